//! Many keys: parallel coordinates, an axis for each key and quantity, a line for each run.

use super::variable::Variable;
use super::{FAILED, Plot, SIZE};
use crate::io::output::{Axis, Figure, Note, Panel, Series, shade};

/// Distance of two axes, and margins at both ends for their names (px).
const APART: f64 = 150.0;
const ENDS: f64 = 60.0;
/// Room for the scale of colours (px).
const SCALE: f64 = 100.0;
/// Names stand above the axes, alternately on two lines (px).
const LINE: f64 = 18.0;
/// Longer names are cut.
const LETTERS: usize = 34;

impl Plot<'_> {
    pub(super) fn parallel(&self, title: &str) -> Figure {
        let variables: Vec<&Variable> = self.keys.iter().chain(&self.quantities).collect();
        let uprights: Vec<(f64, Axis)> = variables
            .iter()
            .enumerate()
            .map(|(at, variable)| (at as f64, variable.axis(0.0)))
            .collect();
        let last = uprights.len().max(2) as f64 - 1.0;
        let plain = |low, high| {
            let mut axis = Axis::linear([low, high].into_iter(), 0.0, 1, "");
            axis.ticks.clear();
            axis
        };
        let axes = [plain(-ENDS / APART, last), plain(0.0, 1.0)];
        let first = self.quantities.first();
        let scale = first.map(|quantity| quantity.axis(0.0));
        let series = self.rows.iter().enumerate().map(|(number, row)| {
            let place = match (first, &scale) {
                (Some(quantity), Some(scale)) => scale.place(quantity.values[number]),
                _ => f64::NAN,
            };
            let colour = if place.is_finite() { shade(place) } else { FAILED.into() };
            let points = variables.iter().zip(&uprights).map(|(variable, (at, axis))| {
                let place = axis.place(variable.values[number]);
                (*at, if place.is_finite() { place } else { -0.04 })
            });
            let line = Series::line(colour, points);
            self.of_row(*row, Series { width: 1.2, opacity: 0.75, ..line })
        });
        let note = |(number, (variable, (at, axis))): (usize, (&&Variable, &(f64, Axis)))| Note {
            text: short(&axis.label(&variable.name)),
            at: (*at, 1.0),
            shift: [0.0, -14.0 - LINE * (number % 2) as f64],
            anchor: "middle",
        };
        let notes = variables.iter().zip(&uprights).enumerate().map(note).collect();
        let (series, scale) = (series.collect(), scale.map(|scale| (scale, String::new())));
        let above = 14.0 + 2.0 * LINE;
        let panel = Panel { axes, series, notes, uprights, scale, above, ..Panel::default() };
        Figure::new(title, vec![panel], [APART * last + 2.0 * ENDS + SCALE, SIZE[1]])
    }
}

/// The end of a long name, which is more specific than its beginning.
fn short(name: &str) -> String {
    match name.chars().count().checked_sub(LETTERS) {
        Some(more) if more > 0 => {
            format!("\u{2026}{}", name.chars().skip(more + 1).collect::<String>())
        }
        _ => name.into(),
    }
}
