//! Volumes of small casters, drawn by one call a step.
//!
//! A call costs a software GPU as much as some thousand pixels, and a scene of many small casters makes one
//! for each part of each volume. So the vertices of small casters' volumes are put after one another into
//! one buffer, each tagged with its volume's number (`shared/volume.wgsl`), and the indices of neighbours in
//! a step too. Large casters keep the buffers of their meshes: copying those would cost more than the call.

use std::ops::Range;

use bytemuck::cast_slice;
use glam::Vec3;

use super::context::Context;
use super::growing::Growing;
use crate::frame::VolumePart;

/// Welded vertices of the largest caster that counts as small.
const SMALL: usize = 256;

/// Parts of a step that follow each other, as one range of indices.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Run {
    /// The step's number among the plan's draws.
    draw: usize,
    /// Which of its parts.
    pub parts: Range<usize>,
    /// Their indices.
    pub indices: Range<u32>,
}

/// The frame's merged volumes.
pub struct Merged {
    /// `Float32x4`, tagged.
    pub vertices: Growing,
    /// `u32`.
    pub indices: Growing,
    runs: Vec<Run>,
    /// Where each planned volume's vertices start, once they were needed.
    first: Vec<Option<u32>>,
    vertex_data: Vec<[f32; 4]>,
    index_data: Vec<u32>,
}

impl Default for Merged {
    fn default() -> Self {
        Self {
            vertices: Growing::new("merged volume vertices", wgpu::BufferUsages::VERTEX),
            indices: Growing::new("merged volume indices", wgpu::BufferUsages::INDEX),
            runs: Vec::new(),
            first: Vec::new(),
            vertex_data: Vec::new(),
            index_data: Vec::new(),
        }
    }
}

impl Merged {
    /// Starts a frame of so many planned volumes.
    pub fn clear(&mut self, volumes: usize) {
        self.runs.clear();
        self.vertex_data.clear();
        self.index_data.clear();
        self.first.clear();
        self.first.resize(volumes, None);
    }

    /// Merges what follows each other in a step and is small: `welded` says a volume's vertices where they may
    /// be copied, `each_index` walks a part's indices among them.
    pub fn append<'a>(
        &mut self,
        draw: usize,
        parts: &[VolumePart],
        welded: impl Fn(usize) -> Option<&'a [Vec3]>,
        each_index: impl Fn(VolumePart, &mut dyn FnMut(u32)),
    ) {
        let small = |part: &VolumePart| welded(part.volume).filter(|welded| welded.len() <= SMALL);
        let mut next = 0;
        for run in parts.chunk_by(|a, b| a.window == b.window && small(a).is_some() == small(b).is_some()) {
            let taken = next..next + run.len();
            next = taken.end;
            if run.len() < 2 || small(&run[0]).is_none() {
                continue;
            }
            let begin = count(self.index_data.len());
            for &part in run {
                let first = self.first_vertex(part.volume, small(&part).unwrap_or_default());
                each_index(part, &mut |index| self.index_data.push(first + index));
            }
            self.runs.push(Run { draw, parts: taken, indices: begin..count(self.index_data.len()) });
        }
    }

    fn first_vertex(&mut self, volume: usize, welded: &[Vec3]) -> u32 {
        *self.first[volume].get_or_insert_with(|| {
            let first = count(self.vertex_data.len());
            for w in [1.0, 0.0] {
                #[expect(clippy::cast_precision_loss, reason = "far below 2^23 volumes")]
                let tag = w + 2.0 * volume as f32;
                self.vertex_data.extend(welded.iter().map(|position| position.extend(tag).to_array()));
            }
            first
        })
    }

    /// Uploads what was appended.
    pub fn write(&mut self, context: &Context) {
        self.vertices.write(context, cast_slice(&self.vertex_data), 16);
        self.indices.write(context, cast_slice(&self.index_data), 4);
    }

    /// The run of a step that begins with this part.
    #[must_use]
    pub fn run(&self, draw: usize, part: usize) -> Option<&Run> {
        // Runs are in the order of steps and of their parts.
        let found = self.runs.binary_search_by(|run| (run.draw, run.parts.start).cmp(&(draw, part)));
        found.ok().map(|at| &self.runs[at])
    }
}

fn count(length: usize) -> u32 {
    u32::try_from(length).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;
    use crate::frame::Part;

    #[test]
    fn neighbours_that_are_small_are_merged_and_large_ones_left() {
        let (few, many) = (vec![Vec3::X; 4], vec![Vec3::Y; SMALL + 1]);
        let mut merged = Merged::default();
        merged.clear(5);
        let part = |volume| VolumePart::whole(volume, Part::Sides);
        let welded = |volume: usize| Some(if volume == 2 { many.as_slice() } else { few.as_slice() });
        let parts = [part(0), part(1), part(2), part(3), part(4), part(3)];
        merged.append(7, &parts, welded, |_, each| [0, 4, 7].into_iter().for_each(each));

        assert_eq!(merged.run(7, 0).unwrap().parts, 0..2);
        assert_eq!(merged.run(7, 3).unwrap().parts, 3..6);
        assert!(merged.run(7, 2).is_none() && merged.run(6, 0).is_none());
        // Volume 3 is drawn twice and there once, after volumes 0 and 1, of eight vertices each.
        assert_eq!(merged.index_data, [0, 4, 7, 8, 12, 15, 16, 20, 23, 24, 28, 31, 16, 20, 23]);
        assert_eq!(merged.vertex_data.len(), 4 * 8);
        assert_eq!([merged.vertex_data[16][3], merged.vertex_data[20][3]], [7.0, 6.0]);
    }

    #[test]
    fn one_part_alone_needs_no_copy() {
        let few = [Vec3::X; 4];
        let mut merged = Merged::default();
        merged.clear(1);
        merged.append(0, &[VolumePart::whole(0, Part::Sides)], |_| Some(&few), |_, each| each(0));
        assert!(merged.run(0, 0).is_none() && merged.vertex_data.is_empty());
    }
}
