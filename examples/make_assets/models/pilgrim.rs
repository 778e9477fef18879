//! The pilgrim: the walker's bones and gait in a hooded robe, of half as many triangles.
//!
//! The robe is a material of its own, so that a scene can dye it. Its skirt hangs on both thighs
//! and swings with them.

use glam::{DVec2, DVec3};

use super::figure::{BOOTS, Part, SKIN, show_walking, skinned};
use super::glb::{Binding, Glb, Look};
use super::math::{smoothstep, turn};
use super::skeleton::{CHEST, HEAD, JOINTS, LEFT_ARM, LEFT_THIGH, PELVIS, RIGHT_ARM, RIGHT_THIGH, SPINE};
use super::soup::{Shape, lathe};

/// What of the body is robe; its folds are shaded from here.
const ROBE: [f64; 3] = [1.0, 1.0, 1.0];
const GIRDLE: [f64; 3] = [0.30, 0.24, 0.16];

fn parts() -> Vec<Part> {
    let v = DVec3::new;
    let mut parts = Vec::new();
    let mut part = |joint, from: (DVec3, f64), to: (DVec3, f64), flat, color| parts.push(Part { joint, from, to, flat, color });
    part(PELVIS, (v(-0.05, 0.95, 0.0), 0.12), (v(0.05, 0.95, 0.0), 0.12), 1.12, ROBE);
    part(SPINE, (v(0.0, 1.02, 0.0), 0.128), (v(0.0, 1.14, 0.0), 0.126), 1.15, ROBE);
    part(CHEST, (v(0.0, 1.18, 0.0), 0.13), (v(0.0, 1.31, 0.01), 0.14), 1.15, ROBE);
    part(CHEST, (v(-0.10, 1.385, 0.0), 0.085), (v(0.10, 1.385, 0.0), 0.085), 1.0, ROBE);
    part(HEAD, (v(0.0, 1.44, 0.0), 0.06), (v(0.0, 1.55, 0.01), 0.06), 1.0, SKIN);
    part(HEAD, (v(0.0, 1.59, 0.025), 0.08), (v(0.0, 1.655, 0.012), 0.092), 0.95, SKIN);
    for (arm, side) in [(LEFT_ARM, 1.0), (RIGHT_ARM, -1.0)] {
        let (shoulder, elbow) = (JOINTS[arm].2, JOINTS[arm + 1].2);
        let down = (elbow - shoulder).normalize();
        part(arm, (shoulder, 0.070), (elbow, 0.062), 1.0, ROBE);
        part(arm + 1, (elbow, 0.062), (elbow + down * 0.24, 0.082), 1.0, ROBE);
        part(arm + 1, (elbow + down * 0.28, 0.040), (elbow + down * 0.38 + v(-0.012 * side, 0.0, 0.01), 0.042), 0.9, SKIN);
    }
    for thigh in [LEFT_THIGH, RIGHT_THIGH] {
        let (knee, ankle) = (JOINTS[thigh + 1].2, JOINTS[thigh + 2].2);
        part(thigh + 1, (knee, 0.055), (ankle + DVec3::Y * 0.02, 0.047), 1.0, BOOTS);
        part(thigh + 2, (ankle + v(0.0, -0.03, -0.03), 0.055), (ankle + v(0.0, -0.044, 0.13), 0.046), 1.0, BOOTS);
    }
    parts
}

/// From the girdle to above the ankles, a closed bell in folds.
fn skirt() -> (Shape, Vec<Binding>) {
    let profile = [
        (0.0, 0.42),
        (0.20, 0.36),
        (0.262, 0.20),
        (0.276, 0.20),
        (0.262, 0.40),
        (0.235, 0.62),
        (0.205, 0.84),
        (0.172, 0.985),
        (0.178, 1.00),
        (0.178, 1.04),
        (0.150, 1.06),
        (0.0, 1.08),
    ];
    let fold = |p: DVec2, turns: f64| p.x * (1.0 + 0.06 * smoothstep(0.95, 0.3, p.y) * turn(turns * 7.0).x);
    let shape = lathe(&profile.map(DVec2::from), 21, fold)
        .map(|p| DVec3::new(p.x * 1.04, p.y, p.z * 0.92))
        .painted(|p| {
            let r = (p.x * p.x + p.z * p.z).sqrt();
            if (0.99..1.05).contains(&p.y) && r > 0.155 { GIRDLE } else { [0.80 + 0.20 * smoothstep(0.2, 0.9, p.y); 3] }
        })
        .creased(0.5);
    let bindings = shape.positions.iter().map(|p| {
        let legs = 0.92 * smoothstep(0.98, 0.45, p.y);
        let left = smoothstep(-0.13, 0.13, p.x);
        let weights = [1.0 - legs, legs * left, legs * (1.0 - left), 0.0];
        ([PELVIS as u8, LEFT_THIGH as u8, RIGHT_THIGH as u8, 0], weights.map(|w| w as f32))
    });
    let bindings = bindings.collect();
    (shape, bindings)
}

/// A hood with a brim about the face, and its cape over the shoulders.
fn hood() -> (Shape, Vec<Binding>) {
    let profile = [
        (0.0, 1.40),
        (0.19, 1.25),
        (0.226, 1.24),
        (0.232, 1.27),
        (0.195, 1.38),
        (0.125, 1.46),
        (0.108, 1.54),
        (0.128, 1.64),
        (0.112, 1.74),
        (0.060, 1.81),
        (0.0, 1.83),
    ];
    let shape = lathe(&profile.map(DVec2::from), 18, |p, _| p.x)
        .map(|p| {
            // Pointed backwards; its front is a hollow for the face.
            let high = smoothstep(1.46, 1.60, p.y);
            let back = DVec3::new(p.x * 1.02, p.y + 0.03 * smoothstep(1.7, 1.83, p.y), p.z * 1.08 - 0.035 * high);
            let front = smoothstep(0.02, 0.10, p.z) * smoothstep(1.48, 1.56, p.y) * smoothstep(1.76, 1.70, p.y);
            let narrow = smoothstep(0.085, 0.05, p.x.abs());
            DVec3::new(back.x * (1.0 + 0.12 * (1.0 - high)), back.y, back.z - 0.085 * front * narrow)
        })
        .painted(|p| [0.86 + 0.14 * smoothstep(1.3, 1.7, p.y); 3])
        .creased(0.5);
    let bindings = shape.positions.iter().map(|p| {
        let head = smoothstep(1.40, 1.54, p.y);
        ([HEAD as u8, CHEST as u8, 0, 0], [head as f32, (1.0 - head) as f32, 0.0, 0.0])
    });
    let bindings = bindings.collect();
    (shape, bindings)
}

/// The triangles of which `keep` says so, with the vertices they use.
fn part_of(shape: &Shape, bindings: &[Binding], keep: impl Fn([u8; 3]) -> bool) -> (Shape, Vec<Binding>) {
    let (mut part, mut kept) = (Shape::default(), Vec::new());
    let mut places = vec![None; shape.positions.len()];
    for t in shape.indices.chunks_exact(3) {
        let robed = t.iter().filter(|&&i| keep(shape.colors[i as usize])).count() >= 2;
        if !robed {
            continue;
        }
        for &i in t {
            let i = i as usize;
            part.indices.push(*places[i].get_or_insert_with(|| {
                part.positions.push(shape.positions[i]);
                part.normals.push(shape.normals[i]);
                part.uvs.push(shape.uvs[i]);
                part.colors.push(shape.colors[i]);
                kept.push(bindings[i]);
                part.positions.len() as u32 - 1
            }));
        }
    }
    (part, kept)
}

/// The figure at the origin with the walker's animation.
pub fn file() -> Vec<u8> {
    let (body, bindings) = skinned(&parts(), 0.05);
    let is_robe = |color: [u8; 3]| color == [255; 3];
    let (flesh, flesh_bindings) = part_of(&body, &bindings, |color| !is_robe(color));
    let (mut robe, mut robe_bindings) = part_of(&body, &bindings, is_robe);
    robe.colors.iter_mut().for_each(|color| *color = color.map(|c| c.max(200)));
    for (extra, bound) in [skirt(), hood()] {
        let first = robe.positions.len() as u32;
        robe_bindings.extend(bound);
        robe.indices.extend(extra.indices.iter().map(|i| i + first));
        robe.positions.extend(extra.positions);
        robe.normals.extend(extra.normals);
        robe.colors.extend(extra.colors);
        robe.uvs.extend(extra.uvs);
    }
    let mut glb = Glb::default();
    let skin = glb.material(&Look { name: "skin", color: [1.0; 3], roughness: 0.8, ..Look::default() });
    let cloth = glb.material(&Look { name: "robe", color: [0.5, 0.42, 0.32], roughness: 0.9, ..Look::default() });
    let mesh = glb.mesh("pilgrim", &[(flesh, skin), (robe, cloth)], &[&flesh_bindings, &robe_bindings]);
    show_walking(&mut glb, "pilgrim", mesh);
    glb.finish()
}
