//! Numbers as messages show them.

/// A number with four significant digits, as messages show times.
pub(crate) fn four_digits(value: f64) -> String {
    digits(value, 4)
}

/// A number with so many significant digits at most, one at least, without zeros at its end.
pub(crate) fn digits(value: f64, count: usize) -> String {
    let rounded = format!("{value:.*e}", count.max(1) - 1).parse().unwrap_or(value);
    format!("{rounded:?}").trim_end_matches(".0").to_owned()
}

/// A number with two significant digits.
pub(crate) fn short(value: f64) -> String {
    match value.abs() {
        1e5.. => format!("{value:.1e}"),
        _ => four_digits(format!("{value:.1e}").parse().unwrap_or(value)),
    }
}

/// A fraction in percent, with two significant digits.
pub(crate) fn percent(part: f64) -> String {
    format!("{} %", short(100.0 * part))
}
