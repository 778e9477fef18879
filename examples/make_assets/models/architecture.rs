//! Floors, columns, arcades, steps, roofs, the amphitheatre.

use glam::{DVec2, DVec3};

use super::glb::{Glb, Look};
use super::math::{hash, turn};
use super::polygon::{arc, extruded, pulled, triangulate};
use super::solids::CREASE;
use super::soup::{Soup, cuboid, lathe};
use super::texture;

/// From column to column of an arcade.
const BAY: f64 = 2.4;
/// Where an arcade's arches spring; columns are as high.
const SPRING: f64 = 2.6;

fn square(half: f64, repeats: f64) -> Soup {
    let mut soup = Soup::default();
    let corners = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
    soup.quad(
        corners.map(|(x, z)| DVec3::new(x * half, 0.0, z * half)),
        corners.map(|(x, z)| DVec2::new(x, z) * (repeats / 2.0)),
    );
    soup
}

/// Squares 24 metres wide at y = 0 that cast no shadow.
pub fn floors() -> Vec<u8> {
    let mut glb = Glb::default();
    let pictures = [
        ("marble", texture::marble(), 12.0, 0.35),
        ("cobbles", texture::cobbles(), 18.0, 0.8),
        ("planks", texture::planks(), 14.0, 0.5),
        ("paving", texture::paving(), 10.0, 0.7),
    ];
    for (name, png, repeats, roughness) in pictures {
        let texture = glb.texture(name, &png);
        let look = glb.material(&Look { name, color: [1.0; 3], roughness, texture: Some(texture), ..Look::default() });
        glb.show_without_shadow(name, &[(square(12.0, repeats).creased(CREASE), look)]);
    }
    // Coloured by its vertices, which costs a software GPU next to nothing.
    let mut chequers = Soup::default();
    for x in -8..8 {
        for z in -8..8 {
            let [r, g, b] = if (x + z) % 2 == 0 { [0.56, 0.53, 0.48] } else { [0.17, 0.19, 0.23] };
            let shade = 0.88 + 0.24 * hash(x, z, 40);
            let tile = square(0.5, 1.0).map(|p| p + DVec3::new(x as f64 + 0.5, 0.0, z as f64 + 0.5));
            chequers = chequers.and(tile.painted(|_| [r * shade, g * shade, b * shade]));
        }
    }
    let painted = glb.material(&Look { name: "chequers", color: [1.0; 3], roughness: 0.6, ..Look::default() });
    glb.show_without_shadow("chequers", &[(chequers.creased(CREASE), painted)]);
    let plain = glb.material(&Look { name: "ground", color: [0.5; 3], ..Look::default() });
    glb.show_without_shadow("ground", &[(square(12.0, 1.0).creased(CREASE), plain)]);
    glb.finish()
}

fn column() -> Soup {
    const FLUTES: f64 = 12.0;
    let mut profile: Vec<DVec2> = vec![(0.0, 0.11), (0.30, 0.11)].into_iter().map(DVec2::from).collect();
    profile.extend(arc(DVec2::new(0.265, 0.16), DVec2::splat(0.05), -0.25, 0.25, 3)); // torus
    profile.extend([(0.242, 0.26), (0.205, 0.30)].map(DVec2::from));
    profile.extend([(0.205, 0.34), (0.200, 1.15), (0.180, 2.20)].map(DVec2::from)); // shaft, with entasis
    profile.extend([(0.180, 2.23), (0.205, 2.25), (0.205, 2.30)].map(DVec2::from));
    profile.extend([(0.186, 2.32), (0.215, 2.42), (0.272, 2.49), (0.0, 2.49)].map(DVec2::from));
    let shaft = lathe(&profile, 3 * FLUTES as usize, |p, turns| {
        let fluted = (0.34..=2.20).contains(&p.y);
        let f = turns * FLUTES - (turns * FLUTES).floor();
        if fluted { p.x - 0.022 * 4.0 * f * (1.0 - f) } else { p.x }
    });
    let plinth = cuboid(DVec3::new(0.64, 0.12, 0.64), 0.012).moved(0.0, 0.06, 0.0);
    let abacus = cuboid(DVec3::new(0.60, 0.12, 0.60), 0.012).moved(0.0, 2.54, 0.0);
    shaft.and(plinth).and(abacus)
}

/// The wall above `bays` arches, its springing at y = 2.6, centred, in the plane z = 0.
fn arcade(bays: usize) -> (Soup, Soup) {
    let (radius, height, half) = (0.94, 1.5, bays as f64 * BAY / 2.0);
    let centre = |k: usize| (k as f64 + 0.5) * BAY - half;
    let mut outline = vec![DVec2::new(-half - 0.26, 0.0)];
    for k in 0..bays {
        outline.extend(arc(DVec2::new(centre(k), 0.0), DVec2::splat(radius), 0.5, 0.0, 20));
    }
    outline.extend([(half + 0.26, 0.0), (half + 0.26, height), (-half - 0.26, height)].map(DVec2::from));
    let wall = extruded(&outline, &[], 0.46).box_mapped(1.0 / 1.6).moved(0.0, SPRING, 0.0);
    let mut trim = Soup::default();
    for k in 0..bays {
        let c = DVec2::new(centre(k), -0.004);
        let mut ring = arc(c, DVec2::splat(radius - 0.02), 0.5, 0.0, 20);
        ring.extend(arc(c, DVec2::splat(radius + 0.15), 0.0, 0.5, 20));
        trim = trim.and(extruded(&ring, &[], 0.54).moved(0.0, SPRING, 0.0));
        let key = [(-0.075, -0.06), (0.075, -0.06), (0.12, 0.26), (-0.12, 0.26)].map(|(x, y)| c + DVec2::new(x, y + radius));
        trim = trim.and(extruded(&key, &[], 0.64).moved(0.0, SPRING, 0.0));
    }
    let cornice: Vec<DVec2> =
        [(0.24, 0.0), (0.27, 0.03), (0.28, 0.08), (0.34, 0.12), (0.40, 0.14), (0.40, 0.22)].map(DVec2::from).to_vec();
    let mut both = cornice.clone();
    both.extend(cornice.iter().rev().map(|p| DVec2::new(-p.x, p.y)));
    trim = trim.and(pulled(&both, 2.0 * half + 0.76).moved(0.0, SPRING + height - 0.02, 0.0));
    (wall, trim)
}

/// Roman tiles: a wavy sheet that rises backwards (towards -z) from its eaves at the origin.
fn roof(length: f64, slope: f64, rise: f64) -> Soup {
    let tiles = (length / 0.24).round() as usize;
    let n = tiles * 6;
    let at = |i: usize| {
        let phase = turn(i as f64 / 6.0);
        DVec2::new((i as f64 / n as f64 - 0.5) * length, 0.035 + 0.045 * phase.x.max(-0.4))
    };
    let mut outline: Vec<DVec2> = (0..=n).rev().map(at).collect();
    // As many points below as there are tiles: two alone would make needles of the eaves.
    outline.extend((0..=tiles).map(|i| DVec2::new((i as f64 / tiles as f64 - 0.5) * length, -0.06)));
    let reach = (slope * slope + rise * rise).sqrt();
    extruded(&outline, &[], reach).map(|p| {
        let along = reach / 2.0 - p.z; // 0 at the eaves
        DVec3::new(p.x, (p.y * slope + along * rise) / reach, (p.y * rise - along * slope) / reach)
    })
}

fn stairs(steps: usize, rise: f64, run: f64, width: f64) -> Soup {
    let mut outline = vec![DVec2::ZERO];
    for k in (0..steps).rev() {
        let (z, y) = ((k + 1) as f64 * run, (steps - k - 1) as f64 * rise);
        outline.push(DVec2::new(z, y));
        outline.push(DVec2::new(z, y + rise));
    }
    outline.push(DVec2::new(0.0, steps as f64 * rise));
    pulled(&outline, width)
}

/// A profile (radius, height), counter-clockwise, swept about the axis between two angles, ends closed.
fn swept(profile: &[DVec2], from: f64, to: f64, segments: usize) -> Soup {
    let at = |p: DVec2, s: usize| {
        let d = turn(from + (to - from) * s as f64 / segments as f64);
        DVec3::new(p.x * d.x, p.y, -p.x * d.y)
    };
    let mut soup = Soup::default();
    for s in 0..segments {
        for (i, &a) in profile.iter().enumerate() {
            let b = profile[(i + 1) % profile.len()];
            soup.quad([at(a, s), at(a, s + 1), at(b, s + 1), at(b, s)], [DVec2::ZERO; 4]);
        }
    }
    for [a, b, c] in triangulate(profile, &[]) {
        let [a, b, c] = [profile[a], profile[b], profile[c]];
        soup.triangle([at(a, 0), at(b, 0), at(c, 0)], [DVec2::ZERO; 3]);
        soup.triangle([at(a, segments), at(c, segments), at(b, segments)], [DVec2::ZERO; 3]);
    }
    soup
}

fn amphitheatre() -> Soup {
    // Each tier a little higher than the one below it, so that all see over the heads before them.
    let (inner, tread, tiers) = (5.5, 0.85, 7);
    let rise = |k: i32| f64::from(k) * (0.38 + 0.012 * f64::from(k));
    let (outer, top) = (inner + tread * f64::from(tiers) + 0.9, rise(tiers));
    let mut profile =
        [(inner, 0.0), (outer, 0.0), (outer, top + 0.9), (outer - 0.5, top + 0.9), (outer - 0.5, top)].map(DVec2::from).to_vec();
    for k in (0..tiers).rev() {
        let r = inner + tread * f64::from(k);
        profile.push(DVec2::new(r, rise(k + 1)));
        if k > 0 {
            profile.push(DVec2::new(r, rise(k)));
        }
    }
    swept(&profile, -0.06, 0.56, 56).box_mapped(0.5)
}

/// Columns, arcades of four and six bays, steps, walls, roofs and seating in stone.
pub fn file() -> Vec<u8> {
    let mut glb = Glb::default();
    let ashlar = glb.texture("ashlar", &texture::ashlar());
    let plaster = glb.texture("plaster", &texture::plaster());
    let stone = glb.material(&Look {
        name: "stone",
        color: [0.86, 0.80, 0.70],
        roughness: 0.85,
        texture: Some(plaster),
        ..Look::default()
    });
    let courses =
        glb.material(&Look { name: "courses", color: [1.0; 3], roughness: 0.9, texture: Some(ashlar), ..Look::default() });
    let wash = glb.material(&Look {
        name: "limewash",
        color: [0.80, 0.52, 0.32],
        roughness: 0.95,
        texture: Some(plaster),
        ..Look::default()
    });
    let tiles = glb.material(&Look {
        name: "tiles",
        color: [0.50, 0.17, 0.09],
        roughness: 0.85,
        texture: Some(plaster),
        ..Look::default()
    });
    let box_stone = |soup: Soup| soup.box_mapped(0.5);
    glb.show("column", &[(box_stone(column()).creased(0.9), stone)]);
    for bays in [4, 6] {
        let (wall, trim) = arcade(bays);
        glb.show(&format!("arcade {bays}"), &[(wall.creased(0.9), courses), (box_stone(trim).creased(0.9), stone)]);
        let length = bays as f64 * BAY + 6.0; // beyond the arcade's ends, into the corners
        glb.show(&format!("roof {bays}"), &[(box_stone(roof(length, 3.5, 1.35)).creased(0.6), tiles)]);
        let wall = cuboid(DVec3::new(length, 6.2, 0.4), 0.0).moved(0.0, 3.1, 0.0).box_mapped(0.4);
        glb.show(&format!("wall {bays}"), &[(wall.creased(0.9), wash)]);
        let slab = cuboid(DVec3::new(length, 0.3, 3.4), 0.02).moved(0.0, 0.15, 0.0);
        glb.show(&format!("gallery floor {bays}"), &[(box_stone(slab).creased(0.9), stone)]);
    }
    glb.show("stairs", &[(box_stone(stairs(5, 0.16, 0.34, 3.2)).creased(0.9), stone)]);
    glb.show("step", &[(box_stone(cuboid(DVec3::new(BAY * 2.0, 0.15, 0.4), 0.015).moved(0.0, 0.075, 0.0)).creased(0.9), stone)]);
    glb.show(
        "terrace",
        &[(cuboid(DVec3::new(4.6, 0.8, 4.0), 0.03).moved(0.0, 0.4, 0.0).box_mapped(1.0 / 1.6).creased(0.9), courses)],
    );
    glb.show("amphitheatre", &[(amphitheatre().creased(0.9), stone)]);
    glb.finish()
}
