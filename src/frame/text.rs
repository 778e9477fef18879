//! A plan as text that a person can read and a test can compare.

use std::collections::BTreeMap;
use std::fmt::{Display, Formatter, Result};

use super::plan::{FramePlan, Projection};
use super::state::DepthBias;
use super::stencil::BitBudget;
use super::step::{Action, Draw, DrawSet, Part, Run, VolumePart};
use crate::geometry::volume::Outline;
use crate::settings::Accumulation;

impl Display for FramePlan {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let [width, height] = self.size;
        writeln!(f, "{width} x {height}, {} sample{}", self.samples, if self.samples == 1 { "" } else { "s" })?;
        if let Some(gather) = self.gather {
            writeln!(f, "frame {} of {}", gather.frame + 1, gather.frames)?;
        }
        if self.accumulation != Accumulation::default() {
            writeln!(f, "lights are added into {}", self.accumulation.name())?;
        }
        writeln!(f, "stencil: count {:08b}", self.budget.count_mask)?;
        if self.budget.beyond_mask != 0 {
            writeln!(f, "stencil: beyond the light's bounds {:08b}", self.budget.beyond_mask)?;
        }
        if self.budget.mirror_mask != 0 {
            writeln!(f, "stencil: mirrors {:08b}", self.budget.mirror_mask)?;
        }
        if self.budget.receiver_mask != 0 {
            writeln!(f, "stencil: receivers {:08b}", self.budget.receiver_mask)?;
        }
        if self.budget.points_mask != 0 {
            writeln!(f, "stencil: points' own bits {:08b}", self.budget.points_mask)?;
        }
        for view in &self.views {
            write!(f, "view {}: front {:?}", view.name, view.winding)?;
            if let Some(window) = &view.through {
                write!(f, "; pixels {:?}, stencil {:08b}", view.rect, window.level)?;
            }
            writeln!(f)?;
        }
        for (point, light) in self.points.iter().enumerate().filter(|(point, light)| point != *light) {
            writeln!(f, "light {point}: a point of light {light}")?;
        }
        for volume in &self.volumes {
            write!(
                f,
                "volume of instance {}, light {}{}: {:?}, for {}",
                volume.instance,
                volume.light,
                if volume.view == 0 { String::new() } else { format!(", view {}", volume.view) },
                volume.method,
                volume.reason.words()
            )?;
            if volume.holds_eye != 0 {
                write!(f, "; {} hold the eye", volume.holds_eye)?;
            }
            if volume.outline == Outline::Polygons {
                write!(f, "; of every polygon")?;
            }
            if let Some(flaw) = volume.flaw {
                write!(f, "; built wrongly: {flaw:?}")?;
            }
            if let Some(metres) = volume.extrusion {
                write!(f, "; ends {metres} m from the light")?;
            }
            if let Some(start) = volume.start {
                write!(f, "; starts where ({}) . x = {:.3}", start.truncate(), -start.w)?;
            }
            if let Some(end) = volume.end {
                let cap = if volume.closed { ", with a cap" } else { "" };
                write!(f, "; ends where ({}) . x = {:.3}{cap}", end.truncate(), -end.w)?;
            }
            if let Some(Projection { receiver, onto, cut }) = volume.projection {
                let cut = if cut { ", cut there" } else { "" };
                write!(
                    f,
                    "; onto {}.{} where ({}) . x = {:.3}{cut}",
                    receiver.instance,
                    receiver.primitive,
                    onto.plane.truncate(),
                    -onto.plane.w
                )?;
            }
            if let Some(cutout) = volume.cutout {
                write!(f, "; {:?} cut-out, thrown with a share of {:.4}", cutout.shape, cutout.throw.share)?;
            }
            writeln!(f)?;
        }
        for (number, step) in self.steps.iter().enumerate() {
            match step.view {
                0 => writeln!(f, "{number:2} {}", step.label)?,
                view => writeln!(f, "{number:2} view {view}: {}", step.label)?,
            }
            match &step.action {
                Action::Clear(clear) => {
                    let mut parts = Vec::new();
                    if let Some([r, g, b, _]) = clear.color {
                        parts.push(format!("colour {r:.3} {g:.3} {b:.3}"));
                    }
                    if let Some(depth) = clear.depth {
                        parts.push(format!("depth {depth}"));
                    }
                    if let Some(stencil) = clear.stencil {
                        parts.push(format!("stencil {stencil}"));
                    }
                    if let Some(counts) = clear.counts {
                        parts.push(format!("counts {counts}"));
                    }
                    writeln!(f, "     clear {}", parts.join(", "))?;
                }
                Action::Draw(draw) => describe(f, draw, self.budget)?,
                Action::Keep => writeln!(f, "     keep {:?} pixels in a texture", self.views[step.view].picture)?,
            }
        }
        for note in &self.notes {
            writeln!(f, "note: {note}")?;
        }
        if let Some(then) = &self.then {
            writeln!(f, "then:\n{then}")?;
        }
        Ok(())
    }
}

fn describe(f: &mut Formatter<'_>, draw: &Draw, budget: BitBudget) -> Result {
    let state = &draw.state;
    let bias = match state.depth.bias {
        DepthBias::NONE => String::new(),
        DepthBias { constant, slope } => format!(", offset by {constant} and {slope} x slope"),
    };
    let depth = format!("{:?}{}{bias}", state.depth.compare, if state.depth.write { ", written" } else { "" });
    let color = state.color.map_or("none".into(), |blend| format!("{blend:?}"));
    writeln!(f, "     {:?} to {:?}: {}", draw.program, draw.target, contents(&draw.set))?;
    writeln!(
        f,
        "     depth {depth}; colour {color}; cull {:?}; front {:?}; near plane {:?}; scissor {:?}",
        state.cull, state.winding, state.near_plane, draw.scissor
    )?;
    writeln!(f, "     stencil {}, reference {}", state.stencil.words(budget), draw.stencil_reference)
}

fn contents(set: &DrawSet) -> String {
    match set {
        DrawSet::FullScreen => "full screen".into(),
        DrawSet::Surfaces(surfaces) => {
            let list: Vec<_> = surfaces.iter().map(|surface| format!("{}.{}", surface.instance, surface.primitive)).collect();
            format!("surfaces {}", list.join(" "))
        }
        DrawSet::Runs(runs) => {
            let run = |Run { surface, triangles: [from, to] }: &Run| {
                format!("{}.{} ({from} to {to})", surface.instance, surface.primitive)
            };
            format!("triangles of {}", runs.iter().map(run).collect::<Vec<_>>().join(" "))
        }
        DrawSet::Swollen(swollen) => {
            let list: Vec<_> =
                swollen.surfaces.iter().map(|surface| format!("{}.{}", surface.instance, surface.primitive)).collect();
            format!("swollen by {:.2} pixels: surfaces {}", swollen.pixels, list.join(" "))
        }
        DrawSet::Volumes(parts) => {
            let of_window = |parts: &[VolumePart]| {
                let mut by_volume: BTreeMap<usize, Vec<&str>> = BTreeMap::new();
                for part in parts {
                    by_volume.entry(part.volume).or_default().push(match part.part {
                        Part::Sides => "sides",
                        Part::SidesTurned => "turned sides",
                        Part::LightCapKept => "light cap",
                        Part::LightCapTurned => "turned light cap",
                        Part::DarkCap => "dark cap",
                        Part::StartCap => "start cap",
                        Part::EndCap => "end cap",
                    });
                }
                let list: Vec<_> = by_volume.iter().map(|(volume, parts)| format!("{volume} ({})", parts.join(", "))).collect();
                let window = parts.first().and_then(|part| part.window).map(|window| format!(" within {window:?}"));
                format!("volumes {}{}", list.join(" "), window.unwrap_or_default())
            };
            let windows: Vec<_> = parts.chunk_by(|a, b| a.window == b.window).map(of_window).collect();
            windows.join("; ")
        }
        DrawSet::Labels(labels) => {
            let list: Vec<_> = labels.iter().map(|label| format!("{:?}", label.text)).collect();
            format!("names {}", list.join(" "))
        }
        DrawSet::Enclosure(solid) => format!("a {}", solid.name()),
        DrawSet::Triangles(corners) => format!("{} triangles", corners.len() / 3),
        DrawSet::Strokes(strokes) => format!("{} lines", strokes.len()),
        DrawSet::Edges(instances) => format!("edges of {} instances", instances.len()),
    }
}
