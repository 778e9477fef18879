//! Cubes, balls and the hanging cut-out.

use glam::{DVec2, DVec3};

use super::glb::{Glb, Look};
use super::math::turn;
use super::polygon::{arc, extruded, stroke};
use super::soup::{cuboid, sphere};

/// Adjacent facets meet smoothly below some 40 degrees.
pub const CREASE: f64 = 0.76;

/// Unit solids about the origin, white, to be recoloured.
pub fn file() -> Vec<u8> {
    let mut glb = Glb::default();
    let matt = glb.material(&Look { name: "matt", roughness: 0.65, ..Look::default() });
    let glossy = glb.material(&Look { name: "glossy", roughness: 0.3, ..Look::default() });
    glb.show("cube", &[(cuboid(DVec3::ONE, 0.0).creased(CREASE), matt)]);
    glb.show("bevelled cube", &[(cuboid(DVec3::ONE, 0.03).creased(0.95), matt)]);
    glb.show("ball", &[(sphere(0.5, 40, 20).creased(CREASE), glossy)]);
    glb.show("small ball", &[(sphere(0.5, 24, 12).creased(CREASE), glossy)]);
    glb.finish()
}

/// The slab of Kilgard's figure 9 with a pattern of its own: the program's name in stencil letters
/// (no letter holds an island, as on a crate), and a slab with a sun.
pub fn cutout() -> Vec<u8> {
    let v = DVec2::new;
    let round = |x: f64, r: f64, from: f64, to: f64, n: usize| arc(v(x, 0.0), DVec2::splat(r), from, to, n);
    let w = 0.085;
    let (r, h) = (0.17, 0.25); // half a letter's width and height
    let oval = |x: f64, from: f64, to: f64| arc(v(x, 0.0), v(r - w / 2.0, h - w / 2.0), from, to, 12);
    let mut holes: Vec<Vec<DVec2>> = Vec::new();
    let mut cut = |line: &[DVec2]| holes.push(stroke(line, w));
    let pitch = 0.45;
    let x = |i: usize| (i as f64 - 3.0) * pitch;
    // O
    cut(&oval(x(0), -0.22, 0.22));
    cut(&oval(x(0), 0.28, 0.72));
    // B and R: a stem, and bowls that leave a bridge to it.
    for (i, lower) in [(1, true), (5, false)] {
        let (left, q) = (x(i) - r + w / 2.0, h / 2.0);
        cut(&[v(left, -h), v(left, h)]);
        let bowl = |y: f64, half: f64| {
            let mut line = vec![v(left + 0.095, y + half)];
            line.extend(arc(v(x(i) + 0.03, y), v(0.10, half), 0.25, -0.25, 10));
            line.push(v(left + 0.095, y - half));
            line
        };
        cut(&bowl(q + 0.01, q - w / 2.0 - 0.01));
        if lower {
            cut(&bowl(-q - 0.005, q - w / 2.0 - 0.005));
        } else {
            cut(&[v(left + 0.11, -0.055), v(x(i) + r - 0.02, -h)]);
        }
    }
    // S
    let (sr, sh) = (r - w / 2.0, (h - w / 2.0) / 2.0);
    let mut s = arc(v(x(2), sh), v(sr, sh), 0.07, 0.75, 14);
    s.extend(arc(v(x(2), -sh), v(sr, sh), 0.25, -0.43, 14).into_iter().skip(1));
    cut(&s);
    // C
    cut(&oval(x(3), 0.12, 0.88));
    // U
    let mut u = vec![v(x(4) - r + w / 2.0, h)];
    u.extend(arc(v(x(4), -h + r), DVec2::splat(r - w / 2.0), 0.5, 1.0, 12));
    u.push(v(x(4) + r - w / 2.0, h));
    cut(&u);
    // A
    cut(&[v(x(6) - r + 0.01, -h), v(x(6) - 0.045, h - 0.02)]);
    cut(&[v(x(6) + r - 0.01, -h), v(x(6) + 0.045, h - 0.02)]);
    cut(&[v(x(6) - 0.045, -0.1), v(x(6) + 0.045, -0.1)]);
    let (half, corner) = (v(1.78, 0.46), 0.14);
    let outline: Vec<DVec2> = [(1.0, 1.0, 0.0), (-1.0, 1.0, 0.25), (-1.0, -1.0, 0.5), (1.0, -1.0, 0.75)]
        .into_iter()
        .flat_map(|(sx, sy, from)| arc(v(sx, sy) * (half - corner), DVec2::splat(corner), from, from + 0.25, 5))
        .collect();
    let mut glb = Glb::default();
    let brass = glb.material(&Look { name: "lacquer", color: [0.42, 0.05, 0.04], roughness: 0.35, ..Look::default() });
    let word = extruded(&outline, &holes, 0.06);
    glb.show("word", &[(word.creased(0.9), brass)]);

    // A disc with an O cut out in two halves and rays around it.
    let mut rays = vec![stroke(&round(0.0, 0.24, -0.21, 0.21, 14), 0.1), stroke(&round(0.0, 0.24, 0.29, 0.71, 14), 0.1)];
    for i in 0..12 {
        let at = |turns: f64, r: f64| turn(i as f64 / 12.0 + turns) * r;
        rays.push(vec![at(-0.022, 0.36), at(-0.03, 0.48), at(0.0, 0.72), at(0.03, 0.48), at(0.022, 0.36)]);
    }
    let disc = arc(v(0.0, 0.0), DVec2::splat(0.85), 0.0, 1.0 - 1.0 / 48.0, 47);
    glb.show("sun", &[(extruded(&disc, &rays, 0.06).creased(0.9), brass)]);
    glb.finish()
}
