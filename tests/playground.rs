//! The playground on the GPU, held in every pixel against a plain function of the stencil test
//! ([`obscura::techniques::playground::model`]).
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::Stage;
use obscura::director::stage;
use obscura::frame::Capabilities;
use obscura::frame::state::{Blend, Compare};
use obscura::frame::stencil::StencilOp;
use obscura::frame::validate::validate;
use obscura::frame::{Action, DrawSet};
use obscura::scene::{Scene, stock};
use obscura::settings::boards::PRESETS;
use obscura::settings::{Board, Face, Facing, Playground, Settings, Shape, ShapeKind, Show};
use obscura::techniques::playground::model::{Pixel, draw};

/// What the board leaves in the stencil, rows from the top.
fn stencil(gpu: &mut (Stage, Scene), board: &Board, size: [u32; 2]) -> Vec<u8> {
    let playground = Playground { board: board.clone(), numbers: false };
    let settings = Settings { show: Show::Playground, playground, size, ..Settings::default() };
    let (stage, scene) = gpu;
    stage.shoot(&settings, scene);
    stage.stencil()
}

fn gpu() -> (Stage, Scene) {
    let mut stage = Stage::new();
    let scene = stock::build("cubes").unwrap().unwrap();
    stage.set_scene(&scene);
    (stage, scene)
}

fn store(reference: u8) -> Face {
    Face { reference, pass: StencilOp::Replace, ..Face::default() }
}

/// What is stored before the states are tried: one column each.
const STORED: [u8; 16] = [0, 1, 2, 3, 4, 15, 16, 0x35, 0x3c, 0x7f, 0x80, 0x81, 0xaa, 0xf0, 0xfe, 0xff];
/// Pixels of a column, and of a row.
const COLUMN: u32 = 4;
const ROW: u32 = 2;

/// A rectangle of whole pixels.
fn rectangle([x, y, width, height]: [u32; 4], size: [u32; 2]) -> Shape {
    let [wide, high] = size.map(|side| side as f32);
    let (x, y, width, height) = (x as f32, y as f32, width as f32, height as f32);
    Shape { at: [(x + width / 2.0) / wide, (y + height / 2.0) / high], size: [width / high, height / high], ..Shape::default() }
}

/// All comparisons by all operations in all three places, for both faces at once, on every stored value, before and behind
/// what is there: one board a pair of masks.
#[test]
fn every_comparison_operation_and_mask_is_as_the_model_has_it() {
    let mut gpu = gpu();
    let states: Vec<_> = (0..64).map(|state| (state / 8, state % 8)).collect();
    let size = [STORED.len() as u32 * COLUMN, states.len() as u32 * 2 * ROW];
    // The last: different ones for the two faces, which takes two draws.
    let masks = [((0xff, 0xff, 3), None), ((0x0f, 0xf0, 0x35), None), ((0xf0, 0x3c, 0x81), Some((0x3c, 0x0f, 0x10)))];
    for ((read_mask, write_mask, reference), of_back) in masks {
        let mut shapes = Vec::new();
        for (column, value) in (0u32..).zip(STORED) {
            // The right half is far, the left half near.
            for (half, depth) in [(0, 0.2), (1, 0.8)] {
                let x = column * COLUMN + half * COLUMN / 2;
                let stripe = rectangle([x, 0, COLUMN / 2, size[1]], size);
                shapes.push(Shape { depth, depth_write: true, front: store(value), ..stripe });
            }
        }
        let mut expected: Vec<Pixel> = Vec::new();
        for y in 0..size[1] {
            for x in 0..size[0] {
                let depth = if x % COLUMN < COLUMN / 2 { 0.2 } else { 0.8 };
                expected.push(Pixel { stencil: STORED[(x / COLUMN) as usize], depth });
                assert_eq!(expected.len() as u32, y * size[0] + x + 1);
            }
        }
        for (number, &(compare, op)) in (0u32..).zip(&states) {
            let face = |turn: usize, (read_mask, write_mask, reference)| Face {
                compare: Compare::ALL[(compare + turn) % 8],
                fail: StencilOp::ALL[(op + turn) % 8],
                depth_fail: StencilOp::ALL[(op + 3 + turn) % 8],
                pass: StencilOp::ALL[(op + 5 + turn) % 8],
                reference,
                read_mask,
                write_mask,
            };
            let front = face(0, (read_mask, write_mask, reference));
            let back = Some(face(1, of_back.unwrap_or((read_mask, write_mask, reference))));
            for (side, facing) in [(0, Facing::Front), (1, Facing::Back)] {
                let y = (number * 2 + side) * ROW;
                let row = rectangle([0, y, size[0], ROW], size);
                let shape = Shape { front, back, facing, depth: 0.5, depth_compare: Compare::Less, ..row };
                for pixel in &mut expected[(y * size[0]) as usize..((y + ROW) * size[0]) as usize] {
                    *pixel = draw(*pixel, &shape, facing == Facing::Front);
                }
                shapes.push(shape);
            }
        }
        let found = stencil(&mut gpu, &Board { clear: 77, clear_depth: 1.0, shapes }, size);
        for (index, (found, expected)) in found.iter().zip(&expected).enumerate() {
            let (x, y) = (index as u32 % size[0], index as u32 / size[0]);
            assert_eq!(*found, expected.stencil, "masks {read_mask:#x} {write_mask:#x}, pixel {x},{y}");
        }
        let changed =
            found.iter().enumerate().filter(|(index, found)| STORED[(*index as u32 % size[0] / COLUMN) as usize] != **found);
        assert!(changed.count() > found.len() / 8, "most states do something");
    }
}

/// Every preset, with its shapes' true outlines: which pixels a shape covers, and from which side, the GPU itself is asked
/// by drawing it alone.
#[test]
fn every_preset_is_as_the_model_has_it() {
    const SIZE: [u32; 2] = [160, 90];
    let mut gpu = gpu();
    for preset in PRESETS {
        let board = (preset.build)();
        let mut expected = vec![Pixel { stencil: board.clear, depth: board.clear_depth }; (SIZE[0] * SIZE[1]) as usize];
        let mut sides = [0usize; 2];
        for shape in &board.shapes {
            let back = Some(store(2));
            let alone = Shape { front: store(1), back, depth_compare: Compare::Always, ..shape.clone() };
            let covered = stencil(&mut gpu, &Board { clear: 0, clear_depth: 1.0, shapes: vec![alone] }, SIZE);
            for (pixel, side) in expected.iter_mut().zip(covered).filter(|(_, side)| *side > 0) {
                *pixel = draw(*pixel, shape, side == 1);
                sides[usize::from(side) - 1] += 1;
            }
        }
        let found = stencil(&mut gpu, &board, SIZE);
        let wrong = found.iter().zip(&expected).filter(|(found, expected)| **found != expected.stencil).count();
        assert_eq!(wrong, 0, "{}", preset.name);
        assert!(sides[0] > 1000, "{}: {sides:?}", preset.name);
        let values: std::collections::BTreeSet<_> = found.into_iter().collect();
        assert!(values.len() >= 3, "{} shows little: {values:?}", preset.name);
    }
}

#[test]
fn a_bow_shows_both_its_sides() {
    const SIZE: [u32; 2] = [64, 36];
    let shape = Shape { kind: ShapeKind::Bow, size: [1.0, 0.8], front: store(1), back: Some(store(2)), ..Shape::default() };
    let found = stencil(&mut gpu(), &Board { clear: 0, clear_depth: 1.0, shapes: vec![shape] }, SIZE);
    let at = |x: usize| found[18 * 64 + x];
    assert_eq!([at(20), at(44), at(2)], [1, 2, 0]);
}

#[test]
fn validation_keeps_others_off_the_board() {
    let scene = stock::build("cubes").unwrap().unwrap();
    let settings = Settings { show: Show::Playground, ..Settings::default() };
    let (_, plan) = stage(&settings, &scene, &Capabilities::complete()).unwrap();
    assert_eq!(validate(&plan), Ok(()));
    let mut colored = plan.clone();
    let shape = colored.steps.iter_mut().find_map(|step| match &mut step.action {
        Action::Draw(draw) if matches!(draw.set, DrawSet::Triangles(_)) => Some(draw),
        _ => None,
    });
    shape.unwrap().state.color = Some(Blend::Replace);
    assert!(validate(&colored).unwrap_err().what.contains("nothing else"));
    let mut narrow = plan.clone();
    narrow.budget = narrow.budget.with_mirrors(1);
    assert!(validate(&narrow).unwrap_err().what.contains("no other owner"));
    // A step of an ordinary frame, put behind the shapes.
    let (_, lit) = stage(&Settings::default(), &scene, &Capabilities::complete()).unwrap();
    let counting =
        lit.steps.iter().find(|step| matches!(&step.action, Action::Draw(draw) if draw.state.stencil.writes())).unwrap();
    let mut disturbed = plan.clone();
    let last = disturbed
        .steps
        .iter()
        .rposition(|step| matches!(&step.action, Action::Draw(draw) if matches!(draw.set, DrawSet::Triangles(_))));
    disturbed.steps.insert(last.unwrap() + 1, counting.clone());
    assert!(validate(&disturbed).unwrap_err().what.contains("play"));
}
