//! Steps that draw the scene's surfaces: ambient light, one light, blended ones, a light's verdict.
//!
//! They are drawn in [groups](SurfaceGroup) of one state.

mod groups;

pub(super) use groups::{Kind, described};
pub use groups::{Known, MATT, Place, SurfaceGroup, opaque_groups, solid_group};

use crate::frame::plan::View;
use crate::frame::state::{Blend, Cull, Depth, NearPlane, State};
use crate::frame::stencil::{BitBudget, StencilState};
use crate::frame::{Action, Draw, DrawSet, LightShape, List, Look, Program, Step, Surface, Target};
use crate::scene::AlphaMode;
use crate::techniques::workspace::Reached;

pub(super) fn step(label: String, why: &str, draw: Draw) -> Step {
    Step { label, why: why.into(), view: 0, action: Action::Draw(Box::new(draw)) }
}

/// Ambient and emitted light; lays the depth that everything after is tested against.
#[must_use]
pub fn ambient<'a>(groups: impl IntoIterator<Item = &'a SurfaceGroup>, scissor: [u32; 4]) -> Vec<Step> {
    let plain = groups.into_iter().filter(|group| group.claims().is_none());
    plain.map(|group| ambient_of(group, scissor)).collect()
}

/// The same of one group, also where it claims its pixels.
#[must_use]
pub fn ambient_of(group: &SurfaceGroup, scissor: [u32; 4]) -> Step {
    let draw = Draw {
        program: if group.kind.masked { Program::AmbientMasked } else { Program::Ambient },
        look: group.kind.look,
        target: Target::Scene,
        state: State {
            depth: group.first_depth(),
            stencil: StencilState::IGNORE,
            color: Some(Blend::Replace),
            cull: group.kind.cull,
            winding: group.kind.winding,
            near_plane: NearPlane::Clip,
        },
        stencil_reference: 0,
        scissor,
        light: None,
        constant: [0.0; 4],
        set: DrawSet::Surfaces(group.surfaces.clone()),
    };
    let why = "Draws every surface in ambient and emitted light and lays the depth that all later steps are tested against.";
    step(format!("ambient{}", group.words()), why, draw)
}

/// Depth alone, of every surface that does not lay it when it is [`finished`]: those do where nothing is
/// counted (not `shadowed`) and nothing masked.
#[must_use]
pub fn depth<'a>(groups: impl IntoIterator<Item = &'a SurfaceGroup>, shadowed: bool, scissor: [u32; 4]) -> Vec<Step> {
    let first = groups.into_iter().filter(|group| !group.lays_depth_when_finished(shadowed));
    first.map(|group| lay(group, scissor)).collect()
}

/// Depth alone.
#[must_use]
pub fn lay(group: &SurfaceGroup, scissor: [u32; 4]) -> Step {
    let why = "Lays the depth that all later steps are tested against; colour waits until the count is known.";
    step(format!("depth{}", group.words()), why, group.depth_draw(Depth::LAY, StencilState::IGNORE, scissor))
}

/// Where and to what a frame's only light is added.
#[derive(Debug)]
pub struct OnlyLight<'a> {
    /// An index into the scene's lights.
    pub light: usize,
    /// Its shape.
    pub shape: LightShape,
    /// Which instances it may reach.
    pub reached: &'a Reached<'a>,
    /// What may be in shadow; `None` where no surface is.
    pub dark: Option<Dark>,
}

/// Where the stencil tells lit from shadow.
#[derive(Debug, Clone, Copy)]
pub struct Dark {
    /// By which bits.
    pub budget: BitBudget,
    /// Pixels; beyond them nothing is in shadow.
    pub scissor: [u32; 4],
}

/// Every surface in its final colour, drawn once: in ambient light and `only` light where its count
/// is zero, in ambient light alone elsewhere.
#[must_use]
pub fn finished(groups: &[SurfaceGroup], only: Option<&OnlyLight<'_>>, scissor: [u32; 4]) -> Vec<Step> {
    let mut steps = Vec::new();
    let dark = only.and_then(|only| only.dark);
    for group in groups {
        let depth = if group.lays_depth_when_finished(dark.is_some()) { Depth::LAY } else { Depth::SAME_SURFACE };
        if let Some(only) = only {
            let stencil = dark.map_or(StencilState::IGNORE, |dark| StencilState::count_equals(dark.budget));
            steps.extend(in_light(group, only, depth, stencil, scissor));
            steps.extend(dark.and_then(|dark| in_shadow(group, only, dark)));
        }
        steps.extend(out_of_reach(group, only, depth, scissor));
    }
    steps
}

/// The same in two halves, before the count and after it. First every surface as if everything were lit, or in shadow
/// where the `eye_in_shadow` says that most of what it sees may be; which lays depth, but for masked surfaces. Then again, in
/// its other colour, what the count says is not so.
#[must_use]
pub fn finished_early(groups: &[SurfaceGroup], only: &OnlyLight<'_>, eye_in_shadow: bool, scissor: [u32; 4]) -> [Vec<Step>; 2] {
    let mut halves = [Vec::new(), Vec::new()];
    for group in groups {
        let depth = if group.lays_depth_when_finished(false) { Depth::LAY_LAST } else { Depth::SAME_SURFACE };
        match only.dark {
            Some(dark) if eye_in_shadow => {
                halves[0].extend(out_of_reach(group, None, depth, scissor));
                let lit = StencilState::count_equals(dark.budget);
                halves[1].extend(in_light(group, only, Depth::SAME_SURFACE, lit, scissor));
            }
            dark => {
                halves[0].extend(in_light(group, only, depth, StencilState::IGNORE, scissor));
                halves[0].extend(out_of_reach(group, Some(only), depth, scissor));
                halves[1].extend(dark.and_then(|dark| in_shadow(group, only, dark)));
            }
        }
    }
    halves
}

/// What the light may reach of a group, in it and in ambient light.
fn in_light(group: &SurfaceGroup, only: &OnlyLight<'_>, depth: Depth, stencil: StencilState, scissor: [u32; 4]) -> Option<Step> {
    let why = if stencil.tests() {
        "Ambient light and this one, through the tone curve, where no volume holds the surface."
    } else {
        "Ambient light and this one, through the tone curve, wherever the light reaches."
    };
    let label = format!("light {}: lit", only.light);
    finish(group, (&label, why), (only.reached.of(&group.surfaces, true), Some(only)), (depth, stencil), scissor)
}

/// The same in ambient light alone, where the count says so.
fn in_shadow(group: &SurfaceGroup, only: &OnlyLight<'_>, Dark { budget, scissor }: Dark) -> Option<Step> {
    let why = "Ambient light alone, through the tone curve, where a volume holds the surface.";
    let label = format!("light {}: shadow", only.light);
    let state = (Depth::SAME_SURFACE, StencilState::count_differs(budget));
    finish(group, (&label, why), (only.reached.of(&group.surfaces, true), None), state, scissor)
}

/// What the light does not reach of a group; all of it where there is none.
fn out_of_reach(group: &SurfaceGroup, only: Option<&OnlyLight<'_>>, depth: Depth, scissor: [u32; 4]) -> Option<Step> {
    let why = if only.is_some() {
        "Ambient light alone, through the tone curve: the light does not reach here."
    } else {
        "Ambient light alone, through the tone curve."
    };
    let far = only.map_or_else(|| group.surfaces.clone(), |only| only.reached.of(&group.surfaces, false));
    finish(group, ("ambient", why), (far, None), (depth, StencilState::IGNORE), scissor)
}

/// Some surfaces of a group in their final colour, in ambient light and perhaps another.
fn finish(
    group: &SurfaceGroup,
    (label, why): (&str, &str),
    (surfaces, lit): (List<Surface>, Option<&OnlyLight<'_>>),
    (depth, stencil): (Depth, StencilState),
    scissor: [u32; 4],
) -> Option<Step> {
    let draw = Draw {
        look: Look { light: lit.map(|lit| lit.shape).unwrap_or_default(), finished: true, ..group.kind.look },
        target: Target::Direct,
        state: State { depth: depth.with_bias(group.bias()), ..group.again(Blend::Replace, stencil) },
        light: lit.map(|lit| lit.light),
        ..Draw::plain(if lit.is_some() { Program::Lit } else { Program::Ambient }, DrawSet::Surfaces(surfaces.clone()), scissor)
    };
    (!surfaces.is_empty()).then(|| step(format!("{label}{}", group.words()), why, draw))
}

/// One light over surfaces that are [`finished`] in ambient light alone: again in their final colour, with both, where
/// its count is zero. For where it cannot be asked at once whether a count is zero and which view it is of.
#[must_use]
pub fn relit(groups: &[SurfaceGroup], only: &OnlyLight<'_>, scissor: [u32; 4]) -> Vec<Step> {
    let why = "Ambient light and this one, through the tone curve, where no volume holds the surface.";
    let of_group = |group: &SurfaceGroup| {
        let surfaces = only.reached.of(&group.surfaces, true);
        let draw = Draw {
            program: Program::Lit,
            look: Look { light: only.shape, finished: true, clipped: false, ..group.kind.look },
            target: Target::Direct,
            state: group
                .again(Blend::Replace, only.dark.map_or(StencilState::IGNORE, |dark| StencilState::count_equals(dark.budget))),
            stencil_reference: 0,
            scissor,
            light: Some(only.light),
            constant: [0.0; 4],
            set: DrawSet::Surfaces(surfaces.clone()),
        };
        (!surfaces.is_empty()).then(|| step(format!("light {}: lit{}", only.light, group.words()), why, draw))
    };
    groups.iter().filter_map(of_group).collect()
}

/// Every surface in the colour that stands for its number ([`crate::frame::identity_color`]).
#[must_use]
pub fn identities(groups: &[SurfaceGroup], scissor: [u32; 4]) -> Vec<Step> {
    let why = "Every surface in a colour that no other has: which object is seen in which view, for other programs to read.";
    let of_group = |group: &SurfaceGroup| step(format!("surfaces{}", group.words()), why, group.identity_draw(scissor));
    groups.iter().map(of_group).collect()
}

/// A display colour for surfaces that share it.
#[derive(Debug, Clone, Copy)]
pub struct Tint<'a> {
    /// What they are.
    pub label: &'a str,
    /// One sentence on that.
    pub why: &'a str,
    /// As the picture stores it (sRGB, 0 to 1), with alpha.
    pub color: [f32; 4],
    /// What is seen from behind, of surfaces that are otherwise drawn from the front alone: the inside of what
    /// the near plane cuts open.
    pub inside: bool,
}

/// The surfaces that `wanted` takes, in one colour and shaded by their slope alone; lays depth.
#[must_use]
pub fn tinted(groups: &[SurfaceGroup], tint: &Tint<'_>, wanted: impl Fn(Surface) -> bool, scissor: [u32; 4]) -> Vec<Step> {
    let draw = |group: &SurfaceGroup, surfaces| Draw {
        program: if group.kind.masked { Program::TintMasked } else { Program::Tint },
        look: group.bare_look(),
        target: Target::Scene,
        state: State {
            depth: group.first_depth(),
            cull: if tint.inside { Cull::Front } else { group.kind.cull },
            ..group.again(Blend::Replace, StencilState::IGNORE)
        },
        stencil_reference: 0,
        scissor,
        light: None,
        constant: tint.color,
        set: DrawSet::Surfaces(surfaces),
    };
    let of_group = |group: &SurfaceGroup| {
        let has_inside = group.kind.cull != Cull::None && !group.kind.laid;
        let drawn = group.surfaces.iter().copied().filter(|surface| wanted(*surface) && (has_inside || !tint.inside));
        let surfaces: List<_> = drawn.collect();
        (!surfaces.is_empty()).then(|| step(format!("{}{}", tint.label, group.words()), tint.why, draw(group, surfaces)))
    };
    groups.iter().filter_map(of_group).collect()
}

/// The same over surfaces that lie there already, multiplied with what they are: colours above 1 brighten.
#[must_use]
pub fn tinted_again(groups: &[SurfaceGroup], tint: &Tint<'_>, scissor: [u32; 4]) -> Vec<Step> {
    let mut steps = tinted(groups, tint, |_| true, scissor);
    for step in &mut steps {
        if let Action::Draw(draw) = &mut step.action {
            let bias = draw.state.depth.bias;
            (draw.state.depth, draw.state.color) = (Depth::SAME_SURFACE.with_bias(bias), Some(Blend::Multiply));
        }
    }
    steps
}

/// One light, added where its count is zero, to the surfaces that `reached` says it may reach.
#[must_use]
pub fn lit<'a>(
    groups: impl IntoIterator<Item = &'a SurfaceGroup>,
    light: usize,
    shape: LightShape,
    scissor: [u32; 4],
    stencil: StencilState,
    reached: &Reached<'_>,
) -> Vec<Step> {
    let draw = |group: &SurfaceGroup, surfaces| Draw {
        program: Program::Lit,
        look: Look { light: shape, clipped: false, ..group.kind.look },
        target: Target::Scene,
        state: group.again(Blend::Add, stencil),
        stencil_reference: 0,
        scissor,
        light: Some(light),
        constant: [0.0; 4],
        set: DrawSet::Surfaces(surfaces),
    };
    let why = "Adds the light where no volume holds the surface, where the count is zero; and marks it there, lest another surface in the same place takes the light again.";
    let of_group = |group: &SurfaceGroup| {
        let surfaces = reached.of(&group.surfaces, true);
        (!surfaces.is_empty()).then(|| step(format!("light {light}: add{}", group.words()), why, draw(group, surfaces)))
    };
    groups.into_iter().filter_map(of_group).collect()
}

/// Whether some surfaces' textures are left for after all lights.
#[must_use]
pub fn textured_last(groups: &[SurfaceGroup]) -> bool {
    groups.iter().any(|group| group.kind.textured_last)
}

/// The textures of surfaces whose light was added up without them (M section 8).
#[must_use]
pub fn textures(groups: &[SurfaceGroup], stencil: StencilState, scissor: [u32; 4]) -> Vec<Step> {
    let draw = |group: &SurfaceGroup| Draw {
        program: Program::Texture,
        look: Look::default(),
        target: Target::Scene,
        state: group.again(Blend::Multiply, stencil),
        stencil_reference: 0,
        scissor,
        light: None,
        constant: [0.0; 4],
        set: DrawSet::Surfaces(group.surfaces.clone()),
    };
    let why = "Multiplies the sum of all lights with the surface's texture, which no light has read: once a frame instead of once a light.";
    let last = groups.iter().filter(|group| group.kind.textured_last);
    last.map(|group| step(format!("texture{}", group.words()), why, draw(group))).collect()
}

/// One light's verdict in exact values: white where the count is zero, black where it is not.
#[must_use]
pub fn verdict(groups: &[SurfaceGroup], light: usize, scissor: [u32; 4], budget: BitBudget) -> Vec<Step> {
    let dark = said(groups, light, scissor, false, StencilState::IGNORE);
    let lit = said(groups, light, scissor, true, StencilState::count_equals(budget));
    dark.into_iter().chain(lit).collect()
}

/// Half of a light's verdict in exact values: that surfaces are `lit`, or that they are in shadow, where the stencil lets
/// it through.
#[must_use]
pub fn said<'a>(
    groups: impl IntoIterator<Item = &'a SurfaceGroup>,
    light: usize,
    scissor: [u32; 4],
    lit: bool,
    stencil: StencilState,
) -> Vec<Step> {
    let (name, value, why) = if lit {
        ("lit", 1.0, "White where the count is zero, within the light's range.")
    } else {
        ("shadow", 0.0, "Black within the light's range, until the count says otherwise.")
    };
    let of_group = |group: &SurfaceGroup| {
        let draw = Draw {
            program: Program::Verdict,
            look: Look::default(),
            target: Target::Scene,
            state: group.again(Blend::Replace, stencil),
            stencil_reference: 0,
            scissor,
            light: Some(light),
            constant: [value, value, value, 1.0],
            set: DrawSet::Surfaces(group.surfaces.clone()),
        };
        step(format!("light {light}: {name}{}", group.words()), why, draw)
    };
    groups.into_iter().map(of_group).collect()
}

/// Blended surfaces, far to near, in every light, unshadowed.
#[must_use]
pub fn transparent(known: Known<'_>, view: &View, scissor: [u32; 4]) -> Vec<Step> {
    let Known { scene, pose, workspace, .. } = known;
    let nodes = workspace.numbers.collect(scene.instances().map(|(node, ..)| node));
    let mut blended: Vec<_> = described(known, view)
        .filter(|(kind, alpha, _)| *alpha == AlphaMode::Blend && kind.decal.is_none_or(|decal| decal.ground().is_none()))
        .map(|(kind, _, surface)| {
            let center = pose.world_bounds(scene, nodes[surface.instance]).center();
            (center.as_dvec3().distance_squared(view.camera.eye), kind, surface)
        })
        .collect();
    blended.sort_by(|a, b| b.0.total_cmp(&a.0));

    let groups = blended.chunk_by(|(_, a, _), (_, b, _)| a == b);
    let of_one_kind = |alike: &[(f64, Kind, Surface)]| {
        let surfaces = workspace.surfaces.collect(alike.iter().map(|(.., surface)| *surface));
        SurfaceGroup { kind: alike[0].1, surfaces }
    };
    let why = "Blended surfaces, far to near, over the finished picture; they receive no shadows and cast none.";
    groups
        .map(of_one_kind)
        .map(|group| {
            let state = State {
                depth: Depth::NEARER.with_bias(group.bias()),
                stencil: StencilState::IGNORE,
                color: Some(Blend::Over),
                cull: group.kind.cull,
                winding: group.kind.winding,
                near_plane: NearPlane::Clip,
            };
            let label = format!("blended{}", group.words());
            let draw = Draw {
                program: Program::Transparent,
                look: group.kind.look,
                target: Target::Scene,
                state,
                stencil_reference: 0,
                scissor,
                light: None,
                constant: [0.0; 4],
                set: DrawSet::Surfaces(group.surfaces),
            };
            step(label, why, draw)
        })
        .collect()
}
