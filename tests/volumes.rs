//! Shadow volumes of random solids and random soups: closed, and counting what they should.
#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod shapes;

use std::collections::BTreeMap;

use glam::{DVec3, Vec4};
use obscura::geometry::{EyeCount, VolumeParts, VolumeScratch, holding_count};
use proptest::prelude::*;
use shapes::{Shape, cube, light, place, shape, solid, torus};

/// Directed edges that no other edge cancels. Extruded vertices are one for a directional light.
fn unbalanced(boundary: &[[u32; 3]], vertices: u32, light: Vec4) -> usize {
    let mut sums = BTreeMap::new();
    let place = |vertex: u32| if light.w == 0.0 { vertex.min(vertices) } else { vertex };
    for [a, b, c] in boundary {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let (from, to) = (place(*from), place(*to));
            *sums.entry((from.min(to), from.max(to))).or_insert(0) += i32::from(from < to) - i32::from(from > to);
        }
    }
    sums.values().filter(|sum| **sum != 0).count()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_solids_are_solid(shape in solid()) {
        prop_assert!(shape.mesh.topology.report().is_solid(), "{:?}", shape.mesh.topology.report());
    }

    #[test]
    fn who_faces_the_light_counts_and_of_the_soup_everyone(shape in shape(), light in light()) {
        let volume = shape.volume(light, VolumeParts::SIDES);
        let solid = shape.mesh.topology.report().is_solid();
        let some_solid = shape.mesh.topology.report().solid_components > 0;
        for (triangle, counts) in shape.mesh.topology.triangles().iter().zip(volume.scratch.facing().contributions()) {
            let [a, b, c] = triangle.map(|vertex| shape.welded[vertex as usize].as_dvec3());
            let above = (b - a).cross(c - a).normalize_or_zero().dot(light.truncate().as_dvec3() - a * f64::from(light.w));
            if above > 1e-3 {
                prop_assert_eq!(*counts, 1);
            } else if above < -1e-3 {
                prop_assert!(*counts == 0 && some_solid || *counts == -1 && !solid);
            }
        }
    }

    #[test]
    fn volumes_are_closed(shape in shape(), light in light()) {
        let boundary = shape.boundary(&shape.volume(light, VolumeParts::ALL));
        prop_assert_eq!(unbalanced(&boundary, shape.welded.len() as u32, light), 0);
    }

    #[test]
    fn volumes_wind_around_a_point_once_for_each_triangle_before_it(
        shape in shape(), light in light(), points in prop::collection::vec(place(), 8),
    ) {
        let volume = shape.volume(light, VolumeParts::ALL);
        let boundary = shape.boundary(&volume);
        for point in points {
            let point = point.as_dvec3();
            let winding = shape.winding(&boundary, light, point);
            let expected = shape.crossed(volume.scratch.facing(), light, point);
            prop_assert!((winding - f64::from(expected)).abs() < 1e-3, "{winding} around {point}, but {expected} crossed");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_eyes_count_is_what_the_volume_winds(shape in shape(), light in light(), eyes in prop::collection::vec(place(), 8)) {
        let volume = shape.volume(light, VolumeParts::ALL);
        let boundary = shape.boundary(&volume);
        for eye in eyes {
            let eye = eye.as_dvec3();
            let winding = shape.winding(&boundary, light, eye);
            match holding_count(&shape.mesh.topology, &shape.mesh.positions, light.as_dvec4(), eye) {
                EyeCount::Count(count) => prop_assert!((winding - f64::from(count)).abs() < 1e-3, "{winding} around {eye}, counted {count}"),
                EyeCount::Ambiguous => prop_assert!(shape.near_boundary(light, eye), "{eye} is far from every side and triangle"),
            }
        }
    }
}

#[test]
fn an_eye_in_line_with_an_edge_inside_the_surface_is_never_counted_wrong() {
    // Light and eye on the cube's axis, which meets its faces' diagonals: z-fail, or one exactly.
    let shape = Shape::new(cube());
    for step in -50..50 {
        let eye = DVec3::new(f64::from(step) * 1e-7, -3.0, f64::from(step) * -1e-7);
        let counted = holding_count(&shape.mesh.topology, &shape.mesh.positions, Vec4::new(0.0, 4.0, 0.0, 1.0).as_dvec4(), eye);
        assert!(matches!(counted, EyeCount::Count(1) | EyeCount::Ambiguous), "{counted:?} at {eye}");
        let clear = holding_count(
            &shape.mesh.topology,
            &shape.mesh.positions,
            Vec4::new(0.0, 4.0, 0.0, 1.0).as_dvec4(),
            eye + DVec3::X * 0.01,
        );
        assert_eq!(clear, EyeCount::Count(1));
    }
}

/// The number of silhouette edges of the cube, whose faces' diagonals never are any.
fn cube_silhouette(light: Vec4) -> usize {
    let shape = Shape::new(cube());
    let volume = shape.volume(light, VolumeParts::ALL);
    let edges = volume.scratch.silhouette().len();
    let a_side = if light.w == 0.0 { 3 } else { 6 };
    assert_eq!(volume.ranges.sides.len(), edges * a_side);
    // The pivot's two edges need no triangle.
    let dark = if light.w == 0.0 || edges == 0 { 0 } else { (edges - 2) * 3 };
    assert_eq!(volume.ranges.dark_cap.len(), dark);
    edges
}

#[test]
fn a_cube_has_the_silhouettes_one_knows() {
    assert_eq!(cube_silhouette(Vec4::new(0.2, 5.0, -0.1, 1.0)), 4, "one face seen");
    assert_eq!(cube_silhouette(Vec4::new(3.0, 5.0, -0.1, 1.0)), 6, "two faces seen");
    assert_eq!(cube_silhouette(Vec4::new(3.0, 5.0, -7.0, 1.0)), 6, "three faces seen");
    assert_eq!(cube_silhouette(Vec4::new(1.0, 1.0, -1.0, 0.0)), 6, "from a corner, infinitely far");
    assert_eq!(cube_silhouette(Vec4::new(0.0, 1.0, 0.0, 0.0)), 4, "straight from above, infinitely far");
    assert_eq!(cube_silhouette(Vec4::new(0.1, 0.2, 0.3, 1.0)), 0, "from inside no face is seen");
}

#[test]
fn short_indices_are_the_long_ones() {
    let shape = Shape::new(cube());
    let light = Vec4::new(3.0, 5.0, -7.0, 1.0);
    let (mut long, mut short, mut scratch) = (Vec::<u32>::new(), Vec::<u16>::new(), VolumeScratch::default());
    let ranges = scratch.append(shape.caster(), light, VolumeParts::ALL, &mut long);
    assert_eq!(scratch.append(shape.caster(), light, VolumeParts::ALL, &mut short), ranges);
    assert_eq!(short.iter().map(|&index| u32::from(index)).collect::<Vec<_>>(), long);
}

#[test]
fn parts_are_appended_and_only_those_asked_for() {
    let shape = Shape::new(cube());
    let light = Vec4::new(3.0, 5.0, -7.0, 1.0);
    let (mut indices, mut scratch) = (vec![7u32, 7, 7], VolumeScratch::default());
    let sides = scratch.append(shape.caster(), light, VolumeParts::SIDES, &mut indices);
    assert_eq!((sides.sides.clone(), sides.triangles()), (3..39, 12));
    assert!(sides.light_cap_kept.is_empty() && sides.light_cap_turned.is_empty() && sides.dark_cap.is_empty());
    let all = scratch.append(shape.caster(), light, VolumeParts::ALL, &mut indices);
    assert_eq!((all.sides, all.light_cap_kept, all.dark_cap), (39..75, 75..93, 93..105));
    assert_eq!(indices[3..39], indices[39..75]);
    assert_eq!(indices.len(), 105);
}

#[test]
fn a_light_in_a_room_casts_its_shadow_all_around_though_the_door_is_narrow() {
    // A cube seen from inside, one triangle of it missing.
    let (positions, mut indices) = cube();
    indices.truncate(33);
    let shape = Shape::new((positions, indices));
    let light = Vec4::new(0.1, 0.0, 0.05, 1.0);
    let volume = shape.volume(light, VolumeParts::ALL);
    assert_eq!(volume.scratch.silhouette().len(), 3);
    assert_eq!(volume.ranges.light_cap_turned.len(), 33, "every wall has its back to the light");
    assert_eq!(volume.ranges.dark_cap.len(), 33, "no fan");
    let boundary = shape.boundary(&volume);
    let behind_a_wall = shape.winding(&boundary, light, DVec3::new(-4.0, 0.3, 0.2));
    let beyond_the_door = shape.winding(&boundary, light, DVec3::new(4.0, -0.9, 1.1));
    assert!((behind_a_wall - 1.0).abs() < 1e-6 && beyond_the_door.abs() < 1e-6, "{behind_a_wall} {beyond_the_door}");
}

#[test]
fn a_fan_caps_what_all_triangles_would() {
    let shape = Shape::new(torus(9, 7, |_| 0.0));
    let light = Vec4::new(0.4, 3.0, 0.2, 1.0);
    let volume = shape.volume(light, VolumeParts::ALL);
    let lit = volume.scratch.facing().contributions().iter().filter(|counts| **counts == 1).count();
    assert!(volume.ranges.dark_cap.len() < lit * 3, "a fan is the smaller one");
    let mut boundary = shape.boundary(&volume);
    let fan: Vec<f64> = (0..40).map(|at| shape.winding(&boundary, light, sample(at))).collect();
    // The same volume with every lit triangle for a dark cap.
    boundary.truncate(boundary.len() - volume.ranges.dark_cap.len() / 3);
    let counted = shape.mesh.topology.triangles().iter().zip(volume.scratch.facing().contributions());
    for (triangle, _) in counted.filter(|(_, counts)| **counts == 1) {
        let [a, b, c] = triangle.map(|vertex| vertex + shape.welded.len() as u32);
        boundary.push([c, b, a]);
    }
    for (at, fan) in fan.iter().enumerate() {
        assert!((fan - shape.winding(&boundary, light, sample(at))).abs() < 1e-9);
    }
    assert!(fan.iter().any(|winding| *winding > 0.5) && fan.iter().any(|winding| *winding < 0.5));
}

/// Points all over the neighbourhood, the same every time.
fn sample(at: usize) -> DVec3 {
    let spread = |step: f64| (at as f64 * step).fract() * 4.0 - 2.0;
    DVec3::new(spread(0.618_034), spread(0.754_878), spread(0.569_840))
}

/// No edge of the silhouette lies on the light's side of a triangle in whose plane the light is: the sides that
/// begin there would cover the triangle at its own depth.
fn leaves_edge_on_triangles_behind(shape: &Shape, light: Vec4) -> (usize, usize) {
    let volume = shape.volume(light, VolumeParts::SIDES);
    let corner = |vertex: u32| shape.welded[vertex as usize].as_dvec3();
    let way = |from: DVec3| light.truncate().as_dvec3() - from * f64::from(light.w);
    let (mut edge_on, mut covered) = (0, 0);
    for triangle in shape.mesh.topology.triangles() {
        let [a, b, c] = triangle.map(corner);
        let normal = (b - a).cross(c - a).normalize();
        if normal.dot(way(a).normalize()).abs() > 4e-6 {
            continue;
        }
        edge_on += 1;
        for (from, to) in [(0, 1), (1, 2), (2, 0)] {
            let (from, to) = (triangle[from], triangle[to]);
            let lit_side = (corner(to) - corner(from)).cross(normal).dot(way(corner(from))) > 0.0;
            covered += usize::from(lit_side && volume.scratch.silhouette().iter().any(|e| *e == [from, to] || *e == [to, from]));
        }
    }
    (edge_on, covered)
}

#[test]
fn the_silhouette_runs_behind_what_the_light_sees_edge_on() {
    // The top of a cube, from the side: it goes with the wall that faces the light.
    let solid = Shape::new(cube());
    for light in [Vec4::new(5.0, 1.0, 0.3, 1.0), Vec4::new(-0.2, 0.0, 0.8, 0.0), Vec4::new(-4.0, 1.000_01, -7.0, 1.0)] {
        let (edge_on, covered) = leaves_edge_on_triangles_behind(&solid, light);
        assert!(edge_on >= 2 && covered == 0, "{edge_on} edge-on, {covered} covered before {light}");
    }
    // A notch in a block: the floor of the notch goes with the wall that hides it from the light.
    let outline = [(0.0, 0.0), (3.0, 0.0), (3.0, 2.0), (2.0, 2.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
    let strips = [[0, 1, 4], [0, 4, 5], [1, 2, 3], [1, 3, 4], [0, 5, 6], [0, 6, 7]];
    let count = outline.len() as u32;
    let positions = [0.0, 1.0].iter().flat_map(|z| outline.iter().map(move |(x, y)| glam::Vec3::new(*x, *y, *z))).collect();
    let mut indices = Vec::new();
    for [a, b, c] in strips {
        indices.extend([a, c, b, a + count, b + count, c + count]);
    }
    for at in 0..count {
        let next = (at + 1) % count;
        indices.extend([at, next, next + count, at, next + count, at + count]);
    }
    let notch = Shape::new((positions, indices));
    assert!(notch.mesh.topology.report().is_solid(), "{:?}", notch.mesh.topology.report());
    for light in [Vec4::new(9.0, 1.0, 0.4, 1.0), Vec4::new(-9.0, 2.0, 0.4, 1.0)] {
        let (edge_on, covered) = leaves_edge_on_triangles_behind(&notch, light);
        assert!(edge_on >= 2 && covered == 0, "{edge_on} edge-on, {covered} covered before {light}");
    }
}
