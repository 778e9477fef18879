//! What it takes to plan a frame, without a device: poses and plans of whole scenes, and the clipping and the questions
//! about bodies that plans are made of. `cargo bench --bench planning`.
#![allow(clippy::unwrap_used, missing_docs, reason = "a bench fails by panicking")]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::{DAffine3, DVec2, DVec3, DVec4, Vec3};
use obscura::director;
use obscura::frame::validate::validate;
use obscura::frame::{Camera, Capabilities, FramePlan};
use obscura::geometry::clip::clipped;
use obscura::geometry::frustum::hull_rect;
use obscura::geometry::{Aabb, Body, Sight};
use obscura::scene::pose::{Poser, pose};
use obscura::scene::{Pose, Scene, generated, stock};
use obscura::settings::{Settings, Technique};
use obscura::techniques::workspace::Workspace;

/// Scenes with many casters, with many lights, with many views.
fn scenes() -> Vec<Scene> {
    let stock = ["courtyard", "stairs", "barbershop"].map(|name| stock::build(name).unwrap().unwrap());
    stock.into_iter().chain([generated::casters(1024), generated::lights(16)]).collect()
}

fn plans(criterion: &mut Criterion) {
    let capabilities = Capabilities::complete();
    for scene in scenes() {
        let mut group = criterion.benchmark_group(format!("plan of {}", scene.name));
        group.sample_size(30);
        let settings = Settings::default();
        group.bench_function("pose", |bencher| {
            let (mut poser, mut before) = (Poser::default(), Pose::default());
            bencher.iter(|| {
                let memory = std::mem::take(&mut before);
                before = poser.pose(memory, &scene, black_box(1.0), scene.default_animation, &settings.lights);
            });
        });
        let posed = pose(&scene, 0.0, scene.default_animation, &settings.lights);
        let camera = Camera::choose(&settings, &scene, &posed).unwrap();
        for technique in [Technique::None, Technique::ZFail, Technique::Auto] {
            let settings = Settings { technique, ..Settings::default() };
            // One frame after the other, in the memory of the one before.
            let (mut workspace, mut before) = (Workspace::default(), FramePlan::default());
            group.bench_function(technique.name(), |bencher| {
                bencher.iter(|| {
                    let memory = std::mem::take(&mut before).emptied();
                    workspace.take_back();
                    let posed = black_box(&posed);
                    before = director::plan(&settings, &scene, posed, camera, &capabilities, None, (&workspace, memory));
                });
            });
        }
        let memory = (&Workspace::default(), FramePlan::default());
        let plan = director::plan(&settings, &scene, &posed, camera, &capabilities, None, memory);
        group.bench_function("validation", |bencher| bencher.iter(|| validate(black_box(&plan))));
        group.finish();
    }
}

fn clipping(criterion: &mut Criterion) {
    let scene = stock::build("barbershop").unwrap().unwrap();
    let settings = Settings::default();
    let posed = pose(&scene, 0.0, scene.default_animation, &settings.lights);
    let camera = Camera::choose(&settings, &scene, &posed).unwrap();
    let clip_from_world = camera.clip_from_world();
    let sight = Sight::of_eye(camera.eye, clip_from_world, settings.size);
    let frustum = Body::frustum(camera.eye, camera.near_rectangle());
    let ahead = camera.near_rectangle().iter().sum::<DVec3>() / 4.0 - camera.eye;
    let middle = camera.eye + ahead.normalize() * 4.0;
    // A square in the middle of the view that reaches out of it, seen from before it.
    let square = [DVec2::new(-3.0, -3.0), DVec2::new(3.0, -3.0), DVec2::new(3.0, 3.0), DVec2::new(-3.0, 3.0)];
    let across = ahead.normalize().any_orthonormal_pair();
    let corners = square.map(|corner| middle + across.0 * corner.x + across.1 * corner.y);
    let toward = -ahead.normalize();
    let plane: DVec4 = toward.extend(-toward.dot(middle));
    let triangles = [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]];
    let planes = sight.planes(0.0);
    let bounds = Aabb { min: Vec3::splat(-0.5), max: Vec3::splat(0.5) };
    let boxed = Body::boxed(&bounds, &DAffine3::from_translation(middle));

    let mut group = criterion.benchmark_group("clipping");
    group.bench_function("a square by a view's planes", |bencher| bencher.iter(|| clipped(black_box(&corners), &planes)));
    group.bench_function("the view through a mirror", |bencher| {
        bencher.iter(|| sight.reflected(black_box(&triangles), plane, true));
    });
    group.bench_function("a box to its pixels", |bencher| {
        bencher.iter(|| hull_rect(black_box(&boxed).hull(), &clip_from_world, settings.size));
    });
    group.bench_function("whether a box and a view meet", |bencher| bencher.iter(|| frustum.may_meet(black_box(&boxed))));
    group.finish();
}

criterion_group!(benches, plans, clipping);
criterion_main!(benches);
