//! The ladder: one rung at a time.

use std::ops::ControlFlow;
use std::time::Instant;

use super::advice::Candidate;
use super::choice::Choice;
use crate::error::Error;
use crate::scene::Scene;
use crate::settings::Settings;
use crate::study::quantity::{Quantity, Seen};
use crate::study::truth::{Probe, reason};
use crate::trajectory::Trajectory;

/// What is asked.
#[derive(Debug)]
pub(super) struct Request {
    pub(super) accuracy: f64,
    pub(super) settings: Settings,
    pub(super) quantity: Quantity,
    /// Time (s) for all runs.
    pub(super) budget: f64,
}

/// A run that has come to its end.
#[derive(Debug, Clone)]
pub(super) struct Solved {
    pub(super) choice: Choice,
    pub(super) seen: Seen,
    pub(super) seconds: f64,
    pub(super) unknowns: usize,
}

/// Why the search ends before its time: the budget is spent, or the observer says so.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stop {
    Budget,
    Interrupted,
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
    pub(super) failures: Vec<Candidate>,
    pub(super) runs: usize,
    /// Whether the observer has ended it.
    pub(super) is_interrupted: bool,
}

/// A run this short (s) is timed again, so many times in all.
const SHORT: f64 = 0.1;
const REPETITIONS: usize = 3;
/// A run may take this part of the time that is left: there are others.
const SHARE: f64 = 0.4;
/// Below this part of the budget it is spent.
const LEAST: f64 = 0.02;
/// How run time grows with the unknowns: between the plane and space.
const GROWTH: f64 = 1.5;

impl Search<'_> {
    /// Seconds left.
    pub(super) fn left(&self) -> f64 {
        self.request.budget - self.began.elapsed().as_secs_f64()
    }

    /// Whether too little is left to begin anything.
    fn is_spent(&self) -> bool {
        self.left() < LEAST * self.request.budget
    }

    /// Runs the scene by a choice. `None` if that gives no motion, which is noted.
    pub(super) fn run(&mut self, choice: &Choice) -> Result<Option<Solved>, Stop> {
        match self.attempt(choice) {
            Ok(solved) => Ok(Some(solved)),
            Err(Error::Integration(failure))
                if failure.is_interruption() && self.is_interrupted =>
            {
                Err(Stop::Interrupted)
            }
            Err(Error::Integration(failure)) if failure.is_interruption() && self.is_spent() => {
                Err(Stop::Budget)
            }
            Err(error) => {
                let failure = Some(reason(error).to_string());
                let candidate = Candidate { failure, ..Candidate::new(choice.clone()) };
                self.failures.push(candidate);
                Ok(None)
            }
        }
    }

    fn attempt(&mut self, choice: &Choice) -> Result<Solved, Error> {
        let scene = choice.scene(&self.scene)?;
        let what = format!("{choice}: {} nodes", scene.body().mesh().node_count());
        let nodes = (0..self.nodes).collect();
        let probe = Probe::new(&scene, self.request.quantity.clone(), nodes);
        let first = self.once(&scene, &probe, &choice.settings, &what)?;
        let (seen, unknowns) = (probe.seen(&first), first.report().states);
        let mut seconds = first.report().wall_seconds;
        for _ in 1..REPETITIONS {
            if seconds > SHORT {
                break;
            }
            let again = self.once(&scene, &probe, &choice.settings, &what)?;
            seconds = seconds.min(again.report().wall_seconds);
        }
        Ok(Solved { choice: choice.clone(), seen, seconds, unknowns })
    }

    fn once(
        &mut self,
        scene: &Scene,
        probe: &Probe,
        settings: &Settings,
        what: &str,
    ) -> Result<Trajectory, Error> {
        self.runs += 1;
        let least = (1.0 - SHARE) * self.left();
        // a look at the clock costs nothing beside a step
        scene.simulate_with(settings, &probe.sampling(), |_| {
            if self.left() < least {
                return ControlFlow::Break(());
            }
            let goes_on = (self.observer)(what);
            self.is_interrupted = goes_on.is_break();
            goes_on
        })
    }

    /// Whether there is time for a run with as many unknowns, as the time of another tells.
    pub(super) fn affords(&self, unknowns: usize, known: &Solved) -> bool {
        let ratio = unknowns as f64 / known.unknowns as f64;
        known.seconds * ratio.powf(GROWTH) < SHARE * self.left()
    }
}
