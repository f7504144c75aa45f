//! Stop times, interpolation, new starts, what a step costs.

use pliant::rosenbrock::Reached;

use super::*;

fn solver(order: u32) -> Rosenbrock<impl Ode> {
    let options = Options::new(1e-6, 1e-9).order(order);
    Rosenbrock::new(oscillator, 0.0, &[0.0, 0.0], &options).unwrap()
}

#[test]
fn stop_times_are_hit_and_hold_once() {
    for order in ORDERS {
        let mut solver = solver(order);
        solver.set_stop_time(Some(0.7)).unwrap();
        assert_eq!(solver.solve_to(2.0).unwrap(), Reached::StopTime);
        assert_eq!(solver.t(), 0.7);
        assert_eq!(solver.solve_to(2.0).unwrap(), Reached::Time);
        assert_eq!(solver.t(), 2.0);
        assert!((solver.y()[0] - oscillator_exact(2.0)).abs() < 1e-5);
        assert!(solver.set_stop_time(Some(0.5)).is_err());
    }
}

/// Output within steps changes none of them; both ends of the dense output are the states there, and its derivative is that of
/// a difference.
#[test]
fn interpolation() {
    for order in ORDERS {
        let (mut often, mut once) = (solver(order), solver(order));
        for k in 1..=100 {
            often.solve_to(0.02 * f64::from(k)).unwrap();
        }
        once.solve_to(2.0).unwrap();
        assert_eq!(often.y(), once.y());
        assert_eq!(often.statistics(), once.statistics());
        let (start, end) = once.last_step();
        let [mut a, mut b, mut slope] = [[0.0; 2]; 3];
        let (middle, d) = (0.5 * (start + end), 1e-5 * (end - start));
        once.interpolate(middle - d, 0, &mut a).unwrap();
        once.interpolate(middle + d, 0, &mut b).unwrap();
        once.interpolate(middle, 1, &mut slope).unwrap();
        let difference = (b[0] - a[0]) / (2.0 * d);
        assert!((difference - slope[0]).abs() < 1e-7, "{difference} {}", slope[0]);
        once.interpolate(start, 0, &mut a).unwrap();
        once.interpolate(start.next_up(), 0, &mut b).unwrap();
        assert!((a[0] - b[0]).abs() < 1e-12);
        for (t, derivative) in [(start - 0.1, 0), (end + 0.1, 0), (middle, 2)] {
            assert!(once.interpolate(t, derivative, &mut a).is_err());
        }
    }
}

#[test]
fn a_new_start_repeats_the_run_and_resuming_keeps_the_step() {
    for order in ORDERS {
        let mut solver = solver(order);
        solver.solve_to(2.0).unwrap();
        let (y, statistics) = (solver.y().to_vec(), solver.statistics());
        solver.reinit(0.0, &[0.0, 0.0]).unwrap();
        assert_eq!(solver.last_step(), (0.0, 0.0));
        solver.solve_to(2.0).unwrap();
        assert_eq!((solver.y(), solver.statistics()), (&y[..], statistics.clone()));
        let next = statistics.current_step;
        assert!(solver.resume(2.0, &y).unwrap());
        let _ = solver.step(10.0).unwrap();
        assert!((solver.last_step().1 - 2.0 - next).abs() < 1e-12);
    }
}

/// Of a system whose Jacobian never changes it is evaluated once, and factorized less often than steps are taken.
#[test]
fn constant_jacobians_are_kept() {
    for order in ORDERS {
        let options = Options::new(1e-6, 1e-9).order(order).linear();
        let mut solver = Rosenbrock::new(oscillator, 0.0, &[0.0, 0.0], &options).unwrap();
        solver.solve_to(20.0).unwrap();
        let counts = solver.statistics();
        assert_eq!(counts.jacobian_evaluations, 1);
        assert!(2 * counts.linear_setups < counts.steps, "{counts:?}");
        assert!((solver.y()[0] - oscillator_exact(20.0)).abs() < 1e-5);
    }
}

/// y' = -k (y - 1), where k is set from outside.
struct Pull {
    k: f64,
}

impl Ode for Pull {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Rhs {
        ydot[0] = -self.k * (y[0] - 1.0);
        Ok(())
    }
}

/// A matrix that serves many steps is renewed where it is no longer good enough: when k becomes 1e5 times as large, the step with
/// the old one fails, and is repeated at once.
#[test]
fn old_matrices_are_renewed_where_steps_fail() {
    let options =
        Options::new(1e-4, 1e-6).order(3).initial_step(0.1).max_steps_between_jacobians(50);
    let mut solver = Rosenbrock::new(Pull { k: 0.1 }, 0.0, &[0.0], &options).unwrap();
    for tick in 1..=20 {
        if tick == 11 {
            let counts = solver.statistics();
            assert_eq!((counts.linear_setups, counts.error_test_failures), (1, 0), "{counts:?}");
            solver.system_mut().k = 1e4;
        }
        let (start, y) = (solver.t(), solver.y().to_vec());
        assert!(solver.resume(start, &y).unwrap());
        let t = 0.1 * f64::from(tick);
        solver.set_stop_time(Some(t)).unwrap();
        solver.solve_to(t).unwrap();
    }
    let counts = solver.statistics();
    assert!(counts.error_test_failures > 0 && counts.linear_setups > 1, "{counts:?}");
    assert!((solver.y()[0] - 1.0).abs() < 1e-5, "{}", solver.y()[0]);
}

/// A step takes one factorization, an evaluation for each stage but the first, one for df/dt and one at its end, which is the first
/// of the next step. One that is repeated has its Jacobian and df/dt already, and no end.
#[test]
fn what_a_step_costs() {
    for (order, stages) in [(3, 4), (4, 6)] {
        let options = Options::new(1e-6, 1e-9).order(order).initial_step(1.0);
        let mut solver = Rosenbrock::new(oscillator, 0.0, &[0.0, 0.0], &options).unwrap();
        solver.solve_to(2.0).unwrap();
        let counts = solver.statistics();
        assert!(counts.error_test_failures > 0, "{counts:?}");
        let tried = counts.steps + counts.error_test_failures;
        assert_eq!(counts.linear_setups, tried);
        assert_eq!(counts.jacobian_evaluations, counts.steps);
        // one more to begin with: the first slope
        assert_eq!(counts.evaluations, tried * (stages - 1) + counts.steps + 1);
        // df/dt and two columns
        assert_eq!(counts.difference_quotient_evaluations, 3 * counts.steps);
    }
}

/// y'' = -y from y = 1, with a root function y.
struct Swing;

impl Ode for Swing {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Rhs {
        ydot.copy_from_slice(&[y[1], -y[0]]);
        Ok(())
    }

    fn root_count(&self) -> usize {
        1
    }

    fn roots(&mut self, _t: f64, y: &[f64], g: &mut [f64]) -> Rhs {
        g[0] = y[0];
        Ok(())
    }
}

/// cos t is zero at pi/2, 3 pi/2, ..., falling and rising in turns.
#[test]
fn roots_are_found_on_the_dense_output() {
    for (order, tolerance) in [(3, 1e-6), (4, 1e-7)] {
        let options = Options::new(1e-8, 1e-10).order(order);
        let mut solver = Rosenbrock::new(Swing, 0.0, &[1.0, 0.0], &options).unwrap();
        for k in 0..4 {
            assert_eq!(solver.solve_to(100.0).unwrap(), Reached::Root);
            let expected = (f64::from(k) + 0.5) * std::f64::consts::PI;
            let error = (solver.t() - expected).abs();
            assert!(error < tolerance, "{order}: {error:e}");
            assert_eq!(solver.roots_found(), [if k % 2 == 0 { -1 } else { 1 }]);
        }
    }
}
