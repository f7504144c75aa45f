//! The run of a scene: phases one after the other, and their intervals.
//!
//! The loop is a state machine: each call takes a step of the current interval, or begins the next interval
//! or phase. `Scene::simulate` calls it to the end, a `Simulation` until the time that its user asks for.
//! Readings lie within the last step and are interpolated, so that reading changes no digit. Phases end at a
//! stop time, as equations change there; samples never shorten a step. An integrator that gives up leaves
//! reason, time and step size, with the trajectory until then.

use std::mem::take;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use super::angles::Angles;
use super::auto::Plan;
use super::failure::in_mechanics;
use super::interval::{Ending, RollbackPoint};
use super::phase_run::{Integration, PhaseRun, Running};
use super::progress::Observer;
use super::records::{self, begin_to_move, energy, project};
use super::reduced_checks::{ReducedChecks, locked};
use super::resolution::Resolution;
use super::sampling::Sampling;
use super::sensor::Sensors;
use super::step_list::Prescribed;
use super::view::{Gauges, View};
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::dynamics::indicators::{self, Follower};
use crate::dynamics::matrices::Matrices;
use crate::dynamics::phase::{Failed, Integrable, Start};
use crate::dynamics::report::{PhaseReport, Report, SensorErrorEstimate, creation};
use crate::dynamics::state::{Layout, State};
use crate::dynamics::system::{PhaseSystem, ResidualSnapshot, System};
use crate::dynamics::trajectory::{IntegrationFailure, Interrupted, Leap, Sample, Trajectory};
use crate::elements::body::{Body, Part};
use crate::elements::force::Forces;
use crate::integrators::ode::Failure;
use crate::scene::constraint::{ConstraintRow, PhaseStart, check_rigid_holds, prescribe};
use crate::scene::settings::{Method, Scales, Settings};
use crate::scene::timeline::{Phase, Scene};

/// The next step in multiples of the size that is known, at most.
const AHEAD: f64 = 2.0;

/// Paths that begin nearer to their nodes than this part of the size of the body begin there: the rest is rounding.
const LEAST_LEAP: f64 = 1e-9;

/// Breaks no farther away than this, in parts of their time, are passed without a step, which round-off would take.
const NEAREST: f64 = 16.0 * f64::EPSILON;

/// The run of a scene.
pub(super) struct Run {
    pub(super) scene: Arc<Scene>,
    pub(super) settings: Settings,
    pub(super) matrices: Arc<Matrices>,
    pub(super) gauges: Arc<Gauges>,
    pub(super) sampling: Sampling,
    pub(super) sensors: Sensors,
    /// The angles among them at the present time.
    pub(super) angles: Angles,
    scales: Scales,
    /// Absolute tolerance of displacements as requested (m).
    pub(super) atol_position: f64,
    /// Started with the run.
    clock: Instant,
    /// Wall-clock time of its start and its steps, if that is limited.
    pub(super) spent: Duration,
    /// The phase in force, as commands have changed it, and its number.
    pub(super) phase: Arc<Phase>,
    pub(super) number: usize,
    /// Whether commands have changed it.
    pub(super) is_commanded: bool,
    /// Identity of the constraints in force.
    pub(super) constraints: Arc<()>,
    pub(super) phase_run: PhaseRun,
    pub(super) integration: Integration,
    pub(super) time: f64,
    pub(super) state: Vec<f64>,
    /// Positions of its unknowns.
    pub(super) layout: Layout,
    /// Steps taken since t = 0.
    pub(super) steps: usize,
    /// Steps in a row that did not move time ahead.
    pub(super) standing: usize,
    pub(super) trajectory: Trajectory,
    /// Follows the surface into obstacles.
    pub(super) follower: Follower,
    /// The last state whose energy balance was in order.
    pub(super) rollback_point: RollbackPoint,
    /// Reference value (J) of the energy balance by which methods are judged: that at the start or, once a
    /// phase has ended with one that was not in order, that at the start of the next phase, which did not
    /// cause the error.
    pub(super) balance: f64,
    /// Energies below this (J) are too small to be watched.
    pub(super) least_energy: f64,
    /// A time (s) at which steps end, though no interval does.
    pub(super) pause: Option<f64>,
    /// The steps of another run, if it follows them.
    pub(super) prescribed: Option<Prescribed>,
    /// The bounds of the steps of the interval, and how many times as often as its tolerance takes functions of programs are looked at for
    /// them.
    resolution: Resolution,
    pub(super) looks: f64,
    /// Error checks of the reduced model, if the scene is run by one.
    pub(super) reduced: Option<Mutex<ReducedChecks>>,
}

impl Run {
    /// A run of `scene` under the `forces` of its first phase, at its start.
    pub(super) fn new(
        scene: &Scene,
        settings: &Settings,
        (sampling, sensors): (&Sampling, Sensors),
        clock: Instant,
        (matrices, gauges): (Arc<Matrices>, Gauges),
        forces: Forces,
    ) -> Result<Self, Error> {
        let phase = scene.first_phase()?;
        scene.check_ends()?;
        let (u, v) = (scene.initial_displacements(), scene.initial_velocities()?);
        let start = PhaseStart { time: 0.0, u };
        let full = scene.system(&matrices, phase, forces, &start, settings.alpha)?;
        let mut equations = scene.phase_system(full, &phase.name)?;
        let system = equations.full();
        if system.relaxation_rate() > 0.0 && !settings.method.information().has_internal_unknowns {
            let takes = Method::names(|row| row.has_internal_unknowns);
            let help = format!("bodies with Maxwell branches are for {takes}");
            return Err(InputError::new("method", settings.method, help).into());
        }
        indicators::overlap::check_start(scene)?;
        if let Some(why) = settings.method.why_not(scene) {
            return Err(InputError::new("method", settings.method, why).into());
        }
        let mut internal = system.relaxed(u);
        if let Some(branches) = &matrices.branches {
            scene.start_branches(branches, &mut internal);
        }
        let layout = system.layout();
        let mut state = layout.state(u, &v, &internal);
        begin_to_move(settings, phase, equations.full_mut(), &mut state);
        let accelerates = sensors.need_accelerations();
        let mut first = records::sample(0, &mut *equations, 0.0, &state, accelerates)
            .map_err(|failure| scene.bad_start(failure))?;
        if !first.energy.balance().is_finite() {
            let reason = "the energies are beyond the range of double precision";
            return Err(scene.bad_start(Failure::Recoverable(reason.into())).into());
        }
        let scales = Scales::of(scene);
        let atol_position = settings.tolerances_by(&scales).position;
        let report = Report {
            method: settings.method,
            rtol: settings.rtol,
            atol_position,
            alpha: settings.alpha,
            plane: scene.body().planes(),
            ..Report::default()
        };
        let plan = Plan::new(settings, &mut *equations, 0.0, &state);
        let times = sampling.within(0.0, phase.until);
        let (phase, balance) = (Arc::new(phase.clone()), first.energy.balance());
        let mut angles = Angles::default();
        scene.starting_angles().for_each(|(name, turns)| angles.note(name, turns));
        records::complete(&mut first, (&sensors, &angles), (scene, &gauges), &phase, false);
        let mut trajectory = Trajectory::new(scene, report, first);
        trajectory.sensors = sensors.quantities.clone();
        let mut run = Self {
            phase_run: PhaseRun::new(plan, times, scene.stops(0), settings.max_steps),
            phase,
            is_commanded: false,
            number: 0,
            constraints: Arc::new(()),
            integration: Integration::Absent,
            settings: settings.clone(),
            matrices,
            gauges: Arc::new(gauges),
            sampling: sampling.clone(),
            sensors,
            angles,
            scales,
            atol_position,
            spent: clock.elapsed(),
            clock,
            time: 0.0,
            state,
            layout,
            steps: 0,
            standing: 0,
            rollback_point: RollbackPoint::default(),
            balance,
            follower: Follower::new(scene),
            trajectory,
            least_energy: least_energy(scene.body()),
            pause: None,
            prescribed: None,
            resolution: Resolution::default(),
            looks: 1.0,
            reduced: scene.reduced_model().map(|model| {
                Mutex::new(ReducedChecks::new(scene, model, sampling.keeps_lacking()))
            }),
            scene: Arc::new(scene.clone()),
        };
        run.follow_angles();
        let phase = run.phase.clone();
        run.note_leap(equations.full(), &phase, u);
        run.begin(&*equations);
        run.integration = Integration::Idle(equations);
        Ok(run)
    }

    /// Takes a step; `false` at the end of the scene, where there is none.
    pub(super) fn advance(&mut self, observer: Observer) -> Result<bool, Error> {
        self.sensors.ending(&self.phase)?;
        if self.settings.max_time.is_none() {
            return self.take_step(observer);
        }
        let began = Instant::now();
        let outcome = self.take_step(observer);
        self.spent += began.elapsed();
        outcome
    }

    fn take_step(&mut self, observer: Observer) -> Result<bool, Error> {
        loop {
            let system = match take(&mut self.integration) {
                Integration::Running(mut work) if self.phase_run.ended.is_none() => {
                    let bound = self.bound(work.next_step());
                    let mut ended = self.try_step(&mut work, bound, observer);
                    self.integration = Integration::Running(work);
                    if let Err(source) = &ended
                        && let Some(before) = self.phase_run.plan.after_failure(source, self.time)
                    {
                        ended = Ok(Some(Ending::Better(before)));
                    }
                    self.phase_run.ended = ended.map_err(|source| self.give_up(source))?;
                    return Ok(true);
                }
                Integration::Running(work) => self.phase_run.rest(work),
                Integration::Idle(system) => system,
                Integration::Absent => {
                    let system = self.equations(&self.phase, &self.state)?;
                    self.begin_events(system.full());
                    system
                }
            };
            if !self.go_on(system)? {
                return Ok(false);
            }
        }
    }

    /// Begins the next interval, if necessary that of the next phase; `false` at the end of the scene.
    pub(super) fn go_on(&mut self, mut system: Box<dyn Integrable>) -> Result<bool, Error> {
        loop {
            match self.phase_run.ended.take() {
                Some(Ending::Reached) if self.phase_run.interval.inside.take().is_some() => {}
                Some(Ending::Reached) => match self.phase_run.stops.pop() {
                    Some(stop) => self.phase_run.interval.stop = stop,
                    None if self.is_last_phase() => {
                        self.phase_run.ended = Some(Ending::Reached);
                        self.integration = Integration::Idle(system);
                        return Ok(false);
                    }
                    None => system = self.next_phase(system)?,
                },
                Some(Ending::Event) => self.phase_run.interval.inside = None,
                // a step that ends inside the obstacle has its force
                Some(Ending::Passage(t)) => self.phase_run.interval.inside = Some(t),
                Some(Ending::Better(other)) => {
                    self.phase_run.follow(other);
                    self.begin_events(system.full());
                }
                Some(Ending::Doubtful { instead }) => {
                    self.go_back();
                    self.find_interval();
                    self.phase_run.follow(instead);
                    self.begin_events(system.full());
                }
                None => {}
            }
            let end = self.phase_run.interval.end();
            let is_break = end < self.phase.until && end == self.phase_run.interval.stop;
            if is_break && self.time < end && end - self.time <= NEAREST * end.abs() {
                self.time = end;
            }
            if self.time < end {
                break;
            }
            // an event, or a review of the method, exactly at the end of the interval
            self.phase_run.ended = Some(Ending::Reached);
        }
        system.forget_counts();
        let (end, first) = (self.stop(), self.phase_run.first_step.take());
        let settings = &self.phase_run.plan.settings;
        let start = Start {
            settings,
            atol: &settings.tolerances_by(&self.scales),
            state: &self.state,
            time: self.time,
            first,
            prescribed: self.prescribed.is_some(),
        };
        let started = system.start(&start).and_then(|mut stepper| {
            stepper.stop_at(end)?;
            Ok(Running::new(stepper, self.time, end))
        });
        self.integration =
            Integration::Running(started.map_err(|source| self.failure(source, 0.0))?);
        Ok(true)
    }

    /// Where steps end (s).
    pub(super) fn stop(&self) -> f64 {
        self.pause.unwrap_or(f64::INFINITY).min(self.phase_run.interval.end())
    }

    /// Where the next step ends at the latest (s), if its size (s) is known to be `next`: before it passes over what changes with time,
    /// and before a jump at the end of the interval.
    fn bound(&mut self, next: Option<f64>) -> f64 {
        let stop = self.phase_run.interval.stop;
        if !self.resolution.is_of(&self.phase, self.time, stop) {
            let span = [self.time, stop];
            let looks = [self.settings.rtol, self.looks];
            self.resolution = Resolution::new(&self.scene, &self.phase, span, looks);
        }
        let end = match self.stop() {
            end if end == stop => self.resolution.end(),
            end => end,
        };
        if let Some(prescribed) = &mut self.prescribed {
            return prescribed.end(self.time, stop, end);
        }
        // a step that is known may be stretched towards its end
        let until = next.map_or(end, |next| end.min(self.time + AHEAD * next));
        self.resolution.bound(self.time, until).unwrap_or(end)
    }

    /// Where the last step of the interval ends (s).
    pub(super) fn resolution_end(&self) -> f64 {
        self.resolution.end()
    }

    pub(super) fn is_last_phase(&self) -> bool {
        self.number + 1 == self.scene.phases().len()
    }

    /// Begins the phase after that of `system`.
    pub(super) fn next_phase(
        &mut self,
        system: Box<dyn Integrable>,
    ) -> Result<Box<dyn Integrable>, Error> {
        self.trajectory.report = self.report();
        let scene = self.scene.clone();
        let phase = scene.phases()[self.number + 1].clone();
        let phase = Arc::new(phase.after(&self.phase, scene.obstacles(), self.time));
        let mut next = self.followed_by(&phase, &*system)?;
        (self.number, self.phase, self.is_commanded) =
            (self.number + 1, phase.clone(), phase.is_redirected());
        project(&self.settings, &phase, next.full_mut(), self.time, &mut self.state);
        let plan = Plan::new(&self.settings, &mut *next, self.time, &self.state);
        (self.phase_run, self.constraints) = (self.new_phase_run(plan), Arc::new(()));
        self.begin(&*next);
        Ok(next)
    }

    /// The equations of `phase`, which follows that of `system`.
    pub(super) fn followed_by(
        &mut self,
        phase: &Phase,
        system: &dyn PhaseSystem,
    ) -> Result<Box<dyn Integrable>, InputError> {
        let n = self.scene.body().dofs();
        let mut u = self.state[..n].to_vec();
        prescribe(system.full().rows(), self.time, &mut u);
        let next = self.equations(phase, &u)?;
        self.note_leap(next.full(), phase, &u);
        // an obstacle that begins or ceases to act with nodes inside it changes the stored energy: the
        // difference is supplied from outside
        let [before, after] =
            [system, &*next].map(|system| energy(system, self.time, &self.state).balance());
        self.supply(after - before);
        Ok(next)
    }

    /// Notes paths of the phase of `system` that begin away from where the displacements `u` (m) have their nodes.
    fn note_leap(&mut self, system: &System, phase: &Phase, u: &[f64]) {
        let body = self.scene.body();
        let (at, least) = ((u, body.dimension()), LEAST_LEAP * body.size());
        self.trajectory.leaps.extend(Leap::of(system.rows(), phase.name(), self.time, at, least));
    }

    /// The equations of a phase that begins with the displacements at the beginning of `u`.
    pub(super) fn equations(
        &self,
        phase: &Phase,
        u: &[f64],
    ) -> Result<Box<dyn Integrable>, InputError> {
        self.scene.phase_system(self.full_equations(phase, u)?, phase.name())
    }

    /// As [`equations`](Self::equations), in all unknowns.
    pub(super) fn full_equations(&self, phase: &Phase, u: &[f64]) -> Result<System, InputError> {
        let start = PhaseStart { time: self.time, u };
        let forces = self.scene.forces_in(phase)?;
        let alpha = self.settings.alpha;
        let system = self.scene.system(&self.matrices, phase, forces, &start, alpha)?;
        check_rigid_holds(system.rows(), self.scene.body(), phase.name(), &start)?;
        Ok(system)
    }

    /// The equations of a phase under `forces` and the `rows` of its constraints.
    pub(super) fn equations_by(
        &self,
        phase: &Phase,
        forces: Forces,
        rows: Vec<ConstraintRow>,
    ) -> Result<Box<dyn Integrable>, InputError> {
        let (matrices, alpha) = (self.matrices.clone(), self.settings.alpha);
        let full = System::new(matrices, forces, rows, alpha, phase.name())?;
        self.scene.phase_system(full, phase.name())
    }

    /// Begins the phase in force, whose equations are `system`.
    fn begin(&mut self, system: &dyn PhaseSystem) {
        self.begin_events(system.full());
        let balance = energy(system, self.time, &self.state).balance();
        let (created, scale) = self.created(balance);
        if creation(created, scale).is_some() {
            self.balance = balance;
        }
        self.remember();
    }

    pub(super) fn begin_events(&mut self, system: &System) {
        let located = self.phase_run.plan.locates();
        self.phase_run.interval.events.begin(system, self.time, &self.state, located);
        self.follower.begin(&self.scene, &self.phase);
    }

    /// A run in the same state without equations; its trajectory begins with the last sample of this one.
    pub(super) fn twin(&self) -> Self {
        Self {
            scene: self.scene.clone(),
            settings: self.settings.clone(),
            matrices: self.matrices.clone(),
            gauges: self.gauges.clone(),
            sampling: self.sampling.clone(),
            sensors: self.sensors.clone(),
            angles: self.angles.clone(),
            scales: self.scales,
            atol_position: self.atol_position,
            clock: Instant::now(),
            spent: Duration::ZERO,
            phase: self.phase.clone(),
            number: self.number,
            is_commanded: self.is_commanded,
            constraints: self.constraints.clone(),
            phase_run: self.new_phase_run(self.phase_run.plan.clone()),
            integration: Integration::Absent,
            time: self.time,
            state: self.state.clone(),
            layout: self.layout,
            steps: self.steps,
            standing: 0,
            trajectory: self.trajectory.at_end(),
            follower: self.follower.anew(),
            rollback_point: self.rollback_point.clone(),
            balance: self.balance,
            least_energy: self.least_energy,
            pause: None,
            prescribed: None,
            resolution: Resolution::default(),
            looks: self.looks,
            reduced: self.reduced.as_ref().map(|checks| Mutex::new(locked(checks).clone())),
        }
    }

    /// Report of the motion so far, with the error estimate of a reduced model.
    pub(super) fn report(&self) -> Report {
        if let Some(checks) = &self.reduced {
            let equations = || self.full_equations(&self.phase, &self.state).ok();
            locked(checks).settle(self.number, equations, |state, x| self.changes_by(state, x));
        }
        self.settled_report()
    }

    /// How the phase in force was computed so far.
    pub(super) fn phase_report(&self) -> PhaseReport {
        self.phase_run.report(&self.phase, self.time, &self.integration)
    }

    /// The same, with the part of the error estimate of a reduced model that is known already: the rest takes factorizations with all unknowns.
    pub(super) fn settled_report(&self) -> Report {
        let mut report = self.trajectory.report.clone();
        let phase = self.phase_report();
        report.wall_seconds = self.clock.elapsed().as_secs_f64();
        report.states = phase.states;
        report.phases.push(phase);
        if let Some(checks) = &self.reduced {
            let checks = locked(checks);
            report.indicators = indicators::reduced(&checks.report);
            report.reduced = Some(checks.report.clone());
        }
        report
    }

    /// Changes of the readings of nodal positions under additional displacements (m) of a state.
    fn changes_by(&self, at: &ResidualSnapshot, displacements: &[f64]) -> Vec<SensorErrorEstimate> {
        if !self.sensors.read_places() {
            return Vec::new();
        }
        let [u, v, _] = &at.state;
        let moved: Vec<f64> = u.iter().zip(displacements).map(|(u, x)| u + x).collect();
        let Self { scene, phase, gauges, .. } = self;
        let view = |u| View {
            scene,
            phase,
            gauges,
            time: at.time,
            u,
            v,
            amounts: &[],
            accelerations: &[],
        };
        let sample = self.trajectory.last();
        self.sensors.changes([(&view(u), sample), (&view(&moved), sample)])
    }

    /// The motion, at the end of the run.
    pub(super) fn into_trajectory(mut self) -> Trajectory {
        self.trajectory.report = self.report();
        self.trajectory.angles = take(&mut self.angles.0);
        if let Some(checks) = &self.reduced {
            self.trajectory.lacking = locked(checks).take_lacking();
        }
        self.trajectory.report.indicators = indicators::of_motion(&self.trajectory);
        self.trajectory
    }

    /// The error of an integrator that has given up, with the state that the last step led to, unless the
    /// equations are undefined there.
    fn give_up(&mut self, source: Failed) -> Error {
        let Integration::Running(work) = take(&mut self.integration) else {
            return self.failure(source, 0.0);
        };
        let step = work.stepper.counts().last_step;
        let mut system = self.phase_run.rest(work);
        if self.time > self.trajectory.last().time {
            let accelerates = self.sensors.need_accelerations();
            let last =
                records::sample(self.number, &mut *system, self.time, &self.state, accelerates);
            if let Ok(mut last) = last {
                self.complete(&mut last);
                self.trajectory.push(last);
            }
        }
        self.integration = Integration::Idle(system);
        self.failure(source, step)
    }

    /// Adds to a sample the quantities that do not follow from the equations.
    pub(super) fn complete(&self, sample: &mut Sample) {
        let own = (&*self.scene, &*self.gauges);
        let sensors = (&self.sensors, &self.angles);
        records::complete(sample, sensors, own, &self.phase, self.is_commanded);
    }

    /// Updates the angles of sensors to the present state.
    pub(super) fn follow_angles(&mut self) {
        if !self.sensors.have_angles() {
            return;
        }
        let Self { scene, phase, gauges, time, state, layout, sensors, angles, .. } = self;
        let (time, State { u, v, internal, .. }) = (*time, layout.of(state));
        let (_, amounts) = layout.split(internal);
        let view = View { scene, phase, gauges, time, u, v, amounts, accelerations: &[] };
        sensors.follow(&view, angles);
    }

    /// Size (s) and order of the last step of the integrator at work.
    pub(super) fn last_step(&self) -> (f64, u32) {
        match &self.integration {
            Integration::Running(work) => {
                (work.stepper.counts().last_step, work.stepper.last_order())
            }
            _ => (0.0, 0),
        }
    }

    /// The notice of steps that are far too short for the phase.
    pub(super) fn notice(&self) -> Option<&str> {
        self.phase_run.crawl.told.as_deref()
    }

    /// The error of a run that was stopped.
    pub(super) fn interrupted(&mut self) -> Error {
        self.give_up(Interrupted.into())
    }

    pub(super) fn failure(&self, source: Failed, step: f64) -> Error {
        let mut trajectory = self.trajectory.clone();
        trajectory.report = self.report();
        trajectory.report.indicators = indicators::of_motion(&trajectory);
        Box::new(IntegrationFailure {
            phase: self.phase.name.clone(),
            method: self.settings.method,
            time: self.time,
            step,
            source: in_mechanics(source, indicators::doom(&trajectory.report.indicators)),
            trajectory,
        })
        .into()
    }
}

/// The strain energy (J) of a body, the softest of several, under strains of a thousandth; 0 if all are rigid.
fn least_energy(body: &Body) -> f64 {
    let energy = |Part { body, .. }: Part| 1e-6 * body.material().young * body.volume();
    let soft = body.parts().filter(|part| !part.body.is_rigid());
    soft.map(energy).reduce(f64::min).unwrap_or(0.0)
}
