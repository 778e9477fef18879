//! `obscura verify`: what the techniques draw, held against exact rays ([`crate::truth`]).
//!
//! Each technique draws `show shadow` of each light; every decided pixel must be what the rays say. A
//! technique that claims to be exact fails with its first wrong pixel; of the others the number is the
//! price that is paid for them. Once for all of them `show surfaces` is drawn, and every decided pixel must
//! show the instance that rays meet, through the very mirrors that they meet on their way.
//!
//! What is drawn has every view in a mirror, however small: rays know no least size.

use std::collections::{BTreeMap, HashMap};
use std::time::Instant;

use image::RgbaImage;

use super::report;
pub use super::report::{LightRow, Report, SurfaceRow, WrongSurfaceView, WrongView};
use super::wander::{Place, strays};
use super::{HeadlessError, check_target, progress_bar, save_png};
use crate::cli::{VerifyRequest, render_command};
use crate::director::{self, StageError};
use crate::frame::{Camera, Capabilities, FramePlan, identity_color};
use crate::gpu::{Context, Renderer, readback};
use crate::scene::{AnimationChoice, Mirror, Pose, PosedLight, Scene};
use crate::settings::{MirrorLight, Mirrors, Planar, Settings, Show, Technique};
use crate::techniques::{self, planar};
use crate::truth::{Comparison, SurfaceComparison, Surfaces, Traced, Verdicts, World, Wrong, WrongPixel, paint};

/// One view, drawn and judged.
#[derive(Default)]
pub struct Verified {
    /// What came of it.
    pub judged: Judged,
    /// Milliseconds.
    pub draw_ms: f64,
    /// Milliseconds.
    pub trace_ms: f64,
}

/// `show shadow` of some lights by some techniques, and `show surfaces`: drawn and to be judged.
pub struct Shots {
    /// The scene as it was drawn.
    pub pose: Pose,
    /// Where it was drawn from.
    pub camera: Camera,
    /// The lights as they were drawn: of those with a size the point that was looked at.
    lights: Vec<PosedLight>,
    /// Technique by technique, and light by light.
    pictures: Vec<(Technique, usize, RgbaImage)>,
    /// Which surface each pixel shows.
    surfaces: RgbaImage,
    /// By what the pixels' colours mean.
    key: Key,
    mirrors: Vec<Mirror>,
    bounces: u32,
    /// The only surfaces with a verdict, where shadows are planar: elsewhere nothing is claimed.
    receivers: Option<Vec<(usize, usize)>>,
}

/// What the colours of `show surfaces` mean.
struct Key {
    /// The plan's views by the mirrors on their way.
    views: HashMap<Vec<usize>, usize>,
    instances: usize,
}

impl Key {
    /// The colour of an instance in the view that a path leads to; none where the plan has no such view.
    fn color(&self, path: &[usize], instance: Option<usize>) -> Option<[u8; 3]> {
        let Some(instance) = instance else { return Some(identity_color(0)) };
        let number = self.views.get(path)? * self.instances + instance + 1;
        u32::try_from(number).ok().map(identity_color)
    }

    /// The path and the instance of a colour, where it has any: a search, for few.
    fn meaning(&self, color: [u8; 3]) -> Option<(&[usize], Option<usize>)> {
        let all = || [None].into_iter().chain((0..self.instances).map(Some));
        let mut pairs = self.views.keys().flat_map(|path| all().map(move |instance| (path.as_slice(), instance)));
        pairs.find(|(path, instance)| self.color(path, *instance) == Some(color))
    }
}

/// Shots, judged.
#[derive(Default)]
pub struct Judged {
    /// What rays say for each light.
    pub verdicts: Vec<Verdicts>,
    /// Technique by technique, and light by light, what came of it.
    pub found: Vec<(Technique, usize, Comparison)>,
    /// What is seen, by rays.
    pub seen: Surfaces,
    /// What came of `show surfaces`.
    pub surfaces: SurfaceComparison,
    /// In words, what the first pixel with a wrong surface should show, and what it shows.
    pub first_wrong: Option<[String; 2]>,
    /// Whether the eye is in the shadow of any of the lights.
    pub eye_in_shadow: bool,
}

impl Judged {
    /// 2 where what claims to be exact is wrong, or a surface, 1 where another is.
    fn worst(&self, settings: &Settings) -> u8 {
        let wrong = self.found.iter().filter(|(.., found)| found.wrong() > 0);
        let lights = wrong
            .map(|(technique, ..)| {
                1 + u8::from(techniques::claims_exact(&Settings { technique: *technique, ..settings.clone() }))
            })
            .max()
            .unwrap_or(0);
        if self.surfaces.pixels.is_empty() { lights } else { 2 }
    }

    /// Every wrong pixel, of whatever kind.
    #[must_use]
    pub fn wrong(&self) -> Vec<WrongPixel> {
        let lights = self.found.iter().flat_map(|(.., found)| found.pixels.iter().copied());
        lights.chain(self.surfaces.pixels.iter().map(|at| WrongPixel { x: at.x, y: at.y, how: Wrong::Surface })).collect()
    }
}

impl Shots {
    /// Draws `show shadow` of each of `lights` by each of `techniques`, and `show surfaces`, everything else as
    /// `settings` say. `draw` makes the picture of a plan. None where there is nothing to draw.
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
        let counting = |technique: &Technique| planar::technique(&Settings { technique: *technique, ..settings.clone() });
        let techniques: &[Technique] = &techniques.iter().map(counting).collect::<Vec<_>>();
        let by = techniques.iter().find(|technique| reflects(**technique)).or(techniques.first());
        let Some(&technique) = by.filter(|_| !lights.is_empty()) else { return Ok(None) };
        let settings = whole(settings);
        let surfaces = Settings { technique, show: Show::Surfaces, ..settings.clone() };
        let (pose, plan) = director::stage(&surfaces, scene, capabilities)?;
        let mut shots = Self {
            camera: plan.views[0].camera,
            lights: Vec::new(),
            pictures: Vec::new(),
            surfaces: draw(&plan, &pose)?,
            key: Key {
                views: plan.views.iter().enumerate().map(|(number, view)| (view.path().to_vec(), number)).collect(),
                instances: scene.instances().count(),
            },
            mirrors: scene.mirrors_in_force(&settings.mirrors).0,
            bounces: if reflects(technique) { settings.mirrors.most_bounces() } else { 0 },
            receivers: planar::is_on(&settings).then(|| {
                let receivers = scene.receivers_in_force(&settings.planar).0.into_iter();
                receivers.map(|receiver| (receiver.instance, receiver.primitive)).collect()
            }),
            pose,
        };
        for &technique in techniques {
            for &light in lights {
                let settings = Settings { technique, show: Show::Shadow, light, ..settings.clone() };
                let (pose, plan) = director::stage(&settings, scene, capabilities)?;
                shots.pictures.push((technique, light, draw(&plan, &pose)?));
                if shots.lights.len() < lights.len() {
                    shots.lights.push(pose.lights[light]);
                }
            }
        }
        Ok(Some(shots))
    }

    /// What rays are cast through.
    #[must_use]
    pub fn world(&self, scene: &Scene) -> World {
        let world = World::with_mirrors(scene, &self.pose, &self.mirrors);
        match &self.receivers {
            Some(receivers) => world.of_receivers(receivers.iter().copied()),
            None => world,
        }
    }

    /// Holds the pictures, of `size` pixels, against rays through `world`, which is [`Self::world`] or that of
    /// other shots of the same moment. `goes_on` as in [`World::judge_lights`].
    #[must_use]
    pub fn judge(&self, scene: &Scene, world: &World, size: [u32; 2], goes_on: &(dyn Fn(f64) -> bool + Sync)) -> Option<Judged> {
        let trace = |bounces| world.trace(&self.camera, &self.lights, size, bounces, goes_on);
        let Traced { verdicts, surfaces: seen } = trace(self.bounces)?;
        let draws_no_view = |picture: &(Technique, usize, RgbaImage)| self.bounces > 0 && !reflects(picture.0);
        let plain = if self.pictures.iter().any(draws_no_view) { trace(0)?.verdicts } else { Vec::new() };
        let compare = |(number, shot): (usize, &(Technique, usize, RgbaImage))| {
            let verdicts = if draws_no_view(shot) { &plain } else { &verdicts };
            (shot.0, shot.1, verdicts[number % verdicts.len()].compare(&shot.2))
        };
        let found = self.pictures.iter().enumerate().map(compare).collect();
        let surfaces = seen.compare(&self.surfaces, |path, instance| self.key.color(path, instance));
        let first_wrong = surfaces.pixels.first().map(|wrong| {
            let drawn = wrong.drawn.and_then(|color| self.key.meaning(color));
            let drawn = drawn.map_or("what no view has".into(), |(path, instance)| self.words(scene, path, instance));
            [self.words(scene, &seen.paths()[wrong.path], wrong.instance), drawn]
        });
        let eye_in_shadow =
            self.lights.iter().filter(|light| light.off.is_none()).any(|light| world.shades(self.camera.eye, light));
        Some(Judged { verdicts, found, seen, surfaces, first_wrong, eye_in_shadow })
    }

    /// An instance as it is seen through mirrors: `chair in left mirror in right mirror`, the last mirror of the
    /// way first.
    fn words(&self, scene: &Scene, path: &[usize], instance: Option<usize>) -> String {
        let name = |instance| scene.instances().nth(instance).map_or("", |(_, node, _)| node.name.as_str());
        let mirrors = path.iter().rev().map(|mirror| format!(" in {}", self.mirrors[*mirror].name));
        instance.map_or("nothing", name).to_owned() + &mirrors.collect::<String>()
    }
}

/// Whether a technique draws what is seen in mirrors: where shadows are quads over the picture, mirrors are surfaces.
fn reflects(technique: Technique) -> bool {
    techniques::row(technique).darkens.is_none()
}

/// The same settings, with every view in a mirror that shows at all.
pub(super) fn whole(settings: &Settings) -> Settings {
    let mirrors = Mirrors { least_pixels: 0, ..settings.mirrors.clone() };
    Settings { mirrors, ..settings.clone() }
}

/// A world, and the moment and the mirrors it belongs to: views of one moment share it.
#[derive(Default)]
pub struct Kept(Option<(f64, AnimationChoice, Mirrors, Planar, World)>);

impl Kept {
    /// The world of some shots: the one that is kept, where it is theirs, or a new one, which is kept then.
    fn world(&mut self, scene: &Scene, settings: &Settings, shots: &Shots) -> &World {
        let animation = settings.animation.unwrap_or(scene.default_animation);
        let (time, mirrors, planar) = (settings.time, &settings.mirrors, &settings.planar);
        let held = self.0.take().filter(|kept| (kept.0, kept.1, &kept.2, &kept.3) == (time, animation, mirrors, planar));
        let held = held.unwrap_or_else(|| (time, animation, mirrors.clone(), planar.clone(), shots.world(scene)));
        &self.0.insert(held).4
    }
}

/// Draws `show shadow` of the scene (which the renderer holds) for each of `lights` by each of
/// `techniques`, and `show surfaces`, everything else as `settings` say, and holds the pictures against exact rays.
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
    let judged = shots.and_then(|shots| shots.judge(scene, kept.world(scene, settings, &shots), settings.size, &|_| true));
    Ok(Verified { judged: judged.unwrap_or_default(), draw_ms, trace_ms: lap(&mut begun) })
}

/// Does what is asked; the picture of wrong pixels is written whatever they are.
///
/// # Errors
/// Whatever stands in the way. Wrong pixels are no error here: [`Report::broken_promises`] counts them.
pub fn verify(request: &VerifyRequest) -> Result<Report, HeadlessError> {
    crate::cli::check(&request.settings)?;
    let mut request = request.clone();
    if planar::is_on(&request.settings) {
        // Planar shadows take the place of all techniques, and no light comes off mirrors.
        request.techniques.truncate(1);
        request.settings.mirrors.light = MirrorLight::Off;
    }
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
        surfaces: SurfaceRow { exact: techniques::spoiled_by(&request.settings).is_none(), ..SurfaceRow::default() },
        wrong_views: Vec::new(),
        wrong_surfaces: Vec::new(),
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
            (None, None) => (0..scene.lights_in_force(&settings.mirrors)).collect(),
        };
        let view = verify_view((&context, &mut renderer), &scene, settings, &request.techniques, &lights, &mut kept)?;
        report.add(&view, &scene, settings, &mut rows);
        if let Some(place) = place {
            *report.eyes.entry(*place).or_default() += 1;
        }
        // The picture shows the first view in which an exact technique or a surface is wrong, else the first
        // with anything wrong, else the first.
        let rank = view.judged.worst(settings);
        if request.diff.is_some() && shown.as_ref().is_none_or(|(shown, ..)| rank > *shown) {
            shown = Some((rank, settings.clone(), view));
        }
        let wrong = report.surfaces.wrong + rows.values().map(|row| row.wrong).sum::<usize>();
        progress.set_message(format!("{wrong} wrong"));
        progress.inc(1);
    }
    progress.finish_and_clear();
    report.lights = rows.into_values().collect();
    report.wrong_views.sort_by_key(|view| !view.exact);
    report.wrong_views.truncate(report::WRONG_VIEWS_KEPT);
    if let (Some(path), Some((_, settings, view))) = (&request.diff, shown) {
        let settings = Settings { show: Show::Final, samples: 1, ..settings };
        let (pose, plan) = director::stage(&settings, &scene, context.capabilities())?;
        let (_, mut picture) = readback::picture(&context, &mut renderer, &plan, &scene, &pose)?;
        paint(&mut picture, &view.judged.verdicts, &view.judged.wrong());
        save_png(path, &picture, &render_command(&settings))?;
    }
    Ok(report)
}

fn lap(clock: &mut Instant) -> f64 {
    let milliseconds = clock.elapsed().as_secs_f64() * 1e3;
    *clock = Instant::now();
    milliseconds
}
