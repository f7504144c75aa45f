//! Running a scene: phase by phase, with restarts in between and samples along the way.

mod solver;
mod stepper;

use std::fmt;
use std::time::Instant;

use solver::Tolerances;
pub use solver::{Method, Solver};
use stepper::{Failed, Stepper};

use crate::constraint::{Start, tell};
use crate::error::{Error, positive};
use crate::ode::Failure;
use crate::scene::{Forces, Phase, Scene};
use crate::system::{ENERGIES, System};
use crate::trajectory::{PhaseReport, Report, Sample, Trajectory};

/// When the motion is sampled. The start and the end of each phase always are.
///
/// Samples come from the dense output of the integrator; they never shorten its steps.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sampling(Times);

#[derive(Debug, Clone, PartialEq, Default)]
enum Times {
    #[default]
    PhaseEnds,
    Every(f64),
    At(Vec<f64>),
}

impl Sampling {
    /// At t = 0 and at the ends of the phases only.
    pub fn phase_ends() -> Self {
        Self(Times::PhaseEnds)
    }

    /// At all multiples of `step` (s).
    pub fn every(step: f64) -> Self {
        Self(Times::Every(step))
    }

    /// At the given times (s), in any order.
    pub fn at(times: impl Into<Vec<f64>>) -> Self {
        Self(Times::At(times.into()))
    }

    fn validate(&self, end: f64) -> Result<(), Error> {
        match &self.0 {
            Times::PhaseEnds => Ok(()),
            Times::Every(step) => positive("sampling step", *step, "s").map(|_| ()),
            Times::At(times) => match times.iter().find(|t| !(0.0..=end).contains(*t)) {
                Some(t) => {
                    let mend = format!("samples lie between 0 and the end of the scene, {end} s");
                    Err(Error::input("sampling time", t, mend))
                }
                None => Ok(()),
            },
        }
    }

    /// The sampling times after `start` up to `end`, ending with `end`.
    fn within(&self, start: f64, end: f64) -> Vec<f64> {
        // multiples that round-off alone keeps apart from the ends of the phase are those ends
        let apart = 1e-9 * (end - start);
        let mut times: Vec<f64> = match &self.0 {
            Times::PhaseEnds => Vec::new(),
            Times::Every(step) => {
                let (first, last) = ((start / step).floor() as u64, (end / step).ceil() as u64);
                (first..=last).map(|k| k as f64 * step).collect()
            }
            Times::At(times) => times.clone(),
        };
        times.retain(|&t| t > start + apart && t < end - apart);
        times.push(end);
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }
}

/// What the integration of a phase cost.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Counts {
    /// Steps taken.
    pub steps: usize,
    /// Evaluations of the right-hand side or residual.
    pub evaluations: usize,
    /// Factorizations of the Newton matrix.
    pub factorizations: usize,
    /// Steps repeated because their error was too large.
    pub error_test_failures: usize,
    /// Newton iterations that did not converge (`rk`: steps refused by the right-hand side).
    pub convergence_failures: usize,
    /// Size of the last step (s).
    pub last_step: f64,
    /// Order of the last step.
    pub last_order: u32,
    /// What the integrator noticed: that stability, not accuracy, bounds its steps.
    pub notice: Option<String>,
}

/// An integration that gave up: where, why, and what was computed until then.
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
    /// What the integrator said, with the likely cause and what to try.
    pub source: Failed,
    /// The motion until then.
    pub trajectory: Trajectory,
}

impl fmt::Display for IntegrationFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { phase, method, time, step, source, .. } = self;
        write!(
            f,
            "phase \"{phase}\" ({method}) stopped at t = {time} s, step {step:.3e} s: {source}"
        )?;
        let mut cause = source.source();
        while let Some(inner) = cause {
            write!(f, ": {inner}")?;
            cause = inner.source();
        }
        Ok(())
    }
}

impl std::error::Error for IntegrationFailure {}

impl Scene {
    /// Runs the scene, from rest in its natural shape if nothing else was said.
    ///
    /// ```
    /// use pliant::{Body, Cells, Material, Mesh, Phase, Sampling, Scene, Solver};
    ///
    /// let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
    /// let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
    /// let body = Body::new(mesh, rubber).thickness(0.01).build()?;
    /// let scene = Scene::new(body)
    ///     .phase(Phase::until(0.1).hold("bottom").move_nodes([14, 15], [0.0, -0.16]));
    /// let trajectory = scene.simulate(&Solver::default(), &Sampling::every(0.01))?;
    /// assert!((trajectory.last().u[2 * 13 + 1] - -0.016).abs() < 1e-6);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// Bad input before anything is computed; [`Error::Integration`] with the motion until then
    /// when the integrator gives up.
    pub fn simulate(&self, solver: &Solver, sampling: &Sampling) -> Result<Trajectory, Error> {
        solver.validate()?;
        let forces = self.forces()?;
        sampling.validate(self.end())?;
        Run::new(self, solver).all(forces, sampling)
    }
}

/// A scene on its way.
struct Run<'a> {
    scene: &'a Scene,
    solver: &'a Solver,
    atol: Tolerances,
    time: f64,
    /// (u, v, energies)
    state: Vec<f64>,
    /// Steps in a row that did not move time ahead.
    standing: usize,
    trajectory: Trajectory,
}

impl<'a> Run<'a> {
    fn new(scene: &'a Scene, solver: &'a Solver) -> Self {
        let report = Report {
            method: solver.method,
            rtol: solver.rtol,
            alpha: solver.alpha,
            ..Report::default()
        };
        Self {
            scene,
            solver,
            atol: solver.tolerances(scene.body()),
            time: 0.0,
            state: [scene.start().as_slice().concat(), vec![0.0; ENERGIES]].concat(),
            standing: 0,
            trajectory: Trajectory::new(scene, report),
        }
    }

    fn all(mut self, forces: Vec<Forces>, sampling: &Sampling) -> Result<Trajectory, Error> {
        let n = self.scene.body().dofs();
        let model = self.scene.model(&forces);
        let mut rows = Vec::new();
        for (number, (phase, forces)) in self.scene.phases().iter().zip(forces).enumerate() {
            let mut u = self.state[..n].to_vec();
            tell(&rows, self.time, &mut u);
            let start = Start { time: self.time, u: &u };
            let mut system = self.scene.system(&model, phase, forces, &start, self.solver.alpha)?;
            rows = system.rows().to_vec();
            if phase.projects_velocity {
                system.project(self.time, &mut self.state[n..2 * n]);
            }
            if let Err((source, step)) = self.phase(number, phase, system, sampling) {
                return Err(self.failure(phase, source, step));
            }
        }
        Ok(self.trajectory)
    }

    /// Integrates one phase to its end.
    fn phase(
        &mut self,
        number: usize,
        phase: &Phase,
        mut system: System,
        sampling: &Sampling,
    ) -> Result<(), (Failed, f64)> {
        let clock = Instant::now();
        let end = phase.until;
        if number == 0 {
            let state = self.state.clone();
            self.sample(number, &mut system, &state).map_err(|source| (source, 0.0))?;
        }
        let mut times = sampling.within(self.time, end).into_iter().peekable();
        let mut stepper =
            Stepper::new(system, self.solver, &self.atol, self.time, end, &self.state)
                .map_err(|source| (source, 0.0))?;
        let mut sample = vec![0.0; stepper.size()];
        let mut result = Ok(());
        let mut steps = 0;
        while result.is_ok() && self.time < end {
            result = match steps == self.solver.max_steps {
                false => self.step(number, end, &mut stepper, &mut times, &mut sample),
                true => Err(too_many_steps(steps, &stepper.counts())),
            };
            steps += 1;
        }
        let counts = stepper.counts();
        let step = counts.last_step;
        self.trajectory.report.states = stepper.size();
        self.trajectory.report.phases.push(PhaseReport {
            name: phase.name.clone(),
            end: self.time,
            wall_seconds: clock.elapsed().as_secs_f64(),
            counts,
        });
        result.map_err(|source| (source, step))
    }

    /// Takes one step, and the samples within it.
    fn step(
        &mut self,
        number: usize,
        end: f64,
        stepper: &mut Stepper,
        times: &mut std::iter::Peekable<impl Iterator<Item = f64>>,
        sample: &mut [f64],
    ) -> Result<(), Failed> {
        let time = stepper.step(end)?;
        self.standing = if time > self.time { 0 } else { self.standing + 1 };
        if self.standing == STANDING {
            return Err(standing_still(stepper.system().refusal()));
        }
        let n = self.scene.body().dofs();
        let (before, after) = (&self.state[..n], &stepper.state()[..n]);
        stepper.system().check_step(time, before, after).map_err(into_error)?;
        while let Some(t) = times.next_if(|&t| t <= time) {
            stepper.interpolate(t, sample)?;
            self.time = t;
            self.sample(number, stepper.system_mut(), sample)?;
        }
        self.time = time;
        let length = self.state.len();
        self.state.copy_from_slice(&stepper.state()[..length]);
        let drift = stepper.system().drift(time, &self.state[..n]);
        let worst = &mut self.trajectory.report.constraint_drift;
        *worst = worst.max(drift);
        Ok(())
    }

    /// Records `state` = (u, v, energies, ...) at the present time.
    fn sample(&mut self, phase: usize, system: &mut System, state: &[f64]) -> Result<(), Failed> {
        let n = system.dofs();
        let (u, v) = (&state[..n], &state[n..2 * n]);
        let multipliers = system.multipliers(self.time, u, v).map_err(into_error)?.to_vec();
        let mut energy = system.energy(self.time, u, v);
        energy.dissipated = state[2 * n];
        energy.supplied = state[2 * n + 1];
        self.trajectory.push(Sample {
            time: self.time,
            phase,
            u: u.to_vec(),
            v: v.to_vec(),
            multipliers,
            energy,
            constraint_drift: system.drift(self.time, u),
        });
        Ok(())
    }

    fn failure(self, phase: &Phase, source: Failed, step: f64) -> Error {
        Box::new(IntegrationFailure {
            phase: phase.name.clone(),
            method: self.solver.method,
            time: self.time,
            step,
            source,
            trajectory: self.trajectory,
        })
        .into()
    }
}

/// Steps in a row that may be too small to move time ahead in double precision.
const STANDING: usize = 100;

fn standing_still(refusal: &str) -> Failed {
    let reason = match refusal {
        "" => "the motion changes without end in no time: check the model near this time",
        reason => reason,
    };
    format!("{STANDING} steps, too small to move time ahead, have not led past this: {reason}")
        .into()
}

fn too_many_steps(steps: usize, counts: &Counts) -> Failed {
    let reason = counts.notice.as_deref().unwrap_or("loosen rtol, or choose another method");
    format!("{steps} steps taken, as many as max_steps allows: {reason}").into()
}

fn into_error(failure: Failure) -> Failed {
    match failure {
        Failure::Recoverable(message) => message.into(),
        Failure::Fatal(error) => error,
    }
}

#[cfg(test)]
mod tests {
    use super::Sampling;

    #[test]
    fn samples_lie_within_the_phase_and_end_with_it() {
        // 3 x 0.1 is a little more than 0.3
        assert_eq!(Sampling::every(0.1).within(0.0, 0.3), [0.1, 0.2, 0.3]);
        assert_eq!(Sampling::every(0.1).within(0.3, 0.45), [0.4, 0.45]);
        assert_eq!(Sampling::at([0.4, 0.1, 0.3, 0.1]).within(0.0, 0.35), [0.1, 0.3, 0.35]);
        assert_eq!(Sampling::phase_ends().within(0.3, 0.45), [0.45]);
    }
}
