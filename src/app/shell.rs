//! The loop: winit's events in, frames out.
//!
//! One frame: time moves on; egui runs the panel, which edits the settings; the scene is staged
//! and drawn where something changed; a frame of the surface is had, the picture copied and the
//! panel painted over it. Whatever the surface or the device answer, [`super::surface`] knows what
//! to do about it.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::time::{Duration, Instant};

use winit::application::ApplicationHandler;
use winit::dpi::LogicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoopProxy};
use winit::window::{Fullscreen, Window, WindowId};

use super::device::{Painted, Screen};
use super::live::{Live, new_egui, run_panel};
use super::pace::{self, Pace};
use super::session::{Drawn, Exhibit, Session};
use super::surface::{AFTER_TIMEOUT, After, Before, SurfaceState};
use super::ui::{Action, FrameNumbers, Tone, Topic, style};
use super::{AppError, Wake, WindowOptions, store};
use crate::director::{Planner, stage_frame};
use crate::frame::Gather;
use crate::headless::HeadlessError;
use crate::headless::verify::Shots;
use crate::settings::{SceneChoice, Show};

/// How often shaders in a folder are looked at.
const SHADER_POLL: Duration = Duration::from_millis(250);

/// How often in a row the device is rebuilt without a frame in between.
const REBUILDS: u32 = 3;

/// The application that winit runs.
pub(super) struct Shell {
    session: Session,
    planner: Planner,
    options: WindowOptions,
    proxy: EventLoopProxy<Wake>,
    live: Option<Live>,
    pace: Pace,
    started: Instant,
    last_frame: Option<Instant>,
    last_picture: Option<Instant>,
    next_shader_poll: Option<Instant>,
    pictures: u64,
    rebuilds: u32,
    failure: Option<AppError>,
}

impl Shell {
    pub fn new(session: Session, options: WindowOptions, proxy: EventLoopProxy<Wake>) -> Self {
        Self {
            session,
            planner: Planner::default(),
            options,
            proxy,
            live: None,
            pace: Pace::default(),
            started: Instant::now(),
            last_frame: None,
            last_picture: None,
            next_shader_poll: None,
            pictures: 0,
            rebuilds: 0,
            failure: None,
        }
    }

    /// What the loop ended with.
    pub fn end(self) -> Result<(), AppError> {
        self.failure.map_or(Ok(()), Err)
    }

    fn fail(&mut self, event_loop: &ActiveEventLoop, error: AppError) {
        self.failure = Some(error);
        event_loop.exit();
    }

    fn waker(&self, wake: Wake) -> impl Fn() + Send + Sync + 'static {
        let proxy = self.proxy.clone();
        move || {
            // A loop that is gone needs no waking.
            let _ = proxy.send_event(wake);
        }
    }

    fn open(&mut self, choice: SceneChoice, keep: bool) {
        let wake = self.waker(Wake::Scene);
        self.session.open(choice, keep, wake);
        self.pace.want(Instant::now());
    }

    fn create_window(&mut self, event_loop: &ActiveEventLoop) -> Result<(), AppError> {
        let [width, height] = self.options.size.or(self.session.preferences.window).unwrap_or([1280, 720]);
        let attributes = Window::default_attributes()
            .with_title(self.session.title())
            .with_inner_size(LogicalSize::new(width, height))
            .with_min_inner_size(LogicalSize::new(480, 320));
        let window = event_loop.create_window(attributes).map_err(|error| AppError::WindowSystem(error.to_string()))?;
        let window = Arc::new(window);
        let context = egui::Context::default();
        style::install(&context);
        let egui = new_egui(context, &window, None);
        let size = window.inner_size().into();
        let title = self.session.title();
        let vsync = self.session.preferences.vsync;
        self.live =
            Some(Live { screen: None, egui, surface: SurfaceState::new(size), surface_gone: false, vsync, title, window });
        self.build_screen()?;
        self.open(self.session.settings.scene.clone(), true);
        Ok(())
    }

    /// Opens the device, and brings the scene to it. What was there before must be gone: a window
    /// bears one surface.
    fn build_screen(&mut self) -> Result<(), AppError> {
        let Some(live) = &mut self.live else { return Ok(()) };
        live.screen = None;
        let settings = &self.session.settings;
        let shaders = settings.shaders.as_deref();
        let (mut screen, shader_error) = Screen::new(&live.window, settings.adapter.as_deref(), shaders, live.vsync)?;
        tracing::info!("drawing with {}", screen.context.capabilities().adapter);
        let proxy = self.proxy.clone();
        screen.context.on_lost(move || {
            // A loop that is gone needs no waking.
            let _ = proxy.send_event(Wake::Device);
        });
        live.egui.set_max_texture_side(screen.max_side() as usize);
        live.surface.recreated();
        live.surface_gone = false;
        if let Some(loaded) = &self.session.loaded
            && let Err(error) = screen.set_scene(&loaded.scene)
        {
            self.session.loaded = None;
            self.session.notice(Topic::Scene, Tone::Error, error.to_string());
        }
        if let Some(live) = &mut self.live {
            live.screen = Some(screen);
        }
        if let Some(words) = shader_error {
            self.session.notice(Topic::Shaders, Tone::Error, words);
        }
        self.session.drawn_from = None;
        self.pace.want(Instant::now());
        Ok(())
    }

    /// The device is gone: everything on it is made anew from the CPU scene.
    fn rebuild(&mut self) -> Result<(), AppError> {
        self.rebuilds += 1;
        if self.rebuilds > REBUILDS {
            return Err(AppError::DeviceLost);
        }
        if let Some(live) = &mut self.live {
            live.screen = None;
            // The painter that is gone had all the panel's textures. A new context sends them
            // again; it keeps what the old one remembered.
            let old = live.egui.egui_ctx().clone();
            let context = egui::Context::default();
            style::install(&context);
            context.memory_mut(|memory| memory.data = old.memory(|memory| memory.data.clone()));
            live.egui = new_egui(context, &live.window, live.egui.egui_input().max_texture_side);
        }
        self.build_screen()?;
        self.session.notice(Topic::Device, Tone::Warning, "The graphics device was lost; everything was built anew.");
        self.take_opened();
        Ok(())
    }

    /// Does what may touch the device, whatever that does about it.
    fn guarded(&mut self, event_loop: &ActiveEventLoop, work: impl FnOnce(&mut Self) -> Result<(), AppError>) {
        // wgpu panics in places when the device is lost under it.
        let result = match catch_unwind(AssertUnwindSafe(|| work(self))) {
            Ok(result) => result,
            Err(panic) => {
                let lost = |live: &Live| live.screen.as_ref().is_some_and(|screen| screen.context.is_lost());
                if !self.live.as_ref().is_some_and(lost) {
                    resume_unwind(panic);
                }
                self.rebuild()
            }
        };
        if let Err(error) = result {
            self.fail(event_loop, error);
        }
    }

    fn frame(&mut self, event_loop: &ActiveEventLoop) -> Result<(), AppError> {
        let now = Instant::now();
        self.pace.begin(now);
        let elapsed = self.last_frame.replace(now).map_or(0.0, |last| (now - last).as_secs_f64());
        let Some(live) = &mut self.live else { return Ok(()) };
        let Some(screen) = &mut live.screen else { return Ok(()) };
        if live.surface.drawable(screen.max_side()).is_none() {
            return Ok(());
        }
        if screen.context.is_lost() {
            return self.rebuild();
        }
        if std::mem::take(&mut live.surface_gone) {
            screen.recreate_surface()?;
            live.surface.recreated();
        }
        // Timestamps and finished work arrive only when somebody asks.
        if let Err(error) = screen.context.device.poll(wgpu::PollType::Poll) {
            tracing::debug!("poll: {error}");
        }
        if let Some(words) = screen.context.take_error() {
            self.session.notice(Topic::Device, Tone::Error, format!("The graphics device reports: {words}"));
        }
        self.session.verification.poll();
        self.session.advance(elapsed);
        if let Some(when) = self.session.forget_old_news(now) {
            self.pace.want(when);
        }

        let (painted, outcome, mut textures) = run_panel(live, &mut self.session, &mut self.pace, now, now - self.started);
        let Some(screen) = &mut live.screen else { return Ok(()) };
        screen.take_textures(&mut textures);
        // Nothing of it may be left when a lost device panics: it asserts so when it is dropped.
        let freed = std::mem::take(&mut textures.free);
        if live.vsync != self.session.preferences.vsync {
            live.vsync = self.session.preferences.vsync;
            screen.set_vsync(live.vsync);
            live.surface.invalidate();
        }
        for action in outcome.actions {
            self.act(event_loop, action);
        }
        if self.session.wants_other_floor() {
            self.open(self.session.settings.scene.clone(), true);
        }
        self.draw_picture(now);
        let shown = self.show(&painted, outcome.picture.min);
        if let Some(screen) = self.live.as_mut().and_then(|live| live.screen.as_mut()) {
            screen.free_textures(freed);
        }
        if shown? {
            self.rebuilds = 0;
        }
        if self.options.frames.is_some_and(|frames| self.pictures >= frames) {
            event_loop.exit();
        }
        if self.session.preferences.continuous
            || self.options.frames.is_some()
            || self.session.moves()
            || self.session.next_frame.is_some()
        {
            self.pace.want(now);
        }
        self.update_title();
        Ok(())
    }

    /// Draws the scene, where it is not the picture that is there already.
    fn draw_picture(&mut self, now: Instant) {
        let session = &mut self.session;
        let always = session.preferences.continuous || self.options.frames.is_some();
        if !session.is_stale() && !always {
            return;
        }
        let Some(screen) = self.live.as_mut().and_then(|live| live.screen.as_mut()) else { return };
        let begun = Instant::now();
        let frame = session.frame();
        let together = session.put_together(|scene| screen.set_scene(scene).map_err(|error| error.to_string()));
        let Some(loaded) = &session.loaded else { return };
        let staged = together.and_then(|()| {
            let capabilities = screen.context.capabilities();
            let staged = self.planner.stage_frame(&session.settings, &loaded.scene, capabilities, frame);
            staged.map_err(|error| error.to_string())
        });
        session.drawn_from = Some(session.settings.clone());
        session.next_frame = None;
        let result = staged.and_then(|(pose, plan)| {
            let staging = begun.elapsed().as_secs_f64() * 1e3;
            let stats = screen.draw(&plan, &loaded.scene, &pose).map_err(|error| error.to_string())?;
            let complexity = match session.settings.show {
                Show::Complexity => Some(screen.tally(&session.settings).map_err(|error| error.to_string())?),
                _ => None,
            };
            Ok((Drawn { pose, plan, complexity }, stats, staging))
        });
        match result {
            Ok((drawn, stats, staging)) => {
                session.next_frame = drawn.plan.gather.and_then(Gather::next);
                if let Some(Drawn { pose, plan, .. }) = session.drawn.replace(drawn) {
                    self.planner.take_back((pose, plan));
                }
                session.dismiss(Topic::Frame);
                if self.pictures == 0 {
                    tracing::info!("first picture drawn");
                }
                self.pictures += 1;
                let interval = self.last_picture.replace(now).map(|last| (now - last).as_secs_f64() * 1e3);
                session.history.push(FrameNumbers {
                    // After a pause there is no interval to speak of.
                    interval_ms: interval.filter(|interval| *interval < 1000.0),
                    cpu_ms: staging + stats.cpu_ms,
                    gpu_ms: stats.gpu_ms,
                    draws: stats.draws,
                    triangles: stats.triangles,
                    volumes: stats.volumes,
                    volume_triangles: stats.volume_triangles,
                });
            }
            Err(words) => session.notice(Topic::Frame, Tone::Error, format!("Cannot draw this: {words}")),
        }
    }

    /// Gets a frame of the surface, and shows picture and panel in it. True where one was shown.
    fn show(&mut self, painted: &Painted, picture_at: egui::Pos2) -> Result<bool, AppError> {
        loop {
            let Some(live) = &mut self.live else { return Ok(false) };
            let Some(screen) = &mut live.screen else { return Ok(false) };
            match live.surface.before(screen.max_side(), screen.context.is_lost()) {
                Before::Skip => return Ok(false),
                Before::Rebuild => return self.rebuild().map(|()| false),
                Before::Configure(size) => screen.configure(size),
                Before::Acquire => {}
            }
            let texture = screen.acquire();
            match (live.surface.after((&texture).into(), screen.context.is_lost()), texture) {
                (After::Draw, wgpu::CurrentSurfaceTexture::Success(frame) | wgpu::CurrentSurfaceTexture::Suboptimal(frame)) => {
                    let at = [picture_at.x, picture_at.y].map(|at| (at * painted.pixels_per_point).round().max(0.0) as u32);
                    screen.present(frame, at, painted);
                    return Ok(true);
                }
                (After::Draw | After::WaitUntilShown, _) => return Ok(false),
                (After::Wait(time), _) => {
                    let when = Instant::now() + time;
                    self.pace.hold(when);
                    self.pace.want(when);
                    return Ok(false);
                }
                (After::Reconfigure, _) => {}
                (After::Recreate, _) => {
                    // Not at once: the window may be gone, and the word of it still on its way.
                    live.surface_gone = true;
                    let when = Instant::now() + AFTER_TIMEOUT;
                    self.pace.hold(when);
                    self.pace.want(when);
                    return Ok(false);
                }
                (After::Rebuild, _) => return self.rebuild().map(|()| false),
                (After::GiveUp, _) => return Err(AppError::SurfaceLost),
            }
        }
    }

    fn act(&mut self, event_loop: &ActiveEventLoop, action: Action) {
        let Some(action) = self.session.act(action) else { return };
        match action {
            Action::Open(choice) => self.open(choice, false),
            Action::Demonstrate(failure) => {
                let wake = self.waker(Wake::Scene);
                self.session.demonstrate(Exhibit::Failure(failure), wake);
            }
            Action::Figure(number) => {
                let wake = self.waker(Wake::Scene);
                self.session.demonstrate(Exhibit::Figure(number), wake);
            }
            Action::Reload => self.open(self.session.settings.scene.clone(), true),
            Action::Screenshot => self.photograph(),
            Action::Verify => self.verify(),
            Action::CopyCommand => {
                let command = self.session.command();
                if let Some(live) = &mut self.live {
                    live.egui.set_clipboard_text(command.clone());
                }
                self.session.notice(Topic::Picture, Tone::Good, format!("Copied: {command}"));
            }
            Action::LoseDevice => {
                if let Some(screen) = self.live.as_ref().and_then(|live| live.screen.as_ref()) {
                    screen.context.device.destroy();
                }
            }
            Action::ToggleFullscreen => {
                if let Some(live) = &self.live {
                    let full = live.window.fullscreen().is_none();
                    live.window.set_fullscreen(full.then_some(Fullscreen::Borderless(None)));
                }
            }
            Action::Quit => event_loop.exit(),
            Action::ForgetRecent | Action::Dismiss(_) | Action::Tell(_) => {}
        }
        self.pace.want(Instant::now());
    }

    /// Draws what is to be verified; a thread of its own casts the rays.
    fn verify(&mut self) {
        // What is found is true of this moment, and shown as long as it lasts.
        self.session.preferences.clock.playing = false;
        let wake = self.waker(Wake::Verified);
        let Some(screen) = self.live.as_mut().and_then(|live| live.screen.as_mut()) else { return };
        let Some(loaded) = &self.session.loaded else { return };
        let (settings, scene) = (self.session.settings.clone(), loaded.scene.clone());
        let capabilities = screen.context.capabilities().clone();
        let lights: Vec<_> = (0..scene.lights_in_force(&settings.mirrors)).collect();
        let drawn = Shots::draw(&settings, &scene, &capabilities, (&[settings.technique], &lights), |plan, pose| {
            screen.photograph(plan, &scene, pose).map_err(HeadlessError::from)
        });
        match drawn {
            Ok(Some(shots)) => self.session.verification.start(scene, shots, settings, wake),
            Ok(None) => {}
            Err(error) => self.session.notice(Topic::Frame, Tone::Error, format!("Cannot verify this: {error}")),
        }
    }

    fn photograph(&mut self) {
        let Some(screen) = self.live.as_mut().and_then(|live| live.screen.as_mut()) else { return };
        let Some(loaded) = &self.session.loaded else { return };
        // The frame on show, drawn again: the mean stays what it is.
        let shown = self.session.drawn.as_ref().filter(|_| self.session.drawn_from.as_ref() == Some(&self.session.settings));
        let frame = shown.and_then(|drawn| drawn.plan.gather).map_or(0, |gather| gather.frame);
        let staged = stage_frame(&self.session.settings, &loaded.scene, screen.context.capabilities(), frame);
        let image = staged
            .map_err(|error| error.to_string())
            .and_then(|(pose, plan)| screen.photograph(&plan, &loaded.scene, &pose).map_err(|error| error.to_string()));
        match image {
            Ok(image) => self.session.save(&image),
            Err(words) => self.session.notice(Topic::Picture, Tone::Error, format!("The picture is not saved: {words}")),
        }
    }

    /// A scene may be there: shows it, or says why not.
    fn take_opened(&mut self) {
        let Some(screen) = self.live.as_mut().and_then(|live| live.screen.as_mut()) else { return };
        if screen.context.is_lost() {
            // It takes no scene; the one that is built in its place does.
            return;
        }
        let needs_another = self.session.take_opened(|scene| screen.set_scene(scene).map_err(|error| error.to_string()));
        if needs_another {
            store::turn_to(&mut self.session.settings, SceneChoice::default());
            self.open(SceneChoice::default(), true);
        }
        self.pace.want(Instant::now());
    }

    fn poll_shaders(&mut self, now: Instant) {
        if self.session.settings.shaders.is_none() || self.next_shader_poll.is_some_and(|next| now < next) {
            return;
        }
        self.next_shader_poll = Some(now + SHADER_POLL);
        let Some(screen) = self.live.as_mut().and_then(|live| live.screen.as_mut()) else { return };
        let scene = self.session.loaded.as_ref().map(|loaded| &*loaded.scene);
        if screen.context.is_lost() {
            return;
        }
        match screen.poll_shaders(scene) {
            None => return,
            Some(Ok(())) => {
                self.session.drawn_from = None;
                self.session.notice(Topic::Shaders, Tone::Good, "Shaders read again.");
            }
            Some(Err(words)) => self.session.notice(Topic::Shaders, Tone::Error, words),
        }
        self.pace.want(now);
    }

    fn update_title(&mut self) {
        let Some(live) = &mut self.live else { return };
        let title = self.session.title();
        if live.title != title {
            live.window.set_title(&title);
            live.title = title;
        }
    }

    /// The shortest time between two frames, on the screen where the window is.
    fn shortest(&self) -> Duration {
        let monitor = self.live.as_ref().and_then(|live| live.window.current_monitor());
        pace::shortest(self.session.preferences.vsync, monitor.and_then(|monitor| monitor.refresh_rate_millihertz()))
    }
}

impl ApplicationHandler<Wake> for Shell {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.live.is_none()
            && let Err(error) = self.create_window(event_loop)
        {
            self.fail(event_loop, error);
        }
    }

    fn user_event(&mut self, event_loop: &ActiveEventLoop, wake: Wake) {
        match wake {
            Wake::Quit => event_loop.exit(),
            Wake::Scene => self.guarded(event_loop, |shell| {
                shell.take_opened();
                Ok(())
            }),
            Wake::Device | Wake::Verified => self.pace.want(Instant::now()),
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(live) = &mut self.live else { return };
        let now = Instant::now();
        if !matches!(event, WindowEvent::RedrawRequested | WindowEvent::Destroyed)
            && live.egui.on_window_event(&live.window, &event).repaint
        {
            self.pace.want(now);
        }
        match event {
            WindowEvent::CloseRequested | WindowEvent::Destroyed => event_loop.exit(),
            WindowEvent::Resized(size) => {
                live.surface.resized(size.into());
                let plain = live.window.fullscreen().is_none() && !live.window.is_maximized();
                if plain && size.width > 0 && size.height > 0 {
                    self.session.preferences.window = Some(size.to_logical::<u32>(live.window.scale_factor()).into());
                }
                self.pace.want(now);
            }
            WindowEvent::Occluded(occluded) => {
                live.surface.occluded(occluded);
                self.pace.want(now);
            }
            WindowEvent::DroppedFile(path) => self.open(SceneChoice::File(path), false),
            WindowEvent::RedrawRequested => self.guarded(event_loop, |shell| shell.frame(event_loop)),
            _ => {}
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let now = Instant::now();
        self.guarded(event_loop, |shell| {
            shell.poll_shaders(now);
            Ok(())
        });
        self.session.keep(now);
        let write = self.session.store.notice(&self.session.settings, &self.session.preferences, now);
        let shaders = self.session.settings.shaders.is_some().then_some(self.next_shader_poll).flatten();
        let frame = self.pace.due(self.shortest());
        if let (Some(due), Some(live)) = (frame, &self.live)
            && due <= now
        {
            live.window.request_redraw();
        }
        let waiting = [write, shaders, frame.filter(|due| *due > now)];
        let next = waiting.into_iter().flatten().min();
        event_loop.set_control_flow(next.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        if let Err(words) = self.session.store.write_now(&self.session.settings, &self.session.preferences) {
            eprintln!("obscura: {words}");
        }
        self.live = None;
    }
}
