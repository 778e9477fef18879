//! The window: a winit loop around the same settings, scene, plan and renderer that the headless
//! commands use.
//!
//! ```text
//!   winit events -> shell -> egui -> ui::Panel -> Settings, Actions
//!                     |                              |
//!                   pace, surface                 session -> director::stage -> device -> frame
//! ```
//!
//! - [`surface`] decides what to do about the window's surface, [`pace`] when to draw: both
//!   without a GPU;
//! - [`control`], [`keys`] and [`clock`] turn input into settings, [`ui`] is the panel;
//! - [`verify`] holds the picture against exact rays;
//! - [`store`] keeps settings between runs, `session` holds what is shown, without a window;
//! - [`device`] is everything that is lost with the device, `shell` the loop around it all.

pub mod clock;
pub mod control;
pub mod device;
pub mod keys;
mod live;
pub mod pace;
pub mod photo;
mod session;
mod shell;
pub mod store;
pub mod surface;
pub mod ui;
pub mod verify;

use thiserror::Error;
use winit::event_loop::{EventLoop, EventLoopProxy};

use crate::cli::{InputError, WindowRequest};
use crate::gpu::GpuError;
use crate::settings::Settings;
use session::Session;
use shell::Shell;
use store::Store;

/// How the window is opened.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct WindowOptions {
    /// Logical pixels; else the size it had last.
    pub size: Option<[u32; 2]>,
    /// Whether frames wait for the screen; else as it was last.
    pub vsync: Option<bool>,
    /// The window closes after this many pictures, drawn one after the other: for tests and timing.
    pub frames: Option<u64>,
}

/// Why there is no window, or no more: one line each.
#[derive(Debug, Error)]
pub enum AppError {
    /// Neither a Wayland socket nor an X server.
    #[error("there is no display for a window: neither WAYLAND_DISPLAY nor DISPLAY names one")]
    NoDisplay,
    /// The window system refused.
    #[error("the window system refuses a window: {0}")]
    WindowSystem(String),
    /// The device refused.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The surface was lost and does not come back.
    #[error("the window's surface was lost, and does not come back")]
    SurfaceLost,
    /// The device was lost again and again.
    #[error("the graphics device was lost, and is lost again whenever it is rebuilt")]
    DeviceLost,
}

/// What wakes the loop from other threads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wake {
    /// A signal asks the program to end.
    Quit,
    /// A scene is there, or why there is none.
    Scene,
    /// The device was lost.
    Device,
    /// Rays have something to say.
    Verified,
}

/// What the window starts with: the last run's settings, and over them what the arguments say.
///
/// # Errors
/// Arguments that name nothing or lie out of range.
pub fn start(request: &WindowRequest) -> Result<(Settings, WindowOptions), InputError> {
    let (stored, _) = Store::of_user().load();
    let settings = request.settings(stored.settings)?;
    let size = (settings.size != Settings::default().size).then_some(settings.size);
    Ok((settings, WindowOptions { size, vsync: request.vsync, frames: request.frames }))
}

/// Opens the window and stays until it is closed.
///
/// # Errors
/// No display, no device, or one that is lost for good.
pub fn run(settings: Settings, options: WindowOptions) -> Result<(), AppError> {
    let event_loop = event_loop()?;
    event_loop.set_control_flow(winit::event_loop::ControlFlow::Wait);
    let proxy = event_loop.create_proxy();
    watch_signals(proxy.clone());
    let session = Session::new(settings, &options, Store::of_user());
    let mut shell = Shell::new(session, options, proxy);
    event_loop.run_app(&mut shell).map_err(|error| AppError::WindowSystem(error.to_string()))?;
    shell.end()
}

/// winit builds one event loop a process, so which window system it is must be known before: a
/// Wayland compositor that answers, else an X server.
fn event_loop() -> Result<EventLoop<Wake>, AppError> {
    let mut builder = EventLoop::<Wake>::with_user_event();
    #[cfg(all(unix, not(target_os = "macos")))]
    {
        use winit::platform::wayland::EventLoopBuilderExtWayland as _;
        use winit::platform::x11::EventLoopBuilderExtX11 as _;
        let named = |variable| std::env::var_os(variable).is_some_and(|value| !value.is_empty());
        if wayland_answers() {
            builder.with_wayland();
        } else if named("DISPLAY") {
            builder.with_x11();
        } else {
            return Err(AppError::NoDisplay);
        }
    }
    builder.build().map_err(|error| AppError::WindowSystem(error.to_string()))
}

#[cfg(all(unix, not(target_os = "macos")))]
fn wayland_answers() -> bool {
    use std::path::PathBuf;
    if std::env::var_os("WAYLAND_SOCKET").is_some_and(|socket| !socket.is_empty()) {
        return true;
    }
    let Some(name) = std::env::var_os("WAYLAND_DISPLAY").filter(|name| !name.is_empty()) else { return false };
    let folder = std::env::var_os("XDG_RUNTIME_DIR").map(PathBuf::from).unwrap_or_default();
    // An absolute name replaces the folder.
    std::os::unix::net::UnixStream::connect(folder.join(name)).is_ok()
}

/// SIGTERM, SIGINT and SIGHUP end the window as its close button does.
fn watch_signals(proxy: EventLoopProxy<Wake>) {
    #[cfg(unix)]
    {
        use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
        let signals = signal_hook::iterator::Signals::new([SIGTERM, SIGINT, SIGHUP]);
        let watched = signals.and_then(|mut signals| {
            std::thread::Builder::new().name("signals".into()).spawn(move || {
                for _ in signals.forever() {
                    // A loop that is gone needs no waking.
                    let _ = proxy.send_event(Wake::Quit);
                }
            })
        });
        if let Err(error) = watched {
            tracing::warn!("signals end the program at once: {error}");
        }
    }
    #[cfg(not(unix))]
    drop(proxy);
}
