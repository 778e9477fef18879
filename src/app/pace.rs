//! When the next frame is due: as soon as something asks for one, but never sooner than the pace allows.
//!
//! Presentation does not throttle everywhere (a software GPU's Fifo returns at once), so the loop
//! sleeps by itself; an idle window draws nothing at all.

use std::time::{Duration, Instant};

/// The shortest time between two frames without vsync: 240 a second, so that no core burns.
pub const SHORTEST: Duration = Duration::from_micros(1_000_000 / 240);

/// Frames asked for, and when.
#[derive(Debug, Clone, Default)]
pub struct Pace {
    wanted: Option<Instant>,
    not_before: Option<Instant>,
    last: Option<Instant>,
}

impl Pace {
    /// A frame is wanted at `when` (or sooner, if one already is).
    pub fn want(&mut self, when: Instant) {
        self.wanted = Some(self.wanted.map_or(when, |wanted| wanted.min(when)));
    }

    /// No frame before `when`.
    pub fn hold(&mut self, when: Instant) {
        self.not_before = Some(when);
    }

    /// A frame starts: what was wanted is had.
    pub fn begin(&mut self, now: Instant) {
        self.wanted = None;
        self.not_before = None;
        self.last = Some(now);
    }

    /// When the next frame is due, if one is wanted.
    #[must_use]
    pub fn due(&self, shortest: Duration) -> Option<Instant> {
        let wanted = self.wanted?;
        let paced = self.last.map_or(wanted, |last| wanted.max(last + shortest));
        Some(self.not_before.map_or(paced, |not_before| paced.max(not_before)))
    }
}

/// The shortest time between two frames. With vsync a little less than the screen's own, so that
/// presentation keeps the beat where it can.
#[must_use]
pub fn shortest(vsync: bool, refresh_millihertz: Option<u32>) -> Duration {
    if !vsync {
        return SHORTEST;
    }
    let hertz = refresh_millihertz.map_or(60.0, |rate| f64::from(rate) / 1000.0).clamp(20.0, 500.0);
    Duration::from_secs_f64(0.9 / hertz)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_wanted_nothing_due() {
        let mut pace = Pace::default();
        let now = Instant::now();
        assert_eq!(pace.due(SHORTEST), None);
        pace.want(now);
        pace.begin(now);
        assert_eq!(pace.due(SHORTEST), None, "an idle window sleeps");
    }

    #[test]
    fn frames_keep_their_distance() {
        let mut pace = Pace::default();
        let now = Instant::now();
        pace.begin(now);
        pace.want(now);
        assert_eq!(pace.due(SHORTEST), Some(now + SHORTEST));
        let later = now + Duration::from_secs(1);
        pace.want(later);
        assert_eq!(pace.due(SHORTEST), Some(now + SHORTEST), "the sooner wish wins");
        pace.hold(now + Duration::from_millis(250));
        assert_eq!(pace.due(SHORTEST), Some(now + Duration::from_millis(250)));
        pace.begin(later);
        pace.want(later + Duration::from_secs(5));
        assert_eq!(pace.due(SHORTEST), Some(later + Duration::from_secs(5)), "a wish for later waits");
    }

    #[test]
    fn vsync_follows_the_screen() {
        assert_eq!(shortest(false, Some(60_000)), SHORTEST);
        assert_eq!(shortest(true, Some(144_000)), Duration::from_secs_f64(0.9 / 144.0));
        assert_eq!(shortest(true, Some(0)), Duration::from_secs_f64(0.9 / 20.0));
        assert_eq!(shortest(true, None), Duration::from_secs_f64(0.9 / 60.0));
    }
}
