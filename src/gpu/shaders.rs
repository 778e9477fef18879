//! WGSL: embedded in the binary or read from a folder, put together, checked by naga first.
//!
//! A file is put together by `#include "path"` lines. Positions in errors are led back to the file
//! and line they came from. [`PROGRAMS`] says which entry points each [`Program`] runs.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::context::GpuError;
use crate::frame::Program;

/// The files as they were when the program was built.
const EMBEDDED: &[(&str, &str)] = &[
    ("shared/frame.wgsl", include_str!("../../shaders/shared/frame.wgsl")),
    ("shared/surface.wgsl", include_str!("../../shaders/shared/surface.wgsl")),
    ("shared/material.wgsl", include_str!("../../shaders/shared/material.wgsl")),
    ("shared/light.wgsl", include_str!("../../shaders/shared/light.wgsl")),
    ("shared/full_screen.wgsl", include_str!("../../shaders/shared/full_screen.wgsl")),
    ("shared/tone.wgsl", include_str!("../../shaders/shared/tone.wgsl")),
    ("shared/mirror.wgsl", include_str!("../../shaders/shared/mirror.wgsl")),
    ("shared/volume.wgsl", include_str!("../../shaders/shared/volume.wgsl")),
    ("depth.wgsl", include_str!("../../shaders/depth.wgsl")),
    ("ambient.wgsl", include_str!("../../shaders/ambient.wgsl")),
    ("lit.wgsl", include_str!("../../shaders/lit.wgsl")),
    ("transparent.wgsl", include_str!("../../shaders/transparent.wgsl")),
    ("verdict.wgsl", include_str!("../../shaders/verdict.wgsl")),
    ("volume.wgsl", include_str!("../../shaders/volume.wgsl")),
    ("wireframe.wgsl", include_str!("../../shaders/wireframe.wgsl")),
    ("texture.wgsl", include_str!("../../shaders/texture.wgsl")),
    ("labels.wgsl", include_str!("../../shaders/labels.wgsl")),
    ("dissolve.wgsl", include_str!("../../shaders/dissolve.wgsl")),
    ("stencil_only.wgsl", include_str!("../../shaders/stencil_only.wgsl")),
    ("wide.wgsl", include_str!("../../shaders/wide.wgsl")),
    ("lines.wgsl", include_str!("../../shaders/lines.wgsl")),
    ("tint.wgsl", include_str!("../../shaders/tint.wgsl")),
    ("dark.wgsl", include_str!("../../shaders/dark.wgsl")),
    ("bounds.wgsl", include_str!("../../shaders/bounds.wgsl")),
    ("reflect.wgsl", include_str!("../../shaders/reflect.wgsl")),
    ("mirrored.wgsl", include_str!("../../shaders/mirrored.wgsl")),
    ("identity.wgsl", include_str!("../../shaders/identity.wgsl")),
    ("halo.wgsl", include_str!("../../shaders/halo.wgsl")),
    ("playground.wgsl", include_str!("../../shaders/playground.wgsl")),
    ("solid.wgsl", include_str!("../../shaders/solid.wgsl")),
    ("geometry.wgsl", include_str!("../../shaders/geometry.wgsl")),
    ("shade.wgsl", include_str!("../../shaders/shade.wgsl")),
    ("output.wgsl", include_str!("../../shaders/output.wgsl")),
    ("shared/double.wgsl", include_str!("../../shaders/shared/double.wgsl")),
    (COMPUTE, include_str!("../../shaders/silhouettes.wgsl")),
];

/// The compute shader that finds silhouettes.
pub const COMPUTE: &str = "silhouettes.wgsl";
/// Its entry points, in the order in which they run.
pub const STAGES: [&str; 7] = ["face", "follow", "pivot", "tally", "scan", "write", "arguments"];

/// What vertices a program reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Vertices {
    /// None: the shader makes them.
    None,
    /// None: the shader makes [`BANDS`] of six.
    Bands,
    /// Positions and attributes of a mesh.
    Surface,
    /// Positions of a mesh.
    Positions,
    /// The same, and which way is out.
    Swollen,
    /// Positions of a mesh, as line ends.
    Edges,
    /// Homogeneous positions: of volumes, welded positions twice, with w = 1 and w = 0.
    Volume,
    /// Corners of names' plates and letters.
    Labels,
    /// Corners of lines and areas.
    Lines,
}

/// How many bands the background is drawn in.
pub const BANDS: u32 = 32;

/// One program's shaders.
#[derive(Debug, Clone, Copy)]
pub struct Entry {
    /// Which.
    pub program: Program,
    /// The file.
    pub file: &'static str,
    /// The vertex entry point.
    pub vertex: &'static str,
    /// The fragment entry point.
    pub fragment: &'static str,
    /// What the vertex entry point reads.
    pub vertices: Vertices,
    /// What is set when its pipeline is made.
    pub overrides: &'static [Override],
}

/// The WGSL `override`s there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Override {
    /// `TEXTURED`: the base colour texture is sampled.
    Textured,
    /// `GLOSSY`: highlights are computed.
    Glossy,
    /// `BOTH_SIDES`: triangles are seen from behind too.
    BothSides,
    /// `LIGHT_KIND`: the shape of the one light.
    LightKind,
    /// `BANDS`: how many there are.
    Bands,
    /// `FINISHED`: the colour is the picture's own.
    Finished,
    /// `CLIPPED`: fragments under the clip plane are left out.
    Clipped,
    /// `MIRROR`: how the surface reflects.
    Mirror,
    /// `LIGHT_0` to `LIGHT_3`: the shape of one of several lights.
    EachKind(usize),
    /// `EACH`: each light's bit is asked for.
    Each,
    /// `MATERIALS`: they are read pixel by pixel.
    Materials,
}

const fn entry(
    program: Program,
    file: &'static str,
    vertex: &'static str,
    fragment: &'static str,
    vertices: Vertices,
    overrides: &'static [Override],
) -> Entry {
    Entry { program, file, vertex, fragment, vertices, overrides }
}

/// What `shared/surface.wgsl` declares.
const SURFACE: &[Override] = &[Override::Textured, Override::Glossy, Override::BothSides, Override::Clipped];
/// And `ambient.wgsl` beside it.
const AMBIENT: &[Override] =
    &[Override::Textured, Override::Glossy, Override::BothSides, Override::Clipped, Override::Finished, Override::Mirror];
/// And `reflect.wgsl`.
const REFLECTED: &[Override] = &[Override::Textured, Override::Glossy, Override::BothSides, Override::Clipped, Override::Mirror];
/// And `lit.wgsl`.
const LIT: &[Override] = &[
    Override::Textured,
    Override::Glossy,
    Override::BothSides,
    Override::Clipped,
    Override::LightKind,
    Override::Finished,
    Override::Mirror,
];

/// What `shade.wgsl` declares.
const SHADE: &[Override] = &[
    Override::Glossy,
    Override::Finished,
    Override::EachKind(0),
    Override::EachKind(1),
    Override::EachKind(2),
    Override::EachKind(3),
    Override::Each,
    Override::Materials,
];

/// Every program, in the order of the enum.
pub const PROGRAMS: &[Entry] = &[
    entry(Program::Depth, "depth.wgsl", "depth_vertex", "depth", Vertices::Positions, &[]),
    entry(Program::DepthMasked, "depth.wgsl", "surface_vertex", "depth_masked", Vertices::Surface, SURFACE),
    entry(Program::Ambient, "ambient.wgsl", "ambient_vertex", "ambient", Vertices::Surface, AMBIENT),
    entry(Program::AmbientMasked, "ambient.wgsl", "ambient_vertex", "ambient_masked", Vertices::Surface, AMBIENT),
    entry(Program::Lit, "lit.wgsl", "lit_vertex", "lit", Vertices::Surface, LIT),
    entry(Program::Volume, "volume.wgsl", "volume_vertex", "volume_count", Vertices::Volume, &[]),
    entry(Program::VolumeMismatched, "volume.wgsl", "volume_vertex_mismatched", "volume_count", Vertices::Volume, &[]),
    entry(Program::VolumeGlass, "volume.wgsl", "volume_vertex", "volume_glass", Vertices::Volume, &[]),
    entry(Program::VolumeNumbers, "wide.wgsl", "volume_vertex", "volume_numbers", Vertices::Volume, &[]),
    entry(Program::Verdict, "verdict.wgsl", "surface_vertex", "verdict", Vertices::Surface, SURFACE),
    entry(Program::Transparent, "transparent.wgsl", "surface_vertex", "transparent", Vertices::Surface, SURFACE),
    entry(Program::Wireframe, "wireframe.wgsl", "wireframe_vertex", "wireframe", Vertices::Edges, &[]),
    entry(Program::Gather, "output.wgsl", "full_screen_vertex", "gather", Vertices::None, &[]),
    entry(Program::StencilColors, "output.wgsl", "full_screen_vertex", "stencil_colors", Vertices::None, &[]),
    entry(Program::ToneMap, "output.wgsl", "backdrop_vertex", "tone_map", Vertices::None, &[]),
    entry(Program::Background, "output.wgsl", "band_vertex", "background", Vertices::Bands, &[Override::Bands]),
    entry(Program::Copy, "output.wgsl", "full_screen_vertex", "copy", Vertices::None, &[]),
    entry(Program::VolumeFronts, "volume.wgsl", "volume_vertex", "volume_count_fronts", Vertices::Volume, &[]),
    entry(Program::VolumeBacks, "volume.wgsl", "volume_vertex", "volume_count_backs", Vertices::Volume, &[]),
    entry(Program::Labels, "labels.wgsl", "label_vertex", "label", Vertices::Labels, &[]),
    entry(Program::Texture, "texture.wgsl", "surface_vertex", "texture", Vertices::Surface, SURFACE),
    entry(Program::StencilOnly, "stencil_only.wgsl", "full_screen_vertex", "stencil_only", Vertices::None, &[]),
    entry(Program::WideVerdict, "wide.wgsl", "full_screen_vertex", "wide_verdict", Vertices::None, &[]),
    entry(Program::WideVerdictEach, "wide.wgsl", "full_screen_vertex", "wide_verdict_each", Vertices::None, &[]),
    entry(Program::WideBit, "wide.wgsl", "full_screen_vertex", "wide_bit", Vertices::None, &[]),
    entry(Program::WideOverflow, "wide.wgsl", "full_screen_vertex", "wide_overflow", Vertices::None, &[]),
    entry(Program::NearPlane, "volume.wgsl", "thrown_vertex", "volume_count", Vertices::Volume, &[]),
    entry(Program::Dark, "dark.wgsl", "full_screen_vertex", "dark", Vertices::None, &[]),
    entry(Program::Tint, "tint.wgsl", "surface_vertex", "tint", Vertices::Surface, SURFACE),
    entry(Program::TintMasked, "tint.wgsl", "surface_vertex", "tint_masked", Vertices::Surface, SURFACE),
    entry(Program::Bounds, "bounds.wgsl", "bounds_vertex", "bounds", Vertices::Volume, &[]),
    entry(Program::Lines, "lines.wgsl", "line_vertex", "line", Vertices::Lines, &[]),
    entry(Program::Own, "ambient.wgsl", "ambient_vertex", "own", Vertices::Surface, AMBIENT),
    entry(Program::Reflected, "reflect.wgsl", "surface_vertex", "reflected", Vertices::Surface, REFLECTED),
    entry(Program::Backdrop, "output.wgsl", "backdrop_vertex", "backdrop", Vertices::None, &[]),
    entry(Program::Mirrored, "mirrored.wgsl", "surface_vertex", "mirrored", Vertices::Surface, REFLECTED),
    entry(Program::Identity, "identity.wgsl", "identity_vertex", "identity", Vertices::Surface, SURFACE),
    entry(Program::Halo, "halo.wgsl", "halo_vertex", "halo", Vertices::Swollen, &[Override::Clipped]),
    entry(Program::Playground, "playground.wgsl", "full_screen_vertex", "playground", Vertices::None, &[]),
    entry(Program::SolidMerge, "solid.wgsl", "full_screen_vertex", "solid_merge", Vertices::None, &[]),
    entry(Program::SolidMergeEach, "solid.wgsl", "full_screen_vertex", "solid_merge_each", Vertices::None, &[]),
    entry(Program::Projected, "volume.wgsl", "thrown_vertex", "projected", Vertices::Volume, &[]),
    entry(Program::Pattern, "dissolve.wgsl", "pattern_vertex", "pattern", Vertices::None, &[]),
    entry(Program::LayKept, "dissolve.wgsl", "full_screen_vertex", "lay_kept", Vertices::None, &[]),
    entry(Program::VolumeFill, "volume.wgsl", "volume_vertex", "projected", Vertices::Volume, &[]),
    entry(Program::Geometry, "geometry.wgsl", "geometry_vertex", "geometry", Vertices::Surface, SURFACE),
    entry(Program::GeometryMasked, "geometry.wgsl", "geometry_vertex", "geometry_masked", Vertices::Surface, SURFACE),
    entry(Program::MarkDark, "shade.wgsl", "full_screen_vertex", "mark_dark", Vertices::None, &[]),
    entry(Program::Shade, "shade.wgsl", "shade_vertex", "shade", Vertices::None, SHADE),
];

/// The entry of a program.
#[must_use]
pub fn entry_of(program: Program) -> &'static Entry {
    // The table is in the enum's order; a test holds it so.
    &PROGRAMS[program as usize]
}

/// A file with its includes put in.
#[derive(Debug, Clone)]
pub struct Source {
    /// The whole text.
    pub text: String,
    /// File and line of each line of `text`, from 1.
    origin: Vec<(String, usize)>,
}

impl Source {
    /// Parses and validates; the error is `file:line:column: message`.
    ///
    /// # Errors
    /// What naga finds.
    pub fn check(&self) -> Result<naga::Module, String> {
        let module = naga::front::wgsl::parse_str(&self.text).map_err(|error| {
            let location = error.location(&self.text).map(|at| (at.line_number as usize, at.line_position as usize));
            self.locate(location, error.message())
        })?;
        naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::all())
            .validate(&module)
            .map_err(|error| {
                let location = error.location(&self.text).map(|at| (at.line_number as usize, at.line_position as usize));
                let mut message = error.as_inner().to_string();
                let mut cause: Option<&dyn std::error::Error> = std::error::Error::source(error.as_inner());
                while let Some(inner) = cause {
                    message.push_str(": ");
                    message.push_str(&inner.to_string());
                    cause = inner.source();
                }
                self.locate(location, &message)
            })?;
        Ok(module)
    }

    fn locate(&self, at: Option<(usize, usize)>, message: &str) -> String {
        let message = message.lines().next().unwrap_or("unknown error");
        match at.and_then(|(line, column)| Some((self.origin.get(line.checked_sub(1)?)?, column))) {
            Some(((file, line), column)) => format!("{file}:{line}:{column}: {message}"),
            None => {
                let file = self.origin.last().map_or("shader", |(file, _)| file.as_str());
                format!("{file}: {message}")
            }
        }
    }
}

/// Where shader text comes from.
#[derive(Debug)]
pub struct Library {
    folder: Option<PathBuf>,
    stamps: HashMap<PathBuf, Option<SystemTime>>,
}

impl Library {
    /// Embedded files, or those of `folder` with the embedded ones for what it lacks.
    #[must_use]
    pub fn new(folder: Option<&Path>) -> Self {
        let mut library = Self { folder: folder.map(Path::to_path_buf), stamps: HashMap::new() };
        library.changed();
        library
    }

    /// Whether a file of the folder changed since the last call.
    pub fn changed(&mut self) -> bool {
        let Some(folder) = &self.folder else { return false };
        let mut changed = false;
        for (name, _) in EMBEDDED {
            let path = folder.join(name);
            let stamp = std::fs::metadata(&path).and_then(|data| data.modified()).ok();
            changed |= self.stamps.insert(path, stamp).is_some_and(|before| before != stamp);
        }
        changed
    }

    /// Every file that programs name, put together and checked.
    ///
    /// # Errors
    /// The first file's first error, with its place.
    pub fn load(&self) -> Result<HashMap<&'static str, Source>, GpuError> {
        let mut sources = HashMap::new();
        for file in PROGRAMS.iter().map(|entry| entry.file).chain([COMPUTE]) {
            if !sources.contains_key(file) {
                let source = self.source(file).map_err(GpuError::Shader)?;
                source.check().map_err(GpuError::Shader)?;
                sources.insert(file, source);
            }
        }
        Ok(sources)
    }

    /// One file with its includes put in; the error says where.
    ///
    /// # Errors
    /// A file that is not there or cannot be read, an include that is not there or includes itself.
    pub fn source(&self, file: &str) -> Result<Source, String> {
        let mut source = Source { text: String::new(), origin: Vec::new() };
        self.include(file, &mut Vec::new(), &mut source)?;
        Ok(source)
    }

    fn include(&self, file: &str, stack: &mut Vec<String>, source: &mut Source) -> Result<(), String> {
        if stack.iter().any(|open| open == file) {
            return Err(format!("{file}: includes itself"));
        }
        let text = self.read(file)?;
        stack.push(file.into());
        for (number, line) in text.lines().enumerate() {
            if let Some(rest) = line.trim().strip_prefix("#include") {
                let path = rest.trim().trim_matches('"');
                let there = EMBEDDED.iter().any(|(name, _)| *name == path);
                if !there {
                    return Err(format!("{file}:{}:1: no shader file `{path}` to include", number + 1));
                }
                self.include(path, stack, source)?;
            } else {
                source.text.push_str(line);
                source.text.push('\n');
                source.origin.push((file.into(), number + 1));
            }
        }
        stack.pop();
        Ok(())
    }

    fn read(&self, file: &str) -> Result<String, String> {
        if let Some(path) = self.folder.as_ref().map(|folder| folder.join(file))
            && path.exists()
        {
            return std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()));
        }
        EMBEDDED
            .iter()
            .find(|(name, _)| *name == file)
            .map(|(_, text)| (*text).to_owned())
            .ok_or_else(|| format!("{file}: no such shader file"))
    }
}
