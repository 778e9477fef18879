//! Where a mesh's vertices go when it swells: one direction for each welded vertex, so that nothing tears.
//!
//! It is the mean of the normals about the vertex, each weighted by its angle there (Thürmer and Wüthrich 1998): hard
//! edges and smooth ones alike. Along an open edge the way out of the triangle, in its own plane, is added, so that
//! sheets swell too.

use std::collections::HashSet;
use std::f32::consts::FRAC_PI_2;

use glam::Vec3;

/// For each welded vertex a unit vector, or zero where nothing says which way is out. `triangles` are welded vertices,
/// counter-clockwise from outside.
#[must_use]
pub fn directions(triangles: impl Iterator<Item = [u32; 3]> + Clone, welded: &[Vec3]) -> Vec<Vec3> {
    let mut ways = vec![Vec3::ZERO; welded.len()];
    let edges = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]];
    let there: HashSet<[u32; 2]> = triangles.clone().flat_map(edges).collect();
    for triangle in triangles {
        let [a, b, c] = triangle.map(|vertex| welded[vertex as usize]);
        let Some(normal) = (b - a).cross(c - a).try_normalize() else { continue };
        for (corner, (to, from)) in [(b - a, c - a), (c - b, a - b), (a - c, b - c)].into_iter().enumerate() {
            ways[triangle[corner] as usize] += normal * to.angle_between(from);
        }
        for [from, to] in edges(triangle).into_iter().filter(|&[from, to]| !there.contains(&[to, from])) {
            let along = welded[to as usize] - welded[from as usize];
            let beside = along.cross(normal).normalize_or_zero() * FRAC_PI_2;
            ways[from as usize] += beside;
            ways[to as usize] += beside;
        }
    }
    ways.into_iter().map(Vec3::normalize_or_zero).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cube_s_corners_go_out_along_its_diagonals() {
        let corners: Vec<Vec3> =
            (0..8usize).map(|i| Vec3::from_array([0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 1.0 } else { -1.0 }))).collect();
        let quads: [[u32; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
        let ways = directions(triangles, &corners);
        assert!(ways.iter().zip(&corners).all(|(way, corner)| way.distance(corner.normalize()) < 1e-5), "{ways:?}");
    }

    #[test]
    fn a_sheet_grows_in_its_own_plane() {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y];
        let ways = directions([[0, 1, 2], [0, 2, 3]].into_iter(), &corners);
        for (way, corner) in ways.iter().zip(corners) {
            let out = corner - Vec3::new(0.5, 0.5, 0.0);
            assert!(way.z > 0.1 && way.x * out.x > 0.0 && way.y * out.y > 0.0, "{way}");
        }
    }

    #[test]
    fn what_has_no_area_says_nothing() {
        assert_eq!(directions([[0, 1, 1]].into_iter(), &[Vec3::ZERO, Vec3::X]), [Vec3::ZERO; 2]);
    }
}
