//! Parity (K 6.1): one bit, turned over by every face.
//!
//! Every face of a volume's boundary before the surface inverts one stencil bit, whether it is
//! entered or left; an odd number of faces means that the surface is inside. It needs one bit and one
//! operation that all hardware has, and faces need not be told apart.
//!
//! ```text
//!   eye o----|----------|-----> odd, even: lit          one volume, or volumes apart
//!   eye o----|----|-----x       even, though inside two: lit, wrongly
//! ```
//!
//! K asks for a boundary that cuts space cleanly into inside and outside. Volumes here are one a
//! caster and may overlap; where a point lies in two of them the bit is even again, and the light
//! falls into the shadow. K's text is kept to also in that faces are counted from the eye (z-pass):
//! with the eye in a shadow, light and shadow change places. Both faults are the technique's own.

use super::{Group, Row};
use crate::frame::stencil::StencilState;
use crate::frame::{Method, Part, Reason};
use crate::geometry::Outline;
use crate::settings::Technique;

pub(super) const ROW: Row = Row {
    technique: Technique::Parity,
    title: "Parity",
    about: "Turns one bit over at every face before the surface; wrong where volumes overlap, and with the eye in a shadow.",
    exact: false,
    source: "Kilgard 1999, 6.1",
    decide: |_| Some((Method::ZPass, Reason::Technique)),
    outline: Outline::Silhouette,
    extrusion: None,
    darkens: None,
    groups: &[GROUPS],
};

const GROUPS: &[Group] = &[Group {
    method: Method::ZPass,
    parts: &[Part::Sides],
    label: "invert one bit at sides, parity",
    why: "Every face before the surface turns the bit over: odd is inside, as long as no two volumes overlap.",
    stencil: StencilState::invert_z_pass,
    ..Group::PLAIN
}];
