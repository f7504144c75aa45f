//! Clock times, whose neighbouring numbers are far apart: 2.4e-7 s at the seconds since 1970, 0.125 s at 1e15 s.

use pliant::{
    integrate::{Error as IntegrateError, Integrator},
    ode::{Failure, Functional, Ode, Slopes, dae_with_parameters, with_parameters},
    rk, rosenbrock,
    solve::{Error, Event, Method, Options, Output, Problem, Run, gradient, solve},
    sundials::{
        AdjointOptions, Arkode, ArkodeOptions, ButcherTable, Cvode, CvodeOptions, Ida, IdaOptions,
        Sensitivities,
    },
};

use crate::support::methods;

/// Starts and spans of a few thousand numbers at least: Unix seconds, before 1970, microseconds in a long run, and the far future.
const CLOCKS: [(f64, f64); 6] =
    [(1.8e9, 1e-3), (1.8e9, 1.0), (-1.8e9, 1e-3), (1e6, 1e-6), (1e15, 1e3), (1e15, 1e6)];

fn all_methods() -> Vec<Method> {
    let mut all = methods();
    all.push(Method::Rosenbrock);
    all
}

/// y' = -y / scale from 1.
fn decay<'a>(scale: f64) -> Problem<'a> {
    let rhs = move |_t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot[0] = -y[0] / scale;
        Ok(())
    };
    Problem::ode(rhs, [1.0])
}

/// At clock times the same equations have the errors that they have at time 0: at the ends of all steps, at every number between, and
/// at output times, which come back as they were given.
#[test]
fn a_decay_is_as_accurate_as_at_time_0() {
    let options = Options::new(1e-8, 1e-10);
    for (start, span) in CLOCKS {
        for method in all_methods() {
            let end = start + span;
            let truth = |t: f64| (-(t - start) / span).exp();
            let solution = solve(decay(span), method, (start, end), &options).unwrap();
            let worst = (0..solution.t().len())
                .map(|k| (solution.y(k)[0] - truth(solution.t()[k])).abs())
                .fold(0.0, f64::max);
            let reference = solve(decay(span), method, (0.0, end - start), &options).unwrap();
            let last = (solution.last()[0] - reference.last()[0]).abs();
            println!("{start:e} {span:e} {method:?}: {worst:e} {last:e}");
            // measured: up to 4e-8, what the methods leave of 1e-8 in a step
            assert!(worst < 1e-7, "{start:e} {span:e} {method:?}: {worst:e}");
            // the same steps, but for roundings of times of ends and stages
            assert!(last < 1e-9, "{start:e} {span:e} {method:?}: {last:e}");
            assert!(solution.t().windows(2).all(|pair| pair[0] < pair[1]));
            assert_eq!(solution.t().last(), Some(&end));

            let times: Vec<f64> = (0..=97)
                .map(|k| start + span * f64::from(k) / 97.0)
                .filter(|t| *t <= end)
                .collect();
            let at = options.clone().output(Output::Times(times.clone()));
            let sampled = solve(decay(span), method, (start, end), &at).unwrap();
            for (k, t) in times.into_iter().enumerate() {
                assert_eq!(sampled.t()[k].to_bits(), t.to_bits());
                for y in [sampled.y(k)[0], solution.at(t).unwrap()[0]] {
                    let error = (y - truth(t)).abs();
                    // Hermite's cubics of ARKODE have 1e-5 between the steps, at time 0 as here
                    let tolerance =
                        if matches!(method, Method::RungeKutta(_)) { 3e-5 } else { 1e-6 };
                    assert!(error < tolerance, "{start:e} {span:e} {method:?} {t}: {error:e}");
                }
            }
        }
    }
}

/// The integrators themselves, to targets down to four numbers away: 1 us at Unix seconds, 1 ns in a run of a million seconds.
#[test]
fn integrators_reach_close_targets() {
    for (start, span) in [(1.7e9, 1e-6), (1.7e9, 3e-5), (1e6, 1e-9), (1e6, 1e-8), (1e15, 0.5)] {
        let end = start + span;
        let scale = end - start;
        let rhs = move |_t: f64, y: &[f64], ydot: &mut [f64]| {
            ydot[0] = -y[0] / scale;
            Ok(())
        };
        let residual = move |_t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
            r[0] = yp[0] + y[0] / scale;
            Ok(())
        };
        let (y0, yp0) = ([1.0], [-1.0 / scale]);
        let cvode = CvodeOptions::new(1e-8, 1e-10);
        let table = ButcherTable::implicit(5).unwrap();
        let arkode = ArkodeOptions::new(1e-8, 1e-10).table(table);
        let explicit = rk::Options::new(1e-8, 1e-10);
        let linear = rosenbrock::Options::new(1e-8, 1e-10);
        check(&mut Cvode::new(rhs, start, &y0, &cvode).unwrap(), end);
        check(
            &mut Ida::new(residual, start, &y0, &yp0, &IdaOptions::new(1e-8, 1e-10)).unwrap(),
            end,
        );
        check(&mut Arkode::new(rhs, start, &y0, &arkode).unwrap(), end);
        check(&mut rk::DormandPrince::new(rhs, start, &y0, &explicit).unwrap(), end);
        check(&mut rosenbrock::Rosenbrock::new(rhs, start, &y0, &linear).unwrap(), end);
    }
}

/// To 1/e at `end`, by one call, and by steps to a stop time after a new start there, whose times grow.
fn check(integrator: &mut impl Integrator, end: f64) {
    integrator.solve_to(end).unwrap();
    assert_eq!(integrator.t().to_bits(), end.to_bits());
    let error = (integrator.y()[0] - (-1f64).exp()).abs();
    assert!(error < 1e-7, "{end}: {error:e}");
    let start = integrator.t();
    // the span after `end` may have other numbers
    let stop = end + (end - integrator.last_step().0).max(4.0 * (end.next_up() - end));
    let y = integrator.y().to_vec();
    integrator.reinit(start, &y).unwrap();
    integrator.set_stop_time(Some(stop)).unwrap();
    let (mut last, mut value) = (start, y[0]);
    while integrator.t() < stop {
        integrator.step(stop).unwrap();
        assert!(integrator.t() > last && integrator.y()[0] < value);
        (last, value) = (integrator.t(), integrator.y()[0]);
    }
    assert_eq!(integrator.t().to_bits(), stop.to_bits());
}

/// Also in a span of a hundred numbers: what it is, is the difference of its ends. One that is no number has an error that says so.
#[test]
fn a_span_of_few_numbers_is_what_its_ends_are() {
    let options = Options::new(1e-8, 1e-10);
    for (start, span) in [(1.7e9, 3e-5), (1.7e9, 1e-4), (1e6, 1e-8), (1e15, 12.5)] {
        for method in all_methods() {
            let end = start + span;
            let solution = solve(decay(span), method, (start, end), &options).unwrap();
            let truth = |t: f64| (-(t - start) / span).exp();
            for (k, t) in solution.t().iter().enumerate() {
                let error = (solution.y(k)[0] - truth(*t)).abs();
                assert!(error < 1e-7, "{start:e} {span:e} {method:?}: {error:e}");
            }
            assert_eq!(solution.t().last(), Some(&end));
            let mut t = start;
            while t < end {
                let error = (solution.at(t).unwrap()[0] - truth(t)).abs();
                let tolerance = if matches!(method, Method::RungeKutta(_)) { 3e-5 } else { 1e-6 };
                assert!(error < tolerance, "{start:e} {span:e} {method:?} {t}: {error:e}");
                t = t.next_up();
            }
        }
    }
    match solve(decay(1e-9), Method::Bdf, (1.8e9, 1.8e9 + 1e-9), &options) {
        Err(Error::Input(error)) => {
            let words = error.to_string();
            assert!(words.contains("numbers are 2.4e-7 apart"), "{words}");
        }
        other => panic!("{other:?}"),
    }
}

/// A forced equation sees the times as they are: y' = cos(t - start) over a minute.
#[test]
fn the_equations_see_the_clock() {
    let start = 1.8e9;
    for method in all_methods() {
        let rhs = move |t: f64, _y: &[f64], ydot: &mut [f64]| {
            assert!((start..=start + 60.0).contains(&t));
            ydot[0] = (t - start).cos();
            Ok(())
        };
        let options = Options::new(1e-6, 1e-8).output(Output::End);
        let solution =
            solve(Problem::ode(rhs, [0.0]), method, (start, start + 60.0), &options).unwrap();
        let error = (solution.last()[0] - 60f64.sin()).abs();
        // 2.4e-7 s is what the times are rounded by
        println!("{method:?}: {error:e}");
        assert!(error < 2e-5, "{method:?}: {error:e}");
    }
}

struct Clocked;

impl Ode for Clocked {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot.copy_from_slice(&[y[1], -9.81e6]);
        Ok(())
    }

    fn quadrature_count(&self) -> usize {
        1
    }

    fn quadratures(&mut self, _t: f64, y: &[f64], qdot: &mut [f64]) -> Result<(), Failure> {
        qdot[0] = y[1];
        Ok(())
    }
}

/// A ball that falls 1 m in 0.45 ms and bounces, pushed at a break: events to the number, and integrals that are what it has risen.
#[test]
fn events_breaks_and_integrals_keep_the_clock() {
    let (start, end) = (1.8e9, 1.8e9 + 2e-3);
    let first = (2.0 / 9.81e6f64).sqrt();
    let number = 2.4e-7;
    for method in all_methods() {
        let ball = || {
            let floor = Event::new(|_, y: &[f64]| y[0]).falling().action(|jump| jump.y[1] *= -0.5);
            let fall = |_t: f64, y: &[f64], ydot: &mut [f64]| {
                ydot.copy_from_slice(&[y[1], -9.81e6]);
                Ok(())
            };
            match method {
                Method::Bdf | Method::Adams => Problem::ode(Clocked, [1.0, 0.0]).event(floor),
                _ => Problem::ode(fall, [1.0, 0.0]).event(floor),
            }
        };
        let options = Options::new(1e-9, 1e-11);
        let solution = solve(ball(), method, (start, end), &options).unwrap();
        for (k, expected) in [(0, first), (1, 2.0 * first), (2, 2.5 * first)] {
            let event = &solution.events()[k];
            let off = event.t - start - expected;
            // each later flight begins where the one before was rounded to
            assert!(off.abs() < 3.0 * number, "{method:?} {k}: {off:e}");
            assert!(event.y[0].abs() < 2.0 * number * 9.81e6 * first, "{:?}", event.y);
        }
        if matches!(method, Method::Bdf | Method::Adams) {
            for k in 0..solution.t().len() {
                let error = (solution.quadratures(k)[0] - (solution.y(k)[0] - 1.0)).abs();
                assert!(error < 1e-8, "{method:?} {error:e}");
            }
        }
        let push = start + 2e-4;
        let pushed = ball().break_with(push, |jump| jump.y[1] += 1e3);
        let solution = solve(pushed, method, (start, start + 4e-4), &options).unwrap();
        let (before, rest) = (push - start, start + 4e-4 - push);
        let expected = 1.0 - 0.5 * 9.81e6 * (before + rest).powi(2) + 1e3 * rest;
        let error = (solution.last()[0] - expected).abs();
        println!("{method:?}: {error:e}");
        assert!(error < 1e-8, "{method:?}: {error:e}");
    }
}

struct Last;

impl Functional for Last {
    fn terminal(
        &mut self,
        _t: f64,
        y: &[f64],
        _p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        if let Some(slopes) = slopes {
            slopes.y[0] = 1.0;
        }
        Ok(y[0])
    }
}

/// dy/dp of y' = -p y, forward and by the adjoint, for an ODE and a DAE: -T exp(-p T).
#[test]
fn derivatives_keep_the_clock() {
    for (start, span) in [(1.8e9, 1e-3), (1e15, 1e3)] {
        let p: f64 = 1.0 / span;
        let end = start + span;
        let time = end - start;
        let expected = -time * (-p * time).exp();
        let ode = || {
            let rhs = |_t: f64, y: &[f64], p: &[f64], ydot: &mut [f64]| {
                ydot[0] = -p[0] * y[0];
                Ok(())
            };
            Problem::ode(with_parameters(rhs, [p]), [1.0])
        };
        let dae = || {
            let residual = |_t: f64, y: &[f64], yp: &[f64], p: &[f64], r: &mut [f64]| {
                r[0] = yp[0] + p[0] * y[1];
                r[1] = y[1] - y[0];
                Ok(())
            };
            Problem::dae(dae_with_parameters(residual, [p]), [1.0, 1.0], [-p, -p])
                .differential([true, false])
        };
        let options = Options::new(1e-9, 1e-11);
        let forward = options.clone().sensitivities(Sensitivities::of([0]));
        let back = AdjointOptions::new(1e-9, 1e-11);
        let span = (start, end);
        for (problem, method) in
            [(ode(), Method::Bdf), (ode(), Method::Adams), (dae(), Method::Ida)]
        {
            let solution = solve(problem, method, span, &forward).unwrap();
            for (k, t) in solution.t().iter().enumerate() {
                let expected = -(t - start) * (-p * (t - start)).exp();
                let error = (solution.sensitivities(k)[(0, 0)] - expected).abs() / time;
                assert!(error < 1e-6, "{method:?} {start:e}: {error:e}");
            }
        }
        for (problem, method) in [(ode(), Method::Bdf), (dae(), Method::Ida)] {
            let found = gradient(problem, Last, method, span, &options, &back).unwrap();
            let error = (found.parameters[0] - expected).abs() / time;
            println!("{method:?} {start:e}: {error:e}");
            assert!(error < 1e-6, "{method:?} {start:e}: {error:e}");
        }
    }
}

/// Backward in time, and step by step: the times of a run fall, and it ends where it was told to.
#[test]
fn a_run_goes_back_from_a_clock_time() {
    let (start, end) = (1.8e9, 1.8e9 - 1e-3);
    let mut run =
        Run::new(decay(-1e-3), Method::Bdf, (start, end), &Options::new(1e-8, 1e-10)).unwrap();
    let mut last = start;
    while let Some(step) = run.advance().unwrap() {
        assert!(step.t < last);
        last = step.t;
        let error = (step.y[0] - ((last - start) / 1e-3).exp()).abs();
        assert!(error < 1e-7, "{error:e}");
    }
    assert_eq!(last, end);
}

/// Root functions of the integrators are followed as finely.
#[test]
fn roots_keep_the_clock() {
    struct Falls;
    impl Ode for Falls {
        fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
            ydot[0] = -1e3 * y[0];
            Ok(())
        }

        fn root_count(&self) -> usize {
            1
        }

        fn roots(&mut self, _t: f64, y: &[f64], g: &mut [f64]) -> Result<(), Failure> {
            g[0] = y[0] - 0.5;
            Ok(())
        }
    }
    fn find(mut integrator: impl Integrator) -> Result<(), IntegrateError> {
        let start = integrator.t();
        integrator.solve_to(start + 2e-3)?;
        assert_eq!(integrator.roots_found(), [-1]);
        let off = integrator.t() - start - 1e-3 * 2f64.ln();
        assert!(off.abs() < 2.4e-7, "{off:e}");
        assert!((integrator.y()[0] - 0.5).abs() < 2.4e-4);
        Ok(())
    }
    let start = 1.8e9;
    let table = ButcherTable::implicit(5).unwrap();
    find(Cvode::new(Falls, start, &[1.0], &CvodeOptions::new(1e-8, 1e-10)).unwrap()).unwrap();
    find(Arkode::new(Falls, start, &[1.0], &ArkodeOptions::new(1e-8, 1e-10).table(table)).unwrap())
        .unwrap();
    find(rk::DormandPrince::new(Falls, start, &[1.0], &rk::Options::new(1e-8, 1e-10)).unwrap())
        .unwrap();
}
