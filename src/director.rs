//! THE pass order: one function that reads aloud as the frame.
//!
//! [`plan`] is the only place where the order of passes is written. It calls each technique for
//! its steps, in order, and the result is plain data ([`FramePlan`]); [`stage`] adds what comes
//! before (pose, camera) and after (validation), for the window and the headless commands alike.

mod casters;
mod decals;
mod deferred;
mod diagrams;
mod direct;
mod dissolve;
mod halos;
mod off_mirrors;
mod planar;
mod reflections;
mod rounds;
mod shown;
mod silhouettes;
mod solids;
mod stage;
mod views;

pub use stage::{Planner, StageError, frames, stage, stage_changed, stage_frame};

use crate::director::views::Outlook;
use crate::frame::plan::View;
use crate::frame::stencil::{BitBudget, StencilState};
use crate::frame::{Action, Camera, Capabilities, Clear, FramePlan, Gather, Reflections, Step, Target};
use crate::geometry::Enclosure;
use crate::geometry::sight::Sight;
use crate::scene::{Pose, Scene};
use crate::settings::{Accumulation, Settings, Show, Technique, Texturing};
use crate::techniques::cases::{self, Class};
use crate::techniques::culling::Interest;
use crate::techniques::decals::Decals;
use crate::techniques::labels::Named;
use crate::techniques::mirrors::{self, Mirrors};
use crate::techniques::own_bits::{Round, Shining};
use crate::techniques::planar::Receivers;
use crate::techniques::surfaces::Known;
use crate::techniques::workspace::{Lent, Workspace};
use crate::techniques::{self, bounds, depth_bounds, playground, show, surfaces, wide};

/// The frame, in order: ambient light and depth; then light by light, volumes into the stencil and
/// light where the count is zero; then what is blended, what is shown of the inner works, and the
/// picture. A frame of one light at most goes a shorter way: depth, volumes, and each surface once.
///
/// It is planned in the workspace's memory, and in that of a plan that nobody needs any more.
#[must_use]
pub fn plan(
    settings: &Settings,
    scene: &Scene,
    pose: &Pose,
    camera: Camera,
    capabilities: &Capabilities,
    gather: Option<Gather>,
    memory: (&Workspace, FramePlan),
) -> FramePlan {
    let mut frame = Frame::new(settings, (scene, pose), camera, capabilities, memory);
    frame.plan.gather = gather;
    let whole = frame.whole();
    if settings.show == Show::Playground {
        frame.extend(playground::steps(&settings.playground, settings.size, whole));
        return frame.plan;
    }
    if frame.plan.views.len() > 1 || matches!(settings.show, Show::Surfaces | Show::Views | Show::Birdseye) {
        if !frame.draw_reflections() {
            frame.finish();
        }
        return frame.plan;
    }
    let groups = surfaces::opaque_groups(frame.known(), frame.view(), frame.plan.size, frame.texturing());

    match settings.show {
        Show::Stencil | Show::Shadow if frame.is_planar() => frame.show_planar(&groups, settings.show == Show::Stencil),
        Show::Stencil | Show::Shadow => {
            let rounds::Counted { count, points_mask } = frame.count_shown(settings.light);
            let shows_stencil = settings.show == Show::Stencil;
            frame.clear_all([0.0; 4], count.base);
            frame.draw_solid();
            frame.extend(surfaces::ambient(&groups, whole));
            if !shows_stencil {
                frame.clear_color([MID_GREY, MID_GREY, MID_GREY, 1.0]);
            }
            frame.extend(count.steps);
            if shows_stencil {
                frame.push(show::stencil_colors(count.budget, points_mask, whole));
            } else {
                let scissor = frame.light_rect(settings.light);
                if let Some(scissor) = scissor {
                    frame.extend(surfaces::verdict(&groups, settings.light, scissor, count.budget));
                }
                frame.push(show::copy(whole));
            }
        }
        Show::Overflow => {
            let count = frame.count_by(techniques::row(Technique::Wide), settings.light);
            frame.clear_all([0.0; 4], count.base);
            frame.draw_solid();
            frame.extend(surfaces::ambient(&groups, whole));
            if !count.steps.is_empty() {
                frame.extend(count.steps);
                let step = wide::overflow_colors(&frame.ask(settings.light, whole));
                frame.push(step);
            }
            frame.push(show::copy(whole));
        }
        Show::Cases => {
            frame.plan_casters(settings.light);
            let classes = frame.classes(settings.light);
            frame.clear_all(cases::BACKGROUND, 0);
            frame.draw_solid();
            frame.extend(cases::steps(scene, &groups, &classes, Class::color, whole));
            frame.extend(cases::glass(frame.known(), frame.view(), whole));
            frame.push(show::copy(whole));
            frame.label(Target::Output);
        }
        Show::Bounds => {
            frame.plan_casters(settings.light);
            let (classes, scissor) = (frame.classes(settings.light), frame.light_rect(settings.light));
            let (eye, above) = frame.rise();
            let groups = surfaces::opaque_groups(frame.known(), frame.view(), frame.plan.size, Texturing::EachLight);
            frame.clear_all(cases::BACKGROUND, 0);
            frame.draw_solid();
            frame.extend(cases::steps(scene, &groups, &classes, bounds::color_of, whole));
            if above.cut.is_some() {
                frame.extend(bounds::cut(&groups, whole));
            }
            frame.extend(bounds::glass(&frame.plan.volumes, settings.light, whole));
            frame.push(show::copy(whole));
            frame.draw_bounds(&eye, &above, scissor);
            let named = Named { casters: settings.lighting.labels, eye: Some(eye.eye) };
            // The near plane may cut lamps off; their names stay.
            frame.name(named, Camera { near: 0.0, ..above.camera }, Target::Output);
        }
        Show::Complexity => frame.draw_complexity(&groups),
        Show::Rays => frame.draw_diagram(),
        Show::Final | Show::Volumes | Show::Wireframe => {
            let darkens = techniques::row(settings.technique).darkens;
            let mut rounds = if frame.is_planar() { Vec::new() } else { frame.rounds() };
            let transparent = surfaces::transparent(frame.known(), frame.view(), whole);
            let one_light = rounds.iter().map(|round| round.lights.len()).sum::<usize>() <= 1;
            let in_turn = darkens.is_none() && !frame.is_planar();
            let direct = in_turn && transparent.is_empty() && frame.may_draw_directly();
            if frame.defers(&rounds, &groups, direct) {
                frame.draw_deferred(rounds, &groups);
                frame.label(Target::Direct);
                return frame.plan;
            }
            if one_light && direct {
                frame.draw_directly(rounds.pop(), &groups);
                frame.label(Target::Direct);
                return frame.plan;
            }
            let lights: Vec<_> = rounds.iter().flat_map(|round| &round.lights).map(|shining| shining.light).collect();
            frame.start(rounds.first().map_or(0, |round| round.base));
            frame.draw_solid();
            frame.extend(surfaces::ambient(&groups, whole));
            let all: Vec<_> = groups.iter().collect();
            frame.lay_decals(&all);
            if frame.is_planar() {
                frame.shine_planar(&all);
            }
            for round in rounds {
                frame.start_round(&round);
                frame.extend(round.steps);
                for Shining { light, rect, budget } in round.lights {
                    let once = budget.map_or_else(|| frame.unused_bit(Some(light)), StencilState::light_once);
                    let reached = frame.reached(light);
                    frame.extend(surfaces::lit(&groups, light, (&pose.lights[light]).into(), rect, once, &reached));
                }
            }
            if surfaces::textured_last(&groups) {
                let once = frame.unused_bit(None);
                frame.extend(surfaces::textures(&groups, once, whole));
            }
            if let Some(color) = darkens {
                frame.start_round(&Round::default());
                for light in lights {
                    frame.darken(light, color);
                }
            }
            frame.blend_decals(&all);
            frame.extend(transparent);
            frame.draw_halos();
            frame.finish();
        }
        Show::Surfaces | Show::Views | Show::Birdseye | Show::Playground => {}
    }
    frame.plan
}

/// What `show shadow` draws where a light has no say: exactly 128 of 255 in the picture.
const MID_GREY: f32 = 128.0 / 255.0;

/// A plan in the making, and what its steps are made from.
struct Frame<'a> {
    settings: &'a Settings,
    scene: &'a Scene,
    pose: &'a Pose,
    capabilities: &'a Capabilities,
    /// The view whose steps are planned.
    outlook: Outlook<'a>,
    /// What each view sees, where there are mirrors.
    sights: Vec<Sight>,
    mirrors: Mirrors,
    decals: Decals,
    /// Of each instance, whether it has a halo.
    glowing: Lent<'a, bool>,
    /// Where lists are made.
    workspace: &'a Workspace,
    receivers: Receivers,
    /// What the stencil was cleared to last, and which bits are no longer so.
    stored: u8,
    used: u8,
    plan: FramePlan,
}

impl<'a> Frame<'a> {
    fn new(
        settings: &'a Settings,
        (scene, pose): (&'a Scene, &'a Pose),
        camera: Camera,
        capabilities: &'a Capabilities,
        (workspace, before): (&'a Workspace, FramePlan),
    ) -> Self {
        let exact_values = matches!(
            settings.show,
            Show::Shadow
                | Show::Stencil
                | Show::Overflow
                | Show::Surfaces
                | Show::Views
                | Show::Birdseye
                | Show::Complexity
                | Show::Playground
        );
        let reads_samples = settings.technique == Technique::Wide || scene.solid.is_some();
        let each_sample = !reads_samples || capabilities.wide_four_samples;
        let dissolves = dissolve::wanted(settings);
        let samples = if exact_values || dissolves || !capabilities.four_samples || !each_sample { 1 } else { settings.samples };
        let FramePlan { mut notes, mut views, mut points, volumes, steps, .. } = before.emptied();
        notes.extend(capabilities.lacks().iter().map(|lack| format!("no {}: {}", lack.feature, lack.instead)));
        if dissolves && settings.samples != 1 {
            notes.push("what dissolves does so by whole pixels: 1 sample a pixel".into());
        }
        if exact_values && settings.samples != 1 {
            notes.push(format!("{} shows exact values: 1 sample a pixel", settings.show.name()));
        }
        if let Some(far) = camera.far {
            notes.push(format!("the far plane at {far} m cuts volumes off: what is counted from infinity goes wrong"));
        }
        if !each_sample && settings.samples != 1 {
            notes.push("this device counts wide, and puts solids together, with 1 sample a pixel only".into());
        }
        views.push(View::of_eye("eye", camera, settings.size));
        points.extend(pose.lights.iter().map(|light| light.of));
        let plan = FramePlan {
            size: settings.size,
            samples,
            exposure: scene.exposure * settings.exposure.exp2(),
            smooth_terminator: settings.smooth_terminator,
            budget: BitBudget::of_bits(settings.counting.bits),
            views,
            volumes,
            steps,
            accumulation: settings.lighting.accumulation,
            gather: None,
            points,
            notes,
            reflections: Reflections::default(),
            breaks: None,
            then: None,
        };
        let outlook = Outlook::new((scene, pose), (0, &plan.views[0]), None, workspace);
        let (sights, mirrors, receivers) = (Vec::new(), Mirrors::default(), Receivers::default());
        let mut glowing = workspace.flags.lend();
        scene.find_glowing(&settings.halos.edits, &mut glowing);
        let mut frame = Self {
            settings,
            scene,
            pose,
            capabilities,
            outlook,
            sights,
            mirrors,
            receivers,
            glowing,
            workspace,
            decals: Decals::default(),
            stored: 0,
            used: 0,
            plan,
        };
        frame.note_solid();
        frame.plan_views();
        frame.plan_receivers();
        frame.choose_bits();
        frame.choose_decals();
        frame
    }

    /// One bit less to count in where lights' bounds are marked.
    fn choose_bits(&mut self) {
        if matches!(self.settings.show, Show::Complexity | Show::Playground) {
            // Counting is clamped, and clamping knows no fields; and who plays has all of it.
            self.plan.budget = BitBudget::default();
            return;
        }
        if self.has_halos() {
            self.plan.budget = self.plan.budget.with_halos();
        }
        if !self.settings.culling.depth_bounds || techniques::row(self.settings.technique).darkens.is_some() {
            return;
        }
        if self.is_planar() {
            self.plan.notes.push("no depth bounds here: shadows are planar".into());
            return;
        }
        if self.plan.budget.mirror_mask != 0 {
            self.plan.notes.push("no depth bounds here: mirrors have taken bits of the stencil".into());
            return;
        }
        let lights = &self.pose.lights;
        let marked = (0..lights.len()).any(|light| lights[light].on && lights[light].shadows && self.solid(light).is_some());
        if marked {
            self.plan.budget = self.plan.budget.with_bounds();
            let bits = self.plan.budget.count_mask.count_ones();
            self.plan.notes.push(format!("depth bounds take a bit of the stencil: {bits} are left to count in"));
        } else {
            self.plan.notes.push("no light has depth bounds here: none has an end that could be marked".into());
        }
    }

    /// What bounds a light in depth.
    fn solid(&self, light: usize) -> Option<Enclosure> {
        let bounds = self.settings.culling.light_bounds;
        let interest = match self.settings.show {
            // The stencil is shown with its mark.
            Show::Stencil => Interest::InRange,
            show => show.into(),
        };
        depth_bounds::enclosure(&self.pose.lights[light], bounds, interest, &self.view().camera)
    }

    /// The view's pixels.
    fn whole(&self) -> [u32; 4] {
        self.view().rect
    }

    /// Whether the settings leave nothing to accumulate but light.
    fn may_draw_directly(&self) -> bool {
        if self.dissolves() {
            return false;
        }
        let plan = &self.plan;
        let in_floats = plan.accumulation == Accumulation::Float;
        let textured = self.texturing() == Texturing::EachLight;
        self.settings.show == Show::Final
            && plan.samples == 1
            && plan.gather.is_none()
            && in_floats
            && textured
            && !self.has_halos()
            && self.scene.solid.is_none()
            && !self.decals.claim()
    }

    /// How often surfaces are textured: exact values have no light to be multiplied.
    fn texturing(&self) -> Texturing {
        let exact_values = matches!(self.settings.show, Show::Shadow | Show::Stencil);
        if exact_values { Texturing::EachLight } else { self.settings.lighting.texturing }
    }

    /// What surfaces are grouped by.
    fn known(&self) -> Known<'_> {
        Known {
            scene: self.scene,
            pose: self.pose,
            mirrors: &self.mirrors,
            decals: &self.decals,
            places: &self.outlook.places,
            workspace: self.workspace,
        }
    }

    /// The steps from the sum of all light to the picture.
    fn finish(&mut self) {
        let whole = self.whole();
        match self.settings.show {
            Show::Volumes => {
                self.plan_glass(self.settings.light);
                self.extend(show::volumes(&self.plan.volumes, self.settings.light, whole));
            }
            Show::Wireframe => self.push(show::wireframe(self.scene.instances().count(), whole)),
            _ => {}
        }
        if let Some(gather) = self.plan.gather {
            self.push(show::gather(gather, whole));
        }
        self.push(show::tone_map(whole));
        self.label(Target::Output);
    }

    fn push(&mut self, mut step: Step) {
        mirrors::keep_in_view(&mut step, self.outlook.view, &self.plan.views, self.plan.budget);
        self.plan.steps.push(step);
    }

    fn extend(&mut self, steps: Vec<Step>) {
        for step in steps {
            self.push(step);
        }
    }

    fn clear(&mut self, label: String, why: &str, clear: Clear) {
        self.push(Step { label, why: why.into(), view: 0, action: Action::Clear(clear) });
    }

    fn clear_all(&mut self, color: [f32; 4], stencil: u8) {
        let why =
            "Depth to infinity (0, reverse-Z), the stencil to how many volumes of the light that is counted first hold the eye.";
        self.clear("clear".into(), why, Clear { color: Some(color), depth: Some(0.0), stencil: Some(stencil), counts: None });
    }

    fn clear_color(&mut self, color: [f32; 4]) {
        let why = "Depth is laid; colour starts at the grey that means neither lit nor in shadow.";
        self.clear("clear colour".into(), why, Clear { color: Some(color), depth: None, stencil: None, counts: None });
    }
}
