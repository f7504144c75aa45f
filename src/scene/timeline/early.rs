//! Tables that end before their phase begins, and act as a step there.

use super::{Phase, Scene};
use crate::scene::forces::{Signal, VectorSignal};

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

/// Quantities that a phase lists by names, and that are 0 where it does not: in words, with names and signals.
fn named(phase: &Phase) -> [(&'static str, Vec<(&str, &Signal)>); 3] {
    fn one(list: &[(String, Signal)]) -> Vec<(&str, &Signal)> {
        list.iter().map(|(name, signal)| (name.as_str(), signal)).collect()
    }
    let all = phase.actuations.iter();
    let actuations =
        all.flat_map(|(names, signal)| names.iter().map(move |name| (name.as_str(), signal)));
    [
        ("the actuation of", actuations.collect()),
        ("the pressure in", one(&phase.pressures)),
        ("the flow into", one(&phase.flows)),
    ]
}

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
            for ((what, now), (_, then)) in named(phase).into_iter().zip(named(before)) {
                for (name, signal) in &now {
                    let Some(last) = ends_before(signal.breaks(), start) else { continue };
                    let sum = |all: &[(&str, &Signal)]| -> f64 {
                        let own = all.iter().filter(|(own, _)| own == name);
                        own.map(|(_, signal)| signal.at(start)).sum()
                    };
                    add(format!("{what} \"{name}\""), last, [sum(&then), sum(&now)]);
                }
            }
            for (nodes, load) in &phase.loads {
                let VectorSignal::TimeTable(table) = &load.value else { continue };
                let Some(last) = ends_before(&table.times, start) else { continue };
                let mut loads = before.loads.iter();
                let known = loads.find(|(own, other)| own == nodes && other.kind == load.kind);
                let mut then = vec![0.0; table.values[0].len()];
                if let Some((_, known)) = known {
                    known.value.at(start, &mut then);
                }
                for (component, then) in then.into_iter().enumerate() {
                    let now = table.at(start, component);
                    add(format!("the load on {nodes}"), last, [then, now]);
                }
            }
        }
        early
    }
}
