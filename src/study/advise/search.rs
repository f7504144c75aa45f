//! The ladder: one rung at a time.

use std::ops::ControlFlow;
use std::time::Instant;

use super::choice::Choice;
use super::{Adviser, Candidate};
use crate::error::Error;
use crate::scene::Scene;
use crate::settings::Settings;
use crate::study::quantity::Seen;
use crate::study::truth::{Probe, reason};
use crate::trajectory::Trajectory;

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
    pub(super) adviser: &'a Adviser<'a>,
    /// The scene as it was written, or the part of it that can be known.
    pub(super) scene: Scene,
    /// Nodes of its mesh, which all finer ones share.
    pub(super) nodes: usize,
    pub(super) observer: &'a mut dyn FnMut(&str) -> ControlFlow<()>,
    pub(super) began: Instant,
    pub(super) failures: Vec<Candidate>,
    pub(super) runs: usize,
}

/// A run this short (s) is timed again, so many times in all.
const SHORT: f64 = 0.1;
const REPETITIONS: usize = 3;
/// How run time grows with the unknowns: between the plane and space.
const GROWTH: f64 = 1.5;

impl Search<'_> {
    /// Seconds left.
    pub(super) fn left(&self) -> f64 {
        self.adviser.budget - self.began.elapsed().as_secs_f64()
    }

    /// Runs the scene by a choice. `None` if that gives no motion, which is noted.
    pub(super) fn run(&mut self, choice: &Choice) -> Result<Option<Solved>, Stop> {
        match self.attempt(choice) {
            Ok(solved) => Ok(Some(solved)),
            Err(Error::Integration(failure)) if failure.is_interruption() => {
                Err(if self.left() <= 0.0 { Stop::Budget } else { Stop::Interrupted })
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
        let probe = Probe::new(&scene, self.adviser.quantity.clone(), nodes);
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
        // a look at the clock costs nothing beside a step
        scene.simulate_with(settings, &probe.sampling(), |_| match self.left() > 0.0 {
            true => (self.observer)(what),
            false => ControlFlow::Break(()),
        })
    }

    /// Whether there is time for a run with as many unknowns, as the time of another tells.
    pub(super) fn affords(&self, unknowns: usize, known: &Solved) -> bool {
        let ratio = unknowns as f64 / known.unknowns as f64;
        known.seconds * ratio.powf(GROWTH) < 0.4 * self.left()
    }
}
