//! Axes, linear and logarithmic: where their lines are, which numbers stand beside them, and in which unit.

use super::CHARACTER;

const SUPERSCRIPTS: [&str; 10] = ["⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"];

/// Units that take a prefix.
const PREFIXED: [&str; 7] = ["m", "s", "m/s", "N", "J", "Pa", "rad"];
const PREFIXES: [(f64, &str); 8] = [
    (1e9, "G"),
    (1e6, "M"),
    (1e3, "k"),
    (1.0, ""),
    (1e-3, "m"),
    (1e-6, "\u{b5}"),
    (1e-9, "n"),
    (1e-12, "p"),
];
/// Sizes between which numbers read well without a power of ten beside the unit.
const PLAIN: [f64; 2] = [1e-3, 1e4];
/// Larger numbers are cut off here, so that their differences do not overflow.
const LARGEST: f64 = 1e300;
/// Smaller numbers count as 0.
const LEAST: f64 = 1e-290;

/// A range of numbers with the lines across it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Axis {
    /// Ends of the range; decades, if the axis is logarithmic.
    low: f64,
    high: f64,
    is_logarithmic: bool,
    /// Values of the lines, and their labels; minor lines have none.
    pub(crate) ticks: Vec<(f64, String)>,
    /// Unit of the labels.
    pub(crate) unit: String,
}

impl Axis {
    /// From the least to the largest of the finite `values`, extended by `margin` times that range at both
    /// ends, with about `count` lines.
    pub(crate) fn linear(
        values: impl Iterator<Item = f64>,
        margin: f64,
        count: usize,
        unit: &str,
    ) -> Self {
        let finite = values.filter(|value| value.is_finite());
        let finite = finite.map(|value| value.clamp(-LARGEST, LARGEST));
        let [low, high] =
            finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], x| [l.min(x), h.max(x)]);
        let [low, high] = if low > high { [0.0, 1.0] } else { [low, high] };
        let largest = Some(low.abs().max(high.abs())).filter(|size| *size > LEAST).unwrap_or(0.0);
        let [low, high] = match high - low {
            // all alike, but for round-off
            width if width <= (1e-12 * largest).max(LEAST) => {
                let half = if largest == 0.0 { 1.0 } else { 0.1 * largest };
                [low - half, high + half]
            }
            width => [low - margin * width, high + margin * width],
        };
        let (factor, unit) = scaled(largest, unit);
        let ticks = ticks(low / factor, high / factor, count);
        let ticks = ticks.into_iter().map(|(value, label)| (value * factor, label)).collect();
        Self { low, high, is_logarithmic: false, ticks, unit }
    }

    /// From the least to the largest of the positive `values`, one decade at least, with margins at both ends.
    /// Labels are written by `label`; of many decades every second, third, ... has one, about `count` in all.
    pub(crate) fn logarithmic(
        values: impl Iterator<Item = f64>,
        count: usize,
        label: impl Fn(f64) -> String,
    ) -> Self {
        let [low, high] = values
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], x| [l.min(x), h.max(x)])
            .map(f64::log10);
        let room = 0.06 * (high - low) + 0.5 * (1.0 - (high - low)).max(0.0);
        let [low, high] = [low - room, high + room];
        let lines = decades([low, high]);
        let stride = lines.iter().filter(|line| line.1).count().div_ceil(count).max(1) as i64;
        let is_kept = |value: f64| stride == 1 || value.log10().round() as i64 % stride == 0;
        let text = |(value, is_major): (f64, bool)| {
            let is_labelled = is_major && is_kept(value);
            (value, if is_labelled { label(value) } else { String::new() })
        };
        // between many decades minor lines would be a grey field
        let lines = lines.into_iter().filter(|line| line.1 || high - low < 12.0);
        let ticks = lines.map(text).collect();
        Self { low, high, is_logarithmic: true, ticks, unit: String::new() }
    }

    /// Position of a value: 0 at the lower end, 1 at the upper.
    pub(crate) fn place(&self, value: f64) -> f64 {
        let value = if self.is_logarithmic { value.log10() } else { value };
        (value.clamp(-LARGEST, LARGEST) - self.low) / (self.high - self.low)
    }

    /// Width of the widest label (px).
    pub(super) fn width(&self) -> f64 {
        let lengths = self.ticks.iter().map(|tick| tick.1.chars().count());
        CHARACTER * lengths.max().unwrap_or(0) as f64
    }

    /// The value at a place from 0 to 1.
    pub(crate) fn value(&self, place: f64) -> f64 {
        let value = self.low + place * (self.high - self.low);
        if self.is_logarithmic { 10_f64.powf(value) } else { value }
    }

    /// The values at both ends.
    pub(crate) fn ends(&self) -> [f64; 2] {
        [0.0, 1.0].map(|place| self.value(place))
    }

    /// The name of a quantity with the unit of the labels, or with the power of ten that they leave out.
    pub(crate) fn label(&self, name: &str) -> String {
        match (name, &self.unit[..]) {
            (name, "" | "1") => name.into(),
            ("", unit) => unit.into(),
            (name, unit) if unit.starts_with("10") && !unit.contains(' ') => {
                format!("{name} / {unit}")
            }
            (name, unit) => format!("{name} ({unit})"),
        }
    }
}

/// A factor with which numbers up to `largest` read well, and the unit with it.
fn scaled(largest: f64, unit: &str) -> (f64, String) {
    if PREFIXED.contains(&unit) && largest > 0.0 {
        let found = PREFIXES.iter().find(|(factor, _)| largest >= 0.9999 * factor);
        if let Some((factor, prefix)) = found.filter(|(factor, _)| largest < 1e6 * factor) {
            return (*factor, format!("{prefix}{unit}"));
        }
    }
    let name = unit.replace("^2", "\u{b2}").replace("^3", "\u{b3}");
    if largest == 0.0 || (PLAIN[0]..PLAIN[1]).contains(&largest) {
        return (1.0, name);
    }
    let power = 3 * (largest.log10() / 3.0).floor() as i32;
    // the result of powi is not the nearest number
    let factor = format!("1e{power}").parse().unwrap_or(1.0);
    (factor, format!("{} {name}", power_text(factor)).trim_end().to_owned())
}

/// Round numbers from `low` to `high`, about `count` of them, as they are written.
fn ticks(low: f64, high: f64, count: usize) -> Vec<(f64, String)> {
    let rough = (high - low) / count as f64;
    let power = 10_f64.powi(rough.log10().floor() as i32);
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().find(|digit| digit * power >= 0.999 * rough);
    let step = step.unwrap_or(10.0) * power;
    let decimals = (-(step * 1.001).log10().floor()).max(0.0) as usize;
    let [first, last] = [(low / step - 1e-9).ceil(), (high / step + 1e-9).floor()];
    let number = (last - first).clamp(0.0, 100.0) as usize;
    let label = |value: f64| {
        let text = format!("{value:.decimals$}");
        // no minus before zero, and a real one before others
        match text.parse() {
            Ok(0.0) => text.replace('-', ""),
            _ => text.replace('-', "\u{2212}"),
        }
    };
    (0..=number).map(|k| (first + k as f64) * step).map(|value| (value, label(value))).collect()
}

/// Values between the decades `low` and `high` at which an axis has lines, and whether they are labelled:
/// powers of ten, and in a short range others, too.
fn decades([low, high]: [f64; 2]) -> Vec<(f64, bool)> {
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
    use super::{Axis, decades, power_text, ticks};

    fn labels(low: f64, high: f64, count: usize) -> Vec<String> {
        ticks(low, high, count).into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(labels(-0.31, 0.72, 6), ["\u{2212}0.2", "0.0", "0.2", "0.4", "0.6"]);
        assert_eq!(labels(0.0, 1.0, 4), ["0.0", "0.5", "1.0"]);
        assert_eq!(labels(990.0, 1010.5, 4), ["990", "1000", "1010"]);
        assert_eq!(labels(0.0, 1e-7, 2), ["0.00000000", "0.00000005", "0.00000010"]);
    }

    #[test]
    fn units_fit_the_numbers() {
        let unit =
            |largest: f64, unit: &str| Axis::linear([0.0, largest].into_iter(), 0.0, 4, unit).unit;
        assert_eq!(unit(0.03, "m"), "mm");
        assert_eq!(unit(2.5e5, "Pa"), "kPa");
        assert_eq!(unit(3.0, "N"), "N");
        assert_eq!(unit(2e-5, "m^3"), "10\u{207b}\u{2076} m\u{b3}");
        assert_eq!(unit(0.2, "kg m/s"), "kg m/s");
        assert_eq!(unit(3e12, "N"), "GN");
        assert_eq!(unit(3e20, "N"), "10\u{b9}\u{2078} N");
    }

    /// Whatever the values, all of them lie on the axis and its lines, too.
    #[test]
    fn any_values_have_an_axis() {
        for values in [
            vec![],
            vec![f64::NAN],
            vec![0.0],
            vec![-3.0, -3.0],
            vec![1.0, 1.0 + 1e-15],
            vec![f64::MAX, f64::MIN],
            vec![5e-324, 0.0],
            vec![f64::INFINITY, 1.0],
            vec![1e-300, 2e-300],
        ] {
            let axis = Axis::linear(values.iter().copied(), 0.05, 5, "m");
            for value in values.iter().filter(|value| value.is_finite()) {
                assert!((0.0..=1.0).contains(&axis.place(*value)), "{values:?}");
            }
            assert!(axis.ticks.len() <= 12, "{values:?}: {:?}", axis.ticks);
            assert!(axis.ticks.iter().all(|tick| tick.0.is_finite()), "{values:?}");
        }
    }

    #[test]
    fn lines_are_powers_of_ten_and_more_in_a_short_range() {
        let labelled = |range| -> Vec<f64> {
            decades(range).into_iter().filter(|tick| tick.1).map(|tick| tick.0).collect()
        };
        assert_eq!(labelled([-3.2, 0.1]), [1e-3, 1e-2, 1e-1, 1.0]);
        assert_eq!(labelled([-1.8, -0.9]), [2e-2, 5e-2, 0.1]);
    }

    #[test]
    fn labels_are_powers() {
        assert_eq!([1e-3, 2e-10, 1.0, 10.0].map(power_text), ["10⁻³", "2·10⁻¹⁰", "1", "10¹"]);
    }
}
