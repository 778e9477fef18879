//! Exact stencil integers on tiny scenes, each variant: the eye outside all volumes, inside one,
//! inside three, with a caster across the near plane, with open and mirrored casters and every kind
//! of light. What the integers must be is told by rays ([`obscura::truth`]).
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::{Build, Stage, cube, mesh, seen_from, square};
use glam::DVec3;
use obscura::frame::{Method, Reason};
use obscura::scene::{LightKind, Scene};
use obscura::settings::{Culling, Settings, Show, Technique};
use obscura::truth::World;

const SIZE: [u32; 2] = [160, 90];
const EXACT: [Technique; 4] = [Technique::ZFail, Technique::ExactZPass, Technique::OneSided, Technique::PerPolygon];

/// A floor, and cubes of half side `half` at the places given.
fn cubes_over_floor(places: &[(f64, f64, f64)], half: f64) -> Build {
    let mut build = Build::new();
    build.floor(0.0, 30.0);
    let cube = build.mesh(cube(0));
    for &(x, y, z) in places {
        build.place(cube, DVec3::new(x, y, z), DVec3::splat(half));
    }
    build
}

/// Stencil values, what they must be where the rays agree, and how each volume was counted.
type Measured = (Vec<u8>, Vec<Option<u8>>, Vec<(Method, Reason)>);

/// The stencil of one light, and what it must be.
fn measure(stage: &mut Stage, scene: &Scene, settings: &Settings, technique: Technique) -> Measured {
    let settings = Settings { technique, show: Show::Stencil, ..settings.clone() };
    let shot = stage.shoot(&settings, scene);
    let world = World::new(scene, &shot.pose);
    let expected = world.counts(&shot.plan.views[0].camera, &shot.pose.lights[settings.light], settings.size);
    let methods = shot.plan.volumes.iter().map(|volume| (volume.method, volume.reason)).collect();
    (stage.stencil(), expected, methods)
}

/// Every decided pixel holds the count that rays give; returns the largest one and the methods used.
fn assert_exact(scene: &Scene, settings: &Settings, technique: Technique) -> (u8, Vec<(Method, Reason)>) {
    let mut stage = Stage::new();
    stage.set_scene(scene);
    let (stencil, expected, methods) = measure(&mut stage, scene, settings, technique);
    let decided = expected.iter().flatten().count();
    assert!(decided > 1000, "only {decided} decided pixels: the view tells little");
    let wrong: Vec<_> = (0..stencil.len()).filter(|&i| expected[i].is_some_and(|count| count != stencil[i])).collect();
    if let Some(&first) = wrong.first() {
        let (x, y) = (first % SIZE[0] as usize, first / SIZE[0] as usize);
        panic!(
            "{}: {} of {decided} decided pixels wrong, the first at {x},{y}: {} instead of {:?}; {methods:?}",
            technique.name(),
            wrong.len(),
            stencil[first],
            expected[first],
        );
    }
    (expected.into_iter().flatten().max().unwrap(), methods)
}

#[test]
fn the_eye_outside_all_volumes() {
    let mut build = cubes_over_floor(&[(-2.0, 1.5, 0.0), (1.0, 2.0, -1.0), (1.2, 3.8, -1.0)], 0.7);
    build.point_light(DVec3::new(1.0, 8.0, 0.5));
    let scene = build.0;
    let settings = seen_from(DVec3::new(4.0, 5.0, 9.0), DVec3::new(0.0, 1.0, 0.0), SIZE);
    for technique in EXACT.into_iter().chain([Technique::ZPass]) {
        let (largest, methods) = assert_exact(&scene, &settings, technique);
        assert_eq!(largest, 2, "one cube's shadow falls into another's");
        let expected = match technique {
            Technique::ZPass => (Method::ZPass, Reason::Technique),
            Technique::ExactZPass => (Method::ExactZPass, Reason::SurfaceCovers),
            _ => (Method::ZFail, Reason::SurfaceCovers),
        };
        assert!(methods.iter().all(|&method| method == expected), "{methods:?}");
    }
}

/// A cube between the light and the eye; three of them, one above the other.
fn eye_in_shadow(volumes: u8) -> (Scene, Settings) {
    let places: Vec<_> = (0..volumes).map(|i| (0.0, 6.0 + 2.5 * f64::from(i), 0.0)).collect();
    let mut build = cubes_over_floor(&places, 1.0);
    build.point_light(DVec3::new(0.1, 16.0, 0.2));
    let eye = DVec3::new(0.3, 1.0, 0.2);
    let scene = build.0;
    let settings = seen_from(eye, DVec3::new(5.0, 0.0, -3.0), SIZE);
    (scene, settings)
}

#[test]
fn the_eye_inside_one_volume() {
    let (scene, settings) = eye_in_shadow(1);
    for technique in EXACT {
        assert_eq!(assert_exact(&scene, &settings, technique).0, 1);
    }
}

#[test]
fn the_eye_inside_three_volumes() {
    let (scene, settings) = eye_in_shadow(3);
    for technique in EXACT {
        assert_eq!(assert_exact(&scene, &settings, technique).0, 3);
    }
}

#[test]
fn z_pass_misses_exactly_the_volumes_that_hold_the_eye() {
    for volumes in [1u8, 3] {
        let (scene, settings) = eye_in_shadow(volumes);
        let mut stage = Stage::new();
        stage.set_scene(&scene);
        let (stencil, expected, _) = measure(&mut stage, &scene, &settings, Technique::ZPass);
        let decided = stencil.iter().zip(&expected).filter_map(|(&found, expected)| expected.map(|count| (found, count)));
        for (found, count) in decided {
            assert_eq!(found, count.wrapping_sub(volumes));
        }
    }
}

#[test]
fn a_caster_across_the_near_plane() {
    // The eye stands a hand's breadth before a cube's face and looks along it.
    let mut build = cubes_over_floor(&[(0.0, 1.5, 0.0), (3.0, 2.0, -4.0)], 1.0);
    build.point_light(DVec3::new(-2.0, 7.0, 3.0));
    let scene = build.0;
    let settings = seen_from(DVec3::new(1.04, 1.6, 0.5), DVec3::new(1.5, 1.2, -3.0), SIZE);
    for technique in EXACT {
        let (_, methods) = assert_exact(&scene, &settings, technique);
        assert_eq!(methods[0], (Method::ZFailCompared, Reason::AcrossNearPlane));
        assert_ne!(methods[1].1, Reason::AcrossNearPlane);
    }
}

#[test]
fn the_eye_inside_a_caster() {
    let mut build = cubes_over_floor(&[(0.0, 2.0, 0.0), (4.0, 2.0, -4.0)], 1.0);
    build.point_light(DVec3::new(-2.0, 9.0, 3.0));
    let scene = build.0;
    let settings = seen_from(DVec3::new(0.2, 2.1, 0.1), DVec3::new(3.0, 0.5, -3.0), SIZE);
    for technique in EXACT {
        let (_, methods) = assert_exact(&scene, &settings, technique);
        assert_eq!(methods[0], (Method::ZFailCompared, Reason::AcrossNearPlane));
    }
}

/// A sheet, a box without lid, and a fan of three triangles on one edge.
fn open_casters(material: usize) -> Build {
    let mut build = Build::new();
    build.floor(0.0, 30.0);
    let sheet = build.mesh(square(material));
    build.place(sheet, DVec3::new(-3.0, 2.5, 0.0), DVec3::ONE);
    let corners = [
        [-1.0, 0.0, -1.0],
        [1.0, 0.0, -1.0],
        [1.0, 0.0, 1.0],
        [-1.0, 0.0, 1.0],
        [-1.0, 1.5, -1.0],
        [1.0, 1.5, -1.0],
        [1.0, 1.5, 1.0],
        [-1.0, 1.5, 1.0],
    ];
    let sides: Vec<[u32; 3]> = (0..4u32).flat_map(|i| [[i, (i + 1) % 4 + 4, (i + 1) % 4], [i, i + 4, (i + 1) % 4 + 4]]).collect();
    let open_box = build.mesh(mesh("open box", &corners, &sides, material));
    build.place(open_box, DVec3::new(0.5, 1.0, 0.0), DVec3::ONE);
    let fan = [[0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [1.5, 1.0, 0.2], [-0.6, 1.2, 1.1], [-0.7, 0.8, -1.2]];
    let fan = build.mesh(mesh("fan", &fan, &[[0, 1, 2], [0, 1, 3], [1, 0, 4]], material));
    build.place(fan, DVec3::new(3.5, 1.0, 0.5), DVec3::ONE);
    build
}

#[test]
fn open_and_non_manifold_casters_cast_from_every_triangle() {
    for light in [DVec3::new(0.5, 9.0, 1.0), DVec3::new(6.0, 1.9, 4.0), DVec3::new(-1.0, 0.6, 3.0)] {
        let mut build = open_casters(1);
        build.point_light(light);
        let scene = build.0;
        let settings = seen_from(DVec3::new(2.0, 6.0, 9.0), DVec3::new(0.0, 1.0, 0.0), SIZE);
        for technique in EXACT {
            let (largest, _) = assert_exact(&scene, &settings, technique);
            assert!(largest >= 1);
        }
    }
}

#[test]
fn an_open_caster_culled_from_behind_goes_by_compared_z_fail() {
    let mut build = open_casters(0);
    build.point_light(DVec3::new(0.5, 9.0, 1.0));
    let scene = build.0;
    let settings = seen_from(DVec3::new(2.0, 6.0, 9.0), DVec3::new(0.0, 1.0, 0.0), SIZE);
    for technique in EXACT {
        let (_, methods) = assert_exact(&scene, &settings, technique);
        assert!(methods.iter().all(|&method| method == (Method::ZFailCompared, Reason::SurfaceMayBeMissing)), "{methods:?}");
    }
}

#[test]
fn mirrored_casters_count_like_others() {
    let mut build = cubes_over_floor(&[], 1.0);
    let wedge_corners =
        [[-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [1.0, 0.0, 1.0], [-1.0, 0.0, 1.0], [-1.0, 1.5, -1.0], [-1.0, 1.5, 1.0]];
    let wedge = [[0, 1, 2], [0, 2, 3], [0, 4, 1], [2, 5, 3], [1, 4, 5], [1, 5, 2], [0, 3, 5], [0, 5, 4]];
    let wedge = build.mesh(mesh("wedge", &wedge_corners, &wedge, 0));
    assert!(build.0.meshes[wedge].topology.report().is_solid(), "the test's wedge is a solid");
    build.place(wedge, DVec3::new(-2.0, 1.0, 0.0), DVec3::ONE);
    build.place(wedge, DVec3::new(2.0, 1.0, 0.0), DVec3::new(-1.0, 1.0, 1.0));
    build.place(wedge, DVec3::new(0.0, 3.5, -1.0), DVec3::new(-1.0, -0.7, -1.3));
    build.point_light(DVec3::new(0.7, 8.0, 2.0));
    let scene = build.0;
    let settings = seen_from(DVec3::new(1.0, 5.0, 9.0), DVec3::new(0.0, 1.0, 0.0), SIZE);
    for technique in EXACT.into_iter().chain([Technique::ZPass]) {
        assert_exact(&scene, &settings, technique);
    }
}

#[test]
fn directional_and_spot_lights() {
    for kind in [LightKind::Directional, LightKind::Spot { inner: 0.3, outer: 0.6 }] {
        let mut build = cubes_over_floor(&[(-2.0, 1.5, 0.0), (1.0, 2.0, -1.0), (1.4, 4.2, -1.3)], 0.7);
        build.light(kind, DVec3::new(3.0, 9.0, 2.0), DVec3::new(-0.3, -1.0, -0.2), 100.0);
        let scene = build.0;
        let outside = seen_from(DVec3::new(4.0, 5.0, 9.0), DVec3::new(0.0, 1.0, 0.0), SIZE);
        let inside = seen_from(DVec3::new(1.0 - 0.12, 0.5, -1.0 - 0.1), DVec3::new(-3.0, 0.4, 1.0), SIZE);
        for technique in EXACT {
            assert_exact(&scene, &outside, technique);
            assert_exact(&scene, &inside, technique);
        }
    }
}

#[test]
fn an_eye_on_a_volumes_boundary_goes_by_z_fail() {
    // Light and eye lie in the plane of the cube's face x = 1: the side of its volume holds the eye.
    let mut build = cubes_over_floor(&[(0.0, 3.0, 0.0)], 1.0);
    build.point_light(DVec3::new(1.0, 9.0, 0.0));
    let scene = build.0;
    let settings = seen_from(DVec3::new(1.0, 0.8, 0.0), DVec3::new(0.2, 0.5, 4.0), SIZE);
    let (_, methods) = assert_exact(&scene, &settings, Technique::ExactZPass);
    assert_eq!(methods[0], (Method::ZFail, Reason::EyeOnBoundary));
}

#[test]
fn without_depth_clamp_exact_z_pass_is_z_fail_and_says_so() {
    let (scene, settings) = eye_in_shadow(1);
    let settings = Settings { technique: Technique::ExactZPass, ..settings };
    let capabilities = obscura::frame::Capabilities { depth_clip_control: false, ..obscura::frame::Capabilities::complete() };
    let (_, plan) = obscura::director::stage(&settings, &scene, &capabilities).unwrap();
    assert!(plan.volumes.iter().all(|volume| volume.method == Method::ZFail && volume.reason == Reason::NoDepthClamp));
    assert!(plan.notes.iter().any(|note| note.contains("depth clamp")), "{:?}", plan.notes);
}

/// Pixels that rays decide, as (found, what rays count).
fn decided(scene: &Scene, settings: &Settings, technique: Technique) -> Vec<(u8, u8)> {
    let mut stage = Stage::new();
    stage.set_scene(scene);
    let (stencil, expected, _) = measure(&mut stage, scene, settings, technique);
    stencil.into_iter().zip(expected).filter_map(|(found, expected)| expected.map(|count| (found, count))).collect()
}

#[test]
fn parity_is_the_counts_lowest_bit() {
    // One cube's shadow falls into another's: two volumes over one pixel are none to parity.
    let mut build = cubes_over_floor(&[(-2.0, 1.5, 0.0), (1.0, 2.0, -1.0), (1.2, 3.8, -1.0)], 0.7);
    build.point_light(DVec3::new(1.0, 8.0, 0.5));
    let settings = seen_from(DVec3::new(4.0, 5.0, 9.0), DVec3::new(0.0, 1.0, 0.0), SIZE);
    let pixels = decided(&build.0, &settings, Technique::Parity);
    assert!(pixels.iter().all(|&(found, count)| found == count % 2));
    let of = |wanted: u8| pixels.iter().filter(|(_, count)| *count == wanted).count();
    assert!(of(1) > 100 && of(2) > 20, "{} once, {} twice in shadow", of(1), of(2));
}

#[test]
fn to_parity_light_and_shadow_change_places_for_an_eye_in_shadow() {
    let (scene, settings) = eye_in_shadow(1);
    let pixels = decided(&scene, &settings, Technique::Parity);
    assert!(pixels.iter().all(|&(found, count)| found == 1 - count));
}

#[test]
fn a_far_plane_takes_the_shadows_of_z_fail_and_leaves_those_of_z_pass() {
    // Seen from above: all surfaces lie before the far plane, but the volumes go on below the floor.
    let mut build = cubes_over_floor(&[(-2.0, 1.5, 0.0), (1.0, 2.0, -1.0)], 0.7);
    build.point_light(DVec3::new(1.0, 8.0, 0.5));
    let scene = build.0;
    let settings = seen_from(DVec3::new(0.0, 13.0, 2.0), DVec3::new(0.0, 0.0, 0.0), SIZE);
    for technique in [Technique::ZFail, Technique::OneSided, Technique::PerPolygon] {
        assert_exact(&scene, &settings, technique);
        let cut = Settings { far: Some(15.0), ..settings.clone() };
        let pixels = decided(&scene, &cut, technique);
        let lost = pixels.iter().filter(|&&(found, count)| count > 0 && found == count - 1).count();
        let kept = pixels.iter().filter(|&&(found, count)| count > 0 && found == count).count();
        println!("{}: {lost} shadows lost, {kept} kept", technique.name());
        assert!(lost > 100, "{}: what ends beyond the far plane ends nowhere", technique.name());
        assert!(pixels.iter().all(|&(found, count)| found == count || found == count.wrapping_sub(1)));
    }
    for technique in [Technique::ZPass, Technique::ExactZPass] {
        assert_exact(&scene, &Settings { far: Some(15.0), ..settings.clone() }, technique);
    }
}

/// How many decided pixels are wrong, of how many.
fn wrong(scene: &Scene, settings: &Settings, technique: Technique) -> (usize, usize) {
    let pixels = decided(scene, settings, technique);
    (pixels.iter().filter(|(found, count)| found != count).count(), pixels.len())
}

/// How each caster is counted.
fn methods(scene: &Scene, settings: &Settings, technique: Technique) -> Vec<(Method, Reason)> {
    let mut stage = Stage::new();
    stage.set_scene(scene);
    measure(&mut stage, scene, settings, technique).2
}

#[test]
fn zp_plus_counts_the_near_plane_first() {
    let (scene, settings) = eye_in_shadow(3);
    assert_eq!(assert_exact(&scene, &settings, Technique::ZPlus).0, 3);
    let methods = methods(&scene, &settings, Technique::ZPlus);
    assert!(methods.iter().all(|&method| method == (Method::ZPlus, Reason::OverNearRectangle)), "{methods:?}");
}

#[test]
fn zp_plus_with_a_light_before_the_eye() {
    // The light shines towards the eye, past a cube whose shadow's border crosses the near rectangle.
    let mut build = cubes_over_floor(&[(0.0, 1.2, 0.0), (3.0, 1.2, -1.0)], 0.7);
    build.point_light(DVec3::new(0.3, 1.9, -4.0));
    let scene = build.0;
    let settings = seen_from(DVec3::new(1.26, 0.65, 4.0), DVec3::new(1.2, 0.5, -4.0), SIZE);
    let methods = methods(&scene, &settings, Technique::ZPlus);
    assert_eq!(methods[0], (Method::ZPlusMirrored, Reason::OverNearRectangle));
    assert_eq!(methods[1], (Method::ZPass, Reason::NearRectangleClear));
    let (z_pass_wrong, of) = wrong(&scene, &settings, Technique::ZPass);
    let (cracks, _) = wrong(&scene, &settings, Technique::ZPlus);
    println!("{cracks} cracks, z-pass wrong in {z_pass_wrong} of {of}");
    assert!(z_pass_wrong > 1000 && of - z_pass_wrong > 1000, "the shadow's border crosses the near rectangle");
    assert!(cracks <= 5, "{cracks}");
}

#[test]
fn a_light_on_the_near_plane_sees_nothing_through_it_and_zp_plus_goes_by_z_fail() {
    let mut build = cubes_over_floor(&[(0.0, 3.0, -2.0)], 1.0);
    build.point_light(DVec3::new(2.0, 7.0, 5.9));
    let scene = build.0;
    let settings = seen_from(DVec3::new(0.0, 1.0, 6.0), DVec3::new(0.0, 1.0, 0.0), SIZE);
    let (_, methods) = assert_exact(&scene, &settings, Technique::ZPlus);
    assert_eq!(methods[0], (Method::ZFail, Reason::LightOnNearPlane));
}

#[test]
fn zp_plus_with_directional_and_spot_lights() {
    for kind in [LightKind::Directional, LightKind::Point] {
        let mut build = cubes_over_floor(&[(-2.0, 1.5, 0.0), (1.0, 2.0, -1.0), (1.4, 4.2, -1.3)], 0.7);
        build.light(kind, DVec3::new(3.0, 9.0, 2.0), DVec3::new(-0.3, -1.0, -0.2), 100.0);
        let scene = build.0;
        let outside = seen_from(DVec3::new(4.0, 5.0, 9.0), DVec3::new(0.0, 1.0, 0.0), SIZE);
        assert_exact(&scene, &outside, Technique::ZPlus);
        let inside = seen_from(DVec3::new(1.0 - 0.12, 0.5, -1.0 - 0.1), DVec3::new(-3.0, 0.4, 1.0), SIZE);
        assert_exact(&scene, &inside, Technique::ZPlus);
        let by_light = methods(&scene, &inside, Technique::ZPlus);
        assert!(by_light.iter().any(|(method, _)| matches!(method, Method::ZPlus | Method::ZPlusMirrored)), "{by_light:?}");
    }
}

#[test]
fn beams_shadows_end_fifty_metres_from_the_light() {
    // The light at 12 m is within reach of the floor; in the same scene six times as large it is not.
    let place = |scale: f64| {
        let mut build = Build::new();
        build.floor(0.0, 30.0 * scale);
        let cube = build.mesh(cube(0));
        build.place(cube, DVec3::new(1.0, 2.0, -1.0) * scale, DVec3::splat(0.7 * scale));
        build.point_light(DVec3::new(1.0, 12.0, 0.5) * scale);
        (build.0, seen_from(DVec3::new(4.0, 5.0, 9.0) * scale, DVec3::new(0.0, 1.0, 0.0), SIZE))
    };
    let (scene, settings) = place(1.0);
    assert_eq!(wrong(&scene, &settings, Technique::Beam).0, 0);
    let (scene, settings) = place(6.0);
    let pixels = decided(&scene, &settings, Technique::Beam);
    let shadowed = pixels.iter().filter(|(_, count)| *count > 0).count();
    let lost = pixels.iter().filter(|(found, count)| *count > 0 && *found == 0).count();
    assert!(shadowed > 100 && lost * 2 > shadowed, "{lost} of {shadowed} lost");
}

#[test]
fn merged_volumes_are_as_many_triangles_in_fewer_draws() {
    let places: Vec<_> = (0..9).map(|at| (f64::from(at % 3) * 3.0 - 3.0, 1.0, f64::from(at / 3) * -3.0)).collect();
    let mut build = cubes_over_floor(&places, 0.5);
    build.point_light(DVec3::new(1.0, 8.0, 2.0));
    let settings = seen_from(DVec3::new(0.0, 3.0, 7.0), DVec3::ZERO, SIZE);
    let mut stage = Stage::new();
    stage.set_scene(&build.0);
    let mut drawn = |caster_scissors| {
        let culling = Culling { caster_scissors, ..settings.culling };
        let settings = Settings { culling, technique: Technique::ZFail, show: Show::Stencil, ..settings.clone() };
        let stats = stage.shoot(&settings, &build.0).stats;
        (stats.draws, stats.triangles, stats.volume_triangles, stage.stencil())
    };
    let (merged, apart) = (drawn(false), drawn(true));
    // A cube's sides are 6 edges or fewer, 2 triangles each, and its caps.
    assert!(merged.2 >= 9 * 12, "{} triangles of volumes", merged.2);
    assert_eq!((merged.1, merged.2), (apart.1, apart.2));
    assert!(merged.0 + 8 <= apart.0, "{} draws and {}", merged.0, apart.0);
    assert!(merged.3 == apart.3, "the same stencil");
}
