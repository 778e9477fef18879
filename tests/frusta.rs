//! The near pyramid and the lights' rectangles never leave out what is there.
#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod common;

use common::mesh;
use common::strategies::{camera, pixel, vector};
use glam::{DAffine3, DQuat, DVec3, Vec3};
use obscura::frame::Camera;
use obscura::geometry::Aabb;
use obscura::geometry::frustum::{NearPyramid, screen_rect};
use proptest::prelude::*;

fn near_corners(camera: &Camera) -> [DVec3; 4] {
    let up = camera.up * (camera.vertical_fov / 2.0).tan() * camera.near;
    let right = camera.forward.cross(camera.up) * (camera.vertical_fov / 2.0).tan() * camera.near * camera.aspect;
    let center = camera.eye + camera.forward * camera.near;
    [center - right - up, center + right - up, center + right + up, center - right + up]
}

fn placed() -> impl Strategy<Value = DAffine3> {
    (vector(5.0), vector(3.0), vector(2.0))
        .prop_map(|(place, turn, scale)| DAffine3::from_scale_rotation_translation(scale, DQuat::from_scaled_axis(turn), place))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_point_of_both_is_a_touch(camera in camera(), world_from_object in placed(), shares in prop::array::uniform5(0.0..1.0f64), spread in prop::array::uniform6(0.0f32..0.5)) {
        // A point of the pyramid, and a box about it in an object's space.
        let points = near_corners(&camera).into_iter().chain([camera.eye]);
        let point: DVec3 = points.zip(shares).map(|(point, share)| point * share).sum::<DVec3>() / shares.iter().sum::<f64>().max(1e-9);
        prop_assume!(shares.iter().sum::<f64>() > 1e-6 && world_from_object.matrix3.determinant().abs() > 1e-3);
        let held = world_from_object.inverse().transform_point3(point).as_vec3();
        let bounds = Aabb { min: held - Vec3::from_slice(&spread[..3]), max: held + Vec3::from_slice(&spread[3..]) };
        prop_assert!(NearPyramid::of(camera.eye, near_corners(&camera)).may_touch(&bounds, &world_from_object));
    }

    #[test]
    fn a_triangle_through_a_point_of_it_is_a_touch(camera in camera(), world_from_object in placed(), shares in prop::array::uniform5(0.0..1.0f64), others in prop::array::uniform2(vector(4.0)), weights in prop::array::uniform3(0.05..1.0f64)) {
        prop_assume!(world_from_object.matrix3.determinant().abs() > 1e-3);
        let points = near_corners(&camera).into_iter().chain([camera.eye]);
        let total = shares.iter().sum::<f64>();
        prop_assume!(total > 1e-6);
        let held = points.zip(shares).map(|(point, share)| point * share).sum::<DVec3>() / total;
        let held = world_from_object.inverse().transform_point3(held);
        // The third corner is where the point has these weights in the triangle.
        let [p, q] = others.map(|other| held + other);
        let r = held - ((p - held) * weights[0] + (q - held) * weights[1]) / weights[2];
        let corners = [p, q, r].map(|corner| corner.as_vec3().to_array());
        let triangle = mesh("triangle", &corners, &[[0, 1, 2]], 0);
        let pyramid = NearPyramid::of(camera.eye, near_corners(&camera));
        prop_assert!(pyramid.may_touch_surface(&triangle.topology, &triangle.positions, &world_from_object));
    }

    #[test]
    fn a_rectangle_holds_every_pixel_of_the_sphere(camera in camera(), center in vector(8.0), radius in 0.01..4.0f64, directions in prop::collection::vec(vector(1.0), 60)) {
        let clip_from_world = camera.clip_from_world();
        let size = [300, 200];
        let rect = screen_rect(center, radius, &clip_from_world, size);
        for direction in directions.into_iter().filter_map(|direction| direction.try_normalize()) {
            let Some(pixel) = pixel(center + direction * radius, &clip_from_world, size) else { continue };
            let [x, y, width, height] = rect.ok_or_else(|| TestCaseError::fail("none, but a point shows"))?;
            let within = |at: f64, low: u32, extent: u32| f64::from(low) <= at && at <= f64::from(low + extent);
            prop_assert!(within(pixel[0], x, width) && within(pixel[1], y, height), "{pixel:?} outside {rect:?}");
        }
    }
}

/// At (0, 0, 10), looking along -Z, a right angle high and wide.
fn straight(near: f64) -> Camera {
    Camera::look_at(DVec3::Z * 10.0, DVec3::ZERO, std::f64::consts::FRAC_PI_2, 1.0, near).unwrap()
}

#[test]
fn rectangles_are_tight_where_the_sphere_is_before_the_near_plane() {
    let clip_from_world = straight(0.1).clip_from_world();
    // Seen from 10 m, a sphere of 5 m fills sin = 1/2, tan = 0.577 to each side of 200 pixels' middle.
    assert_eq!(screen_rect(DVec3::ZERO, 5.0, &clip_from_world, [200, 200]), Some([41, 41, 118, 118]));
    assert_eq!(screen_rect(DVec3::new(30.0, 0.0, 0.0), 5.0, &clip_from_world, [200, 200]), None, "beside the view");
    assert_eq!(screen_rect(DVec3::Z * 30.0, 5.0, &clip_from_world, [200, 200]), None, "behind the eye");
    assert_eq!(screen_rect(DVec3::Z * 10.0, 5.0, &clip_from_world, [200, 100]), Some([0, 0, 200, 100]), "about the eye");
    assert_eq!(screen_rect(DVec3::ZERO, f64::INFINITY, &clip_from_world, [20, 10]), Some([0, 0, 20, 10]));
    let [x, _, width, _] = screen_rect(DVec3::new(-5.0, 0.0, 10.0), 4.0, &clip_from_world, [200, 200]).unwrap();
    assert!(x == 0 && width <= 100, "to the left of the eye, and reaching behind it: {x} {width}");
}

#[test]
fn a_near_pyramid_is_no_larger_than_it_is() {
    let camera = straight(1.0);
    let pyramid = NearPyramid::of(camera.eye, near_corners(&camera));
    let cube = Aabb { min: Vec3::splat(-0.5), max: Vec3::splat(0.5) };
    let touches = |place: DVec3| pyramid.may_touch(&cube, &DAffine3::from_translation(place));
    assert!(touches(DVec3::new(0.0, 0.0, 9.5)) && touches(DVec3::new(0.0, 0.0, 10.4)), "the eye within, the near plane within");
    assert!(
        !touches(DVec3::new(0.0, 0.0, 8.4)) && touches(DVec3::new(0.0, 0.0, 8.6)),
        "beyond the near plane by a tenth, across it"
    );
    assert!(!touches(DVec3::new(0.0, 0.0, 10.6)) && !touches(DVec3::new(1.6, 0.0, 9.5)), "behind the eye, beside the rectangle");
    assert!(!touches(DVec3::new(1.3, 0.0, 10.1)), "beside the pyramid's slope");
    assert!(touches(DVec3::new(1.48, 0.0, 9.0)) && !touches(DVec3::new(1.51, 0.0, 9.0)), "beside the rectangle, by a hair");
    assert!(!pyramid.may_touch(&Aabb::EMPTY, &DAffine3::IDENTITY));
    let flat = DAffine3::from_scale_rotation_translation(DVec3::new(9.0, 0.0, 9.0), DQuat::IDENTITY, DVec3::ZERO);
    assert!(pyramid.may_touch(&Aabb { min: Vec3::splat(-5.0), max: Vec3::splat(5.0) }, &flat), "a floor through the eye");
}

#[test]
fn an_eye_in_the_hollow_of_a_solid_touches_nothing_of_it() {
    // A room: a box with a smaller one taken out, as one mesh.
    let corner = |half: f32, corner: u8| [0, 1, 2].map(|axis| if corner >> axis & 1 == 1 { half } else { -half });
    let corners: Vec<[f32; 3]> = [2.0, 1.5].into_iter().flat_map(|half| (0..8).map(move |i| corner(half, i))).collect();
    let quads: [[u32; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let outside = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    let triangles: Vec<[u32; 3]> = outside.clone().chain(outside.map(|[a, b, c]| [a + 8, c + 8, b + 8])).collect();
    let room = mesh("room", &corners, &triangles, 0);
    let bounds = Aabb { min: Vec3::splat(-2.0), max: Vec3::splat(2.0) };
    let looks = |eye: DVec3, target: DVec3| {
        let camera = Camera::look_at(eye, target, 1.0, 1.0, 0.2).unwrap();
        let pyramid = NearPyramid::of(camera.eye, camera.near_rectangle());
        assert!(pyramid.may_touch(&bounds, &DAffine3::IDENTITY), "its box knows no better");
        pyramid.may_touch_surface(&room.topology, &room.positions, &DAffine3::IDENTITY)
    };
    assert!(!looks(DVec3::ZERO, DVec3::NEG_Z) && !looks(DVec3::new(1.2, -1.3, 0.9), DVec3::new(1.0, 0.0, 0.0)));
    assert!(!looks(DVec3::new(0.0, 0.0, -1.25), DVec3::new(0.0, 0.0, -5.0)), "a hair before the wall");
    assert!(looks(DVec3::new(0.0, 0.0, -1.35), DVec3::new(0.0, 0.0, -5.0)), "the wall between eye and near plane");
    assert!(!looks(DVec3::new(0.0, 0.0, -1.35), DVec3::ZERO), "the wall behind the eye");
    assert!(looks(DVec3::new(0.0, 1.45, 0.0), DVec3::new(0.0, 1.45, 5.0)), "the ceiling across the near rectangle's edge");
}
