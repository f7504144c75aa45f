//! A system with a functional: what the run forward integrates, and the right-hand sides of the way back.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use faer::MatMut;

use super::{jacobian::StoredJacobian, options::AdjointOptions};
use crate::{
    input::InputError,
    integrate::Tolerances,
    ode::{BandMut, Failure, Functional, Ode, Slopes},
    sundials::{LinearSolver, matrix::Entries},
};

/// An [`Ode`] with the integral of a functional beside it.
pub(super) struct AdjointSystem<S, F> {
    pub(super) system: S,
    pub(super) functional: F,
    supplied_rhs: bool,
    supplied_parameters: bool,
    tolerances: Tolerances,
    jacobian: StoredJacobian,
    pub(super) backward: LinearSolver,
    /// Time of the Jacobian: on the way back there is one state at each time.
    jacobian_time: Option<f64>,
    slopes_y: Vec<f64>,
    slopes_p: Vec<f64>,
    p: Vec<f64>,
    trial: Vec<f64>,
    ahead: Vec<f64>,
    behind: Vec<f64>,
}

impl<S: Ode, F: Functional> AdjointSystem<S, F> {
    pub(super) fn new(
        system: S,
        functional: F,
        n: usize,
        forward: &LinearSolver,
        tolerances: &Tolerances,
        options: &AdjointOptions,
    ) -> Result<Self, InputError> {
        let jacobian = StoredJacobian::new(forward, n);
        let backward = jacobian.backward_solver()?;
        let p = system.parameters().to_vec();
        Ok(Self {
            system,
            functional,
            supplied_rhs: options.supplied_rhs,
            supplied_parameters: options.supplied_parameters,
            tolerances: tolerances.clone(),
            jacobian,
            backward,
            jacobian_time: None,
            slopes_y: vec![0.0; n],
            slopes_p: vec![0.0; p.len()],
            trial: p.clone(),
            p,
            ahead: vec![0.0; n],
            behind: vec![0.0; n],
        })
    }

    /// Forgets the Jacobian, with a new run.
    pub(super) fn start(&mut self) {
        self.jacobian_time = None;
    }

    /// Writes lambda' = -(df/dy)^T lambda - dh/dy.
    pub(super) fn backward_rhs(
        &mut self,
        t: f64,
        y: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        if self.supplied_rhs {
            self.system.adjoint_rhs(t, y, lambda, out)?;
        } else {
            self.evaluate_jacobian(t, y)?;
            self.jacobian.transposed_times(lambda, out);
        }
        self.evaluate_slopes(t, y)?;
        out.iter_mut().zip(&self.slopes_y).for_each(|(out, slope)| *out = -*out - slope);
        Ok(())
    }

    /// Writes what, integrated back in time, gives dG/dp: -(df/dp)^T lambda - dh/dp.
    pub(super) fn backward_quadratures(
        &mut self,
        t: f64,
        y: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        if self.supplied_parameters {
            self.system.adjoint_parameters(t, y, lambda, out)?;
        } else {
            self.parameter_differences(t, y, lambda, out)?;
        }
        self.evaluate_slopes(t, y)?;
        out.iter_mut().zip(&self.slopes_p).for_each(|(out, slope)| *out = -*out - slope);
        Ok(())
    }

    /// Writes the derivative of `backward_rhs` by lambda.
    pub(super) fn backward_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        entries: Entries<'_>,
    ) -> Result<(), Failure> {
        self.evaluate_jacobian(t, y)?;
        self.jacobian.write_negative_transposed(&self.backward, entries);
        Ok(())
    }

    fn evaluate_jacobian(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        if self.jacobian_time == Some(t) {
            return Ok(());
        }
        self.jacobian_time = None;
        let tolerances = &self.tolerances;
        let size = |j: usize| match y[j].abs() + tolerances.atol_of(j) / tolerances.rtol {
            0.0 => 1.0,
            size => size,
        };
        self.jacobian.evaluate(&mut self.system, t, y, size)?;
        self.jacobian_time = Some(t);
        Ok(())
    }

    fn evaluate_slopes(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        self.slopes_y.fill(0.0);
        self.slopes_p.fill(0.0);
        let slopes = Slopes { y: &mut self.slopes_y, p: &mut self.slopes_p };
        self.functional.running(t, y, self.system.parameters(), Some(slopes))?;
        Ok(())
    }

    /// (df/dp)^T lambda by central differences; parameters are put back to the last bit, whatever happens.
    fn parameter_differences(
        &mut self,
        t: f64,
        y: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        self.p.copy_from_slice(self.system.parameters());
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            for (i, out) in out.iter_mut().enumerate() {
                let p = self.p[i];
                let step = f64::EPSILON.cbrt() * if p == 0.0 { 1.0 } else { p.abs() };
                for (p, result) in [(p + step, &mut self.ahead), (p - step, &mut self.behind)] {
                    self.trial.copy_from_slice(&self.p);
                    self.trial[i] = p;
                    self.system.set_parameters(&self.trial);
                    self.system.rhs(t, y, result)?;
                }
                let differences = self.ahead.iter().zip(&self.behind).map(|(a, b)| a - b);
                let sum: f64 = differences.zip(lambda).map(|(d, lambda)| d * lambda).sum();
                *out = sum / ((p + step) - (p - step));
            }
            Ok(())
        }));
        self.system.set_parameters(&self.p);
        outcome.unwrap_or_else(|panic| resume_unwind(panic))
    }
}

impl<S: Ode, F: Functional> Ode for AdjointSystem<S, F> {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.system.rhs(t, y, ydot)
    }

    fn dense_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        ydot: &[f64],
        jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        self.system.dense_jacobian(t, y, ydot, jacobian)
    }

    fn banded_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        ydot: &[f64],
        jacobian: BandMut<'_>,
    ) -> Result<(), Failure> {
        self.system.banded_jacobian(t, y, ydot, jacobian)
    }

    fn sparse_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        ydot: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        self.system.sparse_jacobian(t, y, ydot, values)
    }

    fn quadrature_count(&self) -> usize {
        1
    }

    fn quadratures(&mut self, t: f64, y: &[f64], qdot: &mut [f64]) -> Result<(), Failure> {
        qdot[0] = self.functional.running(t, y, self.system.parameters(), None)?;
        Ok(())
    }
}
