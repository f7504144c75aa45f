//! Many keys: parallel coordinates, an axis for each key and quantity, a line for each run.

use svg::node::element::{Group, Polyline, Text};

use super::map::colours;
use super::scale::{Variable, colour};
use super::{FAILED, GREY, PANEL, Plot, ROOM};
use crate::io::output::{Axis, Point, round, stroke, text};

/// Distance of two axes (px).
const APART: f64 = 150.0;
/// Top of the axes (px): the names stand above it, alternately on two lines.
const TOP: f64 = 62.0;
const LINE: f64 = 18.0;
/// Longer names are cut.
const LETTERS: usize = 34;

impl Plot<'_> {
    pub(super) fn parallel_width(&self) -> f64 {
        let axes = self.keys.len() + self.quantities.len();
        ROOM[0] + APART * (axes.max(2) - 1) as f64 + ROOM[2] + 60.0
    }

    pub(super) fn parallel(&self) -> Group {
        let variables: Vec<&Variable> = self.keys.iter().chain(&self.quantities).collect();
        let axes: Vec<Axis> = variables.iter().map(|variable| variable.axis(0.0)).collect();
        let bottom = PANEL[1] - ROOM[3] + 20.0;
        let x = |at: usize| ROOM[0] + APART * at as f64;
        let y = |place: f64| bottom - place * (bottom - TOP);
        let first = self.quantities.first();
        let shade = first.map(|quantity| quantity.axis(0.0));
        let mut panel = Group::new().set("fill", "none").set("stroke-width", 1.2);
        for (number, row) in self.rows.iter().enumerate() {
            let value = first.map_or(f64::NAN, |quantity| quantity.values[number]);
            let shown = match &shade {
                Some(shade) if value.is_finite() => colour(shade.place(value)),
                _ => FAILED.into(),
            };
            let places = variables.iter().zip(&axes).enumerate().map(|(at, (variable, axis))| {
                let place = axis.place(variable.values[number]);
                [x(at), y(if place.is_finite() { place } else { -0.04 })]
            });
            let places: Vec<String> =
                places.map(|[x, y]| format!("{},{}", round(x), round(y))).collect();
            let line = Polyline::new().set("points", places.join(" ")).set("stroke", shown);
            panel = panel.add(self.mark(*row).add(line.set("stroke-opacity", 0.75)));
        }
        let mut group = Group::new().add(panel);
        for (at, (variable, axis)) in variables.iter().zip(&axes).enumerate() {
            group = group.add(stroke([x(at), TOP], [x(at), bottom], GREY));
            for (value, label) in axis.ticks.iter().filter(|tick| !tick.1.is_empty()) {
                let place = axis.place(*value);
                if (0.0..=1.0).contains(&place) {
                    group = group
                        .add(stroke([x(at) - 4.0, y(place)], [x(at), y(place)], GREY))
                        .add(over(label, [x(at) - 7.0, y(place) + 4.0]).set("text-anchor", "end"));
                }
            }
            let above = TOP - 14.0 - LINE * (at % 2) as f64;
            let name = text(short(&variable.label(axis)), [x(at), above]);
            group = group.add(name.set("text-anchor", "middle"));
        }
        let (Some(quantity), Some(shade)) = (first, &shade) else { return group };
        let right = x(axes.len() - 1) + 10.0;
        let name = format!("colour: {}", short(&quantity.name));
        let name = text(name, [right + 42.0, TOP - 16.0 - 2.0 * LINE]).set("text-anchor", "end");
        group.add(colours(shade, "", [0.0, TOP, right, bottom])).add(name.set("fill", GREY))
    }
}

/// A label that can be read over lines.
fn over(label: &str, place: Point) -> Text {
    let label = text(label, place).set("paint-order", "stroke").set("stroke", "#ffffff");
    label.set("stroke-width", 3).set("stroke-linejoin", "round")
}

/// The end of a long name, which tells more than its beginning.
fn short(name: &str) -> String {
    match name.chars().count().checked_sub(LETTERS) {
        Some(more) if more > 0 => {
            format!("\u{2026}{}", name.chars().skip(more + 1).collect::<String>())
        }
        _ => name.into(),
    }
}
