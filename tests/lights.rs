//! Lights that are more than points of one colour: with a size, with a slide; and how their light is
//! gathered.
#![allow(clippy::unwrap_used, clippy::panic, clippy::float_cmp, reason = "a test fails by panicking; values are exact")]

mod common;

use common::{Build, Stage, cube, mesh, seen_from, square};
use glam::{DVec3, Vec3};
use image::RgbaImage;
use obscura::director::{StageError, frames, stage, stage_frame};
use obscura::frame::validate::validate;
use obscura::frame::{Action, Capabilities, Draw, DrawSet, Gather, Label, Program, Target};
use obscura::gpu::readback;
use obscura::scene::{Environment, Extent, LightKind, Scene, Texture, Wrap};
use obscura::settings::{
    Accumulation, AreaMode, LightEdit, Lighting, Settings, Shading, Show, SlideChoice, Technique, Texturing,
};

const SIZE: [u32; 2] = [160, 160];

/// Nothing shines but the lights.
fn dark(mut build: Build) -> Build {
    build.0.environment = Environment { ambient_sky: Vec3::ZERO, ambient_ground: Vec3::ZERO, background: [Vec3::ZERO; 2] };
    build
}

/// A floor under a spot that shines straight down, its slide a quarter red, green, blue and white from the
/// upper left; seen from above, -Z up.
fn projected() -> (Scene, Settings) {
    let mut build = dark(Build::new());
    build.floor(0.0, 20.0);
    let spot = build.light(LightKind::Spot { inner: 0.6, outer: 0.7 }, DVec3::Y * 5.0, DVec3::NEG_Y, 100.0);
    let quarters = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [255, 255, 255, 255]];
    let rgba = quarters.concat();
    let texture = Texture { name: "quarters".into(), width: 2, height: 2, rgba, wrap: [Wrap::Clamp; 2], nearest: false };
    build.0.textures.push(texture);
    build.0.lights[spot].slide = Some(0);
    (build.0, seen_from(DVec3::new(0.0, 10.0, 0.001), DVec3::ZERO, SIZE))
}

fn at(image: &RgbaImage, x: f64, y: f64) -> [u8; 3] {
    let [r, g, b, _] = image.get_pixel((x * f64::from(SIZE[0])) as u32, (y * f64::from(SIZE[1])) as u32).0;
    [r, g, b]
}

#[test]
fn a_spot_projects_its_slide_upright_and_nothing_beyond_its_edge() {
    let (scene, settings) = projected();
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let image = stage.shoot(&settings, &scene).image;
    // The slide's half is 5 tan(0.7) / sqrt 2 = 2.98 m, the picture's half 10 tan(25 degrees) = 4.66 m.
    let (near, far) = (0.5 - 0.5 * 1.5 / 4.66, 0.5 + 0.5 * 1.5 / 4.66);
    let strongest = |[r, g, b]: [u8; 3]| [r > 100, g > 100, b > 100];
    assert_eq!(strongest(at(&image, near, near)), [true, false, false]);
    assert_eq!(strongest(at(&image, far, near)), [false, true, false]);
    assert_eq!(strongest(at(&image, near, far)), [false, false, true]);
    assert_eq!(strongest(at(&image, far, far)), [true, true, true]);
    for beyond in [0.5 - 0.5 * 3.1 / 4.66, 0.5 + 0.5 * 3.1 / 4.66] {
        assert_eq!([at(&image, beyond, 0.5), at(&image, 0.5, beyond)], [[0; 3]; 2], "beyond the slide's edge");
    }

    let plain = LightEdit { slide: Some(SlideChoice::None), ..LightEdit::default() };
    let without = stage.shoot(&Settings { lights: [(0, plain)].into(), ..settings.clone() }, &scene).image;
    let [r, g, b] = at(&without, near, near);
    assert!(r == g && g == b && r > 100, "a plain cone is white");
    assert!(at(&without, 0.5, 0.5 - 0.5 * 3.1 / 4.66)[0] > 50, "and round");

    for slide in SlideChoice::ALL.into_iter().filter(|slide| *slide != SlideChoice::None) {
        let edit = LightEdit { slide: Some(slide), ..LightEdit::default() };
        let built_in = stage.shoot(&Settings { lights: [(0, edit)].into(), ..settings.clone() }, &scene).image;
        assert_ne!(built_in, image, "{}", slide.name());
        assert_ne!(built_in, without, "{}", slide.name());
        let lit = built_in.pixels().filter(|pixel| pixel.0[..3].iter().any(|value| *value > 60)).count();
        assert!(lit > 1000, "{}: {lit}", slide.name());
    }
}

/// A cube over a floor, and a lamp of some size above.
fn soft() -> (Scene, Settings) {
    let mut build = dark(Build::new());
    build.floor(0.0, 20.0);
    let solid = build.mesh(cube(0));
    build.place(solid, DVec3::new(0.0, 3.0, 0.0), DVec3::splat(0.7));
    let lamp = build.point_light(DVec3::new(0.5, 8.0, 0.2));
    build.0.lights[lamp].extent = Extent::Round(0.8);
    (build.0, seen_from(DVec3::new(0.0, 6.0, 9.0), DVec3::new(0.0, 1.0, 0.0), SIZE))
}

fn sampled(settings: &Settings, area_samples: u32) -> Settings {
    Settings { lighting: Lighting { area_samples, ..settings.lighting }, ..settings.clone() }
}

/// Each point of a light is exact by itself, and the picture is their sum: a pixel is black where none of
/// them is seen, as bright as without shadows where all are, and in between where some are.
#[test]
fn a_light_with_a_size_is_the_sum_of_its_points() {
    let (scene, settings) = soft();
    let settings = sampled(&settings, 8);
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let mut lit = vec![0u32; (SIZE[0] * SIZE[1]) as usize];
    let mut surface = vec![true; lit.len()];
    for light_sample in 0..8 {
        let lighting = Lighting { light_sample, ..settings.lighting };
        let verdict = stage.shoot(&Settings { show: Show::Shadow, lighting, ..settings.clone() }, &scene).image;
        for (pixel, (lit, surface)) in verdict.pixels().zip(lit.iter_mut().zip(&mut surface)) {
            *lit += u32::from(pixel.0[0] == 255);
            *surface &= pixel.0[0] != 128;
        }
    }
    let picture = stage.shoot(&settings, &scene).image;
    let shadowless = LightEdit { shadows: Some(false), ..LightEdit::default() };
    let unshadowed = stage.shoot(&Settings { lights: [(0, shadowless)].into(), ..settings.clone() }, &scene).image;
    let mut seen = [0; 9];
    for ((pixel, bright), (lit, surface)) in picture.pixels().zip(unshadowed.pixels()).zip(lit.iter().zip(&surface)) {
        // What faces away from the lamp is dark however much of it there is.
        if !surface || bright.0[0] < 40 {
            continue;
        }
        seen[*lit as usize] += 1;
        match lit {
            0 => assert_eq!(pixel.0[..3], [0; 3]),
            8 => assert_eq!(pixel, bright),
            _ => assert!(pixel.0[0] > 0 && pixel.0[0] < bright.0[0], "{pixel:?} of {bright:?} by {lit} points"),
        }
    }
    assert!(seen.iter().all(|pixels| *pixels > 20), "the penumbra has all its steps: {seen:?}");
}

#[test]
fn the_plan_counts_each_point_by_itself() {
    let (scene, settings) = soft();
    let plan = |settings: &Settings| stage(settings, &scene, &Capabilities::complete()).unwrap().1;
    let eight = plan(&sampled(&settings, 8));
    assert_eq!(eight.points, [0; 8]);
    assert_eq!(eight.volumes.iter().map(|volume| volume.light).collect::<Vec<_>>(), [0, 1, 2, 3, 4, 5, 6, 7]);
    assert!(eight.to_string().contains("light 7: a point of light 0"));
    let one = plan(&sampled(&settings, 1));
    assert_eq!((one.points.len(), one.volumes.len()), (1, 1));
    let edit = LightEdit { radius: Some(0.0), ..LightEdit::default() };
    let point = plan(&Settings { lights: [(0, edit)].into(), ..sampled(&settings, 8) });
    assert_eq!(point, one, "a radius of 0 is a point");

    let mut many = scene.clone();
    many.lights = vec![scene.lights[0].clone(); 40];
    let error = stage(&sampled(&settings, 64), &many, &Capabilities::complete()).unwrap_err();
    assert!(matches!(error, StageError::Points(2560)), "{error}");
}

/// The mean of so many frames.
fn gathered(stage: &mut Stage, scene: &Scene, settings: &Settings, accumulate: u32) -> RgbaImage {
    let settings = Settings { lighting: Lighting { accumulate, ..settings.lighting }, ..settings.clone() };
    let mut image = None;
    for frame in 0..frames(&settings) {
        let (pose, plan) = stage_frame(&settings, scene, stage.context.capabilities(), frame).unwrap();
        image = Some(readback::picture(&stage.context, &mut stage.renderer, &plan, scene, &pose).unwrap().1);
    }
    image.unwrap()
}

fn levels(image: &RgbaImage) -> usize {
    image.pixels().map(|pixel| pixel.0).collect::<std::collections::BTreeSet<_>>().len()
}

fn largest_difference(a: &RgbaImage, b: &RgbaImage) -> u8 {
    let differences = a.pixels().zip(b.pixels()).map(|(a, b)| (0..3).map(|i| a.0[i].abs_diff(b.0[i])).max().unwrap_or(0));
    differences.max().unwrap_or(0)
}

/// Sixteen frames of one point each are one frame of sixteen points, but for the smooth edges.
#[test]
fn gathered_frames_are_the_mean_of_their_points() {
    let (scene, settings) = soft();
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let over_time = gathered(&mut stage, &scene, &sampled(&settings, 1), 16);
    let at_once = stage.shoot(&sampled(&settings, 16), &scene).image;
    let alone = stage.shoot(&sampled(&settings, 1), &scene).image;
    let far = |a: &RgbaImage, b: &RgbaImage| {
        a.pixels().zip(b.pixels()).filter(|(a, b)| a.0[0].abs_diff(b.0[0]) > 24).count() as f64 / f64::from(SIZE[0] * SIZE[1])
    };
    let (same, other) = (far(&over_time, &at_once), far(&over_time, &alone));
    assert!(same < 0.03 && other > 2.0 * same, "{same} of the pixels differ, {other} from hard shadows");
    assert!(levels(&over_time) > levels(&alone), "penumbra and edges have more steps");

    assert_eq!(gathered(&mut stage, &scene, &sampled(&settings, 1), 16), over_time, "the same arguments, the same pixels");
    assert_eq!(gathered(&mut stage, &scene, &settings, 1), stage.shoot(&settings, &scene).image, "one frame is a frame");
}

/// A frame that is drawn again leaves the same mean: pictures are saved so.
#[test]
fn the_last_gathered_frame_can_be_drawn_again() {
    let (scene, mut settings) = soft();
    settings.lighting = Lighting { area_samples: 1, accumulate: 5, ..settings.lighting };
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    for frame in 0..5 {
        let (pose, plan) = stage_frame(&settings, &scene, stage.context.capabilities(), frame).unwrap();
        assert_eq!(plan.gather, Some(Gather { frame, frames: 5 }));
        let mut draw = || readback::picture(&stage.context, &mut stage.renderer, &plan, &scene, &pose).unwrap().1;
        assert!(draw() == draw(), "frame {frame}");
    }
}

#[test]
fn a_frame_joins_the_mean_after_the_scene_and_before_the_picture() {
    let (scene, mut settings) = soft();
    settings.lighting.accumulate = 4;
    let capabilities = Capabilities::complete();
    let (_, plan) = stage_frame(&settings, &scene, &capabilities, 2).unwrap();
    let targets: Vec<_> = plan.draws().map(|(_, draw)| draw.target).collect();
    let [rest @ .., Target::Mean, Target::Output] = &targets[..] else { panic!("{targets:?}") };
    assert!(rest.iter().all(|target| *target == Target::Scene));
    assert_ne!(plan.views[0].camera.shift, glam::DVec2::ZERO);

    let mut never = plan.clone();
    never.steps.retain(|step| !matches!(&step.action, Action::Draw(draw) if draw.program == Program::Gather));
    assert!(validate(&never).unwrap_err().what.contains("joined the mean"));
    let mut unasked = plan.clone();
    unasked.gather = None;
    assert!(validate(&unasked).unwrap_err().what.contains("does not gather"));
    let mut twice = plan;
    twice.steps.insert(twice.steps.len() - 1, twice.steps[twice.steps.len() - 2].clone());
    assert!(validate(&twice).unwrap_err().what.contains("once"));

    let (_, exact) = stage(&Settings { show: Show::Shadow, ..settings }, &scene, &capabilities).unwrap();
    assert_eq!(exact.gather, None, "exact values have no mean");
}

/// What M section 8 warns of: in 8 bits gradients have fewer steps, and many dim lights are lost altogether
/// where floats add up to what one light of their sum gives.
#[test]
fn eight_bits_band_and_lose_dim_lights() {
    let (scene, settings) = soft();
    let hard = LightEdit { radius: Some(0.0), intensity: Some(30.0), ..LightEdit::default() };
    let settings = Settings { lights: [(0, hard)].into(), ..settings };
    let in_bits = |settings: &Settings| Settings {
        lighting: Lighting { accumulation: Accumulation::EightBit, ..settings.lighting },
        ..settings.clone()
    };
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let float = stage.shoot(&settings, &scene).image;
    let bits = stage.shoot(&in_bits(&settings), &scene).image;
    assert!(levels(&bits) * 3 < levels(&float) * 2, "{} levels instead of {}", levels(&bits), levels(&float));
    assert!(largest_difference(&float, &bits) < 30, "the same picture nonetheless");

    // 60 lights of a sixtieth: each less than half a 255th where it falls.
    let (mut many, mut settings) = soft();
    many.lights = vec![many.lights[0].clone(); 60];
    let dim = LightEdit { radius: Some(0.0), intensity: Some(0.1), shadows: Some(false), ..LightEdit::default() };
    settings.lights = (0..60).map(|light| (light, dim.clone())).collect();
    stage.set_scene(&many);
    let float = stage.shoot(&settings, &many).image;
    let bits = stage.shoot(&in_bits(&settings), &many).image;
    let brightest = |image: &RgbaImage| image.pixels().map(|pixel| pixel.0[0]).max().unwrap();
    assert!(brightest(&float) > 20 && brightest(&bits) == 0, "{} and {}", brightest(&float), brightest(&bits));
}

/// Names are in the picture, on their plates and nowhere else, and the same every time.
#[test]
fn names_are_drawn_over_the_picture() {
    let (mut scene, settings) = soft();
    scene.nodes[1].name = "a cube".into();
    scene.lights[0].name = "l\u{e4}mp".into();
    let named = Settings { lighting: Lighting { labels: true, ..settings.lighting }, ..settings.clone() };
    let camera = glam::DVec3::new(0.0, 6.0, 16.0);
    let far = |settings: &Settings| Settings {
        camera: obscura::settings::CameraChoice::Free { eye: camera, target: DVec3::new(0.0, 4.0, 0.0) },
        ..settings.clone()
    };
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let plain = stage.shoot(&far(&settings), &scene);
    let shot = stage.shoot(&far(&named), &scene);
    let (step, draw) = shot.plan.draws().last().unwrap();
    let DrawSet::Labels(labels) = &draw.set else { panic!("{} comes last", step.label) };
    assert_eq!(labels.iter().map(|label| label.text.as_str()).collect::<Vec<_>>(), ["l\u{e4}mp", "a cube"]);

    let rects = |label: &Label| [label.plate, [label.anchor[0] - 3.0, label.anchor[1] - 3.0, 6.0, 6.0]];
    let inside = |x: u32, y: u32, [left, top, width, height]: [f32; 4]| {
        let (x, y) = (x as f32 + 0.5, y as f32 + 0.5);
        x > left && y > top && x < left + width && y < top + height
    };
    for (x, y, pixel) in shot.image.enumerate_pixels() {
        if !labels.iter().flat_map(rects).any(|rect| inside(x, y, rect)) {
            assert_eq!(pixel, plain.image.get_pixel(x, y), "beside all names, at {x}, {y}");
        }
    }
    for label in labels {
        // The letters are bright, and begin and end near the plate's ends.
        let bright = |x: u32, y: u32| inside(x, y, label.plate) && shot.image.get_pixel(x, y).0[0] > 150;
        let lit: Vec<_> = shot.image.enumerate_pixels().filter(|(x, y, _)| bright(*x, *y)).map(|(x, ..)| x as f32).collect();
        assert!(lit.len() > 20, "{}: {}", label.text, lit.len());
        let (first, last) = lit.iter().fold((f32::MAX, 0.0f32), |(first, last), x| (first.min(*x), last.max(*x)));
        let [left, _, width, _] = label.plate;
        assert!(first - left < 8.0 && left + width - last < 9.0, "{}: {first} to {last} of {:?}", label.text, label.plate);
    }
    assert!(stage.shoot(&far(&named), &scene).image == shot.image);
    let exact = Settings { show: Show::Shadow, ..far(&named) };
    assert!(stage.shoot(&exact, &scene).plan.draws().all(|(_, draw)| draw.program != Program::Labels), "not over exact values");
}

/// Two lights on a textured floor and ball; `roughness` below 1 gives them highlights.
fn textured(roughness: f32) -> (Scene, Settings) {
    let mut build = dark(Build::new());
    let rgba = [[200, 40, 40, 255], [40, 200, 40, 255], [90, 90, 220, 255], [20, 20, 20, 255]].concat();
    let texture = Texture { name: "tiles".into(), width: 2, height: 2, rgba, wrap: [Wrap::Repeat; 2], nearest: false };
    build.0.textures.push(texture);
    build.0.materials[0].base_color_texture = Some(0);
    build.0.materials[0].roughness = roughness;
    let corners = [[-8.0, 0.0, -8.0], [-8.0, 0.0, 8.0], [8.0, 0.0, 8.0], [8.0, 0.0, -8.0]];
    let positions: Vec<Vec3> = corners.map(Vec3::from).to_vec();
    let uvs = corners.map(|[x, _, z]: [f32; 3]| glam::Vec2::new(x, z) / 4.0).to_vec();
    let floor = obscura::scene::Mesh::new(obscura::scene::MeshParts {
        name: "floor".into(),
        positions,
        normals: None,
        uvs: Some(uvs),
        colors: None,
        indices: vec![0, 1, 2, 0, 2, 3],
        primitives: vec![obscura::scene::Primitive { first_index: 0, index_count: 6, material: 0, casts_shadow: false }],
        skin: Vec::new(),
        morphs: Vec::new(),
        morph_weights: Vec::new(),
    });
    let floor = build.mesh(floor.unwrap());
    build.place(floor, DVec3::ZERO, DVec3::ONE);
    let solid = build.mesh(cube(1));
    build.place(solid, DVec3::Y * 1.5, DVec3::splat(0.6));
    build.point_light(DVec3::new(-2.0, 4.0, -3.0));
    build.point_light(DVec3::new(3.0, 5.0, -2.0));
    build.0.exposure = 0.4;
    let mut settings = seen_from(DVec3::new(0.0, 5.0, 9.0), DVec3::ZERO, SIZE);
    // Shaded pixel by pixel, textures are read once in any case.
    settings.lighting.shading = Shading::Forward;
    (build.0, settings)
}

/// M section 8: on matt surfaces the sum of all lights times the texture is the sum of each times the
/// texture; highlights, which have no texture, are tinted by it.
#[test]
fn textures_once_are_the_same_on_matt_surfaces_and_tint_highlights() {
    let mut stage = Stage::new();
    let once = |settings: &Settings| Settings {
        lighting: Lighting { texturing: Texturing::Once, ..settings.lighting },
        ..settings.clone()
    };
    let (matt, settings) = textured(1.0);
    stage.set_scene(&matt);
    let each = stage.shoot(&settings, &matt);
    let last = stage.shoot(&once(&settings), &matt);
    assert!(levels(&each.image) > 500, "there is something to see");
    // As in tests/goldens.rs: LEVELS of 255, EDGES of the pixels.
    let differ = |a: &image::Rgba<u8>, b: &image::Rgba<u8>| (0..3).any(|i| a.0[i].abs_diff(b.0[i]) > 5);
    let wrong = each.image.pixels().zip(last.image.pixels()).filter(|(a, b)| differ(a, b)).count();
    assert!(wrong as f64 <= 0.0015 * f64::from(SIZE[0] * SIZE[1]), "{wrong} pixels differ");

    let of = |program: Program, shot: &common::Shot| shot.plan.draws().filter(|(_, draw)| draw.program == program).count();
    assert_eq!((of(Program::Texture, &each), of(Program::Texture, &last)), (0, 1));
    let reads =
        |shot: &common::Shot| shot.plan.draws().filter(|(_, draw)| draw.program == Program::Lit && draw.look.textured).count();
    assert_eq!((reads(&each), reads(&last)), (2, 0), "no light reads a texture");

    let (shiny, settings) = textured(0.4);
    stage.set_scene(&shiny);
    let each = stage.shoot(&settings, &shiny).image;
    let last = stage.shoot(&once(&settings), &shiny).image;
    // The colour of what differs most: white where each light reads the texture, the texture's where none does.
    let (white, tinted) =
        each.pixels().zip(last.pixels()).max_by_key(|(a, b)| (0..3).map(|i| a.0[i].abs_diff(b.0[i])).max()).unwrap();
    let spread = |pixel: &image::Rgba<u8>| pixel.0[..3].iter().max().unwrap() - pixel.0[..3].iter().min().unwrap();
    assert!(spread(tinted) > spread(white) + 20, "{white:?} and {tinted:?}");
}

/// A lamp of some size over a floor, and `casters` between them.
fn under_a_lamp(casters: impl Fn(&mut Build)) -> (Scene, Settings) {
    let mut build = dark(Build::new());
    build.floor(0.0, 20.0);
    casters(&mut build);
    let lamp = build.point_light(DVec3::new(0.5, 12.0, 0.2));
    build.0.lights[lamp].extent = Extent::Round(0.6);
    (build.0, seen_from(DVec3::new(0.0, 6.0, 9.0), DVec3::new(0.0, 0.5, 0.0), SIZE))
}

/// Sheets one above the other, as one mesh or each by itself.
fn sheets(build: &mut Build, count: u16, one_mesh: bool) {
    let height = |at: u16| 1.0 + f32::from(at) * 0.02;
    if one_mesh {
        let corners =
            (0..count).flat_map(|at| [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]].map(|[x, z]| [x, height(at), z]));
        let corners: Vec<[f32; 3]> = corners.collect();
        let quads = (0..u32::from(count)).flat_map(|at| [[0, 1, 2], [0, 2, 3]].map(|quad| quad.map(|corner| at * 4 + corner)));
        let triangles: Vec<[u32; 3]> = quads.collect();
        let stack = build.mesh(mesh("stack", &corners, &triangles, 1));
        build.place(stack, DVec3::ZERO, DVec3::ONE);
    } else {
        let sheet = build.mesh(square(1));
        (0..count).for_each(|at| _ = build.place(sheet, DVec3::new(0.0, height(at).into(), 0.0), DVec3::ONE));
    }
}

fn cubes(build: &mut Build, places: &[[f64; 3]]) {
    let solid = build.mesh(cube(0));
    places.iter().for_each(|&at| _ = build.place(solid, DVec3::from(at), DVec3::splat(0.6)));
}

/// Each point's bit is what the point counted by itself says, and the picture is the same to the last bit,
/// whichever way the bits come about.
#[test]
fn a_bit_for_each_point_holds_what_the_points_hold_one_by_one() {
    type Casters = fn(&mut Build);
    let cases: [(&str, usize, Casters); 4] = [
        ("turned over by every face", 1, |build| cubes(build, &[[0.0, 2.0, 0.0], [-3.0, 1.0, 1.0]])),
        ("4 at a time, counted in 4 bits and collapsed into it", 2, |build| cubes(build, &[[0.0, 2.0, 0.0], [0.3, 4.0, 0.2]])),
        ("of 8 points in batches of at most 15", 2, |build| sheets(build, 40, false)),
        ("counted wide", 1, |build| sheets(build, 40, true)),
    ];
    let mut stage = Stage::new();
    for (how, rounds, casters) in cases {
        let (scene, settings) = under_a_lamp(casters);
        stage.set_scene(&scene);
        let under_it = seen_from(DVec3::new(0.1, 0.6, 0.1), DVec3::new(0.5, 0.0, 0.2), SIZE);
        for (place, settings) in [settings, under_it].into_iter().enumerate() {
            for technique in
                [Technique::ZFail, Technique::ExactZPass, Technique::Auto, Technique::OneSided, Technique::PerPolygon]
            {
                // All of it for one technique, a part of it for the others.
                let samples: &[u32] = if technique == Technique::ExactZPass { &[0, 1, 2, 3, 4, 5, 6, 7] } else { &[3, 6] };
                let settings = Settings { technique, ..settings.clone() };
                let by = |area_mode, light_sample, show| Settings {
                    show,
                    lighting: Lighting { area_mode, light_sample, ..settings.lighting },
                    ..settings.clone()
                };
                let one_by_one = stage.shoot(&by(AreaMode::Points, 0, Show::Final), &scene);
                let together = stage.shoot(&by(AreaMode::Bits, 0, Show::Final), &scene);
                let notes = &together.plan.notes;
                let told = format!("{how}, {}, from place {place}: {notes:?}", technique.name());
                assert!(together.image == one_by_one.image, "{told}");
                let clears = together
                    .plan
                    .steps
                    .iter()
                    .filter(|step| matches!(&step.action, Action::Clear(clear) if clear.stencil.is_some()));
                assert!(notes.iter().any(|note| note.contains(how)), "{told}");
                assert_eq!(clears.count(), rounds, "{told}");
                // The bits of the first round, as they are when all of it is counted.
                stage.shoot(&by(AreaMode::Bits, 0, Show::Stencil), &scene);
                let stencil = stage.stencil();
                let mut bits = 0;
                for &sample in samples {
                    let verdict = stage.shoot(&by(AreaMode::Points, sample, Show::Shadow), &scene).image;
                    let shot = stage.shoot(&by(AreaMode::Bits, sample, Show::Shadow), &scene);
                    assert!(shot.image == verdict, "point {sample}: {told}");
                    if sample as usize >= 8 / rounds {
                        continue;
                    }
                    let adds = |draw: &Draw| draw.program == Program::Lit && draw.light == Some(sample as usize);
                    let (_, added) = together.plan.draws().find(|(_, draw)| adds(draw)).unwrap();
                    let bit = added.state.stencil.read_mask;
                    assert!(bit.is_power_of_two() && bits & bit == 0, "{told}");
                    bits |= bit;
                    let mut seen = [0; 2];
                    for (pixel, stencil) in verdict.pixels().zip(&stencil).filter(|(pixel, _)| pixel.0[0] != 128) {
                        assert_eq!(stencil & bit == 0, pixel.0[0] == 255, "point {sample}: {told}");
                        seen[usize::from(stencil & bit == 0)] += 1;
                    }
                    assert!(seen[0] > 30, "{seen:?}, point {sample}: {told}");
                }
            }
        }
    }
}

/// What is in one place twice is lit once, whether the light is counted, is not, or is one of many; and
/// textured once.
#[test]
fn of_two_surfaces_in_one_place_only_one_takes_the_light() {
    let scene = |floors: usize| {
        let mut build = dark(Build::new());
        for _ in 0..floors {
            build.floor(0.0, 20.0);
        }
        let texture = Texture {
            name: "grey".into(),
            width: 1,
            height: 1,
            rgba: vec![128, 128, 128, 255],
            wrap: [Wrap::Clamp; 2],
            nearest: false,
        };
        build.0.textures.push(texture);
        build.0.materials[0].base_color_texture = Some(0);
        cubes(&mut build, &[[0.0, 2.0, 0.0]]);
        build.point_light(DVec3::new(0.5, 9.0, 0.2));
        build.point_light(DVec3::new(-3.0, 6.0, 0.2));
        build.point_light(DVec3::new(3.0, 6.0, 0.2));
        build.0
    };
    let settings = seen_from(DVec3::new(0.0, 6.0, 9.0), DVec3::new(0.0, 0.5, 0.0), SIZE);
    let mut stage = Stage::new();
    let mut pictures = Vec::new();
    for floors in [1, 2] {
        let scene = scene(floors);
        stage.set_scene(&scene);
        let by = |stage: &mut Stage, settings: &Settings| stage.shoot(settings, &scene).image;
        let mut drawn = Vec::new();
        for technique in [Technique::ZFail, Technique::None] {
            for (texturing, depth_bounds) in [(Texturing::EachLight, false), (Texturing::Once, true)] {
                let lighting = Lighting { texturing, ..settings.lighting };
                let mut settings = Settings { technique, lighting, ..settings.clone() };
                settings.culling.depth_bounds = depth_bounds;
                settings.lights.insert(1, LightEdit { shadows: Some(false), ..LightEdit::default() });
                settings.lights.insert(2, LightEdit { range: Some(9.0), ..LightEdit::default() });
                drawn.push(by(&mut stage, &settings));
            }
        }
        pictures.push(drawn);
    }
    assert!(pictures[0] == pictures[1]);
    assert!(pictures[0][0] != pictures[0][2], "there is a shadow");
}
