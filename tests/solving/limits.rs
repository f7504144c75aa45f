//! Limits and cancellation: a run ends with what was computed.

use std::{
    ops::ControlFlow,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::Duration,
};

use pliant::{
    ode::Failure,
    solve::{Error, Method, Options, Output, Problem, Reason, Run, Solution, solve},
    sundials::ButcherTable,
};

use crate::support::{methods, sine, tight};

fn stopped(outcome: Result<Solution, Error>) -> (Reason, Solution) {
    match outcome {
        Err(Error::Stopped(stopped)) => (stopped.reason, stopped.solution),
        other => panic!("{other:?}"),
    }
}

/// The part that was computed is the beginning of the whole solution, bit by bit.
#[test]
fn a_limit_ends_a_run_with_what_was_computed() {
    for method in methods() {
        let whole = solve(sine(), method, (0.0, 20.0), &tight()).unwrap();
        let (reason, part) = stopped(solve(sine(), method, (0.0, 20.0), &tight().max_steps(12)));
        assert!(matches!(reason, Reason::Steps(12)), "{method:?} {reason:?}");
        assert_eq!(part.t(), &whole.t()[..13]);
        assert_eq!(part.states(), &whole.states()[..26]);
        let limited = tight().max_evaluations(50);
        let (reason, part) = stopped(solve(sine(), method, (0.0, 20.0), &limited));
        assert!(matches!(reason, Reason::Evaluations(50..80)), "{method:?} {reason:?}");
        let n = part.t().len();
        assert_eq!(part.t(), &whole.t()[..n]);
        let limited = tight().max_wall_time(Duration::ZERO);
        let (reason, part) = stopped(solve(sine(), method, (0.0, 20.0), &limited));
        assert!(matches!(reason, Reason::WallTime(_)), "{method:?}");
        assert_eq!(part.t(), [0.0]);
    }
}

/// What is asked for at given times has the place where it stopped, too.
#[test]
fn a_stop_between_output_times_leaves_where_it_stopped() {
    let options = tight().output(Output::Times(vec![10.0])).max_steps(7);
    let (_, part) = stopped(solve(sine(), Method::Bdf, (0.0, 20.0), &options));
    assert_eq!(part.t().len(), 2);
    let t = part.t()[1];
    assert!(t > 0.0 && (part.y(1)[0] - t.sin()).abs() < 1e-8);
}

#[test]
fn a_failure_leaves_what_was_computed() {
    for method in methods() {
        let fails = |t: f64, y: &[f64], ydot: &mut [f64]| {
            if t > 2.0 {
                return Err(Failure::Fatal("the fuse is blown".into()));
            }
            ydot[0] = -y[0];
            Ok(())
        };
        let outcome = solve(Problem::ode(fails, [1.0]), method, (0.0, 5.0), &tight());
        let text = format!("{}", outcome.as_ref().unwrap_err());
        assert!(text.contains("the right-hand side failed"), "{text}");
        let (reason, part) = stopped(outcome);
        assert!(matches!(reason, Reason::Failed(_)));
        let t = *part.t().last().unwrap();
        assert!(t > 1.0 && (part.last()[0] - (-t).exp()).abs() < 1e-8, "{method:?} {t}");
    }
}

#[test]
fn an_observer_sees_each_step_and_may_end_the_run() {
    let mut parts = Vec::new();
    let problem = sine().observed_by(|progress| {
        parts.push(progress.part);
        if progress.t > 5.0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let (reason, part) = stopped(solve(problem, Method::Bdf, (0.0, 20.0), &tight()));
    assert!(matches!(reason, Reason::Cancelled));
    assert_eq!(parts.len() + 1, part.t().len());
    assert!(parts.is_sorted() && parts.last().is_some_and(|part| (0.25..0.4).contains(part)));
}

#[test]
fn another_thread_may_cancel() {
    let flag = Arc::new(AtomicBool::new(false));
    let problem_flag = flag.clone();
    let running = Arc::new(AtomicBool::new(false));
    let told = running.clone();
    let worker = thread::spawn(move || {
        // a run of hours
        let problem = sine().cancelled_by(problem_flag).observed_by(move |_| {
            told.store(true, Ordering::Relaxed);
            ControlFlow::Continue(())
        });
        let options = Options::new(1e-8, 1e-10).max_steps(u64::MAX).output(Output::End);
        stopped(solve(problem, Method::Bdf, (0.0, 1e12), &options))
    });
    while !running.load(Ordering::Relaxed) {
        thread::yield_now();
    }
    flag.store(true, Ordering::Relaxed);
    let (reason, _) = worker.join().unwrap();
    assert!(matches!(reason, Reason::Cancelled));
}

/// Where the integrator knows why there are so many steps, the error tells it in place of the advice to allow more.
#[test]
fn an_error_tells_why_there_are_so_many_steps() {
    let most = 20_000;
    let options = || Options::new(1e-8, 1e-10).max_steps(most);
    // it slides along the switch at 0
    let slides = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot[0] = -y[0].signum();
        Ok(())
    };
    let mut all = methods();
    all.push(Method::Rosenbrock);
    for method in all {
        let outcome = solve(Problem::ode(slides, [0.5]), method, (0.0, 2.0), &options());
        let error = outcome.unwrap_err().to_string();
        assert!(error.contains("switch to and fro"), "{method:?}: {error}");
        assert!(!error.contains("max_steps"), "{method:?}: {error}");
    }
    let stiff = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot.copy_from_slice(&[y[1], 1e6 * ((1.0 - y[0] * y[0]) * y[1] - y[0])]);
        Ok(())
    };
    let explicit = Method::RungeKutta(ButcherTable::explicit(5).unwrap());
    for method in [Method::DormandPrince, explicit] {
        let outcome = solve(Problem::ode(stiff, [2.0, 0.0]), method, (0.0, 2.0), &options());
        let error = outcome.unwrap_err().to_string();
        assert!(error.contains("stability, not accuracy, limits the step"), "{method:?}: {error}");
        let mut run =
            Run::new(Problem::ode(stiff, [2.0, 0.0]), method, (0.0, 2.0), &options()).unwrap();
        let reason = loop {
            if let Err(reason) = run.advance() {
                break reason;
            }
        };
        assert!(matches!(reason, Reason::Steps(steps) if steps == most), "{reason}");
        assert!(run.notice().is_some_and(|notice| error.ends_with(&notice)));
    }
    // nothing is wrong with a long run of a smooth solution
    for method in methods() {
        let error = solve(sine(), method, (0.0, 1e6), &tight().max_steps(most)).unwrap_err();
        let words = error.to_string();
        assert!(
            words.contains("raise max_steps if the step size is reasonable"),
            "{method:?}: {words}"
        );
    }
}
