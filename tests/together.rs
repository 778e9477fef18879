//! Effects together: halos, reflections, planar shadows and solids in one frame, by stencil integers and pixels.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::Stage;
use glam::DVec2;
use obscura::director::stage as stage_plan;
use obscura::frame::{Capabilities, Program, identity_color};
use obscura::headless::render::open;
use obscura::scene::{Scene, stock};
use obscura::settings::{Halos, MirrorMode, Operation, Planar, PlanarMode, SceneChoice, Settings, Show, SurfacePlace, Technique};

const SIZE: [u32; 2] = [240, 135];
/// As [`obscura::frame::stencil`] has it: what has a halo, and how often a pixel glows.
const TAG: u8 = 4;
const ONCE: u8 = 1;

fn node(scene: &Scene, name: &str) -> usize {
    scene.nodes.iter().position(|node| node.name == name).unwrap()
}

/// The pixels that show one of these instances: by itself, and in mirrors.
fn shows(stage: &mut Stage, scene: &Scene, settings: &Settings, wanted: impl Fn(usize) -> bool) -> [Vec<bool>; 2] {
    let shot = stage.shoot(&Settings { show: Show::Surfaces, ..settings.clone() }, scene);
    let count = scene.instances().count();
    [0..count, count..shot.plan.views.len() * count].map(|views| {
        let chosen = views.filter(|number| wanted(number % count));
        let colors: Vec<_> = chosen.map(|number| identity_color(u32::try_from(number).unwrap() + 1)).collect();
        shot.image.pixels().map(|pixel| colors.contains(&[pixel.0[0], pixel.0[1], pixel.0[2]])).collect()
    })
}

/// Where two pictures differ.
fn differs(a: &image::RgbaImage, b: &image::RgbaImage) -> Vec<bool> {
    a.pixels().zip(b.pixels()).map(|(a, b)| a != b).collect()
}

/// K's figure 17 in one frame: objects in halos, the floor's reflection of both, and shadows thrown onto that very floor.
#[test]
fn halos_reflections_and_planar_shadows_are_right_together() {
    let mut stage = Stage::new();
    let scene = stock::build("halo").unwrap().unwrap();
    stage.set_scene(&scene);
    let floor = SurfacePlace { node: node(&scene, "floor"), primitive: 0 };
    for mode in [PlanarMode::StencilBlend, PlanarMode::StencilRelight, PlanarMode::Multi, PlanarMode::Hybrid] {
        let planar = Planar { mode, edits: [(floor, true)].into(), ..Planar::default() };
        let settings = Settings { size: SIZE, time: 1.0, planar, ..Settings::default() };
        // Shadows on the floor are those of exact rays, which would go on from a mirror.
        let mut dull = settings.clone();
        dull.mirrors.mode = MirrorMode::Off;
        for (light, found) in stage.verify(&dull, &scene).iter().enumerate() {
            assert_eq!(found.wrong(), 0, "{mode:?}, light {light}: {:.3?}", found.pixels);
            assert!(found.shadow > 300, "{mode:?}, light {light}: {} in shadow", found.shadow);
        }
        let glowing = scene.glowing(&settings.halos.edits);
        let [objects, reflected] = shows(&mut stage, &scene, &settings, |instance| glowing[instance]);
        let with = stage.shoot(&settings, &scene);
        let stencil = stage.stencil();
        assert!(with.plan.views.len() > 1, "the floor reflects");
        let halos = Halos { edits: glowing_off(&scene), ..Halos::default() };
        let without = stage.shoot(&Settings { halos, ..settings.clone() }, &scene).image;
        let glows = differs(&with.image, &without);
        let (mut glow, mut reflected_glow, mut seen) = (0, 0, [0; 2]);
        for (at, glows) in glows.into_iter().enumerate() {
            // What stands on the floor glows before the floor, and over what that reflects.
            let own = stencil[at] == ONCE;
            assert!(!(glows && objects[at]), "{mode:?}: a halo covers what it is about, pixel {at}");
            assert!(!glows || own || !reflected[at], "{mode:?}: a halo covers what it is about in the mirror, pixel {at}");
            *if own { &mut glow } else { &mut reflected_glow } += usize::from(glows);
            seen = [seen[0] + usize::from(objects[at]), seen[1] + usize::from(reflected[at])];
        }
        assert!(seen.iter().all(|seen| *seen > 150), "{seen:?} pixels show objects, and their reflections");
        assert!(glow > 400 && reflected_glow > 150, "{mode:?}: {glow} pixels glow, {reflected_glow} in the mirror");
        // The shadows are there with the halos: they darken pixels that do not glow just as they do without.
        let bare = Settings { planar: Planar::default(), technique: Technique::None, ..settings.clone() };
        let unshadowed = stage.shoot(&bare, &scene).image;
        let darker = |at: &usize| with.image.as_raw()[at * 4 + 1] + 8 < unshadowed.as_raw()[at * 4 + 1];
        let count = (0..objects.len()).filter(|at| !objects[*at] && stencil[*at] != ONCE).filter(darker).count();
        assert!(count > 300, "{mode:?}: {count} pixels are in shadow");
    }
}

/// Every halo of the scene's own taken away.
fn glowing_off(scene: &Scene) -> std::collections::BTreeMap<usize, bool> {
    (0..scene.nodes.len()).filter(|node| scene.nodes[*node].halo).map(|node| (node, false)).collect()
}

fn solid(operation: Operation) -> (Scene, Settings) {
    let mut settings = Settings { scene: SceneChoice::Stock("csg".into()), size: SIZE, time: 1.0, ..Settings::default() };
    settings.csg.operation = Some(operation);
    (open(&settings).unwrap(), settings)
}

const OPERATIONS: [Operation; 4] = [Operation::Union, Operation::Intersection, Operation::AMinusB, Operation::BMinusA];

#[test]
fn solids_throw_planar_shadows_as_rays_have_it() {
    let mut stage = Stage::new();
    for operation in OPERATIONS {
        let (scene, mut settings) = solid(operation);
        stage.set_scene(&scene);
        for mode in [PlanarMode::StencilBlend, PlanarMode::StencilRelight, PlanarMode::Multi, PlanarMode::Hybrid] {
            let floor = SurfacePlace { node: node(&scene, "floor"), primitive: 0 };
            settings.planar = Planar { mode, edits: [(floor, true)].into(), ..Planar::default() };
            for (light, found) in stage.verify(&settings, &scene).iter().enumerate() {
                assert_eq!(found.wrong(), 0, "{operation:?}, {mode:?}, light {light}: {:.3?}", found.pixels);
                assert!(found.shadow > 300, "{operation:?}, {mode:?}, light {light}: {} in shadow", found.shadow);
            }
        }
    }
}

/// Two solids put together are one object: whichever of them is to glow, the glow is about what is left, and never on it.
#[test]
fn a_halo_surrounds_what_is_left_of_two_solids() {
    let mut stage = Stage::new();
    for operation in OPERATIONS {
        let (scene, mut settings) = solid(operation);
        stage.set_scene(&scene);
        let whole = scene.solid.clone().unwrap();
        let is_solid = |instance: usize| instance == whole.a || instance == whole.b;
        let [left, _] = shows(&mut stage, &scene, &settings, is_solid);
        let without = stage.shoot(&settings, &scene).image;
        for operand in [whole.of.a, whole.of.b] {
            settings.halos.edits = [(operand, true)].into();
            let with = stage.shoot(&settings, &scene).image;
            let (stencil, glows) = (stage.stencil(), differs(&with, &without));
            let place = |at: usize| DVec2::new((at % SIZE[0] as usize) as f64, (at / SIZE[0] as usize) as f64);
            let tagged: Vec<_> = (0..stencil.len()).filter(|at| stencil[*at] == TAG).collect();
            let far = f64::from(settings.halos.width) / 100.0 * f64::from(SIZE[1]) + 2.0;
            let beside =
                |at: usize, of: &[usize]| of.iter().map(|other| place(at).distance(place(*other))).fold(f64::INFINITY, f64::min);
            for at in 0..stencil.len() {
                assert!([0, ONCE, TAG].contains(&stencil[at]));
                assert!(!left[at] || stencil[at] == TAG, "{operation:?}: all of the solid is tagged, pixel {at}");
                assert!(!left[at] || !glows[at], "{operation:?}: a halo covers the solid, pixel {at}");
                assert!(stencil[at] != ONCE || beside(at, &tagged) < far, "{operation:?}: it glows far away, pixel {at}");
            }
            // What was taken away has no halo: nothing is tagged but what is left, and what of that other things hide.
            let seen: Vec<_> = (0..left.len()).filter(|at| left[*at]).collect();
            let elsewhere = tagged.iter().filter(|at| beside(**at, &seen) > 1.5).count();
            assert!(elsewhere * 50 < tagged.len(), "{operation:?}: {elsewhere} of {} tagged pixels show no solid", tagged.len());
            let count = stencil.iter().filter(|value| **value == ONCE).count();
            assert!(seen.len() > 200 && count > 200, "{operation:?}: {} of the solid, {count} glow", seen.len());
        }
    }
}

/// Casting a shadow and having a halo are two things.
#[test]
fn a_solid_that_casts_no_shadow_has_its_halo_and_one_without_a_mesh_says_that_it_has_none() {
    let mut stage = Stage::new();
    for operation in OPERATIONS {
        let (scene, mut settings) = solid(operation);
        let whole = scene.solid.clone().unwrap();
        settings.halos.edits = [(whole.of.a, true)].into();
        stage.set_scene(&scene);
        stage.shoot(&settings, &scene);
        let stencil = stage.stencil();

        let mut apart = stock::build("csg").unwrap().unwrap();
        for operand in [whole.of.a, whole.of.b] {
            apart.nodes[operand].casts_shadow = false;
        }
        let shadowless = apart.combined(apart.combination_at(&settings).unwrap());
        stage.set_scene(&shadowless);
        let plan = stage.shoot(&settings, &shadowless).plan;
        let of_solid = |instance: usize| [Some(whole.a), Some(whole.b), whole.caster].contains(&Some(instance));
        assert!(plan.volumes.iter().all(|volume| !of_solid(volume.instance)), "{operation:?} casts a shadow");
        assert!(stage.stencil() == stencil, "{operation:?}: the halo is that of a solid which casts one");

        // As if the library had given up.
        let notes = |casts: bool, glows: bool| {
            let mut scene = scene.clone();
            if whole.caster.is_some() {
                scene.nodes.pop();
            }
            let whole = scene.solid.as_mut().unwrap();
            (whole.casts, whole.caster, whole.refusal) = (casts, None, Some("the library gave up".into()));
            let mut settings = settings.clone();
            settings.halos.edits = if glows { settings.halos.edits } else { [].into() };
            let plan = stage_plan(&settings, &scene, &Capabilities::complete()).unwrap().1;
            let halos = plan.draws().any(|(_, draw)| draw.program == Program::Halo);
            assert_eq!(halos, glows && operation == Operation::Union, "{operation:?}");
            plan.notes.into_iter().filter(|note| note.starts_with("the solid")).collect::<Vec<_>>()
        };
        if operation != Operation::Union {
            assert_eq!(notes(true, true), ["the solid casts no shadow and has no halo: the library gave up"]);
            assert_eq!(notes(false, true), ["the solid has no halo: the library gave up"]);
            assert_eq!(notes(true, false), ["the solid casts no shadow: the library gave up"]);
            assert!(notes(false, false).is_empty());
        }
    }
}
