//! The scene from the side, cut along the plane that the eye looks in, with some of its rays and the count along each:
//! the papers' diagrams, drawn as the live scene (K figures 8, 10 and 13; M figure 1; B's first).
//!
//! A ray's count is asked point by point: how many light-facing triangles of casters lie on the way to the light, as
//! many as there are volumes that hold the point. Where it changes the ray enters a volume, or leaves one.

use glam::{DVec2, DVec3};

use super::above::content;
use super::bounds::{EYE, dot};
use crate::frame::state::{Blend, State};
use crate::frame::{Camera, Draw, DrawSet, Label, LabelKind, Program, Step, Stroke, Target};
use crate::scene::solid::Role;
use crate::scene::{AlphaMode, LightKind, Pose, PosedLight, Scene};

/// How many rays are drawn.
const RAYS: usize = 7;

/// Of half the eye's vertical angle: how far the outermost rays lie from its middle.
const WIDEST: f64 = 0.8;

/// Places along a ray where the count is asked before it is asked more closely.
const PLACES: usize = 160;

/// Full vertical angle of the view from the side, radians: narrow, so that what is upright looks so.
const FIELD_OF_VIEW: f64 = 0.35;

/// Room about what is framed, as a share of it.
const MARGIN: f64 = 0.12;

/// A ray of the eye.
#[derive(Debug, Clone, PartialEq)]
pub struct Ray {
    /// Unit, world space.
    pub direction: DVec3,
    /// Its place in the picture, upwards from the middle: -1 is the lower edge, 1 the upper.
    pub height: f64,
    /// Piece by piece from the eye, each with its end, metres, and in how many volumes it lies.
    pub legs: Vec<(f64, u32)>,
    /// It ends on a surface.
    pub hits: bool,
}

/// A triangle of world space.
struct Triangle {
    corners: [DVec3; 3],
    /// Seen from behind, it is not there.
    one_sided: bool,
}

impl Triangle {
    fn normal(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a)
    }

    /// How many times `way` leads from `from` to it, ahead.
    fn meets(&self, from: DVec3, way: DVec3) -> Option<f64> {
        let [a, b, c] = self.corners;
        super::above::meets(from, way, a, b, c)
    }
}

/// What rays meet, and what casts before one light.
struct Geometry {
    seen: Vec<Triangle>,
    casting: Vec<Triangle>,
    light: PosedLight,
}

impl Geometry {
    fn new(scene: &Scene, pose: &Pose, light: PosedLight) -> Self {
        let (mut seen, mut casting) = (Vec::new(), Vec::new());
        for (instance, (node_index, node, mesh)) in scene.instances().enumerate() {
            let world_from_object = pose.world_from_object[node_index];
            let turned = world_from_object.matrix3.determinant() < 0.0;
            let positions = pose.positions(scene, node_index);
            let at = |triangle: usize| {
                let corner = |i: usize| positions[mesh.indices[triangle * 3 + i] as usize].as_dvec3();
                let [a, b, c] = [0, 1, 2].map(|i| world_from_object.transform_point3(corner(i)));
                if turned { [a, c, b] } else { [a, b, c] }
            };
            // Two solids put together are seen by the mesh of the result.
            if scene.solid.as_ref().is_none_or(|solid| solid.caster.is_none() || solid.role(instance) == Role::Object) {
                for run in mesh.primitives.iter() {
                    let material = &scene.materials[run.material];
                    let triangles = run.first_index as usize / 3..(run.first_index + run.index_count) as usize / 3;
                    if material.alpha != AlphaMode::Blend {
                        let one_sided = !material.double_sided;
                        seen.extend(triangles.map(|triangle| Triangle { corners: at(triangle), one_sided }));
                    }
                }
            }
            if node.casts_shadow {
                let topology = &mesh.topology;
                for (&triangle, &soup) in topology.mesh_triangles().iter().zip(topology.two_sided()) {
                    let triangle = Triangle { corners: at(triangle as usize), one_sided: !soup };
                    if soup || triangle.normal().dot(way_to(&light, triangle.corners[0]).0) > 0.0 {
                        casting.push(triangle);
                    }
                }
            }
        }
        Self { seen, casting, light }
    }

    /// Metres to the first surface; none where there is none.
    fn surface(&self, from: DVec3, direction: DVec3, near: f64) -> Option<f64> {
        let faces = |triangle: &&Triangle| !triangle.one_sided || triangle.normal().dot(direction) < 0.0;
        let met = self.seen.iter().filter(faces).filter_map(|triangle| triangle.meets(from, direction));
        met.filter(|metres| *metres > near).min_by(f64::total_cmp)
    }

    /// In how many volumes a point lies.
    fn count(&self, point: DVec3) -> u32 {
        let (way, end) = way_to(&self.light, point);
        let crossed = self.casting.iter().filter_map(|triangle| triangle.meets(point, way)).filter(|share| *share < end);
        u32::try_from(crossed.count()).unwrap_or(u32::MAX)
    }
}

/// The way from a point to a light, and how many times it leads there.
fn way_to(light: &PosedLight, point: DVec3) -> (DVec3, f64) {
    match light.kind {
        LightKind::Directional => (-light.direction, f64::INFINITY),
        LightKind::Point | LightKind::Spot { .. } => (light.position - point, 1.0),
    }
}

/// Rays of the eye in the upright plane that it looks in, with one light's count along each.
#[must_use]
pub fn rays(scene: &Scene, pose: &Pose, eye: &Camera, light: usize) -> Vec<Ray> {
    let Some(&light) = pose.lights.get(light).filter(|light| light.on) else { return Vec::new() };
    let geometry = Geometry::new(scene, pose, light);
    let farthest = f64::from(content(scene, pose, eye.eye).radius()) * 2.0;
    #[expect(clippy::cast_precision_loss, reason = "a few rays")]
    let ray = |number: usize| {
        let height = WIDEST * (2.0 * number as f64 / (RAYS - 1) as f64 - 1.0);
        let direction = (eye.forward + eye.up * ((eye.vertical_fov / 2.0).tan() * height)).normalize();
        let hit = geometry.surface(eye.eye, direction, eye.near);
        // A hair before the surface, on the side that is seen.
        let length = hit.map_or(farthest, |metres| metres * (1.0 - 1e-6)).min(farthest);
        let count = |metres: f64| geometry.count(eye.eye + direction * metres);
        Ray { direction, height, legs: legs(length, count), hits: hit.is_some_and(|metres| metres <= farthest) }
    };
    (0..RAYS).map(ray).collect()
}

/// Where the count changes along so many metres.
fn legs(length: f64, count: impl Fn(f64) -> u32) -> Vec<(f64, u32)> {
    let mut legs = Vec::new();
    let mut here = (0.0, count(0.0));
    for place in 1..=PLACES {
        #[expect(clippy::cast_precision_loss, reason = "a few places")]
        let there = length * place as f64 / PLACES as f64;
        let beyond = count(there);
        if beyond != here.1 {
            let (mut low, mut high) = (here.0, there);
            for _ in 0..24 {
                let middle = (low + high) / 2.0;
                *if count(middle) == here.1 { &mut low } else { &mut high } = middle;
            }
            legs.push((low, here.1));
        }
        here = (there, beyond);
    }
    legs.push(here);
    legs
}

/// Where the scene is seen from the side, right of the eye: its near plane is the upright plane that the eye looks in, so
/// that what lies before it is cut away. The eye looks to the right of the picture.
#[must_use]
pub fn side(scene: &Scene, pose: &Pose, eye: &Camera) -> Camera {
    let framed = content(scene, pose, eye.eye);
    let ahead = DVec3::new(eye.forward.x, 0.0, eye.forward.z).try_normalize().unwrap_or(DVec3::X);
    let right = ahead.cross(DVec3::Y);
    let (min, max) = (framed.min.as_dvec3(), framed.max.as_dvec3());
    let corners =
        (0..8).map(|i| DVec3::from_array([0, 1, 2].map(|axis| if i >> axis & 1 == 1 { max } else { min }.to_array()[axis])));
    let along = |way: DVec3| {
        corners.clone().map(move |corner| corner.dot(way)).fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)))
    };
    let ((back, front), (low, high)) = (along(ahead), along(DVec3::Y));
    let half = DVec2::new(front - back, high - low).max(DVec2::splat(0.1)) / 2.0 * (1.0 + MARGIN);
    let distance = (half.y.max(half.x / eye.aspect)) / (FIELD_OF_VIEW / 2.0).tan();
    let middle = ahead * ((back + front) / 2.0) + DVec3::Y * ((low + high) / 2.0) + right * eye.eye.dot(right);
    Camera {
        eye: middle + right * distance,
        forward: -right,
        up: DVec3::Y,
        vertical_fov: FIELD_OF_VIEW,
        aspect: eye.aspect,
        near: distance * (1.0 + 1e-9),
        far: None,
        focus_distance: distance,
        shift: DVec2::ZERO,
        mirrored: false,
    }
}

/// The colour of a piece of a ray: light where nothing shadows it, and the deeper the more volumes it lies in.
fn color(count: u32) -> [f32; 4] {
    match count {
        0 => [1.0, 0.90, 0.55, 1.0],
        1 => [0.62, 0.50, 1.0, 1.0],
        2 => [0.86, 0.36, 0.86, 1.0],
        _ => [1.0, 0.30, 0.42, 1.0],
    }
}

/// The rays over the view from the side, and the counts beside them.
#[must_use]
pub fn overlay(rays: &[Ray], eye: DVec3, side: &Camera, size: [u32; 2]) -> (Vec<Stroke>, Vec<Label>) {
    let clip_from_world = side.clip_from_world();
    let extent = DVec2::new(size[0].into(), size[1].into());
    let at = |place: DVec3| {
        let clip = clip_from_world * place.extend(1.0);
        ((DVec2::new(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * extent).as_vec2()
    };
    #[expect(clippy::cast_precision_loss, reason = "pixels")]
    let text = (size[1] as f32 / 45.0).round().clamp(9.0, 30.0);
    let (mut strokes, mut labels) = (Vec::new(), Vec::new());
    for ray in rays {
        let mut from = 0.0;
        for (number, &(to, count)) in ray.legs.iter().enumerate() {
            let (start, end) = (at(eye + ray.direction * from), at(eye + ray.direction * to));
            let points = vec![start.to_array(), end.to_array()];
            strokes.push(Stroke { points, closed: false, width: 2.0, color: color(count), fill: None });
            if number + 1 < ray.legs.len() || ray.hits {
                let [r, g, b, _] = color(ray.legs.get(number + 1).map_or(count, |next| next.1));
                strokes.push(dot(end.to_array(), text / 4.0, [r, g, b]));
            }
            if start.distance(end) > text * 1.6 {
                let words = count.to_string();
                #[expect(clippy::cast_precision_loss, reason = "a few letters")]
                let width = text * 0.62 * words.len() as f32;
                let middle = (start + end) / 2.0;
                let plate = [middle.x - width / 2.0, middle.y - text * 1.25, width, text * 1.2];
                labels.push(Label { text: words, kind: LabelKind::Legend, anchor: middle.to_array(), plate, text_size: text });
            }
            from = to;
        }
    }
    strokes.push(dot(at(eye).to_array(), text / 3.0, EYE));
    (strokes, labels)
}

/// The lines over the finished picture.
#[must_use]
pub fn step(strokes: Vec<Stroke>, scissor: [u32; 4]) -> Step {
    let why = "Rays of the eye, each piece in the colour of how many volumes hold it; dots where it enters one or leaves it.";
    let draw = Draw {
        target: Target::Output,
        state: State { color: Some(Blend::Over), ..State::FLAT },
        ..Draw::plain(Program::Lines, DrawSet::Strokes(strokes), scissor)
    };
    Step::drawing("rays", why, draw)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_count_that_changes_ends_a_piece() {
        let found = legs(10.0, |metres| u32::from(metres > 2.0) + u32::from(metres > 3.5) - u32::from(metres > 7.0));
        let counts: Vec<_> = found.iter().map(|leg| leg.1).collect();
        assert_eq!(counts, [0, 1, 2, 1]);
        for ((end, _), expected) in found.iter().zip([2.0, 3.5, 7.0, 10.0]) {
            assert!((end - expected).abs() < 1e-6, "{found:?}");
        }
    }
}
