//! The option that says how coplanar geometry is drawn, to [`DecalMode`] and back.

use clap::Args;

use super::command_line::Line;
use super::input::InputError;
use super::{by_name, names};
use crate::settings::DecalMode;

/// What both the window and `render` understand of it.
#[derive(Debug, Clone, PartialEq, Args)]
pub(super) struct DecalArguments {
    #[arg(long, value_name = "D", help = format!("How decals are kept from fighting their ground: {}", names(DecalMode::ALL.map(DecalMode::name))))]
    decals: Option<String>,
}

impl DecalArguments {
    /// Changes `decals` as the arguments say.
    pub fn apply(&self, decals: &mut DecalMode) -> Result<(), InputError> {
        if let Some(name) = &self.decals {
            *decals = by_name("way of drawing decals", name, DecalMode::ALL, DecalMode::name)?;
        }
        Ok(())
    }
}

/// The option that gives `decals` again.
pub(super) fn write(decals: DecalMode, line: &mut Line) {
    if decals != DecalMode::default() {
        line.option("--decals", decals.name());
    }
}
