//! K's figure 17: an object in a magic halo, combined with a stenciled reflection and a shadow. A hooded figure with a
//! power of its own on a polished floor, and a ring that floats: a sphere, which K shows, has no hollows to fill.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3, Vec3};

use super::carpentry::SUNK;
use super::compose::{ARCHITECTURE, Composer, FLOORS, FURNITURE, PILGRIM, SOLIDS, TOYS, at};
use crate::scene::gltf::ImportError;
use crate::scene::{Reflective, Scene};

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("halo", &[SOLIDS, FLOORS, FURNITURE, ARCHITECTURE, TOYS, PILGRIM])?;
    c.environment([0.060, 0.068, 0.110], [0.045, 0.042, 0.052], [0.012, 0.016, 0.045], [0.085, 0.060, 0.095]);
    let marble = c.prop("marble");
    let floor = c.laid(marble, [7.0, 6.0], 1.4);
    let floor = c.reflecting(floor, Reflective { reflectivity: 0.38, tint: Vec3::new(0.92, 0.95, 1.0) });
    c.put("floor", floor, at(0.0, 0.0, 0.0));

    let column = c.prop("column");
    for (number, (x, z)) in [(-3.3, -3.2), (-1.15, -3.9), (1.15, -3.9), (3.3, -3.2), (1.9, 0.55)].into_iter().enumerate() {
        c.put(&format!("column {number}"), column, at(x, -SUNK, z).facing(x * 23.0));
    }
    let plinth = c.prop("plinth");
    c.put("plinth", plinth, at(-1.75, -SUNK, -0.5).sized(0.75));
    let (ball, urn) = (c.prop("ball"), c.prop("urn"));
    c.put("urn", urn, at(2.75, -SUNK, -1.3).facing(40.0));
    for (name, color, (x, z, radius)) in
        [("red ball", [0.50, 0.05, 0.04], (-0.75, 0.95, 0.21)), ("blue ball", [0.05, 0.13, 0.42], (-2.6, 0.55, 0.3))]
    {
        let painted = c.tinted(ball, color, 0.3);
        c.put(name, painted, at(x, radius - SUNK, z).sized(2.0 * radius));
    }

    let pilgrim = c.put_figure(None, PILGRIM, "pilgrim", at(0.35, 0.0, -0.35).facing(-14.0));
    c.dyed(pilgrim, "robe", [0.10, 0.12, 0.30]);
    c.halo(pilgrim);
    // Behind the column as it comes round: what stands before a halo hides it.
    let torus = c.prop("torus");
    let ring = c.tinted(torus, [0.45, 0.30, 0.05], 0.35);
    let ring = c.put("ring", ring, at(1.85, 1.55, -0.55).sized(0.62));
    c.turns(ring, 9.0, 24, |turns| {
        DQuat::from_axis_angle(DVec3::new(0.3, 1.0, 0.1).normalize(), turns * TAU) * DQuat::from_rotation_x(1.25)
    });
    c.moves(ring, 6.0, 24, |turns| DVec3::new(1.85, 1.55 + 0.07 * (turns * TAU).sin(), -0.55));
    c.halo(ring);
    let orb = c.tinted(ball, [0.40, 0.26, 0.05], 0.3);
    let orb = c.put("orb", orb, at(-1.75, 1.12, -0.5).sized(0.5));
    c.moves(orb, 5.0, 24, |turns| DVec3::new(-1.75, 1.17 + 0.05 * (turns * TAU).sin(), -0.5));
    c.halo(orb);

    c.point_light("lamp", [-3.4, 4.4, 3.4], [1.0, 0.86, 0.66], 105.0, 18.0);
    c.point_light("moon", [4.6, 5.0, 1.8], [0.42, 0.56, 1.0], 62.0, 18.0);
    c.camera("figure", [0.15, 1.5, 4.25], [0.15, 0.86, -0.6], 42.0);
    c.camera("low", [-1.9, 0.45, 3.6], [0.3, 0.95, -0.9], 46.0);
    c.camera("above", [3.8, 3.6, 3.6], [0.1, 0.6, -0.6], 42.0);
    Ok(c.finish())
}
