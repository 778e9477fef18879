//! Time as the window runs it: playing or paused, stepped, faster or slower.

use serde::{Deserialize, Serialize};

/// One step, seconds: a frame of a film at 30 Hz.
pub const STEP: f64 = 1.0 / 30.0;

/// The slowest and the fastest that time goes, in seconds per second.
pub const SPEEDS: std::ops::RangeInclusive<f64> = 0.05..=8.0;

/// The longest jump between two frames, seconds: a window that was hidden goes on where it was.
const LONGEST: f64 = 0.25;

/// How the scene's time moves on. The time itself is [`crate::settings::Settings::time`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Clock {
    /// Time moves on by itself.
    pub playing: bool,
    /// Scene seconds per second, within [`SPEEDS`].
    pub speed: f64,
}

impl Default for Clock {
    fn default() -> Self {
        Self { playing: true, speed: 1.0 }
    }
}

impl Clock {
    /// The scene's time `elapsed` real seconds after it was `time`.
    #[must_use]
    pub fn advance(&self, time: f64, elapsed: f64) -> f64 {
        if self.playing { time + elapsed.clamp(0.0, LONGEST) * self.speed } else { time }
    }

    /// Stops, and gives the time one step on (or back, not before 0).
    #[must_use]
    pub fn step(&mut self, time: f64, steps: i32) -> f64 {
        self.playing = false;
        (time + f64::from(steps) * STEP).max(0.0)
    }

    /// Twice or half as fast, and so on.
    pub fn faster(&mut self, doublings: i32) {
        self.speed = (self.speed * 2f64.powi(doublings)).clamp(*SPEEDS.start(), *SPEEDS.end());
    }

    /// Puts back what a settings file may have spoilt.
    #[must_use]
    pub fn sane(mut self) -> Self {
        self.speed = if self.speed.is_finite() { self.speed.clamp(*SPEEDS.start(), *SPEEDS.end()) } else { 1.0 };
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_plays_pauses_and_steps() {
        let mut clock = Clock::default();
        assert!((clock.advance(1.0, 0.1) - 1.1).abs() < 1e-12);
        clock.faster(1);
        assert!((clock.advance(1.0, 0.1) - 1.2).abs() < 1e-12);
        assert!((clock.advance(1.0, 3600.0) - 1.5).abs() < 1e-12, "an hour hidden is no hour in the scene");
        let stepped = clock.step(1.0, 1);
        assert!(!clock.playing && (stepped - 1.0 - STEP).abs() < 1e-12);
        assert_eq!(clock.advance(stepped, 0.1), stepped);
        assert_eq!(clock.step(0.0, -1), 0.0);
    }

    #[test]
    fn speed_stays_in_its_range() {
        let mut clock = Clock::default();
        clock.faster(40);
        assert_eq!(clock.speed, *SPEEDS.end());
        clock.faster(-80);
        assert_eq!(clock.speed, *SPEEDS.start());
        assert_eq!(Clock { speed: f64::NAN, ..clock }.sane().speed, 1.0);
    }
}
