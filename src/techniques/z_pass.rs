//! Z-pass (Heidmann 1991; K section 6, L "Rendering Shadow Volumes", C "Z-Pass Algorithm").
//!
//! From the eye to the surface, faces of shadow volumes are counted: one more where the ray enters
//! a volume, one less where it leaves. A count above zero means the surface is inside.
//!
//! ```text
//!            light *
//!                 / \        caster
//!   eye          /###\
//!    o--------->/-+1--\--1--------> surface: count 0, lit
//!     `--------/+1-----\- - - x     surface inside: count 1, shadow
//! ```
//!
//! It is wrong, on purpose, where the near plane cuts a volume: faces before the near plane are
//! clipped and go uncounted, so an eye that stands in a shadow starts with a wrong count.

use super::{Group, Row};
use crate::frame::stencil::StencilState;
use crate::frame::{Method, Part, Reason};
use crate::geometry::Outline;
use crate::settings::Technique;

pub(super) const ROW: Row = Row {
    technique: Technique::ZPass,
    title: "Z-pass",
    about: "Counts volume faces in front of the surface; wrong where the near plane cuts a volume.",
    exact: false,
    source: "Heidmann 1991; Kilgard 1999, 6; Lengyel 2002, Rendering Shadow Volumes",
    decide: |_| Some((Method::ZPass, Reason::Technique)),
    outline: Outline::Silhouette,
    extrusion: None,
    darkens: None,
    groups: &[GROUPS],
};

pub(super) const GROUPS: &[Group] = &[Group {
    method: Method::ZPass,
    parts: &[Part::Sides, Part::StartCap, Part::EndCap],
    label: "count sides, z-pass",
    why: "Faces before the surface: entering counts up, leaving counts down.",
    stencil: StencilState::count_z_pass,
    ..Group::PLAIN
}];
