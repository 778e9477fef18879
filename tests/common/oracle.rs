//! What a pixel's count must be, by rays in f64 over every triangle: for tiny scenes only.
//!
//! A pixel is decided when rays through its centre and four points a quarter pixel around it meet
//! the same instance and find the same count, and the count stays when the light moves by a
//! millionth of the scene's size, so that no surface that the light merely grazes is asked about;
//! only decided pixels are compared.

use glam::DVec3;
use obscura::frame::Camera;
use obscura::scene::{AlphaMode, LightKind, Pose, Scene};

/// The count of each pixel: none where there is no surface or the pixel is an edge.
pub fn counts(scene: &Scene, pose: &Pose, camera: &Camera, light: usize, [width, height]: [u32; 2]) -> Vec<Option<u8>> {
    let triangles = triangles(scene, pose);
    let nudge = 1e-6 * f64::from(scene.bounds(pose).radius());
    let nudged = [DVec3::ONE, DVec3::NEG_ONE, DVec3::new(1.0, -1.0, 1.0), DVec3::new(-1.0, 1.0, -1.0)].map(|by| {
        let mut moved = pose.clone();
        moved.lights[light].position += by * nudge;
        moved.lights[light].direction = (moved.lights[light].direction + by * 1e-6).normalize();
        moved
    });
    let mut counts = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let at = |dx: f64, dy: f64| {
                let point = ((f64::from(x) + 0.5 + dx) / f64::from(width), (f64::from(y) + 0.5 + dy) / f64::from(height));
                count_at(&triangles, pose, camera, light, point)
            };
            let center = at(0.0, 0.0);
            let agree = [(-0.25, -0.25), (0.25, -0.25), (-0.25, 0.25), (0.25, 0.25)].iter().all(|&(dx, dy)| at(dx, dy) == center);
            let steady = || {
                nudged.iter().all(|moved| {
                    let point = ((f64::from(x) + 0.5) / f64::from(width), (f64::from(y) + 0.5) / f64::from(height));
                    count_at(&triangles, moved, camera, light, point) == center
                })
            };
            counts.push(center.filter(|_| agree && steady()).map(|(_, count)| count));
        }
    }
    counts
}

struct Triangle {
    corners: [DVec3; 3],
    instance: usize,
    casts: bool,
    /// Of a solid: it counts only when it faces the light.
    solid: bool,
    double_sided: bool,
    mirrored: bool,
}

fn triangles(scene: &Scene, pose: &Pose) -> Vec<Triangle> {
    let mut all = Vec::new();
    for (instance, (node_index, node, mesh)) in scene.instances().enumerate() {
        let world_from_object = pose.world_from_object[node_index];
        let positions = pose.positions(scene, node_index);
        for primitive in &mesh.primitives {
            let material = &scene.materials[primitive.material];
            assert_eq!(material.alpha, AlphaMode::Opaque, "the oracle knows opaque surfaces only");
            let range = primitive.first_index as usize..(primitive.first_index + primitive.index_count) as usize;
            for corners in mesh.indices[range].chunks_exact(3) {
                let corner = |i: usize| world_from_object.transform_point3(positions[corners[i] as usize].as_dvec3());
                all.push(Triangle {
                    corners: [corner(0), corner(1), corner(2)],
                    instance,
                    casts: node.casts_shadow && primitive.casts_shadow,
                    solid: mesh.topology.report().is_solid(),
                    double_sided: material.double_sided,
                    mirrored: world_from_object.matrix3.determinant() < 0.0,
                });
            }
        }
    }
    all
}

/// Distance along the ray in units of `direction`, and whether the front is seen.
fn meet(triangle: &Triangle, origin: DVec3, direction: DVec3) -> Option<(f64, bool)> {
    let [a, b, c] = triangle.corners;
    let (ab, ac) = (b - a, c - a);
    let p = direction.cross(ac);
    let determinant = ab.dot(p);
    if determinant == 0.0 {
        return None;
    }
    let s = origin - a;
    let u = s.dot(p) / determinant;
    let q = s.cross(ab);
    let v = direction.dot(q) / determinant;
    let distance = ac.dot(q) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then_some((distance, (determinant > 0.0) != triangle.mirrored))
}

fn count_at(triangles: &[Triangle], pose: &Pose, camera: &Camera, light: usize, (x, y): (f64, f64)) -> Option<(usize, u8)> {
    let half_height = (camera.vertical_fov / 2.0).tan();
    let right = camera.forward.cross(camera.up);
    let direction =
        camera.forward + right * ((2.0 * x - 1.0) * half_height * camera.aspect) + camera.up * ((1.0 - 2.0 * y) * half_height);
    let mut nearest: Option<(f64, usize)> = None;
    for triangle in triangles {
        if let Some((distance, front)) = meet(triangle, camera.eye, direction)
            && distance > camera.near
            && (front || triangle.double_sided)
            && nearest.is_none_or(|(best, _)| distance < best)
        {
            nearest = Some((distance, triangle.instance));
        }
    }
    let (distance, instance) = nearest?;
    // A hair before the surface, on the side that is seen: the dark side of a sheet is in its shadow.
    Some((instance, count(triangles, pose, light, camera.eye + direction * (distance * (1.0 - 1e-7)))))
}

fn count(triangles: &[Triangle], pose: &Pose, light: usize, point: DVec3) -> u8 {
    let light = &pose.lights[light];
    let (toward, length) = match light.kind {
        LightKind::Directional => (-light.direction, f64::INFINITY),
        _ => (light.position - point, 1.0),
    };
    let mut count = 0u8;
    for triangle in triangles.iter().filter(|triangle| triangle.casts) {
        if let Some((distance, front)) = meet(triangle, point, toward)
            && distance > 0.0
            && distance < length
            // From the surface towards the light, a light-facing triangle is seen from behind.
            && (!front || !triangle.solid)
        {
            count = count.wrapping_add(1);
        }
    }
    count
}
