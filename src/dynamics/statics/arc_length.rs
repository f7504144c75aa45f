//! The path of equilibria by arc length: Riks' method (Int. J. Solids Struct. 15, 1979) in the form that Crisfield
//! (Comput. Struct. 13, 1981) calls linearized.
//!
//! A step goes along the tangent of the path, x_q with K x_q - A mu = df/dlambda, A^T x_q = db/dlambda, until
//! its norm, that of M, is the length of the step. Newton's method returns to the path within the plane
//! normal to the tangent, with the load factor lambda as one more unknown:
//!
//! ```text
//! x = x_r + dlambda x_q,   dlambda = -(n . x_r)/(n . x_q),   n = M x_q at the start of the step
//! ```
//!
//! where x_r is the Newton step at constant load. Both come from the factors of K, by LU where K is
//! indefinite. The path is followed in the same sense as before (n . last step > 0), also at limit points.
//!
//! Other branches intersect the plane normal to the tangent as well. A step that ends far from the tangent,
//! or where the path has another direction, is repeated with half the length.

use super::newton::{Search, Stuck, reason};
use crate::base::vector::{dot, largest};

/// Newton iterations of one step.
const MOST_ITERATIONS: usize = 12;

/// Largest ratio of the length of a step after its return to the path to that along the tangent: 25 degrees off the
/// tangent.
const LONGER: f64 = 1.1;

/// Up to here the path is straight enough for the next step to be longer.
const HARDLY_LONGER: f64 = 1.02;

/// Least cosine of the angle between a step and the tangent at its end.
const ALIKE: f64 = 0.5;

/// The tangent of the path.
struct Tangent {
    /// x_q
    along: Vec<f64>,
    /// n = M x_q
    normal: Vec<f64>,
    /// Change of the load factor along it per length of x in the norm of M: below 0 where the load falls.
    rate: f64,
}

impl Search<'_> {
    /// Follows the path of equilibria from no load to the whole load.
    pub(super) fn trace(&mut self) -> Result<(), Stuck> {
        self.tried = 0.0;
        self.balance(self.statics.max_iterations)?;
        self.factorize()?;
        let mut along = vec![0.0; self.u.len()];
        self.load_direction(&mut along)?;
        let mut tangent = self.tangent(along)?;
        let longest = 1.0 / (tangent.rate * self.statics.load_steps as f64);
        let mut length = longest;
        for _ in 0..self.statics.arc_steps {
            let (from, mu) = (self.u.clone(), self.mu.clone());
            let (along, longer) = loop {
                match self.advance(&tangent, length, &from) {
                    Ok(step) => break step,
                    Err(stuck) => {
                        self.u.copy_from_slice(&from);
                        self.mu.copy_from_slice(&mu);
                        self.failed_steps += 1;
                        length *= 0.5;
                        if length < self.statics.min_load_step * longest {
                            return Err(stuck);
                        }
                    }
                }
            };
            self.arrive();
            let Some(next) = along else { return Ok(()) };
            tangent = next;
            if longer <= HARDLY_LONGER {
                length = longest.min(2.0 * length);
            }
        }
        let fractions = || self.curve.iter().map(|point| point.fraction);
        let [lowest, highest] = [fractions().fold(0.0, f64::min), fractions().fold(0.0, f64::max)];
        let help = match lowest < -1.0 {
            true => {
                "it leads far below no load: if it should not, raise load_steps, for shorter steps do not leave it for \
                 another branch"
            }
            false => "raise arc_steps, or lower load_steps for longer steps",
        };
        self.tried = 1.0;
        Err(self.stuck(format!(
            "the path of equilibria has not come to the whole load in {} steps, and to {:.2} % of it at most: {help}",
            self.statics.arc_steps,
            100.0 * highest
        )))
    }

    /// Takes a step of `length` along the path, `from` the last displacements on it. Returns the tangent at
    /// its end, none where the whole load has been reached, and how much longer the step has become.
    fn advance(
        &mut self,
        tangent: &Tangent,
        length: f64,
        from: &[f64],
    ) -> Result<(Option<Tangent>, f64), Stuck> {
        let along = self.step(tangent.rate * length, &tangent.along, &tangent.normal)?;
        let mut longer = self.way(from) / length;
        let is_whole = longer <= LONGER && self.tried >= 1.0;
        if is_whole {
            // the whole load was reached within the step
            let part = (1.0 - self.fraction) / (self.tried - self.fraction);
            self.u.iter_mut().zip(from).for_each(|(u, from)| *u = from + part * (*u - from));
            self.tried = 1.0;
            self.balance(self.statics.max_iterations)?;
            longer = self.way(from) / length;
        }
        if longer > LONGER {
            return Err(self.stuck(
                "the path of equilibria is lost: steps along it end on another branch, however short; raise load_steps"
                    .into(),
            ));
        }
        if is_whole {
            return Ok((None, longer));
        }
        let mut next = self.tangent(along)?;
        self.x.iter_mut().zip(&self.u).zip(from).for_each(|((x, u), from)| *x = u - from);
        let cosine = next.rate * dot(&next.normal, &self.x) / (longer * length);
        if cosine.abs() < ALIKE {
            return Err(self.stuck(
                "the path of equilibria turns sharply, or branches, within the shortest step: lower min_load_step".into(),
            ));
        }
        next.rate *= cosine.signum();
        Ok((Some(next), longer))
    }

    /// Distance of the body `from` other displacements, in the norm of M.
    fn way(&mut self, from: &[f64]) -> f64 {
        self.x.iter_mut().zip(&self.u).zip(from).for_each(|((x, u), from)| *x = u - from);
        self.rest.weigh(&self.x, &mut self.work);
        dot(&self.x, &self.work).sqrt()
    }

    /// The tangent along x_q, in the direction of rising load.
    fn tangent(&self, along: Vec<f64>) -> Result<Tangent, Stuck> {
        let mut normal = vec![0.0; along.len()];
        self.rest.weigh(&along, &mut normal);
        let speed = dot(&along, &normal).sqrt();
        if !(speed > 0.0 && speed.is_finite()) {
            return Err(self.stuck("the load moves nothing, so there is no path to follow".into()));
        }
        Ok(Tangent { along, normal, rate: 1.0 / speed })
    }

    /// Takes a step along the tangent of the path, by `advance` in the load, and iterates back to the path.
    /// Returns x_q there.
    fn step(&mut self, advance: f64, along: &[f64], normal: &[f64]) -> Result<Vec<f64>, Stuck> {
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
                return Ok(direction);
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

/// Step of the load factor in the finite difference for the direction of the load: loads are linear in it,
/// and paths of constraints smooth.
const STEP: f64 = 1e-4;
