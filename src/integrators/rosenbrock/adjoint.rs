//! The discrete adjoint of a step: derivatives of a function of the end of a step by its start, and by the equations.
//!
//! It is that of the step as computed, stages and all, and not an integration of the adjoint equations. With lambda the derivative of the
//! number by the end, and J = df/dy at the start, each stage has a vector
//!
//! ```text
//! (I - gamma h J)^T z_i = m_i lambda + sum_j (a_ji Y_j + gamma c_ji z_j),   Y_j = gamma h (df/dy at stage j)^T z_j,   j > i
//! ```
//!
//! and the derivative by the start is lambda + sum Y_i + sum gamma h (J'[.] u_i)^T z_i + sum gamma gamma_i h^2 (dJ/dt)^T z_i, the change
//! J'[x] of J along x by central differences. It takes one factorization, transposed (E. Hairer, C. Lubich, G. Wanner, "Geometric
//! Numerical Integration", 2nd ed., section VI.4, has adjoints of one-step methods; D. N. Daescu, G. R. Carmichael, A. Sandu, "Adjoint
//! implementation of Rosenbrock methods applied to variational data assimilation problems", J. Comput. Phys. 165 (2000) 496-510, these).
//!
//! By a parameter p of the equations the derivative is that of sum z_i.(gamma h f + gamma h J u_i + gamma gamma_i h^2 df/dt) with the
//! u_i, z_i and stages held: values of f by other equations, and no factorization.

#[cfg(test)]
mod tests;

use super::solver::Rosenbrock;
use super::tableau::Tableau;
use crate::base::simd::add_multiple;
use crate::integrators::common::OneStep;
use crate::integrators::ode::{Failure, Ode};

/// Equations L y' = g(t, y) with a constant matrix L, which are y' = f(t, y) to an integrator, with the transposes of their linearization.
///
/// Adjoint vectors z are given by weights w of the equations, z = L^T w, so that z.f = w.g: products with f take no solve with L.
pub(crate) trait Transposed: Ode {
    /// Number of weights.
    fn weights(&self) -> usize;

    /// Whether dg/dy never changes.
    fn is_linear(&self) -> bool;

    /// Evaluates g at (t, y).
    fn evaluate_at(&mut self, t: f64, y: &[f64]) -> Result<(), Failure>;

    /// w.g, as last evaluated, which was at `y`.
    fn weigh(&self, y: &[f64], weights: &[f64]) -> f64;

    /// Evaluates dg/dy at (t, y).
    fn linearize_at(&mut self, t: f64, y: &[f64]) -> Result<(), Failure>;

    /// w.(dg/dy) x, as last evaluated.
    fn weigh_along(&mut self, weights: &[f64], x: &[f64]) -> f64;

    /// Adds `factor` times (dg/dy)^T w, as last evaluated.
    fn add_transposed(&self, factor: f64, weights: &[f64], out: &mut [f64]);

    /// Finds the weights with (L - gamma dg/dy)^T w = r, as last set up.
    fn solve_transposed(&mut self, r: &[f64], weights: &mut [f64]);

    /// Writes z = L^T w.
    fn vector_of(&self, weights: &[f64], z: &mut [f64]);

    /// Finds the weights of z.
    fn weights_of(&mut self, z: &[f64], weights: &mut [f64]);
}

/// Adjoint of a step: its stages and their adjoint vectors.
#[derive(Debug)]
pub(crate) struct StepAdjoint {
    tableau: &'static Tableau,
    h: f64,
    /// y at the start, and where f is evaluated in each stage.
    start: Vec<f64>,
    arguments: Vec<Vec<f64>>,
    /// u_i.
    stages: Vec<Vec<f64>>,
    /// The weights of z_i, and z_i.
    weights: Vec<Vec<f64>>,
    vectors: Vec<Vec<f64>>,
    /// The right-hand sides for z_i.
    wanted: Vec<Vec<f64>>,
    /// Y_i; a second state beside the start.
    pulled: Vec<f64>,
    beside: Vec<f64>,
}

/// The change of J along u_i is that over this part of u_i.
const PART: f64 = 1e-3;

/// Derivatives by time are quotients of second order over this part of a step: with these shares of the values after so many of it.
const LATER: f64 = 2e-3;
const LATER_SHARES: [(f64, f64); 3] = [(0.0, -1.5), (1.0, 2.0), (2.0, -0.5)];

impl StepAdjoint {
    /// Room for the steps of an integrator.
    pub(crate) fn new<S: Transposed>(integrator: &Rosenbrock<S>) -> Self {
        let OneStep { march, method } = integrator;
        let (n, weights) = (march.y.len(), march.system.weights());
        let each = |n: usize| vec![vec![0.0; n]; method.tableau.alpha.len()];
        Self {
            tableau: method.tableau,
            h: 0.0,
            start: vec![0.0; n],
            arguments: each(n),
            stages: each(n),
            weights: each(weights),
            vectors: each(n),
            wanted: each(n),
            pulled: vec![0.0; n],
            beside: vec![0.0; n],
        }
    }

    /// The step size times the weights of each stage, which is that of a constant added to g.
    #[cfg(feature = "gradient")]
    pub(crate) fn impulses(&self) -> impl Iterator<Item = (f64, &[f64])> {
        let gamma = self.tableau.gamma * self.h;
        self.weights.iter().map(move |weights| (gamma, &weights[..]))
    }

    /// The sum of which the derivative is that of the number, of other equations, and another start `t` and size `h` of the step. `has_masses` says whether they have the same L; `weights` has space for two.
    pub(crate) fn weigh<S: Transposed>(
        &self,
        other: &mut S,
        (t, h): (f64, f64),
        has_masses: bool,
        [own, of_time]: &mut [Vec<f64>; 2],
    ) -> Result<f64, Failure> {
        let gamma = self.tableau.gamma * h;
        let mut sum = 0.0;
        of_time.clear();
        of_time.resize(other.weights(), 0.0);
        own.resize(other.weights(), 0.0);
        other.linearize_at(t, &self.start)?;
        for (i, argument) in self.arguments.iter().enumerate() {
            let weights = if has_masses {
                &self.weights[i]
            } else {
                other.weights_of(&self.vectors[i], own);
                &*own
            };
            sum += gamma * other.weigh_along(weights, &self.stages[i]);
            other.evaluate_at(t + self.tableau.alpha[i] * h, argument)?;
            sum += gamma * other.weigh(argument, weights);
            let factor = gamma * h * self.tableau.gamma_sums[i];
            of_time.iter_mut().zip(weights).for_each(|(sum, w)| *sum += factor * w);
        }
        let later = LATER * h;
        for (steps, share) in LATER_SHARES {
            other.evaluate_at(t + steps * later, &self.start)?;
            sum += share / later * other.weigh(&self.start, of_time);
        }
        Ok(sum)
    }

    /// Turns `lambda`, the derivative of a number by the end of the last step of the integrator, into that by its start. `other` are its
    /// equations once more, to be linearized at other states.
    pub(crate) fn pull_back<S: Transposed>(
        &mut self,
        integrator: &mut Rosenbrock<S>,
        other: &mut S,
        lambda: &mut [f64],
    ) -> Result<(), Failure> {
        let OneStep { march, method } = integrator;
        let (tableau, h) = (method.tableau, march.t - march.t_old);
        let (gamma, t) = (tableau.gamma * h, march.clock.time(march.t_old));
        let Self { start, arguments, stages, weights, vectors, wanted, pulled, beside, .. } = self;
        let system = &mut march.system;
        self.h = h;
        start.copy_from_slice(&march.y_old);
        for (i, wanted) in wanted.iter_mut().enumerate() {
            stages[i].copy_from_slice(&method.stages[i]);
            arguments[i].copy_from_slice(start);
            for (a, stage) in tableau.a[i].iter().zip(&*stages) {
                add_multiple(*a, stage, &mut arguments[i]);
            }
            wanted.fill(0.0);
            add_multiple(tableau.m[i], lambda, wanted);
        }
        for i in (0..wanted.len()).rev() {
            let (before, rest) = wanted.split_at_mut(i);
            system.solve_transposed(&rest[0], &mut weights[i]);
            system.vector_of(&weights[i], &mut vectors[i]);
            pulled.fill(0.0);
            match i {
                0 => system.add_transposed(gamma, &weights[i], pulled),
                _ => {
                    let at = march.clock.time(march.t_old + tableau.alpha[i] * h);
                    other.linearize_at(at, &arguments[i])?;
                    other.add_transposed(gamma, &weights[i], pulled);
                }
            }
            for (j, wanted) in before.iter_mut().enumerate() {
                add_multiple(tableau.a[i][j], pulled, wanted);
                add_multiple(tableau.gamma * tableau.c[i][j], &vectors[i], wanted);
            }
            add_multiple(1.0, pulled, lambda);
        }
        if Transposed::is_linear(system) {
            return Ok(());
        }
        for (stage, weights) in stages.iter().zip(&*weights) {
            for part in [PART, -PART] {
                beside.copy_from_slice(start);
                add_multiple(part, stage, beside);
                other.linearize_at(t, beside)?;
                other.add_transposed(gamma / (2.0 * part), weights, lambda);
            }
        }
        if method.time_slope.iter().any(|slope| *slope != 0.0) {
            let later = LATER * h;
            for (steps, share) in LATER_SHARES {
                other.linearize_at(t + steps * later, start)?;
                for (weights, of_time) in weights.iter().zip(tableau.gamma_sums) {
                    other.add_transposed(share * gamma * h * of_time / later, weights, lambda);
                }
            }
        }
        Ok(())
    }
}
