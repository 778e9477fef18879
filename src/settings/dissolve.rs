//! Two scenes or two techniques in one picture, mixed pixel by pixel.

use serde::{Deserialize, Serialize};

use super::Technique;

/// A picture that dissolves into another (K section 7, figure 16): another scene, or the same by another technique.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Dissolve {
    /// The technique that it dissolves into; none leaves that alone.
    pub into: Option<Technique>,
    /// The stock scene that it dissolves into, seen by its first camera; none leaves that alone.
    pub scene: Option<String>,
    /// Which pixels go first.
    pub pattern: Pattern,
    /// How many have gone: 0 none, 1 all.
    pub amount: f32,
    /// Where this is not 0 the amount goes by time instead, there and back in so many seconds.
    pub seconds: f32,
}

impl Default for Dissolve {
    fn default() -> Self {
        Self { into: None, scene: None, pattern: Pattern::default(), amount: 0.5, seconds: 0.0 }
    }
}

impl Dissolve {
    /// How many pixels have gone at a time, seconds; of 1.
    #[must_use]
    pub fn amount_at(&self, time: f64) -> f32 {
        if self.seconds <= 0.0 {
            return self.amount.clamp(0.0, 1.0);
        }
        #[expect(clippy::cast_possible_truncation, reason = "a share of 1")]
        let turn = (time / f64::from(self.seconds)).rem_euclid(1.0) as f32;
        1.0 - (2.0 * turn - 1.0).abs()
    }
}

/// The order in which pixels go.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Pattern {
    /// Bayer's ordered dither, 8 by 8.
    #[default]
    Bayer,
    /// Void and cluster, 32 by 32: no structure that the eye holds on to.
    BlueNoise,
    /// Every other pixel, and then the rest.
    Checker,
    /// From the left to the right.
    Wipe,
}

impl Pattern {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 4] = [Self::Bayer, Self::BlueNoise, Self::Checker, Self::Wipe];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bayer => "bayer",
            Self::BlueNoise => "blue-noise",
            Self::Checker => "checker",
            Self::Wipe => "wipe",
        }
    }

    /// One sentence for help and panel.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Bayer => "pixels turn in the order of Bayer's 8 by 8 matrix",
            Self::BlueNoise => "pixels turn in an order without structure (void and cluster)",
            Self::Checker => "every other pixel turns first, and then the rest",
            Self::Wipe => "pixels turn from the left to the right",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_amount_goes_there_and_back_by_time() {
        let still = Dissolve { amount: 0.3, ..Dissolve::default() };
        assert_eq!([0.0, 7.5].map(|time| still.amount_at(time)), [0.3, 0.3]);
        let moving = Dissolve { seconds: 4.0, ..still.clone() };
        assert_eq!([0.0, 1.0, 2.0, 3.0, 4.0, 5.0].map(|time| moving.amount_at(time)), [0.0, 0.5, 1.0, 0.5, 0.0, 0.5]);
    }
}
