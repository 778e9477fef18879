//! The playground: its board edited live, and the calls that set the same states.

use egui::{ComboBox, DragValue, PointerButton, Rect, Response, RichText, Ui};
use glam::DVec2;

use super::style::{self, explain, field, name_it, slider};
use super::technique::capital;
use super::{Desk, Panel};
use crate::frame::state::Compare;
use crate::frame::stencil::StencilOp;
use crate::settings::boards::{self, PRESETS};
use crate::settings::{Api, Board, Face, Facing, MOST_SHAPES, Shape, ShapeKind, Show};
use crate::techniques::playground::calls::calls;
use crate::techniques::playground::{needs_two_draws, outline};

/// The whole section.
pub fn playground(ui: &mut Ui, panel: &mut Panel, desk: &mut Desk<'_>) {
    if desk.settings.show != Show::Playground {
        explain(ui, "Shapes drawn into the stencil one after another, every state free to choose (Kilgard 1999, 1).");
        if ui.button("Open the playground").clicked() {
            desk.settings.show = Show::Playground;
        }
        return;
    }
    let playground = &mut desk.settings.playground;
    let board = &mut playground.board;
    presets(ui, board);
    ui.checkbox(&mut playground.numbers, "Numbers").on_hover_text("The stencil's value in the middle of each cell of a grid");
    field(ui, "Clear to", "What the stencil holds before the first shape", |ui| ui.add(byte(&mut board.clear)));
    field(ui, "Clear depth", "What depth holds before the first shape: 0 is near, 1 far", |ui| {
        ui.add(slider(&mut board.clear_depth, 0.0..=1.0).max_decimals(2))
    });
    explain(ui, "Drawn in this order; drag them in the picture.");
    shapes(ui, board);
    copy(ui, panel, board);
}

fn presets(ui: &mut Ui, board: &mut Board) {
    let current = boards::name_of(board);
    field(ui, "Board", "Boards that show something", |ui| {
        ComboBox::from_id_salt("board")
            .selected_text(current.map_or_else(|| "your own".to_owned(), capital))
            .show_ui(ui, |ui| {
                for preset in PRESETS {
                    let response = ui.selectable_label(current == Some(preset.name), capital(preset.name));
                    if response.on_hover_text(capital(preset.about)).clicked() {
                        *board = (preset.build)();
                    }
                }
            })
            .response
    });
    if let Some(preset) = current.and_then(boards::find) {
        explain(ui, format!("{}.", capital(preset.about)));
    }
}

/// What is done with the list of shapes after it was shown.
enum Change {
    Remove(usize),
    Raise(usize),
}

fn shapes(ui: &mut Ui, board: &mut Board) {
    let mut change = None;
    for (index, shape) in board.shapes.iter_mut().enumerate() {
        let number = index + 1;
        let title = format!("{number} {}", shape.title());
        egui::CollapsingHeader::new(title).id_salt(("shape", index)).show(ui, |ui| {
            place(ui, shape);
            depth(ui, shape);
            face(ui, &format!("{number} front"), "Front faces", &mut shape.front);
            let mut apart = shape.back.is_some();
            if ui.checkbox(&mut apart, "Back faces apart").on_hover_text("Else both faces have the same state").changed() {
                shape.back = apart.then_some(shape.front);
            }
            if let Some(back) = &mut shape.back {
                face(ui, &format!("{number} back"), "Back faces", back);
            }
            if needs_two_draws(shape) {
                explain(
                    ui,
                    "The faces differ in reference or masks, of which wgpu has one for both: the shape is drawn twice, front faces and then back faces.",
                );
            }
            ui.horizontal(|ui| {
                if ui.add_enabled(index > 0, egui::Button::new("Earlier")).on_hover_text("Draws it before the one above").clicked() {
                    change = Some(Change::Raise(index));
                }
                if ui.button("Remove").clicked() {
                    change = Some(Change::Remove(index));
                }
            });
        });
    }
    match change {
        Some(Change::Remove(index)) => _ = board.shapes.remove(index),
        Some(Change::Raise(index)) => board.shapes.swap(index - 1, index),
        None => {}
    }
    let room = board.shapes.len() < MOST_SHAPES;
    if ui.add_enabled(room, egui::Button::new("Add a shape")).clicked() {
        let front = Face { reference: 1, pass: StencilOp::Replace, ..Face::default() };
        board.shapes.push(Shape { kind: ShapeKind::Disc, front, ..Shape::default() });
    }
}

fn place(ui: &mut Ui, shape: &mut Shape) {
    ui.horizontal_wrapped(|ui| {
        style::tight(ui);
        for kind in ShapeKind::ALL {
            ui.selectable_value(&mut shape.kind, kind, capital(kind.name()));
        }
    });
    ui.horizontal(|ui| {
        ui.label(RichText::new("Seen from").color(style::WEAK));
        ui.selectable_value(&mut shape.facing, Facing::Front, "Front");
        ui.selectable_value(&mut shape.facing, Facing::Back, "Back");
    });
    let share = |ui: &mut Ui, label: &str, tip: &str, value: &mut f32, range| {
        field(ui, label, tip, |ui| ui.add(slider(value, range).max_decimals(2)));
    };
    share(ui, "Across", "Its middle, a share of the picture's width", &mut shape.at[0], 0.0..=1.0);
    share(ui, "Down", "Its middle, a share of the picture's height", &mut shape.at[1], 0.0..=1.0);
    share(ui, "Width", "A share of the picture's height", &mut shape.size[0], 0.02..=2.0);
    share(ui, "Height", "A share of the picture's height", &mut shape.size[1], 0.02..=2.0);
    share(ui, "Turned", "Counter-clockwise, degrees", &mut shape.turn, -180.0..=180.0);
}

fn depth(ui: &mut Ui, shape: &mut Shape) {
    field(ui, "Depth", "0 is near, 1 far", |ui| ui.add(slider(&mut shape.depth, 0.0..=1.0).max_decimals(2)));
    field(ui, "Depth test", "Its depth against what is stored", |ui| compare(ui, "depth test", &mut shape.depth_compare));
    ui.checkbox(&mut shape.depth_write, "Writes depth");
}

/// The eight items of one face.
fn face(ui: &mut Ui, id: &str, title: &str, face: &mut Face) {
    style::card(ui, |ui| {
        ui.label(RichText::new(title).strong());
        field(ui, "Compare", "The reference against what is stored, both under the read mask", |ui| {
            compare(ui, id, &mut face.compare)
        });
        for (label, tip, op) in [
            ("Fail", "Where the stencil test fails", &mut face.fail),
            ("Depth fail", "Where the stencil test passes and the depth test fails", &mut face.depth_fail),
            ("Pass", "Where both pass", &mut face.pass),
        ] {
            field(ui, label, tip, |ui| operation(ui, id, label, op));
        }
        for (label, tip, value) in [
            ("Reference", "What is compared, and what Replace stores", &mut face.reference),
            ("Read mask", "Bits that the comparison sees", &mut face.read_mask),
            ("Write mask", "Bits that the operations change", &mut face.write_mask),
        ] {
            ui.horizontal(|ui| {
                let response = field(ui, label, tip, |ui| ui.add(byte(value)));
                name_it(&response, format!("{id} {}", label.to_lowercase()));
                ui.label(RichText::new(format!("{value:08b}")).monospace().color(style::WEAK));
            });
        }
    });
}

fn byte(value: &mut u8) -> DragValue<'_> {
    DragValue::new(value).hexadecimal(2, false, false).prefix("0x").speed(0.25)
}

fn compare(ui: &mut Ui, id: &str, value: &mut Compare) -> Response {
    let combo = ComboBox::from_id_salt((id, "compare")).selected_text(value.name());
    combo
        .show_ui(ui, |ui| {
            for one in Compare::ALL {
                ui.selectable_value(value, one, one.name());
            }
        })
        .response
}

fn operation(ui: &mut Ui, id: &str, label: &str, value: &mut StencilOp) -> Response {
    let combo = ComboBox::from_id_salt((id, label)).selected_text(value.name());
    combo
        .show_ui(ui, |ui| {
            for one in StencilOp::ALL {
                ui.selectable_value(value, one, one.name());
            }
        })
        .response
}

fn copy(ui: &mut Ui, panel: &mut Panel, board: &Board) {
    ui.separator();
    ui.horizontal_wrapped(|ui| {
        style::tight(ui);
        for api in Api::ALL {
            ui.selectable_value(&mut panel.api, api, api.title());
        }
    });
    let text = calls(board, panel.api);
    if ui.button("Copy calls").on_hover_text("The calls that set all of these states, to the clipboard").clicked() {
        ui.ctx().copy_text(text.clone());
    }
    let lines = egui::ScrollArea::both().id_salt("calls").max_height(220.0).min_scrolled_height(220.0);
    lines.auto_shrink([false, true]).show(ui, |ui| {
        ui.add(egui::Label::new(RichText::new(text).monospace().size(10.5)).extend());
    });
}

/// Shapes follow the mouse.
pub fn drag(response: &Response, panel: &mut Panel, desk: &mut Desk<'_>, rect: Rect) {
    let (size, shapes) = (desk.settings.size, &mut desk.settings.playground.board.shapes);
    if response.drag_started_by(PointerButton::Primary)
        && let Some(at) = response.ctx.input(|input| input.pointer.press_origin())
    {
        let share = (at - rect.min) / rect.size();
        let at = DVec2::new(f64::from(share.x), f64::from(share.y)) * DVec2::from(size.map(f64::from));
        // What was drawn last lies on top.
        panel.dragged_shape = shapes.iter().rposition(|shape| holds(&outline(shape, size), at));
    }
    if !response.dragged() {
        panel.dragged_shape = None;
    }
    if let Some(shape) = panel.dragged_shape.and_then(|index| shapes.get_mut(index)) {
        let moved = response.drag_delta() / rect.size();
        shape.at = [(shape.at[0] + moved.x).clamp(0.0, 1.0), (shape.at[1] + moved.y).clamp(0.0, 1.0)];
    }
}

/// Whether a polygon holds a point: its sides cross the way to the right an odd number of times.
fn holds(polygon: &[DVec2], at: DVec2) -> bool {
    let sides = polygon.iter().zip(polygon.iter().cycle().skip(1));
    let crosses = |(from, to): &(&DVec2, &DVec2)| {
        (from.y > at.y) != (to.y > at.y) && at.x < from.x + (at.y - from.y) / (to.y - from.y) * (to.x - from.x)
    };
    sides.filter(crosses).count() % 2 == 1
}
