//! The parts of casters that volumes are thrown from, kept for a frame: one is thrown by many lights, in many views.

use std::collections::HashMap;

use glam::{DAffine3, DVec4, Vec3};

use crate::frame::{Piece, VolumePlan};
use crate::geometry::Portion;
use crate::scene::Mesh;

/// What tells pieces of one caster apart.
pub type Key = (u64, [u64; 4]);

/// By instance and piece.
#[derive(Debug, Default)]
pub struct Portions(HashMap<(usize, Key), Portion>);

/// A piece as bits.
#[must_use]
pub fn key(piece: &Piece) -> Key {
    match piece {
        Piece::Whole => (0, [0; 4]),
        Piece::Before { plane, slack } => (slack.to_bits() | 1, plane.to_array().map(f64::to_bits)),
        Piece::Primitive(number) => (0, [1, *number as u64, 0, 0]),
    }
}

impl Portions {
    /// Another frame: what was cut may have moved.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// The part of a mesh that a volume is thrown from; `welded` are its welded vertices' places.
    pub fn of(&mut self, volume: &VolumePlan, (mesh, world_from_object): (&Mesh, &DAffine3), welded: &[Vec3]) -> &Portion {
        self.0.entry((volume.instance, key(&volume.piece))).or_insert_with(|| match volume.piece {
            Piece::Whole => Portion::default(),
            Piece::Before { plane, slack } => {
                let normal = world_from_object.matrix3.transpose() * plane.truncate();
                let offset = plane.truncate().dot(world_from_object.translation) + plane.w;
                let heights: DVec4 = normal.extend(offset);
                Portion::before(&mesh.topology, welded, heights, slack)
            }
            Piece::Primitive(number) => {
                let of_vertex = &mesh.topology.weld().welded_of_vertex;
                let triangles = mesh.triangles(number).map(|corners| corners.map(|vertex| of_vertex[vertex as usize]));
                let flat = |[a, b, c]: &[u32; 3]| a == b || b == c || c == a;
                Portion::sheet(triangles.filter(|triangle| !flat(triangle)).collect(), welded)
            }
        })
    }
}
