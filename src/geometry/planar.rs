//! Planar mirrors: whether triangles lie on one plane, and the reflection in it (K appendix A).
//!
//! A plane is four numbers, a unit normal n and an offset w: `n.x + w` is a point's height over it, positive
//! on the side that reflects. K's appendix gives the matrix for a plane through p with direction v; with n
//! for v and -w for p.v it is
//!
//! ```text
//!   x' = x - 2 (n.x + w) n          what is at height h comes to -h; done twice, all is back
//! ```

use glam::{DAffine3, DMat3, DVec3, DVec4, Vec3};
use thiserror::Error;

/// Why triangles are no plane mirror.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum Uneven {
    /// There are none, or all are lines and points.
    #[error("its triangles have no area")]
    NoArea,
    /// Metres from the plane nearest to all.
    #[error("its corners lie up to {} m off one plane", significant(*.0))]
    OffPlane(f64),
    /// They lie on one plane, but on both its sides, and the material is single-sided.
    #[error("its triangles face both ways")]
    BothWays,
}

/// The plane on which all these triangles lie, its normal towards the side from which they run
/// counter-clockwise. With `both_sides` they may face either way, and the largest decides.
///
/// Nearly a plane is one where rounding explains the rest: the last digits of single-precision coordinates
/// as a transform left them, or the steps of positions stored in 16 bits.
///
/// # Errors
/// As [`Uneven`] lists. Positions are finite.
pub fn plane_of(triangles: impl Iterator<Item = [Vec3; 3]> + Clone, both_sides: bool) -> Result<DVec4, Uneven> {
    /// Of the largest coordinate: sixteen halves of a last digit.
    const SINGLE_PRECISION: f64 = 1e-6;
    /// Of the extent: half a step of 16 bits on each of three axes, rounded up.
    const SIXTEEN_BITS: f64 = 2e-5;
    /// Of the largest triangle's area: what faces the other way must be more than a sliver.
    const SLIVER: f64 = 1e-6;

    let triangles = triangles.map(|corners| corners.map(Vec3::as_dvec3));
    let double_area = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
    let largest = triangles.clone().map(double_area).max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    let largest = largest.ok_or(Uneven::NoArea)?;
    let first = largest.try_normalize().ok_or(Uneven::NoArea)?;
    // Slivers have directions of their own, and little say: the sum weighs by area.
    let turned = |area: DVec3| if both_sides && area.dot(first) < 0.0 { -area } else { area };
    let sum: DVec3 = triangles.clone().map(|corners| turned(double_area(corners))).sum();
    let normal = sum.try_normalize().filter(|normal| normal.dot(first) > 0.5).unwrap_or(first);

    let corners = triangles.clone().flatten();
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
    for corner in corners {
        (low, high) = (low.min(corner), high.max(corner));
        let height = normal.dot(corner);
        (lowest, highest) = (lowest.min(height), highest.max(height));
    }
    let room = SINGLE_PRECISION * low.abs().max(high.abs()).max_element() + SIXTEEN_BITS * (high - low).max_element();
    let off = (highest - lowest) / 2.0;
    if off > room {
        return Err(Uneven::OffPlane(off));
    }
    if triangles.clone().any(|corners| turned(double_area(corners)).dot(normal) < -SLIVER * largest.length()) {
        return Err(Uneven::BothWays);
    }
    Ok(normal.extend(-(lowest + highest) / 2.0))
}

/// Height of a point over a plane, metres.
#[must_use]
pub fn height(plane: DVec4, point: DVec3) -> f64 {
    plane.truncate().dot(point) + plane.w
}

/// A plane of an object's space in the world: what was on its positive side stays there, also where the
/// transform mirrors. It must have an inverse.
#[must_use]
pub fn transformed(plane: DVec4, world_from_object: &DAffine3) -> DVec4 {
    let object_from_world = world_from_object.inverse();
    let normal = object_from_world.matrix3.transpose() * plane.truncate();
    let offset = plane.truncate().dot(object_from_world.translation) + plane.w;
    normal.extend(offset) / normal.length()
}

/// The reflection in a plane (K appendix A), which is its own inverse.
#[must_use]
pub fn reflection(plane: DVec4) -> DAffine3 {
    let normal = plane.truncate();
    let column = |axis: DVec3| axis - normal * (2.0 * normal.dot(axis));
    let matrix = DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z));
    DAffine3::from_mat3_translation(matrix, normal * (-2.0 * plane.w))
}

/// Two significant digits, without an exponent where a person would write none.
fn significant(value: f64) -> String {
    if value >= 0.01 { format!("{value:.2}") } else { format!("{value:.1e}") }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails may panic")]
    use super::*;
    use glam::DQuat;

    fn fan(corners: &[[f32; 3]]) -> Vec<[Vec3; 3]> {
        let corner = |i: usize| Vec3::from(corners[i]);
        (1..corners.len() - 1).map(|i| [corner(0), corner(i), corner(i + 1)]).collect()
    }

    fn square(y: f32) -> Vec<[Vec3; 3]> {
        fan(&[[-1.0, y, 1.0], [1.0, y, 1.0], [1.0, y, -1.0], [-1.0, y, -1.0]])
    }

    fn of(triangles: &[[Vec3; 3]], both_sides: bool) -> Result<DVec4, Uneven> {
        plane_of(triangles.iter().copied(), both_sides)
    }

    #[test]
    fn a_floor_reflects_upwards() {
        assert_eq!(of(&square(2.0), false).unwrap(), DVec4::new(0.0, 1.0, 0.0, -2.0));
        let turned: Vec<_> = square(2.0).iter().map(|&[a, b, c]| [a, c, b]).collect();
        assert_eq!(of(&turned, false).unwrap(), DVec4::new(0.0, -1.0, 0.0, 2.0));
    }

    #[test]
    fn concave_and_many_polygons_are_one_plane() {
        let arrow = fan(&[[0.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 1.0, 0.0], [-2.0, 2.0, 0.0]]);
        let mut many = arrow.clone();
        many.extend(fan(&[[7.0, 7.0, 0.0], [8.0, 7.0, 0.0], [8.0, 9.0, 0.0]]));
        for triangles in [arrow, many] {
            assert_eq!(of(&triangles, false).unwrap(), DVec4::new(0.0, 0.0, 1.0, 0.0));
        }
    }

    #[test]
    fn what_is_no_plane_says_how_far() {
        let bent = fan(&[[-1.0, 0.0, 1.0], [1.0, 0.24, 1.0], [1.0, 0.0, -1.0], [-1.0, 0.24, -1.0]]);
        let error = of(&bent, true).unwrap_err();
        assert!(matches!(error, Uneven::OffPlane(off) if (off - 0.12).abs() < 1e-6), "{error:?}");
        assert_eq!(error.to_string(), "its corners lie up to 0.12 m off one plane");
        let dented = fan(&[[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 2e-4, -1.0], [-1.0, 0.0, -1.0]]);
        assert!(of(&dented, false).unwrap_err().to_string().ends_with("e-5 m off one plane"));
        let steps = [square(0.0), square(0.2)].concat();
        assert_eq!(of(&steps, false), Err(Uneven::OffPlane(f64::from(0.2f32) / 2.0)), "two tiers are two mirrors");
    }

    #[test]
    fn rounding_is_forgiven_wherever_a_mirror_stands() {
        let turn = DQuat::from_rotation_x(0.7) * DQuat::from_rotation_z(0.31);
        for (far, size) in [(0.0, 1.0), (300.0, 1.0), (4e4, 20.0), (0.0, 1e-3)] {
            let moved = square(0.0).into_iter().map(|corners| {
                corners.map(|corner| (turn * (corner.as_dvec3() * size) + DVec3::new(far, far / 3.0, -far)).as_vec3())
            });
            let plane = plane_of(moved, false).unwrap();
            let slope = plane.truncate().dot(turn * DVec3::Y);
            assert!(1.0 - slope < 1e-4, "{far} {size}: {slope}");
        }
    }

    #[test]
    fn a_two_sided_sheet_may_be_wound_either_way() {
        let [first, [a, b, c]] = square(0.0)[..] else { unreachable!("two triangles") };
        let mixed = [first, [a, c, b]];
        assert_eq!(of(&mixed, false), Err(Uneven::BothWays));
        assert_eq!(of(&mixed, true).unwrap().y.abs(), 1.0);
    }

    #[test]
    fn lines_are_no_plane() {
        assert_eq!(of(&[], false), Err(Uneven::NoArea));
        assert_eq!(of(&[[Vec3::ZERO, Vec3::X, Vec3::X * 2.0]], true), Err(Uneven::NoArea));
    }

    #[test]
    fn a_mirrored_node_reflects_on_its_front() {
        // A mirror that looks along +X, in a node that mirrors x: it looks along -X, from x = -3.
        let place = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 2.0));
        let plane = transformed(DVec4::new(1.0, 0.0, 0.0, -3.0), &place);
        assert!(plane.distance(DVec4::new(-1.0, 0.0, 0.0, -3.0)) < 1e-12, "{plane}");
        assert!(height(plane, DVec3::NEG_X * 5.0) > 0.0);
    }
}
