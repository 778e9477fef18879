//! Which fragments depth complexity counts.

use serde::{Deserialize, Serialize};

/// What `show complexity` counts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Complexity {
    /// How often a pixel is updated, in the order in which surfaces are drawn (K section 7).
    #[default]
    Updates,
    /// How many fragments fall on a pixel, hidden ones among them.
    Fragments,
}

impl Complexity {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 2] = [Self::Updates, Self::Fragments];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Updates => "updates",
            Self::Fragments => "fragments",
        }
    }

    /// One sentence for help and panel.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Updates => "how often each pixel is updated, in the order in which surfaces are drawn",
            Self::Fragments => "how many fragments fall on each pixel, those that depth hides among them",
        }
    }
}
