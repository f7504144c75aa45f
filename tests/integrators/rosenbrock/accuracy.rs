//! Orders, stiffness, trusted digits.

use pliant::samples::VanDerPol;

use super::*;

/// The order that halving the step shows.
fn measured(coarse: f64, fine: f64) -> f64 {
    (coarse / fine).log2()
}

/// With errors of 1e-7 to 1e-9, well above rounding. An order is right to 0.25; dense output has the order of the
/// method, too, as its error of one step is not handed on.
#[test]
fn errors_fall_by_the_order() {
    for order in ORDERS {
        let run = |h| errors(oscillator, &[0.0, 0.0], &fixed_step(order, h), oscillator_exact);
        let (coarse, fine) = (run(0.02), run(0.01));
        for (coarse, fine) in coarse.into_iter().zip(fine) {
            let found = measured(coarse, fine);
            assert!(
                (found - f64::from(order)).abs() < 0.25,
                "{order}: {coarse:e} {fine:e} {found}"
            );
        }
        let run = |h| {
            let options = fixed_step(order, h).newton(LinearSolver::Custom);
            errors(Logistic::with(1.0), &[0.1], &options, logistic_exact)
        };
        let (coarse, fine) = (run(0.1), run(0.05));
        for (coarse, fine) in coarse.into_iter().zip(fine) {
            let found = measured(coarse, fine);
            assert!((found - f64::from(order)).abs() < 0.4, "{order}: {coarse:e} {fine:e} {found}");
        }
    }
}

/// With 1.3 times the Jacobian for a matrix ROS34PW2 keeps its order and RODASP2 falls to order 2.
#[test]
fn a_matrix_that_is_not_the_jacobian() {
    for (order, kept, h) in [(3, 3.0, 0.02), (4, 2.0, 0.004)] {
        let run = |h| {
            let options = fixed_step(order, h).newton(LinearSolver::Custom);
            errors(Logistic::with(1.3), &[0.1], &options, logistic_exact)[0]
        };
        let found = measured(run(h), run(0.5 * h));
        assert!((found - kept).abs() < 0.25, "{order}: {found}");
    }
}

/// One matrix for a tenth of the time, in steps that end at given times, where each time the integration is resumed: the
/// order stays.
#[test]
fn one_matrix_for_many_steps() {
    let run = |steps: u32| {
        let h = 2.0 / f64::from(steps);
        let options = fixed_step(3, h).max_steps_between_jacobians(steps / 10);
        let mut solver = Rosenbrock::new(logistic, 0.0, &[0.1], &options).unwrap();
        let mut error: f64 = 0.0;
        for step in 1..=steps {
            let t = f64::from(step) * h;
            solver.set_stop_time(Some(t)).unwrap();
            solver.solve_to(t).unwrap();
            let y = solver.y().to_vec();
            error = error.max((y[0] - logistic_exact(t)).abs());
            assert!(solver.resume(t, &y).unwrap());
        }
        let counts = solver.statistics();
        assert_eq!((counts.steps, counts.linear_setups), (steps.into(), 10));
        error
    };
    let (coarse, fine) = (run(100), run(200));
    let found = measured(coarse, fine);
    assert!((found - 3.0).abs() < 0.25, "{coarse:e} {fine:e} {found}");
}

/// y' = -lambda (y - cos t) - sin t with y = cos t (A. Prothero, A. Robinson, Math. Comp. 28 (1974) 145-162): at h lambda far above
/// 1 the order is reduced.
#[test]
fn stiff_forcing_reduces_the_order() {
    let stiff = |t: f64, y: &[f64], ydot: &mut [f64]| -> Rhs {
        ydot[0] = -1e6 * (y[0] - t.cos()) - t.sin();
        Ok(())
    };
    for order in ORDERS {
        let run = |h| errors(stiff, &[1.0], &fixed_step(order, h), f64::cos)[0];
        let (coarse, fine) = (run(0.2), run(0.1));
        let found = measured(coarse, fine);
        println!("{order}: {coarse:e} {fine:e} {found}");
        assert!(found > 1.5, "{order}: {found}");
        assert!(fine < 1e-6, "{order}: {fine:e}");
    }
}

/// One step with h lambda = 1e10 leaves nothing of a motion that is not on the slow path.
#[test]
fn fast_motions_are_damped_at_once() {
    for order in ORDERS {
        let decay = |_t: f64, y: &[f64], ydot: &mut [f64]| -> Rhs {
            ydot[0] = -1e10 * y[0];
            Ok(())
        };
        let mut solver = Rosenbrock::new(decay, 0.0, &[1.0], &fixed_step(order, 1.0)).unwrap();
        let _ = solver.step(1.0).unwrap();
        assert_eq!(solver.last_step(), (0.0, 1.0));
        assert!(solver.y()[0].abs() < 1e-6, "{order}: {:e}", solver.y()[0]);
    }
}

/// Van der Pol's oscillator, mu = 1000, against digits of quadruple precision; supplied Jacobians and differences give
/// the same.
#[test]
fn van_der_pol() {
    for order in ORDERS {
        for jacobian in [Jacobian::Supplied, Jacobian::DifferenceQuotients] {
            let options =
                Options::new(1e-7, 1e-10).order(order).newton(LinearSolver::Dense(jacobian));
            let problem = VanDerPol::new();
            let mut solver = Rosenbrock::new(problem, 0.0, &VanDerPol::Y0, &options).unwrap();
            solver.solve_to(2000.0).unwrap();
            let error = (solver.y()[0] / 1.706_167_732_170_465 - 1.0).abs();
            println!("{order} {jacobian:?}: {error:e} {:?}", solver.statistics());
            assert!(error < 1e-5, "{order} {jacobian:?}: {error:e}");
        }
    }
}
