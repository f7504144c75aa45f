//! Integrals beside the solution.

use pliant::{
    ode::{Dae, Failure, Ode},
    solve::{Event, Method, Options, Output, Problem, Run, solve},
    sundials::Sensitivities,
};

use crate::support::{G, fall, tight};

/// A ball, with the integral of its velocity, which is what it has risen: whatever happens at impacts.
struct Ball;

impl Ode for Ball {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        fall(t, y, ydot)
    }

    fn quadrature_count(&self) -> usize {
        2
    }

    fn quadratures(&mut self, _t: f64, y: &[f64], qdot: &mut [f64]) -> Result<(), Failure> {
        qdot.copy_from_slice(&[y[1], y[1].abs()]);
        Ok(())
    }
}

fn ball<'a>() -> Problem<'a> {
    let floor = Event::new(|_, y| y[0]).falling().action(|jump| jump.y[1] *= -0.8);
    Problem::ode(Ball, [10.0, 0.0]).event(floor).break_with(2.0, |jump| jump.y[1] += 1.0)
}

/// Across impacts and a break, at the ends of steps and at times between.
#[test]
fn integrals_go_on_across_jumps() {
    let times: Vec<f64> = (1..=20).map(|k| 0.2 * f64::from(k)).collect();
    for method in [Method::Bdf, Method::Adams] {
        for options in [tight(), tight().output(Output::Times(times.clone()))] {
            let solution = solve(ball(), method, (0.0, 4.0), &options).unwrap();
            assert!(solution.events().len() > 1);
            for k in 0..solution.t().len() {
                let error = (solution.quadratures(k)[0] - (solution.y(k)[0] - 10.0)).abs();
                // 1e-10 of a way of 30 m, and what the heights at the impacts are off
                assert!(error < 2e-8, "{method:?} at {}: {error:e}", solution.t()[k]);
            }
        }
    }
}

/// Up and down: the way to the second impact is the height of the start and twice that of the flight between.
#[test]
fn the_way_of_a_ball() {
    let floor = Event::new(|_, y| y[0]).falling().action(|jump| jump.y[1] *= -0.8);
    let second = Event::new(|_, y| y[0]).falling().terminal_after(2);
    let problem = Problem::ode(Ball, [10.0, 0.0]).event(floor).event(second);
    let solution = solve(problem, Method::Bdf, (0.0, 9.0), &tight()).unwrap();
    let way = solution.quadratures(solution.t().len() - 1)[1];
    assert!((way - (10.0 + 2.0 * 6.4)).abs() < 1e-6, "{way}");
    assert!((solution.t().last().unwrap() - 2.6 * (20.0 / G).sqrt()).abs() < 1e-8);
}

#[test]
fn a_run_that_is_taken_up_has_its_integrals() {
    let mut run = Run::new(ball(), Method::Bdf, (0.0, 4.0), &tight()).unwrap();
    while run.t() < 3.0 {
        run.advance().unwrap();
    }
    let saved = run.save();
    let problem = ball().resume(saved.clone());
    let solution = solve(problem, Method::Bdf, (saved.t, 4.0), &tight()).unwrap();
    let last = solution.t().len() - 1;
    assert_eq!(solution.quadratures(0), saved.quadratures);
    assert!((solution.quadratures(last)[0] - (solution.last()[0] - 10.0)).abs() < 2e-8);

    let mut short = saved.clone();
    short.quadratures.pop();
    let text = Run::new(ball().resume(short), Method::Bdf, (saved.t, 4.0), &tight())
        .unwrap_err()
        .to_string();
    assert!(text.contains("quadratures"), "{text}");
}

#[test]
fn methods_without_integrals_say_so() {
    let text = solve(ball(), Method::DormandPrince, (0.0, 4.0), &Options::new(1e-6, 1e-8))
        .unwrap_err()
        .to_string();
    assert!(text.contains("integrals") && text.contains("take Bdf, Adams or Ida"), "{text}");
}

/// A ball under the gravity p0 that keeps the part p1 of its speed at impacts, with the integrals of its velocity, which is
/// what it has risen, and of its height; as a DAE with its acceleration as an algebraic unknown.
struct Bouncing([f64; 2]);

impl Ode for Bouncing {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot.copy_from_slice(&[y[1], -self.0[0]]);
        Ok(())
    }

    fn quadrature_count(&self) -> usize {
        2
    }

    fn quadratures(&mut self, _t: f64, y: &[f64], qdot: &mut [f64]) -> Result<(), Failure> {
        qdot.copy_from_slice(&[y[1], y[0]]);
        Ok(())
    }

    fn parameters(&self) -> &[f64] {
        &self.0
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.0.copy_from_slice(values);
    }
}

impl Dae for Bouncing {
    fn residual(&mut self, _t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        r.copy_from_slice(&[yp[0] - y[1], yp[1] - y[2], y[2] + self.0[0]]);
        Ok(())
    }

    fn quadrature_count(&self) -> usize {
        2
    }

    fn quadratures(
        &mut self,
        _t: f64,
        y: &[f64],
        _yp: &[f64],
        qdot: &mut [f64],
    ) -> Result<(), Failure> {
        qdot.copy_from_slice(&[y[1], y[0]]);
        Ok(())
    }

    fn parameters(&self) -> &[f64] {
        Ode::parameters(self)
    }

    fn set_parameters(&mut self, values: &[f64]) {
        Ode::set_parameters(self, values);
    }
}

const BOUNCING: [f64; 2] = [9.81, 0.8];

/// The same from 10 m: as an ODE, or as a DAE.
fn bouncing<'a>(is_dae: bool) -> Problem<'a> {
    let floor = Event::new(|_, y| y[0]).falling().action(|jump| jump.y[1] *= -jump.p[1]);
    let ball = Bouncing(BOUNCING);
    match is_dae {
        false => Problem::ode(ball, [10.0, 0.0]),
        true => Problem::dae(ball, [10.0, 0.0, 0.0], [0.0; 3]).differential([true, true, false]),
    }
    .event(floor)
}

/// The integral of the height up to time t, after two impacts, in closed form.
fn under_the_path(t: f64, [g, e]: [f64; 2]) -> f64 {
    let first = (20.0 / g).sqrt();
    let speed = e * g * first;
    let second = first + 2.0 * speed / g;
    assert!(second < t);
    // of a flight from the ground with this speed
    let flight = |speed: f64, t: f64| speed * t * t / 2.0 - g * t.powi(3) / 6.0;
    10.0 * first - g * first.powi(3) / 6.0
        + flight(speed, 2.0 * speed / g)
        + flight(e * speed, t - second)
}

/// Across two impacts, whose times depend on both parameters: those of the integral of the velocity are those of the height,
/// and those of the integral of the height are differences of its closed form.
#[test]
fn sensitivities_of_integrals_follow_jumps() {
    let wanted = || tight().sensitivities(Sensitivities::of([0, 1]).integrals());
    let times: Vec<f64> = (1..=21).map(|k| 0.2 * f64::from(k)).collect();
    for (is_dae, method) in [(false, Method::Bdf), (false, Method::Adams), (true, Method::Ida)] {
        for options in [wanted(), wanted().output(Output::Times(times.clone()))] {
            let solution = solve(bouncing(is_dae), method, (0.0, 4.2), &options).unwrap();
            assert_eq!(solution.events().len(), 2);
            let mut worst = 0.0;
            for k in 0..solution.t().len() {
                let (s, q) = (solution.sensitivities(k), solution.quadrature_sensitivities(k));
                assert_eq!((q.nrows(), q.ncols()), (2, 2));
                worst = (0..2).map(|j| (q[(0, j)] - s[(0, j)]).abs()).fold(worst, f64::max);
            }
            let q = solution.quadrature_sensitivities(solution.t().len() - 1);
            for k in 0..2 {
                let by = |d: f64| {
                    let mut p = BOUNCING;
                    p[k] += d;
                    under_the_path(4.2, p)
                };
                let expected = (by(1e-5) - by(-1e-5)) / 2e-5;
                worst = worst.max((q[(1, k)] - expected).abs());
            }
            println!("{method:?}: {worst:e}");
            // of numbers up to 20; the state at the impacts has 1e-9
            assert!(worst < 5e-8, "{method:?}: {worst:e}");
        }
    }
}

/// y = e^(-p t) with the integral of 1 above y = 1/2 and of 3 below, a switch of the integrand alone, which is an event without
/// an action: its derivative is -2 times that of the time ln 2/p.
#[test]
fn a_switch_of_the_integrand_is_followed() {
    struct Switching([f64; 1]);
    impl Ode for Switching {
        fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
            ydot[0] = -self.0[0] * y[0];
            Ok(())
        }
        fn quadrature_count(&self) -> usize {
            1
        }
        fn quadratures(&mut self, _t: f64, y: &[f64], qdot: &mut [f64]) -> Result<(), Failure> {
            qdot[0] = if y[0] > 0.5 { 1.0 } else { 3.0 };
            Ok(())
        }
        fn parameters(&self) -> &[f64] {
            &self.0
        }
        fn set_parameters(&mut self, values: &[f64]) {
            self.0.copy_from_slice(values);
        }
    }
    let p = 0.7;
    let problem = Problem::ode(Switching([p]), [1.0]).event(Event::new(|_, y| y[0] - 0.5));
    let options = tight().sensitivities(Sensitivities::of([0]).integrals());
    let solution = solve(problem, Method::Bdf, (0.0, 2.0), &options).unwrap();
    let last = solution.t().len() - 1;
    let time = 2f64.ln() / p;
    let errors = [
        solution.quadratures(last)[0] - (time + 3.0 * (2.0 - time)),
        solution.quadrature_sensitivities(last)[(0, 0)] - 2.0 * time / p,
    ];
    println!("{errors:?}");
    assert!(errors.iter().all(|error| error.abs() < 3e-9), "{errors:?}");
}

#[test]
fn a_run_that_is_taken_up_has_the_sensitivities_of_its_integrals() {
    let options = tight().sensitivities(Sensitivities::of([0, 1]).integrals());
    let whole = solve(bouncing(false), Method::Bdf, (0.0, 4.2), &options).unwrap();
    let mut run = Run::new(bouncing(false), Method::Bdf, (0.0, 4.2), &options).unwrap();
    run.advance_to(2.0).unwrap();
    let saved = run.save();
    assert_eq!(saved.quadrature_sensitivities[0], run.quadrature_sensitivities()[(0, 0)]);
    run.advance_to(4.2).unwrap();
    let straight = run.quadrature_sensitivities().to_owned();
    run.restore(&saved).unwrap();
    run.advance_to(4.2).unwrap();
    let resumed = bouncing(false).resume(saved.clone());
    let resumed = solve(resumed, Method::Bdf, (2.0, 4.2), &options).unwrap();
    let expected = whole.quadrature_sensitivities(whole.t().len() - 1);
    for found in [
        straight.as_ref(),
        run.quadrature_sensitivities(),
        resumed.quadrature_sensitivities(resumed.t().len() - 1),
    ] {
        assert!((found - expected).norm_max() < 5e-8, "{found:?} {expected:?}");
    }
    let mut short = saved;
    short.quadrature_sensitivities.pop();
    let text = run.restore(&short).unwrap_err().to_string();
    assert!(text.contains("sensitivities of integrals"), "{text}");
}
