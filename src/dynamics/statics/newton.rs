//! The search for an equilibrium: Newton's method with falling energy, load step by load step.
//!
//! The tolerance, 1e-10 of the largest force, may be out of reach: in nearly incompressible bodies forces are
//! small differences of much larger terms. An iteration that no longer reduces the residual ends the search
//! if the residual is within the last digits of the terms of K u. Moving obstacles are taken at their
//! positions; that their velocity drags nothing and friction does not act is a warning.
//!
//! The lowest eigenvalue of K x = omega^2 M x, by inverse iteration with the factor at hand, distinguishes
//! stable equilibria (with their lowest frequency), neutral and unstable ones; a Rayleigh quotient below 0
//! proves instability.

use super::options::Statics;
use crate::base::vector::largest;
use crate::dynamics::equilibrium::Stability;
use crate::dynamics::system::{AtRest, ForceBalance};
use crate::elements::body::Body;
use crate::integrators::ode::Failure;

/// The search stopped: why, and the largest unbalanced force (N).
pub(super) struct Stuck {
    pub(super) cause: String,
    pub(super) residual: f64,
}

/// An equilibrium found for a part of the load.
pub(super) struct Point {
    /// Part of constraints and loads.
    pub(super) fraction: f64,
    pub(super) u: Vec<f64>,
    /// Constraint forces.
    pub(super) mu: Vec<f64>,
    /// Largest |A^T u - b| (m).
    pub(super) drift: f64,
}

impl Point {
    /// Start of the search.
    pub(super) fn start(u: &[f64], rows: usize) -> Self {
        Self { fraction: 0.0, u: u.to_vec(), mu: vec![0.0; rows], drift: 0.0 }
    }
}

/// Rigid-body freedom that the constraints leave to the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Hold {
    /// None, by constraints on single nodes alone.
    Whole,
    /// None, but only together with constraints that couple several nodes.
    BySums,
    /// Some.
    Loose,
}

/// The state of a search.
pub(super) struct Search<'a> {
    pub(super) rest: AtRest,
    pub(super) statics: &'a Statics,
    pub(super) body: &'a Body,
    /// Whether the constraints alone do not hold the body.
    pub(super) is_loose: bool,
    /// Size of the body (m): no iteration moves a node by more than half of it.
    pub(super) size: f64,
    /// Multiples of M that are added to K: the least one, and the present one (1/s^2).
    pub(super) floor: f64,
    pub(super) shift: f64,
    /// Order of magnitude of the largest eigenvalue of K x = eigenvalue M x.
    pub(super) highest: f64,
    /// K is constant, and has been factorized.
    is_done: bool,
    pub(super) is_linear: bool,
    /// Part of constraints and loads in force at `u`.
    pub(super) fraction: f64,
    /// Part last tried.
    pub(super) tried: f64,
    pub(super) u: Vec<f64>,
    /// Constraint forces there.
    pub(super) mu: Vec<f64>,
    pub(super) at: ForceBalance,
    pub(super) residual: f64,
    pub(super) iterations: usize,
    pub(super) load_steps: usize,
    pub(super) failed_steps: usize,
    /// The equilibria found: those of a load curve, or else the last one.
    pub(super) curve: Vec<Point>,
    /// Rigid motions, in words, that were removed from the last one.
    pub(super) removed: Vec<String>,
    pub(super) trial: ForceBalance,
    pub(super) x: Vec<f64>,
    pub(super) d: Vec<f64>,
    pub(super) work: Vec<f64>,
    /// Load steps for which damped motion found the equilibrium.
    pub(super) damped_steps: usize,
}

/// Largest number of Newton iterations to an equilibrium that is near, stable or not, and the distance that
/// counts as near, relative to the size of the body.
const MOST_CLIMBING: usize = 20;
const NEAR: f64 = 0.5;

/// Parts of the highest eigenvalue: the smallest shift that is tried (which also stays if rigid motions are
/// free, or held by rows of several nodes), and the largest.
pub(super) const SHIFTS: [f64; 2] = [1e-10, 1e3];

/// Reason for the rejection of a step.
pub(super) const PASSED: &str =
    "surfaces that touch would pass through each other: take more load_steps";

impl<'a> Search<'a> {
    /// From the start of `rest`.
    pub(super) fn new(mut rest: AtRest, statics: &'a Statics, body: &'a Body, hold: Hold) -> Self {
        let (dofs, rows) = (rest.system().dofs(), rest.system().rows().len());
        let u = rest.start().to_vec();
        rest.update_tangent(1.0, &u);
        let highest = rest.highest();
        let floor = if hold == Hold::Whole { 0.0 } else { SHIFTS[0] * highest };
        Self {
            is_linear: rest.is_linear(),
            rest,
            statics,
            body,
            is_loose: hold == Hold::Loose,
            size: body.size(),
            floor,
            shift: floor,
            highest,
            is_done: false,
            fraction: 0.0,
            tried: 0.0,
            u,
            mu: vec![0.0; rows],
            at: ForceBalance::zeros(dofs),
            residual: 0.0,
            iterations: 0,
            load_steps: 0,
            failed_steps: 0,
            curve: Vec::new(),
            removed: Vec::new(),
            trial: ForceBalance::zeros(dofs),
            x: vec![0.0; dofs],
            d: vec![0.0; rows],
            work: vec![0.0; dofs],
            damped_steps: 0,
        }
    }

    /// Records the equilibrium that was found.
    pub(super) fn arrive(&mut self) {
        self.fraction = self.tried;
        self.load_steps += 1;
        if !self.statics.is_curve() {
            self.curve.clear();
        }
        let drift = self.drift();
        let (u, mu) = (self.u.clone(), self.mu.clone());
        self.curve.push(Point { fraction: self.fraction, u, mu, drift });
    }

    /// Time (s) of equilibrium `number` of `count`, which is that for a `fraction` of the load.
    pub(super) fn time(&self, number: usize, count: usize, fraction: f64) -> f64 {
        let part = match self.statics.arc_steps {
            0 => fraction,
            _ => number as f64 / count.max(1) as f64,
        };
        part * self.rest.time()
    }

    /// Finds the equilibrium for the part `tried` of the load, from `u`, in `max_iterations` at most.
    pub(super) fn balance(&mut self, max_iterations: usize) -> Result<(), Stuck> {
        let Statics { rtol, .. } = *self.statics;
        self.shift = self.floor;
        self.residual = f64::INFINITY;
        let from = self.u.clone();
        self.evaluate()?;
        let predicted = usize::from(max_iterations > 1 && self.predict()?);
        for iteration in predicted..max_iterations {
            self.iterations += 1;
            self.turn();
            self.prepare()?;
            self.rest.lacking(self.tried, &self.u, &mut self.d);
            self.rest.solve(&self.at.total, &self.d, &mut self.x, &mut self.mu);
            self.keep_place();
            let before = self.residual;
            self.residual = self.rest.residual(&self.at.total, &self.mu, &mut self.work);
            let (lacking, length) = (largest(&self.d), largest(&self.x));
            if !length.is_finite() {
                return Err(self.stuck("the displacements grow without bound".into()));
            }
            if lacking > 1e-12 * self.size && iteration < 2 {
                // the constraints are met first, even if the energy rises
                self.meet()?;
                continue;
            }
            let is_newton = self.shift == self.floor;
            let is_round_off = is_newton && length <= 1e-3 * rtol * self.size;
            if self.residual <= rtol * self.at.scale || is_round_off || self.is_exhausted(before) {
                return Ok(());
            }
            self.descend((0.5 * self.size / length).min(1.0))?;
        }
        if self.shift > self.floor && self.climb(&from) {
            return Ok(());
        }
        let beyond = match self.shift > self.floor {
            true => {
                "the stiffness has become indefinite, as beyond buckling, and the way down from there is long: give it a side \
                 to buckle to by a small load, or "
            }
            false => "",
        };
        Err(self.stuck(format!(
            "not converged after {max_iterations} iterations: {beyond}raise max_iterations or load_steps"
        )))
    }

    /// Continues from where the search began with Newton's method, regardless of the energy, to an
    /// equilibrium that may be unstable. Returns whether there is one near; if not, the state is restored.
    fn climb(&mut self, from: &[f64]) -> bool {
        let before = (self.u.clone(), self.mu.clone(), self.at.clone(), self.residual);
        let rtol = self.statics.rtol;
        self.u.copy_from_slice(from);
        for _ in 0..MOST_CLIMBING {
            self.iterations += 1;
            if self.evaluate().is_err() {
                break;
            }
            self.rest.update_tangent(self.tried, &self.u);
            if !self.rest.factorize_any() {
                break;
            }
            self.rest.lacking(self.tried, &self.u, &mut self.d);
            self.rest.solve(&self.at.total, &self.d, &mut self.x, &mut self.mu);
            self.residual = self.rest.residual(&self.at.total, &self.mu, &mut self.work);
            let (lacking, length) = (largest(&self.d), largest(&self.x));
            let is_round_off = length <= 1e-3 * rtol * self.size;
            if lacking <= 1e-12 * self.size
                && (self.residual <= rtol * self.at.scale || is_round_off)
            {
                // the factorization that determines stability
                self.shift = self.floor;
                return self.prepare().is_ok();
            }
            self.u.iter_mut().zip(&self.x).for_each(|(u, x)| *u += x);
            let way = self.u.iter().zip(from).map(|(u, from)| (u - from).abs());
            let is_near = way.fold(0.0, f64::max) <= NEAR * self.size;
            if !is_near || self.x.iter().any(|x| !x.is_finite()) {
                break;
            }
        }
        (self.u, self.mu, self.at, self.residual) = before;
        false
    }

    /// Whether the unbalanced forces are only round-off, and iterations no longer reduce them much from what
    /// they were `before`: in a nearly incompressible body the forces between nodes are so much larger than
    /// their sums that the tolerance cannot be reached.
    fn is_exhausted(&mut self, before: f64) -> bool {
        if self.residual < 0.5 * before {
            return false;
        }
        self.residual <= self.round_off()
    }

    /// Size of the round-off in nodal forces (N) where the search is.
    pub(super) fn round_off(&mut self) -> f64 {
        self.work.iter_mut().zip(&self.u).for_each(|(size, u)| *size = u.abs());
        self.rest.round_off(&self.work)
    }

    pub(super) fn evaluate(&mut self) -> Result<(), Stuck> {
        let result = self.rest.evaluate(self.tried, &self.u, &mut self.at);
        result.map_err(|failure| self.stuck(reason(failure)))
    }

    /// Factorizes K, shifted just enough to be positive definite.
    fn prepare(&mut self) -> Result<(), Stuck> {
        if self.is_linear && self.is_done {
            return Ok(());
        }
        self.rest.update_tangent(self.tried, &self.u);
        let [least, most] = SHIFTS.map(|part| part * self.highest);
        self.shift = if self.shift <= 10.0 * least { self.floor } else { 0.1 * self.shift };
        while !self.rest.factorize(self.shift) {
            if self.is_linear || self.shift > most {
                let cause = "the stiffness matrix is not positive definite: hold more of the body";
                return Err(self.stuck(cause.into()));
            }
            self.shift = (10.0 * self.shift).max(100.0 * least);
        }
        self.is_done = true;
        Ok(())
    }

    /// Stability of the equilibrium at `u`, by the last factorization: that of K there.
    pub(super) fn stability(&mut self) -> Stability {
        let eigenvalue = self.rest.lowest_eigenvalue(self.shift);
        let omega = eigenvalue.abs().sqrt();
        // round-off of K against M
        match eigenvalue.abs() <= 1e-13 * self.highest {
            true => Stability::Neutral,
            false if eigenvalue > 0.0 => {
                Stability::Stable { frequency: omega / std::f64::consts::TAU }
            }
            false => Stability::Unstable { growth: omega },
        }
    }

    /// Largest |A^T u - b| (m).
    fn drift(&mut self) -> f64 {
        self.rest.lacking(self.fraction, &self.u, &mut self.d);
        largest(&self.d)
    }

    pub(super) fn stuck(&self, cause: String) -> Stuck {
        Stuck { cause, residual: self.residual }
    }
}

pub(super) fn reason(failure: Failure) -> String {
    match failure {
        Failure::Recoverable(message) => message,
        Failure::Fatal(error) => error.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::body::Strain;
    use crate::elements::mesh::Mesh;
    use crate::scene::constraint::PhaseStart;
    use crate::scene::timeline::{Phase, Scene};
    use crate::studies::samples::BEAM_MATERIAL;

    /// A direction of falling energy, a hundred times too long: the bar is stretched no further than the
    /// energy falls.
    #[test]
    fn no_step_goes_uphill() {
        let mesh = Mesh::bar(0.1, 3).unwrap();
        let body = Body::new(mesh, BEAM_MATERIAL).area(2e-4).strain(Strain::Green).build().unwrap();
        let phase = Phase::until(1.0).hold("left").load("right", [1.0]);
        let scene = Scene::new(body).phase(phase.clone());
        let start = PhaseStart { time: 0.0, u: &[0.0; 3] };
        let mut forces = scene.forces().unwrap();
        let matrices = scene.matrices(&forces);
        let system = scene.system(&matrices, &phase, forces.remove(0), &start, 0.0).unwrap();
        let rest = AtRest::new(system, 1.0, "test").unwrap();
        let statics = Statics::default();
        let mut search = Search::new(rest, &statics, scene.body(), Hold::Whole);
        search.tried = 1.0;
        assert!(search.evaluate().is_ok());
        let start = search.at.clone();
        // F L/(E A) = 1 cm: the energy of both halves of the bar is least there
        search.x = vec![0.0, 0.5, 1.0];
        assert!(search.descend(1.0).is_ok());
        let change = search.at.energy_since(&start, search.u[2], &[0.0, 0.5, 1.0]);
        // at 1 cm it is -F^2 L/(2 E A) = -5 mJ, were the bar linear
        assert!(change < 0.0 && search.u[2] < 0.02, "{} m, {change} J", search.u[2]);
        assert!((search.u[1] - 0.5 * search.u[2]).abs() < 1e-16);
    }
}
