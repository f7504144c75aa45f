//! The stages of the search, one after the other: tolerance, alpha, law, mesh, omitted terms, method.
//!
//! Each stage is one question, answered by runs with a negligible error of the integration: tolerance; alpha,
//! increased by ten until that changes nothing; measure of strain; inertia, where it was written lumped;
//! meshes (halved; quadratic; quadratic and halved), until three of one kind show that they are fine enough
//! or the budget is spent; omitted terms; inertia. Where halving all cells would take too long, triangles and
//! tetrahedra are divided where most (0.8) of the jumps of their strains are, by Zienkiewicz and Zhu's
//! estimate over the motion. Terms that seem negligible on the mesh as written are omitted together on
//! the finest one and count as negligible only if they are so there, too, as a coarse mesh may hide them. The model
//! that is enough is swept by methods and tolerances, the fastest of those by the treatment of contact
//! events; a run that takes twice as long as the fastest right one is cut short. For a number at the end of
//! the motion the equilibrium is a candidate, too.

use std::iter;

use super::choice::{Choice, RicherCells};
use super::evidence::Evidence;
use super::search::{Cut, Search, Solved, Stop};
use crate::dynamics::equilibrium::MeshEstimate;
use crate::elements::body::{Inertia, Strain};
use crate::scene::settings::{ContactEvents, Method, Settings};
use crate::scene::timeline::Shrink;
use crate::studies::work_precision::tightening;

/// Fractions of the accuracy allotted to errors of each kind: of the integration in the runs by which models
/// are compared, and of alpha.
const OF_TIGHT: f64 = 0.05;
const OF_ALPHA: f64 = 0.05;
/// The same, of the remainder after the error of the finest mesh: of the law, of each omitted term, and of the mesh. Their sum
/// leaves a margin for the integration.
const OF_LAW: f64 = 0.2;
const OF_TERM: f64 = 0.05;
const OF_MESH: f64 = 0.4;
/// The finest mesh is fine enough if it may be off by this part of the accuracy itself.
const OF_TRUTH: f64 = 0.3;
/// Runs that locate contact events may take this many times as long as the scene as it was written, plus this
/// time (s); if they take longer, contact events are treated automatically.
const LOCATING: f64 = 10.0;
const LOCATING_SHORT: f64 = 0.5;
/// Cells are halved fewer times than this, and as often at most in some places.
const FINEST: usize = 6;
const MOST_LOCAL: usize = 8;
/// Factor between successive values of alpha, and the largest (1/s) that is tried.
const FIRMER: f64 = 10.0;
const FIRMEST: f64 = 1e6;
/// Advice on the meshes of several bodies.
const OF_SEVERAL: &str = "finer meshes, as there are several bodies: halve the cells of each (`halved` of its mesh, `Scene::halved`) and see \
     what that changes";
/// Tolerances that are swept.
const TOLERANCES: [f64; 10] = [1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 1e-6, 1e-7, 1e-8];
/// A sweep ends where runs take this many times as long as the fastest that is right.
pub(super) const PATIENCE: f64 = 2.0;

impl Search<'_> {
    /// Runs all stages, until everything is known or there is no more time.
    pub(super) fn climb(&mut self, found: &mut Evidence) -> Result<(), Stop> {
        let written = Choice::written(&self.scene, &self.request.settings);
        found.written = self.run(&written)?;
        let Some(tight) = self.tight(&written, found)? else { return Ok(()) };
        found.tight = Some(tight.clone());
        let firm = self.alpha(tight, found)?;
        let rich = self.law(firm, found)?;
        let rich = self.consistent(rich, found)?;
        found.meshes.push(rich.clone());
        let refined = self.refine(&rich, found);
        found.settle(self.request.accuracy);
        refined?;
        self.leave_out(&rich, found)?;
        let Some(enough) = self.enough(&rich, found) else { return Ok(()) };
        let enough = self.confirmed(enough, found)?;
        self.known_or_run(&enough, found)?;
        if self.request.quantity.is_at_end() {
            self.rest(&enough, found)?;
            if found.off_at_rest() > self.request.accuracy {
                return Ok(()); // nothing is enough on this mesh
            }
        }
        self.sweep(&enough, found)?;
        self.rigid(found)?;
        self.smaller(Shrink::Half, found)?;
        self.smaller(Shrink::Section, found)?;
        self.rod(found)?;
        self.reduce(found)
    }

    /// The model as it was written with hardly any error of the integration. `None` if it has no such motion.
    fn tight(&mut self, written: &Choice, found: &mut Evidence) -> Result<Option<Solved>, Stop> {
        let accuracy = self.request.accuracy;
        let mut rtol = tightening::first(accuracy);
        let mut before: Option<Solved> = None;
        let mut contact_events = ContactEvents::Locate;
        let usual = found.written.as_ref().map_or(f64::INFINITY, |written| written.seconds);
        loop {
            let settings = self.request.settings(Method::Auto, rtol, contact_events);
            // events that follow each other closely may take longer than all the rest
            if contact_events == ContactEvents::Locate && before.is_none() {
                self.patience = LOCATING * usual + LOCATING_SHORT;
            }
            let solved = self.run(&Choice { settings, ..written.clone() });
            self.patience = f64::INFINITY;
            let Some(solved) = solved? else {
                if self.cut == Some(Cut::Late) {
                    contact_events = ContactEvents::Auto;
                    continue;
                }
                return Ok(before);
            };
            if let Some(before) = &before {
                let apart = before.error(&solved);
                let is_last = tightening::is_tightest(rtol);
                if apart <= OF_TIGHT * accuracy || (is_last && apart <= accuracy) {
                    return Ok(Some(solved));
                }
                if is_last {
                    let limit = accuracy * solved.seen.scale;
                    let distances = solved.seen.distances(&before.seen);
                    let parted = distances.iter().position(|distance| *distance > limit);
                    // for a single number of the motion the time of parting is not known
                    let parted = parted.filter(|_| self.request.quantity.is_over_time());
                    let part = parted.map_or(0.0, |at| at as f64 / distances.len() as f64);
                    found.known_until = Some(part * self.scene.end());
                    return Ok(None);
                }
            }
            before = Some(solved);
            rtol = tightening::tighter(rtol);
        }
    }

    /// Finds an alpha of which ten times as much makes no significant change.
    fn alpha(&mut self, tight: Solved, found: &mut Evidence) -> Result<Solved, Stop> {
        let has_rows = self.scene.phases().iter().any(|phase| !phase.constraints.is_empty());
        let mut firm = tight;
        while has_rows && firm.choice.settings.alpha < FIRMEST {
            let alpha = firm.choice.settings.alpha;
            let settings = Settings { alpha: FIRMER * alpha, ..firm.choice.settings.clone() };
            let Some(firmer) = self.run(&Choice { settings, ..firm.choice.clone() })? else {
                break;
            };
            let change = firm.error(&firmer);
            found.alphas.push((alpha, change));
            found.models.push(firmer.clone());
            if change <= OF_ALPHA * self.request.accuracy {
                break;
            }
            firm = firmer;
        }
        Ok(firm)
    }

    /// Finds the run with the measure of strain that is right however far cells turn, and what the other one
    /// changes.
    fn law(&mut self, firm: Solved, found: &mut Evidence) -> Result<Solved, Stop> {
        let strain = match firm.choice.strain {
            Strain::Cauchy => Strain::Green,
            // rigid pieces turn
            Strain::Green if self.scene.body().rigid_pieces().is_some() => return Ok(firm),
            Strain::Green => Strain::Cauchy,
        };
        let Some(other) = self.run(&Choice { strain, ..firm.choice.clone() })? else {
            return Ok(firm);
        };
        found.models.push(other.clone());
        let [rich, poor] = match strain {
            Strain::Green => [other, firm],
            Strain::Cauchy => [firm, other],
        };
        found.law = Some(poor.error(&rich));
        Ok(rich)
    }

    /// The run with consistent inertia, if it was written lumped: what that changes is an error of the model, which an error of the
    /// mesh may hide.
    fn consistent(&mut self, rich: Solved, found: &mut Evidence) -> Result<Solved, Stop> {
        if rich.choice.inertia == Inertia::Consistent {
            return Ok(rich);
        }
        let choice = Choice { inertia: Inertia::Consistent, ..rich.choice.clone() };
        let Some(consistent) = self.run(&choice)? else { return Ok(rich) };
        found.models.push(consistent.clone());
        found.inertia = Some(rich.error(&consistent));
        Ok(consistent)
    }

    /// Runs finer meshes, until the finest show that they are fine enough, or take too long. Three of one kind have to show it:
    /// two may agree by chance. Where halving all cells takes too long, triangles and tetrahedra are divided where their strains
    /// jump most.
    fn refine(&mut self, rich: &Solved, found: &mut Evidence) -> Result<(), Stop> {
        if !self.scene.body().is_single() {
            found.not_tried.push(OF_SEVERAL.into());
            return Ok(());
        }
        let richest = RicherCells::of(self.scene.body());
        let finer = |richer, halved| Choice { richer, halved, ..rich.choice.clone() };
        let first = if richest.is_some() { 0 } else { 2 };
        let steps = (first..FINEST).map(|halved| finer(richest, halved));
        for choice in iter::once(finer(None, 1)).chain(steps) {
            if !self.run_mesh(&choice, found)? {
                break;
            }
            // linear cells that lock may agree with each other
            if choice.richer == richest && self.is_fine(found) {
                return Ok(());
            }
        }
        for _ in 0..MOST_LOCAL {
            let Some(last) = found.truth() else { return Ok(()) };
            let (mut choice, count) = (last.choice.clone(), found.meshes.len());
            if choice.richer != richest || last.worst.is_empty() {
                return Ok(());
            }
            choice.halved_in.push(last.worst.clone());
            let is_done = !self.run_mesh(&choice, found)? || self.is_fine(found);
            if is_done || found.meshes.len() == count {
                return Ok(());
            }
        }
        Ok(())
    }

    /// Whether the finest mesh is known to be fine enough.
    fn is_fine(&self, found: &Evidence) -> bool {
        found.has_rate() && found.resolution() < OF_TRUTH * self.request.accuracy
    }

    /// Runs the mesh of a `choice`. False if there is no such mesh, or no time for it.
    fn run_mesh(&mut self, choice: &Choice, found: &mut Evidence) -> Result<bool, Stop> {
        let Some(last) = found.truth() else { return Ok(false) };
        let scene = match choice.scene(&self.scene) {
            Ok(scene) => scene,
            Err(error) => {
                found.not_tried.push(format!("finer meshes: {error}"));
                return Ok(false);
            }
        };
        let unknowns = 2 * scene.body().dofs() + 2;
        let can_afford = unknowns <= last.unknowns || self.affords(unknowns, &found.meshes);
        let solved = if can_afford { self.run(choice)? } else { None };
        if !can_afford || self.cut == Some(Cut::Share) {
            let mesh = choice.mesh();
            let why = format!("{mesh}: {unknowns} unknowns take longer than the budget");
            found.not_tried.push(why);
            return Ok(false);
        }
        found.meshes.extend(solved);
        Ok(true)
    }

    /// Tries to omit terms.
    fn leave_out(&mut self, rich: &Solved, found: &mut Evidence) -> Result<(), Stop> {
        for term in self.scene.terms() {
            let choice = Choice { without: vec![term.clone()], ..rich.choice.clone() };
            if let Some(solved) = self.run(&choice)? {
                found.terms.push((term, solved.error(rich)));
                found.models.push(solved);
            }
        }
        if found.inertia.is_some() || rich.choice.inertia == Inertia::Lumped {
            return Ok(());
        }
        let choice = Choice { inertia: Inertia::Lumped, ..rich.choice.clone() };
        if let Some(solved) = self.run(&choice)? {
            found.inertia = Some(solved.error(rich));
            found.models.push(solved);
        }
        Ok(())
    }

    /// The cheapest model on the cheapest mesh that is right, apart from errors of the integration.
    fn enough(&self, rich: &Solved, found: &Evidence) -> Option<Choice> {
        let left = found.left(self.request.accuracy);
        let truth = found.truth()?;
        let is_fine = |mesh: &&Solved| mesh.error(truth) <= OF_MESH * left;
        let fine = found.meshes.iter().filter(is_fine);
        let mesh = fine.min_by(|a, b| a.seconds.total_cmp(&b.seconds)).unwrap_or(truth);
        let strain = match found.law {
            Some(error) if error <= OF_LAW * left => Strain::Cauchy,
            _ => rich.choice.strain,
        };
        let small = found.terms.iter().filter(|(_, error)| *error <= OF_TERM * left);
        let without = small.map(|(term, _)| term.clone()).collect();
        Some(Choice { strain, without, ..mesh.choice.clone() })
    }

    /// Choice `enough`, if its omitted terms and its measure of strain change as little on the finest mesh as on that which was
    /// written; all of the model otherwise.
    fn confirmed(&mut self, enough: Choice, found: &mut Evidence) -> Result<Choice, Stop> {
        let Some(truth) = found.truth().cloned() else { return Ok(enough) };
        let (strain, without) = (enough.strain, enough.without.clone());
        let poor = Choice { strain, without, ..truth.choice.clone() };
        if poor == truth.choice {
            return Ok(enough);
        }
        let whole = Choice { strain: truth.choice.strain, without: Vec::new(), ..enough.clone() };
        let terms = OF_TERM * poor.without.len() as f64;
        let law = if poor.strain == truth.choice.strain { 0.0 } else { OF_LAW };
        if let Some(solved) = self.known_or_run(&poor, found)? {
            let change = solved.error(&truth);
            found.together = Some(change);
            if change <= (terms + law) * found.left(self.request.accuracy) {
                return Ok(enough);
            }
        }
        Ok(whole)
    }

    /// A run that was made already, or else is made and added to the models.
    fn known_or_run(
        &mut self,
        choice: &Choice,
        found: &mut Evidence,
    ) -> Result<Option<Solved>, Stop> {
        let known = found.all().chain(found.meshes.first()).find(|solved| solved.choice == *choice);
        if let Some(known) = known {
            return Ok(Some(known.clone()));
        }
        let solved = self.run(choice)?;
        found.models.extend(solved.clone());
        Ok(solved)
    }

    /// Tries the equilibrium in place of the motion, and estimates its error on the mesh as it was written.
    fn rest(&mut self, enough: &Choice, found: &mut Evidence) -> Result<(), Stop> {
        // damping has no effect at rest
        let choice = Choice { is_static: true, ..enough.clone() };
        let Some(solved) = self.run(&choice)? else { return Ok(()) };
        found.sweep.push(solved.clone());
        if found.is_right(&solved, self.request.accuracy) {
            let coarse = Choice { richer: None, halved: 0, halved_in: Vec::new(), ..choice };
            let scene = coarse.scene(&self.scene).ok();
            let equilibrium = scene.and_then(|scene| self.at_rest(&scene).ok());
            let estimate =
                |equilibrium| MeshEstimate::of(&equilibrium, &self.request.quantity).ok();
            found.mesh_estimate = equilibrium.and_then(estimate);
        }
        Ok(())
    }

    /// Tries methods and tolerances for a model that is enough, and with the fastest of them the ways to
    /// treat contact events.
    fn sweep(&mut self, enough: &Choice, found: &mut Evidence) -> Result<(), Stop> {
        let accuracy = self.request.accuracy;
        let implicit = [Method::Auto, Method::Arkode, Method::CvodeBdf];
        let mut ways = implicit.map(|method| (method, enough.inertia)).to_vec();
        let lumped_is_enough =
            found.inertia.is_some_and(|error| error <= OF_LAW * found.left(accuracy));
        let central = Method::CentralDifference;
        let can_be_central = central.why_not(&self.scene).is_none();
        if can_be_central && (lumped_is_enough || enough.inertia == Inertia::Lumped) {
            ways.push((central, Inertia::Lumped));
        }
        let mut fastest: Option<Solved> = None;
        for (method, inertia) in ways {
            // the effect of the inertia on this mesh
            if inertia != enough.inertia {
                self.known_or_run(&Choice { inertia, ..enough.clone() }, found)?;
            }
            for rtol in TOLERANCES {
                let settings = Settings {
                    alpha: enough.settings.alpha,
                    ..self.request.settings(method, rtol, ContactEvents::Auto)
                };
                let choice = Choice { settings, inertia, ..enough.clone() };
                let limit = fastest.as_ref().map_or(f64::INFINITY, |fastest| fastest.seconds);
                self.patience = PATIENCE * limit;
                let solved = self.run(&choice);
                self.patience = f64::INFINITY;
                let Some(solved) = solved? else {
                    if self.cut == Some(Cut::Late) {
                        let late = "it takes more than twice as long as the fastest that is right";
                        found
                            .not_tried
                            .push(format!("{method} at rtol {rtol:.0e} to its end: {late}"));
                        break;
                    }
                    continue;
                };
                found.sweep.push(solved.clone());
                let is_right = found.is_right(&solved, accuracy);
                let is_late = solved.seconds > PATIENCE * limit;
                if is_right && solved.seconds < limit {
                    fastest = Some(solved);
                }
                if is_right || is_late {
                    break;
                }
            }
        }
        let Some(fastest) = fastest else { return Ok(()) };
        let has_contact =
            !fastest.choice.scene(&self.scene).is_ok_and(|s| s.obstacles().is_empty());
        for contact_events in [ContactEvents::StepOver, ContactEvents::Locate] {
            let settings = Settings { contact_events, ..fastest.choice.settings.clone() };
            if has_contact
                && let Some(solved) = self.run(&Choice { settings, ..fastest.choice.clone() })?
            {
                found.sweep.push(solved);
            }
        }
        Ok(())
    }
}
