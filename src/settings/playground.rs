//! The playground: shapes drawn one after another into the stencil, and the whole state that each is drawn with.
//!
//! Everything is named as the frame's own states are ([`Compare`], [`StencilOp`]). Depth is as most programs have it: 0 is
//! near, 1 far. Boards are written as JSON; what is left out is at its initial value (K section 1, table 2).

use serde::{Deserialize, Serialize};

use super::boards;
use crate::frame::state::Compare;
use crate::frame::stencil::StencilOp;

/// What is played with, and how it is shown.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Playground {
    /// The shapes.
    pub board: Board,
    /// The stencil's values are written over the picture, in a grid.
    pub numbers: bool,
}

/// Shapes on a cleared stencil.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Board {
    /// What the stencil is cleared to.
    #[serde(default)]
    pub clear: u8,
    /// What depth is cleared to, 0 to 1.
    #[serde(default = "far")]
    pub clear_depth: f32,
    /// In the order they are drawn in; at most [`MOST_SHAPES`].
    pub shapes: Vec<Shape>,
}

const fn far() -> f32 {
    1.0
}

/// Shapes on one board.
pub const MOST_SHAPES: usize = 64;
/// Letters of a shape's name.
pub const LONGEST_NAME: usize = 40;

impl Default for Board {
    fn default() -> Self {
        boards::table_2()
    }
}

/// One shape, and the state it is drawn with.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Shape {
    /// What it is called; its kind where that is empty.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Its outline.
    pub kind: ShapeKind,
    /// Its middle: shares of the picture's width and height, from the upper left.
    pub at: [f32; 2],
    /// Its width and height: shares of the picture's height.
    pub size: [f32; 2],
    /// Turned counter-clockwise, degrees.
    pub turn: f32,
    /// 0 is near, 1 far.
    pub depth: f32,
    /// Which side is seen.
    pub facing: Facing,
    /// Its depth against what is there.
    pub depth_compare: Compare,
    /// Whether its depth stays where it passes.
    pub depth_write: bool,
    /// The stencil's state for triangles seen from the front.
    pub front: Face,
    /// For those seen from behind, where that is another.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub back: Option<Face>,
}

impl Default for Shape {
    fn default() -> Self {
        Self {
            name: String::new(),
            kind: ShapeKind::default(),
            at: [0.5; 2],
            size: [0.5; 2],
            turn: 0.0,
            depth: 0.5,
            facing: Facing::default(),
            depth_compare: Compare::Always,
            depth_write: false,
            front: Face::default(),
            back: None,
        }
    }
}

impl Shape {
    /// The state for triangles seen from behind.
    #[must_use]
    pub fn back(&self) -> Face {
        self.back.unwrap_or(self.front)
    }

    /// What it is called.
    #[must_use]
    pub fn title(&self) -> &str {
        if self.name.is_empty() { self.kind.name() } else { &self.name }
    }
}

/// The stencil's state for one side of triangles; its default is what OpenGL starts with (K table 2).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Face {
    /// `reference & read_mask` against `stored & read_mask`.
    pub compare: Compare,
    /// What is compared, and what Replace stores.
    pub reference: u8,
    /// Bits that the comparison sees.
    pub read_mask: u8,
    /// Bits that the operations change.
    pub write_mask: u8,
    /// Where the stencil test fails.
    pub fail: StencilOp,
    /// Where it passes and the depth test fails.
    pub depth_fail: StencilOp,
    /// Where both pass.
    pub pass: StencilOp,
}

impl Default for Face {
    fn default() -> Self {
        Self {
            compare: Compare::Always,
            reference: 0,
            read_mask: u8::MAX,
            write_mask: u8::MAX,
            fail: StencilOp::Keep,
            depth_fail: StencilOp::Keep,
            pass: StencilOp::Keep,
        }
    }
}

/// A shape's outline.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ShapeKind {
    /// Its tip at the top.
    Triangle,
    /// An ellipse.
    Disc,
    /// Of five points.
    Star,
    /// A rectangle.
    #[default]
    Quad,
    /// Two triangles that meet in the middle: the left one shows the side that is said, the right one the other.
    Bow,
}

impl ShapeKind {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 5] = [Self::Triangle, Self::Disc, Self::Star, Self::Quad, Self::Bow];

    /// The name in files and for people.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Triangle => "triangle",
            Self::Disc => "disc",
            Self::Star => "star",
            Self::Quad => "quad",
            Self::Bow => "bow",
        }
    }
}

/// Which side of a shape is seen.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Facing {
    /// Its triangles turn counter-clockwise on screen.
    #[default]
    Front,
    /// They turn clockwise.
    Back,
}

/// Whose calls set a state.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum Api {
    /// wgpu, Rust.
    #[default]
    Wgpu,
    /// Vulkan, C.
    Vulkan,
    /// Direct3D 12, C++.
    D3d12,
    /// OpenGL, C.
    OpenGl,
}

impl Api {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 4] = [Self::Wgpu, Self::Vulkan, Self::D3d12, Self::OpenGl];

    /// The name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Wgpu => "wgpu",
            Self::Vulkan => "vulkan",
            Self::D3d12 => "d3d12",
            Self::OpenGl => "opengl",
        }
    }

    /// As its makers write it.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Wgpu => "wgpu",
            Self::Vulkan => "Vulkan",
            Self::D3d12 => "Direct3D 12",
            Self::OpenGl => "OpenGL",
        }
    }
}
