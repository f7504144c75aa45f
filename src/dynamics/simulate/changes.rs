//! Changes of a run between two steps: other forces or constraints, another state, or an earlier one.
//!
//! A command edits a copy of the phase in force: new forces go into the existing equations, new constraints
//! make new equations, and the run goes on from the state at that time. A number that a command has set once
//! is shared by forces and phase (`SharedValue`): the next command sets it and builds nothing, so that ticks of a
//! controller allocate nothing under methods for ODEs. Checkpoints, forks and samples hold a
//! frozen copy; each sample refers to the phase in force at its time.
//!
//! One-step methods keep their step size (`Integrator::resume`), multistep methods start anew in their own memory: a history that
//! is kept does not see a jump below the tolerance at the start of a step, and errors grow
//! (`docs/notes/commands.md`).

use std::mem::{replace, take};
use std::sync::Arc;

use super::auto::Plan;
use super::checkpoint::{Checkpoint, Kept, Record};
use super::interval::Ending;
use super::phase_run::{GoesOn, Integration, MeanSteps, PhaseRun};
use super::records::{self, energy, project};
use super::reduced_checks::locked;
use super::run::Run;
use super::sampling::Sampling;
use super::sensor::Sensors;
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::dynamics::phase::Integrable;
use crate::dynamics::system::{Energy, PhaseSystem};
use crate::dynamics::trajectory::Sample;
use crate::elements::force::Forces;
use crate::scene::constraint::ConstraintRow;
use crate::scene::forces::SharedValue;
use crate::scene::timeline::Phase;

/// Part of the equations that a command changes.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Change {
    /// Forces that store no energy.
    Loads,
    /// Forces that store energy: which obstacles act, how far cells have grown.
    Stores,
    /// Prescribed displacements: nodes that are held or moved.
    Constraints,
}

/// Number of commands in a phase that are taken for single ones.
const NEW_STARTS: usize = 3;

impl Run {
    fn system(&self) -> Option<&dyn PhaseSystem> {
        match &self.integration {
            Integration::Running(work) => Some(work.stepper.system()),
            Integration::Idle(system) => Some(&**system),
            Integration::Absent => None,
        }
    }

    /// The equations in force.
    pub(super) fn system_mut(&mut self) -> Result<&mut dyn PhaseSystem, Error> {
        if let Integration::Absent = self.integration {
            self.integration = Integration::Idle(self.equations(&self.phase, &self.state)?);
        }
        match &mut self.integration {
            Integration::Running(work) => Ok(work.stepper.system_mut()),
            Integration::Idle(system) => Ok(&mut **system),
            Integration::Absent => {
                Err(InputError::new("simulation", "without equations", "restart it").into())
            }
        }
    }

    /// Writes the state at a time (s) within the last step.
    pub(super) fn look(&mut self, t: f64, state: &mut [f64]) -> Result<(), Error> {
        match &mut self.integration {
            Integration::Running(work) if t < self.time => {
                let seen = work.stepper.interpolate(t, &mut work.sample);
                state.copy_from_slice(&work.sample[..self.state.len()]);
                seen.map_err(|source| self.failure(source, 0.0))
            }
            _ => {
                state.copy_from_slice(&self.state);
                Ok(())
            }
        }
    }

    /// Energies of `state` at time `t` (s).
    pub(super) fn energy(&self, t: f64, state: &[f64]) -> Energy {
        match self.system() {
            Some(system) => energy(system, t, state),
            // lost in a panic, or with an integrator that could not be made
            None => self
                .equations(&self.phase, &self.state)
                .map_or_else(|_| Energy::default(), |system| energy(&*system, t, state)),
        }
    }

    /// The sample of `state` at time `t` (s).
    pub(super) fn sample(&mut self, t: f64, state: &[f64]) -> Result<Sample, Error> {
        let number = self.number;
        let accelerates = self.sensors.need_accelerations();
        let sample = records::sample(number, self.system_mut()?, t, state, accelerates);
        let mut sample = sample.map_err(|failure| self.failure(failure.into_error(), 0.0))?;
        self.complete(&mut sample);
        Ok(sample)
    }

    /// Whether another phase follows at time `t` (s), at or before the end of the last step.
    pub(super) fn is_past_phase(&self, t: f64) -> bool {
        self.time <= t && self.time >= self.phase_end() && !self.is_last_phase()
    }

    /// Enters the next phase if the present one is at its end.
    pub(super) fn leave_phase(&mut self) -> Result<(), Error> {
        if !self.is_past_phase(self.time) {
            return Ok(());
        }
        let system = self.rest()?;
        let next = self.next_phase(system)?;
        self.resume(next);
        Ok(())
    }

    /// Makes `state` at time `t` (s), at or before the present one and in the same phase, the
    /// present state.
    pub(super) fn set_state(&mut self, t: f64, state: &[f64]) -> Result<(), Error> {
        let system = self.rest()?;
        if t < self.time {
            let samples = self.trajectory.samples();
            let late = samples.iter().rev().take_while(|sample| sample.time > t).count();
            self.trajectory.go_back(samples.len() - late, self.trajectory.noted());
            self.sample_from(t);
        }
        (self.time, self.standing) = (t, 0);
        self.state.copy_from_slice(state);
        self.resume(system);
        Ok(())
    }

    /// Puts `phase` in force in place of the present one, which differs from it by a `change`.
    pub(super) fn change(&mut self, phase: Phase, change: Change) -> Result<(), Error> {
        let mut forces = self.scene.forces_in(&phase)?;
        if change == Change::Loads {
            self.expect_commands()?;
            match self.change_loads(forces)? {
                None => {
                    self.is_commanded = true;
                    self.phase = Arc::new(phase);
                    self.find_interval();
                    return Ok(());
                }
                Some(refused) => forces = refused,
            }
        }
        let mut system = self.rest()?;
        let constrains = change == Change::Constraints;
        let before = match change {
            Change::Stores => energy(&*system, self.time, &self.state).balance(),
            _ => 0.0,
        };
        if constrains || !system.change_forces(forces) {
            match self.followed_by(&phase, &*system) {
                Ok(next) => system = next,
                Err(error) => {
                    self.resume(system);
                    return Err(error.into());
                }
            }
        } else if change == Change::Stores {
            self.supply(energy(&*system, self.time, &self.state).balance() - before);
        }
        if constrains {
            project(&self.settings, &phase, system.full_mut(), self.time, &mut self.state);
            self.constraints = Arc::new(());
            self.phase_run.follow(Plan::new(&self.settings, &mut *system, self.time, &self.state));
        }
        (self.phase, self.is_commanded) = (Arc::new(phase), true);
        self.resume(system);
        Ok(())
    }

    /// Leaves a method that was chosen automatically for another, if commands keep coming.
    fn expect_commands(&mut self) -> Result<(), Error> {
        self.phase_run.commands += 1;
        let period = self.time - replace(&mut self.phase_run.commanded, self.time);
        // several commands at one time are one
        let part = self.next_step().filter(|_| period > 0.0).map_or(1.0, |step| step / period);
        if self.phase_run.commands > NEW_STARTS
            && let Some(system) = self.system()
            && let Some(plan) = self.phase_run.plan.under_commands(system, part)
        {
            let system = self.rest()?;
            self.phase_run.follow(plan);
            self.resume(system);
        }
        Ok(())
    }

    /// Changes the forces of a running integrator, if it can continue with others; returns them if not.
    fn change_loads(&mut self, forces: Forces) -> Result<Option<Forces>, Error> {
        let (Integration::Running(work), None) = (&mut self.integration, &self.phase_run.ended)
        else {
            return Ok(Some(forces));
        };
        if !work.stepper.system_mut().change_forces(forces.clone()) || !self.keep_on()? {
            return Ok(Some(forces));
        }
        Ok(None)
    }

    /// Sets numbers of the phase in force.
    pub(super) fn set_live(&mut self, live: &SharedValue, values: &[f64]) -> Result<(), Error> {
        self.expect_commands()?;
        live.set(values);
        if !self.keep_on()? {
            let mut system = self.rest()?;
            system.forget_tangents();
            self.resume(system);
        }
        Ok(())
    }

    /// Lets the integrator continue after a jump of the forces, or start again, if one is running and can do so.
    fn keep_on(&mut self) -> Result<bool, Error> {
        let (Integration::Running(work), None) = (&mut self.integration, &self.phase_run.ended)
        else {
            return Ok(false);
        };
        work.stepper.system_mut().forget_tangents();
        match work.go_on(self.time, &self.state) {
            Ok(GoesOn::Here) => {}
            Ok(GoesOn::Anew(counts)) => self.phase_run.restart(counts),
            Ok(GoesOn::Not) => return Ok(false),
            Err(source) => return Err(self.failure(source, 0.0)),
        }
        let (system, located) = (work.stepper.system().full(), self.phase_run.plan.locates());
        self.phase_run.interval.events.begin(system, self.time, &self.state, located);
        self.follower.begin(&self.scene, &self.phase);
        self.remember();
        Ok(true)
    }

    /// A state to return to.
    pub(super) fn checkpoint(&self, time: f64, state: &[f64]) -> Checkpoint {
        let rows = self.system().map_or(&[][..], |system| system.full().rows());
        Checkpoint {
            scene: self.scene.clone(),
            constraints: self.constraints.clone(),
            plan: self.phase_run.plan.clone(),
            record: Record::of(self),
            kept: Kept {
                time,
                state: state.to_vec(),
                phase: self.phase.snapshot(),
                number: self.number,
                is_commanded: self.is_commanded,
                origins: rows.iter().map(ConstraintRow::origin).collect(),
                first_step: self.next_step(),
                steps: self.steps,
                commands: self.phase_run.commands,
                balance: self.balance,
                energies: self.trajectory.noted(),
                angles: self.angles.clone(),
            },
        }
    }

    /// Returns to a state.
    pub(super) fn restore(&mut self, checkpoint: &Checkpoint) -> Result<(), Error> {
        let Checkpoint { scene, constraints, plan, record, kept } = checkpoint;
        let Kept { time, ref state, ref phase, number, balance, steps, .. } = *kept;
        if !Arc::ptr_eq(&self.scene, scene) {
            let help = "it belongs to another simulation: restore it there, or in a fork of that";
            return Err(InputError::new("checkpoint", format!("at {time} s"), help).into());
        }
        let mut system = self.rest()?;
        self.time = time;
        self.state.copy_from_slice(state);
        self.angles.clone_from(&kept.angles);
        if !Arc::ptr_eq(&self.phase, phase) {
            let forces = self.scene.forces_in(phase)?;
            let same = Arc::ptr_eq(&self.constraints, constraints) && system.change_forces(forces);
            if !same {
                system = kept.equations(self)?;
            }
            (self.phase, self.constraints) = (phase.clone(), constraints.clone());
            self.is_commanded = kept.is_commanded;
        }
        if self.number != number {
            self.number = number;
            self.reduced.iter().for_each(|checks| locked(checks).go_back(number));
            self.phase_run = self.new_phase_run(plan.clone());
        }
        self.sample_from(time);
        self.phase_run.follow(plan.clone());
        self.phase_run.go_back(&record.phase);
        (self.phase_run.first_step, self.phase_run.commands) = (kept.first_step, kept.commands);
        self.phase_run.interval.steps = self.settings.max_steps;
        (self.balance, self.standing, self.steps) = (balance, 0, steps);
        let samples = self.trajectory.samples().partition_point(|sample| sample.time <= time);
        let trajectory = &mut self.trajectory;
        trajectory.report = record.report.clone();
        trajectory.penetrations.clone_from(&record.penetrations);
        trajectory.leaps.clone_from(&record.leaps);
        trajectory.go_back(samples.max(1), kept.energies);
        self.resume(system);
        Ok(())
    }

    /// An independent run from `state` at time `t` (s) on.
    pub(super) fn fork(&self, t: f64, state: &[f64]) -> Result<Self, Error> {
        let rows = match self.system() {
            Some(system) => system.full().rows().to_vec(),
            None => self.equations(&self.phase, &self.state)?.full().rows().to_vec(),
        };
        let phase = self.phase.snapshot();
        let forces = self.scene.forces_in(&phase)?;
        let system = self.equations_by(&phase, forces, rows)?;
        let mut run = self.twin();
        run.phase = phase;
        run.time = t;
        run.state.copy_from_slice(state);
        run.sample_from(t);
        run.phase_run.first_step = self.next_step();
        run.resume(system);
        Ok(run)
    }

    /// Size of the next step (s), if it is known.
    fn next_step(&self) -> Option<f64> {
        match &self.integration {
            Integration::Running(work) => work.next_step(),
            _ => self.phase_run.first_step,
        }
    }

    /// Ends the integrator and returns its equations; its step size is kept for the next one.
    fn rest(&mut self) -> Result<Box<dyn Integrable>, Error> {
        self.phase_run.first_step = self.next_step();
        if let Some(Ending::Doubtful { instead: plan } | Ending::Better(plan)) =
            self.phase_run.ended.take()
        {
            self.phase_run.follow(plan);
        }
        match take(&mut self.integration) {
            Integration::Running(work) => Ok(self.phase_run.rest(work)),
            Integration::Idle(system) => Ok(system),
            Integration::Absent => Ok(self.equations(&self.phase, &self.state)?),
        }
    }

    /// Continues from the present state with the equations `system` of the phase in force.
    fn resume(&mut self, system: Box<dyn Integrable>) {
        self.find_stops();
        (self.phase_run.ended, self.phase_run.mean_steps) =
            (Some(Ending::Reached), MeanSteps::default());
        self.begin_events(system.full());
        self.integration = Integration::Idle(system);
        self.follow_angles();
        self.remember();
    }

    /// Finds the end of the interval that the present time lies in, and of those after it.
    pub(super) fn find_interval(&mut self) {
        self.find_stops();
        self.phase_run.interval.stop = self.phase_run.stops.pop().unwrap_or(self.phase_end());
    }

    /// When the phase in force ends (s), as far as that is known.
    fn phase_end(&self) -> f64 {
        self.phase_run.cut.unwrap_or(self.phase.until)
    }

    /// Finds the ends of the intervals that are left of the phase in force.
    fn find_stops(&mut self) {
        if self.phase_run.cut.is_some_and(|cut| self.time < cut) {
            self.phase_run.cut = None;
            self.phase_run.interval.times.uncut();
        }
        let mut stops = Vec::new();
        if self.phase_run.cut.is_none() {
            stops = self.scene.breaks_within(&self.phase, self.time);
            stops.push(self.phase.until);
        }
        stops.reverse();
        (self.phase_run.stops, self.phase_run.interval.inside) = (stops, None);
    }

    /// Counts a sudden change of the stored energy (J) as supplied from outside.
    pub(super) fn supply(&mut self, energy: f64) {
        *self.layout.of_mut(&mut self.state).supplied += energy;
    }

    /// The phase in force from the present time on, integrated by `plan`.
    pub(super) fn new_phase_run(&self, plan: Plan) -> PhaseRun {
        let times = self.sampling.within(self.time, self.phase.until);
        PhaseRun::new(plan, times, self.scene.stops(self.number), self.settings.max_steps)
    }

    /// Takes samples at other times from the end of the last step on.
    pub(super) fn record(&mut self, sampling: &Sampling, sensors: Sensors) {
        self.trajectory.unread(sensors.quantities.clone());
        self.trajectory.peaks.clear();
        self.angles.keep(|name| sensors.quantities.iter().any(|quantity| quantity.name == name));
        (self.sampling, self.sensors) = (sampling.clone(), sensors);
        if self.trajectory.last().time == self.time {
            let mut now = self.trajectory.last().clone();
            if self.sensors.need_accelerations() {
                let (number, time, state) = (self.number, self.time, self.state.clone());
                let again = self.system_mut().ok().map(|system| {
                    records::sample(number, system, time, &state, true)
                        .map(|again| again.accelerations)
                });
                now.accelerations = again.and_then(Result::ok).unwrap_or_default();
            }
            self.complete(&mut now);
            self.trajectory.replace_last(now);
        }
        self.follow_angles();
        self.sample_from(self.time);
        // a rollback does not reach behind this time, as samples before it were taken at other times
        self.remember();
    }

    /// Takes the samples after time `t` (s), whether they were taken before or not.
    fn sample_from(&mut self, t: f64) {
        self.phase_run.interval.times = self.sampling.within(t, self.phase.until);
        self.phase_run.interval.taken = 0;
    }
}
