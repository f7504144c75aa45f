//! What happens when the user's system, or the user, does something wrong.

use std::{
    error::Error as _,
    panic::{AssertUnwindSafe, catch_unwind},
};

use pliant::{
    InputError,
    ode::{Dae, Failure, Ode},
    sundials::{
        Callback, Cause, Cvode, CvodeOptions, Error, Ida, IdaOptions, InitialCondition,
        IntegrationError, Integrator, Jacobian, LinearSolver, Multistep, Pattern,
    },
};

fn integration_error<T: std::fmt::Debug>(result: Result<T, Error>) -> IntegrationError {
    match result {
        Err(Error::Integration(error)) => {
            println!("{error}");
            *error
        }
        other => panic!("{other:?} is not an integration error"),
    }
}

fn decay(_t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    ydot[0] = -y[0];
    Ok(())
}

fn cvode<S: Ode>(system: S) -> Cvode<S> {
    Cvode::new(system, 0.0, &[1.0], &CvodeOptions::new(1e-6, 1e-9)).unwrap()
}

/// Fails in the callback that it is told to fail in.
struct Saboteur {
    place: Callback,
    how: fn() -> Failure,
}

impl Saboteur {
    fn at(&self, place: Callback, t: f64) -> Result<(), Failure> {
        if self.place == place && t > 0.5 { Err((self.how)()) } else { Ok(()) }
    }
}

impl Ode for Saboteur {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.at(Callback::Rhs, t)?;
        decay(t, y, ydot)
    }

    fn newton_setup(
        &mut self,
        t: f64,
        _y: &[f64],
        _ydot: &[f64],
        _gamma: f64,
        _reuse: bool,
    ) -> Result<bool, Failure> {
        self.at(Callback::NewtonSetup, t)?;
        Ok(true)
    }

    fn newton_solve(&mut self, _gamma: f64, _r: &mut [f64]) -> Result<(), Failure> {
        self.at(Callback::NewtonSolve, 1.0)
    }

    fn root_count(&self) -> usize {
        1
    }

    fn roots(&mut self, t: f64, _y: &[f64], g: &mut [f64]) -> Result<(), Failure> {
        self.at(Callback::Roots, t)?;
        g[0] = 1.0;
        Ok(())
    }
}

impl Dae for Saboteur {
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        self.at(Callback::Residual, t)?;
        r[0] = yp[0] + y[0];
        Ok(())
    }

    fn dense_jacobian(
        &mut self,
        t: f64,
        cj: f64,
        _y: &[f64],
        _yp: &[f64],
        mut jacobian: faer::MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        self.at(Callback::Jacobian, t)?;
        jacobian[(0, 0)] = cj + 1.0;
        Ok(())
    }
}

const FATAL: fn() -> Failure = || std::io::Error::other("the disk is full").into();
const PANIC: fn() -> Failure = || panic!("sabotage");

fn run_ode(place: Callback, how: fn() -> Failure) -> Result<(), Error> {
    let options = CvodeOptions::new(1e-6, 1e-9).newton(LinearSolver::Custom);
    Cvode::new(Saboteur { place, how }, 0.0, &[1.0], &options)?.solve_to(10.0).map(|_| ())
}

fn run_dae(place: Callback, how: fn() -> Failure) -> Result<(), Error> {
    let options = IdaOptions::new(1e-6, 1e-9).newton(LinearSolver::Dense(Jacobian::Supplied));
    Ida::new(Saboteur { place, how }, 0.0, &[1.0], &[-1.0], &options)?.solve_to(10.0).map(|_| ())
}

const ODE_PLACES: [Callback; 4] =
    [Callback::Rhs, Callback::NewtonSetup, Callback::NewtonSolve, Callback::Roots];
const DAE_PLACES: [Callback; 2] = [Callback::Residual, Callback::Jacobian];

#[test]
fn a_fatal_failure_comes_back_as_the_source() {
    let runs = ODE_PLACES.map(|place| (place, run_ode(place, FATAL)));
    let dae_runs = DAE_PLACES.map(|place| (place, run_dae(place, FATAL)));
    for (place, result) in runs.into_iter().chain(dae_runs) {
        let error = integration_error(result);
        assert_eq!(error.cause, Cause::Fatal(place));
        assert_eq!(error.source().unwrap().to_string(), "the disk is full");
        // Matrices are set up every twenty steps or so.
        assert!(error.t < 3.0, "it went on to {}", error.t);
    }
}

#[test]
fn a_panic_crosses_c_and_goes_on_in_rust() {
    let panics = |run: &dyn Fn()| {
        let payload = catch_unwind(AssertUnwindSafe(run)).unwrap_err();
        assert_eq!(payload.downcast_ref::<&str>(), Some(&"sabotage"));
    };
    for place in ODE_PLACES {
        panics(&|| drop(run_ode(place, PANIC)));
    }
    for place in DAE_PLACES {
        panics(&|| drop(run_dae(place, PANIC)));
    }
    let mut solver = Ida::new(
        |_t: f64, _y: &[f64], _yp: &[f64], _r: &mut [f64]| Err(PANIC()),
        0.0,
        &[1.0],
        &[0.0],
        &IdaOptions::new(1e-6, 1e-9),
    )
    .unwrap();
    let payload =
        catch_unwind(AssertUnwindSafe(|| solver.consistent_start(InitialCondition::State, 1.0)))
            .unwrap_err();
    assert_eq!(payload.downcast_ref::<&str>(), Some(&"sabotage"));
}

#[test]
fn a_solver_can_be_used_again_after_a_panic() {
    let mut angry = true;
    let mut solver = cvode(move |t: f64, y: &[f64], ydot: &mut [f64]| {
        if t > 0.5 && std::mem::take(&mut angry) {
            panic!("once");
        }
        decay(t, y, ydot)
    });
    catch_unwind(AssertUnwindSafe(|| solver.solve_to(1.0))).unwrap_err();
    solver.reinit(0.0, &[1.0]).unwrap();
    solver.solve_to(1.0).unwrap();
    assert!((solver.y()[0] - (-1f64).exp()).abs() < 1e-5);
}

#[test]
fn a_recoverable_failure_is_overcome_by_a_smaller_step() {
    // sqrt(1 - t) ends at t = 1; a long step passes it, and short ones reach t = 0.999.
    let mut refusals = 0;
    let mut solver = cvode(|t: f64, _y: &[f64], ydot: &mut [f64]| {
        if t > 1.0 {
            refusals += 1;
            return Err(Failure::Recoverable("beyond the edge".into()));
        }
        ydot[0] = -(1.0 - t).sqrt();
        Ok(())
    });
    solver.solve_to(0.999).unwrap();
    let exact = 1.0 - 2.0 / 3.0 * (1.0 - 0.001f64.powf(1.5));
    assert!((solver.y()[0] - exact).abs() < 1e-4, "{}", solver.y()[0] - exact);
    drop(solver);
    assert!(refusals > 0, "the edge was never touched");
}

#[test]
fn a_failure_that_no_step_overcomes_is_an_error() {
    for place in [Callback::Rhs, Callback::NewtonSetup, Callback::NewtonSolve] {
        let refuse: fn() -> Failure = || Failure::Recoverable("no".into());
        let error = integration_error(run_ode(place, refuse));
        let Cause::Rejected { callback, message, .. } = error.cause else { panic!() };
        assert_eq!((callback, message.as_str()), (place, "no"));
    }
    for place in DAE_PLACES {
        let refuse: fn() -> Failure = || Failure::Recoverable("no".into());
        let error = integration_error(run_dae(place, refuse));
        assert!(
            matches!(&error.cause, Cause::Rejected { callback, .. } if *callback == place),
            "{:?}",
            error.cause
        );
    }
}

#[test]
fn an_overcome_failure_is_not_blamed_for_a_later_one() {
    let mut refused = false;
    let system = move |t: f64, y: &[f64], ydot: &mut [f64]| {
        if t > 0.1 && !refused {
            refused = true;
            return Err(Failure::Recoverable("early".into()));
        }
        decay(t, y, ydot)
    };
    let options = CvodeOptions::new(1e-6, 1e-9).max_steps(60);
    let error = integration_error(Cvode::new(system, 0.0, &[1.0], &options).unwrap().solve_to(1e3));
    assert!(error.t > 0.2);
    assert!(matches!(error.cause, Cause::TooManySteps { .. }));
}

#[test]
fn nan_is_named_with_time_and_component() {
    let mut solver = Cvode::new(
        |t: f64, _y: &[f64], ydot: &mut [f64]| {
            ydot.copy_from_slice(&[1.0, (1.0 - t).sqrt()]);
            Ok(())
        },
        0.0,
        &[0.0, 0.0],
        &CvodeOptions::new(1e-6, 1e-9),
    )
    .unwrap();
    let error = integration_error(solver.solve_to(2.0));
    let Cause::NotFinite { callback: Callback::Rhs, t, component: 1, .. } = error.cause else {
        panic!("{:?}", error.cause)
    };
    assert!((t - 1.0).abs() < 0.01 && (error.t - 1.0).abs() < 0.01);
    // It does not try for ever.
    let steps = solver.statistics().steps;
    assert!(steps < 500, "{steps}");

    let error = integration_error(
        cvode(|_t: f64, _y: &[f64], ydot: &mut [f64]| {
            ydot[0] = f64::INFINITY;
            Ok(())
        })
        .solve_to(1.0),
    );
    assert!(matches!(error.cause, Cause::NotFinite { component: 0, .. }));

    let residual = |_t: f64, _y: &[f64], _yp: &[f64], r: &mut [f64]| {
        r[0] = f64::NAN;
        Ok(())
    };
    let error = integration_error(
        Ida::new(residual, 0.0, &[1.0], &[0.0], &IdaOptions::new(1e-6, 1e-9))
            .unwrap()
            .solve_to(1.0),
    );
    assert!(matches!(error.cause, Cause::NotFinite { callback: Callback::Residual, .. }));
}

#[test]
fn nan_in_a_jacobian_is_named() {
    let pattern = Pattern::from_entries(1, []).unwrap();
    let system = pliant::ode::with_sparse_jacobian(decay, |_t, _y, _ydot, values: &mut [f64]| {
        values[0] = f64::NAN;
        Ok(())
    });
    let options = CvodeOptions::new(1e-6, 1e-9)
        .newton(LinearSolver::Klu { pattern, jacobian: Jacobian::Supplied });
    let error = integration_error(Cvode::new(system, 0.0, &[1.0], &options).unwrap().solve_to(1.0));
    assert!(matches!(error.cause, Cause::NotFinite { callback: Callback::Jacobian, .. }));
}

#[test]
fn errors_travel() {
    const fn travels<T: std::error::Error + Send + Sync + 'static>() {}
    const { travels::<Error>() };
}

#[test]
fn a_missing_jacobian_is_named() {
    let options = CvodeOptions::new(1e-6, 1e-9).newton(LinearSolver::Dense(Jacobian::Supplied));
    let error = integration_error(Cvode::new(decay, 0.0, &[1.0], &options).unwrap().solve_to(1.0));
    assert!(error.source().unwrap().to_string().contains("dense_jacobian"));
}

#[test]
fn a_singular_newton_matrix_is_named() {
    // Two unknowns, one equation twice.
    let residual = |_t: f64, y: &[f64], _yp: &[f64], r: &mut [f64]| {
        r.fill(y[0] + y[1] - 1.0);
        Ok(())
    };
    let error = integration_error(
        Ida::new(residual, 0.0, &[0.2, 0.3], &[0.0; 2], &IdaOptions::new(1e-6, 1e-9))
            .unwrap()
            .solve_to(1.0),
    );
    assert_eq!(error.cause, Cause::LinearSolver);
}

#[test]
fn too_many_steps_and_too_much_accuracy() {
    let options = CvodeOptions::new(1e-6, 1e-9).max_steps(3);
    let error = integration_error(Cvode::new(decay, 0.0, &[1.0], &options).unwrap().solve_to(10.0));
    assert!(matches!(error.cause, Cause::TooManySteps { .. }));
    assert!(error.t > 0.0 && error.step > 0.0 && error.order >= 1);

    let options = CvodeOptions::new(1e-20, 1e-30);
    let error = integration_error(Cvode::new(decay, 0.0, &[1.0], &options).unwrap().solve_to(1.0));
    assert_eq!(error.cause, Cause::TooMuchAccuracy);
}

#[test]
fn unusable_input_is_named_before_c_sees_it() {
    let good = CvodeOptions::new(1e-6, 1e-9);
    let refused = |y0: &[f64], options: &CvodeOptions| match Cvode::new(decay, 0.0, y0, options) {
        Err(Error::Input(InputError { input, value, help })) => {
            println!("{input} = {value}: {help}");
            input
        }
        other => panic!("{other:?} is not an input error"),
    };
    for rtol in [1.0, -1e-3, f64::NAN, f64::INFINITY] {
        assert_eq!(refused(&[1.0], &CvodeOptions::new(rtol, 1e-9)), "rtol");
    }
    for atol in [-1e-9, f64::NAN, f64::INFINITY] {
        assert_eq!(refused(&[1.0], &CvodeOptions::new(1e-6, atol)), "atol");
        assert_eq!(refused(&[1.0], &CvodeOptions::new(1e-6, [atol])), "atol");
    }
    assert_eq!(refused(&[0.0], &CvodeOptions::new(1e-6, 0.0)), "atol");
    assert_eq!(refused(&[1.0], &CvodeOptions::new(1e-6, [1e-9; 2])), "length of atol");
    assert_eq!(refused(&[], &good), "length of y0");
    assert_eq!(refused(&[f64::NAN], &good), "y0");
    assert_eq!(refused(&[1.0], &good.clone().max_order(6)), "max_order");
    assert_eq!(refused(&[1.0], &good.clone().max_order(0)), "max_order");
    assert_eq!(refused(&[1.0], &good.clone().method(Multistep::Adams).max_order(13)), "max_order");
    assert_eq!(refused(&[1.0], &good.clone().max_step(-1.0)), "max_step");
    assert_eq!(refused(&[1.0], &good.clone().min_step(f64::NAN)), "min_step");
    assert_eq!(refused(&[1.0], &good.clone().min_step(2.0).max_step(1.0)), "min_step");
    assert_eq!(refused(&[1.0], &good.clone().initial_step(0.0)), "initial_step");
    assert_eq!(refused(&[1.0], &good.clone().max_steps(0)), "max_steps");
    let pattern = Pattern::from_entries(2, []).unwrap();
    let klu = LinearSolver::Klu { pattern, jacobian: Jacobian::Supplied };
    assert_eq!(refused(&[1.0], &good.clone().newton(klu)), "dimension of the sparsity pattern");
    let band = LinearSolver::Band { lower: 1, upper: 0, jacobian: Jacobian::DifferenceQuotients };
    assert_eq!(refused(&[1.0], &good.clone().newton(band)), "bandwidths (lower, upper)");

    let mut solver = cvode(decay);
    solver.solve_to(1.0).unwrap();
    let inputs = [
        solver.solve_to(f64::NAN).unwrap_err(),
        solver.solve_to(0.5).unwrap_err(),
        solver.step(0.5).unwrap_err(),
        solver.set_stop_time(Some(0.5)).unwrap_err(),
        solver.set_stop_time(Some(f64::NAN)).unwrap_err(),
        solver.interpolate(0.0, 0, &mut [0.0]).unwrap_err(),
        solver.interpolate(1.0, 9, &mut [0.0]).unwrap_err(),
        solver.interpolate(1.0, 0, &mut [0.0; 2]).unwrap_err(),
        solver.reinit(0.0, &[1.0; 2]).unwrap_err(),
        solver.reinit(f64::INFINITY, &[1.0]).unwrap_err(),
        solver.reinit(0.0, &[f64::NAN]).unwrap_err(),
    ];
    for error in inputs {
        println!("{error}");
        assert!(matches!(error, Error::Input(_)), "{error:?}");
    }
    // None of these has disturbed the solver.
    solver.solve_to(2.0).unwrap();
    assert!((solver.y()[0] - (-2f64).exp()).abs() < 2e-6);
}

#[test]
fn more_root_functions_than_c_can_count_are_refused() {
    struct Crowded(usize);
    impl Ode for Crowded {
        fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
            decay(t, y, ydot)
        }

        fn root_count(&self) -> usize {
            self.0
        }
    }
    // The first is -1 as a count of C, the second none at all.
    for count in [usize::MAX, 1 << 32] {
        let options = CvodeOptions::new(1e-6, 1e-9);
        let error = Cvode::new(Crowded(count), 0.0, &[1.0], &options).unwrap_err();
        assert!(matches!(&error, Error::Input(input) if input.input == "root_count"), "{error}");
    }
}
