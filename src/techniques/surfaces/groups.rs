//! Surfaces grouped by the state they need: culled or drawn from both sides, wound straight or mirrored, masked or not, with a
//! texture or a highlight or without.

use std::cmp::Reverse;

use glam::Vec3;

use crate::frame::plan::View;
use crate::frame::state::{Blend, Cull, Depth, DepthBias, NearPlane, State, Winding};
use crate::frame::stencil::StencilState;
use crate::frame::{Draw, DrawSet, List, Look, Program, Surface, Target};
use crate::geometry::frustum::screen_rect;
use crate::scene::solid::Role;
use crate::scene::{AlphaMode, Pose, Scene};
use crate::settings::Texturing;
use crate::techniques::decals::{Decal, Decals};
use crate::techniques::mirrors::Mirrors;
use crate::techniques::workspace::{Lent, Workspace};

/// Surfaces that share state and shader.
#[derive(Debug)]
pub struct SurfaceGroup {
    pub(in crate::techniques) kind: Kind,
    pub(in crate::techniques) surfaces: List<Surface>,
}

/// What decides the state and the shader a surface is drawn with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::techniques) struct Kind {
    pub cull: Cull,
    pub winding: Winding,
    pub masked: bool,
    /// Its texture multiplies the sum of all lights, and no light reads it.
    pub textured_last: bool,
    /// Its number among the mirrors in force.
    pub mirror: Option<usize>,
    /// Its depth is there already: of two solids put together what is seen was found out before.
    pub laid: bool,
    /// What it is as a decal.
    pub decal: Option<Decal>,
    pub look: Look,
}

/// What is known of a scene's surfaces before they are grouped for a view.
#[derive(Debug, Clone, Copy)]
pub struct Known<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Where everything is.
    pub pose: &'a Pose,
    /// The mirrors in force.
    pub mirrors: &'a Mirrors,
    /// The decals, and how they are drawn.
    pub decals: &'a Decals,
    /// Where things lie before the mirror that the view looks through.
    pub places: &'a [Place],
    /// Where lists are made.
    pub workspace: &'a Workspace,
}

/// Where an instance lies before the plane that a view is clipped at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// All of it is before the plane.
    Before,
    /// Some of it may be behind.
    Across,
    /// Nothing of it is seen.
    Unseen,
}

/// The scene's opaque and masked surfaces that the view may see, grouped.
#[must_use]
pub fn opaque_groups(known: Known<'_>, view: &View, size: [u32; 2], texturing: Texturing) -> Vec<SurfaceGroup> {
    let Known { scene, pose, workspace, .. } = known;
    let clip_from_world = view.camera.clip_from_world();
    // The radius of each instance's bounds; `None` where it is out of view.
    let seen = workspace.sizes.collect(scene.instances().map(|(node, ..)| {
        let bounds = pose.world_bounds(scene, node);
        let (center, radius) = (bounds.center().as_dvec3(), bounds.radius());
        screen_rect(center, f64::from(radius), &clip_from_world, size).map(|_| radius)
    }));
    let mut found: Vec<(Kind, Lent<'_, Surface>)> = Vec::new();
    for (mut kind, alpha, surface) in described(known, view) {
        if texturing == Texturing::Once && kind.textured_last {
            kind.look.textured = false;
        } else {
            kind.textured_last = false;
        }
        if alpha != AlphaMode::Blend && seen[surface.instance].is_some() {
            match found.iter_mut().find(|(alike, _)| *alike == kind) {
                Some((_, surfaces)) => surfaces.push(surface),
                None => found.push((kind, workspace.found_surfaces.collect([surface]))),
            }
        }
    }
    // Floors and walls come last, so that what stands before them hides them; all else stays in the scene's
    // order, in which instances of one mesh mostly follow each other and are drawn by one call.
    let largest = seen.iter().copied().flatten().fold(0.0, f32::max);
    let wide = |surface: &Surface| seen[surface.instance].is_some_and(|radius| radius > largest / 2.0);
    let in_order = |(kind, surfaces): (Kind, Lent<'_, Surface>)| {
        let [small, large] = [false, true].map(|large| surfaces.iter().filter(move |surface| wide(surface) == large));
        SurfaceGroup { kind, surfaces: workspace.surfaces.collect(small.chain(large).copied()) }
    };
    let mut groups: Vec<_> = found.into_iter().map(in_order).collect();
    groups.sort_by_key(|group| group.surfaces.iter().any(wide));
    // What claims its pixels comes first, from the topmost on; its ground takes what is left.
    groups.sort_by_key(|group| Reverse(group.claims().and(group.kind.decal).map(Decal::layer)));
    groups
}

/// The mesh of two solids put together: what casts their shadow, and is not drawn itself; none where the view sees nothing
/// of it.
#[must_use]
pub fn solid_group(known: Known<'_>, view: &View) -> Option<SurfaceGroup> {
    let caster = known.scene.solid.as_ref()?.caster?;
    let mut of_it = of_all(known, view).filter(|(.., surface)| surface.instance == caster);
    let (kind, _, surface) = of_it.find(|_| known.places[caster] != Place::Unseen)?;
    Some(SurfaceGroup { kind, surfaces: vec![surface].into() })
}

pub(in crate::techniques) fn described<'a>(
    known: Known<'a>,
    view: &'a View,
) -> impl Iterator<Item = (Kind, AlphaMode, Surface)> + 'a {
    let Known { scene, decals, places, .. } = known;
    let through = view.through.as_ref().map(|window| window.exit);
    let casts_only = scene.solid.as_ref().and_then(|solid| solid.caster);
    let is_seen = move |surface: Surface| {
        let there = Some(surface.instance) != casts_only && places[surface.instance] != Place::Unseen;
        there && Some(surface) != through && !decals.hides(surface)
    };
    of_all(known, view).filter(move |(.., surface)| is_seen(*surface))
}

/// Every surface, seen or not.
fn of_all<'a>(known: Known<'a>, view: &'a View) -> impl Iterator<Item = (Kind, AlphaMode, Surface)> + 'a {
    let Known { scene, pose, mirrors, decals, places, .. } = known;
    scene.instances().enumerate().flat_map(move |(instance, (node, _, mesh))| {
        let winding = view.winding.through(pose.world_from_object[node].matrix3.determinant());
        let role = scene.solid.as_ref().map_or(Role::Object, |solid| solid.role(instance));
        mesh.primitives.iter().enumerate().map(move |(primitive, part)| {
            let material = &scene.materials[part.material];
            let surface = Surface { instance, primitive };
            let mirror = mirrors.of(surface).filter(|_| role == Role::Object);
            let kind = Kind {
                cull: match role {
                    Role::Inside => Cull::Front,
                    Role::Object if material.double_sided => Cull::None,
                    _ => Cull::Back,
                },
                winding,
                masked: matches!(material.alpha, AlphaMode::Mask(_)),
                // Masked surfaces need their texture to know where they are, and what surfaces give off by
                // themselves is no light on their texture.
                textured_last: material.base_color_texture.is_some()
                    && mirror.is_none()
                    && material.alpha == AlphaMode::Opaque
                    && material.emissive == Vec3::ZERO,
                mirror,
                laid: role != Role::Object,
                decal: decals.of(surface),
                look: Look {
                    inside: role == Role::Inside,
                    clipped: places[instance] == Place::Across,
                    mirror: mirrors.look(mirror),
                    textured: material.base_color_texture.is_some(),
                    glossy: material.roughness < MATT || material.metallic > 0.0,
                    ..Look::default()
                },
            };
            (kind, material.alpha, surface)
        })
    })
}

/// Materials at least this rough, and without metal, get no highlight: it would not be seen.
pub const MATT: f32 = 0.9;

impl SurfaceGroup {
    /// Whether depth is laid by drawing the surfaces in their final colour: not before the count is known,
    /// and not where fragments are masked away, which only the programs that lay depth first do.
    pub(super) fn lays_depth_when_finished(&self, shadowed: bool) -> bool {
        !shadowed && !self.kind.masked
    }

    /// Which mirror it is, where it is one.
    #[must_use]
    pub fn mirror(&self) -> Option<usize> {
        self.kind.mirror
    }

    /// Whether its depth is there before it is drawn: two solids put together.
    #[must_use]
    pub fn is_laid(&self) -> bool {
        self.kind.laid
    }

    /// How depth is tested where it is drawn first.
    pub(in crate::techniques) fn first_depth(&self) -> Depth {
        (if self.kind.laid { Depth::SAME_SURFACE } else { Depth::LAY }).with_bias(self.bias())
    }

    /// The ground on which it claims its pixels, by the stencil.
    pub(in crate::techniques) fn claims(&self) -> Option<usize> {
        self.kind.decal.and_then(Decal::ground)
    }

    /// How its depth is moved.
    pub(super) fn bias(&self) -> DepthBias {
        self.kind.decal.map_or(DepthBias::NONE, Decal::bias)
    }

    /// What lays its depth alone.
    pub(super) fn depth_program(&self) -> Program {
        if self.kind.masked || self.kind.look.clipped { Program::DepthMasked } else { Program::Depth }
    }

    /// Nothing but what decides where it is.
    pub(super) fn bare_look(&self) -> Look {
        let Look { textured, clipped, inside, .. } = self.kind.look;
        Look { textured: self.kind.masked && textured, clipped, inside, ..Look::default() }
    }

    /// In the colour of their numbers; lays depth.
    pub(super) fn identity_draw(&self, scissor: [u32; 4]) -> Draw {
        Draw {
            program: Program::Identity,
            look: self.bare_look(),
            target: Target::Scene,
            state: State { depth: self.first_depth(), ..self.again(Blend::Replace, StencilState::IGNORE) },
            stencil_reference: 0,
            scissor,
            light: None,
            constant: [0.0; 4],
            set: DrawSet::Surfaces(self.surfaces.clone()),
        }
    }

    /// Its depth alone, and how it is compared.
    pub(in crate::techniques) fn depth_draw(&self, depth: Depth, stencil: StencilState, scissor: [u32; 4]) -> Draw {
        Draw {
            program: self.depth_program(),
            look: self.bare_look(),
            target: Target::Scene,
            state: State { depth: depth.with_bias(self.bias()), color: None, ..self.again(Blend::Replace, stencil) },
            stencil_reference: 0,
            scissor,
            light: None,
            constant: [0.0; 4],
            set: DrawSet::Surfaces(self.surfaces.clone()),
        }
    }

    /// Drawn again over its own depth.
    pub(in crate::techniques) fn again(&self, blend: Blend, stencil: StencilState) -> State {
        State {
            depth: Depth::SAME_SURFACE.with_bias(self.bias()),
            stencil,
            color: Some(blend),
            cull: self.kind.cull,
            winding: self.kind.winding,
            near_plane: NearPlane::Clip,
        }
    }

    pub(in crate::techniques) fn words(&self) -> String {
        let mut words = String::new();
        let kind = &self.kind;
        for (there, word) in [
            (kind.cull == Cull::None, ", both sides"),
            (kind.winding == Winding::Cw, ", mirrored"),
            (kind.masked, ", masked"),
            (kind.textured_last, ", textured last"),
            (kind.look.textured, ", textured"),
            (kind.look.glossy, ", glossy"),
            (kind.look.clipped, ", clipped"),
            (kind.mirror.is_some(), ", mirror"),
            (kind.laid && !kind.look.inside, ", of a solid"),
            (kind.look.inside, ", inside of a solid"),
        ] {
            if there {
                words.push_str(word);
            }
        }
        words
    }
}
