//! Pure math, no GPU and no scene: bounds, frusta, mesh topology, silhouettes, shadow volumes.

pub mod bounds;
pub mod terminator;
pub mod topology;
pub mod weld;

pub use bounds::Aabb;
pub use topology::{Topology, TopologyReport};
pub use weld::Weld;
