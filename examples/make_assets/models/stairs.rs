//! A flight of steps so long that 256 shadow volumes lie one in another at its foot (McGuire et
//! al. 2003, image 3): a light stands on the platform at its top, a little *below* the line of the
//! steps' noses continued upwards, so that every ray that comes down along the flight goes through
//! all of it.
//!
//! ```text
//!        light
//!   ------*------__  platform                    what lies between a point of the court below the
//!                  |__ step 1                    terrace and the light: the platform, 254 steps,
//!                     |__ ...                    the terrace, each once: 256
//!                        |________ landing
//!                                 |__ ...
//!                                    |__ step 254
//!                                       |______ terrace
//!                                              |
//!                                              |_______________ court ___
//!                                                                        |__ ten more steps
//! ```
//!
//! The file holds the whole building, one node a step, so that its measures live here alone.

use glam::{DVec2, DVec3};
use serde_json::json;

use super::glb::{Glb, Look};
use super::math::hash;
use super::polygon::{arc, extruded, pulled};
use super::soup::{Soup, cuboid};
use super::texture;

/// Height and depth of a step.
const RISE: f64 = 0.10;
const RUN: f64 = 0.22;
/// Depth of a landing, which is a step too.
const LANDING: f64 = 6.0 * RUN;
/// Steps between landings, from the top.
const FLIGHTS: [usize; 6] = [41, 42, 41, 42, 41, 42];
/// How wide the flight is, how far down its blocks reach.
const WIDTH: f64 = 7.0;
const BODY: f64 = 5.6;
/// The walls on both sides: how thick, how high over the noses.
const FLANK: f64 = 0.8;
const PARAPET: f64 = 0.5;
/// The terrace between flight and court.
const TERRACE: f64 = 6.0;
const TERRACE_DEPTH: f64 = 2.4;
/// Where the terrace ends and the court begins.
const COURT: f64 = 20.0;
/// Where the court ends, and the steps that lead down from it.
const COURT_END: f64 = 44.0;
const COURT_WIDTH: f64 = 120.0;
const LOW_STEPS: usize = 10;
const LOW_RUN: f64 = 0.42;

/// A block whose top is at y = 0 and whose front is at z = 0.
fn block(width: f64, height: f64, depth: f64) -> Soup {
    cuboid(DVec3::new(width, height, depth), 0.0).moved(0.0, -height / 2.0, -depth / 2.0)
}

/// Each step: where its nose is, and how deep it is.
fn steps() -> Vec<(DVec2, f64)> {
    let mut steps = Vec::new();
    let count = FLIGHTS.iter().sum::<usize>() + FLIGHTS.len() - 1;
    let depth = FLIGHTS.iter().sum::<usize>() as f64 * RUN + (FLIGHTS.len() - 1) as f64 * LANDING;
    let (mut y, mut z) = (TERRACE + (count + 1) as f64 * RISE, COURT - TERRACE_DEPTH - depth);
    for (i, flight) in FLIGHTS.into_iter().enumerate() {
        let landing = (i + 1 < FLIGHTS.len()).then_some(LANDING);
        for depth in std::iter::repeat_n(RUN, flight).chain(landing) {
            y -= RISE;
            z += depth;
            steps.push((DVec2::new(z, y), depth));
        }
    }
    steps
}

/// A wall along the flight, its top parallel to the noses, from the ground up; a pier at its foot.
fn flank(steps: &[(DVec2, f64)], top: DVec2) -> Soup {
    let foot = COURT - TERRACE_DEPTH;
    let mut outline = vec![DVec2::new(top.x, 0.0), DVec2::new(foot + 0.9, 0.0)];
    outline.push(DVec2::new(foot + 0.9, TERRACE + PARAPET + 0.35));
    outline.push(DVec2::new(foot - 0.4, TERRACE + PARAPET + 0.35));
    for (nose, depth) in steps.iter().rev().filter(|(_, depth)| *depth > RUN) {
        outline.push(DVec2::new(nose.x, nose.y + PARAPET));
        outline.push(DVec2::new(nose.x - depth, nose.y + PARAPET));
    }
    outline.push(DVec2::new(top.x, top.y + PARAPET));
    pulled(&outline, FLANK)
}

/// Where the light shines through: two piers and an arch.
fn gate() -> Soup {
    let (half, spring, radius) = (WIDTH / 2.0 + FLANK, 3.4, 2.9);
    let mut outline = vec![DVec2::new(-half, 0.0), DVec2::new(-radius, 0.0)];
    outline.extend(arc(DVec2::new(0.0, spring), DVec2::splat(radius), 0.5, 0.0, 24));
    outline.extend([(radius, 0.0), (half, 0.0), (half, 7.0), (-half, 7.0)].map(DVec2::from));
    let cornice =
        [(-0.55, 0.0), (0.55, 0.0), (0.62, 0.12), (0.80, 0.20), (0.80, 0.42), (-0.80, 0.42), (-0.80, 0.20), (-0.62, 0.12)];
    let cornice = pulled(&cornice.map(DVec2::from), 2.0 * half + 0.5).moved(0.0, 7.0, 0.0);
    // A flat gable above it.
    let gable = [(-half - 0.1, 0.0), (half + 0.1, 0.0), (0.0, 1.5)].map(DVec2::from);
    extruded(&outline, &[], 1.1).and(cornice).and(extruded(&gable, &[], 1.1).moved(0.0, 7.42, 0.0))
}

fn obelisk() -> Soup {
    let taper = |p: DVec3| {
        let k = 1.0 - 0.42 * ((p.y - 0.9) / 4.6).clamp(0.0, 1.0);
        DVec3::new(p.x * k, p.y, p.z * k)
    };
    let shaft = cuboid(DVec3::new(0.62, 4.6, 0.62), 0.0).moved(0.0, 3.2, 0.0).map(taper);
    // The point is cut as the shaft's own end.
    let mut point = Soup::default();
    let corners =
        [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)].map(|(x, z)| DVec3::new(x * 0.31 * 0.58, 5.5, z * 0.31 * 0.58));
    let top = DVec3::new(0.0, 6.0, 0.0);
    for i in 0..4 {
        point.triangle([corners[i], corners[(i + 1) % 4], top], [DVec2::ZERO; 3]);
    }
    point.quad([corners[3], corners[2], corners[1], corners[0]], [DVec2::ZERO; 4]);
    let foot = cuboid(DVec3::new(1.25, 0.25, 1.25), 0.03).moved(0.0, 0.125, 0.0);
    let plinth = cuboid(DVec3::new(0.95, 0.65, 0.95), 0.03).moved(0.0, 0.575, 0.0);
    shaft.and(point).and(foot).and(plinth)
}

/// The stone's brightness varies a little from place to place.
fn weathered(soup: Soup, which: i64) -> Soup {
    let tone = 0.95 + 0.05 * hash(which, 5, 90);
    soup.painted(move |_| [tone, tone * (0.97 + 0.03 * hash(which, 6, 90)), tone * (0.92 + 0.05 * hash(which, 7, 90))])
}

/// The building, and an obelisk beside it that is placed by the scene.
pub fn file() -> Vec<u8> {
    let mut glb = Glb::default();
    let texture = glb.texture("sandstone", &texture::sandstone());
    let stone = glb.material(&Look { name: "sandstone", color: [1.0, 0.97, 0.92], texture: Some(texture), ..Look::default() });
    let plain = glb.material(&Look { name: "worn stone", color: [0.60, 0.53, 0.44], roughness: 0.85, ..Look::default() });

    let place = |glb: &mut Glb, name: &str, mesh: usize, p: DVec3| {
        glb.node(json!({"name": name, "mesh": mesh, "translation": p.as_vec3().to_array()}));
    };
    let made = |glb: &mut Glb, name: &str, soup: Soup, material: usize| glb.mesh(name, &[(soup.creased(0.9), material)], &[]);

    let steps = steps();
    let top = DVec2::new(steps[0].0.x - steps[0].1, steps[0].0.y + RISE);
    let treads: Vec<usize> =
        (0..5).map(|i| made(&mut glb, &format!("tread {i}"), weathered(block(WIDTH, BODY, RUN), i), plain)).collect();
    let landing = made(&mut glb, "landing", weathered(block(WIDTH, BODY, LANDING), 3), plain);
    for (i, (nose, depth)) in steps.iter().enumerate() {
        let tread = treads[(hash(i as i64, 1, 91) * 5.0) as usize % 5];
        let mesh = if *depth > RUN { landing } else { tread };
        place(&mut glb, &format!("step {}", i + 1), mesh, DVec3::new(0.0, nose.y, nose.x));
    }
    let walls = |soup: Soup| soup.box_mapped(1.0 / 2.4);
    let platform = walls(block(WIDTH + 2.0 * FLANK, top.y, 14.0));
    let platform = made(&mut glb, "platform", platform, stone);
    place(&mut glb, "platform", platform, DVec3::new(0.0, top.y, top.x));
    let flank = made(&mut glb, "flank", walls(flank(&steps, top)), stone);
    for (name, side) in [("left flank", -1.0), ("right flank", 1.0)] {
        place(&mut glb, name, flank, DVec3::new(side * (WIDTH + FLANK) / 2.0, 0.0, 0.0));
    }
    let (z, y) = (TERRACE_DEPTH, TERRACE);
    let cornice = [(z, y - 0.5), (z + 0.08, y - 0.42), (z + 0.2, y - 0.34), (z + 0.2, y)];
    let mut profile = [(0.0, 0.0), (z + 0.12, 0.0), (z + 0.12, 0.45), (z, 0.57)].map(DVec2::from).to_vec();
    profile.extend(cornice.map(DVec2::from));
    profile.push(DVec2::new(0.0, y));
    let terrace = pulled(&profile, WIDTH + 4.2);
    let terrace = made(&mut glb, "terrace", walls(terrace), stone);
    place(&mut glb, "terrace", terrace, DVec3::new(0.0, 0.0, COURT - TERRACE_DEPTH));
    let gate = made(&mut glb, "gate", walls(gate()), stone);
    place(&mut glb, "gate", gate, DVec3::new(0.0, top.y, top.x - 0.7));

    let low = made(&mut glb, "low step", weathered(block(COURT_WIDTH, 1.6, LOW_RUN), 9), plain);
    for k in 0..LOW_STEPS {
        let p = DVec3::new(0.0, -RISE * (k + 1) as f64, COURT_END + LOW_RUN * (k + 1) as f64);
        place(&mut glb, &format!("step {}", steps.len() + k + 1), low, p);
    }
    glb.show("obelisk", &[(walls(obelisk()).creased(0.9), stone)]);
    glb.finish()
}
