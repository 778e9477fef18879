//! The walker's bones, and its gait by inverse kinematics: feet planted, hips carried over them.
//!
//! It faces +Z, its left is +X. In the bind pose it stands with straight legs, arms a little out.

use glam::{DMat3, DQuat, DVec3};

use super::math::{about, smoothstep, turn};

/// Name, parent, place in the bind pose.
pub const JOINTS: [(&str, Option<usize>, DVec3); 14] = [
    ("pelvis", None, DVec3::new(0.0, 0.95, 0.0)),
    ("spine", Some(PELVIS), DVec3::new(0.0, 1.08, 0.0)),
    ("chest", Some(SPINE), DVec3::new(0.0, 1.24, 0.0)),
    ("head", Some(CHEST), DVec3::new(0.0, 1.49, 0.0)),
    ("left arm", Some(CHEST), DVec3::new(0.18, 1.40, 0.0)),
    ("left forearm", Some(LEFT_ARM), DVec3::new(0.30, 1.144, 0.0)),
    ("right arm", Some(CHEST), DVec3::new(-0.18, 1.40, 0.0)),
    ("right forearm", Some(RIGHT_ARM), DVec3::new(-0.30, 1.144, 0.0)),
    ("left thigh", Some(PELVIS), DVec3::new(0.095, 0.92, 0.0)),
    ("left shin", Some(LEFT_THIGH), DVec3::new(0.095, 0.92 - THIGH, 0.0)),
    ("left foot", Some(LEFT_THIGH + 1), DVec3::new(0.095, ANKLE, 0.0)),
    ("right thigh", Some(PELVIS), DVec3::new(-0.095, 0.92, 0.0)),
    ("right shin", Some(RIGHT_THIGH), DVec3::new(-0.095, 0.92 - THIGH, 0.0)),
    ("right foot", Some(RIGHT_THIGH + 1), DVec3::new(-0.095, ANKLE, 0.0)),
];

pub const PELVIS: usize = 0;
pub const SPINE: usize = 1;
pub const CHEST: usize = 2;
pub const HEAD: usize = 3;
pub const LEFT_ARM: usize = 4;
pub const RIGHT_ARM: usize = 6;
pub const LEFT_THIGH: usize = 8;
pub const RIGHT_THIGH: usize = 11;

const THIGH: f64 = 0.42;
const SHIN: f64 = 0.41;
/// Height of the ankle over the sole.
const ANKLE: f64 = 0.09;
/// The points the foot rolls over, behind and before the ankle.
const HEEL: f64 = 0.07;
const BALL: f64 = 0.13;

/// Seconds for two steps.
pub const PERIOD: f64 = 1.16;
/// Metres for two steps.
pub const STRIDE: f64 = 1.04;
/// The part of the cycle that a foot is on the ground.
const STANCE: f64 = 0.6;

/// Rotations of all joints in their parents' spaces, and the pelvis's place.
pub struct Stance {
    pub rotations: [DQuat; 14],
    pub pelvis: DVec3,
}

/// Ankle (z forwards of the hips, height) and pitch of the foot in degrees, toes up positive.
fn foot(phase: f64) -> (f64, f64, f64) {
    let reach = STRIDE * STANCE / 2.0;
    if phase < STANCE {
        let u = phase / STANCE;
        let flat = reach * (1.0 - 2.0 * u);
        let pitch = 17.0 * (1.0 - smoothstep(0.0, 0.2, u)) - 38.0 * smoothstep(0.55, 1.02, u);
        // Toes up the foot rolls over its heel, toes down over its ball.
        let pivot = if pitch > 0.0 { -HEEL } else { BALL };
        let d = turn(pitch / 360.0);
        let (z, y) = (-pivot, ANKLE);
        (flat + pivot + z * d.x - y * d.y, z * d.y + y * d.x, pitch)
    } else {
        let u = (phase - STANCE) / (1.0 - STANCE);
        let ((z0, y0, p0), (z1, y1, p1)) = (foot(STANCE - 1e-9), foot(0.0));
        let slope = -STRIDE * (1.0 - STANCE); // it leaves and meets the ground at the ground's speed
        let (uu, uuu) = (u * u, u * u * u);
        let z = z0 * (2.0 * uuu - 3.0 * uu + 1.0)
            + slope * (uuu - 2.0 * uu + u)
            + z1 * (3.0 * uu - 2.0 * uuu)
            + slope * 0.6 * (uuu - uu);
        let lift = 16.0 * uu * (1.0 - u) * (1.0 - u);
        let y = y0 + (y1 - y0) * smoothstep(0.0, 0.75, u) + 0.035 * lift;
        (z, y, p0 + (p1 - p0) * smoothstep(0.0, 0.9, u))
    }
}

/// The rotation that turns a bone hanging straight down along `direction`, knees forwards.
fn hanging(direction: DVec3, forward: DVec3) -> DQuat {
    let y = -direction.normalize();
    let z = (forward - y * forward.dot(y)).normalize();
    DQuat::from_mat3(&DMat3::from_cols(y.cross(z), y, z))
}

/// The pose at a phase of the cycle, 0..1; the left heel strikes at 0.
pub fn gait(phase: f64) -> Stance {
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    let wave = |cycles: f64, shift: f64| turn(cycles * (phase - shift)).x;
    let mut rotations = [DQuat::IDENTITY; 14];
    let pelvis = DVec3::new(0.022 * wave(1.0, 0.32), 0.912 - 0.016 * wave(2.0, 0.06), 0.0);
    let hips = about(y, -6.0 * wave(1.0, 0.0)) * about(z, 2.5 * wave(1.0, 0.25)) * about(x, 2.0);
    rotations[PELVIS] = hips;
    rotations[SPINE] = about(y, 5.0 * wave(1.0, 0.02)) * about(z, -2.0 * wave(1.0, 0.25)) * about(x, 1.5);
    rotations[CHEST] = about(y, 6.0 * wave(1.0, 0.04)) * about(x, 1.0 + 1.0 * wave(2.0, 0.1));
    rotations[HEAD] = about(y, -5.0 * wave(1.0, 0.04)) * about(x, -3.5 + 1.2 * wave(2.0, 0.2));
    for (arm, side, shift) in [(LEFT_ARM, 1.0, 0.0), (RIGHT_ARM, -1.0, 0.5)] {
        let swing = wave(1.0, shift + 0.03);
        rotations[arm] = about(x, 21.0 * swing - 3.0) * about(z, -18.0 * side);
        rotations[arm + 1] = about(x, -24.0 + 12.0 * wave(1.0, shift + 0.08));
    }
    for (thigh, shift) in [(LEFT_THIGH, 0.0), (RIGHT_THIGH, 0.5)] {
        let own = phase + shift - (phase + shift).floor();
        let (along, height, pitch) = foot(own);
        let hip = pelvis + hips * (JOINTS[thigh].2 - JOINTS[PELVIS].2);
        let ankle = DVec3::new(JOINTS[thigh].2.x * 0.75, height, along);
        let reach = ankle - hip;
        let length = reach.length().min((THIGH + SHIN) * 0.9995);
        let direction = reach.normalize();
        let bend = (z - direction * z.dot(direction)).normalize();
        let along_reach = (length * length + THIGH * THIGH - SHIN * SHIN) / (2.0 * length);
        let knee = hip + direction * along_reach + bend * (THIGH * THIGH - along_reach * along_reach).max(0.0).sqrt();
        let upper = hanging(knee - hip, z);
        let lower = hanging(hip + direction * length - knee, z);
        rotations[thigh] = hips.inverse() * upper;
        rotations[thigh + 1] = upper.inverse() * lower;
        rotations[thigh + 2] = lower.inverse() * about(x, -pitch);
    }
    Stance { rotations, pelvis }
}
