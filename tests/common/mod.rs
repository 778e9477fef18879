//! What the rendering tests share: a device, tiny scenes made by hand, frames drawn and read back.
#![allow(
    dead_code,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "each test binary uses a part; tests fail by panicking"
)]

pub mod strategies;

use glam::{DAffine3, DQuat, DVec3, Vec2, Vec3};
use obscura::director;
use obscura::frame::FramePlan;
use obscura::gpu::{Context, FrameStats, Renderer, readback};
use obscura::headless::verify::{Kept, verify_view};
use obscura::scene::mesh::MeshParts;
use obscura::scene::{Camera, Light, LightKind, Material, Mesh, Node, Pose, Primitive, Scene, Transform};
use obscura::settings::{CameraChoice, Settings, Show};
use obscura::truth::Comparison;

/// A device and what is drawn on it.
pub struct Stage {
    pub context: Context,
    pub renderer: Renderer,
}

/// One drawn frame.
pub struct Shot {
    pub plan: FramePlan,
    pub pose: Pose,
    pub stats: FrameStats,
    pub image: image::RgbaImage,
}

impl Stage {
    /// Tests need a device: `./check` installs a software one.
    pub fn new() -> Self {
        let context = Context::headless(None).expect("a Vulkan device (./check installs lavapipe)");
        let renderer = Renderer::new(&context, None).expect("the embedded shaders compile");
        Self { context, renderer }
    }

    pub fn set_scene(&mut self, scene: &Scene) {
        self.renderer.set_scene(&self.context, scene).expect("the scene fits");
    }

    /// Draws the scene that was set last.
    pub fn shoot(&mut self, settings: &Settings, scene: &Scene) -> Shot {
        let (pose, plan) = director::stage(settings, scene, self.context.capabilities()).expect("the settings fit the scene");
        let (stats, image) =
            readback::picture(&self.context, &mut self.renderer, &plan, scene, &pose).expect("the frame is drawn");
        Shot { plan, pose, stats, image }
    }

    /// Holds every light's `show shadow` of the scene that was set last, drawn by the settings'
    /// technique, against exact rays.
    pub fn verify(&mut self, settings: &Settings, scene: &Scene) -> Vec<Comparison> {
        let lights: Vec<_> = (0..scene.lights_in_force(&settings.mirrors)).collect();
        let device = (&self.context, &mut self.renderer);
        let view = verify_view(device, scene, settings, &[settings.technique], &lights, &mut Kept::default()).unwrap();
        assert_eq!(view.judged.first_wrong, None, "{} pixels show another surface", view.judged.surfaces.pixels.len());
        view.judged.found.into_iter().map(|(.., comparison)| comparison).collect()
    }

    /// The stencil after the last frame, rows from the top.
    pub fn stencil(&self) -> Vec<u8> {
        readback::stencil(&self.context, &self.renderer).expect("the stencil comes back")
    }
}

/// Draws the scene by the settings' technique and asserts that every decided pixel of every light is
/// what exact rays say; gives the comparisons, one a light. Decided pixels must be many, lit and
/// shadowed ones among them, or the view says little.
pub fn assert_exact(scene: &Scene, settings: &Settings) -> Vec<Comparison> {
    let mut stage = Stage::new();
    stage.set_scene(scene);
    let found = stage.verify(settings, scene);
    for (light, comparison) in found.iter().enumerate() {
        let command = obscura::cli::render_command(&Settings { show: Show::Shadow, light, ..settings.clone() });
        assert_eq!(comparison.wrong(), 0, "the first of {comparison:.4?}; {command}", comparison = comparison.pixels);
        assert!(comparison.decided * 2 > comparison.edges, "{} edges, {} decided", comparison.edges, comparison.decided);
    }
    assert!(found.iter().any(|comparison| comparison.lit > 0) && found.iter().any(|comparison| comparison.shadow > 0));
    found
}

/// A mesh with flat normals from positions and triangles.
pub fn mesh(name: &str, positions: &[[f32; 3]], triangles: &[[u32; 3]], material: usize) -> Mesh {
    let indices = triangles.concat();
    let count = u32::try_from(indices.len()).unwrap();
    Mesh::new(MeshParts {
        name: name.into(),
        positions: positions.iter().map(|&p| Vec3::from(p)).collect(),
        normals: None,
        uvs: Some(vec![Vec2::ZERO; positions.len()]),
        colors: None,
        indices,
        primitives: vec![Primitive { first_index: 0, index_count: count, material, casts_shadow: true }],
        skin: Vec::new(),
        morphs: Vec::new(),
        morph_weights: Vec::new(),
    })
    .unwrap()
}

/// A closed cube of side 2 about the origin.
pub fn cube(material: usize) -> Mesh {
    let corners: Vec<[f32; 3]> = (0..8u8).map(|i| [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 1.0 } else { -1.0 })).collect();
    let quads: [[u32; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles: Vec<[u32; 3]> = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    mesh("cube", &corners, &triangles, material)
}

/// A square of side 2 in the plane y = 0, looking up.
pub fn square(material: usize) -> Mesh {
    mesh("square", &[[-1.0, 0.0, -1.0], [-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0]], &[[0, 1, 2], [0, 2, 3]], material)
}

/// A scene in the making: one material for solids (0) and one drawn from both sides (1).
pub struct Build(pub Scene);

impl Build {
    pub fn new() -> Self {
        let both_sides = Material { name: "both sides".into(), double_sided: true, ..Material::default() };
        let mut scene = Scene { name: "test".into(), exposure: 1.0, ..Scene::default() };
        scene.materials = vec![Material::default(), both_sides];
        Self(scene)
    }

    pub fn mesh(&mut self, mesh: Mesh) -> usize {
        self.0.meshes.push(mesh);
        self.0.meshes.len() - 1
    }

    /// An instance of a mesh; returns its node.
    pub fn place(&mut self, mesh: usize, at: DVec3, scale: DVec3) -> usize {
        self.node(Some(mesh), Transform::Trs { translation: at, rotation: DQuat::IDENTITY, scale })
    }

    /// A surface that receives shadows and casts none.
    pub fn floor(&mut self, y: f64, half_side: f64) {
        let square = self.mesh(square(0));
        let node = self.place(square, DVec3::new(0.0, y, 0.0), DVec3::new(half_side, 1.0, half_side));
        self.0.nodes[node].casts_shadow = false;
    }

    pub fn point_light(&mut self, at: DVec3) -> usize {
        self.light(LightKind::Point, at, DVec3::NEG_Y, 100.0)
    }

    pub fn light(&mut self, kind: LightKind, at: DVec3, towards: DVec3, intensity: f32) -> usize {
        let rotation = DQuat::from_rotation_arc(DVec3::NEG_Z, towards.normalize());
        let node = self.node(None, Transform::Affine(DAffine3::from_rotation_translation(rotation, at)));
        let name = format!("light {}", self.0.lights.len());
        self.0.lights.push(Light { name, node, kind, color: Vec3::ONE, intensity, ..Light::default() });
        self.0.lights.len() - 1
    }

    pub fn camera(&mut self, eye: DVec3, target: DVec3) {
        let forward = (target - eye).normalize();
        let right = forward.cross(DVec3::Y).normalize();
        let world_from_node = DAffine3::from_cols(right, right.cross(forward), -forward, eye);
        let node = self.node(None, Transform::Affine(world_from_node));
        self.0.cameras.push(Camera {
            name: format!("camera {}", self.0.cameras.len()),
            node,
            vertical_fov: 1.0,
            near: 0.1,
            focus_distance: eye.distance(target),
        });
    }

    fn node(&mut self, mesh: Option<usize>, local: Transform) -> usize {
        let name = format!("node {}", self.0.nodes.len());
        self.0.nodes.push(Node { name, mesh, local, ..Node::default() });
        self.0.nodes.len() - 1
    }
}

/// Settings for a small picture seen from `eye`.
pub fn seen_from(eye: DVec3, target: DVec3, size: [u32; 2]) -> Settings {
    Settings { camera: CameraChoice::Free { eye, target }, size, ..Settings::default() }
}
