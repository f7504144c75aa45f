//! Interface of a run to its integrator, in addition to [`Integrator`].

use faer::{MatMut, MatRef};

use super::method::MethodUse;
use crate::integrators::{
    common::{Error, Integrator, Reached, Statistics},
    ode::{Borrowed, Dae, Failure, Ode, call, delegate::delegate},
    rk::DormandPrince,
    rosenbrock::Rosenbrock,
    sundials::{Arkode, Ida, IdaOptions, InitialCondition, Solver, WithSensitivities},
};

/// An integrator, whatever its kind and its system.
pub(super) trait Engine: Send {
    fn t(&self) -> f64;
    fn y(&self) -> &[f64];
    /// The time derivative of the state for a DAE; empty otherwise.
    fn yp(&self) -> &[f64];
    fn step(&mut self, towards: f64) -> Result<Reached, Error>;
    fn set_stop_time(&mut self, t: f64) -> Result<(), Error>;
    fn set_stop_before(&mut self, t: f64) -> Result<(), Error>;
    fn interpolate(&mut self, t: f64, derivative: u32, out: &mut [f64]) -> Result<(), Error>;
    fn interpolant_degree(&self) -> u32;
    fn statistics(&self) -> Statistics;
    fn steps(&self) -> u64;
    fn notice(&self) -> Option<String>;
    /// The methods so far, if it changes between them.
    fn uses(&self) -> &[MethodUse] {
        &[]
    }
    /// Starts again at `t` from `y` (and `yp`, of a DAE).
    fn restart(&mut self, t: f64, y: &[f64], yp: &[f64]) -> Result<(), Error>;
    fn parameters(&self) -> &[f64];
    fn set_parameters(&mut self, values: &[f64]);
    /// Writes the right-hand side of an ODE; does nothing for a DAE, whose slope is known already.
    fn slope(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure>;
    /// Writes the right-hand side of an ODE, or the residual of a DAE.
    fn equations(&mut self, t: f64, y: &[f64], yp: &[f64], out: &mut [f64]) -> Result<(), Failure>;
    /// Writes the sensitivities at `t`, within the last step.
    fn sensitivities_at(&mut self, t: f64, out: MatMut<'_, f64>) -> Result<(), Error>;
    /// Writes the integrals from the last start to `t`, within the last step.
    fn quadratures_at(&mut self, t: f64, out: &mut [f64]) -> Result<(), Error>;
    /// Writes the sensitivities of the integrals from the last start to `t`, within the last step.
    fn quadrature_sensitivities_at(&mut self, t: f64, out: MatMut<'_, f64>) -> Result<(), Error>;
    /// Writes the integrands.
    fn integrands(&mut self, t: f64, y: &[f64], yp: &[f64], out: &mut [f64])
    -> Result<(), Failure>;
    /// Sets the initial sensitivities to `s`, after a new start, and the derivatives of all parameters by those
    /// of the sensitivities to `dp`, column by column.
    fn start_sensitivities(&mut self, s: MatRef<'_, f64>, dp: &[f64]) -> Result<(), Error>;
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
    /// Sensitivities, and the derivatives of the parameters by those of the sensitivities, one column after
    /// the other, if they are wanted.
    pub(super) s: Option<(&'s mut [f64], &'s [f64])>,
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
        delegate! { @methods [integrator]
            fn t() -> f64;
            fn y() -> &[f64];
            fn step(towards: f64) -> Result<Reached, Error>;
            fn set_stop_before(t: f64) -> Result<(), Error>;
            fn interpolate(t: f64, derivative: u32, out: &mut [f64]) -> Result<(), Error>;
            fn interpolant_degree() -> u32;
            fn statistics() -> Statistics;
            fn steps() -> u64;
            fn notice() -> Option<String>;
            fn sensitivities_at(t: f64, out: MatMut<'_, f64>) -> Result<(), Error>;
            fn start_sensitivities(s: MatRef<'_, f64>, dp: &[f64]) -> Result<(), Error>;
            fn quadratures_at(t: f64, out: &mut [f64]) -> Result<(), Error>;
            fn quadrature_sensitivities_at(t: f64, out: MatMut<'_, f64>) -> Result<(), Error>;
        }

        fn set_stop_time(&mut self, t: f64) -> Result<(), Error> {
            self.integrator.set_stop_time(Some(t))
        }

        fn parameters(&self) -> &[f64] {
            self.integrator.system().parameters()
        }

        fn set_parameters(&mut self, values: &[f64]) {
            self.integrator.system_mut().set_parameters(values);
        }
    };
}

/// Sensitivities and integrals; an integrator without them writes nothing.
pub(super) trait Extras {
    fn sensitivities_at(&mut self, _: f64, _: MatMut<'_, f64>) -> Result<(), Error> {
        Ok(())
    }

    fn start_sensitivities(&mut self, _: MatRef<'_, f64>, _: &[f64]) -> Result<(), Error> {
        Ok(())
    }

    fn quadratures_at(&mut self, _: f64, _: &mut [f64]) -> Result<(), Error> {
        Ok(())
    }

    fn quadrature_sensitivities_at(&mut self, _: f64, _: MatMut<'_, f64>) -> Result<(), Error> {
        Ok(())
    }
}

impl<S> Extras for Arkode<S> {}
impl<S> Extras for DormandPrince<S> {}
impl<S> Extras for Rosenbrock<S> {}

impl<K: WithSensitivities, S> Extras for Solver<K, S> {
    fn sensitivities_at(&mut self, t: f64, out: MatMut<'_, f64>) -> Result<(), Error> {
        self.interpolate_sensitivities(t, 0, out)
    }

    fn start_sensitivities(&mut self, s: MatRef<'_, f64>, dp: &[f64]) -> Result<(), Error> {
        self.set_parameter_directions(dp)?;
        self.set_sensitivities(s)
    }

    fn quadratures_at(&mut self, t: f64, out: &mut [f64]) -> Result<(), Error> {
        self.interpolate_quadratures(t, 0, out)
    }

    fn quadrature_sensitivities_at(&mut self, t: f64, out: MatMut<'_, f64>) -> Result<(), Error> {
        self.interpolate_quadrature_sensitivities(t, 0, out)
    }
}

impl<I: Integrator<System: Ode> + Extras + Send> Engine for OdeEngine<I> {
    forward!();

    fn yp(&self) -> &[f64] {
        &[]
    }

    fn slope(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        call::rhs(self.integrator.system_mut(), t, y, out)
    }

    fn equations(&mut self, t: f64, y: &[f64], _: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        call::rhs(self.integrator.system_mut(), t, y, out)
    }

    fn integrands(&mut self, t: f64, y: &[f64], _: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        call::quadratures(self.integrator.system_mut(), t, y, out)
    }

    fn restart(&mut self, t: f64, y: &[f64], _: &[f64]) -> Result<(), Error> {
        self.integrator.reinit(t, y)
    }
}

impl<S: Dae + Send> Engine for DaeEngine<S> {
    forward!();

    fn yp(&self) -> &[f64] {
        self.integrator.yp()
    }

    fn slope(&mut self, _: f64, _: &[f64], _: &mut [f64]) -> Result<(), Failure> {
        Ok(())
    }

    fn equations(&mut self, t: f64, y: &[f64], yp: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        call::residual(self.integrator.system_mut(), t, y, yp, out)
    }

    fn integrands(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        call::dae_quadratures(self.integrator.system_mut(), t, y, yp, out)
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
        if let Some((s, dp)) = &s {
            fresh.set_parameter_directions(dp)?;
            fresh.set_sensitivities(MatRef::from_column_major_slice(s, shape.0, shape.1))?;
        }
        fresh.consistent_start(InitialCondition::Algebraic, towards)?;
        y.copy_from_slice(fresh.y());
        yp.copy_from_slice(fresh.yp());
        if let Some((s, _)) = s {
            MatMut::from_column_major_slice_mut(s, shape.0, shape.1)
                .copy_from(fresh.sensitivities());
        }
        Ok(())
    }
}
