//! Building an adjoint gradient.

use super::system::AdjointSystem;
use crate::base::input::InputError;
use crate::integrators::{
    common::{Error, check_start, check_time},
    ode::{Borrowed, Functional, Ode},
    sundials::{
        CvodeOptions,
        adjoint::{
            gradient::Gradient,
            options::AdjointOptions,
            setup::{AdjointOf, Along, Runs},
        },
        cvode::CvodeKind,
        session::Session,
    },
};

/// Gradients of a [`Functional`] of the solution of y' = f(t, y, p), by the adjoint method.
///
/// They are taken with respect to any number of parameters and to the initial state, by a forward run with
/// checkpoints and a backward run of the adjoint lambda, lambda' = -(df/dy)^T lambda - dh/dy from
/// lambda(T) = dg/dy.
///
/// ```
/// use pliant::{
///     ode::{Failure, Functional, Slopes, with_parameters},
///     sundials::{Adjoint, AdjointOptions, CvodeOptions},
/// };
///
/// /// The state at the end.
/// struct End;
///
/// impl Functional for End {
///     fn terminal(
///         &mut self,
///         _t: f64,
///         y: &[f64],
///         _p: &[f64],
///         slopes: Option<Slopes<'_>>,
///     ) -> Result<f64, Failure> {
///         if let Some(slopes) = slopes {
///             slopes.y[0] = 1.0;
///         }
///         Ok(y[0])
///     }
/// }
///
/// let decay = with_parameters(
///     |_t, y, p, ydot| {
///         ydot[0] = -p[0] * y[0];
///         Ok(())
///     },
///     [2.0],
/// );
/// let (forward, back) = (CvodeOptions::new(1e-8, 1e-10), AdjointOptions::new(1e-8, 1e-10));
/// let gradient = Adjoint::new(decay, End, 0.0, &[1.0], &forward, &back)?.gradient(1.0)?;
/// let exact = (-2f64).exp();
/// assert!((gradient.value - exact).abs() < 1e-6);
/// assert!((gradient.parameters[0] + exact).abs() < 1e-6);
/// assert!((gradient.initial_state[0] - exact).abs() < 1e-6);
/// # Ok::<(), pliant::sundials::Error>(())
/// ```
///
/// User guide: chapter "Using CVODES for Adjoint Sensitivity Analysis".
pub type Adjoint<S, F> = AdjointOf<CvodeOptions, S, F>;

type Equations<'a> = AdjointSystem<Borrowed<'a, dyn Ode + 'a>, Borrowed<'a, dyn Functional + 'a>>;

impl Runs<CvodeOptions> {
    fn equations<'a>(
        &self,
        system: &'a mut (dyn Ode + 'a),
        functional: &'a mut (dyn Functional + 'a),
    ) -> Result<Equations<'a>, InputError> {
        let (system, functional, n) = (Borrowed(system), Borrowed(functional), self.start.1.len());
        let forward = self.forward.for_adjoint(&self.start.1)?;
        AdjointSystem::new(system, functional, n, forward, &self.options)
    }

    /// For one run.
    fn session<'e, 'a>(
        &self,
        equations: &'e mut Equations<'a>,
    ) -> Result<Session<CvodeKind, Borrowed<'e, Equations<'a>>>, Error> {
        Session::of_cvode(Borrowed(equations), self.start.0, &self.start.1, &self.forward)
    }

    /// Finds inputs that cannot be used.
    fn check(&self, system: &mut dyn Ode, functional: &mut dyn Functional) -> Result<(), Error> {
        self.session(&mut self.equations(system, functional)?)?;
        Ok(())
    }

    fn gradient(
        &self,
        system: &mut dyn Ode,
        functional: &mut dyn Functional,
        t: f64,
        along: Along<'_>,
    ) -> Result<Gradient, Error> {
        self.session(&mut self.equations(system, functional)?)?.gradient(t, &self.options, along)
    }
}

impl<S: Ode, F: Functional> Adjoint<S, F> {
    /// For the solution that starts at time `t0` from `y0`, with options of the forward and of the backward
    /// run.
    ///
    /// # Errors
    /// [`Error::Input`] for options or initial values that cannot be used, and for systems with root
    /// functions, as lambda jumps at an event.
    pub fn new(
        system: S,
        functional: F,
        t0: f64,
        y0: &[f64],
        forward: &CvodeOptions,
        options: &AdjointOptions,
    ) -> Result<Self, Error> {
        check_start(t0, y0)?;
        let sizes = (system.parameters().len(), system.root_count());
        let runs = Runs::new((t0, y0, &[]), forward, options, sizes)?;
        let mut adjoint = Self { system, functional, runs };
        adjoint.runs.check(&mut adjoint.system, &mut adjoint.functional)?;
        Ok(adjoint)
    }

    /// Value and gradient of the functional at the end time T = `t`.
    ///
    /// Each call integrates again, with the present parameters of the [system](Self::system_mut).
    ///
    /// # Errors
    /// [`Error::Integration`] if the forward or the backward run stopped, with the reason; [`Error::Input`]
    /// if `t` is not finite or is the start.
    ///
    /// # Panics
    /// A panic of the system or the functional passes through.
    pub fn gradient(&mut self, t: f64) -> Result<Gradient, Error> {
        self.gradient_along(t, &[], |_, _| ())
    }

    /// As [`gradient`](Self::gradient), and calls `visit(t, lambda)` at each of the `times` of the backward run, which
    /// lead from the end to the start (`CVodeGetB`).
    ///
    /// Lambda at time t is the derivative of G with respect to the state y(t), for the equations from there on: what a push at
    /// that time changes.
    ///
    /// # Errors
    /// As for `gradient`, and for times that are not on that way.
    ///
    /// # Panics
    /// As for `gradient`.
    pub fn gradient_along(
        &mut self,
        t: f64,
        times: &[f64],
        mut visit: impl FnMut(f64, &[f64]),
    ) -> Result<Gradient, Error> {
        check_time("end time", t)?;
        if t == self.runs.start.0 {
            return Err(Error::input("end time", t, "it is another than the start"));
        }
        let along = Along { times, visit: &mut visit };
        along.check(self.runs.start.0, t)?;
        self.runs.gradient(&mut self.system, &mut self.functional, t, along)
    }
}
