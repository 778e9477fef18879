//! What the window remembers between runs: the settings, and how it likes to work.
//!
//! One JSON file, written a moment after each change (the death of an X server ends a process
//! without a goodbye) to a temporary name and renamed. A file that cannot be read is left out,
//! with a note; what it says is checked, because people edit such files.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use super::clock::Clock;
use super::control::Mode;
use crate::cli::check;
use crate::settings::{SceneChoice, Settings};

/// How long after a change the file is written: a slider dragged for a second is one write.
pub const DELAY: Duration = Duration::from_millis(500);

/// How many files the recent list holds.
pub const RECENT: usize = 10;

/// No settings file of ours is larger, bytes.
const LARGEST: u64 = 1 << 20;

/// How the window works; what is drawn is in [`Settings`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Preferences {
    /// Frames wait for the screen; else they come as fast as [`super::pace`] allows.
    pub vsync: bool,
    /// Draws all the time, also when nothing changes: for timing.
    pub continuous: bool,
    /// What dragging the mouse does.
    pub mode: Mode,
    /// Flying speed, metres per second.
    pub fly_speed: f64,
    /// The side panel is there.
    pub panel: bool,
    /// Lights are drawn as icons over the picture, and can be dragged.
    pub icons: bool,
    /// Whether and how fast time goes.
    pub clock: Clock,
    /// Files opened before, the latest first.
    pub recent: Vec<PathBuf>,
    /// The window's size, logical pixels.
    pub window: Option<[u32; 2]>,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            vsync: true,
            continuous: false,
            mode: Mode::default(),
            fly_speed: 3.0,
            panel: true,
            icons: true,
            clock: Clock::default(),
            recent: Vec::new(),
            window: None,
        }
    }
}

impl Preferences {
    /// Puts `path` at the head of the recent files.
    pub fn opened(&mut self, path: &Path) {
        self.recent.retain(|other| other != path);
        self.recent.insert(0, path.to_path_buf());
        self.recent.truncate(RECENT);
    }
}

/// What the file holds.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Stored {
    /// What is drawn, and how.
    pub settings: Settings,
    /// How the window works.
    pub preferences: Preferences,
}

impl Stored {
    /// What of it is kept: not what was asked for on one command line, nor a moment in time, nor a failure that was
    /// looked at: who starts the program again is not to find it wrong.
    fn lasting(settings: &Settings, preferences: &Preferences) -> Self {
        let settings = Settings {
            failure: None,
            adapter: None,
            shaders: None,
            time: 0.0,
            size: Settings::default().size,
            ..settings.clone()
        };
        Self { settings, preferences: preferences.clone() }
    }

    /// Replaces what no control could have made by the defaults.
    fn sane(mut self) -> Self {
        let defaults = Settings::default();
        let settings = &mut self.settings;
        settings.size = defaults.size;
        settings.time = defaults.time;
        settings.failure = None;
        // Each part is judged by itself, as the command line's are: one that was refused would keep the
        // program from starting until somebody found the file.
        let parts: [fn(&mut Settings, Settings); 8] = [
            |to, from| to.samples = from.samples,
            |to, from| to.fov = from.fov,
            |to, from| to.exposure = from.exposure,
            |to, from| to.camera = from.camera,
            |to, from| to.lights = from.lights,
            |to, from| to.lighting = from.lighting,
            |to, from| to.counting = from.counting,
            |to, from| to.mirrors = from.mirrors,
        ];
        for part in parts {
            let mut alone = Settings::default();
            part(&mut alone, settings.clone());
            if check(&alone).is_err() {
                part(settings, Settings::default());
            }
        }
        self.preferences.clock = self.preferences.clock.sane();
        self.preferences.recent.truncate(RECENT);
        if !(self.preferences.fly_speed > 0.0 && self.preferences.fly_speed <= 1000.0) {
            self.preferences.fly_speed = Preferences::default().fly_speed;
        }
        self.preferences.window = self.preferences.window.filter(|size| size.iter().all(|side| (200..=16384).contains(side)));
        self
    }
}

/// Makes `settings` those of another scene: what spoke of the old scene's lights, cameras and
/// animations is gone, and the new one is framed by its first camera.
pub fn turn_to(settings: &mut Settings, scene: SceneChoice) {
    let defaults = Settings::default();
    settings.scene = scene;
    settings.camera = defaults.camera;
    settings.fov = defaults.fov;
    settings.time = defaults.time;
    settings.animation = defaults.animation;
    settings.light = defaults.light;
    settings.lights = defaults.lights;
    settings.exposure = defaults.exposure;
    settings.mirrors.edits = defaults.mirrors.edits;
    settings.planar.edits = defaults.planar.edits;
}

/// The file, and what is to be written to it.
#[derive(Debug)]
pub struct Store {
    path: Option<PathBuf>,
    written: Stored,
    changed: Option<Instant>,
}

impl Store {
    /// The store of this user: `$OBSCURA_CONFIG_DIR`, or `obscura` in the system's folder for settings.
    #[must_use]
    pub fn of_user() -> Self {
        let folder = std::env::var_os("OBSCURA_CONFIG_DIR")
            .map(PathBuf::from)
            .or_else(|| dirs::config_dir().map(|folder| folder.join("obscura")));
        Self::at(folder.map(|folder| folder.join("settings.json")))
    }

    /// A store in this file; in none, nothing is kept.
    #[must_use]
    pub fn at(path: Option<PathBuf>) -> Self {
        Self { path, written: Stored::default(), changed: None }
    }

    /// What was kept, or the defaults; and a note where the file could not be used.
    pub fn load(&mut self) -> (Stored, Option<String>) {
        let Some(path) = &self.path else { return (Stored::default(), None) };
        match read(path) {
            Ok(stored) => {
                self.written = stored.clone();
                (stored.sane(), None)
            }
            Err(None) => (Stored::default(), None),
            Err(Some(why)) => (Stored::default(), Some(format!("kept settings are ignored: {}: {why}", path.display()))),
        }
    }

    /// Looks whether something changed; gives when to call [`write_if_due`](Self::write_if_due), if ever.
    pub fn notice(&mut self, settings: &Settings, preferences: &Preferences, now: Instant) -> Option<Instant> {
        if self.path.is_none() || Stored::lasting(settings, preferences) == self.written {
            self.changed = None;
            return None;
        }
        Some(*self.changed.get_or_insert(now) + DELAY)
    }

    /// Writes a change older than [`DELAY`].
    ///
    /// # Errors
    /// One sentence on why the file cannot be written; it is not tried again before the next change.
    pub fn write_if_due(&mut self, settings: &Settings, preferences: &Preferences, now: Instant) -> Result<(), String> {
        match self.notice(settings, preferences, now) {
            Some(due) if now >= due => self.write_now(settings, preferences),
            _ => Ok(()),
        }
    }

    /// Writes what changed, at once.
    ///
    /// # Errors
    /// One sentence on why the file cannot be written.
    pub fn write_now(&mut self, settings: &Settings, preferences: &Preferences) -> Result<(), String> {
        let stored = Stored::lasting(settings, preferences);
        self.changed = None;
        let Some(path) = self.path.as_ref().filter(|_| stored != self.written) else { return Ok(()) };
        let result = write(path, &stored).map_err(|why| format!("settings are not kept: {}: {why}", path.display()));
        self.written = stored;
        result
    }
}

/// The file's contents; no error where there is none.
fn read(path: &Path) -> Result<Stored, Option<String>> {
    let metadata = match std::fs::metadata(path) {
        Ok(metadata) => metadata,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Err(None),
        Err(error) => return Err(Some(error.to_string())),
    };
    if !metadata.is_file() || metadata.len() > LARGEST {
        return Err(Some("not a settings file".into()));
    }
    let text = std::fs::read_to_string(path).map_err(|error| Some(error.to_string()))?;
    serde_json::from_str(&text).map_err(|error| Some(error.to_string()))
}

fn write(path: &Path, stored: &Stored) -> std::io::Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder)?;
    let mut file = tempfile::NamedTempFile::new_in(folder)?;
    serde_json::to_writer_pretty(&mut file, stored)?;
    file.write_all(b"\n")?;
    file.persist(path)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a failed unwrap is a failed test
    use super::*;
    use crate::settings::{CameraChoice, Failure, LightEdit, Mirrors, SurfacePlace, Technique};
    use glam::DVec3;

    fn store(folder: &Path) -> Store {
        Store::at(Some(folder.join("deep/settings.json")))
    }

    #[test]
    fn what_is_written_comes_back() {
        let folder = tempfile::tempdir().unwrap();
        let mut settings = Settings {
            technique: Technique::ExactZPass,
            camera: CameraChoice::Free { eye: DVec3::new(0.1, 2.0, 3.0), target: DVec3::ZERO },
            shaders: Some("once".into()),
            time: 7.0,
            failure: Some(Failure::NoDarkCap),
            ..Settings::default()
        };
        settings.lights.insert(2, LightEdit { on: Some(false), ..LightEdit::default() });
        let preferences = Preferences { vsync: false, recent: vec!["a.glb".into()], ..Preferences::default() };
        store(folder.path()).write_now(&settings, &preferences).unwrap();
        let (stored, note) = store(folder.path()).load();
        assert_eq!(note, None);
        assert_eq!(stored.preferences, preferences);
        assert_eq!(stored.settings, Settings { shaders: None, time: 0.0, failure: None, ..settings });
        assert_eq!(std::fs::read_dir(folder.path().join("deep")).unwrap().count(), 1, "no temporary file stays");
    }

    #[test]
    fn writing_waits_and_happens_once() {
        let folder = tempfile::tempdir().unwrap();
        let mut store = store(folder.path());
        let file = folder.path().join("deep/settings.json");
        let (settings, preferences) = (Settings::default(), Preferences { icons: false, ..Preferences::default() });
        let start = Instant::now();
        assert_eq!(store.notice(&Settings::default(), &Preferences::default(), start), None, "nothing changed");
        assert_eq!(store.notice(&settings, &preferences, start), Some(start + DELAY));
        assert_eq!(store.notice(&settings, &preferences, start + DELAY / 2), Some(start + DELAY));
        store.write_if_due(&settings, &preferences, start + DELAY / 2).unwrap();
        assert!(!file.exists());
        store.write_if_due(&settings, &preferences, start + DELAY).unwrap();
        assert!(file.exists());
        assert_eq!(store.notice(&settings, &preferences, start + DELAY), None);
        let later = Settings { time: 3.0, ..settings };
        assert_eq!(store.notice(&later, &preferences, start + DELAY), None, "time that goes on is no change");
    }

    #[test]
    fn a_broken_file_is_ignored_with_a_note() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(folder.path().join("deep")).unwrap();
        for broken in ["{", "7", r#"{"settings": {"technique": "magic"}}"#] {
            std::fs::write(folder.path().join("deep/settings.json"), broken).unwrap();
            let (stored, note) = store(folder.path()).load();
            assert_eq!(stored, Stored::default());
            assert!(note.unwrap().contains("settings.json"), "{broken}");
        }
        assert_eq!(Store::at(Some(folder.path().join("none.json"))).load().1, None, "no file is no news");
    }

    #[test]
    fn numbers_nobody_could_choose_are_put_right() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(folder.path().join("deep")).unwrap();
        let text = r#"{"settings": {"samples": 3, "fov": 720, "exposure": 1e9, "camera": {"free": {"eye": [1,1,1], "target": [1,1,1]}}},
            "preferences": {"clock": {"speed": -4}, "fly_speed": 0, "window": [1, 1]}, "from-the-future": true}"#;
        std::fs::write(folder.path().join("deep/settings.json"), text).unwrap();
        let (stored, note) = store(folder.path()).load();
        assert_eq!(note, None);
        let mut expected = Stored::default();
        expected.preferences.clock.speed = 0.05;
        assert_eq!(stored, expected);
    }

    #[test]
    fn whatever_the_file_says_the_window_opens() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(folder.path().join("deep")).unwrap();
        for broken in [
            r#""camera": {"free": {"eye": [1e12, 0, 0], "target": [0, 0, 0]}}"#,
            r#""exposure": -40"#,
            r#""fov": 0"#,
            r#""mirrors": {"bounces": 0}"#,
            r#""mirrors": {"bounces": 4000000000, "edits": [[{"node": 7, "primitive": 0}, true]]}"#,
            r#""lights": {"0": {"range": -1}}"#,
            r#""lights": {"0": {"position": [1e300, 0, 0]}}"#,
        ] {
            let text = format!(r#"{{"settings": {{"technique": "z-pass", {broken}}}}}"#);
            std::fs::write(folder.path().join("deep/settings.json"), text).unwrap();
            let (stored, _) = store(folder.path()).load();
            assert_eq!(stored.settings, Settings { technique: Technique::ZPass, ..Settings::default() }, "{broken}");
        }
    }

    #[test]
    fn another_scene_starts_afresh_and_keeps_how_it_is_drawn() {
        let mut settings = Settings { light: 3, fov: Some(20.0), technique: Technique::ZPass, samples: 4, ..Settings::default() };
        settings.lights.insert(0, LightEdit::default());
        settings.mirrors.bounces = 2;
        settings.mirrors.edits.insert(SurfacePlace { node: 1, primitive: 0 }, true);
        turn_to(&mut settings, SceneChoice::Stock("cubes".into()));
        let expected = Settings {
            scene: SceneChoice::Stock("cubes".into()),
            technique: Technique::ZPass,
            samples: 4,
            mirrors: Mirrors { bounces: 2, ..Mirrors::default() },
            ..Settings::default()
        };
        assert_eq!(settings, expected);
    }
}
