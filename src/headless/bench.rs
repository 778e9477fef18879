//! `obscura bench`: how long frames take, and what their shadow volumes cost.
//!
//! A frame is measured from before it is planned until the device has drawn it, so that the work of different frames
//! does not overlap; nothing is read back in between. Lights go round in small circles: every silhouette and every
//! volume is found anew, and yet all frames are alike. Light that is kept still by nobody's wish would be kept from
//! frame to frame by a cleverer renderer, and its cost not be seen.

use std::f64::consts::TAU;
use std::fmt::{self, Display};
use std::time::Instant;

use glam::DVec3;
use indicatif::ProgressBar;
use serde::Serialize;

use super::{HeadlessError, check_exists, progress_bar};
use crate::cli::{BenchRequest, check};
use crate::director::{self, Planner};
use crate::gpu::{Context, GpuError, Renderer, readback};
use crate::scene::{LightKind, Pose, Scene};
use crate::settings::{Settings, Technique};
use crate::techniques::fill;

/// Frames of one round of the lights; so many are drawn, and not measured, to warm up: pipelines that are needed
/// anywhere on the way are compiled then.
pub const ROUND: u32 = 20;
/// Metres: how far from its place a light goes at most.
const FARTHEST: f64 = 0.5;
/// In small scenes it is this part of their diagonal.
const PART_OF_SCENE: f64 = 0.02;
/// Radians: how far directional light turns from its own direction.
const TURN: f64 = 0.02;

/// What was measured.
#[derive(Debug, Clone, Serialize)]
#[serde(transparent)]
pub struct Report {
    /// The device.
    #[serde(skip)]
    pub adapter: String,
    /// Picture by picture.
    pub rows: Vec<Row>,
}

/// One scene by one technique.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// The scene's name.
    pub scene: String,
    /// How its shadows were counted.
    pub technique: Technique,
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// How many were measured.
    pub frames: u32,
    /// Milliseconds from before a frame was planned until it was drawn.
    pub frame_ms: Spread,
    /// Milliseconds of this thread, until the frame was submitted.
    pub cpu_ms: Spread,
    /// Milliseconds of the device; none where it has no timestamps.
    pub gpu_ms: Option<Spread>,
    /// Fragments of shadow volumes, of all passes, for each pixel of the picture; the lights at their places.
    pub fragments_per_pixel: f64,
    /// Triangles of shadow volumes that were drawn in a frame: the median.
    pub volume_triangles: u64,
    /// Indices of shadow volumes that were built in a frame: the median.
    pub indices: u64,
}

/// What lies in the middle of many numbers, and near both ends.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Spread {
    /// Half are below.
    pub median: f64,
    /// One in ten is below.
    pub p10: f64,
    /// One in ten is above.
    pub p90: f64,
}

impl Spread {
    /// Of some numbers, in any order; zeros where there are none.
    #[must_use]
    pub fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        // The nearest in rank.
        let at = |share: usize| values.get((values.len().saturating_sub(1) * share + 50) / 100).copied().unwrap_or(0.0);
        Self { median: at(50), p10: at(10), p90: at(90) }
    }
}

/// A table for people: what belongs to one scene stands together, numbers under one another.
impl Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const HEAD: [&str; 8] =
            ["scene", "technique", "frame ms", "CPU ms", "GPU ms", "fragments a pixel", "volume triangles", "indices"];
        let Some(first) = self.rows.first() else { return Ok(()) };
        let Row { width, height, frames, .. } = first;
        writeln!(f, "{}, {width} x {height} pixels; medians of {frames} frames (10th to 90th percentile)\n", self.adapter)?;
        let cells = |row: &Row| {
            [
                row.scene.clone(),
                row.technique.name().into(),
                row.frame_ms.to_string(),
                row.cpu_ms.to_string(),
                row.gpu_ms.map_or("none".into(), |spread| spread.to_string()),
                format!("{:.2}", row.fragments_per_pixel),
                row.volume_triangles.to_string(),
                row.indices.to_string(),
            ]
        };
        let lines: Vec<_> = [HEAD.map(str::to_owned)].into_iter().chain(self.rows.iter().map(cells)).collect();
        let width = |column: usize| lines.iter().map(|cells| cells[column].chars().count()).max().unwrap_or(0);
        let widths: [usize; HEAD.len()] = std::array::from_fn(width);
        for cells in &lines {
            let [name, technique, numbers @ ..] = cells;
            write!(f, "{name:<0$}  {technique:<1$}", widths[0], widths[1])?;
            for (number, width) in numbers.iter().zip(&widths[2..]) {
                write!(f, "  {number:>width$}")?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}

impl Display for Spread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { median, p10, p90 } = self;
        write!(f, "{median:.2} ({p10:.2} to {p90:.2})")
    }
}

/// Measures what is asked for.
///
/// # Errors
/// Whatever stands in the way of the first picture that cannot be drawn.
pub fn bench(request: &BenchRequest) -> Result<Report, HeadlessError> {
    for settings in &request.pictures {
        check(settings)?;
        check_exists(&settings.scene)?;
    }
    let mut bench = Bench::new(request.pictures.first().unwrap_or(&Settings::default()))?;
    let progress = progress_bar(request.pictures.len() as u64 * u64::from(request.frames));
    let mut rows = Vec::with_capacity(request.pictures.len());
    for of_scene in request.pictures.chunk_by(|a, b| a.scene == b.scene) {
        let scene = super::render::open(&of_scene[0])?;
        bench.set_scene(&scene)?;
        for settings in of_scene {
            progress.set_message(format!("{} {}", scene.name, settings.technique.name()));
            rows.push(bench.measure(&scene, settings, request.frames, &progress)?);
        }
    }
    progress.finish_and_clear();
    Ok(Report { adapter: bench.adapter().into(), rows })
}

/// A device that frames are measured on.
pub struct Bench {
    context: Context,
    renderer: Renderer,
    planner: Planner,
}

impl Bench {
    /// Opens the device, with the adapter and the shaders that `settings` say.
    ///
    /// # Errors
    /// No device, or shaders that do not compile.
    pub fn new(settings: &Settings) -> Result<Self, GpuError> {
        let context = Context::headless(settings.adapter.as_deref())?;
        let renderer = Renderer::new(&context, settings.shaders.as_deref())?;
        Ok(Self { context, renderer, planner: Planner::default() })
    }

    /// The device's name.
    #[must_use]
    pub fn adapter(&self) -> &str {
        &self.context.capabilities().adapter
    }

    /// The scene that is measured next.
    ///
    /// # Errors
    /// A scene that does not fit the device.
    pub fn set_scene(&mut self, scene: &Scene) -> Result<(), GpuError> {
        self.renderer.set_scene(&self.context, scene)
    }

    /// Draws and measures `frames` frames of the scene that was set; says each to `progress`.
    ///
    /// # Errors
    /// Settings that cannot be drawn, or a device that cannot.
    pub fn measure(
        &mut self,
        scene: &Scene,
        settings: &Settings,
        frames: u32,
        progress: &ProgressBar,
    ) -> Result<Row, HeadlessError> {
        let texture = readback::target(&self.context, settings.size);
        let output = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let fragments = self.fragments(scene, settings, &output)?;
        let radius = radius(scene, settings);
        for number in 0..ROUND.min(frames) {
            self.frame(scene, settings, &output, (number, radius))?;
        }
        let mut measured = Vec::with_capacity(frames as usize);
        for number in 0..frames {
            measured.push(self.frame(scene, settings, &output, (number, radius))?);
            progress.inc(1);
        }
        let spread = |of: fn(&Frame) -> f64| Spread::of(measured.iter().map(of).collect());
        let gpu: Vec<_> = measured.iter().filter_map(|frame| frame.gpu_ms).collect();
        let [width, height] = settings.size;
        #[expect(
            clippy::cast_precision_loss,
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "counts below 2^53"
        )]
        let middle = |of: fn(&Frame) -> u64| Spread::of(measured.iter().map(|frame| of(frame) as f64).collect()).median as u64;
        Ok(Row {
            scene: scene.name.clone(),
            technique: settings.technique,
            width,
            height,
            frames,
            frame_ms: spread(|frame| frame.frame_ms),
            cpu_ms: spread(|frame| frame.cpu_ms),
            gpu_ms: (!gpu.is_empty()).then(|| Spread::of(gpu)),
            fragments_per_pixel: fragments / (f64::from(width) * f64::from(height)),
            volume_triangles: middle(|frame| frame.volume_triangles),
            indices: middle(|frame| frame.indices),
        })
    }

    /// Plans and draws one frame, and waits for it: `place` is which of a round, and how far lights go.
    fn frame(
        &mut self,
        scene: &Scene,
        settings: &Settings,
        output: &wgpu::TextureView,
        (number, radius): (u32, f64),
    ) -> Result<Frame, HeadlessError> {
        let Self { context, renderer, planner } = self;
        let turns = f64::from(number % ROUND) / f64::from(ROUND);
        let gathered = number % director::frames(settings);
        let begun = Instant::now();
        let (pose, plan) =
            planner.stage_changed(settings, scene, context.capabilities(), gathered, |pose| go_round(pose, turns, radius))?;
        let mut drawn = renderer.render(context, &plan, scene, &pose, output, readback::PICTURE_FORMAT)?;
        let submitted = begun.elapsed();
        context.wait_idle()?;
        let done = begun.elapsed();
        readback::add_computed(context, renderer, &plan, &mut drawn)?;
        planner.take_back((pose, plan));
        if let Some(error) = context.take_error() {
            return Err(GpuError::Device(error).into());
        }
        Ok(Frame {
            frame_ms: done.as_secs_f64() * 1e3,
            cpu_ms: submitted.as_secs_f64() * 1e3,
            gpu_ms: renderer.gpu_ms(),
            volume_triangles: drawn.volume_triangles,
            indices: drawn.indices,
        })
    }

    /// How many fragments the volumes of a frame have, the lights at their places.
    fn fragments(&mut self, scene: &Scene, settings: &Settings, output: &wgpu::TextureView) -> Result<f64, HeadlessError> {
        let Self { context, renderer, .. } = self;
        let (pose, plan) = director::stage(settings, scene, context.capabilities())?;
        let Some(counting) = fill::counted(&plan) else { return Ok(0.0) };
        renderer.render(context, &counting, scene, &pose, output, readback::PICTURE_FORMAT)?;
        Ok(readback::counts(context, renderer)?.into_iter().map(f64::from).sum())
    }
}

/// What was measured of one frame.
struct Frame {
    frame_ms: f64,
    cpu_ms: f64,
    gpu_ms: Option<f64>,
    volume_triangles: u64,
    indices: u64,
}

/// Metres that lights go from their places.
fn radius(scene: &Scene, settings: &Settings) -> f64 {
    let animation = settings.animation.unwrap_or(scene.default_animation);
    let bounds = scene.bounds(&crate::scene::pose::pose(scene, settings.time, animation, &settings.lights));
    let diagonal = f64::from((bounds.max - bounds.min).length());
    // Nothing to see has no size.
    if diagonal.is_finite() { (diagonal * PART_OF_SCENE).min(FARTHEST) } else { FARTHEST }
}

/// Every light on its way round its place, in parts of the whole, metres away from it: about the vertical; directional
/// light about its direction.
pub fn go_round(pose: &mut Pose, turns: f64, radius: f64) {
    let (sin, cos) = (turns * TAU).sin_cos();
    for light in &mut pose.lights {
        if light.kind == LightKind::Directional {
            let up = light.right.cross(light.direction);
            light.direction = (light.direction + (light.right * cos + up * sin) * TURN).normalize();
            let right = light.right.reject_from_normalized(light.direction);
            light.right = right.try_normalize().unwrap_or_else(|| light.direction.any_orthonormal_vector());
        } else {
            let aside = DVec3::new(cos, 0.0, sin) * radius;
            light.position += aside;
            light.center += aside;
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;
    use crate::scene::PosedLight;

    #[test]
    fn a_spread_is_what_lies_in_the_middle_and_near_both_ends() {
        let backwards = (0..=100).rev().map(f64::from).collect();
        assert_eq!(Spread::of(backwards), Spread { median: 50.0, p10: 10.0, p90: 90.0 });
        assert_eq!(Spread::of(vec![7.0]), Spread { median: 7.0, p10: 7.0, p90: 7.0 });
        assert_eq!(Spread::of(Vec::new()), Spread::default());
    }

    #[test]
    fn lights_go_round_their_places_and_directions() {
        let places = |turns: f64| {
            let sun = PosedLight { kind: LightKind::Directional, ..PosedLight::default() };
            let mut pose = Pose { lights: vec![PosedLight::default(), sun], ..Pose::default() };
            go_round(&mut pose, turns, 0.25);
            (pose.lights[0].position, pose.lights[0].center, pose.lights[1].direction, pose.lights[1].right)
        };
        let round: Vec<_> = (0..ROUND).map(|number| places(f64::from(number) / f64::from(ROUND))).collect();
        for (index, (position, center, direction, right)) in round.iter().enumerate() {
            assert!((position.length() - 0.25).abs() < 1e-12 && position == center);
            assert!((direction.angle_between(DVec3::NEG_Z) - TURN).abs() < 1e-4, "{direction}");
            assert!(direction.is_normalized() && right.is_normalized() && direction.dot(*right).abs() < 1e-12);
            assert!(round[..index].iter().all(|other| other.0.distance(*position) > 1e-3 && other.2 != *direction));
        }
        let middle = round.iter().map(|place| place.0).sum::<DVec3>();
        assert!(middle.length() < 1e-9, "as often on one side as on the other");
    }

    #[test]
    fn the_table_is_aligned_and_json_is_a_bare_array() {
        let row = |scene: &str, technique, gpu_ms| Row {
            scene: scene.into(),
            technique,
            width: 64,
            height: 36,
            frames: 3,
            frame_ms: Spread::of(vec![123.4]),
            cpu_ms: Spread::default(),
            gpu_ms,
            fragments_per_pixel: 1.5,
            volume_triangles: 9,
            indices: 27,
        };
        let rows = vec![row("a", Technique::Auto, None), row("a long name", Technique::ExactZPass, Some(Spread::default()))];
        let report = Report { adapter: "the device".into(), rows };
        let text = report.to_string();
        let lines: Vec<_> = text.lines().skip(2).collect();
        assert_eq!(lines.len(), 3, "{text}");
        assert!(
            text.starts_with("the device, 64 x 36 pixels") && lines.iter().all(|line| line.len() == lines[0].len()),
            "{text}"
        );
        let json = serde_json::to_value(&report).unwrap();
        assert_eq!(json[0]["gpu_ms"], serde_json::Value::Null);
        assert_eq!(json[1]["technique"], "exact-z-pass");
    }
}
