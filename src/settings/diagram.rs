//! What is drawn into the scene seen from the side.

use serde::{Deserialize, Serialize};

/// What `show rays` draws in.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Diagram {
    /// Some of the eye's rays, with the count along each (K figures 10 and 13).
    #[default]
    Rays,
    /// The volumes cut open, and what is lit and what is not of all that they meet (K figure 8, B's second).
    Slice,
    /// One ray from end to end: what is counted in front of the surface, and what behind it (M figure 1).
    Ends,
    /// The occlusion pyramid between light and viewport, and each caster's case (M figures 2 and 4).
    Pyramid,
    /// Where back faces alone would have been counted behind the surface (B's third).
    BackFaces,
    /// Where front faces were counted off again (B's fourth).
    BothFaces,
    /// A caster seen from the light, and the fan that its dark cap is made of (M figure 3).
    Fan,
    /// The corners of a caster's polygon in their order (B's first).
    Order,
    /// Rays that mirrors turn back, and rays that lead past them (K figure 2).
    Mirrors,
}

impl Diagram {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 9] = [
        Self::Rays,
        Self::Slice,
        Self::Ends,
        Self::Pyramid,
        Self::BackFaces,
        Self::BothFaces,
        Self::Fan,
        Self::Order,
        Self::Mirrors,
    ];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rays => "rays",
            Self::Slice => "slice",
            Self::Ends => "ends",
            Self::Pyramid => "pyramid",
            Self::BackFaces => "back-faces",
            Self::BothFaces => "both-faces",
            Self::Fan => "fan",
            Self::Order => "order",
            Self::Mirrors => "mirrors",
        }
    }

    /// One sentence for help and panel.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Rays => "some of the eye's rays, with one light's count along each",
            Self::Slice => "the light's volumes cut open, and what they leave lit of all that they meet",
            Self::Ends => "one ray from end to end: what z-pass counts before the surface, and z-fail behind it",
            Self::Pyramid => "the occlusion pyramid from the light to the viewport, and each caster's case",
            Self::BackFaces => "where surfaces would be counted up when back faces alone are drawn, by z-fail",
            Self::BothFaces => "what is left of that when front faces have counted down",
            Self::Fan => {
                "the caster nearest to the middle, seen from the light: its silhouette, and the fan that closes its dark cap"
            }
            Self::Order => "the polygon in the middle, its corners numbered in their order",
            Self::Mirrors => "rays that mirrors turn back, and those that lead past them",
        }
    }

    /// Whether the scene is seen from the side, cut along the plane that the eye looks in.
    #[must_use]
    pub const fn from_the_side(self) -> bool {
        !matches!(self, Self::Fan | Self::Order)
    }
}
