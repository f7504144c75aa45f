//! Numbers that show how far a result can be trusted, each with its limits.

use std::fmt;

/// A number measured on a scene or on its motion, with its limits and the remedy beyond them.
#[derive(Debug, Clone, PartialEq)]
pub struct Indicator {
    /// Name of the measured quantity: one word, or several joined by hyphens.
    pub name: &'static str,
    /// Measured value, in [`unit`](Self::unit).
    pub value: f64,
    /// Least and largest value that are in order; infinite where there is no limit.
    pub limits: [f64; 2],
    /// Unit of the value and of its limits; empty for counts, `"1"` for ratios.
    pub unit: &'static str,
    /// Assessment of the value.
    pub verdict: Verdict,
    /// Message: the measured value, its limit and, beyond it, the remedy.
    pub text: String,
}

/// Assessment of the value of an [`Indicator`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// In order.
    Fine,
    /// The result is doubtful: a warning.
    Doubtful,
    /// The result would be the same with a simpler model, or with half of the body.
    MoreThanNeeded,
}

impl Verdict {
    /// Its word: `fine`, `doubtful`, `more-than-needed`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fine => "fine",
            Self::Doubtful => "doubtful",
            Self::MoreThanNeeded => "more-than-needed",
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl Indicator {
    /// A number that is for information only.
    pub(crate) fn told(name: &'static str, value: f64, unit: &'static str, text: String) -> Self {
        let limits = [f64::NEG_INFINITY, f64::INFINITY];
        Self { name, value, limits, unit, verdict: Verdict::Fine, text }
    }

    /// A number that makes the result doubtful if it is beyond its `limits`: the text is `beyond` then, else `within`.
    pub(crate) fn trusted(
        name: &'static str,
        (value, unit): (f64, &'static str),
        limits: [f64; 2],
        within: impl FnOnce() -> String,
        beyond: impl FnOnce() -> String,
    ) -> Self {
        Self::judged(name, (value, unit), limits, within, (Verdict::Doubtful, beyond))
    }

    /// A number that shows, below the limit `least`, that a simpler model would do: the text is `below` then,
    /// else `within`.
    pub(crate) fn needed(
        name: &'static str,
        (value, unit): (f64, &'static str),
        least: f64,
        within: impl FnOnce() -> String,
        below: impl FnOnce() -> String,
    ) -> Self {
        let limits = [least, f64::INFINITY];
        Self::judged(name, (value, unit), limits, within, (Verdict::MoreThanNeeded, below))
    }

    fn judged(
        name: &'static str,
        (value, unit): (f64, &'static str),
        limits: [f64; 2],
        within: impl FnOnce() -> String,
        (verdict, beyond): (Verdict, impl FnOnce() -> String),
    ) -> Self {
        match value < limits[0] || value > limits[1] {
            true => Self { name, value, limits, unit, verdict, text: beyond() },
            false => Self { name, value, limits, unit, verdict: Verdict::Fine, text: within() },
        }
    }

    /// Whether the value is beyond its limits.
    pub fn is_beyond(&self) -> bool {
        self.verdict != Verdict::Fine
    }

    /// Whether it makes the result doubtful.
    pub fn is_doubtful(&self) -> bool {
        self.verdict == Verdict::Doubtful
    }
}

impl fmt::Display for Indicator {
    /// One line: the verdict and the text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:16}  {}", self.verdict, self.text)
    }
}

/// The texts of those that make a result doubtful: its warnings.
pub(crate) fn warnings(indicators: &[Indicator]) -> Vec<String> {
    let doubtful = indicators.iter().filter(|indicator| indicator.is_doubtful());
    doubtful.map(|indicator| indicator.text.clone()).collect()
}
