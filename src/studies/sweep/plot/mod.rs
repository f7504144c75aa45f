//! Pictures of the rows of a study: quantities over one key, maps over two, parallel coordinates of more.

mod map;
mod parallel;
mod variable;

use std::path::Path;

use self::variable::Variable;
use super::row::{Row, RowVerdict};
use super::run::Sweep;
use super::table::Results;
use crate::base::input::digits;
use crate::dynamics::error::Error;
use crate::io::output::{COLOURS, Figure, Mark, Panel, Series};

/// Width of a panel, and height of its field (px).
const SIZE: [f64; 2] = [480.0, 314.0];
/// More rows are not drawn, so that a picture does not grow without bounds.
const MOST: usize = 20_000;
/// Colour of runs that failed.
const FAILED: &str = "#b9bec4";
/// A bar that stands on the floor.
const BAR: &str = "m-3 0 v-10 h6 v10 z";

/// Data of a picture of a study.
struct Plot<'a> {
    rows: Vec<(usize, &'a Row)>,
    /// Keys that vary.
    keys: Vec<Variable>,
    quantities: Vec<Variable>,
    /// Whether marks tell their values.
    is_told: bool,
}

impl Results {
    /// Draws the quantities over the keys that vary, to an SVG or PNG file: over one key, as a map over two, with
    /// parallel coordinates of more. `units` are those of the quantities.
    ///
    /// # Errors
    /// As of charts: another ending of `path`; [`Error::Output`].
    pub fn write_plot(
        &self,
        sweep: &Sweep,
        units: &[&str],
        path: impl AsRef<Path>,
    ) -> Result<(), Error> {
        self.figure(sweep, units, false).write(path.as_ref())
    }

    /// The same as data, in which each mark has the number of its row (`data-row`), and tells its values if it
    /// `is_told`.
    pub(super) fn figure(&self, sweep: &Sweep, units: &[&str], is_told: bool) -> Figure {
        let stride = self.rows.len().div_ceil(MOST).max(1);
        let rows: Vec<(usize, &Row)> = self.rows.iter().enumerate().step_by(stride).collect();
        let keys = sweep.plan().keys().iter().filter_map(|key| Variable::key(sweep, key, &rows));
        let units = units.iter().copied().chain(std::iter::repeat(""));
        let quantities = sweep.quantities().zip(units);
        let quantities = quantities.map(|(name, unit)| Variable::quantity(name, unit, &rows));
        let plot = Plot { keys: keys.collect(), quantities: quantities.collect(), rows, is_told };
        let failed = plot.rows.iter().filter(|(_, row)| row.verdict == RowVerdict::Failed).count();
        let what = if sweep.file().is_static { "equilibria" } else { "runs" };
        let mut about = format!("{} {what}", self.rows.len());
        if stride > 1 {
            about += &format!(", {} of them drawn", plot.rows.len());
        }
        about += match failed {
            0 => "",
            _ => "; grey: failed",
        };
        if let ([_, _, _, ..], Some(first)) = (&plot.keys[..], plot.quantities.first()) {
            about += &format!("; colour: {}", first.name);
        }
        Figure { about, columns: 2, ..plot.figure(&sweep.file().title) }
    }
}

impl Plot<'_> {
    fn figure(&self, title: &str) -> Figure {
        let panels = match &self.keys[..] {
            [key] => self.quantities.iter().map(|quantity| self.over(key, quantity)).collect(),
            [x, y] => self.quantities.iter().map(|quantity| self.map([x, y], quantity)).collect(),
            _ => return self.parallel(title),
        };
        Figure::new(title, panels, SIZE)
    }

    /// A quantity over the one key that varies.
    fn over(&self, key: &Variable, quantity: &Variable) -> Panel {
        let axes = [key.axis(0.04), quantity.axis(0.06)];
        let points = key.values.iter().copied().zip(quantity.values.iter().copied());
        let mut sorted: Vec<(f64, f64)> = points.clone().collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut series = Vec::new();
        if key.words.is_empty() {
            series.push(Series { width: 1.4, ..Series::line(COLOURS[0], sorted) });
        }
        let floor = axes[1].ends()[0];
        series.extend(self.rows.iter().zip(points).map(|(row, (x, y))| {
            self.of_row(
                *row,
                match y.is_finite() {
                    true => Series::marks(COLOURS[0], Mark { radius: 3.6, ..Mark::DOT }, [(x, y)]),
                    false => Series::marks(FAILED, Mark { shape: BAR, ..Mark::DOT }, [(x, floor)]),
                },
            )
        }));
        let names = [axes[0].label(&key.name), axes[1].label(&quantity.name)];
        Panel { axes, names, series, ..Panel::default() }
    }

    /// The series of a row, with the row's number and values.
    fn of_row(&self, (number, row): (usize, &Row), series: Series) -> Series {
        let keys = row.keys.iter().map(|(key, value)| format!("{key} = {value}"));
        let quantity = |(name, value): (&String, &Option<f64>)| {
            Some(format!("{name} = {}", digits((*value)?, 6)))
        };
        let quantities = row.quantities.iter().filter_map(quantity);
        let told = keys.chain(quantities).chain([row.verdict.to_string()]);
        let tip = self.is_told.then(|| told.collect::<Vec<_>>().join("\n"));
        Series { row: Some(number), tip, ..series }
    }
}
