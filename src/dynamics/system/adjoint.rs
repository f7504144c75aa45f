//! The transposed linearization of the equations, for the adjoints of steps.
//!
//! With C = -b'' + 2 alpha (A^T v - b') + alpha^2 (A^T u - b) and accelerations a the equations are
//!
//! ```text
//! u' = v,   M a - A lambda = f(t, u, v),   A^T a = -C(t, u, v)
//! ```
//!
//! weighted with y, w and m, where A^T w = 0: (y, w, m) represent the adjoint vector (y, M w + A m). Its product with (u', v') is
//! y.v + w.f - m.C, so that no product solves a system with M. The Newton system transposed is
//!
//! ```text
//! N^T w - A mu = gamma ru + rv,   A^T w = 0,   N = M + gamma D + gamma^2 Kt
//! m = -mu / (1 + alpha gamma)^2,   y = ru - gamma Kt^T w - gamma alpha^2 A m
//! ```

use super::System;
use super::newton_matrix::NewtonMatrix;
use crate::base::simd::add_multiple;
use crate::base::vector::dot;
use crate::dynamics::linear::nodal_multipliers;
use crate::dynamics::state::State;
use crate::integrators::ode::Failure;
use crate::integrators::rosenbrock::Transposed;

impl System {
    /// The reason for which the adjoint of steps is not available, if there is one.
    pub(crate) fn why_not_transposed(&self) -> Option<&'static str> {
        [
            (self.layout.strains > 0, "adjoint gradients do not yet support Maxwell branches"),
            (
                self.layout.amounts > 0,
                "adjoint gradients do not yet support gas, liquids and actuators that lag",
            ),
            (self.matrices.rigid.is_some(), "adjoint gradients do not yet support rigid pieces"),
        ]
        .into_iter()
        .find_map(|(is, why)| is.then_some(why))
    }

    /// Whether M and A are the same as those of `other`.
    pub(crate) fn has_masses_of(&self, other: &Self) -> bool {
        self.matrices.inertia.values == other.matrices.inertia.values
            && self.rows.iter().map(|row| &row.terms).eq(other.rows.iter().map(|row| &row.terms))
    }

    /// The weights of the displacements, of the momenta and of the rows of the constraints.
    fn parts<'w>(&self, weights: &'w [f64]) -> [&'w [f64]; 3] {
        let (motion, of_rows) = weights.split_at(2 * self.dofs());
        let (of_displacements, of_momenta) = motion.split_at(self.dofs());
        [of_displacements, of_momenta, of_rows]
    }

    fn parts_mut<'w>(&self, weights: &'w mut [f64]) -> [&'w mut [f64]; 3] {
        let (motion, of_rows) = weights.split_at_mut(2 * self.dofs());
        let (of_displacements, of_momenta) = motion.split_at_mut(self.dofs());
        [of_displacements, of_momenta, of_rows]
    }

    /// The weights of the rows of the constraints, which are those of a constant added to A^T v'.
    pub(crate) fn of_rows<'w>(&self, weights: &'w [f64]) -> &'w [f64] {
        self.parts(weights)[2]
    }
}

impl Transposed for System {
    fn weights(&self) -> usize {
        2 * self.dofs() + self.rows.len()
    }

    fn is_linear(&self) -> bool {
        System::is_linear(self)
    }

    fn evaluate_at(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        let State { u, v, internal, .. } = self.layout.of(y);
        self.evaluate_forces(t, u, v, internal)?;
        self.evaluate_rows(t, u, v)
    }

    fn weigh(&self, y: &[f64], weights: &[f64]) -> f64 {
        let [of_displacements, of_momenta, of_rows] = self.parts(weights);
        dot(of_displacements, self.layout.of(y).v)
            + dot(of_momenta, &self.at.total)
            + dot(of_rows, &self.at.demands)
    }

    fn linearize_at(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        let State { u, v, .. } = self.layout.of(y);
        self.update_tangents(t, u, v, false);
        Ok(())
    }

    fn weigh_along(&mut self, weights: &[f64], x: &[f64]) -> f64 {
        let State { u: xu, v: xv, .. } = self.layout.of(x);
        let NewtonMatrix { stiffness, damping, right, .. } = &mut self.newton;
        right.fill(0.0);
        stiffness.get().add_product(-1.0, xu, right);
        damping.get().add_product(-1.0, xv, right);
        let [of_displacements, of_momenta, of_rows] = self.parts(weights);
        let along = dot(of_displacements, xv) + dot(of_momenta, &self.newton.right);
        let alpha = self.alpha;
        let rows = self.rows.iter().zip(of_rows);
        rows.fold(along, |along, (row, m)| {
            along - m * (2.0 * alpha * row.apply(xv) + alpha * alpha * row.apply(xu))
        })
    }

    fn add_transposed(&self, factor: f64, weights: &[f64], out: &mut [f64]) {
        let [of_displacements, of_momenta, of_rows] = self.parts(weights);
        let (out, alpha) = (self.layout.of_mut(out), self.alpha);
        let (stiffness, damping) = self.tangents();
        stiffness.add_transposed_product(-factor, of_momenta, out.u);
        if self.newton.is_damped {
            damping.add_transposed_product(-factor, of_momenta, out.v);
        }
        add_multiple(factor, of_displacements, out.v);
        self.add_rows(-factor * alpha * alpha, of_rows, out.u);
        self.add_rows(-2.0 * factor * alpha, of_rows, out.v);
    }

    fn solve_transposed(&mut self, r: &[f64], weights: &mut [f64]) {
        let State { u: ru, v: rv, .. } = self.layout.of(r);
        let (gamma, alpha) = (self.newton.gamma, self.alpha);
        self.newton.right.copy_from_slice(rv);
        add_multiple(gamma, ru, &mut self.newton.right);
        self.newton.demand_nothing();
        self.newton.skew.transpose();
        self.solve_resisted();
        self.newton.skew.transpose();
        let [of_displacements, of_momenta, of_rows] = self.parts_mut(weights);
        let NewtonMatrix { stiffness, damping, is_damped, right, xv, mu, .. } = &mut self.newton;
        of_displacements.fill(0.0);
        stiffness.get().add_transposed_product(gamma, xv, of_displacements);
        // N^T w less its right-hand side: at fixed components the force of their rows
        right.iter_mut().for_each(|right| *right = -*right);
        self.matrices.add_momentum(1.0, xv, right);
        add_multiple(gamma, of_displacements, right);
        if *is_damped {
            damping.get().add_transposed_product(gamma, xv, right);
        }
        nodal_multipliers(&self.rows, mu, |dof| right[dof]);
        of_momenta.copy_from_slice(xv);
        let decay = (1.0 + alpha * gamma).powi(2);
        of_rows.iter_mut().zip(&*mu).for_each(|(m, mu)| *m = -mu / decay);
        of_displacements.iter_mut().zip(ru).for_each(|(y, ru)| *y = ru - *y);
        self.add_rows(-gamma * alpha * alpha, of_rows, of_displacements);
    }

    fn vector_of(&self, weights: &[f64], z: &mut [f64]) {
        let [of_displacements, of_momenta, of_rows] = self.parts(weights);
        z.fill(0.0);
        let z = self.layout.of_mut(z);
        z.u.copy_from_slice(of_displacements);
        self.matrices.add_momentum(1.0, of_momenta, z.v);
        self.add_rows(1.0, of_rows, z.v);
    }

    fn weights_of(&mut self, z: &[f64], weights: &mut [f64]) {
        let State { u, v, .. } = self.layout.of(z);
        let [of_displacements, of_momenta, of_rows] = self.parts_mut(weights);
        of_displacements.copy_from_slice(u);
        self.newton.demands.fill(0.0);
        self.inertia.solve_whole(
            &self.rows,
            v,
            &self.newton.demands,
            of_momenta,
            of_rows,
            |dof, w| self.matrices.momentum_of(dof, w),
        );
        of_rows.iter_mut().for_each(|m| *m = -*m);
    }
}
