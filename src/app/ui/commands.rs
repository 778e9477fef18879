//! What each key of [`crate::app::keys`] does to the settings, or asks the window for.

use egui::Context;

use super::{Action, Desk, Marks, Panel, View, camera};
use crate::app::control::Mode;
use crate::app::keys::{self, Command};
use crate::settings::{CameraChoice, SceneChoice, Show, Technique};

/// Carries out the keys pressed since the last frame. Letters belong to the text field that has
/// the focus, if one has.
pub fn run(context: &Context, panel: &mut Panel, desk: &mut Desk<'_>, view: &View<'_>, actions: &mut Vec<Action>) {
    for command in context.input(keys::pressed) {
        // What is typed on after Ctrl+O belongs to the path, also before the field could take the focus.
        let typing = panel.focus_path || context.egui_wants_keyboard_input();
        let while_typing = matches!(
            command,
            Command::Quit
                | Command::OpenPath
                | Command::Reload
                | Command::ToggleFullscreen
                | Command::TogglePanel
                | Command::Close
        );
        if !typing || while_typing {
            one(command, panel, desk, view, actions);
        }
    }
}

fn one(command: Command, panel: &mut Panel, desk: &mut Desk<'_>, view: &View<'_>, actions: &mut Vec<Action>) {
    let settings = &mut *desk.settings;
    let preferences = &mut *desk.preferences;
    match command {
        Command::Technique(technique) => settings.technique = technique,
        Command::NextTechnique => settings.technique = after(&Technique::ALL, settings.technique),
        Command::NextShow => settings.show = after(&Show::ALL, settings.show),
        Command::NextLight => {
            let lights = view.scene.map_or(0, |scene| scene.lights_in_force(&settings.mirrors)).max(1);
            settings.light = (settings.light + 1) % lights;
        }
        Command::NextScene => {
            let current =
                view.stock.iter().position(|row| matches!(&settings.scene, SceneChoice::Stock(name) if row.name == name));
            if let Some(next) = view.stock.get(current.map_or(0, |index| (index + 1) % view.stock.len())) {
                actions.push(Action::Open(SceneChoice::Stock(next.name.into())));
            }
        }
        Command::NextCamera => {
            let cameras = view.scene.map_or(&[][..], |scene| &scene.cameras);
            let current = match &settings.camera {
                CameraChoice::First => Some(0),
                CameraChoice::Named(name) => cameras.iter().position(|camera| camera.name == *name).or_else(|| name.parse().ok()),
                CameraChoice::Free { .. } => None,
            };
            let next = current.map_or(0, |index| (index + 1) % cameras.len().max(1));
            if let Some(camera) = cameras.get(next) {
                settings.camera = camera::named(next, &camera.name, cameras);
                settings.fov = None;
            }
        }
        Command::ResetCamera => camera::reset(desk),
        Command::ToggleMode => {
            preferences.mode = if preferences.mode == Mode::Orbit { Mode::Fly } else { Mode::Orbit };
        }
        Command::TogglePlay => preferences.clock.playing = !preferences.clock.playing,
        Command::Step(steps) => settings.time = preferences.clock.step(settings.time, steps),
        Command::Faster(doublings) => preferences.clock.faster(doublings),
        Command::ToggleSamples => {
            let four = view.capabilities.is_none_or(|capabilities| capabilities.four_samples);
            settings.samples = if settings.samples == 1 && four { 4 } else { 1 };
        }
        Command::MakeMirrors => panel.toggle_marks(Marks::Mirrors),
        Command::MarkReceivers => panel.toggle_marks(Marks::Receivers),
        Command::ToggleIcons => preferences.icons = !preferences.icons,
        Command::TogglePanel => preferences.panel = !preferences.panel,
        Command::ToggleHelp => panel.help = !panel.help,
        Command::Close => {
            panel.help = false;
            panel.focus_path = false;
            panel.marks = None;
        }
        Command::Screenshot => actions.push(Action::Screenshot),
        Command::CopyCommand => actions.push(Action::CopyCommand),
        Command::OpenPath => {
            preferences.panel = true;
            panel.focus_path = true;
        }
        Command::Reload => actions.push(Action::Reload),
        Command::LoseDevice => actions.push(Action::LoseDevice),
        Command::ToggleFullscreen => actions.push(Action::ToggleFullscreen),
        Command::Quit => actions.push(Action::Quit),
    }
}

/// The one after `current`, and after the last the first.
fn after<T: Copy + PartialEq, const N: usize>(all: &[T; N], current: T) -> T {
    let index = all.iter().position(|one| *one == current).map_or(0, |index| (index + 1) % N);
    all[index]
}
