//! Arguments to settings, and settings to arguments.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // a test may stop where it stands

use std::collections::BTreeMap;
use std::path::PathBuf;

use glam::Vec3;
use proptest::prelude::*;

use super::*;
use crate::scene::{Animation, BuiltInSlide, Light, Scene};
use crate::settings::{
    Accumulation, AreaMode, Backend, Board, CameraChoice, Complexity, Counting, Csg, Culling, DecalMode, Diagram, Dissolve,
    Failure, Halos, HybridPart, LEAST_TEXTURE, LastBounce, LightBounds, LightEdit, Lighting, MAX_AREA_SAMPLES, MAX_BOUNCES,
    MAX_COUNT_BITS, MAX_FRAMES, MAX_HALO_WIDTH, MOST_TEXTURE, MirrorLight, MirrorMode, Mirrors, Operation, Overflow, Pattern,
    Planar, PlanarMode, Playground, Shading, Show, SlideChoice, SurfacePlace, Technique, Texturing, boards,
};

fn command(line: &str) -> Result<Command, InputError> {
    parse(shlex::split(line).unwrap()).unwrap_or_else(|error| panic!("{line}: {error}")).command()
}

fn settings(line: &str) -> Settings {
    match command(line).unwrap() {
        Command::Render { settings, .. } => settings,
        other => panic!("{other:?}"),
    }
}

fn input_error(line: &str) -> String {
    let message = command(line).unwrap_err().to_string();
    assert!(!message.contains('\n'), "{message}");
    message
}

fn usage_error(line: &str) -> String {
    let error = parse(shlex::split(line).unwrap()).expect_err("should be wrong usage");
    assert_eq!(error.exit_code(), 2);
    error.to_string()
}

#[test]
fn clap_finds_no_fault_in_the_definition() {
    Cli::command().debug_assert();
}

#[test]
fn every_argument_reaches_its_setting() {
    let got = settings(
        "obscura render fox.glb --out a.png --technique z-pass --count-bits 3 --overflow naive --complexity fragments --diagram both-faces --decals offset --board masks --numbers --show stencil --failure saturating --light 2 --size 64x32 --samples 4 \
         --eye -1,2.5,3e2 --target 0,0,-1 --fov 33.5 --far 7.5 --time 1.25 --animation 3 --floor --exposure -1.5 \
         --no-smooth-terminator --light-edit '1:on=false,shadows=true,position=1;-2;3,color=1;0.5;0,intensity=7,range=9' \
         --light-edit 1:radius=0.5,slide=stained-glass --area-samples 16 --area-mode bits --light-sample 3 --accumulate 256 \
         --accumulation 8-bit --texturing once --shading deferred --labels --no-culling --light-bounds sphere --caster-scissors --depth-bounds on --footprints off --clamping off --silhouettes compute \
         --mirrors stencil --bounces 7 --last-bounce fade --fresnel on --mirror-texture 77 --mirror-light virtual --least-pixels 25 --mirror 12=on --mirror 3:1=off \
         --dissolve parity --dissolve-scene cubes --dissolve-pattern wipe --dissolve-amount 0.25 --dissolve-seconds 3 --halo 4 --halo 5=off --halo-color 0.5,0,1 --halo-width 2.5 --csg a-minus-b --csg-a 6 --csg-b 9 \
         --planar hybrid --hybrid planar --receiver 4=on --receiver 5:2=off \
         --light-edit 1:on=true --adapter llvm --shaders wgsl",
    );
    let edit = LightEdit {
        position: Some(DVec3::new(1.0, -2.0, 3.0)),
        color: Some(Vec3::new(1.0, 0.5, 0.0)),
        intensity: Some(7.0),
        range: Some(9.0),
        on: Some(true),
        shadows: Some(true),
        radius: Some(0.5),
        slide: Some(SlideChoice::BuiltIn(BuiltInSlide::StainedGlass)),
    };
    let expected = Settings {
        scene: SceneChoice::File("fox.glb".into()),
        floor: true,
        technique: Technique::ZPass,
        counting: Counting { bits: 3, overflow: Overflow::Naive },
        complexity: Complexity::Fragments,
        diagram: Diagram::BothFaces,
        decals: DecalMode::Offset,
        dissolve: Dissolve {
            into: Some(Technique::Parity),
            scene: Some("cubes".into()),
            pattern: Pattern::Wipe,
            amount: 0.25,
            seconds: 3.0,
        },
        playground: Playground { board: (boards::find("masks").unwrap().build)(), numbers: true },
        show: Show::Stencil,
        failure: Some(Failure::Saturating),
        light: 2,
        size: [64, 32],
        samples: 4,
        camera: CameraChoice::Free { eye: DVec3::new(-1.0, 2.5, 300.0), target: DVec3::new(0.0, 0.0, -1.0) },
        fov: Some(33.5),
        far: Some(7.5),
        time: 1.25,
        animation: Some(AnimationChoice::One(3)),
        smooth_terminator: false,
        exposure: -1.5,
        lights: BTreeMap::from([(1, edit)]),
        lighting: Lighting {
            area_samples: 16,
            area_mode: AreaMode::Bits,
            light_sample: 3,
            accumulate: 256,
            accumulation: Accumulation::EightBit,
            texturing: Texturing::Once,
            shading: Shading::Deferred,
            labels: true,
        },
        culling: Culling {
            on: false,
            light_bounds: LightBounds::Sphere,
            caster_scissors: true,
            depth_bounds: true,
            footprints: false,
            clamping: false,
        },
        silhouettes: Backend::Compute,
        adapter: Some("llvm".into()),
        mirrors: Mirrors {
            mode: MirrorMode::Stencil,
            bounces: 7,
            last: LastBounce::Fade,
            fresnel: true,
            texture: 77,
            least_pixels: 25,
            light: MirrorLight::Virtual,
            edits: BTreeMap::from([
                (SurfacePlace { node: 12, primitive: 0 }, true),
                (SurfacePlace { node: 3, primitive: 1 }, false),
            ]),
        },
        halos: Halos { edits: BTreeMap::from([(4, true), (5, false)]), color: Vec3::new(0.5, 0.0, 1.0), width: 2.5 },
        csg: Csg { operation: Some(Operation::AMinusB), a: Some(6), b: Some(9) },
        planar: Planar {
            mode: PlanarMode::Hybrid,
            hybrid: HybridPart::Planar,
            edits: BTreeMap::from([
                (SurfacePlace { node: 4, primitive: 0 }, true),
                (SurfacePlace { node: 5, primitive: 2 }, false),
            ]),
        },
        shaders: Some("wgsl".into()),
    };
    assert_eq!(got, expected);
}

#[test]
fn a_failure_brings_its_own_scene_where_none_is_named() {
    let base = Settings::default();
    let expected = crate::failures::demonstration(Failure::DarkCapFan, &base);
    assert_ne!(expected.scene, base.scene);
    assert_eq!(settings("obscura render --failure dark-cap-fan --out a.png"), expected);
    let got = settings("obscura render --failure dark-cap-fan --out a.png --camera inside --size 64x36");
    let camera = CameraChoice::Named("inside".into());
    assert_eq!(got, Settings { camera, size: [64, 36], ..expected.clone() }, "which may be looked at from elsewhere");
    let got = settings("obscura render cubes --failure dark-cap-fan --out a.png");
    let (scene, failure) = (SceneChoice::Stock("cubes".into()), Some(Failure::DarkCapFan));
    assert_eq!(got, Settings { scene, failure, ..base });
    let message = input_error("obscura render --failure none --out a.png");
    assert!(message.starts_with("no failure `none`; there are: eye-in-shadow, near-plane, "), "{message}");
    assert!(usage_error("obscura render --out a.png").contains("SCENE"));
    let Command::Window(request) = command("obscura --failure t-junction").unwrap() else { panic!() };
    let saved = Settings { size: [64, 36], ..Settings::default() };
    assert_eq!(request.settings(saved.clone()).unwrap(), crate::failures::demonstration(Failure::TJunction, &saved));
}

#[test]
fn commands_are_told_apart_from_scenes() {
    assert_eq!(command("obscura list --json").unwrap(), Command::List { json: true });
    assert_eq!(command("obscura tour").unwrap(), Command::Tour { out: "out".into() });
    assert_eq!(
        command("obscura info cubes --floor").unwrap(),
        Command::Info { scene: SceneChoice::Stock("cubes".into()), floor: true, json: false }
    );
    let Command::Window(request) = command("obscura cubes --vsync off --frames 3 --show volumes").unwrap() else { panic!() };
    assert_eq!((request.vsync, request.frames, request.bare), (Some(false), Some(3), false));
    assert_eq!(request.settings(Settings::default()).unwrap().show, Show::Volumes);
    let Command::Window(request) = command("obscura").unwrap() else { panic!() };
    assert!(request.bare);
}

#[test]
fn a_stock_name_wins_over_a_file_of_that_name() {
    assert_eq!(scene_choice("cubes".as_ref()), Ok(SceneChoice::Stock("cubes".into())));
    assert_eq!(scene_choice("./cubes".as_ref()), Ok(SceneChoice::File("cubes".into())));
    assert_eq!(scene_choice("./a/cubes".as_ref()), Ok(SceneChoice::File("./a/cubes".into())));
    assert_eq!(scene_choice("cubes.glb".as_ref()), Ok(SceneChoice::File("cubes.glb".into())));
}

#[test]
fn the_windows_saved_settings_stay_unless_a_scene_is_named() {
    let saved = Settings {
        scene: SceneChoice::Stock("grid".into()),
        technique: Technique::ZPass,
        camera: CameraChoice::Named("top".into()),
        time: 3.0,
        lights: BTreeMap::from([(0, LightEdit { on: Some(false), ..LightEdit::default() })]),
        mirrors: Mirrors {
            bounces: 2,
            edits: BTreeMap::from([(SurfacePlace { node: 1, primitive: 0 }, true)]),
            ..Mirrors::default()
        },
        ..Settings::default()
    };
    let start = |line: &str| match command(line).unwrap() {
        Command::Window(request) => request.settings(saved.clone()).unwrap(),
        other => panic!("{other:?}"),
    };
    assert_eq!(start("obscura"), saved);
    assert_eq!(start("obscura --samples 4"), Settings { samples: 4, ..saved.clone() });
    let cubes = SceneChoice::Stock("cubes".into());
    let mirrors = Mirrors { bounces: 2, ..Mirrors::default() };
    let fresh = Settings { scene: cubes, technique: Technique::ZPass, mirrors, ..Settings::default() };
    assert_eq!(start("obscura cubes"), fresh);
}

#[test]
fn what_names_nothing_or_lies_out_of_range_is_one_line_of_bad_input() {
    for (arguments, expected) in [
        ("--technique zfail", "no technique `zfail`; there are: none, z-pass, z-fail, exact-z-pass"),
        ("--show all", "no show `all`; there are: final, stencil, shadow, overflow, volumes, cases, bounds, wireframe"),
        ("--size 0x10", "0x10"),
        ("--size 99999999999999999999999x10", "each side must be 1 to 8192"),
        ("--size 8193x10", "8193x10"),
        ("--samples 3", "3 samples"),
        ("--samples 0", "0 samples"),
        ("--eye nan,0,0 --target 1,1,1", "the camera's eye"),
        ("--eye 0,0,0 --target 1,inf,1", "the camera's target"),
        ("--eye 0,0,0 --target 1,1e300,1", "between -1000000000 and 1000000000"),
        ("--eye 1,2,3 --target 1,2,3", "same point: 1, 2, 3"),
        ("--fov 0", "between 0 and 180"),
        ("--fov 180", "between 0 and 180"),
        ("--fov nan", "between 0 and 180"),
        ("--time -1", "the time must not be negative"),
        ("--time inf", "the time must be a finite number"),
        ("--exposure -inf", "the exposure"),
        ("--exposure 1000", "the exposure"),
        ("--light-edit 3:position=nan;0;0", "light 3's position"),
        ("--light-edit 3:color=1;-1;0", "light 3's color must not be negative"),
        ("--light-edit 3:intensity=inf", "light 3's intensity"),
        ("--light-edit 3:range=0", "light 3's range must not be negative or zero"),
        ("--light-edit 3:range=nan", "light 3's range"),
    ] {
        let message = input_error(&format!("obscura render cubes --out a.png {arguments}"));
        assert!(message.contains(expected), "{arguments}: {message}");
        // The window says the same.
        assert_eq!(input_error(&format!("obscura cubes {arguments}")), message);
    }
}

#[test]
fn what_cannot_be_read_is_wrong_usage() {
    for (arguments, expected) in [
        ("render cubes", "--out"),
        ("render --out a.png", "SCENE"),
        ("render cubes --out a.png --size 10", "WIDTHxHEIGHT"),
        ("render cubes --out a.png --size axb", "WIDTHxHEIGHT"),
        ("render cubes --out a.png --light one", "whole number"),
        ("render cubes --out a.png --light -1", "whole number"),
        ("render cubes --out a.png --eye 1,2 --target 1,2,3", "three numbers"),
        ("render cubes --out a.png --eye 1,2,3", "--eye needs --target"),
        ("cubes --target 1,2,3", "--target needs --eye"),
        ("render cubes --out a.png --eye 1,2,3 --target 0,0,0 --camera top", "cannot be used with"),
        ("render cubes --out a.png --light-edit 0", "K:WHAT=VALUE"),
        ("render cubes --out a.png --light-edit x:on=true", "`x` is no light's index"),
        ("render cubes --out a.png --light-edit 0:glow=1", "`glow` is not one of"),
        ("render cubes --out a.png --light-edit 0:position=1;2", "three numbers"),
        ("render cubes --out a.png --animation walk", "all, still"),
        ("render cubes --out a.png --nonsense", "--nonsense"),
        ("cubes --vsync maybe", "--vsync"),
        ("list --out x", "--out"),
    ] {
        let message = usage_error(&format!("obscura {arguments}"));
        let first = message.lines().next().unwrap();
        assert!(first.starts_with("error: "), "{arguments}: {first}");
        assert!(message.contains(expected), "{arguments}: {message}");
    }
}

#[test]
fn the_scene_must_have_the_lights_and_animations_asked_for() {
    let light = Light { name: "sun".into(), ..Light::default() };
    let scene = Scene { lights: vec![light; 2], animations: vec![Animation::default()], ..Scene::default() };
    let says = |arguments: &str, scene: &Scene| {
        check_against(&settings(&format!("obscura render cubes --out a.png {arguments}")), scene)
            .map_err(|error| error.to_string())
    };
    assert_eq!(says("--light 1 --animation 0 --light-edit 1:on=true", &scene), Ok(()));
    assert_eq!(says("--light 2", &scene), Err("no light 2 in this scene: it has 2, counted from 0".into()));
    assert_eq!(says("--light-edit 7:on=true", &scene), Err("no light 7 in this scene: it has 2, counted from 0".into()));
    assert!(says("--light 99999999999999999999999", &scene).is_err());
    assert_eq!(says("--animation 1", &scene), Err("no animation 1 in this scene: it has 1, counted from 0".into()));
    assert_eq!(says("", &Scene::default()), Ok(()));
    assert_eq!(says("--light-edit 0:on=true", &Scene::default()), Err("no light 0 in this scene: it has 0".into()));
}

#[test]
fn the_command_says_only_what_differs_from_the_default() {
    assert_eq!(render_command(&Settings::default()), "obscura render courtyard --out obscura.png");
    let turned = Settings {
        scene: SceneChoice::File("my models/-fox's.glb".into()),
        camera: CameraChoice::Named("-top".into()),
        fov: Some(0.1 + 0.2),
        ..Settings::default()
    };
    assert_eq!(
        render_command(&turned),
        r#"obscura render "my models/-fox's.glb" --out obscura.png '--camera=-top' --fov 0.30000000000000004"#
    );
}

/// Every f64 below `limit`, not only round ones.
fn number(limit: f64) -> impl Strategy<Value = f64> {
    prop_oneof![-limit..limit, prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO]
        .prop_filter("in range", move |x| x.abs() <= limit)
}

fn positive() -> impl Strategy<Value = f32> {
    prop::num::f32::POSITIVE | prop::num::f32::NORMAL | prop::num::f32::ZERO | prop::num::f32::SUBNORMAL
}

fn anywhere() -> impl Strategy<Value = DVec3> {
    [number(MAX_COORDINATE), number(MAX_COORDINATE), number(MAX_COORDINATE)].prop_map(DVec3::from)
}

fn word() -> impl Strategy<Value = String> {
    prop_oneof!["[^\\x00]{0,12}", "[-./ '\"$a-z\\\\\n]{1,8}", Just("--size".to_string()), Just("cubes".to_string())]
}

fn any_scene() -> impl Strategy<Value = SceneChoice> {
    let names: Vec<_> = stock::TABLE.iter().map(|scene| scene.name).collect();
    let stock = prop::sample::select(names).prop_map(|name| SceneChoice::Stock(name.into()));
    let file = word()
        .prop_filter("a `./` that only protects a name is not kept", |path| {
            !path.is_empty() && !path.strip_prefix("./").is_some_and(needs_dot)
        })
        .prop_map(|path| SceneChoice::File(path.into()));
    prop_oneof![stock, file]
}

fn any_camera() -> impl Strategy<Value = CameraChoice> {
    prop_oneof![
        Just(CameraChoice::First),
        word().prop_map(CameraChoice::Named),
        (anywhere(), anywhere())
            .prop_filter("two points", |(eye, target)| eye != target)
            .prop_map(|(eye, target)| CameraChoice::Free { eye, target }),
    ]
}

fn any_animation() -> impl Strategy<Value = AnimationChoice> {
    prop_oneof![Just(AnimationChoice::All), Just(AnimationChoice::Still), any::<usize>().prop_map(AnimationChoice::One)]
}

fn any_edit() -> impl Strategy<Value = LightEdit> {
    let color = [positive(), positive(), positive()].prop_map(Vec3::from);
    let some = prop::option::of::<BoxedStrategy<f32>>;
    let range = (positive().prop_filter("above zero", |range| *range > 0.0)).boxed();
    (
        prop::option::of(anywhere()),
        prop::option::of(color),
        some(positive().prop_filter("finite", |x| x.is_finite()).boxed()),
        some(range),
        any::<Option<bool>>(),
        any::<Option<bool>>(),
        some(positive().prop_filter("finite", |x| x.is_finite()).boxed()),
        prop::option::of(prop::sample::select(&SlideChoice::ALL[..])),
    )
        .prop_map(|(position, color, intensity, range, on, shadows, radius, slide)| LightEdit {
            position,
            color: color.filter(|color: &Vec3| color.is_finite()),
            intensity,
            range,
            on,
            shadows,
            radius,
            slide,
        })
}

fn any_settings() -> impl Strategy<Value = Settings> {
    let picture = (
        any_scene(),
        any::<bool>(),
        prop::sample::select(&Technique::ALL[..]),
        prop::sample::select(&Show::ALL[..]),
        any::<usize>(),
        [1..=MAX_SIZE, 1..=MAX_SIZE],
        prop::sample::select(&[1u32, 4][..]),
    );
    let eye = (
        any_camera(),
        prop::option::of((1e-300..180f64).prop_filter("an angle", |degrees| *degrees < 180.0)),
        prop::option::of(1e-300..f64::MAX),
        number(f64::MAX).prop_map(f64::abs),
        prop::option::of(any_animation()),
        any::<bool>(),
        -MAX_EXPOSURE..MAX_EXPOSURE,
    );
    let lighting = (
        1..=MAX_AREA_SAMPLES,
        prop::sample::select(&AreaMode::ALL[..]),
        1..=MAX_FRAMES,
        prop::sample::select(&Accumulation::ALL[..]),
        prop::sample::select(&Texturing::ALL[..]),
        prop::sample::select(&Shading::ALL[..]),
        any::<bool>(),
    )
        .prop_flat_map(|(area_samples, area_mode, accumulate, accumulation, texturing, shading, labels)| {
            (0..area_samples).prop_map(move |light_sample| Lighting {
                area_samples,
                area_mode,
                light_sample,
                accumulate,
                accumulation,
                texturing,
                shading,
                labels,
            })
        });
    let switch = any::<bool>;
    let culling = (switch(), prop::sample::select(&LightBounds::ALL[..]), switch(), switch(), switch(), switch()).prop_map(
        |(on, light_bounds, caster_scissors, depth_bounds, footprints, clamping)| Culling {
            on,
            light_bounds,
            caster_scissors,
            depth_bounds,
            footprints,
            clamping,
        },
    );
    let place = (any::<usize>(), any::<usize>()).prop_map(|(node, primitive)| SurfacePlace { node, primitive });
    let edits = || prop::collection::btree_map(place.clone(), any::<bool>(), 0..4);
    let planar = (prop::sample::select(&PlanarMode::ALL[..]), prop::sample::select(&HybridPart::ALL[..]), edits())
        .prop_map(|(mode, hybrid, edits)| Planar { mode, hybrid, edits });
    let mirrors = (
        prop::sample::select(&MirrorMode::ALL[..]),
        1..=MAX_BOUNCES,
        prop::sample::select(&LastBounce::ALL[..]),
        any::<bool>(),
        LEAST_TEXTURE..=MOST_TEXTURE,
        any::<u32>(),
        prop::sample::select(&MirrorLight::ALL[..]),
        edits(),
    )
        .prop_map(|(mode, bounces, last, fresnel, texture, least_pixels, light, edits)| Mirrors {
            mode,
            bounces,
            last,
            fresnel,
            texture,
            least_pixels,
            light,
            edits,
        });
    let part = || 0.0f32..=1.0;
    let halos =
        (prop::collection::btree_map(any::<usize>(), any::<bool>(), 0..4), [part(), part(), part()], 0.0..=MAX_HALO_WIDTH)
            .prop_map(|(edits, color, width)| Halos { edits, color: color.into(), width });
    let operation = prop::option::of(prop::sample::select(&Operation::ALL[..]));
    let csg = (operation, prop::option::of(any::<usize>()), prop::option::of(any::<usize>())).prop_map(|(operation, a, b)| Csg {
        operation,
        a,
        b,
    });
    let dissolve = (
        prop::option::of(prop::sample::select(&Technique::ALL[..])),
        prop::option::of(prop::sample::select(&["cubes", "csg"][..]).prop_map(String::from)),
        prop::sample::select(&Pattern::ALL[..]),
        0.0..=1.0f32,
        0.0..100.0f32,
    )
        .prop_map(|(into, scene, pattern, amount, seconds)| Dissolve { into, scene, pattern, amount, seconds });
    let rest = (
        prop::collection::btree_map(any::<usize>(), any_edit(), 0..4),
        lighting,
        (1..=MAX_COUNT_BITS, prop::sample::select(&Overflow::ALL[..])).prop_map(|(bits, overflow)| Counting { bits, overflow }),
        (culling, mirrors, halos, csg, planar, dissolve, prop::sample::select(&Backend::ALL[..])),
        prop::option::of(word()),
        prop::option::of(word().prop_filter("a folder", |path| !path.is_empty()).prop_map(PathBuf::from)),
        (
            prop::option::of(prop::sample::select(&Failure::ALL[..])),
            (prop::sample::select(&Complexity::ALL[..]), prop::sample::select(&Diagram::ALL[..])),
            prop::sample::select(&DecalMode::ALL[..]),
            (0..boards::PRESETS.len(), any::<u8>(), any::<bool>()).prop_map(|(preset, clear, numbers)| {
                let board = (boards::PRESETS[preset].build)();
                Playground { board: Board { clear: clear % 3, ..board }, numbers }
            }),
        ),
    );
    (picture, eye, rest).prop_map(
        |(
            (scene, floor, technique, show, light, size, samples),
            (camera, fov, far, time, animation, smooth_terminator, exposure),
            (
                lights,
                lighting,
                counting,
                (culling, mirrors, halos, csg, planar, dissolve, silhouettes),
                adapter,
                shaders,
                (failure, (complexity, diagram), decals, playground),
            ),
        )| Settings {
            scene,
            floor,
            technique,
            counting,
            complexity,
            diagram,
            decals,
            dissolve,
            playground,
            show,
            failure,
            light,
            size,
            samples,
            camera,
            fov,
            far,
            time,
            animation,
            smooth_terminator,
            exposure,
            lights,
            lighting,
            culling,
            silhouettes,
            adapter,
            mirrors,
            halos,
            csg,
            planar,
            shaders,
        },
    )
}

proptest! {
    #[test]
    fn a_render_command_draws_the_same_settings(expected in any_settings()) {
        let line = render_command(&expected);
        let words = shlex::split(&line).expect("a shell can read it");
        let parsed = parse(words).map_err(|error| TestCaseError::fail(format!("{line}: {error}")))?;
        match parsed.command() {
            Ok(Command::Render { settings, .. }) => prop_assert_eq!(settings, expected, "{}", line),
            other => prop_assert!(false, "{line}: {other:?}"),
        }
    }
}
