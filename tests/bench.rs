//! What the bench counts: fragments of shadow volumes against rays.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{Build, Stage, seen_from, square};
use glam::DVec3;
use obscura::frame::Camera;
use obscura::gpu::readback;
use obscura::scene::LightKind;
use obscura::settings::{Culling, Settings, Technique};
use obscura::techniques::fill;

const SIZE: [u32; 2] = [160, 90];
const EYE: DVec3 = DVec3::new(2.0, 12.0, 5.0);
const TARGET: DVec3 = DVec3::new(0.2, 0.0, 0.1);
/// Heights and half sides, metres, of squares over the target.
const SQUARES: [(f64, f64); 3] = [(0.0, 3.0), (1.5, 2.0), (4.0, 2.5)];

/// How many of the squares the ray through a pixel meets; none where it passes a rim closely.
fn met(camera: &Camera, pixel: [u32; 2]) -> Option<f32> {
    let corners = camera.near_rectangle_of([pixel[0], pixel[1], 1, 1], SIZE);
    let way = corners.iter().sum::<DVec3>() / 4.0 - camera.eye;
    let inside = SQUARES.map(|(height, half)| {
        let at = camera.eye + way * ((height - camera.eye.y) / way.y);
        half - at.x.abs().max(at.z.abs())
    });
    let decided = inside.iter().all(|inside| inside.abs() > 1e-3);
    decided.then(|| inside.iter().filter(|inside| **inside > 0.0).map(|_| 1.0).sum())
}

/// Light that shines along the view throws every volume straight away from the eye, so that on screen each covers its
/// square and nothing else: once with its near end, and once with its sides and its far end. One-sided counting draws both twice, and drops half of the fragments.
#[test]
fn each_fragment_of_a_volume_counts_once() {
    let mut build = Build::new();
    let mesh = build.mesh(square(1));
    for (height, half) in SQUARES {
        build.place(mesh, DVec3::new(0.0, height, 0.0), DVec3::new(half, 1.0, half));
    }
    build.light(LightKind::Directional, EYE, TARGET - EYE, 3.0);
    let scene = build.0;
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    for (technique, faces) in [(Technique::ZFail, 2.0), (Technique::OneSided, 4.0), (Technique::ZPass, 1.0)] {
        let settings =
            Settings { technique, culling: Culling { on: false, ..Culling::default() }, ..seen_from(EYE, TARGET, SIZE) };
        let shot = stage.shoot(&settings, &scene);
        let counting = fill::counted(&shot.plan).unwrap();
        readback::picture(&stage.context, &mut stage.renderer, &counting, &scene, &shot.pose).unwrap();
        let counts = readback::counts(&stage.context, &stage.renderer).unwrap();
        let mut decided = [0; 4];
        for (index, &count) in (0u32..).zip(&counts) {
            let pixel = [index % SIZE[0], index / SIZE[0]];
            let Some(met) = met(&shot.plan.views[0].camera, pixel) else { continue };
            assert_eq!(count, met * faces, "{technique:?}, pixel {pixel:?}");
            decided[met as usize] += 1;
        }
        assert!(decided.iter().all(|pixels| *pixels > 100), "{decided:?}");
    }
}
