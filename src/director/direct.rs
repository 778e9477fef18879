//! Frames of one light at most, whose surfaces are drawn in their final colour straight into the picture.

use super::Frame;
use crate::frame::stencil::BitBudget;
use crate::frame::{Step, Target};
use crate::settings::Shading;
use crate::techniques::own_bits::{Round, Shining};
use crate::techniques::{show, surfaces};

impl Frame<'_> {
    /// The frame of one light at most, with nothing blended: depth, the count, and then every surface
    /// once, in its final colour. Nothing is accumulated, so the linear target is not used at all. Where
    /// nothing is counted, surfaces lay depth as they are drawn; and so they do where they are drawn early, as if all of them were
    /// lit, and again where they are in shadow.
    pub(super) fn draw_directly(&mut self, only: Option<Round>, groups: &[surfaces::SurfaceGroup]) {
        let whole = self.whole();
        let round = only.unwrap_or_default();
        self.clear_all([0.0, 0.0, 0.0, 1.0], round.base);
        let shining = round.lights.first();
        let budget = shining.and_then(|shining| shining.budget);
        let scissor = round.counted_within().unwrap_or(whole);
        let reached = shining.map(|shining| self.reached(shining.light));
        let only = shining.zip(reached.as_ref()).map(|(&Shining { light, .. }, reached)| surfaces::OnlyLight {
            light,
            shape: (&self.pose.lights[light]).into(),
            reached,
            dark: budget.map(|budget| surfaces::Dark { budget, scissor }),
        });
        let early = self.draws_early(budget);
        for step in surfaces::depth(groups, budget.is_some() && !early, whole) {
            self.push(Step { action: step.action.onto(Target::Direct), ..step });
        }
        let [before, after] = match &only {
            Some(only) if early => surfaces::finished_early(groups, only, round.base != 0, whole),
            only => [Vec::new(), surfaces::finished(groups, only.as_ref(), whole)],
        };
        self.extend(before);
        for step in round.steps {
            self.push(Step { action: step.action.onto(Target::Direct), ..step });
        }
        self.extend(after);
        self.push(show::background(whole));
    }

    /// Whether surfaces lay depth in the colour that most of them may keep, where some light is counted: that is one walk
    /// less over them, but what is hidden later is shaded in vain.
    fn draws_early(&self, budget: Option<BitBudget>) -> bool {
        budget.is_some() && matches!(self.settings.lighting.shading, Shading::Auto | Shading::Early)
    }
}
