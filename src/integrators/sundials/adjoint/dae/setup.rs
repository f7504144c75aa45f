//! Building an adjoint gradient.

use super::system::AdjointDae;
use crate::integrators::{
    common::{Error, check_finite, check_length, check_start, check_time},
    ode::{Borrowed, Dae, Functional},
    sundials::{
        IdaOptions, InitialCondition,
        adjoint::{
            gradient::Gradient,
            options::AdjointOptions,
            setup::{AdjointOf, Along, Runs},
        },
        ida::{IdaKind, StartsDae},
        session::Session,
    },
};

/// Gradients of a [`Functional`] of the solution of F(t, y, y', p) = 0, by the adjoint method.
///
/// They are taken with respect to any number of parameters and to the differential unknowns of the initial
/// state, as by [`Adjoint`](crate::integrators::sundials::Adjoint) for an ODE: by a forward run with
/// checkpoints and a backward run of the adjoint lambda, (dF/dy')^T lambda' = (dF/dy)^T lambda - dh/dy. For
/// F = y' - f this lambda is dG/dy(t).
///
/// The equations have to be of index 1 with a constant dF/dy' (which may depend on parameters), and be
/// separated: as many of them as there are algebraic unknowns contain no derivatives, and the others contain
/// derivatives of differential unknowns only. Rows may be in any order.
///
/// ```
/// use pliant::{
///     ode::{Failure, Functional, Slopes, dae_with_parameters},
///     sundials::{AdjointOptions, DaeAdjoint, IdaOptions},
/// };
///
/// /// The algebraic unknown at the end.
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
///             slopes.y[1] = 1.0;
///         }
///         Ok(y[1])
///     }
/// }
///
/// // y' = -z, 0 = z - p y: z = p exp(-p t)
/// let decay = dae_with_parameters(
///     |_t, y, yp, p, residual| {
///         residual[0] = yp[0] + y[1];
///         residual[1] = y[1] - p[0] * y[0];
///         Ok(())
///     },
///     [2.0],
/// );
/// let forward = IdaOptions::new(1e-8, 1e-10).differential([true, false]);
/// let back = AdjointOptions::new(1e-8, 1e-10);
/// let (y0, yp0) = ([1.0, 0.0], [0.0, 0.0]);
/// let gradient = DaeAdjoint::new(decay, End, 0.0, &y0, &yp0, &forward, &back)?.gradient(1.0)?;
/// let decayed = (-2f64).exp();
/// assert!((gradient.value - 2.0 * decayed).abs() < 1e-6);
/// assert!((gradient.parameters[0] - (1.0 - 2.0) * decayed).abs() < 1e-6);
/// assert!((gradient.initial_state[0] - 2.0 * decayed).abs() < 1e-6);
/// # Ok::<(), pliant::sundials::Error>(())
/// ```
///
/// User guide: chapter "Using IDAS for Adjoint Sensitivity Analysis".
pub type DaeAdjoint<S, F> = AdjointOf<IdaOptions, S, F>;

type Equations<'a> = AdjointDae<Borrowed<'a, dyn Dae + 'a>, Borrowed<'a, dyn Functional + 'a>>;

impl Runs<IdaOptions> {
    fn equations<'a>(
        &self,
        system: &'a mut (dyn Dae + 'a),
        functional: &'a mut (dyn Functional + 'a),
    ) -> Result<Equations<'a>, Error> {
        let (t0, y0, yp0) = &self.start;
        let (system, functional) = (Borrowed(system), Borrowed(functional));
        let forward = self.forward.for_adjoint(y0)?;
        let mut equations = AdjointDae::new(system, functional, y0.len(), forward, &self.options)?;
        equations.start((*t0, y0, yp0))?;
        Ok(equations)
    }

    /// For one run.
    fn session<'e, 'a>(
        &self,
        equations: &'e mut Equations<'a>,
    ) -> Result<Session<IdaKind, Borrowed<'e, Equations<'a>>>, Error> {
        let (t0, y0, yp0) = &self.start;
        Session::of_ida(Borrowed(equations), *t0, (y0, yp0), &self.forward)
    }

    /// Finds inputs that cannot be used.
    fn check(&self, system: &mut dyn Dae, functional: &mut dyn Functional) -> Result<(), Error> {
        self.session(&mut self.equations(system, functional)?)?;
        Ok(())
    }

    fn gradient(
        &self,
        system: &mut dyn Dae,
        functional: &mut dyn Functional,
        t: f64,
        along: Along<'_>,
    ) -> Result<Gradient, Error> {
        let mut equations = self.equations(system, functional)?;
        let mut session = self.session(&mut equations)?;
        session.consistent_start(InitialCondition::Algebraic, t)?;
        session.gradient(t, &self.options, along)
    }
}

impl<S: Dae, F: Functional> DaeAdjoint<S, F> {
    /// For the solution that starts at time `t0` from the differential unknowns of `y0`.
    ///
    /// `forward` are the options of the forward run, which have to say which unknowns are
    /// [differential](IdaOptions::differential); `options` are those of the backward run. The algebraic
    /// unknowns and `yp0` are guesses: they follow from the equations and their parameters, as with
    /// [`InitialCondition::Algebraic`](crate::integrators::sundials::InitialCondition::Algebraic).
    ///
    /// # Errors
    /// [`Error::Input`] for options or initial values that cannot be used, for equations without the required
    /// form, and for systems with root functions, as lambda jumps at an event. [`Error::Integration`] where
    /// the equations fail at the start.
    ///
    /// # Panics
    /// A panic of the system passes through.
    pub fn new(
        system: S,
        functional: F,
        t0: f64,
        y0: &[f64],
        yp0: &[f64],
        forward: &IdaOptions,
        options: &AdjointOptions,
    ) -> Result<Self, Error> {
        check_start(t0, y0)?;
        check_length("length of yp0", yp0.len(), y0.len())?;
        check_finite("yp0", yp0)?;
        let sizes = (system.parameters().len(), system.root_count());
        let runs = Runs::new((t0, y0, yp0), forward, options, sizes)?;
        let mut adjoint = Self { system, functional, runs };
        adjoint.runs.check(&mut adjoint.system, &mut adjoint.functional)?;
        Ok(adjoint)
    }

    /// Value and gradient of the functional at the end time T = `t`.
    ///
    /// Each call integrates again, with the present parameters of the [system](Self::system_mut).
    ///
    /// # Errors
    /// [`Error::Integration`] if the forward or the backward run stopped, with the reason, such as a dF/dy'
    /// that is not constant; [`Error::Input`] if `t` is not finite or not later than the start.
    ///
    /// # Panics
    /// A panic of the system or the functional passes through.
    pub fn gradient(&mut self, t: f64) -> Result<Gradient, Error> {
        self.gradient_along(t, &[], |_, _| ())
    }

    /// As [`gradient`](Self::gradient), and calls `visit(t, lambda)` at each of the `times` of the backward run, which
    /// lead from the end to the start (`IDAGetB`).
    ///
    /// (dF/dy')^T lambda at time t is the derivative of G with respect to the differential unknowns at that time.
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
        let t0 = self.runs.start.0;
        if t <= t0 {
            let help = format!(
                "it is later than the start, {t0:?}: IDAS has no way back from an earlier time, for which the equations \
                 can be written in -t"
            );
            return Err(Error::input("end time", t, help));
        }
        let along = Along { times, visit: &mut visit };
        along.check(self.runs.start.0, t)?;
        self.runs.gradient(&mut self.system, &mut self.functional, t, along)
    }
}
