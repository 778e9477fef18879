//! Carries plans out on the device. Nothing here decides what is drawn: the plan does.
//!
//! [`Context`] is the device, [`Renderer`] everything made on it for one scene. A lost device is
//! dealt with by making both anew from the CPU scene.

mod compute;
pub mod context;
mod cutouts;
mod encode;
mod encode_volumes;
mod frame_buffers;
mod growing;
mod kept;
mod labels;
mod lines;
mod merged;
pub mod pipelines;
mod portions;
pub mod readback;
mod scene_buffers;
pub mod shaders;
mod slides;
mod targets;
mod texture;
mod timing;
pub mod types;
mod uniforms;

use std::path::Path;
use std::time::Instant;

use serde::Serialize;

pub use context::{Context, GpuError};
use frame_buffers::FrameBuffers;
use labels::Labels;
use lines::Lines;
use pipelines::Pipelines;
use scene_buffers::SceneBuffers;
use shaders::Library;
pub use targets::Targets;
use texture::Samplers;
use timing::Timing;

use crate::frame::{FramePlan, Method, Target};
use crate::scene::{Pose, Scene};

/// What one frame took.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct FrameStats {
    /// Draw calls.
    pub draws: u32,
    /// Triangles drawn, volumes included, once for each pass; of volumes whose silhouettes the device finds none until
    /// [`readback::add_computed`] has asked it.
    pub triangles: u64,
    /// Shadow volumes counted.
    pub volumes: u32,
    /// Triangles of shadow volumes, likewise.
    pub volume_triangles: u64,
    /// Indices of shadow volumes built, likewise.
    pub indices: u64,
    /// Their bytes: two an index for casters of up to 32768 vertices, four for others.
    pub index_bytes: u64,
    /// Milliseconds of this thread: volumes built, uploads, recording, submission.
    pub cpu_ms: f64,
    /// Milliseconds of the device, of the newest frame that has reported; none without timestamps.
    pub gpu_ms: Option<f64>,
}

impl FrameStats {
    /// Of two frames that make one picture.
    fn and(self, second: Self) -> Self {
        Self {
            draws: self.draws + second.draws,
            triangles: self.triangles + second.triangles,
            volumes: self.volumes + second.volumes,
            volume_triangles: self.volume_triangles + second.volume_triangles,
            indices: self.indices + second.indices,
            index_bytes: self.index_bytes + second.index_bytes,
            cpu_ms: self.cpu_ms + second.cpu_ms,
            gpu_ms: second.gpu_ms,
        }
    }
}

/// Everything made on the device for drawing.
pub struct Renderer {
    library: Library,
    pipelines: Pipelines,
    samplers: Samplers,
    scene: Option<SceneBuffers>,
    frame: FrameBuffers,
    /// The same of the scene's partner.
    partner: Option<Box<(SceneBuffers, FrameBuffers)>>,
    labels: Labels,
    lines: Lines,
    targets: Option<Targets>,
    timing: Timing,
}

impl Renderer {
    /// Compiles the shaders, from `shaders` where that folder has them.
    ///
    /// # Errors
    /// A shader that does not compile.
    pub fn new(context: &Context, shaders: Option<&Path>) -> Result<Self, GpuError> {
        if let Some(folder) = shaders
            && !folder.is_dir()
        {
            return Err(GpuError::Shader(format!("{}: not a folder", folder.display())));
        }
        let library = Library::new(shaders);
        let pipelines = Pipelines::new(context, &library)?;
        Ok(Self {
            library,
            pipelines,
            samplers: Samplers::default(),
            scene: None,
            frame: FrameBuffers::default(),
            partner: None,
            labels: Labels::default(),
            lines: Lines::default(),
            targets: None,
            timing: Timing::new(context),
        })
    }

    /// Uploads a scene; the one before stays until the new one is there.
    ///
    /// # Errors
    /// A scene that does not fit the device.
    pub fn set_scene(&mut self, context: &Context, scene: &Scene) -> Result<(), GpuError> {
        let memory = context.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let mut upload = |scene| SceneBuffers::new(context, &self.pipelines.material_layout, &mut self.samplers, scene);
        let buffers = upload(scene);
        let partner = scene.partner.as_deref().map(upload).transpose();
        if let Some(error) = pollster::block_on(memory.pop()) {
            return Err(GpuError::TooLarge(format!("it is out of memory: {error}")));
        }
        self.scene = Some(buffers?);
        self.partner = partner?.map(|buffers| Box::new((buffers, FrameBuffers::default())));
        if let Some(targets) = &mut self.targets {
            // It reads the materials of the scene before.
            targets.geometry = None;
        }
        self.frame.forget_scene();
        Ok(())
    }

    /// Draws the plan into `output`, a view of `format` and the plan's size, and submits it; and so the plan of the scene's
    /// partner, where one comes after it. `scene` is the one that was set.
    ///
    /// # Errors
    /// Targets that do not fit, a device that is lost.
    pub fn render(
        &mut self,
        context: &Context,
        plan: &FramePlan,
        scene: &Scene,
        pose: &Pose,
        output: &wgpu::TextureView,
        format: wgpu::TextureFormat,
    ) -> Result<FrameStats, GpuError> {
        let first = self.render_alone(context, plan, scene, pose, output, format)?;
        let Some(then) = &plan.then else { return Ok(first) };
        let (Some(scene), Some(pose), Some(mut partner)) = (&scene.partner, &pose.partner, self.partner.take()) else {
            return Err(GpuError::Device("the scene's partner was not set".into()));
        };
        let mut exchange = |renderer: &mut Self| {
            if let Some(scene) = &mut renderer.scene {
                std::mem::swap(scene, &mut partner.0);
            }
            std::mem::swap(&mut renderer.frame, &mut partner.1);
        };
        exchange(self);
        let second = self.render_alone(context, then, scene, pose, output, format);
        exchange(self);
        self.partner = Some(partner);
        Ok(first.and(second?))
    }

    fn render_alone(
        &mut self,
        context: &Context,
        plan: &FramePlan,
        scene: &Scene,
        pose: &Pose,
        output: &wgpu::TextureView,
        format: wgpu::TextureFormat,
    ) -> Result<FrameStats, GpuError> {
        if context.is_lost() {
            return Err(GpuError::Device("it was lost".into()));
        }
        let begun = Instant::now();
        let shape = targets::Shape::of(plan);
        if self.targets.as_ref().is_none_or(|targets| targets.shape != shape) {
            self.targets = None;
            self.targets = Some(Targets::new(context, &self.pipelines.targets_layout, shape)?);
        }
        let (Some(targets), Some(buffers)) = (&mut self.targets, &mut self.scene) else {
            return Err(GpuError::Device("no scene was set".into()));
        };
        if plan.draws().any(|(_, draw)| draw.target == Target::Counts) {
            targets.with_counts(context, &self.pipelines.counts_layouts);
        }
        if plan.draws().any(|(_, draw)| draw.target == Target::Solid) {
            targets.with_solid(context, &self.pipelines.solid_layouts);
        }
        if plan.draws().any(|(_, draw)| draw.target == Target::Geometry) {
            targets.with_geometry(context, &self.pipelines.geometry_layout, &buffers.all_materials);
        }
        let kept: Vec<_> = plan.views.iter().filter(|view| view.texture.is_some()).map(|view| view.picture).collect();
        targets.with_reflections(context, &self.pipelines.reflection_layout, &kept);
        for (instance, (node, _, mesh)) in scene.instances().enumerate() {
            buffers.pose(context, instance, mesh, pose.deformed[node].as_ref());
        }
        self.frame.write(context, &self.pipelines.frame_layout, buffers, plan, scene, pose)?;

        self.labels.write(context, &self.pipelines.labels_layout, plan);
        self.lines.write(context, plan);

        let mut encoder = context.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("frame") });
        let begun_before = self.frame.compute.dispatch(context, &self.pipelines, &mut encoder, self.timing.begins());
        let work = encode::Encode {
            begun_before,
            context,
            pipelines: &mut self.pipelines,
            buffers,
            frame: &self.frame,
            labels: &self.labels,
            lines: &self.lines,
            targets,
            output,
            format,
            timing: &self.timing,
        };
        let drawn = encode::encode(work, plan, scene, &mut encoder);
        let slot = self.timing.resolve(&mut encoder);
        context.queue.submit([encoder.finish()]);
        self.timing.read(slot);
        let volumes = plan.volumes.iter().filter(|volume| volume.method != Method::Dropped).count();
        let [indices, index_bytes] = self.frame.index_count();
        Ok(FrameStats {
            draws: drawn.draws,
            triangles: drawn.triangles,
            volumes: u32::try_from(volumes).unwrap_or(u32::MAX),
            volume_triangles: drawn.volume_triangles,
            indices,
            index_bytes,
            cpu_ms: begun.elapsed().as_secs_f64() * 1e3,
            gpu_ms: self.timing.latest(),
        })
    }

    /// Looks whether a shader of the folder changed, and if so takes it: `Err` says where it is
    /// wrong, and the last good shaders stay.
    pub fn poll_shaders(&mut self, context: &Context) -> Option<Result<(), String>> {
        self.library.changed().then(|| self.pipelines.reload(context, &self.library).map_err(|error| error.to_string()))
    }

    /// The newest frame time that has arrived from the device, milliseconds.
    pub fn gpu_ms(&mut self) -> Option<f64> {
        self.timing.latest()
    }

    /// What the last frame's volumes were drawn from.
    pub(crate) fn frame_buffers(&self) -> &FrameBuffers {
        &self.frame
    }

    /// What the last frame was drawn into.
    #[must_use]
    pub fn targets(&self) -> Option<&Targets> {
        self.targets.as_ref()
    }
}
