//! Where the scene is seen from.

use egui::Ui;

use super::style::{self, field, number, point, slider};
use super::{Desk, View};
use crate::app::control::{self, Mode, Place};
use crate::frame::Camera;
use crate::settings::CameraChoice;

/// Named cameras, the mouse's mode, angle of view, and the place in numbers.
pub fn camera(ui: &mut Ui, desk: &mut Desk<'_>, view: &View<'_>) {
    let cameras = view.scene.map_or(&[][..], |scene| &scene.cameras);
    ui.horizontal(|ui| {
        let current = match &desk.settings.camera {
            CameraChoice::First => cameras.first().map_or("first", |camera| &camera.name).to_owned(),
            CameraChoice::Named(name) => name.clone(),
            CameraChoice::Free { .. } => "free".into(),
        };
        let list = egui::ComboBox::from_id_salt("camera").selected_text(current).width(140.0).show_ui(ui, |ui| {
            for (index, camera) in cameras.iter().enumerate() {
                let choice = named(index, &camera.name, cameras);
                if ui.selectable_label(desk.settings.camera == choice, &camera.name).clicked() {
                    desk.settings.camera = choice;
                    desk.settings.fov = None;
                }
            }
        });
        style::name_it(&list.response, "Camera of the scene");
        for (mode, words, tip) in [
            (Mode::Orbit, "Orbit", "Dragging turns the eye about its target (O)"),
            (Mode::Fly, "Fly", "Dragging turns the eye where it is; W A S D Q E fly in both modes (O)"),
        ] {
            if ui.selectable_label(desk.preferences.mode == mode, words).on_hover_text(tip).clicked() {
                desk.preferences.mode = mode;
            }
        }
    });
    let Some(shown) = super::camera_of(desk.settings, view) else {
        if ui.button("Reset camera").clicked() {
            reset(desk);
        }
        return;
    };
    field(ui, "Flying", "Flying speed; Shift makes it four times as fast", |ui| {
        ui.add(number(&mut desk.preferences.fly_speed).speed(0.05).range(0.05..=200.0).max_decimals(2).suffix(" m/s"))
    });
    let mut degrees = shown.vertical_fov.to_degrees();
    let angle = field(ui, "View angle", "Vertical angle of view, degrees", |ui| {
        ui.add(slider(&mut degrees, 5.0..=150.0).fixed_decimals(1).suffix("°"))
    });
    if angle.changed() {
        desk.settings.fov = Some(degrees);
    }
    far_plane(ui, desk, &shown);
    let mut place = Place { eye: shown.eye, target: shown.target() };
    let eye = point(ui, "Eye", "Where the eye is", &mut place.eye);
    let target = point(ui, "Target", "What the eye looks at", &mut place.target);
    if eye || target {
        control::place(desk.settings, &shown, place);
    }
    ui.horizontal(|ui| {
        let changed = desk.settings.camera != CameraChoice::First || desk.settings.fov.is_some();
        if ui.add_enabled(changed, egui::Button::new("Reset camera")).on_hover_text("The scene's first camera (R)").clicked() {
            reset(desk);
        }
        let copy = ui.button("Copy place").on_hover_text("Copy --eye, --target and --fov for the command line");
        if copy.clicked() {
            ui.ctx().copy_text(words(&shown));
        }
    });
}

/// Whether there is a far plane, and where: volumes need none, and suffer from one.
fn far_plane(ui: &mut Ui, desk: &mut Desk<'_>, shown: &Camera) {
    let mut there = desk.settings.far.is_some();
    let tip = "Cuts surfaces and shadow volumes off, as every projection but an infinite one does: \
               what is counted from infinity (z-fail) then goes wrong (McGuire et al. 2003, 3)";
    ui.horizontal(|ui| {
        if ui.checkbox(&mut there, "Far plane").on_hover_text(tip).changed() {
            // Where the view's target is, something is there to be cut.
            desk.settings.far = there.then(|| (shown.focus_distance * 1.5).max(shown.near * 2.0));
        }
        if let Some(far) = &mut desk.settings.far {
            let least = shown.near * 1.01;
            let response = ui.add(number(far).speed(0.05).range(least..=1e6).max_decimals(2).suffix(" m"));
            style::name_it(&response, "Distance of the far plane");
        }
    });
}

/// The scene's first camera, as it was made.
pub fn reset(desk: &mut Desk<'_>) {
    desk.settings.camera = CameraChoice::First;
    desk.settings.fov = None;
}

/// The settings' word for the camera of this index: its name, or the index where the name is not its own.
#[must_use]
pub fn named(index: usize, name: &str, cameras: &[crate::scene::Camera]) -> CameraChoice {
    let first = cameras.iter().position(|camera| camera.name == name);
    CameraChoice::Named(if first == Some(index) { name.to_owned() } else { index.to_string() })
}

/// The camera as options of the command line.
fn words(camera: &Camera) -> String {
    let point = |p: glam::DVec3| format!("{:.4},{:.4},{:.4}", p.x, p.y, p.z);
    format!("--eye {} --target {} --fov {:.2}", point(camera.eye), point(camera.target()), camera.vertical_fov.to_degrees())
}
