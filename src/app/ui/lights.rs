//! The scene's lights, each with what can be changed of it.

use egui::{Color32, RichText, Ui};

use super::style::{self, field, number, point};
use super::{Desk, Panel, View};
use crate::scene::{Light, LightKind, PosedLight};
use crate::settings::LightEdit;

/// All lights.
pub fn lights(ui: &mut Ui, panel: &mut Panel, desk: &mut Desk<'_>, view: &View<'_>) {
    let Some(scene) = view.scene.filter(|scene| !scene.lights.is_empty()) else {
        style::explain(ui, "This scene has no lights.");
        return;
    };
    ui.horizontal(|ui| {
        ui.checkbox(&mut desk.preferences.icons, "Icons over the picture").on_hover_text(
            "Each light as an icon that can be dragged: in the plane facing the camera, with Shift along one axis (G)",
        );
        if ui.add_enabled(!desk.settings.lights.is_empty(), egui::Button::new("Reset all")).clicked() {
            desk.settings.lights.clear();
        }
    });
    for (index, light) in scene.lights.iter().enumerate() {
        let posed = view.pose.and_then(|pose| pose.lights.get(index));
        ui.push_id(("light", index), |ui| one(ui, panel, desk, index, light, posed));
    }
}

fn one(ui: &mut Ui, panel: &mut Panel, desk: &mut Desk<'_>, index: usize, light: &Light, posed: Option<&PosedLight>) {
    let mut edit = desk.settings.lights.get(&index).cloned().unwrap_or_default();
    let before = edit.clone();
    let id = ui.make_persistent_id("fold");
    let mut fold = egui::collapsing_header::CollapsingState::load_with_default_open(ui.ctx(), id, false);
    if panel.unfold_light == Some(index) {
        fold.set_open(true);
        panel.unfold_light = None;
    }
    let header = fold.show_header(ui, |ui| {
        let mut on = edit.on.unwrap_or(true);
        let switch = ui.checkbox(&mut on, "").on_hover_text("Shines");
        style::name_it(&switch, format!("Light {index} on"));
        if switch.changed() {
            edit.on = (!on).then_some(false);
        }
        let mut color = edit.color.unwrap_or(light.color).to_array();
        let swatch = ui.color_edit_button_rgb(&mut color).on_hover_text("Colour");
        style::name_it(&swatch, format!("Light {index} colour"));
        if swatch.changed() {
            edit.color = Some(color.into());
        }
        let name = RichText::new(format!("{index}  {}", light.name));
        let name = if panel.selected_light == Some(index) { name.color(style::ACCENT) } else { name };
        let kind = match light.kind {
            LightKind::Point => "point",
            LightKind::Directional => "directional",
            LightKind::Spot { .. } => "spot",
        };
        if ui
            .add(egui::Label::new(name).truncate().sense(egui::Sense::click()))
            .on_hover_text(format!("A {kind} light"))
            .clicked()
        {
            panel.selected_light = Some(index);
        }
    });
    header.body(|ui| body(ui, index, light, posed, &mut edit));
    if edit != before {
        if edit == LightEdit::default() {
            desk.settings.lights.remove(&index);
        } else {
            desk.settings.lights.insert(index, edit);
        }
    }
}

fn body(ui: &mut Ui, index: usize, light: &Light, posed: Option<&PosedLight>, edit: &mut LightEdit) {
    if light.kind != LightKind::Directional
        && let Some(posed) = posed
    {
        let mut position = edit.position.unwrap_or(posed.position);
        if point(ui, "Position", "Where the light is", &mut position) {
            edit.position = Some(position);
        }
    }
    let directional = light.kind == LightKind::Directional;
    let unit = if directional { " lx" } else { " cd" };
    let mut intensity = edit.intensity.unwrap_or(light.intensity);
    let speed = (f64::from(intensity) * 0.01).max(0.01);
    let strength = field(ui, "Intensity", "How bright the light is: candela, or lux for directional lights", |ui| {
        ui.add(number(&mut intensity).speed(speed).range(0.0..=1.0e7).suffix(unit))
    });
    if strength.changed() {
        edit.intensity = Some(intensity);
    }
    if !directional {
        range(ui, light, edit);
    }
    let mut shadows = edit.shadows.unwrap_or(true);
    if ui.checkbox(&mut shadows, "Casts shadows").changed() {
        edit.shadows = (!shadows).then_some(false);
    }
    let reset = ui.add_enabled(*edit != LightEdit::default(), egui::Button::new(format!("Reset light {index}")));
    if reset.on_hover_text("Back to what the scene says").clicked() {
        *edit = LightEdit::default();
    }
}

fn range(ui: &mut Ui, light: &Light, edit: &mut LightEdit) {
    let tip = "Where the light ends; a smaller range is drawn faster";
    let mut range = edit.range.unwrap_or(light.range);
    let response = field(ui, "Range", tip, |ui| {
        if range.is_finite() {
            let speed = (f64::from(range) * 0.01).max(0.01);
            ui.add(number(&mut range).speed(speed).range(0.01..=1.0e5).suffix(" m"))
        } else {
            let mut response = ui.button(RichText::new("never ends").color(Color32::WHITE));
            if response.clicked() {
                range = 20.0;
                response.mark_changed();
            }
            response
        }
    });
    if response.changed() {
        edit.range = Some(range);
    }
}
