//! The search: runs of candidates, within a budget.

use std::ops::ControlFlow;
use std::time::Instant;

use super::advice::Candidate;
use super::choice::Choice;
use super::runs::{Outcome, Runs};
use crate::dynamics::equilibrium::Equilibrium;
use crate::dynamics::error::Error;
use crate::dynamics::statics::Statics;
use crate::dynamics::trajectory::Trajectory;
use crate::elements::basis::{can_be_bisected, worst_cells};
use crate::scene::settings::{ContactEvents, Method, Settings};
use crate::scene::timeline::{Phase, Scene};
use crate::studies::work_precision::quantity::{Quantity, Seen};
use crate::studies::work_precision::truth::{Probe, reason};

/// Request to the adviser.
#[derive(Debug)]
pub(super) struct Request {
    pub(super) accuracy: f64,
    pub(super) settings: Settings,
    pub(super) quantity: Quantity,
    /// Time (s) for all runs.
    pub(super) budget: f64,
}

impl Request {
    /// The settings of the request, with another method and tolerance.
    pub(super) fn settings(
        &self,
        method: Method,
        rtol: f64,
        contact_events: ContactEvents,
    ) -> Settings {
        let (atol_position, atol_velocity) = (None, None);
        let own = self.settings.clone();
        Settings { method, rtol, contact_events, atol_position, atol_velocity, ..own }
    }
}

/// A run that has come to its end.
#[derive(Debug, Clone)]
pub(super) struct Solved {
    pub(super) choice: Choice,
    pub(super) seen: Seen,
    pub(super) seconds: f64,
    pub(super) unknowns: usize,
    /// Warnings of the run.
    pub(super) warnings: Vec<String>,
    /// Cells to divide next.
    pub(super) worst: Vec<usize>,
}

impl Solved {
    /// Its relative error, if `truth` is right.
    pub(super) fn error(&self, truth: &Self) -> f64 {
        truth.seen.error(&self.seen).mean
    }
}

/// Reason for an early end of the search: the budget is spent, the observer ends it, or runs cannot be stored.
#[derive(Debug)]
pub(super) enum Stop {
    Budget,
    Interrupted,
    Trouble(Error),
}

/// Runs candidates within the budget.
pub(super) struct Search<'a> {
    pub(super) request: &'a Request,
    /// The scene as it was written, or the part of it that can be known.
    pub(super) scene: Scene,
    /// Nodes of its mesh, which all finer ones share.
    pub(super) nodes: usize,
    pub(super) observer: &'a mut dyn FnMut(&str) -> ControlFlow<()>,
    pub(super) began: Instant,
    pub(super) kept: Runs,
    pub(super) failures: Vec<Candidate>,
    /// Runs that were made, and that were known already.
    pub(super) runs: usize,
    pub(super) known: usize,
    /// The longest time (s) that a run may take.
    pub(super) patience: f64,
    /// Reason for which the last run was cut short, if it was.
    pub(super) cut: Option<Cut>,
}

/// Reason for cutting a run short.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cut {
    /// A request of the observer.
    Interrupted,
    /// Its share of the time that is left is spent.
    Share,
    /// It takes longer than the search has patience for.
    Late,
}

/// A run this short (s) is timed again, this many times in all.
pub(super) const SHORT: f64 = 0.1;
const REPETITIONS: usize = 3;
/// Strains are compared from cell to cell at this many times, and the cells with this part of all jumps are divided next: more
/// than half, so that two meshes differ by more than is left.
const LOOKS: usize = 10;
const WORST: f64 = 0.8;
/// A run may take this part of the time that is left: others follow.
pub(super) const SHARE: f64 = 0.4;
/// If less than this part of the budget is left, it counts as spent.
const LEAST: f64 = 0.02;
/// Exponent by which run time grows with the unknowns, between those of the plane and of space, until it is measured; and the
/// largest that is believed.
const GROWTH: f64 = 1.5;
const MOST_GROWTH: f64 = 2.5;

impl<'a> Search<'a> {
    /// A search for `scene`, whose budget begins now.
    pub(super) fn new(
        request: &'a Request,
        scene: &Scene,
        kept: Runs,
        observer: &'a mut dyn FnMut(&str) -> ControlFlow<()>,
    ) -> Self {
        Self {
            request,
            scene: scene.clone(),
            nodes: match scene.body().is_single() {
                true => scene.body().to_builder().own_mesh().node_count(),
                false => scene.body().mesh().node_count(),
            },
            observer,
            began: Instant::now(),
            kept,
            failures: Vec::new(),
            runs: 0,
            known: 0,
            patience: f64::INFINITY,
            cut: None,
        }
    }

    /// Seconds left.
    pub(super) fn left(&self) -> f64 {
        self.request.budget - self.began.elapsed().as_secs_f64()
    }

    /// Whether too little is left to begin anything.
    fn is_spent(&self) -> bool {
        self.left() < LEAST * self.request.budget
    }

    /// Runs the scene by a choice, if it was not run before. `None` if that gives no motion, which is noted,
    /// or if it takes longer than there is patience for.
    pub(super) fn run(&mut self, choice: &Choice) -> Result<Option<Solved>, Stop> {
        self.cut = None;
        let name = self.kept.name(&self.scene, &self.request.quantity, choice);
        let outcome = match self.kept.get(&name) {
            Some(known) => {
                self.known += 1;
                known.clone()
            }
            None => {
                let solved = self.solve(choice);
                let outcome =
                    solved.unwrap_or_else(|error| Outcome::failed(reason(error).to_string()));
                let outcome = Outcome { run: name, ..outcome };
                match self.cut.filter(|_| outcome.failure.is_some()) {
                    None => self.kept.keep(&outcome).map_err(Stop::Trouble)?,
                    Some(Cut::Interrupted) => return Err(Stop::Interrupted),
                    Some(Cut::Share) if self.is_spent() => return Err(Stop::Budget),
                    Some(Cut::Late) => return Ok(None),
                    Some(Cut::Share) => {}
                }
                outcome
            }
        };
        let choice = choice.clone();
        let Outcome { seen, seconds, unknowns, failure, warnings, worst, .. } = outcome;
        match seen {
            Some(seen) => Ok(Some(Solved { choice, seen, seconds, unknowns, warnings, worst })),
            None => {
                self.failures.push(Candidate { failure, ..Candidate::new(choice) });
                Ok(None)
            }
        }
    }

    /// Outcome of a run.
    fn solve(&mut self, choice: &Choice) -> Result<Outcome, Error> {
        let scene = choice.scene(&self.scene)?;
        let what = format!("{choice}: {} nodes", scene.body().mesh().node_count());
        if choice.is_static {
            self.runs += 1;
            if (self.observer)(&what).is_break() {
                self.cut = Some(Cut::Interrupted);
            }
            let clock = Instant::now();
            let seen = self.request.quantity.seen_at_rest(&self.at_rest(&scene)?)?;
            let seconds = clock.elapsed().as_secs_f64();
            return Ok(Outcome::new(Some(seen), seconds, scene.body().dofs()));
        }
        self.measured(&scene, &choice.settings, &what)
    }

    /// Observation of a motion, and its run time.
    pub(super) fn measured(
        &mut self,
        scene: &Scene,
        settings: &Settings,
        what: &str,
    ) -> Result<Outcome, Error> {
        let (request, nodes) = (self.request, self.nodes);
        self.observed(scene, (&request.quantity, nodes), settings, what)
    }

    /// Observation of a `quantity` of a motion, of so many of the first nodes, and its run time: the least of several
    /// runs, if it is short.
    pub(super) fn observed(
        &mut self,
        scene: &Scene,
        (quantity, nodes): (&Quantity, usize),
        settings: &Settings,
        what: &str,
    ) -> Result<Outcome, Error> {
        let probe = Probe::new(scene, quantity.clone(), (0..nodes).collect());
        let first = self.once(scene, &probe, settings, what)?;
        let mut seconds = first.report().wall_seconds;
        for _ in 1..REPETITIONS {
            if seconds > SHORT {
                break;
            }
            let again = self.once(scene, &probe, settings, what)?;
            seconds = seconds.min(again.report().wall_seconds);
        }
        let (seen, warnings) = (probe.seen(&first), first.report().warnings());
        let kind = scene.body().mesh().kind();
        let worst = if can_be_bisected(kind) { worst_in(&first) } else { Vec::new() };
        Ok(Outcome { warnings, worst, ..Outcome::new(Some(seen), seconds, first.report().states) })
    }

    /// The equilibrium in which a scene comes to rest, if it ever does.
    pub(super) fn at_rest(&self, scene: &Scene) -> Result<Equilibrium, Error> {
        let last = scene.phases().last().map_or("", Phase::name);
        scene.equilibrium_of(last, &Statics::default())
    }

    fn once(
        &mut self,
        scene: &Scene,
        probe: &Probe,
        settings: &Settings,
        what: &str,
    ) -> Result<Trajectory, Error> {
        self.runs += 1;
        let (clock, share) = (Instant::now(), SHARE * self.left());
        // a look at the clock costs nothing compared with a step
        scene.simulate_with(settings, &probe.sampling(), |_| self.look_up(what, clock, share))
    }

    /// Looks up from `what` is run since `clock`, and ends it where it takes more than its `share` (s) or than there is patience
    /// for.
    pub(super) fn look_up(&mut self, what: &str, clock: Instant, share: f64) -> ControlFlow<()> {
        let seconds = clock.elapsed().as_secs_f64();
        self.cut = match (self.observer)(what) {
            ControlFlow::Break(()) => Some(Cut::Interrupted),
            ControlFlow::Continue(()) if seconds > self.patience => Some(Cut::Late),
            ControlFlow::Continue(()) if seconds > share => Some(Cut::Share),
            ControlFlow::Continue(()) => None,
        };
        self.cut.map_or(ControlFlow::Continue(()), |_| ControlFlow::Break(()))
    }

    /// Whether there is time for a run with as many unknowns, judged by the times of others from coarse to fine: the last of them,
    /// and how time has grown up to it.
    pub(super) fn affords(&self, unknowns: usize, known: &[Solved]) -> bool {
        let Some(last) = known.last() else { return true };
        let rise = |from: f64, to: f64| (to / from).ln();
        let grown = match known {
            [.., before, _] if before.seconds > SHORT && before.unknowns < last.unknowns => {
                let of_time = rise(before.seconds, last.seconds);
                of_time / rise(before.unknowns as f64, last.unknowns as f64)
            }
            _ => GROWTH,
        };
        let growth = grown.clamp(1.0, MOST_GROWTH);
        let ratio = unknowns as f64 / last.unknowns as f64;
        last.seconds * ratio.powf(growth) < SHARE * self.left()
    }
}

/// The cells in which most jumps of strain are in a motion.
fn worst_in(trajectory: &Trajectory) -> Vec<usize> {
    let body = trajectory.body();
    let samples = trajectory.samples();
    let mut jumps = vec![0.0; body.mesh().cell_count()];
    for sample in samples.iter().step_by(samples.len().div_ceil(LOOKS)) {
        let own = body.strain_jumps_by_cell(&sample.u);
        jumps.iter_mut().zip(own).for_each(|(sum, jump)| *sum += jump);
    }
    worst_cells(&jumps, WORST)
}
