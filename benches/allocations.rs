//! What a frame allocates once everything is there: how often, and how many bytes, in scenes that grow. `cargo bench
//! --bench allocations`.
//!
//! Counted is what this process asks its allocator for, planning and drawing apart; a driver's own memory is not. What
//! grows with the scene would be marked in the last line. Needs a device (a software one will do).
#![allow(clippy::unwrap_used, missing_docs, reason = "a bench fails by panicking")]

use std::alloc::System;

use obscura::director;
use obscura::gpu::{Context, Renderer, readback};
use obscura::headless::bench::go_round;
use obscura::scene::generated;
use obscura::settings::{Settings, Technique};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, Stats, StatsAlloc};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Frames before counting, and counted ones.
const FRAMES: [u32; 2] = [30, 20];

/// Allocations, those that grew what was there among them, and bytes.
fn add(sums: &mut [usize; 2], stats: &Stats) {
    sums[0] += stats.allocations + stats.reallocations;
    sums[1] += stats.bytes_allocated;
}

fn main() {
    let context = Context::headless(None).unwrap();
    println!("on {}; allocations and bytes of one frame", context.capabilities().adapter);
    println!("{:>8}  {:>10}  {:>21}  {:>21}", "casters", "technique", "planned", "drawn");
    let texture = readback::target(&context, [320, 180]);
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    for technique in [Technique::None, Technique::ZFail, Technique::Auto] {
        let settings = Settings { technique, size: [320, 180], ..Settings::default() };
        let mut counts = Vec::new();
        for casters in [32, 64, 128, 256, 512, 1024] {
            let scene = generated::casters(casters);
            let mut renderer = Renderer::new(&context, None).unwrap();
            renderer.set_scene(&context, &scene).unwrap();
            let (mut planned, mut drawn) = ([0; 2], [0; 2]);
            for frame in 0..FRAMES[0] + FRAMES[1] {
                let region = Region::new(ALLOCATOR);
                let turns = f64::from(frame) / 20.0;
                let (pose, plan) = director::stage_changed(&settings, &scene, context.capabilities(), 0, |pose| {
                    go_round(pose, turns, 0.1);
                })
                .unwrap();
                let of_plan = region.change();
                let region = Region::new(ALLOCATOR);
                renderer.render(&context, &plan, &scene, &pose, &view, readback::PICTURE_FORMAT).unwrap();
                context.wait_idle().unwrap();
                if frame >= FRAMES[0] {
                    add(&mut planned, &of_plan);
                    add(&mut drawn, &region.change());
                }
            }
            let [plan, draw] = [planned, drawn].map(|sums| sums.map(|sum| sum / FRAMES[1] as usize));
            println!(
                "{casters:>8}  {:>10}  {:>8} {:>10} B  {:>8} {:>10} B",
                technique.name(),
                plan[0],
                plan[1],
                draw[0],
                draw[1]
            );
            counts.push([plan, draw]);
        }
        let (first, last) = (counts[0], counts[counts.len() - 1]);
        for (what, part) in [("planning", 0), ("drawing", 1)] {
            let [more, bytes] = [0, 1].map(|of| last[part][of] as i64 - first[part][of] as i64);
            let per = |more: i64| more as f64 / (1024.0 - 32.0);
            println!(
                "{what} by {}: {:.3} allocations and {:.1} bytes more for each caster",
                technique.name(),
                per(more),
                per(bytes)
            );
        }
    }
}
