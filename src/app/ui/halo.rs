//! Halos: what has one, its colour and its width.

use egui::Ui;

use super::style::{self, explain, field, slider};
use super::{Desk, View};
use crate::scene::Scene;
use crate::settings::{Halos, MAX_HALO_WIDTH};

/// Height of a row of the list, points.
const ROW: f32 = 20.0;

/// Colour and width, and the list of what may glow.
pub fn halos(ui: &mut Ui, desk: &mut Desk<'_>, view: &View<'_>) {
    let halos = &mut desk.settings.halos;
    field(ui, "Width", "How far a halo reaches, percent of the picture's height", |ui| {
        ui.add(slider(&mut halos.width, 0.0..=MAX_HALO_WIDTH).max_decimals(1).suffix(" %"))
    });
    let mut color = halos.color.to_array();
    let response = field(ui, "Colour", "The colour of all halos", |ui| ui.color_edit_button_rgb(&mut color));
    style::name_it(&response, "Halo colour");
    if response.changed() {
        halos.color = color.into();
    }
    match view.scene {
        Some(scene) if scene.instances().next().is_some() => list(ui, halos, scene),
        _ => _ = explain(ui, "Nothing is here that could glow."),
    }
}

/// Everything that shows something, or has something hanging on it that does.
fn list(ui: &mut Ui, halos: &mut Halos, scene: &Scene) {
    let mut shows: Vec<bool> = scene.nodes.iter().map(|node| node.mesh.is_some()).collect();
    for (index, node) in scene.nodes.iter().enumerate().rev() {
        if let Some(parent) = node.parent.filter(|_| shows[index]) {
            shows[parent] = true;
        }
    }
    let listed: Vec<usize> = (0..scene.nodes.len()).filter(|&node| shows[node]).collect();
    let glows = scene.glowing_nodes(&halos.edits);
    let depth = |mut node: usize| {
        let mut depth = 0u8;
        while let Some(parent) = scene.nodes[node].parent {
            (node, depth) = (parent, depth.saturating_add(1));
        }
        f32::from(depth.min(8))
    };
    #[expect(clippy::cast_precision_loss, reason = "a height")]
    let height = (listed.len() as f32 * (ROW + ui.spacing().item_spacing.y)).min(208.0);
    let rows = egui::ScrollArea::vertical().id_salt("halos").max_height(height).min_scrolled_height(height);
    rows.auto_shrink([false, true]).show_rows(ui, ROW, listed.len(), |ui, range| {
        for &node in &listed[range] {
            ui.horizontal(|ui| {
                ui.add_space(depth(node) * 12.0);
                let mut on = glows[node];
                let about = format!("Node {node}: a glow about it and all that hangs on it");
                ui.push_id(node, |ui| {
                    let response = ui.checkbox(&mut on, &scene.nodes[node].name).on_hover_text(about);
                    style::name_it(&response, format!("Halo: {}", scene.nodes[node].name));
                    if response.changed() {
                        scene.set_halo(&mut halos.edits, node, on);
                    }
                });
            });
        }
    });
}
