//! Weights of the error norm, bounds of the step size, and controllers of ARKODE.

use std::panic::{AssertUnwindSafe, catch_unwind};

use pliant::{
    ode::Failure,
    sundials::{
        Arkode, ArkodeOptions, ButcherTable, Callback, Cause, Controller, Cvode, CvodeOptions,
        Error, Ida, IdaOptions, Integrator, StepControl,
    },
};

const RATES: [f64; 3] = [-0.3, -40.0, -900.0];

fn decays(t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    let forcing = (3.0 * t).sin();
    (0..3).for_each(|i| ydot[i] = RATES[i] * (y[i] - forcing));
    Ok(())
}

fn residual(t: f64, y: &[f64], yp: &[f64], residual: &mut [f64]) -> Result<(), Failure> {
    decays(t, y, residual)?;
    residual.iter_mut().zip(yp).for_each(|(r, yp)| *r -= yp);
    Ok(())
}

const Y0: [f64; 3] = [1.0, 2.0, 0.5];

/// A solver of each kind that has taken its options from these.
fn solvers(
    change_cvode: impl Fn(CvodeOptions) -> CvodeOptions,
    change_ida: impl Fn(IdaOptions) -> IdaOptions,
    change_arkode: impl Fn(ArkodeOptions) -> ArkodeOptions,
) -> (Cvode<impl pliant::ode::Ode>, Ida<impl pliant::ode::Dae>, Arkode<impl pliant::ode::Ode>) {
    let (rtol, atol) = (1e-5, [1e-8, 1e-7, 1e-6]);
    let mut yp0 = [0.0; 3];
    decays(0.0, &Y0, &mut yp0).unwrap();
    (
        Cvode::new(decays, 0.0, &Y0, &change_cvode(CvodeOptions::new(rtol, atol))).unwrap(),
        Ida::new(residual, 0.0, &Y0, &yp0, &change_ida(IdaOptions::new(rtol, atol))).unwrap(),
        Arkode::new(decays, 0.0, &Y0, &change_arkode(ArkodeOptions::new(rtol, atol))).unwrap(),
    )
}

fn end(solver: &mut impl Integrator) -> (Vec<f64>, u64) {
    solver.solve_to(2.0).unwrap();
    (solver.y().to_vec(), solver.statistics().steps)
}

/// The weights of the tolerances, computed by the user, give the same run to the last bit.
#[test]
fn own_weights_take_the_place_of_tolerances() {
    let weigh = |y: &[f64], weights: &mut [f64]| {
        for (i, atol) in [1e-8, 1e-7, 1e-6].into_iter().enumerate() {
            weights[i] = 1.0 / (1e-5 * y[i].abs() + atol);
        }
    };
    let (mut cvode, mut ida, mut arkode) = solvers(|o| o, |o| o, |o| o);
    let (mut own_cvode, mut own_ida, mut own_arkode) =
        solvers(|o| o.error_weights(weigh), |o| o.error_weights(weigh), |o| o.error_weights(weigh));
    assert_eq!(end(&mut own_cvode), end(&mut cvode));
    assert_eq!(end(&mut own_ida), end(&mut ida));
    assert_eq!(end(&mut own_arkode), end(&mut arkode));

    // a hundredth of the error of each is a hundredth of the tolerances, but for rounding
    let strict = move |y: &[f64], weights: &mut [f64]| {
        weigh(y, weights);
        weights.iter_mut().for_each(|weight| *weight *= 100.0);
    };
    let (mut strict_cvode, ..) = solvers(|o| o.error_weights(strict), |o| o, |o| o);
    let options = CvodeOptions::new(1e-7, [1e-10, 1e-9, 1e-8]);
    let mut same = Cvode::new(decays, 0.0, &Y0, &options).unwrap();
    let [(own, steps), (given, expected)] = [end(&mut strict_cvode), end(&mut same)];
    assert!(steps.abs_diff(expected) < 5 && steps > cvode.statistics().steps);
    assert!(own.iter().zip(&given).all(|(own, given)| (own - given).abs() < 1e-7));
}

#[test]
fn unusable_weights_stop_the_run_with_their_unknown() {
    let zero = |y: &[f64], weights: &mut [f64]| {
        weights.fill(1e6);
        weights[1] = if y[1] < 1.0 { 0.0 } else { 1e6 };
    };
    let (mut cvode, mut ida, mut arkode) =
        solvers(|o| o.error_weights(zero), |o| o.error_weights(zero), |o| o.error_weights(zero));
    for outcome in [cvode.solve_to(2.0), ida.solve_to(2.0), arkode.solve_to(2.0)] {
        let Err(Error::Integration(error)) = outcome else { panic!("{outcome:?}") };
        assert_eq!(error.cause, Cause::Fatal(Callback::ErrorWeights), "{error}");
        assert!(error.source.unwrap().to_string().contains("unknown 1 is 0"));
        assert!(error.t > 0.0 && error.t < 0.1);
    }
    let panics = |_: &[f64], _: &mut [f64]| panic!("weights");
    let (mut cvode, ..) = solvers(|o| o.error_weights(panics), |o| o, |o| o);
    let panic = catch_unwind(AssertUnwindSafe(|| cvode.solve_to(2.0))).unwrap_err();
    assert_eq!(*panic.downcast_ref::<&str>().unwrap(), "weights");
}

/// All ratios of a step size to the one before.
fn ratios(solver: &mut impl Integrator) -> Vec<f64> {
    let mut sizes = Vec::new();
    while solver.t() < 2.0 {
        solver.step(4.0).unwrap();
        let (start, end) = solver.last_step();
        sizes.push(end - start);
    }
    sizes.windows(2).map(|pair| pair[1] / pair[0]).collect()
}

/// Bounds hold for every step, but for rounding of the times, and runs without them exceed each.
#[test]
fn step_sizes_change_within_their_bounds() {
    let least = |ratios: &[f64]| ratios.iter().copied().fold(f64::INFINITY, f64::min);
    let most = |ratios: &[f64]| ratios.iter().copied().fold(0.0, f64::max);
    let plain = solvers(|o| o, |o| o, |o| o);
    let control = StepControl::new().max_growth(1.7).min_reduction(0.8).keep_between(0.99, 1.01);
    let bound = control.first_growth(1.6);
    let bounded =
        solvers(|o| o.step_control(bound), |o| o.step_control(control), |o| o.step_control(bound));
    let (mut a, mut b, mut c) = plain;
    let free = [ratios(&mut a), ratios(&mut b), ratios(&mut c)];
    let (mut a, mut b, mut c) = bounded;
    let bounded = [ratios(&mut a), ratios(&mut b), ratios(&mut c)];
    for ((free, bounded), name) in free.iter().zip(&bounded).zip(["CVODE", "IDA", "ARKODE"]) {
        println!(
            "{name}: {:.3} to {:.3}, {:.3} to {:.3}",
            least(free),
            most(free),
            least(bounded),
            most(bounded)
        );
        assert!(most(free) > 1.8);
        // IDA doubles its steps and raises its order until a step fails or the order falls
        let doubled = if name == "IDA" {
            1 + bounded[1..].iter().take_while(|r| **r > 1.99).count()
        } else {
            0
        };
        let later = &bounded[doubled.max(1)..];
        assert!(name == "IDA" || bounded[0] < 1.6 + 1e-9, "{name}: {}", bounded[0]);
        assert!(later.len() > 20 && most(later) < 1.7 + 1e-9, "{name}: {}", most(later));
    }
    // steps that are kept as long as they may be longer by less than a factor of three; failures shorten them
    let keep = StepControl::new().keep_between(0.5, 3.0);
    let (mut a, ..) = solvers(|o| o.step_control(keep), |o| o, |o| o);
    let kept = ratios(&mut a);
    // CVODE does not look at the bounds for the second step
    assert!(kept[2..].iter().all(|r| *r < 1.0 + 1e-6 || *r > 3.0 - 1e-6));
}

#[test]
fn unusable_bounds_are_named() {
    let refused = |control: StepControl| {
        let options = CvodeOptions::new(1e-6, 1e-9).step_control(control);
        Cvode::new(decays, 0.0, &Y0, &options).unwrap_err().to_string()
    };
    let new = StepControl::new;
    for (control, name) in [
        (new().max_growth(1.0), "max_growth"),
        (new().first_growth(f64::NAN), "first_growth"),
        (new().min_reduction(1.0), "min_reduction"),
        (new().keep_between(1.0, 2.0), "keep_between"),
        (new().keep_between(0.5, f64::INFINITY), "keep_between"),
        (new().after_error_failure(0.0), "after_error_failure"),
        (new().after_convergence_failure(1.5), "after_convergence_failure"),
    ] {
        assert!(refused(control).contains(name), "{}", refused(control));
    }
    let options = IdaOptions::new(1e-6, 1e-9).step_control(new().first_growth(10.0));
    let error = Ida::new(residual, 0.0, &Y0, &[0.0; 3], &options).unwrap_err().to_string();
    assert!(error.contains("first_growth") && error.contains("IDA"), "{error}");
    for (options, name) in [
        (ArkodeOptions::new(1e-6, 1e-9).safety_factor(1.0), "safety_factor"),
        (ArkodeOptions::new(1e-6, 1e-9).error_bias(0.5), "error_bias"),
    ] {
        let error = Arkode::new(decays, 0.0, &Y0, &options).unwrap_err().to_string();
        assert!(error.contains(name), "{error}");
    }
}

/// Where y' = f(t), the error estimate of the method of Heun and Euler is h (f(t + h) - f(t))/2: the steps follow from
/// the formulas of the controllers. (Exponents of the filters: Soederlind 2003, table I; h is raised to the order 2.)
#[test]
fn controllers_are_their_formulas() {
    const ATOL: f64 = 1e-7;
    let f = |t: f64| (0.5 * t).exp() + 0.1 * t.sin();
    let errors = |size: f64, t: f64| 0.5 * size * (f(t + size) - f(t)).abs() / ATOL;
    type Exponents = ([f64; 3], [f64; 2], f64);
    // the last is by ARKODE's user guide, for the order 1 of the estimate; it swings more and more, and is left in time
    let cases: [(Controller, Exponents); 5] = [
        (Controller::H211, ([0.25, 0.25, 0.0], [-0.25, 0.0], 2.0)),
        (Controller::H0211, ([0.5, 0.5, 0.0], [-0.5, 0.0], 2.0)),
        (Controller::H312, ([0.125, 0.25, 0.125], [-0.375, -0.125], 2.0)),
        (Controller::H0321, ([1.25, 0.5, -0.75], [0.25, 0.75], 2.0)),
        (Controller::Pi, ([0.8, -0.31, 0.0], [0.0, 0.0], 1.0)),
    ];
    for (controller, (exponents, ratios, order)) in cases {
        let options = ArkodeOptions::new(0.0, ATOL)
            .table(ButcherTable::explicit(2).unwrap())
            .initial_step(5e-4)
            .controller(controller)
            .safety_factor(0.9)
            .error_bias(1.2)
            .step_control(StepControl::new().keep_between(1.0 - 1e-9, 1.0 + 1e-9));
        let rhs = |t: f64, _: &[f64], ydot: &mut [f64]| {
            ydot[0] = f(t);
            Ok(())
        };
        let mut solver = Arkode::new(rhs, 0.0, &[0.0], &options).unwrap();
        let (mut sizes, mut estimates) = (Vec::new(), Vec::new());
        for step in 0..if order == 1.0 { 20 } else { 60 } {
            solver.step(100.0).unwrap();
            let (start, end) = solver.last_step();
            if step >= 4 {
                let at = |back: usize| (sizes[step - 1 - back], estimates[step - 1 - back]);
                let [(h1, e1), (h2, e2), (h3, e3)] = [0, 1, 2].map(at);
                let mut predicted: f64 = 0.9 * h1;
                for (e, k) in [e1, e2, e3].into_iter().zip(exponents) {
                    predicted *= f64::powf(1.2 * e, -k / order);
                }
                predicted *= f64::powf(h1 / h2, ratios[0]) * f64::powf(h2 / h3, ratios[1]);
                let error = (end - start) / predicted - 1.0;
                // rounding of the times, magnified by small differences of f
                assert!(error.abs() < 1e-6, "{controller:?}, step {step}: {error:e}");
            }
            sizes.push(end - start);
            estimates.push(errors(end - start, start));
        }
        assert_eq!(solver.statistics().error_test_failures, 0);
    }
}
