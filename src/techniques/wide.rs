//! Wide counting: z-fail with a float target in the stencil's place, and additive blending in the
//! place of its operations.
//!
//! The stencil counts to 255. A float counts further: every face behind the surface adds +1 or -1,
//! told by the side it is seen from, to one number a sample. What the stencil asks of the depth test
//! (`count where it fails`) blending asks the other way round: draw where it passes, so every depth
//! test of z-fail becomes its contrary, *not nearer* for *nearer*, *always* for *never*. Then one
//! full-screen step writes the verdict into the stencil, where every pass that adds light finds it as
//! usual.
//!
//! R32Float is used where the device blends it: sums of ones are exact to 2^24, in any order. R16Float,
//! which every device blends, is exact to 2048, and *on the way* a sum may be as large as all faces
//! over a pixel, not only as the volumes that hold it. Several samples a pixel have a number each, and
//! the verdict is then read for each sample by itself.
//!
//! Other exact techniques fall back on this one where a single caster's volume could wind around a
//! point more often than the stencil can count (`techniques::overflow`).

use super::counting::{Ask, full_screen};
use super::{Group, Row, z_fail};
use crate::frame::state::{Blend, Depth};
use crate::frame::stencil::{BitBudget, StencilState};
use crate::frame::{Action, Clear, Method, Part, Program, Step, Target};
use crate::geometry::Outline;
use crate::settings::Technique;

pub(super) const ROW: Row = Row {
    technique: Technique::Wide,
    title: "Wide count",
    about: "Z-fail in a float target: adds and subtracts colour instead of stencil, never overflows.",
    exact: true,
    source: "this project; after Carmack 2000 (z-fail) and the counting by blending of hardware without stencil",
    decide: |caster| Some(z_fail::decide(caster)),
    outline: Outline::Silhouette,
    extrusion: None,
    darkens: None,
    groups: &[GROUPS],
};

/// Added where a back face is seen, taken away where a front face is.
const KEPT: [f32; 4] = [1.0, 0.0, 0.0, 0.0];
/// For light caps whose triangles are turned to face the light.
const TURNED: [f32; 4] = [-1.0, 0.0, 0.0, 0.0];

const WIDE: Group = Group {
    program: Program::VolumeNumbers,
    color: Some(Blend::Add),
    target: Target::Counts,
    constant: KEPT,
    depth: Depth::NOT_NEARER,
    stencil: StencilState::within_bounds,
    ..Group::PLAIN
};

const GROUPS: &[Group] = &[
    Group {
        method: Method::ZFail,
        parts: &[Part::Sides],
        label: "add sides",
        why: "Faces that are not nearer than the surface: back faces add one, front faces take one away.",
        ..WIDE
    },
    Group {
        method: Method::ZFail,
        parts: &[Part::LightCapKept],
        label: "add light caps",
        why: "The caster's own surface is in the depth buffer, so its light cap can never be nearer: it counts everywhere.",
        depth: Depth::IGNORE,
        ..WIDE
    },
    Group {
        method: Method::ZFail,
        parts: &[Part::LightCapTurned],
        label: "add turned light caps",
        why: "Triangles of open casters that face away from the light cast too: the same order of vertices, the other sign.",
        depth: Depth::IGNORE,
        constant: TURNED,
        ..WIDE
    },
    Group {
        method: Method::ZFailCompared,
        parts: &[Part::Sides, Part::LightCapKept],
        label: "add sides and light caps, compared",
        why: "The caster's surface may be missing from the depth buffer, so its light cap is compared with depth.",
        ..WIDE
    },
    Group {
        method: Method::ZFailCompared,
        parts: &[Part::LightCapTurned],
        label: "add turned light caps, compared",
        why: "Triangles of open casters turned to face the light: the same order of vertices, the other sign.",
        constant: TURNED,
        ..WIDE
    },
    Group {
        method: Method::ZFailCut,
        parts: &[Part::Sides],
        label: "add sides of what was cut",
        why: "Faces that are not nearer than the surface: back faces add one, front faces take one away.",
        ..WIDE
    },
    Group {
        method: Method::ZFailCut,
        parts: &[Part::LightCapKept],
        label: "add light caps of what was cut",
        why: "Triangles that were cut have other last bits of depth than the surface: pushed back a hair, they count behind it.",
        depth: NOT_NEARER_CUT,
        ..WIDE
    },
    Group {
        method: Method::ZFailCut,
        parts: &[Part::LightCapTurned],
        label: "add turned light caps of what was cut",
        why: "Triangles of open casters turned to face the light: the same order of vertices, the other sign.",
        depth: NOT_NEARER_CUT,
        constant: TURNED,
        ..WIDE
    },
    z_fail::dark_caps(Method::ZFail, DARK_CAPS),
    z_fail::dark_caps(Method::ZFailCompared, DARK_CAPS),
    z_fail::dark_caps(Method::ZFailCut, DARK_CAPS),
];

const NOT_NEARER_CUT: Depth = Depth::NOT_NEARER.with_bias(Depth::NEARER_CUT.bias);

const DARK_CAPS: Group = Group { label: "add dark caps", depth: Depth::IGNORE, ..WIDE };

/// Before the first volume: nothing is counted.
pub(super) fn begin(light: usize) -> Step {
    Step {
        label: format!("light {light}: clear the wide count"),
        why: "Z-fail counts from infinity, where no volume holds anything.".into(),
        view: 0,
        action: Action::Clear(Clear { color: None, depth: None, stencil: None, counts: Some(0.0) }),
    }
}

/// After the last: the verdict into the stencil, or where it is to be shown the count itself, bit by
/// bit, as far as the false colours can tell it from one below zero.
pub(super) fn finish(ask: &Ask) -> Vec<Step> {
    let budget = ask.budget;
    if ask.values {
        let most = most_shown(budget);
        return (0..8)
            .filter(|bit| most >> bit & 1 == 1)
            .map(|bit| {
                let label = format!("light {}: bit {bit} of the wide count", ask.light);
                let why =
                    format!("Sets this bit of the stencil's count where the wide count has it; {most} stands for all above.");
                let mut step = full_screen(label, &why, Program::WideBit, StencilState::set_bit(budget, bit), 1 << bit, ask);
                if let Action::Draw(draw) = &mut step.action {
                    draw.constant = [bit as f32, f32::from(most), 0.0, 0.0];
                }
                step
            })
            .collect();
    }
    let label = format!("light {}: verdict of the wide count", ask.light);
    if budget.is_points() {
        let why = "Where the wide count is not zero the point's own bit is set; elsewhere it stays clear.";
        let program = if ask.samples == 1 { Program::WideVerdict } else { Program::WideVerdictEach };
        return vec![full_screen(label, why, program, StencilState::set_verdict(budget), budget.verdict_mask, ask)];
    }
    let why = "Where the wide count is not zero the stencil's count becomes one; elsewhere it is zero.";
    let program = if ask.samples == 1 { Program::WideVerdict } else { Program::WideVerdictEach };
    vec![full_screen(label, why, program, StencilState::set_count(budget), 1, ask)]
}

/// The largest count that `show stencil` shows: beyond half of a byte it would be taken for negative.
fn most_shown(budget: BitBudget) -> u8 {
    budget.count_mask & 0x7f
}

/// What a field of these bits would make of the wide count, in false colour, for `show overflow`.
pub(crate) fn overflow_colors(ask: &Ask) -> Step {
    let label = format!("light {}: what a field of {} makes of the count", ask.light, ask.budget.largest() + 1);
    let why = "Blue: the field holds the count. Amber: it wraps and is not zero. Red: it wraps to zero, shadow taken for light.";
    let mut step = full_screen(label, why, Program::WideOverflow, StencilState::IGNORE, 0, ask);
    if let Action::Draw(draw) = &mut step.action {
        #[expect(clippy::cast_precision_loss, reason = "256 at most")]
        let field = (ask.budget.largest() + 1) as f32;
        draw.constant = [field, 0.0, 0.0, 0.0];
        draw.state.color = Some(Blend::Over);
    }
    step
}
