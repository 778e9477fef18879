//! Z-fail for hardware without two-sided stencil (K 6.3; L "Rendering Shadow Volumes"; C "Z-Fail
//! Algorithm").
//!
//! One draw has one set of stencil operations, whichever way a face looks. So volumes are drawn
//! twice: once without their fronts, counting up, and once without their backs, counting down. Every
//! vertex is transformed twice: the same faces meet the same depths as in two-sided
//! [`super::z_fail`], in another order. Counting wraps, so the order is nothing to the sum, and every
//! pixel's count is z-fail's.
//!
//! The papers leave faces out by culling. That is only as exact as the driver's culling agrees with
//! its rasteriser about slivers, and lavapipe (Mesa 22.3) does not: what it clips it culls by the
//! triangle's area before vertices are moved to the subpixel grid, and again by the area after, so
//! that a sliver which turns over in between is culled both times (measured: 1 pixel of 22,400 in one
//! of six views). So the fragment shader leaves faces out, by the facing that the rasteriser gives it.
//!
//! Hardware of K's time clamped instead of wrapping: there the raising pass has to come first, which
//! is why it does here.

use super::{Group, Row, z_fail};
use crate::frame::Program;
use crate::frame::stencil::{BitBudget, StencilState};
use crate::geometry::Outline;
use crate::settings::Technique;

pub(super) const ROW: Row = Row {
    technique: Technique::OneSided,
    title: "One-sided z-fail",
    about: "Z-fail in two passes, backs up and fronts down, as for hardware without two-sided stencil; exact, at twice the vertices.",
    exact: true,
    source: "Kilgard 1999, 6.3; Lengyel 2002, Rendering Shadow Volumes; CSCI 4229, Z-Fail Algorithm",
    decide: |caster| Some(z_fail::decide(caster)),
    outline: Outline::Silhouette,
    extrusion: None,
    darkens: None,
    groups: &[RAISING, LOWERING],
};

/// Straight parts raise with their backs, turned ones with their fronts.
const RAISING: &[Group] = &[
    half(0, Program::VolumeBacks, StencilState::raise_behind),
    half(1, Program::VolumeBacks, StencilState::raise_behind),
    half(2, Program::VolumeFronts, StencilState::raise_behind),
    half(3, Program::VolumeBacks, StencilState::raise_behind),
    half(4, Program::VolumeFronts, StencilState::raise_behind),
    half(5, Program::VolumeBacks, StencilState::raise_behind),
    half(6, Program::VolumeBacks, StencilState::raise_behind),
];

const LOWERING: &[Group] = &[
    half(0, Program::VolumeFronts, StencilState::lower_behind),
    half(1, Program::VolumeFronts, StencilState::lower_behind),
    half(2, Program::VolumeBacks, StencilState::lower_behind),
    half(3, Program::VolumeFronts, StencilState::lower_behind),
    half(4, Program::VolumeBacks, StencilState::lower_behind),
    half(5, Program::VolumeFronts, StencilState::lower_behind),
    half(6, Program::VolumeFronts, StencilState::lower_behind),
];

/// One of z-fail's groups, of one face only.
const fn half(of: usize, program: Program, stencil: fn(BitBudget) -> StencilState) -> Group {
    Group { program, stencil, ..z_fail::GROUPS[of] }
}
