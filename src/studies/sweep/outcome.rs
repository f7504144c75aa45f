//! The outcome of a point: a motion, or an equilibrium.
//!
//! A run is sampled as in the scene, so that its warnings are those of `pliant run`; quantities are
//! additional sensors, removed before an output is kept. A run has one core, by a pool of one thread. Reading
//! a scene and building its body is not shared between runs: 4 to 8 % of a run (`docs/notes/studies.md`).

use std::ops::ControlFlow;

use crate::base::input::InputError;
use crate::dynamics::equilibrium::{Equilibrium, NoEquilibrium, Stability};
use crate::dynamics::error::Error;
use crate::dynamics::simulate::{Sampling, Simulation};
use crate::dynamics::trajectory::{IntegrationFailure, Trajectory};
use crate::io::scene_file::{SceneFile, StudyFile};
use crate::studies::work_precision::Verification;
use crate::studies::work_precision::quantity::Quantity;

/// The outcome of a point.
#[derive(Debug)]
#[allow(clippy::large_enum_variant, reason = "there is one of them at a time")]
pub enum Outcome {
    /// The motion, as `pliant run` has it.
    Motion(Result<Trajectory, Box<IntegrationFailure>>),
    /// The equilibrium, as `pliant static` has it.
    Equilibrium(Result<Equilibrium, Box<NoEquilibrium>>),
}

impl Outcome {
    /// The motion, or the equilibria of the load curve; as far as it came.
    pub fn trajectory(&self) -> &Trajectory {
        match self {
            Self::Motion(Ok(motion)) => motion,
            Self::Motion(Err(failure)) => &failure.trajectory,
            Self::Equilibrium(Ok(found)) => found.trajectory(),
            Self::Equilibrium(Err(failure)) => &failure.trajectory,
        }
    }

    /// Reason for its failure.
    pub(super) fn failure(&self) -> Option<String> {
        match self {
            Self::Motion(motion) => motion.as_ref().err().map(ToString::to_string),
            Self::Equilibrium(found) => found.as_ref().err().map(ToString::to_string),
        }
    }

    /// Whether it was stopped from outside.
    pub(super) fn is_interruption(&self) -> bool {
        matches!(self, Self::Motion(Err(failure)) if failure.is_interruption())
    }

    /// Time reached (s), or the part of the phase's end to which the load of an equilibrium was brought on.
    pub(super) fn reached(&self) -> f64 {
        let trajectory = self.trajectory();
        let last = trajectory.last();
        match self {
            // by arc length samples are spread over the phase, independent of the load
            Self::Equilibrium(Err(failure)) => {
                failure.fraction * trajectory.scene().phases()[last.phase].end()
            }
            _ => last.time,
        }
    }

    /// Steps of the integrator, or Newton's iterations.
    pub(super) fn steps(&self) -> usize {
        match self {
            Self::Motion(_) => self.trajectory().report().steps(),
            Self::Equilibrium(Ok(found)) => found.iterations,
            Self::Equilibrium(Err(failure)) => failure.iterations,
        }
    }

    /// Names of the indicators in doubt.
    pub(super) fn warnings(&self) -> Vec<String> {
        let named = self.trajectory().report().named_warnings();
        let mut names: Vec<String> = named.into_iter().map(|(name, _)| name.into()).collect();
        names.dedup();
        if let Self::Equilibrium(Ok(Equilibrium {
            stability: Stability::Unstable { .. }, ..
        })) = self
        {
            names.push(UNSTABLE.into());
        }
        names
    }
}

/// The warning of an equilibrium that a small push ends.
const UNSTABLE: &str = "unstable";

/// The results for a point: the scene, the number of each quantity, and the whole.
pub(super) struct Computed {
    pub(super) file: SceneFile,
    pub(super) numbers: Vec<Option<f64>>,
    pub(super) outcome: Outcome,
}

/// Names of sensors that read quantities begin so.
const SENSOR: &str = "\u{1}sweep";
/// Times at which swings are looked at.
const LOOKS: usize = 2000;

/// The quantities of a study that are kept of a scene.
fn named(study: &StudyFile, file: &SceneFile) -> Result<Vec<Quantity>, InputError> {
    let texts = study.quantities.iter().map(|written| &written.text);
    texts.map(|text| Quantity::named(text, &file.scene, &file.output.sensors)).collect()
}

/// Runs a scene.
pub(super) fn motion(
    mut file: SceneFile,
    study: &StudyFile,
    observer: &mut dyn FnMut(&Simulation) -> ControlFlow<()>,
) -> Result<Computed, Error> {
    let within = study.accuracy.or(file.accuracy.within);
    if file.accuracy.quantity.is_none() {
        file.accuracy.quantity = study.quantities.first().map(|written| written.text.clone());
    }
    let quantities = named(study, &file)?;
    let sampling = sampling(&file, &quantities, within.is_some());
    let result = match within {
        None => {
            let mut simulation = file.scene.start(&file.settings)?;
            simulation.record(&sampling)?;
            simulation.finish(observer)
        }
        Some(within) => {
            Verification::of_file(&file, within)?.sampling(sampling.clone()).finish(observer)
        }
    };
    let mut motion = match result {
        Ok(trajectory) => Ok(trajectory),
        Err(Error::Integration(failure)) => Err(failure),
        Err(error) => return Err(error),
    };
    let trajectory = match &mut motion {
        Ok(trajectory) => trajectory,
        Err(failure) => &mut failure.trajectory,
    };
    let numbers = quantities.iter().enumerate();
    let numbers = numbers.map(|(at, quantity)| read(trajectory, quantity, at)).collect();
    trajectory.drop_sensors(|name| name.starts_with(SENSOR));
    let ends: Vec<f64> =
        file.scene.phases().iter().map(crate::scene::timeline::Phase::end).collect();
    trajectory
        .keep_samples(|sample| !sampling.is_extra(sample.time) || ends.contains(&sample.time));
    file.explain(trajectory);
    Ok(Computed { file, numbers, outcome: Outcome::Motion(motion) })
}

/// Finds the equilibrium of a scene.
pub(super) fn equilibrium(file: SceneFile, study: &StudyFile) -> Result<Computed, Error> {
    let mut sampling = Sampling::phase_ends();
    for (at, quantity) in named(study, &file)?.iter().enumerate() {
        sampling = sampling.read(format!("{SENSOR}{at}"), quantity.at_rest(&file.scene)?.clone());
    }
    let mut found = match file.equilibrium() {
        Ok(found) => found,
        Err(Error::Statics(failure)) => {
            let outcome = Outcome::Equilibrium(Err(failure));
            return Ok(Computed { file, numbers: Vec::new(), outcome });
        }
        Err(error) => return Err(error),
    };
    found.read(&sampling)?;
    let number = |at| Some(found.sample().sensors[column(found.trajectory(), at)?]);
    let numbers = (0..study.quantities.len()).map(|at| number(at).filter(|x| x.is_finite()));
    let numbers = numbers.collect();
    found.trajectory.drop_sensors(|name| name.starts_with(SENSOR));
    Ok(Computed { file, numbers, outcome: Outcome::Equilibrium(Ok(found)) })
}

/// The sampling that the scene asks for, with the quantities.
fn sampling(file: &SceneFile, quantities: &[Quantity], is_verified: bool) -> Sampling {
    let end = file.scene.end();
    let mut sampling = match is_verified {
        false => file.output.sampling(),
        true => file.output.verified_sampling(end),
    };
    if quantities.iter().any(Quantity::is_of_history) {
        let times: Vec<f64> = (1..LOOKS).map(|k| end * (k as f64 / LOOKS as f64)).collect();
        sampling = match is_verified {
            false => sampling.also_at(times),
            // verified runs have extra times of their own
            true => {
                let sensors = file.output.sensors.iter().cloned();
                sensors.fold(Sampling::at(times), |all, (name, reading)| all.read(name, reading))
            }
        };
    }
    for (at, quantity) in quantities.iter().enumerate() {
        if let Some(reading) = quantity.read_for_it() {
            sampling = sampling.read(format!("{SENSOR}{at}"), reading.clone());
        }
    }
    match quantities.iter().any(Quantity::is_peak) {
        true => sampling.finding_peaks(),
        false => sampling,
    }
}

/// The column of quantity `at`.
fn column(motion: &Trajectory, at: usize) -> Option<usize> {
    let name = format!("{SENSOR}{at}");
    // a vector on a line has one component, which the name of its column has, too
    let is_own = |column: &str| {
        column.strip_prefix(&name).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    motion.sensors().iter().position(|sensor| is_own(&sensor.name))
}

/// The number of quantity `at`.
fn read(motion: &Trajectory, quantity: &Quantity, at: usize) -> Option<f64> {
    let column = column(motion, at)?;
    let samples = motion.samples().iter();
    let (times, series): (Vec<f64>, Vec<f64>) =
        samples.map(|sample| (sample.time, sample.sensors[column])).unzip();
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let read = motion.peaks.get(column).copied().unwrap_or(none);
    quantity.number(&times, &series, read).filter(|number| number.is_finite())
}
