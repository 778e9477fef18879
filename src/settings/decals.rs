//! How coplanar geometry is drawn.

use serde::{Deserialize, Serialize};

/// What keeps decals, which lie in the very plane of what is under them, from fighting it for depth.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DecalMode {
    /// Nothing: depth decides, and its last bits are chance (K figure 18, left).
    ZFighting,
    /// Polygon offset: each layer is drawn nearer than it is.
    Offset,
    /// The stencil: drawn without depth where their ground is seen (K figure 18, right).
    #[default]
    Stencil,
}

impl DecalMode {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 3] = [Self::ZFighting, Self::Offset, Self::Stencil];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::ZFighting => "z-fighting",
            Self::Offset => "offset",
            Self::Stencil => "stencil",
        }
    }

    /// One sentence for help and panel.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::ZFighting => "depth decides between surfaces in one plane, and its last bits are chance",
            Self::Offset => "each layer of decals is drawn nearer than it is, by polygon offset",
            Self::Stencil => "decals are drawn without depth where the ground they lie on is seen, each pixel once",
        }
    }
}
