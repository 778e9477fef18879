//! The walker: a traveller in a hat and a cape, skinned to [`super::skeleton`].
//!
//! The body is the zero surface of smoothly joined round cones, made into triangles by surface
//! nets (Gibson, "Constrained Elastic Surface Nets", 1998, without the elastic): one closed mesh.
//! Each vertex hangs on the bones whose cones are near it.

use std::collections::HashMap;

use glam::{DMat4, DQuat, DVec2, DVec3, IVec3};
use serde_json::json;

use super::glb::{Binding, Glb, Look};
use super::math::turn;
use super::skeleton::{CHEST, HEAD, JOINTS, LEFT_ARM, LEFT_THIGH, PELVIS, PERIOD, RIGHT_ARM, RIGHT_THIGH, SPINE, gait};
use super::soup::{Shape, lathe};

/// A cone with round ends that moves with a joint.
pub struct Part {
    pub joint: usize,
    /// Its ends, and how thick it is there.
    pub from: (DVec3, f64),
    pub to: (DVec3, f64),
    /// Scales z before measuring: flat chests, long feet.
    pub flat: f64,
    pub color: [f64; 3],
}

pub const SKIN: [f64; 3] = [0.50, 0.27, 0.16];
const SHIRT: [f64; 3] = [0.17, 0.11, 0.07];
const TROUSERS: [f64; 3] = [0.09, 0.12, 0.19];
pub const BOOTS: [f64; 3] = [0.10, 0.055, 0.03];

fn parts() -> Vec<Part> {
    let v = DVec3::new;
    let mut parts = Vec::new();
    let mut part = |joint, from: (DVec3, f64), to: (DVec3, f64), flat, color| parts.push(Part { joint, from, to, flat, color });
    part(PELVIS, (v(-0.06, 0.94, 0.0), 0.115), (v(0.06, 0.94, 0.0), 0.115), 1.12, TROUSERS);
    part(SPINE, (v(0.0, 1.02, 0.0), 0.125), (v(0.0, 1.14, 0.0), 0.120), 1.2, SHIRT);
    part(CHEST, (v(0.0, 1.18, 0.0), 0.125), (v(0.0, 1.31, 0.01), 0.135), 1.2, SHIRT);
    part(CHEST, (v(-0.10, 1.38, 0.0), 0.078), (v(0.10, 1.38, 0.0), 0.078), 1.0, SHIRT);
    part(HEAD, (v(0.0, 1.42, 0.0), 0.056), (v(0.0, 1.54, 0.01), 0.054), 1.0, SKIN);
    part(HEAD, (v(0.0, 1.59, 0.03), 0.078), (v(0.0, 1.665, 0.012), 0.094), 0.95, SKIN);
    part(HEAD, (v(0.0, 1.60, 0.115), 0.012), (v(0.0, 1.575, 0.125), 0.018), 1.0, SKIN); // a nose
    for (arm, side) in [(LEFT_ARM, 1.0), (RIGHT_ARM, -1.0)] {
        let (shoulder, elbow) = (JOINTS[arm].2, JOINTS[arm + 1].2);
        let down = (elbow - shoulder).normalize();
        part(arm, (shoulder, 0.066), (elbow, 0.044), 1.0, SHIRT);
        part(arm + 1, (elbow, 0.045), (elbow + down * 0.24, 0.032), 1.0, SHIRT);
        part(arm + 1, (elbow + down * 0.265, 0.031), (elbow + down * 0.37 + v(-0.012 * side, 0.0, 0.01), 0.036), 0.85, SKIN);
    }
    for thigh in [LEFT_THIGH, RIGHT_THIGH] {
        let (hip, knee, ankle) = (JOINTS[thigh].2, JOINTS[thigh + 1].2, JOINTS[thigh + 2].2);
        part(thigh, (hip - DVec3::Y * 0.03, 0.092), (knee, 0.062), 0.95, TROUSERS);
        part(thigh + 1, (knee, 0.060), (knee + v(0.0, -0.13, -0.012), 0.062), 1.0, TROUSERS);
        part(thigh + 1, (knee + v(0.0, -0.13, -0.012), 0.060), (ankle + DVec3::Y * 0.02, 0.043), 1.0, BOOTS);
        part(thigh + 2, (ankle + v(0.0, -0.03, -0.03), 0.052), (ankle + v(0.0, -0.046, 0.13), 0.042), 1.0, BOOTS);
    }
    parts
}

impl Part {
    fn distance(&self, p: DVec3) -> f64 {
        let flatten = DVec3::new(1.0, 1.0, self.flat);
        let (p, a, b) = (p * flatten, self.from.0 * flatten, self.to.0 * flatten);
        let axis = b - a;
        let t = ((p - a).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
        p.distance(a + axis * t) - (self.from.1 + (self.to.1 - self.from.1) * t)
    }
}

/// Distance to the whole body, seams rounded; the soles are flat at the ground.
fn body(parts: &[Part], p: DVec3) -> f64 {
    const ROUND: f64 = 0.035;
    let mut d = f64::INFINITY;
    for part in parts {
        let other = part.distance(p);
        let h = ((ROUND - (d - other).abs()) / ROUND).max(0.0);
        d = d.min(other) - h * h * ROUND * 0.25;
    }
    d.max(0.002 - p.y)
}

fn gradient(f: &impl Fn(DVec3) -> f64, p: DVec3) -> DVec3 {
    const E: f64 = 1e-4;
    DVec3::from_array(std::array::from_fn(|i| {
        let mut step = DVec3::ZERO;
        step[i] = E;
        (f(p + step) - f(p - step)) / (2.0 * E)
    }))
}

/// The zero surface of `f`: a vertex in every cell that it passes, a quad across every edge.
fn surface_nets(f: &impl Fn(DVec3) -> f64, low: DVec3, cells: IVec3, size: f64) -> Shape {
    let at = |c: IVec3| low + c.as_dvec3() * size;
    let corner = |c: IVec3| (c.x * (cells.y + 1) + c.y) as usize * (cells.z as usize + 1) + c.z as usize;
    let mut values = vec![0.0; ((cells.x + 1) * (cells.y + 1) * (cells.z + 1)) as usize];
    let all =
        |end: IVec3| (0..end.x).flat_map(move |x| (0..end.y).flat_map(move |y| (0..end.z).map(move |z| IVec3::new(x, y, z))));
    for c in all(cells + 1) {
        values[corner(c)] = f(at(c));
    }
    let value = |c: IVec3| values[corner(c)];
    let offset = |i: i32| IVec3::new(i & 1, i >> 1 & 1, i >> 2 & 1);
    let mut shape = Shape::default();
    let mut vertex: HashMap<IVec3, u32> = HashMap::new();
    for c in all(cells) {
        let (mut sum, mut count) = (DVec3::ZERO, 0.0);
        for i in 0..8 {
            for bit in [1, 2, 4] {
                let (a, b) = (c + offset(i), c + offset(i | bit));
                let (va, vb) = (value(a), value(b));
                if i & bit == 0 && (va < 0.0) != (vb < 0.0) {
                    sum += at(a).lerp(at(b), va / (va - vb));
                    count += 1.0;
                }
            }
        }
        if count == 0.0 {
            continue;
        }
        // Onto the surface, but no farther than the cell is wide.
        let mut p = sum / count;
        for _ in 0..3 {
            let g = gradient(f, p);
            p -= (g * f(p) / g.length_squared().max(0.25)).clamp_length_max(size * 0.3);
        }
        vertex.insert(c, shape.positions.len() as u32);
        shape.positions.push(p);
        shape.normals.push(gradient(f, p).normalize());
    }
    for c in all(cells) {
        for axis in 0..3 {
            let mut unit = IVec3::ZERO;
            unit[axis] = 1;
            let (va, vb) = (value(c), value(c + unit));
            if (va < 0.0) == (vb < 0.0) {
                continue;
            }
            let (mut u, mut v) = (IVec3::ZERO, IVec3::ZERO);
            u[(axis + 1) % 3] = 1;
            v[(axis + 2) % 3] = 1;
            let mut quad = [c - u - v, c - v, c, c - u].map(|cell| vertex.get(&cell).copied().unwrap_or_default());
            if va >= 0.0 {
                quad.reverse();
            }
            // The shorter diagonal bends less.
            let [a, b, c, d] = quad;
            let long = |i: u32, j: u32| shape.positions[i as usize].distance_squared(shape.positions[j as usize]);
            shape.indices.extend(if long(a, c) <= long(b, d) { [a, b, c, a, c, d] } else { [b, c, d, b, d, a] });
        }
    }
    shape
}

/// The four nearest joints, nearer ones weighing much more.
fn bind(parts: &[Part], p: DVec3) -> Binding {
    let mut near = [0.0_f64; JOINTS.len()];
    for part in parts {
        let d = part.distance(p).max(0.0) + 0.022;
        near[part.joint] = near[part.joint].max(1.0 / (d * d * d * d));
    }
    let mut order: Vec<usize> = (0..JOINTS.len()).collect();
    order.sort_by(|&a, &b| near[b].total_cmp(&near[a]));
    let total: f64 = order[..4].iter().map(|&j| near[j]).sum();
    (std::array::from_fn(|i| order[i] as u8), std::array::from_fn(|i| (near[order[i]] / total) as f32))
}

fn paint(color: [f64; 3]) -> [u8; 3] {
    color.map(|c| (c * 255.0).round() as u8)
}

/// The body's surface, a vertex about every `size` metres, and what its vertices hang on.
pub fn skinned(parts: &[Part], size: f64) -> (Shape, Vec<Binding>) {
    let f = |p: DVec3| body(parts, p);
    let cells = |metres: f64| (metres / size).round() as i32;
    let cells = IVec3::new(cells(1.296), cells(1.872), cells(0.432));
    let low = DVec3::new(-0.5 * size * f64::from(cells.x), -0.0205, -0.190);
    let mut shape = surface_nets(&f, low, cells, size);
    let nearest = |p: DVec3| parts.iter().min_by(|a, b| a.distance(p).total_cmp(&b.distance(p))).map_or(SKIN, |part| part.color);
    shape.colors = shape.positions.iter().map(|&p| paint(nearest(p))).collect();
    shape.uvs = vec![DVec2::ZERO; shape.positions.len()];
    let bindings = shape.positions.iter().map(|&p| bind(parts, p)).collect();
    (shape, bindings)
}

/// A brim that droops all round, and a crown with a dent.
fn hat() -> Shape {
    let profile: Vec<DVec2> = [
        (0.0, 1.700),
        (0.100, 1.700),
        (0.24, 1.688),
        (0.262, 1.692),
        (0.262, 1.704),
        (0.24, 1.708),
        (0.112, 1.716),
        (0.104, 1.75),
        (0.096, 1.805),
        (0.075, 1.832),
        (0.04, 1.832),
        (0.0, 1.822),
    ]
    .map(DVec2::from)
    .to_vec();
    lathe(&profile, 24, |p, _| p.x)
        .map(|p| {
            let brim = ((p.x * p.x + p.z * p.z).sqrt() - 0.11).max(0.0) / 0.15;
            DVec3::new(p.x * 0.88, p.y - brim * 0.028 - 0.02 * p.z, p.z * 0.96 + 0.015)
        })
        .painted(|p| if p.y > 1.708 && p.y < 1.755 { [0.20, 0.05, 0.03] } else { [0.24, 0.17, 0.10] })
        .creased(0.7)
}

/// A bell about the shoulders, in folds, with a thickness of a centimetre.
fn cape() -> Shape {
    let outside = [
        (0.300, 1.03),
        (0.288, 1.10),
        (0.272, 1.20),
        (0.248, 1.30),
        (0.215, 1.385),
        (0.165, 1.435),
        (0.11, 1.468),
        (0.078, 1.51),
    ];
    let inside = [
        (0.066, 1.51),
        (0.098, 1.455),
        (0.153, 1.422),
        (0.203, 1.372),
        (0.236, 1.29),
        (0.260, 1.20),
        (0.276, 1.10),
        (0.288, 1.03),
        (0.300, 1.03),
    ];
    let profile: Vec<DVec2> = outside.iter().chain(&inside).copied().map(DVec2::from).collect();
    lathe(&profile, 36, |p, turns| p.x * (1.0 + 0.035 * ((1.42 - p.y) / 0.4).clamp(0.0, 1.0) * turn(turns * 9.0).x))
        .map(|p| DVec3::new(p.x * 1.13, p.y, p.z * 0.90 + 0.005))
        .painted(|p| if p.y < 1.055 { [0.42, 0.25, 0.07] } else { [0.30, 0.035, 0.03] })
        .creased(0.6)
}

/// The figure at the origin with an animation `walk` that stays on the spot.
pub fn file() -> Vec<u8> {
    let (mut shape, mut binding) = skinned(&parts(), 0.036);
    for (extra, joint) in [(hat(), HEAD), (cape(), CHEST)] {
        let first = shape.positions.len() as u32;
        binding.extend(extra.positions.iter().map(|_| ([joint as u8, 0, 0, 0], [1.0, 0.0, 0.0, 0.0])));
        shape.indices.extend(extra.indices.iter().map(|i| i + first));
        shape.positions.extend(extra.positions);
        shape.normals.extend(extra.normals);
        shape.colors.extend(extra.colors);
        shape.uvs.extend(extra.uvs);
    }
    let mut glb = Glb::default();
    let cloth = glb.material(&Look { name: "cloth", color: [1.0; 3], roughness: 0.8, ..Look::default() });
    let mesh = glb.mesh("walker", &[(shape, cloth)], &[&binding]);
    show_walking(&mut glb, "walker", mesh);
    glb.finish()
}

/// A node that shows the skinned mesh, its bones, and the animation that moves them.
pub fn show_walking(glb: &mut Glb, name: &str, mesh: usize) {
    for (i, (name, parent, place)) in JOINTS.iter().enumerate() {
        let local = *place - parent.map_or(DVec3::ZERO, |parent| JOINTS[parent].2);
        let children: Vec<usize> = (0..JOINTS.len()).filter(|&j| JOINTS[j].1 == Some(i)).collect();
        let mut node = json!({"name": name, "translation": local.as_vec3().to_array()});
        if !children.is_empty() {
            node["children"] = json!(children);
        }
        glb.node(node);
    }
    let joints: Vec<usize> = (0..JOINTS.len()).collect();
    let inverse_bind = JOINTS.map(|(_, _, place)| DMat4::from_translation(-place));
    let skin = glb.skin(&joints, &inverse_bind);
    glb.node(json!({"name": name, "mesh": mesh, "skin": skin}));

    const KEYS: usize = 32;
    let times: Vec<f32> = (0..=KEYS).map(|k| (PERIOD * k as f64 / KEYS as f64) as f32).collect();
    let stances: Vec<_> = (0..=KEYS).map(|k| gait((k % KEYS) as f64 / KEYS as f64)).collect();
    let rotations: Vec<(usize, Vec<DQuat>)> =
        joints.iter().map(|&j| (j, stances.iter().map(|s| s.rotations[j]).collect())).collect();
    let places: Vec<DVec3> = stances.iter().map(|s| s.pelvis).collect();
    glb.animation("walk", &times, &rotations, &[(PELVIS, places)]);
}
