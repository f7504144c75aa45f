//! Reduced models: a scene in a few unknowns, learned from runs of all of them, with the error that this makes.
//!
//! The shapes are a proper orthogonal decomposition of the displacements in these runs, phase by phase (L. Sirovich,
//! Quart. Appl. Math. 45 (1987) 561-571); of bodies that nothing holds they contain all linear displacements and, in the
//! plane, each shape turned by a quarter: so the body may turn by any angle. The cells are found by energy-conserving
//! sampling and weighting (`scene/reduced_model.rs`).

mod alike;
mod error;
mod learn;
mod sample;
mod told;
#[cfg(feature = "sweep")]
mod varied;
mod verified;

use std::collections::BTreeMap;
use std::time::Instant;

use alike::differing_part;
pub use error::error;
use error::{distance, travel};
use learn::LearnedPhase;
#[cfg(feature = "sweep")]
pub use varied::{VariedKey, words};
pub use verified::{Verified, verify};

use crate::base::input::{InputError, positive};
use crate::dynamics::error::Error;
use crate::dynamics::simulate::Sampling;
use crate::dynamics::trajectory::Trajectory;
use crate::elements::body::ByCell;
use crate::integrators::ode::Failure;
use crate::scene::ReducedModel;
use crate::scene::settings::Settings;
use crate::scene::timeline::Scene;

/// What a reduced model is learned from, and how good it is to be.
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
    /// The smallest model within what was wanted, or else the best one.
    pub model: ReducedModel,
    /// Whether it is within what was wanted.
    pub is_within: bool,
    /// What was tried, from the smallest one.
    pub tried: Vec<Tried>,
    /// Time (s) that a full run takes, the mean of those that were checked with.
    pub full_seconds: f64,
    /// Time (s) that all of it has taken.
    pub training_seconds: f64,
    /// Unknowns and cells of the full model.
    pub full: [usize; 2],
}

/// A model that was tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tried {
    /// Its unknowns.
    pub unknowns: usize,
    /// Number of cells whose forces it computes; 0 where all forces of cells are linear.
    pub cells: usize,
    /// Largest error of a displacement, relative to the largest displacement in all runs; infinite where a run failed.
    pub error: f64,
    /// The error that the runs themselves told (the largest one).
    pub told: f64,
    /// Time (s) of a run, the mean of all that it was checked with; no number where all failed.
    pub seconds: f64,
}

/// Numbers of unknowns that are tried.
const SIZES: [usize; 10] = [4, 6, 8, 12, 16, 24, 32, 48, 64, 96];

/// Samples of a run.
const SAMPLES: f64 = 200.0;

/// Parts of the error that is wanted by which the work of the sampled cells may differ from that of all: at first, and where
/// more shapes do not help at last.
const OF_CELLS: [f64; 2] = [0.03, 1e-4];

/// Part of an error to which another model has to come for more shapes to have helped.
const HELPED: f64 = 0.7;

/// Multiple of the error with all cells up to which it is the shapes that are too few, and not the cells.
const OF_SHAPES: f64 = 2.0;

/// Learns reduced models of growing size, and returns the smallest one that is good enough. `observer` is told what is
/// being done, in a few words.
///
/// # Errors
/// No scene to learn from, scenes that differ in their bodies or phases, what a reduced model cannot have; a training run
/// that fails.
pub fn reduce(training: &Training, observer: &mut dyn FnMut(&str)) -> Result<Reduced, Error> {
    let clock = Instant::now();
    check(training)?;
    let Training { scenes, held_out, settings, within, most_unknowns } = training;
    let mut full = |scenes: &[Scene], what: &str| -> Result<Vec<(Trajectory, f64)>, Error> {
        let mut runs = Vec::new();
        for (k, scene) in scenes.iter().enumerate() {
            observer(&format!("{what} {} of {}", k + 1, scenes.len()));
            runs.push(timed(scene, settings)?);
        }
        Ok(runs)
    };
    let learned_from = full(scenes, "training run")?;
    let held_out = full(held_out, "run to check with")?;
    let checks: Vec<(Trajectory, f64)> = learned_from.into_iter().chain(held_out).collect();
    let runs: Vec<&Trajectory> = checks[..scenes.len()].iter().map(|(run, _)| run).collect();

    observer("shapes");
    let body = scenes[0].body();
    let numbers = 0..scenes[0].phases().len();
    let phases: Result<Vec<LearnedPhase>, Error> =
        numbers.map(|number| LearnedPhase::new(&runs, number, *most_unknowns)).collect();
    let phases = phases?;
    let most = phases.iter().map(LearnedPhase::most).max().unwrap_or(0);
    if most == 0 {
        let help = "nothing moves in the training runs: there is nothing to learn";
        return Err(InputError::new("training runs", "at rest", help).into());
    }
    let way = checks.iter().map(|(run, _)| travel(run)).fold(0.0, f64::max);
    let least = phases.iter().map(LearnedPhase::least).max().unwrap_or(0);
    if least > *most_unknowns {
        let help = format!("a body that nothing holds needs {least} at least");
        return Err(InputError::new("most unknowns", most_unknowns, help).into());
    }
    let by_cell = body.elastic().map(|elastic| elastic.by_cell(body.mesh()));
    let mut tolerance = OF_CELLS[0] * within;
    let mut tried: Vec<Tried> = Vec::new();
    let mut best: Option<ReducedModel> = None;
    let mut failure = None;
    for size in
        SIZES.into_iter().chain([most]).filter(|size| (least..=*most_unknowns).contains(size))
    {
        let counts: Vec<usize> = phases.iter().map(|phase| phase.count(size)).collect();
        let unknowns = counts.iter().copied().max().unwrap_or(0);
        if tried.iter().any(|tried| tried.unknowns >= unknowns) {
            continue;
        }
        let mut of_all_cells = None;
        loop {
            observer(&format!("{unknowns} unknowns"));
            let model = model(training, &phases, &counts, by_cell.as_ref(), [tolerance, way])?;
            let has_all = model.cells() == 0 || model.cells() == model.cell_count;
            let (model, found) = checked(model, &checks, settings);
            tried.push(found.tried);
            failure = found.problem.or(failure);
            let before = best.as_ref().map_or(f64::INFINITY, |best| best.error);
            let error = model.error;
            if error < before {
                best = Some(model);
            }
            if error <= *within || error < HELPED * before || has_all {
                break;
            }
            // more shapes do not help: are the cells too few?
            let with_all = of_all_cells.get_or_insert_with(|| {
                let worst = &checks[found.worst..=found.worst];
                let all = self::model(training, &phases, &counts, by_cell.as_ref(), [0.0, way]);
                all.map_or(f64::INFINITY, |all| checked(all, worst, settings).0.error)
            });
            if error <= OF_SHAPES * *with_all {
                break;
            }
            let least = OF_CELLS[1] * within;
            tolerance = if tolerance > least { 0.1 * tolerance } else { 0.0 };
        }
        tolerance = tolerance.max(OF_CELLS[1] * within);
        if best.as_ref().is_some_and(|best| best.error <= *within) {
            break;
        }
    }
    let Some(model) = best else {
        // no model could be run to the end
        if let Some(problem) = failure {
            return Err(problem);
        }
        let help = "it allows no shape: give more";
        return Err(InputError::new("most unknowns", most_unknowns, help).into());
    };
    Ok(Reduced {
        is_within: model.error <= *within,
        model,
        tried,
        full_seconds: mean(checks.iter().map(|(_, seconds)| *seconds)),
        training_seconds: clock.elapsed().as_secs_f64(),
        full: [body.dofs(), body.mesh().cell_count()],
    })
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
    if !first.growths().is_empty() {
        let help = "cells that grow cannot be reduced yet: run the scene unreduced";
        return Err(InputError::new("number of growths", first.growths().len(), help));
    }
    for scene in scenes.iter().chain(held_out) {
        scene.validate()?;
        if let Some(part) = differing_part(first, scene)? {
            let help = "all have the body of the first one, and hold and move the same nodes: vary signals and loads";
            return Err(InputError::new("training scenes", format!("with other {part}"), help));
        }
    }
    Ok(())
}

/// A run with the samples that models are learned from and checked by, and the time (s) that it takes.
fn timed(scene: &Scene, settings: &Settings) -> Result<(Trajectory, f64), Error> {
    let clock = Instant::now();
    let run = scene.simulate(settings, &Sampling::every(scene.end() / SAMPLES))?;
    Ok((run, clock.elapsed().as_secs_f64()))
}

/// A model of so many shapes of each phase, not checked yet.
fn model(
    training: &Training,
    phases: &[LearnedPhase],
    counts: &[usize],
    by_cell: Option<&ByCell>,
    [tolerance, travel]: [f64; 2],
) -> Result<ReducedModel, Error> {
    let body = training.scenes[0].body();
    let cells = match by_cell {
        Some(by_cell) if tolerance > 0.0 => sample::weights(by_cell, phases, counts, tolerance)?,
        Some(_) => (0..body.mesh().cell_count()).map(|cell| (cell, 1.0)).collect(),
        None => BTreeMap::new(),
    };
    let runs = training.scenes.len();
    Ok(ReducedModel {
        dofs: body.dofs(),
        cell_count: body.mesh().cell_count(),
        phases: phases.iter().zip(counts).map(|(phase, &count)| phase.reduced(count)).collect(),
        cells,
        travel,
        error: f64::INFINITY,
        within: training.within,
        error_per_imbalance: 1.0,
        learned_from: format!("{runs} run{}", if runs == 1 { "" } else { "s" }),
    })
}

/// What the runs of a model have shown.
struct Found {
    tried: Tried,
    /// The check with the largest error.
    worst: usize,
    /// Why a run failed, if one did.
    problem: Option<Error>,
}

/// A model with its errors in the runs that it is checked with.
fn checked(
    mut model: ReducedModel,
    checks: &[(Trajectory, f64)],
    settings: &Settings,
) -> (ReducedModel, Found) {
    let (mut error, mut worst, mut problem) = (0.0_f64, 0, None);
    let (mut per_imbalance, mut imbalance, mut seconds) = (0.0_f64, 0.0_f64, Vec::new());
    for (number, (full, _)) in checks.iter().enumerate() {
        let run = full.scene().clone().reduced(model.clone()).map_err(Error::from);
        let own = match run.and_then(|scene| timed(&scene, settings)) {
            Ok((run, time)) => {
                let own = distance(full, &run) / model.travel;
                let told = run.report().reduced.as_ref().map_or(0.0, |run| run.imbalance());
                imbalance = imbalance.max(told);
                if told > 0.0 {
                    per_imbalance = per_imbalance.max(own / told);
                }
                seconds.push(time);
                own
            }
            Err(failed) => {
                problem = Some(failed);
                f64::INFINITY
            }
        };
        if own > error {
            (error, worst) = (own, number);
        }
    }
    let tried = Tried {
        unknowns: model.unknowns(),
        cells: model.cells(),
        error,
        told: imbalance * per_imbalance,
        seconds: mean(seconds.into_iter()),
    };
    (model.error, model.error_per_imbalance) = (error, per_imbalance);
    (model, Found { tried, worst, problem })
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.collect();
    values.iter().sum::<f64>() / values.len() as f64
}

/// The error of forces that have no meaning in a state as few shapes have it.
fn undefined(failure: Failure) -> Error {
    let help =
        "few shapes turn a cell inside out there: train with smaller motions, or with more of them";
    InputError::new("training state", failure.into_error(), help).into()
}
