//! More volumes over a pixel than the stencil counts: exact techniques stay exact, in batches and in a
//! wide target; the naive count is wrong exactly where it wraps to zero; few bits change nothing.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::{Build, Shot, Stage, cube, mesh, seen_from, square};
use glam::DVec3;
use obscura::director;
use obscura::frame::stencil::StencilOp;
use obscura::frame::validate::validate;
use obscura::frame::{Action, Capabilities, Draw, FramePlan, Program, Target};
use obscura::gpu::readback;
use obscura::scene::{LightKind, Scene, stock};
use obscura::settings::{Counting, Culling, Overflow, Settings, Show, Technique};
use obscura::truth::World;

const SIZE: [u32; 2] = [160, 90];
const SHEETS: usize = 300;
const LIGHT: DVec3 = DVec3::new(0.1, 20.0, 0.2);

fn height(sheet: usize) -> f64 {
    3.0 + sheet as f64 * 0.04
}

/// Three hundred sheets one above the other between a light and a floor: each an instance of its own,
/// or all of them one mesh.
fn stacked(one_mesh: bool) -> (Scene, Settings) {
    let mut build = Build::new();
    build.floor(0.0, 30.0);
    if one_mesh {
        let mut corners = Vec::new();
        let mut triangles = Vec::new();
        for sheet in 0..SHEETS {
            let first = corners.len() as u32;
            let y = height(sheet) as f32;
            corners.extend([[-1.0, y, -1.0], [-1.0, y, 1.0], [1.0, y, 1.0], [1.0, y, -1.0]]);
            triangles.extend([[0, 1, 2], [0, 2, 3]].map(|triangle: [u32; 3]| triangle.map(|corner| first + corner)));
        }
        let stack = build.mesh(mesh("stack", &corners, &triangles, 1));
        build.place(stack, DVec3::ZERO, DVec3::ONE);
    } else {
        let sheet = build.mesh(square(1));
        (0..SHEETS).for_each(|at| _ = build.place(sheet, DVec3::new(0.0, height(at), 0.0), DVec3::ONE));
    }
    build.point_light(LIGHT);
    (build.0, seen_from(DVec3::new(7.0, 6.0, 9.0), DVec3::new(0.5, 0.0, 0.5), SIZE))
}

/// How many sheets lie between the light and a point of the floor.
fn above(point: DVec3) -> usize {
    (0..SHEETS)
        .filter(|&sheet| {
            let through = LIGHT.lerp(point, 1.0 - height(sheet) / LIGHT.y);
            through.x.abs() < 1.0 && through.z.abs() < 1.0
        })
        .count()
}

fn note(shot: &Shot) -> String {
    shot.plan.notes.iter().find(|note| note.starts_with("light 0: ")).cloned().unwrap_or_default()
}

/// Every decided pixel's verdict is the rays', by `technique`; gives what was drawn.
fn assert_exact(stage: &mut Stage, scene: &Scene, settings: &Settings) -> Shot {
    let found = stage.verify(settings, scene);
    for (light, comparison) in found.iter().enumerate() {
        let command = obscura::cli::render_command(&Settings { show: Show::Shadow, light, ..settings.clone() });
        assert_eq!(comparison.wrong(), 0, "{:?}: {command}", comparison.pixels.first());
        assert!(comparison.decided > 1000, "{} decided: {command}", comparison.decided);
    }
    assert!(found.iter().any(|comparison| comparison.lit > 0) && found.iter().any(|comparison| comparison.shadow > 0));
    stage.shoot(&Settings { show: Show::Shadow, ..settings.clone() }, scene)
}

#[test]
fn three_hundred_volumes_are_counted_in_batches_or_wide_and_never_wrong() {
    let mut stage = Stage::new();
    for one_mesh in [false, true] {
        let (scene, settings) = stacked(one_mesh);
        stage.set_scene(&scene);
        for technique in [Technique::ZFail, Technique::ExactZPass, Technique::ZPlus, Technique::Wide] {
            let shot = assert_exact(&mut stage, &scene, &Settings { technique, ..settings.clone() });
            let note = note(&shot);
            match technique {
                Technique::Wide => assert_eq!(note, "", "it never overflows"),
                _ if one_mesh => assert!(note.contains("up to 300") && note.contains("alone") && note.contains("wide"), "{note}"),
                _ => assert!(note.contains("up to 300") && note.contains("3 batches of at most 127"), "{note}"),
            }
        }
    }
}

#[test]
fn the_eye_in_three_hundred_volumes() {
    // Exact z-pass starts each batch at what that batch's volumes count around the eye.
    let (scene, _) = stacked(false);
    let settings = seen_from(DVec3::new(0.3, 1.2, 0.2), DVec3::new(2.5, 0.0, 1.0), SIZE);
    // Between its pieces a volume holds no eye.
    let settings = Settings { culling: Culling { clamping: false, ..settings.culling }, ..settings };
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    for technique in [Technique::ExactZPass, Technique::ZFail] {
        let settings = Settings { technique, ..settings.clone() };
        let found = stage.verify(&settings, &scene);
        assert_eq!(found[0].wrong(), 0);
        assert!(found[0].lit > 500 && found[0].shadow > 500, "{} lit, {} in shadow", found[0].lit, found[0].shadow);
        let shot = stage.shoot(&settings, &scene);
        let starts: Vec<_> = shot.plan.steps.iter().filter(|step| step.label.contains("start batch")).collect();
        assert_eq!(starts.len(), if technique == Technique::ExactZPass { 2 } else { 0 });
    }
}

#[test]
fn the_wide_count_is_every_floor_pixels_number_of_sheets() {
    let (scene, settings) = stacked(false);
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let settings = Settings { technique: Technique::Wide, show: Show::Shadow, ..settings };
    let shot = stage.shoot(&settings, &scene);
    let counts = readback::counts(&stage.context, &stage.renderer).unwrap();
    let camera = &shot.plan.views[0].camera;
    let by_rays = World::new(&scene, &shot.pose).counts(camera, &shot.pose.lights[0], SIZE);
    let half_height = (camera.vertical_fov / 2.0).tan();
    let right = camera.forward.cross(camera.up);
    let mut seen = Vec::new();
    for (at, (&count, by_rays)) in counts.iter().zip(&by_rays).enumerate() {
        if let Some(by_rays) = by_rays {
            assert_eq!(count.rem_euclid(256.0), f32::from(*by_rays), "pixel {at}");
        }
        let (x, y) = ((at % SIZE[0] as usize) as f64 + 0.5, (at / SIZE[0] as usize) as f64 + 0.5);
        let (x, y) = (2.0 * x / f64::from(SIZE[0]) - 1.0, 1.0 - 2.0 * y / f64::from(SIZE[1]));
        let way = camera.forward + right * (x * half_height * camera.aspect) + camera.up * (y * half_height);
        let on_floor = camera.eye - way * (camera.eye.y / way.y);
        // The stack hides a part of the floor.
        let hidden = (0..SHEETS).any(|sheet| {
            let through = camera.eye + way * ((height(sheet) - camera.eye.y) / way.y);
            through.x.abs() <= 1.0 && through.z.abs() <= 1.0
        });
        // On the border of a sheet's shadow rounding decides.
        let beside = [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z].map(|side| above(on_floor + side * 1e-4));
        if way.y < 0.0 && !hidden && on_floor.abs().max_element() < 29.0 && beside.iter().all(|&count| count == beside[0]) {
            assert_eq!(count, above(on_floor) as f32, "pixel {at}, {on_floor} on the floor");
            seen.push(count);
        }
    }
    let most = seen.iter().fold(0f32, |most, count| most.max(*count));
    assert!(seen.len() > 1000 && most == 300.0, "{} pixels, {most} at most", seen.len());
    assert!(seen.contains(&0.0) && seen.iter().any(|&count| (1.0..299.0).contains(&count) && count != 256.0));
}

#[test]
fn the_naive_count_is_wrong_exactly_where_it_wraps_to_zero_and_show_overflow_marks_it() {
    let (scene, settings) = stacked(true);
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    stage.shoot(&Settings { technique: Technique::Wide, show: Show::Shadow, ..settings.clone() }, &scene);
    let counts = readback::counts(&stage.context, &stage.renderer).unwrap();
    for bits in [3, 8] {
        let field = 2f32.powi(bits);
        let counting = Counting { bits: bits as u32, overflow: Overflow::Naive };
        let marked = stage.shoot(&Settings { show: Show::Overflow, counting, ..settings.clone() }, &scene);
        for technique in [Technique::ZFail, Technique::ExactZPass] {
            let naive = stage.shoot(&Settings { technique, show: Show::Shadow, counting, ..settings.clone() }, &scene);
            assert!(note(&naive).contains("is taken for none"), "{}", note(&naive));
            let mut aliased = 0;
            for (at, &count) in counts.iter().enumerate() {
                let (x, y) = (at as u32 % SIZE[0], at as u32 / SIZE[0]);
                let [shade, ..] = naive.image.get_pixel(x, y).0;
                if shade == 128 {
                    continue; // no surface
                }
                let wraps_to_zero = count % field == 0.0;
                assert_eq!(shade, if wraps_to_zero { 255 } else { 0 }, "{count} at {x},{y}");
                let is_red = marked.image.get_pixel(x, y).0 == [255, 0, 0, 255];
                assert_eq!(is_red, wraps_to_zero && count != 0.0, "{count} at {x},{y}");
                aliased += usize::from(is_red);
            }
            assert!(aliased > if bits == 3 { 200 } else { 5 }, "{aliased} aliased");
        }
    }
}

#[test]
fn few_bits_change_no_verdict() {
    let mut stage = Stage::new();
    for name in ["cubes", "courtyard"] {
        let scene = stock::build(name).unwrap().unwrap();
        stage.set_scene(&scene);
        let settings = Settings { size: [120, 68], ..Settings::default() };
        let full = |light| Settings { show: Show::Shadow, light, ..settings.clone() };
        for light in 0..scene.lights.len() {
            let expected = stage.shoot(&full(light), &scene).image;
            for (bits, technique) in [(1, Technique::ZFail), (2, Technique::ExactZPass), (3, Technique::ZFail)] {
                let counting = Counting { bits, overflow: Overflow::Exact };
                let shot = stage.shoot(&Settings { counting, technique, ..full(light) }, &scene);
                assert!(shot.image == expected, "{name}, light {light}, {bits} bits, {}: {}", technique.name(), note(&shot));
            }
        }
    }
}

#[test]
fn two_bits_against_rays() {
    let mut build = Build::new();
    build.floor(0.0, 30.0);
    let cube = build.mesh(cube(0));
    for at in 0..9 {
        build.place(
            cube,
            DVec3::new(f64::from(at % 3) * 0.5, 1.0 + f64::from(at) * 1.1, f64::from(at % 2) * 0.4),
            DVec3::splat(0.5),
        );
    }
    build.point_light(DVec3::new(3.0, 16.0, 2.0));
    build.light(LightKind::Directional, DVec3::ZERO, DVec3::new(-0.2, -1.0, -0.1), 3.0);
    let scene = build.0;
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let settings = seen_from(DVec3::new(4.0, 5.0, 9.0), DVec3::new(-1.0, 0.5, 0.0), SIZE);
    for bits in [1, 2] {
        for technique in [Technique::ZFail, Technique::ExactZPass] {
            let counting = Counting { bits, overflow: Overflow::Exact };
            let shot = assert_exact(&mut stage, &scene, &Settings { technique, counting, ..settings.clone() });
            assert!(note(&shot).contains("batches"), "{}", note(&shot));
        }
    }
}

#[test]
fn with_four_samples_the_wide_count_draws_what_z_fail_draws() {
    let scene = stock::build("cubes").unwrap().unwrap();
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let settings = Settings { samples: 4, size: [120, 68], ..Settings::default() };
    let by_stencil = stage.shoot(&settings, &scene).image;
    let wide = stage.shoot(&Settings { technique: Technique::Wide, ..settings }, &scene);
    assert_eq!(wide.plan.samples, 4);
    assert!(wide.image == by_stencil);
}

#[test]
fn the_count_itself_is_shown_as_far_as_the_colours_tell_it() {
    let (scene, settings) = stacked(false);
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let shot = stage.shoot(&Settings { show: Show::Stencil, ..settings }, &scene);
    assert!(note(&shot).contains("wide"), "{}", note(&shot));
    let counts = readback::counts(&stage.context, &stage.renderer).unwrap();
    let shown = stage.stencil();
    assert!(shown.iter().zip(&counts).all(|(&shown, &count)| f32::from(shown) == count.clamp(0.0, 127.0)));
    assert!(counts.contains(&300.0));
}

fn planned(one_mesh: bool, capabilities: &Capabilities) -> FramePlan {
    let (scene, settings) = stacked(one_mesh);
    director::stage(&settings, &scene, capabilities).unwrap().1
}

#[test]
fn a_device_that_cannot_blend_single_precision_counts_in_half() {
    let capabilities = Capabilities { wide_counts: obscura::frame::WideCounts::Float16, ..Capabilities::complete() };
    let plan = planned(true, &capabilities);
    assert!(plan.notes.iter().any(|note| note.contains("R16Float")), "{:?}", plan.notes);
}

/// What validation says of a plan after `change` was made to the first step of this program.
fn spoil(one_mesh: bool, program: Program, change: impl Fn(&mut Draw)) -> &'static str {
    let mut plan = planned(one_mesh, &Capabilities::complete());
    assert_eq!(validate(&plan), Ok(()));
    let draw = plan.steps.iter_mut().find_map(|step| match &mut step.action {
        Action::Draw(draw) if draw.program == program => Some(draw),
        _ => None,
    });
    change(draw.unwrap());
    validate(&plan).unwrap_err().what
}

#[test]
fn validation_knows_what_batches_and_wide_counts_must_be() {
    let collapse = |change: &dyn Fn(&mut Draw)| spoil(false, Program::StencilOnly, change);
    assert!(collapse(&|draw| draw.state.stencil.write_mask = 0x80).contains("leaves a part"));
    assert!(collapse(&|draw| draw.stencil_reference = 0).contains("no verdict"));
    assert!(collapse(&|draw| draw.light = Some(1)).contains("was not made"));
    assert!(collapse(&|draw| draw.state.depth = obscura::frame::state::Depth::NEARER).contains("depth"));
    let wide = |change: &dyn Fn(&mut Draw)| spoil(true, Program::VolumeNumbers, change);
    assert!(wide(&|draw| draw.constant[0] = -1.0).contains("sign"));
    assert!(wide(&|draw| draw.state.depth = obscura::frame::state::Depth::NEARER).contains("not nearer"));
    assert!(wide(&|draw| draw.state.color = None).contains("added"));
    assert!(wide(&|draw| draw.target = Target::Direct).contains("nowhere else"));
    let verdict = |change: &dyn Fn(&mut Draw)| spoil(true, Program::WideVerdict, change);
    assert!(verdict(&|draw| draw.program = Program::WideVerdictEach).contains("samples"));
    assert!(verdict(&|draw| draw.light = None).contains("not counted wide"));
    assert!(verdict(&|draw| draw.state.stencil.front.pass = StencilOp::Keep).contains("replaces"));
}

#[test]
fn at_the_foot_of_the_stairs_eight_bits_fail_and_exact_techniques_do_not() {
    let scene = stock::build("stairs").unwrap().unwrap();
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let settings = Settings { size: SIZE, ..Settings::default() };
    for technique in [Technique::ZFail, Technique::ExactZPass] {
        let shot = assert_exact(&mut stage, &scene, &Settings { technique, ..settings.clone() });
        assert!(note(&shot).contains("batches"), "{}", note(&shot));
    }
    let counting = Counting { overflow: Overflow::Naive, ..Counting::default() };
    let naive = stage.verify(&Settings { counting, ..settings }, &scene);
    assert!(naive[0].wrong() > 0, "256 volumes over a pixel are none to eight bits");
}
