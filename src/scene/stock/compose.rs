//! Puts scenes together from the models in `assets/`: takes parts by their node's name, recolours
//! them, places them, adds lights, cameras and movement.
//!
//! Only parts that are asked for enter the scene, with just their materials and textures, each
//! once. A name that no model has becomes a warning of the scene; a test holds every stock scene to
//! have none.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DQuat, DVec3, Vec2, Vec3, Vec4};

use crate::frame::camera::DEFAULT_NEAR;
use crate::scene::gltf::{ImportError, load_embedded};
use crate::scene::{
    AlphaMode, Animation, AnimationChoice, BuiltInSlide, Camera, Channel, Environment, Extent, Interpolation, Light, LightKind,
    Material, Mesh, MeshParts, Node, Operands, Primitive, Property, Reflective, Scene, Transform,
};

macro_rules! model {
    ($name:literal) => {
        ($name, include_bytes!(concat!("../../../assets/", $name, ".glb")))
    };
}

/// A model file in the program.
pub(super) type Model = (&'static str, &'static [u8]);

/// All of them.
#[cfg(test)]
pub(super) const MODELS: [Model; 11] =
    [SOLIDS, TEAPOT, CUTOUT, FLOORS, ARCHITECTURE, FURNITURE, WALKER, STAIRS, TOYS, PILGRIM, CATHEDRAL];

pub(super) const SOLIDS: Model = model!("solids");
pub(super) const TEAPOT: Model = model!("teapot");
pub(super) const CUTOUT: Model = model!("cutout");
pub(super) const FLOORS: Model = model!("floors");
pub(super) const ARCHITECTURE: Model = model!("architecture");
pub(super) const FURNITURE: Model = model!("furniture");
pub(super) const WALKER: Model = model!("walker");
pub(super) const STAIRS: Model = model!("stairs");
pub(super) const TOYS: Model = model!("toys");
pub(super) const PILGRIM: Model = model!("pilgrim");
pub(super) const CATHEDRAL: Model = model!("cathedral");

/// Seconds the walker takes for two steps, as its model says.
pub(super) const STRIDE_SECONDS: f64 = 1.16;
/// Metres the walker goes with two steps.
pub(super) const STRIDE: f64 = 1.04;

/// A mesh in the scene, ready to be placed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Prop {
    mesh: usize,
    casts_shadow: bool,
}

/// Where something is: a [`Transform`] in the making.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    translation: DVec3,
    rotation: DQuat,
    scale: DVec3,
}

/// At a point, upright, facing +Z, life-sized.
pub(super) fn at(x: f64, y: f64, z: f64) -> Place {
    Place { translation: DVec3::new(x, y, z), rotation: DQuat::IDENTITY, scale: DVec3::ONE }
}

impl Place {
    /// Turned about the vertical by these degrees first, counter-clockwise seen from above.
    pub(super) fn facing(self, degrees: f64) -> Self {
        self.turned(DVec3::Y, degrees)
    }

    /// Turned about a unit axis of its own by these degrees.
    pub(super) fn turned(self, axis: DVec3, degrees: f64) -> Self {
        Self { rotation: self.rotation * DQuat::from_axis_angle(axis, degrees.to_radians()), ..self }
    }

    /// This many times as large.
    pub(super) fn sized(self, factor: f64) -> Self {
        self.stretched(factor, factor, factor)
    }

    /// This many times as large along its own axes.
    pub(super) fn stretched(self, x: f64, y: f64, z: f64) -> Self {
        Self { scale: self.scale * DVec3::new(x, y, z), ..self }
    }
}

impl From<Place> for Transform {
    fn from(place: Place) -> Self {
        Self::Trs { translation: place.translation, rotation: place.rotation, scale: place.scale }
    }
}

/// A loaded model, and where its parts went in the scene.
struct Library {
    model: Scene,
    meshes: Vec<Option<usize>>,
    materials: Vec<Option<usize>>,
    textures: Vec<Option<usize>>,
}

/// A scene in the making.
pub(super) struct Composer {
    scene: Scene,
    libraries: Vec<Library>,
}

impl Composer {
    /// An empty scene that takes its parts from these models.
    pub(super) fn new(name: &str, models: &[Model]) -> Result<Self, ImportError> {
        let mut libraries = Vec::new();
        for (name, bytes) in models {
            let model = load_embedded(name, bytes)?;
            libraries.push(Library {
                meshes: vec![None; model.meshes.len()],
                materials: vec![None; model.materials.len()],
                textures: vec![None; model.textures.len()],
                model,
            });
        }
        let scene = Scene { name: name.into(), exposure: 1.0, default_animation: AnimationChoice::All, ..Scene::default() };
        Ok(Self { scene, libraries })
    }

    /// The scene, done.
    pub(super) fn finish(mut self) -> Scene {
        let refused = [self.scene.find_mirrors(), self.scene.find_receivers()];
        self.scene.warnings.extend(refused.into_iter().flatten());
        self.scene
    }

    /// Light from everywhere: from above, from below; and the backdrop, top and bottom.
    pub(super) fn environment(&mut self, sky: [f32; 3], ground: [f32; 3], top: [f32; 3], bottom: [f32; 3]) {
        self.scene.environment =
            Environment { ambient_sky: sky.into(), ambient_ground: ground.into(), background: [top.into(), bottom.into()] };
    }

    /// The mesh that the model node of this name shows.
    pub(super) fn prop(&mut self, name: &str) -> Prop {
        for library in &mut self.libraries {
            let shown = library.model.nodes.iter().find(|node| node.name == name).and_then(|node| Some((node, node.mesh?)));
            if let Some((node, mesh)) = shown {
                let casts_shadow = node.casts_shadow;
                return Prop { mesh: library.bring_mesh(&mut self.scene, mesh), casts_shadow };
            }
        }
        self.scene.warnings.push(format!("no model holds a part {name:?}"));
        Prop { mesh: 0, casts_shadow: true }
    }

    /// The same shape in one colour (linear), without its texture.
    pub(super) fn tinted(&mut self, prop: Prop, color: [f32; 3], roughness: f32) -> Prop {
        let [r, g, b] = color;
        self.remade(prop, |material| {
            material.base_color = Vec4::new(r, g, b, 1.0);
            material.base_color_texture = None;
            material.roughness = roughness;
        })
    }

    /// The same shape with one of its primitives in another colour (linear).
    pub(super) fn painted(&mut self, prop: Prop, primitive: usize, color: [f32; 3], roughness: f32) -> Prop {
        let [r, g, b] = color;
        let mut numbers = 0..;
        self.remade(prop, |material| {
            if numbers.next() == Some(primitive) {
                material.base_color = Vec4::new(r, g, b, 1.0);
                material.roughness = roughness;
            }
        })
    }

    /// The same shape shining of itself; it casts no shadow: lights sit inside such things.
    pub(super) fn glowing(&mut self, prop: Prop, radiance: [f32; 3]) -> Prop {
        let prop = self.remade(prop, |material| {
            material.base_color = Vec4::new(0.0, 0.0, 0.0, 1.0);
            material.emissive = radiance.into();
        });
        Prop { casts_shadow: false, ..prop }
    }

    fn remade(&mut self, prop: Prop, mut change: impl FnMut(&mut Material)) -> Prop {
        let Some(mut mesh) = self.scene.meshes.get(prop.mesh).cloned() else { return prop };
        for primitive in &mut mesh.primitives {
            let mut material = self.scene.materials.get(primitive.material).cloned().unwrap_or_default();
            change(&mut material);
            primitive.material = self.scene.materials.len();
            self.scene.materials.push(material);
        }
        self.scene.meshes.push(mesh);
        Prop { mesh: self.scene.meshes.len() - 1, ..prop }
    }

    /// A mesh made of these triangles (counter-clockwise from outside), flat, in one colour (linear).
    pub(super) fn made(
        &mut self,
        name: &str,
        positions: &[Vec3],
        triangles: &[[u32; 3]],
        color: [f32; 3],
        roughness: f32,
    ) -> Prop {
        let [r, g, b] = color;
        let index_count = triangles.as_flattened().len() as u32;
        let primitive = Primitive { first_index: 0, index_count, material: self.scene.materials.len(), casts_shadow: true };
        let parts = MeshParts {
            name: name.into(),
            positions: positions.to_vec(),
            indices: triangles.as_flattened().to_vec(),
            primitives: vec![primitive],
            ..MeshParts::default()
        };
        let base_color = Vec4::new(r, g, b, 1.0);
        self.scene.materials.push(Material { name: name.into(), base_color, roughness, ..Material::default() });
        self.meshed(parts)
    }

    fn meshed(&mut self, parts: MeshParts) -> Prop {
        let name = parts.name.clone();
        match Mesh::new(parts) {
            Ok(mesh) => self.scene.meshes.push(mesh),
            Err(error) => self.scene.warnings.push(format!("the mesh {name:?} cannot be made: {error}")),
        }
        Prop { mesh: self.scene.meshes.len().saturating_sub(1), casts_shadow: true }
    }

    /// A rectangle of a floor in the material of another, as large as its half sides say, the texture repeated
    /// every so many metres; it looks up and casts no shadow.
    pub(super) fn laid(&mut self, floor: Prop, half: [f32; 2], repeat: f32) -> Prop {
        let material = self.scene.meshes.get(floor.mesh).and_then(|mesh| mesh.primitives.first()).map(|run| run.material);
        let corners = [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]].map(|corner| Vec2::from(corner) * Vec2::from(half));
        let prop = self.meshed(MeshParts {
            name: "floor".into(),
            positions: corners.iter().map(|corner| Vec3::new(corner.x, 0.0, corner.y)).collect(),
            uvs: Some(corners.iter().map(|corner| *corner / repeat).collect()),
            indices: vec![0, 1, 2, 0, 2, 3],
            primitives: vec![Primitive {
                first_index: 0,
                index_count: 6,
                material: material.unwrap_or_default(),
                casts_shadow: true,
            }],
            ..MeshParts::default()
        });
        Self::shadeless(prop)
    }

    /// The same shape as a mirror.
    pub(super) fn reflecting(&mut self, prop: Prop, look: Reflective) -> Prop {
        self.remade(prop, |material| material.mirror = Some(look))
    }

    /// The same shape marked to take planar shadows.
    pub(super) fn receiving(&mut self, prop: Prop) -> Prop {
        self.remade(prop, |material| material.receiver = true)
    }

    /// The same shape as a decal, which covers so much of what it lies on; it casts no shadow.
    pub(super) fn decal(&mut self, prop: Prop, opacity: f32) -> Prop {
        let prop = self.remade(prop, |material| {
            material.decal = true;
            if opacity < 1.0 {
                material.alpha = AlphaMode::Blend;
                material.base_color.w = opacity;
            }
        });
        Self::shadeless(prop)
    }

    /// The same, casting no shadow: walls and floors with nothing behind them.
    pub(super) fn shadeless(prop: Prop) -> Prop {
        Prop { casts_shadow: false, ..prop }
    }

    /// The same shape drawn from both sides: a sheet.
    pub(super) fn sheet(&mut self, prop: Prop) -> Prop {
        self.remade(prop, |material| material.double_sided = true)
    }

    /// Two nodes are meant to be put together.
    pub(super) fn combines(&mut self, operands: Operands) {
        self.scene.operands = Some(operands);
    }

    /// Two doorways lead to each other.
    pub(super) fn joins(&mut self, [one, other]: [usize; 2]) {
        self.scene.nodes[one].portal = Some(other);
        self.scene.nodes[other].portal = Some(one);
    }

    /// A node glows, with all that hangs on it.
    pub(super) fn halo(&mut self, node: usize) {
        self.scene.nodes[node].halo = true;
    }

    /// A node that shows nothing, to hang others on.
    pub(super) fn group(&mut self, name: &str, parent: Option<usize>, place: Place) -> usize {
        self.scene.nodes.push(Node { name: name.into(), parent, local: place.into(), ..Node::default() });
        self.scene.nodes.len() - 1
    }

    /// Places a part in the scene.
    pub(super) fn put(&mut self, name: &str, prop: Prop, place: Place) -> usize {
        self.put_on(None, name, prop, place)
    }

    /// Places a part in a node's space.
    pub(super) fn put_on(&mut self, parent: Option<usize>, name: &str, prop: Prop, place: Place) -> usize {
        let node = self.group(name, parent, place);
        if prop.mesh < self.scene.meshes.len() {
            self.scene.nodes[node].mesh = Some(prop.mesh);
            self.scene.nodes[node].casts_shadow = prop.casts_shadow;
        }
        node
    }

    /// Places all of a model, its skins and animations too.
    pub(super) fn put_figure(&mut self, parent: Option<usize>, model: Model, name: &str, place: Place) -> usize {
        let root = self.group(name, parent, place);
        let mut libraries = std::mem::take(&mut self.libraries);
        if let Some(library) = libraries.iter_mut().find(|library| library.model.name == model.0) {
            let (nodes, skins) = (self.scene.nodes.len(), self.scene.skins.len());
            for index in 0..library.model.nodes.len() {
                let mesh = library.model.nodes[index].mesh.map(|mesh| library.bring_mesh(&mut self.scene, mesh));
                let node = &library.model.nodes[index];
                self.scene.nodes.push(Node {
                    parent: Some(node.parent.map_or(root, |parent| parent + nodes)),
                    mesh,
                    skin: node.skin.map(|skin| skin + skins),
                    ..node.clone()
                });
            }
            for skin in &library.model.skins {
                let mut skin = skin.clone();
                skin.joints.iter_mut().for_each(|joint| *joint += nodes);
                self.scene.skins.push(skin);
            }
            for animation in &library.model.animations {
                let mut animation = animation.clone();
                animation.name = format!("{name}: {}", animation.name);
                animation.channels.iter_mut().for_each(|channel| channel.node += nodes);
                self.scene.animations.push(animation);
            }
        } else {
            self.scene.warnings.push(format!("the model {:?} is not loaded", model.0));
        }
        self.libraries = libraries;
        root
    }

    /// Gives a figure's parts of the material `part` another colour; call it right after placing the figure.
    pub(super) fn dyed(&mut self, figure: usize, part: &str, color: [f32; 3]) {
        let [r, g, b] = color;
        for node in figure + 1..self.scene.nodes.len() {
            let Some(mesh) = self.scene.nodes[node].mesh else { continue };
            let prop = self.remade(Prop { mesh, casts_shadow: true }, |material| {
                if material.name == part {
                    material.base_color = Vec4::new(r, g, b, 1.0);
                }
            });
            self.scene.nodes[node].mesh = Some(prop.mesh);
        }
    }

    /// Starts a figure's own animation this part of its loop later, so that it is out of step with its like.
    pub(super) fn out_of_step(&mut self, name: &str, turns: f64) {
        for animation in self.scene.animations.iter_mut().filter(|animation| animation.name == format!("{name}: walk")) {
            for channel in &mut animation.channels {
                let (mut shifted, mut value) = (Vec::new(), Vec::new());
                for &time in &channel.times {
                    channel
                        .sample((f64::from(time) / animation.duration + turns).rem_euclid(1.0) * animation.duration, &mut value);
                    shifted.extend(value.iter().map(|&v| v as f32));
                }
                channel.values = shifted;
            }
        }
    }

    /// A part that shines of itself in its own colours, this many times as bright; it casts no shadow.
    pub(super) fn luminous(&mut self, prop: Prop, factor: f32) -> Prop {
        let prop = self.remade(prop, |material| {
            material.unlit = true;
            material.base_color = Vec4::new(factor, factor, factor, 1.0);
        });
        Prop { casts_shadow: false, ..prop }
    }

    /// A light at a node's origin, shining along its -Z where it has a direction.
    pub(super) fn light(&mut self, node: usize, kind: LightKind, color: [f32; 3], intensity: f32, range: f32) {
        let name = self.scene.nodes[node].name.clone();
        self.scene.lights.push(Light { name, node, kind, color: color.into(), intensity, range, ..Light::default() });
    }

    /// The last light has a size.
    pub(super) fn sized_light(&mut self, extent: Extent) {
        if let Some(light) = self.scene.lights.last_mut() {
            light.extent = extent;
        }
    }

    /// The last light, a spot, projects a slide.
    pub(super) fn projects(&mut self, slide: BuiltInSlide) {
        let texture = self.scene.textures.len();
        if let Some(light) = self.scene.lights.last_mut() {
            light.slide = Some(texture);
            self.scene.textures.push(slide.texture().clone());
        }
    }

    /// A light that shines everywhere, standing still.
    pub(super) fn point_light(&mut self, name: &str, position: [f64; 3], color: [f32; 3], candela: f32, range: f32) -> usize {
        let [x, y, z] = position;
        let node = self.group(name, None, at(x, y, z));
        self.light(node, LightKind::Point, color, candela, range);
        node
    }

    /// A node at `eye` that looks at `target` along its -Z, upright.
    pub(super) fn looking(&mut self, name: &str, eye: [f64; 3], target: [f64; 3]) -> usize {
        let (eye, target) = (DVec3::from(eye), DVec3::from(target));
        let back = (eye - target).normalize();
        let right = DVec3::Y.cross(back).normalize();
        let rotation = DQuat::from_mat3(&DMat3::from_cols(right, back.cross(right), back));
        self.group(name, None, Place { translation: eye, rotation, scale: DVec3::ONE })
    }

    /// A camera at `eye` that turns about `target`; the scene's first is the one it opens with.
    pub(super) fn camera(&mut self, name: &str, eye: [f64; 3], target: [f64; 3], vertical_degrees: f64) {
        let node = self.looking(&format!("camera {name}"), eye, target);
        self.scene.cameras.push(Camera {
            name: name.into(),
            node,
            vertical_fov: vertical_degrees.to_radians(),
            near: DEFAULT_NEAR,
            focus_distance: DVec3::from(eye).distance(DVec3::from(target)),
        });
    }

    /// Moves a node along a closed path, `path(turns)` for turns from 0 to 1, every `seconds`.
    pub(super) fn moves(&mut self, node: usize, seconds: f64, keys: usize, path: impl Fn(f64) -> DVec3) {
        let values = keyed(keys, |turns| path(turns).as_vec3());
        self.animate(node, Property::Translation, seconds, keys, values.iter().flat_map(Vec3::to_array).collect());
    }

    /// Turns a node, `rotation(turns)` for turns from 0 to 1, every `seconds`; the ends must agree.
    pub(super) fn turns(&mut self, node: usize, seconds: f64, keys: usize, rotation: impl Fn(f64) -> DQuat) {
        let values = keyed(keys, |turns| rotation(turns).as_quat());
        self.animate(node, Property::Rotation, seconds, keys, values.iter().flat_map(|q| q.to_array()).collect());
    }

    /// Swings a node about a unit axis, to and fro, by at most these degrees.
    pub(super) fn swings(&mut self, node: usize, seconds: f64, axis: DVec3, degrees: f64) {
        self.turns(node, seconds, 24, |turns| DQuat::from_axis_angle(axis, degrees.to_radians() * (turns * TAU).sin()));
    }

    /// Leads a walker's root along a closed path of a whole number of strides, facing where it
    /// goes, its feet in step with the ground.
    pub(super) fn walks(&mut self, root: usize, strides: u32, path: impl Fn(f64) -> DVec3) {
        let (seconds, keys) = (f64::from(strides) * STRIDE_SECONDS, strides as usize * 6);
        self.moves(root, seconds, keys, &path);
        self.turns(root, seconds, keys, |turns| {
            let ahead = path((turns + 1e-3).rem_euclid(1.0)) - path((turns - 1e-3).rem_euclid(1.0));
            DQuat::from_rotation_y(ahead.x.atan2(ahead.z))
        });
    }

    fn animate(&mut self, node: usize, property: Property, seconds: f64, keys: usize, values: Vec<f32>) {
        let times = (0..=keys).map(|key| (seconds * key as f64 / keys as f64) as f32).collect();
        let channel = Channel { node, property, interpolation: Interpolation::Linear, times, values };
        // What moves and turns on one clock is one animation.
        let name = self.scene.nodes[node].name.clone();
        let same = self.scene.animations.iter_mut().find(|animation| animation.name == name && animation.duration == seconds);
        match same {
            Some(animation) => animation.channels.push(channel),
            None => self.scene.animations.push(Animation { name, channels: vec![channel], duration: seconds }),
        }
    }
}

/// Values at evenly spaced turns; the last is the first again, to the bit, so that loops have no seam.
fn keyed<T: Copy>(keys: usize, value: impl Fn(f64) -> T) -> Vec<T> {
    let mut values: Vec<T> = (0..keys).map(|key| value(key as f64 / keys as f64)).collect();
    values.extend(values.first().copied());
    values
}

impl Library {
    fn bring_mesh(&mut self, scene: &mut Scene, index: usize) -> usize {
        if let Some(done) = self.meshes[index] {
            return done;
        }
        let mut mesh = self.model.meshes[index].clone();
        for primitive in &mut mesh.primitives {
            primitive.material = self.bring_material(scene, primitive.material);
        }
        scene.meshes.push(mesh);
        *self.meshes[index].insert(scene.meshes.len() - 1)
    }

    fn bring_material(&mut self, scene: &mut Scene, index: usize) -> usize {
        if let Some(done) = self.materials[index] {
            return done;
        }
        let mut material = self.model.materials[index].clone();
        material.base_color_texture = material.base_color_texture.map(|texture| {
            *self.textures[texture].get_or_insert_with(|| {
                scene.textures.push(self.model.textures[texture].clone());
                scene.textures.len() - 1
            })
        });
        scene.materials.push(material);
        *self.materials[index].insert(scene.materials.len() - 1)
    }
}

/// A point on a circle about the vertical axis through `centre`, counter-clockwise seen from above.
pub(super) fn circle(centre: DVec3, radius: f64, turns: f64) -> DVec3 {
    let (sin, cos) = (turns * TAU).sin_cos();
    centre + DVec3::new(cos * radius, 0.0, -sin * radius)
}

/// A closed way of this length about the z axis: two straights `radius` to both sides, two half circles.
pub(super) fn there_and_back(middle: DVec3, radius: f64, length: f64, turns: f64) -> DVec3 {
    let straight = (length - TAU * radius) / 2.0;
    let (half, arc) = (straight / 2.0, PI * radius);
    let s = turns.rem_euclid(1.0) * length;
    middle
        + if s < straight {
            DVec3::new(radius, 0.0, half - s)
        } else if s < straight + arc {
            DVec3::new(0.0, 0.0, -half) + circle(DVec3::ZERO, radius, (s - straight) / arc * 0.5)
        } else if s < 2.0 * straight + arc {
            DVec3::new(-radius, 0.0, s - straight - arc - half)
        } else {
            DVec3::new(0.0, 0.0, half) + circle(DVec3::ZERO, radius, (s - 2.0 * straight - arc) / arc * 0.5 + 0.5)
        }
}
