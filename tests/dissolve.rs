//! Pictures that dissolve into others: by the stencil, pixel by pixel.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::Stage;
use obscura::director;
use obscura::frame::Capabilities;
use obscura::frame::validate::validate;
use obscura::headless::render::put_together;
use obscura::scene::{Scene, stock};
use obscura::settings::{Accumulation, Dissolve, MirrorMode, Mirrors, Pattern, SceneChoice, Settings, Technique};

/// Many patterns fit into it, whole.
const SIZE: [u32; 2] = [128, 64];

fn settings(pattern: Pattern, amount: f32) -> Settings {
    let dissolve = Dissolve { into: Some(Technique::None), pattern, amount, ..Dissolve::default() };
    Settings { technique: Technique::ZFail, dissolve, size: SIZE, samples: 4, ..Settings::default() }
}

fn room() -> Scene {
    stock::build("gallery").unwrap().unwrap()
}

/// The share of pixels that have turned is the amount, as far as the pattern has steps for it; and each shows the picture
/// that it should, as it is by itself.
#[test]
fn so_many_pixels_turn_and_each_shows_its_picture() {
    let scene = room();
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let [first, second] = [0.0, 1.0].map(|amount| stage.shoot(&settings(Pattern::Bayer, amount), &scene).image);
    let differ = first.pixels().zip(second.pixels()).filter(|(first, second)| first != second).count();
    assert!(differ > 500, "the pictures differ in {differ} pixels");
    let all = (SIZE[0] * SIZE[1]) as usize;
    let steps = |pattern| match pattern {
        Pattern::Bayer => [0.0, 1.0 / 64.0, 0.25, 0.5, 37.0 / 64.0, 1.0],
        Pattern::BlueNoise => [0.0, 1.0 / 256.0, 0.25, 0.5, 133.0 / 256.0, 1.0],
        Pattern::Checker => [0.0, 0.0, 0.5, 0.5, 0.5, 1.0],
        Pattern::Wipe => [0.0, 1.0 / 128.0, 0.25, 0.5, 97.0 / 128.0, 1.0],
    };
    for pattern in Pattern::ALL {
        for amount in steps(pattern) {
            let shot = stage.shoot(&settings(pattern, amount), &scene);
            let stencil = stage.stencil();
            let turned = stencil.iter().filter(|value| **value & 1 == 1).count();
            assert_eq!(turned as f32 / all as f32, amount, "{pattern:?}");
            for (at, value) in stencil.iter().enumerate() {
                let (x, y) = (at as u32 % SIZE[0], at as u32 / SIZE[0]);
                let expected = if value & 1 == 1 { &second } else { &first };
                assert_eq!(shot.image.get_pixel(x, y), expected.get_pixel(x, y), "{pattern:?} {amount} at {x},{y}");
            }
        }
    }
}

/// Each of the two pictures is the one that its technique draws by itself: here the second flattens
/// silhouettes, so its volumes are not the first one's.
#[test]
fn both_pictures_are_what_their_techniques_draw() {
    let scene = stock::build("shadowfun").unwrap().unwrap();
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let mut pictures = Vec::new();
    for (amount, technique) in [(0.0, Technique::ZFail), (1.0, Technique::Flattened)] {
        let into = Dissolve { into: Some(Technique::Flattened), amount, ..Dissolve::default() };
        let base = Settings { technique: Technique::ZFail, size: [256, 128], ..Settings::default() };
        let mixed = stage.shoot(&Settings { dissolve: into, ..base.clone() }, &scene).image;
        let alone = stage.shoot(&Settings { technique, ..base }, &scene).image;
        // What is drawn by itself may go the shorter way, without a sum of light: its last bits differ.
        let far = mixed.pixels().zip(alone.pixels()).filter(|(a, b)| (0..3).any(|i| a.0[i].abs_diff(b.0[i]) > 2)).count();
        assert_eq!(far, 0, "{technique:?}");
        pictures.push(alone);
    }
    let differ = pictures[0].pixels().zip(pictures[1].pixels()).filter(|(a, b)| a != b).count();
    assert!(differ > 50, "{differ} pixels differ by technique");
}

/// No pattern turns a pixel back as it goes on.
#[test]
fn what_has_turned_stays_turned() {
    let scene = room();
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    for pattern in Pattern::ALL {
        let mut before = vec![0; (SIZE[0] * SIZE[1]) as usize];
        for amount in [0.1, 0.3, 0.6, 0.9] {
            stage.shoot(&settings(pattern, amount), &scene);
            let now: Vec<u8> = stage.stencil().iter().map(|value| value & 1).collect();
            assert!(before.iter().zip(&now).all(|(before, now)| before <= now), "{pattern:?} at {amount}");
            before = now;
        }
    }
}

#[test]
fn pictures_that_cannot_share_their_targets_stay_whole() {
    let scene = room();
    let plan = |settings: &Settings| director::stage(settings, &scene, &Capabilities::complete()).unwrap().1;
    let texture = Mirrors { mode: MirrorMode::Texture, ..Mirrors::default() };
    let whole = plan(&Settings { mirrors: texture, ..settings(Pattern::Bayer, 0.5) });
    assert!(whole.notes.iter().any(|note| note.contains("nothing dissolves")), "{:?}", whole.notes);
    let mixed = plan(&settings(Pattern::Bayer, 0.5));
    assert!(mixed.notes.iter().any(|note| note.contains("1 sample a pixel")), "{:?}", mixed.notes);
    assert_eq!(mixed.samples, 1);
}

/// Two scenes, each with its own eye, lights, mirrors, bits and exposure: each pixel is one scene's or the other's, as many as
/// the amount says, and each picture is what its scene looks like by itself.
#[test]
fn two_scenes_are_mixed_pixel_by_pixel() {
    let mut stage = Stage::new();
    for (one, other, accumulation) in [
        ("gallery", "barbershop", Accumulation::Float),
        ("runway", "gallery", Accumulation::Float),
        ("slabs", "csg", Accumulation::EightBit),
    ] {
        let mut settings = Settings { size: SIZE, time: 1.0, ..Settings::default() };
        settings.lighting.accumulation = accumulation;
        let alone = [one, other].map(|name| {
            let scene = put_together(&settings, stock::build(name).unwrap().unwrap());
            stage.set_scene(&scene);
            stage.shoot(&settings, &scene).image
        });
        settings.dissolve.scene = Some(other.into());
        let scene = put_together(&settings, stock::build(one).unwrap().unwrap());
        stage.set_scene(&scene);
        let mut mixed = |pattern, amount| {
            let dissolve = Dissolve { pattern, amount, ..settings.dissolve.clone() };
            let shot = stage.shoot(&Settings { dissolve, ..settings.clone() }, &scene);
            (shot.image, stage.stencil())
        };
        let whole = [0.0, 1.0].map(|amount| mixed(Pattern::Bayer, amount).0);
        for (whole, alone) in whole.iter().zip(&alone) {
            // What is drawn by itself goes the shorter way where it can, and its background is never kept as light: where
            // that has 8 bits, half a step of it is up to 12.92 / 2 of the picture's.
            let most = if accumulation == Accumulation::Float { 2 } else { 7 };
            let far = whole.pixels().zip(alone.pixels()).filter(|(a, b)| (0..3).any(|i| a.0[i].abs_diff(b.0[i]) > most)).count();
            assert_eq!(far, 0, "{one}, {other}");
        }
        let differ = whole[0].pixels().zip(whole[1].pixels()).filter(|(a, b)| a != b).count();
        assert!(differ * 2 > (SIZE[0] * SIZE[1]) as usize, "{one}, {other}: {differ} pixels differ");
        for (pattern, amount) in
            [(Pattern::Bayer, 37.0 / 64.0), (Pattern::BlueNoise, 0.25), (Pattern::Checker, 0.5), (Pattern::Wipe, 0.75)]
        {
            let (image, stencil) = mixed(pattern, amount);
            let turned = stencil.iter().filter(|value| **value & 1 == 1).count();
            assert_eq!(turned as f32 / stencil.len() as f32, amount, "{one}, {other}, {pattern:?}");
            let pixels = image.pixels().zip(whole[0].pixels().zip(whole[1].pixels()));
            let wrong = pixels
                .zip(&stencil)
                .filter(|((pixel, (first, second)), value)| **pixel != *(if **value & 1 == 1 { *second } else { *first }));
            assert_eq!(wrong.count(), 0, "{one}, {other}, {pattern:?}");
        }
        // It may dissolve into another technique as well; and without, the first scene is as it was.
        let dissolve = Dissolve { into: Some(Technique::None), amount: 1.0, ..settings.dissolve.clone() };
        let unshadowed = stage.shoot(&Settings { dissolve, ..settings.clone() }, &scene).image;
        assert!(unshadowed != whole[1], "{other} without shadows");
        let off = stage.shoot(&Settings { dissolve: Dissolve::default(), ..settings }, &scene).image;
        assert!(off == alone[0], "{one} alone, beside {other}");
    }
}

#[test]
fn the_first_of_two_scenes_makes_no_picture_by_itself() {
    let mut settings = Settings { size: SIZE, ..Settings::default() };
    settings.dissolve.scene = Some("slabs".into());
    let plan = |settings: &Settings, scene: &Scene| director::stage(settings, scene, &Capabilities::complete()).unwrap().1;
    let missing = plan(&settings, &room());
    assert!(missing.then.is_none() && missing.notes.iter().any(|note| note.contains("the scene slabs is not open")));
    let scene = put_together(&settings, room());
    assert_eq!(scene.partner.as_ref().unwrap().name, "slabs");
    let good = plan(&settings, &scene);
    assert_eq!((validate(&good), good.pictures().count()), (Ok(()), 2));
    let mut alone = good.clone();
    alone.then = None;
    assert!(validate(&alone).unwrap_err().what.contains("without a picture"));
    let mut spoiled = good.clone();
    spoiled.then.as_mut().unwrap().steps.pop();
    assert!(validate(&spoiled).unwrap_err().what.contains("without a picture"), "the second is checked as well");
    let texture = Mirrors { mode: MirrorMode::Texture, ..Mirrors::default() };
    let whole = plan(&Settings { mirrors: texture, ..settings.clone() }, &scene);
    assert!(whole.then.is_none() && whole.notes.iter().any(|note| note.contains("nothing dissolves")), "{:?}", whole.notes);
    settings.scene = SceneChoice::Stock("gallery".into());
    let command = obscura::cli::render_command(&settings);
    assert!(command.contains("--dissolve-scene slabs"), "{command}");
}
