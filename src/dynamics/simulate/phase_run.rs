//! A phase that is being run: its intervals, the method that integrates them, and its cost so far.

use std::time::Instant;

use super::auto::{LONG, Plan, TRIALS};
use super::crawl::Crawl;
use super::events::Events;
use super::interval::{Ending, Interval};
use super::sampling::Schedule;
use super::stalled::cost;
use crate::dynamics::phase::{Failed, Integrable, Stepper};
use crate::dynamics::report::{Counts, PhaseReport};
use crate::scene::settings::Method;
use crate::scene::timeline::Phase;

/// A phase that is being run.
pub(super) struct PhaseRun {
    clock: Instant,
    pub(super) plan: Plan,
    pub(super) interval: Interval,
    /// Ends of the intervals that are left (s), the last one first.
    pub(super) stops: Vec<f64>,
    /// End of the last interval, once it has ended.
    pub(super) ended: Option<Ending>,
    /// When (s) it has ended before its time.
    pub(super) cut: Option<f64>,
    /// Changes of the forces by commands.
    pub(super) commands: usize,
    /// Time (s) of the last one.
    pub(super) commanded: f64,
    /// First step of the next integrator (s), if it is known.
    pub(super) first_step: Option<f64>,
    pub(super) mean_steps: MeanSteps,
    pub(super) crawl: Crawl,
    /// Cost of the integrators that have ended.
    counts: Counts,
    /// Unknowns of the last one.
    states: usize,
}

/// The equations in force, and what integrates them.
#[derive(Default)]
pub(super) enum Integration {
    /// An integrator could not be made.
    #[default]
    Absent,
    /// No integrator, between two intervals.
    Idle(Box<dyn Integrable>),
    Running(Running),
}

/// An integrator at work on an interval.
pub(super) struct Running {
    pub(super) stepper: Box<dyn Stepper>,
    /// Its stop time (s).
    pub(super) stop: f64,
    /// Room for a state of the integrator.
    pub(super) sample: Vec<f64>,
    /// Steps, the time (s) when the present trial began, and mean step sizes (s) of the last trials, the last
    /// one first.
    pub(super) steps: usize,
    pub(super) trial_began: f64,
    pub(super) means: [f64; TRIALS],
}

/// Continuation of an integrator after a change of the forces.
pub(super) enum GoesOn {
    /// With the step that it had.
    Here,
    /// From a new start, after these statistics.
    Anew(Counts),
    /// Not at all: a new one is needed.
    Not,
}

/// The mean size of the steps of a plan, whatever intervals they lie in: of the last ones, and of those since the last review.
#[derive(Default)]
pub(super) struct MeanSteps {
    steps: usize,
    /// When the first one began (s).
    began: f64,
    reviewed: usize,
    /// The cost of the phase then.
    spent: f64,
    /// When the first one of these began (s).
    review_began: f64,
}

impl MeanSteps {
    /// Adds a step; after each [`LONG`] of them returns their mean size (s).
    pub(super) fn add(&mut self, [start, end]: [f64; 2]) -> Option<f64> {
        if self.steps == 0 {
            self.began = start;
        }
        if self.reviewed == 0 {
            self.review_began = start;
        }
        self.reviewed += 1;
        self.steps = (self.steps + 1) % LONG;
        (self.steps == 0).then(|| (end - self.began) / LONG as f64)
    }

    /// Steps up to `time` (s) since the last review, or since the plan was chosen, and their mean size (s).
    pub(super) fn since_review(&self, time: f64) -> (usize, f64) {
        (self.reviewed, (time - self.review_began) / self.reviewed.max(1) as f64)
    }
}

impl Running {
    pub(super) fn new(stepper: Box<dyn Stepper>, time: f64, stop: f64) -> Self {
        let sample = vec![0.0; stepper.state().len()];
        Self { stepper, stop, sample, steps: 0, trial_began: time, means: [f64::INFINITY; TRIALS] }
    }

    /// Goes on from `state` at time `t` (s) after a change of the forces.
    pub(super) fn go_on(&mut self, t: f64, state: &[f64]) -> Result<GoesOn, Failed> {
        let goes_on = match self.stepper.resume(t, state)? {
            true => GoesOn::Here,
            false => self.stepper.restart(t, state)?.map_or(GoesOn::Not, GoesOn::Anew),
        };
        self.stop = f64::NAN;
        Ok(goes_on)
    }

    /// Size of the next step (s), if it is known.
    pub(super) fn next_step(&self) -> Option<f64> {
        Some(self.stepper.next_step()).filter(|h| h.is_finite() && *h > 0.0)
    }
}

impl PhaseRun {
    /// A phase at its start, of at most `steps` steps.
    pub(super) fn new(plan: Plan, times: Schedule, stops: Vec<f64>, steps: usize) -> Self {
        let events = Events::default();
        Self {
            clock: Instant::now(),
            plan,
            interval: Interval { times, taken: 0, stop: 0.0, inside: None, steps, events },
            stops: stops.into_iter().rev().collect(),
            ended: Some(Ending::Reached),
            cut: None,
            commands: 0,
            commanded: f64::NAN,
            first_step: None,
            mean_steps: MeanSteps::default(),
            crawl: Crawl::default(),
            counts: Counts::default(),
            states: 0,
        }
    }

    /// Continues with another plan.
    pub(super) fn follow(&mut self, plan: Plan) {
        (self.plan, self.mean_steps) = (plan, MeanSteps::default());
        self.begin_review(None);
        self.counts.notice = None;
    }

    /// Counts the cost of an integrator that has started again.
    pub(super) fn restart(&mut self, counts: Counts) {
        self.counts.add(counts);
        self.mean_steps = MeanSteps::default();
        self.begin_review(None);
    }

    /// The cost of the phase so far, with the present integrator.
    fn spent(&self, stepper: Option<&dyn Stepper>) -> f64 {
        let method = self.plan.settings.method;
        let now = stepper.map_or(0.0, |stepper| cost(method, &stepper.counts()));
        cost(method, &self.counts) + now
    }

    /// Begins a review of the plan.
    pub(super) fn begin_review(&mut self, stepper: Option<&dyn Stepper>) {
        (self.mean_steps.reviewed, self.mean_steps.spent) = (0, self.spent(stepper));
    }

    /// The cost of a second of the motion since the last review, up to `time` (s).
    pub(super) fn cost(&self, time: f64, stepper: &dyn Stepper) -> f64 {
        let MeanSteps { spent, review_began, .. } = self.mean_steps;
        (self.spent(Some(stepper)) - spent) / (time - review_began)
    }

    /// Ends an integrator and returns its equations.
    pub(super) fn rest(&mut self, work: Running) -> Box<dyn Integrable> {
        self.counts.add(work.stepper.counts());
        self.states = work.stepper.unknowns();
        work.stepper.into_system()
    }

    /// Continues from where a report on the phase was made.
    pub(super) fn go_back(&mut self, report: &PhaseReport) {
        (self.counts, self.states) = (report.counts.clone(), report.states);
        self.interval.events.count = report.counts.contact_events;
        self.interval.events.slips.clone_from(&report.slips);
    }

    /// The report on `phase` up to time `end` (s), with the present integration `at`.
    pub(super) fn report(&self, phase: &Phase, end: f64, at: &Integration) -> PhaseReport {
        let (mut counts, mut states) = (self.counts.clone(), self.states);
        if let Integration::Running(work) = at {
            counts.add(work.stepper.counts());
            states = work.stepper.unknowns();
        }
        counts.contact_events = self.interval.events.count;
        let Plan { settings, reason, .. } = &self.plan;
        if reason.is_some() && settings.method == Method::Rk {
            // the automatic choice of methods already takes care of what it notices about stability
            counts.notice = None;
        }
        if let Some(told) = &self.crawl.told {
            counts.notice = Some(told.clone());
        }
        PhaseReport {
            name: phase.name.clone(),
            end,
            ended_by: phase
                .ends
                .as_ref()
                .filter(|_| self.cut.is_some())
                .map(|by| by.sensor.clone()),
            states,
            wall_seconds: self.clock.elapsed().as_secs_f64(),
            method: settings.method,
            reason: reason.clone(),
            counts,
            slips: self.interval.events.slips.clone(),
        }
    }
}
