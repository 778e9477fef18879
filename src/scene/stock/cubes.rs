//! Beam's demo: four cubes over a floor throw their shadows on it and on a sphere. The cheapest
//! scene: one light, a floor coloured by its vertices.

use glam::{DQuat, DVec3};

use super::compose::{Composer, FLOORS, FURNITURE, SOLIDS, at, circle};
use crate::scene::gltf::ImportError;
use crate::scene::{LightKind, Scene};

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("cubes", &[SOLIDS, FLOORS, FURNITURE])?;
    c.environment([0.085, 0.095, 0.12], [0.05, 0.045, 0.04], [0.030, 0.042, 0.070], [0.075, 0.085, 0.105]);

    let floor = c.prop("chequers");
    let floor = c.receiving(floor);
    c.put("floor", floor, at(0.0, 0.0, 0.0));
    let ball = c.prop("ball");
    let ivory = c.tinted(ball, [0.70, 0.64, 0.54], 0.35);
    c.put("sphere", ivory, at(0.0, 0.8, 0.0).sized(1.6));

    let cube = c.prop("bevelled cube");
    let ring = c.group("cubes", None, at(0.0, 1.85, 0.0));
    c.turns(ring, 24.0, 24, |turns| DQuat::from_rotation_y(turns * std::f64::consts::TAU));
    let colors = [[0.66, 0.13, 0.07], [0.72, 0.42, 0.06], [0.05, 0.36, 0.34], [0.10, 0.17, 0.52]];
    for (i, color) in colors.into_iter().enumerate() {
        let paint = c.tinted(cube, color, 0.5);
        let turns = i as f64 / 4.0 + 0.125;
        let p = circle(DVec3::ZERO, 1.5, turns);
        let lift = [0.0, 0.35, -0.15, 0.2][i];
        let name = ["red cube", "yellow cube", "green cube", "blue cube"][i];
        let node = c.put_on(Some(ring), name, paint, at(p.x, p.y + lift, p.z).facing(turns * 360.0 + 20.0).sized(0.78));
        let start = DQuat::from_rotation_y(turns * std::f64::consts::TAU + 0.35);
        let tilt = DVec3::new(1.0, 0.4, 0.2 * i as f64 - 0.3).normalize();
        c.turns(node, [12.0, 16.0, 14.0, 18.0][i], 24, move |t| {
            start * DQuat::from_axis_angle(tilt, (t + 0.09 + 0.13 * i as f64) * std::f64::consts::TAU)
        });
    }

    let lamp = c.group("lamp", None, at(-3.0, 4.5, 2.8));
    c.light(lamp, LightKind::Point, [1.0, 0.93, 0.82], 85.0, 18.0);
    c.moves(lamp, 10.0, 32, |turns| circle(DVec3::new(-3.35, 4.5, 2.8), 0.35, turns));
    let flame = c.prop("flame");
    let glow = c.glowing(flame, [1.0, 0.93, 0.82]);
    c.put_on(Some(lamp), "bulb", glow, at(0.0, 0.0, 0.0).sized(1.5));

    c.camera("front", [0.9, 3.7, 6.9], [0.0, 1.05, 0.0], 40.0);
    c.camera("low", [-4.6, 0.7, 3.6], [0.2, 1.2, -0.2], 50.0);
    c.camera("above", [0.4, 8.2, 3.4], [0.0, 0.4, 0.0], 45.0);
    Ok(c.finish())
}
