//! Polygons cut by planes (Sutherland and Hodgman, "Reentrant Polygon Clipping", 1974), and outlines on
//! screen.

use glam::{DVec2, DVec3, DVec4};

use super::planar::height;

/// What of a convex polygon, its corners in order, lies on or over all of `planes` (as in
/// [`super::planar`], not necessarily unit); empty where nothing does. All corners that are left are corners
/// of it or lie on its edges.
#[must_use]
pub fn clipped(polygon: &[DVec3], planes: &[DVec4]) -> Vec<DVec3> {
    let (mut kept, mut next) = (polygon.to_vec(), Vec::with_capacity(polygon.len() + planes.len()));
    for &plane in planes {
        next.clear();
        for (index, &corner) in kept.iter().enumerate() {
            let before = kept[(index + kept.len() - 1) % kept.len()];
            let (at, at_before) = (height(plane, corner), height(plane, before));
            if (at >= 0.0) != (at_before >= 0.0) {
                next.push(before + (corner - before) * (at_before / (at_before - at)));
            }
            if at >= 0.0 {
                next.push(corner);
            }
        }
        std::mem::swap(&mut kept, &mut next);
        if kept.is_empty() {
            break;
        }
    }
    kept
}

/// The same in two dimensions: what of a convex polygon lies where `a x + b y + c >= 0`.
pub(super) fn cut(polygon: &[DVec2], line: DVec3) -> Vec<DVec2> {
    let flat: Vec<DVec3> = polygon.iter().map(|corner| corner.extend(0.0)).collect();
    clipped(&flat, &[DVec4::new(line.x, line.y, 0.0, line.z)]).into_iter().map(DVec3::truncate).collect()
}

/// Twice the area that turns from `a` to `b`: positive where `b` lies to the left of `a`, the y axis up.
pub(super) fn turn(a: DVec2, b: DVec2) -> f64 {
    a.perp_dot(b)
}

/// The area of a polygon whose corners are in order, positive counter-clockwise with the y axis up.
pub(crate) fn area(polygon: &[DVec2]) -> f64 {
    let Some(&first) = polygon.first() else { return 0.0 };
    let from_first = polygon.array_windows().map(|&[a, b]| turn(a - first, b - first));
    from_first.sum::<f64>() / 2.0
}

/// The corners of the smallest convex polygon about `points`, counter-clockwise with the y axis up (Andrew's
/// monotone chain); two corners where all lie on a line, one where all are one. Sorts `points`.
pub(crate) fn hull(points: &mut Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    if points.len() < 3 {
        return points.clone();
    }
    let mut corners: Vec<DVec2> = Vec::with_capacity(2 * points.len());
    for backwards in [false, true] {
        let start = corners.len();
        for index in 0..points.len() {
            let point = points[if backwards { points.len() - 1 - index } else { index }];
            while let [.., a, b] = corners[start..]
                && turn(b - a, point - a) <= 0.0
            {
                corners.pop();
            }
            corners.push(point);
        }
        corners.pop(); // begins the other chain
    }
    corners
}

/// A convex polygon about another (counter-clockwise, at least three corners) of at most `most` corners (at
/// least 4): edges are left out, those first that make the least of it, and their neighbours extended until
/// they meet.
pub(super) fn simplified(mut polygon: Vec<DVec2>, most: usize) -> Vec<DVec2> {
    while polygon.len() > most {
        let count = polygon.len();
        let corner = |index: usize| polygon[index % count];
        let without = |index: usize| {
            let [a, b, c, d] = [0, 1, 2, 3].map(|step| corner(index + step));
            let along = turn(b - a, d - c);
            // The neighbours part where they turn by half a circle or more.
            let far = turn(c - b, d - c) / along;
            let meeting = b + (b - a) * far;
            (along > 0.0 && meeting.is_finite()).then(|| (turn(c - b, meeting - b).abs(), index, meeting))
        };
        let Some((_, index, meeting)) = (0..count).filter_map(without).min_by(|a, b| a.0.total_cmp(&b.0)) else { break };
        polygon[(index + 1) % count] = meeting;
        polygon.remove((index + 2) % count);
    }
    polygon
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit_square() -> Vec<DVec2> {
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(DVec2::from).to_vec()
    }

    #[test]
    fn planes_cut_off_what_is_under_them() {
        let square: Vec<DVec3> = unit_square().iter().map(|corner| corner.extend(0.0)).collect();
        let left = DVec4::new(-1.0, 0.0, 0.0, 0.25);
        assert_eq!(area(&clipped(&square, &[left]).iter().map(|p| p.truncate()).collect::<Vec<_>>()), 0.25);
        let edge = clipped(&square, &[left, -left]);
        assert!(!edge.is_empty() && edge.iter().all(|corner| corner.x == 0.25), "on both planes: an edge is left");
        assert!(clipped(&square, &[left, DVec4::new(1.0, 0.0, 0.0, -0.3)]).is_empty());
        assert_eq!(clipped(&square, &[]), square);
        assert!(clipped(&[], &[left]).is_empty());
    }

    #[test]
    fn hulls_hold_corners_only() {
        let mut points = unit_square();
        points.extend([[0.5, 0.5], [0.5, 0.0], [1.0, 1.0], [0.0, 0.3]].map(DVec2::from));
        assert_eq!(hull(&mut points), unit_square());
        let mut line = vec![DVec2::ZERO, DVec2::ONE, DVec2::splat(0.3)];
        assert_eq!(hull(&mut line), [DVec2::ZERO, DVec2::ONE]);
        assert_eq!(hull(&mut vec![DVec2::ONE; 3]), [DVec2::ONE]);
    }

    #[test]
    fn fewer_corners_hold_all_there_was() {
        let round: Vec<DVec2> = (0..23).map(|i| DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / 23.0)).collect();
        for most in [4, 5, 8, 22] {
            let fewer = simplified(round.clone(), most);
            assert_eq!(fewer.len(), most);
            for (index, &a) in fewer.iter().enumerate() {
                let b = fewer[(index + 1) % most];
                assert!(round.iter().all(|&point| turn(b - a, point - a) > -1e-12), "{most}");
            }
            assert!(area(&fewer) < area(&round) * 1.4, "{most}: {}", area(&fewer));
        }
        assert_eq!(simplified(round.clone(), 30), round);
    }
}
