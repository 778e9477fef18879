//! Recording the parts of shadow volumes: within their windows, merged where they are small, by arguments of the device's
//! own where it finds silhouettes.

use std::ops::Range;

use super::compute::ARGUMENTS;
use super::encode::{Drawn, Encode};
use super::frame_buffers::range_of;
use super::merged;
use crate::frame::{FramePlan, VolumePart};
use crate::geometry::pixels::common;

impl Encode<'_> {
    pub(super) fn record_volumes(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        plan: &FramePlan,
        (number, parts, scissor): (usize, &[VolumePart], [u32; 4]),
        drawn: &mut Drawn,
    ) {
        let (Some(long), Some(short)) = (self.frame.indices.buffer(), self.frame.short_indices.buffer()) else { return };
        let mut bound = None;
        let mut bound_format = None;
        let (mut merged_to, mut computed_to) = (0, 0);
        let mut window = None;
        for (at, part) in parts.iter().enumerate() {
            // Of a window that lies beside the draw's pixels nothing is drawn.
            let Some([x, y, width, height]) = common(part.window.unwrap_or(scissor), scissor) else { continue };
            if window != part.window {
                pass.set_scissor_rect(x, y, width, height);
                window = part.window;
            }
            if let Some(run) = self.frame.merged.run(number, at) {
                self.record_merged(pass, run, drawn);
                merged_to = run.parts.end;
                (bound, bound_format) = (None, None);
            }
            if at < merged_to.max(computed_to) {
                continue;
            }
            if let Some(slot) = self.frame.compute.slot(*part) {
                let vertices_of = |part: &VolumePart| self.buffers.vertices(plan.volumes[part.volume].instance);
                let vertices = vertices_of(part);
                // What is of the same vertices and stands next to each other among the arguments is one call.
                let next = |(part, slot): &(&VolumePart, u32)| {
                    let same = part.window == window && std::ptr::eq(vertices_of(part), vertices);
                    same && self.frame.compute.slot(**part) == Some(*slot)
                };
                let count = 1 + parts[at + 1..].iter().zip(slot + 1..).take_while(next).count();
                self.record_computed(pass, slot..slot + u32::try_from(count).unwrap_or(1), &vertices.volume);
                computed_to = at + count;
                (bound, bound_format) = (None, None);
                drawn.draws += 1;
                continue;
            }
            let (indices, format) = &self.frame.volume_indices[part.volume];
            let range = range_of(indices, part.part);
            if range.is_empty() {
                continue;
            }
            if bound_format != Some(*format) {
                let buffer = if *format == wgpu::IndexFormat::Uint16 { short } else { long };
                pass.set_index_buffer(buffer.slice(..), *format);
                bound_format = Some(*format);
            }
            let first_vertex = self.frame.first_vertices[part.volume];
            let instance = plan.volumes[part.volume].instance;
            let vertices_of = if first_vertex.is_some() { Bound::Cutouts } else { Bound::Instance(instance) };
            if bound != Some(vertices_of) {
                let of_mesh = || &self.buffers.vertices(instance).volume;
                let buffer = if first_vertex.is_some() { self.frame.cutout_vertices.buffer() } else { Some(of_mesh()) };
                let Some(buffer) = buffer else { continue };
                pass.set_vertex_buffer(0, buffer.slice(..));
                bound = Some(vertices_of);
            }
            let volume = u32::try_from(part.volume).unwrap_or(0);
            let triangles = u64::from((range.end - range.start) / 3);
            let base_vertex = first_vertex.and_then(|first| i32::try_from(first).ok()).unwrap_or(0);
            pass.draw_indexed(range, base_vertex, volume..volume + 1);
            drawn.draws += 1;
            drawn.triangles += triangles;
            drawn.volume_triangles += triangles;
        }
    }

    /// Parts whose indices a compute shader has found: it alone knows how many.
    fn record_computed(&self, pass: &mut wgpu::RenderPass<'_>, slots: Range<u32>, vertices: &wgpu::Buffer) {
        let compute = &self.frame.compute;
        let (Some(indices), Some(draws)) = (compute.indices.buffer(), compute.draws.buffer()) else { return };
        pass.set_vertex_buffer(0, vertices.slice(..));
        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.multi_draw_indexed_indirect(draws, u64::from(slots.start) * ARGUMENTS, slots.len() as u32);
    }

    fn record_merged(&self, pass: &mut wgpu::RenderPass<'_>, run: &merged::Run, drawn: &mut Drawn) {
        let merged = &self.frame.merged;
        let (Some(vertices), Some(indices)) = (merged.vertices.buffer(), merged.indices.buffer()) else { return };
        if run.indices.is_empty() {
            return;
        }
        pass.set_vertex_buffer(0, vertices.slice(..));
        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
        // The vertices are tagged with their volumes' numbers from 0.
        pass.draw_indexed(run.indices.clone(), 0, 0..1);
        let triangles = u64::from((run.indices.end - run.indices.start) / 3);
        drawn.draws += 1;
        drawn.triangles += triangles;
        drawn.volume_triangles += triangles;
    }
}

/// Whose volume vertices are bound.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Bound {
    Instance(usize),
    Cutouts,
}
