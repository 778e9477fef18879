//! Clamped volumes: what is counted piece by piece is right by exact rays, and the same by every technique that counts so.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::{Build, Stage, assert_exact, cube, seen_from};
use glam::DVec3;
use obscura::frame::VolumePlan;
use obscura::gpu::readback;
use obscura::scene::Scene;
use obscura::settings::{Backend, Culling, Settings, Show, Technique};
use obscura::techniques::fill;

/// Two layers of cubes high over a floor.
fn layers() -> Scene {
    let mut build = Build::new();
    build.floor(0.0, 40.0);
    let cube = build.mesh(cube(0));
    for (x, y, z) in [(0.0, 10.0, 0.0), (0.0, 24.0, 0.0), (5.0, 10.5, 2.0), (-4.0, 24.0, 3.0), (-5.0, 11.0, -4.0)] {
        build.place(cube, DVec3::new(x, y, z), DVec3::splat(1.2));
    }
    build.point_light(DVec3::new(3.0, 44.0, -2.0));
    build.0
}

/// About the layers, among them, and in their shadows.
const EYES: [[f64; 3]; 6] =
    [[9.0, 9.0, 26.0], [2.0, 2.0, 20.0], [-14.0, 5.3, 12.0], [-0.6, 3.0, 0.3], [0.3, 34.0, 14.2], [-12.0, 17.0, -9.0]];

const COUNTED: [Technique; 4] = [Technique::Auto, Technique::ZFail, Technique::ExactZPass, Technique::OneSided];

fn view(eye: [f64; 3], technique: Technique) -> Settings {
    let culling = Culling { clamping: true, ..Culling::default() };
    Settings { technique, culling, ..seen_from(DVec3::from(eye), DVec3::new(-1.0, 8.0, 0.5), [320, 180]) }
}

fn pieces(volumes: &[VolumePlan]) -> usize {
    volumes.iter().filter(|volume| volume.start.is_some() || volume.closed).count()
}

#[test]
fn pieces_are_right_by_exact_rays_and_alike_by_every_technique() {
    let scene = layers();
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let mut cut = 0;
    for eye in EYES {
        let stencils = COUNTED.map(|technique| {
            let settings = view(eye, technique);
            assert_exact(&scene, &settings);
            let plan = stage.shoot(&Settings { show: Show::Stencil, ..settings }, &scene).plan;
            cut += pieces(&plan.volumes);
            assert_eq!(plan.casters().count(), 5, "a caster's pieces are one volume to the reader");
            stage.stencil()
        });
        let surfaces = stage.shoot(&Settings { show: Show::Shadow, ..view(eye, Technique::ZFail) }, &scene).image;
        for (technique, stencil) in COUNTED.iter().zip(&stencils) {
            let differ =
                surfaces.pixels().zip(stencil.iter().zip(&stencils[1])).filter(|(pixel, (a, b))| pixel.0[0] != 128 && a != b);
            assert_eq!(differ.count(), 0, "{} at {eye:?}", technique.name());
        }
    }
    assert!(cut > 40, "{cut} pieces");
}

#[test]
fn between_two_pieces_the_eye_is_in_none() {
    let scene = layers();
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let [whole, clamped] = [false, true].map(|clamping| {
        let settings = view(EYES[3], Technique::ExactZPass);
        let culling = Culling { clamping, ..settings.culling };
        let plan = stage.shoot(&Settings { culling, ..settings }, &scene).plan;
        plan.volumes.iter().map(|volume| volume.holds_eye).sum::<i32>()
    });
    assert_eq!([whole, clamped], [2, 0], "the volumes of two cubes hold the eye, and none of their pieces");
}

#[test]
fn a_device_finds_the_same_pieces() {
    let scene = layers();
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let mut cut = 0;
    for eye in EYES {
        for technique in COUNTED {
            let settings = view(eye, technique);
            let by_cpu = stage.shoot(&settings, &scene);
            let by_device = stage.shoot(&Settings { silhouettes: Backend::Compute, ..settings }, &scene);
            cut += by_device.plan.volumes.iter().filter(|volume| volume.closed && !volume.silhouette.is_cpu()).count();
            assert!(by_cpu.image == by_device.image, "{} at {eye:?}", technique.name());
        }
    }
    assert!(cut > 10, "{cut} pieces");
}

#[test]
fn what_does_not_know_the_caps_of_pieces_counts_whole_volumes() {
    let scene = layers();
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let mut pieces_of = |settings: &Settings| pieces(&stage.shoot(settings, &scene).plan.volumes);
    for technique in [Technique::ZPass, Technique::PerPolygon, Technique::ZPlus, Technique::Wide, Technique::Parity] {
        assert_eq!(pieces_of(&view(EYES[0], technique)), 0, "{}", technique.name());
    }
    let auto = view(EYES[0], Technique::Auto);
    assert!(pieces_of(&auto) > 0);
    for culling in [Culling { clamping: false, ..auto.culling }, Culling { on: false, ..auto.culling }] {
        assert_eq!(pieces_of(&Settings { culling, ..auto.clone() }), 0);
    }
}

#[test]
fn far_fewer_fragments_are_counted() {
    let scene = layers();
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let mut fragments = |clamping| {
        let auto = view(EYES[0], Technique::Auto);
        let culling = Culling { clamping, footprints: false, ..auto.culling };
        let shot = stage.shoot(&Settings { culling, ..auto }, &scene);
        let counting = fill::counted(&shot.plan).unwrap();
        readback::picture(&stage.context, &mut stage.renderer, &counting, &scene, &shot.pose).unwrap();
        readback::counts(&stage.context, &stage.renderer).unwrap().iter().sum::<f32>()
    };
    let [whole, clamped] = [false, true].map(&mut fragments);
    assert!(clamped < 0.75 * whole, "{clamped} fragments of {whole}");
}
