//! M y' = f(t, y) as a DAE, for mass matrices that may be singular.

use faer::MatMut;

use super::{linear_solver::LinearSolver, stored_matrix::StoredMatrix};
use crate::integrators::{
    common::{Error, check_whole},
    ode::{BandMut, Dae, Failure, MassKind, Ode, Storage, call, delegate::delegate},
};

/// The DAE M y' - f(t, y) = 0 of an [`Ode`] with a mass matrix, for [`Ida`](super::Ida).
///
/// M may be singular: M = diag(1, 1, 0) makes the third equation a constraint, 0 = f3(t, y). The equations
/// have to be of index 1, that is, M with the derivatives of the constraints has to be regular.
///
/// Its Jacobians dF/dy + cj dF/dy' = cj M - df/dy are made of those of the system; so are, for an M that parameters do not change, the
/// derivatives that sensitivities and adjoint gradients take.
///
/// ```
/// use pliant::{
///     ode::with_mass,
///     sundials::{Ida, IdaOptions, InitialCondition, Integrator, Jacobian, LinearSolver, MassForm},
/// };
///
/// // y1' = -y2 with 0 = y1 - y2
/// let rhs = |_t: f64, y: &[f64], f: &mut [f64]| {
///     f[0] = -y[1];
///     f[1] = y[0] - y[1];
///     Ok(())
/// };
/// let solver = LinearSolver::Dense(Jacobian::DifferenceQuotients);
/// let mut system = MassForm::new(with_mass(rhs, [1.0, 0.0]), 2, &solver)?;
/// let differential = system.differential(0.0)?;
/// let options = IdaOptions::new(1e-8, 1e-10).newton(solver).differential(differential);
/// let mut ida = Ida::new(system, 0.0, &[1.0, 0.0], &[0.0, 0.0], &options)?;
/// ida.consistent_start(InitialCondition::Algebraic, 1.0)?;
/// ida.solve_to(1.0)?;
/// assert!((ida.y()[0] - (-1f64).exp()).abs() < 1e-6);
/// # Ok::<(), pliant::sundials::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct MassForm<S> {
    system: S,
    /// In the form of the Newton matrix.
    mass: StoredMatrix,
    /// Whether `mass` is up to date; one that depends on time never is.
    known: bool,
    /// f(t, y)
    f: Vec<f64>,
}

impl<S: Ode> MassForm<S> {
    /// The DAE of `system`, which has `n` unknowns, for the linear solver that
    /// [`IdaOptions::newton`](super::IdaOptions::newton) is given: M has the form of the matrix it works on.
    ///
    /// # Errors
    /// If the system has no [mass matrix](Ode::mass_kind), or the linear solver stores no matrix.
    pub fn new(system: S, n: usize, solver: &LinearSolver) -> Result<Self, Error> {
        if system.mass_kind() == MassKind::Identity {
            let help = "the system has to give one: see `mass_kind` and `with_mass`";
            return Err(Error::input("mass matrix", "none", help));
        }
        check_whole(&system)?;
        solver.check(n)?;
        if matches!(solver, LinearSolver::Krylov(_) | LinearSolver::Custom) {
            let help = "with a mass matrix it is dense, of band form or sparse (KLU)";
            return Err(Error::input("linear solver", format!("{solver:?}"), help));
        }
        let mass = StoredMatrix::new(solver, n);
        Ok(Self { system, mass, known: false, f: vec![0.0; n] })
    }

    /// For each unknown, whether it is differential, for
    /// [`IdaOptions::differential`](super::IdaOptions::differential): whether its column of M at time `t`
    /// has a nonzero.
    ///
    /// That is exact where each differential unknown has mass of its own, as with a diagonal M. Where M
    /// couples unknowns so that only combinations of them have mass, as a capacitor between two nodes does,
    /// all of them count as differential: [`consistent_start`](super::Ida::consistent_start) cannot determine
    /// which to change then, and the start has to satisfy the constraints.
    ///
    /// # Errors
    /// If the system does not give its mass matrix.
    pub fn differential(&mut self, t: f64) -> Result<Vec<bool>, Error> {
        self.update(t).map_err(|failure| {
            let help = "the system has to give it in the form of the linear solver";
            Error::input("mass matrix", failure.into_error(), help)
        })?;
        let mut differential = vec![false; self.f.len()];
        self.mass.each(|_, j, value| differential[j] |= value != 0.0);
        Ok(differential)
    }

    /// The system.
    #[must_use]
    pub fn system(&self) -> &S {
        &self.system
    }

    /// The system, to be changed.
    pub fn system_mut(&mut self) -> &mut S {
        self.known = false;
        &mut self.system
    }

    /// Updates the matrix to time `t`.
    fn update(&mut self, t: f64) -> Result<(), Failure> {
        if !self.known {
            self.mass.entries().mass(&mut self.system, t)?;
            self.known = self.system.mass_kind() == MassKind::Constant;
        }
        Ok(())
    }

    /// Prepares a Jacobian at (t, y): evaluates the matrix and f there.
    fn prepare(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        self.update(t)?;
        call::rhs(&mut self.system, t, y, &mut self.f)
    }
}

impl<S: Ode> Dae for MassForm<S> {
    delegate! { @methods [system]
        fn root_count() -> usize;
        fn quadrature_count() -> usize;
        fn parameters() -> &[f64];
        fn supplied_jacobian() -> Option<Storage<'_>>;
    }

    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure> {
        self.update(t)?;
        call::rhs(&mut self.system, t, y, residual)?;
        negate(residual);
        self.mass.each(|i, j, value| residual[i] += value * yp[j]);
        Ok(())
    }

    fn dense_jacobian(
        &mut self,
        t: f64,
        cj: f64,
        y: &[f64],
        _yp: &[f64],
        mut jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        self.prepare(t, y)?;
        self.system.dense_jacobian(t, y, &self.f, jacobian.as_mut())?;
        self.mass.each(|i, j, value| jacobian[(i, j)] = cj * value - jacobian[(i, j)]);
        Ok(())
    }

    fn banded_jacobian(
        &mut self,
        t: f64,
        cj: f64,
        y: &[f64],
        _yp: &[f64],
        mut jacobian: BandMut<'_>,
    ) -> Result<(), Failure> {
        self.prepare(t, y)?;
        self.system.banded_jacobian(t, y, &self.f, jacobian.reborrow())?;
        self.mass.each(|i, j, value| jacobian[(i, j)] = cj * value - jacobian[(i, j)]);
        Ok(())
    }

    fn sparse_jacobian(
        &mut self,
        t: f64,
        cj: f64,
        y: &[f64],
        _yp: &[f64],
        jacobian: &mut [f64],
    ) -> Result<(), Failure> {
        self.prepare(t, y)?;
        self.system.sparse_jacobian(t, y, &self.f, jacobian)?;
        for (entry, value) in jacobian.iter_mut().zip(self.mass.values()) {
            *entry = cj * value - *entry;
        }
        Ok(())
    }

    fn jacobian_times(
        &mut self,
        t: f64,
        cj: f64,
        y: &[f64],
        _yp: &[f64],
        v: &[f64],
        jv: &mut [f64],
    ) -> Result<(), Failure> {
        self.prepare(t, y)?;
        call::jacobian_times(&mut self.system, t, y, &self.f, v, jv)?;
        negate(jv);
        self.mass.each(|i, j, value| jv[i] += cj * value * v[j]);
        Ok(())
    }

    fn roots(&mut self, t: f64, y: &[f64], _yp: &[f64], g: &mut [f64]) -> Result<(), Failure> {
        call::roots(&mut self.system, t, y, g)
    }

    fn quadratures(
        &mut self,
        t: f64,
        y: &[f64],
        _yp: &[f64],
        qdot: &mut [f64],
    ) -> Result<(), Failure> {
        call::quadratures(&mut self.system, t, y, qdot)
    }

    fn sensitivity_residual(
        &mut self,
        t: f64,
        y: &[f64],
        _yp: &[f64],
        parameter: usize,
        s: &[f64],
        sp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure> {
        self.prepare(t, y)?;
        call::sensitivity_rhs(&mut self.system, t, y, &self.f, parameter, s, residual)?;
        negate(residual);
        self.mass.each(|i, j, value| residual[i] += value * sp[j]);
        Ok(())
    }

    fn adjoint_residual(
        &mut self,
        t: f64,
        y: &[f64],
        _yp: &[f64],
        lambda: &[f64],
        mu: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        self.update(t)?;
        call::adjoint_rhs(&mut self.system, t, y, lambda, out)?;
        negate(out);
        self.mass.add_transposed_times(1.0, mu, out);
        Ok(())
    }

    fn adjoint_parameters(
        &mut self,
        t: f64,
        y: &[f64],
        _yp: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        call::adjoint_parameters(&mut self.system, t, y, lambda, out)?;
        negate(out);
        Ok(())
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.known = false;
        self.system.set_parameters(values);
    }
}

fn negate(numbers: &mut [f64]) {
    numbers.iter_mut().for_each(|number| *number = -*number);
}
