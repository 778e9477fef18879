//! Volumes built wrongly, on purpose: what the failure gallery shows of geometry.
//!
//! Every flaw but one is another topology over the same welded vertices, so the volume's vertex
//! buffer stays what it was and only its indices go wrong:
//!
//! ```text
//!   assumed closed          coarser               T-junction
//!     ____ ____          .-'''-.    /\              a               a
//!    |    |    |        (       )  /  \            /|\             /|
//!    |____|__  :         '-...-'   \  /     x ---m | > y    x     m | > y
//!              ^ border,            \/             \|/       \     \|
//!                no side there                      c         '---- c
//! ```

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};
use serde::Serialize;

use super::topology::{Topology, directed_edges};

/// How a volume is built wrongly.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Flaw {
    /// By the rules for closed meshes, whatever the mesh: only what faces the light counts, and
    /// only edges of two triangles can be silhouette edges (M section 4 demands such meshes).
    AssumedClosed,
    /// From fewer triangles than are drawn: vertices of one cell of a grid become one (K 6.2.2).
    Coarser,
    /// Where an edge is divided on both sides, one side forgets it: T-junctions (M section 4).
    TJunctions,
    /// The dark cap is a fan over the silhouette also where that is not within a half-space.
    FanAcross,
}

/// Cells along a caster's longest side when its volume is coarser.
const CELLS: f32 = 7.0;

/// How far a vertex may stray from the edge it divides, as a share of that edge, and still be taken for
/// one that divides it.
const STRAY: f64 = 0.01;

impl Flaw {
    /// The topology that the flawed volume is built from; `None` where it is the mesh's own. `welded`
    /// are its welded vertices, object space, which the result is over too.
    #[must_use]
    pub fn topology(self, topology: &Topology, welded: &[Vec3]) -> Option<Topology> {
        match self {
            Self::AssumedClosed => Some(topology.assumed_closed()),
            Self::Coarser => Some(Topology::of_welded(coarser(topology.triangles(), welded), welded)),
            Self::TJunctions => Some(Topology::of_welded(undivided(topology.triangles(), welded), welded)),
            Self::FanAcross => None,
        }
    }
}

/// The triangles between the cells' first vertices.
fn coarser(triangles: &[[u32; 3]], welded: &[Vec3]) -> Vec<[u32; 3]> {
    let used = || triangles.iter().flatten().map(|&vertex| welded[vertex as usize]);
    let least = used().fold(Vec3::INFINITY, Vec3::min);
    let most = used().fold(Vec3::NEG_INFINITY, Vec3::max);
    let cell = ((most - least).max_element() / CELLS).max(f32::MIN_POSITIVE);
    let mut first: BTreeMap<[i32; 3], u32> = BTreeMap::new();
    let kept: Vec<u32> = (0u32..)
        .zip(welded)
        .map(|(vertex, &place)| {
            let at = ((place - least) / cell).floor().as_ivec3().to_array();
            *first.entry(at).or_insert(vertex)
        })
        .collect();
    let moved = triangles.iter().map(|triangle| triangle.map(|vertex| kept[vertex as usize]));
    moved.filter(|[a, b, c]| a != b && b != c && c != a).collect()
}

/// The triangles, pairs of them joined into one where the vertex between them lies on the joint edge.
///
/// ```text
///     x            x
///    /|\          / \
///   a-m-c   ->   a---c       m stays a corner on the other side of a - c
/// ```
fn undivided(triangles: &[[u32; 3]], welded: &[Vec3]) -> Vec<[u32; 3]> {
    let place = |vertex: u32| -> DVec3 { welded[vertex as usize].as_dvec3() };
    let divides = |m: u32, a: u32, c: u32| {
        let (edge, way) = (place(c) - place(a), place(m) - place(a));
        let share = way.dot(edge) / edge.length_squared();
        share > 0.0 && share < 1.0 && way.distance(edge * share) < STRAY * edge.length()
    };
    let mut triangles: Vec<Option<[u32; 3]>> = triangles.iter().copied().map(Some).collect();
    let mut of_edge: BTreeMap<[u32; 2], usize> = BTreeMap::new();
    for (number, triangle) in triangles.iter().enumerate() {
        of_edge.extend(triangle.iter().flat_map(directed_edges).map(|edge| (edge, number)));
    }
    // A joint triangle may be joined with the next: on until nothing is.
    let mut again: Vec<usize> = (0..triangles.len()).collect();
    while let Some(number) = again.pop() {
        let Some(triangle) = triangles[number] else { continue };
        for [m, x] in directed_edges(&triangle).into_iter().flat_map(|[a, b]| [[a, b], [b, a]]) {
            // One of the pair runs m -> x, the other x -> m.
            let Some(&other) = of_edge
                .get(&[m, x])
                .filter(|other| **other != number)
                .or_else(|| of_edge.get(&[x, m]).filter(|other| **other != number))
            else {
                continue;
            };
            let Some(beyond) = triangles[other] else { continue };
            let third = |of: [u32; 3]| of.into_iter().find(|vertex| ![m, x].contains(vertex));
            let (Some(a), Some(c)) = (third(triangle), third(beyond)) else { continue };
            if a == c || !divides(m, a, c) {
                continue;
            }
            let joint = triangle.map(|vertex| if vertex == m { c } else { vertex });
            for edge in directed_edges(&triangle).into_iter().chain(directed_edges(&beyond)) {
                of_edge.remove(&edge);
            }
            triangles[other] = None;
            triangles[number] = Some(joint);
            of_edge.extend(directed_edges(&joint).map(|edge| (edge, number)));
            again.push(number);
            break;
        }
    }
    triangles.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails may panic")]
    use std::cmp::Ordering;

    use super::*;
    use crate::geometry::Weld;

    fn topology(places: &[Vec3], triangles: &[[u32; 3]]) -> Topology {
        Topology::build(triangles.as_flattened(), places, Weld::new(places, |_, _| Ordering::Equal), |_| true)
    }

    /// Two squares side by side; the long edge between them is divided in three for both, by
    /// vertices that a coarse grid has moved.
    fn seam() -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let places = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [3.004, 2.0], [3.0, 3.0], [0.0, 3.0], [6.0, 0.0], [6.0, 3.0]];
        let places = places.map(|[x, y]| Vec3::new(x, y, 0.5)).to_vec();
        // Left a fan about vertex 0, which spans the long edge; right one that cannot forget it.
        let left = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
        let right = [[1, 6, 2], [2, 6, 3], [3, 6, 7], [3, 7, 4]];
        (places, left.into_iter().chain(right).collect())
    }

    #[test]
    fn a_divided_edge_is_forgotten_on_one_side() {
        let (places, triangles) = seam();
        let flawed = Flaw::TJunctions.topology(&topology(&places, &triangles), &places).unwrap();
        let mut left: Vec<_> = flawed.triangles()[..2].to_vec();
        left.iter_mut().for_each(|triangle| triangle.sort_unstable());
        left.sort_unstable();
        assert_eq!(left, [[0, 1, 4], [0, 4, 5]], "{:?}", flawed.triangles());
        assert!(flawed.report().border_edges > topology(&places, &triangles).report().border_edges);
        let area = |triangles: &[[u32; 3]]| -> f32 {
            let twice = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a).z;
            triangles.iter().map(|triangle| twice(triangle.map(|vertex| places[vertex as usize])) / 2.0).sum()
        };
        assert!((area(flawed.triangles()) - 18.0).abs() < 0.05, "nothing is lost or turned over but the slivers");
    }

    #[test]
    fn what_is_assumed_closed_has_no_border_and_no_soup() {
        let (places, triangles) = seam();
        let whole = topology(&places, &triangles);
        assert!(!whole.others().ends.is_empty() && whole.two_sided()[0]);
        let flawed = Flaw::AssumedClosed.topology(&whole, &places).unwrap();
        assert!(flawed.others().ends.is_empty());
        assert!(flawed.two_sided().iter().all(|soup| !soup));
        assert_eq!(flawed.triangles(), whole.triangles());
        assert_eq!(flawed.pairs().a, whole.pairs().a);
    }

    #[test]
    fn coarser_has_fewer_triangles_over_the_same_vertices() {
        let side = 40u32;
        let places: Vec<Vec3> =
            (0..side * side).map(|i| Vec3::new((i % side) as f32, (i / side) as f32 * 0.5, ((i % 7) as f32) * 0.1)).collect();
        let mut triangles = Vec::new();
        for (x, y) in (0..side - 1).flat_map(|x| (0..side - 1).map(move |y| (x, y))) {
            let at = x + y * side;
            triangles.extend([[at, at + 1, at + side + 1], [at, at + side + 1, at + side]]);
        }
        let flawed = Flaw::Coarser.topology(&topology(&places, &triangles), &places).unwrap();
        assert!((10..triangles.len() / 10).contains(&flawed.triangles().len()), "{}", flawed.triangles().len());
        assert_eq!(flawed.weld().len(), places.len());
    }
}
