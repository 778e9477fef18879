//! A scene at one point in time, as triangles of world space in double precision.

use std::collections::BTreeSet;

use glam::{DAffine3, DVec2, DVec3, DVec4};

use super::mask::Masks;
use super::solid::Combined;
use super::tree::Tree;
use crate::geometry::Aabb;
use crate::geometry::planar::{height, reflection, transformed};
use crate::scene::{AlphaMode, Mesh, Mirror, Pose, Scene};

/// The number of no face, no instance, no mirror.
pub const NONE: u32 = u32::MAX;

/// What rays are cast through: everything that is seen or casts.
///
/// It stays right for every camera and light as long as nothing moves.
#[derive(Debug)]
pub struct World {
    pub(super) faces: Vec<Face>,
    pub(super) tree: Tree,
    pub(super) masks: Masks,
    /// Diameter of the ball about everything shown, metres.
    pub(super) size: f64,
    /// The largest coordinate, metres.
    pub(super) largest: f64,
    /// By their numbers.
    pub(super) mirrors: Vec<Glass>,
    /// Two solids put together.
    pub(super) combined: Option<Combined>,
    /// Instances and their primitives: the only surfaces that verdicts are asked about, where it is not all of them.
    asked: Option<BTreeSet<(u32, u32)>>,
}

/// A mirror in the world.
#[derive(Debug)]
pub struct Glass {
    /// Unit normal to the reflecting side, and offset; none for what is no mirror in this pose.
    plane: Option<DVec4>,
    both_sides: bool,
    /// Of a portal: takes the eye to behind its other doorway.
    turn: Option<DAffine3>,
    /// The number of that doorway.
    exit: u32,
}

/// A mirror as an eye has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Towards {
    /// It reflects, or leads on, to another eye.
    Front {
        /// From this eye to that.
        turn: DAffine3,
        /// Of what is seen: unit normal towards it.
        plane: DVec4,
        /// The mirror that it begins at, which is not seen.
        exit: u32,
    },
    /// It is a surface as any other.
    Back,
    /// The eye is on its plane.
    Unsure,
}

/// One triangle.
#[derive(Debug)]
pub struct Face {
    /// Metres, world space.
    pub corners: [DVec3; 3],
    /// The scene's instance it belongs to.
    pub instance: u32,
    /// The primitive of the instance's mesh that it belongs to.
    pub primitive: u32,
    /// The number of the mirror it is a part of, or [`NONE`].
    pub mirror: u32,
    /// Whether it is drawn into the depth buffer, and how.
    pub seen: Seen,
    pub casts: Casts,
    /// Its object is turned inside out, so its front is where it looks clockwise.
    pub mirrored: bool,
    /// Its number among the masked ones.
    pub mask: Option<u32>,
}

/// How a triangle is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Seen {
    /// Not into the depth buffer.
    Never,
    FromFront,
    FromBothSides,
}

/// When a triangle counts for a shadow.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Casts {
    Never,
    /// Of a solid: when it faces the light.
    FacingLight,
    /// Of the soup.
    Always,
}

/// An eye is on a mirror's plane where single precision may have it on either side: of the largest coordinate.
const ON_THE_PLANE: f64 = 2e-6;

/// So low over a mirror's plane nothing is seen in it, of the radius of the ball about everything shown: what
/// lies on the plane, a frame's back for example, must not fight with what is seen in the mirror. The renderer
/// cuts there.
const CLIP_SLACK: f64 = 1e-5;

impl World {
    /// The scene as posed, mirrors being surfaces as others.
    #[must_use]
    pub fn new(scene: &Scene, pose: &Pose) -> Self {
        Self::with_mirrors(scene, pose, &[])
    }

    /// The scene as posed, with mirrors: [`Self::trace`] follows rays through them.
    #[must_use]
    pub fn with_mirrors(scene: &Scene, pose: &Pose, mirrors: &[Mirror]) -> Self {
        let mut faces = Vec::new();
        let mut operands = Vec::new();
        let mut masks = Masks::new(scene);
        for (instance, (node_index, node, mesh)) in (0u32..).zip(scene.instances()) {
            let number = instance as usize;
            let solid = scene.solid.as_ref();
            if solid.is_some_and(|solid| solid.caster == Some(number)) {
                continue;
            }
            let operand = solid.filter(|solid| number == solid.a || number == solid.b).map(|solid| number == solid.b);
            let world_from_object = pose.world_from_object[node_index];
            let positions = pose.positions(scene, node_index);
            let mirrored = world_from_object.matrix3.determinant() < 0.0;
            let casts = if node.casts_shadow { casting(mesh) } else { Vec::new() };
            for (at, (number, primitive)) in (0u32..).zip(mesh.primitives.iter().enumerate()) {
                let mirror = mirrors.iter().position(|mirror| (mirror.node, mirror.primitive) == (node_index, number));
                let mirror = mirror.and_then(|mirror| u32::try_from(mirror).ok()).unwrap_or(NONE);
                let material = &scene.materials[primitive.material];
                let seen = match (material.alpha, material.double_sided) {
                    _ if operand.is_some() => Seen::Never,
                    // A decal is its ground, but for the colour.
                    _ if material.decal => Seen::Never,
                    (AlphaMode::Blend, _) => Seen::Never,
                    (_, true) => Seen::FromBothSides,
                    (_, false) => Seen::FromFront,
                };
                let first = primitive.first_index as usize / 3;
                for triangle in first..first + primitive.index_count as usize / 3 {
                    let casts = casts.get(triangle).copied().filter(|_| operand.is_none()).unwrap_or(Casts::Never);
                    if let Some(of_b) = operand {
                        operands.push((faces.len() as u32, of_b));
                    } else if seen == Seen::Never && casts == Casts::Never {
                        continue;
                    }
                    let vertices = [0, 1, 2].map(|corner| mesh.indices[triangle * 3 + corner] as usize);
                    let corners = vertices.map(|vertex| world_from_object.transform_point3(positions[vertex].as_dvec3()));
                    let mask = if let AlphaMode::Mask(cutoff) = material.alpha {
                        let corners = vertices.map(|vertex| (mesh.uvs[vertex].as_dvec2(), mesh.colors[vertex][3]));
                        Some(masks.add(scene, material, cutoff, corners))
                    } else {
                        None
                    };
                    faces.push(Face { corners, instance, primitive: at, mirror, seen, casts, mirrored, mask });
                }
            }
        }
        let boxes: Vec<_> = faces.iter().map(Face::bounds).collect();
        let of_operands: Vec<_> = operands.iter().map(|&(face, _)| boxes[face as usize]).collect();
        let combined = scene.solid.as_ref().map(|solid| Combined::new(solid.of.operation, operands, &of_operands));
        let bounds = scene.bounds(pose);
        let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
        let largest = if largest.is_finite() { f64::from(largest) } else { 0.0 };
        let glass = |mirror: &Mirror| {
            let posed = mirror.posed(scene, pose).ok();
            let exit = mirrors.iter().position(|other| Some(other.node) == mirror.exit);
            Glass {
                plane: posed.as_ref().map(|posed| posed.plane),
                both_sides: mirror.double_sided,
                turn: posed.and_then(|posed| posed.turn),
                exit: exit.and_then(|exit| u32::try_from(exit).ok()).unwrap_or(NONE),
            }
        };
        Self {
            tree: Tree::new(&boxes),
            faces,
            masks,
            size: 2.0 * f64::from(bounds.radius()),
            largest,
            mirrors: mirrors.iter().map(glass).collect(),
            combined,
            asked: None,
        }
    }

    /// The same for planar shadows, with verdicts on their receivers only, each an instance and one of its primitives: of
    /// all other surfaces rays are not asked whether they are lit.
    #[must_use]
    pub fn of_receivers(mut self, receivers: impl IntoIterator<Item = (usize, usize)>) -> Self {
        let number = |number: usize| u32::try_from(number).unwrap_or(NONE);
        self.asked = Some(receivers.into_iter().map(|(instance, primitive)| (number(instance), number(primitive))).collect());
        self
    }

    /// Whether verdicts are asked about a face.
    pub(super) fn asks_about(&self, face: u32) -> bool {
        let Face { instance, primitive, .. } = self.faces[face as usize];
        self.asked.as_ref().is_none_or(|asked| asked.contains(&(instance, primitive)))
    }

    /// A mirror, by its number, as seen from `eye`.
    pub(super) fn towards(&self, mirror: u32, eye: DVec3) -> Towards {
        let Some(&Glass { plane: Some(plane), both_sides, turn, exit }) = self.mirrors.get(mirror as usize) else {
            return Towards::Back;
        };
        let room = ON_THE_PLANE * self.largest.max(eye.abs().max_element());
        let front = |plane: DVec4| match turn {
            None => Towards::Front { turn: reflection(plane), plane, exit: mirror },
            Some(turn) => Towards::Front { turn, plane: -transformed(plane, &turn), exit },
        };
        match height(plane, eye) {
            over if over.abs() <= room => Towards::Unsure,
            over if over > 0.0 => front(plane),
            _ if both_sides => front(-plane),
            _ => Towards::Back,
        }
    }

    /// Metres: what is no higher over a mirror's plane is not seen in it.
    pub(super) fn clip_slack(&self) -> f64 {
        CLIP_SLACK * self.size / 2.0
    }
}

/// Of each of the mesh's triangles, when it counts.
fn casting(mesh: &Mesh) -> Vec<Casts> {
    let mut casts = vec![Casts::Never; mesh.indices.len() / 3];
    for (&triangle, &soup) in mesh.topology.mesh_triangles().iter().zip(mesh.topology.two_sided()) {
        casts[triangle as usize] = if soup { Casts::Always } else { Casts::FacingLight };
    }
    casts
}

impl Face {
    fn bounds(&self) -> Aabb {
        let [a, b, c] = self.corners;
        Aabb::around(a.min(b).min(c), a.max(b).max(c))
    }

    /// The triangle as rays from `apex` ask it.
    #[inline]
    pub fn from(&self, apex: DVec3) -> Asked {
        let [a, b, c] = self.corners;
        let (ab, ac, s) = (b - a, c - a, apex - a);
        let (normal, v) = (ac.cross(ab), s.cross(ab));
        Asked { normal, u: ac.cross(s), v, height: ac.dot(v) }
    }
}

/// A triangle seen from a point, ready for many rays from there: Möller and Trumbore's test
/// (1997), its products taken apart so that each ray costs three of them.
#[derive(Debug, Clone, Copy)]
pub struct Asked {
    normal: DVec3,
    u: DVec3,
    v: DVec3,
    height: f64,
}

/// Where a ray meets a triangle.
#[derive(Debug, Clone, Copy)]
pub struct Met {
    /// In units of the ray's direction.
    pub distance: f64,
    /// The ray comes from the side where the corners run counter-clockwise.
    pub counter_clockwise: bool,
}

impl Asked {
    /// Along `direction`, before or behind the apex.
    #[inline]
    pub fn meet(&self, direction: DVec3) -> Option<Met> {
        let determinant = direction.dot(self.normal);
        let (u, v) = (direction.dot(self.u), direction.dot(self.v));
        let inside = if determinant > 0.0 {
            u >= 0.0 && v >= 0.0 && u + v <= determinant
        } else {
            determinant < 0.0 && u <= 0.0 && v <= 0.0 && u + v >= determinant
        };
        inside.then(|| Met { distance: self.height / determinant, counter_clockwise: determinant > 0.0 })
    }

    /// One over the distance at which a ray meets the triangle's plane.
    #[inline]
    pub fn nearness(&self, direction: DVec3) -> f64 {
        direction.dot(self.normal) / self.height
    }

    /// The weights of the second and the third corner where the ray meets the triangle's plane.
    #[inline]
    pub fn weights(&self, direction: DVec3) -> DVec2 {
        DVec2::new(direction.dot(self.u), direction.dot(self.v)) / direction.dot(self.normal)
    }
}
