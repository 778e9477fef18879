//! `obscura verify`: what the techniques draw, held against exact rays ([`crate::truth`]).
//!
//! Each technique draws `show shadow` of each light; every decided pixel must be what the rays say. A
//! technique that claims to be exact fails with its first wrong pixel; of the others the number is the
//! price that is paid for them.

use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::time::Instant;

use image::RgbaImage;
use serde::Serialize;

use super::wander::{Place, strays};
use super::{HeadlessError, check_target, progress_bar, save_png};
use crate::cli::{VerifyRequest, render_command};
use crate::director::{self, StageError};
use crate::frame::{Camera, Capabilities, FramePlan};
use crate::gpu::{Context, Renderer, readback};
use crate::scene::{AnimationChoice, Pose, PosedLight, Scene};
use crate::settings::{Settings, Show, Technique};
use crate::techniques;
use crate::truth::{Comparison, Verdicts, World, WrongPixel, paint};

/// What was found.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// The scene's name.
    pub scene: String,
    /// Of each picture, pixels.
    pub size: [u32; 2],
    /// How many views were looked at.
    pub views: usize,
    /// What random views were made from.
    pub seed: Option<u64>,
    /// Where the eyes of random views were.
    pub eyes: BTreeMap<Place, usize>,
    /// How many of the views have their eye in a shadow of their light.
    pub eyes_in_shadow: usize,
    /// Why no technique claims to be exact, where none does.
    pub spoiled_by: Option<&'static str>,
    /// The device.
    pub adapter: String,
    /// Technique by technique and light by light, all views together.
    pub lights: Vec<LightRow>,
    /// The first views with wrong pixels, exact techniques' before others'.
    pub wrong_views: Vec<WrongView>,
    /// Milliseconds spent on drawing.
    pub draw_ms: f64,
    /// Milliseconds spent on rays.
    pub trace_ms: f64,
}

/// One technique and one light.
#[derive(Debug, Clone, Serialize)]
pub struct LightRow {
    /// The technique.
    pub technique: Technique,
    /// Whether it claims to be exact, with these settings.
    pub exact: bool,
    /// The light's index.
    pub light: usize,
    /// Its name.
    pub name: String,
    /// Views that looked at it.
    pub views: usize,
    /// Pixels that rays agree on.
    pub decided: usize,
    /// Of those, lit.
    pub lit: usize,
    /// Of those, in shadow.
    pub shadow: usize,
    /// Pixels that rays do not agree on.
    pub edges: usize,
    /// Decided pixels that are drawn otherwise.
    pub wrong: usize,
}

/// A view with wrong pixels.
#[derive(Debug, Clone, Serialize)]
pub struct WrongView {
    /// The technique.
    pub technique: Technique,
    /// Whether it claims to be exact.
    pub exact: bool,
    /// The light.
    pub light: usize,
    /// How many.
    pub wrong: usize,
    /// The first of them.
    pub first: WrongPixel,
    /// What draws them.
    pub command: String,
}

/// For so many views with wrong pixels, of exact techniques and of others, the command is kept.
const WRONG_VIEWS_KEPT: usize = 8;

impl Report {
    /// Wrong pixels of techniques that claim to have none.
    #[must_use]
    pub fn broken_promises(&self) -> usize {
        self.lights.iter().filter(|row| row.exact).map(|row| row.wrong).sum()
    }
}

/// One view, drawn and judged.
pub struct Verified {
    /// What rays say for each of them.
    pub verdicts: Vec<Verdicts>,
    /// Technique by technique, and light by light, what came of it.
    pub found: Vec<(Technique, usize, Comparison)>,
    /// Whether the eye is in the shadow of any of them.
    pub eye_in_shadow: bool,
    /// Milliseconds.
    pub draw_ms: f64,
    /// Milliseconds.
    pub trace_ms: f64,
}

impl Verified {
    /// 2 where a technique that claims to be exact is wrong, 1 where another is.
    fn worst(&self) -> u8 {
        let wrong = self.found.iter().filter(|(.., found)| found.wrong() > 0);
        wrong.map(|(technique, ..)| 1 + u8::from(techniques::row(*technique).exact)).max().unwrap_or(0)
    }
}

/// `show shadow` of some lights by some techniques, drawn and to be judged.
pub struct Shots {
    /// The scene as it was drawn.
    pub pose: Pose,
    /// Where it was drawn from.
    pub camera: Camera,
    /// The lights as they were drawn: of those with a size the point that was looked at.
    lights: Vec<PosedLight>,
    /// Technique by technique, and light by light.
    pictures: Vec<(Technique, usize, RgbaImage)>,
}

/// Shots, judged.
pub struct Judged {
    /// What rays say for each light.
    pub verdicts: Vec<Verdicts>,
    /// Technique by technique, and light by light, what came of it.
    pub found: Vec<(Technique, usize, Comparison)>,
    /// Whether the eye is in the shadow of any of the lights.
    pub eye_in_shadow: bool,
}

impl Shots {
    /// Draws `show shadow` of each of `lights` by each of `techniques`, everything else as `settings`
    /// say. `draw` makes the picture of a plan. None where there is nothing to draw.
    ///
    /// # Errors
    /// Settings that cannot be drawn, or what `draw` says.
    pub fn draw<E: From<StageError>>(
        settings: &Settings,
        scene: &Scene,
        capabilities: &Capabilities,
        (techniques, lights): (&[Technique], &[usize]),
        mut draw: impl FnMut(&FramePlan, &Pose) -> Result<RgbaImage, E>,
    ) -> Result<Option<Self>, E> {
        let mut shots: Option<Self> = None;
        for &technique in techniques {
            for &light in lights {
                let settings = Settings { technique, show: Show::Shadow, light, ..settings.clone() };
                let (pose, plan) = director::stage(&settings, scene, capabilities)?;
                let picture = draw(&plan, &pose)?;
                let posed = pose.lights[light];
                let camera = plan.views[0].camera;
                let shots = shots.get_or_insert_with(|| Self { pose, camera, lights: Vec::new(), pictures: Vec::new() });
                if shots.pictures.len() < lights.len() {
                    shots.lights.push(posed);
                }
                shots.pictures.push((technique, light, picture));
            }
        }
        Ok(shots)
    }

    /// Holds the pictures, of `size` pixels, against rays through `world`, which is the pose's.
    /// `goes_on` as in [`World::judge_lights`].
    #[must_use]
    pub fn judge(&self, world: &World, size: [u32; 2], goes_on: &(dyn Fn(f64) -> bool + Sync)) -> Option<Judged> {
        let verdicts = world.judge_lights(&self.camera, &self.lights, size, goes_on)?;
        let found = self
            .pictures
            .iter()
            .zip(verdicts.iter().cycle())
            .map(|((technique, light, picture), verdicts)| (*technique, *light, verdicts.compare(picture)))
            .collect();
        let eye_in_shadow = self.lights.iter().any(|light| world.shades(self.camera.eye, light));
        Some(Judged { verdicts, found, eye_in_shadow })
    }
}

/// A world and the moment it belongs to: views of one moment share it.
#[derive(Default)]
pub struct Kept(Option<(f64, AnimationChoice, World)>);

/// Draws `show shadow` of the scene (which the renderer holds) for each of `lights` by each of
/// `techniques`, everything else as `settings` say, and holds the pictures against exact rays.
///
/// # Errors
/// Settings that cannot be drawn, or a device that cannot.
pub fn verify_view(
    (context, renderer): (&Context, &mut Renderer),
    scene: &Scene,
    settings: &Settings,
    techniques: &[Technique],
    lights: &[usize],
    kept: &mut Kept,
) -> Result<Verified, HeadlessError> {
    let mut begun = Instant::now();
    let shots = Shots::draw(settings, scene, context.capabilities(), (techniques, lights), |plan, pose| {
        readback::picture(context, renderer, plan, scene, pose).map(|(_, picture)| picture).map_err(HeadlessError::from)
    })?;
    let draw_ms = lap(&mut begun);
    let judged = shots.and_then(|shots| {
        let animation = settings.animation.unwrap_or(scene.default_animation);
        let same = |kept: &(f64, AnimationChoice, World)| kept.0 == settings.time && kept.1 == animation;
        let held = kept.0.take().filter(same);
        let held = held.unwrap_or_else(|| (settings.time, animation, World::new(scene, &shots.pose)));
        let (.., world) = kept.0.insert(held);
        shots.judge(world, settings.size, &|_| true)
    });
    let Judged { verdicts, found, eye_in_shadow } =
        judged.unwrap_or_else(|| Judged { verdicts: Vec::new(), found: Vec::new(), eye_in_shadow: false });
    Ok(Verified { verdicts, found, eye_in_shadow, draw_ms, trace_ms: lap(&mut begun) })
}

/// Does what is asked; the picture of wrong pixels is written whatever they are.
///
/// # Errors
/// Whatever stands in the way. Wrong pixels are no error here: [`Report::broken_promises`] counts them.
pub fn verify(request: &VerifyRequest) -> Result<Report, HeadlessError> {
    crate::cli::check(&request.settings)?;
    if let Some(diff) = &request.diff {
        check_target(diff)?;
    }
    let scene = super::render::open(&request.settings)?;
    if scene.lights.is_empty() {
        return Err(HeadlessError::NoLights(scene.name));
    }
    let views: Vec<(Settings, Option<Place>)> = match request.random {
        None => vec![(request.settings.clone(), None)],
        Some((count, seed)) => strays(&scene, &request.settings, request.light, count, seed)
            .into_iter()
            .map(|stray| (stray.settings, Some(stray.place)))
            .collect(),
    };
    let context = Context::headless(request.settings.adapter.as_deref())?;
    let mut renderer = Renderer::new(&context, request.settings.shaders.as_deref())?;
    renderer.set_scene(&context, &scene)?;

    let mut report = Report {
        scene: scene.name.clone(),
        size: request.settings.size,
        views: views.len(),
        seed: request.random.map(|(_, seed)| seed),
        eyes: BTreeMap::new(),
        eyes_in_shadow: 0,
        spoiled_by: techniques::spoiled_by(&request.settings),
        adapter: context.capabilities().adapter.clone(),
        lights: Vec::new(),
        wrong_views: Vec::new(),
        draw_ms: 0.0,
        trace_ms: 0.0,
    };
    let mut rows: BTreeMap<(usize, usize), LightRow> = BTreeMap::new();
    let mut kept = Kept::default();
    let mut shown: Option<(u8, Settings, Verified)> = None;
    let progress = progress_bar(views.len() as u64);
    for (settings, place) in &views {
        let lights: Vec<_> = match (place, request.light) {
            (Some(_), _) => vec![settings.light],
            (None, Some(light)) => vec![light],
            (None, None) => (0..scene.lights.len()).collect(),
        };
        let view = verify_view((&context, &mut renderer), &scene, settings, &request.techniques, &lights, &mut kept)?;
        report.add(&view, &scene, settings, &mut rows);
        if let Some(place) = place {
            *report.eyes.entry(*place).or_default() += 1;
        }
        // The picture shows the first view in which an exact technique is wrong, else the first with
        // anything wrong, else the first.
        let rank = view.worst();
        if request.diff.is_some() && shown.as_ref().is_none_or(|(shown, ..)| rank > *shown) {
            shown = Some((rank, settings.clone(), view));
        }
        progress.set_message(format!("{} wrong", rows.values().map(|row| row.wrong).sum::<usize>()));
        progress.inc(1);
    }
    progress.finish_and_clear();
    report.lights = rows.into_values().collect();
    report.wrong_views.sort_by_key(|view| !view.exact);
    report.wrong_views.truncate(WRONG_VIEWS_KEPT);
    if let (Some(path), Some((_, settings, view))) = (&request.diff, shown) {
        let settings = Settings { show: Show::Final, samples: 1, ..settings };
        let (pose, plan) = director::stage(&settings, &scene, context.capabilities())?;
        let (_, mut picture) = readback::picture(&context, &mut renderer, &plan, &scene, &pose)?;
        paint_over(&view, &mut picture);
        save_png(path, &picture, &render_command(&settings))?;
    }
    Ok(report)
}

/// Paints every wrong pixel of a view over its picture.
fn paint_over(view: &Verified, picture: &mut RgbaImage) {
    let wrong: Vec<_> = view.found.iter().flat_map(|(.., found)| found.pixels.iter().copied()).collect();
    paint(picture, &view.verdicts, &wrong);
}

impl Report {
    fn add(&mut self, view: &Verified, scene: &Scene, settings: &Settings, rows: &mut BTreeMap<(usize, usize), LightRow>) {
        self.draw_ms += view.draw_ms;
        self.trace_ms += view.trace_ms;
        self.eyes_in_shadow += usize::from(view.eye_in_shadow);
        for (technique, light, found) in &view.found {
            let exact = techniques::row(*technique).exact && self.spoiled_by.is_none();
            let order = Technique::ALL.iter().position(|one| one == technique).unwrap_or(usize::MAX);
            let row = rows.entry((order, *light)).or_insert_with(|| LightRow {
                technique: *technique,
                exact,
                light: *light,
                name: scene.lights[*light].name.clone(),
                views: 0,
                decided: 0,
                lit: 0,
                shadow: 0,
                edges: 0,
                wrong: 0,
            });
            row.views += 1;
            row.decided += found.decided;
            row.lit += found.lit;
            row.shadow += found.shadow;
            row.edges += found.edges;
            row.wrong += found.wrong();
            let kept = self.wrong_views.iter().filter(|view| view.exact == exact).count();
            if let Some(&first) = found.pixels.first()
                && kept < WRONG_VIEWS_KEPT
            {
                let settings = Settings { technique: *technique, show: Show::Shadow, light: *light, ..settings.clone() };
                let command = render_command(&settings);
                self.wrong_views.push(WrongView {
                    technique: *technique,
                    exact,
                    light: *light,
                    wrong: found.wrong(),
                    first,
                    command,
                });
            }
        }
    }
}

impl Display for Report {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        match self.seed {
            None => writeln!(out, "{}, {width}x{height}", self.scene)?,
            Some(seed) => writeln!(out, "{}, {} random views of {width}x{height}, seed {seed}", self.scene, self.views)?,
        }
        writeln!(
            out,
            "{:<16} {:<26} {:>11} {:>11} {:>11} {:>9} {:>9}",
            "technique", "light", "lit", "shadow", "decided", "edges", "wrong"
        )?;
        for row in &self.lights {
            let name: String = format!("{} {}", row.light, row.name).chars().take(26).collect();
            let verdict = match (row.exact, row.wrong) {
                (true, 1..) => "  claims to be exact",
                (false, 1..) => "  known to fail",
                (_, 0) => "",
            };
            writeln!(
                out,
                "{:<16} {name:<26} {:>11} {:>11} {:>11} {:>9} {:>9}{verdict}",
                row.technique.name(),
                row.lit,
                row.shadow,
                row.decided,
                row.edges,
                row.wrong
            )?;
        }
        if let Some(what) = self.spoiled_by {
            writeln!(out, "no technique claims to be exact here: {what} spoils counting")?;
        }
        if !self.eyes.is_empty() {
            let count = |place| self.eyes.get(&place).copied().unwrap_or(0);
            writeln!(
                out,
                "eyes: {} anywhere, {} in or at casters' boxes, {} behind casters, {} with casters across the near plane; {} in shadow",
                count(Place::Anywhere),
                count(Place::AtCaster),
                count(Place::BehindCaster),
                count(Place::AcrossNearPlane),
                self.eyes_in_shadow
            )?;
        }
        for view in &self.wrong_views {
            let WrongPixel { x, y, .. } = view.first;
            writeln!(out, "{} wrong by {}, the first at {x},{y}: {}", view.wrong, view.technique.name(), view.command)?;
        }
        writeln!(out, "drawn in {:.1} s, traced in {:.1} s", self.draw_ms / 1e3, self.trace_ms / 1e3)
    }
}

fn lap(clock: &mut Instant) -> f64 {
    let milliseconds = clock.elapsed().as_secs_f64() * 1e3;
    *clock = Instant::now();
    milliseconds
}
