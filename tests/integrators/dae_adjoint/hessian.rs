//! Products of Hessians with directions, against SUNDIALS' example, closed forms and differences of gradients.

use faer::MatMut;
use pliant::{
    ode::{Dae, Failure, dae_with_parameters},
    sundials::{AdjointOptions, DaeAdjoint, Error, IdaOptions, Jacobian, LinearSolver, Pattern},
};

use super::{By, OF_MIXED, OfMixed, difference, mixed};

/// `idasHessian_ASA_FSA` of SUNDIALS 6.4.1: the gradient and the Hessian of the integral of |y|^2/2 over 80 s by two rates of
/// Robertson's reactions, which its `.out` prints with five digits.
#[test]
fn the_hessian_of_the_example_of_idas() {
    let residual = |_t: f64, y: &[f64], yp: &[f64], p: &[f64], r: &mut [f64]| {
        let exchange = p[0] * y[0] - p[1] * y[1] * y[2];
        r[0] = yp[0] + exchange;
        r[1] = yp[1] - exchange + 3e7 * y[1] * y[1];
        r[2] = y[0] + y[1] + y[2] - 1.0;
        Ok(())
    };
    let functional = || {
        By(
            |_: &[f64], _: &mut [f64]| 0.0,
            |y: &[f64], slopes: &mut [f64]| {
                slopes.copy_from_slice(y);
                0.5 * y.iter().map(|y| y * y).sum::<f64>()
            },
        )
    };
    let jacobian = Jacobian::DifferenceQuotients;
    let entries = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
    let pattern = Pattern::from_entries(3, entries).unwrap();
    for solver in [
        LinearSolver::Dense(jacobian),
        LinearSolver::Band { lower: 2, upper: 2, jacobian },
        LinearSolver::Klu { pattern, jacobian },
    ] {
        let forward = IdaOptions::new(1e-8, 1e-10).newton(solver).differential([true, true, false]);
        let back = AdjointOptions::new(1e-8, 1e-8);
        let (y0, yp0) = ([1.0, 0.0, 0.0], [-0.04, 0.04, 0.0]);
        let system = dae_with_parameters(residual, [0.04, 1e4]);
        let made = DaeAdjoint::new(system, functional(), 0.0, &y0, &yp0, &forward, &back);
        let mut adjoint = made.unwrap();
        let far = |found: f64, printed: f64| (found / printed - 1.0).abs();
        assert!(far(adjoint.gradient(80.0).unwrap().value, 2.5042e1) < 2e-5);
        let printed = [
            ([1.0, 0.0], -1.3753e2, [4.4243e3, -2.7779e-3]),
            ([0.0, 1.0], 4.1552e-4, [-2.7779e-3, -2.4173e-8]),
        ];
        for (direction, slope, second) in printed {
            let found = adjoint.hessian_times(80.0, &direction).unwrap();
            println!("{found:?}");
            // half of the last digit that is printed
            assert!(far(found.value, slope) < 5e-5, "{} {slope}", found.value);
            for (found, printed) in found.parameters.iter().zip(second) {
                assert!(far(*found, printed) < 3e-5, "{found} {printed}");
            }
        }
        assert_eq!(adjoint.system().parameters(), [0.04, 1e4], "put back to the last bit");
    }
}

/// p2 y' = -p0 y + z, 0 = z - p1 y, whose first equation is the second row: y = y0 exp(-k t), k = (p0 - p1)/p2.
struct Decay([f64; 3]);

impl Dae for Decay {
    fn residual(&mut self, _t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        let [p0, p1, p2] = self.0;
        r.copy_from_slice(&[y[1] - p1 * y[0], p2 * yp[0] + p0 * y[0] - y[1]]);
        Ok(())
    }

    fn dense_jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        _y: &[f64],
        _yp: &[f64],
        mut jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        let [p0, p1, p2] = self.0;
        (jacobian[(0, 0)], jacobian[(0, 1)]) = (-p1, 1.0);
        (jacobian[(1, 0)], jacobian[(1, 1)]) = (p0 + cj * p2, -1.0);
        Ok(())
    }

    fn adjoint_parameters(
        &mut self,
        _t: f64,
        y: &[f64],
        yp: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        out.copy_from_slice(&[y[0] * lambda[1], -y[0] * lambda[0], yp[0] * lambda[1]]);
        Ok(())
    }

    fn parameters(&self) -> &[f64] {
        &self.0
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.0.copy_from_slice(values);
    }
}

/// z(T) = p1 y0 exp(-k T), with everything supplied by the system and with nothing.
#[test]
fn second_derivatives_of_a_decay_in_closed_form() {
    let (p, y0, t) = ([2.0, 0.5, 1.6], 1.5, 1.2);
    let k = (p[0] - p[1]) / p[2];
    let e = y0 * f64::exp(-k * t);
    let by_k = [1.0 / p[2], -1.0 / p[2], -k / p[2]];
    let twice = 1.0 / (p[2] * p[2]);
    let by_k_twice = [[0.0, 0.0, -twice], [0.0, 0.0, twice], [-twice, twice, 2.0 * k * twice]];
    let first = |i: usize| f64::from(u8::from(i == 1)) * e - p[1] * t * e * by_k[i];
    let second = |i: usize, j: usize| {
        let of_factor = [(i, j), (j, i)].map(|(i, j)| if i == 1 { by_k[j] } else { 0.0 });
        let of_exponent = t * t * by_k[i] * by_k[j] - t * by_k_twice[i][j];
        -t * e * (of_factor[0] + of_factor[1]) + p[1] * e * of_exponent
    };
    let functional = || {
        By(
            |y: &[f64], slopes: &mut [f64]| {
                slopes[1] = 1.0;
                y[1]
            },
            |_: &[f64], _: &mut [f64]| 0.0,
        )
    };
    for (jacobian, back) in [
        (Jacobian::DifferenceQuotients, AdjointOptions::new(1e-8, 1e-10)),
        (Jacobian::Supplied, AdjointOptions::new(1e-8, 1e-10).supplied_parameters()),
    ] {
        let forward = IdaOptions::new(1e-8, 1e-10)
            .newton(LinearSolver::Dense(jacobian))
            .differential([true, false]);
        let (start, slopes) = ([y0, 0.0], [0.0; 2]);
        let made = DaeAdjoint::new(Decay(p), functional(), 0.0, &start, &slopes, &forward, &back);
        let mut adjoint = made.unwrap();
        let gradient = adjoint.gradient(t).unwrap();
        let exact = [p[1] * e, first(0), first(1), first(2), p[1] * e / y0, 0.0];
        println!("{jacobian:?}: gradient {:e}", difference(&gradient, &exact));
        assert!(difference(&gradient, &exact) < 1e-7, "{gradient:?} {exact:?}");
        for direction in [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.3, -2.0, 0.7]] {
            let found = adjoint.hessian_times(t, &direction).unwrap();
            let sum = |of: &dyn Fn(usize) -> f64| (0..3).map(|j| of(j) * direction[j]).sum::<f64>();
            let slope = sum(&first);
            let [a, b, c] = [0, 1, 2].map(|i| sum(&|j| second(i, j)));
            let exact = [slope, a, b, c, slope / y0, 0.0];
            println!("{jacobian:?}: {:e}", difference(&found, &exact));
            assert!(difference(&found, &exact) < 5e-7, "{found:?} {exact:?}");
        }
        for (direction, says) in
            [(vec![], "length"), (vec![0.0; 3], "zero"), (vec![f64::NAN; 3], "direction")]
        {
            let error = adjoint.hessian_times(t, &direction).unwrap_err().to_string();
            assert!(error.contains(says), "{error}");
        }
    }
}

/// Nonlinear equations in any order with parameters in dF/dy', and a functional of parameters.
#[test]
fn products_are_differences_of_gradients() {
    let jacobian = Jacobian::DifferenceQuotients;
    let entries = [(0, 3), (1, 0), (1, 3), (2, 0), (2, 1), (3, 0), (3, 1), (3, 2), (0, 2)];
    let pattern = Pattern::from_entries(4, entries).unwrap();
    let new = |solver: LinearSolver, rtol: f64| {
        let forward = IdaOptions::new(rtol, 1e-2 * rtol)
            .newton(solver)
            .differential([false, true, false, true]);
        let system = dae_with_parameters(mixed, OF_MIXED);
        let back = AdjointOptions::new(rtol, 1e-2 * rtol);
        let (y0, yp0) = ([0.0, 1.2, 0.0, -0.8], [0.0; 4]);
        DaeAdjoint::new(system, OfMixed, 0.0, &y0, &yp0, &forward, &back).unwrap()
    };
    let direction = [0.5, -0.3, 1.0];
    let mut of_gradients = new(LinearSolver::Dense(jacobian), 1e-10);
    // differences of fourth order
    let h = 1e-2;
    let mut by = vec![0.0; 8];
    for (step, weight) in [(h, 8.0), (-h, -8.0), (2.0 * h, -1.0), (-2.0 * h, 1.0)] {
        let moved: Vec<f64> = OF_MIXED.iter().zip(direction).map(|(p, v)| p + step * v).collect();
        of_gradients.system_mut().set_parameters(&moved);
        let gradient = of_gradients.gradient(2.0).unwrap();
        let numbers = super::numbers(&gradient);
        by.iter_mut().zip(numbers).for_each(|(by, x)| *by += weight * x / (12.0 * h));
    }
    for solver in [LinearSolver::Dense(jacobian), LinearSolver::Klu { pattern, jacobian }] {
        let found = new(solver, 1e-8).hessian_times(2.0, &direction).unwrap();
        println!("{:e}", difference(&found, &by));
        assert!(difference(&found, &by) < 1e-6, "{found:?} {by:?}");
    }
}

#[test]
fn options_without_a_hessian_are_named() {
    let forward = IdaOptions::new(1e-6, 1e-8).differential([true, false]);
    let back = AdjointOptions::new(1e-6, 1e-8);
    let (y0, yp0) = ([1.0, 0.0], [0.0; 2]);
    let weighted = forward.clone().error_weights(|_, w| w.fill(1e6));
    let functional = By(|_: &[f64], _: &mut [f64]| 0.0, |_: &[f64], _: &mut [f64]| 0.0);
    let system = Decay([2.0, 0.5, 1.6]);
    let made = DaeAdjoint::new(system, functional, 0.0, &y0, &yp0, &weighted, &back);
    match made.unwrap().hessian_times(1.0, &[1.0, 0.0, 0.0]) {
        Err(Error::Input(error)) => assert!(error.to_string().contains("error_weights")),
        other => panic!("{other:?}"),
    }
}
