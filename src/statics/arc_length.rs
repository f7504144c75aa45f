//! The path of equilibria by arc length: Riks' method (Int. J. Solids Struct. 15, 1979) in the form that Crisfield
//! (Comput. Struct. 13, 1981) calls linearized.
//!
//! A step goes along the tangent of the path, x_q with K x_q - A mu = df/dlambda, A^T x_q = db/dlambda, as far as its norm,
//! that of M, is the length of the step. Newton's method comes back to the path within the plane across the tangent, with
//! the load factor lambda as one more unknown:
//!
//! ```text
//! x = x_r + dlambda x_q,   dlambda = -(n . x_r)/(n . x_q),   n = M x_q at the start of the step
//! ```
//!
//! where x_r is the Newton step at constant load. Both come from the factors of K, by LU where K is indefinite.
//! The path goes on to the side to which it came (n . last step > 0), at limit points, too.

use super::newton::{Search, Stuck, reason};
use crate::vector::{dot, largest};

/// Newton iterations of one step.
const MOST_ITERATIONS: usize = 12;

impl Search<'_> {
    /// Follows the path of equilibria from no load to the whole load.
    pub(super) fn trace(&mut self) -> Result<(), Stuck> {
        self.tried = 0.0;
        self.balance()?;
        let dofs = self.u.len();
        let (mut along, mut normal, mut last) = (vec![0.0; dofs], vec![0.0; dofs], vec![0.0; dofs]);
        let [mut longest, mut length] = [0.0; 2];
        for _ in 0..self.statics.arc_steps {
            self.factorize()?;
            self.load_direction(&mut along)?;
            self.rest.weigh(&along, &mut normal);
            let speed = dot(&along, &normal).sqrt();
            if longest == 0.0 {
                longest = speed / self.statics.load_steps as f64;
                length = longest;
            }
            if !(speed > 0.0 && speed.is_finite()) {
                return Err(
                    self.stuck("the load moves nothing, so there is no path to follow".into())
                );
            }
            let side = if dot(&normal, &last) < 0.0 { -1.0 } else { 1.0 };
            let (from, mu, start) = (self.u.clone(), self.mu.clone(), self.fraction);
            while let Err(stuck) = self.step(side * length / speed, &along, &normal) {
                self.u.copy_from_slice(&from);
                self.mu.copy_from_slice(&mu);
                self.failed_steps += 1;
                length *= 0.5;
                if length < self.statics.min_load_step * longest {
                    return Err(stuck);
                }
            }
            last.iter_mut().zip(&self.u).zip(&from).for_each(|((x, u), from)| *x = u - from);
            length = longest.min(2.0 * length);
            if self.tried >= 1.0 {
                // the whole load was reached within the step
                let back = (self.tried - 1.0) / (self.tried - start);
                self.u.iter_mut().zip(&last).for_each(|(u, x)| *u -= back * x);
                self.tried = 1.0;
                self.balance()?;
                self.arrive();
                return Ok(());
            }
            self.arrive();
        }
        let highest = self.curve.iter().map(|point| point.fraction).fold(0.0, f64::max);
        self.tried = 1.0;
        Err(self.stuck(format!(
            "the path of equilibria has not come to the whole load in {} steps, and to {:.2} % of it at most: raise \
             arc_steps, or lower load_steps for longer steps",
            self.statics.arc_steps,
            100.0 * highest
        )))
    }

    /// Takes a step along the tangent of the path, by `advance` in the load, and comes back to the path.
    fn step(&mut self, advance: f64, along: &[f64], normal: &[f64]) -> Result<(), Stuck> {
        self.tried = self.fraction + advance;
        self.u.iter_mut().zip(along).for_each(|(u, x)| *u += advance * x);
        let mut direction = vec![0.0; self.u.len()];
        for _ in 0..MOST_ITERATIONS {
            self.iterations += 1;
            self.evaluate()?;
            self.factorize()?;
            self.load_direction(&mut direction)?;
            self.rest.lacking(self.tried, &self.u, &mut self.d);
            self.rest.solve(&self.at.total, &self.d, &mut self.x, &mut self.mu);
            self.residual = self.rest.residual(&self.at.total, &self.mu, &mut self.work);
            let more = -dot(normal, &self.x) / dot(normal, &direction);
            self.x.iter_mut().zip(&direction).for_each(|(x, along)| *x += more * along);
            let (lacking, length) = (largest(&self.d), largest(&self.x));
            if !(length.is_finite() && more.is_finite()) {
                return Err(self.stuck("the displacements grow without bound".into()));
            }
            let is_met = lacking <= 1e-12 * self.size;
            let rtol = self.statics.rtol;
            let is_round_off = length <= 1e-3 * rtol * self.size && more.abs() <= 1e-3 * rtol;
            if is_met && (self.residual <= rtol * self.at.scale || is_round_off) {
                return Ok(());
            }
            self.u.iter_mut().zip(&self.x).for_each(|(u, x)| *u += x);
            self.tried += more;
        }
        Err(self.stuck(format!(
            "a step along the path has not converged in {MOST_ITERATIONS} iterations"
        )))
    }

    /// Factorizes K at `u`, definite or not.
    fn factorize(&mut self) -> Result<(), Stuck> {
        self.rest.update_tangent(self.tried, &self.u);
        match self.rest.factorize_any() {
            true => Ok(()),
            false => {
                Err(self.stuck("the stiffness matrix is singular: hold more of the body".into()))
            }
        }
    }

    /// Change of the displacements with the load at `u`, where the forces are known, by the last factorization.
    fn load_direction(&mut self, x: &mut [f64]) -> Result<(), Stuck> {
        let ahead = self.tried + STEP;
        self.rest.evaluate(ahead, &self.u, &mut self.trial).map_err(|e| self.stuck(reason(e)))?;
        let change = self.trial.total.iter().zip(&self.at.total);
        self.work.iter_mut().zip(change).for_each(|(q, (ahead, at))| *q = (ahead - at) / STEP);
        let mut demands = vec![0.0; self.d.len()];
        self.rest.lacking(ahead, &self.u, &mut demands);
        self.rest.lacking(self.tried, &self.u, &mut self.d);
        demands.iter_mut().zip(&self.d).for_each(|(ahead, at)| *ahead = (*ahead - at) / STEP);
        let mut mu = vec![0.0; self.mu.len()];
        self.rest.solve(&self.work, &demands, x, &mut mu);
        Ok(())
    }
}

/// Step of the load factor in the difference that gives its direction: loads are linear in it, and paths of constraints
/// smooth.
const STEP: f64 = 1e-4;
