//! "Verify this view": the button, what was found, and the wrong pixels over the picture.

use egui::{Color32, Rect, RichText, Ui, pos2, vec2};

use super::style::{self, explain};
use super::{Action, Desk, View};
use crate::techniques;

/// The button, and what was found.
pub fn verify(ui: &mut Ui, desk: &Desk<'_>, view: &View<'_>, actions: &mut Vec<Action>) {
    let lights = view.scene.is_some_and(|scene| !scene.lights.is_empty());
    if let Some(share) = view.verification.progress() {
        ui.add(egui::ProgressBar::new(share).text("casting rays"));
        return;
    }
    let tip = "Stops the time, draws each light's shadow by this technique, and which surface is seen through which mirrors, and holds \
               every pixel against exact rays; wrong ones are framed in the picture: red drawn lit, blue drawn dark, magenta another surface";
    if ui.add_enabled(lights, egui::Button::new("Verify this view")).on_hover_text(tip).clicked() {
        actions.push(Action::Verify);
    }
    let Some(finding) = view.verification.finding(desk.settings) else { return };
    let surfaces = &finding.surfaces;
    let lights = finding.lights.iter().map(|(name, found)| (name.as_str(), found.decided, found.edges, found.wrong()));
    let wrong_surfaces = surfaces.pixels.len();
    for (name, decided, edges, wrong) in lights.chain([("surfaces", surfaces.decided, surfaces.edges, wrong_surfaces)]) {
        let color = if wrong == 0 { style::GOOD } else { style::ERROR };
        ui.label(RichText::new(format!("{name}: {decided} decided, {edges} edges, {wrong} wrong")).color(color));
    }
    let spoiled = techniques::spoiled_by(desk.settings);
    let words = match (finding.wrong.is_empty(), techniques::claims_exact(desk.settings)) {
        (true, _) if techniques::planar::is_on(desk.settings) => "Every decided pixel of the receivers is what exact rays say.",
        (true, _) => "Every decided pixel is what exact rays say.",
        (false, _) if wrong_surfaces > 0 => "What is seen must be exact by every technique: please report this view.",
        (false, true) => "This technique claims to be exact: please report this view.",
        (false, false) => "This technique is known to fail in such views.",
    };
    let words = spoiled
        .filter(|_| !finding.wrong.is_empty())
        .map_or_else(|| words.to_owned(), |what| format!("Wrong on purpose: {what} spoils counting."));
    explain(ui, words);
}

/// Wrong pixels are painted one by one up to so many; beyond that a part of them tells as much.
const MOST_PAINTED: usize = 20_000;

/// Paints the wrong pixels over the picture, each at least three points wide.
pub fn overlay(ui: &Ui, rect: Rect, desk: &Desk<'_>, view: &View<'_>) {
    let Some(finding) = view.verification.finding(desk.settings) else { return };
    let painter = ui.painter().with_clip_rect(rect);
    let pixel = 1.0 / ui.ctx().pixels_per_point();
    let stride = finding.wrong.len().div_ceil(MOST_PAINTED).max(1);
    for wrong in finding.wrong.iter().step_by(stride) {
        let center = rect.min + vec2(wrong.x as f32 + 0.5, wrong.y as f32 + 0.5) * pixel;
        let [r, g, b] = wrong.how.color();
        let side = pixel.max(3.0);
        if finding.wrong.len() < 200 {
            // Few are hard to find.
            let frame = Rect::from_center_size(center, vec2(13.0, 13.0));
            painter.rect_stroke(frame, 0.0, (1.0, Color32::from_gray(200)), egui::StrokeKind::Inside);
        }
        let at = Rect::from_center_size(pos2(center.x, center.y), vec2(side, side));
        painter.rect_filled(at, 0.0, Color32::from_rgb(r, g, b));
    }
}
