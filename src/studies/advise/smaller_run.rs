//! Runs of a smaller model beside what it is a model of.

use super::evidence::Evidence;
use super::ladder::PATIENCE;
use super::runs::Outcome;
use super::search::{Cut, SHORT, Search, Solved, Stop};
use super::smaller_model::SmallerModel;
use crate::base::input::InputError;
use crate::scene::constraint::Axis;
use crate::scene::timeline::{Scene, Shrink, Smaller, SmallerScene};
use crate::studies::work_precision::quantity::{Quantity, Seen};
use crate::studies::work_precision::truth::reason;

/// A smaller model, what is read in it, and what of the motion that it is a model of that is compared with.
struct Shrunk {
    kind: Smaller,
    scene: Scene,
    quantity: Quantity,
    /// Its nodes that stand for the nodes compared with.
    points: Vec<usize>,
    full: Seen,
}

impl Shrunk {
    /// Difference of the observed motion or quantity from that of the full model.
    fn change(&self, seen: &Seen) -> f64 {
        let axes: Vec<usize> = (0..self.scene.body().dimension()).collect();
        match self.quantity.is_motion() {
            true => self.full.error(&seen.chosen(&self.points, &axes)).mean,
            false => self.full.error(seen).mean,
        }
    }
}

impl Search<'_> {
    /// Runs a half or section of the fastest motion that is right, across the first axis that has one. Why there is none across any axis is
    /// told, of meshes that have one.
    pub(super) fn smaller(&mut self, shrink: Shrink, found: &mut Evidence) -> Result<(), Stop> {
        let Some([best, exact]) = self.soft(found) else { return Ok(()) };
        let Ok(scene) = best.choice.scene(&self.scene) else { return Ok(()) };
        let mut refused = Vec::new();
        for &axis in Axis::all(scene.body().dimension()) {
            if scene.map_across(shrink, axis, false).is_err() {
                continue;
            }
            match self.shrunk(&scene, (shrink, axis), &exact.seen) {
                Ok(model) => return self.run_smaller([best, exact], &model, found),
                Err(error) => {
                    let name = ["half of it, cut across", "in a plane across"];
                    let name = name[usize::from(shrink == Shrink::Section)];
                    refused.push(format!("{name} {}: {error}", axis.word()));
                }
            }
        }
        found.not_tried.extend(refused);
        Ok(())
    }

    fn shrunk(
        &self,
        scene: &Scene,
        across: (Shrink, Axis),
        full: &Seen,
    ) -> Result<Shrunk, InputError> {
        let quantity = &self.request.quantity;
        let read = |smaller: &SmallerScene| quantity.by_map(scene, &smaller.map);
        let (SmallerScene { kind, scene, map }, quantity) = scene.smaller(across, read)?;
        let numbers = map.numbers[..self.nodes].iter().enumerate();
        let pairs = numbers.filter_map(|(node, number)| Some((node, (*number)?)));
        let (nodes, points): (Vec<usize>, Vec<usize>) = pairs.unzip();
        let full = match quantity.is_motion() {
            true => full.chosen(&nodes, &map.axes()),
            false => full.clone(),
        };
        Ok(Shrunk { kind, scene, quantity, points, full })
    }

    /// Runs a smaller model as exactly as what it is a model of was run, to see what it changes, and then as fast.
    fn run_smaller(
        &mut self,
        [best, exact]: [Solved; 2],
        model: &Shrunk,
        found: &mut Evidence,
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
        found: &mut Evidence,
    ) -> Result<Option<Outcome>, Stop> {
        let Shrunk { kind, scene, quantity, points, .. } = model;
        let nodes = points.iter().max().map_or(0, |last| last + 1);
        let name = self.kept.name(scene, quantity, &full.choice);
        if let Some(known) = self.kept.get(&name).cloned() {
            self.known += 1;
            return Ok(Some(known));
        }
        (self.cut, self.patience) = (None, (PATIENCE * full.seconds).max(SHORT));
        let settings = &full.choice.settings;
        let outcome = self.observed(scene, (quantity, nodes), settings, &kind.to_string());
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
