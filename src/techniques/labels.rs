//! The final pass (M section 8): what receives no shadows and is no part of the scene, such as names.
//!
//! Each light and each caster is named at its place. The nearest are placed first; a name goes above its
//! place, or below it, or beside it, wherever it covers no other, and where there is no room it is left
//! out and counted. Names are set in a fixed width, so that the plan knows how large they are without
//! any font.

use crate::frame::state::{Blend, State};
use crate::frame::{Camera, Draw, DrawSet, Label, LabelKind, Program, Step, Target};
use crate::scene::{LightKind, Pose, Scene};

/// A character's width to the height of the letters, of the fixed-width font (Hack: 1233 of 2048).
const ADVANCE: f32 = 0.602;
/// A line's height to the height of the letters.
const LINE: f32 = 1.25;
/// More names than this are no help.
const MOST: usize = 64;
/// Longer names are cut.
const LONGEST: usize = 40;

/// What is named, beside the lights.
#[derive(Debug, Clone, Copy)]
pub struct Named {
    /// What casts shadows.
    pub casters: bool,
    /// The eye, where the picture is seen from elsewhere.
    pub eye: Option<glam::DVec3>,
}

/// The names of lights that shine from some place and of what else is `named`, as `camera` sees them in a
/// picture of `size` pixels; and how many had no room.
#[must_use]
pub fn labels(scene: &Scene, pose: &Pose, named: Named, camera: Camera, size: [u32; 2]) -> (Vec<Label>, usize) {
    let clip_from_world = Camera { shift: glam::DVec2::ZERO, ..camera }.clip_from_world();
    #[expect(clippy::cast_precision_loss, reason = "pixels")]
    let [width, height] = size.map(|side| side as f32);
    let text_size = (height / 55.0).round().clamp(11.0, 40.0);
    let mut wanted = Vec::new();
    let mut want = |kind, name: &str, place: glam::DVec3| {
        let clip = clip_from_world * place.extend(1.0);
        if clip.w <= camera.near || name.is_empty() {
            return;
        }
        #[expect(clippy::cast_possible_truncation, reason = "pixels")]
        let anchor = [(clip.x / clip.w * 0.5 + 0.5) as f32 * width, (0.5 - clip.y / clip.w * 0.5) as f32 * height];
        if (0.0..width).contains(&anchor[0]) && (0.0..height).contains(&anchor[1]) {
            let mut text: String =
                name.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).take(LONGEST).collect();
            if name.chars().nth(LONGEST).is_some() {
                text.push('\u{2026}');
            }
            wanted.push((clip.w, Label { text, kind, anchor, plate: [0.0; 4], text_size }));
        }
    };
    for (light, posed) in scene.lights.iter().zip(&pose.lights) {
        if posed.on && posed.kind != LightKind::Directional {
            want(LabelKind::Light, &light.name, posed.center);
        }
    }
    if let Some(eye) = named.eye {
        want(LabelKind::Eye, "eye", eye);
    }
    for (node_index, node, mesh) in scene.instances().filter(|_| named.casters) {
        if node.casts_shadow && mesh.primitives.iter().any(|primitive| primitive.casts_shadow) {
            want(LabelKind::Caster, &node.name, pose.world_bounds(scene, node_index).center().as_dvec3());
        }
    }
    // Lights before casters, the nearest first.
    wanted.sort_by(|(a_depth, a), (b_depth, b)| a.kind.cmp(&b.kind).then(a_depth.total_cmp(b_depth)));
    let mut placed: Vec<Label> = Vec::new();
    let mut left_out = 0;
    for (_, mut label) in wanted {
        match place(&label, [width, height], &placed).filter(|_| placed.len() < MOST) {
            Some(plate) => {
                label.plate = plate;
                placed.push(label);
            }
            None => left_out += 1,
        }
    }
    (placed, left_out)
}

/// Where a name has room: x, y, width and height in pixels.
fn place(label: &Label, [width, height]: [f32; 2], placed: &[Label]) -> Option<[f32; 4]> {
    #[expect(clippy::cast_precision_loss, reason = "a few dozen letters")]
    let letters = label.text.chars().count() as f32;
    let size = [(letters * ADVANCE * label.text_size + 8.0).ceil(), (LINE * label.text_size + 2.0).ceil()];
    // Room for a name beside the place between one above and one below it.
    let gap = (size[1] / 2.0).ceil() + 1.0;
    let [x, y] = label.anchor;
    let corners = [
        [x - size[0] / 2.0, y - gap - size[1]],
        [x - size[0] / 2.0, y + gap],
        [x + gap, y - size[1] / 2.0],
        [x - gap - size[0], y - size[1] / 2.0],
    ];
    let overlap =
        |a: &[f32; 4], b: &[f32; 4]| (0..2).all(|axis| a[axis] < b[axis] + b[axis + 2] && b[axis] < a[axis] + a[axis + 2]);
    corners
        .into_iter()
        .map(|[left, top]| [left.round().clamp(0.0, (width - size[0]).max(0.0)), top.round(), size[0], size[1]])
        .filter(|plate| plate[1] >= 0.0 && plate[1] + plate[3] <= height && plate[2] <= width)
        .find(|plate| placed.iter().all(|other| !overlap(plate, &other.plate)))
}

/// Names over the finished picture, which is `target`.
#[must_use]
pub fn step(labels: Vec<Label>, target: Target, scissor: [u32; 4]) -> Step {
    let why = "Names lights and casters over the finished picture: they are no part of the scene and receive no shadows.";
    let draw = Draw {
        target,
        state: State { color: Some(Blend::Over), ..State::FLAT },
        ..Draw::plain(Program::Labels, DrawSet::Labels(labels), scissor)
    };
    Step::drawing("labels", why, draw)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(text: &str, anchor: [f32; 2]) -> Label {
        Label { text: text.into(), kind: LabelKind::Caster, anchor, plate: [0.0; 4], text_size: 12.0 }
    }

    #[test]
    fn names_move_aside_for_each_other_and_are_left_out_at_last() {
        let mut placed = Vec::new();
        let mut sides = Vec::new();
        for _ in 0..5 {
            let mut label = named("cube", [100.0, 50.0]);
            let Some(plate) = place(&label, [200.0, 100.0], &placed) else { break };
            sides.push([plate[0] + plate[2] / 2.0 - 100.0, plate[1] + plate[3] / 2.0 - 50.0].map(|off| off.round()));
            label.plate = plate;
            placed.push(label);
        }
        assert_eq!(placed.len(), 4, "above, below, right and left: {sides:?}");
        assert!(sides[0][1] < 0.0 && sides[1][1] > 0.0 && sides[2][0] > 0.0 && sides[3][0] < 0.0, "{sides:?}");
    }

    #[test]
    fn names_stay_in_the_picture() {
        let [x, _, width, _] = place(&named("a long name of something", [3.0, 50.0]), [200.0, 100.0], &[]).unwrap_or_default();
        assert!(x == 0.0 && width > 100.0);
        assert!(place(&named("top", [100.0, 2.0]), [200.0, 100.0], &[]).is_some_and(|plate| plate[1] > 2.0), "below");
        assert_eq!(place(&named("wider than the picture", [10.0, 50.0]), [60.0, 100.0], &[]), None);
    }
}
