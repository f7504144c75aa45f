//! Pictures of the rows of a study: quantities over one key, maps over two, parallel coordinates of more.

mod map;
mod over_one;
mod parallel;
mod scale;

use std::path::Path;

use svg::Document;
use svg::node::element::{Group, Title};

use self::scale::Variable;
use super::row::{Row, RowVerdict};
use super::run::Sweep;
use super::table::Results;
use crate::base::input::digits;
use crate::dynamics::error::Error;
use crate::io::output::{page, text, write_figure};

/// Size of a panel (px).
const PANEL: [f64; 2] = [480.0, 400.0];
/// Room in a panel on the left, above, on the right and below its field (px).
const ROOM: [f64; 4] = [76.0, 34.0, 84.0, 52.0];
/// Height of the title (px).
const HEAD: f64 = 56.0;
/// Panels side by side.
const ACROSS: usize = 2;
/// More rows are not drawn, so that a picture does not grow without bounds.
const MOST: usize = 20_000;
const GREY: &str = "#777777";
const PALE: &str = "#dedede";
/// Colour of runs that failed.
const FAILED: &str = "#b9bec4";

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
        write_figure(&self.figure(sweep, units, false), path.as_ref())
    }

    /// The same as a document, in which each mark has the number of its row (`data-row`), and tells its values if it
    /// `is_told`.
    pub(super) fn figure(&self, sweep: &Sweep, units: &[&str], is_told: bool) -> Document {
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
        plot.document(&sweep.file().title, &about)
    }
}

impl Plot<'_> {
    fn document(&self, title: &str, about: &str) -> Document {
        let panels: Vec<Group> = match self.keys.len() {
            1 => self.quantities.iter().map(|quantity| self.over_one(quantity)).collect(),
            2 => self.quantities.iter().map(|quantity| self.map(quantity)).collect(),
            _ => vec![self.parallel()],
        };
        let across = panels.len().clamp(1, ACROSS);
        let down = panels.len().div_ceil(across);
        let width = match self.keys.len() {
            1 | 2 => PANEL[0] * across as f64,
            _ => self.parallel_width(),
        };
        let size = [width, HEAD + PANEL[1] * down as f64];
        let head = Group::new()
            .add(text(title, [20.0, 26.0]).set("font-size", 16).set("font-weight", 600))
            .add(text(about, [20.0, 45.0]).set("fill", GREY));
        panels.into_iter().enumerate().fold(page(size).add(head), |document, (at, panel)| {
            let [x, y] = [PANEL[0] * (at % across) as f64, HEAD + PANEL[1] * (at / across) as f64];
            document.add(panel.set("transform", format!("translate({x} {y})")))
        })
    }

    /// Tooltip of a row, when the pointer is on its mark.
    fn told(&self, row: &Row) -> Title {
        let mut lines: Vec<String> =
            row.keys.iter().map(|(key, value)| format!("{key} = {value}")).collect();
        lines.extend(
            row.quantities
                .iter()
                .filter_map(|(name, value)| Some(format!("{name} = {}", digits((*value)?, 6)))),
        );
        lines.push(row.verdict.to_string());
        Title::new(lines.join("\n"))
    }

    /// The group of a row's mark.
    fn mark(&self, (number, row): (usize, &Row)) -> Group {
        let mark = Group::new().set("data-row", number);
        match self.is_told {
            true => mark.set("class", "mark").add(self.told(row)),
            false => mark,
        }
    }
}

/// Left, top, right and bottom of the field of a panel.
fn field() -> [f64; 4] {
    [ROOM[0], ROOM[1], PANEL[0] - ROOM[2], PANEL[1] - ROOM[3]]
}
