//! Silhouettes, kept for as long as neither caster nor light moves.
//!
//! A frame asks for a caster's silhouette more than once: the plan bounds how many volumes can lie over a pixel
//! ([`super::overlap`]), and the volume itself is made of it. And most frames are like the one before. So who was seen
//! by which light last time is remembered here, with what was seen. It is a memory, not a state: without it every
//! answer is the same.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use glam::Vec4;

use super::silhouette::{Facing, silhouette_in_blocks};
use super::volume::Caster;

/// What a light sees of a caster.
#[derive(Debug, Default)]
pub struct Silhouette {
    facing: Facing,
    edges: Vec<[u32; 2]>,
    blocks: Vec<Vec<[u32; 2]>>,
    bounds: Mutex<Vec<Bound>>,
}

/// How often the volume winds around a point at most, and how much patience it took to find
/// ([`super::overlap::OverlapScratch`]).
#[derive(Debug, Clone, Copy)]
struct Bound {
    enough: u32,
    bound: u32,
    patience: usize,
}

impl Silhouette {
    /// What `light` (object space, as [`super::volume::VolumeScratch::append`] takes it) sees of `caster`. Reuses the memory.
    pub fn find(&mut self, caster: Caster<'_>, light: Vec4) {
        self.facing.decide(caster.topology, caster.planes, caster.welded, light);
        silhouette_in_blocks(caster.topology, &self.facing, &mut self.blocks, &mut self.edges);
        self.bounds.get_mut().unwrap_or_else(PoisonError::into_inner).clear();
    }

    /// Who faces the light.
    #[must_use]
    pub fn facing(&self) -> &Facing {
        &self.facing
    }

    /// As [`super::silhouette::silhouette`] finds it.
    #[must_use]
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// The bound that is `enough`, found by `find` where it was not before; `patience` becomes what either leaves.
    pub(super) fn bound(&self, enough: u32, patience: &mut usize, find: impl FnOnce(&mut usize) -> u32) -> u32 {
        let mut bounds = self.bounds.lock().unwrap_or_else(PoisonError::into_inner);
        let known = bounds.iter().find(|known| known.enough == enough);
        if let Some((left, bound)) = known.and_then(|known| Some((patience.checked_sub(known.patience)?, known.bound))) {
            *patience = left;
            return bound;
        }
        let before = *patience;
        let bound = find(patience);
        // What ran out of patience is found again when there is more.
        if *patience > 0 {
            bounds.push(Bound { enough, bound, patience: before - *patience });
        }
        bound
    }
}

/// One caster before one light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Pair {
    /// As the scene counts its instances.
    pub instance: usize,
    /// As the pose counts its lights.
    pub light: usize,
    /// The caster is a reflection.
    pub reflected: bool,
}

/// The silhouettes of a scene.
#[derive(Debug, Default)]
pub struct Silhouettes {
    slots: Mutex<Slots>,
}

#[derive(Debug, Default)]
struct Slots {
    slots: HashMap<Pair, Slot>,
    triangles: usize,
}

#[derive(Debug)]
struct Slot {
    /// Which planes, and the light's bits: what the silhouette depends on.
    of: (u64, [u32; 4]),
    silhouette: Arc<Silhouette>,
}

impl Clone for Silhouettes {
    /// Another scene remembers nothing yet.
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Silhouettes {
    /// Of the casters kept: some ten bytes each.
    const MOST_TRIANGLES: usize = 8 << 20;

    /// What `light` (object space) sees of `caster`, found anew where either has moved.
    pub fn of(&self, pair: Pair, caster: Caster<'_>, light: Vec4) -> Arc<Silhouette> {
        let of = (caster.planes.build_number(), light.to_array().map(f32::to_bits));
        let triangles = caster.topology.triangles().len();
        let before = {
            let mut slots = self.slots.lock().unwrap_or_else(PoisonError::into_inner);
            match slots.slots.get(&pair) {
                Some(slot) if slot.of == of => return slot.silhouette.clone(),
                _ => slots.take(&pair),
            }
        };
        let mut silhouette = before.unwrap_or_default();
        match Arc::get_mut(&mut silhouette) {
            Some(own) => own.find(caster, light),
            None => {
                let mut own = Silhouette::default();
                own.find(caster, light);
                silhouette = Arc::new(own);
            }
        }
        let mut slots = self.slots.lock().unwrap_or_else(PoisonError::into_inner);
        if slots.triangles + triangles > Self::MOST_TRIANGLES {
            *slots = Slots::default();
        }
        slots.take(&pair);
        slots.triangles += triangles;
        slots.slots.insert(pair, Slot { of, silhouette: silhouette.clone() });
        silhouette
    }
}

impl Slots {
    fn take(&mut self, pair: &Pair) -> Option<Arc<Silhouette>> {
        let silhouette = self.slots.remove(pair)?.silhouette;
        self.triangles -= silhouette.facing.contributions().len();
        Some(silhouette)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use std::cmp::Ordering;

    use glam::Vec3;

    use super::*;
    use crate::geometry::silhouette::EdgeOn;
    use crate::geometry::{Aabb, Posed, Topology, Weld};

    struct Solid {
        topology: Topology,
        posed: Posed,
        bounds: Aabb,
    }

    impl Solid {
        fn new(positions: &[Vec3], indices: &[u32]) -> Self {
            let weld = Weld::new(positions, |_, _| Ordering::Equal);
            let topology = Topology::build(indices, positions, weld, |_| true);
            let posed = Posed::new(&topology, positions);
            Self { bounds: Aabb::from_points(posed.welded.iter().copied()), topology, posed }
        }

        fn caster(&self) -> Caster<'_> {
            let Posed { welded, planes } = &self.posed;
            Caster { topology: &self.topology, welded, planes, bounds: &self.bounds }
        }

        /// Triangle by triangle, edge by edge, and what is edge-on by asking all neighbours until none changes its mind.
        fn plainly(&self, light: Vec4) -> (Vec<i8>, Vec<[u32; 2]>) {
            let Self { topology, posed, bounds } = self;
            let seen = EdgeOn::new(bounds, light);
            let alone: Vec<Option<i8>> =
                (0..topology.triangles().len()).map(|at| seen.alone(&posed.planes, at, topology.two_sided()[at])).collect();
            let mut counts: Vec<i8> = alone.iter().map(|counts| counts.unwrap_or(0)).collect();
            let pairs = topology.pairs();
            loop {
                let before = counts.clone();
                let mut least: Vec<Option<i8>> = vec![None; counts.len()];
                for edge in 0..pairs.a.len() {
                    let (forward, backward) = (pairs.forward[edge] as usize, pairs.backward[edge] as usize);
                    let [a, b] = [pairs.a[edge], pairs.b[edge]].map(|vertex| posed.welded[vertex as usize].as_dvec3());
                    for (own, other, along) in [(forward, backward, b - a), (backward, forward, a - b)] {
                        let from = if own == forward { a } else { b };
                        let outward = along.cross(posed.planes.normal(own).as_dvec3());
                        let light = light.as_dvec4();
                        if alone[own].is_none() && outward.dot(light.truncate() - from * light.w) > 0.0 {
                            least[own] = Some(least[own].unwrap_or(1).min(before[other]));
                        }
                    }
                }
                counts.iter_mut().zip(&least).for_each(|(own, least)| *own = least.unwrap_or(*own));
                if counts == before {
                    break;
                }
            }
            let mut edges = Vec::new();
            for edge in 0..pairs.a.len() {
                let (a, b) = (pairs.a[edge], pairs.b[edge]);
                let sum = counts[pairs.forward[edge] as usize] - counts[pairs.backward[edge] as usize];
                edges.extend(std::iter::repeat_n(if sum > 0 { [a, b] } else { [b, a] }, sum.unsigned_abs().into()));
            }
            (counts, edges)
        }
    }

    /// A slab with a flat top of `side` by `side` squares, whose triangles are numbered in a shuffled order.
    fn slab(side: u32) -> Solid {
        let across = side + 1;
        let at = |x: u32, z: u32, top: u32| (top * across + z) * across + x;
        let mut positions = Vec::new();
        for top in [0.0, 1.0] {
            positions.extend((0..across * across).map(|at| Vec3::new((at % across) as f32, top, (at / across) as f32)));
        }
        let mut triangles = Vec::new();
        for (x, z) in (0..side).flat_map(|z| (0..side).map(move |x| (x, z))) {
            for top in [0, 1] {
                let [a, b, c, d] = [at(x, z, top), at(x, z + 1, top), at(x + 1, z + 1, top), at(x + 1, z, top)];
                triangles.extend(if top == 1 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
            }
        }
        for along in 0..side {
            let walls = [
                [at(along, 0, 0), at(along, 0, 1), at(along + 1, 0, 1), at(along + 1, 0, 0)],
                [at(along + 1, side, 0), at(along + 1, side, 1), at(along, side, 1), at(along, side, 0)],
                [at(0, along + 1, 0), at(0, along + 1, 1), at(0, along, 1), at(0, along, 0)],
                [at(side, along, 0), at(side, along, 1), at(side, along + 1, 1), at(side, along + 1, 0)],
            ];
            triangles.extend(walls.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]));
        }
        fastrand::Rng::with_seed(5).shuffle(&mut triangles);
        Solid::new(&positions, &triangles.concat())
    }

    #[test]
    fn many_cores_find_what_one_finds_triangle_by_triangle() {
        let slab = slab(120);
        assert!(slab.topology.report().is_solid() && slab.topology.triangles().len() > 50_000, "{:?}", slab.topology.report());
        let mut silhouette = Silhouette::default();
        // Above, beside, and in the plane of the top: 28,800 triangles seen edge-on, which pass on what they decide.
        for light in [[60.0, 90.0, 30.0, 1.0], [-7.0, 0.4, 11.0, 1.0], [-30.0, 1.0, 40.0, 1.0], [0.8, 0.0, -0.6, 0.0]] {
            let light = Vec4::from_array(light);
            silhouette.find(slab.caster(), light);
            let (counts, edges) = slab.plainly(light);
            assert!(silhouette.facing().contributions() == counts, "facing of {light}");
            assert!(silhouette.edges() == edges, "silhouette of {light}");
            assert!(counts.contains(&1) && !edges.is_empty());
        }
    }

    #[test]
    fn what_has_not_moved_is_not_found_again() {
        let slab = slab(3);
        let kept = Silhouettes::default();
        let pair = Pair { instance: 4, light: 1, reflected: false };
        let light = Vec4::new(9.0, 9.0, 9.0, 1.0);
        let first = kept.of(pair, slab.caster(), light);
        let again = kept.of(pair, slab.caster(), light);
        assert!(Arc::ptr_eq(&first, &again));
        let other_light = kept.of(Pair { light: 2, ..pair }, slab.caster(), light);
        assert!(!Arc::ptr_eq(&first, &other_light));
        let edges = first.edges().to_vec();
        let moved = kept.of(pair, slab.caster(), Vec4::new(-9.0, -9.0, 2.0, 1.0));
        assert!(!Arc::ptr_eq(&first, &moved) && edges == first.edges(), "what somebody still reads is left alone");
        assert_ne!(moved.edges(), edges);
        let posed_again = Solid { posed: Posed::new(&slab.topology, &slab.posed.welded), ..slab };
        let same = kept.of(pair, posed_again.caster(), light);
        assert!(!Arc::ptr_eq(&first, &same) && same.edges() == edges, "another pose, though it looks the same");
    }

    #[test]
    fn a_bound_is_found_once_and_costs_the_same_patience_again() {
        let silhouette = Silhouette::default();
        let mut patience = 100;
        assert_eq!(
            silhouette.bound(7, &mut patience, |patience| {
                *patience -= 30;
                5
            }),
            5
        );
        assert_eq!(silhouette.bound(7, &mut patience, |_| unreachable!("known")), 5);
        assert_eq!(patience, 40);
        let mut little = 20;
        assert_eq!(
            silhouette.bound(7, &mut little, |patience| {
                *patience = 0;
                9
            }),
            9,
            "too little for what is known"
        );
        assert_eq!(silhouette.bound(7, &mut 30, |_| unreachable!("known")), 5);
    }
}
