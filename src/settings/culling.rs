//! What is left out of counting shadows, and how.

use serde::{Deserialize, Serialize};

/// What is left out of counting shadows because it cannot matter ([`crate::techniques::culling`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Culling {
    /// Volumes whose shadow meets nothing that is lit and in view, and caps that are out of view.
    pub on: bool,
    /// What bounds the pixels that a light can reach.
    pub light_bounds: LightBounds,
    /// Each volume is counted in a step of its own, behind a scissor of its own; else those that are
    /// counted alike share both.
    pub caster_scissors: bool,
    /// Counts only where the surface lies within the light's bounds ([`crate::techniques::depth_bounds`]).
    pub depth_bounds: bool,
    /// Exact forms count a volume only in those cells of the picture where its shadow may fall
    /// ([`crate::techniques::windows`]).
    pub footprints: bool,
    /// Exact forms count only the pieces of a volume about what can receive its shadow ([`crate::geometry::clamping`]).
    pub clamping: bool,
}

impl Default for Culling {
    fn default() -> Self {
        Self {
            on: true,
            light_bounds: LightBounds::default(),
            caster_scissors: false,
            depth_bounds: false,
            footprints: true,
            clamping: true,
        }
    }
}

/// What bounds the pixels that a light can reach: clipped at the near plane and projected, it is the
/// light's scissor.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LightBounds {
    /// Nothing: every pixel.
    None,
    /// The box about its range (M).
    Box,
    /// The ball of its range (L).
    Sphere,
    /// The cone of a spot, as far as its range; nothing for other lights.
    Cone,
    /// All of them.
    #[default]
    Tight,
}

impl LightBounds {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 5] = [Self::None, Self::Box, Self::Sphere, Self::Cone, Self::Tight];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Box => "box",
            Self::Sphere => "sphere",
            Self::Cone => "cone",
            Self::Tight => "tight",
        }
    }

    /// One sentence for help and panel.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::None => "every pixel is counted and lit",
            Self::Box => "the box about the light's range, clipped and projected (McGuire)",
            Self::Sphere => "the ball of the light's range, by the planes that touch it (Lengyel)",
            Self::Cone => "the cone of a spot, as far as its range; other lights have none",
            Self::Tight => "ball, box and the cone of a spot, whichever is smaller",
        }
    }

    /// Whether the box about the range is among them.
    #[must_use]
    pub const fn has_box(self) -> bool {
        matches!(self, Self::Box | Self::Tight)
    }

    /// Whether the ball of the range is among them.
    #[must_use]
    pub const fn has_ball(self) -> bool {
        matches!(self, Self::Sphere | Self::Tight)
    }

    /// Whether a spot's cone is among them.
    #[must_use]
    pub const fn has_cone(self) -> bool {
        matches!(self, Self::Cone | Self::Tight)
    }
}
