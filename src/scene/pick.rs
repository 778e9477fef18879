//! Which surface lies under a place of the picture, for clicks on it.

use glam::DVec3;

use super::{Pose, Scene};
use crate::settings::SurfacePlace;

/// The surface that a ray from `eye` meets first, not before `nearest` times `direction` (world space): from the
/// front, or from behind where its material shows that. Holes of masks are closed to it.
#[must_use]
pub fn surface_at(scene: &Scene, pose: &Pose, eye: DVec3, direction: DVec3, nearest: f64) -> Option<SurfacePlace> {
    let mut found = None;
    let mut farthest = f64::INFINITY;
    for (node, _, mesh) in scene.instances() {
        let Some(world_from_object) = pose.world_from_object.get(node) else { continue };
        let object_from_world = world_from_object.inverse();
        let (from, way) = (object_from_world.transform_point3(eye), object_from_world.transform_vector3(direction));
        if !pose.bounds(scene, node).meets_segment(from, way, farthest) {
            continue;
        }
        let positions = pose.positions(scene, node);
        for (primitive, run) in mesh.primitives.iter().enumerate() {
            let both_sides = scene.materials.get(run.material).is_some_and(|material| material.double_sided);
            for corners in mesh.triangles(primitive) {
                let corners = corners.map(|vertex| positions[vertex as usize].as_dvec3());
                if let Some(at) = crossing(from, way, corners, both_sides).filter(|at| (nearest..farthest).contains(at)) {
                    farthest = at;
                    found = Some(SurfacePlace { node, primitive });
                }
            }
        }
    }
    found
}

/// How many times `way` from `from` a triangle lies (Möller and Trumbore 1997). An object's front is its front
/// whatever its node mirrors.
fn crossing(from: DVec3, way: DVec3, [a, b, c]: [DVec3; 3], both_sides: bool) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let across = way.cross(ac);
    let facing = ab.dot(across);
    if facing == 0.0 || (facing < 0.0 && !both_sides) {
        return None;
    }
    let to = from - a;
    let along = to.cross(ab);
    let (u, v) = (to.dot(across) / facing, way.dot(along) / facing);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| ac.dot(along) / facing)
}
