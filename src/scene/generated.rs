//! Scenes of any size, made to see how cost grows with one thing while all else stays: boxes on a floor, ever more
//! and ever smaller, so that their shadows cover as much as before; a knot of ever more triangles; the same boxes
//! in ever more lights.

use std::f32::consts::TAU;

use glam::{DAffine3, DMat3, DVec3, Vec3};

use super::{AnimationChoice, Camera, Light, Material, Mesh, MeshParts, Node, Primitive, Scene, Transform};
use crate::frame::camera::DEFAULT_NEAR;

/// Metres: half the side of what the boxes stand on.
const HALF: f32 = 6.0;
/// The part of the distance between boxes that a box takes, where they stand as far apart in both directions.
const FILLED: f32 = 0.5;

/// So many boxes on a floor, in one light. They cover a quarter of it, however many there are.
#[must_use]
pub fn casters(count: u32) -> Scene {
    let mut scene = floor(format!("{count} casters"));
    stand_boxes(&mut scene, count);
    light(&mut scene, DVec3::new(-4.0, 9.0, 5.0), 260.0);
    scene
}

/// One knot of `2^doublings` times [`FEWEST_TRIANGLES`] triangles over a floor, in one light.
#[must_use]
pub fn triangles(doublings: u32) -> Scene {
    // Rings and sides are doubled in turn.
    let (rings, sides) = (64 << doublings.div_ceil(2), 8 << (doublings / 2));
    let mut scene = floor(format!("{} triangles", FEWEST_TRIANGLES << doublings));
    let (positions, indices) = knot(rings, sides);
    let mesh = add_mesh(&mut scene, "knot", positions, indices, [0.62, 0.20, 0.08]);
    let place = DAffine3::from_rotation_translation(glam::DQuat::from_rotation_x(0.5), DVec3::new(0.0, 2.6, 0.0));
    add_node(&mut scene, "knot", Some(mesh), place);
    light(&mut scene, DVec3::new(-4.0, 9.0, 5.0), 260.0);
    scene
}

/// Of the smallest [`triangles`].
pub const FEWEST_TRIANGLES: u64 = 1024;

/// 25 boxes on a floor, in so many lights around them, which shine as much together as one.
#[must_use]
pub fn lights(count: u32) -> Scene {
    let mut scene = floor(format!("{count} lights"));
    stand_boxes(&mut scene, 25);
    for number in 0..count {
        let (sin, cos) = (f64::from(number) / f64::from(count) * std::f64::consts::TAU + 2.2).sin_cos();
        #[expect(clippy::cast_precision_loss, reason = "few lights")]
        light(&mut scene, DVec3::new(cos * 6.5, 9.0, sin * 6.5), 260.0 / count as f32);
    }
    scene
}

/// Positions and indices of a trefoil's tube, closed and outward, of `2 * rings * sides` triangles, some six metres
/// across.
#[must_use]
pub fn knot(rings: u32, sides: u32) -> (Vec<Vec3>, Vec<u32>) {
    let curve = |turn: f32| {
        let out = 2.0 + (3.0 * turn).cos();
        Vec3::new(out * (2.0 * turn).cos(), (3.0 * turn).sin(), out * (2.0 * turn).sin())
    };
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    #[expect(clippy::cast_precision_loss, reason = "far fewer than 2^24")]
    let turn = |step: u32, steps: u32| step as f32 / steps as f32 * TAU;
    for ring in 0..rings {
        let at = curve(turn(ring, rings));
        let along = (curve(turn(ring, rings) + 1e-3) - at).normalize();
        let across = along.cross(at).normalize();
        let up = across.cross(along);
        for side in 0..sides {
            let (sin, cos) = turn(side, sides).sin_cos();
            positions.push(at + (across * cos + up * sin) * 0.4);
            let vertex = |ring: u32, side: u32| ring % rings * sides + side % sides;
            let (a, b) = (vertex(ring, side), vertex(ring + 1, side));
            let (c, d) = (vertex(ring + 1, side + 1), vertex(ring, side + 1));
            indices.extend([a, c, d, a, b, c]);
        }
    }
    (positions, indices)
}

/// A floor that casts nothing, and a camera that has all of it in view.
fn floor(name: String) -> Scene {
    let mut scene = Scene { name, exposure: 1.0, default_animation: AnimationChoice::Still, ..Scene::default() };
    let side = HALF * 1.5;
    let corners = [[-side, -side], [-side, side], [side, side], [side, -side]].map(|[x, z]| Vec3::new(x, 0.0, z));
    let mesh = add_mesh(&mut scene, "floor", corners.into(), vec![0, 1, 2, 0, 2, 3], [0.55, 0.55, 0.52]);
    let node = add_node(&mut scene, "floor", Some(mesh), DAffine3::IDENTITY);
    scene.nodes[node].casts_shadow = false;
    let (eye, target) = (DVec3::new(0.0, 10.0, 15.0), DVec3::new(0.0, 0.5, 0.5));
    let back = (eye - target).normalize();
    let right = DVec3::Y.cross(back).normalize();
    let world_from_camera = DAffine3::from_mat3_translation(DMat3::from_cols(right, back.cross(right), back), eye);
    let node = add_node(&mut scene, "camera", None, world_from_camera);
    scene.cameras.push(Camera {
        name: "over the floor".into(),
        node,
        vertical_fov: 0.8,
        near: DEFAULT_NEAR,
        focus_distance: eye.distance(target),
    });
    scene
}

/// So many boxes, row by row.
fn stand_boxes(scene: &mut Scene, count: u32) {
    let corners: Vec<_> = (0..8u8).map(|i| [0, 1, 2].map(|axis| f32::from(i >> axis & 1) - 0.5)).map(Vec3::from).collect();
    let quads: [[u32; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let indices = quads.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]).collect();
    let mesh = add_mesh(scene, "box", corners, indices, [0.14, 0.36, 0.52]);
    let columns = count.max(1).isqrt() + u32::from(count.isqrt().pow(2) < count);
    let rows = count.div_ceil(columns).max(1);
    let pitch = [columns, rows].map(|boxes| f64::from(HALF) * 2.0 / f64::from(boxes));
    let side = (pitch[0] * pitch[1]).sqrt() * f64::from(FILLED);
    for number in 0..count {
        let place = |step: u32, axis: usize| (f64::from(step) + 0.5) * pitch[axis] - f64::from(HALF);
        let [x, z] = [place(number % columns, 0), place(number / columns, 1)];
        let place = DAffine3::from_scale(DVec3::splat(side));
        let place = DAffine3::from_translation(DVec3::new(x, side * 0.75, z)) * place;
        add_node(scene, &format!("box {number}"), Some(mesh), place);
    }
}

fn light(scene: &mut Scene, at: DVec3, candela: f32) {
    let name = format!("light {}", scene.lights.len());
    let node = add_node(scene, &name, None, DAffine3::from_translation(at));
    scene.lights.push(Light { name, node, intensity: candela, ..Light::default() });
}

fn add_node(scene: &mut Scene, name: &str, mesh: Option<usize>, world_from_node: DAffine3) -> usize {
    scene.nodes.push(Node { name: name.into(), mesh, local: Transform::Affine(world_from_node), ..Node::default() });
    scene.nodes.len() - 1
}

/// A mesh in one colour.
fn add_mesh(scene: &mut Scene, name: &str, positions: Vec<Vec3>, indices: Vec<u32>, color: [f32; 3]) -> usize {
    let material = scene.materials.len();
    let base_color = Vec3::from(color).extend(1.0);
    scene.materials.push(Material { name: name.into(), base_color, ..Material::default() });
    let index_count = u32::try_from(indices.len()).unwrap_or(u32::MAX);
    let primitive = Primitive { first_index: 0, index_count, material, casts_shadow: true };
    let parts = MeshParts { name: name.into(), positions, indices, primitives: vec![primitive], ..MeshParts::default() };
    match Mesh::new(parts) {
        Ok(mesh) => scene.meshes.push(mesh),
        Err(error) => scene.warnings.push(format!("the mesh {name:?} cannot be made: {error}")),
    }
    scene.meshes.len() - 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_have_as_much_as_is_asked_for_and_are_closed() {
        let shown = |scene: &Scene| scene.instances().filter(|(_, node, _)| node.casts_shadow).count();
        for (scene, casters, lights) in [(casters(7), 7, 1), (lights(5), 25, 5), (triangles(3), 1, 1)] {
            assert_eq!((shown(&scene), scene.lights.len(), scene.warnings.len()), (casters, lights, 0), "{}", scene.name);
            let solid = |node: &Node, mesh: &Mesh| !node.casts_shadow || mesh.topology.report().is_solid();
            assert!(scene.instances().all(|(_, node, mesh)| solid(node, mesh)), "{}", scene.name);
        }
        for doublings in 0..5 {
            let scene = triangles(doublings);
            let count = scene.meshes.iter().map(|mesh| mesh.topology.report().triangles).max();
            assert_eq!(count, Some((FEWEST_TRIANGLES as usize) << doublings));
        }
    }
}
