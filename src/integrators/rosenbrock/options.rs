//! Options of the integrator.

use super::tableau::{RODASP2, ROS34PW2, Tableau};
use crate::base::input::InputError;
use crate::integrators::common::{AbsoluteTolerance, ExplicitOptions, step_options};
use crate::integrators::sundials::{Jacobian, LinearSolver};

/// Tolerances, method and limits of a [`Rosenbrock`](super::Rosenbrock).
///
/// ```
/// use pliant::rosenbrock::Options;
/// use pliant::sundials::{Jacobian, LinearSolver};
///
/// let solver = LinearSolver::Band { lower: 1, upper: 1, jacobian: Jacobian::DifferenceQuotients };
/// let options = Options::new(1e-6, 1e-9).order(3).newton(solver).max_step(0.1);
/// ```
#[derive(Clone, Debug)]
#[must_use]
pub struct Options {
    /// Tolerances and step sizes.
    pub(crate) forward: ExplicitOptions,
    pub(super) order: u32,
    pub(super) solver: LinearSolver,
    pub(super) trusts_jacobian: bool,
    pub(super) linear: bool,
    pub(super) steps_between_jacobians: u32,
}

impl Default for Options {
    /// Tolerances rtol 1e-6 and atol 1e-9.
    fn default() -> Self {
        Self::new(1e-6, 1e-9)
    }
}

impl Options {
    /// These tolerances, order 4, a dense matrix of difference quotients.
    ///
    /// Local errors are kept below `rtol |y_i| + atol_i` in the root mean square, the norm of CVODE. `rtol`
    /// is at least 1e-14, `atol` positive.
    pub fn new(rtol: f64, atol: impl Into<AbsoluteTolerance>) -> Self {
        let forward = ExplicitOptions::new(rtol, atol);
        let solver = LinearSolver::Dense(Jacobian::DifferenceQuotients);
        Self {
            forward,
            order: 4,
            solver,
            trusts_jacobian: false,
            linear: false,
            steps_between_jacobians: 1,
        }
    }

    /// Order of the method: 4 (RODASP2, the default) or 3 (ROS34PW2, which has its order with any matrix).
    pub fn order(mut self, order: u32) -> Self {
        self.order = order;
        self
    }

    /// Solver of the linear systems with the matrix I - gamma h df/dy, and source of df/dy: dense
    /// (the default, with difference quotients), of band form, sparse, or by the system's own `newton_setup`
    /// and `newton_solve`. A Krylov method cannot be used.
    pub fn newton(mut self, solver: LinearSolver) -> Self {
        self.solver = solver;
        self
    }

    /// As [`CvodeOptions::check_jacobian`](crate::integrators::sundials::CvodeOptions::check_jacobian):
    /// whether a Jacobian that the system supplies is compared with differences. Default: yes.
    pub fn check_jacobian(mut self, on: bool) -> Self {
        self.trusts_jacobian = !on;
        self
    }

    /// States that the Jacobian never changes: it is evaluated once, and I - gamma h df/dy is factorized only
    /// when the step size changes, which it then does less often.
    pub fn linear(mut self) -> Self {
        self.linear = true;
        self
    }

    /// Steps, at most, that one factorization serves after [`resume`](super::Integrator::resume), as long as the step size stays
    /// the same: for control loops, whose commands come at equal times. Default: 1. A step that fails with an old matrix is
    /// repeated with a new one. Above 1 the order has to be 3: that method has its order with any matrix.
    pub fn max_steps_between_jacobians(mut self, steps: u32) -> Self {
        self.steps_between_jacobians = steps;
        self
    }

    step_options!(forward.steps);

    /// Prescribed steps: as long as a stop time is set the step ends there, whatever its error estimate says. With the steps of an
    /// earlier integration the result is a smooth function of initial values and parameters. A step whose equations cannot be
    /// evaluated or solved is still divided.
    #[cfg(any(test, feature = "bodies"))]
    pub(crate) fn prescribed(mut self) -> Self {
        self.forward.prescribed = true;
        self
    }

    /// The method of that order.
    pub(super) fn tableau(&self) -> Result<&'static Tableau, InputError> {
        let steps = self.steps_between_jacobians;
        let refused = |help| Err(InputError::new("max_steps_between_jacobians", steps, help));
        match self.order {
            _ if steps == 0 => refused("give 1 or more"),
            4 if steps > 1 => {
                refused("order 4 takes the Jacobian of each step: give 1, or order 3")
            }
            3 => Ok(&ROS34PW2),
            4 => Ok(&RODASP2),
            order => Err(InputError::new("order", order, "there are methods of order 3 and 4")),
        }
    }
}
