//! Silhouettes found by the compute shader are the CPU's: index for index, stencil for stencil, pixel for pixel.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;
mod shapes;

use common::{Build, Shot, Stage, cube, mesh, seen_from, square};
use glam::DVec3;
use obscura::frame::{Capabilities, Part, VolumePart};
use obscura::gpu::readback::volume_parts;
use obscura::scene::{LightKind, Scene, open, stock};
use obscura::settings::{Backend, Failure, LightEdit, MirrorLight, SceneChoice, Settings, Show, Technique};
use proptest::strategy::{Strategy as _, ValueTree as _};

/// Draws by both; the stencils, the pictures and the parts must be equal. Gives how many parts the shader has built.
fn assert_equal(stage: &mut Stage, scene: &Scene, settings: &Settings, about: &str) -> usize {
    let by = |stage: &mut Stage, silhouettes: Backend| {
        let shot = stage.shoot(&Settings { silhouettes, ..settings.clone() }, scene);
        let parts = volume_parts(&stage.context, &stage.renderer, &shot.plan).unwrap();
        (shot, parts, stage.stencil())
    };
    let (cpu, cpu_parts, cpu_stencil) = by(stage, Backend::Cpu);
    let (compute, parts, stencil) = by(stage, Backend::Compute);
    let drawn = |shot: &Shot| (shot.stats.volume_triangles, shot.stats.indices);
    let mut other_ways = false;
    let names = |parts: &[(VolumePart, Vec<u32>)]| parts.iter().map(|(part, _)| *part).collect::<Vec<_>>();
    assert_eq!(names(&cpu_parts), names(&parts), "{about}");
    for ((part, expected), (_, found)) in cpu_parts.iter().zip(&parts) {
        // Where the box does not tell that a fan will do, the shader takes all triangles: the count is the same.
        let cap = matches!(part.part, Part::DarkCap | Part::StartCap | Part::EndCap);
        let other_way = cap && expected.len() != found.len();
        other_ways |= other_way;
        assert!(expected == found || other_way, "{about}: {part:?}, {} and {} indices", expected.len(), found.len());
    }
    let differ = cpu_stencil.iter().zip(&stencil).filter(|(a, b)| a != b).count();
    assert_eq!(differ, 0, "{about}: stencil values differ");
    assert!(cpu.image == compute.image, "{about}: pixels differ");
    assert!(other_ways || drawn(&cpu) == drawn(&compute), "{about}: {:?} and {:?}", drawn(&cpu), drawn(&compute));
    let computed = |(part, indices): &&(VolumePart, Vec<u32>)| {
        compute.plan.volumes[part.volume].silhouette == Backend::Compute && !indices.is_empty()
    };
    parts.iter().filter(computed).count()
}

#[test]
fn stock_scenes_are_the_same_by_every_technique() {
    let mut stage = Stage::new();
    for (name, least) in [("courtyard", 8), ("terraces", 8), ("cathedral", 8), ("gallery", 2)] {
        let scene = stock::build(name).unwrap().unwrap();
        stage.set_scene(&scene);
        let mut built = 0;
        for technique in [Technique::Auto, Technique::ZFail, Technique::ZPass, Technique::Wide] {
            for (light, time) in [(0, 0.5), (scene.lights.len() - 1, 7.0)] {
                let show = if technique == Technique::Auto { Show::Final } else { Show::Stencil };
                let settings = Settings { technique, show, light, time, size: [160, 90], ..Settings::default() };
                built += assert_equal(&mut stage, &scene, &settings, &format!("{name} by {technique:?}"));
            }
        }
        assert!(built >= least, "{name}: the shader built only {built} parts");
    }
}

/// Skins that bend as time goes by, their casters' volumes built on the device in every pose.
#[test]
fn skinned_casters_are_the_same_in_every_pose() {
    let mut stage = Stage::new();
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let fox = ["../shared/models/Fox.glb", "../../shared/models/Fox.glb"].map(|path| root.join(path));
    let fox = fox.into_iter().find(|path| path.is_file());
    let scenes =
        [Some(stock::build("cathedral").unwrap().unwrap()), fox.map(|path| open(&SceneChoice::File(path), true).unwrap())];
    for scene in scenes.into_iter().flatten() {
        stage.set_scene(&scene);
        let mut bent = std::collections::HashSet::new();
        for (technique, time) in
            [(Technique::ZFail, 0.0), (Technique::ZFail, 0.31), (Technique::Auto, 0.31), (Technique::Auto, 0.9)]
        {
            let show = if technique == Technique::Auto { Show::Final } else { Show::Stencil };
            let settings = Settings { technique, show, time, size: [160, 90], ..Settings::default() };
            let about = format!("{} by {technique:?} at {time}", scene.name);
            assert!(assert_equal(&mut stage, &scene, &settings, &about) > 0);
            let shot = stage.shoot(&Settings { silhouettes: Backend::Compute, ..settings }, &scene);
            let nodes: Vec<_> = scene.instances().map(|(node, ..)| node).collect();
            for (part, indices) in volume_parts(&stage.context, &stage.renderer, &shot.plan).unwrap() {
                let volume = &shot.plan.volumes[part.volume];
                let skinned = scene.nodes[nodes[volume.instance]].skin.is_some();
                if skinned && volume.silhouette == Backend::Compute && !indices.is_empty() {
                    assert!(shot.pose.deformed[nodes[volume.instance]].is_some());
                    bent.insert((volume.instance, time.to_bits(), indices));
                }
            }
        }
        let poses = bent.iter().map(|(_, time, _)| *time).collect::<std::collections::HashSet<_>>();
        assert!(bent.len() > 3 && poses.len() == 3, "{}: {} silhouettes, {} poses", scene.name, bent.len(), poses.len());
    }
}

/// A heap of everything that is not closed and simple.
fn heap() -> Scene {
    let mut build = Build::new();
    build.floor(0.0, 20.0);
    let solid = build.mesh(cube(0));
    build.place(solid, DVec3::new(-2.0, 1.5, 0.0), DVec3::ONE);
    build.place(solid, DVec3::new(2.0, 1.5, 1.0), DVec3::new(-1.0, 1.0, 0.5));
    let sheet = build.mesh(square(1));
    build.place(sheet, DVec3::new(0.0, 4.0, 0.0), DVec3::ONE);
    // Three pages on one spine, one of them the wrong way round.
    let corners = [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [1.0, 0.6, 0.0], [-1.0, 0.7, 0.1], [0.1, 1.0, 0.2]];
    let book = build.mesh(mesh("book", &corners, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]], 1));
    build.place(book, DVec3::new(0.0, 1.0, -3.0), DVec3::ONE);
    build.point_light(DVec3::new(1.0, 7.0, 2.0));
    build.light(LightKind::Directional, DVec3::Y, DVec3::new(-0.4, -1.0, 0.2), 3.0);
    build.0
}

#[test]
fn sheets_books_suns_and_lights_in_a_face_are_the_same() {
    let mut stage = Stage::new();
    let scene = heap();
    stage.set_scene(&scene);
    let base = Settings { show: Show::Stencil, ..seen_from(DVec3::new(5.0, 5.0, 9.0), DVec3::Y, [160, 90]) };
    let mut built = 0;
    for technique in [Technique::ZFail, Technique::ExactZPass, Technique::Beam] {
        built += assert_equal(&mut stage, &scene, &Settings { technique, light: 1, ..base.clone() }, "the sun");
        // In the plane of a cube's top, of its side, in line with an edge; within a cube; close to the book's spine.
        for at in [[7.0, 2.5, 3.0], [-1.0, 6.0, 4.0], [-3.0, 2.5, 9.0], [-2.0, 1.5, 0.25], [0.0, 1.0, 3.0], [0.3, 1.2, -2.8]] {
            let edit = LightEdit { position: Some(at.into()), ..LightEdit::default() };
            let settings = Settings { technique, lights: [(0, edit)].into(), ..base.clone() };
            built += assert_equal(&mut stage, &scene, &settings, &format!("{technique:?} from {at:?}"));
        }
    }
    assert!(built > 60, "{built}");
}

#[test]
fn random_solids_and_soups_are_the_same_index_for_index() {
    let mut stage = Stage::new();
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let whole = |value: f32| f64::from((value * 4.0).round()) / 4.0;
    for case in 0..60 {
        let shape = shapes::shape().new_tree(&mut runner).unwrap().current();
        let light = shapes::light().new_tree(&mut runner).unwrap().current();
        let mut build = Build::new();
        build.0.meshes.push(shape.mesh);
        build.place(0, DVec3::ZERO, DVec3::ONE);
        build.floor(-9.0, 30.0);
        // Every other light stands on a grid, where it is in many planes.
        let at = light.truncate().to_array().map(|value| if case % 2 == 0 { whole(value) } else { f64::from(value) });
        if light.w == 0.0 {
            build.light(LightKind::Directional, DVec3::ZERO, -DVec3::from_array(at), 1.0);
        } else {
            build.point_light(at.into());
        }
        stage.set_scene(&build.0);
        let settings = Settings {
            show: Show::Stencil,
            technique: Technique::ZFail,
            ..seen_from(DVec3::new(6.0, 9.0, 12.0), DVec3::ZERO, [48, 32])
        };
        assert_equal(&mut stage, &build.0, &settings, &format!("case {case}: {at:?}"));
    }
}

#[test]
fn what_the_shader_does_not_build_is_said() {
    let mut stage = Stage::new();
    let scene = stock::build("courtyard").unwrap().unwrap();
    stage.set_scene(&scene);
    let base = Settings { silhouettes: Backend::Compute, size: [64, 36], ..Settings::default() };
    let note = |settings: &Settings| {
        let (_, plan) = obscura::director::stage(settings, &scene, stage.context.capabilities()).unwrap();
        plan.notes.iter().find(|note| note.contains("on the CPU")).cloned()
    };
    assert_eq!(note(&base), None);
    let said = |settings: &Settings, words: &str| {
        let note = note(settings);
        assert!(note.as_ref().is_some_and(|note| note.contains(words)), "{note:?} does not say: {words}");
    };
    said(&Settings { technique: Technique::PerPolygon, ..base.clone() }, "polygon");
    said(&Settings { technique: Technique::Flattened, ..base.clone() }, "cut-outs");
    said(&Settings { failure: Some(Failure::DarkCapFan), ..base.clone() }, "wrongly");
    let afar = LightEdit { position: Some(DVec3::splat(2e9)), range: Some(f32::INFINITY), ..LightEdit::default() };
    let mut lit_from_afar = Settings { technique: Technique::ZFail, lights: [(0, afar)].into(), ..base.clone() };
    lit_from_afar.culling.on = false;
    said(&lit_from_afar, "farther");
    let lacking = |largest| {
        let capabilities = Capabilities { compute_silhouettes: largest, ..Capabilities::complete() };
        let (_, plan) = obscura::director::stage(&base, &scene, &capabilities).unwrap();
        assert!(plan.volumes.iter().all(|volume| volume.silhouette == Backend::Cpu));
        plan.notes.join("; ")
    };
    assert!(lacking(None).contains("INDIRECT_FIRST_INSTANCE"));
    assert!(lacking(Some(64)).contains("too small"));
    let mirrors = stock::build("barbershop").unwrap().unwrap();
    stage.set_scene(&mirrors);
    let mut virtual_lights = Settings { size: [160, 90], ..Settings::default() };
    virtual_lights.mirrors.light = MirrorLight::Virtual;
    assert!(assert_equal(&mut stage, &mirrors, &virtual_lights, "light off mirrors, some of it by the CPU") > 0);
}

/// A slab whose top, at y = 1, is a grid of triangles of all sizes.
fn uneven_slab(side: u32) -> Scene {
    let across = side + 1;
    let at = |x: u32, z: u32, top: u32| (top * across + z) * across + x;
    let mut random = fastrand::Rng::with_seed(3);
    let mut jitter = |step: u32| step as f32 * 10.0 + if step == 0 || step == side { 0.0 } else { random.f32() * 4.0 };
    let mut positions = Vec::new();
    for (top, z, x) in (0..2).flat_map(|top| (0..across).flat_map(move |z| (0..across).map(move |x| (top, z, x)))) {
        positions.push([jitter(x), top as f32, jitter(z)]);
    }
    let mut triangles = Vec::new();
    for (x, z) in (0..side).flat_map(|z| (0..side).map(move |x| (x, z))) {
        for top in [0, 1] {
            let [a, b, c, d] = [at(x, z, top), at(x, z + 1, top), at(x + 1, z + 1, top), at(x + 1, z, top)];
            triangles.extend(if top == 1 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
        }
    }
    for along in 0..side {
        let walls = [
            [at(along, 0, 0), at(along, 0, 1), at(along + 1, 0, 1), at(along + 1, 0, 0)],
            [at(along + 1, side, 0), at(along + 1, side, 1), at(along, side, 1), at(along, side, 0)],
            [at(0, along + 1, 0), at(0, along + 1, 1), at(0, along, 1), at(0, along, 0)],
            [at(side, along, 0), at(side, along, 1), at(side, along + 1, 1), at(side, along + 1, 0)],
        ];
        triangles.extend(walls.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]));
    }
    let mut build = Build::new();
    let slab = build.mesh(mesh("slab", &positions, &triangles, 0));
    build.place(slab, DVec3::ZERO, DVec3::ONE);
    build.point_light(DVec3::ZERO);
    build.0
}

#[test]
fn triangles_that_rounding_decides_are_decided_by_the_same_rounding() {
    let mut stage = Stage::new();
    let scene = uneven_slab(40);
    stage.set_scene(&scene);
    // As far over the top's plane as makes it edge-on or not by the last bit: 2^-16 of the coordinates' sum.
    let height = 1.0 + 201.0 / 65536.0;
    let mut caps = Vec::new();
    for y in [height, f64::from(f32::next_up(height as f32)), f64::from(f32::next_down(height as f32))] {
        let edit = LightEdit { position: Some(DVec3::new(-1.0, y, 200.0)), ..LightEdit::default() };
        let mut settings = Settings {
            technique: Technique::ZFail,
            show: Show::Stencil,
            lights: [(0, edit)].into(),
            ..seen_from(DVec3::new(-60.0, 90.0, 100.0), DVec3::new(150.0, 0.0, 150.0), [64, 36])
        };
        settings.culling.on = false;
        assert!(assert_equal(&mut stage, &scene, &settings, &format!("light at height {y}")) > 0);
        let shot = stage.shoot(&settings, &scene);
        let parts = volume_parts(&stage.context, &stage.renderer, &shot.plan).unwrap();
        let cap = parts.iter().find(|(part, _)| part.part == Part::LightCapKept).map_or(0, |(_, indices)| indices.len() / 3);
        caps.push(cap);
    }
    assert!(caps.iter().any(|cap| *cap != caps[0]), "a last bit says nothing: {caps:?}");
}
