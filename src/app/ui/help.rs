//! The help overlay: every key and gesture, from the one table.

use egui::{Align2, RichText, Ui, vec2};

use super::style;
use crate::app::keys::{Group, TABLE};

/// Shows the help over the picture; closes it where its button is pressed.
pub fn help(ui: &Ui, open: &mut bool) {
    let mut stays = true;
    egui::Window::new("Keys and mouse")
        .id(egui::Id::unique("help"))
        .open(&mut stays)
        .collapsible(false)
        .resizable(false)
        .anchor(Align2::CENTER_CENTER, vec2(0.0, 0.0))
        .show(ui.ctx(), |ui| {
            let height = ui.ctx().content_rect().height() - 90.0;
            egui::ScrollArea::vertical().max_height(height).min_scrolled_height(height).show(ui, |ui| {
                ui.horizontal_top(|ui| {
                    for groups in [&Group::ALL[..2], &Group::ALL[2..]] {
                        ui.vertical(|ui| {
                            ui.set_width(345.0);
                            for group in groups {
                                rows(ui, *group);
                            }
                        });
                    }
                });
            });
        });
    *open &= stays;
}

fn rows(ui: &mut Ui, group: Group) {
    ui.add_space(6.0);
    ui.label(RichText::new(group.title()).strong().color(style::ACCENT));
    egui::Grid::new(group.title()).num_columns(2).spacing(vec2(12.0, 5.0)).show(ui, |ui| {
        for row in TABLE.iter().filter(|row| row.group == group) {
            ui.label(RichText::new(row.keys).monospace().color(egui::Color32::WHITE));
            ui.scope(|ui| {
                ui.set_max_width(225.0);
                ui.add(egui::Label::new(row.about).wrap());
            });
            ui.end_row();
        }
    });
}
