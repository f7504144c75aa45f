//! Failures of the right-hand side and bad input.

use super::*;

#[test]
fn a_right_hand_side_that_is_not_a_number_is_named() {
    // The first component is fine; the second has a logarithm that ends at t = 0.5.
    let trap = |t: f64, _y: &[f64], ydot: &mut [f64]| {
        ydot[0] = 1.0;
        ydot[1] = if t < 0.5 { 1.0 } else { f64::NAN };
        Ok(())
    };
    let mut solver = DormandPrince::new(trap, 0.0, &[0.0, 0.0], &Options::default()).unwrap();
    let error = stopped(solver.solve_to(1.0));
    match error.cause {
        Cause::NotFinite { callback: Callback::Rhs, t, component, value } => {
            assert_eq!(component, 1);
            assert!(value.is_nan());
            let step = error.step;
            assert!((t - 0.5).abs() < 1e-10 && step < 1e-10, "t = {t}, step {step}");
        }
        _ => panic!("{error}"),
    }
    // What was reached is kept: y = t up to the trap.
    assert!((solver.y()[1] - solver.t()).abs() < 1e-14 && solver.t() > 0.49);

    let mut at_once = DormandPrince::new(
        |_t: f64, _y: &[f64], ydot: &mut [f64]| {
            ydot.fill(f64::INFINITY);
            Ok(())
        },
        3.0,
        &[0.0],
        &Options::default(),
    )
    .unwrap();
    let error = stopped(at_once.step(f64::MAX));
    assert!(matches!(error.cause, Cause::NotFinite { t: 3.0, component: 0, .. }), "{error}");
    assert_eq!((error.t, error.step), (3.0, 0.0));
}

#[test]
fn a_recoverable_failure_is_retried_with_a_smaller_step() {
    // y' = -sqrt(y), y = (1 - t/2)^2 until t = 2: long steps leave the domain y >= 0.
    let mut refusals = 0;
    let root = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        if y[0] < 0.0 {
            refusals += 1;
            return Err(Failure::Recoverable(format!("y = {} is negative", y[0])));
        }
        ydot[0] = -y[0].sqrt();
        Ok(())
    };
    // The first step reaches far beyond t = 2.
    let options = Options::default().initial_step(8.0);
    let mut solver = DormandPrince::new(root, 0.0, &[1.0], &options).unwrap();
    let y = at(&mut solver, 1.9)[0];
    // Below the tolerance, 1e-6 of a value of size 1, as errors do not grow.
    assert!((y - 0.0025).abs() < 2e-7, "{y}");
    let refused = solver.statistics().refused_steps;
    assert!(refused > 0);
    drop(solver);
    assert_eq!(refusals, refused);
}

#[test]
fn a_refusal_at_every_step_size_says_what_the_right_hand_side_said() {
    let wall = |t: f64, _y: &[f64], ydot: &mut [f64]| {
        if t > 0.25 {
            return Err(Failure::Recoverable("behind the wall".into()));
        }
        ydot[0] = 1.0;
        Ok(())
    };
    let mut solver = DormandPrince::new(wall, 0.0, &[0.0], &Options::default()).unwrap();
    let error = stopped(solver.solve_to(1.0));
    match &error.cause {
        Cause::Rejected { callback: Callback::Rhs, t, message } => {
            let step = error.step;
            assert!((t - 0.25).abs() < 1e-10 && step < 1e-10, "t = {t}, step {step}");
            assert_eq!(message, "behind the wall");
        }
        _ => panic!("{error}"),
    }
}

#[test]
fn a_fatal_failure_is_handed_on_as_the_source() {
    let broken = |t: f64, _y: &[f64], ydot: &mut [f64]| {
        ydot[0] = 1.0;
        if t > 0.5 {
            "not a number".parse::<f64>().map(drop)?
        }
        Ok(())
    };
    let mut solver = DormandPrince::new(broken, 0.0, &[0.0], &Options::default()).unwrap();
    let error = stopped(solver.solve_to(1.0));
    assert_eq!(error.cause, Cause::Fatal(Callback::Rhs));
    assert!(error.t <= 0.5 && error.t + error.step > 0.5, "{error}");
    assert!(error.source().unwrap().downcast_ref::<std::num::ParseFloatError>().is_some());
}

#[test]
fn a_singularity_ends_in_step_underflow() {
    // y' = y^2, y(0) = 1: y = 1 / (1 - t).
    let blow_up = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot[0] = y[0] * y[0];
        Ok(())
    };
    let mut solver = DormandPrince::new(blow_up, 0.0, &[1.0], &Options::default()).unwrap();
    let error = stopped(solver.solve_to(2.0));
    assert_eq!(error.cause, Cause::ErrorTest);
    // The position of the singularity moves with the error, rtol 1e-6.
    assert!((error.t - 1.0).abs() < 1e-5, "{error}");
}

#[test]
fn too_many_steps_says_why_and_can_be_continued() {
    let options = Options::default().max_steps(200);
    let mut stiff = DormandPrince::new(prothero(1e4), 0.0, &[0.0], &options).unwrap();
    let error = stopped(stiff.solve_to(1.0));
    match &error.cause {
        Cause::TooManySteps { target, steps, notice } => {
            assert_eq!((error.t, *target, *steps), (stiff.t(), 1.0, 200));
            assert!(notice.is_some() && error.to_string().contains("implicit"), "{error}");
        }
        _ => panic!("{error}"),
    }
    assert_eq!(stiff.statistics().steps, 200);
    let reached = stiff.t();
    assert!(stiff.solve_to(1.0).is_err() && stiff.t() > reached);

    let options = Options::default().max_steps(3);
    let mut smooth = DormandPrince::new(pendulum, 0.0, &[0.0, 0.0], &options).unwrap();
    let message = smooth.solve_to(100.0).unwrap_err().to_string();
    assert!(message.contains("max_steps"), "{message}");
}

#[test]
fn time_goes_forward_only() {
    let mut solver = DormandPrince::new(logistic, 1.0, &[0.1], &Options::default()).unwrap();
    let backward = solver.solve_to(0.0).unwrap_err().to_string();
    let stop = solver.set_stop_time(Some(0.5)).unwrap_err().to_string();
    for message in [backward, stop] {
        assert!(message.contains("forward only"), "{message}");
    }
    // Within the last step is not backward.
    solver.solve_to(2.0).unwrap();
    let end = solver.t();
    solver.solve_to(2.0).unwrap();
    assert_eq!(solver.t(), end);
    assert!(solver.interpolate(0.5, 0, &mut [0.0]).is_err());
}

#[test]
fn bad_input_is_named_with_its_value() {
    let good = Options::default;
    let start =
        |y: &[f64], options: Options| DormandPrince::new(logistic, 0.0, y, &options).map(drop);
    let cases = [
        (
            start(&[1.0], Options::new(0.0, 0.0)),
            "atol = 0 cannot be used: unknown 0 has no rtol either",
        ),
        (start(&[1.0], Options::new(1e-15, 1e-9)), "rtol = 0.000000000000001"),
        (start(&[1.0], Options::new(1.0, 1e-9)), "rtol = 1"),
        (start(&[1.0], Options::new(f64::NAN, 1e-9)), "rtol = NaN"),
        (start(&[1.0], Options::new(1e-6, -1.0)), "atol = -1"),
        (start(&[1.0, 1.0], Options::new(1e-6, [1.0, 0.0])), "atol = 0"),
        (start(&[1.0], Options::new(1e-6, [1.0, 1.0])), "length of atol = 2"),
        (start(&[1.0], good().initial_step(-1.0)), "initial_step = -1"),
        (start(&[1.0], good().initial_step(0.0)), "initial_step = 0"),
        (start(&[1.0], good().max_step(-1.0)), "max_step = -1"),
        (start(&[1.0], good().max_steps(0)), "max_steps = 0"),
        (start(&[], good()), "length of y0 = 0"),
        (start(&[1.0, f64::NAN], good()), "y0 = NaN in component 1"),
    ];
    for (result, expected) in cases {
        let message = result.unwrap_err().to_string();
        assert!(message.starts_with(expected), "{message:?} should start with {expected:?}");
    }
    let mut solver = DormandPrince::new(logistic, 0.0, &[0.1], &good()).unwrap();
    assert!(solver.reinit(0.0, &[0.1, 0.2]).unwrap_err().to_string().contains("1 unknowns"));
    assert!(solver.interpolate(0.0, 1, &mut [0.0]).is_err());
}
