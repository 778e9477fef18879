//! Doorways that lead elsewhere. A study by lamplight: through one doorway of it one looks out on a terrace by night,
//! which lies forty metres off; two more face each other across it, and each leads to the other, so that the study
//! repeats itself for ever. On the terrace the way back stands free, a doorway with nothing behind it.
//!
//! ```text
//!      .--- a ---.                        a leads to A and back
//!      |         |             A          b leads to c: who looks in at the one sees out of the other
//!      b         c           terrace
//!      |  study  |
//!      '---------'
//! ```

use std::f64::consts::TAU;

use glam::{DQuat, DVec3, Vec3};

use super::carpentry::{ceiling, frame, painting, pendant, rectangle, walls};
use super::compose::{ARCHITECTURE, Composer, FLOORS, FURNITURE, Place, SOLIDS, STRIDE, WALKER, at, there_and_back};
use crate::scene::Scene;
use crate::scene::gltf::ImportError;

/// Half the study: across, and along; and its height.
const STUDY: [f32; 2] = [3.4, 3.4];
const HEIGHT: f32 = 3.2;

/// Where the terrace is.
const TERRACE: f64 = 40.0;

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("portals", &[SOLIDS, FLOORS, FURNITURE, ARCHITECTURE, WALKER])?;
    c.environment([0.060, 0.062, 0.085], [0.045, 0.040, 0.040], [0.012, 0.018, 0.050], [0.050, 0.045, 0.085]);
    study(&mut c);
    terrace(&mut c);
    let (oak, stone) = ([0.20, 0.10, 0.045], [0.40, 0.38, 0.36]);
    let out = doorway(&mut c, "door to the terrace", at(0.0, 1.16, -3.4), oak);
    let back = doorway(&mut c, "door to the study", at(TERRACE, 1.16, -2.0), stone);
    c.joins([out, back]);
    let left = doorway(&mut c, "left door", at(-3.4, 1.16, -0.5).facing(90.0), oak);
    let right = doorway(&mut c, "right door", at(3.4, 1.16, -0.5).facing(-90.0), oak);
    c.joins([left, right]);
    c.camera("study", [1.75, 1.6, 2.9], [-1.15, 1.15, -2.2], 58.0);
    c.camera("without end", [2.6, 1.5, -0.25], [-3.4, 1.3, -0.55], 50.0);
    c.camera("terrace", [TERRACE + 2.6, 1.7, 3.9], [TERRACE - 0.2, 1.0, -1.6], 54.0);
    Ok(c.finish())
}

/// A frame, and in it what leads on. `place` is its middle, facing into the room. Gives the node of what leads on.
fn doorway(c: &mut Composer, name: &str, place: Place, color: [f32; 3]) -> usize {
    let group = c.group(name, None, place);
    let (inner, outer) = (rectangle(1.5, 2.2), rectangle(1.74, 2.44));
    let ring = frame(c, &inner, &outer, 0.1, color);
    c.put_on(Some(group), "frame", ring, at(0.0, 0.0, -0.02));
    let corners = rectangle(1.6, 2.3).map(|[x, y]| Vec3::new(x, y, 0.0));
    let way = c.made("way", &corners, &[[0, 1, 2], [0, 2, 3]], [0.20, 0.23, 0.25], 0.3);
    c.put_on(Some(group), name, Composer::shadeless(way), at(0.0, 0.0, 0.03))
}

fn study(c: &mut Composer) {
    let planks = c.prop("planks");
    let floor = c.laid(planks, STUDY, 1.5);
    c.put("floor", floor, at(0.0, 0.0, 0.0));
    for (name, heights, color) in [("panels", [0.0, 0.9], [0.13, 0.065, 0.03]), ("wall", [0.9, HEIGHT], [0.36, 0.25, 0.16])] {
        let band = walls(c, name, STUDY, heights, color);
        c.put(name, band, at(0.0, 0.0, 0.0));
    }
    let above = ceiling(c, STUDY, HEIGHT, [0.42, 0.38, 0.32]);
    c.put("ceiling", above, at(0.0, 0.0, 0.0));
    let (plinth, knot, bench) = (c.prop("plinth"), c.prop("knot"), c.prop("bench"));
    c.put("plinth", plinth, at(-2.2, -0.01, -2.35).facing(20.0).sized(0.8));
    let brass = c.tinted(knot, [0.60, 0.38, 0.12], 0.35);
    let statue = c.put("knot", brass, at(-2.2, 0.87 + 0.44, -2.35).sized(0.75));
    c.turns(statue, 18.0, 24, |turns| DQuat::from_rotation_y(turns * TAU));
    c.put("bench", bench, at(1.9, -0.01, -2.7).sized(0.85));
    let strokes = [
        ([-0.14, 0.08], [0.34, 0.40], [0.50, 0.10, 0.06]),
        ([0.18, -0.10], [0.30, 0.34], [0.08, 0.18, 0.42]),
        ([0.05, 0.22], [0.6, 0.05], [0.66, 0.48, 0.12]),
    ];
    painting(c, "picture", at(-2.2, 1.95, -3.4), [0.9, 0.8], [0.62, 0.58, 0.50], &strokes);
    let reader = c.put_figure(None, WALKER, "reader", at(0.0, 0.0, 0.0));
    c.walks(reader, 9, |turns| there_and_back(DVec3::new(-0.9, 0.0, -0.5), 0.6, 9.0 * STRIDE, turns + 0.55));
    pendant(c, "study lamp", [0.2, 2.4, -0.4], 0.75, [1.0, 0.70, 0.40], (17.0, 8.0));
    pendant(c, "reading lamp", [-2.1, 2.3, 1.9], 0.85, [1.0, 0.58, 0.34], (9.0, 7.0));
}

fn terrace(c: &mut Composer) {
    let marble = c.prop("marble");
    let floor = c.laid(marble, [6.0, 6.0], 1.4);
    c.put("terrace", floor, at(TERRACE, 0.0, 0.0));
    let (column, cypress, pot, urn, ball) = (c.prop("column"), c.prop("cypress"), c.prop("pot"), c.prop("urn"), c.prop("ball"));
    for (number, (x, z)) in [(-2.6, 2.6), (-0.9, 3.6), (0.9, 3.6), (2.6, 2.6)].into_iter().enumerate() {
        c.put(&format!("column {number}"), column, at(TERRACE + x, -0.01, z));
    }
    for (name, x, z) in [("left", -2.4, -1.2), ("right", 2.5, -0.9)] {
        c.put(&format!("{name} pot"), pot, at(TERRACE + x, -0.01, z));
        c.put(&format!("{name} cypress"), cypress, at(TERRACE + x, 0.0, z).sized(0.8));
    }
    c.put("urn", urn, at(TERRACE - 1.5, -0.01, 1.0));
    let pearl = c.tinted(ball, [0.62, 0.62, 0.66], 0.3);
    c.put("pearl", pearl, at(TERRACE + 0.9, 0.34, 0.9).sized(0.7));
    c.point_light("moon", [TERRACE - 5.5, 7.5, 4.5], [0.52, 0.66, 1.0], 170.0, 20.0);
    c.point_light("lantern", [TERRACE + 1.9, 1.9, 1.9], [1.0, 0.62, 0.30], 7.0, 8.0);
    let spark = c.prop("small ball");
    let globe = c.glowing(spark, [2.4, 1.5, 0.7]);
    c.put("lantern's globe", globe, at(TERRACE + 1.9, 1.9, 1.9).sized(0.12));
}
