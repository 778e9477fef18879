//! What holds for decals: their ground is marked, they claim its pixels, and the mark is gone before anything else.

use super::Progress;
use crate::frame::plan::FramePlan;
use crate::frame::state::Compare;
use crate::frame::stencil::StencilState;
use crate::frame::step::{Draw, DrawSet, Surface};

/// A step of decals, or what comes between them; `None` where the draw has nothing to do with them.
pub(super) fn check(plan: &FramePlan, draw: &Draw, state: &mut Progress) -> Option<Result<(), &'static str>> {
    let budget = plan.budget;
    if budget.decal_mask == 0 {
        return None;
    }
    let stencil = draw.state.stencil;
    let of_surfaces = matches!(draw.set, DrawSet::Surfaces(_));
    if of_surfaces && stencil == StencilState::mark_ground(budget) {
        if draw.state.depth.compare != Compare::Equal || draw.state.depth.write || draw.stencil_reference != budget.decal_mask {
            return Some(Err("the ground of decals is marked where it is seen: at its own depth"));
        }
        if state.counting {
            return Some(Err("decals are laid before anything is counted, or after all of it"));
        }
        if !state.ground_marked {
            state.grounds.push(Vec::new());
        }
        state.ground_marked = true;
        state.remember(draw);
        return Some(Ok(()));
    }
    if of_surfaces && stencil == StencilState::claim_ground(budget) && draw.stencil_reference == budget.decal_mask {
        state.remember(draw);
        return Some(if state.ground_marked { Ok(()) } else { Err("decals claim ground that was not marked") });
    }
    if draw.set == DrawSet::FullScreen && stencil == StencilState::unmark_ground(budget) {
        state.ground_marked = false;
        return Some(Ok(()));
    }
    let touches = stencil.tests() || stencil.writes();
    (state.ground_marked && touches).then_some(Err("it asks the stencil while the ground of decals is marked"))
}

impl Progress {
    /// The surfaces of a draw are of the ground that is marked, or lie on it.
    fn remember(&mut self, draw: &Draw) {
        if let (Some(ground), DrawSet::Surfaces(surfaces)) = (self.grounds.last_mut(), &draw.set) {
            ground.extend(surfaces);
        }
    }

    /// Whether two surfaces are ground of the same decals, or decals on the same ground.
    pub(super) fn shares_ground(&self, a: Surface, b: Surface) -> bool {
        self.grounds.iter().any(|ground| ground.contains(&a) && ground.contains(&b))
    }
}
