//! Arrays of numbers as short text.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

/// `points`, one after the other with a number per axis each, as 16-bit numbers between the least
/// and the largest of their axis.
pub(super) fn points(points: &[f64], axes: usize) -> Value {
    let along = |axis: usize| points.iter().skip(axis).step_by(axes);
    let ranges: Vec<[f64; 2]> = (0..axes)
        .map(|axis| {
            let least = along(axis).copied().fold(f64::INFINITY, f64::min);
            [least, along(axis).copied().fold(f64::NEG_INFINITY, f64::max)]
        })
        .collect();
    let mut bytes = Vec::with_capacity(2 * points.len());
    for (x, [least, largest]) in points.iter().zip(ranges.iter().cycle()) {
        bytes.extend((share(x - least, largest - least, u16::MAX.into()) as u16).to_le_bytes());
    }
    json!({ "ranges": ranges, "numbers": STANDARD.encode(bytes) })
}

/// `values` between two others as 8-bit numbers; values outside count as the nearer one.
pub(super) fn values(values: &[f32], [least, largest]: [f64; 2]) -> Value {
    let byte =
        |&value: &f32| share(f64::from(value) - least, largest - least, u8::MAX.into()) as u8;
    STANDARD.encode(values.iter().map(byte).collect::<Vec<u8>>()).into()
}

/// `numbers` in single precision.
pub(super) fn singles(numbers: impl IntoIterator<Item = f64>) -> Value {
    let bytes = numbers.into_iter().flat_map(|x| (x as f32).to_le_bytes());
    STANDARD.encode(bytes.collect::<Vec<u8>>()).into()
}

/// The nearest whole number to `steps` times the share of `part` in `whole`.
fn share(part: f64, whole: f64, steps: f64) -> f64 {
    if whole > 0.0 { (part / whole * steps).round() } else { 0.0 }
}
