//! The saddle-point system of statics and its dual, with the full tangent, symmetric or not: the effect
//! of unbalanced forces on the equilibrium, and on a quantity of it.

use super::AtRest;
use crate::base::sparse::BlockMatrix;
use crate::base::vector::largest;

/// Largest number of refinements of a solution with the factors of the symmetric part of K: each multiplies
/// the error by about the relative size of the part that is not symmetric.
const MOST_REFINEMENTS: usize = 100;

/// Size of a refinement relative to the solution at which they end, about the error of the solution.
pub(crate) const DUAL_ERROR: f64 = 1e-9;

impl AtRest {
    /// Solves K x - A mu = f, A^T x = d by the last factorization, which must be that of K without a shift; K
    /// need not be symmetric. This is a step of Newton's method with its constraint forces. Returns whether
    /// it succeeded.
    pub(crate) fn solve_exactly(
        &mut self,
        [f, d]: [&[f64]; 2],
        x: &mut [f64],
        mu: &mut [f64],
    ) -> bool {
        self.refine([f, d], x, mu, BlockMatrix::add_product)
    }

    /// The dual solution z and nu of a quantity with the derivatives j by displacements and g by multipliers, at the displacements `u` under the
    /// whole load, whose tangent is factorized; none if that cannot be inverted.
    pub(crate) fn dual(&mut self, u: &[f64], of: [&[f64]; 2]) -> Option<[Vec<f64>; 2]> {
        self.update_tangent(1.0, u);
        let (mut z, mut nu) = (vec![0.0; u.len()], vec![0.0; self.system.rows.len()]);
        let is_solved = self.factorize_any() && self.solve_dual(of, &mut z, &mut nu);
        is_solved.then_some([z, nu])
    }

    /// Solves the dual K^T z - A nu = j, A^T z = -g likewise: the step above has j . x + g . mu = z . f - nu . d.
    pub(crate) fn solve_dual(
        &mut self,
        [j, g]: [&[f64]; 2],
        z: &mut [f64],
        nu: &mut [f64],
    ) -> bool {
        let demands: Vec<f64> = g.iter().map(|g| -g).collect();
        self.refine([j, &demands], z, nu, BlockMatrix::add_transposed_product)
    }

    /// Solves with K or K^T, depending on `add_product`.
    fn refine(
        &mut self,
        [f, d]: [&[f64]; 2],
        x: &mut [f64],
        mu: &mut [f64],
        add_product: fn(&BlockMatrix, f64, &[f64], &mut [f64]),
    ) -> bool {
        x.fill(0.0);
        mu.fill(0.0);
        let (mut more, mut more_mu) = (x.to_vec(), mu.to_vec());
        let (mut left, mut demands) = (f.to_vec(), d.to_vec());
        for _ in 0..MOST_REFINEMENTS {
            let solver = &mut self.system.newton.solver;
            solver.solve(&self.system.rows, &left, &demands, &mut more, &mut more_mu);
            x.iter_mut().zip(&more).for_each(|(x, more)| *x += more);
            mu.iter_mut().zip(&more_mu).for_each(|(mu, more)| *mu += more);
            demands.fill(0.0);
            left.copy_from_slice(f);
            add_product(self.tangent(), -1.0, x, &mut left);
            for (row, mu) in self.system.rows.iter().zip(&*mu) {
                if row.nodal().is_none() {
                    row.terms.iter().for_each(|&(dof, c)| left[dof] += c * mu);
                }
            }
            if largest(&more) <= DUAL_ERROR * largest(x) {
                for (row, mu) in self.system.rows.iter().zip(mu) {
                    if let Some((dof, c)) = row.nodal() {
                        *mu = -left[dof] / c;
                    }
                }
                return true;
            }
        }
        false
    }
}
