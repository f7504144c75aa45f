//! The history since the start, for the running chart of the page.
//!
//! Energies and sensors are recorded at least every thousandth of the scene and every 5 ms, and a page gets
//! the records since its last request: charts are independent of the speed of the browser, and a page that
//! is opened later has all of it.

use serde_json::{Value, json};

use crate::dynamics::simulate::Simulation;
use crate::io::output::Picture;

/// Most moments; beyond this number every other one is dropped.
const MOST: usize = 3000;

/// The energies and sensor readings since the start.
#[derive(Default)]
pub(super) struct Past {
    moments: Vec<Moment>,
}

/// A time (s), the energies (J), and the sensor readings.
type Moment = (f64, [f64; 8], Vec<f64>);

impl Past {
    /// The past of a simulation at its start.
    pub(super) fn of(simulation: &mut Simulation) -> Self {
        let mut past = Self::default();
        past.note(simulation);
        past
    }

    /// Records the present.
    pub(super) fn note(&mut self, simulation: &mut Simulation) {
        let sensors = simulation.trajectory().sensors().len();
        // a sample requires constraint forces; where they cannot be computed there are no readings either
        let sample = (sensors > 0).then(|| simulation.sample().ok()).flatten();
        let (energy, read) = match sample {
            Some(sample) => (sample.energy, sample.sensors),
            None => (simulation.energy(), vec![f64::NAN; sensors]),
        };
        self.moments.push((simulation.time(), Picture::energies(&energy), read));
        if self.moments.len() > MOST {
            let mut number = 0;
            self.moments.retain(|_| {
                number += 1;
                number % 2 == 1
            });
        }
    }

    /// The moments after the time `since` (s), or all of them; values that are NaN become `null`.
    pub(super) fn after(&self, since: Option<f64>) -> Value {
        let is_known = |time: f64| since.is_some_and(|since| time <= since);
        let from = self.moments.partition_point(|&(time, ..)| is_known(time));
        self.moments[from..].iter().map(|moment| json!(moment)).collect()
    }
}
