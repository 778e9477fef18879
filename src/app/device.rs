//! Everything on the device for one window: surface, renderer, the picture it draws, the panel's painter.
//!
//! The picture is drawn into a texture of its own, of just the size that the panel leaves, and
//! copied into each frame. So nothing is drawn behind the panel, and a panel that changes while
//! the scene does not costs no new picture: on a software GPU that is most of a frame.
//!
//! All of this is lost with the device, and made anew from the CPU scene: [`Screen::new`].

use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui_wgpu::ScreenDescriptor;
use winit::window::Window;

use crate::frame::FramePlan;
use crate::gpu::readback::PICTURE_FORMAT;
use crate::gpu::shaders::Library;
use crate::gpu::{Context, FrameStats, GpuError, Renderer};
use crate::scene::{Pose, Scene};
use crate::settings::Settings;
use crate::techniques::complexity::Tally;

/// What egui drew, ready to be painted.
pub struct Painted {
    /// Triangles.
    pub jobs: Vec<egui::ClippedPrimitive>,
    /// Physical pixels a point.
    pub pixels_per_point: f32,
}

/// The device's side of the window. Fields are dropped in order: surface, panel, renderer, device, window.
pub struct Screen {
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    panel: egui_wgpu::Renderer,
    picture: Option<Picture>,
    /// What the picture is drawn in: a format that does not convert, as [`PICTURE_FORMAT`].
    picture_format: wgpu::TextureFormat,
    /// The picture's texels can be copied into the surface as they are.
    copies: bool,
    renderer: Renderer,
    /// The folder of shaders did not compile when the renderer was made.
    waiting_for: Option<(PathBuf, Library)>,
    /// The device.
    pub context: Context,
    window: Arc<Window>,
}

/// The scene's picture.
struct Picture {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    size: [u32; 2],
    /// Where surfaces take no copies, the panel's painter draws it.
    painted: Option<egui::TextureId>,
}

impl Screen {
    /// Opens the device and makes what does not depend on the scene. Shaders in a folder that do
    /// not compile are left out; the second value says why.
    ///
    /// # Errors
    /// No device, or none that can draw into this window.
    pub fn new(
        window: &Arc<Window>,
        adapter: Option<&str>,
        shaders: Option<&Path>,
        vsync: bool,
    ) -> Result<(Self, Option<String>), GpuError> {
        let (context, surface) = Context::for_window(adapter, window.clone())?;
        let mut error = None;
        let renderer = match Renderer::new(&context, shaders) {
            Err(GpuError::Shader(words)) if shaders.is_some_and(Path::is_dir) => {
                error = Some(words);
                Renderer::new(&context, None)?
            }
            renderer => renderer?,
        };
        let waiting_for = shaders.filter(|_| error.is_some()).map(|folder| (folder.to_path_buf(), Library::new(Some(folder))));
        let capabilities = surface.get_capabilities(&context.adapter);
        let mut config = surface
            .get_default_config(&context.adapter, 1, 1)
            .ok_or_else(|| GpuError::Surface("the device offers no format for it".into()))?;
        // egui blends in gamma space, so it wants a format that does not convert.
        let wanted = [wgpu::TextureFormat::Bgra8Unorm, wgpu::TextureFormat::Rgba8Unorm];
        if let Some(format) = wanted.into_iter().find(|format| capabilities.formats.contains(format)) {
            config.format = format;
        }
        if capabilities.alpha_modes.contains(&wgpu::CompositeAlphaMode::Opaque) {
            config.alpha_mode = wgpu::CompositeAlphaMode::Opaque;
        }
        let plain = config.format.remove_srgb_suffix();
        let copies = wanted.contains(&plain) && capabilities.usages.contains(wgpu::TextureUsages::COPY_DST);
        if copies {
            config.usage |= wgpu::TextureUsages::COPY_DST;
        }
        config.present_mode = present_mode(vsync);
        let picture_format = if copies { plain } else { PICTURE_FORMAT };
        let panel = egui_wgpu::Renderer::new(&context.device, config.format, egui_wgpu::RendererOptions::default());
        let screen = Self {
            surface,
            config,
            panel,
            picture: None,
            picture_format,
            copies,
            renderer,
            waiting_for,
            context,
            window: window.clone(),
        };
        Ok((screen, error))
    }

    /// The longest side of a texture, pixels.
    #[must_use]
    pub fn max_side(&self) -> u32 {
        self.context.capabilities().max_size
    }

    /// Frames wait for the screen, or not; takes effect when the surface is configured next.
    pub fn set_vsync(&mut self, vsync: bool) {
        self.config.present_mode = present_mode(vsync);
    }

    /// Configures the surface.
    pub fn configure(&mut self, [width, height]: [u32; 2]) {
        self.config.width = width;
        self.config.height = height;
        self.surface.configure(&self.context.device, &self.config);
    }

    /// Makes a new surface for the same window.
    ///
    /// # Errors
    /// The window system does not give one.
    pub fn recreate_surface(&mut self) -> Result<(), GpuError> {
        self.surface =
            self.context.instance.create_surface(self.window.clone()).map_err(|error| GpuError::Surface(error.to_string()))?;
        Ok(())
    }

    /// Asks for a frame of the surface, which must be configured.
    #[must_use]
    pub fn acquire(&self) -> wgpu::CurrentSurfaceTexture {
        self.surface.get_current_texture()
    }

    /// Takes the scene to the device.
    ///
    /// # Errors
    /// It does not fit; the one before stays.
    pub fn set_scene(&mut self, scene: &Scene) -> Result<(), GpuError> {
        self.renderer.set_scene(&self.context, scene)
    }

    /// Looks whether shaders of the folder changed; `Err` says what is wrong with them. Where they
    /// were wrong from the start, `scene` goes to the renderer that they make.
    pub fn poll_shaders(&mut self, scene: Option<&Scene>) -> Option<Result<(), String>> {
        let Some((folder, files)) = &mut self.waiting_for else { return self.renderer.poll_shaders(&self.context) };
        if !files.changed() {
            return None;
        }
        match Renderer::new(&self.context, Some(folder)) {
            Ok(renderer) => {
                self.renderer = renderer;
                self.waiting_for = None;
                let set = scene.map_or(Ok(()), |scene| self.renderer.set_scene(&self.context, scene));
                Some(set.map_err(|error| error.to_string()))
            }
            Err(error) => Some(Err(error.to_string())),
        }
    }

    /// Draws the scene's picture, to be shown by [`Self::present`].
    ///
    /// # Errors
    /// See [`Renderer::render`].
    pub fn draw(&mut self, plan: &FramePlan, scene: &Scene, pose: &Pose) -> Result<FrameStats, GpuError> {
        if self.picture.as_ref().is_none_or(|picture| picture.size != plan.size) {
            let old = self.picture.take().and_then(|picture| picture.painted);
            self.picture = Some(self.new_picture(plan.size, old));
        }
        let Some(picture) = &self.picture else { return Err(GpuError::Device("there is no picture to draw".into())) };
        self.renderer.render(&self.context, plan, scene, pose, &picture.view, self.picture_format)
    }

    fn new_picture(&mut self, size: [u32; 2], old: Option<egui::TextureId>) -> Picture {
        let [width, height] = size;
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT
            | if self.copies { wgpu::TextureUsages::COPY_SRC } else { wgpu::TextureUsages::TEXTURE_BINDING };
        let texture = self.context.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("picture"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: self.picture_format,
            usage,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        if let Some(old) = old {
            self.panel.free_texture(&old);
        }
        let painted =
            (!self.copies).then(|| self.panel.register_native_texture(&self.context.device, &view, wgpu::FilterMode::Nearest));
        Picture { texture, view, size, painted }
    }

    /// Depth complexity in numbers, of the picture that was drawn last.
    ///
    /// # Errors
    /// See [`crate::gpu::readback::stencil`].
    pub fn tally(&self, settings: &Settings) -> Result<Tally, GpuError> {
        crate::headless::render::tally(&self.context, &self.renderer, settings)
    }

    /// The texture by which the panel's painter draws the picture, where it cannot be copied.
    #[must_use]
    pub fn painted_picture(&self) -> Option<egui::TextureId> {
        self.picture.as_ref().and_then(|picture| picture.painted)
    }

    /// Takes the panel's new textures; also on frames that are not shown.
    pub fn take_textures(&mut self, textures: &mut egui::TexturesDelta) {
        for (id, deltas) in textures.set.drain() {
            for delta in deltas {
                self.panel.update_texture(&self.context.device, &self.context.queue, id, &delta);
            }
        }
    }

    /// Lets go of textures that the panel needs no more; after their last frame is submitted.
    pub fn free_textures(&mut self, textures: impl IntoIterator<Item = egui::TextureId>) {
        for id in textures {
            self.panel.free_texture(&id);
        }
    }

    /// Copies the picture to `at` (pixels), paints the panel over it, and shows the frame.
    pub fn present(&mut self, frame: wgpu::SurfaceTexture, at: [u32; 2], painted: &Painted) {
        let size = [frame.texture.width(), frame.texture.height()];
        let view = frame.texture.create_view(&wgpu::TextureViewDescriptor::default());
        let device = &self.context.device;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("panel") });
        let descriptor = ScreenDescriptor { size_in_pixels: size, pixels_per_point: painted.pixels_per_point };
        let mut commands = self.panel.update_buffers(device, &self.context.queue, &mut encoder, &painted.jobs, &descriptor);
        {
            let attachments = |load| wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
            };
            let covered = self.picture.as_ref().filter(|_| self.copies).is_some_and(|picture| {
                let room = [0, 1].map(|side| size[side].saturating_sub(at[side]).min(picture.size[side]));
                let [width, height] = room;
                if width == 0 || height == 0 {
                    return false;
                }
                let origin = wgpu::Origin3d { x: at[0], y: at[1], z: 0 };
                let aspect = wgpu::TextureAspect::All;
                encoder.copy_texture_to_texture(
                    wgpu::TexelCopyTextureInfo { texture: &picture.texture, mip_level: 0, origin: wgpu::Origin3d::ZERO, aspect },
                    wgpu::TexelCopyTextureInfo { texture: &frame.texture, mip_level: 0, origin, aspect },
                    wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                );
                true
            });
            // What the picture does not cover, the panel does; a clear would wipe the picture out.
            let load = if covered { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(wgpu::Color::BLACK) };
            let mut pass = encoder
                .begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some("panel"),
                    color_attachments: &[Some(attachments(load))],
                    ..Default::default()
                })
                .forget_lifetime();
            self.panel.render(&mut pass, &painted.jobs, &descriptor);
        }
        commands.push(encoder.finish());
        self.context.queue.submit(commands);
        self.window.pre_present_notify();
        self.context.queue.present(frame);
    }

    /// Draws the plan once more, into a picture that is read back.
    ///
    /// # Errors
    /// See [`crate::gpu::readback::picture`].
    pub fn photograph(&mut self, plan: &FramePlan, scene: &Scene, pose: &Pose) -> Result<image::RgbaImage, GpuError> {
        crate::gpu::readback::picture(&self.context, &mut self.renderer, plan, scene, pose).map(|(_, image)| image)
    }
}

fn present_mode(vsync: bool) -> wgpu::PresentMode {
    if vsync { wgpu::PresentMode::Fifo } else { wgpu::PresentMode::AutoNoVsync }
}
