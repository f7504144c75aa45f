//! Derivatives to parameters, across events and breaks.

use pliant::{
    ode::{dae_with_parameters, with_parameters},
    solve::{Event, Method, Options, Output, Problem, Run, solve},
    sundials::Sensitivities,
};

use crate::support::{fall_under, tight};

fn decay<'a>() -> Problem<'a> {
    let equations = with_parameters(
        |_t, y, p, ydot| {
            ydot[0] = -p[0] * y[0];
            Ok(())
        },
        [2.0, 0.5],
    );
    Problem::ode(equations, [1.0])
}

/// y = e^(-p t): dy/dp = -t e^(-p t), at steps and at output times, by both families of CVODE.
#[test]
fn sensitivities_come_with_the_states() {
    for method in [Method::Bdf, Method::Adams] {
        let options = tight().sensitivities(Sensitivities::of([0]));
        let times: Vec<f64> = (0..=10).map(|k| 0.3 * f64::from(k)).collect();
        let at = options.clone().output(Output::Times(times.clone()));
        for options in [options, at] {
            let solution = solve(decay(), method, (0.0, 3.0), &options).unwrap();
            for (k, t) in solution.t().iter().enumerate() {
                let expected = -t * (-2.0 * t).exp();
                let s = solution.sensitivities(k);
                assert_eq!((s.nrows(), s.ncols()), (1, 1));
                assert!(
                    (s[(0, 0)] - expected).abs() < 5e-9,
                    "{method:?} {t}: {} {expected}",
                    s[(0, 0)]
                );
            }
        }
    }
}

/// The height of a ball at time t that falls from 10 m under gravity g and keeps the part e of its speed: two impacts by then.
fn height(t: f64, [g, e]: [f64; 2]) -> f64 {
    let first = (20.0 / g).sqrt();
    let speed = e * g * first;
    let second = first + 2.0 * speed / g;
    assert!(second < t);
    let (speed, t) = (e * speed, t - second);
    speed * t - 0.5 * g * t * t
}

/// Both derivatives of the height after two impacts against central differences of the closed form, which have 1e-9 left: the times of the impacts
/// depend on gravity, and on the restitution from the second on.
#[test]
fn a_bounce_is_followed() {
    let p = [9.81, 0.8];
    for method in [Method::Bdf, Method::Adams] {
        let floor = Event::new(|_, y| y[0]).falling().action(|jump| jump.y[1] *= -jump.p[1]);
        let problem = Problem::ode(fall_under(p), [10.0, 0.0]).event(floor);
        let options = tight().sensitivities(Sensitivities::of([0, 1]));
        let solution = solve(problem, method, (0.0, 4.2), &options).unwrap();
        assert_eq!(solution.events().len(), 2);
        assert!((solution.last()[0] - height(4.2, p)).abs() < 1e-7);
        let s = solution.sensitivities(solution.t().len() - 1);
        for k in 0..2 {
            let by = |d: f64| {
                let mut p = p;
                p[k] += d;
                height(4.2, p)
            };
            let expected = (by(1e-5) - by(-1e-5)) / 2e-5;
            let error = (s[(0, k)] - expected).abs() / expected.abs();
            println!("{method:?} {k}: {} {expected} {error:e}", s[(0, k)]);
            // measured 5e-9: the differences of the closed form and of the jump have about 1e-10, the state at the impacts 1e-9
            assert!(error < 2e-8, "{method:?} {k}: {} {expected}", s[(0, k)]);
        }
    }
}

/// The same ball as a DAE, with its acceleration as an algebraic unknown, whose derivative to gravity is -1 at the start already.
#[test]
fn a_bounce_of_a_dae_is_followed() {
    let p = [9.81, 0.8];
    let ball = dae_with_parameters(
        |_t, y, yp, p, r| {
            r[0] = yp[0] - y[1];
            r[1] = yp[1] - y[2];
            r[2] = y[2] + p[0];
            Ok(())
        },
        p,
    );
    let floor = Event::new(|_, y| y[0]).falling().action(|jump| jump.y[1] *= -jump.p[1]);
    let problem = Problem::dae(ball, [10.0, 0.0, 0.0], [0.0; 3])
        .differential([true, true, false])
        .event(floor);
    let options = tight().sensitivities(Sensitivities::of([0, 1]));
    let solution = solve(problem, Method::Ida, (0.0, 4.2), &options).unwrap();
    assert_eq!(solution.events().len(), 2);
    assert!((solution.last()[0] - height(4.2, p)).abs() < 1e-7);
    let last = solution.t().len() - 1;
    for k in [0, last] {
        let s = solution.sensitivities(k);
        assert!((s[(2, 0)] + 1.0).abs() < 1e-9 && s[(2, 1)].abs() < 1e-9, "{s:?}");
    }
    for k in 0..2 {
        let by = |d: f64| {
            let mut p = p;
            p[k] += d;
            height(4.2, p)
        };
        let expected = (by(1e-5) - by(-1e-5)) / 2e-5;
        let error = (solution.sensitivities(last)[(0, k)] - expected).abs() / expected.abs();
        println!("{k}: {error:e}");
        assert!(error < 2e-8, "{k}: {error:e}");
    }
}

/// y' = z, 0 = z - p until t = 1 and 0 = z - 2 p from then on: z and dz/dp jump there with the equations.
#[test]
fn algebraic_unknowns_jump_at_a_break() {
    let ramp = dae_with_parameters(
        |t, y, yp, p, r| {
            r[0] = yp[0] - y[1];
            r[1] = y[1] - if t < 1.0 { p[0] } else { 2.0 * p[0] };
            Ok(())
        },
        [3.0],
    );
    let problem =
        Problem::dae(ramp, [0.0, 0.0], [0.0; 2]).differential([true, false]).breaks([1.0]);
    let options = tight().sensitivities(Sensitivities::of([0]));
    let solution = solve(problem, Method::Ida, (0.0, 2.0), &options).unwrap();
    let at = solution.t().iter().position(|&t| t == 1.0).unwrap();
    let found = [at, at + 1].map(|k| [solution.y(k)[1], solution.sensitivities(k)[(1, 0)]]);
    let expected = [[3.0, 1.0], [6.0, 2.0]];
    for (found, expected) in found.as_flattened().iter().zip(expected.as_flattened()) {
        assert!((found - expected).abs() < 1e-8, "{found} {expected}");
    }
    let last = solution.t().len() - 1;
    assert!((solution.y(last)[0] - 9.0).abs() < 1e-8);
    assert!((solution.sensitivities(last)[(0, 0)] - 3.0).abs() < 1e-8);
}

/// At t = 1 the state is raised by p1: dy/dp1 = e^(-p0 (t - 1)) from then on, and 0 before.
#[test]
fn a_break_is_followed() {
    let problem = || decay().break_with(1.0, |jump| jump.y[0] += jump.p[1]);
    let options = tight().sensitivities(Sensitivities::of([1, 0]));
    let solution = solve(problem(), Method::Bdf, (0.0, 2.0), &options).unwrap();
    let k = solution.t().iter().position(|&t| t == 1.0).unwrap();
    assert_eq!(solution.sensitivities(k)[(0, 0)], 0.0);
    assert!((solution.sensitivities(k + 1)[(0, 0)] - 1.0).abs() < 1e-9);
    let last = solution.sensitivities(solution.t().len() - 1);
    let (decayed, start) = ((-2.0_f64).exp(), (-4.0_f64).exp());
    assert!((last[(0, 0)] - decayed).abs() < 1e-8, "{}", last[(0, 0)]);
    // to the rate: -2 e^-4 of the start, and -1/2 e^-2 of what came at t = 1
    assert!((last[(0, 1)] + 2.0 * start + 0.5 * decayed).abs() < 1e-8, "{}", last[(0, 1)]);

    // put aside and taken up again
    let mut run = Run::new(problem(), Method::Bdf, (0.0, 2.0), &options).unwrap();
    while run.t() < 1.5 {
        run.advance().unwrap();
    }
    let saved = run.save();
    let start = saved.t;
    let late = solve(problem().resume(saved), Method::Bdf, (start, 2.0), &options).unwrap();
    let s = late.sensitivities(late.t().len() - 1);
    assert!((s[(0, 0)] - last[(0, 0)]).abs() < 1e-8 && (s[(0, 1)] - last[(0, 1)]).abs() < 1e-8);
}

#[test]
fn what_cannot_be_followed_is_refused() {
    let options = Options::new(1e-6, 1e-8).sensitivities(Sensitivities::of([0]));
    let text = solve(decay(), Method::DormandPrince, (0.0, 1.0), &options).unwrap_err().to_string();
    assert!(text.contains("sensitivities") && text.contains("take Bdf, Adams or Ida"), "{text}");
    let dae = dae_with_parameters(
        |_t, y, yp, p, r| {
            r[0] = yp[0] + p[0] * y[0];
            Ok(())
        },
        [2.0],
    );
    let problem = Problem::dae(dae, [1.0], [-2.0]).breaks([0.5]);
    let text = solve(problem, Method::Ida, (0.0, 1.0), &options).unwrap_err().to_string();
    assert!(text.contains("Problem::differential"), "{text}");
    let dae = dae_with_parameters(
        |_t, y, yp, p, r| {
            r[0] = yp[0] + p[0] * y[0];
            Ok(())
        },
        [2.0],
    );
    let problem = Problem::dae(dae, [1.0], [-2.0])
        .differential([true])
        .break_with(0.5, |jump| jump.y[0] = -jump.yp[0]);
    let text = solve(problem, Method::Ida, (0.0, 1.0), &options).unwrap_err().to_string();
    assert!(text.contains("not yp"), "{text}");
    // the top of a flight is touched, and no crossing of it
    let top = Event::new(|_, y| y[0] - 1.0).touching(1e-3).action(|jump| jump.y[1] = -1.0);
    let problem = Problem::ode(fall_under([8.0, 0.0]), [0.0, 4.0]).event(top);
    let text = solve(problem, Method::Bdf, (0.0, 1.0), &options).unwrap_err().to_string();
    assert!(text.contains("only touches zero"), "{text}");
}

/// y(0) = p1 and y' = -p0 y: dy/dp1 = e^(-p0 t), from 1 at the start.
#[test]
fn the_start_may_depend_on_parameters() {
    let options = tight().sensitivities(Sensitivities::of([1, 0]));
    let problem = || decay().initial_sensitivities([1.0, 0.0]);
    let solution = solve(problem(), Method::Bdf, (0.0, 1.0), &options).unwrap();
    let decayed = (-2.0_f64).exp();
    for (k, expected) in [(0, [1.0, 0.0]), (solution.t().len() - 1, [decayed, -decayed])] {
        let s = solution.sensitivities(k);
        assert!((s[(0, 0)] - expected[0]).abs() < 1e-9 && (s[(0, 1)] - expected[1]).abs() < 1e-9);
    }
    let refused = |problem, options: &Options| {
        solve(problem, Method::Bdf, (0.0, 1.0), options).unwrap_err().to_string()
    };
    assert!(refused(decay().initial_sensitivities([1.0]), &options).contains("there are 2"));
    assert!(refused(problem(), &tight()).contains("Options::sensitivities"));
}

/// y' = p up to an event at y = 1, where y becomes 3: y = 3 + p t - 1 behind it. A break just before makes the last step short, which
/// tells nothing of the time in which the solution changes: differences over a part of that step would be rounding alone.
#[test]
fn a_short_last_step_costs_no_digits() {
    for gap in [1e-3, 1e-6, 1e-9, 1e-12] {
        let line = with_parameters(
            |_t, _y, p, ydot| {
                ydot[0] = p[0];
                Ok(())
            },
            [1.0],
        );
        let event = Event::new(|_, y| y[0] - 1.0).rising().action(|jump| jump.y[0] = 3.0);
        let problem = Problem::ode(line, [0.0]).breaks([1.0 - gap]).event(event);
        let options = tight().sensitivities(Sensitivities::of([0]));
        let solution = solve(problem, Method::Bdf, (0.0, 2.0), &options).unwrap();
        let s = solution.sensitivities(solution.t().len() - 1)[(0, 0)];
        println!("{gap:e}: {:e}", s - 2.0);
        // differences have 4e-11 of the slope left
        assert!((s - 2.0).abs() < 1e-9, "{gap:e}: {s}");
    }
}
