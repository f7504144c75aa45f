//! The runs that derivatives are made of.

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::method::Method;
use super::number::{Number, set};
use super::objective::{self, Seen};
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use rayon::prelude::*;

use crate::dynamics::simulate::{Sampling, Simulation, StepList, Tape};
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::io::scene_file::{SceneFile, SceneReader};
use crate::scene::settings::{ContactEvents, Settings};
use crate::scene::timeline::Scene;
use crate::studies::fit::SceneFit;
use crate::studies::work_precision::Quantity;

/// A scene file, and what is seen of its runs.
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

/// The steps of a run, with the states that they lead to if they are to be taken back.
pub(super) struct Steps {
    pub(super) list: StepList,
    pub(super) tape: Option<Tape>,
}

/// Why there is no derivative.
pub(super) enum Stop {
    /// A run by the steps of another one needed others.
    OtherSteps,
    Failed(Error),
}

impl From<Error> for Stop {
    fn from(error: Error) -> Self {
        Self::Failed(error)
    }
}

/// Which objectives are found by taking steps back.
pub(super) const AT_THE_END: &str = "steps are taken back for readings at the end";

/// Why the steps of one run are not those of another.
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

    /// Adds the steps of a run that were taken back, with so many scenes with other numbers: about three of them, and two fifths of a step for
    /// each scene (measured with a beam of some hundred triangles).
    pub(super) fn add_taken_back(&self, steps: usize, others: usize) {
        self.add(3 * steps + 2 * steps * others / 5);
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

    /// The objective with another value for a number, and the steps that led there if they were not those of another run; with the states
    /// there if they are to be taken back.
    pub(super) fn observe(
        &self,
        other: Option<(&Number, f64)>,
        rtol: f64,
        method: Method,
        by: Option<&StepList>,
        costs: &Costs,
    ) -> Result<(Seen, Option<Steps>), Stop> {
        let mut own: Vec<String> =
            other.into_iter().map(|(number, value)| set(&number.key, value)).collect();
        if self.target.is_at_rest() {
            own.push(set("statics.rtol", rtol));
        }
        let read = || {
            self.reader.parse_with(&self.text, &self.path, &[&self.overrides[..], &own].concat())
        };
        let mut steps = None;
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
                    steps = Some(Steps { list, tape: Some(tape) });
                    return Ok(motion);
                }
                let (motion, list) = simulation.finish_with_steps()?;
                steps = Some(Steps { list, tape: None });
                return Ok(motion);
            };
            simulation.finish_by_steps(by)?.ok_or_else(|| {
                has_other_steps = true;
                InputError::new("steps", "others", OTHER_STEPS).into()
            })
        };
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
            _ if has_other_steps => Err(Stop::OtherSteps),
            Ok(seen) => {
                costs.add(seen.steps);
                Ok((seen, steps))
            }
            Err(error) => Err(Stop::Failed(error)),
        }
    }
}

impl Runs {
    /// The Lagrangian of the steps of a run at this tolerance for scenes with other values of numbers.
    ///
    /// # Errors
    /// Why they cannot be taken back.
    pub(super) fn lagrangians(
        &self,
        tape: &Tape,
        rtol: f64,
        others: &[(&Number, f64)],
    ) -> Result<Vec<f64>, String> {
        let Target::Quantity(text) = &self.target else { return Err(AT_THE_END.into()) };
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
