//! Load steps: their sizes, and remedies where Newton's method fails.
//!
//! A step that fails is halved; where it would become too small, damped motion (implicit Euler steps of M u'
//! = f, longer as f falls) finds the next equilibrium, and the report says so. Loads are scaled by the
//! factor, signals of actuators and amounts in chambers rise linearly from values without a force
//! (`Scene::loaded`).

use super::newton::{SHIFTS, Search, Stuck};
use crate::base::vector::largest;

/// Iterations of a load step up to which the next one may be larger, and most iterations after a step that failed.
const FAST: usize = 15;
const FEW: usize = 30;

/// Most steps of damped motion, and the longest, relative to the size of the body.
const MOST_DAMPED: usize = 400;
const LONGEST: f64 = 0.1;

/// Its first shift, as a part of the highest eigenvalue, and how the shift changes: with the part of the unbalanced forces that
/// a step leaves, times a factor, within limits; after a step that is too long by another factor.
const FIRST_SHIFT: f64 = 1e-4;
const FALLING: f64 = 0.5;
const LIMITS: [f64; 2] = [0.1, 2.0];
const TOO_LONG: f64 = 4.0;

/// The least shift, which slows nothing down.
const LEAST_SHIFT: f64 = 1e-15;

impl Search<'_> {
    /// Applies the whole load.
    pub(super) fn all(&mut self) -> Result<(), Stuck> {
        let largest = 1.0 / self.statics.load_steps as f64;
        let mut step = largest;
        while self.fraction < 1.0 {
            // a part that differs from the whole load by round-off only is the whole load
            let target = self.fraction + step;
            self.tried = if target > 1.0 - 1e-9 { 1.0 } else { target };
            let (u, mu) = (self.u.clone(), self.mu.clone());
            let before = self.iterations;
            let is_smallest = 0.5 * step < self.statics.min_load_step;
            // a smaller step takes less than many iterations
            let most = match self.failed_steps > 0 && !is_smallest {
                true => self.statics.max_iterations.min(FEW),
                false => self.statics.max_iterations,
            };
            let found = match self.balance(most).and_then(|()| self.place()) {
                Err(stuck) if self.is_linear => return Err(stuck),
                // a body that nothing holds may be pushed on and on
                Err(stuck) if is_smallest && !self.is_loose => {
                    (self.u, self.mu) = (u.clone(), mu.clone());
                    let at = self.at.clone();
                    // the first reason is the one that helps
                    self.relax().and_then(|()| self.place()).map_err(|_| {
                        self.at = at;
                        stuck
                    })
                }
                found => found,
            };
            match found {
                Ok(()) => {
                    self.arrive();
                    if self.iterations - before <= FAST {
                        step = largest.min(2.0 * step);
                    }
                }
                Err(stuck) => {
                    (self.u, self.mu) = (u, mu);
                    self.failed_steps += 1;
                    if is_smallest {
                        return Err(stuck);
                    }
                    step *= 0.5;
                }
            }
        }
        Ok(())
    }

    /// The last resort: damped motion, without inertia, to the equilibrium for the part `tried` of the load, from `u`.
    ///
    /// Steps of the implicit Euler method for M u' = f(u), whose length grows as the unbalanced forces fall (pseudo-transient
    /// continuation: Kelley and Keyes, SIAM J. Numer. Anal. 35, 1998), until Newton's method converges.
    fn relax(&mut self) -> Result<(), Stuck> {
        let nowhere = "damped motion finds no equilibrium either";
        self.evaluate()?;
        let mut shift = FIRST_SHIFT * self.highest;
        let mut before = f64::INFINITY;
        for _ in 0..MOST_DAMPED {
            self.iterations += 1;
            self.rest.update_tangent(self.tried, &self.u);
            while !self.rest.factorize(shift) {
                shift *= TOO_LONG;
                if shift > SHIFTS[1] * self.highest {
                    return Err(self.stuck(nowhere.into()));
                }
            }
            self.rest.lacking(self.tried, &self.u, &mut self.d);
            let is_met = largest(&self.d) <= 1e-12 * self.size;
            self.rest.solve(&self.at.total, &self.d, &mut self.x, &mut self.mu);
            self.residual = self.rest.residual(&self.at.total, &self.mu, &mut self.work);
            let rtol = self.statics.rtol;
            let is_round_off =
                shift <= SHIFTS[0] * self.highest && largest(&self.x) <= 1e-3 * rtol * self.size;
            if is_met && (self.residual <= rtol * self.at.scale || is_round_off) {
                self.damped_steps += 1;
                return self.balance(self.statics.max_iterations);
            }
            self.work.iter_mut().zip(&self.u).zip(&self.x).for_each(|((w, u), x)| *w = u + x);
            let is_short = largest(&self.x) <= LONGEST * self.size;
            if !is_short
                || self.rest.passage(&self.u, &self.work).is_some()
                || self.rest.evaluate(self.tried, &self.work, &mut self.trial).is_err()
            {
                shift *= TOO_LONG;
                continue;
            }
            std::mem::swap(&mut self.at, &mut self.trial);
            std::mem::swap(&mut self.u, &mut self.work);
            shift *= (FALLING * self.residual / before).clamp(LIMITS[0], LIMITS[1]);
            shift = shift.max(self.floor).max(LEAST_SHIFT * self.highest);
            before = self.residual;
        }
        Err(self.stuck(nowhere.into()))
    }
}
