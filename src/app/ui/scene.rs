//! Which scene: stock scenes, files, what the importer and the mesh doctor say.

use std::path::PathBuf;

use egui::{Key, RichText, Ui};

use super::style::{self, card, explain};
use super::technique::capital;
use super::{Action, Desk, Panel, View};
use crate::scene::stock::DEMONSTRATIONS;
use crate::settings::SceneChoice;

/// Scenes and files.
pub fn scene(ui: &mut Ui, panel: &mut Panel, desk: &mut Desk<'_>, view: &View<'_>, actions: &mut Vec<Action>) {
    ui.horizontal_wrapped(|ui| {
        style::tight(ui);
        for stock in view.stock {
            let chosen = matches!(&desk.settings.scene, SceneChoice::Stock(name) if name == stock.name);
            if ui.add(egui::Button::selectable(chosen, stock.name)).on_hover_text(stock.about).clicked() {
                actions.push(Action::Open(SceneChoice::Stock(stock.name.into())));
            }
        }
    });
    match &desk.settings.scene {
        SceneChoice::Stock(name) => {
            if let Some(stock) = view.stock.iter().chain(DEMONSTRATIONS).find(|stock| stock.name == name) {
                explain(ui, format!("{}.", capital(stock.about).trim_end_matches('.')));
            }
        }
        SceneChoice::File(path) => {
            ui.add(egui::Label::new(RichText::new(path.display().to_string()).monospace()).wrap());
        }
    }
    if let Some(name) = view.opening {
        ui.horizontal(|ui| {
            ui.spinner();
            ui.label(format!("Opening {name} ..."));
        });
    }
    files(ui, panel, desk, actions);
    if let Some(scene) = view.scene
        && !scene.warnings.is_empty()
    {
        let count = scene.warnings.len();
        let words = format!("Import: {count} note{}", if count == 1 { "" } else { "s" });
        egui::CollapsingHeader::new(RichText::new(words).color(style::WARNING)).id_salt("warnings").show(ui, |ui| {
            for warning in &scene.warnings {
                explain(ui, format!("- {warning}"));
            }
        });
    }
    if !view.doctor.is_empty() {
        egui::CollapsingHeader::new("Mesh report").id_salt("doctor").show(ui, |ui| {
            explain(ui, "Whether each mesh is closed, and so how its shadow volume is built.");
            card(ui, |ui| {
                egui::ScrollArea::both().id_salt("doctor").max_height(220.0).min_scrolled_height(220.0).show(ui, |ui| {
                    ui.add(egui::Label::new(RichText::new(view.doctor).monospace().size(11.0)).extend());
                });
            });
        });
    }
}

/// Opening files, folded away until somebody wants to.
fn files(ui: &mut Ui, panel: &mut Panel, desk: &mut Desk<'_>, actions: &mut Vec<Action>) {
    let fold = egui::CollapsingHeader::new("File").id_salt("file").default_open(false).open(panel.focus_path.then_some(true));
    let response = fold.show(ui, |ui| {
        path_field(ui, panel, actions);
        ui.horizontal(|ui| {
            recent(ui, desk, actions);
            if ui.button("Reload").on_hover_text("Read the scene again (F5)").clicked() {
                actions.push(Action::Reload);
            }
        });
        ui.checkbox(&mut desk.settings.floor, "Floor beneath a file's scene")
            .on_hover_text("Adds a large floor under the scene, so that shadows have something to fall on");
    });
    response.header_response.on_hover_text("Open a .glb or .gltf file; files can also be dropped on the window (Ctrl+O)");
}

fn path_field(ui: &mut Ui, panel: &mut Panel, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        let width = ui.available_width() - 60.0;
        let field = egui::TextEdit::singleline(&mut panel.path).hint_text("path of a .glb or .gltf file").desired_width(width);
        let response = ui.add(field).on_hover_text("Type or paste a path, then Enter. Files can also be dropped on the window.");
        style::name_it(&response, "Path");
        // The fold may still be opening; a field that is not shown takes no focus.
        if panel.focus_path {
            panel.focus_path = !response.has_focus();
            response.request_focus();
        }
        let entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let path = pasted(&panel.path);
        let open = ui.add_enabled(path.is_some(), egui::Button::new("Open"));
        if let Some(path) = path.filter(|_| entered || open.clicked()) {
            actions.push(Action::Open(SceneChoice::File(path)));
        }
    });
}

/// The path in what people paste: file managers add quotes, `file://` and ends of line.
#[must_use]
pub fn pasted(text: &str) -> Option<PathBuf> {
    let text = text.trim();
    let quoted = |quote| text.strip_prefix(quote).and_then(|text| text.strip_suffix(quote));
    let text = quoted('"').or_else(|| quoted('\'')).unwrap_or(text);
    if let Some(rest) = text.strip_prefix("file://") {
        let path = rest.strip_prefix("localhost").unwrap_or(rest);
        return Some(percent_encoding::percent_decode_str(path).decode_utf8_lossy().into_owned().into());
    }
    if let Some(rest) = text.strip_prefix("~/") {
        return dirs::home_dir().map(|home| home.join(rest));
    }
    (!text.is_empty()).then(|| text.into())
}

fn recent(ui: &mut Ui, desk: &Desk<'_>, actions: &mut Vec<Action>) {
    let recent = &desk.preferences.recent;
    ui.add_enabled_ui(!recent.is_empty(), |ui| {
        ui.menu_button("Recent files", |ui| {
            for path in recent {
                let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
                if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
                    actions.push(Action::Open(SceneChoice::File(path.clone())));
                    ui.close();
                }
            }
            ui.separator();
            if ui.button("Forget all").clicked() {
                actions.push(Action::ForgetRecent);
                ui.close();
            }
        })
        .response
        .on_disabled_hover_text("No file was opened yet");
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pasted_paths_lose_what_file_managers_add() {
        let path = |text: &str| Some(PathBuf::from(text));
        assert_eq!(pasted(" /a/b c.glb\n"), path("/a/b c.glb"));
        assert_eq!(pasted("'/a/b.glb'"), path("/a/b.glb"));
        assert_eq!(pasted("\"/a/b.glb\""), path("/a/b.glb"));
        assert_eq!(pasted("file:///a/b%20c.glb\r\n"), path("/a/b c.glb"));
        assert_eq!(pasted("file://localhost/a.glb"), path("/a.glb"));
        assert_eq!(pasted("  "), None);
    }
}
