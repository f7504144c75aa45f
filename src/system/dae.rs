//! The index-1 form: y = (u, v, energy dissipated, energy supplied, lambda), with the residuals
//!
//! ```text
//! u' - v
//! M v' - f - A lambda
//! (two energy rates)
//! A^T v' + 2 alpha (A^T v - b') + alpha^2 (A^T u - b) - b''
//! ```

use super::System;
use super::ode::ENERGIES;
use crate::ode::{Dae, Failure};

/// The equations of a phase with the multipliers as unknowns.
pub(crate) struct IndexOne {
    pub(crate) system: System,
    /// For each degree of freedom, the constraint rows it is in and its coefficients there.
    constraints_of: Vec<Vec<(usize, f64)>>,
}

impl IndexOne {
    pub(crate) fn new(system: System) -> Self {
        let mut constraints_of = vec![Vec::new(); system.dofs()];
        for (k, row) in system.rows.iter().enumerate() {
            row.terms
                .iter()
                .for_each(|&(dof, coefficient)| constraints_of[dof].push((k, coefficient)));
        }
        Self { system, constraints_of }
    }

    /// Number of unknowns.
    pub(crate) fn size(&self) -> usize {
        2 * self.system.dofs() + ENERGIES + self.system.rows.len()
    }

    /// y and y' with which the residual vanishes, from (u, v) and the energies in the front of
    /// `state`.
    pub(crate) fn consistent(
        &mut self,
        t: f64,
        state: &[f64],
    ) -> Result<(Vec<f64>, Vec<f64>), Failure> {
        let n = self.system.dofs();
        let (u, v) = (&state[..n], &state[n..2 * n]);
        self.system.evaluate(t, u, v)?;
        let (dissipated, supplied) = self.system.powers(v, &self.system.at.multipliers);
        let y = [state, &self.system.at.multipliers].concat();
        let mut yp = [v, &self.system.at.acceleration, &[dissipated, supplied]].concat();
        yp.resize(self.size(), 0.0);
        Ok((y, yp))
    }

    /// Visits all entries of dF/dy + cj dF/dy' as (row, column, value), column by column, rows
    /// ascending; the same entries at every call.
    pub(crate) fn visit_jacobian(&self, cj: f64, mut visit: impl FnMut(usize, usize, f64)) {
        let System { model, rows, alpha, .. } = &self.system;
        let (n, d) = (self.system.dofs(), model.dimension);
        let (stiffness, damping) = self.system.tangents();
        let (inertia, pattern) = (&model.inertia, model.pattern());
        let lambda = 2 * n + ENERGIES;
        // entry (column, row) of the pattern; the one that is wanted is (row, column)
        let block = |matrix: &[f64], entry: usize, row_axis: usize, column_axis: usize| {
            matrix[(pattern.transposed(entry) * d + row_axis) * d + column_axis]
        };
        for dof in 0..n {
            visit(dof, dof, cj);
            for (entry, node) in pattern.row(dof / d) {
                for axis in 0..d {
                    let kt = block(&stiffness.values, entry, axis, dof % d);
                    visit(n + node * d + axis, dof, kt);
                }
            }
            let constraints = self.constraints_of[dof].iter();
            constraints.for_each(|(k, c)| visit(lambda + k, dof, alpha * alpha * c));
        }
        for dof in 0..n {
            visit(dof, n + dof, -1.0);
            for (entry, node) in pattern.row(dof / d) {
                for axis in 0..d {
                    let mass = if axis == dof % d { cj * inertia.values[entry] } else { 0.0 };
                    let damped = block(&damping.values, entry, axis, dof % d);
                    visit(n + node * d + axis, n + dof, mass + damped);
                }
            }
            let constraints = self.constraints_of[dof].iter();
            constraints.for_each(|(k, c)| visit(lambda + k, n + dof, (cj + 2.0 * alpha) * c));
        }
        (2 * n..lambda).for_each(|energy| visit(energy, energy, cj));
        for (k, row) in rows.iter().enumerate() {
            row.terms.iter().for_each(|&(dof, c)| visit(n + dof, lambda + k, -c));
            visit(lambda + k, lambda + k, 0.0);
        }
    }
}

impl Dae for IndexOne {
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure> {
        let n = self.system.dofs();
        let (u, v, multipliers) = (&y[..n], &y[n..2 * n], &y[2 * n + ENERGIES..]);
        let (up, vp) = (&yp[..n], &yp[n..2 * n]);
        self.system.evaluate_forces(t, u, v)?;
        self.system.evaluate_rows(t, u, v)?;
        let (dissipated, supplied) = self.system.powers(v, multipliers);
        let System { model, rows, at, .. } = &mut self.system;
        at.multipliers.copy_from_slice(multipliers);

        for i in 0..n {
            residual[i] = up[i] - v[i];
            residual[n + i] = -at.total[i];
        }
        let momentum = &mut residual[n..2 * n];
        model.inertia.add_product(model.dimension, 1.0, vp, momentum);
        for (row, multiplier) in rows.iter().zip(multipliers) {
            row.terms.iter().for_each(|&(dof, c)| momentum[dof] -= c * multiplier);
        }
        residual[2 * n] = yp[2 * n] - dissipated;
        residual[2 * n + 1] = yp[2 * n + 1] - supplied;
        for ((residual, row), demand) in
            residual[2 * n + ENERGIES..].iter_mut().zip(rows).zip(&at.demands)
        {
            *residual = row.apply(vp) - demand;
        }
        Ok(())
    }

    fn sparse_jacobian(
        &mut self,
        t: f64,
        cj: f64,
        y: &[f64],
        _yp: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        let n = self.system.dofs();
        self.system.update_tangents(t, &y[..n], &y[n..2 * n], false);
        let mut values = values.iter_mut();
        self.visit_jacobian(cj, |_, _, value| {
            if let Some(slot) = values.next() {
                *slot = value;
            }
        });
        Ok(())
    }

    fn newton_setup(&mut self, t: f64, cj: f64, y: &[f64], _yp: &[f64]) -> Result<(), Failure> {
        let n = self.system.dofs();
        self.system.update_tangents(t, &y[..n], &y[n..2 * n], false);
        self.system.factorize_newton(1.0 / cj)
    }

    fn newton_solve(&mut self, r: &mut [f64]) -> Result<(), Failure> {
        let n = self.system.dofs();
        let (motion, rest) = r.split_at_mut(2 * n);
        let (energies, r3) = rest.split_at_mut(ENERGIES);
        let (r1, r2) = motion.split_at_mut(n);
        self.system.solve_newton_dae(r1, r2, r3);
        let (dissipated, supplied) = self.system.power_changes();
        let gamma = self.system.gamma();
        energies[0] = gamma * (energies[0] + dissipated);
        energies[1] = gamma * (energies[1] + supplied);
        Ok(())
    }
}
