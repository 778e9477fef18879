//! Decals in pixels: every one shows the topmost layer on its ground, takes each light once and is blended once; and
//! without the stencil depth makes a mess of it.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::{Build, Stage, assert_exact, cube, mesh, seen_from};
use glam::{DVec3, Vec3, Vec4};
use obscura::director::stage;
use obscura::frame::validate::validate;
use obscura::frame::{Action, Camera, Capabilities, FramePlan};
use obscura::scene::{AlphaMode, Material, Scene, stock};
use obscura::settings::{DecalMode, Settings, Technique};

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

#[test]
fn in_mirrors_decals_are_offset_and_that_is_said() {
    let mut gallery = stock::build("gallery").unwrap().unwrap();
    let node = gallery.nodes.iter().position(|node| node.mesh.is_some() && node.casts_shadow).unwrap();
    let mesh = gallery.nodes[node].mesh.unwrap();
    let material = gallery.meshes[mesh].primitives[0].material;
    gallery.materials[material].decal = true;
    let plan = plan(&gallery, &Settings::default());
    assert!(plan.notes.iter().any(|note| note.contains("decals by polygon offset")), "{:?}", plan.notes);
}
