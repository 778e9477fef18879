//! What holds for depth complexity: fragments that are counted as surfaces lay depth.

use super::Progress;
use crate::frame::plan::FramePlan;
use crate::frame::state::Compare;
use crate::frame::stencil::StencilState;
use crate::frame::step::{Draw, DrawSet};

/// What counts fragments, or asks for their count; `None` where the draw has nothing to do with them.
pub(super) fn check(plan: &FramePlan, draw: &Draw, state: &mut Progress) -> Option<Result<(), &'static str>> {
    let stencil = &draw.state.stencil;
    if stencil.writes() {
        let counts = [false, true].map(|hidden| StencilState::count_fragments(plan.budget, hidden)).contains(stencil);
        return match (counts, state.fragments) {
            (true, _) => Some(count(plan, draw, state)),
            (false, true) => Some(Err("it writes over counted fragments")),
            (false, false) => None,
        };
    }
    let at_least = [stencil.front.compare, stencil.back.compare].contains(&Compare::LessEqual);
    let answered = state.fragments && *stencil == StencilState::count_at_least(plan.budget);
    (at_least && !answered).then_some(Err("it asks for fragments that were not counted"))
}

/// Surfaces count as they lay depth; nothing else is in the stencil, and clamping needs all of it.
fn count(plan: &FramePlan, draw: &Draw, state: &mut Progress) -> Result<(), &'static str> {
    if !matches!(draw.set, DrawSet::Surfaces(_)) || draw.state.depth.compare != Compare::Greater {
        return Err("only surfaces that lay depth, or are hidden by it, are counted by their fragments");
    }
    if plan.budget.count_mask != u8::MAX || state.counted.is_some() || !state.owned.is_empty() {
        return Err("it counts fragments in bits that belong to others");
    }
    state.fragments = true;
    Ok(())
}
