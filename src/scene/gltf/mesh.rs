//! A glTF mesh's primitives, put together into one mesh of ours.
//!
//! Each primitive takes only the vertices that its triangles use: files often cut one large vertex
//! array into many primitives. Primitives without normals in a mesh where others have some get a
//! vertex for each triangle corner and the triangle's normal, which is glTF's rule.

use std::collections::BTreeMap;
use std::collections::HashMap;
use std::rc::Rc;

use glam::{Affine2, Vec2, Vec3};
use gltf::json;
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::mesh::{Mode, Semantic};
use gltf::json::validation::Checked;

use super::accessor::{self, Floats, Store};
use super::error::{AccessorError, Problem, Warnings, name, part};
use crate::geometry::terminator::face_normal;
use crate::scene::mesh::MeshParts;
use crate::scene::{Mesh, MorphTarget, Primitive, SkinVertex};

/// Where a material's base colour texture takes its coordinates from.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct UvSource {
    /// TEXCOORD_n.
    pub set: u32,
    /// KHR_texture_transform, which is worked into the vertices.
    pub transform: Option<Affine2>,
}

/// What a mesh has to know of a material.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct MaterialUse {
    pub uvs: UvSource,
    /// Blended materials and decals cast no shadows.
    pub shadeless: bool,
}

/// More than anybody makes; each is a weight a node.
const MOST_MORPH_TARGETS: usize = 4096;
/// Vertex and topology bytes of a vertex and of a triangle, about, for the memory budget.
const VERTEX_BYTES: u64 = 128;
const TRIANGLE_BYTES: u64 = 160;

/// One primitive's triangles: which source vertex each of its vertices is, and three of them a triangle.
struct Corners {
    sources: Vec<u32>,
    indices: Vec<u32>,
}

/// Builds mesh `index`; `None` when there is no triangle in it. `materials` has one entry a material of
/// the file and the default one behind them.
pub(super) fn import(
    store: &Store<'_>,
    index: usize,
    mesh: &json::Mesh,
    materials: &[MaterialUse],
    warnings: &mut Warnings,
) -> Result<Option<Mesh>, Problem> {
    let named = || part("mesh", index, mesh.name.as_deref());
    let drawn = |primitive: &&json::mesh::Primitive| match primitive.mode {
        Checked::Valid(mode) => !matches!(mode, Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip),
        Checked::Invalid => true, // told below
    };
    let any =
        |semantic: &Semantic| mesh.primitives.iter().filter(drawn).any(|primitive| attribute(primitive, semantic).is_some());
    let targets = mesh.primitives.iter().filter(drawn).map(|primitive| primitive.targets.as_ref().map_or(0, Vec::len));
    let targets = targets.max().unwrap_or(0);
    if targets > MOST_MORPH_TARGETS {
        return Err(Problem::Part { part: named(), what: format!("{targets} morph targets; the limit is {MOST_MORPH_TARGETS}") });
    }
    let has_normals = any(&Semantic::Normals);
    let has_skin = any(&Semantic::Joints(0)) && any(&Semantic::Weights(0));
    let mut parts = MeshParts {
        name: name("mesh", index, mesh.name.as_deref()),
        normals: has_normals.then(Vec::new),
        uvs: Some(Vec::new()),
        colors: any(&Semantic::Colors(0)).then(Vec::new),
        morphs: vec![MorphTarget::default(); targets],
        ..MeshParts::default()
    };
    for (number, primitive) in mesh.primitives.iter().enumerate() {
        let builder = Builder { store, primitive, name: &|| format!("{}, primitive {number}", named()), has_skin, materials };
        builder.append(&mut parts, warnings)?;
    }
    if parts.indices.is_empty() {
        return Ok(None);
    }
    let mut weights = mesh.weights.clone().unwrap_or_default();
    weights.iter_mut().filter(|weight| !weight.is_finite()).for_each(|weight| *weight = 0.0);
    weights.resize(targets, 0.0);
    parts.morph_weights = weights;
    Mesh::new(parts).map(Some).map_err(|error| Problem::Part { part: named(), what: error.to_string() })
}

fn attribute(primitive: &json::mesh::Primitive, semantic: &Semantic) -> Option<json::Index<json::Accessor>> {
    primitive.attributes.get(&Checked::Valid(semantic.clone())).copied()
}

struct Builder<'a> {
    store: &'a Store<'a>,
    primitive: &'a json::mesh::Primitive,
    name: &'a dyn Fn() -> String,
    has_skin: bool,
    materials: &'a [MaterialUse],
}

impl Builder<'_> {
    fn error(&self, what: String) -> Problem {
        Problem::Part { part: (self.name)(), what }
    }

    /// Appends this primitive's vertices and triangles to the mesh's.
    fn append(&self, parts: &mut MeshParts, warnings: &mut Warnings) -> Result<(), Problem> {
        let Checked::Valid(mode) = self.primitive.mode else {
            return Err(self.error("its mode is not one of glTF's".into()));
        };
        if matches!(mode, Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
            warnings.push(format!("{}: points and lines are not drawn", (self.name)()));
            return Ok(());
        }
        let default = self.materials.len() - 1;
        let material = self.primitive.material.map_or(default, |material| material.value());
        let Some(used) = self.materials.get(material).filter(|_| self.primitive.material.is_none() || material < default) else {
            return Err(self.error(format!("material {material} does not exist; the file has {default}")));
        };
        let Some(positions) = attribute(self.primitive, &Semantic::Positions) else {
            warnings.push(format!("{}: it has no positions and is not drawn", (self.name)()));
            return Ok(());
        };
        let positions = self.store.floats(positions, &accessor::VEC3, || format!("{}, POSITION", (self.name)()))?;
        let vertices = positions.count();
        let mut corners = self.corners(mode, vertices, warnings)?;
        if corners.indices.is_empty() {
            warnings.push(format!("{}: it has no triangles", (self.name)()));
            return Ok(());
        }
        let normals = self.vertex_floats(&Semantic::Normals, &accessor::VEC3, vertices)?;
        let flat = parts.normals.is_some() && normals.is_none();
        if flat {
            corners.sources = corners.indices.iter().map(|&index| corners.sources[index as usize]).collect();
            corners.indices = (0..corners.indices.len() as u32).collect();
        }
        let first_vertex = parts.positions.len();
        let (new_vertices, new_indices) = (corners.sources.len(), corners.indices.len());
        self.charge(new_vertices, new_indices / 3, parts.morphs.len())?;
        if first_vertex + new_vertices > u32::MAX as usize || parts.indices.len() + new_indices > u32::MAX as usize {
            return Err(self.error("the mesh has more than 2^32 vertices or indices".into()));
        }
        let gather = |from: &Floats| corners.sources.iter().map(|&at| vec3(from, at)).collect::<Vec<_>>();

        parts.positions.extend(gather(&positions));
        if let Some(all) = &mut parts.normals {
            match normals {
                Some(normals) => all.extend(gather(&normals)),
                None => {
                    for triangle in parts.positions[first_vertex..].as_chunks::<3>().0 {
                        all.extend([face_normal(*triangle).unwrap_or(Vec3::Y); 3]);
                    }
                }
            }
        }
        self.append_uvs(parts, used.uvs, &corners.sources, vertices)?;
        self.append_colors(parts, &corners.sources, vertices)?;
        if self.has_skin {
            self.append_skin(parts, &corners.sources, vertices, warnings)?;
        }
        self.append_morphs(parts, &corners.sources, vertices, first_vertex)?;

        let first_index = parts.indices.len() as u32;
        parts.indices.extend(corners.indices.iter().map(|index| index + first_vertex as u32));
        parts.primitives.push(Primitive {
            first_index,
            index_count: new_indices as u32,
            material,
            casts_shadow: !used.shadeless,
        });
        Ok(())
    }

    fn charge(&self, vertices: usize, triangles: usize, morphs: usize) -> Result<(), Problem> {
        // In u64, from lengths of arrays that exist: no overflow within 4096 morph targets.
        let bytes = vertices as u64 * (VERTEX_BYTES + 24 * morphs as u64) + triangles as u64 * TRIANGLE_BYTES;
        if self.store.budget().take(Some(bytes)) {
            Ok(())
        } else {
            Err(Problem::TooLarge { what: "its geometry is", limit: super::budget_words() })
        }
    }

    /// An attribute with one element a vertex. NaN is left in for [`Mesh::new`] to mend.
    fn vertex_floats(
        &self,
        semantic: &Semantic,
        wanted: &accessor::Wanted,
        vertices: usize,
    ) -> Result<Option<Rc<Floats>>, Problem> {
        let Some(index) = attribute(self.primitive, semantic) else { return Ok(None) };
        let name = || format!("{}, {}", (self.name)(), semantic.to_string());
        let floats = self.store.any_floats(index, wanted, name)?;
        if floats.count() == vertices {
            Ok(Some(floats))
        } else {
            Err(Store::error(index, AccessorError::Count { found: floats.count(), wanted: vertices }, name))
        }
    }

    /// The primitive's triangles and the vertices they use, in order of use.
    fn corners(&self, mode: Mode, vertices: usize, warnings: &mut Warnings) -> Result<Corners, Problem> {
        let given = match self.primitive.indices {
            None => None,
            Some(index) => {
                let name = || format!("{}, indices", (self.name)());
                let indices = self.store.integers(index, Type::Scalar, ComponentType::U32, name)?;
                if let Some((at, bad)) = indices.iter().enumerate().find(|(_, index)| **index as usize >= vertices) {
                    return Err(self.error(format!("index {at} is {bad}, but there are {vertices} vertices")));
                }
                Some(indices)
            }
        };
        let count = given.as_ref().map_or(vertices, |given| given.len());
        if count > u32::MAX as usize / 3 {
            return Err(self.error("too many indices".into()));
        }
        // Three for each index of a strip or fan; the budget knows before they are there.
        if !self.store.budget().take(Some(12 * count as u64)) {
            return Err(Problem::TooLarge { what: "its geometry is", limit: super::budget_words() });
        }
        let corner = |at: usize| given.as_ref().map_or(at as u32, |given| given[at]);
        let mut list = Vec::new();
        match mode {
            Mode::TriangleStrip => {
                for i in 0..count.saturating_sub(2) {
                    // glTF's order, which keeps the winding.
                    list.extend([corner(i), corner(i + 1 + i % 2), corner(i + 2 - i % 2)]);
                }
            }
            Mode::TriangleFan => {
                for i in 1..count.saturating_sub(1) {
                    list.extend([corner(i), corner(i + 1), corner(0)]);
                }
            }
            _ => {
                if !count.is_multiple_of(3) {
                    warnings.push(format!("{}: the last triangle is incomplete and left out", (self.name)()));
                }
                list.extend((0..count - count % 3).map(corner));
            }
        }
        if matches!(mode, Mode::TriangleStrip | Mode::TriangleFan) {
            let whole = |corners: &&[u32; 3]| corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0];
            list = list.as_chunks::<3>().0.iter().filter(whole).flatten().copied().collect();
        }
        Ok(used_only(list, vertices))
    }

    fn append_uvs(&self, parts: &mut MeshParts, source: UvSource, sources: &[u32], vertices: usize) -> Result<(), Problem> {
        let Some(all) = &mut parts.uvs else { return Ok(()) };
        match self.vertex_floats(&Semantic::TexCoords(source.set), &accessor::VEC2, vertices)? {
            None => all.resize(all.len() + sources.len(), Vec2::ZERO),
            Some(uvs) => all.extend(sources.iter().map(|&at| {
                let uv = uvs.get::<2>(at as usize).map_or(Vec2::ZERO, Vec2::from_array);
                source.transform.map_or(uv, |transform| transform.transform_point2(uv))
            })),
        }
        Ok(())
    }

    fn append_colors(&self, parts: &mut MeshParts, sources: &[u32], vertices: usize) -> Result<(), Problem> {
        let Some(all) = &mut parts.colors else { return Ok(()) };
        match self.vertex_floats(&Semantic::Colors(0), &accessor::COLOR, vertices)? {
            None => all.resize(all.len() + sources.len(), [255; 4]),
            Some(colors) => all.extend(sources.iter().map(|&at| {
                let byte = |value: f32| (value.clamp(0.0, 1.0) * 255.0).round() as u8; // NaN becomes 0
                let at = at as usize;
                let opaque = || colors.get::<3>(at).map(|[r, g, b]| [r, g, b, 1.0]);
                let color = if colors.width == 4 { colors.get::<4>(at) } else { opaque() };
                color.unwrap_or([1.0; 4]).map(byte)
            })),
        }
        Ok(())
    }

    /// Joints and weights; of more than four a vertex, the four that weigh most.
    fn append_skin(
        &self,
        parts: &mut MeshParts,
        sources: &[u32],
        vertices: usize,
        warnings: &mut Warnings,
    ) -> Result<(), Problem> {
        let mut sets: Vec<(Rc<Vec<u32>>, Rc<Floats>)> = Vec::new();
        for set in 0.. {
            let (joints, weights) = (Semantic::Joints(set), Semantic::Weights(set));
            let Some(index) = attribute(self.primitive, &joints) else { break };
            let name = || format!("{}, {}", (self.name)(), joints.to_string());
            let joints = self.store.integers(index, Type::Vec4, ComponentType::U16, name)?;
            if joints.len() != vertices * 4 {
                return Err(Store::error(index, AccessorError::Count { found: joints.len() / 4, wanted: vertices }, name));
            }
            let Some(index) = attribute(self.primitive, &weights) else { break };
            let name = || format!("{}, {}", (self.name)(), weights.to_string());
            let weights = self.store.floats(index, &accessor::VEC4, name)?;
            if weights.count() != vertices {
                return Err(Store::error(index, AccessorError::Count { found: weights.count(), wanted: vertices }, name));
            }
            sets.push((joints, weights));
        }
        if sets.len() > 1 {
            warnings.push(format!("{}: of more than four joints a vertex, the four that weigh most are used", (self.name)()));
        }
        let unbound = SkinVertex { joints: [0; 4], weights: [1.0, 0.0, 0.0, 0.0] };
        parts.skin.extend(sources.iter().map(|&at| {
            let at = at as usize;
            let mut bindings: Vec<(u16, f32)> = Vec::with_capacity(4 * sets.len());
            for (joints, weights) in &sets {
                let joints = joints.get(4 * at..4 * at + 4).unwrap_or_default();
                bindings.extend(joints.iter().map(|joint| *joint as u16).zip(weights.get::<4>(at).unwrap_or_default()));
            }
            if bindings.len() > 4 {
                bindings.sort_by(|a, b| b.1.total_cmp(&a.1));
            }
            let mut bound = SkinVertex { joints: [0; 4], weights: [0.0; 4] };
            for (slot, (joint, weight)) in bindings.into_iter().take(4).enumerate() {
                // A joint that weighs nothing may be any number.
                if weight > 0.0 {
                    (bound.joints[slot], bound.weights[slot]) = (joint, weight);
                }
            }
            if bound.weights == [0.0; 4] { unbound } else { bound }
        }));
        Ok(())
    }

    fn append_morphs(&self, parts: &mut MeshParts, sources: &[u32], vertices: usize, first_vertex: usize) -> Result<(), Problem> {
        let targets = self.primitive.targets.as_deref().unwrap_or_default();
        for (number, morph) in parts.morphs.iter_mut().enumerate() {
            let target = targets.get(number);
            for (index, name, into) in [
                (target.and_then(|target| target.positions), "POSITION", &mut morph.positions),
                (target.and_then(|target| target.normals), "NORMAL", &mut morph.normals),
            ] {
                let Some(index) = index else {
                    if !into.is_empty() {
                        into.resize(first_vertex + sources.len(), Vec3::ZERO);
                    }
                    continue;
                };
                let name = || format!("{}, morph target {number}, {name}", (self.name)());
                let moved = self.store.floats(index, &accessor::VEC3, name)?;
                if moved.count() != vertices {
                    return Err(Store::error(index, AccessorError::Count { found: moved.count(), wanted: vertices }, name));
                }
                into.resize(first_vertex, Vec3::ZERO);
                into.extend(sources.iter().map(|&at| vec3(&moved, at)));
            }
        }
        Ok(())
    }
}

fn vec3(floats: &Floats, at: u32) -> Vec3 {
    floats.get::<3>(at as usize).map_or(Vec3::ZERO, Vec3::from_array)
}

/// Renumbers a triangle list so that unused vertices are left out; all indices are below `vertices`.
fn used_only(mut list: Vec<u32>, vertices: usize) -> Corners {
    let mut sources = Vec::new();
    // A table for few vertices, a map for a few triangles in a large array: a file may have very many of those.
    if vertices <= 4 * list.len() {
        let mut numbers = vec![u32::MAX; vertices];
        for index in &mut list {
            let number = &mut numbers[*index as usize];
            if *number == u32::MAX {
                *number = sources.len() as u32;
                sources.push(*index);
            }
            *index = *number;
        }
    } else {
        let mut numbers = HashMap::new();
        for index in &mut list {
            *index = *numbers.entry(*index).or_insert_with(|| {
                sources.push(*index);
                sources.len() as u32 - 1
            });
        }
    }
    Corners { sources, indices: list }
}

/// The highest joint that moves a vertex of each mesh, and so how many joints its skins need.
pub(super) fn joints_needed(meshes: &[Mesh]) -> BTreeMap<usize, usize> {
    let highest = |mesh: &Mesh| mesh.skin.iter().flat_map(|bound| bound.joints).max();
    meshes.iter().enumerate().filter_map(|(index, mesh)| Some((index, usize::from(highest(mesh)?) + 1))).collect()
}
