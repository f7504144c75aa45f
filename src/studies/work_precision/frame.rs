//! Axes of charts of error over time, both logarithmic.

use super::fastest::time_text;
use crate::io::output::{Axis, power_text};

/// Larger relative errors are drawn as large as this: wrong is wrong.
pub(crate) const WORST: f64 = 10.0;
/// Labels on an axis, at most.
const LABELS: usize = 30;

/// Axes that include all `times` (s) and `errors`, which are positive; one of each at least.
pub(crate) fn axes(
    times: impl Iterator<Item = f64>,
    errors: impl Iterator<Item = f64>,
) -> [Axis; 2] {
    let errors = errors.map(|error| error.min(WORST));
    [
        Axis::logarithmic(times, LABELS, round_time_text),
        Axis::logarithmic(errors, LABELS, power_text),
    ]
}

/// Corners of a band across the field, from its floor to the error `level`.
pub(crate) fn below(level: f64, [x, y]: &[Axis; 2]) -> [(f64, f64); 4] {
    let ([left, right], [bottom, top]) = (x.ends(), y.ends());
    let level = level.clamp(bottom, top);
    [(left, bottom), (left, level), (right, level), (right, bottom)]
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
