//! Error checks of a run by a reduced model: snapshots of its residual are stored at some times. The displacements that
//! balance them are computed on request only, as that takes a factorization with all unknowns.
//!
//! They are requested by the report or the end of a phase: a controller that reads sensors alone never waits
//! for them. Reactions of constraints are M u'' - f at the held nodes, with the forces of all cells and the
//! accelerations of the model.

use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::base::vector::largest;
use crate::dynamics::report::{ReducedReport, SensorErrorEstimate};
use crate::dynamics::system::{MissingDisplacement, ResidualSnapshot, System};
use crate::scene::reduced_model::ReducedModel;
use crate::scene::timeline::Scene;

/// Error report so far, and residual snapshots that are still to be evaluated.
#[derive(Clone)]
pub(super) struct ReducedChecks {
    pub(super) report: ReducedReport,
    /// Of the present phase.
    left_over: Vec<ResidualSnapshot>,
    /// Of all phases, if somebody wants them.
    lacking: Option<Vec<MissingDisplacement>>,
}

impl ReducedChecks {
    /// At the start of a run by `model`, which keeps the displacements that it lacks or not.
    pub(super) fn new(scene: &Scene, model: &ReducedModel, keeps_lacking: bool) -> Self {
        let report = ReducedReport::new(model, scene.written_keys());
        Self { report, left_over: Vec::new(), lacking: keeps_lacking.then(Vec::new) }
    }

    /// Keeps what is left over in a state whose largest displacement is `travel` (m).
    pub(super) fn keep(&mut self, left_over: ResidualSnapshot, travel: f64) {
        self.report.note_state(travel, left_over.outside);
        self.left_over.push(left_over);
    }

    /// Finds how far all that is left over would move the body, with the `equations` of the phase `number`; infinitely far without
    /// them. `change` finds how much what sensors read would change.
    pub(super) fn settle(
        &mut self,
        number: usize,
        equations: impl FnOnce() -> Option<System>,
        change: impl Fn(&ResidualSnapshot, &[f64]) -> Vec<SensorErrorEstimate>,
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
                lacking.push(MissingDisplacement { phase: number, displacement });
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
    pub(super) fn take_lacking(&mut self) -> Vec<MissingDisplacement> {
        self.lacking.take().unwrap_or_default()
    }
}

/// The checks, whatever has happened to others who looked at them.
pub(super) fn locked(checks: &Mutex<ReducedChecks>) -> MutexGuard<'_, ReducedChecks> {
    checks.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use super::*;
    use crate::reduce::{Training, reduce};
    use crate::{Body, Cells, Material, Mesh, Phase, Settings, Strain};

    /// Six states of each of two phases, however often they are run; none where nobody has asked.
    #[test]
    fn what_is_lacking_is_kept_for_the_last_way_alone() {
        let mesh = Mesh::rectangle([0.1, 0.02], [5, 2], Cells::Rectangles).unwrap();
        let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.4, viscosity: 100.0 };
        let body = Body::new(mesh, rubber).thickness(0.01).strain(Strain::Green).build().unwrap();
        let bent = Phase::until(0.1).named("bent").hold("left").load([10], [0.0, 0.02]);
        let scene = Scene::new(body).phase(bent).phase(Phase::until(0.2).hold("left"));
        let settings = Settings { rtol: 1e-4, ..Settings::default() };
        let training = Training {
            scenes: vec![scene.clone()],
            held_out: Vec::new(),
            settings: settings.clone(),
            within: 0.1,
            most_unknowns: 6,
        };
        let model = reduce(&training, &mut |_| ControlFlow::Continue(())).unwrap().model;
        let scene = scene.reduced(model.clone()).unwrap();
        for (is_asked, expected) in [(true, [6, 6]), (false, [0, 0])] {
            let mut strip = scene.start(&settings).unwrap();
            strip.run.reduced = Some(Mutex::new(ReducedChecks::new(&scene, &model, is_asked)));
            strip.advance_to(0.05).unwrap();
            let halfway = strip.checkpoint();
            for _ in 0..4 {
                strip.restore(&halfway).unwrap();
                strip.advance_to(0.2).unwrap();
            }
            let lacking = strip.into_trajectory().lacking;
            let of_phase = |phase| lacking.iter().filter(|own| own.phase == phase).count();
            assert!(lacking.len() <= expected.iter().sum(), "{}", lacking.len());
            assert_eq!(of_phase(1), expected[1]);
        }
    }
}
