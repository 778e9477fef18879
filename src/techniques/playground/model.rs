//! The stencil test as a plain function: what a GPU does to one pixel (K section 1).

use crate::frame::state::Compare;
use crate::frame::stencil::StencilOp;
use crate::settings::{Face, Shape};

/// One pixel: what is stored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pixel {
    /// All eight bits.
    pub stencil: u8,
    /// 0 is near, 1 far.
    pub depth: f32,
}

/// What a fragment of `shape` leaves of a pixel; `front` says which of its sides is seen.
#[must_use]
pub fn draw(pixel: Pixel, shape: &Shape, front: bool) -> Pixel {
    let face = if front { shape.front } else { shape.back() };
    let asked = (face.reference & face.read_mask, pixel.stencil & face.read_mask);
    let passes = compares(face.compare, asked.0, asked.1);
    let in_depth = compares(shape.depth_compare, shape.depth, pixel.depth);
    let op = match (passes, in_depth) {
        (false, _) => face.fail,
        (true, false) => face.depth_fail,
        (true, true) => face.pass,
    };
    let depth = if passes && in_depth && shape.depth_write { shape.depth } else { pixel.depth };
    Pixel { stencil: operate(op, pixel.stencil, &face), depth }
}

/// Incoming against stored.
fn compares<T: PartialOrd>(compare: Compare, incoming: T, stored: T) -> bool {
    match compare {
        Compare::Never => false,
        Compare::Always => true,
        Compare::Equal => incoming == stored,
        Compare::NotEqual => incoming != stored,
        Compare::Less => incoming < stored,
        Compare::LessEqual => incoming <= stored,
        Compare::Greater => incoming > stored,
        Compare::GreaterEqual => incoming >= stored,
    }
}

/// The operation works on all eight bits; of what comes out only the bits of the write mask are stored.
fn operate(op: StencilOp, stored: u8, face: &Face) -> u8 {
    let value = match op {
        StencilOp::Keep => stored,
        StencilOp::Zero => 0,
        StencilOp::Replace => face.reference,
        StencilOp::Invert => !stored,
        StencilOp::IncrementClamp => stored.saturating_add(1),
        StencilOp::DecrementClamp => stored.saturating_sub(1),
        StencilOp::IncrementWrap => stored.wrapping_add(1),
        StencilOp::DecrementWrap => stored.wrapping_sub(1),
    };
    stored & !face.write_mask | value & face.write_mask
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(stored: u8, face: Face) -> u8 {
        draw(Pixel { stencil: stored, depth: 1.0 }, &Shape { front: face, ..Shape::default() }, true).stencil
    }

    #[test]
    fn operations_as_kilgard_has_them() {
        let on_pass = |pass| Face { pass, reference: 0x5a, ..Face::default() };
        let expected = [
            (StencilOp::Keep, [0, 255]),
            (StencilOp::Zero, [0, 0]),
            (StencilOp::Replace, [0x5a, 0x5a]),
            (StencilOp::Invert, [255, 0]),
            (StencilOp::IncrementClamp, [1, 255]),
            (StencilOp::DecrementClamp, [0, 254]),
            (StencilOp::IncrementWrap, [1, 0]),
            (StencilOp::DecrementWrap, [255, 254]),
        ];
        for (op, results) in expected {
            assert_eq!([after(0, on_pass(op)), after(255, on_pass(op))], results, "{op:?}");
        }
    }

    #[test]
    fn masks_hide_bits_from_the_test_and_from_the_operation() {
        let face = Face { compare: Compare::Equal, reference: 0x31, read_mask: 0x0f, write_mask: 0xf0, ..Face::default() };
        let replace = Face { pass: StencilOp::Replace, ..face };
        assert_eq!(after(0x81, replace), 0x31, "low bits agree, high bits are replaced");
        assert_eq!(after(0x82, replace), 0x82, "low bits differ");
        let adds = Face { pass: StencilOp::IncrementWrap, write_mask: 0x0f, ..Face::default() };
        assert_eq!(after(0x2f, adds), 0x20, "the carry is lost with its bit");
        let adds = Face { pass: StencilOp::IncrementClamp, write_mask: 0x0f, ..Face::default() };
        assert_eq!(after(0x2f, adds), 0x20, "clamping saturates the byte, not the field");
        assert_eq!(after(0xff, adds), 0xff);
    }

    #[test]
    fn the_reference_stands_on_the_left_of_the_comparison() {
        for (compare, passes) in [(Compare::Less, [false, false, true]), (Compare::GreaterEqual, [true, true, false])] {
            let face = Face { compare, reference: 2, pass: StencilOp::Zero, fail: StencilOp::Invert, ..Face::default() };
            let results = [1, 2, 3].map(|stored| after(stored, face) == 0);
            assert_eq!(results, passes, "{compare:?}");
        }
    }

    #[test]
    fn depth_decides_after_the_stencil_and_is_written_only_where_both_pass() {
        let front =
            Face { fail: StencilOp::Zero, depth_fail: StencilOp::Invert, pass: StencilOp::IncrementWrap, ..Face::default() };
        let back = Some(Face { compare: Compare::Never, ..front });
        let shape = Shape { front, back, depth: 0.5, depth_compare: Compare::Less, depth_write: true, ..Shape::default() };
        let far = Pixel { stencil: 3, depth: 0.9 };
        assert_eq!(draw(far, &shape, true), Pixel { stencil: 4, depth: 0.5 });
        assert_eq!(draw(Pixel { depth: 0.2, ..far }, &shape, true), Pixel { stencil: !3, depth: 0.2 });
        assert_eq!(draw(far, &shape, false), Pixel { stencil: 0, depth: 0.9 });
    }
}
