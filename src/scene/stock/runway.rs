//! K's figure 18: a runway whose markings, and the shadow of an aeroplane over it, lie in the very plane of the ground.
//!
//! Stripes of grass, asphalt, markings, tyre marks and the aeroplane's shadow are decals in the plane y = 0, one over the
//! other. The shadow is the aeroplane's triangles that look into the sun, thrown on the ground: many of them overlap.

use std::f32::consts::{PI, TAU};

use glam::{DVec3, Mat3, Vec3};

use super::carpentry::{boxes, turned};
use super::compose::{Composer, Prop, at};
use crate::scene::gltf::ImportError;
use crate::scene::{LightKind, Scene};

/// The way sunlight goes.
const SUN: Vec3 = Vec3::new(-0.62, -1.0, -0.34);

/// A solid: corners and triangles, counter-clockwise from outside.
type Solid = (Vec<Vec3>, Vec<[u32; 3]>);

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("runway", &[])?;
    c.environment([0.30, 0.345, 0.42], [0.15, 0.15, 0.10], [0.16, 0.38, 0.80], [1.10, 1.02, 0.90]);
    ground(&mut c);
    aeroplane(&mut c);
    field(&mut c);

    let sun = c.looking("sun", [-SUN.x * 40.0, 40.0, -SUN.z * 40.0].map(f64::from), [0.0; 3]);
    c.light(sun, LightKind::Directional, [1.0, 0.91, 0.76], 3.3, f32::INFINITY);

    c.camera("threshold", [-9.4, 5.4, 31.0], [-0.5, 2.3, 3.2], 42.0);
    c.camera("tower", [26.0, 12.5, 22.0], [-0.5, 1.5, 0.0], 38.0);
    c.camera("ground", [5.6, 0.55, 30.0], [-0.8, 2.9, 4.0], 50.0);
    Ok(c.finish())
}

/// Rectangles in the plane y = 0, looking up: middle and size, x and z.
fn flat(c: &mut Composer, name: &str, list: &[([f32; 2], [f32; 2])], color: [f32; 3]) -> Prop {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for &([x, z], [wide, long]) in list {
        let first = positions.len() as u32;
        let corners = [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]];
        positions.extend(corners.map(|[a, b]: [f32; 2]| Vec3::new(x + a * wide / 2.0, 0.0, z + b * long / 2.0)));
        triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    Composer::shadeless(c.made(name, &positions, &triangles, color, 0.95))
}

fn ground(c: &mut Composer) {
    let grass = flat(c, "grass", &[([0.0, 0.0], [132.0, 132.0])], [0.085, 0.155, 0.04]);
    c.put("grass", grass, at(0.0, 0.0, 0.0));
    let mown: Vec<_> = (0..8).map(|stripe| ([0.0, -59.0 + 16.4 * stripe as f32], [131.0, 8.2])).collect();
    let apron = [([0.0, 0.0], [15.0, 126.0]), ([24.0, -20.0], [34.0, 9.0])];
    let mut marks = vec![([-6.7, 0.0], [0.3, 124.0]), ([6.7, 0.0], [0.3, 124.0])];
    // The threshold's bars, the middle line, and where to touch down.
    marks.extend([-5.4, -4.0, -2.6, -1.2, 1.2, 2.6, 4.0, 5.4].map(|x| ([x, 22.5], [0.72, 7.0])));
    marks.extend((0..9).map(|dash| ([0.0, 12.0 - 8.0 * dash as f32], [0.34, 4.2])));
    marks.extend([-3.3, 3.3].map(|x| ([x, -3.0], [1.5, 6.0])));
    marks.extend([([24.0, -20.0], [33.0, 0.22])]);
    let tyres: Vec<_> = (0..7)
        .map(|mark| ([-2.2 + 0.73 * mark as f32, 4.0 - 2.1 * (mark % 3) as f32], [0.3, 15.0 + (mark % 4) as f32 * 3.0]))
        .collect();
    for (name, list, color, opacity) in [
        ("mown grass", &mown[..], [0.13, 0.215, 0.06], 1.0),
        ("asphalt", &apron, [0.105, 0.108, 0.115], 1.0),
        ("markings", &marks, [0.82, 0.82, 0.78], 1.0),
        ("tyre marks", &tyres, [0.012, 0.012, 0.013], 0.5),
    ] {
        let prop = flat(c, name, list, color);
        let prop = c.decal(prop, opacity);
        c.put(name, prop, at(0.0, 0.0, 0.0));
    }
}

/// A solid of eight corners, each told by whether it is at the far end in x, y and z.
fn block(corner: impl Fn(bool, bool, bool) -> Vec3) -> Solid {
    let positions = (0..8).map(|i| corner(i & 1 == 1, i & 2 == 2, i & 4 == 4)).collect();
    let quads: [[u32; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    (positions, quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

fn cuboid(middle: [f32; 3], size: [f32; 3]) -> Solid {
    let (middle, half) = (Vec3::from(middle), Vec3::from(size) / 2.0);
    block(|x, y, z| middle + half * Vec3::from([x, y, z].map(|far| if far { 1.0 } else { -1.0 })))
}

/// Turned about a line along z: z and radius from the tail to the nose; its ends are points.
fn spindle([x, y]: [f32; 2], profile: &[[f32; 2]], sides: u32) -> Solid {
    let (first, last) = (profile[0], profile[profile.len() - 1]);
    let inner = &profile[1..profile.len() - 1];
    let mut positions: Vec<Vec3> = vec![Vec3::new(x, y, first[0]), Vec3::new(x, y, last[0])];
    for &[z, radius] in inner {
        positions.extend((0..sides).map(|side| {
            let (sin, cos) = (side as f32 / sides as f32 * TAU).sin_cos();
            Vec3::new(x + radius * cos, y + radius * sin, z)
        }));
    }
    let ring = |number: u32, side: u32| 2 + number * sides + side % sides;
    let mut triangles = Vec::new();
    let end = inner.len() as u32 - 1;
    for side in 0..sides {
        triangles.extend([[0, ring(0, side + 1), ring(0, side)], [1, ring(end, side), ring(end, side + 1)]]);
        for number in 0..end {
            let [a, b] = [ring(number, side), ring(number, side + 1)];
            let [d, e] = [ring(number + 1, side), ring(number + 1, side + 1)];
            triangles.extend([[a, b, e], [a, e, d]]);
        }
    }
    (positions, triangles)
}

/// A wing, or anything like one: root and tip, each by its side (x), height (y), leading and trailing edge (z) and thickness.
fn wing(side: f32, root: [f32; 5], tip: [f32; 5]) -> Solid {
    block(|x, y, z| {
        let [out, up, front, back, thick] = if x == (side > 0.0) { tip } else { root };
        Vec3::new(side * out, up + if y { thick / 2.0 } else { -thick / 2.0 }, if z { front } else { back })
    })
}

fn aeroplane(c: &mut Composer) {
    let hull = [
        [-9.4, 0.0],
        [-9.0, 0.16],
        [-6.6, 0.66],
        [-4.2, 1.02],
        [-2.0, 1.12],
        [5.6, 1.12],
        [7.2, 0.98],
        [8.3, 0.68],
        [8.9, 0.34],
        [9.1, 0.0],
    ];
    let engine = [[-0.9, 0.0], [-0.9, 0.3], [-0.4, 0.52], [1.2, 0.6], [1.75, 0.5], [1.75, 0.36], [1.5, 0.0]];
    let fin = block(|x, y, z| {
        let (front, back, thick) = if y { (-7.9, -9.5, 0.05) } else { (-5.6, -9.0, 0.14) };
        Vec3::new(if x { thick } else { -thick }, if y { 3.9 } else { 0.55 }, if z { front } else { back })
    });
    let mut white = vec![spindle([0.0, 0.0], &hull, 28)];
    let (mut grey, mut dark) = (Vec::new(), Vec::new());
    for side in [-1.0, 1.0] {
        grey.push(wing(side, [0.8, -0.45, 2.7, -1.7, 0.42], [9.8, 0.55, -2.0, -3.3, 0.12]));
        grey.push(wing(side, [0.3, 0.25, -6.5, -8.6, 0.2], [3.7, 0.55, -8.2, -9.2, 0.08]));
        white.push(spindle([side * 3.3, -1.05], &engine.map(|[z, radius]| [z + 1.1, radius]), 20));
        dark.push(spindle([side * 3.3, -1.05], &[[2.4, 0.0], [2.45, 0.34], [2.87, 0.34], [2.9, 0.0]], 20));
        dark.extend((0..21).map(|window| cuboid([side * 1.08, 0.36, -4.0 + 0.48 * window as f32], [0.1, 0.24, 0.2])));
        // Into the hull where the nose begins.
        dark.push(block(|x, y, z| {
            let (out, up) = if y { (0.52, 0.80) } else { (0.70, 0.44) };
            let out = out - if z { 0.18 } else { 0.0 };
            Vec3::new(side * out + if x { 0.16 } else { -0.16 }, up, if z { 8.05 } else { 7.35 })
        }));
    }
    let red = vec![fin];
    // On its last metres, nose up, and a little askew in the wind.
    let turn = Mat3::from_rotation_y(0.16) * Mat3::from_rotation_x(-0.075) * Mat3::from_rotation_z(0.05);
    let place = |at: Vec3| turn * at + Vec3::new(-0.3, 4.6, 4.0);
    let mut shadow: Solid = (Vec::new(), Vec::new());
    for (name, solids, color, roughness) in [
        ("hull", &white, [0.80, 0.81, 0.83], 0.35),
        ("wings", &grey, [0.46, 0.48, 0.51], 0.4),
        ("windows", &dark, [0.015, 0.018, 0.025], 0.3),
        ("fin", &red, [0.55, 0.035, 0.03], 0.4),
    ] {
        for (number, (positions, triangles)) in solids.iter().enumerate() {
            let positions: Vec<_> = positions.iter().map(|&at| place(at)).collect();
            throw(&positions, triangles, &mut shadow);
            let part = c.made(name, &positions, triangles, color, roughness);
            // Its shadow lies on the ground already.
            c.put(&format!("{name} {number}"), Composer::shadeless(part), at(0.0, 0.0, 0.0));
        }
    }
    let (positions, triangles) = shadow;
    let shadow = c.made("aeroplane's shadow", &positions, &triangles, [0.004, 0.006, 0.012], 1.0);
    let shadow = c.decal(shadow, 0.62);
    c.put("aeroplane's shadow", Composer::shadeless(shadow), at(0.0, 0.0, 0.0));
}

/// What looks into the sun, thrown on the ground along its light; looking up.
fn throw(positions: &[Vec3], triangles: &[[u32; 3]], shadow: &mut Solid) {
    for triangle in triangles {
        let [a, b, c] = triangle.map(|corner| positions[corner as usize]);
        if (b - a).cross(c - a).dot(SUN) >= 0.0 {
            continue;
        }
        let thrown = [a, b, c].map(|at| {
            let down = at - SUN * (at.y / SUN.y);
            Vec3::new(down.x, 0.0, down.z)
        });
        // What faces the sun faces up when it is thrown down.
        if (thrown[1] - thrown[0]).cross(thrown[2] - thrown[0]).y > 1e-9 {
            let first = shadow.0.len() as u32;
            shadow.0.extend(thrown);
            shadow.1.push([first, first + 1, first + 2]);
        }
    }
}

/// What stands beside the runway.
fn field(c: &mut Composer) {
    let post = boxes(c, "post", &[([0.0, 0.09, 0.0], [0.1, 0.18, 0.1])], [0.50, 0.33, 0.04], 0.6);
    let bulb = boxes(c, "bulb", &[([0.0, 0.22, 0.0], [0.13, 0.1, 0.13])], [1.0, 1.0, 1.0], 0.5);
    let glow = c.glowing(bulb, [2.2, 1.7, 0.9]);
    for number in 0..13 {
        for side in [-1.0, 1.0] {
            let place = (side * 7.9, 27.0 - 6.5 * f64::from(number));
            c.put("edge post", post, at(place.0, 0.0, place.1));
            c.put("edge light", glow, at(place.0, 0.0, place.1));
        }
    }
    let hall = boxes(c, "hall", &[([0.0, 2.2, 0.0], [13.0, 4.4, 9.0])], [0.43, 0.45, 0.47], 0.8);
    let gate = boxes(c, "gate", &[([0.0, 1.75, 0.0], [9.0, 3.5, 0.2])], [0.10, 0.18, 0.30], 0.6);
    for (number, z) in [-26.0, -12.0, -42.0].into_iter().enumerate() {
        c.put(&format!("hangar {number}"), hall, at(46.0, 0.0, z).facing(-90.0));
        c.put(&format!("gate {number}"), gate, at(41.45, 0.0, z).facing(-90.0));
    }
    let shaft = [[0.0, 0.0], [1.5, 0.0], [1.15, 7.5], [2.1, 8.3], [2.1, 8.5], [0.0, 8.5]];
    let shaft = turned(c, "tower", &shaft, 16, [0.62, 0.60, 0.56], 0.8);
    c.put("tower", shaft, at(-24.0, 0.0, -24.0));
    let cab = turned(c, "cab", &[[0.0, 8.45], [1.85, 8.45], [2.15, 9.9], [0.0, 9.9]], 10, [0.03, 0.06, 0.08], 0.3);
    c.put("cab", cab, at(-24.0, 0.0, -24.0));
    let roof = turned(c, "roof", &[[0.0, 9.85], [2.35, 9.85], [2.2, 10.2], [0.0, 10.5]], 16, [0.50, 0.08, 0.06], 0.7);
    c.put("roof", roof, at(-24.0, 0.0, -24.0));
    let dish =
        boxes(c, "dish", &[([0.0, 10.9, 0.0], [2.2, 0.5, 0.12]), ([0.0, 10.6, 0.3], [0.12, 0.6, 0.12])], [0.7, 0.7, 0.7], 0.5);
    let dish = c.put("dish", dish, at(-24.0, 0.0, -24.0));
    c.swings(dish, 5.0, DVec3::Y, 80.0);
    let hill = [[0.0, -0.5], [17.0, -0.5], [12.0, 2.6], [6.0, 4.3], [0.0, 4.9]];
    let hill = turned(c, "hill", &hill, 14, [0.055, 0.095, 0.05], 1.0);
    for (number, (x, z, size)) in
        [(-46.0, -44.0, 1.0), (-12.0, -52.0, 0.8), (18.0, -50.0, 0.95), (45.0, -48.0, 0.85)].into_iter().enumerate()
    {
        c.put(&format!("hill {number}"), Composer::shadeless(hill), at(x, 0.0, z).sized(size));
    }
    let (trunk, crown) = tree(c);
    for (number, (x, z, size)) in [
        (-14.0, 8.0, 1.0),
        (-17.5, -2.0, 1.25),
        (-13.2, -10.0, 0.85),
        (-20.0, 13.0, 1.15),
        (13.5, 10.0, 0.9),
        (16.5, 2.0, 1.1),
        (-30.0, -6.0, 1.3),
    ]
    .into_iter()
    .enumerate()
    {
        c.put(&format!("trunk {number}"), trunk, at(x, 0.0, z).sized(size));
        c.put(&format!("crown {number}"), crown, at(x, 0.0, z).sized(size).facing(50.0 * number as f64));
    }
}

fn tree(c: &mut Composer) -> (Prop, Prop) {
    let trunk = turned(c, "trunk", &[[0.0, 0.0], [0.22, 0.0], [0.14, 1.2], [0.0, 1.2]], 8, [0.09, 0.055, 0.03], 1.0);
    let leaf = |height: f32| 1.15 * (PI * ((height - 0.8) / 3.4).clamp(0.0, 1.0)).sin().max(0.02).powf(0.7);
    let mut profile = vec![[0.0, 0.9]];
    profile.extend([1.0, 1.5, 2.1, 2.8, 3.4, 3.9].map(|height| [leaf(height), height]));
    profile.push([0.0, 4.15]);
    (trunk, turned(c, "crown", &profile, 10, [0.05, 0.115, 0.035], 1.0))
}
