//! The forward run and the backward run.

use super::{
    callbacks::{jacobian, quadratures, residual},
    end::start_of_backward_problem,
    system::AdjointDae,
};
use crate::integrators::{
    common::{Error, Integrator},
    ode::{Borrowed, Dae, Functional},
    sundials::{
        IdaOptions, InitialCondition,
        adjoint::{backward::Callbacks, gradient::Gradient, options::AdjointOptions},
        ffi,
        ida::{BACKWARD, IdaKind, StartsDae},
        linear::Linear,
        quadratures::CarriesIntegrals,
        session::Session,
    },
};

/// Where the forward run starts: time, state and its time derivative.
pub(super) type Start = (f64, Vec<f64>, Vec<f64>);

/// The solver of one forward and one backward run, as for an ODE.
pub(super) struct AdjointRun<'a, S, F> {
    solver: Session<IdaKind, Borrowed<'a, AdjointDae<S, F>>>,
    options: &'a AdjointOptions,
    t0: f64,
}

impl<'a, S: Dae, F: Functional> AdjointRun<'a, S, F> {
    pub(super) fn new(
        system: &'a mut AdjointDae<S, F>,
        (t0, y0, yp0): &Start,
        forward: &IdaOptions,
        options: &'a AdjointOptions,
    ) -> Result<Self, Error> {
        system.start((*t0, y0, yp0))?;
        let solver = Session::of_ida(Borrowed(system), *t0, (y0, yp0), forward)?;
        Ok(Self { solver, options, t0: *t0 })
    }

    /// Runs to time `t` and back.
    pub(super) fn gradient(mut self, t: f64) -> Result<Gradient, Error> {
        self.solver.consistent_start(InitialCondition::Algebraic, t)?;
        // As late as possible: if no run follows, IDAS 6.4.1 frees pointers that it never wrote.
        // SAFETY: the functions are those of IDA.
        unsafe { self.solver.keep_checkpoints(&BACKWARD, self.options)? };
        // steps must not pass `t`: the equations may jump there
        self.solver.set_stop_time(Some(t))?;
        self.solver.solve_to(t)?;
        let (y, yp) = (self.solver.y().to_vec(), self.solver.yp().to_vec());
        let mut gradient = self.solver.system_mut().0.equations.terminal("IDA", t, &y)?;
        gradient.value += self.solver.quadratures()[0];
        self.start_back((t, &y, &yp), &mut gradient)?;
        self.solver.run_back(self.t0, &mut gradient.parameters)?;
        gradient.initial_state.fill(0.0);
        if let Some(backward) = &self.solver.backward {
            let (mass, lambda) = (&self.solver.system().0.mass, backward.lambda.as_slice());
            mass.add_transposed_times(1.0, lambda, &mut gradient.initial_state);
        }
        Ok(gradient)
    }

    /// Makes the backward problem, which starts at this point from the slopes of g in `end`.
    fn start_back(
        &mut self,
        (t, y, yp): (f64, &[f64], &[f64]),
        end: &mut Gradient,
    ) -> Result<(), Error> {
        let (memory, data) = (self.solver.memory.raw, self.solver.host.as_ptr());
        let context = &self.solver.context;
        let system = &mut self.solver.host.get_mut().system.0;
        let parameters = system.equations.parameters().to_vec();
        // SAFETY: the data is the host, which outlives the solver.
        let mut linear = unsafe {
            let kind = &system.equations.backward;
            Linear::new::<Borrowed<'a, AdjointDae<S, F>>>(kind, &self.solver.y, context, data)?
        };
        let (lambda, slope) =
            start_of_backward_problem(system, (t, y, yp), end, &mut linear, context)?;
        // SAFETY: memory and vectors are alive when these are called, and the callbacks fit the host that is
        // their data.
        unsafe {
            let callbacks = Callbacks {
                init: |which, lambda, slope| {
                    let residual = Some(residual::<S, F> as _);
                    ("IDAInitB", ffi::IDAInitB(memory, which, residual, t, lambda, slope))
                },
                set_jacobian: |which| {
                    let code = ffi::IDASetJacFnB(memory, which, Some(jacobian::<S, F>));
                    ("IDASetJacFnB", code)
                },
                init_quadratures: |which, integrals| {
                    let integrands = Some(quadratures::<S, F> as _);
                    ("IDAQuadInitB", ffi::IDAQuadInitB(memory, which, integrands, integrals))
                },
            };
            let how = (self.options, &parameters[..]);
            self.solver.start_back(&BACKWARD, linear, (lambda, Some(slope)), how, callbacks)
        }
    }
}
