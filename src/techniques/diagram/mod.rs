//! The papers' diagrams, drawn as the live scene: from the side, cut along the plane that the eye looks in ([`section`]),
//! with rays, volumes and counts drawn in (K figures 2, 8, 10 and 13; M figures 1, 2 and 4; Beam's pictures); and what
//! is told best from elsewhere ([`fan`]).
//!
//! All of it is lines, areas and words in pixels over a picture of the scene.

pub mod fan;
pub mod rays;
pub mod section;
mod sheet;

use glam::{DVec2, DVec3};

use self::rays::{RAYS, Ray};
use self::section::{Piece, Plane, Section};
pub use self::sheet::Sheet;
use super::above::content;
use super::cases::Class;
use crate::frame::state::{Blend, State};
use crate::frame::{Camera, Draw, DrawSet, Program, Step, Stroke, Target};
use crate::geometry::Aabb;
use crate::scene::{LightKind, Mirror, Pose, PosedLight, Scene};
use crate::settings::Diagram;

/// Full vertical angle of the view from the side, radians: narrow, so that what is upright looks so.
const FIELD_OF_VIEW: f64 = 0.35;

/// Room about what is framed, as a share of it.
const MARGIN: f64 = 0.16;

/// Room beyond it, as a share of it.
const AHEAD: f64 = 0.2;

/// What is drawn of.
#[derive(Debug, Clone, Copy)]
pub struct Scope<'a> {
    /// What is cut open.
    pub scene: &'a Scene,
    /// Where it is.
    pub pose: &'a Pose,
    /// The eye whose plane it is cut along.
    pub eye: &'a Camera,
    /// The light whose volumes are drawn.
    pub light: &'a PosedLight,
    /// What reflects.
    pub mirrors: &'a [Mirror],
    /// What each instance is to the light.
    pub classes: &'a [Class],
}

impl Scope<'_> {
    /// What the plane cuts of what casts, with the eye and the lamp; everything, where that is nothing.
    fn framed(&self, lamp: bool) -> Aabb {
        let Self { scene, pose, eye, light, .. } = *self;
        let all = content(scene, pose, eye.eye);
        let plane = Plane::of(eye);
        let cut = |casts: bool, most: f32| {
            let all = scene.instances().filter(|(_, node, _)| node.casts_shadow == casts);
            let cut = all.map(|(node, ..)| pose.world_bounds(scene, node)).filter(|bounds| plane.cuts(bounds));
            cut.filter(|bounds| bounds.radius() < most).fold(Aabb::EMPTY, |all, bounds| all.union(&bounds))
        };
        let casters = cut(true, f32::INFINITY);
        if casters.is_empty() {
            return all;
        }
        // What casts nothing is framed, too, unless it is a floor or a wall.
        let cut = casters.union(&cut(false, casters.radius() * 1.5)).union(&Aabb::around(eye.eye, eye.eye));
        let near = light.kind != LightKind::Directional && light.position.distance(eye.eye) < f64::from(cut.radius()) * 3.0;
        if near && lamp { cut.union(&Aabb::around(light.position, light.position)) } else { cut }
    }

    /// The plane, what is on it, and how far rays are followed, metres.
    fn section(&self, plane: &Plane) -> (Section, f64) {
        let farthest = f64::from(content(self.scene, self.pose, self.eye.eye).radius()) * 4.0;
        (Section::new(self.scene, self.pose, plane, self.light, self.mirrors, farthest * 2.0), farthest)
    }
}

/// Where the scene is seen from the side, right of the eye: its near plane is the upright plane that the eye looks in, so
/// that what lies before it is cut away. The eye looks to the right of the picture.
#[must_use]
pub fn side(diagram: Diagram, scope: &Scope<'_>) -> Camera {
    let (framed, eye, plane) = (scope.framed(diagram != Diagram::Mirrors), scope.eye, Plane::of(scope.eye));
    let (min, max) = (framed.min.as_dvec3(), framed.max.as_dvec3());
    let corners =
        (0..8).map(|i| DVec3::from_array([0, 1, 2].map(|axis| if i >> axis & 1 == 1 { max } else { min }.to_array()[axis])));
    let along = |way: DVec3| {
        corners.clone().map(move |corner| corner.dot(way)).fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)))
    };
    let ((back, front), (low, high)) = (along(plane.ahead()), along(DVec3::Y));
    // Shadows lead on, mostly ahead.
    let front = front + (front - back) * AHEAD;
    let half = DVec2::new(front - back, high - low).max(DVec2::splat(0.1)) / 2.0 * (1.0 + MARGIN);
    let distance = (half.y.max(half.x / eye.aspect)) / (FIELD_OF_VIEW / 2.0).tan();
    let right = plane.right();
    let middle = plane.ahead() * ((back + front) / 2.0) + DVec3::Y * ((low + high) / 2.0) + right * eye.eye.dot(right);
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

/// The colour of what so many volumes hold: light where none does, and the deeper the more they are.
pub(super) const fn color(count: u32) -> [f32; 3] {
    match count {
        0 => [1.0, 0.90, 0.55],
        1 => [0.62, 0.50, 1.0],
        2 => [0.90, 0.36, 0.86],
        _ => [1.0, 0.30, 0.42],
    }
}

/// What the papers draw their frusta in.
const FRUSTUM: [f32; 4] = [0.45, 0.70, 1.0, 0.9];

/// What they draw the occlusion pyramid in.
const PYRAMID: [f32; 4] = [1.0, 0.36, 0.28, 1.0];

/// The diagram over the view from the side.
#[must_use]
pub fn overlay<'a>(diagram: Diagram, scope: &Scope<'a>, side: &'a Camera, size: [u32; 2]) -> Sheet<'a> {
    let plane = Plane::of(scope.eye);
    let (section, farthest) = scope.section(&plane);
    let mut sheet = Sheet::new(plane, side, size);
    let forward = plane.way(scope.eye.forward).truncate();
    match diagram {
        Diagram::Slice => {
            sheet.shadows(&section, 0.34);
            sheet.solids(&section);
            sheet.outline(&section);
            sheet.names(scope, &section);
            sheet.verdicts(&section);
            sheet.shadow_words(&section);
        }
        Diagram::Ends => {
            sheet.shadows(&section, 0.22);
            sheet.solids(&section);
            sheet.outline(&section);
            ends(&mut sheet, scope, &section, forward);
        }
        Diagram::Pyramid => {
            sheet.shadows(&section, 0.22);
            pyramid(&mut sheet, scope, &section, forward, farthest);
        }
        Diagram::BackFaces | Diagram::BothFaces => {
            let beyond = |place: DVec2, fronts: bool| counted_beyond(&section, place, fronts, farthest);
            let inside = Wedge::of(scope.eye, &plane);
            sheet.shadows(&section, 0.14);
            sheet.areas(|place| if inside.holds(place) { beyond(place, diagram == Diagram::BothFaces) } else { 0 });
            sheet.solids(&section);
            sheet.outline(&section);
            inside.draw(&mut sheet, farthest);
            sheet.legend(&[(1, "counted, a surface there would be dark")]);
        }
        Diagram::Mirrors => {
            sheet.solids(&section);
            mirrors(&mut sheet, scope, &section, farthest);
        }
        Diagram::Rays | Diagram::Fan | Diagram::Order => {
            sheet.shadows(&section, 0.22);
            sheet.solids(&section);
            sheet.outline(&section);
            for (number, ray) in rays::through(&section, scope.eye, &plane, farthest).iter().enumerate() {
                // The rays lie close together at the eye: their first counts stand farther out, by turns.
                sheet.ray(ray, [0.62, 0.86][number % 2]);
            }
            sheet.legend(&[(0, "0, lit"), (1, "1 volume"), (2, "2"), (3, "3 and more")]);
        }
    }
    sheet.dot(DVec2::ZERO, 1.3, super::bounds::EYE);
    sheet
}

/// How often a place would be counted by z-fail, were a surface there: back faces beyond it, along the eye's ray, less front
/// faces where those count, too.
fn counted_beyond(section: &Section, place: DVec2, fronts: bool, farthest: f64) -> u32 {
    let legs = section.legs(place, place.normalize_or(DVec2::X), farthest);
    let left: u32 = legs.windows(2).map(|pair| pair[0].1.saturating_sub(pair[1].1)).sum();
    let entered: u32 = legs.windows(2).map(|pair| pair[1].1.saturating_sub(pair[0].1)).sum();
    // What a ray has not left it leaves by the dark cap, at infinity.
    let left = left + legs.last().map_or(0, |leg| leg.1);
    if fronts { left.saturating_sub(entered) } else { left }
}

/// One ray, what is counted on either side of where it ends, and from where.
fn ends(sheet: &mut Sheet<'_>, scope: &Scope<'_>, section: &Section, forward: DVec2) {
    let (near, wedge) = (scope.eye.near, Wedge::of(scope.eye, &Plane::of(scope.eye)));
    wedge.draw(sheet, 1.6 * near);
    let (low, high) = wedge.viewport();
    sheet.line(low, high, 3.0, with_alpha(super::bounds::EYE, 1.0));
    sheet.line(DVec2::ZERO, forward * near, 1.0, with_alpha(color(0), 0.6));
    let surface = section.surface(DVec2::ZERO, forward, near).map(|(metres, _)| metres);
    let (hit, out) = (surface.unwrap_or(f64::INFINITY), sheet.way_out(DVec2::ZERO, forward));
    let legs: Vec<_> = section.legs(forward * near, forward, out - near).into_iter().map(|(to, n)| (to + near, n)).collect();
    let mut from = near;
    for &(to, count) in &legs {
        let color = with_alpha(color(count), 1.0);
        if from < hit {
            sheet.line(forward * from, forward * to.min(hit), 2.5, color);
        }
        if to > hit {
            sheet.dashes(forward * from.max(hit), forward * to, 2.0, color);
        }
        from = to;
    }
    // Entered is one more, left is one less, on both sides; z-fail, on its way from infinity, takes the other sense.
    let mut said = [String::new(), String::new()];
    let mut sums = [0; 2];
    for pair in legs.windows(2) {
        let [(at, before), (_, after)] = [pair[0], pair[1]];
        let change = i64::from(after) - i64::from(before);
        let beyond = usize::from(at > hit);
        let words = format!("{change:+}");
        sheet.dot(forward * at, 1.0, color(before.max(after)));
        sheet.note(forward * at, [0.0, -1.7], &words);
        said[beyond] += &format!(" {words}");
        sums[beyond] += change;
    }
    if let Some(&(_, held)) = legs.last().filter(|(_, held)| *held > 0) {
        said[1] += &format!(" -{held} at the dark cap");
        sums[1] -= i64::from(held);
    }
    sheet.dot(forward * near, 1.0, super::bounds::EYE);
    sheet.note(forward * near, [0.0, 2.6], "U, at the viewport");
    if surface.is_some() {
        sheet.dot(forward * hit, 1.4, [FRUSTUM[0], FRUSTUM[1], FRUSTUM[2]]);
        sheet.note(forward * hit, [-1.3, 1.5], "P");
    }
    sheet.note(forward * (out * 0.96), [-2.0, -1.8], "U, at infinity");
    let sum = |side: usize| if said[side].is_empty() { " nothing".to_owned() } else { said[side].clone() };
    let words =
        format!("U to P, z-pass:{}, so {} hold P;  P to infinity, z-fail:{}, so {} hold P", sum(0), sums[0], sum(1), -sums[1]);
    sheet.caption(&words);
    sheet.names(scope, section);
}

/// The eye's frustum, the pyramid from the light to its viewport, and the casters in the colours of their cases.
fn pyramid(sheet: &mut Sheet<'_>, scope: &Scope<'_>, section: &Section, forward: DVec2, farthest: f64) {
    let plane = Plane::of(scope.eye);
    let wedge = Wedge::of(scope.eye, &plane);
    let (low, high) = wedge.viewport();
    let light = plane.place(scope.light.position).truncate();
    let away = plane.way(scope.light.direction).truncate().normalize_or(DVec2::NEG_Y);
    // Towards a light at infinity its sides run side by side.
    let tip = |end: DVec2| if scope.light.kind == LightKind::Directional { end - away * farthest } else { light };
    sheet.area(&[low, high, tip(high), tip(low)], with_alpha([PYRAMID[0], PYRAMID[1], PYRAMID[2]], 0.18));
    sheet.solids_in(section, |instance| {
        let class = scope.classes.get(instance).copied().unwrap_or(Class::Receiver);
        (class != Class::Receiver).then(|| class.color())
    });
    wedge.dashed(sheet, farthest);
    for end in [low, high] {
        sheet.line(end, tip(end), 2.0, PYRAMID);
    }
    sheet.line(low, high, 4.0, with_alpha(super::bounds::EYE, 1.0));
    sheet.note(forward * scope.eye.near, [0.0, 2.4], "viewport");
    let mut said = Vec::new();
    for piece in &section.pieces {
        let Some(&class) = scope.classes.get(piece.instance) else { continue };
        if said.iter().all(|(instance, _)| *instance != piece.instance) && class != Class::Receiver {
            said.push((piece.instance, class));
        }
    }
    for (instance, class) in &said {
        sheet.note(middle_of(section, *instance), [0.0, -2.2], class.name());
    }
    let first = said.iter().map(|(_, class)| *class).max_by_key(|class| *class != Class::LeftOut && *class != Class::One);
    if let Some(class) = first {
        sheet.caption(&format!("{}: {}", class.name(), class.words()));
    }
}

/// Rays that mirrors turn back, with where what is seen in them seems to stand, and rays that lead past them.
fn mirrors(sheet: &mut Sheet<'_>, scope: &Scope<'_>, section: &Section, farthest: f64) {
    const MOST_BOUNCES: usize = 4;
    const TURNED: [f32; 4] = [0.42, 0.84, 0.95, 1.0];
    const PAST: [f32; 4] = [1.0, 0.45, 0.32, 1.0];
    let panes: Vec<Piece> = section.pieces.iter().copied().filter(|piece| piece.mirror).collect();
    sheet.reflected(section, &panes);
    sheet.outline_in(section, |piece| if piece.mirror { (TURNED, 4.0) } else { ([0.80, 0.82, 0.86, 0.9], 1.4) });
    let plane = Plane::of(scope.eye);
    let (mut turned, mut past) = (0, 0);
    for number in 0..RAYS + 2 {
        let mut way = rays::way(scope.eye, &plane, number, RAYS + 2).1;
        let (mut from, mut nearest, mut bounces) = (DVec2::ZERO, scope.eye.near, 0);
        let straight = way;
        let mut first = None;
        loop {
            let hit = section.surface(from, way, nearest);
            let to = from + way * hit.map_or(farthest, |(metres, _)| metres);
            let behind = bounces == 0 && panes.iter().any(|pane| crosses(pane, from, to));
            let color = if bounces > 0 {
                TURNED
            } else if behind {
                PAST
            } else {
                with_alpha(color(0), 1.0)
            };
            sheet.line(from, to, 2.0, color);
            past += usize::from(behind);
            let Some((_, piece)) = hit else { break };
            if bounces > 0 || !piece.mirror {
                sheet.dot(to, 0.9, [color[0], color[1], color[2]]);
            }
            if !piece.mirror || bounces == MOST_BOUNCES {
                if let (Some(begun), false) = (first, piece.mirror) {
                    // As far straight on as the turned ray is long.
                    let length = to.distance(begun);
                    sheet.dashes(begun, begun + straight * length, 1.2, [TURNED[0], TURNED[1], TURNED[2], 0.7]);
                }
                break;
            }
            let normal = piece.out.normalize_or(DVec2::Y);
            way -= normal * (2.0 * way.dot(normal));
            first = first.or(Some(to));
            turned += usize::from(bounces == 0);
            (from, nearest, bounces) = (to, 1e-6 * farthest, bounces + 1);
        }
    }
    if let Some(pane) = panes.first() {
        sheet.note((pane.from + pane.to) / 2.0, [0.0, 1.6], "mirror");
    }
    let lead = match past {
        0 => "none leads to behind its plane: a constrained reflection".to_owned(),
        1 => "1 leads to behind its plane: an unconstrained reflection".to_owned(),
        _ => format!("{past} lead to behind its plane: an unconstrained reflection"),
    };
    sheet.caption(&format!("{turned} rays meet the mirror; {lead}"));
}

/// Whether the line from one place to another crosses the plane of a pane, from its front to its back, beside the pane.
fn crosses(pane: &Piece, from: DVec2, to: DVec2) -> bool {
    let height = |place: DVec2| pane.out.dot(place - pane.from);
    let (before, after) = (height(from), height(to));
    let scale = pane.out.length() * (to - from).length() * 1e-6;
    before > scale && after < -scale
}

/// The middle of what is cut of an instance.
fn middle_of(section: &Section, instance: usize) -> DVec2 {
    let of_it = section.pieces.iter().filter(|piece| piece.instance == instance);
    let (min, max) = of_it.fold((DVec2::MAX, DVec2::MIN), |(min, max), piece| {
        (min.min(piece.from).min(piece.to), max.max(piece.from).max(piece.to))
    });
    (min + max) / 2.0
}

const fn with_alpha([r, g, b]: [f32; 3], alpha: f32) -> [f32; 4] {
    [r, g, b, alpha]
}

/// What of the plane the eye sees.
struct Wedge {
    low: DVec2,
    high: DVec2,
    near: f64,
}

impl Wedge {
    fn of(eye: &Camera, plane: &Plane) -> Self {
        let way = |share: f64| plane.way(eye.forward + eye.up * ((eye.vertical_fov / 2.0).tan() * share)).truncate();
        Self { low: way(-1.0), high: way(1.0), near: eye.near }
    }

    fn holds(&self, place: DVec2) -> bool {
        self.low.perp_dot(place) >= 0.0 && self.high.perp_dot(place) <= 0.0 && place.dot(self.low + self.high) > 0.0
    }

    /// The near rectangle's lower and upper end.
    fn viewport(&self) -> (DVec2, DVec2) {
        (self.low * self.near, self.high * self.near)
    }

    fn draw(&self, sheet: &mut Sheet<'_>, length: f64) {
        for way in [self.low, self.high] {
            sheet.line(DVec2::ZERO, way * length, 1.6, FRUSTUM);
        }
    }

    fn dashed(&self, sheet: &mut Sheet<'_>, length: f64) {
        for way in [self.low, self.high] {
            sheet.dashes(DVec2::ZERO, way * length, 1.6, FRUSTUM);
        }
    }
}

/// Lines and areas over the finished picture.
#[must_use]
pub fn step(strokes: Vec<Stroke>, scissor: [u32; 4]) -> Step {
    let why = "The diagram over the picture: rays, volumes and counts, in the colour of how many volumes hold what they show.";
    let draw = Draw {
        target: Target::Output,
        state: State { color: Some(Blend::Over), ..State::FLAT },
        ..Draw::plain(Program::Lines, DrawSet::Strokes(strokes), scissor)
    };
    Step::drawing("diagram", why, draw)
}

/// Rays of the eye in the upright plane that it looks in, with one light's count along each.
#[must_use]
pub fn rays(scene: &Scene, pose: &Pose, eye: &Camera, light: usize) -> Vec<Ray> {
    let Some(light) = pose.lights.get(light).filter(|light| light.on) else { return Vec::new() };
    let plane = Plane::of(eye);
    let (section, farthest) = Scope { scene, pose, eye, light, mirrors: &[], classes: &[] }.section(&plane);
    rays::through(&section, eye, &plane, farthest)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use crate::director::stage;
    use crate::frame::Capabilities;
    use crate::scene::stock;
    use crate::settings::Settings;

    /// Back faces less front faces beyond a place are the volumes that hold it, and back faces alone never fewer.
    #[test]
    fn both_faces_count_what_holds_a_place() {
        for name in ["slice", "slabs"] {
            let scene = stock::build(name).unwrap().unwrap();
            let (pose, plan) = stage(&Settings::default(), &scene, &Capabilities::complete()).unwrap();
            let (eye, light) = (&plan.views[0].camera, &pose.lights[0]);
            let scope = Scope { scene: &scene, pose: &pose, eye, light, mirrors: &[], classes: &[] };
            let (section, farthest) = scope.section(&Plane::of(eye));
            let mut seen = [0; 2];
            for (x, y) in (1..40).flat_map(|x| (-8..16).map(move |y| (x, y))) {
                let place = DVec2::new(f64::from(x) * 0.201, f64::from(y) * 0.173);
                let held = section.legs(place, DVec2::new(0.6, 0.8), farthest)[0].1;
                assert_eq!(counted_beyond(&section, place, true, farthest), held, "{name}, {place}");
                let backs = counted_beyond(&section, place, false, farthest);
                assert!(backs >= held, "{name}, {place}");
                seen[0] += usize::from(held > 0);
                seen[1] += usize::from(backs > held);
            }
            assert!(seen.iter().all(|places| *places > 30), "{name}: {seen:?} held, and counted wrongly by back faces alone");
        }
    }
}
