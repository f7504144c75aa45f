//! Which steps are taken: stability, stop times, restarts.

use super::*;

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
        assert!((solver.y()[0] - stop.exp()).abs() < 1e-8);
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
