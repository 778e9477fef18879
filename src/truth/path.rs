//! The mirrors on a ray's way, and what every pixel shows after them.

use std::collections::HashMap;

use image::RgbaImage;
use serde::Serialize;

use crate::settings::MAX_BOUNCES;

/// The mirrors that reflected a ray, the first one first.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Path {
    mirrors: [u32; MAX_BOUNCES as usize],
    length: u8,
}

impl Path {
    /// The same as numbers.
    pub fn mirrors(&self) -> &[u32] {
        &self.mirrors[..usize::from(self.length)]
    }

    /// One more. A path holds [`MAX_BOUNCES`] at most, and so many rays are reflected at most.
    pub fn push(&mut self, mirror: u32) {
        if let Some(place) = self.mirrors.get_mut(usize::from(self.length)) {
            *place = mirror;
            self.length += 1;
        }
    }
}

/// What one pixel shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Sighting {
    /// Which of [`Surfaces::paths`] leads there.
    pub path: usize,
    /// The scene's instance; none for the background.
    pub instance: Option<usize>,
}

/// The surface that each pixel of a picture shows, and the mirrors on the way.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Surfaces {
    size: [u32; 2],
    paths: Vec<Vec<usize>>,
    pixels: Vec<Option<Sighting>>,
}

/// A pixel that shows another surface than it should, or shows it through other mirrors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct WrongSurface {
    /// Pixels from the left.
    pub x: u32,
    /// Pixels from the top.
    pub y: u32,
    /// Which of [`Surfaces::paths`] should lead there.
    pub path: usize,
    /// What it should show; none for the background.
    pub instance: Option<usize>,
    /// What it is drawn as.
    pub drawn: Option<[u8; 3]>,
}

/// A picture of surfaces against what rays say.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SurfaceComparison {
    /// Pixels on which rays agree.
    pub decided: usize,
    /// Of those, how many were reflected so often: the first entry is for never.
    pub bounces: Vec<usize>,
    /// Pixels on which they do not agree.
    pub edges: usize,
    /// Decided pixels that are drawn otherwise, row by row.
    pub pixels: Vec<WrongSurface>,
}

impl Surfaces {
    /// From what each pixel shows, row by row: the mirrors on the way and the instance.
    pub(super) fn new(size: [u32; 2], pixels: impl Iterator<Item = Option<(Path, u32)>>) -> Self {
        let mut numbers: HashMap<Path, usize> = HashMap::from([(Path::default(), 0)]);
        let mut paths = vec![Vec::new()];
        let pixels = pixels
            .map(|shown| {
                let (path, instance) = shown?;
                let number = *numbers.entry(path).or_insert_with(|| {
                    paths.push(path.mirrors().iter().map(|mirror| *mirror as usize).collect());
                    paths.len() - 1
                });
                let instance = (instance != super::world::NONE).then_some(instance as usize);
                Some(Sighting { path: number, instance })
            })
            .collect();
        Self { size, paths, pixels }
    }

    /// The paths that pixels have: mirrors by their numbers, in the order that rays meet them. The first is
    /// the eye's own, without any.
    #[must_use]
    pub fn paths(&self) -> &[Vec<usize>] {
        &self.paths
    }

    /// Row by row from the top; none for edges.
    #[must_use]
    pub fn pixels(&self) -> &[Option<Sighting>] {
        &self.pixels
    }

    /// Holds a picture against what rays say. `color` is what a surface is drawn in, the path that leads there
    /// and the instance; none where there is no such colour, and then the pixel is wrong. A picture of
    /// another size is all wrong.
    #[must_use]
    pub fn compare(&self, picture: &RgbaImage, color: impl Fn(&[usize], Option<usize>) -> Option<[u8; 3]>) -> SurfaceComparison {
        let mut comparison = SurfaceComparison::default();
        let mut colors: HashMap<Sighting, Option<[u8; 3]>> = HashMap::new();
        for (at, &shown) in (0u32..).zip(&self.pixels) {
            let Some(sighting) = shown else {
                comparison.edges += 1;
                continue;
            };
            let path = &self.paths[sighting.path];
            comparison.decided += 1;
            if comparison.bounces.len() <= path.len() {
                comparison.bounces.resize(path.len() + 1, 0);
            }
            comparison.bounces[path.len()] += 1;
            let (x, y) = (at % self.size[0], at / self.size[0]);
            let drawn = picture.get_pixel_checked(x, y).filter(|_| picture.dimensions() == (self.size[0], self.size[1]));
            let drawn = drawn.map(|pixel| [pixel.0[0], pixel.0[1], pixel.0[2]]);
            let expected = *colors.entry(sighting).or_insert_with(|| color(path, sighting.instance));
            if expected.is_none() || drawn != expected {
                comparison.pixels.push(WrongSurface { x, y, path: sighting.path, instance: sighting.instance, drawn });
            }
        }
        comparison
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    fn path(mirrors: &[u32]) -> Path {
        let mut path = Path::default();
        mirrors.iter().for_each(|mirror| path.push(*mirror));
        path
    }

    /// Two pixels through mirror 3, one through 3 and 1, the background, an edge, the eye's own.
    fn surfaces() -> Surfaces {
        let pixels = [Some((path(&[3]), 4)), Some((path(&[3]), 5)), Some((path(&[3, 1]), 4)), Some((path(&[3]), u32::MAX)), None];
        Surfaces::new([3, 2], pixels.into_iter().chain([Some((path(&[]), 4))]))
    }

    #[expect(clippy::unnecessary_wraps, clippy::cast_possible_truncation, reason = "as `compare` takes it; small numbers")]
    fn color(path: &[usize], instance: Option<usize>) -> Option<[u8; 3]> {
        Some([path.len() as u8, path.iter().sum::<usize>() as u8, instance.map_or(0, |instance| instance as u8)])
    }

    #[test]
    fn paths_are_told_apart_and_kept_once() {
        let surfaces = surfaces();
        assert_eq!(surfaces.paths(), [vec![], vec![3], vec![3, 1]]);
        assert_eq!(surfaces.pixels()[2], Some(Sighting { path: 2, instance: Some(4) }));
        assert_eq!(surfaces.pixels()[3], Some(Sighting { path: 1, instance: None }));
        assert_ne!(path(&[0]), path(&[]), "the mirror with the number 0 is a mirror");
    }

    #[test]
    fn every_pixel_but_edges_must_be_drawn_in_its_colour() {
        let drawn = [[1, 3, 4], [1, 3, 5], [2, 4, 4], [1, 3, 0], [9, 9, 9], [0, 0, 4]];
        let mut picture = RgbaImage::from_fn(3, 2, |x, y| {
            let [r, g, b] = drawn[(y * 3 + x) as usize];
            Rgba([r, g, b, 255])
        });
        let right = SurfaceComparison { decided: 5, bounces: vec![1, 3, 1], edges: 1, pixels: Vec::new() };
        assert_eq!(surfaces().compare(&picture, color), right);
        picture.put_pixel(2, 0, Rgba([1, 3, 4, 255]));
        let wrong = WrongSurface { x: 2, y: 0, path: 2, instance: Some(4), drawn: Some([1, 3, 4]) };
        assert_eq!(surfaces().compare(&picture, color).pixels, [wrong]);
        assert_eq!(surfaces().compare(&picture, |_, _| None).pixels.len(), 5, "nothing has a colour");
        assert_eq!(surfaces().compare(&RgbaImage::new(6, 1), color).pixels.len(), 5, "another picture");
    }
}
