//! The options that say how a frame's light comes together, to [`Lighting`] and back.

use clap::Args;

use super::command_line::Line;
use super::input::InputError;
use super::{by_name, names};
use crate::settings::{Accumulation, AreaMode, Lighting, MAX_AREA_SAMPLES, MAX_FRAMES, Shading, Texturing};

/// What both the window and `render` understand of it.
#[derive(Debug, Clone, PartialEq, Args)]
pub(super) struct LightingArguments {
    /// Points that each light with a size is counted as in a frame [default: 8]
    #[arg(long, value_name = "N")]
    area_samples: Option<u32>,
    #[arg(long, value_name = "M", help = format!("Where the points of one light keep their shadows: {}", names(AreaMode::ALL.map(AreaMode::name))))]
    area_mode: Option<String>,
    /// Which of those points of light K stencil, shadow and volumes look at, from 0
    #[arg(long, value_name = "J")]
    light_sample: Option<u32>,
    /// The mean of so many frames, each with other points of the lights with a size [default: 1]
    #[arg(long, value_name = "N")]
    accumulate: Option<u32>,
    #[arg(long, value_name = "A", help = format!("What lights are added into: {}", names(Accumulation::ALL.map(Accumulation::name))))]
    accumulation: Option<String>,
    #[arg(long, value_name = "T", help = format!("How often surfaces are textured: {}", names(Texturing::ALL.map(Texturing::name))))]
    texturing: Option<String>,
    #[arg(long, value_name = "S", help = format!("Whether lights draw surfaces or pixels: {}", names(Shading::ALL.map(Shading::name))))]
    shading: Option<String>,
    /// Writes the names of lights and of what casts shadows into the picture
    #[arg(long)]
    labels: bool,
}

impl LightingArguments {
    /// Changes `lighting` as the arguments say.
    pub fn apply(&self, lighting: &mut Lighting) -> Result<(), InputError> {
        lighting.area_samples = self.area_samples.unwrap_or(lighting.area_samples);
        if let Some(name) = &self.area_mode {
            lighting.area_mode = by_name("area mode", name, AreaMode::ALL, AreaMode::name)?;
        }
        lighting.light_sample = self.light_sample.unwrap_or(lighting.light_sample);
        lighting.accumulate = self.accumulate.unwrap_or(lighting.accumulate);
        if let Some(name) = &self.accumulation {
            lighting.accumulation = by_name("accumulation", name, Accumulation::ALL, Accumulation::name)?;
        }
        if let Some(name) = &self.texturing {
            lighting.texturing = by_name("texturing", name, Texturing::ALL, Texturing::name)?;
        }
        if let Some(name) = &self.shading {
            lighting.shading = by_name("shading", name, Shading::ALL, Shading::name)?;
        }
        lighting.labels |= self.labels;
        Ok(())
    }
}

/// The options that give `lighting` again.
pub(super) fn write(lighting: &Lighting, line: &mut Line) {
    let Lighting { area_samples, area_mode, light_sample, accumulate, accumulation, texturing, shading, labels } = *lighting;
    let default = Lighting::default();
    let mut number = |name, value: u32, default| {
        if value != default {
            line.option(name, &value.to_string());
        }
    };
    number("--area-samples", area_samples, default.area_samples);
    number("--light-sample", light_sample, default.light_sample);
    number("--accumulate", accumulate, default.accumulate);
    if area_mode != default.area_mode {
        line.option("--area-mode", area_mode.name());
    }
    if accumulation != default.accumulation {
        line.option("--accumulation", accumulation.name());
    }
    if texturing != default.texturing {
        line.option("--texturing", texturing.name());
    }
    if shading != default.shading {
        line.option("--shading", shading.name());
    }
    if labels {
        line.word("--labels");
    }
}

/// Says whether `lighting` can be drawn on some scene.
pub(super) fn check(lighting: &Lighting) -> Result<(), InputError> {
    let within = |what, value: u32, least, most| {
        if (least..=most).contains(&value) { Ok(()) } else { Err(InputError::Range { what, value, least, most }) }
    };
    within("the points of a light with a size", lighting.area_samples, 1, MAX_AREA_SAMPLES)?;
    within("the point of the light that is looked at", lighting.light_sample, 0, lighting.area_samples - 1)?;
    within("the frames gathered", lighting.accumulate, 1, MAX_FRAMES)
}
