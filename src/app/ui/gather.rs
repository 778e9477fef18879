//! How the light of a picture comes together: frames gathered into a mean, what lights are added into.

use egui::Ui;

use super::style::{explain, field, slider};
use super::technique::capital;
use super::{Desk, View, style};
use crate::settings::{Accumulation, MAX_FRAMES, Shading, Texturing};

/// All of it.
pub fn gather(ui: &mut Ui, desk: &mut Desk<'_>, view: &View<'_>) {
    let lighting = &mut desk.settings.lighting;
    let tip = "Shows the mean of so many frames, each with other points of the lights with a size and of every pixel: soft \
               shadows and smooth edges. They are gathered while nothing moves";
    field(ui, "Frames", tip, |ui| ui.add(slider(&mut lighting.accumulate, 1..=MAX_FRAMES).logarithmic(true)));
    if let Some(gather) = view.plan.and_then(|plan| plan.gather) {
        let done = gather.frame + 1;
        let progress = egui::ProgressBar::new(done as f32 / gather.frames as f32).desired_height(6.0);
        ui.add(progress.fill(if gather.next().is_some() { style::ACCENT } else { style::GOOD }));
        let soft = view.pose.is_some_and(|pose| pose.lights.iter().any(|light| !light.extent.is_point()));
        let points =
            if soft { format!(", {} points of each light with a size", done * lighting.area_samples) } else { String::new() };
        explain(ui, format!("{done} of {} frames gathered{points}.", gather.frames));
    }
    let tip = "Names lights and what casts shadows, in the picture itself";
    ui.checkbox(&mut lighting.labels, "Names in the picture").on_hover_text(tip);
    ui.horizontal(|ui| {
        ui.label(egui::RichText::new("Lights in").color(style::WEAK));
        for accumulation in Accumulation::ALL {
            let words = capital(accumulation.name());
            let response = ui.selectable_label(lighting.accumulation == accumulation, words);
            if response.on_hover_text(format!("{}.", capital(accumulation.about()))).clicked() {
                lighting.accumulation = accumulation;
            }
        }
    });
    ui.horizontal(|ui| {
        ui.label(egui::RichText::new("Shading").color(style::WEAK));
        for shading in Shading::ALL {
            let response = ui.selectable_label(lighting.shading == shading, capital(shading.name()));
            if response.on_hover_text(format!("{}.", capital(shading.about()))).clicked() {
                lighting.shading = shading;
            }
        }
    });
    ui.horizontal(|ui| {
        ui.label(egui::RichText::new("Textures").color(style::WEAK));
        for texturing in Texturing::ALL {
            let response = ui.selectable_label(lighting.texturing == texturing, capital(&texturing.name().replace('-', " ")));
            if response.on_hover_text(format!("{}.", capital(texturing.about()))).clicked() {
                lighting.texturing = texturing;
            }
        }
    });
}
