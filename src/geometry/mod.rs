//! Pure math, no GPU and no scene: bounds, frusta, mesh topology, silhouettes, shadow volumes, mirrors, planar shadows.

pub mod bounds;
pub mod clip;
pub mod cutout;
pub mod enclosure;
pub mod ending;
pub mod eye_count;
pub mod flatten;
pub mod flaw;
pub mod frustum;
pub mod layers;
pub mod near_rectangle;
pub mod outward;
pub mod overlap;
pub mod planar;
pub mod planar_shadow;
pub mod portion;
pub mod reach;
pub mod sight;
pub mod silhouette;
pub mod terminator;
pub mod topology;
pub mod volume;
pub mod weld;

pub use bounds::Aabb;
pub use enclosure::Enclosure;
pub use eye_count::{EyeCount, holding_count};
pub use flaw::Flaw;
pub use frustum::NearPyramid;
pub use planar_shadow::LitPlane;
pub use portion::Portion;
pub use reach::{BOX_EDGES, Body};
pub use sight::{Reflected, Sight};
pub use silhouette::{Facing, Planes, light_in_object};
pub use topology::{Topology, TopologyReport};
pub use volume::{Caster, Outline, VolumeIndices, VolumeParts, VolumeScratch};
pub use weld::Weld;
