//! How the panel looks: dark, calm, one warm accent, numbers in a fixed width.

use egui::{Color32, CornerRadius, FontFamily, FontId, Margin, Response, RichText, Stroke, TextStyle, Ui, Vec2};

/// What is chosen, and what shines.
pub const ACCENT: Color32 = Color32::from_rgb(0xf2, 0xb1, 0x56);
/// The panel itself.
pub const PANEL: Color32 = Color32::from_rgb(0x17, 0x1a, 0x20);
/// Boxes on the panel.
pub const CARD: Color32 = Color32::from_rgb(0x20, 0x24, 0x2c);
/// Fields and graphs, sunk into the panel.
pub const WELL: Color32 = Color32::from_rgb(0x0f, 0x11, 0x15);
/// Text.
pub const TEXT: Color32 = Color32::from_rgb(0xd7, 0xda, 0xe0);
/// Text that explains.
pub const WEAK: Color32 = Color32::from_rgb(0x93, 0x9b, 0xa8);
/// Something went wrong.
pub const ERROR: Color32 = Color32::from_rgb(0xff, 0x7a, 0x6b);
/// Something should be known.
pub const WARNING: Color32 = Color32::from_rgb(0xf5, 0xcb, 0x5c);
/// Something went well; also the GPU's line in the graph.
pub const GOOD: Color32 = Color32::from_rgb(0x6f, 0xc3, 0xdf);

/// Sets the style of a context, once.
pub fn install(context: &egui::Context) {
    context.set_theme(egui::ThemePreference::Dark);
    context.style_mut_of(egui::Theme::Dark, |style| {
        style.text_styles = [
            (TextStyle::Heading, FontId::new(17.0, FontFamily::Proportional)),
            (TextStyle::Body, FontId::new(13.0, FontFamily::Proportional)),
            (TextStyle::Button, FontId::new(13.0, FontFamily::Proportional)),
            (TextStyle::Small, FontId::new(11.0, FontFamily::Proportional)),
            (TextStyle::Monospace, FontId::new(12.0, FontFamily::Monospace)),
        ]
        .into();
        style.drag_value_text_style = TextStyle::Monospace;
        let spacing = &mut style.spacing;
        spacing.item_spacing = Vec2::new(6.0, 5.0);
        spacing.button_padding = Vec2::new(8.0, 3.0);
        spacing.interact_size = Vec2::new(36.0, 20.0);
        spacing.slider_width = 128.0;
        spacing.combo_width = 150.0;
        spacing.tooltip_width = 320.0;
        spacing.indent = 12.0;
        let visuals = &mut style.visuals;
        visuals.override_text_color = None;
        visuals.panel_fill = PANEL;
        visuals.window_fill = PANEL;
        visuals.extreme_bg_color = WELL;
        visuals.faint_bg_color = CARD;
        visuals.code_bg_color = WELL;
        visuals.weak_text_color = Some(WEAK);
        visuals.hyperlink_color = ACCENT;
        visuals.warn_fg_color = WARNING;
        visuals.error_fg_color = ERROR;
        visuals.selection.bg_fill = ACCENT.gamma_multiply(0.32);
        visuals.selection.stroke = Stroke::new(1.0, Color32::from_rgb(0xff, 0xe3, 0xb8));
        visuals.slider_trailing_fill = true;
        visuals.window_stroke = Stroke::new(1.0, Color32::from_rgb(0x33, 0x39, 0x45));
        let widgets = &mut visuals.widgets;
        widgets.noninteractive.fg_stroke.color = TEXT;
        widgets.noninteractive.bg_stroke = Stroke::new(1.0, Color32::from_rgb(0x2b, 0x30, 0x3a));
        for (state, fill) in [
            (&mut widgets.inactive, Color32::from_rgb(0x2b, 0x30, 0x3a)),
            (&mut widgets.hovered, Color32::from_rgb(0x3a, 0x41, 0x4e)),
            (&mut widgets.active, Color32::from_rgb(0x4a, 0x52, 0x61)),
            (&mut widgets.open, Color32::from_rgb(0x2b, 0x30, 0x3a)),
        ] {
            state.bg_fill = fill;
            state.weak_bg_fill = fill;
            state.fg_stroke.color = TEXT;
            state.corner_radius = CornerRadius::same(4);
            state.expansion = 0.0;
        }
        widgets.hovered.bg_stroke = Stroke::new(1.0, ACCENT.gamma_multiply(0.6));
    });
}

/// A part of the panel that can be folded away.
pub fn section(ui: &mut Ui, title: &str, open: bool, contents: impl FnOnce(&mut Ui)) {
    section_unfolded(ui, title, open, false, contents);
}

/// The same; `unfold` opens it, where it was folded away.
pub fn section_unfolded(ui: &mut Ui, title: &str, open: bool, unfold: bool, contents: impl FnOnce(&mut Ui)) {
    ui.add_space(2.0);
    ui.separator();
    let header = egui::CollapsingHeader::new(RichText::new(title).strong().color(Color32::WHITE)).default_open(open);
    header.open(unfold.then_some(true)).show_unindented(ui, |ui| {
        ui.add_space(2.0);
        contents(ui);
        ui.add_space(4.0);
    });
}

/// Less room around words, for rows of choices that should stay one row.
pub fn tight(ui: &mut Ui) {
    ui.spacing_mut().button_padding.x = 5.0;
    ui.spacing_mut().item_spacing.x = 2.0;
}

/// A box on the panel.
pub fn card<R>(ui: &mut Ui, contents: impl FnOnce(&mut Ui) -> R) -> R {
    let frame = egui::Frame::new().fill(CARD).corner_radius(CornerRadius::same(5)).inner_margin(Margin::symmetric(8, 6));
    frame
        .show(ui, |ui| {
            ui.set_width(ui.available_width());
            contents(ui)
        })
        .inner
}

/// The width of the words to the left of a control.
const LABEL: f32 = 78.0;

/// One line: words, then a control, which is named after them.
pub fn field(ui: &mut Ui, label: &str, tip: &str, control: impl FnOnce(&mut Ui) -> Response) -> Response {
    ui.horizontal(|ui| {
        let words = ui.allocate_ui_with_layout(
            Vec2::new(LABEL, ui.spacing().interact_size.y),
            egui::Layout::left_to_right(egui::Align::Center),
            |ui| {
                ui.set_min_width(LABEL);
                ui.label(RichText::new(label).color(WEAK))
            },
        );
        control(ui).labelled_by(words.inner.id).on_hover_text(tip)
    })
    .inner
}

/// Words that explain, small.
pub fn explain(ui: &mut Ui, words: impl Into<String>) -> Response {
    ui.add(egui::Label::new(RichText::new(words).small().color(WEAK)).wrap())
}

/// Three numbers, one for each axis, in metres; true where one changed.
pub fn point(ui: &mut Ui, label: &str, tip: &str, value: &mut glam::DVec3) -> bool {
    let mut changed = false;
    ui.horizontal(|ui| {
        let words = ui.allocate_ui_with_layout(
            Vec2::new(LABEL, ui.spacing().interact_size.y),
            egui::Layout::left_to_right(egui::Align::Center),
            |ui| {
                ui.set_min_width(LABEL);
                ui.label(RichText::new(label).color(WEAK)).on_hover_text(tip);
            },
        );
        ui.spacing_mut().item_spacing.x = 3.0;
        let width = ((ui.available_width() - 6.0) / 3.0).max(40.0);
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let speed = (value[axis].abs() * 0.01).max(0.01);
            let number = number(&mut value[axis]).speed(speed).range(-1.0e6..=1.0e6).max_decimals(2);
            let response = ui.add_sized([width, 20.0], number).on_hover_text(format!("{tip}: {name}, metres"));
            name_it(&response, format!("{label} {name}"));
            changed |= response.changed();
        }
        words.response
    });
    changed
}

/// A number that takes no NaN and no infinity, typed or dragged.
pub fn number<N: egui::emath::Numeric>(value: &mut N) -> egui::DragValue<'_> {
    egui::DragValue::new(value)
        .clamp_existing_to_range(false)
        .custom_parser(|text| text.trim().parse().ok().filter(|number: &f64| number.is_finite()))
}

/// A slider that leaves alone what nobody slides: egui's own would round and clamp what it shows.
pub fn slider<N: egui::emath::Numeric>(value: &mut N, range: std::ops::RangeInclusive<N>) -> egui::Slider<'_> {
    egui::Slider::new(value, range).clamping(egui::SliderClamping::Edits)
}

/// Gives a control without words of its own a name, for screen readers and tests.
pub fn name_it(response: &Response, name: impl Into<String>) {
    let (name, id) = (name.into(), response.id);
    response.ctx.accesskit_node_builder(id, |node| node.set_label(name));
}
