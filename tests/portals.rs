//! Doorways that lead elsewhere: by hand, against rays, and what is no doorway.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use std::collections::BTreeMap;

use common::{Build, assert_exact, cube, mesh, seen_from};
use glam::{DQuat, DVec3};
use obscura::cli::VerifyRequest;
use obscura::director;
use obscura::frame::Capabilities;
use obscura::headless::verify::verify;
use obscura::scene::gltf;
use obscura::scene::mirror::{Mirror, Refusal};
use obscura::scene::{Reflective, Scene, Transform, pose};
use obscura::settings::{MirrorMode, Mirrors, SceneChoice, Settings, Technique};

/// Two doorways of two metres by two: one at the origin, looking along +Z, one at (50, 0, 0), looking along +X. What
/// stands a metre before the second, and one to its left as one steps out, is seen a metre behind the first, and one to
/// the left.
fn doors() -> (Build, [usize; 2]) {
    doors_of(0)
}

/// The same of that material.
fn doors_of(material: usize) -> (Build, [usize; 2]) {
    let mut build = Build::new();
    let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    let way = build.mesh(mesh("way", &corners, &[[0, 1, 2], [0, 2, 3]], material));
    let one = build.place(way, DVec3::ZERO, DVec3::ONE);
    let other = build.place(way, DVec3::ZERO, DVec3::ONE);
    let quarter = DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2);
    build.0.nodes[other].local = Transform::Trs { translation: DVec3::new(50.0, 0.0, 0.0), rotation: quarter, scale: DVec3::ONE };
    for (node, exit) in [(one, other), (other, one)] {
        build.0.nodes[node].portal = Some(exit);
        build.0.nodes[node].casts_shadow = false;
    }
    (build, [one, other])
}

fn find(scene: &mut Scene) {
    let portals = (0..scene.nodes.len()).filter(|node| scene.nodes[*node].portal.is_some());
    scene.mirrors = portals.map(|node| Mirror::of(scene, node, 0, Reflective::default()).unwrap()).collect();
}

#[test]
fn who_steps_in_at_the_one_steps_out_of_the_other() {
    let (mut build, _) = doors();
    find(&mut build.0);
    let pose = pose::pose(&build.0, 0.0, build.0.default_animation, &BTreeMap::new());
    let turn = build.0.mirrors[0].posed(&build.0, &pose).unwrap().turn.unwrap();
    let goes = |from: [f64; 3], to: [f64; 3]| {
        let arrived = turn.transform_point3(DVec3::from(from));
        assert!(arrived.distance(DVec3::from(to)) < 1e-12, "{from:?} goes to {arrived}, not {to:?}");
    };
    goes([0.0, 0.0, 0.0], [50.0, 0.0, 0.0]);
    // A metre behind the one is a metre before the other; up is up; the left hand stays the left hand.
    goes([0.0, 0.0, -1.0], [51.0, 0.0, 0.0]);
    goes([0.0, 0.5, 0.0], [50.0, 0.5, 0.0]);
    goes([-0.5, 0.0, 0.0], [50.0, 0.0, -0.5]);
    let back = build.0.mirrors[1].posed(&build.0, &pose).unwrap().turn.unwrap();
    assert!((back * turn).abs_diff_eq(glam::DAffine3::IDENTITY, 1e-12), "there and back");
}

/// Seen through: a box and its shadow on a wall, in the light of a lamp there.
#[test]
fn shadows_beyond_are_exact() {
    shadows_are_exact_beyond(doors().0);
}

/// A doorway that is seen from behind, too, does not stand in its own way.
#[test]
fn shadows_beyond_a_doorway_with_two_sides_are_exact() {
    shadows_are_exact_beyond(doors_of(1).0);
}

fn shadows_are_exact_beyond(mut build: Build) {
    let box_there = build.mesh(cube(0));
    build.place(box_there, DVec3::new(53.0, 0.0, 0.2), DVec3::splat(0.4));
    build.place(box_there, DVec3::new(58.0, 0.0, 0.0), DVec3::new(0.1, 6.0, 6.0));
    build.point_light(DVec3::new(51.0, 0.8, 0.9));
    find(&mut build.0);
    for technique in [Technique::ZFail, Technique::ExactZPass, Technique::Auto] {
        let settings = Settings { technique, ..seen_from(DVec3::new(0.2, 0.3, 2.5), DVec3::ZERO, [160, 90]) };
        let found = assert_exact(&build.0, &settings);
        assert!(found[0].lit > 300 && found[0].shadow > 300, "{} lit, {} in shadow", found[0].lit, found[0].shadow);
    }
    let mirrors = |mode| Mirrors { mode, ..Mirrors::default() };
    let views = |mode| {
        let settings = Settings { mirrors: mirrors(mode), ..seen_from(DVec3::new(0.2, 0.3, 2.5), DVec3::ZERO, [160, 90]) };
        director::stage(&settings, &build.0, &Capabilities::complete()).unwrap().1.views.len()
    };
    assert_eq!([MirrorMode::Off, MirrorMode::Stencil].map(views), [1, 2]);
}

#[test]
fn doorways_that_lead_nowhere_or_do_not_fit_are_refused() {
    let (mut build, [one, other]) = doors();
    find(&mut build.0);
    let refused = |scene: &Scene| {
        let pose = pose::pose(scene, 0.0, scene.default_animation, &BTreeMap::new());
        scene.mirrors[0].posed(scene, &pose).unwrap_err()
    };
    build.0.mirrors[0].exit = Some(99);
    assert_eq!(refused(&build.0), Refusal::NoExit);
    build.0.mirrors[0].exit = Some(other);
    build.place(0, DVec3::ZERO, DVec3::ONE);
    build.0.nodes[one].local = Transform::Trs { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::splat(2.0) };
    assert_eq!(refused(&build.0), Refusal::Resized);
}

/// By name, in a file; and what is said of a name that no node has.
#[test]
fn files_name_their_doorways() {
    let file = |exit: &str| {
        format!(
            r#"{{"asset": {{"version": "2.0"}}, "scenes": [{{"nodes": [0, 1]}}],
            "nodes": [{{"name": "in", "mesh": 0, "extras": {{"portal": "{exit}"}}}},
                      {{"name": "out", "mesh": 0, "translation": [9, 0, 0], "extras": {{"portal": "in"}}}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
            "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}}],
            "bufferViews": [{{"buffer": 0, "byteLength": 36}}],
            "buffers": [{{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}]}}"#
        )
    };
    let folder = tempfile::tempdir().unwrap();
    let open = |text: String| {
        let path = folder.path().join("doors.gltf");
        std::fs::write(&path, text).unwrap();
        gltf::load(&path).unwrap()
    };
    let scene = open(file("out"));
    assert_eq!(scene.mirrors.iter().map(|mirror| mirror.exit).collect::<Vec<_>>(), [Some(1), Some(0)], "{:?}", scene.warnings);
    let scene = open(file("nowhere"));
    assert!(scene.mirrors.is_empty(), "{:?}", scene.mirrors);
    assert!(scene.warnings.iter().any(|warning| warning.contains("portal")), "{:?}", scene.warnings);
}

#[test]
fn random_views_through_many_doorways_are_exact() {
    let mirrors = Mirrors { bounces: 8, ..Mirrors::default() };
    let request = VerifyRequest {
        settings: Settings { scene: SceneChoice::Stock("portals".into()), mirrors, size: [160, 90], ..Settings::default() },
        techniques: vec![Technique::ZFail, Technique::ExactZPass],
        light: None,
        random: Some((12, 20_261_122)),
        diff: None,
    };
    let report = verify(&request).unwrap();
    println!("{report}");
    assert_eq!(report.broken_promises(), 0, "{report}");
    assert!(report.surfaces.bounces.len() > 4, "{report}");
}
