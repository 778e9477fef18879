//! Light from surfaces that glow, for files that have no lights: a lamp's glass, the panel in the
//! ceiling of a Cornell box.
//!
//! A small surface of radiance L and area A shines along its normal with L * A candela. A few small
//! glowing surfaces become point lights just before them; a scene of which everything glows, or a sky
//! around it, does not. The surface itself then casts no shadow: its own light would be shut in.

use glam::{DQuat, DVec3, Vec3};

use super::error::{Warnings, clip};
use crate::scene::{Light, LightKind, Node, Pose, Scene, Transform};

/// More of them are a pattern, not lamps.
const MOST: usize = 4;
/// A lamp is small beside the scene: its radius to the scene's.
const LARGEST: f64 = 0.3;

struct Glow {
    node: usize,
    name: String,
    position: DVec3,
    /// Watts' worth: linear RGB radiance times area.
    power: Vec3,
}

/// Adds lights for the glowing surfaces of `scene`; whether there were any.
pub(super) fn add(scene: &mut Scene, pose: &Pose, radius: f64, warnings: &mut Warnings) -> bool {
    let glows: Vec<Glow> = scene.instances().filter_map(|(node, _, _)| glow(scene, pose, node)).take(MOST + 1).collect();
    let small = |glow: &Glow| f64::from(pose.world_bounds(scene, glow.node).radius()) < LARGEST * radius;
    if glows.is_empty() || glows.len() > MOST || !glows.iter().all(small) {
        return false;
    }
    for glow in glows {
        warnings.push(format!("the file has no lights; {:?} glows, and a light before it shines in its place", clip(&glow.name)));
        scene.nodes[glow.node].casts_shadow = false;
        let brightest = glow.power.max_element();
        let local = Transform::Trs { translation: glow.position, rotation: DQuat::IDENTITY, scale: DVec3::ONE };
        scene.nodes.push(Node { name: glow.name.clone(), local, ..Node::default() });
        scene.lights.push(Light {
            name: glow.name,
            node: scene.nodes.len() - 1,
            kind: LightKind::Point,
            color: glow.power / brightest,
            intensity: brightest,
            range: f32::INFINITY,
            ..Light::default()
        });
    }
    true
}

/// What glows of the mesh that `node` shows.
fn glow(scene: &Scene, pose: &Pose, node: usize) -> Option<Glow> {
    let mesh = &scene.meshes[scene.nodes[node].mesh?];
    let (positions, world_from_object) = (pose.positions(scene, node), &pose.world_from_object[node]);
    let (mut power, mut area, mut normal, mut middle) = (DVec3::ZERO, 0.0, DVec3::ZERO, DVec3::ZERO);
    for primitive in &mesh.primitives {
        let emissive = scene.materials[primitive.material].emissive.as_dvec3();
        if emissive == DVec3::ZERO {
            continue;
        }
        let range = primitive.first_index as usize..(primitive.first_index + primitive.index_count) as usize;
        for triangle in mesh.indices[range].as_chunks::<3>().0 {
            let [a, b, c] = triangle.map(|vertex| world_from_object.transform_point3(positions[vertex as usize].as_dvec3()));
            let twice = (b - a).cross(c - a);
            let size = 0.5 * twice.length();
            power += emissive * size;
            area += size;
            normal += 0.5 * twice;
            middle += (a + b + c) / 3.0 * size;
        }
    }
    let power = power.as_vec3();
    if area <= 0.0 || !power.is_finite() || power.max_element() <= 0.0 {
        return None;
    }
    // Before a panel; in the middle of a bulb, whose normals cancel out.
    let before = normal / area * 0.05 * f64::from(pose.world_bounds(scene, node).radius());
    Some(Glow { node, name: scene.nodes[node].name.clone(), position: middle / area + before, power })
}
