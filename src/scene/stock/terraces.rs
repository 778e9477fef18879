//! K's "two-tiered reflective marble floor" (section 3): the two tiers can show nothing of each other, but "each tier
//! has its own noticeably distinct reflection", at its own height.

use glam::{DVec3, Vec3};

use super::carpentry::{SUNK, boxes};
use super::compose::{ARCHITECTURE, Composer, FLOORS, FURNITURE, SOLIDS, STRIDE, TOYS, WALKER, at, there_and_back};
use crate::scene::gltf::ImportError;
use crate::scene::{Reflective, Scene};

/// The upper tier's height, and its half sides.
const TIER: f64 = 0.45;
const HALF: [f32; 2] = [3.6, 2.4];
/// Where the middle of the upper tier is along z.
const BACK: f64 = -3.4;

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("terraces", &[SOLIDS, FLOORS, FURNITURE, ARCHITECTURE, TOYS, WALKER])?;
    c.environment([0.075, 0.085, 0.125], [0.055, 0.050, 0.055], [0.020, 0.034, 0.095], [0.22, 0.14, 0.13]);
    let marble = c.prop("marble");
    let polish = Reflective { reflectivity: 0.3, tint: Vec3::ONE };
    let lower = c.laid(marble, [6.5, 6.0], 1.6);
    let lower = c.reflecting(lower, polish);
    c.put("lower tier", lower, at(0.0, 0.0, 0.0));
    let upper = c.laid(marble, HALF, 1.2);
    let upper = c.reflecting(upper, polish);
    c.put("upper tier", upper, at(0.0, TIER, BACK));
    // The block under it, a hair lower, and a rim's breadth larger.
    let [x, z] = HALF;
    let height = TIER as f32;
    let block = boxes(
        &mut c,
        "block",
        &[([0.0, height / 2.0 - 0.02, 0.0], [2.0 * x + 0.08, height + 0.03, 2.0 * z + 0.08])],
        [0.42, 0.38, 0.34],
        0.7,
    );
    c.put("block", block, at(0.0, 0.0, BACK));
    let stairs = c.prop("stairs");
    c.put("stairs", stairs, at(-1.4, -0.02, BACK + 2.43).stretched(0.8, TIER / 0.8, 0.62));

    let (column, cypress, pot, urn) = (c.prop("column"), c.prop("cypress"), c.prop("pot"), c.prop("urn"));
    for (number, x) in [-3.0, -1.0, 1.0, 3.0].into_iter().enumerate() {
        c.put(&format!("column {number}"), column, at(x, TIER - SUNK, BACK - 1.7));
    }
    let beam = boxes(&mut c, "beam", &[([0.0, 0.16, 0.0], [7.0, 0.34, 0.62])], [0.55, 0.50, 0.44], 0.8);
    c.put("beam", beam, at(0.0, TIER + 2.58, BACK - 1.7));
    for (side, x) in [("left", -3.0), ("right", 3.0)] {
        c.put(&format!("{side} pot"), pot, at(x, TIER - SUNK, BACK + 1.7));
        c.put(&format!("{side} cypress"), cypress, at(x, TIER, BACK + 1.7).facing(x * 30.0).sized(0.8));
        c.put(&format!("{side} urn"), urn, at(x * 1.42, -SUNK, 1.4).facing(x * 20.0));
    }
    let (plinth, knot) = (c.prop("plinth"), c.prop("knot"));
    c.put("plinth", plinth, at(1.1, TIER - SUNK, BACK + 0.5).sized(0.8));
    let bronze = c.tinted(knot, [0.50, 0.30, 0.12], 0.4);
    let statue = c.put("knot", bronze, at(1.1, TIER + 0.87 + 0.46, BACK + 0.5).sized(0.8));
    c.turns(statue, 24.0, 24, |turns| glam::DQuat::from_rotation_y(turns * std::f64::consts::TAU));
    let ball = c.prop("ball");
    for (name, color, (x, z, radius)) in [
        ("red ball", [0.55, 0.06, 0.04], (0.5, 0.9, 0.30)),
        ("blue ball", [0.06, 0.14, 0.46], (1.5, 0.35, 0.22)),
        ("ivory ball", [0.70, 0.66, 0.57], (2.4, 1.2, 0.38)),
    ] {
        let painted = c.tinted(ball, color, 0.3);
        c.put(name, painted, at(x, radius - SUNK, z).sized(2.0 * radius));
    }
    let walker = c.put_figure(None, WALKER, "walker", at(0.0, 0.0, 0.0));
    c.walks(walker, 10, |turns| there_and_back(DVec3::new(-2.6, 0.0, 1.6), 0.9, 10.0 * STRIDE, turns + 0.08));

    c.point_light("evening sun", [6.2, 4.6, 3.4], [1.0, 0.70, 0.42], 210.0, 22.0);
    c.point_light("sky", [-5.4, 7.0, 0.6], [0.40, 0.54, 1.0], 120.0, 20.0);
    c.camera("two tiers", [1.5, 1.75, 5.4], [-0.2, 0.75, -1.6], 46.0);
    c.camera("edge", [-0.7, 0.7, 2.7], [0.9, 0.8, -2.6], 50.0);
    c.camera("above", [-5.2, 4.2, 4.6], [0.2, 0.3, -1.6], 46.0);
    Ok(c.finish())
}
