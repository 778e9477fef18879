//! The options for planar shadows, to [`Planar`] and back.

use clap::Args;

use super::command_line::Line;
use super::input::InputError;
use super::{by_name, mirrors, names};
use crate::scene::{Refusal, Scene};
use crate::settings::{HybridPart, Planar, PlanarMode, SurfacePlace};

/// What both the window and `render` understand of it.
#[derive(Debug, Clone, PartialEq, Args)]
pub(super) struct PlanarArguments {
    #[arg(long, value_name = "MODE", help = format!("How shadows are projected onto receivers, instead of counted by --technique: {} [default: off]", names(PlanarMode::ALL.map(PlanarMode::name))))]
    planar: Option<String>,
    #[arg(long, value_name = "PART", help = format!("What is drawn of --planar hybrid: {} [default: both]", names(HybridPart::ALL.map(HybridPart::name))))]
    hybrid: Option<String>,
    /// Makes a flat surface a receiver of planar shadows, or a receiver none, such as "12=on" or "3:1=off" for the second
    /// primitive of node 3; can be repeated
    #[arg(long, value_name = "NODE[:PRIMITIVE]=SWITCH", value_parser = mirrors::edit)]
    receiver: Vec<(SurfacePlace, bool)>,
}

impl PlanarArguments {
    /// Changes `planar` as the arguments say.
    pub fn apply(&self, planar: &mut Planar) -> Result<(), InputError> {
        if let Some(name) = &self.planar {
            planar.mode = by_name("planar mode", name, PlanarMode::ALL, PlanarMode::name)?;
        }
        if let Some(name) = &self.hybrid {
            planar.hybrid = by_name("part of the hybrid", name, HybridPart::ALL, HybridPart::name)?;
        }
        planar.edits.extend(self.receiver.iter().copied());
        Ok(())
    }
}

/// The options that give `planar` again.
pub(super) fn write(planar: &Planar, line: &mut Line) {
    let Planar { mode, hybrid, edits } = planar;
    let default = Planar::default();
    if *mode != default.mode {
        line.option("--planar", mode.name());
    }
    if *hybrid != default.hybrid {
        line.option("--hybrid", hybrid.name());
    }
    for (place, on) in edits {
        line.option("--receiver", &mirrors::edited(place, *on));
    }
}

/// Says whether the surfaces that `planar` speaks of are there. What cannot be a receiver takes none of these shadows,
/// and a note says why.
pub(super) fn check_against(planar: &Planar, scene: &Scene) -> Result<(), InputError> {
    let missing = |place: &&SurfacePlace| scene.can_receive(**place) == Err(Refusal::Missing);
    match planar.edits.keys().find(missing) {
        Some(&SurfacePlace { node, primitive }) => Err(InputError::Surface { node, primitive }),
        None => Ok(()),
    }
}
