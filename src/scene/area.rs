//! Lights with a size, as collections of points (K section 6.4, after Brotman and Badler 1984).
//!
//! ```text
//!    globe: a point light's          disc: a spot's           rectangle: in the light's own plane
//!      . - .                           |  right                     ________
//!    (   x   )  points all over it     x ---> direction            |  x     |  points all over it
//!      ' - '                           |                           |________|
//! ```
//!
//! Shadow volumes know only points, so a light of N samples is N lights of a point each, with an Nth of
//! the intensity, each counted by itself: exact for every sample, and the more samples, the softer the
//! steps. The points are a low-discrepancy sequence (R2: Roberts 2018, the plastic number's powers), not
//! dice: the same settings give the same picture, any number of them from the start is spread well, and so
//! the frames that are gathered over time go on where the last one ended.

use glam::DVec3;

use super::{LightKind, Pose, PosedLight};

/// What shines.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum Extent {
    /// Hard shadows.
    #[default]
    Point,
    /// A globe of this radius in metres for a point light, a disc square to its direction for a spot.
    Round(f32),
    /// Width along the node's X and height along its Y, metres.
    Rectangle([f32; 2]),
}

impl Extent {
    /// Whether all its points are one.
    #[must_use]
    pub fn is_point(self) -> bool {
        match self {
            Self::Point => true,
            Self::Round(radius) => radius <= 0.0,
            Self::Rectangle(sides) => sides.iter().all(|side| *side <= 0.0),
        }
    }

    /// From the light's centre to the point of it that two numbers in 0..1 name, evenly; metres, world
    /// space.
    #[must_use]
    fn offset(self, light: &PosedLight, [u, v]: [f64; 2]) -> DVec3 {
        let up = light.right.cross(light.direction);
        let turn = std::f64::consts::TAU * u;
        match (self, light.kind) {
            (Self::Point, _) => DVec3::ZERO,
            // Even on a globe: evenly in height, by Archimedes.
            (Self::Round(radius), LightKind::Point) => {
                let height = 2.0 * v - 1.0;
                let ring = (1.0 - height * height).max(0.0).sqrt();
                f64::from(radius) * DVec3::new(ring * turn.cos(), height, ring * turn.sin())
            }
            (Self::Round(radius), _) => f64::from(radius) * v.sqrt() * (light.right * turn.cos() + up * turn.sin()),
            (Self::Rectangle([width, height]), _) => {
                light.right * (f64::from(width) * (u - 0.5)) + up * (f64::from(height) * (v - 0.5))
            }
        }
    }
}

/// Which points of the lights with a size are in one frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sampling {
    /// Points of each light, at least 1.
    pub samples: u32,
    /// Which of the gathered frames this is, from 0.
    pub frame: u32,
}

impl Sampling {
    /// How many points `light` is counted as.
    #[must_use]
    pub fn points(&self, light: &PosedLight) -> u32 {
        if light.extent.is_point() { 1 } else { self.samples.max(1) }
    }
}

/// Point `index` of the R2 sequence, shifted by `seed`'s own amount: in 0..1 by 0..1.
#[must_use]
pub fn sequence(index: u64, seed: usize) -> [f64; 2] {
    // The real root of x^3 = x + 1.
    const PLASTIC: f64 = 1.324_717_957_244_746;
    const GOLDEN: f64 = 0.618_033_988_749_895;
    #[expect(clippy::cast_precision_loss, reason = "a few thousand points of a few hundred lights")]
    let (index, seed) = (index as f64, seed as f64);
    [(0.5 + index / PLASTIC + seed * GOLDEN).fract(), (0.5 + index / (PLASTIC * PLASTIC) + seed * GOLDEN * GOLDEN).fract()]
}

impl Pose {
    /// Makes every light with a size its points: one stays in the light's own place among the lights, the
    /// others follow after all lights. Of the light `looked_at`, it is point `point` that stays.
    pub fn expand_lights(&mut self, sampling: Sampling, looked_at: usize, point: u32) {
        for index in 0..self.lights.len() {
            let light = self.lights[index];
            let count = sampling.points(&light);
            // A single point stands in the middle, until more are gathered.
            if light.extent.is_point() || (count == 1 && sampling.frame == 0) {
                continue;
            }
            let first = u64::from(sampling.frame) * u64::from(count);
            let mut points: Vec<_> = (0..count)
                .map(|number| {
                    let offset = light.extent.offset(&light, sequence(first + u64::from(number), index));
                    #[expect(clippy::cast_precision_loss, reason = "a few dozen")]
                    let intensity = light.intensity / count as f32;
                    PosedLight { position: light.center + offset, intensity, ..light }
                })
                .collect();
            if index == looked_at {
                points.swap(0, (point as usize).min(count as usize - 1));
            }
            self.lights[index] = points.remove(0);
            self.lights.extend(points);
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::cast_precision_loss, reason = "small counts")]
    use super::*;
    use glam::Vec3;

    const EIGHT: Sampling = Sampling { samples: 8, frame: 0 };

    fn lamp(of: usize, kind: LightKind, extent: Extent) -> PosedLight {
        let center = DVec3::new(1.0, 2.0, 3.0);
        PosedLight { kind, extent, of, center, position: center, intensity: Vec3::splat(16.0), ..PosedLight::default() }
    }

    fn expanded(lights: Vec<PosedLight>, sampling: Sampling, looked_at: usize, point: u32) -> Vec<PosedLight> {
        let mut pose = Pose { lights, ..Pose::default() };
        pose.expand_lights(sampling, looked_at, point);
        pose.lights
    }

    #[test]
    fn a_light_with_a_size_becomes_points_that_share_its_light() {
        let lamps = vec![
            lamp(0, LightKind::Point, Extent::Round(0.5)),
            lamp(1, LightKind::Point, Extent::Point),
            lamp(2, LightKind::Spot { inner: 0.1, outer: 0.5 }, Extent::Rectangle([2.0, 1.0])),
        ];
        let points = expanded(lamps, EIGHT, 0, 0);
        assert_eq!(points.len(), 17);
        let of: Vec<_> = points.iter().map(|point| point.of).collect();
        assert_eq!(of, [0, 1, 2, 0, 0, 0, 0, 0, 0, 0, 2, 2, 2, 2, 2, 2, 2]);
        for lamp in [0, 2] {
            let sum: Vec3 = points.iter().filter(|point| point.of == lamp).map(|point| point.intensity).sum();
            assert!(sum.abs_diff_eq(Vec3::splat(16.0), 1e-4), "{sum}");
        }
        assert_eq!(points[1].position, points[1].center, "a point stays what it is");
        for point in points.iter().filter(|point| point.of == 0) {
            assert!((point.position.distance(point.center) - 0.5).abs() < 1e-12, "on the globe");
        }
        for point in points.iter().filter(|point| point.of == 2) {
            let offset = point.position - point.center;
            assert!(offset.dot(point.direction).abs() < 1e-12, "in the light's plane");
            assert!(offset.x.abs() <= 1.0 && offset.y.abs() <= 0.5, "{offset}");
        }
    }

    #[test]
    fn points_are_spread_well_whatever_their_number() {
        // In each quarter of the square a quarter of the points, but for a few: six of 1024, where random
        // points would stray by fourteen.
        for count in [8, 16, 64, 256, 1024_u64] {
            for seed in 0..5 {
                let mut quarters = [0; 4];
                for index in 0..count {
                    let [u, v] = sequence(index, seed);
                    assert!((0.0..1.0).contains(&u) && (0.0..1.0).contains(&v));
                    quarters[usize::from(u > 0.5) * 2 + usize::from(v > 0.5)] += 1;
                }
                let few = u64::from(1 + count.ilog2() / 2);
                assert!(quarters.iter().all(|quarter| (count / 4).abs_diff(*quarter) <= few), "{count}: {quarters:?}");
            }
        }
        assert_ne!(sequence(0, 0), sequence(0, 1), "lights do not share their points");
    }

    #[test]
    fn the_point_that_is_looked_at_takes_the_lights_place() {
        let lamps = || vec![lamp(0, LightKind::Point, Extent::Round(1.0))];
        let first = expanded(lamps(), EIGHT, 0, 0);
        for point in 0..8 {
            let looked_at = expanded(lamps(), EIGHT, 0, point);
            assert_eq!(looked_at[0].position, first[point as usize].position);
            assert_eq!(looked_at.len(), 8);
        }
        let elsewhere = expanded(lamps(), EIGHT, 3, 5);
        assert_eq!(elsewhere[0].position, first[0].position);
    }

    #[test]
    fn frames_go_on_where_the_last_one_ended() {
        let lamps = || vec![lamp(0, LightKind::Spot { inner: 0.0, outer: 0.4 }, Extent::Round(1.0))];
        let all = expanded(lamps(), EIGHT, 0, 0);
        let by_frames: Vec<_> = (0..4)
            .flat_map(|frame| expanded(lamps(), Sampling { samples: 2, frame }, 0, 0))
            .map(|point| point.position)
            .collect();
        assert_eq!(by_frames, all.iter().map(|point| point.position).collect::<Vec<_>>());
        let alone = expanded(lamps(), Sampling { samples: 1, frame: 0 }, 0, 0);
        assert_eq!(alone[0].position, alone[0].center, "one point and no more is the middle");
        let later = expanded(lamps(), Sampling { samples: 1, frame: 5 }, 0, 0);
        assert_eq!(later[0].position, all[5].position);
    }
}
