//! Never wrong by overflow: how often a light's volumes can lie over one pixel, and what is done where
//! that is more than the stencil's field can tell apart.
//!
//! A count is right modulo the field's size, so it is wrong in one case only: a multiple of that size
//! reads as zero, and shadow is taken for light. The plan bounds the count ([`crate::geometry::overlap`]):
//! for each caster, then for casters whose volumes can overlap at all. Where the bound fits the field,
//! as it nearly always does, nothing changes. Where it does not, exact techniques stay exact:
//!
//! - **in batches**, each of which fits a field one bit shorter; between two batches one full-screen step
//!   turns every count that is not zero into the verdict bit ([`StencilState::collapse`]);
//! - **wide** ([`super::wide`]), where one caster alone could overflow a batch, or where the count itself
//!   is to be shown.
//!
//! [`StencilState::collapse`]: crate::frame::stencil::StencilState::collapse

use super::counting::Ask;
use super::workspace::Lent;
use super::{Caster, Row};
use crate::geometry::kept::Pair;
use crate::geometry::overlap::{Cone, Heap, OverlapScratch};
use crate::geometry::{self, Posed};
use crate::settings::{Overflow, Technique};

/// What every note on a count that could overflow holds.
pub const TOO_MANY: &str = "volumes over one pixel";

/// How a light's volumes are counted, so that the count fits.
#[derive(Debug)]
pub(super) enum Way<'w> {
    /// All at once.
    Plain,
    /// One after the other: of each caster, in which batch; and how many there are.
    Batches(Lent<'w, usize>, usize),
    /// In a float target.
    Wide,
}

/// The way, and what a user should know of it.
#[derive(Debug)]
pub(super) struct Decision<'w> {
    pub way: Way<'w>,
    pub note: Option<String>,
}

/// Memory that is kept from light to light.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    overlap: OverlapScratch,
    bounds: Vec<u32>,
    cones: Vec<Cone>,
    heaps: Vec<Heap>,
}

/// More casters than this are not looked at pair by pair.
const MANY: usize = 4096;

/// Decides for those of a light's casters that are counted at all, by their numbers.
pub(super) fn decide<'w>(row: &Row, (casters, counted): (&[Caster<'_>], &[usize]), ask: &Ask<'w>) -> Decision<'w> {
    let largest = ask.budget.largest();
    if row.technique == Technique::Wide {
        return Decision { way: Way::Wide, note: None };
    }
    if row.technique == Technique::Parity {
        // It does not count.
        return Decision { way: Way::Plain, note: None };
    }
    let casters = || counted.iter().map(|&number| &casters[number]);
    let Scratch { overlap, bounds, cones, heaps } = &mut *ask.workspace.overflow.borrow_mut();
    bounds.clear();
    bounds.extend(casters().map(trivial_bound));
    let sum = |bounds: &[u32]| bounds.iter().map(|bound| u64::from(*bound)).sum::<u64>();
    let plain = Decision { way: Way::Plain, note: None };
    if sum(bounds) <= largest.into() {
        return plain;
    }
    overlap.begin();
    for (bound, caster) in bounds.iter_mut().zip(casters()) {
        if *bound > 1 {
            *bound = winding_bound(overlap, caster, ask.light, largest);
        }
    }
    if sum(bounds) <= largest.into() {
        return plain;
    }
    cones.clear();
    cones.extend(casters().map(|caster| cone(caster, counted.len() > MANY)));
    let mut most = together(heaps, cones, bounds);
    if most > largest.into() {
        // Worth more time.
        for (bound, caster) in bounds.iter_mut().zip(casters()) {
            if *bound > 1 {
                *bound = winding_bound(overlap, caster, ask.light, 1);
            }
        }
        most = together(heaps, cones, bounds);
    }
    if most <= largest.into() {
        return plain;
    }

    let number = casters().next().map_or(ask.light, |caster| caster.light.of);
    let bits = ask.budget.count_mask.count_ones();
    let too_many = format!("light {number}: up to {most} {TOO_MANY}, the count of {bits} bits tells {largest}");
    if ask.overflow == Overflow::Naive || !row.counts_exactly() {
        let note = format!("{too_many}: a multiple of {} is taken for none (`show overflow` marks where)", largest + 1);
        return Decision { way: Way::Plain, note: Some(note) };
    }
    // What is turned over leaves nothing to collapse.
    let batch = if ask.budget.count_mask == 0 { 0 } else { ask.budget.batched().largest() };
    let alone = bounds.iter().max().copied().unwrap_or(0);
    let by_wide = ask.samples == 1 || ask.capabilities.wide_four_samples;
    if alone <= batch && !(ask.values && by_wide) {
        let mut batch_of = ask.workspace.numbers.lend();
        let batches = in_batches(heaps, (cones, bounds), batch.into(), &mut batch_of);
        let note = format!("{too_many}: counted in {batches} batches of at most {batch}, each collapsed into one bit");
        return Decision { way: Way::Batches(batch_of, batches), note: Some(note) };
    }
    if by_wide {
        let why = if ask.values { "its count is shown".to_owned() } else { format!("one caster alone has up to {alone}") };
        let format = ask.capabilities.wide_counts.name();
        return Decision { way: Way::Wide, note: Some(format!("{too_many}, and {why}: counted wide, in {format}")) };
    }
    let note = format!("{too_many}, and this device counts wide with 1 sample a pixel only: shadows may be taken for light");
    Decision { way: Way::Plain, note: Some(note) }
}

/// The most that all of them can add up to over one point; in the first of `heaps`.
fn together(heaps: &mut Vec<Heap>, cones: &[Cone], bounds: &[u32]) -> u64 {
    let all = empty(heaps, 0);
    for (cone, bound) in cones.iter().zip(bounds) {
        all.try_add(*cone, *bound, u64::MAX);
    }
    all.most()
}

/// Casters into as few batches as come by first fit: of each the batch into `batch_of`; gives how many there are.
fn in_batches(heaps: &mut Vec<Heap>, (cones, bounds): (&[Cone], &[u32]), largest: u64, batch_of: &mut Vec<usize>) -> usize {
    let mut batches = 0;
    for (cone, bound) in cones.iter().zip(bounds) {
        let found = heaps[..batches].iter_mut().position(|batch| batch.try_add(*cone, *bound, largest));
        batch_of.push(found.unwrap_or_else(|| {
            empty(heaps, batches).try_add(*cone, *bound, largest);
            batches += 1;
            batches - 1
        }));
    }
    batches
}

/// One of the heaps, or another one, with nothing in it.
fn empty(heaps: &mut Vec<Heap>, number: usize) -> &mut Heap {
    if heaps.len() <= number {
        heaps.resize_with(number + 1, Heap::default);
    }
    heaps[number].clear();
    &mut heaps[number]
}

/// Known without looking at the light: one for a convex solid, else as many as there are triangles.
fn trivial_bound(caster: &Caster<'_>) -> u32 {
    let topology = &caster.mesh.topology;
    if topology.convex() && caster.pose.deformed[caster.node_index].is_none() {
        return 1;
    }
    u32::try_from(topology.triangles().len()).unwrap_or(u32::MAX)
}

/// What its volume may lie in, as the light sees it.
fn cone(caster: &Caster<'_>, everywhere: bool) -> Cone {
    let light = glam::DVec4::from(caster.light);
    if everywhere {
        return Cone::EVERYWHERE;
    }
    let bounds = caster.pose.bounds(caster.scene, caster.node_index).transformed(&caster.world_from_object);
    Cone::about(&bounds, light)
}

/// How often at most one caster's volume winds around a point: `enough` is as good as any less.
fn winding_bound(scratch: &mut OverlapScratch, caster: &Caster<'_>, light: usize, enough: u32) -> u32 {
    let Posed { welded, planes } = caster.pose.posed(caster.mesh, caster.node_index);
    let bounds = caster.pose.bounds(caster.scene, caster.node_index);
    let posed = geometry::Caster { topology: &caster.mesh.topology, welded, planes, bounds: &bounds };
    let pair = Pair { instance: caster.instance, light, reflected: caster.reflected.is_some() };
    let light = caster.light_in_object().as_vec4();
    scratch.winding_bound(posed, light, &caster.scene.silhouettes.of(pair, posed, light), enough)
}
