//! Where a ray enters and leaves two solids put together: by the intervals that it spends in each of them.

use glam::DVec3;

use super::tree::{Bundle, Stack, Tree};
use super::world::World;
use crate::geometry::Aabb;
use crate::settings::Operation;

use super::eye::{SLACK, enters};

/// The faces of A and B, apart from all others: none of them is a surface by itself.
#[derive(Debug)]
pub struct Combined {
    operation: Operation,
    tree: Tree,
    /// Of each box of the tree, the face's number in the world, and whether it is B's.
    faces: Vec<(u32, bool)>,
}

/// The border of the result, where a ray crosses it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// In units of the ray's direction.
    pub distance: f64,
    /// Into the result; else out of it.
    pub into: bool,
    /// The face of A or B that is the border there.
    pub face: u32,
}

impl Combined {
    pub fn new(operation: Operation, faces: Vec<(u32, bool)>, boxes: &[Aabb]) -> Self {
        Self { operation, tree: Tree::new(boxes), faces }
    }

    /// Whether a face is A's or B's.
    pub fn holds(&self, face: u32) -> bool {
        self.faces.binary_search_by_key(&face, |(held, _)| *held).is_ok()
    }

    /// Where a ray from `origin` crosses the result's border, the nearest first.
    pub fn crossings(&self, world: &World, origin: DVec3, direction: DVec3, stack: &mut Stack) -> Vec<Crossing> {
        let slack = SLACK * (world.size + origin.length());
        let mut line = Line { combined: self, world, origin, direction, inverse: direction.recip(), slack, met: Vec::new() };
        self.tree.descend(&mut line, stack);
        let mut met = line.met;
        met.sort_by(|a, b| b.0.total_cmp(&a.0));
        // From infinity, which is outside both.
        let (mut in_a, mut in_b) = (false, false);
        let mut crossings = Vec::new();
        for (distance, of_b, face) in met {
            let beyond = self.operation.holds(in_a, in_b);
            *if of_b { &mut in_b } else { &mut in_a } ^= true;
            if self.operation.holds(in_a, in_b) != beyond {
                crossings.push(Crossing { distance, into: beyond, face });
            }
        }
        crossings.reverse();
        crossings
    }
}

/// One ray, and all it meets.
struct Line<'a> {
    combined: &'a Combined,
    world: &'a World,
    origin: DVec3,
    direction: DVec3,
    inverse: DVec3,
    slack: f64,
    /// Distance, whether it is B's, and the face.
    met: Vec<(f64, bool, u32)>,
}

impl Bundle for Line<'_> {
    fn enters(&self, min: DVec3, max: DVec3) -> Option<f64> {
        let (low, high) = (min - self.origin - self.slack, max - self.origin + self.slack);
        enters(low, high, self.inverse, 0.0, f64::INFINITY)
    }

    fn reach(&self) -> f64 {
        f64::INFINITY
    }

    fn meet(&mut self, index: u32) -> bool {
        let (face, of_b) = self.combined.faces[index as usize];
        let met = self.world.faces[face as usize].from(self.origin).meet(self.direction);
        self.met.extend(met.filter(|met| met.distance > 0.0).map(|met| (met.distance, of_b, face)));
        true
    }
}
