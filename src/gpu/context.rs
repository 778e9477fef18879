//! The device: found, opened with what it has, watched for loss and errors.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use thiserror::Error;

use crate::frame::{Capabilities, WideCounts};
use crate::settings::Accumulation;

/// What goes wrong between this program and the device: one line each.
#[derive(Debug, Error)]
pub enum GpuError {
    /// Nothing to draw with.
    #[error("no graphics device: {0}")]
    NoDevice(String),
    /// No adapter's name holds the words asked for.
    #[error("no adapter's name contains `{asked}`; there are: {there}")]
    NoSuchAdapter {
        /// What was asked for.
        asked: String,
        /// The names of those there are.
        there: String,
    },
    /// The window's surface could not be made.
    #[error("cannot draw into the window: {0}")]
    Surface(String),
    /// The scene does not fit the byte budget or the device's limits.
    #[error("the scene is too large for the device: {0}")]
    TooLarge(String),
    /// A shader does not compile: file, line, column, message.
    #[error("shader: {0}")]
    Shader(String),
    /// The device reported an error, was lost, or did not answer.
    #[error("the graphics device failed: {0}")]
    Device(String),
}

/// An open device with its queue.
pub struct Context {
    /// Where the adapter came from.
    pub instance: wgpu::Instance,
    /// What was opened.
    pub adapter: wgpu::Adapter,
    /// The device.
    pub device: wgpu::Device,
    /// Its one queue.
    pub queue: wgpu::Queue,
    capabilities: Capabilities,
    watch: Arc<Watch>,
}

/// What the device's callbacks may touch: they can run under the driver's locks.
#[derive(Default)]
struct Watch {
    lost: AtomicBool,
    error: Mutex<Option<String>>,
    wake: Mutex<Option<Box<dyn Fn() + Send + Sync>>>,
}

/// Linear colour of the scene, wide enough that many lights do not band.
pub const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Linear colour of the scene, as wide as the accumulation asks for.
#[must_use]
pub const fn color_format(accumulation: Accumulation) -> wgpu::TextureFormat {
    match accumulation {
        Accumulation::Float => COLOR_FORMAT,
        Accumulation::EightBit => wgpu::TextureFormat::Rgba8Unorm,
    }
}
/// The mean of many frames: one of a thousand must not be lost in it.
pub const MEAN_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// What is kept of the surfaces that pixels show, packed by the shader: a software device pays several times as much for
/// targets that it must convert to.
pub const GEOMETRY_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;

/// A bit of each light whose shadow a pixel is in: sums of different powers of two, 255ths of one, are exact.
pub const DARK_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// Depth and stencil of the scene. Floats where the device has them: reverse-Z puts the far end near
/// zero, where 24 fixed bits are coarse and surfaces a hair from a volume's face fall on its wrong side
/// (measured against exact rays: 102 wrong pixels of a million became 1).
const fn depth_format(features: wgpu::Features) -> wgpu::TextureFormat {
    if features.contains(wgpu::Features::DEPTH32FLOAT_STENCIL8) {
        wgpu::TextureFormat::Depth32FloatStencil8
    } else {
        wgpu::TextureFormat::Depth24PlusStencil8
    }
}

impl Context {
    /// A device without a window; `adapter` is part of the wanted adapter's name.
    ///
    /// # Errors
    /// No device, or none of that name.
    pub fn headless(adapter: Option<&str>) -> Result<Self, GpuError> {
        let instance = new_instance();
        Self::open(instance, adapter, None)
    }

    /// A device that can draw into `window`, and the window's surface, not yet configured.
    ///
    /// # Errors
    /// No device, none of that name, or none that can draw there.
    pub fn for_window(
        adapter: Option<&str>,
        window: Arc<winit::window::Window>,
    ) -> Result<(Self, wgpu::Surface<'static>), GpuError> {
        let instance = new_instance();
        let surface = instance.create_surface(window).map_err(|error| GpuError::Surface(error.to_string()))?;
        let context = Self::open(instance, adapter, Some(&surface))?;
        Ok((context, surface))
    }

    fn open(instance: wgpu::Instance, wanted: Option<&str>, surface: Option<&wgpu::Surface<'_>>) -> Result<Self, GpuError> {
        let adapter = choose_adapter(&instance, wanted, surface)?;
        let features = adapter.features() & WANTED_FEATURES;
        let limits = wgpu::Limits::default().or_better_values_from(&adapter.limits());
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("obscura"),
            required_features: features,
            required_limits: limits.clone(),
            ..Default::default()
        };
        let (device, queue) =
            pollster::block_on(adapter.request_device(&descriptor)).map_err(|error| GpuError::NoDevice(error.to_string()))?;

        let watch = Arc::new(Watch::default());
        let on_lost = watch.clone();
        device.set_device_lost_callback(move |reason, message| {
            if reason != wgpu::DeviceLostReason::Destroyed {
                tracing::error!("device lost: {message}");
            }
            on_lost.lost.store(true, Ordering::Release);
            on_lost.wake();
        });
        let on_error = watch.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            tracing::error!("{error}");
            let one_line =
                error.to_string().lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join("; ");
            on_error.error.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(one_line);
        }));

        let info = adapter.get_info();
        let four = |format: wgpu::TextureFormat| adapter.get_texture_format_features(format).flags.sample_count_supported(4);
        let blends_float32 = features.contains(wgpu::Features::FLOAT32_BLENDABLE);
        let capabilities = Capabilities {
            adapter: format!("{} ({})", info.name, info.backend),
            depth_clip_control: features.contains(wgpu::Features::DEPTH_CLIP_CONTROL),
            timestamps: features.contains(wgpu::Features::TIMESTAMP_QUERY),
            four_samples: four(COLOR_FORMAT) && four(depth_format(features)),
            float_depth: features.contains(wgpu::Features::DEPTH32FLOAT_STENCIL8),
            wide_counts: if blends_float32 { WideCounts::Float32 } else { WideCounts::Float16 },
            wide_four_samples: four(counts_format(blends_float32))
                && adapter.get_downlevel_capabilities().flags.contains(wgpu::DownlevelFlags::MULTISAMPLED_SHADING),
            compute_silhouettes: computes(&adapter, features, &limits),
            max_size: limits.max_texture_dimension_2d,
        };
        Ok(Self { instance, adapter, device, queue, capabilities, watch })
    }

    /// The format of the scene's depth and stencil.
    #[must_use]
    pub fn depth_format(&self) -> wgpu::TextureFormat {
        depth_format(self.device.features())
    }

    /// What the device can do.
    #[must_use]
    pub fn capabilities(&self) -> &Capabilities {
        &self.capabilities
    }

    /// What [`crate::frame::Target::Counts`] is made of.
    #[must_use]
    pub fn counts_format(&self) -> wgpu::TextureFormat {
        counts_format(self.capabilities.wide_counts == WideCounts::Float32)
    }

    /// Whether the device is gone; everything must then be made anew.
    #[must_use]
    pub fn is_lost(&self) -> bool {
        self.watch.lost.load(Ordering::Acquire)
    }

    /// The first error the device reported since the last call.
    #[must_use]
    pub fn take_error(&self) -> Option<String> {
        self.watch.error.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Calls `wake` when the device is lost, from any thread; it must not touch the device.
    pub fn on_lost(&self, wake: impl Fn() + Send + Sync + 'static) {
        *self.watch.wake.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(wake));
    }

    /// Waits for `submission`, for 30 seconds at most: a software GPU may be slow, but not for ever.
    ///
    /// # Errors
    /// The device does not answer, or is lost.
    pub fn wait(&self, submission: wgpu::SubmissionIndex) -> Result<(), GpuError> {
        self.wait_for(Some(submission))
    }

    /// Waits for everything submitted so far, likewise.
    ///
    /// # Errors
    /// The device does not answer, or is lost.
    pub fn wait_idle(&self) -> Result<(), GpuError> {
        self.wait_for(None)
    }

    fn wait_for(&self, submission_index: Option<wgpu::SubmissionIndex>) -> Result<(), GpuError> {
        if self.is_lost() {
            return Err(GpuError::Device("it was lost".into()));
        }
        let timeout = std::time::Duration::from_secs(30);
        let wait = wgpu::PollType::Wait { submission_index, timeout: Some(timeout) };
        self.device.poll(wait).map(|_| ()).map_err(|error| GpuError::Device(error.to_string()))
    }
}

impl Watch {
    fn wake(&self) {
        if let Some(wake) = &*self.wake.lock().unwrap_or_else(PoisonError::into_inner) {
            wake();
        }
    }
}

/// Used where the device has them; [`Capabilities::lacks`] says what replaces them.
const WANTED_FEATURES: wgpu::Features = wgpu::Features::DEPTH_CLIP_CONTROL
    .union(wgpu::Features::DEPTH32FLOAT_STENCIL8)
    .union(wgpu::Features::TIMESTAMP_QUERY)
    .union(wgpu::Features::INDIRECT_FIRST_INSTANCE)
    .union(wgpu::Features::FLOAT32_BLENDABLE);

/// The bytes that a compute shader's buffers hold at most, where it can find silhouettes.
fn computes(adapter: &wgpu::Adapter, features: wgpu::Features, limits: &wgpu::Limits) -> Option<u64> {
    const BUFFERS: u32 = 8;
    let needed = wgpu::DownlevelFlags::COMPUTE_SHADERS | wgpu::DownlevelFlags::INDIRECT_EXECUTION;
    let there = features.contains(wgpu::Features::INDIRECT_FIRST_INSTANCE)
        && adapter.get_downlevel_capabilities().flags.contains(needed)
        && limits.max_storage_buffers_per_shader_stage >= BUFFERS;
    there.then_some(limits.max_storage_buffer_binding_size.min(limits.max_buffer_size))
}

/// Sums of ones: R32Float where it can be blended, for it is exact to 2^24; else R16Float, which
/// every device blends, exact to 2048.
const fn counts_format(blends_float32: bool) -> wgpu::TextureFormat {
    if blends_float32 { wgpu::TextureFormat::R32Float } else { wgpu::TextureFormat::R16Float }
}

fn new_instance() -> wgpu::Instance {
    wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::PRIMARY,
        flags: wgpu::InstanceFlags::empty().with_env(),
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    })
}

fn choose_adapter(
    instance: &wgpu::Instance,
    wanted: Option<&str>,
    surface: Option<&wgpu::Surface<'_>>,
) -> Result<wgpu::Adapter, GpuError> {
    let Some(wanted) = wanted else {
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            compatible_surface: surface,
            ..Default::default()
        };
        return pollster::block_on(instance.request_adapter(&options)).map_err(|_| {
            let hint = "no Vulkan driver found (./demo installs a software one on Debian and Ubuntu: mesa-vulkan-drivers)";
            GpuError::NoDevice(hint.into())
        });
    };
    let all = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    let names: Vec<_> = all.iter().map(|adapter| adapter.get_info().name).collect();
    all.into_iter()
        .filter(|adapter| surface.is_none_or(|surface| adapter.is_surface_supported(surface)))
        .find(|adapter| adapter.get_info().name.to_lowercase().contains(&wanted.to_lowercase()))
        .ok_or_else(|| GpuError::NoSuchAdapter {
            asked: wanted.into(),
            there: if names.is_empty() { "none".into() } else { names.join(", ") },
        })
}
