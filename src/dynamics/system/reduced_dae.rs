//! The equations of a reduced model as IDA takes them, y' - f(t, y) = 0.
//!
//! No constraints are left for a form of index 2, and no pattern for KLU.

use super::System;
use super::form::Form;
use super::reduced_form::{Lift, ReducedForm};
use crate::integrators::ode::{Dae, Failure, Ode};

/// The equations of a reduced model as a system of residuals.
pub(crate) struct ReducedDae {
    form: ReducedForm,
    /// Step parameter of the last Newton matrix.
    gamma: f64,
}

impl ReducedDae {
    pub(crate) fn new(form: ReducedForm) -> Self {
        Self { form, gamma: 0.0 }
    }

    /// y' with which the residual vanishes.
    pub(crate) fn consistent(&mut self, t: f64, y: &[f64]) -> Result<Vec<f64>, Failure> {
        let mut yp = vec![0.0; y.len()];
        self.form.rhs(t, y, &mut yp)?;
        Ok(yp)
    }
}

impl Form for ReducedDae {
    fn system(&self) -> &System {
        self.form.system()
    }

    fn system_mut(&mut self) -> &mut System {
        self.form.system_mut()
    }

    fn into_system(self) -> System {
        self.form.into_system()
    }
}

impl Lift for ReducedDae {
    fn reduced(&mut self) -> &mut ReducedForm {
        &mut self.form
    }
}

impl Dae for ReducedDae {
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure> {
        self.form.rhs(t, y, residual)?;
        residual.iter_mut().zip(yp).for_each(|(residual, yp)| *residual = yp - *residual);
        Ok(())
    }

    fn newton_setup(&mut self, t: f64, cj: f64, y: &[f64], yp: &[f64]) -> Result<(), Failure> {
        self.gamma = 1.0 / cj;
        self.form.newton_setup(t, y, yp, self.gamma, false)?;
        Ok(())
    }

    /// cj - J is I - gamma J over gamma.
    fn newton_solve(&mut self, r: &mut [f64]) -> Result<(), Failure> {
        r.iter_mut().for_each(|r| *r *= self.gamma);
        self.form.newton_solve(self.gamma, r)
    }
}
