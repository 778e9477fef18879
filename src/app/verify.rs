//! "Verify this view": the picture on show against exact rays, on a thread of its own.
//!
//! The window draws what is to be judged, which takes a few frames' time; rays take longer, so a
//! worker casts them while the window goes on. What comes of it belongs to the settings it was asked
//! for, and is shown as long as they stay.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, PoisonError};

use crate::headless::verify::Shots;
use crate::scene::Scene;
use crate::settings::Settings;
use crate::truth::{Comparison, SurfaceComparison, WrongPixel};

/// What was found of one view.
#[derive(Debug, Clone)]
pub struct Finding {
    /// The view.
    pub settings: Settings,
    /// Light by light.
    pub lights: Vec<(String, Comparison)>,
    /// Which surfaces are seen, and through which mirrors.
    pub surfaces: SurfaceComparison,
    /// All wrong pixels.
    pub wrong: Vec<WrongPixel>,
}

/// At most one view is verified at a time; the last finding stays.
#[derive(Debug, Default)]
pub struct Verification {
    running: Option<Running>,
    finding: Option<Finding>,
}

#[derive(Debug)]
struct Running {
    stop: Arc<AtomicBool>,
    /// Thousandths.
    done: Arc<AtomicU32>,
    answer: Receiver<Finding>,
}

impl Drop for Running {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

impl Verification {
    /// Starts judging what was drawn by the settings' technique; what was being judged is given up.
    /// `wake` is called from the worker when there is something new to show.
    pub fn start(&mut self, scene: Arc<Scene>, shots: Shots, settings: Settings, wake: impl Fn() + Send + Sync + 'static) {
        let (sender, answer) = channel();
        let (stop, done) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicU32::new(0)));
        self.finding = None;
        self.running = Some(Running { stop: stop.clone(), done: done.clone(), answer });
        let work = move || {
            let world = shots.world(&scene);
            let shown = std::sync::Mutex::new(0);
            let goes_on = |share: f64| {
                let permille = (share * 1e3) as u32;
                done.fetch_max(permille, Ordering::Relaxed);
                let mut shown = shown.lock().unwrap_or_else(PoisonError::into_inner);
                if permille >= *shown + 50 {
                    *shown = permille;
                    wake();
                }
                !stop.load(Ordering::Relaxed)
            };
            let Some(judged) = shots.judge(&scene, &world, settings.size, &goes_on) else { return };
            let wrong = judged.wrong();
            let name = |light| scene.light_name(&settings.mirrors, light);
            let lights = judged.found.into_iter().map(|(_, light, found)| (name(light), found)).collect();
            // Nobody may be waiting any more.
            let _ = sender.send(Finding { settings, lights, surfaces: judged.surfaces, wrong });
            wake();
        };
        std::thread::spawn(work);
    }

    /// Takes the answer, if it is there.
    pub fn poll(&mut self) {
        let Some(running) = &self.running else { return };
        match running.answer.try_recv() {
            Ok(finding) => {
                self.finding = Some(finding);
                self.running = None;
            }
            Err(TryRecvError::Disconnected) => self.running = None,
            Err(TryRecvError::Empty) => {}
        }
    }

    /// How far it is, 0 to 1, while it runs.
    #[must_use]
    pub fn progress(&self) -> Option<f32> {
        self.running.as_ref().map(|running| running.done.load(Ordering::Relaxed) as f32 / 1e3)
    }

    /// What was found, where it speaks of these settings.
    #[must_use]
    pub fn finding(&self, settings: &Settings) -> Option<&Finding> {
        self.finding.as_ref().filter(|finding| finding.settings == *settings)
    }

    /// A finding that was made elsewhere.
    #[must_use]
    pub fn found(finding: Finding) -> Self {
        Self { running: None, finding: Some(finding) }
    }
}
