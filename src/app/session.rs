//! What is shown, without the window: settings, scene, notices, and the last frame's plan.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::ui::{self, Action, History, Notice, Panel, Tone, Topic, View};
use super::verify::Verification;
use super::{WindowOptions, photo, store};
use crate::cli::render_command;
use crate::failures::demonstration;
use crate::figures;
use crate::frame::{Capabilities, FramePlan};
use crate::headless::render::put_together;
use crate::scene::open::{Loading, load_on_thread};
use crate::scene::{Pose, Scene, doctor, stock};
use crate::settings::{Failure, SceneChoice, Settings, Show};
use crate::techniques::complexity::Tally;
use store::{Preferences, Store};

/// How long good news stay.
const GOOD_NEWS: Duration = Duration::from_secs(8);

/// The scene that is drawn.
pub(super) struct Loaded {
    pub scene: Arc<Scene>,
    /// As it was opened: no solids put together, and no partner.
    opened: Arc<Scene>,
    /// The stock scene that is its partner, or could not be.
    dissolves_into: Option<String>,
    doctor: String,
    floor: bool,
}

/// A scene on its way.
struct Opening {
    loading: Loading,
    name: String,
    floor: bool,
    /// It is the scene that is there already, or the one that the settings were made for: camera
    /// and lights stay.
    keep: bool,
    /// What it is to show, with all that belongs to that.
    exhibit: Option<Exhibit>,
}

/// Something that brings scene, camera and settings along.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Exhibit {
    /// A failure of the gallery.
    Failure(Failure),
    /// A figure of the papers, by its number in the table.
    Figure(usize),
}

impl Exhibit {
    /// All that shows it; what is not of the scene is `base`'s.
    fn settings(self, base: &Settings) -> Settings {
        match self {
            Self::Failure(failure) => demonstration(failure, base),
            Self::Figure(number) => figures::TABLE.get(number).map_or_else(|| base.clone(), |figure| figure.settings(base)),
        }
    }
}

/// The last picture.
pub(super) struct Drawn {
    pub pose: Pose,
    pub plan: FramePlan,
    /// Its depth complexity, where that is shown.
    pub complexity: Option<Tally>,
}

/// Everything that outlives a window and a device.
pub(super) struct Session {
    pub settings: Settings,
    pub preferences: Preferences,
    pub store: Store,
    pub panel: Panel,
    pub history: History,
    pub loaded: Option<Loaded>,
    pub drawn: Option<Drawn>,
    /// What the last picture was drawn from, or tried to be.
    pub drawn_from: Option<Settings>,
    /// The next of the frames that are gathered while nothing changes; none where all are there.
    pub next_frame: Option<u32>,
    /// The picture against exact rays, where that was asked for.
    pub verification: Verification,
    notices: Vec<Notice>,
    /// When good news go by themselves.
    passing: Vec<(Topic, Instant)>,
    opening: Option<Opening>,
}

impl Session {
    pub fn new(mut settings: Settings, options: &WindowOptions, mut store: Store) -> Self {
        settings.scene = wherever(settings.scene);
        let (stored, note) = store.load();
        let mut preferences = stored.preferences;
        if let Some(vsync) = options.vsync {
            preferences.vsync = vsync;
        }
        let mut session = Self {
            settings,
            preferences,
            store,
            panel: Panel::default(),
            history: History::default(),
            loaded: None,
            drawn: None,
            drawn_from: None,
            next_frame: None,
            verification: Verification::default(),
            notices: Vec::new(),
            passing: Vec::new(),
            opening: None,
        };
        if let Some(note) = note {
            session.notice(Topic::Store, Tone::Warning, note);
        }
        session
    }

    /// Says something; a newer word on the same topic replaces the older.
    pub fn notice(&mut self, topic: Topic, tone: Tone, words: impl Into<String>) {
        let words = words.into();
        match tone {
            Tone::Good => tracing::info!("{words}"),
            Tone::Warning => tracing::warn!("{words}"),
            Tone::Error => tracing::error!("{words}"),
        }
        self.dismiss(topic);
        if tone == Tone::Good {
            self.passing.push((topic, Instant::now() + GOOD_NEWS));
        }
        self.notices.push(Notice { topic, tone, words });
    }

    pub fn dismiss(&mut self, topic: Topic) {
        self.notices.retain(|notice| notice.topic != topic);
        self.passing.retain(|(passing, _)| *passing != topic);
    }

    /// Takes good news away that everybody has read; gives when the next will go.
    pub fn forget_old_news(&mut self, now: Instant) -> Option<Instant> {
        let old: Vec<_> = self.passing.iter().filter(|(_, end)| *end <= now).map(|(topic, _)| *topic).collect();
        for topic in old {
            self.dismiss(topic);
        }
        self.passing.iter().map(|(_, end)| *end).min()
    }

    /// What the panel shows; settings, preferences and panel itself stay free to be changed.
    pub fn parts<'a>(
        &'a mut self,
        capabilities: Option<&'a Capabilities>,
        picture: Option<egui::TextureId>,
    ) -> (&'a mut Panel, ui::Desk<'a>, View<'a>) {
        let view = View {
            stock: stock::TABLE,
            scene: self.loaded.as_ref().map(|loaded| &*loaded.scene),
            pose: self.drawn.as_ref().map(|drawn| &drawn.pose),
            plan: self.drawn.as_ref().map(|drawn| &drawn.plan),
            doctor: self.loaded.as_ref().map_or("", |loaded| &loaded.doctor),
            opening: self.opening.as_ref().map(|opening| opening.name.as_str()),
            notices: &self.notices,
            capabilities,
            complexity: self.drawn.as_ref().and_then(|drawn| drawn.complexity),
            history: &self.history,
            verification: &self.verification,
            picture,
        };
        (&mut self.panel, ui::Desk { settings: &mut self.settings, preferences: &mut self.preferences }, view)
    }

    /// The title of the window; no NUL in it, which winit does not forgive.
    pub fn title(&self) -> String {
        let scene = match &self.settings.scene {
            SceneChoice::Stock(name) => name.clone(),
            SceneChoice::File(path) => path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        };
        let title = format!("Obscura \u{2014} {scene} \u{2014} {}", self.settings.technique.name());
        title.chars().map(|letter| if letter.is_control() { '\u{fffd}' } else { letter }).collect()
    }

    /// Starts opening a scene; one that was on its way is forgotten.
    pub fn open(&mut self, choice: SceneChoice, keep: bool, wake: impl FnOnce() + Send + 'static) {
        let choice = wherever(choice);
        let name = match &choice {
            SceneChoice::Stock(name) => name.clone(),
            SceneChoice::File(path) => path.display().to_string(),
        };
        let floor = self.settings.floor;
        self.opening = Some(Opening { loading: load_on_thread(choice, floor, wake), name, floor, keep, exhibit: None });
    }

    /// Shows a failure of the gallery, or a figure, on the scene that shows it well; that is opened first where it is not
    /// there yet, so that the settings never speak of another.
    pub fn demonstrate(&mut self, exhibit: Exhibit, wake: impl FnOnce() + Send + 'static) {
        let wanted = exhibit.settings(&self.settings);
        if self.loaded.is_some() && self.opening.is_none() && wanted.scene == self.settings.scene && !self.settings.floor {
            self.settings = wanted;
            return;
        }
        self.settings.floor = false;
        self.open(wanted.scene, true, wake);
        if let Some(opening) = &mut self.opening {
            opening.exhibit = Some(exhibit);
        }
    }

    /// Whether the floor was switched since the scene was opened.
    pub fn wants_other_floor(&self) -> bool {
        self.opening.is_none() && self.loaded.as_ref().is_some_and(|loaded| loaded.floor != self.settings.floor)
    }

    /// Takes the scene that was opened, if it is there: `upload` brings it to the device. True where
    /// nothing could be opened and nothing is there, so that another scene is needed.
    pub fn take_opened(&mut self, upload: impl FnOnce(&Scene) -> Result<(), String>) -> bool {
        let Some(result) = self.opening.as_mut().and_then(|opening| opening.loading.poll()) else { return false };
        let Some(opening) = self.opening.take() else { return false };
        let result = result.map_err(|error| error.to_string()).and_then(|scene| {
            let uploaded = upload(&scene).map_err(|error| format!("{}: {error}", opening.name));
            uploaded.map(|()| scene)
        });
        let choice = opening.loading.choice;
        match result {
            Ok(scene) => {
                if let Some(exhibit) = opening.exhibit {
                    self.settings = exhibit.settings(&self.settings);
                } else if !opening.keep {
                    store::turn_to(&mut self.settings, choice.clone());
                }
                if let SceneChoice::File(path) = &choice {
                    self.preferences.opened(path);
                }
                tracing::info!("opened {}", opening.name);
                let doctor = doctor::report(&scene).to_string();
                let scene = Arc::new(scene);
                self.loaded = Some(Loaded { doctor, opened: scene.clone(), dissolves_into: None, scene, floor: opening.floor });
                self.verification = Verification::default();
                self.drawn = None;
                self.drawn_from = None;
                self.dismiss(Topic::Scene);
                self.dismiss(Topic::Frame);
                false
            }
            Err(words) => {
                if self.loaded.is_none() {
                    // Nobody may be looking at the panel yet.
                    eprintln!("obscura: {words}");
                }
                self.notice(Topic::Scene, Tone::Error, format!("Cannot open this: {words}"));
                if let Some(loaded) = &self.loaded {
                    self.settings.floor = loaded.floor;
                }
                self.loaded.is_none() && choice != SceneChoice::default()
            }
        }
    }

    /// Puts the scene's two solids together, or takes them apart, and finds the scene that it dissolves into, where settings or time ask for it: `upload` brings what
    /// comes of it to the device.
    pub fn put_together(&mut self, upload: impl FnOnce(&Scene) -> Result<(), String>) -> Result<(), String> {
        let Some(loaded) = &mut self.loaded else { return Ok(()) };
        let wanted = loaded.opened.combination_at(&self.settings);
        let there = loaded.scene.solid.as_ref().map(|solid| &solid.of);
        let like = wanted.is_none() && there.is_none()
            || wanted.as_ref().zip(there).is_some_and(|(wanted, there)| wanted.is_like(there));
        let into = &self.settings.dissolve.scene;
        if like && loaded.dissolves_into == *into {
            return Ok(());
        }
        let as_opened = wanted.is_none() && into.is_none();
        let together = || Arc::new(put_together(&self.settings, (*loaded.opened).clone()));
        let scene = if as_opened { loaded.opened.clone() } else { together() };
        upload(&scene)?;
        (loaded.scene, loaded.dissolves_into) = (scene, into.clone());
        Ok(())
    }

    /// Moves the scene's time on.
    pub fn advance(&mut self, elapsed: f64) {
        if self.moves() {
            self.settings.time = self.preferences.clock.advance(self.settings.time, elapsed);
        }
    }

    /// Whether the picture will look different in a moment.
    pub fn moves(&self) -> bool {
        let moving = |loaded: &Loaded| ui::moves(&loaded.scene, self.settings.animation);
        // The playground has no time.
        self.preferences.clock.playing && self.settings.show != Show::Playground && self.loaded.as_ref().is_some_and(moving)
    }

    /// Whether the picture has to be drawn again.
    pub fn is_stale(&self) -> bool {
        self.loaded.is_some() && (self.drawn_from.as_ref() != Some(&self.settings) || self.next_frame.is_some())
    }

    /// Which of the gathered frames is to be drawn: the next one, or the last one again where all are
    /// there; the first where anything has changed.
    pub fn frame(&self) -> u32 {
        match &self.drawn {
            Some(drawn) if self.drawn_from.as_ref() == Some(&self.settings) => {
                self.next_frame.or(drawn.plan.gather.map(|gather| gather.frame)).unwrap_or(0)
            }
            _ => 0,
        }
    }

    /// The settings that draw just what is shown, so many frames gathered.
    fn as_shown(&self) -> Settings {
        let mut settings = self.settings.clone();
        let gathered = |drawn: &Drawn| drawn.plan.gather.map(|gather| gather.frame + 1);
        if self.drawn_from.as_ref() == Some(&self.settings)
            && let Some(frames) = self.drawn.as_ref().and_then(gathered)
        {
            settings.lighting.accumulate = frames;
        }
        settings
    }

    /// The command that draws this picture without a window.
    pub fn command(&self) -> String {
        render_command(&self.settings)
    }

    /// Saves a picture and says where, or why not.
    pub fn save(&mut self, image: &image::RgbaImage) {
        match photo::save(image, &self.settings, &render_command(&self.as_shown())) {
            Ok(path) => self.notice(Topic::Picture, Tone::Good, format!("Saved {}", path.display())),
            Err(error) => self.notice(Topic::Picture, Tone::Error, format!("The picture is not saved: {error}")),
        }
    }

    /// Writes settings that changed a while ago.
    pub fn keep(&mut self, now: Instant) {
        if let Err(words) = self.store.write_if_due(&self.settings, &self.preferences, now) {
            self.notice(Topic::Store, Tone::Warning, words);
        }
    }

    /// What can be done about an action without window and device; gives back the others.
    pub fn act(&mut self, action: Action) -> Option<Action> {
        match action {
            Action::ForgetRecent => self.preferences.recent.clear(),
            Action::Dismiss(topic) => self.dismiss(topic),
            Action::Tell(notice) => self.notice(notice.topic, notice.tone, notice.words),
            other => return Some(other),
        }
        None
    }
}

/// The same scene, named so that it is found again from any folder: settings and recent files are
/// kept, and the next run may start elsewhere.
fn wherever(choice: SceneChoice) -> SceneChoice {
    match choice {
        SceneChoice::File(path) => SceneChoice::File(std::path::absolute(&path).unwrap_or(path)),
        stock @ SceneChoice::Stock(_) => stock,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a failed unwrap is a failed test
    use super::*;
    use crate::settings::CameraChoice;

    fn session() -> Session {
        Session::new(Settings::default(), &WindowOptions::default(), Store::at(None))
    }

    /// Opens, waits, takes.
    fn open(session: &mut Session, choice: SceneChoice, upload: Result<(), String>) -> bool {
        let (woken, wait) = std::sync::mpsc::channel();
        session.open(choice, false, move || woken.send(()).unwrap());
        wait.recv_timeout(std::time::Duration::from_secs(60)).unwrap();
        session.take_opened(|_| upload)
    }

    fn cube(folder: &std::path::Path) -> SceneChoice {
        let path = folder.join("tri.gltf");
        let text = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
            "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
            "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
            "bufferViews":[{"buffer":0,"byteLength":36}],
            "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;
        std::fs::write(&path, text).unwrap();
        SceneChoice::File(path)
    }

    #[test]
    fn a_file_that_cannot_be_opened_leaves_the_running_scene_alone() {
        let folder = tempfile::tempdir().unwrap();
        let mut session = session();
        let good = cube(folder.path());
        assert!(!open(&mut session, good.clone(), Ok(())));
        assert_eq!(session.settings.scene, good);
        let SceneChoice::File(path) = &good else { unreachable!() };
        assert_eq!(&session.preferences.recent, std::slice::from_ref(path));
        session.settings.camera = CameraChoice::Named("0".into());
        let before = session.settings.clone();

        assert!(!open(&mut session, SceneChoice::File(folder.path().join("none.glb")), Ok(())));
        assert_eq!(session.settings, before);
        assert!(session.loaded.is_some());
        assert!(session.notices[0].words.contains("none.glb"), "{:?}", session.notices);

        assert!(!open(&mut session, good, Err("too many triangles".into())));
        assert_eq!(session.settings, before, "nor does one that the device cannot take");
        assert!(session.notices[0].words.contains("too many triangles"));
    }

    #[test]
    fn files_are_remembered_for_runs_from_other_folders() {
        let here = tempfile::tempdir_in(".").unwrap();
        let folder = std::path::Path::new(here.path().file_name().unwrap());
        let relative = cube(folder);
        let mut session =
            Session::new(Settings { scene: relative.clone(), ..Settings::default() }, &WindowOptions::default(), Store::at(None));
        let absolute = std::env::current_dir().unwrap().join(folder).join("tri.gltf");
        assert_eq!(session.settings.scene, SceneChoice::File(absolute.clone()));
        session.settings = Settings::default();
        assert!(!open(&mut session, relative, Ok(())));
        assert_eq!(session.settings.scene, SceneChoice::File(absolute.clone()));
        assert_eq!(session.preferences.recent, [absolute]);
    }

    #[test]
    fn a_failure_is_shown_once_its_scene_is_there() {
        let mut session = session();
        let before = session.settings.clone();
        let (woken, wait) = std::sync::mpsc::channel();
        session.demonstrate(Exhibit::Failure(Failure::DarkCapFan), move || woken.send(()).unwrap());
        assert_eq!(session.settings, before, "not before");
        wait.recv_timeout(std::time::Duration::from_secs(60)).unwrap();
        session.take_opened(|_| Ok(()));
        assert_eq!(session.settings, demonstration(Failure::DarkCapFan, &before));
        session.settings.camera = CameraChoice::Named("inside".into());
        session.settings.failure = None;
        session.demonstrate(Exhibit::Failure(Failure::DarkCapFan), || unreachable!("the scene is there"));
        assert_eq!(session.settings, demonstration(Failure::DarkCapFan, &before), "seen from where it shows well");
    }

    #[test]
    fn a_bad_first_file_calls_for_the_default_scene() {
        let mut session = session();
        assert!(open(&mut session, SceneChoice::File("/nowhere.glb".into()), Ok(())));
        assert_eq!(session.settings.scene, SceneChoice::default());
    }

    #[test]
    fn titles_hold_no_nul() {
        let mut session = session();
        session.settings.scene = SceneChoice::File("/a/b\0c.glb".into());
        assert_eq!(session.title(), "Obscura \u{2014} b\u{fffd}c.glb \u{2014} auto");
    }

    #[test]
    fn a_newer_word_replaces_the_older() {
        let mut session = session();
        session.notice(Topic::Picture, Tone::Good, "one");
        session.notice(Topic::Scene, Tone::Error, "two");
        session.notice(Topic::Picture, Tone::Good, "three");
        let words: Vec<_> = session.notices.iter().map(|notice| notice.words.as_str()).collect();
        assert_eq!(words, ["two", "three"]);
        let now = Instant::now();
        assert!(session.forget_old_news(now).is_some_and(|end| end > now));
        assert_eq!(session.notices.len(), 2);
        assert_eq!(session.forget_old_news(now + GOOD_NEWS), None);
        assert_eq!(session.notices[0].words, "two", "errors stay");
        assert_eq!(session.notices.len(), 1);
    }
}
