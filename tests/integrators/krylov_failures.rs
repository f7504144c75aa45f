//! Krylov methods where the user's system, or the user, does something wrong.

use std::panic::{AssertUnwindSafe, catch_unwind};

use pliant::{
    ode::{Dae, Failure, Ode},
    sundials::{
        Arkode, ArkodeOptions, Callback, Cause, Cvode, CvodeOptions, Error, Ida, IdaOptions,
        IntegrationError, Integrator, Jacobian, Krylov, KrylovMethod, LinearSolver, Pattern,
        Preconditioner, Side,
    },
};

const GMRES: KrylovMethod = KrylovMethod::Gmres { dimension: 3, restarts: 1 };
const BICGSTAB: KrylovMethod = KrylovMethod::BiCgStab { iterations: 5 };

fn integration_error<T: std::fmt::Debug>(result: Result<T, Error>) -> IntegrationError {
    match result {
        Err(Error::Integration(error)) => {
            println!("{error}");
            *error
        }
        other => panic!("{other:?} is not an integration error"),
    }
}

/// A failure, or a number that is spoilt.
type How = fn(&mut f64) -> Result<(), Failure>;

/// The state at t = 2 and the linear failures until then.
type End = Result<(f64, u64), Error>;

/// y' = -50 (y - cos t), which beyond t = 0.5 fails in the callback that it is told to fail in, some times;
/// `newton_solve` does at once.
#[derive(Clone, Copy)]
struct Saboteur {
    place: Callback,
    how: How,
    times: u32,
}

impl Saboteur {
    fn at(&mut self, place: Callback, t: f64, output: &mut f64) -> Result<(), Failure> {
        if self.place != place || t <= 0.5 || self.times == 0 {
            return Ok(());
        }
        self.times -= 1;
        (self.how)(output)
    }

    /// The exact solution.
    fn y(t: f64) -> f64 {
        let slow = |t: f64| (2500.0 * t.cos() + 50.0 * t.sin()) / 2501.0;
        slow(t) + (1.0 - slow(0.0)) * (-50.0 * t).exp()
    }
}

impl Ode for Saboteur {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot[0] = -50.0 * (y[0] - t.cos());
        Ok(())
    }

    fn sparse_jacobian(
        &mut self,
        t: f64,
        _y: &[f64],
        _ydot: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        values[0] = -50.0;
        self.at(Callback::Jacobian, t, &mut values[0])
    }

    fn jacobian_times(
        &mut self,
        t: f64,
        _y: &[f64],
        _ydot: &[f64],
        v: &[f64],
        jv: &mut [f64],
    ) -> Result<(), Failure> {
        jv[0] = -50.0 * v[0];
        self.at(Callback::JacobianTimes, t, &mut jv[0])
    }

    fn newton_setup(
        &mut self,
        t: f64,
        _y: &[f64],
        _ydot: &[f64],
        _gamma: f64,
        _reuse: bool,
    ) -> Result<bool, Failure> {
        self.at(Callback::NewtonSetup, t, &mut 0.0)?;
        Ok(true)
    }

    fn newton_solve(&mut self, _gamma: f64, r: &mut [f64]) -> Result<(), Failure> {
        self.at(Callback::NewtonSolve, 1.0, &mut r[0])
    }
}

impl Dae for Saboteur {
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        r[0] = yp[0] + 50.0 * (y[0] - t.cos());
        Ok(())
    }

    fn sparse_jacobian(
        &mut self,
        t: f64,
        cj: f64,
        _y: &[f64],
        _yp: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        values[0] = cj + 50.0;
        self.at(Callback::Jacobian, t, &mut values[0])
    }

    fn jacobian_times(
        &mut self,
        t: f64,
        cj: f64,
        _y: &[f64],
        _yp: &[f64],
        v: &[f64],
        jv: &mut [f64],
    ) -> Result<(), Failure> {
        jv[0] = (cj + 50.0) * v[0];
        self.at(Callback::JacobianTimes, t, &mut jv[0])
    }

    fn newton_setup(&mut self, t: f64, _cj: f64, _y: &[f64], _yp: &[f64]) -> Result<(), Failure> {
        self.at(Callback::NewtonSetup, t, &mut 0.0)
    }

    fn newton_solve(&mut self, r: &mut [f64]) -> Result<(), Failure> {
        self.at(Callback::NewtonSolve, 1.0, &mut r[0])
    }
}

/// The integrators, as functions of the saboteur.
const INTEGRATORS: [fn(Saboteur, LinearSolver) -> End; 3] = [
    |saboteur, solver| {
        let options = CvodeOptions::new(1e-6, 1e-9).newton(solver).max_steps_between_setups(1);
        end(Cvode::new(saboteur, 0.0, &[1.0], &options)?)
    },
    |saboteur, solver| {
        let options = ArkodeOptions::new(1e-6, 1e-9).newton(solver).max_steps_between_setups(1);
        let options = options.max_steps_between_jacobians(1);
        end(Arkode::new(saboteur, 0.0, &[1.0], &options)?)
    },
    |saboteur, solver| {
        let options = IdaOptions::new(1e-6, 1e-9).newton(solver);
        end(Ida::new(saboteur, 0.0, &[1.0], &[0.0], &options)?)
    },
];

fn end(mut solver: impl Integrator) -> End {
    solver.solve_to(2.0)?;
    Ok((solver.y()[0], solver.statistics().linear_failures))
}

/// Calls `check` with how each integrator ends, by each method and each place of sabotage.
fn each_end((how, times): (How, u32), check: impl Fn(Callback, &dyn Fn() -> End)) {
    for (place, method) in PLACES.into_iter().flat_map(|place| [(place, GMRES), (place, BICGSTAB)])
    {
        let preconditioner = match place {
            Callback::Jacobian => Preconditioner::Ilu {
                pattern: Pattern::from_entries(1, []).unwrap(),
                jacobian: Jacobian::Supplied,
            },
            _ => Preconditioner::Custom,
        };
        let krylov = Krylov::new(method)
            .products(Jacobian::Supplied)
            .preconditioner(Side::Left, preconditioner);
        let solver = LinearSolver::Krylov(krylov);
        for run in INTEGRATORS {
            check(place, &|| run(Saboteur { place, how, times }, solver.clone()));
        }
    }
}

const PLACES: [Callback; 4] =
    [Callback::JacobianTimes, Callback::Jacobian, Callback::NewtonSetup, Callback::NewtonSolve];

const WITHIN_SOLVE: [Callback; 2] = [Callback::JacobianTimes, Callback::NewtonSolve];

#[test]
fn errors_of_callbacks_come_back_with_their_source() {
    let full = |_: &mut f64| Err(std::io::Error::other("the disk is full").into());
    each_end((full, u32::MAX), |place, end| {
        let error = integration_error(end());
        assert_eq!(error.cause, Cause::Fatal(place));
        assert_eq!(error.source.unwrap().to_string(), "the disk is full");
    });
}

/// Places within the solution of a system are left out: small steps do without any, where the predictor is good
/// enough.
#[test]
fn refusals_and_nan_are_named() {
    let refuse = |_: &mut f64| Err(Failure::Recoverable("not here".into()));
    each_end((refuse, u32::MAX), |place, end| {
        if !WITHIN_SOLVE.contains(&place) {
            let error = integration_error(end());
            let Cause::Rejected { callback, .. } = error.cause else { panic!("{:?}", error.cause) };
            assert_eq!(callback, place);
        }
    });
    let nan = |output: &mut f64| {
        *output = f64::NAN;
        Ok(())
    };
    each_end((nan, u32::MAX), |place, end| {
        // the other setup has no numbers to give
        if place == Callback::Jacobian {
            let error = integration_error(end());
            let Cause::NotFinite { callback, .. } = error.cause else {
                panic!("{:?}", error.cause)
            };
            assert_eq!(callback, place);
        }
    });
}

/// A solution that is refused some times, or is NaN, is tried again with smaller steps.
#[test]
fn refused_solutions_are_tried_again() {
    let refuse = |_: &mut f64| Err(Failure::Recoverable("not here".into()));
    let nan = |output: &mut f64| {
        *output = f64::NAN;
        Ok(())
    };
    for how in [refuse as How, nan] {
        each_end((how, 3), |place, end| {
            if WITHIN_SOLVE.contains(&place) {
                let (y, failures) = end().unwrap();
                let error = (y - Saboteur::y(2.0)).abs();
                println!("error {error:.1e}, {failures} failures");
                assert!(error < 5e-6, "{error}");
                assert_eq!(failures, 3);
            }
        });
    }
}

#[test]
fn panics_pass_through_c() {
    each_end((|_| panic!("sabotage"), u32::MAX), |_, end| {
        let panic = catch_unwind(AssertUnwindSafe(end)).unwrap_err();
        assert_eq!(panic.downcast_ref(), Some(&"sabotage"));
    });
}

#[test]
fn missing_products_are_named() {
    let decay = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot[0] = -y[0];
        Ok(())
    };
    let krylov = Krylov::new(GMRES).products(Jacobian::Supplied);
    let options = CvodeOptions::new(1e-6, 1e-9).newton(LinearSolver::Krylov(krylov));
    let mut solver = Cvode::new(decay, 0.0, &[1.0], &options).unwrap();
    let error = integration_error(solver.solve_to(1.0));
    assert!(error.source.unwrap().to_string().contains("jacobian_times"));
}

/// A DAE whose first equation lacks its unknown: the factorization has no pivot there, and says so.
#[test]
fn a_missing_pivot_is_named() {
    let crossed = |_t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
        r.copy_from_slice(&[yp[1] + y[1], y[0] - y[1]]);
        Ok(())
    };
    let pattern = Pattern::band(2, 1, 1).unwrap();
    let ilu = Preconditioner::Ilu { pattern, jacobian: Jacobian::DifferenceQuotients };
    let krylov = Krylov::new(GMRES).preconditioner(Side::Left, ilu);
    let options = IdaOptions::new(1e-6, 1e-9).newton(LinearSolver::Krylov(krylov));
    let mut solver = Ida::new(crossed, 0.0, &[1.0; 2], &[-1.0; 2], &options).unwrap();
    let error = integration_error(solver.solve_to(1.0));
    let Cause::Rejected { callback: Callback::Preconditioner, message, .. } = error.cause else {
        panic!("{:?}", error.cause)
    };
    assert!(message.contains("row 0"), "{message}");
}

/// One dimension without a restart is too little for steps of a fixed size.
#[test]
fn a_method_that_does_not_converge_is_named() {
    let oscillators = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        for k in 0..4 {
            let rate = 10f64.powi(k as i32);
            (ydot[2 * k], ydot[2 * k + 1]) = (rate * y[2 * k + 1], -rate * y[2 * k]);
        }
        Ok(())
    };
    for method in [
        KrylovMethod::Gmres { dimension: 1, restarts: 0 },
        KrylovMethod::BiCgStab { iterations: 1 },
    ] {
        let options = ArkodeOptions::new(1e-6, 1e-9)
            .fixed_step(0.1)
            .newton(LinearSolver::Krylov(Krylov::new(method)));
        let y0 = [1.0, 0.5, 1.0, 0.5, 1.0, 0.5, 1.0, 0.5];
        let mut solver = Arkode::new(oscillators, 0.0, &y0, &options).unwrap();
        let error = integration_error(solver.solve_to(1.0));
        assert_eq!(error.cause, Cause::LinearConvergence);
        assert!(solver.statistics().linear_failures > 0);
    }
}

#[test]
fn unusable_options_are_named() {
    let decay = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot[0] = -y[0];
        Ok(())
    };
    let refused = |krylov: Krylov| {
        let options = CvodeOptions::new(1e-6, 1e-9).newton(LinearSolver::Krylov(krylov));
        match Cvode::new(decay, 0.0, &[1.0], &options) {
            Err(Error::Input(error)) => error.input,
            other => panic!("{other:?} is not an input error"),
        }
    };
    for dimension in [0, 1001, u32::MAX] {
        let gmres = KrylovMethod::Gmres { dimension, restarts: 0 };
        assert_eq!(refused(Krylov::new(gmres)), "dimension");
        let bicgstab = KrylovMethod::BiCgStab { iterations: dimension };
        assert_eq!(refused(Krylov::new(bicgstab)), "iterations");
    }
    let restarts = KrylovMethod::Gmres { dimension: 1, restarts: 1001 };
    assert_eq!(refused(Krylov::new(restarts)), "restarts");
    for factor in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(refused(Krylov::new(GMRES).tolerance_factor(factor)), "tolerance_factor");
    }
    let pattern = Pattern::from_entries(2, []).unwrap();
    let ilu = Preconditioner::Ilu { pattern, jacobian: Jacobian::Supplied };
    let krylov = Krylov::new(GMRES).preconditioner(Side::Left, ilu);
    assert_eq!(refused(krylov), "dimension of the sparsity pattern");

    let krylov = Krylov::new(GMRES).preconditioner(Side::Right, Preconditioner::Custom);
    let options = IdaOptions::new(1e-6, 1e-9).newton(LinearSolver::Krylov(krylov));
    let residual = |_t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
        r[0] = yp[0] + y[0];
        Ok(())
    };
    let error = Ida::new(residual, 0.0, &[1.0], &[-1.0], &options).unwrap_err();
    assert!(
        matches!(&error, Error::Input(e) if e.input == "side of the preconditioner"),
        "{error}"
    );
}
