//! McGuire's image 5: a light inside a grid of cubes, shadows fanning out over an amphitheatre.

use glam::DVec3;

use super::compose::{ARCHITECTURE, Composer, FLOORS, FURNITURE, SOLIDS, at};
use crate::scene::gltf::ImportError;
use crate::scene::{LightKind, Scene};

/// From cube to cube.
const PITCH: f64 = 1.3;

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("grid", &[SOLIDS, FLOORS, ARCHITECTURE, FURNITURE])?;
    c.environment([0.050, 0.060, 0.085], [0.03, 0.03, 0.035], [0.012, 0.018, 0.040], [0.050, 0.058, 0.085]);

    let floor = c.prop("paving");
    let floor = c.receiving(floor);
    c.put("floor", floor, at(0.0, 0.0, 0.0));
    let seats = c.prop("amphitheatre");
    let seats = c.tinted(seats, [0.50, 0.44, 0.36], 0.9);
    c.put("seats", seats, at(0.0, 0.0, 0.0));

    let cube = c.prop("cube");
    let paints = [[0.55, 0.14, 0.07], [0.62, 0.55, 0.44], [0.08, 0.22, 0.34]].map(|color| c.tinted(cube, color, 0.6));
    for (layer, paint) in paints.into_iter().enumerate() {
        for row in -2..=2 {
            for column in -2..=2 {
                let place = at(f64::from(column) * PITCH, 0.9 + PITCH * layer as f64, f64::from(row) * PITCH);
                c.put(&format!("cube {layer} {row} {column}"), paint, place.sized(0.5));
            }
        }
    }

    // It stays in the lanes between the layers and columns: never inside a cube.
    let lamp = c.group("lamp", None, at(0.0, 0.9 + PITCH / 2.0, 0.0));
    c.light(lamp, LightKind::Point, [1.0, 0.84, 0.60], 46.0, 15.0);
    c.moves(lamp, 20.0, 80, |turns| {
        let (sin, cos) = (turns * std::f64::consts::TAU).sin_cos();
        let (sin2, _) = (turns * 2.0 * std::f64::consts::TAU).sin_cos();
        DVec3::new(cos * 1.9, 0.9 + PITCH * 0.5 + 0.08 * sin2, sin * 1.9)
    });
    let flame = c.prop("flame");
    let glow = c.glowing(flame, [1.0, 0.86, 0.62]);
    c.put_on(Some(lamp), "bulb", glow, at(0.0, 0.0, 0.0).sized(2.2));

    let moon = c.looking("moon", [6.0, 12.0, 9.0], [0.0, 0.0, 0.0]);
    c.light(moon, LightKind::Directional, [0.45, 0.62, 1.0], 0.55, f32::INFINITY);

    c.camera("stage", [2.4, 5.6, 10.2], [0.0, 1.55, -0.9], 45.0);
    c.camera("seats", [-7.9, 4.6, -5.4], [0.4, 1.3, 0.8], 55.0);
    c.camera("inside", [0.65, 1.55, 4.6], [-0.9, 1.9, -4.0], 62.0);
    Ok(c.finish())
}
