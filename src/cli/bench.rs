//! `obscura bench`'s arguments.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::Args;

use super::command_line::{Line, picture_options};
use super::input::InputError;
use super::picture::PictureArguments;
use super::{by_name, names, scene_choice};
use crate::scene::stock;
use crate::settings::{MAX_BOUNCES, SceneChoice, Settings, Technique};

/// Frames measured where nothing is said: three rounds of the lights.
pub const DEFAULT_FRAMES: u32 = 60;
/// More would only be waited for.
const MOST_FRAMES: u32 = 100_000;

/// What is to be measured.
#[derive(Debug, Clone, PartialEq)]
pub struct BenchRequest {
    /// Each of these pictures, those of one scene after one another.
    pub pictures: Vec<Settings>,
    /// How often each is drawn and measured.
    pub frames: u32,
}

/// What is doubled again and again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sweep {
    /// Boxes on a floor.
    Casters,
    /// Triangles of one knot.
    Triangles,
    /// Lights around boxes.
    Lights,
    /// Reflections of a ray.
    Bounces,
    /// Pixels of the picture.
    Pixels,
}

impl Sweep {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 5] = [Self::Casters, Self::Triangles, Self::Lights, Self::Bounces, Self::Pixels];

    /// The name on the command line and of the files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Casters => "casters",
            Self::Triangles => "triangles",
            Self::Lights => "lights",
            Self::Bounces => "bounces",
            Self::Pixels => "pixels",
        }
    }

    /// How many points it has where nothing is said, and how many at most.
    #[must_use]
    pub const fn steps(self) -> [u32; 2] {
        match self {
            Self::Casters => [11, 16],
            Self::Triangles => [10, 13],
            Self::Lights => [6, 8],
            Self::Bounces => [MAX_BOUNCES.ilog2() + 1, MAX_BOUNCES.ilog2() + 1],
            Self::Pixels => [7, 10],
        }
    }

    /// The scene that is swept where none is named; none where the sweep makes its scenes.
    #[must_use]
    pub const fn scene(self) -> Option<&'static str> {
        match self {
            Self::Casters | Self::Triangles | Self::Lights => None,
            Self::Bounces => Some("barbershop"),
            Self::Pixels => Some("cubes"),
        }
    }
}

/// How the cost of frames grows: what is to be measured, and where it goes.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepRequest {
    /// With what.
    pub sweep: Sweep,
    /// How often it is doubled, and one.
    pub steps: u32,
    /// What all pictures have in common.
    pub settings: Settings,
    /// Each is drawn by these.
    pub techniques: Vec<Technique>,
    /// How often each is drawn and measured.
    pub frames: u32,
    /// The folder to write to; made where it is missing.
    pub out: PathBuf,
}

impl SweepRequest {
    /// The line that measures it again, quoted for a POSIX shell; writes to where it is run.
    #[must_use]
    pub fn command(&self) -> String {
        let Self { sweep, steps, settings, techniques, frames, out: _ } = self;
        let mut line = Line::default();
        line.word("obscura");
        line.word("bench");
        if sweep.scene().is_some() {
            line.scene(&settings.scene);
        }
        line.option("--sweep", sweep.name());
        line.option("--out", ".");
        line.option("--technique", &techniques.iter().map(|technique| technique.name()).collect::<Vec<_>>().join(","));
        line.option("--frames", &frames.to_string());
        line.option("--steps", &steps.to_string());
        picture_options(&Settings { technique: Technique::default(), ..settings.clone() }, &mut line);
        line.finish()
    }
}

/// The size that the sweep over pixels begins with where nothing is said.
const SMALLEST: [u32; 2] = [320, 180];
/// What sweeps draw by where nothing is said.
const SWEPT: [Technique; 4] = [Technique::None, Technique::ZPass, Technique::ZFail, Technique::Auto];

#[derive(Debug, Args)]
pub(super) struct BenchArguments {
    /// Stock scenes' names, or .gltf or .glb files (`./name` where a file has a stock name) [default: every stock scene]
    #[arg(value_name = "SCENE")]
    scenes: Vec<OsString>,
    #[command(flatten)]
    pub(super) picture: PictureArguments,
    /// Frames to measure of each
    #[arg(long, value_name = "N", default_value_t = DEFAULT_FRAMES, allow_hyphen_values = true)]
    frames: u32,
    #[arg(long, value_name = "WHAT", requires = "out", help = format!("Doubles one thing again and again: {}", names(Sweep::ALL.map(Sweep::name))))]
    sweep: Option<String>,
    /// The folder for a sweep's table and plot, WHAT.csv and WHAT.png; made where it is missing
    #[arg(long, value_name = "DIR", requires = "sweep")]
    out: Option<PathBuf>,
    /// How many points a sweep has, each twice the one before [default: as many as show where its curves bend]
    #[arg(long, value_name = "N", requires = "sweep", allow_hyphen_values = true)]
    steps: Option<u32>,
    /// Prints what was measured as JSON
    #[arg(long)]
    pub(super) json: bool,
}

impl BenchArguments {
    /// Of a sweep, where one is asked for.
    pub(super) fn sweep_request(&self) -> Result<Option<SweepRequest>, InputError> {
        let (Some(name), Some(out)) = (&self.sweep, &self.out) else { return Ok(None) };
        let sweep = by_name("sweep", name, Sweep::ALL, Sweep::name)?;
        let refused = |takes| Err(InputError::SweepScene { sweep: sweep.name(), takes });
        let scene = match (sweep.scene(), &self.scenes[..]) {
            (None, []) => None,
            (None, _) => return refused("makes its own scenes: leave SCENE out"),
            (Some(scene), []) => Some(SceneChoice::Stock(scene.into())),
            (Some(_), [scene]) => Some(scene_choice(scene)?),
            (Some(_), _) => return refused("takes one scene"),
        };
        let [usual, most] = sweep.steps();
        let steps = self.steps.unwrap_or(usual);
        in_range("the number of steps", steps, most)?;
        in_range("the number of frames", self.frames, MOST_FRAMES)?;
        let mut picture = self.picture.clone();
        if sweep == Sweep::Pixels {
            picture.size.get_or_insert(SMALLEST);
        }
        let chosen = picture.technique.take().map(|names| techniques(&names)).transpose()?;
        let mut settings = picture.settings(None, Settings::default())?;
        settings.scene = scene.unwrap_or(settings.scene);
        let techniques = chosen.unwrap_or_else(|| SWEPT.into());
        Ok(Some(SweepRequest { sweep, steps, settings, techniques, frames: self.frames, out: out.clone() }))
    }

    pub(super) fn request(mut self) -> Result<BenchRequest, InputError> {
        in_range("the number of frames", self.frames, MOST_FRAMES)?;
        let techniques = self.picture.technique.take().map(|names| techniques(&names)).transpose()?;
        let scenes = self.scenes()?;
        let mut pictures = Vec::new();
        for settings in scenes {
            let techniques = techniques.clone().unwrap_or_else(|| vec![settings.technique]);
            pictures.extend(techniques.into_iter().map(|technique| Settings { technique, ..settings.clone() }));
        }
        Ok(BenchRequest { pictures, frames: self.frames })
    }

    /// The picture of each scene.
    fn scenes(&self) -> Result<Vec<Settings>, InputError> {
        let of = |scene| self.picture.settings(scene, Settings::default());
        if !self.scenes.is_empty() {
            return self.scenes.iter().map(|word| of(Some(word))).collect();
        }
        if self.picture.failure.is_some() {
            // It brings its own.
            return Ok(vec![of(None)?]);
        }
        let stock = stock::TABLE.iter().map(|row| SceneChoice::Stock(row.name.into()));
        stock.map(|scene| Ok(Settings { scene, ..of(None)? })).collect()
    }
}

fn in_range(what: &'static str, value: u32, most: u32) -> Result<(), InputError> {
    if (1..=most).contains(&value) { Ok(()) } else { Err(InputError::Range { what, value, least: 1, most }) }
}

/// `all`, or names between commas.
fn techniques(names: &str) -> Result<Vec<Technique>, InputError> {
    if names == "all" {
        return Ok(Technique::ALL.into());
    }
    names.split(',').map(|name| by_name("technique", name.trim(), Technique::ALL, Technique::name)).collect()
}
