//! Options of a solution, one set for all methods.

use std::time::Duration;

use crate::base::input::InputError;
use crate::integrators::{
    common::{AbsoluteTolerance, Tolerances, check_finite},
    sundials::{LinearSolver, Sensitivities, Sign},
};

/// Output that a [`Solution`](super::Solution) keeps.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Output {
    /// The ends of all steps, and the polynomials between them, for [`Solution::at`](super::Solution::at) any
    /// time. Its memory is that of the states times the order of the method at most.
    #[default]
    Steps,
    /// The states at these times, in the order of the run, and at its ends.
    Times(Vec<f64>),
    /// The states at the start and the end only.
    End,
}

/// Tolerances, limits and output, for any [`Method`](super::Method). An option that a method does not
/// have is an error.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[must_use]
pub struct Options {
    pub(super) tolerances: Tolerances,
    pub(super) linear_solver: Option<LinearSolver>,
    pub(super) initial_step: Option<f64>,
    pub(super) min_step: Option<f64>,
    pub(super) max_step: Option<f64>,
    pub(super) max_order: Option<u32>,
    pub(super) max_steps: u64,
    pub(super) max_evaluations: Option<u64>,
    pub(super) max_wall_time: Option<Duration>,
    pub(super) output: Output,
    pub(super) sensitivities: Option<Sensitivities>,
    pub(super) sign_constraints: Vec<Sign>,
    pub(super) project: bool,
    pub(super) check_jacobian: bool,
}

impl Options {
    /// These tolerances: local errors are kept below `rtol |y_i| + atol_i`, in the root mean square. One of the two may be 0, `atol` for
    /// unknowns that stay away from 0.
    pub fn new(rtol: f64, atol: impl Into<AbsoluteTolerance>) -> Self {
        Self {
            tolerances: Tolerances::new(rtol, atol),
            linear_solver: None,
            initial_step: None,
            min_step: None,
            max_step: None,
            max_order: None,
            max_steps: 100_000,
            max_evaluations: None,
            max_wall_time: None,
            output: Output::default(),
            sensitivities: None,
            sign_constraints: Vec::new(),
            project: false,
            check_jacobian: true,
        }
    }

    /// Linear solver for Newton's method. Default: with the Jacobian that an ODE supplies, if it states its
    /// form ([`Ode::supplied_jacobian`](crate::integrators::ode::Ode::supplied_jacobian)); else a dense matrix of difference quotients; for more than
    /// 500 unknowns a sparse one, if changes of the unknowns at the start show that few occur in each equation (and there is no mass
    /// matrix).
    ///
    /// A given pattern needs no search, and can include entries that are zero at the start: [`LinearSolver::Klu`].
    pub fn linear_solver(mut self, solver: LinearSolver) -> Self {
        self.linear_solver = Some(solver);
        self
    }

    /// Size of the first step, without sign. Default: estimated.
    pub fn initial_step(mut self, h: f64) -> Self {
        self.initial_step = Some(h);
        self
    }

    /// Lower bound of the step size. Default: none.
    pub fn min_step(mut self, h: f64) -> Self {
        self.min_step = Some(h);
        self
    }

    /// Upper bound of the step size. Default: none.
    pub fn max_step(mut self, h: f64) -> Self {
        self.max_step = Some(h);
        self
    }

    /// Highest order of a multistep method, or the order of a Rosenbrock method.
    pub fn max_order(mut self, order: u32) -> Self {
        self.max_order = Some(order);
        self
    }

    /// Steps of the whole run. Default: 100,000.
    pub fn max_steps(mut self, steps: u64) -> Self {
        self.max_steps = steps;
        self
    }

    /// Evaluations of the right-hand side or residual in the whole run, including those of difference
    /// quotients; checked after each step. Default: no limit.
    pub fn max_evaluations(mut self, evaluations: u64) -> Self {
        self.max_evaluations = Some(evaluations);
        self
    }

    /// Wall-clock time that the run may take, checked after each step. Default: no limit.
    pub fn max_wall_time(mut self, time: Duration) -> Self {
        self.max_wall_time = Some(time);
        self
    }

    /// Output that the solution keeps. Default: [`Output::Steps`].
    pub fn output(mut self, output: Output) -> Self {
        self.output = output;
        self
    }

    /// Also computes the derivatives dy/dp with respect to some parameters of the equations, by CVODE and
    /// IDA: [`Solution::sensitivities`](super::Solution::sensitivities).
    ///
    /// They are continued across events and breaks, those of a DAE if its [differential
    /// unknowns](super::Problem::differential) are known. An action is then called some more times, at states
    /// nearby, for its derivatives, also for those of parameters that it sets.
    ///
    /// Equations that switch by themselves, as by `if y[0] < 0.3`, need the condition as the function of an
    /// [`Event`](super::Event), with or without an action: the integrator then restarts where they jump. A
    /// jump elsewhere, unless its time is fixed, ends the run by [`Reason::Switch`](super::Reason::Switch)
    /// if steps become short there.
    pub fn sensitivities(mut self, sensitivities: Sensitivities) -> Self {
        self.sensitivities = Some(sensitivities);
        self
    }

    /// Inequality constraints: for each unknown the sign that it keeps, at the ends of steps; see
    /// [`CvodeOptions::sign_constraints`](crate::integrators::sundials::CvodeOptions::sign_constraints). For
    /// all methods except those of Dormand and Prince and of Rosenbrock. Default: none.
    pub fn sign_constraints(mut self, signs: impl Into<Vec<Sign>>) -> Self {
        self.sign_constraints = signs.into();
        self
    }

    /// Projects the state onto the invariants of the equations after each step, by
    /// [`Ode::project`](crate::integrators::ode::Ode::project). For BDF only. Default: off.
    pub fn project(mut self) -> Self {
        self.project = true;
        self
    }

    /// Whether a Jacobian that the equations supply is compared with differences of them, at a cost of a few
    /// evaluations; see
    /// [`CvodeOptions::check_jacobian`](crate::integrators::sundials::CvodeOptions::check_jacobian). Switch
    /// it off for one that is meant to be an approximation. Default: yes.
    pub fn check_jacobian(mut self, on: bool) -> Self {
        self.check_jacobian = on;
        self
    }

    /// Checks options that no integrator checks, for a run over `span`.
    pub(super) fn check(&self, span: (f64, f64)) -> Result<(), InputError> {
        if self.max_steps == 0 {
            return Err(InputError::new("max_steps", 0, "it is at least 1"));
        }
        if let Some(h) = self.initial_step
            && (h.is_nan() || h <= 0.0)
        {
            let help = "it is positive; the span tells the direction of time";
            return Err(InputError::new("initial_step", h, help));
        }
        if let Output::Times(times) = &self.output {
            check_finite("output times", times)?;
            let (start, end) = span;
            let sign = (end - start).signum();
            let mut last = start;
            for t in times {
                if (t - last) * sign < 0.0 || (end - t) * sign < 0.0 {
                    let help = format!("they go from {start} to {end} in order");
                    return Err(InputError::new("output times", t, help));
                }
                last = *t;
            }
        }
        Ok(())
    }
}
