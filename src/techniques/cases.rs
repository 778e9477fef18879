//! Casters in the colours of their cases for one light (M section 7, image 6).
//!
//! M paints the cubes of case 3 green and leaves the others as they are; here every case has its own
//! colour, and what was left out another. The colours are the plan's: a step draws all surfaces of one
//! class in one constant, shaded by their slope alone, so that the picture's hues say nothing else.
//!
//! A caster of case 2 is out of view by what that case means, so this show has yellow only where a
//! caster's box is said to be out of view wrongly or reaches beyond the light's scissor; `show bounds`
//! has it from above.

use serde::Serialize;

use super::surfaces::{self, Known, SurfaceGroup, Tint};
use crate::frame::plan::{Case, View, VolumePlan};
use crate::frame::{Action, Look, Method, Program, Step, Surface};
use crate::scene::Scene;

/// What an instance is to one light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Class {
    /// M's case 1.
    One,
    /// M's case 2.
    Two,
    /// M's case 3.
    Three,
    /// A caster whose volume is not counted: it can matter to nothing.
    LeftOut,
    /// It casts no shadow in this light.
    Receiver,
}

impl Class {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 5] = [Self::One, Self::Two, Self::Three, Self::LeftOut, Self::Receiver];

    /// As the picture stores it (sRGB, 0 to 1), before it is shaded: apart also for eyes that tell red from
    /// green badly (after Okabe and Ito's palette).
    #[must_use]
    pub const fn color(self) -> [f32; 3] {
        match self {
            Self::One => [0.42, 0.66, 0.90],
            Self::Two => [0.98, 0.83, 0.24],
            Self::Three => [0.93, 0.33, 0.18],
            Self::LeftOut => [0.62, 0.50, 0.78],
            Self::Receiver => [0.84, 0.84, 0.82],
        }
    }

    /// A word or two for legends.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::One => "case 1",
            Self::Two => "case 2",
            Self::Three => "case 3",
            Self::LeftOut => "left out",
            Self::Receiver => "no caster",
        }
    }

    /// One sentence for people.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::One => Case::One.words(),
            Self::Two => Case::Two.words(),
            Self::Three => Case::Three.words(),
            Self::LeftOut => "its shadow can matter to nothing that is lit and in view: it is not counted",
            Self::Receiver => "it casts no shadow in this light",
        }
    }

    fn of(volume: &VolumePlan) -> Self {
        match (volume.method, volume.case) {
            (Method::Dropped, _) | (_, None) => Self::LeftOut,
            (_, Some(Case::One)) => Self::One,
            (_, Some(Case::Two)) => Self::Two,
            (_, Some(Case::Three)) => Self::Three,
        }
    }
}

/// Where no surface is: a display value, and no hue of a class.
pub const BACKGROUND: [f32; 4] = [0.055, 0.06, 0.075, 1.0];

/// What blended surfaces are shown as: a display colour, and how much of it. They cast no shadows.
const GLASS: [f32; 4] = [0.84, 0.84, 0.82, 0.18];

/// What each instance's surfaces are to `light`, whose volumes are among `volumes`; `shadows` says whether it
/// casts any.
#[must_use]
pub fn classes(scene: &Scene, volumes: &[VolumePlan], light: usize, shadows: bool) -> Vec<Class> {
    // A light whose bounds are out of view has no volumes planned at all: nothing of it is seen.
    let unplanned = if shadows { Class::LeftOut } else { Class::Receiver };
    let mut classes: Vec<_> = scene
        .instances()
        .map(|(_, node, mesh)| {
            let casts = node.casts_shadow && mesh.primitives.iter().any(|part| part.casts_shadow);
            if casts { unplanned } else { Class::Receiver }
        })
        .collect();
    for volume in volumes.iter().filter(|volume| volume.light == light) {
        classes[volume.instance] = Class::of(volume);
    }
    classes
}

/// Every surface in its class's colour, as `color_of` has it; lays depth. Parts of a caster that cast no shadow
/// are receivers.
#[must_use]
pub fn steps(
    scene: &Scene,
    groups: &[SurfaceGroup],
    classes: &[Class],
    color_of: fn(Class) -> [f32; 3],
    scissor: [u32; 4],
) -> Vec<Step> {
    let meshes: Vec<_> = scene.instances().map(|(_, _, mesh)| mesh).collect();
    let class_of = |surface: Surface| {
        let casts = meshes[surface.instance].primitives[surface.primitive].casts_shadow;
        if casts { classes[surface.instance] } else { Class::Receiver }
    };
    let of_class = |class: Class| {
        let [r, g, b] = color_of(class);
        let tint = Tint { label: class.name(), why: class.words(), color: [r, g, b, 1.0], inside: false };
        surfaces::tinted(groups, &tint, |surface| class_of(surface) == class, scissor)
    };
    Class::ALL.into_iter().flat_map(of_class).collect()
}

/// Blended surfaces as thin grey glass: they cast no shadows.
#[must_use]
pub fn glass(known: Known<'_>, view: &View, scissor: [u32; 4]) -> Vec<Step> {
    let mut steps = surfaces::transparent(known, view, scissor);
    for step in &mut steps {
        step.why = "Blended surfaces as thin glass: they cast no shadows.".into();
        if let Action::Draw(draw) = &mut step.action {
            draw.program = Program::Tint;
            draw.look = Look::default();
            draw.constant = GLASS;
        }
    }
    steps
}
