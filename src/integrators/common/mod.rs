//! Shared parts of all integrators: their interface ([`Integrator`]), [`Tolerances`], [`Statistics`] and errors
//! ([`Error`]).
//!
//! The integrators are those of [`sundials`](crate::integrators::sundials), [`rk`](crate::integrators::rk),
//! [`rosenbrock`](crate::integrators::rosenbrock) and
//! [`central_difference`](crate::integrators::central_difference); the systems of equations are in
//! [`ode`](crate::integrators::ode).

mod clock;
mod error;
mod explicit_options;
mod integrator;
mod jacobian_check;
mod march;
mod one_step;
mod options;
mod rootfinding;
mod roots;
mod statistics;
mod tolerances;

pub(crate) use clock::{Clock, is_fine};
pub use error::{Callback, Cause, Error, IntegrationError};
pub use explicit_options::ExplicitOptions;
pub(crate) use explicit_options::{check_stop_time, check_target};
pub(crate) use integrator::number_before;
pub use integrator::{Integrator, Reached};
pub(crate) use jacobian_check::{JacobianCheck, Point, Wanted};
pub(crate) use march::{March, StepMethod, not_finite};
pub use one_step::OneStep;
pub(crate) use options::{
    SHORTEST, StepOptions, check_count, check_finite, check_form, check_length, check_start,
    check_start_time, check_step, check_time, check_whole, step_options,
};
pub(crate) use roots::time_tolerance;
pub use statistics::Statistics;
pub use tolerances::{AbsoluteTolerance, Tolerances};
