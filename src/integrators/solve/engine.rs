//! Interface of a run to its integrator, in addition to [`Integrator`].

use faer::{MatMut, MatRef};

use crate::integrators::{
    common::{Error, Integrator, Reached, Statistics},
    ode::{Borrowed, Dae, Failure, Ode, call},
    rk::DormandPrince,
    rosenbrock::Rosenbrock,
    sundials::{Arkode, Cvode, Ida, IdaOptions, InitialCondition},
};

/// An integrator, whatever its kind and its system.
pub(super) trait Engine {
    fn t(&self) -> f64;
    fn y(&self) -> &[f64];
    /// The time derivative of the state for a DAE; empty otherwise.
    fn yp(&self) -> &[f64];
    fn step(&mut self, towards: f64) -> Result<Reached, Error>;
    fn set_stop_time(&mut self, t: f64) -> Result<(), Error>;
    fn interpolate(&mut self, t: f64, derivative: u32, out: &mut [f64]) -> Result<(), Error>;
    fn interpolant_degree(&self) -> u32;
    fn statistics(&self) -> Statistics;
    /// Starts again at `t` from `y` (and `yp`, of a DAE).
    fn restart(&mut self, t: f64, y: &[f64], yp: &[f64]) -> Result<(), Error>;
    fn parameters(&self) -> &[f64];
    fn set_parameters(&mut self, values: &[f64]);
    /// Writes the right-hand side of an ODE; does nothing for a DAE, whose slope is known already.
    fn slope(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure>;
    /// Writes the sensitivities at `t`, within the last step.
    fn interpolate_sensitivities(&mut self, t: f64, out: MatMut<'_, f64>) -> Result<(), Error>;
    /// Number of integrals.
    fn quadrature_count(&self) -> usize;
    /// Writes the integrals from the last start to `t`, within the last step.
    fn interpolate_quadratures(&mut self, t: f64, out: &mut [f64]) -> Result<(), Error>;
    /// Sets the initial sensitivities to `s`, after a new start.
    fn set_sensitivities(&mut self, s: MatRef<'_, f64>) -> Result<(), Error>;
    /// Corrects the start before the first step, as far as that is allowed, so that it and its sensitivities
    /// satisfy the equations.
    fn make_consistent(&mut self, _towards: f64) -> Result<(), Error> {
        Ok(())
    }
    /// Whether nothing needs correction, or the correctable unknowns are known.
    fn can_be_consistent(&self) -> bool {
        true
    }
    /// An error that says why the run makes no progress, if the equations themselves show it.
    fn diagnose(&mut self) -> Result<(), Error> {
        Ok(())
    }
    /// The correction of `make_consistent`, for a state that the integrator does not start from, or not yet.
    fn correct(&mut self, _: Start<'_>, _towards: f64) -> Result<(), Error> {
        Ok(())
    }
}

/// A state from which a solution continues.
pub(super) struct Start<'s> {
    pub(super) t: f64,
    pub(super) y: &'s mut [f64],
    pub(super) yp: &'s mut [f64],
    /// Sensitivities, one column after the other, if they are wanted.
    pub(super) s: Option<&'s mut [f64]>,
}

/// An integrator of ODEs.
pub(super) struct OdeEngine<I> {
    pub(super) integrator: I,
}

/// IDA and its options: states are corrected by a second solver of its equations, so that this one keeps the
/// last step.
pub(super) struct DaeEngine<S> {
    pub(super) integrator: Ida<S>,
    pub(super) options: IdaOptions,
}

macro_rules! forward {
    () => {
        fn t(&self) -> f64 {
            self.integrator.t()
        }

        fn y(&self) -> &[f64] {
            self.integrator.y()
        }

        fn step(&mut self, towards: f64) -> Result<Reached, Error> {
            self.integrator.step(towards)
        }

        fn set_stop_time(&mut self, t: f64) -> Result<(), Error> {
            self.integrator.set_stop_time(Some(t))
        }

        fn interpolate(&mut self, t: f64, derivative: u32, out: &mut [f64]) -> Result<(), Error> {
            self.integrator.interpolate(t, derivative, out)
        }

        fn interpolant_degree(&self) -> u32 {
            self.integrator.interpolant_degree()
        }

        fn statistics(&self) -> Statistics {
            self.integrator.statistics()
        }

        fn parameters(&self) -> &[f64] {
            self.integrator.system().parameters()
        }

        fn set_parameters(&mut self, values: &[f64]) {
            self.integrator.system_mut().set_parameters(values);
        }
    };
}

/// Sensitivities and integrals of integrators that compute them.
macro_rules! with_sensitivities {
    () => {
        fn interpolate_sensitivities(&mut self, t: f64, out: MatMut<'_, f64>) -> Result<(), Error> {
            self.integrator.interpolate_sensitivities(t, 0, out)
        }

        fn set_sensitivities(&mut self, s: MatRef<'_, f64>) -> Result<(), Error> {
            self.integrator.set_sensitivities(s)
        }

        fn quadrature_count(&self) -> usize {
            self.integrator.system().quadrature_count()
        }

        fn interpolate_quadratures(&mut self, t: f64, out: &mut [f64]) -> Result<(), Error> {
            self.integrator.interpolate_quadratures(t, 0, out)
        }
    };
}

/// The same for integrators without them: nothing is written.
macro_rules! without_sensitivities {
    () => {
        fn interpolate_sensitivities(&mut self, _: f64, _: MatMut<'_, f64>) -> Result<(), Error> {
            Ok(())
        }

        fn set_sensitivities(&mut self, _: MatRef<'_, f64>) -> Result<(), Error> {
            Ok(())
        }

        fn quadrature_count(&self) -> usize {
            0
        }

        fn interpolate_quadratures(&mut self, _: f64, _: &mut [f64]) -> Result<(), Error> {
            Ok(())
        }
    };
}

macro_rules! ode_engine {
    ($integrator:ident, $sensitivities:ident) => {
        impl<S: Ode> Engine for OdeEngine<$integrator<S>> {
            forward!();
            $sensitivities!();

            fn yp(&self) -> &[f64] {
                &[]
            }

            fn slope(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
                call::rhs(self.integrator.system_mut(), t, y, out)
            }

            fn restart(&mut self, t: f64, y: &[f64], _: &[f64]) -> Result<(), Error> {
                self.integrator.reinit(t, y)
            }
        }
    };
}

ode_engine!(Cvode, with_sensitivities);
ode_engine!(Arkode, without_sensitivities);
ode_engine!(DormandPrince, without_sensitivities);
ode_engine!(Rosenbrock, without_sensitivities);

impl<S: Dae> Engine for DaeEngine<S> {
    forward!();
    with_sensitivities!();

    fn yp(&self) -> &[f64] {
        self.integrator.yp()
    }

    fn slope(&mut self, _: f64, _: &[f64], _: &mut [f64]) -> Result<(), Failure> {
        Ok(())
    }

    fn restart(&mut self, t: f64, y: &[f64], yp: &[f64]) -> Result<(), Error> {
        self.integrator.reinit_with(t, y, yp)
    }

    fn can_be_consistent(&self) -> bool {
        self.integrator.knows_algebraic()
    }

    fn make_consistent(&mut self, towards: f64) -> Result<(), Error> {
        if !self.can_be_consistent() {
            return Ok(());
        }
        self.integrator.consistent_start(InitialCondition::Algebraic, towards)
    }

    fn diagnose(&mut self) -> Result<(), Error> {
        self.integrator.diagnose_index()
    }

    fn correct(&mut self, start: Start<'_>, towards: f64) -> Result<(), Error> {
        if !self.can_be_consistent() {
            return Ok(());
        }
        let Start { t, y, yp, s } = start;
        let mut fresh = Ida::new(Borrowed(self.integrator.system_mut()), t, y, yp, &self.options)?;
        let shape = (y.len(), fresh.sensitivities().ncols());
        if let Some(s) = &s {
            fresh.set_sensitivities(MatRef::from_column_major_slice(s, shape.0, shape.1))?;
        }
        fresh.consistent_start(InitialCondition::Algebraic, towards)?;
        y.copy_from_slice(fresh.y());
        yp.copy_from_slice(fresh.yp());
        if let Some(s) = s {
            MatMut::from_column_major_slice_mut(s, shape.0, shape.1)
                .copy_from(fresh.sensitivities());
        }
        Ok(())
    }
}
