//! The papers' figures: a click opens the scene with settings and camera set.

use egui::{RichText, Ui};

use super::style::{self, card, explain};
use super::{Action, Panel};
use crate::figures::{Paper, TABLE};

/// The list, paper by paper, and what is to be seen in the one that was chosen last.
pub fn figures(ui: &mut Ui, panel: &mut Panel, actions: &mut Vec<Action>) {
    explain(ui, "The papers' figures, each with scene, camera and settings.");
    let rows = egui::ScrollArea::vertical().id_salt("figures").max_height(260.0).min_scrolled_height(260.0);
    rows.auto_shrink([false, true]).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 2.0;
        for paper in Paper::ALL {
            ui.add(egui::Label::new(RichText::new(paper.title()).small().color(style::ACCENT)).wrap());
            for (number, figure) in TABLE.iter().enumerate().filter(|(_, figure)| figure.paper == paper) {
                let chosen = panel.figure == Some(number);
                let words = format!("{}: {}", figure.number, figure.title);
                let button = egui::Button::selectable(chosen, words).frame(chosen).truncate();
                if ui.add(button).on_hover_text(figure.seen).clicked() {
                    panel.figure = Some(number);
                    actions.push(Action::Figure(number));
                }
            }
        }
    });
    let Some(figure) = panel.figure.and_then(|number| TABLE.get(number)) else { return };
    ui.add_space(4.0);
    card(ui, |ui| {
        ui.label(RichText::new(format!("{} ({})", figure.number, figure.name)).small().color(style::ACCENT));
        explain(ui, figure.seen);
        if !figure.instead.is_empty() {
            explain(ui, format!("Here with {}.", figure.instead));
        }
    });
}
