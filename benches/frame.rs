//! Whole frames at 1280 x 720: planned, built, drawn, waited for. `cargo bench --bench frame`.
//!
//! The light moves every frame, so that nothing could be kept from one to the next. Needs a device
//! (a software one will do); says which one it measured.
#![allow(clippy::unwrap_used, missing_docs, reason = "a bench fails by panicking")]

use criterion::{Criterion, criterion_group, criterion_main};
use obscura::director;
use obscura::gpu::{Context, Renderer, readback};
use obscura::scene::stock;
use obscura::settings::{LightEdit, Settings, Technique};

fn frames(criterion: &mut Criterion) {
    let context = Context::headless(None).unwrap();
    println!("on {}", context.capabilities().adapter);
    let texture = readback::target(&context, [1280, 720]);
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    for row in stock::TABLE {
        let scene = stock::build(row.name).unwrap().unwrap();
        let mut renderer = Renderer::new(&context, None).unwrap();
        renderer.set_scene(&context, &scene).unwrap();
        let mut group = criterion.benchmark_group(row.name);
        group.sample_size(40);
        for technique in Technique::ALL {
            let mut settings = Settings { technique, ..Settings::default() };
            let (pose, _) = director::stage(&settings, &scene, context.capabilities()).unwrap();
            let home = pose.lights[0].position;
            let mut frame = 0u32;
            group.bench_function(technique.name(), |bencher| {
                bencher.iter(|| {
                    frame += 1;
                    let angle = f64::from(frame) * 0.1;
                    let position = Some(home + glam::DVec3::new(angle.cos(), 0.0, angle.sin()) * 0.3);
                    settings.lights.insert(0, LightEdit { position, ..LightEdit::default() });
                    let (pose, plan) = director::stage(&settings, &scene, context.capabilities()).unwrap();
                    renderer.render(&context, &plan, &scene, &pose, &view, readback::PICTURE_FORMAT).unwrap();
                    context.wait_idle().unwrap();
                });
            });
        }
        group.finish();
    }
}

criterion_group!(benches, frames);
criterion_main!(benches);
