//! The bound on how often a volume winds around a point: never below what rays count, and close to it.
#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod shapes;

use glam::{DVec3, Vec3, Vec4};
use obscura::geometry::overlap::{OverlapScratch, is_convex};
use obscura::geometry::{Facing, Silhouette, VolumeParts};
use proptest::prelude::*;
use shapes::{Shape, Surface, cube, light, place, shape, sphere, torus};

fn bound(shape: &Shape, light: Vec4, enough: u32) -> u32 {
    let mut silhouette = Silhouette::default();
    silhouette.find(shape.caster(), light);
    OverlapScratch::default().winding_bound(shape.caster(), light, &silhouette, enough)
}

/// The most triangles that any of many rays from the light crosses: towards all middles of
/// triangles, and past all corners.
fn by_rays(shape: &Shape, light: Vec4, more: &[Vec3]) -> i32 {
    let mut facing = Facing::default();
    facing.decide(&shape.mesh.topology, &shape.planes, &shape.welded, light);
    let corners = |at: usize| shape.mesh.topology.triangles()[at].map(|vertex| shape.welded[vertex as usize].as_dvec3());
    let middles = (0..shape.mesh.topology.triangles().len()).map(|at| {
        let [a, b, c] = corners(at);
        a * 0.37 + b * 0.34 + c * 0.29
    });
    let past = shape.welded.iter().flat_map(|corner| {
        [-1.0, 1.0].into_iter().flat_map(move |x| [-1.0, 1.0].map(|z| corner.as_dvec3() + DVec3::new(x, 0.3 * z, z) * 1e-3))
    });
    middles.chain(past).chain(more.iter().map(|point| point.as_dvec3())).fold(0, |most, through| {
        let from = light.truncate().as_dvec3();
        let far = if light.w == 0.0 { through - from * 1e3 } else { from + (through - from).normalize_or_zero() * 1e3 };
        most.max(shape.crossed(&facing, light, far))
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_ray_crosses_more_than_the_bound(shape in shape(), light in light(), points in prop::collection::vec(place(), 64)) {
        let most = by_rays(&shape, light, &points);
        // Plainly, and with the order of the edges.
        for enough in [u32::MAX - 1, 1000, 3, 0] {
            let bound = bound(&shape, light, enough);
            prop_assert!(i64::from(bound) >= i64::from(most), "at most {bound} for {enough}, but {most} crossed");
        }
    }

    #[test]
    fn with_the_order_of_edges_the_bound_is_all_but_what_rays_find(
        shape in shape(), light in light(), points in prop::collection::vec(place(), 64),
    ) {
        let most = by_rays(&shape, light, &points);
        let found = bound(&shape, light, 0);
        // Small overlaps slip between the rays.
        prop_assert!(i64::from(found) <= i64::from(most) * 3 / 2 + 3, "{found} against {most}");
    }
}

#[test]
fn stacked_sheets_count_one_each_and_a_fence_counts_one() {
    let lamp = Vec4::new(0.3, 700.0, 0.2, 1.0);
    let sheet = |at: Vec3, size: f32, surface: &mut Surface| {
        let first = surface.0.len() as u32;
        surface.0.extend([[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]].map(|[x, z]| at + Vec3::new(x, 0.0, z) * size));
        surface.1.extend([0, 1, 2, 0, 2, 3].map(|index| first + index));
    };
    let mut stack = Surface::default();
    (0..300).for_each(|at| sheet(Vec3::new(0.0, at as f32, 0.0), 2.0, &mut stack));
    let stack = Shape::new(stack);
    for enough in [0, 255, 299] {
        assert_eq!(bound(&stack, lamp, enough), 300);
        assert_eq!(bound(&stack, Vec4::new(0.01, 1.0, 0.0, 0.0), enough), 300);
    }
    // Thirty by thirty, none above another: every meridian meets many of them, no ray two.
    let mut tiles = Surface::default();
    (0..900).for_each(|at| sheet(Vec3::new((at % 30) as f32, 0.0, (at / 30) as f32) * 3.0, 1.0, &mut tiles));
    let tiles = Shape::new(tiles);
    assert_eq!(bound(&tiles, lamp, 0), 1);
    assert_eq!(bound(&tiles, Vec4::new(0.1, 1.0, 0.2, 0.0), 0), 1);
    let plain = bound(&tiles, lamp, 60);
    assert!((20..=60).contains(&plain), "{plain}");
}

#[test]
fn a_light_all_around_which_the_caster_lies_is_bounded_too() {
    // A room seen from inside, and a torus that turns round the light.
    let (positions, mut indices) = cube();
    indices.iter_mut().for_each(|index| *index = 7 - *index);
    let room = Shape::new((positions, indices));
    assert_eq!(bound(&room, Vec4::new(0.1, 0.0, 0.05, 1.0), 0), 1);
    let ring = Shape::new(torus(30, 20, |_| 0.0));
    let at_center = bound(&ring, Vec4::new(0.0, 0.1, 0.0, 1.0), 0);
    assert_eq!(at_center, 1, "each ray leaves by the outside of the tube, turned away");
    let outside = Vec4::new(5.0, 0.1, 0.2, 1.0);
    // The near tube and the far one; close to its outline a tube of flat triangles is folded once more.
    let most = by_rays(&ring, outside, &[]);
    assert!((2..=3).contains(&most), "{most}");
    assert_eq!(bound(&ring, outside, 0), most.cast_unsigned(), "no more than some ray finds");
}

#[test]
fn convex_solids_are_told_from_others() {
    let convex = |surface: Surface| {
        let shape = Shape::new(surface);
        is_convex(&shape.mesh.topology, &shape.mesh.positions)
    };
    assert!(convex(cube()));
    assert!(convex(sphere(12, 16, |_| 0.0)), "flat quadrangles, rounded");
    assert!(!convex(torus(12, 9, |_| 0.0)));
    assert!(!convex(sphere(12, 16, |at| if at == 40 { 0.02 } else { 0.0 })), "one dent is enough");
    let mut open = cube();
    open.1.truncate(30);
    assert!(!convex(open));
    let (positions, mut inside_out) = cube();
    inside_out.iter_mut().for_each(|index| *index = 7 - *index);
    assert!(!convex((positions, inside_out)));
    let (mut two, mut indices) = cube();
    two.extend(cube().0.iter().map(|corner| *corner + Vec3::X * 5.0));
    indices.extend(cube().1.iter().map(|index| index + 8));
    assert!(!convex((two, indices)), "two convex solids");
}

/// Twenty faces that cross each other, each edge convex, all of them beneath: it winds seven times.
#[test]
fn the_great_icosahedron_is_not_convex() {
    let golden = (1.0 + 5f32.sqrt()) / 2.0;
    let corners: Vec<Vec3> = [[0.0, 1.0, golden], [1.0, golden, 0.0], [golden, 0.0, 1.0]]
        .iter()
        .flat_map(|&[x, y, z]| {
            [-1.0, 1.0].into_iter().flat_map(move |s| {
                [-1.0, 1.0].map(|t| match (x == 0.0, y == 0.0) {
                    (true, _) => Vec3::new(0.0, y * s, z * t),
                    (_, true) => Vec3::new(x * s, 0.0, z * t),
                    _ => Vec3::new(x * s, y * t, 0.0),
                })
            })
        })
        .collect();
    // Its faces are the triangles of the long diagonals: 2 golden apart.
    let far = |a: usize, b: usize| (corners[a].distance(corners[b]) - 2.0 * golden).abs() < 1e-4;
    let mut indices = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if far(a, b) && far(b, c) && far(c, a) {
                    let outward = (corners[b] - corners[a]).cross(corners[c] - corners[a]).dot(corners[a]) > 0.0;
                    indices.extend(if outward { [a, b, c] } else { [a, c, b] }.map(|corner| corner as u32));
                }
            }
        }
    }
    assert_eq!(indices.len(), 60);
    let shape = Shape::new((corners, indices));
    assert!(shape.mesh.topology.report().is_solid());
    assert!(!is_convex(&shape.mesh.topology, &shape.mesh.positions));
    let lamp = Vec4::new(1.0, 9.0, 2.0, 1.0);
    assert!(by_rays(&shape, lamp, &[]) > 1 && !shape.volume(lamp, VolumeParts::ALL).indices.is_empty());
}
