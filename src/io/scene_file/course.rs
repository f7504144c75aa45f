//! Time functions in a table: one value or formula, or a table of values at times, which may be repeated.

use super::table::Table;
use super::value::Value;
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::scene::forces::{Signal, TimeTable, VectorSignal};

/// The key of values at times, of the key `word` of one value.
pub(super) fn plural(word: &str) -> String {
    match word {
        "stress" => "stresses".into(),
        word => format!("{word}s"),
    }
}

/// The signal of the key `word`, a number or formula, or of the keys `times` and the plural of `word`, lists of numbers.
/// A table may be repeated up to the time `until` (s).
pub(super) fn course(table: &Table, until: f64, word: &str) -> Result<Signal, Error> {
    let signal = match table.optional(word, Value::signal)? {
        Some(signal) => signal,
        None => Signal::table(
            table.required("times", Value::numbers)?,
            table.required(&plural(word), Value::numbers)?,
        ),
    };
    repeated(table, signal, |signal, period| signal.repeated(period, until))
}

/// Periodic signal, by `repeat`, if the table has a period; `signal` otherwise.
fn repeated<S>(
    table: &Table,
    signal: S,
    repeat: impl FnOnce(S, f64) -> Result<S, InputError>,
) -> Result<S, Error> {
    let Some(value) = table.get("period") else { return Ok(signal) };
    repeat(signal, value.finite()?).map_err(|error| value.error(error))
}

/// The vector of the key `word`, constant or by formulas, or of the keys `times` and `word` with an s, if there is any.
pub(super) fn vectors(
    table: &Table,
    word: &str,
    dimension: usize,
) -> Result<Option<VectorSignal>, Error> {
    if let Some(value) = table.optional(word, |value| value.vector_signal(dimension))? {
        return Ok(Some(value));
    }
    let many = table.optional(&format!("{word}s"), |value| {
        value.list_of("vectors, one per time", |vector| vector.vector(dimension))
    })?;
    let Some(values) = many else { return Ok(None) };
    let times = table.required("times", Value::numbers)?;
    Ok(Some(VectorSignal::TimeTable(TimeTable::new(times, values))))
}

/// The same in a phase that ends at the time `until` (s), up to which a table may be repeated.
pub(super) fn vectors_until(
    table: &Table,
    until: f64,
    word: &str,
    dimension: usize,
) -> Result<Option<VectorSignal>, Error> {
    let Some(vector) = vectors(table, word, dimension)? else { return Ok(None) };
    repeated(table, vector, |vector, period| vector.repeated(period, until)).map(Some)
}
