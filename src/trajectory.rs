//! What a run leaves behind: sampled states, and how they were obtained.

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
    /// Wall-clock time (s).
    pub wall_seconds: f64,
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

    /// Factorizations of the Newton matrix in all phases.
    pub fn factorizations(&self) -> usize {
        self.phases.iter().map(|phase| phase.counts.factorizations).sum()
    }
}

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
        for PhaseReport { name, end, wall_seconds, counts } in &self.phases {
            let Counts { steps, evaluations, factorizations, .. } = counts;
            let rejected = rejected(counts);
            writeln!(
                f,
                "{name:12} {end:8} {steps:8} {evaluations:12} {factorizations:15} {rejected:9} \
                 {wall_seconds:9.4}"
            )?;
        }
        let rejected: usize = self.phases.iter().map(|phase| rejected(&phase.counts)).sum();
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
        for PhaseReport { name, counts, .. } in &self.phases {
            if let Some(notice) = &counts.notice {
                write!(f, "\nphase \"{name}\": {notice}")?;
            }
        }
        Ok(())
    }
}

impl Trajectory {
    pub(crate) fn new(scene: &Scene, report: Report) -> Self {
        Self { scene: scene.clone(), samples: Vec::new(), report }
    }

    pub(crate) fn push(&mut self, sample: Sample) {
        let start = self.samples.first().map_or(sample.energy.balance(), |s| s.energy.balance());
        let Energy { kinetic, strain, contact, springs, dissipated, supplied, .. } = sample.energy;
        let report = &mut self.report;
        report.energy_error = report.energy_error.max((sample.energy.balance() - start).abs());
        let sum = kinetic + strain + contact + springs + dissipated.abs() + supplied.abs();
        report.energy_scale = report.energy_scale.max(sum);
        self.samples.push(sample);
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

    /// Angular momentum (kg m^2/s, counter-clockwise) of a two-dimensional body about its centre of
    /// mass: the sum of (x - c) x (M v) over the nodes, M the consistent inertia matrix. `None` in
    /// other dimensions.
    pub fn angular_momentum(&self, sample: &Sample) -> Option<f64> {
        let body = self.body();
        if body.dimension() != 2 {
            return None;
        }
        let centre = self.centre_of_mass(sample);
        let mut momenta = vec![0.0; body.dofs()];
        body.inertia().add_product(2, 1.0, &sample.v, &mut momenta);
        let positions = body.mesh().positions().chunks_exact(2);
        let nodes = positions.zip(sample.u.chunks_exact(2)).zip(momenta.chunks_exact(2));
        let moments = nodes.map(|((x, u), p)| {
            let arm = [x[0] + u[0] - centre[0], x[1] + u[1] - centre[1]];
            arm[0] * p[1] - arm[1] * p[0]
        });
        Some(moments.sum())
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
