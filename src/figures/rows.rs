//! The figures themselves, a file for each paper, and what several of them say of their settings.

mod beam;
mod csci;
mod kilgard;
mod lengyel;
mod mcguire;

use glam::DVec3;

use super::Figure;
use crate::settings::{CameraChoice, LightEdit, Operation, Settings};

/// Paper by paper, in [`super::Paper::ALL`]'s order; each table in its paper's order.
pub(super) static TABLES: [&[Figure]; 5] = [kilgard::TABLE, mcguire::TABLE, lengyel::TABLE, beam::TABLE, csci::TABLE];

/// From here to there.
fn look(settings: &mut Settings, eye: [f64; 3], target: [f64; 3]) {
    settings.camera = CameraChoice::Free { eye: DVec3::from(eye), target: DVec3::from(target) };
}

/// By one of the scene's cameras.
fn camera(settings: &mut Settings, name: &str) {
    settings.camera = CameraChoice::Named(name.into());
}

fn off(settings: &mut Settings, light: usize) {
    settings.lights.insert(light, LightEdit { on: Some(false), ..LightEdit::default() });
}

fn csg(settings: &mut Settings, operation: Operation) {
    settings.csg.operation = Some(operation);
}
