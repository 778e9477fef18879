//! The program: reads its arguments, opens the window or works without one, reports what went
//! wrong in one line, and says by its exit code what kind of end it was: 0 done, 1 bad input or
//! a failure, 2 wrong usage.

use std::fmt::Display;
use std::io::{self, IsTerminal as _, Write as _};
use std::path::Path;
use std::process::ExitCode;

use obscura::cli::{self, Command, WindowRequest};
use obscura::headless::{self, bench::bench, catalog::Catalog, render::render, sweep::sweep, tour, verify::verify};
use obscura::scene::doctor;
use obscura::techniques::playground;
use serde::Serialize;
use tracing_subscriber::EnvFilter;

fn main() -> ExitCode {
    quiet_device_search();
    keep_freed_memory();
    // Quiet unless asked: RUST_LOG=obscura=info, for example.
    let filter = EnvFilter::try_from_default_env().unwrap_or_else(|_| EnvFilter::new("off"));
    tracing_subscriber::fmt().with_env_filter(filter).with_ansi(io::stderr().is_terminal()).with_writer(io::stderr).init();

    let parsed = match cli::parse(std::env::args_os()) {
        Ok(parsed) => parsed,
        Err(error) => {
            // Help may be piped into a reader that has had enough.
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    match parsed.command().map_err(Failure::from).and_then(run) {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure(message)) => {
            let _ = writeln!(io::stderr(), "obscura: error: {}", one_line(&message));
            ExitCode::FAILURE
        }
    }
}

/// An error's message: here, at the edge, is where it is handled.
struct Failure(String);

impl<E: std::error::Error> From<E> for Failure {
    fn from(error: E) -> Self {
        Self(error.to_string())
    }
}

fn run(command: Command) -> Result<(), Failure> {
    match command {
        Command::Window(request) => window(&request),
        Command::Render { settings, out, json } => {
            let report = render(&settings, &out, json)?;
            match &report.complexity {
                _ if json => print_json(&report),
                Some(tally) => print(&tally.to_string()),
                None => Ok(()),
            }
        }
        Command::Verify { request, json } => {
            let report = verify(&request)?;
            print_as(&report, json)?;
            match report.broken_promises() {
                0 => Ok(()),
                wrong => Err(Failure(format!("{wrong} pixels are wrong by techniques that claim to be exact"))),
            }
        }
        Command::Bench { request, json } => print_as(&bench(&request)?, json),
        Command::Sweep { request, json } => print_as(&sweep(&request)?, json),
        Command::Playground { settings, out, calls } => {
            if let Some(out) = out {
                render(&settings, &out, false)?;
            }
            match calls {
                Some(api) => print(&playground::calls::calls(&settings.playground.board, api)),
                None => Ok(()),
            }
        }
        Command::List { json } => print_as(&Catalog::new(), json),
        Command::Info { scene, floor, json } => print_as(&doctor::report(&headless::open_scene(&scene, floor)?), json),
        Command::Tour { out } => take_tour(&out),
        Command::Figures { figures, size, out } => {
            let files = headless::figures::figures(&figures, size, &out)?;
            let folder = out.canonicalize().unwrap_or(out);
            print(&format!("{} figures, and {} that shows them, in {}\n", files.len(), headless::figures::PAGE, folder.display()))
        }
    }
}

/// The window where there is a display; else the tour, if nothing in particular was asked for.
fn window(request: &WindowRequest) -> Result<(), Failure> {
    if has_display() {
        let (settings, options) = obscura::app::start(request)?;
        if request.names_scene() {
            // A typing mistake; what is wrong with a file that is there, the panel says.
            headless::check_exists(&settings.scene)?;
        }
        Ok(obscura::app::run(settings, options)?)
    } else if request.bare {
        take_tour(Path::new("out"))
    } else {
        Err(Failure("there is no display for a window; `obscura render SCENE --out FILE.png` draws without one".into()))
    }
}

/// Mesa's device selection layer asks Wayland for the preferred GPU, and libwayland complains on
/// stderr where there is no `XDG_RUNTIME_DIR`. Without a display there is nothing to ask: the layer is
/// told to stand aside, so that one error stays one line.
#[allow(unsafe_code)] // the process has one thread here
fn quiet_device_search() {
    if !has_display() && std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        // SAFETY: nothing else reads or writes the environment before main goes on.
        unsafe { std::env::set_var("NODEVICE_SELECT", "1") };
    }
}

/// A software GPU lists a frame's triangles in blocks of 64 KiB that it frees when they are drawn. By its defaults the C
/// library gives the top of the heap back to the system each time, and every page of it costs a fault in the next frame:
/// 9,000 of them, and a third of the frame, where there are 200,000 triangles.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[allow(unsafe_code)] // the C library's own call
fn keep_freed_memory() {
    /// Bytes: as much as the triangles of a frame may well take.
    const KEPT: libc::c_int = 256 << 20;
    // A user's own choice goes first.
    if std::env::var_os("MALLOC_TRIM_THRESHOLD_").is_none() {
        // SAFETY: it changes when memory is given back, and nothing else.
        unsafe { libc::mallopt(libc::M_TRIM_THRESHOLD, KEPT) };
    }
}

#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
fn keep_freed_memory() {}

fn has_display() -> bool {
    let named = |variable| std::env::var_os(variable).is_some_and(|value| !value.is_empty());
    cfg!(any(windows, target_os = "macos")) || named("DISPLAY") || named("WAYLAND_DISPLAY") || named("WAYLAND_SOCKET")
}

fn take_tour(out: &Path) -> Result<(), Failure> {
    let files = tour::tour(out)?;
    let folder = out.canonicalize().unwrap_or_else(|_| out.into());
    print(&format!("{} pictures in {}\n", files.len(), folder.display()))
}

fn print_as<T: Display + Serialize>(value: &T, json: bool) -> Result<(), Failure> {
    if json { print_json(value) } else { print(&value.to_string()) }
}

fn print_json<T: Serialize>(value: &T) -> Result<(), Failure> {
    print(&(serde_json::to_string_pretty(value)? + "\n"))
}

/// Writes to stdout; a reader that has had enough (`obscura list | head -1`) is no error.
fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => Ok(result?),
    }
}

/// One line, whatever names and drivers put into it.
fn one_line(message: &str) -> String {
    let words: Vec<_> = message.split_whitespace().collect();
    words.join(" ").chars().map(|letter| if letter.is_control() { '\u{fffd}' } else { letter }).collect()
}
