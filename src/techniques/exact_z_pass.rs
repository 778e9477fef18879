//! Exact z-pass: z-pass whose count starts from the truth (DESIGN section 4).
//!
//! Z-pass goes wrong because clipping at the near plane loses faces. Here nothing is lost: the
//! sides are drawn under depth clamp (`unclipped_depth`), which keeps what lies between the eye and
//! the near plane, and the stencil starts, not at zero, but at the number of volumes that hold the
//! eye: the light-facing triangles that the segment from light to eye crosses. So each pixel's
//! count is that of the volumes holding its surface, by sides alone, without light or dark cap.
//!
//! ```text
//!   count(surface) = count(eye) + sides entered - sides left, along the ray eye -> surface
//! ```
//!
//! The light cap need not be drawn because a ray that crosses it meets the caster's own surface
//! there, and stops. That is so only if the surface is really drawn: a caster whose surface may be
//! missing from the depth buffer, or that reaches between the eye and the near plane, goes by
//! z-fail and is left out of the eye's count; counts add, so the two mix freely. So does a caster
//! whose volume's boundary the eye lies on, within rounding.
//!
//! Usta et al. (HPG 2019) describe an artefact-free z-pass with the same aim; only its abstract was
//! at hand.

use super::{Caster, Group, Row, z_fail};
use crate::frame::state::NearPlane;
use crate::frame::stencil::StencilState;
use crate::frame::{Method, Part, Reason};
use crate::geometry::Outline;
use crate::settings::Technique;

pub(super) const ROW: Row = Row {
    technique: Technique::ExactZPass,
    title: "Exact z-pass",
    about: "Counts sides from the eye's own count, without caps; exact everywhere, by z-fail where that would not be.",
    exact: true,
    source: "this project; after Heidmann 1991 and Lengyel 2002; aim as in Usta et al. 2019",
    decide: |caster| Some(decide(caster)),
    outline: Outline::Silhouette,
    extrusion: None,
    darkens: None,
    groups: &[GROUPS, z_fail::GROUPS],
};

pub(super) const GROUPS: &[Group] = &[Group {
    method: Method::ExactZPass,
    parts: &[Part::Sides, Part::StartCap, Part::EndCap],
    label: "count sides, exact z-pass",
    why: "Faces before the surface, under depth clamp so that the near plane cuts none off; the stencil starts at the eye's count.",
    stencil: StencilState::count_z_pass,
    near_plane: NearPlane::Clamp,
    ..Group::PLAIN
}];

/// Exact z-pass for one caster, or z-fail where that would not be exact.
pub(super) fn decide(caster: &Caster<'_>) -> (Method, Reason) {
    match z_fail::decide(caster) {
        (by_z_fail, _) if !caster.capabilities.depth_clip_control => (by_z_fail, Reason::NoDepthClamp),
        (Method::ZFail, _) if caster.holds_eye().is_none() => (Method::ZFail, Reason::EyeOnBoundary),
        (Method::ZFail, reason) => (Method::ExactZPass, reason),
        by_z_fail => by_z_fail,
    }
}
