//! Views by way of mirrors: what the plan says of them, and what they leave behind.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that fails may panic")]

mod common;

use common::{Build, Stage, cube, mesh, seen_from};
use glam::{DMat4, DVec3, Vec3, Vec4};
use obscura::director;
use obscura::frame::state::Winding;
use obscura::frame::stencil::{BitBudget, StencilState};
use obscura::frame::validate::validate;
use obscura::frame::{Action, Capabilities, Draw, FramePlan, Target, identity_color};
use obscura::geometry::planar::reflection;
use obscura::gpu::readback;
use obscura::scene::{Material, Mirror, Reflective, Scene, stock};
use obscura::settings::{LastBounce, LightEdit, MirrorMode, Settings, Shading, Show, SurfacePlace, Technique, Texturing};

const SIZE: [u32; 2] = [320, 180];

const ROOMS: [&str; 6] = ["gallery", "barbershop", "corridor", "terraces", "figure3", "kaleidoscope"];

fn room(name: &str) -> Scene {
    stock::build(name).unwrap().unwrap()
}

fn settings(bounces: u32) -> Settings {
    let mut settings = Settings { technique: Technique::ZFail, size: SIZE, ..Settings::default() };
    settings.mirrors.bounces = bounces;
    settings
}

fn plan(scene: &Scene, settings: &Settings) -> FramePlan {
    director::stage(settings, scene, &Capabilities::complete()).unwrap().1
}

#[test]
fn a_reflected_camera_sees_the_reflected_world() {
    let planned = plan(&room("barbershop"), &settings(3));
    for view in &planned.views[1..] {
        let window = view.through.as_ref().unwrap();
        let before = planned.views[window.parent].camera.clip_from_world();
        let mirrored = before * DMat4::from(reflection(window.plane));
        let error = (view.camera.clip_from_world() - mirrored).abs();
        assert!(error.to_cols_array().iter().all(|error| *error < 1e-9), "{error}");
        let near = view.camera.near_rectangle().map(|corner| mirrored * corner.extend(1.0));
        let corners = near.map(|corner| (corner / corner.w).truncate().truncate());
        let expected = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        assert!(corners.iter().zip(expected).all(|(at, expected)| at.distance(expected.into()) < 1e-6), "{corners:?}");
        assert_eq!(view.winding, if window.path.len() % 2 == 1 { Winding::Cw } else { Winding::Ccw });
    }
}

#[test]
fn every_level_has_a_value_of_its_own_in_the_mirror_bits() {
    for deepest in 1..=8 {
        let budget = BitBudget::default().with_mirrors(deepest);
        let levels: Vec<u8> = (0..=deepest).map(|mirrors| budget.level(mirrors)).collect();
        for (index, level) in levels.iter().enumerate() {
            assert_eq!(level & !budget.mirror_mask, 0);
            assert!(!levels[..index].contains(level), "{levels:?}");
        }
        assert_eq!(levels[0], 0, "the eye's own pixels are not tagged");
        assert_eq!(budget.count_mask, !budget.mirror_mask);
        assert_eq!(budget.mirror_mask.count_ones(), [1, 2, 2, 3, 3, 3, 3, 4][deepest as usize - 1]);
    }
}

#[test]
fn no_mirror_is_seen_in_itself_and_views_are_far_fewer_than_the_worst_case() {
    for name in ROOMS {
        let planned = plan(&room(name), &settings(4));
        assert!(planned.views.len() > 1, "{name}: its mirrors show");
        for view in &planned.views {
            assert!(view.path().windows(2).all(|pair| pair[0] != pair[1]), "{name}: {:?}", view.path());
            assert!(view.path().len() <= 4);
        }
        let (drawn, worst) = (planned.views.len() as u64, planned.reflections.worst_case);
        assert!(drawn <= worst, "{name}: {drawn} of {worst}");
        if name == "kaleidoscope" {
            assert!(drawn * 5 <= worst, "{drawn} of {worst}");
        }
    }
}

/// Drawn with and without reflections: what a frame leaves in depth is the same to the last bit, no pixel stays
/// tagged, and outside the mirrors count and colour are the same too.
#[test]
fn mirrors_leave_depth_and_stencil_as_they_were() {
    let mut stage = Stage::new();
    let mut reflected = 0;
    for name in ROOMS {
        let scene = room(name);
        stage.set_scene(&scene);
        let seen = stage.shoot(&Settings { show: Show::Surfaces, ..settings(2) }, &scene);
        let instances = scene.instances().count();
        let own: Vec<[u8; 3]> = (1..=instances).map(|number| identity_color(u32::try_from(number).unwrap())).collect();
        let is_own: Vec<bool> = seen.image.pixels().map(|pixel| own.contains(&[pixel[0], pixel[1], pixel[2]])).collect();

        // Frames with mirrors are drawn forward: so is the one without them.
        let mut on = settings(2);
        on.lighting.shading = Shading::Forward;
        let with = stage.shoot(&on, &scene);
        let (depth, stencil) = (readback::depth(&stage.context, &stage.renderer).unwrap(), stage.stencil());
        let mut off = on.clone();
        off.mirrors.mode = MirrorMode::Off;
        let without = stage.shoot(&off, &scene);
        let (depth_off, stencil_off) = (readback::depth(&stage.context, &stage.renderer).unwrap(), stage.stencil());

        assert!(depth.iter().zip(&depth_off).all(|(a, b)| a.to_bits() == b.to_bits()), "{name}: depth");
        let budget = with.plan.budget;
        assert!(stencil.iter().all(|value| value & budget.mirror_mask == 0), "{name}: a pixel stays tagged");
        for (at, is_own) in is_own.iter().enumerate() {
            reflected += usize::from(!is_own);
            if *is_own {
                let mask = budget.count_mask;
                assert_eq!(stencil[at] & mask, stencil_off[at] & mask, "{name}: the count at {at}");
                let colors = [&with.image, &without.image].map(|image| image.as_raw()[at * 4..at * 4 + 4].to_vec());
                let apart = colors[0].iter().zip(&colors[1]).any(|(a, b)| a.abs_diff(*b) > 1);
                assert!(!apart, "{name}: {colors:?} at {at}");
            }
        }
    }
    assert!(reflected > 20_000, "{reflected} pixels in mirrors");
}

/// In a mirror with nothing before it, what is seen by way of two is what a brighter or paler mirror shows of it.
#[test]
fn what_lies_past_the_last_bounce_is_grey_or_fades() {
    let mut stage = Stage::new();
    let scene = room("barbershop");
    stage.set_scene(&scene);
    let picture = |stage: &mut Stage, bounces, last| {
        let mut settings = settings(bounces);
        settings.mirrors.last = last;
        stage.shoot(&settings, &scene).image
    };
    let one = picture(&mut stage, 1, LastBounce::Grey);
    let two = picture(&mut stage, 2, LastBounce::Grey);
    assert!(one != two, "the second mirror is grey in the first");
    assert!(picture(&mut stage, 1, LastBounce::Fade) == one, "the first bounce does not fade");
    let faded = picture(&mut stage, 2, LastBounce::Fade);
    assert!(faded != two, "the second does");
}

/// As wide as the picture, a texture has a pixel for each of the mirror's: then it shows what the stencil bounds. A
/// narrower one shows its own pixels.
#[test]
fn a_texture_of_the_pictures_size_shows_what_the_stencil_bounds() {
    let mut stage = Stage::new();
    for name in ["barbershop", "gallery", "figure3"] {
        let scene = room(name);
        stage.set_scene(&scene);
        let mut picture = |mode, texture| {
            let mut settings = settings(1);
            (settings.mirrors.mode, settings.mirrors.texture) = (mode, texture);
            stage.shoot(&settings, &scene).image
        };
        let stencil = picture(MirrorMode::Stencil, 256);
        let apart = |image: &image::RgbaImage| {
            let pairs = image.as_raw().iter().zip(stencil.as_raw());
            pairs.filter(|(a, b)| a.abs_diff(**b) > 2).count()
        };
        assert_eq!(apart(&picture(MirrorMode::Texture, SIZE[0])), 0, "{name}");
        assert!(apart(&picture(MirrorMode::Texture, SIZE[0] / 4)) > 500, "{name}: its pixels show");
    }
}

/// Without the stencil the reflection of what stands on the table shows below it, where nothing is in its way.
#[test]
fn unbounded_reflections_show_beside_their_mirror() {
    let mut stage = Stage::new();
    let scene = room("figure3");
    stage.set_scene(&scene);
    let mut picture = |mode, show| {
        let mut settings = Settings { show, ..settings(1) };
        settings.mirrors.mode = mode;
        stage.shoot(&settings, &scene).image
    };
    let off = picture(MirrorMode::Off, Show::Final);
    let bounded = picture(MirrorMode::Stencil, Show::Final);
    let unbounded = picture(MirrorMode::Unbounded, Show::Final);
    let differ = |a: &image::RgbaImage, b: &image::RgbaImage, x, y| {
        a.get_pixel(x, y).0.iter().zip(b.get_pixel(x, y).0).any(|(a, b)| a.abs_diff(b) > 20)
    };
    let pixels = || (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)));
    let beside = pixels().filter(|&(x, y)| !differ(&bounded, &off, x, y) && differ(&unbounded, &off, x, y)).count();
    assert!(beside > 500, "{beside} pixels");
    assert!(
        picture(MirrorMode::Unbounded, Show::Surfaces) == picture(MirrorMode::Stencil, Show::Surfaces),
        "exact values are shown by the stencil"
    );
}

/// A cube before a mirror, one light: drawn at once in final colours, and by adding up light, the picture is the same;
/// with shadows, without, and where the light's end leaves none to count.
#[test]
fn perfect_mirrors_look_the_same_drawn_directly_or_added_up() {
    let mut build = Build::new();
    build.floor(0.0, 9.0);
    let block = build.mesh(cube(0));
    build.place(block, DVec3::new(0.6, 1.0, 0.0), DVec3::splat(0.6));
    let corners = [[-2.5, 0.1, -3.0], [2.5, 0.1, -3.0], [2.5, 3.0, -3.0], [-2.5, 3.0, -3.0]];
    let pane = build.mesh(mesh("mirror", &corners, &[[0, 1, 2], [0, 2, 3]], 0));
    let node = build.place(pane, DVec3::ZERO, DVec3::ONE);
    let light = build.point_light(DVec3::new(2.0, 4.0, 1.5));
    let scene = build.0;
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let eye = seen_from(DVec3::new(-1.5, 2.0, 5.0), DVec3::new(0.3, 1.0, -1.0), SIZE);
    for (shadows, range) in [(true, None), (false, None), (true, Some(2.5)), (true, Some(0.01))] {
        for technique in [Technique::Auto, Technique::ZFail, Technique::None] {
            let mut settings = Settings { technique, ..eye.clone() };
            settings.mirrors.edits.insert(SurfacePlace { node, primitive: 0 }, true);
            settings.lights.insert(light, LightEdit { shadows: Some(shadows), range, ..LightEdit::default() });
            let direct = stage.shoot(&settings, &scene);
            assert_eq!(direct.plan.views.len(), 2);
            assert!(direct.plan.draws().any(|(_, draw)| draw.target == Target::Direct), "it is drawn directly");
            settings.lighting.texturing = Texturing::Once;
            let added = stage.shoot(&settings, &scene);
            assert!(added.plan.draws().all(|(_, draw)| draw.target != Target::Direct), "light is added up");
            let pairs = direct.image.as_raw().iter().zip(added.image.as_raw());
            let apart = pairs.filter(|(a, b)| a.abs_diff(**b) > 2).count();
            assert_eq!(apart, 0, "{} {shadows} {range:?}", technique.name());
        }
    }
}

/// A dark floor that reflects a glowing wall: with Fresnel it shows as much of it as one without whose reflectivity is
/// Schlick's of the angle at which the pixel sees it.
#[test]
fn fresnel_reflects_as_schlick_says() {
    const STRAIGHT: f64 = 0.1;
    let mut build = Build::new();
    build.floor(0.0, 30.0);
    build.0.materials[0].base_color = Vec4::new(0.0, 0.0, 0.0, 1.0);
    build.0.materials.push(Material { emissive: Vec3::splat(0.8), ..Material::default() });
    let corners = [[-60.0, 0.0, -25.0], [60.0, 0.0, -25.0], [60.0, 90.0, -25.0], [-60.0, 90.0, -25.0]];
    let wall = build.mesh(mesh("wall", &corners, &[[0, 1, 2], [0, 2, 3]], 2));
    build.place(wall, DVec3::ZERO, DVec3::ONE);
    let mut scene = build.0;
    let floor = scene.nodes.iter().position(|node| node.mesh == Some(0)).unwrap();
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let mut seen = Vec::new();
    for (eye, target) in
        [([0.0, 2.0, 8.0], [0.0, 0.0, -4.0]), ([1.0, 3.0, 4.0], [0.0, 0.0, 1.0]), ([0.0, 0.5, 9.0], [0.0, 0.0, 2.0])]
    {
        let (eye, target) = (DVec3::from(eye), DVec3::from(target));
        let cosine = (eye - target).normalize().y;
        let schlick = STRAIGHT + (1.0 - STRAIGHT) * (1.0 - cosine).powi(5);
        let mut middle = |reflectivity: f64, fresnel| {
            let look = Reflective { reflectivity: reflectivity as f32, ..Reflective::default() };
            scene.mirrors = vec![Mirror::of(&scene, floor, 0, look).unwrap()];
            let mut settings = seen_from(eye, target, [81, 61]);
            settings.mirrors.fresnel = fresnel;
            stage.shoot(&settings, &scene).image.get_pixel(40, 30).0[0]
        };
        let (found, expected) = (middle(STRAIGHT, true), middle(schlick, false));
        assert!(found.abs_diff(expected) <= 1, "{found} instead of {expected} at {target}");
        assert!(found > middle(STRAIGHT, false), "it reflects more than straight in");
        seen.push(found);
    }
    assert!(seen[0] > seen[1] && seen[2] > seen[0], "the more, the more obliquely: {seen:?}");
}

fn draw_of<'a>(plan: &'a mut FramePlan, label: &str) -> &'a mut Draw {
    let found = plan.steps.iter_mut().find(|step| step.label.contains(label));
    match &mut found.unwrap_or_else(|| panic!("no step {label}")).action {
        Action::Draw(draw) => draw,
        Action::Clear(_) | Action::Keep => panic!("{label} draws nothing"),
    }
}

#[test]
fn validation_finds_faults_between_views() {
    let good = plan(&room("barbershop"), &settings(2));
    assert_eq!(validate(&good), Ok(()));
    let fault = |change: &dyn Fn(&mut FramePlan)| {
        let mut plan = good.clone();
        change(&mut plan);
        validate(&plan).unwrap_err().what
    };
    let without = |label: &'static str| {
        move |plan: &mut FramePlan| {
            let at = plan.steps.iter().position(|step| step.label.contains(label)).unwrap();
            plan.steps.remove(at);
        }
    };
    assert!(fault(&without("tag eye >")).contains("not tagged"));
    assert!(fault(&without("untag eye >")).contains("not"));
    let in_view = |plan: &FramePlan| plan.steps.iter().position(|step| step.view == 1 && step.label.contains("ambient")).unwrap();
    let beyond = fault(&|plan| {
        let at = in_view(plan);
        if let Action::Draw(draw) = &mut plan.steps[at].action {
            draw.state.stencil = StencilState::IGNORE;
            draw.stencil_reference = 0;
        }
    });
    assert!(beyond.contains("beyond its mirror"), "{beyond}");
    assert!(fault(&|plan| draw_of(plan, "tag eye >").stencil_reference ^= 0x80).contains("bits"));
    assert!(fault(&|plan| draw_of(plan, "untag eye >").state.depth.write = false).contains("depth"));
    assert!(fault(&|plan| plan.views[1].winding = Winding::Ccw).contains("winding"));
    let unreset = |plan: &mut FramePlan| plan.steps.retain(|step| step.view != 1 || !step.label.contains("reset"));
    assert!(fault(&unreset).contains("another view left"));
}
