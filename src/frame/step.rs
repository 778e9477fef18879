//! One entry of the plan: a draw, or a clear, with everything it needs said in ids and values.

use serde::Serialize;

use super::lists::List;
use super::state::State;
use crate::geometry::Enclosure;
use crate::scene::{LightKind, PosedLight};

/// One entry of the plan, carried out in order.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Step {
    /// A few words, for lists and debug markers.
    pub label: String,
    /// One sentence: what it is for.
    pub why: String,
    /// Which view it draws, an index into the plan's views.
    pub view: usize,
    /// What it does.
    pub action: Action,
}

impl Step {
    /// A draw for the eye's view; `why` is one sentence.
    #[must_use]
    pub fn drawing(label: impl Into<String>, why: impl Into<String>, draw: Draw) -> Self {
        Self { label: label.into(), why: why.into(), view: 0, action: Action::Draw(Box::new(draw)) }
    }

    /// The pixels it draws in; `None` where it clears.
    #[must_use]
    pub fn scissor(&self) -> Option<[u32; 4]> {
        match &self.action {
            Action::Draw(draw) => Some(draw.scissor),
            Action::Clear(_) | Action::Keep => None,
        }
    }
}

/// What a step does.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Action {
    /// Sets attachments to fixed values; begins a new render pass.
    Clear(Clear),
    /// Draws.
    Draw(Box<Draw>),
    /// Keeps the view's picture in its texture, as far as it is drawn.
    Keep,
}

/// What an attachment clear sets; `None` leaves the attachment as it is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Clear {
    /// Linear RGBA.
    pub color: Option<[f32; 4]>,
    /// Reverse-Z: 0 is infinity.
    pub depth: Option<f32>,
    /// All eight bits: an attachment clear knows no mask.
    pub stencil: Option<u8>,
    /// Of [`Target::Counts`].
    pub counts: Option<f32>,
}

impl Action {
    /// The same, what is drawn to [`Target::Scene`] drawn to another target.
    #[must_use]
    pub fn onto(mut self, target: Target) -> Self {
        if let Self::Draw(draw) = &mut self
            && draw.target == Target::Scene
        {
            draw.target = target;
        }
        self
    }
}

/// A draw: program, state, and what is drawn.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Draw {
    /// Which shaders.
    pub program: Program,
    /// What of those shaders is needed.
    pub look: Look,
    /// Where it draws to.
    pub target: Target,
    /// The whole fixed state.
    pub state: State,
    /// Compared with the stencil's masked value.
    pub stencil_reference: u8,
    /// Pixels: x, y, width, height from the top left; not empty, inside the picture.
    pub scissor: [u32; 4],
    /// The light the shaders look at, an index into the scene's lights.
    pub light: Option<usize>,
    /// Linear RGBA that programs without a light of their own draw with.
    pub constant: [f32; 4],
    /// What is drawn.
    pub set: DrawSet,
}

impl Draw {
    /// A draw into the scene by [`State::FLAT`], of no light and no colour: what it has besides is said over it.
    #[must_use]
    pub fn plain(program: Program, set: DrawSet, scissor: [u32; 4]) -> Self {
        Self {
            program,
            look: Look::default(),
            target: Target::Scene,
            state: State::FLAT,
            stencil_reference: 0,
            scissor,
            light: None,
            constant: [0.0; 4],
            set,
        }
    }
}

/// What a step's surfaces and light have, so that pixels pay for nothing else: the shaders are
/// specialised for it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
pub struct Look {
    /// Some material has a texture.
    pub textured: bool,
    /// Some material has a highlight.
    pub glossy: bool,
    /// The shape of the light.
    pub light: LightShape,
    /// The colour is the picture's: ambient light is in it, exposure and tone curve are done.
    pub finished: bool,
    /// Fragments under the view's clip plane are left out.
    pub clipped: bool,
    /// How the surface reflects.
    pub mirror: MirrorLook,
    /// Triangles are seen from behind alone: the surface is the inside of another solid.
    pub inside: bool,
    /// What is shaded pixel by pixel.
    pub shade: Shade,
}

/// Of [`Program::Shade`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
pub struct Shade {
    /// The shapes of its lights; the step's constant has their numbers.
    pub lights: [Option<LightShape>; SHADED_TOGETHER],
    /// Each light is asked for its bit in [`Target::Dark`]; else the stencil says where they shine, or all shine everywhere.
    pub each: bool,
    /// Some material has more than its base colour: it is read pixel by pixel.
    pub materials: bool,
}

/// As many lights are shaded by one step at most.
pub const SHADED_TOGETHER: usize = 4;

/// How a surface reflects, without its numbers.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum MirrorLook {
    /// It does not.
    #[default]
    None,
    /// The same from everywhere.
    Even,
    /// The more, the more obliquely it is seen.
    Fresnel,
}

/// The shape of a light, without its numbers.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LightShape {
    /// From one point.
    #[default]
    Point,
    /// From infinitely far away.
    Directional,
    /// A cone.
    Spot,
    /// A cone with a picture in it.
    Projector,
}

impl From<&PosedLight> for LightShape {
    fn from(light: &PosedLight) -> Self {
        match light.kind {
            LightKind::Point => Self::Point,
            LightKind::Directional => Self::Directional,
            LightKind::Spot { .. } if light.slide.is_some() => Self::Projector,
            LightKind::Spot { .. } => Self::Spot,
        }
    }
}

/// Where a step draws to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Target {
    /// The linear accumulation target, with depth and stencil.
    Scene,
    /// The mean of the frames gathered so far, in 32-bit floats; the scene's targets are read.
    Mean,
    /// The picture itself; the scene's targets are read, or the mean in their place.
    Output,
    /// The picture itself, under the scene's depth and stencil: for frames that need no accumulation.
    Direct,
    /// One number a sample that counts beyond the stencil, under the scene's depth.
    Counts,
    /// Depth and stencil of one layer of two solids put together ([`crate::techniques::csg`]), apart from the scene's.
    Solid,
    /// What light needs to know of each pixel's surface, beside the scene's depth ([`crate::techniques::deferred`]).
    Geometry,
    /// A bit of each light, set where the surface is in its shadow; under the scene's depth and stencil. Zero at first.
    Dark,
    /// The picture itself, shaded from what [`Target::Geometry`] and [`Target::Dark`] hold; the scene's stencil is only read.
    Shaded,
}

/// Which shaders a step runs; [`crate::gpu::shaders`] says where each is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Program {
    /// Surfaces without colour, for their depth.
    Depth,
    /// The same, with fragments below the alpha cutoff left out.
    DepthMasked,
    /// Surfaces in ambient and emitted light.
    Ambient,
    /// The same, with fragments below the alpha cutoff left out.
    AmbientMasked,
    /// Surfaces in one light.
    Lit,
    /// Shadow volumes, no colour.
    Volume,
    /// The same by other arithmetic than the surfaces', on purpose ([`crate::failures`]).
    VolumeMismatched,
    /// Shadow volumes as coloured glass.
    VolumeGlass,
    /// Shadow volumes as numbers: the constant's red for back faces, its negative for front faces.
    VolumeNumbers,
    /// One light's verdict in plain values.
    Verdict,
    /// Blended surfaces in every light, unshadowed.
    Transparent,
    /// Triangle edges.
    Wireframe,
    /// Full screen: the scene joins the mean of the frames before it.
    Gather,
    /// Full screen: the stencil in false colour.
    StencilColors,
    /// Full screen: the gradient behind everything, exposure and tone curve.
    ToneMap,
    /// Full screen: the gradient alone, through the tone curve.
    Background,
    /// Full screen: display values as they are.
    Copy,
    /// Shadow volumes, no colour, faces seen from the front only.
    VolumeFronts,
    /// Shadow volumes, no colour, faces seen from behind only.
    VolumeBacks,
    /// Names on their plates.
    Labels,
    /// Surfaces' textures, without any light.
    Texture,
    /// Full screen, no colour: the stencil's operations alone.
    StencilOnly,
    /// Full screen, no colour, where [`Target::Counts`] is not zero.
    WideVerdict,
    /// The same, for every sample of several.
    WideVerdictEach,
    /// Full screen, no colour, where bit number red of [`Target::Counts`], at most green, is set.
    WideBit,
    /// Full screen: what a field of as many values as the constant's red makes of [`Target::Counts`].
    WideOverflow,
    /// Light caps on the near rectangle, seen from the light, no colour.
    NearPlane,
    /// Full screen, before the picture: one colour where the stencil lets it through.
    Dark,
    /// Surfaces in one colour, shaded by their slope alone.
    Tint,
    /// The same, with fragments below the alpha cutoff left out.
    TintMasked,
    /// A light's bounds, or a shape of the playground, no colour.
    Bounds,
    /// Lines and areas over the picture.
    Lines,
    /// A mirror's own look in ambient and emitted light, to be added to its reflection.
    Own,
    /// How much of the reflection behind it a mirror shows, to be multiplied with it.
    Reflected,
    /// Full screen, at infinity: the gradient behind everything, as light.
    Backdrop,
    /// A mirror's surface with the texture that keeps the view through it.
    Mirrored,
    /// Surfaces in the colour of their number ([`crate::frame::identity_color`]).
    Identity,
    /// Swollen surfaces in one colour.
    Halo,
    /// Full screen: the playground's stencil as colours and numbers.
    Playground,
    /// Full screen, depth alone: a layer of [`Target::Solid`] on the side of the other operand that the constant's red says.
    SolidMerge,
    /// The same, for every sample of several.
    SolidMergeEach,
    /// Light caps thrown onto a receiver, in the constant.
    Projected,
    /// Full screen, no colour: where a pattern has turned, the constant's red being which and its green how far.
    Pattern,
    /// Full screen: the picture that was kept of the eye's view, as it is.
    LayKept,
    /// Shadow volumes in the constant: their fill is counted so.
    VolumeFill,
    /// Surfaces into [`Target::Geometry`].
    Geometry,
    /// The same, with fragments below the alpha cutoff left out.
    GeometryMasked,
    /// Full screen: a light's bit, the constant's red, into [`Target::Dark`].
    MarkDark,
    /// Full screen, before infinity: some lights, ambient and emitted light on what [`Target::Geometry`] holds.
    Shade,
}

/// What a step draws, by number.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum DrawSet {
    /// Everything on screen.
    FullScreen,
    /// Mesh primitives.
    Surfaces(List<Surface>),
    /// Some triangles of mesh primitives.
    Runs(Vec<Run>),
    /// Mesh primitives, larger than they are.
    Swollen(Swollen),
    /// Parts of shadow volumes.
    Volumes(List<VolumePart>),
    /// A convex solid, both sides of it.
    Enclosure(Enclosure),
    /// Corners in clip space, three a triangle.
    Triangles(Vec<[f32; 4]>),
    /// All edges of these instances, numbered as [`Surface::instance`].
    Edges(Vec<usize>),
    /// Names over the finished picture.
    Labels(Vec<Label>),
    /// Lines and areas over the finished picture.
    Strokes(Vec<Stroke>),
}

/// Some triangles of a mesh primitive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Run {
    /// Of which.
    pub surface: Surface,
    /// From the first of these numbers to before the second.
    pub triangles: [u32; 2],
}

/// Mesh primitives whose vertices are moved outwards on screen ([`crate::geometry::outward`]).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Swollen {
    /// Which.
    pub surfaces: Vec<Surface>,
    /// By how many pixels.
    pub pixels: f32,
}

/// A line, or an area with its rim. Places and widths in pixels from the upper left; colours as the
/// picture stores them (sRGB), with alpha that is not multiplied into them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Stroke {
    /// In order.
    pub points: Vec<[f32; 2]>,
    /// The last point is joined to the first.
    pub closed: bool,
    /// Of the line.
    pub width: f32,
    /// Of the line.
    pub color: [f32; 4],
    /// Of the area, which must be convex and closed; none for lines.
    pub fill: Option<[f32; 4]>,
}

/// A name at its place in the picture. Places and sizes in pixels from the upper left.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Label {
    /// What is written.
    pub text: String,
    /// What is named.
    pub kind: LabelKind,
    /// Where that is.
    pub anchor: [f32; 2],
    /// The plate that bears the text: left, top, width, height.
    pub plate: [f32; 4],
    /// The size of the letters.
    pub text_size: f32,
}

/// What a name is the name of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LabelKind {
    /// A light.
    Light,
    /// The eye, seen from elsewhere.
    Eye,
    /// Something that casts shadows.
    Caster,
    /// A colour of a legend: the words alone, without plate or mark.
    Legend,
    /// A shape of the playground.
    Shape,
    /// Words of a diagram, on a plate without a mark.
    Note,
}

/// One primitive of one instance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Surface {
    /// As [`crate::scene::Scene::instances`] counts them.
    pub instance: usize,
    /// Of the instance's mesh.
    pub primitive: usize,
}

/// One part of one planned volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct VolumePart {
    /// An index into the plan's volumes.
    pub volume: usize,
    /// Which part of it.
    pub part: Part,
    /// The pixels of the draw's that it is drawn in; all where there are none given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window: Option<[u32; 4]>,
}

impl VolumePart {
    /// A part, all of it.
    #[must_use]
    pub const fn whole(volume: usize, part: Part) -> Self {
        Self { volume, part, window: None }
    }
}

/// The parts a shadow volume is drawn in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Part {
    /// Quads from silhouette edges to infinity (triangles, for directional lights).
    Sides,
    /// The sides of single polygons that their neighbours' sides cancel: in the neighbour's vertex
    /// order, so that both have the same depth to the last bit.
    SidesTurned,
    /// Light-facing triangles, in the surface's vertex order.
    LightCapKept,
    /// Triangles turned to face the light, in the surface's vertex order nonetheless.
    LightCapTurned,
    /// The cap at infinity, or on the plane behind everything.
    DarkCap,
    /// The cap that a piece of a clamped volume starts with.
    StartCap,
    /// The cap that it ends with, where surfaces may lie beyond.
    EndCap,
}
