//! Events at given times, events that happen once, are armed, or are held at zero.

use pliant::{
    ode::{Failure, Functional, Slopes, dae_with_parameters, with_parameters},
    solve::{Event, Method, Options, Output, Problem, Run, gradient, solve},
    sundials::{AdjointOptions, Sensitivities},
};

use crate::support::{methods, tight};

fn decay<'a>() -> Problem<'a> {
    let decay = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot[0] = -y[0];
        Ok(())
    };
    Problem::ode(decay, [1.0])
}

/// A clock has all of its ticks, at k times the period, for each method: those that do nothing leave the steps as they are.
#[test]
fn no_tick_is_lost() {
    for method in methods() {
        let plain = solve(decay(), method, (0.0, 1.0), &tight()).unwrap();
        for period in [0.3, 0.001] {
            let ticks = (1.0_f64 / period).floor() as usize;
            for acts in [false, true] {
                let clock = Event::every(period);
                let clock = if acts { clock.action(|_| ()) } else { clock };
                let solution = solve(decay().event(clock), method, (0.0, 1.0), &tight()).unwrap();
                assert_eq!(solution.events().len(), ticks, "{method:?} {period} {acts}");
                for (k, tick) in solution.events().iter().enumerate() {
                    assert_eq!(tick.t, (k + 1) as f64 * period);
                    // errors of many starts add up
                    let off = (tick.y[0] - (-tick.t).exp()).abs();
                    assert!(off < 1e-5, "{method:?} {period} {acts}: {off:e}");
                }
                assert_eq!(solution.t().last(), Some(&1.0));
                assert!(acts || solution.statistics().steps == plain.statistics().steps);
            }
        }
    }
}

/// Both start and end of the span are times like others: y' = -y from 1, which becomes 2 at the start and grows by 5 at the end.
#[test]
fn actions_take_place_at_the_ends_of_the_span() {
    for method in methods() {
        let problem = || {
            decay()
                .event(Event::at(0.0).action(|jump| jump.y[0] = 2.0))
                .event(Event::at(1.0).action(|jump| jump.y[0] += 5.0))
        };
        let solution = solve(problem(), method, (0.0, 1.0), &tight()).unwrap();
        assert_eq!(solution.y(0), [2.0]);
        assert_eq!(solution.events()[0].y, [1.0]);
        let times: Vec<f64> = solution.events().iter().map(|event| event.t).collect();
        assert_eq!(times, [0.0, 1.0]);
        let expected = 5.0 + 2.0 * (-1.0_f64).exp();
        assert!((solution.last()[0] - expected).abs() < 1e-6, "{method:?}");

        // resumed behind the start, the action there is not repeated
        let first = solve(problem(), method, (0.0, 0.5), &tight()).unwrap();
        let second = problem().resume(first.saved().clone());
        let second = solve(second, method, (0.5, 1.0), &tight()).unwrap();
        assert!((second.last()[0] - expected).abs() < 1e-6, "{method:?}");
    }
}

/// A run shows what happened at its start with the first step, and once.
#[test]
fn a_run_shows_the_event_at_its_start() {
    let problem = decay().event(Event::at(0.0).action(|jump| jump.y[0] = 2.0));
    let mut run = Run::new(problem, Method::Bdf, (0.0, 1.0), &tight()).unwrap();
    assert_eq!(run.y(), [2.0]);
    let counts: Vec<usize> = (0..2).map(|_| run.advance().unwrap().unwrap().events.len()).collect();
    assert_eq!(counts, [1, 0]);
}

/// Backward in time a clock ticks at the same multiples, and from its start on downwards. 1e4 s away from 0 it has no drift.
#[test]
fn clocks_run_backward_and_far_away() {
    let times = |event: Event<'static>, span: (f64, f64)| -> Vec<f64> {
        let solution = solve(decay().event(event), Method::Bdf, span, &tight()).unwrap();
        solution.events().iter().map(|event| event.t).collect()
    };
    assert_eq!(times(Event::every(0.25), (0.8, 0.0)), [0.75, 0.5, 0.25, 0.0]);
    assert_eq!(
        times(Event::every(0.5).starting_at(0.75).action(|_| ()), (1.0, -0.5)),
        [0.75, 0.25, -0.25]
    );
    let far = times(Event::every(0.1).action(|_| ()), (10_000.05, 10_001.0));
    let expected: Vec<f64> = (100_001..=100_010).map(|k| f64::from(k) * 0.1).collect();
    assert_eq!(far, expected);
    assert_eq!(times(Event::every(0.25).terminal_after(2), (0.1, 9.0)), [0.25, 0.5]);
}

/// The state at the end.
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

/// y' = u, and each second, from the start on, a controller sets u = (p - y) / 2: y(3) = p (1 - 1/8), forward and by the adjoint.
#[test]
fn a_sampled_controller_has_derivatives() {
    let problem = || {
        let plant = with_parameters(
            |_t, _y, p, ydot| {
                ydot[0] = p[1];
                Ok(())
            },
            [2.0, 0.0],
        );
        let control =
            |jump: &mut pliant::solve::Jump<'_>| jump.p[1] = 0.5 * (jump.p[0] - jump.y[0]);
        let clock = Event::every(1.0).starting_at(0.0).action(control);
        Problem::ode(plant, [0.0]).event(clock)
    };
    let options = tight().sensitivities(Sensitivities::of([0]));
    let solution = solve(problem(), Method::Bdf, (0.0, 3.0), &options).unwrap();
    assert!((solution.last()[0] - 1.75).abs() < 1e-9);
    let s = solution.sensitivities(solution.t().len() - 1)[(0, 0)];
    assert!((s - 0.875).abs() < 1e-9, "{s}");
    let back = AdjointOptions::new(1e-10, 1e-12);
    let found = gradient(problem(), Last, Method::Bdf, (0.0, 3.0), &tight(), &back).unwrap();
    assert!((found.parameters[0] - 0.875).abs() < 1e-9, "{found:?}");
    assert!((found.initial_state[0] - 0.125).abs() < 1e-9, "{found:?}");
}

/// A cell that is charged at constant current up to 4.2 V, then at constant voltage down to 0.05 A, and discharged to 3.6 V, again and again. The voltage is held by an
/// equation, whose rounding is no event; the next charge is one again. The current ends by the equations, not by events, so that one cycle
/// takes as many steps as with an event function that a hand switches off.
#[test]
fn an_event_that_is_held_at_zero_happens_once() {
    let charge = |by_hand: bool, end: f64| {
        let cell = dae_with_parameters(
            |_t, y, yp, p, r| {
                let rest = 3.4 + 0.6 * y[0] + 0.3 * (4.0 * y[0]).tanh();
                r[0] = yp[0] - y[1] / 3600.0;
                r[1] = y[2] - rest - 0.05 * y[1] - 0.01 * (3.0 * y[1]).asinh();
                r[2] = match p[0] {
                    0.0 => y[1] - 1.0,
                    1.0 => y[2] - 4.2,
                    _ => y[1] + 1.0,
                };
                Ok(())
            },
            [0.0],
        );
        let full = move |_t: f64, y: &[f64], p: &[f64]| {
            if by_hand && p[0] == 1.0 { -1.0 } else { y[2] - 4.2 }
        };
        let full = Event::with_parameters(full).rising().action(|jump| jump.p[0] = 1.0);
        let done = Event::new(|_t, y| y[1] - 0.05).falling().action(|jump| jump.p[0] = 2.0);
        let empty = Event::new(|_t, y| y[2] - 3.6).falling().action(|jump| jump.p[0] = 0.0);
        let problem = Problem::dae(cell, [0.0, 1.0, 3.45], [0.0; 3])
            .differential([true, false, false])
            .event(full)
            .event(done)
            .event(empty);
        let options = Options::new(1e-6, 1e-8).output(Output::End);
        solve(problem, Method::Ida, (0.0, end), &options).unwrap()
    };
    let [held, by_hand] = [false, true].map(|by_hand| charge(by_hand, 3400.0));
    assert_eq!(held.events().len(), 1);
    assert_eq!(held.statistics().steps, by_hand.statistics().steps);
    let numbers: Vec<usize> = charge(false, 40_000.0).events().iter().map(|at| at.event).collect();
    assert_eq!(numbers[..9], [0, 1, 2].repeat(3), "{numbers:?}");
}

/// y = sin t crosses 0 at each multiple of pi. An event that happens once is met at pi alone; one that another one arms again at 7.5, at 3 pi, too;
/// one that is disarmed at 4, at pi alone.
#[test]
fn events_happen_once_and_are_armed_and_disarmed() {
    let sine = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot.copy_from_slice(&[y[1], -y[0]]);
        Ok(())
    };
    for method in methods() {
        for acts in [false, true] {
            let crossing = || {
                let crossing = Event::new(|_t, y: &[f64]| y[0]);
                if acts { crossing.action(|_| ()) } else { crossing }
            };
            let problem = || {
                Problem::ode(sine, [0.0, 1.0])
                    .event(crossing().once())
                    .event(crossing().once())
                    .event(crossing())
                    .event(Event::at(4.0).action(|jump| jump.disarm(2)))
                    .event(Event::at(7.5).action(|jump| jump.arm(1)))
            };
            let expected = [vec![1.0], vec![1.0, 3.0], vec![1.0]];
            let solution = solve(problem(), method, (0.0, 12.0), &tight()).unwrap();
            let first = solve(problem(), method, (0.0, 5.0), &tight()).unwrap();
            let resumed = problem().resume(first.saved().clone());
            let second = solve(resumed, method, (5.0, 12.0), &tight()).unwrap();
            let pieces = [first.events(), second.events()].concat();
            for events in [solution.events(), &pieces] {
                for (number, expected) in expected.iter().enumerate() {
                    let found = events.iter().filter(|event| event.event == number);
                    let found: Vec<f64> =
                        found.map(|event| event.t / std::f64::consts::PI).collect();
                    assert_eq!(found.len(), expected.len(), "{method:?} {number} {found:?}");
                    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6));
                }
            }
        }
    }
}

#[test]
fn clocks_without_sense_are_refused() {
    let refused = |event: Event<'static>| {
        solve(decay().event(event), Method::Bdf, (0.0, 1.0), &tight()).unwrap_err().to_string()
    };
    for period in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-17] {
        assert!(refused(Event::every(period)).contains("period of event 0"));
    }
    assert!(refused(Event::at(f64::NAN)).contains("time of event 0"));
    assert!(refused(Event::every(0.1).rising()).contains("event with a function"));
    assert!(refused(Event::new(|_, y| y[0] - 0.5).starting_at(0.1)).contains("starting_at"));
    let arms = Event::at(0.5).action(|jump| jump.arm(7));
    assert!(refused(arms).contains("the problem has 1"));
}
