//! Diagrams that are seen from elsewhere than the side: the dark cap's fan, from the light (M figure 3), and the order
//! of a polygon's corners, from the eye (Beam's first picture).
//!
//! Both are about what is in the middle of the eye's picture.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::with_alpha;
use crate::frame::{Camera, Label, LabelKind, Stroke};
use crate::scene::{LightKind, Pose, PosedLight, Scene};
use crate::techniques::above::meets;
use crate::techniques::bounds::dot;

/// Front faces of the fan, and back faces (M's own colours).
const FRONT: [f32; 4] = [1.0, 0.84, 0.20, 0.40];
const BACK: [f32; 4] = [0.10, 0.78, 0.92, 0.52];

/// The polygon's rim and its order.
const RIM: [f32; 4] = [1.0, 0.84, 0.42, 1.0];

/// A caster in world space, its corners by number.
struct Caster {
    corners: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    instance: usize,
}

impl Caster {
    fn all<'a>(scene: &'a Scene, pose: &'a Pose) -> impl Iterator<Item = Self> + 'a {
        scene.instances().enumerate().filter(|(_, (_, node, _))| node.casts_shadow).map(|(instance, (node, _, mesh))| {
            let (positions, place) = (pose.positions(scene, node), pose.world_from_object[node]);
            let corner = |&vertex: &u32| place.transform_point3(positions[vertex as usize].as_dvec3());
            let turned = place.matrix3.determinant() < 0.0;
            let triangle = |&[a, b, c]: &[u32; 3]| if turned { [a, c, b] } else { [a, b, c] };
            Self {
                corners: mesh.topology.weld().vertex_of_welded.iter().map(corner).collect(),
                triangles: mesh.topology.triangles().iter().map(triangle).collect(),
                instance,
            }
        })
    }

    fn of(&self, triangle: [u32; 3]) -> [DVec3; 3] {
        triangle.map(|corner| self.corners[corner as usize])
    }

    fn normal(&self, triangle: [u32; 3]) -> DVec3 {
        let [a, b, c] = self.of(triangle);
        (b - a).cross(c - a)
    }

    /// Edges that only one of these triangles has, in its direction.
    fn rim(triangles: impl Iterator<Item = [u32; 3]>) -> Vec<[u32; 2]> {
        let mut edges: BTreeMap<[u32; 2], i32> = BTreeMap::new();
        for [a, b, c] in triangles {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                *edges.entry([from.min(to), from.max(to)]).or_default() += if from < to { 1 } else { -1 };
            }
        }
        let once = edges.into_iter().filter(|(_, sum)| *sum != 0);
        once.map(|([low, high], sum)| if sum > 0 { [low, high] } else { [high, low] }).collect()
    }
}

/// The caster that the eye's middle ray meets first, and the triangle there.
fn in_the_middle(scene: &Scene, pose: &Pose, eye: &Camera) -> Option<(Caster, [u32; 3])> {
    let met = Caster::all(scene, pose).filter_map(|caster| {
        let faces = caster.triangles.iter().filter(|triangle| caster.normal(**triangle).dot(eye.forward) < 0.0);
        let hits = faces.filter_map(|&triangle| {
            let [a, b, c] = caster.of(triangle);
            meets(eye.eye, eye.forward, a, b, c).map(|metres| (metres, triangle))
        });
        let nearest = hits.min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some((nearest, caster))
    });
    met.min_by(|a, b| a.0.0.total_cmp(&b.0.0)).map(|((_, triangle), caster)| (caster, triangle))
}

/// The caster whose middle lies nearest to the middle of the eye's picture.
fn nearest_to_the_middle(scene: &Scene, pose: &Pose, eye: &Camera) -> Option<Caster> {
    let beside = |caster: &Caster| {
        #[expect(clippy::cast_precision_loss, reason = "corners of a mesh")]
        let middle = caster.corners.iter().sum::<DVec3>() / caster.corners.len().max(1) as f64;
        (middle - eye.eye).angle_between(eye.forward)
    };
    Caster::all(scene, pose).min_by(|a, b| beside(a).total_cmp(&beside(b)))
}

/// The caster nearest to the middle of the eye's picture, as the light sees it; none where nothing casts.
#[must_use]
pub fn from_the_light(scene: &Scene, pose: &Pose, eye: &Camera, light: &PosedLight) -> Option<Camera> {
    let caster = nearest_to_the_middle(scene, pose, eye)?;
    let (node, ..) = scene.instances().nth(caster.instance)?;
    let bounds = pose.world_bounds(scene, node);
    let (middle, radius) = (bounds.center().as_dvec3(), f64::from(bounds.radius()));
    let place = match light.kind {
        LightKind::Directional => middle - light.direction * radius * 20.0,
        LightKind::Point | LightKind::Spot { .. } => light.position,
    };
    let distance = place.distance(middle);
    // So that it fills the picture's height, nearly.
    let angle = 2.0 * (radius / distance).min(0.95).asin();
    Camera::look_at(place, middle, angle.clamp(0.01, 2.6), eye.aspect, (distance * 0.01).min(0.1)).ok()
}

/// From the world to pixels.
struct Lens {
    clip_from_world: glam::DMat4,
    size: DVec2,
}

impl Lens {
    fn new(camera: &Camera, size: [u32; 2]) -> Self {
        Self { clip_from_world: camera.clip_from_world(), size: DVec2::new(size[0].into(), size[1].into()) }
    }

    fn at(&self, place: DVec3) -> DVec2 {
        let clip = self.clip_from_world * place.extend(1.0);
        (DVec2::new(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * self.size
    }

    fn text(&self) -> f64 {
        (self.size.y / 36.0).round().clamp(8.0, 34.0)
    }

    fn line(&self, from: DVec2, to: DVec2, width: f64, color: [f32; 4]) -> Stroke {
        let width = (width * self.text() / 10.0) as f32;
        Stroke { points: [from, to].map(|place| place.as_vec2().to_array()).into(), closed: false, width, color, fill: None }
    }

    fn note(&self, middle: DVec2, words: &str) -> Label {
        let text = self.text();
        let size = DVec2::new((words.chars().count() as f64 * 0.602 + 0.8) * text, text * 1.4);
        let corner = (middle - size / 2.0).round();
        let plate = [corner.x, corner.y, size.x, size.y].map(|value| value as f32);
        Label { text: words.into(), kind: LabelKind::Note, anchor: middle.as_vec2().to_array(), plate, text_size: text as f32 }
    }
}

/// The silhouette of the caster nearest to the middle, as `from_light` sees it, and the fan from one of its corners: a triangle
/// for each of its edges, front faces and back faces.
#[must_use]
pub fn fan(scene: &Scene, pose: &Pose, eye: &Camera, from_light: &Camera, size: [u32; 2]) -> (Vec<Stroke>, Vec<Label>) {
    let Some(caster) = nearest_to_the_middle(scene, pose, eye) else { return (Vec::new(), Vec::new()) };
    let lens = Lens::new(from_light, size);
    let facing = caster.triangles.iter().copied().filter(|&triangle| {
        let [a, ..] = caster.of(triangle);
        caster.normal(triangle).dot(from_light.eye - a) > 0.0
    });
    let rim = Caster::rim(facing);
    let place = |corner: u32| lens.at(caster.corners[corner as usize]);
    let Some(&[hub, _]) = rim.first() else { return (Vec::new(), Vec::new()) };
    let (mut fronts, mut backs) = (0, 0);
    let mut strokes = Vec::new();
    let mut spokes = Vec::new();
    for &[from, to] in rim.iter().filter(|edge| !edge.contains(&hub)) {
        let corners = [hub, from, to].map(place);
        let [a, b, c] = corners;
        // The picture's y points down: what turns clockwise there turns the other way in the world.
        let front = (b - a).perp_dot(c - a) < 0.0;
        *if front { &mut fronts } else { &mut backs } += 1;
        let fill = if front { FRONT } else { BACK };
        let points: Vec<_> = corners.iter().map(|corner| corner.as_vec2().to_array()).collect();
        strokes.push(Stroke { points, closed: true, width: 0.0, color: fill, fill: Some(fill) });
        spokes.push(lens.line(a, b, 0.8, [0.04, 0.05, 0.07, 0.8]));
        spokes.push(lens.line(a, c, 0.8, [0.04, 0.05, 0.07, 0.8]));
    }
    strokes.extend(spokes);
    strokes.extend(rim.iter().map(|&[from, to]| lens.line(place(from), place(to), 2.2, [1.0, 1.0, 1.0, 1.0])));
    strokes.push(dot(place(hub).as_vec2().to_array(), (lens.text() * 0.4) as f32, [1.0, 1.0, 1.0]));
    let words =
        format!("{} edges: {fronts} front faces, {backs} back faces; what both cover is counted up and down again", rim.len());
    let low = DVec2::new(lens.size.x / 2.0, lens.size.y - lens.text() * 1.4);
    (strokes, vec![lens.note(low, &words)])
}

/// The polygon in the middle of the eye's picture, its corners numbered in their order.
#[must_use]
pub fn order(scene: &Scene, pose: &Pose, eye: &Camera, size: [u32; 2]) -> (Vec<Stroke>, Vec<Label>) {
    let Some((caster, met)) = in_the_middle(scene, pose, eye) else { return (Vec::new(), Vec::new()) };
    let lens = Lens::new(eye, size);
    // A polygon is all triangles of the plane that this one lies in, and of no other caster.
    let (normal, [origin, ..]) = (caster.normal(met).normalize_or_zero(), caster.of(met));
    let extent = caster.corners.iter().map(|corner| corner.distance(origin)).fold(0.0, f64::max);
    let on_plane = |triangle: &[u32; 3]| {
        caster.normal(*triangle).normalize_or_zero().dot(normal) > 0.999
            && caster.of(*triangle).iter().all(|corner| (*corner - origin).dot(normal).abs() < 1e-4 * extent)
    };
    let rim = Caster::rim(caster.triangles.iter().copied().filter(on_plane));
    let mut corners: Vec<u32> = rim.first().map(|edge| edge[0]).into_iter().collect();
    while let Some(&last) = corners.last()
        && let Some(next) = rim.iter().find(|edge| edge[0] == last).map(|edge| edge[1])
        && !corners.contains(&next)
    {
        corners.push(next);
    }
    let places: Vec<_> = corners.iter().map(|&corner| lens.at(caster.corners[corner as usize])).collect();
    #[expect(clippy::cast_precision_loss, reason = "a polygon's corners")]
    let middle = places.iter().sum::<DVec2>() / places.len().max(1) as f64;
    let mut strokes = Vec::new();
    let mut labels = Vec::new();
    for (index, &place) in places.iter().enumerate() {
        strokes.push(lens.line(place, places[(index + 1) % places.len()], 2.2, RIM));
        strokes.push(dot(place.as_vec2().to_array(), (lens.text() * 0.36) as f32, [RIM[0], RIM[1], RIM[2]]));
        labels.push(lens.note(place + (place - middle).normalize_or_zero() * lens.text() * 1.5, &index.to_string()));
    }
    // Round through points between the corners and the middle, nearly once.
    let arc: Vec<_> = round(&places, middle);
    strokes.extend(arc.windows(2).map(|pair| lens.line(pair[0], pair[1], 2.0, with_alpha([1.0, 1.0, 1.0], 0.95))));
    if let [.., before, end] = arc.as_slice() {
        let way = (*end - *before).normalize_or_zero() * lens.text() * 0.9;
        for turn in [2.6, -2.6] {
            strokes.push(lens.line(*end, *end + DVec2::from_angle(turn).rotate(way), 2.0, [1.0, 1.0, 1.0, 0.95]));
        }
    }
    (strokes, labels)
}

/// A closed curve half-way between a polygon and its middle, but for the last of it.
fn round(corners: &[DVec2], middle: DVec2) -> Vec<DVec2> {
    const STEPS: usize = 12;
    const INWARD: f64 = 0.52;
    let count = corners.len();
    if count < 3 {
        return Vec::new();
    }
    // Between the middles of two edges, bent towards the corner between them.
    let edge = |index: usize| (corners[index % count] + corners[(index + 1) % count]) / 2.0;
    let along = |index: usize, share: f64| {
        let (from, corner, to) = (edge(index), corners[(index + 1) % count], edge(index + 1));
        from.lerp(corner, share).lerp(corner.lerp(to, share), share)
    };
    #[expect(clippy::cast_precision_loss, reason = "a few steps")]
    let point = |step: usize| along(count + step / STEPS - 1, (step % STEPS) as f64 / STEPS as f64);
    (0..count * STEPS - STEPS / 2).map(|step| middle + (point(step) - middle) * INWARD).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rim_of_a_square_has_four_edges_in_its_order() {
        let rim = Caster::rim([[0, 1, 2], [0, 2, 3]].into_iter());
        let mut expected = [[0, 1], [1, 2], [2, 3], [3, 0]];
        expected.sort_unstable();
        let mut found = rim;
        found.sort_unstable();
        assert_eq!(found, expected);
    }
}
