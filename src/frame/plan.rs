//! The frame as one value.

use glam::{DAffine3, DVec4, Vec4};
use serde::Serialize;

use super::camera::Camera;
use super::state::Winding;
use super::stencil::{BitBudget, StencilState};
use super::step::{Action, Draw, DrawSet, Part, Step, Surface};
use super::validate::Rule;
use crate::geometry::cutout::{CutoutPlane, Throw};
use crate::geometry::planar::reflection;
use crate::geometry::volume::Outline;
use crate::geometry::{Enclosure, Flaw, LitPlane, VolumeParts};
use crate::settings::{Accumulation, Backend};

/// Everything that one frame does, in order: ids and values only.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct FramePlan {
    /// Pixels.
    pub size: [u32; 2],
    /// Per pixel.
    pub samples: u32,
    /// Multiplies linear colour before the tone curve.
    pub exposure: f32,
    /// The terminator bound is in force.
    pub smooth_terminator: bool,
    /// Who owns which stencil bits.
    pub budget: BitBudget,
    /// The eye's, and then one for each mirror path, each after the view it is seen in.
    pub views: Vec<View>,
    /// How each caster's volume is counted for each light, and why.
    pub volumes: Vec<VolumePlan>,
    /// What is done, in order.
    pub steps: Vec<Step>,
    /// What lights are added into.
    pub accumulation: Accumulation,
    /// Which of the frames whose mean is shown this is; none where a frame stands for itself.
    pub gather: Option<Gather>,
    /// For every light of the pose, the light of the scene that it is, or is a point of
    /// ([`crate::scene::area`]).
    pub points: Vec<usize>,
    /// What there is to reflect.
    pub reflections: Reflections,
    /// What a user should know about this frame: replacements, limits.
    pub notes: Vec<String>,
    /// The one rule of [`super::validate`] that this frame breaks, where it is spoiled on purpose
    /// ([`crate::failures`]).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub breaks: Option<Rule>,
    /// A frame of the scene's partner that is drawn after this one, which then ends in a texture: the picture is made of both.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub then: Option<Box<FramePlan>>,
}

impl FramePlan {
    /// This frame, and the one that is drawn after it.
    pub fn pictures(&self) -> impl Iterator<Item = &Self> {
        std::iter::successors(Some(self), |plan| plan.then.as_deref())
    }

    /// No frame, with room for one like this.
    #[must_use]
    pub fn emptied(self) -> Self {
        let Self { mut views, mut volumes, mut steps, mut points, mut notes, .. } = self;
        views.clear();
        volumes.clear();
        steps.clear();
        points.clear();
        notes.clear();
        Self { views, volumes, steps, points, notes, ..Self::default() }
    }
}

/// One of several frames whose mean is shown. Drawn again, it leaves the same mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Gather {
    /// Which, from 0: the mean is that of this one and all before it.
    pub frame: u32,
    /// How many there will be.
    pub frames: u32,
}

impl Gather {
    /// The frame after this one, until all are there.
    #[must_use]
    pub fn next(self) -> Option<u32> {
        (self.frame + 1 < self.frames).then_some(self.frame + 1)
    }
}

/// Mirrors, and the views that were planned for them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Reflections {
    /// Mirrors in force, seen or not.
    pub mirrors: usize,
    /// How often a ray is reflected at most.
    pub bounces: u32,
    /// How many views there would be if every mirror showed in every other (K section 3), the eye's own among them.
    pub worst_case: u64,
    /// Views that were left out for being too small.
    pub too_small: usize,
    /// Lights off mirrors that reach something in some view.
    pub lights: usize,
    /// Linear radiance that mirrors add to ambient light.
    pub ambient: [f32; 3],
}

/// One eye: the camera's own, or that eye reflected in the mirrors of a path.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct View {
    /// Words: `eye`, and the names of the mirrors on the way.
    pub name: String,
    /// Where it looks from.
    pub camera: Camera,
    /// The front's winding on screen for instances that do not mirror.
    pub winding: Winding,
    /// The pixels it may have.
    pub rect: [u32; 4],
    /// Pixels: of the picture it is drawn as, which fills the left upper part of the targets. Smaller than the frame's for
    /// a view that goes into a texture.
    pub picture: [u32; 2],
    /// Which of the frame's textures keeps it, where one does.
    pub texture: Option<usize>,
    /// What it looks through; none for the eye itself.
    pub through: Option<Window>,
}

/// The mirror that a view looks through.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Window {
    /// The view that the mirror is seen in: an index into the plan's views.
    pub parent: usize,
    /// The mirrors that a ray from the eye meets on its way, in order: indices into the mirrors in force
    /// ([`crate::scene::Scene::mirrors_in_force`]).
    pub path: Vec<usize>,
    /// The last mirror's surface.
    pub surface: Surface,
    /// Where what is seen begins: the mirror's surface, or of a portal the other doorway's.
    pub exit: Surface,
    /// The plane of that, world space, unit normal to the side that is seen: nothing under it is.
    pub plane: DVec4,
    /// Takes the eye before the mirror to the one that looks through: a reflection, or a portal's rigid transform.
    pub turn: DAffine3,
    /// Metres over the plane up to which nothing is seen, either: what lies in it is no reflection.
    pub slack: f64,
    /// Its pixels' value in the stencil's mirror bits.
    pub level: u8,
}

impl Window {
    /// The plane under which nothing is drawn: the mirror's, raised by the slack.
    #[must_use]
    pub fn clip_plane(&self) -> Vec4 {
        (self.plane - DVec4::W * self.slack).as_vec4()
    }
}

impl View {
    /// The eye's own, of the whole picture.
    #[must_use]
    pub fn of_eye(name: &str, camera: Camera, size: [u32; 2]) -> Self {
        Self {
            name: name.into(),
            camera,
            winding: Winding::Ccw,
            rect: [0, 0, size[0], size[1]],
            picture: size,
            texture: None,
            through: None,
        }
    }

    /// The mirrors on the way from the eye; none for the eye's own.
    #[must_use]
    pub fn path(&self) -> &[usize] {
        self.through.as_ref().map_or(&[], |window| &window.path)
    }

    /// Its pixels' value in the stencil's mirror bits.
    #[must_use]
    pub fn level(&self) -> u8 {
        self.through.as_ref().map_or(0, |window| window.level)
    }
}

/// One caster's volume for one light in one view.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VolumePlan {
    /// The view it is counted in: an index into the plan's views.
    pub view: usize,
    /// The caster, as [`crate::scene::Scene::instances`] counts them.
    pub instance: usize,
    /// An index into the scene's lights.
    pub light: usize,
    /// How it is counted.
    pub method: Method,
    /// Why so.
    pub reason: Reason,
    /// M's case; none where nothing is drawn.
    pub case: Option<Case>,
    /// The parts that may be on screen: others are not drawn, whatever the method asks for.
    pub parts: VolumeParts,
    /// The pixels (x, y, width, height from the top left) where it may hold a surface that matters.
    pub rect: [u32; 4],
    /// The cells of the picture where it may do so ([`crate::geometry::pixels::Grid`]).
    #[serde(skip)]
    pub cells: u64,
    /// How many of this caster's volumes hold the eye, where the method needs to know.
    pub holds_eye: i32,
    /// What has sides: the caster's silhouette, or each of its polygons.
    pub outline: Outline,
    /// Metres from the light to its far end, where that is no plane: Beam's finite volumes.
    pub extrusion: Option<f64>,
    /// The plane it ends on, world space, outward normal and offset; none where it goes to infinity.
    pub end: Option<DVec4>,
    /// The plane it starts on, where it is a piece of a clamped volume ([`crate::geometry::clamping`]) that does not start at
    /// its caster: likewise, its normal away from the light.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start: Option<DVec4>,
    /// Surfaces may lie beyond its end: it has a cap there.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub closed: bool,
    /// Which part of its caster throws it.
    #[serde(skip_serializing_if = "Piece::is_whole")]
    pub piece: Piece,
    /// The plane, in world space, that its caster is reflected in: it is thrown by the reflection.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reflected: Option<DVec4>,
    /// What its volume is thrown from, where that is not the caster's own silhouette.
    pub cutout: Option<Cutout>,
    /// Whether some of its triangles may have to be turned to face the light: an open caster's.
    pub turns: bool,
    /// The front's winding on screen.
    pub winding: Winding,
    /// What the caster itself is thrown onto, where that is done instead of counting a volume.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub projection: Option<Projection>,
    /// What finds its caster's silhouette.
    #[serde(skip_serializing_if = "Backend::is_cpu")]
    pub silhouette: Backend,
    /// How it is built wrongly, where it is so on purpose.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flaw: Option<Flaw>,
}

impl VolumePlan {
    /// Where its caster is, or is reflected to, given where it is.
    #[must_use]
    pub fn placed(&self, world_from_object: &DAffine3) -> DAffine3 {
        self.reflected.map_or(*world_from_object, |plane| reflection(plane) * *world_from_object)
    }

    /// Whether a part need be drawn. Z-fail counts what is on screen and behind the surface; other
    /// methods know themselves what they draw.
    #[must_use]
    pub const fn shows(&self, part: Part) -> bool {
        if self.cutout.is_some() || self.extrusion.is_some() || !self.method.is_z_fail() {
            return true;
        }
        match part {
            Part::Sides | Part::SidesTurned => self.parts.sides,
            Part::LightCapKept | Part::LightCapTurned => self.parts.light_cap,
            Part::DarkCap => self.parts.dark_cap,
            Part::StartCap | Part::EndCap => true,
        }
    }

    /// Whether it has such a part at all: a piece of a clamped volume has caps of its own.
    #[must_use]
    pub const fn has(&self, part: Part) -> bool {
        match part {
            Part::Sides | Part::SidesTurned => true,
            Part::LightCapKept => self.start.is_none(),
            Part::LightCapTurned => self.start.is_none() && self.turns,
            Part::DarkCap => !self.closed,
            Part::StartCap => self.start.is_some(),
            Part::EndCap => self.closed,
        }
    }

    /// The pixels where it must be counted, of those that are its light's. Where the stencil starts
    /// with this volume counted, all of them: elsewhere nothing would take it away again.
    #[must_use]
    pub const fn scissor(&self, of_light: [u32; 4]) -> [u32; 4] {
        if self.adds_nothing_elsewhere() { self.rect } else { of_light }
    }

    /// Whether its count is zero wherever it holds no surface, so that it need not be counted there.
    #[must_use]
    pub const fn adds_nothing_elsewhere(&self) -> bool {
        let of_method = match self.method {
            Method::ZPass | Method::ZFail | Method::ZFailCompared | Method::ZFailCut => true,
            Method::ExactZPass => self.holds_eye == 0,
            _ => false,
        };
        self.cutout.is_none() && self.extrusion.is_none() && of_method
    }
}

/// Which part of a caster throws a volume.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Piece {
    /// All of it.
    #[default]
    Whole,
    /// What lies before a plane of world space, higher than `slack` metres.
    Before {
        /// Unit normal and offset.
        plane: DVec4,
        /// Metres.
        slack: f64,
    },
    /// One of its mesh's primitives, whether that casts shadows or not: a mirror, whose volume is the beam of light off it.
    Primitive(usize),
}

impl Piece {
    /// Whether it is all of the caster.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        *self == Self::Whole
    }
}

/// A planar shadow: a caster's light cap, thrown onto the plane of a receiver (K section 4).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Projection {
    /// Which takes it.
    pub receiver: Surface,
    /// Its plane, before the light and the view's eye.
    pub onto: LitPlane,
    /// Some of the caster's triangles are behind the plane, or in it: they are cut on it, or left out.
    pub cut: bool,
}

/// M's three cases (M section 7, figure 4), by the caster's box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Case {
    /// It throws no shadow on the near rectangle, or on the way there from the eye.
    One,
    /// It may throw a shadow there, and is itself out of view.
    Two,
    /// It may throw a shadow there, and is itself in view.
    Three,
}

impl Case {
    /// 1, 2 or 3.
    #[must_use]
    pub const fn number(self) -> u8 {
        match self {
            Self::One => 1,
            Self::Two => 2,
            Self::Three => 3,
        }
    }

    /// One sentence for people.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::One => "it throws no shadow on the near rectangle: sides alone will do",
            Self::Two => "it may shade the near rectangle, and is out of view: sides and dark cap",
            Self::Three => "it may shade the near rectangle, and is in view: sides and both caps",
        }
    }
}

/// A cut-out that a volume is thrown from, in the caster's object space.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Cutout {
    /// Where it comes from.
    pub shape: CutoutShape,
    /// On which it lies.
    pub plane: CutoutPlane,
    /// How its far copy is made.
    pub throw: Throw,
}

/// Where a cut-out comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum CutoutShape {
    /// The caster lies on one plane: it is the cut-out itself.
    Planar,
    /// The caster's silhouette, flattened onto a plane behind it.
    Flattened,
}

/// How a volume is counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Sides, clipped at the near plane.
    ZPass,
    /// Sides, clipped at the near plane, whose count is drawn first, seen from the light.
    ZPlus,
    /// The same, for a light on the far side of the near plane.
    ZPlusMirrored,
    /// Sides under depth clamp, from the eye's own count.
    ExactZPass,
    /// Sides, dark cap, light cap that depth can never hide from.
    ZFail,
    /// The same, the light cap compared with depth.
    ZFailCompared,
    /// The same of a caster that was cut: the light cap lies a hair behind the surface that is drawn, which was not.
    ZFailCut,
    /// No volume: the light cap thrown onto a receiver.
    Projected,
    /// Nothing is drawn.
    Dropped,
}

impl Method {
    /// Sides and both caps, counted behind the surface.
    #[must_use]
    pub const fn is_z_fail(self) -> bool {
        matches!(self, Self::ZFail | Self::ZFailCompared | Self::ZFailCut)
    }

    /// A word or two for people.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::ZPass => "z-pass",
            Self::ExactZPass => "exact z-pass",
            Self::ZFail => "z-fail",
            Self::ZFailCompared => "z-fail, compared",
            Self::ZFailCut => "z-fail, cut",
            Self::ZPlus => "ZP+",
            Self::ZPlusMirrored => "ZP+, mirrored",
            Self::Projected => "planar shadow",
            Self::Dropped => "left out",
        }
    }
}

/// Why a volume is counted as it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reason {
    /// The technique does it so for every caster.
    Technique,
    /// The caster's own surface is surely in the depth buffer.
    SurfaceCovers,
    /// The caster reaches into the pyramid between the eye and the near rectangle, or holds the eye.
    AcrossNearPlane,
    /// Its surface may be missing from the depth buffer where the light sees it: culled from
    /// behind, alpha-masked or blended.
    SurfaceMayBeMissing,
    /// The eye lies so near the volume's boundary that its count would be a guess.
    EyeOnBoundary,
    /// The device has no depth clamp.
    NoDepthClamp,
    /// The caster may throw its shadow on the near rectangle.
    OverNearRectangle,
    /// None of the caster lies between the light and the near rectangle.
    NearRectangleClear,
    /// The light stands on the near plane, or shines along it.
    LightOnNearPlane,
    /// The caster lies wholly beyond the light's range.
    OutOfRange,
    /// All of the caster lies on one plane: its outline is thrown by one matrix.
    Planar,
    /// The caster does not lie on one plane.
    NotPlanar,
    /// The light looks along the cut-out's plane, or nearly.
    LightInPlane,
    /// The caster's silhouette was flattened into a cut-out.
    Flattened,
    /// The light stands in the caster, or so near that it cannot be projected on one plane.
    LightTooNear,
    /// The caster lies wholly outside the light's cone.
    OutOfCone,
    /// The volume lies wholly out of view.
    OutOfView,
    /// The volume holds no surface that is lit and in view.
    ReachesNothing,
    /// The caster throws no shadow on the near rectangle.
    NearPlaneClear,
    /// It is the outline of a mirror, beyond which its light shines.
    Beam,
    /// The caster stands in the light's way to the mirror: its reflection stands in the way of the reflected light.
    BeforeMirror,
    /// All of it lies on the light's side of the receiver.
    OverReceiver,
    /// The receiver's plane cuts it, or it lies in that plane in part.
    AcrossReceiver,
    /// It lies behind the receiver, or in its plane.
    BehindReceiver,
    /// It lies beyond the light.
    BeyondLight,
    /// The light lies in the receiver's plane.
    LightInReceiver,
}

impl Reason {
    /// One sentence for people.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Technique => "the technique counts every caster so",
            Self::SurfaceCovers => "the caster's own surface is surely in the depth buffer",
            Self::AcrossNearPlane => "the caster reaches between the eye and the near plane",
            Self::SurfaceMayBeMissing => "the caster's surface may be missing from the depth buffer",
            Self::EyeOnBoundary => "the eye lies on the volume's boundary",
            Self::NoDepthClamp => "the device has no depth clamp",
            Self::OverNearRectangle => "the caster may throw its shadow on the near rectangle",
            Self::NearRectangleClear => "nothing of the caster lies between the light and the near rectangle",
            Self::LightOnNearPlane => "the light stands on the near plane",
            Self::OutOfRange => "the caster lies beyond the light's range",
            Self::Planar => "the caster is a planar cut-out, thrown by one matrix",
            Self::NotPlanar => "the caster is no planar cut-out",
            Self::LightInPlane => "the light looks along the cut-out's plane",
            Self::Flattened => "the caster was flattened into a cut-out",
            Self::LightTooNear => "the light is too near to flatten the caster",
            Self::OutOfCone => "the caster lies outside the light's cone",
            Self::OutOfView => "its shadow is out of view",
            Self::ReachesNothing => "its shadow meets no surface that is lit and in view",
            Self::NearPlaneClear => "it throws no shadow on the near plane",
            Self::Beam => "the mirror's outline bounds the light that comes off it",
            Self::BeforeMirror => "the caster stands in the light's way to the mirror",
            Self::OverReceiver => "the caster lies on the light's side of the receiver",
            Self::AcrossReceiver => "the receiver's plane cuts the caster",
            Self::BehindReceiver => "the caster lies behind the receiver, or in its plane",
            Self::BeyondLight => "the caster lies beyond the light",
            Self::LightInReceiver => "the light lies in the receiver's plane",
        }
    }
}

impl FramePlan {
    /// Who owns which stencil bits, the verdict's included where some light is counted in batches.
    #[must_use]
    pub fn bits_in_use(&self) -> BitBudget {
        let batched = self.budget.batched();
        let collapse = StencilState::collapse(batched);
        let verdict = |draw: &Draw| draw.state.stencil == collapse;
        if self.draws().any(|(_, draw)| verdict(draw)) { batched } else { self.budget }
    }

    /// The volumes, each with its pieces: a caster's in one light and view is one however it is cut.
    pub fn casters(&self) -> impl Iterator<Item = &[VolumePlan]> {
        let of = |volume: &VolumePlan| (volume.view, volume.instance, volume.light);
        self.volumes.chunk_by(move |a, b| a.closed && b.start.is_some() && of(a) == of(b))
    }

    /// What bounds a light in depth, where that is marked in the stencil.
    #[must_use]
    pub fn depth_bounds(&self, light: usize) -> Option<&Enclosure> {
        self.draws().find_map(|(_, draw)| match &draw.set {
            DrawSet::Enclosure(solid) if draw.light == Some(light) => Some(solid),
            _ => None,
        })
    }

    /// The view that is kept in a texture for the one mirror that a draw of `view` draws.
    #[must_use]
    pub fn kept_behind(&self, view: usize, draw: &Draw) -> Option<usize> {
        let DrawSet::Surfaces(surfaces) = &draw.set else { return None };
        let behind = |of: &View| {
            let window = of.through.as_ref();
            window.is_some_and(|window| window.parent == view && **surfaces == [window.surface])
        };
        self.views.iter().position(|of| of.texture.is_some() && behind(of))
    }

    /// The draws, in order, with their steps.
    pub fn draws(&self) -> impl Iterator<Item = (&Step, &Draw)> {
        self.steps.iter().filter_map(|step| match &step.action {
            Action::Draw(draw) => Some((step, &**draw)),
            Action::Clear(_) | Action::Keep => None,
        })
    }
}
