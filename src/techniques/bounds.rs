//! What bounds one light's count, drawn over the view from above (M image 4): the eye's frustum, the slice of
//! it behind the light's scissor, the lights' ranges, the bounds the scissor was made from, and the line from
//! the light to the eye, along which the occlusion pyramid lies (M figure 2).
//!
//! Everything is a line or an area in pixels, projected here in double precision: the plan says where they
//! are, and the GPU only fills them.

use glam::{DVec2, DVec3, DVec4, Vec2};

use super::above::Above;
use super::cases::Class;
use super::show;
use super::surfaces::{self, SurfaceGroup, Tint};
use crate::frame::state::{Blend, State};
use crate::frame::{Action, Camera, Draw, DrawSet, Method, Program, Step, Stroke, Target, VolumePlan};
use crate::geometry::BOX_EDGES;
use crate::geometry::clip::hull;
use crate::geometry::frustum::cube;
use crate::scene::{LightKind, Pose, PosedLight};
use crate::settings::LightBounds;

/// The frustum's lines and the eye itself: display sRGB.
pub const EYE: [f32; 3] = [0.97, 0.98, 1.0];

/// Pixels.
const DOT: f32 = 5.0;

/// What the overlay is drawn from.
#[derive(Debug, Clone, Copy)]
pub struct Scope<'a> {
    /// Where the picture is seen from.
    pub above: &'a Above,
    /// The eye that the light is counted for.
    pub eye: &'a Camera,
    /// Pixels, of both pictures.
    pub size: [u32; 2],
    /// Where the lights are.
    pub pose: &'a Pose,
    /// How many of those are the scene's own: points of lights with a size follow.
    pub lights: usize,
    /// The light that is counted.
    pub light: usize,
    /// What bounds it.
    pub bounds: LightBounds,
    /// Its scissor in the eye's picture; none where it reaches nothing there.
    pub scissor: Option<[u32; 4]>,
}

/// Lines and areas over the view from above, what is covered first.
#[must_use]
pub fn strokes(scope: &Scope<'_>) -> Vec<Stroke> {
    let map = Map::new(scope);
    let mut strokes = Vec::new();
    map.frustum(&mut strokes);
    let shining = scope.pose.lights.iter().take(scope.lights).enumerate().filter(|(_, light)| light.on);
    for (index, light) in shining.clone() {
        map.range(light, index == scope.light, &mut strokes);
    }
    if let Some(light) = scope.pose.lights.get(scope.light) {
        map.bounds(light, &mut strokes);
        map.pyramid(light, &mut strokes);
    }
    for (index, light) in shining {
        map.lamp(light, index == scope.light, &mut strokes);
    }
    strokes.extend(map.at(scope.eye.eye).map(|at| dot(at, DOT, EYE)));
    strokes
}

/// From the world to the picture from above.
pub(super) struct Map<'a> {
    scope: &'a Scope<'a>,
    clip_from_world: glam::DMat4,
    /// Between these heights everything is that is framed.
    low: f64,
    high: f64,
    /// Metres: leads out of the picture from everywhere in it.
    reach: f64,
}

impl<'a> Map<'a> {
    pub fn new(scope: &'a Scope<'a>) -> Self {
        let Above { camera, content, .. } = scope.above;
        let reach = camera.eye.distance(content.min.as_dvec3()) * 2.0;
        let (low, high) = (f64::from(content.min.y), f64::from(content.max.y));
        Self { scope, clip_from_world: camera.clip_from_world(), low, high, reach }
    }

    /// A place's pixel; none at the height of the view's eye and above.
    pub fn at(&self, place: DVec3) -> Option<[f32; 2]> {
        let clip = self.clip_from_world * place.extend(1.0);
        let size = DVec2::new(self.scope.size[0].into(), self.scope.size[1].into());
        let at = (DVec2::new(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * size;
        // Far outside is as good as farther outside.
        let pixel = at.clamp(-size * 100.0, size * 100.0).as_vec2().to_array();
        (clip.w > self.scope.above.camera.eye.y.abs() * 1e-6 && at.is_finite()).then_some(pixel)
    }

    fn line(&self, from: DVec3, to: DVec3, width: f32, color: [f32; 4]) -> Option<Stroke> {
        Some(Stroke { points: vec![self.at(from)?, self.at(to)?], closed: false, width, color, fill: None })
    }

    fn ring(
        &self,
        places: impl IntoIterator<Item = DVec3>,
        width: f32,
        color: [f32; 4],
        fill: Option<[f32; 4]>,
    ) -> Option<Stroke> {
        let points = places.into_iter().map(|place| self.at(place)).collect::<Option<Vec<_>>>()?;
        Some(Stroke { points, closed: true, width, color, fill })
    }

    /// Where a ray of the eye leaves the layer in which everything is.
    pub fn end(&self, towards: DVec3) -> DVec3 {
        let eye = self.scope.eye.eye;
        let way = (towards - eye).normalize_or_zero();
        let out = if way.y < 0.0 { (self.low - eye.y) / way.y } else { (self.high - eye.y) / way.y };
        eye + way * if out.is_finite() { out.clamp(0.0, self.reach) } else { self.reach }
    }

    /// What the eye sees through some of its pixels, as a convex area: the outline of all that its rays meet
    /// between floor and ceiling.
    fn seen_through(&self, pixels: [u32; 4]) -> Vec<[f32; 2]> {
        const STEPS: u32 = 12;
        let corners = self.scope.eye.near_rectangle_of(pixels, self.scope.size);
        let border = (0..4).flat_map(|side| {
            let (a, b) = (corners[side], corners[(side + 1) % 4]);
            (0..STEPS).map(move |step| a.lerp(b, f64::from(step) / f64::from(STEPS)))
        });
        let ends = border.map(|place| self.end(place));
        let places = std::iter::once(self.scope.eye.eye).chain(ends);
        let mut pixels = places.filter_map(|place| self.at(place)).map(|pixel| Vec2::from(pixel).as_dvec2()).collect();
        // What came from single precision fits it again.
        hull(&mut pixels).into_iter().map(|corner| corner.as_vec2().to_array()).collect()
    }

    pub fn frustum(&self, strokes: &mut Vec<Stroke>) {
        let Scope { eye, size, scissor, .. } = *self.scope;
        let whole = [0, 0, size[0], size[1]];
        let white = |alpha| with_alpha(EYE, alpha);
        let area = |pixels, width, color, fill| {
            let points = self.seen_through(pixels);
            (points.len() > 2).then_some(Stroke { points, closed: true, width, color, fill: Some(fill) })
        };
        strokes.extend(area(whole, 1.0, white(0.5), white(0.09)));
        if let (Some(scissor), Some(light)) =
            (scissor.filter(|scissor| *scissor != whole), self.scope.pose.lights.get(self.scope.light))
        {
            let color = hue_of(light);
            strokes.extend(area(scissor, 2.0, with_alpha(color, 0.9), with_alpha(color, 0.16)));
        }
        let ends = eye.near_rectangle().map(|corner| self.end(corner));
        strokes.extend(ends.iter().filter_map(|end| self.line(eye.eye, *end, 2.0, white(1.0))));
        // Where the picture's border runs over the floor.
        let on_floor = |end: DVec3| (end.y - self.low).abs() < 1e-6 * self.reach;
        for (a, b) in (0..4).map(|side| (ends[side], ends[(side + 1) % 4])) {
            strokes.extend(self.line(a, b, 1.0, white(0.5)).filter(|_| on_floor(a) && on_floor(b)));
        }
    }

    /// The circle in which the light's ball is widest.
    fn range(&self, light: &PosedLight, chosen: bool, strokes: &mut Vec<Stroke>) {
        if !light.range.is_finite() {
            return;
        }
        let circle = circle(light.position, DVec3::X * light.range, DVec3::Z * light.range);
        let (width, alpha) = if chosen { (2.5, 1.0) } else { (1.25, 0.55) };
        let color = hue_of(light);
        let fill = chosen.then_some(with_alpha(color, 0.05));
        strokes.extend(self.ring(circle, width, with_alpha(color, alpha), fill));
    }

    /// What the scissor was made from.
    fn bounds(&self, light: &PosedLight, strokes: &mut Vec<Stroke>) {
        let color = with_alpha(hue_of(light), 0.8);
        let bounds = self.scope.bounds;
        if bounds.has_box() && light.range.is_finite() {
            let corners: Vec<_> = cube(light.position, light.range).map(DVec4::truncate).collect();
            let edges = BOX_EDGES.iter().filter_map(|[a, b]| self.line(corners[*a], corners[*b], 1.25, color));
            strokes.extend(edges);
        }
        if let (true, LightKind::Spot { outer, .. }) = (bounds.has_cone(), light.kind) {
            let outer = f64::from(outer).min(1.5);
            let reach = if light.range.is_finite() { light.range } else { self.reach };
            let up = light.direction.cross(light.right);
            let wide = reach * outer.tan();
            let rim: Vec<_> = circle(light.position + light.direction * reach, light.right * wide, up * wide).collect();
            strokes.extend(rim.iter().step_by(CIRCLE / 8).filter_map(|place| self.line(light.position, *place, 1.25, color)));
            strokes.extend(self.ring(rim, 1.25, color, None));
        }
    }

    /// From the light to the eye, dashed: what lies on this line may shade the near plane.
    fn pyramid(&self, light: &PosedLight, strokes: &mut Vec<Stroke>) {
        const DASH: f32 = 7.0;
        let eye = self.scope.eye.eye;
        let towards = if light.kind == LightKind::Directional { self.end(eye - light.direction) } else { light.position };
        let (Some(from), Some(to)) = (self.at(eye), self.at(towards)) else { return };
        let (from, to) = (Vec2::from(from), Vec2::from(to));
        let length = from.distance(to).min(self.scope.size[0] as f32 * 4.0);
        let way = (to - from).normalize_or_zero();
        let dashes = (length / (2.0 * DASH)).ceil() as usize;
        let color = with_alpha(hue_of(light), 1.0);
        strokes.extend((0..dashes).map(|dash| {
            let begin = dash as f32 * 2.0 * DASH;
            let points = [begin, (begin + DASH).min(length)].map(|along| (from + way * along).to_array());
            Stroke { points: points.into(), closed: false, width: 1.5, color, fill: None }
        }));
    }

    fn lamp(&self, light: &PosedLight, chosen: bool, strokes: &mut Vec<Stroke>) {
        if light.kind == LightKind::Directional {
            return;
        }
        let Some(at) = self.at(light.center) else { return };
        strokes.push(dot(at, if chosen { DOT * 1.4 } else { DOT }, hue_of(light)));
    }
}

const CIRCLE: usize = 72;

fn circle(middle: DVec3, right: DVec3, up: DVec3) -> impl Iterator<Item = DVec3> {
    (0..CIRCLE).map(move |step| {
        let (sin, cos) = (std::f64::consts::TAU * step as f64 / CIRCLE as f64).sin_cos();
        middle + right * cos + up * sin
    })
}

/// A disc with a dark rim.
pub(super) fn dot(at: [f32; 2], radius: f32, color: [f32; 3]) -> Stroke {
    let points = (0..24).map(|step| {
        let (sin, cos) = (std::f32::consts::TAU * step as f32 / 24.0).sin_cos();
        [at[0] + radius * cos, at[1] + radius * sin]
    });
    let rim = [0.03, 0.03, 0.05, 1.0];
    Stroke { points: points.collect(), closed: true, width: 2.0, color: rim, fill: Some(with_alpha(color, 1.0)) }
}

/// A light's hue at full brightness, as pictures store it.
fn hue_of(light: &PosedLight) -> [f32; 3] {
    let brightest = light.intensity.max_element();
    let hue = if brightest > 0.0 { light.intensity / brightest } else { glam::Vec3::ONE };
    // Pale enough to be seen on what is dark.
    (hue * 0.85 + 0.15).to_array().map(|linear| linear.powf(1.0 / 2.2))
}

fn with_alpha([r, g, b]: [f32; 3], alpha: f32) -> [f32; 4] {
    [r, g, b, alpha]
}

/// The colours of the classes in the view from above: what casts nothing is dim, for the lines to stand out.
#[must_use]
pub fn color_of(class: Class) -> [f32; 3] {
    match class {
        Class::Receiver => [0.30, 0.31, 0.34],
        _ => class.color(),
    }
}

/// The light's volumes as thin glass: the more there are, the thinner.
#[must_use]
pub fn glass(volumes: &[VolumePlan], light: usize, scissor: [u32; 4]) -> Vec<Step> {
    /// So many layers of glass still let the scene through.
    const FEW: f32 = 10.0;
    let counted = volumes.iter().filter(|volume| volume.light == light && volume.method != Method::Dropped).count();
    let mut steps = show::volumes(volumes, light, scissor);
    for step in &mut steps {
        if let Action::Draw(draw) = &mut step.action {
            let [r, g, b, alpha] = draw.constant;
            // Dark, so that many layers do not outshine the rest.
            draw.constant = [r * 0.5, g * 0.5, b * 0.5, alpha * (FEW / counted as f32).sqrt().min(1.0)];
        }
    }
    steps
}

/// What the near plane cut open, filled as an architect's plan fills it.
#[must_use]
pub fn cut(groups: &[SurfaceGroup], scissor: [u32; 4]) -> Vec<Step> {
    let why = "What covers the eye is cut away: the inside of what was cut open is dark.";
    let tint = Tint { label: "cut", why, color: [0.10, 0.10, 0.12, 1.0], inside: true };
    surfaces::tinted(groups, &tint, |_| true, scissor)
}

/// The lines over the finished picture.
#[must_use]
pub fn step(strokes: Vec<Stroke>, scissor: [u32; 4]) -> Step {
    let why = "Draws the eye's frustum, the light's scissor as a slice of it, ranges and bounds over the finished picture.";
    let draw = Draw {
        target: Target::Output,
        state: State { color: Some(Blend::Over), ..State::FLAT },
        ..Draw::plain(Program::Lines, DrawSet::Strokes(strokes), scissor)
    };
    Step::drawing("bounds", why, draw)
}
