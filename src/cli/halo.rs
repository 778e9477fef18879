//! The options that say what glows, to [`Halos`] and back.

use clap::Args;
use glam::Vec3;

use super::command_line::Line;
use super::input::{InputError, within};
use super::{index, numbers};
use crate::scene::Scene;
use crate::settings::{Halos, MAX_HALO_WIDTH};

/// What both the window and `render` understand of it.
#[derive(Debug, Clone, PartialEq, Args)]
pub(super) struct HaloArguments {
    /// Gives a node of the scene, and all that hangs on it, a halo, such as "12", or takes it away, such as "12=off";
    /// can be repeated
    #[arg(long, value_name = "NODE[=SWITCH]", value_parser = edit)]
    halo: Vec<(usize, bool)>,
    /// The colour of halos, linear, each part 0 to 1 [default: 1,0.62,0.12]
    #[arg(long, value_name = "R,G,B", allow_hyphen_values = true, value_parser = color)]
    halo_color: Option<Vec3>,
    /// How far halos reach, percent of the picture's height, 0 to 25 [default: 5]
    #[arg(long, value_name = "PERCENT", allow_hyphen_values = true)]
    halo_width: Option<f32>,
}

impl HaloArguments {
    /// Changes `halos` as the arguments say.
    pub fn apply(&self, halos: &mut Halos) {
        halos.edits.extend(self.halo.iter().copied());
        halos.color = self.halo_color.unwrap_or(halos.color);
        halos.width = self.halo_width.unwrap_or(halos.width);
    }
}

fn edit(text: &str) -> Result<(usize, bool), String> {
    let (node, state) = text.split_once('=').unwrap_or((text, "on"));
    let on = match state {
        "on" => Some(true),
        "off" => Some(false),
        _ => None,
    };
    index(node)
        .ok()
        .zip(on)
        .ok_or_else(|| "expected a node's number, and off where it loses its halo, such as 12 or 12=off".into())
}

fn color(text: &str) -> Result<Vec3, String> {
    numbers(text, ',').map(Vec3::from_array).ok_or_else(|| "expected three numbers, such as 1,0.6,0.1".into())
}

/// The options that give `halos` again.
pub(super) fn write(halos: &Halos, line: &mut Line) {
    let Halos { edits, color, width } = halos;
    let default = Halos::default();
    for (node, on) in edits {
        line.option("--halo", &format!("{node}{}", if *on { "" } else { "=off" }));
    }
    if *color != default.color {
        line.option("--halo-color", &format!("{},{},{}", color.x, color.y, color.z));
    }
    if *width != default.width {
        line.option("--halo-width", &width.to_string());
    }
}

/// Says whether `halos` can be drawn on some scene.
pub(super) fn check(halos: &Halos) -> Result<(), InputError> {
    halos.color.to_array().into_iter().try_for_each(|part| within("each part of the halo's colour", part, 1.0))?;
    within("the halo's width", halos.width, MAX_HALO_WIDTH)
}

/// Says whether the nodes that `halos` speak of are there.
pub(super) fn check_against(halos: &Halos, scene: &Scene) -> Result<(), InputError> {
    let count = scene.nodes.len();
    match halos.edits.keys().find(|node| **node >= count) {
        Some(&index) => Err(InputError::Index { kind: "node", index, count }),
        None => Ok(()),
    }
}
