//! The ladder, one rung at a time: tolerance, law, mesh, what may be left out, method.

use super::choice::Choice;
use super::search::{Search, Solved, Stop};
use crate::body::{Inertia, Strain};
use crate::mesh::CellKind;
use crate::scene::Term;
use crate::settings::{ContactEvents, Method, Settings};

/// What was found on the way.
#[derive(Debug, Default)]
pub(super) struct Found {
    /// The scene as it was written, by its own settings.
    pub(super) written: Option<Solved>,
    /// Models with hardly any error of the integration, the mesh as it was written.
    pub(super) models: Vec<Solved>,
    /// The richest law on meshes from coarse to fine; the last one is what all is compared with.
    pub(super) meshes: Vec<Solved>,
    /// What was left out, and what that changes (relative).
    pub(super) terms: Vec<(Term, f64)>,
    /// By how much the other measure of strain changes it, and the other inertia.
    pub(super) law: Option<f64>,
    pub(super) inertia: Option<f64>,
    /// What is enough, by several methods and tolerances.
    pub(super) sweep: Vec<Solved>,
    /// Time (s) until which two tight runs agree, if that is before the end.
    pub(super) known_until: Option<f64>,
    pub(super) not_tried: Vec<String>,
}

/// Parts of the accuracy that errors of a kind may take: of the integration of those runs that models are compared
/// by, of the law, of each term that is left out, and of the mesh.
const OF_TIGHT: f64 = 0.05;
const OF_LAW: f64 = 0.3;
const OF_TERM: f64 = 0.05;
const OF_MESH: f64 = 0.6;
/// The finest mesh is fine enough if it may be off by this part of the accuracy itself.
const OF_TRUTH: f64 = 0.3;
/// Tolerances of the runs that models are compared by: the first, as part of the accuracy, what each is of the one before, and the
/// tightest.
const FIRST: f64 = 0.1;
const TIGHTER: f64 = 0.1;
const TIGHTEST: f64 = 1e-11;
const LOOSEST: f64 = 1e-3;
/// Tolerances that are swept.
const TOLERANCES: [f64; 10] = [1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 1e-6, 1e-7, 1e-8];
/// A sweep ends where runs take so many times as long as the fastest that is right.
const PATIENCE: f64 = 2.0;
/// What halving the cells leaves of the error: linear cells have order 2, and less at corners.
pub(super) const HALVING: f64 = 1.0 / 3.0;

impl Search<'_> {
    /// Climbs until all is known, or there is no more time.
    pub(super) fn climb(&mut self, found: &mut Found) -> Result<(), Stop> {
        let written = Choice::written(&self.scene, &self.request.settings);
        found.written = self.run(&written)?;
        let Some(tight) = self.tight(&written, found)? else { return Ok(()) };
        found.models.push(tight.clone());
        let rich = self.law(&tight, found)?;
        self.refine(&rich, found)?;
        self.leave_out(&rich, found)?;
        match self.enough(&rich, found) {
            // no method makes up for a mesh that is too coarse
            Some(enough) if self.allowed(found) > 0.0 => self.sweep(&enough, found),
            _ => Ok(()),
        }
    }

    fn error(&self, one: &Solved, truth: &Solved) -> f64 {
        truth.seen.distance(&one.seen).mean / truth.seen.scale
    }

    /// The model as it was written with hardly any error of the integration. `None` if it has no such motion.
    fn tight(&mut self, written: &Choice, found: &mut Found) -> Result<Option<Solved>, Stop> {
        let mut rtol = (FIRST * self.request.accuracy).clamp(TIGHTEST, LOOSEST);
        let mut before: Option<Solved> = None;
        loop {
            let contact_events = ContactEvents::Locate;
            let Settings { alpha, max_step, max_steps, .. } = self.request.settings;
            let own = Settings {
                rtol,
                contact_events,
                alpha,
                max_step,
                max_steps,
                ..Settings::default()
            };
            let Some(solved) = self.run(&Choice { settings: own, ..written.clone() })? else {
                return Ok(before);
            };
            if let Some(before) = &before {
                let apart = self.error(before, &solved);
                if apart <= OF_TIGHT * self.request.accuracy {
                    return Ok(Some(solved));
                }
                if rtol <= 2.0 * TIGHTEST && apart <= self.request.accuracy {
                    return Ok(Some(solved));
                }
                if rtol <= 2.0 * TIGHTEST {
                    let limit = self.request.accuracy * solved.seen.scale;
                    let distances = solved.seen.distances(&before.seen);
                    let parted = distances.iter().position(|distance| *distance > limit);
                    // of a number that follows from the motion it is not known since when
                    let parted = parted.filter(|_| self.request.quantity.is_over_time());
                    let part = parted.map_or(0.0, |at| at as f64 / distances.len() as f64);
                    found.known_until = Some(part * self.scene.end());
                    return Ok(None);
                }
            }
            before = Some(solved);
            rtol = (TIGHTER * rtol).max(TIGHTEST);
        }
    }

    /// The measure of strain that is right however far cells turn, and what the other one changes.
    fn law(&mut self, tight: &Solved, found: &mut Found) -> Result<Solved, Stop> {
        let other = match tight.choice.strain {
            Strain::Cauchy => Strain::Green,
            Strain::Green => Strain::Cauchy,
        };
        let Some(other) = self.run(&Choice { strain: other, ..tight.choice.clone() })? else {
            return Ok(tight.clone());
        };
        let [rich, poor] = match other.choice.strain {
            Strain::Green => [&other, tight],
            Strain::Cauchy => [tight, &other],
        };
        found.law = Some(self.error(poor, rich));
        let rich = rich.clone();
        found.models.push(other);
        Ok(rich)
    }

    /// Finer meshes, until the finest two tell how good they are.
    fn refine(&mut self, rich: &Solved, found: &mut Found) -> Result<(), Stop> {
        found.meshes.push(rich.clone());
        let kind = self.scene.body().mesh().kind();
        let has_quadratic =
            matches!(kind, CellKind::Triangle | CellKind::Quadrilateral | CellKind::Tetrahedron);
        let finer = |quadratic, halved| Choice { quadratic, halved, ..rich.choice.clone() };
        let mut steps = vec![finer(false, 1), finer(has_quadratic, usize::from(!has_quadratic))];
        steps.dedup();
        steps.extend([
            finer(has_quadratic, 1 + usize::from(!has_quadratic)),
            finer(has_quadratic, 2),
        ]);
        steps.dedup();
        for choice in steps {
            let Some(last) = found.meshes.last() else { return Ok(()) };
            let scene = match choice.scene(&self.scene) {
                Ok(scene) => scene,
                Err(error) => {
                    found.not_tried.push(format!("finer meshes: {error}"));
                    return Ok(());
                }
            };
            let unknowns = 2 * scene.body().dofs() + 2;
            if unknowns > last.unknowns && !self.affords(unknowns, last) {
                let cells = choice.cells(kind);
                found
                    .not_tried
                    .push(format!("{cells}: {unknowns} unknowns take longer than the budget"));
                return Ok(());
            }
            // two steps that agree need no third
            if choice.halved == 2
                && has_quadratic
                && self.resolution(found) < OF_TRUTH * self.request.accuracy
            {
                return Ok(());
            }
            if let Some(solved) = self.run(&choice)? {
                found.meshes.push(solved);
            }
        }
        Ok(())
    }

    /// The error that the finest mesh may have itself, as the one before tells.
    pub(super) fn resolution(&self, found: &Found) -> f64 {
        match &found.meshes[..] {
            [.., before, truth] => HALVING * self.error(before, truth),
            _ => f64::NAN,
        }
    }

    /// The error that a candidate may have: the accuracy less what its measure may be off by. A mesh that was compared with
    /// none is taken as it is.
    pub(super) fn allowed(&self, found: &Found) -> f64 {
        let resolution = self.resolution(found);
        self.request.accuracy - if resolution.is_nan() { 0.0 } else { resolution }
    }

    /// Tries what may be left out.
    fn leave_out(&mut self, rich: &Solved, found: &mut Found) -> Result<(), Stop> {
        for term in self.scene.terms() {
            let choice = Choice { without: vec![term.clone()], ..rich.choice.clone() };
            if let Some(solved) = self.run(&choice)? {
                found.terms.push((term, self.error(&solved, rich)));
                found.models.push(solved);
            }
        }
        let inertia = match rich.choice.inertia {
            Inertia::Consistent => Inertia::Lumped,
            Inertia::Lumped => Inertia::Consistent,
        };
        if let Some(solved) = self.run(&Choice { inertia, ..rich.choice.clone() })? {
            found.inertia = Some(self.error(&solved, rich));
            found.models.push(solved);
        }
        Ok(())
    }

    /// The cheapest model on the cheapest mesh that is right, but for the integration.
    pub(super) fn enough(&self, rich: &Solved, found: &Found) -> Option<Choice> {
        let accuracy = self.request.accuracy;
        let truth = found.meshes.last()?;
        let is_fine = |mesh: &&Solved| self.error(mesh, truth) <= OF_MESH * accuracy;
        let fine = found.meshes.iter().filter(is_fine);
        let mesh = fine.min_by(|a, b| a.seconds.total_cmp(&b.seconds)).unwrap_or(truth);
        let strain = match found.law {
            Some(error) if error <= OF_LAW * accuracy => Strain::Cauchy,
            _ => rich.choice.strain,
        };
        let small = found.terms.iter().filter(|(_, error)| *error <= OF_TERM * accuracy);
        let without = small.map(|(term, _)| term.clone()).collect();
        Some(Choice { strain, without, ..mesh.choice.clone() })
    }

    /// Methods and tolerances for a model that is enough.
    fn sweep(&mut self, enough: &Choice, found: &mut Found) -> Result<(), Stop> {
        let Some(truth) = found.meshes.last().cloned() else { return Ok(()) };
        let mut fastest = f64::INFINITY;
        let lumped_is_enough =
            found.inertia.is_some_and(|error| error <= OF_LAW * self.request.accuracy);
        let mut ways = vec![
            (Method::Auto, enough.inertia),
            (Method::Arkode, enough.inertia),
            (Method::CvodeBdf, enough.inertia),
        ];
        if lumped_is_enough || enough.inertia == Inertia::Lumped {
            ways.push((Method::CentralDifference, Inertia::Lumped));
        }
        for (method, inertia) in ways {
            for rtol in TOLERANCES {
                let Settings { alpha, max_step, max_steps, .. } = self.request.settings;
                let own =
                    Settings { method, rtol, alpha, max_step, max_steps, ..Settings::default() };
                let choice = Choice { settings: own, inertia, ..enough.clone() };
                let Some(solved) = self.run(&choice)? else { continue };
                let is_right = self.error(&solved, &truth) <= self.allowed(found);
                let seconds = solved.seconds;
                found.sweep.push(solved);
                if is_right {
                    fastest = fastest.min(seconds);
                    break;
                }
                if seconds > PATIENCE * fastest {
                    break;
                }
            }
        }
        Ok(())
    }
}
