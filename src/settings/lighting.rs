//! What lights are made of, how their light is gathered, and what is written over the picture.

use serde::{Deserialize, Serialize};

/// How a frame's light comes together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Lighting {
    /// Points that each light with an extent is counted as in one frame (K 6.4): 1 to [`MAX_AREA_SAMPLES`].
    pub area_samples: u32,
    /// Where the points of one light keep their shadows until they shine.
    pub area_mode: AreaMode,
    /// Which of those points `stencil`, `shadow` and `volumes` look at, from 0.
    pub light_sample: u32,
    /// Frames whose mean is shown, each with other points of the area lights and, but for the first, a
    /// shift of less than half a pixel: 1 to [`MAX_FRAMES`]. The window gathers them while nothing moves.
    pub accumulate: u32,
    /// What lights are added into.
    pub accumulation: Accumulation,
    /// How often surfaces are textured.
    pub texturing: Texturing,
    /// Whether lights draw surfaces, or pixels.
    pub shading: Shading,
    /// Names of lights and of what casts shadows, at their places in the picture.
    pub labels: bool,
}

/// The most points one light is counted as in a frame: each has shadow volumes of its own.
pub const MAX_AREA_SAMPLES: u32 = 64;

/// The most frames whose mean is shown.
pub const MAX_FRAMES: u32 = 1024;

impl Default for Lighting {
    fn default() -> Self {
        Self {
            // As many as K's figure 15 has.
            area_samples: 8,
            area_mode: AreaMode::default(),
            light_sample: 0,
            accumulate: 1,
            accumulation: Accumulation::default(),
            texturing: Texturing::default(),
            shading: Shading::default(),
            labels: false,
        }
    }
}

/// Where the points of a light with a size keep their shadows until they shine.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AreaMode {
    /// One after the other in the whole stencil, as lights of their own.
    #[default]
    Points,
    /// Together, each in a bit of its own (K 6.4, [`crate::techniques::own_bits`]).
    Bits,
}

impl AreaMode {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 2] = [Self::Points, Self::Bits];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Points => "points",
            Self::Bits => "bits",
        }
    }

    /// One sentence for help and panel.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Points => "each point counts in the whole stencil and shines before the next",
            Self::Bits => "each point has a stencil bit of its own; all are counted, then all shine (Kilgard 6.4)",
        }
    }
}

/// What lights are added into, one after the other.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Accumulation {
    /// 16-bit floats: neither dim lights nor bright ones are lost.
    #[default]
    Float,
    /// 8 bits a channel, as in 2003 (M section 8): every light is rounded to a 255th of white before it is
    /// added, and sums end at white.
    EightBit,
}

impl Accumulation {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 2] = [Self::Float, Self::EightBit];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Float => "float",
            Self::EightBit => "8-bit",
        }
    }

    /// One sentence for help and panel.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Float => "lights are added in 16-bit floats: nothing is lost",
            Self::EightBit => "lights are added in 8 bits, as in 2003: gradients band, dim lights are lost, sums end at white",
        }
    }
}

/// How often surfaces are textured.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Texturing {
    /// With every light: highlights keep the light's colour.
    #[default]
    EachLight,
    /// Once, after all lights (M section 8): lights add untextured light, which the texture then multiplies.
    /// The same picture on matt surfaces; highlights are tinted by the texture.
    Once,
}

impl Texturing {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 2] = [Self::EachLight, Self::Once];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::EachLight => "each-light",
            Self::Once => "once",
        }
    }

    /// One sentence for help and panel.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::EachLight => "every light reads the texture of every surface it reaches",
            Self::Once => "the texture multiplies the sum of all lights: the same on matt surfaces, tinted highlights on others",
        }
    }
}

/// Whether lights draw the surfaces they shine on, or the pixels that show them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shading {
    /// The cheapest of the three, by how many triangles and lights there are.
    #[default]
    Auto,
    /// As the papers do: every light draws its surfaces again.
    Forward,
    /// One light's surfaces lay depth in the colour that most may keep, and are drawn again where the count says otherwise
    /// ([`crate::techniques::surfaces::finished_early`]).
    Early,
    /// Surfaces are drawn once, and what light needs to know of them is kept ([`crate::techniques::deferred`]).
    Deferred,
}

impl Shading {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 4] = [Self::Auto, Self::Forward, Self::Early, Self::Deferred];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Forward => "forward",
            Self::Early => "early",
            Self::Deferred => "deferred",
        }
    }

    /// One sentence for help and panel.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Auto => "the cheapest of the three, by how many triangles and lights there are",
            Self::Forward => "every light draws the surfaces it shines on again, as the papers do",
            Self::Early => "one light's surfaces lay depth as if all were lit, and are drawn again where they are in shadow",
            Self::Deferred => "surfaces are drawn once; depth, normal and base colour are kept, and lights draw pixels",
        }
    }
}
