//! One pixel after the other: what is seen, and is it lit.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use glam::{DVec2, DVec3, DVec4};

use super::compare::{Verdict, Verdicts};
use super::eye::{CLIP_ROUNDING, Eye, PLACES, SLACK, Shown, enters};
use super::path::{Path, Surfaces};
use super::solid::Crossing;
use super::tree::{Bundle, Stack};
use super::world::{Asked, Casts, Face, NONE, World};
use crate::frame::Camera;
use crate::geometry::planar::{height, reflection};
use crate::scene::{LightKind, OffMirror, PosedLight};

/// Where the centre's ray to the light begins when it is moved along the surface, to the right and
/// down, in [`NUDGE`]s.
const SIDEWAYS: [DVec2; 4] = [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y];

/// Points of a surface: what is met at each place, and the centre's moved sideways.
const POINTS: usize = PLACES.len() + SIDEWAYS.len();

/// Where the light is moved to, in [`NUDGE`]s.
const NUDGES: [DVec3; 4] = [DVec3::ONE, DVec3::NEG_ONE, DVec3::new(1.0, -1.0, 1.0), DVec3::new(-1.0, 1.0, -1.0)];

/// How far either end of the ray to the light is moved, of the scene's size (or of 1, for a direction).
const NUDGE: f64 = 1e-6;

/// How far before a surface the ray to the light starts, of its depth.
const HAIR: f64 = 1e-7;

/// Rays between a pixel's points and a light: from each of them, from the centre's moved nearer and
/// farther, and from the centre to where the light is moved.
const RAYS: usize = POINTS + 2 + NUDGES.len();

/// How many volumes each ray crosses.
type Counts = [u8; RAYS];

/// What rays say of each pixel of a picture.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Traced {
    /// Light by light, what `show shadow` must hold.
    pub verdicts: Vec<Verdicts>,
    /// What is seen.
    pub surfaces: Surfaces,
}

impl World {
    /// What each pixel must be in `light`, for a picture of `size` pixels.
    #[must_use]
    pub fn judge(&self, camera: &Camera, light: &PosedLight, size: [u32; 2]) -> Verdicts {
        self.judge_lights(camera, std::slice::from_ref(light), size, &|_| true).and_then(|mut all| all.pop()).unwrap_or_default()
    }

    /// The same for several lights, on all cores. `goes_on` hears after every row which share of the
    /// work is done, from any thread; where it says no, there is no answer.
    pub fn judge_lights(
        &self,
        camera: &Camera,
        lights: &[PosedLight],
        size: [u32; 2],
        goes_on: &(dyn Fn(f64) -> bool + Sync),
    ) -> Option<Vec<Verdicts>> {
        self.trace(camera, lights, size, 0, goes_on).map(|traced| traced.verdicts)
    }

    /// The same by rays that mirrors reflect up to `bounces` times ([`crate::settings::MAX_BOUNCES`] at most), and
    /// which surface each pixel shows, through which mirrors.
    pub fn trace(
        &self,
        camera: &Camera,
        lights: &[PosedLight],
        size: [u32; 2],
        bounces: u32,
        goes_on: &(dyn Fn(f64) -> bool + Sync),
    ) -> Option<Traced> {
        let each = lights.len().max(1);
        let rows = self.rows((camera, bounces), size, goes_on, |caster, y| {
            let mut verdicts = vec![Verdict::Edge; each * size[0] as usize];
            let pixels = (0..size[0]).zip(verdicts.chunks_exact_mut(each));
            let surfaces: Vec<_> = pixels.map(|(x, verdicts)| caster.pixel(x, y, lights, verdicts)).collect();
            (verdicts, surfaces)
        })?;
        let mut verdicts = vec![Verdicts::new(size); lights.len()];
        for pixel in rows.iter().flat_map(|(row, _)| row.chunks_exact(each)) {
            for (verdicts, verdict) in verdicts.iter_mut().zip(pixel) {
                verdicts.push(*verdict);
            }
        }
        Some(Traced { verdicts, surfaces: Surfaces::new(size, rows.into_iter().flat_map(|(_, surfaces)| surfaces)) })
    }

    /// How many volumes of `light` each pixel lies in, modulo 256: what the stencil must hold. None
    /// where there is no surface, and at edges: borders between counts, not only of light.
    #[must_use]
    pub fn counts(&self, camera: &Camera, light: &PosedLight, size: [u32; 2]) -> Vec<Option<u8>> {
        let row = |caster: &mut Caster<'_>, y| (0..size[0]).map(|x| caster.count(x, y, light)).collect::<Vec<_>>();
        self.rows((camera, 0), size, &|_| true, row).unwrap_or_default().into_iter().flatten().collect()
    }

    /// Whether a point is in shadow of `light`; on a border it may say either.
    #[must_use]
    pub fn shades(&self, point: DVec3, light: &PosedLight) -> bool {
        let surface = Surface { points: [point; POINTS], displaced: [point; 2], face: NONE };
        let mut shadow = Shadow::new(self, light, &surface);
        self.tree.descend(&mut shadow, &mut Stack::new());
        shadow.meet_solid(&mut Stack::new());
        light.shadows && shadow.counts[0] > 0
    }

    /// Every row of a picture, on all cores, by rays that are reflected up to so many times.
    fn rows<T: Send>(
        &self,
        (camera, bounces): (&Camera, u32),
        size: [u32; 2],
        goes_on: &(dyn Fn(f64) -> bool + Sync),
        row: impl Fn(&mut Caster<'_>, u32) -> T + Sync,
    ) -> Option<Vec<T>> {
        let (next, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
        let work = || {
            let mut caster = Caster::new(self, Eye::new(camera, size), bounces);
            let mut done = Vec::new();
            while !stopped.load(Ordering::Relaxed) {
                let y = next.fetch_add(1, Ordering::Relaxed);
                let Some(at) = u32::try_from(y).ok().filter(|y| *y < size[1]) else { break };
                done.push((at, row(&mut caster, at)));
                if !goes_on(f64::from(at + 1) / f64::from(size[1])) {
                    stopped.store(true, Ordering::Relaxed);
                }
            }
            done
        };
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let mut rows: Vec<(u32, T)> = std::thread::scope(|scope| {
            let others: Vec<_> = (1..threads).map(|_| scope.spawn(work)).collect();
            let mut rows = work();
            for other in others {
                match other.join() {
                    Ok(done) => rows.extend(done),
                    Err(panic) => std::panic::resume_unwind(panic),
                }
            }
            rows
        });
        rows.sort_by_key(|(y, _)| *y);
        (!stopped.into_inner()).then(|| rows.into_iter().map(|(_, row)| row).collect())
    }
}

/// One thread's rays.
struct Caster<'a> {
    world: &'a World,
    eye: Eye,
    bounces: u32,
    stack: Stack,
    /// What cast the last shadow of each light: it may well cast the next.
    last: Vec<Option<u32>>,
}

/// What is seen through a pixel.
struct Surface {
    /// Metres, world space, a hair before the surface.
    points: [DVec3; POINTS],
    /// The centre's point moved nearer, and farther.
    displaced: [DVec3; 2],
    /// The triangle that the centre meets.
    face: u32,
}

impl<'a> Caster<'a> {
    fn new(world: &'a World, eye: Eye, bounces: u32) -> Self {
        Self { world, eye, bounces, stack: Stack::new(), last: Vec::new() }
    }

    /// The verdict of each light on one pixel; gives the mirrors on the way and the instance that is seen,
    /// where that is decided.
    fn pixel(&mut self, x: u32, y: u32, lights: &[PosedLight], verdicts: &mut [Verdict]) -> Option<(Path, u32)> {
        let shown = self.look(x, y)?;
        let instance = shown.nearest[0].instance;
        if instance == NONE {
            verdicts.fill(Verdict::Nothing);
        } else if !shown.nearest.iter().any(|met| self.world.asks_about(met.face)) {
            verdicts.fill(Verdict::Unasked);
        } else if !shown.nearest.iter().all(|met| self.world.asks_about(met.face)) {
            // Both kinds of surface in one pixel: an edge.
        } else if let Some(surface) = self.surface(&shown) {
            self.last.resize(lights.len(), None);
            for (number, (light, verdict)) in lights.iter().zip(verdicts).enumerate() {
                *verdict = self.light(number, light, &surface);
            }
        }
        shown.alone.then_some((shown.path, instance))
    }

    fn count(&mut self, x: u32, y: u32, light: &PosedLight) -> Option<u8> {
        let shown = self.look(x, y).filter(|shown| shown.nearest[0].instance != NONE)?;
        let surface = self.surface(&shown)?;
        let mut shadow = Shadow::new(self.world, light, &surface);
        shadow.counts_on = true;
        self.world.tree.descend(&mut shadow, &mut self.stack);
        shadow.meet_solid(&mut self.stack);
        let counts = shadow.counts;
        counts.iter().all(|count| *count == counts[0]).then_some(counts[0])
    }

    fn look(&mut self, x: u32, y: u32) -> Option<Shown> {
        let center = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        self.world.look(&self.eye, center, self.bounces, &mut self.stack)
    }

    /// The surface that a pixel shows, to be lit; none where rays beside the centre's meet another triangle.
    fn surface(&mut self, Shown { eye, directions, nearest, .. }: &Shown) -> Option<Surface> {
        let at = |direction: DVec3, depth: f64| eye.point(direction, depth * (1.0 - HAIR));
        let mut points = [DVec3::ZERO; POINTS];
        for (point, (direction, met)) in points.iter_mut().zip(directions.iter().zip(nearest)) {
            *point = at(*direction, met.depth);
        }
        // Moved sideways it must begin on the very same triangle: where two join, a rasteriser, which moves
        // corners to the nearest 256th of a pixel, may give the pixel to the one and the edge of a volume
        // that begins there to the other.
        let (depth, moved) = (nearest[0].depth, NUDGE * self.world.size);
        let [across, along] = eye.pixel.map(DVec3::normalize);
        let sideways = SIDEWAYS.map(|by| directions[0] + (across * by.x + along * by.y) * (moved / depth));
        let again = self.world.meet(eye, sideways, moved / depth, &mut self.stack);
        if again.iter().any(|met| met.face != nearest[0].face) {
            return None;
        }
        for (point, (direction, met)) in points[PLACES.len()..].iter_mut().zip(sideways.iter().zip(&again)) {
            *point = at(*direction, met.depth);
        }
        let displaced = [-moved, moved].map(|by| points[0] + directions[0].normalize() * by);
        Some(Surface { points, displaced, face: nearest[0].face })
    }

    /// Whether `light`, the `number`th, reaches all of the points, or none.
    fn light(&mut self, number: usize, light: &PosedLight, surface: &Surface) -> Verdict {
        if !matches!(light.kind, LightKind::Directional) && light.range.is_finite() {
            // The picture's distances are of single precision.
            let unsure = 1e-5 * light.range + 1e-6 * (self.world.largest + light.position.abs().max_element());
            let beyond = surface.points.map(|point| point.distance(light.position) - light.range);
            if beyond.iter().all(|beyond| *beyond > unsure) {
                return Verdict::OutOfRange;
            }
            if !beyond.iter().all(|beyond| *beyond < -unsure) {
                return Verdict::Edge;
            }
        }
        if let Some(off) = light.off {
            return self.light_off(light, off, surface);
        }
        if !light.shadows {
            return Verdict::Lit;
        }
        let mut shadow = Shadow::new(self.world, light, surface);
        if let Some(last) = self.last[number]
            && !shadow.meet(last)
        {
            return Verdict::Shadow;
        }
        self.world.tree.descend(&mut shadow, &mut self.stack);
        shadow.meet_solid(&mut self.stack);
        let shaded = shadow.counts.map(|count| count > 0);
        if shaded[0] {
            self.last[number] = shadow.whole.or(self.last[number]);
        }
        match shaded {
            _ if shaded.contains(&!shaded[0]) => Verdict::Edge,
            [true, ..] => Verdict::Shadow,
            [false, ..] => Verdict::Lit,
        }
    }

    /// The same of a light off a mirror: through the mirror's outline, and free of what casts on both parts of the way.
    /// The part to the mirror is asked for behind it, as it were, the points being reflected: from the real light
    /// straight on to there is as far, and through the same place of the mirror.
    fn light_off(&mut self, light: &PosedLight, off: OffMirror, surface: &Surface) -> Verdict {
        let Some(plane) = off.plane else { return Verdict::Shadow };
        let over = Some((plane, self.world.clip_slack()));
        let mut beam = Shadow { mirror: u32::try_from(off.mirror).unwrap_or(NONE), ..Shadow::new(self.world, light, surface) };
        self.world.tree.descend(&mut beam, &mut self.stack);
        let in_beam = beam.counts.map(|count| count > 0);
        let mut free = [true; RAYS];
        let mut unsure = false;
        if light.shadows && in_beam.contains(&true) {
            let reflection = reflection(plane);
            let reflected = Surface {
                points: surface.points.map(|point| reflection.transform_point3(point)),
                displaced: surface.displaced.map(|point| reflection.transform_point3(point)),
                face: NONE,
            };
            let mut before = Shadow { over, ..Shadow::new(self.world, &light.reflected(plane), &reflected) };
            let mut onward = Shadow { over, ..Shadow::new(self.world, light, surface) };
            for shadow in [&mut onward, &mut before] {
                self.world.tree.descend(shadow, &mut self.stack);
                shadow.meet_solid(&mut self.stack);
                unsure |= shadow.unsure;
                free.iter_mut().zip(shadow.counts).for_each(|(free, count)| *free &= count == 0);
            }
        }
        let mut lit = in_beam;
        lit.iter_mut().zip(free).for_each(|(lit, free)| *lit &= free);
        match lit {
            _ if unsure || lit.contains(&!lit[0]) => Verdict::Edge,
            [true, ..] => Verdict::Lit,
            [false, ..] => Verdict::Shadow,
        }
    }
}

/// The rays between one pixel's points and a light.
///
/// Rays with a common end are asked together: at a point light those of all points, at a directional
/// light those of the centre. The centre's ray comes first.
struct Shadow<'a> {
    world: &'a World,
    /// Of the middle ray, from the surface to the light.
    origin: DVec3,
    inverse: DVec3,
    /// Where it ends, in units of its direction.
    end: f64,
    /// How far the others are from it at most.
    spread: DVec3,
    /// Where rays begin, and which is the first that does not begin there any more.
    apices: [(DVec3, usize); POINTS + 2],
    apex_count: usize,
    directions: [DVec3; RAYS],
    /// The rays of the surface moved nearer and farther.
    displaced: [usize; 2],
    /// The triangle that is seen: a surface that is moved stays on the same side of it.
    own: u32,
    /// Rays run from the light, not to it.
    from_light: bool,
    counts: Counts,
    /// Every triangle is to be counted, not only found out whether there is one.
    counts_on: bool,
    /// A triangle that every ray meets.
    whole: Option<u32>,
    /// Only what is so far over a plane casts: unit normal and offset, and metres.
    over: Option<(DVec4, f64)>,
    /// Not what casts is asked for, but the triangles of this mirror, from whichever side; [`NONE`] for what casts.
    mirror: u32,
    /// Something casts so near that plane that rounding may have it on either side.
    unsure: bool,
}

impl<'a> Shadow<'a> {
    fn new(world: &'a World, light: &PosedLight, surface: &Surface) -> Self {
        let Surface { points, displaced: moved_points, face } = surface;
        let mut spread = DVec3::ZERO;
        for point in points.iter().chain(moved_points) {
            spread = spread.max((*point - points[0]).abs());
        }
        let (places, nudges) = (POINTS, NUDGES.len());
        let mut apices = [(DVec3::ZERO, 0); POINTS + 2];
        let mut directions = [DVec3::ZERO; RAYS];
        let from_light = !matches!(light.kind, LightKind::Directional);
        let (toward, end, apex_count, displaced);
        if from_light {
            apices[0] = (light.position, places + 2);
            for (direction, point) in directions.iter_mut().zip(points.iter().chain(moved_points)) {
                *direction = *point - light.position;
            }
            for (at, by) in NUDGES.iter().enumerate() {
                let moved = light.position + *by * (NUDGE * world.size);
                apices[1 + at] = (moved, places + 3 + at);
                directions[places + 2 + at] = points[0] - moved;
            }
            (toward, end) = (light.position - points[0], 1.0);
            (apex_count, displaced) = (1 + nudges, [places, places + 1]);
        } else {
            toward = -light.direction;
            end = f64::INFINITY;
            directions.fill(toward);
            for (direction, by) in directions[1..].iter_mut().zip(NUDGES) {
                *direction = -(light.direction + by * NUDGE).normalize();
            }
            for (at, point) in points.iter().chain(moved_points).enumerate() {
                apices[at] = (*point, nudges + 1 + at);
            }
            (apex_count, displaced) = (places + 2, [RAYS - 2, RAYS - 1]);
        }
        Self {
            world,
            origin: points[0],
            inverse: toward.recip(),
            end,
            // The light's moves, over the whole width of the world where it is a direction.
            spread: spread + (4.0 * NUDGE + SLACK) * world.size + SLACK * world.largest,
            apices,
            apex_count,
            directions,
            displaced,
            own: *face,
            from_light,
            counts: [0; RAYS],
            counts_on: false,
            whole: None,
            over: None,
            mirror: NONE,
            unsure: false,
        }
    }

    /// Counts how often the way to the light leaves two solids put together.
    fn meet_solid(&mut self, stack: &mut Stack) {
        let Some(combined) = &self.world.combined else { return };
        let mut first = 0;
        let mut crossed = [0u8; RAYS];
        for &(apex, end) in &self.apices[..self.apex_count] {
            for (crossed, direction) in crossed[first..end].iter_mut().zip(&self.directions[first..end]) {
                let crossings = combined.crossings(self.world, apex, *direction, stack);
                let over =
                    |distance: f64| self.over.is_none_or(|(plane, slack)| height(plane, apex + *direction * distance) > slack);
                let bars = |it: &&Crossing| it.into == self.from_light && it.distance < self.end && over(it.distance);
                let barred = crossings.iter().filter(bars).count();
                *crossed = u8::try_from(barred).unwrap_or(u8::MAX);
            }
            first = end;
        }
        // A surface that is moved stays on the same side of the solid that it belongs to.
        if self.own != NONE && combined.holds(self.own) {
            self.displaced.iter().for_each(|&ray| crossed[ray] = crossed[0]);
        }
        for (count, crossed) in self.counts.iter_mut().zip(crossed) {
            *count = count.wrapping_add(crossed);
        }
    }

    /// Whether this ray crosses the triangle so that it counts.
    #[inline]
    fn crosses(&mut self, face: &Face, asked: &Asked, apex: DVec3, direction: DVec3) -> bool {
        let Some(met) = asked.meet(direction).filter(|met| met.distance > 0.0 && met.distance < self.end) else { return false };
        if self.mirror != NONE {
            return true;
        }
        let facing = (met.counter_clockwise != face.mirrored) == self.from_light;
        if !facing && face.casts != Casts::Always {
            return false;
        }
        let Some((plane, slack)) = self.over else { return true };
        let height = height(plane, apex + direction * met.distance);
        self.unsure |= height.abs() <= CLIP_ROUNDING * slack;
        height > slack
    }
}

impl Bundle for Shadow<'_> {
    #[inline]
    fn enters(&self, min: DVec3, max: DVec3) -> Option<f64> {
        let (low, high) = (min - self.origin - self.spread, max - self.origin + self.spread);
        enters(low, high, self.inverse, 0.0, self.end)
    }

    #[inline]
    fn reach(&self) -> f64 {
        self.end
    }

    fn meet(&mut self, index: u32) -> bool {
        let face = &self.world.faces[index as usize];
        let low = |(plane, slack)| face.corners.iter().all(|corner| height(plane, *corner) <= slack);
        let asked_for = if self.mirror == NONE { face.casts != Casts::Never } else { face.mirror == self.mirror };
        if !asked_for || self.over.is_some_and(low) {
            return true;
        }
        let mut crossed = [false; RAYS];
        let mut first = 0;
        for at in 0..self.apex_count {
            let (apex, end) = self.apices[at];
            let asked = face.from(apex);
            for (ray, crossed) in (first..end).zip(&mut crossed[first..end]) {
                *crossed = self.crosses(face, &asked, apex, self.directions[ray]);
            }
            first = end;
        }
        if self.own == index {
            self.displaced.iter().for_each(|&ray| crossed[ray] = crossed[0]);
        }
        for (count, crossed) in self.counts.iter_mut().zip(crossed) {
            *count = count.wrapping_add(u8::from(crossed));
        }
        if crossed == [true; RAYS] {
            self.whole = Some(index);
        }
        self.counts_on || !self.counts.iter().all(|count| *count > 0)
    }
}
