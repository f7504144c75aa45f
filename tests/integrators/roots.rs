//! Root functions: the explicit Runge-Kutta method stops where CVODE does, and where closed forms say.

use std::f64::consts::PI;

use pliant::ode::{Failure, Ode};
use pliant::rk::{self, DormandPrince};
use pliant::sundials::{Cvode, CvodeOptions, Integrator, Multistep, Reached};

/// y' = f(t, y) with root functions g(t, y).
struct System<F, G> {
    f: F,
    g: G,
    count: usize,
}

impl<F, G> Ode for System<F, G>
where
    F: FnMut(f64, &[f64], &mut [f64]),
    G: FnMut(f64, &[f64], &mut [f64]),
{
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        (self.f)(t, y, ydot);
        Ok(())
    }

    fn root_count(&self) -> usize {
        self.count
    }

    fn roots(&mut self, t: f64, y: &[f64], g: &mut [f64]) -> Result<(), Failure> {
        (self.g)(t, y, g);
        Ok(())
    }
}

/// Both integrators at the start.
fn both<S: Ode + Clone + 'static>(
    system: &S,
    y: &[f64],
    tolerance: f64,
) -> [Box<dyn Integrator<System = S>>; 2] {
    let ours = rk::Options::new(tolerance, tolerance).max_step(0.5);
    let theirs = CvodeOptions::new(tolerance, tolerance).method(Multistep::Adams).max_step(0.5);
    [
        Box::new(DormandPrince::new(system.clone(), 0.0, y, &ours).unwrap()),
        Box::new(Cvode::new(system.clone(), 0.0, y, &theirs).unwrap()),
    ]
}

impl<F: Clone, G: Clone> Clone for System<F, G> {
    fn clone(&self) -> Self {
        Self { f: self.f.clone(), g: self.g.clone(), count: self.count }
    }
}

const GRAVITY: f64 = 9.81;

fn ball() -> impl Ode + Clone {
    let f = |_t: f64, y: &[f64], ydot: &mut [f64]| (ydot[0], ydot[1]) = (y[1], -GRAVITY);
    System { f, g: |_t: f64, y: &[f64], g: &mut [f64]| g[0] = y[0], count: 1 }
}

/// A ball that keeps 0.8 of its speed at each impact: impact k is 2 v_k/g after the one before.
#[test]
fn a_ball_bounces_at_the_times_of_the_closed_form() {
    for (mut solver, tolerance) in both(&ball(), &[1.0, 0.0], 1e-10).into_iter().zip([1e-13, 2e-11])
    {
        let (mut impact, mut speed) = ((2.0 / GRAVITY).sqrt(), (2.0 * GRAVITY).sqrt());
        for k in 0..12 {
            assert_eq!(solver.solve_to(100.0).unwrap(), Reached::Root);
            let (t, y, roots) = (solver.t(), solver.y(), solver.roots_found());
            println!("impact {k}: {t} off by {:.1e}", t - impact);
            // rk integrates a parabola exactly, but for round-off; CVODE to its tolerance
            assert!((t - impact).abs() < tolerance && (y[1] + speed).abs() < 20.0 * tolerance);
            assert!(y[0].abs() < 20.0 * tolerance, "{y:?}");
            assert_eq!(roots, [-1]);
            // a start at a root: the ball leaves it, and that is no root
            speed *= 0.8;
            solver.reinit(t, &[0.0, speed]).unwrap();
            impact = t + 2.0 * speed / GRAVITY;
        }
    }
}

/// A pendulum let go at 2 rad passes its lowest point a quarter of the period 4 K(sin 1) later, and
/// every half of it from then on; a fifth of the way up, it passes in between.
#[test]
fn a_pendulum_passes_its_lowest_point_at_the_times_of_the_closed_form() {
    let pendulum = System {
        f: |_t: f64, y: &[f64], ydot: &mut [f64]| (ydot[0], ydot[1]) = (y[1], -y[0].sin()),
        g: |_t: f64, y: &[f64], g: &mut [f64]| g[0] = y[0],
        count: 1,
    };
    // arithmetic-geometric mean
    let (mut a, mut b) = (1.0_f64, 1.0_f64.cos());
    for _ in 0..8 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    let quarter = PI / (2.0 * a);
    for mut solver in both(&pendulum, &[2.0, 0.0], 1e-10) {
        for k in 0..20 {
            assert_eq!(solver.solve_to(1000.0).unwrap(), Reached::Root);
            let (t, roots) = (solver.t(), solver.roots_found());
            let off = t - f64::from(2 * k + 1) * quarter;
            println!("passage {k} off by {off:.1e}");
            // local errors of 1e-10 over 90 s, which grow with time squared
            assert!(off.abs() < 3e-7, "{k}: {off:e}");
            assert_eq!(roots, [if k % 2 == 0 { -1 } else { 1 }]);
        }
    }
}

/// Where an integration to t = 4 stops, and the signs of the roots there, by both integrators.
fn stops(g: fn(f64, &mut [f64]), count: usize) -> Vec<(f64, Vec<i32>)> {
    let f = |t: f64, _y: &[f64], ydot: &mut [f64]| ydot[0] = t.cos();
    let system = System { f, g: move |t: f64, _y: &[f64], out: &mut [f64]| g(t, out), count };
    let [ours, theirs] = both(&system, &[0.0], 1e-6).map(|mut solver| {
        let mut stops = Vec::new();
        while solver.solve_to(4.0).unwrap() == Reached::Root {
            let (t, roots) = (solver.t(), solver.roots_found());
            stops.push((t, roots.to_vec()));
        }
        assert_eq!(solver.t(), 4.0);
        stops
    });
    assert_eq!(ours.len(), theirs.len(), "{ours:?} {theirs:?}");
    for (ours, theirs) in ours.iter().zip(&theirs) {
        // both search to 100 times the round-off of t and h
        assert!((ours.0 - theirs.0).abs() < 2e-13 && ours.1 == theirs.1, "{ours:?} {theirs:?}");
    }
    ours
}

fn assert_stops(g: fn(f64, &mut [f64]), count: usize, expected: &[(f64, &[i32])]) {
    let found = stops(g, count);
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for ((t, signs), (exact, expected)) in found.iter().zip(expected) {
        assert!((t - exact).abs() < 2e-13 && signs == expected, "{found:?}");
    }
}

#[test]
fn roots_of_one_step_come_one_after_the_other() {
    let g = |t: f64, g: &mut [f64]| {
        (g[0], g[1], g[2]) = (t - 1.3, 1.25 - t, t - 1.3);
    };
    assert_stops(g, 3, &[(1.25, &[0, -1, 0]), (1.3, &[1, 0, 1])]);
    // two roots of one function, with a third between them; curved, so that secants mislead
    let g = |t: f64, g: &mut [f64]| {
        (g[0], g[1]) = ((t - 2.1).exp() - 1.0, (t - 2.0).powi(3) - 1e-3);
    };
    assert_stops(g, 2, &[(2.1, &[1, 1])]);
    let g = |t: f64, g: &mut [f64]| {
        (g[0], g[1]) = ((t - 2.1).powi(5), (3.0 * (t - 2.05)).sinh());
    };
    assert_stops(g, 2, &[(2.05, &[0, 1]), (2.1, &[1, 0])]);
}

#[test]
fn a_function_that_is_zero_at_the_start_is_no_root_there() {
    assert_stops(|t, g| g[0] = t, 1, &[]);
    assert_stops(|t, g| g[0] = t * (t - 1.7), 1, &[(1.7, &[1])]);
    // one that stays 0 is left out until it leaves it
    let g = |t: f64, g: &mut [f64]| g[0] = if t < 1.2 { 0.0 } else { (t - 1.2) * (2.4 - t) };
    assert_stops(g, 1, &[(2.4, &[-1])]);
}

#[test]
fn exact_zeros_count_where_steps_and_outputs_end() {
    assert_stops(|t, g| g[0] = 4.0 - t, 1, &[(4.0, &[-1])]);
    // no change of sign between the ends of steps
    assert_stops(|t, g| g[0] = (t - PI / 3.0).powi(2), 1, &[]);
    // the search meets the zero itself, and goes on from it
    let g = |t: f64, g: &mut [f64]| g[0] = if t == 4.0 { 0.0 } else { t - 4.5 };
    assert_stops(g, 1, &[(4.0, &[1])]);
}

#[test]
fn single_steps_stop_at_roots_and_go_on_to_the_end_of_the_step() {
    let options = rk::Options::new(1e-6, 1e-9).initial_step(0.5).max_step(0.5);
    let mut solver = DormandPrince::new(ball(), 0.0, &[1.0, 0.0], &options).unwrap();
    assert_eq!(solver.step(f64::MAX).unwrap(), Reached::Root);
    let (t, impact) = (solver.t(), (2.0 / GRAVITY).sqrt());
    assert!((t - impact).abs() < 1e-13, "{t}");
    assert_eq!(solver.last_step(), (0.0, 0.5));
    // left alone, the ball falls on
    assert_eq!(solver.step(f64::MAX).unwrap(), Reached::Time);
    assert_eq!((solver.t(), solver.statistics().steps), (0.5, 1));
    assert!((solver.y()[0] - (1.0 - 0.5 * GRAVITY * 0.25)).abs() < 1e-14);
    // at a stop time, too
    solver.reinit(0.0, &[1.0, 0.0]).unwrap();
    solver.set_stop_time(Some(0.5)).unwrap();
    assert_eq!(solver.solve_to(0.5).unwrap(), Reached::Root);
    assert_eq!(solver.solve_to(0.5).unwrap(), Reached::StopTime);
    assert!(solver.statistics().root_evaluations > 3);
}

#[test]
fn a_root_function_without_a_value_is_an_error() {
    let system = System {
        f: |_t: f64, _y: &[f64], ydot: &mut [f64]| ydot[0] = 1.0,
        g: |t: f64, _y: &[f64], g: &mut [f64]| (g[0], g[1]) = (1.0, (0.5 - t).sqrt()),
        count: 2,
    };
    let mut solver = DormandPrince::new(system, 0.0, &[0.0], &rk::Options::default()).unwrap();
    let message = solver.solve_to(1.0).unwrap_err().to_string();
    assert!(
        message.contains("the root functions returned NaN at t = ")
            && message.contains("in component 1"),
        "{message}"
    );
}
