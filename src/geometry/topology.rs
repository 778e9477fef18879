//! Edges of welded triangles: built once a mesh, read by every silhouette.
//!
//! Each triangle of the mesh, in the mesh's own vertex order, becomes a triangle of welded
//! vertices; those with two equal corners enclose nothing and are dropped. Every edge (a < b) keeps
//! the triangles it borders, each with a sign: +1 where the triangle runs a -> b, -1 where b -> a.
//!
//! **Solid and soup.** Triangles joined by edges form components. A component whose every edge sums
//! to zero is a surface without border; if besides it encloses a positive volume, its triangles
//! face outwards and it is *solid*: what enters it leaves it, so counting the triangles that face
//! the light is enough (M section 2). Every other component is *soup*: open, unbalanced, inside out
//! or of no volume. There every triangle counts, turned to face the light (the general form of
//! Bergeron and of Kim et al.), which makes any heap of triangles cast the right shadow.
//!
//! A light inside a solid is faced by none of its triangles and shines out, as through a lamp's
//! globe; inside soup it is shut in.
//!
//! Deformation moves vertices, not edges: a pose uses the topology, and the solid flags, of the
//! shape that was built.

use glam::{DVec3, Vec3};
use serde::Serialize;

use super::Weld;
use super::cutout::CutoutPlane;
use super::overlap::is_convex;

/// Most vertices, and most indices, of a mesh. A volume has up to eight indices for each index of
/// its mesh, and for several lights they stand in one buffer: all are to be numbered by 32 bits.
pub const LARGEST: usize = 1 << 26;

/// The welded triangles and edges of a mesh.
#[derive(Debug, Clone, Default)]
pub struct Topology {
    weld: Weld,
    triangles: Vec<[u32; 3]>,
    mesh_triangles: Vec<u32>,
    two_sided: Vec<bool>,
    pairs: PairEdges,
    others: OtherEdges,
    plane: Option<CutoutPlane>,
    report: TopologyReport,
    convex: bool,
}

/// Edges with exactly two triangles, one in each direction: all there are in a solid mesh. Arrays
/// of equal length, for the hot loop.
#[derive(Debug, Clone, Default)]
pub struct PairEdges {
    /// Smaller welded vertex.
    pub a: Vec<u32>,
    /// Larger welded vertex.
    pub b: Vec<u32>,
    /// The triangle that runs a -> b.
    pub forward: Vec<u32>,
    /// The triangle that runs b -> a.
    pub backward: Vec<u32>,
    /// Of each welded vertex, where the edges start whose smaller end it is; one more than there are vertices.
    pub starts: Vec<u32>,
}

impl PairEdges {
    /// The edge between two vertices, by its number; `None` where there is none of two triangles.
    #[must_use]
    pub fn between(&self, from: u32, to: u32) -> Option<usize> {
        let [a, b] = [from.min(to), from.max(to)];
        let &[start, end] = self.starts.get(a as usize..)?.first_chunk::<2>()?;
        let found = self.b[start as usize..end as usize].binary_search(&b).ok()?;
        Some(start as usize + found)
    }
}

/// All other edges, in compressed rows.
#[derive(Debug, Clone, Default)]
pub struct OtherEdges {
    /// The welded vertices (a, b), a < b.
    pub ends: Vec<[u32; 2]>,
    /// Where an edge's incidences start; one more than there are edges.
    pub starts: Vec<u32>,
    /// Triangle number times two, plus one where it runs b -> a.
    pub incidences: Vec<u32>,
}

impl OtherEdges {
    /// Each edge's ends with its (triangle, sign) pairs.
    pub fn iter(&self) -> impl Iterator<Item = ([u32; 2], impl Iterator<Item = (u32, i32)>)> {
        self.ends.iter().zip(self.starts.array_windows()).map(|(&ends, &[start, end])| {
            let of_edge = &self.incidences[start as usize..end as usize];
            (ends, of_edge.iter().map(|&incidence| (incidence >> 1, 1 - 2 * (incidence & 1) as i32)))
        })
    }
}

/// What a mesh is made of, and so how its volume is built.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct TopologyReport {
    /// That cast shadows, without the degenerate ones.
    pub triangles: usize,
    /// Dropped: two of the corners are one welded vertex.
    pub degenerate: usize,
    /// After welding.
    pub welded_vertices: usize,
    /// Groups of triangles joined by edges.
    pub components: usize,
    /// Of those, without border: every edge is run as often one way as the other.
    pub closed_components: usize,
    /// Of those, enclosing a positive volume: their light-facing triangles alone are counted.
    pub solid_components: usize,
    /// Of the closed ones, enclosing a negative volume.
    pub inside_out_components: usize,
    /// Edges of one triangle.
    pub border_edges: usize,
    /// Edges of more than two triangles, or of two that run the same way.
    pub non_manifold_edges: usize,
}

impl TopologyReport {
    /// Every component is solid, and there is one.
    #[must_use]
    pub fn is_solid(&self) -> bool {
        self.components > 0 && self.solid_components == self.components
    }
}

impl Topology {
    /// From the mesh's `indices` (three a triangle, in range of `positions`), the vertices welded
    /// by `weld`. `casts` says of a triangle, by its number in `indices`, whether it casts a
    /// shadow; the others are left out.
    ///
    /// At most [`LARGEST`] positions and indices.
    #[must_use]
    pub fn build(indices: &[u32], positions: &[Vec3], weld: Weld, casts: impl Fn(u32) -> bool) -> Self {
        let mut topology = Self { weld, ..Self::default() };
        for (triangle, number) in indices.as_chunks::<3>().0.iter().zip(0u32..) {
            let welded = triangle.map(|vertex| topology.weld.welded_of_vertex[vertex as usize]);
            if !casts(number) {
                continue;
            }
            if welded[0] == welded[1] || welded[1] == welded[2] || welded[2] == welded[0] {
                topology.report.degenerate += 1;
                continue;
            }
            topology.triangles.push(welded);
            topology.mesh_triangles.push(number);
        }
        topology.report.triangles = topology.triangles.len();
        topology.report.welded_vertices = topology.weld.len();
        topology.find_edges();
        topology.find_solids(positions);
        topology.convex = is_convex(&topology, positions);
        topology.plane = topology.plane_of(positions);
        topology
    }

    /// Of triangles that are welded already, all of which cast: the volume's vertices are `welded`.
    #[must_use]
    pub fn of_welded(triangles: Vec<[u32; 3]>, welded: &[Vec3]) -> Self {
        let mut topology = Self::joined(triangles, welded);
        topology.find_solids(welded);
        topology
    }

    /// The same of a part of another mesh: which of the triangles count from both sides is as it was there.
    #[must_use]
    pub fn of_part(triangles: Vec<[u32; 3]>, welded: &[Vec3], two_sided: Vec<bool>) -> Self {
        Self { two_sided, ..Self::joined(triangles, welded) }
    }

    fn joined(triangles: Vec<[u32; 3]>, welded: &[Vec3]) -> Self {
        let same: Vec<u32> = (0..welded.len() as u32).collect();
        let weld = Weld { welded_of_vertex: same.clone(), vertex_of_welded: same };
        let mut topology = Self { weld, mesh_triangles: (0..triangles.len() as u32).collect(), triangles, ..Self::default() };
        topology.report.triangles = topology.triangles.len();
        topology.report.welded_vertices = welded.len();
        topology.find_edges();
        topology
    }

    /// The same triangles as software sees them that takes every mesh for closed: no soup, and no
    /// edges but those of two triangles.
    #[must_use]
    pub fn assumed_closed(&self) -> Self {
        Self { two_sided: vec![false; self.triangles.len()], others: OtherEdges::default(), ..self.clone() }
    }

    fn find_edges(&mut self) {
        // Directed edges, sorted into buckets by their smaller end, then each small bucket by the
        // larger end and the triangle: in all O(n) for ordinary meshes, O(n log n) for any.
        let mut starts = vec![0u32; self.weld.len() + 1];
        for edge in self.triangles.iter().flat_map(directed_edges) {
            starts[edge[0].min(edge[1]) as usize + 1] += 1;
        }
        for at in 1..starts.len() {
            starts[at] += starts[at - 1];
        }
        let mut next = starts.clone();
        let mut sorted = vec![0u64; self.triangles.len() * 3];
        for (triangle, number) in self.triangles.iter().zip(0u64..) {
            for [from, to] in directed_edges(triangle) {
                let slot = &mut next[from.min(to) as usize];
                sorted[*slot as usize] = u64::from(from.max(to)) << 32 | number << 1 | u64::from(from > to);
                *slot += 1;
            }
        }

        self.others.starts.push(0);
        self.pairs.starts.push(0);
        for (a, bucket) in (0u32..).zip(starts.array_windows()).map(|(a, &[start, end])| (a, start as usize..end as usize)) {
            let bucket = &mut sorted[bucket];
            bucket.sort_unstable();
            for edge in bucket.chunk_by(|x, y| x >> 32 == y >> 32) {
                let b = (edge[0] >> 32) as u32;
                let reversed = edge.iter().filter(|&half| half & 1 == 1).count();
                match (edge.len(), reversed) {
                    (2, 1) => {
                        let triangles = [edge[0], edge[1]].map(|half| (half as u32) >> 1);
                        let first_is_forward = edge[0] & 1 == 0;
                        self.pairs.a.push(a);
                        self.pairs.b.push(b);
                        self.pairs.forward.push(triangles[usize::from(!first_is_forward)]);
                        self.pairs.backward.push(triangles[usize::from(first_is_forward)]);
                    }
                    (count, _) => {
                        if count == 1 {
                            self.report.border_edges += 1;
                        } else {
                            self.report.non_manifold_edges += 1;
                        }
                        self.others.ends.push([a, b]);
                        self.others.incidences.extend(edge.iter().map(|&half| half as u32));
                        self.others.starts.push(self.others.incidences.len() as u32);
                    }
                }
            }
            self.pairs.starts.push(self.pairs.a.len() as u32);
        }
    }

    fn find_solids(&mut self, positions: &[Vec3]) {
        let mut components = DisjointSets::new(self.triangles.len());
        for (&forward, &backward) in self.pairs.forward.iter().zip(&self.pairs.backward) {
            components.join(forward, backward);
        }
        let mut unbalanced = Vec::new();
        for (_, incidences) in self.others.iter() {
            let mut sum = 0;
            let mut first = None;
            for (triangle, sign) in incidences {
                components.join(*first.get_or_insert(triangle), triangle);
                sum += sign;
            }
            unbalanced.extend(first.filter(|_| sum != 0));
        }

        #[derive(Clone, Copy)]
        struct Enclosed {
            open: bool,
            origin: DVec3,
            volume: f64,
            /// Sum of the absolute terms, to tell a volume from its rounding.
            terms: f64,
        }
        let mut enclosed: Vec<Option<Enclosed>> = vec![None; self.triangles.len()];
        for (triangle, number) in self.triangles.iter().zip(0u32..) {
            let corners = triangle.map(|welded| positions[self.weld.vertex_of_welded[welded as usize] as usize].as_dvec3());
            let component = enclosed[components.root(number) as usize].get_or_insert(Enclosed {
                open: false,
                origin: corners[0],
                volume: 0.0,
                terms: 0.0,
            });
            // About a point of the component itself: far from the origin digits would be lost.
            let [a, b, c] = corners.map(|corner| corner - component.origin);
            let area = (b - a).cross(c - a);
            component.volume += a.dot(area);
            component.terms += a.length() * area.length();
        }
        for triangle in unbalanced {
            if let Some(component) = &mut enclosed[components.root(triangle) as usize] {
                component.open = true;
            }
        }

        // Below this share of its terms a volume is none: a sheet with two sides, rounded.
        const NOTHING: f64 = 1e-10;
        let solid = |component: &Enclosed| !component.open && component.volume > NOTHING * component.terms;
        for component in enclosed.iter().flatten() {
            self.report.components += 1;
            self.report.closed_components += usize::from(!component.open);
            self.report.solid_components += usize::from(solid(component));
            self.report.inside_out_components += usize::from(!component.open && component.volume < -NOTHING * component.terms);
        }
        self.two_sided = (0..self.triangles.len() as u32)
            .map(|triangle| !enclosed[components.root(triangle) as usize].as_ref().is_some_and(solid))
            .collect();
    }

    /// What is what after welding.
    #[must_use]
    pub fn weld(&self) -> &Weld {
        &self.weld
    }

    /// The triangles' welded vertices, in the mesh's own order and rotation.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Which triangle of the mesh's indices each one is.
    #[must_use]
    pub fn mesh_triangles(&self) -> &[u32] {
        &self.mesh_triangles
    }

    /// Of each triangle: it belongs to the soup, and counts from both sides.
    #[must_use]
    pub fn two_sided(&self) -> &[bool] {
        &self.two_sided
    }

    /// Edges with a triangle on each side.
    #[must_use]
    pub fn pairs(&self) -> &PairEdges {
        &self.pairs
    }

    /// Edges with any other number of triangles.
    #[must_use]
    pub fn others(&self) -> &OtherEdges {
        &self.others
    }

    /// As it was built it is one convex solid ([`is_convex`]): its volumes wind around no point twice.
    #[must_use]
    pub fn convex(&self) -> bool {
        self.convex
    }

    /// The plane on which all of it lies, where there is one: the mesh is a planar cut-out.
    #[must_use]
    pub fn plane(&self) -> Option<CutoutPlane> {
        self.plane
    }

    /// The same for the mesh's vertices at other positions.
    #[must_use]
    pub fn plane_of(&self, positions: &[Vec3]) -> Option<CutoutPlane> {
        let position = |&welded: &u32| positions[self.weld.vertex_of_welded[welded as usize] as usize];
        CutoutPlane::of(self.triangles.iter().flatten().map(position))
    }

    /// What the mesh is made of.
    #[must_use]
    pub fn report(&self) -> &TopologyReport {
        &self.report
    }
}

/// A triangle's edges, as it runs along them.
pub(super) fn directed_edges(&[a, b, c]: &[u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// Union-find with path halving, the smaller number on top.
struct DisjointSets {
    parent: Vec<u32>,
}

impl DisjointSets {
    fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).collect() }
    }

    fn root(&mut self, mut at: u32) -> u32 {
        while self.parent[at as usize] != at {
            let above = self.parent[self.parent[at as usize] as usize];
            self.parent[at as usize] = above;
            at = above;
        }
        at
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b) as usize] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cmp::Ordering;

    fn build(positions: &[Vec3], indices: &[u32]) -> Topology {
        Topology::build(indices, positions, Weld::new(positions, |_, _| Ordering::Equal), |_| true)
    }

    /// A tetrahedron, outward, about `at`.
    fn tetrahedron(at: Vec3) -> (Vec<Vec3>, Vec<u32>) {
        (vec![at, at + Vec3::X, at + Vec3::Y, at + Vec3::Z], vec![0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3])
    }

    #[test]
    fn a_tetrahedron_is_solid_far_from_the_origin_and_when_split() {
        let (positions, indices) = tetrahedron(Vec3::splat(1e4));
        // Every triangle with vertices of its own, as flat shading has them.
        let split: Vec<Vec3> = indices.iter().map(|&index| positions[index as usize]).collect();
        let topology = build(&split, &(0..12).collect::<Vec<_>>());
        assert_eq!(
            *topology.report(),
            TopologyReport {
                triangles: 4,
                welded_vertices: 4,
                components: 1,
                closed_components: 1,
                solid_components: 1,
                ..TopologyReport::default()
            }
        );
        assert!(topology.report().is_solid());
        assert_eq!(topology.pairs().a.len(), 6);
        assert!(topology.others().ends.is_empty());
        assert!(topology.two_sided().iter().all(|soup| !soup));
        for edge in 0..6 {
            let pairs = topology.pairs();
            let (a, b) = (pairs.a[edge], pairs.b[edge]);
            let runs = |triangle: u32, ends: [u32; 2]| directed_edges(&topology.triangles()[triangle as usize]).contains(&ends);
            assert!(a < b && runs(pairs.forward[edge], [a, b]) && runs(pairs.backward[edge], [b, a]));
        }
    }

    #[test]
    fn inside_out_open_and_flat_components_are_soup() {
        let (mut positions, mut indices) = tetrahedron(Vec3::ZERO);
        let add = |other: (Vec<Vec3>, Vec<u32>), positions: &mut Vec<Vec3>, indices: &mut Vec<u32>| {
            indices.extend(other.1.iter().map(|index| index + positions.len() as u32));
            positions.extend(other.0);
        };
        let mut inside_out = tetrahedron(Vec3::X * 5.0);
        inside_out.1.reverse();
        add(inside_out, &mut positions, &mut indices);
        let mut open = tetrahedron(Vec3::Y * 5.0);
        open.1.truncate(9);
        add(open, &mut positions, &mut indices);
        // A sheet with a front and a back, and a triangle with two corners in one place.
        add(
            (vec![Vec3::Z, Vec3::new(0.3, 0.1, 7.0), Vec3::new(-2.0, 0.7, 9.0)], vec![0, 1, 2, 1, 0, 2, 0, 1, 1]),
            &mut positions,
            &mut indices,
        );
        let topology = build(&positions, &indices);
        assert_eq!(
            *topology.report(),
            TopologyReport {
                triangles: 13,
                degenerate: 1,
                welded_vertices: 14,
                components: 4,
                closed_components: 3,
                solid_components: 1,
                inside_out_components: 1,
                border_edges: 3,
                non_manifold_edges: 0,
            }
        );
        assert!(!topology.report().is_solid());
        let soup: Vec<bool> = (0..13).map(|triangle| triangle >= 4).collect();
        assert_eq!(topology.two_sided(), soup);
    }

    #[test]
    fn a_book_of_three_pages_has_a_non_manifold_spine() {
        let positions = [Vec3::ZERO, Vec3::Z, Vec3::X, Vec3::Y, Vec3::NEG_X];
        let topology = build(&positions, &[0, 1, 2, 1, 0, 3, 0, 1, 4]);
        assert_eq!(topology.report().non_manifold_edges, 1);
        assert_eq!(topology.report().border_edges, 6);
        assert_eq!(topology.report().components, 1);
        let spine: Vec<_> =
            topology.others().iter().filter(|(ends, _)| *ends == [0, 1]).flat_map(|(_, incidences)| incidences).collect();
        assert_eq!(spine, [(0, 1), (1, -1), (2, 1)]);
    }

    #[test]
    fn a_triangle_that_casts_nothing_leaves_a_hole() {
        let (positions, indices) = tetrahedron(Vec3::ZERO);
        let topology =
            Topology::build(&indices, &positions, Weld::new(&positions, |_, _| Ordering::Equal), |triangle| triangle != 1);
        assert_eq!(topology.mesh_triangles(), [0, 2, 3]);
        assert_eq!(topology.report().border_edges, 3);
        assert!(!topology.report().is_solid());
    }
}
