//! What holds for halos: what is tagged first is never covered, and no pixel glows twice.

use super::Progress;
use crate::frame::plan::FramePlan;
use crate::frame::state::Depth;
use crate::frame::stencil::StencilState;
use crate::frame::step::{Draw, DrawSet, Program};

/// Checks a tag or a shell; `None` where the draw is neither.
pub(super) fn check(plan: &FramePlan, draw: &Draw, state: &mut Progress) -> Option<Result<(), &'static str>> {
    let tag = StencilState::tag_halo(plan.budget);
    let tags = plan.budget.halo_mask != 0 && draw.state.stencil == tag && matches!(draw.set, DrawSet::Surfaces(_));
    if tags {
        return Some(check_tag(plan, draw, state));
    }
    if draw.program != Program::Halo && !matches!(draw.set, DrawSet::Swollen(_)) {
        return None;
    }
    Some(check_shell(plan, draw, state))
}

fn check_tag(plan: &FramePlan, draw: &Draw, state: &mut Progress) -> Result<(), &'static str> {
    if state.counting || state.counted.is_some() || (state.shone != 0 && !state.tagged) {
        return Err("it tags for halos while the stencil holds a count");
    }
    // What is tagged where it is seen alone is a part of what was tagged before.
    let everywhere = draw.state.depth == Depth::IGNORE || (state.tagged && draw.state.depth == Depth::SAME_SURFACE);
    if draw.stencil_reference != plan.budget.halo_tag() || draw.state.color.is_some() || !everywhere {
        return Err("what has a halo is tagged wherever it is, and drawn no more");
    }
    // Nothing may be counted on top of it.
    state.shone |= plan.budget.halo_mask;
    state.tagged = true;
    Ok(())
}

fn check_shell(plan: &FramePlan, draw: &Draw, state: &Progress) -> Result<(), &'static str> {
    if draw.program != Program::Halo || !matches!(draw.set, DrawSet::Swollen(_)) {
        return Err("only halos swell, and all of them do");
    }
    if !state.tagged {
        return Err("a halo is drawn before its object is tagged");
    }
    if plan.budget.halo_mask == 0
        || draw.state.stencil != StencilState::glow_once(plan.budget)
        || draw.stencil_reference != 0
        || draw.state.depth.write
    {
        return Err("a halo is drawn where neither an object is tagged nor a halo drawn, and counts itself there");
    }
    Ok(())
}
