//! The result of an adjoint problem.

use super::slopes::{Names, SlopesCheck};
use crate::base::input::InputError;
use crate::integrators::{
    common::{Tolerances, check_finite},
    ode::{Failure, Functional, Slopes},
};

/// A functional G = g(T, y(T), p) + integral of h(t, y, p) and its derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient {
    /// G.
    pub value: f64,
    /// dG/dp, for all parameters of the system.
    pub parameters: Vec<f64>,
    /// dG/dy0, with respect to the initial state; if that depends on parameters, (dy0/dp)^T dG/dy0 has to be
    /// added to dG/dp. For a DAE, with respect to the differential unknowns: algebraic ones follow from them,
    /// and have zeros.
    pub initial_state: Vec<f64>,
}

impl Gradient {
    /// The gradient of g(T, y, p) with respect to the state and the parameters at the end, where the backward
    /// run starts.
    pub(crate) fn at_end(
        functional: &mut impl Functional,
        t: f64,
        [y, p]: [&[f64]; 2],
        tolerances: &Tolerances,
    ) -> Result<Self, Failure> {
        let (mut initial_state, mut parameters) = (vec![0.0; y.len()], vec![0.0; p.len()]);
        let slopes = Slopes { y: &mut initial_state, p: &mut parameters };
        let value = functional.terminal(t, y, p, Some(slopes))?;
        let mut check = SlopesCheck::new((y.len(), tolerances), p.len());
        check.check(
            Names::of_functional("terminal of the functional"),
            [y, p],
            [&initial_state, &parameters],
            |y, p| functional.terminal(t, y, p, None),
        )?;
        Ok(Self { value, parameters, initial_state })
    }

    /// Checks that its numbers are finite.
    pub(crate) fn check(self) -> Result<Self, InputError> {
        check_finite("terminal functional", &[self.value])?;
        check_finite("terminal slopes by y", &self.initial_state)?;
        check_finite("terminal slopes by p", &self.parameters)?;
        Ok(self)
    }
}
