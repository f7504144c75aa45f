//! Linear solvers and preconditioners of a system's own that answer zero, or off by a factor: errors instead of smooth wrong solutions.

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
    solutions: u32,
}

const RATES: [f64; 2] = [100.0, 300.0];

fn pulled(factor: f64) -> Pulled {
    Pulled { factor, gamma: 0.0, solutions: 0 }
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
        self.solutions += 1;
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

/// The factor that an error tells, of a run that ended at its start.
fn found(outcome: Result<Solution, solve::Error>) -> f64 {
    let error = outcome.unwrap_err();
    println!("{error}");
    let solve::Error::Stopped(stopped) = error else { panic!("{error}") };
    assert!(stopped.to_string().contains("newton_solve is wrong"), "{stopped}");
    assert_eq!(stopped.solution.t(), [0.0]);
    match stopped.reason {
        Reason::Failed(Error::Integration(error)) => match error.cause {
            Cause::WrongSolver { factor } => factor,
            cause => panic!("{cause:?}"),
        },
        reason => panic!("{reason}"),
    }
}

/// Factors with which Newton's method cannot converge are told; one that is right is not, nor one that only slows it down.
#[test]
fn a_factor_that_is_off_is_told() {
    for method in implicit() {
        for factor in [0.0, 1e-3, -1.0, 3.0, 1e6] {
            let told = found(solved(method, LinearSolver::Custom, factor));
            assert!((told - factor).abs() <= 1e-4 * factor.abs(), "{method:?}: {told} {factor}");
        }
        for factor in [1.0, 0.9] {
            let solution = solved(method, LinearSolver::Custom, factor);
            // the linear solution is the whole answer of a Rosenbrock method, and whatever it is off by stays
            if method == Method::Rosenbrock && factor != 1.0 {
                continue;
            }
            let last = solution.unwrap().last().to_vec();
            assert!(last.iter().all(|y| (y - 1.0).abs() < 1e-5), "{method:?} {factor}: {last:?}");
        }
    }
}

/// Preconditioners may be off by any factor, but for zero.
#[test]
fn a_preconditioner_that_is_zero_is_told() {
    for (method, side) in [
        (Method::Bdf, Side::Left),
        (Method::Bdf, Side::Right),
        (Method::RungeKutta(ButcherTable::implicit(5).unwrap()), Side::Left),
        (Method::Ida, Side::Left),
    ] {
        assert_eq!(found(solved(method, preconditioned(side), 0.0)), 0.0);
        for factor in [1.0, 0.1, -3.0] {
            let last = solved(method, preconditioned(side), factor).unwrap().last().to_vec();
            assert!(last.iter().all(|y| (y - 1.0).abs() < 1e-5), "{method:?} {factor}: {last:?}");
        }
    }
}

/// The check can be switched off; it takes two solutions at the first set-up, the second, the fourth and so on.
#[test]
fn the_check_is_rare_and_can_be_switched_off() {
    let options = Options::new(1e-6, 1e-9).linear_solver(LinearSolver::Custom);
    let count = |options: &Options| {
        let mut system = pulled(1.0);
        let lent = pliant::ode::Borrowed(&mut system);
        let solution =
            solve(Problem::ode(lent, [0.0; 2]), Method::Bdf, (0.0, 1.0), options).unwrap();
        let setups = solution.statistics().linear_setups;
        (system.solutions, setups, solution.last().to_vec())
    };
    let (checked, setups, last) = count(&options);
    let (trusted, _, same) = count(&options.clone().check_jacobian(false));
    assert_eq!(last, same);
    assert_eq!(u64::from(checked - trusted), 2 * (1 + u64::from(setups.ilog2())));
    let unchecked = options.check_jacobian(false);
    solve(problem(Method::Bdf, 0.0), Method::Bdf, (0.0, 1.0), &unchecked).unwrap();
}
