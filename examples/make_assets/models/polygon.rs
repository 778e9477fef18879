//! Flat polygons with holes: strokes, ear clipping, extrusion.

use glam::{DVec2, DVec3};

use super::math::turn;
use super::soup::Soup;

/// Points along an arc about `centre`, angles in turns.
pub fn arc(centre: DVec2, radius: DVec2, from: f64, to: f64, pieces: usize) -> Vec<DVec2> {
    (0..=pieces).map(|i| centre + turn(from + (to - from) * i as f64 / pieces as f64) * radius).collect()
}

/// The outline, counter-clockwise, of a stroke of the given width along an open line.
pub fn stroke(line: &[DVec2], width: f64) -> Vec<DVec2> {
    let n = line.len();
    let side = |sign: f64| -> Vec<DVec2> {
        (0..n)
            .map(|i| {
                let before = (line[i] - line[i.max(1) - 1]).normalize_or_zero();
                let after = (line[(i + 1).min(n - 1)] - line[i]).normalize_or_zero();
                let (a, b) = (before.perp(), after.perp());
                let mitre = if i == 0 {
                    b
                } else if i == n - 1 {
                    a
                } else {
                    (a + b) / (1.0 + a.dot(b))
                };
                line[i] + mitre * sign * width / 2.0
            })
            .collect()
    };
    let mut outline = side(-1.0);
    outline.extend(side(1.0).into_iter().rev());
    outline
}

fn cross(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

fn area(outline: &[DVec2]) -> f64 {
    (0..outline.len()).map(|i| outline[i].perp_dot(outline[(i + 1) % outline.len()])).sum::<f64>() / 2.0
}

fn inside(p: DVec2, t: [DVec2; 3], margin: f64) -> bool {
    cross(t[0], t[1], p) >= margin && cross(t[1], t[2], p) >= margin && cross(t[2], t[0], p) >= margin
}

/// Triangles of a counter-clockwise outline less its clockwise holes, as indices into all points
/// in order. Holes are first tied to the outline by a two-way bridge, rightmost hole first, then
/// ears are cut off (Eberly, "Triangulation by Ear Clipping").
pub fn triangulate(outline: &[DVec2], holes: &[Vec<DVec2>]) -> Vec<[usize; 3]> {
    let mut points = outline.to_vec();
    let mut ring: Vec<usize> = (0..outline.len()).collect();
    let mut rings: Vec<Vec<usize>> = Vec::new();
    for hole in holes {
        rings.push((points.len()..points.len() + hole.len()).collect());
        points.extend(hole);
    }
    let rightmost = |ring: &Vec<usize>| ring.iter().copied().max_by(|&a, &b| points[a].x.total_cmp(&points[b].x)).unwrap_or(0);
    rings.sort_by(|a, b| points[rightmost(b)].x.total_cmp(&points[rightmost(a)].x));
    for hole in &rings {
        let start = rightmost(hole);
        let at = hole.iter().position(|&i| i == start).unwrap_or(0);
        // The nearest ring vertex that sees the hole's vertex: no ring edge crosses the bridge.
        let p = points[start];
        let crosses = |a: DVec2, b: DVec2, c: DVec2, d: DVec2| {
            a != c
                && a != d
                && b != c
                && b != d
                && cross(a, b, c) * cross(a, b, d) <= 0.0
                && cross(c, d, a) * cross(c, d, b) <= 0.0
        };
        let sees = |k: usize| {
            let q = points[ring[k]];
            let (previous, next) = (points[ring[(k + ring.len() - 1) % ring.len()]], points[ring[(k + 1) % ring.len()]]);
            let within = if cross(previous, q, next) >= 0.0 {
                cross(previous, q, p) > 0.0 && cross(q, next, p) > 0.0
            } else {
                cross(previous, q, p) > 0.0 || cross(q, next, p) > 0.0
            };
            let blocked =
                |ring: &[usize]| (0..ring.len()).any(|i| crosses(p, q, points[ring[i]], points[ring[(i + 1) % ring.len()]]));
            within && !blocked(&ring) && !rings.iter().any(|other| blocked(other))
        };
        let best = (0..ring.len())
            .filter(|&k| sees(k))
            .min_by(|&a, &b| points[ring[a]].distance(p).total_cmp(&points[ring[b]].distance(p)));
        let Some(k) = best else { continue };
        let mut bridged = ring[..=k].to_vec();
        bridged.extend(hole[at..].iter().chain(&hole[..=at]));
        bridged.extend(&ring[k..]);
        ring = bridged;
    }
    let mut triangles = Vec::new();
    while ring.len() > 3 {
        let n = ring.len();
        // Of all ears the one with the shortest cut, for fewer slivers.
        let cut = |i: usize| points[ring[(i + n - 1) % n]].distance(points[ring[(i + 1) % n]]);
        let ear = |margin: f64| {
            (0..n)
                .filter(|&i| {
                    let t = [ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]].map(|v| points[v]);
                    cross(t[0], t[1], t[2]) > 1e-9
                        && ring.iter().all(|&v| t.contains(&points[v]) || !inside(points[v], t, margin))
                })
                .min_by(|&a, &b| cut(a).total_cmp(&cut(b)))
        };
        // A cut may touch other points only where there is no better one (the corners of stairs).
        let Some(i) = ear(0.0).or_else(|| ear(1e-9)) else { break };
        triangles.push([ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]]);
        ring.remove(i);
    }
    if let [a, b, c] = ring[..] {
        triangles.push([a, b, c]);
    }
    flip(&points, &mut triangles);
    triangles
}

/// Flips edges until the triangulation is Delaunay (Lawson): ears leave slivers, even triangles of three
/// points of one line, and no rasteriser finds the depth of what is thinner than its grid.
fn flip(points: &[DVec2], triangles: &mut [[usize; 3]]) {
    let angle = |at: usize, a: usize, b: usize| (points[a] - points[at]).angle_to(points[b] - points[at]).abs();
    // Every flip makes the smallest angle larger, so this ends; rounding is kept from going on by the margin.
    const MARGIN: f64 = 1e-6;
    let mut flipped = true;
    while flipped {
        flipped = false;
        for first in 0..triangles.len() {
            for second in 0..triangles.len() {
                for corner in 0..3 {
                    let [a, b, c] = [0, 1, 2].map(|i| triangles[first][(corner + i) % 3]);
                    let Some(other) = (0..3).find(|&i| triangles[second][i] == c && triangles[second][(i + 1) % 3] == b) else {
                        continue;
                    };
                    // The edge from b to c, with a on its left and d on its right.
                    let d = triangles[second][(other + 2) % 3];
                    let area = |a: usize, b: usize, c: usize| cross(points[a], points[b], points[c]);
                    let better = angle(a, b, c) + angle(d, b, c) > std::f64::consts::PI + MARGIN;
                    if better && area(a, b, d) > 1e-9 && area(a, d, c) > 1e-9 {
                        triangles[first] = [a, b, d];
                        triangles[second] = [a, d, c];
                        flipped = true;
                    }
                }
            }
        }
    }
}

/// A slab between z = -depth/2 and z = depth/2. Outline and holes may run either way.
pub fn extruded(outline: &[DVec2], holes: &[Vec<DVec2>], depth: f64) -> Soup {
    let turned = |line: &[DVec2], counter_clockwise: bool| {
        let mut line = line.to_vec();
        if (area(&line) > 0.0) != counter_clockwise {
            line.reverse();
        }
        line
    };
    let outline = turned(outline, true);
    let holes: Vec<_> = holes.iter().map(|hole| turned(hole, false)).collect();
    let points: Vec<DVec2> = outline.iter().chain(holes.iter().flatten()).copied().collect();
    let at = |p: DVec2, z: f64| p.extend(z * depth / 2.0);
    let mut soup = Soup::default();
    for [a, b, c] in triangulate(&outline, &holes) {
        let [a, b, c] = [points[a], points[b], points[c]];
        soup.triangle([at(a, 1.0), at(b, 1.0), at(c, 1.0)], [a, b, c]);
        soup.triangle([at(a, -1.0), at(c, -1.0), at(b, -1.0)], [a, c, b]);
    }
    for line in std::iter::once(&outline).chain(&holes) {
        for (i, &a) in line.iter().enumerate() {
            let b = line[(i + 1) % line.len()];
            soup.quad([at(a, -1.0), at(b, -1.0), at(b, 1.0), at(a, 1.0)], [a, b, b, a]);
        }
    }
    soup
}

/// As [`extruded`], but the outline's x runs along +Z and it is pulled along X: stairs, mouldings.
pub fn pulled(outline: &[DVec2], length: f64) -> Soup {
    extruded(outline, &[], length).map(|p| DVec3::new(-p.z, p.y, p.x))
}
