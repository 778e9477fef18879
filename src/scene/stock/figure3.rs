//! K's figure 3: a figure on a small reflective surface with nothing around it, so that a reflection that no stencil
//! bounds sticks out beyond the edge, and from below "really is just the object flipped through the mirror plane".

use std::f64::consts::TAU;

use glam::{DQuat, Vec3};

use super::carpentry::{boxes, turned};
use super::compose::{Composer, FLOORS, SOLIDS, TOYS, at};
use crate::scene::gltf::ImportError;
use crate::scene::{Reflective, Scene};

/// Height of the table over the studio's floor: its reflections end well above that.
const TABLE: f64 = 2.3;

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("figure3", &[SOLIDS, FLOORS, TOYS])?;
    c.environment([0.100, 0.105, 0.120], [0.070, 0.065, 0.062], [0.030, 0.034, 0.045], [0.060, 0.056, 0.056]);
    let backdrop = c.prop("backdrop");
    let backdrop = c.tinted(backdrop, [0.20, 0.23, 0.29], 1.0);
    c.put("backdrop", backdrop, at(0.0, -TABLE, -6.0).stretched(1.0, 1.0, 1.2));

    let chequers = c.prop("chequers");
    let glossy = c.reflecting(chequers, Reflective { reflectivity: 0.55, tint: Vec3::ONE });
    c.put("mirror", glossy, at(0.0, 0.0, 0.0).sized(0.15));
    let wood = [0.20, 0.085, 0.035];
    let top = boxes(
        &mut c,
        "table top",
        &[
            ([0.0, -0.065, 0.0], [2.4, 0.11, 2.4]),
            ([-1.235, -0.05, 0.0], [0.09, 0.12, 2.56]),
            ([1.235, -0.05, 0.0], [0.09, 0.12, 2.56]),
            ([0.0, -0.052, -1.235], [2.50, 0.124, 0.088]),
            ([0.0, -0.052, 1.235], [2.50, 0.124, 0.088]),
        ],
        wood,
        0.45,
    );
    c.put("table top", top, at(0.0, 0.0, 0.0));
    let leg =
        [[0.0, -2.31], [0.55, -2.31], [0.52, -2.22], [0.16, -2.05], [0.11, -1.2], [0.17, -0.3], [0.40, -0.10], [0.0, -0.09]];
    let leg = turned(&mut c, "leg", &leg, 20, wood, 0.45);
    c.put("leg", leg, at(0.0, 0.0, 0.0));

    // The dinosaur stands on the glass, and turns on its heels.
    let turntable = c.group("dinosaur", None, at(0.0, 0.0, 0.0));
    c.turns(turntable, 16.0, 32, |turns| DQuat::from_rotation_y(turns * TAU));
    let dinosaur = c.prop("dinosaur");
    let dinosaur = c.painted(dinosaur, 0, [0.14, 0.42, 0.13], 0.5);
    c.put_on(Some(turntable), "dinosaur", dinosaur, at(0.06, 0.685, 0.0));
    let ball = c.prop("ball");
    for (name, color, (x, z, radius)) in
        [("red ball", [0.62, 0.06, 0.04], (0.85, 0.80, 0.17)), ("yellow ball", [0.72, 0.48, 0.05], (-0.92, 0.72, 0.12))]
    {
        let painted = c.tinted(ball, color, 0.3);
        c.put(name, painted, at(x, radius - 0.003, z).sized(2.0 * radius));
    }
    c.point_light("key", [2.6, 3.6, 2.8], [1.0, 0.93, 0.82], 78.0, 16.0);
    c.point_light("fill", [-3.6, 2.4, 1.4], [0.46, 0.60, 1.0], 24.0, 14.0);
    c.camera("figure", [1.1, 1.15, 3.9], [0.0, 0.12, 0.0], 44.0);
    c.camera("low", [-0.6, 0.42, 3.6], [0.0, 0.15, 0.0], 44.0);
    c.camera("above", [2.6, 3.0, 2.9], [0.0, 0.1, 0.0], 44.0);
    Ok(c.finish())
}
