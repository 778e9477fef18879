//! What reflections cost: whole frames at 1280 x 720 with and without them. `cargo bench --bench mirrors`.
//!
//! Prints the views that were drawn beside the worst case (K section 3), and what a frame takes of one without
//! mirrors. The light moves every frame. Needs a device (a software one will do); says which one it measured.
#![allow(clippy::unwrap_used, missing_docs, reason = "a bench fails by panicking")]

use std::time::Instant;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use obscura::director;
use obscura::gpu::{Context, Renderer, readback};
use obscura::scene::stock;
use obscura::settings::{LightEdit, MirrorMode, Settings};

/// Scene and bounces; 0 without mirrors.
const FRAMES: [(&str, &[u32]); 3] = [("figure3", &[0, 1]), ("barbershop", &[0, 1, 2, 4, 8]), ("kaleidoscope", &[0, 1, 4])];

fn frames(criterion: &mut Criterion) {
    let context = Context::headless(None).unwrap();
    println!("on {}", context.capabilities().adapter);
    let texture = readback::target(&context, [1280, 720]);
    let target = texture.create_view(&wgpu::TextureViewDescriptor::default());
    for (name, all) in FRAMES {
        let scene = stock::build(name).unwrap().unwrap();
        let mut renderer = Renderer::new(&context, None).unwrap();
        renderer.set_scene(&context, &scene).unwrap();
        let mut group = criterion.benchmark_group(name);
        group.sample_size(30);
        let mut without = None;
        for &bounces in all {
            let mut settings = Settings::default();
            settings.mirrors.bounces = bounces.max(1);
            settings.mirrors.mode = if bounces == 0 { MirrorMode::Off } else { MirrorMode::Recursive };
            let (pose, plan) = director::stage(&settings, &scene, context.capabilities()).unwrap();
            let home = pose.lights[0].position;
            let mut frame = 0u32;
            let mut took = Vec::new();
            let label = if bounces == 0 { "without mirrors".to_owned() } else { format!("{bounces} bounces") };
            group.bench_function(label, |bencher| {
                bencher.iter(|| {
                    let begun = Instant::now();
                    frame += 1;
                    let angle = f64::from(frame) * 0.1;
                    let position = Some(home + DVec3::new(angle.cos(), 0.0, angle.sin()) * 0.3);
                    settings.lights.insert(0, LightEdit { position, ..LightEdit::default() });
                    let (pose, plan) = director::stage(&settings, &scene, context.capabilities()).unwrap();
                    renderer.render(&context, &plan, &scene, &pose, &target, readback::PICTURE_FORMAT).unwrap();
                    context.wait_idle().unwrap();
                    took.push(begun.elapsed().as_secs_f64() * 1e3);
                });
            });
            // The first frames compile pipelines.
            let mut took = took.split_off((took.len() / 2).min(20));
            took.sort_by(f64::total_cmp);
            // None where only others were asked for.
            let Some(&median) = took.get(took.len() / 2) else { continue };
            let share = median / *without.get_or_insert(median);
            let (views, worst) = (plan.views.len(), plan.reflections.worst_case.max(1));
            println!("{name}, {bounces} bounces: {median:.1} ms, {share:.2} of none; {views} views, {worst} at worst");
        }
        group.finish();
    }
}

criterion_group!(benches, frames);
criterion_main!(benches);
