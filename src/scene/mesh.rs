//! A mesh: vertices for drawing, triangles by material, and the welded topology that casts shadows.

use glam::{Vec2, Vec3};

use crate::geometry::{Aabb, Topology};

/// Triangles in object space. All vertex arrays have one entry a vertex.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    /// Its name in the file, or `mesh N`.
    pub name: String,
    /// Metres, all finite.
    pub positions: Vec<Vec3>,
    /// Unit length.
    pub normals: Vec<Vec3>,
    /// Of the base colour texture; zeros where the file has none.
    pub uvs: Vec<Vec2>,
    /// Linear RGBA, 8 bits; white where the file has none.
    pub colors: Vec<[u8; 4]>,
    /// Three a triangle, counter-clockwise seen from the front; all in range.
    pub indices: Vec<u32>,
    /// Consecutive runs of `indices`, one material each, together all of them.
    pub primitives: Vec<Primitive>,
    /// Empty, or one joint binding a vertex.
    pub skin: Vec<SkinVertex>,
    /// Shapes to blend in.
    pub morphs: Vec<MorphTarget>,
    /// Weights of `morphs` where a node has none of its own.
    pub morph_weights: Vec<f32>,
    /// Edges of the welded triangles: what silhouettes and volumes are made from.
    pub topology: Topology,
    /// Sine of the largest angle between a vertex's normal and its triangles' normals: see
    /// [`crate::geometry::terminator`].
    pub terminator: Vec<f32>,
    /// Of `positions`.
    pub bounds: Aabb,
}

/// A run of a mesh's triangles with one material.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Primitive {
    /// Into the mesh's `indices`.
    pub first_index: u32,
    /// A multiple of 3.
    pub index_count: u32,
    /// Into the scene's materials.
    pub material: usize,
}

/// Which joints move a vertex, and how much.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SkinVertex {
    /// Into the skin's joints.
    pub joints: [u16; 4],
    /// Not negative, adding up to 1.
    pub weights: [f32; 4],
}

/// Displacements of a mesh's vertices; an empty array means none.
#[derive(Debug, Clone, Default)]
pub struct MorphTarget {
    /// Metres.
    pub positions: Vec<Vec3>,
    /// Added before the normal is made unit again.
    pub normals: Vec<Vec3>,
}
