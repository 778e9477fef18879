//! The frame as data: what [`crate::director::plan`] writes and the GPU carries out.
//!
//! A [`FramePlan`] holds ids and values only, so it can be printed, compared with a stored text,
//! checked ([`validate`]) and explained in the panel without a GPU.

pub mod camera;
pub mod capabilities;
pub mod plan;
pub mod state;
pub mod stencil;
pub mod step;
mod text;
pub mod validate;

pub use camera::{Camera, CameraError};
pub use capabilities::{Capabilities, Lack, WideCounts};
pub use plan::{Case, Cutout, CutoutShape, FramePlan, Gather, Method, Reason, View, VolumePlan, Window};
pub use step::{
    Action, Clear, Draw, DrawSet, Label, LabelKind, LightShape, Look, Part, Program, Step, Stroke, Surface, Target, VolumePart,
};
