//! How many triangles of one side lie over a pixel, one behind the other: a bound that never says too little.
//!
//! Every triangle is clipped at the near plane and projected, and counts for each pixel whose centre is no farther from
//! it than a rasteriser's grid could move it. Where triangles join, a pixel may so be counted twice; and where the bound
//! is too large, a step is drawn that meets nothing.

use glam::{DMat4, DVec2, DVec4};

/// How far a rasteriser may move a corner, pixels, with room to spare: to the nearest 256th.
const GRID: f64 = 1.0 / 64.0;

/// Which triangles are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Side {
    /// Those whose corners run counter-clockwise on screen.
    pub counter_clockwise: bool,
}

/// For each layer, the pixels (x, y, width, height from the top left) that hold all places where so many triangles of
/// the side lie over one another: the first holds all, and the last what the deepest place has. No layers where nothing
/// is on screen. `triangles` are corners in object space; only pixels within `rect` matter.
#[must_use]
pub fn layers(
    triangles: impl Iterator<Item = [DVec4; 3]>,
    clip_from_object: &DMat4,
    near: f64,
    size: [u32; 2],
    rect: [u32; 4],
    side: Side,
) -> Vec<[u32; 4]> {
    let [left, top, width, height] = rect;
    let mut counts = vec![0u16; width as usize * height as usize];
    let half = DVec2::new(f64::from(size[0]), f64::from(size[1])) / 2.0;
    for corners in triangles {
        let clipped = before_near(corners.map(|corner| *clip_from_object * corner), near);
        let polygon: Vec<DVec2> = clipped
            .iter()
            .map(|clip| (DVec2::new(clip.x, -clip.y) / clip.w + 1.0) * half - DVec2::new(f64::from(left), f64::from(top)))
            .collect();
        if polygon.len() < 3 {
            continue;
        }
        // Twice the area, counter-clockwise as people see it: down is +Y here.
        let doubled: f64 = (0..polygon.len()).map(|i| polygon[(i + 1) % polygon.len()].perp_dot(polygon[i])).sum();
        let extent = polygon.iter().fold(DVec2::ZERO, |most, corner| most.max((*corner - polygon[0]).abs())).max_element();
        // What is all but edge-on may be drawn as either side.
        let flat = doubled.abs() <= 4.0 * GRID * (extent + 1.0);
        if flat || (doubled > 0.0) == side.counter_clockwise {
            count(&polygon, doubled, [width, height], &mut counts);
        }
    }
    let deepest = counts.iter().copied().max().unwrap_or(0);
    let mut rects = Vec::new();
    for layer in 0..deepest {
        let deep = |&(at, count): &(usize, &u16)| (*count > layer).then_some(at).is_some();
        let (mut low, mut high) = ([u32::MAX; 2], [0; 2]);
        for (at, _) in counts.iter().enumerate().filter(deep) {
            #[expect(clippy::cast_possible_truncation, reason = "a pixel's number")]
            let at = [at as u32 % width, at as u32 / width];
            for axis in 0..2 {
                low[axis] = low[axis].min(at[axis]);
                high[axis] = high[axis].max(at[axis] + 1);
            }
        }
        rects.push([left + low[0], top + low[1], high[0] - low[0], high[1] - low[1]]);
    }
    rects
}

/// A triangle in clip space without what lies before the near plane.
fn before_near(corners: [DVec4; 3], near: f64) -> Vec<DVec4> {
    let mut kept = Vec::with_capacity(4);
    for (at, from) in corners.iter().enumerate() {
        let to = corners[(at + 1) % 3];
        let (here, there) = (from.w - near, to.w - near);
        if here >= 0.0 {
            kept.push(*from);
        }
        if (here >= 0.0) != (there >= 0.0) {
            kept.push(*from + (to - *from) * (here / (here - there)));
        }
    }
    kept
}

/// One more for each pixel whose centre lies in a convex polygon, or a hair beside it. Pixels from the rectangle's corner.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the picture")]
fn count(polygon: &[DVec2], doubled: f64, [width, height]: [u32; 2], counts: &mut [u16]) {
    let low = polygon.iter().fold(DVec2::MAX, |low, corner| low.min(*corner)) - GRID;
    let high = polygon.iter().fold(DVec2::MIN, |high, corner| high.max(*corner)) + GRID;
    let first = |at: f64, most: u32| (at - 0.5).ceil().clamp(0.0, f64::from(most)) as usize;
    let last = |at: f64, most: u32| ((at - 0.5).floor() + 1.0).clamp(0.0, f64::from(most)) as usize;
    // Inward normal and offset of each edge, moved out by the grid.
    let inward = if doubled > 0.0 { -1.0 } else { 1.0 };
    let edge = |at: usize| {
        let (from, to) = (polygon[at], polygon[(at + 1) % polygon.len()]);
        let normal = (to - from).perp().normalize_or_zero() * inward;
        (normal, GRID - normal.dot(from))
    };
    let edges: Vec<_> = (0..polygon.len()).map(edge).collect();
    for y in first(low.y, height)..last(high.y, height) {
        let middle = y as f64 + 0.5;
        let (mut from, mut to) = (low.x, high.x);
        for (normal, offset) in &edges {
            let rest = normal.y * middle + offset;
            if normal.x.abs() < 1e-12 {
                if rest < 0.0 {
                    to = f64::NEG_INFINITY;
                }
            } else if normal.x > 0.0 {
                from = from.max(-rest / normal.x);
            } else {
                to = to.min(-rest / normal.x);
            }
        }
        if from <= to {
            let row = &mut counts[y * width as usize..(y + 1) * width as usize];
            let (from, to) = (first(from, width), last(to, width));
            row.get_mut(from..to).into_iter().flatten().for_each(|count| *count = count.saturating_add(1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::camera::DEFAULT_NEAR;

    /// The right angle at the upper left, `deep` metres before the eye, covering a quarter of what lies right and below.
    fn stack(depths: &[f64]) -> Vec<[DVec4; 3]> {
        let corner = |x: f64, y: f64, depth: f64| DVec4::new(x * depth, y * depth, -depth, 1.0);
        depths.iter().map(|&depth| [corner(0.0, 0.0, depth), corner(0.0, -0.5, depth), corner(0.5, 0.0, depth)]).collect()
    }

    fn seen(triangles: &[[DVec4; 3]], counter_clockwise: bool) -> Vec<[u32; 4]> {
        // One metre to the side is the picture's edge, one metre before the eye.
        let clip_from_object =
            DMat4::from_cols(DVec4::X, DVec4::Y, DVec4::new(0.0, 0.0, 0.0, -1.0), DVec4::new(0.0, 0.0, DEFAULT_NEAR, 0.0));
        let side = Side { counter_clockwise };
        layers(triangles.iter().copied(), &clip_from_object, DEFAULT_NEAR, [40, 40], [0, 0, 40, 40], side)
    }

    #[test]
    fn layers_are_as_many_as_the_deepest_pixel_has() {
        assert_eq!(seen(&stack(&[1.0]), true), [[20, 20, 10, 10]]);
        assert_eq!(seen(&stack(&[1.0, 2.0, 5.0]), true), [[20, 20, 10, 10]; 3]);
        assert!(seen(&stack(&[1.0, 2.0]), false).is_empty(), "all face the eye");
        assert!(seen(&stack(&[0.5 * DEFAULT_NEAR, -3.0]), true).is_empty(), "before the near plane, and behind the eye");
        let moved: Vec<_> = stack(&[1.0]).iter().map(|t| t.map(|corner| corner + DVec4::new(0.3, 0.0, 0.0, 0.0))).collect();
        let both = [stack(&[1.0]), moved].concat();
        assert_eq!(seen(&both, true)[0], [20, 20, 16, 10]);
        assert_eq!(seen(&both, true)[1][0], 26, "they overlap from there on");
    }

    #[test]
    fn what_crosses_the_near_plane_counts_as_far_as_it_is_seen() {
        let mut triangle = stack(&[1.0]);
        triangle[0][0] = DVec4::new(0.0, 0.0, 1.0, 1.0);
        assert_eq!(seen(&triangle, true).len() + seen(&triangle, false).len(), 1);
    }
}
