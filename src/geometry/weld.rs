//! Welding: which of a mesh's vertices are one corner of the solid.
//!
//! Files split a vertex wherever its normal, texture coordinate or colour changes; a shadow caster
//! knows only places. Two vertices are welded when their positions are the same *bits* (-0 counts
//! as 0) and everything that moves them is the same too, so that they stay together in every pose.
//! Nothing is welded by a tolerance: the drawn surface and its shadow volume must share their
//! positions bit by bit, and a gap in the one must be the same gap in the other.

use std::cmp::Ordering;

use glam::Vec3;

/// Two-way table between a mesh's vertices and its welded vertices.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Weld {
    /// One per vertex. Welded vertices are numbered in the order in which they first appear.
    pub welded_of_vertex: Vec<u32>,
    /// One per welded vertex: the first of its vertices, which has its position in every pose.
    pub vertex_of_welded: Vec<u32>,
}

impl Weld {
    /// Welds vertices with equal position bits. `moves_alike` orders two vertices (given by index)
    /// by whatever deforms them: only those it calls equal become one.
    ///
    /// There are at most `u32::MAX` vertices.
    #[must_use]
    pub fn new(positions: &[Vec3], mut moves_alike: impl FnMut(u32, u32) -> Ordering) -> Self {
        // Position bits above, the vertex's own number below: one sort of plain integers brings
        // equal places together, the earliest vertex first.
        let mut keys: Vec<u128> =
            positions.iter().zip(0u128..).map(|(position, vertex)| place(*position) << 32 | vertex).collect();
        keys.sort_unstable();
        let vertex = |key: u128| key as u32;

        // The first vertex of each welded group, for every vertex.
        let mut first: Vec<u32> = vec![0; positions.len()];
        for group in keys.chunk_by_mut(|a, b| a >> 32 == b >> 32) {
            group.sort_by(|&a, &b| moves_alike(vertex(a), vertex(b)));
            for alike in group.chunk_by(|&a, &b| moves_alike(vertex(a), vertex(b)) == Ordering::Equal) {
                for &key in alike {
                    first[vertex(key) as usize] = vertex(alike[0]);
                }
            }
        }

        let mut weld = Self { welded_of_vertex: vec![0; positions.len()], vertex_of_welded: Vec::new() };
        for (at, &first) in first.iter().enumerate() {
            weld.welded_of_vertex[at] = if first as usize == at {
                weld.vertex_of_welded.push(first);
                weld.vertex_of_welded.len() as u32 - 1
            } else {
                // The first of a group comes before the rest, so it has its number already.
                weld.welded_of_vertex[first as usize]
            };
        }
        weld
    }

    /// Number of welded vertices.
    #[must_use]
    pub fn len(&self) -> usize {
        self.vertex_of_welded.len()
    }

    /// Has no vertices.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.vertex_of_welded.is_empty()
    }

    /// The welded vertices' positions of a mesh posed as `positions`, into `welded` (cleared first).
    pub fn gather(&self, positions: &[Vec3], welded: &mut Vec<Vec3>) {
        welded.clear();
        welded.extend(self.vertex_of_welded.iter().map(|&vertex| positions[vertex as usize]));
    }
}

/// A position's bits, the two zeros made one.
fn place(position: Vec3) -> u128 {
    let [x, y, z] = position.to_array().map(|value| u128::from((value + 0.0).to_bits()));
    x << 64 | y << 32 | z
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_welded_by_bits_and_zeros_are_one() {
        let close = f32::from_bits(1.0f32.to_bits() + 1);
        let positions = [Vec3::X, Vec3::new(close, 0.0, 0.0), Vec3::new(1.0, -0.0, 0.0), Vec3::X, Vec3::Y];
        let weld = Weld::new(&positions, |_, _| Ordering::Equal);
        assert_eq!(weld.welded_of_vertex, [0, 1, 0, 0, 2]);
        assert_eq!(weld.vertex_of_welded, [0, 1, 4]);
    }

    #[test]
    fn what_moves_apart_stays_apart() {
        let positions = [Vec3::X; 5];
        let bones = [2, 1, 2, 1, 3];
        let weld = Weld::new(&positions, |a, b| bones[a as usize].cmp(&bones[b as usize]));
        assert_eq!(weld.welded_of_vertex, [0, 1, 0, 1, 2]);
        let mut places = vec![Vec3::ZERO];
        weld.gather(&positions, &mut places);
        assert_eq!(places, [Vec3::X; 3]);
    }
}
