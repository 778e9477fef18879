//! How often volumes can lie over each other: a bound on what a stencil count must hold.
//!
//! A caster's volume winds around a point as often as the way from the light to that point crosses
//! triangles that span it. So its greatest winding is the greatest number of those triangles that
//! any one ray from the light crosses. Trying rays proves nothing; the silhouette does. Seen from
//! the light it is a set of directed closed curves with the lit side on their left, and the winding
//! in a direction changes only where one of them is crossed, by one, up or down by its direction.
//!
//! ```text
//!        pole: w0 triangles on the ray       One meridian, from pole to pole: each edge that runs
//!          |                                 east (->) is entered, each that runs west (<-) is
//!     +1 ->|----.                            left. Nothing on it winds oftener than
//!          |    |
//!     -1 <-|----'                              w0 + the edges on it that run east.
//!          |
//! ```
//!
//! Over all meridians that is one sweep of the silhouette's edges by azimuth, O(s log s). It needs
//! nothing of the caster: open, self-crossing, all around the light. A directional light's meridians
//! are parallel lines, and w0 is zero. The sweep is made about up to three axes, and the smallest
//! answer counts. It is loose where a meridian enters and leaves many parts one after the other: a
//! fence, a colonnade. There the order of the edges is looked at too, strip by strip between
//! neighbouring vertices (`Sweep::ordered`); within a strip edges have all but fixed heights, and
//! the answer is all but exact.
//!
//! A convex solid ([`is_convex`]) needs none of this: a ray leaves it for good.
//!
//! Counts of different casters add only where their volumes overlap: where cones about them, seen
//! from the light, do ([`Cone`]).
//!
//! All of it is meant up to the rounding that facing itself is decided with: slivers thinner than a
//! millionth of the caster may wind once more or less.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec2, DVec3, Vec3, Vec4};

use super::kept::Silhouette;
use super::volume::Caster;
use super::{Aabb, Topology};

/// Whether a mesh is the surface of one convex solid, up to a millionth of its size.
///
/// Every edge is convex, every triangle has one and the same point beneath it, and the triangles
/// cover the directions about that point once. So each ray from it meets the surface once, and a
/// body that is star-shaped and convex along every edge is convex. O(f).
#[must_use]
pub fn is_convex(topology: &Topology, positions: &[Vec3]) -> bool {
    const ROUNDING: f64 = 1e-6;
    let report = topology.report();
    if !report.is_solid() || report.components != 1 || !topology.others().ends.is_empty() {
        return false;
    }
    let corner = |welded: u32| positions[topology.weld().vertex_of_welded[welded as usize] as usize].as_dvec3();
    let triangles = topology.triangles();
    let used = || triangles.iter().flatten().map(|&welded| corner(welded));
    let inside = used().sum::<DVec3>() / (3 * triangles.len()) as f64;
    let slack = ROUNDING * used().fold(0.0, |radius: f64, point| radius.max(point.distance(inside)));

    let above = |triangle: u32, point: DVec3| {
        let [a, b, c] = triangles[triangle as usize].map(corner);
        (b - a).cross(c - a).try_normalize().map_or(0.0, |normal| normal.dot(point - a))
    };
    let pairs = topology.pairs();
    let convex_edges = pairs.forward.iter().zip(&pairs.backward).all(|(&forward, &backward)| {
        triangles[backward as usize].iter().all(|&welded| above(forward, corner(welded)) <= slack)
            && triangles[forward as usize].iter().all(|&welded| above(backward, corner(welded)) <= slack)
    });
    let beneath = || (0..triangles.len() as u32).all(|triangle| above(triangle, inside) <= slack);
    let half_angles = || -> f64 {
        triangles
            .iter()
            .map(|triangle| {
                // Van Oosterom and Strackee.
                let [a, b, c] = triangle.map(|welded| (corner(welded) - inside).normalize_or_zero());
                a.dot(b.cross(c)).atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
            })
            .sum()
    };
    convex_edges && beneath() && (half_angles() / TAU).round() == 1.0
}

/// Memory that bounds are found in, kept from one caster to the next.
#[derive(Debug)]
pub struct OverlapScratch {
    /// How many edges may still be looked at to make bounds smaller than the plain sweep's.
    pub patience: usize,
    /// The silhouette's ends, turned so that z runs to the pole.
    seen: Vec<[DVec3; 2]>,
    sweep: Sweep,
}

/// Some milliseconds.
const PATIENCE: usize = 400_000;

impl Default for OverlapScratch {
    fn default() -> Self {
        Self { patience: PATIENCE, seen: Vec::new(), sweep: Sweep::default() }
    }
}

impl OverlapScratch {
    /// Other casters, with all patience again.
    pub fn begin(&mut self) {
        self.patience = PATIENCE;
    }

    /// How often at most the volume of `caster` before `light` (object space, as
    /// [`super::volume::VolumeScratch::append`] takes it) winds around any point. A bound of
    /// `enough` or less is as good as any, and not made smaller.
    pub fn winding_bound(&mut self, caster: Caster<'_>, light: Vec4, silhouette: &Silhouette, enough: u32) -> u32 {
        let mut patience = self.patience;
        let bound =
            silhouette.bound(enough, &mut patience, |patience| self.find_bound(caster, light, silhouette, enough, patience));
        self.patience = patience;
        bound
    }

    fn find_bound(&mut self, caster: Caster<'_>, light: Vec4, silhouette: &Silhouette, enough: u32, patience: &mut usize) -> u32 {
        let Caster { topology, welded, bounds, .. } = caster;
        let contributions = silhouette.facing().contributions();
        let counted = contributions.iter().filter(|counts| **counts != 0).count();
        let mut best = u32::try_from(counted).unwrap_or(u32::MAX);
        if best <= 1 {
            return best;
        }
        let directional = light.w == 0.0;
        let from = light.truncate().as_dvec3();
        let center = bounds.center().as_dvec3();
        // Away from the light, where the caster lies: poles beside it have nothing before them.
        let forward = if directional { -from } else { center - from };
        let forward = forward.try_normalize().unwrap_or(DVec3::NEG_Y);
        let (right, up) = forward.any_orthonormal_pair();
        let turned = (up + right).normalize();
        let poles: &[DVec3] = if directional { &[up, right, turned] } else { &[up, right, forward] };
        for &pole in poles {
            // Azimuth grows to the left, as seen from the light.
            let east = if directional { pole.cross(forward) } else { pole.any_orthonormal_vector() };
            let to_sweep = DMat3::from_cols(east, pole.cross(east), pole).transpose();
            let turned = |vertex: u32| {
                let vertex = welded[vertex as usize].as_dvec3();
                to_sweep * if directional { vertex } else { vertex - from }
            };
            self.seen.clear();
            self.seen.extend(silhouette.edges().iter().map(|edge| edge.map(turned)));
            let bound = if directional {
                self.sweep.lay_parallel(&self.seen);
                self.sweep.bound(0, enough, patience)
            } else {
                // Mostly the pole's line misses the caster's box, and so all of its triangles.
                let beside = misses_pole(bounds.corners().map(|corner| to_sweep * (corner - from)));
                let Some(at_pole) = (if beside { Some(0) } else { crossed_at_pole(topology, contributions, turned) }) else {
                    continue;
                };
                if !self.sweep.lay_meridians(&self.seen) {
                    continue;
                }
                self.sweep.bound(at_pole, enough, patience)
            };
            best = best.min(bound);
            if best <= enough {
                break;
            }
        }
        best
    }
}

/// Whether a box lies wholly beside the pole's line, by more than rounding.
fn misses_pole(corners: [DVec3; 8]) -> bool {
    const SLACK: f64 = 1e-5;
    let size = corners.iter().map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
    [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y]
        .iter()
        .any(|side| corners.iter().all(|corner| side.dot(corner.truncate()) > SLACK * size))
}

/// How many counted triangles the ray from the light to the pole crosses; `None` where it
/// passes too near to an edge to tell. `turned` says where a vertex is.
fn crossed_at_pole(topology: &Topology, contributions: &[i8], turned: impl Fn(u32) -> DVec3) -> Option<u32> {
    let mut crossed = 0;
    for (triangle, _) in topology.triangles().iter().zip(contributions).filter(|(_, counts)| **counts != 0) {
        let [a, b, c] = triangle.map(&turned);
        if a.z < 0.0 && b.z < 0.0 && c.z < 0.0 {
            continue;
        }
        let turns = [(a, b), (b, c), (c, a)].map(|(from, to)| from.truncate().perp_dot(to.truncate()));
        let left = turns.iter().all(|turn| *turn >= 0.0);
        let right = turns.iter().all(|turn| *turn <= 0.0);
        if !left && !right {
            continue;
        }
        let twice_area: f64 = turns.iter().sum();
        let size = [a, b, c].iter().map(|corner| corner.truncate().length_squared()).fold(0.0, f64::max);
        if turns.iter().any(|turn| turn.abs() <= ROUNDING * size) {
            // On an edge, or seen edge-on.
            return None;
        }
        let height = (turns[1] * a.z + turns[2] * b.z + turns[0] * c.z) / twice_area;
        crossed += u32::from(height > 0.0);
    }
    Some(crossed)
}

/// Relative, of double precision sums of a few terms: generous.
const ROUNDING: f64 = 1e-12;

/// Silhouette edges as intervals of the swept coordinate (azimuth, or metres across).
#[derive(Debug, Default)]
struct Sweep {
    edges: Vec<Edge>,
    /// Where edges begin and end: place, then whether it begins there, then which.
    events: Vec<(f64, bool, u32)>,
    active: Vec<u32>,
    /// Of each edge, where it stands in `active`.
    place: Vec<u32>,
    heights: Vec<(f64, i8)>,
}

#[derive(Debug, Clone, Copy)]
struct Edge {
    start: f64,
    end: f64,
    /// +1 where crossing it from the pole enters, -1 where it leaves.
    enters: i8,
    height: Height,
}

/// How high an edge stands, by the swept coordinate.
#[derive(Debug, Clone, Copy)]
enum Height {
    /// Parallel light: value at the origin, and slope.
    Line(f64, f64),
    /// The tangent of the elevation of a plane through the light: amplitude, and azimuth of its
    /// peak. Nothing is known of edges along a meridian.
    Wave(Option<(f64, f64)>),
}

impl Height {
    /// Least and greatest between two places.
    fn between(self, from: f64, to: f64) -> (f64, f64) {
        let (a, b) = match self {
            Self::Line(at_zero, slope) => (at_zero + slope * from, at_zero + slope * to),
            Self::Wave(None) => return (f64::NEG_INFINITY, f64::INFINITY),
            Self::Wave(Some((amplitude, peak))) => {
                let holds = |turn: f64| {
                    let place = from + (peak + turn - from).rem_euclid(TAU);
                    place <= to
                };
                let (a, b) = (amplitude * (from - peak).cos(), amplitude * (to - peak).cos());
                let high = if holds(0.0) { amplitude } else { a.max(b) };
                let low = if holds(PI) { -amplitude } else { a.min(b) };
                (low, high)
            }
        };
        let slack = ROUNDING.sqrt() * a.abs().max(b.abs());
        (a.min(b) - slack, a.max(b) + slack)
    }
}

impl Sweep {
    /// Takes the silhouette as a parallel light sees it: x to the left, z up.
    fn lay_parallel(&mut self, silhouette: &[[DVec3; 2]]) {
        self.edges.clear();
        for &[a, b] in silhouette {
            if a.x == b.x {
                continue;
            }
            let slope = (b.z - a.z) / (b.x - a.x);
            self.edges.push(Edge {
                start: a.x.min(b.x),
                end: a.x.max(b.x),
                enters: if b.x > a.x { 1 } else { -1 },
                height: Height::Line(a.z - slope * a.x, slope),
            });
        }
    }

    /// Takes the silhouette by azimuth about z; false where an edge passes too near to the pole to
    /// say on which side.
    fn lay_meridians(&mut self, silhouette: &[[DVec3; 2]]) -> bool {
        const NEAR_POLE: f64 = 1e-7;
        self.edges.clear();
        for &[a, b] in silhouette {
            let [flat_a, flat_b] = [a, b].map(|point| point.truncate());
            let along = flat_b - flat_a;
            let at = (-flat_a.dot(along) / along.length_squared()).clamp(0.0, 1.0);
            let nearest = if at.is_nan() { flat_a } else { flat_a + along * at };
            // The pole of either side: an edge below the light is as near to the other one.
            if nearest.length() <= NEAR_POLE * a.length().max(b.length()) {
                return false;
            }
            let azimuth = |point: DVec2| point.y.atan2(point.x);
            let (from, to) = (azimuth(flat_a), azimuth(flat_b));
            let turn = to - from;
            let short = turn - TAU * (turn / TAU).round();
            if short == 0.0 {
                continue;
            }
            let normal = a.cross(b);
            let level = normal.truncate() / -normal.z;
            let known = normal.z.abs() > NEAR_POLE * normal.length() && level.is_finite();
            let height = Height::Wave(known.then(|| (level.length(), level.y.atan2(level.x))));
            let enters = if short > 0.0 { 1 } else { -1 };
            let (start, end) = if short > 0.0 { (from, to) } else { (to, from) };
            let mut push = |start, end| {
                if start < end {
                    self.edges.push(Edge { start, end, enters, height });
                }
            };
            if start <= end {
                push(start, end);
            } else {
                push(start, PI);
                push(-PI, end);
            }
        }
        true
    }

    /// The greatest winding on any line of the sweep, `at_pole` where each begins.
    fn bound(&mut self, at_pole: u32, enough: u32, patience: &mut usize) -> u32 {
        self.events.clear();
        for (edge, index) in self.edges.iter().zip(0u32..) {
            self.events.push((edge.start, true, index));
            self.events.push((edge.end, false, index));
        }
        self.events.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut entering = at_pole;
        let mut most = at_pole;
        for events in self.events.chunk_by(|a, b| a.0 == b.0) {
            // What ends and what begins at one place never meet.
            for &(_, begins, index) in events {
                if self.edges[index as usize].enters > 0 {
                    entering = if begins { entering.wrapping_add(1) } else { entering.wrapping_sub(1) };
                }
            }
            most = most.max(entering);
        }
        if most <= enough { most } else { self.ordered(at_pole, most, enough, patience) }
    }

    /// The same with the order of the edges on each line, where the number of them is more than
    /// `enough`; gives up, with what `plain` is, when `patience` ends.
    fn ordered(&mut self, at_pole: u32, plain: u32, enough: u32, patience: &mut usize) -> u32 {
        self.active.clear();
        self.place.clear();
        self.place.resize(self.edges.len(), 0);
        let mut entering = at_pole;
        let mut most = at_pole;
        let mut next = 0;
        while next < self.events.len() {
            let from = self.events[next].0;
            while let Some(&(_, begins, index)) = self.events.get(next).filter(|event| event.0 == from) {
                let enters = self.edges[index as usize].enters > 0;
                if begins {
                    self.place[index as usize] = self.active.len() as u32;
                    self.active.push(index);
                    entering = entering.wrapping_add(u32::from(enters));
                } else {
                    let hole = self.place[index as usize] as usize;
                    self.active.swap_remove(hole);
                    if let Some(&moved) = self.active.get(hole) {
                        self.place[moved as usize] = hole as u32;
                    }
                    entering = entering.wrapping_sub(u32::from(enters));
                }
                next += 1;
            }
            let Some(&(to, ..)) = self.events.get(next) else { break };
            if entering <= most.max(enough) {
                // As it is, this strip changes nothing.
                most = most.max(entering);
                continue;
            }
            let Some(left) = patience.checked_sub(self.active.len()) else { return plain };
            *patience = left;
            self.heights.clear();
            self.heights.extend(self.active.iter().map(|&index| {
                let edge = self.edges[index as usize];
                let (low, high) = edge.height.between(from, to);
                // From the pole down: entered as early, left as late as may be.
                (if edge.enters > 0 { high } else { low }, edge.enters)
            }));
            self.heights.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(b.1.cmp(&a.1)));
            let mut winding = i64::from(at_pole);
            for (_, enters) in &self.heights {
                winding += i64::from(*enters);
                most = most.max(u32::try_from(winding).unwrap_or(0));
            }
        }
        most
    }
}

/// The directions in which a caster's volume lies, seen from the light: a cone about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cone {
    /// Of a point light: unit axis, and half angle in radians (pi: everywhere), at most pi / 2 else,
    /// with its cosine and sine.
    Point(DVec3, f64, DVec2),
    /// Of a directional light: a place in the plane across the light, and a radius, metres.
    Parallel(DVec2, f64),
}

impl Cone {
    /// All directions.
    pub const EVERYWHERE: Self = Self::Point(DVec3::Y, PI, DVec2::NEG_X);

    /// About a box in world space; `light` is a point with w = 1, or the direction towards a
    /// directional light with w = 0.
    #[must_use]
    pub fn about(bounds: &Aabb, light: glam::DVec4) -> Self {
        const SLACK: f64 = 1e-5;
        let (center, radius) = (bounds.center().as_dvec3(), f64::from(bounds.radius()));
        let grown = radius + SLACK * (radius + center.abs().max_element());
        if light.w == 0.0 {
            let (right, up) = light.truncate().normalize_or(DVec3::Y).any_orthonormal_pair();
            return Self::Parallel(DVec2::new(center.dot(right), center.dot(up)), grown);
        }
        let way = center - light.truncate();
        match way.try_normalize() {
            Some(axis) if way.length() > grown => {
                let half = (grown / way.length()).asin() + SLACK;
                Self::Point(axis, half, DVec2::from_angle(half))
            }
            _ => Self::EVERYWHERE,
        }
    }

    /// Whether two casters' volumes may overlap. May say yes wrongly, never no.
    #[must_use]
    pub fn may_overlap(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Point(a, half_a, turn_a), Self::Point(b, half_b, turn_b)) => {
                // The cosine of the sum of the half angles.
                half_a + half_b >= PI || a.dot(*b) >= turn_a.x * turn_b.x - turn_a.y * turn_b.y
            }
            (Self::Parallel(a, radius_a), Self::Parallel(b, radius_b)) => a.distance(*b) <= radius_a + radius_b,
            _ => true,
        }
    }
}

/// Casters gathered so that in no direction their bounds add up to more than a limit.
#[derive(Debug, Clone, Default)]
pub struct Heap {
    members: Vec<(Cone, u32, u64)>,
    most: u64,
}

impl Heap {
    /// Nothing is in it any more.
    pub fn clear(&mut self) {
        self.members.clear();
        self.most = 0;
    }

    /// Adds a caster whose own greatest winding is at most `bound`, unless the heap could then count
    /// beyond `limit`; says whether it did.
    ///
    /// Casters that meet in one direction overlap pairwise. So for any one of them, it and all that
    /// may overlap it together bound the sum.
    pub fn try_add(&mut self, cone: Cone, bound: u32, limit: u64) -> bool {
        let bound_wide = u64::from(bound);
        let mut own = bound_wide;
        let mut most = self.most;
        for (other, other_bound, with_overlaps) in &self.members {
            if cone.may_overlap(other) {
                own += u64::from(*other_bound);
                most = most.max(with_overlaps + bound_wide);
            }
        }
        // The sum about a member may pass the limit only if the sum about the newcomer might.
        let most = most.max(own);
        if most > limit {
            return false;
        }
        for (other, _, with_overlaps) in &mut self.members {
            if cone.may_overlap(other) {
                *with_overlaps += bound_wide;
            }
        }
        self.members.push((cone, bound, own));
        self.most = most;
        true
    }

    /// The most that its casters can add up to over one point.
    #[must_use]
    pub fn most(&self) -> u64 {
        self.most
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec4;

    fn boxed(center: Vec3, half: f32) -> Aabb {
        Aabb::from_points([center - half, center + half])
    }

    #[test]
    fn cones_apart_add_nothing_to_each_other() {
        let lamp = DVec4::new(0.0, 10.0, 0.0, 1.0);
        let left = Cone::about(&boxed(Vec3::new(-4.0, 0.0, 0.0), 1.0), lamp);
        let right = Cone::about(&boxed(Vec3::new(4.0, 0.0, 0.0), 1.0), lamp);
        let below = Cone::about(&boxed(Vec3::new(4.5, -2.0, 0.0), 1.0), lamp);
        let around = Cone::about(&boxed(Vec3::new(0.0, 9.0, 0.0), 2.0), lamp);
        assert!(!left.may_overlap(&right) && right.may_overlap(&below));
        assert!([left, right, below].iter().all(|cone| around.may_overlap(cone)), "the lamp is within it");
        let sun = DVec4::new(0.0, 1.0, 0.0, 0.0);
        let [low, high, beside] =
            [[0.0, 0.0], [0.0, 50.0], [3.0, 0.0]].map(|[x, y]| Cone::about(&boxed(Vec3::new(x, y, 0.0), 0.8), sun));
        assert!(low.may_overlap(&high) && !low.may_overlap(&beside));
    }

    #[test]
    fn a_heap_takes_what_fits_and_leaves_what_would_count_beyond() {
        let sun = DVec4::new(0.0, 1.0, 0.0, 0.0);
        let at = |x: f32| Cone::about(&boxed(Vec3::new(x, 0.0, 0.0), 0.5), sun);
        let mut heap = Heap::default();
        for place in 0..50 {
            assert!(heap.try_add(at(place as f32 * 5.0), 3, 3), "nothing overlaps");
        }
        assert_eq!(heap.most(), 3);
        assert!(!heap.try_add(at(10.0), 1, 3), "a fourth over the same place");
        assert!(heap.try_add(at(10.0), 1, 4));
        assert_eq!(heap.most(), 4);
        assert!(heap.try_add(at(15.0), 1, 4), "beside the fourth");
    }

    #[test]
    fn a_plane_through_the_light_stands_as_high_as_its_points() {
        let (a, b) = (DVec3::new(3.0, -1.0, 0.7), DVec3::new(2.0, 2.0, -0.4));
        let mut sweep = Sweep::default();
        assert!(sweep.lay_meridians(&[[a, b]]));
        let edge = sweep.edges[0];
        assert_eq!(edge.enters, 1, "it runs by growing azimuth");
        for step in 0..=20 {
            let point = a.lerp(b, f64::from(step) / 20.0);
            let azimuth = point.y.atan2(point.x);
            let height = point.z / point.truncate().length();
            let (low, high) = edge.height.between(azimuth, azimuth);
            assert!(low <= height && height <= high && high - low < 1e-5, "{low} {height} {high}");
            let (low, high) = edge.height.between(edge.start, edge.end);
            assert!(low <= height && height <= high);
        }
    }
}
