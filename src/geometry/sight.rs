//! What a view sees through the mirrors on its way: the eye reflected, the outline of the last mirror as it
//! is seen, the mirror's plane.
//!
//! ```text
//!        \   seen   /
//!         \        /
//!     -----\======/----- mirror's plane: nothing behind it is reflected
//!           \    /
//!            \  /        the eye's picture of the mirror bounds what is seen in it, so the view
//!             \/         through it is a pyramid with the mirror for a window
//!        reflected eye
//! ```
//!
//! K section 3 asks for "a conservative reflection frustum". All views of one frame share the picture:
//! reflected in each mirror of its path, the last one first, a point falls on the very pixel where the eye
//! sees it. So a frustum is an outline on the picture, the same kind of thing at every depth, and a mirror
//! is cut by its lines before the mirror's own outline takes their place.
//!
//! What is kept errs on one side: a mirror may be said to show where it does not, never the reverse. An
//! outline is wider than what was seen by a quarter of a pixel and by what single precision may have moved
//! the corners.

use glam::{DAffine3, DMat3, DMat4, DVec2, DVec3, DVec4};

use super::planar::{height, reflection, transformed};
use super::{Body, clip};

/// One view: what is drawn by `clip_from_world` within `outline` and over `near`.
#[derive(Debug, Clone, PartialEq)]
pub struct Sight {
    /// The eye after the reflections, world space.
    pub eye: DVec3,
    /// Reflects the world in the mirrors of the path, the last first, and projects it: reverse-Z.
    pub clip_from_world: DMat4,
    /// How often the way from the eye was reflected. Where that is odd, what ran counter-clockwise on
    /// screen runs clockwise.
    pub bounces: usize,
    /// World space, unit normal away from the eye: the mirror's plane, nothing under which is seen. For
    /// the eye itself the near plane.
    pub near: DVec4,
    /// All that is seen lies within: convex, in pixels from the top left, at most [`Self::CORNERS`].
    pub outline: Vec<DVec2>,
    /// The picture's, pixels.
    pub size: [u32; 2],
}

/// A mirror as a view sees it, and the view in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Reflected {
    /// What is seen in the mirror.
    pub sight: Sight,
    /// Takes the eye before the mirror to the one that looks through it.
    pub turn: DAffine3,
    /// What of each of the mirror's triangles is in view, world space.
    pub polygons: Vec<Vec<DVec3>>,
    /// Pixels that `polygons` cover; nothing else hides them yet.
    pub area: f64,
}

/// Of coordinates: what single precision may do to a vertex on its way to the picture.
const ROUNDING: f64 = 1e-6;

impl Sight {
    /// Of an outline.
    pub const CORNERS: usize = 8;

    /// What the eye itself sees, in a picture of `size` pixels.
    #[must_use]
    pub fn of_eye(eye: DVec3, clip_from_world: DMat4, size: [u32; 2]) -> Self {
        let near = clip_from_world.row(3) - clip_from_world.row(2);
        let [width, height] = size.map(f64::from);
        let outline = [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]].map(DVec2::from).to_vec();
        Self { eye, clip_from_world, bounces: 0, near: near / near.truncate().length(), outline, size }
    }

    /// The mirror of these triangles (world space) on `plane`, which reflects on the side of its normal or,
    /// with `both_sides`, on either; `None` where this view cannot see it. The mirror this view looks
    /// through must not be asked for.
    #[must_use]
    pub fn reflected(&self, triangles: &[[DVec3; 3]], plane: DVec4, both_sides: bool) -> Option<Reflected> {
        self.through(triangles, plane, both_sides, None)
    }

    /// The same through a portal, whose `turn` takes the eye before it to behind its other doorway.
    #[must_use]
    pub fn through(&self, triangles: &[[DVec3; 3]], plane: DVec4, both_sides: bool, turn: Option<DAffine3>) -> Option<Reflected> {
        let over = height(plane, self.eye);
        let (plane, over) = if both_sides && over < 0.0 { (-plane, -over) } else { (plane, over) };
        let corners = triangles.as_flattened();
        let largest = corners.iter().fold(self.eye.abs(), |largest, corner| largest.max(corner.abs())).max_element();
        let room = ROUNDING * largest;
        if over.is_nan() || over < -room || !largest.is_finite() {
            return None;
        }
        let planes = self.planes(room);
        let cut = triangles.iter().map(|triangle| clip::clipped(triangle, &planes));
        let polygons: Vec<_> = cut.filter(|polygon| !polygon.is_empty()).collect();
        // A mirror on the plane of the one looked through is beside it, not in it.
        let behind = |corner: &DVec3| self.bounces > 0 && height(self.near, *corner) <= room;
        if polygons.iter().flatten().all(behind) {
            return None;
        }

        let [across, down, depth] = self.rows();
        let mut nearest = f64::INFINITY;
        let mut seen = |point: &DVec3| {
            let point = point.extend(1.0);
            let w = depth.dot(point);
            nearest = nearest.min(w);
            DVec2::new(across.dot(point), down.dot(point)) / w
        };
        let on_screen: Vec<Vec<DVec2>> = polygons.iter().map(|polygon| polygon.iter().map(&mut seen).collect()).collect();
        let size = f64::from(self.size[0].max(self.size[1]));
        let weight = |row: DVec4| corners.iter().map(|corner| row.abs().dot(corner.abs().extend(1.0))).fold(0.0, f64::max);
        let moved = ROUNDING * (weight(across) + weight(down) + weight(depth) * size) / nearest;
        let hull = clip::hull(&mut on_screen.concat());
        let near = turn.map_or(plane, |turn| -transformed(plane, &turn));
        let turn = turn.unwrap_or_else(|| reflection(plane));
        let sight = Self {
            eye: turn.transform_point3(self.eye),
            clip_from_world: self.clip_from_world * DMat4::from(turn.inverse()),
            bounces: self.bounces + 1,
            near,
            outline: widened(&hull, 0.25 + moved)?,
            size: self.size,
        };
        sight.rect()?;
        Some(Reflected { sight, turn, area: on_screen.iter().map(|polygon| clip::area(polygon).abs()).sum(), polygons })
    }

    /// The pixels (x, y, width, height from the top left) within the outline's bounds; `None` where there
    /// are none.
    #[must_use]
    pub fn rect(&self) -> Option<[u32; 4]> {
        let size = DVec2::from(self.size.map(f64::from));
        let bounds = self
            .outline
            .iter()
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), corner| (low.min(*corner), high.max(*corner)));
        let (low, high) = (bounds.0.floor().clamp(DVec2::ZERO, size), bounds.1.ceil().clamp(DVec2::ZERO, size));
        let extent = high - low;
        (extent.min_element() >= 1.0).then_some([low.x as u32, low.y as u32, extent.x as u32, extent.y as u32])
    }

    /// Planes over which all lies that is seen, in world space, not unit: the outline's edges, and the near
    /// plane. Things and casters are better asked of [`Self::body`].
    #[must_use]
    pub fn planes(&self, room: f64) -> Vec<DVec4> {
        let [across, down, depth] = self.rows();
        let line = |line: DVec3| across * line.x + down * line.y + depth * line.z;
        let mut planes: Vec<DVec4> = edges(&self.outline).map(line).collect();
        // Before the near plane there is no picture, nor a place on it.
        planes.push(depth * (1.0 + ROUNDING) - self.clip_from_world.row(2));
        if self.bounces > 0 {
            planes.push(self.near + DVec4::W * room);
        }
        planes
    }

    /// All that the view can see, for ever: what does not meet it (things, casters' volumes) may be left out.
    #[must_use]
    pub fn body(&self) -> Body {
        /// Metres along the view: a window farther away bounds nothing that single precision could tell.
        const FARTHEST: f64 = 1e4;
        let rows = self.rows().map(DVec4::truncate);
        let ray_of_pixel = DMat3::from_cols(rows[0], rows[1], rows[2]).transpose().inverse();
        // Each reaches one metre along the view.
        let rays: Vec<DVec3> = self.outline.iter().map(|corner| ray_of_pixel * corner.extend(1.0)).collect();
        let picture = self.clip_from_world.row(3) - self.clip_from_world.row(2);
        let meets = |plane: DVec4, ray: DVec3| {
            let towards = plane.truncate().dot(ray);
            let at = -height(plane, self.eye) / towards;
            (towards > 0.0 && (0.0..FARTHEST).contains(&at)).then_some(at)
        };
        // A ray that misses the mirror's plane bounds the window wherever it is cut: here at the near plane.
        let at = |&ray: &DVec3| self.eye + ray * meets(self.near, ray).or_else(|| meets(picture, ray)).unwrap_or(0.0);
        let window: Vec<DVec3> = rays.iter().map(at).collect();
        Body::through(self.eye, &window, &rays, self.near)
    }

    /// Homogeneous pixels from the top left: across, down, and what both are divided by.
    fn rows(&self) -> [DVec4; 3] {
        let row = |index| self.clip_from_world.row(index);
        let [width, height] = self.size.map(f64::from);
        [(row(3) + row(0)) * (width / 2.0), (row(3) - row(1)) * (height / 2.0), row(3)]
    }
}

/// How many times the scene is drawn at most for this many mirrors and bounces, where every mirror shows in
/// every other (K section 3): `1 + n` times the sum of `(n - 1)^(i - 1)` for i from 1 to r.
#[must_use]
pub fn worst_case(mirrors: usize, bounces: u32) -> u64 {
    let mirrors = mirrors as u64;
    if mirrors == 0 {
        return 1;
    }
    let paths = (0..bounces).map(|bounce| (mirrors - 1).saturating_pow(bounce));
    paths.fold(0u64, u64::saturating_add).saturating_mul(mirrors).saturating_add(1)
}

/// Pixels: corners closer than this are one, for the edge between them may have any direction. A corner that two polygons
/// share has a place of its own in each, the last digits apart.
const ONE_CORNER: f64 = 1e-3;

/// The lines of a polygon's edges, `a x + b y + c >= 0` within, (a, b) unit. Edges that hardly are any bound nothing.
fn edges(polygon: &[DVec2]) -> impl Iterator<Item = DVec3> {
    polygon.iter().enumerate().filter_map(|(index, &a)| {
        let along = polygon[(index + 1) % polygon.len()] - a;
        let inward = along.perp().try_normalize().filter(|_| along.length() > ONE_CORNER)?;
        Some(inward.extend(-inward.dot(a)))
    })
}

/// A convex outline `room` pixels about a hull, which may be a line or a point.
fn widened(hull: &[DVec2], room: f64) -> Option<Vec<DVec2>> {
    if !(room.is_finite() && hull.iter().all(|corner| corner.is_finite())) {
        return None;
    }
    let low = hull.iter().copied().reduce(DVec2::min)?;
    let high = hull.iter().copied().reduce(DVec2::max)?;
    // The edges moved outward meet farther out than their own way, in sharp corners much farther.
    let (low, high) = (low - 4.0 * room, high + 4.0 * room);
    let box_about = vec![low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
    let mut outline = edges(hull).fold(box_about, |outline, line| clip::cut(&outline, line + DVec3::Z * room));
    outline.dedup_by(|next, corner| next.distance(*corner) <= ONE_CORNER);
    if let [first, .., last] = outline[..]
        && first.distance(last) <= ONE_CORNER
    {
        outline.pop();
    }
    Some(clip::simplified(outline, Sight::CORNERS))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails may panic")]
    use super::*;
    use crate::geometry::Aabb;
    use glam::{DAffine3, Vec3};

    const SIZE: [u32; 2] = [400, 200];

    /// At the origin, looking along -Z, a right angle high.
    fn eye() -> Sight {
        let clip = glam::dcamera::rh::proj::directx::perspective_infinite_reverse(std::f64::consts::FRAC_PI_2, 2.0, 0.1);
        Sight::of_eye(DVec3::ZERO, clip, SIZE)
    }

    /// A rectangle about `at`, spanned by two half sides; it faces along their cross product.
    fn pane(at: DVec3, right: DVec3, up: DVec3) -> (Vec<[DVec3; 3]>, DVec4) {
        let [a, b, c, d] = [at - right - up, at + right - up, at + right + up, at - right + up];
        let normal = right.cross(up).normalize();
        (vec![[a, b, c], [a, c, d]], normal.extend(-normal.dot(at)))
    }

    fn sees(sight: &Sight, at: DVec3) -> bool {
        let half = Aabb { min: Vec3::splat(-0.01), max: Vec3::splat(0.01) };
        sight.body().may_meet(&Body::boxed(&half, &DAffine3::from_translation(at)))
    }

    #[test]
    fn a_mirror_is_a_window_into_the_reflected_room() {
        let (triangles, plane) = pane(DVec3::new(0.0, 0.0, -5.0), DVec3::X, DVec3::Y);
        let found = eye().reflected(&triangles, plane, false).unwrap();
        assert!((found.area - 1600.0).abs() < 1e-6, "40 by 40 pixels, not {}", found.area);
        assert_eq!(found.sight.rect(), Some([179, 79, 42, 42]), "a quarter of a pixel more on each side");
        assert_eq!(found.sight.eye, DVec3::new(0.0, 0.0, -10.0));
        assert!(sees(&found.sight, DVec3::new(0.0, 0.0, 3.0)) && sees(&found.sight, DVec3::new(2.5, 0.0, 3.0)));
        assert!(!sees(&found.sight, DVec3::new(2.8, 0.0, 3.0)), "beside the window");
        assert!(!sees(&found.sight, DVec3::new(0.0, 0.0, -5.2)), "behind the mirror");
        assert!(!sees(&found.sight, DVec3::new(1.3, 0.0, -4.9)), "beside it, at its edge");
    }

    #[test]
    fn mirrors_that_cannot_be_seen_give_no_view() {
        let [right, up] = [DVec3::X, DVec3::Y];
        for (at, right, up, why) in [
            (DVec3::new(0.0, 0.0, -5.0), right, -up, "its back"),
            (DVec3::new(0.0, 0.0, 5.0), right, -up, "behind the eye"),
            (DVec3::new(12.0, 0.0, -5.0), right, up, "beside the picture"),
            (DVec3::new(0.0, 0.0, -0.05), right * 0.01, up * 0.01, "before the near plane"),
        ] {
            let (triangles, plane) = pane(at, right, up);
            assert!(eye().reflected(&triangles, plane, false).is_none(), "{why}");
        }
        let (triangles, plane) = pane(DVec3::new(0.0, 0.0, -5.0), right, -up);
        let both = eye().reflected(&triangles, plane, true).unwrap();
        assert_eq!(both.sight.near, -plane, "turned to the side that is seen");
    }

    #[test]
    fn two_walls_show_each_other_without_end_but_no_mirror_itself() {
        let left = pane(DVec3::new(-2.0, 0.0, -21.0), DVec3::NEG_Z * 20.0, DVec3::Y);
        let right = pane(DVec3::new(2.0, 0.0, -21.0), DVec3::Z * 20.0, DVec3::Y);
        let walls = [&left, &right];
        let mut sight = eye();
        let mut width = u32::MAX;
        for bounce in 0..8 {
            let (triangles, plane) = walls[bounce % 2];
            let found = sight.reflected(triangles, *plane, false).unwrap();
            assert!(found.sight.reflected(triangles, *plane, false).is_none(), "in itself");
            assert_eq!(found.sight.bounces, bounce + 1);
            let [_, _, narrower, _] = found.sight.rect().unwrap();
            assert!(narrower <= width, "{narrower} after {width}");
            (sight, width) = (found.sight, narrower);
        }
        assert!((sight.eye.x - 32.0).abs() < 1e-9, "each pair of bounces moves it by twice the room's width");
    }

    #[test]
    fn a_mirror_on_the_same_plane_is_beside_it() {
        let (triangles, plane) = pane(DVec3::new(0.0, 0.0, -5.0), DVec3::X, DVec3::Y);
        let through = eye().reflected(&triangles, plane, true).unwrap().sight;
        let (larger, same) = pane(DVec3::new(0.5, 0.0, -5.0), DVec3::X * 2.0, DVec3::Y);
        assert!(through.reflected(&larger, same, true).is_none());
    }

    #[test]
    fn an_eye_on_the_glass_still_sees() {
        for distance in [0.2, 0.1001, 1e-3, 1e-9, 0.0] {
            // A wall beside the eye, seen the more obliquely the nearer it is.
            let (triangles, plane) = pane(DVec3::new(-distance, 0.0, -3.0), DVec3::NEG_Z * 4.0, DVec3::Y * 2.0);
            let found = eye().reflected(&triangles, plane, false).unwrap();
            assert!(found.sight.rect().is_some(), "{distance}");
            assert!(found.sight.body().may_meet(&Body::boxed(
                &Aabb { min: Vec3::new(0.0, -1.0, -4.0), max: Vec3::new(5.0, 1.0, -3.0) },
                &DAffine3::IDENTITY
            )));
        }
    }

    /// As the clipper leaves them: corners on the edges, and each corner twice, some last digits apart.
    #[test]
    fn an_outline_holds_corners_that_nearly_coincide() {
        let mut random = fastrand::Rng::with_seed(11);
        for _ in 0..2000 {
            let corner = |random: &mut fastrand::Rng| DVec2::new(random.f64() * 60.0, random.f64() * 40.0);
            let [a, b, c] = [corner(&mut random), corner(&mut random), corner(&mut random)];
            let (on_ab, on_bc) = (a + (b - a) * random.f64(), b + (c - b) * random.f64());
            let points = [a, b, c, on_ab, on_bc];
            let near = |point: DVec2, random: &mut fastrand::Rng| {
                point * (1.0 + DVec2::new(random.f64() - 0.5, random.f64() - 0.5) * 8.0 * f64::EPSILON)
            };
            let mut given: Vec<_> = points.iter().flat_map(|&point| [point, near(point, &mut random)]).collect();
            let outline = widened(&clip::hull(&mut given), 0.25).unwrap();
            for (line, point) in edges(&outline).flat_map(|line| points.map(|point| (line, point))) {
                assert!(line.dot(point.extend(1.0)) > 0.2, "{point} of {points:?} is not in {outline:?}");
            }
        }
    }

    #[test]
    fn the_worst_case_is_kilgards() {
        assert_eq!([worst_case(3, 2), worst_case(5, 4)], [10, 426], "his own two examples");
        assert_eq!([worst_case(0, 5), worst_case(1, 5), worst_case(2, 8), worst_case(6, 0)], [1, 2, 17, 1]);
        assert_eq!(worst_case(1000, 60), u64::MAX);
    }
}
