//! What the window and every command that draws understand, and the settings that come of it.

use std::ffi::OsStr;
use std::path::PathBuf;

use clap::Args;
use glam::DVec3;

use super::input::{InputError, check};
use super::{
    animation, by_name, complexity, counting, csg, culling, decals, diagram, dissolve, halo, index, light_edit, lighting,
    mirrors, names, planar, playground, point, scene_choice, silhouettes, size,
};
use crate::failures;
use crate::scene::AnimationChoice;
use crate::settings::{CameraChoice, Failure, LightEdit, Settings, Show, Technique};

/// What both the window and `render` understand. Words and numbers are kept as they were read;
/// whether they name something is [`PictureArguments::settings`]'s business.
#[derive(Debug, Clone, PartialEq, Args)]
pub(super) struct PictureArguments {
    #[arg(long, value_name = "T", help = format!("How shadows are counted: {}", names(Technique::ALL.map(Technique::name))))]
    pub(super) technique: Option<String>,
    #[arg(long, value_name = "S", help = format!("What is shown: {}", names(Show::ALL.map(Show::name))))]
    pub(super) show: Option<String>,
    /// A classic mistake, made on purpose (`obscura list` names them); without SCENE it is shown on a scene of
    /// its own
    #[arg(long, value_name = "NAME")]
    pub(super) failure: Option<String>,
    /// The light that stencil, shadow and volumes look at, from 0
    #[arg(long, value_name = "K", allow_hyphen_values = true, value_parser = index)]
    pub(super) light: Option<usize>,
    /// Pixels [default: 1280x720]
    #[arg(long, value_name = "WxH", allow_hyphen_values = true, value_parser = size)]
    pub(super) size: Option<[u32; 2]>,
    /// Samples a pixel, 1 or 4 [default: 1]
    #[arg(long, value_name = "N")]
    samples: Option<u32>,
    /// One of the scene's cameras [default: its first]
    #[arg(long, value_name = "NAME|INDEX", allow_hyphen_values = true, conflicts_with_all = ["eye", "target"])]
    camera: Option<String>,
    /// Where the camera stands, metres
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = point)]
    pub(super) eye: Option<DVec3>,
    /// What the camera looks at, metres
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = point)]
    pub(super) target: Option<DVec3>,
    /// The full vertical angle of view, degrees [default: the camera's]
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    fov: Option<f64>,
    /// A far plane, metres, which cuts shadow volumes off and spoils counting [default: none]
    #[arg(long, value_name = "METRES", allow_hyphen_values = true)]
    far: Option<f64>,
    /// Seconds into the animation [default: 0]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    time: Option<f64>,
    /// Which animations play [default: the scene's choice]
    #[arg(long, value_name = "all|still|N", allow_hyphen_values = true, value_parser = animation)]
    animation: Option<AnimationChoice>,
    /// Adds a floor beneath a file's scene
    #[arg(long)]
    floor: bool,
    /// Brightens or darkens the picture [default: 0]
    #[arg(long, value_name = "STOPS", allow_hyphen_values = true)]
    exposure: Option<f32>,
    /// Shades meshes without the bound that keeps facets off the terminator
    #[arg(long)]
    no_smooth_terminator: bool,
    /// Changes light K, such as "0:on=false" or
    /// "1:position=0;3;0,color=1;0.5;0.2,intensity=40,range=12,shadows=true,radius=0.3,slide=window"; can be repeated
    #[arg(long, value_name = "K:WHAT=VALUE,...", value_parser = light_edit::parse)]
    light_edit: Vec<(usize, LightEdit)>,
    #[command(flatten)]
    lighting: lighting::LightingArguments,
    #[command(flatten)]
    counting: counting::CountingArguments,
    #[command(flatten)]
    culling: culling::CullingArguments,
    #[command(flatten)]
    complexity: complexity::ComplexityArguments,
    #[command(flatten)]
    diagram: diagram::DiagramArguments,
    #[command(flatten)]
    decals: decals::DecalArguments,
    #[command(flatten)]
    dissolve: dissolve::DissolveArguments,
    #[command(flatten)]
    playground: playground::BoardArguments,
    #[command(flatten)]
    mirrors: mirrors::MirrorArguments,
    #[command(flatten)]
    halos: halo::HaloArguments,
    #[command(flatten)]
    csg: csg::CsgArguments,
    #[command(flatten)]
    planar: planar::PlanarArguments,
    #[command(flatten)]
    silhouettes: silhouettes::SilhouetteArguments,
    /// The graphics adapter: part of its name
    #[arg(long, value_name = "SUBSTRING", allow_hyphen_values = true)]
    adapter: Option<String>,
    /// Reads the shaders from a folder, and again when they change
    #[arg(long, value_name = "DIR")]
    shaders: Option<PathBuf>,
}

impl PictureArguments {
    /// `base`, changed as the arguments say.
    pub(super) fn settings(&self, scene: Option<&OsStr>, base: Settings) -> Result<Settings, InputError> {
        let mut settings = base;
        if let Some(word) = scene {
            settings = settings.of_another_scene(scene_choice(word)?);
        }
        if let Some(name) = &self.failure {
            let failure = by_name("failure", name, Failure::ALL, Failure::name)?;
            settings = if scene.is_none() {
                failures::demonstration(failure, &settings)
            } else {
                Settings { failure: Some(failure), ..settings }
            };
        }
        if let Some(name) = &self.technique {
            settings.technique = by_name("technique", name, Technique::ALL, Technique::name)?;
        }
        if let Some(name) = &self.show {
            settings.show = by_name("show", name, Show::ALL, Show::name)?;
        }
        if let (Some(eye), Some(target)) = (self.eye, self.target) {
            settings.camera = CameraChoice::Free { eye, target };
        }
        if let Some(name) = &self.camera {
            settings.camera = CameraChoice::Named(name.clone());
        }
        settings.light = self.light.unwrap_or(settings.light);
        settings.size = self.size.unwrap_or(settings.size);
        settings.samples = self.samples.unwrap_or(settings.samples);
        settings.fov = self.fov.or(settings.fov);
        settings.far = self.far.or(settings.far);
        settings.time = self.time.unwrap_or(settings.time);
        settings.animation = self.animation.or(settings.animation);
        settings.floor |= self.floor;
        settings.exposure = self.exposure.unwrap_or(settings.exposure);
        settings.smooth_terminator &= !self.no_smooth_terminator;
        for (light, edit) in &self.light_edit {
            light_edit::merge(settings.lights.entry(*light).or_default(), edit);
        }
        self.lighting.apply(&mut settings.lighting)?;
        self.counting.apply(&mut settings.counting)?;
        self.culling.apply(&mut settings.culling)?;
        self.silhouettes.apply(&mut settings.silhouettes)?;
        self.complexity.apply(&mut settings.complexity)?;
        self.diagram.apply(&mut settings.diagram)?;
        self.decals.apply(&mut settings.decals)?;
        self.dissolve.apply(&mut settings.dissolve)?;
        self.playground.apply(&mut settings.playground)?;
        self.mirrors.apply(&mut settings.mirrors)?;
        self.halos.apply(&mut settings.halos);
        self.csg.apply(&mut settings.csg)?;
        self.planar.apply(&mut settings.planar)?;
        settings.adapter = self.adapter.clone().or(settings.adapter);
        settings.shaders = self.shaders.clone().or(settings.shaders);
        check(&settings)?;
        Ok(settings)
    }
}
