//! Two objects put together to one solid (K section 7, constructive solid geometry).
//!
//! What is seen of the solid is drawn from the two objects themselves ([`crate::techniques::csg`]); what casts its
//! shadow, and swells to its halo, is a mesh of its own, which a library makes ([`Scene::combined`]). The scene with that mesh is another scene:
//! one node and one mesh more, all numbers as they were.

use std::panic::{AssertUnwindSafe, catch_unwind};

use boolmesh::prelude::{Manifold, OpType, compute_boolean};
use glam::{DAffine3, DVec3, Vec3};
use thiserror::Error;

use super::{AlphaMode, Mesh, MeshParts, Node, Pose, Primitive, Scene};
use crate::scene::pose::pose;
use crate::settings::{Csg, Operation, Settings};

/// Two nodes of a scene, and what it means to become of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Operands {
    /// The node that shows A.
    pub a: usize,
    /// The node that shows B.
    pub b: usize,
    /// What becomes of them.
    pub operation: Operation,
}

/// All that a solid depends on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Combination {
    /// The node that shows A.
    pub a: usize,
    /// The node that shows B.
    pub b: usize,
    /// What becomes of them; not [`Operation::Off`].
    pub operation: Operation,
    /// Where B lies in A's space.
    pub a_from_b: DAffine3,
}

/// A solid that a scene was [combined](Scene::combined) for.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// What it is made of.
    pub of: Combination,
    /// A's instance, B's, and that of the solid's own mesh, which casts the shadow; no such mesh where none could be made.
    pub a: usize,
    /// See `a`.
    pub b: usize,
    /// See `a`.
    pub caster: Option<usize>,
    /// A or B is meant to cast shadows: so is the solid.
    pub casts: bool,
    /// Why there is no mesh of it.
    pub refusal: Option<String>,
}

/// What an instance is to a solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Nothing: an object as others.
    Object,
    /// An operand whose front is seen.
    Front,
    /// The operand that is taken away: its inside is seen.
    Inside,
}

impl Solid {
    /// What an instance is to it.
    #[must_use]
    pub fn role(&self, instance: usize) -> Role {
        match self.of.operation {
            Operation::AMinusB if instance == self.b => Role::Inside,
            Operation::BMinusA if instance == self.a => Role::Inside,
            _ if instance == self.a || instance == self.b => Role::Front,
            _ => Role::Object,
        }
    }
}

/// Why a node can be no operand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Unfit {
    /// There is no such node, or it shows nothing.
    #[error("it shows no mesh")]
    Missing,
    /// Inside and outside are not told apart.
    #[error("it is not closed")]
    Open,
    /// What lies behind shows through.
    #[error("it is not opaque")]
    Glass,
    /// Its shape changes with time.
    #[error("bones or morph targets bend it")]
    Bent,
    /// Both operands are the same node.
    #[error("it is A and B at once")]
    Twice,
}

impl Combination {
    /// Whether another is the same but for rounding.
    #[must_use]
    pub fn is_like(&self, other: &Self) -> bool {
        let apart =
            (self.a_from_b.matrix3 - other.a_from_b.matrix3).to_cols_array().into_iter().fold(0.0, |most, x| x.abs().max(most));
        let moved = self.a_from_b.translation.distance(other.a_from_b.translation);
        let room = 1e-9 * (1.0 + self.a_from_b.translation.length());
        (self.a, self.b, self.operation) == (other.a, other.b, other.operation) && apart < 1e-9 && moved < room
    }
}

impl Scene {
    /// Says whether a node can be A or B.
    ///
    /// # Errors
    /// Why it cannot.
    pub fn can_be_operand(&self, node: usize) -> Result<(), Unfit> {
        let mesh = self.nodes.get(node).and_then(|node| node.mesh).ok_or(Unfit::Missing)?;
        let mesh = &self.meshes[mesh];
        if !mesh.primitives.iter().all(|part| self.materials[part.material].alpha == AlphaMode::Opaque) {
            return Err(Unfit::Glass);
        }
        if self.nodes[node].skin.is_some() || mesh.is_deformable() {
            return Err(Unfit::Bent);
        }
        if mesh.topology.report().is_solid() { Ok(()) } else { Err(Unfit::Open) }
    }

    /// The operands and the operation in force; none where objects stay apart.
    #[must_use]
    pub fn operands_in_force(&self, csg: &Csg) -> Option<Operands> {
        let meant = self.operands;
        let operation = csg.operation.or(meant.map(|meant| meant.operation)).filter(|operation| *operation != Operation::Off)?;
        let (a, b) = (csg.a.or(meant.map(|meant| meant.a))?, csg.b.or(meant.map(|meant| meant.b))?);
        Some(Operands { a, b, operation })
    }

    /// What is to be put together, as posed; none where objects stay apart, or cannot be put together.
    #[must_use]
    pub fn combination(&self, csg: &Csg, pose: &Pose) -> Option<Combination> {
        let Operands { a, b, operation } = self.operands_in_force(csg)?;
        if a == b || self.can_be_operand(a).is_err() || self.can_be_operand(b).is_err() {
            return None;
        }
        // What a transform without inverse flattens is no solid.
        if [a, b].iter().any(|node| pose.deformed[*node].is_some()) {
            return None;
        }
        let a_from_b = pose.world_from_object[a].inverse() * pose.world_from_object[b];
        Some(Combination { a, b, operation, a_from_b })
    }

    /// What is to be put together as settings have it, at their time.
    #[must_use]
    pub fn combination_at(&self, settings: &Settings) -> Option<Combination> {
        self.operands_in_force(&settings.csg)?;
        let pose = pose(self, settings.time, settings.animation.unwrap_or(self.default_animation), &settings.lights);
        self.combination(&settings.csg, &pose)
    }

    /// The scene in which the two are one solid: they cast no shadows any more, but the solid's mesh does, the last node of
    /// the scene. A union casts the shadows of both, and needs none. Where no mesh can be made the solid casts none, has no
    /// halo, and says why.
    #[must_use]
    pub fn combined(&self, of: Combination) -> Self {
        let mut scene = self.clone();
        let instance = |node: usize| self.instances().position(|(index, ..)| index == node).unwrap_or_default();
        let (a, b) = (instance(of.a), instance(of.b));
        let casts = [of.a, of.b].iter().any(|node| self.nodes[*node].casts_shadow);
        let mut solid = Solid { of, a, b, caster: None, casts, refusal: None };
        if of.operation != Operation::Union {
            for node in [of.a, of.b] {
                scene.nodes[node].casts_shadow = false;
            }
            match catch_unwind(AssertUnwindSafe(|| self.solid_mesh(&of))).unwrap_or_else(|_| Err("the library gave up".into())) {
                Ok(Some(mesh)) => {
                    solid.caster = Some(self.instances().count());
                    scene.meshes.push(mesh);
                    let name = of.operation.words().into();
                    let mesh = Some(scene.meshes.len() - 1);
                    scene.nodes.push(Node { name, parent: Some(of.a), mesh, casts_shadow: casts, ..Node::default() });
                }
                Ok(None) => {}
                Err(why) => solid.refusal = Some(why),
            }
        }
        scene.solid = Some(solid);
        scene
    }

    /// The solid's surface in A's space; none where nothing is left.
    fn solid_mesh(&self, of: &Combination) -> Result<Option<Mesh>, String> {
        let mesh_of =
            |node: usize| self.nodes[node].mesh.map(|mesh| &self.meshes[mesh]).ok_or_else(|| Unfit::Missing.to_string());
        let (a, b) = (mesh_of(of.a)?, mesh_of(of.b)?);
        let (a, b) = (manifold(a, &DAffine3::IDENTITY)?, manifold(b, &of.a_from_b)?);
        let result = match of.operation {
            Operation::Off => return Ok(None),
            Operation::Union => compute_boolean(&a, &b, OpType::Add),
            Operation::Intersection => compute_boolean(&a, &b, OpType::Intersect),
            Operation::AMinusB => compute_boolean(&a, &b, OpType::Subtract),
            Operation::BMinusA => compute_boolean(&b, &a, OpType::Subtract),
        };
        let result = match result {
            // What is left is nothing.
            Err(why) if why.starts_with("empty ") => return Ok(None),
            result => result?,
        };
        let positions: Vec<Vec3> = result.ps.iter().map(|at| DVec3::new(at.x, at.y, at.z).as_vec3()).collect();
        let mut indices = Vec::with_capacity(result.hs.len());
        for corners in result.hs.chunks_exact(3) {
            for corner in corners {
                indices.push(u32::try_from(corner.tail).map_err(|_| "too many vertices")?);
            }
        }
        if indices.is_empty() {
            return Ok(None);
        }
        let material = mesh_of(of.a)?.primitives.first().map_or(0, |part| part.material);
        let index_count = u32::try_from(indices.len()).map_err(|_| "too many triangles")?;
        let primitives = vec![Primitive { first_index: 0, index_count, material, casts_shadow: true }];
        let parts = MeshParts { name: of.operation.words().into(), positions, indices, primitives, ..MeshParts::default() };
        Mesh::new(parts).map(Some).map_err(|error| error.to_string())
    }
}

/// A mesh's welded surface, moved, as the library wants it.
fn manifold(mesh: &Mesh, moved: &DAffine3) -> Result<Manifold, String> {
    let topology = &mesh.topology;
    let at = |&vertex: &u32| moved.transform_point3(mesh.positions[vertex as usize].as_dvec3()).to_array();
    let positions: Vec<f64> = topology.weld().vertex_of_welded.iter().flat_map(at).collect();
    // What is turned inside out must run the other way round.
    let turned = moved.matrix3.determinant() < 0.0;
    let corners = |&[a, b, c]: &[u32; 3]| if turned { [a, c, b] } else { [a, b, c] }.map(|corner| corner as usize);
    let indices: Vec<usize> = topology.triangles().iter().flat_map(corners).collect();
    Manifold::new(&positions, &indices)
}
