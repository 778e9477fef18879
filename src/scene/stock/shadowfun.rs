//! After Kilgard's `shadowfun` (1999, 6.2.2, figure 11): toys tumble before a wall, and two lights,
//! one warm, one cool, throw each of them on it twice. Where one light is missing the other colours
//! the shadow. His program flattened every object's silhouette into a cut-out: nothing here touches
//! the wall, so on it the technique `flattened` gives the same picture as the exact ones. The rosette
//! is flat, a planar cut-out by itself.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use super::compose::{Composer, FURNITURE, TOYS, at, circle};
use crate::scene::gltf::ImportError;
use crate::scene::{LightKind, Scene};

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("shadowfun", &[TOYS, FURNITURE])?;
    c.environment([0.095, 0.095, 0.11], [0.075, 0.07, 0.07], [0.02, 0.02, 0.03], [0.03, 0.03, 0.04]);

    let wall = c.prop("backdrop");
    c.put("wall", wall, at(0.0, 0.0, -3.4));

    // Name, part, paint, place, size, axis it tumbles about, seconds a turn.
    let toys = [
        ("dinosaur", "dinosaur", [0.10, 0.34, 0.22], (-0.15, 2.62, 0.15), 0.92, (0.12, 1.0, 0.05), 20.0),
        ("torus", "torus", [0.60, 0.07, 0.05], (-2.35, 2.75, -0.15), 1.05, (1.0, 0.35, 0.2), 11.0),
        ("star", "star", [0.80, 0.50, 0.05], (2.15, 2.95, 0.05), 0.85, (0.25, 1.0, 0.3), 13.0),
        ("jack", "jack", [0.25, 0.10, 0.42], (-1.55, 1.15, 0.45), 0.72, (0.5, 0.3, 1.0), 12.0),
        ("gear", "gear", [0.06, 0.20, 0.42], (1.42, 1.18, 0.35), 0.86, (0.3, 0.9, 0.25), 16.0),
    ];
    for (i, (name, part, color, (x, y, z), size, axis, seconds)) in toys.into_iter().enumerate() {
        let toy = c.prop(part);
        let toy = if part == "dinosaur" { c.painted(toy, 0, color, 0.4) } else { c.tinted(toy, color, 0.32) };
        let node = c.put(name, toy, at(x, y, z).sized(size));
        let axis = DVec3::from(axis).normalize();
        let start = DQuat::from_rotation_y([0.55, 0.5, -0.35, 0.3, -0.5][i]);
        c.turns(node, seconds, 32, move |turns| start * DQuat::from_axis_angle(axis, turns * TAU));
        c.moves(node, [6.0, 7.0, 8.0, 5.0, 9.0][i], 24, move |turns| {
            DVec3::new(x, y + 0.09 * ((turns + 0.21 * i as f64) * TAU).sin(), z)
        });
    }
    let rosette = c.prop("rosette");
    let rosette = c.tinted(rosette, [0.055, 0.05, 0.07], 0.4);
    let node = c.put("rosette sheet", rosette, at(3.5, 1.35, -0.5).sized(0.8));
    c.turns(node, 18.0, 32, |turns| {
        DQuat::from_rotation_y(-0.25 + 0.8 * (turns * TAU).sin()) * DQuat::from_rotation_z(turns * TAU)
    });

    let lamps = [
        ("warm lamp", [1.0, 0.56, 0.26], DVec3::new(-4.0, 3.1, 6.9), 11.0),
        ("cool lamp", [0.28, 0.62, 1.0], DVec3::new(4.1, 2.8, 7.0), 14.0),
    ];
    for (name, color, middle, seconds) in lamps {
        let lamp = c.group(name, None, at(middle.x, middle.y, middle.z));
        c.light(lamp, LightKind::Point, color, 235.0, 26.0);
        c.moves(lamp, seconds, 32, move |turns| circle(middle, 0.3, turns));
        let flame = c.prop("flame");
        let glow = c.glowing(flame, color);
        c.put_on(Some(lamp), "bulb", glow, at(0.0, 0.0, 0.0).sized(1.6));
    }

    c.camera("wall", [0.4, 2.2, 6.9], [0.3, 2.12, -1.6], 37.0);
    c.camera("from the side", [-5.4, 1.7, 3.4], [0.9, 1.9, -2.0], 48.0);
    c.camera("close", [1.5, 2.9, 4.2], [-0.5, 2.2, -1.2], 46.0);
    Ok(c.finish())
}
