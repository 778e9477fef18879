//! The terminator bound: how far a smooth normal strays from the facets around it.
//!
//! A shadow volume knows facets, shading knows smooth normals. Between the two, at the terminator
//! of a coarse mesh, lie facets that have turned away from the light (so they are in shadow, all
//! of them, with a zigzag border) while the interpolated normal still sees it. No offset mends
//! that; shading must reach zero first.
//!
//! Let d be the largest angle between a vertex's normal n and the normals of its triangles. Where
//! the angle between n and the light exceeds 90 degrees - d, that is where n.l < sin d, one of the
//! facets may have turned away. So the diffuse term is
//!
//! ```text
//!     max(0, (n.l - sin d) / (1 - sin d))
//! ```
//!
//! which is 1 where it was 1, and 0 wherever a facet of the vertex can be in its own shadow. Flat
//! shading has d = 0 and is left alone. sin d is interpolated over the triangle like the normal.

use glam::Vec3;

/// The largest sine kept: beyond it (72 degrees; spikes and broken normals) the term would shine
/// on almost nothing, and some of the zigzag is the smaller evil.
pub const LARGEST_SINE: f32 = 0.95;

/// sin d of every vertex into `sines` (cleared first), which gets one entry a position. `indices`
/// are three a triangle, in range; `normals` are unit.
pub fn sines(positions: &[Vec3], normals: &[Vec3], indices: &[u32], sines: &mut Vec<f32>) {
    sines.clear();
    sines.resize(positions.len(), 0.0);
    for triangle in indices.as_chunks::<3>().0 {
        let Some(face) = face_normal(triangle.map(|vertex| positions[vertex as usize])) else { continue };
        for vertex in triangle.map(|vertex| vertex as usize) {
            let normal = normals[vertex];
            // The cross product, not the root of 1 - cos^2: small angles keep their digits.
            let sine = if normal.dot(face) > 0.0 { normal.cross(face).length() } else { 1.0 };
            sines[vertex] = sines[vertex].max(sine.min(LARGEST_SINE));
        }
    }
}

/// The unit normal of a triangle, counter-clockwise seen from its tip; `None` without area.
#[must_use]
pub fn face_normal([a, b, c]: [Vec3; 3]) -> Option<Vec3> {
    // In double precision, where the square of any single-precision length is a number.
    let [a, b, c] = [a.as_dvec3(), b.as_dvec3(), c.as_dvec3()];
    (b - a).cross(c - a).try_normalize().map(|normal| normal.as_vec3())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails may panic")]
    use super::*;

    #[test]
    fn the_steepest_face_of_a_vertex_decides() {
        // Two triangles meeting at the x axis, one flat and one rising at 45 degrees.
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(0.0, -1.0, 1.0)];
        let indices = [0, 1, 2, 1, 0, 3];
        let normals = [Vec3::Z; 4];
        let mut found = vec![7.0; 9];
        sines(&positions, &normals, &indices, &mut found);
        let slope = std::f32::consts::FRAC_1_SQRT_2;
        for (sine, expected) in found.iter().zip([slope, slope, 0.0, slope]) {
            assert!((sine - expected).abs() < 1e-6, "{found:?}");
        }
        assert_eq!(found.len(), 4);
    }

    #[test]
    fn a_normal_on_the_wrong_side_is_held_at_the_largest_sine() {
        let mut found = Vec::new();
        sines(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[Vec3::Z, Vec3::NEG_Z, Vec3::X], &[0, 1, 2], &mut found);
        assert_eq!(found, [0.0, LARGEST_SINE, LARGEST_SINE]);
    }

    #[test]
    fn slivers_have_no_normal_and_huge_triangles_do() {
        assert_eq!(face_normal([Vec3::ZERO, Vec3::X, Vec3::X * 2.0]), None);
        let normal = face_normal([Vec3::ZERO, Vec3::X * 1e30, Vec3::Y * 1e30]);
        assert_eq!(normal.unwrap(), Vec3::Z);
    }
}
