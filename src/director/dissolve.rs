//! A picture that dissolves into another (K section 7, figure 16): two frames of one scene, one after the other, mixed by
//! a pattern in the stencil before the light becomes a picture.
//!
//! ```text
//!   the first frame       all of it, but for exposure and tone curve; kept in a texture
//!   the second frame      the same, by the other technique
//!   pattern               the stencil is cleared, and the pixels that have turned are marked
//!   lay                   the first frame again, where nothing is marked
//!   tone map              and what comes after it
//! ```

use super::Frame;
use crate::frame::plan::FramePlan;
use crate::frame::state::{Blend, State};
use crate::frame::stencil::{BitBudget, StencilState};
use crate::frame::{Action, Clear, Draw, DrawSet, Program, Step, VolumePart};
use crate::settings::{Dissolve, Settings, Show, Technique};

/// Whether, and into what, these settings dissolve their picture.
#[must_use]
pub fn wanted(settings: &Settings) -> Option<Technique> {
    settings.dissolve.into.filter(|_| settings.show == Show::Final)
}

impl Frame<'_> {
    /// One of two frames that are to be mixed: not drawn directly, and with one sample a pixel.
    pub(super) fn dissolves(&self) -> bool {
        wanted(self.settings).is_some()
    }
}

/// Both frames as one: `first` dissolving into `second`, which is the same but for the technique; `first` alone, with a
/// note, where they cannot share the targets.
#[must_use]
pub fn mixed(mut first: FramePlan, second: FramePlan, dissolve: &Dissolve, time: f64) -> FramePlan {
    let ends = |plan: &FramePlan| plan.steps.iter().position(is_tone_map);
    let in_textures = first.views.iter().any(|view| view.texture.is_some());
    let alike = first.views == second.views
        && BitBudget { points_mask: 0, ..first.budget } == BitBudget { points_mask: 0, ..second.budget };
    let (Some(end), Some(second_end)) = (ends(&first), ends(&second)) else { return first };
    if in_textures || !alike || first.gather.is_some() {
        first.notes.push("nothing dissolves here: the two pictures have not the same views and bits".into());
        return first;
    }
    first.views[0].texture = Some(0);
    let whole = first.views[0].rect;
    let last = first.steps.split_off(end);
    let why = "The first picture is kept as it is, linear, while the second is drawn.";
    first.steps.push(Step { label: "keep the first picture".into(), why: why.into(), view: 0, action: Action::Keep });
    let before = first.volumes.len();
    first.volumes.extend(second.volumes);
    first.budget.points_mask |= second.budget.points_mask;
    first.steps.extend(second.steps.into_iter().take(second_end).map(|step| moved_on(step, before)));
    first.notes.extend(second.notes);
    let mut told = std::collections::HashSet::new();
    first.notes.retain(|note| told.insert(note.clone()));
    let bit = first.budget.count_mask & first.budget.count_mask.wrapping_neg();
    let why = "The stencil is free for the pattern.";
    let clear = Clear { color: None, depth: None, stencil: Some(0), counts: None };
    first.steps.push(Step { label: "clear the stencil".into(), why: why.into(), view: 0, action: Action::Clear(clear) });
    let amount = dissolve.amount_at(time);
    let state = State { stencil: StencilState::mark(bit), ..State::FLAT };
    let draw = Draw::plain(Program::Pattern, DrawSet::FullScreen, whole);
    let constant = [dissolve.pattern as u8 as f32, amount, 0.0, 0.0];
    let pattern = Draw { state, stencil_reference: bit, constant, ..draw };
    first.steps.push(Step::drawing("pattern", "Marks the pixels that have turned to the second picture.", pattern));
    let state = State { stencil: StencilState::unmarked(bit), color: Some(Blend::Replace), ..State::FLAT };
    let lay = Draw { state, ..Draw::plain(Program::LayKept, DrawSet::FullScreen, whole) };
    first.steps.push(Step::drawing(
        "lay the first picture",
        "Where nothing is marked the first picture takes its place again.",
        lay,
    ));
    first.steps.extend(last);
    first
}

fn is_tone_map(step: &Step) -> bool {
    matches!(&step.action, Action::Draw(draw) if draw.program == Program::ToneMap)
}

/// A step of a frame whose volumes come after so many others.
fn moved_on(mut step: Step, by: usize) -> Step {
    if let Action::Draw(draw) = &mut step.action
        && let DrawSet::Volumes(parts) = &mut draw.set
    {
        *parts = parts.iter().map(|part| VolumePart { volume: part.volume + by, ..*part }).collect();
    }
    step
}
