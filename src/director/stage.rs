//! What comes before a plan (pose, camera) and after it (validation), for the window and the headless commands alike.
//!
//! Who draws one frame after the other gives each back to the [`Planner`] when it is drawn: the next one is planned in its
//! memory, and nothing is allocated that grows with the scene.

use glam::DVec2;
use thiserror::Error;

use super::{dissolve, plan, silhouettes};
use crate::failures;
use crate::frame::validate::{Fault, validate};
use crate::frame::{Camera, CameraError, Capabilities, FramePlan, Gather};
use crate::scene::area::sequence;
use crate::scene::pose::Poser;
use crate::scene::{Pose, Sampling, Scene};
use crate::settings::{MAX_FRAMES, MirrorLight, SceneChoice, Settings, Show};
use crate::techniques::planar as planar_shadows;
use crate::techniques::workspace::Workspace;

/// Why a frame cannot be planned: one line each.
#[derive(Debug, Error)]
pub enum StageError {
    /// The settings ask for a camera that is not there.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The settings ask for a light that is not there.
    #[error("no light {0} in this scene: it has {1}")]
    Light(usize, usize),
    /// A size that no picture has.
    #[error("a picture of {0} x {1} pixels is not possible here: each side must be 1 to {2}")]
    Size(u32, u32, u32),
    /// Not 1 or 4.
    #[error("{0} samples a pixel are not possible: 1 or 4")]
    Samples(u32),
    /// The time is NaN, infinite or negative.
    #[error("the time must be a number of seconds from 0 on, not {0}")]
    Time(f64),
    /// Lights with a size, each counted as many points.
    #[error("{0} points of lights are too many: {MOST_POINTS} at most; fewer points a light (--area-samples) are fewer")]
    Points(usize),
    /// A fault in the plan: a bug in this program, caught before the GPU sees it.
    #[error("the frame plan is faulty: {0}")]
    Plan(#[from] Fault),
}

/// Points of lights in one frame: each is counted by itself.
const MOST_POINTS: usize = 2048;

/// The scene at the settings' time, and the validated plan of its frame.
///
/// # Errors
/// Settings that ask for what is not there.
pub fn stage(settings: &Settings, scene: &Scene, capabilities: &Capabilities) -> Result<(Pose, FramePlan), StageError> {
    stage_frame(settings, scene, capabilities, 0)
}

/// How many frames make one picture: those whose mean it is, or one.
#[must_use]
pub fn frames(settings: &Settings) -> u32 {
    // Exact values and false colours have no mean.
    let one_frame = !matches!(settings.show, Show::Final | Show::Volumes | Show::Wireframe);
    if one_frame || dissolve::wanted(settings) { 1 } else { settings.lighting.accumulate.clamp(1, MAX_FRAMES) }
}

/// [`stage`] for one of the [`frames`], from 0: each has other points of the lights with a size, and all
/// but the first look past the middle of their pixels by less than half of one. Drawn in order, each leaves
/// the mean of all so far.
///
/// # Errors
/// Settings that ask for what is not there.
pub fn stage_frame(
    settings: &Settings,
    scene: &Scene,
    capabilities: &Capabilities,
    frame: u32,
) -> Result<(Pose, FramePlan), StageError> {
    stage_changed(settings, scene, capabilities, frame, |_| ())
}

/// [`stage_frame`] of a moment that `change` has made another one: it is given the scene's pose before light comes
/// off mirrors, and before lights with a size become points.
///
/// # Errors
/// Settings that ask for what is not there.
pub fn stage_changed(
    settings: &Settings,
    scene: &Scene,
    capabilities: &Capabilities,
    frame: u32,
    change: impl FnOnce(&mut Pose),
) -> Result<(Pose, FramePlan), StageError> {
    Planner::default().stage_changed(settings, scene, capabilities, frame, change)
}

/// Plans one frame after the other in the same memory.
#[derive(Debug, Default)]
pub struct Planner {
    workspace: Workspace,
    poser: Poser,
    /// A frame that nobody needs any more.
    before: Option<(Pose, FramePlan)>,
}

impl Planner {
    /// A frame that nobody needs any more: the next one may stand in its memory.
    pub fn take_back(&mut self, frame: (Pose, FramePlan)) {
        self.before = Some(frame);
    }

    /// [`stage_frame`].
    ///
    /// # Errors
    /// Settings that ask for what is not there.
    pub fn stage_frame(
        &mut self,
        settings: &Settings,
        scene: &Scene,
        capabilities: &Capabilities,
        frame: u32,
    ) -> Result<(Pose, FramePlan), StageError> {
        self.stage_changed(settings, scene, capabilities, frame, |_| ())
    }

    /// [`stage_changed`].
    ///
    /// # Errors
    /// Settings that ask for what is not there.
    pub fn stage_changed(
        &mut self,
        settings: &Settings,
        scene: &Scene,
        capabilities: &Capabilities,
        frame: u32,
        change: impl FnOnce(&mut Pose),
    ) -> Result<(Pose, FramePlan), StageError> {
        let [width, height] = settings.size;
        let largest = capabilities.max_size.min(crate::settings::MAX_SIZE);
        if width == 0 || height == 0 || width > largest || height > largest {
            return Err(StageError::Size(width, height, largest));
        }
        if ![1, 4].contains(&settings.samples) {
            return Err(StageError::Samples(settings.samples));
        }
        if !settings.time.is_finite() || settings.time < 0.0 {
            return Err(StageError::Time(settings.time));
        }
        let in_force = planar_shadows::in_force(&failures::while_on(settings));
        let settings = &in_force;
        let Self { workspace, poser, before } = self;
        let (pose, plan_before) = before.take().unwrap_or_default();
        let plan_before = plan_before.emptied();
        workspace.take_back();
        let animation = settings.animation.unwrap_or(scene.default_animation);
        let mut pose = poser.pose(pose, scene, settings.time, animation, &settings.lights);
        change(&mut pose);
        if settings.mirrors.light == MirrorLight::Virtual {
            pose.add_lights_off(scene, &scene.mirrors_in_force(&settings.mirrors).0);
        }
        if settings.show.looks_at_light() && settings.light >= pose.lights.len() {
            return Err(StageError::Light(settings.light, pose.lights.len()));
        }
        let sampling = Sampling { samples: settings.lighting.area_samples, frame };
        let points = pose.lights.iter().map(|light| sampling.points(light) as usize).sum();
        if points > MOST_POINTS {
            return Err(StageError::Points(points));
        }
        pose.expand_lights(sampling, settings.light, settings.lighting.light_sample);
        let mut camera = Camera::choose(settings, scene, &pose)?;
        let frames = frames(settings);
        if frame > 0 {
            let beside = DVec2::from(sequence(frame.into(), 0)) - 0.5;
            camera.shift = beside * 2.0 / DVec2::new(width.into(), height.into());
        }
        let gather = (frames > 1).then_some(Gather { frame, frames });
        let mut plan = plan(settings, scene, &pose, camera, capabilities, gather, (workspace, plan_before));
        if dissolve::wanted(settings) {
            let technique = settings.dissolve.into.unwrap_or(settings.technique);
            let second = Settings { technique, ..settings.clone() };
            let spare = (&*workspace, FramePlan::default());
            match (&settings.dissolve.scene, &scene.partner) {
                (None, _) => {
                    let second = super::plan(&second, scene, &pose, camera, capabilities, gather, spare);
                    plan = dissolve::mixed(plan, second, &settings.dissolve, settings.time);
                }
                (Some(name), Some(partner)) => {
                    let time = settings.time;
                    let second = Settings { time, ..second.of_another_scene(SceneChoice::Stock(name.clone())) };
                    let mut posed = poser.pose(Pose::default(), partner, time, partner.default_animation, &second.lights);
                    if second.mirrors.light == MirrorLight::Virtual {
                        posed.add_lights_off(partner, &partner.mirrors_in_force(&second.mirrors).0);
                    }
                    posed.expand_lights(sampling, second.light, second.lighting.light_sample);
                    if posed.lights.len() > MOST_POINTS {
                        return Err(StageError::Points(posed.lights.len()));
                    }
                    let camera = Camera::choose(&second, partner, &posed)?;
                    let then = super::plan(&second, partner, &posed, camera, capabilities, gather, spare);
                    plan = dissolve::into_another(plan, then, &settings.dissolve, settings.time);
                    pose.partner = Some(Box::new(posed));
                }
                (Some(name), None) => plan.notes.push(format!("nothing dissolves here: the scene {name} is not open")),
            }
        }
        if let Some(failure) = settings.failure {
            failures::spoil(failure, &mut plan);
        }
        silhouettes::choose(&mut plan, settings.silhouettes, (scene, &pose), capabilities, workspace);
        validate(&plan)?;
        Ok((pose, plan))
    }
}
