//! Z-fail (Carmack 2000; M section 3; L "Rendering Shadow Volumes").
//!
//! The same count taken from the other end: from infinity towards the eye, faces *behind* the
//! surface are counted, those that fail the depth test. Nothing between the eye and the surface
//! matters, so the near plane cannot spoil it; but now the volume must be closed, with a light cap
//! (the caster's light-facing triangles) and a dark cap (the same, at infinity, or on a plane behind
//! everything: [`crate::geometry::ending`]). The projection has no far plane (DESIGN section 3), so
//! nothing is cut off there either.
//!
//! The light cap lies on the caster's own surface. Where that surface is surely in the depth
//! buffer, no cap fragment can be nearer than what is stored, so the cap is drawn with depth
//! compare Never and counts everywhere. Where it may be missing (culled from behind, masked,
//! before the near plane) the depth test must decide; cap and surface share vertex order and
//! position arithmetic, so that equal depth is equal to the last bit.
//!
//! The dark cap is behind every surface by construction, so it is drawn with Never too. Compared, it
//! would fail wherever a surface is, but for the slivers of its fan: seen edge-on on the plane where a
//! volume ends, their depth is interpolated from next to nothing, and one in a million would pass.

use super::{Caster, Group, Row};
use crate::frame::state::Depth;
use crate::frame::stencil::StencilState;
use crate::frame::{Method, Part, Reason};
use crate::geometry::Outline;
use crate::settings::Technique;

pub(super) const ROW: Row = Row {
    technique: Technique::ZFail,
    title: "Z-fail",
    about: "Counts volume faces behind the surface; exact everywhere, pays for caps.",
    exact: true,
    source: "Carmack 2000; McGuire et al. 2003, 3; Lengyel 2002, Rendering Shadow Volumes",
    decide: |caster| Some(decide(caster)),
    outline: Outline::Silhouette,
    extrusion: None,
    darkens: None,
    groups: &[GROUPS, CUT],
};

pub(super) const GROUPS: &[Group] = &[
    Group {
        method: Method::ZFail,
        parts: &[Part::Sides, Part::StartCap, Part::EndCap],
        label: "count sides, z-fail",
        why: "Faces behind the surface, from infinity towards the eye.",
        stencil: StencilState::count_z_fail,
        ..Group::PLAIN
    },
    Group {
        method: Method::ZFail,
        parts: &[Part::LightCapKept],
        label: "count light caps, z-fail",
        why: "The caster's own surface is in the depth buffer, so its light cap can never be nearer: it counts everywhere.",
        stencil: StencilState::count_z_fail,
        depth: Depth::NEVER,
        ..Group::PLAIN
    },
    Group {
        method: Method::ZFail,
        parts: &[Part::LightCapTurned],
        label: "count turned light caps, z-fail",
        why: "Triangles of open casters that face away from the light cast too: the same order of vertices, the operations swapped.",
        stencil: StencilState::count_z_fail_turned,
        depth: Depth::NEVER,
        ..Group::PLAIN
    },
    Group {
        method: Method::ZFailCompared,
        parts: &[Part::Sides, Part::LightCapKept, Part::StartCap, Part::EndCap],
        label: "count sides and light caps, z-fail, compared",
        why: "The caster's surface may be missing from the depth buffer, so its light cap is compared with depth.",
        stencil: StencilState::count_z_fail,
        ..Group::PLAIN
    },
    Group {
        method: Method::ZFailCompared,
        parts: &[Part::LightCapTurned],
        label: "count turned light caps, z-fail, compared",
        why: "Triangles of open casters turned to face the light: the same order of vertices, the operations swapped.",
        stencil: StencilState::count_z_fail_turned,
        ..Group::PLAIN
    },
    dark_caps(Method::ZFail, DARK_CAPS),
    dark_caps(Method::ZFailCompared, DARK_CAPS),
];

/// Of casters that were cut, which only light off mirrors has.
const CUT: &[Group] = &[
    Group {
        method: Method::ZFailCut,
        parts: &[Part::Sides],
        label: "count sides of what was cut, z-fail",
        why: "Faces behind the surface, from infinity towards the eye.",
        stencil: StencilState::count_z_fail,
        ..Group::PLAIN
    },
    Group {
        method: Method::ZFailCut,
        parts: &[Part::LightCapKept],
        label: "count light caps of what was cut, z-fail",
        why: "Triangles that were cut have other last bits of depth than the surface: pushed back a hair, they count behind it.",
        stencil: StencilState::count_z_fail,
        depth: Depth::NEARER_CUT,
        ..Group::PLAIN
    },
    Group {
        method: Method::ZFailCut,
        parts: &[Part::LightCapTurned],
        label: "count turned light caps of what was cut, z-fail",
        why: "Triangles of open casters turned to face the light: the same order of vertices, the operations swapped.",
        stencil: StencilState::count_z_fail_turned,
        depth: Depth::NEARER_CUT,
        ..Group::PLAIN
    },
    dark_caps(Method::ZFailCut, DARK_CAPS),
];

const DARK_CAPS: Group =
    Group { label: "count dark caps, z-fail", stencil: StencilState::count_z_fail, depth: Depth::NEVER, ..Group::PLAIN };

/// The dark caps of volumes counted by `method`, where they count everywhere as `everywhere` says.
pub(super) const fn dark_caps(method: Method, everywhere: Group) -> Group {
    let why = "Every surface hides the dark cap: it counts everywhere.";
    Group { method, parts: &[Part::DarkCap], why, ..everywhere }
}

/// Z-fail for one caster: how its light cap must be drawn.
pub(super) fn decide(caster: &Caster<'_>) -> (Method, Reason) {
    let compared = if caster.piece.is_whole() { Method::ZFailCompared } else { Method::ZFailCut };
    if caster.reflected.is_some() {
        (Method::ZFailCompared, Reason::BeforeMirror)
    } else if caster.across_near_plane() {
        (compared, Reason::AcrossNearPlane)
    } else if !caster.surface_covers() {
        (compared, Reason::SurfaceMayBeMissing)
    } else {
        (Method::ZFail, Reason::SurfaceCovers)
    }
}
