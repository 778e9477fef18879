//! Everything without a window: pictures, lists and reports.
//!
//! - [`render`] draws one picture, [`tour`] all of them; [`save`](save_png) writes them whole or not at all;
//! - [`verify`] holds what is drawn against exact rays, also on random views ([`wander`]);
//! - [`mod@bench`] measures frames, one by one, [`sweep`] how that grows, which [`plot`] draws;
//! - [`json`] is what `render --json` prints, [`catalog`] what `list` prints.

pub mod bench;
pub mod catalog;
pub mod figures;
pub mod json;
pub mod plot;
pub mod render;
mod report;
mod save;
pub mod sweep;
pub mod tour;
pub mod verify;
pub mod wander;

use std::io::IsTerminal as _;
use std::path::PathBuf;

use indicatif::{ProgressBar, ProgressStyle};
use thiserror::Error;

use crate::cli::InputError;
use crate::director::StageError;
use crate::gpu::GpuError;
use crate::scene::{OpenError, Scene, stock};
use crate::settings::SceneChoice;

pub use save::{COMMAND_KEY, SaveError, check_target, read_command, save_png};

/// Why there is no picture: one line each.
#[derive(Debug, Error)]
pub enum HeadlessError {
    /// Settings that name nothing or lie out of range.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The scene cannot be opened.
    #[error(transparent)]
    Open(#[from] OpenError),
    /// The frame cannot be planned.
    #[error(transparent)]
    Stage(#[from] StageError),
    /// The device cannot draw it.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The picture cannot be written.
    #[error(transparent)]
    Save(#[from] SaveError),
    /// There is nothing to verify.
    #[error("{0} has no lights: there are no shadows to verify")]
    NoLights(String),
    /// A plot cannot be drawn.
    #[error("cannot draw the plot: {0}")]
    Plot(String),
    /// The folder cannot be made.
    #[error("cannot make the folder {folder}: {error}", folder = .0.display(), error = .1)]
    Folder(PathBuf, #[source] std::io::Error),
}

/// Opens a scene.
///
/// # Errors
/// No such scene, or a file that cannot be imported.
pub fn open_scene(choice: &SceneChoice, floor: bool) -> Result<Scene, HeadlessError> {
    check_exists(choice)?;
    Ok(crate::scene::open(choice, floor)?)
}

/// Says whether there is anything to open. A word that is no file may have been meant as a stock
/// scene's name, so those are listed.
///
/// # Errors
/// A file that is not there.
pub fn check_exists(choice: &SceneChoice) -> Result<(), InputError> {
    match choice {
        SceneChoice::File(path) if matches!(path.try_exists(), Ok(false)) => {
            let known = stock::TABLE.iter().map(|scene| scene.name).collect::<Vec<_>>().join(", ");
            Err(InputError::NoScene { name: path.to_string_lossy().into_owned(), known })
        }
        _ => Ok(()),
    }
}

/// On a terminal a bar; elsewhere, or for nothing to come, none.
fn progress_bar(count: u64) -> ProgressBar {
    if count == 0 || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} {msg}").unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(count).with_style(style)
}
