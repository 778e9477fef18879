//! What glows, and how.

use std::collections::BTreeMap;

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Halos about objects (K section 7, figure 17).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Halos {
    /// Which of the scene's nodes have one, with all that hangs on them, where that is not as the scene has it.
    pub edits: BTreeMap<usize, bool>,
    /// Linear RGB, 0 to 1.
    pub color: Vec3,
    /// How far it reaches, percent of the picture's height: 0 to [`MAX_HALO_WIDTH`].
    pub width: f32,
}

/// The widest halo, percent of the picture's height.
pub const MAX_HALO_WIDTH: f32 = 25.0;

impl Default for Halos {
    fn default() -> Self {
        Self { edits: BTreeMap::new(), color: Vec3::new(1.0, 0.62, 0.12), width: 5.0 }
    }
}

impl Halos {
    /// The same without what speaks of one scene's nodes.
    #[must_use]
    pub fn of_another_scene(self) -> Self {
        Self { edits: BTreeMap::new(), ..self }
    }
}
