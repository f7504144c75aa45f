//! The forward run with checkpoints and the backward run, for CVODES and IDAS.

use super::{
    equations::{Equations, refused},
    gradient::Gradient,
    options::AdjointOptions,
    setup::Along,
};
use crate::integrators::{
    common::{AbsoluteTolerance, Error, IntegrationError, Integrator, Tolerances},
    ode::{Borrowed, Failure, Functional},
    sundials::{
        auxiliary::Backward,
        context::Context,
        differences::Differences,
        ffi,
        functions::{BackwardFunctions, InitBackward, InitBackwardQuadratures, SetBackward},
        linear::Linear,
        quadratures::CarriesIntegrals,
        report::cause_of,
        session::Session,
        vector::Vector,
    },
};

/// Time, state and its time derivative, which is empty for an ODE.
pub(super) type Point<'a> = (f64, &'a [f64], &'a [f64]);

/// A system with a functional, and the differences between the backward runs of an ODE and of a DAE.
///
/// # Safety
/// The functions are those of the integrator of this kind, and the callbacks that they register fit a host
/// with this system, [`Borrowed`].
pub(in crate::integrators::sundials) unsafe trait BackwardProblem {
    type Kind;
    type System;
    type Functional: Functional;

    const FUNCTIONS: &'static BackwardFunctions;
    const INIT: InitBackward;
    const SET_JACOBIAN: SetBackward;
    const INIT_QUADRATURES: InitBackwardQuadratures;

    fn equations(&mut self) -> &mut Equations<Self::System, Self::Functional>;

    /// Lambda, and lambda' of a DAE, where the backward run starts: from the slopes of g in `end`, whose dG/dp
    /// it may change. `linear` is the linear solver of that run.
    fn start_back(
        &mut self,
        at: Point<'_>,
        end: &mut Gradient,
        linear: &mut Linear,
        context: &Context,
    ) -> Result<(Vector, Option<Vector>), Error>;

    /// Writes dG/dy0 for the lambda at the start.
    fn by_initial_state(&mut self, lambda: &[f64], out: &mut [f64]) -> Result<(), Failure>;
}

impl<P: BackwardProblem> Session<P::Kind, Borrowed<'_, P>> {
    /// Value and gradient of the functional, by a run to time `t` and back, `along` which lambda is shown.
    ///
    /// A further run would begin with the first step size of this one, whatever has changed: the backward run
    /// leaves it in C (6.4.1).
    pub(super) fn gradient(
        mut self,
        t: f64,
        options: &AdjointOptions,
        along: Along<'_>,
    ) -> Result<Gradient, Error> {
        let (memory, steps) = (self.memory.raw, i64::from(options.checkpoint_steps));
        // As late as possible: if no run follows, IDAS 6.4.1 frees pointers that it never wrote.
        // SAFETY: the memory is alive and of this integrator; the values are plain numbers.
        self.host.call(P::FUNCTIONS.init_checkpoints, |init| unsafe {
            init(memory, steps, ffi::CV_HERMITE)
        })?;
        self.solve = P::FUNCTIONS.solve_forward;
        self.host.get_mut().differences.iter_mut().for_each(Differences::make_repeatable);
        // steps must not pass `t`: the equations may jump there
        self.set_stop_time(Some(t))?;
        self.solve_to(t)?;
        let equations = self.host.get_mut().system.0.equations();
        let integrator = self.memory.functions.integrator;
        let mut gradient = equations.terminal(integrator, t, self.y.as_slice())?;
        gradient.value += self.quadratures()[0];
        self.start_back(t, &mut gradient, options)?;
        self.run_back(t, &mut gradient, along)?;
        Ok(gradient)
    }

    /// Makes the backward problem, which starts at time `t` from the slopes of g in `end`.
    fn start_back(
        &mut self,
        t: f64,
        end: &mut Gradient,
        options: &AdjointOptions,
    ) -> Result<(), Error> {
        let (functions, elapsed) = (P::FUNCTIONS, self.elapsed);
        let (memory, data, context) = (self.memory.raw, self.host.as_ptr(), &self.context);
        let system = &mut self.host.get_mut().system.0;
        let parameters = system.equations().parameters().to_vec();
        let (n, count) = (self.y.as_slice().len(), parameters.len());
        // SAFETY: the data is the host, which outlives the solver.
        let mut linear = unsafe {
            Linear::new::<Borrowed<'_, P>>(&system.equations().backward, &self.y, context, data)?
        };
        let at = (t, self.y.as_slice(), self.yp.as_ref().map_or(&[][..], Vector::as_slice));
        let (lambda, slope) = system.start_back(at, end, &mut linear, context)?;
        let mut which = 0;
        // SAFETY: the memory is alive, the result pointer is valid.
        self.host.call(functions.create, |create| unsafe { create(memory, &raw mut which) })?;
        let zeros = vec![0.0; count];
        let gradient = (count > 0).then(|| Vector::from_slice(&zeros, context)).transpose()?;
        let Tolerances { rtol, atol } = &options.tolerances;
        let atol = Vector::from_slice(&spread(atol, n), context)?;
        let max_steps = i64::from(self.max_steps);
        let solver_kind = self.host.get_mut().system.0.equations().backward.clone();
        let backward = self.backward.insert(Backward { which, linear, lambda, slope, gradient });
        let (solver, matrix) = (backward.linear.solver(), backward.linear.matrix());
        let (lambda, slope) = (backward.lambda.raw(), backward.raw_slope());
        let integrals = backward.gradient.as_ref().map(Vector::raw);
        let host = &mut self.host;
        // SAFETY: the memory is alive and has this problem; it copies vectors, the linear solver lives longer
        // than it, and the host, which the callbacks fit, is their data.
        unsafe {
            host.call(P::INIT, |init| init(memory, which, elapsed, lambda, slope))?;
            host.call(functions.vector_tolerances, |set| set(memory, which, *rtol, atol.raw()))?;
            host.call(functions.set_user_data, |set| set(memory, which, data))?;
            host.call(functions.set_max_steps, |set| set(memory, which, max_steps))?;
            host.call(functions.set_linear_solver, |set| set(memory, which, solver, matrix))?;
            host.call(P::SET_JACOBIAN, |set| set(memory, which, &solver_kind))?;
        }
        let Some(integrals) = integrals else { return Ok(()) };
        let Tolerances { rtol, atol } = options.tolerances_for(&parameters);
        let atol = Vector::from_slice(&spread(&atol, count), context)?;
        // SAFETY: as above.
        unsafe {
            host.call(P::INIT_QUADRATURES, |init| init(memory, which, integrals))?;
            host.call(functions.set_quadrature_error_control, |set| set(memory, which, 1))?;
            host.call(functions.quadrature_tolerances, |set| set(memory, which, rtol, atol.raw()))
        }
    }

    /// Integrates back from time `end` to the start, adds the integrals to dG/dp, and writes dG/dy0.
    fn run_back(
        &mut self,
        end: f64,
        gradient: &mut Gradient,
        Along { times, visit }: Along<'_>,
    ) -> Result<(), Error> {
        let (clock, begin) = (self.clock(), self.clock().start());
        let start = clock.time(begin);
        self.host.get_mut().troubles.clear();
        for &t in times {
            if t != end {
                self.go_back(if t == start { begin } else { clock.elapsed(t) })?;
            }
            self.backward.iter().for_each(|backward| visit(t, backward.lambda.as_slice()));
        }
        if times.last() != Some(&start) {
            self.go_back(begin)?;
        }
        let Some(backward) = &self.backward else { return Ok(()) };
        let (memory, functions, which) = (self.memory.raw, P::FUNCTIONS, backward.which);
        let mut t = 0.0;
        let lambda = backward.lambda.as_slice();
        let system = &mut self.host.get_mut().system.0;
        let by_state = system.by_initial_state(lambda, &mut gradient.initial_state);
        by_state.map_err(|failure| refused(functions.integrator, start, failure))?;
        let Some(integrals) = &backward.gradient else { return Ok(()) };
        // SAFETY: as above.
        self.host.call(functions.get_quadratures, |get| unsafe {
            get(memory, which, &raw mut t, integrals.raw())
        })?;
        let pairs = gradient.parameters.iter_mut().zip(integrals.as_slice());
        pairs.for_each(|(slope, integral)| *slope += integral);
        Ok(())
    }

    /// Integrates back to time `t` of C, and reads lambda there.
    fn go_back(&mut self, t: f64) -> Result<(), Error> {
        let (memory, functions) = (self.memory.raw, P::FUNCTIONS);
        let Some(backward) = &self.backward else { return Ok(()) };
        let which = backward.which;
        // SAFETY: memory and everything registered with it are alive; `&mut self` keeps others away while
        // callbacks use the host.
        let code = unsafe { (functions.solve.1)(memory, t, ffi::CV_NORMAL) };
        self.host.get_mut().troubles.resume_panic();
        if code < 0 {
            return Err(self.stopped_back(which, code));
        }
        let mut reached = 0.0;
        let (lambda, slope) = (backward.lambda.raw(), backward.raw_slope());
        // SAFETY: memory and vectors are alive, the result pointer is valid.
        self.host.call(functions.get, |get| unsafe {
            get(memory, which, &raw mut reached, lambda, slope)
        })
    }

    /// The error of a backward run that stopped.
    fn stopped_back(&mut self, which: i32, code: i32) -> Error {
        let functions = P::FUNCTIONS;
        let (mut t, mut step, mut order) = (f64::NAN, f64::NAN, 0);
        // SAFETY: the memory is alive; that of the backward problem belongs to it, and the result pointers
        // are valid.
        unsafe {
            let memory = (functions.get_memory)(self.memory.raw, which);
            (functions.get_current_time.1)(memory, &raw mut t);
            (self.memory.functions.get_current_step.1)(memory, &raw mut step);
            (functions.get_current_order.1)(memory, &raw mut order);
        }
        let begin = self.clock().time(self.clock().start());
        let (otherwise, blame_retries) = cause_of(code, self.max_steps, begin);
        let troubles = &mut self.host.get_mut().troubles;
        let message = format!("SUNDIALS, code {code}: {}", troubles.message());
        let (cause, source) = troubles.cause((t, step), blame_retries, otherwise);
        let integrator = functions.integrator;
        let (order, t) = (order as u32, self.clock().time(t));
        IntegrationError { integrator, cause, t, step, order, message, source }.into()
    }
}

/// A tolerance for each of `n` numbers.
fn spread(atol: &AbsoluteTolerance, n: usize) -> Vec<f64> {
    match atol {
        AbsoluteTolerance::Scalar(atol) => vec![*atol; n],
        AbsoluteTolerance::Vector(atol) => atol.clone(),
    }
}
