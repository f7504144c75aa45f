//! Numbers in words.

use crate::input::told;

/// A number with two digits.
pub(super) fn short(value: f64) -> String {
    match value.abs() {
        1e5.. => format!("{value:.1e}"),
        _ => told(format!("{value:.1e}").parse().unwrap_or(value)),
    }
}

/// A part in percent, with two digits.
pub(super) fn percent(part: f64) -> String {
    format!("{} %", short(100.0 * part))
}
