//! Orders, tolerances, dense output.

use super::*;

#[test]
fn the_order_of_the_solution_is_five() {
    let error = |h: f64| {
        let mut solver = DormandPrince::new(logistic, 0.0, &[0.1], &fixed_step(h)).unwrap();
        (at(&mut solver, 2.0)[0] - logistic_exact(2.0)).abs()
    };
    // Observed order between successive halvings; 0.2 is what higher terms leave at these h.
    for h in [0.125, 0.0625] {
        let order = (error(h) / error(h / 2.0)).log2();
        assert!((order - 5.0).abs() < 0.2, "order {order} at h = {h}");
    }
}

#[test]
fn the_order_of_dense_output_is_four_and_of_its_derivative_three() {
    // Largest error within one step from exact data: O(h^5) for order 4. Hermite interpolation
    // without the last term of the extension would show 4.
    let errors = |h: f64| {
        let t0 = 0.7;
        let start = [logistic_exact(t0)];
        let mut solver = DormandPrince::new(logistic, t0, &start, &fixed_step(h)).unwrap();
        solver.step(f64::MAX).unwrap();
        scattered(50).fold((0.0_f64, 0.0_f64), |(in_y, in_slope), theta| {
            let t = t0 + theta * h;
            let (mut y, mut slope) = ([0.0], [0.0]);
            solver.interpolate(t, 0, &mut y).unwrap();
            solver.interpolate(t, 1, &mut slope).unwrap();
            let exact = logistic_exact(t);
            let exact_slope = exact * (1.0 - exact);
            (in_y.max((y[0] - exact).abs()), in_slope.max((slope[0] - exact_slope).abs()))
        })
    };
    for h in [0.4, 0.2] {
        let (coarse, fine) = (errors(h), errors(h / 2.0));
        let (order, slope_order) = ((coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2());
        assert!((order - 5.0).abs() < 0.4, "order {order} at h = {h}");
        assert!((slope_order - 4.0).abs() < 0.4, "order of the slope {slope_order} at h = {h}");
    }
}

#[test]
fn dense_output_meets_both_ends_of_the_step() {
    let mut solver = DormandPrince::new(pendulum, 0.0, &[0.0, 0.0], &Options::default()).unwrap();
    let mut before = (0.0, [0.0; 2]);
    for _ in 0..5 {
        before = (solver.t(), [solver.y()[0], solver.y()[1]]);
        solver.step(f64::MAX).unwrap();
    }
    let after = (solver.t(), [solver.y()[0], solver.y()[1]]);
    for (t, y) in [before, after] {
        let (mut value, mut slope, mut f) = ([0.0; 2], [0.0; 2], [0.0; 2]);
        solver.interpolate(t, 0, &mut value).unwrap();
        solver.interpolate(t, 1, &mut slope).unwrap();
        pendulum(t, &y, &mut f).unwrap();
        // Same numbers up to the rounding of h = t_new - t_old.
        for i in 0..2 {
            assert!((value[i] - y[i]).abs() < 1e-14, "{value:?} {y:?}");
            assert!((slope[i] - f[i]).abs() < 1e-12, "{slope:?} {f:?}");
        }
    }
}

#[test]
fn the_pendulum_returns_after_its_exact_period() {
    let options = Options::new(1e-12, 1e-13);
    let mut solver = DormandPrince::new(pendulum, 0.0, &[0.0, 0.0], &options).unwrap();
    for period in 1..=5 {
        let t = 2.0 * f64::from(period);
        let angle = at(&mut solver, t)[0];
        // The turning point: the angle is flat in t there, the velocity is not.
        assert!(angle.abs() < 1e-10, "angle {angle} at t = {t}");
        let velocity = at(&mut solver, t)[1];
        assert!(velocity.abs() < 1e-9, "velocity {velocity} at t = {t}");
    }
    // Half a period: the other turning point, at -pi.
    solver.reinit(0.0, &[0.0, 0.0]).unwrap();
    let angle = at(&mut solver, 1.0)[0];
    assert!((angle + std::f64::consts::PI).abs() < 1e-10, "angle {angle}");
}

#[test]
fn the_error_shrinks_with_the_tolerance() {
    let error = |rtol: f64| {
        let options = Options::new(rtol, rtol);
        let mut solver = DormandPrince::new(pendulum, 0.0, &[0.0, 0.0], &options).unwrap();
        let y = at(&mut solver, 4.0);
        y[0].abs().max(y[1].abs())
    };
    let errors: Vec<f64> = [1e-4, 1e-6, 1e-8, 1e-10].map(error).into();
    for pair in errors.windows(2) {
        // Proportional to rtol, within a factor 5 either way.
        let ratio = pair[0] / pair[1];
        assert!((20.0..500.0).contains(&ratio), "errors {errors:?}");
    }
    // The global error stays within the local tolerance times the growth of errors over two
    // periods, a few hundred for this pendulum.
    assert!(errors[3] < 500.0 * 1e-10, "errors {errors:?}");
}

#[test]
fn the_relative_tolerance_follows_the_solution() {
    let decay = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot[0] = -y[0];
        Ok(())
    };
    let options = Options::new(1e-6, 1e-30);
    let mut solver = DormandPrince::new(decay, 0.0, &[1.0], &options).unwrap();
    for t in [1.0, 10.0, 30.0] {
        let relative = at(&mut solver, t)[0] / (-t).exp() - 1.0;
        // Every step adds at most rtol, and there are four of them in a unit of time.
        assert!(relative.abs() < 4.0 * t * 1e-6, "{relative} at t = {t}");
    }
    // The start is where it was, and so are the steps that lead from it.
    let steps = solver.statistics().steps;
    solver.reinit(0.0, &[1.0]).unwrap();
    solver.solve_to(30.0).unwrap();
    assert_eq!(solver.statistics().steps, steps);
}

#[test]
fn each_component_has_its_absolute_tolerance() {
    // Copies of one equation in units 1 and 1e6: with atol in the same units the error norm (a mean,
    // not a sum), and so every step, is the same as for one copy.
    let copies = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        for (slope, value) in ydot.iter_mut().zip(y) {
            *slope = -value;
        }
        Ok(())
    };
    let run = |y: &[f64], atol: AbsoluteTolerance| {
        let options = Options::new(1e-14, atol);
        let mut solver = DormandPrince::new(copies, 0.0, y, &options).unwrap();
        solver.solve_to(3.0).unwrap();
        solver.statistics().steps
    };
    let same = run(&[1.0], AbsoluteTolerance::Scalar(1e-8));
    assert_eq!(run(&[1.0; 7], AbsoluteTolerance::Scalar(1e-8)), same);
    assert_eq!(run(&[1.0, 1e6], vec![1e-8, 1e-2].into()), same);
    assert!(run(&[1.0, 1e6], vec![1e-8, 1e-8].into()) > 3 * same);
}

#[test]
fn the_first_step_knows_the_time_scale() {
    let first_step = |rate: f64| {
        let decay = move |_t: f64, y: &[f64], ydot: &mut [f64]| {
            ydot[0] = -rate * y[0];
            Ok(())
        };
        let mut solver = DormandPrince::new(decay, 0.0, &[1.0], &Options::default()).unwrap();
        solver.step(f64::MAX).unwrap();
        assert_eq!(solver.statistics().error_test_failures, 0);
        rate * solver.t()
    };
    let reference = first_step(1.0);
    // The error estimate for y' = -y is about z^5/1000 at step z: rtol 1e-6 allows z = 0.25. The
    // first guess is meant to be cautious, but not by more than a factor of ten.
    assert!((0.025..0.25).contains(&reference), "{reference}");
    for rate in [1e-9, 1e-3, 1e3, 1e9, 1e15] {
        let scaled = first_step(rate);
        assert!((scaled / reference - 1.0).abs() < 1e-13, "{scaled} {reference}");
    }
}
