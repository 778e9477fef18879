//! ZP+ (Hornus, Hoberock, Lefebvre and Hart 2005, "ZP+: correct z-pass stencil shadows"; named by C).
//!
//! Z-pass lacks what the near plane cuts off. ZP+ lays that first: it looks from the light through
//! the near rectangle, so that the rectangle fills the viewport, and draws the caster's light-facing
//! triangles. Each pixel then holds how many volumes hold the *near point* of its ray, and z-pass of
//! the sides, clipped at the near plane, goes on from there ([`crate::geometry::near_rectangle`]).
//!
//! ```text
//!   count(surface) = light-facing triangles between the light and the near point
//!                  + sides entered - sides left, from the near point to the surface
//! ```
//!
//! The light may stand on either side of the near plane, or infinitely far away; on the plane itself
//! it sees nothing through it, and the caster goes by z-fail. So does one that itself reaches before
//! the near plane, or whose surface may be missing: there the way from the near point may cross the
//! light cap, which z-pass leaves out. Casters that cannot throw their shadow on the near rectangle
//! need plain z-pass only (M 3, case 1, and L's occlusion pyramid).
//!
//! **It cracks.** Where a side passes through the near plane, its border there is the clipper's work
//! on one hand and the rasteriser's of a projected edge on the other: equal on paper, and rounded
//! apart. A pixel on that line may get one and not the other, and is then wrong along its whole ray,
//! on whatever surface it sees. Hornus et al. name this; it cannot be mended without leaving their
//! method, so the technique does not claim to be exact, its cracks are counted by `obscura verify`
//! and by a test, and [`super::exact_z_pass`] is what to use instead: it has no border to disagree on.

use super::{Caster, Group, Row, z_fail, z_pass};
use crate::frame::state::Depth;
use crate::frame::stencil::StencilState;
use crate::frame::{Method, Part, Program, Reason};
use crate::geometry::Outline;
use crate::settings::Technique;

pub(super) const ROW: Row = Row {
    technique: Technique::ZPlus,
    title: "ZP+",
    about: "Z-pass whose near plane is counted first, seen from the light; right but for cracks, single pixels on the near plane's cut.",
    exact: false,
    source: "Hornus et al. 2005; CSCI 4229, Improved methods",
    decide: |caster| Some(decide(caster)),
    outline: Outline::Silhouette,
    extrusion: None,
    darkens: None,
    groups: &[NEAR_PLANE, SIDES, z_pass::GROUPS, z_fail::GROUPS],
};

fn decide(caster: &Caster<'_>) -> (Method, Reason) {
    match z_fail::decide(caster) {
        (Method::ZFail, _) => {}
        by_z_fail => return by_z_fail,
    }
    match caster.view.camera.through_light(caster.light) {
        None => (Method::ZFail, Reason::LightOnNearPlane),
        Some(_) if !caster.may_shadow_near_rectangle() => (Method::ZPass, Reason::NearRectangleClear),
        Some(through) if through.mirrored => (Method::ZPlusMirrored, Reason::OverNearRectangle),
        Some(_) => (Method::ZPlus, Reason::OverNearRectangle),
    }
}

/// Every triangle that the light sees adds one. They are drawn with their faces told apart all the
/// same: one that rounding turned over must take away what it covers twice.
const NEAR_PLANE: &[Group] = &[
    near_plane(Method::ZPlus, Part::LightCapKept),
    near_plane(Method::ZPlus, Part::LightCapTurned),
    near_plane(Method::ZPlusMirrored, Part::LightCapKept),
    near_plane(Method::ZPlusMirrored, Part::LightCapTurned),
];

const SIDES: &[Group] = &[sides(Method::ZPlus), sides(Method::ZPlusMirrored)];

const fn near_plane(method: Method, part: Part) -> Group {
    let turned = matches!(part, Part::LightCapTurned);
    let mirrored = matches!(method, Method::ZPlusMirrored);
    Group {
        method,
        parts: if turned { &[Part::LightCapTurned] } else { &[Part::LightCapKept] },
        label: if turned { "count the near plane, turned, ZP+" } else { "count the near plane, ZP+" },
        why: "Looks from the light through the near rectangle: each pixel gets how many volumes hold its ray where it starts.",
        program: Program::NearPlane,
        stencil: if turned == mirrored { StencilState::count_z_pass } else { StencilState::count_z_pass_turned },
        depth: Depth::IGNORE,
        ..Group::PLAIN
    }
}

const fn sides(method: Method) -> Group {
    Group { method, label: "count sides, ZP+", ..z_pass::GROUPS[0] }
}
