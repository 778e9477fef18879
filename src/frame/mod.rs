//! The frame as data: what [`crate::director::plan`] writes and the GPU carries out.
//!
//! A [`FramePlan`] holds ids and values only, so it can be printed, compared with a stored text,
//! checked ([`validate`]) and explained in the panel without a GPU.

pub mod camera;
pub mod capabilities;
pub mod lists;
pub mod plan;
pub mod state;
pub mod stencil;
pub mod step;
mod text;
pub mod validate;

pub use camera::{Camera, CameraError};
pub use capabilities::{Capabilities, Lack, WideCounts};
pub use lists::List;
pub use plan::{
    Case, Cutout, CutoutShape, FramePlan, Gather, Method, Piece, Projection, Reason, Reflections, View, VolumePlan, Window,
};
/// What `show surfaces` draws a surface in, display values: of the pixels of view `v` that show instance `i` of `n`,
/// the number is v n + i + 1; 0 is no surface. No two numbers below 2^24 have one colour.
#[must_use]
pub const fn identity_color(number: u32) -> [u8; 3] {
    // As `shaders/identity.wgsl` has it: times an odd number, modulo 2^24.
    let [low, middle, high, _] = number.wrapping_mul(0x9e37_79b1).to_le_bytes();
    [low, middle, high]
}

pub use step::{
    Action, Clear, Draw, DrawSet, Label, LabelKind, LightShape, Look, MirrorLook, Part, Program, Run, SHADED_TOGETHER, Shade,
    Step, Stroke, Surface, Swollen, Target, VolumePart,
};
