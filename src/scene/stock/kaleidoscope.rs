//! A kaleidoscope: three mirrors in a triangle, bright toys at its end, and the eye inside. Every mirror shows
//! the two others, which is K's worst case (section 3); but the images tile the plane about the eye, and only
//! those that lie in the picture are views: close to the toys few, down the length of the tube many.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3, Vec3};

use super::carpentry::{boxes, disc, pane, rectangle};
use super::compose::{Composer, SOLIDS, TOYS, at};
use crate::scene::gltf::ImportError;
use crate::scene::{LightKind, Reflective, Scene};

/// A mirror's width, and how far its middle is from the axis: a little more than where the three would meet.
const WIDTH: f32 = 1.4;
const AXIS: f64 = 0.408;
/// The tube goes from here towards -z, as far as it is long.
const NEAR: f64 = 0.9;
const LENGTH: f64 = 2.5;

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("kaleidoscope", &[SOLIDS, TOYS])?;
    c.environment([0.16, 0.16, 0.18], [0.14, 0.13, 0.13], [0.006, 0.006, 0.010], [0.010, 0.008, 0.010]);
    let look = Reflective { reflectivity: 1.0, tint: Vec3::new(0.96, 0.97, 0.98) };
    let glass = pane(&mut c, "mirror", &rectangle(WIDTH, LENGTH as f32), look);
    let board = boxes(&mut c, "board", &[([0.0, 0.0, -0.03], [WIDTH + 0.06, LENGTH as f32, 0.05])], [0.03, 0.03, 0.035], 0.9);
    let board = Composer::shadeless(board);
    let middle = NEAR - LENGTH / 2.0;
    for (number, name) in ["floor mirror", "right mirror", "left mirror"].into_iter().enumerate() {
        // Each about the axis; its glass looks inwards and its length lies along z.
        let side = c.group(name, None, at(0.0, 0.0, middle).turned(DVec3::Z, 120.0 * number as f64));
        let place = at(0.0, -AXIS, 0.0).turned(DVec3::X, -90.0);
        c.put_on(Some(side), name, glass, place);
        c.put_on(Some(side), &format!("{name}'s board"), board, place);
    }
    // The far end: a pale plate, beyond the mirrors' edges.
    let end = NEAR - LENGTH;
    let plate = boxes(&mut c, "plate", &[([0.0, 0.0, -0.05], [2.6, 2.6, 0.08])], [0.60, 0.58, 0.66], 0.9);
    c.put("plate", Composer::shadeless(plate), at(0.0, 0.1, end - 0.004));
    let hub = c.group("hub", None, at(0.0, 0.0, end));
    c.turns(hub, 40.0, 48, |turns| DQuat::from_rotation_z(turns * TAU));
    toys(&mut c, hub);
    let lamp = c.point_light("lamp", [0.03, 0.06, -0.35], [1.0, 0.95, 0.88], 3.0, 5.0);
    c.moves(lamp, 12.0, 24, |turns| {
        let (sin, cos) = (turns * TAU).sin_cos();
        DVec3::new(0.08 * cos, 0.06 + 0.06 * sin, -0.35)
    });
    let glint = c.group("glint", Some(hub), at(0.17, 0.12, 0.62));
    c.light(glint, LightKind::Point, [0.35, 0.55, 1.0], 0.8, 3.0);
    c.camera("close", [-0.05, 0.06, -0.7], [0.02, 0.02, end], 50.0);
    c.camera("down the tube", [0.03, 0.05, 0.2], [0.0, 0.02, end], 64.0);
    Ok(c.finish())
}

/// Small, bright, turning, and all within the triangle wherever the hub turns.
fn toys(c: &mut Composer, hub: usize) {
    for (name, part, color, (x, y, z), size, seconds) in [
        ("ring", "torus", [0.80, 0.10, 0.06], (0.13, 0.16, 0.17), 0.20, 7.0),
        ("star", "star", [0.85, 0.60, 0.05], (-0.18, 0.09, 0.15), 0.17, 9.0),
        ("jack", "jack", [0.08, 0.30, 0.80], (0.02, -0.20, 0.20), 0.18, 8.0),
        ("wheel", "gear", [0.08, 0.58, 0.22], (-0.11, -0.10, 0.38), 0.13, 6.0),
        ("pearl", "ball", [0.85, 0.82, 0.75], (0.19, -0.07, 0.13), 0.16, 10.0),
        ("cherry", "small ball", [0.75, 0.05, 0.25], (-0.02, 0.03, 0.10), 0.13, 10.0),
    ] {
        let toy = c.prop(part);
        let painted = c.tinted(toy, color, 0.35);
        let node = c.put_on(Some(hub), name, painted, at(x, y, z).sized(size));
        c.turns(node, seconds, 24, |turns| DQuat::from_axis_angle(DVec3::new(0.36, 0.48, 0.8), turns * TAU));
    }
    let coins = disc(0.05, 6);
    let gem = super::carpentry::frame(c, &disc(0.02, 6), &coins, 0.03, [0.65, 0.10, 0.75]);
    for (number, (x, y)) in [(0.26, 0.05), (-0.20, -0.14), (-0.06, 0.25)].into_iter().enumerate() {
        c.put_on(Some(hub), &format!("gem {number}"), gem, at(x, y, 0.05).turned(DVec3::X, 20.0));
    }
}
