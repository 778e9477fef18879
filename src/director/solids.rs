//! A solid's depth comes before its view's surfaces: they find themselves by it.

use super::Frame;
use crate::frame::FramePlan;
use crate::scene::{Pose, Scene};
use crate::settings::Settings;
use crate::techniques::csg;

impl Frame<'_> {
    /// The depth of the scene's solid, where it has one, as the view sees it.
    pub(super) fn draw_solid(&mut self) {
        let Some(solid) = &self.scene.solid else { return };
        let (bits, samples) = (self.settings.counting.bits, self.plan.samples);
        let (steps, notes) = csg::steps(self.known(), self.view(), solid, bits, samples);
        self.extend(steps);
        for note in notes {
            if !self.plan.notes.contains(&note) {
                self.plan.notes.push(note);
            }
        }
    }
}

/// What a user should know of the scene's solid.
pub(super) fn note(plan: &mut FramePlan, settings: &Settings, scene: &Scene, pose: &Pose) {
    let Some(solid) = &scene.solid else { return };
    if let Some(why) = &solid.refusal {
        plan.notes.push(format!("the solid casts no shadow: {why}"));
    }
    // Operands that move against each other are combined anew for every picture; single frames of one cannot be.
    if scene.combination(&settings.csg, pose).is_none_or(|now| !now.is_like(&solid.of)) {
        plan.notes.push("the solid's shadow is that of another time: A and B have moved against each other".into());
    }
}
