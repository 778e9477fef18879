//! Boards that show something about the stencil test, by name.

use super::playground::{Board, Face, Facing, Shape, ShapeKind};
use crate::frame::state::Compare;
use crate::frame::stencil::StencilOp;

/// A board with a name.
#[derive(Debug, Clone, Copy)]
pub struct Preset {
    /// On the command line and in the panel.
    pub name: &'static str,
    /// One sentence: what to see in it.
    pub about: &'static str,
    /// Makes it.
    pub build: fn() -> Board,
}

/// Every board, the default first.
pub const PRESETS: &[Preset] = &[
    Preset { name: "table-2", about: "each of Kilgard's stencil states at work, from the initial values on", build: table_2 },
    Preset {
        name: "operations",
        about: "each operation on the stored values 0, 1, 4 and 255, the reference 5",
        build: operations,
    },
    Preset {
        name: "comparisons",
        about: "each comparison of the reference 2 with the stored values 1, 2 and 3: zero where it passes",
        build: comparisons,
    },
    Preset { name: "masks", about: "write masks let through one field of bits each, and a read mask asks for one", build: masks },
    Preset { name: "two-sided", about: "front faces add one, back faces take one away, as shadow volumes do", build: two_sided },
    Preset {
        name: "z-fail",
        about: "operations where depth fails: a volume's faces, its front and its back, behind a disc and before it",
        build: z_fail,
    },
    Preset { name: "clamp-and-wrap", about: "the two ways of counting past the ends, 0 and 255", build: clamp_and_wrap },
    Preset {
        name: "mirrors",
        about: "a tag in the high bits, a count in the low ones, and a masked reset, as mirrors with shadows have it",
        build: mirrors,
    },
];

/// The board of this name.
#[must_use]
pub fn find(name: &str) -> Option<&'static Preset> {
    PRESETS.iter().find(|preset| preset.name == name)
}

/// The name of the preset that a board is.
#[must_use]
pub fn name_of(board: &Board) -> Option<&'static str> {
    PRESETS.iter().find(|preset| (preset.build)() == *board).map(|preset| preset.name)
}

fn board(shapes: Vec<Shape>) -> Board {
    Board { clear: 0, clear_depth: 1.0, shapes }
}

fn shape(kind: ShapeKind, at: [f32; 2], size: [f32; 2], front: Face) -> Shape {
    Shape { kind, at, size, front, ..Shape::default() }
}

fn named(name: &str, shape: Shape) -> Shape {
    Shape { name: name.into(), ..shape }
}

/// Stores a value wherever it is drawn.
fn store(reference: u8) -> Face {
    Face { reference, pass: StencilOp::Replace, ..Face::default() }
}

fn on_pass(pass: StencilOp) -> Face {
    Face { pass, ..Face::default() }
}

/// The stencil's state, item by item (K table 2).
#[must_use]
pub fn table_2() -> Board {
    use ShapeKind::{Disc, Quad, Star, Triangle};
    let ringed = Face { compare: Compare::Equal, fail: StencilOp::Invert, ..store(1) };
    let low = Face { compare: Compare::Equal, read_mask: 0x0f, reference: 0x21, write_mask: 0xf0, ..store(0) };
    board(vec![
        named("initial values", shape(Quad, [0.5, 0.12], [1.2, 0.16], Face::default())),
        named("replace by 1", shape(Disc, [0.36, 0.56], [0.66, 0.66], store(1))),
        named("increment", shape(Triangle, [0.58, 0.5], [0.62, 0.6], on_pass(StencilOp::IncrementWrap))),
        named("equal 1: keep, else invert", shape(Star, [0.3, 0.72], [0.42, 0.42], Face { pass: StencilOp::Keep, ..ringed })),
        named("low bits 1: high bits 2", shape(Quad, [0.62, 0.72], [0.7, 0.16], low)),
    ])
}

fn operations() -> Board {
    let mut shapes = Vec::new();
    for (row, value) in [0u8, 1, 4, 255].into_iter().enumerate() {
        let y = 0.2 + 0.2 * row as f32;
        shapes.push(named(&format!("stored {value}"), shape(ShapeKind::Quad, [0.5, y], [1.7, 0.18], store(value))));
    }
    for (column, op) in StencilOp::ALL.into_iter().enumerate() {
        let x = 0.125 + 0.107 * column as f32;
        let face = Face { reference: 5, pass: op, ..Face::default() };
        shapes.push(named(op.name(), shape(ShapeKind::Quad, [x, 0.5], [0.13, 0.94], face)));
    }
    board(shapes)
}

fn comparisons() -> Board {
    let mut shapes = Vec::new();
    for (row, value) in [1u8, 2, 3].into_iter().enumerate() {
        let y = 0.25 + 0.25 * row as f32;
        shapes.push(named(&format!("stored {value}"), shape(ShapeKind::Quad, [0.5, y], [1.7, 0.22], store(value))));
    }
    for (column, compare) in Compare::ALL.into_iter().enumerate() {
        let x = 0.125 + 0.107 * column as f32;
        let face = Face { compare, reference: 2, pass: StencilOp::Zero, ..Face::default() };
        shapes.push(named(compare.name(), shape(ShapeKind::Quad, [x, 0.5], [0.13, 0.94], face)));
    }
    board(shapes)
}

fn masks() -> Board {
    use ShapeKind::{Disc, Quad};
    let bits = |write_mask| Face { write_mask, ..store(0xff) };
    let asks = Face { compare: Compare::Equal, reference: 0x0c, read_mask: 0x0c, pass: StencilOp::Zero, ..Face::default() };
    board(vec![
        named("write 00000011", shape(Disc, [0.38, 0.4], [0.6, 0.6], bits(0x03))),
        named("write 00001100", shape(Disc, [0.62, 0.4], [0.6, 0.6], bits(0x0c))),
        named("write 11110000", shape(Disc, [0.5, 0.66], [0.6, 0.6], bits(0xf0))),
        named("zero where bits 00001100 are set", shape(Quad, [0.5, 0.5], [1.5, 0.1], asks)),
    ])
}

fn two_sided() -> Board {
    let front = on_pass(StencilOp::IncrementWrap);
    let back = Some(on_pass(StencilOp::DecrementWrap));
    let both = |kind, at, size, facing| Shape { back, facing, ..shape(kind, at, size, front) };
    board(vec![
        both(ShapeKind::Bow, [0.5, 0.4], [1.3, 0.6], Facing::Front),
        named("disc, front", both(ShapeKind::Disc, [0.3, 0.55], [0.6, 0.6], Facing::Front)),
        named("disc, back", both(ShapeKind::Disc, [0.7, 0.55], [0.6, 0.6], Facing::Back)),
        named("star, front", both(ShapeKind::Star, [0.5, 0.66], [0.6, 0.6], Facing::Front)),
    ])
}

fn z_fail() -> Board {
    let depth = |depth, shape| Shape { depth, depth_compare: Compare::Less, ..shape };
    let surface = |shape| Shape { depth_write: true, ..shape };
    let front = Face { depth_fail: StencilOp::DecrementWrap, ..Face::default() };
    let back = Some(Face { depth_fail: StencilOp::IncrementWrap, ..Face::default() });
    let face =
        |name, at, facing, z| named(name, depth(z, Shape { facing, back, ..shape(ShapeKind::Quad, at, [0.36, 0.84], front) }));
    let disc = |name, x, z| named(name, surface(depth(z, shape(ShapeKind::Disc, [x, 0.5], [0.44, 0.44], Face::default()))));
    board(vec![
        named("floor, depth 0.9", surface(depth(0.9, shape(ShapeKind::Quad, [0.5, 0.55], [1.66, 0.7], Face::default())))),
        disc("disc, depth 0.2", 0.22, 0.2),
        disc("disc, depth 0.5", 0.5, 0.5),
        disc("disc, depth 0.8", 0.78, 0.8),
        face("front, 0.4", [0.22, 0.5], Facing::Front, 0.4),
        face("back, 0.7", [0.22, 0.5], Facing::Back, 0.7),
        face("front, 0.4", [0.5, 0.5], Facing::Front, 0.4),
        face("back, 0.7", [0.5, 0.5], Facing::Back, 0.7),
        face("front, 0.4", [0.78, 0.5], Facing::Front, 0.4),
        face("back, 0.7", [0.78, 0.5], Facing::Back, 0.7),
        Shape { kind: ShapeKind::Star, size: [0.6, 0.6], ..face("star, front, 0.3", [0.5, 0.52], Facing::Front, 0.3) },
        Shape { kind: ShapeKind::Star, size: [0.6, 0.6], ..face("star, back, 0.6", [0.5, 0.52], Facing::Back, 0.6) },
    ])
}

fn clamp_and_wrap() -> Board {
    use StencilOp::{DecrementClamp, DecrementWrap, IncrementClamp, IncrementWrap};
    let mut shapes = vec![
        named("stored 254", shape(ShapeKind::Quad, [0.5, 0.3], [1.7, 0.3], store(254))),
        named("stored 1", shape(ShapeKind::Quad, [0.5, 0.72], [1.7, 0.3], store(1))),
    ];
    for (column, op) in [IncrementClamp, IncrementWrap, DecrementClamp, DecrementWrap].into_iter().enumerate() {
        for turn in 0..3u8 {
            let x = 0.16 + 0.226 * column as f32 + 0.018 * f32::from(turn);
            let name = if turn == 0 { op.name() } else { "again" };
            shapes.push(named(name, shape(ShapeKind::Disc, [x, 0.5], [0.28, 0.86], on_pass(op))));
        }
    }
    board(shapes)
}

fn mirrors() -> Board {
    use ShapeKind::{Disc, Quad, Star};
    let tag = Face { write_mask: 0xc0, ..store(0x40) };
    let inside =
        |pass| Face { compare: Compare::Equal, reference: 0x40, read_mask: 0xc0, write_mask: 0x3f, pass, ..Face::default() };
    let deeper =
        Face { compare: Compare::Equal, reference: 0x40, read_mask: 0xc0, write_mask: 0xc0, ..inside(StencilOp::Invert) };
    let reset =
        Face { compare: Compare::Equal, reference: 0x80, read_mask: 0xc0, write_mask: 0x3f, pass: StencilOp::Zero, ..tag };
    board(vec![
        named("room: +1", shape(Disc, [0.28, 0.4], [0.7, 0.7], on_pass(StencilOp::IncrementWrap))),
        named("tag a mirror", shape(Quad, [0.58, 0.52], [0.9, 0.66], tag)),
        named("in it: +1", shape(Star, [0.46, 0.5], [0.7, 0.7], inside(StencilOp::IncrementWrap))),
        named("a mirror in it", shape(Quad, [0.68, 0.56], [0.44, 0.4], deeper)),
        named("reset in that one", shape(Quad, [0.5, 0.56], [1.6, 0.9], reset)),
    ])
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a failed unwrap is a failed test
    use super::*;

    #[test]
    fn every_preset_is_found_by_its_name_and_survives_a_file() {
        for preset in PRESETS {
            let board = (preset.build)();
            assert_eq!(find(preset.name).unwrap().name, preset.name);
            assert_eq!(name_of(&board), Some(preset.name), "no two are the same");
            let text = serde_json::to_string(&board).unwrap();
            assert_eq!(serde_json::from_str::<Board>(&text).unwrap(), board, "{text}");
        }
        assert_eq!(name_of(&Board::default()), Some(PRESETS[0].name));
    }

    #[test]
    fn what_a_file_leaves_out_is_at_its_initial_value() {
        let board: Board = serde_json::from_str(r#"{"shapes": [{"kind": "disc", "front": {"pass": "invert"}}]}"#).unwrap();
        let front = Face { pass: StencilOp::Invert, ..Face::default() };
        let expected = Shape { kind: ShapeKind::Disc, front, ..Shape::default() };
        assert_eq!((board.clear, board.clear_depth, board.shapes), (0, 1.0, vec![expected]));
    }
}
