//! Early and deferred shading against the forward form: the same stencil to the last bit; drawn early the same picture to the
//! last bit, too, deferred but for a step of 255 or two, which 16-bit floats make of normals and base colours.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::Stage;
use obscura::director::stage;
use obscura::frame::state::Depth;
use obscura::frame::validate::validate;
use obscura::frame::{Action, Capabilities, Draw, Program, Target};
use obscura::scene::{Scene, stock};
use obscura::settings::{Settings, Shading, Technique};

fn settings(shading: Shading) -> Settings {
    let mut settings = Settings { size: [320, 180], ..Settings::default() };
    settings.lighting.shading = shading;
    // Surfaces as any others.
    settings.mirrors.mode = obscura::settings::MirrorMode::Off;
    settings
}

fn programs(settings: &Settings, scene: &Scene) -> Vec<Program> {
    stage(settings, scene, &Capabilities::complete()).unwrap().1.draws().map(|(_, draw)| draw.program).collect()
}

/// Textures, highlights, two sides, unlit and masked surfaces; points, spots, directional lights; one to four lights.
#[test]
fn the_picture_is_the_forward_one() {
    for name in ["courtyard", "cathedral", "teapots", "shadowfun", "eye-in-shadow", "barbershop", "cubes"] {
        let scene = stock::build(name).unwrap().unwrap();
        let mut device = Stage::new();
        device.set_scene(&scene);
        let forward = device.shoot(&settings(Shading::Forward), &scene);
        let deferred = device.shoot(&settings(Shading::Deferred), &scene);
        assert!(programs(&settings(Shading::Deferred), &scene).contains(&Program::Shade), "{name} is not shaded pixel by pixel");
        assert!(!programs(&settings(Shading::Forward), &scene).contains(&Program::Shade));
        let differ = |a: &image::Rgba<u8>, b: &image::Rgba<u8>| (0..4).map(|part| a[part].abs_diff(b[part])).max().unwrap();
        let steps: Vec<_> = forward.image.pixels().zip(deferred.image.pixels()).map(|(a, b)| differ(a, b)).collect();
        let worst = steps.iter().max().unwrap();
        // What is lit in one and dark in the other differs by far more.
        assert!(*worst <= 4, "{name}: a pixel differs by {worst} steps");
        let few = steps.iter().filter(|&&step| step > 1).count();
        assert!(few * 2000 < steps.len(), "{name}: {few} pixels differ by more than a step");
    }
}

/// One light, seen from the light and from the shadow; textures, highlights, two sides, masked surfaces.
#[test]
fn drawn_early_the_picture_is_the_forward_one_to_the_last_bit() {
    for (name, eye_in_shadow) in [("cubes", false), ("shadowfun", false), ("teapots", false), ("eye-in-shadow", true)] {
        let mut scene = stock::build(name).unwrap().unwrap();
        scene.lights.truncate(1);
        let mut device = Stage::new();
        device.set_scene(&scene);
        let forward = device.shoot(&settings(Shading::Forward), &scene);
        let stencil = device.stencil();
        let early = device.shoot(&settings(Shading::Early), &scene);
        assert_eq!(device.stencil(), stencil, "{name}");
        let differ = forward.image.pixels().zip(early.image.pixels()).filter(|(a, b)| a != b).count();
        assert_eq!(differ, 0, "{name}: pixels differ");
        let walks = |shot: &common::Shot| {
            shot.plan.draws().filter(|(_, draw)| matches!(draw.set, obscura::frame::DrawSet::Surfaces(_))).count()
        };
        assert!(walks(&early) < walks(&forward), "{name}: {} walks over surfaces", walks(&early));
        let first = early.plan.draws().map(|(_, draw)| draw.program).find(|program| *program != Program::DepthMasked);
        let expected = if eye_in_shadow { Program::Ambient } else { Program::Lit };
        assert_eq!(first, Some(expected), "{name}: the colour that most surfaces keep comes first");
    }
}

#[test]
fn the_stencil_is_the_forward_one() {
    let scene = stock::build("cubes").unwrap().unwrap();
    for technique in [Technique::ZPass, Technique::ZFail, Technique::ExactZPass, Technique::Auto, Technique::Wide] {
        let mut device = Stage::new();
        device.set_scene(&scene);
        let stencils = [Shading::Forward, Shading::Early, Shading::Deferred].map(|shading| {
            device.shoot(&Settings { technique, ..settings(shading) }, &scene);
            device.stencil()
        });
        assert!(stencils[0].iter().any(|count| *count != 0));
        assert_eq!(stencils[0], stencils[1], "early, {}", technique.name());
        assert_eq!(stencils[0], stencils[2], "deferred, {}", technique.name());
    }
}

/// By itself only where it pays: for many triangles, or several lights.
#[test]
fn auto_takes_it_where_it_pays() {
    let deferred = |name: &str| {
        let scene = stock::build(name).unwrap().unwrap();
        programs(&settings(Shading::Auto), &scene).contains(&Program::Shade)
    };
    assert!(!deferred("cubes"), "75 cubes in one light");
    let cubes = stock::build("cubes").unwrap().unwrap();
    let [auto, early] = [Shading::Auto, Shading::Early].map(|shading| programs(&settings(shading), &cubes));
    assert_eq!(auto, early, "they are drawn early");
    assert!(deferred("eye-in-shadow"), "two lights");
}

/// Each light is counted, leaves its bit, and all are shaded by one step: no surface is drawn twice.
#[test]
fn surfaces_are_drawn_once() {
    let scene = stock::build("courtyard").unwrap().unwrap();
    let (_, plan) = stage(&settings(Shading::Deferred), &scene, &Capabilities::complete()).unwrap();
    let lights = plan.draws().filter(|(_, draw)| draw.program == Program::MarkDark).count();
    assert!((2..=4).contains(&lights), "{lights} lights leave bits");
    assert_eq!(plan.draws().filter(|(_, draw)| draw.program == Program::Shade).count(), 1);
    let mut walks = plan.draws().filter(|(_, draw)| matches!(draw.set, obscura::frame::DrawSet::Surfaces(_)));
    assert!(walks.all(|(_, draw)| draw.target == Target::Geometry), "surfaces are drawn for nothing else");
}

#[test]
fn validation_knows_what_may_be_shaded() {
    let scene = stock::build("courtyard").unwrap().unwrap();
    let (_, good) = stage(&settings(Shading::Deferred), &scene, &Capabilities::complete()).unwrap();
    let fault = |change: &dyn Fn(&mut Vec<obscura::frame::Step>)| {
        let mut plan = good.clone();
        change(&mut plan.steps);
        validate(&plan).unwrap_err().what
    };
    let program = |step: &obscura::frame::Step| match &step.action {
        Action::Draw(draw) => Some(draw.program),
        _ => None,
    };
    let without = |unwanted: Program| fault(&|steps| steps.retain(|step| program(step) != Some(unwanted)));
    assert!(without(Program::Geometry).contains("before colour and depth"), "without the walk that keeps them there is nothing");
    assert!(without(Program::MarkDark).contains("bits of lights that left none"));
    let changed = |wanted: Program, change: &dyn Fn(&mut Draw)| {
        fault(&|steps| {
            let draws = steps.iter_mut().filter_map(|step| match &mut step.action {
                Action::Draw(draw) if draw.program == wanted => Some(draw),
                _ => None,
            });
            draws.for_each(|draw| change(draw));
        })
    };
    assert!(changed(Program::MarkDark, &|draw| draw.constant[0] = 1.0 / 255.0).contains("no other light"));
    assert!(changed(Program::MarkDark, &|draw| draw.constant[0] = 0.5 / 255.0).contains("a bit each"));
    assert!(changed(Program::Shade, &|draw| draw.state.depth = Depth::LAY).contains("neither depth nor stencil"));
    assert!(changed(Program::Geometry, &|draw| draw.state.depth = Depth::SAME_SURFACE).contains("with their depth"));
}

#[test]
fn what_cannot_be_deferred_says_why_and_is_drawn_forward() {
    let scene = stock::build("cubes").unwrap().unwrap();
    let mut far = settings(Shading::Deferred);
    far.far = Some(100.0);
    let mut samples = settings(Shading::Deferred);
    samples.samples = 4;
    for settings in [far, samples] {
        let (_, plan) = stage(&settings, &scene, &Capabilities::complete()).unwrap();
        assert!(plan.notes.iter().any(|note| note.starts_with("no deferred shading here: ")), "{:?}", plan.notes);
        assert!(plan.draws().all(|(_, draw)| draw.program != Program::Shade));
    }
    let several = stock::build("courtyard").unwrap().unwrap();
    for (scene, early) in [(&scene, true), (&several, false)] {
        let (_, plan) = stage(&settings(Shading::Early), scene, &Capabilities::complete()).unwrap();
        assert_eq!(plan.notes.iter().any(|note| note.starts_with("no early shading here: ")), !early);
    }
}
