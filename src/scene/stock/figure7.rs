//! K's figures 6, 7 and 14: a dinosaur on a tile that hangs in the sky, so that a projected shadow that nothing bounds
//! goes on in mid-air, and shows where its own triangles lie over each other. A second receiver stands upright behind
//! it, a sun and a lamp throw two shadows of everything, and a flat rosette shades the dinosaur too: which planar
//! shadows cannot, and volumes of cut-outs can.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use super::carpentry::boxes;
use super::compose::{Composer, FLOORS, SOLIDS, TOYS, at};
use crate::scene::gltf::ImportError;
use crate::scene::{LightKind, Scene};

/// Half the tile: across, and along.
const TILE: [f32; 2] = [1.75, 1.35];
/// Half the board: across, and up.
const BOARD: [f32; 2] = [1.25, 0.85];

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("figure7", &[SOLIDS, FLOORS, TOYS])?;
    c.environment([0.20, 0.23, 0.30], [0.14, 0.12, 0.11], [0.13, 0.25, 0.50], [0.80, 0.62, 0.46]);

    let planks = c.prop("planks");
    let tile = c.laid(planks, TILE, 1.1);
    let tile = c.receiving(tile);
    c.put("tile", tile, at(0.0, 0.0, 0.0));
    let [x, z] = TILE.map(|half| 2.0 * half);
    let slab = boxes(
        &mut c,
        "slab",
        &[
            ([0.0, -0.07, 0.0], [x - 0.01, 0.12, z - 0.01]),
            ([0.0, -0.055, z / 2.0 + 0.02], [x + 0.1, 0.15, 0.06]),
            ([0.0, -0.055, -z / 2.0 - 0.02], [x + 0.1, 0.15, 0.06]),
            ([x / 2.0 + 0.021, -0.054, 0.0], [0.06, 0.148, z - 0.03]),
            ([-x / 2.0 - 0.021, -0.054, 0.0], [0.06, 0.148, z - 0.03]),
        ],
        [0.16, 0.065, 0.028],
        0.5,
    );
    c.put("slab", slab, at(0.0, 0.0, 0.0));

    let ivory = c.laid(planks, BOARD, 0.9);
    let ivory = c.tinted(ivory, [0.50, 0.47, 0.41], 0.95);
    let board = c.receiving(ivory);
    let easel = c.group("easel", None, at(0.50, 0.98, -1.0).facing(-8.0));
    c.put_on(Some(easel), "board", board, at(0.0, 0.0, 0.0).turned(DVec3::X, 90.0));
    let [width, height] = BOARD.map(|half| 2.0 * half);
    let back = boxes(
        &mut c,
        "back",
        &[
            ([0.0, 0.0, -0.03], [width - 0.01, height - 0.01, 0.05]),
            ([0.0, height / 2.0 + 0.018, -0.012], [width + 0.09, 0.05, 0.07]),
            ([0.0, -height / 2.0 - 0.018, -0.012], [width + 0.09, 0.05, 0.07]),
            ([width / 2.0 + 0.018, 0.0, -0.012], [0.05, height, 0.068]),
            ([-width / 2.0 - 0.018, 0.0, -0.012], [0.05, height, 0.068]),
        ],
        [0.10, 0.12, 0.15],
        0.5,
    );
    c.put_on(Some(easel), "back", back, at(0.0, 0.0, 0.0));

    let turntable = c.group("dinosaur", None, at(-0.62, 0.0, 0.30));
    c.turns(turntable, 24.0, 32, |turns| DQuat::from_rotation_y(-0.45 + 0.3 * (turns * TAU).sin()));
    let dinosaur = c.prop("dinosaur");
    let dinosaur = c.painted(dinosaur, 0, [0.16, 0.42, 0.14], 0.5);
    c.put_on(Some(turntable), "dinosaur", dinosaur, at(0.0, 0.685, 0.0));
    let ball = c.prop("ball");
    for (name, color, (x, z, radius)) in
        [("red ball", [0.62, 0.06, 0.04], (1.12, 0.72, 0.20)), ("yellow ball", [0.76, 0.50, 0.05], (-1.38, 0.98, 0.13))]
    {
        let painted = c.tinted(ball, color, 0.3);
        c.put(name, painted, at(x, radius, z).sized(2.0 * radius));
    }
    let rosette = c.prop("rosette");
    let rosette = c.tinted(rosette, [0.05, 0.06, 0.10], 0.4);
    let hanger = c.put("rosette sheet", rosette, at(-1.5, 1.5, 0.85).sized(0.48));
    c.turns(hanger, 18.0, 32, |turns| {
        DQuat::from_rotation_y(-0.35 + 0.25 * (turns * TAU).sin())
            * DQuat::from_rotation_x(-0.5)
            * DQuat::from_rotation_z(turns * TAU)
    });

    let sun = c.looking("sun", [-2.0, 1.8, 2.15], [0.0, 0.0, 0.0]);
    c.light(sun, LightKind::Directional, [1.0, 0.86, 0.66], 3.0, f32::INFINITY);
    c.point_light("lamp", [2.5, 2.2, 1.5], [0.55, 0.70, 1.0], 30.0, 18.0);
    c.camera("figure", [0.85, 2.35, 4.35], [0.03, 0.36, -0.1], 42.0);
    c.camera("low", [-1.9, 0.75, 4.0], [0.0, 0.55, -0.2], 42.0);
    c.camera("below", [0.9, -1.3, 3.6], [0.0, 0.1, 0.0], 46.0);
    Ok(c.finish())
}
