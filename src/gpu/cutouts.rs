//! The volumes of cut-outs: their indices, and the vertices of those that the mesh has not.
//!
//! A planar caster's cut-out is the mesh itself, so its volume indexes the mesh's own volume vertices,
//! and the near ones are the drawn surface's to the last bit. A flattened silhouette is a new figure
//! each frame: K's prism, its outline at z = 0 and again at z = 1, all of it placed by the volume's
//! matrix. Such vertices have w = 0, which is what sends a vertex through the matrix.
//!
//! A caster that a receiver's plane cuts has new vertices too: its light cap, as far as it throws a planar shadow.

use glam::{DVec4, Mat4, Vec3, Vec4};

use crate::frame::{Cutout, CutoutShape};
use crate::geometry::cutout::append_cutout;
use crate::geometry::flatten::Flattener;
use crate::geometry::planar_shadow::append_over;
use crate::geometry::silhouette::silhouette;
use crate::geometry::volume::{Caster, VolumeIndices, VolumeParts};
use crate::geometry::{Facing, LitPlane, Portion};

/// Memory that cut-outs' volumes are built in, kept from frame to frame.
#[derive(Default)]
pub struct CutoutScratch {
    /// Of this frame's flattened silhouettes, `Float32x4`.
    pub vertices: Vec<[f32; 4]>,
    facing: Facing,
    edges: Vec<[u32; 2]>,
    flattener: Flattener,
}

/// The matrix that places a cut-out's vertices with w = 0 in object space.
#[must_use]
pub fn thrown(cutout: &Cutout) -> Mat4 {
    match cutout.shape {
        CutoutShape::Planar => cutout.throw.thrown_from_object(),
        CutoutShape::Flattened => cutout.throw.object_from_prism(&cutout.plane),
    }
    .as_mat4()
}

impl CutoutScratch {
    /// Appends a portion's vertices, as they are and to be thrown; gives where they start.
    pub fn append_portion(&mut self, portion: &Portion) -> u32 {
        let first = self.vertices.len() as u32;
        for w in [1.0, 0.0] {
            self.vertices.extend(portion.welded.iter().map(|place| place.extend(w).to_array()));
        }
        first
    }

    /// Appends the light cap of `caster` as far as it lies over a plane: of its object space, heights in metres.
    pub fn append_over(
        &mut self,
        caster: Caster<'_>,
        light: Vec4,
        onto: (DVec4, &LitPlane),
        indices: &mut Vec<u32>,
    ) -> (VolumeIndices, Option<u32>) {
        let Caster { topology, welded, planes, .. } = caster;
        self.facing.decide(topology, planes, welded, light);
        let first = self.vertices.len();
        append_over((topology, welded), self.facing.contributions(), onto, &mut self.vertices);
        let start = indices.len() as u32;
        indices.extend(0..(self.vertices.len() - first) as u32);
        let light_cap_kept = start..indices.len() as u32;
        (VolumeIndices { light_cap_kept, ..VolumeIndices::default() }, Some(first as u32))
    }

    /// Appends the volume thrown from a cut-out of `caster`. Also where its vertices start among
    /// [`Self::vertices`], or `None` where they are the mesh's own.
    pub fn append(
        &mut self,
        caster: Caster<'_>,
        light: Vec4,
        cutout: &Cutout,
        parts: VolumeParts,
        indices: &mut Vec<u32>,
    ) -> (VolumeIndices, Option<u32>) {
        let Caster { topology, welded, planes, .. } = caster;
        match cutout.shape {
            CutoutShape::Planar => {
                let towards = cutout.plane.normal() * cutout.plane.height(cutout.throw.light).signum();
                self.facing.decide_planar(topology, welded, towards);
                silhouette(topology, &self.facing, &mut self.edges);
                let counted = |contribution| {
                    let all = topology.triangles().iter().zip(self.facing.contributions());
                    all.filter(move |(_, counts)| **counts == contribution).map(|(triangle, _)| *triangle)
                };
                let vertices = topology.weld().len() as u32;
                (append_cutout(vertices, &self.edges, counted(1), counted(-1), parts, indices), None)
            }
            CutoutShape::Flattened => {
                self.facing.decide(topology, planes, welded, light);
                silhouette(topology, &self.facing, &mut self.edges);
                let outline = self.flattener.flatten(welded, &self.edges, &cutout.plane, cutout.throw.light);
                let first = self.vertices.len() as u32;
                for z in [0.0, 1.0] {
                    self.vertices.extend(outline.points.iter().map(|point| {
                        let Vec3 { x, y, z } = point.as_vec2().extend(z);
                        [x, y, z, 0.0]
                    }));
                }
                let counted = outline.triangles.iter().copied();
                let none = std::iter::empty();
                let count = outline.points.len() as u32;
                (append_cutout(count, &outline.edges, counted, none, parts, indices), Some(first))
            }
        }
    }
}
