//! Charts: quantities over time, or over each other.

use std::path::Path;

use super::COLOURS;
use super::figure::{Axis, Figure, Mark, Panel, Series, Theme, power_text};
use crate::base::input::InputError;
use crate::dynamics::error::Error;

/// Width of a chart, and height of its field (px).
const SIZE: [f64; 2] = [800.0, 320.0];
/// Approximate number of lines across the field.
const LINES: usize = 9;
/// Dashes of one line of reference after the other, which short ones in the legend tell apart, too.
const DASHES: [&str; 3] = ["6 5", "2 3", "10 3 2 3"];

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
        let colour = self.next_colour();
        self.with(name, Series::line(colour, points))
    }

    /// As [`series`](Self::series), with a dot at each point: for few points, each a measurement.
    pub fn marked(
        self,
        name: impl Into<String>,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        let colour = self.next_colour();
        self.with(name, Series { mark: Some(Mark::DOT), ..Series::line(colour, points) })
    }

    /// As [`series`](Self::series), dashed and grey: expected values, for comparison.
    pub fn reference(
        self,
        name: impl Into<String>,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        let before =
            self.series.iter().filter(|series| series.colour == Theme::PRINT.muted).count();
        let dashes = DASHES[before % DASHES.len()];
        self.with(name, Series { dashes, ..Series::line(Theme::PRINT.muted, points) })
    }

    fn with(mut self, name: impl Into<String>, series: Series) -> Self {
        self.series.push(Series { name: name.into(), width: 2.0, ..series });
        self
    }

    fn next_colour(&self) -> &'static str {
        let before =
            self.series.iter().filter(|series| series.colour != Theme::PRINT.muted).count();
        COLOURS[before % 6]
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
        let axis =
            |values: &mut dyn Iterator<Item = f64>, margin, is_logarithmic| match is_logarithmic {
                true => Axis::logarithmic(values, LINES, power_text),
                false => Axis::linear(values, margin, LINES, ""),
            };
        let axes = [
            axis(&mut self.points().map(|point| point.0), 0.0, log_x),
            axis(&mut self.points().map(|point| point.1), 0.05, log_y),
        ];
        let names = [0, 1].map(|at| axes[at].label(&self.axes[at]));
        let panel = Panel { axes, names, series: self.series.clone(), ..Panel::default() };
        Figure::new(&self.title, vec![panel], SIZE).write(path.as_ref())
    }

    fn points(&self) -> impl Iterator<Item = &(f64, f64)> {
        self.series.iter().flat_map(|series| &series.points)
    }
}
