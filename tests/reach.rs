//! Bodies that have a point in common are never told apart, and rectangles hold all that shows.
#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod common;

use common::strategies::{camera, pixel, vector};
use glam::{DAffine3, DQuat, DVec3, DVec4, Vec3};
use obscura::frame::Camera;
use obscura::geometry::frustum::hull_rect;
use obscura::geometry::{Aabb, Body};
use proptest::prelude::*;

fn light() -> impl Strategy<Value = DVec4> {
    (vector(6.0), any::<bool>()).prop_map(|(light, sun)| if sun { light.normalize().extend(0.0) } else { light.extend(1.0) })
}

/// A box in an object's space, the object's place, and a point of the box in the world.
fn caster() -> impl Strategy<Value = (Aabb, DAffine3, DVec3)> {
    let placed = (vector(5.0), vector(3.0), prop::array::uniform3(0.1..2.0f64));
    (placed, prop::array::uniform3(0.0f32..1.0), prop::array::uniform3(0.0..1.0f64)).prop_map(
        |((place, turn, scale), size, share)| {
            let bounds = Aabb { min: Vec3::ZERO, max: Vec3::from(size) };
            let world_from_object =
                DAffine3::from_scale_rotation_translation(DVec3::from(scale), DQuat::from_scaled_axis(turn), place);
            (bounds, world_from_object, world_from_object.transform_point3(bounds.max.as_dvec3() * DVec3::from(share)))
        },
    )
}

fn corners(bounds: &Aabb, world_from_object: &DAffine3) -> [DVec3; 8] {
    bounds.corners().map(|corner| world_from_object.transform_point3(corner))
}

/// How far along the ray from the light through a point of the caster the volume's place lies: 1 is at it.
fn shadowed(point: DVec3, light: DVec4, along: f64) -> DVec3 {
    point + (point * light.w - light.truncate()) * (along - 1.0)
}

/// A cube about a point that is in the body too.
fn about(point: DVec3, spread: f64) -> Body {
    Body::boxed(
        &Aabb { min: Vec3::splat(-1.0), max: Vec3::ONE },
        &DAffine3::from_scale_rotation_translation(DVec3::splat(spread), DQuat::from_rotation_y(spread), point),
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, max_global_rejects: 200_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_volume_holds_every_place_behind_its_caster((bounds, place, point) in caster(), light in light(), along in 1.0..50.0f64, spread in 0.0..0.3f64) {
        prop_assume!((point * light.w - light.truncate()).length() > 1e-3);
        let volume = Body::volume(&corners(&bounds, &place), light, None);
        prop_assert!(volume.may_meet(&about(shadowed(point, light, along), spread)));
    }

    #[test]
    fn an_ended_volume_holds_every_place_before_its_end((bounds, place, point) in caster(), light in vector(6.0), normal in vector(1.0), distance in 0.0..8.0f64, share in 0.0..1.0f64) {
        let Some(normal) = normal.try_normalize() else { return Ok(()) };
        let corners = corners(&bounds, &place);
        // Behind all of the caster, its rays running towards it.
        let farthest = corners.iter().map(|corner| normal.dot(*corner)).fold(f64::NEG_INFINITY, f64::max);
        let height = farthest + distance;
        prop_assume!(corners.iter().all(|corner| normal.dot(*corner - light) > 0.02 * corner.distance(light)));
        let end = normal.extend(-height);
        let to_plane = (height - normal.dot(light)) / normal.dot(point - light);
        let on_the_way = shadowed(point, light.extend(1.0), 1.0 + (to_plane - 1.0) * share);
        let ended = Body::volume(&corners, light.extend(1.0), Some(end));
        prop_assert!(ended.may_meet(&about(on_the_way, 0.0)));
        let cap = Body::dark_cap(&corners, light, Some(end));
        prop_assert!(cap.may_meet(&about(shadowed(point, light.extend(1.0), to_plane), 0.0)));
    }

    #[test]
    fn a_view_sees_every_volume_that_reaches_into_it(camera in camera(), (bounds, place, point) in caster(), light in light(), along in 1.0..50.0f64) {
        let at = shadowed(point, light, along);
        prop_assume!(pixel(at, &camera.clip_from_world(), [2, 2]).is_some() && (point * light.w - light.truncate()).length() > 1e-3);
        let view = Body::frustum(camera.eye, camera.near_rectangle());
        prop_assert!(view.may_meet(&Body::volume(&corners(&bounds, &place), light, None)));
        // And of what goes on for ever in it, the cap in the sky.
        let far = (point - light.truncate()).normalize_or_zero();
        let seen = camera.clip_from_world() * far.extend(0.0);
        if light.w == 1.0 && seen.w > 0.0 && seen.x.abs() <= seen.w && seen.y.abs() <= seen.w {
            prop_assert!(view.directions_of().may_meet(&Body::dark_cap(&corners(&bounds, &place), light.truncate(), None)));
        }
    }

    #[test]
    fn a_caster_that_shades_the_near_rectangle_meets_the_occlusion_pyramid(camera in camera(), light in light(), shares in prop::array::uniform2(0.0..1.0f64), along in 0.0..1.0f64, spread in 0.0..0.5f64) {
        let [a, b, _, d] = camera.near_rectangle();
        let on_rectangle = a + (b - a) * shares[0] + (d - a) * shares[1];
        // On the way from there to the light; a directional one is as far as one likes.
        let way = light.truncate() - on_rectangle * light.w;
        let between = on_rectangle + way * if light.w == 0.0 { along * 20.0 } else { along };
        let pyramid = Body::pyramid(light, camera.near_rectangle());
        prop_assert!(pyramid.may_meet(&about(between, spread)));
        let from_eye = camera.eye + (on_rectangle - camera.eye) * shares[0];
        let way = light.truncate() - from_eye * light.w;
        let between = from_eye + way * if light.w == 0.0 { along * 20.0 } else { along };
        let occlusion = Body::occlusion(light, camera.near_rectangle(), camera.eye);
        prop_assert!(occlusion.may_meet(&about(between, spread)) && occlusion.may_meet(&about(on_rectangle, spread)));
    }

    #[test]
    fn a_cone_holds_every_place_it_lights(apex in vector(5.0), axis in vector(1.0), outer in 0.05..1.25f64, angle in 0.0..1.0f64, turn in 0.0..6.3f64, distance in 0.01..30.0f64) {
        let Some(axis) = axis.try_normalize() else { return Ok(()) };
        let (right, up) = axis.any_orthonormal_pair();
        let (sin, cos) = (outer * angle).sin_cos();
        let at = apex + (axis * cos + (right * turn.cos() + up * turn.sin()) * sin) * distance;
        prop_assert!(Body::cone(apex, axis, outer).unwrap().may_meet(&about(at, 0.0)));
        prop_assert!(Body::cone_within(apex, axis, outer, 30.0).unwrap().may_meet(&about(at, 0.0)));
    }

    #[test]
    fn a_hulls_rectangle_holds_every_place_that_shows(camera in camera(), (bounds, place, point) in caster(), light in light(), along in 1.0..50.0f64) {
        let size = [300, 200];
        let at = shadowed(point, light, along);
        let Some(shown) = pixel(at, &camera.clip_from_world(), size) else { return Ok(()) };
        prop_assume!((point * light.w - light.truncate()).length() > 1e-3);
        let volume = Body::volume(&corners(&bounds, &place), light, None);
        let rect = hull_rect(volume.hull(), &camera.clip_from_world(), size);
        let [x, y, width, height] = rect.ok_or_else(|| TestCaseError::fail("none, but a point shows"))?;
        let within = |at: f64, low: u32, extent: u32| f64::from(low) <= at && at <= f64::from(low + extent);
        prop_assert!(within(shown[0], x, width) && within(shown[1], y, height), "{shown:?} outside {rect:?}");
    }
}

#[test]
fn the_rectangle_of_a_box_is_tight() {
    let camera = Camera::look_at(DVec3::Z * 10.0, DVec3::ZERO, std::f64::consts::FRAC_PI_2, 1.0, 0.1).unwrap();
    let cube = Body::boxed(&Aabb { min: Vec3::splat(-1.0), max: Vec3::ONE }, &DAffine3::IDENTITY);
    // Its near face fills 1 / 9 to each side of 180 pixels' middle.
    assert_eq!(hull_rect(cube.hull(), &camera.clip_from_world(), [180, 180]), Some([79, 79, 22, 22]));
}
