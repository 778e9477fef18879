//! Where an alpha-masked surface is: as far as can be known.
//!
//! A device filters the texture by footprints and weights of its own choice. So the answer has three
//! values: what every texel that any filter could take says, and else [`Mask::Unsure`]. Where the
//! texture is magnified beyond doubt, the four texels and their weights are known, and only alpha
//! close to the cutoff is left open.

use glam::DVec2;

use crate::scene::{Material, Scene, Texture, Wrap};

/// What a masked triangle is at one point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mask {
    Surface,
    Hole,
    /// Filtering or rounding may decide.
    Unsure,
}

/// What a device's filter may be wrong by, of 1: weights of a few bits.
const FILTERING: f64 = 0.02;

/// What single precision may be wrong by, of 1.
const ROUNDING: f64 = 1e-5;

/// Masked triangles and the alpha of their textures.
#[derive(Debug, Default)]
pub struct Masks {
    faces: Vec<MaskedFace>,
    /// As the scene numbers them; none for textures that mask nothing.
    textures: Vec<Option<Alpha>>,
}

#[derive(Debug)]
struct MaskedFace {
    texture: Option<usize>,
    cutoff: f64,
    /// At the corners, without the texture's.
    alpha: [f64; 3],
    uvs: [DVec2; 3],
}

impl Masks {
    /// None yet.
    pub fn new(scene: &Scene) -> Self {
        Self { faces: Vec::new(), textures: scene.textures.iter().map(|_| None).collect() }
    }

    /// Takes a triangle up, its corners' texture coordinates and vertex colours' alpha; gives its number.
    pub fn add(&mut self, scene: &Scene, material: &Material, cutoff: f32, corners: [(DVec2, u8); 3]) -> u32 {
        if let Some(texture) = material.base_color_texture {
            self.textures[texture].get_or_insert_with(|| Alpha::new(&scene.textures[texture]));
        }
        self.faces.push(MaskedFace {
            texture: material.base_color_texture,
            cutoff: f64::from(cutoff),
            alpha: corners.map(|(_, alpha)| f64::from(material.base_color.w) * f64::from(alpha) / 255.0),
            uvs: corners.map(|(uv, _)| uv),
        });
        u32::try_from(self.faces.len() - 1).unwrap_or(u32::MAX)
    }

    /// The triangle at `weights` of its second and third corner; `beside` are the weights one pixel
    /// to the right and one pixel down.
    pub fn at(&self, face: u32, weights: DVec2, beside: [DVec2; 2]) -> Mask {
        let face = &self.faces[face as usize];
        let blend = |weights: DVec2| 1.0 - weights.x - weights.y;
        let factor = face.alpha[0] * blend(weights) + face.alpha[1] * weights.x + face.alpha[2] * weights.y;
        let uv = |weights: DVec2| face.uvs[0] * blend(weights) + face.uvs[1] * weights.x + face.uvs[2] * weights.y;
        let Some(texture) = face.texture.and_then(|texture| self.textures[texture].as_ref()) else {
            return decide([factor; 2], ROUNDING, face.cutoff);
        };
        let here = uv(weights) * texture.size();
        let longest = beside.map(|weights| (uv(weights) * texture.size() - here).length()).into_iter().fold(0.0, f64::max);
        let (alpha, unsure) = if longest < 0.7 && !texture.nearest {
            ([texture.filtered(here); 2], FILTERING)
        } else if longest < 0.7 {
            (texture.range(here, 0.02), ROUNDING)
        } else {
            // Of the mip level that is taken, or the next, texels one and a half away may count.
            (texture.range(here, 4.0 * longest.max(1.0)), FILTERING)
        };
        decide(alpha.map(|alpha| alpha * factor), unsure, face.cutoff)
    }
}

fn decide([least, most]: [f64; 2], unsure: f64, cutoff: f64) -> Mask {
    if least >= cutoff + unsure {
        Mask::Surface
    } else if most < cutoff - unsure {
        Mask::Hole
    } else {
        Mask::Unsure
    }
}

/// A texture's alpha, and the least and the most of it in squares of doubling size.
#[derive(Debug)]
struct Alpha {
    wrap: [Wrap; 2],
    nearest: bool,
    levels: Vec<Level>,
}

#[derive(Debug)]
struct Level {
    width: usize,
    height: usize,
    /// Least and most.
    cells: Vec<[u8; 2]>,
}

impl Alpha {
    fn new(texture: &Texture) -> Self {
        let (width, height) = (texture.width as usize, texture.height as usize);
        let cells = texture.rgba.as_chunks::<4>().0.iter().map(|texel| [texel[3]; 2]).collect();
        let mut levels = vec![Level { width, height, cells }];
        while let Some(coarser) = levels.last().filter(|level| level.width > 1 || level.height > 1).map(Level::halved) {
            levels.push(coarser);
        }
        Self { wrap: texture.wrap, nearest: texture.nearest, levels }
    }

    fn size(&self) -> DVec2 {
        DVec2::new(self.levels[0].width as f64, self.levels[0].height as f64)
    }

    /// Bilinear, at a place in texels.
    fn filtered(&self, at: DVec2) -> f64 {
        let low = (at - 0.5).floor();
        let part = at - 0.5 - low;
        let texel = |x: f64, y: f64| {
            let place = low + DVec2::new(x, y) + 0.5;
            let [x, y] = self.ranges(place, 0.0).map(|[first, _]| first);
            f64::from(self.levels[0].cells[y * self.levels[0].width + x][0]) / 255.0
        };
        let row = |y: f64| texel(0.0, y) * (1.0 - part.x) + texel(1.0, y) * part.x;
        row(0.0) * (1.0 - part.y) + row(1.0) * part.y
    }

    /// The least and the most among all texels that are at most `around` texels from a place.
    fn range(&self, at: DVec2, around: f64) -> [f64; 2] {
        let level = (around.max(1.0).log2().ceil() as usize).min(self.levels.len() - 1);
        let [columns, rows] = self.ranges(at, around).map(|[first, last]| first >> level..=last >> level);
        let cells = &self.levels[level];
        let mut found = [u8::MAX, u8::MIN];
        for row in rows {
            for cell in &cells.cells[row * cells.width..][columns.clone()] {
                found = [found[0].min(cell[0]), found[1].max(cell[1])];
            }
        }
        found.map(|alpha| f64::from(alpha) / 255.0)
    }

    /// The first and the last column, and row, within `around` of a place: wrapped, and perhaps more
    /// than need be.
    fn ranges(&self, at: DVec2, around: f64) -> [[usize; 2]; 2] {
        [(at.x, self.levels[0].width, self.wrap[0]), (at.y, self.levels[0].height, self.wrap[1])].map(|(at, size, wrap)| {
            let side = size as f64;
            let (low, high) = (at - around, at + around);
            let [low, high] = match wrap {
                _ if !low.is_finite() || !high.is_finite() => [0.0, side],
                Wrap::Clamp => [low, high],
                // Across a border: all of it.
                _ if (low / side).floor() != (high / side).floor() => [0.0, side],
                Wrap::Mirror if (low / side).floor().rem_euclid(2.0) == 1.0 => {
                    [side - high.rem_euclid(side), side - low.rem_euclid(side)]
                }
                Wrap::Repeat | Wrap::Mirror => [low.rem_euclid(side), high.rem_euclid(side)],
            };
            [low, high].map(|place| (place.max(0.0) as usize).min(size - 1))
        })
    }
}

impl Level {
    /// Half as large, rounded up.
    fn halved(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mut cells = vec![[u8::MAX, u8::MIN]; width * height];
        for (at, cell) in self.cells.iter().enumerate() {
            let held = &mut cells[at / self.width / 2 * width + at % self.width / 2];
            *held = [held[0].min(cell[0]), held[1].max(cell[1])];
        }
        Self { width, height, cells }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{AlphaMode, Scene};
    use glam::Vec4;

    /// Left half opaque, right half clear; 64 by 32 texels.
    fn halves(wrap: Wrap, nearest: bool) -> Masks {
        let rgba = (0..64 * 32).flat_map(|at| [9, 9, 9, if at % 64 < 32 { 255 } else { 0 }]).collect();
        let texture = Texture { name: "halves".into(), width: 64, height: 32, rgba, wrap: [wrap; 2], nearest };
        let scene = Scene { textures: vec![texture], ..Scene::default() };
        let material = Material { base_color_texture: Some(0), alpha: AlphaMode::Mask(0.5), ..Material::default() };
        let mut masks = Masks::new(&scene);
        let corners = [(DVec2::ZERO, 255), (DVec2::X, 255), (DVec2::Y, 255)];
        masks.add(&scene, &material, 0.5, corners);
        let faint = Material { base_color: Vec4::new(1.0, 1.0, 1.0, 0.4), base_color_texture: None, ..material };
        masks.add(&scene, &faint, 0.5, corners);
        masks
    }

    /// The weights are the texture coordinates here; a pixel is `step` wide.
    fn at(masks: &Masks, u: f64, step: f64) -> Mask {
        let here = DVec2::new(u, 0.3);
        masks.at(0, here, [here + DVec2::X * step, here + DVec2::Y * step])
    }

    #[test]
    fn magnified_texels_decide_up_to_the_cutoff_itself() {
        let masks = halves(Wrap::Repeat, false);
        assert_eq!(at(&masks, 0.49, 0.001), Mask::Surface);
        assert_eq!(at(&masks, 0.51, 0.001), Mask::Hole);
        assert_eq!(at(&masks, 0.5, 0.001), Mask::Unsure);
        let blocky = halves(Wrap::Repeat, true);
        assert_eq!(at(&blocky, 0.499, 0.001), Mask::Surface);
        assert_eq!(at(&blocky, 0.501, 0.001), Mask::Hole);
        assert_eq!(at(&blocky, 0.5, 0.001), Mask::Unsure);
    }

    #[test]
    fn minified_texels_decide_far_from_the_border_only() {
        let masks = halves(Wrap::Repeat, false);
        assert_eq!(at(&masks, 0.25, 0.02), Mask::Surface);
        assert_eq!(at(&masks, 0.75, 0.02), Mask::Hole);
        assert_eq!(at(&masks, 0.45, 0.02), Mask::Unsure);
        assert_eq!(at(&masks, 0.25, 0.5), Mask::Unsure, "the whole texture is a few pixels");
    }

    #[test]
    fn outside_the_texture_it_goes_on_as_it_is_told() {
        let answers = |wrap| [-0.25, 1.25, 1.75, -1.75].map(|u| at(&halves(wrap, false), u, 0.001));
        use Mask::{Hole, Surface};
        assert_eq!(answers(Wrap::Repeat), [Hole, Surface, Hole, Surface]);
        assert_eq!(answers(Wrap::Mirror), [Surface, Hole, Surface, Surface]);
        assert_eq!(answers(Wrap::Clamp), [Surface, Hole, Hole, Surface]);
    }

    #[test]
    fn the_material_alone_may_say_it() {
        let masks = halves(Wrap::Repeat, false);
        assert_eq!(masks.at(1, DVec2::splat(0.2), [DVec2::ZERO; 2]), Mask::Hole);
    }
}
