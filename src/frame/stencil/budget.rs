//! Who owns which of the stencil's eight bits in one frame.

use serde::Serialize;

/// Which bits belong to whom in one frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
pub struct BitBudget {
    /// The low field: how many volumes hold the pixel, modulo its size.
    pub count_mask: u8,
    /// One bit above the field, or none: the pixel was found in shadow by a batch of volumes that is
    /// no longer counted.
    pub verdict_mask: u8,
    /// The highest bit, or none: the pixel's surface lies beyond the light's bounds, where nothing is
    /// counted ([`crate::techniques::depth_bounds`]).
    pub beyond_mask: u8,
    /// Bits that single points of a light with a size have for themselves ([`crate::techniques::own_bits`]): all
    /// in this frame; or the verdict bit alone, where it is one point's own.
    pub points_mask: u8,
    /// Whether the light has bounds that are marked there; others leave the bit as it is.
    pub bounded: bool,
    /// The highest bits, or none: how many mirrors lie on the way from the eye to the pixel's surface
    /// ([`Self::level`]).
    pub mirror_mask: u8,
    /// One bit for as long as decals are drawn, or none: the ground that they lie on ([`crate::techniques::decals`]).
    pub decal_mask: u8,
    /// The lowest three, or none: objects with halos, and what glows ([`crate::techniques::halo`]), when nothing is
    /// counted any more.
    pub halo_mask: u8,
    /// Bits that tell receivers of planar shadows apart, or none ([`Self::receiver`]).
    pub receiver_mask: u8,
}

impl Default for BitBudget {
    fn default() -> Self {
        Self::of_bits(8)
    }
}

impl BitBudget {
    /// A field of 1 to 8 bits.
    #[must_use]
    pub const fn of_bits(bits: u32) -> Self {
        Self {
            count_mask: u8::MAX
                >> (8 - if bits < 1 {
                    1
                } else if bits > 8 {
                    8
                } else {
                    bits
                }),
            verdict_mask: 0,
            beyond_mask: 0,
            points_mask: 0,
            bounded: false,
            mirror_mask: 0,
            halo_mask: 0,
            receiver_mask: 0,
            decal_mask: 0,
        }
    }

    /// The same with the highest bits for mirrors that lie up to `levels` deep in one another; a field that took
    /// them has as many bits less.
    #[must_use]
    pub const fn with_mirrors(self, levels: u32) -> Self {
        let bits = u32::BITS - levels.leading_zeros();
        let mirror_mask = !(u8::MAX.unbounded_shr(bits));
        Self { count_mask: self.count_mask & !mirror_mask, mirror_mask, ..self }
    }

    /// The same with the highest bit that none of `taken` is for the ground of decals; it is free again when they are drawn.
    #[must_use]
    pub const fn with_decals(self, taken: u8) -> Self {
        Self { decal_mask: highest(!(taken | self.beyond_mask | self.mirror_mask)), ..self }
    }

    /// The same with the lowest bits for halos, after all light. Mirrors never need so many that these are among theirs.
    #[must_use]
    pub const fn with_halos(self) -> Self {
        Self { halo_mask: 0b111 & !self.mirror_mask, ..self }
    }

    /// The bit of what has a halo: the highest of theirs. Those below count how often a pixel glows.
    #[must_use]
    pub const fn halo_tag(self) -> u8 {
        if self.halo_mask == 0 { 0 } else { highest(self.halo_mask) }
    }

    /// The mirror bits of pixels that are seen by way of so many mirrors. The operation `Invert` turns all bits of a
    /// write mask over, so that one step asks for a level and leads to any other.
    #[must_use]
    pub const fn level(self, mirrors: u32) -> u8 {
        (mirrors << self.mirror_mask.trailing_zeros()) as u8 & self.mirror_mask
    }

    /// The same with the highest bit that is left for what lies beyond the light's bounds; a field that took it
    /// has one bit less.
    #[must_use]
    pub const fn with_bounds(self) -> Self {
        let beyond_mask = highest(!self.mirror_mask);
        Self { count_mask: self.count_mask & !beyond_mask, beyond_mask, bounded: true, ..self }
    }

    /// The same for a light whose bounds are not marked.
    #[must_use]
    pub const fn without_bounds(self) -> Self {
        Self { bounded: false, ..self }
    }

    /// The bit that tells what lies beyond the light's bounds, where those are marked.
    #[must_use]
    pub const fn beyond(self) -> u8 {
        if self.bounded { self.beyond_mask } else { 0 }
    }

    /// For one point of a light: it counts in the low `count_bits`, which it shares, and its verdict is its `own` bit. Where
    /// there are none to count in, the own bit is turned over instead.
    #[must_use]
    pub const fn of_point(count_bits: u32, own: u8) -> Self {
        let count_mask = ((1_u32 << count_bits) - 1) as u8;
        Self { count_mask, verdict_mask: own, points_mask: own, ..Self::of_bits(1) }
    }

    /// Whether the verdict bit is one point's own: all of its count ends up there.
    #[must_use]
    pub const fn is_points(self) -> bool {
        self.points_mask != 0 && self.points_mask == self.verdict_mask
    }

    /// The largest count that the field tells from all smaller ones; a bit that is turned over tells one
    /// from none.
    #[must_use]
    pub const fn largest(self) -> u32 {
        if self.count_mask == 0 { 1 } else { self.count_mask as u32 }
    }

    /// What counting may ever write in a frame of this budget: with batches or without.
    #[must_use]
    pub const fn reserved(self) -> u8 {
        let counted = self.shadow_mask() | self.batched().shadow_mask() | self.points_mask;
        counted | self.halo_mask | self.receiver_mask | self.decal_mask
    }

    /// All that is zero where the light shines: the field, the verdict bit, and the bounds'; or a point's own
    /// bit.
    #[must_use]
    pub const fn shadow_mask(self) -> u8 {
        if self.is_points() {
            return self.verdict_mask;
        }
        self.count_mask | self.verdict_mask | self.beyond()
    }

    /// What counting asks of the stored value: the bounds' bit; without one it asks nothing, of `counted`.
    pub(super) const fn asked(self, counted: u8) -> u8 {
        if self.bounded { self.beyond_mask } else { counted }
    }

    /// The same with a verdict bit: the bit above the field, or the field's own highest where there
    /// is none above it. A point's own bit stays what it is.
    #[must_use]
    pub const fn batched(self) -> Self {
        if self.is_points() {
            return self;
        }
        let count_mask = self.count_mask & (highest(!(self.mirror_mask | self.beyond_mask | self.receiver_mask)) - 1);
        Self { count_mask, verdict_mask: count_mask + 1, ..self }
    }
}

/// The highest bit of a mask that has one.
const fn highest(mask: u8) -> u8 {
    1 << (mask | 1).ilog2()
}
