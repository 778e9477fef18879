//! What is kept from frame to frame changes nothing: a renderer that has drawn other frames before draws what a new one draws.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::Stage;
use glam::DVec3;
use obscura::gpu::Renderer;
use obscura::scene::stock;
use obscura::settings::{Backend, CameraChoice, LightEdit, Settings, Show, Technique};

#[test]
fn a_frame_after_others_is_the_frame_alone() {
    let scene = stock::build("courtyard").unwrap().unwrap();
    let first = Settings { show: Show::Stencil, technique: Technique::ZFail, size: [160, 90], time: 1.0, ..Settings::default() };
    let eye = |x: f64| CameraChoice::Free { eye: DVec3::new(x, 4.0, 9.0), target: DVec3::ZERO };
    let moved = LightEdit { position: Some(DVec3::new(1.0, 5.0, 1.0)), ..LightEdit::default() };
    let frames = [
        ("first", first.clone()),
        ("the same", first.clone()),
        ("from elsewhere", Settings { camera: eye(2.0), ..first.clone() }),
        ("later", Settings { time: 3.0, ..first.clone() }),
        ("lit from elsewhere", Settings { lights: [(0, moved)].into(), ..first.clone() }),
        ("by z-pass", Settings { technique: Technique::ZPass, ..first.clone() }),
        ("by z-pass, from elsewhere", Settings { technique: Technique::ZPass, camera: eye(-3.0), ..first.clone() }),
        ("polygon by polygon", Settings { technique: Technique::PerPolygon, ..first.clone() }),
        ("by compute", Settings { silhouettes: Backend::Compute, ..first.clone() }),
        ("by compute, from elsewhere", Settings { silhouettes: Backend::Compute, camera: eye(2.0), ..first.clone() }),
        ("by compute, later", Settings { silhouettes: Backend::Compute, time: 3.0, ..first.clone() }),
        ("the first again", first.clone()),
    ];
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let drawn: Vec<_> = frames
        .iter()
        .map(|(_, settings)| {
            let stats = stage.shoot(settings, &scene).stats;
            (stage.stencil(), stats.indices)
        })
        .collect();
    for ((name, settings), (stencil, indices)) in frames.iter().zip(&drawn) {
        // Nor does the scene remember anything.
        let scene = scene.clone();
        stage.renderer = Renderer::new(&stage.context, None).unwrap();
        stage.set_scene(&scene);
        let shot = stage.shoot(settings, &scene);
        assert_eq!(shot.stats.indices, *indices, "{name}");
        assert!(stage.stencil() == *stencil, "{name}");
    }
    for (one, other) in [(0, 1), (0, 8), (2, 9), (3, 10), (0, 11)] {
        assert!(drawn[one].0 == drawn[other].0, "{} and {}", frames[one].0, frames[other].0);
    }
    let different = |frame: usize| assert!(drawn[frame].0 != drawn[0].0, "{} shows nothing new", frames[frame].0);
    [2, 3, 4, 6].into_iter().for_each(different);
}
