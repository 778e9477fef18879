//! Meshes as words of 32 bits, one after the other, for silhouettes that are found in a compute shader.
//!
//! What never moves (triangles, neighbours, edges) lies in one arena, what a pose moves (planes, welded vertices) in
//! another. `shaders/silhouettes.wgsl` reads both.

use super::silhouette::Posed;
use super::topology::directed_edges;
use super::{Outline, Topology, VolumeParts};

/// No neighbour across this edge: it is not one of two triangles that run it in opposite directions.
pub const NONE: u32 = u32::MAX;
/// Set in a triangle's first corner where it belongs to the soup.
pub const SOUP: u32 = 1 << 31;

/// Where a mesh's topology stands, in words from its beginning.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Fixed {
    /// Three corners a triangle, the first with [`SOUP`].
    pub triangles: u32,
    /// Three a triangle, across the edges from its first corner on: a triangle, or [`NONE`].
    pub neighbours: u32,
    /// Four a pair edge: the ends, the triangle that runs along, the one that runs back.
    pub pairs: u32,
    /// Four for each other edge: the ends, where its incidences start among all, how many.
    pub others: u32,
    /// As [`super::topology::OtherEdges::incidences`].
    pub incidences: u32,
    /// All of it.
    pub words: u32,
}

impl Fixed {
    /// Of a topology.
    #[must_use]
    pub fn of(topology: &Topology) -> Self {
        let count = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
        let triangles = count(topology.triangles().len());
        let neighbours = triangles * 3;
        let pairs = neighbours + triangles * 3;
        let others = pairs + count(topology.pairs().a.len()) * 4;
        let incidences = others + count(topology.others().ends.len()) * 4;
        let words = incidences + count(topology.others().incidences.len());
        Self { triangles: 0, neighbours, pairs, others, incidences, words }
    }
}

/// Appends a topology, as [`Fixed`] says.
pub fn append_fixed(topology: &Topology, words: &mut Vec<u32>) {
    let pairs = topology.pairs();
    for (&[a, b, c], &soup) in topology.triangles().iter().zip(topology.two_sided()) {
        words.extend([if soup { a | SOUP } else { a }, b, c]);
    }
    for triangle in topology.triangles() {
        words.extend(directed_edges(triangle).map(|[from, to]| match pairs.between(from, to) {
            Some(edge) if from < to => pairs.backward[edge],
            Some(edge) => pairs.forward[edge],
            None => NONE,
        }));
    }
    for edge in 0..pairs.a.len() {
        words.extend([pairs.a[edge], pairs.b[edge], pairs.forward[edge], pairs.backward[edge]]);
    }
    let others = topology.others();
    for (&[a, b], &[start, end]) in others.ends.iter().zip(others.starts.array_windows()) {
        words.extend([a, b, start, end - start]);
    }
    words.extend(&others.incidences);
}

/// Words of a pose: five a triangle, and after them three a welded vertex.
#[must_use]
pub fn posed_words(topology: &Topology) -> u64 {
    topology.triangles().len() as u64 * 5 + topology.weld().len() as u64 * 3
}

/// Appends a pose's planes (normal, offset, narrowness) and welded vertices, as bits.
pub fn append_posed(posed: &Posed, words: &mut Vec<u32>) {
    posed.planes.append_words(words);
    words.extend(posed.welded.iter().flat_map(|vertex| vertex.to_array()).map(f32::to_bits));
}

/// The most indices that parts of a volume can have: of sides, the light cap, the dark cap, the start cap.
#[must_use]
pub fn most_indices(topology: &Topology, parts: VolumeParts) -> [u64; 4] {
    debug_assert_eq!(parts.outline, Outline::Silhouette, "single polygons are the CPU's");
    // Between two triangles that count from both sides stand up to two sides.
    let soup = topology.report().solid_components != topology.report().components;
    let pairs = topology.pairs().a.len() as u64 * if soup { 2 } else { 1 };
    let edges = pairs + topology.others().incidences.len() as u64;
    let triangles = topology.triangles().len() as u64;
    let of = |wanted: bool, count: u64| if wanted { count } else { 0 };
    let cap = triangles.max(edges) * 3;
    [of(parts.sides, edges * 6), of(parts.light_cap, triangles * 3), of(parts.dark_cap, cap), of(parts.start_cap, cap)]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;
    use crate::geometry::Weld;
    use glam::Vec3;
    use std::cmp::Ordering;

    #[test]
    fn an_open_tetrahedron_stands_where_its_layout_says() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        let weld = Weld::new(&positions, |_, _| Ordering::Equal);
        let topology = Topology::build(&[0, 2, 1, 0, 1, 3, 1, 2, 3], &positions, weld, |_| true);
        let mut words = Vec::new();
        append_fixed(&topology, &mut words);
        let Fixed { neighbours, pairs, others, incidences, words: all, .. } = Fixed::of(&topology);
        assert_eq!(words.len(), all as usize);
        let at = |start: u32, count: usize| &words[start as usize..start as usize + count];
        assert_eq!(at(0, 3), [SOUP, 2, 1], "it is open");
        assert_eq!(at(neighbours, 3), [NONE, 2, 1], "of the first: a border, and the two others");
        assert_eq!(at(pairs, 4), [0, 1, 1, 0]);
        assert_eq!(at(others, 4), [0, 2, 0, 1]);
        assert_eq!(at(incidences, 1), [0], "the first triangle runs it forward");
        let mut posed = Vec::new();
        append_posed(&Posed::new(&topology, &positions), &mut posed);
        assert_eq!(posed.len() as u64, posed_words(&topology));
        assert_eq!(posed[..3], [0.0f32, 0.0, -1.0].map(f32::to_bits), "the first looks down");
    }
}
