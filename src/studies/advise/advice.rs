//! The result of the adviser.

use super::choice::Choice;
use super::parts::Parts;
use super::reduced_candidate::ReducedCandidate;
use super::smaller_model::SmallerModel;
use crate::dynamics::equilibrium::MeshEstimate;
use crate::scene::timeline::{Smaller, Term};
use crate::studies::work_precision::look::Look;

/// Recommended model of a scene, and the findings that lead to it.
#[derive(Debug, Clone)]
pub struct Advice {
    /// Quantity that has to be accurate.
    pub quantity: String,
    /// The requested relative accuracy, and its scale: the change of the quantity,
    /// in `unit`.
    pub accuracy: f64,
    /// See `accuracy`.
    pub scale: f64,
    /// Unit of the scale.
    pub unit: String,
    /// The scene as it was written.
    pub written: Candidate,
    /// The cheapest candidate that is right, if there is one: the sum of its [`parts`](Candidate::parts) is no larger than the
    /// accuracy.
    pub enough: Option<Candidate>,
    /// Reference of all candidates, and the relative error that it may have itself (NaN: not known).
    pub truth: Option<Candidate>,
    /// See `truth`.
    pub resolution: f64,
    /// Whether the `resolution` is that of a rate which three meshes of one kind of cells tell.
    pub has_rate: bool,
    /// If no finer mesh is fine enough to compare with, so that the mesh is taken as it was written: by how
    /// much the finest mesh that was tried differs from it (relative).
    pub mesh: Option<f64>,
    /// Values of alpha (1/s), each with the change that ten times as much makes (relative).
    pub alphas: Vec<(f64, f64)>,
    /// Change by the other measure of strain.
    pub law: Option<f64>,
    /// Change by the other inertia.
    pub inertia: Option<f64>,
    /// Changes by omitted terms.
    pub terms: Vec<(Term, f64)>,
    /// Joint change by all simplifications that matter little, the measure of strain included, on the finest mesh.
    pub together: Option<f64>,
    /// All that were run, in their order.
    pub candidates: Vec<Candidate>,
    /// Time (s) until which the motion can be known, if small errors grow too large before its end.
    pub known_until: Option<f64>,
    /// Time (s) at which the motion ends that all other fields are about: the end of the scene, or some time
    /// before `known_until`.
    pub end: f64,
    /// The error of a number of an equilibrium because of the mesh as it was written, estimated by
    /// adjoint-weighted residuals; only where an equilibrium is enough. The errors of candidates come from
    /// comparing runs.
    pub mesh_estimate: Option<MeshEstimate>,
    /// Smaller models that were run, each of the fastest motion that is right, on its mesh.
    pub smaller: Vec<SmallerModel>,
    /// Error and speed-up of a reduced model of the recommended model.
    pub reduced: Option<ReducedCandidate>,
    /// Findings of a coarse run before all others.
    pub look: Option<Look>,
    /// Alternatives that were not tried, and why.
    pub not_tried: Vec<String>,
    /// Whether the budget was spent, or the observer has ended the search, before all was tried.
    pub is_cut_short: bool,
    /// Runs, and the time (s) that they took in all.
    pub runs: usize,
    /// See `runs`.
    pub seconds: f64,
    /// Runs that were known from an earlier search.
    pub known: usize,
}

impl Advice {
    /// The fastest half, section or rod (of [`smaller`](Self::smaller)) with which the sufficient model remains sufficient, if one saves time: its
    /// [error](Self::error_of) is within the accuracy.
    pub fn smaller_enough(&self) -> Option<&SmallerModel> {
        let is_right = |model: &&SmallerModel| {
            let saves_time = model.seconds < model.full_seconds;
            let error = self.error_of(model);
            model.set().is_some() && saves_time && error.is_some_and(|error| error <= self.accuracy)
        };
        let right = self.smaller.iter().filter(is_right);
        right.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
    }

    /// Bound of the error of a [smaller model](Self::smaller) (relative): its change and the error of the sufficient model; of a rod, whose
    /// change is the distance from the reference, that and the error that the reference may have.
    pub fn error_of(&self, model: &SmallerModel) -> Option<f64> {
        let enough = self.enough.as_ref()?.parts?.sum();
        let of_full = match model.kind {
            Smaller::Rod { .. } if self.resolution.is_nan() => 0.0,
            Smaller::Rod { .. } => self.resolution,
            _ => enough,
        };
        Some(of_full + model.change)
    }

    /// Overrides in the file of the scene, as `--set` takes them, for the recommended model, by a
    /// [smaller model](Self::smaller_enough) if there is one.
    pub fn set(&self) -> Vec<String> {
        let enough = self.enough.iter().flat_map(|enough| enough.set.iter().cloned());
        enough.chain(self.smaller_enough().and_then(SmallerModel::set)).collect()
    }
}

/// A choice, and how good it is.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// The choice.
    pub choice: Choice,
    /// Overrides for the candidate in the file of the scene, as `--set` takes them.
    pub set: Vec<String>,
    /// Its relative distance from the truth; none without a motion, or without anything to compare with.
    pub error: Option<f64>,
    /// The parts of this error, if the runs between it and the truth were made, too: their sum bounds it, what the truth may be
    /// off by included.
    pub parts: Option<Parts>,
    /// Wall-clock time (s) of one run.
    pub seconds: f64,
    /// Unknowns of the integrator.
    pub unknowns: usize,
    /// Reason for a missing motion.
    pub failure: Option<String>,
    /// Warnings of the run.
    pub warnings: Vec<String>,
}

impl Candidate {
    pub(super) fn new(choice: Choice) -> Self {
        Self {
            choice,
            set: Vec::new(),
            error: None,
            parts: None,
            seconds: 0.0,
            unknowns: 0,
            failure: None,
            warnings: Vec::new(),
        }
    }
}
