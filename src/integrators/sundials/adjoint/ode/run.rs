//! The forward run and the backward run.

use super::{
    callbacks::{jacobian, quadratures, rhs},
    system::AdjointSystem,
};
use crate::integrators::{
    common::{Error, Integrator},
    ode::{Borrowed, Functional, Ode},
    sundials::{
        CvodeOptions,
        adjoint::{backward::Callbacks, gradient::Gradient, options::AdjointOptions},
        cvode::{BACKWARD, CvodeKind},
        ffi,
        linear::Linear,
        quadratures::CarriesIntegrals,
        session::Session,
        vector::Vector,
    },
};

/// The solver of one forward and one backward run. A further run would begin with the first step size of this
/// one, whatever has changed: the backward run leaves it in C (6.4.1).
pub(super) struct AdjointRun<'a, S, F> {
    solver: Session<CvodeKind, Borrowed<'a, AdjointSystem<S, F>>>,
    options: &'a AdjointOptions,
    t0: f64,
}

impl<'a, S: Ode, F: Functional> AdjointRun<'a, S, F> {
    pub(super) fn new(
        system: &'a mut AdjointSystem<S, F>,
        (t0, y0): &(f64, Vec<f64>),
        forward: &CvodeOptions,
        options: &'a AdjointOptions,
    ) -> Result<Self, Error> {
        system.equations.forget();
        let mut solver = Session::of_cvode(Borrowed(system), *t0, y0, forward)?;
        // SAFETY: the functions are those of CVODE.
        unsafe { solver.keep_checkpoints(&BACKWARD, options)? };
        Ok(Self { solver, options, t0: *t0 })
    }

    /// Runs to time `t` and back.
    pub(super) fn gradient(mut self, t: f64) -> Result<Gradient, Error> {
        // steps must not pass `t`: the equations may jump there
        self.solver.set_stop_time(Some(t))?;
        self.solver.solve_to(t)?;
        let y = self.solver.y().to_vec();
        let mut gradient = self.solver.system_mut().0.equations.terminal("CVODE", t, &y)?;
        gradient.value += self.solver.quadratures()[0];
        self.start_back(t, &gradient.initial_state)?;
        self.solver.run_back(self.t0, &mut gradient.parameters)?;
        if let Some(backward) = &self.solver.backward {
            gradient.initial_state.copy_from_slice(backward.lambda.as_slice());
        }
        Ok(gradient)
    }

    /// Makes the backward problem, which starts at time `t` from `lambda`.
    fn start_back(&mut self, t: f64, lambda: &[f64]) -> Result<(), Error> {
        let (memory, data) = (self.solver.memory.raw, self.solver.host.as_ptr());
        let context = &self.solver.context;
        let equations = &self.solver.system().0.equations;
        let parameters = equations.parameters().to_vec();
        let lambda = Vector::from_slice(lambda, context)?;
        // SAFETY: the data is the host, which outlives the solver.
        let linear = unsafe {
            let kind = &equations.backward;
            Linear::new::<Borrowed<'a, AdjointSystem<S, F>>>(kind, &lambda, context, data)?
        };
        // SAFETY: memory and vectors are alive when these are called, and the callbacks fit the host that is
        // their data.
        unsafe {
            let callbacks = Callbacks {
                init: |which, lambda, _| {
                    let code = ffi::CVodeInitB(memory, which, Some(rhs::<S, F>), t, lambda);
                    ("CVodeInitB", code)
                },
                set_jacobian: |which| {
                    let code = ffi::CVodeSetJacFnB(memory, which, Some(jacobian::<S, F>));
                    ("CVodeSetJacFnB", code)
                },
                init_quadratures: |which, integrals| {
                    let integrands = Some(quadratures::<S, F> as _);
                    let code = ffi::CVodeQuadInitB(memory, which, integrands, integrals);
                    ("CVodeQuadInitB", code)
                },
            };
            let how = (self.options, &parameters[..]);
            self.solver.start_back(&BACKWARD, linear, (lambda, None), how, callbacks)
        }
    }
}
