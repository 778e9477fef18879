//! Boxes: what holds a mesh, and what may be skipped because it holds nothing of interest.

use glam::{DAffine3, DVec3, Vec3};

/// An axis-aligned box; empty (min > max) by default.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aabb {
    /// Smallest corner.
    pub min: Vec3,
    /// Largest corner.
    pub max: Vec3,
}

impl Default for Aabb {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl Aabb {
    /// Holds nothing; the union with it changes nothing.
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The smallest box that holds all of `points`.
    #[must_use]
    pub fn from_points(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |held, point| Self { min: held.min.min(point), max: held.max.max(point) })
    }

    /// Holds nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The middle; the origin for an empty box.
    #[must_use]
    pub fn center(&self) -> Vec3 {
        // Halved first: the sum of two large corners would overflow.
        if self.is_empty() { Vec3::ZERO } else { self.min * 0.5 + self.max * 0.5 }
    }

    /// From the middle to a corner, per axis; zero for an empty box.
    #[must_use]
    pub fn half_size(&self) -> Vec3 {
        if self.is_empty() { Vec3::ZERO } else { self.max * 0.5 - self.min * 0.5 }
    }

    /// Of the sphere about the middle that holds the box.
    #[must_use]
    pub fn radius(&self) -> f32 {
        self.half_size().length()
    }

    /// The smallest box that holds both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Lies within the box or on it.
    #[must_use]
    pub fn contains(&self, point: DVec3) -> bool {
        point.cmpge(self.min.as_dvec3()).all() && point.cmple(self.max.as_dvec3()).all()
    }

    /// The eight corners; all infinite for an empty box.
    #[must_use]
    pub fn corners(&self) -> [DVec3; 8] {
        let (min, max) = (self.min.as_dvec3(), self.max.as_dvec3());
        std::array::from_fn(|corner| {
            let pick = |bit: usize, low: f64, high: f64| if corner & bit == 0 { low } else { high };
            DVec3::new(pick(1, min.x, max.x), pick(2, min.y, max.y), pick(4, min.z, max.z))
        })
    }

    /// A box in the target space that holds this one: rounded outwards, so that it holds the
    /// transformed points whatever the rounding.
    #[must_use]
    pub fn transformed(&self, target_from_source: &DAffine3) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        let mut min = DVec3::INFINITY;
        let mut max = DVec3::NEG_INFINITY;
        for corner in self.corners() {
            let corner = target_from_source.transform_point3(corner);
            min = min.min(corner);
            max = max.max(corner);
        }
        Self::around(min, max)
    }

    /// The box of single precision about one of double precision.
    #[must_use]
    pub fn around(min: DVec3, max: DVec3) -> Self {
        let down = |value: f64| {
            let near = value as f32;
            if f64::from(near) > value { near.next_down() } else { near }
        };
        let up = |value: f64| {
            let near = value as f32;
            if f64::from(near) < value { near.next_up() } else { near }
        };
        Self { min: Vec3::new(down(min.x), down(min.y), down(min.z)), max: Vec3::new(up(max.x), up(max.y), up(max.z)) }
    }

    /// Metres from `point` to the nearest point of the box; 0 inside, infinite for an empty box.
    #[must_use]
    pub fn distance_to(&self, point: DVec3) -> f64 {
        if self.is_empty() {
            return f64::INFINITY;
        }
        point.distance(point.clamp(self.min.as_dvec3(), self.max.as_dvec3()))
    }

    /// Whether any of `origin + s * towards`, 0 <= s <= `reach` (which may be infinite), lies in
    /// the box. May say yes wrongly (within a millionth of the coordinates' size), never no.
    #[must_use]
    pub fn meets_segment(&self, origin: DVec3, towards: DVec3, reach: f64) -> bool {
        if self.is_empty() {
            return false;
        }
        let (min, max) = (self.min.as_dvec3(), self.max.as_dvec3());
        let grown = 1e-6 * origin.abs().max(min.abs()).max(max.abs()).max_element();
        let (mut from, mut to) = (0.0f64, reach);
        for axis in 0..3 {
            let (low, high) = (min[axis] - grown - origin[axis], max[axis] + grown - origin[axis]);
            if towards[axis] == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return false;
                }
                continue;
            }
            let (a, b) = (low / towards[axis], high / towards[axis]);
            from = from.max(a.min(b));
            to = to.min(a.max(b));
        }
        from <= to
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    #[test]
    fn the_empty_box_holds_nothing_and_adds_nothing() {
        let unit = Aabb::from_points([Vec3::ZERO, Vec3::ONE]);
        assert!(Aabb::default().is_empty());
        assert_eq!(Aabb::EMPTY.union(&unit), unit);
        assert_eq!(Aabb::EMPTY.center(), Vec3::ZERO);
        assert_eq!(Aabb::EMPTY.distance_to(DVec3::ZERO), f64::INFINITY);
        assert!(Aabb::EMPTY.transformed(&DAffine3::IDENTITY).is_empty());
        assert!(!Aabb::from_points([Vec3::ONE]).is_empty(), "one point is a box");
    }

    #[test]
    fn distances_reach_from_the_nearest_point() {
        let unit = Aabb::from_points([Vec3::ZERO, Vec3::ONE]);
        assert_eq!(unit.distance_to(DVec3::new(0.5, 0.2, 1.0)), 0.0);
        assert_eq!(unit.distance_to(DVec3::new(4.0, 5.0, 0.5)), 5.0);
        assert!((f64::from(unit.radius()) - 0.75f64.sqrt()).abs() < 1e-6);
    }

    #[test]
    fn segments_meet_what_they_reach() {
        let unit = Aabb::from_points([Vec3::ZERO, Vec3::ONE]);
        let from = DVec3::new(-1.0, 0.5, 0.5);
        assert!(unit.meets_segment(from, DVec3::X, f64::INFINITY));
        assert!(unit.meets_segment(from, DVec3::X, 1.0), "it ends on the face");
        assert!(!unit.meets_segment(from, DVec3::X, 0.9));
        assert!(!unit.meets_segment(from, DVec3::NEG_X, f64::INFINITY));
        assert!(!unit.meets_segment(from, DVec3::new(1.0, 1.0, 0.0), f64::INFINITY));
        assert!(unit.meets_segment(DVec3::splat(0.5), DVec3::ZERO, f64::INFINITY), "a point inside");
        assert!(!Aabb::EMPTY.meets_segment(from, DVec3::X, f64::INFINITY));
    }

    #[test]
    fn a_turned_box_still_holds_its_points() {
        let turn = DAffine3::from_rotation_translation(DQuat::from_rotation_y(0.3), DVec3::new(0.1, 1e6, -3.0));
        let held = Aabb::from_points([Vec3::new(-0.1, 0.0, 0.3), Vec3::new(2.0, 7.7, 1.0)]);
        let turned = held.transformed(&turn);
        for corner in held.corners() {
            assert!(turned.contains(turn.transform_point3(corner)));
        }
    }
}
