//! The scene that greets: a court at dusk. A fountain between two arcades, a statue on a terrace;
//! a warm sun low on the right, a blue sky, a lantern that swings in the gallery and throws the
//! shadows of its cage and of the columns about.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::compose::{ARCHITECTURE, Composer, FLOORS, FURNITURE, STRIDE, WALKER, at, circle};
use crate::scene::gltf::ImportError;
use crate::scene::{LightKind, Scene};

/// Height of the galleries' floor.
const GALLERY: f64 = 0.3;
/// Where the back arcade's columns stand.
const BACK: f64 = -4.95;
/// Where the left arcade's columns stand.
const LEFT: f64 = -7.2;
/// Floors and walls that would meet in one plane are kept this far apart.
const SHADE: f64 = 0.004;

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("courtyard", &[FLOORS, ARCHITECTURE, FURNITURE, WALKER])?;
    c.environment([0.075, 0.085, 0.125], [0.055, 0.045, 0.042], [0.030, 0.050, 0.125], [0.26, 0.17, 0.15]);
    let floor = c.prop("cobbles");
    c.put("court", floor, at(0.0, 0.0, 0.0));
    galleries(&mut c);
    terrace(&mut c);
    furniture(&mut c);
    walkers(&mut c);
    lights(&mut c);
    c.camera("court", [3.9, 1.9, 7.7], [0.6, 1.6, -1.5], 50.0);
    c.camera("gallery", [-5.6, 1.75, -7.2], [1.6, 1.15, 0.4], 58.0);
    c.camera("fountain", [-3.4, 1.35, 3.6], [0.9, 1.15, -0.9], 50.0);
    Ok(c.finish())
}

fn galleries(c: &mut Composer) {
    let (column, step) = (c.prop("column"), c.prop("step"));
    let [arcade6, roof6, wall6, floor6] = ["arcade 6", "roof 6", "wall 6", "gallery floor 6"].map(|name| c.prop(name));
    let [arcade4, roof4, wall4, floor4] = ["arcade 4", "roof 4", "wall 4", "gallery floor 4"].map(|name| c.prop(name));

    c.put("back floor", floor6, at(0.0, 0.0, BACK - 1.35));
    c.put("back arcade", arcade6, at(0.0, GALLERY, BACK));
    c.put("back roof", roof6, at(0.0, GALLERY + 4.34, BACK + 0.5));
    c.put("back wall", wall6, at(0.0, 0.0, BACK - 3.2));
    for k in 0..7 {
        c.put(&format!("back column {k}"), column, at(LEFT + 2.4 * f64::from(k), GALLERY, BACK));
    }
    for k in -1..=1 {
        c.put(&format!("back step {k}"), step, at(4.8 * f64::from(k), 0.0, BACK + 0.52));
    }
    let middle = BACK + 4.8;
    c.put("left floor", floor4, at(LEFT - 1.35, -SHADE, middle).facing(90.0));
    c.put("left arcade", arcade4, at(LEFT, GALLERY - SHADE, middle).facing(90.0));
    c.put("left roof", roof4, at(LEFT + 0.5, GALLERY + 4.34, middle).facing(90.0));
    c.put("left wall", wall4, at(LEFT - 3.2, -SHADE, middle).facing(90.0));
    for k in 1..5 {
        c.put(&format!("left column {k}"), column, at(LEFT, GALLERY, BACK + 2.4 * f64::from(k)));
    }
    for k in 0..2 {
        let z = BACK + 0.72 + 2.4 + 4.8 * f64::from(k);
        c.put(&format!("left step {k}"), step, at(LEFT + 0.52, -SHADE, z).facing(90.0));
    }
    // The wall that closes the court on the right, behind the terrace.
    c.put("right wall", wall4, at(8.65, -1.0, 0.0).facing(-90.0));
}

fn terrace(c: &mut Composer) {
    let (terrace, stairs, plinth, knot) = (c.prop("terrace"), c.prop("stairs"), c.prop("plinth"), c.prop("knot"));
    c.put("terrace", terrace, at(6.1, 0.0, -2.3));
    c.put("stairs", stairs, at(6.1, 0.0, -0.31));
    c.put("plinth", plinth, at(6.1, 0.8, -2.4));
    let statue = c.put("statue", knot, at(6.1, 0.8 + 1.09 + 0.56, -2.4));
    c.turns(statue, 30.0, 36, |turns| glam::DQuat::from_rotation_y(turns * TAU));
}

fn furniture(c: &mut Composer) {
    let (fountain, water) = (c.prop("fountain"), c.prop("water"));
    c.put("fountain", fountain, at(0.0, 0.0, 0.0));
    c.put("water", water, at(0.0, 0.0, 0.0));
    let (pot, cypress, urn, bench) = (c.prop("pot"), c.prop("cypress"), c.prop("urn"), c.prop("bench"));
    for (i, (x, y, z)) in [(-5.2, 0.0, -3.2), (-5.3, 0.0, 4.4), (4.35, 0.8, -3.75), (7.85, 0.8, -3.75)].into_iter().enumerate() {
        let turned = 70.0 * i as f64;
        c.put(&format!("pot {i}"), pot, at(x, y, z));
        c.put(&format!("cypress {i}"), cypress, at(x, y, z).facing(turned));
    }
    c.put("urn", urn, at(4.15, 0.0, 0.6).facing(20.0));
    c.put("small urn", urn, at(8.0, 0.0, 1.1).facing(75.0).sized(0.62));
    c.put("bench", bench, at(-4.9, 0.0, 0.8).facing(90.0));
}

fn walkers(c: &mut Composer) {
    // Round the fountain.
    let radius = 20.0 * STRIDE / TAU;
    let first = c.put_figure(None, WALKER, "walker", at(0.0, 0.0, 0.0));
    c.walks(first, 20, move |turns| circle(DVec3::ZERO, radius, turns + 0.72));

    // Up and down the back gallery: two straights and two half circles.
    let (turn_radius, length) = (0.55, 22.0 * STRIDE);
    let straight = (length - TAU * turn_radius) / 2.0;
    let second = c.put_figure(None, WALKER, "watchman", at(0.0, 0.0, 0.0));
    c.walks(second, 22, move |turns| {
        let s = (turns + 0.12).rem_euclid(1.0) * length;
        let centre = DVec3::new(-1.0, GALLERY, BACK - 1.5);
        let (half, arc) = (straight / 2.0, PI * turn_radius);
        centre
            + if s < straight {
                DVec3::new(s - half, 0.0, turn_radius)
            } else if s < straight + arc {
                DVec3::new(half, 0.0, 0.0) + circle(DVec3::ZERO, turn_radius, (s - straight) / arc * 0.5 - 0.25)
            } else if s < 2.0 * straight + arc {
                DVec3::new(half - (s - straight - arc), 0.0, -turn_radius)
            } else {
                DVec3::new(-half, 0.0, 0.0) + circle(DVec3::ZERO, turn_radius, (s - 2.0 * straight - arc) / arc * 0.5 + 0.25)
            }
    });
}

fn lights(c: &mut Composer) {
    c.point_light("evening sun", [8.0, 5.5, 2.2], [1.0, 0.66, 0.36], 300.0, 24.0);
    c.point_light("sky", [-5.2, 8.6, -3.2], [0.36, 0.52, 1.0], 150.0, 22.0);
    // The lantern hangs from the gallery's ceiling and swings about its hook.
    let hook = c.group("lantern", None, at(-3.6, GALLERY + 3.9, BACK - 1.45));
    c.swings(hook, 3.4, DVec3::new(0.8, 0.0, 0.6), 9.0);
    let flame_node = c.group("lantern light", Some(hook), at(0.0, -1.35, 0.0));
    c.light(flame_node, LightKind::Point, [1.0, 0.46, 0.16], 17.0, 9.5);
    let (cage, flame, post) = (c.prop("cage"), c.prop("flame"), c.prop("post"));
    c.put_on(Some(flame_node), "cage", cage, at(0.0, 0.0, 0.0));
    c.put_on(Some(flame_node), "flame", flame, at(0.0, 0.0, 0.0));
    // A post, drawn thin, is its rod.
    c.put_on(Some(hook), "rod", post, at(0.0, -1.06, 0.0).stretched(0.12, 0.478, 0.12));
}
