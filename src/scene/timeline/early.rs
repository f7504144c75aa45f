//! Tables that end before their phase begins, and act as a step there.

use super::Scene;

/// A table whose last value acts from the start of its phase on, where something else acted before.
pub(crate) struct EarlyTable {
    pub(crate) phase: String,
    /// Its quantity, in words.
    pub(crate) of: String,
    /// Start of the phase, and last time of the table (s).
    pub(crate) start: f64,
    pub(crate) last: f64,
    /// The values before and behind the start.
    pub(crate) values: [f64; 2],
}

/// A jump counts from this part of its values on.
const JUMP: f64 = 1e-6;

/// Whether all times of a table, its `breaks`, are before the `start` of its phase (s).
fn ends_before(breaks: &[f64], start: f64) -> Option<f64> {
    breaks.last().copied().filter(|last| breaks.len() > 1 && *last <= start)
}

fn jumps([from, to]: [f64; 2]) -> bool {
    (to - from).abs() > JUMP * from.abs().max(to.abs())
}

impl Scene {
    /// The tables of later phases that act as steps.
    pub(crate) fn early_tables(&self) -> Vec<EarlyTable> {
        let mut early = Vec::new();
        for (before, phase) in self.phases.iter().zip(self.phases.iter().skip(1)) {
            let start = before.until;
            let mut add = |of: String, last: f64, values: [f64; 2]| {
                if jumps(values) {
                    early.push(EarlyTable { phase: phase.name.clone(), of, start, last, values });
                }
            };
            for input in &phase.inputs {
                let Some(last) = ends_before(input.signal.breaks(), start) else { continue };
                for target in input.target.each() {
                    let at = |phase| self.input_at(phase, input.quantity, &target, start);
                    for (then, now) in at(before).into_iter().zip(at(phase)) {
                        add(format!("the {}", input.quantity.of(&target)), last, [then, now]);
                    }
                }
            }
        }
        early
    }
}
