//! The explicit Runge-Kutta integrator against closed forms, published values and its own promises.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::error::Error as _;

use pliant::integrate::{AbsoluteTolerance, Callback, Cause, IntegrationError};
use pliant::ode::{Failure, Ode};
use pliant::rk::{DormandPrince, Error, Integrator, Options, Reached};

type Rhs = Result<(), Failure>;

/// y' = y (1 - y), y(0) = 1/10: y = 1 / (1 + 9 exp(-t)).
fn logistic(_t: f64, y: &[f64], ydot: &mut [f64]) -> Rhs {
    ydot[0] = y[0] * (1.0 - y[0]);
    Ok(())
}

fn logistic_exact(t: f64) -> f64 {
    1.0 / (1.0 + 9.0 * (-t).exp())
}

/// Pendulum of length 1 by its angle from the horizontal. From rest at angle 0 it swings over pi
/// and back in exactly 2 with this gravity.
fn pendulum(_t: f64, y: &[f64], ydot: &mut [f64]) -> Rhs {
    let gravity = 13.750371636040746; // rounded from 13.750371636040745654980191559621
    ydot[0] = y[1];
    ydot[1] = -gravity * y[0].cos();
    Ok(())
}

/// y' = -lambda (y - cos t), y(0) = 0: smooth and slow after 1/lambda, stiff when lambda is large
/// (E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", (IV.1.1)).
fn prothero(lambda: f64) -> impl FnMut(f64, &[f64], &mut [f64]) -> Rhs {
    move |t, y, ydot| {
        ydot[0] = -lambda * (y[0] - t.cos());
        Ok(())
    }
}

fn prothero_exact(lambda: f64, t: f64) -> f64 {
    let scale = lambda / (lambda * lambda + 1.0);
    scale * (lambda * t.cos() + t.sin() - lambda * (-lambda * t).exp())
}

/// Steps of size h whatever the error.
fn fixed_step(h: f64) -> Options {
    Options::new(0.5, 1e6).initial_step(h).max_step(h)
}

/// The error of an integration that stopped.
fn stopped<T: std::fmt::Debug>(result: Result<T, Error>) -> IntegrationError {
    match result {
        Err(Error::Integration(error)) => *error,
        other => panic!("{other:?}"),
    }
}

/// A fixed sequence of numbers in (0, 1) that looks random.
fn scattered(count: u32) -> impl Iterator<Item = f64> {
    (1..=count).map(|k| (f64::from(k) * 0.618_033_988_749_895).fract())
}

/// The solution at time `t`.
fn at<S: Ode>(solver: &mut DormandPrince<S>, t: f64) -> &[f64] {
    solver.solve_to(t).unwrap();
    solver.y()
}

#[test]
fn the_order_of_the_solution_is_five() {
    let error = |h: f64| {
        let mut solver = DormandPrince::new(logistic, 0.0, &[0.1], &fixed_step(h)).unwrap();
        (at(&mut solver, 2.0)[0] - logistic_exact(2.0)).abs()
    };
    // Observed order between successive halvings; 0.2 is what higher terms leave at these h.
    for h in [0.125, 0.0625] {
        let order = (error(h) / error(h / 2.0)).log2();
        assert!((order - 5.0).abs() < 0.2, "order {order} at h = {h}");
    }
}

#[test]
fn the_order_of_dense_output_is_four_and_of_its_derivative_three() {
    // Largest error within one step from exact data: O(h^5) for order 4. Hermite interpolation
    // without the last term of the extension would show 4.
    let errors = |h: f64| {
        let t0 = 0.7;
        let start = [logistic_exact(t0)];
        let mut solver = DormandPrince::new(logistic, t0, &start, &fixed_step(h)).unwrap();
        solver.step(f64::MAX).unwrap();
        scattered(50).fold((0.0_f64, 0.0_f64), |(in_y, in_slope), theta| {
            let t = t0 + theta * h;
            let (mut y, mut slope) = ([0.0], [0.0]);
            solver.interpolate(t, 0, &mut y).unwrap();
            solver.interpolate(t, 1, &mut slope).unwrap();
            let exact = logistic_exact(t);
            let exact_slope = exact * (1.0 - exact);
            (in_y.max((y[0] - exact).abs()), in_slope.max((slope[0] - exact_slope).abs()))
        })
    };
    for h in [0.4, 0.2] {
        let (coarse, fine) = (errors(h), errors(h / 2.0));
        let (order, slope_order) = ((coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2());
        assert!((order - 5.0).abs() < 0.4, "order {order} at h = {h}");
        assert!((slope_order - 4.0).abs() < 0.4, "order of the slope {slope_order} at h = {h}");
    }
}

#[test]
fn dense_output_meets_both_ends_of_the_step() {
    let mut solver = DormandPrince::new(pendulum, 0.0, &[0.0, 0.0], &Options::default()).unwrap();
    let mut before = (0.0, [0.0; 2]);
    for _ in 0..5 {
        before = (solver.t(), [solver.y()[0], solver.y()[1]]);
        solver.step(f64::MAX).unwrap();
    }
    let after = (solver.t(), [solver.y()[0], solver.y()[1]]);
    for (t, y) in [before, after] {
        let (mut value, mut slope, mut f) = ([0.0; 2], [0.0; 2], [0.0; 2]);
        solver.interpolate(t, 0, &mut value).unwrap();
        solver.interpolate(t, 1, &mut slope).unwrap();
        pendulum(t, &y, &mut f).unwrap();
        // Same numbers up to the rounding of h = t_new - t_old.
        for i in 0..2 {
            assert!((value[i] - y[i]).abs() < 1e-14, "{value:?} {y:?}");
            assert!((slope[i] - f[i]).abs() < 1e-12, "{slope:?} {f:?}");
        }
    }
}

#[test]
fn the_pendulum_returns_after_its_exact_period() {
    let options = Options::new(1e-12, 1e-13);
    let mut solver = DormandPrince::new(pendulum, 0.0, &[0.0, 0.0], &options).unwrap();
    for period in 1..=5 {
        let t = 2.0 * f64::from(period);
        let angle = at(&mut solver, t)[0];
        // The turning point: the angle is flat in t there, the velocity is not.
        assert!(angle.abs() < 1e-10, "angle {angle} at t = {t}");
        let velocity = at(&mut solver, t)[1];
        assert!(velocity.abs() < 1e-9, "velocity {velocity} at t = {t}");
    }
    // Half a period: the other turning point, at -pi.
    solver.reinit(0.0, &[0.0, 0.0]).unwrap();
    let angle = at(&mut solver, 1.0)[0];
    assert!((angle + std::f64::consts::PI).abs() < 1e-10, "angle {angle}");
}

#[test]
fn the_error_shrinks_with_the_tolerance() {
    let error = |rtol: f64| {
        let options = Options::new(rtol, rtol);
        let mut solver = DormandPrince::new(pendulum, 0.0, &[0.0, 0.0], &options).unwrap();
        let y = at(&mut solver, 4.0);
        y[0].abs().max(y[1].abs())
    };
    let errors: Vec<f64> = [1e-4, 1e-6, 1e-8, 1e-10].map(error).into();
    for pair in errors.windows(2) {
        // Proportional to rtol, within a factor 5 either way.
        let ratio = pair[0] / pair[1];
        assert!((20.0..500.0).contains(&ratio), "errors {errors:?}");
    }
    // The global error stays within the local tolerance times the growth of errors over two
    // periods, a few hundred for this pendulum.
    assert!(errors[3] < 500.0 * 1e-10, "errors {errors:?}");
}

#[test]
fn the_relative_tolerance_follows_the_solution() {
    let decay = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot[0] = -y[0];
        Ok(())
    };
    let options = Options::new(1e-6, 1e-30);
    let mut solver = DormandPrince::new(decay, 0.0, &[1.0], &options).unwrap();
    for t in [1.0, 10.0, 30.0] {
        let relative = at(&mut solver, t)[0] / (-t).exp() - 1.0;
        // Every step adds at most rtol, and there are four of them in a unit of time.
        assert!(relative.abs() < 4.0 * t * 1e-6, "{relative} at t = {t}");
    }
    // The start is where it was, and so are the steps that lead from it.
    let steps = solver.statistics().steps;
    solver.reinit(0.0, &[1.0]).unwrap();
    solver.solve_to(30.0).unwrap();
    assert_eq!(solver.statistics().steps, steps);
}

#[test]
fn each_component_has_its_absolute_tolerance() {
    // Copies of one equation in units 1 and 1e6: with atol in the same units the error norm (a mean,
    // not a sum), and so every step, is the same as for one copy.
    let copies = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        for (slope, value) in ydot.iter_mut().zip(y) {
            *slope = -value;
        }
        Ok(())
    };
    let run = |y: &[f64], atol: AbsoluteTolerance| {
        let options = Options::new(1e-14, atol);
        let mut solver = DormandPrince::new(copies, 0.0, y, &options).unwrap();
        solver.solve_to(3.0).unwrap();
        solver.statistics().steps
    };
    let same = run(&[1.0], AbsoluteTolerance::Scalar(1e-8));
    assert_eq!(run(&[1.0; 7], AbsoluteTolerance::Scalar(1e-8)), same);
    assert_eq!(run(&[1.0, 1e6], vec![1e-8, 1e-2].into()), same);
    assert!(run(&[1.0, 1e6], vec![1e-8, 1e-8].into()) > 3 * same);
}

#[test]
fn the_first_step_knows_the_time_scale() {
    let first_step = |rate: f64| {
        let decay = move |_t: f64, y: &[f64], ydot: &mut [f64]| {
            ydot[0] = -rate * y[0];
            Ok(())
        };
        let mut solver = DormandPrince::new(decay, 0.0, &[1.0], &Options::default()).unwrap();
        solver.step(f64::MAX).unwrap();
        assert_eq!(solver.statistics().error_test_failures, 0);
        rate * solver.t()
    };
    let reference = first_step(1.0);
    // The error estimate for y' = -y is about z^5/1000 at step z: rtol 1e-6 allows z = 0.25. The
    // first guess is meant to be cautious, but not by more than a factor of ten.
    assert!((0.025..0.25).contains(&reference), "{reference}");
    for rate in [1e-9, 1e-3, 1e3, 1e9, 1e15] {
        let scaled = first_step(rate);
        assert!((scaled / reference - 1.0).abs() < 1e-9, "{scaled} {reference}");
    }
}

/// Where |R(-x)| = 1 for the stability polynomial of the method: 3.3066 by bisection.
fn stability_limit() -> f64 {
    let r = |x: f64| {
        let z = -x;
        1.0 + z
            * (1.0
                + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0 * (1.0 + z / 5.0 * (1.0 + z / 5.0)))))
    };
    let (mut low, mut high) = (2.0, 5.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if r(middle).abs() < 1.0 { low = middle } else { high = middle }
    }
    low
}

#[test]
fn on_a_stiff_problem_stability_limits_the_step_and_the_notice_says_so() {
    for lambda in [1e3, 1e4, 1e5] {
        let options = Options::new(1e-4, 1e-7);
        let mut solver = DormandPrince::new(prothero(lambda), 0.0, &[0.0], &options).unwrap();
        let y = at(&mut solver, 1.5)[0];
        // Slow, but right: rtol 1e-4 on a solution of size at most 1, errors damped.
        let exact = prothero_exact(lambda, 1.5);
        assert!((y - exact).abs() < 1e-4, "y = {y}, exact {exact}");

        let statistics = solver.statistics();
        let expected = 1.5 * lambda / stability_limit();
        let ratio = statistics.steps as f64 / expected;
        // The first steps resolve the transient; near the limit steps vary by a few per cent.
        assert!(
            (0.95..1.15).contains(&ratio),
            "lambda {lambda}: {statistics:?}, {expected} expected"
        );

        let limit = solver.stability_limit().expect("a stiff problem is noticed");
        assert!((limit.rate / lambda - 1.0).abs() < 0.2, "{limit:?}");
        assert!((limit.step * lambda / stability_limit() - 1.0).abs() < 0.2, "{limit:?}");
        assert!(limit.time < 0.2, "{limit:?}");
        assert!(limit.steps as f64 > 0.9 * expected, "{limit:?}");
        let notice = limit.to_string();
        assert!(notice.contains("implicit"), "{notice}");
    }
}

#[test]
fn no_stability_notice_where_accuracy_limits_the_step() {
    for rtol in [1e-3, 1e-6, 1e-10] {
        let options = Options::new(rtol, rtol);
        let mut pendulum = DormandPrince::new(pendulum, 0.0, &[0.0, 0.0], &options).unwrap();
        pendulum.solve_to(20.0).unwrap();
        assert_eq!(pendulum.stability_limit(), None);
        let mut mild = DormandPrince::new(prothero(1.0), 0.0, &[0.0], &options).unwrap();
        mild.solve_to(20.0).unwrap();
        assert_eq!(mild.stability_limit(), None);
    }
}

#[test]
fn the_stop_time_is_hit_exactly_and_never_passed() {
    // The second is shorter than the step that the start would suggest.
    for stop in [1.0 / 3.0, 1e-9] {
        let forcing = |t: f64, _y: &[f64], ydot: &mut [f64]| {
            assert!(t <= stop, "evaluated at {t}");
            ydot[0] = t.exp();
            Ok(())
        };
        let mut solver = DormandPrince::new(forcing, 0.0, &[1.0], &Options::default()).unwrap();
        solver.set_stop_time(Some(stop)).unwrap();
        assert_eq!(solver.solve_to(0.5).unwrap(), Reached::StopTime);
        assert_eq!(solver.t(), stop);
        assert!((solver.y()[0] - stop.exp()).abs() < 1e-6);
        // It holds once, and cannot be set behind or at the time reached.
        assert!(solver.set_stop_time(Some(stop)).is_err());
        assert!(solver.set_stop_time(Some(0.5 * stop)).is_err());
    }
}

#[test]
fn a_step_cut_short_by_the_stop_time_does_not_slow_the_next() {
    let solve = |stops: &[f64]| {
        let mut solver =
            DormandPrince::new(pendulum, 0.0, &[0.0, 0.0], &Options::default()).unwrap();
        for stop in stops {
            solver.set_stop_time(Some(*stop)).unwrap();
            solver.solve_to(*stop).unwrap();
        }
        solver.set_stop_time(None).unwrap();
        solver.solve_to(2.0).unwrap();
        solver.statistics().steps
    };
    let free = solve(&[]);
    // One extra step for each stop and a few because the others moved; growing again from 1e-9
    // would take ten.
    let stopped = solve(&[1.0, 1.0 + 1e-9, 1.0 + 2e-9]);
    assert!(stopped <= free + 6, "{stopped} steps with stops, {free} without");
}

#[test]
fn output_times_do_not_change_the_steps() {
    let steps = |outputs: u32| {
        let mut solver =
            DormandPrince::new(pendulum, 0.0, &[0.0, 0.0], &Options::default()).unwrap();
        for k in 1..=outputs {
            solver.solve_to(2.0 * f64::from(k) / f64::from(outputs)).unwrap();
        }
        (solver.t(), solver.y().to_vec(), solver.statistics())
    };
    assert_eq!(steps(1), steps(1000));
}

#[test]
fn reinit_repeats_the_run_bit_for_bit() {
    let mut solver = DormandPrince::new(pendulum, 0.0, &[0.0, 0.0], &Options::default()).unwrap();
    solver.set_stop_time(Some(1.7)).unwrap();
    let first = at(&mut solver, 1.7).to_vec();
    let statistics = solver.statistics();
    solver.reinit(0.0, &[0.0, 0.0]).unwrap();
    assert_eq!(solver.statistics().evaluations, 0);
    solver.set_stop_time(Some(1.7)).unwrap();
    assert_eq!(at(&mut solver, 1.7), first);
    assert_eq!(solver.statistics(), statistics);
}

#[test]
fn a_changed_system_is_evaluated_afresh() {
    struct Pull(f64);
    impl Ode for Pull {
        fn rhs(&mut self, _t: f64, _y: &[f64], ydot: &mut [f64]) -> Rhs {
            ydot[0] = self.0;
            Ok(())
        }
    }
    let mut solver = DormandPrince::new(Pull(1.0), 0.0, &[0.0], &Options::default()).unwrap();
    solver.set_stop_time(Some(1.0)).unwrap();
    solver.solve_to(1.0).unwrap();
    solver.system_mut().0 = -2.0;
    solver.set_stop_time(Some(2.0)).unwrap();
    // 1 up, then 2 down; a stale slope at t = 1 would give something else. Rounding only.
    let y = at(&mut solver, 2.0)[0];
    assert!((y + 1.0).abs() < 1e-14, "{y}");
    assert_eq!(solver.into_system().0, -2.0);
}

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
    // Tolerance 1e-6 of a value of size 1; errors do not grow.
    assert!((y - 0.0025).abs() < 1e-5, "{y}");
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
        (start(&[1.0], Options::new(0.0, 1e-9)), "rtol = 0"),
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

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

struct CountingAllocator;

// SAFETY: hands everything on to the system's allocator.
unsafe impl GlobalAlloc for CountingAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.set(ALLOCATIONS.get() + 1);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

#[test]
fn stepping_allocates_nothing() {
    let mut solver = DormandPrince::new(pendulum, 0.0, &[0.0, 0.0], &Options::default()).unwrap();
    let mut y = [0.0; 2];
    let before = ALLOCATIONS.get();
    for period in 1..20 {
        solver.solve_to(2.0 * f64::from(period)).unwrap();
        solver.step(f64::MAX).unwrap();
        solver.interpolate(solver.t(), 0, &mut y).unwrap();
    }
    solver.reinit(0.0, &[0.0, 0.0]).unwrap();
    solver.solve_to(2.0).unwrap();
    assert_eq!(ALLOCATIONS.get(), before);
    assert!(before > 0);
}

#[test]
fn solvers_can_move_between_threads() {
    fn check<T: Send + Sync>() {}
    check::<DormandPrince<fn(f64, &[f64], &mut [f64]) -> Rhs>>();
    check::<Error>();
}

#[test]
fn only_the_last_step_is_interpolated() {
    let (mut y, y0) = ([0.0; 2], [0.3, -0.2]);
    let mut solver = DormandPrince::new(pendulum, 1.0, &y0, &Options::default()).unwrap();
    // before the first step the start alone is known, and after a restart none of the run before
    for (start, state) in [(1.0, y0), (1.05, [0.7, 0.1])] {
        solver.reinit(start, &state).unwrap();
        assert_eq!(solver.last_step(), (start, start));
        solver.interpolate(start, 0, &mut y).unwrap();
        assert_eq!(y, state);
        for t in [1.0, 1.01, 1.05, 1.06] {
            let message = solver.interpolate(t, 1, &mut y).unwrap_err().to_string();
            assert!(message.contains("step"), "{message}");
            assert!(t == start || solver.interpolate(t, 0, &mut y).is_err());
        }
        solver.solve_to(2.0).unwrap();
    }
    assert!(solver.interpolate(2.0, 2, &mut y).unwrap_err().to_string().contains("derivative = 2"));
}
