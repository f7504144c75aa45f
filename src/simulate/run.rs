//! A scene on its way: phases, the legs they consist of, and samples.

use std::time::Instant;

use super::auto::{Plan, TRIAL};
use super::events::{Events, Met};
use super::failure::{STANDING, standing_still, too_many_steps};
use super::leg::{Checkpoint, Ending, Leg, Outcome};
use super::progress::{Observer, Progress};
use super::records::{self, energy, project};
use super::sampling::Sampling;
use super::stepper::{self, Failed, Stepper};
use crate::constraint::{PhaseStart, prescribe};
use crate::error::Error;
use crate::force::Forces;
use crate::ode::Failure;
use crate::report::{Counts, PhaseReport, Report, creation};
use crate::scene::{Phase, Scene};
use crate::settings::{AbsoluteTolerances, Method, Settings};
use crate::state::ENERGIES;
use crate::system::System;
use crate::trajectory::{IntegrationFailure, Interrupted, Trajectory};

/// A scene on its way.
pub(super) struct Run<'a> {
    scene: &'a Scene,
    settings: &'a Settings,
    atol: AbsoluteTolerances,
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
    /// Where the energy balance last was in order.
    good: Checkpoint,
    /// Energy balance (J) that methods are judged by: that of the start or, once a phase has ended with one
    /// that was not in order, of the next one, which is not to blame for that.
    balance: f64,
    /// Energies below this (J) are too small to be watched.
    least_energy: f64,
}

/// Steps between looks at the energy balance, each of which costs about one evaluation of the forces.
const WATCH: usize = 32;

impl<'a> Run<'a> {
    /// Runs `scene` under the `forces` of its phases.
    pub(super) fn all(
        scene: &'a Scene,
        settings: &'a Settings,
        clock: Instant,
        forces: Vec<Forces>,
        sampling: &Sampling,
        observer: Observer,
    ) -> Result<Trajectory, Error> {
        let n = scene.body().dofs();
        let model = scene.model(&forces);
        let mut forces = forces.into_iter();
        let mut equations = |phase: &Phase, time: f64, u: &[f64]| {
            let forces = forces.next().unwrap_or_default();
            scene.system(&model, phase, forces, &PhaseStart { time, u }, settings.alpha)
        };
        let mut system = equations(scene.first_phase()?, 0.0, scene.start()[0])?;
        let mut run = Self::new(scene, settings, clock, &mut system)?;
        for (number, phase) in scene.phases().iter().enumerate() {
            if number > 0 {
                let mut u = run.state[..n].to_vec();
                prescribe(system.rows(), run.time, &mut u);
                let next = equations(phase, run.time, &u)?;
                // an obstacle that begins or ceases to act with nodes inside it changes what is stored:
                // that comes from outside
                let [before, after] =
                    [&system, &next].map(|system| energy(system, run.time, &run.state).balance());
                run.state[2 * n + 1] += after - before;
                system = next;
                project(settings, phase, &mut system, run.time, &mut run.state);
            }
            system = match run.phase(number, phase, system, sampling, observer) {
                Ok(system) => system,
                Err((source, step)) => return Err(run.failure(phase, source, step)),
            };
        }
        Ok(run.trajectory)
    }

    /// A run at its start, which `system` is sampled at.
    fn new(
        scene: &'a Scene,
        settings: &'a Settings,
        clock: Instant,
        system: &mut System,
    ) -> Result<Self, Error> {
        let mut state = [scene.start().as_slice().concat(), vec![0.0; ENERGIES]].concat();
        project(settings, scene.first_phase()?, system, 0.0, &mut state);
        let first =
            records::sample(0, system, 0.0, &state).map_err(|failure| scene.bad_start(failure))?;
        if !first.energy.balance().is_finite() {
            let reason = "the energies are beyond the range of double precision";
            return Err(scene.bad_start(Failure::Recoverable(reason.into())).into());
        }
        let report = Report {
            method: settings.method,
            rtol: settings.rtol,
            alpha: settings.alpha,
            ..Report::default()
        };
        Ok(Self {
            scene,
            settings,
            atol: settings.tolerances(scene.body()),
            clock,
            time: 0.0,
            state,
            steps: 0,
            standing: 0,
            good: Checkpoint::default(),
            balance: first.energy.balance(),
            trajectory: Trajectory::new(scene, report, first),
            // that of strains of a thousandth
            least_energy: 1e-6 * scene.body().material().young * scene.body().volume(),
        })
    }

    /// Integrates one phase to its end, and gives its equations back.
    fn phase(
        &mut self,
        number: usize,
        phase: &Phase,
        mut system: System,
        sampling: &Sampling,
        observer: Observer,
    ) -> Result<System, (Failed, f64)> {
        let clock = Instant::now();
        let times = sampling.within(self.time, phase.until);
        let mut plan = Plan::new(self.settings, &mut system, self.time, &self.state);
        let (steps, mut events) = (self.settings.max_steps, Events::default());
        events.begin(&system, self.time, &self.state, plan.locates());
        let mut leg =
            Leg { number, times: &times, taken: 0, stop: 0.0, inside: None, steps, events };
        let (mut counts, mut states) = (Counts::default(), 0);
        let mut stops = self.scene.breaks(number).into_iter().chain([phase.until]);
        let balance = energy(&system, self.time, &self.state).balance();
        if self.created(balance).is_some() {
            self.balance = balance;
        }
        self.remember(&leg);
        let mut ended = Ok(Ending::Reached);
        let result = loop {
            match ended {
                Err(source) => break Err(source),
                Ok(Ending::Reached) if leg.inside.take().is_some() => {}
                Ok(Ending::Reached) => match stops.next() {
                    Some(stop) => leg.stop = stop,
                    None => break Ok(()),
                },
                Ok(Ending::Event) => leg.inside = None,
                // a step that ends within the obstacle feels it
                Ok(Ending::Passage(t)) => leg.inside = Some(t),
                Ok(Ending::Better(other)) => {
                    plan = other;
                    counts.notice = None;
                    leg.events.begin(&system, self.time, &self.state, plan.locates());
                }
                Ok(Ending::Doubtful { instead }) => {
                    self.go_back(&mut leg);
                    ended = Ok(Ending::Better(instead));
                    continue;
                }
            }
            if self.time >= leg.end() {
                // an event, or a look at the method, just where the leg ends
                ended = Ok(Ending::Reached);
                continue;
            }
            system.forget_counts();
            let stepper = stepper::start(
                system,
                &plan.settings,
                &self.atol,
                self.time,
                leg.end(),
                &self.state,
            );
            let mut stepper = stepper.map_err(|source| (source, 0.0))?;
            ended = self.leg(&mut leg, &plan, &mut *stepper, observer);
            counts.add(stepper.counts());
            states = stepper.state().len();
            system = stepper.into_system();
        };
        if result.is_err() && self.time > self.trajectory.last().time {
            // the state that the last step led to, unless the equations have no meaning there
            let last = records::sample(number, &mut system, self.time, &self.state);
            last.into_iter().for_each(|sample| self.trajectory.push(sample));
        }
        counts.contact_events = leg.events.count;
        if plan.reason.is_some() && plan.settings.method == Method::Rk {
            // what it notices of stability, the choice of methods looks after
            counts.notice = None;
        }
        let step = counts.last_step;
        let report = &mut self.trajectory.report;
        report.wall_seconds = self.clock.elapsed().as_secs_f64();
        report.states = states;
        report.phases.push(PhaseReport {
            name: phase.name.clone(),
            end: self.time,
            states,
            wall_seconds: clock.elapsed().as_secs_f64(),
            method: plan.settings.method,
            reason: plan.reason,
            counts,
        });
        result.map(|()| system).map_err(|source| (source, step))
    }

    /// Integrates to the end of a leg, unless the energy balance casts doubt on a method that can be
    /// exchanged.
    fn leg(
        &mut self,
        leg: &mut Leg,
        plan: &Plan,
        stepper: &mut dyn Stepper,
        observer: Observer,
    ) -> Result<Ending, Failed> {
        let mut sample = vec![0.0; stepper.state().len()];
        // mean step sizes (s) of the last two trials
        let (mut steps, mut trial_began, mut means) = (0_usize, self.time, [f64::INFINITY; 2]);
        while self.time < leg.end() {
            if leg.steps == 0 {
                return Err(too_many_steps(self.settings.max_steps, &stepper.counts()));
            }
            leg.steps -= 1;
            let (step, is_event) = match self.step(leg, stepper, &mut sample)? {
                Outcome::Taken(step) => (step, false),
                Outcome::CutOff(step) => (step, true),
                Outcome::Refused(t) => return Ok(Ending::Passage(t)),
            };
            if self.steps.is_multiple_of(WATCH) || self.time >= leg.stop {
                let energy = energy(stepper.system(), self.time, &self.state);
                self.trajectory.note_energy(&energy);
                if plan.is_on_trial() {
                    let created = self.created(energy.balance());
                    match created.and_then(|trouble| plan.instead(&trouble)) {
                        Some(instead) => return Ok(Ending::Doubtful { instead }),
                        None => self.remember(leg),
                    }
                }
            }
            self.report_progress(leg.number, step, stepper.last_order(), observer)?;
            if is_event {
                return Ok(Ending::Event);
            }
            steps += 1;
            if steps.is_multiple_of(TRIAL) {
                means = [(self.time - trial_began) / TRIAL as f64, means[0]];
                trial_began = self.time;
                if let Some(other) = plan.reconsidered(means, steps) {
                    return Ok(Ending::Better(other));
                }
            }
        }
        Ok(Ending::Reached)
    }

    /// What the methods have created if the energy balance is now `balance` (J), if it is too much.
    fn created(&self, balance: f64) -> Option<String> {
        let scale = self.trajectory.report.energy_scale.max(self.least_energy);
        creation(balance - self.balance, scale)
    }

    /// Keeps the present state to go back to.
    fn remember(&mut self, leg: &Leg) {
        let Report { energy_error, energy_created, energy_scale, .. } = self.trajectory.report;
        let good = &mut self.good;
        (good.time, good.taken, good.samples) =
            (self.time, leg.taken, self.trajectory.samples().len());
        good.energies = [energy_error, energy_created, energy_scale];
        good.state.clone_from(&self.state);
    }

    /// Goes back to the state last kept.
    fn go_back(&mut self, leg: &mut Leg) {
        let Checkpoint { time, ref state, taken, samples, energies } = self.good;
        (self.time, leg.taken, self.standing) = (time, taken, 0);
        self.state.clone_from(state);
        self.trajectory.go_back(samples, energies);
    }

    /// Takes one step, up to the first contact event within it, and the samples there are.
    fn step(
        &mut self,
        leg: &mut Leg,
        stepper: &mut dyn Stepper,
        sample: &mut [f64],
    ) -> Result<Outcome, Failed> {
        let (n, length) = (self.scene.body().dofs(), self.state.len());
        let reached = stepper.step(leg.end())?;
        let times = [self.time, reached];
        let event = match leg.events.met(stepper, &self.state, times, self.atol.position, sample)? {
            Met::Nothing => None,
            Met::Event(t) => Some(t),
            Met::Passage(t) => return Ok(Outcome::Refused(t)),
        };
        let time = event.unwrap_or(reached);
        self.standing = if time > self.time { 0 } else { self.standing + 1 };
        if self.standing == STANDING {
            return Err(standing_still(stepper.system().refusal()));
        }
        // a step that is refused leaves no samples
        let (system, arrived) = arrival(stepper, event, sample)?;
        let before = &self.state[..n];
        system.check_step(time, before, &arrived[..n]).map_err(Failure::into_error)?;
        while let Some(t) = leg.times.get(leg.taken).filter(|&t| t <= time) {
            leg.taken += 1;
            stepper.interpolate(t, sample)?;
            let taken = records::sample(leg.number, stepper.system_mut(), t, sample);
            self.trajectory.push(taken.map_err(Failure::into_error)?);
        }
        let (system, arrived) = arrival(stepper, event, sample)?;
        let step = time - self.time;
        self.time = time;
        self.steps += 1;
        self.state.copy_from_slice(&arrived[..length]);
        if event.is_some() {
            leg.events.pass(system, time, &self.state, step);
        }
        let drift = system.drift(time, &self.state[..n]);
        let worst = &mut self.trajectory.report.constraint_drift;
        *worst = worst.max(drift);
        Ok(if event.is_some() { Outcome::CutOff(step) } else { Outcome::Taken(step) })
    }

    /// Tells how far the run has come.
    fn report_progress(
        &self,
        phase: usize,
        step: f64,
        order: u32,
        observer: Observer,
    ) -> Result<(), Failed> {
        let Self { time, steps, .. } = *self;
        let name = &self.scene.phases()[phase].name;
        let answer = observer(&Progress { time, phase, name, steps, step, order });
        // the last step leaves nothing to be stopped
        if answer.is_break() && time < self.scene.end() { Err(Interrupted.into()) } else { Ok(()) }
    }

    fn failure(self, phase: &Phase, source: Failed, step: f64) -> Error {
        Box::new(IntegrationFailure {
            phase: phase.name.clone(),
            method: self.settings.method,
            time: self.time,
            step,
            source,
            trajectory: self.trajectory,
        })
        .into()
    }
}

/// Where a step has led, by its event or else by itself.
fn arrival<'s>(
    stepper: &'s mut dyn Stepper,
    event: Option<f64>,
    sample: &'s mut [f64],
) -> Result<(&'s System, &'s [f64]), Failed> {
    let Some(t) = event else { return Ok((stepper.system(), stepper.state())) };
    stepper.interpolate(t, sample)?;
    Ok((stepper.system(), sample))
}
