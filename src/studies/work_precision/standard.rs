//! Standard stiff problems, by all methods or all linear solvers that make sense for them.

use super::General;
use crate::integrators::ode::Ode;
use crate::integrators::sundials::{
    Ida, Jacobian, Krylov, KrylovMethod, LinearSolver, MassForm, Pattern, Preconditioner, Side,
};
use crate::studies::samples::{
    Brusselator, HeatedSquare, Hires, Oregonator, Pollution, Reference, Robertson,
    TransistorAmplifier, VanDerPol,
};

const DENSE: LinearSolver = LinearSolver::Dense(Jacobian::Supplied);

/// Standard problems.
impl General {
    /// HIRES: eight reactions, mildly stiff.
    #[must_use]
    pub fn hires() -> Self {
        small("HIRES", &Hires::new(), &Hires::Y0, Hires::REFERENCE)
    }

    /// Robertson's reactions, to t = 4e10.
    #[must_use]
    pub fn robertson() -> Self {
        small("Robertson", &Robertson::new(), &Robertson::Y0, Robertson::REFERENCE)
    }

    /// Van der Pol's oscillator, mu = 1000.
    #[must_use]
    pub fn van_der_pol() -> Self {
        small("van der Pol", &VanDerPol::new(), &VanDerPol::Y0, VanDerPol::REFERENCE)
    }

    /// The Oregonator, a limit cycle with sudden jumps.
    #[must_use]
    pub fn oregonator() -> Self {
        small("Oregonator", &Oregonator::new(), &Oregonator::Y0, Oregonator::REFERENCE)
    }

    /// Air pollution: 20 species.
    #[must_use]
    pub fn pollution() -> Self {
        small("Pollution", &Pollution::new(), &Pollution::Y0, Pollution::REFERENCE)
    }

    /// The transistor amplifier, a DAE: by IDA alone, with limits on its order.
    #[must_use]
    pub fn transistor_amplifier() -> Self {
        let orders = [("ida", 5), ("ida, order 4", 4), ("ida, order 3", 3), ("ida, order 2", 2)];
        orders.into_iter().fold(
            known("Transistor amplifier", TransistorAmplifier::REFERENCE),
            |problem, (name, order)| {
                problem.line(name, "ida", move |goal| {
                    let (y0, yp0) = (TransistorAmplifier::Y0, TransistorAmplifier::YP0);
                    let system = MassForm::new(TransistorAmplifier, y0.len(), &DENSE)?;
                    let options = goal.ida().newton(DENSE).max_order(order);
                    goal.reach(Ida::new(system, 0.0, &y0, &yp0, &options)?)
                })
            },
        )
    }

    /// The Brusselator on a line of 500 points: the same steps by all linear solvers, and other methods.
    #[must_use]
    pub fn brusselator() -> Self {
        let system = Brusselator::new(500);
        let (y0, half) = (system.y0(), Brusselator::BANDWIDTH);
        let supplied = Jacobian::Supplied;
        let band = LinearSolver::Band { lower: half, upper: half, jacobian: supplied };
        let [klu, coloured] = [supplied, Jacobian::DifferenceQuotients]
            .map(|jacobian| LinearSolver::Klu { pattern: system.pattern().clone(), jacobian });
        let [gmres, ilu] = krylov(system.pattern());
        General::agreed("Brusselator, 500 points", 10.0, vec![1.0; y0.len()], ["rk", "arkode"])
            .linear_solvers(
                &system,
                &y0,
                [
                    ("cvode-bdf, band", &band),
                    ("cvode-bdf, KLU", &klu),
                    ("cvode-bdf, KLU, coloured", &coloured),
                    ("cvode-bdf, GMRES", &gmres),
                    ("cvode-bdf, GMRES, ILU", &ilu),
                    ("cvode-bdf, dense", &DENSE),
                ],
            )
            .ida("ida, band", &system, &y0, &band)
            .arkode("arkode", &system, &y0, &klu, 5)
            .rk(&system, &y0)
    }

    /// Heat in a square of 100 x 100 points.
    #[must_use]
    pub fn heated_square() -> Self {
        let side = 100;
        let system = HeatedSquare::new(side);
        let (y0, end, jacobian) = (system.exact(0.0), 0.1, Jacobian::Supplied);
        let band = LinearSolver::Band { lower: side, upper: side, jacobian };
        let klu = LinearSolver::Klu { pattern: system.pattern().clone(), jacobian };
        let [gmres, ilu] = krylov(system.pattern());
        General::new("Heated square, 100 x 100 points", end, system.exact(end), 1e-13)
            .linear_solvers(
                &system,
                &y0,
                [
                    ("cvode-bdf, band", &band),
                    ("cvode-bdf, KLU", &klu),
                    ("cvode-bdf, GMRES", &gmres),
                    ("cvode-bdf, GMRES, ILU", &ilu),
                ],
            )
            .arkode("arkode, KLU", &system, &y0, &klu, 4)
            .arkode("arkode, GMRES, ILU", &system, &y0, &ilu, 4)
            .rk(&system, &y0)
    }

    /// BDF with several solvers of its linear systems.
    fn linear_solvers<S: Ode + Clone + 'static, const N: usize>(
        self,
        system: &S,
        y0: &[f64],
        solvers: [(&str, &LinearSolver); N],
    ) -> Self {
        solvers.into_iter().fold(self, |problem, (name, newton)| {
            problem.cvode(name, system, y0, newton, |options| options)
        })
    }
}

fn known(title: &str, Reference { t, y, digits, .. }: Reference) -> General {
    General::new(title, t, y, 10_f64.powi(-(digits as i32)))
}

/// A problem of a few unknowns: dense matrices, all methods.
fn small<S: Ode + Clone + 'static>(
    title: &str,
    system: &S,
    y0: &[f64],
    reference: Reference,
) -> General {
    known(title, reference).methods(system, y0, &DENSE)
}

/// GMRES by itself, and with ILU(0).
fn krylov(pattern: &Pattern) -> [LinearSolver; 2] {
    let gmres = Krylov::new(KrylovMethod::Gmres { dimension: 20, restarts: 2 });
    let ilu = Preconditioner::Ilu { pattern: pattern.clone(), jacobian: Jacobian::Supplied };
    [gmres.clone(), gmres.preconditioner(Side::Left, ilu)].map(LinearSolver::Krylov)
}
