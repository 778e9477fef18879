//! The scene for mirrors: an art room. Two great mirrors face each other across it, a round one hangs on the far
//! wall, the floor is polished; three lamps of different colours, sculptures on plinths, paintings, and a visitor
//! who walks between all their reflections.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3, Vec3};

use super::carpentry::{SUNK, ceiling, disc, hung_mirror, painting, pendant, rectangle, walls};
use super::compose::{Composer, FLOORS, FURNITURE, SOLIDS, STRIDE, TOYS, WALKER, at, there_and_back};
use crate::scene::gltf::ImportError;
use crate::scene::{Reflective, Scene};

/// Half the room: across, and along; and its height.
const ROOM: [f32; 2] = [4.6, 4.0];
const HEIGHT: f32 = 3.7;

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("gallery", &[SOLIDS, FLOORS, FURNITURE, TOYS, WALKER])?;
    c.environment([0.085, 0.082, 0.090], [0.060, 0.052, 0.048], [0.010, 0.010, 0.013], [0.014, 0.012, 0.012]);
    room(&mut c);
    mirrors(&mut c);
    paintings(&mut c);
    sculptures(&mut c);
    let visitor = c.put_figure(None, WALKER, "visitor", at(0.0, 0.0, 0.0));
    c.walks(visitor, 12, |turns| there_and_back(DVec3::new(0.0, 0.0, 0.1), 1.25, 12.0 * STRIDE, turns + 0.40));
    pendant(&mut c, "amber lamp", [-2.5, 2.85, 0.9], 0.85, [1.0, 0.66, 0.32], (26.0, 12.0));
    pendant(&mut c, "blue lamp", [2.6, 2.85, 1.2], 0.85, [0.36, 0.56, 1.0], (26.0, 12.0));
    pendant(&mut c, "rose lamp", [0.3, 3.0, -2.3], 0.7, [1.0, 0.46, 0.50], (24.0, 12.0));
    c.camera("entrance", [2.2, 1.7, 3.6], [-1.5, 1.25, -1.4], 54.0);
    c.camera("between the mirrors", [3.7, 1.7, 0.7], [-4.6, 1.5, -0.3], 56.0);
    c.camera("round mirror", [0.9, 1.7, -0.6], [1.9, 1.75, -4.0], 50.0);
    c.camera("floor", [-1.3, 0.5, 3.3], [0.9, 0.8, -2.2], 54.0);
    Ok(c.finish())
}

fn room(c: &mut Composer) {
    let planks = c.prop("planks");
    let floor = c.laid(planks, ROOM, 1.5);
    let floor = c.reflecting(floor, Reflective { reflectivity: 0.22, tint: Vec3::ONE });
    let floor = c.receiving(floor);
    c.put("floor", floor, at(0.0, 0.0, 0.0));
    for (name, heights, color) in [
        ("skirting", [0.0, 0.16], [0.08, 0.055, 0.04]),
        ("wall", [0.16, 3.2], [0.115, 0.175, 0.20]),
        ("cornice", [3.2, HEIGHT], [0.44, 0.42, 0.38]),
    ] {
        let band = walls(c, name, ROOM, heights, color);
        c.put(name, band, at(0.0, 0.0, 0.0));
    }
    let above = ceiling(c, ROOM, HEIGHT, [0.42, 0.40, 0.37]);
    c.put("ceiling", above, at(0.0, 0.0, 0.0));
    let bench = c.prop("bench");
    let bench = c.tinted(bench, [0.17, 0.08, 0.04], 0.5);
    c.put("bench", bench, at(0.0, -SUNK, 0.1).facing(90.0));
}

fn mirrors(c: &mut Composer) {
    let silver = Reflective { reflectivity: 1.0, tint: Vec3::new(0.96, 0.97, 0.96) };
    let gilt = [0.50, 0.31, 0.08];
    let great = rectangle(3.4, 2.1);
    hung_mirror(c, "left mirror", at(-4.6, 1.62, -0.4).facing(90.0), &great, silver, 0.14, gilt);
    hung_mirror(c, "right mirror", at(4.6, 1.62, -0.4).facing(-90.0), &great, silver, 0.14, gilt);
    let old = Reflective { reflectivity: 0.9, tint: Vec3::new(1.0, 0.93, 0.80) };
    hung_mirror(c, "round mirror", at(1.9, 1.8, -4.0), &disc(0.78, 28), old, 0.10, gilt);
}

/// After nobody in particular.
fn paintings(c: &mut Composer) {
    let (red, blue, yellow) = ([0.56, 0.05, 0.035], [0.035, 0.10, 0.42], [0.74, 0.50, 0.05]);
    let (ink, chalk) = ([0.02, 0.02, 0.022], [0.72, 0.70, 0.64]);
    let grid = [
        ([-0.33, 0.21], [0.48, 0.62], red),
        ([0.36, -0.34], [0.42, 0.36], blue),
        ([-0.36, -0.40], [0.42, 0.24], yellow),
        ([-0.08, 0.0], [0.035, 1.06], ink),
        ([0.0, -0.13], [1.16, 0.035], ink),
        ([0.25, 0.18], [0.66, 0.03], ink),
    ];
    painting(c, "grid", at(-0.35, 1.75, -4.0), [1.2, 1.1], chalk, &grid);
    let sea = [
        ([0.0, -0.30], [1.56, 0.5], [0.03, 0.12, 0.20]),
        ([0.0, -0.06], [1.56, 0.10], [0.10, 0.30, 0.36]),
        ([0.42, 0.22], [0.24, 0.24], [0.85, 0.42, 0.10]),
        ([0.42, -0.22], [0.14, 0.22], [0.60, 0.25, 0.07]),
    ];
    painting(c, "sunset", at(-2.75, 1.75, -4.0), [1.6, 1.1], [0.42, 0.22, 0.20], &sea);
    let squares = [
        ([0.0, 0.0], [0.78, 0.78], [0.62, 0.26, 0.03]),
        ([0.0, -0.06], [0.54, 0.54], [0.70, 0.40, 0.05]),
        ([0.0, -0.11], [0.30, 0.30], [0.80, 0.62, 0.16]),
    ];
    painting(c, "squares", at(-1.8, 1.7, 4.0).facing(180.0), [1.0, 1.0], [0.45, 0.10, 0.04], &squares);
    let bars: Vec<_> = [red, chalk, blue, yellow, ink, [0.05, 0.30, 0.16], chalk, red]
        .into_iter()
        .enumerate()
        .map(|(number, color)| ([-0.7 + 0.2 * number as f32, 0.04 * (number * 5 % 4) as f32 - 0.06], [0.13, 0.8], color))
        .collect();
    painting(c, "bars", at(1.6, 1.7, 4.0).facing(180.0), [1.7, 1.1], [0.50, 0.47, 0.41], &bars);
}

fn sculptures(c: &mut Composer) {
    let plinth = c.prop("plinth");
    for (name, part, color, (x, z), scale, lift, seconds) in [
        ("knot", "knot", [0.46, 0.29, 0.12], (-2.3, -2.0), 0.95, 0.54, 26.0),
        ("ring", "torus", [0.10, 0.28, 0.44], (2.7, -2.3), 0.66, 0.55, 22.0),
        ("jack", "jack", [0.55, 0.09, 0.05], (-2.6, 2.2), 0.62, 0.40, 19.0),
        ("star", "star", [0.66, 0.46, 0.10], (3.5, 2.5), 0.66, 0.42, 23.0),
    ] {
        c.put(&format!("{name}'s plinth"), plinth, at(x, -SUNK, z).stretched(0.8, 0.85, 0.8));
        let shape = c.prop(part);
        let cast = c.tinted(shape, color, 0.4);
        let node = c.put(name, cast, at(x, 0.93 + lift, z).sized(scale));
        c.turns(node, seconds, 24, |turns| DQuat::from_rotation_y(turns * TAU));
    }
}
