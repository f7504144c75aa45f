//! The start of a method on the equations of a run.

use super::{
    auto::AutoEngine,
    engine::{DaeEngine, Engine, OdeEngine},
    integrator_options::shared,
    method::Method,
    options::Options,
    problem::Equations,
};
use crate::integrators::{
    common::{Error, Tolerances},
    ode::Boxed,
    rk,
    rosenbrock::Rosenbrock,
    sundials::{Arkode, ArkodeOptions, Cvode, Ida},
};

impl Method {
    /// An integrator for `equations` from the time `t` and state `y` towards `end`.
    pub(super) fn engine<'a>(
        self,
        equations: Equations<'a>,
        (t, end): (f64, f64),
        y: &[f64],
        options: &Options,
    ) -> Result<Box<dyn Engine + 'a>, Error> {
        let sign = (end - t).signum();
        let Tolerances { rtol, atol } = options.tolerances.clone();
        let system = match self.take(equations, t, y.len(), options)? {
            Equations::Dae { system, yp, differential } => {
                let options = self.ida(options, sign, differential);
                let integrator = Ida::new(Boxed(system), t, y, &yp, &options)?;
                return Ok(Box::new(DaeEngine { integrator, options }));
            }
            Equations::Ode(system) => Boxed(system),
        };
        Ok(match self {
            Self::RungeKutta(table) => {
                let built = shared(ArkodeOptions::new(rtol, atol).table(table), options, sign);
                Box::new(OdeEngine { integrator: Arkode::new(system, t, y, &built)? })
            }
            Self::Auto => Box::new(AutoEngine::new(system, (t, end), y, options)?),
            Self::DormandPrince => {
                let integrator = rk::DormandPrince::new(system, t, y, &options.explicit())?;
                Box::new(OdeEngine { integrator })
            }
            Self::Rosenbrock => {
                let integrator = Rosenbrock::new(system, t, y, &options.rosenbrock())?;
                Box::new(OdeEngine { integrator })
            }
            _ => {
                let built = self.cvode(options, sign);
                Box::new(OdeEngine { integrator: Cvode::new(system, t, y, &built)? })
            }
        })
    }
}
