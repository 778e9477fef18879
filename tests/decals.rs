//! Decals in pixels: every one shows the topmost layer on its ground, takes each light once and is blended once; and
//! without the stencil depth makes a mess of it.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::{Build, Stage, assert_exact, cube, mesh, seen_from};
use glam::{DVec3, Vec3, Vec4};
use obscura::director::stage;
use obscura::frame::state::DepthBias;
use obscura::frame::validate::validate;
use obscura::frame::{Action, Camera, Capabilities, FramePlan};
use obscura::scene::{AlphaMode, Material, Mirror, Reflective, Scene};
use obscura::settings::{DecalMode, LightEdit, MirrorMode, PlanarMode, Settings, SurfacePlace, Technique};

const SIZE: [u32; 2] = [200, 112];

/// A rectangle in the plane y = 0, looking up: from, to.
fn flat(material: usize, list: &[[[f32; 2]; 2]]) -> obscura::scene::Mesh {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for [[x0, z0], [x1, z1]] in list {
        let first = positions.len() as u32;
        positions.extend([[*x0, 0.0, *z1], [*x1, 0.0, *z1], [*x1, 0.0, *z0], [*x0, 0.0, *z0]]);
        triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    mesh("flat", &positions, &triangles, material)
}

/// Layers on a ground, each a material of its own: emitted colour, and where they lie.
struct Layer {
    emissive: [f32; 3],
    alpha: f32,
    at: Vec<[[f32; 2]; 2]>,
}

/// The ground reaches 20 m about the origin; `half` darkens it and all layers alike where they are to be lit.
fn scene(layers: &[Layer], lit: bool) -> Scene {
    let mut build = Build::new();
    let base = if lit { 0.6 } else { 0.0 };
    let material = |emissive: [f32; 3], alpha: f32| Material {
        base_color: Vec4::new(base, base, base, alpha),
        emissive: if lit { Vec3::ZERO } else { emissive.into() },
        alpha: if alpha < 1.0 { AlphaMode::Blend } else { AlphaMode::Opaque },
        ..Material::default()
    };
    build.0.materials.push(material([0.2, 0.2, 0.2], 1.0));
    let ground = build.mesh(flat(2, &[[[-20.0, -20.0], [20.0, 20.0]]]));
    let node = build.place(ground, DVec3::ZERO, DVec3::ONE);
    build.0.nodes[node].casts_shadow = false;
    for layer in layers {
        let number = build.0.materials.len();
        build.0.materials.push(Material { decal: true, ..material(layer.emissive, layer.alpha) });
        let decal = build.mesh(flat(number, &layer.at));
        let node = build.place(decal, DVec3::ZERO, DVec3::ONE);
        build.0.nodes[node].casts_shadow = false;
    }
    build.0.materials.push(Material {
        base_color: Vec4::new(0.0, 0.0, 0.0, 1.0),
        emissive: Vec3::new(0.0, 0.0, 0.9),
        ..Material::default()
    });
    let block = build.mesh(cube(build.0.materials.len() - 1));
    build.place(block, DVec3::new(1.0, 1.0, 4.0), DVec3::splat(0.8));
    build.point_light(DVec3::new(2.0, 9.0, 5.0));
    build.0
}

fn settings(decals: DecalMode) -> Settings {
    Settings { decals, ..seen_from(DVec3::new(-3.0, 1.6, 13.0), DVec3::new(0.4, 0.4, 0.0), SIZE) }
}

fn two_layers() -> Vec<Layer> {
    vec![
        Layer { emissive: [0.8, 0.0, 0.0], alpha: 1.0, at: vec![[[-5.3, -9.1], [4.7, 7.2]]] },
        Layer { emissive: [0.0, 0.8, 0.0], alpha: 1.0, at: vec![[[-2.1, -6.4], [2.3, 5.1]], [[-0.4, -3.0], [3.9, 6.3]]] },
    ]
}

/// Where a pixel's ray meets the plane y = 0; none beyond the horizon.
fn on_ground(camera: &Camera, x: u32, y: u32) -> Option<DVec3> {
    let way = camera.near_rectangle_of([x, y, 1, 1], SIZE).iter().sum::<DVec3>() / 4.0 - camera.eye;
    (way.y < 0.0).then(|| camera.eye + way * (-camera.eye.y / way.y))
}

/// Which layer is topmost at a place, from 1, 0 for the ground; none close to a rim.
fn topmost(layers: &[Layer], at: DVec3) -> Option<usize> {
    let mut found = 0;
    for (number, layer) in (1..).zip(layers) {
        for [[x0, z0], [x1, z1]] in &layer.at {
            let [x0, z0, x1, z1] = [*x0, *z0, *x1, *z1].map(f64::from);
            let inside = (at.x - x0).min(x1 - at.x).min(at.z - z0).min(z1 - at.z);
            if inside.abs() < 0.02 {
                return None;
            }
            if inside > 0.0 {
                found = number;
            }
        }
    }
    Some(found)
}

/// Pixels that show the wrong layer, and those that show the right one, by layer.
fn shown(mode: DecalMode) -> (usize, [usize; 3]) {
    let layers = two_layers();
    let scene = scene(&layers, false);
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let shot = stage.shoot(&settings(mode), &scene);
    let camera = shot.plan.views[0].camera;
    let (mut wrong, mut right) = (0, [0; 3]);
    for (x, y, pixel) in shot.image.enumerate_pixels() {
        let Some(at) = on_ground(&camera, x, y).filter(|at| at.x.abs().max(at.z.abs()) < 19.5) else { continue };
        let Some(expected) = topmost(&layers, at) else { continue };
        let [r, g, b, _] = pixel.0.map(i32::from);
        let found = match () {
            () if b > r + 40 && b > g + 40 => continue, // the block, before everything
            () if r > g + 60 => 1,
            () if g > r + 60 => 2,
            () => 0,
        };
        if found == expected { right[expected] += 1 } else { wrong += 1 }
    }
    (wrong, right)
}

#[test]
fn the_stencil_shows_the_topmost_layer_everywhere() {
    let (wrong, right) = shown(DecalMode::Stencil);
    assert_eq!(wrong, 0);
    assert!(right.iter().all(|&pixels| pixels > 500), "{right:?}");
}

#[test]
fn depth_alone_fights_and_an_offset_mends_it() {
    let (wrong, right) = shown(DecalMode::ZFighting);
    assert!(wrong > 300, "{wrong} wrong, {right:?}");
    assert!(right[1] + right[2] > 100, "by chance: {right:?}");
    assert_eq!(shown(DecalMode::Offset).0, 0);
}

/// A decal of its ground's own colour cannot be told from it: each pixel takes each light once, and keeps its shadow.
#[test]
fn decals_take_each_light_once() {
    let hidden = scene(&[], true);
    let layered = scene(&two_layers(), true);
    for technique in [Technique::ZFail, Technique::Auto, Technique::Wide, Technique::Beam] {
        let picture = |scene: &Scene| {
            let mut stage = Stage::new();
            stage.set_scene(scene);
            stage.shoot(&Settings { technique, ..settings(DecalMode::Stencil) }, scene).image
        };
        let (without, with) = (picture(&hidden), picture(&layered));
        let far = without.pixels().zip(with.pixels()).filter(|(a, b)| (0..3).any(|i| a.0[i].abs_diff(b.0[i]) > 2)).count();
        assert_eq!(far, 0, "{technique:?}");
    }
    assert_exact(&layered, &settings(DecalMode::Stencil));
}

#[test]
fn blended_decals_darken_once() {
    // Two triangles of one decal lie over each other about the middle.
    let at = vec![[[-4.0, -4.0], [1.0, 4.0]], [[-1.0, -4.0], [4.0, 4.0]]];
    let scene = scene(&[Layer { emissive: [0.0; 3], alpha: 0.5, at }], false);
    let values = |mode| {
        let mut stage = Stage::new();
        stage.set_scene(&scene);
        let shot = stage.shoot(&settings(mode), &scene);
        let camera = shot.plan.views[0].camera;
        let mut values: [std::collections::BTreeSet<u8>; 3] = Default::default();
        for (x, y, pixel) in shot.image.enumerate_pixels() {
            let Some(at) = on_ground(&camera, x, y) else { continue };
            let [r, _, b, _] = pixel.0;
            if at.z.abs() > 3.9 || b > r.saturating_add(40) {
                continue;
            }
            match at.x.abs() {
                x if x < 0.95 => _ = values[2].insert(r),
                x if (1.05..3.95).contains(&x) => _ = values[1].insert(r),
                x if (4.05..10.0).contains(&x) => _ = values[0].insert(r),
                _ => {}
            }
        }
        values
    };
    let [ground, once, overlap] = values(DecalMode::Stencil);
    assert_eq!((ground.len(), once.len()), (1, 1), "{ground:?} {once:?}");
    assert_eq!(once, overlap);
    assert!(once.first() < ground.first());
    let [_, once, overlap] = values(DecalMode::Offset);
    assert!(overlap.first() < once.first(), "drawn over each other it darkens twice: {overlap:?} {once:?}");
}

/// A shadow over the markings, not only over the tarmac between them.
#[test]
fn blended_decals_lie_on_opaque_ones_too() {
    let layers = [
        Layer { emissive: [0.8, 0.0, 0.0], alpha: 1.0, at: vec![[[-5.0, -4.0], [0.0, 4.0]]] },
        Layer { emissive: [0.0; 3], alpha: 0.5, at: vec![[[-3.0, -4.0], [3.0, 4.0]]] },
    ];
    let scene = scene(&layers, false);
    let mut stage = Stage::new();
    stage.set_scene(&scene);
    let shot = stage.shoot(&settings(DecalMode::Stencil), &scene);
    let camera = shot.plan.views[0].camera;
    let mut values: [std::collections::BTreeSet<u8>; 4] = Default::default();
    for (x, y, pixel) in shot.image.enumerate_pixels() {
        let Some(at) = on_ground(&camera, x, y).filter(|at| at.z.abs() < 3.9) else { continue };
        let [r, _, b, _] = pixel.0;
        let zones = [-4.9..-3.1, -2.9..-0.1, 0.1..2.9, 5.1..9.0];
        if let Some(zone) = zones.iter().position(|zone| zone.contains(&at.x))
            && b <= r.saturating_add(40)
        {
            values[zone].insert(r);
        }
    }
    assert!(values.iter().all(|values| values.len() == 1), "one value everywhere: {values:?}");
    let [red, dark_red, dark, ground] = values.map(|values| values.first().copied().unwrap());
    assert!(dark_red < red && dark < ground && dark < dark_red, "{red} {dark_red} {dark} {ground}");
}

fn plan(scene: &Scene, settings: &Settings) -> FramePlan {
    stage(settings, scene, &Capabilities::complete()).unwrap().1
}

#[test]
fn validation_knows_marked_ground() {
    let good = plan(&scene(&two_layers(), true), &settings(DecalMode::Stencil));
    assert_eq!(validate(&good), Ok(()));
    let at = |label: &str| good.steps.iter().position(|step| step.label.starts_with(label)).unwrap();
    let spoiled = |change: &dyn Fn(&mut FramePlan)| {
        let mut plan = good.clone();
        change(&mut plan);
        validate(&plan).unwrap_err().what
    };
    assert!(spoiled(&|plan| _ = plan.steps.remove(at("mark the ground"))).contains("not marked"));
    assert!(spoiled(&|plan| _ = plan.steps.remove(at("unmark"))).contains("while the ground"));
    assert!(
        spoiled(&|plan| {
            if let Action::Draw(draw) = &mut plan.steps[at("mark the ground")].action {
                draw.state.depth = obscura::frame::state::Depth::IGNORE;
            }
        })
        .contains("where it is seen")
    );
}

/// A mirror that stands across the ground at z = -10, from x = -8 to 8 and up to y = 6, and a sticker on it.
const MIRROR: [[f64; 2]; 2] = [[-8.0, 0.0], [8.0, 6.0]];
const STICKER: [[f64; 2]; 2] = [[-2.6, 1.2], [0.9, 3.1]];

fn with_mirror(mut scene: Scene, sticker: Option<Vec3>) -> Scene {
    let upright = |[[x0, y0], [x1, y1]]: [[f64; 2]; 2], material| {
        let corners = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map(|[x, y]| [x as f32, y as f32, 0.0]);
        mesh("upright", &corners, &[[0, 1, 2], [0, 2, 3]], material)
    };
    let silver = scene.materials.len();
    let black = Material { base_color: Vec4::new(0.0, 0.0, 0.0, 1.0), ..Material::default() };
    scene.materials.push(black.clone());
    scene.materials.push(Material { decal: true, emissive: sticker.unwrap_or_default(), ..black });
    let mut build = Build(scene);
    let wall = build.mesh(upright(MIRROR, silver));
    let node = build.place(wall, DVec3::new(0.0, 0.0, -10.0), DVec3::ONE);
    build.0.nodes[node].casts_shadow = false;
    if sticker.is_some() {
        let label = build.mesh(upright(STICKER, silver + 1));
        let label = build.place(label, DVec3::new(0.0, 0.0, -10.0), DVec3::ONE);
        build.0.nodes[label].casts_shadow = false;
    }
    build.0.mirrors = vec![Mirror::of(&build.0, node, 0, Reflective::default()).unwrap()];
    build.0
}

/// How far a place is within a rectangle; below 0 beside it.
fn inside([[x0, y0], [x1, y1]]: [[f64; 2]; 2], [x, y]: [f64; 2]) -> f64 {
    (x - x0).min(x1 - x).min(y - y0).min(y1 - y)
}

/// How many pixels show each colour.
type Colors = std::collections::BTreeMap<[u8; 3], usize>;

/// Layer by layer, opaque and blended, on the ground and on a mirror, the eye's own and by way of the mirror: what lies in a
/// place says what is seen there, and nothing else does.
#[test]
fn decals_are_the_same_in_mirrors_and_lie_on_mirrors_too() {
    let shade = vec![[[-7.0, -8.0], [1.0, 4.0]], [[-1.0, -8.0], [7.0, 4.0]]];
    let layers = two_layers();
    let all = layers.into_iter().chain([Layer { emissive: [0.0; 3], alpha: 0.5, at: shade.clone() }]).collect::<Vec<_>>();
    let scene = with_mirror(scene(&all, false), Some(Vec3::new(0.7, 0.7, 0.0)));
    let layers = two_layers();
    for mode in [MirrorMode::Recursive, MirrorMode::Texture] {
        let mut settings = settings(DecalMode::Stencil);
        settings.mirrors.mode = mode;
        // As many pixels in the texture as in the picture.
        settings.mirrors.texture = SIZE[0];
        let mut stage = Stage::new();
        stage.set_scene(&scene);
        let shot = stage.shoot(&settings, &scene);
        let notes = &shot.plan.notes;
        assert!(!notes.iter().any(|note| note.contains("decals")), "{notes:?}");
        let [eye, reflected] = [0, 1].map(|view| shot.plan.views[view].camera);
        // By the topmost opaque layer, and whether it is shaded: what is seen there, by the eye and in the mirror.
        let mut seen: [[[Colors; 2]; 3]; 2] = Default::default();
        let mut sticker = Colors::new();
        for (x, y, pixel) in shot.image.enumerate_pixels() {
            let [r, g, b, _] = pixel.0;
            if b > r.saturating_add(40) && b > g.saturating_add(40) {
                continue; // the block, or its reflection
            }
            let way = eye.near_rectangle_of([x, y, 1, 1], SIZE).iter().sum::<DVec3>() / 4.0 - eye.eye;
            let at = eye.eye + way * ((-10.0 - eye.eye.z) / way.z);
            let (in_mirror, in_sticker) = (inside(MIRROR, [at.x, at.y]), inside(STICKER, [at.x, at.y]));
            if in_mirror.abs() < 0.05 || in_sticker.abs() < 0.05 {
                continue;
            }
            if in_sticker > 0.0 {
                *sticker.entry([r, g, b]).or_insert(0) += 1;
                continue;
            }
            let mirrored = in_mirror > 0.0;
            let Some(at) = on_ground(if mirrored { &reflected } else { &eye }, x, y) else { continue };
            let shaded: Vec<_> = shade.iter().map(|zone| inside(zone.map(|at| at.map(f64::from)), [at.x, at.z])).collect();
            let beyond = at.x.abs().max(at.z.abs()) > 19.5 || shaded.iter().any(|within| within.abs() < 0.05);
            let Some(layer) = topmost(&layers, at).filter(|_| !beyond) else { continue };
            let shaded = shaded.iter().any(|within| *within > 0.0);
            *seen[usize::from(mirrored)][layer][usize::from(shaded)].entry([r, g, b]).or_insert(0) += 1;
        }
        assert_eq!(sticker.len(), 1, "{mode:?}: {sticker:?}");
        assert!(sticker.iter().all(|([r, g, b], pixels)| r == g && *r > b + 60 && *pixels > 80), "{mode:?}: {sticker:?}");
        let mut colors = std::collections::BTreeSet::<[u8; 3]>::new();
        let [own, reflected] = seen;
        for (own, mirrored) in own.iter().flatten().zip(reflected.iter().flatten()) {
            assert!(own.len() == 1 && own.keys().eq(mirrored.keys()), "{mode:?}: {own:?} {mirrored:?}");
            assert!(mirrored.values().all(|pixels| *pixels > 8), "{mode:?}: {mirrored:?}");
            colors.extend(own.keys());
        }
        assert_eq!(colors.len(), 6, "{colors:?}");
    }
}

/// Two lights over a ground of two tiles, of unlike materials, with decals of its own colour that lie across both, and a
/// mirror that shows all that. The second light reaches the right tile and not the decals' middle.
fn tiled(layers: &[Layer]) -> (Scene, [usize; 2]) {
    let mut build = Build(scene(layers, true));
    build.0.meshes.remove(0);
    build.0.meshes.insert(0, flat(2, &[[[0.0, -20.0], [20.0, 20.0]]]));
    let other = build.0.materials.len();
    build.0.materials.push(Material { double_sided: true, ..build.0.materials[2].clone() });
    let left = build.mesh(flat(other, &[[[-20.0, -20.0], [0.0, 20.0]]]));
    let left = build.place(left, DVec3::ZERO, DVec3::ONE);
    build.0.nodes[left].casts_shadow = false;
    let lamp = build.point_light(DVec3::new(9.0, 2.0, 3.0));
    build.0.lights[lamp].range = 3.5;
    build.point_light(DVec3::new(-4.0, 8.0, 7.0));
    (with_mirror(build.0, None), [0, left])
}

/// A decal of its ground's own colour cannot be told from it, whatever shadows fall there, in mirrors and out of them.
#[test]
fn decals_take_the_planar_shadows_of_their_ground() {
    let (bare, decked) = (tiled(&[]), tiled(&two_layers()));
    let nodes = decked.1;
    let mut stage = Stage::new();
    let mut picture = |(scene, [right, left]): &(Scene, [usize; 2]), mode, lights: usize| {
        let mut settings = settings(DecalMode::Stencil);
        settings.planar.mode = mode;
        for node in [right, left] {
            settings.planar.edits.insert(SurfacePlace { node: *node, primitive: 0 }, true);
        }
        for light in lights..3 {
            settings.lights.insert(light, LightEdit { on: Some(false), ..LightEdit::default() });
        }
        stage.set_scene(scene);
        let shot = stage.shoot(&settings, scene);
        assert!(!shot.plan.notes.iter().any(|note| note.contains("decals")), "{:?}", shot.plan.notes);
        shot.image
    };
    let differ = |a: &image::RgbaImage, b: &image::RgbaImage| {
        let far = a.pixels().zip(b.pixels()).filter(|(a, b)| (0..3).any(|i| a.0[i].abs_diff(b.0[i]) > 2));
        far.count()
    };
    assert_eq!(bare.0.nodes[nodes[0]].name, decked.0.nodes[nodes[0]].name);
    for lights in [1, 3] {
        let shadowless = picture(&bare, PlanarMode::Hybrid, 0);
        for mode in PlanarMode::ALL {
            let (without, with) = (picture(&bare, mode, lights), picture(&decked, mode, lights));
            assert!(differ(&without, &shadowless) > 4000, "{mode:?}: it is lit");
            assert_eq!(differ(&without, &with), 0, "{mode:?}, {lights} lights");
        }
        // In colours of their own they cannot be taken for what they lie on, however shadows are drawn.
        let mut colored = decked.clone();
        for (number, material) in colored.0.materials.iter_mut().filter(|material| material.decal).enumerate() {
            material.base_color[number] = 0.05;
        }
        let multi = picture(&colored, PlanarMode::Multi, lights);
        assert!(differ(&multi, &picture(&decked, PlanarMode::Multi, lights)) > 2000);
        for mode in [PlanarMode::StencilRelight, PlanarMode::Hybrid] {
            assert_eq!(differ(&multi, &picture(&colored, mode, lights)), 0, "{mode:?}, {lights} lights");
        }
    }
}

#[test]
fn decals_are_offset_where_only_a_part_of_their_ground_takes_shadows_and_that_is_said() {
    let (scene, [right, left]) = tiled(&two_layers());
    let decal = scene.nodes.iter().position(|node| node.mesh == Some(1)).unwrap();
    let said = |receivers: &[usize], mode| {
        let mut settings = settings(DecalMode::Stencil);
        settings.planar.mode = mode;
        for &node in receivers {
            settings.planar.edits.insert(SurfacePlace { node, primitive: 0 }, true);
        }
        let plan = stage(&settings, &scene, &Capabilities::complete());
        let plan = plan.unwrap_or_else(|fault| panic!("{receivers:?} {mode:?}: {fault}")).1;
        let offset = plan.draws().any(|(_, draw)| draw.state.depth.bias == DepthBias { constant: 16, slope: 1 });
        let note = "decals by polygon offset where of them and their ground only some take planar shadows";
        assert_eq!(plan.notes.iter().any(|said| said == note), offset, "{receivers:?} {mode:?}: {:?}", plan.notes);
        offset
    };
    assert_eq!(scene.materials[scene.meshes[1].primitives[0].material].emissive, Vec3::ZERO);
    for mode in [PlanarMode::StencilBlend, PlanarMode::StencilRelight, PlanarMode::Multi, PlanarMode::Hybrid] {
        assert!(said(&[right], mode) && said(&[decal], mode) && said(&[left, decal], mode), "{mode:?}");
        assert!(!said(&[], mode) && !said(&[right, left], mode) && !said(&[right, left, decal], mode), "{mode:?}");
    }
    assert!(!said(&[right], PlanarMode::Naive) && !said(&[decal], PlanarMode::Off));
}

#[test]
fn validation_knows_who_shares_a_receivers_value() {
    let (scene, [right, left]) = tiled(&two_layers());
    let mut settings = settings(DecalMode::Stencil);
    settings.planar.mode = PlanarMode::Multi;
    for node in [right, left] {
        settings.planar.edits.insert(SurfacePlace { node, primitive: 0 }, true);
    }
    let good = plan(&scene, &settings);
    let spoiled = |change: &dyn Fn(&mut FramePlan)| {
        let mut plan = good.clone();
        change(&mut plan);
        validate(&plan).unwrap_err().what
    };
    let at = |words: &str| good.steps.iter().position(|step| step.label.contains(words)).unwrap();
    let (tag, shadow) = (at(": decal"), at("light 0: shadows onto"));
    let late = |plan: &mut FramePlan| {
        let step = plan.steps.remove(tag);
        plan.steps.insert(shadow, step);
    };
    assert!(spoiled(&late).contains("one value"), "after a shadow has fallen");
    let twice = |plan: &mut FramePlan| plan.steps.insert(tag, plan.steps[tag].clone());
    assert!(spoiled(&twice).contains("one value"));
    let add = shadow + good.steps[shadow..].iter().position(|step| step.label.starts_with("light 0: add")).unwrap();
    let twice = |plan: &mut FramePlan| plan.steps.insert(add, plan.steps[add].clone());
    assert!(spoiled(&twice).contains("where it is not in shadow"));
}
