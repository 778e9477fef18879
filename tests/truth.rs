//! Pictures against exact rays.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use common::{Build, Stage, assert_exact, cube, mesh, seen_from, square};
use glam::DVec3;
use obscura::cli::VerifyRequest;
use obscura::frame::{Camera, identity_color};
use obscura::headless::verify::{Report, verify};
use obscura::scene::{AlphaMode, PosedLight, Scene, pose, stock};
use obscura::settings::{CameraChoice, Mirrors, SceneChoice, Settings, Show, Technique};
use obscura::truth::{Verdict, World};

const EXACT: [Technique; 2] = [Technique::ZFail, Technique::ExactZPass];

/// A cube between the light and the eye.
fn eye_in_shadow() -> (Scene, Settings) {
    let mut build = Build::new();
    build.floor(0.0, 30.0);
    let cube = build.mesh(cube(0));
    build.place(cube, DVec3::new(0.0, 6.0, 0.0), DVec3::ONE);
    build.point_light(DVec3::new(0.1, 16.0, 0.2));
    (build.0, seen_from(DVec3::new(0.3, 1.0, 0.2), DVec3::new(5.0, 0.0, -3.0), [160, 90]))
}

#[test]
fn the_exact_techniques_are_exact_with_the_eye_in_shadow() {
    let (scene, settings) = eye_in_shadow();
    for technique in EXACT {
        assert_exact(&scene, &Settings { technique, ..settings.clone() });
    }
}

#[test]
fn z_pass_is_found_wrong_with_the_eye_in_shadow() {
    let (scene, settings) = eye_in_shadow();
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let [ref found] = stage.verify(&Settings { technique: Technique::ZPass, ..settings }, &scene)[..] else { panic!() };
    assert!(found.wrong() > 1000, "{} wrong of {}", found.wrong(), found.decided);
}

/// A floor at 0 and a square of side 2 above it at 2, drawn from both sides; the lamp straight above.
fn sheet_over_floor(material: usize) -> Build {
    let mut build = Build::new();
    build.floor(0.0, 30.0);
    let sheet = build.mesh(square(material));
    build.place(sheet, DVec3::new(0.0, 2.0, 0.0), DVec3::ONE);
    build
}

/// The verdict on the middle of the picture seen from `eye` to `target`.
fn middle(scene: &Scene, eye: DVec3, target: DVec3) -> Verdict {
    let pose = pose::pose(scene, 0.0, scene.default_animation, &BTreeMap::new());
    let camera = Camera::look_at(eye, target, 0.6, 1.0, 0.1).unwrap();
    let verdicts = World::new(scene, &pose).judge(&camera, &pose.lights[0], [33, 33]);
    assert_eq!(verdicts.size(), [33, 33]);
    verdicts.pixels()[16 * 33 + 16]
}

#[test]
fn rays_tell_lit_from_shadow_and_both_sides_of_a_sheet() {
    let mut build = sheet_over_floor(1);
    build.point_light(DVec3::new(0.01, 6.0, 0.02));
    let scene = build.0;
    let from = |eye: DVec3, target: DVec3| middle(&scene, eye, target);
    assert_eq!(from(DVec3::new(4.0, 1.0, 0.0), DVec3::new(0.2, 0.0, 0.1)), Verdict::Shadow, "beneath the sheet");
    assert_eq!(from(DVec3::new(4.0, 1.0, 0.0), DVec3::new(2.5, 0.0, 0.1)), Verdict::Lit, "beside its shadow");
    assert_eq!(from(DVec3::new(0.5, 5.0, 0.5), DVec3::new(0.3, 2.0, 0.1)), Verdict::Lit, "the sheet from above");
    assert_eq!(from(DVec3::new(0.5, 0.5, 0.5), DVec3::new(0.3, 2.0, 0.1)), Verdict::Shadow, "its dark side");
    assert_eq!(from(DVec3::new(0.5, 1.0, 0.5), DVec3::new(9.0, 5.0, 0.3)), Verdict::Nothing, "the sky");
    // Twice the sheet's side, for the lamp is 4 above it and 6 above the floor: a shadow of 1.5.
    assert_eq!(from(DVec3::new(4.0, 3.0, 0.0), DVec3::new(1.49, 0.0, 0.0)), Verdict::Edge);
}

#[test]
fn where_two_triangles_join_a_rasteriser_may_take_either() {
    let mut build = sheet_over_floor(1);
    build.point_light(DVec3::new(0.01, 6.0, 0.02));
    // The floor's two triangles join where x is z; nothing else is near.
    let at = |x: f64, z: f64| middle(&build.0, DVec3::new(4.0, 2.0, 0.5), DVec3::new(x, 0.0, z));
    for joint in [2.5, 3.25, -4.0] {
        assert_eq!(at(joint, joint), Verdict::Edge, "{joint}");
        for beside in [0.01, -0.01] {
            assert_eq!(at(joint, joint + beside), Verdict::Lit, "{joint} {beside}: half a pixel's width does not matter");
        }
    }
}

/// Two sheets of one mesh, the border of the left one at x = 0.
fn sheets(right: [[f32; 3]; 4]) -> Build {
    let mut build = Build::new();
    let left = [[-3.0, -3.0, 0.0], [0.0, -3.0, 0.0], [0.0, 3.0, 0.0], [-3.0, 3.0, 0.0]];
    let corners: Vec<_> = left.into_iter().chain(right).collect();
    let sheets = mesh("sheets", &corners, &[[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]], 0);
    let sheets = build.mesh(sheets);
    build.place(sheets, DVec3::ZERO, DVec3::ONE);
    build.point_light(DVec3::new(0.3, 0.2, 9.0));
    build
}

#[test]
fn outlines_within_one_object_are_edges_and_joints_are_not() {
    // A pixel is 0.02 wide here: its places lie 0.005 beside its centre.
    let at = |build: &Build, x: f64| {
        let pose = pose::pose(&build.0, 0.0, build.0.default_animation, &BTreeMap::new());
        let fov = 2.0 * (0.01f64 * 33.0 / 5.0).atan();
        let camera = Camera::look_at(DVec3::new(x, 0.1, 5.0), DVec3::new(x, 0.1, 0.0), fov, 1.0, 0.1).unwrap();
        World::new(&build.0, &pose).judge(&camera, &pose.lights[0], [33, 33]).pixels()[16 * 33 + 16]
    };
    let behind = sheets([[-1.0, -3.0, -0.2], [3.0, -3.0, -0.2], [3.0, 3.0, -0.2], [-1.0, 3.0, -0.2]]);
    let folded = sheets([[0.0, -3.0, 0.0], [3.0, -3.0, -2.0], [3.0, 3.0, -2.0], [0.0, 3.0, 0.0]]);
    for x in [-0.003, 0.003] {
        assert_eq!(at(&behind, x), Verdict::Edge, "{x}: the left one's outline is in the pixel");
        assert_eq!(at(&folded, x), Verdict::Lit, "{x}: the sheet goes on");
    }
    for x in [-0.05, 0.5] {
        assert_eq!(at(&behind, x), Verdict::Lit, "{x}");
    }
}

#[test]
fn rays_know_culling_the_near_plane_and_what_is_blended() {
    let below = (DVec3::new(0.5, 0.5, 0.5), DVec3::new(0.3, 2.0, 0.3));
    let mut build = sheet_over_floor(0);
    build.point_light(DVec3::new(0.01, 6.0, 0.02));
    assert_eq!(middle(&build.0, below.0, below.1), Verdict::Nothing, "culled from behind");
    let beneath = (DVec3::new(4.0, 1.0, 0.0), DVec3::new(0.2, 0.0, 0.1));
    assert_eq!(middle(&build.0, beneath.0, beneath.1), Verdict::Shadow, "but it casts");
    // Closer than the near plane: seen through.
    let close = DVec3::new(0.3, 2.05, 0.3);
    assert_eq!(middle(&build.0, close, DVec3::new(0.3, 0.0, 0.31)), Verdict::Shadow, "the floor below");
    build.0.materials[0].double_sided = true;
    build.0.materials[0].alpha = AlphaMode::Blend;
    assert_eq!(middle(&build.0, below.0, below.1), Verdict::Nothing, "blended surfaces are none");
}

#[test]
fn rays_know_a_light_s_range_and_one_without_shadows() {
    let mut build = sheet_over_floor(1);
    let light = build.point_light(DVec3::new(0.01, 6.0, 0.02));
    build.0.lights[light].range = 7.0;
    let eye = DVec3::new(4.0, 1.0, 0.0);
    assert_eq!(middle(&build.0, eye, DVec3::new(2.5, 0.0, 0.1)), Verdict::Lit);
    assert_eq!(middle(&build.0, eye, DVec3::new(9.0, 0.0, 0.1)), Verdict::OutOfRange);
    let pose = pose::pose(&build.0, 0.0, build.0.default_animation, &BTreeMap::new());
    let camera = Camera::look_at(eye, DVec3::new(0.2, 0.0, 0.1), 0.6, 1.0, 0.1).unwrap();
    let world = World::new(&build.0, &pose);
    let shine = PosedLight { shadows: false, ..pose.lights[light] };
    assert_eq!(world.judge(&camera, &shine, [33, 33]).pixels()[16 * 33 + 16], Verdict::Lit);
    assert!(world.shades(DVec3::new(0.2, 1.0, 0.1), &pose.lights[light]));
    assert!(!world.shades(DVec3::new(0.2, 3.0, 0.1), &pose.lights[light]));
}

#[test]
fn a_light_inside_a_solid_shines_out_and_one_inside_soup_is_shut_in() {
    for (solid, expected) in [(true, Verdict::Lit), (false, Verdict::Shadow)] {
        let mut build = Build::new();
        build.floor(0.0, 30.0);
        let mut lamp = cube(0);
        if !solid {
            // One face less: every triangle counts, from whichever side.
            let few = lamp.indices[6..].as_chunks::<3>().0.to_vec();
            let corners: Vec<_> = lamp.positions.iter().map(|corner| corner.to_array()).collect();
            lamp = mesh("open", &corners, &few, 0);
        }
        assert_eq!(lamp.topology.report().is_solid(), solid);
        let lamp = build.mesh(lamp);
        build.place(lamp, DVec3::new(0.0, 2.0, 0.0), DVec3::ONE);
        build.point_light(DVec3::new(0.0, 2.0, 0.0));
        assert_eq!(middle(&build.0, DVec3::new(6.0, 1.0, 0.0), DVec3::new(2.3, 0.0, 0.9)), expected, "solid: {solid}");
    }
}

#[test]
fn many_lights_at_once_are_judged_as_each_alone_and_work_can_be_called_off() {
    let scene = stock::build("teapots").unwrap().unwrap();
    let pose = pose::pose(&scene, 1.0, scene.default_animation, &BTreeMap::new());
    let camera = Camera::choose(&Settings::default(), &scene, &pose).unwrap();
    let world = World::new(&scene, &pose);
    let all = world.judge_lights(&camera, &pose.lights, [64, 36], &|_| true).unwrap();
    assert_eq!(all.len(), scene.lights.len());
    for (verdicts, light) in all.iter().zip(&pose.lights) {
        assert_eq!(*verdicts, world.judge(&camera, light, [64, 36]));
    }
    assert!(world.judge_lights(&camera, &pose.lights, [64, 36], &|share| share < 0.5).is_none());
}

/// The tree changes nothing: each ray finds what a look at every triangle finds.
#[test]
fn the_tree_finds_what_every_triangle_tells() {
    let scene = stock::build("courtyard").unwrap().unwrap();
    let pose = pose::pose(&scene, 3.0, scene.default_animation, &BTreeMap::new());
    let world = World::new(&scene, &pose);
    let light = &pose.lights[0];
    let mut soup = Vec::new();
    for (node_index, _, mesh) in scene.instances().filter(|(_, node, _)| node.casts_shadow) {
        let positions = pose.positions(&scene, node_index);
        let to_world = pose.world_from_object[node_index];
        let mirrored = to_world.matrix3.determinant() < 0.0;
        for (&triangle, &both) in mesh.topology.mesh_triangles().iter().zip(mesh.topology.two_sided()) {
            let corner = |at: u32| positions[mesh.indices[(triangle * 3 + at) as usize] as usize].as_dvec3();
            soup.push(([0, 1, 2].map(|at| to_world.transform_point3(corner(at))), both, mirrored));
        }
    }
    let mut random = fastrand::Rng::with_seed(5);
    let (mut dark, points) = (0, 1500);
    for _ in 0..points {
        let at = DVec3::new(random.f64() * 14.0 - 7.0, random.f64() * 5.0, random.f64() * 10.0 - 5.0);
        let way = light.position - at;
        let crossed = soup.iter().any(|&([a, b, c], both, mirrored)| {
            // By volumes of tetrahedra, where the caster has products of its own.
            let side = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p);
            let (from, to) = (side(a, b, c).dot(at - a), side(a, b, c).dot(light.position - a));
            let turns = [way.dot((a - at).cross(b - at)), way.dot((b - at).cross(c - at)), way.dot((c - at).cross(a - at))];
            let through = turns.iter().all(|turn| *turn > 0.0) || turns.iter().all(|turn| *turn < 0.0);
            through && from * to < 0.0 && (both || (to > 0.0) != mirrored)
        });
        assert_eq!(world.shades(at, light), crossed, "{at}");
        dark += usize::from(crossed);
    }
    assert!(dark > 60 && dark < points - 60, "{dark}");
}

/// `../shared`: beside the checkout, or beside the folder of its worktrees.
fn shared() -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    ["../shared", "../../shared"].iter().map(|path| root.join(path)).find(|path| path.is_dir())
}

/// Files of a shared folder that scenes are read from.
fn files(folder: &str) -> Vec<PathBuf> {
    let Some(folder) = shared().map(|shared| shared.join(folder)) else {
        println!("no ../shared here: its {folder} are left out");
        return Vec::new();
    };
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "glb" || extension == "gltf"));
    files.sort();
    files
}

/// Random views of one scene, each by the exact techniques: not one decided pixel may be wrong.
fn assert_exact_on_random_views(scene: SceneChoice, floor: bool, count: usize) {
    let report = exact_on_random_views(Settings { scene, floor, ..Settings::default() }, count);
    let decided: usize = report.lights.iter().map(|row| row.decided).sum();
    let shadow: usize = report.lights.iter().map(|row| row.shadow).sum();
    assert!(decided > count * 2 * 160 * 90 * 8 / 10 && shadow > 500, "{report}");
}

fn exact_on_random_views(settings: Settings, count: usize) -> Report {
    let request = VerifyRequest {
        settings: Settings { size: [160, 90], ..settings },
        techniques: EXACT.to_vec(),
        light: None,
        random: Some((count, 20_261_122)),
        diff: None,
    };
    let report = verify(&request).unwrap();
    println!("{report}");
    assert_eq!((report.views, report.broken_promises()), (count, 0), "{report}");
    report
}

#[test]
fn random_views_are_exact_at_every_depth_of_mirrors() {
    for bounces in [1, 2, 8] {
        let mut reflected = vec![0; 9];
        for name in ["barbershop", "corridor", "terraces", "figure3", "kaleidoscope", "gallery"] {
            let mirrors = Mirrors { bounces, ..Mirrors::default() };
            let scene = SceneChoice::Stock(name.into());
            let report = exact_on_random_views(Settings { scene, mirrors, ..Settings::default() }, 3);
            reflected.iter_mut().zip(&report.surfaces.bounces).for_each(|(all, these)| *all += these);
        }
        let deepest = reflected.iter().rposition(|pixels| *pixels > 0).unwrap();
        assert_eq!(deepest, bounces as usize, "{reflected:?} decided pixels by reflections");
    }
}

/// Drawn with one reflection and held against two: exactly what is seen by way of two mirrors is wrong. And taken for each
/// other, mirrors are found out.
#[test]
fn what_is_seen_through_other_mirrors_is_found_wrong() {
    let scene = stock::build("barbershop").unwrap().unwrap();
    let mirrors = Mirrors { bounces: 1, ..Mirrors::default() };
    let camera = CameraChoice::Named("hall of mirrors".into());
    let settings = Settings { show: Show::Surfaces, camera, size: [160, 90], mirrors, ..Settings::default() };
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let shot = stage.shoot(&settings, &scene);
    let list = scene.mirrors_in_force(&settings.mirrors).0;
    let world = World::with_mirrors(&scene, &shot.pose, &list);
    let wrong = |bounces, mirror_of: &dyn Fn(usize) -> usize| {
        let traced = world.trace(&shot.plan.views[0].camera, &[], settings.size, bounces, &|_| true).unwrap();
        let found = traced.surfaces.compare(&shot.image, |path, instance| {
            let path: Vec<_> = path.iter().map(|mirror| mirror_of(*mirror)).collect();
            let view = shot.plan.views.iter().position(|view| view.path() == path)?;
            let number = instance.map_or(0, |instance| view * scene.instances().count() + instance + 1);
            Some(identity_color(u32::try_from(number).unwrap()))
        });
        (found.pixels.len(), found.bounces)
    };
    let (right, all) = wrong(1, &|mirror| mirror);
    assert!(right == 0 && all[0] > 1000 && all[1] > 1000, "{right} wrong, {all:?} by reflections");
    let (missing, all) = wrong(2, &|mirror| mirror);
    assert!(missing == all[2] && missing > 200, "{missing} wrong, {all:?} by reflections");
    let (other, all) = wrong(1, &|mirror| 1 - mirror);
    assert_eq!(other, all[1], "the other mirror's view");
}

#[test]
fn random_views_of_the_stock_scenes_are_exact() {
    for row in stock::TABLE {
        assert_exact_on_random_views(SceneChoice::Stock(row.name.into()), false, 6);
    }
}

#[test]
fn random_views_of_the_shared_scenes_are_exact() {
    for path in files("scenes") {
        assert_exact_on_random_views(SceneChoice::File(path), false, 4);
    }
}

#[test]
fn random_views_of_the_shared_models_are_exact() {
    for path in files("models") {
        assert_exact_on_random_views(SceneChoice::File(path), true, 6);
    }
}
