//! What the view can see of things: the pyramid before the near plane, and rectangles on screen.
//!
//! Both answer "is it safe to skip?", so both err on one side: a pyramid may be said to touch what
//! it does not, a rectangle may be a pixel too large.

use glam::{DAffine3, DMat4, DVec2, DVec3, DVec4};

use super::Aabb;

/// The convex hull of the eye and the near rectangle: what the near plane cuts off the view.
///
/// ```text
///            ______ near rectangle
///            \    /
///             \  /   a caster that reaches in here, or holds the eye, is cut or
///              \/    seen from inside, and its surface is missing from the depth buffer
///             eye
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearPyramid {
    /// The eye, then the rectangle.
    points: [DVec3; 5],
    /// Outward normals (not unit; zero for faces without area) with a point on the face.
    faces: [(DVec3, DVec3); 5],
}

impl NearPyramid {
    /// From the eye and the corners of the near rectangle, in order around it, world space.
    #[must_use]
    pub fn of(eye: DVec3, [a, b, c, d]: [DVec3; 4]) -> Self {
        let inside = (eye + (a + b + c + d) / 4.0) / 2.0;
        let outward = |on: DVec3, along: DVec3, across: DVec3| {
            let normal = (along - on).cross(across - on).normalize_or_zero();
            (if normal.dot(inside - on) > 0.0 { -normal } else { normal }, on)
        };
        let faces = [outward(eye, a, b), outward(eye, b, c), outward(eye, c, d), outward(eye, d, a), outward(a, b, c)];
        Self { points: [eye, a, b, c, d], faces }
    }

    /// Whether the box `bounds` of an object's space may reach into the pyramid. May say yes
    /// wrongly, never no: only the faces of pyramid and box are tried as separating planes, with
    /// room for the rounding of single precision.
    #[must_use]
    pub fn may_touch(&self, bounds: &Aabb, world_from_object: &DAffine3) -> bool {
        const ROUNDING: f64 = 1e-5;
        if bounds.is_empty() {
            return false;
        }
        let corners = bounds.corners().map(|corner| world_from_object.transform_point3(corner));
        let size = corners.iter().chain(&self.points).fold(DVec3::ZERO, |largest, point| largest.max(point.abs())).max_element();
        let room = ROUNDING * size;
        let beyond = |(normal, on): &(DVec3, DVec3)| corners.iter().all(|corner| normal.dot(*corner - *on) > room);
        if self.faces.iter().any(beyond) {
            return false;
        }
        // The box's own faces, in the world: its corners differ by one axis each.
        let center = (corners[0] + corners[7]) / 2.0;
        let axes = [1, 2, 4].map(|corner| (corners[corner] - corners[0]) / 2.0);
        let past = |axis: usize| {
            let normal = axes[(axis + 1) % 3].cross(axes[(axis + 2) % 3]).normalize_or_zero();
            let half = normal.dot(axes[axis]).abs() + room;
            let along = self.points.map(|point| normal.dot(point - center));
            along.iter().all(|along| *along > half) || along.iter().all(|along| *along < -half)
        };
        !(0..3).any(past)
    }
}

/// The pixels (x, y, width, height from the top left) that may see any of a sphere in world space,
/// in a picture of `size`: one pixel too many on each side rather than one too few. `None` where
/// none can. `clip_from_world` is a reverse-Z perspective.
///
/// A sphere wholly before the near plane is bounded by the planes through the eye that touch it
/// (L, "Scissor Optimization"): a plane of constant x = s w of clip space touches where its
/// distance from the centre is the radius, a quadratic in s. One that reaches behind the near plane
/// is bounded by its cube, whose edges are clipped there.
#[must_use]
pub fn screen_rect(center: DVec3, radius: f64, clip_from_world: &DMat4, size: [u32; 2]) -> Option<[u32; 4]> {
    let whole = Some([0, 0, size[0], size[1]]);
    if !(center.is_finite() && radius.is_finite() && clip_from_world.is_finite()) {
        return whole;
    }
    let w = clip_from_world.row(3);
    let near = w - clip_from_world.row(2);
    let at = center.extend(1.0);
    // Distances from the near plane and from the eye's plane, in units of the sphere's own radius.
    let before = |plane: DVec4| plane.dot(at) - radius * plane.truncate().length();
    let (min, max) = if before(near) > 0.0 && before(w) > 0.0 {
        let x = tangents(clip_from_world.row(0), w, at, radius);
        let y = tangents(clip_from_world.row(1), w, at, radius);
        let (Some([left, right]), Some([bottom, top])) = (x, y) else { return whole };
        (DVec2::new(left, bottom), DVec2::new(right, top))
    } else {
        cube_edges(center, radius, clip_from_world)?
    };
    if !(min.is_finite() && max.is_finite()) {
        return whole;
    }
    let size = DVec2::new(size[0].into(), size[1].into());
    let to_pixels = |clip: DVec2| (DVec2::new(clip.x, -clip.y) * 0.5 + 0.5) * size;
    let (left_top, right_bottom) = (to_pixels(DVec2::new(min.x, max.y)), to_pixels(DVec2::new(max.x, min.y)));
    let low = (left_top.floor() - 1.0).clamp(DVec2::ZERO, size);
    let high = (right_bottom.ceil() + 1.0).clamp(DVec2::ZERO, size);
    let extent = high - low;
    (extent.min_element() > 0.0).then_some([low.x as u32, low.y as u32, extent.x as u32, extent.y as u32])
}

/// The two s for which the plane `row - s w` is at `radius` from `center`, the smaller first.
fn tangents(row: DVec4, w: DVec4, center: DVec4, radius: f64) -> Option<[f64; 2]> {
    let (at, at_w) = (row.dot(center), w.dot(center));
    let (normal, normal_w) = (row.truncate(), w.truncate());
    let square = radius * radius;
    // (at - s at_w)^2 = radius^2 |normal - s normal_w|^2
    let a = at_w * at_w - square * normal_w.length_squared();
    let half_b = square * normal.dot(normal_w) - at * at_w;
    let c = at * at - square * normal.length_squared();
    let discriminant = half_b * half_b - a * c;
    if !(a > 0.0 && discriminant >= 0.0) {
        return None;
    }
    let root = discriminant.sqrt();
    Some([(-half_b - root) / a, (-half_b + root) / a])
}

/// The smallest and largest x / w and y / w of the cube about a sphere, where it is not behind the
/// near plane; `None` where all of it is.
fn cube_edges(center: DVec3, radius: f64, clip_from_world: &DMat4) -> Option<(DVec2, DVec2)> {
    let corners: [DVec4; 8] = std::array::from_fn(|corner| {
        let side = |bit: usize| if corner & bit == 0 { -radius } else { radius };
        *clip_from_world * (center + DVec3::new(side(1), side(2), side(4))).extend(1.0)
    });
    let before = |clip: &DVec4| clip.w - clip.z;
    let mut points: Vec<DVec4> = corners.iter().filter(|corner| before(corner) >= 0.0).copied().collect();
    for (low, bit) in (0..8).flat_map(|corner| [1, 2, 4].map(|bit| (corner, bit))).filter(|(corner, bit)| corner & bit == 0) {
        let (a, b) = (corners[low], corners[low | bit]);
        if (before(&a) >= 0.0) != (before(&b) >= 0.0) {
            points.push(a + (b - a) * (before(&a) / (before(&a) - before(&b))));
        }
    }
    let projected = points.iter().map(|clip| DVec2::new(clip.x, clip.y) / clip.w);
    projected.fold(None, |held: Option<(DVec2, DVec2)>, point| {
        let (min, max) = held.unwrap_or((point, point));
        Some((min.min(point), max.max(point)))
    })
}
