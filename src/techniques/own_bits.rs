//! The points of a light with a size, each with a stencil bit of its own (K section 6.4, figure 15).
//!
//! K draws a soft shadow as the sum of eight points' hard ones. Each point's shadow volumes go into the
//! stencil first, each into its own bit; then the points shine one after the other, each where its bit is
//! clear. Nothing is cleared between them.
//!
//! ```text
//!   bit   7 6 5 4 3 2 1 0
//!         h g f e d c b a        eight points, each bit turned over by every face behind the surface
//!         d c b a [count  ]      four points at a time; each counted, then collapsed into its bit
//! ```
//!
//! A bit of one's own leaves none to count in, and K does not say how many volumes may overlap in one. Turned over,
//! it tells 1 from 0 and takes 2 for none. So the plan asks the bound on overlaps (`overflow.rs`) for every
//! point, and takes the first that is exact:
//!
//! - **eight bits**, turned over by faces, where no two volumes of one point can lie over one pixel;
//! - **four and four**: half of the points at a time, each counted in the four low bits, which hold 15, and
//!   collapsed into its own bit, as often as batches of casters need;
//! - a point whose one caster alone could pass that is counted **wide**, and its verdict written into its bit.
//!
//! A point that shines marks its pixels in its own bit, as K has it, lest a second surface in the same place
//! takes the light twice ([`StencilState::light_once`]).
//!
//! [`StencilState::light_once`]: crate::frame::stencil::StencilState::light_once

use super::Row;
use super::counting::{Ask, LightCount, count_light, full_screen};
use super::overflow::{self, Way};
use super::workspace::Casters;
use crate::frame::stencil::{BitBudget, StencilState};
use crate::frame::{Program, Step, VolumePlan};
use crate::geometry::pixels::around;
use crate::settings::{Overflow, Technique};

/// One point of a light with a size, and what casts shadows before it.
pub struct Point<'a> {
    /// An index into the pose's lights.
    pub light: usize,
    /// The pixels it can reach.
    pub rect: [u32; 4],
    /// All that might cast a shadow.
    pub casters: Casters<'a>,
}

/// Lights whose shadows are in the stencil together: one, or points of one with a bit each.
#[derive(Debug, Default)]
pub struct Round {
    /// What the stencil must hold everywhere before the first volume.
    pub base: u8,
    /// The counting steps, in order.
    pub steps: Vec<Step>,
    /// What shines then.
    pub lights: Vec<Shining>,
}

/// A light that is added where its bits are zero.
#[derive(Debug, Clone, Copy)]
pub struct Shining {
    /// An index into the pose's lights.
    pub light: usize,
    /// The pixels it can reach.
    pub rect: [u32; 4],
    /// The bits that hold its verdict; none where nothing shadows it.
    pub budget: Option<BitBudget>,
}

impl Round {
    /// Of one light, that has the stencil for itself.
    #[must_use]
    pub fn of_one(light: usize, rect: [u32; 4], count: LightCount) -> Self {
        let shadowed = count.base != 0 || !count.steps.is_empty();
        let budget = shadowed.then_some(count.budget);
        Self { base: count.base, steps: count.steps, lights: vec![Shining { light, rect, budget }] }
    }

    /// The pixels in which the count may differ from zero; `None` where that is everywhere.
    #[must_use]
    pub fn counted_within(&self) -> Option<[u32; 4]> {
        // Where no volume is drawn the count stays what it was.
        self.steps.iter().filter_map(Step::scissor).reduce(around).filter(|_| self.base == 0)
    }
}

/// Points whose count has bits of its own, at most.
const MOST_COUNT_BITS: u32 = 4;

/// Counts all points of one light, each into a bit of its own, in as many rounds as the bits ask for; and says how.
/// Plans are appended to `volumes`. `ask` is one for all of them but for the light.
pub fn count_points(row: &Row, points: &[Point<'_>], ask: &Ask<'_>, volumes: &mut Vec<VolumePlan>) -> (Vec<Round>, String) {
    let (layout, mut words) = choose(row, points, ask);
    let rounds: Vec<_> = points.chunks(layout.points() as usize).map(|some| round(row, some, layout, ask, volumes)).collect();
    if rounds.len() > 1 {
        words = format!("{words}, in {} rounds", rounds.len());
    }
    (rounds, words)
}

/// How the bits are dealt out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Layout {
    /// Low ones, that all points count in.
    count_bits: u32,
    /// All there are.
    bits: u32,
}

impl Layout {
    /// How many have a bit.
    const fn points(self) -> u32 {
        self.bits - self.count_bits
    }

    /// The bits of one of them.
    const fn budget(self, point: u32) -> BitBudget {
        BitBudget::of_point(self.count_bits, 1 << (self.count_bits + point))
    }
}

fn choose(row: &Row, points: &[Point<'_>], ask: &Ask<'_>) -> (Layout, String) {
    let bits = if ask.budget.beyond_mask == 0 { 8 } else { 7 };
    let own = Layout { count_bits: 0, bits };
    let split = Layout { count_bits: ask.budget.count_mask.count_ones().min(MOST_COUNT_BITS), bits };
    let light = points.first().and_then(|point| point.casters.first()).map_or(ask.light, |caster| caster.light.of);
    let number = points.len();
    let told = |how: &str| format!("light {light}: {number} points, each with a bit of its own: {how}");
    let ways = |layout: Layout| -> Vec<_> {
        let way = |point: &Point<'_>| {
            let casters = &point.casters;
            let is_counted = |number: &usize| casters[*number].sight.dropped.is_none();
            let counted = ask.workspace.numbers.collect((0..casters.len()).filter(is_counted));
            overflow::decide(row, (casters, &counted), &Ask { budget: layout.budget(0), light: point.light, ..*ask })
        };
        points.iter().map(way).collect()
    };
    let protected = ask.overflow == Overflow::Exact && row.counts_exactly();
    let by_own = ways(own);
    if row.technique == Technique::Wide {
        return (own, told("counted wide, and the verdict written into it"));
    }
    if by_own.iter().all(|decision| matches!(decision.way, Way::Plain) && decision.note.is_none()) {
        return (own, told("turned over by every face, for no two volumes lie over one pixel"));
    }
    let by_split = ways(split);
    if protected && by_split.iter().all(|decision| matches!(decision.way, Way::Wide)) {
        return (own, told("counted wide, and the verdict written into it, for one caster alone could pass the count"));
    }
    let low = split.count_bits;
    let wide = by_split.iter().filter(|decision| matches!(decision.way, Way::Wide)).count();
    let batched = by_split.iter().filter(|decision| matches!(decision.way, Way::Batches(..))).count();
    let mut how = format!("{} at a time, counted in {low} bits and collapsed into it", split.points());
    if batched > 0 {
        how.push_str(&format!(" (of {batched} points in batches of at most {})", split.budget(0).largest()));
    }
    if wide > 0 {
        how.push_str(&format!(" ({wide} points counted wide)"));
    }
    if let Some(note) = by_split.iter().filter(|_| !protected).find_map(|decision| decision.note.as_ref()) {
        how.push_str(&format!("; {note}"));
    }
    (split, told(&how))
}

fn round(row: &Row, points: &[Point<'_>], layout: Layout, ask: &Ask<'_>, volumes: &mut Vec<VolumePlan>) -> Round {
    let mut round = Round::default();
    for (number, point) in (0..).zip(points) {
        let budget = layout.budget(number);
        let ask = Ask { light: point.light, budget, ..*ask };
        let count = count_light(row, &point.casters, &ask, volumes);
        if layout.count_bits == 0 || number == 0 {
            round.base |= count.base;
        } else if count.base != 0 {
            round.steps.push(start(count.base, &ask));
        }
        round.steps.extend(count.steps);
        round.lights.push(Shining { light: point.light, rect: point.rect, budget: Some(budget) });
    }
    round
}

/// The shared count of a point that is not the first.
fn start(base: u8, ask: &Ask<'_>) -> Step {
    full_screen(
        format!("light {}: start at {base}", ask.light),
        "So many of this point's volumes hold the eye, where counting starts.",
        Program::StencilOnly,
        StencilState::set_count(ask.budget),
        base,
        ask,
    )
}
