//! What the view can see of things: the pyramid before the near plane, and rectangles on screen.
//!
//! Both answer "is it safe to skip?", so both err on one side: a pyramid may be said to touch what
//! it does not, a rectangle may be a pixel too large.

use glam::{DAffine3, DMat4, DVec2, DVec3, DVec4, Vec3};

use super::{Aabb, Body, Topology};

/// The convex hull of the eye and the near rectangle: what the near plane cuts off the view.
///
/// ```text
///            ______ near rectangle
///            \    /
///             \  /   a caster that reaches in here, or holds the eye, is cut or
///              \/    seen from inside, and its surface is missing from the depth buffer
///             eye
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct NearPyramid {
    body: Body,
    eye: DVec3,
    rectangle: [DVec3; 4],
}

impl NearPyramid {
    /// From the eye and the corners of the near rectangle, in order around it, world space.
    #[must_use]
    pub fn of(eye: DVec3, near_rectangle: [DVec3; 4]) -> Self {
        Self { body: Body::pyramid(eye.extend(1.0), near_rectangle), eye, rectangle: near_rectangle }
    }

    /// Whether a triangle of `topology`, its mesh's vertices at `positions`, may reach into the pyramid. May
    /// say yes wrongly, never no.
    ///
    /// Takes time in proportion to the mesh; ask [`Self::may_touch`] first.
    #[must_use]
    pub fn may_touch_surface(&self, topology: &Topology, positions: &[Vec3], world_from_object: &DAffine3) -> bool {
        let object_from_world = world_from_object.inverse();
        let eye = object_from_world.transform_point3(self.eye);
        let rectangle = self.rectangle.map(|corner| object_from_world.transform_point3(corner));
        let [a, b, c, d] = rectangle;
        // Outward, whatever the winding: the pyramid's middle is within.
        let middle = (eye * 2.0 + a + c) / 4.0;
        let plane = |at: DVec3, normal: DVec3| {
            let normal = normal.normalize_or_zero();
            let normal = if normal.dot(middle - at) > 0.0 { -normal } else { normal };
            normal.extend(-normal.dot(at))
        };
        let side = |from: DVec3, to: DVec3| plane(eye, (from - eye).cross(to - eye));
        let planes = [side(a, b), side(b, c), side(c, d), side(d, a), plane(a, (b - a).cross(c - a))];
        if !planes.iter().all(|plane| plane.is_finite() && plane.truncate() != DVec3::ZERO) {
            return true;
        }
        // Generously what single precision is wrong by.
        let largest =
            eye.abs().max_element() + positions.iter().fold(Vec3::ZERO, |most, p| most.max(p.abs())).max_element() as f64;
        let margin = 1e-6 * largest;
        let welded = |vertex: u32| positions[topology.weld().vertex_of_welded[vertex as usize] as usize].as_dvec3();
        let beyond: Vec<u8> = (0..topology.weld().len() as u32)
            .map(|vertex| {
                let at = welded(vertex).extend(1.0);
                planes.iter().enumerate().map(|(bit, plane)| u8::from(plane.dot(at) > margin) << bit).sum()
            })
            .collect();
        topology.triangles().iter().any(|triangle| {
            let [p, q, r] = triangle.map(|vertex| beyond[vertex as usize]);
            if p & q & r != 0 {
                return false;
            }
            let [p, q, r] = triangle.map(welded);
            let normal = (q - p).cross(r - p).normalize_or_zero();
            let heights = [eye, a, b, c, d].map(|point| normal.dot(point - p));
            !(heights.iter().all(|height| *height > margin) || heights.iter().all(|height| *height < -margin))
        })
    }

    /// Whether the box `bounds` of an object's space may reach into the pyramid. May say yes
    /// wrongly, never no.
    #[must_use]
    pub fn may_touch(&self, bounds: &Aabb, world_from_object: &DAffine3) -> bool {
        self.body.may_meet(&Body::boxed(bounds, world_from_object))
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
        return hull_rect(cube(center, radius), clip_from_world, size);
    };
    pixels(min, max, size)
}

/// The corners of the cube about a sphere (M's box about a light), homogeneous.
pub fn cube(center: DVec3, radius: f64) -> impl Iterator<Item = DVec4> + Clone {
    (0..8).map(move |corner| {
        let side = |bit: usize| if corner & bit == 0 { -radius } else { radius };
        (center + DVec3::new(side(1), side(2), side(4))).extend(1.0)
    })
}

/// The pixels, as [`screen_rect`] gives them, that may see any of a convex body: the hull of places
/// (w = 1) and of directions in which it goes on for ever (w = 0), clipped at the near plane and
/// projected (M section 6, lines 5 and 6 of its listing).
#[must_use]
pub fn hull_rect(hull: impl Iterator<Item = DVec4> + Clone, clip_from_world: &DMat4, size: [u32; 2]) -> Option<[u32; 4]> {
    rect_of(hull.map(|place| *clip_from_world * place), size)
}

/// The same of a body whose corners are in clip space.
#[must_use]
pub fn rect_of(clip: impl Iterator<Item = DVec4> + Clone, size: [u32; 2]) -> Option<[u32; 4]> {
    if clip.clone().any(|place| !place.is_finite()) {
        return Some([0, 0, size[0], size[1]]);
    }
    let (min, max) = projected(clip)?;
    pixels(min, max, size)
}

/// The pixels between two corners in clip space; one too many on each side.
pub(super) fn pixels(min: DVec2, max: DVec2, size: [u32; 2]) -> Option<[u32; 4]> {
    if min.is_nan() || max.is_nan() {
        return Some([0, 0, size[0], size[1]]);
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

/// The smallest and largest x / w and y / w of a hull in clip space, where it is not before the near
/// plane; `None` where all of it is. They may be infinite.
fn projected(hull: impl Iterator<Item = DVec4> + Clone) -> Option<(DVec2, DVec2)> {
    let beyond = |clip: &DVec4| clip.w - clip.z;
    let mut bounds: Option<(DVec2, DVec2)> = None;
    let mut take = |clip: DVec4| {
        let point = DVec2::new(clip.x, clip.y) / clip.w;
        let (min, max) = bounds.unwrap_or((DVec2::INFINITY, DVec2::NEG_INFINITY));
        // 0 / 0, a direction straight along the eye's plane, bounds nothing on that axis.
        let open = point.is_nan_mask();
        bounds = Some((
            min.min(DVec2::select(open, DVec2::NEG_INFINITY, point)),
            max.max(DVec2::select(open, DVec2::INFINITY, point)),
        ));
    };
    for (index, a) in hull.clone().enumerate() {
        if beyond(&a) >= 0.0 {
            take(a);
        }
        // Every edge of the hull, and lines through it, which do no harm.
        for b in hull.clone().skip(index + 1).filter(|b| (beyond(b) >= 0.0) != (beyond(&a) >= 0.0)) {
            take(a + (b - a) * (beyond(&a) / (beyond(&a) - beyond(&b))));
        }
    }
    bounds
}
