//! K's figure 19: two solids put together, A or B, A and B, A minus B, B minus A. A is a ball, B a knot that winds in and
//! out of it, so that a ray may meet either side of it several times.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use super::carpentry::SUNK;
use super::compose::{Composer, FLOORS, FURNITURE, SOLIDS, TOYS, at};
use crate::scene::gltf::ImportError;
use crate::scene::{Operands, Scene};
use crate::settings::Operation;

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("csg", &[SOLIDS, FLOORS, FURNITURE, TOYS])?;
    c.environment([0.100, 0.105, 0.125], [0.075, 0.066, 0.060], [0.040, 0.046, 0.066], [0.085, 0.075, 0.072]);
    let planks = c.prop("planks");
    let floor = c.laid(planks, [7.0, 7.0], 1.5);
    c.put("floor", floor, at(0.0, 0.0, 0.0));
    let backdrop = c.prop("backdrop");
    let backdrop = c.tinted(backdrop, [0.21, 0.26, 0.33], 1.0);
    c.put("backdrop", backdrop, at(0.0, -0.01, -3.6).stretched(1.2, 1.0, 1.0));
    let plinth = c.prop("plinth");
    c.put("plinth", plinth, at(0.0, -SUNK, 0.0).stretched(1.25, 0.75, 1.25));

    // Both turn together: the solid keeps its shape.
    let turntable = c.group("turntable", None, at(0.0, 1.62, 0.0));
    c.turns(turntable, 24.0, 32, |turns| DQuat::from_rotation_y(turns * TAU));
    let ball = c.prop("ball");
    let ivory = c.tinted(ball, [0.72, 0.66, 0.52], 0.35);
    let a = c.put_on(Some(turntable), "ball", ivory, at(0.0, 0.0, 0.0).sized(1.5));
    let knot = c.prop("knot");
    let red = c.tinted(knot, [0.60, 0.085, 0.05], 0.35);
    let b = c.put_on(Some(turntable), "knot", red, at(0.05, 0.02, 0.08).turned(DVec3::X, 38.0).sized(1.38));
    c.combines(Operands { a, b, operation: Operation::AMinusB });

    for (name, part, color, (x, y, z), degrees, size) in [
        ("gear", "gear", [0.10, 0.26, 0.44], (-1.55, 0.36, 0.35), 35.0, 0.7),
        ("jack", "jack", [0.12, 0.36, 0.16], (1.55, 0.33, 0.45), -20.0, 0.62),
    ] {
        let toy = c.prop(part);
        let toy = c.tinted(toy, color, 0.35);
        c.put(name, toy, at(x, y, z).facing(degrees).turned(DVec3::X, -12.0).sized(size));
    }
    c.point_light("lamp", [-2.7, 4.3, 3.3], [1.0, 0.90, 0.74], 92.0, 18.0);
    c.point_light("window", [3.6, 3.2, 2.4], [0.52, 0.66, 1.0], 46.0, 16.0);
    c.camera("figure", [0.45, 2.35, 4.1], [0.0, 1.35, 0.0], 42.0);
    c.camera("close", [-1.35, 1.9, 1.75], [0.0, 1.6, 0.0], 46.0);
    c.camera("inside", [0.0, 1.62, 0.05], [0.6, 1.5, 1.6], 74.0);
    c.camera("above", [1.2, 4.2, 1.9], [0.0, 1.3, 0.0], 42.0);
    Ok(c.finish())
}
