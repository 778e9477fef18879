//! Planar shadows (K sections 4, 5 and 6.3): casters thrown onto flat receivers by a matrix.
//!
//! What is thrown is a caster's light cap, the very triangles that its shadow volume would be thrown from, so that both
//! kinds of shadow have one outline. Where it lies before a receiver's plane decides whether it is thrown whole, cut,
//! or not at all ([`crate::geometry::planar_shadow`]).
//!
//! ```text
//!   naive            over everything, nearer by polygon offset, blended: where two triangles of a caster
//!                    lie over each other it is darker, and beyond the receiver's rim it hangs in mid-air
//!   stencil-blend    tag the receiver's visible pixels v; darken where v, which becomes 0: once, whatever casts, and
//!                    however many lights are blocked ("real shadows cannot leave an object doubly dark")
//!   stencil-relight  lit by all; where v: v + 1; draw the receiver anew in ambient light where v + 1, and add to
//!                    that each light that is not blocked there
//!   multi            unlit; light by light: where v: v + 1; add the light where v, which becomes v + 1; and for the
//!                    next light with v and v + 1 in each other's place
//!   hybrid           cut-outs by their volumes, counted; where v: the verdict bit; light where all that is zero
//! ```
//!
//! No depth test decides where a shadow falls: depth has decided already which of the receiver's pixels are seen. The
//! order of all this stands in `director/planar.rs`.

use std::collections::BTreeMap;

use glam::{DAffine3, DVec4};

use super::Caster;
use super::decals::Decals;
use super::surfaces::{SurfaceGroup, ambient_of};
use crate::frame::state::{Blend, Depth, DepthBias, State};
use crate::frame::stencil::{BitBudget, StencilOp, StencilState};
use crate::frame::{
    Action, Draw, DrawSet, Method, Part, Piece, Program, Projection, Reason, Step, Surface, VolumePart, VolumePlan,
};
use crate::geometry::pixels::Grid;
use crate::geometry::planar::height;
use crate::geometry::planar_shadow::{Lies, LitPlane, lies};
use crate::geometry::volume::Outline;
use crate::geometry::{Aabb, VolumeParts};
use crate::scene::{Pose, PosedReceiver, Receiver, Scene};
use crate::settings::{Backend, HybridPart, MirrorLight, Mirrors, Planar, PlanarMode, Settings, Show, Technique};

/// What is laid over shadows that are blended: half of what is there is left (K section 5).
const DARK: [f32; 4] = [0.0, 0.0, 0.0, 0.5];

/// K section 4's `glPolygonOffset(1, 2)`, and some more of the least steps: what is thrown is placed by another product of
/// matrices than the receiver, in single precision.
const LIFT: DepthBias = DepthBias { constant: 64, slope: 1 };

/// Receivers that are told apart beside shadow volumes, which need bits to count in, at a time.
const BESIDE_VOLUMES: usize = 7;

/// The settings that are planned: while planar shadows are drawn the technique counts nothing, but for the hybrid's
/// cut-outs; and they are not drawn where something else is shown, or made wrong on purpose.
#[must_use]
pub fn in_force(settings: &Settings) -> Settings {
    let shows = matches!(settings.show, Show::Final | Show::Volumes | Show::Wireframe | Show::Shadow | Show::Stencil);
    let mode = if shows && is_on(settings) { settings.planar.mode } else { PlanarMode::Off };
    let planar = Planar { mode, ..settings.planar.clone() };
    // A virtual light shines through its mirror's outline only, which nothing here would keep it to.
    let off = is_on(settings) && settings.mirrors.light == MirrorLight::Virtual;
    let light = if off { MirrorLight::Off } else { settings.mirrors.light };
    let mirrors = Mirrors { light, ..settings.mirrors.clone() };
    Settings { technique: technique(settings), planar, mirrors, ..settings.clone() }
}

/// Whether shadows are planar: a failure of the gallery is one of volumes.
#[must_use]
pub fn is_on(settings: &Settings) -> bool {
    settings.planar.mode != PlanarMode::Off && settings.failure.is_none()
}

/// What counts shadow volumes: the chosen technique, or what planar shadows leave of it.
#[must_use]
pub fn technique(settings: &Settings) -> Technique {
    match (settings.planar.mode, settings.planar.hybrid) {
        _ if !is_on(settings) => settings.technique,
        (PlanarMode::Hybrid, part) if part.has_volumes() => Technique::Cutout,
        _ => Technique::None,
    }
}

/// The receivers of a frame.
#[derive(Debug, Default)]
pub struct Receivers {
    list: Vec<(Receiver, PosedReceiver)>,
    by_surface: BTreeMap<(usize, usize), usize>,
}

/// A receiver that a view may see, and all that takes its shadows with it: the decals on it, and where they may lie on other
/// receivers in its plane as well, those. A shadow thrown onto one is a shadow on all.
#[derive(Debug)]
pub struct Stand {
    /// What it is called.
    pub name: String,
    /// The one surface that shadows are thrown onto.
    pub surface: Surface,
    /// Each by itself: decals from the topmost on, and then what they lie on. So each pixel is first met by what is seen there,
    /// where depths of one plane are the same by chance.
    pub groups: Vec<SurfaceGroup>,
    /// Where it is.
    pub posed: PosedReceiver,
}

impl Stand {
    /// Whether a mirror is among it.
    #[must_use]
    pub fn reflects(&self) -> bool {
        self.groups.iter().any(|group| group.mirror().is_some())
    }

    /// Whether any of it is among the instances that something reaches.
    #[must_use]
    pub fn is_among(&self, reached: &[bool]) -> bool {
        self.groups.iter().flat_map(|group| &group.surfaces).any(|surface| reached[surface.instance])
    }
}

impl Receivers {
    /// The receivers in force, where they are; and what a user should know of those that are none.
    #[must_use]
    pub fn new(scene: &Scene, pose: &Pose, settings: &Planar) -> (Self, Vec<String>) {
        if settings.mode == PlanarMode::Off {
            return (Self::default(), Vec::new());
        }
        let (receivers, mut notes) = scene.receivers_in_force(settings);
        let mut list = Vec::new();
        for receiver in receivers {
            match receiver.posed(scene, pose) {
                Ok(posed) => list.push((receiver, posed)),
                Err(why) => notes.push(format!("{}: no receiver now: {why}", receiver.name)),
            }
        }
        if list.is_empty() {
            notes.push("nothing takes planar shadows here: mark a flat surface (--receiver, or a click)".into());
        }
        let place = |(number, (receiver, _)): (usize, &(Receiver, _))| ((receiver.instance, receiver.primitive), number);
        let by_surface = list.iter().enumerate().map(place).collect();
        (Self { list, by_surface }, notes)
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// There are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Whether a surface is one.
    #[must_use]
    pub fn holds(&self, surface: Surface) -> bool {
        self.by_surface.contains_key(&(surface.instance, surface.primitive))
    }

    /// The receivers among a view's surfaces, each by itself but for what shares `decals`, and all that are none.
    #[must_use]
    pub fn apart(&self, groups: &[&SurfaceGroup], decals: &Decals) -> (Vec<Stand>, Vec<SurfaceGroup>) {
        let (mut stands, mut others): (Vec<Stand>, Vec<SurfaceGroup>) = (Vec::new(), Vec::new());
        let single = |group: &SurfaceGroup, surface| SurfaceGroup { kind: group.kind, surfaces: vec![surface].into() };
        let grounds: Vec<_> = groups.iter().filter_map(|group| group.claims()).collect();
        let shared = |a, b| grounds.iter().any(|&ground| decals.lies_in(ground, a) && decals.lies_in(ground, b));
        for group in groups.iter().filter(|group| group.claims().is_none()) {
            let (receiving, rest): (Vec<Surface>, Vec<Surface>) =
                group.surfaces.iter().partition(|surface| self.holds(**surface));
            for surface in receiving {
                let Some(&number) = self.by_surface.get(&(surface.instance, surface.primitive)) else { continue };
                let (receiver, posed) = &self.list[number];
                match stands.iter_mut().find(|stand| shared(stand.surface, surface)) {
                    Some(stand) => stand.groups.push(single(group, surface)),
                    None => {
                        let (name, groups) = (receiver.name.clone(), vec![single(group, surface)]);
                        stands.push(Stand { name, surface, groups, posed: *posed });
                    }
                }
            }
            if !rest.is_empty() {
                others.push(SurfaceGroup { kind: group.kind, surfaces: rest.into() });
            }
        }
        // What claims its pixels stands before what it lies on.
        for group in groups.iter().rev() {
            let Some(ground) = group.claims() else { continue };
            match stands.iter_mut().find(|stand| decals.lies_in(ground, stand.surface)) {
                Some(stand) => _ = stand.groups.splice(0..0, group.surfaces.iter().map(|&surface| single(group, surface))),
                None => others.insert(0, SurfaceGroup { kind: group.kind, surfaces: group.surfaces.clone() }),
            }
        }
        (stands, others)
    }
}

/// The bits that a mode takes of what a frame has.
#[must_use]
pub fn budget(mode: PlanarMode, part: HybridPart, receivers: usize, budget: BitBudget) -> BitBudget {
    let bits = budget.low_bits();
    match mode {
        _ if receivers == 0 => budget,
        PlanarMode::Hybrid if part.has_planar() => {
            let told = receivers.min(BESIDE_VOLUMES);
            // The verdict bit and a bit to count in are the least.
            let tags = (usize::BITS - told.leading_zeros()).min(bits.saturating_sub(2)).max(1);
            budget.with_receivers(bits - tags, tags).batched()
        }
        PlanarMode::Off | PlanarMode::Naive | PlanarMode::Hybrid => budget,
        PlanarMode::StencilBlend | PlanarMode::Multi => budget.with_receivers(1, bits - 1),
        PlanarMode::StencilRelight => budget.with_receivers(2, bits - 2),
    }
}

/// What of a caster before a light planar shadows ask.
#[derive(Debug, Clone, Copy)]
pub struct Thrower {
    instance: usize,
    /// Metres, object space.
    bounds: Aabb,
    world_from_object: DAffine3,
    solid: bool,
    /// It lies on one plane, and the hybrid counts its volume.
    pub cut_out: bool,
    /// Why its shadow matters to nothing.
    dropped: Option<Reason>,
    /// The pixels where it may matter.
    rect: [u32; 4],
}

impl Thrower {
    /// Of a caster. Where shadows hang in mid-air (`everywhere`) all in view matters.
    #[must_use]
    pub fn new(caster: &Caster<'_>, everywhere: bool, whole: [u32; 4]) -> Self {
        let dropped = caster.sight.dropped.filter(|reason| !everywhere || *reason == Reason::OutOfRange);
        Self {
            instance: caster.instance,
            bounds: caster.pose.bounds(caster.scene, caster.node_index),
            world_from_object: caster.pose.world_from_object[caster.node_index],
            solid: caster.mesh.topology.report().is_solid(),
            cut_out: is_cut_out(caster),
            dropped,
            rect: if everywhere { whole } else { caster.sight.rect },
        }
    }

    /// How it is thrown onto a receiver by a light, for the view of that number.
    #[must_use]
    pub fn throw(&self, onto: Option<LitPlane>, receiver: Surface, (number, light): (usize, DVec4), view: usize) -> VolumePlan {
        let of = |onto: LitPlane| {
            let corners = self.bounds.corners().map(|corner| height(onto.plane, self.world_from_object.transform_point3(corner)));
            let heights = [corners.iter().copied().fold(f64::INFINITY, f64::min), corners.into_iter().fold(f64::MIN, f64::max)];
            let (method, reason, cut) = match lies(&onto, light, heights, self.solid) {
                Lies::Between => (Method::Projected, Reason::OverReceiver, false),
                Lies::Across => (Method::Projected, Reason::AcrossReceiver, true),
                Lies::Behind => (Method::Dropped, Reason::BehindReceiver, false),
                Lies::Beyond => (Method::Dropped, Reason::BeyondLight, false),
            };
            (method, reason, Some(Projection { receiver, onto, cut }))
        };
        let decided = match (self.dropped, onto) {
            (Some(reason), _) => (Method::Dropped, reason, None),
            (None, None) => (Method::Dropped, Reason::LightInReceiver, None),
            (None, Some(onto)) => of(onto),
        };
        let (method, reason, projection) = decided;
        VolumePlan {
            view,
            instance: self.instance,
            light: number,
            method,
            reason,
            case: None,
            parts: VolumeParts { light_cap: true, ..VolumeParts::NONE },
            rect: self.rect,
            cells: Grid::ALL,
            holds_eye: 0,
            outline: Outline::Silhouette,
            extrusion: None,
            end: None,
            start: None,
            closed: false,
            piece: Piece::Whole,
            reflected: None,
            cutout: None,
            turns: false,
            // Both sides are drawn: what faces the light has been decided.
            winding: State::FLAT.winding,
            projection: projection.filter(|_| method == Method::Projected),
            silhouette: Backend::Cpu,
            flaw: None,
        }
    }
}

/// Whether the hybrid counts a caster's volume: what lies on one plane is its own cut-out.
#[must_use]
pub fn is_cut_out(caster: &Caster<'_>) -> bool {
    let topology = &caster.mesh.topology;
    match &caster.pose.deformed[caster.node_index] {
        Some(deformed) => topology.plane_of(&deformed.positions).is_some(),
        None => topology.plane().is_some(),
    }
}

/// What a planar shadow does to the pixels it falls on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Leaves {
    /// Darkens them, wherever they are.
    Dark,
    /// Draws them in a display value, wherever they are.
    Value([f32; 4]),
    /// Darkens those that hold the value, which then hold none.
    DarkOnce(u8),
    /// Those that hold the value hold the next, or the one before.
    Next(u8, StencilOp),
    /// Those that hold the receiver's value are in shadow.
    Verdict(u8),
}

/// Casters thrown onto one receiver.
#[must_use]
pub fn shadow(stand: &Stand, light: usize, parts: Vec<VolumePart>, leaves: Leaves, budget: BitBudget, scissor: [u32; 4]) -> Step {
    let lifted = State { depth: Depth::ON_OR_NEARER.with_bias(LIFT), ..State::FLAT };
    let marked = |stencil| State { stencil, ..State::FLAT };
    let (state, reference, constant, why) = match leaves {
        Leaves::Dark => (
            State { color: Some(Blend::Over), ..lifted },
            0,
            DARK,
            "Casters thrown onto the receiver's plane, nearer by the polygon offset: they darken whatever they cover.",
        ),
        Leaves::Value(value) => (
            State { color: Some(Blend::Replace), ..lifted },
            0,
            value,
            "Casters thrown onto the receiver's plane, nearer by the polygon offset: whatever they cover is in shadow.",
        ),
        Leaves::DarkOnce(value) => (
            State { color: Some(Blend::Over), ..marked(StencilState::move_on(budget, StencilOp::Zero)) },
            value,
            DARK,
            "Darkens the receiver's pixels that lie in a shadow, each once: its value is gone then.",
        ),
        Leaves::Next(value, step) => (
            marked(StencilState::move_on(budget, step)),
            value,
            [0.0; 4],
            "Casters thrown onto the receiver's plane: of its visible pixels, each that lies in a shadow is marked, once.",
        ),
        Leaves::Verdict(value) => (
            marked(StencilState::shadow_receiver(budget)),
            value | budget.verdict_mask,
            [0.0; 4],
            "Casters that are no cut-outs, thrown onto the receiver's plane: its visible pixels there are in shadow.",
        ),
    };
    let draw = Draw {
        state,
        stencil_reference: reference,
        light: Some(light),
        constant,
        ..Draw::plain(Program::Projected, DrawSet::Volumes(parts.into()), scissor)
    };
    Step::drawing(format!("light {light}: shadows onto {}", stand.name), why, draw)
}

/// The parts of a planar shadow: the light cap, all of it.
#[must_use]
pub fn parts(volume: usize) -> [VolumePart; 2] {
    [Part::LightCapKept, Part::LightCapTurned].map(|part| VolumePart::whole(volume, part))
}

/// A receiver's visible pixels get its value, and so do those of the decals on it.
#[must_use]
pub fn tag(stand: &Stand, budget: BitBudget, value: u8, scissor: [u32; 4]) -> Vec<Step> {
    let of_group = |group: &SurfaceGroup| {
        let draw = group.depth_draw(Depth::SAME_SURFACE, StencilState::tag_receiver(budget, value), scissor);
        let (words, why) = if group.claims().is_some() {
            (": decal", "Where a decal is seen on the receiver it takes the shadows that fall there.")
        } else {
            ("", "The receiver's visible pixels get a value that no other surface has: no shadow will leave them.")
        };
        Step::drawing(format!("tag {}{words}", stand.name), why, draw)
    };
    stand.groups.iter().map(of_group).collect()
}

/// No pixel is a receiver's any more.
#[must_use]
pub fn forget(budget: BitBudget, scissor: [u32; 4]) -> Step {
    let state = State { stencil: StencilState::forget_receivers(budget), ..State::FLAT };
    let why = "There are more receivers than values: those that are done make room.";
    Step::drawing("forget receivers", why, Draw { state, ..Draw::plain(Program::StencilOnly, DrawSet::FullScreen, scissor) })
}

/// The same steps where the stencil holds `value`.
#[must_use]
pub fn where_value(mut steps: Vec<Step>, value: u8) -> Vec<Step> {
    for step in &mut steps {
        if let Action::Draw(draw) = &mut step.action {
            draw.stencil_reference = value;
        }
    }
    steps
}

/// A receiver in ambient and emitted light alone, in the place of all that was added to it.
#[must_use]
pub fn relit(stand: &Stand, stencil: StencilState, value: u8, scissor: [u32; 4]) -> Vec<Step> {
    let again = |group: &SurfaceGroup| {
        let step = ambient_of(group, scissor);
        let Action::Draw(mut draw) = step.action else { return step };
        draw.state = State { depth: Depth::SAME_SURFACE.with_bias(draw.state.depth.bias), stencil, ..draw.state };
        draw.look.clipped = false;
        draw.stencil_reference = value;
        let why = "Shadowed pixels drawn anew with the blocked light switched off, instead of being darkened.";
        Step { action: Action::Draw(draw), label: format!("relight {}", stand.name), why: why.into(), ..step }
    };
    let steps = stand.groups.iter().map(again);
    // What is seen in a pixel must have the last word there, or the only one.
    if stencil.writes() { steps.collect() } else { steps.rev().collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Failure;

    #[test]
    fn planar_shadows_take_the_techniques_place() {
        let settings = |mode, hybrid| Settings { planar: Planar { mode, hybrid, ..Planar::default() }, ..Settings::default() };
        for mode in PlanarMode::ALL {
            for part in HybridPart::ALL {
                let expected = match (mode, part) {
                    (PlanarMode::Off, _) => Technique::default(),
                    (PlanarMode::Hybrid, HybridPart::Both | HybridPart::Volumes) => Technique::Cutout,
                    _ => Technique::None,
                };
                assert_eq!(in_force(&settings(mode, part)).technique, expected, "{mode:?} {part:?}");
            }
        }
        let multi = settings(PlanarMode::Multi, HybridPart::Both);
        let failing = in_force(&Settings { failure: Some(Failure::NearPlane), ..multi.clone() });
        assert_eq!((failing.planar.mode, failing.technique), (PlanarMode::Off, Technique::default()), "a failure is of volumes");
        let cases = in_force(&Settings { show: Show::Cases, ..multi });
        assert_eq!((cases.planar.mode, cases.technique), (PlanarMode::Off, Technique::None));
    }

    #[test]
    fn every_mode_has_the_bits_it_needs_however_many_mirrors_there_are() {
        for mirrors in [0, 1, 8] {
            let whole = BitBudget::default().with_mirrors(mirrors);
            for receivers in [1, 2, 3, 40] {
                for mode in [PlanarMode::StencilBlend, PlanarMode::StencilRelight, PlanarMode::Multi, PlanarMode::Hybrid] {
                    let budget = budget(mode, HybridPart::Both, receivers, whole);
                    assert!(budget.receivers() >= 1, "{mode:?} {mirrors} {receivers}");
                    let masks = [budget.mirror_mask, budget.receiver_mask, budget.verdict_mask, budget.count_mask];
                    assert_eq!(
                        masks.iter().map(|mask| mask.count_ones()).sum::<u32>(),
                        masks.iter().fold(0, |a, b| a | b).count_ones()
                    );
                    assert!(budget.count_mask != 0 && (mode == PlanarMode::Hybrid) == (budget.verdict_mask != 0));
                }
                assert_eq!(budget(PlanarMode::Naive, HybridPart::Both, receivers, whole), whole);
                assert_eq!(budget(PlanarMode::Hybrid, HybridPart::Volumes, receivers, whole), whole);
            }
        }
    }
}
