//! Clamped volumes (Lloyd, Wendt, Govindaraju, Manocha, *CC Shadow Volumes*, 2004): a volume is cut into the pieces about
//! what can receive its shadow, and what lies between them is not drawn.
//!
//! A volume holds a point between two planes as often as the piece of it between these planes does. So where everything
//! that is asked about lies between some pairs of planes, the pieces count the same, and the sides that ran through the air
//! from one receiver to the next are gone:
//!
//! ```text
//!        * light
//!       / \
//!      [###] caster            the first piece: from the caster to a cap just beyond it
//!      '---'
//!                              nothing is drawn here
//!     .-----.  start cap
//!     |[##] |                  a piece about a receiver, capped at both ends
//!     '-----'  end cap
//!
//!   .---------. start cap
//!  =|         |= floor ====    the last piece ends where the volume ends
//! ```
//!
//! All planes are parallel to the one that the volume ends on ([`super::ending`]), a face of a box along the axes: beyond
//! the light, what the caster's box shades is then a pyramid whose cross-sections are rectangles, and where it meets a
//! receiver's box is four inequalities in one unknown, the distance from the light along that axis.

use arrayvec::ArrayVec;
use glam::{DMat4, DVec2, DVec3, DVec4, Vec4Swizzles as _};

use super::frustum::rect_of;
use super::pixels::{around, common};
use super::reach::ROUNDING;

/// Most pieces of one volume.
pub const MOST: usize = 6;

/// Planes that the eye sees nearly from the side are not cut on: least sine of the angle between.
const GRAZING: f64 = 0.02;

/// What a triangle costs a software GPU, in fragments (as [`crate::techniques::windows`] has it).
const TRIANGLE: f64 = 300.0;

/// Volumes of more triangles are not cut: a silhouette of so many short edges has its cost in triangles, which each piece
/// has again (measured: cubes gain, knots of 6,000 triangles lose a tenth of the frame).
const MOST_TRIANGLES: f64 = 128.0;

/// A piece of a volume.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// The plane it starts on, with a cap there; none where it starts at the caster.
    pub start: Option<DVec4>,
    /// The plane it ends on. Normals are unit and point away from the light.
    pub end: DVec4,
    /// It has a cap there too: more may lie beyond.
    pub closed: bool,
    /// The pixels that may see any of it.
    pub drawn: [u32; 4],
    /// The pixels where it may hold a surface.
    pub matters: [u32; 4],
}

/// A stretch of distances from the light, and the pixels of the receivers there.
#[derive(Debug, Clone, Copy)]
struct Stretch {
    from: f64,
    to: f64,
    rect: [u32; 4],
}

/// All that a caster's box may shade, up to the plane its volume ends on.
#[derive(Debug, Clone)]
pub struct Pyramid {
    light: DVec3,
    /// The index of the axis that heights are measured along, and its sign.
    axis: usize,
    sign: f64,
    /// Least and greatest slope along each of the other two axes, metres a metre of height.
    slopes: [[f64; 2]; 2],
    /// Heights of the caster and of the end.
    caster: [f64; 2],
    end: f64,
    /// Metres between a receiver and the next plane, at least.
    margin: f64,
    stretches: ArrayVec<Stretch, MOST>,
}

impl Pyramid {
    /// What the box with these corners (world space) shades from a light at a place, up to the plane `end`, outward, a face
    /// of a box along the axes; `None` where it is no such plane.
    #[must_use]
    pub fn new(corners: &[DVec3; 8], light: DVec3, end: DVec4, margin: f64) -> Option<Self> {
        let normal = end.truncate();
        let axis = (0..3).find(|&axis| normal[axis].abs() == 1.0)?;
        let sign = normal[axis];
        let height = |place: DVec3| (place[axis] - light[axis]) * sign;
        let mut caster = [f64::INFINITY, f64::NEG_INFINITY];
        let mut slopes = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for corner in corners {
            let above = height(*corner);
            if above.is_nan() || above <= 0.0 {
                return None;
            }
            caster = [caster[0].min(above), caster[1].max(above)];
            for (slope, other) in slopes.iter_mut().zip([(axis + 1) % 3, (axis + 2) % 3]) {
                let ratio = (corner[other] - light[other]) / above;
                *slope = [slope[0].min(ratio), slope[1].max(ratio)];
            }
        }
        let end = -end.w - normal.dot(light);
        let fits = end.is_finite() && slopes.iter().flatten().all(|slope| slope.is_finite());
        // Rounding of what is drawn must stay well within the margin.
        let margin = margin.max(ROUNDING * light.abs().max_element().max(end));
        fits.then(|| Self { light, axis, sign, slopes, caster, end, margin, stretches: ArrayVec::new() })
    }

    /// The caster's own surfaces are asked about too; `rect` are their pixels.
    pub fn shades_itself(&mut self, rect: [u32; 4]) {
        let [from, to] = self.caster;
        self.take(Stretch { from, to, rect });
    }

    /// A box along the axes (world space: least and greatest corner) that surfaces lie in, and the pixels that may see any of
    /// them.
    pub fn falls_on(&mut self, [min, max]: [DVec3; 2], rect: [u32; 4]) {
        let height = |place: DVec3| (place[self.axis] - self.light[self.axis]) * self.sign;
        let (a, b) = (height(min), height(max));
        let mut from = a.min(b).max(self.caster[0]);
        let mut to = a.max(b).min(self.end);
        let others = [(self.axis + 1) % 3, (self.axis + 2) % 3];
        for ([low, high], other) in self.slopes.iter().zip(others) {
            // low * height <= greatest, and high * height >= least: with room for rounding.
            let (least, greatest) = (min[other] - self.light[other] - self.margin, max[other] - self.light[other] + self.margin);
            for (slope, most) in [(*low, greatest), (-*high, -least)] {
                if slope > 0.0 {
                    to = to.min(most / slope);
                } else if slope < 0.0 {
                    from = from.max(most / slope);
                } else if most < 0.0 {
                    return;
                }
            }
        }
        if from <= to {
            self.take(Stretch { from, to, rect });
        }
    }

    /// Joins a stretch with what it is not apart from.
    fn take(&mut self, mut new: Stretch) {
        let room = 4.0 * self.margin;
        let join =
            |a: &Stretch, b: &Stretch| Stretch { from: a.from.min(b.from), to: a.to.max(b.to), rect: around(a.rect, b.rect) };
        let mut at = 0;
        while at < self.stretches.len() {
            let other = self.stretches[at];
            if new.from <= other.to + room && other.from <= new.to + room {
                new = join(&new, &other);
                self.stretches.remove(at);
                at = 0;
            } else {
                at += 1;
            }
        }
        let place = self.stretches.iter().position(|other| other.from > new.from).unwrap_or(self.stretches.len());
        if self.stretches.is_full() {
            // One with a neighbour, whatever lies between.
            let neighbour = place.min(self.stretches.len() - 1);
            let other = self.stretches.remove(neighbour);
            self.take(join(&other, &new));
        } else {
            self.stretches.insert(place, new);
        }
    }

    /// The volume's pieces, nearest the light first, seen from `eye`: of a caster whose volume has about so many triangles.
    /// One piece from the caster to the end, not closed, where it is not worth cutting; none where nothing is held.
    #[must_use]
    pub fn pieces(&self, clip_from_world: &DMat4, size: [u32; 2], eye: DVec3, triangles: u64) -> ArrayVec<Piece, MOST> {
        let mut pieces = ArrayVec::new();
        let (Some(first), Some(last)) = (self.stretches.first(), self.stretches.last()) else { return pieces };
        #[expect(clippy::cast_precision_loss, reason = "a cost")]
        let (triangles, edges) = (triangles as f64, triangles as f64 / 2.0);
        let seen = |from: f64, to: f64| {
            let corners = [from, to].into_iter().flat_map(|height| self.section(height)).map(|corner| corner.extend(1.0));
            let clip: ArrayVec<DVec4, 8> = corners.map(|corner| *clip_from_world * corner).collect();
            (rect_of(clip.iter().copied(), size), clip)
        };
        let rect = |from: f64, to: f64| seen(from, to).0;
        let outline = |from: f64, to: f64| match seen(from, to) {
            (Some(rect), clip) => Outline::of(&clip, rect, size),
            (None, _) => Outline::default(),
        };
        // A software GPU pays for blocks of 4 x 4 pixels: for what is covered and for the length of all borders, along which
        // blocks are met by both neighbours; and for triangles.
        // Sides and both ends together cover the outline twice.
        let of_sides = |from: f64, to: f64| {
            let Outline { area, length } = outline(from, to);
            let ends = outline(from, from).area + outline(to, to).area;
            (2.0 * area - ends).max(0.0) + 4.0 * edges * length
        };
        let of_cap = |height: f64| {
            let Outline { area, length } = outline(height, height);
            area + (4.0 + edges) * length + TRIANGLE * edges
        };
        let eye_height = (eye[self.axis] - self.light[self.axis]) * self.sign;
        let few = triangles <= MOST_TRIANGLES;
        let may_cut = |height: f64| {
            let [a, .., b] = self.section(height);
            few && (eye_height - height).abs() > GRAZING * eye.distance((a + b) / 2.0)
                && (eye_height - height).abs() > self.margin
        };
        // Whether to leave out what lies between two heights.
        let gains = |from: f64, to: f64, [starts, ends]: [bool; 2]| {
            let planes = [(from, ends), (to, starts)];
            if to - from <= 2.0 * self.margin || planes.iter().any(|(height, cut)| *cut && !may_cut(*height)) {
                return false;
            }
            let caps = planes.iter().filter(|(_, cut)| *cut).map(|(height, _)| of_cap(*height)).sum::<f64>();
            let again = if starts && ends { TRIANGLE * triangles } else { 0.0 };
            of_sides(from, to) > caps + again
        };
        // The caster's vertices must lie before every plane.
        let beyond_caster = self.caster[1] + 0.5 * self.margin;
        let starts_at = (first.from - self.margin > beyond_caster
            && gains(self.caster[0], first.from - self.margin, [true, false]))
        .then_some(first.from - self.margin);
        let mut open = (starts_at, first.rect);
        let mut close = |(start, matters): (Option<f64>, [u32; 4]), end: f64, closed: bool| {
            let drawn = rect(start.unwrap_or(self.caster[0]), end);
            if let Some((drawn, matters)) = drawn.and_then(|drawn| Some((drawn, common(matters, drawn)?))) {
                let start = start.map(|height| self.plane(height));
                pieces.push(Piece { start, end: self.plane(end), closed, drawn, matters });
            }
        };
        for pair in self.stretches.windows(2) {
            let (end, start) = (pair[0].to + self.margin, pair[1].from - self.margin);
            if start > beyond_caster && end > beyond_caster && gains(end, start, [true, true]) {
                close(open, end, true);
                open = (Some(start), pair[1].rect);
            } else {
                open.1 = around(open.1, pair[1].rect);
            }
        }
        let end = last.to + self.margin;
        if end > beyond_caster && gains(end, self.end, [false, true]) {
            close(open, end, true);
        } else {
            close(open, self.end, false);
        }
        pieces
    }

    /// Where it is cut at a height.
    fn section(&self, height: f64) -> [DVec3; 4] {
        let [[a, b], [c, d]] = self.slopes;
        [[a, c], [a, d], [b, c], [b, d]].map(|[one, other]| {
            let mut place = self.light;
            place[self.axis] += self.sign * height;
            place[(self.axis + 1) % 3] += one * height;
            place[(self.axis + 2) % 3] += other * height;
            place
        })
    }

    fn plane(&self, height: f64) -> DVec4 {
        let mut normal = DVec3::ZERO;
        normal[self.axis] = self.sign;
        normal.extend(-(height + normal.dot(self.light)))
    }
}

/// What a picture shows of a convex body.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Outline {
    /// Pixels, about.
    area: f64,
    /// Around it, pixels.
    length: f64,
}

impl Outline {
    /// Of a body whose corners in clip space are `clip`, in a picture of `size` that shows it within `rect` alone.
    fn of(clip: &[DVec4], rect: [u32; 4], size: [u32; 2]) -> Self {
        let [width, height] = [rect[2], rect[3]].map(f64::from);
        let of_rect = Self { area: width * height, length: 2.0 * (width + height) };
        if clip.iter().any(|corner| corner.w <= corner.z) {
            return of_rect;
        }
        let to_pixels = DVec2::new(size[0].into(), size[1].into()) * 0.5;
        let mut places: ArrayVec<DVec2, 8> = clip.iter().map(|corner| corner.xy() / corner.w * to_pixels).collect();
        let none = [DVec2::INFINITY, DVec2::NEG_INFINITY];
        let [min, max] = places.iter().fold(none, |[min, max], at| [min.min(*at), max.max(*at)]);
        let around = (max - min).element_product();
        if around.is_nan() || around <= 0.0 {
            return Self::default();
        }
        // The hull, by Andrew's monotone chain; of it the share that is on screen, as of what is about it.
        places.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        let chain = |places: &mut dyn Iterator<Item = &DVec2>| {
            let mut chain: ArrayVec<DVec2, 8> = ArrayVec::new();
            for place in places {
                while let [.., a, b] = chain.as_slice()
                    && (b - a).perp_dot(*place - a) <= 0.0
                {
                    chain.pop();
                }
                chain.push(*place);
            }
            let of = |[area, length]: [f64; 2], pair: &[DVec2]| {
                [area + pair[0].perp_dot(pair[1]) / 2.0, length + pair[0].distance(pair[1])]
            };
            chain.windows(2).fold([0.0; 2], of)
        };
        let [below, above] = [chain(&mut places.iter()), chain(&mut places.iter().rev())];
        let on_screen = (of_rect.area / around).min(1.0);
        Self { area: (below[0] + above[0]) * on_screen, length: (below[1] + above[1]) * on_screen }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

    use glam::Vec3;

    use super::*;
    use crate::geometry::Aabb;
    use crate::geometry::ending::ending_plane;

    const SIZE: [u32; 2] = [1280, 720];
    const MARGIN: f64 = 0.01;

    /// A camera without a far plane at `eye`, looking at the origin's surroundings.
    fn clip_from_world(eye: DVec3) -> DMat4 {
        crate::frame::Camera::look_at(eye, DVec3::new(0.0, 4.0, 0.0), 0.9, 16.0 / 9.0, 0.1).unwrap().clip_from_world()
    }

    fn boxed(at: DVec3, half: DVec3) -> Aabb {
        Aabb { min: (at - half).as_vec3(), max: (at + half).as_vec3() }
    }

    /// How many of the pieces a place lies in, were they all around.
    fn holding(pieces: &[Piece], place: DVec3) -> usize {
        let place = place.extend(1.0);
        pieces.iter().filter(|piece| piece.start.is_none_or(|start| start.dot(place) > 0.0) && piece.end.dot(place) < 0.0).count()
    }

    #[test]
    fn every_place_in_shadow_lies_in_one_piece_and_no_plane_is_near_it() {
        let mut random = fastrand::Rng::with_seed(3);
        let within = |random: &mut fastrand::Rng, low: f64, high: f64| low + (high - low) * random.f64();
        let (mut in_shadow, mut cut) = (0, 0);
        for _ in 0..400 {
            let mut vector = |low: f64, high: f64| DVec3::from_array([(); 3].map(|()| within(&mut random, low, high)));
            let caster = boxed(vector(-6.0, 6.0) + DVec3::Y * 14.0, vector(0.2, 0.9));
            let light = vector(-9.0, 9.0) + DVec3::Y * 32.0;
            let mut receivers: Vec<_> = (0..8).map(|_| boxed(vector(-9.0, 9.0) + DVec3::Y * 10.0, vector(0.1, 1.5))).collect();
            receivers.push(boxed(DVec3::ZERO, DVec3::new(30.0, 0.0, 30.0)));
            let eye = vector(-20.0, 20.0) + DVec3::Y * 6.0;
            let all = receivers.iter().fold(boxed(eye, DVec3::ZERO), |all, receiver| all.union(receiver)).union(&caster);
            let corners = caster.corners();
            let Some(end) = ending_plane(light, corners, &all) else { continue };
            let mut pyramid = Pyramid::new(&corners, light, end, MARGIN).unwrap();
            pyramid.shades_itself([0, 0, SIZE[0], SIZE[1]]);
            for receiver in &receivers {
                pyramid.falls_on([receiver.min.as_dvec3(), receiver.max.as_dvec3()], [0, 0, SIZE[0], SIZE[1]]);
            }
            let clip_from_world = clip_from_world(eye);
            let pieces = pyramid.pieces(&clip_from_world, SIZE, eye, 12);
            cut += pieces.iter().filter(|piece| piece.closed).count();
            for receiver in receivers.iter().chain([&caster]) {
                for _ in 0..40 {
                    let share = DVec3::from_array([(); 3].map(|()| random.f64()));
                    let place = receiver.min.as_dvec3() + share * (receiver.max - receiver.min).as_dvec3();
                    let clip = clip_from_world * place.extend(1.0);
                    let on_screen = clip.w > clip.z && clip.x.abs() < clip.w && clip.y.abs() < clip.w;
                    if !on_screen || !caster.meets_segment(place, light - place, 1.0) {
                        continue;
                    }
                    in_shadow += 1;
                    assert_eq!(holding(&pieces, place), 1, "{place} of {receiver:?} in {pieces:?}");
                    let mut planes = pieces.iter().flat_map(|piece| [piece.start, Some(piece.end)]).flatten();
                    let near = planes.find(|plane| plane.dot(place.extend(1.0)).abs() < 0.9 * MARGIN);
                    assert_eq!(near, None, "passes through {place}");
                }
            }
        }
        assert!(in_shadow > 2000 && cut > 100, "{in_shadow} places, {cut} pieces");
    }

    #[test]
    fn a_cube_high_over_the_floor_has_two_pieces_and_one_on_it_one() {
        let light = DVec3::new(0.0, 40.0, 0.0);
        let eye = DVec3::new(3.0, 4.0, 16.0);
        let floor = [DVec3::new(-20.0, 0.0, -20.0), DVec3::new(20.0, 0.0, 20.0)];
        let pieces = |height: f64, own: bool| {
            let caster = boxed(DVec3::Y * height, DVec3::ONE);
            let all = Aabb { min: Vec3::new(-20.0, 0.0, -20.0), max: Vec3::new(20.0, 18.0, 20.0) };
            let end = ending_plane(light, caster.corners(), &all).unwrap();
            let mut pyramid = Pyramid::new(&caster.corners(), light, end, MARGIN).unwrap();
            if own {
                pyramid.shades_itself([0, 0, 1280, 720]);
            }
            pyramid.falls_on(floor, [0, 0, 1280, 720]);
            pyramid.pieces(&clip_from_world(eye), SIZE, eye, 12)
        };
        let high = pieces(9.0, true);
        assert_eq!(
            high.iter().map(|piece| (piece.start.is_some(), piece.closed)).collect::<Vec<_>>(),
            [(false, true), (true, false)]
        );
        let end = high[0].end;
        assert!(end.y == -1.0 && (7.9..8.0).contains(&end.w), "just below the cube: {end}");
        let start = high[1].start.unwrap();
        assert!(start.y == -1.0 && (0.0..0.1).contains(&start.w), "just above the floor: {start}");
        // Whose own sides are nobody's business has the second alone; where there is no room between there is one, whole.
        assert_eq!(pieces(9.0, false).as_slice(), &high[1..]);
        let low = pieces(1.0, true);
        assert_eq!(low.iter().map(|piece| (piece.start, piece.closed)).collect::<Vec<_>>(), [(None, false)]);
    }

    #[test]
    fn what_meets_nothing_has_no_pieces() {
        let caster = boxed(DVec3::Y * 5.0, DVec3::ONE);
        let end = DVec4::new(0.0, -1.0, 0.0, -1.0);
        let mut pyramid = Pyramid::new(&caster.corners(), DVec3::Y * 10.0, end, MARGIN).unwrap();
        for aside in [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z] {
            let at = aside * 9.0;
            pyramid.falls_on([at - 1.0, at + 1.0], [0, 0, 9, 9]);
        }
        pyramid.falls_on([DVec3::new(-1.0, 7.0, -1.0), DVec3::new(1.0, 8.0, 1.0)], [0, 0, 9, 9]);
        let eye = DVec3::new(0.0, 5.0, 20.0);
        assert!(pyramid.pieces(&clip_from_world(eye), SIZE, eye, 12).is_empty());
        assert!(Pyramid::new(&caster.corners(), DVec3::Y * 5.0, end, MARGIN).is_none(), "the light is beside it");
        assert!(Pyramid::new(&caster.corners(), DVec3::Y * 10.0, DVec4::new(0.6, 0.8, 0.0, 3.0), MARGIN).is_none());
    }
}
