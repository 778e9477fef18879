//! The option that says what is drawn into the scene from the side, to [`Diagram`] and back.

use clap::Args;

use super::command_line::Line;
use super::input::InputError;
use super::{by_name, names};
use crate::settings::Diagram;

/// What both the window and `render` understand of it.
#[derive(Debug, Clone, PartialEq, Args)]
pub(super) struct DiagramArguments {
    #[arg(long, value_name = "D", help = format!("What `--show rays` draws in: {}", names(Diagram::ALL.map(Diagram::name))))]
    diagram: Option<String>,
}

impl DiagramArguments {
    /// Changes `diagram` as the arguments say.
    pub fn apply(&self, diagram: &mut Diagram) -> Result<(), InputError> {
        if let Some(name) = &self.diagram {
            *diagram = by_name("diagram", name, Diagram::ALL, Diagram::name)?;
        }
        Ok(())
    }
}

/// The option that gives `diagram` again.
pub(super) fn write(diagram: Diagram, line: &mut Line) {
    if diagram != Diagram::default() {
        line.option("--diagram", diagram.name());
    }
}
