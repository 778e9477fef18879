//! What rooms are built of: boxes, turned wood, walls, picture frames and the mirrors in them.
//!
//! Nothing here lies in the plane of something else. A pane stands before the board it is glued to and
//! reaches into its frame, boards reach into the wall: surfaces cross, and none is ambiguous.

use std::f32::consts::TAU;

use glam::Vec3;

use super::compose::{Composer, Place, Prop, at};
use crate::scene::Reflective;

/// What stands on a floor that reflects stands this deep in it, metres: no face lies on the mirror.
pub(super) const SUNK: f64 = 0.004;

/// A middle and a size.
type Box3 = ([f32; 3], [f32; 3]);

/// Appends a box, outward.
pub(super) fn cuboid(least: Vec3, most: Vec3, positions: &mut Vec<Vec3>, triangles: &mut Vec<[u32; 3]>) {
    let first = positions.len() as u32;
    let corner = |i: usize| Vec3::from_array(std::array::from_fn(|axis| [least, most][i >> axis & 1][axis]));
    positions.extend((0..8).map(corner));
    let quads: [[u32; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    triangles.extend(quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|t| t.map(|i| i + first)));
}

/// Boxes, each by its middle and its size, as one solid in one colour.
pub(super) fn boxes(c: &mut Composer, name: &str, list: &[Box3], color: [f32; 3], roughness: f32) -> Prop {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for &(middle, size) in list {
        let (middle, half) = (Vec3::from(middle), Vec3::from(size) / 2.0);
        cuboid(middle - half, middle + half, &mut positions, &mut triangles);
    }
    c.made(name, &positions, &triangles, color, roughness)
}

/// A solid turned about the vertical: radius and height upward, from the axis to the axis, with this many sides.
pub(super) fn turned(c: &mut Composer, name: &str, profile: &[[f32; 2]], sides: u32, color: [f32; 3], roughness: f32) -> Prop {
    let inner = &profile[1..profile.len() - 1];
    let rim = |[radius, y]: [f32; 2]| {
        (0..sides).map(move |side| {
            let (sin, cos) = (side as f32 / sides as f32 * TAU).sin_cos();
            Vec3::new(radius * cos, y, -radius * sin)
        })
    };
    let mut positions: Vec<Vec3> = inner.iter().flat_map(|&point| rim(point)).collect();
    let (bottom, top) = (positions.len() as u32, positions.len() as u32 + 1);
    positions.extend([profile[0], profile[profile.len() - 1]].map(|[_, y]| Vec3::Y * y));
    let mut triangles = Vec::new();
    let last = (inner.len() as u32 - 1) * sides;
    for side in 0..sides {
        let next = (side + 1) % sides;
        triangles.extend([[bottom, next, side], [top, last + side, last + next]]);
        for ring in (0..last).step_by(sides as usize) {
            let (a, b, c, d) = (ring + side, ring + next, ring + sides + next, ring + sides + side);
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    c.made(name, &positions, &triangles, color, roughness)
}

/// The four walls of a room between two heights, seen from inside, about the origin; they cast no shadow.
pub(super) fn walls(c: &mut Composer, name: &str, half: [f32; 2], heights: [f32; 2], color: [f32; 3]) -> Prop {
    let [x, z] = half;
    let ring = [[-x, -z], [x, -z], [x, z], [-x, z]];
    let positions: Vec<Vec3> = heights.iter().flat_map(|&y| ring.map(|[x, z]| Vec3::new(x, y, z))).collect();
    let quad = |side: u32| {
        let next = (side + 1) % 4;
        [[side, next, next + 4], [side, next + 4, side + 4]]
    };
    let triangles: Vec<[u32; 3]> = (0..4).flat_map(quad).collect();
    Composer::shadeless(c.made(name, &positions, &triangles, color, 0.95))
}

/// A ceiling over a room about the origin, seen from below; it casts no shadow.
pub(super) fn ceiling(c: &mut Composer, half: [f32; 2], height: f32, color: [f32; 3]) -> Prop {
    let [x, z] = half;
    let positions = [[-x, -z], [x, -z], [x, z], [-x, z]].map(|[x, z]| Vec3::new(x, height, z));
    Composer::shadeless(c.made("ceiling", &positions, &[[0, 1, 2], [0, 2, 3]], color, 0.95))
}

/// A mirror's glass in the plane z = 0, looking along +Z: a fan about the origin to its outline, counter-clockwise.
/// It casts no shadow; what it is glued to does.
pub(super) fn pane(c: &mut Composer, name: &str, outline: &[[f32; 2]], look: Reflective) -> Prop {
    let positions: Vec<Vec3> = [[0.0, 0.0]].iter().chain(outline).map(|&[x, y]| Vec3::new(x, y, 0.0)).collect();
    let count = outline.len() as u32;
    let triangles: Vec<[u32; 3]> = (0..count).map(|side| [0, 1 + side, 1 + (side + 1) % count]).collect();
    let glass = c.made(name, &positions, &triangles, [0.20, 0.23, 0.25], 0.3);
    Composer::shadeless(c.reflecting(glass, look))
}

/// A frame: what lies between two outlines of equally many corners, the inner one first, both
/// counter-clockwise, from z = 0 to `depth`.
pub(super) fn frame(c: &mut Composer, inner: &[[f32; 2]], outer: &[[f32; 2]], depth: f32, color: [f32; 3]) -> Prop {
    let count = inner.len() as u32;
    let ring = |outline: &[[f32; 2]], z: f32| outline.iter().map(|&[x, y]| Vec3::new(x, y, z)).collect::<Vec<_>>();
    let positions = [ring(inner, 0.0), ring(outer, 0.0), ring(outer, depth), ring(inner, depth)].concat();
    // Seen along the ring, four corners around: inner back, outer back, outer front, inner front.
    let around = |side: u32, corner: u32| corner % 4 * count + side % count;
    let quad = |side: u32, corner: u32| {
        let [a, b] = [around(side, corner), around(side, corner + 1)];
        let [d, e] = [around(side + 1, corner), around(side + 1, corner + 1)];
        [[a, d, e], [a, e, b]]
    };
    let triangles: Vec<[u32; 3]> = (0..count).flat_map(|side| (0..4).flat_map(move |corner| quad(side, corner))).collect();
    c.made("frame", &positions, &triangles, color, 0.45)
}

/// A rectangle about the origin.
pub(super) fn rectangle(width: f32, height: f32) -> [[f32; 2]; 4] {
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| [x * width / 2.0, y * height / 2.0])
}

/// A regular polygon about the origin.
pub(super) fn disc(radius: f32, sides: u32) -> Vec<[f32; 2]> {
    let corner = |side: u32| {
        let (sin, cos) = (side as f32 / sides as f32 * TAU).sin_cos();
        [radius * cos, radius * sin]
    };
    (0..sides).map(corner).collect()
}

/// The outline as many metres larger on each side as `by` says.
fn larger(outline: &[[f32; 2]], by: f32) -> Vec<[f32; 2]> {
    let far = |axis: usize| outline.iter().map(|corner| corner[axis]).fold(0.0, f32::max);
    let grow = |value: f32, axis: usize| value * (1.0 + by / far(axis));
    outline.iter().map(|&[x, y]| [grow(x, 0), grow(y, 1)]).collect()
}

/// A mirror in a frame `border` metres broad, the glass as large as `outline` where it shows. `place` is its middle on
/// the wall, facing into the room.
pub(super) fn hung_mirror(
    c: &mut Composer,
    name: &str,
    place: Place,
    outline: &[[f32; 2]],
    look: Reflective,
    border: f32,
    color: [f32; 3],
) {
    let group = c.group(name, None, place);
    let ring = frame(c, outline, &larger(outline, border), 0.07, color);
    c.put_on(Some(group), "frame", ring, at(0.0, 0.0, -0.01));
    let glass = pane(c, "glass", &larger(outline, 0.4 * border), look);
    c.put_on(Some(group), name, glass, at(0.0, 0.0, 0.03));
}

/// A painting in a frame: a ground with rectangles on it, each by its middle, its size and its colour. `place` is its
/// middle on the wall, facing into the room.
pub(super) fn painting(
    c: &mut Composer,
    name: &str,
    place: Place,
    [width, height]: [f32; 2],
    ground: [f32; 3],
    strokes: &[([f32; 2], [f32; 2], [f32; 3])],
) {
    let group = c.group(name, None, place);
    let outline = rectangle(width, height);
    let ring = frame(c, &outline, &larger(&outline, 0.05), 0.05, [0.05, 0.035, 0.025]);
    c.put_on(Some(group), "frame", ring, at(0.0, 0.0, -0.01));
    let canvas = boxes(c, "canvas", &[([0.0, 0.0, 0.0], [width + 0.04, height + 0.04, 0.04])], ground, 0.9);
    c.put_on(Some(group), "canvas", Composer::shadeless(canvas), at(0.0, 0.0, 0.0));
    for (number, &([x, y], [wide, high], color)) in strokes.iter().enumerate() {
        // Each a hair thicker than the one before, which it may cross.
        let thick = 0.044 + 0.002 * number as f32;
        let stroke = boxes(c, "stroke", &[([x, y, 0.0], [wide, high, thick])], color, 0.8);
        c.put_on(Some(group), "stroke", Composer::shadeless(stroke), at(0.0, 0.0, 0.0));
    }
}

/// A lamp that hangs from the ceiling: a light in a glowing globe on a cord. Gives the light's node.
pub(super) fn pendant(
    c: &mut Composer,
    name: &str,
    [x, y, z]: [f64; 3],
    cord: f64,
    color: [f32; 3],
    (candela, range): (f32, f32),
) -> usize {
    let lamp = c.point_light(name, [x, y, z], color, candela, range);
    let ball = c.prop("small ball");
    let globe = c.glowing(ball, color.map(|part| part * 2.2));
    c.put_on(Some(lamp), &format!("{name}'s globe"), globe, at(0.0, 0.0, 0.0).sized(0.16));
    let line = boxes(c, "cord", &[([0.0, 0.0, 0.0], [0.012, 1.0, 0.012])], [0.03, 0.03, 0.03], 0.8);
    let line = Composer::shadeless(line);
    c.put_on(Some(lamp), &format!("{name}'s cord"), line, at(0.0, cord / 2.0 + 0.07, 0.0).stretched(1.0, cord, 1.0));
    lamp
}
