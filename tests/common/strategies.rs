//! What tests of geometry are drawn from at random.

use glam::{DMat4, DVec3, DVec4};
use obscura::frame::Camera;
use proptest::prelude::*;

/// Each coordinate up to `size` either way.
pub fn vector(size: f64) -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-size..size).prop_map(DVec3::from)
}

/// An eye near the origin, looking past it.
pub fn camera() -> impl Strategy<Value = Camera> {
    (vector(5.0), vector(5.0), 0.2..2.5f64, 0.5..2.0f64, 0.05..2.0f64)
        .prop_filter_map("eye and target in one place", |(eye, target, fov, aspect, near)| {
            Camera::look_at(eye, target, fov, aspect, near).ok()
        })
}

/// Where a point is drawn, in pixels from the top left; `None` where it is not.
pub fn pixel(point: DVec3, clip_from_world: &DMat4, size: [u32; 2]) -> Option<[f64; 2]> {
    let clip: DVec4 = *clip_from_world * point.extend(1.0);
    let shown = clip.w > 0.0 && clip.z <= clip.w && clip.x.abs() <= clip.w && clip.y.abs() <= clip.w;
    shown.then(|| [(clip.x / clip.w + 1.0) / 2.0 * f64::from(size[0]), (1.0 - clip.y / clip.w) / 2.0 * f64::from(size[1])])
}
