//! The differential-algebraic forms. Of index 1: y = (u, v, energy dissipated, energy supplied, lambda),
//! with the residuals
//!
//! ```text
//! u' - v
//! M v' - f - A lambda
//! (two energy rates)
//! A^T v' + 2 alpha (A^T v - b') + alpha^2 (A^T u - b) - b''
//! ```
//!
//! Of index 2, stabilized by second multipliers eta (C. W. Gear, G. K. Gupta, B. Leimkuhler, "Automatic
//! integration of Euler-Lagrange equations with constraints", J. Comput. Appl. Math. 12-13 (1985) 77-90):
//! y = (u, v, energies, lambda, eta), with
//!
//! ```text
//! M (u' - v) - A eta
//! M v' - f - A lambda
//! (two energy rates)
//! A^T v - b'
//! A^T u - b
//! ```
//!
//! In both, amounts of gas that flows come before the multipliers, with the residuals m' - q.

use super::System;
use crate::dynamics::state::{self, State, StateMut};
use crate::integrators::ode::{Dae, Failure};
use crate::scene::constraint::Prescribed;

/// The form in which the constraints enter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Index {
    /// Stabilized accelerations.
    One,
    /// Velocities and positions.
    Two,
}

/// The equations of a phase with the multipliers as unknowns.
pub(crate) struct DaeForm {
    pub(crate) system: System,
    index: Index,
    /// u' - v
    mismatch: Vec<f64>,
    /// For each degree of freedom, the constraint rows it is in and its coefficients there.
    constraints_of: Vec<Vec<(usize, f64)>>,
}

impl DaeForm {
    pub(crate) fn new(system: System, index: Index) -> Self {
        let mut constraints_of = vec![Vec::new(); system.dofs()];
        for (k, row) in system.rows.iter().enumerate() {
            row.terms
                .iter()
                .for_each(|&(dof, coefficient)| constraints_of[dof].push((k, coefficient)));
        }
        Self { mismatch: vec![0.0; system.dofs()], system, index, constraints_of }
    }

    /// Number of unknowns.
    pub(crate) fn size(&self) -> usize {
        let multipliers = match self.index {
            Index::One => self.system.rows.len(),
            Index::Two => 2 * self.system.rows.len(),
        };
        self.system.unknowns() + multipliers
    }

    /// y and y' with which the residual vanishes, from (u, v) and the energies at the beginning of `state`.
    pub(crate) fn consistent(
        &mut self,
        t: f64,
        state: &[f64],
    ) -> Result<(Vec<f64>, Vec<f64>), Failure> {
        let State { u, v, others, .. } = State::of(state, self.system.dofs());
        self.system.evaluate(t, u, v, others)?;
        let (dissipated, supplied) = self.system.powers(v, &self.system.at.multipliers);
        let mut y = [state, &self.system.at.multipliers].concat();
        y.resize(self.size(), 0.0);
        let flowing = &self.system.at.flowing[0];
        let mut yp = [v, &self.system.at.acceleration, &[dissipated, supplied], flowing].concat();
        yp.resize(self.size(), 0.0);
        Ok((y, yp))
    }

    /// Visits all entries of dF/dy + cj dF/dy' of the form of index 1 as (row, column, value), column by column, rows
    /// ascending; the same entries at every call.
    pub(crate) fn visit_jacobian(&self, cj: f64, mut visit: impl FnMut(usize, usize, f64)) {
        let System { matrices, rows, alpha, .. } = &self.system;
        let (n, d) = (self.system.dofs(), matrices.dimension);
        let (stiffness, damping) = self.system.tangents();
        let (inertia, pattern) = (&matrices.inertia, matrices.pattern());
        let lambda = state::length(n);
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

impl Dae for DaeForm {
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure> {
        let n = self.system.dofs();
        let (State { u, v, others, .. }, rates) = (State::of(y, n), State::of(yp, n));
        let (amounts, multipliers) = others.split_at(self.system.internal());
        let (multipliers, eta) = multipliers.split_at(self.system.rows.len());
        self.system.evaluate_forces(t, u, v, amounts)?;
        self.system.evaluate_rows(t, u, v)?;
        let (dissipated, supplied) = self.system.powers(v, multipliers);
        let System { matrices, rows, at, .. } = &mut self.system;
        at.multipliers.copy_from_slice(multipliers);

        let subtract_pull = |multipliers: &[f64], momentum: &mut [f64]| {
            for (row, multiplier) in rows.iter().zip(multipliers) {
                row.terms.iter().for_each(|&(dof, c)| momentum[dof] -= c * multiplier);
            }
        };
        let residual = StateMut::of(residual, n);
        let (kinematic, dynamic) = (residual.u, residual.v);
        for i in 0..n {
            kinematic[i] = rates.u[i] - v[i];
            dynamic[i] = -at.total[i];
        }
        matrices.inertia.add_product(matrices.dimension, 1.0, rates.v, dynamic);
        subtract_pull(multipliers, dynamic);
        if self.index == Index::Two {
            self.mismatch.copy_from_slice(kinematic);
            kinematic.fill(0.0);
            matrices.inertia.add_product(matrices.dimension, 1.0, &self.mismatch, kinematic);
            subtract_pull(eta, kinematic);
        }
        *residual.dissipated = rates.dissipated - dissipated;
        *residual.supplied = rates.supplied - supplied;
        let (of_amounts, of_rows) = residual.others.split_at_mut(amounts.len());
        for ((residual, rate), flow) in of_amounts.iter_mut().zip(rates.others).zip(&at.flowing[0])
        {
            *residual = rate - flow;
        }
        let (of_rates, of_positions) = of_rows.split_at_mut(rows.len());
        for (k, row) in rows.iter().enumerate() {
            match self.index {
                Index::One => of_rates[k] = row.apply(rates.v) - at.demands[k],
                Index::Two => {
                    let Prescribed { displacement, velocity, .. } = row.prescribed(t);
                    of_rates[k] = at.rates[k] - velocity;
                    of_positions[k] = row.apply(u) - displacement;
                }
            }
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
        let State { u, v, .. } = State::of(y, self.system.dofs());
        self.system.update_tangents(t, u, v, false);
        let mut values = values.iter_mut();
        self.visit_jacobian(cj, |_, _, value| {
            if let Some(slot) = values.next() {
                *slot = value;
            }
        });
        Ok(())
    }

    fn newton_setup(&mut self, t: f64, cj: f64, y: &[f64], _yp: &[f64]) -> Result<(), Failure> {
        let State { u, v, others, .. } = State::of(y, self.system.dofs());
        self.system.update_tangents(t, u, v, false);
        self.system.add_flow_tangents(t, u, &others[..self.system.internal()]);
        self.system.factorize_newton(1.0 / cj)
    }

    fn newton_solve(&mut self, r: &mut [f64]) -> Result<(), Failure> {
        let r = StateMut::of(r, self.system.dofs());
        let gamma = self.system.gamma();
        let (amounts, of_rows) = r.others.split_at_mut(self.system.internal());
        amounts.iter_mut().for_each(|r| *r *= gamma);
        let (r3, r4) = of_rows.split_at_mut(self.system.rows.len());
        match self.index {
            Index::One => self.system.solve_newton_index_one(r.u, r.v, amounts, r3),
            Index::Two => self.system.solve_newton_index_two(r.u, r.v, amounts, [r3, r4]),
        }
        let (dissipated, supplied) = self.system.power_changes();
        let brought = self.system.solve_amounts(r.u, amounts);
        *r.dissipated = gamma * (*r.dissipated + dissipated);
        *r.supplied = gamma * (*r.supplied + supplied + brought);
        Ok(())
    }
}
