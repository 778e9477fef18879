//! Meshes bent by morph targets, skins, and transforms that have no inverse.
//!
//! Vertices that are welded have equal positions, displacements and joint bindings, and go through
//! the same arithmetic in the same order: they come out with equal bits, so that the topology of
//! the bind pose holds in every pose.
//!
//! Normals go through the cofactor matrix, which is the inverse transpose but for its length, exists
//! where there is no inverse, and keeps to the side that the triangles' winding shows.

use std::sync::OnceLock;

use glam::{Affine3A, DAffine3, DMat3, Mat3A, Vec3, Vec3A};

use super::mesh::{flat_normals, unit_normals};
use super::{DeformedMesh, Mesh, Skin};
use crate::geometry::{Aabb, terminator};

/// By its morph targets alone; in object space.
pub(super) fn morphed(mesh: &Mesh, weights: &[f32]) -> DeformedMesh {
    let (positions, normals) = blended(mesh, weights);
    finished(mesh, positions, normals)
}

/// By morph targets, then by joints; in world space, whatever the node's own transform.
pub(super) fn skinned(mesh: &Mesh, weights: &[f32], skin: &Skin, world_from_node: &[DAffine3]) -> DeformedMesh {
    let (mut positions, mut normals) = blended(mesh, weights);
    let joints: Vec<Affine3A> = skin
        .joints
        .iter()
        .zip(&skin.inverse_bind)
        .map(|(&joint, &joint_from_object)| {
            let world_from_joint = world_from_node.get(joint).copied().unwrap_or(DAffine3::IDENTITY);
            (world_from_joint * joint_from_object).as_affine3a()
        })
        .collect();
    for ((position, normal), bound) in positions.iter_mut().zip(&mut normals).zip(&mesh.skin) {
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
    finished(mesh, positions, normals)
}

/// By morph targets, then by a transform; in world space.
pub(super) fn baked(mesh: &Mesh, weights: &[f32], world_from_node: &DAffine3) -> DeformedMesh {
    let (mut positions, mut normals) = blended(mesh, weights);
    let matrix = world_from_node.matrix3;
    let cofactor = DMat3::from_cols(
        matrix.y_axis.cross(matrix.z_axis),
        matrix.z_axis.cross(matrix.x_axis),
        matrix.x_axis.cross(matrix.y_axis),
    );
    for position in &mut positions {
        *position = world_from_node.transform_point3(position.as_dvec3()).as_vec3();
    }
    for normal in &mut normals {
        *normal = (cofactor * normal.as_dvec3()).normalize_or_zero().as_vec3();
    }
    finished(mesh, positions, normals)
}

fn blended(mesh: &Mesh, weights: &[f32]) -> (Vec<Vec3>, Vec<Vec3>) {
    let (mut positions, mut normals) = (mesh.positions.clone(), mesh.normals.clone());
    for (morph, &weight) in mesh.morphs.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
        positions.iter_mut().zip(&morph.positions).for_each(|(position, moved)| *position += moved * weight);
        normals.iter_mut().zip(&morph.normals).for_each(|(normal, moved)| *normal += moved * weight);
    }
    (positions, normals)
}

fn finished(mesh: &Mesh, mut positions: Vec<Vec3>, mut normals: Vec<Vec3>) -> DeformedMesh {
    // What grew past all numbers has no place to be drawn at; it must only not harm the rest.
    positions.iter_mut().filter(|position| !position.is_finite()).for_each(|position| *position = Vec3::ZERO);
    if mesh.flat {
        flat_normals(&positions, &mut normals);
    } else {
        normals = unit_normals(&positions, normals, &mesh.indices);
    }
    let mut sines = Vec::new();
    terminator::sines(&positions, &normals, &mesh.indices, &mut sines);
    let bounds = Aabb::from_points(positions.iter().copied());
    DeformedMesh { bounds, positions, normals, terminator: sines, posed: OnceLock::new() }
}
