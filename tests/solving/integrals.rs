//! Integrals beside the solution.

use pliant::{
    ode::{Failure, Ode},
    solve::{Event, Method, Options, Output, Problem, Run, solve},
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
