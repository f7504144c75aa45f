//! A rung of the ladder: half of a symmetric scene.

use super::found::Found;
use super::ladder::PATIENCE;
use super::runs::Outcome;
use super::search::{Cut, SHORT, Search, Solved, Stop};
use super::smaller_model::{Smaller, SmallerModel};
use crate::base::input::InputError;
use crate::scene::constraint::Axis;
use crate::scene::timeline::{Half, Scene};
use crate::studies::work_precision::quantity::{Quantity, Seen};
use crate::studies::work_precision::truth::reason;

/// A half, what is read in it, and what of the whole motion that is compared with.
struct Halved {
    half: Half,
    quantity: Quantity,
    whole: Seen,
}

impl Search<'_> {
    /// Runs half of the fastest motion that is right, if it is symmetric. Where it is not although the scene is, the change tells.
    pub(super) fn half(&mut self, found: &mut Found) -> Result<(), Stop> {
        let Some([best, exact]) = self.soft(found) else { return Ok(()) };
        let Ok(scene) = best.choice.scene(&self.scene) else { return Ok(()) };
        let mesh = scene.body().mesh();
        if !scene.body().is_single() {
            return Ok(());
        }
        let mut refused = Vec::new();
        for &axis in Axis::all(mesh.dimension()) {
            // of a mesh without a plane of symmetry there is nothing to tell
            if mesh.mirror(axis.index()).is_none() {
                continue;
            }
            match self.halved(&scene, axis, &exact) {
                Ok(halved) => return self.run_half([best, exact], &halved, found),
                Err(error) => {
                    let axis = format!("{axis:?}").to_lowercase();
                    refused.push(format!("half of it, cut across {axis}: {error}"));
                }
            }
        }
        found.not_tried.extend(refused);
        Ok(())
    }

    /// The half on the side on which the quantity is.
    fn halved(&self, scene: &Scene, axis: Axis, exact: &Solved) -> Result<Halved, InputError> {
        let of_side = |is_upper| {
            let half = scene.half(axis, is_upper)?;
            let quantity = self.request.quantity.in_half(scene, &half)?;
            let whole = match quantity.is_motion() {
                true => exact.seen.of_points(&half.nodes[..self.nodes_of(&half)]),
                false => exact.seen.clone(),
            };
            Ok(Halved { half, quantity, whole })
        };
        of_side(false).or_else(|error| of_side(true).map_err(|_: InputError| error))
    }

    /// How many of the first nodes of a half are of the mesh as it was written.
    fn nodes_of(&self, half: &Half) -> usize {
        half.nodes.partition_point(|node| *node < self.nodes)
    }

    /// Runs the half as exactly as the whole was run, to see what it changes, and then as fast.
    fn run_half(
        &mut self,
        [best, exact]: [Solved; 2],
        halved: &Halved,
        found: &mut Found,
    ) -> Result<(), Stop> {
        let kind = Smaller::Half { axis: halved.half.axis, at: halved.half.at };
        let Some(tight) = self.run_as(&exact, halved, kind, found)? else { return Ok(()) };
        let change = tight.seen.as_ref().map_or(f64::NAN, |seen| halved.whole.error(seen).mean);
        let mut pair = (tight, exact);
        if change <= self.request.accuracy
            && let Some(loose) = self.run_as(&best, halved, kind, found)?
        {
            pair = (loose, best);
        }
        let (own, full) = pair;
        found.smaller.push(SmallerModel {
            kind,
            change,
            seconds: own.seconds,
            full_seconds: full.seconds,
            unknowns: own.unknowns,
            full_unknowns: full.unknowns,
        });
        Ok(())
    }

    /// Runs the half with the settings of a whole run, if it was not run before.
    fn run_as(
        &mut self,
        whole: &Solved,
        halved: &Halved,
        kind: Smaller,
        found: &mut Found,
    ) -> Result<Option<Outcome>, Stop> {
        let Halved { half, quantity, .. } = halved;
        let name = self.kept.name(&half.scene, quantity, &whole.choice);
        if let Some(known) = self.kept.get(&name).cloned() {
            self.known += 1;
            return Ok(Some(known));
        }
        (self.cut, self.patience) = (None, (PATIENCE * whole.seconds).max(SHORT));
        let (seen, settings) = ((quantity, self.nodes_of(half)), &whole.choice.settings);
        let outcome = self.observed(&half.scene, seen, settings, &kind.to_string());
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
