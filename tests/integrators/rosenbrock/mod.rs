//! The Rosenbrock methods against closed forms, trusted digits and their own promises.

use pliant::ode::{Failure, Ode};
use pliant::rosenbrock::{Integrator, Options, Rosenbrock};
use pliant::sundials::{Jacobian, LinearSolver};

mod accuracy;
mod failures;
mod steps;

const ORDERS: [u32; 2] = [3, 4];

type Rhs = Result<(), Failure>;

/// y'' = -2 d w y' - w^2 (y - sin t), an oscillator of w = 2 and d = 0.3 whose spring is pulled at.
fn oscillator(t: f64, y: &[f64], ydot: &mut [f64]) -> Rhs {
    ydot[0] = y[1];
    ydot[1] = -1.2 * y[1] - 4.0 * (y[0] - t.sin());
    Ok(())
}

/// Its displacement from rest at 0. The forced part a cos t + b sin t takes -a + 1.2 b + 4 a = 0 and
/// -b - 1.2 a + 4 b = 4.
fn oscillator_exact(t: f64) -> f64 {
    let b = 4.0 / (3.0 + 0.48);
    let a = -0.4 * b;
    let rate = (4.0_f64 - 0.36).sqrt();
    let (p, q) = (-a, (-b - 0.6 * a) / rate);
    a * t.cos() + b * t.sin() + (-0.6 * t).exp() * (p * (rate * t).cos() + q * (rate * t).sin())
}

/// y' = y (1 - y), y(0) = 1/10: y = 1 / (1 + 9 exp(-t)).
fn logistic(_t: f64, y: &[f64], ydot: &mut [f64]) -> Rhs {
    ydot[0] = y[0] * (1.0 - y[0]);
    Ok(())
}

fn logistic_exact(t: f64) -> f64 {
    1.0 / (1.0 + 9.0 * (-t).exp())
}

/// The logistic equation with a matrix of its own, made of so many times the Jacobian.
struct Logistic {
    part: f64,
    divisor: f64,
}

impl Logistic {
    fn with(part: f64) -> Self {
        Self { part, divisor: 1.0 }
    }
}

impl Ode for Logistic {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Rhs {
        logistic(t, y, ydot)
    }

    fn newton_setup(
        &mut self,
        _t: f64,
        y: &[f64],
        _ydot: &[f64],
        gamma: f64,
        _reuse: bool,
    ) -> Result<bool, Failure> {
        self.divisor = 1.0 - gamma * self.part * (1.0 - 2.0 * y[0]);
        Ok(true)
    }

    fn newton_solve(&mut self, _gamma: f64, r: &mut [f64]) -> Rhs {
        r[0] /= self.divisor;
        Ok(())
    }
}

/// Steps of size h whatever the error.
fn fixed_step(order: u32, h: f64) -> Options {
    Options::new(0.5, 1e6).order(order).initial_step(h).max_step(h)
}

/// The largest error of component 0 at the ends of steps and in between, where dense output gives it, up to t = 2.
fn errors(system: impl Ode, y: &[f64], options: &Options, exact: fn(f64) -> f64) -> [f64; 2] {
    let mut solver = Rosenbrock::new(system, 0.0, y, options).unwrap();
    let (mut at_ends, mut between): (f64, f64) = (0.0, 0.0);
    let mut inside = vec![0.0; y.len()];
    while solver.t() < 2.0 - 1e-9 {
        let _ = solver.step(2.0).unwrap();
        at_ends = at_ends.max((solver.y()[0] - exact(solver.t())).abs());
        let (start, end) = solver.last_step();
        for theta in [0.2, 0.5, 0.8] {
            let t = start + theta * (end - start);
            solver.interpolate(t, 0, &mut inside).unwrap();
            between = between.max((inside[0] - exact(t)).abs());
        }
    }
    [at_ends, between]
}
