//! What a frame allocates once everything is there: how often, and how many bytes, in scenes that grow, the lights
//! moving in every frame. `cargo bench --bench allocations`.
//!
//! Counted is what this process asks its allocator for, planning and drawing apart; a driver's own memory is not. What
//! grows with the scene is marked in the last line of each table. Needs a device (a software one will do).
#![allow(clippy::unwrap_used, missing_docs, reason = "a bench fails by panicking")]

use std::alloc::System;

use glam::Vec3;
use obscura::director::Planner;
use obscura::gpu::{Context, Renderer, readback};
use obscura::headless::bench::go_round;
use obscura::scene::{Mesh, MeshParts, MorphTarget, Scene, generated};
use obscura::settings::{Backend, Settings, Technique};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, Stats, StatsAlloc};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Frames before counting, and counted ones: both are whole rounds of the lights.
const FRAMES: [u32; 2] = [40, 20];

/// Scenes of one kind, the smallest first, and how they are drawn.
struct Sweep {
    name: &'static str,
    /// What there is more and more of, and how much of it each scene has.
    grows: &'static str,
    sizes: Vec<u32>,
    scene: fn(u32) -> Scene,
    settings: Settings,
}

fn main() {
    let context = Context::headless(None).unwrap();
    println!("on {}; allocations and bytes of one frame", context.capabilities().adapter);
    let by = |technique| Settings { technique, size: [320, 180], ..Settings::default() };
    let computed = Settings { silhouettes: Backend::Compute, ..by(Technique::Auto) };
    let casters = |name, settings| {
        let sizes = vec![32, 64, 128, 256, 512, 1024];
        Sweep { name, grows: "caster", sizes, scene: generated::casters, settings }
    };
    let sweeps = [
        casters("no shadows", by(Technique::None)),
        casters("z-fail", by(Technique::ZFail)),
        casters("auto", by(Technique::Auto)),
        casters("auto, computed silhouettes", computed),
        Sweep { scene: in_three_lights, ..casters("auto, three lights", by(Technique::Auto)) },
        Sweep {
            name: "auto",
            grows: "triangle",
            sizes: (0..5).collect(),
            scene: generated::triangles,
            settings: by(Technique::Auto),
        },
        Sweep {
            name: "auto, a mesh that bends",
            grows: "triangle",
            sizes: (0..5).collect(),
            scene: bending,
            settings: by(Technique::Auto),
        },
    ];
    for sweep in sweeps {
        measure(&context, &sweep);
    }
}

fn measure(context: &Context, sweep: &Sweep) {
    println!("\n{}\n{:>9}s  {:>21}  {:>21}", sweep.name, sweep.grows, "planned", "drawn");
    let texture = readback::target(context, sweep.settings.size);
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let mut found = Vec::new();
    for &size in &sweep.sizes {
        let scene = (sweep.scene)(size);
        let size = if sweep.grows == "triangle" { (generated::FEWEST_TRIANGLES << size) as u32 } else { size };
        let mut renderer = Renderer::new(context, None).unwrap();
        renderer.set_scene(context, &scene).unwrap();
        let mut planner = Planner::default();
        let (mut planned, mut drawn) = ([0; 2], [0; 2]);
        for frame in 0..FRAMES[0] + FRAMES[1] {
            let region = Region::new(ALLOCATOR);
            let turns = f64::from(frame) / 20.0;
            let settings = Settings { time: turns, ..sweep.settings.clone() };
            let capabilities = context.capabilities();
            let (pose, plan) =
                planner.stage_changed(&settings, &scene, capabilities, 0, |pose| go_round(pose, turns, 0.1)).unwrap();
            let of_plan = region.change();
            let region = Region::new(ALLOCATOR);
            renderer.render(context, &plan, &scene, &pose, &view, readback::PICTURE_FORMAT).unwrap();
            context.wait_idle().unwrap();
            if frame >= FRAMES[0] {
                add(&mut planned, &of_plan);
                add(&mut drawn, &region.change());
            }
            planner.take_back((pose, plan));
        }
        let [plan, draw] = [planned, drawn].map(|sums| sums.map(|sum| sum / FRAMES[1] as usize));
        println!("{size:>10}  {:>8} {:>10} B  {:>8} {:>10} B", plan[0], plan[1], draw[0], draw[1]);
        found.push((size, [plan, draw]));
    }
    let [(least, first), .., (most, last)] = found[..] else { return };
    for (what, part) in [("planning", 0), ("drawing", 1)] {
        let [more, bytes] = [0, 1].map(|of| (last[part][of] as f64 - first[part][of] as f64) / f64::from(most - least));
        println!("{what}: {more:.3} allocations and {bytes:.1} bytes more for each {}", sweep.grows);
    }
}

/// Allocations, those that grew what was there among them, and bytes.
fn add(sums: &mut [usize; 2], stats: &Stats) {
    sums[0] += stats.allocations + stats.reallocations;
    sums[1] += stats.bytes_allocated;
}

fn in_three_lights(count: u32) -> Scene {
    let mut scene = generated::casters(count);
    let light = scene.lights[0].clone();
    scene.lights.extend([light.clone(), light]);
    scene
}

/// A knot that is bent anew in every frame.
fn bending(doublings: u32) -> Scene {
    let mut scene = generated::triangles(doublings);
    let node = scene.nodes.iter_mut().find(|node| node.name == "knot").unwrap();
    node.morph_weights = vec![0.5];
    let mesh = &mut scene.meshes[node.mesh.unwrap()];
    let Mesh { name, positions, indices, primitives, .. } = mesh.clone();
    let upward = positions.iter().map(|position| Vec3::Y * (position.x * 0.1)).collect();
    let morphs = vec![MorphTarget { positions: upward, normals: vec![Vec3::ZERO; positions.len()] }];
    *mesh = Mesh::new(MeshParts { name, positions, indices, primitives, morphs, ..MeshParts::default() }).unwrap();
    scene
}
