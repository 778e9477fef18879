//! What a scene needs to be seen and a file may leave out: light, a camera, an exposure.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};

use super::error::{Problem, Warnings, clip};
use super::{lamps, viewpoint};
use crate::geometry::Aabb;
use crate::scene::{Camera, Environment, Light, LightKind, Node, Pose, Scene, Transform, pose};

/// Metres from the origin, and in size: beyond, single-precision arithmetic on squares of lengths ends.
const FARTHEST: f64 = 1e12;
/// Where the scene is lit from, seen from its middle.
const KEY_SIDE: DVec3 = DVec3::new(-0.8, 1.0, 0.65);
const FILL_SIDE: DVec3 = DVec3::new(0.8, 0.5, 0.7);
/// The irradiance that looks well lit at exposure 1: a white surface then shines with 0.8 of white.
const GOOD_IRRADIANCE: f64 = 0.8 * PI;
/// An exposure beyond these is a mistake in the file, not a bright lamp.
const EXPOSURES: (f64, f64) = (1e-8, 1e6);

/// Fills in what is missing. `heights` are what orthographic cameras see, half.
pub(super) fn complete(scene: &mut Scene, heights: &[Option<f64>], warnings: &mut Warnings) -> Result<(), Problem> {
    let mut posed = pose_at(scene, 0.0);
    let bounds = bounds(scene, &posed)?;
    let (center, radius) = (bounds.center().as_dvec3(), f64::from(bounds.radius()).max(1e-3));
    if scene.lights.is_empty() && lamps::add(scene, &posed, radius, warnings) {
        posed = pose_at(scene, 0.0);
    }
    if scene.lights.is_empty() {
        add_lights(scene, center, radius);
        scene.exposure = 1.0;
    } else {
        scene.exposure = exposure(scene, &posed) as f32;
        let scale = 1.0 / scene.exposure;
        let environment = Environment::default();
        scene.environment = Environment {
            ambient_sky: environment.ambient_sky * scale,
            ambient_ground: environment.ambient_ground * scale,
            background: environment.background.map(|color| color * scale),
        };
    }
    if scene.cameras.is_empty() {
        add_camera(scene, &posed, &bounds, center, radius);
    }
    for (camera, height) in scene.cameras.iter_mut().zip(heights) {
        let Some(world_from_node) = posed.world_from_node.get(camera.node) else { continue };
        let to_center = center - world_from_node.translation;
        let forward = world_from_node.transform_vector3(DVec3::NEG_Z).normalize_or_zero();
        let along = to_center.dot(forward);
        camera.focus_distance = if along > camera.near { along } else { to_center.length().max(radius).max(2.0 * camera.near) };
        if let Some(height) = height {
            camera.vertical_fov = (2.0 * (height / camera.focus_distance).atan()).clamp(5f64.to_radians(), 100f64.to_radians());
        }
    }
    Ok(())
}

/// As the scene shows itself first.
pub(super) fn pose_at(scene: &Scene, time: f64) -> Pose {
    pose::pose(scene, time, scene.default_animation, &BTreeMap::new())
}

/// The box around everything shown, world space; an error where something is nowhere.
pub(super) fn bounds(scene: &Scene, pose: &Pose) -> Result<Aabb, Problem> {
    for (index, node, mesh) in scene.instances() {
        let near = |bounds: Aabb| {
            let farthest = bounds.min.abs().max(bounds.max.abs());
            farthest.is_finite() && f64::from(farthest.max_element()) <= FARTHEST
        };
        // The pose puts what has no finite place at the origin, so the node itself is asked too; a
        // skinned mesh is placed by its joints alone.
        let placed = node.skin.is_some() || near(mesh.bounds.transformed(&pose.world_from_node[index]));
        if !placed || !near(pose.world_bounds(scene, index)) {
            let what = format!("what it shows lies farther than {FARTHEST:e} m from the origin");
            return Err(Problem::Part { part: format!("node {:?}", clip(&node.name)), what });
        }
    }
    Ok(scene.bounds(pose))
}

/// A node that looks from `eye` to `target`.
pub(super) fn add_node(scene: &mut Scene, name: &str, eye: DVec3, target: DVec3) -> usize {
    let back = (eye - target).normalize_or(DVec3::Z);
    let right = DVec3::Y.cross(back).normalize_or(DVec3::X);
    let rotation = DQuat::from_mat3(&DMat3::from_cols(right, back.cross(right), back)).normalize();
    let local = Transform::Trs { translation: eye, rotation, scale: DVec3::ONE };
    scene.nodes.push(Node { name: name.into(), local, ..Node::default() });
    scene.nodes.len() - 1
}

/// A warm key light above to the left, which throws its shadows beside things as the camera sees them,
/// and a faint cool one from the other side, so that what it does not reach has a shape too.
fn add_lights(scene: &mut Scene, center: DVec3, radius: f64) {
    let distance = 2.4 * radius;
    let node = add_node(scene, "key light", center + KEY_SIDE.normalize() * distance, center);
    scene.lights.push(Light {
        name: "key light".into(),
        node,
        kind: LightKind::Point,
        color: Vec3::new(1.0, 0.95, 0.86),
        intensity: (GOOD_IRRADIANCE * distance * distance) as f32,
        range: f32::INFINITY,
        ..Light::default()
    });
    let node = add_node(scene, "fill light", center + FILL_SIDE.normalize() * distance, center);
    scene.lights.push(Light {
        name: "fill light".into(),
        node,
        kind: LightKind::Directional,
        color: Vec3::new(0.75, 0.86, 1.0),
        intensity: (0.25 * GOOD_IRRADIANCE) as f32,
        range: f32::INFINITY,
        ..Light::default()
    });
}

/// From the front, a little to the right and above or wherever more can be seen, so that all of the
/// bounds is in view.
fn add_camera(scene: &mut Scene, posed: &Pose, bounds: &Aabb, center: DVec3, radius: f64) {
    let vertical_fov = 45f64.to_radians();
    let eye = viewpoint::choose(scene, posed, |back| {
        let right = DVec3::Y.cross(back).normalize();
        let up = back.cross(right);
        let tangent = (0.5 * vertical_fov).tan();
        let needed = |corner: DVec3| {
            let offset = corner - center;
            let sideways = (offset.dot(right).abs() / 1.4).max(offset.dot(up).abs()); // pictures are wider than high
            offset.dot(back) + sideways / tangent
        };
        center + back * (bounds.corners().into_iter().map(needed).fold(0.0, f64::max).max(radius) * 1.06)
    });
    let distance = eye.distance(center);
    let node = add_node(scene, "camera", eye, center);
    // Depth is a 24-bit integer: what the near plane gains, the surfaces far behind it lose.
    let near = (radius / 200.0).clamp(1e-5, 0.5);
    scene.cameras.push(Camera { name: "camera".into(), node, vertical_fov, near, focus_distance: distance });
}

/// Candela values mean what their maker thought a camera would do. So the light is measured, at points
/// spread over what casts shadows (over everything where nothing does), and the exposure chosen that
/// takes the median to [`GOOD_IRRADIANCE`]. Of several lights the brightest counts full and the others
/// half: they seldom shine on the same side of things. Shadows and slants are not looked at.
fn exposure(scene: &Scene, pose: &Pose) -> f64 {
    let mut points = sample(scene, pose, true);
    if points.is_empty() {
        points = sample(scene, pose, false);
    }
    let mut measured: Vec<f64> = points.iter().map(|point| irradiance(pose, *point)).filter(|value| *value > 0.0).collect();
    measured.sort_by(f64::total_cmp);
    let brightest = measured.last().copied().unwrap_or(0.0);
    measured.retain(|value| *value > 1e-3 * brightest); // the unlit backyard does not count
    match measured.get(measured.len() / 2) {
        Some(median) => (GOOD_IRRADIANCE / median).clamp(EXPOSURES.0, EXPOSURES.1),
        None => 1.0,
    }
}

fn irradiance(pose: &Pose, point: DVec3) -> f64 {
    let (mut sum, mut brightest) = (0.0, 0.0f64);
    for light in &pose.lights {
        let luminance = light.intensity.as_dvec3().dot(DVec3::new(0.2126, 0.7152, 0.0722));
        let offset = point - light.position;
        let distance = offset.length().max(1e-6);
        let reach = (1.0 - (distance / light.range).powi(4)).clamp(0.0, 1.0);
        let received = match light.kind {
            LightKind::Directional => luminance,
            LightKind::Point => luminance * reach / (distance * distance),
            LightKind::Spot { outer, .. } => {
                let inside = offset.dot(light.direction) >= distance * f64::from(outer).cos();
                if inside { luminance * reach / (distance * distance) } else { 0.0 }
            }
        };
        sum += received;
        brightest = brightest.max(received);
    }
    brightest + 0.5 * (sum - brightest)
}

/// A few hundred vertices, spread evenly over the instances.
fn sample(scene: &Scene, pose: &Pose, casters: bool) -> Vec<DVec3> {
    const POINTS: usize = 1024;
    let chosen = || scene.instances().filter(|(_, node, _)| node.casts_shadow || !casters);
    let each = (POINTS / chosen().count().max(1)).max(2);
    let mut points = Vec::new();
    for (index, _, _) in chosen() {
        let positions = pose.positions(scene, index);
        let step = (positions.len() / each).max(1);
        let world_from_object: &DAffine3 = &pose.world_from_object[index];
        points.extend(positions.iter().step_by(step).map(|position| world_from_object.transform_point3(position.as_dvec3())));
    }
    points
}
