//! `obscura tour`: one picture of each stock scene by each technique, and of everything that can
//! be shown for one of them: what a machine without a display gets to see first.

use std::path::{Path, PathBuf};

use super::save::save_png;
use super::{HeadlessError, progress_bar};
use crate::cli::render_command;
use crate::director;
use crate::gpu::{Context, Renderer, readback};
use crate::scene::stock;
use crate::settings::{SceneChoice, Settings, Show, Technique};

/// One picture of the tour.
#[derive(Debug, Clone, PartialEq)]
pub struct Stop {
    /// The file's name.
    pub file: String,
    /// What it shows.
    pub settings: Settings,
}

/// Every picture, scene by scene.
#[must_use]
pub fn stops() -> Vec<Stop> {
    let default = Settings::default();
    let mut stops = Vec::new();
    for entry in stock::TABLE {
        let scene = SceneChoice::Stock(entry.name.into());
        for technique in Technique::ALL {
            stops.push(Stop {
                file: format!("{}-{}.png", entry.name, technique.name()),
                settings: Settings { scene: scene.clone(), technique, ..default.clone() },
            });
        }
        if scene != default.scene {
            continue;
        }
        // What is shown by default is among the pictures above.
        for show in Show::ALL.into_iter().filter(|show| *show != default.show) {
            stops.push(Stop {
                file: format!("{}-{}-{}.png", entry.name, default.technique.name(), show.name()),
                settings: Settings { scene: scene.clone(), show, ..default.clone() },
            });
        }
    }
    stops
}

/// Draws all [`stops`] into the folder `out`, which is made where it is missing; gives the files.
///
/// # Errors
/// The first thing that stands in the way.
pub fn tour(out: &Path) -> Result<Vec<PathBuf>, HeadlessError> {
    std::fs::create_dir_all(out).map_err(|error| HeadlessError::Folder(out.into(), error))?;
    let stops = stops();
    let context = Context::headless(None)?;
    let mut renderer = Renderer::new(&context, None)?;
    let progress = progress_bar(stops.len() as u64);
    let mut files = Vec::with_capacity(stops.len());
    let mut open = None;
    for stop in stops {
        progress.set_message(stop.file.clone());
        let path = out.join(&stop.file);
        let scene = match open.take() {
            Some((choice, scene)) if choice == stop.settings.scene => scene,
            _ => {
                let scene = super::render::open(&stop.settings)?;
                renderer.set_scene(&context, &scene)?;
                scene
            }
        };
        let (pose, plan) = director::stage(&stop.settings, &scene, context.capabilities())?;
        let (_, picture) = readback::picture(&context, &mut renderer, &plan, &scene, &pose)?;
        save_png(&path, &picture, &render_command(&stop.settings))?;
        open = Some((stop.settings.scene, scene));
        files.push(path);
        progress.inc(1);
    }
    progress.finish_and_clear();
    Ok(files)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn the_tour_stops_at_every_scene_technique_and_show() {
        let stops = stops();
        let files: BTreeSet<_> = stops.iter().map(|stop| &stop.file).collect();
        assert_eq!(files.len(), stops.len(), "every picture has a file of its own");
        for entry in stock::TABLE {
            for technique in Technique::ALL {
                let there = |stop: &Stop| {
                    stop.settings.scene == SceneChoice::Stock(entry.name.into()) && stop.settings.technique == technique
                };
                assert!(stops.iter().any(there), "{} {}", entry.name, technique.name());
            }
        }
        for show in Show::ALL {
            assert!(stops.iter().any(|stop| stop.settings.show == show), "{}", show.name());
        }
    }
}
