//! Known times at which something changes.

use pliant::solve::{End, Event, Options, Problem, solve};

use crate::support::{methods, oscillator, tight};

/// y' = 1 before t = 1, -2 from then on: y(3) = 1 - 4. With the break a method steps on it, and neither side sees the other:
/// the solution is linear on both, and exact to rounding.
#[test]
fn neither_side_of_a_break_sees_the_other() {
    for method in methods() {
        let slope = |t: f64| if t < 1.0 { 1.0 } else { -2.0 };
        let saw = move |t: f64, _: &[f64], ydot: &mut [f64]| {
            ydot[0] = slope(t);
            Ok(())
        };
        let problem = Problem::ode(saw, [0.0]).breaks([1.0]);
        let solution = solve(problem, method, (0.0, 3.0), &tight()).unwrap();
        assert!((solution.last()[0] + 3.0).abs() < 1e-13, "{method:?}: {:?}", solution.last());
        assert!((solution.at(1.0).unwrap()[0] - 1.0).abs() < 1e-13, "{method:?}");
        assert!(solution.t().contains(&1.0));
        // without it the jump has to be found by steps that fail
        let blind = solve(Problem::ode(saw, [0.0]), method, (0.0, 3.0), &tight()).unwrap();
        let failures = |s: &pliant::solve::Solution| s.statistics().error_test_failures;
        assert_eq!(failures(&solution), 0, "{method:?}");
        assert!(failures(&blind) > 3, "{method:?}: {}", failures(&blind));
    }
}

/// Kicks of 1 to the velocity at pi and 2 pi: from (0, 1), sin t turns to -2 sin... each is known in closed form.
#[test]
fn an_action_at_a_break_changes_the_state() {
    use std::f64::consts::PI;
    for method in methods() {
        // at pi the state is (0, -1): doubled; at 2 pi it is (0, 2): stopped
        let problem = Problem::ode(oscillator, [0.0, 1.0])
            .break_with(2.0 * PI, |jump| jump.y.fill(0.0))
            .break_with(PI, |jump| jump.y[1] *= 2.0);
        let solution = solve(problem, method, (0.0, 8.0), &tight()).unwrap();
        assert!((solution.at(1.5 * PI).unwrap()[0] + 2.0).abs() < 1e-8, "{method:?}");
        assert_eq!(solution.last(), [0.0, 0.0]);
        // the time of a jump is there twice, with both states
        let k = solution.t().iter().position(|&t| t == PI).unwrap();
        assert_eq!(solution.t()[k + 1], PI);
        assert_eq!(solution.y(k + 1)[1], 2.0 * solution.y(k)[1]);
    }
}

#[test]
fn a_break_may_end_the_run() {
    for method in methods() {
        let problem = Problem::ode(oscillator, [0.0, 1.0]).break_with(2.0, |jump| jump.end());
        let solution = solve(problem, method, (0.0, 8.0), &Options::new(1e-6, 1e-8)).unwrap();
        assert_eq!((solution.end(), solution.t().last()), (End::Break, Some(&2.0)));
    }
}

/// An impact exactly where a break is: both happen, the event first.
#[test]
fn an_event_may_come_with_a_break() {
    for method in methods() {
        let falls = |t: f64, _y: &[f64], ydot: &mut [f64]| {
            ydot[0] = if t < 2.0 { -1.0 } else { 3.0 };
            Ok(())
        };
        let bounce =
            Event::new(|t: f64, _| t - 2.0_f64.next_down()).action(|jump| jump.y[0] += 10.0);
        let problem =
            Problem::ode(falls, [1.0]).event(bounce).break_with(2.0, |jump| jump.y[0] *= 2.0);
        let solution = solve(problem, method, (0.0, 4.0), &tight()).unwrap();
        assert_eq!(solution.events().len(), 1, "{method:?}");
        // 1 - 2 + 10 = 9, twice that is 18, and 6 more by the end
        assert!((solution.last()[0] - 24.0).abs() < 1e-9, "{method:?}: {:?}", solution.last());
        assert_eq!(solution.end(), End::Span);
    }
}
