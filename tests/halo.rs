//! Halos by stencil integers and pixels: never on what they are about, no pixel twice, whatever the shape; in mirrors
//! too.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::{Build, Stage, cube, seen_from, square};
use glam::DVec3;
use obscura::director::stage;
use obscura::frame::validate::validate;
use obscura::frame::{Action, Capabilities, DrawSet, FramePlan, Program, identity_color};
use obscura::scene::{Material, Reflective, Scene, stock};
use obscura::settings::{Settings, Shading, Show};

const SIZE: [u32; 2] = [240, 160];
/// As [`obscura::frame::stencil`] has it: what has a halo, and how often a pixel glows.
const TAG: u8 = 4;
const ONCE: u8 = 1;

/// A ring, which has a hollow, and a cube that cuts into its glow, before nothing.
fn ring_and_cube() -> (Scene, Settings) {
    let toys = stock::build("shadowfun").unwrap().unwrap();
    let ring = toys.nodes.iter().find(|node| node.name == "torus").unwrap();
    let mut build = Build::new();
    build.0.materials.push(toys.materials[toys.meshes[ring.mesh.unwrap()].primitives[0].material].clone());
    let mut mesh = toys.meshes[ring.mesh.unwrap()].clone();
    mesh.primitives.iter_mut().for_each(|primitive| primitive.material = 2);
    let mesh = build.mesh(mesh);
    build.place(mesh, DVec3::ZERO, DVec3::ONE);
    let cube = build.mesh(cube(0));
    build.place(cube, DVec3::new(0.85, 0.5, 0.3), DVec3::splat(0.2));
    build.point_light(DVec3::new(2.0, 3.0, 4.0));
    build.point_light(DVec3::new(-2.0, 3.0, 4.0));
    let mut settings = seen_from(DVec3::new(0.0, 1.2, 2.2), DVec3::new(0.2, 0.0, 0.0), SIZE);
    settings.halos.edits = [(0, true), (1, true)].into();
    settings.halos.width = 6.0;
    // What has halos is drawn forward: so is what it is compared with.
    settings.lighting.shading = Shading::Forward;
    (build.0, settings)
}

/// The pixels that show an instance, in any view.
fn shows(stage: &mut Stage, scene: &Scene, settings: &Settings, chosen: &[u32]) -> Vec<bool> {
    let shot = stage.shoot(&Settings { show: Show::Surfaces, ..settings.clone() }, scene);
    let count = u32::try_from(scene.instances().count()).unwrap();
    let views = u32::try_from(shot.plan.views.len()).unwrap();
    let numbers = (0..views).flat_map(|view| chosen.iter().map(move |instance| view * count + instance + 1));
    let colors: Vec<_> = numbers.map(identity_color).collect();
    shot.image.pixels().map(|pixel| colors.contains(&[pixel.0[0], pixel.0[1], pixel.0[2]])).collect()
}

#[test]
fn a_halo_is_never_on_its_object_and_no_pixel_glows_twice() {
    let (scene, settings) = ring_and_cube();
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let object = shows(&mut stage, &scene, &settings, &[0, 1]);
    let bare = Settings { halos: obscura::settings::Halos::default(), ..settings.clone() };
    let without = stage.shoot(&bare, &scene).image;
    let with = stage.shoot(&settings, &scene).image;
    let stencil = stage.stencil();
    assert!(stencil.iter().all(|value| [0, ONCE, TAG].contains(value)), "glows once or not at all, and never on an object");
    for (at, value) in stencil.iter().enumerate() {
        assert_eq!(*value == TAG, object[at], "all of the object is tagged, and nothing else: pixel {at}");
        let (before, after) = (without.as_raw()[at * 4..at * 4 + 4].to_vec(), with.as_raw()[at * 4..at * 4 + 4].to_vec());
        match *value {
            // Blue goes down where an amber glow covers a dark ground that is bluish; red goes up in any case.
            ONCE => assert!(after[0] >= before[0], "{before:?} {after:?}"),
            _ => assert_eq!(before, after, "pixel {at} has no halo and is as it was"),
        }
    }
    // As wide as was asked for: 6 % of the height, all around, in the hollow of the ring as well.
    let width = 0.06 * f64::from(SIZE[1]);
    let place = |at: usize| DVec3::new((at % SIZE[0] as usize) as f64, (at / SIZE[0] as usize) as f64, 0.0);
    let objects: Vec<_> = (0..stencil.len()).filter(|&at| stencil[at] == TAG).map(place).collect();
    for (at, value) in stencil.iter().enumerate() {
        let nearest = objects.iter().map(|object| object.distance(place(at))).fold(f64::INFINITY, f64::min);
        match *value {
            ONCE => assert!(nearest < width + 2.0, "{nearest} pixels beside the object, pixel {at}"),
            // The cube's corners are cut off where its faces' copies have theirs.
            0 => assert!(nearest > width * 0.5, "dark {nearest} pixels beside the object, pixel {at}"),
            _ => {}
        }
    }
    let middle = (SIZE[1] / 2 * SIZE[0] + SIZE[0] / 2) as usize;
    assert!(stencil.iter().filter(|value| **value == ONCE).count() > 2000 && stencil[middle] != TAG);
}

#[test]
fn what_stands_before_a_halo_hides_it() {
    let (mut scene, settings) = ring_and_cube();
    let mut build = Build(std::mem::take(&mut scene));
    let shield = build.mesh(cube(0));
    let node = build.place(shield, DVec3::new(-0.4, 0.5, 1.2), DVec3::new(0.3, 0.6, 0.05));
    let scene = build.0;
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let shield = scene.instances().position(|(index, ..)| index == node).unwrap();
    let before = shows(&mut stage, &scene, &settings, &[u32::try_from(shield).unwrap()]);
    stage.shoot(&settings, &scene);
    let stencil = stage.stencil();
    let on = |value: u8| stencil.iter().zip(&before).filter(|(stored, shield)| **shield && **stored == value).count();
    assert!(on(TAG) > 100 && on(ONCE) == 0, "{} tagged, {} glow before the shield", on(TAG), on(ONCE));
}

#[test]
fn halos_are_seen_in_mirrors_and_cover_nothing_there() {
    let mut build = Build::new();
    let look = Reflective { reflectivity: 0.8, tint: glam::Vec3::ONE };
    build.0.materials.push(Material { mirror: Some(look), ..Material::default() });
    let glass = build.mesh(square(2));
    build.place(glass, DVec3::ZERO, DVec3::new(6.0, 1.0, 6.0));
    let mesh = build.mesh(cube(0));
    let object = build.place(mesh, DVec3::new(0.0, 1.4, 0.0), DVec3::splat(0.4));
    build.point_light(DVec3::new(2.0, 4.0, 3.0));
    build.point_light(DVec3::new(-3.0, 4.0, 3.0));
    let mut scene = build.0;
    let mirror = obscura::scene::Mirror::of(&scene, 0, 0, look).unwrap();
    scene.mirrors.push(mirror);
    let mut settings = seen_from(DVec3::new(0.0, 2.0, 5.0), DVec3::new(0.0, 0.3, 0.0), SIZE);
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let cubes = shows(&mut stage, &scene, &settings, &[1]);
    let without = stage.shoot(&settings, &scene).image;
    settings.halos.edits = [(object, true)].into();
    let shot = stage.shoot(&settings, &scene);
    assert_eq!(shot.plan.views.len(), 2);
    let same = |at: usize| without.as_raw()[at * 4..at * 4 + 4] == shot.image.as_raw()[at * 4..at * 4 + 4];
    let (mut on_cubes, mut above, mut below) = (0, 0, 0);
    for (at, shows_cube) in cubes.iter().enumerate() {
        if *shows_cube {
            assert!(same(at), "a halo covers what it is about, pixel {at}");
            on_cubes += 1;
        } else if !same(at) {
            *if at < cubes.len() / 2 { &mut above } else { &mut below } += 1;
        }
    }
    assert!(on_cubes > 1000 && above > 300 && below > 300, "{on_cubes} of cubes, {above} glow above, {below} in the mirror");
}

/// The plan of [`ring_and_cube`], and the steps of one program in it.
fn planned() -> (FramePlan, Vec<usize>) {
    let (scene, settings) = ring_and_cube();
    let plan = stage(&settings, &scene, &Capabilities::complete()).unwrap().1;
    let is_shell = |step: &obscura::frame::Step| matches!(&step.action, Action::Draw(draw) if draw.program == Program::Halo);
    let shells = (0..plan.steps.len()).filter(|&step| is_shell(&plan.steps[step])).collect();
    (plan, shells)
}

#[test]
fn shells_are_drawn_from_the_narrowest_to_the_widest() {
    let (plan, shells) = planned();
    let widths: Vec<_> = plan
        .draws()
        .filter_map(|(_, draw)| if let DrawSet::Swollen(swollen) = &draw.set { Some(swollen.pixels) } else { None })
        .collect();
    assert!(shells.len() >= 4 && widths.is_sorted() && widths[0] > 0.0, "{widths:?}");
    assert!((widths[widths.len() - 1] - 0.06 * 160.0).abs() < 1e-3);
}

#[test]
fn a_plan_whose_halo_could_cover_its_object_is_refused() {
    let (good, shells) = planned();
    validate(&good).unwrap();
    let tagged = good.steps.iter().position(|step| step.label.starts_with("tag for halos")).unwrap();
    let mut plan = good.clone();
    plan.steps.retain(|step| !step.label.starts_with("tag for halos"));
    assert_eq!(validate(&plan).unwrap_err().what, "a halo is drawn before its object is tagged");
    let mut plan = good.clone();
    let Action::Draw(draw) = &mut plan.steps[shells[1]].action else { panic!() };
    draw.state.stencil.front.compare = obscura::frame::state::Compare::Always;
    assert!(validate(&plan).unwrap_err().what.starts_with("a halo is drawn where neither"));
    let mut plan = good.clone();
    plan.steps.remove(tagged - 1);
    assert_eq!(validate(&plan).unwrap_err().what, "it tags for halos while the stencil holds a count");
}
