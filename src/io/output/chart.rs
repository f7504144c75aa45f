//! Charts: quantities over time, or over each other.

use std::error;
use std::io;
use std::ops::Range;
use std::path::Path;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::coord::types::RangedCoordf64;
use plotters::data::float::FloatPrettyPrinter;
use plotters::prelude::*;

use super::decades::{power_text, ticks};
use super::{FONT, write_file};
use crate::base::input::InputError;
use crate::dynamics::error::Error;

/// Size of a chart (px).
const SIZE: [u32; 2] = [800, 440];
/// The plotting library has whole pixels only: it draws on a finer grid by this factor.
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
const GREY: RGBColor = RGBColor(119, 119, 119);
const GRID: RGBColor = RGBColor(222, 222, 222);
/// Left and right end of the legend, and the distance of its lines (px).
const LEGEND: [i32; 3] = [20, 780, 20];
/// Approximate number of labels on an axis.
const LABELS: usize = 9;

/// A line chart with named series, on linear or logarithmic axes.
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
    logarithmic: [bool; 2],
    series: Vec<Series>,
}

#[derive(Debug, Clone, PartialEq)]
struct Series {
    name: String,
    style: Style,
    points: Vec<(f64, f64)>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Style {
    Line,
    /// A line with its points marked.
    Marked,
    /// A dashed grey line.
    Reference,
}

impl Chart {
    /// A chart without series yet.
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            axes: Default::default(),
            logarithmic: [false; 2],
            series: Vec::new(),
        }
    }

    /// What stands along the horizontal and the vertical axis: quantity and unit.
    pub fn axes(mut self, x: impl Into<String>, y: impl Into<String>) -> Self {
        self.axes = [x.into(), y.into()];
        self
    }

    /// Whether the horizontal and the vertical axis are logarithmic. Default: neither.
    pub fn logarithmic(mut self, x: bool, y: bool) -> Self {
        self.logarithmic = [x, y];
        self
    }

    /// Adds a line through `points`, in the order given.
    pub fn series(
        self,
        name: impl Into<String>,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        self.with(name.into(), Style::Line, points)
    }

    /// As [`series`](Self::series), with a dot at each point: for few points, each a measurement.
    pub fn marked(
        self,
        name: impl Into<String>,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        self.with(name.into(), Style::Marked, points)
    }

    /// As [`series`](Self::series), dashed and grey: what is expected, to compare with.
    pub fn reference(
        self,
        name: impl Into<String>,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        self.with(name.into(), Style::Reference, points)
    }

    fn with(
        mut self,
        name: String,
        style: Style,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        self.series.push(Series { name, style, points: points.into_iter().collect() });
        self
    }

    /// Draws the chart to an SVG file.
    ///
    /// # Errors
    /// [`Error::Input`] for a chart without points, for points that are not finite, and for points
    /// that are not positive along a logarithmic axis; [`Error::Output`] if the file cannot be
    /// written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let count: usize = self.series.iter().map(|series| series.points.len()).sum();
        if count == 0 {
            return Err(InputError::new(
                "number of points of a chart",
                0,
                "add a series with points",
            )
            .into());
        }
        let [log_x, log_y] = self.logarithmic;
        for Series { name, points, .. } in &self.series {
            let refuse = |point: &(f64, f64), help: &str| {
                let (input, value) = (format!("point of series \"{name}\""), format!("{point:?}"));
                Err(InputError::new(input, value, help).into())
            };
            if let Some(point) = points.iter().find(|(x, y)| !(x.is_finite() && y.is_finite())) {
                return refuse(point, "it must be a pair of finite numbers");
            }
            if let Some(point) =
                points.iter().find(|(x, y)| log_x && *x <= 0.0 || log_y && *y <= 0.0)
            {
                return refuse(point, "along a logarithmic axis it must be positive");
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

    /// Each series with its colour: references are grey.
    fn coloured(&self) -> impl Iterator<Item = (&Series, RGBColor)> {
        let mut colours = COLOURS.iter().cycle();
        self.series.iter().map(move |series| match series.style {
            Style::Reference => (series, GREY),
            Style::Line | Style::Marked => (series, *colours.next().unwrap_or(&INK)),
        })
    }

    /// Where the legend has each name, in as many lines as it takes, under the title.
    fn legend(&self) -> Vec<(i32, i32)> {
        let [start, end, line] = LEGEND;
        let (mut left, mut y) = (start, 52);
        let places = self.series.iter().map(|series| {
            let width = 55 + (7.0 * series.name.chars().count() as f64) as i32;
            if left > start && left + width > end {
                (left, y) = (start, y + line);
            }
            left += width;
            (left - width, y)
        });
        places.collect()
    }

    fn draw_legend<B: DrawingBackend>(
        &self,
        page: &DrawingArea<B, plotters::coord::Shift>,
    ) -> Result<(), Box<dyn error::Error + '_>>
    where
        B::ErrorType: 'static,
    {
        for ((series, colour), (left, y)) in self.coloured().zip(self.legend()) {
            let stroke = colour.stroke_width(2 * FINE);
            match series.style {
                Style::Reference => {
                    for part in [0, 8, 16] {
                        let ends = [left + part, left + part + 5].map(|x| (fine(x), fine(y)));
                        page.draw(&PathElement::new(ends, stroke))?;
                    }
                }
                Style::Line | Style::Marked => {
                    let ends = [(fine(left), fine(y)), (fine(left + 22), fine(y))];
                    page.draw(&PathElement::new(ends, stroke))?;
                }
            }
            if series.style == Style::Marked {
                page.draw(&Circle::new((fine(left + 11), fine(y)), fine(3), colour.filled()))?;
            }
            page.draw_text(&series.name, &font(13.0).color(&INK), (fine(left + 29), fine(y - 7)))?;
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
        let [log_x, log_y] = self.logarithmic;
        let points = || self.series.iter().flat_map(|series| &series.points);
        let x = Axis::new(points().map(|point| point.0), 0.0, log_x);
        let y = Axis::new(points().map(|point| point.1), 0.05, log_y);
        let (small, label) = (font(12.0).color(&INK), font(13.0).color(&INK));
        let number = |value: f64| {
            let printer =
                FloatPrettyPrinter { allow_scientific: true, min_decimal: 0, max_decimal: 6 };
            printer.print(value).replace('-', "\u{2212}")
        };
        let text = |value: f64, logarithmic| match logarithmic {
            // ticks of a logarithmic axis have one digit
            true => power_text(format!("{:.0e}", 10_f64.powf(value)).parse().unwrap_or(f64::NAN)),
            false => number(value),
        };
        let (x_text, y_text) = (|x: &f64| text(*x, log_x), |y: &f64| text(*y, log_y));
        let lowest_name = self.legend().iter().map(|place| place.1).max().unwrap_or(0);
        let mut chart = ChartBuilder::on(page)
            .margin_top(fine(lowest_name + 16))
            .margin_right(fine(24))
            .margin_bottom(fine(8))
            .margin_left(fine(8))
            .x_label_area_size(fine(44))
            .y_label_area_size(fine(66))
            .build_cartesian_2d(x, y)?;
        chart
            .configure_mesh()
            .max_light_lines(0)
            .bold_line_style(GRID.stroke_width(FINE))
            .axis_style(INK.stroke_width(FINE))
            .set_all_tick_mark_size(fine(4))
            .x_label_formatter(&x_text)
            .y_label_formatter(&y_text)
            .label_style(small)
            .axis_desc_style(label)
            .x_desc(&self.axes[0])
            .y_desc(&self.axes[1])
            .draw()?;
        let scaled = |value: f64, logarithmic| if logarithmic { value.log10() } else { value };
        for (series, colour) in self.coloured() {
            let points =
                || series.points.iter().map(|&(x, y)| (scaled(x, log_x), scaled(y, log_y)));
            let stroke = colour.stroke_width(2 * FINE);
            match series.style {
                Style::Reference => {
                    chart.draw_series(DashedLineSeries::new(points(), fine(6), fine(5), stroke))?;
                }
                Style::Line | Style::Marked => {
                    chart.draw_series(LineSeries::new(points(), stroke))?;
                }
            }
            if series.style == Style::Marked {
                chart.draw_series(points().map(|at| Circle::new(at, fine(3), colour.filled())))?;
            }
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

/// An axis with the places of its lines; along a logarithmic one places are decades.
struct Axis {
    range: RangedCoordf64,
    lines: Vec<f64>,
}

impl Axis {
    /// From the least to the largest of `values`, and a fraction of that more at both ends.
    fn new(values: impl Iterator<Item = f64>, margin: f64, logarithmic: bool) -> Self {
        let values = values.map(|value| if logarithmic { value.log10() } else { value });
        let range = range(values, if logarithmic { 0.05 } else { margin });
        let lines = match logarithmic {
            true => decades(&range),
            false => RangedCoordf64::from(range.clone()).key_points(LABELS),
        };
        Self { range: range.into(), lines }
    }
}

impl Ranged for Axis {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        self.range.map(value, limit)
    }

    fn key_points<Hint: KeyPointHint>(&self, _hint: Hint) -> Vec<f64> {
        self.lines.clone()
    }

    fn range(&self) -> Range<f64> {
        self.range.range()
    }
}

/// Places of the labelled lines of a logarithmic axis: of many decades every second, third, ... one.
fn decades(range: &Range<f64>) -> Vec<f64> {
    let labelled = ticks([range.start, range.end]).into_iter().filter(|tick| tick.1);
    let places: Vec<f64> = labelled.map(|tick| tick.0.log10()).collect();
    let stride = places.len().div_ceil(LABELS).max(1) as i64;
    let is_kept = |place: &f64| {
        let decade = place.round();
        stride == 1 || (place - decade).abs() < 1e-9 && decade as i64 % stride == 0
    };
    places.into_iter().filter(is_kept).collect()
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
