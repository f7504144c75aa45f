//! Numbers in words.

/// A number with four digits, as messages tell times.
pub(crate) fn told(value: f64) -> String {
    let rounded = format!("{value:.3e}").parse().unwrap_or(value);
    format!("{rounded:?}").trim_end_matches(".0").to_owned()
}

/// A number with two digits.
pub(crate) fn short(value: f64) -> String {
    match value.abs() {
        1e5.. => format!("{value:.1e}"),
        _ => told(format!("{value:.1e}").parse().unwrap_or(value)),
    }
}

/// A part in percent, with two digits.
pub(crate) fn percent(part: f64) -> String {
    format!("{} %", short(100.0 * part))
}
