//! What a caster of 200,000 triangles costs: once a mesh, and each frame for each light; and what it
//! costs to flatten one of 6,000 into a cut-out.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::{DVec3, Vec3, Vec4};
use obscura::geometry::flatten::{Flattener, flattening_plane};
use obscura::geometry::overlap::OverlapScratch;
use obscura::geometry::{
    Aabb, Caster, Facing, Planes, Silhouette, Topology, VolumeParts, VolumeScratch, Weld, holding_count, silhouette::silhouette,
    terminator,
};
use obscura::scene::generated::knot;

fn geometry(criterion: &mut Criterion) {
    let (positions, indices) = knot(1000, 100);
    let build = || Topology::build(&indices, &positions, Weld::new(&positions, |_, _| std::cmp::Ordering::Equal), |_| true);
    let topology = build();
    assert!(topology.report().is_solid() && topology.report().triangles == 200_000, "{:?}", topology.report());
    // As a file holds it that splits every triangle's vertices.
    let split: Vec<Vec3> = indices.iter().map(|&index| positions[index as usize]).collect();
    let split_indices: Vec<u32> = (0..split.len() as u32).collect();

    let mut group = criterion.benchmark_group("200,000 triangles, once");
    group.sample_size(20);
    group.bench_function("topology", |bencher| bencher.iter(build));
    group.bench_function("topology, all vertices split", |bencher| {
        bencher.iter(|| Topology::build(&split_indices, &split, Weld::new(&split, |_, _| std::cmp::Ordering::Equal), |_| true));
    });
    group.finish();

    let (mut welded, mut planes) = (Vec::new(), Planes::default());
    topology.weld().gather(&positions, &mut welded);
    planes.build(&topology, &welded);
    let bounds = Aabb::from_points(welded.iter().copied());
    let caster = Caster { topology: &topology, welded: &welded, planes: &planes, bounds: &bounds };
    let lights = [("point", Vec4::new(5.0, 7.0, 3.0, 1.0)), ("directional", Vec4::new(0.4, 0.8, 0.4, 0.0))];

    let mut group = criterion.benchmark_group("200,000 triangles, each pose");
    group.bench_function("planes", |bencher| bencher.iter(|| planes_of(&topology, &welded)));
    let normals: Vec<Vec3> = welded.iter().map(|position| position.normalize()).collect();
    let mut sines = Vec::new();
    group.bench_function("terminator", |bencher| bencher.iter(|| terminator::sines(&positions, &normals, &indices, &mut sines)));
    group.finish();

    let mut group = criterion.benchmark_group("200,000 triangles, each light");
    let (mut facing, mut edges) = (Facing::default(), Vec::new());
    group.bench_function("facing", |bencher| bencher.iter(|| facing.decide(&topology, &planes, &welded, black_box(lights[0].1))));
    group.bench_function("silhouette from facing", |bencher| bencher.iter(|| silhouette(&topology, &facing, &mut edges)));
    let mut seen = Silhouette::default();
    group.bench_function("facing and silhouette, all cores", |bencher| {
        bencher.iter(|| seen.find(caster, black_box(lights[0].1)));
    });
    group.bench_function("bound on the winding", |bencher| {
        bencher.iter(|| {
            // Found anew: what is known costs nothing.
            seen.find(caster, lights[0].1);
            OverlapScratch::default().winding_bound(caster, black_box(lights[0].1), &seen, 255)
        });
    });
    let (mut scratch, mut out) = (VolumeScratch::default(), Vec::<u32>::new());
    for (name, light) in lights {
        for (what, parts) in [("facing, silhouette and sides", VolumeParts::SIDES), ("whole volume", VolumeParts::ALL)] {
            group.bench_function(format!("{what}, {name}"), |bencher| {
                bencher.iter(|| {
                    out.clear();
                    scratch.append(caster, black_box(light), parts, &mut out)
                });
            });
        }
    }
    group.bench_function("eye count", |bencher| {
        bencher.iter(|| holding_count(&topology, &positions, lights[0].1.as_dvec4(), black_box(DVec3::new(-4.0, -6.0, -2.0))));
    });
    group.finish();
}

/// K calls it "not a cheap operation": a knot's silhouette, projected and reduced to its outline.
fn flattening(criterion: &mut Criterion) {
    let (positions, indices) = knot(250, 12);
    let topology = Topology::build(&indices, &positions, Weld::new(&positions, |_, _| std::cmp::Ordering::Equal), |_| true);
    assert_eq!(topology.report().triangles, 6_000);
    let (mut welded, mut edges, mut facing) = (Vec::new(), Vec::new(), Facing::default());
    topology.weld().gather(&positions, &mut welded);
    let planes = planes_of(&topology, &welded);
    let bounds = Aabb::from_points(welded.iter().copied());
    let light = Vec4::new(5.0, 7.0, 3.0, 1.0);
    facing.decide(&topology, &planes, &welded, light);
    silhouette(&topology, &facing, &mut edges);
    let plane = || flattening_plane(welded.iter().copied(), &bounds, black_box(light.as_dvec4()));
    let Some(found) = plane() else { return };
    let mut flattener = Flattener::default();
    let mut group = criterion.benchmark_group("6,000 triangles, each light");
    group.bench_function("plane to flatten on", |bencher| bencher.iter(plane));
    group.bench_function("flattened silhouette", |bencher| {
        bencher.iter(|| flattener.flatten(&welded, &edges, &found, light.as_dvec4()));
    });
    group.finish();
}

fn planes_of(topology: &Topology, welded: &[Vec3]) -> Planes {
    let mut planes = Planes::default();
    planes.build(topology, welded);
    planes
}

criterion_group!(benches, geometry, flattening);
criterion_main!(benches);
