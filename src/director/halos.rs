//! Halos come over a view's finished surfaces, when nothing needs the stencil any more.

use super::Frame;
use crate::settings::{Show, Texturing};
use crate::techniques::halo::{self, Glow, Glowing};
use crate::techniques::surfaces;

impl Frame<'_> {
    /// Whether anything glows in what is shown.
    pub(super) fn has_halos(&self) -> bool {
        let shows_light = matches!(self.settings.show, Show::Final | Show::Volumes | Show::Wireframe);
        shows_light && self.settings.halos.width > 0.0 && self.glowing.contains(&true)
    }

    /// The halos that the view sees.
    pub(super) fn draw_halos(&mut self) {
        if !self.has_halos() {
            return;
        }
        let (whole, [_, height]) = (self.whole(), self.view().picture);
        let groups = surfaces::opaque_groups(self.known(), self.view(), self.view().picture, Texturing::EachLight);
        let halos = &self.settings.halos;
        #[expect(clippy::cast_precision_loss, reason = "pixels fit f32 exactly")]
        let pixels = halos.width / 100.0 * height as f32;
        let glow = Glow { color: halos.color, pixels, exposure: self.plan.exposure };
        let mesh = surfaces::solid_group(self.known(), self.view());
        let glowing = Glowing::new(&groups, &self.glowing, self.scene.solid.as_ref(), mesh);
        let steps = halo::steps(&glowing, glow, self.plan.budget, whole);
        if steps.is_empty() {
            return;
        }
        self.reset_view("forget the count", "All light is there: halos have the stencil for themselves.", 0);
        (self.stored, self.used) = (0, u8::MAX);
        self.extend(steps);
    }
}
