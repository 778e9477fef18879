//! The panel, and what mouse and keys do: all of it on egui, so that tests can click through it
//! without a window.
//!
//! The panel edits [`Settings`] (and the window's own [`Preferences`]); what only the window can
//! do, it asks for by [`Action`]s. It reads scene, plan and numbers from a [`View`], and never
//! touches the GPU.

mod camera;
mod commands;
mod complexity;
mod counting;
mod csg;
mod culling;
mod decals;
mod diagram;
mod dissolve;
mod failures;
mod figures;
mod gather;
mod gizmo;
mod halo;
mod help;
mod lights;
mod mirrors;
mod numbers;
mod picture;
mod planar;
mod playground;
mod scene;
mod silhouettes;
pub mod style;
mod technique;
mod time;
mod verify;

pub use gizmo::project;
pub use numbers::{FrameNumbers, History};
pub use scene::pasted;
pub use time::moves;

use egui::{Rect, RichText, Ui};

use super::store::Preferences;
use super::verify::Verification;
use crate::frame::{Camera, Capabilities, FramePlan};
use crate::scene::stock::StockScene;
use crate::scene::{Pose, Scene};
use crate::settings::{Api, Failure, SceneChoice, Settings};
use crate::techniques::complexity::Tally;

/// What the panel edits.
pub struct Desk<'a> {
    /// What is drawn.
    pub settings: &'a mut Settings,
    /// How the window works.
    pub preferences: &'a mut Preferences,
}

/// What the panel shows.
#[derive(Clone, Copy)]
pub struct View<'a> {
    /// The stock scenes.
    pub stock: &'a [StockScene],
    /// The scene that is drawn.
    pub scene: Option<&'a Scene>,
    /// Where everything in it was when it was drawn last.
    pub pose: Option<&'a Pose>,
    /// How it was drawn last.
    pub plan: Option<&'a FramePlan>,
    /// What the mesh doctor says of it.
    pub doctor: &'a str,
    /// The name of what is being opened.
    pub opening: Option<&'a str>,
    /// What should be known.
    pub notices: &'a [Notice],
    /// What the device can do.
    pub capabilities: Option<&'a Capabilities>,
    /// The picture's depth complexity, where that is shown.
    pub complexity: Option<Tally>,
    /// The last frames.
    pub history: &'a History,
    /// What exact rays say of the picture.
    pub verification: &'a Verification,
    /// The picture, where the panel has to draw it; else it is copied beneath.
    pub picture: Option<egui::TextureId>,
}

/// Something that the user should know.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Notice {
    /// What it is about; a newer notice on the same thing replaces it.
    pub topic: Topic,
    /// How bad it is.
    pub tone: Tone,
    /// One or two sentences.
    pub words: String,
}

/// What a notice is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Topic {
    /// Opening a scene.
    Scene,
    /// Shaders read from a folder.
    Shaders,
    /// Planning and drawing.
    Frame,
    /// Saving and copying pictures.
    Picture,
    /// Settings kept between runs.
    Store,
    /// The device.
    Device,
    /// A surface that was made a mirror, or was to be.
    Mirrors,
    /// A surface that was made a receiver of planar shadows, or was to be.
    Receivers,
}

/// How bad it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tone {
    /// It went well.
    Good,
    /// It should be known.
    Warning,
    /// It went wrong.
    Error,
}

/// What the panel asks the window for.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// Opens another scene.
    Open(SceneChoice),
    /// Shows a failure of the gallery where it shows well.
    Demonstrate(Failure),
    /// Shows a figure of the papers, by its number in the table.
    Figure(usize),
    /// Reads the scene again.
    Reload,
    /// Forgets the files opened before.
    ForgetRecent,
    /// Saves the picture.
    Screenshot,
    /// Copies the command that draws the picture.
    CopyCommand,
    /// Holds the picture against exact rays.
    Verify,
    /// Says something to the user.
    Tell(Notice),
    /// Takes a notice away.
    Dismiss(Topic),
    /// Throws the device away, which then is rebuilt.
    LoseDevice,
    /// The whole screen, or a window.
    ToggleFullscreen,
    /// Ends the program.
    Quit,
}

/// What came of one pass.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// What is asked of the window, in order.
    pub actions: Vec<Action>,
    /// Where the picture goes, points. [`Settings::size`] is its size in pixels.
    pub picture: Rect,
}

/// What the panel itself remembers between passes.
#[derive(Debug, Default)]
pub struct Panel {
    /// What stands in the path field.
    pub path: String,
    /// The help overlay is open.
    pub help: bool,
    /// The failure that was chosen last, also while it is off.
    failure: Option<Failure>,
    /// The figure that was chosen last.
    figure: Option<usize>,
    focus_path: bool,
    /// What clicks on the picture make of surfaces.
    marks: Option<Marks>,
    selected_light: Option<usize>,
    unfold_light: Option<usize>,
    /// Whose calls the playground shows.
    api: Api,
    /// The playground's shape that follows the mouse.
    dragged_shape: Option<usize>,
    drag: Option<gizmo::Drag>,
    /// Where each light's icon was painted last.
    icons: Vec<(usize, egui::Pos2)>,
}

/// What a click on the picture makes of a flat surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Marks {
    /// A mirror.
    Mirrors,
    /// A receiver of planar shadows.
    Receivers,
}

impl Panel {
    fn toggle_marks(&mut self, marks: Marks) {
        self.marks = if self.marks == Some(marks) { None } else { Some(marks) };
    }

    /// A box that says whether clicks do that.
    fn marks_box(&mut self, ui: &mut Ui, marks: Marks, words: &str, tip: &str) {
        let mut on = self.marks == Some(marks);
        if ui.checkbox(&mut on, words).on_hover_text(tip).changed() {
            self.toggle_marks(marks);
        }
    }

    /// One pass over everything.
    pub fn show(&mut self, ui: &mut Ui, mut desk: Desk<'_>, view: &View<'_>) -> Outcome {
        let mut actions = Vec::new();
        commands::run(ui.ctx(), self, &mut desk, view, &mut actions);
        if desk.preferences.panel {
            let frame =
                egui::Frame::new().fill(style::PANEL).inner_margin(egui::Margin { left: 12, right: 6, top: 8, bottom: 4 });
            egui::Panel::left("panel").default_size(334.0).size_range(280.0..=460.0).frame(frame).show(ui, |ui| {
                self.header(ui, view, &mut actions);
                egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
                    // Room for the scroll bar.
                    ui.set_max_width(ui.available_width() - 6.0);
                    self.sections(ui, &mut desk, view, &mut actions);
                });
            });
        }
        let frame = egui::Frame::NONE;
        let picture = egui::CentralPanel::no_frame()
            .frame(frame)
            .show(ui, |ui| picture::picture(ui, self, &mut desk, view, &mut actions))
            .inner;
        if !desk.preferences.panel {
            self.floating(ui, &desk, view, picture, &mut actions);
        }
        if self.help {
            help::help(ui, &mut self.help);
        }
        Outcome { actions, picture }
    }

    /// A light was picked on the picture: the panel unfolds it.
    fn choose_light(&mut self, light: usize) {
        if self.selected_light != Some(light) {
            self.selected_light = Some(light);
            self.unfold_light = Some(light);
        }
    }

    fn header(&mut self, ui: &mut Ui, view: &View<'_>, actions: &mut Vec<Action>) {
        ui.horizontal(|ui| {
            ui.label(RichText::new("Obscura").heading().strong().color(style::ACCENT));
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if ui.button("Help").on_hover_text("All keys (F1)").clicked() {
                    self.help = !self.help;
                }
                if ui.button("Copy").on_hover_text("Copy the command that draws this picture (Ctrl+C)").clicked() {
                    actions.push(Action::CopyCommand);
                }
                let tip = "Save the picture, without the panel; its metadata holds the command that draws it again (F12)";
                if ui.button("Save picture").on_hover_text(tip).clicked() {
                    actions.push(Action::Screenshot);
                }
            });
        });
        notices(ui, view.notices, actions);
    }

    fn sections(&mut self, ui: &mut Ui, desk: &mut Desk<'_>, view: &View<'_>, actions: &mut Vec<Action>) {
        style::section_unfolded(ui, "Scene", true, self.focus_path, |ui| scene::scene(ui, self, desk, view, actions));
        style::section(ui, "Frame", true, |ui| numbers::numbers(ui, desk, view));
        style::section(ui, "Technique", true, |ui| {
            technique::techniques(ui, desk);
            silhouettes::silhouettes(ui, desk, view);
        });
        style::section(ui, "Show", true, |ui| technique::show(ui, desk, view));
        style::section(ui, "Decals", false, |ui| decals::decals(ui, desk, view));
        style::section(ui, "Dissolve", false, |ui| dissolve::dissolve(ui, desk));
        style::section(ui, "Stencil playground", false, |ui| playground::playground(ui, self, desk));
        style::section(ui, "Figures", false, |ui| figures::figures(ui, self, actions));
        style::section(ui, "Failures", false, |ui| failures::failures(ui, self, desk, actions));
        style::section(ui, "Proof", true, |ui| verify::verify(ui, desk, view, actions));
        style::section(ui, "Lights", true, |ui| lights::lights(ui, self, desk, view));
        style::section(ui, "Gathering", true, |ui| gather::gather(ui, desk, view));
        style::section(ui, "Mirrors", true, |ui| mirrors::mirrors(ui, self, desk, view));
        style::section(ui, "Solids", false, |ui| csg::csg(ui, desk, view));
        style::section(ui, "Halos", false, |ui| halo::halos(ui, desk, view));
        style::section(ui, "Planar shadows", true, |ui| planar::planar(ui, self, desk, view));
        style::section(ui, "Count", false, |ui| counting::counting(ui, desk, view));
        style::section(ui, "Culling", false, |ui| culling::culling(ui, desk, view));
        style::section(ui, "Camera", true, |ui| camera::camera(ui, desk, view));
        style::section(ui, "Time", true, |ui| time::time(ui, desk, view));
        style::section(ui, "How this frame is drawn", false, |ui| numbers::plan(ui, view));
        style::section(ui, "Device", false, |ui| numbers::device(ui, view));
    }

    /// What stays on the picture while the panel is hidden.
    fn floating(&self, ui: &Ui, desk: &Desk<'_>, view: &View<'_>, picture: Rect, actions: &mut Vec<Action>) {
        let frame = view.history.median(|frame| frame.interval_ms).unwrap_or(0.0);
        let failure = desk.settings.failure.map(|failure| format!(" | wrong on purpose: {}", failure.name()));
        let planar = crate::techniques::planar::is_on(desk.settings).then(|| desk.settings.planar.mode.name());
        let (technique, show) = (planar.unwrap_or(desk.settings.technique.name()), desk.settings.show.name());
        let words = format!("{technique} | {show}{} | {frame:.1} ms | F1 help", failure.unwrap_or_default());
        numbers::caption(ui, picture, &words);
        if !view.notices.is_empty() {
            egui::Area::new(egui::Id::unique("notices")).fixed_pos(picture.left_top() + egui::vec2(10.0, 10.0)).show(
                ui.ctx(),
                |ui| {
                    ui.set_max_width(420.0);
                    notices(ui, view.notices, actions);
                },
            );
        }
    }
}

fn notices(ui: &mut Ui, list: &[Notice], actions: &mut Vec<Action>) {
    for notice in list {
        style::card(ui, |ui| {
            ui.horizontal_top(|ui| {
                let color = match notice.tone {
                    Tone::Good => style::GOOD,
                    Tone::Warning => style::WARNING,
                    Tone::Error => style::ERROR,
                };
                let width = ui.available_width() - 30.0;
                ui.scope(|ui| {
                    ui.set_width(width);
                    ui.add(egui::Label::new(RichText::new(&notice.words).color(color)).wrap());
                });
                let close = ui.small_button("x").on_hover_text("Take this note away");
                style::name_it(&close, "Dismiss");
                if close.clicked() {
                    actions.push(Action::Dismiss(notice.topic));
                }
            });
        });
    }
}

/// The camera of these settings, where there is one.
fn camera_of(settings: &Settings, view: &View<'_>) -> Option<Camera> {
    Camera::choose(settings, view.scene?, view.pose?).ok()
}
