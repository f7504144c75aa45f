//! One run of a study: a row of its table.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};

/// One run: its values, results, reliability and cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// The [point](super::Point).
    pub id: String,
    /// The keys that are varied, with their values as they are set.
    pub keys: BTreeMap<String, String>,
    /// The quantities, with their numbers; none if the run failed, or there is no such number.
    pub quantities: BTreeMap<String, Option<f64>>,
    /// Whether they can be trusted.
    pub verdict: RowVerdict,
    /// Names of the warnings: of the indicators that are beyond their limits, and `integrator`, `energy-balance`,
    /// `accuracy`, of equilibria `unstable`.
    pub warnings: Vec<String>,
    /// Reason for the failure of the run.
    pub failure: Option<String>,
    /// Relative difference of the last two runs, if an accuracy was requested.
    pub difference: Option<f64>,
    /// Time reached (s); in an equilibrium the end of its phase, or that part of it to which the load was brought on.
    pub reached: Option<f64>,
    /// Steps of the integrator; of an equilibrium Newton's iterations.
    pub steps: usize,
    /// Cost of the run: the one part that differs when the same point is run again.
    pub cost: Cost,
}

/// Whether a run can be trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RowVerdict {
    /// No warning.
    Fine,
    /// There are warnings.
    Doubtful,
    /// It ended early, or did not begin.
    Failed,
}

/// Cost of a run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cost {
    /// Wall-clock time (s), with reading the scene.
    pub wall_seconds: f64,
    /// Processor time (s).
    pub processor_seconds: f64,
}

impl RowVerdict {
    /// Its word: `fine`, `doubtful`, `failed`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fine => "fine",
            Self::Doubtful => "doubtful",
            Self::Failed => "failed",
        }
    }
}

impl fmt::Display for RowVerdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl Row {
    /// The number of a quantity, or of a key that has numbers.
    pub fn number(&self, name: &str) -> Option<f64> {
        match self.quantities.get(name) {
            Some(value) => *value,
            None => self.keys.get(name)?.parse().ok(),
        }
    }
}
