//! Where silhouettes are found.

use egui::{RichText, Ui};

use super::style::{self, explain};
use super::technique::capital;
use super::{Desk, View};
use crate::settings::Backend;

/// The choice, and what the plan says of volumes that are built otherwise.
pub fn silhouettes(ui: &mut Ui, desk: &mut Desk<'_>, view: &View<'_>) {
    ui.horizontal(|ui| {
        ui.label(RichText::new("Silhouettes").color(style::WEAK));
        let there = view.capabilities.is_none_or(|capabilities| capabilities.compute_silhouettes.is_some());
        for backend in Backend::ALL {
            let words = if backend.is_cpu() { "CPU".to_owned() } else { capital(backend.name()) };
            let button = egui::Button::selectable(desk.settings.silhouettes == backend, words);
            let response = ui.add_enabled(backend.is_cpu() || there, button).on_hover_text(capital(backend.about()));
            if response.on_disabled_hover_text("This device has no indirect draws that say which volume they draw").clicked() {
                desk.settings.silhouettes = backend;
            }
        }
    });
    if let Some(plan) = view.plan.filter(|_| !desk.settings.silhouettes.is_cpu()) {
        let by_compute = plan.volumes.iter().filter(|volume| !volume.silhouette.is_cpu()).count();
        explain(ui, format!("{by_compute} of {} volumes are built on the device.", plan.volumes.len()));
    }
}
