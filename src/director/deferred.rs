//! Frames whose surfaces are drawn once, and whose lights draw pixels ([`crate::techniques::deferred`]).

use super::Frame;
use crate::frame::stencil::StencilState;
use crate::frame::{Clear, LightShape, SHADED_TOGETHER, Step, Target};
use crate::settings::Shading;
use crate::techniques::deferred::{self, mark, shade};
use crate::techniques::own_bits::{Round, Shining};
use crate::techniques::show;
use crate::techniques::surfaces::SurfaceGroup;

/// From so many triangles on one light is cheaper by pixels than by drawing them three times (measured on a software
/// device: README).
const MANY_TRIANGLES: usize = 20_000;

impl Frame<'_> {
    /// Whether lights draw pixels in this frame, which needs no accumulation and has nothing blended; says why not where
    /// that was asked for.
    pub(super) fn defers(&mut self, rounds: &[Round], groups: &[SurfaceGroup], direct: bool) -> bool {
        let lights = rounds.iter().map(|round| round.lights.len()).sum::<usize>();
        let asked = self.settings.lighting.shading;
        let refusal = if !direct {
            Some("it is for frames of 1 sample, drawn at once, with nothing blended, darkened, dissolved or glowing")
        } else if lights > SHADED_TOGETHER {
            Some("it shades up to four lights together, and there are more")
        } else if self.view().camera.far.is_some() {
            Some("it finds places by a depth without a far plane")
        } else {
            deferred::refusal(self.scene, groups)
        };
        match (asked, refusal) {
            (Shading::Forward, _) => false,
            (Shading::Early, _) => {
                if !direct || lights > 1 {
                    let why = "it is for frames of one light and 1 sample, drawn at once, with nothing blended, darkened, dissolved or glowing";
                    self.plan.notes.push(format!("no early shading here: {why}"));
                }
                false
            }
            (Shading::Auto, Some(_)) => false,
            (Shading::Auto, None) => lights > 1 || deferred::triangles(self.scene, &self.outlook.nodes, groups) >= MANY_TRIANGLES,
            (Shading::Deferred, None) => true,
            (Shading::Deferred, Some(why)) => {
                self.plan.notes.push(format!("no deferred shading here: {why}"));
                false
            }
        }
    }

    /// The frame of up to four lights: surfaces once, then the count and a mark for each light, then every pixel once.
    pub(super) fn draw_deferred(&mut self, rounds: Vec<Round>, groups: &[SurfaceGroup]) {
        let whole = self.whole();
        let shape_of = |light: usize| -> (usize, LightShape) { (light, (&self.pose.lights[light]).into()) };
        let lights: Vec<_> = rounds.iter().flat_map(|round| &round.lights).map(|shining| shape_of(shining.light)).collect();
        let stencil = rounds.first().map_or(0, |round| round.base);
        let why =
            "Depth to infinity (0, reverse-Z), the stencil to how many volumes of the light that is counted first hold the eye.";
        self.clear("clear".into(), why, Clear { color: None, depth: Some(0.0), stencil: Some(stencil), counts: None });
        (self.stored, self.used) = (stencil, 0);
        self.extend(deferred::geometry(groups, whole));
        let each = lights.len() > 1 && rounds.iter().flat_map(|round| &round.lights).any(|shining| shining.budget.is_some());
        // Volumes draw no colour: with several lights they are counted where the marks go, so that it is one pass.
        let counted = if each { Target::Dark } else { Target::Direct };
        let mut place = 0;
        let mut dark = None;
        for round in rounds {
            self.start_round(&round);
            let within = round.counted_within().unwrap_or(whole);
            for step in round.steps {
                self.push(Step { action: step.action.onto(counted), ..step });
            }
            for Shining { light, budget, .. } in round.lights {
                if let Some(budget) = budget.filter(|_| each) {
                    self.push(mark(light, place, budget, within));
                }
                dark = budget.map(|budget| (budget, within));
                place += 1;
            }
        }
        let shading = deferred::Shading { groups, lights: &lights, each };
        match dark.filter(|_| !each) {
            Some((budget, within)) => {
                let words = (
                    "shade: lit",
                    "Ambient light and the light, through the tone curve, where no volume holds the pixel's surface.",
                );
                self.push(shade(&shading, words, StencilState::count_equals(budget), whole, self.scene));
                let words =
                    ("shade: shadow", "Ambient light alone, through the tone curve, where a volume holds the pixel's surface.");
                let unlit = deferred::Shading { lights: &[], ..shading };
                self.push(shade(&unlit, words, StencilState::count_differs(budget), within, self.scene));
            }
            None => {
                let words =
                    ("shade", "Ambient light and every light but where it left its bit, through the tone curve, pixel by pixel.");
                self.push(shade(&shading, words, StencilState::IGNORE, whole, self.scene));
            }
        }
        self.push(show::background(whole));
    }
}
