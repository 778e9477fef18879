//! What there is to draw: meshes with their shadow topology, materials, lights, cameras, animation.
//!
//! A [`Scene`] is CPU data in metres, radians and linear colour; it knows nothing of the GPU and
//! nothing of the settings. It does not change while it is shown: what moves is a [`Pose`], made
//! anew for each point in time by [`pose`](crate::scene::pose::pose).
//!
//! Stock scenes ([`stock`]) and users' files ([`gltf`]) arrive by the same importer.

pub mod animation;
pub mod area;
mod deform;
pub mod doctor;
pub mod generated;
pub mod gltf;
mod halo;
pub mod mesh;
pub mod mirror;
pub mod off_mirror;
pub mod open;
pub mod pick;
pub mod pose;
pub mod receiver;
pub mod slides;
pub mod solid;
pub mod stock;

pub use animation::{Animation, AnimationChoice, Channel, Interpolation, Property};
pub use area::{Extent, Sampling};
pub use mesh::{Mesh, MeshError, MeshParts, MorphTarget, Primitive, SkinVertex};
pub use mirror::{Mirror, PosedMirror, Reflective, Refusal};
pub use off_mirror::OffMirror;
pub use open::{Loading, OpenError, load_on_thread, open};
pub use pose::{DeformedMesh, Pose, PosedLight};
pub use receiver::{PosedReceiver, Receiver};
pub use slides::{BuiltInSlide, Slide};
pub use solid::{Combination, Operands, Solid, Unfit};

use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec3, Vec3, Vec4};

use crate::geometry::Silhouettes;

/// Everything of one scene. Indices (`usize`) point into the vectors of this struct.
#[derive(Debug, Clone, Default)]
pub struct Scene {
    /// What the panel and `obscura info` call it.
    pub name: String,
    /// Sorted so that a parent comes before its children.
    pub nodes: Vec<Node>,
    /// Shared by the nodes that show them.
    pub meshes: Vec<Mesh>,
    /// Never empty where there is a mesh: primitives without one get a neutral grey.
    pub materials: Vec<Material>,
    /// Decoded images with their samplers.
    pub textures: Vec<Texture>,
    /// Joint lists of the skinned meshes.
    pub skins: Vec<Skin>,
    /// Everything that moves.
    pub animations: Vec<Animation>,
    /// Which of them play unless the user chooses otherwise.
    pub default_animation: AnimationChoice,
    /// Lights, each placed by a node.
    pub lights: Vec<Light>,
    /// Cameras, each placed by a node. Never empty after import.
    pub cameras: Vec<Camera>,
    /// The mirrors among its surfaces, as the importer found them.
    pub mirrors: Vec<Mirror>,
    /// Two objects that it means to be put together.
    pub operands: Option<Operands>,
    /// What was put together ([`Scene::combined`]).
    pub solid: Option<Solid>,
    /// Another scene, which the picture dissolves into: by itself, with its own numbers.
    pub partner: Option<Arc<Scene>>,
    /// The surfaces that take planar shadows, as the importer found them.
    pub receivers: Vec<Receiver>,
    /// Light from everywhere and the colour behind everything.
    pub environment: Environment,
    /// Multiplies linear colour before the tone map; chosen for the scene, settings add stops.
    pub exposure: f32,
    /// What the importer had to leave out or replace, one sentence each, naming the part.
    pub warnings: Vec<String>,
    /// A memory of what lights see of its casters.
    pub silhouettes: Silhouettes,
}

/// One place in the hierarchy.
#[derive(Debug, Clone)]
pub struct Node {
    /// Its name in the file, or `node N`.
    pub name: String,
    /// Always a smaller index than the node's own.
    pub parent: Option<usize>,
    /// Where it is in its parent's space, unanimated.
    pub local: Transform,
    /// The mesh it shows.
    pub mesh: Option<usize>,
    /// The skin that deforms the mesh; the mesh is then posed in world space.
    pub skin: Option<usize>,
    /// Weights of the mesh's morph targets, unanimated; empty means the mesh's own.
    pub morph_weights: Vec<f32>,
    /// False where `extras` say `{"casts_shadow": false}`.
    pub casts_shadow: bool,
    /// It has a halo, with all that hangs on it: `extras` say `{"halo": true}`.
    pub halo: bool,
    /// The node of the doorway that this one leads to: a portal, where both lie on one plane each. `extras` say
    /// `{"portal": "that node's name"}`.
    pub portal: Option<usize>,
}

impl Default for Node {
    fn default() -> Self {
        Self {
            name: String::new(),
            parent: None,
            local: Transform::IDENTITY,
            mesh: None,
            skin: None,
            morph_weights: Vec::new(),
            casts_shadow: true,
            halo: false,
            portal: None,
        }
    }
}

/// A node's place in its parent's space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Transform {
    /// Translation, rotation (unit), scale: what animations move.
    Trs {
        /// Metres.
        translation: DVec3,
        /// Unit quaternion.
        rotation: DQuat,
        /// Per axis; negative values mirror.
        scale: DVec3,
    },
    /// Any affine map; glTF forbids animating such nodes.
    Affine(DAffine3),
}

impl Transform {
    /// Nothing moved.
    pub const IDENTITY: Self = Self::Trs { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE };

    /// `parent_from_node`.
    #[must_use]
    pub fn affine(&self) -> DAffine3 {
        match *self {
            Self::Trs { translation, rotation, scale } => DAffine3::from_scale_rotation_translation(scale, rotation, translation),
            Self::Affine(affine) => affine,
        }
    }
}

/// How a surface looks: the base of glTF's metallic-roughness model.
#[derive(Debug, Clone)]
pub struct Material {
    /// Its name in the file, or `material N`.
    pub name: String,
    /// Linear RGB and alpha, multiplied with the texture and the vertex colour.
    pub base_color: Vec4,
    /// sRGB image; its transform is already applied to the mesh's texture coordinates.
    pub base_color_texture: Option<usize>,
    /// 0 mirror-like to 1 matt.
    pub roughness: f32,
    /// 0 or 1, or between for mixtures.
    pub metallic: f32,
    /// Linear radiance added regardless of light.
    pub emissive: Vec3,
    /// Drawn from both sides; else triangles seen from behind are culled.
    pub double_sided: bool,
    /// What alpha means.
    pub alpha: AlphaMode,
    /// Shown in its base colour, unlit (KHR_materials_unlit).
    pub unlit: bool,
    /// A mirror, where its surface is plane: `extras {"mirror": true, "reflectivity": 0.5, "tint": [1, 0.9, 0.8]}`,
    /// the last two as needed.
    pub mirror: Option<Reflective>,
    /// A receiver of planar shadows, where its surface is plane: `extras {"receiver": true}`.
    pub receiver: bool,
    /// Lies in the plane of other surfaces, and over them: `extras {"decal": true}`. It casts no shadow.
    pub decal: bool,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: "default".into(),
            base_color: Vec4::new(0.8, 0.8, 0.8, 1.0),
            base_color_texture: None,
            roughness: 1.0,
            metallic: 0.0,
            emissive: Vec3::ZERO,
            double_sided: false,
            alpha: AlphaMode::Opaque,
            unlit: false,
            mirror: None,
            receiver: false,
            decal: false,
        }
    }
}

/// What a material's alpha means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AlphaMode {
    /// Nothing.
    Opaque,
    /// Below the cutoff there is no surface.
    Mask(f32),
    /// How much of what lies behind is covered; drawn after the lit passes, casts no shadow.
    Blend,
}

/// A decoded image, 8 bits, sRGB, not premultiplied, rows from the top.
#[derive(Clone)]
pub struct Texture {
    /// Its name in the file, or `image N`.
    pub name: String,
    /// Pixels, at least 1.
    pub width: u32,
    /// Pixels, at least 1.
    pub height: u32,
    /// `width * height * 4` bytes.
    pub rgba: Vec<u8>,
    /// How coordinates outside 0..1 are read, u then v.
    pub wrap: [Wrap; 2],
    /// Blocky magnification, for pixel art.
    pub nearest: bool,
}

impl std::fmt::Debug for Texture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Texture({:?}, {} x {})", self.name, self.width, self.height)
    }
}

/// How texture coordinates outside 0..1 are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// Over and over.
    Repeat,
    /// Over and over, every other one mirrored.
    Mirror,
    /// The border goes on.
    Clamp,
}

/// The bones of a skinned mesh.
#[derive(Debug, Clone)]
pub struct Skin {
    /// Nodes, as the vertices' joint numbers count them.
    pub joints: Vec<usize>,
    /// `joint_from_object` in the bind pose, one per joint.
    pub inverse_bind: Vec<DAffine3>,
}

/// A light of KHR_lights_punctual, in its node's space: at the origin, looking along -Z.
#[derive(Debug, Clone, PartialEq)]
pub struct Light {
    /// Its name in the file, or `light N`.
    pub name: String,
    /// The node that places it.
    pub node: usize,
    /// Point, directional or spot.
    pub kind: LightKind,
    /// Linear RGB, largest component usually 1.
    pub color: Vec3,
    /// Candela for point and spot lights, lux for directional ones.
    pub intensity: f32,
    /// Metres after which the light ends; infinite allowed (and always so for directional lights).
    pub range: f32,
    /// What shines: a point, or something with a size. Directional lights are points.
    pub extent: Extent,
    /// What a spot projects: a texture of the scene, its lower edge down the node's Y, sRGB.
    pub slide: Option<usize>,
}

impl Default for Light {
    fn default() -> Self {
        Self {
            name: String::new(),
            node: 0,
            kind: LightKind::Point,
            color: Vec3::ONE,
            intensity: 1.0,
            range: f32::INFINITY,
            extent: Extent::Point,
            slide: None,
        }
    }
}

/// The three shapes of light glTF has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LightKind {
    /// Shines everywhere from its node's origin.
    Point,
    /// Shines along its node's -Z from infinitely far away.
    Directional,
    /// A cone about its node's -Z; half angles in radians, inner <= outer <= pi/2.
    Spot {
        /// Full light inside.
        inner: f32,
        /// No light outside.
        outer: f32,
    },
}

/// A perspective camera, looking along its node's -Z.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    /// Its name in the file, or `camera N`.
    pub name: String,
    /// The node that places it.
    pub node: usize,
    /// Full vertical angle of view, radians.
    pub vertical_fov: f64,
    /// Distance of the near plane, metres.
    pub near: f64,
    /// The point an orbiting camera turns about, as a distance along the view direction, metres.
    pub focus_distance: f64,
}

/// Light from everywhere, linear radiance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Environment {
    /// Ambient light on surfaces that look up.
    pub ambient_sky: Vec3,
    /// Ambient light on surfaces that look down.
    pub ambient_ground: Vec3,
    /// Where nothing is drawn, at the top of the view and at the bottom.
    pub background: [Vec3; 2],
}

impl Default for Environment {
    fn default() -> Self {
        Self {
            ambient_sky: Vec3::new(0.10, 0.11, 0.13),
            ambient_ground: Vec3::new(0.06, 0.05, 0.045),
            background: [Vec3::new(0.035, 0.045, 0.07), Vec3::new(0.09, 0.10, 0.12)],
        }
    }
}

impl Scene {
    /// The nodes that show a mesh, in order: the instances that [`crate::frame`] and the GPU number.
    pub fn instances(&self) -> impl Iterator<Item = (usize, &Node, &Mesh)> {
        self.nodes.iter().enumerate().filter_map(|(index, node)| node.mesh.map(|mesh| (index, node, &self.meshes[mesh])))
    }
}
