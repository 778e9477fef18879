//! The frame as data: what [`crate::director::plan`] writes and the GPU carries out.

pub mod camera;

pub use camera::{Camera, CameraError};
