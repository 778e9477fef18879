//! Some of the eye's rays in its plane, with the count along each (K figures 10 and 13).

use glam::DVec2;

use super::section::{Plane, Section};
use crate::frame::Camera;

/// How many rays are drawn.
pub(super) const RAYS: usize = 7;

/// Of half the eye's vertical angle: how far the outermost rays lie from its middle.
const WIDEST: f64 = 0.8;

/// A ray of the eye.
#[derive(Debug, Clone, PartialEq)]
pub struct Ray {
    /// Unit, on the plane: ahead and up.
    pub way: DVec2,
    /// Its place in the picture, upwards from the middle: -1 is the lower edge, 1 the upper.
    pub height: f64,
    /// Piece by piece from the eye, each with its end, metres, and in how many volumes it lies.
    pub legs: Vec<(f64, u32)>,
    /// It ends on a surface.
    pub hits: bool,
}

/// Ray `number` of so many: its place in the picture, and its way.
pub(super) fn way(eye: &Camera, plane: &Plane, number: usize, of: usize) -> (f64, DVec2) {
    #[expect(clippy::cast_precision_loss, reason = "a few rays")]
    let height = WIDEST * (2.0 * number as f64 / (of - 1) as f64 - 1.0);
    let way = plane.way(eye.forward + eye.up * ((eye.vertical_fov / 2.0).tan() * height)).truncate();
    (height, way.normalize_or(DVec2::X))
}

/// The rays, each to its surface or so many metres far.
pub(super) fn through(section: &Section, eye: &Camera, plane: &Plane, farthest: f64) -> Vec<Ray> {
    let ray = |number: usize| {
        let (height, way) = way(eye, plane, number, RAYS);
        let hit = section.surface(DVec2::ZERO, way, eye.near).map(|(metres, _)| metres).filter(|metres| *metres <= farthest);
        Ray { way, height, legs: section.legs(DVec2::ZERO, way, hit.unwrap_or(farthest)), hits: hit.is_some() }
    };
    (0..RAYS).map(ray).collect()
}
