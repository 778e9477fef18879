//! The open window: what belongs to it, and one run of the panel in it.

use std::sync::Arc;
use std::time::{Duration, Instant};

use winit::window::Window;

use super::device::{Painted, Screen};
use super::pace::Pace;
use super::session::Session;
use super::surface::SurfaceState;
use super::ui::Outcome;

/// The window and what belongs to it. Fields are dropped in order: the device's side, then egui,
/// then the window.
pub(super) struct Live {
    pub screen: Option<Screen>,
    pub egui: egui_winit::State,
    pub surface: SurfaceState,
    /// The surface was lost, and is to be made anew.
    pub surface_gone: bool,
    pub vsync: bool,
    pub title: String,
    pub window: Arc<Window>,
}

/// egui's eyes and hands for one window.
pub(super) fn new_egui(context: egui::Context, window: &Arc<Window>, max_side: Option<usize>) -> egui_winit::State {
    let scale = window.scale_factor() as f32;
    egui_winit::State::new(context, egui::ViewportId::ROOT, &**window, Some(scale), window.theme(), max_side)
}

/// The input since the last frame. egui's own way asks the window system for the size, which
/// panics in winit when another program has destroyed the window; the surface knows it as well.
fn take_input(live: &mut Live, time: Duration) -> egui::RawInput {
    let scale = live.window.scale_factor() as f32;
    let pixels_per_point = scale * live.egui.egui_ctx().zoom_factor();
    let [width, height] = live.surface.size().map(|side| side as f32 / pixels_per_point);
    let input = live.egui.egui_input_mut();
    input.time = Some(time.as_secs_f64());
    input.screen_rect = Some(egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(width, height)));
    input.viewport_id = egui::ViewportId::ROOT;
    input.viewports.entry(egui::ViewportId::ROOT).or_default().native_pixels_per_point = Some(scale);
    input.take()
}

/// Runs the panel over the input that came since the last frame.
pub(super) fn run_panel(
    live: &mut Live,
    session: &mut Session,
    pace: &mut Pace,
    now: Instant,
    started: Duration,
) -> (Painted, Outcome, egui::TexturesDelta) {
    let input = take_input(live, started);
    let context = live.egui.egui_ctx().clone();
    let capabilities = live.screen.as_ref().map(|screen| screen.context.capabilities().clone());
    let picture = live.screen.as_ref().and_then(Screen::painted_picture);
    let mut outcome = Outcome { actions: Vec::new(), picture: egui::Rect::NOTHING };
    let output = context.run_ui(input, |ui| {
        let (panel, desk, view) = session.parts(capabilities.as_ref(), picture);
        let Outcome { actions, picture } = panel.show(ui, desk, &view);
        outcome.actions.extend(actions);
        outcome.picture = picture;
    });
    live.egui.handle_platform_output(&live.window, output.platform_output);
    if let Some(viewport) = output.viewport_output.get(&egui::ViewportId::ROOT)
        && let Some(when) = now.checked_add(viewport.repaint_delay)
    {
        pace.want(when);
    }
    let painted =
        Painted { jobs: context.tessellate(output.shapes, output.pixels_per_point), pixels_per_point: output.pixels_per_point };
    (painted, outcome, output.textures_delta)
}
