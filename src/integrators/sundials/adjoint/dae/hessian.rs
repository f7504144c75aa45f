//! Products of Hessians with directions.

use faer::MatMut;

use super::setup::DaeAdjoint;
use crate::integrators::{
    common::Error,
    ode::{Borrowed, Dae, Entries, Failure, Functional, call},
    sundials::adjoint::{
        doubled::{Along, Doubled, Line, System},
        gradient::Gradient,
    },
};

impl<S: Dae, F: Functional> DaeAdjoint<S, F> {
    /// The product of the Hessian d2G/dp2 at the end time T = `t` with a `direction` v of the parameters.
    ///
    /// The result is the [`Gradient`] of the derivative of G along v: `value` is (dG/dp)^T v, `parameters` the product
    /// (d2G/dp2) v, and `initial_state` (d2G/dy0 dp) v; the differential unknowns of y0 do not depend on parameters. All
    /// unit vectors give the Hessian.
    ///
    /// It runs y and s = (dy/dp) v forward, and back with as many unknowns, for twice the unknowns of a gradient.
    /// Second derivatives are central differences of the first, which the system supplies
    /// ([`Jacobian::Supplied`](crate::integrators::sundials::Jacobian::Supplied) of the forward run,
    /// [`supplied_parameters`](crate::integrators::sundials::AdjointOptions::supplied_parameters)), or of the equations,
    /// with some eight digits: tolerances below 1e-8 are not met.
    ///
    /// # Errors
    /// As for [`gradient`](Self::gradient); [`Error::Input`] for a direction of another length, a Krylov method or error
    /// weights of one's own.
    ///
    /// # Panics
    /// A panic of the system or the functional passes through.
    pub fn hessian_times(&mut self, t: f64, direction: &[f64]) -> Result<Gradient, Error> {
        let Self { system, functional, runs } = self;
        let (t0, y0, yp0) = &runs.start;
        let line = Line::new(direction, system.parameters(), &runs.forward.tolerances)?;
        let (mut forward, back) = runs.doubled(&line, system.parameters())?;
        forward.repeat_differential();
        let (supplied, sizes) = (runs.options.supplied_parameters, [y0.len(), yp0.len()]);
        let system = Borrowed(system as &mut dyn Dae);
        let system = Doubled::new(system, &line, [&runs.forward, &forward], supplied, sizes);
        let functional = Along::new(functional, line, y0.len());
        let zeros = vec![0.0; y0.len()];
        let [start, slopes] = [y0, yp0].map(|own| [&own[..], &zeros].concat());
        let made = DaeAdjoint::new(system, functional, *t0, &start, &slopes, &forward, &back);
        let mut gradient = made?.gradient(t)?;
        gradient.initial_state.truncate(y0.len());
        Ok(gradient)
    }
}

impl<'a> System for Borrowed<'a, dyn Dae + 'a> {
    fn evaluate(&mut self, t: f64, [y, yp]: [&[f64]; 2], out: &mut [f64]) -> Result<(), Failure> {
        call::residual(self, t, y, yp, out)
    }

    fn write_entries(
        &mut self,
        t: f64,
        cj: f64,
        [y, yp]: [&[f64]; 2],
        _scratch: &mut [f64],
        entries: Entries<'_>,
    ) -> Result<(), Failure> {
        entries.dae_jacobian(self, t, cj, y, yp)
    }

    fn by_parameters(
        &mut self,
        t: f64,
        [y, yp]: [&[f64]; 2],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        call::dae_adjoint_parameters(self, t, y, yp, lambda, out)
    }

    fn parameters(&self) -> &[f64] {
        Dae::parameters(self)
    }

    fn set_parameters(&mut self, values: &[f64]) {
        Dae::set_parameters(self, values);
    }
}

impl<'a> Dae for Doubled<Borrowed<'a, dyn Dae + 'a>> {
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure> {
        self.evaluate(t, [y, yp], residual)
    }

    fn dense_jacobian(
        &mut self,
        t: f64,
        cj: f64,
        y: &[f64],
        yp: &[f64],
        jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        self.write_entries(t, cj, [y, yp], Entries::Dense(jacobian))
    }

    fn sparse_jacobian(
        &mut self,
        t: f64,
        cj: f64,
        y: &[f64],
        yp: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        self.write_entries(t, cj, [y, yp], Entries::Sparse(values))
    }

    fn adjoint_parameters(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        self.by_parameters(t, [y, yp], lambda, out)
    }

    fn parameters(&self) -> &[f64] {
        Doubled::parameters(self)
    }

    fn set_parameters(&mut self, values: &[f64]) {
        Doubled::set_parameters(self, values);
    }
}
