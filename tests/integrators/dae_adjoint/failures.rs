//! Adjoint gradients of DAEs that can not be had, and why.

use std::panic::{AssertUnwindSafe, catch_unwind};

use pliant::{
    ode::Failure,
    sundials::{
        AdjointOptions, Callback, Cause, DaeAdjoint, Error, Gradient, IdaOptions, IntegrationError,
        Krylov, KrylovMethod, LinearSolver, Sensitivities,
    },
};

use super::{By, LINEAR, Linear, closed_form, difference, square_and_more};

fn stopped(outcome: std::thread::Result<Result<Gradient, Error>>) -> IntegrationError {
    match outcome {
        Ok(Err(Error::Integration(error))) => {
            println!("{error}, {:?}", error.source);
            *error
        }
        other => panic!("{other:?}"),
    }
}

fn nothing(_: &[f64], _: &mut [f64]) -> f64 {
    0.0
}

#[test]
fn troubles_on_the_way_back_are_told() {
    let forward = IdaOptions::new(1e-6, 1e-8).differential([true, false]);
    let back = AdjointOptions::new(1e-6, 1e-8);
    let new = |trouble, forward: &IdaOptions| {
        let (system, functional) = (Linear { trouble, ..LINEAR }, square_and_more());
        DaeAdjoint::new(system, functional, 0.0, &[1.5, 0.0], &[0.0; 2], forward, &back).unwrap()
    };
    let run = |trouble: fn() -> Result<(), Failure>| {
        let mut adjoint = new(Some(trouble), &forward);
        let outcome = catch_unwind(AssertUnwindSafe(|| adjoint.gradient(1.2)));
        assert_eq!(adjoint.system().p, LINEAR.p, "put back to the last bit");
        // It goes on working.
        adjoint.system_mut().trouble = None;
        let gradient = adjoint.gradient(1.2).unwrap();
        assert!(difference(&gradient, &closed_form(LINEAR.p, 1.2)) < 1e-4);
        outcome
    };
    let error = stopped(run(|| Err(Failure::Fatal("no".into()))));
    assert_eq!(error.cause, Cause::Fatal(Callback::Adjoint));
    assert!(error.integrator.contains("IDA in the backward run") && error.t < 0.7);
    let error = stopped(run(|| Err(Failure::Recoverable("not here".into()))));
    assert!(matches!(error.cause, Cause::Rejected { callback: Callback::Adjoint, .. }));
    let panic = run(|| panic!("sabotage")).unwrap_err();
    assert_eq!(*panic.downcast_ref::<&str>().unwrap(), "sabotage");
    // Forward, as ever.
    let error = stopped(Ok(new(None, &forward.clone().max_steps(3)).gradient(1.2)));
    assert!(matches!(error.cause, Cause::TooManySteps { steps: 3, .. }), "{error}");
}

#[test]
fn unusable_input_is_named() {
    let forward = IdaOptions::new(1e-6, 1e-8).differential([true, false]);
    let back = AdjointOptions::new(1e-6, 1e-8);
    let made = |forward: &IdaOptions, back: &AdjointOptions| {
        DaeAdjoint::new(LINEAR, square_and_more(), 0.0, &[1.5, 0.0], &[0.0; 2], forward, back)
    };
    let refused = |forward: &IdaOptions, back: &AdjointOptions| match made(forward, back) {
        Err(Error::Input(error)) => {
            println!("{error}");
            error.to_string()
        }
        other => panic!("{other:?}"),
    };
    assert!(refused(&IdaOptions::new(1e-6, 1e-8), &back).contains("which unknowns are algebraic"));
    let wrong = forward.clone().differential([true, true]);
    assert!(refused(&wrong, &back).contains("1 are without derivatives"));
    let wrong = forward.clone().differential([false, true]);
    assert!(refused(&wrong, &back).contains("its derivative occurs in equation 1"));
    assert!(refused(&forward.clone().newton(LinearSolver::Custom), &back).contains("entries"));
    let krylov = Krylov::new(KrylovMethod::Gmres { dimension: 2, restarts: 1 });
    let krylov = forward.clone().newton(LinearSolver::Krylov(krylov));
    assert!(refused(&krylov, &back).contains("adjoint_residual"));
    let sensitivities = forward.clone().sensitivities(Sensitivities::of([0]));
    assert!(refused(&sensitivities, &back).contains("sensitivities"));
    assert!(refused(&forward, &back.clone().checkpoint_steps(0)).contains("checkpoint_steps"));
    let mut adjoint = made(&forward, &back).unwrap();
    for t in [0.0, -1.0, f64::NAN] {
        assert!(matches!(adjoint.gradient(t), Err(Error::Input(_))));
    }
}

type Residual = fn(f64, &[f64], &[f64], &mut [f64]) -> Result<(), Failure>;

/// What is wrong with equations F(t, y, y') = 0 from here, as their gradient says.
fn trouble_of(
    residual: Residual,
    (y0, yp0): (&[f64], &[f64]),
    differential: &[bool],
) -> IntegrationError {
    let forward = IdaOptions::new(1e-6, 1e-8).differential(differential);
    let back = AdjointOptions::new(1e-6, 1e-8);
    let sum = |y: &[f64], slopes: &mut [f64]| {
        slopes.fill(1.0);
        y.iter().sum()
    };
    let functional = By(sum, nothing);
    let mut adjoint = DaeAdjoint::new(residual, functional, 0.0, y0, yp0, &forward, &back).unwrap();
    stopped(Ok(adjoint.gradient(1.0)))
}

#[test]
fn equations_of_another_form_are_told() {
    let changing: [Residual; 3] = [
        |_, y, yp, r| {
            r[0] = (1.0 + 1e-3 * y[0]) * yp[0] + y[0];
            Ok(())
        },
        |t, y, yp, r| {
            r[0] = (1.0 + 1e-3 * t) * yp[0] + y[0];
            Ok(())
        },
        |_, y, yp, r| {
            r[0] = yp[0] + 1e-3 * yp[0].powi(3) + y[0];
            Ok(())
        },
    ];
    for residual in changing {
        let error = trouble_of(residual, (&[1.0], &[-1.0]), &[true]);
        assert_eq!(error.cause, Cause::Fatal(Callback::Adjoint));
        assert!(error.source.unwrap().to_string().contains("dF/dy' of equation 0"));
    }
    // x' = v, v' = z, 0 = x - t: of index 3
    let error = trouble_of(
        |t, y, yp, r| {
            r.copy_from_slice(&[yp[0] - y[1], yp[1] - y[2], y[0] - t]);
            Ok(())
        },
        (&[0.0, 1.0, 0.0], &[1.0, 0.0, 0.0]),
        &[true, true, false],
    );
    assert!(error.source.unwrap().to_string().contains("index 2"));
    // of index 1, but only two combinations of three unknowns have derivatives: singular to rounding
    let error = trouble_of(
        |_, y, yp, r| {
            let one = 0.1 * yp[0] + 0.37 * yp[1] + 1.3 * yp[2];
            let two = 0.3 * yp[0] - 0.7 * yp[1] + 0.9 * yp[2];
            let both = one / 3.0 + 0.77 * two;
            r.copy_from_slice(&[one + y[0] + y[1], two + y[1], both + y[0] - y[2]]);
            Ok(())
        },
        (&[0.0; 3], &[0.0; 3]),
        &[true; 3],
    );
    assert!(error.source.unwrap().to_string().contains("do not determine"));
}
