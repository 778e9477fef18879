//! How many of a caster's volumes hold the eye: where exact z-pass starts to count.
//!
//! Counting on the way from the eye to a surface tells how the count *changes*. What it is at the
//! eye is geometry: a shadow volume holds the eye when the segment from the light to the eye
//! crosses the triangle that spans it. So the eye's count is the sum, over all triangles that the
//! segment crosses, of what they add to the volume, decided by the very function that made the
//! volume. For a directional light the segment is the ray from the eye towards the light.
//!
//! The triangles are looked at along the segment, where it is a point and crossing is a question
//! in the plane. An edge gives its two triangles the same answer to the last bit (a product's
//! difference only changes its sign when the ends are swapped), so none is missed and none counted
//! twice. But the rasteriser works in single precision: where the eye is so close to a side of the
//! volume, or to the caster's surface, that rounding could put it on the other side, the answer is
//! [`EyeCount::Ambiguous`], and the caller takes z-fail, which does not ask.

use glam::{DVec2, DVec3, DVec4, Vec3};

use super::silhouette::{EdgeOn, narrow, plane};
use super::{Aabb, Topology};

/// How often a caster's volume winds around the eye.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EyeCount {
    /// So often.
    Count(i32),
    /// The eye is too close to the volume's boundary for the rasteriser to agree for certain.
    Ambiguous,
}

/// Counts the volumes that `topology`, its mesh's vertices at `positions`, throws from `light`
/// around `eye`. All in object space; `light` is a point with w = 1, or the direction towards a
/// directional light with w = 0, and is rounded to single precision as it is for the volume.
///
/// Takes time in proportion to the mesh; ask [`super::Aabb::meets_segment`] first.
#[must_use]
pub fn holding_count(topology: &Topology, positions: &[Vec3], light: DVec4, eye: DVec3) -> EyeCount {
    let light = light.as_vec4();
    let Some(sight) = Sight::new(positions, light.as_dvec4(), eye) else { return EyeCount::Ambiguous };
    let welded = |vertex: u32| positions[topology.weld().vertex_of_welded[vertex as usize] as usize];
    let sides: Vec<u8> = topology.weld().vertex_of_welded.iter().map(|&vertex| sight.sides(positions[vertex as usize])).collect();

    let seen = EdgeOn::new(&Aabb::from_points(positions.iter().copied()), light);
    let mut count = 0;
    for (triangle, &two_sided) in topology.triangles().iter().zip(topology.two_sided()) {
        // All corners beyond one and the same side of the segment: the usual case, settled here.
        let [a, b, c] = triangle.map(|vertex| sides[vertex as usize]);
        if a & b & c != 0 {
            continue;
        }
        let corners = triangle.map(welded);
        // Whether one that is edge-on counts, its neighbours decide: where it matters, nobody knows here.
        let plane = plane(corners);
        let counts = seen.contribution(plane, narrow(plane, corners), two_sided);
        if counts == Some(0) {
            continue;
        }
        match (sight.crossing(corners.map(|corner| corner.as_dvec3())), counts) {
            (Crossing::None, _) => {}
            (Crossing::Unclear, _) | (_, None) => return EyeCount::Ambiguous,
            (Crossing::FromFront, Some(counts)) => count += i32::from(counts),
            (Crossing::FromBack, Some(counts)) => count -= i32::from(counts),
        }
    }
    EyeCount::Count(count)
}

/// Whether `eye` lies within a solid component of `topology`, its mesh's vertices at `positions`; `None`
/// where rounding could decide. Object space.
#[must_use]
pub fn inside_solid(topology: &Topology, positions: &[Vec3], eye: DVec3) -> Option<bool> {
    // Any direction will do; this one seldom runs along an edge.
    let sight = Sight::new(positions, DVec4::new(0.487_1, 0.734_9, 0.472_0, 0.0), eye)?;
    let sides: Vec<u8> = topology.weld().vertex_of_welded.iter().map(|&vertex| sight.sides(positions[vertex as usize])).collect();
    let mut winding = 0;
    for (triangle, _) in topology.triangles().iter().zip(topology.two_sided()).filter(|(_, soup)| !**soup) {
        let [a, b, c] = triangle.map(|vertex| sides[vertex as usize]);
        if a & b & c != 0 {
            continue;
        }
        let corners = triangle.map(|vertex| positions[topology.weld().vertex_of_welded[vertex as usize] as usize].as_dvec3());
        match sight.crossing(corners) {
            Crossing::None => {}
            Crossing::Unclear => return None,
            Crossing::FromFront => winding += 1,
            Crossing::FromBack => winding -= 1,
        }
    }
    Some(winding != 0)
}

/// The segment from the eye to the light, and the plane square to it.
struct Sight {
    eye: DVec3,
    /// Unit, from the eye to the light.
    towards: DVec3,
    across: [DVec3; 2],
    /// From the eye to the light, infinite for a directional one.
    length: f64,
    /// What single precision may be wrong by, generously.
    unsure: f64,
}

/// How the segment, coming from the light, meets a triangle.
enum Crossing {
    None,
    FromFront,
    FromBack,
    Unclear,
}

impl Sight {
    fn new(positions: &[Vec3], light: DVec4, eye: DVec3) -> Option<Self> {
        const RELATIVE: f64 = 1e-6;
        let size = f64::from(positions.iter().fold(Vec3::ZERO, |largest, position| largest.max(position.abs())).max_element());
        let light_size = if light.w == 0.0 { 0.0 } else { light.truncate().abs().max_element() };
        let unsure = RELATIVE * size.max(light_size).max(eye.abs().max_element());
        let way = light.truncate() - eye * light.w;
        let towards = way.try_normalize().filter(|towards| towards.is_finite() && unsure.is_finite())?;
        let length = if light.w == 0.0 { f64::INFINITY } else { way.length() };
        let (right, up) = towards.any_orthonormal_pair();
        (length > unsure).then_some(Self { eye, towards, across: [right, up], length, unsure })
    }

    /// Where a point lies seen along the segment, and how far along it.
    fn look(&self, point: DVec3) -> (DVec2, f64) {
        let from_eye = point - self.eye;
        let [right, up] = self.across;
        (DVec2::new(from_eye.dot(right), from_eye.dot(up)), from_eye.dot(self.towards))
    }

    /// One bit for each side of the segment that a point is clearly beyond.
    fn sides(&self, point: Vec3) -> u8 {
        let (seen, along) = self.look(point.as_dvec3());
        u8::from(seen.x < -self.unsure)
            | u8::from(seen.x > self.unsure) << 1
            | u8::from(seen.y < -self.unsure) << 2
            | u8::from(seen.y > self.unsure) << 3
            | u8::from(along < -self.unsure) << 4
            | u8::from(along > self.length + self.unsure) << 5
    }

    fn crossing(&self, corners: [DVec3; 3]) -> Crossing {
        let [a, b, c] = corners;
        let Some(normal) = (b - a).cross(c - a).try_normalize() else { return Crossing::None };
        let eye_above = normal.dot(self.eye - a);
        let light_above = if self.length.is_finite() {
            eye_above + normal.dot(self.towards) * self.length
        } else {
            // Infinitely far: as far above as it likes, unless its direction lies in the plane.
            let slope = normal.dot(self.towards);
            if slope.abs() > 1e-12 { slope.signum() * f64::INFINITY } else { eye_above }
        };
        let clear = eye_above.abs() > self.unsure && light_above.abs() > self.unsure;
        let apart = eye_above.signum() != light_above.signum();

        let seen = corners.map(|corner| self.look(corner));
        let edges = [(seen[0], seen[1]), (seen[1], seen[2]), (seen[2], seen[0])];
        let mut close = false;
        for ((from, from_along), (to, to_along)) in edges {
            // The place of the edge that is nearest to the segment's line.
            let edge = to - from;
            let at = (-from.dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
            let at = if at.is_nan() { 0.0 } else { at };
            if (from + edge * at).length() <= self.unsure {
                let along = from_along + (to_along - from_along) * at;
                if (-self.unsure..=self.length + self.unsure).contains(&along) {
                    return Crossing::Unclear;
                }
                close = true;
            }
        }
        if close {
            // Past an edge that lies beyond the segment's ends; but a steep triangle may still
            // meet the segment itself close by.
            return if clear && !apart { Crossing::None } else { Crossing::Unclear };
        }
        let turns = edges.map(|((from, _), (to, _))| from.perp_dot(to));
        // Clear of all edges, so around the line or not; slivers seen edge-on never are.
        let around = |turn: f64, ((from, _), (to, _)): ((DVec2, f64), (DVec2, f64))| turn > 0.5 * self.unsure * from.distance(to);
        let within = turns.iter().zip(edges).all(|(turn, edge)| around(*turn, edge))
            || turns.iter().zip(edges).all(|(turn, edge)| around(-*turn, edge));
        match (within, clear, apart) {
            (false, ..) => Crossing::None,
            (true, false, _) => Crossing::Unclear,
            (true, true, false) => Crossing::None,
            (true, true, true) if light_above > 0.0 => Crossing::FromFront,
            (true, true, true) => Crossing::FromBack,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Weld;
    use std::cmp::Ordering;

    /// A square facing up at y = 1, two metres wide.
    fn square() -> (Topology, Vec<Vec3>) {
        let positions: Vec<Vec3> =
            [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]].map(|[x, z]| Vec3::new(x, 1.0, z)).to_vec();
        let weld = Weld::new(&positions, |_, _| Ordering::Equal);
        (Topology::build(&[0, 1, 2, 0, 2, 3], &positions, weld, |_| true), positions)
    }

    #[test]
    fn a_solid_holds_what_is_inside_it_and_a_sheet_nothing() {
        let at = |corner: usize| Vec3::new((corner & 1) as f32, (corner >> 1 & 1) as f32, (corner >> 2) as f32);
        let positions: Vec<Vec3> = (0..8).map(at).collect();
        let indices =
            [0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5];
        let topology = Topology::build(&indices, &positions, Weld::new(&positions, |_, _| Ordering::Equal), |_| true);
        let holds = |x: f64, y: f64, z: f64| inside_solid(&topology, &positions, DVec3::new(x, y, z));
        assert_eq!(holds(0.5, 0.4, 0.3), Some(true));
        assert_eq!(holds(-0.5, -0.4, -0.3), Some(false), "the ray goes through it, in and out");
        assert_eq!(holds(1.5, 0.4, 0.3), Some(false));
        assert_eq!(holds(1.0, 0.4, 0.3), None, "on its surface");
        let (sheet, positions) = square();
        assert_eq!(inside_solid(&sheet, &positions, DVec3::new(0.2, 0.0, 0.1)), Some(false));
    }

    fn count(light: DVec4, eye: DVec3) -> EyeCount {
        let (topology, positions) = square();
        holding_count(&topology, &positions, light, eye)
    }

    #[test]
    fn an_open_square_holds_what_is_behind_it_from_either_side() {
        let lamp = DVec4::new(0.1, 3.0, 0.2, 1.0);
        assert_eq!(count(lamp, DVec3::new(0.2, 0.0, 0.1)), EyeCount::Count(1));
        assert_eq!(count(lamp, DVec3::new(0.2, 2.0, 0.1)), EyeCount::Count(0), "between the lamp and the square");
        assert_eq!(count(lamp, DVec3::new(2.0, 0.0, 0.1)), EyeCount::Count(0), "beside the shadow");
        assert_eq!(count(lamp, DVec3::new(0.3, 5.0, 0.1)), EyeCount::Count(0), "beyond the lamp");
        assert_eq!(count(DVec4::new(0.1, -3.0, 0.2, 1.0), DVec3::new(0.2, 2.0, 0.1)), EyeCount::Count(1), "lit from below");
        let sun = DVec4::new(0.0, 1.0, 0.0, 0.0);
        assert_eq!(count(sun, DVec3::new(0.5, -9.0, 0.1)), EyeCount::Count(1));
        assert_eq!(count(sun, DVec3::new(0.5, 9.0, 0.1)), EyeCount::Count(0));
        assert_eq!(count(DVec4::new(1.0, 0.0, 0.0, 0.0), DVec3::new(-5.0, 1.5, 0.0)), EyeCount::Count(0), "along the square");
    }

    #[test]
    fn on_the_boundary_the_answer_is_left_open() {
        let lamp = DVec4::new(0.0, 3.0, 0.0, 1.0);
        assert_eq!(count(lamp, DVec3::new(1.5, 0.0, 0.3)), EyeCount::Ambiguous, "on a side of the volume");
        assert_eq!(count(lamp, DVec3::new(0.2, 1.0, 0.1)), EyeCount::Ambiguous, "on the square");
        assert_eq!(count(lamp, DVec3::new(0.0, 3.0, 0.0)), EyeCount::Ambiguous, "at the lamp");
        assert_eq!(count(DVec4::new(5.0, 1.0, 0.2, 1.0), DVec3::new(-5.0, 1.0, 0.1)), EyeCount::Ambiguous, "seen edge-on");
        assert_eq!(count(lamp, DVec3::new(1.5 + 1e-4, 0.0, 0.3)), EyeCount::Count(0));
        assert_eq!(count(lamp, DVec3::new(1.5 - 1e-4, 0.0, 0.3)), EyeCount::Count(1));
    }
}
