//! A system with a functional: equations of the forward run and of the backward run.

use faer::MatMut;

use super::products::Products;
use crate::base::input::InputError;
use crate::integrators::{
    common::{Error, Tolerances, check_finite},
    ode::{BandMut, Dae, Entries, Failure, Functional, call, delegate::delegate},
    sundials::{
        LinearSolver,
        adjoint::{
            backward::Point,
            equations::{Equations, refused},
            options::AdjointOptions,
            slopes::SlopesCheck,
        },
        sensitivity::Access,
        stored_matrix::StoredMatrix,
    },
};

/// A [`Dae`] F(t, y, y') = 0 with the integral of a functional in addition. dF/dy' is constant, so that F is
/// linear in y'.
pub(super) struct AdjointDae<S, F> {
    pub(super) equations: Equations<S, F>,
    /// The check of (dF/dy)^T lambda and (dF/dy')^T lambda, where the system supplies them.
    pub(super) supplied_rhs: Option<SlopesCheck>,
    supplied_parameters: bool,
    /// Of a Krylov method.
    pub(super) products: Option<Products>,
    /// Which unknowns were declared differential.
    pub(super) differential: Vec<bool>,
    /// dF/dy'
    pub(super) mass: StoredMatrix,
    /// Which equations contain no y'.
    pub(super) algebraic: Vec<bool>,
    /// Two shifted y', and F at both.
    pub(super) moved: [Vec<f64>; 2],
    pub(super) residuals: [Vec<f64>; 2],
}

impl<S: Dae, F: Functional> AdjointDae<S, F> {
    pub(super) fn new(
        system: S,
        functional: F,
        n: usize,
        (solver, tolerances, differential): (&LinearSolver, &Tolerances, &[bool]),
        options: &AdjointOptions,
    ) -> Result<Self, InputError> {
        let access = Access { get: S::parameters, set: S::set_parameters };
        let vector = || vec![0.0; n];
        let equations = Equations::new(system, functional, access, n, (solver, tolerances))?;
        let products = Products::new(&equations.backward, n);
        if products.is_some() && !options.supplied_rhs {
            let help = "there are no entries of the Jacobian to transpose: write adjoint_residual, and say so by \
                        AdjointOptions::supplied_rhs";
            return Err(InputError::new("linear solver", "Krylov", help));
        }
        Ok(Self {
            equations,
            products,
            supplied_rhs: options.supplied_rhs.then(|| SlopesCheck::new((n, tolerances), n)),
            supplied_parameters: options.supplied_parameters,
            differential: differential.to_vec(),
            mass: StoredMatrix::new(solver, n),
            algebraic: vec![false; n],
            moved: [vector(), vector()],
            residuals: [vector(), vector()],
        })
    }

    /// Finds dF/dy' at the start, and the algebraic equations: there have to be as many as algebraic
    /// unknowns.
    pub(super) fn start(&mut self, (t, y, yp): Point<'_>) -> Result<(), Error> {
        // F is linear in y', so that differences over large steps contain nothing but dF/dy'
        const LARGE: f64 = 1024.0 * 1024.0;
        self.equations.forget();
        if self.products.is_some() {
            self.start_products((t, y, yp))?;
            self.check_counts()?;
            // for the preconditioner
            if self.mass.values().is_empty() {
                return Ok(());
            }
        }
        let step = |j: usize| LARGE * self.equations.size(j, y[j]).max(yp[j].abs());
        let steps: Vec<f64> = (0..y.len()).map(step).collect();
        let Equations { system, quotients, .. } = &mut self.equations;
        let evaluate =
            |yp: &[f64], residual: &mut [f64]| call::residual(system, t, y, yp, residual);
        quotients
            .write(&mut self.mass, yp, |j| steps[j], evaluate)
            .map_err(|failure| refused("IDA", t, failure))?;
        check_finite("dF/dy'", self.mass.values())?;
        if self.products.is_some() {
            return Ok(());
        }
        self.algebraic.fill(true);
        let mut wrong = None;
        self.mass.each(|i, j, value| {
            if value != 0.0 {
                self.algebraic[i] = false;
                if !self.differential[j] {
                    wrong = Some((i, j));
                }
            }
        });
        if let Some((i, j)) = wrong {
            let help = format!("its derivative occurs in equation {i}");
            return Err(Error::input("differential", format!("false of unknown {j}"), help));
        }
        self.check_counts()
    }

    /// Refuses another number of algebraic equations than of algebraic unknowns.
    fn check_counts(&self) -> Result<(), Error> {
        let unknowns = self.differential.iter().filter(|differential| !*differential).count();
        let equations = self.algebraic.iter().filter(|algebraic| **algebraic).count();
        if unknowns != equations {
            let help = format!(
                "of the equations {equations} are without derivatives: an adjoint gradient needs as many of them as \
                 there are algebraic unknowns"
            );
            return Err(Error::input("differential", format!("{unknowns} times false"), help));
        }
        Ok(())
    }

    /// Writes (dF/dy')^T lambda' - (dF/dy)^T lambda + dh/dy.
    pub(super) fn backward_residual(
        &mut self,
        (t, y, yp): Point<'_>,
        (lambda, slope): (&[f64], &[f64]),
        out: &mut [f64],
    ) -> Result<(), Failure> {
        if self.supplied_rhs.is_some() {
            self.check_products((t, y, yp))?;
            self.check_supplied((t, y, yp), lambda)?;
            let [negative, _] = &mut self.moved;
            negative.iter_mut().zip(lambda).for_each(|(negative, lambda)| *negative = -lambda);
            let system = &mut self.equations.system;
            call::adjoint_residual(system, t, y, yp, negative, slope, out)?;
        } else {
            self.update_jacobian((t, y, yp))?;
            out.fill(0.0);
            self.mass.add_transposed_times(1.0, slope, out);
            self.equations.jacobian.add_transposed_times(-1.0, lambda, out);
        }
        self.equations.evaluate_slopes(t, y)?;
        out.iter_mut().zip(&self.equations.slopes_y).for_each(|(out, slope)| *out += slope);
        Ok(())
    }

    /// Writes (dF/dy)^T lambda.
    pub(super) fn by_state(
        &mut self,
        at: Point<'_>,
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        if self.supplied_rhs.is_some() {
            return self.transposed_times(at, [1.0, 0.0], lambda, out);
        }
        self.update_jacobian(at)?;
        out.fill(0.0);
        self.equations.jacobian.add_transposed_times(1.0, lambda, out);
        Ok(())
    }

    /// Writes the integrand that, integrated back in time, gives dG/dp: (dF/dp)^T lambda - dh/dp.
    pub(super) fn backward_quadratures(
        &mut self,
        (t, y, yp): Point<'_>,
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        self.by_parameters((t, y, yp), lambda, out)?;
        self.equations.evaluate_slopes(t, y)?;
        out.iter_mut().zip(&self.equations.slopes_p).for_each(|(out, slope)| *out -= slope);
        Ok(())
    }

    /// Writes (dF/dp)^T lambda.
    pub(super) fn by_parameters(
        &mut self,
        (t, y, yp): Point<'_>,
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        if self.supplied_parameters {
            let system = &mut self.equations.system;
            return call::dae_adjoint_parameters(system, t, y, yp, lambda, out);
        }
        let evaluate =
            |system: &mut S, residual: &mut [f64]| call::residual(system, t, y, yp, residual);
        self.equations.parameter_differences(lambda, out, evaluate)
    }

    /// Writes the values of the derivative of `backward_residual` with respect to lambda, with lambda' =
    /// cj lambda: cj (dF/dy')^T - (dF/dy)^T.
    pub(super) fn backward_jacobian(
        &mut self,
        point: Point<'_>,
        cj: f64,
        values: &mut [f64],
    ) -> Result<(), Failure> {
        self.update_jacobian(point)?;
        let Equations { jacobian, backward, .. } = &self.equations;
        let entries = backward.entries(point.1.len(), values);
        let (by_slope, by_state) = (self.mass.values(), jacobian.values());
        let value = |_, position: usize| cj * by_slope[position] - by_state[position];
        jacobian.write_transposed(backward, entries, value);
        Ok(())
    }

    /// Updates dF/dy to this point, and checks that dF/dy' is unchanged there.
    pub(super) fn update_jacobian(&mut self, (t, y, yp): Point<'_>) -> Result<(), Failure> {
        let supplied = |system: &mut S, entries: Entries<'_>, _: &mut [f64]| {
            entries.dae_jacobian(system, t, 0.0, y, yp)
        };
        let evaluate = |system: &mut S, y: &[f64], residual: &mut [f64]| {
            call::residual(system, t, y, yp, residual)
        };
        if self.equations.update_jacobian(t, y, supplied, evaluate)? {
            let checked = match self.products {
                Some(_) => self.check_products((t, y, yp)),
                None => self.check_mass((t, y, yp)),
            };
            if checked.is_err() {
                self.equations.forget();
            }
            checked?;
        }
        Ok(())
    }

    /// Checks that F changes as dF/dy' of the start predicts, if all y' change at once, each by another
    /// amount.
    fn check_mass(&mut self, (t, y, yp): Point<'_>) -> Result<(), Failure> {
        // not a multiple of the steps by which dF/dy' was found, as F may not be linear in y'
        const LARGE: f64 = 70_000.0;
        // smaller changes do not matter for gradients
        const TOLERANCE: f64 = 1e-6;
        for j in 0..y.len() {
            let step = LARGE * uneven(j) * self.equations.size(j, y[j]).max(yp[j].abs());
            (self.moved[0][j], self.moved[1][j]) = (yp[j] + step, yp[j] - step);
        }
        let [ahead, behind] = &mut self.residuals;
        call::residual(&mut self.equations.system, t, y, &self.moved[0], ahead)?;
        call::residual(&mut self.equations.system, t, y, &self.moved[1], behind)?;
        ahead.iter_mut().zip(behind.iter()).for_each(|(ahead, behind)| *ahead -= behind);
        if ahead.iter().any(|difference| !difference.is_finite()) {
            let message = "F is not finite for large y': it has to be linear in y'";
            return Err(Failure::Recoverable(message.into()));
        }
        behind.fill(0.0);
        let [from, to] = [&self.moved[1], &self.moved[0]];
        self.mass.each(|i, j, value| {
            let change = value * (to[j] - from[j]);
            ahead[i] -= change;
            behind[i] += change.abs();
        });
        let changed =
            ahead.iter().zip(behind.iter()).position(|(d, size)| d.abs() > TOLERANCE * size);
        changed.map_or(Ok(()), |i| Err(Self::changed(i)))
    }

    /// The failure of an equation whose dF/dy' is not constant.
    pub(super) fn changed(i: usize) -> Failure {
        let why = format!(
            "dF/dy' of equation {i} is not that of the start: an adjoint gradient needs it constant; write \
             0 = F(t, y, z) with y' = z for such equations, and z as more algebraic unknowns"
        );
        Failure::Fatal(why.into())
    }
}

/// Numbers between 1 and 2 without a pattern.
pub(super) fn uneven(j: usize) -> f64 {
    1.0 + (j as f64 * 0.618_033_988_749_894_9).fract()
}

impl<S: Dae, F: Functional> Dae for AdjointDae<S, F> {
    delegate!(Dae in equations.system: equations);

    fn quadrature_count(&self) -> usize {
        1
    }

    fn quadratures(
        &mut self,
        t: f64,
        y: &[f64],
        _yp: &[f64],
        qdot: &mut [f64],
    ) -> Result<(), Failure> {
        qdot[0] = self.equations.running(t, y)?;
        Ok(())
    }
}
