//! What `obscura render --json` says of a picture: the plan in numbers, and the time it took.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use crate::cli::render_command;
use crate::frame::plan::{Case, Method, Reason};
use crate::frame::{Camera, Capabilities, FramePlan, Lack};
use crate::gpu::FrameStats;
use crate::scene::{Mirror, Scene};
use crate::settings::{MirrorMode, Settings, Show, Technique};
use crate::techniques::complexity::Tally;

/// One picture, for programs.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// The command that draws it again.
    pub command: String,
    /// Where it was written.
    pub file: String,
    /// The scene's name.
    pub scene: String,
    /// How shadows were counted.
    pub technique: Technique,
    /// What is shown.
    pub show: Show,
    /// The light that is looked at.
    pub light: usize,
    /// Pixels.
    pub size: [u32; 2],
    /// Per pixel.
    pub samples: u32,
    /// Frames whose mean the picture is.
    pub frames: u32,
    /// Points of lights that each frame counts: more than there are lights, where some have a size.
    pub points: usize,
    /// Seconds into the animation.
    pub time: f64,
    /// Where the picture is seen from, world space: for `bounds`, from above.
    pub camera: Option<Camera>,
    /// The device.
    pub adapter: String,
    /// What the device cannot do, and what was done instead.
    pub lacks: Vec<Lack>,
    /// What the importer left out or replaced.
    pub warnings: Vec<String>,
    /// What a user should know about this frame.
    pub notes: Vec<String>,
    /// The frame's steps, in order.
    pub steps: Vec<StepReport>,
    /// Light by light, how the shadow volumes were counted.
    pub volumes: Vec<LightReport>,
    /// Caster by caster and light by light, the same.
    pub casters: Vec<CasterReport>,
    /// Mirrors, and the views drawn for them.
    pub reflections: ReflectionsReport,
    /// Depth complexity in numbers, where that is shown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub complexity: Option<Tally>,
    /// What the GPU was given.
    pub frame: FrameStats,
    /// How long it took.
    pub timings: Timings,
}

/// One step of the frame.
#[derive(Debug, Clone, Serialize)]
pub struct StepReport {
    /// A few words.
    pub label: String,
    /// What it is for.
    pub why: String,
}

/// The volumes of one light.
#[derive(Debug, Clone, Serialize)]
pub struct LightReport {
    /// Its index in the scene; points of a light with a size are counted on after the scene's lights.
    pub light: usize,
    /// Its name, or that of the light it is a point of.
    pub name: String,
    /// What bounds it in depth, where that was marked in the stencil.
    pub depth_bounds: Option<&'static str>,
    /// How many casters were counted how, and why.
    pub counted: Vec<Counted>,
}

/// Casters that were counted alike.
#[derive(Debug, Clone, Serialize)]
pub struct Counted {
    /// How.
    pub method: Method,
    /// Why.
    pub reason: Reason,
    /// The reason as a sentence.
    pub words: &'static str,
    /// How many.
    pub casters: usize,
}

/// One caster before one light, as the panel's table has it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct CasterReport {
    /// The name of its node.
    pub caster: String,
    /// The light's index in the scene. Of a light with a size this is the point that is looked at
    /// (`--light-sample`); its other points are not listed.
    pub light: usize,
    /// M's case, 1 to 3; none where it is not counted.
    pub case: Option<u8>,
    /// How it was counted.
    pub method: Method,
    /// Why.
    pub reason: Reason,
}

/// Mirrors, and the views drawn for them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReflectionsReport {
    /// How reflections are drawn.
    pub mode: MirrorMode,
    /// How often a ray is reflected at most.
    pub bounces: u32,
    /// The mirrors in force, seen or not.
    pub mirrors: Vec<MirrorReport>,
    /// What was to be a mirror and is none: why, a line each.
    pub refused: Vec<String>,
    /// Views drawn, the eye's own among them: the mirrors on the way to each.
    pub views: Vec<String>,
    /// How many there would be if every mirror showed in every other (K section 3).
    pub worst_case: u64,
    /// Views that were left out for being too small.
    pub too_small: usize,
}

/// One mirror.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MirrorReport {
    /// The name of its node.
    pub name: String,
    /// The scene's node, as `--mirror` has it.
    pub node: usize,
    /// Of its mesh.
    pub primitive: usize,
    /// How much of what is seen there is the reflection: 0 to 1.
    pub reflectivity: f32,
    /// Multiplies the reflection; linear RGB.
    pub tint: [f32; 3],
}

impl ReflectionsReport {
    fn new(settings: &Settings, scene: &Scene, plan: &FramePlan) -> Self {
        let (mirrors, refused) = scene.mirrors_in_force(&settings.mirrors);
        let mirrors = mirrors.into_iter().map(|Mirror { name, node, primitive, look, .. }| MirrorReport {
            name,
            node,
            primitive,
            reflectivity: look.reflectivity,
            tint: look.tint.to_array(),
        });
        Self {
            mode: settings.mirrors.mode,
            bounces: settings.mirrors.most_bounces(),
            mirrors: mirrors.collect(),
            refused,
            views: plan.views.iter().map(|view| view.name.clone()).collect(),
            worst_case: plan.reflections.worst_case.max(1),
            too_small: plan.reflections.too_small,
        }
    }
}

/// Milliseconds of wall clock. The first frame compiles its pipelines; the second is what a
/// frame costs.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub struct Timings {
    /// Importing the scene.
    pub open_ms: f64,
    /// Finding the device, compiling shaders, uploading the scene.
    pub upload_ms: f64,
    /// The frames before the last one, where the picture is the mean of several.
    pub gather_ms: f64,
    /// Posing and planning.
    pub plan_ms: f64,
    /// The first frame, with its read-back.
    pub first_frame_ms: f64,
    /// The second frame, with its read-back.
    pub second_frame_ms: f64,
}

impl Report {
    /// Everything but the figures that only drawing can tell.
    #[must_use]
    pub fn new(
        file: &Path,
        settings: &Settings,
        scene: &Scene,
        plan: &FramePlan,
        capabilities: &Capabilities,
        frame: FrameStats,
        timings: Timings,
    ) -> Self {
        Self {
            command: render_command(settings),
            file: file.to_string_lossy().into_owned(),
            scene: scene.name.clone(),
            technique: settings.technique,
            show: settings.show,
            light: settings.light,
            size: plan.size,
            samples: plan.samples,
            frames: plan.gather.map_or(1, |gather| gather.frames),
            points: plan.points.len(),
            time: settings.time,
            camera: plan.views.first().map(|view| view.camera),
            adapter: capabilities.adapter.clone(),
            lacks: capabilities.lacks(),
            warnings: scene.warnings.clone(),
            notes: plan.notes.clone(),
            steps: plan.steps.iter().map(|step| StepReport { label: step.label.clone(), why: step.why.clone() }).collect(),
            volumes: volumes(scene, plan),
            casters: casters(scene, plan),
            reflections: ReflectionsReport::new(settings, scene, plan),
            complexity: None,
            frame,
            timings,
        }
    }
}

/// The volumes of the eye's own view, gathered by light, method and reason.
fn volumes(scene: &Scene, plan: &FramePlan) -> Vec<LightReport> {
    let mut lights: BTreeMap<usize, BTreeMap<(Method, Reason), usize>> = BTreeMap::new();
    for volume in plan.casters().filter_map(<[_]>::first).filter(|volume| volume.view == 0) {
        *lights.entry(volume.light).or_default().entry((volume.method, volume.reason)).or_default() += 1;
    }
    lights
        .into_iter()
        .map(|(light, counts)| LightReport {
            light,
            name: plan.points.get(light).and_then(|&of| scene.lights.get(of)).map(|light| light.name.clone()).unwrap_or_default(),
            depth_bounds: plan.depth_bounds(light).map(|solid| solid.name()),
            counted: counts
                .into_iter()
                .map(|((method, reason), casters)| Counted { method, reason, words: reason.words(), casters })
                .collect(),
        })
        .collect()
}

/// Every planned caster of every light of the scene, as the eye's own view counts it.
#[must_use]
pub fn casters(scene: &Scene, plan: &FramePlan) -> Vec<CasterReport> {
    let names: Vec<_> = scene.instances().map(|(_, node, _)| node.name.as_str()).collect();
    let volumes = plan.casters().filter_map(<[_]>::first);
    volumes
        .filter(|volume| volume.view == 0 && volume.light < scene.lights.len())
        .map(|volume| CasterReport {
            caster: names.get(volume.instance).copied().unwrap_or_default().into(),
            light: volume.light,
            case: volume.case.map(Case::number),
            method: volume.method,
            reason: volume.reason,
        })
        .collect()
}
