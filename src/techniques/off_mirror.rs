//! Light off mirrors, all in the stencil (K section 3; Diefenbach): a light's reflection shines only through the
//! mirror's outline, and is blocked by what stands between the mirror and the surface, and by what stands between the
//! light and the mirror.
//!
//! ```text
//!     verdict bit   1 - beam: set but where the virtual light is seen through the mirror
//!     count           volumes of what stands before the mirror, thrown by the virtual light
//!                   + volumes of the same, reflected, thrown by the virtual light too
//! ```
//!
//! Light arrives where both are zero. The beam is the volume that the virtual light throws from the mirror's own
//! polygons; it is taken away from a count that starts at one, and collapsed into the verdict bit as a batch is. Of the
//! count the first part shades the way from the mirror on, and the second the way to it: a reflected caster stands as far
//! behind the mirror as the caster stands before it. For each only what lies before the mirror's plane counts. Casters that reach through it are cut there ([`Piece::Before`]); else what is behind the mirror would
//! throw a shadow out of it, and the mirror's own frame one on itself.
//!
//! All of it is z-fail, or wide where the count is too much for the stencil, whatever technique the other lights are
//! counted by: the reflected casters are nowhere in the depth buffer, and the eye may be in any beam.
//!
//! K's cheap alternative is a little more ambient light: [`more_ambient`] says how much.
//!
//! [`Piece::Before`]: crate::frame::Piece::Before

use glam::{DVec3, Vec3};

use super::counting::{self, Ask, Group, LightCount, between_batches};
use super::{Caster, Row};
use crate::frame::state::Depth;
use crate::frame::stencil::StencilState;
use crate::frame::{Method, Part, Reason, VolumePlan};
use crate::geometry::Outline;
use crate::geometry::planar::height;
use crate::scene::{LightKind, Pose, PosedLight, Scene};
use crate::settings::Technique;
use crate::techniques::mirrors::Mirrors;

/// How the beam is counted: z-fail, with every sign turned over. Not a technique to choose.
const BEAM: Row = Row {
    technique: Technique::ZFail,
    title: "Beam",
    about: "The light off a mirror, bounded by its outline.",
    exact: true,
    source: "Kilgard 1999, 3; Diefenbach 1996",
    decide: |_| Some((Method::ZFailCompared, Reason::Beam)),
    outline: Outline::Silhouette,
    extrusion: None,
    darkens: None,
    groups: &[GROUPS],
};

const GROUPS: &[Group] = &[
    Group {
        method: Method::ZFailCompared,
        parts: &[Part::Sides, Part::LightCapKept],
        label: "take the beam off, z-fail",
        why: "Light comes only through the mirror's outline: inside the beam the one that means dark everywhere is taken away.",
        stencil: StencilState::count_z_fail_turned,
        ..Group::PLAIN
    },
    Group {
        method: Method::ZFailCompared,
        parts: &[Part::LightCapTurned],
        label: "take the beam off, its turned cap, z-fail",
        why: "The mirror's triangles face away from the light behind it: the same order of vertices, the other sign.",
        stencil: StencilState::count_z_fail,
        ..Group::PLAIN
    },
    Group {
        method: Method::ZFailCompared,
        parts: &[Part::DarkCap],
        label: "take the beam off, its dark cap, z-fail",
        why: "Every surface hides the dark cap: it counts everywhere.",
        stencil: StencilState::count_z_fail_turned,
        depth: Depth::NEVER,
        ..Group::PLAIN
    },
];

/// The count of a virtual light: of its beam, and of `casters`, real and reflected, by `row`. Plans are appended to
/// `volumes`.
pub fn count(row: &Row, beam: &Caster<'_>, casters: &[Caster<'_>], ask: &Ask<'_>, volumes: &mut Vec<VolumePlan>) -> LightCount {
    // A batch of its own: no cancelled count outside the beam can be taken for light.
    let ask = Ask { solid: None, budget: ask.budget.without_bounds().batched(), ..*ask };
    let number = volumes.len();
    volumes.push(counting::planned(&BEAM, beam, ask.light, (Method::ZFailCompared, Reason::Beam)));
    let count = counting::count_light(row, casters, &ask, volumes);
    let mut steps = counting::steps(&BEAM, (&[number], &[]), volumes, ask.budget, &ask);
    steps.extend(between_batches(0, count.base, ask.budget, &ask));
    steps.extend(count.steps);
    LightCount { base: 1, steps, budget: ask.budget, ..count }
}

/// Nowhere any light: of a mirror that does not reflect this light.
#[must_use]
pub fn dark(ask: &Ask<'_>) -> LightCount {
    LightCount { base: 1, budget: ask.budget.without_bounds(), ..LightCount::default() }
}

/// Ambient light, linear radiance, as much as all lights would give off all mirrors if what comes off them were spread
/// evenly over the inside of a box about the scene: for each light and mirror, the light that falls on it, times what it
/// reflects, over the box's surface.
#[must_use]
pub fn more_ambient(scene: &Scene, pose: &Pose, mirrors: &Mirrors) -> Vec3 {
    let bounds = scene.bounds(pose);
    let sides = (bounds.max - bounds.min).max(Vec3::ZERO).as_dvec3();
    let surface = 2.0 * (sides.x * sides.y + sides.y * sides.z + sides.z * sides.x);
    if surface <= 0.0 || !surface.is_finite() {
        return Vec3::ZERO;
    }
    let mut ambient = Vec3::ZERO;
    for (_, mirror, posed) in mirrors.posed().filter(|(_, mirror, _)| mirror.exit.is_none()) {
        for [a, b, c] in &posed.triangles {
            let area = (b - a).cross(c - a).length() / 2.0;
            let middle = (a + b + c) / 3.0;
            for light in pose.lights.iter().filter(|light| light.on) {
                let arriving =
                    arriving(light, middle, posed.plane.truncate(), mirror.double_sided, height(posed.plane, light.position));
                #[expect(clippy::cast_possible_truncation, reason = "light is of single precision")]
                let share = (arriving * area / (surface * std::f64::consts::PI)) as f32;
                ambient += light.intensity * mirror.look.tint * (mirror.look.reflectivity * share);
            }
        }
    }
    ambient
}

/// What of each unit of a light's intensity arrives on a square metre at `at`: as `shared/light.wgsl` has it.
fn arriving(light: &PosedLight, at: DVec3, normal: DVec3, both_sides: bool, over: f64) -> f64 {
    let facing = |cosine: f64| if both_sides { cosine.abs() } else { cosine.max(0.0) };
    if light.kind == LightKind::Directional {
        return facing(-normal.dot(light.direction));
    }
    if over <= 0.0 && !both_sides {
        return 0.0;
    }
    let to_light = light.position - at;
    let distance_squared = to_light.length_squared().max(1e-6);
    let way = to_light / distance_squared.sqrt();
    let ends = if light.range.is_finite() { distance_squared / (light.range * light.range) } else { 0.0 };
    let window = (1.0 - ends * ends).clamp(0.0, 1.0);
    let cone = match light.kind {
        LightKind::Spot { inner, outer } => {
            let (inner, outer) = (f64::from(inner).cos(), f64::from(outer).cos());
            ((-way.dot(light.direction) - outer) / (inner - outer).max(1e-4)).clamp(0.0, 1.0)
        }
        _ => 1.0,
    };
    facing(normal.dot(way)) * window * window * cone * cone / distance_squared
}
