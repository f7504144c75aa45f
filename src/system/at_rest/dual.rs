//! The dual of the saddle-point system of statics: what a force left unbalanced does to a number of the equilibrium.

use super::AtRest;
use crate::vector::largest;

/// Refinements of a dual solution, the factors being those of the symmetric part of K: each takes off a share as large as the part
/// that is not symmetric.
const MOST_REFINEMENTS: usize = 100;

/// Where they end, as a part of the solution: no estimate of an error has more digits.
const ENOUGH: f64 = 1e-9;

impl AtRest {
    /// Solves
    ///
    /// ```text
    /// K^T z - A nu = j,   A^T z = -g
    /// ```
    ///
    /// by the last factorization, which has to be that of K without a shift: a step x of Newton's method with its constraint
    /// forces mu, K x - A mu = f and A^T x = d, has j . x + g . mu = z . f - nu . d. Returns whether it could.
    pub(crate) fn solve_dual(
        &mut self,
        [j, g]: [&[f64]; 2],
        z: &mut [f64],
        nu: &mut [f64],
    ) -> bool {
        z.fill(0.0);
        nu.fill(0.0);
        let (mut more, mut more_nu) = (z.to_vec(), nu.to_vec());
        let mut left = j.to_vec();
        let mut demands: Vec<f64> = g.iter().map(|g| -g).collect();
        for _ in 0..MOST_REFINEMENTS {
            let solver = &mut self.system.newton.solver;
            solver.solve(&self.system.rows, &left, &demands, &mut more, &mut more_nu);
            z.iter_mut().zip(&more).for_each(|(z, more)| *z += more);
            nu.iter_mut().zip(&more_nu).for_each(|(nu, more)| *nu += more);
            demands.fill(0.0);
            left.copy_from_slice(j);
            self.tangent().add_transposed_product(-1.0, z, &mut left);
            let rows = || self.system.rows.iter().zip(&*nu);
            for (row, nu) in rows().filter(|(row, _)| row.nodal().is_none()) {
                row.terms.iter().for_each(|&(dof, c)| left[dof] += c * nu);
            }
            if largest(&more) <= ENOUGH * largest(z) {
                for (row, nu) in self.system.rows.iter().zip(nu) {
                    if let Some((dof, c)) = row.nodal() {
                        *nu = -left[dof] / c;
                    }
                }
                return true;
            }
        }
        false
    }
}
