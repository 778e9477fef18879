//! The pixels that planar shadows are known to get wrong, worked out: an outline that lies within half of a 256th of a
//! pixel from the pixel's centre is moved past it, because rasterisers move corners to their grid.
//!
//! Elsewhere such a pixel is an edge, and nobody asks. These two lie beside gaps between shadows so narrow that the
//! five places which decide a pixel are all in shadow. Double precision says so, and so do the very floats that the vertex
//! shader gives; on the grid no triangle covers the centre any more. Nothing before the rasteriser can mend that.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::Stage;
use glam::{DMat4, DVec2, DVec4, Vec2, Vec3, Vec4};
use obscura::director::stage;
use obscura::frame::{Capabilities, Projection};
use obscura::geometry::planar_shadow::{append_over, shadow_matrix};
use obscura::scene::{Scene, stock};
use obscura::settings::{CameraChoice, PlanarMode, Settings, SurfacePlace};

/// How far inside the triangles that cover it a pixel's centre lies at most, pixels; by exact corners, by those of the
/// vertex shader, and by these on the grid. Below 0 nothing covers it. The pixel shows the receiver of that name.
fn inside(scene: &Scene, settings: &Settings, receiver: &str, [x, y]: [u32; 2]) -> [f64; 3] {
    /// Steps of the grid in a pixel.
    const GRID: f64 = 256.0;
    let (pose, plan) = stage(settings, scene, &Capabilities::complete()).unwrap();
    let nodes: Vec<_> = scene.instances().map(|(node, ..)| node).collect();
    let half = DVec2::from(plan.size.map(f64::from)) / 2.0;
    let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
    let mut most = [f64::NEG_INFINITY; 3];
    for volume in plan.volumes.iter().filter(|volume| volume.view == 0 && volume.light == settings.light) {
        let onto_it = |projection: &Projection| scene.nodes[nodes[projection.receiver.instance]].name == receiver;
        let Some(projection) = volume.projection.filter(onto_it) else { continue };
        let (onto, world_from_object) = (projection.onto, pose.world_from_object[nodes[volume.instance]]);
        let light: DVec4 = (&pose.lights[volume.light]).into();
        let matrix = plan.views[0].camera.clip_from_world() * shadow_matrix(onto.plane, light) * DMat4::from(world_from_object);
        let single = matrix.as_mat4();
        let mesh = &scene.meshes[scene.nodes[nodes[volume.instance]].mesh.unwrap()];
        let positions = pose.positions(scene, nodes[volume.instance]);
        let welded: Vec<_> = mesh.topology.weld().vertex_of_welded.iter().map(|vertex| positions[*vertex as usize]).collect();
        let triangles = mesh.topology.triangles().iter().map(|corners| corners.map(|vertex| welded[vertex as usize]));
        // Of a solid the triangles that face the light; the others' shadows lie within theirs.
        let solid = mesh.topology.report().is_solid();
        let faces = |corners: [Vec3; 3]| {
            let [a, b, c] = corners.map(|at| world_from_object.transform_point3(at.as_dvec3()));
            i8::from(!solid || (b - a).cross(c - a).dot(light.truncate() - a * light.w) > 0.0)
        };
        let counts: Vec<_> = triangles.clone().map(faces).collect();
        let mut thrown: Vec<[f32; 4]> = Vec::new();
        if projection.cut {
            let plane = DMat4::from(world_from_object).transpose() * onto.plane;
            append_over((&mesh.topology, &welded), &counts, (plane, &onto), &mut thrown);
        } else {
            let counting = triangles.zip(&counts).filter(|(_, counts)| **counts != 0);
            thrown.extend(counting.flat_map(|(corners, _)| corners.map(|at| at.extend(1.0).to_array())));
        }
        for corners in thrown.as_chunks::<3>().0 {
            let corners = corners.map(|at| Vec4::from(at).truncate());
            let clip = corners.map(|at| matrix * at.as_dvec3().extend(1.0));
            let exact_on_screen = |at: DVec4| half + DVec2::new(at.x, -at.y) / at.w * half;
            // What reaches behind the eye, or beyond the light, is clipped first: none of that has a say here.
            if clip.iter().any(|at| at.z < 0.0 || at.z > at.w) {
                let rest: Vec<_> = clipped(&clip).into_iter().map(exact_on_screen).collect();
                let fan = (2..rest.len()).map(|last| within([rest[0], rest[last - 1], rest[last]], centre));
                fan.for_each(|within| assert!(within.is_nan() || within < -0.01, "{within}"));
                continue;
            }
            let exact = clip.map(exact_on_screen);
            let float = corners.map(|at| on_screen(single * at.extend(1.0), half));
            let grid = float.map(|at| (at * GRID).round() / GRID);
            let found = [exact, float, grid].map(|corners| within(corners, centre));
            most = [0, 1, 2].map(|by| f64::max(most[by], found[by]));
        }
    }
    most
}

/// What is left of a triangle of clip space between the near plane and infinity.
fn clipped(corners: &[DVec4]) -> Vec<DVec4> {
    let sides: [fn(DVec4) -> f64; 2] = [|at| at.z, |at| at.w - at.z];
    let mut polygon = corners.to_vec();
    for side in sides {
        let mut kept = Vec::new();
        for (number, &from) in polygon.iter().enumerate() {
            let to = polygon[(number + 1) % polygon.len()];
            let (before, after) = (side(from), side(to));
            if before >= 0.0 {
                kept.push(from);
            }
            if (before >= 0.0) != (after >= 0.0) {
                kept.push(from.lerp(to, before / (before - after)));
            }
        }
        polygon = kept;
    }
    polygon
}

/// A corner in the picture, by single precision as the device has it.
fn on_screen(clip: Vec4, half: DVec2) -> DVec2 {
    let (inverse, half) = (1.0 / clip.w, half.as_vec2());
    (half + Vec2::new(clip.x, -clip.y) * inverse * half).as_dvec2()
}

/// How far inside a triangle, of either winding, a point is.
fn within([a, b, c]: [DVec2; 3], point: DVec2) -> f64 {
    let sense = (b - a).perp_dot(c - a).signum();
    let edge = |from: DVec2, to: DVec2| sense * (to - from).perp_dot(point - from) / from.distance(to).max(1e-12);
    edge(a, b).min(edge(b, c)).min(edge(c, a))
}

/// Asserts that the pixel alone may be wrong, and that the grid is why.
fn assert_the_grid_decides(scene: &Scene, settings: &Settings, receiver: &str, pixel: [u32; 2]) {
    let [exact, float, grid] = inside(scene, settings, receiver, pixel);
    let half_a_step = 0.5 / 256.0;
    assert!(exact > 0.0 && exact < half_a_step, "the centre is covered, by less than half a step of the grid: {exact}");
    assert!(float > 0.0, "single precision loses nothing: {float}");
    assert!(grid < 0.0, "on the grid nothing covers it: {grid}");
    let mut stage = Stage::new();
    stage.set_scene(scene);
    let found = &stage.verify(settings, scene)[settings.light];
    assert!(found.shadow > 100 && found.pixels.iter().all(|wrong| [wrong.x, wrong.y] == pixel), "{:?}", found.pixels);
}

/// A gap of 0.07 pixels between the shadows of a chair's leather and of its frame.
#[test]
fn a_gap_beside_a_chair() {
    let scene = stock::build("barbershop").unwrap().unwrap();
    let floor = scene.nodes.iter().position(|node| node.name == "floor").unwrap();
    let camera = CameraChoice::Named("hall of mirrors".into());
    let mut settings = Settings { camera, size: [160, 90], light: 1, ..Settings::default() };
    settings.planar.mode = PlanarMode::Multi;
    settings.planar.edits.insert(SurfacePlace { node: floor, primitive: 0 }, true);
    assert_the_grid_decides(&scene, &settings, "floor", [23, 84]);
}

/// A gap in the rosette's shadow, seen along the tile: the one wrong pixel of `verify figure7 --planar multi --random 100`.
#[test]
fn a_gap_in_a_rosettes_shadow() {
    let scene = stock::build("figure7").unwrap().unwrap();
    let camera = CameraChoice::Free {
        eye: [-2.7190698015191614, 0.0752223455046932, -0.5856368412545614].into(),
        target: [-1.7396442794162743, 0.2713787564876098, -0.26339172846183834].into(),
    };
    let mut settings = Settings { camera, size: [320, 180], time: 13.765166194849305, ..Settings::default() };
    settings.planar.mode = PlanarMode::Multi;
    assert_the_grid_decides(&scene, &settings, "tile", [52, 141]);
}
