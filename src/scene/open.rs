//! From a choice to a scene: stock scenes by name, files by path, on this thread or another.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::thread::Builder;

use thiserror::Error;

use super::gltf::{ImportError, add_floor, load};
use super::{Scene, stock};
use crate::settings::SceneChoice;

/// Why a scene cannot be had.
#[derive(Debug, Error)]
pub enum OpenError {
    /// There is no stock scene of that name.
    #[error("no stock scene `{0}`; there are: {1}")]
    Unknown(String, String),
    /// The file cannot be imported.
    #[error(transparent)]
    Import(#[from] ImportError),
    /// The importer failed where it should have told what is wrong.
    #[error("{0}: the importer failed on it, which is a mistake in this program")]
    Panicked(String),
    /// The system gives us no thread.
    #[error("{0}: no thread to import it on: {1}")]
    NoThread(String, std::io::Error),
}

/// Opens what was chosen, with a floor beneath it if that was chosen too.
///
/// # Errors
/// An unknown name, or whatever keeps the file from being a scene. Not even a panic in the importer
/// gets through: the scene that runs goes on.
pub fn open(choice: &SceneChoice, floor: bool) -> Result<Scene, OpenError> {
    catch_unwind(AssertUnwindSafe(|| make(choice, floor))).unwrap_or_else(|_| Err(OpenError::Panicked(words(choice))))
}

fn make(choice: &SceneChoice, floor: bool) -> Result<Scene, OpenError> {
    let mut scene = match choice {
        SceneChoice::File(path) => load(path)?,
        SceneChoice::Stock(name) => match stock::build(name) {
            Some(scene) => scene?,
            None => {
                let names: Vec<_> = stock::TABLE.iter().map(|scene| scene.name).collect();
                return Err(OpenError::Unknown(name.escape_debug().to_string(), names.join(", ")));
            }
        },
    };
    if floor {
        add_floor(&mut scene);
    }
    Ok(scene)
}

fn words(choice: &SceneChoice) -> String {
    match choice {
        SceneChoice::Stock(name) => name.escape_debug().to_string(),
        SceneChoice::File(path) => path.display().to_string().escape_debug().to_string(),
    }
}

/// A scene that is being opened on a thread of its own.
pub struct Loading {
    /// What is being opened.
    pub choice: SceneChoice,
    receiver: Receiver<Result<Scene, OpenError>>,
    finished: bool,
}

impl Loading {
    /// The scene or why there is none, once, when it is there. Does not wait.
    pub fn poll(&mut self) -> Option<Result<Scene, OpenError>> {
        if self.finished {
            return None;
        }
        let result = match self.receiver.try_recv() {
            Ok(result) => result,
            Err(TryRecvError::Empty) => return None,
            Err(TryRecvError::Disconnected) => Err(OpenError::Panicked(words(&self.choice))),
        };
        self.finished = true;
        Some(result)
    }
}

/// As [`open`], on another thread; `wake` is called there when [`Loading::poll`] has something.
/// Dropping the handle lets the thread finish and forgets what it made.
pub fn load_on_thread(choice: SceneChoice, floor: bool, wake: impl FnOnce() + Send + 'static) -> Loading {
    let (sender, receiver) = channel();
    let chosen = choice.clone();
    let failed = sender.clone();
    let work = move || {
        // A receiver that is gone wants no scene any more.
        let _ = sender.send(open(&chosen, floor));
        wake();
    };
    if let Err(error) = Builder::new().name("import".into()).spawn(work) {
        let _ = failed.send(Err(OpenError::NoThread(words(&choice), error)));
    }
    Loading { choice, receiver, finished: false }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;

    #[test]
    fn an_unknown_name_lists_the_known_ones() {
        let error = open(&SceneChoice::Stock("cube\nfarm".into()), false).unwrap_err().to_string();
        assert!(error.starts_with("no stock scene `cube\\nfarm`; there are: "), "{error}");
        for scene in stock::TABLE {
            assert!(error.contains(scene.name));
        }
    }

    #[test]
    fn a_file_that_is_not_there_is_told_from_the_thread_once() {
        let (woken, wait) = channel();
        let choice = SceneChoice::File("/nowhere/at all.glb".into());
        let mut loading = load_on_thread(choice, false, move || woken.send(()).unwrap());
        wait.recv_timeout(std::time::Duration::from_secs(10)).unwrap();
        let error = loading.poll().unwrap().unwrap_err().to_string();
        assert!(error.starts_with("/nowhere/at all.glb: cannot be read: "), "{error}");
        assert!(loading.poll().is_none());
    }
}
