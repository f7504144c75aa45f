//! Adjoints of steps, against differences of the steps.

use super::{StepAdjoint, Transposed};
use crate::integrators::common::{Error, Integrator};
use crate::integrators::ode::{Failure, Ode};
use crate::integrators::rosenbrock::{Options, Rosenbrock};
use crate::integrators::sundials::LinearSolver;

type Matrix = [[f64; 2]; 2];

const MASSES: Matrix = [[2.0, 0.5], [0.3, 1.0]];

/// Two stiff equations that are neither linear nor autonomous, with a parameter.
#[derive(Clone, Default)]
struct Pair {
    parameter: f64,
    value: [f64; 2],
    slope: Matrix,
    gamma: f64,
}

fn solve([[a, b], [c, d]]: Matrix, [x, y]: [f64; 2]) -> [f64; 2] {
    let determinant = a * d - b * c;
    [(d * x - b * y) / determinant, (a * y - c * x) / determinant]
}

fn transposed([[a, b], [c, d]]: Matrix) -> Matrix {
    [[a, c], [b, d]]
}

fn times(matrix: Matrix, x: &[f64]) -> [f64; 2] {
    matrix.map(|row| row[0] * x[0] + row[1] * x[1])
}

impl Pair {
    fn of(parameter: f64) -> Self {
        Self { parameter, ..Self::default() }
    }

    fn newton(&self) -> Matrix {
        let entry = |i: usize, j: usize| MASSES[i][j] - self.gamma * self.slope[i][j];
        [0, 1].map(|i| [0, 1].map(|j| entry(i, j)))
    }
}

impl Ode for Pair {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.evaluate_at(t, y)?;
        ydot.copy_from_slice(&solve(MASSES, self.value));
        Ok(())
    }

    fn newton_setup(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        gamma: f64,
        _reuse: bool,
    ) -> Result<bool, Failure> {
        self.gamma = gamma;
        self.linearize_at(t, y).map(|()| true)
    }

    fn newton_solve(&mut self, _gamma: f64, r: &mut [f64]) -> Result<(), Failure> {
        r.copy_from_slice(&solve(self.newton(), times(MASSES, r)));
        Ok(())
    }
}

impl Transposed for Pair {
    fn weights(&self) -> usize {
        2
    }

    fn is_linear(&self) -> bool {
        false
    }

    fn evaluate_at(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        let p = self.parameter;
        self.value = [
            -p * y[0] * y[0] * y[1] - 40.0 * y[0] + 30.0 * (3.0 * p * t).sin(),
            y[0] * y[1] * t.cos() - p * y[1].powi(3),
        ];
        Ok(())
    }

    fn weigh(&self, _y: &[f64], weights: &[f64]) -> f64 {
        weights[0] * self.value[0] + weights[1] * self.value[1]
    }

    fn linearize_at(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        let p = self.parameter;
        self.slope = [
            [-2.0 * p * y[0] * y[1] - 40.0, -p * y[0] * y[0]],
            [y[1] * t.cos(), y[0] * t.cos() - 3.0 * p * y[1] * y[1]],
        ];
        Ok(())
    }

    fn weigh_along(&mut self, weights: &[f64], x: &[f64]) -> f64 {
        let [a, b] = times(self.slope, x);
        weights[0] * a + weights[1] * b
    }

    fn add_transposed(&self, factor: f64, weights: &[f64], out: &mut [f64]) {
        let product = times(transposed(self.slope), weights);
        out.iter_mut().zip(product).for_each(|(out, x)| *out += factor * x);
    }

    fn solve_transposed(&mut self, r: &[f64], weights: &mut [f64]) {
        weights.copy_from_slice(&solve(transposed(self.newton()), [r[0], r[1]]));
    }

    fn vector_of(&self, weights: &[f64], z: &mut [f64]) {
        z.copy_from_slice(&times(transposed(MASSES), weights));
    }

    fn weights_of(&mut self, z: &[f64], weights: &mut [f64]) {
        weights.copy_from_slice(&solve(transposed(MASSES), [z[0], z[1]]));
    }
}

/// Ends of steps, as parts of the time that they take together.
const ENDS: [f64; 4] = [0.0, 0.2, 0.55, 1.0];

/// Start, end, parameter and initial values.
const NUMBERS: [f64; 5] = [10.1, 10.35, 0.8, 0.6, 1.4];

fn ends(start: f64, end: f64) -> [f64; 4] {
    ENDS.map(|part| start + part * (end - start))
}

fn integrator(parameter: f64, t: f64, order: u32) -> Result<Rosenbrock<Pair>, Error> {
    let options = Options::new(1e-3, 1e-3).order(order).newton(LinearSolver::Custom);
    Rosenbrock::new(Pair::of(parameter), t, &[0.0, 0.0], &options.prescribed())
}

/// The states at the ends of steps.
fn states(
    [start, end, parameter, first, second]: [f64; 5],
    order: u32,
) -> Result<Vec<[f64; 2]>, Error> {
    let mut integrator = integrator(parameter, start, order)?;
    let mut states = vec![[first, second]];
    for [from, to] in ends(start, end).array_windows() {
        take(&mut integrator, [*from, *to], states[states.len() - 1])?;
        states.push([integrator.y()[0], integrator.y()[1]]);
    }
    Ok(states)
}

fn take(integrator: &mut Rosenbrock<Pair>, [from, to]: [f64; 2], y: [f64; 2]) -> Result<(), Error> {
    integrator.reinit(from, &y)?;
    integrator.set_stop_time(Some(to))?;
    integrator.step(to)?;
    assert_eq!((integrator.statistics().steps, integrator.t()), (1, to));
    Ok(())
}

/// A number at the end by times, parameter and initial values: adjoints of steps, and central differences of the steps, extrapolated, differ by
/// 2e-9 of the largest at most (measured: 4e-10, the noise of df/dt, which steps find by a difference). Without the change of the Jacobian
/// it were 4e-5, without that in time 1e-5.
#[test]
fn steps_taken_back_have_the_derivative_of_the_steps() {
    let weights = [0.7, -1.3];
    for order in [3, 4] {
        let states_at = |numbers| states(numbers, order).unwrap();
        let number = |numbers: [f64; 5]| {
            let [a, b] = states_at(numbers)[3];
            weights[0] * a + weights[1] * b
        };
        let others = |at: usize, step: f64| {
            let mut numbers = NUMBERS;
            numbers[at] += step;
            numbers
        };
        let quotient = |at: usize, step: f64, of: &dyn Fn([f64; 5]) -> f64| {
            (of(others(at, step)) - of(others(at, -step))) / (2.0 * step)
        };
        let slope = |at: usize, of: &dyn Fn([f64; 5]) -> f64| {
            let [a, b, c] = [4e-3, 2e-3, 1e-3].map(|step| quotient(at, step, of));
            let [a, b] = [(4.0 * b - a) / 3.0, (4.0 * c - b) / 3.0];
            (16.0 * b - a) / 15.0
        };
        let exact = [0, 1, 2, 3, 4].map(|at| slope(at, &number));

        let [start, end, parameter, ..] = NUMBERS;
        let states = states_at(NUMBERS);
        let times = ends(start, end);
        let mut integrator = integrator(parameter, start, order).unwrap();
        let mut beside = Pair::of(parameter);
        let mut adjoint = StepAdjoint::new(&integrator);
        let mut lambda = weights;
        let mut by_others = [0.0; 3];
        for at in (0..3).rev() {
            take(&mut integrator, [times[at], times[at + 1]], states[at]).unwrap();
            adjoint.pull_back(&mut integrator, &mut beside, &mut lambda).unwrap();
            for (by, sum) in by_others.iter_mut().enumerate() {
                *sum += slope(by, &|[start, end, parameter, ..]| {
                    let times = ends(start, end);
                    let step = (times[at], times[at + 1] - times[at]);
                    let sum = |has_masses| {
                        let mut room = [Vec::new(), Vec::new()];
                        adjoint
                            .weigh(&mut Pair::of(parameter), step, has_masses, &mut room)
                            .unwrap()
                    };
                    assert!((sum(true) - sum(false)).abs() < 1e-14);
                    sum(true)
                });
            }
        }
        let found = [by_others[0], by_others[1], by_others[2], lambda[0], lambda[1]];
        let largest = exact.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        for (found, exact) in found.iter().zip(exact) {
            let off = (found - exact).abs() / largest;
            println!("order {order}: {found:e} {exact:e} {off:.1e}");
            assert!(off < 2e-9, "order {order}: {found:e} {exact:e}");
        }
    }
}
