//! What every stock scene keeps to, without a GPU.

// Test code: a failed expectation is the report.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::collections::BTreeMap;

use glam::DVec3;

use super::TABLE;
use super::compose::{MODELS, STRIDE, STRIDE_SECONDS};
use crate::frame::Camera;
use crate::geometry::planar::height;
use crate::geometry::sight::worst_case;
use crate::geometry::{Body, Sight};
use crate::scene::pose::pose;
use crate::scene::{AnimationChoice, LightKind, Pose, PosedMirror, Property, Scene};
use crate::settings::Settings;

fn scenes() -> Vec<Scene> {
    TABLE.iter().map(|stock| (stock.build)().unwrap_or_else(|error| panic!("{}: {error}", stock.name))).collect()
}

fn posed(scene: &Scene, time: f64) -> Pose {
    pose(scene, time, scene.default_animation, &BTreeMap::new())
}

/// The triangles of every shadow caster in world space, caster by caster.
fn casters<'a>(scene: &'a Scene, pose: &'a Pose) -> impl Iterator<Item = (&'a str, Vec<[DVec3; 3]>)> {
    scene.instances().filter(|(_, node, _)| node.casts_shadow).map(|(index, node, mesh)| {
        let positions = pose.deformed[index].as_ref().map_or(&mesh.positions, |deformed| &deformed.positions);
        let world = |i: u32| pose.world_from_object[index].transform_point3(positions[i as usize].as_dvec3());
        (node.name.as_str(), mesh.indices.chunks_exact(3).map(|t| [world(t[0]), world(t[1]), world(t[2])]).collect())
    })
}

fn casting_triangles(scene: &Scene, pose: &Pose) -> Vec<[DVec3; 3]> {
    casters(scene, pose).flat_map(|(_, triangles)| triangles).collect()
}

fn blocked(triangles: &[[DVec3; 3]], from: DVec3, to: DVec3) -> bool {
    crossings(triangles, from, to) > 0
}

/// How many of the triangles the segment goes through.
fn crossings(triangles: &[[DVec3; 3]], from: DVec3, to: DVec3) -> usize {
    let along = to - from;
    let crosses = |[a, b, c]: &&[DVec3; 3]| {
        let (u, v) = (*b - *a, *c - *a);
        let normal = along.cross(v);
        let volume = u.dot(normal);
        let offset = from - *a;
        let (s, across) = (offset.dot(normal) / volume, offset.cross(u));
        let (t, distance) = (along.dot(across) / volume, v.dot(across) / volume);
        s >= 0.0 && t >= 0.0 && s + t <= 1.0 && distance > 0.0 && distance < 1.0
    };
    triangles.iter().filter(crosses).count()
}

#[test]
fn names_are_unique_and_known() {
    let names: Vec<_> = TABLE.iter().map(|stock| stock.name).collect();
    assert_eq!(
        names,
        [
            "courtyard",
            "cubes",
            "teapots",
            "grid",
            "eye-in-shadow",
            "projector",
            "cathedral",
            "stairs",
            "shadowfun",
            "hello2rts",
            "gallery",
            "barbershop",
            "corridor",
            "terraces",
            "figure3",
            "kaleidoscope",
            "portals",
            "halo",
            "csg",
            "figure7",
            "runway",
        ]
    );
    assert!(super::build("courtyard").is_some() && super::build("nowhere").is_none());
}

#[test]
fn models_import_without_complaint() {
    for (name, bytes) in MODELS {
        let model = crate::scene::gltf::load_embedded(name, bytes).unwrap();
        // Models bring no lights: scenes do. The importer says what it put in their place.
        let complaints: Vec<_> = model.warnings.iter().filter(|warning| !warning.contains("has no lights")).collect();
        assert!(complaints.is_empty(), "{name}: {complaints:?}");
    }
}

#[test]
fn every_scene_is_complete() {
    for scene in scenes() {
        assert_eq!(scene.warnings, Vec::<String>::new(), "{}", scene.name);
        assert!(scene.cameras.len() >= 2 && !scene.lights.is_empty(), "{}", scene.name);
        assert!(!scene.animations.is_empty() && scene.default_animation == AnimationChoice::All, "{}", scene.name);
        assert!(scene.nodes.iter().enumerate().all(|(i, node)| node.parent.is_none_or(|parent| parent < i)), "{}", scene.name);
        for light in &scene.lights {
            assert!(light.range.is_finite() || light.kind == LightKind::Directional, "{}: {}", scene.name, light.name);
        }
        let mut pictures = scene.materials.iter().filter_map(|material| material.base_color_texture);
        assert!(pictures.all(|texture| texture < scene.textures.len()), "{}", scene.name);
        for time in [0.0, 1.7, 60.0] {
            let pose = posed(&scene, time);
            for [a, b, c] in casting_triangles(&scene, &pose) {
                let inside = |p: DVec3| p.is_finite() && p.abs().max_element() < 70.0;
                assert!(inside(a) && inside(b) && inside(c), "{} at {time} s", scene.name);
            }
        }
    }
}

#[test]
fn casters_are_solid_but_for_teapots_and_sheets() {
    for scene in scenes() {
        for (_, node, mesh) in scene.instances().filter(|(_, node, _)| node.casts_shadow) {
            let open = node.name.ends_with("teapot") || node.name.ends_with("sheet");
            assert_eq!(mesh.topology.report().is_solid(), !open, "{}: {}", scene.name, node.name);
        }
    }
}

#[test]
fn casters_face_outwards() {
    for (name, bytes) in MODELS {
        let model = crate::scene::gltf::load_embedded(name, bytes).unwrap();
        for (_, node, mesh) in model.instances().filter(|(_, node, mesh)| node.casts_shadow && mesh.topology.report().is_solid())
        {
            let corner = |i: u32| mesh.positions[i as usize].as_dvec3();
            let six_volumes = |t: &[u32]| corner(t[0]).dot(corner(t[1]).cross(corner(t[2])));
            let volume = mesh.indices.chunks_exact(3).map(six_volumes).sum::<f64>() / 6.0;
            assert!(volume > 1e-4, "{name}: {} holds {volume} cubic metres", node.name);
        }
    }
}

#[test]
fn movement_has_no_seam() {
    for scene in scenes() {
        for animation in &scene.animations {
            for channel in &animation.channels {
                let width = channel.values.len() / channel.times.len();
                assert_eq!(f64::from(*channel.times.last().unwrap()) as f32, animation.duration as f32, "{}", animation.name);
                let (first, last) = (&channel.values[..width], &channel.values[channel.values.len() - width..]);
                let same = first.iter().zip(last).all(|(a, b)| (a - b).abs() < 1e-5);
                assert!(same, "{}: {} ends at {last:?}, not {first:?}", scene.name, animation.name);
                // No jumps between keys either; a half turn of a quaternion's sign is none.
                for pair in channel.values.chunks_exact(width).collect::<Vec<_>>().windows(2) {
                    let step = |sign: f32| pair[0].iter().zip(pair[1]).map(|(a, b)| (a - sign * b).abs()).fold(0.0, f32::max);
                    let step = if channel.property == Property::Rotation { step(1.0).min(step(-1.0)) } else { step(1.0) };
                    assert!(step < 0.45, "{}: {} jumps by {step}", scene.name, animation.name);
                }
            }
        }
    }
}

#[test]
fn triangles_stay_few() {
    let most = [
        75_000, 2_500, 25_000, 8_000, 60_000, 35_000, 35_000, 20_000, 16_000, 20_000, 20_000, 15_000, 18_000, 25_000, 8_000,
        12_000, 30_000, 25_000, 20_000, 8_000, 6_000,
    ];
    assert_eq!(most.len(), TABLE.len());
    for (scene, most) in scenes().iter().zip(most) {
        let triangles: usize = scene.instances().map(|(_, _, mesh)| mesh.indices.len() / 3).sum();
        assert!(triangles <= most, "{}: {triangles} triangles", scene.name);
    }
}

/// How many mirrors each scene means to have, all of them on their planes whatever the time; and nothing that
/// shines or sees lies in such a plane, where a hair would decide which side it is on.
#[test]
fn mirrors_are_where_they_are_meant_to_be() {
    let count = |name: &str| match name {
        "gallery" | "portals" => 4,
        "barbershop" | "corridor" | "terraces" => 2,
        "kaleidoscope" => 3,
        "figure3" | "halo" => 1,
        _ => 0,
    };
    for scene in scenes() {
        assert_eq!(scene.mirrors.len(), count(scene.name.as_str()), "{}", scene.name);
        for time in [0.0, 4.3] {
            let pose = posed(&scene, time);
            for mirror in &scene.mirrors {
                let PosedMirror { plane, triangles, .. } = mirror.posed(&scene, &pose).unwrap();
                let off = triangles.iter().flatten().map(|corner| height(plane, *corner).abs()).fold(0.0, f64::max);
                assert!(off < 1e-6, "{}: {} is {off} m off its plane", scene.name, mirror.name);
                let eyes = scene.cameras.iter().map(|camera| pose.world_from_node[camera.node].translation);
                for place in eyes.chain(pose.lights.iter().map(|light| light.position)) {
                    assert!(height(plane, place).abs() > 0.02, "{}: {place} lies in {}", scene.name, mirror.name);
                }
                assert!(!scene.nodes[mirror.node].casts_shadow, "{}: the glass itself throws no shadow", scene.name);
            }
        }
    }
}

/// The hallway is a periscope: the first camera sees the last leg by both mirrors, and not without them.
#[test]
fn the_corridor_is_a_periscope() {
    let scene = super::build("corridor").unwrap().unwrap();
    let pose = posed(&scene, 0.0);
    let camera = Camera::choose(&Settings::default(), &scene, &pose).unwrap();
    let [first, second] = [0, 1].map(|mirror: usize| scene.mirrors[mirror].posed(&scene, &pose).unwrap());
    let eye = Sight::of_eye(camera.eye, camera.clip_from_world(), [320, 180]);
    let one = eye.reflected(&first.triangles, first.plane, false).expect("the first mirror").sight;
    let two = one.reflected(&second.triangles, second.plane, false).expect("the second in the first").sight;
    assert!(eye.reflected(&second.triangles, second.plane, false).is_none_or(|seen| seen.area < 1.0), "not straight");
    let statue = scene.nodes.iter().position(|node| node.name == "knot").unwrap();
    let place = Body::boxed(&pose.bounds(&scene, statue), &pose.world_from_object[statue]);
    assert!(two.body().may_meet(&place) && !one.body().may_meet(&place));
    for (mirror, name) in [(&first, "the first"), (&second, "the second")] {
        assert!(two.reflected(&mirror.triangles, mirror.plane, false).is_none(), "{name} once more");
    }
}

/// What is marked to take planar shadows does, and stays on its plane whatever the time.
#[test]
fn receivers_are_where_they_are_meant_to_be() {
    let count = |name: &str| match name {
        "cubes" | "teapots" | "grid" | "eye-in-shadow" | "corridor" | "barbershop" | "gallery" => 1,
        "figure7" => 2,
        _ => 0,
    };
    for scene in scenes() {
        assert_eq!(scene.receivers.len(), count(scene.name.as_str()), "{}", scene.name);
        for time in [0.0, 4.3] {
            let pose = posed(&scene, time);
            assert!(scene.receivers.iter().all(|receiver| receiver.posed(&scene, &pose).unwrap().room < 1e-4));
        }
    }
}

#[test]
fn the_eye_in_shadow_is_in_shadow() {
    let scene = super::build("eye-in-shadow").unwrap().unwrap();
    for time in [0.0, 3.0, 6.5, 9.0] {
        let pose = posed(&scene, time);
        let eye = pose.world_from_node[scene.cameras[0].node].translation;
        let triangles = casting_triangles(&scene, &pose);
        assert!(blocked(&triangles, eye, pose.lights[0].position), "at {time} s");
        assert!(!blocked(&triangles, eye + DVec3::Y * 20.0, pose.lights[0].position + DVec3::Y * 15.0), "the ray test itself");
    }
}

/// Eight bits count 256 volumes as none: on a broad patch of the court every ray from the beacon
/// goes through 256 casters, and through each of them once, wherever the beacon is on its way.
#[test]
fn the_stairs_nest_256_volumes() {
    let scene = super::build("stairs").unwrap().unwrap();
    let steps = scene.nodes.iter().filter(|node| node.name.starts_with("step ")).count();
    assert!(steps > 256, "{steps} steps");
    for time in [0.0, 2.0, 4.0, 5.3] {
        let pose = posed(&scene, time);
        let beacon = pose.lights[0].position;
        let solids: Vec<_> = casters(&scene, &pose).filter(|(name, _)| *name != "walker").collect();
        // 20 and 44 are where the court begins and ends; from 35 on the beacon is seen.
        for (x, z, expected) in [
            (-3.0, 21.2, 256),
            (0.1, 22.3, 256),
            (3.0, 21.2, 256),
            (-3.2, 27.9, 256),
            (0.1, 25.0, 256),
            (3.2, 27.9, 256),
            (0.1, 37.0, 0),
            (-3.2, 39.3, 0),
        ] {
            let point = DVec3::new(x, 0.0, z);
            let crossed: Vec<_> = solids.iter().map(|(_, solid)| crossings(solid, beacon, point)).filter(|&n| n > 0).collect();
            assert_eq!(crossed.len(), expected, "volumes over {point} at {time} s");
            assert!(crossed.iter().all(|&n| n == 2), "into each and out of it: {point} at {time} s");
        }
    }
}

#[test]
fn planted_feet_do_not_slide() {
    let scene = super::build("courtyard").unwrap().unwrap();
    // A sole vertex of the fountain's walker, near the ball of the foot: the lowest at any time
    // must be nearly still, whichever it is.
    let (index, _, mesh) = scene.instances().find(|(_, node, _)| node.skin.is_some()).unwrap();
    let (mut worst, mut checked, dt) = (0.0_f64, 0, 0.02);
    for step in 0..58 {
        let time = 5.0 + f64::from(step) * dt;
        let (now, soon) = (posed(&scene, time), posed(&scene, time + dt));
        let [now, soon] = [&now, &soon].map(|pose| &pose.deformed[index].as_ref().unwrap().positions);
        let flat = |i: usize| now[i].y < 0.012 && soon[i].y < 0.012;
        let speeds = (0..mesh.positions.len()).filter(|&i| flat(i)).map(|i| f64::from(now[i].distance(soon[i])) / dt);
        if let Some(slowest) = speeds.min_by(f64::total_cmp) {
            worst = worst.max(slowest);
            checked += 1;
        }
    }
    let pace = STRIDE / STRIDE_SECONDS;
    assert!(checked > 40, "a foot is on the ground nearly always, not {checked} times of 58");
    assert!(worst < 0.25 * pace, "a planted foot slides at {worst:.2} m/s, walking at {pace:.2} m/s");
}

/// How many views a camera needs, the eye's own among them, up to so many bounces.
fn views(sight: &Sight, mirrors: &[PosedMirror], through: Option<usize>, bounces: u32) -> usize {
    let seen = |(index, mirror): (usize, &PosedMirror)| {
        let found = sight.reflected(&mirror.triangles, mirror.plane, false)?;
        Some(views(&found.sight, mirrors, Some(index), bounces - 1))
    };
    let others = mirrors.iter().enumerate().filter(|(index, _)| bounces > 0 && through != Some(*index));
    1 + others.filter_map(seen).sum::<usize>()
}

/// At four bounces, from the first camera; the kaleidoscope's at most a fifth of K's worst case.
#[test]
fn few_of_the_views_there_could_be_are_needed() {
    for (name, most, worst) in [
        ("gallery", 13, 161),
        ("barbershop", 5, 9),
        ("corridor", 3, 9),
        ("terraces", 3, 9),
        ("figure3", 2, 2),
        ("kaleidoscope", 9, 46),
    ] {
        let scene = super::build(name).unwrap().unwrap();
        let pose = posed(&scene, 0.0);
        let mirrors: Vec<_> = scene.mirrors.iter().map(|mirror| mirror.posed(&scene, &pose).unwrap()).collect();
        assert_eq!(worst_case(mirrors.len(), 4), worst, "{name}");
        let settings = Settings { size: [1280, 720], ..Settings::default() };
        let camera = Camera::choose(&settings, &scene, &pose).unwrap();
        let eye = Sight::of_eye(camera.eye, camera.clip_from_world(), settings.size);
        let needed = views(&eye, &mirrors, None, 4);
        assert!(needed <= most && needed > mirrors.len().min(1), "{name}: {needed} views");
        assert_eq!(views(&eye, &mirrors, None, 0), 1, "{name}: the eye's own");
    }
}
