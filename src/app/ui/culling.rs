//! What is left out of counting shadows, and how each caster's volume was counted for one light (M's
//! cases).

use egui::{RichText, Ui, vec2};

use super::style::{self, explain};
use super::technique::capital;
use super::{Desk, View};
use crate::frame::{Method, VolumePlan};
use crate::settings::LightBounds;

/// The switches, and the table of casters.
pub fn culling(ui: &mut Ui, desk: &mut Desk<'_>, view: &View<'_>) {
    let culling = &mut desk.settings.culling;
    ui.checkbox(&mut culling.on, "Leave out what cannot matter").on_hover_text(
        "Volumes whose shadow meets nothing that is lit and in view are not counted, and caps that are out of view not drawn",
    );
    ui.checkbox(&mut culling.caster_scissors, "A scissor for each caster")
        .on_hover_text("Each volume is counted in a step of its own, behind a scissor of its own");
    ui.checkbox(&mut culling.footprints, "Only where shadows may fall").on_hover_text(
        "Counts a volume only in those cells of the picture where it may hold a surface: elsewhere its fronts and backs cancel",
    );
    ui.checkbox(&mut culling.clamping, "Clamped to receivers").on_hover_text(
        "Cuts each volume into the pieces about what can receive its shadow (Lloyd et al. 2004): between them nothing is drawn",
    );
    let tip = "Marks in the stencil which pixels' surfaces lie within a light's bounds, and counts only there. It takes a bit of the count";
    ui.checkbox(&mut culling.depth_bounds, "Depth bounds, by the stencil").on_hover_text(tip);
    if let Some(plan) = view.plan.filter(|_| culling.depth_bounds) {
        let words = plan.depth_bounds(desk.settings.light).map_or_else(
            || format!("Light {} has no bounds in depth here.", desk.settings.light),
            |solid| format!("Light {} is bounded by a {}; `stencil` shows the mark.", desk.settings.light, solid.name()),
        );
        explain(ui, words);
    }
    ui.horizontal_wrapped(|ui| {
        style::tight(ui);
        ui.label(RichText::new("Light bounds").color(style::WEAK));
        for bounds in LightBounds::ALL {
            let response = ui.selectable_label(culling.light_bounds == bounds, capital(bounds.name()));
            if response.on_hover_text(bounds.about()).clicked() {
                culling.light_bounds = bounds;
            }
        }
    });
    table(ui, desk, view);
}

/// Caster, case, method and reason, for the light that is looked at.
fn table(ui: &mut Ui, desk: &Desk<'_>, view: &View<'_>) {
    let (Some(scene), Some(plan)) = (view.scene, view.plan) else { return };
    let light = desk.settings.light;
    let of_light = || plan.casters().filter(move |pieces| pieces[0].view == 0 && pieces[0].light == light);
    let dropped = of_light().filter(|pieces| pieces[0].method == Method::Dropped).count();
    let name = scene.lights.get(light).map_or("", |light| light.name.as_str());
    explain(ui, format!("Light {light}, {name}: {} casters, {dropped} of them left out.", of_light().count()));
    let nodes: Vec<_> = scene.instances().map(|(_, node, _)| node.name.as_str()).collect();
    // Within the panel's own scrolling it would shrink to the least height otherwise.
    let table = egui::ScrollArea::vertical().id_salt("casters").max_height(220.0).min_scrolled_height(220.0);
    table.auto_shrink([false, true]).show(ui, |ui| {
        egui::Grid::new("casters").num_columns(3).striped(true).spacing(vec2(8.0, 2.0)).show(ui, |ui| {
            for pieces in of_light() {
                row(ui, nodes.get(pieces[0].instance).copied().unwrap_or(""), pieces);
                ui.end_row();
            }
        });
    });
}

fn row(ui: &mut Ui, name: &str, pieces: &[VolumePlan]) {
    let volume = &pieces[0];
    let color = if volume.method == Method::Dropped { style::WEAK } else { style::TEXT };
    let case = volume.case.map_or_else(|| "-".to_owned(), |case| case.number().to_string());
    let words = volume.case.map_or("no case: it is not counted", |case| case.words());
    ui.label(RichText::new(case).monospace().color(color)).on_hover_text(words);
    let cut = if pieces.len() > 1 { format!(", in {} pieces", pieces.len()) } else { String::new() };
    let tip = format!("{name}: {}{cut}", volume.reason.words());
    ui.label(RichText::new(volume.method.words()).color(color)).on_hover_text(&tip);
    ui.add(egui::Label::new(RichText::new(name).color(color)).truncate()).on_hover_text(&tip);
}
