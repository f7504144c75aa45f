//! Runs of a smaller model, compared with the full model.
//!
//! Half and section are compared with the accurate motion, on its mesh. The rod in place of a slender solid has no mesh of
//! its own to share with it, and is compared with the reference; more and more elements are tried, until it is accurate or changes no more.

use super::evidence::Evidence;
use super::ladder::PATIENCE;
use super::runs::Outcome;
use super::search::{Cut, SHORT, Search, Solved, Stop};
use super::smaller_model::SmallerModel;
use crate::base::input::InputError;
use crate::scene::constraint::Axis;
use crate::scene::timeline::{RodScene, Scene, Shrink, Smaller, SmallerScene};
use crate::studies::work_precision::quantity::{Quantity, Seen};
use crate::studies::work_precision::truth::reason;

/// Numbers of elements of a rod that are tried, one after the other, ...
const ELEMENTS: [usize; 4] = [5, 10, 20, 40];
/// ... as long as its change is below this fraction of that of the one before.
const CHANGING: f64 = 0.8;

/// A smaller model, the quantity that is read in it, and the part of the full motion that it is compared with.
struct Shrunk {
    kind: Smaller,
    scene: Scene,
    quantity: Quantity,
    /// Its nodes that represent each of the compared nodes, with their weights.
    shares: Vec<Vec<(usize, f64)>>,
    full: Seen,
}

impl Shrunk {
    /// Difference of the observed motion or quantity from that of the full model.
    fn change(&self, seen: &Seen) -> f64 {
        match self.quantity.is_motion() {
            true => self.full.error(&seen.combined(&self.shares)).mean,
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
                Ok(model) => {
                    let smaller = self.run_smaller([&best, &exact], &model, found)?;
                    found.smaller.extend(smaller);
                    return Ok(());
                }
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
        let shares = points.into_iter().map(|point| vec![(point, 1.0)]).collect();
        Ok(Shrunk { kind, scene, quantity, shares, full })
    }

    /// Runs the rod in place of a slender solid, with as few elements as are right.
    pub(super) fn rod(&mut self, found: &mut Evidence) -> Result<(), Stop> {
        let Some([best, exact]) = self.soft(found) else { return Ok(()) };
        let Some(truth) = found.truth().cloned() else { return Ok(()) };
        let (mut nearest, mut refused): (Option<SmallerModel>, _) = (None, None);
        for elements in ELEMENTS {
            let model = match self.rod_model(elements, &truth.seen) {
                Ok(model) => model,
                Err(error) => {
                    refused = Some(format!("a rod of {elements} elements: {error}"));
                    continue;
                }
            };
            let Some(rod) = self.run_smaller([&best, &exact], &model, found)? else { break };
            let before = nearest.as_ref().map_or(f64::INFINITY, |nearest| nearest.change);
            let is_right = rod.change <= found.left(self.request.accuracy);
            let goes_on = rod.change < CHANGING * before;
            if rod.change < before {
                nearest = Some(rod);
            }
            if is_right || !goes_on {
                break;
            }
        }
        if nearest.is_none() {
            found.not_tried.extend(refused);
        }
        found.smaller.extend(nearest);
        Ok(())
    }

    fn rod_model(&self, elements: usize, full: &Seen) -> Result<Shrunk, InputError> {
        let RodScene { scene, axis, kind } = self.scene.rod_scene(elements)?;
        let quantity = self.request.quantity.of_rod(&self.scene, &axis)?;
        let mesh = self.scene.body().mesh();
        let shares = (0..self.nodes).map(|node| axis.shares(mesh.position(node))).collect();
        Ok(Shrunk { kind, scene, quantity, shares, full: full.clone() })
    }

    /// Runs a smaller model with the accuracy of the run of the full model, to find its change, and then as fast: for a rod, which is
    /// compared with the reference, the change by the faster run is added.
    fn run_smaller(
        &mut self,
        [best, exact]: [&Solved; 2],
        model: &Shrunk,
        found: &mut Evidence,
    ) -> Result<Option<SmallerModel>, Stop> {
        let kind = model.kind;
        let Some(tight) = self.run_as(exact, model, found)? else { return Ok(None) };
        let mut change = tight.seen.as_ref().map_or(f64::NAN, |seen| model.change(seen));
        let (mut own, mut full) = (&tight, exact);
        let loose = match change <= self.request.accuracy {
            true => self.run_as(best, model, found)?,
            false => None,
        };
        if let Some(loose) = &loose {
            if let (Smaller::Rod { .. }, Some(tight), Some(loose)) =
                (kind, &tight.seen, &loose.seen)
            {
                change += tight.distance(loose).mean / model.full.scale;
            }
            (own, full) = (loose, best);
        }
        let runs = [(own.seconds, own.unknowns), (full.seconds, full.unknowns)];
        Ok(Some(SmallerModel::new(kind, change, runs)))
    }

    /// Runs a smaller model with the settings of a run of the full model, if it was not run before.
    fn run_as(
        &mut self,
        full: &Solved,
        model: &Shrunk,
        found: &mut Evidence,
    ) -> Result<Option<Outcome>, Stop> {
        let Shrunk { kind, scene, quantity, shares, .. } = model;
        let nodes = shares.iter().flatten().map(|(node, _)| node + 1).max().unwrap_or(0);
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
