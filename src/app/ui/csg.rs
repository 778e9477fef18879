//! Two solids put together: what becomes of them, and which they are.

use egui::{RichText, Ui};

use super::style::{self, explain, field};
use super::technique::capital;
use super::{Desk, View};
use crate::scene::Scene;
use crate::settings::Operation;

/// The operation, and A and B among all closed objects of the scene.
pub fn csg(ui: &mut Ui, desk: &mut Desk<'_>, view: &View<'_>) {
    let Some(scene) = view.scene else {
        explain(ui, "There is no scene.");
        return;
    };
    let csg = &mut desk.settings.csg;
    let meant = scene.operands;
    let operation = csg.operation.or(meant.map(|meant| meant.operation)).unwrap_or_default();
    ui.horizontal_wrapped(|ui| {
        style::tight(ui);
        for one in Operation::ALL {
            if ui.selectable_label(operation == one, capital(one.words())).clicked() {
                csg.operation = Some(one).filter(|one| Some(*one) != meant.map(|meant| meant.operation));
            }
        }
    });
    // The last node may be what casts the solid's shadow.
    let caster = scene.solid.as_ref().is_some_and(|solid| solid.caster.is_some());
    let closed: Vec<usize> =
        (0..scene.nodes.len() - usize::from(caster)).filter(|&node| scene.can_be_operand(node).is_ok()).collect();
    let operands = [("A", meant.map(|meant| meant.a), &mut csg.a), ("B", meant.map(|meant| meant.b), &mut csg.b)];
    for (letter, meant, chosen) in operands {
        choose(ui, letter, scene, &closed, meant, chosen);
    }
    if operation == Operation::Off {
        return;
    }
    match scene.operands_in_force(csg) {
        None => warn(ui, "Choose A and B: any two closed objects."),
        Some(both) if both.a == both.b => warn(ui, "A and B are the same object."),
        Some(_) => {}
    }
    for note in view.plan.iter().flat_map(|plan| &plan.notes).filter(|note| note.contains("solid") || note.contains("layers")) {
        warn(ui, note);
    }
}

fn warn(ui: &mut Ui, words: &str) {
    ui.add(egui::Label::new(RichText::new(capital(words)).small().color(style::WARNING)).wrap());
}

/// The node that shows one operand.
fn choose(ui: &mut Ui, letter: &str, scene: &Scene, closed: &[usize], meant: Option<usize>, chosen: &mut Option<usize>) {
    let name = |node: usize| scene.nodes.get(node).map_or("", |node| node.name.as_str());
    let shown = chosen.or(meant).map_or("none", name).to_owned();
    let tip = "Any closed, opaque object that nothing bends";
    field(ui, letter, tip, |ui| {
        let list = egui::ComboBox::from_id_salt(("csg", letter)).selected_text(shown).width(200.0);
        let response = list.show_ui(ui, |ui| {
            for &node in closed {
                let on = chosen.or(meant) == Some(node);
                if ui.selectable_label(on, format!("{} ({node})", name(node))).clicked() {
                    *chosen = Some(node).filter(|node| Some(*node) != meant);
                }
            }
        });
        response.response
    });
}
