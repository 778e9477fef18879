//! The receivers' bits: every pixel of a receiver of planar shadows holds a value that no other surface has (K section 5).
//!
//! ```text
//!   bit   7 6 5 4 3 2 1 0
//!         r r r r r r r s    v = the receiver's bits, v + 1 = the same with s: "one plus each otherwise unused stencil
//!                            value should also be otherwise unused"
//!         r r r r r r s s    where shadowed pixels are drawn anew: v, v + 1 in a shadow, v + 2 in this light's
//!         r r V [ count ]    beside shadow volumes: V is what a batch of volumes leaves, and is left by shadows too
//! ```

use super::{BitBudget, Compare, StencilFace, StencilOp, StencilState};

impl BitBudget {
    /// The same with `bits` for receivers over the `low` ones; a count that took them has as many bits less.
    #[must_use]
    pub const fn with_receivers(self, low: u32, bits: u32) -> Self {
        let below = u8::MAX.unbounded_shr(8 - low);
        let receiver_mask = u8::MAX.unbounded_shr(8 - bits).unbounded_shl(low) & !self.mirror_mask;
        Self { count_mask: self.count_mask & below, receiver_mask, ..self }
    }

    /// How many bits nobody has but counting, and receivers.
    #[must_use]
    pub const fn low_bits(self) -> u32 {
        (!(self.mirror_mask | self.beyond_mask)).count_ones()
    }

    /// How many receivers can be told apart at a time.
    #[must_use]
    pub const fn receivers(self) -> usize {
        if self.receiver_mask == 0 { 0 } else { (self.receiver_mask >> self.receiver_mask.trailing_zeros()) as usize }
    }

    /// The value of a receiver's pixels, the first having number 0; not 0, which is every other surface's.
    #[must_use]
    pub const fn receiver(self, number: usize) -> u8 {
        ((number + 1) << self.receiver_mask.trailing_zeros()) as u8 & self.receiver_mask
    }

    /// The receivers' bits, and those that change while light falls on one.
    const fn receiving(self) -> u8 {
        self.receiver_mask | self.count_mask
    }
}

impl StencilState {
    /// A receiver's visible pixels, where no receiver is yet, get its value: 0 with the bits of `value` turned over.
    #[must_use]
    pub const fn tag_receiver(budget: BitBudget, value: u8) -> Self {
        let face = StencilFace { pass: StencilOp::Invert, ..StencilFace::test(Compare::Equal) };
        Self { front: face, back: face, read_mask: budget.receiver_mask, write_mask: value }
    }

    /// Pixels that hold the reference hold it no more: `step` is one up, one down, or to nothing. So nothing is done to
    /// them twice (K section 5: "there is no risk of double incrementing a pixel").
    #[must_use]
    pub const fn move_on(budget: BitBudget, step: StencilOp) -> Self {
        let face = StencilFace { pass: step, ..StencilFace::test(Compare::Equal) };
        Self { front: face, back: face, read_mask: budget.receiving(), write_mask: budget.receiving() }
    }

    /// Passes where a pixel holds the reference, and changes nothing.
    #[must_use]
    pub const fn on_receiver(budget: BitBudget) -> Self {
        let face = StencilFace::test(Compare::Equal);
        Self { front: face, back: face, read_mask: budget.receiving(), write_mask: 0 }
    }

    /// A receiver's pixels, whatever is counted in them, are in shadow: the reference holds the receiver's value and the
    /// verdict bit.
    #[must_use]
    pub const fn shadow_receiver(budget: BitBudget) -> Self {
        let face = StencilFace { pass: StencilOp::Replace, ..StencilFace::test(Compare::Equal) };
        Self { front: face, back: face, read_mask: budget.receiver_mask, write_mask: budget.verdict_mask }
    }

    /// No pixel is a receiver's any more.
    #[must_use]
    pub const fn forget_receivers(budget: BitBudget) -> Self {
        Self::replace(budget.receiver_mask)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_receiver_has_values_of_its_own() {
        for (low, mirrors) in [(1, 0), (2, 0), (1, 3), (2, 8), (5, 0)] {
            let whole = BitBudget::default().with_mirrors(mirrors);
            let budget = whole.with_receivers(low, whole.low_bits() - low);
            let values: Vec<u8> = (0..budget.receivers()).map(|number| budget.receiver(number)).collect();
            assert_eq!(values.len(), (1 << (whole.low_bits() - low)) - 1);
            assert!(values.is_sorted_by(|a, b| a < b) && values[0] == 1 << low, "{values:?}");
            assert!(values.iter().all(|value| value & !budget.receiver_mask == 0));
            assert_eq!(budget.receiver_mask & (budget.mirror_mask | budget.count_mask), 0);
            assert_eq!(budget.count_mask, (1 << low) - 1);
            assert_eq!(budget.reserved() & budget.mirror_mask, 0);
        }
        assert_eq!(BitBudget::default().receivers(), 0);
    }

    #[test]
    fn beside_volumes_the_verdict_stands_between_count_and_receivers() {
        let budget = BitBudget::default().with_receivers(6, 2).batched();
        assert_eq!((budget.receiver_mask, budget.verdict_mask, budget.count_mask), (0b1100_0000, 0b0010_0000, 0b0001_1111));
        assert_eq!(budget.batched(), budget);
        assert_eq!(budget.receivers(), 3);
        assert_eq!(budget.shadow_mask() & budget.receiver_mask, 0, "receivers are no shadow");
    }
}
