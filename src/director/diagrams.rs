//! Diagrams: the scene from the side, or as the light sees a caster, with rays, volumes and counts drawn in.

use super::Frame;
use crate::frame::plan::View;
use crate::frame::{Camera, Label, Stroke, Target};
use crate::settings::{Diagram, Texturing};
use crate::techniques::labels::{self, Named};
use crate::techniques::surfaces::{self, Tint};
use crate::techniques::{bounds, cases, diagram, show};

impl Frame<'_> {
    /// The picture of every surface in one colour, seen from where the diagram is drawn, and the diagram over it.
    pub(super) fn draw_diagram(&mut self) {
        let (whole, light, what) = (self.whole(), self.settings.light, self.settings.diagram);
        self.plan_casters(light);
        let eye = self.plan.views[0].camera;
        let (camera, strokes, words) = self.diagram(what, &eye);
        let name = match what {
            Diagram::Order => "eye",
            Diagram::Fan => "light",
            _ => "side",
        };
        self.plan.views[0] = View::of_eye(name, camera, self.plan.size);
        // Display values have no exposure.
        self.plan.exposure = 1.0;
        let groups = surfaces::opaque_groups(self.known(), self.view(), self.plan.size, Texturing::EachLight);
        self.clear_all(cases::BACKGROUND, 0);
        self.draw_solid();
        let why = "Every surface in one colour: the diagram is what is looked at.";
        let shade = if what.from_the_side() { 0.40 } else { 0.62 };
        let tint = Tint { label: "surfaces", why, color: [shade, shade * 1.03, shade * 1.10, 1.0], inside: false };
        self.extend(surfaces::tinted(&groups, &tint, |_| true, whole));
        if what.from_the_side() {
            self.extend(bounds::cut(&groups, whole));
        } else if what == Diagram::Order {
            self.extend(bounds::glass(&self.plan.volumes, light, whole));
        }
        self.push(show::copy(whole));
        self.push(diagram::step(strokes, whole));
        // From the light itself there is no lamp to be named.
        let mut names = if what == Diagram::Fan { Vec::new() } else { self.lamps_and_eye(&eye, &camera, what) };
        names.extend(words);
        self.push(labels::step(names, Target::Output, whole));
    }

    /// Where the diagram is seen from, its lines and its words.
    fn diagram(&mut self, what: Diagram, eye: &Camera) -> (Camera, Vec<Stroke>, Vec<Label>) {
        let (scene, pose, size) = (self.scene, self.pose, self.plan.size);
        let light = &pose.lights[self.settings.light];
        match what {
            Diagram::Order => {
                let (strokes, words) = diagram::fan::order(scene, pose, eye, size);
                (*eye, strokes, words)
            }
            Diagram::Fan => match diagram::fan::from_the_light(scene, pose, eye, light) {
                Some(camera) => {
                    let (strokes, words) = diagram::fan::fan(scene, pose, eye, &camera, size);
                    (camera, strokes, words)
                }
                None => {
                    self.plan.notes.push("nothing casts a shadow here: no fan to draw".into());
                    (*eye, Vec::new(), Vec::new())
                }
            },
            _ => {
                let classes = self.classes(self.settings.light);
                let mirrors = scene.mirrors_in_force(&self.settings.mirrors).0;
                let scope = diagram::Scope { scene, pose, eye, light, mirrors: &mirrors, classes: &classes };
                let side = diagram::side(what, &scope);
                let (strokes, words) = diagram::overlay(what, &scope, &side, size).finished();
                (side, strokes, words)
            }
        }
    }

    fn lamps_and_eye(&self, eye: &Camera, camera: &Camera, what: Diagram) -> Vec<Label> {
        let eye = what.from_the_side().then_some(eye.eye);
        let named = Named { casters: self.settings.lighting.labels, eye };
        labels::labels(self.scene, self.pose, named, Camera { near: 0.0, ..*camera }, self.plan.size).0
    }
}
