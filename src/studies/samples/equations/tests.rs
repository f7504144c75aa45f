//! Jacobians against difference quotients.

use faer::Mat;

use super::*;

/// The dense Jacobian, the sparse one and central difference quotients agree at `y`.
fn check_ode(mut system: impl Ode, pattern: &Pattern, y: &[f64]) {
    let n = y.len();
    let (mut dense, mut values) = (Mat::zeros(n, n), vec![0.0; pattern.entry_count()]);
    system.dense_jacobian(0.0, y, &[], dense.as_mut()).unwrap();
    system.sparse_jacobian(0.0, y, &[], &mut values).unwrap();
    let rhs = |y: &[f64]| {
        let mut ydot = vec![0.0; n];
        system.rhs(0.0, y, &mut ydot).unwrap();
        ydot
    };
    check_columns(n, &dense, pattern, &values, rhs, |j, h| {
        let mut moved = y.to_vec();
        moved[j] += h * y[j].abs();
        (moved, 2.0 * h * y[j].abs())
    });
}

/// `shifted(j, h)` moves unknown j by h, and returns the distance between the moves by h and -h.
fn check_columns(
    n: usize,
    dense: &Mat<f64>,
    pattern: &Pattern,
    values: &[f64],
    mut function: impl FnMut(&[f64]) -> Vec<f64>,
    shifted: impl Fn(usize, f64) -> (Vec<f64>, f64),
) {
    for j in 0..n {
        let (forth, distance) = shifted(j, 1e-4);
        let (back, _) = shifted(j, -1e-4);
        let (forth, back) = (function(&forth), function(&back));
        for i in 0..n {
            // All right-hand sides are at most cubic: the truncation error is about 1e-8.
            let quotient = (forth[i] - back[i]) / distance;
            let error = (dense[(i, j)] - quotient).abs();
            assert!(error <= 1e-6 * (1.0 + quotient.abs()), "({i}, {j}): {quotient}");
            let sparse = pattern.position(i, j).map_or(0.0, |k| values[k]);
            assert_eq!(sparse, dense[(i, j)], "({i}, {j})");
        }
    }
}

#[test]
fn jacobians_are_derivatives() {
    let hires = Hires::new();
    let y = [0.7, 0.3, 0.2, 0.5, 0.9, 0.4, 0.1, 0.6];
    check_ode(hires.clone(), hires.pattern(), &y);
    let robertson = Robertson::new();
    check_ode(robertson.clone(), robertson.pattern(), &[0.7, 3e-2, 0.3]);
    let oscillator = VanDerPol::new();
    check_ode(oscillator.clone(), oscillator.pattern(), &[1.3, -0.7]);
    let oregonator = Oregonator::new();
    check_ode(oregonator.clone(), oregonator.pattern(), &[1.3, 0.7, 0.4]);
    let brusselator = Brusselator::new(4);
    let y = [1.3, 2.7, 0.4, 3.1, 0.8, 2.2, 1.9, 0.6];
    check_ode(brusselator.clone(), brusselator.pattern(), &y);
    let square = HeatedSquare::new(3);
    check_ode(square.clone(), square.pattern(), &[0.3, 0.1, 0.4, 0.2, 0.5, 0.9, 0.6, 0.8, 0.7]);
}

#[test]
fn jacobian_of_the_dae_is_a_derivative() {
    let (mut system, cj, y, n) = (Robertson::new(), 7.0, [0.7, 3e-2, 0.3], 3);
    let pattern = system.pattern().clone();
    let (mut dense, mut values) = (Mat::zeros(n, n), vec![0.0; pattern.entry_count()]);
    Dae::dense_jacobian(&mut system, 0.0, cj, &y, &[], dense.as_mut()).unwrap();
    Dae::sparse_jacobian(&mut system, 0.0, cj, &y, &[], &mut values).unwrap();
    // A move of y by d moves y' by cj d.
    let residual = |moved: &[f64]| {
        let yp: Vec<f64> = (0..n).map(|i| cj * (moved[i] - y[i])).collect();
        let mut residual = vec![0.0; n];
        system.residual(0.0, moved, &yp, &mut residual).unwrap();
        residual
    };
    check_columns(n, &dense, &pattern, &values, residual, |j, h| {
        let mut moved = y.to_vec();
        moved[j] += h * y[j];
        (moved, 2.0 * h * y[j])
    });
}

#[test]
fn references_satisfy_what_is_conserved() {
    let hires = Hires::REFERENCE.y;
    assert!((hires[6] + hires[7] - Hires::Y0[7]).abs() < 1e-15);
    for reference in [Robertson::REFERENCE, Robertson::LATE_REFERENCE] {
        assert!((reference.y.iter().sum::<f64>() - 1.0).abs() < 1e-14);
    }
}

/// The start of the amplifier, y + t y' near t = 0, satisfies M y' = f, and the sums of rows without
/// derivatives to first order.
#[test]
fn the_amplifier_starts_consistently() {
    let (y0, slope) = (TransistorAmplifier::Y0, TransistorAmplifier::YP0);
    let f = |t: f64| {
        let y: Vec<f64> = y0.iter().zip(slope).map(|(y, slope)| y + t * slope).collect();
        let mut f = [0.0; 8];
        TransistorAmplifier.rhs(t, &y, &mut f).unwrap();
        f
    };
    let mut mass = Mat::zeros(8, 8);
    TransistorAmplifier.dense_mass(0.0, mass.as_mut()).unwrap();
    for (i, f) in f(0.0).into_iter().enumerate() {
        let product: f64 = (0..8).map(|j| mass[(i, j)] * slope[j]).sum();
        assert!((product - f).abs() < 1e-18, "row {i}: {product} is not {f}");
    }
    let h = 1e-8;
    let (forth, back) = (f(h), f(-h));
    for i in [0, 3, 6] {
        assert_eq!(f(0.0)[i] + f(0.0)[i + 1], 0.0);
        // What is left is rounding, eps f / h, and cubic terms; those of the rates are of order 1e-2.
        let rate = ((forth[i] + forth[i + 1]) - (back[i] + back[i + 1])) / (2.0 * h);
        assert!(rate.abs() < 1e-10, "rows {i} and {}: {rate}", i + 1);
    }
}

/// The start of the car axis, y + t y' near t = 0, satisfies its equations, and those without derivatives to
/// first order.
#[test]
fn the_car_axis_starts_consistently() {
    let slope = CarAxis::YP0;
    let residual = |t: f64| {
        let y: Vec<f64> = CarAxis::Y0.iter().zip(slope).map(|(y, slope)| y + t * slope).collect();
        let mut residual = [0.0; 10];
        CarAxis { alpha: 3.0 }.residual(t, &y, &slope, &mut residual).unwrap();
        residual
    };
    assert_eq!(residual(0.0), [0.0; 10]);
    let h = 1e-6;
    let (forth, back) = (residual(h), residual(-h));
    for i in [8, 9] {
        // What is left is cubic; the rates of the terms are of order 100.
        let rate = (forth[i] - back[i]) / (2.0 * h);
        assert!(rate.abs() < 1e-8, "row {i}: {rate}");
    }
}
