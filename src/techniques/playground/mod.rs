//! The playground (K section 1, table 2): shapes drawn one after another into the stencil, with every state free to
//! choose, and the stencil that comes of it as colours and numbers.
//!
//! wgpu has one reference, one read mask and one write mask for both faces. A shape whose faces have different ones is
//! drawn twice: its front faces, with theirs, and then its back faces, with theirs. A fragment is of one face only, and no
//! shape covers a pixel twice, so that comes to the same.
//!
//! [`model`] says what every pixel must come out as; a test holds the GPU to it. [`calls`] writes each state down as the
//! programs of four interfaces would.

pub mod calls;
pub mod model;

use std::f64::consts::TAU;

use glam::DVec2;

use crate::frame::state::{Blend, Cull, Depth, DepthBias, NearPlane, State, Winding};
use crate::frame::stencil::{StencilFace, StencilState};
use crate::frame::{Action, Clear, Draw, DrawSet, Label, LabelKind, Program, Step, Stroke, Target};
use crate::settings::{Board, Face, Facing, Playground, Shape, ShapeKind};

/// The whole frame.
#[must_use]
pub fn steps(playground: &Playground, size: [u32; 2], scissor: [u32; 4]) -> Vec<Step> {
    let Playground { board, numbers } = playground;
    let clear = Clear { color: Some([0.0; 4]), depth: Some(board.clear_depth), stencil: Some(board.clear), counts: None };
    let why = "The stencil, and depth, as the board has them before the first shape.";
    let mut steps = vec![Step { label: "clear".into(), why: why.into(), view: 0, action: Action::Clear(clear) }];
    for (number, shape) in (1..).zip(&board.shapes) {
        steps.extend(drawn(number, shape, size, scissor));
    }
    steps.push(picture(*numbers, size, scissor));
    steps.extend(names(board, size, scissor));
    steps
}

/// One draw, or one for each face.
fn drawn(number: usize, shape: &Shape, size: [u32; 2], scissor: [u32; 4]) -> Vec<Step> {
    let (front, back) = (shape.front, shape.back());
    let passes: &[(&str, Cull, Face)] = if needs_two_draws(shape) {
        &[(", front faces", Cull::Back, front), (", back faces", Cull::Front, back)]
    } else {
        &[("", Cull::None, front)]
    };
    let corners = triangles(shape, size);
    let pass = |&(which, cull, face): &(&str, Cull, Face)| {
        let faces = if cull == Cull::None { (front, back) } else { (face, face) };
        let stencil = StencilState::played(tested(&faces.0), tested(&faces.1), face.read_mask, face.write_mask);
        let depth = Depth { compare: shape.depth_compare, write: shape.depth_write, bias: DepthBias::NONE };
        let state = State { depth, stencil, color: None, cull, winding: Winding::Ccw, near_plane: NearPlane::Clip };
        let draw = Draw {
            state,
            stencil_reference: face.reference,
            ..Draw::plain(Program::Bounds, DrawSet::Triangles(corners.clone()), scissor)
        };
        Step::drawing(format!("{number} {}{which}", shape.title()), "One shape, with the state that the board gives it.", draw)
    };
    passes.iter().map(pass).collect()
}

/// Whether the faces differ in what one draw has only one of.
#[must_use]
pub fn needs_two_draws(shape: &Shape) -> bool {
    let shared = |face: Face| (face.reference, face.read_mask, face.write_mask);
    shared(shape.front) != shared(shape.back())
}

const fn tested(face: &Face) -> StencilFace {
    StencilFace { compare: face.compare, fail: face.fail, depth_fail: face.depth_fail, pass: face.pass }
}

/// The outline in pixels from the upper left, counter-clockwise on screen for all but the bow's right half.
#[must_use]
pub fn outline(shape: &Shape, [width, height]: [u32; 2]) -> Vec<DVec2> {
    let around = |corners: u32, radius: &dyn Fn(u32) -> f64| {
        let at = |corner| DVec2::from_angle(TAU * (f64::from(corner) / f64::from(corners) + 0.25)) * radius(corner);
        (0..corners).map(at).collect::<Vec<_>>()
    };
    // Upwards is positive here, and the shape reaches from -1 to 1.
    let unit: Vec<DVec2> = match shape.kind {
        ShapeKind::Triangle => [(0.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(DVec2::from).into(),
        ShapeKind::Disc => around(96, &|_| 1.0),
        ShapeKind::Star => around(10, &|corner| if corner % 2 == 0 { 1.0 } else { 0.42 }),
        ShapeKind::Quad => [(-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (1.0, 1.0)].map(DVec2::from).into(),
        ShapeKind::Bow => [(-1.0, 1.0), (-1.0, -1.0), (1.0, 1.0), (1.0, -1.0)].map(DVec2::from).into(),
    };
    let (width, height) = (f64::from(width), f64::from(height));
    let [half_width, half_height] = shape.size.map(|side| f64::from(side) * height / 2.0);
    let middle = DVec2::new(f64::from(shape.at[0]) * width, f64::from(shape.at[1]) * height);
    let turn = DVec2::from_angle(f64::from(shape.turn).to_radians());
    unit.into_iter().map(|at| middle + turn.rotate(at * DVec2::new(half_width, half_height)) * DVec2::new(1.0, -1.0)).collect()
}

/// Corners in clip space, three a triangle: a fan about the middle, which sees all of every outline.
fn triangles(shape: &Shape, size: [u32; 2]) -> Vec<[f32; 4]> {
    let corners = outline(shape, size);
    let [width, height] = size.map(f64::from);
    let middle = DVec2::new(f64::from(shape.at[0]) * width, f64::from(shape.at[1]) * height);
    let sides = (0..corners.len()).map(|at| (at, (at + 1) % corners.len()));
    // Two of the bow's sides run through its middle.
    let sides = sides.filter(|(at, _)| shape.kind != ShapeKind::Bow || at % 2 == 0);
    let turned = shape.facing == Facing::Back;
    let triangle = |(from, to): (usize, usize)| {
        let (from, to) = if turned { (to, from) } else { (from, to) };
        [middle, corners[from], corners[to]].map(|at| {
            let clip = DVec2::new(at.x / width * 2.0 - 1.0, 1.0 - at.y / height * 2.0).as_vec2();
            [clip.x, clip.y, shape.depth, 1.0]
        })
    };
    sides.flat_map(triangle).collect()
}

/// Pixels a side of the cells that have a number each.
fn cell(height: u32) -> f32 {
    #[expect(clippy::cast_precision_loss, reason = "pixels")]
    let height = height as f32;
    (height / 20.0).round().max(20.0)
}

fn picture(numbers: bool, [_, height]: [u32; 2], scissor: [u32; 4]) -> Step {
    let draw = Draw {
        target: Target::Output,
        state: State { color: Some(Blend::Replace), ..State::FLAT },
        constant: [if numbers { cell(height) } else { 0.0 }, 0.0, 0.0, 0.0],
        ..Draw::plain(Program::Playground, DrawSet::FullScreen, scissor)
    };
    let why = "Reads the stencil, and gives each value a colour and, where numbers are asked for, its digits.";
    Step::drawing("the stencil as colours and numbers", why, draw)
}

/// Every shape's outline and its name, over the picture.
fn names(board: &Board, size: [u32; 2], scissor: [u32; 4]) -> Vec<Step> {
    if board.shapes.is_empty() {
        return Vec::new();
    }
    #[expect(clippy::cast_precision_loss, reason = "pixels")]
    let [width, height] = size.map(|side| side as f32);
    let text_size = (height / 50.0).round().clamp(11.0, 32.0);
    let mut strokes = Vec::new();
    let mut labels: Vec<Label> = Vec::new();
    for (number, shape) in (1..).zip(&board.shapes) {
        let points: Vec<_> = outline(shape, size).into_iter().map(|at| at.as_vec2().to_array()).collect();
        let top = points.iter().copied().min_by(|a, b| a[1].total_cmp(&b[1])).unwrap_or_default();
        let text = format!("{number} {}", shape.title());
        #[expect(clippy::cast_precision_loss, reason = "a few dozen letters")]
        let plate = [text.chars().count() as f32 * text_size * 0.602 + 10.0, text_size * 1.4];
        let left = points.iter().map(|at| at[0]).fold(f32::INFINITY, f32::min);
        let right = points.iter().map(|at| at[0]).fold(f32::NEG_INFINITY, f32::max);
        let x = ((left + right - plate[0]) / 2.0).round().clamp(2.0, (width - plate[0] - 2.0).max(2.0));
        let mut y = (top[1] + 3.0).round().clamp(2.0, (height - plate[1] - 2.0).max(2.0));
        // Below names that are there already, as far as the picture goes.
        let covers = |y: f32, other: &Label| {
            let [left, top, wide, high] = other.plate;
            x < left + wide && left < x + plate[0] && y < top + high && top < y + plate[1]
        };
        while labels.iter().any(|other| covers(y, other)) && y + 2.0 * plate[1] < height {
            y += plate[1] + 1.0;
        }
        let anchor = [x + plate[0] / 2.0, y + plate[1] / 2.0];
        labels.push(Label { text, kind: LabelKind::Shape, anchor, plate: [x, y, plate[0], plate[1]], text_size });
        strokes.push(Stroke { points, closed: true, width: 1.5, color: [1.0, 1.0, 1.0, 0.75], fill: None });
    }
    let over = |program, set| Draw {
        target: Target::Output,
        state: State { color: Some(Blend::Over), ..State::FLAT },
        ..Draw::plain(program, set, scissor)
    };
    vec![
        Step::drawing("outlines", "Where each shape lies.", over(Program::Lines, DrawSet::Strokes(strokes))),
        Step::drawing("names", "What each shape is called.", over(Program::Labels, DrawSet::Labels(labels))),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twice the area that the triangles enclose on screen, counter-clockwise positive, in pixels; left half, right half.
    fn areas(shape: &Shape) -> [f64; 2] {
        let mut areas = [0.0; 2];
        for corners in triangles(shape, [200, 100]).chunks(3) {
            let at = |corner: usize| DVec2::new(f64::from(corners[corner][0]) * 100.0, f64::from(corners[corner][1]) * 50.0);
            let (a, b, c) = (at(0), at(1), at(2));
            areas[usize::from((a + b + c).x > 0.0)] += (b - a).perp_dot(c - a);
        }
        areas
    }

    #[test]
    fn shapes_face_as_they_say_and_bows_both_ways() {
        for kind in ShapeKind::ALL {
            let shape = Shape { kind, size: [0.8, 0.6], turn: 20.0, ..Shape::default() };
            let [left, right] = areas(&shape);
            assert!(left > 0.0, "{kind:?}");
            assert_eq!(right > 0.0, kind != ShapeKind::Bow, "{kind:?}");
            let [turned_left, turned_right] = areas(&Shape { facing: Facing::Back, ..shape });
            assert!((turned_left + left).abs() < 1e-2 && (turned_right + right).abs() < 1e-2, "{kind:?}");
        }
    }

    #[test]
    fn only_what_the_faces_do_not_share_takes_two_draws() {
        let back = Face {
            pass: crate::frame::stencil::StencilOp::Invert,
            compare: crate::frame::state::Compare::Less,
            ..Face::default()
        };
        let shape = |back| Shape { back, ..Shape::default() };
        assert!(!needs_two_draws(&shape(None)) && !needs_two_draws(&shape(Some(back))));
        for other in [Face { reference: 1, ..back }, Face { read_mask: 1, ..back }, Face { write_mask: 1, ..back }] {
            assert!(needs_two_draws(&shape(Some(other))));
            let steps = drawn(1, &shape(Some(other)), [64, 64], [0, 0, 64, 64]);
            assert_eq!(steps.len(), 2);
        }
    }
}
