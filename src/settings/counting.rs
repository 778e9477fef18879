//! How many bits shadows are counted in, and what happens where they are too few.

use serde::{Deserialize, Serialize};

/// What counts are held in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Counting {
    /// Bits of the stencil's count: 1 to [`MAX_COUNT_BITS`].
    pub bits: u32,
    /// What is done where more volumes can overlap than the bits can count.
    pub overflow: Overflow,
}

/// All the stencil has.
pub const MAX_COUNT_BITS: u32 = 8;

impl Default for Counting {
    fn default() -> Self {
        Self { bits: MAX_COUNT_BITS, overflow: Overflow::default() }
    }
}

/// What is done where more volumes can overlap than the stencil's bits can count.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Overflow {
    /// Exact techniques stay exact: casters are counted in batches, or in a wide target.
    #[default]
    Exact,
    /// Nothing: counts wrap, and a multiple of the field's size is taken for light.
    Naive,
}

impl Overflow {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 2] = [Self::Exact, Self::Naive];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Naive => "naive",
        }
    }

    /// One sentence for help and panel.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Exact => "where counts could pass the field, casters are counted in batches, or in a wide target",
            Self::Naive => "counts wrap: as many volumes as the field has values are taken for none",
        }
    }
}
