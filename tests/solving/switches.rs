//! Derivatives where the equations switch by themselves.

use pliant::{
    ode::{Failure, Functional, Slopes, dae_with_parameters, with_parameters},
    solve::{Error, Event, Method, Options, Output, Problem, Reason, gradient, solve},
    sundials::{AdjointOptions, Sensitivities},
};

/// The first unknown at the end.
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

/// Derivatives of the first unknown at the end by the first parameters, forward and by the adjoint.
fn both<'a>(
    problem: impl Fn() -> Problem<'a>,
    method: Method,
    end: f64,
    count: usize,
) -> [Result<Vec<f64>, Reason>; 2] {
    let options = Options::new(1e-8, 1e-9).output(Output::End);
    let sensitive =
        options.clone().sensitivities(Sensitivities::of((0..count).collect::<Vec<_>>()));
    let forward = match solve(problem(), method, (0.0, end), &sensitive) {
        Ok(solution) => {
            let s = solution.sensitivities(solution.t().len() - 1);
            Ok((0..count).map(|k| s[(0, k)]).collect())
        }
        Err(Error::Stopped(stopped)) => Err(stopped.reason),
        Err(Error::Input(error)) => Err(Reason::Input(error)),
        Err(other) => panic!("{other}"),
    };
    let back = AdjointOptions::new(1e-8, 1e-9);
    let adjoint = gradient(problem(), Last, method, (0.0, end), &options, &back);
    [forward, adjoint.map(|found| found.parameters[..count].to_vec())]
}

fn check<'a>(
    problem: impl Fn() -> Problem<'a>,
    method: Method,
    end: f64,
    expected: &[f64],
    most: f64,
) {
    for (way, found) in
        ["forward", "adjoint"].iter().zip(both(problem, method, end, expected.len()))
    {
        let found = found.unwrap();
        for (found, expected) in found.iter().zip(expected) {
            let error = (found - expected).abs() / expected.abs().max(1.0);
            println!("{way} {method:?}: {found} {expected} {error:e}");
            assert!(error < most, "{way} {method:?}: {found} {expected} {error:e}");
        }
    }
}

const MULTISTEP: [Method; 2] = [Method::Bdf, Method::Adams];

/// y' = 1 until t = p0 and 3 until t = p1, then -y: the switches are times. y(2) = (p0 + 3 (p1 - p0)) e^(p1 - 2).
#[test]
fn switches_at_times_that_are_parameters() {
    let p = [0.5, 0.7];
    let problem = || {
        let equations = with_parameters(
            |t, y, p, ydot| {
                ydot[0] = match t {
                    t if t < p[0] => 1.0,
                    t if t < p[1] => 3.0,
                    _ => -y[0],
                };
                Ok(())
            },
            p,
        );
        let at = |k: usize| Event::with_parameters(move |t, _y, p| t - p[k]);
        Problem::ode(equations, [0.0]).event(at(0)).event(at(1))
    };
    let (height, decay) = (p[0] + 3.0 * (p[1] - p[0]), (p[1] - 2.0_f64).exp());
    for method in MULTISTEP {
        // measured 2.4e-7, as large as errors of the state
        check(problem, method, 2.0, &[-2.0 * decay, (3.0 + height) * decay], 5e-7);
    }
}

/// A pulse at rest, whose size is far larger than the state: 10 from t = p0 to p1, and y' = -y.
#[test]
fn a_pulse_from_rest() {
    let p = [0.5, 0.7];
    let problem = || {
        let equations = with_parameters(
            |t, y, p, ydot| {
                ydot[0] = -y[0] + if t > p[0] && t < p[1] { 10.0 } else { 0.0 };
                Ok(())
            },
            p,
        );
        let at = |k: usize| Event::with_parameters(move |t, _y, p| t - p[k]);
        Problem::ode(equations, [0.0]).event(at(0)).event(at(1))
    };
    let by = |k: usize| 10.0 * (p[k] - 2.0_f64).exp();
    for method in MULTISTEP {
        // measured 2e-7
        check(problem, method, 2.0, &[-by(0), by(1)], 5e-7);
    }
}

/// y1' = p until y1 = 0.3, and 0.1 from then on; y0' = p before and -y0 behind: y0(1) = 0.3 e^(0.3/p - 1). With and without an action that does nothing.
#[test]
fn switches_of_the_state() {
    let p = 0.5_f64;
    let last = 0.3 * (0.3 / p - 1.0).exp();
    for acts in [false, true] {
        let problem = || {
            let equations = with_parameters(
                |_t, y, p, ydot| {
                    let slopes = if y[1] < 0.3 { [p[0], p[0]] } else { [-y[0], 0.1] };
                    ydot.copy_from_slice(&slopes);
                    Ok(())
                },
                [p],
            );
            // a function of another size than the state
            let here = Event::new(|_t, y| 1e6 * (y[1] - 0.3));
            let here = if acts { here.action(|_| ()) } else { here };
            Problem::ode(equations, [0.0, 0.0]).event(here)
        };
        for method in MULTISTEP {
            // measured 2.3e-8
            check(problem, method, 1.0, &[-last * 0.3 / (p * p)], 1e-7);
        }
    }
}

/// A forced oscillator with a force p1 above the height p0, through which it goes six times. Only one direction counts as the event, or both;
/// with a mass matrix of 1 as a DAE with its acceleration as an algebraic unknown. Against differences of whole runs in which actions
/// switch the force, at tolerances of 1e-11: 0.76974789(1), -2.92236888(1).
#[test]
fn many_crossings() {
    let p = [0.3, 0.7];
    let by_mode = |p: [f64; 2]| {
        let equations = with_parameters(
            |t: f64, y, p, ydot| {
                ydot[0] = y[1];
                ydot[1] = -y[0] - p[1] * p[2] - 0.1 * y[1] + (1.3 * t).sin();
                Ok(())
            },
            [p[0], p[1], 0.0],
        );
        let mode = |jump: &mut pliant::solve::Jump<'_>| jump.p[2] = 1.0 - jump.p[2];
        let here = Event::with_parameters(|_t, y, p| y[0] - p[0]).action(mode);
        let options = Options::new(1e-12, 1e-14).output(Output::End);
        let problem = Problem::ode(equations, [0.0, 0.0]).event(here);
        solve(problem, Method::DormandPrince, (0.0, 15.0), &options).unwrap().last()[0]
    };
    let expected = [0, 1].map(|k| {
        let moved = |d: f64| {
            let mut p = p;
            p[k] += d;
            by_mode(p)
        };
        (8.0 * (moved(1e-3) - moved(-1e-3)) - (moved(2e-3) - moved(-2e-3))) / 12e-3
    });
    println!("{expected:?}");
    for rising in [false, true] {
        let here = move || {
            let here = Event::with_parameters(|_t, y: &[f64], p: &[f64]| y[0] - p[0]);
            if rising { here.rising() } else { here }
        };
        let force = |y: f64, p: &[f64]| if y > p[0] { p[1] } else { 0.0 };
        let ode = || {
            let equations = with_parameters(
                move |t: f64, y, p, ydot| {
                    ydot[0] = y[1];
                    ydot[1] = -y[0] - force(y[0], p) - 0.1 * y[1] + (1.3 * t).sin();
                    Ok(())
                },
                p,
            );
            Problem::ode(equations, [0.0, 0.0]).event(here())
        };
        for method in MULTISTEP {
            // measured 3.4e-7
            check(ode, method, 15.0, &expected, 1e-6);
        }
        let dae = || {
            let equations = dae_with_parameters(
                move |t: f64, y, yp, p, r| {
                    r[0] = yp[0] - y[1];
                    r[1] = yp[1] - y[2];
                    r[2] = y[2] + y[0] + force(y[0], p) + 0.1 * y[1] - (1.3 * t).sin();
                    Ok(())
                },
                p,
            );
            Problem::dae(equations, [0.0; 3], [0.0; 3])
                .differential([true, true, false])
                .event(here())
        };
        // measured 9e-6: differences of the residual are no better next to a restart
        check(dae, Method::Ida, 15.0, &expected, 2e-5);
    }
}

/// y' = p from 0: the time above 0.3 is 1 - 0.3 / p, whose integrand switches, and nothing else.
#[test]
fn a_functional_that_switches() {
    struct Above;
    impl Functional for Above {
        fn running(
            &mut self,
            _t: f64,
            y: &[f64],
            _p: &[f64],
            _slopes: Option<Slopes<'_>>,
        ) -> Result<f64, Failure> {
            Ok(if y[0] > 0.3 { 1.0 } else { 0.0 })
        }
    }
    let line = with_parameters(
        |_t, _y, p, ydot| {
            ydot[0] = p[0];
            Ok(())
        },
        [0.5],
    );
    let problem = Problem::ode(line, [0.0]).event(Event::new(|_t, y| y[0] - 0.3));
    let (options, back) = (Options::new(1e-8, 1e-10), AdjointOptions::new(1e-8, 1e-10));
    let found = gradient(problem, Above, Method::Bdf, (0.0, 1.0), &options, &back).unwrap();
    assert!((found.value - 0.4).abs() < 1e-8, "{found:?}");
    assert!((found.parameters[0] - 1.2).abs() < 1e-8, "{found:?}");
}

/// At 0.5 the mode p1 becomes 1; at a second event p2 becomes what depends on the time, the state and p0: with y' = p2 from t1 on. In closed form,
/// y = p0 t up to t1 = 0.5 / p0, and p2 = t1 + p0 y = 0.5 / p0 + p0 / 2 from then on.
#[test]
fn parameters_that_actions_set() {
    let p = 0.8_f64;
    let problem = || {
        let equations = with_parameters(
            |_t, _y, p, ydot| {
                ydot[0] = if p[1] == 0.0 { p[0] } else { p[2] };
                Ok(())
            },
            [p, 0.0, 7.0],
        );
        let here = Event::new(|_t, y| y[0] - 0.5).rising().action(|jump| {
            jump.p[1] = 1.0;
            jump.p[2] = jump.t + jump.p[0] * jump.y[0];
        });
        Problem::ode(equations, [0.0]).event(here)
    };
    // y(2) = 0.5 + (0.5/p + p/2) (2 - 0.5/p)
    let slope = (-0.5 / (p * p) + 0.5) * (2.0 - 0.5 / p) + (0.5 / p + 0.5 * p) * 0.5 / (p * p);
    for method in MULTISTEP {
        // measured 2e-11
        check(problem, method, 2.0, &[slope], 1e-9);
    }

    // put aside behind the event and taken up again
    let options = Options::new(1e-8, 1e-10).sensitivities(Sensitivities::of([0]));
    let first = solve(problem(), Method::Bdf, (0.0, 1.0), &options).unwrap();
    let resumed = problem().resume(first.saved().clone());
    let second = solve(resumed, Method::Bdf, (1.0, 2.0), &options).unwrap();
    let s = second.sensitivities(second.t().len() - 1)[(0, 0)];
    assert!((s - slope).abs() < 1e-7, "{s} {slope}");
}

/// A switch that is no event is an error where its time depends on unknowns or parameters: also at a break.
#[test]
fn switches_that_are_no_events_are_refused() {
    let by_time = || {
        with_parameters(
            |t, y, p, ydot| {
                ydot[0] = if t < p[0] { 1.0 } else { -y[0] };
                Ok(())
            },
            [0.5],
        )
    };
    let by_state = || {
        with_parameters(
            |_t, y, p, ydot| {
                ydot[0] = if y[0] < 0.25 { p[0] } else { 3.0 * p[0] };
                Ok(())
            },
            [0.5],
        )
    };
    let problems: [&dyn Fn() -> Problem<'static>; 3] = [
        &|| Problem::ode(by_time(), [0.0]),
        &|| Problem::ode(by_time(), [0.0]).breaks([0.5]),
        &|| Problem::ode(by_state(), [0.0]),
    ];
    for problem in problems {
        for method in MULTISTEP {
            for found in both(problem, method, 1.0, 1) {
                match found {
                    Err(Reason::Switch { t, equation: 0, .. }) => {
                        assert!((t - 0.5).abs() < 1e-6, "{t}");
                    }
                    other => panic!("{method:?}: {other:?}"),
                }
            }
        }
    }
}

/// A switch at a fixed time adds nothing to derivatives, whether it is a break or not. y(1) = p / 2 e^(-3 p / 2).
#[test]
fn switches_at_fixed_times_are_right_as_they_are() {
    let p = 0.5_f64;
    for breaks in [vec![], vec![0.5]] {
        let problem = || {
            let equations = with_parameters(
                |t, y, p, ydot| {
                    ydot[0] = if t < 0.5 { p[0] } else { -3.0 * p[0] * y[0] };
                    Ok(())
                },
                [p],
            );
            Problem::ode(equations, [0.0]).breaks(breaks.clone())
        };
        let expected = (0.5 - 0.75 * p) * (-1.5 * p).exp();
        for method in MULTISTEP {
            // measured 1.5e-8
            check(problem, method, 1.0, &[expected], 5e-8);
        }
    }
}

/// Smooth equations are not taken for switches, however steep: a relaxation oscillation, a stiff reaction, a narrow pulse, a steep front; nor kinks.
#[test]
fn smooth_equations_raise_no_alarm() {
    let smooth: [(&dyn Fn() -> Problem<'static>, f64); 5] = [
        (
            &|| {
                let oscillator = |_t: f64, y: &[f64], p: &[f64], ydot: &mut [f64]| {
                    ydot[0] = y[1];
                    ydot[1] = p[0] * (1.0 - y[0] * y[0]) * y[1] - y[0];
                    Ok(())
                };
                Problem::ode(with_parameters(oscillator, [100.0]), [2.0, 0.0])
            },
            200.0,
        ),
        (
            &|| {
                let robertson = |_t: f64, y: &[f64], p: &[f64], ydot: &mut [f64]| {
                    let [a, b, c] = [p[0] * y[0], 1e4 * y[1] * y[2], 3e7 * y[1] * y[1]];
                    ydot.copy_from_slice(&[b - a, a - b - c, c]);
                    Ok(())
                };
                Problem::ode(with_parameters(robertson, [0.04]), [1.0, 0.0, 0.0])
            },
            1e4,
        ),
        (
            &|| {
                let pulse = |t: f64, y: &[f64], p: &[f64], ydot: &mut [f64]| {
                    ydot[0] = -p[0] * y[0] + 100.0 * (-((t - 1.0) / 0.01).powi(2)).exp();
                    Ok(())
                };
                Problem::ode(with_parameters(pulse, [1.0]), [1.0])
            },
            2.0,
        ),
        (
            &|| {
                let front = |_t: f64, y: &[f64], p: &[f64], ydot: &mut [f64]| {
                    ydot[0] = p[0];
                    ydot[1] = (1e6 * (y[0] - 0.5)).tanh();
                    Ok(())
                };
                Problem::ode(with_parameters(front, [1.0]), [0.0, 0.0])
            },
            1.0,
        ),
        (
            &|| {
                let kinks = |t: f64, y: &[f64], p: &[f64], ydot: &mut [f64]| {
                    ydot[0] = -p[0] * y[0].abs() + (7.0 * t).sin().max(0.0) - (y[0] - 0.3).max(0.0);
                    Ok(())
                };
                Problem::ode(with_parameters(kinks, [1.0]), [1.0])
            },
            10.0,
        ),
    ];
    for (problem, end) in smooth {
        for rtol in [1e-4, 1e-7] {
            let options = Options::new(rtol, 1e-3 * rtol).sensitivities(Sensitivities::of([0]));
            solve(problem(), Method::Bdf, (0.0, end), &options).unwrap();
        }
    }
}

/// With equations that do not switch there, an event is only recorded: the steps are the same.
#[test]
fn recorded_events_change_no_steps_of_smooth_equations() {
    let problem = || {
        let sine = |_t: f64, y: &[f64], p: &[f64], ydot: &mut [f64]| {
            ydot.copy_from_slice(&[y[1], -p[0] * y[0]]);
            Ok(())
        };
        Problem::ode(with_parameters(sine, [1.0]), [0.0, 1.0])
    };
    let options = Options::new(1e-8, 1e-10).sensitivities(Sensitivities::of([0]));
    let plain = solve(problem(), Method::Bdf, (0.0, 10.0), &options).unwrap();
    let events = problem().event(Event::new(|_t, y| y[0]));
    let watched = solve(events, Method::Bdf, (0.0, 10.0), &options).unwrap();
    assert_eq!(watched.events().len(), 3);
    assert_eq!(watched.t().len(), plain.t().len());
    let last = plain.t().len() - 1;
    let off = watched.sensitivities(last)[(0, 0)] - plain.sensitivities(last)[(0, 0)];
    assert!(off.abs() < 1e-8, "{off:e}");
}

/// y' = 1 below 0 and -1 above slides along 0, where derivatives do not exist.
#[test]
fn sliding_is_refused() {
    let problem = || {
        let equations = with_parameters(
            |_t, y, p, ydot| {
                ydot[0] = if y[0] < 0.0 { p[0] } else { -p[0] };
                Ok(())
            },
            [1.0],
        );
        Problem::ode(equations, [-0.5]).event(Event::new(|_t, y| y[0]))
    };
    for found in both(problem, Method::Bdf, 1.0, 1) {
        assert!(found.unwrap_err().to_string().contains("slides"));
    }
}
