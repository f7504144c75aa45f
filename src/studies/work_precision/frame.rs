//! The field of charts of error over time, both logarithmic.

use svg::node::element::Group;

use super::fastest::time_text;
use crate::io::output::{Axis, Field, Point, power_text};

/// Larger relative errors are drawn as large as this: wrong is wrong.
const WORST: f64 = 10.0;
/// Labels on an axis, at most.
const LABELS: usize = 30;

/// Where errors and times are on a page, in pixels.
#[derive(Debug)]
pub(crate) struct Frame(Field);

impl Frame {
    /// A field with room for all `times` (s) and `errors`, which are positive; one of each at least.
    pub(crate) fn new(
        edges: [f64; 4],
        colours: [&'static str; 3],
        times: impl Iterator<Item = f64>,
        errors: impl Iterator<Item = f64>,
    ) -> Self {
        let x = Axis::logarithmic(times, LABELS, round_time_text);
        let y = Axis::logarithmic(errors.map(|error| error.min(WORST)), LABELS, power_text);
        Self(Field { edges, x, y, colours })
    }

    /// The place of a run: an error that is too small for the field is drawn at its bottom.
    pub(crate) fn place(&self, error: f64, time: f64) -> Point {
        let [x, y] = self.0.place(time, error.min(WORST));
        [x, y.min(self.0.edges[3])]
    }

    /// Axes, and lines across the field; `time` says which time it is.
    pub(crate) fn axes(&self, time: &str) -> Group {
        let names = Group::new().set("font-size", 13).add(self.0.side("relative error", 60.0));
        self.0.grid().add(self.0.outline()).add(self.0.floor(time)).add(names)
    }
}

/// 10 ms
fn round_time_text(seconds: f64) -> String {
    let text = time_text(seconds);
    match text.split_once('.') {
        Some((whole, rest)) => format!("{whole}{}", rest.trim_start_matches('0')),
        None => text,
    }
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
