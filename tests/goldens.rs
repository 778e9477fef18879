//! Each stock scene drawn with each technique, and one with each show, against pictures in
//! `tests/goldens/`.
//!
//! A picture that is missing fails; `OBSCURA_UPDATE=1 cargo test --test goldens` writes them anew:
//! look at them before committing. What differs is written to `target/tmp/`.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use std::path::{Path, PathBuf};

use common::Stage;
use glam::DVec3;
use image::RgbaImage;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use obscura::figures;
use obscura::headless::render::open;
use obscura::scene::stock;
use obscura::settings::{
    HybridPart, LightEdit, MirrorLight, MirrorMode, Mirrors, Operation, PlanarMode, Settings, Show, Technique,
};

const SIZE: [u32; 2] = [240, 135];

/// Of the papers' figures.
const FIGURE_SIZE: [u32; 2] = [640, 360];

/// THE tolerance. Between hosts, LLVM schedules the same shader differently, and colours differ in
/// the last bits: up to [`LEVELS`] of 255 after the tone curve's steep dark end. Vertex positions
/// differ likewise, so that a silhouette may pass on the other side of a pixel's centre: up to
/// [`EDGES`] of a picture's pixels may then show something else altogether. A wrong count anywhere
/// is an area, and far more than that.
const LEVELS: u8 = 5;
const EDGES: f64 = 0.0015;

/// As small as it gets: no picture here is transparent anywhere.
fn save(path: &Path, picture: &RgbaImage) {
    assert!(picture.pixels().all(|pixel| pixel.0[3] == 255), "{}", path.display());
    let rgb = image::DynamicImage::from(picture.clone()).into_rgb8();
    let file = std::io::BufWriter::new(std::fs::File::create(path).unwrap());
    let encoder = PngEncoder::new_with_quality(file, CompressionType::Best, FilterType::Adaptive);
    rgb.write_with_encoder(encoder).unwrap();
}

fn compare(name: &str, found: &RgbaImage) -> Result<(), String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/goldens").join(format!("{name}.png"));
    if std::env::var_os("OBSCURA_UPDATE").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        save(&path, found);
    }
    let golden = image::open(&path).map_err(|error| format!("{}: {error}", path.display()))?.to_rgba8();
    if golden.dimensions() != found.dimensions() {
        return Err(format!("{name}: {:?} instead of {:?}", found.dimensions(), golden.dimensions()));
    }
    let differs = |a: &image::Rgba<u8>, b: &image::Rgba<u8>| (0..4).any(|i| a.0[i].abs_diff(b.0[i]) > LEVELS);
    let wrong = golden.pixels().zip(found.pixels()).filter(|(a, b)| differs(a, b)).count();
    let share = wrong as f64 / f64::from(found.width() * found.height());
    if share <= EDGES {
        return Ok(());
    }
    let kept: PathBuf = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.png"));
    found.save(&kept).unwrap();
    Err(format!("{name}: {wrong} pixels differ ({:.2} %); found {}", share * 100.0, kept.display()))
}

/// The other techniques are held to these by their stencil values.
const BASIC: [Technique; 4] = [Technique::None, Technique::ZPass, Technique::ZFail, Technique::ExactZPass];

#[test]
fn every_stock_scene_and_technique_looks_as_it_did() {
    let mut stage = Stage::new();
    let mut faults = Vec::new();
    for row in stock::TABLE {
        let scene = stock::build(row.name).unwrap().unwrap();
        stage.set_scene(&scene);
        // Of the scenes with mirrors one picture is enough: what is counted there is counted in the others.
        for technique in BASIC.into_iter().filter(|technique| scene.mirrors.is_empty() || *technique == Technique::ZFail) {
            let settings = Settings { technique, size: SIZE, time: 1.0, ..Settings::default() };
            let shot = stage.shoot(&settings, &scene);
            faults.extend(compare(&format!("{}-{}", row.name, technique.name()), &shot.image).err());
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// How reflections are drawn: of every scene with mirrors, by every mode but the default, which the scenes' own pictures
/// have; what is shown of mirrors alone; and light off mirrors.
#[test]
fn every_mirror_mode_looks_as_it_did() {
    let mut stage = Stage::new();
    let mut faults = Vec::new();
    for row in stock::TABLE {
        let scene = stock::build(row.name).unwrap().unwrap();
        if scene.mirrors.is_empty() {
            continue;
        }
        stage.set_scene(&scene);
        let mut settings = Settings { technique: Technique::Auto, size: SIZE, time: 1.0, ..Settings::default() };
        for show in [Show::Views, Show::Birdseye] {
            let shot = stage.shoot(&Settings { show, ..settings.clone() }, &scene);
            faults.extend(compare(&format!("{}-{}", row.name, show.name()), &shot.image).err());
        }
        for light in [MirrorLight::Ambient, MirrorLight::Virtual] {
            let mirrors = Mirrors { light, ..Mirrors::default() };
            let shot = stage.shoot(&Settings { mirrors, ..settings.clone() }, &scene);
            faults.extend(compare(&format!("{}-light-{}", row.name, light.name()), &shot.image).err());
        }
        for mode in MirrorMode::ALL.into_iter().filter(|mode| *mode != MirrorMode::default()) {
            settings.mirrors.mode = mode;
            let shot = stage.shoot(&settings, &scene);
            faults.extend(compare(&format!("{}-mirrors-{}", row.name, mode.name()), &shot.image).err());
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn every_planar_mode_looks_as_it_did() {
    let mut stage = Stage::new();
    let mut faults = Vec::new();
    let scene = stock::build("figure7").unwrap().unwrap();
    stage.set_scene(&scene);
    let mut settings = Settings { size: SIZE, time: 1.0, ..Settings::default() };
    for mode in PlanarMode::ALL.into_iter().filter(|mode| *mode != PlanarMode::Off) {
        settings.planar.mode = mode;
        let shot = stage.shoot(&settings, &scene);
        faults.extend(compare(&format!("figure7-planar-{}", mode.name()), &shot.image).err());
    }
    for part in [HybridPart::Volumes, HybridPart::Planar] {
        settings.planar.hybrid = part;
        let shot = stage.shoot(&settings, &scene);
        faults.extend(compare(&format!("figure7-planar-hybrid-{}", part.name()), &shot.image).err());
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn every_show_looks_as_it_did() {
    let mut stage = Stage::new();
    let mut faults = Vec::new();
    let scene = stock::build("cubes").unwrap().unwrap();
    stage.set_scene(&scene);
    // Where the lines of the view from above must be is told by tests/bounds.rs, and what mirrors show by the scenes that
    // have some.
    let others = |show: &Show| !matches!(show, Show::Final | Show::Bounds | Show::Birdseye);
    for show in Show::ALL.into_iter().filter(others) {
        let settings = Settings { show, size: SIZE, time: 1.0, ..Settings::default() };
        let shot = stage.shoot(&settings, &scene);
        faults.extend(compare(&format!("show-{}", show.name()), &shot.image).err());
    }
    // Large enough for its legend.
    let settings = Settings { show: Show::Complexity, size: [480, 270], time: 1.0, ..Settings::default() };
    faults.extend(compare("show-complexity-legend", &stage.shoot(&settings, &scene).image).err());
    let mut settings = Settings { show: Show::Playground, size: [480, 270], ..Settings::default() };
    settings.playground.numbers = true;
    faults.extend(compare("show-playground-numbers", &stage.shoot(&settings, &scene).image).err());
    let settings = Settings { samples: 4, size: SIZE, time: 1.0, ..Settings::default() };
    faults.extend(compare("cubes-4-samples", &stage.shoot(&settings, &scene).image).err());
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Kilgard's figure 19, and halos about something else.
#[test]
fn every_operation_on_solids_looks_as_it_did() {
    let mut stage = Stage::new();
    let mut faults = Vec::new();
    let scene = stock::build("csg").unwrap().unwrap();
    for operation in Operation::ALL.into_iter().filter(|operation| *operation != Operation::Off) {
        let mut settings = Settings { size: SIZE, time: 1.0, ..Settings::default() };
        settings.csg.operation = Some(operation);
        let scene = scene.combined(scene.combination_at(&settings).unwrap());
        stage.set_scene(&scene);
        faults.extend(compare(&format!("csg-{}", operation.name()), &stage.shoot(&settings, &scene).image).err());
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Every figure of the papers, with one sample a pixel.
#[test]
fn every_figure_looks_as_it_did() {
    let mut stage = Stage::new();
    let mut faults = Vec::new();
    for figure in figures::TABLE.iter() {
        let settings = figure.settings(&Settings { size: FIGURE_SIZE, ..Settings::default() });
        let scene = open(&settings).unwrap();
        stage.set_scene(&scene);
        faults.extend(compare(&format!("figure-{}", figure.name), &stage.shoot(&settings, &scene).image).err());
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The tolerance lets no shadow go: without its shadows every scene fails.
#[test]
fn the_tolerance_sees_a_missing_shadow() {
    if std::env::var_os("OBSCURA_UPDATE").is_some() {
        return; // would overwrite the goldens with pictures without shadows
    }
    let mut stage = Stage::new();
    for row in stock::TABLE {
        let scene = stock::build(row.name).unwrap().unwrap();
        stage.set_scene(&scene);
        let settings = Settings { technique: Technique::None, size: SIZE, time: 1.0, ..Settings::default() };
        let shot = stage.shoot(&settings, &scene);
        assert!(compare(&format!("{}-z-fail", row.name), &shot.image).is_err(), "{}", row.name);
    }
}

/// `show shadow` holds three values and no others, whatever the sample setting, and the verdict is
/// the stencil's.
#[test]
fn shows_of_exact_values_are_exact() {
    let mut stage = Stage::new();
    let scene = stock::build("cubes").unwrap().unwrap();
    stage.set_scene(&scene);
    let settings = Settings { show: Show::Shadow, samples: 4, size: SIZE, ..Settings::default() };
    let verdict = stage.shoot(&settings, &scene).image;
    let counts = stage.stencil();
    let mut seen = [0usize; 3];
    for (pixel, count) in verdict.pixels().zip(counts) {
        match pixel.0 {
            [255, 255, 255, 255] => {
                assert_eq!(count, 0);
                seen[0] += 1;
            }
            [0, 0, 0, 255] => {
                assert_ne!(count, 0);
                seen[1] += 1;
            }
            [128, 128, 128, 255] => seen[2] += 1,
            other => panic!("a value that says nothing: {other:?}"),
        }
    }
    assert!(seen.iter().all(|&count| count > 100), "lit, shadow, neither: {seen:?}");
}

/// A light whose range ends before everything on screen has no say anywhere: mid-grey throughout.
#[test]
fn a_verdict_out_of_range_is_grey() {
    let mut stage = Stage::new();
    let scene = stock::build("cubes").unwrap().unwrap();
    stage.set_scene(&scene);
    let mut settings = Settings { show: Show::Shadow, size: SIZE, ..Settings::default() };
    let behind = LightEdit { position: Some(DVec3::new(0.0, 500.0, 500.0)), range: Some(1.0), ..LightEdit::default() };
    settings.lights.insert(0, behind);
    let verdict = stage.shoot(&settings, &scene).image;
    assert!(verdict.pixels().all(|pixel| pixel.0 == [128, 128, 128, 255]));
}

/// The same settings draw the same picture, to the last bit.
#[test]
fn the_same_settings_draw_the_same_picture() {
    let scene = stock::build("courtyard").unwrap().unwrap();
    let draw = || {
        let mut stage = Stage::new();
        stage.set_scene(&scene);
        stage.shoot(&Settings { size: SIZE, time: 2.5, ..Settings::default() }, &scene).image
    };
    assert!(draw() == draw());
}
