//! What a run asks of an integrator beyond [`Integrator`].

use faer::{MatMut, MatRef};

use crate::{
    integrate::Integrator,
    integrate::{Error, Reached, Statistics},
    ode::{Dae, Failure, Ode},
    rk::DormandPrince,
    sundials::{Arkode, Cvode, Ida, InitialCondition},
};

/// An integrator, whatever its kind and its system.
pub(super) trait Engine {
    fn t(&self) -> f64;
    fn y(&self) -> &[f64];
    /// The time derivative of the state, of a DAE; empty otherwise.
    fn yp(&self) -> &[f64];
    fn step(&mut self, towards: f64) -> Result<Reached, Error>;
    fn set_stop_time(&mut self, t: f64) -> Result<(), Error>;
    fn interpolate(&mut self, t: f64, derivative: u32, out: &mut [f64]) -> Result<(), Error>;
    fn interpolant_degree(&self) -> u32;
    fn statistics(&self) -> Statistics;
    /// Starts again at `t` from `y` (and `yp`, of a DAE), on the way to `towards`. What may be corrected so that it satisfies the
    /// equations, is.
    fn restart(&mut self, t: f64, y: &[f64], yp: &[f64], towards: f64) -> Result<(), Error>;
    fn parameters(&self) -> &[f64];
    fn set_parameters(&mut self, values: &[f64]);
    /// Writes the right-hand side of an ODE.
    fn slope(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure>;
    /// Writes the sensitivities at `t`, within the last step.
    fn interpolate_sensitivities(&mut self, t: f64, out: MatMut<'_, f64>) -> Result<(), Error>;
    /// Lets the sensitivities start from `s`, after a new start.
    fn set_sensitivities(&mut self, s: MatRef<'_, f64>) -> Result<(), Error>;
    /// Corrects the start, before the first step.
    fn make_consistent(&mut self, _towards: f64) -> Result<(), Error> {
        Ok(())
    }
}

macro_rules! forward {
    () => {
        fn t(&self) -> f64 {
            Integrator::t(self)
        }

        fn y(&self) -> &[f64] {
            Integrator::y(self)
        }

        fn step(&mut self, towards: f64) -> Result<Reached, Error> {
            Integrator::step(self, towards)
        }

        fn set_stop_time(&mut self, t: f64) -> Result<(), Error> {
            Integrator::set_stop_time(self, Some(t))
        }

        fn interpolate(&mut self, t: f64, derivative: u32, out: &mut [f64]) -> Result<(), Error> {
            Integrator::interpolate(self, t, derivative, out)
        }

        fn interpolant_degree(&self) -> u32 {
            Integrator::interpolant_degree(self)
        }

        fn statistics(&self) -> Statistics {
            Integrator::statistics(self)
        }

        fn parameters(&self) -> &[f64] {
            self.system().parameters()
        }

        fn set_parameters(&mut self, values: &[f64]) {
            self.system_mut().set_parameters(values);
        }
    };
}

/// Sensitivities of those that have them.
macro_rules! with_sensitivities {
    () => {
        fn interpolate_sensitivities(&mut self, t: f64, out: MatMut<'_, f64>) -> Result<(), Error> {
            self.interpolate_sensitivities(t, 0, out)
        }

        fn set_sensitivities(&mut self, s: MatRef<'_, f64>) -> Result<(), Error> {
            self.set_sensitivities(s)
        }
    };
}

/// Nothing of those that have none, for which nobody asks.
macro_rules! without_sensitivities {
    () => {
        fn interpolate_sensitivities(&mut self, _: f64, _: MatMut<'_, f64>) -> Result<(), Error> {
            Ok(())
        }

        fn set_sensitivities(&mut self, _: MatRef<'_, f64>) -> Result<(), Error> {
            Ok(())
        }
    };
}

macro_rules! ode_engine {
    ($integrator:ident, $sensitivities:ident) => {
        impl<S: Ode> Engine for $integrator<S> {
            forward!();
            $sensitivities!();

            fn yp(&self) -> &[f64] {
                &[]
            }

            fn slope(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
                self.system_mut().rhs(t, y, out)
            }

            fn restart(&mut self, t: f64, y: &[f64], _: &[f64], _: f64) -> Result<(), Error> {
                self.reinit(t, y)
            }
        }
    };
}

ode_engine!(Cvode, with_sensitivities);
ode_engine!(Arkode, without_sensitivities);
ode_engine!(DormandPrince, without_sensitivities);

impl<S: Dae> Engine for Ida<S> {
    forward!();
    with_sensitivities!();

    fn yp(&self) -> &[f64] {
        Ida::yp(self)
    }

    /// None is known of a DAE.
    fn slope(&mut self, _: f64, _: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        out.fill(f64::NAN);
        Ok(())
    }

    fn restart(&mut self, t: f64, y: &[f64], yp: &[f64], towards: f64) -> Result<(), Error> {
        self.reinit_with(t, y, yp)?;
        self.make_consistent(towards)
    }

    fn make_consistent(&mut self, towards: f64) -> Result<(), Error> {
        if !self.knows_algebraic() {
            return Ok(());
        }
        self.consistent_start(InitialCondition::Algebraic, towards)
    }
}
