//! A rung of the ladder: what changes if nothing strains.

use super::choice::Choice;
use super::evidence::Evidence;
use super::ladder::PATIENCE;
use super::search::{Cut, SHORT, Search, Solved, Stop};
use super::smaller_model::SmallerModel;
use crate::base::input::percent;
use crate::base::sparse::NodePattern;
use crate::elements::body::Strain;
use crate::scene::timeline::Smaller;
use crate::studies::work_precision::rigid_motion::distance_from_rigid;

impl Search<'_> {
    /// Runs the fastest motion that is right with all bodies rigid, unless its strains show that no rigid motion is near enough.
    pub(super) fn rigid(&mut self, found: &mut Evidence) -> Result<(), Stop> {
        let accuracy = self.request.accuracy;
        let Some([best, exact]) = self.soft(found) else { return Ok(()) };
        if self.scene.body().substances().all(|made_of| made_of.is_rigid) {
            return Ok(());
        }
        let least = self.least_rigid_change(&exact);
        if least > accuracy {
            let away = percent(least);
            found
                .not_tried
                .push(format!("all of it rigid: the nearest rigid motion is {away} away"));
            return Ok(());
        }
        let rigid =
            |of: &Solved| Choice { strain: Strain::Green, is_rigid: true, ..of.choice.clone() };
        let scene = rigid(&best).scene(&self.scene);
        if let Err(error) = scene.and_then(|scene| scene.validate()) {
            found.not_tried.push(format!("all of it rigid: {error}"));
            return Ok(());
        }
        let Some(tight) = self.run_within(&rigid(&exact), exact.seconds, found)? else {
            return Ok(());
        };
        let change = tight.error(&exact);
        found.models.push(tight.clone());
        let mut pair = [tight, exact];
        if change <= accuracy
            && let Some(loose) = self.run_within(&rigid(&best), best.seconds, found)?
        {
            found.sweep.push(loose.clone());
            pair = [loose, best];
        }
        let runs = pair.map(|run| (run.seconds, run.unknowns));
        found.smaller.push(SmallerModel::new(Smaller::Rigid, change, runs));
        Ok(())
    }

    /// The fastest motion that is right, and the same with hardly any error of the integration, where it has no smaller model yet.
    pub(super) fn soft(&self, found: &Evidence) -> Option<[Solved; 2]> {
        let best = found.best(self.request.accuracy)?;
        let exact = found.exact(&best.choice)?;
        best.choice.is_of_soft_motion().then(|| [best.clone(), exact.clone()])
    }

    /// Runs a rigid choice, which is cut short where it takes much longer than the `seconds` of what strains.
    fn run_within(
        &mut self,
        choice: &Choice,
        seconds: f64,
        found: &mut Evidence,
    ) -> Result<Option<Solved>, Stop> {
        self.patience = (PATIENCE * seconds).max(SHORT);
        let solved = self.run(choice);
        self.patience = f64::INFINITY;
        let solved = solved?;
        if solved.is_none() && self.cut == Some(Cut::Late) {
            let late = "it takes more than twice as long as the deformable model";
            found.not_tried.push(format!("{choice}, to its end: {late}"));
        }
        Ok(solved)
    }

    /// Lower bound of the change by rigid bodies: distance of the whole motion from the nearest one in which each piece moves as a rigid
    /// one. Of other quantities nothing is known before a run.
    fn least_rigid_change(&self, best: &Solved) -> f64 {
        if !self.request.quantity.is_motion() {
            return 0.0;
        }
        let mesh = self.scene.body().mesh();
        let pieces = NodePattern::new(mesh.node_count(), mesh.cells()).pieces();
        distance_from_rigid(&best.seen, mesh.positions(), &pieces[..self.nodes])
    }
}
