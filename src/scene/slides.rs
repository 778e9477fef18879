//! What spots project: textures of the scene, or one of a few slides that are drawn here.
//!
//! A slide stands square to the light's direction, upright, and just fits into the outer cone: its corners
//! touch it. Beyond its edge there is no light.

use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

use super::{Texture, Wrap};

/// What a spot projects.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Slide {
    /// A texture of the scene.
    Texture(usize),
    /// One that is drawn here.
    BuiltIn(BuiltInSlide),
}

/// Slides that need no file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BuiltInSlide {
    /// Panes between glazing bars.
    Window,
    /// A rose of coloured glass in lead.
    StainedGlass,
    /// Bars crossing at a slant.
    Grille,
}

/// Texels a side of every slide, as it is projected.
pub const SIDE: u32 = 512;

impl BuiltInSlide {
    /// All of them, in the order people see them.
    pub const ALL: [Self; 3] = [Self::Window, Self::StainedGlass, Self::Grille];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Window => "window",
            Self::StainedGlass => "stained-glass",
            Self::Grille => "grille",
        }
    }

    /// The slide, [`SIDE`] texels a side; drawn when first asked for.
    #[must_use]
    pub fn texture(self) -> &'static Texture {
        static DRAWN: [OnceLock<Texture>; 3] = [const { OnceLock::new() }; 3];
        DRAWN[self as usize].get_or_init(|| Texture {
            name: self.name().into(),
            width: SIDE,
            height: SIDE,
            rgba: draw(match self {
                Self::Window => window,
                Self::StainedGlass => stained_glass,
                Self::Grille => grille,
            }),
            wrap: [Wrap::Clamp; 2],
            nearest: false,
        })
    }
}

/// sRGB of what `at` says of points in -1..1 by -1..1, up positive; four points a texel.
fn draw(at: fn(f32, f32) -> [f32; 3]) -> Vec<u8> {
    #[expect(clippy::cast_precision_loss, reason = "a few hundred texels")]
    let place = |texel: u32, quarter: f32| (texel as f32 + quarter) * 2.0 / SIDE as f32 - 1.0;
    let texel = |index: u32| {
        let (x, y) = (index % SIDE, index / SIDE);
        let mut sum = [0.0; 3];
        for (dx, dy) in [(0.25, 0.25), (0.75, 0.25), (0.25, 0.75), (0.75, 0.75)] {
            let color = at(place(x, dx), -place(y, dy));
            (0..3).for_each(|channel| sum[channel] += color[channel] * 0.25 * 255.0);
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
        let [r, g, b] = sum.map(|value| value.round() as u8);
        [r, g, b, 255]
    };
    (0..SIDE * SIDE).flat_map(texel).collect()
}

const DARK: [f32; 3] = [0.0; 3];

/// Two by three panes, the bars between them, a frame around.
fn window(x: f32, y: f32) -> [f32; 3] {
    let (across, along) = ((x / 0.86 + 1.0) * 1.0, (y / 0.94 + 1.0) * 1.5);
    let in_pane = |at: f32, panes: f32, bar: f32| (0.0..panes).contains(&at) && (bar..1.0 - bar).contains(&at.fract());
    if in_pane(across, 2.0, 0.045) && in_pane(along, 3.0, 0.055) { [1.0, 0.99, 0.96] } else { DARK }
}

/// A rose window: a round eye, petals about it in two rings, lead between.
fn stained_glass(x: f32, y: f32) -> [f32; 3] {
    const GLASS: [[f32; 3]; 6] =
        [[0.93, 0.20, 0.16], [0.16, 0.34, 0.93], [0.98, 0.76, 0.18], [0.15, 0.68, 0.36], [0.58, 0.24, 0.82], [0.14, 0.72, 0.86]];
    const LEAD: f32 = 0.016;
    let radius = x.hypot(y);
    // Twelfths of a turn, from the top.
    let twelfths = (x.atan2(y) / std::f32::consts::TAU + 1.0).fract() * 12.0;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 12")]
    let pane = |turned: f32| ((twelfths + turned).floor() as usize) % 12;
    // Slide halves from the nearest spoke, which stands at every whole number.
    let from_spoke = |turned: f32| {
        let at = (twelfths + turned).fract();
        at.min(1.0 - at) * std::f32::consts::TAU / 12.0 * radius
    };
    let ring = |inner: f32, outer: f32| (inner + LEAD..outer - LEAD).contains(&radius);
    if radius < 0.2 - LEAD {
        return GLASS[2];
    }
    if ring(0.2, 0.5) && from_spoke(0.5) > LEAD {
        return GLASS[[0, 1][pane(0.5) % 2]];
    }
    if ring(0.5, 0.8) && from_spoke(0.0) > LEAD {
        return GLASS[[3, 4, 5, 2][pane(0.0) % 4]];
    }
    // Roundels, one before each outer petal.
    let along = (twelfths.fract() - 0.5) * std::f32::consts::TAU / 12.0;
    let (middle, size) = (0.885, 0.085);
    let from_middle = (radius * along.sin()).hypot(radius * along.cos() - middle);
    if from_middle < size - LEAD * 0.5 { GLASS[pane(0.0) % 6] } else { DARK }
}

/// Two families of bars at a slant, light between, a plate around.
fn grille(x: f32, y: f32) -> [f32; 3] {
    let bar = |at: f32| ((at * 5.0).rem_euclid(1.0) - 0.5).abs() < 0.11;
    let open = x.abs() < 0.94 && y.abs() < 0.94 && !bar((x + y) * 0.5) && !bar((x - y) * 0.5);
    if open { [1.0; 3] } else { DARK }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_slide_has_light_and_darkness_and_a_dark_edge() {
        for slide in BuiltInSlide::ALL {
            let texture = slide.texture();
            assert_eq!(texture.rgba.len() as u32, SIDE * SIDE * 4);
            let lit = texture.rgba.chunks_exact(4).filter(|texel| texel[..3].iter().any(|value| *value > 128)).count();
            let share = lit as f64 / f64::from(SIDE * SIDE);
            assert!((0.3..0.9).contains(&share), "{}: {share}", slide.name());
            let row = SIDE as usize * 4;
            let edge = texture.rgba[..row].iter().chain(&texture.rgba[row * (SIDE as usize - 1)..]);
            assert!(edge.enumerate().all(|(at, value)| at % 4 == 3 || *value == 0), "{}", slide.name());
        }
        let colors: std::collections::BTreeSet<_> = BuiltInSlide::StainedGlass
            .texture()
            .rgba
            .chunks_exact(4)
            .map(|texel| [texel[0] >> 5, texel[1] >> 5, texel[2] >> 5])
            .collect();
        assert!(colors.len() > 6, "glass of many colours");
    }
}
