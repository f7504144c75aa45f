//! Equations of y together with those of s.

use super::{
    first::{FirstDerivatives, System},
    line::{Derivative, Line, Point, STEP},
};
use crate::integrators::{
    ode::{Entries, Failure},
    sundials::{LinearSolver, Pattern, options::SolverOptions},
};

/// The equations of y with those of s = (dy/dp) v in addition: (df/dy) s + (df/dp) v, or (dF/dy) s + (dF/dy') s' +
/// (dF/dp) v.
pub(in crate::integrators::sundials::adjoint) struct Doubled<E> {
    first: FirstDerivatives<E>,
    derivative: Derivative,
    /// The derivative of the matrix along the line.
    change: Vec<f64>,
    /// Of the matrix of y and s, if it is sparse.
    pattern: Option<Pattern>,
}

impl<E: System> Doubled<E> {
    /// For the options of the run forward of y and that of both, whether the equations supply products for parameters,
    /// and the numbers of unknowns and of their slopes.
    pub(in crate::integrators::sundials::adjoint) fn new<O>(
        equations: E,
        line: &Line,
        [forward, both]: [&SolverOptions<O>; 2],
        supplies_parameters: bool,
        [n, slopes]: [usize; 2],
    ) -> Self {
        let solver = (&forward.linear_solver, &forward.tolerances);
        let first = FirstDerivatives::new(equations, solver, supplies_parameters, [n, slopes]);
        let (entries, count) = (first.matrix.values().len(), first.equations.parameters().len());
        let pattern = match &both.linear_solver {
            LinearSolver::Klu { pattern, .. } => Some(pattern.clone()),
            _ => None,
        };
        let derivative = Derivative::new(line.clone(), [n, slopes, n.max(count).max(entries)]);
        Self { first, derivative, change: vec![0.0; entries], pattern }
    }

    /// Writes the equations of y and those of s; `out` is zero on entry, here and below.
    pub(in crate::integrators::sundials::adjoint) fn evaluate(
        &mut self,
        t: f64,
        [y, yp]: [&[f64]; 2],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        let Self { first, derivative, .. } = self;
        let at = Point::of(y, yp);
        let (own, along) = out.split_at_mut(at.y.len());
        first.equations.evaluate(t, [at.y, at.yp], own)?;
        derivative.add(first, &FirstDerivatives::ACCESS, STEP, at, along, |first, at, out| {
            first.equations.evaluate(t, at, out)
        })
    }

    /// Writes their matrix by y and s: that of y twice on the diagonal, and its derivative along the line below.
    pub(in crate::integrators::sundials::adjoint) fn write_entries(
        &mut self,
        t: f64,
        cj: f64,
        [y, yp]: [&[f64]; 2],
        mut entries: Entries<'_>,
    ) -> Result<(), Failure> {
        let Self { first, derivative, change, pattern } = self;
        let at = Point::of(y, yp);
        let step = first.matrix_step();
        change.fill(0.0);
        derivative.add(first, &FirstDerivatives::ACCESS, step, at, change, |first, at, out| {
            first.update_matrix(t, cj, at)?;
            out.copy_from_slice(first.matrix.values());
            Ok(())
        })?;
        first.update_matrix(t, cj, [at.y, at.yp])?;
        let (n, values) = (at.y.len(), first.matrix.values());
        first.matrix.each_position(|i, j, k| {
            let blocks = [(i, j, values[k]), (n + i, j, change[k]), (n + i, n + j, values[k])];
            for (i, j, value) in blocks {
                let position = pattern.as_ref().map_or(Some(0), |pattern| pattern.position(i, j));
                position.into_iter().for_each(|position| entries.set((i, j), position, value));
            }
        });
        Ok(())
    }

    /// Writes the product of `lambda`, of the equations of y and of those of s, with their derivatives by parameters.
    pub(in crate::integrators::sundials::adjoint) fn by_parameters(
        &mut self,
        t: f64,
        [y, yp]: [&[f64]; 2],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        let Self { first, derivative, .. } = self;
        let at = Point::of(y, yp);
        let step = first.parameter_step();
        let (own, along) = lambda.split_at(at.y.len());
        first.by_parameters(t, [at.y, at.yp], own, out)?;
        derivative.add(first, &FirstDerivatives::ACCESS, step, at, out, |first, at, out| {
            first.by_parameters(t, at, along, out)
        })
    }

    pub(in crate::integrators::sundials::adjoint) fn parameters(&self) -> &[f64] {
        self.first.equations.parameters()
    }

    pub(in crate::integrators::sundials::adjoint) fn set_parameters(&mut self, values: &[f64]) {
        self.first.equations.set_parameters(values);
    }
}
