//! The steps of an interval: their ends, checks of their results, and the samples within them.
//!
//! A rise of the energy balance of more than a hundredth of the largest energy is a warning in every run.
//! `Method::Auto` then goes back to the last state whose balance was off by less than a tenth of that, and
//! goes on with another method: after BDF first BDF at a tenth of its tolerances, which costs a damped body
//! less than ARKODE and is more precise, then ARKODE; after ARKODE BDF of order 2. The rise counts from the
//! start, and after a phase that ended out of order from there, so that later phases are judged by their own
//! errors. (Counted from each checkpoint, small rises could add up unnoticed.)

use super::auto::{LONG, TRIAL};
use super::events::Met;
use super::failure::{STANDING, crawling, out_of_time, standing_still, too_many_steps};
use super::interval::{Ending, Outcome, RollbackPoint};
use super::phase_run::Running;
use super::progress::{Observer, Progress};
use super::records::{self, energy};
use super::reduced_checks::locked;
use super::run::Run;
use crate::dynamics::phase::{Failed, Stepper};
use crate::dynamics::report::creation;
use crate::dynamics::system::PhaseSystem;
use crate::dynamics::trajectory::{Interrupted, Sample};
use crate::elements::force::Step;
use crate::integrators::ode::Failure;

/// Steps between checks of the energy balance, each of which costs about one evaluation of the forces.
const WATCH: usize = 32;

/// Times within a step at which peaks of sensors are sought: a period that takes ten steps has 40, which miss its peak by 0.3 % at most.
const PARTS: usize = 4;

/// Part of the largest energy that methods may have created in a state from which others continue.
const CLEAN: f64 = 0.001;

impl Run {
    /// Takes one step of an interval, up to the time `bound` (s) at most; returns how the interval ended, if it did.
    ///
    /// The energy balance is checked now and then, and may make a method doubtful that can be replaced.
    pub(super) fn try_step(
        &mut self,
        work: &mut Running,
        bound: f64,
        observer: Observer,
    ) -> Result<Option<Ending>, Failed> {
        if self.phase_run.interval.steps == 0 {
            return Err(too_many_steps(self.settings.max_steps, &work.stepper.counts()));
        }
        if let Some(limit) = self.settings.max_time
            && self.spent.as_secs_f64() >= limit
        {
            let method = self.phase_run.plan.settings.method;
            return Err(out_of_time(limit, method, &work.stepper.counts()));
        }
        self.phase_run.interval.steps -= 1;
        if work.stop != bound {
            work.stepper.stop_at(bound)?;
            work.stop = bound;
        }
        let start = self.time;
        let (step, is_event) = match self.step(work)? {
            Outcome::Taken(step) => (step, false),
            Outcome::CutOff(step) => (step, true),
            Outcome::Refused(t) => return Ok(Some(Ending::Passage(t))),
        };
        if self.steps.is_multiple_of(WATCH) || self.time >= self.phase_run.interval.stop {
            let energy = energy(work.stepper.system(), self.time, &self.state);
            self.trajectory.note_energy(&energy);
            if self.phase_run.plan.is_on_trial() {
                let (created, scale) = self.created(energy.balance());
                let trouble = creation(created, scale);
                match trouble.and_then(|trouble| self.phase_run.plan.instead(&trouble)) {
                    Some(instead) => return Ok(Some(Ending::Doubtful { instead })),
                    // the state that another method would begin with
                    None if created < CLEAN * scale => self.remember(),
                    None => {}
                }
            }
        }
        let (touches, length) = (work.stepper.system().full().touches(), self.phase_length());
        let counts = || work.stepper.counts();
        self.phase_run.crawl.add([start, self.time], length, touches, counts);
        self.report_progress(step, work.stepper.last_order(), observer)?;
        let led = self.phase_run.mean_steps.add([start, self.time]);
        let (taken, mean) = self.phase_run.mean_steps.since_review(self.time);
        if self.phase_run.plan.is_judged(taken) {
            let cost = self.phase_run.cost(self.time, &*work.stepper);
            if let Some(before) = self.phase_run.plan.settle(cost) {
                return Ok(Some(Ending::Better(before)));
            }
        }
        if let Some(mean) = led {
            let refusal = work.stepper.system().full().refusal();
            if let Some(failed) = crawling(LONG, mean, self.time, refusal) {
                return Err(failed);
            }
            if let Some(other) = self.phase_run.plan.turned_back(mean) {
                return Ok(Some(Ending::Better(other)));
            }
        }
        let patience = self.phase_run.plan.patience_of_probes;
        if patience > 0 && taken >= patience {
            let left = self.phase.until - self.time;
            let cost = self.phase_run.cost(self.time, &*work.stepper);
            if let Some(other) = self.phase_run.plan.stalled(mean, taken, left, cost) {
                return Ok(Some(Ending::Better(other)));
            }
            self.phase_run.begin_review(Some(&*work.stepper));
        }
        if is_event {
            return Ok(Some(Ending::Event));
        }
        work.steps += 1;
        if work.steps.is_multiple_of(TRIAL) {
            work.means.rotate_right(1);
            work.means[0] = (self.time - work.trial_began) / TRIAL as f64;
            work.trial_began = self.time;
            if let Some(other) = self.phase_run.plan.reconsidered(work.means, work.steps) {
                return Ok(Some(Ending::Better(other)));
            }
        }
        Ok((self.time >= self.phase_run.interval.end()).then_some(Ending::Reached))
    }

    /// Energy created by the methods (J) if the energy balance is now `balance`, and the scale of energies (J).
    pub(super) fn created(&self, balance: f64) -> (f64, f64) {
        let scale = self.trajectory.report.energy_scale.max(self.least_energy);
        (balance - self.balance, scale)
    }

    /// How long the phase lasts (s).
    fn phase_length(&self) -> f64 {
        let start = self.number.checked_sub(1).map_or(0.0, |k| self.scene.phases()[k].end());
        self.phase.until - start
    }

    /// Keeps the present state to go back to.
    pub(super) fn remember(&mut self) {
        let rollback_point = &mut self.rollback_point;
        (rollback_point.time, rollback_point.taken, rollback_point.samples) =
            (self.time, self.phase_run.interval.taken, self.trajectory.samples().len());
        rollback_point.energies = self.trajectory.noted();
        rollback_point.angles.clone_from(&self.angles);
        rollback_point.peaks.clone_from(&self.trajectory.peaks);
        rollback_point.penetrations.clone_from(&self.trajectory.penetrations);
        rollback_point.state.clone_from(&self.state);
    }

    /// Goes back to the state last kept.
    pub(super) fn go_back(&mut self) {
        let RollbackPoint {
            time,
            ref state,
            taken,
            samples,
            energies,
            ref angles,
            ref peaks,
            ref penetrations,
        } = self.rollback_point;
        self.trajectory.penetrations.clone_from(penetrations);
        self.angles.clone_from(angles);
        self.trajectory.peaks.clone_from(peaks);
        (self.time, self.phase_run.interval.taken, self.standing) = (time, taken, 0);
        self.state.clone_from(state);
        self.trajectory.go_back(samples, energies);
    }

    /// Takes one step, up to the first contact event within it, and the samples within it.
    fn step(&mut self, work: &mut Running) -> Result<Outcome, Failed> {
        let (n, length) = (self.scene.body().dofs(), self.state.len());
        let (end, stop) = (self.stop(), self.phase_run.interval.stop);
        let Running { stepper, sample, .. } = work;
        let stepper = &mut **stepper;
        let reached = stepper.step(end)?;
        let times = [self.time, reached];
        let (events, tolerance) = (&mut self.phase_run.interval.events, self.atol_position);
        let event = match events.met(stepper, &self.state, times, tolerance, sample)? {
            Met::Nothing => None,
            Met::Event(t) => Some(t),
            Met::Passage(t) => return Ok(Outcome::Refused(t)),
        };
        let cut = self.end_within(stepper, event.unwrap_or(reached), sample)?;
        let event = event.filter(|_| cut.is_none());
        // steps that end just before a jump end at it
        let is_at_jump =
            event.or(cut).is_none() && reached >= self.resolution_end() && reached < stop;
        let time = if is_at_jump { stop } else { event.or(cut).unwrap_or(reached) };
        self.standing = if time > self.time { 0 } else { self.standing + 1 };
        if self.standing == STANDING {
            return Err(standing_still(stepper.system().full().refusal()));
        }
        // a step that is refused leaves no samples
        let (system, arrived) = arrival(stepper, event.or(cut), sample)?;
        let before = &self.state[..n];
        system.full().check_step(time, before, arrived).map_err(Failure::into_error)?;
        if let Some(end) = cut {
            self.phase_run.cut = cut;
            self.phase_run.stops.clear();
            self.phase_run.interval.cut(end);
        }
        while let Some(t) = self.phase_run.interval.next_sample().filter(|&t| t <= time) {
            self.phase_run.interval.taken += 1;
            stepper.interpolate(t.min(reached), sample)?;
            let accelerates = self.sensors.need_accelerations();
            let system = stepper.system_mut();
            let taken = records::sample(self.number, system, t, sample, accelerates);
            let mut taken = taken.map_err(Failure::into_error)?;
            self.complete(&mut taken);
            self.trajectory.push(taken);
        }
        if self.sampling.finds_peaks() {
            self.find_peaks(stepper, time.min(reached), sample)?;
        }
        let (system, arrived) = arrival(stepper, event.or(cut), sample)?;
        self.follower.follow(
            &Step {
                times: [self.time, time],
                u: [&self.state[..n], &arrived[..n]],
                v: [&self.state[n..2 * n], &arrived[n..2 * n]],
            },
            || energy(system, time, arrived).kinetic,
            &mut self.trajectory.penetrations,
        );
        let step = time - self.time;
        self.time = time;
        self.steps += 1;
        self.state.copy_from_slice(&arrived[..length]);
        if event.is_some() {
            self.phase_run.interval.events.pass(system.full(), time, &self.state, step);
        }
        let drift = system.full().drift(time, &self.state[..n]);
        let worst = &mut self.trajectory.report.constraint_drift;
        *worst = worst.max(drift);
        self.follow_angles();
        if self.reduced.is_some() {
            self.check_reduced(work.stepper.system_mut()).map_err(Failure::into_error)?;
        }
        Ok(if event.is_some() { Outcome::CutOff(step) } else { Outcome::Taken(step) })
    }

    /// Keeps the residual forces of a reduced model at some of the steps.
    fn check_reduced(&mut self, system: &mut dyn PhaseSystem) -> Result<(), Failure> {
        let phase = [self.phase.until - self.phase_length(), self.phase.until];
        let left_over = system.left_over(self.time, &self.state, phase)?;
        let Some(left_over) = left_over else { return Ok(()) };
        let first = &self.trajectory.samples()[0].u;
        let moved = self.state.iter().zip(first).map(|(u, start)| (u - start).abs());
        let travel = moved.fold(0.0, f64::max);
        if let Some(checks) = &self.reduced {
            locked(checks).keep(left_over, travel);
        }
        Ok(())
    }

    /// Reads the sensors at a few times within a step up to `time`, to find their largest and least values.
    fn find_peaks(
        &mut self,
        stepper: &mut dyn Stepper,
        time: f64,
        state: &mut [f64],
    ) -> Result<(), Failed> {
        for k in 1..=PARTS {
            let t = match k {
                PARTS => time,
                _ => self.time + (time - self.time) * k as f64 / PARTS as f64,
            };
            let seen = self.seen(stepper, t, state)?;
            self.trajectory.note_peaks(&seen.sensors);
        }
        Ok(())
    }

    /// The sample that sensors see at time `t` (s) within the last step; `state` has room for a state.
    pub(super) fn seen(
        &self,
        stepper: &mut dyn Stepper,
        t: f64,
        state: &mut [f64],
    ) -> Result<Sample, Failed> {
        stepper.interpolate(t, state)?;
        let accelerates = self.sensors.need_accelerations();
        let mut seen = match self.sensors.need_forces() {
            true => records::sample(self.number, stepper.system_mut(), t, state, accelerates)
                .map_err(Failure::into_error)?,
            false => records::of_state(self.number, stepper.system().full(), t, state),
        };
        self.complete(&mut seen);
        Ok(seen)
    }

    /// Reports to the observer how far the run has come.
    fn report_progress(&self, step: f64, order: u32, observer: Observer) -> Result<(), Failed> {
        let Self { time, steps, number, .. } = *self;
        let name = &self.phase.name;
        let (phase, trajectory) = (number, &self.trajectory);
        let notice = self.phase_run.crawl.told.as_deref();
        let answer =
            observer(&Progress { time, phase, name, steps, step, order, notice, trajectory });
        // after the last step there is nothing left to stop
        if answer.is_break() && time < self.scene.end() { Err(Interrupted.into()) } else { Ok(()) }
    }
}

/// The state that a step has led to: at its event, or else at its end.
fn arrival<'s>(
    stepper: &'s mut dyn Stepper,
    event: Option<f64>,
    sample: &'s mut [f64],
) -> Result<(&'s dyn PhaseSystem, &'s [f64]), Failed> {
    let Some(t) = event else { return Ok((stepper.system(), stepper.state())) };
    stepper.interpolate(t, sample)?;
    Ok((stepper.system(), sample))
}
