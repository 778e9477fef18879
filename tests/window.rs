//! The real window on a virtual X server: opens, draws, resizes, obeys keys, saves pictures, ends cleanly.
//!
//! Needs `Xvfb` and `xdotool`; without them these tests say so and do nothing, unless
//! `OBSCURA_REQUIRE_WINDOW=1` (which `./check` sets) makes that a failure.

#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // a failed unwrap is a failed test

use std::collections::HashSet;
use std::io::{BufRead as _, BufReader, Read as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use obscura::headless::read_command;
use x11rb::connection::Connection as _;
use x11rb::protocol::xproto::{ClientMessageEvent, ConnectionExt as _, EventMask, ImageFormat, Window};
use x11rb::rust_connection::RustConnection;

/// How long anything may take: the machine may be busy, and its GPU be software.
const PATIENCE: Duration = Duration::from_secs(90);

/// Repeats until there is an answer.
fn wait<T>(what: &str, mut look: impl FnMut() -> Option<T>) -> T {
    let end = Instant::now() + PATIENCE;
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(Instant::now() < end, "waited in vain for {what}");
        std::thread::sleep(Duration::from_millis(40));
    }
}

/// A virtual X server, ended with the test.
struct Server {
    child: Child,
    display: String,
    connection: RustConnection,
    root: Window,
}

impl Server {
    /// None where the tools are missing, which is said.
    fn start() -> Option<Self> {
        let there = |tool: &str, argument: &str| {
            Command::new(tool).arg(argument).stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok()
        };
        if !there("xdotool", "version") || !there("Xvfb", "-help") {
            let words = "Xvfb or xdotool is missing: the window is not tested";
            assert!(std::env::var("OBSCURA_REQUIRE_WINDOW").as_deref() != Ok("1"), "{words}");
            eprintln!("{words}");
            return None;
        }
        let mut child = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1280x800x24", "-nolisten", "tcp"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let display = format!(":{}", line.trim());
        let (connection, screen) = RustConnection::connect(Some(&display)).unwrap();
        let root = connection.setup().roots[screen].root;
        Some(Self { child, display, connection, root })
    }

    fn title(&self, window: Window) -> Option<String> {
        let atom = |name: &[u8]| Some(self.connection.intern_atom(false, name).ok()?.reply().ok()?.atom);
        let (name, utf8) = (atom(b"_NET_WM_NAME")?, atom(b"UTF8_STRING")?);
        let property = self.connection.get_property(false, window, name, utf8, 0, 1024).ok()?.reply().ok()?;
        String::from_utf8(property.value).ok().filter(|title| !title.is_empty())
    }

    fn size(&self, window: Window) -> (u16, u16) {
        let geometry = self.connection.get_geometry(window).unwrap().reply().unwrap();
        (geometry.width, geometry.height)
    }

    /// The window's pixels, row by row, as the screen shows them.
    fn pixels(&self, window: Window) -> Option<Vec<[u8; 3]>> {
        let (width, height) = self.size(window);
        let image = self.connection.get_image(ImageFormat::Z_PIXMAP, window, 0, 0, width, height, !0).ok()?.reply().ok()?;
        Some(image.data.chunks_exact(4).map(|pixel| [pixel[2], pixel[1], pixel[0]]).collect())
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The program, with a folder of its own for settings and pictures.
struct Program<'a> {
    server: &'a Server,
    child: Child,
    window: Window,
    folder: PathBuf,
}

impl<'a> Program<'a> {
    fn start(server: &'a Server, folder: &Path, arguments: &[&str]) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_obscura"))
            .args(arguments)
            .current_dir(folder)
            .env("DISPLAY", &server.display)
            .env("OBSCURA_CONFIG_DIR", folder.join("config"))
            .env("HOME", folder)
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let window = wait("a window", || {
            assert!(child.try_wait().unwrap().is_none(), "the program ended: {}", rest(&mut child));
            let tree = server.connection.query_tree(server.root).unwrap().reply().unwrap();
            tree.children.into_iter().find(|window| server.title(*window).is_some_and(|title| title.starts_with("Obscura")))
        });
        Self { server, child, window, folder: folder.to_path_buf() }
    }

    fn title(&self) -> String {
        self.server.title(self.window).unwrap_or_default()
    }

    fn wait_title(&self, words: &str) {
        wait(&format!("`{words}` in the title, which is `{}`", self.title()), || self.title().contains(words).then_some(()));
    }

    /// Runs xdotool on the window.
    fn xdotool(&self, arguments: &[&str]) {
        let status = Command::new("xdotool").args(arguments).env("DISPLAY", &self.server.display).status().unwrap();
        assert!(status.success(), "xdotool {arguments:?}");
    }

    fn key(&self, key: &str) {
        let window = self.window.to_string();
        self.xdotool(&["windowfocus", "--sync", &window]);
        self.xdotool(&["key", key]);
    }

    /// The picture's pixels (right of the panel), once it is drawn and stands still.
    fn picture(&self) -> Vec<[u8; 3]> {
        let mut last = Vec::new();
        wait("a picture that stands still", || {
            std::thread::sleep(Duration::from_millis(250));
            let now = self.right_half()?;
            let drawn = now.iter().collect::<HashSet<_>>().len() > 100;
            let still = std::mem::replace(&mut last, now) == last;
            (drawn && still).then(|| last.clone())
        })
    }

    fn right_half(&self) -> Option<Vec<[u8; 3]>> {
        let width = usize::from(self.server.size(self.window).0);
        let pixels = self.server.pixels(self.window)?;
        Some(pixels.chunks_exact(width).flat_map(|row| &row[width / 2..]).copied().collect())
    }

    /// Waits until something is drawn, moving or not.
    fn draws(&self) {
        wait("a picture", || (self.right_half()?.iter().collect::<HashSet<_>>().len() > 100).then_some(()));
    }

    /// Waits for the end: the exit code, and what was written to stderr.
    fn end(mut self) -> (Option<i32>, String) {
        let status = wait("the program to end", || self.child.try_wait().unwrap());
        let words = rest(&mut self.child);
        (status.code(), words)
    }

    fn signal(&self, name: &str) {
        assert!(Command::new("kill").args([&format!("-{name}"), &self.child.id().to_string()]).status().unwrap().success());
    }

    /// Processor seconds used so far.
    fn processor_seconds(&self) -> f64 {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.child.id())).unwrap();
        let fields: Vec<_> = stat.rsplit(')').next().unwrap().split_whitespace().collect();
        // Fields 14 and 15 of proc(5), counted from field 3 on; 100 ticks a second on Linux.
        fields[11..13].iter().map(|ticks| ticks.parse::<f64>().unwrap()).sum::<f64>() / 100.0
    }
}

impl Drop for Program<'_> {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn rest(child: &mut Child) -> String {
    let mut words = String::new();
    if let Some(stderr) = &mut child.stderr {
        let _ = stderr.read_to_string(&mut words);
    }
    words
}

/// What the program itself wrote, apart from what drivers and libraries say.
fn own_words(stderr: &str) -> Vec<&str> {
    stderr.lines().filter(|line| line.contains("obscura") || line.contains("panicked")).collect()
}

fn differing(a: &[[u8; 3]], b: &[[u8; 3]]) -> usize {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 24)).count()
}

#[test]
fn it_draws_obeys_keys_saves_pictures_and_remembers() {
    let Some(server) = Server::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    let program = Program::start(&server, folder.path(), &["eye-in-shadow", "--size", "960x600"]);
    program.draws();
    program.key("space");
    program.key("3");
    program.wait_title("eye-in-shadow \u{2014} z-fail");
    let right = program.picture();
    program.key("2");
    program.wait_title("eye-in-shadow \u{2014} z-pass");
    let wrong = program.picture();
    let changed = differing(&right, &wrong);
    assert!(changed > right.len() / 50, "z-pass fails here, and so must be seen to: {changed} of {} pixels", right.len());
    program.key("4");
    program.wait_title("exact-z-pass");
    let exact = program.picture();
    assert!(differing(&right, &exact) < right.len() / 500, "exact z-pass is right again");

    program.key("F12");
    let pictures = || -> Vec<PathBuf> {
        let entries = std::fs::read_dir(&program.folder).unwrap();
        entries.map(|entry| entry.unwrap().path()).filter(|path| path.extension().is_some_and(|kind| kind == "png")).collect()
    };
    let picture = wait("a saved picture", || pictures().pop());
    let image = image::open(&picture).unwrap().to_rgb8();
    assert!(
        image.width() > 400 && image.width() < 960 && image.height() == 600,
        "{:?}: the panel is left out",
        image.dimensions()
    );
    assert!(image.pixels().collect::<HashSet<_>>().len() > 100);
    let command = read_command(&picture).unwrap().unwrap();
    assert!(command.starts_with("obscura render eye-in-shadow"), "{command}");
    assert!(command.contains("--technique exact-z-pass"), "{command}");

    program.signal("TERM");
    let (code, words) = program.end();
    assert_eq!(code, Some(0), "{words}");
    assert!(own_words(&words).is_empty(), "{words}");

    let program = Program::start(&server, folder.path(), &[]);
    program.wait_title("eye-in-shadow \u{2014} exact-z-pass");
    program.draws();
    program.key("ctrl+q");
    assert_eq!(program.end().0, Some(0));
}

#[test]
fn it_survives_resizes_hiding_and_a_lost_device() {
    let Some(server) = Server::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    let program = Program::start(&server, folder.path(), &["cubes", "--size", "800x500"]);
    program.draws();
    let window = program.window.to_string();
    for (width, height) in [(1000, 700), (500, 330), (1200, 640), (1201, 641)] {
        program.xdotool(&["windowsize", &window, &width.to_string(), &height.to_string()]);
        wait("the new size", || (server.size(program.window) == (width, height)).then_some(()));
        program.draws();
    }
    program.xdotool(&["windowunmap", "--sync", &window]);
    std::thread::sleep(Duration::from_millis(300));
    program.xdotool(&["windowmap", "--sync", &window]);
    program.draws();
    for technique in ["1", "3"] {
        program.key("F9");
        program.key(technique);
        program.wait_title(if technique == "1" { "none" } else { "z-fail" });
        program.draws();
    }

    // Nothing moves, nothing is drawn: no core burns.
    program.key("space");
    program.picture();
    std::thread::sleep(Duration::from_secs(1));
    let before = program.processor_seconds();
    std::thread::sleep(Duration::from_secs(2));
    let used = program.processor_seconds() - before;
    assert!(used < 0.2, "a window that stands still used {used} of 2 seconds");

    close(&server, program.window);
    let (code, words) = program.end();
    assert_eq!(code, Some(0), "{words}");
    assert!(!words.contains("panicked"), "{words}");
}

/// Asks as a window manager does when its close button is pressed.
fn close(server: &Server, window: Window) {
    let atom = |name: &[u8]| server.connection.intern_atom(false, name).unwrap().reply().unwrap().atom;
    let data = [atom(b"WM_DELETE_WINDOW"), 0, 0, 0, 0];
    let message = ClientMessageEvent::new(32, window, atom(b"WM_PROTOCOLS"), data);
    server.connection.send_event(false, window, EventMask::NO_EVENT, message).unwrap();
    server.connection.flush().unwrap();
}

#[test]
fn a_bad_file_leaves_a_scene_running() {
    let Some(server) = Server::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("broken.glb"), b"glTF but not really").unwrap();
    let program = Program::start(&server, folder.path(), &["broken.glb", "--size", "700x450"]);
    program.wait_title("courtyard");
    program.draws();
    let window = program.window.to_string();
    program.xdotool(&["windowclose", &window]);
    let (code, words) = program.end();
    assert_eq!(code, Some(0), "{words}");
    assert!(own_words(&words).iter().any(|line| line.contains("broken.glb")), "{words}");
    assert!(!words.contains("panicked"), "{words}");
}

#[test]
fn it_ends_after_so_many_frames() {
    let Some(server) = Server::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    let program = Program::start(&server, folder.path(), &["cubes", "--frames", "5", "--size", "600x400", "--vsync", "off"]);
    assert_eq!(program.end().0, Some(0));
}

#[test]
fn no_display_is_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_obscura"))
        .args(["cubes"])
        .env("DISPLAY", ":4242")
        .env("OBSCURA_CONFIG_DIR", folder.path())
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .output()
        .unwrap();
    let words = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{words}");
    assert_eq!(own_words(&words).len(), 1, "{words}");
}
