//! The backward run by products with transposed matrices, in place of their entries.

use std::mem;

use super::{
    gmres,
    products::Products,
    system::{AdjointDae, uneven},
};
use crate::base::vector::dot;
use crate::integrators::{
    common::{Error, check_finite},
    ode::{Dae, Failure, Functional, call},
    sundials::{
        adjoint::{
            backward::Point,
            equations::{Equations, refused},
            slopes::{Names, SlopesCheck},
        },
        ilu::no_pivot,
    },
};

/// The part of the direction by which y' is moved to compare products.
const PART: f64 = 0.07;

impl<S: Dae, F: Functional> AdjointDae<S, F> {
    /// Writes `factors[0]` (dF/dy)^T v + `factors[1]` (dF/dy')^T v.
    pub(super) fn transposed_times(
        &mut self,
        (t, y, yp): Point<'_>,
        factors: [f64; 2],
        v: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        let Self { equations, moved, .. } = self;
        for (moved, factor) in moved.iter_mut().zip(factors) {
            moved.iter_mut().zip(v).for_each(|(moved, v)| *moved = factor * v);
        }
        let [lambda, mu] = moved;
        call::adjoint_residual(&mut equations.system, t, y, yp, lambda, mu, out)
    }

    /// Finds the algebraic equations at the start, which do not change with y', and refuses derivatives of algebraic
    /// unknowns.
    pub(super) fn start_products(&mut self, at: Point<'_>) -> Result<(), Error> {
        // F is linear in y', so that differences over large steps contain nothing but dF/dy'
        const LARGE: f64 = 1024.0 * 1024.0;
        let (t, y, yp) = at;
        let size = |j: usize| self.equations.size(j, y[j]).max(yp[j].abs());
        let direction: Vec<f64> = (0..y.len()).map(|j| LARGE * uneven(j) * size(j)).collect();
        let failed = |failure| refused("IDA", t, failure);
        self.differ_along(at, &direction, 1.0).map_err(failed)?;
        check_finite("dF/dy'", &self.residuals[0])?;
        let changes = self.algebraic.iter_mut().zip(&self.residuals[0]);
        changes.for_each(|(algebraic, change)| *algebraic = *change == 0.0);
        if let Some(products) = &mut self.products {
            products.product.copy_from_slice(&self.residuals[0]);
            (products.direction, products.checked) = (direction, None);
            products.start = (t, y.to_vec(), yp.to_vec());
        }
        let (weights, mut columns): (Vec<f64>, _) =
            ((0..y.len()).map(uneven).collect(), vec![0.0; y.len()]);
        self.transposed_times(at, [0.0, 1.0], &weights, &mut columns).map_err(failed)?;
        let wrong = self.differential.iter().zip(&columns).position(|(d, c)| !d && *c != 0.0);
        if let Some(j) = wrong {
            let help = "its derivative occurs in the equations";
            return Err(Error::input("differential", format!("false of unknown {j}"), help));
        }
        Ok(())
    }

    /// Half the change of F between both ends of a `part` of this direction of y', for which the whole would have 1.
    fn differ_along(
        &mut self,
        (t, y, yp): Point<'_>,
        direction: &[f64],
        part: f64,
    ) -> Result<(), Failure> {
        for (j, d) in direction.iter().enumerate() {
            (self.moved[0][j], self.moved[1][j]) = (yp[j] + part * d, yp[j] - part * d);
        }
        let [ahead, behind] = &mut self.residuals;
        call::residual(&mut self.equations.system, t, y, &self.moved[0], ahead)?;
        call::residual(&mut self.equations.system, t, y, &self.moved[1], behind)?;
        let pairs = ahead.iter_mut().zip(behind.iter());
        pairs.for_each(|(ahead, behind)| *ahead = (*ahead - behind) / (2.0 * part));
        Ok(())
    }

    /// Checks that dF/dy' is that of the start, by its product with a direction.
    pub(super) fn check_products(&mut self, at: Point<'_>) -> Result<(), Failure> {
        let Some(mut products) = self.products.take() else { return Ok(()) };
        let is_due = products.checked != Some(at.0);
        let outcome = if is_due { self.compare_products(at, &products) } else { Ok(()) };
        products.checked = outcome.is_ok().then_some(at.0);
        self.products = Some(products);
        outcome
    }

    /// Refuses products with `lambda` that differences of lambda^T F refute, now and then.
    pub(super) fn check_supplied(&mut self, at: Point<'_>, lambda: &[f64]) -> Result<(), Failure> {
        if !self.supplied_rhs.as_mut().is_some_and(SlopesCheck::is_due) {
            return Ok(());
        }
        let [mut by_state, mut by_slope] = mem::take(&mut self.residuals);
        let mut check = || {
            self.transposed_times(at, [1.0, 0.0], lambda, &mut by_state)?;
            self.transposed_times(at, [0.0, 1.0], lambda, &mut by_slope)?;
            let Self { supplied_rhs: Some(check), equations, .. } = &mut *self else {
                return Ok(());
            };
            let ((t, y, yp), Equations { system, scratch, .. }) = (at, equations);
            check.check(
                Names::of_products("adjoint_residual"),
                [y, yp],
                [&by_state, &by_slope],
                |y, yp| {
                    call::residual(system, t, y, yp, scratch)?;
                    Ok(dot(lambda, scratch))
                },
            )
        };
        let outcome = check();
        self.residuals = [by_state, by_slope];
        outcome
    }

    fn compare_products(&mut self, at: Point<'_>, products: &Products) -> Result<(), Failure> {
        self.differ_along(at, &products.direction, PART)?;
        let [found, _] = &self.residuals;
        if found.iter().any(|x| !x.is_finite()) {
            let message = "F is not finite for large y': it has to be linear in y'";
            return Err(Failure::Recoverable(message.into()));
        }
        let mut pairs = found.iter().zip(&products.product);
        match pairs.position(|(found, known)| (found - known).abs() > 1e-6 * known.abs()) {
            Some(i) => Err(Self::changed(i)),
            None => Ok(()),
        }
    }

    /// Writes (dF/dy')^T lambda at the start.
    pub(super) fn mass_times(&mut self, lambda: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        let Some(products) = self.products.take() else {
            out.fill(0.0);
            self.mass.add_transposed_times(1.0, lambda, out);
            return Ok(());
        };
        let (t, y, yp) = &products.start;
        let outcome = self.transposed_times((*t, y, yp), [0.0, 1.0], lambda, out);
        self.products = Some(products);
        outcome
    }

    /// Factorizes cj (dF/dy')^T - (dF/dy)^T incompletely.
    pub(super) fn backward_setup(&mut self, at: Point<'_>, cj: f64) -> Result<(), Failure> {
        self.factorize(|system, values| system.backward_jacobian(at, cj, values))
    }

    /// Replaces `z` by the solution for it, by those factors.
    pub(super) fn backward_solve(&self, z: &mut [f64]) {
        let ilu = self.products.as_ref().and_then(|products| products.ilu.as_ref());
        ilu.into_iter().for_each(|ilu| ilu.solve(z));
    }

    fn factorize(
        &mut self,
        fill: impl FnOnce(&mut Self, &mut [f64]) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        // Taken out, as its values are written by all of the system.
        let ilu = self.products.as_mut().and_then(|products| products.ilu.take());
        let Some(mut ilu) = ilu else { return Ok(()) };
        let mut outcome = Ok(());
        ilu.update_jacobian(|values| {
            outcome = fill(self, values);
            i32::from(outcome.is_err())
        });
        if outcome.is_ok() {
            outcome = ilu.factorize().map_err(|row| Failure::Recoverable(no_pivot(row)));
        }
        if let Some(products) = &mut self.products {
            products.ilu = Some(ilu);
        }
        outcome
    }

    /// Replaces `b` by the solution of K^T x = b, with the K of the start of the backward run. Returns whether there is one.
    pub(super) fn solve_by_products(
        &mut self,
        at: Point<'_>,
        b: &mut [f64],
    ) -> Result<bool, Failure> {
        self.factorize(|system, values| {
            system.update_jacobian(at)?;
            let AdjointDae { equations, mass, algebraic, .. } = system;
            let (by_slope, by_state) = (mass.values(), equations.jacobian.values());
            let entries = equations.backward.entries(algebraic.len(), values);
            equations.jacobian.write_transposed(&equations.backward, entries, |i, position| {
                if algebraic[i] { by_state[position] } else { by_slope[position] }
            });
            Ok(())
        })?;
        let ilu = self.products.as_mut().and_then(|products| products.ilu.take());
        let multiply = |x: &[f64], out: &mut [f64]| {
            let (t, y, yp) = at;
            let Self { equations, moved: [lambda, mu], algebraic, .. } = &mut *self;
            for (i, algebraic) in algebraic.iter().enumerate() {
                (lambda[i], mu[i]) = if *algebraic { (x[i], 0.0) } else { (0.0, x[i]) };
            }
            call::adjoint_residual(&mut equations.system, t, y, yp, lambda, mu, out)
        };
        let outcome = gmres::solve(b, multiply, |z| ilu.iter().for_each(|ilu| ilu.solve(z)));
        if let Some(products) = &mut self.products {
            products.ilu = ilu;
        }
        outcome
    }
}
