//! Toys for the two scenes after Kilgard's demos: solids to tumble before a wall, a flat rosette, the
//! letters of a greeting, and the studio they hang in.

use glam::{DVec2, DVec3};

use super::glb::{Glb, Look};
use super::math::{about, turn};
use super::polygon::{arc, stroke, triangulate};
use super::solids::CREASE;
use super::soup::{Soup, cuboid, lathe, sphere, tube};

type Figure = (Vec<DVec2>, Vec<Vec<DVec2>>);

fn v(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

fn points(list: &[(f64, f64)]) -> Vec<DVec2> {
    list.iter().copied().map(DVec2::from).collect()
}

fn area(line: &[DVec2]) -> f64 {
    (0..line.len()).map(|i| line[i].perp_dot(line[(i + 1) % line.len()])).sum::<f64>() / 2.0
}

/// The outline counter-clockwise, its holes clockwise: the figure is on the left of each.
fn ordered((outline, holes): Figure) -> Vec<Vec<DVec2>> {
    let turned = |mut line: Vec<DVec2>, counter_clockwise: bool| {
        if (area(&line) > 0.0) != counter_clockwise {
            line.reverse();
        }
        line
    };
    std::iter::once(turned(outline, true)).chain(holes.into_iter().map(|hole| turned(hole, false))).collect()
}

/// The line moved to its left by `by` metres, corners mitred.
fn inset(line: &[DVec2], by: f64) -> Vec<DVec2> {
    let n = line.len();
    (0..n)
        .map(|i| {
            let (a, p, b) = (line[(i + n - 1) % n], line[i], line[(i + 1) % n]);
            let (before, after) = ((p - a).normalize().perp(), (b - p).normalize().perp());
            p + (before + after) * (by / (1.0 + before.dot(after)))
        })
        .collect()
}

/// A slab between z = -depth/2 and z = depth/2 with its edges cut at 45 degrees by `bevel` metres.
fn bevelled(figure: Figure, depth: f64, bevel: f64) -> Soup {
    let lines = ordered(figure);
    let inner: Vec<_> = lines.iter().map(|line| inset(line, bevel)).collect();
    let face: Vec<DVec2> = inner.concat();
    let (high, low) = (depth / 2.0, depth / 2.0 - bevel);
    let mut soup = Soup::default();
    for [a, b, c] in triangulate(&inner[0], &inner[1..]).map_points(&face) {
        soup.triangle([a.extend(high), b.extend(high), c.extend(high)], [a, b, c]);
        soup.triangle([a.extend(-high), c.extend(-high), b.extend(-high)], [a, c, b]);
    }
    for (line, inner) in lines.iter().zip(&inner) {
        for i in 0..line.len() {
            let j = (i + 1) % line.len();
            let (a, b, c, d) = (line[i], line[j], inner[i], inner[j]);
            soup.quad([a.extend(-low), b.extend(-low), b.extend(low), a.extend(low)], [a, b, b, a]);
            soup.quad([a.extend(low), b.extend(low), d.extend(high), c.extend(high)], [a, b, d, c]);
            soup.quad([c.extend(-high), d.extend(-high), b.extend(-low), a.extend(-low)], [c, d, b, a]);
        }
    }
    soup
}

/// Triangles of indices as triangles of points.
trait MapPoints {
    fn map_points(self, points: &[DVec2]) -> Vec<[DVec2; 3]>;
}

impl MapPoints for Vec<[usize; 3]> {
    fn map_points(self, points: &[DVec2]) -> Vec<[DVec2; 3]> {
        self.into_iter().map(|triangle| triangle.map(|i| points[i])).collect()
    }
}

/// The figure itself, without thickness, facing +Z.
fn flat(figure: Figure) -> Soup {
    let lines = ordered(figure);
    let face = lines.concat();
    let mut soup = Soup::default();
    for [a, b, c] in triangulate(&lines[0], &lines[1..]).map_points(&face) {
        soup.triangle([a.extend(0.0), b.extend(0.0), c.extend(0.0)], [a, b, c]);
    }
    soup
}

/// A smooth closed curve through these points (Catmull and Rom's), `pieces` between any two.
fn smooth(through: &[(f64, f64)], pieces: usize) -> Vec<DVec2> {
    let p = points(through);
    let n = p.len();
    (0..n)
        .flat_map(|i| {
            let [a, b, c, d] = [p[(i + n - 1) % n], p[i], p[(i + 1) % n], p[(i + 2) % n]];
            (0..pieces).map(move |k| {
                let t = k as f64 / pieces as f64;
                let (tt, ttt) = (t * t, t * t * t);
                (b * 2.0 + (c - a) * t + (a * 2.0 - b * 5.0 + c * 4.0 - d) * tt + (b * 3.0 - a - c * 3.0 + d) * ttt) / 2.0
            })
        })
        .collect()
}

/// A long-necked dinosaur sawn from wood: body, four legs, plates along the back, eyes. About its
/// middle, nose towards +X, two metres and a half long.
fn dinosaur() -> [Soup; 3] {
    let body = smooth(
        &[
            (-1.95, 0.66),
            (-1.92, 0.57),
            (-1.38, 0.40),
            (-0.80, 0.32),
            (-0.30, 0.22),
            (0.20, 0.22),
            (0.55, 0.36),
            (0.82, 0.66),
            (0.96, 1.02),
            (1.08, 1.32),
            (1.32, 1.40),
            (1.62, 1.40),
            (1.72, 1.50),
            (1.60, 1.62),
            (1.34, 1.76),
            (1.06, 1.76),
            (0.88, 1.58),
            (0.76, 1.26),
            (0.58, 0.98),
            (0.30, 0.90),
            (-0.10, 0.96),
            (-0.52, 0.86),
            (-0.92, 0.64),
            (-1.42, 0.58),
        ],
        4,
    );
    let wood = |figure: Vec<DVec2>, depth: f64, bevel: f64| bevelled((figure, Vec::new()), depth, bevel);
    let mut soup = wood(body, 0.40, 0.03);
    for (x, z) in [(-0.52, -0.25), (-0.52, 0.25), (0.32, -0.25), (0.32, 0.25)] {
        let lean = 0.05 * if z < 0.0 { 1.0 } else { -1.0 };
        let leg =
            [(-0.17, 0.0), (0.19, 0.0), (0.19, 0.07), (0.14, 0.11), (0.15, 0.40), (0.10, 0.60), (-0.12, 0.60), (-0.16, 0.40)];
        let leg = leg.map(|(dx, y)| (x + dx + lean * (0.6 - y) * 2.0, y - 0.16));
        soup = soup.and(wood(points(&leg), 0.20, 0.045).moved(0.0, 0.0, z));
    }
    let mut plates = Soup::default();
    for (x, y, tilt, size) in [
        (0.62, 1.06, -34.0, 0.75),
        (0.27, 0.90, -9.0, 1.0),
        (-0.13, 0.93, 4.0, 1.15),
        (-0.54, 0.83, 24.0, 1.0),
        (-0.93, 0.62, 20.0, 0.75),
    ] {
        let leaf =
            points(&[(-0.15, -0.10), (0.15, -0.10), (0.19, 0.10), (0.11, 0.24), (0.0, 0.34), (-0.11, 0.24), (-0.19, 0.10)]);
        let turn = about(DVec3::Z, tilt);
        let plate = wood(leaf, 0.12, 0.035).map(|p| turn * (p * DVec3::new(size, size, 1.0)) + DVec3::new(x, y, 0.0));
        plates = plates.and(plate);
    }
    let eye = |z: f64| sphere(0.055, 16, 8).moved(1.28, 1.61, z);
    let eyes = eye(0.2).and(eye(-0.2));
    [soup, plates, eyes].map(|part| part.moved(0.05, -0.82, 0.0).map(|p| p * 0.7))
}

/// About z, 1.3 metres wide.
fn torus() -> Soup {
    let path: Vec<DVec3> = (0..64).map(|i| (turn(f64::from(i) / 64.0) * 0.45).extend(0.0)).collect();
    tube(&path, 24, |_| 0.19)
}

/// Six arms with a ball each, as children throw them.
fn jack() -> Soup {
    let mut profile = vec![v(0.0, -0.62)];
    let ball = |y: f64| arc(v(0.0, y), DVec2::splat(0.13), -0.22, 0.20, 8);
    profile.extend(ball(-0.50));
    profile.extend(points(&[(0.055, -0.30), (0.075, 0.0), (0.055, 0.30)]));
    profile.extend(ball(0.50).into_iter().skip(1));
    profile.push(v(0.0, 0.63));
    profile[0] = v(0.0, -0.63);
    let bar = lathe(&profile, 20, |p, _| p.x);
    let aside = bar.clone().map(|p| DVec3::new(p.y, -p.x, p.z));
    let ahead = bar.clone().map(|p| DVec3::new(p.x, -p.z, p.y));
    bar.and(aside).and(ahead)
}

fn star(rays: usize, outer: f64, inner: f64) -> Vec<DVec2> {
    (0..rays * 2).map(|i| turn(0.25 + i as f64 / (rays * 2) as f64) * if i % 2 == 0 { outer } else { inner }).collect()
}

/// A toothed wheel with windows.
fn gear() -> Figure {
    let mut outline = Vec::new();
    for tooth in 0..14 {
        for (share, radius) in [(0.05, 0.52), (0.20, 0.64), (0.46, 0.64), (0.61, 0.52)] {
            outline.push(turn((f64::from(tooth) + share) / 14.0) * radius);
        }
    }
    let mut holes = vec![arc(DVec2::ZERO, DVec2::splat(0.11), 0.0, 1.0 - 1.0 / 20.0, 19)];
    for window in 0..5 {
        let at = |turns: f64| (f64::from(window) + turns) / 5.0;
        let mut hole = arc(DVec2::ZERO, DVec2::splat(0.40), at(0.13), at(0.87), 8);
        hole.extend(arc(DVec2::ZERO, DVec2::splat(0.21), at(0.78), at(0.22), 5));
        holes.push(hole);
    }
    (outline, holes)
}

/// A round window's tracery, 2 metres wide: petals, drops between them, an eye in the middle.
fn rosette() -> Figure {
    let rim = arc(DVec2::ZERO, DVec2::splat(1.0), 0.0, 1.0 - 1.0 / 72.0, 71);
    let mut holes = vec![star(8, 0.17, 0.105)];
    for i in 0..8 {
        let towards = turn(f64::from(i) / 8.0);
        let petal = |along: f64, aside: f64| towards * along + towards.perp() * aside;
        let mut hole = vec![petal(0.24, 0.0), petal(0.36, -0.075)];
        let head: Vec<DVec2> = arc(v(0.53, 0.0), v(0.10, 0.125), -0.25, 0.25, 8);
        hole.extend(head.iter().map(|p| petal(p.x, p.y)));
        hole.push(petal(0.36, 0.075));
        holes.push(hole);
        let between = turn((f64::from(i) + 0.5) / 8.0);
        let drop = |along: f64, aside: f64| between * along + between.perp() * aside;
        let mut hole = vec![drop(0.50, 0.0), drop(0.62, -0.055)];
        hole.extend(arc(v(0.74, 0.0), v(0.11, 0.115), -0.25, 0.25, 8).iter().map(|p| drop(p.x, p.y)));
        hole.push(drop(0.62, 0.055));
        holes.push(hole);
        // Small lights along the rim, over the petals.
        let eye = towards * 0.80;
        holes.push(arc(eye, DVec2::splat(0.075), 0.0, 1.0 - 1.0 / 14.0, 13));
    }
    (rim, holes)
}

/// A letter or digit one metre high, from y = 0, about x = 0.
fn glyph(which: char) -> Figure {
    let w = 0.19; // of a stroke
    let solid = |list: &[(f64, f64)]| (points(list), Vec::new());
    match which {
        'H' => {
            let (x, y) = (0.36, w / 2.0);
            let i = x - w;
            solid(&[
                (-x, 0.0),
                (-i, 0.0),
                (-i, 0.5 - y),
                (i, 0.5 - y),
                (i, 0.0),
                (x, 0.0),
                (x, 1.0),
                (i, 1.0),
                (i, 0.5 + y),
                (-i, 0.5 + y),
                (-i, 1.0),
                (-x, 1.0),
            ])
        }
        'E' => {
            let (l, r, y) = (-0.31, 0.31, w / 2.0);
            solid(&[
                (l, 0.0),
                (r, 0.0),
                (r, w),
                (l + w, w),
                (l + w, 0.5 - y),
                (r - 0.07, 0.5 - y),
                (r - 0.07, 0.5 + y),
                (l + w, 0.5 + y),
                (l + w, 1.0 - w),
                (r, 1.0 - w),
                (r, 1.0),
                (l, 1.0),
            ])
        }
        'L' => solid(&[(-0.30, 0.0), (0.30, 0.0), (0.30, w), (-0.30 + w, w), (-0.30 + w, 1.0), (-0.30, 1.0)]),
        'T' => {
            let (x, s) = (0.36, w / 2.0);
            solid(&[(-s, 0.0), (s, 0.0), (s, 1.0 - w), (x, 1.0 - w), (x, 1.0), (-x, 1.0), (-x, 1.0 - w), (-s, 1.0 - w)])
        }
        'O' => {
            let ring = |x: f64, y: f64, pieces: usize| arc(v(0.0, 0.5), v(x, y), 0.0, 1.0 - 1.0 / pieces as f64, pieces - 1);
            (ring(0.43, 0.515, 40), vec![ring(0.43 - w, 0.515 - w, 32)])
        }
        'R' => {
            let (l, bowl, middle) = (-0.32, 0.29, 0.71);
            let mut outline =
                points(&[(l, 0.0), (l + w, 0.0), (l + w, 0.42), (l + w + 0.04, 0.42), (0.13, 0.0), (0.36, 0.0), (0.17, 0.455)]);
            outline.extend(arc(v(0.02, middle), v(0.30, bowl), -0.16, 0.25, 12));
            outline.push(v(l, 1.0));
            let mut hole = points(&[(l + w, 0.42 + w)]);
            hole.extend(arc(v(0.0, middle), v(0.13, bowl - w), -0.25, 0.25, 8));
            hole.push(v(l + w, 1.0 - w));
            (outline, vec![hole])
        }
        'S' => {
            let (r, q) = (0.26, 0.25 - w / 4.0);
            let mut line = arc(v(0.0, 1.0 - w / 2.0 - q), v(r, q), 0.06, 0.75, 14);
            line.extend(arc(v(0.0, w / 2.0 + q), v(r, q), 0.25, -0.44, 14).into_iter().skip(1));
            (stroke(&line, w), Vec::new())
        }
        _ => {
            // 2
            let mut line = arc(v(0.0, 0.68), v(0.25, 0.225), 0.46, -0.08, 14);
            line.extend(points(&[
                (0.13, 0.46),
                (-0.10, 0.235),
                (-0.175, 0.145),
                (-0.165, 0.105),
                (-0.11, w / 2.0),
                (0.33, w / 2.0),
            ]));
            (stroke(&line, w), Vec::new())
        }
    }
}

/// A seamless backdrop, as in a photographer's studio: the floor runs up into the wall in a wide
/// curve. The wall is at z = 0, the floor at y = 0, towards +Z.
fn backdrop() -> Soup {
    let mut profile = vec![v(12.0, 0.0), v(6.0, 0.0)];
    profile.extend(arc(v(1.6, 1.6), DVec2::splat(1.6), 0.75, 0.5, 20));
    profile.extend(points(&[(0.0, 4.0), (0.0, 9.0)]));
    let half = 16.0;
    let mut soup = Soup::default();
    for pair in profile.windows(2) {
        let at = |p: DVec2, x: f64| DVec3::new(x, p.y, p.x);
        let (a, b) = (pair[0], pair[1]);
        soup.quad([at(a, -half), at(a, half), at(b, half), at(b, -half)], [DVec2::ZERO; 4]);
    }
    soup
}

/// All of it.
pub fn file() -> Vec<u8> {
    let mut glb = Glb::default();
    let paint = glb.material(&Look { name: "toy paint", color: [0.8; 3], roughness: 0.35, ..Look::default() });
    let second = glb.material(&Look { name: "second paint", color: [0.85, 0.42, 0.10], roughness: 0.4, ..Look::default() });
    let eye = glb.material(&Look { name: "eye", color: [0.02; 3], roughness: 0.2, ..Look::default() });
    let sheet = glb.material(&Look { name: "sheet", roughness: 0.5, double_sided: true, ..Look::default() });
    let wall = glb.material(&Look { name: "backdrop", color: [0.76, 0.745, 0.71], roughness: 0.95, ..Look::default() });
    let [body, plates, eyes] = dinosaur();
    glb.show("dinosaur", &[(body.creased(0.9), paint), (plates.creased(0.9), second), (eyes.creased(CREASE), eye)]);
    glb.show("torus", &[(torus().creased(CREASE), paint)]);
    glb.show("jack", &[(jack().creased(CREASE), paint)]);
    glb.show("star", &[(bevelled((star(5, 0.75, 0.33), Vec::new()), 0.26, 0.08).creased(0.9), paint)]);
    glb.show("gear", &[(bevelled(gear(), 0.22, 0.03).creased(0.9), paint)]);
    glb.show("rosette", &[(flat(rosette()).creased(CREASE), sheet)]);
    for which in "HELO2RTS".chars() {
        glb.show(&format!("letter {which}"), &[(bevelled(glyph(which), 0.26, 0.035).creased(0.9), paint)]);
    }
    for (name, width, depth) in [("wide step", 5.6, 1.6), ("step", 4.6, 0.95)] {
        glb.show(name, &[(cuboid(DVec3::new(width, 0.2, depth), 0.025).moved(0.0, 0.1, 0.0).creased(0.95), paint)]);
    }
    glb.show_without_shadow("backdrop", &[(backdrop().creased(0.3), wall)]);
    glb.finish()
}
