//! Mirrors: which surfaces of a scene reflect, and where they are in a pose.
//!
//! A primitive whose material is marked a mirror is one where its triangles lie on one plane and face one
//! way ([`crate::geometry::planar`]); shape and number do not matter. What is not is drawn as an ordinary
//! surface, and the scene says why. Bones and morph targets may bend a mirror: then it is asked anew in
//! each pose.
//!
//! A portal is a mirror that does not turn the eye back but takes it elsewhere: to behind another doorway, by a rigid
//! transform in the reflection's place. All else is the same, so it is a mirror here, with an exit.

use std::fmt;

use glam::{DAffine3, DMat3, DVec3, DVec4, Vec3};
use thiserror::Error;

use super::{AlphaMode, Mesh, Node, Pose, Scene};
use crate::geometry::planar::{self, Uneven};
use crate::settings::{MirrorMode, Mirrors, SurfacePlace, toggle};

/// How a material reflects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reflective {
    /// How much of what is seen there is the reflection: 1 all, 0 none; the rest is the surface's own look.
    pub reflectivity: f32,
    /// Multiplies the reflection; linear RGB, each 0 to 1.
    pub tint: Vec3,
}

impl Default for Reflective {
    /// A perfect mirror.
    fn default() -> Self {
        Self { reflectivity: 1.0, tint: Vec3::ONE }
    }
}

/// A planar mirror of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Mirror {
    /// Its node's name.
    pub name: String,
    /// The node that shows it.
    pub node: usize,
    /// The same, as [`Scene::instances`] counts.
    pub instance: usize,
    /// Which of the mesh's primitives it is.
    pub primitive: usize,
    /// Object space, undeformed: unit normal towards the reflecting side, and offset.
    pub plane: DVec4,
    /// It reflects on both sides.
    pub double_sided: bool,
    /// How much, and in what colour.
    pub look: Reflective,
    /// The node of the doorway that it leads to, for a portal: it then shows what is before that one, instead of what is
    /// before itself.
    pub exit: Option<usize>,
}

/// A mirror in the world, at one point in time.
#[derive(Debug, Clone, PartialEq)]
pub struct PosedMirror {
    /// Unit normal towards the reflecting side, and offset, metres.
    pub plane: DVec4,
    /// In the mesh's order.
    pub triangles: Vec<[DVec3; 3]>,
    /// Of a portal: takes an eye before it to where it looks out of the other doorway from, a rotation and a move.
    pub turn: Option<DAffine3>,
}

/// Why a surface is no mirror.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum Refusal {
    /// There is no such node, or it shows no such primitive.
    #[error("there is no such surface")]
    Missing,
    /// It is drawn over what lies behind.
    #[error("its material is blended")]
    Blended,
    /// Masked texels would have to be holes in the reflection.
    #[error("its material has holes (alpha mask)")]
    Masked,
    /// A portal whose other doorway is none.
    #[error("it leads to no doorway")]
    NoExit,
    /// A portal whose two doorways differ by more than their places.
    #[error("its two doorways are not of one size")]
    Resized,
    /// Not on one plane.
    #[error(transparent)]
    Uneven(#[from] Uneven),
}

impl Mirror {
    /// The surface of a node's primitive as a mirror, whatever its material is marked.
    ///
    /// # Errors
    /// Why it cannot be one.
    pub fn of(scene: &Scene, node: usize, primitive: usize, look: Reflective) -> Result<Self, Refusal> {
        let (instance, (_, shown, mesh)) =
            scene.instances().enumerate().find(|(_, (index, ..))| *index == node).ok_or(Refusal::Missing)?;
        Self::shown(scene, (instance, node, shown, mesh), primitive, look)
    }

    fn shown(
        scene: &Scene,
        (instance, node, shown, mesh): (usize, usize, &Node, &Mesh),
        primitive: usize,
        look: Reflective,
    ) -> Result<Self, Refusal> {
        let run = mesh.primitives.get(primitive).ok_or(Refusal::Missing)?;
        let material = scene.materials.get(run.material).ok_or(Refusal::Missing)?;
        match material.alpha {
            AlphaMode::Opaque => {}
            AlphaMode::Mask(_) => return Err(Refusal::Masked),
            AlphaMode::Blend => return Err(Refusal::Blended),
        }
        let triangles = mesh.triangles(primitive).map(|corners| corners.map(|vertex| mesh.positions[vertex as usize]));
        let plane = planar::plane_of(triangles, material.double_sided)?;
        let double_sided = material.double_sided;
        // A doorway has a front.
        let (exit, double_sided) = (shown.portal, double_sided && shown.portal.is_none());
        Ok(Self { name: shown.name.clone(), node, instance, primitive, plane, double_sided, look, exit })
    }

    /// Where it is in a pose of its scene.
    ///
    /// # Errors
    /// Its bones or morph targets have bent it.
    pub fn posed(&self, scene: &Scene, pose: &Pose) -> Result<PosedMirror, Refusal> {
        let posed = posed(scene, pose, (self.node, self.primitive), (self.plane, self.double_sided))?;
        Ok(PosedMirror { turn: self.exit.map(|exit| self.turn(pose, exit)).transpose()?, ..posed })
    }

    /// From before this doorway to behind the other, whose node's axes stand for its own turned about.
    fn turn(&self, pose: &Pose, exit: usize) -> Result<DAffine3, Refusal> {
        /// What rounding may make of a length of one.
        const RIGID: f64 = 1e-6;
        let (from, to) = (pose.world_from_node.get(self.node), pose.world_from_node.get(exit));
        let (from, to) = from.zip(to).ok_or(Refusal::NoExit)?;
        let turn = *to * DAffine3::from_rotation_y(std::f64::consts::PI) * from.inverse();
        let axes = turn.matrix3;
        let off = (axes.transpose() * axes - DMat3::IDENTITY)
            .to_cols_array()
            .into_iter()
            .fold(0.0, |most: f64, part| most.max(part.abs()));
        if off.is_nan() || off > RIGID || axes.determinant() < 0.0 { Err(Refusal::Resized) } else { Ok(turn) }
    }
}

/// Where a flat primitive of a node is in a pose: `plane` is its own while nothing bends it.
pub(super) fn posed(
    scene: &Scene,
    pose: &Pose,
    (node, primitive): (usize, usize),
    (plane, both_sides): (DVec4, bool),
) -> Result<PosedMirror, Refusal> {
    let mesh = scene.nodes.get(node).and_then(|node| node.mesh).map(|mesh| &scene.meshes[mesh]);
    let mesh = mesh.ok_or(Refusal::Missing)?;
    let world_from_object = pose.world_from_object.get(node).ok_or(Refusal::Missing)?;
    let positions = pose.positions(scene, node);
    let triangles = mesh.triangles(primitive).map(|corners| corners.map(|vertex| positions[vertex as usize]));
    let bent = pose.deformed.get(node).is_some_and(Option::is_some);
    let plane = if bent { planar::plane_of(triangles.clone(), both_sides)? } else { plane };
    let in_world = |corner: Vec3| world_from_object.transform_point3(corner.as_dvec3());
    Ok(PosedMirror {
        plane: planar::transformed(plane, world_from_object),
        triangles: triangles.map(|corners| corners.map(in_world)).collect(),
        turn: None,
    })
}

impl Scene {
    /// The mirrors as settings have them, and why some that they ask for are none.
    #[must_use]
    pub fn mirrors_in_force(&self, settings: &Mirrors) -> (Vec<Mirror>, Vec<String>) {
        if settings.mode == MirrorMode::Off {
            return (Vec::new(), Vec::new());
        }
        let place = |mirror: &Mirror| SurfacePlace { node: mirror.node, primitive: mirror.primitive };
        let kept = |mirror: &&Mirror| settings.edits.get(&place(mirror)) != Some(&false) && mirror.look.reflectivity > 0.0;
        let mut mirrors: Vec<_> = self.mirrors.iter().filter(kept).cloned().collect();
        let mut refused = Vec::new();
        for (added, _) in settings.edits.iter().filter(|(_, on)| **on) {
            if self.mirrors.iter().any(|mirror| place(mirror) == *added) {
                continue;
            }
            match Mirror::of(self, added.node, added.primitive, Reflective::default()) {
                Ok(mirror) => mirrors.push(mirror),
                Err(why) => refused.push(format!("node {}, primitive {}: no mirror: {why}", added.node, added.primitive)),
            }
        }
        (mirrors, refused)
    }

    /// Whether a surface can be a mirror.
    ///
    /// # Errors
    /// Why it cannot.
    pub fn can_mirror(&self, place: SurfacePlace) -> Result<(), Refusal> {
        Mirror::of(self, place.node, place.primitive, Reflective::default()).map(|_| ())
    }

    /// Makes a surface a mirror, or a mirror an ordinary surface; says which of the two it is now.
    ///
    /// # Errors
    /// Why it cannot be a mirror: nothing has changed then.
    pub fn toggle_mirror(&self, settings: &mut Mirrors, place: SurfacePlace) -> Result<bool, Refusal> {
        let marked = self.mirrors.iter().any(|mirror| mirror.node == place.node && mirror.primitive == place.primitive);
        toggle(&mut settings.edits, place, marked, || self.can_mirror(place))
    }

    /// Looks for the surfaces that are marked mirrors and fills [`Scene::mirrors`]; says which are none, and
    /// why.
    pub(super) fn find_mirrors(&mut self) -> Vec<String> {
        let (mut mirrors, mut refused) = (Vec::new(), Vec::new());
        for (instance, (node, shown, mesh)) in self.instances().enumerate() {
            for (primitive, run) in mesh.primitives.iter().enumerate() {
                let Some(material) = self.materials.get(run.material) else { continue };
                let doorway = (shown.portal.is_some() && primitive == 0).then(Reflective::default);
                let Some(look) = doorway.or(material.mirror) else { continue };
                if shown.portal.is_some_and(|exit| self.nodes.get(exit).is_none_or(|exit| exit.portal.is_none())) {
                    refused.push(format!("node {:?}: no portal: {}", shown.name, Refusal::NoExit));
                    continue;
                }
                match Mirror::shown(self, (instance, node, shown, mesh), primitive, look) {
                    Ok(mirror) => mirrors.push(mirror),
                    Err(why) => {
                        refused.push(format!("node {:?}, material {:?}: no mirror: {why}", shown.name, material.name));
                    }
                }
            }
        }
        self.mirrors = mirrors;
        refused
    }
}

impl fmt::Display for Mirror {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (reflectivity {}", self.name, self.look.reflectivity)?;
        if self.look.tint != Vec3::ONE {
            write!(f, ", tint {} {} {}", self.look.tint.x, self.look.tint.y, self.look.tint.z)?;
        }
        if self.double_sided {
            write!(f, ", both sides")?;
        }
        if let Some(exit) = self.exit {
            write!(f, ", a doorway to node {exit}")?;
        }
        write!(f, ")")
    }
}
