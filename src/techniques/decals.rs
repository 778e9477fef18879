//! Decals: surfaces in the very plane of what they lie on, such as a runway's markings (K section 7, figure 18).
//!
//! Two surfaces in one plane have depths that differ in their last bits by chance, so depth cannot say which is seen.
//! Polygon offset draws each layer nearer than it is, and sometimes shows it through what stands close before it. The
//! stencil needs neither: what lies beneath says where.
//!
//! ```text
//!   mark     the ground's visible pixels: same depth, one bit
//!   claim    the topmost layer, without depth, where the bit is set: colour, depth, and the bit is gone
//!   ...      the next one down, in what is left
//!   unmark   the rest of the ground
//! ```
//!
//! K draws the layers from the lowest to the highest and replaces the tag each time; from the highest down one bit does
//! for any number of them, every pixel is drawn once, and where the lights come later each pixel has the depth of what is
//! seen there, so that light after light the decal alone passes the test for equal depth: it is drawn before its ground,
//! and takes the light that the ground then finds taken.
//!
//! The ground are all flat opaque surfaces in a decal's plane. Blended decals come when all light is there, by the same
//! bit, each layer's pixels once: overlapping triangles of one shadow do not darken twice.
//!
//! In mirrors nothing else is done, view by view: decals come when a view's own mirrors show what they reflect, so that
//! they may lie on a mirror as well. On ground that takes planar shadows decals take them with it, under its value
//! ([`super::planar::Stand`]); where only a part of the ground does, they are offset instead.

use std::collections::BTreeMap;

use glam::{DVec3, DVec4};

use super::surfaces::{Known, SurfaceGroup, described, step};
use crate::frame::plan::View;
use crate::frame::state::{Blend, Depth, DepthBias, State};
use crate::frame::stencil::{BitBudget, StencilState};
use crate::frame::{Draw, DrawSet, List, Program, Step, Surface};
use crate::geometry::planar::height;
use crate::scene::{AlphaMode, Pose, Scene};
use crate::settings::DecalMode;

/// The decals of a frame.
#[derive(Debug, Default)]
pub struct Decals {
    by_surface: BTreeMap<(usize, usize), Decal>,
    grounds: Vec<Ground>,
    /// They are not drawn at all: exact values are their ground's.
    hidden: bool,
    /// Some are offset although the stencil could draw them: only a part of their ground takes planar shadows.
    parted: bool,
}

/// One decal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Decal {
    /// From 1, the lowest: decal materials in their order.
    layer: u32,
    /// Where the stencil draws it: on which ground.
    ground: Option<usize>,
    /// It is offset by its layer.
    offset: bool,
}

/// A plane with decals, and what they lie on.
#[derive(Debug)]
struct Ground {
    /// World space, unit normal.
    plane: DVec4,
    surfaces: Vec<Surface>,
}

/// How far a surface may be off a plane that it lies in, of the scene's radius.
const FLAT: f64 = 1e-6;

impl Decals {
    /// The scene's decals, where they are, to be drawn by `mode`; or hidden, where exact values are shown. `receives` says
    /// which surfaces take planar shadows by a value in the stencil.
    #[must_use]
    pub fn new(scene: &Scene, pose: &Pose, mode: DecalMode, hidden: bool, receives: impl Fn(Surface) -> bool) -> Self {
        if !scene.materials.iter().any(|material| material.decal) {
            return Self::default();
        }
        let mut decals = Self { hidden, ..Self::default() };
        let layers: Vec<_> = (0..scene.materials.len()).filter(|&material| scene.materials[material].decal).collect();
        let room = FLAT * f64::from(scene.bounds(pose).radius());
        for (instance, (node, _, mesh)) in scene.instances().enumerate() {
            for (primitive, part) in mesh.primitives.iter().enumerate() {
                let Some(layer) = layers.iter().position(|&material| material == part.material) else { continue };
                let surface = Surface { instance, primitive };
                let plane = if mode == DecalMode::Stencil && !hidden { plane(scene, pose, node, part, room) } else { None };
                let ground = plane.and_then(|plane| decals.ground(scene, pose, plane, room));
                // What blends comes when shadows have fallen.
                let blended = scene.materials[part.material].alpha == AlphaMode::Blend;
                let ground = match ground {
                    Some(ground) if !blended && decals.grounds[ground].parts(&receives, surface) => {
                        decals.parted = true;
                        None
                    }
                    ground => ground,
                };
                let layer = u32::try_from(layer + 1).unwrap_or(u32::MAX);
                let offset = mode == DecalMode::Offset || (mode == DecalMode::Stencil && ground.is_none());
                decals.by_surface.insert((surface.instance, surface.primitive), Decal { layer, ground, offset });
            }
        }
        decals
    }

    /// The ground in a plane: a new one where there is none yet, and none where nothing lies there.
    fn ground(&mut self, scene: &Scene, pose: &Pose, plane: DVec4, room: f64) -> Option<usize> {
        let alike = |ground: &Ground| {
            ground.plane.truncate().dot(plane.truncate()) > 1.0 - 1e-9 && (ground.plane.w - plane.w).abs() <= 2.0 * room
        };
        if let Some(known) = self.grounds.iter().position(alike) {
            return Some(known);
        }
        let mut surfaces = Vec::new();
        for (instance, (node, _, mesh)) in scene.instances().enumerate() {
            let world_from_object = pose.world_from_object[node];
            let positions = pose.positions(scene, node);
            for (primitive, part) in mesh.primitives.iter().enumerate() {
                let material = &scene.materials[part.material];
                let indices = &mesh.indices[part.first_index as usize..(part.first_index + part.index_count) as usize];
                let lies = |&index: &u32| {
                    let place = world_from_object.transform_point3(positions[index as usize].as_dvec3());
                    height(plane, place).abs() <= room
                };
                if !material.decal && material.alpha != AlphaMode::Blend && indices.iter().all(lies) {
                    surfaces.push(Surface { instance, primitive });
                }
            }
        }
        if surfaces.is_empty() {
            return None;
        }
        self.grounds.push(Ground { plane, surfaces });
        Some(self.grounds.len() - 1)
    }

    /// What a surface is, if it is a decal.
    #[must_use]
    pub fn of(&self, surface: Surface) -> Option<Decal> {
        self.by_surface.get(&(surface.instance, surface.primitive)).copied()
    }

    /// Whether a surface is not drawn at all.
    #[must_use]
    pub fn hides(&self, surface: Surface) -> bool {
        self.hidden && self.of(surface).is_some()
    }

    /// Whether there are any.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.by_surface.is_empty()
    }

    /// Whether the stencil draws any.
    #[must_use]
    pub fn claim(&self) -> bool {
        self.by_surface.values().any(|decal| decal.ground.is_some())
    }

    /// Whether some are offset because only a part of their ground takes planar shadows.
    #[must_use]
    pub fn parted(&self) -> bool {
        self.parted
    }

    /// Whether a surface is of the ground of that number.
    #[must_use]
    pub fn lies_in(&self, ground: usize, surface: Surface) -> bool {
        self.grounds.get(ground).is_some_and(|ground| ground.surfaces.contains(&surface))
    }

    /// Opaque decals of every ground, in ambient and emitted light; `groups` are the view's, decals from the topmost on.
    #[must_use]
    pub fn lay(&self, groups: &[&SurfaceGroup], budget: BitBudget, scissor: [u32; 4]) -> Vec<Step> {
        let mut steps = Vec::new();
        for number in 0..self.grounds.len() {
            let claims: Vec<_> = groups
                .iter()
                .filter(|group| group.claims() == Some(number))
                .map(|group| {
                    let why = "Draws the decal in ambient and emitted light, without depth, in what the layers above it have left of its ground; the pixels are then its own, and its depth theirs.";
                    let draw = group.depth_draw(Depth::OVERWRITE, StencilState::claim_ground(budget), scissor);
                    let draw = Draw {
                        program: if group.kind.masked { Program::AmbientMasked } else { Program::Ambient },
                        look: group.kind.look,
                        state: State { color: Some(Blend::Replace), ..draw.state },
                        stencil_reference: budget.decal_mask,
                        ..draw
                    };
                    step(format!("decal{}", group.words()), why, draw)
                })
                .collect();
            if !claims.is_empty() {
                steps.extend(self.on(number, groups, (claims, false), budget, scissor));
            }
        }
        steps
    }

    /// Blended decals, layer by layer from the lowest, over the light that their ground gives; `groups` are the view's.
    #[must_use]
    pub fn blend(
        &self,
        known: Known<'_>,
        view: &View,
        groups: &[&SurfaceGroup],
        budget: BitBudget,
        scissor: [u32; 4],
    ) -> Vec<Step> {
        let mut layers: BTreeMap<(u32, usize), Vec<SurfaceGroup>> = BTreeMap::new();
        for (kind, alpha, surface) in described(known, view) {
            let Some(Decal { layer, ground: Some(ground), .. }) = kind.decal else { continue };
            if alpha == AlphaMode::Blend {
                layers.entry((layer, ground)).or_default().push(SurfaceGroup { kind, surfaces: vec![surface].into() });
            }
        }
        let mut steps = Vec::new();
        for ((_, ground), decals) in layers {
            let draws = decals.iter().map(|group| {
                let why = "Blends the decal over its ground, without depth, and no pixel of it twice.";
                let draw = Draw {
                    program: Program::Transparent,
                    look: group.kind.look,
                    state: State { depth: Depth::IGNORE, ..group.again(Blend::Over, StencilState::claim_ground(budget)) },
                    stencil_reference: budget.decal_mask,
                    ..Draw::plain(Program::Transparent, DrawSet::Surfaces(group.surfaces.clone()), scissor)
                };
                step(format!("blended decal{}", group.words()), why, draw)
            });
            steps.extend(self.on(ground, groups, (draws.collect(), true), budget, scissor));
        }
        steps
    }

    /// Steps on one ground: marked before, unmarked after. Where decals are `laid` on it already they are ground as well.
    fn on(
        &self,
        number: usize,
        groups: &[&SurfaceGroup],
        (steps, laid): (Vec<Step>, bool),
        budget: BitBudget,
        scissor: [u32; 4],
    ) -> Vec<Step> {
        let ground = &self.grounds[number];
        let marked = groups.iter().filter_map(|group| {
            let lies = |surface: &Surface| ground.surfaces.contains(surface) || laid && group.claims() == Some(number);
            let surfaces: List<_> = group.surfaces.iter().copied().filter(lies).collect();
            if surfaces.is_empty() {
                return None;
            }
            let draw = group.depth_draw(Depth::SAME_SURFACE, StencilState::mark_ground(budget), scissor);
            let draw = Draw { stencil_reference: budget.decal_mask, set: DrawSet::Surfaces(surfaces), ..draw };
            let why = "Marks the pixels in which the ground is seen: decals on it will be drawn there and nowhere else.";
            Some(step(format!("mark the ground{}", group.words()), why, draw))
        });
        let unmark = Draw {
            state: State { stencil: StencilState::unmark_ground(budget), ..State::FLAT },
            ..Draw::plain(Program::StencilOnly, DrawSet::FullScreen, scissor)
        };
        let why = "The rest of the ground is ground like any other: the bit is free again.";
        marked.chain(steps).chain([step("unmark the ground".into(), why, unmark)]).collect()
    }
}

impl Ground {
    /// Whether a decal on it cannot share the value of what takes planar shadows: some of the ground takes them and some
    /// not, or the decal alone does. In the decal's pixels its depth and the ground's are the same by chance, and light that
    /// is told apart by two values falls there twice.
    fn parts(&self, receives: impl Fn(Surface) -> bool, decal: Surface) -> bool {
        let receiving = self.surfaces.iter().filter(|surface| receives(**surface)).count();
        let all = receiving == self.surfaces.len();
        if receiving == 0 { receives(decal) } else { !all }
    }
}

impl Decal {
    /// How its depth is moved. Each layer by as much again: enough for the least steps of depth at its slope.
    #[must_use]
    pub fn bias(self) -> DepthBias {
        let layer = i32::try_from(self.layer.min(64)).unwrap_or(64);
        if self.offset { DepthBias { constant: 16 * layer, slope: layer } } else { DepthBias::NONE }
    }

    /// The ground on which the stencil draws it.
    #[must_use]
    pub fn ground(self) -> Option<usize> {
        self.ground
    }

    /// From 1, the lowest.
    #[must_use]
    pub fn layer(self) -> u32 {
        self.layer
    }
}

/// The plane that a primitive lies in, world space; none where it is not flat.
fn plane(scene: &Scene, pose: &Pose, node: usize, part: &crate::scene::Primitive, room: f64) -> Option<DVec4> {
    let mesh = scene.nodes[node].mesh.and_then(|mesh| scene.meshes.get(mesh))?;
    let world_from_object = pose.world_from_object[node];
    let positions = pose.positions(scene, node);
    let indices = &mesh.indices[part.first_index as usize..(part.first_index + part.index_count) as usize];
    let at = |index: u32| world_from_object.transform_point3(positions[index as usize].as_dvec3());
    // The largest triangle tells the plane best.
    let normal = |corners: &[u32]| -> DVec3 { (at(corners[1]) - at(corners[0])).cross(at(corners[2]) - at(corners[0])) };
    let largest = indices.chunks_exact(3).max_by(|a, b| normal(a).length_squared().total_cmp(&normal(b).length_squared()))?;
    let unit = normal(largest).try_normalize()?;
    let plane = unit.extend(-unit.dot(at(largest[0])));
    indices.iter().all(|&index| height(plane, at(index)).abs() <= room).then_some(plane)
}
