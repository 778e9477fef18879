//! When.

use egui::Ui;

use super::style::{self, field, number, slider};
use super::{Desk, View};
use crate::app::clock::SPEEDS;
use crate::scene::{AnimationChoice, Scene};

/// Play, pause, step, scrub, speed, and which animations play.
pub fn time(ui: &mut Ui, desk: &mut Desk<'_>, view: &View<'_>) {
    let animations = view.scene.map_or(&[][..], |scene| &scene.animations);
    ui.add_enabled_ui(!animations.is_empty(), |ui| {
        let clock = &mut desk.preferences.clock;
        let settings = &mut *desk.settings;
        ui.horizontal(|ui| {
            let words = if clock.playing { "Pause" } else { "Play" };
            if ui.add_sized([58.0, 20.0], egui::Button::new(words)).on_hover_text("Space").clicked() {
                clock.playing = !clock.playing;
            }
            for (words, steps, tip) in [("Back", -1, "One step back (,)"), ("Step", 1, "One step on (.)")] {
                if ui.button(words).on_hover_text(tip).clicked() {
                    settings.time = clock.step(settings.time, steps);
                }
            }
            let seconds = ui.add(number(&mut settings.time).speed(0.01).range(0.0..=1.0e6).fixed_decimals(2).suffix(" s"));
            style::name_it(&seconds, "Time");
        });
        let longest = view.scene.map_or(0.0, |scene| longest(scene, settings.animation));
        if longest > 0.0 {
            let mut moment = settings.time % longest;
            let slider = field(ui, "Scrub", "Seconds into the longest animation", |ui| {
                ui.add(slider(&mut moment, 0.0..=longest).fixed_decimals(2).suffix(" s"))
            });
            if slider.changed() {
                settings.time = moment;
                clock.playing = false;
            }
        }
        field(ui, "Speed", "How fast the scene runs; 1x is real time (] and [)", |ui| {
            ui.add(slider(&mut clock.speed, SPEEDS).logarithmic(true).fixed_decimals(2).suffix("x"))
        });
        if let Some(scene) = view.scene {
            choice(ui, settings, scene);
        }
    });
    if animations.is_empty() && view.scene.is_some() {
        style::explain(ui, "Nothing moves in this scene.");
    }
}

fn choice(ui: &mut Ui, settings: &mut crate::settings::Settings, scene: &Scene) {
    let current = settings.animation.unwrap_or(scene.default_animation);
    let name = |choice| match choice {
        AnimationChoice::Still => "none",
        AnimationChoice::All => "all",
        AnimationChoice::One(index) => scene.animations.get(index).map_or("?", |animation| &animation.name),
    };
    field(ui, "Animation", "Which of the scene's animations play", |ui| {
        egui::ComboBox::from_id_salt("animation")
            .selected_text(name(current))
            .show_ui(ui, |ui| {
                let ones = (0..scene.animations.len()).map(AnimationChoice::One);
                for choice in [AnimationChoice::Still, AnimationChoice::All].into_iter().chain(ones) {
                    if ui.selectable_label(current == choice, name(choice)).clicked() {
                        settings.animation = Some(choice);
                    }
                }
            })
            .response
    });
}

/// Seconds after which everything that plays has played once.
fn longest(scene: &Scene, choice: Option<AnimationChoice>) -> f64 {
    let playing = |index: usize| match choice.unwrap_or(scene.default_animation) {
        AnimationChoice::Still => false,
        AnimationChoice::All => true,
        AnimationChoice::One(one) => one == index,
    };
    let durations =
        scene.animations.iter().enumerate().filter(|(index, _)| playing(*index)).map(|(_, animation)| animation.duration);
    durations.filter(|duration| duration.is_finite()).fold(0.0, f64::max)
}

/// Whether the scene looks different a moment later.
#[must_use]
pub fn moves(scene: &Scene, choice: Option<AnimationChoice>) -> bool {
    longest(scene, choice) > 0.0
}
