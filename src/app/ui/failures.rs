//! The failure gallery: choose a mistake, read about it, switch it off and on again to compare.

use egui::{RichText, Ui};

use super::style::{self, card, explain};
use super::{Action, Desk, Panel};
use crate::failures::{TABLE, row};

/// The list, and what is to be known of the one that was chosen last.
pub fn failures(ui: &mut Ui, panel: &mut Panel, desk: &mut Desk<'_>, actions: &mut Vec<Action>) {
    if desk.settings.failure.is_some() {
        panel.failure = desk.settings.failure;
    }
    explain(ui, "The classic mistakes of shadow volumes, made on purpose; each opens a scene that shows it well.");
    ui.spacing_mut().item_spacing.y = 2.0;
    for row in &TABLE {
        let on = desk.settings.failure == Some(row.failure);
        let title = if on { RichText::new(row.title).color(style::WARNING) } else { RichText::new(row.title) };
        let chosen = panel.failure == Some(row.failure);
        let tip = format!("{}\nSource: {}", row.seen, row.source);
        if ui.add(egui::Button::selectable(chosen, title).frame(chosen)).on_hover_text(tip).clicked() {
            panel.failure = Some(row.failure);
            actions.push(Action::Demonstrate(row.failure));
        }
    }
    let Some(failure) = panel.failure else { return };
    let row = row(failure);
    ui.add_space(4.0);
    card(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 4.0;
        let mut on = desk.settings.failure == Some(failure);
        let tip = "Off: the same view, drawn by the technique that is chosen above";
        if ui.checkbox(&mut on, "Make this mistake").on_hover_text(tip).changed() {
            desk.settings.failure = on.then_some(failure);
        }
        for (word, sentence) in [("Seen", row.seen), ("Why", row.why), ("Cure", row.cure)] {
            ui.label(RichText::new(word).small().color(style::ACCENT));
            explain(ui, sentence);
        }
        let counted = format!("Counted by {} while it is made. Source: {}.", row.technique.name(), row.source);
        ui.add(egui::Label::new(RichText::new(counted).small().italics().color(style::WEAK)).wrap());
    });
}
