//! Meshes bent by morph targets, skins, and transforms that have no inverse.
//!
//! Vertices that are welded have equal positions, displacements and joint bindings, and go through
//! the same arithmetic in the same order: they come out with equal bits, so that the topology of
//! the bind pose holds in every pose.
//!
//! Normals go through the cofactor matrix, which is the inverse transpose but for its length, exists
//! where there is no inverse, and keeps to the side that the triangles' winding shows.

use glam::{Affine3A, DAffine3, DMat3, Mat3A, Vec3, Vec3A};

use super::mesh::{flat_normals, unit_normals};
use super::{DeformedMesh, Mesh, Skin};
use crate::geometry::{Aabb, terminator};

/// A mesh that is to be bent.
pub(super) struct Bent<'a> {
    pub mesh: &'a Mesh,
    /// Of its morph targets.
    pub weights: &'a [f32],
    /// What it was before, whose memory is used.
    pub into: DeformedMesh,
}

impl Bent<'_> {
    /// By its morph targets alone; in object space.
    pub fn morphed(self) -> DeformedMesh {
        self.blended().finished()
    }

    /// By morph targets, then by joints; in world space, whatever the node's own transform. `joints` is scratch memory.
    pub fn skinned(self, skin: &Skin, world_from_node: &[DAffine3], joints: &mut Vec<Affine3A>) -> DeformedMesh {
        let mut bent = self.blended();
        joints.clear();
        joints.extend(skin.joints.iter().zip(&skin.inverse_bind).map(|(&joint, &joint_from_object)| {
            let world_from_joint = world_from_node.get(joint).copied().unwrap_or(DAffine3::IDENTITY);
            (world_from_joint * joint_from_object).as_affine3a()
        }));
        let DeformedMesh { positions, normals, .. } = &mut bent.into;
        for ((position, normal), bound) in positions.iter_mut().zip(normals).zip(&bent.mesh.skin) {
            let mut matrix = Mat3A::ZERO;
            let mut translation = Vec3A::ZERO;
            for (&joint, &weight) in bound.joints.iter().zip(&bound.weights).filter(|(_, weight)| **weight != 0.0) {
                let joint = joints.get(usize::from(joint)).copied().unwrap_or(Affine3A::IDENTITY);
                matrix += joint.matrix3 * weight;
                translation += joint.translation * weight;
            }
            *position = (matrix * Vec3A::from(*position) + translation).into();
            let cofactor = Mat3A::from_cols(
                matrix.y_axis.cross(matrix.z_axis),
                matrix.z_axis.cross(matrix.x_axis),
                matrix.x_axis.cross(matrix.y_axis),
            );
            *normal = (cofactor * Vec3A::from(*normal)).into();
        }
        bent.finished()
    }

    /// By morph targets, then by a transform; in world space.
    pub fn baked(self, world_from_node: &DAffine3) -> DeformedMesh {
        let mut bent = self.blended();
        let matrix = world_from_node.matrix3;
        let cofactor = DMat3::from_cols(
            matrix.y_axis.cross(matrix.z_axis),
            matrix.z_axis.cross(matrix.x_axis),
            matrix.x_axis.cross(matrix.y_axis),
        );
        for position in &mut bent.into.positions {
            *position = world_from_node.transform_point3(position.as_dvec3()).as_vec3();
        }
        for normal in &mut bent.into.normals {
            *normal = (cofactor * normal.as_dvec3()).normalize_or_zero().as_vec3();
        }
        bent.finished()
    }

    fn blended(mut self) -> Self {
        let Self { mesh, weights, into: DeformedMesh { positions, normals, .. } } = &mut self;
        positions.clone_from(&mesh.positions);
        normals.clone_from(&mesh.normals);
        for (morph, &weight) in mesh.morphs.iter().zip(*weights).filter(|(_, weight)| **weight != 0.0) {
            positions.iter_mut().zip(&morph.positions).for_each(|(position, moved)| *position += moved * weight);
            normals.iter_mut().zip(&morph.normals).for_each(|(normal, moved)| *normal += moved * weight);
        }
        self
    }

    fn finished(self) -> DeformedMesh {
        let Self { mesh, mut into, .. } = self;
        let DeformedMesh { positions, normals, terminator: sines, bounds, posed } = &mut into;
        // What grew past all numbers has no place to be drawn at; it must only not harm the rest.
        positions.iter_mut().filter(|position| !position.is_finite()).for_each(|position| *position = Vec3::ZERO);
        if mesh.flat {
            flat_normals(positions, normals);
        } else {
            unit_normals(positions, normals, &mesh.indices);
        }
        terminator::sines(positions, normals, &mesh.indices, sines);
        *bounds = Aabb::from_points(positions.iter().copied());
        posed.forget();
        into
    }
}
