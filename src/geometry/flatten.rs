//! Silhouettes of any caster, flattened into a cut-out (K 6.2.2).
//!
//! Everything of the caster that faces the light is projected, from the light, onto a plane behind
//! it; the pile of polygons is reduced to its outline, and the outline is a planar cut-out
//! ([`super::cutout`]). K projects by OpenGL's feedback mode and reduces by the GLU tessellator with
//! the non-zero winding rule, boundary for the sides and tessellation for the cap; here both come
//! from one sweep of a polygon library on an integer grid (i_triangle, over i_overlay's union).
//!
//! ```text
//!           * light
//!          / \
//!         /###\       the caster
//!        /#####\
//!     --/-------\--   the plane behind it: all of its shadow starts here
//!      /         \
//!   __/___________\_______ a receiver beyond the plane
//! ```
//!
//! Not every triangle need be projected. Along their common edges the boundaries of triangles
//! cancel, so the silhouette's loops alone wind as often around each point of the plane as
//! light-facing triangles cover it: the same union from O(s) edges instead of O(f) triangles. That
//! holds for solids and for soup alike, because [`super::silhouette`] keeps multiplicities. (K
//! suggests this for closed objects.)
//!
//! **What is right and what is not.** A surface beyond the plane is in the volume exactly when a
//! triangle stands between it and the light: there the shadow is that of the caster itself. Before
//! the plane nothing is in shadow: the caster receives no shadow from itself, and where something
//! stands beside it, or touches it, before the plane, its shadow is missing there. So it errs to
//! one side only: it may miss shadow, and never shadows what is lit.
//!
//! **Where it cannot be done.** The light must see all of the caster before it, within a cone that
//! stays clear of a half-space: not from inside, nor from close above something wide.

use glam::{DVec2, DVec4, Vec3};
use i_triangle::float::triangulation::Triangulation;
use i_triangle::float::triangulator::Triangulator;

use super::Aabb;
use super::cutout::CutoutPlane;

/// The plane onto which everything at `welded` (object space) is flattened for `light` (a point
/// with w = 1, or the direction towards it with w = 0): square to the way from the light to the
/// middle, behind the last vertex, its normal towards the light. `None` where the light is too near.
#[must_use]
pub fn flattening_plane(welded: impl IntoIterator<Item = Vec3>, bounds: &Aabb, light: DVec4) -> Option<CutoutPlane> {
    // The least cosine between the way to a vertex and the way to the middle.
    const NARROWEST: f64 = 0.1;
    let middle = bounds.center().as_dvec3();
    let towards = light.truncate() - middle * light.w;
    let normal = towards.try_normalize().filter(|_| !bounds.is_empty())?;
    let mut deepest = f64::NEG_INFINITY;
    for vertex in welded {
        let from_middle = vertex.as_dvec3() - middle;
        deepest = deepest.max(-normal.dot(from_middle));
        let way = from_middle - towards;
        if light.w != 0.0 && -normal.dot(way) < NARROWEST * way.length() {
            return None;
        }
    }
    // A hair behind, so that the caster's own last vertex is before the plane whatever the rounding.
    let behind = deepest + 1e-4 * f64::from(bounds.radius());
    behind.is_finite().then(|| CutoutPlane::square_to(normal, middle - normal * behind))
}

/// An outline and what it encloses, in the coordinates of a [`CutoutPlane`].
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outline {
    /// Corners.
    pub points: Vec<DVec2>,
    /// What is enclosed, counter-clockwise.
    pub triangles: Vec<[u32; 3]>,
    /// The boundary, what is enclosed on its left.
    pub edges: Vec<[u32; 2]>,
}

/// Flattens casters, keeping its memory from one to the next.
pub struct Flattener {
    library: Triangulator<u32>,
    result: Triangulation<[f64; 2], u32>,
    halves: Vec<[u32; 3]>,
    edges: Vec<[u32; 2]>,
}

impl Default for Flattener {
    fn default() -> Self {
        Self { library: Triangulator::default(), result: Triangulation::with_capacity(0), halves: Vec::new(), edges: Vec::new() }
    }
}

impl Flattener {
    /// The outline of everything that `silhouette` (directed edges of `welded` vertices, the
    /// light-facing side on their left as the light sees it) encloses, seen from `light` on `plane`.
    pub fn flatten(&mut self, welded: &[Vec3], silhouette: &[[u32; 2]], plane: &CutoutPlane, light: DVec4) -> Outline {
        let height = plane.height(light);
        let project = |vertex: u32| {
            let point = welded[vertex as usize].as_dvec3();
            // Along the ray from the light through the point, to the plane.
            let (way, slope) = (point * light.w - light.truncate(), height - plane.height(point.extend(1.0)) * light.w);
            let from_origin = point + way * (plane.height(point.extend(1.0)) / slope) - plane.origin;
            [from_origin.dot(plane.right), from_origin.dot(plane.up)]
        };
        self.edges.clear();
        self.edges.extend_from_slice(silhouette);
        let loops = loops(&mut self.edges).into_iter();
        self.unite(loops.map(|corners| corners.into_iter().map(project).collect()).collect())
    }

    /// The outline of everything around which `loops` wind at all.
    pub fn unite(&mut self, loops: Vec<Vec<[f64; 2]>>) -> Outline {
        // The library insists on a box that has a size.
        if loops.is_empty() || !loops.iter().flatten().flatten().all(|coordinate| coordinate.is_finite()) {
            return Outline::default();
        }
        self.library.triangulate_into(&loops, &mut self.result);
        let triangles: Vec<[u32; 3]> = self.result.indices.as_chunks::<3>().0.to_vec();
        Outline {
            points: self.result.points.iter().map(|&point| point.into()).collect(),
            edges: self.boundary(&triangles),
            triangles,
        }
    }

    /// The triangles' edges but for those that are run both ways. Taken from the triangles, not from
    /// the library's contours, so that sides and caps close to a volume whatever it returns.
    fn boundary(&mut self, triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
        let directed = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        self.halves.clear();
        self.halves.extend(directed.map(|[from, to]| [from.min(to), from.max(to), u32::from(from > to)]));
        self.halves.sort_unstable();
        let mut boundary = Vec::new();
        for edge in self.halves.chunk_by(|x, y| x[..2] == y[..2]) {
            let [a, b, _] = edge[0];
            let backward = edge.iter().filter(|half| half[2] == 1).count();
            let forward = edge.len() - backward;
            let (ends, times) = if forward > backward { ([a, b], forward - backward) } else { ([b, a], backward - forward) };
            boundary.extend(std::iter::repeat_n(ends, times));
        }
        boundary
    }
}

/// Directed edges, of which as many arrive at each vertex as leave it, as closed loops of vertices.
/// Sorts `edges`.
#[must_use]
pub fn loops(edges: &mut [[u32; 2]]) -> Vec<Vec<u32>> {
    edges.sort_unstable();
    // Where the edges from each vertex start, and how many of them are used, kept at the first.
    let first_from = |vertex: u32| edges.partition_point(|edge| edge[0] < vertex);
    let mut used = vec![0; edges.len()];
    let mut take = |vertex: u32| {
        let first = first_from(vertex);
        let next = first + used.get(first)?;
        let edge = edges.get(next).filter(|edge| edge[0] == vertex)?;
        used[first] += 1;
        Some(edge[1])
    };
    let mut loops = Vec::new();
    for &[start, _] in &*edges {
        let mut corners = vec![start];
        while let Some(next) = take(corners[corners.len() - 1]) {
            if next == start {
                break;
            }
            corners.push(next);
        }
        if corners.len() > 2 {
            loops.push(corners);
        }
    }
    loops
}

#[cfg(test)]
mod tests {
    // Test code: a failed expectation is the report.
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::geometry::silhouette::silhouette;
    use crate::geometry::{Facing, Planes, Topology, Weld};
    use glam::DVec3;
    use std::cmp::Ordering;
    use std::f64::consts::{PI, TAU};

    fn area(outline: &Outline) -> f64 {
        let corners = |t: &[u32; 3]| t.map(|i| outline.points[i as usize]);
        outline.triangles.iter().map(corners).map(|[a, b, c]| (b - a).perp_dot(c - a) / 2.0).sum()
    }

    /// Signed area of each loop of the boundary: positive ones enclose, negative ones are holes.
    fn contours(outline: &Outline) -> Vec<f64> {
        let signed = |corners: &Vec<u32>| {
            let point = |i: usize| outline.points[corners[i % corners.len()] as usize];
            (0..corners.len()).map(|i| point(i).perp_dot(point(i + 1)) / 2.0).sum()
        };
        let mut areas: Vec<f64> = loops(&mut outline.edges.clone()).iter().map(signed).collect();
        areas.sort_by(f64::total_cmp);
        areas
    }

    fn square(at: f64, half: f64) -> Vec<[f64; 2]> {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| [at + x * half, at + y * half]).to_vec()
    }

    fn ring(radius: f64, corners: u32) -> Vec<[f64; 2]> {
        (0..corners).map(|i| (f64::from(i) / f64::from(corners) * TAU).sin_cos()).map(|(y, x)| [x * radius, y * radius]).collect()
    }

    #[test]
    fn overlapping_squares_become_one_outline() {
        let outline = Flattener::default().unite(vec![square(0.0, 1.0), square(1.0, 1.0)]);
        assert_eq!(outline.edges.len(), 8, "an eight-cornered outline");
        assert!((area(&outline) - 7.0).abs() < 1e-8);
        let contours = contours(&outline);
        assert!(contours.len() == 1 && (contours[0] - 7.0).abs() < 1e-8, "{contours:?}");
        let apart = Flattener::default().unite(vec![square(0.0, 1.0), square(5.0, 1.0)]);
        assert_eq!(self::contours(&apart).len(), 2);
    }

    #[test]
    fn an_annulus_keeps_its_hole_and_windings_do_not_cancel() {
        let mut inner = ring(1.0, 64);
        inner.reverse();
        let outline = Flattener::default().unite(vec![ring(2.0, 64), inner]);
        let polygon = |radius: f64| 32.0 * (TAU / 64.0).sin() * radius * radius;
        assert!((area(&outline) - polygon(2.0) + polygon(1.0)).abs() < 1e-7);
        let contours = contours(&outline);
        assert!(contours.len() == 2 && (contours[0] + polygon(1.0)).abs() < 1e-7, "{contours:?}");
        let filled = Flattener::default().unite(vec![ring(2.0, 64), ring(1.0, 64)]);
        assert!((area(&filled) - polygon(2.0)).abs() < 1e-7, "wound twice is inside: non-zero, not even-odd");
        assert_eq!(filled.edges.len(), 64);
    }

    /// A torus about z, and its triangles.
    fn torus() -> (Topology, Vec<Vec3>) {
        const AROUND: u32 = 48;
        const TUBE: u32 = 24;
        let turn = |i: u32, of: u32| (f64::from(i) / f64::from(of) * TAU).sin_cos();
        let mut positions = Vec::new();
        let mut indices = Vec::new();
        for i in 0..AROUND {
            for j in 0..TUBE {
                let ((s, c), (t, d)) = (turn(i, AROUND), turn(j, TUBE));
                let r = 2.0 + 0.5 * d;
                positions.push(DVec3::new(r * c, r * s, 0.5 * t).as_vec3());
                let at = |i: u32, j: u32| i % AROUND * TUBE + j % TUBE;
                let [a, b, e, f] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                indices.extend([a, b, e, a, e, f]);
            }
        }
        let weld = Weld::new(&positions, |_, _| Ordering::Equal);
        let topology = Topology::build(&indices, &positions, weld, |_| true);
        assert!(topology.report().is_solid());
        let welded = topology.weld().vertex_of_welded.iter().map(|&v| positions[v as usize]).collect();
        (topology, welded)
    }

    /// By the silhouette, and by every light-facing triangle: K's plain way.
    fn both_ways(topology: &Topology, welded: &[Vec3], light: DVec4) -> [Outline; 2] {
        let mut planes = Planes::default();
        planes.build(topology, welded);
        let mut facing = Facing::default();
        facing.decide(topology, &planes, welded, light.as_vec4());
        let mut edges = Vec::new();
        silhouette(topology, &facing, &mut edges);
        let bounds = Aabb::from_points(welded.iter().copied());
        let plane = flattening_plane(welded.iter().copied(), &bounds, light).unwrap();
        assert!(welded.iter().all(|v| plane.height(v.as_dvec3().extend(1.0)) > 0.0), "the plane is behind");
        let counted = topology.triangles().iter().zip(facing.contributions()).filter(|(_, counts)| **counts != 0);
        let every: Vec<_> = counted
            .flat_map(|(&[a, b, c], &counts)| if counts > 0 { [[a, b], [b, c], [c, a]] } else { [[a, c], [c, b], [b, a]] })
            .collect();
        let mut flattener = Flattener::default();
        // Each triangle's edges close by themselves, so `loops` may walk them in any grouping.
        [edges, every].map(|edges| flattener.flatten(welded, &edges, &plane, light))
    }

    #[test]
    fn a_torus_seen_from_its_axis_is_a_ring() {
        let (topology, welded) = torus();
        for light in [DVec4::new(0.0, 0.0, 1.0, 0.0), DVec4::new(0.0, 0.0, 9.0, 1.0)] {
            let [outline, every] = both_ways(&topology, &welded, light);
            let contours = contours(&outline);
            assert_eq!(contours.len(), 2, "{contours:?}");
            assert!(contours[0] < 0.0 && contours[1] > 0.0);
            assert!((area(&outline) - area(&every)).abs() < 1e-6 * area(&every));
            assert_eq!(outline.edges.len(), 96, "two rings of 48 corners");
        }
        let [sun, _] = both_ways(&topology, &welded, DVec4::new(0.0, 0.0, 1.0, 0.0));
        let polygon = |radius: f64| 24.0 * (TAU / 48.0).sin() * radius * radius;
        assert!((area(&sun) - polygon(2.5) + polygon(1.5)).abs() < 1e-5, "{} of about {}", area(&sun), 4.0 * PI);
    }

    #[test]
    fn the_silhouette_alone_gives_the_union_of_all_triangles() {
        let (topology, welded) = torus();
        let lights = [(9.0, 0.0, 2.0, 1.0), (5.0, 3.0, 4.0, 1.0), (-1.0, 0.2, 0.1, 0.0), (2.0, 6.0, -7.0, 1.0)];
        for light in lights.map(DVec4::from) {
            let [outline, every] = both_ways(&topology, &welded, light);
            assert!(area(&outline) > 1.0 && outline.edges.len() > 40);
            assert!((area(&outline) - area(&every)).abs() < 1e-6 * area(&every), "{light}");
        }
    }

    #[test]
    fn a_light_inside_or_close_above_cannot_flatten() {
        let (_, welded) = torus();
        let bounds = Aabb::from_points(welded.iter().copied());
        let plane = |light: (f64, f64, f64, f64)| flattening_plane(welded.iter().copied(), &bounds, light.into());
        assert!(plane((0.0, 0.0, 9.0, 1.0)).is_some() && plane((0.0, 0.0, -1.0, 0.0)).is_some());
        assert!(plane((0.0, 0.0, 0.6, 1.0)).is_none(), "close above the hole");
        assert!(plane((2.0, 0.0, 0.0, 1.0)).is_none(), "inside the tube");
        assert!(flattening_plane([], &Aabb::EMPTY, DVec4::Z).is_none());
    }

    #[test]
    fn loops_use_every_edge_once() {
        // A bow tie through vertex 0, and one edge twice.
        let mut edges = vec![[0, 1], [1, 2], [2, 0], [0, 3], [3, 4], [4, 0], [5, 6], [6, 7], [7, 5], [5, 6], [6, 8], [8, 5]];
        let total: usize = loops(&mut edges).iter().map(Vec::len).sum();
        assert_eq!(total, 12);
        assert!(loops(&mut []).is_empty());
    }
}
