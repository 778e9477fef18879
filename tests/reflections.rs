//! Rays through mirrors: by hand, and against a tracer that is as plain as can be.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use std::collections::BTreeMap;

use common::{Build, cube, mesh};
use fastrand::Rng;
use glam::{DQuat, DVec2, DVec3};
use obscura::frame::Camera;
use obscura::scene::mirror::Mirror;
use obscura::scene::{Pose, Reflective, Scene, Transform, pose};
use obscura::truth::{Verdict, World};

/// A scene in the making, and which of its nodes are mirrors.
struct Room {
    build: Build,
    mirrors: Vec<usize>,
}

/// What the middle of a picture shows: mirrors on the way, instance, and one light's verdict.
type Middle = (Option<(Vec<usize>, Option<usize>)>, Verdict);

impl Room {
    fn new() -> Self {
        Self { build: Build::new(), mirrors: Vec::new() }
    }

    /// Four corners, counter-clockwise from the front; material 1 is drawn from both sides. Gives the instance.
    fn quad(&mut self, corners: [[f32; 3]; 4], material: usize) -> usize {
        let quad = self.build.mesh(mesh("quad", &corners, &[[0, 1, 2], [0, 2, 3]], material));
        self.build.place(quad, DVec3::ZERO, DVec3::ONE);
        self.build.0.instances().count() - 1
    }

    fn mirror(&mut self, corners: [[f32; 3]; 4], material: usize) -> usize {
        let instance = self.quad(corners, material);
        self.mirrors.push(self.build.0.nodes.len() - 1);
        instance
    }

    fn scene(&self) -> &Scene {
        &self.build.0
    }

    fn pose(&self) -> Pose {
        pose::pose(self.scene(), 0.0, self.scene().default_animation, &BTreeMap::new())
    }

    fn world(&self) -> World {
        let scene = self.scene();
        let mirrors: Vec<_> =
            self.mirrors.iter().map(|node| Mirror::of(scene, *node, 0, Reflective::default()).unwrap()).collect();
        World::with_mirrors(scene, &self.pose(), &mirrors)
    }

    /// Seen from `eye` in the direction `along`, through narrow pixels.
    fn middle(&self, bounces: u32, eye: [f64; 3], along: [f64; 3]) -> Middle {
        self.middle_by(bounces, (eye, along, 0.01), 0)
    }

    /// The same through a picture of any angle, for any light.
    fn middle_by(&self, bounces: u32, (eye, along, fov): ([f64; 3], [f64; 3], f64), light: usize) -> Middle {
        const SIDE: u32 = 5;
        let eye = DVec3::from(eye);
        let camera = Camera::look_at(eye, eye + DVec3::from(along), fov, 1.0, 0.1).unwrap();
        let lights = self.pose().lights;
        let traced = self.world().trace(&camera, &lights[light..=light], [SIDE; 2], bounces, &|_| true).unwrap();
        let at = (SIDE * SIDE / 2) as usize;
        let shown = traced.surfaces.pixels()[at].map(|shown| (traced.surfaces.paths()[shown.path].clone(), shown.instance));
        (shown, traced.verdicts[0].pixels()[at])
    }
}

/// A wall of a barbershop at z = -3, seen between two mirrors that face each other at x = -2 (number 0) and
/// x = 2 (number 1); a square before the wall, and its shadow on the wall up to 0.26 from the middle.
fn barbershop() -> Room {
    let mut room = Room::new();
    let [left, right, wall, _] = [
        room.mirror([[-2.0, -1.0, 3.0], [-2.0, -1.0, -3.0], [-2.0, 1.0, -3.0], [-2.0, 1.0, 3.0]], 0),
        room.mirror([[2.0, -1.0, -3.0], [2.0, -1.0, 3.0], [2.0, 1.0, 3.0], [2.0, 1.0, -3.0]], 0),
        room.quad([[-2.0, -1.0, -3.0], [2.0, -1.0, -3.0], [2.0, 1.0, -3.0], [-2.0, 1.0, -3.0]], 0),
        room.quad([[-0.25, -0.25, -2.9], [0.25, -0.25, -2.9], [0.25, 0.25, -2.9], [-0.25, 0.25, -2.9]], 1),
    ];
    assert_eq!([left, right, wall], [0, 1, 2]);
    room.build.point_light(DVec3::new(0.0, 0.5, 0.0));
    room
}

/// From the middle of the room to the right: it is 2 to the first mirror and 4 to every other, so a ray that
/// falls 3 behind after t along has been reflected (t - 2) / 4 + 1 times.
#[test]
fn between_facing_mirrors_the_way_is_counted_by_hand() {
    let room = barbershop();
    let [left, right, wall, square] = [0, 1, 2, 3];
    let eye = [0.0; 3];
    let look = |bounces, slope: f64| room.middle(bounces, eye, [1.0, 0.0, -slope]);
    // t = 3: the wall at x = 1.
    assert_eq!(look(8, 1.0), (Some((vec![right], Some(wall))), Verdict::Lit));
    // t = 7.5: at 4 - 7.5 = -3.5 after the right mirror, at -4 + 3.5 = -0.5 after the left one.
    assert_eq!(look(8, 0.4), (Some((vec![right, left], Some(wall))), Verdict::Lit));
    // t = 11.9: beside the wall's middle, in the square's shadow.
    let to_shadow = 3.0 / 11.9;
    assert_eq!(look(8, to_shadow), (Some((vec![right, left, right], Some(wall))), Verdict::Shadow));
    assert_eq!(look(3, to_shadow), look(8, to_shadow), "three are enough");
    // t = 11.6, at z = -2.9: there the square lies, at 4 - 11.6, -4 + 7.6, 4 - 3.6.
    let (to_square, behind) = (2.9 / 11.9, 2.9 / 11.5);
    assert_eq!(look(8, to_square).0, Some((vec![right, left, right], Some(square))));
    assert_eq!(look(8, behind).0, Some((vec![right, left, right], Some(wall))));
    // With fewer reflections the ray ends on the glass.
    assert_eq!(look(2, to_shadow), (Some((vec![right, left], Some(right))), Verdict::Lit));
    assert_eq!(look(1, 0.25), (Some((vec![right], Some(left))), Verdict::Lit));
    assert_eq!(look(0, 0.25), (Some((vec![], Some(right))), Verdict::Lit));
    // Eight are the most.
    assert_eq!(look(99, 0.001).0, Some(([right, left].repeat(4), Some(right))));
    // The other way round.
    assert_eq!(room.middle(8, eye, [-1.0, 0.0, -0.4]).0, Some((vec![left, right], Some(wall))));
    // Straight at the square; and past the mirrors' ends, to nothing, once reflected.
    assert_eq!(room.middle(8, eye, [0.02, 0.0, -1.0]), (Some((vec![], Some(square))), Verdict::Lit));
    assert_eq!(room.middle(8, eye, [1.0, 0.0, 1.0]), (Some((vec![right], None)), Verdict::Nothing));
}

#[test]
fn a_periscope_looks_over_a_wall_and_tells_light_from_shadow_there() {
    let mut room = Room::new();
    // Turned by 45 degrees about x: the lower one looks up and back, the upper one down and away.
    let lower = room.mirror([[-1.0, -1.0, -1.0], [1.0, -1.0, -1.0], [1.0, 1.0, -3.0], [-1.0, 1.0, -3.0]], 0);
    let upper = room.mirror([[-1.0, 4.0, -3.0], [1.0, 4.0, -3.0], [1.0, 2.0, -1.0], [-1.0, 2.0, -1.0]], 0);
    let near = room.quad([[-9.0, -9.0, -4.0], [9.0, -9.0, -4.0], [9.0, 1.5, -4.0], [-9.0, 1.5, -4.0]], 0);
    let far = room.quad([[-9.0, -9.0, -6.0], [9.0, -9.0, -6.0], [9.0, 9.0, -6.0], [-9.0, 9.0, -6.0]], 0);
    let before = room.build.point_light(DVec3::new(0.5, 3.5, -4.0));
    let behind = room.build.point_light(DVec3::new(0.0, 3.0, -8.0));
    let below = room.build.point_light(DVec3::new(0.2, 0.0, -2.9));
    let ahead = ([0.0; 3], [0.0, 0.0, -1.0], 0.01);
    let seen = Some((vec![0, 1], Some(far)));
    assert_eq!(room.middle_by(2, ahead, before), (seen.clone(), Verdict::Lit));
    assert_eq!(room.middle_by(2, ahead, behind), (seen.clone(), Verdict::Shadow), "the wall's own");
    // The near wall's rim, 1.5 over that lamp and 1.1 before it, throws its shadow 3.1 before it, up to 4.2.
    assert_eq!(room.middle_by(2, ahead, below), (seen, Verdict::Shadow), "the near wall's");
    assert_eq!(room.middle_by(1, ahead, before).0, Some((vec![0], Some(upper))));
    assert_eq!(room.middle_by(0, ahead, before).0, Some((vec![], Some(lower))));
    assert_eq!(room.middle(2, [1.5, 0.0, 0.0], [0.0, 0.0, -1.0]).0, Some((vec![], Some(near))), "past the periscope");
}

#[test]
fn a_mirror_is_none_from_behind_unless_it_reflects_on_both_sides() {
    for both_sides in [false, true] {
        let mut room = Room::new();
        room.mirror([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]], usize::from(both_sides));
        let front = room.quad([[-9.0, -9.0, 5.0], [9.0, -9.0, 5.0], [9.0, 9.0, 5.0], [-9.0, 9.0, 5.0]], 1);
        let back = room.quad([[-9.0, -9.0, -5.0], [9.0, -9.0, -5.0], [9.0, 9.0, -5.0], [-9.0, 9.0, -5.0]], 1);
        room.build.point_light(DVec3::new(0.0, 3.0, 2.0));
        let ahead = room.middle(4, [0.0, 0.0, 3.0], [0.1, 0.0, -1.0]).0;
        assert_eq!(ahead, Some((vec![0], Some(front))));
        let behind = room.middle(4, [0.0, 0.0, -3.0], [0.1, 0.0, 1.0]).0;
        let expected = if both_sides { (vec![0], Some(back)) } else { (vec![], Some(front)) };
        assert_eq!(behind, Some(expected), "it is seen through: its back is not drawn");
    }
}

/// A floor that reflects, and a sheet over it so low, in metres, that looks down: the eye above does not see it,
/// the reflected one might.
fn backed(over: f32) -> Middle {
    let mut room = Room::new();
    room.mirror([[-4.0, 0.0, 4.0], [4.0, 0.0, 4.0], [4.0, 0.0, -4.0], [-4.0, 0.0, -4.0]], 0);
    room.quad([[-1.0, over, -1.0], [1.0, over, -1.0], [1.0, over, 1.0], [-1.0, over, 1.0]], 0);
    room.quad([[-4.0, 2.0, -4.0], [4.0, 2.0, -4.0], [4.0, 2.0, 4.0], [-4.0, 2.0, 4.0]], 0);
    room.build.point_light(DVec3::new(3.0, 1.0, 3.0));
    room.middle(1, [0.0, 1.0, 0.0], [0.3, -1.0, 0.1])
}

#[test]
fn what_lies_on_the_plane_is_not_seen_in_the_mirror() {
    let (ceiling, sheet) = (Some((vec![0], Some(2))), Some((vec![0], Some(1))));
    // The scene's radius is the root of 33, its hundred thousandth 5.7e-5 m.
    assert_eq!(backed(0.0).0, ceiling);
    assert_eq!(backed(4e-5).0, ceiling);
    assert_eq!(backed(1e-4), (None, Verdict::Edge), "rounding may decide");
    assert_eq!(backed(1e-3).0, sheet);
    assert_eq!(backed(-0.1).0, ceiling, "under the floor");
}

#[test]
fn with_the_eye_on_the_glass_the_near_plane_decides() {
    let mut room = Room::new();
    room.mirror([[-4.0, 0.0, 4.0], [4.0, 0.0, 4.0], [4.0, 0.0, -4.0], [-4.0, 0.0, -4.0]], 0);
    let ceiling = room.quad([[-4.0, 2.0, -4.0], [4.0, 2.0, -4.0], [4.0, 2.0, 4.0], [-4.0, 2.0, 4.0]], 1);
    let cellar = room.quad([[-4.0, -2.0, 4.0], [4.0, -2.0, 4.0], [4.0, -2.0, -4.0], [-4.0, -2.0, -4.0]], 0);
    room.build.point_light(DVec3::new(3.0, 1.0, 3.0));
    // The near plane is 0.1 away.
    let down = |y: f64| room.middle(4, [0.0, y, 0.0], [0.01, -1.0, 0.0]).0;
    assert_eq!(down(0.101), Some((vec![0], Some(ceiling))));
    for y in [0.099, 1e-3, 1e-9, 0.0] {
        assert_eq!(down(y), Some((vec![], Some(cellar))), "{y}: the glass is cut away");
    }
    assert_eq!(room.middle(4, [-3.0, -1.0, 0.0], [1.0, 1.0, 0.0]).0, Some((vec![], Some(ceiling))), "from below it is not there");
    // Along the glass, from so low that single precision may put the eye under it, and from ten times higher.
    let along = |y: f64| room.middle_by(4, ([0.0, y, 0.0], [1.0, -y / 0.2, 0.0], 1e-5), 0);
    assert_eq!(along(4e-6), (None, Verdict::Edge));
    assert_eq!(along(4e-5), (Some((vec![0], None)), Verdict::Nothing));
}

/// A room of six walls, with boxes and mirrors at random; mirrors may cut through both and through each other.
fn random_room(random: &mut Rng) -> Room {
    let mut room = Room::new();
    let place = |random: &mut Rng| DVec3::new(random.f64() * 8.0 - 4.0, random.f64() * 6.0 - 3.0, random.f64() * 8.0 - 4.0);
    let solid = cube(0);
    let corners: Vec<_> = solid.positions.iter().map(|corner| corner.to_array()).collect();
    let inward: Vec<_> = solid.indices.as_chunks::<3>().0.iter().map(|&[a, b, c]| [a, c, b]).collect();
    let walls = room.build.mesh(mesh("walls", &corners, &inward, 0));
    room.build.place(walls, DVec3::ZERO, DVec3::new(5.0, 4.0, 5.0));
    let boxes = room.build.mesh(solid);
    for _ in 0..8 {
        let scale = DVec3::new(random.f64(), random.f64(), random.f64()) * 0.8 + 0.1;
        let (translation, rotation) = (place(random), DQuat::from_scaled_axis(place(random)));
        let node = room.build.place(boxes, translation, scale);
        room.build.0.nodes[node].local = Transform::Trs { translation, rotation, scale };
    }
    for number in 0..9 {
        let (center, rotation) = (place(random), DQuat::from_scaled_axis(place(random)));
        let half = DVec2::new(1.5 + 2.0 * random.f64(), 1.0 + 2.0 * random.f64());
        let corner = |x: f64, y: f64| (center + rotation * DVec3::new(x * half.x, y * half.y, 0.0)).as_vec3().to_array();
        room.mirror([corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)], usize::from(number % 3 == 0));
    }
    room.build.point_light(place(random));
    room
}

/// A triangle of a room, as the plain tracer has it.
struct Plain {
    corners: [DVec3; 3],
    instance: usize,
    mirror: Option<usize>,
    both_sides: bool,
}

fn plain(room: &Room) -> Vec<Plain> {
    let (scene, pose) = (room.scene(), room.pose());
    let mut triangles = Vec::new();
    for (instance, (node, _, mesh)) in scene.instances().enumerate() {
        let mirror = room.mirrors.iter().position(|mirror| *mirror == node);
        let both_sides = scene.materials[mesh.primitives[0].material].double_sided;
        for vertices in mesh.indices.as_chunks::<3>().0 {
            let corners =
                vertices.map(|vertex| pose.world_from_object[node].transform_point3(mesh.positions[vertex as usize].as_dvec3()));
            triangles.push(Plain { corners, instance, mirror, both_sides });
        }
    }
    triangles
}

/// Follows a ray as a child would draw it: to the nearest triangle of all, and from a mirror on in a new
/// direction.
fn follow(room: &[Plain], at: DVec3, along: DVec3, from: f64, bounces: usize, path: &mut Vec<usize>) -> Option<usize> {
    let last = path.last().copied();
    let (mut nearest, mut met) = (f64::INFINITY, None);
    for triangle in room.iter().filter(|triangle| triangle.mirror.is_none() || triangle.mirror != last) {
        let [a, b, c] = triangle.corners;
        let normal = (b - a).cross(c - a).normalize();
        let depth = normal.dot(a - at) / normal.dot(along);
        let point = at + along * depth;
        let inside = [(a, b), (b, c), (c, a)].iter().all(|(p, q)| (*q - *p).cross(point - *p).dot(normal) >= 0.0);
        if inside && depth > from && depth < nearest && (normal.dot(along) < 0.0 || triangle.both_sides) {
            (nearest, met) = (depth, Some((triangle, normal)));
        }
    }
    let (triangle, normal) = met?;
    match triangle.mirror.filter(|_| path.len() < bounces) {
        Some(mirror) => {
            path.push(mirror);
            follow(room, at + along * nearest, along - normal * (2.0 * normal.dot(along)), 0.0, bounces, path)
        }
        None => Some(triangle.instance),
    }
}

#[test]
fn a_plain_tracer_takes_the_same_ways_in_random_rooms() {
    const SIZE: [u32; 2] = [48, 32];
    let mut random = Rng::with_seed(7);
    let mut bounces = [0usize; 6];
    let mut edges = 0;
    for _ in 0..40 {
        let room = random_room(&mut random);
        let eye = DVec3::new(random.f64() * 8.0 - 4.0, random.f64() * 6.0 - 3.0, random.f64() * 8.0 - 4.0);
        let camera = Camera::look_at(eye, DVec3::new(random.f64(), random.f64(), 0.0), 1.4, 1.5, 0.1).unwrap();
        let most = random.usize(2..=5);
        let traced = room.world().trace(&camera, &room.pose().lights, SIZE, most as u32, &|_| true).unwrap();
        let triangles = plain(&room);
        let (right, half_height) = (camera.forward.cross(camera.up), (camera.vertical_fov / 2.0).tan());
        for (number, shown) in (0u32..).zip(traced.surfaces.pixels()) {
            let place = DVec2::new(f64::from(number % SIZE[0]) + 0.5, f64::from(number / SIZE[0]) + 0.5);
            let on_screen =
                (place * 2.0 / DVec2::new(SIZE[0].into(), SIZE[1].into()) - 1.0) * DVec2::new(1.5, -1.0) * half_height;
            let along = camera.forward + right * on_screen.x + camera.up * on_screen.y;
            let mut path = Vec::new();
            let instance = follow(&triangles, eye, along, 0.1, most, &mut path);
            match shown {
                Some(shown) => {
                    assert_eq!((&traced.surfaces.paths()[shown.path], shown.instance), (&path, instance), "{place}");
                    bounces[path.len()] += 1;
                }
                None => edges += 1,
            }
        }
    }
    println!("{bounces:?} pixels by reflections, {edges} edges");
    assert!(
        bounces[..4].iter().all(|count| *count > 100) && edges * 4 < bounces.iter().sum::<usize>(),
        "{bounces:?}, {edges} edges"
    );
}
