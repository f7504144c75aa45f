//! Reduced models without a run of all unknowns: the first shapes come from loads, free vibrations and their derivatives,
//! the others from runs by the model and their residuals. Their error is estimated by these runs.
//!
//! First shapes (`dynamics/system/expected.rs`) are equilibria as the loads grow, displacements of each load
//! by the tangents at rest, the lowest vibrations, as large as the loads make them, and modal derivatives of
//! the ten largest, from second differences of the forces of cells; POD orders them by size. A run by the
//! model keeps the displacements that would balance its residual (`Trajectory::lacking`), the largest of
//! which are the next shapes. The search ends with two successive models whose runs are near to each other, as a small
//! error of a frequency grows with time, which no single state shows. Runs by the last one then replace
//! full ones.

use std::ops::ControlFlow;
use std::time::Instant;

use super::error::distance;
use super::learn::{LearnedPhase, Undeformed, equilibria, expected};
use super::runs::{ByModel, run_by};
use super::{
    Kit, Reduced, SIZES, Training, Tried, check, learn_from, learned, no_shape, size_limits,
};
use crate::base::input::InputError;
use crate::base::vector::largest;
use crate::dynamics::error::Error;
use crate::dynamics::system::MissingDisplacement;
use crate::dynamics::trajectory::Trajectory;
use crate::scene::ReducedModel;
use crate::scene::timeline::Scene;

/// Finds reduced models of growing size without a run of all unknowns, and returns the smallest one whose own runs tell an error that is
/// small enough: an estimate, which [`verify`](super::verify) holds against a run with all unknowns.
///
/// The first shapes are the equilibria under the loads, the free vibrations, and the modal derivatives of these (S. Idelsohn, A. Cardona,
/// Comput. Methods Appl. Mech. Engng 49 (1985) 253-279); of a body with linear strain whose nodes are moved these are the modes of
/// R. Craig and M. Bampton (AIAA J. 6 (1968) 1313-1319). To them come the displacements that would balance what runs by the model leave
/// over, until two of these models in a row are as near to each other as is wanted, and tell no larger error; then the shapes of the runs by the
/// last one, as few as will do. `observer` is as that of [`reduce`](super::reduce).
///
/// ```
/// use pliant::reduce::{Training, reduce_by_modes};
/// use pliant::{SceneFile, Settings};
/// use std::ops::ControlFlow;
///
/// let file = SceneFile::read("scenes/beam-bend-cauchy.toml")?;
/// let training = Training {
///     scenes: vec![file.scene],
///     held_out: Vec::new(),
///     settings: file.settings,
///     within: 0.05,
///     most_unknowns: 24,
/// };
/// let found = reduce_by_modes(&training, &mut |_| ControlFlow::Continue(()))?;
/// assert!(found.is_within && found.model.is_estimate(), "{found}");
/// # Ok::<(), pliant::Error>(())
/// ```
///
/// # Errors
/// As [`reduce`](super::reduce); no model that runs to the end.
pub fn reduce_by_modes(
    training: &Training,
    observer: &mut dyn FnMut(&str) -> ControlFlow<()>,
) -> Result<Reduced, Error> {
    let clock = Instant::now();
    check(training)?;
    let wanted = training.within;
    let mut enrichment =
        Enrichment { training, kit: Kit::new(training, 0.0)?, tried: Vec::new(), observer };
    let Seen { model: rich, runs } = enrichment.enriched()?;
    let mut tried = enrichment.tried;

    // the smallest model as accurate as this one, by both estimates
    let left = training.within - rich.error;
    let within = if left > 0.0 { left } else { training.within };
    let training = Training { within, ..training.clone() };
    let (mut model, smaller) = learn_from(&training, &runs, observer)?;
    let to_told = |error: f64| error + rich.error;
    let told = |own: Tried| Tried { error: to_told(own.error), ..own };
    tried.extend(smaller.into_iter().map(told));
    // residuals of its runs must show all of its error
    let all = to_told(model.error);
    let is_larger = model.error > 0.0 && model.error_per_imbalance > 0.0;
    model.error_per_imbalance *= if is_larger { all / model.error } else { 0.0 };
    model.error_per_imbalance = model.error_per_imbalance.max(1.0);
    model.error = all;
    (model.within, model.is_estimate) = (wanted, true);
    model.learned_from = learned(training.scenes.len(), " by richer models");
    let body = training.scenes[0].body();
    Ok(Reduced {
        is_within: model.error <= wanted,
        model,
        tried,
        full_seconds: None,
        training_seconds: clock.elapsed().as_secs_f64(),
        full: [body.dofs(), body.mesh().cell_count()],
    })
}

/// Multiple of the distance from the runs by the model before that an error is taken for: models of which each is off by two
/// thirds of what the one before is off by have it.
const TIMES_APART: f64 = 2.0;

/// A model with the runs by it.
#[derive(Clone)]
struct Seen {
    model: ReducedModel,
    /// Each with the time (s) that it took.
    runs: Vec<(Trajectory, f64)>,
}

/// Models that are enriched by their missing displacements.
struct Enrichment<'a> {
    training: &'a Training,
    kit: Kit<'a>,
    tried: Vec<Tried>,
    observer: &'a mut dyn FnMut(&str) -> ControlFlow<()>,
}

impl Enrichment<'_> {
    /// The best of models to which shapes are added that their own runs lack, with all cells.
    fn enriched(&mut self) -> Result<Seen, Error> {
        let Training { scenes, within, most_unknowns, .. } = self.training;
        let numbers = 0..scenes[0].phases().len();
        let equations = numbers.map(|number| Undeformed::new(&scenes[0], number));
        let mut equations = equations.collect::<Result<Vec<_>, Error>>()?;
        let mut phases = expected_phases(scenes, &mut equations, *most_unknowns)?;
        let [least, most] = size_limits(&phases, *most_unknowns)?;
        let after = |count: usize| SIZES.into_iter().find(|size| *size > count && *size >= least);
        let first = after(0).map_or(most, |size| size.min(*most_unknowns));
        let mut counts: Vec<usize> = phases.iter().map(|phase| phase.count(first)).collect();
        let (mut last, mut best): (Option<Seen>, Option<Seen>) = (None, None);
        let mut failure = None;
        loop {
            let model = self.kit.model(&phases, &counts, 0.0)?;
            let found = self.run(model, last.as_ref(), &mut failure)?;
            let lacking = found.iter().flat_map(|seen| seen.runs.iter().take(scenes.len()));
            let lacking: Vec<MissingDisplacement> =
                lacking.flat_map(|(run, _)| run.lacking.clone()).collect();
            let error =
                |seen: &Option<Seen>| seen.as_ref().map_or(f64::INFINITY, |seen| seen.model.error);
            let is_enough = error(&found) <= *within;
            if error(&found) <= error(&best) {
                best.clone_from(&found);
            }
            last = found;
            if is_enough {
                break;
            }
            let before = counts.clone();
            let unknowns = counts.iter().copied().max().unwrap_or(0);
            let next = after(unknowns).unwrap_or(*most_unknowns).min(*most_unknowns);
            for (number, count) in counts.iter_mut().enumerate() {
                let own = lacking.iter().filter(|lacking| lacking.phase == number);
                let own: Vec<Vec<f64>> = own.map(|lacking| lacking.displacement.clone()).collect();
                // a failed run has no information: use more of the expected shapes
                if !own.is_empty() {
                    let added = next.saturating_sub(*count);
                    phases[number].grow(&mut equations[number], *count, own, added);
                }
                *count = phases[number].count(next);
            }
            if counts == before {
                break;
            }
        }
        let Some(best) = best else {
            return Err(failure.unwrap_or_else(|| no_shape(*most_unknowns)));
        };
        if best.model.error.is_infinite() {
            let help = "two models in a row tell the error, and it allows one alone: give more";
            return Err(InputError::new("most unknowns", most_unknowns, help).into());
        }
        Ok(best)
    }

    /// Runs all scenes by a model; none where one fails. Its error is the estimate of these runs, or twice their distance from those by the model
    /// `before`, if that is more: small errors of a frequency, which no state shows, grow with time.
    fn run(
        &mut self,
        mut model: ReducedModel,
        before: Option<&Seen>,
        failure: &mut Option<Error>,
    ) -> Result<Option<Seen>, Error> {
        let Training { scenes, held_out, settings, .. } = self.training;
        let mut runs = Vec::new();
        let what = format!("{} unknowns", model.unknowns());
        let see = |_: usize, run: Option<(Trajectory, f64)>| match run {
            Some(run) => {
                runs.push(run);
                ControlFlow::Continue(())
            }
            None => ControlFlow::Break(()),
        };
        let all = scenes.iter().chain(held_out);
        let found = run_by(&model, all, settings, &mut || (self.observer)(&what), see)?;
        let ByModel { lengths: [imbalance, travel], seconds, problem } = found;
        if problem.is_some() {
            *failure = problem;
            return Ok(None);
        }
        let told = if imbalance > 0.0 { imbalance / travel } else { 0.0 };
        let apart = before.map_or(f64::INFINITY, |before| {
            let pairs = before.runs.iter().zip(&runs);
            let apart = pairs.map(|((before, _), (run, _))| distance(before, run));
            apart.fold(0.0, f64::max) / travel
        });
        let error = told.max(TIMES_APART * apart);
        let (unknowns, cells) = (model.unknowns(), model.cells());
        self.tried.push(Tried { unknowns, cells, error, told, seconds });
        (model.error, model.travel, model.is_estimate) = (error, travel, true);
        Ok(Some(Seen { model, runs }))
    }
}

/// All phases, with their `equations` at rest, and the shapes that are expected of them.
fn expected_phases(
    scenes: &[Scene],
    equations: &mut [Undeformed],
    most: usize,
) -> Result<Vec<LearnedPhase>, Error> {
    let numbers = 0..scenes[0].phases().len();
    let at_rest =
        |scene: &Scene| numbers.clone().flat_map(|number| equilibria(scene, number)).collect();
    let at_rest: Vec<Vec<Vec<f64>>> = scenes.iter().map(at_rest).collect();
    let of_phase = |number: usize, equations: &mut Undeformed| {
        let mut vibrations = None;
        // the motion of one phase is reversed by another one
        let mut motions = at_rest.concat();
        for (scene, at_rest) in scenes.iter().zip(&at_rest) {
            let farthest = at_rest.iter().map(|u| largest(u)).fold(0.0, f64::max);
            let most = Some(farthest).filter(|most| *most > 0.0);
            motions.extend(expected((scene, number), most, &mut vibrations)?);
        }
        LearnedPhase::new((&scenes[0], number), equations, &[], &motions, most)
    };
    let each = numbers.clone().zip(equations);
    each.map(|(number, equations)| of_phase(number, equations)).collect()
}
