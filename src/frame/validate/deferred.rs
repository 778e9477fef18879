//! Rules of what is shaded pixel by pixel ([`crate::techniques::deferred`]).

use super::Progress;
use crate::frame::plan::FramePlan;
use crate::frame::state::Depth;
use crate::frame::step::{Draw, DrawSet, Program, Target};

/// Checks a draw that keeps surfaces, marks where a light shines, or shades.
pub(super) fn check(plan: &FramePlan, draw: &Draw, state: &mut Progress) -> Result<(), &'static str> {
    if plan.samples != 1 {
        return Err("what is kept of surfaces has one sample a pixel");
    }
    let writes_stencil = draw.state.stencil.writes();
    match draw.target {
        Target::Geometry => {
            let keeps = matches!(draw.program, Program::Geometry | Program::GeometryMasked);
            if !keeps || !draw.state.depth.write || !matches!(draw.set, DrawSet::Surfaces(_)) || writes_stencil {
                return Err("surfaces are kept with their depth, and nothing else is");
            }
            if state.counting || state.direct {
                return Err("it keeps surfaces after counting began: the count would belong to another");
            }
            // Every pixel is shaded in the end, or filled with the background.
            state.color_set = true;
            state.geometry = Some(0);
        }
        Target::Dark => {
            let bit = draw.constant[0] * 255.0;
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is asked whether it is one")]
            let whole = bit.round() as u8;
            if draw.program != Program::MarkDark && draw.state.color.is_none() {
                return Ok(());
            }
            let marked = state.geometry.ok_or("it marks surfaces that were not kept")?;
            if draw.program != Program::MarkDark || writes_stencil || (bit - f32::from(whole)).abs() > 1e-3 {
                return Err("lights leave a bit each where their shadow is, and nothing else");
            }
            if !whole.is_power_of_two() || marked & whole != 0 {
                return Err("a light's bit is one that no other light has left");
            }
            state.geometry = Some(marked | whole);
        }
        _ => {
            let marked = state.geometry.ok_or("it shades surfaces that were not kept")?;
            if draw.program != Program::Shade || writes_stencil || draw.state.depth != Depth::ANY_SURFACE {
                return Err("pixels are shaded where a surface is, and neither depth nor stencil is written");
            }
            let shade = draw.look.shade;
            #[expect(clippy::cast_precision_loss, reason = "f32 holds whole numbers to 16 million")]
            let shaded = |place: usize, light: usize| draw.constant[place] == light as f32;
            let unmarked = |place: usize| {
                let mut counted = plan.draws().filter(|(_, of)| matches!(of.set, DrawSet::Volumes(_)));
                marked & 1 << place == 0 && counted.any(|(_, of)| of.light.is_some_and(|light| shaded(place, light)))
            };
            let lights = shade.lights.iter().filter(|light| light.is_some()).count();
            if shade.each && (marked == 0 || marked >> lights != 0 || (0..lights).any(unmarked)) {
                return Err("it asks for bits of lights that left none");
            }
            state.direct = true;
        }
    }
    Ok(())
}
