//! Plots of measurements: both axes logarithmic, so that what grows in proportion is a straight line at 45 degrees
//! where the axes are divided alike, and a bend is where something else begins to rule.

use std::ops::Range;

use image::{Rgba, RgbaImage};
use plotters::coord::Shift;
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::prelude::{
    BitMapBackend, ChartBuilder, Color as _, DashedLineSeries, DrawingArea, DrawingAreaErrorKind, FontStyle,
    IntoDrawingArea as _, IntoFont as _, LineSeries, PathElement, RGBColor, ShapeStyle, TextStyle, WHITE,
};
use plotters::style::register_font;

use super::HeadlessError;

/// Pixels of every plot.
pub const SIZE: [u32; 2] = [960, 540];

/// One curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// What it is called in the legend; without a name it is not there.
    pub name: String,
    /// sRGB.
    pub color: [u8; 3],
    /// Drawn in dashes, and thin.
    pub dashed: bool,
    /// Both above zero, x ascending; others are left out.
    pub points: Vec<[f64; 2]>,
}

/// A plot.
#[derive(Debug, Clone, PartialEq)]
pub struct Plot {
    /// Above it.
    pub title: String,
    /// Under the x axis.
    pub x: String,
    /// Beside the y axis.
    pub y: String,
    /// Later ones over earlier ones.
    pub curves: Vec<Curve>,
}

const FONT: &str = "sans-serif";
const INK: RGBColor = RGBColor(0x2b, 0x2f, 0x36);
const GRID: RGBColor = RGBColor(0xdd, 0xdf, 0xe3);

impl Plot {
    /// The picture of it.
    ///
    /// # Errors
    /// Nothing to plot, or what the plotting library says.
    pub fn draw(&self) -> Result<RgbaImage, HeadlessError> {
        let [width, height] = SIZE;
        let mut pixels = vec![0; (width * height * 3) as usize];
        // The panel's own font: a machine without a display may have none.
        register_font(FONT, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT)
            .map_err(|_| failed("its font cannot be read"))?;
        let area = BitMapBackend::with_buffer(&mut pixels, (width, height)).into_drawing_area();
        self.draw_on(&area).map_err(failed)?;
        area.present().map_err(failed)?;
        drop(area);
        Ok(RgbaImage::from_fn(width, height, |x, y| {
            let at = ((y * width + x) * 3) as usize;
            Rgba([pixels[at], pixels[at + 1], pixels[at + 2], 255])
        }))
    }

    fn draw_on(&self, area: &DrawingArea<BitMapBackend<'_>, Shift>) -> Result<(), DrawingAreaErrorKind<BitmapError>> {
        area.fill(&WHITE)?;
        let style = |size: f64| (FONT, size).into_font().color(&INK);
        let points = || self.curves.iter().flat_map(|curve| curve.points.iter().filter(|point| point.iter().all(|v| *v > 0.0)));
        let mut xs: Vec<f64> = points().map(|point| point[0]).collect();
        xs.sort_by(f64::total_cmp);
        xs.dedup();
        let x = Axis::over(xs.iter().copied(), 1.06, xs.clone());
        let ys: Vec<f64> = points().map(|point| point[1]).collect();
        let y = Axis::over(ys.iter().copied(), 1.3, (-20..=30).map(|power| 2f64.powi(power)).collect());
        area.draw_text(&self.title, &style(23.0), (TEXT_FROM, 12))?;
        self.draw_legend(area, &style(18.0))?;
        let mut chart = ChartBuilder::on(area)
            .margin(14)
            .margin_top(76)
            .margin_right(28)
            .x_label_area_size(48)
            .y_label_area_size(66)
            .build_cartesian_2d(x, y)?;
        chart
            .configure_mesh()
            .axis_style(INK)
            .bold_line_style(GRID)
            .light_line_style(WHITE)
            .x_desc(self.x.as_str())
            .y_desc(self.y.as_str())
            .x_label_formatter(&short)
            .y_label_formatter(&short)
            .x_labels(16)
            .y_labels(12)
            .label_style(style(16.0))
            .axis_desc_style(style(18.0))
            .draw()?;
        for curve in &self.curves {
            let points = curve.points.iter().filter(|point| point.iter().all(|v| *v > 0.0)).map(|point| (point[0], point[1]));
            if curve.dashed {
                chart.draw_series(DashedLineSeries::new(points, 5, 4, curve.style()))?;
            } else {
                chart.draw_series(LineSeries::new(points, curve.style()).point_size(4))?;
            }
        }
        Ok(())
    }

    /// The curves' names in a row between title and chart, where no curve can be.
    fn draw_legend(
        &self,
        area: &DrawingArea<BitMapBackend<'_>, Shift>,
        style: &TextStyle<'_>,
    ) -> Result<(), DrawingAreaErrorKind<BitmapError>> {
        let (mut x, y) = (TEXT_FROM, 54);
        for curve in self.curves.iter().filter(|curve| !curve.name.is_empty()) {
            area.draw(&PathElement::new([(x, y), (x + 26, y)], curve.style()))?;
            let (width, height) = area.estimate_text_size(&curve.name, style)?;
            area.draw_text(&curve.name, style, (x + 33, y - i32::try_from(height).unwrap_or(0) / 2))?;
            x += 33 + i32::try_from(width).unwrap_or(0) + 26;
        }
        Ok(())
    }
}

impl Curve {
    fn style(&self) -> ShapeStyle {
        let [red, green, blue] = self.color;
        RGBColor(red, green, blue).stroke_width(if self.dashed { 1 } else { 3 }).filled()
    }
}

/// Pixels from the left: where the chart begins.
const TEXT_FROM: i32 = 80;

type BitmapError = <BitMapBackend<'static> as plotters::prelude::DrawingBackend>::ErrorType;

fn failed(why: impl ToString) -> HeadlessError {
    HeadlessError::Plot(why.to_string())
}

/// A logarithmic axis with marks at given places.
struct Axis {
    range: Range<f64>,
    marks: Vec<f64>,
}

impl Axis {
    /// Over all of these, and by this factor more at either end.
    fn over(values: impl Iterator<Item = f64>, more: f64, marks: Vec<f64>) -> Self {
        let (least, most) = values.fold((f64::INFINITY, 0.0), |(least, most): (f64, f64), v| (least.min(v), most.max(v)));
        let range = if least <= most { least / more..most * more } else { 1.0..2.0 };
        let marks = marks.into_iter().filter(|mark| range.contains(mark)).collect();
        Self { range, marks }
    }
}

impl Ranged for Axis {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let share = (value / self.range.start).ln() / (self.range.end / self.range.start).ln();
        #[expect(clippy::cast_possible_truncation, reason = "pixels")]
        let along = (f64::from(limit.1 - limit.0) * share).round() as i32;
        limit.0 + along
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        let every = self.marks.len().div_ceil(hint.max_num_points().max(1)).max(1);
        self.marks.iter().copied().step_by(every).collect()
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

/// A number in few letters: 0.25, 64, 58 k, 3.7 M.
fn short(value: &f64) -> String {
    match *value {
        value if value >= 999_500.0 => format!("{:.1} M", value / 1e6),
        value if value >= 10_000.0 => format!("{:.0} k", value / 1e3),
        value if value >= 1.0 => format!("{value:.0}"),
        value => format!("{value}"),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    fn plot(points: Vec<[f64; 2]>) -> Plot {
        let curve = |color, dashed| {
            let points = points.iter().map(|[x, y]| [*x, if dashed { y / 4.0 } else { *y }]).collect();
            Curve { name: "a".into(), color, dashed, points }
        };
        let curves = vec![curve([200, 0, 0], false), curve([0, 0, 200], true)];
        Plot { title: "title".into(), x: "x".into(), y: "y".into(), curves }
    }

    #[test]
    fn a_plot_shows_its_curves_and_has_words() {
        let picture = plot(vec![[1.0, 2.0], [2.0, 5.0], [4.0, 30.0]]).draw().unwrap();
        assert_eq!(picture.dimensions(), (SIZE[0], SIZE[1]));
        let count = |color: [u8; 3]| picture.pixels().filter(|pixel| pixel.0[..3] == color).count();
        assert!(count([200, 0, 0]) > 500 && count([0, 0, 200]) > 100, "both curves");
        // The title's letters, above the chart.
        assert!((10..40).any(|y| (80..300).any(|x| picture.get_pixel(x, y).0[0] < 0x80)));
        // What grows in proportion climbs all the way.
        let rows = |x: u32| (76..480).rfind(|&y| picture.get_pixel(x, y).0[..3] == [200, 0, 0]);
        assert!(rows(140) > rows(500) && rows(500) > rows(880));
    }

    #[test]
    fn nothing_to_plot_is_an_empty_plot_and_no_panic() {
        for points in [vec![], vec![[1.0, 0.0]], vec![[3.0, 3.0]], vec![[-1.0, 4.0], [f64::NAN, 1.0]]] {
            plot(points).draw().unwrap();
        }
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            [0.25, 1.0, 64.0, 1024.0, 57_600.0, 524_288.0, 3_686_400.0].map(|v| short(&v)),
            ["0.25", "1", "64", "1024", "58 k", "524 k", "3.7 M"]
        );
    }
}
