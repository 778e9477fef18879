//! Where decals come in the frame: opaque ones with the ground, before any light; blended ones after all of it.
//!
//! In a view with mirrors both come after what its mirrors show: the bit is free then, and decals on a mirror cover it.

use super::Frame;
use crate::frame::stencil::BitBudget;
use crate::settings::{DecalMode, PlanarMode, Show};
use crate::techniques::decals::Decals;
use crate::techniques::surfaces::SurfaceGroup;

impl Frame<'_> {
    /// Decides how decals are drawn in what is shown.
    pub(super) fn choose_decals(&mut self) {
        let shows_light = matches!(self.settings.show, Show::Final | Show::Volumes | Show::Wireframe);
        let hidden = matches!(self.settings.show, Show::Shadow | Show::Stencil | Show::Overflow | Show::Surfaces);
        let mode = match self.settings.decals {
            DecalMode::Stencil if !shows_light => DecalMode::Offset,
            mode => mode,
        };
        // Shadows that hang in mid-air ask for no value.
        let tagged = self.settings.planar.mode != PlanarMode::Naive;
        let receives = |surface| tagged && self.receivers.holds(surface);
        self.decals = Decals::new(self.scene, self.pose, mode, hidden, receives);
        if hidden && !self.decals.is_empty() {
            self.plan.notes.push("decals are left out: exact values are those of the ground they lie on".into());
        }
        if self.decals.parted() {
            self.plan.notes.push("decals by polygon offset where of them and their ground only some take planar shadows".into());
        }
    }

    /// Opaque decals on their grounds, in a bit that nobody has used.
    pub(super) fn lay_decals(&mut self, groups: &[&SurfaceGroup]) {
        if !self.decals.claim() {
            return;
        }
        let BitBudget { beyond_mask, mirror_mask, .. } = self.plan.budget;
        if self.used | self.stored | beyond_mask | mirror_mask == u8::MAX {
            self.reset_view("decals begin", "Decals need a bit: counting begins anew after them.", 0);
            (self.stored, self.used) = (0, 0);
        }
        // The same bit in every view: each but the eye's begins with all of them used.
        self.plan.budget = self.plan.budget.with_decals(self.used | self.stored);
        let steps = self.decals.lay(groups, self.plan.budget, self.whole());
        self.extend(steps);
    }

    /// Blended decals, when nothing needs the stencil any more.
    pub(super) fn blend_decals(&mut self, groups: &[&SurfaceGroup]) {
        let steps = self.decals.blend(self.known(), self.view(), groups, self.plan.budget, self.whole());
        if steps.is_empty() {
            return;
        }
        self.reset_view("forget the count", "All light is there: decals have the stencil for themselves.", 0);
        (self.stored, self.used) = (0, u8::MAX);
        self.extend(steps);
    }
}
