//! Two solids put together: what is seen of them, and what is in their shadow, against intervals along exact rays.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::{Build, Stage, assert_exact, cube, mesh, seen_from};
use glam::DVec3;
use obscura::director::stage;
use obscura::frame::validate::validate;
use obscura::frame::{Action, Capabilities, Program, Target, identity_color};
use obscura::scene::{Operands, Scene, Unfit, stock};
use obscura::settings::{Operation, Settings, Show, Technique};
use obscura::truth::World;

const SIZE: [u32; 2] = [160, 100];
const OPERATIONS: [Operation; 4] = [Operation::Union, Operation::Intersection, Operation::AMinusB, Operation::BMinusA];

fn put_together(scene: &Scene, settings: &Settings) -> Scene {
    let combination = scene.combination_at(settings).unwrap();
    let combined = scene.combined(combination);
    assert_eq!(combined.solid.as_ref().unwrap().refusal, None);
    combined
}

/// What is seen, pixel by pixel, against the rays; gives how many decided pixels show A, and B.
fn assert_seen(stage: &mut Stage, scene: &Scene, settings: &Settings) -> [usize; 2] {
    let shot = stage.shoot(&Settings { show: Show::Surfaces, ..settings.clone() }, scene);
    let world = World::new(scene, &shot.pose);
    let traced = world.trace(&shot.plan.views[0].camera, &[], settings.size, 0, &|_| true).unwrap();
    let solid = scene.solid.as_ref().unwrap();
    let colors = [solid.a, solid.b].map(|instance| identity_color(u32::try_from(instance).unwrap() + 1));
    let mut seen = [0; 2];
    let mut decided = 0;
    for y in 0..settings.size[1] {
        for x in 0..settings.size[0] {
            let [r, g, b, _] = shot.image.get_pixel(x, y).0;
            let Some(sighting) = traced.surfaces.pixels()[(y * settings.size[0] + x) as usize] else { continue };
            decided += 1;
            let wanted = sighting.instance.map_or([0; 3], |instance| identity_color(u32::try_from(instance).unwrap() + 1));
            assert_eq!([r, g, b], wanted, "pixel {x}, {y} by {:?}: {sighting:?}", solid.of.operation);
            for (seen, color) in seen.iter_mut().zip(colors) {
                *seen += usize::from([r, g, b] == color);
            }
        }
    }
    assert!(decided * 3 > (settings.size[0] * settings.size[1]) as usize, "only {decided} pixels are decided");
    seen
}

/// The stock scene by another operation.
fn stock_solid(operation: Operation, settings: &mut Settings) -> Scene {
    settings.csg.operation = Some(operation);
    put_together(&stock::build("csg").unwrap().unwrap(), settings)
}

/// From afar, from close by, from within the ball's hollows, from within the knot.
const EYES: [([f64; 3], [f64; 3]); 4] = [
    ([0.45, 2.35, 4.1], [0.0, 1.35, 0.0]),
    ([-1.35, 1.9, 1.1], [0.0, 1.6, 0.0]),
    ([0.0, 1.62, 0.05], [0.6, 1.5, 1.6]),
    ([0.1, 2.9, 0.3], [0.0, 1.5, 0.1]),
];

#[test]
fn what_is_seen_of_hollow_solids_is_what_rays_see() {
    let mut stage = Stage::new();
    for operation in OPERATIONS {
        let mut settings = Settings { size: SIZE, ..Settings::default() };
        let scene = stock_solid(operation, &mut settings);
        stage.set_scene(&scene);
        let mut all = [0; 2];
        for (eye, target) in EYES {
            settings.camera = seen_from(eye.into(), target.into(), SIZE).camera;
            let seen = assert_seen(&mut stage, &scene, &settings);
            all = [0, 1].map(|operand| all[operand] + seen[operand]);
        }
        assert!(all.iter().all(|seen| *seen > 300), "{operation:?} shows {all:?} pixels of A and B");
    }
}

#[test]
fn the_solid_casts_and_receives_shadows_as_rays_have_it() {
    for operation in OPERATIONS {
        let mut settings = Settings { size: SIZE, technique: Technique::ZFail, ..Settings::default() };
        let scene = stock_solid(operation, &mut settings);
        assert_exact(&scene, &settings);
        settings.camera = seen_from(EYES[1].0.into(), EYES[1].1.into(), SIZE).camera;
        settings.technique = Technique::Auto;
        assert_exact(&scene, &settings);
    }
}

/// Two combs of many blades that stand in each other: each side of either lies over a pixel again and again.
fn combs() -> (Scene, Settings) {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for blade in 0..12u32 {
        let x = -1.1 + 0.2 * blade as f32;
        let first = positions.len() as u32;
        for corner in 0..8u32 {
            let at = |axis: u32| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 };
            positions.push([x + 0.06 * at(0), 0.9 * at(1), 0.9 * at(2)]);
        }
        let quads: [[u32; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        triangles.extend(quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|t| t.map(|i| i + first)));
    }
    let mut build = Build::new();
    build.floor(-1.4, 12.0);
    let comb = build.mesh(mesh("comb", &positions, &triangles, 0));
    let a = build.place(comb, DVec3::ZERO, DVec3::ONE);
    let block = build.mesh(cube(0));
    let b = build.place(block, DVec3::new(0.17, 0.31, 0.23), DVec3::new(0.83, 0.71, 0.57));
    build.point_light(DVec3::new(2.3, 5.0, 3.1));
    build.0.operands = Some(Operands { a, b, operation: Operation::AMinusB });
    // Along the blades' row, so that all of them lie one behind the other.
    (build.0, seen_from(DVec3::new(4.6, 1.3, 1.7), DVec3::ZERO, SIZE))
}

#[test]
fn more_layers_than_the_stencil_tells_apart_are_drawn_in_parts_and_stay_right() {
    let mut stage = Stage::new();
    let (scene, mut settings) = combs();
    for operation in OPERATIONS {
        settings.csg.operation = Some(operation);
        let scene = put_together(&scene, &settings);
        stage.set_scene(&scene);
        let mut pictures = Vec::new();
        for bits in [8, 4, 2, 1] {
            settings.counting.bits = bits;
            assert_seen(&mut stage, &scene, &settings);
            let shot = stage.shoot(&Settings { show: Show::Surfaces, ..settings.clone() }, &scene);
            let told = shot.plan.notes.iter().any(|note| note.contains("more layers than"));
            assert_eq!(
                told,
                bits < 5 && operation != Operation::BMinusA || bits < 2 || told && bits < 5,
                "{bits} bits: {:?}",
                shot.plan.notes
            );
            pictures.push(shot.image);
        }
        assert!(pictures.iter().all(|picture| *picture == pictures[0]), "the bits change nothing");
    }
}

#[test]
fn four_samples_and_mirrors_show_the_solid_too() {
    let mut stage = Stage::new();
    let mut settings = Settings { size: SIZE, ..Settings::default() };
    let scene = stock_solid(Operation::AMinusB, &mut settings);
    stage.set_scene(&scene);
    let one = stage.shoot(&settings, &scene).image;
    let four = stage.shoot(&Settings { samples: 4, ..settings.clone() }, &scene).image;
    let differ = one.pixels().zip(four.pixels()).filter(|(a, b)| (0..3).any(|i| a.0[i].abs_diff(b.0[i]) > 40)).count();
    assert!(differ * 20 < one.pixels().len(), "{differ} pixels are another colour by four samples");
    // The floor as a mirror.
    let floor = scene.nodes.iter().position(|node| node.name == "floor").unwrap();
    settings.mirrors.edits = [(obscura::settings::SurfacePlace { node: floor, primitive: 0 }, true)].into();
    let found = stage.verify(&settings, &scene);
    assert!(found.iter().all(|light| light.wrong() == 0 && light.decided > 1000));
}

#[test]
fn a_layer_that_is_not_counted_is_refused() {
    let mut settings = Settings { size: SIZE, ..Settings::default() };
    let scene = stock_solid(Operation::AMinusB, &mut settings);
    let good = stage(&settings, &scene, &Capabilities::complete()).unwrap().1;
    validate(&good).unwrap();
    let of_solid = |target: Target, label: &str| {
        good.steps
            .iter()
            .position(|step| step.label.ends_with(label) && matches!(&step.action, Action::Draw(draw) if draw.target == target))
            .unwrap()
    };
    let without = |step: usize| {
        let mut plan = good.clone();
        plan.steps.remove(step);
        validate(&plan).unwrap_err().what
    };
    assert_eq!(without(of_solid(Target::Solid, "behind it")), "it merges a layer that was not counted");
    assert_eq!(without(of_solid(Target::Solid, "begin")), "it draws into a solid's own target out of turn");
    let mut plan = good.clone();
    let merge = plan
        .steps
        .iter()
        .position(|step| matches!(&step.action, Action::Draw(draw) if draw.program == Program::SolidMerge))
        .unwrap();
    let Action::Draw(draw) = &mut plan.steps[merge].action else { panic!() };
    draw.state.depth.compare = obscura::frame::state::Compare::Always;
    assert!(validate(&plan).unwrap_err().what.starts_with("of layers the nearest is kept"));
}

#[test]
fn what_is_not_closed_can_be_no_operand() {
    let scene = stock::build("teapots").unwrap().unwrap();
    let teapot = scene.nodes.iter().position(|node| node.name.ends_with("teapot")).unwrap();
    assert_eq!(scene.can_be_operand(teapot), Err(Unfit::Open));
    assert_eq!(scene.can_be_operand(9999), Err(Unfit::Missing));
    let scene = stock::build("halo").unwrap().unwrap();
    let bent = scene.nodes.iter().position(|node| node.skin.is_some()).unwrap();
    assert_eq!(scene.can_be_operand(bent), Err(Unfit::Bent));
}

#[test]
fn operands_that_move_against_each_other_are_told_apart() {
    let scene = stock::build("csg").unwrap().unwrap();
    let at = |time: f64| scene.combination_at(&Settings { time, ..Settings::default() }).unwrap();
    assert!(at(0.0).is_like(&at(7.3)), "both turn together");
    let mut moved = at(0.0);
    moved.a_from_b.translation.x += 1e-3;
    assert!(!moved.is_like(&at(0.0)));
    // Off is off, whatever the scene means.
    let mut settings = Settings::default();
    settings.csg.operation = Some(Operation::Off);
    assert_eq!(scene.combination_at(&settings), None);
}
