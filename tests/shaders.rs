//! Every WGSL entry point passes naga, and every struct shared with Rust has the same layout there.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use obscura::frame::Program;
use obscura::gpu::shaders::{COMPUTE, Entry, Library, PROGRAMS, STAGES, Vertices, entry_of};
use obscura::gpu::types;

#[test]
fn every_entry_point_is_valid_and_of_its_stage() {
    let library = Library::new(None);
    for entry in PROGRAMS {
        let module = library.source(entry.file).unwrap().check().unwrap_or_else(|error| panic!("{error}"));
        let has = |name: &str, stage| module.entry_points.iter().any(|point| point.name == name && point.stage == stage);
        assert!(has(entry.vertex, naga::ShaderStage::Vertex), "{}: no vertex entry point {}", entry.file, entry.vertex);
        let fragment = entry.fragment;
        assert!(has(fragment, naga::ShaderStage::Fragment), "{}: no fragment entry point {fragment}", entry.file);
        assert_eq!(entry_of(entry.program).program, entry.program, "the table is not in the enum's order");
    }
}

#[test]
fn every_entry_point_in_the_files_is_used_by_a_program() {
    let library = Library::new(None);
    for file in PROGRAMS.iter().map(|entry| entry.file) {
        let module = library.source(file).unwrap().check().unwrap();
        for point in &module.entry_points {
            let used =
                PROGRAMS.iter().any(|entry| entry.vertex == point.name || (entry.file == file && entry.fragment == point.name));
            assert!(used, "{file}: entry point `{}` belongs to no program", point.name);
        }
    }
}

#[test]
fn every_override_is_set_by_its_program() {
    let library = Library::new(None);
    for entry in PROGRAMS {
        let module = library.source(entry.file).unwrap().check().unwrap();
        let declared = module.overrides.iter().count();
        let set = entry.overrides.len();
        assert!(set <= declared, "{:?} sets overrides that {} does not declare", entry.program, entry.file);
        if entry.vertices == Vertices::Surface {
            assert_eq!(set, declared, "{:?} leaves an override of {} to its default", entry.program, entry.file);
        }
    }
}

#[test]
fn positions_of_surfaces_and_volumes_are_invariant() {
    let library = Library::new(None);
    // A light's bounds are compared with no surface of the same place.
    let laid = |entry: &&Entry| {
        matches!(entry.vertices, Vertices::Surface | Vertices::Positions | Vertices::Volume) && entry.program != Program::Bounds
    };
    for entry in PROGRAMS.iter().filter(laid) {
        let module = library.source(entry.file).unwrap().check().unwrap();
        let point = module.entry_points.iter().find(|point| point.name == entry.vertex).unwrap();
        let result = point.function.result.as_ref().unwrap();
        let invariant = |binding: &Option<naga::Binding>| {
            matches!(binding, Some(naga::Binding::BuiltIn(naga::BuiltIn::Position { invariant: true })))
        };
        let found = match &module.types[result.ty].inner {
            naga::TypeInner::Struct { members, .. } => members.iter().any(|member| invariant(&member.binding)),
            _ => invariant(&result.binding),
        };
        assert!(found, "{}: {} has no invariant position", entry.file, entry.vertex);
    }
}

/// Name and offset of each field of `structure`, and its size, as naga lays it out.
fn wgsl_layout(file: &str, structure: &str) -> (Vec<(String, u32)>, u32) {
    let module = Library::new(None).source(file).unwrap().check().unwrap();
    let found = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(structure));
    let (_, ty) = found.unwrap_or_else(|| panic!("{file} has no struct {structure}"));
    let naga::TypeInner::Struct { members, span } = &ty.inner else { panic!("{structure} is no struct") };
    (members.iter().map(|member| (member.name.clone().unwrap(), member.offset)).collect(), *span)
}

macro_rules! same_layout {
    ($file:literal, $name:literal, $ty:ty, [$($field:ident),* $(,)?]) => {{
        let (fields, size) = wgsl_layout($file, $name);
        let rust = [$((stringify!($field), std::mem::offset_of!($ty, $field) as u32)),*];
        for (field, offset) in rust {
            let found = fields.iter().find(|(name, _)| name == field);
            assert_eq!(found.map(|(_, offset)| *offset), Some(offset), "{}.{field}", $name);
        }
        let named = fields.iter().filter(|(name, _)| !name.starts_with("_pad")).count();
        assert_eq!(named, rust.len(), "{} has fields that this test does not name", $name);
        assert_eq!(size as usize, size_of::<$ty>(), "size of {}", $name);
    }};
}

#[test]
fn shared_structs_have_the_same_layout() {
    same_layout!(
        "lit.wgsl",
        "Frame",
        types::Frame,
        [
            eye,
            exposure,
            ambient_sky,
            smooth_terminator,
            ambient_ground,
            light_count,
            background_top,
            pixel,
            background_bottom,
            scale,
            size,
            clip_from_world,
            clip_plane,
            way_ahead,
            near,
            way_right,
            way_up
        ]
    );
    same_layout!("lit.wgsl", "Object", types::Object, [clip_from_object, world_from_object, normal_from_object]);
    same_layout!(
        "lit.wgsl",
        "Light",
        types::Light,
        [
            position,
            inverse_range_squared,
            direction,
            cos_outer,
            intensity,
            inverse_cone_width,
            right,
            kind,
            slide,
            slide_scale,
            hand
        ]
    );
    same_layout!(
        "volume.wgsl",
        "Volume",
        types::Volume,
        [light_in_object, end_in_object, start_in_object, thrown, object, by_matrix, extrusion]
    );
    same_layout!("volume.wgsl", "Draw", types::Draw, [constant, light, swell]);
    same_layout!(
        "silhouettes.wgsl",
        "Job",
        types::Job,
        [
            light,
            reach,
            room,
            rounding,
            flags,
            triangles,
            neighbours,
            pairs,
            others,
            incidences,
            planes,
            welded,
            vertices,
            facing,
            edge_on,
            sides,
            cap,
            dark,
            triangle_count,
            pair_count,
            other_count,
            triangle_block,
            triangle_blocks,
            edge_block,
            edge_blocks,
            start
        ]
    );
    same_layout!("lit.wgsl", "Material", types::Material, [base_color, emissive, roughness, metallic, cutoff, unlit, number]);
}

#[test]
fn every_stage_of_the_compute_shader_is_there_and_no_other() {
    let module = Library::new(None).source(COMPUTE).unwrap().check().unwrap_or_else(|error| panic!("{error}"));
    let found: Vec<_> = module.entry_points.iter().map(|point| (point.name.as_str(), point.stage)).collect();
    assert_eq!(found, STAGES.map(|stage| (stage, naga::ShaderStage::Compute)));
    // One thread for each of the draws that a workgroup takes, and so on: gpu/compute.rs knows how many.
    assert!(module.entry_points.iter().all(|point| point.workgroup_size == [64, 1, 1]));
}

#[test]
fn an_error_names_file_line_and_column() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/lit.wgsl")).unwrap();
    let broken = text.replace("light_reach(draw", "no_such_function(draw");
    assert_ne!(text, broken);
    let line = 1 + broken.lines().position(|line| line.contains("no_such_function")).unwrap();
    std::fs::write(folder.path().join("lit.wgsl"), broken).unwrap();
    let error = Library::new(Some(folder.path())).load().unwrap_err().to_string();
    assert!(error.contains(&format!("lit.wgsl:{line}:")), "{error}");
    assert!(error.contains("no_such_function"), "{error}");
}

#[test]
fn an_error_in_an_included_file_names_that_file() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("shared")).unwrap();
    std::fs::write(folder.path().join("shared/full_screen.wgsl"), "fn broken( {\n").unwrap();
    let error = Library::new(Some(folder.path())).load().unwrap_err().to_string();
    assert!(error.contains("shared/full_screen.wgsl:1:"), "{error}");
}

/// Surfaces are grouped by whether they have a highlight, and pixels shaded by their materials' numbers: by one bound.
#[test]
fn what_is_matt_is_so_on_both_sides() {
    let bound = format!("const MATT: f32 = {:?};", obscura::techniques::surfaces::MATT);
    assert!(include_str!("../shaders/shared/light.wgsl").contains(&bound), "{bound}");
}

/// Lavapipe works a shader out anew at every draw where uniforms alone decide a branch or a loop's end, and keeps each
/// copy until the pipeline is dropped: ten megabytes a frame, in a scene of many materials.
#[test]
fn no_branch_is_decided_by_uniforms_alone() {
    let files = |folder: &str| std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect::<Vec<_>>();
    let shaders = files("shaders").into_iter().chain(files("shaders/shared"));
    for file in shaders.filter(|file| file.extension().is_some_and(|extension| extension == "wgsl")) {
        for (number, line) in (1..).zip(std::fs::read_to_string(&file).unwrap().lines()) {
            let line = line.trim();
            let code = line.split("//").next().unwrap_or_default();
            assert!(decided_by_uniforms(code).is_none(), "{}:{number}: {line}", file.display());
        }
    }
    for (code, decides) in [
        ("if material.unlit < 0.5 {", true),
        ("if !GLOSSY || (material.roughness >= MATT && material.metallic <= 0.0) {", true),
        ("for (var i = 0u; i < frame.light_count; i++) {", true),
        ("if draw.light.kind != DIRECTIONAL && far {", true),
        ("if CLIPPED && dot(frame.clip_plane, vec4f(world, 1.0)) < 0.0 {", false),
        ("if base_color(point).a < material.cutoff {", false),
        ("if GLOSSY {", false),
        ("for (var i = 0u; i < count; i++) {", false),
    ] {
        assert_eq!(decided_by_uniforms(code).is_some(), decides, "{code}");
    }
}

/// The part of a branch or of a loop's head that asks uniforms and nothing else.
fn decided_by_uniforms(code: &str) -> Option<&str> {
    let is_uniform = |name: &str| ["material.", "frame.", "draw."].iter().any(|of| name.starts_with(of));
    let names = |asked: &str| {
        let parts = asked.split(|c: char| !(c.is_alphanumeric() || "._".contains(c))).map(str::to_owned);
        parts.filter(|part| part.starts_with(|c: char| c.is_ascii_lowercase())).collect::<Vec<_>>()
    };
    if code.starts_with("for ") {
        return code.split(';').nth(1).filter(|end| names(end).iter().any(|name| is_uniform(name)));
    }
    let asked = code.trim_start_matches("} else ").strip_prefix("if ")?;
    // Each side of these is a branch of its own.
    asked.split("&&").flat_map(|part| part.split("||")).find(|part| {
        let names = names(part);
        !names.is_empty() && names.iter().all(|name| is_uniform(name))
    })
}
