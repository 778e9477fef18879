//! Clicks through the panel without a window: each control changes exactly what it says.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // a failed unwrap is a failed test

use egui::accesskit::Role;
use egui::{Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::{DAffine3, DVec3, Vec3};
use obscura::app::control::Mode;
use obscura::app::keys;
use obscura::app::store::Preferences;
use obscura::app::ui::{Action, Desk, FrameNumbers, History, Notice, Panel, Tone, Topic, View, project, style};
use obscura::app::verify::{Finding, Verification};
use obscura::failures;
use obscura::frame::{Camera, Capabilities, FramePlan};
use obscura::scene::stock::StockScene;
use obscura::scene::{self, Light, LightKind, Node, Pose, PosedLight, Scene};
use obscura::settings::{
    Backend, CameraChoice, Complexity, Csg, DecalMode, Diagram, Failure, Halos, HybridPart, LastBounce, LightEdit, MirrorMode,
    Mirrors, Operation, Planar, PlanarMode, SceneChoice, Settings, Show, SurfacePlace, Technique,
};
use obscura::techniques::TABLE;
use obscura::techniques::cases::{self, Class};
use obscura::techniques::complexity::Tally;
use obscura::truth::{Comparison, SurfaceComparison, Wrong, WrongPixel};

/// Everything around the panel that the window would hold.
struct Bench {
    settings: Settings,
    preferences: Preferences,
    panel: Panel,
    scene: Scene,
    pose: Pose,
    plan: Option<FramePlan>,
    notices: Vec<Notice>,
    capabilities: Capabilities,
    history: History,
    complexity: Option<Tally>,
    verification: Verification,
    actions: Vec<Action>,
    picture: egui::Rect,
}

static STOCK: [StockScene; 2] = [
    StockScene { name: "cubes", about: "four cubes", build: || Ok(Scene::default()) },
    StockScene { name: "grid", about: "many cubes", build: || Ok(Scene::default()) },
];

impl Bench {
    /// A scene with two lights and two cameras, and nothing else: the panel needs no more.
    fn new() -> Self {
        let places =
            [DVec3::new(0.6, 3.0, 1.0), DVec3::new(-0.8, 2.0, 0.0), DVec3::new(0.0, 2.0, 8.0), DVec3::new(0.0, 20.0, 0.1)];
        let light = |name: &str, node| Light {
            name: name.into(),
            node,
            kind: LightKind::Point,
            color: Vec3::new(1.0, 0.5, 0.25),
            intensity: 40.0,
            range: 12.0,
            ..Light::default()
        };
        let camera = |name: &str, node, vertical_fov| scene::Camera {
            name: name.into(),
            node,
            vertical_fov,
            near: 0.1,
            focus_distance: 8.0,
        };
        let scene = Scene {
            nodes: places.iter().map(|_| Node::default()).collect(),
            lights: vec![light("lamp", 0), light("torch", 1)],
            cameras: vec![camera("front", 2, 0.9), camera("above", 3, 0.6)],
            animations: vec![scene::Animation { name: "turn".into(), channels: Vec::new(), duration: 4.0 }],
            warnings: vec!["material `glass`: transmission is left out".into()],
            ..Scene::default()
        };
        let world_from_node: Vec<_> = places.into_iter().map(DAffine3::from_translation).collect();
        let lights = scene.lights.iter().enumerate().map(|(of, light)| PosedLight {
            of,
            position: places[light.node],
            center: places[light.node],
            intensity: light.color * light.intensity,
            range: f64::from(light.range),
            ..PosedLight::default()
        });
        let pose =
            Pose { lights: lights.collect(), world_from_object: world_from_node.clone(), world_from_node, ..Pose::default() };
        Self {
            settings: Settings::default(),
            preferences: Preferences::default(),
            panel: Panel::default(),
            scene,
            pose,
            plan: None,
            notices: Vec::new(),
            capabilities: Capabilities::complete(),
            history: History::default(),
            complexity: None,
            verification: Verification::default(),
            actions: Vec::new(),
            picture: egui::Rect::NOTHING,
        }
    }

    fn pass(&mut self, ui: &mut egui::Ui) {
        let view = View {
            stock: &STOCK,
            scene: Some(&self.scene),
            pose: Some(&self.pose),
            plan: self.plan.as_ref(),
            doctor: "mesh 0 is closed",
            opening: None,
            notices: &self.notices,
            capabilities: Some(&self.capabilities),
            complexity: self.complexity,
            history: &self.history,
            verification: &self.verification,
            picture: None,
        };
        let desk = Desk { settings: &mut self.settings, preferences: &mut self.preferences };
        let outcome = self.panel.show(ui, desk, &view);
        self.actions.extend(outcome.actions);
        self.picture = outcome.picture;
    }
}

/// A panel tall enough to show every section without scrolling.
fn open(bench: Bench) -> Harness<'static, Bench> {
    let builder = Harness::builder().with_size(vec2(1280.0, 2800.0)).with_context_setup(style::install);
    let mut harness = builder.build_ui_state(|ui, bench: &mut Bench| bench.pass(ui), bench);
    harness.run_steps(3);
    harness
}

fn click(harness: &mut Harness<'_, Bench>, label: &str) {
    harness.get_by_role_and_label(Role::Button, label).click();
    harness.run_steps(3);
}

fn choose(harness: &mut Harness<'_, Bench>, label: &str) {
    harness.get_by_role_and_label(Role::RadioButton, label).click();
    harness.run_steps(3);
}

fn press(harness: &mut Harness<'_, Bench>, key: Key) {
    harness.key_press(key);
    harness.run_steps(2);
}

/// The settings after a click, but for the picture's size, which is the window's.
fn settings(harness: &Harness<'_, Bench>) -> Settings {
    Settings { size: Settings::default().size, ..harness.state().settings.clone() }
}

fn camera(bench: &Bench) -> Camera {
    Camera::choose(&bench.settings, &bench.scene, &bench.pose).unwrap()
}

#[test]
fn each_technique_changes_just_the_technique() {
    let mut harness = open(Bench::new());
    for row in TABLE.iter().rev() {
        choose(&mut harness, row.title);
        assert_eq!(settings(&harness), Settings { technique: row.technique, ..Settings::default() });
        assert!(harness.query_by_label_contains(row.about).is_some(), "{} is explained", row.title);
    }
    assert_eq!(harness.state().actions, []);
}

#[test]
fn silhouettes_are_found_where_the_panel_says_and_only_where_the_device_can() {
    let mut harness = open(Bench::new());
    let choose = |harness: &mut Harness<'_, Bench>, label: &str| {
        harness.get_by_role_and_label(Role::Button, label).click();
        harness.run_steps(3);
    };
    choose(&mut harness, "Compute");
    assert_eq!(settings(&harness), Settings { silhouettes: Backend::Compute, ..Settings::default() });
    choose(&mut harness, "CPU");
    assert_eq!(settings(&harness), Settings::default());
    let mut bench = Bench::new();
    bench.capabilities.compute_silhouettes = None;
    let mut harness = open(bench);
    choose(&mut harness, "Compute");
    assert_eq!(settings(&harness), Settings::default());
}

/// The scene of a bench with casters in it, planned.
fn planned(show: Show, light: usize) -> Bench {
    let mut bench = Bench::new();
    bench.scene = scene::stock::build("cathedral").unwrap().unwrap();
    bench.settings = Settings { show, light, technique: Technique::Auto, size: [320, 180], ..Settings::default() };
    let (pose, plan) = obscura::director::stage(&bench.settings, &bench.scene, &Capabilities::complete()).unwrap();
    (bench.pose, bench.plan) = (pose, Some(plan));
    bench
}

/// Every label's words, in the order they stand in.
fn labels(harness: &Harness<'_, Bench>) -> Vec<String> {
    harness.query_all_by_role(Role::Label).filter_map(|node| node.value()).collect()
}

#[test]
fn the_table_of_casters_says_what_the_report_says() {
    for light in 0..3 {
        let mut harness = open(planned(Show::Final, light));
        harness.get_by_label("Culling").click();
        harness.run_steps(6);
        let bench = harness.state();
        let (scene, plan) = (&bench.scene, bench.plan.as_ref().unwrap());
        let report = obscura::headless::json::casters(scene, plan);
        let rows: Vec<_> = report.into_iter().filter(|row| row.light == light).collect();
        assert!(rows.len() > 40 && rows.iter().any(|row| row.case.is_none()), "{rows:?}");
        let expected: Vec<_> = rows
            .iter()
            .flat_map(|row| {
                let case = row.case.map_or("-".into(), |case| case.to_string());
                [case, row.method.words().to_owned(), row.caster.clone()]
            })
            .collect();
        let found = labels(&harness);
        assert!(found.windows(expected.len()).any(|part| *part == expected), "light {light}: {found:?} without {expected:?}");
    }
}

/// A stock scene, planned.
fn reflecting(name: &str) -> Bench {
    let mut bench = Bench::new();
    bench.scene = scene::stock::build(name).unwrap().unwrap();
    bench.settings = Settings { size: [320, 180], ..Settings::default() };
    let (pose, plan) = obscura::director::stage(&bench.settings, &bench.scene, &Capabilities::complete()).unwrap();
    (bench.pose, bench.plan) = (pose, Some(plan));
    bench
}

#[test]
fn mirrors_are_chosen_and_told() {
    let mut harness = open(reflecting("barbershop"));
    let default = Mirrors::default();
    let told = |harness: &Harness<'_, Bench>| labels(harness).into_iter().find(|words| words.contains("views drawn")).unwrap();
    let plan = harness.state().plan.clone().unwrap();
    assert!(plan.views.len() > 3);
    let expected = format!("{} views drawn, of 9 at worst for 2 mirrors and 4 bounces (Kilgard).", plan.views.len());
    assert_eq!(told(&harness), expected);
    let bits = labels(&harness).into_iter().find(|words| words.starts_with("In this frame: ")).unwrap();
    let mirror_bits = plan.budget.mirror_mask.count_ones();
    // A view of this room is counted in batches.
    assert_eq!(plan.bits_in_use().verdict_mask.count_ones(), 1);
    let [below, count] = [7 - mirror_bits, 6 - mirror_bits];
    let expected = format!("7-{} mirror level, {below} shadowed by a batch before, {count}-0 shadow count.", 8 - mirror_bits);
    assert_eq!(bits, format!("In this frame: {expected}"));
    let cells = labels(&harness).into_iter().filter(|words| words == " M ").count() as u32;
    assert_eq!(cells, mirror_bits);

    let mirrors = |harness: &Harness<'_, Bench>| settings(harness).mirrors;
    click(&mut harness, "One bounce");
    assert_eq!(mirrors(&harness), Mirrors { mode: MirrorMode::Stencil, ..default.clone() });
    click(&mut harness, "Unbounded");
    assert_eq!(mirrors(&harness), Mirrors { mode: MirrorMode::Unbounded, ..default.clone() });
    click(&mut harness, "No mirrors");
    assert_eq!(mirrors(&harness), Mirrors { mode: MirrorMode::Off, ..default.clone() });
    click(&mut harness, "Mirrors in mirrors");
    click(&mut harness, "Fade");
    assert_eq!(mirrors(&harness), Mirrors { last: LastBounce::Fade, ..default.clone() });
    click(&mut harness, "Grey");
    harness.get_by_label_contains("Fresnel").click();
    harness.run_steps(3);
    assert_eq!(mirrors(&harness), Mirrors { fresnel: true, ..default.clone() });
    harness.get_by_label_contains("Fresnel").click();
    harness.run_steps(3);

    // Each mirror of the scene has its switch.
    for mirror in harness.state().scene.mirrors.clone() {
        harness.get_by_role_and_label(Role::CheckBox, &mirror.name).click();
        harness.run_steps(3);
        let place = SurfacePlace { node: mirror.node, primitive: mirror.primitive };
        assert_eq!(mirrors(&harness).edits, [(place, false)].into());
        harness.get_by_role_and_label(Role::CheckBox, &mirror.name).click();
        harness.run_steps(3);
        assert_eq!(mirrors(&harness), default, "{}", mirror.name);
    }
    assert_eq!(harness.state().actions, []);
}

#[test]
fn figures_are_asked_for_by_a_click() {
    let mut harness = open(Bench::new());
    harness.get_by_label("Figures").click();
    harness.run_steps(3);
    click(&mut harness, "Figure 3, middle: The same without the stencil");
    let number = obscura::figures::TABLE.iter().position(|figure| figure.name == "k03b").unwrap();
    assert_eq!(harness.state().actions, [Action::Figure(number)]);
    assert!(labels(&harness).iter().any(|words| words == obscura::figures::TABLE[number].seen), "what to see in it");
}

#[test]
fn solids_are_put_together_by_choice() {
    let mut harness = open(reflecting("csg"));
    harness.get_by_label("Solids").click();
    harness.run_steps(3);
    let csg = |harness: &Harness<'_, Bench>| settings(harness).csg;
    for (words, operation) in [
        ("A or B", Operation::Union),
        ("A and B", Operation::Intersection),
        ("B minus A", Operation::BMinusA),
        ("Apart", Operation::Off),
    ] {
        click(&mut harness, words);
        assert_eq!(csg(&harness), Csg { operation: Some(operation), ..Csg::default() });
    }
    click(&mut harness, "A minus B");
    assert_eq!(csg(&harness), Csg::default(), "what the scene means need not be said");
    let gear = harness.state().scene.nodes.iter().position(|node| node.name == "gear").unwrap();
    harness.get_by_role_and_label(Role::ComboBox, "A").click();
    harness.run_steps(3);
    click(&mut harness, &format!("gear ({gear})"));
    assert_eq!(csg(&harness), Csg { a: Some(gear), ..Csg::default() });
}

#[test]
fn halos_are_switched_for_each_object() {
    let mut harness = open(reflecting("halo"));
    harness.get_by_label("Halos").click();
    harness.run_steps(3);
    let scene = scene::stock::build("halo").unwrap().unwrap();
    let node = |name: &str| scene.nodes.iter().position(|node| node.name == name).unwrap();
    for (name, on) in [("column 0", true), ("floor", true)] {
        harness.get_by_role_and_label(Role::CheckBox, &format!("Halo: {name}")).click();
        harness.run_steps(3);
        assert_eq!(settings(&harness).halos.edits, [(node(name), on)].into());
        harness.get_by_role_and_label(Role::CheckBox, &format!("Halo: {name}")).click();
        harness.run_steps(3);
        assert_eq!(settings(&harness).halos, Halos::default());
    }
}

#[test]
fn planar_shadows_are_chosen_and_told() {
    let mut harness = open(reflecting("figure7"));
    let default = Planar::default();
    let planar = |harness: &Harness<'_, Bench>| settings(harness).planar;
    for (title, mode) in [
        ("Naive", PlanarMode::Naive),
        ("Stencil, blended", PlanarMode::StencilBlend),
        ("Stencil, relit", PlanarMode::StencilRelight),
        ("Many lights", PlanarMode::Multi),
        ("Hybrid", PlanarMode::Hybrid),
    ] {
        click(&mut harness, title);
        assert_eq!(planar(&harness), Planar { mode, ..default.clone() });
    }
    click(&mut harness, "Volumes alone");
    assert_eq!(planar(&harness).hybrid, HybridPart::Volumes);
    click(&mut harness, "Both kinds");
    click(&mut harness, "No planar shadows");
    assert_eq!(planar(&harness), default);
    for receiver in harness.state().scene.receivers.clone() {
        harness.get_by_role_and_label(Role::CheckBox, &receiver.name).click();
        harness.run_steps(3);
        let place = SurfacePlace { node: receiver.node, primitive: receiver.primitive };
        assert_eq!(planar(&harness).edits, [(place, false)].into());
        harness.get_by_role_and_label(Role::CheckBox, &receiver.name).click();
        harness.run_steps(3);
        assert_eq!(planar(&harness), default, "{}", receiver.name);
    }
    // A click takes the tile away and brings it back; Z begins and Esc ends that.
    let tile = harness.state().scene.receivers[0].clone();
    let place = SurfacePlace { node: tile.node, primitive: tile.primitive };
    let on_tile = DVec3::new(0.1, 0.0, 1.1);
    click_at(&mut harness, on_tile);
    assert_eq!(planar(&harness), default, "a click alone marks nothing");
    press(&mut harness, Key::Z);
    for edits in [[(place, false)].into(), default.edits.clone()] {
        click_at(&mut harness, on_tile);
        assert_eq!(planar(&harness).edits, edits);
        let actions = std::mem::take(&mut harness.state_mut().actions);
        assert!(matches!(&actions[..], [Action::Tell(Notice { topic: Topic::Receivers, .. })]), "{actions:?}");
    }
    press(&mut harness, Key::Escape);
    click_at(&mut harness, on_tile);
    assert_eq!(planar(&harness), default);
}

/// Clicks where a point of the world is on the picture.
fn click_at(harness: &mut Harness<'_, Bench>, point: DVec3) {
    let bench = harness.state();
    let at = project(&camera(bench), bench.picture, point).unwrap();
    harness.hover_at(at);
    harness.run_steps(1);
    harness.drag_at(at);
    harness.run_steps(1);
    harness.drop_at(at);
    harness.run_steps(3);
}

#[test]
fn a_click_makes_a_mirror_of_what_is_flat_and_takes_it_away() {
    let mut harness = open(reflecting("barbershop"));
    let edits = |harness: &Harness<'_, Bench>| settings(harness).mirrors.edits;
    let said = |harness: &mut Harness<'_, Bench>| -> (Tone, String) {
        let actions = std::mem::take(&mut harness.state_mut().actions);
        let [Action::Tell(Notice { topic: Topic::Mirrors, tone, words })] = &actions[..] else { panic!("{actions:?}") };
        (*tone, words.clone())
    };
    let bench = harness.state();
    let eye = camera(bench);
    let (scene, pose) = (&bench.scene, &bench.pose);
    let seen = |point: DVec3| obscura::scene::pick::surface_at(scene, pose, eye.eye, point - eye.eye, 1e-3);
    // Places on a mirror, on something flat and on something that is not, each seen by the eye.
    let (mut mirror, mut flat, mut solid) = (None, None, None);
    for step in 0..400 {
        let pixel = [step % 20 * 16 + 8, step / 20 * 9 + 4];
        let corners = eye.near_rectangle_of([pixel[0], pixel[1], 1, 1], [320, 180]);
        let point = eye.eye + (corners.iter().sum::<DVec3>() / 4.0 - eye.eye) * 3.0;
        let Some(place) = seen(point) else { continue };
        let marked = scene.mirrors.iter().any(|mirror| mirror.node == place.node && mirror.primitive == place.primitive);
        let kind = match scene.can_mirror(place) {
            _ if marked => &mut mirror,
            Ok(()) => &mut flat,
            Err(_) => &mut solid,
        };
        kind.get_or_insert((point, place));
    }
    let name = |place: SurfacePlace| scene.nodes[place.node].name.clone();
    let [mirror, flat, solid] =
        [mirror, flat, solid].map(|found| found.map(|(point, place)| (point, place, name(place))).unwrap());
    let before = settings(&harness);

    click_at(&mut harness, flat.0);
    assert_eq!(settings(&harness).mirrors, before.mirrors, "a click alone makes no mirror");
    press(&mut harness, Key::X);
    click_at(&mut harness, flat.0);
    assert_eq!(edits(&harness), [(flat.1, true)].into());
    assert_eq!(said(&mut harness), (Tone::Good, format!("{} is a mirror.", flat.2)));
    click_at(&mut harness, mirror.0);
    assert_eq!(edits(&harness), [(flat.1, true), (mirror.1, false)].into());
    assert_eq!(said(&mut harness), (Tone::Good, format!("{} is no mirror any more.", mirror.2)));
    click_at(&mut harness, solid.0);
    let (tone, words) = said(&mut harness);
    assert!(tone == Tone::Warning && words.starts_with(&format!("{} cannot be a mirror: ", solid.2)), "{words}");
    click_at(&mut harness, flat.0);
    click_at(&mut harness, mirror.0);
    assert_eq!(settings(&harness), before, "twice, and all is as it was");
    harness.state_mut().actions.clear();
    press(&mut harness, Key::Escape);
    click_at(&mut harness, flat.0);
    assert_eq!(settings(&harness).mirrors, before.mirrors);
    assert_eq!(harness.state().actions, []);
}

#[test]
fn the_legend_counts_the_classes() {
    let mut harness = open(planned(Show::Cases, 0));
    harness.run_steps(2);
    let bench = harness.state();
    let classes = cases::classes(&bench.scene, &bench.plan.as_ref().unwrap().volumes, 0, true);
    assert_eq!(classes.len(), bench.scene.instances().count());
    for class in Class::ALL {
        let count = classes.iter().filter(|it| **it == class).count();
        assert!(harness.query_by_label(&format!("{count} {}", class.name())).is_some(), "{class:?}");
    }
}

#[test]
fn each_show_changes_just_the_show() {
    let mut harness = open(Bench::new());
    for show in Show::ALL.into_iter().rev() {
        let name = show.name();
        click(&mut harness, &format!("{}{}", name[..1].to_uppercase(), &name[1..]));
        assert_eq!(settings(&harness), Settings { show, ..Settings::default() });
    }
}

#[test]
fn samples_and_switches_change_themselves() {
    let mut harness = open(Bench::new());
    click(&mut harness, "4 a pixel");
    assert_eq!(settings(&harness), Settings { samples: 4, ..Settings::default() });
    click(&mut harness, "1 a pixel");
    assert_eq!(settings(&harness), Settings::default());
    harness.get_by_label("File").click();
    harness.run_steps(5);
    harness.get_by_label("Smooth terminator").click();
    harness.get_by_label("Floor beneath a file's scene").click();
    harness.run_steps(3);
    assert_eq!(settings(&harness), Settings { smooth_terminator: false, floor: true, ..Settings::default() });
}

#[test]
fn what_the_device_lacks_is_said_and_switched_off() {
    let mut bench = Bench::new();
    bench.capabilities =
        Capabilities { four_samples: false, depth_clip_control: false, timestamps: false, ..Capabilities::complete() };
    let mut harness = open(bench);
    click(&mut harness, "4 a pixel");
    press(&mut harness, Key::M);
    assert_eq!(settings(&harness), Settings::default());
    harness.get_by_label("Device").click();
    harness.run_steps(5);
    let lacks = harness.state().capabilities.lacks();
    assert_eq!(lacks.len(), 3);
    for lack in lacks {
        assert!(harness.query_by_label_contains(lack.feature).is_some(), "{}", lack.feature);
        assert!(harness.query_by_label_contains(lack.instead).is_some(), "{}", lack.instead);
    }
}

#[test]
fn a_scene_is_asked_for_not_set() {
    let mut harness = open(Bench::new());
    click(&mut harness, "grid");
    assert_eq!(harness.state().actions, [Action::Open(SceneChoice::Stock("grid".into()))]);
    assert_eq!(settings(&harness), Settings::default(), "the running scene stays until the new one is there");
}

#[test]
fn the_path_field_opens_from_a_folded_scene_and_what_is_typed_early_is_no_command() {
    let mut harness = open(Bench::new());
    harness.get_by_label("Scene").click();
    harness.run_steps(10);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::O);
    // In one pass with Ctrl+O, as they come while a frame takes long.
    harness.key_press(Key::T);
    harness.key_press(Key::N);
    harness.run_steps(10);
    assert!(harness.get_by_label("Path").is_focused());
    assert_eq!(settings(&harness), Settings::default());
    assert_eq!(harness.state().actions, []);
}

#[test]
fn a_typed_path_is_opened() {
    let mut harness = open(Bench::new());
    harness.key_press_modifiers(Modifiers::COMMAND, Key::O);
    harness.run_steps(3);
    assert!(harness.get_by_label("Path").is_focused());
    harness.get_by_label("Path").type_text("/models/n \u{e9}.glb");
    harness.run_steps(2);
    press(&mut harness, Key::Enter);
    assert_eq!(harness.state().actions, [Action::Open(SceneChoice::File("/models/n \u{e9}.glb".into()))]);
    assert_eq!(settings(&harness), Settings::default(), "letters typed into the field are no commands");
}

#[test]
fn recent_files_open_again() {
    let mut bench = Bench::new();
    bench.preferences.opened("/models/duck.glb".as_ref());
    let mut harness = open(bench);
    harness.get_by_label("File").click();
    harness.run_steps(5);
    click(&mut harness, "Recent files");
    click(&mut harness, "duck.glb");
    assert_eq!(harness.state().actions, [Action::Open(SceneChoice::File("/models/duck.glb".into()))]);
}

#[test]
fn lights_are_edited_one_by_one_and_reset() {
    let mut harness = open(Bench::new());
    harness.get_by_label("Light 1 on").click();
    harness.run_steps(3);
    let off = LightEdit { on: Some(false), ..LightEdit::default() };
    assert_eq!(settings(&harness).lights, [(1, off)].into());
    harness.get_by_label("Light 1 on").click();
    harness.run_steps(3);
    assert_eq!(settings(&harness), Settings::default(), "switched on again, nothing is left of it");

    // Unfold light 0 by picking it on the picture, as people do.
    let bench = harness.state();
    let at = project(&camera(bench), bench.picture, bench.pose.lights[0].position).unwrap();
    harness.drag_at(at);
    harness.run_steps(2);
    harness.drop_at(at);
    harness.run_steps(6);
    harness.get_by_label("Casts shadows").click();
    harness.run_steps(3);
    let shadowless = LightEdit { shadows: Some(false), ..LightEdit::default() };
    assert_eq!(settings(&harness).lights, [(0, shadowless)].into());
    click(&mut harness, "Reset light 0");
    assert_eq!(settings(&harness), Settings::default());
}

#[test]
fn a_light_follows_the_mouse() {
    let mut harness = open(Bench::new());
    let bench = harness.state();
    let (picture, start, camera) = (bench.picture, bench.pose.lights[0].position, camera(bench));
    let from = project(&camera, picture, start).unwrap();
    let to = from + vec2(-120.0, 60.0);
    harness.drag_at(from);
    harness.run_steps(2);
    for at in [from + vec2(-30.0, 20.0), to] {
        harness.hover_at(at);
        harness.run_steps(2);
    }
    harness.drop_at(to);
    harness.run_steps(2);
    let settings = settings(&harness);
    let moved = settings.lights[&0].position.unwrap();
    assert!(project(&camera, picture, moved).unwrap().distance(to) < 1.0, "the icon is under the mouse");
    assert!((moved - start).dot(camera.forward).abs() < 1e-6, "in the plane facing the camera");
    assert_eq!(settings.camera, CameraChoice::First, "the camera stays");
}

#[test]
fn dragging_the_picture_moves_the_eye_about_its_target() {
    let mut harness = open(Bench::new());
    let before = camera(harness.state());
    let from = harness.state().picture.center() + vec2(-200.0, 300.0);
    harness.drag_at(from);
    harness.run_steps(2);
    harness.hover_at(from + vec2(90.0, 40.0));
    harness.run_steps(2);
    harness.drop_at(from + vec2(90.0, 40.0));
    harness.run_steps(2);
    let CameraChoice::Free { eye, target } = harness.state().settings.camera else { panic!("the camera is free now") };
    assert!(target.distance(before.target()) < 1e-6);
    assert!(eye.distance(before.eye) > 0.1 && (eye.distance(target) - before.focus_distance).abs() < 1e-6);
    assert!(harness.state().settings.lights.is_empty(), "no light moved");
}

#[test]
fn a_failure_is_chosen_read_and_switched_off_to_compare() {
    let mut harness = open(Bench::new());
    harness.get_by_label("Failures").click();
    harness.run_steps(8);
    assert!(harness.query_by_label("Make this mistake").is_none(), "none is chosen yet");
    for row in &failures::TABLE {
        assert!(harness.query_by_label(row.title).is_some(), "{}", row.title);
    }
    let row = failures::row(Failure::NoDarkCap);
    click(&mut harness, row.title);
    assert_eq!(harness.state().actions, [Action::Demonstrate(Failure::NoDarkCap)]);
    for words in [row.seen, row.why, row.cure] {
        assert!(harness.query_by_label(words).is_some(), "{words}");
    }
    // What the window does of it.
    let size = settings(&harness).size;
    harness.state_mut().settings = failures::demonstration(Failure::NoDarkCap, &Settings { size, ..Settings::default() });
    let on = settings(&harness);
    harness.run_steps(2);
    harness.get_by_label("Make this mistake").click();
    harness.run_steps(3);
    assert_eq!(settings(&harness), Settings { failure: None, ..on.clone() });
    assert!(harness.query_by_label(row.why).is_some(), "the sentences stay");
    harness.get_by_label("Make this mistake").click();
    harness.run_steps(3);
    assert_eq!(settings(&harness), on);
}

#[test]
fn keys_do_what_the_table_says() {
    let mut harness = open(Bench::new());
    for (key, technique) in [Key::Num1, Key::Num2, Key::Num3, Key::Num4].into_iter().zip(Technique::ALL) {
        press(&mut harness, key);
        assert_eq!(settings(&harness), Settings { technique, ..Settings::default() });
    }
    for technique in Technique::ALL.into_iter().skip(4).chain([Technique::None]) {
        press(&mut harness, Key::T);
        assert_eq!(settings(&harness).technique, technique, "after the last comes the first");
    }
    press(&mut harness, Key::V);
    assert_eq!(settings(&harness).show, Show::Stencil);
    press(&mut harness, Key::L);
    assert_eq!(settings(&harness).light, 1);
    press(&mut harness, Key::L);
    assert_eq!(settings(&harness).light, 0);
    press(&mut harness, Key::M);
    assert_eq!(settings(&harness).samples, 4);
    press(&mut harness, Key::C);
    assert_eq!(settings(&harness).camera, CameraChoice::Named("above".into()));
    press(&mut harness, Key::R);
    assert_eq!(settings(&harness).camera, CameraChoice::First);
    press(&mut harness, Key::O);
    assert_eq!(harness.state().preferences.mode, Mode::Fly);
    press(&mut harness, Key::Space);
    assert!(!harness.state().preferences.clock.playing);
    press(&mut harness, Key::Period);
    assert!((settings(&harness).time - obscura::app::clock::STEP).abs() < 1e-9);
    press(&mut harness, Key::CloseBracket);
    assert_eq!(harness.state().preferences.clock.speed, 2.0);
    press(&mut harness, Key::G);
    assert!(!harness.state().preferences.icons);
    assert_eq!(harness.state().actions, []);
    press(&mut harness, Key::N);
    press(&mut harness, Key::F12);
    press(&mut harness, Key::F5);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Q);
    harness.run_steps(2);
    let scene = Action::Open(SceneChoice::Stock("cubes".into()));
    assert_eq!(harness.state().actions, [scene, Action::Screenshot, Action::Reload, Action::Quit]);
}

#[test]
fn held_keys_fly() {
    let mut harness = open(Bench::new());
    let before = camera(harness.state());
    harness.key_down(Key::W);
    harness.run_steps(6);
    harness.key_up(Key::W);
    harness.run_steps(2);
    let CameraChoice::Free { eye, .. } = harness.state().settings.camera else { panic!("the camera is free now") };
    let way = eye - before.eye;
    assert!(way.length() > 0.05 && way.normalize().dot(before.forward) > 0.999, "{way}");
}

#[test]
fn copy_and_screenshot_are_asked_for() {
    let mut harness = open(Bench::new());
    click(&mut harness, "Copy");
    click(&mut harness, "Save picture");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::C);
    harness.run_steps(2);
    assert_eq!(harness.state().actions, [Action::CopyCommand, Action::Screenshot, Action::CopyCommand]);
    assert_eq!(settings(&harness), Settings::default());
}

#[test]
fn the_help_lists_every_key() {
    let mut harness = open(Bench::new());
    assert!(harness.query_by_label("Keys and mouse").is_none());
    press(&mut harness, Key::F1);
    harness.run_steps(5);
    for row in keys::TABLE {
        assert!(harness.query_all_by_label(row.keys).next().is_some(), "{} is listed", row.keys);
        assert!(harness.query_all_by_label(row.about).next().is_some(), "{} is explained", row.keys);
    }
    press(&mut harness, Key::Escape);
    harness.run_steps(5);
    assert!(harness.query_all_by_label(keys::TABLE[0].about).next().is_none(), "Esc closes it");
}

#[test]
fn errors_show_and_go() {
    let mut bench = Bench::new();
    let words = "broken.glb: accessor 3 reaches past its buffer view";
    bench.notices.push(Notice { topic: Topic::Scene, tone: Tone::Error, words: words.into() });
    let mut harness = open(bench);
    assert!(harness.query_by_label(words).is_some());
    click(&mut harness, "Dismiss");
    assert_eq!(harness.state().actions, [Action::Dismiss(Topic::Scene)]);
    press(&mut harness, Key::F2);
    harness.run_steps(5);
    assert!(harness.query_by_label("Save picture").is_none(), "the panel is hidden");
    assert!(harness.query_by_label(words).is_some(), "but errors still show");
}

#[test]
fn importer_notes_are_there_to_unfold() {
    let mut harness = open(Bench::new());
    harness.get_by_label("Import: 1 note").click();
    harness.run_steps(5);
    assert!(harness.query_by_label_contains("material `glass`").is_some());
}

#[test]
fn the_picture_has_the_rest_of_the_window() {
    let mut harness = open(Bench::new());
    let with = harness.state().settings.size;
    assert!(with[0] > 700 && with[0] < 1010, "{with:?}");
    press(&mut harness, Key::F2);
    harness.run_steps(5);
    assert!(harness.state().settings.size[0] > with[0] + 250);
}

#[test]
fn time_is_played_paused_and_stepped() {
    let mut harness = open(Bench::new());
    click(&mut harness, "Pause");
    assert!(!harness.state().preferences.clock.playing);
    click(&mut harness, "Step");
    assert!(settings(&harness).time > 0.0);
    click(&mut harness, "Back");
    assert_eq!(settings(&harness), Settings::default());
}

#[test]
fn the_frame_is_told_in_numbers() {
    let mut bench = Bench::new();
    bench.history.push(FrameNumbers {
        interval_ms: Some(16.7),
        cpu_ms: 1.25,
        gpu_ms: Some(7.5),
        draws: 321,
        triangles: 1_234_567,
        volumes: 42,
        volume_triangles: 98_765,
    });
    let harness = open(bench);
    for number in ["1.25 ms", "7.50 ms", "321", "1 234 567", "42", "98 765"] {
        assert!(harness.query_by_label(number).is_some(), "{number}");
    }
}

#[test]
fn a_view_is_verified_and_says_what_was_found_until_it_changes() {
    let mut harness = open(Bench::new());
    click(&mut harness, "Verify this view");
    assert!(harness.state().actions.contains(&Action::Verify));
    let pixels = vec![WrongPixel { x: 3, y: 4, how: Wrong::Lit }];
    let found = Comparison { decided: 900, lit: 500, shadow: 300, edges: 77, pixels: pixels.clone() };
    let settings = harness.state().settings.clone();
    let surfaces = SurfaceComparison { decided: 950, edges: 27, ..SurfaceComparison::default() };
    let finding = Finding { settings, lights: vec![("lamp".into(), found)], surfaces, wrong: pixels };
    harness.state_mut().verification = Verification::found(finding);
    harness.run_steps(2);
    let words = "lamp: 900 decided, 77 edges, 1 wrong";
    assert!(harness.query_by_label_contains(words).is_some());
    assert!(harness.query_by_label_contains("surfaces: 950 decided, 27 edges, 0 wrong").is_some());
    harness.state_mut().settings.fov = Some(33.0);
    harness.run_steps(2);
    assert!(harness.query_by_label_contains(words).is_none(), "of another view it says nothing");
}

#[test]
fn depth_complexity_is_told_in_numbers_while_it_is_shown() {
    let mut bench = Bench::new();
    bench.complexity = Some(Tally::of(&[0, 1, 3, 255], 2, Complexity::Updates));
    let mut harness = open(bench);
    assert!(harness.query_by_label_contains("255 at most").is_none());
    click(&mut harness, "Complexity");
    assert_eq!(harness.state().settings.show, Show::Complexity);
    assert!(harness.query_by_label_contains("255 at most (pixel 1,1)").is_some());
    assert!(harness.query_by_label_contains("1 pixels reached 255").is_some(), "a full byte is said to be full");
    click(&mut harness, "Fragments");
    assert_eq!(harness.state().settings.complexity, Complexity::Fragments);
    assert!(harness.query_by_label_contains("at most").is_none(), "those were updates");
}

#[test]
fn the_playground_is_edited_live() {
    let mut harness = open(Bench::new());
    harness.get_by_label("Stencil playground").click();
    harness.run_steps(3);
    click(&mut harness, "Open the playground");
    assert_eq!(harness.state().settings.show, Show::Playground);
    let shapes = |harness: &Harness<'_, Bench>| harness.state().settings.playground.board.shapes.len();
    let before = shapes(&harness);
    click(&mut harness, "Add a shape");
    assert_eq!(shapes(&harness), before + 1);
    harness.get_by_label("1 initial values").click();
    harness.run_steps(3);
    harness.get_by_label("Back faces apart").click();
    harness.run_steps(3);
    let first = &harness.state().settings.playground.board.shapes[0];
    assert_eq!(first.back, Some(first.front));
    click(&mut harness, "Remove");
    assert_eq!(shapes(&harness), before);
    assert_ne!(harness.state().settings.playground.board.shapes[0].name, "initial values");
    click(&mut harness, "OpenGL");
    click(&mut harness, "Copy calls");
    let copied =
        |command: &egui::OutputCommand| matches!(command, egui::OutputCommand::CopyText(text) if text.contains("glStencilFunc("));
    assert!(
        harness.output().platform_output.commands.iter().any(copied)
            || harness.query_by_label_contains("glStencilFunc(").is_some()
    );
}

#[test]
fn a_shape_follows_the_mouse() {
    let mut bench = Bench::new();
    bench.settings.show = Show::Playground;
    // A shape's size is a share of the picture's height, and this picture is tall.
    bench.settings.playground.board.shapes.iter_mut().for_each(|shape| shape.size = [0.02; 2]);
    bench.settings.playground.board.shapes[1].at = [0.31, 0.46];
    let camera = bench.settings.camera.clone();
    let mut harness = open(bench);
    let rect = harness.state().picture;
    let at = |harness: &Harness<'_, Bench>| harness.state().settings.playground.board.shapes[1].at;
    let before = at(&harness);
    let from = rect.min + rect.size() * vec2(0.31, 0.46);
    harness.drag_at(from);
    harness.run_steps(2);
    harness.hover_at(from + vec2(30.0, 20.0));
    harness.run_steps(2);
    harness.drop_at(from + vec2(30.0, 20.0));
    harness.run_steps(2);
    let moved = [at(&harness)[0] - before[0], at(&harness)[1] - before[1]];
    assert!((moved[0] - 30.0 / rect.width()).abs() < 1e-3 && (moved[1] - 20.0 / rect.height()).abs() < 1e-3, "{moved:?}");
    assert_eq!(harness.state().settings.camera, camera, "the eye stays");
}

#[test]
fn decals_are_chosen_in_the_panel() {
    let mut harness = open(Bench::new());
    harness.get_by_label("Decals").click();
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("This scene has none").is_some());
    for mode in DecalMode::ALL {
        click(&mut harness, &format!("Decals: {}", mode.name()));
        assert_eq!(harness.state().settings.decals, mode);
    }
}

#[test]
fn diagrams_are_chosen_in_the_panel_and_explained_there() {
    let mut harness = open(Bench::new());
    assert!(harness.query_by_label("Drawn in").is_none(), "nothing is cut open yet");
    harness.state_mut().settings.show = Show::Rays;
    harness.run_steps(3);
    for what in Diagram::ALL {
        let words = what.name().replace('-', " ");
        let title = words[..1].to_uppercase() + &words[1..];
        // What is shown, and a section, may have the same name: the row that begins with these words is meant.
        let row = harness.get_by_label("Drawn in").rect().top();
        let named = harness.get_all_by_role_and_label(Role::Button, &title);
        let below = named.filter(|button| button.rect().bottom() > row);
        below.min_by(|a, b| a.rect().top().total_cmp(&b.rect().top())).unwrap().click();
        harness.run_steps(3);
        assert_eq!(harness.state().settings.diagram, what);
        let about = what.about();
        let about = format!("{}{}.", about[..1].to_uppercase(), &about[1..]);
        assert!(harness.query_by_label(&about).is_some(), "{about}");
    }
}

#[test]
fn what_a_picture_dissolves_into_is_chosen_in_the_panel() {
    let mut harness = open(Bench::new());
    harness.get_by_label("Dissolve").click();
    harness.run_steps(3);
    harness.get_by_role_and_label(Role::ComboBox, "Into scene").click();
    harness.run_steps(3);
    // Scenes to open have the same names; the list that has just come down is the last.
    harness.get_all_by_role_and_label(Role::Button, "cubes").last().unwrap().click();
    harness.run_steps(3);
    assert_eq!(harness.state().settings.dissolve.scene.as_deref(), Some("cubes"));
    harness.get_by_role_and_label(Role::ComboBox, "Into technique").click();
    harness.run_steps(3);
    harness.get_all_by_role_and_label(Role::Button, TABLE[1].title).last().unwrap().click();
    harness.run_steps(3);
    assert!(harness.state().settings.dissolve.into.is_some());
}
