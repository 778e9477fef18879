//! The tree of boxes over a world's triangles.
//!
//! A library builds it; its boxes are of single precision, rounded outwards, and decide only what need
//! not be looked at. The descent is our own: it is in double precision and takes a whole bundle of rays.

use glam::DVec3;
use obvhs::aabb::Aabb as LibraryBox;
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use crate::geometry::Aabb;

/// Boxes in boxes, down to a few triangles each.
#[derive(Debug, Default)]
pub struct Tree {
    nodes: Vec<Node>,
    /// The numbers of what was given, leaf by leaf.
    order: Vec<u32>,
}

#[derive(Debug)]
struct Node {
    min: DVec3,
    max: DVec3,
    /// The first of two children among the nodes, or the first entry of `order`.
    first: u32,
    /// How many entries of `order`; 0 for a node with children.
    count: u32,
}

/// What a bundle of rays wants to know.
pub trait Bundle {
    /// Where the bundle enters a box at the earliest, along its rays; `None` if none of them can
    /// meet the box.
    fn enters(&self, min: DVec3, max: DVec3) -> Option<f64>;

    /// What is entered farther on than this tells nothing any more.
    fn reach(&self) -> f64;

    /// Looks at one thing. False ends the descent.
    fn meet(&mut self, index: u32) -> bool;
}

/// Working memory of [`Tree::descend`]: where boxes that are still to be opened are entered.
pub type Stack = Vec<(f64, u32)>;

/// At most.
const TRIANGLES_IN_A_LEAF: u32 = 4;

/// What opening a box costs, of what asking a triangle costs.
const OPENING_A_BOX: f32 = 1.0;

impl Tree {
    /// Over things with these boxes; their numbers are their places here.
    pub fn new(boxes: &[Aabb]) -> Self {
        if boxes.is_empty() {
            return Self::default();
        }
        let boxes: Vec<_> =
            boxes.iter().map(|held| LibraryBox { min: held.min.to_array().into(), max: held.max.to_array().into() }).collect();
        let numbers = (0u32..).take(boxes.len()).collect();
        // Its steps one by one: the library's `build_bvh2` ends in a check, in debug builds, of how deep
        // the tree is, which trees over many equal places do not pass. Our stack has no depth to keep.
        let mut built =
            PlocBuilder::with_capacity(boxes.len()).build(PlocSearchDistance::Medium, &boxes, numbers, SortPrecision::U64, 0);
        collapse(&mut built, TRIANGLES_IN_A_LEAF, OPENING_A_BOX);
        let corner = |at: [f32; 3]| DVec3::from_array(at.map(f64::from));
        let nodes = built
            .nodes
            .iter()
            .map(|node| Node {
                min: corner(node.aabb().min.into()),
                max: corner(node.aabb().max.into()),
                first: node.first_index,
                count: node.prim_count,
            })
            .collect();
        Self { nodes, order: built.primitive_indices }
    }

    fn entered(&self, bundle: &impl Bundle, index: u32) -> Option<(f64, u32)> {
        let node = &self.nodes[index as usize];
        bundle.enters(node.min, node.max).map(|at| (at, index))
    }

    /// Shows the bundle everything that it may meet, near boxes first.
    pub fn descend(&self, bundle: &mut impl Bundle, stack: &mut Stack) {
        stack.clear();
        stack.extend((!self.nodes.is_empty()).then(|| self.entered(bundle, 0)).flatten());
        while let Some((at, index)) = stack.pop() {
            if at > bundle.reach() {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count > 0 {
                let things = node.first as usize..(node.first + node.count) as usize;
                if !self.order[things].iter().all(|&thing| bundle.meet(thing)) {
                    return;
                }
                continue;
            }
            match (self.entered(bundle, node.first), self.entered(bundle, node.first + 1)) {
                (Some(first), Some(second)) if first.0 <= second.0 => stack.extend([second, first]),
                (first, second) => stack.extend(first.into_iter().chain(second)),
            }
        }
    }
}
