//! A solid's depth comes before its view's surfaces: they find themselves by it.

use super::Frame;
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
    /// What a user should know of the scene's solid.
    pub(super) fn note_solid(&mut self) {
        let Some(solid) = &self.scene.solid else { return };
        if let Some(why) = &solid.refusal {
            let glows = self.has_halos() && (self.glowing[solid.a] || self.glowing[solid.b]);
            let lacks: Vec<_> = [(solid.casts, "casts no shadow"), (glows, "has no halo")]
                .into_iter()
                .filter(|lack| lack.0)
                .map(|lack| lack.1)
                .collect();
            if !lacks.is_empty() {
                self.plan.notes.push(format!("the solid {}: {why}", lacks.join(" and ")));
            }
        }
        // Operands that move against each other are combined anew for every picture; single frames of one cannot be.
        if self.scene.combination(&self.settings.csg, self.pose).is_none_or(|now| !now.is_like(&solid.of)) {
            self.plan.notes.push("the solid's shadow is that of another time: A and B have moved against each other".into());
        }
    }
}
