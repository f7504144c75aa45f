//! Sparsity patterns: found for many unknowns, and told where they lack entries.

use pliant::{
    integrate::{self, Cause, Integrator},
    rosenbrock::{self, Rosenbrock},
    solve::{Error, Method, Options, Output, Problem, Reason, solve},
    sundials::{
        Arkode, ArkodeOptions, ButcherTable, Cvode, CvodeOptions, Ida, IdaOptions, Jacobian,
        LinearSolver, Pattern,
    },
};

const DIFFERENCES: Jacobian = Jacobian::DifferenceQuotients;

/// Diffusion along n points whose first and last keep 0, with a source at y1 and a link from the first to the last point: the entry (n - 1, 0).
fn rod(
    n: usize,
    link: f64,
) -> impl FnMut(f64, &[f64], &mut [f64]) -> Result<(), pliant::ode::Failure> {
    let d = 100.0;
    move |_t, y, f| {
        for i in 0..n {
            let left = if i > 0 { y[i - 1] } else { 0.0 };
            let right = if i + 1 < n { y[i + 1] } else { 0.0 };
            f[i] = d * (left - 2.0 * y[i] + right);
        }
        f[n - 1] += link * y[0];
        Ok(())
    }
}

fn missing(error: &integrate::Error) -> (usize, usize, f64) {
    let integrate::Error::Integration(error) = error else { panic!("{error}") };
    let text = error.to_string();
    match error.cause {
        Cause::MissingEntry { row, column, difference } => {
            assert!(text.contains(&format!("lacks entry ({row}, {column})")), "{text}");
            (row, column, difference)
        }
        _ => panic!("{text}"),
    }
}

/// Of a band and of a pattern, in all integrators that take difference quotients on them: the entry is named, with its value, at the first steps. With
/// all entries, and with the check switched off, nothing is said.
#[test]
fn an_entry_that_a_pattern_lacks_is_named() {
    let n = 40;
    let y0: Vec<f64> = (0..n).map(|i| 1.0 + (i as f64).sin()).collect();
    let mut yp0 = vec![0.0; n];
    rod(n, 300.0)(0.0, &y0, &mut yp0).unwrap();
    let band = LinearSolver::Band { lower: 1, upper: 1, jacobian: DIFFERENCES };
    let klu = |pattern| LinearSolver::Klu { pattern, jacobian: DIFFERENCES };
    let tridiagonal = klu(Pattern::band(n, 1, 1).unwrap());
    let whole = klu(Pattern::ode_by_nan(&mut rod(n, 300.0), 0.0, &y0).unwrap());
    let residual = |t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
        rod(n, 300.0)(t, y, r)?;
        r.iter_mut().zip(yp).for_each(|(r, yp)| *r -= yp);
        Ok(())
    };
    let table = ButcherTable::implicit(4).unwrap();
    let outcomes = |solver: &LinearSolver, checks: bool| {
        let cvode = CvodeOptions::new(1e-6, 1e-9).newton(solver.clone()).check_jacobian(checks);
        let mut cvode = Cvode::new(rod(n, 300.0), 0.0, &y0, &cvode).unwrap();
        let arkode = ArkodeOptions::new(1e-6, 1e-9).table(table).newton(solver.clone());
        let arkode = arkode.check_jacobian(checks);
        let mut arkode = Arkode::new(rod(n, 300.0), 0.0, &y0, &arkode).unwrap();
        let ros = rosenbrock::Options::new(1e-6, 1e-9).newton(solver.clone());
        let ros = ros.check_jacobian(checks);
        let mut ros = Rosenbrock::new(rod(n, 300.0), 0.0, &y0, &ros).unwrap();
        let ida = IdaOptions::new(1e-6, 1e-9).newton(solver.clone()).check_jacobian(checks);
        let mut ida = Ida::new(residual, 0.0, &y0, &yp0, &ida).unwrap();
        let end = 0.05;
        let ode = [cvode.solve_to(end), arkode.solve_to(end), ros.solve_to(end)];
        (ode, ida.solve_to(end))
    };
    // the quotients of IDA on a band are those of SUNDIALS, out of sight
    let (ode, _) = outcomes(&band, true);
    let (by_pattern, dae) = outcomes(&tridiagonal, true);
    for outcome in ode.into_iter().chain(by_pattern).chain([dae]) {
        let (row, column, difference) = missing(&outcome.unwrap_err());
        assert_eq!((row, column), (n - 1, 0));
        // a linear equation: the quotient is exact to the rounding of values of about 100 in shifts of 1e-5
        assert!((difference - 300.0).abs() < 1e-6, "{difference}");
    }
    for (solver, checks) in [(&whole, true), (&tridiagonal, false)] {
        let (ode, dae) = outcomes(solver, checks);
        for outcome in ode.into_iter().chain([dae]) {
            outcome.unwrap();
        }
    }
}

/// A thousand points: the solution is that of a run with the pattern written down, and costs as many evaluations but for the search, where a
/// dense matrix would have taken a thousand for each Jacobian.
#[test]
fn many_unknowns_get_a_pattern() {
    let n = 1000;
    let y0: Vec<f64> = (0..n).map(|i| if i < 500 { 1.0 } else { 0.0 }).collect();
    let pattern = Pattern::ode_by_nan(&mut rod(n, 1.0), 0.0, &y0).unwrap();
    let options = || Options::new(1e-6, 1e-9).output(Output::End);
    let klu = LinearSolver::Klu { pattern, jacobian: DIFFERENCES };
    let implicit = Method::RungeKutta(ButcherTable::implicit(4).unwrap());
    for method in [Method::Bdf, Method::Adams, Method::Rosenbrock, implicit] {
        let given = options().linear_solver(klu.clone());
        let given = solve(Problem::ode(rod(n, 1.0), y0.clone()), method, (0.0, 1.0), &given);
        let found = solve(Problem::ode(rod(n, 1.0), y0.clone()), method, (0.0, 1.0), &options());
        let (given, found) = (given.unwrap(), found.unwrap());
        assert_eq!(found.last(), given.last(), "{method:?}");
        assert_eq!(found.statistics(), given.statistics(), "{method:?}");
    }
    let residual = move |t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
        rod(n, 1.0)(t, y, r)?;
        r.iter_mut().zip(yp).for_each(|(r, yp)| *r -= yp);
        Ok(())
    };
    let mut yp0 = vec![0.0; n];
    rod(n, 1.0)(0.0, &y0, &mut yp0).unwrap();
    let found = solve(Problem::dae(residual, y0.clone(), yp0), Method::Ida, (0.0, 1.0), &options())
        .unwrap();
    let statistics = found.statistics();
    assert!(
        statistics.difference_quotient_evaluations <= 5 * statistics.jacobian_evaluations,
        "{statistics:?}"
    );
}

/// Equations that depend on all unknowns keep their dense matrix, and those that have no value beside the start are asked nearer to it; none of that is an error.
#[test]
fn what_is_not_sparse_stays_dense() {
    let n = 501;
    let mean = move |_t: f64, y: &[f64], f: &mut [f64]| {
        let mean = y.iter().sum::<f64>() / n as f64;
        (0..n).for_each(|i| f[i] = mean - y[i]);
        Ok(())
    };
    let options = Options::new(1e-6, 1e-9).output(Output::End);
    let y0: Vec<f64> = (0..n).map(|i| i as f64).collect();
    let solution = solve(Problem::ode(mean, y0), Method::Bdf, (0.0, 1.0), &options).unwrap();
    assert!((solution.last()[0] - 250.0 * (1.0 - (-1.0_f64).exp())).abs() < 1e-3);
    let statistics = solution.statistics();
    assert!(statistics.difference_quotient_evaluations >= 501 * statistics.jacobian_evaluations);

    // beyond 1.001 there is no value
    let narrow = move |_t: f64, y: &[f64], f: &mut [f64]| {
        for i in 0..n {
            let next = y[(i + 1) % n];
            f[i] = (1.001 - next).sqrt() - y[i] - (0.001_f64).sqrt();
        }
        Ok(())
    };
    let solution =
        solve(Problem::ode(narrow, vec![1.0; n]), Method::Bdf, (0.0, 1e-3), &options).unwrap();
    let statistics = solution.statistics();
    assert!(statistics.difference_quotient_evaluations <= 8 * statistics.jacobian_evaluations);
}

/// Of equations that depend on another unknown later only: the error names the entry, and the search was one of some hundred evaluations.
#[test]
fn an_entry_that_comes_later_is_named() {
    let n = 600;
    let mut linked = rod(n, 1e3);
    let mut alone = rod(n, 0.0);
    let switching = move |t: f64, y: &[f64], f: &mut [f64]| {
        if t < 0.1 { alone(t, y, f) } else { linked(t, y, f) }
    };
    let problem = Problem::ode(switching, vec![1.0; n]);
    let error = solve(problem, Method::Bdf, (0.0, 10.0), &Options::new(1e-6, 1e-9)).unwrap_err();
    let Error::Stopped(stopped) = error else { panic!("{error}") };
    let Reason::Failed(error) = stopped.reason else { panic!("{stopped}") };
    assert_eq!(missing(&error).0, n - 1);
}

/// 60,000 unknowns of a ring without a word about their pattern: as a dense matrix they would take 29 GB.
#[test]
fn sixty_thousand_unknowns_need_no_pattern() {
    let n = 60_000;
    let ring = |_t: f64, y: &[f64], f: &mut [f64]| {
        for i in 0..n {
            f[i] = 1e4 * (y[(i + 1) % n] - 2.0 * y[i] + y[(i + n - 1) % n]);
        }
        Ok(())
    };
    let y0: Vec<f64> =
        (0..n).map(|i| (1e-3 * std::f64::consts::TAU * (i % 1000) as f64).cos()).collect();
    let options = Options::new(1e-4, 1e-6).output(Output::End);
    let solution =
        solve(Problem::ode(ring, y0.clone()), Method::Bdf, (0.0, 1.0), &options).unwrap();
    // a wave of 1000 points decays at the rate 4e4 sin^2(pi / 1000)
    let rate = 4e4 * (1e-3 * std::f64::consts::PI).sin().powi(2);
    assert!((solution.last()[0] - (-rate).exp()).abs() < 1e-3);
}

/// A dense matrix that no machine can store, as it is beyond the addresses of one, is refused before anything runs, with its size and what to do.
#[test]
fn a_dense_matrix_beyond_the_memory_is_refused() {
    let n = 4_000_000;
    let mean = |_t: f64, _y: &[f64], _f: &mut [f64]| panic!("it is not called");
    let y0 = vec![0.0; n];
    let errors = [
        Cvode::new(mean, 0.0, &y0, &CvodeOptions::new(1e-4, 1e-6)).err(),
        Rosenbrock::new(mean, 0.0, &y0, &rosenbrock::Options::new(1e-4, 1e-6)).err(),
    ];
    for error in errors {
        let error = error.unwrap().to_string();
        println!("{error}");
        assert!(
            error.contains("128000.0 GB") && error.contains("Pattern::ode_by_sampling"),
            "{error}"
        );
    }
}
