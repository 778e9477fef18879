//! The options of a picture that dissolves into another, to [`Dissolve`] and back.

use clap::Args;

use super::command_line::Line;
use super::input::{InputError, at_least_zero, within};
use super::{by_name, names};
use crate::scene::stock;
use crate::settings::{Dissolve, Pattern, Technique};

/// What both the window and `render` understand of it.
#[derive(Debug, Clone, PartialEq, Args)]
pub(super) struct DissolveArguments {
    /// Mixes the picture pixel by pixel with the same by another technique
    #[arg(long, value_name = "T")]
    dissolve: Option<String>,
    /// Mixes the picture pixel by pixel with another stock scene, seen by its first camera
    #[arg(long, value_name = "NAME")]
    dissolve_scene: Option<String>,
    #[arg(long, value_name = "P", help = format!("Which pixels turn first: {} [default: bayer]", names(Pattern::ALL.map(Pattern::name))))]
    dissolve_pattern: Option<String>,
    /// How many of the pixels have turned, 0 to 1 [default: 0.5]
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true)]
    dissolve_amount: Option<f32>,
    /// The amount goes by time, there and back in so many seconds; 0 stays [default: 0]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    dissolve_seconds: Option<f32>,
}

impl DissolveArguments {
    /// Changes `dissolve` as the arguments say.
    pub fn apply(&self, dissolve: &mut Dissolve) -> Result<(), InputError> {
        if let Some(name) = &self.dissolve {
            dissolve.into = Some(by_name("technique", name, Technique::ALL, Technique::name)?);
        }
        if let Some(name) = &self.dissolve_scene {
            dissolve.scene = Some(name.clone());
        }
        if let Some(name) = &self.dissolve_pattern {
            dissolve.pattern = by_name("pattern", name, Pattern::ALL, Pattern::name)?;
        }
        dissolve.amount = self.dissolve_amount.unwrap_or(dissolve.amount);
        dissolve.seconds = self.dissolve_seconds.unwrap_or(dissolve.seconds);
        Ok(())
    }
}

/// Says whether `dissolve` can be drawn.
pub(super) fn check(dissolve: &Dissolve) -> Result<(), InputError> {
    if let Some(name) = dissolve.scene.as_ref().filter(|name| stock::find(name).is_none()) {
        let known: Vec<_> = stock::TABLE.iter().map(|scene| scene.name).collect();
        return Err(InputError::Unknown { kind: "stock scene", name: name.clone(), known: known.join(", ") });
    }
    within("the dissolve's amount", dissolve.amount, 1.0)?;
    at_least_zero("the dissolve's seconds", dissolve.seconds.into())
}

/// The options that give `dissolve` again.
pub(super) fn write(dissolve: &Dissolve, line: &mut Line) {
    let Dissolve { into, ref scene, pattern, amount, seconds } = *dissolve;
    let default = Dissolve::default();
    if let Some(into) = into {
        line.option("--dissolve", into.name());
    }
    if let Some(scene) = scene {
        line.option("--dissolve-scene", scene);
    }
    if pattern != default.pattern {
        line.option("--dissolve-pattern", pattern.name());
    }
    if amount != default.amount {
        line.option("--dissolve-amount", &amount.to_string());
    }
    if seconds != default.seconds {
        line.option("--dissolve-seconds", &seconds.to_string());
    }
}
