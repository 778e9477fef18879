//! `obscura verify`'s arguments.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::Args;

use super::input::InputError;
use super::picture::PictureArguments;
use crate::settings::{Settings, Technique};

/// What is to be verified.
#[derive(Debug, Clone, PartialEq)]
pub struct VerifyRequest {
    /// The view; of random ones what all have in common.
    pub settings: Settings,
    /// Drawn by each of these.
    pub techniques: Vec<Technique>,
    /// Only this light; else all of them, or one at random in each random view.
    pub light: Option<usize>,
    /// How many random views, and the seed they are made from.
    pub random: Option<(usize, u64)>,
    /// A picture of the wrong pixels.
    pub diff: Option<PathBuf>,
}

/// The size of random views, pixels: small, for there are many of them.
pub const RANDOM_SIZE: [u32; 2] = [320, 180];

#[derive(Debug, Args)]
pub(super) struct VerifyArguments {
    /// A stock scene's name, or a .gltf or .glb file (`./name` where a file has a stock name)
    #[arg(value_name = "SCENE")]
    scene: OsString,
    #[command(flatten)]
    pub(super) picture: PictureArguments,
    /// Looks from N random places with the light at random places: anywhere, in casters, in their
    /// shadows, with casters across the near plane, at mirrors; 320x180 pixels each unless --size says otherwise
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    random: Option<u32>,
    /// What the random views are made from: the same seed gives the same views everywhere
    #[arg(long, value_name = "S", default_value_t = 1, requires = "random")]
    seed: u64,
    /// Writes a picture of the wrong pixels: red drawn lit, blue drawn dark, magenta another surface, edges faintly
    #[arg(long, value_name = "FILE.png")]
    diff: Option<PathBuf>,
    /// Prints what was found as JSON
    #[arg(long)]
    pub(super) json: bool,
}

impl VerifyArguments {
    pub(super) fn request(self) -> Result<VerifyRequest, InputError> {
        let mut picture = self.picture;
        // Without shadows there is nothing to verify, unless it is asked for.
        let counting = || Technique::ALL.into_iter().filter(|technique| *technique != Technique::None).collect();
        let techniques = match picture.technique.take_if(|name| name == "all") {
            None if picture.technique.is_some() => None,
            _ => Some(counting()),
        };
        if self.random.is_some() {
            picture.size.get_or_insert(RANDOM_SIZE);
        }
        let light = picture.light;
        let settings = picture.settings(Some(&self.scene), Settings::default())?;
        Ok(VerifyRequest {
            techniques: techniques.unwrap_or_else(|| vec![settings.technique]),
            settings,
            light,
            random: self.random.map(|count| (count as usize, self.seed)),
            diff: self.diff,
        })
    }
}
