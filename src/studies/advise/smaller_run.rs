//! Runs of a smaller model beside what it is a model of.

use super::found::Found;
use super::ladder::PATIENCE;
use super::runs::Outcome;
use super::search::{Cut, SHORT, Search, Solved, Stop};
use super::smaller_model::SmallerModel;
use crate::base::input::InputError;
use crate::scene::constraint::Axis;
use crate::scene::timeline::{Scene, Smaller};
use crate::studies::work_precision::quantity::{Quantity, Seen};
use crate::studies::work_precision::truth::reason;

/// A smaller model, what is read in it, and what of the motion that it is a model of that is compared with.
pub(super) struct Shrunk {
    pub(super) kind: Smaller,
    pub(super) scene: Scene,
    pub(super) quantity: Quantity,
    /// How many of its first nodes are looked at, for the whole motion.
    pub(super) nodes: usize,
    /// Which of these stand for the nodes compared with, where that is not each for its own.
    pub(super) points: Option<Vec<usize>>,
    pub(super) full: Seen,
}

impl Shrunk {
    /// Difference of the observed motion or quantity from that of the full model.
    fn change(&self, seen: &Seen) -> f64 {
        match self.points.as_ref().filter(|_| self.quantity.is_motion()) {
            Some(points) => self.full.error(&seen.of_points(points)).mean,
            None => self.full.error(seen).mean,
        }
    }
}

impl Search<'_> {
    /// Runs a smaller model of the fastest motion that is right, across the first axis that has one. `of` makes it, or says nothing
    /// where there is none; why there is none across any axis is told after `name`, as in "half of it, cut across".
    pub(super) fn run_across(
        &mut self,
        name: &str,
        found: &mut Found,
        of: impl Fn(&Self, &Scene, Axis, &Solved) -> Option<Result<Shrunk, InputError>>,
    ) -> Result<(), Stop> {
        let Some([best, exact]) = self.soft(found) else { return Ok(()) };
        let Ok(scene) = best.choice.scene(&self.scene) else { return Ok(()) };
        if !scene.body().is_single() {
            return Ok(());
        }
        let mut refused = Vec::new();
        for &axis in Axis::all(scene.body().dimension()) {
            match of(self, &scene, axis, &exact) {
                Some(Ok(model)) => return self.run_smaller([best, exact], &model, found),
                Some(Err(error)) => refused.push(format!("{name} {}: {error}", axis.word())),
                None => {}
            }
        }
        found.not_tried.extend(refused);
        Ok(())
    }

    /// Runs a smaller model as exactly as what it is a model of was run, to see what it changes, and then as fast.
    fn run_smaller(
        &mut self,
        [best, exact]: [Solved; 2],
        model: &Shrunk,
        found: &mut Found,
    ) -> Result<(), Stop> {
        let kind = model.kind;
        let Some(tight) = self.run_as(&exact, model, found)? else { return Ok(()) };
        let change = tight.seen.as_ref().map_or(f64::NAN, |seen| model.change(seen));
        let mut pair = (tight, exact);
        if change <= self.request.accuracy
            && let Some(loose) = self.run_as(&best, model, found)?
        {
            pair = (loose, best);
        }
        let (own, full) = pair;
        let runs = [(own.seconds, own.unknowns), (full.seconds, full.unknowns)];
        found.smaller.push(SmallerModel::new(kind, change, runs));
        Ok(())
    }

    /// Runs a smaller model with the settings of a run of what it is a model of, if it was not run before.
    fn run_as(
        &mut self,
        full: &Solved,
        model: &Shrunk,
        found: &mut Found,
    ) -> Result<Option<Outcome>, Stop> {
        let Shrunk { kind, scene, quantity, nodes, .. } = model;
        let name = self.kept.name(scene, quantity, &full.choice);
        if let Some(known) = self.kept.get(&name).cloned() {
            self.known += 1;
            return Ok(Some(known));
        }
        (self.cut, self.patience) = (None, (PATIENCE * full.seconds).max(SHORT));
        let settings = &full.choice.settings;
        let outcome = self.observed(scene, (quantity, *nodes), settings, &kind.to_string());
        self.patience = f64::INFINITY;
        match outcome {
            Ok(outcome) => {
                let outcome = Outcome { run: name, ..outcome };
                self.kept.keep(&outcome).map_err(Stop::Trouble)?;
                Ok(Some(outcome))
            }
            Err(_) if self.cut == Some(Cut::Interrupted) => Err(Stop::Interrupted),
            Err(error) => {
                found.not_tried.push(format!("{kind}, to its end: {}", reason(error)));
                Ok(None)
            }
        }
    }
}
