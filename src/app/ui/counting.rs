//! In how many bits shadows are counted, and what happens where they are too few.

use egui::{RichText, Ui};

use super::style::{self, explain, field, slider};
use super::technique::capital;
use super::{Desk, View};
use crate::settings::{MAX_COUNT_BITS, Overflow};
use crate::techniques::TOO_MANY;

/// Both settings, and what the plan made of them.
pub fn counting(ui: &mut Ui, desk: &mut Desk<'_>, view: &View<'_>) {
    let counting = &mut desk.settings.counting;
    field(ui, "Count bits", "Bits of the stencil that shadows are counted in: eight tell 255 volumes from none", |ui| {
        ui.add(slider(&mut counting.bits, 1..=MAX_COUNT_BITS))
    });
    ui.horizontal(|ui| {
        ui.label(RichText::new("Overflow").color(style::WEAK));
        for overflow in Overflow::ALL {
            let words = capital(overflow.name());
            let response = ui.selectable_label(counting.overflow == overflow, words);
            if response.on_hover_text(overflow.about()).clicked() {
                counting.overflow = overflow;
            }
        }
    });
    let notes: Vec<_> = view.plan.iter().flat_map(|plan| &plan.notes).filter(|note| note.contains(TOO_MANY)).collect();
    for note in &notes {
        ui.add(egui::Label::new(RichText::new(capital(note)).small().color(style::WARNING)).wrap());
    }
    if notes.is_empty() {
        explain(ui, "No pixel can lie in more volumes than these bits count, or nothing is counted in them.");
    }
}
