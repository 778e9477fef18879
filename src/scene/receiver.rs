//! Receivers: which surfaces of a scene take planar shadows (K sections 4 and 5), and where they are in a pose.
//!
//! What holds for mirrors ([`super::mirror`]) holds for receivers: a primitive is one where its triangles lie on one
//! plane. It may have holes, though: a shadow falls where the surface is seen.

use std::fmt;

use glam::{DVec3, DVec4};

use super::mirror::posed;
use super::{AlphaMode, Mesh, Node, Pose, PosedMirror, Refusal, Scene};
use crate::geometry::planar::{height, plane_of};
use crate::settings::{Planar, SurfacePlace, toggle};

/// A surface that takes planar shadows.
#[derive(Debug, Clone, PartialEq)]
pub struct Receiver {
    /// Its node's name.
    pub name: String,
    /// The node that shows it.
    pub node: usize,
    /// The same, as [`Scene::instances`] counts.
    pub instance: usize,
    /// Which of the mesh's primitives it is.
    pub primitive: usize,
    /// Object space, undeformed: unit normal towards its front, and offset.
    pub plane: DVec4,
    /// It is drawn from both sides.
    pub double_sided: bool,
}

/// A receiver in the world, at one point in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PosedReceiver {
    /// Unit normal towards its front, and offset, metres.
    pub plane: DVec4,
    /// Metres: rounding may have lifted its own triangles so far off the plane.
    pub room: f64,
}

impl Receiver {
    /// The surface of a node's primitive as a receiver, whatever its material is marked.
    ///
    /// # Errors
    /// Why it cannot be one.
    pub fn of(scene: &Scene, node: usize, primitive: usize) -> Result<Self, Refusal> {
        let shown = scene.instances().enumerate().find(|(_, (index, ..))| *index == node);
        let (instance, (_, shown, mesh)) = shown.ok_or(Refusal::Missing)?;
        Self::shown(scene, (instance, node, shown, mesh), primitive)
    }

    fn shown(
        scene: &Scene,
        (instance, node, shown, mesh): (usize, usize, &Node, &Mesh),
        primitive: usize,
    ) -> Result<Self, Refusal> {
        let run = mesh.primitives.get(primitive).ok_or(Refusal::Missing)?;
        let material = scene.materials.get(run.material).ok_or(Refusal::Missing)?;
        if material.alpha == AlphaMode::Blend {
            return Err(Refusal::Blended);
        }
        let triangles = mesh.triangles(primitive).map(|corners| corners.map(|vertex| mesh.positions[vertex as usize]));
        let double_sided = material.double_sided;
        let plane = plane_of(triangles, double_sided)?;
        Ok(Self { name: shown.name.clone(), node, instance, primitive, plane, double_sided })
    }

    /// Where it is in a pose of its scene.
    ///
    /// # Errors
    /// Its bones or morph targets have bent it.
    pub fn posed(&self, scene: &Scene, pose: &Pose) -> Result<PosedReceiver, Refusal> {
        /// Of the largest coordinate: sixteen halves of a last digit of single precision.
        const ROUNDING: f64 = 1e-6;
        let PosedMirror { plane, triangles, .. } =
            posed(scene, pose, (self.node, self.primitive), (self.plane, self.double_sided))?;
        let mut corners = triangles.iter().flatten();
        let off = corners.clone().map(|corner| height(plane, *corner).abs()).fold(0.0, f64::max);
        let largest = corners.by_ref().fold(DVec3::ZERO, |largest, corner| largest.max(corner.abs())).max_element();
        Ok(PosedReceiver { plane, room: 2.0 * off + ROUNDING * largest })
    }

    fn place(&self) -> SurfacePlace {
        SurfacePlace { node: self.node, primitive: self.primitive }
    }
}

impl Scene {
    /// The receivers as settings have them, whatever the mode, and why some that they ask for are none.
    #[must_use]
    pub fn receivers_in_force(&self, settings: &Planar) -> (Vec<Receiver>, Vec<String>) {
        let kept = |receiver: &&Receiver| settings.edits.get(&receiver.place()) != Some(&false);
        let mut receivers: Vec<_> = self.receivers.iter().filter(kept).cloned().collect();
        let mut refused = Vec::new();
        for (added, _) in settings.edits.iter().filter(|(_, on)| **on) {
            if self.receivers.iter().any(|receiver| receiver.place() == *added) {
                continue;
            }
            match Receiver::of(self, added.node, added.primitive) {
                Ok(receiver) => receivers.push(receiver),
                Err(why) => refused.push(format!("node {}, primitive {}: no receiver: {why}", added.node, added.primitive)),
            }
        }
        (receivers, refused)
    }

    /// Whether a surface is there at all, and can take planar shadows.
    ///
    /// # Errors
    /// Why it cannot.
    pub fn can_receive(&self, place: SurfacePlace) -> Result<(), Refusal> {
        Receiver::of(self, place.node, place.primitive).map(|_| ())
    }

    /// Makes a surface a receiver, or a receiver none; says which of the two it is now.
    ///
    /// # Errors
    /// Why it cannot be a receiver: nothing has changed then.
    pub fn toggle_receiver(&self, settings: &mut Planar, place: SurfacePlace) -> Result<bool, Refusal> {
        let marked = self.receivers.iter().any(|receiver| receiver.place() == place);
        toggle(&mut settings.edits, place, marked, || self.can_receive(place))
    }

    /// Looks for the surfaces that are marked receivers and fills [`Scene::receivers`]; says which are none, and why.
    pub(super) fn find_receivers(&mut self) -> Vec<String> {
        let (mut receivers, mut refused) = (Vec::new(), Vec::new());
        for (instance, (node, shown, mesh)) in self.instances().enumerate() {
            for (primitive, run) in mesh.primitives.iter().enumerate() {
                let Some(material) = self.materials.get(run.material).filter(|material| material.receiver) else { continue };
                match Receiver::shown(self, (instance, node, shown, mesh), primitive) {
                    Ok(receiver) => receivers.push(receiver),
                    Err(why) => {
                        refused.push(format!("node {:?}, material {:?}: no receiver: {why}", shown.name, material.name));
                    }
                }
            }
        }
        self.receivers = receivers;
        refused
    }
}

impl fmt::Display for Receiver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.name, if self.double_sided { " (both sides)" } else { "" })
    }
}
