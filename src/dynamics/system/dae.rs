//! The differential-algebraic forms. Of index 1: y = (u, v, x, energy dissipated, energy supplied, lambda), where x are strains
//! of Maxwell branches and amounts with the rates q, with the residuals
//!
//! ```text
//! u' - v
//! M v' - f - A lambda
//! x' - q
//! (two energy rates)
//! A^T v' + 2 alpha (A^T v - b') + alpha^2 (A^T u - b) - b''
//! ```
//!
//! Of index 2, stabilized by second multipliers eta (C. W. Gear, G. K. Gupta, B. Leimkuhler, "Automatic
//! integration of Euler-Lagrange equations with constraints", J. Comput. Appl. Math. 12-13 (1985) 77-90):
//! y = (u, v, x, energies, lambda, eta), with
//!
//! ```text
//! M (u' - v) - A eta
//! M v' - f - A lambda
//! x' - q
//! (two energy rates)
//! A^T v - b'
//! A^T u - b
//! ```
//!
//! Strains and amounts are eliminated from Newton's systems as in the ODE form (`newton.rs`): cj x - dq is I - gamma J over gamma.
//!
//! Edges of rigid pieces (`edges.rs`) have multipliers behind those of the rows, which press with x at their nodes, and in the
//! form of index 2 second ones behind eta. Their residuals are x.x'' + x'.x' + 2 alpha x.x' + alpha^2 g, or x.x' and g. The
//! forces on dependent nodes are moved to their frames, W^T (M v' - f), and both rows of these nodes
//! become their positions and velocities, u - W u and v - W v, so that they do not drift.
//!
//! Newton's systems of index 2 decouple except for one part: with xu = s + gamma xv,
//!
//! ```text
//! G s = r4 - gamma r3 + gamma x'.xu,   (G + gamma x') xv = r3 - x'.s
//! ```
//!
//! gamma x'.xu, known last, is omitted: iterations converge by the rotation of a piece in a time gamma.

use super::System;
use crate::dynamics::state::State;
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
}

impl DaeForm {
    pub(crate) fn new(system: System, index: Index) -> Self {
        Self { mismatch: vec![0.0; system.dofs()], system, index }
    }

    /// Number of multipliers of rows and edges.
    fn constraints(&self) -> usize {
        self.system.rows.len() + self.system.edges.list.len()
    }

    /// Number of unknowns.
    pub(crate) fn size(&self) -> usize {
        let multipliers = match self.index {
            Index::One => self.constraints(),
            Index::Two => 2 * self.constraints(),
        };
        self.system.layout.unknowns() + multipliers
    }

    /// Absolute tolerances of the multipliers, those of `force` (N) and, in the form of index 2, of `momentum` (N s): what
    /// edges have is over their lengths.
    pub(crate) fn tolerances(&self, [force, momentum]: [f64; 2]) -> Vec<f64> {
        let System { rows, edges, .. } = &self.system;
        let of = |least: f64| {
            let of_edges =
                edges.list.iter().map(move |edge| least / (2.0 * edge.half_square()).sqrt());
            std::iter::repeat_n(least, rows.len()).chain(of_edges)
        };
        match self.index {
            Index::One => of(force).collect(),
            Index::Two => of(force).chain(of(momentum)).collect(),
        }
    }

    /// Writes y and y' with which the residual vanishes, from the `state` of the phase at time `t` (s).
    pub(crate) fn consistent(
        &mut self,
        t: f64,
        state: &[f64],
        [y, yp]: [&mut [f64]; 2],
    ) -> Result<(), Failure> {
        let layout = self.system.layout;
        let State { u, v, internal, .. } = layout.of(state);
        self.system.evaluate(t, u, v, internal)?;
        let (dissipated, supplied) = self.system.powers(v, &self.system.at.multipliers);
        let parts = [state, &self.system.at.multipliers, &self.system.edges.multipliers];
        y.fill(0.0);
        y.iter_mut().zip(parts.into_iter().flatten()).for_each(|(y, part)| *y = *part);
        yp.fill(0.0);
        let rates = layout.of_mut(yp);
        rates.u.copy_from_slice(v);
        rates.v.copy_from_slice(&self.system.at.acceleration);
        self.system.copy_internal_rates(rates.internal);
        (*rates.dissipated, *rates.supplied) = (dissipated, supplied);
        Ok(())
    }

    /// Takes the state for that in which rigid pieces enter the Newton matrix.
    fn linearize_edges(&mut self, y: &[f64], yp: &[f64]) {
        let System { edges, linear_edges, rows, alpha, layout, .. } = &mut self.system;
        let State { u, v, multipliers, .. } = layout.of(y);
        edges.move_to(*alpha, u, v);
        edges.accelerate(layout.of(yp).v);
        let of_edges = &multipliers[rows.len()..][..edges.list.len()];
        edges.multipliers.copy_from_slice(of_edges);
        linear_edges.copy_from(edges);
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
        let layout = self.system.layout;
        let (State { u, v, internal, multipliers, .. }, rates) = (layout.of(y), layout.of(yp));
        let (multipliers, slips) = multipliers.split_at(self.constraints());
        let of_rows = &multipliers[..self.system.rows.len()];
        self.system.evaluate_forces(t, u, v, internal)?;
        self.system.evaluate_rows(t, u, v)?;
        self.system.edges.accelerate(rates.v);
        let (dissipated, supplied) = self.system.powers(v, of_rows);
        let residual = layout.of_mut(residual);
        self.system.copy_internal_rates(residual.internal);
        residual.internal.iter_mut().zip(rates.internal).for_each(|(r, rate)| *r = rate - *r);
        let System { matrices, rows, edges, at, .. } = &mut self.system;
        at.multipliers.copy_from_slice(of_rows);

        let subtract_pull = |multipliers: &[f64], momentum: &mut [f64]| {
            let (of_rows, of_edges) = multipliers.split_at(rows.len());
            for (row, multiplier) in rows.iter().zip(of_rows) {
                row.terms.iter().for_each(|&(dof, c)| momentum[dof] -= c * multiplier);
            }
            edges.subtract_pull(of_edges, momentum);
        };
        let (kinematic, dynamic) = (residual.u, residual.v);
        for i in 0..layout.dofs {
            kinematic[i] = rates.u[i] - v[i];
            dynamic[i] = -at.total[i];
        }
        matrices.add_momentum(1.0, rates.v, dynamic);
        subtract_pull(multipliers, dynamic);
        if self.index == Index::Two {
            self.mismatch.copy_from_slice(kinematic);
            kinematic.fill(0.0);
            matrices.add_momentum(1.0, &self.mismatch, kinematic);
            subtract_pull(slips, kinematic);
        }
        if let Some(rigid) = &matrices.rigid {
            if self.index == Index::Two {
                rigid.gather(kinematic);
            }
            rigid.gather(dynamic);
            rigid.replace_by_strays(u, kinematic);
            rigid.replace_by_strays(v, dynamic);
        }
        *residual.dissipated = rates.dissipated - dissipated;
        *residual.supplied = rates.supplied - supplied;
        let (of_rates, of_positions) = residual.multipliers.split_at_mut(multipliers.len());
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
        match self.index {
            Index::One => {
                let of_edges = of_rates[rows.len()..].iter_mut();
                of_edges.zip(edges.imbalances()).for_each(|(residual, off)| *residual = off);
            }
            Index::Two => {
                for (k, [off, rate]) in (rows.len()..).zip(edges.remainders(u, v)) {
                    (of_positions[k], of_rates[k]) = (off, rate);
                }
            }
        }
        Ok(())
    }

    fn newton_setup(&mut self, t: f64, cj: f64, y: &[f64], yp: &[f64]) -> Result<(), Failure> {
        self.linearize_edges(y, yp);
        self.system.linearize(t, y, 1.0 / cj, false).map(|_| ())
    }

    fn newton_solve(&mut self, r: &mut [f64]) -> Result<(), Failure> {
        let r = self.system.layout.of_mut(r);
        let gamma = self.system.gamma();
        r.internal.iter_mut().for_each(|r| *r *= gamma);
        let (r3, r4) = r.multipliers.split_at_mut(self.constraints());
        match self.index {
            Index::One => self.system.solve_newton_index_one(r.u, r.v, r.internal, r3),
            Index::Two => self.system.solve_newton_index_two(r.u, r.v, r.internal, [r3, r4]),
        }
        let [dissipated, supplied] = self.system.solve_internal(r.u, r.internal);
        *r.dissipated = gamma * (*r.dissipated + dissipated);
        *r.supplied = gamma * (*r.supplied + supplied);
        Ok(())
    }
}
