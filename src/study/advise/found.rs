//! What was found on the way.

use super::parts::Parts;
use super::search::{Request, Solved};
use crate::scene::Term;

/// Runs, by what they were made for, and what they tell.
#[derive(Debug, Default)]
pub(super) struct Found {
    /// The scene as it was written, by its own settings.
    pub(super) written: Option<Solved>,
    /// The same with hardly any error of the integration.
    pub(super) tight: Option<Solved>,
    /// Models on the mesh as it was written that something is learned from.
    pub(super) models: Vec<Solved>,
    /// The richest model on meshes from coarse to fine; the last one is what all is compared with.
    pub(super) meshes: Vec<Solved>,
    /// Values of alpha (1/s), each with what ten times as much changes (relative).
    pub(super) alphas: Vec<(f64, f64)>,
    /// What the other measure of strain changes, and the other inertia.
    pub(super) law: Option<f64>,
    pub(super) inertia: Option<f64>,
    /// What was left out, and what that changes.
    pub(super) terms: Vec<(Term, f64)>,
    /// What is enough, by several methods and tolerances, ...
    pub(super) sweep: Vec<Solved>,
    /// ... and with hardly any error of the integration.
    pub(super) enough: Option<Solved>,
    /// Time (s) until which two tight runs agree, if that is before the end.
    pub(super) known_until: Option<f64>,
    pub(super) not_tried: Vec<String>,
}

/// What halving the cells leaves of the error: linear cells have order 2, and less at corners.
const HALVING: f64 = 1.0 / 3.0;

impl Found {
    /// What all is compared with.
    pub(super) fn truth(&self) -> Option<&Solved> {
        self.meshes.last()
    }

    /// The error that the finest mesh may have itself, as the one before tells. Not a number where there is but one.
    pub(super) fn resolution(&self) -> f64 {
        match &self.meshes[..] {
            [.., before, truth] => HALVING * before.error(truth),
            _ => f64::NAN,
        }
    }

    /// The error that a candidate may have for an `accuracy`: that less what its measure may be off by. A mesh that was compared with
    /// none is taken as it is.
    pub(super) fn allowed(&self, accuracy: f64) -> f64 {
        let resolution = self.resolution();
        accuracy - if resolution.is_nan() { 0.0 } else { resolution }
    }

    /// All runs, in the order in which they were made.
    pub(super) fn all(&self) -> impl Iterator<Item = &Solved> {
        let models = self.written.iter().chain(&self.tight).chain(&self.models);
        models.chain(self.meshes.iter().skip(1)).chain(&self.enough).chain(&self.sweep)
    }

    /// The fastest of those that are right, and that leave as it was written what is not to be chosen.
    pub(super) fn best(&self, request: &Request) -> Option<&Solved> {
        let (truth, allowed) = (self.truth()?, self.allowed(request.accuracy));
        let written = &self.written.as_ref().or(self.tight.as_ref())?.choice;
        let is_right = |solved: &&Solved| {
            solved.error(truth) <= allowed
                && request.freedom.allows(&solved.choice, written, &request.settings)
        };
        self.all().filter(is_right).min_by(|a, b| a.seconds.total_cmp(&b.seconds))
    }

    /// What the error of a run is made of, if what stands between it and the truth was run, too: its own model with hardly any
    /// error of the integration, and the richest model on its own mesh.
    pub(super) fn parts(&self, of: &Solved) -> Option<Parts> {
        let truth = self.truth()?;
        let tight = &self.tight.as_ref()?.choice.settings;
        let own = self.all().chain(self.meshes.first()).find(|solved| {
            solved.choice.is_model_of(&of.choice) && solved.choice.settings.rtol <= tight.rtol
        })?;
        let mesh = self.meshes.iter().find(|mesh| mesh.choice.is_mesh_of(&of.choice))?;
        let apart = |a: &Solved, b: &Solved| a.seen.distance(&b.seen).mean / truth.seen.scale;
        Some(Parts { time: apart(of, own), model: apart(own, mesh), mesh: apart(mesh, truth) })
    }
}
