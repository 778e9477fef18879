//! Pictures against exact rays.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::{Build, Stage, assert_exact, cube, seen_from};
use glam::DVec3;
use obscura::scene::Scene;
use obscura::settings::{Settings, Technique};

const EXACT: [Technique; 2] = [Technique::ZFail, Technique::ExactZPass];

/// A cube between the light and the eye.
fn eye_in_shadow() -> (Scene, Settings) {
    let mut build = Build::new();
    build.floor(0.0, 30.0);
    let cube = build.mesh(cube(0));
    build.place(cube, DVec3::new(0.0, 6.0, 0.0), DVec3::ONE);
    build.point_light(DVec3::new(0.1, 16.0, 0.2));
    (build.0, seen_from(DVec3::new(0.3, 1.0, 0.2), DVec3::new(5.0, 0.0, -3.0), [160, 90]))
}

#[test]
fn the_exact_techniques_are_exact_with_the_eye_in_shadow() {
    let (scene, settings) = eye_in_shadow();
    for technique in EXACT {
        assert_exact(&scene, &Settings { technique, ..settings.clone() });
    }
}

#[test]
fn z_pass_is_found_wrong_with_the_eye_in_shadow() {
    let (scene, settings) = eye_in_shadow();
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let [ref found] = stage.verify(&Settings { technique: Technique::ZPass, ..settings }, &scene)[..] else { panic!() };
    assert!(found.wrong() > 1000, "{} wrong of {}", found.wrong(), found.decided);
}
