//! A system, of any kind, with a functional: their derivatives in the backward run.

use super::{
    gradient::Gradient,
    parameters::ParameterDifferences,
    slopes::{Names, SlopesCheck},
};
use crate::base::input::InputError;
use crate::integrators::{
    common::{Callback, Cause, Error, IntegrationError, Tolerances},
    ode::{Entries, Failure, Functional, Slopes},
    sundials::{
        LinearSolver,
        sensitivity::Access,
        stored_matrix::{Quotients, StoredMatrix},
    },
};

/// A system and a functional, with storage for their derivatives.
pub(in crate::integrators::sundials) struct Equations<S, F> {
    pub(super) system: S,
    functional: F,
    access: Access<S>,
    tolerances: Tolerances,
    pub(super) jacobian: StoredMatrix,
    /// Whether the system supplies it.
    is_supplied: bool,
    pub(super) quotients: Quotients,
    /// The linear solver of the backward run.
    pub(super) backward: LinearSolver,
    /// Time and state of the Jacobian.
    jacobian_time: Option<f64>,
    jacobian_state: Vec<f64>,
    check: SlopesCheck,
    /// The derivatives of h with respect to the unknowns and to the parameters.
    pub(super) slopes_y: Vec<f64>,
    pub(super) slopes_p: Vec<f64>,
    differences: ParameterDifferences,
    pub(super) scratch: Vec<f64>,
}

impl<S, F: Functional> Equations<S, F> {
    /// For `n` unknowns, and the linear solver and tolerances of the forward run.
    pub(super) fn new(
        system: S,
        functional: F,
        access: Access<S>,
        n: usize,
        (forward, tolerances): (&LinearSolver, &Tolerances),
    ) -> Result<Self, InputError> {
        let jacobian = StoredMatrix::new(forward, n);
        let backward = jacobian.backward_solver()?;
        let count = (access.get)(&system).len();
        Ok(Self {
            system,
            functional,
            access,
            tolerances: tolerances.clone(),
            is_supplied: forward.supplies_entries(),
            quotients: Quotients::new(&jacobian),
            jacobian,
            backward,
            jacobian_time: None,
            jacobian_state: vec![0.0; n],
            check: SlopesCheck::new((n, tolerances), count),
            slopes_y: vec![0.0; n],
            slopes_p: vec![0.0; count],
            differences: ParameterDifferences::new(count, n),
            scratch: vec![0.0; n],
        })
    }

    pub(super) fn parameters(&self) -> &[f64] {
        (self.access.get)(&self.system)
    }

    /// Forgets the Jacobian, for a new run or because it is not usable.
    pub(super) fn forget(&mut self) {
        self.jacobian_time = None;
    }

    /// The size of unknown `j` for difference quotients, if its value is `y`.
    pub(super) fn size(&self, j: usize, y: f64) -> f64 {
        self.tolerances.size_of(j, y)
    }

    /// Updates the Jacobian to (t, y), unless it is up to date: by `supplied`, which also gets scratch space
    /// for n numbers, or by differences of `evaluate`. Returns whether it was evaluated.
    pub(super) fn update_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        supplied: impl FnOnce(&mut S, Entries<'_>, &mut [f64]) -> Result<(), Failure>,
        mut evaluate: impl FnMut(&mut S, &[f64], &mut [f64]) -> Result<(), Failure>,
    ) -> Result<bool, Failure> {
        if self.jacobian_time == Some(t) && self.jacobian_state == y {
            return Ok(false);
        }
        self.jacobian_time = None;
        let Self { system, jacobian, quotients, tolerances, scratch, .. } = self;
        if self.is_supplied {
            supplied(system, jacobian.entries(), scratch)?;
        } else {
            let step = |j: usize| f64::EPSILON.cbrt() * tolerances.size_of(j, y[j]);
            quotients.write(jacobian, y, step, |y, out| evaluate(system, y, out))?;
        }
        self.jacobian_time = Some(t);
        self.jacobian_state.copy_from_slice(y);
        Ok(true)
    }

    /// h(t, y, p)
    pub(super) fn running(&mut self, t: f64, y: &[f64]) -> Result<f64, Failure> {
        self.functional.running(t, y, (self.access.get)(&self.system), None)
    }

    /// Evaluates the slopes of h.
    pub(super) fn evaluate_slopes(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        self.slopes_y.fill(0.0);
        self.slopes_p.fill(0.0);
        let Self { functional, check, slopes_y, slopes_p, .. } = self;
        let p = (self.access.get)(&self.system);
        functional.running(t, y, p, Some(Slopes { y: slopes_y, p: slopes_p }))?;
        if !check.is_due() {
            return Ok(());
        }
        check.check(
            Names::of_functional("running of the functional"),
            [y, p],
            [slopes_y, slopes_p],
            |y, p| functional.running(t, y, p, None),
        )
    }

    /// g(T, y, p), and its derivatives with respect to p and y at the end of a run of `integrator`.
    pub(super) fn terminal(
        &mut self,
        integrator: &'static str,
        t: f64,
        y: &[f64],
    ) -> Result<Gradient, Error> {
        let p = (self.access.get)(&self.system);
        let end = Gradient::at_end(&mut self.functional, t, [y, p], &self.tolerances);
        Ok(end.map_err(|failure| refused(integrator, t, failure))?.check()?)
    }

    /// Writes the product of lambda with the derivatives of `evaluate` with respect to p, by central
    /// differences.
    pub(super) fn parameter_differences(
        &mut self,
        lambda: &[f64],
        out: &mut [f64],
        evaluate: impl FnMut(&mut S, &mut [f64]) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let Self { system, access, differences, .. } = self;
        differences.write(system, access, f64::EPSILON.cbrt(), lambda, out, evaluate)
    }
}

/// The error of a functional, or of equations, that have no value at time `t`.
pub(super) fn refused(integrator: &'static str, t: f64, failure: Failure) -> Error {
    IntegrationError {
        integrator,
        cause: Cause::Fatal(Callback::Adjoint),
        t,
        step: 0.0,
        order: 0,
        message: String::new(),
        source: Some(failure.into_error()),
    }
    .into()
}
