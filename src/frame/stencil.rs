//! The stencil's eight bits: who owns them, the named operations, and words for people.
//!
//! This module owns the budget (DESIGN section 5); no other code writes a mask. Increment adds to the
//! whole byte, so only the low field can count; it takes all bits that nobody else needs (mirrors
//! take the high ones), or as many as the settings say.
//!
//! ```text
//!   bit   7 6 5 4 3 2 1 0
//!         [ shadow count  ]      modulo 256
//!         m m [shadow count]     how many mirrors lie on the way; all others then have what is left
//!         V [shadow count ]      V: shadowed by a batch before; modulo 128
//!         B [shadow count ]      B: beyond the light's depth bounds; modulo 128
//!         B V [shadow count ]    both; modulo 64
//!         h g f e d c b a        a bit for each of eight points of a light with a size
//!         d c b a [ count ]      for each of four, that count in the low bits one after the other
//!                   T g g        after all light: T, an object with a halo; g, how often the pixel glows
//!                       p        after all light: p, has turned to the picture that it dissolves into
//!         r r r r r r r s        which receiver of planar shadows; shadowed, or lit the round before
//!         r r V [ count ]        the same beside volumes: V, shadowed by what is projected
//! ```
//!
//! All of them (receivers' apart: `frame::stencil::receivers`) are zero where the light shines, so that one comparison
//! with zero asks for all.
//!
//! A light whose volumes could lie over one pixel more often than the field can tell apart is counted
//! in batches ([`BitBudget::batched`]): after each, one full-screen step ([`StencilState::collapse`])
//! turns every count that is not zero into the verdict bit and starts the field anew.

mod budget;
mod receivers;
mod solid;

use serde::{Deserialize, Serialize};

use super::state::Compare;
pub use budget::BitBudget;
pub use solid::{INSIDE, most_layers};

/// What happens to the stored value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StencilOp {
    /// Stays.
    Keep,
    /// One more, wrapping: the order in which faces arrive must not matter.
    IncrementWrap,
    /// One less, wrapping.
    DecrementWrap,
    /// One more, but never past the byte's largest value: the old operation, which loses counts.
    IncrementClamp,
    /// One less, but never below zero.
    DecrementClamp,
    /// Becomes zero.
    Zero,
    /// Becomes the reference.
    Replace,
    /// All bits turn over.
    Invert,
}

impl StencilOp {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 8] = [
        Self::Keep,
        Self::Zero,
        Self::Replace,
        Self::Invert,
        Self::IncrementClamp,
        Self::DecrementClamp,
        Self::IncrementWrap,
        Self::DecrementWrap,
    ];

    /// The name in files and for people.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Keep => "keep",
            Self::Zero => "zero",
            Self::Replace => "replace",
            Self::Invert => "invert",
            Self::IncrementClamp => "increment-clamp",
            Self::DecrementClamp => "decrement-clamp",
            Self::IncrementWrap => "increment-wrap",
            Self::DecrementWrap => "decrement-wrap",
        }
    }
}

/// Test and operations for one side of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
pub struct StencilFace {
    /// `reference & read_mask` against `stored & read_mask`.
    pub compare: Compare,
    /// Where the stencil test fails.
    pub fail: StencilOp,
    /// Where the stencil test passes and the depth test fails.
    pub depth_fail: StencilOp,
    /// Where both pass.
    pub pass: StencilOp,
}

impl StencilFace {
    const fn always(depth_fail: StencilOp, pass: StencilOp) -> Self {
        Self { compare: Compare::Always, fail: StencilOp::Keep, depth_fail, pass }
    }

    /// Counts within the light's bounds only, where they are marked.
    const fn count(budget: BitBudget, depth_fail: StencilOp, pass: StencilOp) -> Self {
        let compare = if budget.bounded { Compare::Equal } else { Compare::Always };
        Self { compare, fail: StencilOp::Keep, depth_fail, pass }
    }

    const fn test(compare: Compare) -> Self {
        Self { compare, fail: StencilOp::Keep, depth_fail: StencilOp::Keep, pass: StencilOp::Keep }
    }
}

/// Test and operations of both sides, and the bits they see and touch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
pub struct StencilState {
    /// Triangles seen from the front.
    pub front: StencilFace,
    /// Triangles seen from behind.
    pub back: StencilFace,
    /// Bits the comparison sees.
    pub read_mask: u8,
    /// Bits the operations change.
    pub write_mask: u8,
}

use StencilOp::{DecrementWrap, IncrementWrap, Keep};

impl StencilState {
    /// The stencil has no say and stays as it is.
    pub const IGNORE: Self =
        Self { front: StencilFace::test(Compare::Always), back: StencilFace::test(Compare::Always), read_mask: 0, write_mask: 0 };

    /// Z-pass (Heidmann 1991; L): entering a volume before the surface counts up, leaving it down.
    #[must_use]
    pub const fn count_z_pass(budget: BitBudget) -> Self {
        Self {
            front: StencilFace::count(budget, Keep, IncrementWrap),
            back: StencilFace::count(budget, Keep, DecrementWrap),
            read_mask: budget.asked(budget.count_mask),
            write_mask: budget.count_mask,
        }
    }

    /// Z-pass for triangles whose order of vertices was turned round: the operations are swapped instead.
    #[must_use]
    pub const fn count_z_pass_turned(budget: BitBudget) -> Self {
        let straight = Self::count_z_pass(budget);
        Self { front: straight.back, back: straight.front, ..straight }
    }

    /// Z-fail (Carmack 2000; M section 3): from infinity to the surface, behind it.
    #[must_use]
    pub const fn count_z_fail(budget: BitBudget) -> Self {
        Self {
            front: StencilFace::count(budget, DecrementWrap, Keep),
            back: StencilFace::count(budget, IncrementWrap, Keep),
            read_mask: budget.asked(budget.count_mask),
            write_mask: budget.count_mask,
        }
    }

    /// Z-fail for light-cap triangles that were turned to face the light. They are drawn in the
    /// surface's own vertex order, so that their depth is the surface's to the last bit, and the
    /// operations are swapped instead.
    #[must_use]
    pub const fn count_z_fail_turned(budget: BitBudget) -> Self {
        let straight = Self::count_z_fail(budget);
        Self { front: straight.back, back: straight.front, ..straight }
    }

    /// What hardware without two-sided stencil has: one set of operations for both faces, so that
    /// one of them must be culled (K 6.3, L, C). One more behind the surface: for back faces.
    #[must_use]
    pub const fn raise_behind(budget: BitBudget) -> Self {
        Self::one_sided(budget, budget.count_mask, StencilFace::count(budget, IncrementWrap, Keep))
    }

    /// The other half of [`Self::raise_behind`]: one less behind the surface, for front faces.
    #[must_use]
    pub const fn lower_behind(budget: BitBudget) -> Self {
        Self::one_sided(budget, budget.count_mask, StencilFace::count(budget, DecrementWrap, Keep))
    }

    /// As [`Self::raise_behind`], but clamped, as before wrapping operations were common (B).
    #[must_use]
    pub const fn raise_behind_clamped(budget: BitBudget) -> Self {
        Self::one_sided(budget, budget.count_mask, StencilFace::count(budget, StencilOp::IncrementClamp, Keep))
    }

    /// As [`Self::lower_behind`], but clamped (B).
    #[must_use]
    pub const fn lower_behind_clamped(budget: BitBudget) -> Self {
        Self::one_sided(budget, budget.count_mask, StencilFace::count(budget, StencilOp::DecrementClamp, Keep))
    }

    /// Passes where the count is not the reference, and makes it the reference everywhere (B's dark quad).
    #[must_use]
    pub const fn reset_where_counted(budget: BitBudget) -> Self {
        let face = StencilFace {
            compare: Compare::NotEqual,
            fail: StencilOp::Replace,
            depth_fail: StencilOp::Replace,
            pass: StencilOp::Replace,
        };
        Self { front: face, back: face, read_mask: budget.count_mask, write_mask: budget.count_mask }
    }

    /// Parity (K 6.1): every face before the surface turns the lowest bit over, whichever way it looks.
    #[must_use]
    pub const fn invert_z_pass(budget: BitBudget) -> Self {
        Self::one_sided(budget, budget.count_mask & 1, StencilFace::count(budget, Keep, StencilOp::Invert))
    }

    const fn one_sided(budget: BitBudget, write_mask: u8, face: StencilFace) -> Self {
        Self { front: face, back: face, read_mask: budget.asked(write_mask), write_mask }
    }

    /// A convex solid about what the light reaches, in one draw of both its sides: the pixel's surface
    /// lies within where one face is behind it, beyond where it is none or two. Every face behind it turns
    /// the bit over.
    #[must_use]
    pub const fn mark_bounds(budget: BitBudget) -> Self {
        let face = StencilFace::always(StencilOp::Invert, Keep);
        Self { front: face, back: face, read_mask: 0, write_mask: budget.beyond_mask }
    }

    /// Passes within the light's bounds, where they are marked, and changes nothing.
    #[must_use]
    pub const fn within_bounds(budget: BitBudget) -> Self {
        if !budget.bounded {
            return Self::IGNORE;
        }
        let face = StencilFace::test(Compare::Equal);
        Self { front: face, back: face, read_mask: budget.beyond_mask, write_mask: 0 }
    }

    /// Between two batches, full screen: a count that is not zero becomes zero and leaves the verdict
    /// bit behind. The reference is the verdict bit: none of the field's, so that it compares as
    /// zero, and the very value to store.
    #[must_use]
    pub const fn collapse(budget: BitBudget) -> Self {
        let face = StencilFace { pass: StencilOp::Replace, ..StencilFace::test(Compare::NotEqual) };
        Self { front: face, back: face, read_mask: budget.count_mask, write_mask: budget.count_mask | budget.verdict_mask }
    }

    /// The field becomes the reference, whatever it was; the verdict bit stays.
    #[must_use]
    pub const fn set_count(budget: BitBudget) -> Self {
        Self::replace(budget.count_mask)
    }

    /// The verdict bit becomes the reference's, whatever it was.
    #[must_use]
    pub const fn set_verdict(budget: BitBudget) -> Self {
        Self::replace(budget.verdict_mask)
    }

    /// The same faces by the same tests, but each that counts turns `bit` over instead: the lowest bit of what
    /// would be counted.
    #[must_use]
    pub fn turning_over(self, bit: u8) -> Self {
        if !self.writes_anything() {
            return self;
        }
        let turns = |op: StencilOp| if op == Keep { Keep } else { StencilOp::Invert };
        let face = |face: StencilFace| StencilFace {
            fail: turns(face.fail),
            depth_fail: turns(face.depth_fail),
            pass: turns(face.pass),
            ..face
        };
        Self { front: face(self.front), back: face(self.back), write_mask: bit, ..self }
    }

    /// Passes where the light shines, and marks the pixel as shadowed: a second surface in the same place
    /// does not take the light again (K 6.4).
    #[must_use]
    pub const fn light_once(budget: BitBudget) -> Self {
        let face = StencilFace { pass: StencilOp::Invert, ..StencilFace::test(Compare::Equal) };
        let bit = if budget.is_points() { budget.verdict_mask } else { budget.count_mask & 1 };
        Self { front: face, back: face, read_mask: budget.shadow_mask(), write_mask: bit }
    }

    /// What has a halo: its pixels get the tag, which the reference is.
    #[must_use]
    pub const fn tag_halo(budget: BitBudget) -> Self {
        Self { read_mask: 0, ..Self::replace(budget.halo_tag()) }
    }

    /// A halo: passes where nothing is tagged and nothing glows yet, and counts that the pixel glows.
    #[must_use]
    pub const fn glow_once(budget: BitBudget) -> Self {
        let face = StencilFace { pass: IncrementWrap, ..StencilFace::test(Compare::Equal) };
        Self { front: face, back: face, read_mask: budget.halo_mask, write_mask: budget.halo_mask & !budget.halo_tag() }
    }

    /// One bit of the field becomes the reference's, whatever it was.
    #[must_use]
    pub const fn set_bit(budget: BitBudget, bit: u32) -> Self {
        Self::replace(budget.count_mask & (1 << bit))
    }

    /// Sets some bits to the reference's, whatever is there: a pattern's.
    #[must_use]
    pub const fn mark(mask: u8) -> Self {
        Self::replace(mask)
    }

    /// Passes where none of some bits is set, and changes nothing.
    #[must_use]
    pub const fn unmarked(mask: u8) -> Self {
        let face = StencilFace::test(Compare::Equal);
        Self { front: face, back: face, read_mask: mask, write_mask: 0 }
    }

    const fn replace(mask: u8) -> Self {
        let face = StencilFace::always(Keep, StencilOp::Replace);
        Self { front: face, back: face, read_mask: mask, write_mask: mask }
    }

    /// Passes where the count equals the reference, with no verdict beside it, and changes nothing.
    #[must_use]
    pub const fn count_equals(budget: BitBudget) -> Self {
        Self::compare_count(budget, Compare::Equal)
    }

    /// Passes where the count differs from the reference, and changes nothing.
    #[must_use]
    pub const fn count_differs(budget: BitBudget) -> Self {
        Self::compare_count(budget, Compare::NotEqual)
    }

    const fn compare_count(budget: BitBudget, compare: Compare) -> Self {
        let face = StencilFace::test(compare);
        Self { front: face, back: face, read_mask: budget.shadow_mask(), write_mask: 0 }
    }

    /// The ground of decals where it is seen gets the bit, which the reference is.
    #[must_use]
    pub const fn mark_ground(budget: BitBudget) -> Self {
        Self { read_mask: 0, ..Self::replace(budget.decal_mask) }
    }

    /// A decal on marked ground: passes where the bit is the reference's, and takes it away.
    #[must_use]
    pub const fn claim_ground(budget: BitBudget) -> Self {
        let face = StencilFace { pass: StencilOp::Invert, ..StencilFace::test(Compare::Equal) };
        Self { front: face, back: face, read_mask: budget.decal_mask, write_mask: budget.decal_mask }
    }

    /// Ground that no decal has claimed is as any other: the bit becomes the reference's, none.
    #[must_use]
    pub const fn unmark_ground(budget: BitBudget) -> Self {
        Self { read_mask: 0, ..Self::replace(budget.decal_mask) }
    }

    /// As the playground has it: any state at all, in a frame whose stencil belongs to nobody else.
    #[must_use]
    pub const fn played(front: StencilFace, back: StencilFace, read_mask: u8, write_mask: u8) -> Self {
        Self { front, back, read_mask, write_mask }
    }

    /// Depth complexity (K section 7): every fragment that updates its pixel counts, or where `hidden` every fragment. It
    /// is clamped, which keeps a full byte from coming round to zero; so the field must be all of it.
    #[must_use]
    pub const fn count_fragments(budget: BitBudget, hidden: bool) -> Self {
        let more = StencilOp::IncrementClamp;
        let face = StencilFace::always(if hidden { more } else { Keep }, more);
        Self { front: face, back: face, read_mask: budget.count_mask, write_mask: budget.count_mask }
    }

    /// Passes where the count is the reference or more, and changes nothing.
    #[must_use]
    pub const fn count_at_least(budget: BitBudget) -> Self {
        Self::compare_count(budget, Compare::LessEqual)
    }

    /// Whether any operation changes stored bits.
    #[must_use]
    pub fn writes(&self) -> bool {
        self.write_mask != 0 && self.writes_anything()
    }

    fn writes_anything(&self) -> bool {
        let face = |f: &StencilFace| f.fail != Keep || f.depth_fail != Keep || f.pass != Keep;
        face(&self.front) || face(&self.back)
    }

    /// Whether the stored bits decide anything.
    #[must_use]
    pub fn tests(&self) -> bool {
        self.front.compare != Compare::Always || self.back.compare != Compare::Always
    }

    /// The same in one view only: where the mirror bits are those of the reference. What asks for a count that
    /// differs cannot ask for more; it must be harmless elsewhere.
    #[must_use]
    pub fn in_view(self, budget: BitBudget) -> Self {
        let asks = |face: StencilFace| StencilFace {
            compare: if face.compare == Compare::Always { Compare::Equal } else { face.compare },
            ..face
        };
        let faces = [self.front, self.back];
        if faces.iter().any(|face| !matches!(face.compare, Compare::Always | Compare::Equal)) {
            return self;
        }
        let asked = if self.tests() { self.read_mask } else { 0 };
        Self { front: asks(self.front), back: asks(self.back), read_mask: asked | budget.mirror_mask, ..self }
    }

    /// A mirror's surface, from its pixels in one view to those of the view through it, or back: passes where the
    /// mirror bits are the reference and turns over those in which `other` differs.
    #[must_use]
    pub const fn through_mirror(budget: BitBudget, reference: u8, other: u8) -> Self {
        let face = StencilFace { pass: StencilOp::Invert, ..StencilFace::test(Compare::Equal) };
        Self { front: face, back: face, read_mask: budget.mirror_mask, write_mask: reference ^ other }
    }

    /// All bits but the mirrors' become the reference's, whatever they were.
    #[must_use]
    pub const fn set_all(budget: BitBudget) -> Self {
        Self::replace(!budget.mirror_mask)
    }

    /// The state in words, for the panel and plan snapshots.
    #[must_use]
    pub fn words(&self, budget: BitBudget) -> String {
        if !self.tests() && !self.writes() {
            return "ignored".into();
        }
        let face = |f: &StencilFace| {
            let test = match f.compare {
                Compare::Always => String::new(),
                Compare::Equal if self.read_mask != 0 && self.read_mask & !budget.mirror_mask == 0 => "in its view ".into(),
                Compare::Equal if self.read_mask & !budget.mirror_mask == budget.beyond_mask && budget.beyond_mask != 0 => {
                    "within the bounds ".into()
                }
                Compare::Equal if budget.receiver_mask != 0 && self.read_mask & budget.receiver_mask == budget.receiver_mask => {
                    "passes where the reference is the value ".into()
                }
                Compare::Equal if f.pass == IncrementWrap => "where nothing is tagged or glows ".into(),
                other => format!("passes where the reference is {} ", compare_words(other)),
            };
            let ops: Vec<_> = [("fail", f.fail), ("depth fail", f.depth_fail), ("pass", f.pass)]
                .into_iter()
                .filter(|(_, op)| *op != Keep)
                .map(|(when, op)| format!("{when}: {}", op_words(op)))
                .collect();
            format!("{test}{}", ops.join(", ")).trim().to_owned()
        };
        let (front, back) = (face(&self.front), face(&self.back));
        let masks = format!("read {:08b} write {:08b}", self.read_mask, self.write_mask);
        if front == back { format!("{front} ({masks})") } else { format!("front {front}; back {back} ({masks})") }
    }
}

fn compare_words(compare: Compare) -> &'static str {
    match compare {
        Compare::Never => "never",
        Compare::Always => "anything",
        Compare::Equal => "the count",
        Compare::NotEqual => "not the count",
        Compare::Less => "below the count",
        Compare::LessEqual => "the count or below",
        Compare::Greater => "above the count",
        Compare::GreaterEqual => "the count or above",
    }
}

fn op_words(op: StencilOp) -> &'static str {
    match op {
        Keep => "keep",
        IncrementWrap => "+1",
        DecrementWrap => "-1",
        StencilOp::IncrementClamp => "+1 up to 255",
        StencilOp::DecrementClamp => "-1 down to 0",
        StencilOp::Zero => "0",
        StencilOp::Replace => "the reference",
        StencilOp::Invert => "inverted",
    }
}
