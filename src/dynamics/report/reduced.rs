//! Error report of a run by a reduced model.

use std::collections::BTreeMap;
use std::fmt;

use crate::base::input::{four_digits, percent};
use crate::scene::reduced_model::ReducedModel;

/// Results of a run by a reduced model: its estimated error and its range.
#[derive(Debug, Clone, PartialEq)]
pub struct ReducedReport {
    /// Shapes of the phase that has most.
    pub shapes: usize,
    /// Cells whose forces are computed, and all; the first is 0 where these are exact along the shapes.
    pub cells: [usize; 2],
    /// Largest error of a displacement in the runs that the model was checked with, relative to their largest displacement.
    pub checked_error: f64,
    /// The error that was wanted of it.
    pub within: f64,
    /// The error that this run estimates, relative to the largest displacement in it or in these runs: the displacement by the residual forces, times the ratio of the two in the runs that the
    /// model was checked with.
    pub estimated_error: f64,
    /// Extrapolation: distance outside the training range, relative to the largest modal range.
    pub outside: f64,
    /// Estimated errors of the sensors that follow from positions of nodes.
    pub readings: Vec<SensorErrorEstimate>,
    /// The keys of the scene's file, with their values, that the model was not learned over: neither the error that this run estimates nor that
    /// where it was checked is one of such scenes.
    pub unlearned: Vec<String>,
    /// Whether its error is not that of any run with all unknowns, but an estimate by its own runs.
    pub is_estimate: bool,
    /// Whether it was learned from one run.
    is_of_one_run: bool,
    per_imbalance: f64,
    /// Largest imbalance and largest displacement (m) that were seen.
    imbalance: f64,
    travel: f64,
}

/// The error of a sensor, as a run by a reduced model estimates it.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorErrorEstimate {
    /// Name of its column.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// The largest error at the checked times, in that unit.
    pub error: f64,
}

impl ReducedReport {
    /// A run by `model` at its start.
    pub(crate) fn new(model: &ReducedModel, keys: &BTreeMap<String, String>) -> Self {
        Self {
            shapes: model.unknowns(),
            cells: [model.cells(), model.cell_count],
            checked_error: model.error,
            within: model.within,
            estimated_error: 0.0,
            outside: 0.0,
            readings: Vec::new(),
            unlearned: model.unlearned(keys),
            is_estimate: model.is_estimate,
            is_of_one_run: model.runs == 1,
            per_imbalance: model.error_per_imbalance,
            imbalance: 0.0,
            travel: model.travel,
        }
    }

    /// Adds a state whose largest displacement is `travel` (m), so far outside of those learned from.
    pub(crate) fn note_state(&mut self, travel: f64, outside: f64) {
        self.travel = self.travel.max(travel);
        self.outside = self.outside.max(outside);
        self.estimated_error = self.per_imbalance * self.imbalance();
    }

    /// Adds an imbalance (m).
    pub(crate) fn note_imbalance(&mut self, imbalance: f64) {
        self.imbalance = self.imbalance.max(imbalance);
        self.estimated_error = self.per_imbalance * self.imbalance();
    }

    /// Adds the change of sensor readings by an imbalance.
    pub(crate) fn note_changes(&mut self, changes: Vec<SensorErrorEstimate>) {
        for change in changes {
            let error = self.per_imbalance * change.error;
            match self.readings.iter_mut().find(|told| told.name == change.name) {
                Some(told) => told.error = told.error.max(error),
                None => self.readings.push(SensorErrorEstimate { error, ..change }),
            }
        }
    }

    /// Difference of the error of this run from that of the single full-order run that the model was learned from, relative to the
    /// required accuracy; none if it was learned from several runs, and without an error of this run.
    pub(crate) fn apart_from_one_run(&self) -> Option<f64> {
        let is_told = self.is_of_one_run && !self.is_estimate && self.estimated_error > 0.0;
        is_told.then(|| (self.estimated_error - self.checked_error).abs() / self.within)
    }

    /// The imbalance (m) up to which the error is one that was wanted.
    pub(crate) fn enough(&self) -> f64 {
        self.within * self.travel / self.per_imbalance
    }

    /// The largest imbalance (m), and the largest displacement (m).
    pub(crate) fn lengths(&self) -> [f64; 2] {
        [self.imbalance, self.travel]
    }

    /// The largest imbalance relative to the largest displacement.
    pub(crate) fn imbalance(&self) -> f64 {
        if self.travel > 0.0 { self.imbalance / self.travel } else { 0.0 }
    }
}

impl fmt::Display for ReducedReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { shapes, cells: [cells, all], checked_error, estimated_error, .. } = self;
        write!(f, "reduced model: {shapes} shapes")?;
        if *cells > 0 {
            write!(f, ", {cells} of {all} cells")?;
        }
        let (checked, said) = (percent(*checked_error), percent(*estimated_error));
        match self.is_estimate {
            true => {
                write!(f, "; error {said} estimated by this run, not verified with all unknowns")?
            }
            false => {
                write!(f, "; error {checked} in its verification, {said} estimated by this run")?
            }
        }
        for SensorErrorEstimate { name, unit, error } in &self.readings {
            let unit = if unit == "1" { "" } else { unit };
            write!(f, ", {name} {} {unit}", four_digits(*error))?;
        }
        Ok(())
    }
}
