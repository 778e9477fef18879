//! How a finished plan is spoiled: pure changes of plain data, one function a failure.

use crate::frame::state::{Compare, Depth, DepthBias, NearPlane};
use crate::frame::stencil::{StencilFace, StencilOp};
use crate::frame::validate::Rule;
use crate::frame::{Action, Draw, DrawSet, FramePlan, Method, Part, Program, VolumePart};
use crate::geometry::Flaw;

/// The technique that counts, or the count that overflows, is the failure; the plan is as it was made.
pub(super) fn nothing(_: &mut FramePlan) {}

/// The draws that count volumes.
fn counting(plan: &mut FramePlan) -> impl Iterator<Item = &mut Draw> {
    plan.steps.iter_mut().filter_map(|step| match &mut step.action {
        Action::Draw(draw) if matches!(draw.set, DrawSet::Volumes(_)) && draw.state.stencil.writes() => Some(&mut **draw),
        _ => None,
    })
}

/// Exact z-pass without its depth clamp: faces before the near plane are lost again.
pub(super) fn clip_at_near_plane(plan: &mut FramePlan) {
    counting(plan).for_each(|draw| draw.state.near_plane = NearPlane::Clip);
    plan.breaks = Some(Rule::ExactZPassClamps);
}

/// A far plane not far behind what is looked at, and volumes without end. One that the settings ask for
/// stays where it is.
pub(super) fn put_far_plane(plan: &mut FramePlan) {
    /// Times the distance of the camera's point of interest.
    const BEHIND: f64 = 2.0;
    for view in &mut plan.views {
        let camera = &mut view.camera;
        camera.far = camera.far.or(Some((camera.focus_distance * BEHIND).max(camera.near * 2.0)));
    }
    plan.volumes.iter_mut().for_each(|volume| volume.end = None);
}

/// Nothing closes the volumes towards the light.
pub(super) fn drop_light_caps(plan: &mut FramePlan) {
    drop_parts(plan, |part| matches!(part, Part::LightCapKept | Part::LightCapTurned));
}

/// Nothing closes them away from it.
pub(super) fn drop_dark_caps(plan: &mut FramePlan) {
    drop_parts(plan, |part| part == Part::DarkCap);
}

fn drop_parts(plan: &mut FramePlan, dropped: fn(Part) -> bool) {
    for draw in counting(plan) {
        if let DrawSet::Volumes(parts) = &mut draw.set {
            *parts = parts.iter().copied().filter(|part| !dropped(part.part)).collect();
        }
    }
    let empty = |draw: &Draw| matches!(&draw.set, DrawSet::Volumes(parts) if parts.is_empty());
    plan.steps.retain(|step| !matches!(&step.action, Action::Draw(draw) if empty(draw)));
}

/// Counting stops at 0 and 255 instead of going round.
pub(super) fn clamp_counts(plan: &mut FramePlan) {
    let clamped = |op| match op {
        StencilOp::IncrementWrap => StencilOp::IncrementClamp,
        StencilOp::DecrementWrap => StencilOp::DecrementClamp,
        other => other,
    };
    let face = |face: &mut StencilFace| {
        for op in [&mut face.fail, &mut face.depth_fail, &mut face.pass] {
            *op = clamped(*op);
        }
    };
    for draw in counting(plan) {
        face(&mut draw.state.stencil.front);
        face(&mut draw.state.stencil.back);
    }
}

/// The volumes' vertices by another program than the surfaces', and light caps that are compared with
/// the surface they lie on.
pub(super) fn mismatch(plan: &mut FramePlan) {
    compare_light_caps(plan);
    for draw in counting(plan) {
        draw.program = Program::VolumeMismatched;
    }
}

/// Volumes nearer to the eye than they are.
pub(super) fn offset(plan: &mut FramePlan) {
    const BIAS: DepthBias = DepthBias { constant: 0, slope: -60 };
    for draw in counting(plan) {
        draw.state.depth = draw.state.depth.with_bias(BIAS);
    }
}

/// Light caps by depth compare, as everybody drew them: right as long as cap and surface share their
/// depth to the last bit.
fn compare_light_caps(plan: &mut FramePlan) {
    for draw in counting(plan) {
        let dark = |part: &VolumePart| part.part == Part::DarkCap;
        let dark = matches!(&draw.set, DrawSet::Volumes(parts) if parts.iter().any(dark));
        if draw.state.depth.compare == Compare::Never && !dark {
            draw.state.depth = Depth::NEARER;
        }
    }
    for volume in plan.volumes.iter_mut().filter(|volume| volume.method == Method::ZFail) {
        volume.method = Method::ZFailCompared;
    }
}

/// By the rules for closed meshes.
pub(super) fn assume_closed(plan: &mut FramePlan) {
    build_wrongly(plan, Flaw::AssumedClosed);
}

/// With T-junctions where the surface has none.
pub(super) fn forget_vertices(plan: &mut FramePlan) {
    build_wrongly(plan, Flaw::TJunctions);
}

/// From fewer triangles.
pub(super) fn coarsen(plan: &mut FramePlan) {
    build_wrongly(plan, Flaw::Coarser);
}

/// With a fan for a dark cap, whatever the silhouette.
pub(super) fn fan_across(plan: &mut FramePlan) {
    build_wrongly(plan, Flaw::FanAcross);
}

fn build_wrongly(plan: &mut FramePlan, flaw: Flaw) {
    plan.volumes.iter_mut().for_each(|volume| volume.flaw = Some(flaw));
}
