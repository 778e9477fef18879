//! Obscura: the architecture page is written as the parts land.

pub mod frame;
pub mod geometry;
pub mod scene;
pub mod settings;
