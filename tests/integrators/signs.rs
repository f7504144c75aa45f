//! Unknowns that keep their sign: inequality constraints.

use std::fmt::Debug;

use pliant::{
    ode::Failure,
    samples::{Hires, Robertson},
    sundials::{
        Arkode, ArkodeOptions, ButcherTable, Cause, Cvode, CvodeOptions, Error, Ida, IdaOptions,
        InitialCondition, Integrator, Jacobian, LinearSolver, Pattern, Sign,
    },
};

/// Smallest value of an unknown at the ends of steps to time `end`, in units of its largest, and the
/// time that was reached.
fn lowest<I: Integrator>(mut solver: I, end: f64) -> (f64, f64) {
    let mut low = vec![f64::INFINITY; solver.y().len()];
    let mut high = vec![0.0_f64; low.len()];
    while solver.t() < end && solver.step(end).is_ok() {
        for ((low, high), y) in low.iter_mut().zip(&mut high).zip(solver.y()) {
            (*low, *high) = (low.min(*y), high.max(y.abs()));
        }
    }
    let lowest = low.iter().zip(&high).map(|(low, high)| low / high).fold(f64::INFINITY, f64::min);
    (lowest, solver.t())
}

/// With an `atol` above the largest value of y2 the errors make it negative, which is where Robertson's equations
/// are unstable: without constraints no run survives its first seconds.
#[test]
fn concentrations_stay_positive() {
    let end = 1e3;
    let (y0, yp0) = (&Robertson::Y0, &Robertson::YP0);
    let [free, kept] = [[Sign::Free; 3], [Sign::NonNegative; 3]].map(|signs| {
        let options = CvodeOptions::new(1e-2, 1e-3).sign_constraints(signs);
        let cvode = Cvode::new(Robertson::new(), 0.0, y0, &options).unwrap();
        let options = IdaOptions::new(1e-2, 1e-3).sign_constraints(signs);
        let ida = Ida::new(Robertson::new(), 0.0, y0, yp0, &options).unwrap();
        let options = ArkodeOptions::new(1e-2, 1e-3).sign_constraints(signs);
        let arkode = Arkode::new(Robertson::new(), 0.0, y0, &options).unwrap();
        [lowest(cvode, end), lowest(ida, end), lowest(arkode, end)]
    });
    println!("free {free:?}, kept {kept:?}");
    for ((free, reached), (kept, kept_reached)) in free.into_iter().zip(kept) {
        assert!(free < -0.5 && reached < 10.0);
        // C puts the unknown to its bound but for rounding: 2.2e-17 by CVODE, 6e-19 by IDA
        assert!(kept > -2.5e-17 && kept_reached >= end);
    }

    // HIRES survives, with negative concentrations.
    let [free, kept] = [Sign::Free, Sign::NonNegative].map(|sign| {
        let options = CvodeOptions::new(1e-2, 1e-3).sign_constraints([sign; 8]);
        let solver = Cvode::new(Hires::new(), 0.0, &Hires::Y0, &options).unwrap();
        lowest(solver, Hires::REFERENCE.t).0
    });
    println!("free {free:e}, kept {kept:e}");
    assert!(free < -1e-2 && kept >= 0.0);
}

/// y' = -100 y: a coarse run overshoots zero; each sign is kept in its own way.
#[test]
fn every_sign_is_kept() {
    fn decay(_t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot[0] = -100.0 * y[0];
        Ok(())
    }
    let extreme = |start: f64, sign: Sign| {
        let options = CvodeOptions::new(1e-2, 1e-3).sign_constraints([sign]);
        let mut solver = Cvode::new(decay, 0.0, &[start], &options).unwrap();
        let mut extreme = start;
        while solver.t() < 1.0 {
            solver.step(1.0).unwrap();
            extreme =
                if start > 0.0 { extreme.min(solver.y()[0]) } else { extreme.max(solver.y()[0]) };
        }
        println!("{sign:?}: {extreme:e}");
        extreme
    };
    assert!(extreme(1.0, Sign::Free) < -1e-5 && extreme(-1.0, Sign::Free) > 1e-5);
    assert!(extreme(1.0, Sign::NonNegative) >= 0.0 && extreme(-1.0, Sign::NonPositive) <= 0.0);
    assert!(extreme(1.0, Sign::Positive) > 0.0 && extreme(-1.0, Sign::Negative) < 0.0);
}

/// y = 1 - t is zero exactly at the end of the first step of size 1.
#[test]
fn zero_itself_is_allowed_or_not() {
    let end_of_step = |sign: Sign| {
        let rhs = |_t: f64, _y: &[f64], ydot: &mut [f64]| {
            ydot[0] = -1.0;
            Ok(())
        };
        let options = ArkodeOptions::new(1e-3, 1e-3)
            .table(ButcherTable::explicit(2).unwrap())
            .initial_step(1.0)
            .sign_constraints([sign]);
        let mut solver = Arkode::new(rhs, 0.0, &[1.0], &options).unwrap();
        solver.step(2.0).unwrap();
        println!("{sign:?}: {:e} at {}", solver.y()[0], solver.t());
        solver.y()[0]
    };
    assert_eq!(end_of_step(Sign::NonNegative), 0.0);
    assert!(end_of_step(Sign::Positive) > 0.0);
}

fn cause<T: Debug>(result: Result<T, Error>) -> (Cause, f64) {
    match result {
        Err(Error::Integration(error)) => {
            println!("{error}");
            (error.cause, error.t)
        }
        other => panic!("{other:?} is not an integration error"),
    }
}

/// y2 = 1 - t: no method keeps it positive beyond t = 1.
#[test]
fn equations_that_lead_across_the_bound_are_an_error() {
    let signs = [Sign::Free, Sign::NonNegative];
    let rhs = |_t: f64, _y: &[f64], ydot: &mut [f64]| {
        ydot.copy_from_slice(&[0.0, -1.0]);
        Ok(())
    };
    let y0 = [-1.0, 1.0];
    let cvode = CvodeOptions::new(1e-6, 1e-9).sign_constraints(signs).max_steps(1000);
    let arkode = ArkodeOptions::new(1e-6, 1e-9).sign_constraints(signs).max_steps(1000);
    let explicit = arkode.clone().table(ButcherTable::explicit(4).unwrap());
    let residual = |_t: f64, _y: &[f64], yp: &[f64], r: &mut [f64]| {
        r.copy_from_slice(&[yp[0], yp[1] + 1.0]);
        Ok(())
    };
    let ida = IdaOptions::new(1e-6, 1e-9).sign_constraints(signs).max_steps(1000);
    let runs = [
        cause(Cvode::new(rhs, 0.0, &y0, &cvode).unwrap().solve_to(2.0)),
        cause(Arkode::new(rhs, 0.0, &y0, &arkode).unwrap().solve_to(2.0)),
        cause(Arkode::new(rhs, 0.0, &y0, &explicit).unwrap().solve_to(2.0)),
        cause(Ida::new(residual, 0.0, &y0, &[0.0, -1.0], &ida).unwrap().solve_to(2.0)),
    ];
    for (cause, t) in runs {
        let Cause::SignConstraint { unknown: 1, value } = cause else { panic!("{cause:?}") };
        assert!(value < 0.0 && (0.9..=1.001).contains(&t), "{value} at {t}");
    }
}

/// Each solver knows its own bounds: that one within the equations of another met one is not why the other fails.
#[test]
fn solvers_within_solvers_keep_their_bounds_apart() {
    let inner = CvodeOptions::new(1e-3, 1e-6).sign_constraints([Sign::NonNegative]).max_steps(100);
    let mut sign = 1.0;
    let rhs = |_t: f64, _y: &[f64], ydot: &mut [f64]| {
        let falling = |_t: f64, _y: &[f64], ydot: &mut [f64]| {
            ydot[0] = -1.0;
            Ok(())
        };
        let (inner, _) = cause(Cvode::new(falling, 0.0, &[1.0], &inner)?.solve_to(2.0));
        assert!(matches!(inner, Cause::SignConstraint { .. }), "{inner:?}");
        // no step passes this
        sign = -sign;
        ydot.copy_from_slice(&[sign * 1e9, 0.0]);
        Ok(())
    };
    let outer = CvodeOptions::new(1e-6, 1e-9)
        .sign_constraints([Sign::Free, Sign::NonNegative])
        .min_step(1e-6);
    let (cause, _) = cause(Cvode::new(rhs, 0.0, &[0.0, 1.0], &outer).unwrap().solve_to(2.0));
    assert!(matches!(cause, Cause::ErrorTest | Cause::Convergence), "{cause:?}");
}

#[test]
fn a_start_beyond_the_bound_is_not_found() {
    // the second equation asks for -1
    let system = |_t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
        r.copy_from_slice(&[yp[0] + y[0], y[1] + 1.0]);
        Ok(())
    };
    let options = IdaOptions::new(1e-6, 1e-8)
        .differential([true, false])
        .sign_constraints([Sign::Free, Sign::NonNegative]);
    let mut solver = Ida::new(system, 0.0, &[1.0, 0.5], &[-1.0, 0.0], &options).unwrap();
    let (cause, _) = cause(solver.consistent_start(InitialCondition::Algebraic, 1.0));
    assert!(matches!(cause, Cause::SignConstraint { unknown: 1, .. }), "{cause:?}");
}

#[test]
fn unusable_constraints_are_named() {
    fn still(_t: f64, _y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot.fill(0.0);
        Ok(())
    }
    fn refused<T: Debug>(result: Result<T, Error>) -> String {
        let Err(Error::Input(error)) = result else { panic!("{result:?} is not an input error") };
        println!("{error}");
        format!("{} = {}", error.input, error.value)
    }
    let cvode = |signs: &[Sign], y0: &[f64]| {
        let options = CvodeOptions::new(1e-6, 1e-9).sign_constraints(signs);
        Cvode::new(still, 0.0, y0, &options)
    };
    assert_eq!(refused(cvode(&[Sign::Free], &[1.0; 2])), "length of sign_constraints = 1");
    for (sign, y) in [
        (Sign::NonNegative, -1.0),
        (Sign::Positive, 0.0),
        (Sign::NonPositive, 1.0),
        (Sign::Negative, 0.0),
    ] {
        let expected = format!("y0 = {y:?} in component 1");
        assert_eq!(refused(cvode(&[Sign::Free, sign], &[-1.0, y])), expected);
    }
    let options = ArkodeOptions::new(1e-6, 1e-9).sign_constraints([Sign::NonNegative]);
    let fixed = options.clone().fixed_step(0.1);
    assert_eq!(
        refused(Arkode::new(still, 0.0, &[1.0], &fixed)),
        "sign_constraints = given with fixed_step"
    );

    let mut solver = cvode(&[Sign::Free, Sign::NonNegative], &[0.0; 2]).unwrap();
    assert_eq!(refused(solver.reinit(0.0, &[0.0, -1.0])), "y = -1.0 in component 1");
    solver.reinit(0.0, &[-1.0, 0.0]).unwrap();
    solver.solve_to(1.0).unwrap();
    let mut solver = Arkode::new(still, 0.0, &[1.0], &options).unwrap();
    solver.solve_to(1.0).unwrap();
    assert_eq!(refused(solver.resume(1.0, &[-1.0])), "y = -1.0 in component 0");
}

/// Increments of difference quotients turn round where they would lead across a bound, of sparse matrices as SUNDIALS has it for dense ones:
/// y' = -y sqrt y at 1e-3, which increments of the size of the absolute tolerance, 1e-2, would make negative. Both take the same steps to the last bit,
/// and the equations are asked below zero by neither matrix: they are not a number there.
#[test]
fn increments_keep_the_sign() {
    let slowing = |_t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
        r[0] = yp[0] + y[0] * y[0].sqrt();
        Ok(())
    };
    let pattern = Pattern::from_entries(1, []).unwrap();
    let jacobian = Jacobian::DifferenceQuotients;
    let [dense, sparse] = [LinearSolver::Dense(jacobian), LinearSolver::Klu { pattern, jacobian }]
        .map(|solver| {
            let options = IdaOptions::new(1e-6, 1e-2)
                .newton(solver)
                .initial_step(1e-3)
                .sign_constraints([Sign::NonNegative]);
            let mut ida = Ida::new(slowing, 0.0, &[1e-3], &[-3.2e-5], &options).unwrap();
            ida.solve_to(1.0).unwrap();
            (ida.y()[0], ida.statistics().steps, ida.statistics().difference_quotient_evaluations)
        });
    assert_eq!(dense, sparse);
    assert!(dense.2 > 0);
}
