//! The near rectangle seen from a light: what lies between the two, and where its shadow falls there.
//!
//! ```text
//!        * light
//!        |\ `.                the triangle P is thrown along the rays from the light onto
//!        | \  `.              the near plane, at Q; what falls on the rectangle is seen
//!        |  \P__\             there by the eye, in the very pixels the rectangle covers
//!        |   \   `.
//!      --+----Q----`---- near rectangle
//!         \   :     /
//!          \  :    /
//!             o eye
//! ```
//!
//! With N(X) the height of a point over the near plane, and the light L homogeneous (w = 1, or 0 for
//! a direction), the point Q = N(L) P - N(P) L lies on the plane (N(Q) = 0) and on the line through
//! light and P. The map is linear in P: a planar shadow's matrix (K 5), with the near rectangle for a
//! floor. Followed by the eye's own projection it is the light's view through the near rectangle
//! (Hornus et al. 2005).

use glam::{DAffine3, DMat4, DVec3, DVec4};

use super::{Aabb, NearPyramid};

/// The light's view through the near rectangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThroughLight {
    /// World space to clip space: what lies between light and near plane falls on the pixels whose
    /// near point it shadows, what does not is clipped.
    pub clip_from_world: DMat4,
    /// The light is on the far side of the near plane: it looks towards the eye, and what it sees from
    /// the front is seen from behind.
    pub mirrored: bool,
}

/// The light (world space: a point with w = 1, or the direction towards it with w = 0) looking
/// through the near rectangle of an eye whose projection is `clip_from_world`. `near_plane` has a unit
/// normal towards the eye, `near` is the eye's distance from it, metres. `None` where the light lies
/// on the plane, or so close that single precision would not tell the side.
#[must_use]
pub fn through_light(light: DVec4, near_plane: DVec4, near: f64, clip_from_world: &DMat4) -> Option<ThroughLight> {
    /// Of the near distance (points), or of one (directions).
    const LEAST_HEIGHT: f64 = 1e-3;
    /// Of the light's coordinates.
    const ROUNDING: f64 = 1e-6;
    /// Depth is not compared: it only clips what is behind the near plane, at 0, and must not reach 1
    /// before the light does.
    const DEPTH: f64 = 1e-9;

    let height = near_plane.dot(light);
    let scale = if light.w == 0.0 { 1.0 } else { near };
    let least = LEAST_HEIGHT * scale + ROUNDING * light.truncate().abs().max_element() * light.w;
    // A light that is no number is on no side.
    if height.is_nan() || height.abs() <= least {
        return None;
    }
    // Over the plane is where the light is.
    let (plane, height) = (near_plane * height.signum(), height.abs());
    let thrown = |axis: DVec4, over: f64| {
        let on_plane = axis * height - light * over;
        let clip = *clip_from_world * on_plane;
        // On the near plane w is the near distance, times the point's own w.
        DVec4::new(clip.x, clip.y, DEPTH * scale.min(height) * over, near * on_plane.w)
    };
    let clip_from_world = DMat4::from_cols(
        thrown(DVec4::X, plane.x),
        thrown(DVec4::Y, plane.y),
        thrown(DVec4::Z, plane.z),
        thrown(DVec4::W, plane.w),
    );
    Some(ThroughLight { clip_from_world, mirrored: near_plane.dot(light) < 0.0 })
}

/// Whether the box `bounds` of an object's space may lie, in part, between the light (as in
/// [`through_light`]) and the near rectangle. May say yes wrongly, never no.
#[must_use]
pub fn may_shadow(light: DVec4, rectangle: [DVec3; 4], bounds: &Aabb, world_from_object: &DAffine3) -> bool {
    if bounds.is_empty() {
        return false;
    }
    if light.w != 0.0 {
        return NearPyramid::of(light.truncate() / light.w, rectangle).may_touch(bounds, world_from_object);
    }
    // The rays that reach the rectangle fill a prism; both are taken as round about their middles.
    const ROUNDING: f64 = 1e-5;
    let Some(towards) = light.truncate().try_normalize() else { return true };
    let middle = rectangle.iter().sum::<DVec3>() / 4.0;
    let corners = bounds.corners().map(|corner| world_from_object.transform_point3(corner));
    let center = corners.iter().sum::<DVec3>() / 8.0;
    let farthest = |points: &[DVec3], from: DVec3| points.iter().map(|point| point.distance(from)).fold(0.0, f64::max);
    let radius = farthest(&corners, center) + farthest(&rectangle, middle);
    let offset = center - middle;
    let along = offset.dot(towards);
    let beside = (offset - towards * along).length();
    let room = ROUNDING * corners.iter().fold(middle.abs(), |largest, corner| largest.max(corner.abs())).max_element();
    beside <= radius + room && along >= -(radius + room)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    const NEAR: f64 = 0.5;

    /// An eye at the origin that looks along -Z.
    fn clip_from_world() -> DMat4 {
        glam::dcamera::rh::proj::directx::perspective_infinite_reverse(1.0, 1.5, NEAR)
    }

    fn near_plane() -> DVec4 {
        DVec4::new(0.0, 0.0, 1.0, NEAR)
    }

    fn look(light: DVec4, point: DVec3) -> DVec4 {
        through_light(light, near_plane(), NEAR, &clip_from_world()).unwrap().clip_from_world * point.extend(1.0)
    }

    #[test]
    fn what_the_light_throws_on_the_near_plane_is_seen_there() {
        for light in [DVec4::new(1.0, 2.0, 3.0, 1.0), DVec4::new(0.2, 0.1, -4.0, 1.0), DVec4::new(0.3, 0.2, 0.9, 0.0)] {
            let on_plane = DVec3::new(0.1, -0.05, -NEAR);
            let towards = light.truncate() - on_plane * light.w;
            let seen = clip_from_world() * on_plane.extend(1.0);
            for way in [0.1, 0.5, 0.9] {
                let clip = look(light, on_plane + towards * way);
                assert!(clip.w > 0.0 && clip.z > 0.0 && clip.z < clip.w, "between light and plane: kept");
                assert!((clip.truncate() / clip.w).truncate().distance((seen / seen.w).truncate().truncate()) < 1e-12);
            }
            let behind = look(light, on_plane - towards * 0.3);
            assert!(behind.z < 0.0, "behind the near plane: clipped");
            if light.w != 0.0 {
                let past = look(light, on_plane + towards * 1.2);
                assert!(past.z > past.w, "beyond the light: clipped");
            }
        }
    }

    #[test]
    fn a_light_on_the_near_plane_sees_nothing_through_it() {
        for light in [DVec4::new(2.0, 0.0, -NEAR, 1.0), DVec4::X, DVec4::splat(f64::NAN)] {
            assert_eq!(through_light(light, near_plane(), NEAR, &clip_from_world()), None);
        }
        let mirrored = |z| through_light(DVec4::new(0.0, 0.0, z, 1.0), near_plane(), NEAR, &clip_from_world()).unwrap().mirrored;
        assert!(!mirrored(1.0) && !mirrored(0.0), "on the eye's side");
        assert!(mirrored(-2.0), "in the picture");
    }

    #[test]
    fn boxes_beside_the_rays_throw_nothing_on_the_rectangle() {
        let rectangle = [(-0.4, -0.3), (0.4, -0.3), (0.4, 0.3), (-0.4, 0.3)].map(|(x, y)| DVec3::new(x, y, -NEAR));
        let cube = Aabb::around(DVec3::splat(-0.5), DVec3::splat(0.5));
        let between = |light: DVec4, at: DVec3| may_shadow(light, rectangle, &cube, &DAffine3::from_translation(at));
        for light in [DVec4::new(0.0, 10.0, 0.0, 1.0), DVec4::Y] {
            assert!(between(light, DVec3::new(0.0, 5.0, -0.3)));
            assert!(!between(light, DVec3::new(4.0, 5.0, 0.0)), "beside");
            assert!(!between(light, DVec3::new(0.0, -5.0, -0.3)), "behind the rectangle");
        }
    }
}
