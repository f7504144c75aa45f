//! Charts: quantities over time, or over each other.

use std::error;
use std::io;
use std::ops::Range;
use std::path::Path;

use plotters::data::float::FloatPrettyPrinter;
use plotters::prelude::*;

use super::{FONT, write_file};
use crate::error::Error;

/// Size of a chart (px).
const SIZE: [u32; 2] = [800, 440];
/// The plotting library knows whole pixels only: it draws on a finer grid by this factor.
const FINE: u32 = 8;
/// Colours that stay apart for colour-blind eyes and in grey (after Okabe and Ito).
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
];
const INK: RGBColor = RGBColor(34, 34, 34);
const GRID: RGBColor = RGBColor(222, 222, 222);

/// A line chart with named series.
///
/// ```
/// use pliant::output::Chart;
///
/// # let directory = tempfile::tempdir().unwrap();
/// # let path = directory.path().join("height.svg");
/// let fall = |t: f64| (t, 1.0 - 4.9 * t * t);
/// Chart::new("A stone falls")
///     .axes("time (s)", "height (m)")
///     .series("stone", (0..40).map(|k| fall(0.01 * k as f64)))
///     .write(&path)?;
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    title: String,
    axes: [String; 2],
    series: Vec<(String, Vec<(f64, f64)>)>,
}

impl Chart {
    /// A chart without series yet.
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), axes: Default::default(), series: Vec::new() }
    }

    /// What stands along the horizontal and the vertical axis: quantity and unit.
    pub fn axes(mut self, x: impl Into<String>, y: impl Into<String>) -> Self {
        self.axes = [x.into(), y.into()];
        self
    }

    /// Adds a line through `points`, in the order given.
    pub fn series(
        mut self,
        name: impl Into<String>,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        self.series.push((name.into(), points.into_iter().collect()));
        self
    }

    /// Draws the chart to an SVG file.
    ///
    /// # Errors
    /// [`Error::Input`] for a chart without points and for points that are not finite;
    /// [`Error::Output`] if the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let count: usize = self.series.iter().map(|(_, points)| points.len()).sum();
        if count == 0 {
            return Err(Error::input("number of points of a chart", 0, "add a series with points"));
        }
        for (name, points) in &self.series {
            if let Some(point) = points.iter().find(|(x, y)| !(x.is_finite() && y.is_finite())) {
                let (input, value) = (format!("point of series \"{name}\""), format!("{point:?}"));
                return Err(Error::input(input, value, "it must be a pair of finite numbers"));
            }
        }
        write_file(path.as_ref(), |file| {
            let svg = self.draw().map_err(|error| io::Error::other(error.to_string()))?;
            file.write_all(svg.as_bytes())
        })
    }

    fn draw(&self) -> Result<String, Box<dyn error::Error + '_>> {
        let size = SIZE.map(|pixels| FINE * pixels);
        let mut svg = String::new();
        {
            let page = SVGBackend::with_string(&mut svg, size.into()).into_drawing_area();
            page.fill(&WHITE)?;
            let title = font(17.0).style(FontStyle::Bold);
            page.draw_text(&self.title, &title.color(&INK), (fine(20), fine(14)))?;
            self.draw_legend(&page)?;
            self.draw_lines(&page)?;
            page.present()?;
        }
        let attributes =
            |[width, height]: [u32; 2]| format!(r#"width="{width}" height="{height}""#);
        Ok(svg.replacen(&attributes(size), &attributes(SIZE), 1))
    }

    /// The names of the series in one line under the title.
    fn draw_legend<B: DrawingBackend>(
        &self,
        page: &DrawingArea<B, plotters::coord::Shift>,
    ) -> Result<(), Box<dyn error::Error + '_>>
    where
        B::ErrorType: 'static,
    {
        let mut left = 20;
        for ((name, _), colour) in self.series.iter().zip(COLOURS.iter().cycle()) {
            let line = vec![(fine(left), fine(52)), (fine(left + 22), fine(52))];
            page.draw(&PathElement::new(line, colour.stroke_width(2 * FINE)))?;
            page.draw_text(name, &font(13.0).color(&INK), (fine(left + 29), fine(45)))?;
            left += 55 + (7.0 * name.chars().count() as f64) as i32;
        }
        Ok(())
    }

    fn draw_lines<B: DrawingBackend>(
        &self,
        page: &DrawingArea<B, plotters::coord::Shift>,
    ) -> Result<(), Box<dyn error::Error + '_>>
    where
        B::ErrorType: 'static,
    {
        let points = || self.series.iter().flat_map(|(_, points)| points);
        let x = range(points().map(|point| point.0), 0.0);
        let y = range(points().map(|point| point.1), 0.05);
        let (small, label) = (font(12.0).color(&INK), font(13.0).color(&INK));
        let number = |x: &f64| {
            let printer =
                FloatPrettyPrinter { allow_scientific: true, min_decimal: 0, max_decimal: 6 };
            printer.print(*x).replace('-', "\u{2212}")
        };
        let mut chart = ChartBuilder::on(page)
            .margin_top(fine(68))
            .margin_right(fine(24))
            .margin_bottom(fine(8))
            .margin_left(fine(8))
            .x_label_area_size(fine(44))
            .y_label_area_size(fine(66))
            .build_cartesian_2d(x, y)?;
        chart
            .configure_mesh()
            .x_labels(9)
            .y_labels(7)
            .max_light_lines(0)
            .bold_line_style(GRID.stroke_width(FINE))
            .axis_style(INK.stroke_width(FINE))
            .set_all_tick_mark_size(fine(4))
            .x_label_formatter(&number)
            .y_label_formatter(&number)
            .label_style(small)
            .axis_desc_style(label)
            .x_desc(&self.axes[0])
            .y_desc(&self.axes[1])
            .draw()?;
        for ((_, points), colour) in self.series.iter().zip(COLOURS.iter().cycle()) {
            let line = LineSeries::new(points.iter().copied(), colour.stroke_width(2 * FINE));
            chart.draw_series(line)?;
        }
        Ok(())
    }
}

fn fine(pixels: i32) -> i32 {
    pixels * FINE as i32
}

/// The font at a size in pixels, of which the plotting library writes 1/1.24 to SVG.
fn font(pixels: f64) -> FontDesc<'static> {
    FontDesc::new(FontFamily::Name(FONT), 1.24 * pixels * f64::from(FINE), FontStyle::Normal)
}

/// From the least to the largest of `values`, and a fraction of that more at both ends.
fn range(values: impl Iterator<Item = f64>, margin: f64) -> Range<f64> {
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    if low == high {
        let half = if low == 0.0 { 1.0 } else { 0.1 * low.abs() };
        return low - half..high + half;
    }
    let more = margin * (high - low);
    low - more..high + more
}
