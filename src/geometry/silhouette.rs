//! Which triangles face a light, and the edges where that changes.
//!
//! All of it happens in the caster's object space: the light comes to the mesh, not the mesh to
//! the light (M section 6). A light is four numbers: a point (x y z 1), or the direction *towards*
//! a directional light (x y z 0).
//!
//! Facing is decided **once** a triangle, and everything else (silhouette, caps, the count of
//! volumes that hold the eye) reads that decision. A triangle seen edge-on may be decided either
//! way by rounding; because nobody asks twice, the volume is closed whatever the answer.

use std::fmt::{self, Debug, Formatter};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};

use glam::{DAffine3, DVec3, DVec4, Vec3, Vec4};
use rayon::prelude::*;

use super::patches::Patches;
use super::{Aabb, Topology};

/// A light of world space (a point with w = 1, or the direction towards it with w = 0) in the
/// space of an object whose transform has an inverse. Directions come out unit.
#[must_use]
pub fn light_in_object(world_from_object: &DAffine3, light: impl Into<DVec4>) -> DVec4 {
    let light = light.into();
    let object_from_world = world_from_object.inverse();
    if light.w == 0.0 {
        object_from_world.transform_vector3(light.truncate()).normalize_or(DVec3::Y).extend(0.0)
    } else {
        object_from_world.transform_point3(light.truncate() / light.w).extend(1.0)
    }
}

/// The planes of a topology's triangles for one pose, as arrays, so that deciding who faces a
/// light is one straight loop.
#[derive(Clone, Default)]
pub struct Planes {
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
    offset: Vec<f32>,
    /// Each triangle's height over its longest edge, of the normal's length: what it is edge-on by.
    narrow: Vec<f32>,
    bounds: Aabb,
    build: u64,
}

/// Without the build's number: it says nothing of what the planes are.
impl Debug for Planes {
    fn fmt(&self, out: &mut Formatter<'_>) -> fmt::Result {
        let Self { x, y, z, offset, narrow, bounds, build: _ } = self;
        let planes = (x, y, z, offset);
        out.debug_struct("Planes").field("planes", &planes).field("narrow", narrow).field("bounds", bounds).finish()
    }
}

impl Planes {
    /// The planes of `topology` posed as `welded` (one position a welded vertex). They are not
    /// normalised: only the sign is used. Reuses the arrays.
    pub fn build(&mut self, topology: &Topology, welded: &[Vec3]) {
        static BUILDS: AtomicU64 = AtomicU64::new(1);
        self.build = BUILDS.fetch_add(1, Ordering::Relaxed);
        self.bounds = Aabb::from_points(welded.iter().copied());
        for array in [&mut self.x, &mut self.y, &mut self.z, &mut self.offset, &mut self.narrow] {
            array.clear();
            array.reserve(topology.triangles().len());
        }
        for triangle in topology.triangles() {
            let corners = triangle.map(|vertex| welded[vertex as usize]);
            let plane = plane(corners);
            self.x.push(plane.x);
            self.y.push(plane.y);
            self.z.push(plane.z);
            self.offset.push(plane.w);
            self.narrow.push(narrow(plane, corners));
        }
    }

    /// Decides triangles from `first` on into `out`, which has room for one block, and lists those seen edge-on.
    fn decide_block(&self, seen: &EdgeOn, soup: &[bool], first: usize, out: &mut [i8], edge_on: &mut Vec<u32>) {
        /// Few, because where one is edge-on all of them are looked at again.
        const RUN: usize = 256;
        edge_on.clear();
        for (run, out) in out.chunks_mut(RUN).enumerate() {
            let first = first + run * RUN;
            // Slices of one length, so that the loop has no checks in it and runs several at a time.
            let run = first..first + out.len();
            let [x, y, z, offset, narrow] =
                [&self.x, &self.y, &self.z, &self.offset, &self.narrow].map(|array| &array[run.clone()]);
            let soup = &soup[run];
            let height = |at: usize| seen.height([x[at], y[at], z[at], offset[at]], narrow[at]);
            let mut unclear = 0u32;
            for at in 0..out.len() {
                let [height, least] = height(at);
                out[at] = counts(height > if soup[at] { 0.0 } else { least }, soup[at]);
                unclear += u32::from(!soup[at] & (height.abs() < least));
            }
            if unclear > 0 {
                let is_edge_on = |at: &usize| {
                    let [height, least] = height(*at);
                    !soup[*at] & (height.abs() < least)
                };
                edge_on.extend((0..out.len()).filter(is_edge_on).map(|at| (first + at) as u32));
            }
        }
    }

    /// Of one triangle, not normalised.
    pub(super) fn normal(&self, triangle: usize) -> Vec3 {
        Vec3::new(self.x[triangle], self.y[triangle], self.z[triangle])
    }

    /// The number of the build that they are of: where it is the same, so are they.
    #[must_use]
    pub const fn build_number(&self) -> u64 {
        self.build
    }

    /// Normal, offset and narrowness of each, as bits.
    pub(super) fn append_words(&self, words: &mut Vec<u32>) {
        for at in 0..self.len() {
            words.extend([self.x[at], self.y[at], self.z[at], self.offset[at], self.narrow[at]].map(f32::to_bits));
        }
    }

    /// What facing `light` is decided with beside planes: the light's reach, the room, and what rounding leaves
    /// open.
    #[must_use]
    pub fn unsure(&self, light: Vec4) -> [f32; 3] {
        let EdgeOn { reach, room, .. } = EdgeOn::new(&self.bounds, light);
        [reach, room, EdgeOn::ROUNDING]
    }

    /// Of how many triangles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Of none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }
}

/// A mesh in one pose, as silhouettes see it.
#[derive(Debug, Clone, Default)]
pub struct Posed {
    /// One position a welded vertex, object space.
    pub welded: Vec<Vec3>,
    /// Of its triangles.
    pub planes: Planes,
}

impl Posed {
    /// Of a mesh whose vertices are at `positions`.
    #[must_use]
    pub fn new(topology: &Topology, positions: &[Vec3]) -> Self {
        let mut posed = Self::default();
        posed.find(topology, positions);
        posed
    }

    fn find(&mut self, topology: &Topology, positions: &[Vec3]) {
        topology.weld().gather(positions, &mut self.welded);
        self.planes.build(topology, &self.welded);
    }
}

/// A [`Posed`] that is found when it is asked for, in the memory of the one before.
#[derive(Debug, Default)]
pub struct LazyPosed {
    found: OnceLock<Posed>,
    before: Mutex<Posed>,
}

impl Clone for LazyPosed {
    fn clone(&self) -> Self {
        Self { found: self.found.clone(), before: Mutex::default() }
    }
}

impl LazyPosed {
    /// Of a mesh whose vertices are at `positions`: the same ones until it is [forgotten](Self::forget).
    pub fn get(&self, topology: &Topology, positions: &[Vec3]) -> &Posed {
        self.found.get_or_init(|| {
            let mut posed = std::mem::take(&mut *self.before.lock().unwrap_or_else(PoisonError::into_inner));
            posed.find(topology, positions);
            posed
        })
    }

    /// The vertices move.
    pub fn forget(&mut self) {
        if let Some(posed) = self.found.take() {
            *self.before.get_mut().unwrap_or_else(PoisonError::into_inner) = posed;
        }
    }
}

/// A triangle's plane, not normalised.
pub(super) fn plane(corners: [Vec3; 3]) -> Vec4 {
    // In double precision: rounded once, at the end, slivers keep their direction.
    let [a, b, c] = corners.map(|corner| corner.as_dvec3());
    let normal = (b - a).cross(c - a);
    normal.extend(-normal.dot(a)).as_vec4()
}

/// The normal's length over the longest edge's.
pub(super) fn narrow(plane: Vec4, [a, b, c]: [Vec3; 3]) -> f32 {
    let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared()).sqrt();
    if longest > 0.0 { plane.truncate().length() / longest } else { 0.0 }
}

/// A light, and how close to a triangle's plane it must be to see the triangle edge-on.
///
/// The sides of a volume that the light throws along a triangle rise over it by the light's angle to its
/// plane, times its length. Where that is less than some millionths of the coordinates, depths do not tell
/// the two apart; and a silhouette that runs on the triangle's other side is off by no more than that.
#[derive(Debug, Clone, Copy)]
pub(super) struct EdgeOn {
    /// In scalars, not lanes of one register: the loop over triangles is to take several triangles at a time.
    light: [f32; 4],
    /// The light's largest coordinate.
    reach: f32,
    /// Some millionths of the coordinates, times the least distance from the light.
    room: f32,
}

impl EdgeOn {
    /// Of the coordinates: what single precision leaves open about a height.
    const ROUNDING: f32 = 1.0 / (1u32 << 16) as f32;
    /// Of the coordinates: what depths do not tell apart.
    const SHARE: f32 = 2.0 / (1u32 << 20) as f32;

    /// For a mesh in `bounds`.
    pub(super) fn new(bounds: &Aabb, light: Vec4) -> Self {
        let reach = light.truncate().abs().max_element();
        let size = bounds.min.abs().max(bounds.max.abs()).max_element();
        let (size, distance) = if light.w == 0.0 {
            (size, 1.0)
        } else {
            (size.max(reach), light.truncate().distance(light.truncate().clamp(bounds.min, bounds.max)))
        };
        let room = Self::SHARE * size * distance;
        Self { light: light.to_array(), reach, room: if room.is_finite() { room } else { 0.0 } }
    }

    /// The light's height over a plane, and the height under which it sees the triangle edge-on. Neither is
    /// normalised.
    #[inline]
    fn height(&self, [x, y, z, w]: [f32; 4], narrow: f32) -> [f32; 2] {
        let [light_x, light_y, light_z, light_w] = self.light;
        let unsure = (x.abs() + y.abs() + z.abs()) * self.reach + (w * light_w).abs();
        let height = x * light_x + y * light_y + z * light_z + w * light_w;
        [height, (Self::ROUNDING * unsure).max(narrow * self.room)]
    }

    /// What a triangle adds to the volume by itself; `None` where it is seen edge-on, and its neighbours decide
    /// ([`Facing::decide`]).
    #[inline]
    pub(super) fn contribution(&self, plane: Vec4, narrow: f32, two_sided: bool) -> Option<i8> {
        let [height, least] = self.height(plane.to_array(), narrow);
        (height.abs() >= least).then(|| counts(height > 0.0, two_sided))
    }
}

#[cfg(test)]
impl EdgeOn {
    /// [`Self::contribution`] of one of many.
    pub(super) fn alone(&self, planes: &Planes, at: usize, two_sided: bool) -> Option<i8> {
        let plane = Vec4::new(planes.x[at], planes.y[at], planes.z[at], planes.offset[at]);
        if two_sided {
            let [height, _] = self.height(plane.to_array(), planes.narrow[at]);
            return Some(counts(height > 0.0, true));
        }
        self.contribution(plane, planes.narrow[at], false)
    }
}

fn counts(facing: bool, two_sided: bool) -> i8 {
    i8::from(facing) - i8::from(two_sided & !facing)
}

/// Triangles that are decided in one go, and edges that are looked at.
const BLOCK: usize = 1 << 12;
/// Blocks that are worth waking other cores for: below, one core is done in less time than it takes to ask them.
const MANY_BLOCKS: usize = 8;

/// What each triangle adds to the volume: +1 as it is, 0 nothing, -1 turned round.
#[derive(Debug, Clone, Default)]
pub struct Facing {
    contributions: Vec<i8>,
    /// Which triangles have the light in their plane, block by block.
    edge_on: Vec<Vec<u32>>,
    patches: Patches,
}

impl Facing {
    /// Decides for a light: +1 for triangles that face it; of those that do not, 0 in solid
    /// components and -1 in the soup. A triangle without area faces nothing. Reuses the array.
    ///
    /// ```text
    ///     light *        solid: +1 0        soup: +1 -1
    ///            \       ____               ____
    ///             v     | +1 |              +1
    ///                   |____| 0             ____ -1 (its back to the light)
    /// ```
    ///
    /// A triangle in whose plane the light lies may be counted or not; its own volume is flat, and closed
    /// either way. But where it leaves the silhouette on its side towards the light, the sides that begin
    /// there cover it, at its own depth, and rounding says pixel by pixel what they count. So it goes with
    /// the neighbour over which the light looks at it, and the silhouette runs where the light leaves it:
    ///
    /// ```text
    ///   light *  - - - -  ____edge-on___            light *  - - - -  \          ___
    ///                    |              \                              \        |
    ///            faces it: +1    +1      \ away: 0            away: 0    \__0____| faces it: +1
    /// ```
    ///
    /// Of the soup every triangle counts, so it goes by the sign alone.
    pub fn decide(&mut self, topology: &Topology, planes: &Planes, welded: &[Vec3], light: Vec4) {
        let seen = EdgeOn::new(&planes.bounds, light);
        let soup = topology.two_sided();
        let count = soup.len().min(planes.len());
        let blocks = count.div_ceil(BLOCK);
        self.contributions.resize(count, 0);
        self.edge_on.resize_with(blocks, Vec::new);
        let decide = |(block, (out, edge_on)): (usize, (&mut [i8], &mut Vec<u32>))| {
            planes.decide_block(&seen, soup, block * BLOCK, out, edge_on);
        };
        if blocks < MANY_BLOCKS {
            self.contributions.chunks_mut(BLOCK).zip(&mut self.edge_on).enumerate().for_each(decide);
        } else {
            self.contributions.par_chunks_mut(BLOCK).zip(self.edge_on.par_iter_mut()).enumerate().for_each(decide);
        }
        let edge_on = self.edge_on.iter().flatten().copied();
        self.patches.follow_neighbours(topology, planes, welded, light, edge_on, &mut self.contributions);
    }

    /// Decides for a cut-out, all of it on one plane: every triangle counts, those turned round whose
    /// own normal points away from `towards`, the plane's normal on the light's side.
    pub fn decide_planar(&mut self, topology: &Topology, welded: &[Vec3], towards: DVec3) {
        self.contributions.clear();
        self.contributions.extend(topology.triangles().iter().map(|triangle| {
            let [a, b, c] = triangle.map(|vertex| welded[vertex as usize].as_dvec3());
            if (b - a).cross(c - a).dot(towards) >= 0.0 { 1 } else { -1 }
        }));
    }

    /// One per triangle of the topology.
    #[must_use]
    pub fn contributions(&self) -> &[i8] {
        &self.contributions
    }
}

/// The silhouette into `edges` (cleared first): directed edges `[a, b]` of welded vertices, such
/// that the lit side's triangle, counter-clockwise seen from the light, runs a -> b. An edge whose
/// triangles add up to m stands there |m| times.
pub fn silhouette(topology: &Topology, facing: &Facing, edges: &mut Vec<[u32; 2]>) {
    silhouette_in_blocks(topology, facing, &mut Vec::new(), edges);
}

/// The same; `blocks` is memory for what several cores find, kept from one to the next.
pub(super) fn silhouette_in_blocks(
    topology: &Topology,
    facing: &Facing,
    blocks: &mut Vec<Vec<[u32; 2]>>,
    edges: &mut Vec<[u32; 2]>,
) {
    edges.clear();
    let contributions = facing.contributions();
    let pairs = topology.pairs();
    let count = pairs.a.len();
    let look_at = |block: std::ops::Range<usize>, edges: &mut Vec<[u32; 2]>| {
        let (forward, backward) = (&pairs.forward[block.clone()], &pairs.backward[block.clone()]);
        let ends = pairs.a[block.clone()].iter().zip(&pairs.b[block]);
        for ((&forward, &backward), (&a, &b)) in forward.iter().zip(backward).zip(ends) {
            let change = i32::from(contributions[forward as usize]) - i32::from(contributions[backward as usize]);
            if change != 0 {
                repeat(edges, [a, b], change);
            }
        }
    };
    if count < MANY_BLOCKS * BLOCK {
        look_at(0..count, edges);
    } else {
        blocks.resize_with(count.div_ceil(BLOCK), Vec::new);
        blocks.par_iter_mut().enumerate().for_each(|(block, found)| {
            found.clear();
            look_at(block * BLOCK..((block + 1) * BLOCK).min(count), found);
        });
        edges.extend(blocks.iter().flatten());
    }
    for (ends, incidences) in topology.others().iter() {
        let sum = incidences.map(|(triangle, sign)| sign * i32::from(contributions[triangle as usize])).sum();
        repeat(edges, ends, sum);
    }
}

/// The edges of every counted polygon by itself, none left out (K 6.3), into `kept` and `turned`
/// (cleared first).
///
/// Where two polygons meet, their sides fill the same place and must cancel. They do so to the last
/// bit only if both are drawn in the same vertex order, so one of them goes to `turned`: it is to be
/// drawn as the other, with increment and decrement swapped. The order is that of the silhouette,
/// should the edge be part of it: `kept` less `turned` is [`silhouette`]'s very list.
pub fn polygon_edges(topology: &Topology, facing: &Facing, kept: &mut Vec<[u32; 2]>, turned: &mut Vec<[u32; 2]>) {
    kept.clear();
    turned.clear();
    let contributions = facing.contributions();
    let counts = |triangle: u32, sign: i32| sign * i32::from(contributions[triangle as usize]);
    let mut add = |[a, b]: [u32; 2], along: &[i32]| {
        let forward = along.iter().sum::<i32>() >= 0;
        let edge = if forward { [a, b] } else { [b, a] };
        for &count in along.iter().filter(|count| **count != 0) {
            if (count > 0) == forward { kept.push(edge) } else { turned.push(edge) }
        }
    };
    let pairs = topology.pairs();
    for at in 0..pairs.a.len() {
        add([pairs.a[at], pairs.b[at]], &[counts(pairs.forward[at], 1), counts(pairs.backward[at], -1)]);
    }
    let mut along = Vec::new();
    for (ends, incidences) in topology.others().iter() {
        along.clear();
        along.extend(incidences.map(|(triangle, sign)| counts(triangle, sign)));
        add(ends, &along);
    }
}

fn repeat(edges: &mut Vec<[u32; 2]>, [a, b]: [u32; 2], times: i32) {
    let edge = if times > 0 { [a, b] } else { [b, a] };
    edges.extend(std::iter::repeat_n(edge, times.unsigned_abs() as usize));
}
