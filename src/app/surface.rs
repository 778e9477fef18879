//! What to do about the window's surface before and after each attempt to get a frame of it.
//!
//! The rules are a small machine without any GPU in it, so that each can be tested:
//!
//! ```text
//!   size, device --before()--> Skip | Configure(size) | Rebuild | Acquire
//!   what came back --after()--> Draw | Wait | WaitUntilShown | Reconfigure | Recreate | Rebuild | GiveUp
//! ```
//!
//! Two things wgpu does not forgive shape it: acquiring from a surface that was never configured
//! panics, and a lost device shows up as `Validation`, silently, so the device is asked first.

use std::time::Duration;

use wgpu::CurrentSurfaceTexture;

/// How long to leave the surface alone after a timeout.
pub const AFTER_TIMEOUT: Duration = Duration::from_millis(16);

/// How long to leave it alone when configuring it anew does not help.
pub const AFTER_TROUBLE: Duration = Duration::from_millis(250);

/// How often in a row a surface is called outdated before patience sets in, and how often in a row
/// it may be lost before the window gives up (a display server that died loses it for ever).
pub const TRIES: u32 = 3;

/// What came of asking for a frame: [`CurrentSurfaceTexture`] without the texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Acquired {
    /// A frame.
    Success,
    /// A frame, but the surface should be configured anew.
    Suboptimal,
    /// None in time.
    Timeout,
    /// Nobody would see it.
    Occluded,
    /// The surface changed and must be configured anew.
    Outdated,
    /// The surface is gone.
    Lost,
    /// wgpu refused.
    Validation,
}

impl From<&CurrentSurfaceTexture> for Acquired {
    fn from(texture: &CurrentSurfaceTexture) -> Self {
        match texture {
            CurrentSurfaceTexture::Success(_) => Self::Success,
            CurrentSurfaceTexture::Suboptimal(_) => Self::Suboptimal,
            CurrentSurfaceTexture::Timeout => Self::Timeout,
            CurrentSurfaceTexture::Occluded => Self::Occluded,
            CurrentSurfaceTexture::Outdated => Self::Outdated,
            CurrentSurfaceTexture::Lost => Self::Lost,
            CurrentSurfaceTexture::Validation => Self::Validation,
        }
    }
}

/// What to do before asking for a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Before {
    /// There is nothing to draw on: the window is minimised, has no size, or nobody sees it.
    Skip,
    /// Configure the surface with this size first, then ask.
    Configure([u32; 2]),
    /// The device is lost: build everything anew.
    Rebuild,
    /// Ask.
    Acquire,
}

/// What to do after asking for a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum After {
    /// Draw, submit, present.
    Draw,
    /// Draw nothing, try again after this long.
    Wait(Duration),
    /// Draw nothing until the window is shown again.
    WaitUntilShown,
    /// Configure the surface and try again at once.
    Reconfigure,
    /// Drop the surface, create it anew, configure it, try again.
    Recreate,
    /// The device is lost: build everything anew.
    Rebuild,
    /// It does not come back.
    GiveUp,
}

/// The surface's state, as far as the window has to remember it.
#[derive(Debug, Clone, Default)]
pub struct SurfaceState {
    /// The window's size as last reported, pixels.
    size: [u32; 2],
    /// What the surface is configured with; none before the first time.
    configured: Option<[u32; 2]>,
    /// It must be configured again whatever its size.
    stale: bool,
    occluded: bool,
    outdated_in_a_row: u32,
    lost_in_a_row: u32,
}

impl SurfaceState {
    /// A surface that was not configured yet, for a window of `size` pixels.
    #[must_use]
    pub fn new(size: [u32; 2]) -> Self {
        Self { size, ..Self::default() }
    }

    /// The window has a new size; the surface follows at the next [`before`](Self::before).
    pub fn resized(&mut self, size: [u32; 2]) {
        self.size = size;
    }

    /// The window was hidden or shown.
    pub fn occluded(&mut self, occluded: bool) {
        self.occluded = occluded;
    }

    /// The surface has to be configured again: another presentation mode was chosen.
    pub fn invalidate(&mut self) {
        self.stale = true;
    }

    /// The surface is a new one.
    pub fn recreated(&mut self) {
        self.configured = None;
    }

    /// The window's size, pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Pixels to draw on, or none while there is nothing to draw on. Clamped to what the device can do.
    #[must_use]
    pub fn drawable(&self, max_side: u32) -> Option<[u32; 2]> {
        let [width, height] = self.size.map(|side| side.min(max_side));
        (width > 0 && height > 0 && !self.occluded).then_some([width, height])
    }

    /// What to do before asking for a frame. `Configure` counts as done.
    pub fn before(&mut self, max_side: u32, device_lost: bool) -> Before {
        let Some(size) = self.drawable(max_side) else { return Before::Skip };
        if device_lost {
            return Before::Rebuild;
        }
        if self.configured == Some(size) && !self.stale {
            return Before::Acquire;
        }
        self.configured = Some(size);
        self.stale = false;
        Before::Configure(size)
    }

    /// What to do about what came back.
    pub fn after(&mut self, acquired: Acquired, device_lost: bool) -> After {
        if !matches!(acquired, Acquired::Outdated) {
            self.outdated_in_a_row = 0;
        }
        if !matches!(acquired, Acquired::Lost) {
            self.lost_in_a_row = 0;
        }
        match acquired {
            Acquired::Success => After::Draw,
            Acquired::Suboptimal => {
                self.stale = true;
                After::Draw
            }
            Acquired::Timeout => After::Wait(AFTER_TIMEOUT),
            Acquired::Occluded => After::WaitUntilShown,
            _ if device_lost => After::Rebuild,
            Acquired::Outdated => {
                self.stale = true;
                self.outdated_in_a_row += 1;
                if self.outdated_in_a_row > TRIES { After::Wait(AFTER_TROUBLE) } else { After::Reconfigure }
            }
            Acquired::Lost => {
                self.configured = None;
                self.lost_in_a_row += 1;
                if self.lost_in_a_row > TRIES { After::GiveUp } else { After::Recreate }
            }
            Acquired::Validation => {
                self.stale = true;
                After::Wait(AFTER_TROUBLE)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MAX: u32 = 8192;

    fn configured() -> SurfaceState {
        let mut state = SurfaceState::new([640, 480]);
        assert_eq!(state.before(MAX, false), Before::Configure([640, 480]), "never acquire before configuring");
        assert_eq!(state.before(MAX, false), Before::Acquire);
        state
    }

    #[test]
    fn a_resize_configures_once() {
        let mut state = configured();
        state.resized([800, 600]);
        state.resized([801, 600]);
        assert_eq!(state.before(MAX, false), Before::Configure([801, 600]));
        assert_eq!(state.before(MAX, false), Before::Acquire);
    }

    #[test]
    fn no_size_and_no_viewer_mean_no_frame() {
        let mut state = configured();
        state.resized([0, 600]);
        assert_eq!(state.before(MAX, false), Before::Skip);
        assert_eq!(state.before(MAX, true), Before::Skip, "a lost device can wait until there is something to draw on");
        state.resized([640, 480]);
        state.occluded(true);
        assert_eq!(state.before(MAX, false), Before::Skip);
        state.occluded(false);
        assert_eq!(state.before(MAX, false), Before::Acquire, "coming back at the same size needs nothing new");
    }

    #[test]
    fn sizes_stay_within_the_device() {
        let mut state = SurfaceState::new([20_000, 100]);
        assert_eq!(state.before(4096, false), Before::Configure([4096, 100]));
    }

    #[test]
    fn suboptimal_draws_and_configures_before_the_next_frame() {
        let mut state = configured();
        assert_eq!(state.after(Acquired::Suboptimal, false), After::Draw);
        assert_eq!(state.before(MAX, false), Before::Configure([640, 480]));
        assert_eq!(state.before(MAX, false), Before::Acquire);
    }

    #[test]
    fn timeouts_wait_and_occlusion_waits_until_shown() {
        let mut state = configured();
        assert_eq!(state.after(Acquired::Timeout, false), After::Wait(AFTER_TIMEOUT));
        assert_eq!(state.after(Acquired::Occluded, false), After::WaitUntilShown);
        assert_eq!(state.before(MAX, false), Before::Acquire);
    }

    #[test]
    fn outdated_configures_and_backs_off_after_three() {
        let mut state = configured();
        for _ in 0..TRIES {
            assert_eq!(state.after(Acquired::Outdated, false), After::Reconfigure);
            assert_eq!(state.before(MAX, false), Before::Configure([640, 480]));
        }
        assert_eq!(state.after(Acquired::Outdated, false), After::Wait(AFTER_TROUBLE));
        assert_eq!(state.after(Acquired::Success, false), After::Draw);
        assert_eq!(state.after(Acquired::Outdated, false), After::Reconfigure, "a frame in between starts the count again");
    }

    #[test]
    fn lost_is_created_anew_three_times() {
        let mut state = configured();
        for _ in 0..TRIES {
            assert_eq!(state.after(Acquired::Lost, false), After::Recreate);
            state.recreated();
            assert_eq!(state.before(MAX, false), Before::Configure([640, 480]));
        }
        assert_eq!(state.after(Acquired::Lost, false), After::GiveUp);
    }

    #[test]
    fn a_lost_device_is_seen_behind_every_mask() {
        for acquired in [Acquired::Validation, Acquired::Outdated, Acquired::Lost] {
            assert_eq!(configured().after(acquired, true), After::Rebuild, "{acquired:?}");
        }
        assert_eq!(configured().before(MAX, true), Before::Rebuild);
        assert_eq!(configured().after(Acquired::Validation, false), After::Wait(AFTER_TROUBLE));
    }

    #[test]
    fn another_presentation_mode_configures_again() {
        let mut state = configured();
        state.invalidate();
        assert_eq!(state.before(MAX, false), Before::Configure([640, 480]));
    }
}
