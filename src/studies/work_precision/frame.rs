//! The frame of charts of error over time, both logarithmic.

use svg::node::element::{Group, Line, Text};

use super::fastest::time_text;
use crate::io::output::{power_text, ticks};

/// Larger relative errors are drawn as large as this: wrong is wrong.
const WORST: f64 = 10.0;

pub(super) type Point = [f64; 2];

/// Where errors and times are on a page, in pixels.
#[derive(Debug)]
pub(super) struct Frame {
    /// Left, top, right and bottom of the field in which points are drawn.
    pub(super) field: [f64; 4],
    /// Decades of time (s) from left to right.
    times: [f64; 2],
    /// Decades of error from bottom to top.
    errors: [f64; 2],
    /// Colours of axes, of lines with a label, and of other lines.
    colours: [&'static str; 3],
}

impl Frame {
    /// A field with room for all `times` (s) and `errors`, which are positive; one of each at least.
    pub(super) fn new(
        field: [f64; 4],
        colours: [&'static str; 3],
        times: impl Iterator<Item = f64>,
        errors: impl Iterator<Item = f64>,
    ) -> Self {
        let errors = range(errors.map(|error| error.min(WORST)));
        Self { field, times: range(times), errors, colours }
    }

    /// The place of a run: an error that is too small for the field is drawn at its bottom.
    pub(super) fn place(&self, error: f64, time: f64) -> Point {
        let [left, top, right, bottom] = self.field;
        let part = |decade: f64, [low, high]: [f64; 2]| (decade - low) / (high - low);
        let decade = error.min(WORST).log10().max(self.errors[0]);
        let x = left + part(time.log10(), self.times) * (right - left);
        let y = bottom - part(decade, self.errors) * (bottom - top);
        [x, y]
    }

    /// Axes, and lines across the field; `time` says which time it is.
    pub(super) fn axes(&self, time: &str) -> Group {
        let [left, top, right, bottom] = self.field;
        let [ink, grid, faint] = self.colours;
        let mut group = Group::new();
        let (times, errors) = (ticks(self.times), ticks(self.errors));
        for (value, is_labelled) in &times {
            let [x, _] = self.place(1.0, *value);
            let colour = if *is_labelled { grid } else { faint };
            group = group.add(stroke([x, top], [x, bottom], colour));
            if *is_labelled {
                let label = text(round_time_text(*value), [x, bottom + 18.0]);
                group = group.add(label.set("text-anchor", "middle"));
            }
        }
        for (value, is_labelled) in &errors {
            let [_, y] = self.place(*value, 1.0);
            let colour = if *is_labelled { grid } else { faint };
            group = group.add(stroke([left, y], [right, y], colour));
            if *is_labelled {
                let label = text(power_text(*value), [left - 8.0, y + 4.0]);
                group = group.add(label.set("text-anchor", "end"));
            }
        }
        let middle = [0.5 * (left + right), 0.5 * (top + bottom)];
        let beside = [left - 60.0, middle[1]];
        group
            .add(stroke([left, bottom], [right, bottom], ink))
            .add(stroke([left, top], [left, bottom], ink))
            .add(
                text(time, [middle[0], bottom + 42.0])
                    .set("text-anchor", "middle")
                    .set("font-size", 13),
            )
            .add(
                text("relative error", beside)
                    .set("text-anchor", "middle")
                    .set("font-size", 13)
                    .set("transform", format!("rotate(-90 {} {})", beside[0], beside[1])),
            )
    }
}

/// Decades from the least to the largest of `values`: one at least, and room for the markers.
fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let [low, high] = values
        .fold([f64::INFINITY, -f64::INFINITY], |[l, h], x| [x.min(l), x.max(h)])
        .map(f64::log10);
    let more = 0.06 * (high - low) + 0.5 * (1.0 - (high - low)).max(0.0);
    [low - more, high + more]
}

/// 10 ms
fn round_time_text(seconds: f64) -> String {
    let text = time_text(seconds);
    match text.split_once('.') {
        Some((whole, rest)) => format!("{whole}{}", rest.trim_start_matches('0')),
        None => text,
    }
}

pub(super) fn text(content: impl Into<String>, [x, y]: Point) -> Text {
    Text::new(content.into()).set("x", round(x)).set("y", round(y))
}

pub(super) fn stroke([x1, y1]: Point, [x2, y2]: Point, colour: &str) -> Line {
    Line::new()
        .set("x1", round(x1))
        .set("y1", round(y1))
        .set("x2", round(x2))
        .set("y2", round(y2))
        .set("stroke", colour)
}

pub(super) fn round(x: f64) -> f64 {
    (100.0 * x).round() / 100.0
}

#[cfg(test)]
mod tests {
    use super::round_time_text;

    #[test]
    fn labels_are_short() {
        let times = [1e-5, 2e-3, 0.1, 1.0, 100.0].map(round_time_text);
        assert_eq!(times, ["10 \u{b5}s", "2 ms", "100 ms", "1 s", "100 s"]);
    }
}
