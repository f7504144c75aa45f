//! Running a scene: phase by phase, with restarts in between and samples along the way.

mod failure;
mod progress;
mod solver;
mod stepper;

use std::iter::Peekable;
use std::ops::ControlFlow;
use std::time::Instant;

pub use failure::{IntegrationFailure, Interrupted};
use failure::{STANDING, into_error, standing_still, too_many_steps};
use progress::Observer;
pub use progress::Progress;
use solver::Tolerances;
pub use solver::{Method, Solver};
use stepper::{Failed, Stepper};

use crate::constraint::{Start, tell};
use crate::error::{Error, positive};
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
    /// Evaluations of the tangents of the forces, of which the Newton matrix is made; none where
    /// they are constant.
    pub jacobian_evaluations: usize,
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
        self.simulate_with(solver, sampling, |_| ControlFlow::Continue(()))
    }

    /// As [`simulate`](Self::simulate), telling `observer` after each step how far the run has
    /// come, until it asks to stop by [`ControlFlow::Break`].
    ///
    /// ```
    /// use std::ops::ControlFlow;
    /// # use pliant::{Body, Cells, Error, Material, Mesh, Phase, Sampling, Scene, Solver};
    /// # let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
    /// # let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
    /// # let body = Body::new(mesh, rubber).thickness(0.01).build()?;
    /// # let scene = Scene::new(body)
    /// #     .phase(Phase::until(0.1).hold("bottom").move_nodes([14, 15], [0.0, -0.16]));
    ///
    /// let patience = |progress: &pliant::simulate::Progress| match progress.steps {
    ///     50 => ControlFlow::Break(()),
    ///     _ => ControlFlow::Continue(()),
    /// };
    /// match scene.simulate_with(&Solver::default(), &Sampling::every(0.01), patience) {
    ///     Err(Error::Integration(end)) if end.is_interruption() => {
    ///         assert_eq!(end.trajectory.report().steps(), 50);
    ///         assert_eq!(end.trajectory.last().time, end.time);
    ///     }
    ///     other => panic!("{other:?}"),
    /// }
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`simulate`](Self::simulate); a run that was stopped ends with [`Error::Integration`],
    /// too, which says so: [`IntegrationFailure::is_interruption`].
    pub fn simulate_with(
        &self,
        solver: &Solver,
        sampling: &Sampling,
        mut observer: impl FnMut(&Progress) -> ControlFlow<()>,
    ) -> Result<Trajectory, Error> {
        let clock = Instant::now();
        solver.validate()?;
        let forces = self.forces()?;
        sampling.validate(self.end())?;
        Run::new(self, solver, clock).all(forces, sampling, &mut observer)
    }
}

/// A scene on its way.
struct Run<'a> {
    scene: &'a Scene,
    solver: &'a Solver,
    atol: Tolerances,
    /// Started with the run.
    clock: Instant,
    time: f64,
    /// (u, v, energies)
    state: Vec<f64>,
    /// Steps taken since t = 0.
    steps: usize,
    /// Steps in a row that did not move time ahead.
    standing: usize,
    trajectory: Trajectory,
}

impl<'a> Run<'a> {
    fn new(scene: &'a Scene, solver: &'a Solver, clock: Instant) -> Self {
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
            clock,
            time: 0.0,
            state: [scene.start().as_slice().concat(), vec![0.0; ENERGIES]].concat(),
            steps: 0,
            standing: 0,
            trajectory: Trajectory::new(scene, report),
        }
    }

    fn all(
        mut self,
        forces: Vec<Forces>,
        sampling: &Sampling,
        observer: Observer,
    ) -> Result<Trajectory, Error> {
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
            if let Err((source, step)) = self.phase(number, phase, system, sampling, observer) {
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
        observer: Observer,
    ) -> Result<(), (Failed, f64)> {
        let clock = Instant::now();
        let end = phase.until;
        if number == 0 {
            let state = self.state.clone();
            self.sample(number, &mut system, 0.0, &state).map_err(|source| (source, 0.0))?;
        }
        let mut times = sampling.within(self.time, end).into_iter().peekable();
        let mut stepper =
            Stepper::new(system, self.solver, &self.atol, self.time, end, &self.state)
                .map_err(|source| (source, 0.0))?;
        let mut sample = vec![0.0; stepper.size()];
        let mut result = Ok(());
        let before = self.steps;
        while result.is_ok() && self.time < end {
            let steps = self.steps - before;
            result = match steps == self.solver.max_steps {
                false => self
                    .step(number, end, &mut stepper, &mut times, &mut sample)
                    .and_then(|step| self.tell(number, step, stepper.last_order(), observer)),
                true => Err(too_many_steps(steps, &stepper.counts())),
            };
        }
        if result.is_err() && self.time > self.trajectory.last().time {
            // the state that the last step led to, unless the equations have no meaning there
            let state = self.state.clone();
            let _ = self.sample(number, stepper.system_mut(), self.time, &state);
        }
        let counts = stepper.counts();
        let step = counts.last_step;
        let report = &mut self.trajectory.report;
        report.wall_seconds = self.clock.elapsed().as_secs_f64();
        report.states = stepper.size();
        report.phases.push(PhaseReport {
            name: phase.name.clone(),
            end: self.time,
            wall_seconds: clock.elapsed().as_secs_f64(),
            counts,
        });
        result.map_err(|source| (source, step))
    }

    /// Takes one step, and the samples within it. Returns its size (s).
    fn step(
        &mut self,
        number: usize,
        end: f64,
        stepper: &mut Stepper,
        times: &mut Peekable<impl Iterator<Item = f64>>,
        sample: &mut [f64],
    ) -> Result<f64, Failed> {
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
            self.sample(number, stepper.system_mut(), t, sample)?;
        }
        let step = time - self.time;
        self.time = time;
        self.steps += 1;
        let length = self.state.len();
        self.state.copy_from_slice(&stepper.state()[..length]);
        let drift = stepper.system().drift(time, &self.state[..n]);
        let worst = &mut self.trajectory.report.constraint_drift;
        *worst = worst.max(drift);
        Ok(step)
    }

    /// Tells how far the run has come.
    fn tell(&self, phase: usize, step: f64, order: u32, observer: Observer) -> Result<(), Failed> {
        let Self { time, steps, .. } = *self;
        let name = &self.scene.phases()[phase].name;
        let answer = observer(&Progress { time, phase, name, steps, step, order });
        // the last step leaves nothing to be stopped
        if answer.is_break() && time < self.scene.end() { Err(Interrupted.into()) } else { Ok(()) }
    }

    /// Records `state` = (u, v, energies, ...) at `time`.
    fn sample(
        &mut self,
        phase: usize,
        system: &mut System,
        time: f64,
        state: &[f64],
    ) -> Result<(), Failed> {
        let n = system.dofs();
        let (u, v) = (&state[..n], &state[n..2 * n]);
        let multipliers = system.multipliers(time, u, v).map_err(into_error)?.to_vec();
        let mut energy = system.energy(time, u, v);
        energy.dissipated = state[2 * n];
        energy.supplied = state[2 * n + 1];
        self.trajectory.push(Sample {
            time,
            phase,
            u: u.to_vec(),
            v: v.to_vec(),
            multipliers,
            energy,
            constraint_drift: system.drift(time, u),
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
