//! Depth complexity in stencil integers: what rays through stacked squares say, in every order of drawing.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::{Build, Stage, seen_from, square};
use glam::DVec3;
use obscura::director::stage;
use obscura::frame::validate::validate;
use obscura::frame::{Action, Camera, Capabilities, FramePlan};
use obscura::headless::render::tally;
use obscura::scene::{AlphaMode, Material, Scene, stock};
use obscura::settings::{Complexity, Settings, Show};

const SIZE: [u32; 2] = [160, 90];

/// Squares over each other, each as high and as large (half a side, metres) as said, in this order.
fn stack(squares: &[(f64, f64)], blended: bool) -> Scene {
    let mut build = Build::new();
    build.0.materials.push(Material { name: "glass".into(), alpha: AlphaMode::Blend, ..Material::default() });
    let mesh = build.mesh(square(if blended { 2 } else { 0 }));
    for &(height, half) in squares {
        build.place(mesh, DVec3::new(0.0, height, 0.0), DVec3::new(half, 1.0, half));
    }
    build.point_light(DVec3::new(0.0, 9.0, 0.0));
    build.0
}

fn settings(complexity: Complexity) -> Settings {
    let settings = seen_from(DVec3::new(2.0, 12.0, 5.0), DVec3::new(0.2, 0.0, 0.1), SIZE);
    Settings { show: Show::Complexity, complexity, ..settings }
}

/// Which squares the ray through a pixel meets, farthest first; none where it passes a rim closely.
fn met(camera: &Camera, squares: &[(f64, f64)], pixel: [u32; 2]) -> Option<Vec<usize>> {
    let corners = camera.near_rectangle_of([pixel[0], pixel[1], 1, 1], SIZE);
    let way = corners.iter().sum::<DVec3>() / 4.0 - camera.eye;
    let mut met = Vec::new();
    for (index, &(height, half)) in squares.iter().enumerate() {
        let share = (height - camera.eye.y) / way.y;
        let at = camera.eye + way * share;
        let inside = half - at.x.abs().max(at.z.abs());
        if share <= 0.0 || inside.abs() < 1e-3 {
            return None;
        }
        if inside > 0.0 {
            met.push((share, index));
        }
    }
    met.sort_by(|a, b| b.0.total_cmp(&a.0));
    Some(met.into_iter().map(|(_, index)| index).collect())
}

/// Draws, and holds every pixel that is decided against `expected` of the squares it meets, farthest first.
fn assert_counts(squares: &[(f64, f64)], blended: bool, complexity: Complexity, expected: impl Fn(&[usize]) -> usize) {
    let scene = stack(squares, blended);
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let settings = settings(complexity);
    let shot = stage.shoot(&settings, &scene);
    let stencil = stage.stencil();
    let mut decided = [0usize; 5];
    for (index, &count) in (0u32..).zip(&stencil) {
        let pixel = [index % SIZE[0], index / SIZE[0]];
        if let Some(met) = met(&shot.plan.views[0].camera, squares, pixel) {
            assert_eq!(usize::from(count), expected(&met).min(255), "pixel {pixel:?} meets {met:?}");
            decided[met.len().min(4)] += 1;
        }
    }
    assert!(decided.iter().take(squares.len().min(4)).all(|&pixels| pixels > 20), "{decided:?}");
    let tally = tally(&stage.context, &stage.renderer, &settings).unwrap();
    assert_eq!(tally.maximum, *stencil.iter().max().unwrap());
    let sum: u64 = stencil.iter().map(|&count| u64::from(count)).sum();
    assert!((tally.average - sum as f64 / f64::from(SIZE[0] * SIZE[1])).abs() < 1e-9);
}

// Of much the same size: the largest surfaces of a scene are drawn last.
const UPWARD: [(f64, f64); 3] = [(0.0, 4.0), (1.5, 3.2), (3.0, 2.4)];

#[test]
fn updates_depend_on_the_order_and_fragments_do_not() {
    let downward = [UPWARD[2], UPWARD[1], UPWARD[0]];
    assert_counts(&UPWARD, false, Complexity::Updates, <[usize]>::len);
    assert_counts(&downward, false, Complexity::Updates, |met| usize::from(!met.is_empty()));
    assert_counts(&UPWARD, false, Complexity::Fragments, <[usize]>::len);
    assert_counts(&downward, false, Complexity::Fragments, <[usize]>::len);
    // Blended surfaces are drawn far to near, whatever their order in the scene, and hide nothing.
    assert_counts(&downward, true, Complexity::Updates, <[usize]>::len);
}

#[test]
fn a_full_byte_stays_full() {
    let many: Vec<_> = (0..300).map(|layer| (f64::from(layer) * 0.01, 3.0)).collect();
    let scene = stack(&many, false);
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let settings = settings(Complexity::Fragments);
    stage.shoot(&settings, &scene);
    let tally = tally(&stage.context, &stage.renderer, &settings).unwrap();
    assert_eq!(tally.maximum, 255);
    assert!(tally.saturated > 1000, "{tally}");
    assert!(tally.to_string().contains("255"), "{tally}");
}

fn plan(settings: &Settings) -> FramePlan {
    stage(settings, &stack(&UPWARD, false), &Capabilities::complete()).unwrap().1
}

#[test]
fn validation_knows_what_fragments_may_be_counted_in() {
    let good = plan(&settings(Complexity::Updates));
    assert_eq!(validate(&good), Ok(()));
    let spoiled = |change: &dyn Fn(&mut FramePlan)| {
        let mut plan = good.clone();
        change(&mut plan);
        validate(&plan).unwrap_err().what
    };
    assert!(spoiled(&|plan| plan.steps.retain(|step| !step.label.starts_with("count"))).contains("were not counted"));
    assert!(
        spoiled(&|plan| {
            for step in &mut plan.steps {
                if let Action::Draw(draw) = &mut step.action
                    && step.label.starts_with("count")
                {
                    draw.state.stencil.write_mask = 0x7f;
                }
            }
        })
        .contains("marked in one of the bits")
    );
    let mut few = settings(Complexity::Updates);
    few.counting.bits = 3;
    few.culling.depth_bounds = true;
    assert_eq!(plan(&few).budget, good.budget, "a clamped count needs the whole byte");
}

#[test]
fn mirrors_are_ordinary_surfaces_and_that_is_said() {
    let scene = stock::build("gallery").unwrap().unwrap();
    let settings = Settings { show: Show::Complexity, ..Settings::default() };
    let (_, plan) = stage(&settings, &scene, &Capabilities::complete()).unwrap();
    assert_eq!(plan.views.len(), 1);
    assert!(plan.notes.iter().any(|note| note.contains("mirrors are ordinary surfaces")), "{:?}", plan.notes);
}
