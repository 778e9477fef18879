//! After Kilgard's `hello2rts` (1999, 6.2.2, figure 12), "hello to real-time shadows": solid letters
//! hang over solid letters and round things, and two lights throw the upper ones on the lower, on the
//! balls and on the wall. Objects times lights is how many volumes there are: his had four.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use super::compose::{Composer, FURNITURE, SOLIDS, TOYS, at, circle};
use crate::scene::gltf::ImportError;
use crate::scene::{LightKind, Scene};

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("hello2rts", &[TOYS, SOLIDS, FURNITURE])?;
    c.environment([0.085, 0.09, 0.11], [0.07, 0.065, 0.06], [0.02, 0.025, 0.035], [0.03, 0.035, 0.04]);

    let wall = c.prop("backdrop");
    let wall = c.tinted(wall, [0.60, 0.62, 0.62], 0.95);
    c.put("wall", wall, at(0.0, 0.0, -3.2));

    // The greeting swings in a wave, each letter a little after the one before.
    for (i, which) in "HELLO".chars().enumerate() {
        let letter = c.prop(&format!("letter {which}"));
        let letter = c.tinted(letter, [0.50, 0.035, 0.03], 0.3);
        let x = (i as f64 - 2.0) * 1.02;
        let y = 2.25 - 0.05 * (i as f64 - 2.0).powi(2);
        let node = c.put(&format!("hanging {which} {i}"), letter, at(x, y, 0.5));
        let late = i as f64 * 0.13;
        c.turns(node, 7.0, 32, move |turns| {
            let (sin, cos) = ((turns - late) * TAU).sin_cos();
            DQuat::from_rotation_y(0.42 * sin) * DQuat::from_rotation_z(0.07 * cos)
        });
        c.moves(node, 7.0, 32, move |turns| DVec3::new(x, y + 0.10 * ((turns - late - 0.1) * TAU).sin(), 0.5));
    }

    // The rest of the title stands on steps and turns its face to the viewer.
    for (name, y, z) in [("wide step", 0.0, -0.75), ("step", 0.2, -1.0)] {
        let step = c.prop(name);
        let step = c.tinted(step, [0.16, 0.165, 0.18], 0.7);
        c.put(name, step, at(0.0, y, z));
    }
    let titles = [
        ('2', -1.55, [0.78, 0.46, 0.05], 20.0),
        ('R', -0.25, [0.05, 0.22, 0.44], 12.0),
        ('T', 0.62, [0.05, 0.22, 0.44], 4.0),
        ('S', 1.46, [0.05, 0.22, 0.44], -8.0),
    ];
    for (which, x, color, facing) in titles {
        let letter = c.prop(&format!("letter {which}"));
        let letter = c.tinted(letter, color, 0.3);
        c.put(
            &format!("standing {which}"),
            letter,
            at(x, 0.405, -1.0).facing(facing).sized(if which == '2' { 1.25 } else { 1.0 }),
        );
    }

    let ball = c.prop("ball");
    let balls = [
        ("ivory ball", [0.72, 0.67, 0.58], (-2.75, 0.62, 0.15), 0.62),
        ("green ball", [0.08, 0.32, 0.16], (2.55, 0.45, 0.35), 0.45),
        ("small ball", [0.70, 0.38, 0.06], (1.55, 0.26, 0.95), 0.26),
        ("grey ball", [0.24, 0.25, 0.28], (-1.35, 0.30, 0.85), 0.30),
    ];
    for (name, color, (x, y, z), radius) in balls {
        let painted = c.tinted(ball, color, 0.3);
        c.put(name, painted, at(x, y, z).sized(radius * 2.0));
    }
    let torus = c.prop("torus");
    let torus = c.tinted(torus, [0.30, 0.10, 0.40], 0.3);
    c.put("ring", torus, at(0.25, 0.19, 0.85).turned(DVec3::X, -90.0));

    let lamps = [
        ("warm lamp", [1.0, 0.70, 0.42], DVec3::new(-3.0, 4.9, 5.6), 9.0),
        ("cool lamp", [0.42, 0.66, 1.0], DVec3::new(3.4, 4.4, 5.2), 12.0),
    ];
    for (name, color, middle, seconds) in lamps {
        let lamp = c.group(name, None, at(middle.x, middle.y, middle.z));
        c.light(lamp, LightKind::Point, color, 120.0, 22.0);
        c.moves(lamp, seconds, 32, move |turns| circle(middle, 0.45, turns));
        let flame = c.prop("flame");
        let glow = c.glowing(flame, color);
        c.put_on(Some(lamp), "bulb", glow, at(0.0, 0.0, 0.0).sized(1.6));
    }

    c.camera("front", [0.35, 2.0, 6.9], [0.0, 1.45, -0.6], 42.0);
    c.camera("left", [-4.3, 2.5, 4.6], [0.3, 1.2, -0.8], 44.0);
    c.camera("low", [2.6, 0.75, 4.4], [-0.3, 1.35, -0.8], 52.0);
    Ok(c.finish())
}
