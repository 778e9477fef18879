//! A part of a mesh that throws a volume by itself: what of it lies before a plane, or a few of its triangles.
//!
//! A triangle that reaches through the plane is cut, and what is left of it keeps its order of corners; two triangles
//! that share an edge share the corner in which it is cut, so what was joined stays joined. What lies on the plane, and
//! all behind it, is left out. A part of a solid is open where it was cut, but its triangles still count only where
//! they face the light: along any ray it counts as many of them as the whole does before the plane.

use std::collections::HashMap;

use glam::{DVec4, Vec3};

use super::{Aabb, Caster, Planes, Topology};

/// Triangles of their own, ready to throw volumes.
#[derive(Debug, Clone, Default)]
pub struct Portion {
    /// Object space.
    pub welded: Vec<Vec3>,
    topology: Topology,
    planes: Planes,
    bounds: Aabb,
}

impl Portion {
    /// What of a mesh, in one pose, lies before a plane: `heights` gives a point's height over it as `plane . (p, 1)`,
    /// and what is no higher than `slack` (of the same unit) lies on it.
    #[must_use]
    pub fn before(topology: &Topology, welded: &[Vec3], heights: DVec4, slack: f64) -> Self {
        let height = |point: Vec3| heights.dot(point.as_dvec3().extend(1.0));
        let over: Vec<f64> = welded.iter().map(|&point| height(point)).collect();
        let side = |vertex: u32| over[vertex as usize];
        let mut kept = Vec::new();
        let mut places = welded.to_vec();
        let mut cuts: HashMap<[u32; 2], u32> = HashMap::new();
        let mut two_sided = Vec::new();
        for (triangle, &both) in topology.triangles().iter().zip(topology.two_sided()) {
            let heights = triangle.map(side);
            if heights.iter().all(|height| *height <= slack) {
                continue;
            }
            if heights.iter().all(|height| *height >= -slack) {
                kept.push(*triangle);
                two_sided.push(both);
                continue;
            }
            let mut corners = Vec::with_capacity(4);
            for (at, &from) in triangle.iter().enumerate() {
                let to = triangle[(at + 1) % 3];
                if side(from) >= -slack {
                    corners.push(from);
                }
                if side(from) > slack && side(to) < -slack || side(from) < -slack && side(to) > slack {
                    let ends = [from.min(to), from.max(to)];
                    corners.push(*cuts.entry(ends).or_insert_with(|| {
                        let [low, high] = ends.map(side);
                        let [a, b] = ends.map(|end| welded[end as usize].as_dvec3());
                        places.push((a + (b - a) * (low / (low - high))).as_vec3());
                        u32::try_from(places.len() - 1).unwrap_or(u32::MAX)
                    }));
                }
            }
            for pair in corners[1..].windows(2) {
                kept.push([corners[0], pair[0], pair[1]]);
                two_sided.push(both);
            }
        }
        Self::of(kept, &places, two_sided)
    }

    /// Some triangles by their welded vertices: a sheet, each of which counts from both sides.
    #[must_use]
    pub fn sheet(triangles: Vec<[u32; 3]>, welded: &[Vec3]) -> Self {
        let both = vec![true; triangles.len()];
        Self::of(triangles, welded, both)
    }

    fn of(mut triangles: Vec<[u32; 3]>, welded: &[Vec3], two_sided: Vec<bool>) -> Self {
        // Only the vertices that are used, in the order in which they are.
        let mut numbers: HashMap<u32, u32> = HashMap::new();
        let mut used = Vec::new();
        for vertex in triangles.iter_mut().flatten() {
            *vertex = *numbers.entry(*vertex).or_insert_with(|| {
                used.push(welded[*vertex as usize]);
                u32::try_from(used.len() - 1).unwrap_or(u32::MAX)
            });
        }
        let topology = Topology::of_part(triangles, &used, two_sided);
        let mut planes = Planes::default();
        planes.build(&topology, &used);
        let bounds = Aabb::from_points(used.iter().copied());
        Self { welded: used, topology, planes, bounds }
    }

    /// As volumes see it.
    #[must_use]
    pub fn caster(&self) -> Caster<'_> {
        Caster { topology: &self.topology, welded: &self.welded, planes: &self.planes, bounds: &self.bounds }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;
    use crate::geometry::{Outline, VolumeParts, VolumeScratch, Weld};
    use glam::{DVec3, Vec4};
    use std::cmp::Ordering;

    /// A cube of two metres about the origin.
    fn cube() -> (Topology, Vec<Vec3>) {
        let corners: Vec<Vec3> =
            (0..8).map(|bits| Vec3::new(bits as f32 % 2.0, (bits / 2) as f32 % 2.0, (bits / 4) as f32) * 2.0 - 1.0).collect();
        let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let indices: Vec<u32> = quads.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]).collect();
        let weld = Weld::new(&corners, |_, _| Ordering::Equal);
        (Topology::build(&indices, &corners, weld, |_| true), corners)
    }

    #[test]
    fn a_cut_solid_keeps_its_shape_and_is_joined_where_it_was() {
        let (topology, welded) = cube();
        assert!(topology.report().is_solid());
        let part = Portion::before(&topology, &welded, DVec3::Y.extend(-0.25), 1e-6);
        let low = part.welded.iter().map(|point| point.y).fold(f32::INFINITY, f32::min);
        assert_eq!(low, 0.25);
        // Four walls, cut across their diagonals: three triangles each; and the top's two.
        assert_eq!(part.topology.triangles().len(), 14);
        assert_eq!(part.topology.report().border_edges, 8, "open along the cut, and nowhere else");
        assert!(part.topology.two_sided().iter().all(|both| !both));
        let area = |welded: &[Vec3], [a, b, c]: [u32; 3]| {
            let [a, b, c] = [a, b, c].map(|vertex| welded[vertex as usize]);
            (b - a).cross(c - a) / 2.0
        };
        let sum: Vec3 = part.topology.triangles().iter().map(|triangle| area(&part.welded, *triangle)).sum();
        assert!(sum.distance(Vec3::Y * 4.0) < 1e-5, "what faces outwards still does: {sum}");
    }

    #[test]
    fn what_lies_on_the_plane_or_behind_is_none_of_it() {
        let (topology, welded) = cube();
        let on_top = Portion::before(&topology, &welded, DVec3::Y.extend(-1.0), 1e-6);
        assert!(on_top.welded.is_empty() && on_top.topology.triangles().is_empty());
        let all_but_the_bottom = Portion::before(&topology, &welded, DVec3::Y.extend(1.0), 1e-6);
        assert_eq!(all_but_the_bottom.topology.triangles().len(), 10);
        let all = Portion::before(&topology, &welded, DVec3::Y.extend(2.0), 1e-6);
        let places = |triangles: &[[u32; 3]], welded: &[Vec3]| {
            triangles.iter().map(|corners| corners.map(|vertex| welded[vertex as usize])).collect::<Vec<_>>()
        };
        assert_eq!(places(all.topology.triangles(), &all.welded), places(topology.triangles(), &welded), "in order");
    }

    #[test]
    fn its_volume_is_closed() {
        let (topology, welded) = cube();
        let part = Portion::before(&topology, &welded, DVec3::new(0.3, 0.8, -0.5).extend(0.1), 1e-6);
        let (mut scratch, mut indices) = (VolumeScratch::default(), Vec::<u32>::new());
        let parts = VolumeParts { outline: Outline::Silhouette, ..VolumeParts::ALL };
        scratch.append(part.caster(), Vec4::new(3.0, 4.0, 5.0, 1.0), parts, &mut indices);
        let mut borders: HashMap<[u32; 2], i32> = HashMap::new();
        for [a, b, c] in indices.as_chunks::<3>().0 {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                *borders.entry([*from.min(to), *from.max(to)]).or_default() += if from < to { 1 } else { -1 };
            }
        }
        assert!(borders.values().all(|sum| *sum == 0), "{borders:?}");
        assert!(!indices.is_empty());
    }
}
