//! How decals are drawn.

use egui::Ui;

use super::style::{self, explain};
use super::technique::capital;
use super::{Desk, View};
use crate::settings::DecalMode;

/// The choice, and whether there is anything to choose it for.
pub fn decals(ui: &mut Ui, desk: &mut Desk<'_>, view: &View<'_>) {
    ui.horizontal_wrapped(|ui| {
        style::tight(ui);
        for mode in DecalMode::ALL {
            let response = ui.selectable_label(desk.settings.decals == mode, format!("Decals: {}", mode.name()));
            if response.on_hover_text(format!("{}.", capital(mode.about()))).clicked() {
                desk.settings.decals = mode;
            }
        }
    });
    explain(ui, format!("{}.", capital(desk.settings.decals.about())));
    if view.scene.is_some_and(|scene| !scene.materials.iter().any(|material| material.decal)) {
        explain(ui, "This scene has none; `runway` has, and so has any glTF material with extras {\"decal\": true}.");
    }
}
