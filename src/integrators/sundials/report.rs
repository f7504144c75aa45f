//! Statistics of an integrator of SUNDIALS, and the cause of its stop.

use super::{
    ffi,
    functions::Get,
    host::ErrorSource,
    index::Index,
    progress::STRETCH,
    session::{Memory, Session},
    signs::Violation,
};
use crate::integrators::common::{Cause, Error, IntegrationError, Statistics};

/// Codes of a factorization that found a singular matrix.
const SINGULAR: [u32; 2] = [ffi::SUNLS_LUFACT_FAIL, ffi::SUNLS_PACKAGE_FAIL_REC];
/// Codes of a Krylov method that did not converge.
const NOT_CONVERGED: [u32; 2] = [ffi::SUNLS_CONV_FAIL, ffi::SUNLS_RES_REDUCED];

impl<K, S> Session<K, S> {
    pub(super) fn all_statistics(&self) -> Statistics {
        let Memory { raw: memory, functions } = self.memory;
        let mut s = self.step_statistics();
        let [mut iterations, mut nonlinear_fails] = [0; 2];
        let count = |(_, get): Get<i64>| {
            let mut count = 0;
            // SAFETY: the memory is alive, the result pointer is valid. Functions which do not apply, say to
            // a solver without Jacobian, leave it untouched.
            unsafe { get(memory, &raw mut count) };
            count as u64
        };
        // SAFETY: the memory is alive, every result pointer is valid.
        unsafe {
            (functions.get_nonlinear_stats.1)(
                memory,
                &raw mut iterations,
                &raw mut nonlinear_fails,
            );
            (functions.get_tolerance_scale.1)(memory, &raw mut s.tolerance_scale);
        }
        s.current_time = self.clock().time(s.current_time);
        s.nonlinear_iterations = iterations as u64;
        s.nonlinear_failures = nonlinear_fails as u64;
        s.step_failures = count(functions.get_step_failures);
        s.jacobian_evaluations = count(functions.get_jacobian_evaluations);
        let ours = self.host.get().differences.as_ref().map_or(0, |ours| ours.evaluations);
        s.difference_quotient_evaluations = count(functions.get_quotient_evaluations) + ours;
        s.linear_iterations = count(functions.get_linear_iterations);
        s.linear_failures = count(functions.get_linear_failures);
        s.preconditioner_setups = count(functions.get_preconditioner_setups);
        s.preconditioner_solves = count(functions.get_preconditioner_solves);
        // ARKODE has no count before the first step
        s.root_evaluations = if s.steps > 0 { count(functions.get_root_evaluations) } else { 0 };
        // without integrals and sensitivities C would make a message of the question
        let quadratures = self.quadratures.as_ref().map(|own| own.functions.get_evaluations);
        s.quadrature_evaluations = quadratures.map_or(0, count);
        if let ([Some(_), Some(_)], Some((_, get))) = (self.stages, functions.get_rhs_evaluations) {
            let [mut explicit, mut implicit] = [0; 2];
            // SAFETY: as above.
            unsafe { get(memory, &raw mut explicit, &raw mut implicit) };
            s.explicit_evaluations = explicit as u64;
        }
        let sensitivities = self.sensitivities.as_ref().map(|own| own.functions.get_evaluations);
        s.sensitivity_evaluations = sensitivities.map_or(0, count);
        s.stability_reductions = functions.get_stability_reductions.map_or(0, count);
        s
    }

    /// The statistics of one call, with the time as C has it, among them those of the last step: cheap enough to be read at every step.
    pub(super) fn step_statistics(&self) -> Statistics {
        let mut s = Statistics::default();
        let [mut steps, mut evaluations, mut setups, mut error_fails] = [0; 4];
        let [mut last_order, mut current_order] = [0; 2];
        // SAFETY: the memory is alive, every result pointer is valid.
        unsafe {
            (self.memory.functions.get_integrator_stats)(
                self.memory.raw,
                &raw mut steps,
                &raw mut evaluations,
                &raw mut setups,
                &raw mut error_fails,
                &raw mut last_order,
                &raw mut current_order,
                &raw mut s.initial_step,
                &raw mut s.last_step,
                &raw mut s.current_step,
                &raw mut s.current_time,
            );
        }
        if steps == 0 {
            // C still has the last step of the previous run
            (s.current_time, s.last_step) = (self.elapsed, 0.0);
        } else if self.failed_within {
            s.current_time = self.elapsed;
        }
        s.steps = steps as u64;
        s.evaluations = evaluations as u64;
        s.linear_setups = setups as u64;
        s.error_test_failures = error_fails as u64;
        s.last_order = self.known_order.unwrap_or(last_order as u32);
        s.current_order = self.known_order.unwrap_or(current_order as u32);
        s
    }

    /// Whether the linear solver failed last with one of these codes.
    fn linear_solver_gave(&self, codes: [u32; 2]) -> bool {
        let mut flag = 0;
        // SAFETY: the memory is alive, the result pointer is valid.
        let code =
            unsafe { (self.memory.functions.get_linear_flag.1)(self.memory.raw, &raw mut flag) };
        code == 0 && codes.iter().any(|&code| i64::from(code) == flag)
    }

    /// The cause that a DAE is of higher index, if it is and may have failed for that.
    pub(super) fn higher_index(&mut self, cause: &Cause) -> Option<Cause> {
        const MOST_UNKNOWNS: usize = 300;
        let suspicious = matches!(
            cause,
            Cause::ErrorTest
                | Cause::Convergence
                | Cause::LinearSolver
                | Cause::InconsistentStart
                | Cause::StandsStill { .. }
                | Cause::TooManySteps { .. }
                | Cause::Other
        );
        let host = self.host.get_mut();
        let (find, y, yp) = (host.find_index?, self.y.as_slice(), self.yp.as_ref()?.as_slice());
        if !suspicious || y.len() > MOST_UNKNOWNS {
            return None;
        }
        match find(&mut host.system, self.t, y, yp) {
            Ok(Index::Higher(unknown)) => Some(Cause::HigherIndex { unknown }),
            _ => None,
        }
    }

    /// The error for a return code of the integrator on its way to `target`.
    pub(super) fn stopped(&mut self, code: i32, target: f64) -> Error {
        // read first: reading the flag of the linear solver may leave a message, too
        let mut message = self.host.get_mut().troubles.message().to_owned();
        if !message.is_empty() {
            message = format!("SUNDIALS, code {code}: {message}");
        }
        let statistics = self.step_statistics();
        let is_dae = self.yp.is_some();
        let (otherwise, blame_retries) = match code {
            ffi::CV_TOO_MUCH_WORK if self.progress.stands => {
                (Cause::StandsStill { steps: STRETCH }, true)
            }
            code if self.memory.functions.mass_failures.contains(&code) => {
                (Cause::MassMatrix, true)
            }
            ffi::IDA_LINESEARCH_FAIL | ffi::IDA_NO_RECOVERY if is_dae => {
                (Cause::InconsistentStart, true)
            }
            ffi::CV_CONV_FAILURE if self.linear_solver_gave(SINGULAR) => {
                (Cause::LinearSolver, true)
            }
            ffi::CV_CONV_FAILURE if self.linear_solver_gave(NOT_CONVERGED) => {
                (Cause::LinearConvergence, true)
            }
            ffi::CV_ERR_FAILURE | ffi::CV_CONV_FAILURE if is_dae && statistics.steps == 0 => {
                (Cause::InconsistentStart, true)
            }
            code => cause_of(code, self.max_steps, target),
        };
        // too many steps at a bound may have another reason, unless they make hardly any progress
        let crawls = statistics.current_step.abs() < 1e-6 * (target - self.t).abs();
        let at_bound = !self.signs.is_empty() && (code != ffi::CV_TOO_MUCH_WORK || crawls);
        let violation = self.host.get().troubles.recent_violation();
        let otherwise = match violation.filter(|_| at_bound) {
            Some(Violation { unknown, value, .. }) => Cause::SignConstraint { unknown, value },
            None => otherwise,
        };
        let troubles = &mut self.host.get_mut().troubles;
        let place = (statistics.current_time, statistics.current_step);
        let (cause, source) = troubles.cause(place, blame_retries, otherwise);
        let cause = self.higher_index(&cause).unwrap_or(cause);
        self.error(&statistics, cause, message, source)
    }

    pub(super) fn error(
        &self,
        statistics: &Statistics,
        cause: Cause,
        message: String,
        source: ErrorSource,
    ) -> Error {
        IntegrationError {
            integrator: self.memory.functions.integrator,
            cause,
            t: self.t,
            step: statistics.current_step,
            order: statistics.current_order,
            message,
            source,
        }
        .into()
    }
}

/// Cause for which an integrator that may take so many steps to `target` stops with this code, and whether a request of
/// the system for a smaller step can be the reason.
pub(super) fn cause_of(code: i32, max_steps: u32, target: f64) -> (Cause, bool) {
    match code {
        ffi::CV_TOO_MUCH_WORK => {
            (Cause::TooManySteps { steps: u64::from(max_steps), target, notice: None }, true)
        }
        ffi::CV_TOO_MUCH_ACC => (Cause::TooMuchAccuracy, false),
        ffi::CV_ERR_FAILURE => (Cause::ErrorTest, false),
        ffi::CV_CONV_FAILURE => (Cause::Convergence, true),
        ffi::CV_LINIT_FAIL | ffi::CV_LSETUP_FAIL | ffi::CV_LSOLVE_FAIL => {
            (Cause::LinearSolver, true)
        }
        _ => (Cause::Other, true),
    }
}
