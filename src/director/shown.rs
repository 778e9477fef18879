//! What is shown beside the picture: volumes, the eye's bounds from above, and names.

use super::Frame;
use crate::frame::plan::View;
use crate::frame::{Camera, Method, Target};
use crate::settings::Technique;
use crate::techniques::above::{Above, above};
use crate::techniques::cases::{self, Class};
use crate::techniques::labels::{self, Named};
use crate::techniques::surfaces::{self, SurfaceGroup};
use crate::techniques::{self, bounds, complexity, show};

impl Frame<'_> {
    /// Makes sure that the light whose volumes are shown has some, even when nothing counted them.
    pub(super) fn plan_glass(&mut self, light: usize) {
        if !self.plan.volumes.iter().any(|volume| volume.view == 0 && volume.light == light && volume.method != Method::Projected)
        {
            self.count_by(techniques::row(Technique::ZPass), light);
        }
    }

    /// Decides every caster of a light, by the chosen technique or, where that counts nothing, as the
    /// volumes that are shown are.
    pub(super) fn plan_casters(&mut self, light: usize) {
        self.count(light);
        self.plan_glass(light);
    }

    /// What each instance is to a light whose casters are planned.
    pub(super) fn classes(&self, light: usize) -> Vec<Class> {
        cases::classes(self.scene, &self.plan.volumes, light, self.pose.lights[light].shadows)
    }

    /// Takes the eye's place to look at all from above; gives the eye, for which everything was planned.
    pub(super) fn rise(&mut self) -> (Camera, Above) {
        let eye = self.plan.views[0].camera;
        let above = above(self.scene, self.pose, &eye, self.settings.light);
        if let Some(cut) = above.cut {
            self.plan.notes.push(format!("something covers the eye: all above {cut:.1} m is cut away"));
        }
        self.plan.views[0] = View::of_eye("above", above.camera, self.plan.size);
        // Display values have no exposure.
        self.plan.exposure = 1.0;
        (eye, above)
    }

    /// How often each pixel is drawn, as colours with a legend.
    pub(super) fn draw_complexity(&mut self, groups: &[SurfaceGroup]) {
        if !self.scene.mirrors_in_force(&self.settings.mirrors).0.is_empty() {
            self.plan.notes.push("mirrors are ordinary surfaces here: one stencil byte counts one view's fragments".into());
        }
        if self.scene.solid.is_some() {
            self.plan.notes.push("two solids put together are counted as the two objects that they are drawn from".into());
        }
        let (whole, what, budget) = (self.whole(), self.settings.complexity, self.plan.budget);
        self.clear_all(cases::BACKGROUND, 0);
        let blended = surfaces::transparent(self.known(), self.view(), whole);
        self.extend(complexity::count(groups, blended, what, budget, whole));
        self.extend(complexity::colors(groups, budget, whole));
        self.push(show::copy(whole));
        self.extend(complexity::legend(what, self.plan.size, whole));
    }

    pub(super) fn draw_bounds(&mut self, eye: &Camera, above: &Above, scissor: Option<[u32; 4]>) {
        let scope = bounds::Scope {
            above,
            eye,
            size: self.plan.size,
            pose: self.pose,
            lights: self.scene.lights.len(),
            light: self.settings.light,
            bounds: self.settings.culling.light_bounds,
            scissor,
        };
        if scissor.is_none() {
            self.plan.notes.push(format!("light {} reaches nothing in view", self.settings.light));
        }
        self.push(bounds::step(bounds::strokes(&scope), self.whole()));
    }

    /// Names, where they are asked for, over the finished picture.
    pub(super) fn label(&mut self, target: Target) {
        if !self.settings.lighting.labels {
            return;
        }
        self.name(Named { casters: true, eye: None }, self.plan.views[0].camera, target);
    }

    /// Names over the finished picture, which `camera` sees.
    pub(super) fn name(&mut self, named: Named, camera: Camera, target: Target) {
        let (labels, left_out) = labels::labels(self.scene, self.pose, named, camera, self.plan.size);
        if left_out > 0 {
            self.plan.notes.push(format!("{left_out} names have no room in the picture"));
        }
        if !labels.is_empty() {
            self.push(labels::step(labels, target, self.whole()));
        }
    }
}
