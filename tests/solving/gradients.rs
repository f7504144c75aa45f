//! Gradients of functionals, across events and breaks.

use pliant::{
    ode::{
        Borrowed, Failure, Functional, Ode, Slopes, dae_with_parameters, with_mass, with_parameters,
    },
    solve::{Event, Method, Options, Problem, Reason, gradient},
    sundials::{AdjointOptions, Gradient, Krylov, KrylovMethod, LinearSolver, Sensitivities},
};

use crate::support::{fall_under, tight};

const MULTISTEP: [Method; 2] = [Method::Bdf, Method::Adams];

/// y0(T) and the integral of y0^2.
struct Mixed;

impl Functional for Mixed {
    fn running(
        &mut self,
        _t: f64,
        y: &[f64],
        _p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        if let Some(slopes) = slopes {
            slopes.y[0] = 2.0 * y[0];
        }
        Ok(y[0] * y[0])
    }

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

/// The time of the end.
struct Time;

impl Functional for Time {
    fn terminal(
        &mut self,
        t: f64,
        _y: &[f64],
        _p: &[f64],
        _slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        Ok(t)
    }
}

fn back() -> AdjointOptions {
    AdjointOptions::new(1e-10, 1e-12)
}

/// The ball of gravity p0 that keeps the part p1 of its speed at the floor.
fn ball<'a>(p: [f64; 2], start: [f64; 2]) -> Problem<'a> {
    let floor = Event::new(|_, y| y[0]).falling().action(|jump| jump.y[1] *= -jump.p[1]);
    Problem::ode(fall_under(p), start).event(floor)
}

/// y0(T) + integral of y0^2 of the ball that falls and bounces, in closed form, by its parabolas.
fn mixed([g, e]: [f64; 2], [mut height, mut speed]: [f64; 2], end: f64) -> f64 {
    let (mut t, mut integral) = (0.0, 0.0);
    loop {
        let impact = (speed + (speed * speed + 2.0 * g * height).sqrt()) / g;
        let s = impact.min(end - t);
        // of (h + v s - g s^2 / 2)^2
        let terms = [
            height * height,
            height * speed,
            (speed * speed - g * height) / 3.0,
            -g * speed / 4.0,
            g * g / 20.0,
        ];
        integral += terms.iter().rev().fold(0.0, |sum, term| (sum + term) * s);
        height += speed * s - 0.5 * g * s * s;
        speed -= g * s;
        t += s;
        if t >= end {
            return height + integral;
        }
        (height, speed) = (0.0, -e * speed);
    }
}

/// All of a gradient.
fn all(gradient: &Gradient) -> Vec<f64> {
    [&gradient.parameters[..], &gradient.initial_state].concat()
}

/// The largest difference to derivatives of `value` by central differences, relative to 1 or to them.
fn off(gradient: &Gradient, at: &[f64], value: impl Fn(&[f64]) -> f64) -> f64 {
    let mut worst = (gradient.value - value(at)).abs() / gradient.value.abs().max(1.0);
    for (k, slope) in all(gradient).iter().enumerate() {
        let by = |d: f64| {
            let mut at = at.to_vec();
            at[k] += d;
            value(&at)
        };
        let d = 1e-4;
        let expected = (8.0 * (by(d) - by(-d)) - (by(2.0 * d) - by(-2.0 * d))) / (12.0 * d);
        worst = worst.max((slope - expected).abs() / expected.abs().max(1.0));
    }
    worst
}

/// After two impacts, against the closed form, whose differences of fourth order have 1e-11 left.
#[test]
fn a_bouncing_ball() {
    let (p, start, end) = ([9.81, 0.8], [10.0, 0.5], 4.2);
    for method in MULTISTEP {
        let found = gradient(ball(p, start), Mixed, method, (0.0, end), &tight(), &back()).unwrap();
        let error = off(&found, &[p, start].concat(), |x| mixed([x[0], x[1]], [x[2], x[3]], end));
        println!("{method:?}: {error:e}");
        assert!(error < 2e-8, "{method:?}: {error:e} {found:?}");
    }
}

/// The same ball as a DAE, with its acceleration as an algebraic unknown z, whose starting guess is wrong.
#[test]
fn a_bouncing_ball_as_a_dae() {
    let (p, start, end) = ([9.81, 0.8], [10.0, 0.5], 4.2);
    let fall = dae_with_parameters(
        |_t, y, yp, p, r| {
            r[0] = y[2] + p[0];
            r[1] = yp[0] - y[1];
            r[2] = 2.0 * (yp[1] - y[2]);
            Ok(())
        },
        p,
    );
    let floor = Event::new(|_, y| y[0]).falling().action(|jump| jump.y[1] *= -jump.p[1]);
    let problem = Problem::dae(fall, [start[0], start[1], 0.0], [0.0; 3])
        .differential([true, true, false])
        .event(floor);
    let mut found = gradient(problem, Mixed, Method::Ida, (0.0, end), &tight(), &back()).unwrap();
    assert_eq!(found.initial_state.pop(), Some(0.0), "of what follows from the others");
    let error = off(&found, &[p, start].concat(), |x| mixed([x[0], x[1]], [x[2], x[3]], end));
    println!("{error:e}");
    assert!(error < 2e-8, "{error:e} {found:?}");
}

/// y' = -z, 0 = z - p0 y, as a DAE and as an ODE with a singular mass matrix. When z has fallen to p1, the action adds z to y; from
/// t = 1.5 on z = 2 p0 y.
#[test]
fn events_and_actions_may_read_algebraic_unknowns() {
    let (p, start) = ([0.9, 0.4], [1.5]);
    let value = |x: &[f64]| {
        let (p0, p1, y0) = (x[0], x[1], x[2]);
        let integral =
            |y: f64, rate: f64, t: f64| y * y * (1.0 - (-2.0 * rate * t).exp()) / (2.0 * rate);
        let before = p1 / p0;
        let tau = (y0 / before).ln() / p0;
        let after = before + p1;
        let late = after * (-p0 * (1.5 - tau)).exp();
        integral(y0, p0, tau)
            + integral(after, p0, 1.5 - tau)
            + integral(late, 2.0 * p0, 0.3)
            + late * (-0.6 * p0).exp()
    };
    let along = |problem: Problem<'static>| {
        problem.breaks([1.5]).event(
            Event::with_parameters(|_, y, p| y[1] - p[1])
                .falling()
                .action(|jump| jump.y[0] += jump.y[1]),
        )
    };
    let factor = |t: f64| if t < 1.5 { 1.0 } else { 2.0 };
    let dae = dae_with_parameters(
        move |t, y, yp, p, r| {
            r[0] = yp[0] + y[1];
            r[1] = y[1] - factor(t) * p[0] * y[0];
            Ok(())
        },
        p,
    );
    let ode = with_parameters(
        move |t, y, p, f| {
            f[0] = -y[1];
            f[1] = y[1] - factor(t) * p[0] * y[0];
            Ok(())
        },
        p,
    );
    let dae = Problem::dae(dae, [start[0], 0.0], [0.0; 2]).differential([true, false]);
    let ode = Problem::ode(with_mass(ode, [1.0, 0.0]), [start[0], 0.0]);
    for problem in [dae, ode] {
        let problem = along(problem);
        let mut found =
            gradient(problem, Mixed, Method::Ida, (0.0, 1.8), &tight(), &back()).unwrap();
        found.initial_state.pop();
        let error = off(&found, &[&p[..], &start].concat(), value);
        println!("{error:e}");
        assert!(error < 2e-8, "{error:e} {found:?}");
    }
}

/// The time of the first impact, which ends the run, by gravity, height and speed.
#[test]
fn the_time_of_an_event() {
    let (p, start) = ([9.81, 0.8], [10.0, 0.5]);
    let value = |x: &[f64]| (x[3] + (x[3] * x[3] + 2.0 * x[0] * x[2]).sqrt()) / x[0];
    for method in MULTISTEP {
        let stop = Event::new(|_, y| y[0]).falling().terminal();
        let problem = Problem::ode(fall_under(p), start).event(stop);
        let found = gradient(problem, Time, method, (0.0, 9.0), &tight(), &back()).unwrap();
        let error = off(&found, &[p, start].concat(), value);
        println!("{method:?}: {error:e}");
        assert!(error < 1e-9, "{method:?}: {error:e} {found:?}");

        // at the second one, after the action, the integral counts, too, and the height is 0
        let second = Event::new(|_, y| y[0]).falling().terminal_after(2);
        let problem = ball(p, start).event(second);
        let found = gradient(problem, Mixed, method, (0.0, 9.0), &tight(), &back()).unwrap();
        let at_impact = |x: &[f64]| {
            let first = value(x);
            let speed = x[1] * (x[0] * first - x[3]);
            mixed([x[0], x[1]], [x[2], x[3]], first + 2.0 * speed / x[0])
        };
        let error = off(&found, &[p, start].concat(), at_impact);
        println!("{method:?}: {error:e}");
        assert!(error < 2e-8, "{method:?}: {error:e} {found:?}");
    }
}

/// y' = -p0 y; at t = 1 the state is raised by p1 y0^2 / 2, from t = 2 on the rate is p1.
#[test]
fn breaks() {
    let (p, start) = ([2.0, 0.5], [1.5]);
    let value = |x: &[f64]| {
        let (p0, p1, y0) = (x[0], x[1], x[2]);
        let integral = |y: f64, rate: f64| y * y * (1.0 - (-2.0 * rate).exp()) / (2.0 * rate);
        let first = y0 * (-p0).exp();
        let raised = first + 0.5 * p1 * first * first;
        let second = raised * (-p0).exp();
        integral(y0, p0) + integral(raised, p0) + integral(second, p1) + second * (-p1).exp()
    };
    for method in MULTISTEP {
        let decay = with_parameters(
            |t, y, p, ydot| {
                ydot[0] = -y[0] * if t < 2.0 { p[0] } else { p[1] };
                Ok(())
            },
            p,
        );
        let problem = Problem::ode(decay, start)
            .break_with(1.0, |jump| jump.y[0] += 0.5 * jump.p[1] * jump.y[0] * jump.y[0])
            .breaks([2.0]);
        let found = gradient(problem, Mixed, method, (0.0, 3.0), &tight(), &back()).unwrap();
        let error = off(&found, &[&p[..], &start].concat(), value);
        println!("{method:?}: {error:e}");
        assert!(error < 2e-8, "{method:?}: {error:e} {found:?}");
    }
}

/// y' = p0 - y rises to p1, where the action sets p0 to p0^2 - 1: the value at T = 3 by both parameters and y(0).
#[test]
fn actions_may_change_parameters() {
    let (p, start) = ([1.2, 0.8], [0.1]);
    let value = |x: &[f64]| {
        let (p0, p1, y0) = (x[0], x[1], x[2]);
        // of (p + c e^-t)^2 from 0 to t
        let integral = |p: f64, c: f64, t: f64| {
            p * p * t + 2.0 * p * c * (1.0 - (-t).exp()) + 0.5 * c * c * (1.0 - (-2.0 * t).exp())
        };
        let tau = ((p0 - y0) / (p0 - p1)).ln();
        let (late, rest) = (p0 * p0 - 1.0, 3.0 - tau);
        let end = late + (p1 - late) * (-rest).exp();
        integral(p0, y0 - p0, tau) + integral(late, p1 - late, rest) + end
    };
    for method in MULTISTEP {
        let mut heater = with_parameters(
            |_t, y, p, ydot| {
                ydot[0] = p[0] - y[0];
                Ok(())
            },
            p,
        );
        let switch = Event::with_parameters(|_, y, p| y[0] - p[1])
            .rising()
            .action(|jump| jump.p[0] = jump.p[0] * jump.p[0] - 1.0);
        let problem = Problem::ode(Borrowed(&mut heater), start).event(switch);
        let found = gradient(problem, Mixed, method, (0.0, 3.0), &tight(), &back()).unwrap();
        let error = off(&found, &[&p[..], &start].concat(), value);
        println!("{method:?}: {error:e}");
        assert!(error < 2e-8, "{method:?}: {error:e} {found:?}");
        assert_eq!(heater.parameters(), p, "as they were at the start");
    }
}

/// Backward in time, with as many events at one time as there are unknowns: an oscillator whose state is halved where it is 0.
#[test]
fn backward_in_time() {
    let (p, start) = ([2.0], [0.3, 0.4]);
    let value = |x: &[f64]| {
        // y = a sin(p t + phase) before t = -phase / p, and a quarter of it beyond
        let (p, phase) = (x[0], (x[0] * x[1] / x[2]).atan());
        let amplitude = x[1].hypot(x[2] / p);
        let square = |from: f64, to: f64| {
            let part = |t: f64| 0.5 * t - (2.0 * (p * t + phase)).sin() / (4.0 * p);
            part(to) - part(from)
        };
        let (at, end) = (-phase / p, -1.0);
        let rest = amplitude / 4.0;
        amplitude * amplitude * square(0.0, at)
            + rest * rest * square(at, end)
            + rest * (p * end + phase).sin()
    };
    for method in MULTISTEP {
        let oscillator = with_parameters(
            |_t, y, p, ydot| {
                ydot[0] = y[1];
                ydot[1] = -p[0] * p[0] * y[0];
                Ok(())
            },
            p,
        );
        let mut problem = Problem::ode(oscillator, start);
        for _ in 0..2 {
            problem = problem.event(Event::new(|_, y| y[0]).action(|jump| {
                jump.y.iter_mut().for_each(|y| *y *= 0.5);
            }));
        }
        let found = gradient(problem, Mixed, method, (0.0, -1.0), &tight(), &back()).unwrap();
        let error = off(&found, &[&p[..], &start].concat(), value);
        println!("{method:?}: {error:e}");
        assert!(error < 2e-8, "{method:?}: {error:e} {found:?}");
    }
}

#[test]
fn what_has_no_gradient_is_refused() {
    let (p, start) = ([9.81, 0.8], [10.0, 0.5]);
    let refused = |problem, method, options: &Options| match gradient(
        problem,
        Mixed,
        method,
        (0.0, 4.0),
        options,
        &back(),
    ) {
        Err(Reason::Input(error)) => error.to_string(),
        other => panic!("{other:?}"),
    };
    let text = refused(ball(p, start), Method::DormandPrince, &tight());
    assert!(text.contains("takes Bdf or Adams"), "{text}");
    let sensitivities = tight().sensitivities(Sensitivities::of([0]));
    let text = refused(ball(p, start), Method::Bdf, &sensitivities);
    assert!(text.contains("sensitivities"), "{text}");
    let krylov = tight().linear_solver(LinearSolver::Krylov(Krylov::new(KrylovMethod::Gmres {
        dimension: 5,
        restarts: 0,
    })));
    let text = refused(ball(p, start), Method::Bdf, &krylov);
    assert!(text.contains("entries of the Jacobian"), "{text}");
    // the top of the flight is touched, and no crossing of it
    let top = Event::new(|_, y| y[0] - 10.0).touching(1e-3).action(|jump| jump.y[1] = -1.0);
    let problem = ball(p, [10.0 - 0.5 * 9.81 * 0.25, 0.5 * 9.81]).event(top);
    let text = refused(problem, Method::Bdf, &tight());
    assert!(text.contains("only touches zero"), "{text}");
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
    let text = refused(problem, Method::Ida, &tight());
    assert!(text.contains("not yp"), "{text}");
}

/// y0^2 p0 at the end, or its integral, whose slopes are off by the factor `by_y` or `by_p`.
struct Wrong {
    at_end: bool,
    by_y: f64,
    by_p: f64,
}

impl Wrong {
    fn value(&self, y: &[f64], p: &[f64], slopes: Option<Slopes<'_>>) -> f64 {
        if let Some(slopes) = slopes {
            slopes.y[0] = self.by_y * 2.0 * y[0] * p[0];
            slopes.p[0] = self.by_p * y[0] * y[0];
        }
        y[0] * y[0] * p[0]
    }
}

impl Functional for Wrong {
    fn running(
        &mut self,
        _t: f64,
        y: &[f64],
        p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        Ok(if self.at_end { 0.0 } else { self.value(y, p, slopes) })
    }

    fn terminal(
        &mut self,
        _t: f64,
        y: &[f64],
        p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        Ok(if self.at_end { self.value(y, p, slopes) } else { 0.0 })
    }
}

/// Wrong slopes of a functional are refused with their place and both values; by an ODE and by a DAE.
#[test]
fn wrong_slopes_of_a_functional_are_found() {
    let p = [9.81, 0.8];
    let dae = || {
        let fall = dae_with_parameters(
            |_t, y, yp, p, r| {
                r[0] = yp[0] - y[1];
                r[1] = yp[1] + p[0];
                Ok(())
            },
            p,
        );
        Problem::dae(fall, [10.0, 0.5], [0.5, -p[0]]).differential([true, true])
    };
    let ode = || ball(p, [10.0, 0.5]);
    let problems: [(&dyn Fn() -> Problem<'static>, Method); 2] =
        [(&ode, Method::Bdf), (&dae, Method::Ida)];
    for (problem, method) in problems {
        for at_end in [false, true] {
            let find = |by_y: f64, by_p: f64| {
                let functional = Wrong { at_end, by_y, by_p };
                gradient(problem(), functional, method, (0.0, 1.0), &tight(), &back())
            };
            find(1.0, 1.0).unwrap();
            let name = if at_end { "terminal" } else { "running" };
            for (by_y, by_p, place) in [(1.5, 1.0, "y[0]"), (1.0, -1.0, "p[0]"), (0.0, 1.0, "y[0]")]
            {
                let error = find(by_y, by_p).unwrap_err();
                let source = std::error::Error::source(&error);
                let text = source.map_or(error.to_string(), ToString::to_string);
                let expected = format!("{name} of the functional is wrong: its slope by {place}");
                assert!(text.contains(&expected), "{method:?} {text}");
            }
        }
    }
}
