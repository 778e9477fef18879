//! The options that say which surfaces are mirrors and how far they are followed, to [`Mirrors`] and back.

use clap::Args;

use super::command_line::Line;
use super::input::InputError;
use super::{by_name, index, names};
use crate::scene::{Refusal, Scene};
use crate::settings::{LEAST_TEXTURE, LastBounce, MAX_BOUNCES, MOST_TEXTURE, MirrorLight, MirrorMode, Mirrors, SurfacePlace};

/// What both the window and `render` understand of it.
#[derive(Debug, Clone, PartialEq, Args)]
pub(super) struct MirrorArguments {
    #[arg(long, value_name = "MODE", help = format!("How mirrors are drawn: {} [default: recursive]", names(MirrorMode::ALL.map(MirrorMode::name))))]
    mirrors: Option<String>,
    /// How often a ray is reflected at most, 1 to 8, where mirrors are recursive [default: 4]
    #[arg(long, value_name = "N")]
    bounces: Option<u32>,
    #[arg(long, value_name = "L", help = format!("What lies past the last bounce: {} [default: grey]", names(LastBounce::ALL.map(LastBounce::name))))]
    last_bounce: Option<String>,
    /// Mirrors reflect more, the more obliquely they are seen: on or off [default: off]
    #[arg(long, value_name = "SWITCH")]
    fresnel: Option<String>,
    /// How wide a reflection's texture is, 16 to 4096 pixels, where mirrors are textures [default: 256]
    #[arg(long, value_name = "PIXELS")]
    mirror_texture: Option<u32>,
    /// Reflections of fewer pixels are not drawn [default: 0]
    #[arg(long, value_name = "PIXELS")]
    least_pixels: Option<u32>,
    #[arg(long, value_name = "MODE", help = format!("What mirrors do to light: {} [default: off]", names(MirrorLight::ALL.map(MirrorLight::name))))]
    mirror_light: Option<String>,
    /// Makes a flat surface a mirror, or a mirror none, such as "12=on" or "3:1=off" for the second primitive of node 3;
    /// can be repeated
    #[arg(long, value_name = "NODE[:PRIMITIVE]=SWITCH", value_parser = edit)]
    mirror: Vec<(SurfacePlace, bool)>,
}

impl MirrorArguments {
    /// Changes `mirrors` as the arguments say.
    pub fn apply(&self, mirrors: &mut Mirrors) -> Result<(), InputError> {
        if let Some(name) = &self.mirrors {
            mirrors.mode = by_name("mirror mode", name, MirrorMode::ALL, MirrorMode::name)?;
        }
        mirrors.bounces = self.bounces.unwrap_or(mirrors.bounces);
        if let Some(name) = &self.last_bounce {
            mirrors.last = by_name("last bounce", name, LastBounce::ALL, LastBounce::name)?;
        }
        if let Some(name) = &self.fresnel {
            mirrors.fresnel = by_name("fresnel", name, [false, true], switch)?;
        }
        if let Some(name) = &self.mirror_light {
            mirrors.light = by_name("mirror light", name, MirrorLight::ALL, MirrorLight::name)?;
        }
        mirrors.texture = self.mirror_texture.unwrap_or(mirrors.texture);
        mirrors.least_pixels = self.least_pixels.unwrap_or(mirrors.least_pixels);
        mirrors.edits.extend(self.mirror.iter().copied());
        Ok(())
    }
}

fn switch(on: bool) -> &'static str {
    if on { "on" } else { "off" }
}

/// A surface, switched: `NODE[:PRIMITIVE]=on|off`.
pub(super) fn edit(text: &str) -> Result<(SurfacePlace, bool), String> {
    let read = || {
        let (place, state) = text.split_once('=')?;
        let (node, primitive) = place.split_once(':').unwrap_or((place, "0"));
        let place = SurfacePlace { node: index(node).ok()?, primitive: index(primitive).ok()? };
        let on = [false, true].into_iter().find(|on| switch(*on) == state)?;
        Some((place, on))
    };
    read().ok_or_else(|| "expected a node's number, a primitive's and on or off, such as 12=on or 3:1=off".into())
}

/// The options that give `mirrors` again.
pub(super) fn write(mirrors: &Mirrors, line: &mut Line) {
    let Mirrors { mode, bounces, last, fresnel, texture, least_pixels, light, edits } = mirrors;
    let default = Mirrors::default();
    if *mode != default.mode {
        line.option("--mirrors", mode.name());
    }
    if *bounces != default.bounces {
        line.option("--bounces", &bounces.to_string());
    }
    if *last != default.last {
        line.option("--last-bounce", last.name());
    }
    if *texture != default.texture {
        line.option("--mirror-texture", &texture.to_string());
    }
    if *fresnel != default.fresnel {
        line.option("--fresnel", switch(*fresnel));
    }
    if *least_pixels != default.least_pixels {
        line.option("--least-pixels", &least_pixels.to_string());
    }
    if *light != default.light {
        line.option("--mirror-light", light.name());
    }
    for (place, on) in edits {
        line.option("--mirror", &edited(place, *on));
    }
}

/// What [`edit`] reads.
pub(super) fn edited(SurfacePlace { node, primitive }: &SurfacePlace, on: bool) -> String {
    format!("{node}:{primitive}={}", switch(on))
}

/// Says whether `mirrors` can be drawn on some scene.
pub(super) fn check(mirrors: &Mirrors) -> Result<(), InputError> {
    let within = |what, value, least, most| {
        if (least..=most).contains(&value) { Ok(()) } else { Err(InputError::Range { what, value, least, most }) }
    };
    within("the bounces", mirrors.bounces, 1, MAX_BOUNCES)?;
    within("a reflection's texture", mirrors.texture, LEAST_TEXTURE, MOST_TEXTURE)
}

/// Says whether the surfaces that `mirrors` speak of are there. What cannot be a mirror is drawn as it is, and
/// a note says why.
pub(super) fn check_against(mirrors: &Mirrors, scene: &Scene) -> Result<(), InputError> {
    let missing = |place: &&SurfacePlace| scene.can_mirror(**place) == Err(Refusal::Missing);
    match mirrors.edits.keys().find(missing) {
        Some(&SurfacePlace { node, primitive }) => Err(InputError::Surface { node, primitive }),
        None => Ok(()),
    }
}
