//! Windows of coloured panes between leads: sheets that a scene lets shine of themselves.

use glam::{DVec2, DVec3};

use super::math::{hash, turn};
use super::polygon::{arc, extruded};
use super::soup::{Soup, cuboid};

/// Linear colours of glass.
const GLASS: [[f64; 3]; 6] =
    [[0.03, 0.10, 0.55], [0.02, 0.20, 0.62], [0.50, 0.02, 0.05], [0.75, 0.38, 0.04], [0.02, 0.30, 0.14], [0.10, 0.30, 0.75]];
/// Half a lead's width, metres.
const LEAD: f64 = 0.022;

fn pane(soup: &mut Soup, corners: [DVec2; 4], color: [f64; 3]) {
    let centre = corners.iter().sum::<DVec2>() / 4.0;
    let inset = corners.map(|p| p + (centre - p).normalize_or_zero() * LEAD * 1.4);
    let mut pane = Soup::default();
    pane.quad(inset.map(|p| p.extend(0.0)), [DVec2::ZERO; 4]);
    *soup = std::mem::take(soup).and(pane.painted(|_| color));
}

/// Half the width of a pointed window at a height over its springing.
fn half_width(half: f64, above: f64) -> f64 {
    // Two arcs about the opposite springings.
    let radius = 2.0 * half;
    if above <= 0.0 { half } else { (radius * radius - above * above).max(0.0).sqrt() - half }
}

/// A pointed outline, counter-clockwise from the lower left; `spring` is where the arcs start.
pub fn lancet(half: f64, spring: f64, pieces: usize) -> Vec<DVec2> {
    let mut outline = vec![DVec2::new(-half, 0.0), DVec2::new(half, 0.0)];
    outline.extend(arc(DVec2::new(-half, spring), DVec2::splat(2.0 * half), 0.0, 1.0 / 6.0, pieces));
    let left = arc(DVec2::new(half, spring), DVec2::splat(2.0 * half), 1.0 / 3.0, 0.5, pieces);
    outline.extend(left.into_iter().skip(1));
    outline
}

/// A lancet window's panes in `columns`, its back to z = 0, seen from +z; `seed` chooses colours.
pub fn lancet_panes(half: f64, spring: f64, columns: usize, rows: usize, seed: u64) -> Soup {
    let top = spring + 3.0_f64.sqrt() * half * 0.93;
    let mut soup = Soup::default();
    for row in 0..rows {
        let (low, high) = (top * row as f64 / rows as f64, top * (row + 1) as f64 / rows as f64);
        for column in 0..columns {
            let at = |c: usize, y: f64| DVec2::new(half_width(half, y - spring) * (2.0 * c as f64 / columns as f64 - 1.0), y);
            let middle = 2 * column + 1 == columns;
            let pick = hash(row as i64, (column as i64 * 2 - columns as i64 + 1).abs(), seed);
            let glass = if middle { GLASS[2 + (pick * 3.0) as usize % 3] } else { GLASS[(pick * 6.0) as usize % 6] };
            let light = 0.55 + 0.6 * hash(row as i64, column as i64, seed + 1);
            let corners = [at(column, low), at(column + 1, low), at(column + 1, high), at(column, high)];
            pane(&mut soup, corners, glass.map(|c| c * light));
        }
    }
    soup
}

/// A rose: rings of panes about the origin, seen from +z.
pub fn rose_panes(radius: f64) -> Soup {
    let mut soup = Soup::default();
    // From where to where, in how many petals of which glass; a petal bulges outwards.
    let rings: [(f64, f64, f64, usize, &[usize]); 4] = [
        (0.02, 0.20, 0.20, 8, &[3]),
        (0.24, 0.58, 0.63, 8, &[2, 0]),
        (0.65, 0.80, 0.80, 16, &[1, 3]),
        (0.82, 0.98, 0.98, 24, &[0, 2, 5]),
    ];
    for (inner, outer, bulge, petals, glass) in rings {
        for k in 0..petals {
            let at = |turns: f64, r: f64| turn((k as f64 + turns) / petals as f64) * r * radius;
            let light = 0.75 + 0.45 * hash(k as i64, petals as i64, 140);
            let color = GLASS[glass[k % glass.len()]].map(|c| c * light);
            // Seen from +z, angles grow counter-clockwise.
            let (low, high) = (at(0.5, inner), at(0.5, bulge));
            pane(&mut soup, [at(0.0, inner), at(0.0, outer), high, low], color.map(|c| c * 0.9));
            pane(&mut soup, [low, high, at(1.0, outer), at(1.0, inner)], color);
        }
    }
    soup
}

/// A stone frame about a lancet, with a mullion; its back at z = 0.
pub fn lancet_frame(half: f64, spring: f64, width: f64, depth: f64, mullion: bool) -> Soup {
    let inner = lancet(half, spring, 4);
    let outer: Vec<DVec2> = {
        // The same arcs about the same centres, farther out; open at the sill.
        let mut outline = vec![DVec2::new(-half - width, -width), DVec2::new(half + width, -width)];
        outline.extend(arc(DVec2::new(-half, spring), DVec2::splat(2.0 * half + width), 0.0, 0.158, 4));
        outline.push(DVec2::new(0.0, spring + ((2.0 * half + width) * (2.0 * half + width) - half * half).sqrt()));
        outline.extend(arc(DVec2::new(half, spring), DVec2::splat(2.0 * half + width), 0.5 - 0.158, 0.5, 4));
        outline
    };
    let frame = extruded(&outer, &[inner], depth).moved(0.0, 0.0, depth / 2.0);
    if !mullion {
        return frame;
    }
    let height = spring + 1.0 * half;
    frame.and(cuboid(DVec3::new(0.09, height, depth * 0.7), 0.0).moved(0.0, height / 2.0, depth * 0.35))
}
