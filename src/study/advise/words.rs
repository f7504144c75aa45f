//! Numbers in words.

use crate::input::told;

/// A relative number in percent.
pub(super) fn percent(part: f64) -> String {
    format!("{} %", short(100.0 * part))
}

/// How often.
pub(super) fn times(count: usize) -> String {
    match count {
        1 => "once".into(),
        2 => "twice".into(),
        count => format!("{count} times"),
    }
}

/// A number with two digits.
pub(super) fn short(value: f64) -> String {
    let rounded = format!("{value:.1e}").parse().unwrap_or(value);
    told(rounded)
}
