//! Two solids put together.

use serde::{Deserialize, Serialize};

/// Constructive solid geometry (K section 7, figure 19): which two objects, and what becomes of them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Csg {
    /// What becomes of them; what the scene means, if nobody says.
    pub operation: Option<Operation>,
    /// The node that shows A, instead of the scene's.
    pub a: Option<usize>,
    /// The node that shows B.
    pub b: Option<usize>,
}

impl Csg {
    /// The same without what speaks of one scene's nodes.
    #[must_use]
    pub fn of_another_scene(self) -> Self {
        Self::default()
    }
}

/// What becomes of two solids A and B.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Operation {
    /// Nothing: two objects as others.
    #[default]
    Off,
    /// A or B.
    Union,
    /// A and B.
    Intersection,
    /// A without B.
    AMinusB,
    /// B without A.
    BMinusA,
}

impl Operation {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 5] = [Self::Off, Self::Union, Self::Intersection, Self::AMinusB, Self::BMinusA];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Union => "union",
            Self::Intersection => "intersection",
            Self::AMinusB => "a-minus-b",
            Self::BMinusA => "b-minus-a",
        }
    }

    /// A few words for people.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Off => "apart",
            Self::Union => "A or B",
            Self::Intersection => "A and B",
            Self::AMinusB => "A minus B",
            Self::BMinusA => "B minus A",
        }
    }

    /// Whether a point is in the result, that lies in A or not, and in B or not.
    #[must_use]
    pub const fn holds(self, in_a: bool, in_b: bool) -> bool {
        match self {
            Self::Off => false,
            Self::Union => in_a || in_b,
            Self::Intersection => in_a && in_b,
            Self::AMinusB => in_a && !in_b,
            Self::BMinusA => in_b && !in_a,
        }
    }
}
