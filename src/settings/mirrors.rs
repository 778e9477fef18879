//! Which surfaces are mirrors, and how what is seen in them is drawn.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Mirrors, and what is seen in them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Mirrors {
    /// How reflections are drawn.
    pub mode: MirrorMode,
    /// How often a ray is reflected at most, 1 to [`MAX_BOUNCES`]: for the modes that go on in mirrors.
    pub bounces: u32,
    /// What a mirror shows where a ray has been reflected as often as it may be.
    pub last: LastBounce,
    /// Mirrors reflect more, the more obliquely they are seen (Schlick 1994), instead of evenly.
    pub fresnel: bool,
    /// Pixels: how wide a reflection's texture is, [`LEAST_TEXTURE`] to [`MOST_TEXTURE`], as far as the picture is as wide;
    /// its height follows the picture's.
    pub texture: u32,
    /// Pixels: views of a smaller area are not drawn; 0 draws every one that shows.
    pub least_pixels: u32,
    /// What mirrors do to light.
    pub light: MirrorLight,
    /// What was changed of the scene's mirrors.
    #[serde(with = "as_list")]
    pub edits: BTreeMap<SurfacePlace, bool>,
}

/// A surface of the scene: one primitive of a node's mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct SurfacePlace {
    /// The scene's node.
    pub node: usize,
    /// Of its mesh.
    pub primitive: usize,
}

/// Turns a surface on where it was off, or off where it was on, by `edits` of what the scene has `marked`; `can` says whether
/// one that is not marked may be on. Gives which of the two it is now.
///
/// # Errors
/// What `can` says: nothing has changed then.
pub fn toggle<E>(
    edits: &mut BTreeMap<SurfacePlace, bool>,
    place: SurfacePlace,
    marked: bool,
    can: impl FnOnce() -> Result<(), E>,
) -> Result<bool, E> {
    let on = !edits.get(&place).copied().unwrap_or(marked);
    if on && !marked {
        can()?;
    }
    if on == marked {
        edits.remove(&place);
    } else {
        edits.insert(place, on);
    }
    Ok(on)
}

/// The narrowest texture of a reflection, pixels.
pub const LEAST_TEXTURE: u32 = 16;

/// The widest.
pub const MOST_TEXTURE: u32 = 4096;

/// The most reflections of one ray.
pub const MAX_BOUNCES: u32 = 8;

impl Default for Mirrors {
    fn default() -> Self {
        Self {
            mode: MirrorMode::default(),
            bounces: 4,
            last: LastBounce::default(),
            fresnel: false,
            texture: 256,
            least_pixels: 0,
            light: MirrorLight::default(),
            edits: BTreeMap::new(),
        }
    }
}

impl Mirrors {
    /// The same without what speaks of one scene's surfaces.
    #[must_use]
    pub fn of_another_scene(self) -> Self {
        Self { edits: BTreeMap::new(), ..self }
    }

    /// How often a ray is reflected at most, by the mode.
    #[must_use]
    pub fn most_bounces(&self) -> u32 {
        match self.mode {
            MirrorMode::Off => 0,
            MirrorMode::Unbounded | MirrorMode::Stencil | MirrorMode::Texture => 1,
            MirrorMode::Recursive => self.bounces.clamp(1, MAX_BOUNCES),
        }
    }
}

/// How reflections are drawn.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MirrorMode {
    /// Not at all: mirrors are surfaces as others.
    Off,
    /// One reflection, with nothing to keep it within the mirror (K section 2): what is reflected shows beside it too,
    /// and what stands behind it. Exact values are shown as with [`Self::Stencil`].
    Unbounded,
    /// One reflection, bounded by the stencil (K section 3); mirrors seen in a mirror are grey.
    Stencil,
    /// Mirrors in mirrors (K section 3, "recursive reflections").
    #[default]
    Recursive,
    /// One reflection, drawn into a texture of its own, which is then laid on the mirror: no stencil is needed, but the
    /// texture's own pixels show (K section 3 compares the two; Quake 3 does it so). Exact values are shown as with
    /// [`Self::Stencil`].
    Texture,
}

impl MirrorMode {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 5] = [Self::Off, Self::Unbounded, Self::Stencil, Self::Recursive, Self::Texture];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Unbounded => "unbounded",
            Self::Stencil => "stencil",
            Self::Recursive => "recursive",
            Self::Texture => "texture",
        }
    }

    /// One sentence for help and panel.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Off => "mirrors are ordinary surfaces",
            Self::Unbounded => "one reflection without the stencil: it shows beside the mirror too (Kilgard 2, figure 3)",
            Self::Stencil => "one reflection, bounded by the stencil; mirrors in a mirror are grey (Kilgard 3)",
            Self::Recursive => "mirrors in mirrors, each view bounded by the stencil (Kilgard 3)",
            Self::Texture => "one reflection, drawn into a texture first, which is then laid on the mirror (Quake 3)",
        }
    }
}

/// What a mirror shows past the last reflection.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LastBounce {
    /// Neutral grey (K section 3).
    #[default]
    Grey,
    /// The same, and every reflection before it fades towards it.
    Fade,
}

impl LastBounce {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 2] = [Self::Grey, Self::Fade];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Grey => "grey",
            Self::Fade => "fade",
        }
    }

    /// One sentence for help and panel.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Grey => "past the last bounce mirrors are neutral grey (Kilgard 3)",
            Self::Fade => "each bounce fades towards the grey that lies past the last",
        }
    }
}

/// What mirrors do to light.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MirrorLight {
    /// Nothing: what they show is all they do.
    #[default]
    Off,
    /// More ambient light, as much as would come off them were it spread evenly (K section 3).
    Ambient,
    /// Each mirror throws each light back once: a virtual light behind it that shines through its outline and casts
    /// shadows on both parts of the way (K section 3; Diefenbach).
    Virtual,
}

impl MirrorLight {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 3] = [Self::Off, Self::Ambient, Self::Virtual];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Ambient => "ambient",
            Self::Virtual => "virtual",
        }
    }

    /// One sentence for help and panel.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Off => "light does not come off mirrors",
            Self::Ambient => "mirrors add ambient light, as much as comes off them (Kilgard 3)",
            Self::Virtual => "every mirror throws every light back once, with exact shadows on both parts of the way",
        }
    }
}

/// Maps with keys that are no text, as lists of pairs.
pub(super) mod as_list {
    use std::collections::BTreeMap;

    use serde::{Deserialize as _, Deserializer, Serializer};

    use super::SurfacePlace;

    pub fn serialize<S: Serializer>(edits: &BTreeMap<SurfacePlace, bool>, to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(edits)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<BTreeMap<SurfacePlace, bool>, D::Error> {
        Ok(Vec::<(SurfacePlace, bool)>::deserialize(from)?.into_iter().collect())
    }
}
