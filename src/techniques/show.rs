//! Steps that show what is otherwise unseen, and the last one of every frame: the picture itself.

use crate::frame::plan::VolumePlan;
use crate::frame::state::{Blend, Depth, State, Winding};
use crate::frame::stencil::{BitBudget, StencilState};
use crate::frame::{Action, Draw, DrawSet, Gather, List, Method, Part, Program, Step, Target, VolumePart};

/// One light's volumes as coloured glass over the picture (M image 2): those of the eye's own view.
#[must_use]
pub fn volumes(plans: &[VolumePlan], light: usize, scissor: [u32; 4]) -> Vec<Step> {
    let mut steps = Vec::new();
    for winding in [Winding::Ccw, Winding::Cw] {
        let parts: List<_> = plans
            .iter()
            .enumerate()
            .filter(|(_, plan)| {
                plan.view == 0
                    && plan.light == light
                    && !matches!(plan.method, Method::Dropped | Method::Projected)
                    && plan.winding == winding
            })
            .flat_map(|(volume, _)| {
                [Part::Sides, Part::LightCapKept, Part::LightCapTurned].map(|part| VolumePart::whole(volume, part))
            })
            .collect();
        if parts.is_empty() {
            continue;
        }
        let why = "Shows where the light's shadow volumes run: every layer of glass is one face the eye looks through.";
        let draw = Draw {
            state: State { depth: Depth::NEARER, color: Some(Blend::Over), winding, ..State::FLAT },
            light: Some(light),
            constant: [0.45, 0.16, 0.75, 0.11],
            ..Draw::plain(Program::VolumeGlass, DrawSet::Volumes(parts), scissor)
        };
        steps.push(Step::drawing(format!("light {light}: volumes as glass"), why, draw));
    }
    steps
}

/// Darkens the lit picture where a caster's count is not zero, and sets the count back (B).
#[must_use]
pub fn dark(light: usize, color: [f32; 4], budget: BitBudget, scissor: [u32; 4]) -> Step {
    let why = "A dark quad over all pixels whose count is not zero; it sets the count back for the next caster.";
    let draw = Draw {
        state: State { stencil: StencilState::reset_where_counted(budget), color: Some(Blend::Over), ..State::FLAT },
        light: Some(light),
        constant: color,
        ..Draw::plain(Program::Dark, DrawSet::FullScreen, scissor)
    };
    Step::drawing(format!("light {light}: darken"), why, draw)
}

/// Every triangle's edges.
#[must_use]
pub fn wireframe(instances: usize, scissor: [u32; 4]) -> Step {
    let why = "Draws every triangle's edges, pulled a hair towards the eye so that their own surface does not hide them.";
    let draw = Draw {
        state: State { depth: Depth::ON_OR_NEARER, color: Some(Blend::Over), ..State::FLAT },
        constant: [0.85, 0.95, 1.0, 0.55],
        ..Draw::plain(Program::Wireframe, DrawSet::Edges((0..instances).collect()), scissor)
    };
    Step::drawing("wireframe", why, draw)
}

/// One light's count in false colour, with a legend; or, where `points_mask` is not zero, how many of these bits
/// are set: of how many of its points the pixel is in the shadow.
#[must_use]
pub fn stencil_colors(budget: BitBudget, points_mask: u8, scissor: [u32; 4]) -> Step {
    let mut step = full_screen(
        "stencil in false colour",
        "Reads the stencil and gives each count a colour; the legend names them.",
        Program::StencilColors,
        scissor,
    );
    if let Action::Draw(draw) = &mut step.action {
        // Beyond the light's bounds nothing is counted. Receivers' values are what is shown, where no count is.
        let receivers = if budget.verdict_mask == 0 { 0 } else { budget.receiver_mask };
        draw.constant = [f32::from(budget.beyond()), f32::from(points_mask), f32::from(budget.mirror_mask | receivers), 0.0];
    }
    step
}

/// Background, exposure and tone curve: linear light becomes the picture.
#[must_use]
pub fn tone_map(scissor: [u32; 4]) -> Step {
    full_screen(
        "tone map",
        "Fills in the background, exposure and tone curve: linear light becomes the picture.",
        Program::ToneMap,
        scissor,
    )
}

/// The gradient where no surface is, for frames whose surfaces are drawn in their final colour.
#[must_use]
pub fn background(scissor: [u32; 4]) -> Step {
    let mut step = full_screen(
        "background",
        "Fills in the background, through the tone curve, where depth is still at infinity.",
        Program::Background,
        scissor,
    );
    if let Action::Draw(draw) = &mut step.action {
        draw.target = Target::Direct;
        draw.state.depth = Depth::SAME_SURFACE;
    }
    step
}

/// Display values as they are, for pictures that other programs read.
#[must_use]
pub fn copy(scissor: [u32; 4]) -> Step {
    full_screen("copy", "Values go to the picture as they are, for other programs to read.", Program::Copy, scissor)
}

/// The frame joins the mean of those before it.
#[must_use]
pub fn gather(gather: Gather, scissor: [u32; 4]) -> Step {
    let mut step = full_screen(
        &format!("gather frame {} of {}", gather.frame + 1, gather.frames),
        "Joins the mean of the frames before it, in 32-bit floats: more points of every light with a size, and of every pixel.",
        Program::Gather,
        scissor,
    );
    if let Action::Draw(draw) = &mut step.action {
        draw.target = Target::Mean;
        // The weight that this frame has in the mean.
        #[expect(clippy::cast_precision_loss, reason = "at most a thousand")]
        let weight = 1.0 / (gather.frame + 1) as f32;
        draw.constant = [weight, 0.0, 0.0, 0.0];
    }
    step
}

fn full_screen(label: &str, why: &str, program: Program, scissor: [u32; 4]) -> Step {
    let draw = Draw {
        target: Target::Output,
        state: State { color: Some(Blend::Replace), ..State::FLAT },
        ..Draw::plain(program, DrawSet::FullScreen, scissor)
    };
    Step::drawing(label, why, draw)
}
