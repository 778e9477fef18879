//! Casters in the colours of their cases: each pixel has the hue of one class and of no other, and it is
//! the class of what stands there.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::{Build, Shot, Stage, cube, seen_from};
use glam::{DVec3, Vec3};
use image::Rgba;
use obscura::frame::{Camera, Case, DrawSet, Reason};
use obscura::scene::mesh::MeshParts;
use obscura::scene::{Mesh, Primitive, Scene};
use obscura::settings::{Culling, LightEdit, Settings, Show, Technique};
use obscura::techniques::cases::{BACKGROUND, Class, classes};

const SIZE: [u32; 2] = [160, 90];

/// Where the casters stand: the first before the near plane as the lamp to the right sees it and far into
/// the view, the next between lamp and near plane but out of view, then one in the view and out of the
/// lamp's way, and one beyond its range.
const THREE: DVec3 = DVec3::new(4.0, 0.0, -6.25);
const TWO: DVec3 = DVec3::new(10.0, 0.0, -2.5);
const ONE: DVec3 = DVec3::new(-4.0, 0.5, -10.0);
const LEFT_OUT: DVec3 = DVec3::new(-7.5, 4.0, -17.0);

/// One caster in each case, and a floor that casts nothing; seen from the origin along -z.
fn scene() -> (Scene, Settings) {
    let mut build = Build::new();
    build.floor(-2.0, 40.0);
    let cube = build.mesh(cube(0));
    build.place(cube, THREE, DVec3::new(0.5, 0.5, 5.75));
    build.place(cube, TWO, DVec3::splat(0.3));
    build.place(cube, ONE, DVec3::ONE);
    build.place(cube, LEFT_OUT, DVec3::ONE);
    let lamp = build.point_light(DVec3::new(20.0, 0.0, -5.0));
    build.0.lights[lamp].range = 26.0;
    let settings = seen_from(DVec3::ZERO, DVec3::new(0.0, 0.0, -10.0), SIZE);
    // Clamped to what receives it, the second's volume would be seen to hold nothing, and be left out.
    let culling = Culling { clamping: false, ..settings.culling };
    (build.0, Settings { show: Show::Cases, technique: Technique::Auto, culling, ..settings })
}

/// The class whose colour, shaded, this is; none for the background. Every other value fails.
fn class_of(pixel: Rgba<u8>) -> Option<Class> {
    let values = [0, 1, 2].map(|channel| f32::from(pixel.0[channel]));
    let background = BACKGROUND.map(|value| value * 255.0);
    if (0..3).all(|channel| (values[channel] - background[channel]).abs() <= 1.0) {
        return None;
    }
    // The shade that the brightest channel tells must be the others' too, to the last level.
    let fits = |class: &Class| {
        let color = class.color();
        let brightest = if color[0] > color[2] { 0 } else { 2 };
        let shade = values[brightest] / (255.0 * color[brightest]);
        (0.47..=1.005).contains(&shade) && (0..3).all(|i| (values[i] - 255.0 * shade * color[i]).abs() <= 1.6)
    };
    let fitting: Vec<_> = Class::ALL.into_iter().filter(fits).collect();
    assert_eq!(fitting.len(), 1, "{pixel:?} could be {fitting:?}");
    fitting.first().copied()
}

fn pixel_at(shot: &Shot, camera: &Camera, point: DVec3) -> Rgba<u8> {
    let clip = camera.clip_from_world() * point.extend(1.0);
    let at = [clip.x / clip.w * 0.5 + 0.5, 0.5 - clip.y / clip.w * 0.5];
    *shot.image.get_pixel((at[0] * f64::from(SIZE[0])) as u32, (at[1] * f64::from(SIZE[1])) as u32)
}

#[test]
fn every_pixel_has_the_colour_of_its_casters_case() {
    let mut stage = Stage::new();
    let (scene, settings) = scene();
    stage.set_scene(&scene);
    let shot = stage.shoot(&settings, &scene);
    let cases: Vec<_> = shot.plan.volumes.iter().map(|volume| volume.case).collect();
    assert_eq!(cases, [Some(Case::Three), Some(Case::Two), Some(Case::One), None]);
    let camera = shot.plan.views[0].camera;
    for (place, class) in [
        (THREE - DVec3::Z * 5.0, Class::Three),
        (ONE, Class::One),
        (LEFT_OUT, Class::LeftOut),
        (DVec3::new(0.0, -2.0, -8.0), Class::Receiver),
    ] {
        assert_eq!(class_of(pixel_at(&shot, &camera, place)), Some(class), "at {place}");
    }
    let mut seen = std::collections::BTreeMap::new();
    for pixel in shot.image.pixels() {
        *seen.entry(class_of(*pixel)).or_insert(0) += 1;
    }
    assert!(seen.values().all(|count| *count > 20), "{seen:?}");
    assert_eq!(seen.len(), 5, "case 2 is out of view, the background is there: {seen:?}");
    // What is out of view still has its colour in the plan.
    let found = classes(&scene, &shot.plan.volumes, 0, true);
    assert_eq!(found, [Class::Receiver, Class::Three, Class::Two, Class::One, Class::LeftOut]);
}

#[test]
fn what_of_a_caster_casts_nothing_has_a_receivers_colour() {
    // Two squares of one mesh side by side, the right one of which casts nothing.
    let square = |left: f32, right: f32| [[left, -1.0], [right, -1.0], [right, 1.0], [left, 1.0]];
    let corners = [square(-2.0, -0.2), square(0.2, 2.0)].concat();
    let half = |first_index, casts_shadow| Primitive { first_index, index_count: 6, material: 1, casts_shadow };
    let pair = Mesh::new(MeshParts {
        name: "pair".into(),
        positions: corners.into_iter().map(|[x, y]| Vec3::new(x, y, 0.0)).collect(),
        normals: None,
        uvs: None,
        colors: None,
        indices: vec![0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7],
        primitives: vec![half(0, true), half(6, false)],
        skin: Vec::new(),
        morphs: Vec::new(),
        morph_weights: Vec::new(),
    })
    .unwrap();
    let mut build = Build::new();
    build.floor(-2.0, 40.0);
    let pair = build.mesh(pair);
    build.place(pair, DVec3::new(0.0, 0.0, -6.0), DVec3::ONE);
    build.point_light(DVec3::new(0.0, 2.0, 1.0));
    let settings = Settings { show: Show::Cases, ..seen_from(DVec3::ZERO, DVec3::new(0.0, 0.0, -10.0), SIZE) };
    let mut stage = Stage::new();
    stage.set_scene(&build.0);
    let shot = stage.shoot(&settings, &build.0);
    let camera = shot.plan.views[0].camera;
    let at = |x: f64| class_of(pixel_at(&shot, &camera, DVec3::new(x, 0.0, -6.0))).unwrap();
    assert!(matches!(at(-1.0), Class::One | Class::Three), "{:?}", at(-1.0));
    assert_eq!(at(1.0), Class::Receiver);
}

#[test]
fn another_way_of_counting_leaves_the_cases_alone() {
    let mut stage = Stage::new();
    let (scene, settings) = scene();
    stage.set_scene(&scene);
    let first = stage.shoot(&settings, &scene).image;
    for technique in [Technique::None, Technique::ZFail, Technique::PerPolygon, Technique::Beam] {
        let shot = stage.shoot(&Settings { technique, ..settings.clone() }, &scene);
        assert!(shot.image == first, "{}", technique.name());
        // Nothing is counted: the stencil is as it was cleared.
        assert!(stage.stencil().iter().all(|count| *count == 0), "{}", technique.name());
        assert!(shot.plan.draws().all(|(_, draw)| !matches!(draw.set, DrawSet::Volumes(_))));
    }
}

#[test]
fn a_light_without_shadows_has_no_casters_and_one_out_of_view_leaves_all_out() {
    let mut stage = Stage::new();
    let (scene, settings) = scene();
    stage.set_scene(&scene);
    let mut classes_with = |edit: LightEdit| {
        let mut settings = settings.clone();
        settings.lights.insert(0, edit);
        let shot = stage.shoot(&settings, &scene);
        let mut classes: Vec<_> = shot.image.pixels().filter_map(|pixel| class_of(*pixel)).collect();
        classes.sort();
        classes.dedup();
        classes
    };
    assert_eq!(classes_with(LightEdit { shadows: Some(false), ..LightEdit::default() }), [Class::Receiver]);
    let behind = LightEdit { position: Some(DVec3::new(0.0, 0.0, 60.0)), ..LightEdit::default() };
    assert_eq!(classes_with(behind), [Class::LeftOut, Class::Receiver]);
}

#[test]
fn the_report_names_every_caster_of_every_light() {
    let (scene, settings) = scene();
    let capabilities = obscura::frame::Capabilities::complete();
    let (_, plan) = obscura::director::stage(&settings, &scene, &capabilities).unwrap();
    let report = serde_json::to_value(obscura::headless::json::casters(&scene, &plan)).unwrap();
    let row = |node: usize, case: Option<u8>, method: &str, reason: &str| serde_json::json!({ "caster": format!("node {node}"), "light": 0, "case": case, "method": method, "reason": reason });
    let expected = serde_json::json!([
        row(1, Some(3), "exact-z-pass", "surface-covers"),
        row(2, Some(2), "exact-z-pass", "surface-covers"),
        row(3, Some(1), "z-pass", "near-plane-clear"),
        row(4, None, "dropped", "out-of-range"),
    ]);
    assert_eq!(report, expected);
    assert_eq!(plan.volumes[3].reason, Reason::OutOfRange);
}
