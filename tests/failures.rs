//! Every failure of the gallery is there with its switch, and gone without: by exact rays on its own
//! demonstration, pixel by pixel.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::Stage;
use obscura::director;
use obscura::failures::{demonstration, row, spoil, while_on};
use obscura::frame::validate::validate;
use obscura::frame::{Camera, Capabilities};
use obscura::scene::{Pose, Scene, stock};
use obscura::settings::{CameraChoice, Failure, SceneChoice, Settings, Show};
use obscura::techniques::workspace::Workspace;
use obscura::truth::{Verdict, World};

/// Wrong pixels that a demonstration of this size shows at least.
fn least(failure: Failure) -> usize {
    match failure {
        Failure::EyeInShadow | Failure::DarkCapFan => 3000,
        Failure::TJunction => 10,
        Failure::StencilOverflow => 20,
        Failure::MismatchedArithmetic => 100,
        _ => 200,
    }
}

const SIZE: [u32; 2] = [240, 135];

fn scene_of(failure: Failure) -> Scene {
    stock::build(row(failure).scene).unwrap().unwrap()
}

#[test]
fn every_failure_is_there_with_its_switch_and_gone_without() {
    let mut stage = Stage::new();
    let mut faults = Vec::new();
    for failure in Failure::ALL {
        let scene = scene_of(failure);
        stage.set_scene(&scene);
        let on = Settings { show: Show::Shadow, ..demonstration(failure, &Settings { size: SIZE, ..Settings::default() }) };
        let off = Settings { failure: None, ..on.clone() };
        let right = stage.shoot(&off, &scene);
        let camera = &right.plan.views[0].camera;
        let light = &right.pose.lights[on.light];
        let verdicts = World::new(&scene, &right.pose).judge(camera, light, SIZE);
        let (without, with) = (verdicts.compare(&right.image), verdicts.compare(&stage.shoot(&on, &scene).image));
        let lit = verdicts.pixels().iter().filter(|verdict| **verdict == Verdict::Lit).count();
        println!("{}: {} of {} wrong with it, {lit} lit", failure.name(), with.wrong(), with.decided);
        if without.wrong() > 0 {
            faults.push(format!("{} switched off: {:?}", failure.name(), &without.pixels[..without.wrong().min(5)]));
        }
        if with.wrong() < least(failure) {
            faults.push(format!("{}: only {} wrong", failure.name(), with.wrong()));
        }
        if lit < 1000 || without.shadow < 100 {
            faults.push(format!("{}: too little to see", failure.name()));
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

#[test]
fn any_scene_may_be_spoiled_from_any_camera() {
    for entry in stock::TABLE.iter().chain(stock::DEMONSTRATIONS) {
        let scene = stock::build(entry.name).unwrap().unwrap();
        for failure in Failure::ALL {
            for camera in 0..scene.cameras.len() {
                let settings = Settings {
                    scene: SceneChoice::Stock(entry.name.into()),
                    camera: CameraChoice::Named(camera.to_string()),
                    failure: Some(failure),
                    size: [64, 36],
                    ..Settings::default()
                };
                let staged = director::stage(&settings, &scene, &Capabilities::complete());
                let (_, plan) = staged.unwrap_or_else(|error| panic!("{} on {}: {error}", failure.name(), entry.name));
                assert!(plan.notes.last().unwrap().contains(failure.name()), "{:?}", plan.notes);
            }
        }
    }
}

#[test]
fn a_spoiled_plan_breaks_its_own_rule_and_no_other() {
    let failure = Failure::NearPlane;
    let scene = scene_of(failure);
    let settings = demonstration(failure, &Settings { size: SIZE, ..Settings::default() });
    let (pose, plan): (Pose, _) = director::stage(&settings, &scene, &Capabilities::complete()).unwrap();
    assert!(validate(&plan).is_ok() && plan.breaks.is_some());

    let mut innocent = plan.clone();
    innocent.breaks = None;
    assert!(validate(&innocent).unwrap_err().to_string().contains("depth clamp"));

    let mut worse = plan.clone();
    worse.volumes.iter_mut().for_each(|volume| volume.light += 1);
    assert!(validate(&worse).unwrap_err().to_string().contains("another light's volume"));

    // What `stage` does, in its parts: the plan is made by the failure's technique, then spoiled.
    let camera = Camera::choose(&settings, &scene, &pose).unwrap();
    let (workspace, before) = (Workspace::default(), plan.clone());
    let mut parts =
        director::plan(&while_on(&settings), &scene, &pose, camera, &Capabilities::complete(), None, (&workspace, before));
    assert_ne!(parts, plan);
    spoil(failure, &mut parts);
    assert_eq!(parts, plan);
}
