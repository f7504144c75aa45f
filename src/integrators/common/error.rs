//! Errors of integrators, with time, step size, order, likely cause and remedies.

use std::{error, fmt};

use thiserror::Error;

use crate::base::input::{InputError, debug_in_words};

debug_in_words!(Error, IntegrationError);

/// An error of an integrator. It is shown in words, also by [`Debug`](std::fmt::Debug).
#[derive(Error)]
#[non_exhaustive]
pub enum Error {
    /// A value that was handed in cannot be used; nothing was computed.
    #[error(transparent)]
    Input(#[from] InputError),

    /// The integration stopped. The integrator keeps the last state it accepted.
    #[error(transparent)]
    Integration(Box<IntegrationError>),

    /// A function of the library SUNDIALS refused a call.
    #[error("{function} failed with code {code}{}{message}", if message.is_empty() { "" } else { ": " })]
    Call {
        /// The C function.
        function: &'static str,
        /// Its return code.
        code: i32,
        /// The message of SUNDIALS, or empty.
        message: String,
    },
}

impl Error {
    /// `input` = `value` cannot be used: `help`.
    pub(crate) fn input(
        input: impl Into<String>,
        value: impl fmt::Display,
        help: impl Into<String>,
    ) -> Self {
        InputError::new(input, value, help).into()
    }

    /// A C function that returned `code`.
    pub(crate) fn call(function: &'static str, code: i32) -> Self {
        Self::Call { function, code, message: String::new() }
    }

    /// A C function that returned NULL.
    pub(crate) fn out_of_memory(function: &'static str) -> Self {
        Self::Call { function, code: 0, message: "no memory".into() }
    }
}

/// The part of the user's system that was being called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Callback {
    /// [`Ode::rhs`](crate::integrators::ode::Ode::rhs)
    Rhs,
    /// [`Ode::explicit_rhs`](crate::integrators::ode::Ode::explicit_rhs)
    ExplicitRhs,
    /// [`Dae::residual`](crate::integrators::ode::Dae::residual)
    Residual,
    /// `dense_jacobian`, `banded_jacobian` or `sparse_jacobian`
    Jacobian,
    /// `dense_mass`, `banded_mass` or `sparse_mass`
    Mass,
    /// `jacobian_times`
    JacobianTimes,
    /// The incomplete factorization that preconditions a Krylov method.
    Preconditioner,
    /// `newton_setup`
    NewtonSetup,
    /// `newton_solve`
    NewtonSolve,
    /// `roots`
    Roots,
    /// `quadratures`
    Quadratures,
    /// `project`
    Projection,
    /// The weights of the error norm.
    ErrorWeights,
    /// A [`Functional`](crate::integrators::ode::Functional), `adjoint_rhs`, `adjoint_parameters`, or the
    /// equations in their place
    Adjoint,
    /// `sensitivity_rhs` or `sensitivity_residual`, or the equations with a changed parameter in their place
    Sensitivities,
    /// The forces and constraints of a [`SecondOrder`](crate::integrators::ode::SecondOrder) system.
    Forces,
}

impl fmt::Display for Callback {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Rhs => "the right-hand side",
            Self::ExplicitRhs => "the explicit part of the right-hand side",
            Self::Residual => "the residual",
            Self::Jacobian => "the Jacobian",
            Self::Mass => "the mass matrix",
            Self::JacobianTimes => "jacobian_times",
            Self::Preconditioner => "the preconditioner",
            Self::NewtonSetup => "newton_setup",
            Self::NewtonSolve => "newton_solve",
            Self::Roots => "the root functions",
            Self::Adjoint => "the adjoint equations",
            Self::Quadratures => "the integrands",
            Self::Projection => "the projection",
            Self::ErrorWeights => "the error weights",
            Self::Sensitivities => "the equations of the sensitivities",
            Self::Forces => "the equations of motion",
        })
    }
}

/// Cause of the failure of an integration.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Cause {
    /// The user's system requested a stop; its error is the source of this one.
    Fatal(Callback),
    /// The user's system kept rejecting the trial points at any step size.
    Rejected {
        /// Callback that rejected the point.
        callback: Callback,
        /// Time of the last rejected point.
        t: f64,
        /// The reason that was given.
        message: String,
    },
    /// The user's system kept returning NaN or infinity at any step size.
    NotFinite {
        /// Callback that returned it.
        callback: Callback,
        /// Time of the call.
        t: f64,
        /// First component concerned (for a Jacobian: the position among its stored values).
        component: usize,
        /// Its value.
        value: f64,
    },
    /// One call took the largest number of steps allowed. Another call continues.
    TooManySteps {
        /// Steps taken by the call.
        steps: u64,
        /// Target time.
        target: f64,
        /// A warning of the integrator about its steps
        /// ([`Integrator::notice`](super::Integrator::notice)).
        notice: Option<String>,
    },
    /// No progress in time: steps are as short as round-off. Another call continues.
    StandsStill {
        /// Number of such steps.
        steps: u64,
    },
    /// The tolerances require more digits than double precision has.
    TooMuchAccuracy,
    /// The local error stayed too large down to the smallest step.
    ErrorTest,
    /// The nonlinear iteration did not converge down to the smallest step.
    Convergence,
    /// A Jacobian that the user's system supplies is not that of its equations.
    WrongJacobian {
        /// The method that supplied it.
        method: &'static str,
        /// The equation in which it is wrong, or the first of several.
        row: usize,
        /// The unknown for which the derivative is most wrong; `None` if there are too many to search.
        column: Option<usize>,
        /// The supplied value of this entry, or of the product of the row with a direction.
        supplied: f64,
        /// The same by difference quotients of the equations.
        difference: f64,
    },
    /// The equations depend on an unknown by an entry of the Jacobian that its band or pattern, for difference quotients, does not have.
    MissingEntry {
        /// The equation, or the first of several.
        row: usize,
        /// The unknown on which it depends most, of those without an entry.
        column: usize,
        /// The entry by a difference quotient of the equations.
        difference: f64,
    },
    /// The system's own `newton_solve`, as linear solver or preconditioner, answered zero to a right-hand side that is not: Newton's iteration
    /// would accept its first guess as the solution.
    WrongSolver,
    /// The Newton matrix could not be factorized.
    LinearSolver,
    /// The mass matrix could not be factorized.
    MassMatrix,
    /// The Krylov method did not solve the linear systems of the nonlinear iteration down to the
    /// smallest step.
    LinearConvergence,
    /// The initial values of a DAE do not satisfy its equations, or consistent ones could not be found.
    InconsistentStart,
    /// A DAE is of index 2 or higher: the equations without derivatives leave an unknown undetermined.
    HigherIndex {
        /// The unknown, or one of several.
        unknown: usize,
    },
    /// An unknown does not keep the sign that `sign_constraints` require at any step size, or the
    /// steps towards its bound have become too small.
    SignConstraint {
        /// The unknown, or the first of several.
        unknown: usize,
        /// Its value at the end of a step that was tried.
        value: f64,
    },
    /// Anything else; see the message of the library.
    Other,
}

impl Cause {
    fn describe(&self) -> String {
        match self {
            Self::Fatal(callback) => format!("{callback} failed"),
            Self::Rejected { callback, t, message } => {
                format!("{callback} kept rejecting the trial points, last at t = {t:?}: {message}")
            }
            Self::NotFinite { callback, t, component, value } => {
                format!("{callback} returned {value} at t = {t:?} in component {component}")
            }
            Self::TooManySteps { steps, target, .. } => {
                format!("{steps} steps taken, and still short of t = {target:?}")
            }
            Self::StandsStill { steps } => {
                format!(
                    "no progress in time: the last {steps} steps advanced by no more than round-off"
                )
            }
            Self::TooMuchAccuracy => "the tolerances ask for more than double precision".into(),
            Self::ErrorTest => "the local error stays too large at the smallest step".into(),
            Self::Convergence => {
                "the nonlinear iteration does not converge at the smallest step".into()
            }
            Self::WrongJacobian { method, row, column, supplied, difference } => {
                let what = match column {
                    Some(column) => format!("entry ({row}, {column})"),
                    None => format!("row {row} of its product with a direction"),
                };
                format!(
                    "{method} is wrong: {what} is {supplied:e}, but {difference:e} by differences of the equations"
                )
            }
            Self::MissingEntry { row, column, difference } => format!(
                "the band or pattern of the Jacobian lacks entry ({row}, {column}), which is {difference:e} by differences of the equations"
            ),
            Self::WrongSolver => {
                "newton_solve is wrong: it answers zero to a right-hand side that is not".into()
            }
            Self::LinearSolver => "the Newton matrix cannot be factorized".into(),
            Self::MassMatrix => "the mass matrix cannot be factorized".into(),
            Self::LinearConvergence => {
                "the Krylov method does not converge at the smallest step".into()
            }
            Self::InconsistentStart => "the initial values do not satisfy the equations".into(),
            Self::HigherIndex { unknown } => format!(
                "the equations are of index 2 or higher: those without derivatives leave unknown \
                 {unknown} undetermined"
            ),
            Self::SignConstraint { unknown, value } => {
                format!(
                    "unknown {unknown} became {value:e} in the last steps, against sign_constraints"
                )
            }
            Self::Other => "SUNDIALS gave up".into(),
        }
    }

    /// The likely reason and the remedy.
    #[must_use]
    pub fn advice(&self) -> &str {
        match self {
            Self::Fatal(_) => "see the source of this error",
            Self::Rejected { .. } => {
                "the solution leaves the domain of the equations; check the model near this time"
            }
            Self::NotFinite { .. } => {
                "look for a division by zero, a root or logarithm of a negative number, or an \
                 overflow in this component"
            }
            Self::TooManySteps { notice: Some(notice), .. } => notice,
            Self::TooManySteps { .. } => {
                "raise max_steps if the step size is reasonable; if it is tiny, look for a \
                 discontinuity, a fast oscillation or a tolerance that is too tight"
            }
            Self::StandsStill { .. } => {
                "look for a singularity of the solution at this time, a discontinuity that it cannot leave, or \
                 equations of DAEs that determine nothing; raising max_steps does not help"
            }
            Self::TooMuchAccuracy => "raise rtol or atol",
            Self::ErrorTest => {
                "look for a discontinuity or singularity near this time; stop and restart there \
                 (stop time, root function), or raise atol of components near zero"
            }
            Self::Convergence => {
                "check a supplied Jacobian against difference quotients; look for a discontinuity"
            }
            Self::WrongJacobian { .. } => {
                "correct this derivative (ode::check looks at all of them), or let difference quotients take its place; \
                 if it is meant to be an approximation, switch this check off by check_jacobian(false)"
            }
            Self::MissingEntry { .. } => {
                "add it; Pattern::ode_by_nan and the like find all entries at a state, those of other states by more points or by hand; if it is \
                 left out on purpose, which may take many more steps, switch this check off by check_jacobian(false)"
            }
            Self::WrongSolver => {
                "look for a factor that it forgets, a division by infinity, or a result that is not written into r"
            }
            Self::LinearSolver => {
                "look for a zero row or column of the Jacobian; a DAE has to be of index 1"
            }
            Self::MassMatrix => {
                "look for an unknown without mass, a zero row or column: IDA takes singular mass matrices, \
                 by MassForm"
            }
            Self::LinearConvergence => {
                "give it a preconditioner, more dimensions and restarts, or more iterations"
            }
            Self::InconsistentStart => {
                "evaluate the residual at the start, or let consistent_start find the missing \
                 values; if it is right, check a supplied Jacobian"
            }
            Self::HigherIndex { .. } => {
                "replace constraints by their derivatives with respect to time, once or twice, until they \
                 determine it, as the accelerations of a mechanism determine its constraint forces; as an ODE \
                 it may keep the constraints themselves by `project`"
            }
            Self::SignConstraint { .. } => {
                "look at what drives this unknown at its bound: a reaction has to end with what it \
                 consumes; a body that passes a stop needs a root function there and new equations; \
                 if the exact solution keeps the sign, lower atol of this unknown"
            }
            Self::Other => "see the message of SUNDIALS",
        }
    }
}

/// A failed integration: time, cause and remedy.
#[non_exhaustive]
pub struct IntegrationError {
    /// The integrator, such as "CVODE".
    pub integrator: &'static str,
    /// Cause of the failure.
    pub cause: Cause,
    /// Time that was reached.
    pub t: f64,
    /// Step size that was being tried.
    pub step: f64,
    /// Order that was being tried.
    pub order: u32,
    /// The message of SUNDIALS, with its return code; empty for the others.
    pub message: String,
    /// The error that the user's system gave, for [`Cause::Fatal`].
    pub source: Option<Box<dyn error::Error + Send + Sync>>,
}

impl From<IntegrationError> for Error {
    fn from(error: IntegrationError) -> Self {
        Self::Integration(Box::new(error))
    }
}

impl fmt::Display for IntegrationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { integrator, cause, t, step, order, message, source, .. } = self;
        let (what, advice) = (cause.describe(), cause.advice());
        write!(f, "{integrator} stopped at t = {t:?} (step size {step:.3e}, order {order}): ")?;
        match (cause, source) {
            (Cause::Fatal(_), Some(source)) => write!(f, "{what}: {source}")?,
            _ => write!(f, "{what}; {advice}")?,
        }
        if !message.is_empty() {
            write!(f, " [{message}]")?;
        }
        Ok(())
    }
}

impl error::Error for IntegrationError {
    fn source(&self) -> Option<&(dyn error::Error + 'static)> {
        self.source.as_ref().map(|source| source.as_ref() as _)
    }
}
