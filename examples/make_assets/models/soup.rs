//! Triangles on the way to a mesh: put together freely, then given normals and shared vertices.
//!
//! Corners at *exactly* the same position are one point of the surface; every maker here computes
//! shared points once, or by the same arithmetic, so that closed stays closed.

use std::collections::HashMap;

use glam::{DVec2, DVec3};

use super::math::turn;

/// One corner of a triangle.
#[derive(Debug, Clone, Copy)]
pub struct Corner {
    /// Metres.
    pub p: DVec3,
    /// Texture coordinates.
    pub uv: DVec2,
    /// Linear RGB.
    pub color: [u8; 3],
}

/// Loose triangles, three corners each, counter-clockwise seen from outside.
#[derive(Debug, Clone, Default)]
pub struct Soup(pub Vec<Corner>);

/// Vertices and indices, ready for a file.
#[derive(Debug, Clone, Default)]
pub struct Shape {
    pub positions: Vec<DVec3>,
    pub normals: Vec<DVec3>,
    pub uvs: Vec<DVec2>,
    pub colors: Vec<[u8; 3]>,
    pub indices: Vec<u32>,
}

impl Soup {
    pub fn triangle(&mut self, points: [DVec3; 3], uvs: [DVec2; 3]) {
        let [a, b, c] = points;
        if a != b && b != c && c != a {
            self.0.extend(points.iter().zip(uvs).map(|(&p, uv)| Corner { p, uv, color: [255; 3] }));
        }
    }

    pub fn quad(&mut self, points: [DVec3; 4], uvs: [DVec2; 4]) {
        self.triangle([points[0], points[1], points[2]], [uvs[0], uvs[1], uvs[2]]);
        self.triangle([points[0], points[2], points[3]], [uvs[0], uvs[2], uvs[3]]);
    }

    pub fn and(mut self, other: Self) -> Self {
        self.0.extend(other.0);
        self
    }

    pub fn map(mut self, f: impl Fn(DVec3) -> DVec3) -> Self {
        for corner in &mut self.0 {
            corner.p = f(corner.p);
        }
        self
    }

    pub fn moved(self, x: f64, y: f64, z: f64) -> Self {
        self.map(|p| p + DVec3::new(x, y, z))
    }

    /// Paints every corner by its position, linear RGB in 0..1.
    pub fn painted(mut self, f: impl Fn(DVec3) -> [f64; 3]) -> Self {
        for corner in &mut self.0 {
            corner.color = f(corner.p).map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
        }
        self
    }

    /// Texture coordinates from the axis each triangle faces most, `scale` repeats a metre.
    pub fn box_mapped(mut self, scale: f64) -> Self {
        for t in self.0.chunks_exact_mut(3) {
            let n = (t[1].p - t[0].p).cross(t[2].p - t[0].p).abs();
            for c in t {
                c.uv = scale
                    * if n.y >= n.x && n.y >= n.z {
                        DVec2::new(c.p.x, c.p.z)
                    } else if n.x >= n.z {
                        DVec2::new(c.p.z, -c.p.y)
                    } else {
                        DVec2::new(c.p.x, -c.p.y)
                    };
            }
        }
        self
    }

    /// Normals are averaged over triangles whose own normals differ by less than the angle with
    /// this cosine; across sharper edges the surface keeps its crease. (Weights: Max, "Weights for
    /// computing vertex normals from facet normals", 1999.)
    pub fn creased(self, cosine: f64) -> Shape {
        let key = |p: DVec3| [p.x + 0.0, p.y + 0.0, p.z + 0.0].map(f64::to_bits);
        let mut at: HashMap<[u64; 3], Vec<(DVec3, DVec3)>> = HashMap::new(); // (unit normal, weighted normal)
        let units: Vec<DVec3> =
            self.0.chunks_exact(3).map(|t| (t[1].p - t[0].p).cross(t[2].p - t[0].p).normalize_or_zero()).collect();
        for (t, &unit) in self.0.chunks_exact(3).zip(&units) {
            for i in 0..3 {
                let (a, b) = (t[(i + 1) % 3].p - t[i].p, t[(i + 2) % 3].p - t[i].p);
                let weighted = a.cross(b) / (a.length_squared() * b.length_squared());
                at.entry(key(t[i].p)).or_default().push((unit, weighted));
            }
        }
        let mut shape = Shape::default();
        let mut known = HashMap::new();
        for (i, corner) in self.0.iter().enumerate() {
            let unit = units[i / 3];
            let around = at.get(&key(corner.p)).map_or(&[][..], Vec::as_slice);
            let sum: DVec3 = around.iter().filter(|(other, _)| other.dot(unit) > cosine).map(|&(_, weighted)| weighted).sum();
            let normal = (sum.normalize_or(unit) + 0.0).as_vec3(); // no negative zeros: equal is equal in bits
            let identity = (
                corner.p.as_vec3().to_array().map(f32::to_bits),
                normal.to_array().map(f32::to_bits),
                corner.uv.as_vec2().to_array().map(f32::to_bits),
                corner.color,
            );
            let index = *known.entry(identity).or_insert_with(|| {
                shape.positions.push(corner.p);
                shape.normals.push(normal.as_dvec3());
                shape.uvs.push(corner.uv);
                shape.colors.push(corner.color);
                shape.positions.len() as u32 - 1
            });
            shape.indices.push(index);
        }
        shape
    }
}

/// A box about its centre, its edges cut at 45 degrees by `bevel` metres (0 for sharp ones).
pub fn cuboid(size: DVec3, bevel: f64) -> Soup {
    let (outer, inner) = (size / 2.0, size / 2.0 - bevel);
    // The corner with these signs, on the face of this axis.
    let point = |signs: [f64; 3], axis: usize| {
        DVec3::from_array(std::array::from_fn(|i| signs[i] * if i == axis { outer[i] } else { inner[i] }))
    };
    let mut soup = Soup::default();
    let (zero, one) = (DVec2::ZERO, DVec2::ONE);
    let square = [DVec2::new(0.0, 1.0), one, DVec2::new(1.0, 0.0), zero];
    let signs = |axis: usize, a: f64, b: f64, c: f64| {
        let mut s = [0.0; 3];
        (s[axis], s[(axis + 1) % 3], s[(axis + 2) % 3]) = (a, b, c);
        s
    };
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for side in [-1.0, 1.0] {
            let mut face =
                [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(a, b)| point(signs(axis, side, a, b), axis));
            if side < 0.0 {
                face.reverse();
            }
            soup.quad(face, square);
        }
        if bevel > 0.0 {
            for (a, b) in [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)] {
                // The edge along `axis` between the faces of u and v.
                let mut edge = [
                    point(signs(axis, -1.0, a, b), u),
                    point(signs(axis, -1.0, a, b), v),
                    point(signs(axis, 1.0, a, b), v),
                    point(signs(axis, 1.0, a, b), u),
                ];
                if a * b > 0.0 {
                    edge.reverse();
                }
                edge.reverse();
                soup.quad(edge, [zero; 4]);
            }
        }
    }
    if bevel > 0.0 {
        for i in 0..8 {
            let s = [1, 2, 4].map(|bit| if i & bit == 0 { -1.0 } else { 1.0 });
            let mut corner = [point(s, 0), point(s, 1), point(s, 2)];
            if s[0] * s[1] * s[2] < 0.0 {
                corner.reverse();
            }
            soup.triangle(corner, [zero; 3]);
        }
    }
    soup
}

/// Turns a profile (radius, height), given upwards seen from the right with outside on the right,
/// about the Y axis. `bend(point, turns)` gives the radius there: flutes, leaves, noise. A profile
/// that starts and ends on the axis, or where it started, is closed.
pub fn lathe(profile: &[DVec2], segments: usize, bend: impl Fn(DVec2, f64) -> f64) -> Soup {
    let ring = |p: DVec2| -> Vec<DVec3> {
        (0..segments)
            .map(|s| {
                let turns = s as f64 / segments as f64;
                let (direction, r) = (turn(turns), if p.x == 0.0 { 0.0 } else { bend(p, turns) });
                DVec3::new(direction.x * r, p.y, -direction.y * r)
            })
            .collect()
    };
    let rings: Vec<_> = profile.iter().map(|&p| ring(p)).collect();
    let widest = profile.iter().fold(0.0_f64, |w, p| w.max(p.x));
    let around = (widest * std::f64::consts::TAU).round().max(1.0); // whole repeats: the seam does not show
    let mut along = 0.0;
    let mut soup = Soup::default();
    for k in 0..profile.len() - 1 {
        let next_along = along + profile[k].distance(profile[k + 1]);
        for s in 0..segments {
            let t = (s + 1) % segments;
            let (u0, u1) = (around * s as f64 / segments as f64, around * (s + 1) as f64 / segments as f64);
            soup.quad(
                [rings[k][s], rings[k][t], rings[k + 1][t], rings[k + 1][s]],
                [DVec2::new(u0, -along), DVec2::new(u1, -along), DVec2::new(u1, -next_along), DVec2::new(u0, -next_along)],
            );
        }
        along = next_along;
    }
    soup
}

/// A plain round lathe.
pub fn turned(profile: &[(f64, f64)], segments: usize) -> Soup {
    let profile: Vec<_> = profile.iter().map(|&(r, y)| DVec2::new(r, y)).collect();
    lathe(&profile, segments, |p, _| p.x)
}

/// A sphere about the origin.
pub fn sphere(radius: f64, segments: usize, rings: usize) -> Soup {
    let profile: Vec<_> = (0..=rings)
        .map(|k| {
            let d = turn(k as f64 / rings as f64 * 0.5 - 0.25);
            let r = if k == 0 || k == rings { 0.0 } else { d.x * radius };
            DVec2::new(r, d.y * radius)
        })
        .collect();
    lathe(&profile, segments, |p, _| p.x)
}

/// A round tube along a closed curve.
pub fn tube(path: &[DVec3], sides: usize, radius: impl Fn(usize) -> f64) -> Soup {
    let n = path.len();
    let tangent = |i: usize| (path[(i + 1) % n] - path[(i + n - 1) % n]).normalize();
    // A frame carried along without twist, then untwisted evenly so that its ends meet.
    let mut normals = vec![tangent(0).any_orthonormal_vector()];
    for i in 1..=n {
        let t = tangent(i % n);
        let carried = normals[i - 1];
        normals.push((carried - t * carried.dot(t)).normalize());
    }
    let (first, last, t0) = (normals[0], normals[n], tangent(0));
    let twist = DVec2::new(last.dot(first), last.dot(t0.cross(first)));
    // The angle of that twist, found by halving an interval: it only has to be the same everywhere.
    let (mut low, mut high) = (-0.5, 0.5);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        let d = turn(middle);
        let before = if twist.y >= 0.0 { middle < 0.0 || d.x > twist.x } else { middle < 0.0 && d.x < twist.x };
        if before { low = middle } else { high = middle }
    }
    let rings: Vec<Vec<DVec3>> = (0..n)
        .map(|i| {
            let (a, b) = (normals[i], tangent(i).cross(normals[i]));
            (0..sides)
                .map(|s| {
                    let d = turn(s as f64 / sides as f64 - low * i as f64 / n as f64);
                    path[i] + (a * d.x + b * d.y) * radius(i)
                })
                .collect()
        })
        .collect();
    let mut soup = Soup::default();
    for i in 0..n {
        let j = (i + 1) % n;
        for s in 0..sides {
            let t = (s + 1) % sides;
            let (u, v) = (s as f64 / sides as f64, i as f64 / 8.0);
            let (u1, v1) = (u + 1.0 / sides as f64, v + 0.125);
            soup.quad(
                [rings[i][s], rings[i][t], rings[j][t], rings[j][s]],
                [DVec2::new(u, v), DVec2::new(u1, v), DVec2::new(u1, v1), DVec2::new(u, v1)],
            );
        }
    }
    soup
}
