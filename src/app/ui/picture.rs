//! The picture's part of the window: what mouse and held keys do there.

use egui::{PointerButton, Rect, Response, Sense, Ui};
use glam::DVec2;

use super::{Action, Desk, Marks, Panel, View, gizmo, mirrors, numbers, planar, playground};
use crate::app::control::{self, Mode};
use crate::app::keys;
use crate::frame::Camera;
use crate::settings::Show;

/// Points of wheel travel that egui reports for one notch.
const NOTCH: f64 = 50.0;

/// Takes what is left of the window for the picture; moves the camera and the lights.
pub fn picture(ui: &mut Ui, panel: &mut Panel, desk: &mut Desk<'_>, view: &View<'_>, actions: &mut Vec<Action>) -> Rect {
    let rect = ui.available_rect_before_wrap();
    let response = ui.allocate_rect(rect, Sense::click_and_drag());
    super::style::name_it(&response, "Picture");
    if let Some(texture) = view.picture {
        let whole = Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(1.0, 1.0));
        ui.painter().image(texture, rect, whole, egui::Color32::WHITE);
    }
    let scale = ui.ctx().pixels_per_point();
    desk.settings.size = [rect.width(), rect.height()].map(|side| (side * scale).round().max(1.0) as u32);
    if response.clicked() || response.drag_started() {
        ui.ctx().memory_mut(|memory| {
            if let Some(focused) = memory.focused() {
                memory.surrender_focus(focused);
            }
        });
    }
    if desk.settings.show == Show::Playground {
        playground::drag(&response, panel, desk, rect);
        return rect;
    }
    let Some(camera) = super::camera_of(desk.settings, view) else { return rect };
    let held = response.is_pointer_button_down_on();
    // A light is taken by the press itself: one that moves on its own is elsewhere by the time the
    // press turns out to be a drag.
    let pressed = ui.input(|input| input.pointer.primary_pressed().then(|| input.pointer.press_origin()).flatten());
    if let Some(at) = pressed
        && held
        && panel.marks.is_none()
    {
        panel.drag = gizmo::grab(panel.selected_light, &panel.icons, desk, view, &seen_by(desk, view, camera), rect, at);
    }
    if response.clicked()
        && let Some(at) = response.interact_pointer_pos()
    {
        if let Some(marks) = panel.marks {
            let click = match marks {
                Marks::Mirrors => mirrors::click,
                Marks::Receivers => planar::click,
            };
            click(desk, view, &seen_by(desk, view, camera), rect, at, actions);
        } else {
            match panel
                .drag
                .take()
                .or_else(|| gizmo::grab(None, &panel.icons, desk, view, &seen_by(desk, view, camera), rect, at))
            {
                Some(light) => panel.choose_light(light.light),
                None => panel.selected_light = None,
            }
        }
    }
    match panel.drag {
        Some(mut drag) if held => {
            if let Some(mouse) = response.interact_pointer_pos()
                && response.dragged_by(PointerButton::Primary)
            {
                panel.choose_light(drag.light);
                gizmo::follow(
                    &mut drag,
                    desk,
                    &seen_by(desk, view, camera),
                    rect,
                    mouse,
                    ui.input(|input| input.modifiers.shift),
                );
                panel.drag = Some(drag);
            }
        }
        _ => {
            panel.drag = None;
            turn(&response, desk, &camera, rect);
        }
    }
    wheel(ui, &response, desk, view);
    fly(ui, desk, view);
    if let Some(camera) = super::camera_of(desk.settings, view) {
        let camera = seen_by(desk, view, camera);
        panel.icons = gizmo::paint(ui, panel.selected_light, panel.drag, desk, view, &camera, rect);
    }
    super::verify::overlay(ui, rect, desk, view);
    if let Some(marks) = panel.marks {
        let words = match marks {
            Marks::Mirrors => "click a flat surface: a mirror, or none any more | X or Esc ends this",
            Marks::Receivers => "click a flat surface: it takes planar shadows, or none any more | Z or Esc ends this",
        };
        // Above what stands there while the panel is hidden.
        numbers::caption(ui, rect.with_max_y(rect.max.y - 26.0), words);
        response.on_hover_cursor(egui::CursorIcon::Crosshair);
    }
    rect
}

/// What the picture is seen by: the eye that the settings ask for, or the one above that looks down on it.
fn seen_by(desk: &Desk<'_>, view: &View<'_>, eye: Camera) -> Camera {
    let above = view.plan.filter(|_| desk.settings.show == Show::Bounds).and_then(|plan| plan.views.first());
    above.map_or(eye, |above| above.camera)
}

fn turn(response: &Response, desk: &mut Desk<'_>, camera: &Camera, rect: Rect) {
    let moved = response.drag_delta() / rect.height().max(1.0);
    if moved == egui::Vec2::ZERO {
        return;
    }
    let moved = DVec2::new(f64::from(moved.x), f64::from(moved.y));
    let place = if response.dragged_by(PointerButton::Primary) {
        match desk.preferences.mode {
            Mode::Orbit => control::orbit(camera, moved),
            Mode::Fly => control::look(camera, moved),
        }
    } else {
        control::pan(camera, moved)
    };
    control::place(desk.settings, camera, place);
}

fn wheel(ui: &Ui, response: &Response, desk: &mut Desk<'_>, view: &View<'_>) {
    let notches = f64::from(ui.input(|input| input.smooth_scroll_delta().y)) / NOTCH;
    if notches == 0.0 || !response.hovered() {
        return;
    }
    match (desk.preferences.mode, super::camera_of(desk.settings, view)) {
        (Mode::Orbit, Some(camera)) => control::place(desk.settings, &camera, control::zoom(&camera, notches)),
        (Mode::Fly, _) => {
            desk.preferences.fly_speed = (desk.preferences.fly_speed * 1.15f64.powf(notches)).clamp(0.05, 200.0);
        }
        (Mode::Orbit, None) => {}
    }
}

fn fly(ui: &Ui, desk: &mut Desk<'_>, view: &View<'_>) {
    if ui.ctx().egui_wants_keyboard_input() {
        return;
    }
    let ([right, up, forward], fast, elapsed) =
        ui.input(|input| (keys::flight(input), input.modifiers.shift, f64::from(input.stable_dt).min(0.1)));
    if [right, up, forward] == [0.0; 3] {
        return;
    }
    ui.ctx().request_repaint();
    if let Some(camera) = super::camera_of(desk.settings, view) {
        let metres = desk.preferences.fly_speed * elapsed * if fast { 4.0 } else { 1.0 };
        control::place(desk.settings, &camera, control::fly(&camera, right * metres, up * metres, forward * metres));
    }
}
