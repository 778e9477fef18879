//! The stencil of a solid's own target, apart from the frame's ([`crate::techniques::csg`]).
//!
//! ```text
//!   bit   7 6 5 4 3 2 1 0
//!         P [   layer   ]     layer: which of a pixel's fragments, in the order they are drawn, comes next
//!                             P: an odd number of the other operand's faces lie behind the layer
//! ```

use super::StencilOp::{IncrementWrap, Invert, Keep};
use super::{StencilFace, StencilState};
use crate::frame::state::Compare;

/// The bit that tells on which side of the other operand a layer lies.
pub const INSIDE: u8 = 0x80;

/// How many layers so many bits tell apart; one more bit belongs to [`INSIDE`].
#[must_use]
pub const fn most_layers(bits: u32) -> usize {
    1 << layer_bits(bits)
}

const fn layer_bits(bits: u32) -> u32 {
    match bits {
        0 | 1 => 0,
        2..8 => bits - 1,
        _ => 7,
    }
}

impl StencilState {
    /// All bits become the reference, which is 0.
    #[must_use]
    pub const fn solid_begin() -> Self {
        Self::replace(u8::MAX)
    }

    /// Of a pixel's fragments, in the order they are drawn, only the one passes whose number is the reference; each counts.
    #[must_use]
    pub const fn solid_layer(bits: u32) -> Self {
        let face = StencilFace { compare: Compare::Equal, fail: IncrementWrap, depth_fail: IncrementWrap, pass: IncrementWrap };
        let mask = ((1u32 << layer_bits(bits)) - 1) as u8;
        Self { front: face, back: face, read_mask: mask, write_mask: mask }
    }

    /// Every face that is not nearer than the layer turns the bit over.
    #[must_use]
    pub const fn solid_parity() -> Self {
        let face = StencilFace::always(Invert, Keep);
        Self { front: face, back: face, read_mask: 0, write_mask: INSIDE }
    }
}
