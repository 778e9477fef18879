//! What is drawn into the scene from the side.

use egui::{RichText, Ui};

use super::Desk;
use super::style::{self, explain};
use super::technique::capital;
use crate::settings::{Diagram, Show};

/// The choice; nothing while something else is shown.
pub fn diagram(ui: &mut Ui, desk: &mut Desk<'_>) {
    if desk.settings.show != Show::Rays {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new("Drawn in").color(style::WEAK));
        for what in Diagram::ALL {
            let response = ui.selectable_label(desk.settings.diagram == what, capital(&what.name().replace('-', " ")));
            if response.on_hover_text(format!("{}.", capital(what.about()))).clicked() {
                desk.settings.diagram = what;
            }
        }
    });
    explain(ui, format!("{}.", capital(desk.settings.diagram.about())));
}
