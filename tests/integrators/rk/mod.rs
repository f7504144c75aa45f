//! The explicit Runge-Kutta integrator against closed forms, published values and its own promises.

use std::error::Error as _;

use pliant::integrate::{AbsoluteTolerance, Callback, Cause, IntegrationError};
use pliant::ode::{Failure, Ode};
use pliant::rk::{DormandPrince, Error, Integrator, Options, Reached};

mod accuracy;
mod failures;
mod steps;

type Rhs = Result<(), Failure>;

/// y' = y (1 - y), y(0) = 1/10: y = 1 / (1 + 9 exp(-t)).
fn logistic(_t: f64, y: &[f64], ydot: &mut [f64]) -> Rhs {
    ydot[0] = y[0] * (1.0 - y[0]);
    Ok(())
}

fn logistic_exact(t: f64) -> f64 {
    1.0 / (1.0 + 9.0 * (-t).exp())
}

/// Pendulum of length 1 by its angle from the horizontal. From rest at angle 0 it swings over pi
/// and back in exactly 2 with this gravity.
fn pendulum(_t: f64, y: &[f64], ydot: &mut [f64]) -> Rhs {
    let gravity = 13.750371636040746; // rounded from 13.750371636040745654980191559621
    ydot[0] = y[1];
    ydot[1] = -gravity * y[0].cos();
    Ok(())
}

/// y' = -lambda (y - cos t), y(0) = 0: smooth and slow after 1/lambda, stiff when lambda is large
/// (E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", (IV.1.1)).
fn prothero(lambda: f64) -> impl FnMut(f64, &[f64], &mut [f64]) -> Rhs {
    move |t, y, ydot| {
        ydot[0] = -lambda * (y[0] - t.cos());
        Ok(())
    }
}

fn prothero_exact(lambda: f64, t: f64) -> f64 {
    let scale = lambda / (lambda * lambda + 1.0);
    scale * (lambda * t.cos() + t.sin() - lambda * (-lambda * t).exp())
}

/// Steps of size h whatever the error.
fn fixed_step(h: f64) -> Options {
    Options::new(0.5, 1e6).initial_step(h).max_step(h)
}

/// The error of an integration that stopped.
fn stopped<T: std::fmt::Debug>(result: Result<T, Error>) -> IntegrationError {
    match result {
        Err(Error::Integration(error)) => *error,
        other => panic!("{other:?}"),
    }
}

/// A fixed sequence of numbers in (0, 1) that looks random.
fn scattered(count: u32) -> impl Iterator<Item = f64> {
    (1..=count).map(|k| (f64::from(k) * 0.618_033_988_749_895).fract())
}

/// The solution at time `t`.
fn at<S: Ode>(solver: &mut DormandPrince<S>, t: f64) -> &[f64] {
    solver.solve_to(t).unwrap();
    solver.y()
}
