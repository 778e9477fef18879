//! A Gothic nave: piers, pointed arches, triforium, vaults, windows (McGuire et al. 2003, images 1
//! to 7 show one like it).
//!
//! The nave runs along z. One bay of each part, to be set side by side every [`BAY`] metres; its
//! parts stand about the nave's wall line, x = 0 here, the nave's side towards -x.

use glam::{DVec2, DVec3};

use super::glb::{Glb, Look};
use super::math::turn;
use super::polygon::{arc, extruded};
use super::solids::CREASE;
use super::soup::{Soup, cuboid, lathe, turned};
use super::stained_glass::{lancet, lancet_frame, lancet_panes, rose_panes};
use super::texture;

/// From pier to pier.
const BAY: f64 = 4.0;
/// Where the arcade's arches spring: the piers' height.
const SPRING: f64 = 3.8;
/// Height and thickness of the nave's walls.
const WALL: f64 = 11.6;
const THICK: f64 = 0.6;

fn bezel(list: &[(f64, f64)]) -> Vec<DVec2> {
    list.iter().copied().map(DVec2::from).collect()
}

/// Four half-round shafts about a core, on an eight-sided foot, with a capital; a slender shaft
/// goes on up the nave's side to where the vault springs.
fn pier() -> Soup {
    let core = bezel(&[
        (0.0, 0.30),
        (0.54, 0.30),
        (0.52, 0.38),
        (0.44, 0.44),
        (0.44, 3.18),
        (0.50, 3.22),
        (0.50, 3.28),
        (0.45, 3.32),
        (0.47, 3.44),
        (0.62, 3.62),
        (0.0, 3.62),
    ]);
    let core = lathe(&core, 16, |p, turns| {
        let shaft = (0.44..=3.32).contains(&p.y);
        let lobe = turn(turns * 4.0).x;
        if shaft { p.x * (0.92 + 0.13 * lobe) } else { p.x * (0.97 + 0.05 * lobe) }
    });
    let foot = lathe(&bezel(&[(0.0, 0.0), (0.70, 0.0), (0.70, 0.16), (0.62, 0.22), (0.62, 0.30), (0.0, 0.30)]), 8, |p, _| p.x)
        .map(|p| DVec3::new(p.x * 1.03, p.y, p.z * 1.03));
    let abacus = cuboid(DVec3::new(1.0, SPRING - 3.62, 1.0), 0.03).moved(0.0, (SPRING + 3.62) / 2.0, 0.0);
    let respond = turned(
        &[
            (0.0, 3.7),
            (0.12, 3.7),
            (0.15, 3.78),
            (0.11, 3.9),
            (0.11, 6.9),
            (0.13, 6.95),
            (0.13, 7.0),
            (0.2, 7.2),
            (0.2, 7.3),
            (0.0, 7.3),
        ],
        10,
    );
    core.and(foot).and(abacus).and(respond.moved(-THICK / 2.0 - 0.03, 0.0, 0.0))
}

/// A bay of the nave's wall: a pointed arch below, a pair of openings above; seen from -x.
fn wall() -> (Soup, Soup) {
    let half = BAY / 2.0;
    let opening = 1.52; // half the arch's width
    let mut outline = vec![DVec2::new(-half, SPRING), DVec2::new(-opening, SPRING)];
    let arch = |grow: f64, tip: f64| {
        let radius = DVec2::splat(2.0 * opening + grow);
        let mut points = arc(DVec2::new(opening, SPRING), radius, 0.5, 1.0 / 3.0 + tip, 7);
        points.push(DVec2::new(0.0, SPRING + (radius.x * radius.x - opening * opening).sqrt()));
        points.extend(arc(DVec2::new(-opening, SPRING), radius, 1.0 / 6.0 - tip, 0.0, 7));
        points
    };
    outline.extend(arch(0.0, 0.004));
    outline.extend([(half, SPRING), (half, WALL), (-half, WALL)].map(DVec2::from));
    let holes: Vec<Vec<DVec2>> =
        [-0.62, 0.62].map(|z| lancet(0.38, 0.62, 4).into_iter().map(|p| p + DVec2::new(z, 7.35)).collect()).to_vec();
    // Drawn in x and y; turned so that x runs along z.
    let turned = |soup: Soup| soup.map(|p| DVec3::new(-p.z, p.y, p.x));
    let wall = turned(extruded(&outline, &holes, THICK));
    // The arch's moulding, proud on both sides, and two courses.
    let mut ring = arch(-0.02, 0.004);
    let mut outer = arch(0.20, 0.004);
    outer.reverse();
    ring.extend(outer);
    let mut trim = turned(extruded(&ring, &[], THICK + 0.14));
    for y in [7.05, 8.75] {
        trim = trim.and(cuboid(DVec3::new(THICK + 0.16, 0.14, BAY), 0.0).moved(0.0, y, 0.0));
    }
    (wall, trim)
}

/// Height of a pointed arch, 1 at the middle (`u` = 0), 0 at its springing (`u` = 1).
fn pointed(u: f64) -> f64 {
    const RADIUS: f64 = 1.6;
    let along = u.abs() + RADIUS - 1.0;
    ((RADIUS * RADIUS - along * along).max(0.0) / (2.0 * RADIUS - 1.0)).sqrt()
}

/// A groin vault over -1..1 in x and z, 1 high, seen from below: two pointed tunnels, the higher of both.
fn webs(pieces: i32) -> Soup {
    let mut soup = Soup::default();
    let u = |k: i32| f64::from(k) / f64::from(pieces);
    for k in -pieces..pieces {
        let (a, b) = (u(k), u(k + 1));
        // Straight lines from the wall's edge to the groin, one strip between two of them.
        let strip = |side: f64, along_x: bool| {
            let at = |across: f64, t: f64| {
                let y = pointed(t);
                if along_x { DVec3::new(across, y, t) } else { DVec3::new(t, y, across) }
            };
            [at(side, a), at(side, b), at(side * b.abs(), b), at(side * a.abs(), a)]
        };
        for along_x in [true, false] {
            for side in [-1.0, 1.0] {
                let mut quad = strip(side, along_x);
                if (side > 0.0) != along_x {
                    quad.reverse();
                }
                soup.quad(quad, [DVec2::ZERO; 4]);
            }
        }
    }
    soup
}

/// A beam along a curve: `across` is its horizontal direction, its lower face hangs `deep` below.
fn rib(path: &[DVec3], across: DVec3, width: f64, deep: f64) -> Soup {
    let mut soup = Soup::default();
    let side = across * (width / 2.0);
    let low = |p: DVec3, s: f64| p + side * s * 0.55 - DVec3::Y * deep;
    for pair in path.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let bottom = [low(a, -1.0), low(a, 1.0), low(b, 1.0), low(b, -1.0)];
        let left = [a - side, low(a, -1.0), low(b, -1.0), b - side];
        let right = [low(a, 1.0), a + side, b + side, low(b, 1.0)];
        for face in [bottom, left, right] {
            soup.quad(face, [DVec2::ZERO; 4]);
        }
    }
    // It hangs: its faces look down and sideways.
    for t in soup.0.chunks_exact_mut(3) {
        let (n, middle) = ((t[1].p - t[0].p).cross(t[2].p - t[0].p), (t[0].p + t[1].p + t[2].p) / 3.0);
        let nearest = path.iter().min_by(|a, b| a.distance(middle).total_cmp(&b.distance(middle))).copied().unwrap_or_default();
        if n.dot(middle - nearest) < 0.0 {
            t.swap(1, 2);
        }
    }
    soup
}

/// The nave's vault over one bay, `half` wide, `rise` high, with ribs.
fn vault(half: f64, rise: f64) -> (Soup, Soup) {
    let scale = DVec3::new(half, rise, BAY / 2.0);
    let webs = webs(6).map(|p| p * scale);
    let curve = |f: &dyn Fn(f64) -> DVec3| -> Vec<DVec3> { (-6..=6).map(|k| f(f64::from(k) / 6.0) * scale).collect() };
    let mut ribs = Soup::default();
    for side in [-1.0, 1.0] {
        let path = curve(&|t| DVec3::new(t, pointed(t), t * side));
        let across = DVec3::new(-side * scale.z, 0.0, scale.x).normalize();
        ribs = ribs.and(rib(&path, across, 0.20, 0.16));
    }
    let transverse = curve(&|t| DVec3::new(t, pointed(t), -1.0));
    (webs, ribs.and(rib(&transverse, DVec3::Z, 0.44, 0.26)))
}

/// A flat pier against the aisle's outer wall, and the stone bench along it; seen from -x.
fn pilaster() -> Soup {
    let pilaster = cuboid(DVec3::new(0.34, SPRING - 0.2, 0.7), 0.0).moved(-0.1, (SPRING - 0.2) / 2.0, BAY / 2.0);
    let cap = cuboid(DVec3::new(0.5, 0.2, 0.9), 0.03).moved(-0.1, SPRING - 0.1, BAY / 2.0);
    let bench = cuboid(DVec3::new(0.4, 0.45, BAY - 0.7), 0.02).moved(-0.19, 0.225, 0.0);
    pilaster.and(cap).and(bench)
}

fn altar() -> Soup {
    cuboid(DVec3::new(2.4, 0.16, 1.2), 0.02)
        .moved(0.0, 0.08, 0.0)
        .and(cuboid(DVec3::new(1.9, 0.80, 0.72), 0.02).moved(0.0, 0.56, 0.0))
        .and(cuboid(DVec3::new(2.2, 0.12, 0.95), 0.03).moved(0.0, 1.02, 0.0))
}

fn candlestick() -> Soup {
    turned(
        &[
            (0.0, 0.0),
            (0.17, 0.0),
            (0.17, 0.04),
            (0.06, 0.10),
            (0.035, 0.18),
            (0.055, 0.5),
            (0.03, 0.58),
            (0.03, 1.0),
            (0.11, 1.08),
            (0.11, 1.11),
            (0.035, 1.11),
            (0.035, 1.42),
            (0.0, 1.42),
        ],
        12,
    )
}

/// A hoop with a cross of four arms that carries a light at the origin, and three chains up to a
/// hook at y = 6: its shadow is a great wheel.
fn corona() -> Soup {
    const HOOK: f64 = 6.0;
    let (radius, low) = (0.52, -0.40);
    let hoop = turned(
        &[
            (radius - 0.02, low),
            (radius + 0.02, low),
            (radius + 0.02, low + 0.035),
            (radius - 0.02, low + 0.035),
            (radius - 0.02, low),
        ],
        24,
    );
    let arm = |x: f64, z: f64| cuboid(DVec3::new(x, 0.022, z), 0.0);
    let reach = 2.0 * radius - 0.03;
    let cup = turned(&[(0.0, -0.45), (0.02, -0.44), (0.03, -0.40), (0.03, -0.36), (0.0, -0.36)], 8);
    let mut soup =
        hoop.and(arm(reach, 0.022).moved(0.0, low + 0.018, 0.0)).and(arm(0.022, reach).moved(0.0, low + 0.018, 0.0)).and(cup);
    for i in 0..3 {
        let d = turn(f64::from(i) / 3.0 + 0.05) * radius;
        // A thin rod, sheared so that it leans to the hook.
        let length = HOOK - low;
        let rod = cuboid(DVec3::new(0.014, length, 0.014), 0.0).map(|p| {
            let up = p.y / length + 0.5;
            DVec3::new(p.x + d.x * (1.0 - up * 0.98), p.y + length / 2.0 + low + 0.03, p.z + d.y * (1.0 - up * 0.98))
        });
        soup = soup.and(rod);
    }
    soup
}

/// One bay of everything, the east end, and what stands in the choir.
pub fn file() -> Vec<u8> {
    let mut glb = Glb::default();
    let blocks = glb.texture("sandstone", &texture::sandstone());
    let mosaic = glb.texture("mosaic", &texture::mosaic());
    let masonry = glb.material(&Look { name: "masonry", color: [0.98, 0.90, 0.78], texture: Some(blocks), ..Look::default() });
    let dressed = glb.material(&Look { name: "dressed stone", color: [0.66, 0.58, 0.47], roughness: 0.85, ..Look::default() });
    let render = glb.material(&Look { name: "limewash", color: [0.62, 0.55, 0.46], roughness: 0.95, ..Look::default() });
    let floor =
        glb.material(&Look { name: "mosaic", color: [1.0; 3], roughness: 0.45, texture: Some(mosaic), ..Look::default() });
    let glass = glb.material(&Look { name: "glass", color: [1.0; 3], double_sided: true, ..Look::default() });
    let brass =
        glb.material(&Look { name: "brass", color: [0.70, 0.48, 0.18], roughness: 0.35, metallic: 0.4, ..Look::default() });
    let courses = |soup: Soup| soup.box_mapped(1.0 / 2.4).creased(0.9);

    glb.show("pier", &[(pier().creased(0.8), dressed)]);
    let (bay, trim) = wall();
    glb.show("nave wall", &[(courses(bay), masonry), (trim.creased(0.9), dressed)]);
    // What nothing lies behind need not cast.
    let outside = cuboid(DVec3::new(0.4, WALL, BAY), 0.0).moved(0.2, WALL / 2.0, 0.0);
    glb.show_without_shadow("aisle wall", &[(courses(outside), masonry)]);
    glb.show("pilaster", &[(courses(pilaster()), masonry)]);
    let (web, ribs) = vault(3.3, 4.2);
    glb.show_without_shadow("nave vault", &[(web.creased(CREASE), render), (ribs.creased(0.8), dressed)]);
    let web = webs(4).map(|p| p * DVec3::new(1.35, 2.5, BAY / 2.0));
    glb.show_without_shadow("aisle vault", &[(web.creased(CREASE), render)]);

    for (name, seed) in [("tall glass", 150), ("tall glass 2", 160)] {
        glb.show_without_shadow(name, &[(lancet_panes(0.62, 1.9, 3, 7, seed).creased(CREASE), glass)]);
    }
    glb.show_without_shadow("small glass", &[(lancet_panes(0.60, 0.75, 3, 4, 170).creased(CREASE), glass)]);
    glb.show("tall frame", &[(lancet_frame(0.62, 1.9, 0.16, 0.14, false).creased(0.9), dressed)]);
    glb.show("small frame", &[(lancet_frame(0.60, 0.75, 0.14, 0.12, false).creased(0.9), dressed)]);
    glb.show_without_shadow("rose glass", &[(rose_panes(2.1).creased(CREASE), glass)]);
    let circle = |r: f64, n: usize| arc(DVec2::ZERO, DVec2::splat(r), 0.0, 1.0 - 1.0 / n as f64, n - 1);
    let ring = extruded(&circle(2.42, 32), &[circle(2.08, 32)], 0.3).moved(0.0, 0.0, 0.15);
    glb.show("rose frame", &[(ring.creased(0.9), dressed)]);

    let mut square = Soup::default();
    let corners = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
    square.quad(
        corners.map(|(x, z)| DVec3::new(x * 7.0, 0.0, z * 14.0)),
        corners.map(|(x, z)| DVec2::new(x * 7.0, z * 14.0) / 2.2),
    );
    glb.show_without_shadow("pavement", &[(square.creased(CREASE), floor)]);
    glb.show_without_shadow("end wall", &[(courses(cuboid(DVec3::new(14.0, 12.4, 0.6), 0.0).moved(0.0, 6.2, 0.0)), masonry)]);
    let mut steps = Soup::default();
    for k in 0..6 {
        let depth = 0.34 * f64::from(6 - k);
        steps = steps.and(cuboid(DVec3::new(6.5, 0.16, depth), 0.0).moved(0.0, 0.16 * (f64::from(k) + 0.5), depth / 2.0));
    }
    glb.show("choir steps", &[(steps.creased(0.9), dressed)]);
    let choir = cuboid(DVec3::new(6.5, 0.96, 7.2), 0.0).moved(0.0, 0.48, -3.6);
    glb.show("choir", &[(courses(choir), masonry)]);
    glb.show("altar", &[(altar().creased(0.9), dressed)]);
    glb.show("corona", &[(corona().creased(0.8), brass)]);
    glb.show("candlestick", &[(candlestick().creased(0.8), brass)]);
    glb.finish()
}
