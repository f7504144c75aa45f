//! The runs that derivatives are made of.

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::at_rest::Balanced;
use super::method::Method;
use super::number::{Number, set};
use super::objective::{self, Seen};
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::dynamics::phase::Failed;
use rayon::prelude::*;

use crate::dynamics::simulate::{Sampling, Simulation, StepList, Tape};
use crate::dynamics::system::DUAL_ERROR;
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::io::scene_file::{SceneFile, SceneReader};
use crate::scene::settings::{ContactEvents, Settings};
use crate::scene::timeline::Scene;
use crate::studies::fit::SceneFit;
use crate::studies::work_precision::Quantity;

/// A scene file, and the readings of its runs.
#[derive(Debug, Clone)]
pub(super) struct Runs {
    pub(super) reader: SceneReader,
    pub(super) text: String,
    pub(super) path: PathBuf,
    pub(super) overrides: Vec<String>,
    pub(super) target: Target,
}

/// An objective in a scene.
#[derive(Debug, Clone)]
pub(super) enum Target {
    Quantity(String),
    QuantityAtRest(String),
    LeastSquares(Box<SceneFit>),
}

/// The part of a run that others by other numbers need.
pub(super) enum Record {
    Steps(StepList),
    /// With the states after the steps, for the adjoint.
    States(StepList, Tape),
    Equilibrium(Box<Balanced>),
}

impl Record {
    fn steps(&self) -> Option<&StepList> {
        match self {
            Self::Steps(list) | Self::States(list, _) => Some(list),
            Self::Equilibrium(_) => None,
        }
    }
}

/// Reason for a missing derivative.
pub(super) enum Stop {
    /// The method is not one for this scene, and why.
    Unsuited(String),
    Failed(Error),
}

impl From<Error> for Stop {
    fn from(error: Error) -> Self {
        Self::Failed(error)
    }
}

/// A run without differences, at one tolerance.
pub(super) struct Base {
    pub(super) rtol: f64,
    pub(super) seen: Seen,
    pub(super) record: Option<Record>,
}

impl Base {
    /// The relative error of derivatives by what is recorded, beside that of differences and tolerances.
    pub(super) fn error(&self) -> f64 {
        match self.record {
            Some(Record::Equilibrium(_)) => DUAL_ERROR,
            _ => 0.0,
        }
    }
}

/// Which objectives are found by taking steps back.
pub(super) const AT_THE_END: &str = "adjoint gradients need a reading at the end";

/// Reason for which the steps of one run are not those of another.
pub(super) const OTHER_STEPS: &str = "a run with another value needs other steps";

/// Runs so far, and their steps.
#[derive(Default)]
pub(super) struct Costs {
    runs: AtomicUsize,
    pub(super) steps: AtomicUsize,
}

impl Costs {
    fn add(&self, steps: usize) {
        self.runs.fetch_add(1, Ordering::Relaxed);
        self.steps.fetch_add(steps, Ordering::Relaxed);
    }

    /// Adds the adjoint steps of a run, with so many scenes with other numbers: about three of them, and two fifths of a step for
    /// each scene (measured with a beam of some hundred triangles).
    pub(super) fn add_taken_back(&self, steps: usize, others: usize) {
        self.add(3 * steps + 2 * steps * others / 5);
    }

    /// Adds a dual solution, and scenes with other numbers, as an iteration each (measured with a strip of five cells of nine nodes).
    pub(super) fn add_linearized(&self, others: usize) {
        self.steps.fetch_add(1 + others, Ordering::Relaxed);
    }

    pub(super) fn runs(&self) -> usize {
        self.runs.load(Ordering::Relaxed)
    }
}

impl Runs {
    /// The end of the scene (s).
    pub(super) fn end(&self) -> f64 {
        let file = self.reader.parse_with(&self.text, &self.path, &self.overrides);
        file.map_or(f64::NAN, |file| file.scene.end())
    }

    /// The objective with another value for a number, by the steps of another run if its record has some; else with a record of its own.
    pub(super) fn observe(
        &self,
        other: Option<(&Number, f64)>,
        rtol: f64,
        method: Method,
        by: Option<&Record>,
        costs: &Costs,
    ) -> Result<(Seen, Option<Record>), Stop> {
        let mut own: Vec<String> =
            other.into_iter().map(|(number, value)| set(&number.key, value)).collect();
        if self.target.is_at_rest() {
            own.push(set("statics.rtol", rtol));
        }
        let read = || {
            self.reader.parse_with(&self.text, &self.path, &[&self.overrides[..], &own].concat())
        };
        let by = by.and_then(Record::steps);
        let mut record = None;
        let mut has_other_steps = false;
        let mut run = |file: &SceneFile, scene: &Scene, sampling: &Sampling| {
            let settings = settings(&file.settings, rtol, method);
            if method == Method::Differences {
                return scene.simulate(&settings, sampling);
            }
            let mut simulation = scene.start(&settings)?;
            simulation.record(sampling)?;
            let Some(by) = by else {
                if method == Method::Adjoint {
                    let (motion, list, tape) = simulation.finish_with_tape()?;
                    record = Some(Record::States(list, tape));
                    return Ok(motion);
                }
                let (motion, list) = simulation.finish_with_steps()?;
                record = Some(Record::Steps(list));
                return Ok(motion);
            };
            simulation.finish_by_steps(by)?.ok_or_else(|| {
                has_other_steps = true;
                InputError::new("steps", "others", OTHER_STEPS).into()
            })
        };
        let mut balanced = None;
        let seen = match &self.target {
            Target::Quantity(text) => read().and_then(|file| {
                let quantity = objective::quantity(text, &file, false)?;
                let sampling = objective::sampling(&quantity, &file);
                objective::seen(&quantity, &run(&file, &file.scene, &sampling)?)
            }),
            Target::QuantityAtRest(text) => read().and_then(|file| {
                let quantity = objective::quantity(text, &file, true)?;
                let mut found = file.equilibrium()?;
                found.read(&quantity.read_by(Sampling::phase_ends()))?;
                if method == Method::Adjoint {
                    balanced = Some(Balanced::new(&found, &quantity));
                }
                let seen = objective::seen(&quantity, &found.trajectory().at_end())?;
                Ok(Seen { steps: found.iterations, ..seen })
            }),
            Target::LeastSquares(fit) => {
                let mut count = 1;
                let mut counted = |file: &SceneFile, scene: &Scene, sampling: &Sampling| {
                    let motion: Trajectory = run(file, scene, sampling)?;
                    count = motion.report().steps();
                    Ok(motion)
                };
                let sum = fit.sum_of_squares(&own, &mut counted);
                sum.map(|sum| Seen { values: vec![sum], scale: sum, steps: count })
            }
        };
        match seen {
            _ if has_other_steps => Err(Stop::Unsuited(OTHER_STEPS.into())),
            Ok(seen) => {
                costs.add(seen.steps);
                if let Some(balanced) = balanced {
                    let balanced = balanced.map_err(|why| Stop::Unsuited(why.to_string()))?;
                    record = Some(Record::Equilibrium(Box::new(balanced)));
                }
                Ok((seen, record))
            }
            Err(error) => Err(Stop::Failed(error)),
        }
    }
}

impl Runs {
    /// The Lagrangian of the recorded steps or equilibrium for scenes with other values of numbers.
    ///
    /// # Errors
    /// Reason for which the adjoint of steps, or the dual of an equilibrium, is not available.
    pub(super) fn lagrangians(
        &self,
        base: &Base,
        others: &[(&Number, f64)],
        costs: &Costs,
    ) -> Result<Vec<f64>, String> {
        match (&self.target, &base.record) {
            (Target::Quantity(text), Some(Record::States(_, tape))) => {
                costs.add_taken_back(base.seen.steps, others.len());
                self.taken_back(text, tape, base.rtol, others)
            }
            (Target::QuantityAtRest(text), Some(Record::Equilibrium(balanced))) => {
                costs.add_linearized(others.len());
                let of = |(number, value): &(&Number, f64)| {
                    let set = [&self.overrides[..], &[set(&number.key, *value)]].concat();
                    let file = self.reader.parse_with(&self.text, &self.path, &set)?;
                    balanced.lagrangian(&file, &objective::quantity(text, &file, true)?)
                };
                let all: Result<_, Failed> = others.par_iter().map(of).collect();
                all.map_err(|why| why.to_string())
            }
            _ => Err(AT_THE_END.into()),
        }
    }

    fn taken_back(
        &self,
        text: &str,
        tape: &Tape,
        rtol: f64,
        others: &[(&Number, f64)],
    ) -> Result<Vec<f64>, String> {
        let start = |own: &[String]| -> Result<(Simulation, Quantity), Error> {
            let set = [&self.overrides[..], own].concat();
            let file = self.reader.parse_with(&self.text, &self.path, &set)?;
            let quantity = objective::quantity(text, &file, false)?;
            let settings = settings(&file.settings, rtol, Method::Adjoint);
            let mut simulation = file.scene.start(&settings)?;
            simulation.record(&quantity.read_by(Sampling::phase_ends()))?;
            Ok((simulation, quantity))
        };
        let told = |error: Error| error.to_string();
        let (own, quantity) = start(&[]).map_err(told)?;
        let (again, _) = start(&[]).map_err(told)?;
        let others: Result<Vec<Simulation>, Error> = others
            .par_iter()
            .map(|(number, value)| Ok(start(&[set(&number.key, *value)])?.0))
            .collect();
        let read = |motion: &Trajectory, sample: &Sample| {
            let values = quantity.seen(motion, &[], std::iter::once(sample)).values;
            values.first()?.first().copied().filter(|value| value.is_finite())
        };
        tape.lagrangians([own, again], others.map_err(told)?, &read)
    }
}

impl Target {
    pub(super) fn is_at_rest(&self) -> bool {
        match self {
            Self::Quantity(_) => false,
            Self::QuantityAtRest(_) => true,
            Self::LeastSquares(fit) => fit.is_at_rest(),
        }
    }
}

/// The settings of a file at another tolerance; of runs that take the same steps with a method that can, and without events, of which the
/// times would be those of another motion.
fn settings(of_file: &Settings, rtol: f64, method: Method) -> Settings {
    use crate::scene::settings::Method::{Rk, Rosenbrock};
    let tight = of_file.tightened(rtol / of_file.rtol);
    match (method, of_file.method) {
        (Method::Differences, _) => tight,
        (Method::SameSteps | Method::Adjoint, Rk | Rosenbrock) => {
            Settings { contact_events: ContactEvents::StepOver, ..tight }
        }
        (Method::SameSteps | Method::Adjoint, _) => Settings {
            method: Rosenbrock,
            max_order: None,
            stability_limit_detection: false,
            contact_events: ContactEvents::StepOver,
            ..tight
        },
    }
}
