//! Events at the edge of what is defined: of the function of the event, or of the equations.

use pliant::{
    ode::Failure,
    solve::{End, Error, Event, Method, Options, Problem, Reason, solve},
    sundials::ButcherTable,
};

use crate::support::{methods, tight};

/// y = 1 - t, which goes on beyond zero.
fn falling<'a>() -> Problem<'a> {
    let fall = |_t: f64, _y: &[f64], ydot: &mut [f64]| -> Result<(), Failure> {
        ydot[0] = -1.0;
        Ok(())
    };
    Problem::ode(fall, [1.0])
}

/// An emptying tank: y = (1 - t/2)^2 up to t = 2; a negative level is no number to the equations.
fn tank<'a>() -> Problem<'a> {
    let empties = |_t: f64, y: &[f64], ydot: &mut [f64]| -> Result<(), Failure> {
        ydot[0] = -y[0].sqrt();
        Ok(())
    };
    Problem::ode(empties, [1.0])
}

/// ln y falls to -4 at y = exp(-4), just before the edge of its domain, which steps of any size pass: all methods have a
/// solution of degree one exactly.
#[test]
fn a_root_before_the_edge_of_its_function() {
    let expected = 1.0 - (-4.0_f64).exp();
    for method in methods() {
        for options in [Options::new(1e-3, 1e-6), tight()] {
            let event = Event::new(|_, y| y[0].ln() + 4.0).terminal();
            // what another function is behind does not matter
            let other = Event::new(|_, y| (y[0] - 0.01).ln() - 1.0);
            let problem = falling().event(other).event(event);
            let solution = solve(problem, method, (0.0, 5.0), &options).unwrap();
            assert_eq!(solution.end(), End::Event(1), "{method:?}");
            let [found] = solution.events() else { panic!("{method:?}: {:?}", solution.events()) };
            assert!(
                (found.t - expected).abs() < 1e-12 && found.sign == -1,
                "{method:?}: {found:?}"
            );
        }
    }
}

/// A square root has its zero at the edge itself.
#[test]
fn a_root_at_the_edge_of_its_function() {
    for method in methods() {
        let problem = falling().event(Event::new(|_, y| y[0].sqrt()).falling().terminal());
        let solution = solve(problem, method, (0.0, 5.0), &tight()).unwrap();
        let [found] = solution.events() else { panic!("{method:?}: {:?}", solution.events()) };
        assert!((found.t - 1.0).abs() < 1e-12 && found.sign == -1, "{method:?}: {found:?}");
    }
}

/// A function that does not come to zero before it is undefined is an error, as one that is an event the other way.
#[test]
fn a_function_that_ends_without_a_root_is_told() {
    let functions: [fn(f64) -> f64; 3] = [|y| y.sqrt() + 0.1, |y| y.ln() + 800.0, f64::sqrt];
    for (g, rises) in functions.into_iter().zip([false, false, true]) {
        let event = Event::new(move |_, y| g(y[0])).terminal();
        let event = if rises { event.rising() } else { event };
        let error = solve(falling().event(event), Method::Bdf, (0.0, 5.0), &tight()).unwrap_err();
        assert!(error.to_string().contains("the function of event 0 is NaN"), "{error}");
        let reached = error.solution().and_then(|part| part.t().last().copied());
        assert!(reached.is_some_and(|t| t < 1.0), "{reached:?}");
    }
}

/// No step leads behind the event: it ends the run where steps have come to it within the tolerances.
#[test]
fn equations_that_end_at_the_event() {
    let tables = [ButcherTable::implicit(5), ButcherTable::explicit(5), ButcherTable::explicit(4)];
    let tables = tables.map(|table| Method::RungeKutta(table.unwrap()));
    let own = [Method::Bdf, Method::Adams, Method::Rosenbrock, Method::DormandPrince];
    for method in own.into_iter().chain(tables) {
        for (rtol, atol) in [(1e-6, 1e-8), (1e-10, 1e-12)] {
            let ends: [fn(&[f64]) -> f64; 2] = [|y| y[0], |y| y[0].sqrt()];
            for g in ends {
                let problem = tank().event(Event::new(move |_, y| g(y)).terminal());
                let options = Options::new(rtol, atol);
                let solution = solve(problem, method, (0.0, 5.0), &options);
                let solution = solution.unwrap_or_else(|error| panic!("{method:?}: {error}"));
                assert_eq!(solution.end(), End::Event(0), "{method:?}");
                // y is off by a hundred tolerances at most, of which t - 2 is twice the root
                let (t, y) = (solution.t().last().unwrap(), solution.last()[0]);
                println!("{method:?} {rtol:e}: {:e} {y:e}", t - 2.0);
                assert!((t - 2.0).abs() < 20.0 * f64::sqrt(rtol), "{method:?}: {t}");
                assert!(y.abs() < 100.0 * atol, "{method:?}: {y}");
            }
        }
    }
}

/// Elsewhere a failure stays one, whatever is looked for.
#[test]
fn a_failure_far_from_the_event_stays() {
    for g in [|y: f64| y + 1e-3, |y: f64| y - 2.0] {
        let problem = tank().event(Event::new(move |_, y| g(y[0])).terminal());
        let error = solve(problem, Method::DormandPrince, (0.0, 5.0), &tight()).unwrap_err();
        println!("{error}");
        let Error::Stopped(stopped) = error else { panic!("{error}") };
        assert!(matches!(stopped.reason, Reason::Failed(_)), "{stopped}");
        assert_eq!(stopped.solution.events(), []);
    }
}
