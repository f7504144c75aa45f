//! What a run by a reduced model knows of its error: what the model leaves over is kept now and then, and how far that would
//! move the body is found once somebody asks, as it takes a factorization with all unknowns.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::base::vector::largest;
use crate::dynamics::report::{ReducedReport, ToldReading};
use crate::dynamics::system::{Lacking, LeftOver, System};
use crate::scene::reduced_model::ReducedModel;

/// What is known, and what is not known yet.
#[derive(Clone)]
pub(super) struct ReducedChecks {
    pub(super) report: ReducedReport,
    /// Of the present phase.
    left_over: Vec<LeftOver>,
    /// Of all phases.
    pub(super) lacking: Vec<Arc<Lacking>>,
}

impl ReducedChecks {
    /// At the start of a run by `model`.
    pub(super) fn new(model: &ReducedModel) -> Self {
        let report = ReducedReport::new(model);
        Self { report, left_over: Vec::new(), lacking: Vec::new() }
    }

    /// Keeps what is left over in a state whose largest displacement is `travel` (m).
    pub(super) fn keep(&mut self, left_over: LeftOver, travel: f64) {
        self.report.note_state(travel, left_over.outside);
        self.left_over.push(left_over);
    }

    /// Finds how far all that is left over would move the body, with the `equations` of the phase `number`; infinitely far without
    /// them. `change` finds how much what sensors read would change.
    pub(super) fn settle(
        &mut self,
        number: usize,
        equations: impl FnOnce() -> Option<System>,
        change: impl Fn(&LeftOver, &[f64]) -> Vec<ToldReading>,
    ) {
        if self.left_over.is_empty() {
            return;
        }
        let enough = self.report.enough();
        let found = equations().map(|mut system| system.imbalances(&self.left_over, enough));
        let found = found.unwrap_or_else(|| vec![None; self.left_over.len()]);
        for (state, displacement) in self.left_over.drain(..).zip(found) {
            let Some(displacement) = displacement else {
                self.report.note_imbalance(f64::INFINITY);
                continue;
            };
            self.report.note_imbalance(largest(&displacement));
            self.report.note_changes(change(&state, &displacement));
            self.lacking.push(Arc::new(Lacking { phase: number, displacement }));
        }
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
