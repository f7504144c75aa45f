//! Options that each method takes, and those of the integrators behind them.

use super::{method::Method, options::Options, problem::Equations};
use crate::base::input::InputError;
use crate::integrators::{
    common::{Error, StepOptions, Tolerances},
    ode::Boxed,
    rk, rosenbrock,
    sundials::{
        CvodeOptions, IdaOptions, Jacobian, LinearSolver, MassForm, Multistep, OfMultistep,
        SolverOptions,
    },
};

/// Step sizes, for the direction `sign` of time.
fn steps(options: &Options, sign: f64) -> StepOptions {
    let initial_step = options.initial_step.map(|h| h.copysign(sign));
    let max_step = options.max_step.filter(|h| *h != f64::INFINITY);
    StepOptions { initial_step, max_step, ..StepOptions::default() }
}

/// Options that all integrators of SUNDIALS have.
pub(super) fn shared<O>(
    mut built: SolverOptions<O>,
    options: &Options,
    sign: f64,
) -> SolverOptions<O> {
    built.steps = steps(options, sign);
    built = options.min_step.into_iter().fold(built, SolverOptions::min_step);
    built = options.linear_solver.iter().cloned().fold(built, SolverOptions::newton);
    built
        .sign_constraints(options.sign_constraints.as_slice())
        .check_jacobian(options.check_jacobian)
}

/// Options that multistep methods have.
fn multistep<O: OfMultistep>(
    built: SolverOptions<O>,
    options: &Options,
    sign: f64,
) -> SolverOptions<O> {
    let built = shared(built, options, sign);
    let built = options.max_order.into_iter().fold(built, SolverOptions::max_order);
    options.sensitivities.iter().cloned().fold(built, SolverOptions::sensitivities)
}

impl Options {
    /// Those of the method of Dormand and Prince.
    pub(super) fn explicit(&self) -> rk::Options {
        let Tolerances { rtol, atol } = self.tolerances.clone();
        let mut built = rk::Options::new(rtol, atol);
        built.steps = steps(self, 1.0);
        built
    }

    /// Those of Rosenbrock methods.
    pub(super) fn rosenbrock(&self) -> rosenbrock::Options {
        let Tolerances { rtol, atol } = self.tolerances.clone();
        let built = rosenbrock::Options::new(rtol, atol).check_jacobian(self.check_jacobian);
        let solver = self.linear_solver.iter().cloned();
        let built = solver.fold(built, rosenbrock::Options::newton);
        let mut built = self.max_order.into_iter().fold(built, rosenbrock::Options::order);
        built.forward.steps = steps(self, 1.0);
        built
    }
}

impl Method {
    /// This method, or the one that [`Auto`](Self::Auto) stands for where there is no choice, and why.
    pub(super) fn resolve(
        self,
        equations: &Equations<'_>,
        options: &Options,
        sign: f64,
    ) -> (Self, &'static str) {
        let reasons = [
            (options.sensitivities.is_some(), "it computes sensitivities"),
            (equations.quadrature_count() > 0, "it computes integrals"),
            (options.project, "it projects"),
            (!options.sign_constraints.is_empty(), "it keeps signs"),
            (options.min_step.is_some(), "it has a lower bound of steps"),
            (options.max_order.is_some(), "it has a choice of orders"),
            (sign < 0.0, "it goes backward in time"),
        ];
        let reason = reasons.into_iter().find_map(|(applies, reason)| applies.then_some(reason));
        match (self, reason) {
            (Self::Auto, _) if equations.is_dae() => (Self::Ida, "it takes DAEs"),
            (Self::Auto, Some(reason)) => (Self::Bdf, reason),
            (method, _) => (method, "as asked for"),
        }
    }

    /// Refuses options that the method does not have.
    fn check(self, options: &Options, equations: &Equations<'_>) -> Result<(), InputError> {
        let is_dae = matches!(equations, Equations::Dae { .. });
        let refused = |input: &str, value: String, help: &str| {
            Err(InputError::new(input, value, format!("{} {help}", self.name())))
        };
        if is_dae != (self == Self::Ida) && !equations.has_mass() {
            let help = match is_dae {
                true => "integrates ODEs: take Method::Ida for a DAE",
                false => {
                    "integrates DAEs, and ODEs with a mass matrix: take another method for this ODE"
                }
            };
            return refused("method", format!("{self:?}"), help);
        }
        let facts = self.information();
        if let (Some(order), false) = (options.max_order, facts.has_orders) {
            return refused("max_order", order.to_string(), "has one order");
        }
        if let (Some(solver), false) = (&options.linear_solver, facts.is_implicit) {
            return refused(
                "linear_solver",
                format!("{solver:?}"),
                "is explicit and solves no linear systems",
            );
        }
        if options.sensitivities.is_some() && !facts.has_sensitivities {
            return refused("sensitivities", "given".into(), "has none: take Bdf, Adams or Ida");
        }
        if equations.quadrature_count() > 0 && !facts.has_sensitivities {
            let help = "computes none: make them unknowns, or take Bdf, Adams or Ida";
            return refused("integrals", equations.quadrature_count().to_string(), help);
        }
        if let (Some(h), false) = (options.min_step, facts.has_bounds) {
            return refused("min_step", h.to_string(), "has no such limit");
        }
        if !options.sign_constraints.is_empty() && !facts.has_bounds {
            return refused("sign_constraints", "given".into(), "keeps no signs: take another one");
        }
        if options.project && self != Self::Bdf {
            return refused("project", "true".into(), "does not project: take Bdf");
        }
        Ok(())
    }

    /// The options of CVODE.
    pub(super) fn cvode(self, options: &Options, sign: f64) -> CvodeOptions {
        let Tolerances { rtol, atol } = options.tolerances.clone();
        let family = if self == Self::Adams { Multistep::Adams } else { Multistep::Bdf };
        let built = multistep(CvodeOptions::new(rtol, atol).method(family), options, sign);
        if options.project { built.project() } else { built }
    }

    /// The options of IDA.
    pub(super) fn ida(
        self,
        options: &Options,
        sign: f64,
        differential: Option<Vec<bool>>,
    ) -> IdaOptions {
        let Tolerances { rtol, atol } = options.tolerances.clone();
        let built = multistep(IdaOptions::new(rtol, atol), options, sign);
        differential.into_iter().fold(built, IdaOptions::differential)
    }

    /// The equations in the form that this method takes: for IDA, those with a mass matrix as a DAE. Refuses
    /// equations that it does not take, and options that it does not have.
    pub(super) fn take<'a>(
        self,
        equations: Equations<'a>,
        t: f64,
        n: usize,
        options: &Options,
    ) -> Result<Equations<'a>, Error> {
        self.check(options, &equations)?;
        match equations {
            Equations::Ode(system) if self == Self::Ida => {
                let dense = LinearSolver::Dense(Jacobian::DifferenceQuotients);
                let solver = options.linear_solver.as_ref().unwrap_or(&dense);
                let mut system = MassForm::new(Boxed(system), n, solver)?;
                let differential = Some(system.differential(t)?);
                Ok(Equations::Dae { system: Box::new(system), yp: vec![0.0; n], differential })
            }
            equations => Ok(equations),
        }
    }
}
