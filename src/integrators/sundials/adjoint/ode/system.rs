//! A system with a functional: right-hand sides of the forward run and of the backward run.

use faer::MatMut;

use crate::base::{input::InputError, vector::dot};
use crate::integrators::{
    common::Tolerances,
    ode::{BandMut, Entries, Failure, Functional, Ode, call, delegate::delegate},
    sundials::{
        LinearSolver,
        adjoint::{
            equations::Equations,
            options::AdjointOptions,
            slopes::{Names, SlopesCheck},
        },
        ilu::{IncompleteLu, no_pivot},
        sensitivity::Access,
    },
};

/// An [`Ode`] with the integral of a functional in addition.
pub(super) struct AdjointSystem<S, F> {
    pub(super) equations: Equations<S, F>,
    /// The check of (df/dy)^T lambda, where the system supplies it.
    supplied_rhs: Option<SlopesCheck>,
    supplied_parameters: bool,
    /// The preconditioner of a Krylov method in the backward run.
    ilu: Option<IncompleteLu>,
}

impl<S: Ode, F: Functional> AdjointSystem<S, F> {
    pub(super) fn new(
        system: S,
        functional: F,
        n: usize,
        forward: (&LinearSolver, &Tolerances),
        options: &AdjointOptions,
    ) -> Result<Self, InputError> {
        let access = Access { get: S::parameters, set: S::set_parameters };
        let equations = Equations::new(system, functional, access, n, forward)?;
        if let (LinearSolver::Krylov(_), false) = (&equations.backward, options.supplied_rhs) {
            let help = "there are no entries of the Jacobian to transpose: write adjoint_rhs, and say so by \
                        AdjointOptions::supplied_rhs";
            return Err(InputError::new("linear solver", "Krylov", help));
        }
        Ok(Self {
            supplied_rhs: options.supplied_rhs.then(|| SlopesCheck::new((n, forward.1), 0)),
            supplied_parameters: options.supplied_parameters,
            ilu: equations.backward.ilu().map(|(pattern, _)| IncompleteLu::new(pattern)),
            equations,
        })
    }

    /// Writes lambda' = -(df/dy)^T lambda - dh/dy.
    pub(super) fn backward_rhs(
        &mut self,
        t: f64,
        y: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        if let Some(check) = &mut self.supplied_rhs {
            let Equations { system, scratch, .. } = &mut self.equations;
            call::adjoint_rhs(system, t, y, lambda, out)?;
            if check.is_due() {
                // the slope of lambda^T f
                check.check(Names::of_products("adjoint_rhs"), [y, &[]], [out, &[]], |y, _| {
                    call::rhs(system, t, y, scratch)?;
                    Ok(dot(lambda, scratch))
                })?;
            }
        } else {
            self.update_jacobian(t, y)?;
            out.fill(0.0);
            self.equations.jacobian.add_transposed_times(1.0, lambda, out);
        }
        self.equations.evaluate_slopes(t, y)?;
        out.iter_mut().zip(&self.equations.slopes_y).for_each(|(out, slope)| *out = -*out - slope);
        Ok(())
    }

    /// Writes the integrand that, integrated back in time, gives dG/dp: -(df/dp)^T lambda - dh/dp.
    pub(super) fn backward_quadratures(
        &mut self,
        t: f64,
        y: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        if self.supplied_parameters {
            call::adjoint_parameters(&mut self.equations.system, t, y, lambda, out)?;
        } else {
            let evaluate = |system: &mut S, f: &mut [f64]| call::rhs(system, t, y, f);
            self.equations.parameter_differences(lambda, out, evaluate)?;
        }
        self.equations.evaluate_slopes(t, y)?;
        out.iter_mut().zip(&self.equations.slopes_p).for_each(|(out, slope)| *out = -*out - slope);
        Ok(())
    }

    /// Writes the values of the derivative of `backward_rhs` with respect to lambda: -(df/dy)^T.
    pub(super) fn backward_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        self.update_jacobian(t, y)?;
        let Equations { jacobian, backward, .. } = &self.equations;
        let entries = backward.entries(y.len(), values);
        jacobian.write_transposed(backward, entries, |_, position| -jacobian.values()[position]);
        Ok(())
    }

    /// Writes the product of that derivative with `v`: -(df/dy)^T v.
    pub(super) fn backward_product(
        &mut self,
        t: f64,
        y: &[f64],
        v: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        call::adjoint_rhs(&mut self.equations.system, t, y, v, out)?;
        out.iter_mut().for_each(|out| *out = -*out);
        Ok(())
    }

    /// Factorizes I + gamma (df/dy)^T incompletely. Returns whether df/dy is that of this point.
    pub(super) fn backward_setup(
        &mut self,
        t: f64,
        y: &[f64],
        gamma: f64,
        reuse: bool,
    ) -> Result<bool, Failure> {
        // Taken out, as its values are written by all of the system.
        let Some(mut ilu) = self.ilu.take() else { return Ok(true) };
        let fresh = !(reuse && ilu.has_jacobian());
        let mut outcome = Ok(());
        if fresh {
            ilu.update_jacobian(|values| {
                outcome = self.backward_jacobian(t, y, values);
                i32::from(outcome.is_err())
            });
        }
        if outcome.is_ok() {
            let factorized = ilu.factorize_shifted(gamma);
            outcome = factorized.map_err(|row| Failure::Recoverable(no_pivot(row)));
        }
        self.ilu = Some(ilu);
        outcome.map(|()| fresh)
    }

    /// Replaces `z` by the solution for it, by those factors.
    pub(super) fn backward_solve(&self, z: &mut [f64]) {
        self.ilu.iter().for_each(|ilu| ilu.solve(z));
    }

    fn update_jacobian(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        let supplied = |system: &mut S, entries: Entries<'_>, ydot: &mut [f64]| {
            call::rhs(system, t, y, ydot)?;
            entries.jacobian(system, t, y, ydot)
        };
        let evaluate = |system: &mut S, y: &[f64], f: &mut [f64]| call::rhs(system, t, y, f);
        self.equations.update_jacobian(t, y, supplied, evaluate)?;
        Ok(())
    }
}

impl<S: Ode, F: Functional> Ode for AdjointSystem<S, F> {
    delegate!(Ode in equations.system: equations);

    fn quadrature_count(&self) -> usize {
        1
    }

    fn quadratures(&mut self, t: f64, y: &[f64], qdot: &mut [f64]) -> Result<(), Failure> {
        qdot[0] = self.equations.running(t, y)?;
        Ok(())
    }
}
