//! A quantity as colours over the two keys that vary.

use super::variable::Variable;
use super::{FAILED, Plot};
use crate::io::output::{Axis, Mark, Panel, Series, shade};

impl Plot<'_> {
    pub(super) fn map(&self, keys: [&Variable; 2], quantity: &Variable) -> Panel {
        let distinct = keys.map(Variable::distinct);
        let [across, down] = [0, 1].map(|at| distinct[at].len());
        // cells without gaps, if most combinations are there
        let is_grid = 2 * self.rows.len() > across * down;
        let room = |count: usize| if is_grid { 0.5 / (count - 1).max(1) as f64 } else { 0.05 };
        let axes = [keys[0].axis(room(across)), keys[1].axis(room(down))];
        let edges = [0, 1].map(|at| edges(&distinct[at], &axes[at]));
        let scale = quantity.axis(0.0);
        let series = self.rows.iter().enumerate().map(|(at, row)| {
            let value = quantity.values[at];
            let place = scale.place(value);
            let colour = if value.is_finite() { shade(place) } else { FAILED.into() };
            let point = keys.map(|key| key.values[at]);
            let cell = |along: usize| {
                let place = distinct[along].partition_point(|known| *known < point[along]);
                [edges[along][place], edges[along][(place + 1).min(edges[along].len() - 1)]]
            };
            self.of_row(
                *row,
                match is_grid {
                    true => {
                        let ([left, right], [low, high]) = (cell(0), cell(1));
                        let corners = [(left, low), (right, low), (right, high), (left, high)];
                        Series::area(colour, 1.0, corners)
                    }
                    false => {
                        let mark = Mark { radius: 5.2, ..Mark::DOT };
                        Series::marks(colour, mark, [(point[0], point[1])])
                    }
                },
            )
        });
        let names = [0, 1].map(|at| axes[at].label(&keys[at].name));
        let series = series.collect();
        let label = scale.label(&quantity.name);
        Panel { axes, names, series, scale: Some((scale, label)), above: 22.0, ..Panel::default() }
    }
}

/// Bounds of the cells around ascending values, within an axis.
fn edges(values: &[f64], axis: &Axis) -> Vec<f64> {
    let middle = |a: f64, b: f64| axis.value(0.5 * (axis.place(a) + axis.place(b)));
    let middles = values.windows(2).map(|pair| middle(pair[0], pair[1]));
    let [low, high] = axis.ends();
    [low].into_iter().chain(middles).chain([high]).collect()
}
