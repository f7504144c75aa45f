//! Runs that cannot get on, and times that rounding hardly tells apart.

use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering::Relaxed};

use pliant::{
    integrate::{self, Callback, Cause, Integrator},
    ode::{Failure, with_mass},
    rk,
    rosenbrock::{self, Rosenbrock},
    solve::{Error, Event, Method, Options, Problem, Reason, solve},
    sundials::{
        Arkode, ArkodeOptions, ButcherTable, Cvode, CvodeOptions, Ida, IdaOptions, Multistep,
    },
};

use crate::support::methods;

/// All methods, with those for DAEs and of Rosenbrock.
fn all_methods() -> Vec<Method> {
    [methods(), vec![Method::Rosenbrock, Method::Ida]].concat()
}

/// The equations as a method takes them.
fn problem<'a>(
    method: Method,
    rhs: impl FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure> + Send + 'a,
    y: &[f64],
) -> Problem<'a> {
    match method {
        Method::Ida => Problem::ode(with_mass(rhs, vec![1.0; y.len()]), y),
        _ => Problem::ode(rhs, y),
    }
}

fn integration_cause(error: &integrate::Error) -> &Cause {
    match error {
        integrate::Error::Integration(error) => &error.cause,
        other => panic!("{other:?}"),
    }
}

type Rhs = fn(f64, &[f64], &mut [f64]);

/// y' = -y, but for what `Rhs` makes of it.
const BROKEN: [(&str, Rhs, usize); 4] = [
    (
        "NaN from 0.5 on",
        |t, _, f| {
            if t >= 0.5 {
                f[0] = f64::NAN
            }
        },
        0,
    ),
    (
        "infinity from 0.5 on",
        |t, _, f| {
            if t >= 0.5 {
                f[1] = f64::INFINITY
            }
        },
        1,
    ),
    (
        "-infinity between two times",
        |t, _, f| {
            if (0.5..0.9).contains(&t) {
                f[1] = f64::NEG_INFINITY
            }
        },
        1,
    ),
    (
        "NaN below a state",
        |_, y, f| {
            if y[0] <= 0.5 {
                f[1] = f64::NAN
            }
        },
        1,
    ),
];

/// What gives no number keeps a run from going on: that is told, with the place, after some hundred evaluations and not at the limit of steps.
#[test]
fn what_is_no_number_is_told_by_every_method() {
    for (name, broken, component) in BROKEN {
        let calls = AtomicU64::new(0);
        let rhs = |t: f64, y: &[f64], f: &mut [f64]| {
            calls.fetch_add(1, Relaxed);
            f[0] = -y[0];
            f[1] = -y[1];
            broken(t, y, f);
            Ok(())
        };
        let check = |by: String, cause: &Cause, text: String| {
            println!("{name}, {by}, {} calls: {text}", calls.load(Relaxed));
            let Cause::NotFinite { callback, t, component: at, .. } = *cause else {
                panic!("{name}, {by}: {text}")
            };
            // quotients of the Rosenbrock method go where the state goes, and may see it first
            let by_equations = matches!(callback, Callback::Rhs | Callback::Residual);
            let by_quotients = callback == Callback::Jacobian && by == "Rosenbrock";
            assert!(by_equations || by_quotients, "{name}, {by}: {callback}");
            // exp(-t) = 1/2 at ln 2
            let exact = if name.contains("below") { 2f64.ln() } else { 0.5 };
            // explicit methods of ARKODE give up where they first see it
            let near = if by.contains("DORMAND") { 0.5 } else { 2e-3 };
            assert!((t - exact).abs() < near && at == component, "{name}, {by}: {text}");
            let calls = calls.swap(0, Relaxed);
            assert!(calls < 10_000, "{name}, {by}: {calls}");
        };
        for method in all_methods() {
            let options = Options::new(1e-6, 1e-9);
            match solve(problem(method, rhs, &[1.0, 1.0]), method, (0.0, 2.0), &options) {
                Err(Error::Stopped(stopped)) => {
                    let text = stopped.to_string();
                    let Reason::Failed(error) = &stopped.reason else {
                        panic!("{method:?} {text}")
                    };
                    check(format!("{method:?}"), integration_cause(error), text);
                }
                other => panic!("{method:?}: {other:?}"),
            }
        }
        let y = [1.0, 1.0];
        let direct = |by: &str, outcome: Result<integrate::Reached, integrate::Error>| {
            let error = outcome.unwrap_err();
            check(by.into(), integration_cause(&error), error.to_string());
        };
        for method in [Multistep::Bdf, Multistep::Adams] {
            let options = CvodeOptions::new(1e-6, 1e-9).method(method);
            let mut solver = Cvode::new(rhs, 0.0, &y, &options).unwrap();
            direct("CVODE", solver.solve_to(2.0));
        }
        let options = ArkodeOptions::new(1e-6, 1e-9);
        direct("ARKODE", Arkode::new(rhs, 0.0, &y, &options).unwrap().solve_to(2.0));
        let options = rk::Options::new(1e-6, 1e-9);
        direct("rk", rk::DormandPrince::new(rhs, 0.0, &y, &options).unwrap().solve_to(2.0));
        let options = rosenbrock::Options::new(1e-6, 1e-9);
        direct("Rosenbrock", Rosenbrock::new(rhs, 0.0, &y, &options).unwrap().solve_to(2.0));
        let residual = |t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
            rhs(t, y, r)?;
            r.iter_mut().zip(yp).for_each(|(r, yp)| *r -= yp);
            Ok(())
        };
        let options = IdaOptions::new(1e-6, 1e-9);
        let mut ida = Ida::new(residual, 0.0, &y, &[-1.0, -1.0], &options).unwrap();
        direct("IDA", ida.solve_to(2.0));
    }
}

/// What was overcome is not told for what comes later: a state where the equations have no number is met once, far ahead.
#[test]
fn what_was_overcome_is_not_blamed() {
    let met = AtomicBool::new(false);
    let rhs = |t: f64, y: &[f64], f: &mut [f64]| {
        f[0] = -y[0];
        if t > 3.0 && !met.swap(true, Relaxed) {
            f[0] = f64::NAN;
        }
        Ok(())
    };
    let options = Options::new(1e-3, 1e-3).max_steps(60);
    let error = solve(Problem::ode(rhs, [1.0]), Method::Bdf, (0.0, 1e9), &options);
    assert!(met.load(Relaxed));
    match error {
        Ok(solution) => assert_eq!(solution.t().last(), Some(&1e9)),
        Err(Error::Stopped(stopped)) => assert!(matches!(stopped.reason, Reason::Steps(_))),
        Err(error) => panic!("{error}"),
    }
    // nor by the solver itself, where a later call ends at its limit of steps before that time is passed
    let met = AtomicBool::new(false);
    let rhs = |t: f64, y: &[f64], f: &mut [f64]| {
        f[0] = -y[0];
        if t > 3.0 && !met.swap(true, Relaxed) {
            f[0] = f64::NAN;
        }
        Ok(())
    };
    let options = CvodeOptions::new(1e-3, 1e-3).max_steps(1);
    let mut solver = Cvode::new(rhs, 0.0, &[1.0], &options).unwrap();
    while !met.load(Relaxed) {
        solver.step(1e9).unwrap();
    }
    let error = solver.solve_to(1e9).unwrap_err();
    assert!(matches!(integration_cause(&error), Cause::TooManySteps { steps: 1, .. }), "{error}");
}

/// Breaks from 0 to 3 ulps apart, next to each other, to the start and to the end: each is met, in order, and y' = -y goes on as without them.
#[test]
fn breaks_may_be_neighbours() {
    let near = |t: f64, ulps: i64| f64::from_bits((t.to_bits() as i64 + ulps) as u64);
    for method in all_methods() {
        for times in [
            vec![0.3, 0.1 + 0.2],
            vec![0.3, 0.3],
            vec![0.3, near(0.3, 1), near(0.3, 2), near(0.3, 3)],
            vec![0.3, near(0.3, 2), near(0.3, 5), near(0.3, 40)],
            vec![near(0.25, 1), near(1.0, -1)],
            vec![near(0.25, 3), near(1.0, -4)],
        ] {
            let met = AtomicUsize::new(0);
            let mut with_breaks = problem(
                method,
                |_, y, f| {
                    f[0] = -y[0];
                    Ok(())
                },
                &[1.0],
            );
            for &t in &times {
                let met = &met;
                with_breaks = with_breaks.break_with(t, move |jump| {
                    assert_eq!(jump.t, t);
                    met.fetch_add(1, Relaxed);
                    jump.y[0] *= 2.0;
                });
            }
            let options = Options::new(1e-9, 1e-12);
            let solution = solve(with_breaks, method, (0.25, 1.0), &options)
                .unwrap_or_else(|error| panic!("{method:?} {times:?}: {error}"));
            assert_eq!(met.load(Relaxed), times.len(), "{method:?} {times:?}");
            let exact = (-0.75_f64).exp() * f64::from(1 << times.len());
            let error = (solution.last()[0] / exact - 1.0).abs();
            assert!(error < 1e-6, "{method:?} {times:?}: {error:e}");
            // between them, too
            for pair in times.windows(2) {
                let y = solution.at(pair[0]).unwrap()[0];
                assert!(y.is_finite() && y > 0.0);
            }
        }
    }
}

/// An event may lie right before a break or the end; up to some hundred numbers before, which is as far as it is known.
#[test]
fn an_event_may_leave_no_room() {
    for method in all_methods() {
        let before = |t: f64, ulps: u64| f64::from_bits(t.to_bits() - ulps);
        let ulps = [1, 3, 30, 100, 200, 300, 400, 500, 1000];
        for (t, end) in
            ulps.iter().flat_map(|&ulps| [(before(0.5, ulps), 1.0), (before(1.0, ulps), 1.0)])
        {
            let event =
                Event::new(move |at: f64, _: &[f64]| at - t).action(|jump| jump.y[0] += 1.0);
            let falls = problem(
                method,
                |_, _, f| {
                    f[0] = -1.0;
                    Ok(())
                },
                &[1.0],
            );
            let falls = falls.event(event).breaks([0.5]);
            let solution = solve(falls, method, (0.0, end), &Options::new(1e-6, 1e-9)).unwrap();
            assert!((solution.last()[0] - 1.0).abs() < 1e-9, "{method:?} {t}");
        }
    }
}

/// Spans from one ulp on, forward and backward, by `solve` and by the solvers themselves: y' = 1 has moved by the span, to rounding.
#[test]
fn spans_of_an_ulp_are_integrated() {
    let near = |t: f64, ulps: i64| f64::from_bits((t.to_bits() as i64 + ulps) as u64);
    let mut spans = vec![(0.0, 1e-90), (0.3, 0.1 + 0.2)];
    for ulps in [1, 2, 3, 4, 7, 15, 40, 99, 130, 300] {
        spans.extend([(0.3, near(0.3, ulps)), (1e9, near(1e9, ulps)), (1.0, near(1.0, -ulps))]);
    }
    let rises = |_: f64, _: &[f64], f: &mut [f64]| {
        f[0] = 1.0;
        Ok(())
    };
    for (start, end) in spans {
        let check = |by: String, y: f64, t: f64| {
            assert_eq!(t, end, "{by} {start} {end:e}");
            assert!(
                (y - (end - start)).abs() <= 1e-3 * (end - start).abs(),
                "{by} {start} {end}: {y:e}"
            );
        };
        for method in all_methods() {
            let forward_only = matches!(method, Method::DormandPrince | Method::Rosenbrock);
            // stages of a step of an ulp lie between numbers, and so does what IDA corrects the start by: such methods may say that they
            // find none, where an ulp is long; and ARKODE ends 100 ulps from the end if rounding shortens its steps there
            let is_long = start == 1e9
                || matches!(method, Method::RungeKutta(_)) && (end - start).abs() > 1e-15;
            let by_stages = !matches!(method, Method::Bdf | Method::Adams) && is_long;
            if forward_only && end < start || by_stages {
                continue;
            }
            let options = Options::new(1e-6, 1e-30);
            let solution = solve(problem(method, rises, &[0.0]), method, (start, end), &options)
                .unwrap_or_else(|error| panic!("{method:?} {start} {end:e}: {error}"));
            check(format!("{method:?}"), solution.last()[0], solution.t().last().copied().unwrap());
        }
        let options = CvodeOptions::new(1e-6, 1e-30);
        let mut solver = Cvode::new(rises, start, &[0.0], &options).unwrap();
        solver.solve_to(end).unwrap();
        check("CVODE".into(), solver.y()[0], solver.t());
        // it goes on from there, with the stop time that it was given
        let later = start + 1e3 * (end - start);
        solver.set_stop_time(Some(later)).unwrap();
        assert_eq!(
            solver.solve_to(start + 2e3 * (end - start)).unwrap(),
            integrate::Reached::StopTime
        );
        assert!((solver.y()[0] - (later - start)).abs() <= 1e-3 * (later - start).abs());
        // nor does it forget the one that it had before
        let mut solver = Cvode::new(rises, start, &[0.0], &options).unwrap();
        solver.set_stop_time(Some(later)).unwrap();
        assert_eq!(solver.solve_to(end).unwrap(), integrate::Reached::Time);
        assert_eq!(
            solver.solve_to(start + 2e3 * (end - start)).unwrap(),
            integrate::Reached::StopTime,
            "{start} {end:e}"
        );
        assert_eq!(solver.t(), later);
        if start != 1e9 && (end - start).abs() <= 1e-15 {
            let table = ButcherTable::implicit(3).unwrap();
            let options = ArkodeOptions::new(1e-6, 1e-30).table(table);
            let mut solver = Arkode::new(rises, start, &[0.0], &options).unwrap();
            solver.solve_to(end).unwrap();
            check("ARKODE".into(), solver.y()[0], solver.t());
        }
        if start != 1e9 {
            let residual = |_: f64, _: &[f64], yp: &[f64], r: &mut [f64]| {
                r[0] = yp[0] - 1.0;
                Ok(())
            };
            let options = IdaOptions::new(1e-6, 1e-30);
            let mut solver = Ida::new(residual, start, &[0.0], &[1.0], &options).unwrap();
            solver.solve_to(end).unwrap();
            check("IDA".into(), solver.y()[0], solver.t());
        }
        if end > start && start != 1e9 {
            let options = rk::Options::new(1e-6, 1e-30);
            let mut solver = rk::DormandPrince::new(rises, start, &[0.0], &options).unwrap();
            solver.solve_to(end).unwrap();
            check("rk".into(), solver.y()[0], solver.t());
            let options = rosenbrock::Options::new(1e-6, 1e-30);
            let mut solver = Rosenbrock::new(rises, start, &[0.0], &options).unwrap();
            solver.solve_to(end).unwrap();
            check("Rosenbrock".into(), solver.y()[0], solver.t());
        }
    }
}

/// Spans of less than the least step are refused in words.
#[test]
fn spans_below_the_least_step_are_refused() {
    for end in [5e-324, -1e-120] {
        for method in all_methods() {
            let rises = problem(
                method,
                |_, _, f| {
                    f[0] = 1.0;
                    Ok(())
                },
                &[0.0],
            );
            match solve(rises, method, (0.0, end), &Options::new(1e-6, 1e-9)) {
                Err(Error::Input(error)) => assert_eq!(error.input, "end of the span"),
                other => panic!("{method:?}: {other:?}"),
            }
        }
        let rises = |_: f64, _: &[f64], f: &mut [f64]| {
            f[0] = 1.0;
            Ok(())
        };
        let mut solver = Cvode::new(rises, 0.0, &[0.0], &CvodeOptions::new(1e-6, 1e-9)).unwrap();
        let refused = solver.solve_to(end).unwrap_err();
        assert!(matches!(&refused, integrate::Error::Input(error) if error.input == "target time"));
    }
}

/// y' = 1 + y^2 from 1 has no solution beyond pi / 4: steps get shorter than rounding, and the run ends there, after some thousand
/// evaluations (100,000 by the step sizes of 1e-157 that were tried before).
#[test]
fn time_that_stands_still_is_a_cause() {
    for method in [Method::Bdf, Method::Adams, Method::Ida] {
        let calls = AtomicU64::new(0);
        let rhs = |_: f64, y: &[f64], f: &mut [f64]| {
            calls.fetch_add(1, Relaxed);
            f[0] = 1.0 + y[0] * y[0];
            Ok(())
        };
        match solve(problem(method, rhs, &[1.0]), method, (0.0, 2.0), &Options::new(1e-6, 1e-9)) {
            Err(Error::Stopped(stopped)) => {
                println!("{method:?}, {} calls: {stopped}", calls.load(Relaxed));
                let Reason::Failed(error) = &stopped.reason else { panic!("{stopped}") };
                let cause = integration_cause(error);
                assert!(matches!(cause, Cause::StandsStill { steps: 100 }), "{stopped}");
                let t = stopped.solution.t().last().unwrap();
                assert!((t - std::f64::consts::FRAC_PI_4).abs() < 1e-4, "{method:?} {t}");
            }
            other => panic!("{method:?}: {other:?}"),
        }
        assert!(calls.load(Relaxed) < 5000, "{method:?} {}", calls.load(Relaxed));
    }
}

/// A pendulum with its constraint on velocities, from a start that satisfies all of its equations: of index 2, which IDA follows for a while, in ever
/// shorter steps. That is told by `solve`, at its own limit of steps, as by IDA itself.
#[test]
fn index_two_from_a_consistent_start_is_told() {
    let g = 9.81;
    let pendulum = move |_t: f64, s: &[f64], sp: &[f64], r: &mut [f64]| {
        let &[x, y, vx, vy, tension] = s else { unreachable!("five unknowns") };
        r[..4].copy_from_slice(&[
            sp[0] - vx,
            sp[1] - vy,
            sp[2] + tension * x,
            sp[3] + tension * y + g,
        ]);
        r[4] = x * vx + y * vy;
        Ok(())
    };
    let (sin, cos) = 0.5_f64.sin_cos();
    let (y0, yp0) =
        ([sin, -cos, 0.0, 0.0, g * cos], [0.0, 0.0, -g * cos * sin, g * cos * cos - g, 0.0]);
    for steps in [20_000, 200_000] {
        let options = Options::new(1e-8, 1e-8).max_steps(steps);
        match solve(Problem::dae(pendulum, y0, yp0), Method::Ida, (0.0, 10.0), &options) {
            Err(Error::Stopped(stopped)) => {
                println!("{stopped}");
                let Reason::Failed(error) = &stopped.reason else { panic!("{stopped}") };
                assert_eq!(*integration_cause(error), Cause::HigherIndex { unknown: 4 });
            }
            other => panic!("{other:?}"),
        }
        let options = IdaOptions::new(1e-8, 1e-8).max_steps(steps as u32);
        let mut ida = Ida::new(pendulum, 0.0, &y0, &yp0, &options).unwrap();
        let error = ida.solve_to(10.0).unwrap_err();
        assert_eq!(*integration_cause(&error), Cause::HigherIndex { unknown: 4 });
    }
}
