//! The option that says which fragments depth complexity counts, to [`Complexity`] and back.

use clap::Args;

use super::command_line::Line;
use super::input::InputError;
use super::{by_name, names};
use crate::settings::Complexity;

/// What both the window and `render` understand of it.
#[derive(Debug, Clone, PartialEq, Args)]
pub(super) struct ComplexityArguments {
    #[arg(long, value_name = "C", help = format!("What `--show complexity` counts: {}", names(Complexity::ALL.map(Complexity::name))))]
    complexity: Option<String>,
}

impl ComplexityArguments {
    /// Changes `complexity` as the arguments say.
    pub fn apply(&self, complexity: &mut Complexity) -> Result<(), InputError> {
        if let Some(name) = &self.complexity {
            *complexity = by_name("complexity", name, Complexity::ALL, Complexity::name)?;
        }
        Ok(())
    }
}

/// The option that gives `complexity` again.
pub(super) fn write(complexity: Complexity, line: &mut Line) {
    if complexity != Complexity::default() {
        line.option("--complexity", complexity.name());
    }
}
