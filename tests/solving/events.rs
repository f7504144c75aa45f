//! Events: found, counted, acted on, by every method.

use std::f64::consts::{FRAC_PI_2, PI};

use pliant::{
    ode::{dae_with_parameters, with_mass, with_parameters},
    solve::{End, Event, Method, Problem, solve},
};

use crate::support::{G, fall, methods, oscillator, sine, tight};

/// A ball from 10 m that keeps nine tenths of its speed: impacts at t1, t1 + 2 t1 0.9, + 2 t1 0.81, ..., in closed form.
///
/// The motion is a parabola, which every method of order 2 has exactly, so the error is that of BDF's first steps of
/// order 1 and of the start after each impact, by the tolerance 1e-10 of a state of 10.
#[test]
fn a_ball_bounces_at_the_times_of_the_closed_form() {
    for method in methods() {
        let floor = Event::new(|_, y| y[0]).falling().action(|jump| jump.y[1] *= -0.9);
        let problem = Problem::ode(fall, [10.0, 0.0]).event(floor);
        let solution = solve(problem, method, (0.0, 10.0), &tight()).unwrap();
        let first = (2.0 * 10.0 / G).sqrt();
        let (mut expected, mut flight) = (first, 2.0 * first);
        assert_eq!(solution.events().len(), 4, "{method:?}");
        for impact in solution.events() {
            assert!((impact.t - expected).abs() < 1e-8, "{method:?}: {impact:?} {expected}");
            assert_eq!((impact.event, impact.sign), (0, -1));
            assert!(impact.y[1] < 0.0 && impact.y[0].abs() < 1e-11, "{impact:?}");
            flight *= 0.9;
            expected += flight;
        }
        assert_eq!(solution.end(), End::Span);
        assert_eq!(solution.t().last(), Some(&10.0));
    }
}

/// sin t has its roots at k pi, rising at even k, falling at odd ones; it starts at a root, which is no event.
#[test]
fn recorded_events_change_nothing() {
    for method in methods() {
        let plain = solve(sine(), method, (0.0, 20.0), &tight()).unwrap();
        let watched = sine()
            .event(Event::new(|_, y| y[0]))
            .event(Event::new(|_, y| y[0]).rising())
            .event(Event::new(|_, y| y[0]).falling());
        let watched = solve(watched, method, (0.0, 20.0), &tight()).unwrap();
        assert_eq!(plain.states(), watched.states(), "{method:?}");
        let times =
            |event: usize| watched.events().iter().filter(move |e| e.event == event).map(|e| e.t);
        let close = |found: Vec<f64>, expected: Vec<f64>| {
            assert_eq!(found.len(), expected.len(), "{method:?}: {found:?}");
            for (t, expected) in found.iter().zip(expected) {
                // global errors of about a hundred times the tolerance
                assert!((t - expected).abs() < 2e-8, "{method:?}: {t} {expected}");
            }
        };
        close(times(0).collect(), (1..=6).map(|k| PI * f64::from(k)).collect());
        close(times(1).collect(), (1..=3).map(|k| PI * f64::from(2 * k)).collect());
        close(times(2).collect(), (0..=2).map(|k| PI * f64::from(2 * k + 1)).collect());
    }
}

#[test]
fn a_run_ends_at_a_terminal_event_or_at_one_of_a_given_number() {
    for method in methods() {
        let half = || Event::new(|_, y| y[0] - 0.5);
        let solution =
            solve(sine().event(half().terminal()), method, (0.0, 20.0), &tight()).unwrap();
        assert_eq!(solution.end(), End::Event(0));
        assert!((solution.t().last().unwrap() - PI / 6.0).abs() < 1e-9, "{method:?}");
        assert!((solution.last()[0] - 0.5).abs() < 1e-12, "{method:?}");
        // rising through 1/2 for the third time
        let third = sine().event(half().rising().terminal_after(3));
        let solution = solve(third, method, (0.0, 20.0), &tight()).unwrap();
        assert_eq!(solution.events().len(), 3);
        let expected = PI / 6.0 + 4.0 * PI;
        assert!((solution.t().last().unwrap() - expected).abs() < 1e-8, "{method:?}");
    }
}

/// sin t and cos t - 1 are both zero at 2 pi, the second without a change of sign; sin t and sin 2t at pi.
#[test]
fn several_events_may_come_at_one_time() {
    for method in methods() {
        let problem = sine()
            .event(Event::new(|_, y| y[0]))
            .event(Event::new(|_, y| 2.0 * y[0] * y[1]))
            .event(Event::new(|t, _| t - PI).terminal());
        let solution = solve(problem, method, (0.0, 5.0), &tight()).unwrap();
        let found: Vec<usize> = solution.events().iter().map(|e| e.event).collect();
        // sin 2t at pi/2, then all at pi, which the first two know to their errors
        assert_eq!(found[0], 1);
        assert!((solution.events()[0].t - FRAC_PI_2).abs() < 1e-9);
        assert!(solution.events()[1..].iter().all(|e| (e.t - PI).abs() < 1e-8), "{found:?}");
        assert!(found.contains(&2), "{method:?} {found:?}");
    }
    // exactly at one time: the same function twice, once with each kind of consequence
    let mut order = Vec::new();
    let g = || Event::new(|_, y| y[0] + 0.25).falling();
    let problem =
        sine().event(g()).event(g().action(|jump| order.push(jump.t))).event(g().terminal());
    let solution = solve(problem, Method::Bdf, (0.0, 20.0), &tight()).unwrap();
    let found: Vec<usize> = solution.events().iter().map(|e| e.event).collect();
    assert_eq!(found, [0, 1, 2]);
    assert_eq!(order, [solution.events()[0].t]);
    assert_eq!(solution.end(), End::Event(2));
}

/// 1 - cos t touches zero at 2 pi: found if asked for, as near as a minimum of a function with errors of 1e-9 tells: to its square root.
#[test]
fn touching_counts_if_asked_for() {
    for method in methods() {
        let start = [0.5_f64.sin(), 0.5_f64.cos()];
        let solved = |event| {
            let problem = Problem::ode(oscillator, start).event(event);
            solve(problem, method, (0.5, 8.0), &tight()).unwrap()
        };
        let touch = || Event::new(|_, y| 1.0 - y[1]);
        let near = |t: f64| (t - 2.0 * PI).abs() < 1e-4;
        let solution = solved(touch().touching(1e-7));
        assert!(!solution.events().is_empty(), "{method:?}");
        assert!(solution.events().iter().all(|e| near(e.t)), "{method:?}: {:?}", solution.events());
        // by its error 1 - cos t may become negative for a moment, which are two roots
        assert!(solved(touch()).events().iter().all(|e| near(e.t)), "{method:?}");
    }
}

/// A pulse of time that lasts a thousandth of the steps: invisible to the ends of the steps, and to four samples of one.
#[test]
fn two_roots_within_a_step_are_not_missed() {
    for method in methods() {
        // steps of up to 0.5 at these loose tolerances; the dip at 3.3 is 0.02 wide
        let dip = || Event::new(|t: f64, _: &[f64]| (t - 3.3).powi(2) - 1e-4);
        let loose = pliant::solve::Options::new(1e-3, 1e-3);
        let solution = solve(sine().event(dip()), method, (0.0, 6.0), &loose).unwrap();
        let times: Vec<f64> = solution.events().iter().map(|e| e.t).collect();
        assert_eq!(times.len(), 2, "{method:?}: {times:?}");
        assert!((times[0] - 3.29).abs() < 1e-12 && (times[1] - 3.31).abs() < 1e-12, "{times:?}");
    }
}

/// A heater that switches at two thresholds: the state stays, a parameter changes. Between the switches y is exponential.
#[test]
fn an_action_may_change_parameters() {
    // y' = p (1 if on) - y, between 0.2 and 0.8: ln 4 up from 0.2 to 0.8, ln 4 down
    for method in methods() {
        let heater = with_parameters(
            |_t, y, p, ydot| {
                ydot[0] = p[0] - y[0];
                Ok(())
            },
            [1.0],
        );
        let problem = Problem::ode(heater, [0.2])
            .event(Event::new(|_, y| y[0] - 0.8).rising().action(|jump| jump.p[0] = 0.0))
            .event(Event::new(|_, y| y[0] - 0.2).falling().action(|jump| jump.p[0] = 1.0));
        let solution = solve(problem, method, (0.0, 10.0), &tight()).unwrap();
        let expected: Vec<f64> = (1..=7).map(|k| f64::from(k) * 4.0_f64.ln()).collect();
        assert_eq!(solution.events().len(), expected.len(), "{method:?}");
        for (event, expected) in solution.events().iter().zip(&expected) {
            assert!((event.t - expected).abs() < 5e-8, "{method:?}: {} {expected}", event.t);
        }
        assert_eq!(solution.parameters(), [0.0]);
    }
}

/// The same as a DAE: y' = x - y, 0 = x - p, whose algebraic unknown has to follow the parameter at once.
#[test]
fn algebraic_unknowns_follow_a_jump() {
    let heater = dae_with_parameters(
        |_t, y, yp, p, r| {
            r[0] = y[1] - y[0] - yp[0];
            r[1] = y[1] - p[0];
            Ok(())
        },
        [1.0],
    );
    // an inconsistent start, which is corrected
    let problem = Problem::dae(heater, [0.2, 0.0], [0.0, 0.0])
        .differential([true, false])
        .event(Event::new(|_, y| y[0] - 0.8).rising().action(|jump| jump.p[0] = 0.0))
        .event(Event::new(|_, y| y[0] - 0.2).falling().action(|jump| jump.p[0] = 1.0));
    let solution = solve(problem, Method::Ida, (0.0, 10.0), &tight()).unwrap();
    assert_eq!(solution.events().len(), 7);
    for (k, event) in (1..).zip(solution.events()) {
        let expected = f64::from(k) * 4.0_f64.ln();
        assert!((event.t - expected).abs() < 1e-8, "{} {expected}", event.t);
    }
    assert_eq!(solution.y(0), [0.2, 1.0]);
    assert!((solution.last()[1]).abs() < 1e-10);
    assert!((solution.last_yp()[0] + solution.last()[0]).abs() < 1e-9);
}

/// The same with a mass matrix, diag(1, 0) y' = f(t, y): the singular one of an ODE makes it a DAE.
#[test]
fn a_mass_matrix_may_be_singular() {
    let heater = |_t: f64, y: &[f64], f: &mut [f64]| {
        f[0] = y[1] - y[0];
        f[1] = y[1] - 1.0;
        Ok(())
    };
    let problem = Problem::ode(with_mass(heater, [1.0, 0.0]), [0.2, 0.0])
        .event(Event::new(|_, y| y[0] - 0.8).terminal());
    let solution = solve(problem, Method::Ida, (0.0, 10.0), &tight()).unwrap();
    assert!((solution.t().last().unwrap() - 4.0_f64.ln()).abs() < 1e-9);
    assert_eq!(solution.y(0), [0.2, 1.0]);
}

/// Backward in time events come in the order of the run, and what rises with t falls along it.
#[test]
fn events_are_found_backward_in_time() {
    for method in [Method::Bdf, Method::Adams] {
        let problem = Problem::ode(oscillator, [0.0, 1.0]).event(Event::new(|_, y| y[0]));
        let solution = solve(problem, method, (0.0, -10.0), &tight()).unwrap();
        let times: Vec<f64> = solution.events().iter().map(|e| e.t).collect();
        assert_eq!(times.len(), 3);
        for (k, t) in (1..).zip(times) {
            assert!((t + PI * f64::from(k)).abs() < 1e-8, "{t}");
        }
    }
}
