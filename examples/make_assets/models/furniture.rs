//! What stands about: fountain, statue, trees, lanterns, benches.

use glam::{DVec2, DVec3};

use super::glb::{Glb, Look};
use super::math::{hash, smoothstep, turn};
use super::polygon::arc;
use super::solids::CREASE;
use super::soup::{Soup, cuboid, lathe, sphere, tube, turned};
use super::texture;

fn points(list: &[(f64, f64)]) -> Vec<DVec2> {
    list.iter().copied().map(DVec2::from).collect()
}

fn fountain() -> Soup {
    // The pool: eight-sided outside and in.
    let octagon = |turns: f64| {
        let t = turns * 8.0 - (turns * 8.0).floor() - 0.5;
        turn(1.0 / 16.0).x / turn(t / 8.0).x
    };
    let pool = points(&[
        (0.0, 0.0),
        (1.75, 0.0),
        (1.75, 0.10),
        (1.62, 0.14),
        (1.60, 0.42),
        (1.66, 0.48),
        (1.72, 0.50),
        (1.72, 0.58),
        (1.42, 0.58),
        (1.42, 0.52),
        (1.46, 0.50),
        (1.46, 0.16),
        (0.0, 0.16),
    ]);
    let pool = lathe(&pool, 32, |p, turns| p.x * octagon(turns + 1.0 / 16.0));
    // The stem and the upper bowl, in one turned piece.
    let mut stem = points(&[(0.0, 0.14), (0.34, 0.14), (0.34, 0.24), (0.26, 0.30), (0.17, 0.40)]);
    stem.extend(points(&[(0.12, 0.58), (0.12, 0.72), (0.18, 0.84), (0.19, 0.88), (0.13, 0.93), (0.15, 0.99)]));
    stem.extend(arc(DVec2::new(0.0, 1.42), DVec2::new(0.86, 0.42), -0.22, -0.03, 7));
    stem.extend(points(&[(0.90, 1.38), (0.90, 1.43), (0.80, 1.43), (0.78, 1.385)]));
    stem.extend(arc(DVec2::new(0.0, 1.40), DVec2::new(0.76, 0.28), -0.03, -0.20, 5));
    stem.extend(points(&[(0.10, 1.19), (0.085, 1.30), (0.075, 1.55), (0.11, 1.60), (0.11, 1.64), (0.07, 1.67)]));
    stem.extend(arc(DVec2::new(0.0, 1.79), DVec2::new(0.11, 0.13), -0.17, 0.12, 5));
    stem.extend(points(&[(0.035, 1.95), (0.0, 2.05)]));
    let stem = lathe(&stem, 36, |p, turns| {
        // A scalloped bowl.
        let scallop = smoothstep(0.3, 0.85, p.x) * smoothstep(1.05, 1.2, p.y);
        p.x * (1.0 + 0.025 * scallop * turn(turns * 12.0).x)
    });
    pool.and(stem)
}

/// Still water: single sheets a little below the rims.
fn water() -> Soup {
    let disc = |r: f64, y: f64| turned(&[(r, y), (0.0, y)], 32);
    disc(1.44, 0.46).and(disc(0.72, 1.34))
}

/// A trefoil-like band that never ends.
fn knot() -> Soup {
    let path: Vec<DVec3> = (0..112)
        .map(|i| {
            let t = i as f64 / 112.0;
            let (around, through) = (turn(t * 2.0), turn(t * 3.0));
            let r = 0.36 + 0.15 * through.x;
            DVec3::new(around.x * r, around.y * r, 0.17 * through.y)
        })
        .collect();
    tube(&path, 12, |_| 0.075)
}

fn plinth() -> Soup {
    cuboid(DVec3::new(0.92, 0.16, 0.92), 0.02)
        .moved(0.0, 0.08, 0.0)
        .and(cuboid(DVec3::new(0.70, 0.86, 0.70), 0.02).moved(0.0, 0.56, 0.0))
        .and(cuboid(DVec3::new(0.88, 0.12, 0.88), 0.025).moved(0.0, 1.03, 0.0))
        .box_mapped(0.5)
}

fn cypress() -> Soup {
    let mut profile = points(&[(0.0, 0.55)]);
    let n = 16;
    for k in 1..n {
        let t = k as f64 / n as f64;
        let r = 0.42 * smoothstep(-0.05, 0.28, t) * (1.0 - t * t * 0.92 - 0.06 * t);
        profile.push(DVec2::new(r.max(0.02), 0.55 + 2.55 * t));
    }
    profile.push(DVec2::new(0.0, 3.15));
    let leaf = |p: DVec2, turns: f64| {
        let (column, row) = ((turns * 18.0).round() as i64 % 18, (p.y * 10.0).round() as i64);
        p.x * (0.86 + 0.28 * hash(column, row, 9))
    };
    let trunk = turned(&[(0.0, 0.40), (0.06, 0.40), (0.05, 0.75), (0.0, 0.75)], 8).painted(|_| [0.12, 0.07, 0.04]);
    let crown = lathe(&profile, 18, leaf).painted(|p| {
        let light = 0.6 + 0.55 * smoothstep(0.5, 3.2, p.y);
        let speck = 0.8 + 0.4 * hash((p.x * 90.0) as i64, (p.y * 50.0 + p.z * 70.0) as i64, 10);
        [0.045, 0.125, 0.05].map(|c| c * light * speck)
    });
    crown.and(trunk)
}

fn pot() -> Soup {
    turned(
        &[
            (0.0, 0.0),
            (0.23, 0.0),
            (0.25, 0.04),
            (0.31, 0.36),
            (0.33, 0.40),
            (0.38, 0.40),
            (0.38, 0.50),
            (0.32, 0.50),
            (0.31, 0.44),
            (0.0, 0.44),
        ],
        28,
    )
}

/// A cage of six bars with a roof, about the origin: the flame is at the origin.
fn cage() -> Soup {
    let mut soup = turned(&[(0.0, -0.17), (0.10, -0.17), (0.12, -0.15), (0.12, -0.13), (0.0, -0.13)], 18);
    soup =
        soup.and(turned(&[(0.0, 0.13), (0.13, 0.13), (0.14, 0.15), (0.06, 0.23), (0.03, 0.24), (0.02, 0.29), (0.0, 0.30)], 18));
    for i in 0..6 {
        let d = turn((f64::from(i) + 0.5) / 6.0) * 0.105;
        soup = soup.and(cuboid(DVec3::new(0.013, 0.28, 0.013), 0.0).moved(d.x, 0.0, d.y));
    }
    soup
}

fn post() -> Soup {
    turned(
        &[
            (0.0, 0.0),
            (0.19, 0.0),
            (0.19, 0.06),
            (0.12, 0.10),
            (0.07, 0.22),
            (0.045, 0.30),
            (0.038, 1.20),
            (0.055, 1.22),
            (0.055, 1.26),
            (0.035, 1.28),
            (0.03, 2.10),
            (0.05, 2.16),
            (0.09, 2.19),
            (0.09, 2.22),
            (0.0, 2.22),
        ],
        20,
    )
}

fn bench() -> Soup {
    let leg = |x: f64| cuboid(DVec3::new(0.16, 0.40, 0.38), 0.015).moved(x, 0.20, 0.0);
    cuboid(DVec3::new(1.7, 0.10, 0.46), 0.02).moved(0.0, 0.44, 0.0).and(leg(-0.6)).and(leg(0.6)).box_mapped(0.7)
}

/// A tall vase with a lip, hollow down to its foot.
fn urn() -> Soup {
    let mut profile = points(&[(0.0, 0.0), (0.16, 0.0), (0.17, 0.03), (0.10, 0.08)]);
    profile.extend(arc(DVec2::new(0.0, 0.50), DVec2::new(0.30, 0.42), -0.20, 0.15, 9));
    profile.extend(points(&[(0.13, 0.90), (0.12, 0.97), (0.19, 1.04), (0.20, 1.07), (0.16, 1.07), (0.09, 0.98), (0.09, 0.90)]));
    profile.extend(arc(DVec2::new(0.0, 0.50), DVec2::new(0.27, 0.39), 0.15, -0.15, 3));
    profile.push(DVec2::new(0.0, 0.17));
    lathe(&profile, 24, |p, _| p.x)
}

/// Everything that stands about in a court.
pub fn file() -> Vec<u8> {
    let mut glb = Glb::default();
    let plaster = glb.texture("plaster", &texture::plaster());
    let stone = glb.material(&Look {
        name: "stone",
        color: [0.86, 0.80, 0.70],
        roughness: 0.8,
        texture: Some(plaster),
        ..Look::default()
    });
    let wet = glb.material(&Look { name: "water", color: [0.03, 0.11, 0.13], roughness: 0.12, ..Look::default() });
    let bronze =
        glb.material(&Look { name: "bronze", color: [0.62, 0.36, 0.15], roughness: 0.3, metallic: 0.4, ..Look::default() });
    let leaves = glb.material(&Look { name: "leaves", color: [1.0; 3], roughness: 1.0, ..Look::default() });
    let clay = glb.material(&Look { name: "clay", color: [0.52, 0.20, 0.10], roughness: 0.85, ..Look::default() });
    let iron =
        glb.material(&Look { name: "iron", color: [0.06, 0.06, 0.065], roughness: 0.45, metallic: 0.3, ..Look::default() });
    let flame = glb.material(&Look { name: "flame", color: [0.2, 0.1, 0.05], emissive: [1.0, 0.72, 0.38], ..Look::default() });
    glb.show("fountain", &[(fountain().box_mapped(0.6).creased(0.85), stone)]);
    glb.show_without_shadow("water", &[(water().creased(CREASE), wet)]);
    glb.show("plinth", &[(plinth().creased(0.9), stone)]);
    glb.show("knot", &[(knot().creased(0.3), bronze)]);
    glb.show("cypress", &[(cypress().creased(0.8), leaves)]);
    glb.show("pot", &[(pot().creased(0.85), clay)]);
    glb.show("cage", &[(cage().creased(0.85), iron)]);
    glb.show_without_shadow("flame", &[(sphere(0.035, 16, 8).map(|p| p * DVec3::new(1.0, 1.8, 1.0)).creased(CREASE), flame)]);
    glb.show("post", &[(post().creased(0.85), iron)]);
    glb.show("bench", &[(bench().creased(0.9), stone)]);
    glb.show("urn", &[(urn().creased(0.85), clay)]);
    glb.finish()
}
