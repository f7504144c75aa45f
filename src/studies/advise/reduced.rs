//! The last rung: what a reduced model of what is enough would save, and from which run on learning it pays.

use std::fmt;
use std::time::Instant;

use super::found::Found;
use super::runs::Outcome;
use super::search::{Cut, SHARE, Search, Solved, Stop};
use crate::base::input::{percent, short};
use crate::dynamics::error::Error;
use crate::studies::reduce::{Training, pays_from, reduce};
use crate::studies::work_precision::time_text;
use crate::studies::work_precision::truth::reason;

/// A reduced model of what is enough, learned from its own run.
#[derive(Debug, Clone, PartialEq)]
pub struct ReducedCandidate {
    /// Its unknowns: displacements of shapes.
    pub unknowns: usize,
    /// The cells whose forces it computes, and all of them; the first is 0 where it needs none.
    pub cells: [usize; 2],
    /// What it changes, relative to the same scale as the accuracy.
    pub change: f64,
    /// Time (s) of a run by it, and of one of what is enough.
    pub seconds: f64,
    /// See `seconds`.
    pub full_seconds: f64,
    /// Time (s) that it took to learn it.
    pub training_seconds: f64,
}

impl ReducedCandidate {
    /// From which run on the time that learning has taken is won back; none if the model is not faster.
    pub fn pays_from(&self) -> Option<f64> {
        pays_from(self.training_seconds, self.full_seconds - self.seconds)
    }
}

impl fmt::Display for ReducedCandidate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { unknowns, cells: [own, all], change, seconds, full_seconds, .. } = self;
        write!(f, "a reduced model of it, of {unknowns} unknowns")?;
        if *own > 0 {
            write!(f, " and {own} of {all} cells")?;
        }
        write!(f, ", changes it by {}", percent(*change))?;
        let (ratio, time) = (short(full_seconds / seconds), time_text(*seconds));
        match self.pays_from() {
            Some(run) => write!(
                f,
                " at {ratio} times the speed ({time}): learning it took {}, which pays from run {run} on (pliant reduce)",
                time_text(self.training_seconds)
            ),
            None => write!(f, ", and is no faster ({time})"),
        }
    }
}

/// Part of the accuracy that a reduced model may take.
const OF_REDUCED: f64 = 0.5;
/// Most unknowns of it.
const MOST_UNKNOWNS: usize = 64;
/// Learning takes a full run and some ten by models, most of them faster.
const RUNS: f64 = 4.0;

impl Search<'_> {
    /// Learns a reduced model of the fastest motion that is right, from that motion itself.
    pub(super) fn reduce(&mut self, found: &mut Found) -> Result<(), Stop> {
        let best = found.best(self.request.accuracy).filter(|best| !best.choice.is_static);
        let Some(best) = best.cloned() else { return Ok(()) };
        if RUNS * best.seconds > SHARE * self.left() {
            found
                .not_tried
                .push("a reduced model: learning it takes longer than the budget".into());
            return Ok(());
        }
        match self.learned(&best) {
            Ok(reduced) => found.reduced = Some(reduced),
            Err(_) if self.cut == Some(Cut::Interrupted) => return Err(Stop::Interrupted),
            Err(error) => found.not_tried.push(format!("a reduced model: {}", reason(error))),
        }
        Ok(())
    }

    fn learned(&mut self, best: &Solved) -> Result<ReducedCandidate, Error> {
        self.cut = None;
        let (clock, share) = (Instant::now(), SHARE * self.left());
        let what = "a reduced model";
        let training = Training {
            scenes: vec![best.choice.scene(&self.scene)?],
            held_out: Vec::new(),
            settings: best.choice.settings.clone(),
            within: OF_REDUCED * self.request.accuracy,
            most_unknowns: MOST_UNKNOWNS,
        };
        let learned = reduce(&training, &mut |_| self.look_up(what, clock, share))?;
        let (unknowns, cells) = (learned.model.unknowns(), learned.model.cells());
        let scene = training.scenes[0].clone().reduced(learned.model)?;
        let Outcome { seen, seconds, .. } = self.measured(&scene, &training.settings, what)?;
        let change = seen.map_or(f64::NAN, |seen| best.seen.error(&seen).mean);
        Ok(ReducedCandidate {
            unknowns,
            cells: [cells, scene.body().mesh().cell_count()],
            change,
            seconds,
            full_seconds: best.seconds,
            training_seconds: learned.training_seconds,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn learning_pays_where_it_saves_time() {
        let fast = ReducedCandidate {
            unknowns: 12,
            cells: [54, 606],
            change: 0.0056,
            seconds: 0.2,
            full_seconds: 2.0,
            training_seconds: 25.0,
        };
        // 13.9 runs win the time of learning back
        assert_eq!(fast.pays_from(), Some(14.0));
        let told = fast.to_string();
        let parts =
            ["12 unknowns and 54 of 606 cells, changes it by 0.56 % at 10 times", "run 14 on"];
        assert!(parts.iter().all(|part| told.contains(part)), "{told}");
        let slow = ReducedCandidate { cells: [0, 606], seconds: 2.5, ..fast };
        assert_eq!(slow.pays_from(), None);
        let told = slow.to_string();
        assert!(!told.contains("cells") && told.contains("no faster"), "{told}");
    }
}
