//! Convex solids about what a light reaches, as closed meshes to be drawn.
//!
//! A convex body is entered and left once, so the mesh tells whether a surface lies within it by how many
//! of its faces lie behind the surface: one within, none beyond, two before. That holds as long as
//! the mesh is closed, which it is because its triangles share their vertices. A solid holds its body
//! with room to spare: what is within may be a little too much, never too little.
//!
//! ```text
//!     eye o---x--[----x----]--x---->      faces behind x: two, one, none
//! ```

use glam::{DMat4, DVec3, DVec4};
use serde::Serialize;

/// A convex solid, world space, metres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Enclosure {
    /// The cube about a ball.
    Box {
        /// Its middle.
        center: DVec3,
        /// Half its side.
        radius: f64,
    },
    /// Eighty triangles about a ball.
    Ball {
        /// Its middle.
        center: DVec3,
        /// Of the ball.
        radius: f64,
    },
    /// A pyramid about a cone.
    Cone {
        /// Where it begins.
        apex: DVec3,
        /// Where it goes, unit.
        axis: DVec3,
        /// From the axis to the cone, radians: less than a right angle.
        outer: f64,
        /// From the apex to the base, along the axis.
        reach: f64,
    },
}

/// Sides of the pyramid about a cone.
const SIDES: u16 = 16;

impl Enclosure {
    /// The same, holding all that is at most `margin` metres away from it.
    #[must_use]
    pub fn grown(self, margin: f64) -> Self {
        match self {
            Self::Box { center, radius } => Self::Box { center, radius: radius + margin },
            Self::Ball { center, radius } => Self::Ball { center, radius: radius + margin },
            Self::Cone { apex, axis, outer, reach } => {
                let back = margin / outer.sin();
                Self::Cone { apex: apex - axis * back, axis, outer, reach: reach + back + margin }
            }
        }
    }

    /// One word for people.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Box { .. } => "box",
            Self::Ball { .. } => "ball",
            Self::Cone { .. } => "cone",
        }
    }

    /// The corners of its triangles in clip space, three each; the same corner is the same to the last bit.
    pub fn append_clip(&self, clip_from_world: &DMat4, into: &mut Vec<[f32; 4]>) {
        let (places, triangles) = self.mesh();
        let clip: Vec<_> =
            places.iter().map(|place| (*clip_from_world * DVec4::from((*place, 1.0))).as_vec4().to_array()).collect();
        into.extend(triangles.iter().flatten().map(|corner| clip[usize::from(*corner)]));
    }

    /// Its corners, and its triangles by them, all wound the same way.
    fn mesh(&self) -> (Vec<DVec3>, Vec<[u16; 3]>) {
        match *self {
            Self::Box { center, radius } => {
                let corner = |at: u16| DVec3::from([1, 2, 4].map(|axis| if at & axis == 0 { -radius } else { radius }));
                let quads: [[u16; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
                let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
                ((0..8).map(|at| center + corner(at)).collect(), triangles)
            }
            Self::Ball { center, radius } => {
                let (unit, triangles) = ball();
                (unit.into_iter().map(|place| center + place * radius).collect(), triangles)
            }
            Self::Cone { apex, axis, outer, reach } => {
                let (right, up) = axis.any_orthonormal_pair();
                // The sides touch the cone, the corners stand off.
                let radius = reach * outer.tan() / (std::f64::consts::PI / f64::from(SIDES)).cos();
                let around = |side: u16| {
                    let (sin, cos) = (std::f64::consts::TAU * f64::from(side) / f64::from(SIDES)).sin_cos();
                    apex + axis * reach + (right * cos + up * sin) * radius
                };
                let places = [apex, apex + axis * reach].into_iter().chain((0..SIDES).map(around)).collect();
                let triangles = (0..SIDES).flat_map(|side| {
                    let (a, b) = (2 + side, 2 + (side + 1) % SIDES);
                    [[0, b, a], [1, a, b]]
                });
                (places, triangles.collect())
            }
        }
    }
}

/// An icosahedron whose triangles are split in four, about the unit ball.
fn ball() -> (Vec<DVec3>, Vec<[u16; 3]>) {
    const GOLDEN: f64 = 1.618_033_988_749_895;
    const ICOSAHEDRON: [[u16; 3]; 20] = [
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    let mut places: Vec<DVec3> = Vec::with_capacity(42);
    for axis in 0..3 {
        for (one, golden) in [(-1.0, GOLDEN), (1.0, GOLDEN), (-1.0, -GOLDEN), (1.0, -GOLDEN)] {
            let mut place = [one, golden, 0.0];
            place.rotate_right(axis);
            places.push(DVec3::from(place).normalize());
        }
    }
    let mut triangles = Vec::with_capacity(80);
    let between = |a: u16, b: u16, places: &mut Vec<DVec3>| {
        let middle = (places[usize::from(a.min(b))] + places[usize::from(a.max(b))]).normalize();
        let found = places.iter().position(|place| *place == middle).unwrap_or_else(|| {
            places.push(middle);
            places.len() - 1
        });
        u16::try_from(found).unwrap_or(0)
    };
    for [a, b, c] in ICOSAHEDRON {
        let [ab, bc, ca] = [between(a, b, &mut places), between(b, c, &mut places), between(c, a, &mut places)];
        triangles.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
    }
    // The nearest triangle is to touch the ball.
    let nearest = triangles.iter().map(|[a, b, c]: &[u16; 3]| {
        let [a, b, c] = [a, b, c].map(|corner| places[usize::from(*corner)]);
        (b - a).cross(c - a).normalize().dot(a).abs()
    });
    let nearest = nearest.fold(1.0, f64::min);
    places.iter_mut().for_each(|place| *place /= nearest);
    (places, triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    fn solids() -> [Enclosure; 4] {
        let center = DVec3::new(1.0, -2.0, 0.5);
        let axis = DVec3::new(0.3, -1.0, 0.2).normalize();
        [
            Enclosure::Box { center, radius: 2.0 },
            Enclosure::Ball { center, radius: 2.0 },
            Enclosure::Cone { apex: center, axis, outer: 0.6, reach: 3.0 },
            Enclosure::Cone { apex: center, axis, outer: 1.2, reach: 0.5 },
        ]
    }

    #[test]
    fn meshes_are_closed_and_convex() {
        for solid in solids() {
            let (places, triangles) = solid.mesh();
            let mut edges: HashMap<(u16, u16), i32> = HashMap::new();
            for [a, b, c] in &triangles {
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    *edges.entry((*from.min(to), *from.max(to))).or_default() += if from < to { 1 } else { -1 };
                }
                let [a, b, c] = [a, b, c].map(|corner| places[usize::from(*corner)]);
                let normal = (b - a).cross(c - a).normalize();
                let sides: Vec<_> = places.iter().map(|place| normal.dot(*place - a)).filter(|off| off.abs() > 1e-9).collect();
                assert!(sides.iter().all(|off| off.signum() == sides[0].signum()), "{solid:?}");
            }
            assert!(edges.values().all(|sum| *sum == 0), "{solid:?}");
            assert_eq!(places.len() + triangles.len(), edges.len() + 2, "Euler: {solid:?}");
        }
    }

    #[test]
    fn solids_hold_what_they_are_about_and_grow() {
        // Directions all around, in the golden angle's spiral.
        let directions: Vec<_> = (0..500)
            .map(|at| {
                let (height, turn) = (f64::from(at) / 249.5 - 1.0, f64::from(at) * 2.399_963);
                let ring = (1.0 - height * height).sqrt();
                DVec3::new(ring * turn.cos(), height, ring * turn.sin())
            })
            .collect();
        let holds = |solid: &Enclosure, point: DVec3| {
            let (places, triangles) = solid.mesh();
            let middle = places.iter().sum::<DVec3>() / f64::from(u16::try_from(places.len()).unwrap_or(1));
            triangles.iter().all(|triangle| {
                let [a, b, c] = triangle.map(|corner| places[usize::from(corner)]);
                let normal = (b - a).cross(c - a);
                normal.dot(point - a) * normal.dot(middle - a) >= 0.0
            })
        };
        for solid in solids() {
            for direction in &directions {
                let within = match solid {
                    Enclosure::Box { center, radius } | Enclosure::Ball { center, radius } => center + *direction * radius,
                    Enclosure::Cone { apex, axis, outer, reach } => {
                        let (right, up) = axis.any_orthonormal_pair();
                        let ring = right * direction.x + up * direction.z;
                        let along = reach * (direction.y + 1.0) / 2.0;
                        apex + axis * along + ring.normalize_or_zero() * along * outer.tan() * (1.0 - 1e-12)
                    }
                };
                assert!(holds(&solid.grown(1e-9), within), "{solid:?} {within}");
                for other in directions.iter().step_by(50) {
                    assert!(holds(&solid.grown(0.25), within + *other * 0.2499), "{solid:?} grown {within}");
                }
            }
        }
    }
}
