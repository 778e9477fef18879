//! Cut-outs against exact rays: planar ones are right everywhere, flattened ones as far as they say.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::{Build, Stage, assert_exact, cube, mesh, seen_from};
use glam::{DAffine3, DQuat, DVec3};
use obscura::director;
use obscura::frame::{Capabilities, CutoutShape, Method, Reason};
use obscura::scene::{LightKind, Mesh, Node, Scene, Transform, stock};
use obscura::settings::{Culling, Settings, Show, Technique};
use obscura::truth::Wrong;

const SIZE: [u32; 2] = [192, 108];

/// A square frame in the plane y = 0 about a square hole, its triangles wound either way.
fn frame(material: usize) -> Mesh {
    let square = |half: f32| [[-half, 0.0, -half], [-half, 0.0, half], [half, 0.0, half], [half, 0.0, -half]];
    let corners = [square(1.0), square(0.4)].concat();
    let triangles: Vec<[u32; 3]> =
        (0..4).flat_map(|i| [[i, (i + 1) % 4, 4 + i], [4 + (i + 1) % 4, (i + 1) % 4, 4 + i]]).collect();
    mesh("frame", &corners, &triangles, material)
}

fn place(build: &mut Build, mesh: usize, at: DVec3, lean: f64) {
    let local = DAffine3::from_scale_rotation_translation(DVec3::new(1.3, 1.0, 0.9), DQuat::from_rotation_z(lean), at);
    build.0.nodes.push(Node { name: "placed".into(), mesh: Some(mesh), local: Transform::Affine(local), ..Node::default() });
}

/// Two frames in each other's shadow over a floor, one of them drawn from one side only, and a cube.
fn frames() -> Scene {
    let mut build = Build::new();
    build.floor(0.0, 12.0);
    let (double_sided, single_sided) = (build.mesh(frame(1)), build.mesh(frame(0)));
    place(&mut build, double_sided, DVec3::new(0.0, 2.4, 0.0), 0.5);
    place(&mut build, single_sided, DVec3::new(0.4, 1.2, 0.3), -0.3);
    let cube = build.mesh(cube(0));
    build.place(cube, DVec3::new(2.6, 0.5, -0.6), DVec3::splat(0.5));
    build.point_light(DVec3::new(-1.2, 5.0, 1.0));
    build.light(LightKind::Directional, DVec3::ZERO, DVec3::new(0.5, -1.0, -0.4), 2.0);
    // From below: the other side of both.
    build.point_light(DVec3::new(1.0, 0.3, 0.2));
    build.0
}

fn reasons(scene: &Scene, settings: &Settings) -> Vec<(Method, Reason, Option<CutoutShape>)> {
    let settings = Settings { show: Show::Final, ..settings.clone() };
    let (_, plan) = director::stage(&settings, scene, &Capabilities::complete()).unwrap();
    plan.volumes.iter().map(|volume| (volume.method, volume.reason, volume.cutout.map(|cutout| cutout.shape))).collect()
}

#[test]
fn planar_cut_outs_are_exact_from_every_side() {
    let scene = frames();
    // From outside; from within both shadows; from below, where the sheet is seen from its dark side.
    let views = [
        (DVec3::new(1.5, 4.5, 6.0), DVec3::new(0.2, 1.0, 0.0)),
        (DVec3::new(0.9, 0.5, 0.0), DVec3::new(-2.0, 0.2, -3.0)),
        (DVec3::new(-2.0, 0.3, 2.5), DVec3::new(0.4, 1.9, 0.0)),
    ];
    for (eye, target) in views {
        let settings = Settings { technique: Technique::Cutout, ..seen_from(eye, target, SIZE) };
        assert_exact(&scene, &settings);
        // With what is out of view too.
        let reasons = reasons(&scene, &Settings { culling: Culling { on: false, ..Culling::default() }, ..settings });
        assert_eq!(reasons.len(), 9, "three casters, three lights");
        let planar = reasons.iter().filter(|(_, reason, shape)| *reason == Reason::Planar && *shape == Some(CutoutShape::Planar));
        assert_eq!(planar.count(), 6, "{reasons:?}");
        assert_eq!(reasons.iter().filter(|(_, reason, shape)| *reason == Reason::NotPlanar && shape.is_none()).count(), 3);
    }
}

#[test]
fn a_light_in_the_plane_of_a_cut_out_leaves_it_to_z_fail() {
    let mut build = Build::new();
    build.floor(0.0, 12.0);
    let frame = build.mesh(frame(1));
    build.place(frame, DVec3::new(0.0, 2.0, 0.0), DVec3::ONE);
    build.point_light(DVec3::new(5.0, 2.0, 0.0));
    build.point_light(DVec3::new(5.0, 2.0005, 0.0));
    build.point_light(DVec3::new(5.0, 4.5, 0.0));
    let settings =
        Settings { technique: Technique::Cutout, ..seen_from(DVec3::new(-3.0, 4.0, 5.0), DVec3::new(-1.0, 0.0, 0.0), SIZE) };
    let found: Vec<_> = reasons(&build.0, &settings).iter().map(|(_, reason, _)| *reason).collect();
    assert_eq!(found, [Reason::LightInPlane, Reason::LightInPlane, Reason::Planar]);
    assert_exact(&build.0, &settings);
}

#[test]
fn the_rosette_of_shadowfun_is_a_planar_cut_out_and_exact() {
    let scene = stock::build("shadowfun").unwrap().unwrap();
    let settings = Settings { technique: Technique::Cutout, time: 2.3, size: SIZE, ..Settings::default() };
    assert_exact(&scene, &settings);
    let reasons = reasons(&scene, &settings);
    assert_eq!(reasons.iter().filter(|(_, reason, _)| *reason == Reason::Planar).count(), 2, "for both lamps: {reasons:?}");
}

/// Two stacked cubes joined to one caster, the upper one's shadow falls on the lower; high over a floor.
fn stack() -> Scene {
    let mut build = Build::new();
    build.floor(0.0, 14.0);
    let (lower, mut positions) = (cube(0), Vec::new());
    for (at, half) in [(DVec3::ZERO, 1.0), (DVec3::new(0.3, 2.2, -0.2), 0.6)] {
        positions.extend(lower.positions.iter().map(|p| (p.as_dvec3() * half + at).as_vec3().to_array()));
    }
    let count = lower.positions.len() as u32;
    let triangles = lower.indices.as_chunks::<3>().0.to_vec();
    let both: Vec<_> = triangles.iter().copied().chain(triangles.iter().map(|t| t.map(|i| i + count))).collect();
    let stack = build.mesh(mesh("stack", &positions, &both, 0));
    build.place(stack, DVec3::new(0.0, 5.0, 0.0), DVec3::ONE);
    build.point_light(DVec3::new(1.0, 14.0, 0.6));
    build.light(LightKind::Directional, DVec3::ZERO, DVec3::new(-0.2, -1.0, 0.3), 2.0);
    build.0
}

#[test]
fn flattened_shadows_are_exact_on_receivers_beyond_the_cut_out() {
    let scene = stack();
    // The caster is out of view; in the second the eye is in its shadow.
    for (eye, target) in
        [(DVec3::new(3.0, 3.0, 4.0), DVec3::new(0.0, 0.0, 0.0)), (DVec3::new(-0.4, 1.2, 0.6), DVec3::new(-2.2, 0.0, 2.4))]
    {
        let settings = Settings { technique: Technique::Flattened, ..seen_from(eye, target, SIZE) };
        let found = assert_exact(&scene, &settings);
        assert!(found.iter().all(|light| light.shadow > 300 && light.lit > 300), "{found:.2?}");
        assert!(
            reasons(&scene, &settings)
                .iter()
                .all(|found| *found == (Method::ZFailCompared, Reason::Flattened, Some(CutoutShape::Flattened)))
        );
    }
}

#[test]
fn flattened_casters_lack_their_own_shadow_and_darken_nothing() {
    let scene = stack();
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let settings = seen_from(DVec3::new(4.0, 9.5, 4.0), DVec3::new(0.0, 5.5, 0.0), SIZE);
    let missing = |stage: &mut Stage, technique| {
        let found = stage.verify(&Settings { technique, ..settings.clone() }, &scene);
        assert!(found.iter().flat_map(|light| &light.pixels).all(|pixel| pixel.how == Wrong::Lit), "nothing lit is darkened");
        found.iter().map(|light| light.wrong()).collect::<Vec<_>>()
    };
    assert_eq!(missing(&mut stage, Technique::ZFail), [0, 0]);
    let missing = missing(&mut stage, Technique::Flattened);
    assert!(missing.iter().all(|&count| count > 200), "{missing:?}");
}

#[test]
fn flattened_toys_throw_exact_shadows_on_the_wall() {
    let scene = stock::build("shadowfun").unwrap().unwrap();
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    for time in [0.0, 3.7] {
        // Between the toys and the wall: only the wall is seen.
        let (eye, target) = (DVec3::new(0.2, 2.3, -1.7), DVec3::new(0.0, 2.2, -3.4));
        let settings = Settings { technique: Technique::Flattened, time, ..seen_from(eye, target, SIZE) };
        for light in stage.verify(&settings, &scene) {
            assert!(light.wrong() == 0 && light.shadow > 300, "{light:.3?}");
        }
        let everything = Settings { technique: Technique::Flattened, time, size: SIZE, ..Settings::default() };
        for light in stage.verify(&everything, &scene) {
            assert!(light.pixels.iter().all(|pixel| pixel.how == Wrong::Lit), "nothing lit is darkened");
        }
    }
}

#[test]
fn a_light_in_a_caster_or_close_to_it_is_left_to_z_fail() {
    let mut build = Build::new();
    build.floor(0.0, 12.0);
    let cube = build.mesh(cube(0));
    build.place(cube, DVec3::new(0.0, 2.0, 0.0), DVec3::new(3.0, 0.5, 3.0));
    build.point_light(DVec3::new(0.0, 2.53, 0.0));
    build.point_light(DVec3::new(0.0, 2.2, 0.0));
    build.point_light(DVec3::new(0.0, 9.0, 0.0));
    let settings =
        Settings { technique: Technique::Flattened, ..seen_from(DVec3::new(6.0, 5.0, 6.0), DVec3::new(0.0, 0.0, 0.0), SIZE) };
    let found: Vec<_> = reasons(&build.0, &settings).iter().map(|(_, reason, _)| *reason).collect();
    assert_eq!(found, [Reason::LightTooNear, Reason::LightTooNear, Reason::Flattened]);
}
