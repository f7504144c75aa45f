//! First derivatives of the equations of y.

use super::line::{SECOND_STEP, STEP};
use crate::integrators::{
    common::Tolerances,
    ode::{Entries, Failure},
    sundials::{
        LinearSolver,
        adjoint::parameters::ParameterDifferences,
        sensitivity::Access,
        stored_matrix::{Quotients, StoredMatrix},
    },
};

/// Equations f(t, y) of an ODE or F(t, y, y') of a DAE, at (y, y'); y' is empty for the former.
pub(in crate::integrators::sundials::adjoint) trait System {
    fn evaluate(&mut self, t: f64, at: [&[f64]; 2], out: &mut [f64]) -> Result<(), Failure>;

    /// Writes df/dy, or dF/dy + cj dF/dy'; `scratch` has space for as many numbers as y.
    fn write_entries(
        &mut self,
        t: f64,
        cj: f64,
        at: [&[f64]; 2],
        scratch: &mut [f64],
        entries: Entries<'_>,
    ) -> Result<(), Failure>;

    /// Writes (df/dp)^T lambda as the system supplies it.
    fn by_parameters(
        &mut self,
        t: f64,
        at: [&[f64]; 2],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure>;

    fn parameters(&self) -> &[f64];
    fn set_parameters(&mut self, values: &[f64]);
}

/// Equations with their derivatives by y and by parameters, which they supply or which are differences.
pub(super) struct FirstDerivatives<E> {
    pub(super) equations: E,
    pub(super) matrix: StoredMatrix,
    quotients: Quotients,
    /// By twice the step.
    coarse: StoredMatrix,
    coarse_products: Vec<f64>,
    supplies_entries: bool,
    supplies_parameters: bool,
    differences: ParameterDifferences,
    tolerances: Tolerances,
    /// y' that changes with y.
    moved: Vec<f64>,
    scratch: Vec<f64>,
}

impl<E: System> FirstDerivatives<E> {
    /// Access to the parameters.
    pub(super) const ACCESS: Access<Self> = Access {
        get: |first| first.equations.parameters(),
        set: |first, p| first.equations.set_parameters(p),
    };

    /// For the linear solver and the tolerances of y, whether the equations supply products for parameters, and the
    /// numbers of unknowns and of their slopes.
    pub(super) fn new(
        equations: E,
        (solver, tolerances): (&LinearSolver, &Tolerances),
        supplies_parameters: bool,
        [n, slopes]: [usize; 2],
    ) -> Self {
        let (matrix, count) = (StoredMatrix::new(solver, n), equations.parameters().len());
        Self {
            quotients: Quotients::new(&matrix),
            coarse: matrix.clone(),
            coarse_products: vec![0.0; count],
            matrix,
            supplies_entries: solver.supplies_entries(),
            supplies_parameters,
            differences: ParameterDifferences::new(count, n),
            tolerances: tolerances.clone(),
            moved: vec![0.0; slopes],
            scratch: vec![0.0; n],
            equations,
        }
    }

    /// Makes the matrix df/dy, or dF/dy + cj dF/dy', at this point.
    pub(super) fn update_matrix(
        &mut self,
        t: f64,
        cj: f64,
        [y, yp]: [&[f64]; 2],
    ) -> Result<(), Failure> {
        let Self { equations, matrix, coarse, quotients, tolerances, moved, scratch, .. } = self;
        if self.supplies_entries {
            return equations.write_entries(t, cj, [y, yp], scratch, matrix.entries());
        }
        let mut evaluate = |trial: &[f64], out: &mut [f64]| {
            for (j, moved) in moved.iter_mut().enumerate() {
                *moved = yp[j] + cj * (trial[j] - y[j]);
            }
            equations.evaluate(t, [trial, moved], out)
        };
        let step = |j: usize| SECOND_STEP * tolerances.size_of(j, y[j]);
        quotients.write(matrix, y, step, &mut evaluate)?;
        quotients.write(coarse, y, |j| 2.0 * step(j), &mut evaluate)?;
        extrapolate(matrix.values_mut(), coarse.values());
        Ok(())
    }

    /// Writes (df/dp)^T lambda.
    pub(super) fn by_parameters(
        &mut self,
        t: f64,
        at: [&[f64]; 2],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        let Self { equations, differences, coarse_products: coarse, .. } = self;
        if self.supplies_parameters {
            return equations.by_parameters(t, at, lambda, out);
        }
        let access = Access { get: E::parameters, set: E::set_parameters };
        let mut evaluate = |equations: &mut E, out: &mut [f64]| equations.evaluate(t, at, out);
        differences.write(equations, &access, SECOND_STEP, lambda, out, &mut evaluate)?;
        differences.write(equations, &access, 2.0 * SECOND_STEP, lambda, coarse, &mut evaluate)?;
        extrapolate(out, coarse);
        Ok(())
    }

    /// The step for differences of the matrix, relative to sizes.
    pub(super) fn matrix_step(&self) -> f64 {
        if self.supplies_entries { STEP } else { SECOND_STEP }
    }

    /// The step for differences of products for parameters.
    pub(super) fn parameter_step(&self) -> f64 {
        if self.supplies_parameters { STEP } else { SECOND_STEP }
    }
}

/// Richardson's extrapolation of central differences by steps and by twice those: of fourth order.
fn extrapolate(fine: &mut [f64], coarse: &[f64]) {
    fine.iter_mut().zip(coarse).for_each(|(fine, coarse)| *fine += (*fine - coarse) / 3.0);
}
