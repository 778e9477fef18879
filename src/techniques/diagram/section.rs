//! The scene cut along the upright plane that the eye looks in: pieces of surfaces, and what of that plane each
//! triangle that faces the light shadows.
//!
//! ```text
//!              * light            A triangle shadows what lies behind it as seen from the light: four half-spaces,
//!             / \                 which leave a convex polygon of the plane. As many polygons as hold a point, so many
//!            /___\ triangle       volumes hold it: the count, without a ray to the light.
//!           /.....\
//!          /.......\
//! ```
//!
//! Places on the plane are metres from the eye: ahead of it, and up.

use glam::{DVec2, DVec3, DVec4};

use crate::frame::Camera;
use crate::geometry::Aabb;
use crate::geometry::clip::{area, clipped};
use crate::scene::solid::Role;
use crate::scene::{AlphaMode, LightKind, Mirror, Pose, PosedLight, Scene};

/// Of a way's length: pieces of it that are shorter come of rounding.
const LEAST: f64 = 1e-6;

/// The plane that the eye looks in.
#[derive(Debug, Clone, Copy)]
pub struct Plane {
    eye: DVec3,
    ahead: DVec3,
    right: DVec3,
}

impl Plane {
    /// Of this eye.
    #[must_use]
    pub fn of(eye: &Camera) -> Self {
        let ahead = DVec3::new(eye.forward.x, 0.0, eye.forward.z).try_normalize().unwrap_or(DVec3::X);
        Self { eye: eye.eye, ahead, right: ahead.cross(DVec3::Y) }
    }

    /// Unit, level: to the eye's right.
    #[must_use]
    pub const fn right(&self) -> DVec3 {
        self.right
    }

    /// Unit, level: ahead of the eye.
    #[must_use]
    pub const fn ahead(&self) -> DVec3 {
        self.ahead
    }

    /// A way of world space: ahead, up, and to the right of the plane.
    #[must_use]
    pub fn way(&self, way: DVec3) -> DVec3 {
        DVec3::new(way.dot(self.ahead), way.y, way.dot(self.right))
    }

    /// A place of world space likewise.
    #[must_use]
    pub fn place(&self, place: DVec3) -> DVec3 {
        self.way(place - self.eye)
    }

    /// A place of the plane in world space.
    #[must_use]
    pub fn world(&self, place: DVec2) -> DVec3 {
        self.eye + self.ahead * place.x + DVec3::Y * place.y
    }

    /// Whether a box of world space reaches to both sides of it.
    #[must_use]
    pub fn cuts(&self, bounds: &Aabb) -> bool {
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let corner = |i: usize| DVec3::from_array(std::array::from_fn(|axis| [min, max][i >> axis & 1][axis]));
        let sides = (0..8).map(|i| self.place(corner(i)).z);
        sides.clone().any(|side| side <= 0.0) && sides.clone().any(|side| side >= 0.0)
    }
}

/// Where the plane cuts a triangle of a surface.
#[derive(Debug, Clone, Copy)]
pub struct Piece {
    /// One end.
    pub from: DVec2,
    /// The other.
    pub to: DVec2,
    /// What of the surface's normal lies in the plane; not unit.
    pub out: DVec2,
    /// As [`Scene::instances`] counts them.
    pub instance: usize,
    /// Seen from behind, it is not there.
    pub one_sided: bool,
    /// Its front faces the light, or it has two.
    pub faces_light: bool,
    /// Reflects.
    pub mirror: bool,
}

/// What of the plane a triangle shadows: convex, its corners counter-clockwise.
#[derive(Debug, Clone)]
struct Shadow {
    corners: Vec<DVec2>,
}

impl Shadow {
    /// Where a way enters it and where it leaves it, in lengths of the way.
    fn span(&self, from: DVec2, way: DVec2) -> Option<(f64, f64)> {
        let (mut enters, mut leaves) = (f64::NEG_INFINITY, f64::INFINITY);
        for (index, &a) in self.corners.iter().enumerate() {
            let along = self.corners[(index + 1) % self.corners.len()] - a;
            let (height, climb) = (along.perp_dot(from - a), along.perp_dot(way));
            if climb == 0.0 {
                if height < 0.0 {
                    return None;
                }
                continue;
            }
            let at = -height / climb;
            if climb > 0.0 { enters = enters.max(at) } else { leaves = leaves.min(at) }
        }
        (enters < leaves).then_some((enters, leaves))
    }
}

/// The scene on the plane, in one light.
#[derive(Debug, Clone)]
pub struct Section {
    /// Where surfaces are.
    pub pieces: Vec<Piece>,
    shadows: Vec<Shadow>,
}

impl Section {
    /// The scene cut along the plane, and shadowed within so many metres about the eye.
    #[must_use]
    pub fn new(scene: &Scene, pose: &Pose, plane: &Plane, light: &PosedLight, mirrors: &[Mirror], reach: f64) -> Self {
        let mut section = Self { pieces: Vec::new(), shadows: Vec::new() };
        // Homogeneous: the light's place, or the way to it.
        let light = match light.kind {
            LightKind::Directional => plane.way(-light.direction).extend(0.0),
            LightKind::Point | LightKind::Spot { .. } => plane.place(light.position).extend(1.0),
        };
        for (instance, (node_index, node, mesh)) in scene.instances().enumerate() {
            let world_from_object = pose.world_from_object[node_index];
            let turned = world_from_object.matrix3.determinant() < 0.0;
            let positions = pose.positions(scene, node_index);
            let at = |triangle: usize| {
                let corner = |i: usize| positions[mesh.indices[triangle * 3 + i] as usize].as_dvec3();
                let [a, b, c] = [0, 1, 2].map(|i| plane.place(world_from_object.transform_point3(corner(i))));
                if turned { [a, c, b] } else { [a, b, c] }
            };
            // Two solids put together are seen by the mesh of the result.
            if scene.solid.as_ref().is_none_or(|solid| solid.caster.is_none() || solid.role(instance) == Role::Object) {
                for (primitive, run) in mesh.primitives.iter().enumerate() {
                    let material = &scene.materials[run.material];
                    if material.alpha == AlphaMode::Blend {
                        continue;
                    }
                    let mirror = mirrors.iter().any(|mirror| mirror.node == node_index && mirror.primitive == primitive);
                    for triangle in run.first_index as usize / 3..(run.first_index + run.index_count) as usize / 3 {
                        section.cut(at(triangle), instance, !material.double_sided, mirror, light);
                    }
                }
            }
            if node.casts_shadow {
                let topology = &mesh.topology;
                for (&triangle, &soup) in topology.mesh_triangles().iter().zip(topology.two_sided()) {
                    section.throw(at(triangle as usize), soup, light, reach);
                }
            }
        }
        section
    }

    fn cut(&mut self, [a, b, c]: [DVec3; 3], instance: usize, one_sided: bool, mirror: bool, light: DVec4) {
        let over = |corner: DVec3| corner.z >= 0.0;
        if over(a) == over(b) && over(b) == over(c) {
            return;
        }
        let normal = (b - a).cross(c - a);
        let crossing = [(a, b), (b, c), (c, a)].into_iter().filter(|(p, q)| over(*p) != over(*q));
        let mut ends = crossing.map(|(p, q)| (p + (q - p) * (p.z / (p.z - q.z))).truncate());
        if let (Some(from), Some(to)) = (ends.next(), ends.next()) {
            let faces_light = !one_sided || normal.dot(towards(light, a)) > 0.0;
            self.pieces.push(Piece { from, to, out: normal.truncate(), instance, one_sided, faces_light, mirror });
        }
    }

    fn throw(&mut self, [a, b, c]: [DVec3; 3], soup: bool, light: DVec4, reach: f64) {
        let mut normal = (b - a).cross(c - a);
        let facing = normal.dot(towards(light, a));
        if facing <= 0.0 {
            if !soup || facing == 0.0 {
                return;
            }
            normal = -normal;
        }
        let side = |p: DVec3, q: DVec3, third: DVec3| {
            let across = towards(light, p).cross(q - p);
            let plane = across.extend(-across.dot(p));
            if plane.dot(third.extend(1.0)) < 0.0 { -plane } else { plane }
        };
        let behind = (-normal).extend(normal.dot(a));
        let planes = [behind, side(a, b, c), side(b, c, a), side(c, a, b)];
        let all = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0) * reach);
        let corners: Vec<_> = clipped(&all, &planes).into_iter().map(DVec3::truncate).collect();
        // What the plane only touches has no inside.
        if area(&corners) > (LEAST * reach).powi(2) {
            self.shadows.push(Shadow { corners });
        }
    }

    /// Piece by piece along a way of so many lengths of `way`: each one's end, and in how many volumes it lies.
    #[must_use]
    pub fn legs(&self, from: DVec2, way: DVec2, length: f64) -> Vec<(f64, u32)> {
        let mut count = 0;
        let mut changes = Vec::new();
        for (enters, leaves) in self.shadows.iter().filter_map(|shadow| shadow.span(from, way)) {
            if enters < length && leaves > 0.0 {
                if enters <= 0.0 {
                    count += 1
                } else {
                    changes.push((enters, 1))
                }
                if leaves < length {
                    changes.push((leaves, -1));
                }
            }
        }
        changes.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut legs: Vec<(f64, u32)> = Vec::new();
        let mut begun = 0.0;
        let mut end = |to: f64, count: i32| {
            if to - begun > LEAST * length {
                let count = u32::try_from(count).unwrap_or(0);
                match legs.last_mut().filter(|last| last.1 == count) {
                    Some(last) => last.0 = to,
                    None => legs.push((to, count)),
                }
                begun = to;
            }
        };
        for (at, change) in changes {
            end(at, count);
            count += change;
        }
        end(length, count);
        // What came of rounding at the end belongs to the last piece.
        match legs.last_mut() {
            Some(last) => last.0 = length,
            None => legs.push((length, u32::try_from(count).unwrap_or(0))),
        }
        legs
    }

    /// The first surface along a way: how many lengths of it away, beyond the nearest that counts.
    #[must_use]
    pub fn surface(&self, from: DVec2, way: DVec2, nearest: f64) -> Option<(f64, &Piece)> {
        let met = self.pieces.iter().filter_map(|piece| {
            let along = piece.to - piece.from;
            let turns = way.perp_dot(along);
            let (at, share) = ((piece.from - from).perp_dot(along) / turns, (piece.from - from).perp_dot(way) / turns);
            let seen = !piece.one_sided || piece.out.dot(way) < 0.0;
            (seen && at > nearest && (0.0..=1.0).contains(&share)).then_some((at, piece))
        });
        met.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// From where to where solids are, and which, upwards at so many metres ahead of the eye.
    #[must_use]
    pub fn solid(&self, ahead: f64) -> Vec<(usize, f64, f64)> {
        let mut crossed: Vec<_> = self
            .pieces
            .iter()
            .filter(|piece| (piece.from.x <= ahead) != (piece.to.x <= ahead))
            .map(|piece| {
                let share = (ahead - piece.from.x) / (piece.to.x - piece.from.x);
                (piece.instance, piece.from.y + (piece.to.y - piece.from.y) * share, if piece.out.y < 0.0 { 1 } else { -1 })
            })
            .collect();
        crossed.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let mut spans = Vec::new();
        for of_instance in crossed.chunk_by(|a, b| a.0 == b.0) {
            // What is open has no inside.
            if of_instance.iter().map(|crossing| crossing.2).sum::<i32>() != 0 {
                continue;
            }
            let mut inside = 0;
            for pair in of_instance.windows(2) {
                inside += pair[0].2;
                if inside > 0 {
                    spans.push((pair[0].0, pair[0].1, pair[1].1));
                }
            }
        }
        spans
    }
}

/// The way from a place to a light, which is a place or a way.
fn towards(light: DVec4, from: DVec3) -> DVec3 {
    light.truncate() - from * light.w
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lit_from_above(triangles: &[[DVec3; 3]]) -> Section {
        let mut section = Section { pieces: Vec::new(), shadows: Vec::new() };
        for &triangle in triangles {
            section.throw(triangle, true, DVec4::new(0.0, 10.0, 0.0, 1.0), 100.0);
            section.cut(triangle, 0, false, false, DVec4::new(0.0, 10.0, 0.0, 1.0));
        }
        section
    }

    /// Level, across the plane, from `x` to `x + 1`.
    fn shelf(x: f64, y: f64) -> [DVec3; 3] {
        [DVec3::new(x, y, -3.0), DVec3::new(x, y, 3.0), DVec3::new(x + 2.0, y, 0.0)]
    }

    #[test]
    fn what_lies_behind_a_triangle_is_shadowed_and_nothing_else() {
        // On the plane the shelf reaches from 1 to 3 at the height of 5: thrown from a height of 10 onto 0, from 2 to 6.
        let section = lit_from_above(&[shelf(1.0, 5.0)]);
        let floor = section.legs(DVec2::new(-10.0, 0.0), DVec2::X, 30.0);
        assert_eq!(floor.iter().map(|leg| leg.1).collect::<Vec<_>>(), [0, 1, 0]);
        assert!((floor[0].0 - 12.0).abs() < 1e-9 && (floor[1].0 - 16.0).abs() < 1e-9, "{floor:?}");
        assert_eq!(section.legs(DVec2::new(2.0, 9.0), DVec2::X, 1.0), [(1.0, 0)], "between it and the light");
        let (metres, _) = section.surface(DVec2::new(2.0, 0.0), DVec2::Y, 0.1).unwrap_or((0.0, &section.pieces[0]));
        assert!((metres - 5.0).abs() < 1e-9);
    }

    #[test]
    fn shadows_over_one_another_are_counted_each() {
        let section = lit_from_above(&[shelf(1.0, 5.0), shelf(0.5, 2.0)]);
        let counts: Vec<_> = section.legs(DVec2::new(-10.0, 0.0), DVec2::X, 30.0).iter().map(|leg| leg.1).collect();
        assert_eq!(counts, [0, 1, 2, 1, 0]);
    }

    #[test]
    fn neighbours_leave_no_seam() {
        let quad = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, z]| DVec3::new(x, 5.0, z));
        let section = lit_from_above(&[[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]);
        let legs = section.legs(DVec2::new(-10.0, 0.0), DVec2::X, 30.0);
        assert_eq!(legs.iter().map(|leg| leg.1).collect::<Vec<_>>(), [0, 1, 0], "{legs:?}");
    }
}
