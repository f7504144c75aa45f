//! Backward runs of DAEs by Krylov methods and products of the system.

use std::error::Error as _;

use pliant::{
    ode::{Dae, Failure},
    sundials::{
        AdjointOptions, DaeAdjoint, Error, Gradient, IdaOptions, Jacobian, Krylov, KrylovMethod,
        LinearSolver, Pattern, Preconditioner, Side,
    },
};

use super::{
    By, LINEAR, OF_MIXED, OfMixed, closed_form, difference, mixed, numbers, square_and_more,
};

/// GMRES, preconditioned by an incomplete factorization on this pattern, if there is one.
fn gmres(dimension: u32, pattern: Option<&Pattern>) -> LinearSolver {
    let method = KrylovMethod::Gmres { dimension, restarts: 2 };
    let krylov = Krylov::new(method).tolerance_factor(1e-3);
    let jacobian = Jacobian::DifferenceQuotients;
    LinearSolver::Krylov(match pattern {
        Some(pattern) => {
            let ilu = Preconditioner::Ilu { pattern: pattern.clone(), jacobian };
            krylov.preconditioner(Side::Left, ilu)
        }
        None => krylov,
    })
}

#[test]
fn a_linear_dae_in_closed_form() {
    let full = Pattern::from_entries(2, [(0, 1), (1, 0)]).unwrap();
    let back = || AdjointOptions::new(1e-9, 1e-11).supplied_rhs();
    for (solver, back) in [
        (gmres(2, None), back()),
        (gmres(2, Some(&full)), back()),
        (gmres(2, None), back().supplied_parameters()),
        (LinearSolver::Dense(Jacobian::DifferenceQuotients), back().supplied_parameters()),
    ] {
        let forward =
            IdaOptions::new(1e-9, 1e-11).newton(solver.clone()).differential([true, false]);
        let (y0, yp0) = ([1.5, 0.0], [0.0; 2]);
        let made = DaeAdjoint::new(LINEAR, square_and_more(), 0.0, &y0, &yp0, &forward, &back);
        let gradient = made.unwrap().gradient(1.2).unwrap();
        let error = difference(&gradient, &closed_form(LINEAR.p, 1.2));
        println!("{error:e}");
        assert!(error < 1e-7, "{solver:?} {gradient:?}");
    }
}

/// The products of equations, written by hand.
struct WithProducts<R, T> {
    residual: R,
    transposed: T,
    p: [f64; 3],
}

impl<R, T> Dae for WithProducts<R, T>
where
    R: FnMut(f64, &[f64], &[f64], &[f64], &mut [f64]) -> Result<(), Failure>,
    T: FnMut(&[f64], &[f64], [&[f64]; 2], &mut [f64]),
{
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        (self.residual)(t, y, yp, &self.p, r)
    }

    fn adjoint_residual(
        &mut self,
        _t: f64,
        y: &[f64],
        _yp: &[f64],
        lambda: &[f64],
        mu: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        (self.transposed)(y, &self.p, [lambda, mu], out);
        Ok(())
    }

    fn parameters(&self) -> &[f64] {
        &self.p
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.p.copy_from_slice(values);
    }
}

/// Rows in any order and parameters in dF/dy': as by matrices.
#[test]
fn equations_in_any_order_have_the_gradient_of_matrices() {
    let transposed = |y: &[f64], p: &[f64], [l, m]: [&[f64]; 2], out: &mut [f64]| {
        out[0] = -l[1] + l[2] + y[2] * l[3];
        out[1] = p[1] * l[1] - p[2] * y[1].cos() * l[2] + 2.0 * m[1] + m[3];
        out[2] = -(1.0 + 0.9 * y[2] * y[2]) * l[0] - l[2] + y[0] * l[3];
        out[3] = l[0] + l[3] + p[0] * m[1] + 3.0 * m[3];
    };
    let gradient = |solver: LinearSolver, back: AdjointOptions| -> Gradient {
        let forward =
            IdaOptions::new(1e-9, 1e-11).newton(solver).differential([false, true, false, true]);
        let system = WithProducts { residual: mixed, transposed, p: OF_MIXED };
        let (y0, yp0) = ([0.0, 1.2, 0.0, -0.8], [0.0; 4]);
        let made = DaeAdjoint::new(system, OfMixed, 0.0, &y0, &yp0, &forward, &back);
        made.unwrap().gradient(2.0).unwrap()
    };
    let back = AdjointOptions::new(1e-9, 1e-11);
    let exact = gradient(LinearSolver::Dense(Jacobian::DifferenceQuotients), back.clone());
    let found = gradient(gmres(4, None), back.supplied_rhs());
    let error = difference(&found, &numbers(&exact));
    println!("{error:e}");
    assert!(error < 5e-8, "{found:?} {exact:?}");
}

/// Products that are wrong by a sign, in dF/dy or in dF/dy', are refused with the variable.
#[test]
fn wrong_products_are_found() {
    let residual = |_t: f64, y: &[f64], yp: &[f64], p: &[f64], r: &mut [f64]| {
        (r[0], r[1]) = (yp[0] + p[0] * y[1], y[1] - y[0]);
        Ok(())
    };
    let refusal = |signs: [f64; 2]| {
        let transposed = move |_y: &[f64], p: &[f64], [l, m]: [&[f64]; 2], out: &mut [f64]| {
            (out[0], out[1]) = (signs[1] * m[0] - l[1], signs[0] * p[0] * l[0] + l[1]);
        };
        let system = WithProducts { residual, transposed, p: [2.0, 0.0, 0.0] };
        let forward =
            IdaOptions::new(1e-8, 1e-10).newton(gmres(2, None)).differential([true, false]);
        let back = AdjointOptions::new(1e-8, 1e-10).supplied_rhs();
        let (y0, yp0) = ([1.0, 1.0], [-2.0, -2.0]);
        let end = |y: &[f64], slopes: &mut [f64]| {
            slopes[0] = 1.0;
            y[0]
        };
        let functional = By(end, |_: &[f64], _: &mut [f64]| 0.0);
        let made = DaeAdjoint::new(system, functional, 0.0, &y0, &yp0, &forward, &back);
        made.unwrap().gradient(1.0).map_err(|error| error.source().unwrap().to_string())
    };
    assert!((refusal([1.0; 2]).unwrap().parameters[0] + (-2.0_f64).exp()).abs() < 1e-7);
    let by_state = refusal([-1.0, 1.0]).unwrap_err();
    assert!(by_state.contains("adjoint_residual is wrong: its slope by y[1]"), "{by_state}");
    let by_slope = refusal([1.0, -1.0]).unwrap_err();
    assert!(by_slope.contains("adjoint_residual is wrong: its slope by y'[0]"), "{by_slope}");
}

/// A nonlinear rod whose rates are unknowns of their own, of 60 unknowns: as by a sparse matrix.
#[test]
fn a_rod_has_the_gradient_of_a_sparse_matrix() {
    const N: usize = 30;
    let residual = |_t: f64, y: &[f64], yp: &[f64], p: &[f64], r: &mut [f64]| {
        for i in 0..N {
            let at = |i: Option<usize>| i.filter(|i| *i < N).map_or(0.0, |i| y[2 * i]);
            let (left, here, right) = (at(i.checked_sub(1)), y[2 * i], at(Some(i + 1)));
            let rate = p[0] * (left - 2.0 * here + right) - p[1] * here.powi(3) + p[2];
            (r[2 * i], r[2 * i + 1]) = (y[2 * i + 1] - rate, yp[2 * i] - y[2 * i + 1]);
        }
        Ok(())
    };
    let transposed = |y: &[f64], p: &[f64], [l, m]: [&[f64]; 2], out: &mut [f64]| {
        for i in 0..N {
            let at = |i: Option<usize>| i.filter(|i| *i < N).map_or(0.0, |i| l[2 * i]);
            let here = y[2 * i];
            out[2 * i] = (2.0 * p[0] + 3.0 * p[1] * here * here) * l[2 * i] + m[2 * i + 1]
                - p[0] * (at(i.checked_sub(1)) + at(Some(i + 1)));
            out[2 * i + 1] = l[2 * i] - l[2 * i + 1];
        }
    };
    let mean_square = |y: &[f64], slopes: &mut [f64]| {
        (0..N).for_each(|i| slopes[2 * i] = 2.0 * y[2 * i] / N as f64);
        (0..N).map(|i| y[2 * i] * y[2 * i]).sum::<f64>() / N as f64
    };
    let entries = (0..N).flat_map(|i| {
        let next = (i + 1).min(N - 1);
        [(2 * i, 2 * next), (2 * next, 2 * i), (2 * i, 2 * i + 1), (2 * i + 1, 2 * i)]
    });
    let pattern = Pattern::from_entries(2 * N, entries).unwrap();
    let differential: Vec<bool> = (0..2 * N).map(|i| i % 2 == 0).collect();
    let p = [200.0, 3.0, 0.5];
    let mut y0: Vec<f64> =
        (0..2 * N).map(|i| if i % 2 == 0 { (i as f64 * 0.15).sin() } else { 0.0 }).collect();
    let (mut rates, mut yp0) = (vec![0.0; 2 * N], vec![0.0; 2 * N]);
    residual(0.0, &y0, &yp0, &p, &mut rates).unwrap();
    for i in 0..N {
        (y0[2 * i + 1], yp0[2 * i]) = (-rates[2 * i], -rates[2 * i]);
    }
    let gradient = |solver: LinearSolver, back: AdjointOptions| -> Gradient {
        let forward =
            IdaOptions::new(1e-8, 1e-10).newton(solver).differential(differential.clone());
        let system = WithProducts { residual, transposed, p };
        let functional = By(mean_square, mean_square);
        let made = DaeAdjoint::new(system, functional, 0.0, &y0, &yp0, &forward, &back);
        made.unwrap().gradient(0.1).unwrap()
    };
    let back = AdjointOptions::new(1e-7, 1e-9);
    let jacobian = Jacobian::DifferenceQuotients;
    let klu = LinearSolver::Klu { pattern: pattern.clone(), jacobian };
    let exact = gradient(klu, back.clone());
    let found = gradient(gmres(60, Some(&pattern)), back.supplied_rhs());
    let error = difference(&found, &numbers(&exact));
    println!("{error:e}");
    assert!(error < 1e-6, "{found:?} {exact:?}");
}

#[test]
fn unusable_equations_are_named() {
    let back = AdjointOptions::new(1e-6, 1e-8).supplied_rhs();
    let (y0, yp0) = ([1.5, 0.0], [0.0; 2]);
    let made = |differential: [bool; 2]| {
        let forward = IdaOptions::new(1e-6, 1e-8).newton(gmres(2, None)).differential(differential);
        DaeAdjoint::new(LINEAR, square_and_more(), 0.0, &y0, &yp0, &forward, &back)
    };
    let refused = |differential| match made(differential) {
        Err(Error::Input(error)) => error.to_string(),
        other => panic!("{other:?}"),
    };
    assert!(refused([true, true]).contains("1 are without derivatives"));
    assert!(refused([false, true]).contains("its derivative occurs"));
    // dF/dy' that changes with the state
    let residual = |_t: f64, y: &[f64], yp: &[f64], _: &[f64], r: &mut [f64]| {
        r[0] = (1.0 + 1e-3 * y[0]) * yp[0] + y[0];
        Ok(())
    };
    let transposed = |y: &[f64], _: &[f64], [l, m]: [&[f64]; 2], out: &mut [f64]| {
        out[0] = l[0] + (1.0 + 1e-3 * y[0]) * m[0];
    };
    let system = WithProducts { residual, transposed, p: [0.0; 3] };
    let functional = By(
        |y: &[f64], slopes: &mut [f64]| {
            slopes[0] = 1.0;
            y[0]
        },
        |_: &[f64], _: &mut [f64]| 0.0,
    );
    let forward = IdaOptions::new(1e-6, 1e-8).newton(gmres(1, None)).differential([true]);
    let made = DaeAdjoint::new(system, functional, 0.0, &[1.0], &[-1.0], &forward, &back);
    match made.unwrap().gradient(1.0) {
        Err(Error::Integration(error)) => {
            assert!(error.source.unwrap().to_string().contains("dF/dy' of equation 0"));
        }
        other => panic!("{other:?}"),
    }
}
