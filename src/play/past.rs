//! What has been since the start, for the running chart of the page.

use serde_json::{Value, json};

use crate::output::Picture;
use crate::simulate::Simulation;

/// Moments at most; beyond, every other one is left out.
const MOST: usize = 3000;

/// The energies since the start.
#[derive(Default)]
pub(super) struct Past {
    moments: Vec<(f64, [f64; 8])>,
}

impl Past {
    /// The past of a simulation at its start.
    pub(super) fn of(simulation: &Simulation) -> Self {
        let mut past = Self::default();
        past.note(simulation);
        past
    }

    /// Takes the present down.
    pub(super) fn note(&mut self, simulation: &Simulation) {
        let moment = (simulation.time(), Picture::energies(&simulation.energy()));
        self.moments.push(moment);
        if self.moments.len() > MOST {
            let mut number = 0;
            self.moments.retain(|_| {
                number += 1;
                number % 2 == 1
            });
        }
    }

    /// Times (s) and energies (J) after the time `since` (s), or all of them.
    pub(super) fn after(&self, since: Option<f64>) -> Value {
        let is_known = |time: f64| since.is_some_and(|since| time <= since);
        let from = self.moments.partition_point(|&(time, _)| is_known(time));
        self.moments[from..].iter().map(|(time, energies)| json!([time, energies])).collect()
    }
}
