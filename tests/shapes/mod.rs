//! Random solids and soups, and slow, plain answers to what volumes should count.
#![allow(dead_code, reason = "each test binary uses a part")]

use std::ops::Range;

use glam::{DVec3, Vec3, Vec4};
use obscura::geometry::{Caster, Facing, Planes, VolumeIndices, VolumeParts, VolumeScratch};
use obscura::scene::{Mesh, MeshParts, Primitive};
use proptest::prelude::*;

/// A mesh with what its volumes need.
pub struct Shape {
    pub mesh: Mesh,
    pub welded: Vec<Vec3>,
    pub planes: Planes,
}

impl std::fmt::Debug for Shape {
    /// What a failed case needs to be drawn again.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Shape").field("welded", &self.welded).field("triangles", &self.mesh.topology.triangles()).finish()
    }
}

/// Positions and indices.
pub type Surface = (Vec<Vec3>, Vec<u32>);

impl Shape {
    pub fn new((positions, indices): Surface) -> Self {
        let index_count = indices.len() as u32;
        let primitives = vec![Primitive { first_index: 0, index_count, material: 0, casts_shadow: true }];
        let mesh = Mesh::new(MeshParts { positions, indices, primitives, ..MeshParts::default() }).unwrap();
        let (mut welded, mut planes) = (Vec::new(), Planes::default());
        mesh.topology.weld().gather(&mesh.positions, &mut welded);
        planes.build(&mesh.topology, &welded);
        Self { mesh, welded, planes }
    }

    pub fn caster(&self) -> Caster<'_> {
        Caster { topology: &self.mesh.topology, welded: &self.welded, planes: &self.planes, bounds: &self.mesh.bounds }
    }

    pub fn volume(&self, light: Vec4, parts: VolumeParts) -> Volume {
        let (mut indices, mut scratch) = (Vec::new(), VolumeScratch::default());
        let ranges = scratch.append(self.caster(), light, parts, &mut indices);
        Volume { indices, ranges, scratch }
    }

    /// The whole boundary, counter-clockwise from outside: the turned cap is turned here.
    pub fn boundary(&self, volume: &Volume) -> Vec<[u32; 3]> {
        let part = |range: &Range<u32>| volume.indices[range.start as usize..range.end as usize].as_chunks::<3>().0.to_vec();
        let mut boundary = part(&volume.ranges.sides);
        boundary.extend(part(&volume.ranges.light_cap_kept));
        boundary.extend(part(&volume.ranges.light_cap_turned).iter().map(|[a, b, c]| [*c, *b, *a]));
        boundary.extend(part(&volume.ranges.dark_cap));
        boundary
    }

    /// How often the volume's boundary winds around `point`: its triangles' solid angles, for
    /// which a vertex at infinity is as good as any.
    pub fn winding(&self, boundary: &[[u32; 3]], light: Vec4, point: DVec3) -> f64 {
        let half_angles: f64 = boundary
            .iter()
            .map(|triangle| {
                let [a, b, c] = triangle.map(|vertex| {
                    let from_point = match self.welded.get(vertex as usize) {
                        Some(vertex) => vertex.as_dvec3() - point,
                        None => {
                            let vertex = self.welded[vertex as usize - self.welded.len()];
                            vertex.as_dvec3() * f64::from(light.w) - light.truncate().as_dvec3()
                        }
                    };
                    from_point.normalize()
                });
                // Van Oosterom and Strackee.
                a.dot(b.cross(c)).atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
            })
            .sum();
        half_angles / std::f64::consts::TAU
    }

    /// The contributions that the way from the light to `point` crosses, each signed by the side
    /// it is entered from; by Moeller and Trumbore, one triangle at a time.
    pub fn crossed(&self, facing: &Facing, light: Vec4, point: DVec3) -> i32 {
        let towards = light.truncate().as_dvec3() - point * f64::from(light.w);
        let mut sum = 0;
        for (triangle, counts) in self.mesh.topology.triangles().iter().zip(facing.contributions()) {
            let [a, b, c] = triangle.map(|vertex| self.welded[vertex as usize].as_dvec3());
            let normal = towards.cross(c - a);
            let determinant = (b - a).dot(normal);
            let from_a = point - a;
            let u = from_a.dot(normal) / determinant;
            let across = from_a.cross(b - a);
            let v = towards.dot(across) / determinant;
            let t = (c - a).dot(across) / determinant;
            let ends = if light.w == 0.0 { f64::INFINITY } else { 1.0 };
            if u > 0.0 && v > 0.0 && u + v < 1.0 && t > 0.0 && t < ends {
                // The light sees the front where the way to it runs along the normal.
                sum += i32::from(*counts) * if (b - a).cross(c - a).dot(towards) > 0.0 { 1 } else { -1 };
            }
        }
        sum
    }
}

impl Shape {
    /// Whether `eye` lies close to a triangle, or the way to the light close to an edge: found by
    /// trying points of all of them.
    pub fn near_boundary(&self, light: Vec4, eye: DVec3) -> bool {
        let towards = light.truncate().as_dvec3() - eye * f64::from(light.w);
        let close = 1e-3;
        let from_way = |point: DVec3| {
            let along = (point - eye).dot(towards) / towards.length_squared();
            let along = along.clamp(0.0, if light.w == 0.0 { f64::INFINITY } else { 1.0 });
            (eye + towards * along).distance(point)
        };
        self.mesh.topology.triangles().iter().any(|triangle| {
            let [a, b, c] = triangle.map(|vertex| self.welded[vertex as usize].as_dvec3());
            let normal = (b - a).cross(c - a).normalize_or_zero();
            let in_plane = [eye, light.truncate().as_dvec3()].iter().any(|point| normal.dot(*point - a).abs() < close);
            let edges = [(a, b), (b, c), (c, a)];
            in_plane || edges.iter().any(|(a, b)| (0..=5000).any(|step| from_way(a.lerp(*b, f64::from(step) / 5000.0)) < close))
        })
    }
}

/// What was appended, and what it was made in.
pub struct Volume {
    pub indices: Vec<u32>,
    pub ranges: VolumeIndices,
    pub scratch: VolumeScratch,
}

/// Two metres wide, outward; the last two triangles are the face at x = 1.
pub fn cube() -> Surface {
    let positions =
        (0..8).map(|corner| Vec3::new((corner & 1) as f32, (corner >> 1 & 1) as f32, (corner >> 2) as f32) * 2.0 - Vec3::ONE);
    let indices = [0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5];
    (positions.collect(), indices.to_vec())
}

/// About the y axis, outward, its tube of a radius that `bump` varies.
pub fn torus(rings: u32, sides: u32, bump: impl Fn(usize) -> f32) -> Surface {
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    let turn = |step: u32, steps: u32| (step as f32 / steps as f32 * std::f32::consts::TAU).sin_cos();
    for ring in 0..rings {
        for side in 0..sides {
            let ((sin_ring, cos_ring), (sin_side, cos_side)) = (turn(ring, rings), turn(side, sides));
            let radius = 0.5 * (1.0 + 0.5 * bump(positions.len()));
            let out = 1.3 + radius * cos_side;
            positions.push(Vec3::new(out * cos_ring, radius * sin_side, -out * sin_ring));
            let at = |ring: u32, side: u32| ring % rings * sides + side % sides;
            let (a, b, c, d) = (at(ring, side), at(ring + 1, side), at(ring + 1, side + 1), at(ring, side + 1));
            indices.extend([a, b, c, a, c, d]);
        }
    }
    (positions, indices)
}

/// Outward, of a radius that `bump` varies.
pub fn sphere(rings: u32, sides: u32, bump: impl Fn(usize) -> f32) -> Surface {
    let (mut positions, mut indices) = (vec![Vec3::Y, Vec3::NEG_Y], Vec::new());
    let at = |ring: u32, side: u32| match ring {
        0 => 0,
        ring if ring == rings => 1,
        ring => 2 + (ring - 1) * sides + side % sides,
    };
    for ring in 1..rings {
        let (sin, cos) = (ring as f32 / rings as f32 * std::f32::consts::PI).sin_cos();
        for side in 0..sides {
            let turn = side as f32 / sides as f32 * std::f32::consts::TAU;
            positions.push(Vec3::new(sin * turn.cos(), cos, -sin * turn.sin()) * (1.0 + 0.6 * bump(positions.len())));
        }
    }
    for ring in 0..rings {
        for side in 0..sides {
            let (a, b, c, d) = (at(ring, side), at(ring + 1, side), at(ring + 1, side + 1), at(ring, side + 1));
            indices.extend([[a, b, c], [a, c, d]].into_iter().filter(|[a, b, c]| a != b && b != c && c != a).flatten());
        }
    }
    (positions, indices)
}

/// Cubes, tori and spheres with their corners moved at random, some through each other.
pub fn solid() -> impl Strategy<Value = Shape> {
    let bumps = prop::collection::vec(-1.0f32..1.0, 40);
    (0..3, 3..8u32, 3..8u32, bumps).prop_map(|(kind, rings, sides, bumps)| {
        let bump = |at: usize| bumps[at % bumps.len()];
        Shape::new(match kind {
            0 => {
                let (mut positions, indices) = cube();
                for (at, corner) in positions.iter_mut().enumerate() {
                    *corner *= 1.0 + 0.4 * Vec3::new(bump(3 * at), bump(3 * at + 1), bump(3 * at + 2));
                }
                (positions, indices)
            }
            1 => torus(rings, sides, bump),
            _ => sphere(rings, sides, bump),
        })
    })
}

/// Triangles between a few corners: borders, edges of many triangles, doubled triangles, anything.
pub fn soup() -> impl Strategy<Value = Shape> {
    let corner = prop::array::uniform3(-1.5f32..1.5).prop_map(Vec3::from);
    (prop::collection::vec(corner, 4..9), prop::collection::vec(0..1000u32, 3..60)).prop_map(|(corners, mut indices)| {
        indices.truncate(indices.len() / 3 * 3);
        indices.iter_mut().for_each(|index| *index %= corners.len() as u32);
        Shape::new((corners, indices))
    })
}

/// Either.
pub fn shape() -> impl Strategy<Value = Shape> {
    prop_oneof![solid(), soup()]
}

/// In and around the shapes.
pub fn place() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-3.0f32..3.0).prop_map(Vec3::from)
}

/// Near and inside, far, and infinitely far.
pub fn light() -> impl Strategy<Value = Vec4> {
    (place(), prop_oneof![Just((1.0, 1.0)), Just((10.0, 1.0)), Just((1.0, 0.0))])
        .prop_map(|(place, (far, w))| (place * far).extend(w))
}
