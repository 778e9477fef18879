//! Planar shadows: how they are drawn, and which surfaces take them.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::SurfacePlace;

/// Shadows projected onto flat surfaces (K sections 4, 5 and 6.3).
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Planar {
    /// How they are drawn. While they are, the technique counts nothing: other surfaces take no shadows.
    pub mode: PlanarMode,
    /// What of [`PlanarMode::Hybrid`] is drawn.
    pub hybrid: HybridPart,
    /// What was changed of the scene's receivers.
    #[serde(with = "super::mirrors::as_list")]
    pub edits: BTreeMap<SurfacePlace, bool>,
}

impl Planar {
    /// The same without what speaks of one scene's surfaces.
    #[must_use]
    pub fn of_another_scene(self) -> Self {
        Self { edits: BTreeMap::new(), ..self }
    }

    /// Whether every pixel of a receiver is lit or in shadow exactly where it should be.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        match self.mode {
            PlanarMode::Off | PlanarMode::Naive => false,
            PlanarMode::StencilBlend | PlanarMode::StencilRelight | PlanarMode::Multi => true,
            PlanarMode::Hybrid => self.hybrid == HybridPart::Both,
        }
    }
}

/// How planar shadows are drawn.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PlanarMode {
    /// Not at all.
    #[default]
    Off,
    /// Blended over whatever is there, lifted by polygon offset.
    Naive,
    /// The same on receivers alone, each pixel once, however many lights are blocked there.
    StencilBlend,
    /// Shadowed pixels of receivers drawn anew, without the light that is blocked.
    StencilRelight,
    /// Every light added to every receiver where it is not blocked.
    Multi,
    /// Shadow volumes for flat casters, planar shadows for the rest.
    Hybrid,
}

impl PlanarMode {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 6] = [Self::Off, Self::Naive, Self::StencilBlend, Self::StencilRelight, Self::Multi, Self::Hybrid];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Naive => "naive",
            Self::StencilBlend => "stencil-blend",
            Self::StencilRelight => "stencil-relight",
            Self::Multi => "multi",
            Self::Hybrid => "hybrid",
        }
    }

    /// One sentence for help and panel.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Off => "no planar shadows: the technique counts shadow volumes",
            Self::Naive => {
                "projected casters blended over the picture: dark patches, and shadows in mid-air (Kilgard 4, figures 6 and 7)"
            }
            Self::StencilBlend => {
                "kept to the receivers by the stencil, and each pixel darkened once, by however many lights (Kilgard 5, figure 7)"
            }
            Self::StencilRelight => "shadowed pixels of receivers drawn anew without the blocked light (Kilgard 5)",
            Self::Multi => {
                "several receivers, several lights: each light added where it is not blocked, increment and decrement in turn (Kilgard 5)"
            }
            Self::Hybrid => "shadow volumes for cut-outs, planar shadows for all other casters (Kilgard 6.3, figure 14)",
        }
    }
}

/// What of the hybrid is drawn (K figure 14 has all three).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum HybridPart {
    /// Volumes and planar shadows.
    #[default]
    Both,
    /// The cut-outs' volumes alone.
    Volumes,
    /// The others' planar shadows alone.
    Planar,
}

impl HybridPart {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 3] = [Self::Both, Self::Volumes, Self::Planar];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Both => "both",
            Self::Volumes => "volumes",
            Self::Planar => "planar",
        }
    }

    /// One sentence for help and panel.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Both => "cut-outs' volumes and the others' planar shadows",
            Self::Volumes => "cut-outs' volumes alone: nothing else casts a shadow",
            Self::Planar => "planar shadows alone: cut-outs cast none",
        }
    }

    /// Whether cut-outs' volumes are counted.
    #[must_use]
    pub const fn has_volumes(self) -> bool {
        !matches!(self, Self::Planar)
    }

    /// Whether the others' planar shadows are drawn.
    #[must_use]
    pub const fn has_planar(self) -> bool {
        !matches!(self, Self::Volumes)
    }
}
