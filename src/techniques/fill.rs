//! Fill: how many fragments the rasteriser makes of shadow volumes, which is most of what they cost.
//!
//! Counted, not estimated: a plan's volumes are drawn once more by themselves, each within its own scissor and by its own
//! culling, clipping and winding, and every fragment adds one to a float target. Depth and stencil tests let all of
//! them through, for a fragment that fails them has been made as well. Statistics of the device would tell the same,
//! but a software GPU's count whole blocks of pixels.

use crate::frame::state::{Blend, Depth, State};
use crate::frame::stencil::StencilState;
use crate::frame::{Action, Clear, Draw, DrawSet, FramePlan, Program, Step, Target};

/// The plan that counts the fragments of another one's volumes in [`Target::Counts`], one sample a pixel; none where
/// that one draws no volumes.
#[must_use]
pub fn counted(plan: &FramePlan) -> Option<FramePlan> {
    let clear = Step {
        label: "clear the count of fragments".into(),
        why: "No fragment was counted yet.".into(),
        view: 0,
        action: Action::Clear(Clear { color: None, depth: None, stencil: None, counts: Some(0.0) }),
    };
    let volumes = plan.draws().filter(|(_, draw)| matches!(draw.set, DrawSet::Volumes(_)));
    let steps: Vec<_> = [clear].into_iter().chain(volumes.map(|(step, draw)| counting(step, draw))).collect();
    (steps.len() > 1).then(|| FramePlan { steps, samples: 1, gather: None, ..plan.clone() })
}

/// One for each fragment of a step's volumes.
fn counting(step: &Step, draw: &Draw) -> Step {
    let thrown = matches!(draw.program, Program::NearPlane | Program::Projected);
    let draw = Draw {
        program: if thrown { Program::Projected } else { Program::VolumeFill },
        target: Target::Counts,
        state: State { depth: Depth::IGNORE, stencil: StencilState::IGNORE, color: Some(Blend::Add), ..draw.state },
        stencil_reference: 0,
        constant: [1.0, 0.0, 0.0, 1.0],
        ..draw.clone()
    };
    let label = format!("fragments of: {}", step.label);
    let why = "Adds one for each fragment, whatever depth and stencil would make of it.".into();
    Step { label, why, view: step.view, action: Action::Draw(Box::new(draw)) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;
    use crate::director;
    use crate::frame::Capabilities;
    use crate::scene::stock;
    use crate::settings::{Settings, Technique};

    #[test]
    fn every_volume_is_counted_as_it_is_drawn_and_nothing_else_is() {
        let scene = stock::build("barbershop").unwrap().unwrap();
        for technique in Technique::ALL {
            let settings = Settings { technique, ..Settings::default() };
            let (_, plan) = director::stage(&settings, &scene, &Capabilities::complete()).unwrap();
            let volumes: Vec<_> = plan.draws().filter(|(_, draw)| matches!(draw.set, DrawSet::Volumes(_))).collect();
            let Some(counting) = counted(&plan) else {
                assert!(volumes.is_empty(), "{technique:?}");
                continue;
            };
            assert!(!volumes.is_empty() && counting.draws().count() == volumes.len(), "{technique:?}");
            for ((step, draw), (of_step, of)) in counting.draws().zip(volumes) {
                assert_eq!((step.view, &draw.set, draw.scissor), (of_step.view, &of.set, of.scissor));
                assert_eq!((draw.target, draw.state.color, draw.constant[0]), (Target::Counts, Some(Blend::Add), 1.0));
                assert_eq!((draw.state.cull, draw.state.winding), (of.state.cull, of.state.winding));
                assert_eq!(draw.state.near_plane, of.state.near_plane);
            }
        }
    }
}
