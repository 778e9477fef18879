//! The view from above (M image 4): where it stands, and what is cut away so that it sees the eye.
//!
//! ```text
//!          o  looks straight down, from so high that all casters, the eye and the lamps near them
//!         / \   are in the picture
//!        /   \
//!       /_____\ near plane: above everything, or where something covers the eye between the two
//!      /  ___  \
//!     / _/ | \_ \ roof: cut away
//!    /___|_o_|___\ eye
//! ```
//!
//! The near plane of a camera that looks straight down is level, so it cuts buildings as an architect's
//! plan does.

use glam::{DVec2, DVec3};

use crate::frame::Camera;
use crate::geometry::Aabb;
use crate::scene::{LightKind, Pose, Scene};

/// Full vertical angle, radians: narrow, so that walls look like walls in a plan.
const FIELD_OF_VIEW: f64 = 0.35;

/// Room about what is framed, as a share of it.
const MARGIN: f64 = 0.12;

/// How much larger the picture may become for the light's range.
const MOST: f64 = 1.5;

/// What covers the eye and is narrower than this share of the picture stays: it hides little.
const SMALL: f64 = 0.1;

/// How far up from the eye to what covers it the cut lies.
const CUT: f64 = 0.35;

/// The view from above.
#[derive(Debug, Clone, Copy)]
pub struct Above {
    /// Looks straight down; the picture's top is north (-z) or, for scenes longer that way, west (-x).
    pub camera: Camera,
    /// What it frames, world space: casters, the eye, the lamps near them.
    pub content: Aabb,
    /// The height above which everything is cut away, metres, where something covers the eye.
    pub cut: Option<f64>,
}

/// The view from above on `scene` as posed, looked at by `eye`; pictures have the eye's aspect. All that
/// `light` reaches is in the picture too, unless that is much more than the rest.
#[must_use]
pub fn above(scene: &Scene, pose: &Pose, eye: &Camera, light: usize) -> Above {
    let framed = content(scene, pose, eye.eye);
    let (mut min, mut max) = (framed.min.as_dvec3(), framed.max.as_dvec3());
    let level = DVec3::new(1.0, 0.0, 1.0);
    if let Some(light) = pose.lights.get(light).filter(|light| light.range.is_finite()) {
        let most = (max - min) * (MOST - 1.0) / 2.0 * level;
        (min, max) = (
            min.min((light.position - light.range * level).max(min - most)),
            max.max((light.position + light.range * level).min(max + most)),
        );
    }
    framing(scene, pose, eye, framed, [min, max])
}

/// The view from above on a scene and on where it is reflected: all of `rooms` is in the picture, as far as it is
/// not much farther away than the scene is large.
#[must_use]
pub fn above_rooms(scene: &Scene, pose: &Pose, eye: &Camera, rooms: &Aabb) -> Above {
    /// Times the scene's own size.
    const FARTHEST: f64 = 2.0;
    let content = content(scene, pose, eye.eye).union(&scene.bounds(pose));
    let (min, max) = (content.min.as_dvec3(), content.max.as_dvec3());
    let room = (max - min) * DVec3::new(FARTHEST, 0.0, FARTHEST);
    let [low, high] = [rooms.min.as_dvec3().max(min - room), rooms.max.as_dvec3().min(max + room)];
    framing(scene, pose, eye, content, [min.min(low), max.max(high)])
}

fn framing(scene: &Scene, pose: &Pose, eye: &Camera, content: Aabb, [min, max]: [DVec3; 2]) -> Above {
    let middle = (min + max) / 2.0;
    // Never flat: a scene may be a single point.
    let half = ((max - min) / 2.0 * (1.0 + MARGIN)).max(DVec3::splat(0.05));
    let slope = (FIELD_OF_VIEW / 2.0).tan();
    let height_for = |across: f64, upward: f64| (upward / slope).max(across / (slope * eye.aspect));
    let (north, west) = (height_for(half.x, half.z), height_for(half.z, half.x));
    // North is up, unless much more is seen the other way.
    let (up, height) = if west * 1.15 < north { (DVec3::NEG_X, west) } else { (DVec3::NEG_Z, north) };
    let place = DVec3::new(middle.x, max.y + height, middle.z);
    let cover = lowest_cover(scene, pose, eye.eye, half.max_element() * 2.0 * SMALL);
    let cut = cover.map(|cover| eye.eye.y + (cover - eye.eye.y) * CUT).filter(|cut| *cut < place.y);
    let least = height * 0.05;
    let camera = Camera {
        eye: place,
        forward: DVec3::NEG_Y,
        up,
        vertical_fov: FIELD_OF_VIEW,
        aspect: eye.aspect,
        near: cut.map_or(least, |cut| (place.y - cut).max(least)),
        far: None,
        focus_distance: place.y - middle.y,
        shift: DVec2::ZERO,
        mirrored: false,
    };
    Above { camera, content, cut }
}

/// Casters, or whatever there is where nothing casts; the eye; and the lamps that are not far from them.
pub(super) fn content(scene: &Scene, pose: &Pose, eye: DVec3) -> Aabb {
    let casters = scene.instances().filter(|(_, node, _)| node.casts_shadow);
    let mut bounds = casters.fold(Aabb::EMPTY, |all, (node, ..)| all.union(&pose.world_bounds(scene, node)));
    if bounds.is_empty() {
        bounds = scene.bounds(pose);
    }
    let near = f64::from(bounds.radius()) * 2.0;
    let middle = bounds.center().as_dvec3();
    let mut bounds = bounds.union(&Aabb::around(eye, eye));
    for light in pose.lights.iter().filter(|light| light.on && light.kind != LightKind::Directional) {
        if light.position.distance(middle) <= near {
            bounds = bounds.union(&Aabb::around(light.position, light.position));
        }
    }
    bounds
}

/// The height of the lowest surface straight above `eye` that belongs to something at least `width` metres
/// wide.
fn lowest_cover(scene: &Scene, pose: &Pose, eye: DVec3, width: f64) -> Option<f64> {
    let mut lowest: Option<f64> = None;
    for (node, _, mesh) in scene.instances() {
        let bounds = pose.world_bounds(scene, node);
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let over = min.x <= eye.x && eye.x <= max.x && min.z <= eye.z && eye.z <= max.z && max.y > eye.y;
        if !over || (max - min).x.max((max - min).z) < width {
            continue;
        }
        let object_from_world = pose.world_from_object[node].inverse();
        let (from, up) = (object_from_world.transform_point3(eye), object_from_world.transform_vector3(DVec3::Y));
        let positions = pose.positions(scene, node);
        for triangle in mesh.indices.as_chunks::<3>().0 {
            let [a, b, c] = triangle.map(|vertex| positions[vertex as usize].as_dvec3());
            if let Some(metres) = meets(from, up, a, b, c) {
                lowest = Some(lowest.map_or(eye.y + metres, |lowest| lowest.min(eye.y + metres)));
            }
        }
    }
    lowest
}

/// How many times `way` leads from `from` to the triangle; none where it does not meet it ahead (Moeller and
/// Trumbore 1997).
pub(super) fn meets(from: DVec3, way: DVec3, a: DVec3, b: DVec3, c: DVec3) -> Option<f64> {
    let normal = way.cross(c - a);
    let determinant = (b - a).dot(normal);
    let across = (from - a).cross(b - a);
    let (u, v, t) = ((from - a).dot(normal), way.dot(across), (c - a).dot(across));
    let [u, v, t] = [u, v, t].map(|value| value / determinant);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some(t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_meets_what_is_ahead_of_it_and_nothing_else() {
        let [a, b, c] = [DVec3::new(-1.0, 3.0, -1.0), DVec3::new(1.0, 3.0, -1.0), DVec3::new(0.0, 3.0, 2.0)];
        assert_eq!(meets(DVec3::Y, DVec3::Y, a, b, c), Some(2.0));
        assert_eq!(meets(DVec3::Y, DVec3::Y, a, c, b), Some(2.0), "from both sides");
        assert_eq!(meets(DVec3::Y * 4.0, DVec3::Y, a, b, c), None, "behind");
        assert_eq!(meets(DVec3::new(2.0, 0.0, 0.0), DVec3::Y, a, b, c), None, "beside");
        assert_eq!(meets(DVec3::ZERO, DVec3::X, a, b, c), None, "along");
    }
}
