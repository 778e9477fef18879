//! `obscura bench`'s arguments.

use std::ffi::OsString;

use clap::Args;

use super::by_name;
use super::input::InputError;
use super::picture::PictureArguments;
use crate::scene::stock;
use crate::settings::{SceneChoice, Settings, Technique};

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
    /// Prints what was measured as JSON
    #[arg(long)]
    pub(super) json: bool,
}

impl BenchArguments {
    pub(super) fn request(mut self) -> Result<BenchRequest, InputError> {
        if !(1..=MOST_FRAMES).contains(&self.frames) {
            return Err(InputError::Range { what: "the number of frames", value: self.frames, least: 1, most: MOST_FRAMES });
        }
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

/// `all`, or names between commas.
fn techniques(names: &str) -> Result<Vec<Technique>, InputError> {
    if names == "all" {
        return Ok(Technique::ALL.into());
    }
    names.split(',').map(|name| by_name("technique", name.trim(), Technique::ALL, Technique::name)).collect()
}
