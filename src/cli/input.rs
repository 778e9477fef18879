//! Which settings can be drawn at all, and what is said of those that cannot.

use glam::DVec3;
use thiserror::Error;

use super::{counting, csg, dissolve, halo, lighting, mirrors, planar, playground};
use crate::scene::{AnimationChoice, LightKind, Scene};
use crate::settings::{CameraChoice, LightEdit, MAX_SIZE, Settings, SlideChoice};

/// Coordinates beyond this are taken for mistakes: at a million kilometres a metre is less than
/// single precision, which the GPU works in, can tell apart.
pub const MAX_COORDINATE: f64 = 1e9;

/// Stops, either way, beyond which a picture is black or white whatever it shows.
pub const MAX_EXPOSURE: f32 = 32.0;

/// Arguments that read well but name nothing, or lie out of range: one line each.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum InputError {
    /// No such technique or show.
    #[error("no {kind} `{name}`; there are: {known}")]
    Unknown {
        /// What was looked for.
        kind: &'static str,
        /// What was said.
        name: String,
        /// What there is.
        known: String,
    },
    /// Neither a stock scene nor a file.
    #[error("no scene or file `{name}`; stock scenes are: {known}")]
    NoScene {
        /// What was said.
        name: String,
        /// The stock scenes.
        known: String,
    },
    /// A scene, or several, where there is room for none, or for one.
    #[error("the sweep over {sweep} {takes}")]
    SweepScene {
        /// Over what.
        sweep: &'static str,
        /// What it does with scenes.
        takes: &'static str,
    },
    /// A board of the playground that cannot be read or drawn.
    #[error("board {name}: {why}")]
    Board {
        /// Which.
        name: String,
        /// What is wrong with it.
        why: String,
    },
    /// Nothing where a name should be.
    #[error("{0} is empty")]
    Empty(&'static str),
    /// A picture nobody can draw.
    #[error("a picture of {0}x{1} pixels is not possible: each side must be 1 to {MAX_SIZE}")]
    Size(u32, u32),
    /// Not a count of samples that devices have.
    #[error("{0} samples a pixel are not possible: 1 or 4")]
    Samples(u32),
    /// A whole number that is too small or too large.
    #[error("{what} must be {least} to {most}, not {value}")]
    Range {
        /// Whose number.
        what: &'static str,
        /// What it was.
        value: u32,
        /// The smallest allowed.
        least: u32,
        /// The largest allowed.
        most: u32,
    },
    /// A number that is negative, too large, or none.
    #[error("{what} must be 0 to {most}, not {value}")]
    Within {
        /// Whose number.
        what: &'static str,
        /// What it was.
        value: f64,
        /// The largest allowed.
        most: f64,
    },
    /// Something that this kind of light has not.
    #[error("light {light} {what}")]
    LightKind {
        /// Its index.
        light: usize,
        /// Why it cannot have what was asked for.
        what: &'static str,
    },
    /// NaN, infinite, or past all bounds.
    #[error("{what} must be a finite number{}, not {value}", limit(*.bound))]
    Number {
        /// Whose number.
        what: String,
        /// What it was.
        value: f64,
        /// The largest magnitude allowed, where there is one.
        bound: Option<f64>,
    },
    /// Below what it may be.
    #[error("{what} must not be {}, not {value}", if *.zero { "negative or zero" } else { "negative" })]
    Negative {
        /// Whose number.
        what: String,
        /// What it was.
        value: f64,
        /// Zero is too little as well.
        zero: bool,
    },
    /// Nowhere to look.
    #[error("the camera's eye and target are the same point: {0}, {1}, {2}")]
    EyeIsTarget(f64, f64, f64),
    /// Not an angle a picture can have.
    #[error("the field of view must lie between 0 and 180 degrees, not {0}")]
    FieldOfView(f64),
    /// Not a distance a far plane can have.
    #[error("the far plane must lie at a finite distance above 0, not {0}")]
    Far(f64),
    /// The scene has no such thing.
    #[error("no {kind} {index} in this scene: it has {count}{}", counted(*.count))]
    Index {
        /// A light, an animation.
        kind: &'static str,
        /// What was asked for, from 0.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// Solids are to be put together, but which?
    #[error("nothing says which solids to put together here: --csg-a NODE and --csg-b NODE do")]
    NoOperands,
    /// Something that can be no operand.
    #[error("node {node} cannot be {letter}: {why}")]
    Operand {
        /// A or B.
        letter: char,
        /// The node, from 0.
        node: usize,
        /// One sentence.
        why: String,
    },
    /// The scene has no such surface.
    #[error("node {node} of this scene shows no primitive {primitive}")]
    Surface {
        /// The node, from 0.
        node: usize,
        /// The primitive of its mesh, from 0.
        primitive: usize,
    },
}

fn limit(bound: Option<f64>) -> String {
    bound.map(|bound| format!(" between -{bound} and {bound}")).unwrap_or_default()
}

fn counted(count: usize) -> &'static str {
    if count == 0 { "" } else { ", counted from 0" }
}

/// Says whether `settings` can be drawn on some scene.
///
/// # Errors
/// The first thing that cannot be.
pub fn check(settings: &Settings) -> Result<(), InputError> {
    let [width, height] = settings.size;
    if !(1..=MAX_SIZE).contains(&width) || !(1..=MAX_SIZE).contains(&height) {
        return Err(InputError::Size(width, height));
    }
    if !matches!(settings.samples, 1 | 4) {
        return Err(InputError::Samples(settings.samples));
    }
    if let CameraChoice::Free { eye, target } = settings.camera {
        place("the camera's eye", eye)?;
        place("the camera's target", target)?;
        if eye == target {
            return Err(InputError::EyeIsTarget(eye.x, eye.y, eye.z));
        }
    }
    if let Some(degrees) = settings.fov
        && !(degrees > 0.0 && degrees < 180.0)
    {
        return Err(InputError::FieldOfView(degrees));
    }
    if let Some(metres) = settings.far
        && !(metres > 0.0 && metres.is_finite())
    {
        return Err(InputError::Far(metres));
    }
    at_least_zero("the time", settings.time)?;
    bounded("the exposure", f64::from(settings.exposure), Some(f64::from(MAX_EXPOSURE)))?;
    settings.lights.iter().try_for_each(|(light, edit)| check_light(*light, edit))?;
    counting::check(&settings.counting)?;
    lighting::check(&settings.lighting)?;
    playground::check(&settings.playground.board)?;
    halo::check(&settings.halos)?;
    dissolve::check(&settings.dissolve)?;
    mirrors::check(&settings.mirrors)
}

fn check_light(light: usize, edit: &LightEdit) -> Result<(), InputError> {
    let of = |what: &str| format!("light {light}'s {what}");
    if let Some(position) = edit.position {
        place(&of("position"), position)?;
    }
    if let Some(color) = edit.color {
        color.to_array().into_iter().try_for_each(|part| at_least_zero(&of("color"), f64::from(part)))?;
    }
    if let Some(intensity) = edit.intensity {
        at_least_zero(&of("intensity"), f64::from(intensity))?;
    }
    if let Some(radius) = edit.radius {
        at_least_zero(&of("radius"), f64::from(radius))?;
    }
    // An infinite range is what glTF's lights have by default.
    match edit.range {
        Some(range) if range.is_nan() => bounded(&of("range"), f64::from(range), None),
        Some(range) if range <= 0.0 => Err(InputError::Negative { what: of("range"), value: f64::from(range), zero: true }),
        _ => Ok(()),
    }
}

fn place(what: &str, point: DVec3) -> Result<(), InputError> {
    point.to_array().into_iter().try_for_each(|part| bounded(what, part, Some(MAX_COORDINATE)))
}

/// From 0 to `most`.
pub(super) fn within(what: &'static str, value: f32, most: f32) -> Result<(), InputError> {
    if (0.0..=most).contains(&value) { Ok(()) } else { Err(InputError::Within { what, value: value.into(), most: most.into() }) }
}

fn bounded(what: &str, value: f64, bound: Option<f64>) -> Result<(), InputError> {
    if value.is_finite() && bound.is_none_or(|bound| value.abs() <= bound) {
        return Ok(());
    }
    Err(InputError::Number { what: what.into(), value, bound })
}

pub(super) fn at_least_zero(what: &str, value: f64) -> Result<(), InputError> {
    bounded(what, value, None)?;
    if value < 0.0 {
        return Err(InputError::Negative { what: what.into(), value, zero: false });
    }
    Ok(())
}

/// Says whether `scene` has the lights, animations and surfaces that `settings` speak of.
///
/// # Errors
/// The first that is not there.
pub fn check_against(settings: &Settings, scene: &Scene) -> Result<(), InputError> {
    let (count, edited) = (scene.lights.len(), settings.lights.keys().next_back().copied());
    if let Some(index) = edited.filter(|index| *index >= count) {
        return Err(InputError::Index { kind: "light", index, count });
    }
    // Light 0 is what is looked at when nobody chose one, also where there is none.
    let (index, count) = (settings.light, scene.lights_in_force(&settings.mirrors));
    if index >= count && index > 0 {
        return Err(InputError::Index { kind: "light", index, count });
    }
    for (&light, edit) in &settings.lights {
        let refused = |what| Err(InputError::LightKind { light, what });
        match scene.lights[light].kind {
            LightKind::Directional if edit.radius.is_some_and(|radius| radius > 0.0) => {
                return refused("is directional: it has no radius");
            }
            LightKind::Point | LightKind::Directional if edit.slide.is_some_and(|slide| slide != SlideChoice::None) => {
                return refused("is no spot: only spots project slides");
            }
            _ => {}
        }
    }
    if let Some(AnimationChoice::One(index)) = settings.animation
        && index >= scene.animations.len()
    {
        return Err(InputError::Index { kind: "animation", index, count: scene.animations.len() });
    }
    halo::check_against(&settings.halos, scene)?;
    csg::check_against(&settings.csg, scene)?;
    mirrors::check_against(&settings.mirrors, scene)?;
    planar::check_against(&settings.planar, scene)
}
