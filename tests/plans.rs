//! Plans as text, made without a GPU and compared with the texts in `tests/plans/`.
//!
//! A text that is missing or differs fails; `OBSCURA_UPDATE=1 cargo test --test plans` writes them anew.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use std::path::PathBuf;

use common::{Build, cube, seen_from, square};
use glam::{DQuat, DVec3};
use obscura::director::{StageError, stage};
use obscura::frame::state::{Cull, Depth, NearPlane};
use obscura::frame::stencil::{StencilOp, StencilState};
use obscura::frame::validate::validate;
use obscura::frame::{Action, Capabilities, Draw, DrawSet, FramePlan, Method, Program};
use obscura::scene::{AlphaMode, LightKind, Material, Scene, Transform, stock};
use obscura::settings::{
    AreaMode, CameraChoice, Csg, Culling, DecalMode, LightEdit, MirrorLight, Operation, PlanarMode, Settings, Show, SurfacePlace,
    Technique,
};

/// Two lights, one with a range; a solid, a mirrored solid, a sheet, a masked and a blended one.
fn varied() -> Scene {
    let mut build = Build::new();
    let named = |name: &str, alpha| Material { name: name.into(), alpha, ..Material::default() };
    build.0.materials.push(named("masked", AlphaMode::Mask(0.5)));
    build.0.materials.push(named("blended", AlphaMode::Blend));
    build.floor(0.0, 20.0);
    let solid = build.mesh(cube(0));
    build.place(solid, DVec3::new(-2.0, 1.5, 0.0), DVec3::ONE);
    build.place(solid, DVec3::new(2.0, 1.5, 0.0), DVec3::new(-1.0, 1.0, 1.0));
    let sheet = build.mesh(square(1));
    build.place(sheet, DVec3::new(0.0, 4.0, 0.0), DVec3::ONE);
    let masked = build.mesh(cube(2));
    build.place(masked, DVec3::new(0.0, 1.5, -4.0), DVec3::ONE);
    let mut glass = cube(3);
    glass.primitives[0].casts_shadow = false;
    let glass = build.mesh(glass);
    build.place(glass, DVec3::new(0.0, 1.2, 3.0), DVec3::splat(0.5));
    build.point_light(DVec3::new(0.0, 9.0, 0.0));
    let near = build.light(LightKind::Point, DVec3::new(-4.0, 2.0, 0.0), DVec3::NEG_Y, 10.0);
    build.0.lights[near].range = 2.5;
    build.camera(DVec3::new(0.0, 5.0, 12.0), DVec3::new(0.0, 1.0, 0.0));
    build.0
}

fn plan(scene: &Scene, settings: &Settings) -> FramePlan {
    stage(settings, scene, &Capabilities::complete()).unwrap().1
}

/// Two of the varied scene's cubes, one without the other: its depth comes before all surfaces.
#[test]
fn solids_come_first() {
    let mut settings = Settings { size: [320, 180], ..Settings::default() };
    let mut scene = varied();
    scene.nodes[2].local =
        Transform::Trs { translation: DVec3::new(-1.4, 2.1, 0.3), rotation: DQuat::IDENTITY, scale: DVec3::ONE };
    settings.csg = Csg { operation: Some(Operation::AMinusB), a: Some(1), b: Some(2) };
    let scene = scene.combined(scene.combination_at(&settings).unwrap());
    assert_text("csg", &plan(&scene, &settings));
}

/// What is seen of the varied scene where two of its objects glow.
#[test]
fn halos_come_last() {
    let mut settings = Settings { size: [320, 180], ..Settings::default() };
    settings.halos.edits = [(1, true), (4, true)].into();
    settings.halos.width = 3.0;
    assert_text("halo", &plan(&varied(), &settings));
}

fn assert_text(name: &str, plan: &FramePlan) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/plans").join(format!("{name}.txt"));
    let text = plan.to_string();
    if std::env::var_os("OBSCURA_UPDATE").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, &text).unwrap();
    }
    let stored = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert_eq!(text, stored, "the plan differs from {}", path.display());
}

#[test]
fn each_technique_plans_as_written() {
    let scene = varied();
    for technique in Technique::ALL {
        let settings = Settings { technique, size: [320, 180], ..Settings::default() };
        assert_text(technique.name(), &plan(&scene, &settings));
    }
}

#[test]
fn each_show_plans_as_written() {
    let scene = varied();
    for show in Show::ALL.into_iter().filter(|show| *show != Show::Final) {
        let settings = Settings { show, size: [320, 180], ..Settings::default() };
        assert_text(&format!("show-{}", show.name()), &plan(&scene, &settings));
    }
}

#[test]
fn three_bounces_of_the_barbershop_plan_as_written() {
    let scene = stock::build("barbershop").unwrap().unwrap();
    let mut settings = Settings { technique: Technique::ZFail, size: [320, 180], ..Settings::default() };
    settings.mirrors.bounces = 3;
    assert_text("barbershop-3-bounces", &plan(&scene, &settings));
}

#[test]
fn a_dissolve_plans_as_written() {
    let mut settings = Settings { technique: Technique::ZFail, size: [320, 180], ..Settings::default() };
    settings.dissolve.into = Some(Technique::None);
    assert_text("dissolve", &plan(&varied(), &settings));
}

#[test]
fn light_off_a_mirror_plans_as_written() {
    let scene = stock::build("figure3").unwrap().unwrap();
    let mut settings = Settings { technique: Technique::Auto, size: [320, 180], ..Settings::default() };
    settings.mirrors.light = MirrorLight::Virtual;
    assert_text("figure3-light-off-mirrors", &plan(&scene, &settings));
}

/// The floor takes planar shadows, and what stands in it is cut there.
#[test]
fn planar_shadows_plan_as_written() {
    let scene = varied();
    for mode in [PlanarMode::Multi, PlanarMode::StencilRelight, PlanarMode::Hybrid] {
        let mut settings = Settings { size: [320, 180], ..Settings::default() };
        settings.planar.mode = mode;
        settings.planar.edits.insert(SurfacePlace { node: 0, primitive: 0 }, true);
        assert_text(&format!("planar-{}", mode.name()), &plan(&scene, &settings));
    }
}

#[test]
fn decals_plan_as_written() {
    let mut scene = varied();
    for alpha in [AlphaMode::Opaque, AlphaMode::Blend] {
        let material = scene.materials.len();
        scene.materials.push(Material { name: "decal".into(), alpha, decal: true, ..Material::default() });
        let mut build = Build(scene);
        let mesh = build.mesh(square(material));
        let node = build.place(mesh, DVec3::new(1.0, 0.0, 2.0), DVec3::new(3.0, 1.0, 2.0));
        build.0.nodes[node].casts_shadow = false;
        scene = build.0;
    }
    for decals in DecalMode::ALL {
        let settings = Settings { decals, size: [320, 180], ..Settings::default() };
        assert_text(&format!("decals-{}", decals.name()), &plan(&scene, &settings));
    }
}

/// With depth bounds: the second light has an end.
fn bounded() -> FramePlan {
    let mut settings = Settings { technique: Technique::Auto, size: [320, 180], ..Settings::default() };
    settings.culling.depth_bounds = true;
    plan(&varied(), &settings)
}

#[test]
fn depth_bounds_plan_as_written() {
    let plan = bounded();
    assert!(plan.depth_bounds(0).is_none() && plan.depth_bounds(1).is_some());
    assert_text("depth-bounds", &plan);
}

#[test]
fn bounds_are_marked_once_and_before_they_are_asked_for() {
    let plan = bounded();
    let mark = plan.steps.iter().position(|step| step.label.contains("mark")).unwrap();
    let spoiled = |change: &dyn Fn(&mut FramePlan)| {
        let mut plan = plan.clone();
        change(&mut plan);
        validate(&plan).unwrap_err().what
    };
    assert!(spoiled(&|plan| _ = plan.steps.remove(mark)).contains("not marked"));
    assert!(spoiled(&|plan| plan.steps.insert(mark, plan.steps[mark].clone())).contains("once"));
    assert!(spoiled(&|plan| plan.steps.swap(mark, mark + 1)).contains("not marked"));
    assert!(spoiled(&|plan| plan.budget = Default::default()).contains("theirs"));
}

/// The first light has a size and three points, each with a bit of its own.
fn with_own_bits() -> FramePlan {
    let mut settings = Settings { size: [320, 180], ..Settings::default() };
    settings.lights.insert(0, LightEdit { radius: Some(0.4), ..LightEdit::default() });
    settings.lighting.area_samples = 3;
    settings.lighting.area_mode = AreaMode::Bits;
    plan(&varied(), &settings)
}

#[test]
fn points_with_bits_of_their_own_plan_as_written() {
    assert_text("own-bits", &with_own_bits());
}

#[test]
fn validation_knows_whose_bit_is_whose() {
    let plan = with_own_bits();
    let spoiled = |wanted: &str, change: &dyn Fn(&mut Draw)| {
        let mut plan = plan.clone();
        let mut steps = plan.steps.iter_mut().filter(|step| step.label.contains(wanted));
        match &mut steps.next().unwrap().action {
            Action::Draw(draw) => change(draw),
            Action::Clear(_) | Action::Keep => panic!("no draw is called {wanted}"),
        }
        validate(&plan).unwrap_err().what
    };
    assert!(spoiled("light 2: add", &|draw| draw.light = Some(0)).contains("another light's own"));
    assert!(spoiled("light 0: add", &|draw| draw.state.stencil.write_mask = 3).contains("marked in one of the bits"));
    assert!(spoiled("light 0: add", &|draw| draw.state.stencil.front.pass = StencilOp::Keep).contains("marked in one"));
    assert!(spoiled("light 0: add", &|draw| draw.state.stencil.read_mask = 0xff).contains("another light's own"));
    assert!(spoiled("light 2: collapse", &|draw| draw.light = Some(0)).contains("not made"));
    let mut shone = plan.clone();
    let at = |label: &str| plan.steps.iter().position(|step| step.label.contains(label)).unwrap();
    let step = shone.steps.remove(at("light 0: add"));
    shone.steps.insert(at("light 2: collapse"), step);
    assert_eq!(validate(&shone), Ok(()), "a point may shine as soon as its bit is there");
    let mut early = plan.clone();
    let step = early.steps.remove(at("light 2: add"));
    early.steps.insert(at("light 2: collapse") - 1, step);
    assert!(validate(&early).unwrap_err().what.contains("took light"), "{:?}", validate(&early));
}

#[test]
fn the_eye_in_three_shadows_starts_from_three() {
    let mut build = Build::new();
    build.floor(0.0, 20.0);
    let cube = build.mesh(cube(0));
    for i in 0..3 {
        build.place(cube, DVec3::new(0.0, 5.0 + 3.0 * f64::from(i), 0.0), DVec3::ONE);
    }
    build.point_light(DVec3::new(0.1, 15.0, 0.2));
    let settings = seen_from(DVec3::new(0.3, 1.0, 0.2), DVec3::new(5.0, 0.0, -3.0), [320, 180]);
    // Between its pieces a volume holds no eye.
    let culling = Culling { clamping: false, ..settings.culling };
    let plan = plan(&build.0, &Settings { technique: Technique::ExactZPass, culling, ..settings });
    assert_eq!(plan.volumes.iter().map(|volume| volume.holds_eye).collect::<Vec<_>>(), [1, 1, 1]);
    let Action::Clear(clear) = &plan.steps[0].action else { panic!("a frame starts with a clear") };
    assert_eq!(clear.stencil, Some(3));
    assert_text("eye-in-three-shadows", &plan);
}

#[test]
fn a_light_that_is_off_costs_nothing_and_one_without_shadows_no_volumes() {
    let scene = varied();
    let mut settings = Settings { size: [320, 180], ..Settings::default() };
    settings.lights.insert(0, LightEdit { on: Some(false), ..LightEdit::default() });
    settings.lights.insert(1, LightEdit { shadows: Some(false), ..LightEdit::default() });
    let plan = plan(&scene, &settings);
    assert!(plan.volumes.is_empty());
    assert!(plan.draws().all(|(_, draw)| draw.light != Some(0)));
    let lit: Vec<_> = plan.draws().filter(|(_, draw)| draw.program == Program::Lit).collect();
    // No count is asked for: only the bit that the light marks.
    let marks = |draw: &Draw| draw.state.stencil.read_mask == draw.state.stencil.write_mask;
    assert!(!lit.is_empty() && lit.iter().all(|(_, draw)| marks(draw) && draw.state.stencil.write_mask.is_power_of_two()));
}

#[test]
fn casters_beyond_a_lights_range_are_dropped() {
    let plan = plan(&varied(), &Settings { technique: Technique::ZFail, size: [320, 180], ..Settings::default() });
    let of_near_light: Vec<_> = plan.volumes.iter().filter(|volume| volume.light == 1).map(|volume| volume.method).collect();
    assert_eq!(of_near_light, [Method::ZFail, Method::Dropped, Method::Dropped, Method::Dropped]);
    let drawn = plan.draws().filter(|(_, draw)| draw.light == Some(1));
    for (step, draw) in drawn {
        let [_, _, width, height] = draw.scissor;
        assert!(width < 320 && height < 180, "{}: the light's scissor is {:?}", step.label, draw.scissor);
    }
}

#[test]
fn settings_that_ask_for_what_is_not_there_are_refused() {
    let scene = varied();
    let base = Settings { size: [320, 180], ..Settings::default() };
    let refused = |settings: Settings| stage(&settings, &scene, &Capabilities::complete()).unwrap_err();
    let text = |settings: Settings| refused(settings).to_string();
    assert!(matches!(refused(Settings { size: [0, 10], ..base.clone() }), StageError::Size(0, 10, _)));
    assert!(matches!(refused(Settings { size: [10, 100_000], ..base.clone() }), StageError::Size(..)));
    assert!(matches!(refused(Settings { samples: 3, ..base.clone() }), StageError::Samples(3)));
    assert!(matches!(refused(Settings { show: Show::Stencil, light: 7, ..base.clone() }), StageError::Light(7, 2)));
    assert!(matches!(refused(Settings { time: f64::NAN, ..base.clone() }), StageError::Time(_)));
    assert!(text(Settings { camera: CameraChoice::Named("nowhere".into()), ..base.clone() }).contains("camera 0"));
    assert!(text(Settings { fov: Some(180.0), ..base.clone() }).contains("180"));
    let at = |eye, target| Settings { camera: CameraChoice::Free { eye, target }, ..base.clone() };
    assert!(text(at(DVec3::NAN, DVec3::ZERO)).contains("finite"));
    assert!(text(at(DVec3::ONE, DVec3::ONE)).contains("same point"));
}

/// The first draw of a plan that draws volumes, to be spoiled.
fn spoil(change: impl Fn(&mut Draw)) -> String {
    let mut plan = plan(&varied(), &Settings { technique: Technique::ExactZPass, size: [320, 180], ..Settings::default() });
    assert_eq!(validate(&plan), Ok(()));
    let draw = plan.steps.iter_mut().find_map(|step| match &mut step.action {
        Action::Draw(draw) if matches!(draw.set, DrawSet::Volumes(_)) => Some(draw),
        _ => None,
    });
    change(draw.unwrap());
    validate(&plan).unwrap_err().what.into()
}

#[test]
fn validation_finds_each_kind_of_fault() {
    assert!(spoil(|draw| draw.scissor = [300, 0, 21, 10]).contains("scissor"));
    assert!(spoil(|draw| draw.scissor = [0, 0, 0, 10]).contains("scissor"));
    assert!(spoil(|draw| draw.state.winding = draw.state.winding.through(-1.0)).contains("winding"));
    assert!(spoil(|draw| draw.state.near_plane = NearPlane::Clip).contains("depth clamp"));
    assert!(spoil(|draw| draw.state.depth = Depth::NEVER).contains("Never"));
    assert!(spoil(|draw| draw.light = Some(1)).contains("another light"));
    assert!(spoil(|draw| draw.set = DrawSet::Edges(vec![0])).contains("only volumes"));
    assert!(spoil(|draw| draw.set = DrawSet::FullScreen).contains("replaces"));
    assert!(
        spoil(|draw| {
            draw.stencil_reference = 1;
            draw.state.stencil = StencilState { read_mask: 0, ..StencilState::count_equals(Default::default()) };
        })
        .contains("reference")
    );
}

#[test]
fn validation_finds_faults_of_order() {
    let good = plan(&varied(), &Settings { size: [320, 180], ..Settings::default() });
    let mut without_clear = good.clone();
    without_clear.steps.remove(0);
    assert!(validate(&without_clear).unwrap_err().what.contains("cleared"));
    let mut without_picture = good.clone();
    without_picture.steps.pop();
    assert!(validate(&without_picture).unwrap_err().what.contains("without a picture"));
    let mut after_picture = good.clone();
    let last = after_picture.steps.len() - 1;
    after_picture.steps.swap(last, last - 1);
    assert!(validate(&after_picture).unwrap_err().what.contains("after the picture"));
    let mut depth_after_counting = good.clone();
    let ambient = depth_after_counting.steps[1].clone();
    depth_after_counting.steps.insert(last, ambient);
    let fault = validate(&depth_after_counting).unwrap_err();
    assert!(fault.what.contains("depth after counting"), "{fault}");
    let mut unset_stencil = good;
    if let Action::Clear(clear) = &mut unset_stencil.steps[0].action {
        clear.stencil = None;
    }
    assert!(validate(&unset_stencil).unwrap_err().what.contains("nobody set"));
}

#[test]
fn surfaces_state_their_cull_and_winding() {
    let plan = plan(&varied(), &Settings { size: [320, 180], ..Settings::default() });
    let ambient: Vec<_> = plan
        .draws()
        .filter(|(_, draw)| matches!(draw.program, Program::Ambient | Program::AmbientMasked))
        .map(|(_, draw)| (draw.program, draw.state.cull, draw.state.winding))
        .collect();
    assert_eq!(ambient.len(), 4, "solid, mirrored, both sides, masked: {ambient:?}");
    assert_eq!(ambient.iter().filter(|(_, cull, _)| *cull == Cull::None).count(), 1);
}

#[test]
fn the_terminator_setting_reaches_the_plan() {
    let scene = varied();
    let settings = Settings { smooth_terminator: false, exposure: 1.0, size: [320, 180], ..Settings::default() };
    let plan = plan(&scene, &settings);
    assert!(!plan.smooth_terminator);
    assert!((plan.exposure - 2.0 * scene.exposure).abs() < 1e-6);
}
