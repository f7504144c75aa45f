//! The method that is chosen by counted work: which one, when, what it costs, and that nothing of a run is lost where it changes.

use pliant::{
    ode::{Failure, Ode, dae_with_parameters, with_parameters},
    samples::{
        Brusselator, HeatedSquare, Hires, Oregonator, Pollution, Reference, Robertson, VanDerPol,
    },
    solve::{Event, Method, Options, Output, Problem, Run, Solution, gradient, solve},
    sundials::{AdjointOptions, Jacobian, LinearSolver, Sensitivities, Sign},
};

use crate::support::{G, fall, fall_under, sine, tight};

const DENSE: LinearSolver = LinearSolver::Dense(Jacobian::Supplied);

fn methods(solution: &Solution) -> Vec<Method> {
    solution.methods().iter().map(|used| used.method).collect()
}

/// Evaluations of the right-hand side, factorizations and iterations: what costs time in all but the smallest systems.
fn work(solution: &Solution) -> [u64; 2] {
    let s = solution.statistics();
    [s.evaluations + s.difference_quotient_evaluations, s.linear_setups]
}

/// A standard problem by `Auto` and by the method that it should come to, at the same tolerances: evaluations are at most twice as many, as
/// explicit steps of the first transient take six each and no iteration, factorizations 1.5 times, besides those of a trial. The error is
/// within `bound` tolerances, that of the other methods (`tests/integrators/standard_problems.rs`).
fn check<S: Ode + Send + Clone>(
    system: &S,
    y0: &[f64],
    Reference { t, y, .. }: Reference,
    solver: &LinearSolver,
    bound: f64,
    expected: [(f64, Method); 3],
) {
    for (rtol, method) in expected {
        let atol: Vec<f64> = y.iter().map(|y| rtol * y.abs()).collect();
        let options = Options::new(rtol, atol).output(Output::End);
        let implicit = options.clone().linear_solver(solver.clone());
        let run = |method, options: &Options| {
            solve(Problem::ode(system.clone(), y0), method, (0.0, t), options).unwrap()
        };
        let options = if method == Method::DormandPrince { &options } else { &implicit };
        let (auto, best) = (run(Method::Auto, &implicit), run(method, options));
        let used = auto.methods();
        assert!(used.iter().any(|used| used.method == method), "{rtol:e} {used:?}");
        let error = |solution: &Solution| {
            let parts = y.iter().zip(solution.last()).map(|(y, last)| (last / y - 1.0).abs());
            parts.fold(0.0, f64::max) / rtol
        };
        println!(
            "{rtol:e} {:.1} {:.1} {:?} {:?}",
            error(&auto),
            error(&best),
            work(&auto),
            work(&best)
        );
        let [[evaluations, factorizations], most] = [work(&auto), work(&best)];
        assert!(evaluations <= 2 * most[0] + 300, "{rtol:e} {evaluations} {most:?} {used:?}");
        assert!(2 * factorizations <= 3 * most[1] + 30, "{rtol:e} {factorizations} {most:?}");
        assert!(error(&auto) < bound, "{rtol:e} {}", error(&auto));
    }
}

#[test]
fn standard_problems_are_solved_by_the_method_that_costs_least() {
    use Method::{Bdf, DormandPrince, Rosenbrock};
    let eight = [(1e-4, Rosenbrock), (1e-6, Rosenbrock), (1e-8, Bdf)];
    check(&Hires::new(), &Hires::Y0, Hires::REFERENCE, &DENSE, 300.0, eight);
    let few = [(1e-4, Rosenbrock), (1e-6, Rosenbrock), (1e-9, Bdf)];
    check(&Robertson::new(), &Robertson::Y0, Robertson::REFERENCE, &DENSE, 25.0, few);
    check(&VanDerPol::new(), &VanDerPol::Y0, VanDerPol::REFERENCE, &DENSE, 100.0, few);
    check(&Oregonator::new(), &Oregonator::Y0, Oregonator::REFERENCE, &DENSE, 3200.0, few);
    let more = [(1e-3, Rosenbrock), (1e-7, Bdf), (1e-9, Bdf)];
    check(&Pollution::new(), &Pollution::Y0, Pollution::REFERENCE, &DENSE, 20.0, more);
    // stiff, but over so short a time that it never pays
    let brusselator = Brusselator::new(20);
    let band = LinearSolver::Band { lower: 2, upper: 2, jacobian: Jacobian::Supplied };
    let (y0, reference) = (brusselator.y0(), Brusselator::REFERENCE_20);
    let all = [1e-3, 1e-6, 1e-9].map(|rtol| (rtol, DormandPrince));
    check(&brusselator, &y0, reference, &band, 25.0, all);
}

/// Heat in a square of 1600 points begins with BDF, whose steps cost no more than explicit ones that stability limits, and takes its steps and little
/// more; over so short a time that few of those are left, or where the fastest rate is that of waves, it begins with explicit ones.
#[test]
fn many_unknowns_with_few_entries_may_begin_with_bdf() {
    let square = HeatedSquare::new(40);
    let klu = LinearSolver::Klu { pattern: square.pattern().clone(), jacobian: Jacobian::Supplied };
    for rtol in [1e-3, 1e-6] {
        let options = Options::new(rtol, rtol).linear_solver(klu.clone()).output(Output::End);
        let run = |method, t| {
            solve(Problem::ode(square.clone(), square.exact(0.0)), method, (0.0, t), &options)
                .unwrap()
        };
        let (auto, bdf) = (run(Method::Auto, 1.0), run(Method::Bdf, 1.0));
        assert_eq!(methods(&auto), [Method::Bdf], "{:?}", auto.methods());
        assert!(auto.methods()[0].reason.contains("stability limits"));
        let [[evaluations, factorizations], most] = [work(&auto), work(&bdf)];
        println!("{rtol:e} {evaluations} {factorizations} {most:?}");
        assert!(evaluations <= most[0] + 13 + most[0] / 4 && factorizations <= most[1]);
        let exact = square.exact(1.0);
        let error = auto.last().iter().zip(&exact).fold(0.0_f64, |e, (a, b)| e.max((a - b).abs()));
        assert!(error < 30.0 * rtol, "{error:e}");
        assert_eq!(methods(&run(Method::Auto, 1e-3)), [Method::DormandPrince]);
    }
    // waves on a string of 1000 points, by displacements and speeds
    let n = 1000;
    let string = move |_t: f64, y: &[f64], ydot: &mut [f64]| {
        for i in 0..n {
            let at = |k: usize| if (1..=n).contains(&k) { y[2 * (k - 1)] } else { 0.0 };
            ydot[2 * i] = y[2 * i + 1];
            ydot[2 * i + 1] = (at(i) - 2.0 * at(i + 1) + at(i + 2)) * ((n + 1) as f64).powi(2);
        }
        Ok(())
    };
    let y: Vec<f64> = (0..2 * n)
        .map(|k| {
            let x = (k / 2 + 1) as f64 / (n + 1) as f64;
            if k % 2 == 0 { (std::f64::consts::PI * x).sin() } else { 0.0 }
        })
        .collect();
    let band = LinearSolver::Band { lower: 3, upper: 3, jacobian: Jacobian::DifferenceQuotients };
    let options = Options::new(1e-5, 1e-5).linear_solver(band).output(Output::End);
    let waves = solve(Problem::ode(string, y), Method::Auto, (0.0, 1.0), &options).unwrap();
    assert_eq!(methods(&waves)[0], Method::DormandPrince, "{:?}", waves.methods());
}

/// y' = -k(t) (y - sin t) + cos t has the solution sin t, whatever k is: 1, a million from 10 to 20, and 1 again.
#[test]
fn it_changes_with_the_solution() {
    let stiff_for_a_while = |t: f64, y: &[f64], ydot: &mut [f64]| {
        let k = if (10.0..20.0).contains(&t) { 1e6 } else { 1.0 };
        ydot[0] = -k * (y[0] - t.sin()) + t.cos();
        Ok::<(), Failure>(())
    };
    for rtol in [1e-5, 1e-10] {
        let problem = Problem::ode(stiff_for_a_while, [0.0]).breaks([10.0, 20.0]);
        // the interpolant of the Rosenbrock method is a cubic: h^4 / 384 in the middle of a step
        let options = Options::new(rtol, rtol).max_step(if rtol > 1e-8 { 0.2 } else { 0.01 });
        let solution = solve(problem, Method::Auto, (0.0, 200.0), &options).unwrap();
        let used = solution.methods();
        assert_eq!(used[0].method, Method::DormandPrince);
        let implicit = used.iter().find(|used| used.method != Method::DormandPrince).unwrap();
        assert!((10.0..10.01).contains(&implicit.t), "{used:?}");
        assert!(implicit.reason.contains("stability limits"), "{used:?}");
        let back = used.iter().rfind(|used| used.method == Method::DormandPrince).unwrap();
        assert!(back.t >= 20.0, "{used:?}");
        // nothing is lost where the method changes: times, interpolants, counters
        assert!(solution.t().windows(2).all(|pair| pair[0] <= pair[1]));
        for k in 0..2000 {
            let t = 0.1 * f64::from(k);
            let error = (solution.at(t).unwrap()[0] - t.sin()).abs();
            assert!(error < 100.0 * rtol, "{rtol:e} {t} {error:e}");
        }
        let steps = solution.t().windows(2).filter(|pair| pair[0] < pair[1]).count() as u64;
        assert_eq!(solution.statistics().steps, steps);
        let least = if rtol > 1e-8 { 1000 } else { 20_000 };
        assert!(steps < least + least / 10, "{steps}");
    }
}

/// A ball dropped from 1 m that keeps 0.8 of its speed, in a run that others lead, too: saved, restored, advanced to times.
#[test]
fn events_and_runs_under_control() {
    let impact = || {
        Event::new(|_, y: &[f64]| y[0]).falling().action(|jump| jump.y[1] *= -0.8).terminal_after(3)
    };
    let exact = (2.0 / G).sqrt() * (1.0 + 2.0 * 0.8 + 2.0 * 0.64);
    let problem = || Problem::ode(fall, [1.0, 0.0]).event(impact());
    let solution = solve(problem(), Method::Auto, (0.0, 10.0), &tight()).unwrap();
    assert!((solution.t().last().unwrap() - exact).abs() < 1e-9);
    let mut run = Run::new(problem(), Method::Auto, (0.0, 10.0), &tight()).unwrap();
    run.advance_to(0.6).unwrap();
    let saved = run.save();
    run.advance_to(1.0).unwrap();
    let y = run.y().to_vec();
    run.restore(&saved).unwrap();
    run.advance_to(1.0).unwrap();
    assert!((run.y()[0] - y[0]).abs() < 1e-8);
    while run.advance().unwrap().is_some() {}
    assert!((run.t() - exact).abs() < 1e-9);
    assert_eq!(run.methods()[0].method, Method::DormandPrince);
}

/// A stiff solution that is kicked away from where it rests 400 times: short transients, in which explicit steps lead farther for their work.
#[test]
fn a_stiff_solution_is_kicked() {
    let kicked = |t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot[0] = -1e6 * (y[0] - t.cos());
        Ok::<(), Failure>(())
    };
    let problem = Problem::ode(kicked, [1.0]);
    let problem = problem.event(Event::every(0.5).action(|jump| jump.y[0] += 0.1));
    let options = Options::new(1e-10, 1e-10).output(Output::End);
    let solution = solve(problem, Method::Auto, (0.0, 200.25), &options).unwrap();
    // y = (k^2 cos t + k sin t) / (k^2 + 1)
    let (t, k) = (200.25_f64, 1e6);
    assert!((solution.last()[0] - (k * k * t.cos() + k * t.sin()) / (k * k + 1.0)).abs() < 1e-8);
    let used = methods(&solution);
    assert!(used.contains(&Method::DormandPrince) && used.contains(&Method::Bdf), "{used:?}");
}

/// A rate of 1e18 at t = 50, where numbers are 7e-15 apart: no explicit step is stable. y = cos t, but for 1e-18.
#[test]
fn a_method_that_fails_is_replaced() {
    let stiff = |t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot[0] = -1e18 * (y[0] - t.cos());
        Ok::<(), Failure>(())
    };
    // off the solution by rounding alone, which explicit steps blow up
    let start = 50_f64.cos() + 1e-7;
    let options = Options::new(1e-6, 1e-6).output(Output::End);
    let solution = solve(Problem::ode(stiff, [start]), Method::Auto, (50.0, 60.0), &options);
    let solution = solution.unwrap();
    assert!((solution.last()[0] - 60_f64.cos()).abs() < 1e-5);
    let used = solution.methods();
    assert_eq!(used[0].method, Method::DormandPrince);
    assert!(used[1].t == 50.0 && used[1].reason.contains("Dormand-Prince"), "{used:?}");
}

#[test]
fn there_may_be_no_choice() {
    let fixed = |problem: Problem<'_>, options: &Options, span: (f64, f64), expected: Method| {
        let solution = solve(problem, Method::Auto, span, options).unwrap();
        assert_eq!(methods(&solution), [expected]);
        solution
    };
    let dae = dae_with_parameters(
        |_t, y, yp, _p, r| {
            r[0] = yp[0] + y[0];
            Ok(())
        },
        [],
    );
    let solution = fixed(Problem::dae(dae, [1.0], [-1.0]), &tight(), (0.0, 1.0), Method::Ida);
    assert!((solution.last()[0] - (-1_f64).exp()).abs() < 1e-8);

    let solution = fixed(sine(), &tight(), (0.0, -1.0), Method::Bdf);
    assert!((solution.last()[0] + 1_f64.sin()).abs() < 1e-7);
    assert_eq!(solution.methods()[0].reason, "it goes backward in time");

    // dy/dg of a fall is -t^2/2
    let options = tight().sensitivities(Sensitivities::of([0]));
    let problem = Problem::ode(fall_under([G, 0.0]), [1.0, 0.0]);
    let solution = fixed(problem, &options, (0.0, 1.0), Method::Bdf);
    assert!((solution.sensitivities(solution.t().len() - 1)[(0, 0)] + 0.5).abs() < 1e-7);
    fixed(sine(), &tight().max_order(3), (0.0, 1.0), Method::Bdf);
    fixed(sine(), &tight().sign_constraints([Sign::Free; 2]), (0.0, 1.0), Method::Bdf);
    let solution = solve(sine(), Method::Adams, (0.0, 1.0), &tight()).unwrap();
    assert_eq!(solution.methods()[0].reason, "as asked for");
}

/// The slope of y(1) = y0 e^p by p, and input that is refused before the first step.
#[test]
fn gradients_and_refusals() {
    struct Last;
    impl pliant::ode::Functional for Last {
        fn terminal(
            &mut self,
            _t: f64,
            y: &[f64],
            _p: &[f64],
            slopes: Option<pliant::ode::Slopes<'_>>,
        ) -> Result<f64, Failure> {
            if let Some(slopes) = slopes {
                slopes.y[0] = 1.0;
            }
            Ok(y[0])
        }
    }
    let growth = || {
        with_parameters(
            |_t, y, p, ydot| {
                ydot[0] = p[0] * y[0];
                Ok(())
            },
            [0.5],
        )
    };
    let problem = Problem::ode(growth(), [2.0]);
    let back = AdjointOptions::new(1e-10, 1e-12);
    let found = gradient(problem, Last, Method::Auto, (0.0, 1.0), &tight(), &back).unwrap();
    assert!((found.parameters[0] - 2.0 * 0.5_f64.exp()).abs() < 1e-7);

    let band = LinearSolver::Band { lower: 3, upper: 0, jacobian: Jacobian::Supplied };
    let refused = solve(sine(), Method::Auto, (0.0, 1.0), &tight().linear_solver(band));
    assert!(refused.unwrap_err().to_string().contains("bandwidths"));
    let fatal = |t: f64, _: &[f64], ydot: &mut [f64]| {
        ydot[0] = 1.0;
        if t > 0.5 { Err(Failure::Fatal("out of paper".into())) } else { Ok(()) }
    };
    let stopped = solve(Problem::ode(fatal, [0.0]), Method::Auto, (0.0, 1.0), &tight());
    assert!(stopped.unwrap_err().to_string().contains("right-hand side failed"));
}
