//! Reduced models: a scene in a few unknowns, learned from runs of all of them, with its error.
//!
//! The shapes are a proper orthogonal decomposition of the displacements in these runs, phase by phase (L. Sirovich,
//! Quart. Appl. Math. 45 (1987) 561-571); of bodies that nothing holds they contain all linear displacements and, in the
//! plane, each shape rotated by a quarter turn: so the body may rotate by any angle. The cells are found by energy-conserving
//! sampling and weighting (`scene/reduced_model.rs`).

mod alike;
mod by_modes;
mod error;
mod learn;
mod runs;
mod sample;
mod told;
#[cfg(feature = "sweep")]
mod varied;
mod verified;

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use alike::differing_part;
pub use by_modes::reduce_by_modes;
pub use error::error;
use error::{distance, travel};
use learn::{LearnedPhase, Undeformed};
use runs::{ByModel, SAMPLES, mean, run_by, timed};
#[cfg(feature = "study")]
pub(crate) use told::pays_from;
#[cfg(feature = "sweep")]
pub use varied::{VariedKey, words};
pub use verified::{Verified, verify};

use crate::base::input::{InputError, positive};
use crate::dynamics::error::Error;
use crate::dynamics::trajectory::Trajectory;
use crate::elements::body::{ByCell, Elastic};
use crate::integrators::ode::Failure;
use crate::scene::ReducedModel;
use crate::scene::reduced_model::LearnedKey;
use crate::scene::settings::Settings;
use crate::scene::timeline::Scene;

/// Training data of a reduced model, and its required accuracy.
#[derive(Debug, Clone)]
pub struct Training {
    /// The scenes that are run with all unknowns: the same body and phases, under other signals and loads.
    pub scenes: Vec<Scene>,
    /// Scenes that are not learned from, but that models are checked with, as they are with those above.
    pub held_out: Vec<Scene>,
    /// Method and tolerances of all runs.
    pub settings: Settings,
    /// Largest error of a displacement that is wanted, relative to the largest displacement in all of these runs.
    pub within: f64,
    /// Most unknowns of a model.
    pub most_unknowns: usize,
}

/// A reduced model with all that were tried.
#[derive(Debug, Clone)]
pub struct Reduced {
    /// The smallest model within the requested error, or else the best one.
    pub model: ReducedModel,
    /// Whether it is within the requested error.
    pub is_within: bool,
    /// Models that were tried, from the smallest one.
    pub tried: Vec<Tried>,
    /// Time (s) that a full run takes, the mean of those that were checked with; none where there was none.
    pub full_seconds: Option<f64>,
    /// Total time (s).
    pub training_seconds: f64,
    /// Unknowns and cells of the full model.
    pub full: [usize; 2],
}

/// A model that was tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tried {
    /// Its unknowns.
    pub unknowns: usize,
    /// Number of cells whose forces it computes; 0 where these are exact along the shapes.
    pub cells: usize,
    /// Largest error of a displacement, relative to the largest displacement in all runs; infinite where a run failed. With no run
    /// of all unknowns it is the largest one to runs by the model before, or by a richer one.
    pub error: f64,
    /// The largest error estimated by the runs themselves.
    pub told: f64,
    /// Time (s) of a run, the mean of all that it was checked with; no number where all failed.
    pub seconds: f64,
}

/// Numbers of unknowns that are tried.
const SIZES: [usize; 10] = [4, 6, 8, 12, 16, 24, 32, 48, 64, 96];

/// Fractions of the requested error by which the work of the sampled cells may differ from that of all: at first, and
/// where more shapes no longer reduce the error.
const OF_CELLS: [f64; 2] = [0.03, 1e-4];

/// Part of an error to which another model has to come for more shapes to have helped.
const HELPED: f64 = 0.7;

/// Multiple of the error with all cells up to which it is the shapes that are too few, and not the cells.
const OF_SHAPES: f64 = 2.0;

/// Learns reduced models of growing size, and returns the smallest one that is good enough. `observer` gets a short
/// description of the current task after each step of a run, and ends it all by [`ControlFlow::Break`].
///
/// # Errors
/// No scene to learn from, scenes that differ in their bodies or phases, unsupported features of reduced models; a training run
/// that fails, or that the observer has ended.
pub fn reduce(
    training: &Training,
    observer: &mut dyn FnMut(&str) -> ControlFlow<()>,
) -> Result<Reduced, Error> {
    let clock = Instant::now();
    check(training)?;
    let Training { scenes, held_out, settings, .. } = training;
    let mut checks = Vec::new();
    for (scenes, what) in [(scenes, "training run"), (held_out, "run to check with")] {
        for (k, scene) in scenes.iter().enumerate() {
            let what = format!("{what} {} of {}", k + 1, scenes.len());
            checks.push(timed(scene, settings, SAMPLES, &mut || observer(&what))?);
        }
    }
    let (model, tried) = learn_from(training, &checks, observer)?;
    let body = scenes[0].body();
    Ok(Reduced {
        is_within: model.error <= training.within,
        model,
        tried,
        full_seconds: Some(mean(checks.iter().map(|(_, seconds)| *seconds))),
        training_seconds: clock.elapsed().as_secs_f64(),
        full: [body.dofs(), body.mesh().cell_count()],
    })
}

/// The smallest model within the requested error, or else the best one, and all that were tried: learned from the first of some runs, as many as
/// there are scenes, and checked with all of them.
fn learn_from(
    training: &Training,
    checks: &[(Trajectory, f64)],
    observer: &mut dyn FnMut(&str) -> ControlFlow<()>,
) -> Result<(ReducedModel, Vec<Tried>), Error> {
    let Training { scenes, within, most_unknowns, .. } = training;
    let runs: Vec<&Trajectory> = checks[..scenes.len()].iter().map(|(run, _)| run).collect();
    let numbers = 0..scenes[0].phases().len();
    let phases: Result<Vec<LearnedPhase>, Error> = numbers
        .map(|number| {
            let mut at_rest = Undeformed::new(&scenes[0], number)?;
            LearnedPhase::new((&scenes[0], number), &mut at_rest, &runs, &[], *most_unknowns)
        })
        .collect();
    let phases = phases?;
    let [least, most] = size_limits(&phases, *most_unknowns)?;
    let mut search = Search {
        training,
        phases: &phases,
        checks,
        kit: Kit::new(training, checks.iter().map(|(run, _)| travel(run)).fold(0.0, f64::max))?,
        observer,
        tolerance: OF_CELLS[0] * within,
        tried: Vec::new(),
        best: None,
        failure: None,
    };
    let sizes = SIZES.into_iter().chain([most]);
    for size in sizes.filter(|size| (least..=*most_unknowns).contains(size)) {
        search.try_size(size)?;
        if search.best_error() <= *within {
            break;
        }
    }
    let Search { best, failure, tried, .. } = search;
    match best {
        Some(model) => Ok((model, tried)),
        // no model could be run to the end
        None => Err(failure.unwrap_or_else(|| no_shape(*most_unknowns))),
    }
}

/// Fewest and most unknowns of a model of these phases.
fn size_limits(phases: &[LearnedPhase], most_unknowns: usize) -> Result<[usize; 2], InputError> {
    let most = phases.iter().map(LearnedPhase::most).max().unwrap_or(0);
    if most == 0 {
        let help = "nothing moves in the training runs: there is nothing to learn";
        return Err(InputError::new("training runs", "at rest", help));
    }
    let least = phases.iter().map(LearnedPhase::least).max().unwrap_or(0);
    if least > most_unknowns {
        let help = format!("a body that nothing holds needs {least} at least");
        return Err(InputError::new("most unknowns", most_unknowns, help));
    }
    Ok([least, most])
}

/// The error of a number of unknowns that allows no shape.
fn no_shape(most_unknowns: usize) -> Error {
    InputError::new("most unknowns", most_unknowns, "it allows no shape: give more").into()
}

/// Training runs of a model, in words.
fn learned(runs: usize, by: &str) -> String {
    format!("{runs} run{}{by}", if runs == 1 { "" } else { "s" })
}

/// Data from which models are built.
struct Kit<'a> {
    training: &'a Training,
    /// Sampled forces in each phase: the elasticity of cells that do not grow there, and all viscosity, cell by cell, too.
    sampled: Vec<Option<Arc<(Elastic, ByCell)>>>,
    /// Largest displacement (m) in the checks.
    travel: f64,
}

impl<'a> Kit<'a> {
    /// # Errors
    /// Cells that cannot grow.
    fn new(training: &'a Training, travel: f64) -> Result<Self, InputError> {
        let scene = &training.scenes[0];
        let body = scene.body();
        let (mut sampled, mut known) = (Vec::new(), None);
        for phase in scene.phases() {
            let cells = scene.growing_cells(phase)?;
            let own = match known.take() {
                Some((same, own)) if same == cells => own,
                _ => body.elastic_outside(&cells).map(|elastic| {
                    let by_cell = elastic.by_cell(body.mesh());
                    Arc::new((elastic, by_cell))
                }),
            };
            sampled.push(own.clone());
            known = Some((cells, own));
        }
        Ok(Self { training, sampled, travel })
    }

    /// A model of so many shapes of each phase, not checked yet, with cells that do the work of all to a `tolerance`.
    fn model(
        &self,
        phases: &[LearnedPhase],
        counts: &[usize],
        tolerance: f64,
    ) -> Result<ReducedModel, Error> {
        let Self { training, sampled, travel } = self;
        let body = training.scenes[0].body();
        let shapes =
            phases.iter().zip(counts).map(|(phase, count)| count + phase.lifts.len()).max();
        let mut all = sampled.iter().flatten();
        let cells = if all.all(|own| own.0.has_strain_modes(shapes.unwrap_or(0))) {
            BTreeMap::new()
        } else if tolerance > 0.0 {
            let by_cell: Vec<_> =
                sampled.iter().map(|own| own.as_ref().map(|own| &own.1)).collect();
            sample::weights(&by_cell, phases, counts, tolerance)?
        } else {
            (0..body.mesh().cell_count()).map(|cell| (cell, 1.0)).collect()
        };
        let seen = training.scenes.iter().chain(&training.held_out);
        let written: Vec<_> = seen.map(Scene::written_keys).collect();
        Ok(ReducedModel {
            dofs: body.dofs(),
            cell_count: body.mesh().cell_count(),
            phases: phases.iter().zip(counts).map(|(phase, &count)| phase.reduced(count)).collect(),
            cells,
            travel: *travel,
            error: f64::INFINITY,
            within: training.within,
            error_per_imbalance: 1.0,
            is_estimate: false,
            runs: training.scenes.len(),
            learned_from: learned(training.scenes.len(), ""),
            learned_keys: LearnedKey::of(&written),
        })
    }
}

/// The tried models, from the training data.
struct Search<'a> {
    training: &'a Training,
    phases: &'a [LearnedPhase],
    checks: &'a [(Trajectory, f64)],
    kit: Kit<'a>,
    observer: &'a mut dyn FnMut(&str) -> ControlFlow<()>,
    /// Part by which the work of the sampled cells may differ from that of all.
    tolerance: f64,
    tried: Vec<Tried>,
    best: Option<ReducedModel>,
    failure: Option<Error>,
}

impl Search<'_> {
    fn best_error(&self) -> f64 {
        self.best.as_ref().map_or(f64::INFINITY, |best| best.error)
    }

    /// Tries models of `size` unknowns, with more and more cells as long as these are too few.
    fn try_size(&mut self, size: usize) -> Result<(), Error> {
        let within = self.training.within;
        let counts: Vec<usize> = self.phases.iter().map(|phase| phase.count(size)).collect();
        let unknowns = counts.iter().copied().max().unwrap_or(0);
        if self.tried.iter().any(|tried| tried.unknowns >= unknowns) {
            return Ok(());
        }
        let what = format!("{unknowns} unknowns");
        let mut of_all_cells = None;
        loop {
            let model = self.kit.model(self.phases, &counts, self.tolerance)?;
            let has_all = model.cells() == 0 || model.cells() == model.cell_count;
            let (model, found) = self.checked(model, self.checks, &what)?;
            self.tried.push(found.tried);
            self.failure = found.problem.or(self.failure.take());
            let before = self.best_error();
            let error = model.error;
            if error < before {
                self.best = Some(model);
            }
            if error <= within || error < HELPED * before || has_all {
                break;
            }
            // more shapes do not help: are the cells too few?
            let with_all = match of_all_cells {
                Some(known) => known,
                None => {
                    let worst = &self.checks[found.worst..=found.worst];
                    let all = self.kit.model(self.phases, &counts, 0.0)?;
                    self.checked(all, worst, &what)?.0.error
                }
            };
            of_all_cells = Some(with_all);
            if error <= OF_SHAPES * with_all {
                break;
            }
            let least = OF_CELLS[1] * within;
            self.tolerance = if self.tolerance > least { 0.1 * self.tolerance } else { 0.0 };
        }
        self.tolerance = self.tolerance.max(OF_CELLS[1] * within);
        Ok(())
    }

    /// A model with its errors in the runs that it is checked with.
    ///
    /// # Errors
    /// Runs that the observer has ended; others that fail have an infinite error.
    fn checked(
        &mut self,
        mut model: ReducedModel,
        checks: &[(Trajectory, f64)],
        what: &str,
    ) -> Result<(ReducedModel, ModelChecks), Error> {
        let (mut error, mut worst) = (0.0_f64, 0);
        let (mut per_imbalance, mut imbalance) = (0.0_f64, 0.0_f64);
        let scenes = checks.iter().map(|(full, _)| full.scene());
        let settings = &self.training.settings;
        let see = |number: usize, run: Option<(Trajectory, f64)>| {
            let own = run.map_or(f64::INFINITY, |(run, _)| {
                let own = distance(&checks[number].0, &run) / model.travel;
                let told = run.report().reduced.as_ref().map_or(0.0, |run| run.imbalance());
                imbalance = imbalance.max(told);
                if told > 0.0 && told.is_finite() {
                    per_imbalance = per_imbalance.max(own / told);
                }
                own
            });
            if own > error {
                (error, worst) = (own, number);
            }
            ControlFlow::Continue(())
        };
        let found = run_by(&model, scenes, settings, &mut || (self.observer)(what), see)?;
        let ByModel { seconds, problem, .. } = found;
        let (unknowns, cells) = (model.unknowns(), model.cells());
        let tried = Tried { unknowns, cells, error, told: imbalance * per_imbalance, seconds };
        (model.error, model.error_per_imbalance) = (error, per_imbalance);
        Ok((model, ModelChecks { tried, worst, problem }))
    }
}

/// Results of the runs of a model.
struct ModelChecks {
    tried: Tried,
    /// The check with the largest error.
    worst: usize,
    /// Reason of a failed run, if there was one.
    problem: Option<Error>,
}

fn check(training: &Training) -> Result<(), InputError> {
    let Training { scenes, held_out, settings, within, most_unknowns } = training;
    let Some(first) = scenes.first() else {
        let help = "a reduced model is learned from one run at least: give a scene";
        return Err(InputError::new("number of training runs", 0, help));
    };
    positive("error that is wanted", *within, "of the largest displacement")?;
    if *most_unknowns == 0 {
        return Err(InputError::new("most unknowns", 0, "a model has one at least"));
    }
    settings.validate()?;
    first.check_reducible()?;
    for scene in scenes.iter().chain(held_out) {
        scene.validate()?;
        scene.refuse_ends("a reduced model")?;
        if let Some(part) = differing_part(first, scene)? {
            let help = "all have the body of the first one, and hold and move the same nodes: vary signals and loads";
            return Err(InputError::new("training scenes", format!("with other {part}"), help));
        }
    }
    Ok(())
}

/// The error of forces that have no meaning in a state as few shapes have it.
fn undefined(failure: Failure) -> Error {
    let help =
        "few shapes turn a cell inside out there: train with smaller motions, or with more of them";
    InputError::new("training state", failure.into_error(), help).into()
}
