//! The forward run with checkpoints and the backward run, for CVODES and IDAS.

use super::options::AdjointOptions;
use crate::integrators::{
    common::{AbsoluteTolerance, Cause, Error, IntegrationError, Tolerances},
    sundials::{
        auxiliary::Backward, ffi, functions::BackwardFunctions, linear::Linear, session::Session,
        vector::Vector,
    },
};

/// The return code of a C function, with its name.
pub(super) type Called = (&'static str, i32);

/// The C functions that register callbacks of the backward run; they differ between CVODES and IDAS.
pub(super) struct Callbacks<I, J, Q> {
    /// Starts from lambda and lambda'; the latter is null for an ODE.
    pub(super) init: I,
    pub(super) set_jacobian: J,
    /// Takes the initial values of the integrals, which are zero.
    pub(super) init_quadratures: Q,
}

impl<K, S> Session<K, S> {
    /// Makes the forward run keep checkpoints.
    ///
    /// # Safety
    /// The functions belong to this integrator.
    pub(super) unsafe fn keep_checkpoints(
        &mut self,
        functions: &BackwardFunctions,
        options: &AdjointOptions,
    ) -> Result<(), Error> {
        let steps = i64::from(options.checkpoint_steps);
        let (name, init) = functions.init_checkpoints;
        // SAFETY: the memory is alive, and the caller vouches for the function; the values are plain numbers.
        let code = unsafe { init(self.memory.raw, steps, ffi::CV_HERMITE) };
        self.host.accept(name, code)?;
        self.memory.functions = functions.forward;
        Ok(())
    }

    /// Makes the backward problem, which starts from `lambda` (and `slope`, for a DAE).
    ///
    /// # Safety
    /// The functions belong to this integrator, `linear` is made for `lambda`, and the callbacks fit the
    /// host.
    pub(super) unsafe fn start_back(
        &mut self,
        functions: &'static BackwardFunctions,
        linear: Linear,
        (lambda, slope): (Vector, Option<Vector>),
        (options, parameters): (&AdjointOptions, &[f64]),
        callbacks: Callbacks<
            impl FnOnce(i32, ffi::N_Vector, ffi::N_Vector) -> Called,
            impl FnOnce(i32) -> Called,
            impl FnOnce(i32, ffi::N_Vector) -> Called,
        >,
    ) -> Result<(), Error> {
        let (memory, data, context) = (self.memory.raw, self.host.as_ptr(), &self.context);
        let (n, count) = (lambda.as_slice().len(), parameters.len());
        let mut which = 0;
        let (name, create) = functions.create;
        // SAFETY: the memory is alive, the result pointer is valid.
        let code = unsafe { create(memory, &raw mut which) };
        self.host.accept(name, code)?;
        let zeros = vec![0.0; count];
        let gradient = (count > 0).then(|| Vector::from_slice(&zeros, context)).transpose()?;
        let Tolerances { rtol, atol } = &options.tolerances;
        let atol = Vector::from_slice(&spread(atol, n), context)?;
        let max_steps = i64::from(self.max_steps);
        let backward =
            self.backward.insert(Backward { functions, which, linear, lambda, slope, gradient });
        let (solver, matrix) = (backward.linear.solver(), backward.linear.matrix());
        let (start, slope) = (backward.lambda.raw(), backward.raw_slope());
        let integrals = backward.gradient.as_ref().map(Vector::raw);
        let (tolerances, set_tolerances) = functions.vector_tolerances;
        let (user_data, set_user_data) = functions.set_user_data;
        let (most_steps, set_max_steps) = functions.set_max_steps;
        let (linear_solver, set_linear_solver) = functions.set_linear_solver;
        self.accept((callbacks.init)(which, start, slope))?;
        // SAFETY: the memory is alive and has this problem; it copies vectors, the linear solver lives
        // longer than it, and the host is the data of its callbacks.
        let codes = unsafe {
            [
                (tolerances, set_tolerances(memory, which, *rtol, atol.raw())),
                (user_data, set_user_data(memory, which, data)),
                (most_steps, set_max_steps(memory, which, max_steps)),
                (linear_solver, set_linear_solver(memory, which, solver, matrix)),
            ]
        };
        codes.into_iter().try_for_each(|called| self.accept(called))?;
        self.accept((callbacks.set_jacobian)(which))?;
        let Some(integrals) = integrals else { return Ok(()) };
        self.accept((callbacks.init_quadratures)(which, integrals))?;
        let Tolerances { rtol, atol } = options.tolerances_for(parameters);
        let atol = Vector::from_slice(&spread(&atol, count), &self.context)?;
        let (error_control, set_error_control) = functions.set_quadrature_error_control;
        let (tolerances, set_tolerances) = functions.quadrature_tolerances;
        // SAFETY: as above.
        let codes = unsafe {
            [
                (error_control, set_error_control(memory, which, 1)),
                (tolerances, set_tolerances(memory, which, rtol, atol.raw())),
            ]
        };
        codes.into_iter().try_for_each(|called| self.accept(called))
    }

    fn accept(&mut self, (name, code): Called) -> Result<(), Error> {
        self.host.accept(name, code)
    }

    /// Integrates back to `t0`, and adds the integrals to `parameters`. Lambda stays in the backward problem.
    pub(super) fn run_back(&mut self, t0: f64, parameters: &mut [f64]) -> Result<(), Error> {
        let memory = self.memory.raw;
        let Some(backward) = &self.backward else { return Ok(()) };
        let (functions, which) = (backward.functions, backward.which);
        let (lambda, slope) = (backward.lambda.raw(), backward.raw_slope());
        let gradient = backward.gradient.as_ref().map(Vector::raw);
        self.host.get_mut().troubles.clear();
        // SAFETY: memory and everything registered with it are alive; `&mut self` keeps others away while
        // callbacks use the host.
        let code = unsafe { (functions.solve)(memory, t0, ffi::CV_NORMAL) };
        self.host.get_mut().troubles.resume_panic();
        if code < 0 {
            return Err(self.stopped_back((functions, which), code, t0));
        }
        let mut t = 0.0;
        let (name, get) = functions.get;
        // SAFETY: memory and vectors are alive, the result pointers are valid.
        let code = unsafe { get(memory, which, &raw mut t, lambda, slope) };
        self.accept((name, code))?;
        let Some(gradient) = gradient else { return Ok(()) };
        let (name, get) = functions.get_quadratures;
        // SAFETY: as above.
        let code = unsafe { get(memory, which, &raw mut t, gradient) };
        self.accept((name, code))?;
        let integrals = self.backward.as_ref().and_then(|backward| backward.gradient.as_ref());
        let pairs = parameters.iter_mut().zip(integrals.map_or(&[][..], Vector::as_slice));
        pairs.for_each(|(slope, integral)| *slope += integral);
        Ok(())
    }

    /// The error of a backward run to `t0` that stopped.
    fn stopped_back(
        &mut self,
        (functions, which): (&BackwardFunctions, i32),
        code: i32,
        t0: f64,
    ) -> Error {
        let (mut t, mut step, mut order) = (f64::NAN, f64::NAN, 0);
        // SAFETY: the memory is alive; that of the backward problem belongs to it, and the result pointers
        // are valid.
        unsafe {
            let memory = (functions.get_memory)(self.memory.raw, which);
            (functions.get_current_time)(memory, &raw mut t);
            (functions.forward.get_current_step)(memory, &raw mut step);
            (functions.get_current_order)(memory, &raw mut order);
        }
        let (otherwise, blame_retries) = match code {
            ffi::CV_TOO_MUCH_WORK => {
                let steps = u64::from(self.max_steps);
                (Cause::TooManySteps { steps, target: t0, notice: None }, true)
            }
            ffi::CV_TOO_MUCH_ACC => (Cause::TooMuchAccuracy, false),
            ffi::CV_ERR_FAILURE => (Cause::ErrorTest, false),
            ffi::CV_CONV_FAILURE => (Cause::Convergence, true),
            ffi::CV_LINIT_FAIL | ffi::CV_LSETUP_FAIL | ffi::CV_LSOLVE_FAIL => {
                (Cause::LinearSolver, true)
            }
            _ => (Cause::Other, true),
        };
        let troubles = &mut self.host.get_mut().troubles;
        let message = format!("SUNDIALS, code {code}: {}", troubles.message());
        let (cause, source) = troubles.cause((t, step), blame_retries, otherwise);
        let integrator = functions.integrator;
        let order = order as u32;
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
