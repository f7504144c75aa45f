//! The result of a run: sampled states, how they were obtained, and why it ended early.

mod forces;
mod leap;
mod penetration;
mod state;

use std::error::Error;
use std::fmt;
use std::sync::{Arc, OnceLock};

pub(crate) use leap::Leap;
pub(crate) use penetration::{Deepest, DepthLimit, Penetration};

use crate::base::input::{InputError, four_digits};
use crate::dynamics::report::Report;
use crate::dynamics::system::{Energy, MissingDisplacement};
use crate::elements::body::Body;
use crate::scene::settings::Method;
use crate::scene::timeline::{ContactReader, Phase, Scene};

/// The state of a scene at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Time (s).
    pub time: f64,
    /// Number of the phase, counted from 0. The end of a phase belongs to that phase.
    pub phase: usize,
    /// Displacements (m), dimension components per node.
    pub u: Vec<f64>,
    /// Velocities (m/s), likewise.
    pub v: Vec<f64>,
    /// Constraint forces lambda (N) on the body, one per row of the phase's constraints: in the order in
    /// which the phase names them, node by node, axis by axis. [`Trajectory::constraint_force`] returns them
    /// by nodes.
    pub multipliers: Vec<f64>,
    /// Amounts (kg) of the gases in chambers and then of the liquids, the states of [lags](crate::Lag), and the flows of pipes (m^3/s), each in the order of the scene; none where
    /// they are constants: by `central-difference`, and in equilibria without gas and liquids.
    pub amounts: Vec<f64>,
    /// Internal strains (1) of Maxwell branches, of the last sample of a motion alone: there are many.
    pub internal_strains: Vec<f64>,
    /// Energies (J).
    pub energy: Energy,
    /// Largest |A^T u - b| among the constraints of the phase (m).
    pub constraint_drift: f64,
    /// Readings of the [sensors](Trajectory::sensors).
    pub sensors: Vec<f64>,
    /// Accelerations (m/s^2), until sensors have read them.
    pub(crate) accelerations: Vec<f64>,
    pub(crate) commanded: Commanded,
}

/// The phase in force at a sample, if commands have changed it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Commanded(pub(crate) Option<Arc<Phase>>);

/// Samples are equal if their numbers are.
impl PartialEq for Commanded {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// A number that is read at each sample.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Quantity {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
}

/// Name of the sensor that has the load factor of each equilibrium of a load curve.
pub(crate) const LOAD_FACTOR: &str = "load factor";

/// The unit of angles in degrees, the only one outside SI.
pub(crate) const DEGREES: &str = "deg";

impl Quantity {
    /// Heading of its column in a table: its name, followed by the unit if that is degrees, as all else is in
    /// SI units.
    #[cfg(any(feature = "output", feature = "fit"))]
    pub(crate) fn heading(&self) -> String {
        match self.unit == DEGREES {
            true => format!("{} ({DEGREES})", self.name),
            false => self.name.clone(),
        }
    }

    /// The name in the heading of a column, and whether degrees follow it.
    #[cfg(feature = "output")]
    pub(crate) fn of_heading(heading: &str) -> (&str, bool) {
        let name = heading.strip_suffix(')').and_then(|heading| heading.strip_suffix(DEGREES));
        let name = name.and_then(|heading| heading.strip_suffix(" ("));
        (name.unwrap_or(heading), name.is_some())
    }
}

/// A sampled motion and the report of its computation.
#[derive(Clone)]
pub struct Trajectory {
    scene: Scene,
    samples: Vec<Sample>,
    pub(crate) sensors: Vec<Quantity>,
    /// The least and the largest reading of each sensor, also between samples; empty unless requested.
    pub(crate) peaks: Vec<[f64; 2]>,
    pub(crate) report: Report,
    /// Largest depth of the surface in each obstacle.
    pub(crate) penetrations: Vec<Penetration>,
    /// Paths that began away from their nodes.
    pub(crate) leaps: Vec<Leap>,
    /// Reader of contact, created on first use.
    contact: OnceLock<Arc<ContactReader>>,
    /// Displacements that a reduced model lacks, as estimated by the run; empty unless requested.
    pub(crate) lacking: Vec<MissingDisplacement>,
    /// Angles (turns) that sensors of angles read at the end, by their names.
    pub(crate) angles: Vec<(String, f64)>,
}

/// Displacements below this part of the size of a body are round-off, and so is the work of forces along them.
const ROUND_OFF: f64 = 1e-9;

/// Short: errors hold trajectories, and a program that ends with one prints it.
impl fmt::Debug for Trajectory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Trajectory").field("samples", &self.samples.len()).finish_non_exhaustive()
    }
}

impl Trajectory {
    /// A trajectory that begins with the sample `first`.
    pub(crate) fn new(scene: &Scene, report: Report, first: Sample) -> Self {
        let mut trajectory = Self {
            scene: scene.clone(),
            samples: Vec::new(),
            sensors: Vec::new(),
            peaks: Vec::new(),
            report,
            penetrations: Vec::new(),
            leaps: Vec::new(),
            contact: OnceLock::new(),
            lacking: Vec::new(),
            angles: Vec::new(),
        };
        trajectory.push(first);
        trajectory
    }

    pub(crate) fn push(&mut self, sample: Sample) {
        self.note_energy(&sample.energy);
        // a body that is held does not move but by round-off, and all its energies are that
        let reactions: f64 = sample.multipliers.iter().map(|force| force.abs()).sum();
        let least = ROUND_OFF * self.body().size() * reactions;
        self.report.energy_scale = self.report.energy_scale.max(least);
        if let Some(before) = self.samples.last_mut() {
            before.internal_strains = Vec::new();
        }
        self.samples.push(sample);
    }

    /// Adds columns of sensors, with a row for each sample.
    ///
    /// # Errors
    /// A name that another column has.
    pub(crate) fn add_columns(
        &mut self,
        columns: Vec<Quantity>,
        rows: Vec<Vec<f64>>,
    ) -> Result<(), InputError> {
        let is_known = |column: &&Quantity| self.sensors.iter().any(|own| own.name == column.name);
        if let Some(Quantity { name, .. }) = columns.iter().find(is_known) {
            let help = "a column of the equilibria has it: name the sensor otherwise";
            return Err(InputError::new("name of a sensor", format!("\"{name}\""), help));
        }
        self.sensors.extend(columns);
        self.samples.iter_mut().zip(rows).for_each(|(sample, row)| sample.sensors.extend(row));
        Ok(())
    }

    /// Replaces the sensors by others, which have no readings so far.
    pub(crate) fn unread(&mut self, sensors: Vec<Quantity>) {
        for sample in &mut self.samples {
            sample.sensors = vec![f64::NAN; sensors.len()];
        }
        self.sensors = sensors;
    }

    /// Keeps the samples that `is_kept` accepts, of which there must be at least one.
    #[cfg(feature = "study")]
    pub(crate) fn keep_samples(&mut self, is_kept: impl FnMut(&Sample) -> bool) {
        self.samples.retain(is_kept);
    }

    /// Keeps the first `count` columns of the sensors.
    #[cfg(feature = "study")]
    pub(crate) fn keep_sensors(&mut self, count: usize) {
        self.sensors.truncate(count);
        self.samples.iter_mut().for_each(|sample| sample.sensors.truncate(count));
    }

    /// Discards the columns of sensors with these names.
    #[cfg(feature = "sweep")]
    pub(crate) fn drop_sensors(&mut self, is_dropped: impl Fn(&str) -> bool) {
        let kept: Vec<bool> = self.sensors.iter().map(|sensor| !is_dropped(&sensor.name)).collect();
        let mut flags = kept.iter();
        self.sensors.retain(|_| flags.next() == Some(&true));
        for sample in &mut self.samples {
            let mut flags = kept.iter();
            sample.sensors.retain(|_| flags.next() == Some(&true));
        }
    }

    /// Adds a column with a value for each sample.
    #[cfg(feature = "study")]
    pub(crate) fn add_column(&mut self, quantity: Quantity, values: &[f64]) {
        self.sensors.push(quantity);
        self.samples.iter_mut().zip(values).for_each(|(sample, x)| sample.sensors.push(*x));
    }

    /// Replaces the last sample.
    pub(crate) fn replace_last(&mut self, sample: Sample) {
        self.samples.pop();
        self.samples.push(sample);
    }

    /// Records the readings of the sensors at any time.
    pub(crate) fn note_peaks(&mut self, read: &[f64]) {
        self.peaks.resize(read.len(), [f64::INFINITY, f64::NEG_INFINITY]);
        for ([least, largest], x) in self.peaks.iter_mut().zip(read) {
            (*least, *largest) = (least.min(*x), largest.max(*x));
        }
    }

    /// Records the energies of a state.
    pub(crate) fn note_energy(&mut self, energy: &Energy) {
        let start = self.samples.first().map_or(energy.balance(), |s| s.energy.balance());
        let (report, change) = (&mut self.report, energy.balance() - start);
        report.energy_error = report.energy_error.max(change.abs());
        report.energy_created = report.energy_created.max(change);
        report.energy_scale = report.energy_scale.max(energy.size());
    }

    /// Error, rise and scale of the energy balance (J) that were recorded so far.
    pub(crate) fn noted(&self) -> [f64; 3] {
        let Report { energy_error, energy_created, energy_scale, .. } = self.report;
        [energy_error, energy_created, energy_scale]
    }

    /// Discards the samples after the first `count`, which is 1 at least, and the energies seen since: the
    /// error, rise and scale given are those recorded until then.
    pub(crate) fn go_back(&mut self, count: usize, [error, created, scale]: [f64; 3]) {
        self.samples.truncate(count);
        let report = &mut self.report;
        (report.energy_error, report.energy_created, report.energy_scale) = (error, created, scale);
    }

    /// The last sample alone, with the same report.
    pub fn at_end(&self) -> Self {
        self.since(self.last().time)
    }

    /// The samples from time `time` (s) on, and the last one in any case, with the same report.
    pub fn since(&self, time: f64) -> Self {
        let first = self.samples.partition_point(|sample| sample.time < time);
        let samples = self.samples[first.min(self.samples.len() - 1)..].to_vec();
        let (scene, sensors) = (self.scene.clone(), self.sensors.clone());
        let (peaks, contact) = (self.peaks.clone(), self.contact.clone());
        let (report, penetrations) = (self.report.clone(), self.penetrations.clone());
        let (leaps, lacking, angles) = (self.leaps.clone(), Vec::new(), self.angles.clone());
        Self {
            scene,
            samples,
            sensors,
            peaks,
            report,
            penetrations,
            leaps,
            contact,
            lacking,
            angles,
        }
    }

    /// The scene that was run.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The body that moved.
    pub fn body(&self) -> &Body {
        self.scene.body()
    }

    /// The samples, in order of time: the first one is that of the start.
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// The last sample.
    pub fn last(&self) -> &Sample {
        &self.samples[self.samples.len() - 1] // there is one at least: see `new`
    }

    /// Quantities that the [sensors](crate::Sampling::sensor) have read: names and units, in the order of
    /// [`Sample::sensors`].
    pub fn sensors(&self) -> &[Quantity] {
        &self.sensors
    }

    /// Report of the computation.
    pub fn report(&self) -> &Report {
        &self.report
    }

    /// Centre of mass (m).
    pub fn centre_of_mass(&self, sample: &Sample) -> Vec<f64> {
        let positions = self.body().mesh().positions();
        let x: Vec<f64> = positions.iter().zip(&sample.u).map(|(x, u)| x + u).collect();
        self.body().mass_average(&x)
    }

    /// Velocity of the centre of mass (m/s).
    pub fn mean_velocity(&self, sample: &Sample) -> Vec<f64> {
        self.body().mass_average(&sample.v)
    }

    /// Momentum (kg m/s).
    pub fn momentum(&self, sample: &Sample) -> Vec<f64> {
        let mass = self.body().mass();
        self.mean_velocity(sample).iter().map(|v| mass * v).collect()
    }

    /// Angular momentum (kg m^2/s) about the centre of mass: the sum of (x - c) x (M v) over the
    /// nodes, M the consistent inertia matrix. One number in two dimensions (counter-clockwise), a
    /// vector in three, nothing in one. That of a body of revolution is 0.
    pub fn angular_momentum(&self, sample: &Sample) -> Vec<f64> {
        let body = self.body();
        let d = body.dimension();
        if body.is_axisymmetric() {
            return vec![0.0];
        }
        let centre = self.centre_of_mass(sample);
        let mut momenta = vec![0.0; body.dofs()];
        body.inertia().add_product(d, 1.0, &sample.v, &mut momenta);
        let positions = body.mesh().positions();
        let arm = |dof: usize| positions[dof] + sample.u[dof] - centre[dof % d];
        // component (x - c)_i p_j - (x - c)_j p_i
        let moment = |&[i, j]: &[usize; 2]| {
            let nodes = (0..body.dofs()).step_by(d);
            nodes.map(|n| arm(n + i) * momenta[n + j] - arm(n + j) * momenta[n + i]).sum()
        };
        let planes: &[[usize; 2]] = match d {
            1 => &[],
            2 => &[[0, 1]],
            _ => &[[1, 2], [2, 0], [0, 1]],
        };
        planes.iter().map(moment).collect()
    }

    /// Angle (rad, counter-clockwise, between -pi and pi) by which a two-dimensional body has turned as a
    /// whole.
    ///
    /// It is that of the rotation that brings the undeformed shape nearest to the present one, weighted by
    /// mass. `None` in other dimensions. The sensor
    /// [`Reading::rotation`](crate::dynamics::simulate::Reading::rotation) is continuous over whole turns.
    pub fn rotation(&self, sample: &Sample) -> Option<f64> {
        self.body().rotation(&sample.u)
    }
}

/// An integration that failed or was stopped: time, reason, and the results until then.
#[derive(Debug)]
pub struct IntegrationFailure {
    /// Name of the phase.
    pub phase: String,
    /// The method.
    pub method: Method,
    /// Time reached (s).
    pub time: f64,
    /// Last step size (s).
    pub step: f64,
    /// The error of the integrator, with the likely cause and the remedy; [`Interrupted`] if it was
    /// stopped from outside.
    pub source: Box<dyn Error + Send + Sync>,
    /// The motion until then, up to the last step.
    pub trajectory: Trajectory,
}

/// The cause of an [`IntegrationFailure`] that is not a failure: the observer of
/// [`Scene::simulate_with`](crate::Scene::simulate_with) stopped the run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("interrupted")]
pub struct Interrupted;

impl IntegrationFailure {
    /// Whether the run was stopped from outside, with nothing wrong with it.
    pub fn is_interruption(&self) -> bool {
        self.source.is::<Interrupted>()
    }

    /// The error of the integrator, with its sources.
    pub fn cause(&self) -> String {
        let mut said = self.source.to_string();
        let mut behind = self.source.source();
        while let Some(inner) = behind {
            said = format!("{said}: {inner}");
            behind = inner.source();
        }
        said
    }
}

impl fmt::Display for IntegrationFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { phase, method, time, step, .. } = self;
        let cause = self.cause();
        write!(
            f,
            "phase \"{phase}\" ({method}) stopped at t = {} s, step {step:.1e} s: {cause}",
            four_digits(*time)
        )
    }
}

impl Error for IntegrationFailure {}
