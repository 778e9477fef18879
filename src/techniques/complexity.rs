//! Depth complexity (K section 7, figure 20): the stencil counts how often each pixel is updated, and the counts are
//! shown in false colour.
//!
//! K increments the stencil wherever a fragment updates its pixel, so what is counted depends on the order in which
//! surfaces are drawn: far to near every layer counts, near to far only the first. The other count has no such order:
//! every fragment increments, also where depth hides it.
//!
//! The counts become colours as they did when no shader could read a stencil: one quad over the picture for each band of
//! counts, the lowest first, drawn where the stencil holds at least the band's least count.
//!
//! Increment is clamped, so that a pixel never comes round to 0: 255 stands for that many or more, and is said to be so.

use std::fmt;

use serde::Serialize;

use super::surfaces::{SurfaceGroup, Tint, tinted_again};
use crate::frame::state::{Blend, Depth, State};
use crate::frame::stencil::{BitBudget, StencilState};
use crate::frame::{Action, Draw, DrawSet, Label, LabelKind, Look, Program, Step, Stroke, Target};
use crate::settings::Complexity;

/// Counts that share a colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// The first count that has the colour; the next band's ends it.
    pub least: u8,
    /// As the picture stores it (sRGB, 0 to 1).
    pub color: [f32; 3],
}

const fn band(least: u8, color: [f32; 3]) -> Band {
    Band { least, color }
}

/// Every band, from the lowest: single counts up to 8, ever more of them beyond. From cold to hot, and past what should
/// ever be drawn to white.
pub const BANDS: [Band; 16] = [
    band(1, [0.16, 0.19, 0.47]),
    band(2, [0.16, 0.35, 0.74]),
    band(3, [0.13, 0.54, 0.83]),
    band(4, [0.10, 0.67, 0.68]),
    band(5, [0.22, 0.73, 0.42]),
    band(6, [0.56, 0.79, 0.25]),
    band(7, [0.87, 0.83, 0.20]),
    band(8, [0.98, 0.68, 0.15]),
    band(9, [0.96, 0.50, 0.16]),
    band(12, [0.91, 0.32, 0.20]),
    band(16, [0.79, 0.17, 0.28]),
    band(24, [0.72, 0.15, 0.50]),
    band(32, [0.66, 0.26, 0.73]),
    band(64, [0.73, 0.51, 0.89]),
    band(128, [0.87, 0.79, 0.95]),
    band(MOST, [1.0, 1.0, 1.0]),
];

/// What eight bits hold at most; it stands for all above, too.
pub const MOST: u8 = u8::MAX;

/// Counts the fragments of all surfaces, and lays depth as they are drawn: `groups` are opaque, `blended` the steps that
/// draw blended ones.
#[must_use]
pub fn count(groups: &[SurfaceGroup], blended: Vec<Step>, what: Complexity, budget: BitBudget, scissor: [u32; 4]) -> Vec<Step> {
    let stencil = StencilState::count_fragments(budget, what == Complexity::Fragments);
    let why = match what {
        Complexity::Updates => "One more wherever a fragment updates its pixel, up to 255; depth is laid as ever.",
        Complexity::Fragments => "One more wherever a fragment falls, hidden or not, up to 255; depth is laid as ever.",
    };
    let opaque = groups.iter().map(|group| {
        let draw = group.depth_draw(Depth::LAY, stencil, scissor);
        Step::drawing(format!("count{}", group.words()), why, draw)
    });
    let blended = blended.into_iter().map(|mut step| {
        step.label = step.label.replacen("blended", "count, blended", 1);
        step.why = why.into();
        if let Action::Draw(draw) = &mut step.action {
            draw.program = Program::Depth;
            draw.look = Look::default();
            (draw.state.stencil, draw.state.color) = (stencil, None);
        }
        step
    });
    opaque.chain(blended).collect()
}

/// Each band's colour where the stencil holds at least its least count, and then every surface's slope over it.
#[must_use]
pub fn colors(groups: &[SurfaceGroup], budget: BitBudget, scissor: [u32; 4]) -> Vec<Step> {
    let of_band = |band: &Band| {
        let [r, g, b] = band.color;
        let draw = Draw {
            state: State { stencil: StencilState::count_at_least(budget), color: Some(Blend::Replace), ..State::FLAT },
            stencil_reference: band.least,
            constant: [r, g, b, 1.0],
            ..Draw::plain(Program::Dark, DrawSet::FullScreen, scissor)
        };
        let why = "The band's colour wherever as many fragments were counted, or more; the next band covers those.";
        Step::drawing(format!("colour of {} and more", band.least), why, draw)
    };
    let why = "Every surface's slope over its colour, so that shapes can be told.";
    let tint = Tint { label: "slope", why, color: [1.15, 1.15, 1.15, 1.0], inside: false };
    BANDS.iter().map(of_band).chain(tinted_again(groups, &tint, scissor)).collect()
}

/// Rows of at least so many pixels can be read.
const LEAST_ROW: f32 = 11.0;

/// A swatch and its counts for each band, at the left; nothing where the picture is too small for it.
#[must_use]
pub fn legend(what: Complexity, [width, height]: [u32; 2], scissor: [u32; 4]) -> Vec<Step> {
    #[expect(clippy::cast_precision_loss, reason = "pixels")]
    let [width, height] = [width, height].map(|side| side as f32);
    let row = (height / 38.0).clamp(LEAST_ROW, 28.0).round();
    #[expect(clippy::cast_precision_loss, reason = "a dozen bands")]
    let rows = BANDS.len() as f32 + 1.0;
    let (pad, swatch, text) = ((row * 0.5).round(), row * 1.6, (row * 0.72).round());
    let plate = [(text * 9.4).max(swatch + text * 6.0) + pad * 2.0, row * rows + pad * 2.0];
    if plate[0] > width * 0.4 || plate[1] + pad * 2.0 > height {
        return Vec::new();
    }
    let [left, top] = [pad, height - plate[1] - pad];
    let rectangle = |x: f32, y: f32, width: f32, height: f32, fill: [f32; 4]| Stroke {
        points: vec![[x, y], [x + width, y], [x + width, y + height], [x, y + height]],
        closed: true,
        width: 0.0,
        color: fill,
        fill: Some(fill),
    };
    let line = |y: f32, text: String, size: f32| {
        let plate = [left + pad + swatch + 0.4 * row, y, plate[0] - pad * 2.0 - swatch - 0.4 * row, row];
        Label { text, kind: LabelKind::Legend, anchor: [plate[0], y], plate, text_size: size }
    };
    let mut strokes = vec![rectangle(left, top, plate[0], plate[1], [0.02, 0.022, 0.03, 0.86])];
    let heading = match what {
        Complexity::Updates => "updates of a pixel",
        Complexity::Fragments => "fragments a pixel",
    };
    let title = [left + pad, top + pad * 0.6, plate[0] - pad * 2.0, row];
    let mut labels = vec![Label {
        text: heading.into(),
        kind: LabelKind::Legend,
        anchor: [title[0], title[1]],
        plate: title,
        text_size: (text * 0.9).max(8.0).round(),
    }];
    for (index, band) in BANDS.iter().enumerate().rev() {
        #[expect(clippy::cast_precision_loss, reason = "a dozen bands")]
        let y = top + pad + row * (BANDS.len() - index) as f32;
        let [r, g, b] = band.color;
        strokes.push(rectangle(left + pad, y + row * 0.12, swatch, row * 0.76, [r, g, b, 1.0]));
        let words = match BANDS.get(index + 1).map(|next| next.least - 1) {
            None => format!("{}+", band.least),
            Some(last) if last == band.least => last.to_string(),
            Some(last) => format!("{}-{last}", band.least),
        };
        labels.push(line(y, words, text));
    }
    let over = |program, set| Draw {
        target: Target::Output,
        state: State { color: Some(Blend::Over), ..State::FLAT },
        ..Draw::plain(program, set, scissor)
    };
    vec![
        Step::drawing("legend", "A swatch for each band of counts.", over(Program::Lines, DrawSet::Strokes(strokes))),
        Step::drawing("legend's words", "Which counts each colour stands for.", over(Program::Labels, DrawSet::Labels(labels))),
    ]
}

/// Depth complexity in numbers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Tally {
    /// What was counted.
    pub counted: Complexity,
    /// Over all pixels of the picture.
    pub average: f64,
    /// Over the pixels where anything was counted.
    pub average_where_drawn: f64,
    /// Pixels where anything was counted, of all: 0 to 1.
    pub drawn: f64,
    /// The largest count; 255 stands for that many and more.
    pub maximum: u8,
    /// The first pixel that has it, from the upper left.
    pub at: [u32; 2],
    /// Pixels that reached 255, whose true counts are unknown: the averages are then too low.
    pub saturated: usize,
}

impl Tally {
    /// Of the stencil that [`count`] leaves, one byte a pixel, rows of `width` from the top.
    #[must_use]
    pub fn of(stencil: &[u8], width: u32, counted: Complexity) -> Self {
        let sum: u64 = stencil.iter().map(|&count| u64::from(count)).sum();
        let drawn = stencil.iter().filter(|count| **count > 0).count();
        let maximum = stencil.iter().copied().max().unwrap_or(0);
        let at = stencil.iter().position(|count| *count == maximum).unwrap_or(0);
        let at = u32::try_from(at).unwrap_or(0);
        let saturated = stencil.iter().filter(|count| **count == MOST).count();
        #[expect(clippy::cast_precision_loss, reason = "pixels of a picture, and counts in them")]
        let share = |of: u64, all: usize| of as f64 / all.max(1) as f64;
        Self {
            counted,
            average: share(sum, stencil.len()),
            average_where_drawn: share(sum, drawn),
            drawn: share(drawn as u64, stencil.len()),
            maximum,
            at: [at % width.max(1), at / width.max(1)],
            saturated,
        }
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y] = self.at;
        let Self { average, average_where_drawn, maximum, saturated, .. } = self;
        writeln!(
            f,
            "{} a pixel: {average:.3} on average, {average_where_drawn:.3} where anything is drawn, {maximum} at most (pixel {x},{y})",
            self.counted.name()
        )?;
        if *saturated > 0 {
            writeln!(
                f,
                "{saturated} pixels reached {MOST}, the most that eight bits hold: there it may be more, and the averages are too low"
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_count_has_one_band() {
        assert_eq!(BANDS[0].least, 1);
        assert!(BANDS.windows(2).all(|pair| pair[0].least < pair[1].least));
        assert_eq!(BANDS.last().map(|band| band.least), Some(MOST));
    }

    #[test]
    fn a_tally_counts_and_says_where_it_cannot() {
        let tally = Tally::of(&[0, 1, 3, 2, 0, 0], 3, Complexity::Updates);
        assert_eq!((tally.maximum, tally.at, tally.saturated), (3, [2, 0], 0));
        assert_eq!((tally.average, tally.average_where_drawn, tally.drawn), (1.0, 2.0, 0.5));
        assert!(!tally.to_string().contains("255"));
        let full = Tally::of(&[0, 255, 255, 4], 2, Complexity::Fragments);
        assert_eq!((full.maximum, full.at, full.saturated), (255, [1, 0], 2));
        assert!(full.to_string().contains("2 pixels reached 255"), "{full}");
        assert_eq!(Tally::of(&[], 0, Complexity::Updates).average, 0.0);
    }

    #[test]
    fn a_small_picture_has_no_legend() {
        assert!(legend(Complexity::Updates, [240, 135], [0, 0, 240, 135]).is_empty());
        let steps = legend(Complexity::Updates, [640, 360], [0, 0, 640, 360]);
        assert_eq!(steps.len(), 2);
    }
}
