//! What goes wrong is repaired by shorter steps, or told.

use pliant::integrate::{Callback, Cause, IntegrationError};
use pliant::rosenbrock::Error;

use super::*;

fn stopped<T: std::fmt::Debug>(result: Result<T, Error>) -> IntegrationError {
    match result {
        Err(Error::Integration(error)) => *error,
        other => panic!("{other:?}"),
    }
}

/// y' = -1000 sqrt(y) has no meaning below 0, where long steps lead.
#[test]
fn refused_points_shorten_the_step() {
    for order in ORDERS {
        let root = |_t: f64, y: &[f64], ydot: &mut [f64]| -> Rhs {
            if y[0] < 0.0 {
                return Err(Failure::Recoverable("below 0".into()));
            }
            ydot[0] = -2.0 * y[0].sqrt();
            Ok(())
        };
        let options = Options::new(1e-6, 1e-9).order(order).initial_step(5.0);
        let mut solver = Rosenbrock::new(root, 0.0, &[1.0], &options).unwrap();
        solver.solve_to(0.9).unwrap();
        assert!(solver.statistics().refused_steps > 0);
        // y = (1 - t)^2
        assert!((solver.y()[0] - 0.01).abs() < 1e-5, "{}", solver.y()[0]);
        // beyond t = 1 there is none
        let error = stopped(solver.solve_to(2.0));
        // in a stage, or where the Jacobian asks for it
        let Cause::Rejected { callback: Callback::Rhs | Callback::Jacobian, .. } = error.cause
        else {
            panic!("{error}")
        };
        assert!((error.t - 1.0).abs() < 1e-3, "{error}");
        assert_eq!(error.order, order);
    }
}

#[test]
fn fatal_failures_are_handed_on_and_numbers_that_are_none_named() {
    for order in ORDERS {
        let broken = |t: f64, _y: &[f64], ydot: &mut [f64]| -> Rhs {
            ydot[0] = 1.0;
            if t > 0.5 { Err(std::io::Error::other("gone").into()) } else { Ok(()) }
        };
        let options = Options::default().order(order);
        let mut solver = Rosenbrock::new(broken, 0.0, &[0.0], &options).unwrap();
        let error = stopped(solver.solve_to(1.0));
        assert_eq!(error.cause, Cause::Fatal(Callback::Rhs));
        assert_eq!(error.source.unwrap().to_string(), "gone");
        assert!((solver.y()[0] - solver.t()).abs() < 1e-14);

        let no_number = |t: f64, _y: &[f64], ydot: &mut [f64]| -> Rhs {
            ydot.copy_from_slice(&[1.0, if t > 0.5 { f64::NAN } else { 1.0 }]);
            Ok(())
        };
        let mut solver = Rosenbrock::new(no_number, 0.0, &[0.0, 0.0], &options).unwrap();
        let error = stopped(solver.solve_to(1.0));
        assert!(matches!(error.cause, Cause::NotFinite { component: 1, .. }), "{error}");
    }
}

#[test]
fn input_is_checked() {
    let start = |options: &Options, y: &[f64]| Rosenbrock::new(logistic, 0.0, y, options).err();
    let kept = |order, steps| Options::default().order(order).max_steps_between_jacobians(steps);
    let options = [Options::new(1e-15, 1e-9), Options::new(1e-6, 0.0), Options::default().order(5)];
    for options in options.into_iter().chain([kept(4, 2), kept(3, 0)]) {
        assert!(matches!(start(&options, &[0.1]), Some(Error::Input(_))), "{options:?}");
    }
    assert!(matches!(start(&Options::default(), &[f64::NAN]), Some(Error::Input(_))));
    let mut solver = Rosenbrock::new(logistic, 0.0, &[0.1], &Options::default()).unwrap();
    solver.solve_to(1.0).unwrap();
    assert!(matches!(solver.solve_to(-1.0), Err(Error::Input(_))));
    assert!(solver.reinit(0.0, &[0.1, 0.2]).is_err());
}

#[test]
fn too_many_steps_can_be_gone_on_with() {
    let options = Options::new(1e-8, 1e-10).max_steps(3);
    let mut solver = Rosenbrock::new(logistic, 0.0, &[0.1], &options).unwrap();
    let error = stopped(solver.solve_to(2.0));
    assert!(matches!(error.cause, Cause::TooManySteps { steps: 3, .. }), "{error}");
    while solver.solve_to(2.0).is_err() {}
    assert!((solver.y()[0] - logistic_exact(2.0)).abs() < 1e-7);
}
