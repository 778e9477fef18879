//! A floor beneath a scene that has none.

use glam::{DQuat, DVec3, Vec2, Vec3, Vec4};

use super::staging::{bounds, pose_at};
use crate::geometry::Aabb;
use crate::scene::mesh::MeshParts;
use crate::scene::{Material, Mesh, Node, Primitive, Scene, Texture, Transform, Wrap};

/// Adds a checkered floor just beneath everything, at any time of its animations, several times as
/// large. It catches shadows and casts none.
pub fn add_floor(scene: &mut Scene) {
    const TIMES: u32 = 12;
    let longest = scene.animations.iter().map(|animation| animation.duration).fold(0.0, f64::max);
    let times = if longest > 0.0 { TIMES } else { 1 };
    let mut all = Aabb::EMPTY;
    for step in 0..times {
        // A scene that came through the importer is within bounds at the start; later it may not be.
        if let Ok(bounds) = bounds(scene, &pose_at(scene, longest * f64::from(step) / f64::from(times))) {
            all = all.union(&bounds);
        }
    }
    let (center, half) = (all.center(), all.half_size());
    let radius = all.radius().max(1e-3);
    let size = 4.0 * half.x.max(half.z).max(0.6 * radius);
    let tiles = 2.0 * size / (0.35 * radius);
    let height = if all.is_empty() { 0.0 } else { all.min.y - 2e-3 * radius };

    let texture = scene.textures.len();
    scene.textures.push(checker());
    let material = scene.materials.len();
    scene.materials.push(Material {
        name: "floor".into(),
        base_color: Vec4::ONE,
        base_color_texture: Some(texture),
        roughness: 0.9,
        double_sided: true,
        ..Material::default()
    });
    let corners = [Vec2::new(-1.0, -1.0), Vec2::new(-1.0, 1.0), Vec2::new(1.0, 1.0), Vec2::new(1.0, -1.0)];
    let mesh = Mesh::new(MeshParts {
        name: "floor".into(),
        positions: corners.iter().map(|corner| Vec3::new(corner.x * size, 0.0, corner.y * size)).collect(),
        normals: Some(vec![Vec3::Y; 4]),
        // The texture is two tiles wide.
        uvs: Some(corners.iter().map(|corner| *corner * tiles / 4.0).collect()),
        indices: vec![0, 1, 2, 0, 2, 3],
        primitives: vec![Primitive { first_index: 0, index_count: 6, material, casts_shadow: true }],
        ..MeshParts::default()
    });
    // Four finite corners are a mesh; were they none, there would be no floor.
    let Ok(mesh) = mesh else { return };
    scene.meshes.push(mesh);
    let translation = Vec3::new(center.x, height, center.z).as_dvec3();
    scene.nodes.push(Node {
        name: "floor".into(),
        local: Transform::Trs { translation, rotation: DQuat::IDENTITY, scale: DVec3::ONE },
        mesh: Some(scene.meshes.len() - 1),
        casts_shadow: false,
        ..Node::default()
    });
}

/// Two by two tiles in soft colours, with darker joints.
fn checker() -> Texture {
    const SIDE: u32 = 256;
    let pixel = |at: u32| {
        let (x, y) = (at % SIDE, at / SIDE);
        let joint = |v: u32| v % (SIDE / 2) < 2;
        let light = (x / (SIDE / 2) + y / (SIDE / 2)).is_multiple_of(2);
        match (joint(x) || joint(y), light) {
            (true, _) => [150, 146, 140, 255],
            (_, true) => [214, 208, 198, 255],
            (_, false) => [178, 180, 184, 255],
        }
    };
    Texture {
        name: "floor".into(),
        width: SIDE,
        height: SIDE,
        rgba: (0..SIDE * SIDE).flat_map(pixel).collect(),
        wrap: [Wrap::Repeat; 2],
        nearest: false,
    }
}
