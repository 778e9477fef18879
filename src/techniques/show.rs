//! Steps that show what is otherwise unseen, and the last one of every frame: the picture itself.

use crate::frame::plan::VolumePlan;
use crate::frame::state::{Blend, Cull, Depth, NearPlane, State, Winding};
use crate::frame::stencil::{BitBudget, StencilState};
use crate::frame::{Action, Draw, DrawSet, Gather, Look, Method, Part, Program, Step, Target, VolumePart};

/// One light's volumes as coloured glass over the picture (M image 2).
#[must_use]
pub fn volumes(plans: &[VolumePlan], light: usize, scissor: [u32; 4]) -> Vec<Step> {
    let mut steps = Vec::new();
    for winding in [Winding::Ccw, Winding::Cw] {
        let parts: Vec<_> = plans
            .iter()
            .enumerate()
            .filter(|(_, plan)| plan.light == light && plan.method != Method::Dropped && plan.winding == winding)
            .flat_map(|(volume, _)| {
                [Part::Sides, Part::LightCapKept, Part::LightCapTurned].map(|part| VolumePart { volume, part })
            })
            .collect();
        if parts.is_empty() {
            continue;
        }
        steps.push(Step {
            label: format!("light {light}: volumes as glass"),
            why: "Shows where the light's shadow volumes run: every layer of glass is one face the eye looks through.".into(),
            view: 0,
            action: Action::Draw(Box::new(Draw {
                program: Program::VolumeGlass,
                look: Look::default(),
                target: Target::Scene,
                state: State {
                    depth: Depth::NEARER,
                    stencil: StencilState::IGNORE,
                    color: Some(Blend::Over),
                    cull: Cull::None,
                    winding,
                    near_plane: NearPlane::Clip,
                },
                stencil_reference: 0,
                scissor,
                light: Some(light),
                constant: [0.45, 0.16, 0.75, 0.11],
                set: DrawSet::Volumes(parts),
            })),
        });
    }
    steps
}

/// Darkens the lit picture where a caster's count is not zero, and sets the count back (B).
#[must_use]
pub fn dark(light: usize, color: [f32; 4], budget: BitBudget, scissor: [u32; 4]) -> Step {
    Step {
        label: format!("light {light}: darken"),
        why: "A dark quad over all pixels whose count is not zero; it sets the count back for the next caster.".into(),
        view: 0,
        action: Action::Draw(Box::new(Draw {
            program: Program::Dark,
            look: Look::default(),
            target: Target::Scene,
            state: State {
                depth: Depth::IGNORE,
                stencil: StencilState::reset_where_counted(budget),
                color: Some(Blend::Over),
                cull: Cull::None,
                winding: Winding::Ccw,
                near_plane: NearPlane::Clip,
            },
            stencil_reference: 0,
            scissor,
            light: Some(light),
            constant: color,
            set: DrawSet::FullScreen,
        })),
    }
}

/// Every triangle's edges.
#[must_use]
pub fn wireframe(instances: usize, scissor: [u32; 4]) -> Step {
    Step {
        label: "wireframe".into(),
        why: "Draws every triangle's edges, pulled a hair towards the eye so that their own surface does not hide them.".into(),
        view: 0,
        action: Action::Draw(Box::new(Draw {
            program: Program::Wireframe,
            look: Look::default(),
            target: Target::Scene,
            state: State {
                depth: Depth::ON_OR_NEARER,
                stencil: StencilState::IGNORE,
                color: Some(Blend::Over),
                cull: Cull::None,
                winding: Winding::Ccw,
                near_plane: NearPlane::Clip,
            },
            stencil_reference: 0,
            scissor,
            light: None,
            constant: [0.85, 0.95, 1.0, 0.55],
            set: DrawSet::Edges((0..instances).collect()),
        })),
    }
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
        // Beyond the light's bounds nothing is counted.
        draw.constant = [f32::from(budget.beyond()), f32::from(points_mask), 0.0, 0.0];
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
    Step {
        label: label.into(),
        why: why.into(),
        view: 0,
        action: Action::Draw(Box::new(Draw {
            program,
            look: Look::default(),
            target: Target::Output,
            state: State {
                depth: Depth::IGNORE,
                stencil: StencilState::IGNORE,
                color: Some(Blend::Replace),
                cull: Cull::None,
                winding: Winding::Ccw,
                near_plane: NearPlane::Clip,
            },
            stencil_reference: 0,
            scissor,
            light: None,
            constant: [0.0; 4],
            set: DrawSet::FullScreen,
        })),
    }
}
