//! A quantity as colours over the two keys that vary.

use svg::node::element::Group;

use super::scale::{Variable, colour};
use super::{FAILED, GREY, PALE, Plot, field};
use crate::io::output::{Axis, Field, dots, rectangle, text};

/// Left and right edge of the scale of colours, from the right edge of the field (px), and its parts.
const SCALE: [f64; 2] = [14.0, 28.0];
const PARTS: usize = 60;

impl Plot<'_> {
    pub(super) fn map(&self, quantity: &Variable) -> Group {
        let [Some(x_key), Some(y_key)] = [0, 1].map(|at| self.keys.get(at)) else {
            return Group::new();
        };
        let distinct = [x_key, y_key].map(Variable::distinct);
        let [across, down] = [0, 1].map(|at| distinct[at].len());
        // cells without gaps, if most combinations are there
        let is_grid = 2 * self.rows.len() > across * down;
        let room = |count: usize| if is_grid { 0.5 / (count - 1).max(1) as f64 } else { 0.05 };
        let field = Field {
            edges: field(),
            x: x_key.axis(room(across)),
            y: y_key.axis(room(down)),
            colours: [GREY, PALE, PALE],
        };
        let scale = quantity.axis(0.0);
        let shown = |value: f64| match value.is_finite() {
            true => colour(scale.place(value)),
            false => FAILED.into(),
        };
        let mut panel = Group::new();
        if !is_grid {
            panel = panel.add(field.grid());
        }
        let edges = [
            edges(&distinct[0], |x| field.place(x, 0.0)[0], [field.edges[0], field.edges[2]]),
            edges(&distinct[1], |y| field.place(0.0, y)[1], [field.edges[3], field.edges[1]]),
        ];
        for (at, row) in self.rows.iter().enumerate() {
            let (x, y) = (x_key.values[at], y_key.values[at]);
            let colour = shown(quantity.values[at]);
            let mark = self.mark(*row);
            panel = panel.add(match is_grid {
                true => {
                    let cell = |at: usize, value: f64| {
                        let place = distinct[at].partition_point(|known| *known < value);
                        [edges[at][place], edges[at][(place + 1).min(edges[at].len() - 1)]]
                    };
                    let ([left, right], [bottom, top]) = (cell(0, x), cell(1, y));
                    mark.add(
                        rectangle([left, top], [right, bottom])
                            .set("fill", colour)
                            .set("shape-rendering", "crispEdges"),
                    )
                }
                false => {
                    let point = field.place(x, y);
                    dots(dots(mark, [point], 5.6, "#ffffff"), [point], 5.0, &colour)
                }
            });
        }
        let names = [x_key.label(&field.x), y_key.label(&field.y)];
        if is_grid {
            // the labels of the vertical axis alone
            let labels = field.y.ticks.iter().fold(Group::new(), |group, (value, label)| {
                let [_, y] = field.place(0.0, *value);
                group.add(text(label, [field.edges[0] - 8.0, y + 4.0]).set("text-anchor", "end"))
            });
            panel = panel.add(labels);
        }
        let panel =
            panel.add(field.outline()).add(field.floor(&names[0])).add(field.side(&names[1], 58.0));
        panel.add(colours(&scale, &quantity.label(&scale), field.edges))
    }
}

/// Where the cells around ascending values begin and end (px).
fn edges(values: &[f64], place: impl Fn(f64) -> f64, ends: [f64; 2]) -> Vec<f64> {
    let places: Vec<f64> = values.iter().map(|value| place(*value)).collect();
    let middles = places.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
    let mut edges: Vec<f64> = middles.collect();
    let (Some(first), Some(last)) = (places.first(), places.last()) else { return edges };
    let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
    let begin = edges.first().map_or(ends[0], |edge| 2.0 * first - edge);
    let end = edges.last().map_or(ends[1], |edge| 2.0 * last - edge);
    edges.insert(0, begin.clamp(low, high));
    edges.push(end.clamp(low, high));
    edges
}

/// The scale of colours on the right of a field, with what it is of above it.
pub(super) fn colours(scale: &Axis, label: &str, [_, top, right, bottom]: [f64; 4]) -> Group {
    let [left, right] = SCALE.map(|room| right + room);
    let height = (bottom - top) / PARTS as f64;
    let mut group = Group::new();
    for part in 0..PARTS {
        let y = bottom - (part + 1) as f64 * height;
        // a little more than a part, so that no line is seen between them
        let part = rectangle([left, y], [right, y + height + 0.4])
            .set("fill", colour((part as f64 + 0.5) / PARTS as f64));
        group = group.add(part);
    }
    for (value, label) in &scale.ticks {
        let y = bottom - scale.place(*value) * (bottom - top);
        if (top - 1.0..=bottom + 1.0).contains(&y) {
            group = group.add(text(label, [right + 5.0, y + 4.0]));
        }
    }
    group.add(
        text(label, [right + 42.0, top - 12.0]).set("text-anchor", "end").set("font-weight", 600),
    )
}
