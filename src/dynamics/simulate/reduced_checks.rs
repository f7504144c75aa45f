//! What a run by a reduced model knows of its error: what the model leaves over is kept now and then, and how far that would
//! move the body is found once somebody asks, as it takes a factorization with all unknowns.

use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::dynamics::report::ReducedReport;
use crate::dynamics::system::{LeftOver, System};
use crate::scene::reduced_model::ReducedModel;

/// What is known, and what is not known yet.
#[derive(Clone)]
pub(super) struct ReducedChecks {
    pub(super) report: ReducedReport,
    /// Of the present phase.
    left_over: Vec<LeftOver>,
}

impl ReducedChecks {
    /// At the start of a run by `model`.
    pub(super) fn new(model: &ReducedModel) -> Self {
        Self { report: ReducedReport::new(model), left_over: Vec::new() }
    }

    /// Keeps what is left over in a state whose largest displacement is `travel` (m).
    pub(super) fn keep(&mut self, left_over: LeftOver, travel: f64) {
        self.report.note_state(travel, left_over.outside);
        self.left_over.push(left_over);
    }

    /// Finds how far all that is left over would move the body, with the `equations` of the phase; infinitely far without
    /// them.
    pub(super) fn settle(&mut self, equations: impl FnOnce() -> Option<System>) {
        if self.left_over.is_empty() {
            return;
        }
        let found = equations().map(|mut system| system.imbalances(&self.left_over));
        let imbalances = found.unwrap_or_else(|| vec![f64::INFINITY]);
        imbalances.into_iter().for_each(|imbalance| self.report.note_imbalance(imbalance));
        self.left_over.clear();
    }

    /// Forgets what is not known yet, as it belongs to another phase than that to come.
    pub(super) fn forget(&mut self) {
        self.left_over.clear();
    }
}

/// The checks, whatever has happened to others who looked at them.
pub(super) fn locked(checks: &Mutex<ReducedChecks>) -> MutexGuard<'_, ReducedChecks> {
    checks.lock().unwrap_or_else(PoisonError::into_inner)
}
