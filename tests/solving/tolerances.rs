//! Relative tolerances of 0 and next to it: the absolute ones alone count, as in examples of SUNDIALS.

use pliant::{
    ode::with_parameters,
    solve::{Method, Options, Output, Problem, solve},
    sundials::{
        Jacobian, Krylov, KrylovMethod, LinearSolver, Pattern, Preconditioner, Sensitivities, Side,
    },
};

use crate::support::methods;

/// Van der Pol's oscillator for mu = 3.
fn van_der_pol(_t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), pliant::ode::Failure> {
    ydot[0] = y[1];
    ydot[1] = 3.0 * (1.0 - y[0] * y[0]) * y[1] - y[0];
    Ok(())
}

const END: f64 = 8.0;

fn state_at_the_end() -> Vec<f64> {
    let options = Options::new(1e-13, 1e-14).output(Output::End);
    let problem = Problem::ode(van_der_pol, [2.0, 0.0]);
    solve(problem, Method::DormandPrince, (0.0, END), &options).unwrap().last().to_vec()
}

fn check(name: &str, method: Method, rtol: f64, options: Options, steps: u64) {
    let reference = state_at_the_end();
    let problem = Problem::ode(van_der_pol, [2.0, 0.0]);
    let solution = solve(problem, method, (0.0, END), &options.output(Output::End)).unwrap();
    let error = (0..2).map(|i| (solution.last()[i] - reference[i]).abs()).fold(0.0, f64::max);
    let taken = solution.statistics().steps;
    println!("{name} {method:?} {rtol:e}: {error:e} {taken}");
    // the passage through zero magnifies 1e-6 of a step by up to 1e3: measured up to 9e-4, as with rtol = 1e-6
    assert!(error < 2e-3, "{name} {method:?} {rtol:e}: {error:e}");
    assert!(taken < steps, "{name} {method:?} {rtol:e}: {taken}");
}

/// By every method and every form of the Newton matrix.
#[test]
fn no_relative_tolerance_is_needed() {
    let quotients = Jacobian::DifferenceQuotients;
    let krylov = Krylov::new(KrylovMethod::Gmres { dimension: 2, restarts: 0 });
    let pattern = Pattern::band(2, 1, 1).unwrap();
    let solvers =
        [
            ("dense", LinearSolver::Dense(quotients)),
            ("band", LinearSolver::Band { upper: 1, lower: 1, jacobian: quotients }),
            ("sparse", LinearSolver::Klu { pattern: pattern.clone(), jacobian: quotients }),
            ("Krylov", LinearSolver::Krylov(krylov.clone())),
            (
                "ILU",
                LinearSolver::Krylov(krylov.preconditioner(
                    Side::Right,
                    Preconditioner::Ilu { pattern, jacobian: quotients },
                )),
            ),
        ];
    for rtol in [0.0, 1e-20, 1e-100, f64::MIN_POSITIVE] {
        let options = Options::new(rtol, 1e-6);
        for method in methods() {
            if method != Method::DormandPrince || rtol == 0.0 {
                check("default", method, rtol, options.clone(), 3000);
            }
        }
        for (name, solver) in &solvers {
            check(name, Method::Bdf, rtol, options.clone().linear_solver(solver.clone()), 1000);
        }
        if rtol == 0.0 {
            check("default", Method::Rosenbrock, rtol, options, 3000);
        }
    }
}

/// A DAE, and sensitivities: y' = -p y, z = y.
#[test]
fn daes_and_sensitivities_need_none_either() {
    let expected = -2.0 * (-2f64).exp();
    for rtol in [0.0, 1e-20, 1e-100] {
        let options = Options::new(rtol, 1e-8).sensitivities(Sensitivities::of([0]));
        let rhs = |_t: f64, y: &[f64], p: &[f64], f: &mut [f64]| {
            f[0] = -p[0] * y[0];
            Ok(())
        };
        let ode = Problem::ode(with_parameters(rhs, [1.0]), [1.0]);
        let solution = solve(ode, Method::Bdf, (0.0, 2.0), &options).unwrap();
        let s = solution.sensitivities(solution.t().len() - 1)[(0, 0)];
        assert!((s - expected).abs() < 1e-6, "{rtol:e}: {s} {expected}");

        let residual = |_t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
            r[0] = yp[0] + y[1];
            r[1] = y[1] - y[0];
            Ok(())
        };
        let dae = Problem::dae(residual, [1.0, 1.0], [-1.0, -1.0]);
        let solution = solve(dae, Method::Ida, (0.0, 2.0), &Options::new(rtol, 1e-8)).unwrap();
        assert!((solution.last()[1] - (-2f64).exp()).abs() < 1e-6, "{:?}", solution.last());
    }
}

/// A diode behind a resistance: the current rises by e with each 25 mV, and increments may be no larger, whatever rtol is.
#[test]
fn increments_do_not_leave_what_is_linear() {
    let diode = |t: f64, y: &[f64], f: &mut [f64]| {
        f[0] = 1e3 * (5.0 * (100.0 * t).sin() - y[0] - 1e-6 * ((y[0] / 0.025).exp() - 1.0));
        Ok(())
    };
    let solved = |method, rtol, atol| {
        let options = Options::new(rtol, atol).output(Output::End);
        solve(Problem::ode(diode, [0.0]), method, (0.0, 0.05), &options).unwrap()
    };
    let expected = solved(Method::Bdf, 1e-10, 1e-12).last()[0];
    for method in [Method::Bdf, Method::Rosenbrock] {
        let usual = solved(method, 1e-6, 1e-3).statistics().steps;
        for (rtol, atol) in [(0.0, 1e-3), (1e-8, 1e-3), (1e-12, 1e-3), (1e-13, 1e-2)] {
            let solution = solved(method, rtol, atol);
            let (error, steps) =
                ((solution.last()[0] - expected).abs(), solution.statistics().steps);
            println!("{method:?} {rtol:e} {atol:e}: {error:e} {steps} {usual}");
            assert!(error < atol && steps < 2 * usual, "{method:?} {rtol:e}: {error:e} {steps}");
        }
    }
}

/// One of the two tolerances counts for each unknown, or there is none.
#[test]
fn unknowns_without_tolerance_are_refused() {
    for method in methods() {
        for atol in [vec![0.0, 0.0], vec![1e-6, 0.0]] {
            let problem = Problem::ode(van_der_pol, [2.0, 1.0]);
            let error = solve(problem, method, (0.0, 1.0), &Options::new(0.0, atol)).unwrap_err();
            assert!(error.to_string().contains("has no rtol either"), "{error}");
        }
        let problem = Problem::ode(van_der_pol, [2.0, 1.0]);
        let error = solve(problem, method, (0.0, 1.0), &Options::new(-1e-6, 1e-6)).unwrap_err();
        assert!(error.to_string().contains("at least 0 and below 1"), "{error}");
    }
}
