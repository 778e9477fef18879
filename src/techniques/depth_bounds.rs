//! Depth bounds by the stencil (M sections 5 and 6, `SetDepthBounds`).
//!
//! A light with an end lights no surface farther away, so nothing need be counted on it. The light's
//! scissor knows that for pixels beside the light; M's depth bounds test knows it for pixels before and
//! behind it as well: what a pixel's depth already says. M has no replacement for hardware without that
//! test, and WebGPU is without it.
//!
//! The stencil can stand in: before the first volume, one draw of a convex solid about all that the
//! light reaches ([`Enclosure`]) tells the pixels whose surface lies within it, and every step that counts
//! asks for their bit first. That is better than bounds in depth, which are a slab across the view, and worse
//! in that it must be drawn.
//!
//! ```text
//!                         ______
//!     eye o -------------/--x---\--------   one face behind x: the bit turns over, x is counted
//!                y      |  light |          two behind y: it stays, y is not
//!                        \______/     z     none behind z: it stays, z is not
//! ```
//!
//! The bit is one of the count's, and is set where a surface lies *beyond* the bounds: then all bits are zero
//! where the light shines, whatever they mean. It starts set everywhere, by the clear that starts the
//! count. The solid has room to spare for rounding and for the depth buffer's steps, so that too much may
//! be counted, never too little, and every verdict stays what it was.

use glam::DVec3;

use super::culling::Interest;
use crate::frame::state::{Depth, State};
use crate::frame::stencil::{BitBudget, StencilState};
use crate::frame::{Camera, Draw, DrawSet, Program, Step};
use crate::geometry::Enclosure;
use crate::scene::{LightKind, PosedLight};
use crate::settings::LightBounds;

/// A solid about all that the light may light in this view, by `bounds`; none for lights that have no end.
///
/// None either behind a far plane, which would cut the solid open.
#[must_use]
pub fn enclosure(light: &PosedLight, bounds: LightBounds, interest: Interest, camera: &Camera) -> Option<Enclosure> {
    /// Cones wider than this are balls.
    const WIDEST: f64 = 1.3;
    /// Radians: the shader's cosines are in single precision.
    const ROUNDING: f64 = 2e-3;
    let (center, radius) = (light.position, light.range);
    let has_end = light.kind != LightKind::Directional && center.is_finite() && radius.is_finite() && radius > 0.0;
    if !has_end || interest == Interest::InView || bounds == LightBounds::None || camera.far.is_some() {
        return None;
    }
    let ball = Enclosure::Ball { center, radius };
    let solid = match (bounds, light.kind) {
        (LightBounds::Box, _) => Enclosure::Box { center, radius },
        (_, LightKind::Spot { outer, .. }) if bounds.has_cone() && interest == Interest::Lit && f64::from(outer) < WIDEST => {
            let (apex, outer) = (center, f64::from(outer) + ROUNDING);
            light.direction.try_normalize().map_or(ball, |axis| Enclosure::Cone { apex, axis, outer, reach: radius })
        }
        // A light without a cone that could be drawn.
        (LightBounds::Cone, _) => return None,
        _ => ball,
    };
    Some(solid.grown(margin(center, radius, camera)))
}

/// Metres by which rounding may move a surface, or a face of the solid, at the far end of a ball.
fn margin(center: DVec3, radius: f64, camera: &Camera) -> f64 {
    /// Of positions in single precision, with some room.
    const SHARE: f64 = 1e-5;
    /// Of depth, whose values lie 2^-24 apart at best: as many steps as interpolation may be off.
    const STEPS: f64 = 16.0;
    let farthest = center.distance(camera.eye) + radius;
    let step = farthest * farthest / camera.near * f64::from(f32::EPSILON) / 2.0;
    radius * 1e-3 + (center.length() + farthest) * SHARE + step * STEPS
}

/// The step that marks them, in the light's `scissor`.
#[must_use]
pub fn mark(light: usize, solid: Enclosure, budget: BitBudget, scissor: [u32; 4]) -> Step {
    let why = "A solid about all that the light reaches: where one of its two faces is behind the surface, the surface lies \
               within, and only there volumes are counted.";
    let draw = Draw {
        state: State { depth: Depth::NEARER, stencil: StencilState::mark_bounds(budget), ..State::FLAT },
        light: Some(light),
        ..Draw::plain(Program::Bounds, DrawSet::Enclosure(solid), scissor)
    };
    Step::drawing(format!("light {light}: mark its bounds"), why, draw)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

    use super::*;

    fn camera() -> Camera {
        Camera::look_at(DVec3::new(0.0, 1.0, 9.0), DVec3::ZERO, 1.0, 1.5, 0.1).unwrap()
    }

    #[test]
    fn a_spot_is_bounded_by_no_less_than_its_cone_where_only_its_light_counts() {
        let camera = camera();
        for outer in [0.2_f32, 0.7, 1.2] {
            let spot = PosedLight {
                kind: LightKind::Spot { inner: 0.1, outer },
                position: DVec3::new(1.0, 2.0, -3.0),
                direction: DVec3::NEG_Y,
                range: 6.0,
                ..PosedLight::default()
            };
            let by = |bounds, interest| enclosure(&spot, bounds, interest, &camera);
            for bounds in [LightBounds::Tight, LightBounds::Cone] {
                let Some(Enclosure::Cone { apex, axis, outer: solid, reach }) = by(bounds, Interest::Lit) else { panic!() };
                assert!(solid > f64::from(outer) && solid < f64::from(outer) + 0.01, "{solid} for {outer}");
                assert_eq!(axis, spot.direction);
                let before = (spot.position - apex).dot(axis);
                assert!(before > 0.0 && reach - before > spot.range, "it begins before the lamp and ends beyond the range");
            }
            // What lies in range beside the cone counts too.
            let Some(Enclosure::Ball { center, radius }) = by(LightBounds::Tight, Interest::InRange) else { panic!() };
            assert!(center == spot.position && radius > spot.range && radius < spot.range * 1.01);
            assert_eq!(by(LightBounds::Cone, Interest::InRange), None);
            let Some(Enclosure::Box { radius, .. }) = by(LightBounds::Box, Interest::Lit) else { panic!() };
            assert!(radius > spot.range);
            assert_eq!(by(LightBounds::None, Interest::Lit), None);
            assert_eq!(by(LightBounds::Tight, Interest::InView), None);
            assert_eq!(enclosure(&spot, LightBounds::Tight, Interest::Lit, &Camera { far: Some(50.0), ..camera }), None);
            let endless = PosedLight { range: f64::INFINITY, ..spot };
            assert_eq!(enclosure(&endless, LightBounds::Tight, Interest::Lit, &camera), None);
        }
    }
}
