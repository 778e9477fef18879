//! What is seen through a pixel: rays from the eye to the nearest surface, and on through mirrors.
//!
//! A mirror reflects the eye instead of the world, as the renderer does it: the ray goes on straight, from
//! the reflected eye through the mirror's plane, and what it meets is met where it really is. The module's
//! page ([`super`]) has the picture.

use glam::{DAffine3, DVec2, DVec3, DVec4};

use super::mask::Mask;
use super::path::Path;
use super::tree::{Bundle, Stack};
use super::world::{Face, NONE, Seen, Towards, World};
use crate::frame::Camera;
use crate::geometry::planar::height;
use crate::settings::MAX_BOUNCES;

/// The places in a pixel where surfaces are looked for, pixels from its centre.
pub const PLACES: [DVec2; 5] = [
    DVec2::ZERO,
    DVec2::new(-QUARTER, -QUARTER),
    DVec2::new(QUARTER, -QUARTER),
    DVec2::new(-QUARTER, QUARTER),
    DVec2::new(QUARTER, QUARTER),
];
const QUARTER: f64 = 0.25;

/// What a box is made larger by, of the world's size: much more than double precision is wrong by.
pub const SLACK: f64 = 1e-9;

/// What is seen in a mirror must be so much farther over its plane than what surely is not, in
/// [`World::clip_slack`]s: rounding decides in between.
pub const CLIP_ROUNDING: f64 = 3.0;

/// Two surfaces are one before the other where their depths differ by so many steps of 24 bits.
const DEPTH_STEPS: f64 = 4.0;

/// An eye, or a reflected one: where rays begin, and how they lie in the picture.
#[derive(Debug, Clone, Copy)]
pub struct Eye {
    /// World space.
    at: DVec3,
    /// Unit; depths are measured along it.
    forward: DVec3,
    /// One pixel to the right and one down, on the plane one metre before the eye.
    pub pixel: [DVec3; 2],
    /// The near plane's depth, metres: what is nearer is not seen.
    near: f64,
    /// Pixels of the whole picture.
    size: DVec2,
    /// What the eye was reflected by.
    through: Option<Window>,
}

/// Where what an eye sees begins that looks through a mirror, or out of a portal's other doorway.
#[derive(Debug, Clone, Copy)]
struct Window {
    mirror: u32,
    /// Unit normal to the side that is seen, and offset.
    plane: DVec4,
}

impl Eye {
    /// The camera's, for a picture of `size` pixels.
    pub fn new(camera: &Camera, size: [u32; 2]) -> Self {
        let size = DVec2::new(f64::from(size[0]), f64::from(size[1]));
        let half_height = (camera.vertical_fov / 2.0).tan();
        let right = camera.forward.cross(camera.up) * (half_height * camera.aspect * 2.0 / size.x);
        let down = camera.up * (-half_height * 2.0 / size.y);
        Self { at: camera.eye, forward: camera.forward, pixel: [right, down], near: camera.near, size, through: None }
    }

    /// The eye behind a mirror, which it looks through, or behind a portal's other doorway: what is seen begins at the
    /// `exit`, on its plane.
    fn turned(&self, turn: &DAffine3, exit: u32, plane: DVec4) -> Self {
        Self {
            at: turn.transform_point3(self.at),
            forward: turn.transform_vector3(self.forward),
            pixel: self.pixel.map(|step| turn.transform_vector3(step)),
            through: Some(Window { mirror: exit, plane }),
            ..*self
        }
    }

    /// Through a place of the picture, pixels from its top left. Its part along `forward` is 1: distances
    /// are depths.
    pub fn direction(&self, place: DVec2) -> DVec3 {
        let from_middle = place - self.size / 2.0;
        self.forward + self.pixel[0] * from_middle.x + self.pixel[1] * from_middle.y
    }

    /// So far along a direction, world space.
    pub fn point(&self, direction: DVec3, depth: f64) -> DVec3 {
        self.at + direction * depth
    }

    /// The depth from which on things are seen along a direction.
    fn least(&self, direction: DVec3) -> f64 {
        let Some(Window { plane, .. }) = self.through else { return self.near };
        let towards = plane.truncate().dot(direction);
        if towards > 0.0 { (-height(plane, self.at) / towards).max(self.near) } else { f64::INFINITY }
    }

    /// How far two surfaces at a depth must be apart for the depth buffer to tell which is nearer, metres.
    fn depth_step(&self, depth: f64) -> f64 {
        DEPTH_STEPS / f64::from(1u32 << 24) * depth * depth / self.near
    }
}

/// What one ray meets first.
#[derive(Clone, Copy)]
pub struct Nearest {
    pub depth: f64,
    /// [`NONE`] for no surface, in the next two as well.
    pub face: u32,
    pub instance: u32,
    /// [`NONE`] as well for what is no mirror.
    pub mirror: u32,
    /// Whether it is there at all: not at the cutoff of a mask, and not on the plane of the mirror that is
    /// looked through.
    pub sure: bool,
    /// The nearest surface behind it that is another instance, or another mirror: its depth, and its mirror.
    rival: (f64, u32),
}

impl Nearest {
    const NOTHING: Self =
        Self { depth: f64::INFINITY, face: NONE, instance: NONE, mirror: NONE, sure: true, rival: (f64::INFINITY, NONE) };

    /// Takes up another surface that the ray meets.
    fn or(&mut self, mut other: Self) {
        let differ = (other.instance, other.mirror) != (self.instance, self.mirror);
        if other.depth < self.depth {
            other.rival = if differ { (self.depth, self.mirror) } else { self.rival };
            *self = other;
        } else if differ && other.depth < self.rival.0 {
            self.rival = (other.depth, other.mirror);
        }
    }
}

/// What a whole pixel shows.
pub struct Shown {
    /// The mirrors on the way.
    pub path: Path,
    /// The eye that the last of them made.
    pub eye: Eye,
    /// From there to each of [`PLACES`].
    pub directions: [DVec3; PLACES.len()],
    /// What they meet: one instance or nothing, all the same.
    pub nearest: [Nearest; PLACES.len()],
    /// No other instance lies so near that the depth buffer cannot tell.
    pub alone: bool,
}

impl World {
    /// What is seen through a pixel, its centre so many pixels from the top left, by rays that are reflected up to
    /// `bounces` times; none where places of the pixel disagree.
    pub(super) fn look(&self, eye: &Eye, center: DVec2, bounces: u32, stack: &mut Stack) -> Option<Shown> {
        let (mut eye, mut path) = (*eye, Path::default());
        loop {
            let directions = PLACES.map(|place| eye.direction(center + place));
            let [right, down] = eye.pixel;
            let nearest = self.meet(&eye, directions, QUARTER * (right.abs() + down.abs()).max_element(), stack);
            let Nearest { instance, mirror, .. } = nearest[0];
            if nearest.iter().any(|met| !met.sure || met.instance != instance || met.mirror != mirror) {
                return None;
            }
            let tied = |met: &&Nearest| met.rival.0 - met.depth < eye.depth_step(met.depth);
            if nearest.iter().filter(tied).any(|met| met.rival.1 != mirror) {
                return None;
            }
            let last = path.mirrors().len() >= bounces.min(MAX_BOUNCES) as usize;
            match if last { Towards::Back } else { self.towards(mirror, eye.at) } {
                Towards::Unsure => return None,
                Towards::Front { turn, plane, exit } => {
                    path.push(mirror);
                    eye = eye.turned(&turn, exit, plane);
                }
                Towards::Back if self.outlined(&eye, &directions, &nearest) => return None,
                Towards::Back => {
                    let alone = !nearest.iter().any(|met| tied(&met));
                    return Some(Shown { path, eye, directions, nearest, alone });
                }
            }
        }
    }

    /// Whether an outline runs between what the first ray meets and what another does, both of one instance: the one
    /// ends before the other. Where they join in an edge, or are bent towards each other, their planes meet between the
    /// rays; where one stands before the other, they do not.
    fn outlined<const RAYS: usize>(&self, eye: &Eye, directions: &[DVec3; RAYS], nearest: &[Nearest; RAYS]) -> bool {
        /// Of a depth: what double precision may be wrong by.
        const ROUNDING: f64 = 1e-9;
        let (first, center) = (nearest[0], directions[0]);
        directions.iter().zip(nearest).skip(1).filter(|(_, met)| met.face != first.face && first.face != NONE).any(
            |(beside, met)| {
                let planes = [first.face, met.face].map(|face| self.faces[face as usize].from(eye.at));
                // One over depth changes in proportion over the picture.
                let nearer = |direction: DVec3| planes[0].nearness(direction) - planes[1].nearness(direction);
                let (here, there) = (nearer(center) * first.depth, nearer(*beside) * first.depth);
                here * there > 0.0 && here.abs().min(there.abs()) > ROUNDING
            },
        )
    }

    /// The nearest surface in each of some directions, all of them within `spread` of the first, metres for
    /// each metre of depth.
    pub(super) fn meet<const RAYS: usize>(
        &self,
        eye: &Eye,
        directions: [DVec3; RAYS],
        spread: f64,
        stack: &mut Stack,
    ) -> [Nearest; RAYS] {
        let least = directions.map(|direction| eye.least(direction));
        let mut sight = Sight {
            world: self,
            eye,
            inverse: directions[0].recip(),
            directions,
            first: least.into_iter().fold(f64::INFINITY, f64::min),
            least,
            spread: 2.0 * spread,
            slack: SLACK * (self.size + eye.at.length()),
            nearest: [Nearest::NOTHING; RAYS],
        };
        self.tree.descend(&mut sight, stack);
        if let Some(combined) = &self.combined {
            for (at, direction) in directions.iter().enumerate() {
                let crossings = combined.crossings(self, eye.at, *direction, stack);
                let met = crossings.iter().filter(|crossing| crossing.into && crossing.distance > least[at]);
                for crossing in met {
                    let (depth, face) = (crossing.distance, crossing.face);
                    let sure = sight.clear(*direction, depth - least[at]);
                    let instance = self.faces[face as usize].instance;
                    sight.nearest[at].or(Nearest { depth, face, instance, sure, ..Nearest::NOTHING });
                }
            }
        }
        sight.nearest
    }
}

/// The rays through one pixel's places.
struct Sight<'a, const RAYS: usize> {
    world: &'a World,
    eye: &'a Eye,
    directions: [DVec3; RAYS],
    /// Of the first one.
    inverse: DVec3,
    /// The depth from which on each of them sees something.
    least: [f64; RAYS],
    /// The least of those.
    first: f64,
    /// How far the others are from the first one at most, for each metre of depth.
    spread: f64,
    slack: f64,
    nearest: [Nearest; RAYS],
}

impl<const RAYS: usize> Sight<'_, RAYS> {
    /// What surely is not seen: the mirror that is looked through, and what lies on its plane or behind it.
    #[inline]
    fn hidden(&self, face: &Face) -> bool {
        self.eye.through.is_some_and(|Window { mirror, plane }| {
            face.mirror == mirror || face.corners.iter().all(|corner| height(plane, *corner) <= self.world.clip_slack())
        })
    }

    /// Whether a hit beyond the mirror's plane is so far over it that nobody doubts it.
    #[inline]
    fn clear(&self, direction: DVec3, beyond: f64) -> bool {
        self.eye
            .through
            .is_none_or(|Window { plane, .. }| plane.truncate().dot(direction) * beyond > CLIP_ROUNDING * self.world.clip_slack())
    }
}

impl<const RAYS: usize> Bundle for Sight<'_, RAYS> {
    #[inline]
    fn enters(&self, min: DVec3, max: DVec3) -> Option<f64> {
        let (low, high) = (min - self.eye.at, max - self.eye.at);
        // The farthest depth in the box: there the bundle is widest.
        let deepest = (self.eye.forward * low).max(self.eye.forward * high).element_sum();
        if deepest < self.first {
            return None;
        }
        let grown = self.spread * deepest + self.slack;
        enters(low - grown, high + grown, self.inverse, self.first, self.reach())
    }

    #[inline]
    fn reach(&self) -> f64 {
        let depth = self.nearest.iter().map(|met| met.depth).fold(0.0, f64::max);
        depth + self.eye.depth_step(depth)
    }

    fn meet(&mut self, index: u32) -> bool {
        let face = &self.world.faces[index as usize];
        if face.seen == Seen::Never || self.hidden(face) {
            return true;
        }
        let asked = face.from(self.eye.at);
        for at in 0..RAYS {
            let (direction, least) = (self.directions[at], self.least[at]);
            let Some(met) = asked.meet(direction) else { continue };
            let front = met.counter_clockwise != face.mirrored;
            let nearest = &self.nearest[at];
            let too_far = nearest.depth + self.eye.depth_step(nearest.depth);
            if met.distance <= least || met.distance >= too_far || !(front || face.seen == Seen::FromBothSides) {
                continue;
            }
            let mask = face.mask.map_or(Mask::Surface, |mask| {
                let beside = self.eye.pixel.map(|step| asked.weights(direction + step));
                self.world.masks.at(mask, asked.weights(direction), beside)
            });
            if mask != Mask::Hole {
                let sure = mask == Mask::Surface && self.clear(direction, met.distance - least);
                let (instance, mirror) = (face.instance, face.mirror);
                self.nearest[at].or(Nearest { depth: met.distance, face: index, instance, mirror, sure, ..Nearest::NOTHING });
            }
        }
        true
    }
}

/// Where a ray from the origin enters a box, not before `from` and not after `to`.
#[inline]
pub fn enters(low: DVec3, high: DVec3, inverse: DVec3, from: f64, to: f64) -> Option<f64> {
    let (a, b) = (low * inverse, high * inverse);
    let entry = a.min(b).max_element().max(from);
    let exit = a.max(b).min_element().min(to);
    (entry <= exit).then_some(entry)
}
