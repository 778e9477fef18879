//! What the frame cost and what it did: graph, counts, the plan's steps, the device.

use std::collections::VecDeque;

use egui::{Color32, CornerRadius, Rect, RichText, Sense, Stroke, Ui, pos2, vec2};

use super::style::{self, card, explain};
use super::{Desk, View};

/// How many frames the graph remembers.
pub const REMEMBERED: usize = 150;

/// How many frames make a median, however long they took.
const FEW: usize = 5;

/// One drawn frame in numbers.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FrameNumbers {
    /// From the start of the frame before to the start of this one, milliseconds; none after a pause.
    pub interval_ms: Option<f64>,
    /// Posing, planning and recording, milliseconds.
    pub cpu_ms: f64,
    /// Measured on the GPU, milliseconds, where it can.
    pub gpu_ms: Option<f64>,
    /// Draw calls.
    pub draws: u32,
    /// Triangles of all draws.
    pub triangles: u64,
    /// Shadow volumes counted.
    pub volumes: u32,
    /// Their triangles.
    pub volume_triangles: u64,
}

/// The last frames.
#[derive(Debug, Clone, Default)]
pub struct History {
    frames: VecDeque<FrameNumbers>,
}

impl History {
    /// One more frame.
    pub fn push(&mut self, frame: FrameNumbers) {
        if self.frames.len() == REMEMBERED {
            self.frames.pop_front();
        }
        self.frames.push_back(frame);
    }

    /// The latest frame.
    #[must_use]
    pub fn latest(&self) -> Option<&FrameNumbers> {
        self.frames.back()
    }

    /// The median of something over the last second, and a few frames at least: one hiccup does not
    /// move it, and slow frames do not keep the numbers of another scene on show for minutes.
    #[must_use]
    pub fn median(&self, of: impl Fn(&FrameNumbers) -> Option<f64>) -> Option<f64> {
        let mut age = 0.0;
        let recent = self.frames.iter().rev().enumerate().take_while(|(index, frame)| {
            let young = age < 1000.0 || *index < FEW;
            age += frame.interval_ms.unwrap_or(0.0);
            young
        });
        let mut values: Vec<f64> = recent.filter_map(|(_, frame)| of(frame)).collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied()
    }
}

/// The graph, the counts, and how often frames are drawn.
pub fn numbers(ui: &mut Ui, desk: &mut Desk<'_>, view: &View<'_>) {
    graph(ui, view.history);
    let median = |of: fn(&super::FrameNumbers) -> Option<f64>| {
        view.history.median(of).map_or_else(|| "-".to_owned(), |value| format!("{value:.2} ms"))
    };
    let latest = view.history.latest().copied().unwrap_or_default();
    egui::Grid::new("numbers").num_columns(4).spacing(vec2(10.0, 3.0)).show(ui, |ui| {
        let cell = |ui: &mut Ui, words: &str, value: String, color: Color32, tip: &str| {
            ui.label(RichText::new(words).color(color)).on_hover_text(tip);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| ui.label(RichText::new(value).monospace()))
                .inner
                .on_hover_text(tip);
        };
        cell(ui, "CPU", median(|frame| Some(frame.cpu_ms)), style::ACCENT, "Posing, planning, silhouettes and recording; median");
        cell(ui, "Draws", thousands(u64::from(latest.draws)), style::WEAK, "Draw calls of the last frame");
        ui.end_row();
        cell(ui, "GPU", median(|frame| frame.gpu_ms), style::GOOD, "Measured by timestamps on the device; median");
        cell(ui, "Triangles", thousands(latest.triangles), style::WEAK, "Triangles of all draws");
        ui.end_row();
        cell(ui, "Frame", median(|frame| frame.interval_ms), style::TEXT, "From one frame to the next; median");
        cell(
            ui,
            "Volumes",
            thousands(u64::from(latest.volumes)),
            style::WEAK,
            "Shadow volumes counted, and pieces of those that are clamped",
        );
        ui.end_row();
        ui.label("");
        ui.label("");
        cell(ui, "in volumes", thousands(latest.volume_triangles), style::WEAK, "Triangles of the shadow volumes");
        ui.end_row();
    });
    ui.horizontal(|ui| {
        ui.checkbox(&mut desk.preferences.vsync, "Vsync").on_hover_text("Frames wait for the screen; off: up to 240 a second");
        ui.checkbox(&mut desk.preferences.continuous, "Draw always")
            .on_hover_text("Draws all the time, for timing; else only when something moves or changes");
    });
}

fn graph(ui: &mut Ui, history: &History) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 54.0), Sense::hover());
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, CornerRadius::same(4), style::WELL);
    let largest = history.frames.iter().map(|frame| frame.cpu_ms.max(frame.gpu_ms.unwrap_or(0.0))).fold(1.0, f64::max);
    // A scale that moves in steps is easier to read than one that breathes.
    let top = [2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0]
        .into_iter()
        .find(|top| *top >= largest)
        .unwrap_or(largest);
    for share in [0.5, 1.0] {
        let y = rect.bottom() - rect.height() * share as f32 + 0.5;
        painter.hline(rect.x_range(), y, Stroke::new(1.0, Color32::from_rgb(0x24, 0x28, 0x30)));
    }
    let at = |index: usize, value: f64| {
        let x = rect.right() - (history.frames.len() - 1 - index) as f32 * rect.width() / (REMEMBERED - 1) as f32;
        pos2(x, rect.bottom() - (value / top) as f32 * (rect.height() - 3.0) - 1.0)
    };
    let line = |of: &dyn Fn(&FrameNumbers) -> Option<f64>, color| {
        let points: Vec<_> =
            history.frames.iter().enumerate().filter_map(|(index, frame)| of(frame).map(|value| at(index, value))).collect();
        painter.line(points, Stroke::new(1.5, color));
    };
    line(&|frame| frame.gpu_ms, style::GOOD);
    line(&|frame| Some(frame.cpu_ms), style::ACCENT);
    let font = egui::FontId::monospace(10.0);
    painter.text(rect.left_top() + vec2(5.0, 3.0), egui::Align2::LEFT_TOP, format!("{top:.0} ms"), font, style::WEAK);
    response.on_hover_text("Milliseconds a frame: the CPU's share in amber, the GPU's in blue");
}

/// What the plan says about itself, and each of its steps.
pub fn plan(ui: &mut Ui, view: &View<'_>) {
    let Some(plan) = view.plan else {
        explain(ui, "Nothing is drawn yet.");
        return;
    };
    for note in &plan.notes {
        card(ui, |ui| explain(ui, note.as_str()));
    }
    let steps: Vec<_> = plan.pictures().flat_map(|plan| &plan.steps).collect();
    explain(ui, format!("{} steps, in this order:", steps.len()));
    let height = (steps.len() as f32 * 42.0).min(340.0);
    egui::ScrollArea::vertical().id_salt("steps").max_height(height).min_scrolled_height(height).auto_shrink([false, true]).show(
        ui,
        |ui| {
            for (index, step) in steps.into_iter().enumerate() {
                ui.horizontal_wrapped(|ui| {
                    ui.label(RichText::new(format!("{:>2}", index + 1)).monospace().color(style::WEAK));
                    ui.label(step.label.as_str());
                });
                explain(ui, step.why.as_str());
            }
        },
    );
}

/// The device, what it lacks, and what replaces that.
pub fn device(ui: &mut Ui, view: &View<'_>) {
    let Some(capabilities) = view.capabilities else {
        explain(ui, "No device yet.");
        return;
    };
    ui.add(egui::Label::new(capabilities.adapter.as_str()).wrap());
    let lacks = capabilities.lacks();
    if lacks.is_empty() {
        explain(ui, "Everything that Obscura can use is there.");
    }
    for lack in lacks {
        card(ui, |ui| {
            ui.add(egui::Label::new(RichText::new(format!("No {}", lack.feature)).color(style::WARNING)).wrap());
            explain(ui, format!("Instead: {}.", lack.instead));
        });
    }
}

/// `12 345`: digits in threes.
fn thousands(value: u64) -> String {
    let digits = value.to_string();
    let mut words = String::with_capacity(digits.len() * 2);
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            words.push(' ');
        }
        words.push(digit);
    }
    words
}

/// A small marker on the picture while the panel is hidden: technique, view, milliseconds.
pub fn caption(ui: &Ui, rect: Rect, words: &str) {
    let painter = ui.painter_at(rect);
    let galley = painter.layout_no_wrap(words.to_owned(), egui::FontId::monospace(12.0), style::TEXT);
    let at = rect.left_bottom() + vec2(10.0, -10.0 - galley.size().y);
    let back = Rect::from_min_size(at, galley.size()).expand2(vec2(7.0, 4.0));
    painter.rect_filled(back, CornerRadius::same(4), style::PANEL.gamma_multiply(0.8));
    painter.galley(at, galley, style::TEXT);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_history_forgets_the_oldest_and_gives_medians() {
        let mut history = History::default();
        assert_eq!(history.median(|frame| Some(frame.cpu_ms)), None);
        for index in 0..=REMEMBERED {
            history.push(FrameNumbers { cpu_ms: index as f64, ..FrameNumbers::default() });
        }
        assert_eq!(history.frames.len(), REMEMBERED);
        assert_eq!(history.median(|frame| Some(frame.cpu_ms)), Some((REMEMBERED / 2 + 1) as f64));
        assert_eq!(history.median(|frame| frame.gpu_ms), None);
    }

    #[test]
    fn a_median_tells_of_the_last_second() {
        let mut history = History::default();
        let frame = |interval: f64| FrameNumbers { interval_ms: Some(interval), ..FrameNumbers::default() };
        (0..REMEMBERED).for_each(|_| history.push(frame(20.0)));
        (0..FEW).for_each(|_| history.push(frame(700.0)));
        assert_eq!(history.median(|frame| frame.interval_ms), Some(700.0), "a slower scene shows at once");
    }

    #[test]
    fn digits_stand_in_threes() {
        assert_eq!(["0", "999", "1 000", "12 345 678"], [0, 999, 1000, 12_345_678].map(thousands).each_ref().map(String::as_str));
    }
}
