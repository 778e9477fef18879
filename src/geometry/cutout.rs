//! Planar cut-outs: flat casters, whose shadow volumes are their outlines thrown by one matrix.
//!
//! A set of polygons on one plane, with holes or without, never shadows itself, and its volume is
//! its outline extended away from the light (K 6.2.1). K's appendix C extends each vertex v by a
//! distance d: to `v + d (v - l)` from a light at l, to `v - d l` from a light in the direction l.
//! Homogeneous, both are one formula: the vertex, less a multiple of the light,
//!
//! ```text
//!   v' = v - s l        l = (x y z 1), s = d / (1 + d)      a point
//!                       l = (x y z 0), s = d                a direction
//! ```
//!
//! which is linear, so one 4 by 4 matrix does it ([`Throw::thrown_from_object`]), and for a point
//! light d may be infinite: s = 1, w = 0, the vertex is thrown to infinity exactly.
//!
//! All vertices of a cut-out land on one plane parallel to its own. So the *solid* between the two
//! planes is a prism seen through a projective transformation: K's "Advanced" note. The prism is
//! static geometry, the outline (x, y) at z = 0 and again at z = 1, and everything that changes
//! (the light, where the cut-out is, how far the volume reaches) is in the one matrix that takes
//! (x, y, z) into space ([`Throw::object_from_prism`]):
//!
//! ```text
//!     z = 1  +------+              * light        (x y z 1) -> x right + y up + origin - z s l
//!            |      |             / \
//!            | prism|            /___\  z = 0     K solves for its 15 unknowns from five points;
//!     z = 0  +------+           /_____\ z = 1     its columns can also be read off, as here
//! ```
//!
//! The far plane is put where no receiver and no eye can be beyond it ([`CutoutPlane::throw`]): the
//! reasons are those of [`super::ending`]. A light in the cut-out's own plane throws no volume.

use glam::{DMat4, DVec2, DVec3, DVec4, Vec3};
use serde::Serialize;

use super::volume::{VolumeIndices, VolumeParts};

/// The plane of a cut-out, with axes in it: (x, y) of the cut-out lies at `origin + x right + y up`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CutoutPlane {
    /// A point of the plane.
    pub origin: DVec3,
    /// Unit, in the plane.
    pub right: DVec3,
    /// Unit, in the plane, square to `right`.
    pub up: DVec3,
}

/// How a cut-out's far copy is made: the light, homogeneous, in the cut-out's space, and how much
/// of it is taken from each vertex (the module's s).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Throw {
    /// A point with w = 1, or the direction towards a directional light with w = 0.
    pub light: DVec4,
    /// s: below 1 for a point light and then a finite way; 1 to infinity. Metres along the
    /// direction, in the units of its length, for a directional light.
    pub share: f64,
}

impl CutoutPlane {
    /// The plane through `origin` whose normal is `normal` (not zero).
    #[must_use]
    pub fn square_to(normal: DVec3, origin: DVec3) -> Self {
        let (right, up) = normal.normalize_or(DVec3::Y).any_orthonormal_pair();
        Self { origin, right, up }
    }

    /// The one plane on which all of `points` lie, within the rounding of single precision; `None`
    /// where there is none, or more than one because they lie on a line.
    #[must_use]
    pub fn of(points: impl Iterator<Item = Vec3> + Clone) -> Option<Self> {
        // Half a last digit of the coordinates, on each of three axes, and some for the product.
        const ROUNDING: f64 = 4e-7;
        let points = points.map(|point| point.as_dvec3());
        let origin = points.clone().next()?;
        let size = points.clone().fold(0.0, |size: f64, point| size.max(point.abs().max_element()));
        let farthest = |away: &dyn Fn(DVec3) -> f64| points.clone().max_by(|&a, &b| away(a).total_cmp(&away(b)));
        let along = farthest(&|point| point.distance_squared(origin))? - origin;
        let across = farthest(&|point| along.cross(point - origin).length_squared())? - origin;
        let normal = along.cross(across);
        let flat_enough = ROUNDING * size;
        // On a line: the widest triangle is no wider than the rounding.
        if !normal.is_finite() || normal.length() <= 16.0 * flat_enough * along.length() {
            return None;
        }
        let plane = Self::square_to(normal, origin);
        let normal = plane.normal();
        points.clone().all(|point| normal.dot(point - origin).abs() <= flat_enough).then_some(plane)
    }

    /// Unit; the side from which right, up run counter-clockwise.
    #[must_use]
    pub fn normal(&self) -> DVec3 {
        self.right.cross(self.up)
    }

    /// Of a point (w = 1) above the plane; how much a direction (w = 0) rises.
    #[must_use]
    pub fn height(&self, of: DVec4) -> f64 {
        self.normal().dot(of.truncate() - self.origin * of.w)
    }

    /// Where (x, y) of the cut-out lies.
    #[must_use]
    pub fn at(&self, point: DVec2) -> DVec3 {
        self.origin + self.right * point.x + self.up * point.y
    }

    /// How steeply, at least, `light` looks onto the part of the plane within `bounds`' corners: the
    /// sine of the angle; negative from behind.
    #[must_use]
    pub fn steepness(&self, light: DVec4, corners: &[DVec3; 8]) -> f64 {
        let height = self.height(light);
        if light.w == 0.0 {
            return height / light.truncate().length();
        }
        let farthest = corners.iter().map(|corner| corner.distance(light.truncate())).fold(0.0, f64::max);
        height / farthest
    }

    /// From `light`, not in the plane, onto the parallel plane beyond all of `receivers` (corners
    /// of what holds everything that may receive the shadow, and the eye), and a thousandth more.
    #[must_use]
    pub fn throw(&self, light: DVec4, receivers: &[DVec3; 8]) -> Throw {
        let height = self.height(light);
        let below = |corner: &DVec3| -height.signum() * self.height(corner.extend(1.0));
        let depths = receivers.map(|corner| below(&corner));
        let (nearest, deepest) =
            depths.iter().fold((f64::MAX, f64::MIN), |(low, high), &depth| (low.min(depth), high.max(depth)));
        let margin = 1e-3 * (deepest - nearest).max(height.abs()).max(1e-3);
        Throw::extended(light, (deepest.max(0.0) + margin) / height.abs())
    }
}

impl Throw {
    /// As K's appendix C extends: by `distance` times the way from the light, for a point; by
    /// `distance` times the light's direction, for a direction, where it must be finite.
    #[must_use]
    pub fn extended(light: DVec4, distance: f64) -> Self {
        let share = match light.w {
            0.0 => distance,
            _ if distance.is_infinite() => 1.0,
            _ => distance / (1.0 + distance),
        };
        Self { light, share }
    }

    /// Takes a vertex (x y z 1) of any caster to where it is thrown, homogeneous: K's appendix C as
    /// a matrix.
    #[must_use]
    pub fn thrown_from_object(&self) -> DMat4 {
        let mut matrix = DMat4::IDENTITY;
        matrix.w_axis -= self.light * self.share;
        matrix
    }

    /// Takes the prism (x y z 1) over a cut-out's outline into the cut-out's space, homogeneous:
    /// z = 0 onto `plane`, z = 1 to where the light throws it. K's "Advanced" matrix.
    #[must_use]
    pub fn object_from_prism(&self, plane: &CutoutPlane) -> DMat4 {
        DMat4::from_cols(plane.right.extend(0.0), plane.up.extend(0.0), self.light * -self.share, plane.origin.extend(1.0))
    }
}

/// Appends the volume of a cut-out of `vertices` vertices to `indices`, which count 2 `vertices`:
/// the cut-out, then its far copy. `edges` are its outline, each with the cut-out on its left as
/// the light sees it; of its triangles, `kept` are counter-clockwise from the light and `turned`
/// clockwise. Both caps are the triangles themselves: closed, whatever the outline's form.
pub fn append_cutout(
    vertices: u32,
    edges: &[[u32; 2]],
    kept: impl Iterator<Item = [u32; 3]> + Clone,
    turned: impl Iterator<Item = [u32; 3]> + Clone,
    parts: VolumeParts,
    indices: &mut Vec<u32>,
) -> VolumeIndices {
    let far = |vertex: u32| vertex + vertices;
    let mut ranges = VolumeIndices::default();
    let mut start = indices.len();
    let mut since = |indices: &Vec<u32>| {
        let range = start as u32..indices.len() as u32;
        start = indices.len();
        range
    };
    if parts.sides {
        indices.extend(edges.iter().flat_map(|&[a, b]| [a, far(a), far(b), a, far(b), b]));
        ranges.sides = since(indices);
    }
    if parts.light_cap {
        indices.extend(kept.clone().flatten());
        ranges.light_cap_kept = since(indices);
        indices.extend(turned.clone().flatten());
        ranges.light_cap_turned = since(indices);
    }
    if parts.dark_cap {
        indices.extend(kept.flat_map(|[a, b, c]| [c, b, a]).map(far));
        indices.extend(turned.flatten().map(far));
        ranges.dark_cap = since(indices);
    }
    ranges
}

#[cfg(test)]
mod tests {
    // Test code: a failed expectation is the report.
    #![allow(clippy::unwrap_used)]

    use super::*;
    use glam::DMat3;

    const POINT: DVec4 = DVec4::new(1.0, 1.0, 7.0, 1.0);
    const DIRECTION: DVec4 = DVec4::new(0.3, -0.4, 2.0, 0.0);

    /// K's appendix C, line by line.
    fn extend_volume(v: DVec3, local_light: bool, light: DVec3, extend_distance: f64) -> DVec3 {
        let extend_direction = if local_light { v - light } else { -light };
        v + extend_direction * extend_distance
    }

    fn plane() -> CutoutPlane {
        CutoutPlane::square_to(DVec3::new(0.2, -0.5, 1.3), DVec3::new(3.0, 0.5, -2.0))
    }

    fn outline() -> [DVec2; 5] {
        [DVec2::ZERO, DVec2::X, DVec2::new(1.3, 2.0), DVec2::new(-0.7, 0.9), DVec2::new(-4.0, -3.0)]
    }

    fn dehomogenised(point: DVec4) -> DVec3 {
        point.truncate() / point.w
    }

    #[test]
    fn both_matrices_extend_as_appendix_c_does() {
        // K's own example first: a triangle, a light at (1, 1, 7).
        for v in [DVec3::ZERO, DVec3::X, DVec3::Y] {
            let thrown = Throw::extended(POINT, 100_000.0).thrown_from_object() * v.extend(1.0);
            assert!(dehomogenised(thrown).distance(extend_volume(v, true, POINT.truncate(), 100_000.0)) < 1e-5, "{v}");
        }
        for (light, local) in [(POINT, true), (DIRECTION, false)] {
            for distance in [0.5, 1.0, 40.0, 1e4] {
                let throw = Throw::extended(light, distance);
                for point in outline() {
                    let v = plane().at(point);
                    let expected = extend_volume(v, local, light.truncate(), distance);
                    let near = throw.object_from_prism(&plane()) * point.extend(0.0).extend(1.0);
                    let far = throw.object_from_prism(&plane()) * point.extend(1.0).extend(1.0);
                    let thrown = throw.thrown_from_object() * v.extend(1.0);
                    let close =
                        |homogeneous: DVec4, to: DVec3| dehomogenised(homogeneous).distance(to) < 1e-9 * (1.0 + to.length());
                    assert!(close(near, v) && close(far, expected) && close(thrown, expected), "{light} {distance} {point}");
                }
            }
        }
    }

    #[test]
    fn a_point_light_throws_to_infinity_exactly() {
        let throw = Throw::extended(POINT, f64::INFINITY);
        for point in outline() {
            let v = plane().at(point);
            let thrown = throw.thrown_from_object() * v.extend(1.0);
            assert_eq!(thrown, (v - POINT.truncate()).extend(0.0));
            let far = throw.object_from_prism(&plane()) * point.extend(1.0).extend(1.0);
            assert!(far.w == 0.0 && far.truncate().distance(v - POINT.truncate()) < 1e-12);
        }
    }

    /// The projective transformation that takes the standard frame (the four unit points and their
    /// sum) to five points: the step from which the fundamental theorem is proved.
    fn from_standard_frame(points: [DVec4; 5]) -> DMat4 {
        let [a, b, c, d, e] = points;
        let weights = DMat4::from_cols(a, b, c, d).inverse() * e;
        DMat4::from_cols(a * weights.x, b * weights.y, c * weights.z, d * weights.w)
    }

    #[test]
    fn the_prism_matrix_is_the_one_that_five_points_determine() {
        // K: "one and only one projective transformation" takes five points to five points. It is
        // found here from where appendix C puts them, and must be ours, but for a common factor.
        for (light, local) in [(POINT, true), (DIRECTION, false)] {
            let throw = Throw::extended(light, 2.5);
            let prism = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 1.0, 1.0)].map(DVec3::from);
            let placed = prism.map(|p| {
                let v = plane().at(p.truncate());
                if p.z == 0.0 { v } else { extend_volume(v, local, light.truncate(), 2.5) }.extend(1.0)
            });
            let solved = from_standard_frame(placed) * from_standard_frame(prism.map(|p| p.extend(1.0))).inverse();
            let read_off = throw.object_from_prism(&plane());
            let factor = read_off.w_axis.w / solved.w_axis.w;
            let difference = (solved * factor - read_off).to_cols_array().iter().fold(0.0, |most: f64, d| most.max(d.abs()));
            assert!(difference < 1e-9, "{light}: {difference}");
        }
    }

    #[test]
    fn the_far_plane_lies_beyond_every_receiver() {
        let (min, max) = (DVec3::new(-6.0, -1.0, -5.0), DVec3::new(7.0, 9.0, 4.0));
        let corners: [DVec3; 8] = std::array::from_fn(|i| {
            DVec3::from_array(std::array::from_fn(|axis| if i >> axis & 1 == 0 { min[axis] } else { max[axis] }))
        });
        for light in [POINT, DIRECTION, DVec4::new(2.0, 8.0, -30.0, 1.0), -DIRECTION] {
            let throw = plane().throw(light, &corners);
            let heights = outline().map(|point| {
                plane().height(dehomogenised(throw.thrown_from_object() * plane().at(point).extend(1.0)).extend(1.0))
            });
            let side = plane().height(light).signum();
            for height in heights {
                assert!((height - heights[0]).abs() < 1e-9, "parallel to the cut-out");
                assert!(corners.iter().all(|corner| side * plane().height(corner.extend(1.0)) > side * height + 1e-3));
            }
        }
    }

    #[test]
    fn planes_are_found_within_rounding_and_not_elsewhere() {
        let turn = DMat3::from_axis_angle(DVec3::new(0.3, 0.5, -0.8).normalize(), 1.1);
        let placed = |p: DVec3| (turn * p + DVec3::new(20.0, -7.0, 3.0)).as_vec3();
        let flat: Vec<Vec3> = (0..40).map(|i| placed(DVec3::new((i * 7 % 11).into(), (i % 5).into(), 0.0))).collect();
        let plane = CutoutPlane::of(flat.iter().copied()).unwrap();
        assert!(plane.normal().cross(turn * DVec3::Z).length() < 1e-6, "{}", plane.normal());
        for point in &flat {
            let from = point.as_dvec3() - plane.origin;
            let at = plane.at(DVec2::new(from.dot(plane.right), from.dot(plane.up)));
            assert!(at.distance(point.as_dvec3()) < 1e-5);
        }
        let bent = flat.iter().copied().chain([placed(DVec3::new(3.0, 2.0, 1e-4))]);
        assert_eq!(CutoutPlane::of(bent), None, "a tenth of a millimetre off");
        let line = (0..9).map(|i| placed(DVec3::new(i.into(), 0.0, 0.0)));
        assert_eq!(CutoutPlane::of(line), None, "a line lies on many planes");
        assert_eq!(CutoutPlane::of([Vec3::NAN; 3].into_iter()), None);
        assert_eq!(CutoutPlane::of(std::iter::empty()), None);
    }

    #[test]
    fn steepness_is_the_sine_to_the_farthest_corner() {
        let floor = CutoutPlane { origin: DVec3::ZERO, right: DVec3::Z, up: DVec3::X };
        assert_eq!(floor.normal(), DVec3::Y);
        let corners = crate::geometry::Aabb { min: Vec3::new(-4.0, 0.0, 0.0), max: Vec3::new(4.0, 0.0, 0.0) }.corners();
        assert!((floor.steepness(DVec4::new(0.0, 3.0, 0.0, 1.0), &corners) - 0.6).abs() < 1e-12);
        assert!((floor.steepness(DVec4::new(0.0, -1.0, 0.0, 0.0), &corners) + 1.0).abs() < 1e-12);
        assert_eq!(floor.steepness(DVec4::new(9.0, 0.0, 0.0, 1.0), &corners), 0.0);
    }
}
