//! What a run leaves behind: sampled states, and how they were obtained.

mod forces;

use std::fmt;

use crate::body::Body;
use crate::scene::Scene;
use crate::simulate::{Counts, Method};
use crate::system::Energy;

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
    /// Constraint forces lambda (N) on the body, one per row of the phase's constraints: in the
    /// order in which the phase names them, node by node, axis by axis.
    /// [`Trajectory::constraint_force`] tells them by nodes.
    pub multipliers: Vec<f64>,
    /// Energies (J).
    pub energy: Energy,
    /// Largest |A^T u - b| among the constraints of the phase (m).
    pub constraint_drift: f64,
}

/// A sampled motion and the report of its computation.
#[derive(Debug, Clone)]
pub struct Trajectory {
    scene: Scene,
    samples: Vec<Sample>,
    pub(crate) report: Report,
}

/// How a trajectory was computed.
#[derive(Debug, Clone, Default)]
pub struct Report {
    /// Integration method.
    pub method: Method,
    /// Relative tolerance.
    pub rtol: f64,
    /// Rate of the constraint stabilization (1/s).
    pub alpha: f64,
    /// Unknowns of the integrator, in the last phase.
    pub states: usize,
    /// Largest |A^T u - b| at the end of a step (m).
    pub constraint_drift: f64,
    /// Largest change of the energy balance (J): kinetic + potential + dissipated - supplied.
    pub energy_error: f64,
    /// Largest rise of the energy balance (J): energy that the integrator has created.
    pub energy_created: f64,
    /// Largest sum of the energies (J), as the scale of `energy_error`.
    pub energy_scale: f64,
    /// Wall-clock time of the whole run (s).
    pub wall_seconds: f64,
    /// Phase by phase.
    pub phases: Vec<PhaseReport>,
}

/// How one phase was computed.
#[derive(Debug, Clone)]
pub struct PhaseReport {
    /// Name of the phase.
    pub name: String,
    /// Time reached (s).
    pub end: f64,
    /// Unknowns of the integrator.
    pub states: usize,
    /// Wall-clock time (s).
    pub wall_seconds: f64,
    /// Method at the end of the phase: the one asked for, or the choice of [`Method::Auto`].
    pub method: Method,
    /// Why that method, if it was chosen.
    pub reason: Option<String>,
    /// Steps, evaluations, factorizations.
    pub counts: Counts,
}

impl Report {
    /// Steps of all phases.
    pub fn steps(&self) -> usize {
        self.phases.iter().map(|phase| phase.counts.steps).sum()
    }

    /// Evaluations of the right-hand side or residual in all phases.
    pub fn evaluations(&self) -> usize {
        self.phases.iter().map(|phase| phase.counts.evaluations).sum()
    }

    /// Evaluations of the tangents of the forces in all phases.
    pub fn jacobian_evaluations(&self) -> usize {
        self.phases.iter().map(|phase| phase.counts.jacobian_evaluations).sum()
    }

    /// Factorizations of the Newton matrix in all phases.
    pub fn factorizations(&self) -> usize {
        self.phases.iter().map(|phase| phase.counts.factorizations).sum()
    }

    /// Steps of all phases that were repeated because their error was too large.
    pub fn error_test_failures(&self) -> usize {
        self.phases.iter().map(|phase| phase.counts.error_test_failures).sum()
    }

    /// Newton iterations of all phases that did not converge.
    pub fn convergence_failures(&self) -> usize {
        self.phases.iter().map(|phase| phase.counts.convergence_failures).sum()
    }

    /// What makes the result doubtful or the run needlessly long: what the integrators noticed, and
    /// an energy balance that is off by more than a hundredth of the largest energy.
    pub fn warnings(&self) -> Vec<String> {
        let notice = |phase: &PhaseReport| {
            let notice = phase.counts.notice.as_ref()?;
            Some(format!("phase \"{}\": {notice}", phase.name))
        };
        let mut warnings: Vec<String> = self.phases.iter().filter_map(notice).collect();
        let doubt = self.creation(0.0).or_else(|| {
            let part = self.energy_error / self.energy_scale;
            (part > DOUBTFUL).then(|| {
                format!("the energy balance is off by {:.1} % of the largest energy", 100.0 * part)
            })
        });
        warnings.extend(doubt.map(|doubt| {
            format!("{doubt}, so the motion may be wrong: lower rtol, or choose another method")
        }));
        warnings
    }

    /// What the integrator has created, if it is more than a hundredth of the largest energy, which
    /// counts as `least` (J) at least.
    pub(crate) fn creation(&self, least: f64) -> Option<String> {
        let part = self.energy_created / self.energy_scale.max(least);
        (part > DOUBTFUL).then(|| {
            format!(
                "the integrator created {:.1e} J, {:.1} % of the largest energy",
                self.energy_created,
                100.0 * part
            )
        })
    }
}

/// Error of the energy balance, as part of the largest energy, from which a result is doubtful.
const DOUBTFUL: f64 = 0.01;

impl fmt::Display for Report {
    /// A table of the phases and the sums over them, then what is conserved and what is not.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { method, rtol, alpha, states, .. } = self;
        writeln!(f, "{method}, rtol {rtol:.0e}, alpha {alpha:.0e} 1/s, {states} unknowns")?;
        writeln!(
            f,
            "{:12} {:>8} {:>8} {:>12} {:>15} {:>9} {:>9}",
            "phase", "end (s)", "steps", "evaluations", "factorizations", "rejected", "time (s)"
        )?;
        let rejected = |c: &Counts| c.error_test_failures + c.convergence_failures;
        for PhaseReport { name, end, wall_seconds, counts, .. } in &self.phases {
            let Counts { steps, evaluations, factorizations, .. } = counts;
            // of a run that ended early it has all digits
            let mut end_text = end.to_string();
            if end_text.len() > 8 {
                end_text = format!("{end:.3e}");
            }
            let rejected = rejected(counts);
            writeln!(
                f,
                "{name:12} {end_text:>8} {steps:8} {evaluations:12} {factorizations:15} {rejected:9} \
                 {wall_seconds:9.4}"
            )?;
        }
        let rejected = self.error_test_failures() + self.convergence_failures();
        let (steps, seconds) = (self.steps(), self.wall_seconds);
        let (evaluations, factorizations) = (self.evaluations(), self.factorizations());
        writeln!(
            f,
            "{:12} {:8} {steps:8} {evaluations:12} {factorizations:15} {rejected:9} {seconds:9.4}",
            "all", ""
        )?;
        let Self { constraint_drift, energy_error, energy_scale, .. } = self;
        write!(
            f,
            "largest constraint drift {constraint_drift:.1e} m; energy balance off by at most \
             {energy_error:.1e} of {energy_scale:.1e} J"
        )?;
        for PhaseReport { name, reason, counts, .. } in &self.phases {
            let events = match counts.contact_events {
                0 => None,
                1 => Some("1 contact event located".to_owned()),
                count => Some(format!("{count} contact events located")),
            };
            let remarks: Vec<&str> =
                reason.as_deref().into_iter().chain(events.as_deref()).collect();
            if !remarks.is_empty() {
                write!(f, "\nphase \"{name}\": {}", remarks.join("; "))?;
            }
        }
        self.warnings().iter().try_for_each(|warning| write!(f, "\nWARNING: {warning}"))
    }
}

impl Trajectory {
    pub(crate) fn new(scene: &Scene, report: Report) -> Self {
        Self { scene: scene.clone(), samples: Vec::new(), report }
    }

    pub(crate) fn push(&mut self, sample: Sample) {
        self.watch(&sample.energy);
        self.samples.push(sample);
    }

    /// Takes note of the energies of a state.
    pub(crate) fn watch(&mut self, energy: &Energy) {
        let start = self.samples.first().map_or(energy.balance(), |s| s.energy.balance());
        let (report, change) = (&mut self.report, energy.balance() - start);
        report.energy_error = report.energy_error.max(change.abs());
        report.energy_created = report.energy_created.max(change);
        report.energy_scale = report.energy_scale.max(energy.size());
    }

    /// Forgets the samples after the first `count`, and the energies seen since: what was noted
    /// until then is in `report`.
    pub(crate) fn go_back(&mut self, count: usize, [error, created, scale]: [f64; 3]) {
        self.samples.truncate(count);
        let report = &mut self.report;
        (report.energy_error, report.energy_created, report.energy_scale) = (error, created, scale);
    }

    /// The last sample alone, with the same report.
    pub fn at_end(&self) -> Self {
        let samples = self.samples.last().cloned().into_iter().collect();
        Self { scene: self.scene.clone(), samples, report: self.report.clone() }
    }

    /// The scene that was run.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The body that moved.
    pub fn body(&self) -> &Body {
        self.scene.body()
    }

    /// The samples, in order of time.
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// The last sample.
    ///
    /// # Panics
    /// Never for a trajectory that [`Scene::simulate`] returned: it begins with a sample.
    pub fn last(&self) -> &Sample {
        self.samples.last().expect("a trajectory begins with a sample at t = 0")
    }

    /// How it was computed.
    pub fn report(&self) -> &Report {
        &self.report
    }

    /// Centre of mass (m).
    pub fn centre_of_mass(&self, sample: &Sample) -> Vec<f64> {
        let positions = self.body().mesh().positions();
        let x: Vec<f64> = positions.iter().zip(&sample.u).map(|(x, u)| x + u).collect();
        self.mass_average(&x)
    }

    /// Velocity of the centre of mass (m/s).
    pub fn mean_velocity(&self, sample: &Sample) -> Vec<f64> {
        self.mass_average(&sample.v)
    }

    /// Momentum (kg m/s).
    pub fn momentum(&self, sample: &Sample) -> Vec<f64> {
        let mass = self.body().mass();
        self.mean_velocity(sample).iter().map(|v| mass * v).collect()
    }

    /// Angular momentum (kg m^2/s) about the centre of mass: the sum of (x - c) x (M v) over the
    /// nodes, M the consistent inertia matrix. One number in two dimensions (counter-clockwise), a
    /// vector in three, nothing in one.
    pub fn angular_momentum(&self, sample: &Sample) -> Vec<f64> {
        let body = self.body();
        let d = body.dimension();
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

    /// Angle (rad, counter-clockwise) by which a two-dimensional body has turned as a whole: that
    /// of the rotation which, in the mean over its mass, brings the natural shape nearest to the
    /// present one. `None` in other dimensions.
    pub fn rotation(&self, sample: &Sample) -> Option<f64> {
        if self.body().dimension() != 2 {
            return None;
        }
        let positions = self.body().mesh().positions();
        let (centre, natural) = (self.centre_of_mass(sample), self.mass_average(positions));
        let (mut along, mut across) = (0.0, 0.0);
        for (node, mass) in self.body().nodal_masses().iter().enumerate() {
            let arm = |i: usize| positions[2 * node + i] - natural[i];
            let now = |i: usize| positions[2 * node + i] + sample.u[2 * node + i] - centre[i];
            along += mass * (arm(0) * now(0) + arm(1) * now(1));
            across += mass * (arm(0) * now(1) - arm(1) * now(0));
        }
        Some(across.atan2(along))
    }

    fn mass_average(&self, x: &[f64]) -> Vec<f64> {
        let (dimension, mass) = (self.body().dimension(), self.body().mass());
        let mut average = vec![0.0; dimension];
        for (nodal_mass, x) in self.body().nodal_masses().iter().zip(x.chunks_exact(dimension)) {
            average.iter_mut().zip(x).for_each(|(a, x)| *a += nodal_mass * x / mass);
        }
        average
    }
}
