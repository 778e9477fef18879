//! The scene's lights, each with what can be changed of it.

use egui::{Color32, RichText, Ui};

use super::style::{self, field, number, point, slider};
use super::{Desk, Panel, View};
use crate::scene::{Extent, Light, LightKind, PosedLight};
use crate::settings::{AreaMode, LightEdit, MAX_AREA_SAMPLES, SlideChoice};

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
    sizes(ui, desk, view);
    for (index, light) in scene.lights.iter().enumerate() {
        let posed = view.pose.and_then(|pose| pose.lights.get(index));
        ui.push_id(("light", index), |ui| one(ui, panel, desk, index, light, posed));
    }
}

/// How lights with a size are counted; nothing where there are none.
fn sizes(ui: &mut Ui, desk: &mut Desk<'_>, view: &View<'_>) {
    let posed = view.pose.map_or(&[][..], |pose| &pose.lights);
    if posed.iter().all(|light| light.extent.is_point()) {
        return;
    }
    let lighting = &mut desk.settings.lighting;
    field(ui, "Points a light", "Lights with a size are counted as so many points, each with shadow volumes of its own", |ui| {
        ui.add(slider(&mut lighting.area_samples, 1..=MAX_AREA_SAMPLES))
    });
    ui.horizontal(|ui| {
        ui.label(RichText::new("Kept in").color(style::WEAK));
        for (mode, words) in AreaMode::ALL.into_iter().zip(["The whole stencil", "A bit each"]) {
            let response = ui.selectable_label(lighting.area_mode == mode, words);
            if response.on_hover_text(format!("{}.", super::technique::capital(mode.about()))).clicked() {
                lighting.area_mode = mode;
            }
        }
    });
    lighting.light_sample = lighting.light_sample.min(lighting.area_samples - 1);
    let of_one_light = desk.settings.show.looks_at_light();
    let looked_at = posed.get(desk.settings.light).is_some_and(|light| !light.extent.is_point());
    if of_one_light && looked_at && lighting.area_samples > 1 {
        let last = lighting.area_samples - 1;
        field(ui, "Point shown", "Which point of the light stencil, shadow and volumes look at", |ui| {
            ui.add(slider(&mut lighting.light_sample, 0..=last))
        });
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
        let mut position = edit.position.unwrap_or(posed.center);
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
        let mut radius = edit.radius.unwrap_or(match light.extent {
            Extent::Point => 0.0,
            Extent::Round(radius) => radius,
            Extent::Rectangle([width, height]) => width.max(height) / 2.0,
        });
        let tip = "A light with a size throws soft shadows: it is counted as many points. 0 is a point";
        let size = field(ui, "Radius", tip, |ui| ui.add(number(&mut radius).speed(0.005).range(0.0..=100.0).suffix(" m")));
        if size.changed() {
            edit.radius = Some(radius);
        }
    }
    if let LightKind::Spot { .. } = light.kind {
        slide(ui, light, edit);
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

/// What a spot projects.
fn slide(ui: &mut Ui, light: &Light, edit: &mut LightEdit) {
    let own = if light.slide.is_some() { "the scene's" } else { "none" };
    field(ui, "Projects", "A picture in the cone of light, as of a slide projector", |ui| {
        egui::ComboBox::from_id_salt("slide")
            .selected_text(edit.slide.map_or(own, SlideChoice::name))
            .show_ui(ui, |ui| {
                if light.slide.is_some() {
                    ui.selectable_value(&mut edit.slide, None, own);
                }
                for slide in SlideChoice::ALL {
                    let choice = Some(slide).filter(|slide| light.slide.is_some() || *slide != SlideChoice::None);
                    ui.selectable_value(&mut edit.slide, choice, slide.name());
                }
            })
            .response
    });
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
