//! The run forward and the way back.

use super::{
    callbacks::{jacobian, quadratures, rhs},
    options::AdjointOptions,
    system::AdjointSystem,
};
use crate::{
    integrate::{
        AbsoluteTolerance, Callback, Cause, Error, IntegrationError, Integrator, Tolerances,
        check_finite,
    },
    ode::{Borrowed, Failure, Functional, Ode, Slopes},
    sundials::{
        Cvode, CvodeOptions, beside::Backward, cvode::WITH_CHECKPOINTS, ffi, linear::Linear,
        vector::Vector,
    },
};

/// A functional G = g(T, y(T), p) + integral of h(t, y, p) and what it changes by.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient {
    /// G.
    pub value: f64,
    /// dG/dp, for all parameters of the system.
    pub parameters: Vec<f64>,
    /// dG/dy0, by the initial state; where that depends on parameters, it adds (dy0/dp)^T dG/dy0 to dG/dp.
    pub initial_state: Vec<f64>,
}

/// The solver of one run forward and back. A further one would begin with the first step of this one, whatever
/// has changed: the way back leaves it in C (6.4.1).
pub(super) struct Run<'a, S, F> {
    solver: Cvode<Borrowed<'a, AdjointSystem<S, F>>>,
    options: &'a AdjointOptions,
    t0: f64,
}

impl<'a, S: Ode, F: Functional> Run<'a, S, F> {
    pub(super) fn new(
        system: &'a mut AdjointSystem<S, F>,
        (t0, y0): &(f64, Vec<f64>),
        forward: &CvodeOptions,
        options: &'a AdjointOptions,
    ) -> Result<Self, Error> {
        system.start();
        let mut solver = Cvode::new(Borrowed(system), *t0, y0, forward)?;
        let steps = i64::from(options.checkpoint_steps);
        // SAFETY: the memory is alive; the values are plain numbers.
        let code = unsafe { ffi::CVodeAdjInit(solver.memory.raw, steps, ffi::CV_HERMITE) };
        solver.host.accept("CVodeAdjInit", code)?;
        solver.memory.functions = &WITH_CHECKPOINTS;
        Ok(Self { solver, options, t0: *t0 })
    }

    /// Runs to time `t` and back.
    pub(super) fn gradient(mut self, t: f64) -> Result<Gradient, Error> {
        // there may be a jump behind
        self.solver.set_stop_time(Some(t))?;
        self.solver.solve_to(t)?;
        let mut gradient = self.terminal(t)?;
        gradient.value += self.solver.quadratures()[0];
        self.back(t, &mut gradient)?;
        Ok(gradient)
    }

    /// Adds what the way back from time `t` gives to the derivatives of g.
    fn back(&mut self, t: f64, gradient: &mut Gradient) -> Result<(), Error> {
        self.start_back(t, &gradient.initial_state)?;
        self.run_back()?;
        let Some(backward) = &self.solver.backward else { return Ok(()) };
        if let Some(integrals) = &backward.gradient {
            let pairs = gradient.parameters.iter_mut().zip(integrals.as_slice());
            pairs.for_each(|(slope, integral)| *slope += integral);
        }
        gradient.initial_state.copy_from_slice(backward.lambda.as_slice());
        Ok(())
    }

    /// g(T, y, p), and its derivatives by p and by y at the end.
    fn terminal(&mut self, t: f64) -> Result<Gradient, Error> {
        let y = self.solver.y().to_vec();
        let adjoint = &mut *self.solver.host.get_mut().system.0;
        let p = adjoint.system.parameters();
        let (mut by_y, mut by_p) = (vec![0.0; y.len()], vec![0.0; p.len()]);
        let slopes = Slopes { y: &mut by_y, p: &mut by_p };
        let value = adjoint
            .functional
            .terminal(t, &y, p, Some(slopes))
            .map_err(|failure| self.refused(t, failure))?;
        check_finite("terminal functional", &[value])?;
        check_finite("terminal slopes by y", &by_y)?;
        check_finite("terminal slopes by p", &by_p)?;
        Ok(Gradient { value, parameters: by_p, initial_state: by_y })
    }

    /// The error of a functional that has no value at the end.
    fn refused(&self, t: f64, failure: Failure) -> Error {
        IntegrationError {
            integrator: "CVODE",
            cause: Cause::Fatal(Callback::Adjoint),
            t,
            step: 0.0,
            order: 0,
            message: String::new(),
            source: Some(failure.into_error()),
        }
        .into()
    }

    /// Makes the backward problem, which starts at time `t` from `lambda`.
    fn start_back(&mut self, t: f64, lambda: &[f64]) -> Result<(), Error> {
        let (memory, data) = (self.solver.memory.raw, self.solver.host.as_ptr());
        let context = &self.solver.context;
        let mut which = 0;
        // SAFETY: the memory is alive, the result has a place.
        let code = unsafe { ffi::CVodeCreateB(memory, ffi::CV_BDF, &raw mut which) };
        self.solver.host.accept("CVodeCreateB", code)?;
        let lambda = Vector::from_slice(lambda, context)?;
        let adjoint = &*self.solver.system().0;
        let kind = adjoint.backward.clone();
        let count = adjoint.system.parameters().len();
        let n = self.solver.y().len();
        // SAFETY: the data is the host, which outlives the solver.
        let linear = unsafe {
            Linear::new::<Borrowed<'a, AdjointSystem<S, F>>>(&kind, &lambda, context, data)?
        };
        let zeros = vec![0.0; count];
        let gradient = (count > 0).then(|| Vector::from_slice(&zeros, context)).transpose()?;
        let (start, integrals) = (lambda.raw(), gradient.as_ref().map(Vector::raw));
        let (solver, matrix) = (linear.solver(), linear.matrix());
        self.solver.backward = Some(Backward { which, _linear: linear, lambda, gradient });
        let Tolerances { rtol, atol } = &self.options.tolerances;
        let atol = Vector::from_slice(&spread(atol, n), context)?;
        let max_steps = i64::from(self.solver.max_steps);
        // SAFETY: the memory is alive and has this problem; it copies vectors, the linear solver lives
        // longer than it, and callbacks fit the host that is their data.
        let codes = unsafe {
            [
                ("CVodeInitB", ffi::CVodeInitB(memory, which, Some(rhs::<S, F>), t, start)),
                ("CVodeSVtolerancesB", ffi::CVodeSVtolerancesB(memory, which, *rtol, atol.raw())),
                ("CVodeSetUserDataB", ffi::CVodeSetUserDataB(memory, which, data)),
                ("CVodeSetMaxNumStepsB", ffi::CVodeSetMaxNumStepsB(memory, which, max_steps)),
                (
                    "CVodeSetLinearSolverB",
                    ffi::CVodeSetLinearSolverB(memory, which, solver, matrix),
                ),
                ("CVodeSetJacFnB", ffi::CVodeSetJacFnB(memory, which, Some(jacobian::<S, F>))),
            ]
        };
        for (name, code) in codes {
            self.solver.host.accept(name, code)?;
        }
        let Some(integrals) = integrals else { return Ok(()) };
        // SAFETY: as above.
        let code =
            unsafe { ffi::CVodeQuadInitB(memory, which, Some(quadratures::<S, F>), integrals) };
        self.solver.host.accept("CVodeQuadInitB", code)?;
        let Tolerances { rtol, atol } =
            self.options.tolerances_for(self.solver.system().0.system.parameters());
        let atol = Vector::from_slice(&spread(&atol, count), &self.solver.context)?;
        // SAFETY: as above.
        let codes = unsafe {
            [
                ("CVodeSetQuadErrConB", ffi::CVodeSetQuadErrConB(memory, which, 1)),
                (
                    "CVodeQuadSVtolerancesB",
                    ffi::CVodeQuadSVtolerancesB(memory, which, rtol, atol.raw()),
                ),
            ]
        };
        for (name, code) in codes {
            self.solver.host.accept(name, code)?;
        }
        Ok(())
    }

    /// Integrates back to the start.
    fn run_back(&mut self) -> Result<(), Error> {
        let (memory, t0) = (self.solver.memory.raw, self.t0);
        let Some(backward) = &self.solver.backward else { return Ok(()) };
        let which = backward.which;
        let (lambda, gradient) = (backward.lambda.raw(), backward.gradient.as_ref());
        let gradient = gradient.map(Vector::raw);
        self.solver.host.get_mut().troubles.clear();
        // SAFETY: memory and everything registered with it are alive; `&mut self` keeps others away while
        // callbacks use the host.
        let code = unsafe { ffi::CVodeB(memory, t0, ffi::CV_NORMAL) };
        self.solver.host.get_mut().troubles.resume_panic();
        if code < 0 {
            return Err(self.stopped_back(code));
        }
        let mut t = 0.0;
        // SAFETY: memory and vectors are alive, the results have their places.
        let code = unsafe { ffi::CVodeGetB(memory, which, &raw mut t, lambda) };
        self.solver.host.accept("CVodeGetB", code)?;
        let Some(gradient) = gradient else { return Ok(()) };
        // SAFETY: as above.
        let code = unsafe { ffi::CVodeGetQuadB(memory, which, &raw mut t, gradient) };
        self.solver.host.accept("CVodeGetQuadB", code)
    }

    /// Why the way back ended.
    fn stopped_back(&mut self, code: i32) -> Error {
        let which = self.solver.backward.as_ref().map_or(0, |backward| backward.which);
        let (mut t, mut step, mut order) = (f64::NAN, f64::NAN, 0);
        // SAFETY: the memory is alive; that of the backward problem belongs to it, and the results have their places.
        unsafe {
            let memory = ffi::CVodeGetAdjCVodeBmem(self.solver.memory.raw, which);
            ffi::CVodeGetCurrentTime(memory, &raw mut t);
            ffi::CVodeGetCurrentStep(memory, &raw mut step);
            ffi::CVodeGetCurrentOrder(memory, &raw mut order);
        }
        let (otherwise, blame_retries) = match code {
            ffi::CV_TOO_MUCH_WORK => {
                let steps = u64::from(self.solver.max_steps);
                (Cause::TooManySteps { steps, target: self.t0, notice: None }, true)
            }
            ffi::CV_TOO_MUCH_ACC => (Cause::TooMuchAccuracy, false),
            ffi::CV_ERR_FAILURE => (Cause::ErrorTest, false),
            ffi::CV_CONV_FAILURE => (Cause::Convergence, true),
            ffi::CV_LINIT_FAIL | ffi::CV_LSETUP_FAIL | ffi::CV_LSOLVE_FAIL => {
                (Cause::LinearSolver, true)
            }
            _ => (Cause::Other, true),
        };
        let troubles = &mut self.solver.host.get_mut().troubles;
        let message = format!("SUNDIALS, code {code}: {}", troubles.message());
        let (cause, source) = troubles.cause((t, step), blame_retries, otherwise);
        let integrator = "CVODE on the way back";
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
