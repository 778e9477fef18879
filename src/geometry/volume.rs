//! A caster's shadow volume as indices: sides, light cap and dark cap.
//!
//! The vertex buffer holds the V welded vertices twice: v as it is (w = 1), and v' = v + V with
//! w = 0, which the vertex shader sends from the light to infinity as `p * light.w - light.xyz`
//! (M section 6). For a directional light all v' are one point. So a volume is nothing but indices.
//!
//! ```text
//!                light *
//!                     /|\                 light cap: the triangles themselves, kept (+1) or
//!                    / | \                           turned (-1) to face the light
//!             a ____/__|__\ b             sides:     (a, a', b') and (a, b', b) for each edge
//!              /    light  \                         a -> b of the silhouette; a single triangle
//!             /      cap    \                        (a, a', b) towards a directional light
//!            /               \            dark cap:  at infinity, facing away; none for a
//!          a' --- dark cap -- b'                     directional light
//! ```
//!
//! All faces are counter-clockwise seen from outside the volume, but for the *turned* part of the
//! light cap: it keeps the mesh's own vertex order, because a triangle given in another order
//! rasterises to depths with other last bits, and the cap must meet the drawn surface exactly.
//! It is drawn with increment and decrement swapped instead.
//!
//! **The dark cap** is a fan over the silhouette, O(s), where everything the light sees of the
//! caster lies within a half-space about the light; else it is every counted triangle again, O(f).
//! DESIGN asks that of the silhouette's directions alone, which is too little: a light inside a
//! room has for a silhouette just the rim of the door, narrow enough, yet the shadow is all
//! around it. A fan over the rim would cap the lit part instead. So all of the caster's vertices
//! are asked, in the common case by its box alone.

use std::ops::Range;

use glam::{DVec3, Vec3, Vec4};
use serde::Serialize;

use super::flaw::Flaw;
use super::kept::Silhouette;
use super::silhouette::{Facing, Planes, polygon_edges};
use super::{Aabb, Topology};

/// A mesh in one pose, as its volumes see it.
#[derive(Debug, Clone, Copy)]
pub struct Caster<'a> {
    /// Of the mesh.
    pub topology: &'a Topology,
    /// One position a welded vertex, object space.
    pub welded: &'a [Vec3],
    /// Of the same positions.
    pub planes: &'a Planes,
    /// Of the same positions.
    pub bounds: &'a Aabb,
}

/// What has sides.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outline {
    /// The caster's silhouette: sides where counted triangles end.
    #[default]
    Silhouette,
    /// Each counted triangle by itself (K 6.3): a volume a polygon, three sides each.
    Polygons,
}

/// Which parts of a volume are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
pub struct VolumeParts {
    /// From the silhouette to infinity.
    pub sides: bool,
    /// The caster's own counted triangles.
    pub light_cap: bool,
    /// At infinity, or on the plane where it ends. There is none for directional lights.
    pub dark_cap: bool,
    /// On the plane where a clamped volume starts.
    pub start_cap: bool,
    /// What the sides and the dark cap follow.
    pub outline: Outline,
    /// Far ends are places of their own, for directional lights too, which then have a dark cap.
    pub finite: bool,
}

impl VolumeParts {
    /// Nothing yet.
    pub const NONE: Self =
        Self { sides: false, light_cap: false, dark_cap: false, start_cap: false, outline: Outline::Silhouette, finite: false };
    /// What z-pass counts with.
    pub const SIDES: Self = Self { sides: true, ..Self::NONE };
    /// What z-fail counts with.
    pub const ALL: Self = Self { light_cap: true, dark_cap: true, ..Self::SIDES };
}

/// Where a volume's parts stand among the indices. Parts that were not asked for are empty.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct VolumeIndices {
    /// Counter-clockwise from outside.
    pub sides: Range<u32>,
    /// *Clockwise* from outside: draw with increment and decrement swapped. Of single polygons only.
    pub sides_turned: Range<u32>,
    /// Counter-clockwise from outside, which is the light's side; the mesh's own order.
    pub light_cap_kept: Range<u32>,
    /// *Clockwise* from outside: draw with increment and decrement swapped.
    pub light_cap_turned: Range<u32>,
    /// Counter-clockwise from outside, which is infinity's side.
    pub dark_cap: Range<u32>,
    /// Counter-clockwise from outside, which is the light's side: near vertices, that stand on the plane it starts on.
    pub start_cap: Range<u32>,
}

impl VolumeIndices {
    /// In all parts.
    #[must_use]
    pub fn triangles(&self) -> u32 {
        [&self.sides, &self.sides_turned, &self.light_cap_kept, &self.light_cap_turned, &self.dark_cap, &self.start_cap]
            .iter()
            .map(|part| part.len() as u32)
            .sum::<u32>()
            / 3
    }
}

/// How an index is stored. Two bytes are enough for casters of up to 32768 welded vertices, so that a
/// triangle takes 6 bytes (M section 7) instead of 12.
pub trait VolumeIndex: Copy {
    /// How many vertices it can tell apart.
    const LIMIT: usize;

    /// A vertex's number, which is below [`Self::LIMIT`].
    fn of(vertex: u32) -> Self;
}

impl VolumeIndex for u16 {
    const LIMIT: usize = 1 << 16;

    #[expect(clippy::cast_possible_truncation, reason = "the caller asks LIMIT first")]
    fn of(vertex: u32) -> Self {
        vertex as Self
    }
}

impl VolumeIndex for u32 {
    const LIMIT: usize = 1 << 32;

    fn of(vertex: u32) -> Self {
        vertex
    }
}

/// Memory that volumes are built in, kept from one to the next.
#[derive(Debug, Default)]
pub struct VolumeScratch {
    seen: Silhouette,
    polygons: Vec<[u32; 2]>,
    turned: Vec<[u32; 2]>,
}

impl VolumeScratch {
    /// Who faced the light in the last volume that was given no silhouette.
    #[must_use]
    pub fn facing(&self) -> &Facing {
        self.seen.facing()
    }

    /// The silhouette of the same.
    #[must_use]
    pub fn silhouette(&self) -> &[[u32; 2]] {
        self.seen.edges()
    }

    /// Appends the volume that `caster` and `light` (object space: a point with w = 1, the
    /// direction towards a directional light with w = 0) span to `indices`, which count
    /// 2 V vertices: V welded ones, then V extruded.
    pub fn append<I: VolumeIndex>(
        &mut self,
        caster: Caster,
        light: Vec4,
        parts: VolumeParts,
        indices: &mut Vec<I>,
    ) -> VolumeIndices {
        self.append_with(caster, light, parts, false, indices)
    }

    /// The same of a caster whose silhouette is known.
    pub fn append_seen<I: VolumeIndex>(
        &mut self,
        seen: &Silhouette,
        caster: Caster,
        light: Vec4,
        parts: VolumeParts,
        indices: &mut Vec<I>,
    ) -> VolumeIndices {
        self.append_from(seen, caster, light, (parts, false), indices)
    }

    /// The same, built wrongly in the way that `flaw` says.
    pub fn append_flawed<I: VolumeIndex>(
        &mut self,
        flaw: Flaw,
        caster: Caster,
        light: Vec4,
        parts: VolumeParts,
        indices: &mut Vec<I>,
    ) -> VolumeIndices {
        let Some(topology) = flaw.topology(caster.topology, caster.welded) else {
            return self.append_with(caster, light, parts, flaw == Flaw::FanAcross, indices);
        };
        let mut planes = Planes::default();
        planes.build(&topology, caster.welded);
        self.append_with(Caster { topology: &topology, planes: &planes, ..caster }, light, parts, false, indices)
    }

    fn append_with<I: VolumeIndex>(
        &mut self,
        caster: Caster,
        light: Vec4,
        parts: VolumeParts,
        always_fan: bool,
        indices: &mut Vec<I>,
    ) -> VolumeIndices {
        let mut seen = std::mem::take(&mut self.seen);
        seen.find(caster, light);
        let ranges = self.append_from(&seen, caster, light, (parts, always_fan), indices);
        self.seen = seen;
        ranges
    }

    fn append_from<I: VolumeIndex>(
        &mut self,
        seen: &Silhouette,
        caster: Caster,
        light: Vec4,
        (parts, always_fan): (VolumeParts, bool),
        indices: &mut Vec<I>,
    ) -> VolumeIndices {
        let Caster { topology, welded, .. } = caster;
        let to_one_point = light.w == 0.0 && !parts.finite;
        let dark_cap = parts.dark_cap && !to_one_point;
        self.turned.clear();
        let edges = match parts.outline {
            Outline::Silhouette => seen.edges(),
            Outline::Polygons => {
                if parts.sides || dark_cap {
                    polygon_edges(topology, seen.facing(), &mut self.polygons, &mut self.turned);
                }
                &self.polygons
            }
        };
        let counted = |contribution| counted(topology, seen.facing(), contribution);
        let extruded = |vertex: u32| vertex + topology.weld().len() as u32;

        let mut ranges = VolumeIndices::default();
        let mut start = indices.len();
        let mut since = |indices: &Vec<I>| {
            let range = start as u32..indices.len() as u32;
            start = indices.len();
            range
        };
        if parts.sides {
            for (edges, range) in [(edges, &mut ranges.sides), (self.turned.as_slice(), &mut ranges.sides_turned)] {
                if to_one_point {
                    indices.extend(edges.iter().flat_map(|&[a, b]| [a, extruded(a), b]).map(I::of));
                } else {
                    let quads = edges.iter().flat_map(|&[a, b]| [a, extruded(a), extruded(b), a, extruded(b), b]);
                    indices.extend(quads.map(I::of));
                }
                *range = since(indices);
            }
        }
        if parts.light_cap {
            indices.extend(counted(1).flatten().map(I::of));
            ranges.light_cap_kept = since(indices);
            indices.extend(counted(-1).flatten().map(I::of));
            ranges.light_cap_turned = since(indices);
        }
        if dark_cap || parts.start_cap {
            let narrow =
                || parts.outline == Outline::Silhouette && within_half_space(welded, caster.bounds, light.truncate(), edges);
            let pivot = edges.first().map(|[pivot, _]| *pivot).filter(|_| always_fan || narrow());
            let apart = |pivot: u32| edges.iter().filter(move |edge| !edge.contains(&pivot));
            if dark_cap {
                if let Some(pivot) = pivot {
                    indices.extend(apart(pivot).flat_map(|&[a, b]| [pivot, b, a]).map(extruded).map(I::of));
                } else {
                    indices.extend(counted(1).flat_map(|[a, b, c]| [c, b, a]).map(extruded).map(I::of));
                    indices.extend(counted(-1).flatten().map(extruded).map(I::of));
                }
                ranges.dark_cap = since(indices);
            }
            if parts.start_cap {
                if let Some(pivot) = pivot {
                    indices.extend(apart(pivot).flat_map(|&[a, b]| [pivot, a, b]).map(I::of));
                } else {
                    indices.extend(counted(1).flatten().map(I::of));
                    indices.extend(counted(-1).flat_map(|[a, b, c]| [c, b, a]).map(I::of));
                }
                ranges.start_cap = since(indices);
            }
        }
        ranges
    }
}

fn counted<'a>(topology: &'a Topology, facing: &'a Facing, contribution: i8) -> impl Iterator<Item = [u32; 3]> + use<'a> {
    let counted = topology.triangles().iter().zip(facing.contributions());
    counted.filter(move |(_, counts)| **counts == contribution).map(|(triangle, _)| *triangle)
}

/// Every direction from the light to a vertex lies strictly within one half-space, with a margin
/// wide enough for the rounding of the extruded vertices.
fn within_half_space(welded: &[Vec3], bounds: &Aabb, light: Vec3, edges: &[[u32; 2]]) -> bool {
    if box_within_half_space(bounds, light) {
        return true;
    }
    let light = light.as_dvec3();
    let reach = reach(bounds, light);
    // Within the box there may still be a half-space, about the silhouette's mean direction.
    let towards = |vertex: Vec3| vertex.as_dvec3() - light;
    let sum: DVec3 = edges.iter().map(|edge| towards(welded[edge[0] as usize]).normalize_or_zero()).sum();
    let Some(axis) = sum.try_normalize() else { return false };
    welded.iter().all(|&vertex| {
        let direction = towards(vertex);
        direction.dot(axis) > MARGIN * direction.length() + ROUNDING * reach
    })
}

/// The least cosine to the half-space's axis.
const MARGIN: f64 = 1e-3;
/// Of coordinates.
const ROUNDING: f64 = 1e-6;

/// The same told by a caster's box alone: every point of it, and so all of the caster.
#[must_use]
pub fn box_within_half_space(bounds: &Aabb, light: Vec3) -> bool {
    let light = light.as_dvec3();
    let distance = bounds.distance_to(light);
    distance > MARGIN * (distance + 2.0 * f64::from(bounds.radius())) + ROUNDING * reach(bounds, light)
}

fn reach(bounds: &Aabb, light: DVec3) -> f64 {
    light.abs().max_element().max(bounds.min.abs().max(bounds.max.abs()).max_element().into())
}
