//! Where a shadow volume may end: on a plane behind everything that could receive the shadow.
//!
//! A volume to infinity is right and expensive: most of its faces pass over pixels whose surfaces
//! lie long before. It may as well end on a plane, as long as everything that is asked about lies
//! on the near side of that plane:
//!
//! - counted from infinity (z-fail), the shortened volume is closed by its dark cap, which now lies
//!   on the plane; it winds around every point before the plane as often as the endless one;
//! - counted from the eye (z-pass forms), the dark cap is missing, but the way from the eye to a
//!   surface stays before the plane when both ends do (a half-space is convex), so it never meets
//!   what was cut away. Hence the *eye* must lie before the plane too.
//!
//! ```text
//!      * light
//!      |\ \      eye o
//!      | \ \caster
//!      |  \_##
//!      |    \  \             receivers
//!   ---+-----\--\---------- floor -------
//!   ============================ plane: the volume ends here
//! ```
//!
//! All of a caster's vertices are thrown onto the one plane, each along its own ray from the light,
//! so sides stay in their planes and the volume stays watertight. The planes tried are the faces of
//! a box that holds the receivers and the eye, moved outward by a margin far above the rounding of
//! the thrown vertices. A face serves only if every vertex's ray runs towards it.

use glam::{DVec3, DVec4};

use super::Aabb;

/// The plane at infinity, as [`ending_plane`]s are written: the volume does not end.
pub const NEVER_ENDS: DVec4 = DVec4::new(0.0, 0.0, 0.0, -1.0);

/// The face of `within` (grown by a thousandth of its size) on which the volume of a caster with the
/// corners `caster` thrown by a point light ends soonest, as outward normal and offset (`n.x + w =
/// 0` on the plane); `None` where no face serves. All in world space. Faces that the caster
/// reaches beyond do not serve.
#[must_use]
pub fn ending_plane(light: DVec3, caster: [DVec3; 8], within: &Aabb) -> Option<DVec4> {
    /// Rays nearly along a face would end very far away: not worth it.
    const LEAST_SLOPE: f64 = 0.02;
    if within.is_empty() || !light.is_finite() {
        return None;
    }
    let margin = 1e-3 * f64::from(within.radius()).max(1e-3);
    let (min, max) = (within.min.as_dvec3() - margin, within.max.as_dvec3() + margin);
    let mut best: Option<(f64, DVec4)> = None;
    for (axis, outward) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [(axis, 1.0), (axis, -1.0)]) {
        let normal = axis * outward;
        let height = normal.dot(if outward > 0.0 { max } else { min });
        let above = height - normal.dot(light);
        let (mut steepest, mut gentle, mut farthest) = (f64::INFINITY, f64::INFINITY, 0.0f64);
        for corner in caster {
            let ray = corner - light;
            let towards = normal.dot(ray);
            steepest = steepest.min(towards);
            gentle = gentle.min(towards / ray.length());
            farthest = farthest.max(towards);
        }
        // How many times a ray's way to the caster it is to the plane, at worst.
        let stretch = above / steepest;
        // All of the caster lies before the plane, and by more than rounding.
        let before = above > farthest + 0.5 * margin;
        if before && gentle > LEAST_SLOPE && best.is_none_or(|(least, _)| stretch < least) {
            best = Some((stretch, normal.extend(-height)));
        }
    }
    best.map(|(_, plane)| plane)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn corners(min: Vec3, max: Vec3) -> [DVec3; 8] {
        Aabb { min, max }.corners()
    }

    #[test]
    fn a_light_above_ends_the_volume_below_the_floor() {
        let within = Aabb { min: Vec3::new(-10.0, 0.0, -10.0), max: Vec3::new(10.0, 6.0, 10.0) };
        let caster = corners(Vec3::new(-1.0, 1.0, -1.0), Vec3::new(1.0, 2.0, 1.0));
        let plane = ending_plane(DVec3::new(0.0, 5.0, 0.0), caster, &within);
        assert_eq!(plane.map(|plane| plane.truncate()), Some(DVec3::NEG_Y));
        let depth_below_floor = plane.map_or(0.0, |plane| -plane.w);
        assert!((0.001..0.1).contains(&depth_below_floor), "{depth_below_floor}");
    }

    #[test]
    fn a_light_beside_ends_it_behind_the_far_wall_and_one_inside_never() {
        let within = Aabb { min: Vec3::splat(-10.0), max: Vec3::splat(10.0) };
        let caster = corners(Vec3::new(0.0, -1.0, -1.0), Vec3::new(1.0, 1.0, 1.0));
        let beside = ending_plane(DVec3::new(-5.0, 0.0, 0.0), caster, &within);
        assert_eq!(beside.map(|plane| plane.truncate()), Some(DVec3::X));
        assert_eq!(ending_plane(DVec3::new(0.5, 0.0, 0.0), caster, &within), None, "rays leave every way");
    }

    #[test]
    fn everything_in_the_box_lies_before_the_plane() {
        let within = Aabb { min: Vec3::new(-3.0, -1.0, -8.0), max: Vec3::new(9.0, 4.0, 2.0) };
        let caster = corners(Vec3::new(0.0, 0.0, -2.0), Vec3::new(1.0, 1.0, -1.0));
        for light in [DVec3::new(-2.0, 3.0, 0.0), DVec3::new(8.0, 0.5, -7.0), DVec3::new(0.5, 20.0, -1.5)] {
            if let Some(plane) = ending_plane(light, caster, &within) {
                for corner in within.corners() {
                    assert!(plane.truncate().dot(corner) + plane.w < 0.0);
                }
                for corner in caster {
                    assert!(plane.truncate().dot(corner - light) > 0.0, "the ray runs towards the plane");
                }
            }
        }
    }
}
