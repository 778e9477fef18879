//! The option that says where silhouettes are found, to [`Backend`] and back.

use clap::Args;

use super::command_line::Line;
use super::input::InputError;
use super::{by_name, names};
use crate::settings::Backend;

/// What both the window and `render` understand of it.
#[derive(Debug, Clone, PartialEq, Args)]
pub(super) struct SilhouetteArguments {
    #[arg(long, value_name = "B", help = format!("Where silhouettes are found: {} [default: cpu]", names(Backend::ALL.map(Backend::name))))]
    silhouettes: Option<String>,
}

impl SilhouetteArguments {
    /// Changes `backend` as the arguments say.
    pub fn apply(&self, backend: &mut Backend) -> Result<(), InputError> {
        if let Some(name) = &self.silhouettes {
            *backend = by_name("silhouettes", name, Backend::ALL, Backend::name)?;
        }
        Ok(())
    }
}

/// The option that gives `backend` again.
pub(super) fn write(backend: Backend, line: &mut Line) {
    if !backend.is_cpu() {
        line.option("--silhouettes", backend.name());
    }
}
