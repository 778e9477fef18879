//! Mirrors drawn by the stencil (K section 3): the pixels of a mirror are tagged, all that is reflected is drawn there
//! anew, and then the mirror's own surface takes its place again.
//!
//! ```text
//!   tag      the mirror's visible pixels: same depth, their level in the mirror bits
//!   cover    depth back to infinity, and the background, there
//!   ...      the reflected world, with its own mirrors and shadows: a view like the eye's own
//!   uncover  the mirror's depth again, the bit turned back, the reflection dimmed and tinted
//!   own      what the mirror's surface looks like by itself, added
//! ```
//!
//! All depth tests of the reflected view start from infinity, so nothing has to be cleared but these pixels, and
//! outside them nothing changes. Depth after `uncover` is to the last bit what it was before `tag`, because the same
//! triangles are drawn by the same arithmetic.
//!
//! A mirror shows `R tint` of its reflection and `1 - R` of its own look; lights are added up linearly, so the two may
//! be drawn one after the other. Past the last bounce stands K's neutral grey for the reflection.

use std::collections::BTreeMap;

use glam::Vec3;

use super::surfaces::{SurfaceGroup, step};
use crate::frame::plan::{FramePlan, View};
use crate::frame::state::{Blend, Depth, State};
use crate::frame::stencil::{BitBudget, StencilState};
use crate::frame::{Action, Draw, DrawSet, Look, MirrorLook, Program, Step, Surface, Target};
use crate::scene::{Mirror, Pose, PosedMirror, Scene};
use crate::settings::{self, LastBounce};

/// The mirrors of a frame.
#[derive(Debug, Default)]
pub struct Mirrors {
    list: Vec<(Mirror, Option<PosedMirror>)>,
    by_surface: BTreeMap<(usize, usize), usize>,
    bounces: u32,
    last: LastBounce,
    fresnel: bool,
}

/// K's neutral grey, linear, as it comes out of the tone curve.
const GREY: f32 = 0.2;

impl Mirrors {
    /// The mirrors in force, where they are; and what a user should know of those that are none.
    #[must_use]
    pub fn new(scene: &Scene, pose: &Pose, settings: &settings::Mirrors) -> (Self, Vec<String>) {
        let (mirrors, mut notes) = scene.mirrors_in_force(settings);
        let mut placed = |mirror: &Mirror| {
            let posed = mirror.posed(scene, pose);
            posed.map_err(|why| notes.push(format!("{}: no mirror now: {why}", mirror.name))).ok()
        };
        let list: Vec<_> = mirrors.into_iter().map(|mirror| (placed(&mirror), mirror)).map(|(posed, it)| (it, posed)).collect();
        let there = list.iter().enumerate().filter(|(_, (_, posed))| posed.is_some());
        let by_surface = there.map(|(number, (mirror, _))| ((mirror.instance, mirror.primitive), number)).collect();
        let (bounces, last, fresnel) = (settings.most_bounces(), settings.last, settings.fresnel);
        (Self { list, by_surface, bounces, last, fresnel }, notes)
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.by_surface.len()
    }

    /// There are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.by_surface.is_empty()
    }

    /// How often a ray is reflected at most.
    #[must_use]
    pub fn bounces(&self) -> u32 {
        self.bounces
    }

    /// Those that are where they should be, with their numbers.
    pub fn posed(&self) -> impl Iterator<Item = (usize, &Mirror, &PosedMirror)> {
        self.list.iter().enumerate().filter_map(|(number, (mirror, posed))| Some((number, mirror, posed.as_ref()?)))
    }

    /// Where what a mirror shows begins: at itself, or for a portal at its other doorway.
    #[must_use]
    pub fn exit(&self, mirror: &Mirror) -> Surface {
        let other = self.list.iter().map(|(other, _)| other).find(|other| Some(other.node) == mirror.exit);
        let Mirror { instance, primitive, .. } = *other.unwrap_or(mirror);
        Surface { instance, primitive }
    }

    /// The number of the mirror that a surface is.
    #[must_use]
    pub fn of(&self, surface: Surface) -> Option<usize> {
        self.by_surface.get(&(surface.instance, surface.primitive)).copied()
    }

    /// How the shaders must see a surface that is this mirror.
    #[must_use]
    pub fn look(&self, mirror: Option<usize>) -> MirrorLook {
        match mirror {
            None => MirrorLook::None,
            Some(mirror) if self.fresnel && self.straight(mirror) < 1.0 => MirrorLook::Fresnel,
            Some(_) => MirrorLook::Even,
        }
    }

    /// Whether nothing but the reflection is seen of a mirror.
    #[must_use]
    pub fn is_perfect(&self, mirror: usize) -> bool {
        self.straight(mirror) >= 1.0
    }

    /// Whether every mirror shows its reflection and nothing else, just as it is.
    #[must_use]
    pub fn all_perfect(&self) -> bool {
        let clear = |(number, mirror, _): (usize, &Mirror, _)| self.is_perfect(number) && mirror.look.tint == Vec3::ONE;
        (self.last == LastBounce::Grey || self.bounces < 2) && self.posed().all(clear)
    }

    /// Looked at straight in.
    fn straight(&self, mirror: usize) -> f32 {
        self.list[mirror].0.look.reflectivity
    }

    fn tint(&self, mirror: usize) -> Vec3 {
        self.list[mirror].0.look.tint
    }

    /// How much of what a mirror reflects is left where `bounces` mirrors lie on the way, it being the last.
    fn left(&self, bounces: usize) -> f32 {
        match self.last {
            LastBounce::Grey => 1.0,
            #[expect(clippy::cast_precision_loss, reason = "eight at most")]
            LastBounce::Fade => 1.0 - (bounces - 1) as f32 / self.bounces.max(1) as f32,
        }
    }

    /// What a mirror's own look is drawn with: the grey that is mixed in, and the reflectance. `left` is how much of the
    /// reflection there is.
    fn constant(&self, mirror: usize, left: f32, exposure: f32) -> [f32; 4] {
        let grey = self.tint(mirror) * (GREY / exposure * (1.0 - left));
        grey.extend(self.straight(mirror)).to_array()
    }

    /// A mirror that has no view: its own look, and grey for the reflection; lays depth.
    #[must_use]
    pub fn grey(&self, group: &SurfaceGroup, exposure: f32, steps: Vec<Step>) -> Vec<Step> {
        with_constant(steps, group.kind.mirror.map_or([0.0; 4], |mirror| self.constant(mirror, 0.0, exposure)))
    }

    /// One light on a mirror's own surface, whose steps are `steps`.
    #[must_use]
    pub fn lit(&self, group: &SurfaceGroup, steps: Vec<Step>) -> Vec<Step> {
        with_constant(steps, group.kind.mirror.map_or([0.0; 4], |mirror| self.constant(mirror, 1.0, 1.0)))
    }

    /// The mirror's own look in ambient light, added to its reflection, which was seen by way of `bounces` mirrors; none
    /// where nothing of it is seen.
    #[must_use]
    pub fn own(&self, group: &SurfaceGroup, bounces: usize, exposure: f32, scissor: [u32; 4]) -> Option<Step> {
        let mirror = group.kind.mirror?;
        let left = self.left(bounces);
        if self.is_perfect(mirror) && left >= 1.0 {
            return None;
        }
        let draw = group.depth_draw(Depth::SAME_SURFACE, StencilState::IGNORE, scissor);
        let draw = Draw {
            program: Program::Own,
            look: Look { clipped: false, ..group.kind.look },
            constant: self.constant(mirror, left, exposure),
            state: State { color: Some(Blend::Add), ..draw.state },
            ..draw
        };
        let why = "Adds the mirror's own look in ambient light to what it reflects.";
        Some(step(format!("own look{}", group.words()), why, draw))
    }

    /// Tags the pixels in which a view sees the mirror `group`, for the view through it.
    #[must_use]
    pub fn tag(&self, group: &SurfaceGroup, plan: &FramePlan, child: usize) -> Step {
        let (from, to) = (parent(plan, child), &plan.views[child]);
        let stencil = StencilState::through_mirror(plan.budget, from.level(), to.level());
        let draw = Draw { stencil_reference: from.level(), ..group.depth_draw(Depth::SAME_SURFACE, stencil, to.rect) };
        let why = "Tags the pixels in which the mirror is seen: nothing of the reflection will leave them.";
        Step { view: parent_number(to), ..step(format!("tag {}", to.name), why, draw) }
    }

    /// The mirror's surface takes its place again: depth, the mirror bits, and how much of the reflection it shows.
    #[must_use]
    pub fn uncover(&self, group: &SurfaceGroup, plan: &FramePlan, child: usize, dims: bool) -> Step {
        let (from, to) = (parent(plan, child), &plan.views[child]);
        let stencil = StencilState::through_mirror(plan.budget, to.level(), from.level());
        let mut draw = Draw { stencil_reference: to.level(), ..group.depth_draw(Depth::OVERWRITE, stencil, to.rect) };
        let why = if dims && self.multiply(group, to, &mut draw) {
            "The mirror's depth and tag are as they were before; the reflection is multiplied with how much the mirror shows."
        } else {
            "The mirror's depth and tag are as they were before."
        };
        Step { view: parent_number(to), ..step(format!("untag {}", to.name), why, draw) }
    }

    /// The mirror's surface over a reflection that nothing bounds: how much of it the mirror shows.
    #[must_use]
    pub fn dim(&self, group: &SurfaceGroup, plan: &FramePlan, child: usize) -> Option<Step> {
        let to = &plan.views[child];
        let mut draw = group.depth_draw(Depth::SAME_SURFACE, StencilState::IGNORE, to.rect);
        let why = "Multiplies the reflection with how much of it the mirror shows.";
        self.multiply(group, to, &mut draw).then(|| step(format!("dim {}", to.name), why, draw))
    }

    /// The mirror's surface with the texture of what it reflects, as much of it as the mirror shows; lays depth.
    #[must_use]
    pub fn textured(&self, group: &SurfaceGroup, plan: &FramePlan, child: usize) -> Step {
        let (from, to) = (parent(plan, child), &plan.views[child]);
        let mut draw = group.depth_draw(Depth::LAY, StencilState::IGNORE, from.rect);
        draw.constant = Vec3::ONE.extend(1.0).to_array();
        self.multiply(group, to, &mut draw);
        draw.program = Program::Mirrored;
        draw.look = Look { clipped: group.kind.look.clipped, mirror: group.kind.look.mirror, ..Look::default() };
        draw.state.color = Some(Blend::Replace);
        let why = "The mirror's surface with its texture: each pixel finds what it reflects in the place where it lies itself.";
        step(format!("lay on {}", to.name), why, draw)
    }

    /// Makes a draw of the mirror's surface multiply the reflection with how much of it the mirror shows; false where
    /// that is all of it, just as it is.
    fn multiply(&self, group: &SurfaceGroup, to: &View, draw: &mut Draw) -> bool {
        let mirror = group.kind.mirror.unwrap_or_default();
        let left = self.left(to.path().len());
        if self.is_perfect(mirror) && self.tint(mirror) == Vec3::ONE && left >= 1.0 {
            return false;
        }
        draw.program = Program::Reflected;
        draw.look = Look { mirror: group.kind.look.mirror, ..Look::default() };
        draw.state.color = Some(Blend::Multiply);
        draw.constant = (self.tint(mirror) * left).extend(self.straight(mirror)).to_array();
        true
    }
}

/// What a view through a mirror starts from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cover {
    /// The gradient behind everything, as light.
    Light,
    /// The same in the picture's own colours.
    Finished,
    /// A display value.
    Value([f32; 4]),
}

/// Depth back to infinity, and the background, in the pixels of the view that is begun.
#[must_use]
pub fn cover(view: &View, cover: Cover) -> Step {
    let (program, target, constant) = match cover {
        Cover::Light => (Program::Backdrop, Target::Scene, [0.0; 4]),
        Cover::Finished => (Program::Background, Target::Direct, [0.0; 4]),
        Cover::Value(value) => (Program::Dark, Target::Scene, value),
    };
    let state = State { depth: Depth::OVERWRITE, color: Some(Blend::Replace), ..State::FLAT };
    let why = "Depth to infinity and the background, in the mirror's pixels: the reflection is drawn as if nothing were there.";
    let draw = Draw { target, state, constant, ..Draw::plain(program, DrawSet::FullScreen, view.rect) };
    Step::drawing(format!("begin {}", view.name), why, draw)
}

/// All bits but the mirrors' to one value, in the pixels of one view: what a clear would do to all of them.
#[must_use]
pub fn reset(label: String, why: &str, budget: BitBudget, value: u8, rect: [u32; 4]) -> Step {
    let state = State { stencil: StencilState::set_all(budget), ..State::FLAT };
    let draw = Draw::plain(Program::StencilOnly, DrawSet::FullScreen, rect);
    Step::drawing(label, why, Draw { state, stencil_reference: value, ..draw })
}

/// The step in one view only: its pixels, told by their mirror bits.
pub fn keep_in_view(step: &mut Step, view: usize, views: &[View], budget: BitBudget) {
    step.view = view;
    if let Action::Draw(draw) = &mut step.action
        && view > 0
        && budget.mirror_mask != 0
        && matches!(draw.target, Target::Scene | Target::Direct | Target::Counts)
    {
        let stencil = draw.state.stencil.in_view(budget);
        if stencil != draw.state.stencil {
            draw.stencil_reference |= views[view].level();
            draw.state.stencil = stencil;
        }
    }
}

/// A mirror past the last bounce, as `show views` has it: K's neutral grey, a display value.
pub const NO_VIEW: [f32; 4] = [0.5, 0.5, 0.5, 1.0];

/// A display colour for a path of mirrors: each mirror has a hue, each bounce turns it on and makes it paler.
#[must_use]
pub fn path_color(path: &[usize]) -> [f32; 3] {
    if path.is_empty() {
        return [0.78, 0.77, 0.74];
    }
    /// A turn by the golden section sets neighbours far apart.
    const GOLDEN: f32 = 0.618_034;
    #[expect(clippy::cast_precision_loss, reason = "a hue")]
    let turned = path.iter().enumerate().map(|(bounce, mirror)| (*mirror as f32 + 1.0) * GOLDEN * (1.0 + 0.37 * bounce as f32));
    let hue = turned.sum::<f32>().fract();
    #[expect(clippy::cast_precision_loss, reason = "eight bounces at most")]
    let depth = (path.len() - 1) as f32;
    let (saturation, value) = (0.72 * 0.86f32.powf(depth), 0.95 * 0.93f32.powf(depth));
    let channel = |offset: f32| {
        let at = ((hue + offset).fract() * 6.0 - 3.0).abs() - 1.0;
        value * (1.0 - saturation * (1.0 - at.clamp(0.0, 1.0)))
    };
    [channel(0.0), channel(2.0 / 3.0), channel(1.0 / 3.0)]
}

fn parent_number(view: &View) -> usize {
    view.through.as_ref().map_or(0, |window| window.parent)
}

fn parent(plan: &FramePlan, child: usize) -> &View {
    &plan.views[parent_number(&plan.views[child])]
}

fn with_constant(mut steps: Vec<Step>, constant: [f32; 4]) -> Vec<Step> {
    for step in &mut steps {
        if let Action::Draw(draw) = &mut step.action {
            draw.constant = constant;
        }
    }
    steps
}
