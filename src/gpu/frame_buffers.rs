//! What changes with every frame: matrices, lights, and the indices of shadow volumes.

use std::collections::HashMap;

use bytemuck::cast_slice;
use glam::{DAffine3, DMat4, DVec4, Mat4, Vec4};

use super::compute::Compute;
use super::context::{Context, GpuError};
use super::cutouts::{CutoutScratch, thrown};
use super::growing::Growing;
use super::kept::{Kept, Shape};
use super::merged::Merged;
use super::portions::{self, Portions};
use super::scene_buffers::{SceneBuffers, Shown};
use super::slides::Slides;
use super::types::{Draw, Frame, Light, Object, Volume};
use super::uniforms::{frame, light, object, scale};
use crate::frame::{DrawSet, FramePlan, Method, Part, Projection, View, VolumePart, VolumePlan};
use crate::geometry::ending::NEVER_ENDS;
use crate::geometry::kept::Pair;
use crate::geometry::planar_shadow::shadow_matrix;
use crate::geometry::volume::{Caster, Outline, VolumeIndex as _, VolumeIndices, VolumeParts, VolumeScratch};
use crate::geometry::{Posed, light_in_object};
use crate::scene::{Pose, PosedLight, Scene};

/// Uniforms are read at offsets of this many bytes: WebGPU's default alignment.
pub const STRIDE: u64 = 256;

/// Buffers written once a frame, grown when they must, and the bind group over them.
pub struct FrameBuffers {
    /// One for each view.
    frames: Growing,
    /// Every instance of the first view, then of the next.
    objects: Growing,
    lights: Growing,
    volumes: Growing,
    draws: Growing,
    /// Indices of volumes of large casters, `u32`.
    pub indices: Growing,
    /// Indices of all other volumes, `u16`.
    pub short_indices: Growing,
    /// Where each planned volume's parts stand among which of them.
    pub volume_indices: Vec<(VolumeIndices, wgpu::IndexFormat)>,
    slides: Slides,
    /// Vertices of volumes that are thrown from a flattened silhouette, `Float32x4`.
    pub cutout_vertices: Growing,
    /// Where each planned volume's vertices start among those; `None` where they are its mesh's.
    pub first_vertices: Vec<Option<u32>>,
    /// Corners of the solids about lights, in clip space, `Float32x4`.
    pub enclosure_vertices: Growing,
    /// Where those of a draw, by its number among the plan's draws, stand among them.
    pub enclosures: Vec<(usize, std::ops::Range<u32>)>,
    /// Volumes of small casters, once more.
    pub merged: Merged,
    /// Volumes whose silhouettes the device finds.
    pub compute: Compute,
    /// Whether all these are the last frame's.
    kept: Kept,
    bind_group: Option<wgpu::BindGroup>,
    scratch: Scratch,
}

/// CPU memory kept from frame to frame.
#[derive(Default)]
struct Scratch {
    objects: Vec<Object>,
    lights: Vec<Light>,
    volumes: Vec<Volume>,
    frames: Vec<u8>,
    draws: Vec<u8>,
    indices: Vec<u32>,
    short_indices: Vec<u16>,
    volume: VolumeScratch,
    cutouts: CutoutScratch,
    portions: Portions,
    /// What is drawn reflected in a plane: by view, instance and plane, as bits.
    reflected: Vec<Object>,
    reflected_numbers: HashMap<(usize, usize, [u64; 4]), usize>,
    parts: Vec<Option<VolumeParts>>,
    same_shape: SameShape,
    enclosures: Vec<[f32; 4]>,
}

impl Default for FrameBuffers {
    fn default() -> Self {
        let uniform = wgpu::BufferUsages::UNIFORM;
        let storage = wgpu::BufferUsages::STORAGE;
        Self {
            frames: Growing::new("frames", uniform),
            objects: Growing::new("objects", storage),
            lights: Growing::new("lights", storage),
            volumes: Growing::new("volumes", storage),
            draws: Growing::new("draws", uniform),
            indices: Growing::new("volume indices", wgpu::BufferUsages::INDEX),
            short_indices: Growing::new("short volume indices", wgpu::BufferUsages::INDEX),
            volume_indices: Vec::new(),
            slides: Slides::default(),
            cutout_vertices: Growing::new("cut-out vertices", wgpu::BufferUsages::VERTEX),
            first_vertices: Vec::new(),
            enclosure_vertices: Growing::new("solids about lights", wgpu::BufferUsages::VERTEX),
            enclosures: Vec::new(),
            merged: Merged::default(),
            compute: Compute::default(),
            kept: Kept::default(),
            bind_group: None,
            scratch: Scratch::default(),
        }
    }
}

impl FrameBuffers {
    /// Group 0, once something was written.
    #[must_use]
    pub fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.bind_group.as_ref()
    }

    /// Another scene was set: what was made for the one before is none of its business.
    pub fn forget_scene(&mut self) {
        self.slides.forget();
        self.kept.forget();
        self.compute.forget_scene();
        self.bind_group = None;
    }

    /// Builds and uploads everything the plan's steps will read.
    ///
    /// # Errors
    /// Volumes with more indices than the device's largest buffer holds.
    pub fn write(
        &mut self,
        context: &Context,
        layout: &wgpu::BindGroupLayout,
        buffers: &SceneBuffers,
        plan: &FramePlan,
        scene: &Scene,
        pose: &Pose,
    ) -> Result<(), GpuError> {
        self.build_volumes(buffers, plan, scene, pose);
        let longest = (self.scratch.indices.len() * 4).max(self.scratch.short_indices.len() * 2);
        let (bytes, largest) = (longest as u64, context.device.limits().max_buffer_size);
        if bytes > largest {
            let what = format!("its shadow volumes need {} MiB of indices, the device allows {}", bytes >> 20, largest >> 20);
            return Err(GpuError::TooLarge(what));
        }
        self.describe_objects(plan, scene, pose);
        self.build_enclosures(plan);
        let mut grown = self.slides.prepare(context, scene, pose);
        let scratch = &mut self.scratch;
        scratch.lights.clear();
        // Lights that are off have no intensity, so that indices stay the scene's.
        scratch.lights.extend(pose.lights.iter().map(|posed| light(posed, scale(plan), &self.slides)));
        scratch.draws.clear();
        for (_, draw) in plan.draws() {
            let light = draw.light.and_then(|light| scratch.lights.get(light)).copied().unwrap_or_default();
            let swell = if let DrawSet::Swollen(swollen) = &draw.set { swollen.pixels } else { 0.0 };
            let uniform = Draw { constant: draw.constant, light, swell, ..Draw::default() };
            append(&mut scratch.draws, bytemuck::bytes_of(&uniform));
        }
        // What looks at all lights knows no beams.
        let beams = pose.lights.iter().zip(&mut scratch.lights).filter(|(posed, _)| posed.off.is_some());
        beams.for_each(|(_, light)| light.intensity = [0.0; 3]);
        scratch.frames.clear();
        for view in &plan.views {
            append(&mut scratch.frames, bytemuck::bytes_of(&frame(plan, view, scene, pose)));
        }

        grown |= self.frames.write(context, &scratch.frames, STRIDE as usize);
        grown |= self.objects.write(context, cast_slice(&scratch.objects), size_of::<Object>());
        grown |= self.lights.write(context, cast_slice(&scratch.lights), size_of::<Light>());
        grown |= self.volumes.write(context, cast_slice(&scratch.volumes), size_of::<Volume>());
        grown |= self.draws.write(context, &scratch.draws, STRIDE as usize);
        if self.kept.is_same() {
            self.compute.keep();
        } else {
            let of_scene = (scene, pose, buffers.shown.as_slice());
            let first = &scratch.same_shape.first;
            self.compute.prepare(context, plan, of_scene, &scratch.parts, first, &scratch.volumes);
            self.merged.write(context);
            self.indices.write(context, cast_slice(&scratch.indices), 4);
            self.cutout_vertices.write(context, cast_slice(&scratch.cutouts.vertices), 16);
            // Copies come in fours of bytes; what is one index too long is never drawn.
            if scratch.short_indices.len() % 2 == 1 {
                scratch.short_indices.push(0);
            }
            self.short_indices.write(context, cast_slice(&scratch.short_indices), 4);
            self.kept.written();
        }
        self.enclosure_vertices.write(context, cast_slice(&scratch.enclosures), 16);
        if grown || self.bind_group.is_none() {
            self.bind_group = self.make_bind_group(context, layout);
        }
        Ok(())
    }

    fn make_bind_group(&self, context: &Context, layout: &wgpu::BindGroupLayout) -> Option<wgpu::BindGroup> {
        let one_of = |buffer, size: usize| {
            let size = std::num::NonZeroU64::new(size as u64);
            wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size })
        };
        let (slides, slide_sampler) = self.slides.get()?;
        Some(context.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: one_of(self.frames.buffer()?, size_of::<Frame>()) },
                wgpu::BindGroupEntry { binding: 1, resource: self.objects.buffer()?.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 2, resource: self.lights.buffer()?.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 3, resource: self.volumes.buffer()?.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 4, resource: one_of(self.draws.buffer()?, size_of::<Draw>()) },
                wgpu::BindGroupEntry { binding: 5, resource: wgpu::BindingResource::TextureView(slides) },
                wgpu::BindGroupEntry { binding: 6, resource: wgpu::BindingResource::Sampler(slide_sampler) },
            ],
        }))
    }

    /// Only the parts that some step draws are built.
    fn build_volumes(&mut self, buffers: &SceneBuffers, plan: &FramePlan, scene: &Scene, pose: &Pose) {
        let scratch = &mut self.scratch;
        scratch.same_shape.find(plan);
        scratch.parts.clear();
        scratch.parts.resize(plan.volumes.len(), None);
        for (_, draw) in plan.draws() {
            if let DrawSet::Volumes(parts) = &draw.set {
                for part in parts {
                    let outline = plan.volumes[part.volume].outline;
                    let finite = plan.volumes[part.volume].extrusion.is_some();
                    let first = scratch.same_shape.first[part.volume];
                    let wanted = scratch.parts[first].get_or_insert(VolumeParts { outline, finite, ..VolumeParts::NONE });
                    match part.part {
                        Part::Sides | Part::SidesTurned => wanted.sides = true,
                        Part::LightCapKept | Part::LightCapTurned => wanted.light_cap = true,
                        Part::DarkCap | Part::EndCap => wanted.dark_cap = true,
                        Part::StartCap => wanted.start_cap = true,
                    }
                }
            }
        }
        scratch.volumes.clear();
        scratch.reflected.clear();
        scratch.reflected_numbers.clear();
        let shown = &buffers.shown;
        for volume in &plan.volumes {
            let world_from_object = volume.placed(&pose.world_from_object[shown[volume.instance].node]);
            let light = light_in_object(&world_from_object, &pose.lights[volume.light]).as_vec4();
            // Instances of all views come first, and then what is reflected.
            let object = match volume.reflected {
                None => volume.view * shown.len() + volume.instance,
                Some(plane) => {
                    let number = plan.views.len() * shown.len() + scratch.reflected.len();
                    let key = (volume.view, volume.instance, plane.to_array().map(f64::to_bits));
                    *scratch.reflected_numbers.entry(key).or_insert_with(|| {
                        scratch.reflected.push(object(&plan.views[volume.view].camera.clip_from_world(), &world_from_object));
                        number
                    })
                }
            };
            scratch.volumes.push(Volume {
                light_in_object: light.to_array(),
                end_in_object: end_in_object(volume.end, &world_from_object).to_array(),
                start_in_object: volume.start.map_or(Vec4::ZERO, |start| unit_in_object(start, &world_from_object)).to_array(),
                thrown: match volume.method {
                    Method::ZPlus | Method::ZPlusMirrored => {
                        near_from_object(&plan.views[volume.view], &pose.lights[volume.light], &world_from_object)
                    }
                    Method::Projected => projected_from_object(volume, plan, &pose.lights[volume.light], &world_from_object),
                    _ => volume.cutout.as_ref().map_or(Mat4::IDENTITY, thrown),
                }
                .to_cols_array_2d(),
                object: u32::try_from(object).unwrap_or(0),
                by_matrix: u32::from(volume.cutout.is_some()),
                #[expect(clippy::cast_possible_truncation, reason = "the GPU works in f32")]
                extrusion: volume.extrusion.unwrap_or(0.0) as f32,
                _pad: 0,
            });
        }
        self.describe_volumes(buffers, plan, scene, pose);
        if !self.kept.is_same() {
            self.build_indices(buffers, plan, scene, pose);
            self.merge_volumes(buffers, plan);
        }
    }

    /// What the volumes' indices will depend on.
    fn describe_volumes(&mut self, buffers: &SceneBuffers, plan: &FramePlan, scene: &Scene, pose: &Pose) {
        let Self { scratch, kept, .. } = self;
        kept.start();
        for (number, (_, draw)) in plan.draws().enumerate() {
            if let DrawSet::Volumes(parts) = &draw.set {
                kept.draw(number, parts);
            }
        }
        for ((number, volume), described) in plan.volumes.iter().enumerate().zip(&scratch.volumes) {
            let Shown { node, mesh } = buffers.shown[volume.instance];
            kept.volume(Shape {
                instance: volume.instance,
                posed: pose.posed(&scene.meshes[mesh], node).planes.build_number(),
                light: described.light_in_object.map(f32::to_bits),
                parts: scratch.parts[number],
                first: scratch.same_shape.first[number],
                plain: is_plain(volume) && volume.piece.is_whole(),
                silhouette: volume.silhouette,
            });
        }
    }

    fn build_indices(&mut self, buffers: &SceneBuffers, plan: &FramePlan, scene: &Scene, pose: &Pose) {
        let scratch = &mut self.scratch;
        scratch.indices.clear();
        scratch.short_indices.clear();
        scratch.cutouts.vertices.clear();
        scratch.portions.clear();
        self.volume_indices.clear();
        self.first_vertices.clear();
        for (number, (volume, wanted)) in plan.volumes.iter().zip(&scratch.parts).enumerate() {
            let Shown { node: node_index, mesh } = buffers.shown[volume.instance];
            let mesh = &scene.meshes[mesh];
            let light = Vec4::from_array(scratch.volumes[number].light_in_object);
            let first = scratch.same_shape.first[number];
            if first != number {
                self.volume_indices.push(self.volume_indices[first].clone());
                self.first_vertices.push(self.first_vertices[first]);
                continue;
            }
            let Some(parts) = wanted.filter(|_| volume.silhouette.is_cpu()) else {
                self.volume_indices.push((VolumeIndices::default(), wgpu::IndexFormat::Uint16));
                self.first_vertices.push(None);
                continue;
            };
            let Posed { welded, planes } = pose.posed(mesh, node_index);
            let caster = Caster { topology: &mesh.topology, welded, planes, bounds: &pose.bounds(scene, node_index) };
            const SHORT: wgpu::IndexFormat = wgpu::IndexFormat::Uint16;
            const LONG: wgpu::IndexFormat = wgpu::IndexFormat::Uint32;
            if !volume.piece.is_whole() {
                let portion = scratch.portions.of(volume, (mesh, &pose.world_from_object[node_index]), welded);
                let first = scratch.cutouts.append_portion(portion);
                self.volume_indices.push((scratch.volume.append(portion.caster(), light, parts, &mut scratch.indices), LONG));
                self.first_vertices.push(Some(first));
                continue;
            }
            let cut = volume.projection.filter(|projection| projection.cut);
            let seen = || {
                let pair = Pair { instance: volume.instance, light: volume.light, reflected: volume.reflected.is_some() };
                scene.silhouettes.of(pair, caster, light)
            };
            let (indices, format, first_vertex) = match (cut, &volume.cutout, volume.flaw) {
                (Some(Projection { onto, .. }), ..) => {
                    let plane = in_object(onto.plane, &pose.world_from_object[node_index]);
                    let (indices, first_vertex) =
                        scratch.cutouts.append_over(caster, light, (plane, &onto), &mut scratch.indices);
                    (indices, LONG, first_vertex)
                }
                (None, Some(cutout), _) => {
                    let (indices, first_vertex) = scratch.cutouts.append(caster, light, cutout, parts, &mut scratch.indices);
                    (indices, LONG, first_vertex)
                }
                (None, None, Some(flaw)) => {
                    (scratch.volume.append_flawed(flaw, caster, light, parts, &mut scratch.indices), LONG, None)
                }
                (None, None, None) if welded.len() * 2 <= u16::LIMIT => {
                    let indices = scratch.volume.append_seen(&seen(), caster, light, parts, &mut scratch.short_indices);
                    (indices, SHORT, None)
                }
                (None, None, None) => {
                    (scratch.volume.append_seen(&seen(), caster, light, parts, &mut scratch.indices), LONG, None)
                }
            };
            self.volume_indices.push((indices, format));
            self.first_vertices.push(first_vertex);
        }
    }

    /// What is small and drawn by the same step is put together.
    fn merge_volumes(&mut self, buffers: &SceneBuffers, plan: &FramePlan) {
        let Self { merged, volume_indices, first_vertices, scratch, .. } = self;
        let welded = |volume: usize| {
            let vertices = buffers.vertices(plan.volumes[volume].instance);
            let copied = first_vertices[volume].is_none() && plan.volumes[volume].silhouette.is_cpu();
            copied.then_some(vertices.welded.as_slice())
        };
        let each_index = |part: VolumePart, each: &mut dyn FnMut(u32)| {
            let (indices, format) = &volume_indices[part.volume];
            let range = range_of(indices, part.part);
            let range = range.start as usize..range.end as usize;
            match format {
                wgpu::IndexFormat::Uint16 => scratch.short_indices[range].iter().for_each(|&index| each(index.into())),
                wgpu::IndexFormat::Uint32 => scratch.indices[range].iter().for_each(|&index| each(index)),
            }
        };
        merged.clear(plan.volumes.len());
        for (number, (_, draw)) in plan.draws().enumerate() {
            if let DrawSet::Volumes(parts) = &draw.set {
                merged.append(number, parts, welded, each_index);
            }
        }
    }

    fn build_enclosures(&mut self, plan: &FramePlan) {
        let vertices = &mut self.scratch.enclosures;
        vertices.clear();
        self.enclosures.clear();
        for (number, (step, draw)) in plan.draws().enumerate() {
            let count = |vertices: &Vec<[f32; 4]>| u32::try_from(vertices.len()).unwrap_or(u32::MAX);
            let first = count(vertices);
            match &draw.set {
                DrawSet::Enclosure(solid) => solid.append_clip(&plan.views[step.view].camera.clip_from_world(), vertices),
                DrawSet::Triangles(corners) => vertices.extend_from_slice(corners),
                _ => continue,
            }
            self.enclosures.push((number, first..count(vertices)));
        }
    }

    fn describe_objects(&mut self, plan: &FramePlan, scene: &Scene, pose: &Pose) {
        let described = |view: &View| {
            let clip_from_world = view.camera.clip_from_world();
            scene.instances().map(move |(node, ..)| object(&clip_from_world, &pose.world_from_object[node]))
        };
        self.scratch.objects.clear();
        self.scratch.objects.extend(plan.views.iter().flat_map(described));
        self.scratch.objects.append(&mut self.scratch.reflected);
    }

    /// A part's indices, as the CPU built them.
    #[must_use]
    pub fn built(&self, part: VolumePart) -> Vec<u32> {
        let (indices, format) = &self.volume_indices[part.volume];
        let range = range_of(indices, part.part);
        let range = range.start as usize..range.end as usize;
        match format {
            wgpu::IndexFormat::Uint16 => self.scratch.short_indices[range].iter().map(|&index| index.into()).collect(),
            wgpu::IndexFormat::Uint32 => self.scratch.indices[range].to_vec(),
        }
    }

    /// The volume whose indices a volume shares; itself, mostly.
    #[must_use]
    pub fn first_of_shape(&self, volume: usize) -> usize {
        self.scratch.same_shape.first[volume]
    }

    /// Indices built this frame, and their bytes.
    #[must_use]
    pub fn index_count(&self) -> [u64; 2] {
        // In triangles: without what may fill up the last four bytes.
        let short = self.scratch.short_indices.len() as u64 / 3 * 3;
        let long = self.scratch.indices.len() as u64;
        [short + long, short * 2 + long * 4]
    }
}

/// At the next offset that a uniform may have.
fn append(bytes: &mut Vec<u8>, uniform: &[u8]) {
    bytes.extend_from_slice(uniform);
    bytes.resize(bytes.len().next_multiple_of(STRIDE as usize), 0);
}

/// For each volume the first whose indices are its own too: one caster's in one light, seen in several views.
#[derive(Default)]
struct SameShape {
    first: Vec<usize>,
    by_shape: HashMap<ShapeKey, usize>,
}

/// Caster, light, whether it is reflected, and which piece of it; whether it is built polygon by polygon, and whether it has
/// an end of its own.
type ShapeKey = ((usize, usize, bool, portions::Key), bool, bool);

impl SameShape {
    fn find(&mut self, plan: &FramePlan) {
        let Self { first, by_shape } = self;
        first.clear();
        by_shape.clear();
        first.extend(plan.volumes.iter().enumerate().map(|(number, volume)| {
            let plain = is_plain(volume) && volume.method != Method::Dropped;
            let of = (volume.instance, volume.light, volume.reflected.is_some(), portions::key(&volume.piece));
            let key = (of, volume.outline == Outline::Polygons, volume.extrusion.is_some());
            if plain { *by_shape.entry(key).or_insert(number) } else { number }
        }));
    }
}

/// It is thrown from its caster's silhouette, as that is; or from a part of the caster.
fn is_plain(volume: &VolumePlan) -> bool {
    let whole = volume.cutout.is_none() && volume.projection.is_none_or(|projection| !projection.cut);
    whole && volume.flaw.is_none()
}

/// Where a part of a volume stands among the indices.
#[must_use]
pub fn range_of(indices: &VolumeIndices, part: Part) -> std::ops::Range<u32> {
    match part {
        Part::Sides => indices.sides.clone(),
        Part::SidesTurned => indices.sides_turned.clone(),
        Part::LightCapKept => indices.light_cap_kept.clone(),
        Part::LightCapTurned => indices.light_cap_turned.clone(),
        Part::DarkCap | Part::EndCap => indices.dark_cap.clone(),
        Part::StartCap => indices.start_cap.clone(),
    }
}

/// Object space to clip space, as the light sees it through the eye's near rectangle.
fn near_from_object(view: &View, light: &PosedLight, world_from_object: &DAffine3) -> Mat4 {
    // Only lights that look through it have volumes counted so.
    let through = view.camera.through_light(light);
    through.map_or(Mat4::IDENTITY, |through| (through.clip_from_world * DMat4::from(*world_from_object)).as_mat4())
}

/// Object space to clip space, by way of the receiver's plane.
fn projected_from_object(volume: &VolumePlan, plan: &FramePlan, light: &PosedLight, world_from_object: &DAffine3) -> Mat4 {
    let Some(Projection { onto, .. }) = volume.projection else { return Mat4::IDENTITY };
    let clip_from_world = plan.views[volume.view].camera.clip_from_world();
    (clip_from_world * shadow_matrix(onto.plane, light.into()) * DMat4::from(*world_from_object)).as_mat4()
}

/// Where a volume ends, in object space, the normal made unit again.
fn end_in_object(end: Option<DVec4>, world_from_object: &DAffine3) -> Vec4 {
    end.map_or(NEVER_ENDS.as_vec4(), |end| unit_in_object(end, world_from_object))
}

fn unit_in_object(plane: DVec4, world_from_object: &DAffine3) -> Vec4 {
    let plane = in_object(plane, world_from_object);
    (plane / plane.truncate().length()).as_vec4()
}

/// A plane of world space in object space: it gives heights in metres still.
fn in_object(plane: DVec4, world_from_object: &DAffine3) -> DVec4 {
    let normal = world_from_object.matrix3.transpose() * plane.truncate();
    normal.extend(plane.truncate().dot(world_from_object.translation) + plane.w)
}
