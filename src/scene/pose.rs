//! A scene at one point in time: world matrices, deformed meshes, lights in the world.

use glam::{DAffine3, DVec3, Vec3};

use super::LightKind;
use crate::geometry::Aabb;

/// Everything about a scene that depends on time.
#[derive(Debug, Clone, Default)]
pub struct Pose {
    /// Seconds.
    pub time: f64,
    /// One per node.
    pub world_from_node: Vec<DAffine3>,
    /// One per node: the vertices of meshes that skins or morph targets bend, or that a transform
    /// without inverse flattens.
    pub deformed: Vec<Option<DeformedMesh>>,
    /// One per node: where the mesh it shows is in the world. Identity for meshes deformed in
    /// world space (skinned or flattened ones); otherwise the node's own.
    pub world_from_object: Vec<DAffine3>,
    /// One per light of the scene.
    pub lights: Vec<PosedLight>,
}

/// A mesh's vertex data, replaced for this point in time. Same lengths as the mesh's.
#[derive(Debug, Clone, Default)]
pub struct DeformedMesh {
    /// Object space metres (world space for skinned meshes).
    pub positions: Vec<Vec3>,
    /// Unit.
    pub normals: Vec<Vec3>,
    /// As [`super::Mesh::terminator`].
    pub terminator: Vec<f32>,
    /// Of `positions`.
    pub bounds: Aabb,
}

/// A light in world space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PosedLight {
    /// Metres; for directional lights just where the node is.
    pub position: DVec3,
    /// Unit; where a directional or spot light shines to.
    pub direction: DVec3,
    /// Point, directional or spot.
    pub kind: LightKind,
    /// Linear RGB times intensity: candela, or lux for directional lights.
    pub intensity: Vec3,
    /// Metres, infinite allowed.
    pub range: f64,
    /// Shines at all.
    pub on: bool,
    /// Casts shadows.
    pub shadows: bool,
}
