//! Beam's tutorial of 2004, with the look it had (B "Shadow Volumes", "Stencil Operations and Rendering").
//!
//! A volume for each polygon, with everything that made it work at the time, and the marks this
//! leaves:
//!
//! - far ends are not at infinity but [`EXTRUSION`] metres from the light, in the direction of each
//!   vertex: what is farther away stays lit, and shadows of casters beyond it run backwards;
//! - a polygon offset pushes volumes back by [`OFFSET`] steps of depth, to keep light caps off their own
//!   surface: shadows start a hair late;
//! - one-sided operations that clamp, backs counted first, fronts after;
//! - light is never taken away: the whole picture is lit, and then darkened by a full-screen quad
//!   where the count is not zero, which sets the count back. So shadowed surfaces keep half of
//!   *every* light, highlights and all, where two shadows overlap it is darker than in one, and a
//!   lamp's shadow goes on darkening where its light has ended.
//!
//! The far ends are compared with depth, where z-fail's dark cap is not: one that ends at 50 m may well lie
//! before a surface, and that it does is part of the look.
//!
//! B draws the quad after each polygon; here it is drawn after each caster, which for convex casters, B's
//! cubes, is the same picture, and does not cover the screen a thousand times for a sphere.

use super::{Group, Row};
use crate::frame::state::{Depth, DepthBias};
use crate::frame::stencil::{BitBudget, StencilState};
use crate::frame::{Method, Part, Program, Reason};
use crate::geometry::Outline;
use crate::settings::Technique;

/// B's `M_INFINITY`, metres from the light.
pub const EXTRUSION: f64 = 50.0;
/// B's `glPolygonOffset(0, 100)`: the depth format's least steps, away from the eye.
pub const OFFSET: i32 = 100;
/// What is laid over shadows: black, by half. The article does not say; this is near its picture.
const DARK: [f32; 4] = [0.0, 0.0, 0.0, 0.5];

pub(super) const ROW: Row = Row {
    technique: Technique::Beam,
    title: "Per polygon, as in 2004",
    about: "A volume for each polygon that ends 50 m from the light, offset in depth, and a dark quad over the lit picture where the count is not zero.",
    exact: false,
    source: "Beam 2004, Shadow Volumes; Stencil Operations and Rendering",
    decide: |_| Some((Method::ZFailCompared, Reason::Technique)),
    outline: Outline::Polygons,
    extrusion: Some(EXTRUSION),
    darkens: Some(DARK),
    groups: &[RAISING, LOWERING],
};

const STRAIGHT: &[Part] = &[Part::Sides, Part::DarkCap, Part::LightCapKept];
const TURNED: &[Part] = &[Part::SidesTurned, Part::LightCapTurned];

const RAISING: &[Group] = &[
    group(STRAIGHT, Program::VolumeBacks, StencilState::raise_behind_clamped),
    group(TURNED, Program::VolumeFronts, StencilState::raise_behind_clamped),
];

const LOWERING: &[Group] = &[
    group(STRAIGHT, Program::VolumeFronts, StencilState::lower_behind_clamped),
    group(TURNED, Program::VolumeBacks, StencilState::lower_behind_clamped),
];

const fn group(parts: &'static [Part], program: Program, stencil: fn(BitBudget) -> StencilState) -> Group {
    Group {
        method: Method::ZFailCompared,
        parts,
        label: "count polygons' volumes, clamped",
        why: "One face at a time behind the surface, clamped at zero, pushed back by the polygon offset.",
        program,
        stencil,
        // Reverse-Z: back is less.
        depth: Depth::NEARER.with_bias(DepthBias { constant: -OFFSET, slope: 0 }),
        ..Group::PLAIN
    }
}
