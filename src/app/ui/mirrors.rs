//! Mirrors: how they are drawn, which there are, what that costs, and whose the stencil's bits are meanwhile.

use egui::{Color32, Pos2, Rect, RichText, Ui};

use super::style::{self, explain, field, number, slider};
use super::technique::capital;
use super::{Action, Desk, Marks, Notice, Panel, Tone, Topic, View, gizmo};
use crate::frame::stencil::BitBudget;
use crate::frame::{Camera, FramePlan};
use crate::scene::pick::surface_at;
use crate::scene::{Mirror, Reflective, Scene};
use crate::settings::{LEAST_TEXTURE, LastBounce, MAX_BOUNCES, MOST_TEXTURE, MirrorLight, MirrorMode, Mirrors, SurfacePlace};

/// A mode's name on its button.
const fn title(mode: MirrorMode) -> &'static str {
    match mode {
        MirrorMode::Off => "No mirrors",
        MirrorMode::Unbounded => "Unbounded",
        MirrorMode::Stencil => "One bounce",
        MirrorMode::Recursive => "Mirrors in mirrors",
        MirrorMode::Texture => "Texture",
    }
}

/// The settings, the list of mirrors, and what the plan made of both.
pub fn mirrors(ui: &mut Ui, panel: &mut Panel, desk: &mut Desk<'_>, view: &View<'_>) {
    let settings = &mut desk.settings.mirrors;
    ui.horizontal_wrapped(|ui| {
        style::tight(ui);
        for mode in MirrorMode::ALL {
            let response = ui.selectable_label(settings.mode == mode, title(mode));
            if response.on_hover_text(capital(mode.about())).clicked() {
                settings.mode = mode;
            }
        }
    });
    ui.add_enabled_ui(settings.mode == MirrorMode::Recursive, |ui| {
        let tip = "How often a ray is reflected at most";
        field(ui, "Bounces", tip, |ui| ui.add(slider(&mut settings.bounces, 1..=MAX_BOUNCES)));
    });
    if settings.mode == MirrorMode::Texture {
        let tip = "How wide a reflection's texture is, pixels: the whole picture goes into it, so its pixels show on the mirror";
        field(ui, "Texture", tip, |ui| ui.add(number(&mut settings.texture).range(LEAST_TEXTURE..=MOST_TEXTURE).speed(4.0)));
    }
    ui.horizontal(|ui| {
        ui.label(RichText::new("Past the last").color(style::WEAK));
        style::tight(ui);
        for last in LastBounce::ALL {
            let response = ui.selectable_label(settings.last == last, capital(last.name()));
            if response.on_hover_text(capital(last.about())).clicked() {
                settings.last = last;
            }
        }
    });
    ui.checkbox(&mut settings.fresnel, "More where seen obliquely (Fresnel)")
        .on_hover_text("Half-mirrors reflect more, the more obliquely they are seen (Schlick 1994), instead of evenly");
    ui.horizontal(|ui| {
        ui.label(RichText::new("Light off them").color(style::WEAK));
        style::tight(ui);
        for light in MirrorLight::ALL {
            let response = ui.selectable_label(settings.light == light, capital(light.name()));
            if response.on_hover_text(capital(light.about())).clicked() {
                settings.light = light;
            }
        }
    });
    let tip = "Reflections of fewer pixels are not drawn: their mirrors are grey";
    field(ui, "Least pixels", tip, |ui| ui.add(number(&mut settings.least_pixels).range(0..=1_000_000).speed(5.0)));
    if let Some(plan) = view.plan {
        let names: Vec<_> = plan.views.iter().take(MOST_NAMED).map(|view| view.name.as_str()).collect();
        explain(ui, cost(plan)).on_hover_text(names.join("\n"));
        bits(ui, plan.bits_in_use());
    }
    let key = crate::app::keys::key_of(crate::app::keys::Command::MakeMirrors).unwrap_or_default();
    let tip = "While this is on, a click on a flat surface of the picture makes it a mirror, and a mirror none";
    panel.marks_box(ui, Marks::Mirrors, &format!("Clicks make mirrors ({key})"), tip);
    if let Some(scene) = view.scene {
        list(ui, settings, scene);
    }
}

/// Views that are named where the mouse rests.
const MOST_NAMED: usize = 30;

/// The views drawn, beside Kilgard's worst case.
fn cost(plan: &FramePlan) -> String {
    let reflections = plan.reflections;
    if reflections.mirrors == 0 {
        return "No mirror is drawn here: one view.".into();
    }
    let views = plan.views.len();
    let mut words = format!(
        "{views} view{} drawn, of {} at worst for {} mirrors and {} bounces (Kilgard).",
        if views == 1 { "" } else { "s" },
        reflections.worst_case,
        reflections.mirrors,
        reflections.bounces
    );
    if reflections.too_small > 0 {
        words.push_str(&format!(" {} were too small.", reflections.too_small));
    }
    if reflections.lights > 0 {
        words.push_str(&format!(" {} lights come off mirrors.", reflections.lights));
    }
    words
}

/// Who owns a bit of the stencil: a letter for it, a word, and a colour.
type Owner = (&'static str, &'static str, Color32);

fn owner(budget: BitBudget, bit: u32) -> Owner {
    let has = |mask: u8| mask >> bit & 1 == 1;
    [
        (budget.mirror_mask, ("M", "mirror level", Color32::from_rgb(0x7a, 0x55, 0x1e))),
        (budget.receiver_mask, ("R", "receivers of planar shadows", Color32::from_rgb(0x25, 0x58, 0x6e))),
        (budget.beyond_mask, ("B", "beyond the light's bounds", Color32::from_rgb(0x5d, 0x3a, 0x6b))),
        (budget.verdict_mask, ("V", "shadowed by a batch before", Color32::from_rgb(0x70, 0x36, 0x30))),
        (
            budget.count_mask & budget.points_mask,
            ("s", "shadow count and single points, in turn", Color32::from_rgb(0x30, 0x5a, 0x50)),
        ),
        (budget.count_mask, ("c", "shadow count", Color32::from_rgb(0x2d, 0x4a, 0x5c))),
        (budget.points_mask, ("p", "points of lights", Color32::from_rgb(0x36, 0x5c, 0x3a))),
    ]
    .into_iter()
    .find_map(|(mask, owner)| has(mask).then_some(owner))
    .unwrap_or(("-", "nobody", style::WELL))
}

/// The stencil's eight bits, the highest first, and a legend.
pub(super) fn bits(ui: &mut Ui, budget: BitBudget) {
    let owners = [7, 6, 5, 4, 3, 2, 1, 0].map(|bit| (bit, owner(budget, bit)));
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 3.0;
        ui.label(RichText::new("Stencil bits").color(style::WEAK));
        for (bit, (letter, words, color)) in owners {
            let cell = RichText::new(format!(" {letter} ")).monospace().color(Color32::WHITE).background_color(color);
            ui.label(cell).on_hover_text(format!("bit {bit}: {words}"));
        }
    });
    let runs = owners.chunk_by(|a, b| a.1 == b.1).map(|run| {
        let (first, last) = (run[0].0, run[run.len() - 1].0);
        let bits = if first == last { first.to_string() } else { format!("{first}-{last}") };
        format!("{bits} {}", run[0].1.1)
    });
    explain(ui, format!("In this frame: {}.", runs.collect::<Vec<_>>().join(", ")));
}

/// The scene's mirrors and those that were made, each to be switched; and why some are none.
fn list(ui: &mut Ui, settings: &mut Mirrors, scene: &Scene) {
    let place_of = |mirror: &Mirror| SurfacePlace { node: mirror.node, primitive: mirror.primitive };
    let mut mirrors = scene.mirrors.clone();
    let made = settings.edits.iter().filter(|(place, on)| **on && !mirrors.iter().any(|mirror| place_of(mirror) == **place));
    let made: Vec<_> = made.map(|(place, _)| Mirror::of(scene, place.node, place.primitive, Reflective::default())).collect();
    mirrors.extend(made.into_iter().flatten());
    if mirrors.is_empty() {
        explain(ui, "This scene has no mirrors.");
    }
    let mut toggled = None;
    // Within the panel's own scrolling it would shrink to the least height otherwise.
    let height = (mirrors.len() as f32 * 26.0).min(208.0);
    let rows = egui::ScrollArea::vertical().id_salt("mirrors").max_height(height).min_scrolled_height(height);
    rows.auto_shrink([false, true]).show(ui, |ui| {
        for mirror in &mirrors {
            let place = place_of(mirror);
            let marked = scene.mirrors.iter().any(|mirror| place_of(mirror) == place);
            let mut on = settings.edits.get(&place).copied().unwrap_or(marked);
            ui.push_id((place.node, place.primitive), |ui| {
                ui.horizontal(|ui| {
                    let about = format!("{mirror}; node {}, primitive {}", place.node, place.primitive);
                    if ui.checkbox(&mut on, &mirror.name).on_hover_text(about).changed() {
                        toggled = Some(place);
                    }
                    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                        ui.label(RichText::new(format!("{:.0} %", mirror.look.reflectivity * 100.0)).monospace());
                        let [r, g, b] = mirror.look.tint.to_array();
                        let (rect, response) = ui.allocate_exact_size(egui::Vec2::splat(12.0), egui::Sense::hover());
                        ui.painter().rect_filled(rect, 2.0, egui::Rgba::from_rgb(r, g, b));
                        response.on_hover_text(format!("Tint: {r} {g} {b}, linear"));
                    });
                });
            });
        }
    });
    if let Some(place) = toggled {
        // What is in the list can be a mirror.
        let _ = scene.toggle_mirror(settings, place);
    }
    let (_, refused) = scene.mirrors_in_force(settings);
    tell_refused(ui, refused);
}

/// A click on the picture, to make a mirror of a surface or an ordinary surface of a mirror; says which.
pub fn click(desk: &mut Desk<'_>, view: &View<'_>, camera: &Camera, picture: Rect, at: Pos2, actions: &mut Vec<Action>) {
    let Some((scene, place, name)) = surface_under(view, camera, picture, at) else { return };
    let settings = &mut desk.settings.mirrors;
    let (tone, words) = match scene.toggle_mirror(settings, place) {
        Ok(true) if settings.mode == MirrorMode::Off => (Tone::Warning, format!("{name} is a mirror; but no mirrors are drawn.")),
        Ok(true) => (Tone::Good, format!("{name} is a mirror.")),
        Ok(false) => (Tone::Good, format!("{name} is no mirror any more.")),
        Err(why) => (Tone::Warning, format!("{name} cannot be a mirror: {why}.")),
    };
    actions.push(Action::Tell(Notice { topic: Topic::Mirrors, tone, words }));
}

/// The surface under the mouse, and its node's name.
pub(super) fn surface_under<'v>(
    view: &View<'v>,
    camera: &Camera,
    picture: Rect,
    at: Pos2,
) -> Option<(&'v Scene, SurfacePlace, &'v str)> {
    let (scene, pose) = (view.scene?, view.pose?);
    let place = surface_at(scene, pose, camera.eye, gizmo::ray(camera, picture, at), camera.near)?;
    Some((scene, place, scene.nodes.get(place.node).map_or("", |node| node.name.as_str())))
}

/// Why surfaces that the settings speak of are not what they are to be.
pub(super) fn tell_refused(ui: &mut Ui, refused: Vec<String>) {
    for why in refused {
        ui.add(egui::Label::new(RichText::new(capital(&why)).small().color(style::WARNING)).wrap());
    }
}
