//! How shadows are counted, what is shown of it, and how many samples a pixel has.

use egui::{RichText, Ui};

use super::complexity::complexity;
use super::diagram::diagram;
use super::style::{self, explain, field, slider};
use super::{Desk, View};
use crate::app::keys::{Command, key_of};
use crate::settings::Show;
use crate::techniques::TABLE;
use crate::techniques::cases::{self, Class};

/// The techniques; the chosen one with its sentence.
pub fn techniques(ui: &mut Ui, desk: &mut Desk<'_>) {
    ui.spacing_mut().item_spacing.y = 2.0;
    for row in TABLE {
        let chosen = desk.settings.technique == row.technique;
        let title = RichText::new(row.title).strong();
        let title = if chosen { title.color(style::ACCENT) } else { title };
        let key = key_of(Command::Technique(row.technique)).map(|key| format!("\nKey: {key}")).unwrap_or_default();
        let response = ui.radio(chosen, title).on_hover_text(format!("{}\nSource: {}{key}", row.about, row.source));
        if response.clicked() {
            desk.settings.technique = row.technique;
        }
        if chosen {
            ui.horizontal(|ui| {
                ui.add_space(ui.spacing().icon_width + ui.spacing().icon_spacing - 6.0);
                explain(ui, row.about);
            });
            ui.add_space(3.0);
        }
    }
}

/// What is shown, and of which light.
pub fn show(ui: &mut Ui, desk: &mut Desk<'_>, view: &View<'_>) {
    ui.horizontal_wrapped(|ui| {
        style::tight(ui);
        for show in Show::ALL {
            let response = ui.selectable_label(desk.settings.show == show, capital(show.name()));
            if response.on_hover_text(show.about()).clicked() {
                desk.settings.show = show;
            }
        }
    });
    explain(ui, format!("{}.", capital(desk.settings.show.about())));
    if desk.settings.show == Show::Cases {
        legend(ui, desk, view);
    }
    complexity(ui, desk, view);
    diagram(ui, desk);
    let lights = view.scene.map_or(&[][..], |scene| &scene.lights);
    let in_force = view.scene.map_or(0, |scene| scene.lights_in_force(&desk.settings.mirrors));
    let of_one_light = desk.settings.show.looks_at_light();
    ui.add_enabled_ui(of_one_light && !lights.is_empty(), |ui| {
        field(ui, "Light", "The light whose stencil count, shadow, volumes or cases are shown", |ui| {
            let mirrors = desk.settings.mirrors.clone();
            let name = |index: usize| match view.scene {
                Some(scene) if index < in_force => format!("{index}  {}", scene.light_name(&mirrors, index)),
                _ => format!("{index}"),
            };
            egui::ComboBox::from_id_salt("light-k")
                .selected_text(name(desk.settings.light))
                .show_ui(ui, |ui| {
                    for index in 0..in_force {
                        ui.selectable_value(&mut desk.settings.light, index, name(index));
                    }
                })
                .response
        });
    });
    ui.horizontal(|ui| {
        ui.label(RichText::new("Samples").color(style::WEAK));
        let four = view.capabilities.is_none_or(|capabilities| capabilities.four_samples);
        for samples in [1, 4] {
            let words = if samples == 1 { "1 a pixel" } else { "4 a pixel" };
            let tip = "Samples a pixel: 4 smooths every edge, and costs about ten times as much on a software GPU";
            let response =
                ui.add_enabled(samples == 1 || four, egui::Button::selectable(desk.settings.samples == samples, words));
            if response.on_hover_text(tip).on_disabled_hover_text("This device draws 1 sample a pixel only").clicked() {
                desk.settings.samples = samples;
            }
        }
    });
    ui.checkbox(&mut desk.settings.smooth_terminator, "Smooth terminator").on_hover_text(
        "Light reaches zero before any facet turns away from it, so that smooth-shaded meshes show no faceted shadow edge",
    );
    field(ui, "Exposure", "Stops added to the scene's own exposure", |ui| {
        ui.add(slider(&mut desk.settings.exposure, -6.0..=6.0).fixed_decimals(1).suffix(" stops"))
    });
}

/// The colours of the classes, and how many instances are of each.
fn legend(ui: &mut Ui, desk: &Desk<'_>, view: &View<'_>) {
    let (Some(scene), Some(plan), Some(pose)) = (view.scene, view.plan, view.pose) else { return };
    let Some(light) = pose.lights.get(desk.settings.light) else { return };
    let classes = cases::classes(scene, &plan.volumes, desk.settings.light, light.shadows);
    for class in Class::ALL {
        ui.horizontal(|ui| {
            let (rect, _) = ui.allocate_exact_size(egui::Vec2::splat(12.0), egui::Sense::hover());
            let [r, g, b] = class.color().map(|value| (value * 255.0).round() as u8);
            ui.painter().rect_filled(rect, 2.0, egui::Color32::from_rgb(r, g, b));
            let count = classes.iter().filter(|it| **it == class).count();
            ui.label(format!("{count} {}", class.name())).on_hover_text(capital(class.words()));
        });
    }
}

/// `words` with a capital letter.
pub fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
