//! Mirrors: the mathematics on random planes and polygons, and which surfaces of a file are mirrors.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that fails may panic")]

mod common;
mod gltf_files;

use std::collections::BTreeMap;

use common::{Build, cube, square};
use glam::{DAffine3, DQuat, DVec2, DVec3, DVec4, Vec3};
use gltf_files::File;
use obscura::frame::Camera;
use obscura::geometry::clip::clipped;
use obscura::geometry::planar::{height, reflection, transformed};
use obscura::geometry::{Aabb, Body, Sight};
use obscura::scene::gltf::load_bytes;
use obscura::scene::pick::surface_at;
use obscura::scene::pose::pose;
use obscura::scene::{Pose, Reflective, Refusal, Scene, doctor};
use obscura::settings::{MirrorMode, Mirrors, SurfacePlace};
use proptest::prelude::*;
use serde_json::json;

const SIZE: [u32; 2] = [320, 180];

fn vector(size: f64) -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-size..size).prop_map(DVec3::from)
}

fn unit() -> impl Strategy<Value = DVec3> {
    vector(1.0).prop_filter_map("no direction", |v| (v.length() > 0.05).then(|| v.normalize()))
}

fn plane() -> impl Strategy<Value = DVec4> {
    (unit(), -5.0..5.0f64).prop_map(|(normal, offset)| normal.extend(offset))
}

/// A convex polygon on a plane: its corners lie on an ellipse, in order.
fn polygon() -> impl Strategy<Value = Vec<DVec3>> {
    (vector(5.0), unit(), prop::collection::vec(0.05..1.0f64, 3..9), 0.1..3.0f64, 0.1..3.0f64).prop_map(
        |(center, normal, steps, a, b)| {
            let (right, up) = normal.any_orthonormal_pair();
            let whole: f64 = steps.iter().sum();
            let mut turned = 0.0;
            let corner = |step: &f64| {
                turned += step / whole * std::f64::consts::TAU;
                center + right * (a * turned.cos()) + up * (b * turned.sin())
            };
            steps.iter().map(corner).collect()
        },
    )
}

fn fan(polygon: &[DVec3]) -> Vec<[DVec3; 3]> {
    (1..polygon.len() - 1).map(|i| [polygon[0], polygon[i], polygon[i + 1]]).collect()
}

/// A point of a polygon, by weights of its corners.
fn inside(polygon: &[DVec3], weights: &[f64]) -> DVec3 {
    let weights: Vec<f64> = (0..polygon.len()).map(|i| weights[i % weights.len()] * (1.0 + i as f64)).collect();
    let sum: f64 = weights.iter().sum();
    polygon.iter().zip(&weights).map(|(corner, weight)| *corner * (weight / sum)).sum()
}

/// How far a point of the polygon's plane lies within it, metres; negative outside.
fn depth_in(polygon: &[DVec3], point: DVec3) -> f64 {
    let area: DVec3 = (1..polygon.len() - 1).map(|i| (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0])).sum();
    let Some(normal) = area.try_normalize() else { return f64::NEG_INFINITY };
    let edge = |i: usize| {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        (b - a).try_normalize().map_or(f64::INFINITY, |along| normal.cross(along).dot(point - a))
    };
    (0..polygon.len()).map(edge).fold(f64::INFINITY, f64::min)
}

/// The plane of a polygon, its normal to where `before` is.
fn facing(polygon: &[DVec3], before: DVec3) -> DVec4 {
    let normal = (1..polygon.len() - 1).map(|i| (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0])).sum::<DVec3>();
    let normal = normal.normalize();
    let plane = normal.extend(-normal.dot(polygon[0]));
    if height(plane, before) < 0.0 { -plane } else { plane }
}

fn pixel_of(sight: &Sight, point: DVec3) -> DVec2 {
    let clip = sight.clip_from_world * point.extend(1.0);
    (DVec2::new(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * DVec2::from(SIZE.map(f64::from))
}

/// Whether `sight` takes in a point that is seen at `pixel`.
fn takes_in(sight: &Sight, point: DVec3, pixel: DVec2) -> Result<(), TestCaseError> {
    prop_assert!(pixel_of(sight, point).distance(pixel) < 1e-4, "it is seen elsewhere");
    let outline: Vec<DVec3> = sight.outline.iter().map(|corner| corner.extend(0.0)).collect();
    prop_assert!(depth_in(&outline, pixel.extend(0.0)) > 0.2, "{pixel} is not in {:?}", sight.outline);
    let [x, y, wide, high] = sight.rect().unwrap();
    let rect = (f64::from(x)..=f64::from(x + wide), f64::from(y)..=f64::from(y + high));
    prop_assert!(rect.0.contains(&pixel.x) && rect.1.contains(&pixel.y), "{pixel} is not in {:?}", sight.rect());
    let small = Aabb { min: Vec3::splat(-1e-3), max: Vec3::splat(1e-3) };
    prop_assert!(sight.body().may_meet(&Body::boxed(&small, &DAffine3::from_translation(point))), "not in the body");
    prop_assert!(sight.planes(0.0).iter().all(|plane| height(*plane, point) >= -1e-9), "under a plane");
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, max_global_rejects: 200_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn reflecting_twice_is_nothing_and_keeps_lengths(plane in plane(), a in vector(9.0), b in vector(9.0)) {
        let mirror = reflection(plane);
        prop_assert!((mirror * mirror).transform_point3(a).distance(a) < 1e-12);
        let (c, d) = (mirror.transform_point3(a), mirror.transform_point3(b));
        prop_assert!((c.distance(d) - a.distance(b)).abs() < 1e-12);
        prop_assert!((height(plane, a) + height(plane, c)).abs() < 1e-12, "as far behind as before");
        prop_assert!(((c - a).cross(plane.truncate())).length() < 1e-12, "straight through");
        prop_assert!((mirror.matrix3.determinant() + 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_plane_moves_with_its_points(
        plane in plane(), turn in vector(3.0), place in vector(20.0), scale in vector(3.0), point in vector(9.0),
    ) {
        prop_assume!(scale.abs().min_element() > 0.1);
        let world_from_object = DAffine3::from_scale_rotation_translation(scale, DQuat::from_scaled_axis(turn), place);
        let there = transformed(plane, &world_from_object);
        prop_assert!((there.truncate().length() - 1.0).abs() < 1e-12);
        let on_plane = point - plane.truncate() * height(plane, point);
        prop_assert!(height(there, world_from_object.transform_point3(on_plane)).abs() < 1e-9);
        let (before, after) = (height(plane, point), height(there, world_from_object.transform_point3(point)));
        prop_assert!(before.abs() < 1e-9 || before.signum() == after.signum(), "the front stays the front, mirrored or not");
    }

    /// Against what cannot be wrong: points of the polygon, each on or over all planes, or not.
    #[test]
    fn clipping_keeps_what_is_over_the_planes(
        polygon in polygon(), planes in prop::collection::vec(plane(), 0..7),
        weights in prop::collection::vec(prop::collection::vec(0.0..1.0f64, 9), 40),
    ) {
        let kept = clipped(&polygon, &planes);
        for corner in &kept {
            prop_assert!(planes.iter().all(|plane| height(*plane, *corner) > -1e-9));
            prop_assert!(depth_in(&polygon, *corner) > -1e-9, "a corner that was not there");
        }
        for point in weights.iter().filter(|weights| weights.iter().sum::<f64>() > 0.0).map(|weights| inside(&polygon, weights)) {
            let over = planes.iter().map(|plane| height(*plane, point)).fold(f64::INFINITY, f64::min);
            if over >= 1e-9 {
                prop_assert!(depth_in(&kept, point) > -1e-6, "lost {point}, {over} m over the lowest plane");
            } else if over < -1e-9 && kept.len() > 2 {
                prop_assert!(depth_in(&kept, point) < 1e-6, "kept {point}, {over} m under a plane");
            }
        }
    }

    /// A way of light from a point by two mirrors to the eye is made first, and then looked for.
    #[test]
    fn what_two_mirrors_show_is_never_lost(
        first in polygon(), second in polygon(), weights in prop::array::uniform2(prop::collection::vec(0.01..1.0f64, 9)),
        ways in prop::array::uniform2(0.05..12.0f64), aside in vector(0.25), fov in 0.3..1.8f64, near in 0.01..0.2f64,
    ) {
        let (a, b) = (inside(&first, &weights[0]), inside(&second, &weights[1]));
        let (near_plane, far_plane) = (facing(&first, b), facing(&second, a));
        prop_assume!(height(near_plane, b) > 0.01 && height(far_plane, a) > 0.01);
        let at_a = reflection(near_plane).transform_point3(b);
        let eye = a + (a - at_a).normalize() * ways[0];
        let at_b = reflection(far_plane).transform_point3(a);
        let point = b + (b - at_b).normalize() * ways[1];
        let Ok(camera) = Camera::look_at(eye, a + aside * ways[0] * fov, fov, 16.0 / 9.0, near) else { return Ok(()) };
        let view = Sight::of_eye(eye, camera.clip_from_world(), SIZE);
        let pixel = pixel_of(&view, a);
        prop_assume!((a - eye).dot(camera.forward) > near && pixel.cmpgt(DVec2::ZERO).all());
        prop_assume!(pixel.cmplt(DVec2::from(SIZE.map(f64::from))).all());

        let Some(once) = view.reflected(&fan(&first), near_plane, false) else { panic!("the first mirror is lost") };
        takes_in(&once.sight, b, pixel)?;
        prop_assert!(once.polygons.iter().any(|polygon| depth_in(polygon, a) > -1e-6));
        let Some(twice) = once.sight.reflected(&fan(&second), far_plane, false) else { panic!("the second mirror is lost") };
        takes_in(&twice.sight, point, pixel)?;
        prop_assert!(twice.sight.reflected(&fan(&second), far_plane, false).is_none(), "no mirror in itself");
        let back = reflection(near_plane) * reflection(far_plane);
        prop_assert!(twice.sight.eye.distance(back.inverse().transform_point3(eye)) < 1e-9 * (1.0 + twice.sight.eye.length()));
    }

    /// A view's volume of interest is no larger than the pyramid it stands for, give or take its margin.
    #[test]
    fn what_is_well_beside_a_mirror_is_left_out(polygon in polygon(), eye in vector(8.0), point in vector(30.0)) {
        let middle = inside(&polygon, &[1.0]);
        let plane = facing(&polygon, eye);
        prop_assume!(height(plane, eye) > 0.3);
        let camera = Camera::look_at(eye, middle, 1.2, 16.0 / 9.0, 0.05).unwrap();
        let view = Sight::of_eye(eye, camera.clip_from_world(), SIZE);
        let Some(found) = view.reflected(&fan(&polygon), plane, false) else { return Ok(()) };
        // Where the way from the reflected eye to the point meets the mirror's plane.
        let (from, to) = (-height(plane, found.sight.eye), height(plane, point));
        prop_assume!(to > 0.1);
        let met = found.sight.eye.lerp(point, from / (from + to));
        let w = (found.sight.clip_from_world * met.extend(1.0)).w;
        prop_assume!(depth_in(&polygon, met) < -0.3 - 0.1 * w.abs());
        let small = Aabb { min: Vec3::splat(-1e-3), max: Vec3::splat(1e-3) };
        let about = Body::boxed(&small, &DAffine3::from_translation(point));
        // Sharp corners, cut off bluntly, let in more.
        let sharp = polygon.len() < 4;
        prop_assert!(sharp || !found.sight.body().may_meet(&about), "{met} is not on the mirror");
    }
}

fn import(file: &File) -> Scene {
    load_bytes("test", &file.glb()).unwrap()
}

fn still(scene: &Scene, time: f64) -> Pose {
    pose(scene, time, scene.default_animation, &BTreeMap::new())
}

/// The triangle (0 0 0, 1 0 0, 0 1 0), which looks along +Z, in this material.
fn triangle_of(material: serde_json::Value) -> File {
    let mut file = File::triangle();
    file.json["materials"] = json!([material]);
    file.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    file
}

#[test]
fn extras_mark_mirrors_and_say_how_they_reflect() {
    let scene = import(&triangle_of(json!({"extras": {"mirror": true}})));
    let [mirror] = &scene.mirrors[..] else { panic!("{:?}", scene.mirrors) };
    assert_eq!((mirror.node, mirror.instance, mirror.primitive), (0, 0, 0));
    assert_eq!((mirror.plane, mirror.look), (DVec4::Z, Reflective::default()));
    assert!(!mirror.double_sided);

    let look = json!({"mirror": true, "reflectivity": 0.25, "tint": [1, 0.5, 0]});
    let scene = import(&triangle_of(json!({"doubleSided": true, "extras": look})));
    assert_eq!(scene.mirrors[0].look, Reflective { reflectivity: 0.25, tint: Vec3::new(1.0, 0.5, 0.0) });
    let report = doctor::report(&scene);
    assert_eq!(report.mirrors, ["0:0 node 0 (reflectivity 0.25, tint 1 0.5 0, both sides)"]);
    assert!(report.to_string().contains("mirrors     0:0 node 0 (reflectivity"), "{report}");

    for none in [json!({"mirror": false, "reflectivity": 9}), json!({"reflectivity": 1}), json!(7)] {
        let scene = import(&triangle_of(json!({"extras": none})));
        assert!(scene.mirrors.is_empty() && scene.materials[0].mirror.is_none());
        assert!(!scene.warnings.iter().any(|warning| warning.contains("mirror") || warning.contains("reflectivity")));
    }
}

#[test]
fn what_extras_say_wrongly_is_told_and_mended() {
    for (extras, warning, mirrors) in [
        (json!({"mirror": "yes"}), "its `mirror` is neither true nor false, and it is none", 0),
        (json!({"mirror": true, "reflectivity": 2}), "its reflectivity is no number from 0 to 1, and taken as 1", 1),
        (json!({"mirror": true, "reflectivity": "half"}), "its reflectivity is no number from 0 to 1, and taken as 1", 1),
        (json!({"mirror": true, "tint": [1, 1]}), "its tint is not three numbers from 0 to 1, and left out", 1),
        (json!({"mirror": true, "tint": [1, -1, 1e99]}), "its tint is not three numbers from 0 to 1, and left out", 1),
    ] {
        let scene = import(&triangle_of(json!({"name": "silver", "extras": extras})));
        assert!(scene.warnings.contains(&format!("material 0 \"silver\": {warning}")), "{:?}", scene.warnings);
        assert_eq!(scene.mirrors.len(), mirrors);
        assert!(scene.mirrors.iter().all(|mirror| mirror.look == Reflective::default()));
    }
}

#[test]
fn what_cannot_be_a_mirror_is_drawn_as_it_is_and_says_why() {
    let refused = |file: &File, why: &str| {
        let scene = import(file);
        assert!(scene.mirrors.is_empty());
        let words = format!("node \"node 0\", material \"silver\": no mirror: {why}");
        assert!(scene.warnings.contains(&words), "{words}: {:?}", scene.warnings);
        assert!(doctor::report(&scene).to_string().contains(&words));
    };
    let silver = json!({"name": "silver", "extras": {"mirror": true}});
    let mut bent = triangle_of(silver.clone());
    let corners = bent.floats("VEC3", &[0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 1., 0., 1., 0., 0., 1., 1., 0.5]);
    bent.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(corners);
    refused(&bent, "its corners lie up to 0.12 m off one plane");
    let mut blended = silver.clone();
    blended["alphaMode"] = json!("BLEND");
    refused(&triangle_of(blended), "its material is blended");
    let mut masked = silver.clone();
    masked["alphaMode"] = json!("MASK");
    refused(&triangle_of(masked), "its material has holes (alpha mask)");
    let mut line = triangle_of(silver);
    let corners = line.floats("VEC3", &[0., 0., 0., 1., 0., 0., 2., 0., 0.]);
    line.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(corners);
    refused(&line, "its triangles have no area");
}

#[test]
fn mirrors_move_with_their_nodes() {
    let mut file = triangle_of(json!({"extras": {"mirror": true}}));
    let times = file.floats("SCALAR", &[0., 2.]);
    let places = file.floats("VEC3", &[0., 0., 1., 0., 0., 5.]);
    file.json["nodes"] = json!([{"mesh": 0, "scale": [2, 1, -1]}]);
    file.json["animations"] = json!([{
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
        "samplers": [{"input": times, "output": places}],
    }]);
    let scene = import(&file);
    for (time, z) in [(0.0, 1.0), (1.0, 3.0)] {
        let posed = scene.mirrors[0].posed(&scene, &still(&scene, time)).unwrap();
        assert_eq!(posed.plane, DVec4::new(0.0, 0.0, -1.0, z), "the scale turns it round");
        assert_eq!(posed.triangles, [[[0.0, 0.0, z], [2.0, 0.0, z], [0.0, 1.0, z]].map(DVec3::from)]);
    }
}

#[test]
fn a_bent_mirror_is_none_while_it_is_bent() {
    let mut file = triangle_of(json!({"doubleSided": true, "extras": {"mirror": true}}));
    let corners = file.floats("VEC3", &[0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 1., 0., 1., 0., 0., 1., 1., 0.]);
    let moved = file.floats("VEC3", &[0., 0., 0., 0., 0., 0., 0., 0., 0., 0., 0., 0., 0., 0., 0., 0., 0., 0.5]);
    let primitive = &mut file.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["POSITION"] = json!(corners);
    primitive["targets"] = json!([{"POSITION": moved}]);
    let times = file.floats("SCALAR", &[0., 2.]);
    let weights = file.floats("SCALAR", &[0., 1.]);
    file.json["animations"] = json!([{
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}],
        "samplers": [{"input": times, "output": weights}],
    }]);
    let scene = import(&file);
    let posed = |time| scene.mirrors[0].posed(&scene, &still(&scene, time));
    assert_eq!(posed(0.0).unwrap().triangles.len(), 2);
    assert_eq!(posed(1.0).unwrap_err().to_string(), "its corners lie up to 0.06 m off one plane");
    assert_eq!(posed(0.0).unwrap().plane, DVec4::Z);
}

/// A floor, a sheet over its middle drawn from both sides, and beside that a solid cube, turned inside out by its node.
fn floor_sheet_and_cube() -> Build {
    let mut build = Build::new();
    build.floor(0.0, 10.0);
    let (sheet, cube) = (build.mesh(square(1)), build.mesh(cube(0)));
    build.place(sheet, DVec3::Y * 2.0, DVec3::ONE);
    build.place(cube, DVec3::new(5.0, 2.0, 0.0), DVec3::new(-1.0, 1.0, 1.0));
    build
}

#[test]
fn a_ray_meets_the_first_surface_that_is_seen_from_there() {
    let mut build = floor_sheet_and_cube();
    let scene = build.0.clone();
    let pose = still(&scene, 0.0);
    let node = |eye: DVec3, direction: DVec3, nearest: f64| {
        surface_at(&scene, &pose, eye, direction, nearest).map(|SurfacePlace { node, primitive }| (node, primitive))
    };
    let (floor, sheet, cube) = (Some((0, 0)), Some((1, 0)), Some((2, 0)));
    let above = DVec3::new(0.3, 5.0, 0.2);
    assert_eq!(node(above, DVec3::NEG_Y, 0.1), sheet);
    assert_eq!(node(above, DVec3::NEG_Y * 0.5, 0.1), sheet, "lengths are in units of the direction");
    assert_eq!(node(above, DVec3::NEG_Y, 3.5), floor, "the sheet is too near to be seen");
    assert_eq!(node(DVec3::new(0.3, -3.0, 0.2), DVec3::Y, 0.1), sheet, "through the floor's back to the sheet's");
    assert_eq!(node(DVec3::new(4.0, -3.0, 4.0), DVec3::Y, 0.1), None, "through the floor's back");
    assert_eq!(node(above, DVec3::Y, 0.1), None);
    let (along, slanted) = (DVec3::new(0.8, 2.05, 0.0), DVec3::new(1.0, -0.3, 0.0));
    assert_eq!(node(along, slanted, 0.01), sheet, "the cube behind it comes later in the scene");
    assert_eq!(node(along, slanted, 1.0), cube);
    let over_cube = DVec3::new(5.2, 6.0, 0.1);
    assert_eq!(node(over_cube, DVec3::NEG_Y, 0.1), cube);
    assert_eq!(node(over_cube, DVec3::NEG_Y, 3.5), floor, "its inside is not seen");
    assert_eq!(node(DVec3::new(5.2, 2.0, 0.1), DVec3::NEG_Y, 0.01), floor, "nor from within");
    // A room about it all, later in the scene, with walls behind everything.
    let room = build.mesh(common::cube(1));
    build.place(room, DVec3::ZERO, DVec3::splat(30.0));
    let scene = build.0;
    let pose = still(&scene, 0.0);
    let met = |direction| surface_at(&scene, &pose, above, direction, 0.1).map(|place| place.node);
    assert_eq!((met(DVec3::NEG_Y), met(DVec3::Y)), (Some(1), Some(3)));
}

#[test]
fn surfaces_become_mirrors_and_mirrors_surfaces() {
    let mut scene = floor_sheet_and_cube().0;
    let [floor, sheet, cube] = [0, 1, 2].map(|node| SurfacePlace { node, primitive: 0 });
    scene.mirrors = vec![obscura::scene::Mirror::of(&scene, 1, 0, Reflective::default()).unwrap()];
    let mut settings = Mirrors::default();
    let in_force = |settings: &Mirrors| {
        let (mirrors, refused) = scene.mirrors_in_force(settings);
        (mirrors.iter().map(|mirror| mirror.node).collect::<Vec<_>>(), refused.len())
    };
    assert_eq!(in_force(&settings), (vec![1], 0));
    assert_eq!(scene.toggle_mirror(&mut settings, floor), Ok(true));
    assert_eq!(in_force(&settings), (vec![1, 0], 0));
    assert_eq!(scene.toggle_mirror(&mut settings, sheet), Ok(false));
    assert_eq!(in_force(&settings), (vec![0], 0));
    assert!(matches!(scene.toggle_mirror(&mut settings, cube), Err(Refusal::Uneven(_))));
    assert_eq!(scene.toggle_mirror(&mut settings, SurfacePlace { node: 9, primitive: 0 }), Err(Refusal::Missing));
    assert_eq!(in_force(&Mirrors { mode: MirrorMode::Off, ..settings.clone() }), (vec![], 0));
    // What cannot be a mirror is refused also where the settings have it from elsewhere.
    let foreign = Mirrors { edits: [(cube, true)].into(), ..Mirrors::default() };
    assert_eq!(in_force(&foreign), (vec![1], 1));
    assert_eq!(scene.toggle_mirror(&mut settings, sheet), Ok(true));
    assert_eq!(scene.toggle_mirror(&mut settings, floor), Ok(false));
    assert_eq!(settings, Mirrors::default(), "nothing is left of it");
}
