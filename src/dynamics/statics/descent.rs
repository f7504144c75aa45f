//! Steps that lower the energy: the line search, and the first step of a load step.
//!
//! Nodes move along straight lines, cells rotate: a straight step stretches a slender body, and a long one is cut to a small fraction. So
//! where a straight step does not lower the energy, its cells are rotated by the same angles instead (`elements/body/turning.rs`).
//!
//! A straight step that rotates a cell by theta stretches it by theta^2/2; a step of a radian is cut to
//! some hundredths by the line search. The energy has to fall along the rotated step as along the straight one. A
//! load step begins with the tangent of the last one at its load, if the energy falls along the whole of that
//! step, as the tangent of the new load has unbalanced stress there. Mixed methods (stress as
//! an unknown; D. Magisano, L. Leonetti, G. Garcea, Int. J. Numer. Methods Eng. 109, 2017) do as well for St.
//! Venant-Kirchhoff under dead loads; with rubber and tendons, which straight steps of nodes stretch in between,
//! they fail with Hooke's moduli. Iterations are in `docs/notes/statics.md`.

use super::newton::{PASSED, Search, Stuck, reason};
use crate::base::simd::add_multiple;
use crate::base::vector::{dot, largest};
use crate::integrators::ode::Failure;

/// Least turn (rad) for which a step is another one if cells turn along it.
const LEAST_TURN: f64 = 0.01;

/// The longest first steps that are tried, in sizes of the body: straight, and turning.
const FAR: [f64; 2] = [0.5, 2.0];

/// Deformation of cells along a step.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Path {
    Straight,
    Turning,
}

/// Result of a step.
enum End {
    /// Lower energy: accepted.
    Lower,
    /// Up; the factor for which the energy is lowest, by the parabola through the known values.
    Higher(f64),
    /// To where forces are undefined, by this message.
    Undefined(String),
    /// Through surfaces that touch, after this part of it.
    Beyond(f64),
}

impl Search<'_> {
    /// Takes the step to which the tangent of the last load step leads, if the energy falls along the whole of it. Returns whether it has
    /// been taken.
    ///
    /// At the same displacements, the present tangent has the stress of a load that nothing resists yet: a strip that grows on
    /// one side is pressed as if it could not bend, and a tendon resists the bending that it causes.
    pub(super) fn predict(&mut self) -> Result<bool, Stuck> {
        // only from there: another state has a tangent of its own
        let has_begun = self.curve.last().is_some_and(|point| point.u != self.u);
        if self.is_linear || self.is_loose || has_begun || self.tried == self.fraction {
            return Ok(false);
        }
        self.rest.lacking(self.tried, &self.u, &mut self.d);
        if largest(&self.d) > 1e-12 * self.size {
            return Ok(false);
        }
        self.rest.update_tangent(self.fraction, &self.u);
        if !self.rest.factorize(self.floor) {
            return Ok(false);
        }
        let mu = self.mu.clone();
        self.rest.solve(&self.at.total, &self.d, &mut self.x, &mut self.mu);
        let residual = self.rest.residual(&self.at.total, &self.mu, &mut self.work);
        let is_far = residual > self.statics.rtol * self.at.scale;
        let length = largest(&self.x) / self.size;
        let is_lower = is_far
            && (length <= FAR[0] && self.lowers(Path::Straight)?
                || length <= FAR[1] && self.can_turn(1.0) && self.lowers(Path::Turning)?);
        if is_lower {
            self.iterations += 1;
            self.residual = residual;
            return Ok(true);
        }
        self.mu = mu;
        Ok(false)
    }

    fn lowers(&mut self, path: Path) -> Result<bool, Stuck> {
        Ok(matches!(self.go(1.0, path)?, End::Lower))
    }

    /// Line search: goes along x, `factor` times its length at most, so far that the energy falls.
    pub(super) fn descend(&mut self, mut factor: f64) -> Result<(), Stuck> {
        let mut refused = None;
        let mut path = Path::Straight;
        for _ in 0..40 {
            let shorter = match self.go(factor, path)? {
                End::Lower => return Ok(()),
                End::Beyond(part) => {
                    refused = Some(PASSED.to_owned());
                    factor *= part.clamp(0.1, 0.9);
                    continue;
                }
                End::Higher(shorter) => shorter,
                End::Undefined(message) => {
                    refused = Some(message);
                    0.5 * factor
                }
            };
            if path == Path::Straight && self.can_turn(factor) {
                path = Path::Turning;
                continue;
            }
            // if it is NaN, for example: half
            let shorter = if shorter.is_finite() { shorter } else { 0.5 * factor };
            factor = shorter.clamp(0.1 * factor, 0.5 * factor);
        }
        let stalled = "the energy falls no further along the Newton step: forces without a \
                       potential, or with a jump, may have no equilibrium here";
        Err(self.stuck(refused.unwrap_or_else(|| stalled.into())))
    }

    /// Takes the step x, which meets the constraints, though the energy may rise: straight, or turning where that strains less.
    pub(super) fn meet(&mut self) -> Result<(), Stuck> {
        let straight = self.reach(1.0, Path::Straight)?;
        if self.can_turn(1.0) {
            let (u, at) = (self.work.clone(), self.trial.clone());
            let turning = self.reach(1.0, Path::Turning)?;
            let strains_less = || {
                let step: Vec<f64> = self.work.iter().zip(&u).map(|(to, u)| to - u).collect();
                self.trial.energy_since(&at, 1.0, &step) < 0.0
            };
            if turning.is_none() && (straight.is_some() || strains_less()) {
                self.step_there();
                return Ok(());
            }
            (self.work, self.trial) = (u, at);
        }
        match straight {
            Some(End::Undefined(message)) => Err(self.stuck(message)),
            Some(_) => Err(self.stuck(PASSED.into())),
            None => {
                self.step_there();
                Ok(())
            }
        }
    }

    /// Goes along `factor` times x, and stays there if the energy is lower.
    fn go(&mut self, factor: f64, path: Path) -> Result<End, Stuck> {
        if let Some(end) = self.reach(factor, path)? {
            return Ok(end);
        }
        let rise = match path {
            Path::Straight => self.trial.energy_since(&self.at, factor, &self.x),
            Path::Turning => {
                let step: Vec<f64> = self.work.iter().zip(&self.u).map(|(to, u)| to - u).collect();
                self.trial.energy_since(&self.at, 1.0, &step)
            }
        };
        let slope = -dot(&self.at.total, &self.x);
        let round_off = self.trial.round_off(&self.u) + self.at.round_off(&self.u);
        if rise <= 1e-4 * factor * slope + round_off {
            self.step_there();
            return Ok(End::Lower);
        }
        Ok(End::Higher(-0.5 * slope * factor / (rise / factor - slope)))
    }

    /// Where `factor` times x leads, for `work`, and the forces there, for `trial`; or the reason for its failure.
    fn reach(&mut self, factor: f64, path: Path) -> Result<Option<End>, Stuck> {
        self.work.copy_from_slice(&self.u);
        add_multiple(factor, &self.x, &mut self.work);
        if path == Path::Turning {
            let (right, _) = self.turns(factor);
            let mut more = vec![0.0; right.len()];
            self.rest.solve_other(&right, &mut more);
            add_multiple(1.0, &more, &mut self.work);
        }
        if let Some(part) = self.rest.passage(&self.u, &self.work) {
            return Ok(Some(End::Beyond(part)));
        }
        match self.rest.evaluate(self.tried, &self.work, &mut self.trial) {
            Ok(()) => Ok(None),
            Err(Failure::Recoverable(message)) => Ok(Some(End::Undefined(message))),
            Err(fatal) => Err(self.stuck(reason(fatal))),
        }
    }

    /// Stays where [`reach`](Self::reach) has led.
    fn step_there(&mut self) {
        std::mem::swap(&mut self.at, &mut self.trial);
        std::mem::swap(&mut self.u, &mut self.work);
    }

    /// Whether cells turn along `factor` times x. Then the matrix for that takes the place of K, until that is factorized again.
    fn can_turn(&mut self, factor: f64) -> bool {
        let body = self.body;
        self.turns_in_circles()
            && self.turns(factor).1 >= LEAST_TURN
            && self.rest.factorize_other(|matrix| body.add_gradients(matrix))
    }

    /// Right-hand side that turns cells along `factor` times x, and the largest turn (rad).
    fn turns(&self, factor: f64) -> (Vec<f64>, f64) {
        let step: Vec<f64> = self.x.iter().map(|x| factor * x).collect();
        let mut right = vec![0.0; step.len()];
        let angle = self.body.add_turned(&self.u, &step, &mut right);
        (right, angle)
    }
}
