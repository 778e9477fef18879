//! A scene at one point in time: world matrices, deformed meshes, lights in the world.
//!
//! [`pose`] goes down the way of the data once: channels move nodes, parents carry children, skins
//! and morph targets bend meshes, nodes place lights, and what the user changed of a light comes
//! last. A scene shared between two times, or two users, is never written to.

use glam::{Affine3A, DAffine3, DQuat, DVec3, DVec4, Vec3};
use std::collections::BTreeMap;

use super::deform::Bent;
use super::{AnimationChoice, Extent, LightKind, Mesh, OffMirror, Property, Scene, Slide, Transform};
use crate::geometry::{Aabb, LazyPosed, Posed};
use crate::settings::{LightEdit, SlideChoice};

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
    /// One per light of the scene, and one for each of them off each mirror, where those are asked for; where lights with
    /// a size were expanded, their other points after those.
    pub lights: Vec<PosedLight>,
    /// Of the scene's partner, where the picture dissolves into it.
    pub partner: Option<Box<Pose>>,
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
    /// Of `positions`, once asked for ([`Pose::posed`]).
    pub posed: LazyPosed,
}

/// A light in world space: a point of one, where the light has a size and was expanded
/// ([`Pose::expand_lights`]).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PosedLight {
    /// Metres; for directional lights just where the node is.
    pub position: DVec3,
    /// Unit; where a directional or spot light shines to.
    pub direction: DVec3,
    /// Unit, square to `direction`: the node's X, to the right of what it projects.
    pub right: DVec3,
    /// The middle of the light; `position` but for the points of a light with a size.
    pub center: DVec3,
    /// The light of the scene that this is, or is a point of.
    pub of: usize,
    /// The mirror that it comes off, for a light that is a reflection.
    pub off: Option<OffMirror>,
    /// What shines.
    pub extent: Extent,
    /// What a spot projects.
    pub slide: Option<Slide>,
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

impl Default for PosedLight {
    fn default() -> Self {
        Self {
            position: DVec3::ZERO,
            direction: DVec3::NEG_Z,
            right: DVec3::X,
            center: DVec3::ZERO,
            of: 0,
            off: None,
            extent: Extent::Point,
            slide: None,
            kind: LightKind::Point,
            intensity: Vec3::ONE,
            range: f64::INFINITY,
            on: true,
            shadows: true,
        }
    }
}

/// `scene` as it is `time` seconds after its start, the animations of `animation` playing, its
/// lights changed as `lights` says (by light index).
#[must_use]
pub fn pose(scene: &Scene, time: f64, animation: AnimationChoice, lights: &BTreeMap<usize, LightEdit>) -> Pose {
    Poser::default().pose(Pose::default(), scene, time, animation, lights)
}

/// Poses scenes, in memory that is kept from one time to the next.
#[derive(Debug, Default)]
pub struct Poser {
    /// Every node's own transform.
    locals: Vec<Transform>,
    /// And its morph weights; those that nothing animates are empty.
    weights: Vec<Vec<f32>>,
    values: Vec<f64>,
    /// Of the skin that is bent just now.
    joints: Vec<Affine3A>,
}

impl Poser {
    /// [`pose`], in the memory of a pose that nobody needs any more.
    #[must_use]
    pub fn pose(
        &mut self,
        before: Pose,
        scene: &Scene,
        time: f64,
        animation: AnimationChoice,
        edits: &BTreeMap<usize, LightEdit>,
    ) -> Pose {
        self.animate(scene, time, animation);
        let Pose { mut world_from_node, mut deformed, mut world_from_object, mut lights, .. } = before;
        world_from_node.clear();
        for (node, local) in scene.nodes.iter().zip(&self.locals) {
            let world_from_parent = node.parent.and_then(|parent| world_from_node.get(parent)).copied();
            world_from_node.push(world_from_parent.unwrap_or(DAffine3::IDENTITY) * local.affine());
        }

        world_from_object.clone_from(&world_from_node);
        deformed.resize_with(scene.nodes.len(), || None);
        for (at, node) in scene.nodes.iter().enumerate() {
            let slot = &mut deformed[at];
            let Some(mesh) = node.mesh.map(|mesh| &scene.meshes[mesh]) else {
                *slot = None;
                continue;
            };
            let weights = [&self.weights[at], &node.morph_weights, &mesh.morph_weights];
            let weights = weights.into_iter().find(|weights| !weights.is_empty()).map_or(&[][..], Vec::as_slice);
            let skin = node.skin.and_then(|skin| scene.skins.get(skin)).filter(|_| !mesh.skin.is_empty());
            let bent = |before: &mut Option<DeformedMesh>| Bent { mesh, weights, into: before.take().unwrap_or_default() };
            *slot = if let Some(skin) = skin {
                world_from_object[at] = DAffine3::IDENTITY;
                Some(bent(slot).skinned(skin, &world_from_node, &mut self.joints))
            } else if !is_invertible(&world_from_node[at]) {
                world_from_object[at] = DAffine3::IDENTITY;
                Some(bent(slot).baked(&world_from_node[at]))
            } else if weights.iter().zip(&mesh.morphs).any(|(weight, _)| *weight != 0.0) {
                Some(bent(slot).morphed())
            } else {
                None
            };
        }

        lights.clear();
        lights.extend((0..scene.lights.len()).map(|light| place_light(scene, light, &world_from_node, edits.get(&light))));
        Pose { time, world_from_node, deformed, world_from_object, lights, partner: None }
    }

    fn animate(&mut self, scene: &Scene, time: f64, choice: AnimationChoice) {
        let Self { locals, weights, values, .. } = self;
        locals.clear();
        locals.extend(scene.nodes.iter().map(|node| node.local));
        weights.iter_mut().for_each(Vec::clear);
        weights.resize_with(scene.nodes.len(), Vec::new);
        let playing = scene.animations.iter().enumerate().filter(|(index, _)| choice.plays(*index));
        for (animation, channel) in
            playing.flat_map(|(_, animation)| animation.channels.iter().map(move |channel| (animation, channel)))
        {
            channel.sample(animation.local_time(time), values);
            if values.is_empty() || channel.node >= locals.len() {
                continue;
            }
            let Transform::Trs { translation, rotation, scale } = &mut locals[channel.node] else { continue };
            match channel.property {
                Property::Translation => *translation = DVec3::from_slice(values),
                Property::Rotation => *rotation = DQuat::from_slice(values),
                Property::Scale => *scale = DVec3::from_slice(values),
                Property::Weights => {
                    weights[channel.node].clear();
                    weights[channel.node].extend(values.iter().map(|value| *value as f32));
                }
            }
        }
    }
}

/// Has an inverse that can be worked with: lights can be brought into the object's space.
pub(super) fn is_invertible(world_from_node: &DAffine3) -> bool {
    // Lengths whose squares and inverses single precision still holds, and axes that do not all
    // but lie in one plane.
    const LENGTHS: std::ops::Range<f64> = 1e-12..1e12;
    const FLAT: f64 = 1e-6;
    let matrix = world_from_node.matrix3;
    let lengths = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(DVec3::length);
    world_from_node.is_finite()
        && lengths.iter().all(|length| LENGTHS.contains(length))
        && matrix.determinant().abs() > FLAT * lengths.iter().product::<f64>()
}

fn place_light(scene: &Scene, index: usize, world_from_node: &[DAffine3], edit: Option<&LightEdit>) -> PosedLight {
    let light = &scene.lights[index];
    let unedited = LightEdit::default();
    let edit = edit.unwrap_or(&unedited);
    let world_from_light = world_from_node.get(light.node).copied().unwrap_or(DAffine3::IDENTITY);
    let color = edit.color.filter(|color| color.is_finite()).unwrap_or(light.color);
    let intensity = edit.intensity.filter(|intensity| intensity.is_finite()).unwrap_or(light.intensity);
    let position = edit.position.filter(|position| position.is_finite()).unwrap_or(world_from_light.translation);
    let direction = world_from_light.transform_vector3(DVec3::NEG_Z).try_normalize().unwrap_or(DVec3::NEG_Z);
    let right = world_from_light.transform_vector3(DVec3::X).reject_from_normalized(direction);
    let extent = edit.radius.filter(|radius| *radius >= 0.0 && radius.is_finite()).map_or(light.extent, Extent::Round);
    let slide = match edit.slide {
        None => light.slide.map(Slide::Texture),
        Some(SlideChoice::None) => None,
        Some(SlideChoice::BuiltIn(slide)) => Some(Slide::BuiltIn(slide)),
    };
    PosedLight {
        position,
        direction,
        right: right.try_normalize().unwrap_or_else(|| direction.any_orthonormal_vector()),
        center: position,
        of: index,
        off: None,
        extent: if light.kind == LightKind::Directional { Extent::Point } else { extent },
        slide: slide.filter(|_| matches!(light.kind, LightKind::Spot { .. })),
        kind: light.kind,
        intensity: (color * intensity).max(Vec3::ZERO),
        range: match light.kind {
            LightKind::Directional => f64::INFINITY,
            _ => f64::from(edit.range.filter(|range| *range >= 0.0).unwrap_or(light.range)),
        },
        on: edit.on.unwrap_or(true),
        shadows: edit.shadows.unwrap_or(true),
    }
}

impl Pose {
    /// The vertices of the mesh that `node` shows, as they are now, in the space that
    /// `world_from_object` leads from; none where it shows no mesh.
    #[must_use]
    pub fn positions<'a>(&'a self, scene: &'a Scene, node: usize) -> &'a [Vec3] {
        match self.deformed.get(node) {
            Some(Some(deformed)) => &deformed.positions,
            _ => scene.nodes.get(node).and_then(|node| node.mesh).map_or(&[], |mesh| &scene.meshes[mesh].positions),
        }
    }

    /// The mesh that `node` shows, as its silhouettes see it.
    #[must_use]
    pub fn posed<'a>(&'a self, mesh: &'a Mesh, node: usize) -> &'a Posed {
        match self.deformed.get(node) {
            Some(Some(deformed)) => deformed.posed.get(&mesh.topology, &deformed.positions),
            _ => &mesh.rest,
        }
    }

    /// The box about [`Self::positions`]; empty where `node` shows no mesh.
    #[must_use]
    pub fn bounds(&self, scene: &Scene, node: usize) -> Aabb {
        match self.deformed.get(node) {
            Some(Some(deformed)) => deformed.bounds,
            _ => scene.nodes.get(node).and_then(|node| node.mesh).map_or(Aabb::EMPTY, |mesh| scene.meshes[mesh].bounds),
        }
    }

    /// The same in world space.
    #[must_use]
    pub fn world_bounds(&self, scene: &Scene, node: usize) -> Aabb {
        match self.world_from_object.get(node) {
            Some(world_from_object) => self.bounds(scene, node).transformed(world_from_object),
            None => Aabb::EMPTY,
        }
    }
}

impl Scene {
    /// The box about everything the scene shows, as posed, in world space.
    #[must_use]
    pub fn bounds(&self, pose: &Pose) -> Aabb {
        self.instances().fold(Aabb::EMPTY, |held, (node, _, _)| held.union(&pose.world_bounds(self, node)))
    }
}

impl From<&PosedLight> for DVec4 {
    /// In world space, the way volumes want it: a point with w = 1, or the direction *towards* a
    /// directional light with w = 0.
    fn from(light: &PosedLight) -> Self {
        match light.kind {
            LightKind::Directional => (-light.direction).extend(0.0),
            LightKind::Point | LightKind::Spot { .. } => light.position.extend(1.0),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails may panic")]
    use super::*;
    use crate::geometry::light_in_object;
    use crate::scene::BuiltInSlide;
    use crate::scene::{
        Animation, Channel, Interpolation, Light, Mesh, MeshParts, MorphTarget, Node, Primitive, Skin, SkinVertex,
    };
    use std::f64::consts::FRAC_PI_2;

    fn still(scene: &Scene) -> Pose {
        pose(scene, 0.0, AnimationChoice::Still, &BTreeMap::new())
    }

    fn trs(translation: DVec3, rotation: DQuat, scale: DVec3) -> Transform {
        Transform::Trs { translation, rotation, scale }
    }

    fn node(parent: Option<usize>, local: Transform) -> Node {
        Node { parent, local, ..Node::default() }
    }

    /// Corners at the origin, up one metre and up two; facing +Z.
    fn blade() -> MeshParts {
        MeshParts {
            positions: vec![Vec3::ZERO, Vec3::new(0.5, 1.0, 0.0), Vec3::new(0.0, 2.0, 0.0)],
            normals: Some(vec![Vec3::Z; 3]),
            indices: vec![0, 1, 2],
            primitives: vec![Primitive { first_index: 0, index_count: 3, material: 0, casts_shadow: true }],
            ..MeshParts::default()
        }
    }

    fn close(a: Vec3, b: Vec3) -> bool {
        a.distance(b) < 1e-6
    }

    #[test]
    fn parents_carry_children_and_channels_move_them() {
        let quarter = DQuat::from_rotation_y(FRAC_PI_2);
        let channel = |node, property, values: &[f32]| Channel {
            node,
            property,
            interpolation: Interpolation::Linear,
            times: vec![0.0, 2.0],
            values: values.to_vec(),
        };
        let animation = |channel: Channel| Animation { channels: vec![channel], duration: 2.0, ..Animation::default() };
        let scene = Scene {
            nodes: vec![
                node(None, trs(DVec3::X, quarter, DVec3::ONE)),
                node(Some(0), trs(DVec3::X, DQuat::IDENTITY, DVec3::ONE)),
                node(Some(1), Transform::Affine(DAffine3::from_translation(DVec3::X))),
            ],
            animations: vec![
                animation(channel(1, Property::Translation, &[1.0, 0.0, 0.0, 3.0, 0.0, 0.0])),
                animation(channel(1, Property::Scale, &[1.0, 1.0, 1.0, 3.0, 3.0, 3.0])),
                animation(channel(2, Property::Translation, &[9.0; 6])),
                animation(channel(7, Property::Translation, &[9.0; 6])),
            ],
            ..Scene::default()
        };
        // Turned about y, the children's +X is the world's -Z.
        let tip = |time, choice| pose(&scene, time, choice, &BTreeMap::new()).world_from_node[2].translation;
        assert!(tip(0.0, AnimationChoice::Still).distance(DVec3::new(1.0, 0.0, -2.0)) < 1e-12);
        assert!(tip(1.0, AnimationChoice::One(0)).distance(DVec3::new(1.0, 0.0, -3.0)) < 1e-12);
        assert!(tip(1.0, AnimationChoice::One(1)).distance(DVec3::new(1.0, 0.0, -3.0)) < 1e-12);
        assert!(tip(3.0, AnimationChoice::All).distance(DVec3::new(1.0, 0.0, -4.0)) < 1e-12, "looped; a matrix stays");
        assert!(tip(1.0, AnimationChoice::One(99)).distance(DVec3::new(1.0, 0.0, -2.0)) < 1e-12);
    }

    #[test]
    fn a_skin_bends_at_its_joint() {
        let bound = |weights: [f32; 2]| SkinVertex { joints: [0, 1, 0, 0], weights: [weights[0], weights[1], 0.0, 0.0] };
        let mesh =
            Mesh::new(MeshParts { skin: vec![bound([1.0, 0.0]), bound([0.5, 0.5]), bound([0.0, 1.0])], ..blade() }).unwrap();
        let lean = DQuat::from_rotation_x(FRAC_PI_2);
        let scene = Scene {
            nodes: vec![
                // The mesh's own node must not matter.
                Node { mesh: Some(0), skin: Some(0), ..node(None, trs(DVec3::splat(100.0), lean, DVec3::splat(7.0))) },
                node(None, trs(DVec3::Z * 10.0, DQuat::IDENTITY, DVec3::ONE)),
                node(Some(1), trs(DVec3::Y, lean, DVec3::ONE)),
            ],
            meshes: vec![mesh],
            skins: vec![Skin {
                joints: vec![1, 2],
                inverse_bind: vec![DAffine3::IDENTITY, DAffine3::from_translation(DVec3::NEG_Y)],
            }],
            ..Scene::default()
        };
        let pose = still(&scene);
        assert_eq!(pose.world_from_object[0], DAffine3::IDENTITY);
        let deformed = pose.deformed[0].as_ref().unwrap();
        // The upper joint sits at y = 1 and turns +Y to +Z.
        assert!(close(deformed.positions[0], Vec3::new(0.0, 0.0, 10.0)));
        assert!(close(deformed.positions[1], Vec3::new(0.5, 1.0, 10.0)));
        assert!(close(deformed.positions[2], Vec3::new(0.0, 1.0, 11.0)));
        assert!(close(deformed.normals[0], Vec3::Z) && close(deformed.normals[2], Vec3::NEG_Y));
        let between = Vec3::new(0.0, -1.0, 1.0).normalize();
        assert!(close(deformed.normals[1], between), "{}", deformed.normals[1]);
        assert_eq!(deformed.bounds, Aabb::from_points(deformed.positions.iter().copied()));
        assert!(deformed.terminator.iter().any(|sine| *sine > 0.1), "the normals left the face");
        assert_eq!(pose.positions(&scene, 0), deformed.positions);
        assert_eq!(scene.bounds(&pose), deformed.bounds);
    }

    #[test]
    fn morph_targets_add_up_and_weights_come_from_channel_node_or_mesh() {
        let morphs = vec![
            MorphTarget { positions: vec![Vec3::Z, Vec3::ZERO, Vec3::ZERO], normals: vec![Vec3::X, Vec3::ZERO, Vec3::ZERO] },
            MorphTarget { positions: vec![Vec3::ZERO, Vec3::Y, Vec3::Y], normals: vec![] },
        ];
        let mesh = Mesh::new(MeshParts { morphs, morph_weights: vec![0.0, 3.0], ..blade() }).unwrap();
        let channel = Channel {
            node: 2,
            property: Property::Weights,
            interpolation: Interpolation::Linear,
            times: vec![0.0, 1.0],
            values: vec![0.0, 0.0, 2.0, 1.0],
        };
        let show = |weights: &[f32]| Node { mesh: Some(0), morph_weights: weights.to_vec(), ..Node::default() };
        let scene = Scene {
            nodes: vec![show(&[]), show(&[1.0, 2.0]), show(&[0.0, 0.0])],
            meshes: vec![mesh],
            animations: vec![Animation { channels: vec![channel], duration: 4.0, ..Animation::default() }],
            ..Scene::default()
        };
        let pose = pose(&scene, 0.5, AnimationChoice::All, &BTreeMap::new());
        let tips = |node| pose.positions(&scene, node).to_vec();
        assert_eq!(tips(0), [Vec3::ZERO, Vec3::new(0.5, 4.0, 0.0), Vec3::new(0.0, 5.0, 0.0)]);
        assert_eq!(tips(1), [Vec3::Z, Vec3::new(0.5, 3.0, 0.0), Vec3::new(0.0, 4.0, 0.0)]);
        assert_eq!(tips(2), [Vec3::Z, Vec3::new(0.5, 1.5, 0.0), Vec3::new(0.0, 2.5, 0.0)]);
        let normals = &pose.deformed[1].as_ref().unwrap().normals;
        assert!(close(normals[0], Vec3::new(1.0, 0.0, 1.0).normalize()) && close(normals[1], Vec3::Z));
        assert!(still(&scene).deformed[2].is_none(), "weights of zero bend nothing");
    }

    #[test]
    fn a_flat_mesh_stays_flat_when_it_bends() {
        let morphs = vec![MorphTarget { positions: vec![Vec3::ZERO, Vec3::Z * 0.5, Vec3::ZERO], normals: vec![] }];
        let mesh = Mesh::new(MeshParts { normals: None, morphs, morph_weights: vec![1.0], ..blade() }).unwrap();
        let scene = Scene { nodes: vec![Node { mesh: Some(0), ..Node::default() }], meshes: vec![mesh], ..Scene::default() };
        let pose = still(&scene);
        let deformed = pose.deformed[0].as_ref().unwrap();
        let expected = Vec3::new(-1.0, 0.0, 1.0).normalize();
        assert!(deformed.normals.iter().all(|normal| close(*normal, expected)), "{:?}", deformed.normals);
        assert!(deformed.terminator.iter().all(|sine| *sine < 1e-6));
    }

    #[test]
    fn what_has_no_inverse_is_baked_and_mirrors_are_not() {
        let shown = |scale: DVec3| Node { mesh: Some(0), ..node(None, trs(DVec3::X, DQuat::IDENTITY, scale)) };
        let mut parts = blade();
        parts.positions[2].z = 1.0;
        let scene = Scene {
            nodes: vec![
                shown(DVec3::new(-1.0, 1.0, 1.0)),
                shown(DVec3::new(2.0, 1.0, 0.0)),
                shown(DVec3::ZERO),
                shown(DVec3::splat(1e300)),
                shown(DVec3::new(1.0, 1e-7, 1.0)),
            ],
            meshes: vec![Mesh::new(parts).unwrap()],
            ..Scene::default()
        };
        let pose = still(&scene);
        assert!(pose.deformed[0].is_none(), "a mirror has an inverse");
        assert!(pose.world_from_object[0].matrix3.determinant() < 0.0);
        assert!(pose.deformed[4].is_none(), "a thin thing too");
        let flat = pose.deformed[1].as_ref().unwrap();
        assert_eq!(flat.positions, [Vec3::X, Vec3::new(2.0, 1.0, 0.0), Vec3::new(1.0, 2.0, 0.0)]);
        assert_eq!(flat.normals, [Vec3::Z; 3]);
        assert_eq!(pose.world_from_object[1], DAffine3::IDENTITY);
        assert_eq!(pose.positions(&scene, 2), [Vec3::X; 3], "a point");
        assert!(pose.positions(&scene, 3).iter().all(|position| position.is_finite()));
        assert!(pose.deformed.iter().flatten().all(|deformed| deformed.normals.iter().all(|normal| normal.is_normalized())));
    }

    #[test]
    fn lights_stand_where_their_nodes_are_unless_edited() {
        let place = trs(DVec3::new(1.0, 2.0, 3.0), DQuat::from_rotation_y(FRAC_PI_2), DVec3::splat(2.0));
        let light = |kind| Light {
            kind,
            color: Vec3::new(1.0, 0.5, 0.0),
            intensity: 8.0,
            range: 5.0,
            slide: Some(0),
            ..Light::default()
        };
        let scene = Scene {
            nodes: vec![node(None, place)],
            lights: vec![
                light(LightKind::Point),
                light(LightKind::Directional),
                light(LightKind::Spot { inner: 0.1, outer: 0.2 }),
            ],
            ..Scene::default()
        };
        let edit = LightEdit {
            position: Some(DVec3::Y),
            color: Some(Vec3::ONE),
            intensity: Some(3.0),
            range: Some(7.0),
            on: Some(false),
            shadows: Some(false),
            radius: Some(0.25),
            slide: Some(SlideChoice::BuiltIn(BuiltInSlide::Grille)),
        };
        let broken = LightEdit {
            position: Some(DVec3::NAN),
            color: Some(Vec3::NAN),
            intensity: Some(f32::INFINITY),
            range: Some(-1.0),
            radius: Some(-1.0),
            ..LightEdit::default()
        };
        let pose = pose(&scene, 0.0, AnimationChoice::All, &BTreeMap::from([(0, edit), (2, broken), (9, LightEdit::default())]));
        let [point, sun, spot] = [pose.lights[0], pose.lights[1], pose.lights[2]];
        assert_eq!(
            (point.position, point.intensity, point.range, point.on, point.shadows),
            (DVec3::Y, Vec3::splat(3.0), 7.0, false, false)
        );
        assert_eq!((point.extent, point.slide), (Extent::Round(0.25), None), "only spots project");
        assert_eq!((spot.extent, spot.slide), (Extent::Point, Some(Slide::Texture(0))));
        assert!(spot.right.distance(DVec3::NEG_Z) < 1e-12 && spot.center == spot.position);
        assert_eq!((sun.range, sun.on, sun.shadows), (f64::INFINITY, true, true));
        assert!(sun.direction.distance(DVec3::NEG_X) < 1e-12);
        assert_eq!((spot.position, spot.intensity, spot.range), (DVec3::new(1.0, 2.0, 3.0), Vec3::new(8.0, 4.0, 0.0), 5.0));

        let world_from_object = DAffine3::from_scale_rotation_translation(DVec3::new(1.0, -2.0, 1.0), DQuat::IDENTITY, DVec3::X);
        assert_eq!(light_in_object(&world_from_object, &point), DVec4::new(-1.0, -0.5, 0.0, 1.0));
        assert!(light_in_object(&world_from_object, &sun).distance(DVec4::new(1.0, 0.0, 0.0, 0.0)) < 1e-12);
    }
}
