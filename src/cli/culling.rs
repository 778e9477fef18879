//! The options that say what is left out of counting shadows, to [`Culling`] and back.

use clap::Args;

use super::command_line::Line;
use super::input::InputError;
use super::{by_name, names};
use crate::settings::{Culling, LightBounds};

/// What both the window and `render` understand of it.
#[derive(Debug, Clone, PartialEq, Args)]
pub(super) struct CullingArguments {
    /// Counts shadow volumes too that meet nothing that is lit and in view, and caps that are out of view
    #[arg(long)]
    no_culling: bool,
    #[arg(long, value_name = "B", help = format!("What bounds the pixels that a light can reach: {} [default: tight]", names(LightBounds::ALL.map(LightBounds::name))))]
    light_bounds: Option<String>,
    /// Counts each volume in a step of its own, behind a scissor of its own
    #[arg(long)]
    caster_scissors: bool,
    /// Marks the pixels whose surface lies within a light's bounds and counts only there: on or off [default: off]
    #[arg(long, value_name = "SWITCH")]
    depth_bounds: Option<String>,
    /// Counts a volume only in the cells of the picture where its shadow may fall: on or off [default: on]
    #[arg(long, value_name = "SWITCH")]
    footprints: Option<String>,
    /// Counts only the pieces of a volume about what can receive its shadow: on or off [default: on]
    #[arg(long, value_name = "SWITCH")]
    clamping: Option<String>,
}

impl CullingArguments {
    /// Changes `culling` as the arguments say.
    pub fn apply(&self, culling: &mut Culling) -> Result<(), InputError> {
        culling.on &= !self.no_culling;
        if let Some(name) = &self.light_bounds {
            culling.light_bounds = by_name("light bounds", name, LightBounds::ALL, LightBounds::name)?;
        }
        culling.caster_scissors |= self.caster_scissors;
        if let Some(name) = &self.depth_bounds {
            culling.depth_bounds = by_name("depth bounds", name, [false, true], switch)?;
        }
        if let Some(name) = &self.footprints {
            culling.footprints = by_name("footprints", name, [false, true], switch)?;
        }
        if let Some(name) = &self.clamping {
            culling.clamping = by_name("clamping", name, [false, true], switch)?;
        }
        Ok(())
    }
}

fn switch(on: bool) -> &'static str {
    if on { "on" } else { "off" }
}

/// The options that give `culling` again.
pub(super) fn write(culling: &Culling, line: &mut Line) {
    let Culling { on, light_bounds, caster_scissors, depth_bounds, footprints, clamping } = *culling;
    if !on {
        line.word("--no-culling");
    }
    if light_bounds != LightBounds::default() {
        line.option("--light-bounds", light_bounds.name());
    }
    if caster_scissors {
        line.word("--caster-scissors");
    }
    if depth_bounds {
        line.option("--depth-bounds", switch(depth_bounds));
    }
    if !footprints {
        line.option("--footprints", switch(footprints));
    }
    if !clamping {
        line.option("--clamping", switch(clamping));
    }
}
