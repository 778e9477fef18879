//! Planar shadows: how they are drawn, and which surfaces take them.

use egui::{Pos2, Rect, RichText, Ui};

use super::style::{self, explain};
use super::technique::capital;
use super::{Action, Desk, Marks, Notice, Panel, Tone, Topic, View, mirrors};
use crate::app::keys::{Command, key_of};
use crate::frame::{Camera, FramePlan, Method};
use crate::scene::{Receiver, Scene};
use crate::settings::{HybridPart, Planar, PlanarMode, SurfacePlace};
use crate::techniques::planar::is_on;

/// A mode's name on its button.
const fn title(mode: PlanarMode) -> &'static str {
    match mode {
        PlanarMode::Off => "No planar shadows",
        PlanarMode::Naive => "Naive",
        PlanarMode::StencilBlend => "Stencil, blended",
        PlanarMode::StencilRelight => "Stencil, relit",
        PlanarMode::Multi => "Many lights",
        PlanarMode::Hybrid => "Hybrid",
    }
}

/// The same of what is drawn of the hybrid.
const fn part_title(part: HybridPart) -> &'static str {
    match part {
        HybridPart::Both => "Both kinds",
        HybridPart::Volumes => "Volumes alone",
        HybridPart::Planar => "Planar alone",
    }
}

/// The settings, and the list of receivers.
pub fn planar(ui: &mut Ui, panel: &mut Panel, desk: &mut Desk<'_>, view: &View<'_>) {
    let on = is_on(desk.settings);
    let settings = &mut desk.settings.planar;
    ui.horizontal_wrapped(|ui| {
        style::tight(ui);
        for mode in PlanarMode::ALL {
            let response = ui.selectable_label(settings.mode == mode, title(mode));
            if response.on_hover_text(capital(mode.about())).clicked() {
                settings.mode = mode;
            }
        }
    });
    if settings.mode == PlanarMode::Hybrid {
        ui.horizontal(|ui| {
            ui.label(RichText::new("Drawn of it").color(style::WEAK));
            style::tight(ui);
            for part in HybridPart::ALL {
                let response = ui.selectable_label(settings.hybrid == part, part_title(part));
                if response.on_hover_text(capital(part.about())).clicked() {
                    settings.hybrid = part;
                }
            }
        });
    }
    if on {
        explain(ui, format!("{}. The technique counts nothing meanwhile.", capital(settings.mode.about())));
        if let Some(plan) = view.plan {
            explain(ui, thrown(plan, desk.settings.light));
            mirrors::bits(ui, plan.bits_in_use());
        }
    } else if desk.settings.failure.is_some() && settings.mode != PlanarMode::Off {
        explain(ui, "Off while a failure of the gallery is shown: those are volumes'.");
    }
    let key = key_of(Command::MarkReceivers).unwrap_or_default();
    let tip = "While this is on, a click on a flat surface of the picture lets it take planar shadows, or none any more";
    panel.marks_box(ui, Marks::Receivers, &format!("Clicks mark receivers ({key})"), tip);
    if let Some(scene) = view.scene {
        list(ui, &mut desk.settings.planar, scene);
    }
}

/// What the light that is looked at throws onto receivers.
fn thrown(plan: &FramePlan, light: usize) -> String {
    let of_light = || plan.volumes.iter().filter(|volume| volume.light == light && volume.view == 0);
    let thrown = of_light().filter_map(|volume| volume.projection);
    let (whole, cut): (Vec<_>, Vec<_>) = thrown.partition(|projection| !projection.cut);
    let left_out = of_light().filter(|volume| volume.method == Method::Dropped).count();
    format!("Light {light}: {} casters thrown whole, {} cut at a receiver, {left_out} left out.", whole.len(), cut.len())
}

/// The scene's receivers and those that were made, each to be switched; and why some are none.
fn list(ui: &mut Ui, settings: &mut Planar, scene: &Scene) {
    let place_of = |receiver: &Receiver| SurfacePlace { node: receiver.node, primitive: receiver.primitive };
    let mut receivers = scene.receivers.clone();
    let edits = settings.edits.iter().filter(|(_, on)| **on);
    let made = edits.filter(|(place, _)| !scene.receivers.iter().any(|receiver| place_of(receiver) == **place));
    receivers.extend(made.filter_map(|(place, _)| Receiver::of(scene, place.node, place.primitive).ok()));
    if receivers.is_empty() {
        explain(ui, "No surface of this scene takes planar shadows.");
    }
    let mut toggled = None;
    // Within the panel's own scrolling it would shrink to the least height otherwise.
    let height = (receivers.len() as f32 * 26.0).min(156.0);
    let rows = egui::ScrollArea::vertical().id_salt("receivers").max_height(height).min_scrolled_height(height);
    rows.auto_shrink([false, true]).show(ui, |ui| {
        for receiver in &receivers {
            let place = place_of(receiver);
            let marked = scene.receivers.iter().any(|receiver| place_of(receiver) == place);
            let mut on = settings.edits.get(&place).copied().unwrap_or(marked);
            ui.push_id((place.node, place.primitive), |ui| {
                let about = format!("{receiver}; node {}, primitive {}", place.node, place.primitive);
                if ui.checkbox(&mut on, &receiver.name).on_hover_text(about).changed() {
                    toggled = Some(place);
                }
            });
        }
    });
    if let Some(place) = toggled {
        // What is in the list can be a receiver.
        let _ = scene.toggle_receiver(settings, place);
    }
    let (_, refused) = scene.receivers_in_force(settings);
    mirrors::tell_refused(ui, refused);
}

/// A click on the picture, to let a surface take planar shadows or none any more; says which.
pub fn click(desk: &mut Desk<'_>, view: &View<'_>, camera: &Camera, picture: Rect, at: Pos2, actions: &mut Vec<Action>) {
    let Some((scene, place, name)) = mirrors::surface_under(view, camera, picture, at) else { return };
    let settings = &mut desk.settings.planar;
    let (tone, words) = match scene.toggle_receiver(settings, place) {
        Ok(true) if settings.mode == PlanarMode::Off => {
            (Tone::Warning, format!("{name} takes planar shadows; but none are drawn."))
        }
        Ok(true) => (Tone::Good, format!("{name} takes planar shadows.")),
        Ok(false) => (Tone::Good, format!("{name} takes no planar shadows any more.")),
        Err(why) => (Tone::Warning, format!("{name} cannot take planar shadows: {why}.")),
    };
    actions.push(Action::Tell(Notice { topic: Topic::Receivers, tone, words }));
}
