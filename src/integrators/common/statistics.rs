//! Statistics of an integration.

/// Counters and state of an integrator since its creation or last re-initialisation. Entries that do not
/// apply to a method are 0.
///
/// In a Newton iteration every iteration solves one linear system, so `nonlinear_iterations` is
/// also the number of linear solves.
///
/// SUNDIALS user guide: "Optional output functions" of CVODE, IDA and ARKODE.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Statistics {
    /// Steps taken.
    pub steps: u64,
    /// Evaluations of the right-hand side (ODE), residual (DAE) or forces (second order), without
    /// those of difference quotients.
    pub evaluations: u64,
    /// Number of those of the explicit part, if the right-hand side is
    /// [split](crate::integrators::ode::Ode::is_split).
    pub explicit_evaluations: u64,
    /// Evaluations spent on difference quotients for the Jacobian.
    pub difference_quotient_evaluations: u64,
    /// Evaluations of the Jacobian.
    pub jacobian_evaluations: u64,
    /// Factorizations of the Newton matrix, or the setups that a Krylov method has instead.
    pub linear_setups: u64,
    /// Iterations of the Krylov method.
    pub linear_iterations: u64,
    /// Linear systems that the Krylov method did not solve to its tolerance.
    pub linear_failures: u64,
    /// Preconditioners from a fresh Jacobian.
    pub preconditioner_setups: u64,
    /// Systems solved with the preconditioner.
    pub preconditioner_solves: u64,
    /// Iterations of the nonlinear solver.
    pub nonlinear_iterations: u64,
    /// Nonlinear iterations that did not converge. Most are repaired by a fresh Jacobian.
    pub nonlinear_failures: u64,
    /// Steps repeated with a smaller size because the nonlinear iteration failed.
    pub step_failures: u64,
    /// Steps that a method without iterations repeated with a smaller size because the right-hand side or the
    /// forces could not be evaluated: they failed recoverably or were not finite.
    pub refused_steps: u64,
    /// Steps repeated because the local error was too large.
    pub error_test_failures: u64,
    /// Evaluations of the root functions.
    pub root_evaluations: u64,
    /// Evaluations of the integrands of quadratures (CVODE, IDA).
    pub quadrature_evaluations: u64,
    /// Evaluations of the right-hand side or residual of one sensitivity (CVODE) or all (IDA).
    pub sensitivity_evaluations: u64,
    /// Order reductions by stability-limit detection (CVODE).
    pub stability_reductions: u64,
    /// Order of the last step.
    pub last_order: u32,
    /// Order of the next step.
    pub current_order: u32,
    /// Size of the first step.
    pub initial_step: f64,
    /// Size of the last step.
    pub last_step: f64,
    /// Size of the next step.
    pub current_step: f64,
    /// Time that the steps have reached; `solve_to` may have returned an earlier one.
    pub current_time: f64,
    /// Factor by which the tolerances should be raised if they require too much accuracy; 1 if not
    /// (SUNDIALS).
    pub tolerance_scale: f64,
}

impl Statistics {
    /// The summed counters of two runs, the second of which started where the first ended; step sizes, orders
    /// and times are those of the second.
    #[must_use]
    pub(crate) fn followed_by(&self, later: &Self) -> Self {
        let mut sum = later.clone();
        for (sum, earlier) in sum.counters().into_iter().zip(self.clone().counters()) {
            *sum += *earlier;
        }
        sum
    }

    fn counters(&mut self) -> [&mut u64; 19] {
        [
            &mut self.steps,
            &mut self.evaluations,
            &mut self.explicit_evaluations,
            &mut self.difference_quotient_evaluations,
            &mut self.jacobian_evaluations,
            &mut self.linear_setups,
            &mut self.linear_iterations,
            &mut self.linear_failures,
            &mut self.preconditioner_setups,
            &mut self.preconditioner_solves,
            &mut self.nonlinear_iterations,
            &mut self.nonlinear_failures,
            &mut self.step_failures,
            &mut self.refused_steps,
            &mut self.error_test_failures,
            &mut self.root_evaluations,
            &mut self.quadrature_evaluations,
            &mut self.sensitivity_evaluations,
            &mut self.stability_reductions,
        ]
    }
}
