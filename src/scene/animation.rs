//! What moves: keyframe tracks on nodes, as glTF has them.
//!
//! Before its first key a channel has that key's value, after its last the last's; an animation as
//! a whole loops. What is no sound channel (lengths that do not fit) has no value, and its property
//! stays as it is.

use glam::DQuat;
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

impl AnimationChoice {
    /// Whether the animation of this index plays.
    #[must_use]
    pub fn plays(self, animation: usize) -> bool {
        match self {
            Self::Still => false,
            Self::All => true,
            Self::One(one) => one == animation,
        }
    }
}

impl Animation {
    /// Where in its loop the animation is, `time` seconds after the start of the world.
    #[must_use]
    pub fn local_time(&self, time: f64) -> f64 {
        if self.duration > 0.0 && time.is_finite() { time.rem_euclid(self.duration) } else { 0.0 }
    }
}

impl Channel {
    /// The value at `time` seconds into the animation, in `values` (cleared first): 3 numbers for
    /// translation and scale, a unit quaternion (x y z w) for rotation, one a morph target for
    /// weights. Empty where the channel is none.
    pub fn sample(&self, time: f64, values: &mut Vec<f64>) {
        values.clear();
        let keys = self.times.len();
        let parts = if self.interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        if keys == 0 || !self.values.len().is_multiple_of(keys * parts) {
            return;
        }
        let width = self.values.len() / (keys * parts);
        let expected = match self.property {
            Property::Translation | Property::Scale => 3,
            Property::Rotation => 4,
            Property::Weights => width,
        };
        if width != expected {
            return;
        }
        // The last key that is not later, and the one after it.
        let from = self.times.partition_point(|&key| f64::from(key) <= time).saturating_sub(1);
        let to = (from + 1).min(keys - 1);
        let (start, end) = (f64::from(self.times[from]), f64::from(self.times[to]));
        let span = end - start;
        let at = if span > 0.0 { ((time - start) / span).clamp(0.0, 1.0) } else { 0.0 };
        let part = |key: usize, part: usize| &self.values[(key * parts + part) * width..][..width];
        match self.interpolation {
            Interpolation::Step => values.extend(part(from, 0).iter().copied().map(f64::from)),
            Interpolation::Linear if self.property == Property::Rotation => {
                let turned = quaternion(part(from, 0)).slerp(quaternion(part(to, 0)), at);
                values.extend(turned.normalize().to_array());
            }
            Interpolation::Linear => {
                let both = part(from, 0).iter().zip(part(to, 0));
                values.extend(both.map(|(&a, &b)| f64::from(a) + (f64::from(b) - f64::from(a)) * at));
            }
            Interpolation::CubicSpline => {
                // Hermite: values at both ends, the out-tangent of the first, the in-tangent of the second.
                let (at2, at3) = (at * at, at * at * at);
                let weights =
                    [2.0 * at3 - 3.0 * at2 + 1.0, span * (at3 - 2.0 * at2 + at), 3.0 * at2 - 2.0 * at3, span * (at3 - at2)];
                let points = [part(from, 1), part(from, 2), part(to, 1), part(to, 0)];
                values.extend((0..width).map(|number| {
                    weights.iter().zip(points).map(|(weight, point)| weight * f64::from(point[number])).sum::<f64>()
                }));
            }
        }
        if self.property == Property::Rotation {
            let turned = DQuat::from_slice(values);
            let unit = if turned.length_squared().is_normal() { turned.normalize() } else { DQuat::IDENTITY };
            values.copy_from_slice(&unit.to_array());
        }
    }
}

/// Of unit length, whatever the file says.
fn quaternion(values: &[f32]) -> DQuat {
    let turned = DQuat::from_slice(&[f64::from(values[0]), f64::from(values[1]), f64::from(values[2]), f64::from(values[3])]);
    if turned.length_squared().is_normal() { turned.normalize() } else { DQuat::IDENTITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channel(property: Property, interpolation: Interpolation, times: &[f32], values: &[f32]) -> Channel {
        Channel { node: 0, property, interpolation, times: times.to_vec(), values: values.to_vec() }
    }

    fn sample(channel: &Channel, time: f64) -> Vec<f64> {
        let mut values = vec![9.0];
        channel.sample(time, &mut values);
        values
    }

    #[test]
    fn steps_and_lines_hold_their_ends() {
        let keys = [1.0, 0.0, 0.0, 3.0, 2.0, -4.0];
        let step = channel(Property::Translation, Interpolation::Step, &[1.0, 3.0], &keys);
        assert_eq!(sample(&step, 0.0), [1.0, 0.0, 0.0]);
        assert_eq!(sample(&step, 2.999), [1.0, 0.0, 0.0]);
        assert_eq!(sample(&step, 3.0), [3.0, 2.0, -4.0]);
        assert_eq!(sample(&step, 30.0), [3.0, 2.0, -4.0]);
        let line = channel(Property::Scale, Interpolation::Linear, &[1.0, 3.0], &keys);
        assert_eq!(sample(&line, -1.0), [1.0, 0.0, 0.0]);
        assert_eq!(sample(&line, 1.5), [1.5, 0.5, -1.0]);
        assert_eq!(sample(&line, 7.0), [3.0, 2.0, -4.0]);
    }

    #[test]
    fn rotations_take_the_short_arc_at_even_speed() {
        let half = std::f32::consts::FRAC_PI_4.sin();
        // A quarter turn about y, the second key written with the opposite sign.
        let turn = channel(Property::Rotation, Interpolation::Linear, &[0.0, 1.0], &[0.0, 0.0, 0.0, 1.0, 0.0, -half, 0.0, -half]);
        let third = DQuat::from_rotation_y(std::f64::consts::FRAC_PI_6);
        assert!(DQuat::from_slice(&sample(&turn, 1.0 / 3.0)).angle_between(third) < 1e-6);
        let lost = channel(Property::Rotation, Interpolation::Step, &[0.0], &[0.0; 4]);
        assert_eq!(sample(&lost, 0.0), [0.0, 0.0, 0.0, 1.0]);
    }

    #[test]
    fn cubic_splines_follow_their_tangents() {
        // From 0 to 1 over two seconds; leaving at 3 a second, arriving at 0.
        let values = [9.0, 0.0, 3.0, 0.0, 1.0, 9.0];
        let spline = channel(Property::Weights, Interpolation::CubicSpline, &[1.0, 3.0], &values);
        assert_eq!(sample(&spline, 1.0), [0.0]);
        assert_eq!(sample(&spline, 3.0), [1.0]);
        // Half way: 0.5 of the values' difference plus an eighth of span times the tangents' difference.
        assert_eq!(sample(&spline, 2.0), [0.5 + 2.0 * 3.0 / 8.0]);
        let speed = (sample(&spline, 1.001)[0] - sample(&spline, 1.0)[0]) / 0.001;
        assert!((speed - 3.0).abs() < 0.01, "{speed}");
    }

    #[test]
    fn unsound_channels_have_no_value() {
        assert!(sample(&channel(Property::Translation, Interpolation::Linear, &[], &[]), 0.0).is_empty());
        assert!(sample(&channel(Property::Translation, Interpolation::Linear, &[0.0, 1.0], &[0.0; 5]), 0.0).is_empty());
        assert!(sample(&channel(Property::Rotation, Interpolation::Step, &[0.0], &[0.0; 3]), 0.0).is_empty());
        assert!(sample(&channel(Property::Scale, Interpolation::CubicSpline, &[0.0], &[0.0; 3]), 0.0).is_empty());
    }

    #[test]
    fn animations_loop() {
        let animation = Animation { duration: 2.5, ..Animation::default() };
        assert_eq!(animation.local_time(6.0), 1.0);
        assert_eq!(animation.local_time(-0.5), 2.0);
        assert_eq!(animation.local_time(f64::NAN), 0.0);
        assert_eq!(Animation::default().local_time(6.0), 0.0);
        assert!(AnimationChoice::One(2).plays(2) && !AnimationChoice::One(2).plays(0) && !AnimationChoice::Still.plays(0));
    }
}
