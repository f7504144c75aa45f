//! Linear solvers and preconditioners of a system's own that answer zero: errors instead of smooth wrong solutions.

use pliant::{
    integrate::{Cause, Error},
    ode::{Dae, Failure, Ode},
    solve::{self, Method, Options, Problem, Reason, Solution, solve},
    sundials::{ButcherTable, Krylov, KrylovMethod, LinearSolver, Preconditioner, Side},
};

/// y' = -rate (y - 1) for two rates, with a solver whose answers are multiplied by a factor.
struct Pulled {
    factor: f64,
    gamma: f64,
}

const RATES: [f64; 2] = [100.0, 300.0];

fn pulled(factor: f64) -> Pulled {
    Pulled { factor, gamma: 0.0 }
}

impl Ode for Pulled {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        (0..2).for_each(|i| ydot[i] = -RATES[i] * (y[i] - 1.0));
        Ok(())
    }

    fn newton_setup(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        gamma: f64,
        _reuse: bool,
    ) -> Result<bool, Failure> {
        self.gamma = gamma;
        Ok(true)
    }

    fn newton_solve(&mut self, _gamma: f64, r: &mut [f64]) -> Result<(), Failure> {
        (0..2).for_each(|i| r[i] *= self.factor / (1.0 + self.gamma * RATES[i]));
        Ok(())
    }
}

/// The same as a DAE.
struct PulledDae(Pulled);

impl Dae for PulledDae {
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure> {
        self.0.rhs(t, y, residual)?;
        residual.iter_mut().zip(yp).for_each(|(r, yp)| *r = yp - *r);
        Ok(())
    }

    fn newton_setup(&mut self, _t: f64, cj: f64, _y: &[f64], _yp: &[f64]) -> Result<(), Failure> {
        self.0.gamma = cj;
        Ok(())
    }

    fn newton_solve(&mut self, r: &mut [f64]) -> Result<(), Failure> {
        (0..2).for_each(|i| r[i] *= self.0.factor / (self.0.gamma + RATES[i]));
        Ok(())
    }
}

fn problem<'a>(method: Method, factor: f64) -> Problem<'a> {
    match method {
        Method::Ida => Problem::dae(PulledDae(pulled(factor)), [0.0; 2], RATES),
        _ => Problem::ode(pulled(factor), [0.0; 2]),
    }
}

fn implicit() -> [Method; 5] {
    let table = ButcherTable::implicit(5).unwrap();
    [Method::Bdf, Method::Adams, Method::RungeKutta(table), Method::Rosenbrock, Method::Ida]
}

fn preconditioned(side: Side) -> LinearSolver {
    let gmres = Krylov::new(KrylovMethod::Gmres { dimension: 5, restarts: 0 });
    LinearSolver::Krylov(gmres.preconditioner(side, Preconditioner::Custom))
}

fn solved(method: Method, solver: LinearSolver, factor: f64) -> Result<Solution, solve::Error> {
    let options = Options::new(1e-6, 1e-9).linear_solver(solver);
    solve(problem(method, factor), method, (0.0, 1.0), &options)
}

/// The run ends near its start, with an error that says why.
fn is_told(outcome: Result<Solution, solve::Error>) {
    let error = outcome.unwrap_err();
    assert!(error.to_string().contains("newton_solve is wrong"), "{error}");
    let solve::Error::Stopped(stopped) = error else { panic!("{error}") };
    // the first steps may need no solution
    assert!(stopped.solution.t().last().is_some_and(|t| *t < 1e-6));
    let Reason::Failed(Error::Integration(error)) = stopped.reason else { panic!() };
    assert_eq!(error.cause, Cause::WrongSolver);
}

/// By every implicit method; a solver that is right is not.
#[test]
fn a_solver_that_is_zero_is_told() {
    for method in implicit() {
        is_told(solved(method, LinearSolver::Custom, 0.0));
        let last = solved(method, LinearSolver::Custom, 1.0).unwrap().last().to_vec();
        assert!(last.iter().all(|y| (y - 1.0).abs() < 1e-5), "{method:?}: {last:?}");
    }
}

/// Preconditioners may be off by any other factor.
#[test]
fn a_preconditioner_that_is_zero_is_told() {
    for (method, side) in [
        (Method::Bdf, Side::Left),
        (Method::Bdf, Side::Right),
        (Method::RungeKutta(ButcherTable::implicit(5).unwrap()), Side::Left),
        (Method::Ida, Side::Left),
    ] {
        is_told(solved(method, preconditioned(side), 0.0));
        for factor in [1.0, 0.1, -3.0] {
            let last = solved(method, preconditioned(side), factor).unwrap().last().to_vec();
            assert!(last.iter().all(|y| (y - 1.0).abs() < 1e-5), "{method:?} {factor}: {last:?}");
        }
    }
}
