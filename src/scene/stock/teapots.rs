//! Kilgard's figure 9: a cut-out hangs over teapots and balls; its pattern falls on the floor and
//! bends over what is round. His was a planar polygon and the teapots threw no shadow; here the
//! slab has a thickness, and everything shadows everything.

use glam::DVec3;

use super::compose::{CUTOUT, Composer, FLOORS, FURNITURE, SOLIDS, TEAPOT, at};
use crate::scene::gltf::ImportError;
use crate::scene::{LightKind, Scene};

/// Degrees the slab leans back from upright.
const TILT: f64 = 60.0;

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("teapots", &[SOLIDS, FLOORS, TEAPOT, CUTOUT, FURNITURE])?;
    c.environment([0.080, 0.085, 0.10], [0.055, 0.045, 0.04], [0.020, 0.020, 0.026], [0.052, 0.046, 0.044]);

    let floor = c.prop("planks");
    let floor = c.receiving(floor);
    c.put("floor", floor, at(0.0, 0.0, 0.0).facing(90.0));

    let teapot = c.prop("teapot");
    let glazes = [
        ("white teapot", [0.74, 0.70, 0.62], (1.50, -0.30, 200.0, 2.2)),
        ("green teapot", [0.16, 0.38, 0.26], (0.70, -1.75, 160.0, 1.9)),
        ("blue teapot", [0.05, 0.12, 0.40], (-1.80, -0.25, -20.0, 2.0)),
    ];
    for (name, color, (x, z, facing, size)) in glazes {
        let glazed = c.tinted(teapot, color, 0.25);
        c.put(name, glazed, at(x, 0.0, z).facing(facing).sized(size));
    }
    let ball = c.prop("ball");
    let balls = [
        ("red ball", [0.60, 0.06, 0.04], (0.55, 0.80, 0.22)),
        ("ochre ball", [0.70, 0.40, 0.08], (-0.80, 1.00, 0.20)),
        ("ivory ball", [0.72, 0.68, 0.60], (-0.15, -0.70, 0.38)),
        ("grey ball", [0.20, 0.21, 0.24], (2.60, 0.55, 0.26)),
    ];
    for (name, color, (x, z, radius)) in balls {
        let painted = c.tinted(ball, color, 0.3);
        c.put(name, painted, at(x, radius, z).sized(radius * 2.0));
    }

    // The slab swings on four strings about a line far above.
    let hook = c.group("hook", None, at(0.0, 6.0, 0.7));
    c.swings(hook, 6.0, DVec3::X, 2.2);
    let word = c.prop("word");
    let word = c.tinted(word, [0.17, 0.026, 0.02], 0.4);
    c.put_on(Some(hook), "cut-out", word, at(0.0, -4.2, 0.0).turned(DVec3::X, -TILT).sized(0.8));
    let cube = c.prop("cube");
    let string = c.tinted(cube, [0.10, 0.08, 0.06], 0.9);
    for (x, z) in [(-1.3, -0.28), (1.3, -0.28), (-1.3, 0.28), (1.3, 0.28)] {
        // From the slab's surface straight up.
        let y = -4.2 - z * (TILT.to_radians().tan().recip());
        c.put_on(Some(hook), "string", string, at(x, y / 2.0, z).stretched(0.012, -y, 0.012));
    }

    let lamp = c.group("lamp", None, at(0.25, 4.2, 2.2));
    c.light(lamp, LightKind::Point, [1.0, 0.92, 0.80], 95.0, 14.0);
    c.moves(lamp, 9.0, 32, |turns| {
        let (sin, cos) = (turns * std::f64::consts::TAU).sin_cos();
        DVec3::new(0.25 * cos, 4.2 + 0.1 * sin, 2.2)
    });
    c.point_light("window", [-4.6, 2.8, -1.6], [0.50, 0.66, 1.0], 20.0, 14.0);

    c.camera("front", [0.25, 2.55, 4.5], [0.1, 0.58, -0.2], 42.0);
    c.camera("close", [-1.1, 0.95, 3.3], [-0.05, 0.45, -0.4], 42.0);
    c.camera("side", [3.7, 1.75, 2.3], [0.0, 0.55, -0.4], 44.0);
    Ok(c.finish())
}
