//! Planar shadows: the matrix that throws everything onto a plane, away from a light (K section 4 and appendix B,
//! after Blinn's "Me and My (Fake) Shadow", 1988), and what of a caster may be thrown at all.
//!
//! With h(x) the height of a point over the plane, and the light L homogeneous (w = 1, or 0 for a direction),
//!
//! ```text
//!   S x = h(L) x - h(x) L           h(S x) = h(L) h(x) - h(x) h(L) = 0: it lies on the plane,
//!                                   and, a sum of both, on the line through light and x
//!
//!      * L             w = h(L) - h(x)      above 0  between the plane and the light: a shadow
//!     / \                                        0  as high as the light: at infinity
//!    /   x                                  below 0  beyond the light: the point of the line on
//!   /     \                                          the light's other side, where no shadow is
//!  --------S x-------- plane        w = h(L), the same for all, where the light is a direction
//! ```
//!
//! **Beyond the light** nothing need be cut off. All four numbers of such a point have the other sign once the eye's
//! projection has been applied: in front of the eye, the w that the rasteriser clips by is then negative. And what
//! would come to lie behind the eye, where both signs turn, has a depth outside 0 to 1. Whatever passes
//! `0 <= z <= w`, in every projection with a near plane, is in front of the eye *and* below the light, fragment by
//! fragment of a triangle that is neither.
//!
//! **Behind the plane** h(x) < 0 and w > 0 as well: nothing tells such a point from a caster. Triangles that
//! cross the plane are cut on it ([`append_over`]), and what lies wholly behind is left out ([`lies`]).
//! In the plane itself lies the receiver, which must not shadow itself: seen from the light's side, what is
//! no higher than rounding may lift the receiver throws nothing.

use glam::{DMat4, DVec3, DVec4, Vec3};

use super::Topology;
use super::planar::height;

/// K's appendix B: throws points onto `plane` (as in [`super::planar`]) away from `light` (a point with w = 1, or the
/// direction towards it with w = 0), all in one space. Homogeneous: what it gives has w > 0 where there is a shadow,
/// for a light on the plane's positive side.
#[must_use]
pub fn shadow_matrix(plane: DVec4, light: DVec4) -> DMat4 {
    let dot = plane.dot(light);
    let column = |axis: DVec4, over: f64| axis * dot - light * over;
    DMat4::from_cols(column(DVec4::X, plane.x), column(DVec4::Y, plane.y), column(DVec4::Z, plane.z), column(DVec4::W, plane.w))
}

/// A receiver's plane as one light and one eye have it.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct LitPlane {
    /// World space, unit normal to the light's side.
    pub plane: DVec4,
    /// The light's height over it, metres; for a directional light the sine of its angle to the plane.
    pub light: f64,
    /// The eye is on the light's side. Else the receiver's own triangles stand between what is seen and the light.
    pub seen_lit: bool,
    /// Metres: what lies no farther from the plane is taken to lie in it.
    pub room: f64,
}

impl LitPlane {
    /// `plane`, of either side, before `light` (a point with w = 1, or the direction towards it with w = 0) and an eye,
    /// world space; none where the light lies in the plane, which then throws no shadow on it.
    #[must_use]
    pub fn of(plane: DVec4, light: DVec4, eye: DVec3, room: f64) -> Option<Self> {
        /// The least sine of a directional light's angle to the plane.
        const LEAST_SINE: f64 = 1e-6;
        let over = plane.dot(light);
        let least = if light.w == 0.0 { LEAST_SINE } else { room };
        // A light that is no number is on no side.
        if over.is_nan() || over.abs() <= least {
            return None;
        }
        let plane = plane * over.signum();
        Some(Self { plane, light: over.abs(), seen_lit: height(plane, eye) >= 0.0, room })
    }
}

/// Where a caster lies before a receiver.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lies {
    /// Between plane and light, as far as it throws shadows there: it is thrown as it is.
    Between,
    /// Some of it may be behind the plane, or in it: triangle by triangle.
    Across,
    /// Behind the plane, or in it: it throws nothing.
    Behind,
    /// No part of it is lower than the light.
    Beyond,
}

/// Where something between two heights over the plane, metres, lies. `solid` says that of its triangles only those
/// count that face the light: then none that counts lies in the plane while all is over it.
#[must_use]
pub fn lies(lit: &LitPlane, light: DVec4, [lowest, highest]: [f64; 2], solid: bool) -> Lies {
    let LitPlane { light: over, seen_lit, room, .. } = *lit;
    if highest <= if seen_lit { room } else { -room } {
        Lies::Behind
    } else if light.w != 0.0 && lowest >= over {
        Lies::Beyond
    } else if lowest > room || lowest >= -room && solid {
        Lies::Between
    } else {
        Lies::Across
    }
}

/// Appends the triangles of `topology` that count for a light (not 0 in `contributions`), as far as they lie over a
/// plane, as corners with w = 1, three a triangle. `plane` is of the caster's object space and gives heights in metres;
/// `seen_lit` and `room` are [`LitPlane`]'s. Corners that are not cut keep every bit, and triangles that share a cut edge
/// share where it is cut.
pub fn append_over(
    (topology, welded): (&Topology, &[Vec3]),
    contributions: &[i8],
    (plane, lit): (DVec4, &LitPlane),
    corners: &mut Vec<[f32; 4]>,
) {
    let LitPlane { seen_lit, room, .. } = *lit;
    let over = |vertex: u32| height(plane, welded[vertex as usize].as_dvec3());
    let mut polygon: Vec<Vec3> = Vec::with_capacity(4);
    for (triangle, _) in topology.triangles().iter().zip(contributions).filter(|(_, counts)| **counts != 0) {
        let heights = triangle.map(over);
        let in_plane = heights.iter().all(|height| height.abs() <= room);
        let reaches = heights.iter().any(|height| *height > room);
        if !(reaches || in_plane && !seen_lit) {
            continue;
        }
        polygon.clear();
        if in_plane || heights.iter().all(|height| *height >= -room) {
            polygon.extend(triangle.map(|vertex| welded[vertex as usize]));
        } else {
            for (at, &vertex) in triangle.iter().enumerate() {
                let (before, height, height_before) = (triangle[(at + 2) % 3], heights[at], heights[(at + 2) % 3]);
                if (height >= 0.0) != (height_before >= 0.0) {
                    polygon.push(cut(welded, (before, height_before), (vertex, height)));
                }
                if height >= 0.0 {
                    polygon.push(welded[vertex as usize]);
                }
            }
        }
        for at in 2..polygon.len() {
            corners.extend([polygon[0], polygon[at - 1], polygon[at]].map(|corner| corner.extend(1.0).to_array()));
        }
    }
}

/// Where an edge meets the plane: the same from both its ends.
fn cut(welded: &[Vec3], a: (u32, f64), b: (u32, f64)) -> Vec3 {
    let [(from, at_from), (to, at_to)] = if a.0 < b.0 { [a, b] } else { [b, a] };
    let [start, end] = [from, to].map(|vertex| welded[vertex as usize].as_dvec3());
    start.lerp(end, at_from / (at_from - at_to)).as_vec3()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails may panic")]
    use super::*;
    use proptest::prelude::*;

    fn vector(size: f64) -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-size..size).prop_map(DVec3::from)
    }

    fn plane() -> impl Strategy<Value = DVec4> {
        (vector(1.0), -5.0..5.0f64)
            .prop_filter_map("no direction", |(normal, offset)| Some(normal.try_normalize()?.extend(offset)))
    }

    fn light() -> impl Strategy<Value = DVec4> {
        (vector(10.0), any::<bool>()).prop_filter_map("no direction", |(at, point)| {
            if point { Some(at.extend(1.0)) } else { Some(at.try_normalize()?.extend(0.0)) }
        })
    }

    /// K's routine, as he prints it, for one element: `m[column][row]`.
    fn printed(column: usize, row: usize, plane: [f64; 4], light: [f64; 4]) -> f64 {
        let dot: f64 = (0..4).map(|i| plane[i] * light[i]).sum();
        if column == row { dot - light[row] * plane[column] } else { -light[row] * plane[column] }
    }

    #[test]
    fn a_lamp_over_a_floor() {
        let matrix = shadow_matrix(DVec4::Y, DVec4::new(0.0, 4.0, 0.0, 1.0));
        assert_eq!(matrix * DVec4::new(1.0, 2.0, 0.0, 1.0), DVec4::new(4.0, 0.0, 0.0, 2.0), "twice as far from the axis");
        let sun = shadow_matrix(DVec4::Y, DVec4::new(1.0, 1.0, 0.0, 0.0));
        assert_eq!(sun * DVec4::new(0.0, 3.0, 5.0, 1.0), DVec4::new(-3.0, 0.0, 5.0, 1.0));
    }

    proptest! {
        #[test]
        fn the_matrix_is_the_printed_one(plane in plane(), light in light()) {
            let matrix = shadow_matrix(plane, light).to_cols_array_2d();
            for (column, values) in matrix.into_iter().enumerate() {
                for (row, value) in values.into_iter().enumerate() {
                    let expected = printed(column, row, plane.to_array(), light.to_array());
                    prop_assert!((value - expected).abs() < 1e-12);
                }
            }
        }

        #[test]
        fn shadows_lie_on_the_plane_and_on_the_line_to_the_light(plane in plane(), light in light(), point in vector(10.0)) {
            let thrown = shadow_matrix(plane, light) * point.extend(1.0);
            prop_assert!(plane.dot(thrown).abs() < 1e-9, "on the plane");
            prop_assume!(thrown.w.abs() > 1e-3);
            let at = thrown.truncate() / thrown.w;
            let along = if light.w == 0.0 { light.truncate() } else { light.truncate() - point };
            let beside = (at - point).cross(along).length() / along.length().max(1e-9);
            prop_assert!(beside < 1e-8 * (1.0 + at.length()), "{beside} m off the line");
        }

        #[test]
        fn the_sign_tells_casters_from_what_is_beyond_the_light(plane in plane(), light in light(), point in vector(10.0)) {
            let facing = LitPlane::of(plane, light, DVec3::ZERO, 1e-3);
            prop_assume!(facing.is_some());
            let lit = facing.unwrap();
            let thrown = shadow_matrix(lit.plane, light) * point.extend(1.0);
            let over = height(lit.plane, point);
            prop_assert!((thrown.w - (lit.light - over * light.w)).abs() < 1e-9);
            if light.w != 0.0 {
                prop_assert_eq!(thrown.w > 0.0, over < lit.light);
            } else {
                prop_assert!(thrown.w > 0.0);
            }
        }
    }

    fn lit(seen_lit: bool) -> LitPlane {
        LitPlane { plane: DVec4::Y, light: 5.0, seen_lit, room: 1e-5 }
    }

    #[test]
    fn the_plane_is_turned_to_the_light_and_knows_the_eyes_side() {
        let lamp = DVec4::new(0.0, -3.0, 0.0, 1.0);
        let below = LitPlane::of(DVec4::Y, lamp, DVec3::Y, 1e-5).unwrap();
        assert_eq!((below.plane, below.light, below.seen_lit), (-DVec4::Y, 3.0, false));
        assert!(LitPlane::of(DVec4::Y, lamp, DVec3::NEG_Y, 1e-5).unwrap().seen_lit);
        for beside in [DVec4::new(2.0, 1e-6, 0.0, 1.0), DVec4::X, DVec4::splat(f64::NAN)] {
            assert_eq!(LitPlane::of(DVec4::Y, beside, DVec3::Y, 1e-5), None);
        }
    }

    #[test]
    fn casters_are_told_by_their_heights() {
        let lamp = DVec4::new(0.0, 5.0, 0.0, 1.0);
        let of = |heights, solid| lies(&lit(true), lamp, heights, solid);
        assert_eq!(of([0.5, 2.0], false), Lies::Between);
        assert_eq!(of([0.5, 9.0], false), Lies::Between, "the rasteriser cuts at the light's height");
        assert_eq!(of([0.0, 2.0], true), Lies::Between, "standing on the floor");
        assert_eq!(of([0.0, 2.0], false), Lies::Across, "its bottom may count, and lies in the plane");
        assert_eq!(of([-1.0, 2.0], true), Lies::Across);
        assert_eq!(of([-1.0, 1e-6], true), Lies::Behind);
        assert_eq!(of([5.0, 7.0], true), Lies::Beyond);
        assert_eq!(lies(&lit(true), DVec4::Y, [5.0, 7.0], true), Lies::Between, "no height is beyond a sun");
        assert_eq!(lies(&lit(false), lamp, [0.0, 0.0], false), Lies::Across, "the receiver hides the light from itself");
        assert_eq!(lies(&lit(false), lamp, [-1.0, -0.1], false), Lies::Behind);
    }

    /// Of triangles, all of which count.
    fn over(positions: &[[f32; 3]], triangles: &[[u32; 3]], seen_lit: bool) -> Vec<[f32; 4]> {
        let welded: Vec<Vec3> = positions.iter().map(|&position| position.into()).collect();
        let topology = Topology::of_welded(triangles.to_vec(), &welded);
        let mut corners = Vec::new();
        append_over((&topology, &welded), &vec![1; triangles.len()], (DVec4::Y, &lit(seen_lit)), &mut corners);
        corners
    }

    #[test]
    fn triangles_are_cut_on_the_plane() {
        let across = over(&[[0.0, -1.0, 0.0], [2.0, 1.0, 0.0], [-2.0, 1.0, 0.0]], &[[0, 1, 2]], true);
        assert_eq!(across.len(), 6, "a corner is cut off: two triangles are left");
        assert!(across.iter().all(|corner| corner[1] >= 0.0 && corner[3] == 1.0));
        for expected in [[1.0, 0.0, 0.0, 1.0], [-1.0, 0.0, 0.0, 1.0], [2.0, 1.0, 0.0, 1.0], [-2.0, 1.0, 0.0, 1.0]] {
            assert!(across.contains(&expected), "{expected:?} in {across:?}");
        }
        let tip = over(&[[0.0, 1.0, 0.0], [2.0, -1.0, 0.0], [-2.0, -1.0, 0.0]], &[[0, 1, 2]], true);
        assert_eq!(tip.len(), 3);
        assert!(over(&[[0.0, -1.0, 0.0], [2.0, -1.0, 0.0], [-2.0, 0.0, 0.0]], &[[0, 1, 2]], true).is_empty(), "behind");
        assert_eq!(over(&[[0.0, 1.0, 0.0], [2.0, 0.0, 0.0], [-2.0, -1e-6, 0.0]], &[[0, 1, 2]], true).len(), 3, "not cut");
    }

    #[test]
    fn what_lies_in_the_plane_shadows_only_what_is_seen_from_behind() {
        let flat = [[0.0, 1e-6, 0.0], [2.0, 0.0, 0.0], [-2.0, -1e-6, 1.0]];
        assert!(over(&flat, &[[0, 1, 2]], true).is_empty());
        assert_eq!(over(&flat, &[[0, 1, 2]], false).len(), 3);
    }

    #[test]
    fn neighbours_are_cut_in_the_same_place() {
        let corners = [[0.31, 0.77, 0.1], [0.29, -0.41, 0.9], [3.0, 1.3, 0.2], [-2.7, 0.9, -0.4]];
        // The edge between the first two, run both ways.
        let cut = over(&corners, &[[0, 1, 2], [1, 0, 3]], true);
        let on_plane: Vec<_> = cut.iter().filter(|corner| corner[1].abs() < 1e-5).collect();
        let shared = on_plane.iter().filter(|corner| (corner[0] - 0.3).abs() < 0.02).collect::<Vec<_>>();
        assert!(shared.len() >= 2 && shared.iter().all(|corner| corner == &shared[0]), "{shared:?}");
    }
}
