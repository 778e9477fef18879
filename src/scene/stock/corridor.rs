//! K's hallway (section 3): "two mirrors at each end at 45 degree angles so you can peer down the hallway", round
//! two corners: a periscope lying on its side. No mirror shows itself, however often it is asked.
//!
//! ```text
//!            B                       seen from above; the eye at o looks up the first leg, by the
//!      / ---------- \               first mirror along B and by the second one up the last leg,
//!     |  ---------.  |  C           where no straight line leads
//!   A |  |        |  |
//!     |o |        `--'
//! ```
//!
//! (The drawing is turned: -z is up.)

use glam::{DVec3, Vec3};

use super::carpentry::{boxes, cuboid, hung_mirror, painting, pendant, rectangle};
use super::compose::{ARCHITECTURE, Composer, FLOORS, FURNITURE, SOLIDS, STRIDE, WALKER, at, there_and_back};
use crate::scene::gltf::ImportError;
use crate::scene::{Reflective, Scene};

const HEIGHT: f32 = 2.6;

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("corridor", &[SOLIDS, FLOORS, FURNITURE, ARCHITECTURE, WALKER])?;
    c.environment([0.070, 0.072, 0.085], [0.060, 0.052, 0.046], [0.010, 0.011, 0.015], [0.014, 0.013, 0.013]);
    hallway(&mut c);
    let silver = Reflective { reflectivity: 1.0, tint: Vec3::new(0.97, 0.98, 0.97) };
    let frame = [0.20, 0.12, 0.05];
    let outline = rectangle(2.2, 2.1);
    hung_mirror(&mut c, "first mirror", at(0.0, 1.26, -4.0).facing(45.0), &outline, silver, 0.08, frame);
    hung_mirror(&mut c, "second mirror", at(6.0, 1.26, -4.0).facing(-135.0), &outline, silver, 0.08, frame);
    furniture(&mut c);
    let watchman = c.put_figure(None, WALKER, "watchman", at(0.0, 0.0, 0.0));
    c.walks(watchman, 9, |turns| there_and_back(DVec3::new(6.0, 0.0, -7.6), 0.5, 9.0 * STRIDE, turns + 0.93));
    pendant(&mut c, "first lamp", [0.0, 2.2, -1.0], 0.4, [1.0, 0.74, 0.46], (7.0, 9.0));
    pendant(&mut c, "second lamp", [3.0, 2.2, -4.0], 0.4, [0.62, 1.0, 0.72], (7.0, 9.0));
    pendant(&mut c, "third lamp", [6.0, 2.2, -8.3], 0.4, [0.52, 0.70, 1.0], (10.0, 10.0));
    c.camera("periscope", [-0.1, 1.55, 0.9], [0.0, 1.3, -4.0], 38.0);
    c.camera("second leg", [1.2, 1.6, -4.2], [6.0, 1.25, -4.0], 48.0);
    c.camera("from the end", [5.7, 1.5, -10.3], [6.05, 1.3, -4.0], 44.0);
    Ok(c.finish())
}

/// Walls that reach into each other, with a hand's breadth of step where they meet in a visible corner: no two
/// faces in one plane, and no joint for the light.
fn hallway(c: &mut Composer) {
    let floor = c.prop("paving");
    let floor = c.receiving(floor);
    c.put("floor", floor, at(3.0, 0.0, -4.0));
    let boxes: [([f32; 3], [f32; 3]); 9] = [
        ([-1.2, -0.10, -5.15], [-1.0, 2.80, 3.15]),  // A, left
        ([1.02, -0.11, -2.9], [1.22, 2.81, 3.12]),   // A, right
        ([-1.15, -0.12, 3.0], [1.17, 2.82, 3.2]),    // A, behind the eye
        ([1.0, -0.13, -3.0], [7.15, 2.83, -2.8]),    // B, right of who goes along it, and on behind the mirror
        ([-1.16, -0.14, -5.2], [5.0, 2.84, -5.0]),   // B, left
        ([4.78, -0.15, -11.15], [4.98, 2.85, -5.1]), // C, left
        ([7.0, -0.16, -11.16], [7.2, 2.86, -2.85]),  // C, right
        ([4.82, -0.17, -11.2], [7.12, 2.87, -11.0]), // C, its end
        ([-1.3, HEIGHT, -11.3], [7.3, 2.95, 3.3]),   // the ceiling
    ];
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for (least, most) in boxes {
        cuboid(least.into(), most.into(), &mut positions, &mut triangles);
    }
    let walls = c.made("walls", &positions, &triangles, [0.46, 0.41, 0.35], 0.95);
    c.put("walls", walls, at(0.0, 0.0, 0.0));
    // The boards across the outer corners, which the mirrors hang on.
    let cube = c.prop("cube");
    let board = c.tinted(cube, [0.24, 0.20, 0.17], 0.9);
    for (name, x, facing) in [("first board", 0.0, 45.0), ("second board", 6.0, -135.0)] {
        let corner = c.group(name, None, at(x, 0.0, -4.0).facing(facing));
        c.put_on(Some(corner), name, board, at(0.0, 1.32, -0.05).stretched(3.0, 2.9, 0.1));
    }
}

fn furniture(c: &mut Composer) {
    let (plinth, knot, bench) = (c.prop("plinth"), c.prop("knot"), c.prop("bench"));
    c.put("plinth", plinth, at(6.0, -0.01, -10.35).sized(0.85));
    let bronze = c.tinted(knot, [0.55, 0.36, 0.16], 0.4);
    let statue = c.put("knot", bronze, at(6.0, 1.36, -10.35).sized(0.8));
    c.turns(statue, 20.0, 24, |turns| glam::DQuat::from_rotation_y(turns * std::f64::consts::TAU));
    c.put("bench", bench, at(3.0, -0.01, -4.72).sized(0.8));
    let (pot, cypress, urn) = (c.prop("pot"), c.prop("cypress"), c.prop("urn"));
    for (name, x, z) in [("near", 0.70, -2.3), ("far", 5.42, -6.0)] {
        c.put(&format!("{name} pot"), pot, at(x, -0.01, z).sized(0.6));
        c.put(&format!("{name} cypress"), cypress, at(x, 0.0, z).stretched(0.6, 0.5, 0.6));
    }
    c.put("urn", urn, at(-0.66, -0.01, -1.9).sized(0.75));
    let red = boxes(
        c,
        "door",
        &[([0.0, 1.02, 0.0], [0.06, 2.1, 0.95]), ([0.03, 1.0, 0.36], [0.07, 0.05, 0.05])],
        [0.36, 0.05, 0.035],
        0.5,
    );
    c.put("door", red, at(-1.0, 0.0, 0.4));
    let strokes = [
        ([-0.16, 0.1], [0.3, 0.42], [0.55, 0.10, 0.06]),
        ([0.2, -0.14], [0.26, 0.3], [0.07, 0.16, 0.46]),
        ([0.1, 0.25], [0.5, 0.05], [0.70, 0.52, 0.10]),
    ];
    painting(c, "picture", at(2.2, 1.55, -5.0), [0.8, 0.8], [0.66, 0.62, 0.54], &strokes);
    painting(c, "second picture", at(3.8, 1.55, -5.0), [0.8, 0.8], [0.10, 0.16, 0.20], &strokes[..2]);
}
