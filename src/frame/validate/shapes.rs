//! What holds for the playground's shapes: every state is free, as long as nothing else is in the stencil.

use super::Progress;
use crate::frame::plan::FramePlan;
use crate::frame::stencil::BitBudget;
use crate::frame::step::{Draw, DrawSet, Program, Target};

/// A shape, or what would disturb shapes; `None` where the draw has nothing to do with them.
pub(super) fn check(plan: &FramePlan, draw: &Draw, state: &mut Progress) -> Option<Result<(), &'static str>> {
    if !matches!(draw.set, DrawSet::Triangles(_)) {
        let stencil = &draw.state.stencil;
        let touches = stencil.tests() || stencil.writes();
        return (state.played && touches).then_some(Err("it touches a stencil that shapes play with"));
    }
    state.played = true;
    Some(if draw.program != Program::Bounds || draw.target != Target::Scene || draw.state.color.is_some() {
        Err("shapes are drawn into the stencil and nothing else")
    } else if !state.stencil_set {
        Err("it tests or writes stencil bits that nobody set")
    } else if plan.budget != BitBudget::default() || !plan.volumes.is_empty() {
        Err("shapes have all of the stencil, and no other owner beside them")
    } else {
        Ok(())
    })
}
