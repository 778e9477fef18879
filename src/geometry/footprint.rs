//! Where on screen a shadow can fall: the pixels of one receiver that one shadow volume may hold.
//!
//! A volume's sides run from the caster to the last receiver and pass over many pixels whose surfaces lie before or
//! beyond them: there fronts and backs cancel. Only where a surface lies *within* the volume is anything left in the
//! count, and those pixels are few:
//!
//! ```text
//!        * light
//!       / \
//!      [###] caster            1  the caster's own pixels
//!       |   |
//!       |   |                  nothing but air: sides pass, and cancel
//!       |   |
//!   ====[   ]==== floor ====   2  the shadow's pixels
//! ```
//!
//! The bound: the volume of the caster's box, a convex body, is cut by the slab between two opposite faces of the
//! receiver's box, for each of its three pairs of faces; each cut is projected, and the pixels common to all three, and to
//! the receiver's own, hold the shadow. All of it in homogeneous coordinates, so that volumes without end need nothing
//! of their own.

use arrayvec::ArrayVec;
use glam::{DMat4, DVec2, DVec3, DVec4, Vec4Swizzles as _};

use super::Body;
use super::frustum::{hull_rect, pixels, rect_of};
use super::pixels::common;
use super::reach::{BOX_EDGES, ROUNDING, thrown};

/// The pixels that may see any of a body with these corners in clip space.
fn projected(clip: &[DVec4], size: [u32; 2]) -> Option<[u32; 4]> {
    let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for corner in clip {
        // What reaches behind the near plane must be cut there, edge by edge.
        if corner.w <= corner.z {
            return rect_of(clip.iter().copied(), size);
        }
        let point = corner.xy() / corner.w;
        (min, max) = (min.min(point), max.max(point));
    }
    pixels(min, max, size)
}

/// Space between two parallel planes: unit normal, and the least and greatest `normal.place`.
pub type Slab = (DVec3, f64, f64);

/// A surface's box, as shadows fall on it in a view.
#[derive(Debug, Clone, PartialEq)]
pub struct Receiver {
    slabs: ArrayVec<Slab, 3>,
    largest: f64,
    /// Its least and greatest corner, world space.
    pub bounds: [DVec3; 2],
    /// The pixels that may see any of it.
    pub rect: [u32; 4],
}

impl Receiver {
    /// A box in world space and the pixels of a picture of `size` that may see any of it; `None` where none can.
    #[must_use]
    pub fn new(boxed: &Body, clip_from_world: &DMat4, size: [u32; 2]) -> Option<Self> {
        let rect = hull_rect(boxed.hull(), clip_from_world, size)?;
        Some(Self { slabs: boxed.slabs(), largest: boxed.largest(), bounds: boxed.bounds(), rect })
    }
}

/// A caster's box and all behind it as seen from a light, and what a view sees of that.
#[derive(Debug, Clone, PartialEq)]
pub struct Shaft {
    /// The box's corners, and where each ends: a place, or a direction (w = 0) in which it goes on for ever.
    places: [DVec4; 16],
    clip: [DVec4; 16],
    largest: f64,
}

impl Shaft {
    /// Of the caster's box with these world-space `corners` (as [`super::Aabb::corners`] orders them) before `light` (a
    /// place with w = 1, or the direction towards it with w = 0), up to the plane `end` where there is one. `None` where the
    /// light is so near the box that rays may leave every way.
    #[must_use]
    pub fn new(corners: &[DVec3; 8], light: DVec4, end: Option<DVec4>, clip_from_world: &DMat4) -> Option<Self> {
        let mut places = [DVec4::ZERO; 16];
        let middle = (corners[0] + corners[7]) / 2.0;
        if light.w != 0.0 {
            let radius = corners.iter().map(|corner| corner.distance(middle)).fold(0.0, f64::max);
            if middle.distance(light.truncate()) <= radius * 1.01 {
                return None;
            }
        }
        let ends = end.filter(|_| light.w != 0.0).map(|plane| thrown(corners, light.truncate(), plane));
        for (index, corner) in corners.iter().enumerate() {
            places[index] = corner.extend(1.0);
            places[index + 8] = ends.map_or_else(
                || (*corner * light.w - light.truncate()).normalize_or_zero().extend(0.0),
                |ends| ends[index].extend(1.0),
            );
        }
        let largest = places.iter().fold(DVec3::ZERO, |largest, place| largest.max(place.truncate().abs())).max_element();
        places.iter().all(|place| place.is_finite()).then(|| {
            let clip = places.map(|place| *clip_from_world * place);
            Self { places, clip, largest }
        })
    }

    /// The pixels of a picture of `size` where a surface within the receiver's box may lie within the volume; `None`
    /// where the two are apart, or out of view.
    #[must_use]
    pub fn falls_on(&self, receiver: &Receiver, size: [u32; 2]) -> Option<[u32; 4]> {
        let room = ROUNDING * self.largest.max(receiver.largest);
        let mut rect = receiver.rect;
        for &(normal, low, high) in &receiver.slabs {
            let cut = self.cut(normal, low - room, high + room);
            if cut.is_empty() {
                return None;
            }
            rect = common(rect, projected(&cut, size)?)?;
        }
        Some(rect)
    }

    /// Corners, in clip space, of what lies in a slab: the body's own, and where its edges cross the planes.
    fn cut(&self, normal: DVec3, low: f64, high: f64) -> ArrayVec<DVec4, 80> {
        let mut corners = ArrayVec::new();
        let above = self.places.map(|place| normal.dot(place.truncate()) - low * place.w);
        let below = self.places.map(|place| high * place.w - normal.dot(place.truncate()));
        if above.iter().all(|height| *height < 0.0) || below.iter().all(|height| *height < 0.0) {
            return corners;
        }
        for (index, clip) in self.clip.iter().enumerate() {
            if above[index] >= 0.0 && below[index] >= 0.0 {
                corners.push(*clip);
            }
        }
        // Edges of the box, of its far end, and the rays between: those of the body are among them.
        let edges =
            BOX_EDGES.iter().flat_map(|[a, b]| [[*a, *b], [a + 8, b + 8]]).chain((0..8).map(|corner| [corner, corner + 8]));
        for [a, b] in edges {
            for heights in [&above, &below] {
                if (heights[a] < 0.0) != (heights[b] < 0.0) {
                    corners.push(self.clip[a] * heights[b].abs() + self.clip[b] * heights[a].abs());
                }
            }
        }
        corners
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

    use glam::{DAffine3, Vec3};

    use super::*;
    use crate::frame::camera::Camera;
    use crate::geometry::Aabb;
    use crate::geometry::ending::ending_plane;

    const SIZE: [u32; 2] = [640, 360];

    fn camera(eye: DVec3) -> Camera {
        Camera {
            eye,
            forward: (DVec3::new(0.0, 1.0, 0.0) - eye).normalize(),
            up: DVec3::Y,
            vertical_fov: 1.0,
            aspect: 640.0 / 360.0,
            near: 0.1,
            far: None,
            focus_distance: 1.0,
            mirrored: false,
            shift: DVec2::ZERO,
        }
    }

    /// Where a world-space place is on screen, pixels; `None` before the near plane.
    fn pixel(place: DVec3, clip_from_world: &DMat4) -> Option<DVec2> {
        let clip = *clip_from_world * place.extend(1.0);
        (clip.w > clip.z && clip.w > 0.0)
            .then(|| (DVec2::new(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * DVec2::new(SIZE[0].into(), SIZE[1].into()))
    }

    #[test]
    fn every_place_in_shadow_is_in_the_footprint() {
        let mut random = fastrand::Rng::with_seed(11);
        let within = |random: &mut fastrand::Rng, low: f64, high: f64| low + (high - low) * random.f64();
        let (mut in_shadow, mut smaller) = (0, 0);
        for round in 0..400 {
            let turned = DAffine3::from_rotation_y(within(&mut random, 0.0, 3.0));
            let mut vector = |low, high| DVec3::from_array([(); 3].map(|()| within(&mut random, low, high)));
            let clip_from_world = camera(vector(-6.0, 6.0)).clip_from_world();
            let (at, half) = (vector(-2.0, 2.0), vector(0.1, 1.0).as_vec3());
            let caster = Aabb { min: at.as_vec3() - half, max: at.as_vec3() + half };
            let (ground, ground_half) = (vector(-4.0, 4.0), vector(0.0, 3.0).as_vec3());
            let ground = Aabb { min: ground.as_vec3() - ground_half, max: ground.as_vec3() + ground_half };
            let corners = caster.corners().map(|corner| turned.transform_point3(corner));
            let light = if round % 3 == 0 { vector(-1.0, 1.0).extend(0.0) } else { vector(-8.0, 8.0).extend(1.0) };
            let all = Aabb { min: Vec3::splat(-12.0), max: Vec3::splat(12.0) };
            let end = ending_plane(light.truncate(), corners, &all).filter(|_| light.w != 0.0 && round % 2 == 0);
            let Some(shaft) = Shaft::new(&corners, light, end, &clip_from_world) else { continue };
            let receiver = Body::boxed(&ground, &DAffine3::IDENTITY);
            let Some(receiver) = Receiver::new(&receiver, &clip_from_world, SIZE) else { continue };
            let found = shaft.falls_on(&receiver, SIZE);
            smaller += usize::from(found != Some(receiver.rect));
            for _ in 0..200 {
                // A place of the receiver, whose ray to the light meets the caster's box, and that is on screen.
                let share = DVec3::from_array([(); 3].map(|()| within(&mut random, 0.0, 1.0)));
                let place = ground.min.as_dvec3() + share * (ground.max - ground.min).as_dvec3();
                let toward = light.truncate() - place * light.w;
                let into = turned.inverse();
                let (from, way) = (into.transform_point3(place), into.transform_vector3(toward));
                let reach = if light.w == 0.0 { f64::INFINITY } else { 1.0 };
                if !caster.meets_segment(from, way, reach) {
                    continue;
                }
                let Some(at) = pixel(place, &clip_from_world) else { continue };
                if at.cmplt(DVec2::ZERO).any() || at.x >= 640.0 || at.y >= 360.0 {
                    continue;
                }
                in_shadow += 1;
                let [x, y, width, height] = found.unwrap().map(f64::from);
                assert!(at.x >= x && at.x <= x + width && at.y >= y && at.y <= y + height, "{round}: {at} in {found:?}");
            }
        }
        assert!(in_shadow > 1000 && smaller > 100, "{in_shadow} places, {smaller} smaller");
    }

    #[test]
    fn a_shadow_on_the_floor_is_far_smaller_than_the_floor() {
        let clip_from_world = camera(DVec3::new(0.0, 3.0, 10.0)).clip_from_world();
        let floor = Aabb { min: Vec3::new(-20.0, -0.1, -20.0), max: Vec3::new(20.0, 0.0, 20.0) };
        let floor = Receiver::new(&Body::boxed(&floor, &DAffine3::IDENTITY), &clip_from_world, SIZE).unwrap();
        let caster = Aabb { min: Vec3::new(-0.5, 2.0, -0.5), max: Vec3::new(0.5, 3.0, 0.5) };
        let shaft = Shaft::new(&caster.corners(), DVec4::new(0.0, 12.0, 0.0, 1.0), None, &clip_from_world).unwrap();
        let [x, y, width, height] = shaft.falls_on(&floor, SIZE).unwrap();
        assert!(width * height * 20 < floor.rect[2] * floor.rect[3], "{width} x {height} of {:?}", floor.rect);
        let below = pixel(DVec3::ZERO, &clip_from_world).unwrap().as_uvec2();
        assert!((x..x + width).contains(&below.x) && (y..y + height).contains(&below.y));
        // And the caster's own pixels are another such rectangle, above.
        let own = Receiver::new(&Body::boxed(&caster, &DAffine3::IDENTITY), &clip_from_world, SIZE).unwrap();
        let [_, top, _, high] = shaft.falls_on(&own, SIZE).unwrap();
        assert!(top + high < y);
    }

    #[test]
    fn a_light_in_the_box_throws_shadows_every_way() {
        let caster = Aabb { min: Vec3::splat(-1.0), max: Vec3::splat(1.0) };
        let clip_from_world = camera(DVec3::new(0.0, 3.0, 10.0)).clip_from_world();
        assert_eq!(Shaft::new(&caster.corners(), DVec4::new(0.5, 0.5, 0.5, 1.0), None, &clip_from_world), None);
    }
}
