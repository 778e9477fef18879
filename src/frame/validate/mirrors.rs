//! What holds for steps of views by way of mirrors, and for the steps between views.

use super::{Progress, check_draw};
use crate::frame::plan::FramePlan;
use crate::frame::state::{Compare, Winding};
use crate::frame::stencil::{StencilFace, StencilOp, StencilState};
use crate::frame::step::{Draw, DrawSet, Program, Target};

/// A draw of a view: in its own pixels; then all that holds for every draw.
pub(super) fn check(plan: &FramePlan, view: usize, draw: &Draw, state: &mut Progress) -> Result<(), &'static str> {
    let mask = plan.budget.mirror_mask;
    let stencil = &draw.state.stencil;
    if draw.program == Program::Mirrored && !plan.kept_behind(view, draw).is_some_and(|child| state.kept.contains(&child)) {
        return Err("it lays a texture on a mirror that keeps no view of it");
    }
    if mask == 0 || !matches!(draw.target, Target::Scene | Target::Direct | Target::Counts) {
        return check_draw(plan, draw, state);
    }
    if stencil.writes() && stencil.write_mask & mask != 0 {
        return check_passage(plan, view, draw, state);
    }
    if view != state.open.last().copied().unwrap_or(0) {
        return Err("it draws a view whose mirror is not tagged");
    }
    if view == 0 {
        return check_draw(plan, draw, state);
    }
    let parity = if plan.views[view].camera.mirrored { Winding::Cw } else { Winding::Ccw };
    if plan.views[view].winding != parity {
        return Err("its view's winding is not that of so many mirrors");
    }
    // Where it asks for no more than its view it is as if it asked for nothing.
    let asks = stencil.tests() && stencil.read_mask & mask == mask && draw.stencil_reference & mask == plan.views[view].level();
    let face = |face: StencilFace| match face.compare {
        Compare::Equal if stencil.read_mask & !mask == 0 => StencilFace { compare: Compare::Always, ..face },
        _ => face,
    };
    let bare =
        StencilState { front: face(stencil.front), back: face(stencil.back), read_mask: stencil.read_mask & !mask, ..*stencil };
    let equal = |face: &StencilFace| face.compare == Compare::Equal;
    let kept = asks && equal(&stencil.front) && equal(&stencil.back);
    // What collapses a count leaves its pixels, but harms no other view: each counts anew.
    let collapses = stencil.writes() && stencil.front.compare == Compare::NotEqual && draw.state.color.is_none();
    if !kept && !collapses {
        return Err("it draws beyond its mirror's pixels");
    }
    let draw = Draw {
        state: crate::frame::state::State { stencil: bare, ..draw.state },
        stencil_reference: draw.stencil_reference & !mask,
        ..draw.clone()
    };
    if is_reset(&draw, mask) {
        state.field_known = true;
        (state.counted, state.counting, state.shone) = (None, false, 0);
        state.tagged = false;
        state.owned.clear();
        state.receivers.clear();
        return Ok(());
    }
    check_draw(plan, &draw, state)
}

/// All bits but the mirrors' set, in the pixels of one view.
fn is_reset(draw: &Draw, mask: u8) -> bool {
    let replaces =
        StencilFace { compare: Compare::Always, fail: StencilOp::Keep, depth_fail: StencilOp::Keep, pass: StencilOp::Replace };
    let stencil = &draw.state.stencil;
    draw.program == Program::StencilOnly && stencil.write_mask == !mask && [stencil.front, stencil.back] == [replaces; 2]
}

/// From a view's pixels of a mirror to those of the view through it, or back.
fn check_passage(plan: &FramePlan, view: usize, draw: &Draw, state: &mut Progress) -> Result<(), &'static str> {
    let budget = plan.budget;
    let DrawSet::Surfaces(surfaces) = &draw.set else { return Err("only a mirror's own surface tags its pixels") };
    let through = |child: &usize| {
        let window = plan.views[*child].through.as_ref();
        window.is_some_and(|window| window.parent == view && **surfaces == [window.surface])
    };
    let (inner, outer) = (state.open.last().copied(), plan.views[view].level());
    let reference = draw.stencil_reference;
    let stencil = &draw.state.stencil;
    // Back: from the view that was opened last.
    if let Some(child) = inner.filter(through)
        && reference == plan.views[child].level()
        && *stencil == StencilState::through_mirror(budget, reference, outer)
    {
        if !draw.state.depth.write || draw.state.depth.compare != Compare::Always {
            return Err("a mirror's depth must be there again when its pixels are untagged");
        }
        state.open.pop();
        return Ok(());
    }
    if inner.unwrap_or(0) != view {
        return Err("it tags a mirror of a view that is not drawn");
    }
    let Some(child) = (0..plan.views.len()).find(through) else { return Err("it tags what is no mirror of its view") };
    if reference != outer || *stencil != StencilState::through_mirror(budget, outer, plan.views[child].level()) {
        return Err("it tags a mirror's pixels by other bits than its view's");
    }
    if draw.state.depth.compare != Compare::Equal || draw.state.depth.write {
        return Err("a mirror is tagged where it is seen: at its own depth");
    }
    state.open.push(child);
    Ok(())
}
