//! A picture that dissolves into another.

use egui::Ui;

use super::Desk;
use super::style::{self, explain, field, slider};
use super::technique::capital;
use crate::scene::stock;
use crate::settings::{Pattern, Technique};
use crate::techniques;

/// Into which technique or scene, in which pattern, how far.
pub fn dissolve(ui: &mut Ui, desk: &mut Desk<'_>) {
    let dissolve = &mut desk.settings.dissolve;
    field(ui, "Into technique", "The technique that the picture dissolves into, pixel by pixel", |ui| {
        let title = |into: Option<Technique>| into.map_or("nothing", |technique| techniques::row(technique).title);
        egui::ComboBox::from_id_salt("dissolve-into")
            .selected_text(title(dissolve.into))
            .show_ui(ui, |ui| {
                for into in std::iter::once(None).chain(Technique::ALL.map(Some)) {
                    ui.selectable_value(&mut dissolve.into, into, title(into));
                }
            })
            .response
    });
    field(ui, "Into scene", "The stock scene that the picture dissolves into, seen by its first camera", |ui| {
        egui::ComboBox::from_id_salt("dissolve-scene")
            .selected_text(dissolve.scene.as_deref().unwrap_or("the same"))
            .show_ui(ui, |ui| {
                ui.selectable_value(&mut dissolve.scene, None, "the same");
                for scene in stock::TABLE {
                    ui.selectable_value(&mut dissolve.scene, Some(scene.name.into()), scene.name);
                }
            })
            .response
    });
    ui.add_enabled_ui(dissolve.into.is_some() || dissolve.scene.is_some(), |ui| {
        ui.horizontal_wrapped(|ui| {
            style::tight(ui);
            for pattern in Pattern::ALL {
                let response = ui.selectable_label(dissolve.pattern == pattern, capital(pattern.name()));
                if response.on_hover_text(capital(pattern.about())).clicked() {
                    dissolve.pattern = pattern;
                }
            }
        });
        ui.add_enabled_ui(dissolve.seconds <= 0.0, |ui| {
            field(ui, "Amount", "How many of the pixels have turned", |ui| ui.add(slider(&mut dissolve.amount, 0.0..=1.0)));
        });
        let tip = "Where this is not 0 the amount goes by time, there and back in so many seconds";
        field(ui, "Seconds", tip, |ui| ui.add(slider(&mut dissolve.seconds, 0.0..=20.0)));
    });
    explain(ui, "The stencil marks a pattern, and each of two pictures is drawn where the other is not (Kilgard 7, figure 16).");
}
