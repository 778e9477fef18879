//! Whether two convex bodies can meet: view frusta, occlusion pyramids, casters' boxes, shadow
//! volumes, lights' cones. Every culling decision (M section 6, L "Determining Whether Caps are
//! Necessary") is this one question, and [`Body::may_meet`] errs on one side: it may say yes wrongly,
//! never no.
//!
//! A body is the hull of *places* and of *directions* in which it goes on for ever, so that a view
//! without a far plane and a volume that runs to infinity are as good as any box. Two such bodies are
//! apart when some axis separates them, and it is enough to try the normals of both and the cross
//! products of their edges (the separating axis theorem). How an axis was found does not matter: one
//! that separates the points is proof, and the list need only be good, not complete.
//!
//! ```text
//!        body A                     body B
//!      .--------.               .----------- goes on for ever: along this axis its
//!      |        |               |            interval is [b, infinity)
//!      '--------'               '-----------
//!    --[========]---- room -----[==============>   axis
//! ```
//!
//! The bodies stand for what single precision draws, so they are apart only with some room between
//! them, in proportion to their coordinates.

use arrayvec::ArrayVec;
use glam::{DAffine3, DVec3, DVec4};

use super::Aabb;
use super::footprint::Slab;

/// A convex body in world space, metres; it holds nothing where it has neither places nor directions.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Body {
    /// It is the hull of these,
    points: ArrayVec<DVec3, 16>,
    /// and of these unit directions, each going on for ever from any of the places.
    directions: ArrayVec<DVec3, 8>,
    /// All its facets, outward unit normal and offset (`n.x + w <= 0` inside); none where they are not known.
    facets: ArrayVec<DVec4, 9>,
    /// More axes worth a try, unit or zero.
    axes: ArrayVec<DVec3, 16>,
    /// Directions of its edges, not unit.
    edges: ArrayVec<DVec3, 16>,
}

/// Gaps smaller than this share of the coordinates are none.
pub(super) const ROUNDING: f64 = 1e-5;

/// A direction this nearly square to an axis (unit vectors' dot product) goes neither way along it.
const SQUARE: f64 = 1e-9;

/// The twelve edges of a box, as corners of [`Aabb::corners`].
pub const BOX_EDGES: [[usize; 2]; 12] =
    [[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]];

impl Body {
    /// The box `bounds` of an object's space.
    #[must_use]
    pub fn boxed(bounds: &Aabb, world_from_object: &DAffine3) -> Self {
        if bounds.is_empty() {
            return Self::default();
        }
        let corners = bounds.corners().map(|corner| world_from_object.transform_point3(corner));
        let mut body = Self { points: corners.into_iter().collect(), ..Self::default() };
        body.edges.extend([1, 2, 4].map(|corner| corners[corner] - corners[0]));
        let [a, b, c] = box_axes(&corners);
        for (normal, low, high) in [(a, 0, 1), (b, 0, 2), (c, 0, 4)] {
            let outward = if normal.dot(corners[high] - corners[low]) < 0.0 { -normal } else { normal };
            // Without a normal there is no telling who is inside: the facets would hold too much.
            if normal == DVec3::ZERO {
                body.facets.clear();
                break;
            }
            body.facets.push(facet(outward, corners[high]));
            body.facets.push(facet(-outward, corners[low]));
        }
        body
    }

    /// All that a view sees: from the near rectangle (`corners`, in order around it) away from the
    /// eye, for ever.
    #[must_use]
    pub fn frustum(eye: DVec3, corners: [DVec3; 4]) -> Self {
        let mut body = Self::default();
        body.points.extend(corners);
        body.directions.extend(corners.map(|corner| (corner - eye).normalize_or_zero()));
        body.edges.extend(corners.map(|corner| corner - eye));
        body.edges.extend([corners[1] - corners[0], corners[2] - corners[1]]);
        let inside = (corners[0] + corners[2]) - eye;
        body.sides(corners, |corner| corner - eye, inside);
        body.facets.push(facet_away((corners[1] - corners[0]).cross(corners[2] - corners[1]), corners[0], inside));
        body
    }

    /// All that `eye` sees through a convex window: `window` are its corners in order around it, each on or
    /// before the plane `near` (unit normal away from the eye, under which nothing is seen), `rays` the
    /// ways from the eye through them. At most eight.
    #[must_use]
    pub fn through(eye: DVec3, window: &[DVec3], rays: &[DVec3], near: DVec4) -> Self {
        let mut body = Self::default();
        body.points.extend(window.iter().copied());
        body.directions.extend(rays.iter().map(|ray| ray.normalize_or_zero()));
        body.edges.extend(rays.iter().copied());
        let inside = eye + rays.iter().sum::<DVec3>();
        for (index, ray) in rays.iter().enumerate() {
            // Two rays in one direction span no plane: a facet is missing then, which lets too much in.
            let across = ray.cross(rays[(index + 1) % rays.len()]);
            if let Some(normal) = across.try_normalize() {
                body.facets.push(facet_away(normal, eye, inside));
                body.edges.push(normal.cross(near.truncate()));
            }
        }
        body.facets.push(-near);
        body
    }

    /// The hull of an apex (a place with w = 1, or a direction from the rectangle to infinity with w =
    /// 0) and a rectangle (`corners`, in order around it): the occlusion pyramid between a light and the
    /// near rectangle (M figure 2, L), or what the near plane cuts off the view, its apex being the eye.
    ///
    /// ```text
    ///            ______ near rectangle
    ///            \    /
    ///             \  /   what touches nothing in here throws no shadow on the near rectangle
    ///              \/
    ///            light, before or behind the rectangle
    /// ```
    #[must_use]
    pub fn pyramid(apex: DVec4, corners: [DVec3; 4]) -> Self {
        let mut body = Self::default();
        body.points.extend(corners);
        body.edges.extend([corners[1] - corners[0], corners[2] - corners[1]]);
        let center = (corners[0] + corners[2]) / 2.0;
        let towards = apex.truncate() - center * apex.w;
        if apex.w == 0.0 {
            body.directions.push(towards.normalize_or_zero());
            body.edges.push(towards);
        } else {
            body.points.push(apex.truncate() / apex.w);
            body.edges.extend(corners.map(|corner| apex.truncate() - corner * apex.w));
        }
        let inside = center + towards.normalize_or_zero() * (if apex.w == 0.0 { 1.0 } else { towards.length() * 0.25 });
        body.sides(corners, |corner| apex.truncate() - corner * apex.w, inside);
        body.facets.push(facet_away((corners[1] - corners[0]).cross(corners[2] - corners[1]), corners[0], inside));
        body
    }

    /// The hull of a light (a place with w = 1, or the direction towards it with w = 0), the near rectangle
    /// (`corners`, in order around it) and the eye: the occlusion pyramid (L; M figure 2) and what lies
    /// before the near plane. A caster that does not reach in here shades no point from the eye to the
    /// near rectangle.
    #[must_use]
    pub fn occlusion(light: DVec4, corners: [DVec3; 4], eye: DVec3) -> Self {
        let pyramid = Self::pyramid(light, corners);
        let before = Self::pyramid(eye.extend(1.0), corners);
        let spine = light.truncate() - eye * light.w;
        let mut body = Self { points: pyramid.points.clone(), directions: pyramid.directions.clone(), ..Self::default() };
        body.points.push(eye);
        body.axes.extend(pyramid.facets.iter().chain(&before.facets).map(|facet| facet.truncate()));
        body.axes.extend(corners.map(|corner| (corner - eye).cross(spine).normalize_or_zero()));
        body.edges.extend(pyramid.edges);
        body.edges.extend(corners.map(|corner| corner - eye));
        body.edges.push(spine);
        body
    }

    /// All that a spot light at `apex` with the half angle `outer` (radians) about the unit `axis` shines
    /// on: eight planes about the cone. `None` for cones too wide to be bounded so.
    #[must_use]
    pub fn cone(apex: DVec3, axis: DVec3, outer: f64) -> Option<Self> {
        const WIDEST: f64 = 1.3;
        /// Radians: the shader's cosines are in single precision.
        const MARGIN: f64 = 2e-3;
        const SIDES: usize = 8;
        if !(0.0..WIDEST).contains(&outer) || !apex.is_finite() {
            return None;
        }
        let axis = axis.try_normalize()?;
        let (right, up) = axis.any_orthonormal_pair();
        let tangent = (outer + MARGIN).tan();
        let around = |turn: f64| {
            let (sin, cos) = (std::f64::consts::TAU * turn / SIDES as f64).sin_cos();
            right * cos + up * sin
        };
        let widened = tangent / (std::f64::consts::PI / SIDES as f64).cos();
        let mut body = Self::default();
        body.points.push(apex);
        for side in 0..SIDES {
            let ray = (axis + around(side as f64) * widened).normalize();
            body.directions.push(ray);
            body.edges.push(ray);
            // Halfway to the next ray the plane touches the cone.
            body.facets.push(facet((around(side as f64 + 0.5) - axis * tangent).normalize(), apex));
        }
        Some(body)
    }

    /// The same, no farther from `apex` than `reach` metres along `axis`.
    #[must_use]
    pub fn cone_within(apex: DVec3, axis: DVec3, outer: f64, reach: f64) -> Option<Self> {
        let mut body = Self::cone(apex, axis, outer)?;
        let axis = axis.try_normalize()?;
        if reach.is_finite() {
            let rays = std::mem::take(&mut body.directions);
            body.points.extend(rays.iter().map(|ray| apex + *ray * (reach / ray.dot(axis))));
            // The facets no longer hold it alone.
            body.axes.extend(body.facets.iter().map(|facet| facet.truncate()));
            body.facets.clear();
            body.axes.push(axis);
        }
        Some(body)
    }

    /// The shadow volume's bounds: a caster's box (`corners` as [`Aabb::corners`] orders them, world
    /// space) and all behind it as seen from `light` (a place with w = 1, or the direction towards a
    /// directional light with w = 0), up to the plane `end` where there is one: M's hull of the box and
    /// of the box projected away from the light.
    #[must_use]
    pub fn volume(corners: &[DVec3; 8], light: DVec4, end: Option<DVec4>) -> Self {
        let mut body = Self::volume_hull(corners, light, end);
        body.edges.extend([1, 2, 4].map(|corner| corners[corner] - corners[0]));
        body.axes.extend(box_axes(corners));
        let rays = corners.map(|corner| ray(corner, light));
        let across = |[a, b]: [usize; 2]| (corners[b] - corners[a]).cross(rays[a]).normalize_or_zero();
        body.axes.extend(BOX_EDGES.map(across));
        if light.w == 0.0 {
            body.edges.push(rays[0]);
        } else {
            body.edges.extend(rays);
            body.axes.extend(end.map(|plane| plane.truncate()));
        }
        body
    }

    /// The same places and directions alone: for what asks for its [hull](Self::hull) and compares it with nothing.
    #[must_use]
    pub fn volume_hull(corners: &[DVec3; 8], light: DVec4, end: Option<DVec4>) -> Self {
        let mut body = Self::default();
        body.points.extend(*corners);
        match end {
            _ if light.w == 0.0 => body.directions.push(ray(corners[0], light)),
            Some(plane) => body.points.extend(thrown(corners, light.truncate(), plane)),
            None => body.directions.extend(corners.map(|corner| ray(corner, light))),
        }
        body
    }

    /// The dark cap's bounds: [`Self::volume`]'s far end alone. The one at infinity is given as seen
    /// from the eye, as directions: compare it with [`Self::directions_of`] a view.
    #[must_use]
    pub fn dark_cap(corners: &[DVec3; 8], light: DVec3, end: Option<DVec4>) -> Self {
        let mut body = Self::default();
        match end {
            Some(plane) => {
                body.points.extend(thrown(corners, light, plane));
                body.axes.push(plane.truncate());
            }
            None => body.points.extend(corners.map(|corner| (corner - light).normalize_or_zero())),
        }
        body
    }

    /// All that this body reaches at infinity, as a cone about the origin.
    #[must_use]
    pub fn directions_of(&self) -> Self {
        let mut cone =
            Self { directions: self.directions.clone(), edges: self.directions.iter().copied().collect(), ..Self::default() };
        cone.points.push(DVec3::ZERO);
        let normals = self.facets.iter().map(|facet| facet.truncate());
        cone.axes.extend(normals.filter(|normal| self.directions.iter().all(|way| normal.dot(*way) < SQUARE)));
        cone
    }

    /// Its places, homogeneous: w = 1, and w = 0 for directions in which it goes on for ever.
    pub fn hull(&self) -> impl Iterator<Item = DVec4> + Clone {
        let places = self.points.iter().map(|point| point.extend(1.0));
        places.chain(self.directions.iter().map(|direction| direction.extend(0.0)))
    }

    /// Between each two of its facets that look opposite ways; none where its facets are not known.
    #[must_use]
    pub fn slabs(&self) -> ArrayVec<Slab, 3> {
        let facing = |pair: &[DVec4]| pair[0].truncate() == -pair[1].truncate();
        let pairs = self.facets.chunks_exact(2).filter(|pair| facing(pair));
        pairs.take(3).map(|pair| (pair[0].truncate(), pair[1].w, -pair[0].w)).collect()
    }

    /// The largest of its places' coordinates, metres.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.points.iter().fold(DVec3::ZERO, |largest, point| largest.max(point.abs())).max_element()
    }

    /// The least and greatest of its places' coordinates, metres.
    #[must_use]
    pub fn bounds(&self) -> [DVec3; 2] {
        let none = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        self.points.iter().fold(none, |[min, max], point| [min.min(*point), max.max(*point)])
    }

    /// Whether the two may have a point in common. May say yes wrongly, and does where less than a
    /// hundred-thousandth of their coordinates lies between them; never says no wrongly.
    #[must_use]
    pub fn may_meet(&self, other: &Self) -> bool {
        if self.points.is_empty() || other.points.is_empty() {
            return false;
        }
        // Most that meet are seen to at once.
        if self.holds_some_of(other) || other.holds_some_of(self) {
            return true;
        }
        let places = self.points.iter().chain(&other.points);
        let room = ROUNDING * places.fold(DVec3::ZERO, |largest, point| largest.max(point.abs())).max_element();
        let separates = |axis: DVec3| {
            let ([low, high], [other_low, other_high]) = (self.along(axis), other.along(axis));
            other_low - high > room || low - other_high > room
        };
        let crossed = || {
            let pairs = self.edges.iter().flat_map(|a| other.edges.iter().map(|b| a.cross(*b)));
            pairs.filter_map(DVec3::try_normalize)
        };
        !(self.normals().chain(other.normals()).any(separates) || crossed().any(separates))
    }

    fn normals(&self) -> impl Iterator<Item = DVec3> {
        self.facets.iter().map(|facet| facet.truncate()).chain(self.axes.iter().copied())
    }

    /// Where it lies along an axis, least and greatest.
    fn along(&self, axis: DVec3) -> [f64; 2] {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for point in &self.points {
            let at = axis.dot(*point);
            // A place that is no number keeps everything from being apart.
            if at.is_nan() {
                return [f64::NEG_INFINITY, f64::INFINITY];
            }
            low = low.min(at);
            high = high.max(at);
        }
        for direction in &self.directions {
            let way = axis.dot(*direction);
            if way.is_nan() || way > SQUARE {
                high = f64::INFINITY;
            }
            if way.is_nan() || way < -SQUARE {
                low = f64::NEG_INFINITY;
            }
        }
        [low, high]
    }

    fn holds_some_of(&self, other: &Self) -> bool {
        let holds = |point: &DVec3| self.facets.iter().all(|facet| facet.truncate().dot(*point) + facet.w <= 0.0);
        !self.facets.is_empty() && other.points.iter().any(holds)
    }

    /// Facets through neighbouring corners of a rectangle and the edges that `edge` says leave them.
    fn sides(&mut self, corners: [DVec3; 4], edge: impl Fn(DVec3) -> DVec3, inside: DVec3) {
        for (a, b) in (0..4).map(|side| (corners[side], corners[(side + 1) % 4])) {
            self.facets.push(facet_away((b - a).cross(edge(a)), a, inside));
        }
    }
}

/// The way from a light past a corner: unit.
fn ray(corner: DVec3, light: DVec4) -> DVec3 {
    (corner * light.w - light.truncate()).normalize_or_zero()
}

/// The plane through `on`, its unit normal towards where `inside` is not.
fn facet_away(normal: DVec3, on: DVec3, inside: DVec3) -> DVec4 {
    let normal = normal.normalize_or_zero();
    facet(if normal.dot(inside - on) > 0.0 { -normal } else { normal }, on)
}

fn facet(normal: DVec3, on: DVec3) -> DVec4 {
    normal.extend(-normal.dot(on))
}

/// Square to the faces of a box that may be sheared: unit, or zero for a box that is a line or a point.
fn box_axes(corners: &[DVec3; 8]) -> [DVec3; 3] {
    let [a, b, c] = [1, 2, 4].map(|corner| corners[corner] - corners[0]);
    // A box without height is bounded by the planes through its rim and square to it.
    let [a, b, c] = match [a, b, c].map(|edge| edge == DVec3::ZERO) {
        [true, false, false] => [b.cross(c), b, c],
        [false, true, false] => [a, c.cross(a), c],
        [false, false, true] => [a, b, a.cross(b)],
        _ => [a, b, c],
    };
    [b.cross(c), c.cross(a), a.cross(b)].map(DVec3::normalize_or_zero)
}

/// Each corner where its ray from the light meets the plane; all rays run towards it.
pub(super) fn thrown(corners: &[DVec3; 8], light: DVec3, plane: DVec4) -> [DVec3; 8] {
    let height = -(plane.truncate().dot(light) + plane.w);
    corners.map(|corner| light + (corner - light) * (height / plane.truncate().dot(corner - light)))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails may panic")]
    use super::*;
    use glam::Vec3;

    fn cube(at: DVec3, half: f32) -> Body {
        Body::boxed(&Aabb { min: Vec3::splat(-half), max: Vec3::splat(half) }, &DAffine3::from_translation(at))
    }

    fn corners(at: DVec3, half: f64) -> [DVec3; 8] {
        Aabb { min: Vec3::NEG_ONE, max: Vec3::ONE }.corners().map(|corner| at + corner * half)
    }

    /// At the origin, looking along -Z, a right angle high and wide, the near plane at 1 m.
    fn view() -> Body {
        Body::frustum(DVec3::ZERO, near_rectangle())
    }

    fn near_rectangle() -> [DVec3; 4] {
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| DVec3::new(x, y, -1.0))
    }

    #[test]
    fn a_view_sees_what_is_in_it_however_far() {
        for (at, seen) in [
            (DVec3::new(0.0, 0.0, -5.0), true),
            (DVec3::new(0.0, 0.0, -1e6), true),
            (DVec3::new(1e6 - 0.4, 0.0, -1e6), true),
            (DVec3::new(5.4, 0.0, -5.0), true),
            (DVec3::new(6.1, 0.0, -5.0), false),
            (DVec3::new(0.0, 0.0, -0.4), false),
            (DVec3::new(0.0, 0.0, 5.0), false),
            (DVec3::new(0.0, 7.0, -5.0), false),
        ] {
            assert_eq!(view().may_meet(&cube(at, 0.5)), seen, "{at}");
            assert_eq!(cube(at, 0.5).may_meet(&view()), seen, "{at}, asked the other way");
        }
        assert!(view().may_meet(&cube(DVec3::ZERO, 50.0)), "all about the eye");
        assert!(!view().may_meet(&Body::default()));
    }

    #[test]
    fn crossed_edges_tell_apart_what_no_face_does() {
        let turned = |angle: f64, at: DVec3| {
            let long = Aabb { min: Vec3::new(-5.0, -0.5, -0.5), max: Vec3::new(5.0, 0.5, 0.5) };
            let roll = DAffine3::from_rotation_x(std::f64::consts::FRAC_PI_4);
            Body::boxed(&long, &(DAffine3::from_translation(at) * DAffine3::from_rotation_y(angle) * roll))
        };
        let half_diagonal = 0.5f64.sqrt();
        let lower = turned(0.0, DVec3::ZERO);
        let apart = turned(1.2, DVec3::Y * (2.0 * half_diagonal + 0.01));
        let close = turned(1.2, DVec3::Y * (2.0 * half_diagonal - 0.01));
        assert!(!lower.may_meet(&apart) && lower.may_meet(&close), "two bars, edge on edge");
    }

    #[test]
    fn a_volume_runs_away_from_its_light() {
        let light = DVec4::new(0.0, 10.0, 0.0, 1.0);
        let caster = corners(DVec3::new(0.0, 5.0, 0.0), 0.5);
        let endless = Body::volume(&caster, light, None);
        let floor = DVec4::new(0.0, -1.0, 0.0, 0.0);
        let ended = Body::volume(&caster, light, Some(floor));
        for (at, in_endless, in_ended) in [
            (DVec3::new(0.0, 2.0, 0.0), true, true),
            (DVec3::new(0.0, -50.0, 0.0), true, false),
            (DVec3::new(0.0, 7.0, 0.0), false, false),
            (DVec3::new(1.5, 0.2, 0.0), false, false),
            (DVec3::new(1.1, 0.1, 0.0), true, true),
            (DVec3::new(10.0, -90.0, 0.0), true, false),
            (DVec3::new(12.0, -90.0, 0.0), false, false),
        ] {
            assert_eq!(endless.may_meet(&cube(at, 0.05)), in_endless, "{at}");
            assert_eq!(ended.may_meet(&cube(at, 0.05)), in_ended, "{at}, ended on the floor");
        }
        let sun = Body::volume(&caster, DVec4::new(0.0, 1.0, 0.0, 0.0), None);
        assert!(sun.may_meet(&cube(DVec3::new(0.4, -500.0, 0.0), 0.05)));
        assert!(!sun.may_meet(&cube(DVec3::new(0.6, -500.0, 0.0), 0.05)));
        let around = Body::volume(&corners(DVec3::Y * 10.0, 1.0), light, None);
        assert!(around.may_meet(&cube(DVec3::new(3.0, 50.0, 9.0), 0.1)), "a light in the caster throws every way");
    }

    #[test]
    fn an_occlusion_pyramid_lies_between_light_and_near_rectangle() {
        let before = Body::pyramid(DVec4::new(0.0, 0.0, -11.0, 1.0), near_rectangle());
        let behind = Body::pyramid(DVec4::new(0.0, 0.0, 9.0, 1.0), near_rectangle());
        let sun = Body::pyramid(DVec4::new(0.0, 0.0, 1.0, 0.0), near_rectangle());
        for (at, in_before, in_behind, in_sun) in [
            (DVec3::new(0.0, 0.0, -6.0), true, false, false),
            (DVec3::new(0.7, 0.0, -6.0), false, false, false),
            (DVec3::new(0.0, 0.0, 4.0), false, true, true),
            (DVec3::new(0.0, 0.0, 40.0), false, false, true),
            (DVec3::new(0.9, 0.9, 4.0), false, false, true),
            (DVec3::new(1.2, 0.9, 4.0), false, false, false),
            (DVec3::new(0.0, 0.0, -1.0), true, true, true),
        ] {
            assert_eq!(before.may_meet(&cube(at, 0.1)), in_before, "{at}, light before");
            assert_eq!(behind.may_meet(&cube(at, 0.1)), in_behind, "{at}, light behind");
            assert_eq!(sun.may_meet(&cube(at, 0.1)), in_sun, "{at}, sun behind");
        }
        let flat = Body::pyramid(DVec4::new(5.0, 0.0, -1.0, 1.0), near_rectangle());
        assert!(flat.may_meet(&cube(DVec3::new(3.0, 0.0, -1.0), 0.1)), "a light in the near plane");
        assert!(!flat.may_meet(&cube(DVec3::new(3.0, 0.0, -2.0), 0.1)));
    }

    #[test]
    fn a_cone_is_closed_in_by_eight_planes() {
        let cone = Body::cone(DVec3::ZERO, DVec3::NEG_Y, 0.5).unwrap();
        let at = |angle: f64, turn: f64| DVec3::new(angle.sin() * turn.cos(), -angle.cos(), angle.sin() * turn.sin()) * 100.0;
        for turn in 0..32 {
            let turn = f64::from(turn) * 0.2;
            assert!(cone.may_meet(&cube(at(0.5, turn), 0.01)), "{turn}");
            assert!(!cone.may_meet(&cube(at(0.6, turn), 0.01)), "{turn}");
        }
        assert!(!cone.may_meet(&cube(DVec3::Y, 0.1)));
        let short = Body::cone_within(DVec3::ZERO, DVec3::NEG_Y, 0.5, 10.0).unwrap();
        assert!(short.may_meet(&cube(DVec3::Y * -9.0, 0.1)) && !short.may_meet(&cube(DVec3::Y * -11.0, 0.1)));
        assert_eq!(Body::cone(DVec3::ZERO, DVec3::X, 1.5), None);
    }

    #[test]
    fn a_dark_cap_at_infinity_is_seen_in_its_direction() {
        let sky = view().directions_of();
        let cap = |light: DVec3| Body::dark_cap(&corners(DVec3::ZERO, 0.1), light, None);
        assert!(sky.may_meet(&cap(DVec3::new(0.0, 0.0, 9.0))), "thrown along the view");
        assert!(!sky.may_meet(&cap(DVec3::new(0.0, 0.0, -9.0))), "thrown behind the eye");
        assert!(!sky.may_meet(&cap(DVec3::new(-9.0, 0.0, 0.0))), "thrown aside");
        assert!(sky.may_meet(&cap(DVec3::new(0.0, 0.0, 0.0))), "thrown every way");
        let floor = Body::dark_cap(
            &corners(DVec3::new(0.0, 0.0, -5.0), 0.1),
            DVec3::new(0.0, 9.0, -5.0),
            Some(DVec4::new(0.0, -1.0, 0.0, -4.0)),
        );
        assert!(view().may_meet(&floor));
        assert!(!view().may_meet(&Body::dark_cap(
            &corners(DVec3::new(0.0, 0.0, 5.0), 0.1),
            DVec3::new(0.0, 9.0, 5.0),
            Some(DVec4::new(0.0, -1.0, 0.0, -4.0))
        )));
    }

    #[test]
    fn a_floor_without_height_ends_at_its_rim() {
        let flat = Aabb { min: Vec3::new(-2.0, 0.0, -2.0), max: Vec3::new(2.0, 0.0, 2.0) };
        let floor = Body::boxed(&flat, &DAffine3::from_rotation_y(0.3));
        assert!(floor.may_meet(&cube(DVec3::ZERO, 0.1)) && !floor.may_meet(&cube(DVec3::Y, 0.1)));
        assert!(!floor.may_meet(&cube(DVec3::X * 4.0, 0.1)), "beside it, in its plane");
    }

    #[test]
    fn what_is_no_number_is_never_apart() {
        let spoiled = Body::volume(&[DVec3::NAN; 8], DVec4::new(0.0, 1.0, 0.0, 1.0), None);
        assert!(view().may_meet(&spoiled));
    }
}
