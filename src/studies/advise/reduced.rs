//! The last stage: the saving by a reduced model of the sufficient model.

use std::time::Instant;

use super::evidence::Evidence;
use super::reduced_candidate::ReducedCandidate;
use super::runs::Outcome;
use super::search::{Cut, SHARE, Search, Solved, Stop};
use crate::dynamics::error::Error;
use crate::studies::reduce::{Training, reduce};
use crate::studies::work_precision::truth::reason;

/// Part of the accuracy that a reduced model may take.
const OF_REDUCED: f64 = 0.5;
/// Most unknowns of it.
const MOST_UNKNOWNS: usize = 64;
/// Learning takes a full run and some ten by models, most of them faster.
const RUNS: f64 = 4.0;

impl Search<'_> {
    /// Learns a reduced model of the fastest motion that is right, from that motion itself.
    pub(super) fn reduce(&mut self, found: &mut Evidence) -> Result<(), Stop> {
        let best = found.best(self.request.accuracy).filter(|best| best.choice.is_of_soft_motion());
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
