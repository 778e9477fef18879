//! Numbers that come out the same on every host.

use glam::{DQuat, DVec2, DVec3};

/// Cosine and sine of an angle in whole turns: exact at quarter turns, within 1e-15 elsewhere.
pub fn turn(turns: f64) -> DVec2 {
    let turns = turns - turns.floor();
    let quarter = (turns * 4.0 + 0.5).floor();
    let x = (turns - quarter * 0.25) * std::f64::consts::TAU; // -pi/4 ..= pi/4
    let xx = x * x;
    let (mut sin, mut cos, mut sin_term, mut cos_term) = (0.0, 0.0, x, 1.0);
    for n in 0..10 {
        sin += sin_term;
        cos += cos_term;
        let k = f64::from(2 * n);
        sin_term *= -xx / ((k + 2.0) * (k + 3.0));
        cos_term *= -xx / ((k + 1.0) * (k + 2.0));
    }
    match quarter as i32 & 3 {
        0 => DVec2::new(cos, sin),
        1 => DVec2::new(-sin, cos),
        2 => DVec2::new(-cos, -sin),
        _ => DVec2::new(sin, -cos),
    }
}

/// Rotation about a unit axis by an angle in degrees.
pub fn about(axis: DVec3, degrees: f64) -> DQuat {
    let half = turn(degrees / 720.0);
    let v = axis * half.y;
    DQuat::from_xyzw(v.x, v.y, v.z, half.x)
}

/// 0 below `a`, 1 above `b`, smooth between.
pub fn smoothstep(a: f64, b: f64, x: f64) -> f64 {
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// A number in 0..1 that looks random, fixed by the three integers.
pub fn hash(x: i64, y: i64, seed: u64) -> f64 {
    let mut h = seed ^ (x as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ (y as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F);
    for _ in 0..2 {
        h = (h ^ (h >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        h = (h ^ (h >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        h ^= h >> 31;
    }
    (h >> 11) as f64 / (1u64 << 53) as f64
}

/// Smooth noise in 0..1 over the plane, one value a unit square, repeating every `period` units.
pub fn noise(p: DVec2, period: i64, seed: u64) -> f64 {
    let cell = p.floor();
    let (x, y) = (cell.x as i64, cell.y as i64);
    let at = |dx: i64, dy: i64| hash((x + dx).rem_euclid(period), (y + dy).rem_euclid(period), seed);
    let (u, v) = (smoothstep(0.0, 1.0, p.x - cell.x), smoothstep(0.0, 1.0, p.y - cell.y));
    let (top, bottom) = (at(0, 0) * (1.0 - u) + at(1, 0) * u, at(0, 1) * (1.0 - u) + at(1, 1) * u);
    top * (1.0 - v) + bottom * v
}

/// Four octaves of [`noise`] in 0..1, the coarsest `period` units wide.
pub fn clouds(p: DVec2, period: i64, seed: u64) -> f64 {
    let (mut sum, mut weight) = (0.0, 0.0);
    for octave in 0..4u32 {
        let f = f64::from(1u32 << octave);
        sum += noise(p * f, period << octave, seed + u64::from(octave)) / f;
        weight += 1.0 / f;
    }
    sum / weight
}
