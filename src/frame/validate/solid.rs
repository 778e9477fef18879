//! What holds for a solid's own target: begun, one layer laid, the other operand counted behind it, and only then merged.

use super::Progress;
use crate::frame::state::{Compare, Cull, Depth};
use crate::frame::stencil::StencilState;
use crate::frame::step::{Draw, DrawSet, Program, Target};

/// How far a layer is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum Layer {
    /// Nothing is known of the target.
    #[default]
    None,
    /// Depth is at infinity, all bits are 0.
    Begun,
    /// One layer is laid.
    Laid,
    /// The other operand is counted behind it.
    Counted,
}

/// Checks a step of the target, or one that reads it; `None` where it is neither.
pub(super) fn check(draw: &Draw, samples: u32, state: &mut Progress) -> Option<Result<(), &'static str>> {
    let merges = matches!(draw.program, Program::SolidMerge | Program::SolidMergeEach);
    match (draw.target, merges) {
        (Target::Solid, _) => Some(check_layer(draw, state)),
        (_, true) => Some(check_merge(draw, samples, state)),
        _ => None,
    }
}

fn check_layer(draw: &Draw, state: &mut Progress) -> Result<(), &'static str> {
    let stencil = &draw.state.stencil;
    if draw.state.color.is_some() {
        return Err("a solid's own target has no colour");
    }
    match (&draw.set, state.layer) {
        (DrawSet::FullScreen, _) => {
            if draw.state.depth != Depth::OVERWRITE || *stencil != StencilState::solid_begin() || draw.stencil_reference != 0 {
                return Err("a layer begins with depth at infinity and no bit set");
            }
            state.layer = Layer::Begun;
        }
        (DrawSet::Runs(_), Layer::Begun) => {
            let counts = (1..=8).any(|bits| *stencil == StencilState::solid_layer(bits));
            if !counts || draw.stencil_reference & !stencil.read_mask != 0 || draw.state.depth != Depth::OVERWRITE {
                return Err("a layer is one fragment of each pixel, wherever it lies");
            }
            if draw.state.cull == Cull::None {
                return Err("a layer is of one side");
            }
            state.layer = Layer::Laid;
        }
        (DrawSet::Runs(_), Layer::Laid | Layer::Counted) => {
            if *stencil != StencilState::solid_parity() || draw.state.depth != Depth::NEARER || draw.state.cull != Cull::None {
                return Err("the other operand is counted behind a layer by both its sides");
            }
            state.layer = Layer::Counted;
        }
        _ => return Err("it draws into a solid's own target out of turn"),
    }
    Ok(())
}

fn check_merge(draw: &Draw, samples: u32, state: &mut Progress) -> Result<(), &'static str> {
    if state.layer != Layer::Counted {
        return Err("it merges a layer that was not counted");
    }
    if !(state.color_set && state.depth_set) || draw.target != Target::Scene || state.output_begun || state.direct {
        return Err("a solid is merged into the scene's depth, once that is there and before the picture");
    }
    if state.counting {
        return Err("it writes depth after counting began: the count would belong to another surface");
    }
    if draw.state.stencil.writes() || draw.state.depth.compare != Compare::Greater || !draw.state.depth.write {
        return Err("of layers the nearest is kept, and nothing else changes");
    }
    if (draw.program == Program::SolidMergeEach) != (samples != 1) {
        return Err("it merges layers of another number of samples");
    }
    state.layer = Layer::None;
    Ok(())
}
