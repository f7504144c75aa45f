//! IDA against trusted end states. The bounds are chosen as in `cvode.rs`.

use crate::support::OwnSolver;
use pliant::{
    ode::Dae,
    samples::{Pendulum, Robertson},
    sundials::{
        Cause, Error, Ida, IdaOptions, InitialCondition, Integrator, Jacobian, LinearSolver,
    },
};

fn robertson_error(system: impl Dae, rtol: f64, solver: LinearSolver) -> f64 {
    let options = IdaOptions::new(rtol, [1e-6 * rtol, 1e-11 * rtol, 1e-2 * rtol]).newton(solver);
    let mut solver = Ida::new(system, 0.0, &Robertson::Y0, &Robertson::YP0, &options).unwrap();
    solver.solve_to(Robertson::REFERENCE.t).unwrap();
    let error = Robertson::REFERENCE.error(solver.y());
    println!("rtol {rtol:e}: error {error:.2e}, {} steps", solver.statistics().steps);
    error
}

#[test]
fn robertson_by_every_linear_solver() {
    let klu = LinearSolver::Klu {
        pattern: Robertson::new().pattern().clone(),
        jacobian: Jacobian::Supplied,
    };
    let band = LinearSolver::Band { lower: 2, upper: 2, jacobian: Jacobian::DifferenceQuotients };
    for solver in [
        LinearSolver::Dense(Jacobian::Supplied),
        LinearSolver::Dense(Jacobian::DifferenceQuotients),
        band,
        klu,
    ] {
        let error = robertson_error(Robertson::new(), 1e-8, solver);
        assert!(error < 1e-5, "{error}");
    }
    let error = robertson_error(OwnSolver::new(Robertson::new(), 3), 1e-8, LinearSolver::Custom);
    assert!(error < 1e-5, "{error}");
}

#[test]
fn errors_shrink_with_rtol() {
    let errors = [1e-4, 1e-6, 1e-8].map(|rtol| {
        robertson_error(Robertson::new(), rtol, LinearSolver::Dense(Jacobian::Supplied))
    });
    assert!(errors[0] > errors[1] && errors[1] > errors[2], "{errors:?}");
    assert!(errors[2] < 1e-2 * errors[0], "{errors:?}");
}

#[test]
fn the_pendulum_keeps_its_period() {
    for (rtol, bound) in [(1e-6, 1e-2), (1e-9, 1e-5)] {
        let options = IdaOptions::new(rtol, rtol).differential(Pendulum::DIFFERENTIAL);
        let mut solver =
            Ida::new(Pendulum, 0.0, &Pendulum::DAE_Y0, &Pendulum::DAE_YP0, &options).unwrap();
        solver.solve_to(5.0 * Pendulum::PERIOD).unwrap();
        let error: f64 = solver.y()[..4]
            .iter()
            .zip(Pendulum::Y0)
            .map(|(y, y0)| (y - y0).abs())
            .fold(0.0, f64::max);
        println!("rtol {rtol:e}: error {error:.2e}, {} steps", solver.statistics().steps);
        assert!(error < bound, "{error}");
    }
}

#[test]
fn a_consistent_start_is_found() {
    let options = IdaOptions::new(1e-8, 1e-12).differential(Robertson::DIFFERENTIAL);
    let mut solver =
        Ida::new(Robertson::new(), 0.0, &[1.0, 0.0, 0.7], &[0.0; 3], &options).unwrap();
    solver.consistent_start(InitialCondition::Algebraic, 0.4).unwrap();
    assert!(solver.y()[2].abs() < 1e-13, "{:?}", solver.y());
    for (yp, expected) in solver.yp().iter().zip(Robertson::YP0).take(2) {
        assert!((yp - expected).abs() < 1e-13, "{:?}", solver.yp());
    }
}

#[test]
fn the_state_of_rest_is_found() {
    // y' = 2 - y at rest: y = 2, whatever was handed in.
    let system = |_t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
        r[0] = yp[0] + y[0] - 2.0;
        Ok(())
    };
    let mut solver = Ida::new(system, 0.0, &[5.0], &[0.0], &IdaOptions::new(1e-8, 1e-10)).unwrap();
    solver.consistent_start(InitialCondition::State, 1.0).unwrap();
    assert!((solver.y()[0] - 2.0).abs() < 1e-8);
}

/// 0 = x^2 - w^2 with x = 2, from near and far: from w = 1 Newton's method is there after four iterations, each of which needs a new Jacobian.
#[test]
fn starts_that_newtons_method_reaches_are_found() {
    let system = |_t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
        r[0] = yp[0] + y[0];
        r[1] = y[0] * y[0] - y[1] * y[1];
        Ok(())
    };
    for w in [0.01, 0.1, 0.5, 1.0, 1.5, 3.0, 100.0] {
        let options = IdaOptions::new(1e-6, 1e-9).differential([true, false]);
        let mut solver = Ida::new(system, 0.0, &[2.0, w], &[0.0; 2], &options).unwrap();
        solver.consistent_start(InitialCondition::Algebraic, 1.0).unwrap();
        // the last iteration of a method of order 2 leaves next to nothing of the tolerance, 2e-6
        println!("{w}: {:e}", solver.y()[1] - 2.0);
        assert!((solver.y()[1] - 2.0).abs() < 1e-9, "{w}: {:?}", solver.y());
    }
}

#[test]
fn an_impossible_start_is_an_error() {
    // No real number has the square -1.
    let system = |_t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
        r[0] = yp[0] - y[1];
        r[1] = y[1] * y[1] + 1.0;
        Ok(())
    };
    let options = IdaOptions::new(1e-6, 1e-8).differential([true, false]);
    let mut solver = Ida::new(system, 0.0, &[0.0, 0.5], &[0.0, 0.0], &options).unwrap();
    for error in [
        solver.consistent_start(InitialCondition::Algebraic, 1.0).unwrap_err(),
        solver.solve_to(1.0).unwrap_err(),
    ] {
        println!("{error}");
        let Error::Integration(error) = error else { panic!("{error}") };
        assert_eq!(error.cause, Cause::InconsistentStart);
        assert_eq!(error.integrator, "IDA");
    }
}

#[test]
fn an_inconsistent_start_is_an_error() {
    // y1 + y2 + y3 is 1.7 and not 1: no step size makes the jump small.
    let options = IdaOptions::new(1e-6, 1e-9);
    let mut solver =
        Ida::new(Robertson::new(), 0.0, &[1.0, 0.0, 0.7], &Robertson::YP0, &options).unwrap();
    match solver.solve_to(1.0) {
        Err(Error::Integration(error)) => assert_eq!(error.cause, Cause::InconsistentStart),
        other => panic!("{other:?}"),
    }
}

#[test]
fn unusable_input_is_named() {
    let refused = |yp0: &[f64], options: &IdaOptions| match Ida::new(
        Robertson::new(),
        0.0,
        &Robertson::Y0,
        yp0,
        options,
    ) {
        Err(Error::Input(error)) => error.input,
        other => panic!("{other:?} is not an input error"),
    };
    let good = IdaOptions::new(1e-6, 1e-9);
    assert_eq!(refused(&[0.0; 2], &good), "length of yp0");
    assert_eq!(refused(&[f64::NAN; 3], &good), "yp0");
    assert_eq!(
        refused(&Robertson::YP0, &good.clone().suppress_algebraic(true)),
        "suppress_algebraic"
    );
    assert_eq!(
        refused(&Robertson::YP0, &good.clone().differential([true])),
        "length of differential"
    );

    let mut solver =
        Ida::new(Robertson::new(), 0.0, &Robertson::Y0, &Robertson::YP0, &good).unwrap();
    for error in [
        solver.consistent_start(InitialCondition::Algebraic, 1.0).unwrap_err(),
        solver.consistent_start(InitialCondition::State, 0.0).unwrap_err(),
        solver.reinit_with(0.0, &Robertson::Y0, &[0.0]).unwrap_err(),
    ] {
        assert!(matches!(error, Error::Input(_)), "{error:?}");
    }
    solver.solve_to(1.0).unwrap();
    let error = solver.consistent_start(InitialCondition::State, 2.0).unwrap_err();
    assert!(matches!(error, Error::Input(error) if error.input == "steps taken"));
}
