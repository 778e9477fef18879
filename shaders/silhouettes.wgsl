// Silhouettes and shadow volumes found on the device: facing, edges, and the indices of sides and caps, in the CPU's own
// order and to its last decision (geometry/silhouette.rs, geometry/volume.rs); the counts go into indirect draws.
//
//   face       a triangle: +1, 0 or -1, or left open where floats do not tell, or the light sees it edge-on
//   follow     what is open is decided exactly, and what is edge-on by its neighbours
//   pivot      the first edge of each silhouette, about which the dark cap is fanned
//   tally      how much each block of edges and triangles adds
//   scan       and so where each block's indices begin
//   write      the indices
//   arguments  of the draws
//
// A software GPU runs a branch that nobody takes, but leaves a loop as soon as all have: so what is seldom needed has a
// list and a stage of its own, and loops that have nothing to do end before they begin.
//
// Jobs, blocks and the arenas are laid out by gpu/compute.rs and geometry/arena.rs.

#include "shared/double.wgsl"

// One volume. Words of `topology` and `poses`, places in `facing` and `indices`.
struct Job {
    light: vec4u,           // object space, as bits
    reach: u32,             // of geometry::silhouette::EdgeOn, as bits
    room: u32,
    rounding: u32,
    flags: u32,
    triangles: u32,         // three corners each; the highest bit of the first is set in soup
    neighbours: u32,        // three each, across the edges from the first corner on
    pairs: u32,             // four each: ends, the triangle that runs along, the one that runs back
    others: u32,            // four each: ends, first incidence, how many
    incidences: u32,        // triangle number times two, plus one where it runs back
    planes: u32,            // five each: normal, offset, narrowness, as bits
    welded: u32,            // three each, as bits
    vertices: u32,          // how many; the extruded ones come after them
    facing: u32,
    edge_on: u32,           // the list of what is open: triangle; of what is edge-on, in the highest bits whom it follows
    sides: u32,
    cap: u32,
    dark: u32,
    triangle_count: u32,
    pair_count: u32,
    other_count: u32,
    triangle_block: u32,    // the first
    triangle_blocks: u32,
    edge_block: u32,
    edge_blocks: u32,
    start: u32,             // the start cap: the dark cap of near vertices, turned
    _pad0: u32,
    _pad1: u32,
    _pad2: u32,
}

const SIDES: u32 = 1u;
const LIGHT_CAP: u32 = 2u;
const FAN: u32 = 4u;
const DARK_TRIANGLES: u32 = 8u;
const TO_ONE_POINT: u32 = 16u;
const START_CAP: u32 = 32u;

// Counters of a job, before those of the blocks.
const COUNTERS: u32 = 8u;
const OPEN: u32 = 0u;
const PIVOT: u32 = 1u;      // all bits set less the first edge's number: zero where there is none
const SIDE_COUNT: u32 = 2u;
const FAN_COUNT: u32 = 3u;
const KEPT_COUNT: u32 = 4u;
const TURNED_COUNT: u32 = 5u;

const LANES: u32 = 64u;
const EACH: u32 = 8u;
// Workgroups in a row, where there are more than a dispatch may have.
const ROW: u32 = 32768u;
const NONE: u32 = 0xffffffffu;

const OF_TRIANGLES: u32 = 0u;
const OF_PAIRS: u32 = 1u;

@group(0) @binding(0) var<storage, read> topology: array<u32>;
@group(0) @binding(1) var<storage, read> poses: array<u32>;
@group(0) @binding(2) var<storage, read> jobs: array<Job>;
// First how many blocks of triangles, blocks, jobs and draws there are; then a block's job, kind and first item; then a
// draw's job, part and volume.
@group(0) @binding(3) var<storage, read> entries: array<vec4u>;
@group(0) @binding(4) var<storage, read_write> facing: array<i32>;
@group(0) @binding(4) var<storage, read_write> facing_shared: array<atomic<i32>>;
@group(0) @binding(5) var<storage, read_write> counters: array<atomic<u32>>;
@group(0) @binding(6) var<storage, read_write> indices: array<u32>;
@group(0) @binding(7) var<storage, read_write> draws: array<u32>;

fn number_of(group: vec3u) -> u32 {
    return group.x + group.y * ROW;
}

fn counter(job: u32, which: u32) -> u32 {
    return atomicLoad(&counters[job * COUNTERS + which]);
}

// Where a block's counters are: what it adds, and how much comes before that.
fn block_counters(block: u32) -> u32 {
    return entries[0].z * COUNTERS + block * 4u;
}

fn corner(job: Job, triangle: u32, which: u32) -> u32 {
    return topology[job.triangles + triangle * 3u + which] & 0x7fffffffu;
}

// -- face

struct Side {
    height: Double,
    least: Double,
}

// EdgeOn::height, rounded where the CPU rounds.
fn exactly(job: Job, at: u32) -> Side {
    let x = double_of(poses[at]);
    let y = double_of(poses[at + 1u]);
    let z = double_of(poses[at + 2u]);
    let offset = single(times(double_of(poses[at + 3u]), double_of(job.light.w)));
    let span = single(plus(single(plus(absolute(x), absolute(y))), absolute(z)));
    let unsure = single(plus(single(times(span, double_of(job.reach))), absolute(offset)));
    let across = single(plus(single(times(x, double_of(job.light.x))), single(times(y, double_of(job.light.y)))));
    let height = single(plus(single(plus(across, single(times(z, double_of(job.light.z))))), offset));
    let by_rounding = single(times(double_of(job.rounding), unsure));
    let by_room = single(times(double_of(poses[at + 4u]), double_of(job.room)));
    if less(by_rounding, by_room) {
        return Side(height, by_room);
    }
    return Side(height, by_rounding);
}

@compute @workgroup_size(LANES)
fn face(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let block = number_of(group);
    if block >= entries[0].x {
        return;
    }
    let entry = entries[1u + block];
    let job = jobs[entry.x];
    for (var item = entry.z + lane; item < min(entry.z + LANES * EACH, job.triangle_count); item += LANES) {
        let soup = topology[job.triangles + item * 3u] >> 31u == 1u;
        let at = job.planes + item * 5u;
        let plane = vec4f(bitcast<f32>(poses[at]), bitcast<f32>(poses[at + 1u]), bitcast<f32>(poses[at + 2u]), bitcast<f32>(poses[at + 3u]));
        let light = bitcast<vec4f>(job.light);
        let height = dot(plane, light);
        let span = (abs(plane.x) + abs(plane.y) + abs(plane.z)) * bitcast<f32>(job.reach) + abs(plane.w * light.w);
        let narrow = bitcast<f32>(poses[at + 4u]);
        let threshold = max(bitcast<f32>(job.rounding) * span, narrow * bitcast<f32>(job.room));
        let least = select(threshold, 0.0, soup);
        // Floats are off by some 2^-20 of the sum of all sizes, and by what the device takes for zero.
        let unsure = (span + threshold) * 7.62939453125e-6 + 1e-27;
        let clear = abs(abs(height) - least) > unsure;
        facing[job.facing + item] = select(select(0, -1, soup), 1, height > least);
        if !clear || (!soup && abs(height) < least) {
            facing[job.edge_on + atomicAdd(&counters[entry.x * COUNTERS + OPEN], 1u)] = i32(item);
        }
    }
}

// -- follow

struct Triple {
    x: Double,
    y: Double,
    z: Double,
}

fn triple(bits: vec3u) -> Triple {
    return Triple(double_of(bits.x), double_of(bits.y), double_of(bits.z));
}

fn difference(a: Triple, b: Triple) -> Triple {
    return Triple(plus(a.x, opposite(b.x)), plus(a.y, opposite(b.y)), plus(a.z, opposite(b.z)));
}

fn cross_of(a: Triple, b: Triple) -> Triple {
    return Triple(
        plus(times(a.y, b.z), opposite(times(b.y, a.z))),
        plus(times(a.z, b.x), opposite(times(b.z, a.x))),
        plus(times(a.x, b.y), opposite(times(b.x, a.y))),
    );
}

fn welded(job: Job, vertex: u32) -> Triple {
    let at = job.welded + vertex * 3u;
    return triple(vec3u(poses[at], poses[at + 1u], poses[at + 2u]));
}

// Whether the neighbour across a triangle's edge lies on its side towards the light (geometry/patches.rs).
fn is_towards(job: Job, triangle: u32, edge: u32) -> bool {
    let a = welded(job, corner(job, triangle, edge));
    let b = welded(job, corner(job, triangle, (edge + 1u) % 3u));
    let at = job.planes + triangle * 5u;
    let outward = cross_of(difference(b, a), triple(vec3u(poses[at], poses[at + 1u], poses[at + 2u])));
    var way = triple(job.light.xyz);
    if job.light.w != 0u {
        way = difference(way, a);
    }
    let sum = plus(plus(times(outward.x, way.x), times(outward.y, way.y)), times(outward.z, way.z));
    return !is_zero(sum) && !sum.negative;
}

var<workgroup> open_count: u32;
var<workgroup> changed: atomic<u32>;
var<workgroup> any_changed: u32;

@compute @workgroup_size(LANES)
fn follow(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let number = number_of(group);
    if number >= entries[0].z {
        return;
    }
    let job = jobs[number];
    if lane == 0u {
        open_count = counter(number, OPEN);
    }
    let count = workgroupUniformLoad(&open_count);
    for (var at = lane; at < count; at += LANES) {
        let triangle = u32(atomicLoad(&facing_shared[job.edge_on + at]));
        let soup = topology[job.triangles + triangle * 3u] >> 31u == 1u;
        let exact = exactly(job, job.planes + triangle * 5u);
        let above = !is_zero(exact.height) && !exact.height.negative;
        let faces = select(less(exact.least, exact.height), above, soup);
        let edge_on = !soup && less(absolute(exact.height), exact.least);
        atomicStore(&facing_shared[job.facing + triangle], select(select(0, -1, soup), 1, faces));
        var follows = 0u;
        for (var edge = 0u; edge < select(0u, 3u, edge_on); edge++) {
            if topology[job.neighbours + triangle * 3u + edge] != NONE && is_towards(job, triangle, edge) {
                follows |= 1u << (29u + edge);
            }
        }
        atomicStore(&facing_shared[job.edge_on + at], i32(triangle | follows));
    }
    storageBarrier();
    workgroupBarrier();
    // Nobody counts before all whom he follows do: in whatever order they are asked, the same come to count.
    loop {
        for (var at = lane; at < count; at += LANES) {
            let entry = u32(atomicLoad(&facing_shared[job.edge_on + at]));
            let triangle = entry & 0x1fffffffu;
            if entry >> 29u == 0u || atomicLoad(&facing_shared[job.facing + triangle]) == 1 {
                continue;
            }
            var all = true;
            for (var edge = 0u; edge < 3u; edge++) {
                if ((entry >> (29u + edge)) & 1u) == 1u {
                    let neighbour = topology[job.neighbours + triangle * 3u + edge];
                    all = all && atomicLoad(&facing_shared[job.facing + neighbour]) == 1;
                }
            }
            if all {
                atomicStore(&facing_shared[job.facing + triangle], 1);
                atomicStore(&changed, 1u);
            }
        }
        storageBarrier();
        workgroupBarrier();
        if lane == 0u {
            any_changed = atomicExchange(&changed, 0u);
        }
        if workgroupUniformLoad(&any_changed) == 0u {
            break;
        }
    }
}

// -- edges

struct Edge {
    ends: vec2u,            // the lit side's triangle runs from the first to the second
    count: u32,
}

fn edge_at(job: Job, kind: u32, item: u32) -> Edge {
    var at = job.pairs + item * 4u;
    var change = 0;
    if kind == OF_PAIRS {
        change = facing[job.facing + topology[at + 2u]] - facing[job.facing + topology[at + 3u]];
    } else {
        at = job.others + item * 4u;
        let first = job.incidences + topology[at + 2u];
        for (var next = first; next < first + topology[at + 3u]; next++) {
            let incidence = topology[next];
            change += (1 - 2 * i32(incidence & 1u)) * facing[job.facing + (incidence >> 1u)];
        }
    }
    let ends = vec2u(topology[at], topology[at + 1u]);
    return Edge(select(ends.yx, ends, change > 0), u32(abs(change)));
}

fn edges_of(job: Job, kind: u32) -> u32 {
    return select(job.other_count, job.pair_count, kind == OF_PAIRS);
}

@compute @workgroup_size(LANES)
fn pivot(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let block = number_of(group) + entries[0].x;
    if block >= entries[0].y {
        return;
    }
    let entry = entries[1u + block];
    let job = jobs[entry.x];
    let end = select(0u, min(entry.z + LANES * EACH, edges_of(job, entry.y)), (job.flags & FAN) != 0u);
    for (var item = entry.z + lane; item < end; item += LANES) {
        if edge_at(job, entry.y, item).count > 0u {
            let number = item + select(job.pair_count, 0u, entry.y == OF_PAIRS);
            atomicMax(&counters[entry.x * COUNTERS + PIVOT], NONE - number);
            break;
        }
    }
}

// The vertex about which a fan is laid.
fn pivot_of(number: u32, job: Job) -> u32 {
    let found = counter(number, PIVOT);
    if (job.flags & FAN) == 0u || found == 0u {
        return NONE;
    }
    let edge = NONE - found;
    if edge < job.pair_count {
        return edge_at(job, OF_PAIRS, edge).ends.x;
    }
    return edge_at(job, OF_PAIRS + 1u, edge - job.pair_count).ends.x;
}

// -- tally, scan, write

// What an item adds: of an edge, sides and triangles of the fan; of a triangle, one as it is or one turned.
fn adds(job: Job, kind: u32, item: u32, about: u32) -> vec2u {
    if kind == OF_TRIANGLES {
        let counts = facing[job.facing + item];
        return vec2u(select(0u, 1u, counts == 1), select(0u, 1u, counts == -1));
    }
    let edge = edge_at(job, kind, item);
    return vec2u(edge.count, select(edge.count, 0u, about == NONE || edge.ends.x == about || edge.ends.y == about));
}

// How many items of a kind there are to look at.
fn items_of(job: Job, kind: u32) -> u32 {
    if kind == OF_TRIANGLES {
        return select(0u, job.triangle_count, (job.flags & (LIGHT_CAP | DARK_TRIANGLES)) != 0u);
    }
    return select(0u, edges_of(job, kind), (job.flags & (SIDES | FAN)) != 0u);
}

var<workgroup> of_lanes: array<vec2u, LANES>;

// What the lanes before this one add.
fn before(lane: u32, own: vec2u) -> vec2u {
    of_lanes[lane] = own;
    workgroupBarrier();
    var sum = vec2u(0u);
    for (var other = 0u; other < lane; other++) {
        sum += of_lanes[other];
    }
    return sum;
}

@compute @workgroup_size(LANES)
fn tally(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let block = number_of(group);
    if block >= entries[0].y {
        return;
    }
    let entry = entries[1u + block];
    let job = jobs[entry.x];
    let about = pivot_of(entry.x, job);
    let first = entry.z + lane * EACH;
    let end = min(first + EACH, items_of(job, entry.y));
    var sum = vec2u(0u);
    for (var item = first; item < end; item++) {
        sum += adds(job, entry.y, item, about);
    }
    let total = before(lane, sum) + sum;
    if lane == LANES - 1u {
        atomicStore(&counters[block_counters(block)], total.x);
        atomicStore(&counters[block_counters(block) + 1u], total.y);
    }
}

@compute @workgroup_size(LANES)
fn scan(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let number = number_of(group);
    if number >= entries[0].z {
        return;
    }
    let job = jobs[number];
    for (var kind = 0u; kind < 2u; kind++) {
        let first_block = select(job.edge_block, job.triangle_block, kind == 0u);
        let count = select(job.edge_blocks, job.triangle_blocks, kind == 0u);
        let each = (count + LANES - 1u) / LANES;
        let first = first_block + min(lane * each, count);
        let end = first_block + min((lane + 1u) * each, count);
        var sum = vec2u(0u);
        for (var block = first; block < end; block++) {
            let at = block_counters(block);
            sum += vec2u(atomicLoad(&counters[at]), atomicLoad(&counters[at + 1u]));
        }
        workgroupBarrier();
        var begin = before(lane, sum);
        for (var block = first; block < end; block++) {
            let at = block_counters(block);
            let own = vec2u(atomicLoad(&counters[at]), atomicLoad(&counters[at + 1u]));
            atomicStore(&counters[at + 2u], begin.x);
            atomicStore(&counters[at + 3u], begin.y);
            begin += own;
        }
        if lane == LANES - 1u {
            let which = number * COUNTERS + select(SIDE_COUNT, KEPT_COUNT, kind == 0u);
            atomicStore(&counters[which], begin.x);
            atomicStore(&counters[which + 1u], begin.y);
        }
    }
}

fn write_triangle(at: u32, corners: vec3u) {
    indices[at] = corners.x;
    indices[at + 1u] = corners.y;
    indices[at + 2u] = corners.z;
}

fn write_edge(job: Job, edge: Edge, about: u32, begin: vec2u) {
    let a = edge.ends.x;
    let b = edge.ends.y;
    let v = job.vertices;
    if (job.flags & SIDES) != 0u {
        for (var copy = 0u; copy < edge.count; copy++) {
            if (job.flags & TO_ONE_POINT) != 0u {
                write_triangle(job.sides + (begin.x + copy) * 3u, vec3u(a, a + v, b));
            } else {
                let at = job.sides + (begin.x + copy) * 6u;
                write_triangle(at, vec3u(a, a + v, b + v));
                write_triangle(at + 3u, vec3u(a, b + v, b));
            }
        }
    }
    if about != NONE && a != about && b != about {
        for (var copy = 0u; copy < edge.count; copy++) {
            let at = (begin.y + copy) * 3u;
            write_triangle(job.dark + at, vec3u(about, b, a) + v);
            if (job.flags & START_CAP) != 0u {
                write_triangle(job.start + at, vec3u(about, a, b));
            }
        }
    }
}

fn write_cap(job: Job, number: u32, item: u32, begin: vec2u) {
    let counts = facing[job.facing + item];
    if counts == 0 {
        return;
    }
    let corners = vec3u(corner(job, item, 0u), corner(job, item, 1u), corner(job, item, 2u));
    // What is turned comes after all that is kept.
    let at = 3u * select(begin.x, counter(number, KEPT_COUNT) + begin.y, counts == -1);
    if (job.flags & LIGHT_CAP) != 0u {
        write_triangle(job.cap + at, corners);
    }
    if (job.flags & DARK_TRIANGLES) != 0u {
        write_triangle(job.dark + at, select(corners.zyx, corners, counts == -1) + job.vertices);
        if (job.flags & START_CAP) != 0u {
            write_triangle(job.start + at, select(corners, corners.zyx, counts == -1));
        }
    }
}

@compute @workgroup_size(LANES)
fn write(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let block = number_of(group);
    if block >= entries[0].y {
        return;
    }
    let entry = entries[1u + block];
    let job = jobs[entry.x];
    let about = pivot_of(entry.x, job);
    let at = block_counters(block);
    let any = atomicLoad(&counters[at]) + atomicLoad(&counters[at + 1u]) != 0u;
    let first = entry.z + lane * EACH;
    let end = select(0u, min(first + EACH, items_of(job, entry.y)), any);
    var sum = vec2u(0u);
    for (var item = first; item < end; item++) {
        sum += adds(job, entry.y, item, about);
    }
    var begin = before(lane, sum) + vec2u(atomicLoad(&counters[at + 2u]), atomicLoad(&counters[at + 3u]));
    let own_end = select(0u, end, sum.x + sum.y != 0u);
    for (var item = first; item < own_end; item++) {
        if entry.y == OF_TRIANGLES {
            write_cap(job, entry.x, item, begin);
        } else {
            write_edge(job, edge_at(job, entry.y, item), about, begin);
        }
        begin += adds(job, entry.y, item, about);
    }
}

// -- arguments

const PART_SIDES: u32 = 0u;
const PART_KEPT: u32 = 1u;
const PART_TURNED: u32 = 2u;
const PART_START: u32 = 4u;

@compute @workgroup_size(LANES)
fn arguments(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = number_of(group) * LANES + lane;
    if slot >= entries[0].w {
        return;
    }
    let entry = entries[1u + entries[0].y + slot];
    let job = jobs[entry.x];
    let kept = counter(entry.x, KEPT_COUNT) * 3u;
    let turned = counter(entry.x, TURNED_COUNT) * 3u;
    var first = select(job.dark, job.start, entry.y == PART_START);
    var count = 0u;
    if entry.y == PART_SIDES {
        first = job.sides;
        count = counter(entry.x, SIDE_COUNT) * select(6u, 3u, (job.flags & TO_ONE_POINT) != 0u);
    } else if entry.y == PART_KEPT {
        first = job.cap;
        count = kept;
    } else if entry.y == PART_TURNED {
        first = job.cap + kept;
        count = turned;
    } else if (job.flags & FAN) != 0u {
        count = counter(entry.x, FAN_COUNT) * 3u;
    } else if (job.flags & DARK_TRIANGLES) != 0u {
        count = kept + turned;
    }
    let at = slot * 5u;
    draws[at] = count;
    draws[at + 1u] = 1u;
    draws[at + 2u] = first;
    draws[at + 3u] = 0u;
    draws[at + 4u] = entry.z;
}
