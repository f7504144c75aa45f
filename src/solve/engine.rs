//! What a run asks of an integrator beyond [`Integrator`].

use crate::{
    integrate::Integrator,
    integrate::{Error, Reached, Statistics},
    ode::{Dae, Ode},
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

macro_rules! ode_engine {
    ($integrator:ident) => {
        impl<S: Ode> Engine for $integrator<S> {
            forward!();

            fn yp(&self) -> &[f64] {
                &[]
            }

            fn restart(&mut self, t: f64, y: &[f64], _: &[f64], _: f64) -> Result<(), Error> {
                self.reinit(t, y)
            }
        }
    };
}

ode_engine!(Cvode);
ode_engine!(Arkode);
ode_engine!(DormandPrince);

impl<S: Dae> Engine for Ida<S> {
    forward!();

    fn yp(&self) -> &[f64] {
        Ida::yp(self)
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
