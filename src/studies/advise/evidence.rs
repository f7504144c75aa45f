//! Findings of the search so far.
//!
//! The reference is the richest model on the finest mesh, and an answer has to be within the accuracy
//! including the error of the reference. That follows from the rate of three meshes of one kind (order 2 at
//! best, order 1 for cells divided in some places, and of two such meshes in a row twice the last step at
//! least, as the error of all other cells does not show; ten times the last step where it is no smaller than
//! the one before), and is the whole distance of the last two meshes where there are not three. Linear cells
//! alone are not trusted, because those that lock may agree with each other. Where the finest mesh is not
//! known to be fine enough, the mesh is used as written, and the answer reports it with the difference of finer
//! ones.

use super::choice::Choice;
use super::parts::Parts;
use super::reduced_candidate::ReducedCandidate;
use super::search::Solved;
use super::smaller_model::SmallerModel;
use crate::dynamics::equilibrium::MeshEstimate;
use crate::scene::timeline::Term;

/// Runs, by their purpose, and the conclusions from them.
#[derive(Debug, Default)]
pub(super) struct Evidence {
    /// The scene as it was written, by its own settings.
    pub(super) written: Option<Solved>,
    /// The same with hardly any error of the integration.
    pub(super) tight: Option<Solved>,
    /// Models with hardly any error of the integration that something is learned from, most of them on the mesh as it was written.
    pub(super) models: Vec<Solved>,
    /// The richest model on meshes from coarse to fine; the last one is the reference of all.
    pub(super) meshes: Vec<Solved>,
    /// Finer meshes that are not fine enough either: then the mesh is taken as it was written, and `meshes`
    /// has it alone.
    pub(super) finer: Vec<Solved>,
    /// Values of alpha (1/s), each with the change that ten times as much makes (relative).
    pub(super) alphas: Vec<(f64, f64)>,
    /// Changes by the other measure of strain, and by the other inertia.
    pub(super) law: Option<f64>,
    pub(super) inertia: Option<f64>,
    /// Omitted terms, and the change by each.
    pub(super) terms: Vec<(Term, f64)>,
    /// Joint change by all omitted terms on the finest mesh, with the recommended measure of strain.
    pub(super) together: Option<f64>,
    /// Runs of the recommended model, by several methods and tolerances.
    pub(super) sweep: Vec<Solved>,
    /// Estimated error of an equilibrium due to the mesh of the file.
    pub(super) mesh_estimate: Option<MeshEstimate>,
    /// Smaller models of the fastest motion that is right.
    pub(super) smaller: Vec<SmallerModel>,
    /// Error and speed-up of a reduced model of the recommended model.
    pub(super) reduced: Option<ReducedCandidate>,
    /// Time (s) until which two tight runs agree, if that is before the end.
    pub(super) known_until: Option<f64>,
    pub(super) not_tried: Vec<String>,
}

/// Ratio of the error of the finer of two meshes to their distance, if halving the cells leaves a quarter of
/// the error; no better order is believed, ...
const ORDER_2: f64 = 1.0 / 3.0;
/// ... half of it, which is assumed where there is no third mesh to tell; ...
const ORDER_1: f64 = 1.0;
/// ... what is assumed at least if cells were divided in some places only, twice: the error of all others does not show; ...
const LOCAL: f64 = 2.0;
/// ... and the most that is assumed, if halving leaves nearly all of the error, as under loads on single
/// nodes.
const LEAST_ORDER: f64 = 10.0;

impl Evidence {
    /// Reference of all runs: the one on the finest mesh.
    pub(super) fn truth(&self) -> Option<&Solved> {
        self.meshes.last()
    }

    /// The error that the finest mesh may have itself, estimated from the meshes before: from three of one kind of cells by the
    /// ratio of their last two distances, from two by their whole distance. NaN if there is only one mesh.
    pub(super) fn resolution(&self) -> f64 {
        let (Some(truth), [.., before, _]) = (self.truth(), &self.meshes[..]) else {
            return f64::NAN;
        };
        let apart = |a: &Solved, b: &Solved| a.seen.distance(&b.seen).mean / truth.seen.scale;
        let left = match &self.meshes[..] {
            [.., first, second, third] if self.has_rate() => {
                let rate = apart(second, third) / apart(first, second);
                let is_local = |coarse: &Solved, fine: &Solved| {
                    coarse.choice.halved_in.len() < fine.choice.halved_in.len()
                };
                let best = match [is_local(first, second), is_local(second, third)] {
                    [true, true] => LOCAL,
                    [_, is_local] => {
                        if is_local {
                            ORDER_1
                        } else {
                            ORDER_2
                        }
                    }
                };
                if rate < 1.0 {
                    (rate / (1.0 - rate)).clamp(best, LEAST_ORDER)
                } else {
                    LEAST_ORDER
                }
            }
            _ => ORDER_1,
        };
        left * apart(before, truth)
    }

    /// Whether the last three meshes are of one kind of cells, so that they tell a rate.
    pub(super) fn has_rate(&self) -> bool {
        match &self.meshes[..] {
            [.., first, _, third] => first.choice.richer == third.choice.richer,
            _ => false,
        }
    }

    /// Remainder of an `accuracy` after the error of the finest mesh. That error counts as 0 if no other mesh was compared.
    pub(super) fn left(&self, accuracy: f64) -> f64 {
        let resolution = self.resolution();
        accuracy - if resolution.is_nan() { 0.0 } else { resolution }
    }

    /// Whether a run is right: by the sum of its parts, which may have cancelled in it.
    pub(super) fn is_right(&self, solved: &Solved, accuracy: f64) -> bool {
        self.parts(solved).is_some_and(|parts| parts.sum() <= accuracy)
    }

    /// All runs, in the order in which they were made.
    pub(super) fn all(&self) -> impl Iterator<Item = &Solved> {
        let models = self.written.iter().chain(&self.tight).chain(&self.models);
        let meshes = self.meshes.iter().skip(1).chain(&self.finer);
        models.chain(meshes).chain(&self.sweep)
    }

    /// Takes the mesh as it was written, if even the finest is not fine enough for an `accuracy`.
    pub(super) fn settle(&mut self, accuracy: f64) {
        if self.left(accuracy) <= 0.0 {
            self.finer = self.meshes.split_off(1);
        }
    }

    /// Change of the result from the mesh of the file to the finest one, if the former is recommended.
    pub(super) fn mesh(&self) -> Option<f64> {
        Some(self.finer.last()?.error(self.truth()?))
    }

    /// The fastest of the accurate ones; rigid models, with the fewest unknowns, before others.
    pub(super) fn best(&self, accuracy: f64) -> Option<&Solved> {
        let right = self.all().filter(|solved| self.is_right(solved, accuracy));
        let is_soft = |solved: &Solved| !solved.choice.is_rigid;
        right.min_by(|a, b| is_soft(a).cmp(&is_soft(b)).then(a.seconds.total_cmp(&b.seconds)))
    }

    /// The run of the model of a `choice` with hardly any error of the integration, if it was made.
    pub(super) fn exact(&self, choice: &Choice) -> Option<&Solved> {
        let tight = &self.tight.as_ref()?.choice.settings;
        self.all().chain(self.meshes.first()).find(|solved| {
            solved.choice.is_model_of(choice) && solved.choice.settings.rtol <= tight.rtol
        })
    }

    /// The parts of the error of a run, if the runs between it and the truth were made, too: its own model
    /// with hardly any error of the integration, and the richest model on its own mesh. A mesh that was compared with no other is
    /// off by what residuals tell, if they do, and else taken as it is.
    pub(super) fn parts(&self, of: &Solved) -> Option<Parts> {
        let truth = self.truth()?;
        let own = self.exact(&of.choice)?;
        let mesh = self.meshes.iter().find(|mesh| mesh.choice.is_mesh_of(&of.choice))?;
        let apart = |a: &Solved, b: &Solved| a.seen.distance(&b.seen).mean / truth.seen.scale;
        let parts @ [time, model, mesh] = [apart(of, own), apart(own, mesh), apart(mesh, truth)];
        // where a run does not have the quantity, the parts are not known
        let is_known = parts.iter().all(|part| part.is_finite());
        let left = match self.resolution() {
            resolution if resolution.is_nan() => self.off_at_rest(),
            resolution => resolution,
        };
        is_known.then_some(Parts { time, model, mesh: mesh + left })
    }

    /// By how much the mesh as it was written is off at rest (relative), if it is compared with no other and residuals tell; else NaN.
    pub(super) fn off_at_rest(&self) -> f64 {
        let estimate = self.mesh_estimate.as_ref().filter(|estimate| estimate.is_reliable());
        match (estimate, self.truth(), &self.meshes[..]) {
            (Some(estimate), Some(truth), [_]) => estimate.correction.abs() / truth.seen.scale,
            _ => f64::NAN,
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::scene::settings::Settings;
    use crate::studies::advise::RicherCells;
    use crate::studies::samples::beam_jump;

    /// Meshes on which a number is off by `errors` of its scale.
    fn meshes(errors: &[(bool, f64)]) -> Evidence {
        let scene = beam_jump().unwrap();
        let meshes = errors.iter().zip(0..).map(|(&(quadratic, error), halved)| {
            let values = [[1.0 + error]];
            let seen = json!({ "dimension": 1, "values": values, "scale": 1.0 });
            let choice = Choice::written(&scene, &Settings::default());
            Solved {
                choice: Choice { richer: quadratic.then(RicherCells::default), halved, ..choice },
                seen: serde_json::from_value(seen).unwrap(),
                seconds: 1.0,
                unknowns: 1,
                warnings: Vec::new(),
                worst: Vec::new(),
            }
        });
        Evidence { meshes: meshes.collect(), ..Evidence::default() }
    }

    #[test]
    fn the_finest_mesh_is_as_good_as_the_order_of_the_others_says() {
        let known = |errors: &[(bool, f64)]| meshes(errors).resolution();
        let near = |told: f64, error: f64| assert!((told - error).abs() < 1e-12, "{told} {error}");
        // the whole distance of two meshes, and order 2 by three
        near(known(&[(true, 0.16), (true, 0.04)]), 0.12);
        near(known(&[(true, 0.64), (true, 0.16), (true, 0.04)]), 0.04);
        // order 1
        near(known(&[(true, 0.16), (true, 0.08), (true, 0.04)]), 0.04);
        // no limit: each step is as large as the one before
        near(known(&[(true, 0.3), (true, 0.2), (true, 0.1)]), LEAST_ORDER * 0.1);
        // order 4 counts as order 2
        near(known(&[(true, 0.0257), (true, 0.0017), (true, 0.0002)]), 0.0005);
        // cells of two kinds
        near(known(&[(false, 0.5), (false, 0.05), (true, 0.02)]), 0.03);
        near(known(&[(false, 0.05), (true, 0.02), (true, 0.005)]), 0.015);
        assert!(known(&[(false, 0.05)]).is_nan());
        // cells divided in some places leave as much as they take away, at the second time twice that
        let mut found = meshes(&[(true, 0.0257), (true, 0.0017), (true, 0.0002)]);
        found.meshes[2].choice.halved_in.push(vec![0]);
        near(found.resolution(), 0.0015);
        found.meshes[1].choice.halved_in.push(vec![0]);
        found.meshes[2].choice.halved_in.push(vec![0]);
        near(found.resolution(), 0.003);
    }

    #[test]
    fn errors_that_cancel_are_not_right() {
        let mut found = meshes(&[(true, 0.02), (true, 0.005), (true, 0.00125)]);
        // a model that is off by as much as the coarse mesh, the other way: it has the value of the finest mesh
        let [coarse, _, truth] = &found.meshes[..] else { unreachable!() };
        let choice = Choice { without: vec![Term::Gravity], ..coarse.choice.clone() };
        let lucky = Solved { choice, ..truth.clone() };
        found.tight = Some(coarse.clone());
        found.models.push(lucky.clone());
        assert_eq!(lucky.error(found.truth().unwrap()), 0.0);
        let parts = found.parts(&lucky).unwrap();
        // the finest mesh is off by a third of the last distance
        let expected = [0.01875, 0.01875 + 0.00375 / 3.0];
        for (part, expected) in [parts.model, parts.mesh].into_iter().zip(expected) {
            assert!((part - expected).abs() < 1e-12, "{parts:?}");
        }
        assert!(!found.is_right(&lucky, 0.038) && found.is_right(&lucky, 0.039));
    }

    #[test]
    fn a_mesh_that_residuals_show_to_be_off_is_not_enough() {
        let mut found = meshes(&[(true, 0.0)]);
        let written = found.meshes[0].clone();
        (found.written, found.tight) = (Some(written.clone()), Some(written.clone()));
        assert!(found.is_right(&written, 0.02) && found.best(0.02).is_some());
        let estimate = |remainder| MeshEstimate {
            quantity: "bend:end".into(),
            unit: "deg".into(),
            value: 1.0,
            change: 1.0,
            correction: -0.039,
            remainder,
            cells: Vec::new(),
            unknowns: 1,
            seconds: 0.0,
        };
        found.mesh_estimate = Some(estimate(0.01));
        assert!(found.best(0.02).is_none() && found.best(0.04).is_some());
        assert_eq!(found.parts(&written).unwrap().mesh, 0.039);
        // no estimate by which to judge
        found.mesh_estimate = Some(estimate(1.0));
        assert!(found.best(0.02).is_some());
        // finer meshes tell themselves
        let mut found = meshes(&[(true, 0.02), (true, 0.005), (true, 0.00125)]);
        found.mesh_estimate = Some(estimate(0.01));
        assert!(found.off_at_rest().is_nan());
    }

    #[test]
    fn a_mesh_that_no_other_confirms_is_taken_as_it_was_written() {
        let mut found = meshes(&[(false, 0.5), (false, 0.05), (true, 0.02)]);
        found.settle(0.04);
        assert!(found.mesh().is_none() && found.meshes.len() == 3);
        found.settle(0.02);
        // 0.48 away, of a scale that is 1
        assert!((found.mesh().unwrap() - 0.48).abs() < 1e-12 && found.meshes.len() == 1);
    }
}
