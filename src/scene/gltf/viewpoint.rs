//! From where a scene without cameras is seen first.
//!
//! From the front right and above, as one looks at a thing on a table; but into a room, that shows its
//! outside. So where the scene is small enough to ask, sight lines to some of its surfaces are tried, and
//! straight from the front wins where it shows clearly more.

use glam::{DVec3, Vec3};

use crate::scene::{Pose, Scene};

/// Seen from the middle of the scene.
const ABOVE_RIGHT: DVec3 = DVec3::new(0.55, 0.42, 1.0);
const FRONT: DVec3 = DVec3::new(0.0, 0.02, 1.0);
/// Every sight line is tried against every triangle: this many at most, and so many lines.
const MOST_TRIANGLES: usize = 20_000;
const SIGHT_LINES: usize = 128;
/// How much more the front has to show.
const CLEARLY: f64 = 1.4;

struct Triangle {
    corners: [Vec3; 3],
    double_sided: bool,
}

/// The eye that sees more, of those that `place` gives for a direction from the scene's middle.
pub(super) fn choose(scene: &Scene, pose: &Pose, place: impl Fn(DVec3) -> DVec3) -> DVec3 {
    let (above_right, front) = (place(ABOVE_RIGHT.normalize()), place(FRONT.normalize()));
    let total: usize = scene.instances().map(|(_, _, mesh)| mesh.indices.len() / 3).sum();
    if total > MOST_TRIANGLES {
        return above_right;
    }
    let triangles = triangles(scene, pose);
    let (from_above, from_front) = (seen(&triangles, above_right.as_vec3()), seen(&triangles, front.as_vec3()));
    if from_front as f64 > CLEARLY * from_above as f64 { front } else { above_right }
}

fn triangles(scene: &Scene, pose: &Pose) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    for (node, _, mesh) in scene.instances() {
        let (positions, world_from_object) = (pose.positions(scene, node), &pose.world_from_object[node]);
        let mirrored = world_from_object.matrix3.determinant() < 0.0;
        for primitive in &mesh.primitives {
            let double_sided = scene.materials[primitive.material].double_sided;
            let range = primitive.first_index as usize..(primitive.first_index + primitive.index_count) as usize;
            for triangle in mesh.indices[range].as_chunks::<3>().0 {
                let place = |vertex: u32| world_from_object.transform_point3(positions[vertex as usize].as_dvec3()).as_vec3();
                let mut corners = triangle.map(place);
                if mirrored {
                    corners.swap(1, 2);
                }
                triangles.push(Triangle { corners, double_sided });
            }
        }
    }
    triangles
}

/// How many of the sampled triangles' middles `eye` sees, from their front: who sees the back of a
/// double-sided wall stands on its wrong side.
fn seen(triangles: &[Triangle], eye: Vec3) -> usize {
    let step = triangles.len().div_ceil(SIGHT_LINES).max(1);
    let visible = |(index, target): &(usize, &Triangle)| {
        let middle = target.corners.iter().sum::<Vec3>() / 3.0;
        let blocks = |(other, triangle): (usize, &Triangle)| other != *index && triangle.is_hit(eye, middle - eye);
        target.faces(middle - eye) && !triangles.iter().enumerate().any(blocks)
    };
    triangles.iter().enumerate().step_by(step).filter(visible).count()
}

impl Triangle {
    /// Shows its front to who looks along `direction`.
    fn faces(&self, direction: Vec3) -> bool {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a).dot(direction) < 0.0
    }

    /// Lies before the end of `direction`, seen from `eye` (Moeller and Trumbore).
    fn is_hit(&self, eye: Vec3, direction: Vec3) -> bool {
        if !(self.double_sided || self.faces(direction)) {
            return false;
        }
        let [a, b, c] = self.corners;
        let (ab, ac) = (b - a, c - a);
        let across = direction.cross(ac);
        let inverse = 1.0 / ab.dot(across);
        let from_a = eye - a;
        let u = from_a.dot(across) * inverse;
        let around = from_a.cross(ab);
        let v = direction.dot(around) * inverse;
        let along = ac.dot(around) * inverse;
        u >= 0.0 && v >= 0.0 && u + v <= 1.0 && along > 0.0 && along < 0.999
    }
}
