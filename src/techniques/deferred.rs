//! Deferred shading: surfaces are drawn once, and what light needs to know of them is kept.
//!
//! The papers draw every surface again for each light, and where one light falls on the picture alone, once for what is lit
//! and once for what is not. Where triangles are many each of those walks costs more than the shadows. So the first walk
//! keeps, beside depth, each pixel's normal and base colour (Saito and Takahashi, *Comprehensible Rendering of 3-D
//! Shapes*, 1990), and lights draw pixels:
//!
//! - one light in two full-screen steps, that ask the stencil as the forward form does: both lights where the count is zero,
//!   ambient light where it is not;
//! - up to four lights are counted one after the other, each leaves a bit of its own where its
//!   shadow is ([`Target::Dark`]), and one step shades them all, so that nothing is accumulated.
//!
//! The stencil, and what is lit and what is dark, are the forward form's very own. Colours may differ by a step or two of
//! 255: normals and base colours are kept in 16-bit floats.

use super::surfaces::{SurfaceGroup, step};
use crate::frame::state::{Blend, Depth, State};
use crate::frame::stencil::{BitBudget, StencilState};
use crate::frame::{Draw, DrawSet, LightShape, Look, Program, SHADED_TOGETHER, Shade, Step, Target};
use crate::scene::Scene;

/// Materials have their number in a half float, which holds whole numbers so far.
const MOST_MATERIALS: usize = 1 << 11;

/// Why surfaces cannot be kept, where one of them cannot.
#[must_use]
pub fn refusal(scene: &Scene, groups: &[SurfaceGroup]) -> Option<&'static str> {
    let unfit = |group: &SurfaceGroup| {
        let kind = &group.kind;
        kind.mirror.is_some() || kind.laid || kind.look.clipped || kind.textured_last || group.claims().is_some()
    };
    if groups.iter().any(unfit) {
        Some("mirrors, solids put together and decals by the stencil are drawn surface by surface")
    } else if scene.materials.len() > MOST_MATERIALS {
        Some("it tells 2048 materials apart, and this scene has more")
    } else {
        None
    }
}

/// Triangles of these surfaces; `nodes` are the instances'.
#[must_use]
pub fn triangles(scene: &Scene, nodes: &[usize], groups: &[SurfaceGroup]) -> usize {
    let mesh = |instance: usize| scene.nodes[nodes[instance]].mesh.map(|mesh| &scene.meshes[mesh]);
    let triangles =
        |surface: &crate::frame::Surface| Some(mesh(surface.instance)?.primitives[surface.primitive].index_count as usize / 3);
    groups.iter().flat_map(|group| &group.surfaces).filter_map(triangles).sum()
}

/// Keeps each pixel's surface; lays depth.
#[must_use]
pub fn geometry(groups: &[SurfaceGroup], scissor: [u32; 4]) -> Vec<Step> {
    let why = "Lays the depth that all later steps are tested against, and keeps normal and base colour for the lights.";
    let of_group = |group: &SurfaceGroup| {
        let draw = Draw {
            look: group.kind.look,
            target: Target::Geometry,
            state: State { depth: group.first_depth(), ..group.again(Blend::Replace, StencilState::IGNORE) },
            ..Draw::plain(
                if group.kind.masked { Program::GeometryMasked } else { Program::Geometry },
                DrawSet::Surfaces(group.surfaces.clone()),
                scissor,
            )
        };
        step(format!("geometry{}", group.words()), why, draw)
    };
    groups.iter().map(of_group).collect()
}

/// The bit of a light, the `place`th of those that are shaded together, where its shadow is; it is nowhere beyond the scissor.
#[must_use]
pub fn mark(light: usize, place: usize, budget: BitBudget, scissor: [u32; 4]) -> Step {
    let draw = Draw {
        target: Target::Dark,
        state: State { color: Some(Blend::Add), stencil: StencilState::count_differs(budget), ..State::FLAT },
        light: Some(light),
        constant: [f32::from(1u8 << place) / 255.0, 0.0, 0.0, 0.0],
        ..Draw::plain(Program::MarkDark, DrawSet::FullScreen, scissor)
    };
    let why = "Leaves the light's bit where a volume holds the surface: all lights are shaded together in the end.";
    step(format!("light {light}: mark"), why, draw)
}

/// Some lights, none to [`SHADED_TOGETHER`], on the surfaces of some groups.
#[derive(Debug)]
pub struct Shading<'a> {
    /// What was kept.
    pub groups: &'a [SurfaceGroup],
    /// Indices into the pose's lights, and their shapes.
    pub lights: &'a [(usize, LightShape)],
    /// Each light that casts shadows has left its bit; else the stencil says where they shine, or all shine everywhere.
    pub each: bool,
}

/// Lights pixels, in their final colour.
#[must_use]
pub fn shade(shading: &Shading<'_>, (label, why): (&str, &str), stencil: StencilState, scissor: [u32; 4], scene: &Scene) -> Step {
    let Shading { groups, lights, each } = *shading;
    let mut shapes = [None; SHADED_TOGETHER];
    let mut constant = [0.0; SHADED_TOGETHER];
    for (place, (light, shape)) in lights.iter().enumerate().take(SHADED_TOGETHER) {
        shapes[place] = Some(*shape);
        #[expect(clippy::cast_precision_loss, reason = "f32 holds whole numbers to 16 million")]
        let number = *light as f32;
        constant[place] = number;
    }
    let materials = scene.materials.iter().any(|material| material.unlit || material.emissive != glam::Vec3::ZERO);
    let glossy = !lights.is_empty() && groups.iter().any(|group| group.kind.look.glossy);
    let look =
        Look { glossy, finished: true, shade: Shade { lights: shapes, each, materials: materials || glossy }, ..Look::default() };
    let draw = Draw {
        look,
        target: Target::Shaded,
        state: State { depth: Depth::ANY_SURFACE, stencil, color: Some(Blend::Replace), ..State::FLAT },
        light: lights.first().map(|(light, _)| *light),
        constant,
        ..Draw::plain(Program::Shade, DrawSet::FullScreen, scissor)
    };
    step(label.into(), why, draw)
}
