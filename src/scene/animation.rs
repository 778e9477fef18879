//! What moves: keyframe tracks on nodes, as glTF has them.

use serde::{Deserialize, Serialize};

/// A named group of channels that loops on its own clock.
#[derive(Debug, Clone, Default)]
pub struct Animation {
    /// Its name in the file, or `animation N`.
    pub name: String,
    /// One per node and property.
    pub channels: Vec<Channel>,
    /// Seconds after which it starts again; 0 where nothing moves.
    pub duration: f64,
}

/// One property of one node over time.
#[derive(Debug, Clone)]
pub struct Channel {
    /// The node that moves.
    pub node: usize,
    /// Which of its properties.
    pub property: Property,
    /// How values between keys are found.
    pub interpolation: Interpolation,
    /// Seconds, strictly rising.
    pub times: Vec<f32>,
    /// `times.len() * width` numbers (three times that for cubic splines: in-tangent, value,
    /// out-tangent); width is 3 for translation and scale, 4 for rotation (x y z w), the number
    /// of morph targets for weights.
    pub values: Vec<f32>,
}

/// What a channel moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Property {
    /// Metres in the parent's space.
    Translation,
    /// Unit quaternion.
    Rotation,
    /// Per axis.
    Scale,
    /// Morph target weights.
    Weights,
}

/// How values between keys are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// The last key's value.
    Step,
    /// Straight, along the arc for rotations.
    Linear,
    /// Hermite with the file's tangents.
    CubicSpline,
}

/// Which animations of a scene play.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AnimationChoice {
    /// None: everything stands in its unanimated place.
    Still,
    /// All at once, each on its own loop: stock scenes are made so.
    #[default]
    All,
    /// Just this one: files often hold alternatives.
    One(usize),
}
