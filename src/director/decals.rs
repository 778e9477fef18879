//! Where decals come in the frame: opaque ones with the ground, before any light; blended ones after all of it.

use super::Frame;
use crate::settings::{DecalMode, Show};
use crate::techniques::decals::Decals;
use crate::techniques::surfaces::SurfaceGroup;

impl Frame<'_> {
    /// Decides how decals are drawn in what is shown.
    pub(super) fn choose_decals(&mut self) {
        let shows_light = matches!(self.settings.show, Show::Final | Show::Volumes | Show::Wireframe);
        let hidden = matches!(self.settings.show, Show::Shadow | Show::Stencil | Show::Overflow | Show::Surfaces);
        let in_mirrors = self.plan.views.len() > 1;
        let elsewhere = in_mirrors || self.is_planar();
        let mode = match self.settings.decals {
            DecalMode::Stencil if elsewhere || !shows_light => DecalMode::Offset,
            mode => mode,
        };
        self.decals = Decals::new(self.scene, self.pose, mode, hidden);
        if self.decals.is_empty() {
            return;
        }
        if hidden {
            self.plan.notes.push("decals are left out: exact values are those of the ground they lie on".into());
        } else if mode != self.settings.decals && elsewhere {
            let whose = if in_mirrors { "mirrors" } else { "planar shadows" };
            self.plan.notes.push(format!("decals by polygon offset: {whose} have taken the stencil before the lights"));
        }
    }

    /// Opaque decals on their grounds, in a bit that nobody has used.
    pub(super) fn lay_decals(&mut self, groups: &[SurfaceGroup]) {
        if !self.decals.claim() {
            return;
        }
        let taken = self.used | self.stored | self.plan.budget.beyond_mask;
        if taken == u8::MAX {
            self.reset_view("forget the count", "Decals need a bit: counting begins anew after them.", 0);
            self.stored = 0;
        }
        self.plan.budget = self.plan.budget.with_decals(self.used | self.stored);
        let steps = self.decals.lay(groups, self.plan.budget, self.whole());
        self.extend(steps);
    }

    /// Blended decals, when nothing needs the stencil any more.
    pub(super) fn blend_decals(&mut self, groups: &[SurfaceGroup]) {
        let steps = self.decals.blend(self.known(), self.view(), groups, self.plan.budget, self.whole());
        if steps.is_empty() {
            return;
        }
        self.reset_view("forget the count", "All light is there: decals have the stencil for themselves.", 0);
        (self.stored, self.used) = (0, u8::MAX);
        self.extend(steps);
    }
}
