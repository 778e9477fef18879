//! Walks the plan and records it: neighbours with the same attachments share one render pass.

use super::context::Context;
use super::frame_buffers::{FrameBuffers, STRIDE};
use super::labels::Labels;
use super::lines::Lines;
use super::pipelines::{Key, Pipelines, Reads, reads};
use super::scene_buffers::SceneBuffers;
use super::shaders::{BANDS, Vertices, entry_of};
use super::targets::{Mean, Targets};
use super::timing::Timing;
use crate::frame::{Action, Clear, Draw, DrawSet, FramePlan, Program, Run, Surface, Target, View};
use crate::scene::Scene;

/// What a frame is drawn with and into.
pub struct Encode<'a> {
    pub context: &'a Context,
    pub pipelines: &'a mut Pipelines,
    pub buffers: &'a mut SceneBuffers,
    pub frame: &'a FrameBuffers,
    pub labels: &'a Labels,
    pub lines: &'a Lines,
    pub targets: &'a Targets,
    pub output: &'a wgpu::TextureView,
    pub format: wgpu::TextureFormat,
    pub timing: &'a Timing,
    /// The frame's time began before its first render pass.
    pub begun_before: bool,
}

/// What was drawn.
#[derive(Debug, Clone, Copy, Default)]
pub struct Drawn {
    /// Draw calls.
    pub draws: u32,
    /// Triangles of surfaces and volumes together.
    pub triangles: u64,
    /// Of shadow volumes.
    pub volume_triangles: u64,
}

/// Draws that share attachments, and what is cleared before them.
struct Pass<'a> {
    target: Target,
    clear: Clear,
    /// With each draw's number among the plan's draws.
    draws: Vec<(Place, &'a Draw)>,
    /// No pass before it has its target.
    first: bool,
    /// The view whose picture is kept in its texture afterwards.
    keeps: Option<usize>,
}

/// Records the whole plan.
pub fn encode(encode: Encode<'_>, plan: &FramePlan, scene: &Scene, encoder: &mut wgpu::CommandEncoder) -> Drawn {
    for (_, draw) in plan.draws() {
        encode.pipelines.prepare(encode.context, &encode.key(plan, draw));
        if let DrawSet::Swollen(swollen) = &draw.set {
            for surface in &swollen.surfaces {
                let mesh = encode.buffers.shown[surface.instance].mesh;
                encode.buffers.prepare_outward(encode.context, surface.instance, mesh, &scene.meshes[mesh]);
            }
        }
        if let DrawSet::Edges(shown) = &draw.set {
            for &instance in shown {
                let mesh = encode.buffers.shown[instance].mesh;
                encode.buffers.prepare_edges(encode.context, mesh, &scene.meshes[mesh]);
            }
        }
    }
    let passes = passes(plan);
    let last_scene = passes.iter().rposition(|pass| pass.target == Target::Scene);
    let mut drawn = Drawn::default();
    for (index, pass) in passes.iter().enumerate() {
        let timestamps = encode.timing.writes(index == 0 && !encode.begun_before, index + 1 == passes.len());
        let mut recorder = encode.begin(encoder, plan, pass, Some(index) == last_scene, timestamps);
        recorder.set_bind_group_checked(0, encode.frame.bind_group(), Place::default());
        for &(place, draw) in &pass.draws {
            encode.record(&mut recorder, plan, scene, draw, place, &mut drawn);
        }
        drop(recorder);
        if let Some(view) = pass.keeps {
            encode.keep(encoder, &plan.views[view]);
        }
    }
    drawn
}

/// Which draw.
#[derive(Debug, Clone, Copy, Default)]
struct Place {
    /// Its view, among the plan's.
    view: usize,
    /// Its number among the plan's draws.
    number: usize,
}

trait CheckedBind {
    fn set_bind_group_checked(&mut self, index: u32, group: Option<&wgpu::BindGroup>, place: Place);
}

impl CheckedBind for wgpu::RenderPass<'_> {
    fn set_bind_group_checked(&mut self, index: u32, group: Option<&wgpu::BindGroup>, place: Place) {
        if let Some(group) = group {
            let offset = |number: usize| u32::try_from(number as u64 * STRIDE).unwrap_or(0);
            self.set_bind_group(index, group, &[offset(place.view), offset(place.number)]);
        }
    }
}

fn passes(plan: &FramePlan) -> Vec<Pass<'_>> {
    const KEEP: Clear = Clear { color: None, depth: None, stencil: None, counts: None };
    let mut passes: Vec<Pass<'_>> = Vec::new();
    let mut pending: Option<Clear> = None;
    let mut number = 0;
    for step in &plan.steps {
        match &step.action {
            Action::Clear(clear) => {
                let before = pending.unwrap_or(KEEP);
                pending = Some(Clear {
                    color: clear.color.or(before.color),
                    depth: clear.depth.or(before.depth),
                    stencil: clear.stencil.or(before.stencil),
                    counts: clear.counts.or(before.counts),
                });
            }
            Action::Keep => {
                if let Some(pass) = passes.last_mut() {
                    pass.keeps = Some(step.view);
                }
            }
            Action::Draw(draw) => {
                // The mean's and the picture's own passes clear nothing of the scene's, and the counts' no
                // colour.
                let elsewhere = match draw.target {
                    Target::Scene | Target::Direct | Target::Geometry | Target::Dark | Target::Shaded => false,
                    Target::Mean | Target::Output | Target::Solid => true,
                    Target::Counts => pending.is_some_and(|clear| clear.color.is_some()),
                };
                if let Some(mut clear) = pending.take_if(|_| elsewhere) {
                    let counts = clear.counts.take_if(|_| draw.target == Target::Counts);
                    passes.push(Pass { target: Target::Scene, clear, draws: Vec::new(), first: false, keeps: None });
                    pending = counts.map(|counts| Clear { counts: Some(counts), ..KEEP });
                }
                let follows = |pass: &Pass<'_>| pass.target == draw.target && pass.keeps.is_none();
                let joins = pending.is_none() && passes.last().is_some_and(follows);
                if !joins {
                    let first = passes.iter().all(|pass| pass.target != draw.target);
                    let clear = pending.take().unwrap_or(KEEP);
                    passes.push(Pass { target: draw.target, clear, draws: Vec::new(), first, keeps: None });
                }
                if let Some(pass) = passes.last_mut() {
                    pass.draws.push((Place { view: step.view, number }, draw));
                }
                number += 1;
            }
        }
    }
    passes
}

fn load<T, C: Into<T>>(clear: Option<C>) -> wgpu::LoadOp<T> {
    clear.map_or(wgpu::LoadOp::Load, |value| wgpu::LoadOp::Clear(value.into()))
}

impl Encode<'_> {
    fn key(&self, plan: &FramePlan, draw: &Draw) -> Key {
        Key {
            program: draw.program,
            look: draw.look,
            state: draw.state,
            target: draw.target,
            output: self.format,
            samples: plan.samples,
            accumulation: plan.accumulation,
        }
    }

    /// The mean that this frame leaves.
    fn mean(&self, plan: &FramePlan) -> Option<&Mean> {
        let gather = plan.gather?;
        self.targets.means.as_ref().map(|means| &means[gather.frame as usize % 2])
    }

    fn begin<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        plan: &FramePlan,
        pass: &Pass<'_>,
        resolve: bool,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        let store = wgpu::StoreOp::Store;
        match pass.target {
            Target::Scene | Target::Direct => {
                let color =
                    pass.clear.color.map(|[r, g, b, a]| wgpu::Color { r: r.into(), g: g.into(), b: b.into(), a: a.into() });
                let in_scene = pass.target == Target::Scene;
                encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some(if in_scene { "scene" } else { "picture, under the scene's depth" }),
                    color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                        view: if in_scene { &self.targets.color } else { self.output },
                        depth_slice: None,
                        resolve_target: self.targets.resolved.as_ref().filter(|_| resolve),
                        ops: wgpu::Operations { load: load(color), store },
                    })],
                    depth_stencil_attachment: Some(self.depth_stencil(&pass.clear)),
                    timestamp_writes,
                    ..Default::default()
                })
            }
            Target::Geometry => encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("geometry"),
                color_attachments: &[self.targets.geometry.as_ref().map(|kept| wgpu::RenderPassColorAttachment {
                    view: &kept.surface,
                    depth_slice: None,
                    resolve_target: None,
                    // Where no surface is drawn nothing is read.
                    ops: wgpu::Operations { load: wgpu::LoadOp::Load, store },
                })],
                depth_stencil_attachment: Some(self.depth_stencil(&pass.clear)),
                timestamp_writes,
                ..Default::default()
            }),
            Target::Dark => encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("shadows"),
                color_attachments: &[self.targets.geometry.as_ref().map(|kept| wgpu::RenderPassColorAttachment {
                    view: &kept.dark,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations { load: load(pass.first.then_some(wgpu::Color::TRANSPARENT)), store },
                })],
                depth_stencil_attachment: Some(self.depth_stencil(&pass.clear)),
                timestamp_writes,
                ..Default::default()
            }),
            Target::Shaded => encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("shading"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: self.output,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations { load: wgpu::LoadOp::Load, store },
                })],
                // Depth is read as a texture, too: nothing may write it.
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &self.targets.depth_stencil,
                    depth_ops: None,
                    stencil_ops: None,
                }),
                timestamp_writes,
                ..Default::default()
            }),
            Target::Counts => encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("counts"),
                color_attachments: &[self.targets.counts.as_ref().map(|counts| wgpu::RenderPassColorAttachment {
                    view: &counts.view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: load(pass.clear.counts.map(|red| wgpu::Color { r: red.into(), ..wgpu::Color::BLACK })),
                        store,
                    },
                })],
                depth_stencil_attachment: Some(self.depth_stencil(&pass.clear)),
                timestamp_writes,
                ..Default::default()
            }),
            Target::Solid => {
                // The plan draws what it begins with; what it does not draw it does not read.
                let view = self.targets.solid.as_ref().map_or(&self.targets.depth_stencil, |solid| &solid.depth_stencil);
                encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some("solid"),
                    depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                        view,
                        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store }),
                        stencil_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store }),
                    }),
                    timestamp_writes,
                    ..Default::default()
                })
            }
            Target::Mean | Target::Output => encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some(if pass.target == Target::Mean { "mean" } else { "picture" }),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: self.mean(plan).filter(|_| pass.target == Target::Mean).map_or(self.output, |mean| &mean.view),
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store },
                })],
                timestamp_writes,
                ..Default::default()
            }),
        }
    }

    /// The scene's depth and stencil, cleared as a pass begins.
    fn depth_stencil(&self, clear: &Clear) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        let store = wgpu::StoreOp::Store;
        wgpu::RenderPassDepthStencilAttachment {
            view: &self.targets.depth_stencil,
            depth_ops: Some(wgpu::Operations { load: load(clear.depth), store }),
            stencil_ops: Some(wgpu::Operations { load: load(clear.stencil), store }),
        }
    }

    /// What was drawn of a view into its texture.
    fn keep(&self, encoder: &mut wgpu::CommandEncoder, view: &View) {
        let Some(reflection) = view.texture.and_then(|texture| self.targets.reflections.get(texture)) else { return };
        let [width, height] = reflection.size;
        encoder.copy_texture_to_texture(
            self.targets.color_texture.as_image_copy(),
            reflection.texture.as_image_copy(),
            wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        );
    }

    fn record(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        plan: &FramePlan,
        scene: &Scene,
        draw: &Draw,
        place: Place,
        drawn: &mut Drawn,
    ) {
        let Some(pipeline) = self.pipelines.get(&self.key(plan, draw)) else { return };
        pass.set_pipeline(pipeline);
        pass.set_bind_group_checked(0, self.frame.bind_group(), place);
        pass.set_stencil_reference(draw.stencil_reference.into());
        let [x, y, width, height] = draw.scissor;
        pass.set_scissor_rect(x, y, width, height);
        if !self.targets.reflections.is_empty() {
            let [width, height] = plan.views[place.view].picture.map(|side| side as f32);
            pass.set_viewport(0.0, 0.0, width, height, 0.0, 1.0);
        }
        let kept = plan.kept_behind(place.view, draw).filter(|_| draw.program == Program::Mirrored);
        if let Some(reflection) = kept.and_then(|view| self.targets.reflections.get(plan.views[view].texture?)) {
            pass.set_bind_group(2, &reflection.read, &[]);
        }
        match &draw.set {
            DrawSet::FullScreen => {
                let kept = plan.views[place.view].texture.filter(|_| draw.program == Program::LayKept);
                if let Some(kept) = kept.and_then(|texture| self.targets.reflections.get(texture)) {
                    pass.set_bind_group(1, &kept.read, &[]);
                }
                if let (Reads::Solid | Reads::SolidEach, Some(solid)) = (reads(draw.program, draw.target), &self.targets.solid) {
                    pass.set_bind_group(1, &solid.read, &[]);
                }
                match (reads(draw.program, draw.target), &self.targets.counts, self.mean(plan)) {
                    (Reads::Geometry, ..) => {
                        if let Some(kept) = &self.targets.geometry {
                            pass.set_bind_group(1, &kept.read, &[]);
                        }
                    }
                    (Reads::Targets, _, None) => pass.set_bind_group(1, &self.targets.read, &[]),
                    (Reads::Targets, _, Some(mean)) if draw.target == Target::Mean => pass.set_bind_group(1, &mean.gather, &[]),
                    (Reads::Targets, _, Some(mean)) => pass.set_bind_group(1, &mean.read, &[]),
                    (Reads::Counts | Reads::CountsEach, Some(counts), _) => pass.set_bind_group(1, &counts.read, &[]),
                    _ => {}
                }
                let bands = entry_of(draw.program).vertices == Vertices::Bands;
                pass.draw(if bands { 0..BANDS * 6 } else { 0..3 }, 0..1);
                drawn.draws += 1;
            }
            DrawSet::Surfaces(surfaces) => self.record_surfaces(pass, scene, surfaces, place.view, drawn),
            DrawSet::Runs(runs) => self.record_runs(pass, scene, runs, place.view, drawn),
            DrawSet::Swollen(swollen) => self.record_swollen(pass, scene, &swollen.surfaces, place.view, drawn),
            DrawSet::Volumes(parts) => self.record_volumes(pass, plan, (place.number, parts, draw.scissor), drawn),
            DrawSet::Enclosure(_) | DrawSet::Triangles(_) => self.record_enclosure(pass, place.number, drawn),
            DrawSet::Labels(_) => self.record_labels(pass, drawn),
            DrawSet::Strokes(_) => self.record_lines(pass, drawn),
            DrawSet::Edges(instances) => self.record_edges(pass, instances, place.view, drawn),
        }
    }

    fn record_surfaces(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        scene: &Scene,
        surfaces: &[Surface],
        view: usize,
        drawn: &mut Drawn,
    ) {
        let shown = &self.buffers.shown;
        let mut bound_instance = None;
        let mut bound_material = None;
        let mesh_of = |surface: &Surface| shown[surface.instance].mesh;
        let at_rest = |surface: &Surface| self.buffers.deformed[surface.instance].is_none();
        // What follows each other and differs by its instance's number alone is one call.
        let joins = |a: &Surface, b: &Surface| {
            let next = Surface { instance: a.instance + 1, ..*a };
            next == *b && mesh_of(a) == mesh_of(b) && at_rest(a) && at_rest(b)
        };
        for run in surfaces.chunk_by(joins) {
            let surface = run[0];
            let mesh_index = mesh_of(&surface);
            let primitive = scene.meshes[mesh_index].primitives[surface.primitive];
            if bound_instance != Some(surface.instance) {
                self.bind_mesh(pass, surface.instance, mesh_index);
                bound_instance = Some(surface.instance);
            }
            if bound_material != Some(primitive.material) {
                pass.set_bind_group(1, &self.buffers.materials[primitive.material], &[]);
                bound_material = Some(primitive.material);
            }
            let object = u32::try_from(view * shown.len() + surface.instance).unwrap_or(0);
            let count = u32::try_from(run.len()).unwrap_or(1);
            pass.draw_indexed(primitive.first_index..primitive.first_index + primitive.index_count, 0, object..object + count);
            drawn.draws += 1;
            drawn.triangles += u64::from(primitive.index_count / 3) * u64::from(count);
        }
    }

    /// The vertices of an instance and the indices of its mesh, as surfaces are drawn with.
    fn bind_mesh(&self, pass: &mut wgpu::RenderPass<'_>, instance: usize, mesh: usize) {
        let vertices = self.buffers.vertices(instance);
        pass.set_vertex_buffer(0, vertices.positions.slice(..));
        pass.set_vertex_buffer(1, vertices.attributes.slice(..));
        pass.set_index_buffer(self.buffers.meshes[mesh].indices.slice(..), wgpu::IndexFormat::Uint32);
    }

    fn record_runs(&self, pass: &mut wgpu::RenderPass<'_>, scene: &Scene, runs: &[Run], view: usize, drawn: &mut Drawn) {
        let shown = &self.buffers.shown;
        for Run { surface, triangles: [from, to] } in runs {
            let mesh_index = shown[surface.instance].mesh;
            let primitive = scene.meshes[mesh_index].primitives[surface.primitive];
            self.bind_mesh(pass, surface.instance, mesh_index);
            pass.set_bind_group(1, &self.buffers.materials[primitive.material], &[]);
            let object = u32::try_from(view * shown.len() + surface.instance).unwrap_or(0);
            pass.draw_indexed(primitive.first_index + from * 3..primitive.first_index + to * 3, 0, object..object + 1);
            drawn.draws += 1;
            drawn.triangles += u64::from(to - from);
        }
    }

    fn record_swollen(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        scene: &Scene,
        surfaces: &[Surface],
        view: usize,
        drawn: &mut Drawn,
    ) {
        let shown = &self.buffers.shown;
        for surface in surfaces {
            let mesh_index = shown[surface.instance].mesh;
            let primitive = scene.meshes[mesh_index].primitives[surface.primitive];
            let vertices = self.buffers.vertices(surface.instance);
            let Some(outward) = &vertices.outward else { continue };
            pass.set_vertex_buffer(0, vertices.positions.slice(..));
            pass.set_vertex_buffer(1, outward.slice(..));
            pass.set_index_buffer(self.buffers.meshes[mesh_index].indices.slice(..), wgpu::IndexFormat::Uint32);
            let object = u32::try_from(view * shown.len() + surface.instance).unwrap_or(0);
            pass.draw_indexed(primitive.first_index..primitive.first_index + primitive.index_count, 0, object..object + 1);
            drawn.draws += 1;
            drawn.triangles += u64::from(primitive.index_count / 3);
        }
    }

    fn record_enclosure(&self, pass: &mut wgpu::RenderPass<'_>, number: usize, drawn: &mut Drawn) {
        let found = self.frame.enclosures.iter().find(|(of, _)| *of == number);
        let (Some((_, range)), Some(buffer)) = (found, self.frame.enclosure_vertices.buffer()) else { return };
        pass.set_vertex_buffer(0, buffer.slice(..));
        pass.draw(range.clone(), 0..1);
        drawn.draws += 1;
        drawn.triangles += u64::from((range.end - range.start) / 3);
    }

    fn record_labels(&self, pass: &mut wgpu::RenderPass<'_>, drawn: &mut Drawn) {
        let Some(labels) = self.labels.get() else { return };
        pass.set_bind_group(1, labels.atlas, &[]);
        pass.set_vertex_buffer(0, labels.vertices.slice(..));
        pass.set_index_buffer(labels.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..labels.index_count, 0, 0..1);
        drawn.draws += 1;
        drawn.triangles += u64::from(labels.index_count / 3);
    }

    fn record_lines(&self, pass: &mut wgpu::RenderPass<'_>, drawn: &mut Drawn) {
        let Some((vertices, indices, index_count)) = self.lines.get() else { return };
        pass.set_vertex_buffer(0, vertices.slice(..));
        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..index_count, 0, 0..1);
        drawn.draws += 1;
        drawn.triangles += u64::from(index_count / 3);
    }

    fn record_edges(&self, pass: &mut wgpu::RenderPass<'_>, instances: &[usize], view: usize, drawn: &mut Drawn) {
        let shown = &self.buffers.shown;
        for &instance in instances {
            let Some((edges, count)) = &self.buffers.meshes[shown[instance].mesh].edges else { continue };
            pass.set_vertex_buffer(0, self.buffers.vertices(instance).positions.slice(..));
            pass.set_index_buffer(edges.slice(..), wgpu::IndexFormat::Uint32);
            let object = u32::try_from(view * shown.len() + instance).unwrap_or(0);
            pass.draw_indexed(0..*count, 0, object..object + 1);
            drawn.draws += 1;
        }
    }
}
