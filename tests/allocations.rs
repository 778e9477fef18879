//! What is planned frame after frame allocates nothing that grows with the scene. Alone in its process: every thread's
//! allocations are counted.
#![allow(clippy::unwrap_used, missing_docs, reason = "a test fails by panicking")]

use std::alloc::System;

use obscura::director::Planner;
use obscura::frame::Capabilities;
use obscura::headless::bench::go_round;
use obscura::scene::{Scene, generated};
use obscura::settings::{Backend, Settings, Technique};
use obscura::techniques::row;
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Frames of one round of the lights.
const ROUND: u32 = 8;

/// Allocations and bytes of a frame: words that say how many there are have more digits. An entry for each of 72 casters
/// more would be as many bytes at the very least.
const MORE_DIGITS: [usize; 2] = [1, 70];

/// How often one round asks for memory, and for how many bytes, when a few have gone before.
fn allocated(scene: &Scene, settings: &Settings) -> [usize; 2] {
    let mut planner = Planner::default();
    let mut round = || {
        let region = Region::new(ALLOCATOR);
        for frame in 0..ROUND {
            let turns = f64::from(frame) / f64::from(ROUND);
            let capabilities = Capabilities::complete();
            let moved = |pose: &mut _| go_round(pose, turns, 0.1);
            let staged = planner.stage_changed(settings, scene, &capabilities, 0, moved).unwrap();
            planner.take_back(staged);
        }
        let change = region.change();
        [change.allocations + change.reallocations, change.bytes_allocated]
    };
    (0..4).for_each(|_| _ = round());
    round()
}

fn in_three_lights(casters: u32) -> Scene {
    let mut scene = generated::casters(casters);
    let light = scene.lights[0].clone();
    scene.lights.extend([light.clone(), light]);
    scene
}

#[test]
fn planning_allocates_nothing_that_grows_with_the_scene() {
    for (what, [few, many]) in [
        ("casters", [8, 80].map(generated::casters)),
        ("casters in three lights", [8, 80].map(in_three_lights)),
        ("triangles", [0, 3].map(generated::triangles)),
    ] {
        // What darkens by one caster after the other has steps for each, with words of their own.
        for technique in Technique::ALL.into_iter().filter(|technique| row(*technique).darkens.is_none()) {
            for silhouettes in [Backend::Cpu, Backend::Compute] {
                let settings = Settings { technique, silhouettes, size: [320, 180], ..Settings::default() };
                let [of_few, of_many] = [&few, &many].map(|scene| allocated(scene, &settings));
                let more: [usize; 2] = std::array::from_fn(|of| of_many[of].saturating_sub(of_few[of]) / ROUND as usize);
                let said = format!("{what} by {}, silhouettes {silhouettes:?}: {more:?}", technique.name());
                assert!(more[0] <= MORE_DIGITS[0] && more[1] <= MORE_DIGITS[1], "{said}");
            }
        }
    }
}
