//! Everything a user can choose, as plain data.
//!
//! The panel edits a [`Settings`], the command line fills one, tests build one; it knows neither
//! wgpu nor egui, and nothing flows back into it from the renderer.

pub mod boards;
mod complexity;
mod counting;
mod csg;
mod culling;
mod decals;
mod diagram;
mod dissolve;
mod halo;
mod lighting;
mod mirrors;
mod planar;
mod playground;
mod silhouettes;

pub use complexity::Complexity;
pub use counting::{Counting, MAX_COUNT_BITS, Overflow};
pub use csg::{Csg, Operation};
pub use culling::{Culling, LightBounds};
pub use decals::DecalMode;
pub use diagram::Diagram;
pub use dissolve::{Dissolve, Pattern};
pub use halo::{Halos, MAX_HALO_WIDTH};
pub use lighting::{Accumulation, AreaMode, Lighting, MAX_AREA_SAMPLES, MAX_FRAMES, Shading, Texturing};
pub use mirrors::{LEAST_TEXTURE, LastBounce, MAX_BOUNCES, MOST_TEXTURE, MirrorLight, MirrorMode, Mirrors, SurfacePlace, toggle};
pub use planar::{HybridPart, Planar, PlanarMode};
pub use silhouettes::Backend;

pub use playground::{Api, Board, Face, Facing, LONGEST_NAME, MOST_SHAPES, Playground, Shape, ShapeKind};

use std::collections::BTreeMap;
use std::path::PathBuf;

use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};

use crate::scene::{AnimationChoice, BuiltInSlide};

/// The whole choice: which scene, seen from where, drawn how.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// What is drawn.
    pub scene: SceneChoice,
    /// Adds a floor beneath a file's scene.
    pub floor: bool,
    /// How shadows are counted.
    pub technique: Technique,
    /// In how many bits, and what happens where they are too few.
    pub counting: Counting,
    /// What is shown of it.
    pub show: Show,
    /// The classic mistake that the frame makes on purpose.
    pub failure: Option<Failure>,
    /// The light that shows of one light look at ([`Show::looks_at_light`]).
    pub light: usize,
    /// Pixels: 1 to [`MAX_SIZE`] a side. The window's own size wins there.
    pub size: [u32; 2],
    /// Per pixel, 1 or 4.
    pub samples: u32,
    /// Where from.
    pub camera: CameraChoice,
    /// Full vertical angle, degrees, instead of the camera's own.
    pub fov: Option<f64>,
    /// Metres: the distance of a far plane that cuts surfaces and volumes off; none by default. The
    /// near plane is the nearest it may be.
    pub far: Option<f64>,
    /// Seconds into the animation.
    pub time: f64,
    /// Which animations play.
    pub animation: Option<AnimationChoice>,
    /// Diffuse light reaches zero before any facet turns away, so that smooth-shaded meshes show
    /// no faceted shadow edge at the terminator.
    pub smooth_terminator: bool,
    /// Stops added to the scene's own exposure.
    pub exposure: f32,
    /// What was changed of the scene's lights, by light index.
    pub lights: BTreeMap<usize, LightEdit>,
    /// How the frame's light comes together.
    pub lighting: Lighting,
    /// What is left out of counting shadows.
    pub culling: Culling,
    /// Where silhouettes are found.
    pub silhouettes: Backend,
    /// How coplanar geometry is drawn.
    pub decals: DecalMode,
    /// Whether the picture dissolves into another.
    pub dissolve: Dissolve,
    /// Shapes drawn into the stencil, and their states.
    pub playground: Playground,
    /// Which fragments depth complexity counts.
    pub complexity: Complexity,
    /// What is drawn into the scene from the side.
    pub diagram: Diagram,
    /// Which surfaces are mirrors, and how what is seen in them is drawn.
    pub mirrors: Mirrors,
    /// What glows.
    pub halos: Halos,
    /// Two solids put together.
    pub csg: Csg,
    /// Which surfaces take planar shadows, and how those are drawn.
    pub planar: Planar,
    /// Part of the name of the adapter to use.
    pub adapter: Option<String>,
    /// Shaders are read from here instead of the program, and again when they change.
    pub shaders: Option<PathBuf>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            scene: SceneChoice::default(),
            floor: false,
            technique: Technique::default(),
            counting: Counting::default(),
            show: Show::default(),
            failure: None,
            light: 0,
            size: [1280, 720],
            samples: 1,
            camera: CameraChoice::default(),
            fov: None,
            far: None,
            time: 0.0,
            animation: None,
            smooth_terminator: true,
            exposure: 0.0,
            lights: BTreeMap::new(),
            lighting: Lighting::default(),
            culling: Culling::default(),
            silhouettes: Backend::default(),
            decals: DecalMode::default(),
            dissolve: Dissolve::default(),
            playground: Playground::default(),
            complexity: Complexity::default(),
            diagram: Diagram::default(),
            mirrors: Mirrors::default(),
            halos: Halos::default(),
            csg: Csg::default(),
            planar: Planar::default(),
            adapter: None,
            shaders: None,
        }
    }
}

impl Settings {
    /// The same without what speaks of one scene's nodes, surfaces, lights and cameras: for another scene.
    #[must_use]
    pub fn of_another_scene(self, scene: SceneChoice) -> Self {
        Self {
            scene,
            technique: self.technique,
            show: self.show,
            size: self.size,
            samples: self.samples,
            smooth_terminator: self.smooth_terminator,
            lighting: self.lighting,
            counting: self.counting,
            decals: self.decals,
            dissolve: self.dissolve,
            playground: self.playground,
            complexity: self.complexity,
            diagram: self.diagram,
            culling: self.culling,
            silhouettes: self.silhouettes,
            mirrors: self.mirrors.of_another_scene(),
            halos: self.halos.of_another_scene(),
            csg: self.csg.of_another_scene(),
            planar: self.planar.of_another_scene(),
            adapter: self.adapter,
            shaders: self.shaders,
            ..Self::default()
        }
    }
}

/// The longest side of a picture, pixels: what every device of the last decade can draw into.
pub const MAX_SIZE: u32 = 8192;

/// Which scene.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SceneChoice {
    /// One of [`crate::scene::stock`], by name.
    Stock(String),
    /// A glTF or GLB file.
    File(PathBuf),
}

impl Default for SceneChoice {
    fn default() -> Self {
        Self::Stock("courtyard".into())
    }
}

/// Where the scene is seen from.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CameraChoice {
    /// The scene's first camera.
    #[default]
    First,
    /// By name, or by index where no camera has that name.
    Named(String),
    /// Anywhere.
    Free {
        /// Metres, world space.
        eye: DVec3,
        /// What is looked at, metres, world space; not the eye itself.
        target: DVec3,
    },
}

/// What was changed of one light.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LightEdit {
    /// World space metres; it then no longer follows its node.
    pub position: Option<DVec3>,
    /// Linear RGB.
    pub color: Option<Vec3>,
    /// Candela, or lux for directional lights.
    pub intensity: Option<f32>,
    /// Metres.
    pub range: Option<f32>,
    /// Shines at all.
    pub on: Option<bool>,
    /// Casts shadows.
    pub shadows: Option<bool>,
    /// Metres, instead of the light's own extent: a globe about a point light, a disc before a spot; 0 is a
    /// point. Directional lights have none.
    pub radius: Option<f32>,
    /// What a spot projects.
    pub slide: Option<SlideChoice>,
}

/// What a spot projects, instead of what the scene says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SlideChoice {
    /// Nothing: a plain cone of light.
    None,
    /// One that is built in.
    #[serde(untagged)]
    BuiltIn(BuiltInSlide),
}

impl SlideChoice {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 4] = [
        Self::None,
        Self::BuiltIn(BuiltInSlide::Window),
        Self::BuiltIn(BuiltInSlide::StainedGlass),
        Self::BuiltIn(BuiltInSlide::Grille),
    ];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::BuiltIn(slide) => slide.name(),
        }
    }
}

/// An enum of choices whose names stand in one place only: on the command line, in files and here.
macro_rules! named {
    ($(#[$about:meta])* $Choice:ident { $($(#[$doc:meta])* $variant:ident = $name:literal,)* }) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
        pub enum $Choice {
            $($(#[$doc])* #[serde(rename = $name)] $variant,)*
        }

        impl $Choice {
            /// Every one, in the order people see them.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$variant),*];

            /// The name on the command line and in files.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                }
            }
        }
    };
}

named! {
    /// How shadows are counted. [`crate::techniques::TABLE`] describes each.
    Technique {
        /// No shadows.
        None = "none",
        /// Heidmann's: counts volume faces before the surface.
        ZPass = "z-pass",
        /// Carmack's reverse: counts volume faces behind the surface, caps and all.
        ZFail = "z-fail",
        /// Sides only, counted from the eye's own count, exact at the near plane.
        ExactZPass = "exact-z-pass",
        /// Each caster by the cheapest form that is exact for it.
        #[default]
        Auto = "auto",
        /// Z-fail in a float target.
        Wide = "wide",
        /// Z-pass whose near plane is counted first.
        ZPlus = "zp-plus",
        /// Z-fail in two passes, of one face each.
        OneSided = "one-sided",
        /// Z-fail with a volume for each polygon.
        PerPolygon = "per-polygon",
        /// Beam's tutorial: finite volumes of each polygon, and a dark quad.
        Beam = "beam",
        /// Inverts one bit.
        Parity = "parity",
        /// Kilgard's planar cut-outs: flat casters by their outline and one matrix.
        Cutout = "cutout",
        /// Kilgard's flattened silhouettes: every caster reduced to a cut-out for each light.
        Flattened = "flattened",
    }
}

/// What is shown.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Show {
    /// The lit picture.
    #[default]
    Final,
    /// One light's stencil count in false colour, with a legend.
    Stencil,
    /// One light's verdict, exact: white lit, black in shadow, mid-grey where there is no surface
    /// or the light's range ends before it.
    Shadow,
    /// What the count's bits make of one light's true count: where they hold it, where it wraps, and
    /// where it wraps to zero.
    Overflow,
    /// The picture with one light's shadow volumes drawn over it.
    Volumes,
    /// Every caster in the colour of the case it falls in for one light.
    Cases,
    /// From above: the eye's frustum, the lights' ranges, one light's scissor.
    Bounds,
    /// The picture with every triangle's edges.
    Wireframe,
    /// Every surface in the colour of the mirrors on the way to it.
    Views,
    /// Every surface in a colour that no other has, exact.
    Surfaces,
    /// From above: the rooms that mirrors make, and what is seen of each.
    Birdseye,
    /// How often each pixel is drawn, in false colour, with a legend.
    Complexity,
    /// From the side, cut where the eye looks: rays, volumes and counts, as [`Diagram`] says.
    Rays,
    /// Shapes drawn into the stencil one after another, in place of the scene.
    Playground,
}

named! {
    /// The classic mistakes of shadow volumes, each of which one switch makes. [`crate::failures::TABLE`]
    /// says of each what is seen, why, and what cures it. The default is where the gallery begins.
    Failure {
        /// Counting in front of the surface, from inside a shadow.
        #[default]
        EyeInShadow = "eye-in-shadow",
        /// The near plane cuts a volume open.
        NearPlane = "near-plane",
        /// A far plane cuts volumes open.
        FiniteFar = "finite-far",
        /// Volumes that are open towards the light.
        NoLightCap = "no-light-cap",
        /// Volumes that are open away from the light.
        NoDarkCap = "no-dark-cap",
        /// The dark cap as a fan all around the light.
        DarkCapFan = "dark-cap-fan",
        /// Counting that stops at 0 and 255.
        Saturating = "saturating",
        /// More volumes over a pixel than the stencil can count.
        StencilOverflow = "stencil-overflow",
        /// The rules for closed meshes on an open one.
        OpenMesh = "open-mesh",
        /// A vertex in the middle of an edge.
        TJunction = "t-junction",
        /// A volume of fewer triangles than the surface.
        CoarseVolume = "coarse-volume",
        /// Surfaces and volumes whose positions are computed differently.
        MismatchedArithmetic = "mismatched-arithmetic",
        /// Volumes moved by polygon offset.
        PolygonOffset = "polygon-offset",
    }
}

impl Show {
    /// Everything that can be shown, in the order people see them.
    pub const ALL: [Self; 14] = [
        Self::Final,
        Self::Stencil,
        Self::Shadow,
        Self::Overflow,
        Self::Volumes,
        Self::Cases,
        Self::Bounds,
        Self::Wireframe,
        Self::Views,
        Self::Surfaces,
        Self::Birdseye,
        Self::Complexity,
        Self::Rays,
        Self::Playground,
    ];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Final => "final",
            Self::Stencil => "stencil",
            Self::Shadow => "shadow",
            Self::Overflow => "overflow",
            Self::Volumes => "volumes",
            Self::Cases => "cases",
            Self::Bounds => "bounds",
            Self::Wireframe => "wireframe",
            Self::Views => "views",
            Self::Surfaces => "surfaces",
            Self::Birdseye => "birdseye",
            Self::Complexity => "complexity",
            Self::Rays => "rays",
            Self::Playground => "playground",
        }
    }

    /// One sentence for help and panel.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Final => "the lit picture",
            Self::Stencil => "one light's stencil count in false colour, with a legend",
            Self::Shadow => "one light's verdict, exact: white lit, black in shadow, grey out of range or no surface",
            Self::Overflow => {
                "what the count's bits make of one light's true count: blue held, amber wrapped, red taken for light"
            }
            Self::Volumes => "one light's shadow volumes drawn over the picture",
            Self::Cases => {
                "casters by the case they fall in for one light: blue 1, yellow 2, red 3, violet left out; grey casts nothing"
            }
            Self::Bounds => {
                "from above: the eye's frustum, the lights' ranges, one light's scissor as a slice of the frustum, casters by case"
            }
            Self::Wireframe => "every triangle's edges drawn over the picture",
            Self::Views => "every surface in the colour of the mirrors on the way to it; grey past the last bounce",
            Self::Surfaces => {
                "every surface in a colour of its own, another in each mirror: exact values, black where nothing is"
            }
            Self::Birdseye => "from above: the rooms that mirrors make, where they seem to stand, and what is seen of each",
            Self::Rays => "a diagram: the scene from the side, cut where the eye looks, with rays, volumes and counts drawn in",
            Self::Complexity => "how often each pixel is drawn: depth complexity in false colour, with a legend",
            Self::Playground => "the stencil test to play with: shapes drawn one after another, every state free to choose",
        }
    }

    /// Whether it looks at one light, [`Settings::light`].
    #[must_use]
    pub const fn looks_at_light(self) -> bool {
        match self {
            Self::Stencil | Self::Shadow | Self::Overflow | Self::Volumes | Self::Cases | Self::Bounds | Self::Rays => true,
            Self::Final
            | Self::Wireframe
            | Self::Views
            | Self::Surfaces
            | Self::Birdseye
            | Self::Complexity
            | Self::Playground => false,
        }
    }
}
