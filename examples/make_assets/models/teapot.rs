//! Martin Newell's teapot (1975): public-domain bicubic Bezier patches, here by their symmetry.
//!
//! Lid, rim, body and bottom are profiles turned about the axis by Newell's own approximate
//! quarter circle (inner control points at 0.56 of the radius, so not quite round); handle and
//! spout are half cross-sections, mirrored. As in the original there is a gap between lid and rim,
//! and handle and spout run into the body: an open mesh that meets itself, a good test of shadows.

use glam::DVec3;

use super::glb::{Glb, Look};
use super::soup::Soup;

/// Radius and height of four control points.
type Profile = [[f64; 2]; 4];

const LID: [Profile; 2] =
    [[[0.0, 3.15], [0.8, 3.15], [0.0, 2.85], [0.2, 2.7]], [[0.2, 2.7], [0.4, 2.55], [1.3, 2.55], [1.3, 2.4]]];

const BODY: [Profile; 4] = [
    [[1.4, 2.4], [1.3375, 2.53125], [1.4375, 2.53125], [1.5, 2.4]],
    [[1.5, 2.4], [1.75, 1.875], [2.0, 1.35], [2.0, 0.9]],
    [[2.0, 0.9], [2.0, 0.45], [1.5, 0.225], [1.5, 0.15]],
    [[1.5, 0.15], [1.5, 0.075], [1.425, 0.0], [0.0, 0.0]],
];

/// Half a cross-section: x, half width, height of four control points; four of those along.
type Half = [[[f64; 3]; 4]; 4];

const HANDLE: [Half; 2] = [
    [
        [[-1.6, 0.0, 2.025], [-1.6, 0.3, 2.025], [-1.5, 0.3, 2.25], [-1.5, 0.0, 2.25]],
        [[-2.3, 0.0, 2.025], [-2.3, 0.3, 2.025], [-2.5, 0.3, 2.25], [-2.5, 0.0, 2.25]],
        [[-2.7, 0.0, 2.025], [-2.7, 0.3, 2.025], [-3.0, 0.3, 2.25], [-3.0, 0.0, 2.25]],
        [[-2.7, 0.0, 1.8], [-2.7, 0.3, 1.8], [-3.0, 0.3, 1.8], [-3.0, 0.0, 1.8]],
    ],
    [
        [[-2.7, 0.0, 1.8], [-2.7, 0.3, 1.8], [-3.0, 0.3, 1.8], [-3.0, 0.0, 1.8]],
        [[-2.7, 0.0, 1.575], [-2.7, 0.3, 1.575], [-3.0, 0.3, 1.35], [-3.0, 0.0, 1.35]],
        [[-2.5, 0.0, 1.125], [-2.5, 0.3, 1.125], [-2.65, 0.3, 0.9375], [-2.65, 0.0, 0.9375]],
        [[-2.0, 0.0, 0.9], [-2.0, 0.3, 0.9], [-1.9, 0.3, 0.6], [-1.9, 0.0, 0.6]],
    ],
];

const SPOUT: [Half; 2] = [
    [
        [[1.7, 0.0, 1.425], [1.7, 0.66, 1.425], [1.7, 0.66, 0.6], [1.7, 0.0, 0.6]],
        [[2.6, 0.0, 1.425], [2.6, 0.66, 1.425], [3.1, 0.66, 0.825], [3.1, 0.0, 0.825]],
        [[2.3, 0.0, 2.1], [2.3, 0.25, 2.1], [2.4, 0.25, 2.025], [2.4, 0.0, 2.025]],
        [[2.7, 0.0, 2.4], [2.7, 0.25, 2.4], [3.3, 0.25, 2.4], [3.3, 0.0, 2.4]],
    ],
    [
        [[2.7, 0.0, 2.4], [2.7, 0.25, 2.4], [3.3, 0.25, 2.4], [3.3, 0.0, 2.4]],
        [[2.8, 0.0, 2.475], [2.8, 0.25, 2.475], [3.525, 0.25, 2.49375], [3.525, 0.0, 2.49375]],
        [[2.9, 0.0, 2.475], [2.9, 0.15, 2.475], [3.45, 0.15, 2.5125], [3.45, 0.0, 2.5125]],
        [[2.8, 0.0, 2.4], [2.8, 0.15, 2.4], [3.2, 0.15, 2.4], [3.2, 0.0, 2.4]],
    ],
];

/// Where a Bezier curve through four control points is at t.
fn bezier(p: [DVec3; 4], t: f64) -> DVec3 {
    let s = 1.0 - t;
    p[0] * (s * s * s) + p[1] * (3.0 * s * s * t) + p[2] * (3.0 * s * t * t) + p[3] * (t * t * t)
}

/// Newell's x, y (width), z (height) to ours, in metres.
fn point(x: f64, width: f64, height: f64) -> DVec3 {
    DVec3::new(x, height, width) * (0.35 / 3.15)
}

/// Points of a grid of `n` by `m` quads over a patch, evenly in the parameters.
fn grid(patch: [[DVec3; 4]; 4], n: usize, m: usize) -> Vec<Vec<DVec3>> {
    (0..=n)
        .map(|i| {
            let curve = patch.map(|row| bezier(row, i as f64 / n as f64));
            // Where control points coincide, so shall the points: rounding must not pull the knob's top apart.
            (0..=m).map(|j| (bezier(curve, j as f64 / m as f64) * 1e6).round() / 1e6).collect()
        })
        .collect()
}

/// `rows[i][j]` to quads, front side where `i` to the right and `j` up is counter-clockwise.
fn skin(rows: &[Vec<DVec3>]) -> Soup {
    let mut soup = Soup::default();
    for (a, b) in rows.iter().zip(&rows[1..]) {
        for j in 0..a.len() - 1 {
            soup.quad([a[j], b[j], b[j + 1], a[j + 1]], [glam::DVec2::ZERO; 4]);
        }
    }
    soup
}

/// The quarter from +x to +width; the other three follow by mirroring, which keeps shared points equal.
fn turned(profile: &Profile, quads: usize) -> Soup {
    let quarter = [[1.0, 0.0], [1.0, 0.56], [0.56, 1.0], [0.0, 1.0]];
    let patch = quarter.map(|[x, y]| profile.map(|[r, h]| point(r * x, r * y, h)));
    let rows = grid(patch, quads, quads);
    let mirrored = |sx: f64, sy: f64| -> Soup {
        let mut rows: Vec<Vec<DVec3>> =
            rows.iter().map(|row| row.iter().map(|p| *p * DVec3::new(sx, 1.0, sy)).collect()).collect();
        if sx * sy > 0.0 {
            rows.iter_mut().for_each(|row| row.reverse());
        }
        skin(&rows)
    };
    mirrored(1.0, 1.0).and(mirrored(-1.0, 1.0)).and(mirrored(-1.0, -1.0)).and(mirrored(1.0, -1.0))
}

fn sleeve(half: &Half, around: usize, along: usize) -> Soup {
    // Across first, then along.
    let patch: [[DVec3; 4]; 4] = std::array::from_fn(|k| {
        std::array::from_fn(|i| {
            let [x, w, h] = half[i][k];
            point(x, w, h)
        })
    });
    let rows = grid(patch, around, along);
    let side = |sign: f64| {
        let mut rows: Vec<Vec<DVec3>> =
            rows.iter().map(|row| row.iter().map(|p| *p * DVec3::new(1.0, 1.0, sign)).collect()).collect();
        if sign > 0.0 {
            rows.reverse();
        }
        skin(&rows)
    };
    side(1.0).and(side(-1.0))
}

/// The teapot, 0.35 m high, its axis on the y axis, spout towards +x.
pub fn file() -> Vec<u8> {
    let mut soup = Soup::default();
    for profile in &LID {
        soup = soup.and(turned(profile, 8));
    }
    for profile in &BODY {
        soup = soup.and(turned(profile, 8));
    }
    for half in &HANDLE {
        soup = soup.and(sleeve(half, 6, 8));
    }
    for half in &SPOUT {
        soup = soup.and(sleeve(half, 8, 8));
    }
    let mut glb = Glb::default();
    let glaze =
        glb.material(&Look { name: "glaze", color: [0.75, 0.72, 0.66], roughness: 0.25, double_sided: true, ..Look::default() });
    glb.show("teapot", &[(soup.creased(0.5), glaze)]);
    glb.finish()
}
