//! Logarithmic axes: where their lines are and how they are labelled.

const SUPERSCRIPTS: [&str; 10] = ["⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"];

/// Values between the decades `low` and `high` at which an axis has lines, and whether they are labelled:
/// powers of ten, and in a short range others, too.
pub(crate) fn ticks([low, high]: [f64; 2]) -> Vec<(f64, bool)> {
    let is_short = high - low < 2.5;
    let mut ticks = Vec::new();
    for decade in low.floor() as i32..=high.floor() as i32 {
        for digit in 1..=9 {
            let value = format!("{digit}e{decade}").parse::<f64>().expect("a number");
            if (low..=high).contains(&value.log10()) {
                ticks.push((value, digit == 1 || is_short && (digit == 2 || digit == 5)));
            }
        }
    }
    ticks
}

/// 10⁻³, 2·10⁻³
pub(crate) fn power_text(value: f64) -> String {
    let text = format!("{value:e}");
    let (digit, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let raised: String = exponent
        .chars()
        .map(|c| c.to_digit(10).map_or("⁻", |digit| SUPERSCRIPTS[digit as usize]))
        .collect();
    match (digit, exponent) {
        (digit, "0") => digit.into(),
        ("1", _) => format!("10{raised}"),
        _ => format!("{digit}·10{raised}"),
    }
}

#[cfg(test)]
mod tests {
    use super::{power_text, ticks};

    #[test]
    fn ticks_are_powers_of_ten_and_more_in_a_short_range() {
        let labelled = |range| -> Vec<f64> {
            ticks(range).into_iter().filter(|tick| tick.1).map(|tick| tick.0).collect()
        };
        assert_eq!(labelled([-3.2, 0.1]), [1e-3, 1e-2, 1e-1, 1.0]);
        assert_eq!(labelled([-1.8, -0.9]), [2e-2, 5e-2, 0.1]);
    }

    #[test]
    fn labels_are_powers() {
        assert_eq!([1e-3, 2e-10, 1.0, 10.0].map(power_text), ["10⁻³", "2·10⁻¹⁰", "1", "10¹"]);
    }
}
