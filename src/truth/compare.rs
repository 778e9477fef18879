//! Verdicts, and a picture held against them: the one comparison that command line, tests and panel share.

use image::{Rgba, RgbaImage};

/// What one pixel of `show shadow` must be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Undecided: rays through the pixel disagree.
    Edge,
    /// A surface that rays were not asked about ([`super::World::of_receivers`]).
    Unasked,
    /// No surface: grey.
    Nothing,
    /// A surface beyond the light's range: grey.
    OutOfRange,
    /// White.
    Lit,
    /// Black.
    Shadow,
}

impl Verdict {
    /// What `show shadow` must hold, in each colour; none where it may hold anything.
    #[must_use]
    pub const fn value(self) -> Option<u8> {
        match self {
            Self::Edge | Self::Unasked => None,
            Self::Nothing | Self::OutOfRange => Some(128),
            Self::Lit => Some(255),
            Self::Shadow => Some(0),
        }
    }
}

/// A verdict for each pixel of a picture.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Verdicts {
    size: [u32; 2],
    pixels: Vec<Verdict>,
}

/// How a decided pixel is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Wrong {
    /// Drawn lit; it is in shadow.
    Lit,
    /// Drawn in shadow; it is lit.
    Dark,
    /// Drawn as reached by the light's range and is not, or the other way round; or no verdict at all.
    Reach,
    /// Another surface is drawn, or one through other mirrors.
    Surface,
}

/// One of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct WrongPixel {
    /// Pixels from the left.
    pub x: u32,
    /// Pixels from the top.
    pub y: u32,
    /// How.
    pub how: Wrong,
}

/// A picture against verdicts.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Comparison {
    /// Pixels on which rays agree, lit or not, or without a surface.
    pub decided: usize,
    /// Of those, lit.
    pub lit: usize,
    /// Of those, in shadow.
    pub shadow: usize,
    /// Pixels on which they do not agree.
    pub edges: usize,
    /// Decided pixels that are drawn otherwise, row by row.
    pub pixels: Vec<WrongPixel>,
}

impl Comparison {
    /// How many decided pixels are drawn otherwise.
    #[must_use]
    pub fn wrong(&self) -> usize {
        self.pixels.len()
    }
}

impl Verdicts {
    pub(super) fn new(size: [u32; 2]) -> Self {
        Self { size, pixels: Vec::with_capacity(size[0] as usize * size[1] as usize) }
    }

    pub(super) fn push(&mut self, verdict: Verdict) {
        self.pixels.push(verdict);
    }

    /// Width and height, pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Row by row from the top.
    #[must_use]
    pub fn pixels(&self) -> &[Verdict] {
        &self.pixels
    }

    /// Holds a picture against the verdicts: `show shadow` of the same view, light and size. A
    /// picture of another size is all wrong.
    #[must_use]
    pub fn compare(&self, picture: &RgbaImage) -> Comparison {
        let mut comparison = Comparison::default();
        for (at, &verdict) in (0u32..).zip(&self.pixels) {
            let Some(value) = verdict.value() else {
                comparison.edges += usize::from(verdict == Verdict::Edge);
                continue;
            };
            comparison.decided += 1;
            comparison.lit += usize::from(verdict == Verdict::Lit);
            comparison.shadow += usize::from(verdict == Verdict::Shadow);
            let (x, y) = (at % self.size[0], at / self.size[0]);
            let drawn = picture.get_pixel_checked(x, y).filter(|_| picture.dimensions() == (self.size[0], self.size[1]));
            let drawn = drawn.map(|pixel| [pixel.0[0], pixel.0[1], pixel.0[2]]);
            if drawn != Some([value; 3]) {
                let how = match (drawn, verdict) {
                    (Some([255, 255, 255]), Verdict::Shadow) => Wrong::Lit,
                    (Some([0, 0, 0]), Verdict::Lit) => Wrong::Dark,
                    _ => Wrong::Reach,
                };
                comparison.pixels.push(WrongPixel { x, y, how });
            }
        }
        comparison
    }
}

/// Paints wrong pixels over a picture of the view, which is dimmed: edges of any of `verdicts` faintly,
/// wrong pixels in [`Wrong::color`] with a pale frame around each, so that one alone is found.
pub fn paint(picture: &mut RgbaImage, verdicts: &[Verdicts], wrong: &[WrongPixel]) {
    for pixel in picture.pixels_mut() {
        let [r, g, b, a] = pixel.0;
        pixel.0 = [r / 3, g / 3, b / 3, a];
    }
    let edge = |at: usize| verdicts.iter().any(|verdicts| verdicts.pixels.get(at) == Some(&Verdict::Edge));
    for (_, pixel) in picture.pixels_mut().enumerate().filter(|(at, _)| edge(*at)) {
        let [r, g, b, a] = pixel.0;
        pixel.0 = [r.saturating_add(28), g.saturating_add(28), b.saturating_add(34), a];
    }
    for (x, y) in wrong.iter().flat_map(|wrong| around(wrong.x, wrong.y)) {
        if let Some(pixel) = picture.get_pixel_mut_checked(x, y) {
            *pixel = Rgba([150, 150, 150, 255]);
        }
    }
    for wrong in wrong {
        if let Some(pixel) = picture.get_pixel_mut_checked(wrong.x, wrong.y) {
            let [r, g, b] = wrong.how.color();
            *pixel = Rgba([r, g, b, 255]);
        }
    }
}

impl Wrong {
    /// sRGB: red where it is drawn lit, blue where it is drawn dark, yellow where the light's reach
    /// is wrong, magenta where the surface is.
    #[must_use]
    pub const fn color(self) -> [u8; 3] {
        match self {
            Self::Lit => [255, 60, 40],
            Self::Dark => [60, 140, 255],
            Self::Reach => [255, 210, 40],
            Self::Surface => [255, 80, 255],
        }
    }
}

/// The eight pixels around one.
fn around(x: u32, y: u32) -> impl Iterator<Item = (u32, u32)> {
    let near = |at: u32| [at.wrapping_sub(1), at, at.wrapping_add(1)];
    near(y).into_iter().flat_map(move |y| near(x).map(|x| (x, y))).filter(move |at| *at != (x, y))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdicts() -> Verdicts {
        let pixels = vec![Verdict::Lit, Verdict::Shadow, Verdict::Edge, Verdict::Nothing, Verdict::OutOfRange, Verdict::Lit];
        Verdicts { size: [3, 2], pixels }
    }

    fn picture(values: [u8; 6]) -> RgbaImage {
        RgbaImage::from_fn(3, 2, |x, y| {
            let value = values[(y * 3 + x) as usize];
            Rgba([value, value, value, 255])
        })
    }

    #[test]
    fn what_is_right_is_right_and_edges_may_be_anything() {
        for edge in [0, 77, 128, 255] {
            let comparison = verdicts().compare(&picture([255, 0, edge, 128, 128, 255]));
            assert_eq!(comparison, Comparison { decided: 5, lit: 2, shadow: 1, edges: 1, pixels: Vec::new() });
        }
    }

    #[test]
    fn what_is_wrong_is_wrong_in_its_own_way() {
        let comparison = verdicts().compare(&picture([0, 255, 9, 255, 0, 128]));
        let how: Vec<_> = comparison.pixels.iter().map(|wrong| (wrong.x, wrong.y, wrong.how)).collect();
        let reach = Wrong::Reach;
        assert_eq!(how, [(0, 0, Wrong::Dark), (1, 0, Wrong::Lit), (0, 1, reach), (1, 1, reach), (2, 1, reach)]);
        assert_eq!(verdicts().compare(&picture([254, 0, 0, 128, 128, 255])).wrong(), 1, "white is white");
        assert_eq!(verdicts().compare(&RgbaImage::new(6, 1)).wrong(), 5, "another picture");
    }

    #[test]
    fn wrong_pixels_are_painted_over_their_neighbours_frames() {
        let comparison = verdicts().compare(&picture([0, 255, 9, 128, 128, 255]));
        let mut painted = picture([90; 6]);
        paint(&mut painted, &[verdicts()], &comparison.pixels);
        let color = |x, y| [0, 1, 2].map(|channel| painted.get_pixel(x, y).0[channel]);
        assert_eq!((color(0, 0), color(1, 0)), (Wrong::Dark.color(), Wrong::Lit.color()));
        assert_eq!(color(0, 1), [150; 3]);
        let mut calm = picture([90; 6]);
        paint(&mut calm, &[verdicts()], &[]);
        assert_eq!(calm.get_pixel(0, 0).0, [30, 30, 30, 255]);
        assert_eq!(calm.get_pixel(2, 0).0, [58, 58, 64, 255]);
    }
}
