//! A picture that dissolves into another (K section 7, figure 16): two frames, one after the other, mixed by a pattern in
//! the stencil before the light becomes a picture.
//!
//! ```text
//!   the first frame       all of it, but for exposure and tone curve; kept in a texture
//!   the second frame      the same, by the other technique
//!   pattern               the stencil is cleared, and the pixels that have turned are marked
//!   lay                   the first frame again, where nothing is marked
//!   tone map              and what comes after it
//! ```
//!
//! Two frames of one scene are one plan. Another scene has numbers of its own, for all that a plan speaks of: its frame is a
//! plan by itself, drawn after this one into the same targets ([`FramePlan::then`]), with its own views, bits and exposure.

use super::Frame;
use crate::frame::plan::FramePlan;
use crate::frame::state::{Blend, State};
use crate::frame::stencil::{BitBudget, StencilState};
use crate::frame::{Action, Clear, Draw, DrawSet, Program, Step, VolumePart};
use crate::settings::{Accumulation, Dissolve, Pattern, Settings, Show};

/// Whether these settings dissolve their picture.
#[must_use]
pub fn wanted(settings: &Settings) -> bool {
    let Dissolve { into, scene, .. } = &settings.dissolve;
    (into.is_some() || scene.is_some()) && settings.show == Show::Final
}

impl Frame<'_> {
    /// One of two frames that are to be mixed: not drawn directly, and with one sample a pixel.
    pub(super) fn dissolves(&self) -> bool {
        wanted(self.settings)
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
    let last = first.steps.split_off(end);
    keep(&mut first);
    let before = first.volumes.len();
    first.volumes.extend(second.volumes);
    first.budget.points_mask |= second.budget.points_mask;
    first.steps.extend(second.steps.into_iter().take(second_end).map(|step| moved_on(step, before)));
    tell(&mut first, second.notes);
    lay(&mut first, dissolve.pattern, dissolve.amount_at(time), 1.0);
    first.steps.extend(last);
    first
}

/// A frame that dissolves into one of another scene, which comes after it; `first` alone, with a note, where the targets'
/// textures are taken.
#[must_use]
pub fn into_another(mut first: FramePlan, mut second: FramePlan, dissolve: &Dissolve, time: f64) -> FramePlan {
    let ends = |plan: &FramePlan| plan.steps.iter().position(is_tone_map);
    let (Some(end), Some(second_end)) = (ends(&first), ends(&second)) else { return first };
    if first.views.iter().chain(&second.views).any(|view| view.texture.is_some()) {
        first.notes.push("nothing dissolves here: reflections have taken the texture".into());
        return first;
    }
    first.steps.truncate(end);
    let state = State { color: Some(Blend::Under), ..State::FLAT };
    let behind = Draw { state, ..Draw::plain(Program::Backdrop, DrawSet::FullScreen, first.views[0].rect) };
    let why = "The first picture's own background, which the second's would not be.";
    first.steps.push(Step::drawing("background of the first picture", why, behind));
    keep(&mut first);
    // The texture must outlive the first frame: both have it.
    second.views[0].texture = Some(0);
    let last = second.steps.split_off(second_end);
    // Light is exposed at the end, as the second picture's; in 8 bits it has been already.
    let exposed = if first.accumulation == Accumulation::Float { first.exposure / second.exposure } else { 1.0 };
    lay(&mut second, dissolve.pattern, dissolve.amount_at(time), exposed);
    second.steps.extend(last);
    tell(&mut first, std::mem::take(&mut second.notes));
    first.then = Some(Box::new(second));
    first
}

/// What was drawn so far goes into the eye's texture.
fn keep(plan: &mut FramePlan) {
    plan.views[0].texture = Some(0);
    let why = "The first picture is kept as it is, linear, while the second is drawn.";
    plan.steps.push(Step { label: "keep the first picture".into(), why: why.into(), view: 0, action: Action::Keep });
}

/// More notes, each once.
fn tell(plan: &mut FramePlan, notes: Vec<String>) {
    plan.notes.extend(notes);
    let mut told = std::collections::HashSet::new();
    plan.notes.retain(|note| told.insert(note.clone()));
}

/// The pattern, and what was kept where it leaves room, times `exposed`.
fn lay(plan: &mut FramePlan, pattern: Pattern, amount: f32, exposed: f32) {
    let whole = plan.views[0].rect;
    let bit = plan.budget.count_mask & plan.budget.count_mask.wrapping_neg();
    let why = "The stencil is free for the pattern.";
    let clear = Clear { color: None, depth: None, stencil: Some(0), counts: None };
    plan.steps.push(Step { label: "clear the stencil".into(), why: why.into(), view: 0, action: Action::Clear(clear) });
    let state = State { stencil: StencilState::mark(bit), ..State::FLAT };
    let constant = [pattern as u8 as f32, amount, 0.0, 0.0];
    let draw = Draw { state, stencil_reference: bit, constant, ..Draw::plain(Program::Pattern, DrawSet::FullScreen, whole) };
    plan.steps.push(Step::drawing("pattern", "Marks the pixels that have turned to the second picture.", draw));
    let state = State { stencil: StencilState::unmarked(bit), color: Some(Blend::Replace), ..State::FLAT };
    let constant = [exposed, 0.0, 0.0, 0.0];
    let draw = Draw { state, constant, ..Draw::plain(Program::LayKept, DrawSet::FullScreen, whole) };
    plan.steps.push(Step::drawing(
        "lay the first picture",
        "Where nothing is marked the first picture takes its place again.",
        draw,
    ));
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
