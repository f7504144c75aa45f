//! The data that a one-step method works on, and the trait of such a method.

use std::fmt;

use super::clock::Clock;
use super::error::{Callback, Cause, Error, IntegrationError};
use super::explicit_options::ExplicitOptions;
use super::roots::Roots;
use super::statistics::Statistics;
use crate::integrators::ode::{Failure, Ode};

/// State of an integration by a one-step method.
#[derive(Debug)]
pub struct March<S> {
    /// Name and order of the method.
    pub(crate) integrator: &'static str,
    pub(crate) order: u32,
    pub(crate) system: S,
    pub(crate) options: ExplicitOptions,
    /// Weights of the error norm.
    pub(crate) weight: Vec<f64>,
    /// Counts all times below from the start.
    pub(crate) clock: Clock,
    /// Time of the present state, and the stop time, in the user's time.
    pub(crate) now: f64,
    pub(crate) stop_given: f64,
    pub(crate) stop_time: Option<f64>,
    /// End of the last accepted step, the solution there and f.
    pub(crate) t: f64,
    pub(crate) y: Vec<f64>,
    pub(crate) slope: Vec<f64>,
    /// Whether `slope` is f(t, y).
    pub(crate) slope_known: bool,
    /// Start of the last accepted step; equal to `t` when there is nothing to interpolate in. The solution
    /// there and f; while a step is tried, those at its end.
    pub(crate) t_old: f64,
    pub(crate) y_old: Vec<f64>,
    pub(crate) slope_old: Vec<f64>,
    /// Argument of a stage.
    pub(crate) argument: Vec<f64>,
    /// Time within the last step at which the last call stopped, unless at its end, and the solution there.
    pub(crate) rest: Option<f64>,
    pub(crate) output: Vec<f64>,
    pub(crate) roots: Roots,
    /// Size of the next step, once known.
    pub(crate) next_step: Option<f64>,
    /// Reason for the last rejection of a step, until steps grow again.
    pub(crate) setback: Option<Cause>,
    pub(crate) statistics: Statistics,
}

impl<S: Ode> March<S> {
    /// Separates failures that a smaller step may remedy from those that end the integration, in a call at
    /// time `t` from the start on a step of size `step`.
    pub(crate) fn classify(
        &self,
        outcome: Result<(), Failure>,
        callback: Callback,
        t: f64,
        step: f64,
    ) -> Result<Option<Cause>, Error> {
        match outcome {
            Ok(()) => Ok(None),
            Err(Failure::Recoverable(message)) => {
                Ok(Some(Cause::Rejected { callback, t: self.clock.time(t), message }))
            }
            Err(Failure::Fatal(source)) => {
                let stopped = self.stopped(Cause::Fatal(callback), step);
                Err(IntegrationError { source: Some(source), ..stopped }.into())
            }
        }
    }

    /// The error of an integration that stopped in a step.
    pub(crate) fn stopped(&self, cause: Cause, step: f64) -> IntegrationError {
        let Self { integrator, order, .. } = *self;
        let t = self.clock.time(self.t);
        IntegrationError { integrator, cause, t, step, order, message: String::new(), source: None }
    }
}

/// The first component of f at time `t` that is not finite.
pub(crate) fn not_finite(t: f64, slope: &[f64]) -> Option<Cause> {
    let component = slope.iter().position(|value| !value.is_finite())?;
    Some(Cause::NotFinite { callback: Callback::Rhs, t, component, value: slope[component] })
}

/// Formulas of a one-step method for a single step.
///
/// Steps share nothing but their size. Times are those from the start, of [`March`]. Starts, stops, roots and the loop over steps are done by
/// [`OneStep`](super::OneStep).
pub trait StepMethod: fmt::Debug {
    /// Restarts the method.
    fn restart(&mut self);

    /// Discards cached data of the system, such as its Jacobian.
    fn forget(&mut self);

    /// The norm of the local error.
    fn norm(&self, x: &[f64], weight: &[f64]) -> f64;

    /// Tries a step to `t_new`, `h` later; `y_old` then holds the new solution and `slope_old` f there.
    ///
    /// The inner result is the norm of the error estimate, at most 1 if the step can be accepted, or why
    /// there is none.
    fn try_step<S: Ode>(
        &mut self,
        march: &mut March<S>,
        t_new: f64,
        h: f64,
    ) -> Result<Result<f64, Cause>, Error>;

    /// Accepts the step just tried. Returns the size of the next one.
    fn accept<S: Ode>(&mut self, march: &March<S>, t_new: f64, h: f64, error: f64) -> f64;

    /// The size to retry with after an error norm above 1.
    fn reject(&mut self, h: f64, error: f64) -> f64;

    /// The size to retry with when there is no error norm.
    fn refuse(&mut self, h: f64) -> f64;

    /// Writes the state within the last step.
    fn interpolate<S: Ode>(&self, march: &March<S>, t: f64, y: &mut [f64]);

    /// Writes its time derivative.
    fn interpolate_slope<S: Ode>(&self, march: &March<S>, t: f64, ydot: &mut [f64]);

    /// Degree in time of the state within a step.
    fn interpolant_degree(&self) -> u32;

    /// A warning about the steps, as [`Integrator::notice`](super::Integrator::notice).
    fn notice(&self) -> Option<String> {
        None
    }

    /// [`Integrator::bounding_rate`](super::Integrator::bounding_rate).
    fn bounding_rate(&self) -> Option<f64> {
        None
    }
}
