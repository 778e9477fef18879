//! Silhouettes and volumes found by a compute shader: what it is given, and the dispatches.
//!
//! Meshes stand in arenas of words ([`crate::geometry::arena`]): what never moves is uploaded once a scene, poses where
//! they change. Each frame that moves something uploads its jobs (one a volume), the blocks of triangles and edges
//! that workgroups take, and the draws there will be; `shaders/silhouettes.wgsl` says what becomes of them. Indices get
//! as much room as they can need at most, and the draws' arguments stay on the device: nothing is read back.

use bytemuck::cast_slice;
use glam::Vec4;

use super::context::Context;
use super::growing::Growing;
use super::pipelines::Pipelines;
use super::scene_buffers::Shown;
use super::shaders::{COMPUTE, STAGES};
use super::types::{Job, Volume};
use crate::frame::{DrawSet, FramePlan, Part, VolumePart};
use crate::geometry::VolumeParts;
use crate::geometry::arena::{self, Fixed};
use crate::geometry::volume::box_within_half_space;
use crate::scene::{Pose, Scene};

/// Triangles or edges that one workgroup takes.
const BLOCK: u32 = 512;
/// Threads of a workgroup, and so draws that one takes.
const LANES: u32 = 64;
/// Workgroups in a row, where there are more than a dispatch may have.
const ROW: u32 = 1 << 15;
/// Words of a job's own counters, before four a block.
const COUNTERS: u32 = 8;
/// Bytes of one draw's arguments.
pub const ARGUMENTS: u64 = 20;

const SIDES: u32 = 1;
const LIGHT_CAP: u32 = 2;
const FAN: u32 = 4;
const DARK_TRIANGLES: u32 = 8;
const TO_ONE_POINT: u32 = 16;
const START_CAP: u32 = 32;

/// Everything that silhouettes are found with on the device.
pub struct Compute {
    stages: Option<Stages>,
    /// Where each mesh's topology begins, in words, once it is there.
    fixed_at: Vec<u32>,
    /// And its pose at rest.
    rest_at: Vec<u32>,
    topology: Growing,
    poses: Growing,
    jobs: Growing,
    entries: Growing,
    facing: Growing,
    counters: Growing,
    /// Indices of all volumes, `u32`.
    pub indices: Growing,
    /// Arguments of indirect draws.
    pub draws: Growing,
    bind_group: Option<wgpu::BindGroup>,
    /// Of each planned volume: the draws of its parts.
    slots: Vec<[Option<u32>; PARTS.len()]>,
    /// Of each planned volume that is the first of its shape: its job.
    job_of: Vec<Option<u32>>,
    /// Where each instance's pose is, in words, once it was asked for.
    posed_at: Vec<Option<u32>>,
    job_data: Vec<Job>,
    entry_data: Vec<[u32; 4]>,
    words: Vec<u32>,
    counts: Counts,
    /// Something is to be found before the frame is drawn.
    pending: bool,
}

/// The parts there are, as the shader numbers them.
const PARTS: [Part; 5] = [Part::Sides, Part::LightCapKept, Part::LightCapTurned, Part::DarkCap, Part::StartCap];

/// A part's number among them: what closes a piece is built as a dark cap.
fn place_of(part: Part) -> Option<usize> {
    let part = if part == Part::EndCap { Part::DarkCap } else { part };
    PARTS.iter().position(|of| *of == part)
}

/// How many there are of what the shader works through.
#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    triangle_blocks: u32,
    blocks: u32,
    slots: u32,
}

struct Stages {
    generation: u64,
    layout: wgpu::BindGroupLayout,
    pipelines: Vec<wgpu::ComputePipeline>,
}

impl Default for Compute {
    fn default() -> Self {
        let storage = wgpu::BufferUsages::STORAGE;
        let source = wgpu::BufferUsages::COPY_SRC;
        Self {
            stages: None,
            fixed_at: Vec::new(),
            rest_at: Vec::new(),
            topology: Growing::new("topologies", storage),
            poses: Growing::new("poses", storage),
            jobs: Growing::new("silhouette jobs", storage),
            entries: Growing::new("silhouette blocks", storage),
            facing: Growing::new("facing", storage),
            counters: Growing::new("silhouette counters", storage),
            indices: Growing::new("computed volume indices", storage | wgpu::BufferUsages::INDEX | source),
            draws: Growing::new("computed draws", storage | wgpu::BufferUsages::INDIRECT | source),
            bind_group: None,
            slots: Vec::new(),
            job_of: Vec::new(),
            posed_at: Vec::new(),
            job_data: Vec::new(),
            entry_data: Vec::new(),
            words: Vec::new(),
            counts: Counts::default(),
            pending: false,
        }
    }
}

impl Compute {
    /// Another scene was set.
    pub fn forget_scene(&mut self) {
        self.fixed_at.clear();
        self.rest_at.clear();
    }

    /// The draw of a part, by its number among the arguments, where its volume is found here.
    #[must_use]
    pub fn slot(&self, part: VolumePart) -> Option<u32> {
        let place = place_of(part.part)?;
        self.slots.get(part.volume)?[place]
    }

    /// Uploads what a plan's volumes are found from; `shown` says what each instance shows, `parts` what is built of each
    /// volume that is the first of its shape, `same_shape` which that is.
    pub fn prepare(
        &mut self,
        context: &Context,
        plan: &FramePlan,
        (scene, pose, shown): (&Scene, &Pose, &[Shown]),
        parts: &[Option<VolumeParts>],
        same_shape: &[usize],
        volumes: &[Volume],
    ) {
        self.slots.clear();
        self.job_data.clear();
        self.pending = plan.volumes.iter().any(|volume| !volume.silhouette.is_cpu());
        if !self.pending {
            return;
        }
        let mut grown = self.lay_topologies(context, scene);
        grown |= self.lay_poses(context, plan, (scene, pose, shown));
        self.job_of.clear();
        self.job_of.resize(plan.volumes.len(), None);
        let (mut facing, mut indices) = (0u32, 0u32);
        for (number, volume) in plan.volumes.iter().enumerate() {
            let wanted = parts[number].filter(|_| !volume.silhouette.is_cpu() && same_shape[number] == number);
            let Some(wanted) = wanted else { continue };
            let Shown { node, mesh: of_node } = shown[volume.instance];
            let mesh = &scene.meshes[of_node];
            let topology = &mesh.topology;
            let light = Vec4::from_array(volumes[number].light_in_object);
            let to_one_point = light.w == 0.0 && !wanted.finite;
            // What closes a piece at its start is what closes it at its end, turned: both are built.
            let wanted = VolumeParts { dark_cap: (wanted.dark_cap || wanted.start_cap) && !to_one_point, ..wanted };
            let fan = wanted.dark_cap && box_within_half_space(&pose.bounds(scene, node), light.truncate());
            let flags = [
                (wanted.sides, SIDES),
                (wanted.light_cap, LIGHT_CAP),
                (fan, FAN),
                (wanted.dark_cap && !fan, DARK_TRIANGLES),
                (to_one_point, TO_ONE_POINT),
                (wanted.start_cap, START_CAP),
            ];
            let count = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
            let (triangles, pairs, others) =
                (count(topology.triangles().len()), count(topology.pairs().a.len()), count(topology.others().ends.len()));
            let [reach, room, rounding] = pose.posed(mesh, node).planes.unsure(light).map(f32::to_bits);
            let (fixed, base) = (Fixed::of(topology), self.fixed_at[of_node]);
            let planes = self.posed_at[volume.instance].unwrap_or(0);
            // What the plan allows fits 32 bits: it bounds them by a buffer's largest size.
            let room_for = arena::most_indices(topology, wanted).map(|most| u32::try_from(most).unwrap_or(u32::MAX));
            self.job_of[number] = Some(count(self.job_data.len()));
            self.job_data.push(Job {
                light: light.to_array().map(f32::to_bits),
                reach,
                room,
                rounding,
                flags: flags.iter().map(|(set, flag)| if *set { *flag } else { 0 }).sum(),
                triangles: base + fixed.triangles,
                neighbours: base + fixed.neighbours,
                pairs: base + fixed.pairs,
                others: base + fixed.others,
                incidences: base + fixed.incidences,
                planes,
                welded: planes + triangles * 5,
                vertices: count(topology.weld().len()),
                facing,
                edge_on: facing + triangles,
                sides: indices,
                cap: indices + room_for[0],
                dark: indices + room_for[0] + room_for[1],
                start: indices + room_for[0] + room_for[1] + room_for[2],
                triangle_count: triangles,
                pair_count: pairs,
                other_count: others,
                ..Job::default()
            });
            facing += triangles * 2;
            indices += room_for.iter().sum::<u32>();
        }
        self.list_blocks();
        self.list_draws(plan, same_shape);
        let jobs = self.job_data.len() as u64;
        grown |= self.jobs.write(context, cast_slice(&self.job_data), size_of::<Job>());
        grown |= self.entries.write(context, cast_slice(&self.entry_data), 16);
        grown |= self.facing.reserve(context, u64::from(facing) * 4);
        grown |= self.counters.reserve(context, (jobs * u64::from(COUNTERS) + u64::from(self.counts.blocks) * 4) * 4);
        grown |= self.indices.reserve(context, u64::from(indices) * 4);
        grown |= self.draws.reserve(context, u64::from(self.counts.slots) * ARGUMENTS);
        if grown {
            self.bind_group = None;
        }
    }

    /// What never moves, once a scene.
    fn lay_topologies(&mut self, context: &Context, scene: &Scene) -> bool {
        if !self.fixed_at.is_empty() {
            return false;
        }
        self.words.clear();
        let mut rest_words = 0u64;
        for mesh in &scene.meshes {
            self.fixed_at.push(u32::try_from(self.words.len()).unwrap_or(u32::MAX));
            self.rest_at.push(u32::try_from(rest_words).unwrap_or(u32::MAX));
            arena::append_fixed(&mesh.topology, &mut self.words);
            rest_words += arena::posed_words(&mesh.topology);
        }
        let grown = self.topology.write(context, cast_slice(&self.words), 4);
        self.words.clear();
        scene.meshes.iter().for_each(|mesh| arena::append_posed(&mesh.rest, &mut self.words));
        self.poses.write(context, cast_slice(&self.words), 4) | grown
    }

    /// Poses of what is deformed, after those at rest; says whether that took another buffer.
    fn lay_poses(&mut self, context: &Context, plan: &FramePlan, (scene, pose, shown): (&Scene, &Pose, &[Shown])) -> bool {
        self.posed_at.clear();
        self.posed_at.resize(shown.len(), None);
        let rest_words = scene.meshes.iter().map(|mesh| arena::posed_words(&mesh.topology)).sum::<u64>();
        let mut end = rest_words;
        self.words.clear();
        for volume in plan.volumes.iter().filter(|volume| !volume.silhouette.is_cpu()) {
            let place = &mut self.posed_at[volume.instance];
            let Shown { node, mesh } = shown[volume.instance];
            if place.is_some() {
                continue;
            }
            *place = Some(self.rest_at[mesh]);
            if pose.deformed[node].is_some() {
                *place = Some(u32::try_from(end).unwrap_or(u32::MAX));
                let mesh = &scene.meshes[mesh];
                arena::append_posed(pose.posed(mesh, node), &mut self.words);
                end += arena::posed_words(&mesh.topology);
            }
        }
        let grown = self.poses.reserve(context, end * 4);
        if grown {
            let deformed = std::mem::take(&mut self.words);
            scene.meshes.iter().for_each(|mesh| arena::append_posed(&mesh.rest, &mut self.words));
            self.poses.write_at(context, 0, cast_slice(&self.words));
            self.words = deformed;
        }
        self.poses.write_at(context, rest_words * 4, cast_slice(&self.words));
        grown
    }

    fn list_blocks(&mut self) {
        self.entry_data.clear();
        self.entry_data.push([0; 4]);
        let first = |entries: &Vec<[u32; 4]>| u32::try_from(entries.len() - 1).unwrap_or(u32::MAX);
        for (number, job) in (0u32..).zip(&mut self.job_data) {
            job.triangle_block = first(&self.entry_data);
            self.entry_data.extend((0..job.triangle_count).step_by(BLOCK as usize).map(|item| [number, 0, item, 0]));
            job.triangle_blocks = first(&self.entry_data) - job.triangle_block;
        }
        self.counts.triangle_blocks = first(&self.entry_data);
        for (number, job) in (0u32..).zip(&mut self.job_data) {
            job.edge_block = first(&self.entry_data);
            for (kind, count) in [(1, job.pair_count), (2, job.other_count)] {
                self.entry_data.extend((0..count).step_by(BLOCK as usize).map(|item| [number, kind, item, 0]));
            }
            job.edge_blocks = first(&self.entry_data) - job.edge_block;
        }
        self.counts.blocks = first(&self.entry_data);
    }

    fn list_draws(&mut self, plan: &FramePlan, same_shape: &[usize]) {
        self.slots.resize(plan.volumes.len(), [None; PARTS.len()]);
        self.counts.slots = 0;
        for (_, draw) in plan.draws() {
            let DrawSet::Volumes(parts) = &draw.set else { continue };
            for part in parts {
                let Some(job) = self.job_of[same_shape[part.volume]] else { continue };
                let Some(place) = place_of(part.part) else { continue };
                let slot = &mut self.slots[part.volume][place];
                if slot.is_none() {
                    *slot = Some(self.counts.slots);
                    self.counts.slots += 1;
                    let numbers = [place, part.volume].map(|number| u32::try_from(number).unwrap_or(0));
                    self.entry_data.push([job, numbers[0], numbers[1], 0]);
                }
            }
        }
        let jobs = u32::try_from(self.job_data.len()).unwrap_or(u32::MAX);
        self.entry_data[0] = [self.counts.triangle_blocks, self.counts.blocks, jobs, self.counts.slots];
    }

    /// What was prepared is still right: nothing has moved.
    pub fn keep(&mut self) {
        self.pending = false;
    }

    /// Records the dispatches, where there are any; says whether.
    pub fn dispatch(
        &mut self,
        context: &Context,
        pipelines: &Pipelines,
        encoder: &mut wgpu::CommandEncoder,
        timestamp_writes: Option<wgpu::ComputePassTimestampWrites<'_>>,
    ) -> bool {
        if !std::mem::take(&mut self.pending) || self.job_data.is_empty() {
            return false;
        }
        if self.stages.as_ref().is_none_or(|stages| stages.generation != pipelines.generation()) {
            self.stages = Some(Stages::new(context, pipelines));
            self.bind_group = None;
        }
        let Some(stages) = &self.stages else { return false };
        if self.bind_group.is_none() {
            self.bind_group = self.bind(context, &stages.layout);
        }
        let (Some(group), Some(counters)) = (&self.bind_group, self.counters.buffer()) else { return false };
        encoder.clear_buffer(counters, 0, None);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some("silhouettes"), timestamp_writes });
        pass.set_bind_group(0, group, &[]);
        let Counts { triangle_blocks, blocks, slots } = self.counts;
        let jobs = u32::try_from(self.job_data.len()).unwrap_or(u32::MAX);
        let groups = [triangle_blocks, jobs, blocks - triangle_blocks, blocks, jobs, blocks, slots.div_ceil(LANES)];
        for (pipeline, groups) in stages.pipelines.iter().zip(groups) {
            if groups > 0 {
                pass.set_pipeline(pipeline);
                pass.dispatch_workgroups(groups.min(ROW), groups.div_ceil(ROW), 1);
            }
        }
        true
    }

    fn bind(&self, context: &Context, layout: &wgpu::BindGroupLayout) -> Option<wgpu::BindGroup> {
        let buffers =
            [&self.topology, &self.poses, &self.jobs, &self.entries, &self.facing, &self.counters, &self.indices, &self.draws];
        let mut entries = Vec::with_capacity(buffers.len());
        for (binding, buffer) in (0u32..).zip(buffers) {
            entries.push(wgpu::BindGroupEntry { binding, resource: buffer.buffer()?.as_entire_binding() });
        }
        let descriptor = wgpu::BindGroupDescriptor { label: Some("silhouettes"), layout, entries: &entries };
        Some(context.device.create_bind_group(&descriptor))
    }
}

impl Stages {
    fn new(context: &Context, pipelines: &Pipelines) -> Self {
        let device = &context.device;
        let entry = |binding| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: binding < 4 },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("silhouettes"),
            entries: &[0, 1, 2, 3, 4, 5, 6, 7].map(entry),
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("silhouettes"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = |stage: &&str| {
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(stage),
                layout: Some(&pipeline_layout),
                module: pipelines.module(COMPUTE),
                entry_point: Some(stage),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            })
        };
        Self { generation: pipelines.generation(), pipelines: STAGES.iter().map(pipeline).collect(), layout }
    }
}
