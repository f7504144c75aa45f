//! Steering an integration: roots, stop times, dense output, single steps, restarts, threads.

use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    thread,
};

use pliant::{
    ode::{Borrowed, Dae, Failure, Ode},
    samples::{Hires, Robertson},
    sundials::{
        Arkode, ArkodeOptions, ButcherTable, Cvode, CvodeOptions, Error, Ida, IdaOptions,
        Integrator, Jacobian, LinearSolver, Multistep, Reached,
    },
};

/// y'' = -y as a system, with the exact solution (cos t, -sin t), and roots of y and of t - 5.
struct Oscillator {
    latest: f64,
}

impl Oscillator {
    fn new() -> Self {
        Self { latest: 0.0 }
    }
}

impl Ode for Oscillator {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.latest = self.latest.max(t);
        ydot.copy_from_slice(&[y[1], -y[0]]);
        Ok(())
    }

    fn root_count(&self) -> usize {
        2
    }

    fn roots(&mut self, t: f64, y: &[f64], g: &mut [f64]) -> Result<(), Failure> {
        g.copy_from_slice(&[y[0], t - 5.0]);
        Ok(())
    }
}

impl Dae for Oscillator {
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        self.latest = self.latest.max(t);
        r.copy_from_slice(&[yp[0] - y[1], yp[1] + y[0]]);
        Ok(())
    }

    fn root_count(&self) -> usize {
        2
    }

    fn roots(&mut self, t: f64, y: &[f64], _yp: &[f64], g: &mut [f64]) -> Result<(), Failure> {
        Ode::roots(self, t, y, g)
    }
}

fn oscillator() -> Cvode<Oscillator> {
    let options = CvodeOptions::new(1e-9, 1e-9).method(Multistep::Adams);
    Cvode::new(Oscillator::new(), 0.0, &[1.0, 0.0], &options).unwrap()
}

fn oscillator_by_runge_kutta(table: ButcherTable) -> Arkode<Oscillator> {
    let options = ArkodeOptions::new(1e-9, 1e-9).table(table);
    Arkode::new(Oscillator::new(), 0.0, &[1.0, 0.0], &options).unwrap()
}

fn oscillating_dae() -> Ida<Oscillator> {
    let options = IdaOptions::new(1e-9, 1e-9);
    Ida::new(Oscillator::new(), 0.0, &[1.0, 0.0], &[0.0, -1.0], &options).unwrap()
}

// The integrators have the same methods; one text tests all.
macro_rules! for_multistep {
    ($solver:ident => $test:block) => {{
        {
            let mut $solver = oscillator();
            $test
        }
        {
            let mut $solver = oscillating_dae();
            $test
        }
    }};
}

macro_rules! for_all {
    ($solver:ident => $test:block) => {{
        for_multistep!($solver => $test);
        for table in [ButcherTable::implicit(4).unwrap(), ButcherTable::explicit(5).unwrap()] {
            let mut $solver = oscillator_by_runge_kutta(table);
            $test
        }
    }};
}

#[test]
fn roots_are_found_with_their_direction() {
    use std::f64::consts::FRAC_PI_2;
    for_all!(solver => {
        for (t, signs) in [(FRAC_PI_2, [-1, 0]), (3.0 * FRAC_PI_2, [1, 0]), (5.0, [0, 1])] {
            assert_eq!(solver.solve_to(7.0).unwrap(), Reached::Root);
            assert!((solver.t() - t).abs() < 1e-6, "{} is not {t}", solver.t());
            assert_eq!(solver.roots_found(), signs);
        }
        assert_eq!(solver.solve_to(7.0).unwrap(), Reached::Time);
        assert_eq!(solver.t(), 7.0);
        assert!((solver.y()[0] - 7f64.cos()).abs() < 1e-6);
        assert!(solver.statistics().root_evaluations > 0);
    });
}

#[test]
fn nothing_is_evaluated_beyond_a_stop_time() {
    for_all!(solver => {
        solver.set_stop_time(Some(0.7)).unwrap();
        assert_eq!(solver.solve_to(1.0).unwrap(), Reached::StopTime);
        assert_eq!(solver.t(), 0.7);
        assert_eq!(solver.system().latest, 0.7);
        assert!((solver.y()[0] - 0.7f64.cos()).abs() < 2e-7);
        // It holds once.
        assert_eq!(solver.solve_to(1.0).unwrap(), Reached::Time);
        // One that is the target.
        solver.set_stop_time(Some(1.3)).unwrap();
        assert_eq!(solver.solve_to(1.3).unwrap(), Reached::StopTime);
        assert_eq!(solver.solve_to(1.4).unwrap(), Reached::Time);
        assert_eq!(solver.t(), 1.4);
        // One that is taken back.
        solver.set_stop_time(Some(1.5)).unwrap();
        solver.set_stop_time(None).unwrap();
        assert_eq!(solver.solve_to(1.55).unwrap(), Reached::Time);
    });
}

#[test]
fn a_stop_time_that_is_taken_back_before_going_backwards() {
    for_all!(solver => {
        solver.set_stop_time(Some(-0.7)).unwrap();
        solver.set_stop_time(None).unwrap();
        assert_eq!(solver.solve_to(-1.0).unwrap(), Reached::Time);
        assert!((solver.y()[1] + (-1f64).sin()).abs() < 1e-6);
    });
}

#[test]
fn dense_output_is_as_accurate_as_the_steps() {
    for_multistep!(solver => {
        let mut out = [0.0; 2];
        let (mut at_steps, mut between, mut slopes) = (0f64, 0f64, 0f64);
        while solver.t() < 1.4 {
            assert_eq!(solver.step(2.0).unwrap(), Reached::Time);
            let (start, end) = solver.last_step();
            assert_eq!(end, solver.t());
            at_steps = at_steps.max((solver.y()[0] - end.cos()).abs());
            for i in 0..=4 {
                let t = start + (end - start) * f64::from(i) / 4.0;
                solver.interpolate(t, 0, &mut out).unwrap();
                between = between.max((out[0] - t.cos()).abs());
                solver.interpolate(t, 1, &mut out).unwrap();
                slopes = slopes.max((out[0] + t.sin()).abs());
            }
        }
        println!("errors: {at_steps:.1e} at steps, {between:.1e} between, slopes {slopes:.1e}");
        // The interpolating polynomial has the order of the method; its derivative loses one.
        assert!(at_steps < 1e-7 && between < 2.0 * at_steps + 1e-9, "{at_steps} {between}");
        assert!(slopes < 1e-5, "{slopes}");
    });
}

#[test]
fn output_times_do_not_change_the_steps() {
    let options = CvodeOptions::new(1e-9, 1e-9).initial_step(1e-6);
    let fresh = || Cvode::new(Oscillator::new(), 0.0, &[1.0, 0.0], &options).unwrap();
    let mut direct = fresh();
    direct.solve_to(1.5).unwrap();
    let mut sampled = fresh();
    for i in 1..=150 {
        sampled.solve_to(f64::from(i) * 0.01).unwrap();
    }
    assert_eq!(direct.statistics().steps, sampled.statistics().steps);
    assert_eq!(direct.y(), sampled.y());
}

#[test]
fn the_present_time_is_reached_without_a_step() {
    for_all!(solver => {
        assert_eq!(solver.solve_to(0.0).unwrap(), Reached::Time);
        assert_eq!(solver.statistics().steps, 0);
    });
}

#[test]
fn a_restart_repeats_the_run() {
    for_all!(solver => {
        solver.solve_to(1.0).unwrap();
        let (y, statistics) = (solver.y().to_vec(), solver.statistics());
        solver.set_stop_time(Some(1.1)).unwrap();
        restart(&mut solver);
        assert_eq!((solver.t(), solver.y()), (0.0, &[1.0, 0.0][..]));
        assert_eq!(solver.statistics().steps, 0);
        solver.solve_to(1.0).unwrap();
        assert_eq!((solver.y(), solver.statistics()), (&y[..], statistics));
    });
}

#[test]
fn without_a_step_only_the_start_itself_is_known() {
    for_all!(solver => {
        let mut out = [f64::NAN; 2];
        for again in [false, true] {
            if again {
                solver.solve_to(1.0).unwrap();
                restart(&mut solver);
            }
            assert_eq!(solver.last_step(), (0.0, 0.0));
            solver.interpolate(0.0, 0, &mut out).unwrap();
            assert_eq!(out, [1.0, 0.0]);
            for (t, derivative) in [(0.0, 1), (1e-3, 0), (-1e-3, 0)] {
                let error = solver.interpolate(t, derivative, &mut out).unwrap_err();
                assert!(matches!(error, Error::Input(_)), "{error:?}");
            }
            assert_eq!(out, [1.0, 0.0]);
        }
    });
}

#[test]
fn a_restart_forgets_the_direction_of_time() {
    for_all!(solver => {
        // Set and lifted, before C knows of it and after.
        for known in [0.0, 0.5] {
            solver.set_stop_time(Some(5.0)).unwrap();
            solver.solve_to(known).unwrap();
            solver.set_stop_time(None).unwrap();
            solver.solve_to(1.0).unwrap();
            restart(&mut solver);
            assert_eq!(solver.solve_to(-1.0).unwrap(), Reached::Time);
            assert!((solver.y()[1] + (-1f64).sin()).abs() < 1e-6);
            restart(&mut solver);
            // ARKODE refuses a stop time in the first step after time has turned.
            solver.solve_to(1.0).unwrap();
            restart(&mut solver);
        }
        // One that C has reached, and one at the same time.
        for _ in 0..2 {
            solver.set_stop_time(Some(0.5)).unwrap();
            assert_eq!(solver.solve_to(1.0).unwrap(), Reached::StopTime);
            restart(&mut solver);
        }
    });
}

/// y'' = -y until it is stopped.
struct Mortal {
    end: f64,
    how: fn() -> Failure,
}

impl Ode for Mortal {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        if t > self.end {
            return Err((self.how)());
        }
        ydot.copy_from_slice(&[y[1], -y[0]]);
        Ok(())
    }
}

impl Dae for Mortal {
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        self.rhs(t, y, r)?;
        r.iter_mut().zip(yp).for_each(|(r, yp)| *r -= yp);
        Ok(())
    }
}

#[test]
fn after_a_failure_time_and_state_belong_together() {
    let fatal: fn() -> Failure = || std::fmt::Error.into();
    let recoverable: fn() -> Failure = || Failure::Recoverable("no further".into());
    let panicking: fn() -> Failure = || panic!("no further");
    let (y0, yp0) = ([1.0, 0.0], [0.0, -1.0]);
    macro_rules! fail {
        ($solver:expr, $modes:ident) => {
            for &one_by_one in $modes {
                let mut solver = $solver;
                let failed = catch_unwind(AssertUnwindSafe(|| match one_by_one {
                    false => solver.solve_to(2.0).map(drop),
                    true => (0..10_000).try_for_each(|_| solver.step(2.0).map(drop)),
                }));
                assert!(!matches!(failed, Ok(Ok(()))));
                let (t, y) = (solver.t(), solver.y().to_vec());
                assert!(t > 0.5 && t <= 1.0, "{t}");
                // rtol is 1e-9; one step of the wrong time would be an error of 1e-2
                assert!((y[0] - t.cos()).abs() < 1e-6, "{y:?} at {t}");
                assert!((y[1] + t.sin()).abs() < 1e-6, "{y:?} at {t}");
                assert_eq!(solver.last_step().1, t);
                let mut out = [0.0; 2];
                solver.interpolate(t, 0, &mut out).unwrap();
                assert!((out[0] - y[0]).abs() < 1e-12, "{out:?} {y:?}");
                // What else it gives has to be right.
                let (start, _) = solver.last_step();
                if solver.interpolate(start, 0, &mut out).is_ok() {
                    assert!((out[0] - start.cos()).abs() < 1e-6, "{out:?} at {start}");
                }
                // And it can go on.
                solver.system_mut().end = f64::INFINITY;
                solver.solve_to(1.5).unwrap();
                assert!((solver.y()[0] - 1.5f64.cos()).abs() < 1e-6);
            }
        };
    }
    // One by one, steps that may be repeated become ever smaller, and none fails.
    let all: &[bool] = &[false, true];
    for (how, modes) in [(fatal, all), (recoverable, &[false]), (panicking, all)] {
        let system = || Mortal { end: 1.0, how };
        let options = CvodeOptions::new(1e-9, 1e-9).method(Multistep::Adams);
        fail!(Cvode::new(system(), 0.0, &y0, &options).unwrap(), modes);
        let options = IdaOptions::new(1e-9, 1e-9);
        fail!(Ida::new(system(), 0.0, &y0, &yp0, &options).unwrap(), modes);
        for table in [ButcherTable::implicit(4).unwrap(), ButcherTable::explicit(5).unwrap()] {
            let options = ArkodeOptions::new(1e-9, 1e-9).table(table);
            fail!(Arkode::new(system(), 0.0, &y0, &options).unwrap(), modes);
        }
    }
}

/// A new start, with y' for those who need it.
trait Restart {
    fn restart(&mut self);
}

impl Restart for Cvode<Oscillator> {
    fn restart(&mut self) {
        self.reinit(0.0, &[1.0, 0.0]).unwrap();
    }
}

impl Restart for Arkode<Oscillator> {
    fn restart(&mut self) {
        self.reinit(0.0, &[1.0, 0.0]).unwrap();
    }
}

impl Restart for Ida<Oscillator> {
    fn restart(&mut self) {
        self.reinit_with(0.0, &[1.0, 0.0], &[0.0, -1.0]).unwrap();
    }
}

fn restart(solver: &mut impl Restart) {
    solver.restart();
}

#[test]
fn solvers_move_between_threads() {
    let threads: Vec<_> = (0..4)
        .map(|i| {
            let klu = LinearSolver::Klu {
                pattern: Hires::new().pattern().clone(),
                jacobian: Jacobian::Supplied,
            };
            let options = CvodeOptions::new(1e-8, 1e-12).newton(klu);
            let mut solver = Cvode::new(Hires::new(), 0.0, &Hires::Y0, &options).unwrap();
            solver.solve_to(f64::from(i) + 1.0).unwrap();
            thread::spawn(move || {
                solver.solve_to(Hires::REFERENCE.t).unwrap();
                solver
            })
        })
        .collect();
    for thread in threads {
        let solver = thread.join().unwrap();
        assert!(Hires::REFERENCE.error(solver.y()) < 2e-6);
    }
    const fn is_send<T: Send>() {}
    const { is_send::<Cvode<Robertson>>() };
    const { is_send::<Ida<Robertson>>() };
}

#[test]
fn a_lent_system_stays_with_its_owner() {
    let mut system = Oscillator::new();
    let options = CvodeOptions::new(1e-6, 1e-9);
    let mut solver = Cvode::new(Borrowed(&mut system), 0.0, &[1.0, 0.0], &options).unwrap();
    solver.solve_to(1.0).unwrap();
    drop(solver);
    assert!(system.latest >= 1.0);
}

#[test]
fn options_limit_steps_and_order() {
    let options = CvodeOptions::new(1e-6, 1e-9)
        .initial_step(1e-3)
        .max_step(0.01)
        .max_order(2)
        .stability_limit_detection(true)
        .max_steps_between_setups(5)
        .convergence_coefficient(0.01);
    let mut solver = Cvode::new(Oscillator::new(), 0.0, &[1.0, 0.0], &options).unwrap();
    while solver.t() < 1.0 {
        solver.step(1.0).unwrap();
        let statistics = solver.statistics();
        assert!(statistics.last_step <= 0.01 && statistics.last_order <= 2);
        assert_eq!(statistics.initial_step, 1e-3);
    }
    assert!(solver.statistics().steps >= 100);
    assert!(solver.statistics().linear_setups >= solver.statistics().steps / 5);
}

/// y' = target - y, whose target is changed while it is integrated.
struct Relaxation {
    target: f64,
}

impl Ode for Relaxation {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot[0] = self.target - y[0];
        Ok(())
    }
}

/// After a change of the system an integrator goes on with the step size it had, and as accurately.
#[test]
fn a_change_of_the_system_needs_no_new_start() {
    fn follow(solver: &mut impl Integrator<System = Relaxation>, name: &str) {
        let mut exact = 1.0;
        for (k, target) in [0.0, 2.0, -1.0, -1.0, 0.5].into_iter().enumerate() {
            solver.system_mut().target = target;
            let (t, y) = (solver.t(), solver.y().to_vec());
            let before = solver.statistics();
            assert!(solver.resume(t, &y).unwrap(), "{name}");
            assert_eq!((solver.t(), solver.y()), (t, y.as_slice()));
            let end = 0.7 * (k + 1) as f64;
            solver.set_stop_time(Some(end)).unwrap();
            let _ = solver.step(end).unwrap();
            let after = solver.statistics();
            assert_eq!(after.steps, before.steps + 1);
            if k > 0 {
                println!(
                    "{name}: step {:.1e}, planned {:.1e}",
                    after.last_step, before.current_step
                );
                assert!(after.last_step > 0.1 * before.current_step.min(0.7), "{name}");
            }
            while solver.t() < end {
                let _ = solver.step(end).unwrap();
            }
            exact = target + (exact - target) * (-(end - t)).exp();
            let off = (solver.y()[0] - exact).abs();
            println!("{name}: {off:.1e}");
            assert!(off < 1e-6, "{name}: {off:e}");
        }
    }
    let system = || Relaxation { target: 0.0 };
    let implicit = ArkodeOptions::new(1e-8, 1e-8);
    follow(&mut Arkode::new(system(), 0.0, &[1.0], &implicit).unwrap(), "ARKODE");
    let explicit = implicit.table(ButcherTable::explicit(5).unwrap());
    follow(&mut Arkode::new(system(), 0.0, &[1.0], &explicit).unwrap(), "ARKODE, explicit");
    let options = pliant::rk::Options::new(1e-8, 1e-8);
    let solver = pliant::rk::DormandPrince::new(system(), 0.0, &[1.0], &options);
    follow(&mut solver.unwrap(), "Runge-Kutta");
    // a DAE would need a consistent y', and multistep methods have a history
    let mut ida = oscillating_dae();
    let y = ida.y().to_vec();
    assert!(!ida.resume(0.0, &y).unwrap());
    let mut cvode = oscillator();
    cvode.solve_to(1.0).unwrap();
    assert!(!cvode.resume(1.0, &[0.0, 0.0]).unwrap());
}
