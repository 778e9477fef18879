//! A mesh: vertices for drawing, triangles by material, and the welded topology that casts shadows.
//!
//! [`Mesh::new`] is the only way from a file's arrays to a mesh: it checks what the GPU and the
//! topology rely on, makes what is missing, and mends what can be mended without changing a shape.

use std::cmp::Ordering;

use glam::{Vec2, Vec3};
use thiserror::Error;

use crate::geometry::{Aabb, Posed, Topology, Weld, terminator, topology};

/// Triangles in object space. All vertex arrays have one entry a vertex.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    /// Its name in the file, or `mesh N`.
    pub name: String,
    /// Metres, all finite.
    pub positions: Vec<Vec3>,
    /// Unit length.
    pub normals: Vec<Vec3>,
    /// The file has no normals: every triangle has vertices of its own and one normal, in every pose.
    pub flat: bool,
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
    /// Weights of `morphs` where a node has none of its own; as many as there are morphs.
    pub morph_weights: Vec<f32>,
    /// Edges of the welded triangles: what silhouettes and volumes are made from.
    pub topology: Topology,
    /// As it is at rest.
    pub rest: Posed,
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
    /// False for blended materials: light passes them, so the topology leaves their triangles out.
    pub casts_shadow: bool,
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

/// What a mesh is made from. Vertex arrays that are there have one entry a position.
#[derive(Debug, Clone, Default)]
pub struct MeshParts {
    /// Its name in the file, or `mesh N`.
    pub name: String,
    /// Metres.
    pub positions: Vec<Vec3>,
    /// Any length but zero; without them the mesh is shaded flat, which is glTF's rule.
    pub normals: Option<Vec<Vec3>>,
    /// Of the base colour texture.
    pub uvs: Option<Vec<Vec2>>,
    /// Linear RGBA.
    pub colors: Option<Vec<[u8; 4]>>,
    /// Three a triangle.
    pub indices: Vec<u32>,
    /// Consecutive runs of `indices`.
    pub primitives: Vec<Primitive>,
    /// Empty, or one a vertex.
    pub skin: Vec<SkinVertex>,
    /// Shapes to blend in; each array empty, or one entry a vertex.
    pub morphs: Vec<MorphTarget>,
    /// Empty (all zero), or one a morph target.
    pub morph_weights: Vec<f32>,
}

/// Why parts are no mesh.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum MeshError {
    /// An array is neither empty nor as long as the positions.
    #[error("{found} {what} for {expected} {per}")]
    Length {
        /// The array.
        what: &'static str,
        /// Entries there should be.
        expected: usize,
        /// What there is one of for each entry.
        per: &'static str,
        /// Entries there are.
        found: usize,
    },
    /// A number is NaN or infinite.
    #[error("the {what} of vertex {vertex} is not a finite number")]
    NotFinite {
        /// The array.
        what: &'static str,
        /// Where in it.
        vertex: usize,
    },
    /// An index points past the vertices.
    #[error("index {at} is {index}, but there are {vertices} vertices")]
    Index {
        /// Where it stands.
        at: usize,
        /// What it is.
        index: u32,
        /// How many there are.
        vertices: usize,
    },
    /// The runs are no triangles, or leave gaps, or overlap, or end elsewhere than the indices.
    #[error("primitive {0} does not continue the triangles before it")]
    Primitives(usize),
    /// More than the topology can number.
    #[error("too large: {0} vertices or indices")]
    TooLarge(usize),
}

impl Mesh {
    /// Checks the parts, makes what is missing (flat normals, zero texture coordinates, white),
    /// makes normals unit length and joint weights sum to one, and builds topology, terminator
    /// bounds and box. Normals and texture coordinates that are not numbers are replaced, for they
    /// harm nobody; positions that are not are an error.
    ///
    /// # Errors
    /// As [`MeshError`] lists.
    pub fn new(mut parts: MeshParts) -> Result<Self, MeshError> {
        parts.check()?;
        let flat = parts.normals.is_none();
        if flat {
            parts.split();
        }
        let normals = match parts.normals.take() {
            Some(mut given) => {
                unit_normals(&parts.positions, &mut given, &parts.indices);
                given
            }
            None => {
                let mut normals = Vec::new();
                flat_normals(&parts.positions, &mut normals);
                normals
            }
        };
        let vertices = parts.positions.len();
        let mut uvs = parts.uvs.unwrap_or_else(|| vec![Vec2::ZERO; vertices]);
        uvs.iter_mut().filter(|uv| !uv.is_finite()).for_each(|uv| *uv = Vec2::ZERO);
        parts.skin.iter_mut().for_each(SkinVertex::normalize);
        parts.morph_weights.resize(parts.morphs.len(), 0.0);

        let weld = Weld::new(&parts.positions, |a, b| moves_alike(&parts.skin, &parts.morphs, a as usize, b as usize));
        let mut casts = vec![false; parts.indices.len() / 3];
        for primitive in &parts.primitives {
            let first = primitive.first_index as usize / 3;
            casts[first..first + primitive.index_count as usize / 3].fill(primitive.casts_shadow);
        }
        let topology = Topology::build(&parts.indices, &parts.positions, weld, |triangle| casts[triangle as usize]);
        let mut sines = Vec::new();
        terminator::sines(&parts.positions, &normals, &parts.indices, &mut sines);
        Ok(Self {
            name: parts.name,
            bounds: Aabb::from_points(parts.positions.iter().copied()),
            rest: Posed::new(&topology, &parts.positions),
            positions: parts.positions,
            normals,
            flat,
            uvs,
            colors: parts.colors.unwrap_or_else(|| vec![[255; 4]; vertices]),
            indices: parts.indices,
            primitives: parts.primitives,
            skin: parts.skin,
            morphs: parts.morphs,
            morph_weights: parts.morph_weights,
            topology,
            terminator: sines,
        })
    }

    /// The vertices of a primitive's triangles; none where there is no such primitive.
    pub fn triangles(&self, primitive: usize) -> impl Iterator<Item = [u32; 3]> + Clone {
        let run = self.primitives.get(primitive).map_or(0..0, |run| {
            let first = run.first_index as usize;
            first..first + run.index_count as usize
        });
        self.indices[run].as_chunks::<3>().0.iter().copied()
    }

    /// Something moves its vertices against each other.
    #[must_use]
    pub fn is_deformable(&self) -> bool {
        !self.morphs.is_empty() || !self.skin.is_empty()
    }
}

impl MeshParts {
    fn check(&self) -> Result<(), MeshError> {
        let vertices = self.positions.len();
        let largest = vertices.max(self.indices.len());
        if largest > topology::LARGEST {
            return Err(MeshError::TooLarge(largest));
        }
        let per = |what, expected, per, found| {
            if found == expected { Ok(()) } else { Err(MeshError::Length { what, expected, per, found }) }
        };
        let per_vertex = |what, found| per(what, vertices, "vertices", found);
        let per_vertex_or_none = |what, found| if found == 0 { Ok(()) } else { per_vertex(what, found) };
        per_vertex("normals", self.normals.as_ref().map_or(vertices, Vec::len))?;
        per_vertex("texture coordinates", self.uvs.as_ref().map_or(vertices, Vec::len))?;
        per_vertex("colours", self.colors.as_ref().map_or(vertices, Vec::len))?;
        per_vertex_or_none("joint bindings", self.skin.len())?;
        if !self.morph_weights.is_empty() {
            per("morph weights", self.morphs.len(), "morph targets", self.morph_weights.len())?;
        }
        let finite = |what, values: &[Vec3]| match values.iter().position(|value| !value.is_finite()) {
            None => Ok(()),
            Some(vertex) => Err(MeshError::NotFinite { what, vertex }),
        };
        finite("position", &self.positions)?;
        for morph in &self.morphs {
            per_vertex_or_none("morph displacements", morph.positions.len())?;
            per_vertex_or_none("morph normals", morph.normals.len())?;
            finite("morph displacement", &morph.positions)?;
            finite("morph normal", &morph.normals)?;
        }
        if let Some(vertex) = self.skin.iter().position(|bound| !bound.weights.iter().all(|weight| weight.is_finite())) {
            return Err(MeshError::NotFinite { what: "joint weight", vertex });
        }
        if let Some(vertex) = self.morph_weights.iter().position(|weight| !weight.is_finite()) {
            return Err(MeshError::NotFinite { what: "morph weight", vertex });
        }
        if let Some((at, &index)) = self.indices.iter().enumerate().find(|(_, index)| **index as usize >= vertices) {
            return Err(MeshError::Index { at, index, vertices });
        }
        let mut end = 0;
        for (number, primitive) in self.primitives.iter().enumerate() {
            let count = primitive.index_count as usize;
            if primitive.first_index as usize != end || !count.is_multiple_of(3) {
                return Err(MeshError::Primitives(number));
            }
            end += count;
        }
        if end == self.indices.len() { Ok(()) } else { Err(MeshError::Primitives(self.primitives.len())) }
    }

    /// Gives every triangle vertices of its own, in order.
    fn split(&mut self) {
        fn spread<T: Copy>(values: &mut Vec<T>, indices: &[u32]) {
            if !values.is_empty() {
                *values = indices.iter().map(|&index| values[index as usize]).collect();
            }
        }
        let indices = &self.indices;
        spread(&mut self.positions, indices);
        self.uvs.iter_mut().for_each(|uvs| spread(uvs, indices));
        self.colors.iter_mut().for_each(|colors| spread(colors, indices));
        spread(&mut self.skin, indices);
        for morph in &mut self.morphs {
            spread(&mut morph.positions, indices);
            // The spec: without normals, those of morph targets mean nothing either.
            morph.normals.clear();
        }
        self.indices = (0..indices.len() as u32).collect();
    }
}

impl SkinVertex {
    fn normalize(&mut self) {
        self.weights = self.weights.map(|weight| weight.max(0.0));
        let sum: f64 = self.weights.iter().map(|weight| f64::from(*weight)).sum();
        self.weights = if sum > 0.0 { self.weights.map(|weight| (f64::from(weight) / sum) as f32) } else { [1.0, 0.0, 0.0, 0.0] };
        // A joint without weight moves nothing, and must not keep apart what is welded.
        for (joint, _) in self.joints.iter_mut().zip(&self.weights).filter(|(_, weight)| **weight == 0.0) {
            *joint = 0;
        }
    }
}

/// The face normals of a mesh whose every triangle has vertices of its own, in order; up for
/// triangles without area, which nobody sees. `normals` is cleared first.
pub(super) fn flat_normals(positions: &[Vec3], normals: &mut Vec<Vec3>) {
    normals.clear();
    for triangle in positions.as_chunks::<3>().0 {
        normals.extend([terminator::face_normal(*triangle).unwrap_or(Vec3::Y); 3]);
    }
}

/// Makes normals unit length; one of a triangle's own where there is no direction in them.
pub(super) fn unit_normals(positions: &[Vec3], normals: &mut [Vec3], indices: &[u32]) {
    let mut lost = false;
    for normal in &mut *normals {
        // In double precision, where tiny and huge ones have a length too.
        *normal = normal.as_dvec3().try_normalize().map_or(Vec3::ZERO, |unit| unit.as_vec3());
        lost |= *normal == Vec3::ZERO;
    }
    if lost {
        for triangle in indices.as_chunks::<3>().0 {
            let mut face = None;
            for vertex in triangle.map(|vertex| vertex as usize) {
                if normals[vertex] == Vec3::ZERO {
                    let face =
                        face.get_or_insert_with(|| terminator::face_normal(triangle.map(|vertex| positions[vertex as usize])));
                    normals[vertex] = face.unwrap_or(Vec3::ZERO);
                }
            }
        }
        normals.iter_mut().filter(|normal| **normal == Vec3::ZERO).for_each(|normal| *normal = Vec3::Y);
    }
}

/// Orders two vertices by all that deforms them; equal ones stay together in every pose.
fn moves_alike(skin: &[SkinVertex], morphs: &[MorphTarget], a: usize, b: usize) -> Ordering {
    let bits = |value: f32| (value + 0.0).to_bits();
    let binding = |vertex: usize| skin.get(vertex).map(|bound| (bound.joints, bound.weights.map(bits)));
    let mut order = binding(a).cmp(&binding(b));
    for morph in morphs {
        let moved = |vertex: usize| morph.positions.get(vertex).map(|moved| moved.to_array().map(bits));
        order = order.then_with(|| moved(a).cmp(&moved(b)));
    }
    order
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails may panic")]
    use super::*;

    fn square() -> MeshParts {
        MeshParts {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y],
            indices: vec![0, 1, 2, 0, 2, 3],
            primitives: vec![Primitive { first_index: 0, index_count: 6, material: 0, casts_shadow: true }],
            ..MeshParts::default()
        }
    }

    #[test]
    fn missing_normals_are_flat_and_welding_survives_the_split() {
        let mesh = Mesh::new(square()).unwrap();
        assert!(mesh.flat);
        assert_eq!(mesh.normals, [Vec3::Z; 6]);
        assert_eq!(mesh.indices, [0, 1, 2, 3, 4, 5]);
        assert_eq!(mesh.topology.report().welded_vertices, 4);
        assert_eq!(mesh.topology.pairs().a.len(), 1);
        assert_eq!((mesh.uvs.len(), mesh.colors.len(), mesh.terminator.len()), (6, 6, 6));
        assert_eq!(mesh.bounds, Aabb { min: Vec3::ZERO, max: Vec3::X + Vec3::Y });
    }

    #[test]
    fn given_normals_become_unit_and_lost_ones_a_faces() {
        let normals = vec![Vec3::ZERO, Vec3::X * 1e-30, Vec3::splat(f32::NAN), Vec3::Y * 1e30];
        let mesh = Mesh::new(MeshParts { normals: Some(normals), ..square() }).unwrap();
        assert_eq!(mesh.normals, [Vec3::Z, Vec3::X, Vec3::Z, Vec3::Y]);
        assert!(!mesh.flat);
    }

    #[test]
    fn vertices_that_move_apart_are_not_welded() {
        let moved = |last| MeshParts {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ZERO, Vec3::Y, Vec3::NEG_X],
            indices: (0..6).collect(),
            morphs: vec![MorphTarget {
                positions: vec![Vec3::Z, Vec3::ZERO, Vec3::X, last, Vec3::X, Vec3::ZERO],
                normals: vec![],
            }],
            ..square()
        };
        assert_eq!(Mesh::new(moved(Vec3::Z)).unwrap().topology.report().border_edges, 4);
        assert_eq!(Mesh::new(moved(Vec3::Y)).unwrap().topology.report().border_edges, 6);
        let bound = |joint| SkinVertex { joints: [joint, 0, 0, 0], weights: [2.0, 0.0, 0.0, 0.0] };
        let skinned =
            |last| MeshParts { skin: vec![bound(0), bound(0), bound(1), bound(0), bound(last), bound(0)], ..moved(Vec3::Z) };
        assert_eq!(Mesh::new(skinned(1)).unwrap().topology.report().border_edges, 4);
        assert_eq!(Mesh::new(skinned(2)).unwrap().topology.report().border_edges, 6);
        assert_eq!(Mesh::new(skinned(1)).unwrap().skin[0].weights, [1.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn blended_triangles_cast_nothing() {
        let run = |first_index, casts_shadow| Primitive { first_index, index_count: 3, material: 0, casts_shadow };
        let mesh = Mesh::new(MeshParts { primitives: vec![run(0, false), run(3, true)], ..square() }).unwrap();
        assert_eq!(mesh.topology.mesh_triangles(), [1]);
    }

    #[test]
    fn what_is_no_mesh_is_told() {
        let error = |parts: MeshParts| Mesh::new(parts).unwrap_err().to_string();
        let mut parts = square();
        parts.positions[2].y = f32::NAN;
        assert_eq!(error(parts), "the position of vertex 2 is not a finite number");
        let mut parts = square();
        parts.indices[4] = 4;
        assert_eq!(error(parts), "index 4 is 4, but there are 4 vertices");
        assert_eq!(error(MeshParts { uvs: Some(vec![]), ..square() }), "0 texture coordinates for 4 vertices");
        assert_eq!(error(MeshParts { morph_weights: vec![1.0], ..square() }), "1 morph weights for 0 morph targets");
        let mut parts = square();
        parts.primitives[0].index_count = 5;
        assert_eq!(error(parts), "primitive 0 does not continue the triangles before it");
        let mut parts = square();
        parts.primitives[0].index_count = 3;
        assert_eq!(error(parts), "primitive 1 does not continue the triangles before it");
    }

    #[test]
    fn a_mesh_of_nothing_is_a_mesh() {
        let mesh = Mesh::new(MeshParts::default()).unwrap();
        assert!(mesh.bounds.is_empty());
        assert!(!mesh.topology.report().is_solid());
    }
}
