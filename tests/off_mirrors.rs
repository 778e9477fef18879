//! Light off mirrors: by hand, against rays, and on the whole.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use std::collections::BTreeMap;

use common::{Build, Stage, assert_exact, cube, mesh, seen_from};
use glam::{DVec3, Vec3};
use obscura::cli::VerifyRequest;
use obscura::director;
use obscura::frame::{Camera, Capabilities, Piece};
use obscura::headless::verify::verify;
use obscura::scene::{Pose, Scene, pose, stock};
use obscura::settings::{MirrorLight, Mirrors, SceneChoice, Settings, Show, SurfacePlace, Technique};
use obscura::truth::{Verdict, World};

/// A mirror of two metres on the floor about the origin, and a ceiling at 4 m; the lamp at (-3, 3, 0), so that its
/// reflection shines on the ceiling from x = 1.67 to 6.33, by way of x q of the mirror on -3 + (q + 3) 7 / 3.
fn hall() -> (Build, Mirrors) {
    let mut build = Build::new();
    let corners = [[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [-1.0, 0.0, -1.0]];
    let glass = build.mesh(mesh("glass", &corners, &[[0, 1, 2], [0, 2, 3]], 0));
    let node = build.place(glass, DVec3::ZERO, DVec3::ONE);
    let corners = [[-20.0, 4.0, -20.0], [20.0, 4.0, -20.0], [20.0, 4.0, 20.0], [-20.0, 4.0, 20.0]];
    let ceiling = build.mesh(mesh("ceiling", &corners, &[[0, 1, 2], [0, 2, 3]], 0));
    build.place(ceiling, DVec3::ZERO, DVec3::ONE);
    build.point_light(DVec3::new(-3.0, 3.0, 0.0));
    let edits = BTreeMap::from([(SurfacePlace { node, primitive: 0 }, true)]);
    (build, Mirrors { light: MirrorLight::Virtual, edits, ..Mirrors::default() })
}

/// With a box of a quarter of a metre somewhere.
fn with_box(at: [f64; 3]) -> (Build, Mirrors) {
    let (mut build, mirrors) = hall();
    let cube = build.mesh(cube(0));
    build.place(cube, DVec3::from(at), DVec3::splat(0.12));
    (build, mirrors)
}

fn posed(scene: &Scene, mirrors: &Mirrors) -> Pose {
    let mut pose = pose::pose(scene, 0.0, scene.default_animation, &BTreeMap::new());
    pose.add_lights_off(scene, &scene.mirrors_in_force(mirrors).0);
    pose
}

/// What rays say of the ceiling over (x, 0) in the light off the mirror.
fn over(scene: &Scene, mirrors: &Mirrors, x: f64) -> Verdict {
    let pose = posed(scene, mirrors);
    let eye = DVec3::new(x, 3.0, 0.01);
    let camera = Camera::look_at(eye, DVec3::new(x, 4.0, 0.0), 0.01, 1.0, 0.1).unwrap();
    let world = World::with_mirrors(scene, &pose, &scene.mirrors_in_force(mirrors).0);
    world.judge(&camera, &pose.lights[1], [5, 5]).pixels()[12]
}

#[test]
fn a_reflected_light_is_as_far_behind_the_mirror_and_only_before_it() {
    let (build, mirrors) = hall();
    let pose = posed(&build.0, &mirrors);
    assert_eq!(pose.lights.len(), 2);
    assert!(pose.lights[1].position.distance(DVec3::new(-3.0, -3.0, 0.0)) < 1e-12 && pose.lights[1].on);
    assert_eq!(build.0.light_name(&mirrors, 1), "light 0 off node 0");
    let (mut beneath, mirrors) = hall();
    beneath.0.lights.clear();
    beneath.point_light(DVec3::new(0.5, -2.0, 0.0));
    assert!(!posed(&beneath.0, &mirrors).lights[1].on);
}

#[test]
fn rays_bound_it_by_the_mirrors_outline() {
    let (build, mirrors) = hall();
    let ceiling = |x| over(&build.0, &mirrors, x);
    assert_eq!([1.5, 1.9, 4.0, 6.2, 6.5].map(ceiling), {
        use Verdict::{Lit, Shadow};
        [Shadow, Lit, Lit, Lit, Shadow]
    });
}

#[test]
fn rays_are_blocked_before_the_mirror_and_after_it_and_not_behind_it() {
    // The way to (4, 4, 0) leads over the middle of the mirror.
    let at = |place| {
        let (build, mirrors) = with_box(place);
        [2.5, 4.0, 5.5].map(|x| over(&build.0, &mirrors, x) == Verdict::Shadow)
    };
    assert_eq!(at([-1.5, 1.5, 0.0]), [false, true, false], "before it");
    assert_eq!(at([2.0, 2.0, 0.0]), [false, true, false], "after it");
    assert_eq!(at([-1.5, -1.5, 0.0]), [false; 3], "behind it, where the light seems to come from");
    assert_eq!(at([0.0, 0.0, 0.0]), [false, true, false], "through it");
}

/// Casters before, after, behind, on and through the mirror; every light, seen by the eye and by way of the mirror.
#[test]
fn the_stencil_says_the_same() {
    let places = [[-1.5, 1.5, 0.0], [2.0, 2.0, 0.0], [-1.5, -1.5, 0.0], [0.0, 0.12, 0.3], [0.1, 0.05, -0.4], [-1.1, 0.0, 0.6]];
    for place in places {
        let (build, mirrors) = with_box(place);
        let eye = DVec3::new(3.0, 1.5, 4.5);
        for technique in [Technique::ZFail, Technique::Wide, Technique::Auto] {
            let settings =
                Settings { technique, mirrors: mirrors.clone(), ..seen_from(eye, DVec3::new(2.5, 2.5, 0.0), [160, 90]) };
            let found = assert_exact(&build.0, &settings);
            assert_eq!(found.len(), 2);
            assert!(
                found[1].lit > 300 && found[1].shadow > 300,
                "{place:?}: {} lit, {} in shadow",
                found[1].lit,
                found[1].shadow
            );
        }
    }
}

/// What reaches through the mirror is cut, for the mirror's own light only.
#[test]
fn only_what_reaches_through_the_mirror_is_cut() {
    let (build, mirrors) = with_box([0.0; 3]);
    let settings = Settings { mirrors, ..seen_from(DVec3::new(1.0, 2.5, 9.0), DVec3::new(1.5, 2.0, 0.0), [160, 90]) };
    let plan = director::stage(&settings, &build.0, &Capabilities::complete()).unwrap().1;
    let of = |light: usize, instance: usize| {
        let volumes = plan.volumes.iter().filter(move |volume| volume.light == light && volume.instance == instance);
        volumes.filter(|volume| volume.view == 0).map(|volume| (volume.piece, volume.reflected.is_some())).collect::<Vec<_>>()
    };
    assert!(matches!(of(0, 2)[..], [(Piece::Whole, false)]));
    assert!(matches!(of(1, 2)[..], [(Piece::Before { .. }, false), (Piece::Before { .. }, true)]), "{:?}", of(1, 2));
    assert!(matches!(of(1, 1)[..], [(Piece::Whole, false), (Piece::Whole, true)]), "{:?}", of(1, 1));
    assert!(matches!(of(1, 0)[..], [(Piece::Primitive(0), false)]), "the beam: {:?}", of(1, 0));
    // The beam's batch has a bit of its own, below the mirror's.
    let bits = plan.bits_in_use();
    assert_eq!((plan.budget.verdict_mask, bits.mirror_mask, bits.verdict_mask, bits.count_mask), (0, 0x80, 0x40, 0x3f));
}

/// Where there is light off the mirror the picture is brighter, by as much as the light is, and nowhere else.
#[test]
fn it_is_added_where_it_falls() {
    let (build, mirrors) = hall();
    let eye = DVec3::new(1.0, 1.0, 9.0);
    let settings = |light| Settings {
        mirrors: Mirrors { light, ..mirrors.clone() },
        technique: Technique::ZFail,
        ..seen_from(eye, DVec3::new(1.5, 3.0, 0.0), [160, 90])
    };
    let mut stage = Stage::new();
    stage.set_scene(&build.0);
    let without = stage.shoot(&settings(MirrorLight::Off), &build.0).image;
    let with = stage.shoot(&settings(MirrorLight::Virtual), &build.0).image;
    let verdict = Settings { show: Show::Shadow, light: 1, ..settings(MirrorLight::Virtual) };
    let verdict = stage.shoot(&verdict, &build.0).image;
    let mut brighter = 0;
    for ((before, after), lit) in without.pixels().zip(with.pixels()).zip(verdict.pixels()) {
        // One light alone is not added up in floats: the last step may be rounded otherwise.
        let more = i16::from(after.0[1]) - i16::from(before.0[1]);
        assert!(more >= -1, "{before:?} {after:?}");
        brighter += usize::from(more > 1);
        assert!(lit.0[0] == 255 || more <= 1, "brighter in shadow: {before:?} {after:?}");
    }
    assert!(brighter > 500, "{brighter}");
}

/// The cheap alternative: the light that falls on the mirror, over the surface of the room's box.
#[test]
fn more_ambient_light_is_what_comes_off_spread_evenly() {
    let (build, mirrors) = hall();
    let mirrors = Mirrors { light: MirrorLight::Ambient, ..mirrors };
    let settings = Settings { mirrors, ..seen_from(DVec3::new(1.0, 1.0, 9.0), DVec3::new(1.5, 3.0, 0.0), [160, 90]) };
    let plan = director::stage(&settings, &build.0, &Capabilities::complete()).unwrap().1;
    let intensity = build.0.lights[0].intensity * build.0.lights[0].color;
    // Two triangles, their middles a third off the mirror's.
    let flux: f64 = [[1.0, 1.0, -1.0], [-1.0, 1.0, -1.0]]
        .iter()
        .map(|[third_x, first_z, last_z]| {
            let middle = DVec3::new(third_x / 3.0, 0.0, (first_z + 2.0 * last_z) / 3.0);
            let way = DVec3::new(-3.0, 3.0, 0.0) - middle;
            2.0 * way.normalize().y / way.length_squared()
        })
        .sum();
    let surface = 2.0 * (40.0 * 40.0 + 2.0 * 40.0 * 4.0);
    let expected = flux / (surface * std::f64::consts::PI);
    let ratio = Vec3::from(plan.reflections.ambient) / intensity / expected as f32;
    assert!((ratio - 1.0).abs().max_element() < 0.02, "{ratio}");
    assert_eq!(plan.reflections.lights, 0);
}

/// Random views of every scene with mirrors, most of them of light off a mirror.
#[test]
fn random_views_of_light_off_mirrors_are_exact() {
    for row in stock::TABLE {
        let scene = stock::build(row.name).unwrap().unwrap();
        // Light does not pass portals.
        if scene.mirrors.iter().all(|mirror| mirror.exit.is_some()) {
            continue;
        }
        let mirrors = Mirrors { bounces: 2, light: MirrorLight::Virtual, ..Mirrors::default() };
        let scene = SceneChoice::Stock(row.name.into());
        let request = VerifyRequest {
            settings: Settings { scene, mirrors, size: [160, 90], ..Settings::default() },
            techniques: vec![Technique::ZFail, Technique::Wide],
            light: None,
            random: Some((4, 20_261_122)),
            diff: None,
        };
        let report = verify(&request).unwrap();
        println!("{report}");
        assert_eq!(report.broken_promises(), 0, "{report}");
        assert!(report.lights.iter().any(|light| light.name.contains(" off ")), "{report}");
    }
}
