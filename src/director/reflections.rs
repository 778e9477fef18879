//! A frame with mirrors: every view is drawn like the eye's own, in the pixels of its mirror.
//!
//! A view's mirrors are drawn before its lights: what a mirror shows of itself is added to its reflection, light by
//! light, and the stencil's count is free until then. Where exact values are shown it is the other way round: what a
//! view counted stays in its pixels, but where a mirror shows another.

use super::views::Outlook;
use super::{Frame, MID_GREY, rounds};
use crate::frame::plan::{View, Window};
use crate::frame::state::Winding;
use crate::frame::stencil::{BitBudget, StencilState};
use crate::frame::{Action, Clear, Step, Target};
use crate::scene::AlphaMode;
use crate::settings::{Show, Texturing};
use crate::techniques::above::above_rooms;
use crate::techniques::counting::LightCount;
use crate::techniques::mirrors::{self, Cover};
use crate::techniques::own_bits::{Round, Shining};
use crate::techniques::surfaces::{self, SurfaceGroup, Tint};
use crate::techniques::{birdseye, bounds, cases, show};

/// One view's surfaces.
struct Stage {
    /// Those that reflect nothing.
    plain: Vec<SurfaceGroup>,
    /// Mirrors without a view.
    grey: Vec<SurfaceGroup>,
    /// Mirrors with the view through each.
    open: Vec<(SurfaceGroup, usize)>,
}

impl Frame<'_> {
    /// The whole frame but its last step, which makes the picture of it; true where there is nothing left to do.
    pub(super) fn draw_reflections(&mut self) -> bool {
        match self.settings.show {
            Show::Final if self.may_reflect_directly() => {
                self.clear_all([0.0, 0.0, 0.0, 1.0], 0);
                self.draw_view(true);
                self.push(show::background(self.whole()));
                true
            }
            Show::Final | Show::Volumes | Show::Wireframe => {
                self.start(0);
                self.draw_view(false);
                false
            }
            _ => {
                self.draw_exactly();
                true
            }
        }
    }

    /// One light at most, and mirrors that show nothing but their reflection.
    fn may_reflect_directly(&self) -> bool {
        let lights = self.pose.lights.iter().filter(|light| light.on).count();
        let blended = |(_, _, mesh): (_, _, &crate::scene::Mesh)| {
            mesh.primitives.iter().any(|part| self.scene.materials[part.material].alpha == AlphaMode::Blend)
        };
        lights <= 1
            && !self.is_planar()
            && !self.unbounded()
            && !self.textured()
            && self.mirrors.all_perfect()
            && self.may_draw_directly()
            && !self.scene.instances().any(blended)
    }

    /// The surfaces of the view, apart by what is done with them.
    fn stage(&self, texturing: Texturing) -> Stage {
        let view = self.outlook.view;
        let children = self.children(view);
        let mut stage = Stage { plain: Vec::new(), grey: Vec::new(), open: Vec::new() };
        for group in surfaces::opaque_groups(self.known(), self.view(), self.view().picture, texturing) {
            let through = |child: &&usize| self.plan.views[**child].path().last().copied() == group.mirror();
            match (group.mirror(), children.iter().find(through)) {
                (None, _) => stage.plain.push(group),
                (Some(_), None) => stage.grey.push(group),
                (Some(_), Some(child)) => stage.open.push((group, *child)),
            }
        }
        stage
    }

    /// Surfaces, what their mirrors show, and then the lights.
    fn draw_view(&mut self, direct: bool) {
        let (whole, exposure) = (self.whole(), self.plan.exposure);
        let stage = self.stage(self.texturing());
        let is_eye = self.outlook.view == 0;
        let unbounded = is_eye && self.unbounded();
        if unbounded {
            self.draw_unbounded(&stage.open);
        }
        let textured = is_eye && self.textured();
        if textured {
            self.draw_textures(&stage.open);
        }
        // The eye's own way of drawing directly asks for counts that are not zero, which in a mirror it cannot.
        let only = if direct && is_eye { self.rounds().pop() } else { None };
        let depth_first = only.as_ref().is_some_and(|round| round.lights.iter().any(|shining| shining.budget.is_some()));
        if direct {
            let depth = surfaces::depth(&stage.plain, depth_first, whole);
            self.extend_onto(Target::Direct, depth);
            if !depth_first {
                self.extend(surfaces::finished(&stage.plain, None, whole));
            }
            let grey = surfaces::finished(&stage.grey, None, whole);
            self.extend_grey(&stage.grey, grey);
        } else {
            self.draw_solid();
            self.extend(surfaces::ambient(&stage.plain, whole));
            let grey = surfaces::ambient(&stage.grey, whole);
            self.extend_grey(&stage.grey, grey);
        }
        if textured {
            let laid = stage.open.iter().map(|(group, child)| self.mirrors.textured(group, &self.plan, *child)).collect();
            self.extend(laid);
        } else if !unbounded {
            let (target, cover) = if direct { (Target::Direct, Cover::Finished) } else { (Target::Scene, Cover::Light) };
            let open = stage.open.iter().map(|(group, _)| surfaces::lay(group, whole)).collect();
            self.extend_onto(target, open);
            self.draw_children(&stage.open, |frame| frame.draw_view(direct), cover);
        }

        if direct {
            let round = if is_eye { only } else { self.rounds().pop() };
            self.light_directly(&stage.plain, round, depth_first);
            return;
        }
        for (group, child) in &stage.open {
            let bounces = self.plan.views[*child].path().len();
            if let Some(step) = self.mirrors.own(group, bounces, exposure, whole) {
                self.push(step);
            }
        }
        let all: Vec<_> = stage.plain.iter().chain(&stage.grey).chain(stage.open.iter().map(|(group, _)| group)).collect();
        self.lay_decals(&all);
        if self.is_planar() {
            self.shine_planar(&all);
        }
        let rounds = if self.is_planar() { Vec::new() } else { self.rounds() };
        for round in rounds {
            self.start_round(&round);
            let Round { steps, lights, .. } = round;
            self.extend(steps);
            for Shining { light, rect, budget } in lights {
                let once = budget.map_or_else(|| self.unused_bit(Some(light)), StencilState::light_once);
                let (reached, shape) = (self.reached(light), (&self.pose.lights[light]).into());
                self.extend(surfaces::lit(&stage.plain, light, shape, rect, once, &reached));
                let mirrors = stage.grey.iter().chain(stage.open.iter().map(|(group, _)| group));
                let own = mirrors.filter(|group| group.mirror().is_some_and(|mirror| !self.mirrors.is_perfect(mirror)));
                let lit = |group| self.mirrors.lit(group, surfaces::lit([group], light, shape, rect, once, &reached));
                let steps = own.flat_map(lit).collect();
                self.extend(steps);
            }
        }
        if surfaces::textured_last(&stage.plain) {
            let once = self.unused_bit(None);
            self.extend(surfaces::textures(&stage.plain, once, whole));
        }
        self.blend_decals(&all);
        self.extend(surfaces::transparent(self.known(), self.view(), whole));
        self.draw_halos();
    }

    /// The frame's one light, over surfaces in their final colour.
    fn light_directly(&mut self, groups: &[SurfaceGroup], round: Option<Round>, depth_first: bool) {
        let whole = self.whole();
        if let Some(round) = &round {
            self.start_round(round);
        }
        let round = round.unwrap_or_default();
        let steps = round.steps;
        self.extend_onto(Target::Direct, steps);
        let shining = round.lights.first().copied();
        let reached = shining.map(|shining| self.reached(shining.light));
        let only = shining.zip(reached.as_ref()).map(|(Shining { light, budget, .. }, reached)| surfaces::OnlyLight {
            light,
            shape: (&self.pose.lights[light]).into(),
            reached,
            dark: budget.map(|budget| surfaces::Dark { budget, scissor: whole }),
        });
        if depth_first {
            self.extend(surfaces::finished(groups, only.as_ref(), whole));
        } else if let Some(only) = &only {
            self.extend(surfaces::relit(groups, only, shining.map_or(whole, |shining| shining.rect)));
        }
    }

    /// Each mirror's view all over the picture, before the room itself (K section 2), and then the mirrors' depth: the
    /// room covers what lies behind it, and what is reflected shows wherever nothing does.
    fn draw_unbounded(&mut self, open: &[(SurfaceGroup, usize)]) {
        for (number, (_, child)) in open.iter().enumerate() {
            let outer = self.look_from(*child);
            self.used = u8::MAX;
            if number == 0 {
                self.push(mirrors::cover(&self.plan.views[*child], Cover::Light));
            }
            self.draw_view(false);
            self.outlook = outer;
        }
        self.used = u8::MAX;
        let whole = self.whole();
        self.extend(open.iter().map(|(group, _)| surfaces::lay(group, whole)).collect());
        let dimmed = open.iter().filter_map(|(group, child)| self.mirrors.dim(group, &self.plan, *child));
        let dimmed = dimmed.collect();
        self.extend(dimmed);
    }

    /// Each mirror's view by itself, into its texture.
    fn draw_textures(&mut self, open: &[(SurfaceGroup, usize)]) {
        for (_, child) in open {
            self.clear_all([0.0; 4], 0);
            let outer = self.look_from(*child);
            self.used = u8::MAX;
            self.push(mirrors::cover(&self.plan.views[*child], Cover::Light));
            self.draw_view(false);
            let why = "The reflection goes into the mirror's texture; the targets are free for what comes next.";
            let label = format!("keep {}", self.view().name);
            self.push(Step { label, why: why.into(), view: *child, action: Action::Keep });
            self.outlook = outer;
        }
        self.start(0);
    }

    /// Each mirror's view, where the mirror is seen.
    fn draw_children(&mut self, open: &[(SurfaceGroup, usize)], mut draw: impl FnMut(&mut Self), cover: Cover) {
        for (group, child) in open {
            let dims = cover == Cover::Light;
            let target = if cover == Cover::Finished { Target::Direct } else { Target::Scene };
            let tag = self.mirrors.tag(group, &self.plan, *child);
            self.plan.steps.push(onto(target, tag));
            let outer = self.look_from(*child);
            self.used = u8::MAX;
            self.push(mirrors::cover(&self.plan.views[*child], cover));
            draw(self);
            self.outlook = outer;
            let uncover = self.mirrors.uncover(group, &self.plan, *child, dims);
            self.plan.steps.push(onto(target, uncover));
            self.used = u8::MAX;
        }
    }

    /// What exact values are shown of: each view's own, mirrors as windows.
    fn draw_exactly(&mut self) {
        match self.settings.show {
            Show::Surfaces => {
                self.clear_all([0.0; 4], 0);
                self.draw_identities();
                self.push(show::copy(self.whole()));
            }
            Show::Views => {
                self.clear_all(cases::BACKGROUND, 0);
                self.draw_paths();
                self.push(show::copy(self.whole()));
            }
            Show::Birdseye => self.draw_from_above(),
            _ => self.draw_values(),
        }
    }

    fn draw_identities(&mut self) {
        let whole = self.whole();
        let stage = self.stage(Texturing::EachLight);
        self.draw_solid();
        self.extend(surfaces::identities(&stage.plain, whole));
        self.extend(surfaces::identities(&stage.grey, whole));
        let open = stage.open.iter().map(|(group, _)| surfaces::lay(group, whole)).collect();
        self.extend(open);
        self.draw_children(&stage.open, Self::draw_identities, Cover::Value([0.0; 4]));
    }

    fn draw_paths(&mut self) {
        let whole = self.whole();
        let stage = self.stage(Texturing::EachLight);
        let [r, g, b] = mirrors::path_color(self.view().path());
        let tint = Tint {
            label: "view",
            why: "Every surface in the colour of the mirrors on the way to it.",
            color: [r, g, b, 1.0],
            inside: false,
        };
        self.draw_solid();
        self.extend(surfaces::tinted(&stage.plain, &tint, |_| true, whole));
        self.extend(surfaces::tinted(&stage.grey, &Tint { color: mirrors::NO_VIEW, ..tint }, |_| true, whole));
        let open = stage.open.iter().map(|(group, _)| surfaces::lay(group, whole)).collect();
        self.extend(open);
        self.draw_children(&stage.open, Self::draw_paths, Cover::Value(cases::BACKGROUND));
    }

    /// Every view's room where it seems to stand, seen from above; and what the eye sees of each.
    fn draw_from_above(&mut self) {
        let (eye, planned) = (self.plan.views[0].camera, self.plan.views.clone());
        let room = self.scene.bounds(self.pose);
        let rooms = birdseye::seeming(&planned).iter().fold(room, |all, place| all.union(&room.transformed(place)));
        let above = above_rooms(self.scene, self.pose, &eye, &rooms);
        let size = self.plan.size;
        self.plan.budget = BitBudget::of_bits(self.settings.counting.bits);
        self.plan.exposure = 1.0;
        for (number, before) in planned.iter().enumerate() {
            let camera = match &before.through {
                Some(window) => self.plan.views[window.parent].camera.turned(&window.turn),
                None => above.camera,
            };
            let through = before.through.clone().map(|window| Window { level: 0, ..window });
            let winding = if camera.mirrored { Winding::Cw } else { Winding::Ccw };
            let name = before.name.replacen("eye", "above", 1);
            self.plan.views[number] = View { winding, through, ..View::of_eye(&name, camera, size) };
        }
        self.clear_all(cases::BACKGROUND, 0);
        for number in 0..planned.len() {
            let view = (number, &self.plan.views[number]);
            self.outlook = Outlook::new((self.scene, self.pose), view, None, self.workspace);
            let groups = surfaces::opaque_groups(self.known(), self.view(), size, Texturing::EachLight);
            let [r, g, b] = mirrors::path_color(self.view().path());
            let why = "Every view's room in its colour, where it seems to stand.";
            let tint = Tint { label: "room", why, color: [r, g, b, 1.0], inside: false };
            self.draw_solid();
            self.extend(surfaces::tinted(&groups, &tint, |_| true, self.whole()));
            if above.cut.is_some() {
                self.extend(bounds::cut(&groups, self.whole()));
            }
        }
        self.outlook = Outlook::new((self.scene, self.pose), (0, &self.plan.views[0]), None, self.workspace);
        self.push(show::copy(self.whole()));
        let strokes = birdseye::strokes((&above, &eye, self.pose), &planned, &self.sights, mirrors::path_color, size);
        self.push(bounds::step(strokes, self.whole()));
    }

    /// One light's count, or verdict, in every view.
    fn draw_values(&mut self) {
        let (light, stencil) = (self.settings.light, self.settings.show == Show::Stencil);
        let planar = self.is_planar();
        let rounds::Counted { count, points_mask } = if planar { rounds::Counted::default() } else { self.count_shown(light) };
        let color = if stencil { [0.0; 4] } else { [MID_GREY, MID_GREY, MID_GREY, 1.0] };
        self.clear_all(color, count.base);
        let budget = count.budget;
        self.draw_value(count);
        let whole = self.whole();
        if planar {
            self.push(self.planar_picture(stencil));
        } else if stencil {
            self.push(show::stencil_colors(budget, points_mask, whole));
        } else {
            self.push(show::copy(whole));
        }
    }

    fn draw_value(&mut self, count: LightCount) {
        let (whole, light, stencil) = (self.whole(), self.settings.light, self.settings.show == Show::Stencil);
        let stage = self.stage(Texturing::EachLight);
        let all: Vec<&SurfaceGroup> =
            stage.plain.iter().chain(&stage.grey).chain(stage.open.iter().map(|(group, _)| group)).collect();
        self.draw_solid();
        if stencil {
            self.extend(surfaces::ambient(all.iter().copied(), whole));
        } else {
            self.extend(all.iter().filter(|group| !group.is_laid()).map(|group| surfaces::lay(group, whole)).collect());
        }
        self.extend(count.steps);
        if self.is_planar() {
            self.planar_values(&all, stencil);
        } else if !stencil && let Some(scissor) = self.light_rect(light) {
            for group in &all {
                self.extend(surfaces::verdict(std::slice::from_ref(*group), light, scissor, count.budget));
            }
        }
        let color = if stencil { [0.0; 4] } else { [MID_GREY, MID_GREY, MID_GREY, 1.0] };
        let draw = |frame: &mut Self| {
            let count = if frame.is_planar() { LightCount::default() } else { frame.count(light) };
            frame.reset_view("reset the count", "This view counts from how many volumes hold its own eye.", count.base);
            frame.draw_value(count);
        };
        self.draw_children(&stage.open, draw, Cover::Value(color));
    }

    /// All bits but the mirrors', in the view's pixels.
    pub(super) fn reset_view(&mut self, label: &str, why: &str, value: u8) {
        if self.plan.budget.mirror_mask == 0 || self.outlook.view == 0 {
            self.clear(label.into(), why, Clear { color: None, depth: None, stencil: Some(value), counts: None });
        } else {
            self.push(mirrors::reset(label.into(), why, self.plan.budget, value, self.whole()));
        }
    }

    fn extend_grey(&mut self, groups: &[SurfaceGroup], steps: Vec<Step>) {
        // One step for each: a mirror is a group by itself.
        for (group, step) in groups.iter().zip(steps) {
            let steps = self.mirrors.grey(group, self.plan.exposure, vec![step]);
            self.extend(steps);
        }
    }

    fn extend_onto(&mut self, target: Target, steps: Vec<Step>) {
        for step in steps {
            self.push(onto(target, step));
        }
    }
}

fn onto(target: Target, step: Step) -> Step {
    Step { action: step.action.onto(target), ..step }
}
