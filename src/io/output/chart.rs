//! Charts: quantities over time, or over each other.

use std::path::Path;

use svg::Document;
use svg::node::element::Group;

use super::COLOURS;
use super::figure::{
    Axis, Field, Line, SWATCH, dots, legend_places, page, power_text, text, write_figure,
};
use crate::base::input::InputError;
use crate::dynamics::error::Error;

/// Size of a chart (px).
const SIZE: [f64; 2] = [800.0, 440.0];
/// Room on the left, for labels and name of the vertical axis, on the right, and below (px).
const ROOM: [f64; 3] = [84.0, 24.0, 52.0];
/// Left and right end of the legend, and where its first line stands, below the title (px).
const LEGEND: [f64; 3] = [20.0, 780.0, 52.0];
/// Radius of a dot (px).
const RADIUS: f64 = 3.0;
/// Approximate number of lines across the field.
const LINES: usize = 9;
const GREY: &str = "#777777";
/// Dashes of one line of reference after the other, which short ones in the legend tell apart, too.
const DASHES: [&str; 3] = ["6 5", "2 3", "10 3 2 3"];
const GRID: &str = "#dedede";

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
    /// A dashed grey line; each has dashes of its own.
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

    /// Labels of the horizontal and the vertical axis: quantity and unit.
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

    /// Draws the chart to an SVG file, or, with the feature `png`, a PNG file.
    ///
    /// # Errors
    /// [`Error::Input`] for a chart without points, for points that are not finite, for points that are not positive
    /// along a logarithmic axis, and another ending of `path`; [`Error::Output`] if the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        if self.points().next().is_none() {
            let help = "add a series with points";
            return Err(InputError::new("number of points of a chart", 0, help).into());
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
        write_figure(&self.draw(), path.as_ref())
    }

    fn points(&self) -> impl Iterator<Item = &(f64, f64)> {
        self.series.iter().flat_map(|series| &series.points)
    }

    fn draw(&self) -> Document {
        let [left, right, first] = LEGEND;
        let names = self.series.iter().map(|series| &series.name[..]);
        let places = legend_places(names, [left, right], first);
        let field = self.field(places.iter().map(|place| place[1]).fold(first, f64::max) + 16.0);
        // a power of ten that the labels leave out
        let name = |name: &String, axis: &Axis| match &axis.unit[..] {
            "" => name.clone(),
            power => format!("{name} / {power}"),
        };
        let title = text(&self.title, [left, 28.0]).set("font-size", 17).set("font-weight", "bold");
        let mut chart = page(SIZE).add(title).add(field.grid()).add(field.outline());
        chart = chart
            .add(field.floor(&name(&self.axes[0], &field.x)).set("font-size", 13))
            .add(field.side(&name(&self.axes[1], &field.y), 62.0).set("font-size", 13));
        let mut colours = COLOURS[..6].iter().cycle();
        let mut dashed = DASHES.iter().cycle();
        for (series, [x, y]) in self.series.iter().zip(places) {
            let colour = match series.style {
                Style::Reference => GREY,
                Style::Line | Style::Marked => colours.next().unwrap_or(&GREY),
            };
            let dashes = match series.style {
                Style::Reference => dashed.next().unwrap_or(&"none"),
                Style::Line | Style::Marked => "none",
            };
            let mut marks = Vec::new();
            if series.style == Style::Marked {
                marks = series.points.iter().map(|(x, y)| field.place(*x, *y)).collect();
                marks.push([x + 0.5 * SWATCH - 4.0, y]);
            }
            let line = field.line(series.points.iter().copied());
            chart = chart
                .add(line.draw(colour, 2.0, RADIUS, dashes))
                .add(Line::swatch([x, y]).draw(colour, 2.0, RADIUS, dashes))
                .add(dots(Group::new(), marks, RADIUS, colour))
                .add(text(&series.name, [x + SWATCH, y + 4.0]).set("font-size", 13));
        }
        chart
    }

    /// The field below `top` (px).
    fn field(&self, top: f64) -> Field {
        let [log_x, log_y] = self.logarithmic;
        let axis =
            |values: &mut dyn Iterator<Item = f64>, margin, is_logarithmic| match is_logarithmic {
                true => Axis::logarithmic(values, LINES, power_text),
                false => Axis::linear(values, margin, LINES, ""),
            };
        let x = axis(&mut self.points().map(|point| point.0), 0.0, log_x);
        let y = axis(&mut self.points().map(|point| point.1), 0.05, log_y);
        let [left, right, below] = ROOM;
        let edges = [left, top, SIZE[0] - right, SIZE[1] - below];
        Field { edges, x, y, colours: [super::INK, GRID, "#f3f3f3"] }
    }
}
