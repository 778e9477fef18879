//! Depth, blend, cull and colour-write state, each with a name and the reason for it.
//!
//! Plain values without wgpu, so that a plan can be printed, compared and tested without a GPU.
//! Depth is reverse-Z (DESIGN section 3): 1 at the near plane, 0 at infinity, so `Greater` means
//! *nearer than what is there*.

use serde::{Deserialize, Serialize};

use super::stencil::StencilState;

/// A comparison, as WebGPU names them; `incoming OP stored`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Compare {
    /// Fails always.
    Never,
    /// Passes always.
    Always,
    /// Passes where both are the same.
    Equal,
    /// Passes where they differ.
    NotEqual,
    /// Passes where the incoming value is less: farther, for depth.
    Less,
    /// Passes where the incoming value is less or the same.
    LessEqual,
    /// Passes where the incoming value is greater: nearer, for depth.
    Greater,
    /// Passes where the incoming value is greater or the same.
    GreaterEqual,
}

impl Compare {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 8] =
        [Self::Never, Self::Less, Self::LessEqual, Self::Equal, Self::GreaterEqual, Self::Greater, Self::NotEqual, Self::Always];

    /// The name in files and for people.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Never => "never",
            Self::Less => "less",
            Self::LessEqual => "less-equal",
            Self::Equal => "equal",
            Self::GreaterEqual => "greater-equal",
            Self::Greater => "greater",
            Self::NotEqual => "not-equal",
            Self::Always => "always",
        }
    }
}

/// How depth is tested and written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
pub struct Depth {
    /// Incoming against stored.
    pub compare: Compare,
    /// Whether passing fragments replace the stored depth.
    pub write: bool,
    /// What is added to a fragment's depth before it is compared.
    pub bias: DepthBias,
}

/// Polygon offset. In reverse-Z what is added brings nearer, what is taken away pushes back.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize)]
pub struct DepthBias {
    /// In the least steps that the depth format tells apart (OpenGL's `units`).
    pub constant: i32,
    /// Times the triangle's steepest slope in depth (OpenGL's `factor`).
    pub slope: i32,
}

impl DepthBias {
    /// Depth as it is.
    pub const NONE: Self = Self { constant: 0, slope: 0 };
}

impl Depth {
    /// The first pass over opaque surfaces: the nearest wins and stays.
    pub const LAY: Self = Self::plain(Compare::Greater, true);
    /// The same; of surfaces in one place the last stays, as where they are drawn again over their depth.
    pub const LAY_LAST: Self = Self::plain(Compare::GreaterEqual, true);
    /// Surfaces drawn again: only the very fragments that laid the depth pass.
    pub const SAME_SURFACE: Self = Self::plain(Compare::Equal, false);
    /// Shadow volumes and other things that must be nearer than the surface, and leave it alone.
    pub const NEARER: Self = Self::plain(Compare::Greater, false);
    /// Lines that lie on the surface.
    pub const ON_OR_NEARER: Self = Self::plain(Compare::GreaterEqual, false);
    /// Light caps whose own surface is surely in the depth buffer: they can never be nearer, so the
    /// test that would decide by equality is not asked (DESIGN section 4).
    pub const NEVER: Self = Self::plain(Compare::Never, false);
    /// Light caps whose triangles were cut, compared with a surface that was not: the same plane, but rounded otherwise.
    /// Pushed back by a few steps they lie behind it, as they would if nothing were rounded.
    pub const NEARER_CUT: Self = Self::NEARER.with_bias(DepthBias { constant: -8, slope: 0 });
    /// What is counted by colour instead of stencil, behind the surface: all that [`Self::NEARER`]
    /// refuses.
    pub const NOT_NEARER: Self = Self::plain(Compare::LessEqual, false);
    /// What takes the place of whatever is there: a mirror's pixels before and after its reflection.
    pub const OVERWRITE: Self = Self::plain(Compare::Always, true);
    /// Full-screen steps, which lie at infinity, where there is a surface.
    pub const ANY_SURFACE: Self = Self::plain(Compare::Less, false);
    /// Full-screen steps, and whatever counts everywhere: depth has no say.
    pub const IGNORE: Self = Self::plain(Compare::Always, false);

    const fn plain(compare: Compare, write: bool) -> Self {
        Self { compare, write, bias: DepthBias::NONE }
    }

    /// The same, pushed back or brought nearer.
    #[must_use]
    pub const fn with_bias(self, bias: DepthBias) -> Self {
        Self { bias, ..self }
    }
}

/// How a fragment's colour meets what is there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Blend {
    /// Takes its place.
    Replace,
    /// Is added: one light after the other.
    Add,
    /// Covers it by alpha, premultiplied.
    Over,
    /// Fills what its alpha leaves, premultiplied.
    Under,
    /// Multiplies it: a texture over the light that falls on it.
    Multiply,
}

/// Which side of a triangle is left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Cull {
    /// Both sides are drawn.
    None,
    /// What is seen from behind is left out.
    Back,
    /// What is seen from the front is left out.
    Front,
}

/// Which winding is the front on screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Winding {
    /// Counter-clockwise, as glTF has it.
    Ccw,
    /// Clockwise: an odd number of reflections in the instance's transform and the view's.
    Cw,
}

impl Winding {
    /// The front's winding after one more map with a determinant of this sign.
    #[must_use]
    pub fn through(self, determinant: f64) -> Self {
        match (determinant < 0.0, self) {
            (false, winding) => winding,
            (true, Self::Ccw) => Self::Cw,
            (true, Self::Cw) => Self::Ccw,
        }
    }
}

/// What happens to triangles before the near plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum NearPlane {
    /// They are cut off.
    Clip,
    /// They stay, their depth clamped (`unclipped_depth`).
    Clamp,
}

/// The whole fixed state of one step; nothing is inherited from the step before.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
pub struct State {
    /// Depth test and write.
    pub depth: Depth,
    /// Stencil test and operations of both faces.
    pub stencil: StencilState,
    /// How colour is combined; `None` writes no colour.
    pub color: Option<Blend>,
    /// Which side is left out.
    pub cull: Cull,
    /// Which winding is the front.
    pub winding: Winding,
    /// What the near plane does.
    pub near_plane: NearPlane,
}

impl State {
    /// What covers the picture, by itself: drawn whole, whatever depth and stencil hold, writing neither, nor
    /// colour.
    pub const FLAT: Self = Self {
        depth: Depth::IGNORE,
        stencil: StencilState::IGNORE,
        color: None,
        cull: Cull::None,
        winding: Winding::Ccw,
        near_plane: NearPlane::Clip,
    };
}
