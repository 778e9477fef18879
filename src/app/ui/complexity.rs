//! Depth complexity: what is counted, and what came of it.

use egui::{RichText, Ui};

use super::style::{self, explain};
use super::technique::capital;
use super::{Desk, View};
use crate::settings::{Complexity, Show};

/// The choice, and the numbers of the picture on show; nothing while something else is shown.
pub fn complexity(ui: &mut Ui, desk: &mut Desk<'_>, view: &View<'_>) {
    if desk.settings.show != Show::Complexity {
        return;
    }
    ui.horizontal(|ui| {
        ui.label(RichText::new("Counted").color(style::WEAK));
        for what in Complexity::ALL {
            let response = ui.selectable_label(desk.settings.complexity == what, capital(what.name()));
            if response.on_hover_text(format!("{}.", capital(what.about()))).clicked() {
                desk.settings.complexity = what;
            }
        }
    });
    if let Some(tally) = view.complexity.filter(|tally| tally.counted == desk.settings.complexity) {
        for line in tally.to_string().lines() {
            explain(ui, format!("{}.", capital(line)));
        }
    }
}
