//! What a run by a reduced model knows of its error: what the model leaves over is kept now and then, and how far that would
//! move the body is found once somebody asks, as it takes a factorization with all unknowns.

use std::sync::{Mutex, MutexGuard, PoisonError};

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
    /// Of all phases, if somebody wants them.
    lacking: Option<Vec<Lacking>>,
}

impl ReducedChecks {
    /// At the start of a run by `model`, which keeps the displacements that it lacks or not.
    pub(super) fn new(model: &ReducedModel, keeps_lacking: bool) -> Self {
        let report = ReducedReport::new(model);
        Self { report, left_over: Vec::new(), lacking: keeps_lacking.then(Vec::new) }
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
            if let Some(lacking) = &mut self.lacking {
                lacking.push(Lacking { phase: number, displacement });
            }
        }
    }

    /// Forgets what is not known yet, as a run goes back from its phase to the earlier one `number`, and what was lacking from
    /// that on, as it is run again.
    pub(super) fn go_back(&mut self, number: usize) {
        self.left_over.clear();
        self.lacking.iter_mut().for_each(|all| all.retain(|lacking| lacking.phase < number));
    }

    /// The displacements that were lacking, at the end; none unless they were kept.
    pub(super) fn take_lacking(&mut self) -> Vec<Lacking> {
        self.lacking.take().unwrap_or_default()
    }
}

/// The checks, whatever has happened to others who looked at them.
pub(super) fn locked(checks: &Mutex<ReducedChecks>) -> MutexGuard<'_, ReducedChecks> {
    checks.lock().unwrap_or_else(PoisonError::into_inner)
}
