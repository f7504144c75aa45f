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

/// A problem, over a span, that a method of some steps cannot finish, or that says nothing.
fn reason_of_many_steps(
    rhs: fn(f64, &[f64], &mut [f64]),
    y: &[f64],
    end: f64,
    method: Method,
    rtol: f64,
) -> Option<String> {
    let rhs = move |t: f64, y: &[f64], ydot: &mut [f64]| {
        rhs(t, y, ydot);
        Ok(())
    };
    let options = Options::new(rtol, 1e-2 * rtol).max_steps(20_000).output(Output::End);
    match solve(Problem::ode(rhs, y), method, (0.0, end), &options) {
        Ok(solution) => solution.notice().map(String::from),
        Err(error) => {
            let solution = error.solution().expect("it stopped");
            let notice = solution.notice().map(String::from);
            // the error says it, too
            assert!(notice.as_ref().is_none_or(|notice| error.to_string().ends_with(notice)));
            notice
        }
    }
}

/// Solutions that slide along a switch, of one unknown and of a mass on a moving ground with dry friction; stiff equations and oscillations that
/// their solutions do not follow, by the methods whose stability they limit; and equations whose steps are as small as their solutions change.
#[test]
fn many_steps_have_their_reason() {
    let [implicit, explicit] =
        [ButcherTable::implicit(4).unwrap(), ButcherTable::explicit(5).unwrap()];
    let [dirk, erk] = [Method::RungeKutta(implicit), Method::RungeKutta(explicit)];
    let (bdf, adams, dopri, ros) =
        (Method::Bdf, Method::Adams, Method::DormandPrince, Method::Rosenbrock);
    let slide: fn(f64, &[f64], &mut [f64]) = |_, y, f| f[0] = if y[0] > 0.5 { -1.0 } else { 1.0 };
    let friction: fn(f64, &[f64], &mut [f64]) =
        |t, y, f| (f[0], f[1]) = (y[1], 0.5 * t.sin() - y[1].signum());
    let switches = "switch to and fro at this state";
    for method in [bdf, adams, dopri, ros, dirk, erk] {
        let told = reason_of_many_steps(slide, &[0.0], 10.0, method, 1e-6).unwrap();
        assert!(told.contains(switches), "{method:?}: {told}");
    }
    for method in [dopri, ros, dirk, erk] {
        let told = reason_of_many_steps(friction, &[0.0, 1.0], 10.0, method, 1e-6).unwrap();
        assert!(told.contains(switches), "{method:?}: {told}");
    }

    let decay: fn(f64, &[f64], &mut [f64]) = |t, y, f| f[0] = -1e4 * (y[0] - t.cos());
    let vibration: fn(f64, &[f64], &mut [f64]) =
        |t, y, f| (f[0], f[1]) = (y[1], -1e8 * (y[0] - t.sin()));
    let stability = "stability, not accuracy, limits the step";
    for method in [dopri, erk] {
        let told = reason_of_many_steps(decay, &[0.0], 20.0, method, 1e-6).unwrap();
        assert!(told.contains(stability) && told.contains("an implicit method"), "{told}");
    }
    for (method, advice) in
        [(bdf, "Method::Rosenbrock"), (adams, "implicit"), (dopri, "implicit"), (erk, "implicit")]
    {
        let told = reason_of_many_steps(vibration, &[0.0, 1.0], 10.0, method, 1e-6).unwrap();
        assert!(told.contains(stability) && told.contains(advice), "{method:?}: {told}");
    }
    // the advice is right: the methods that it names follow the slow motion alone
    for method in [ros, dirk] {
        let rhs = move |t: f64, y: &[f64], ydot: &mut [f64]| {
            vibration(t, y, ydot);
            Ok(())
        };
        let options = Options::new(1e-6, 1e-8).max_steps(2_000).output(Output::End);
        let solution = solve(Problem::ode(rhs, [0.0, 1.0]), method, (0.0, 10.0), &options).unwrap();
        assert!((solution.last()[0] - 10_f64.sin()).abs() < 1e-6, "{:?}", solution.last());
    }
    // what Dormand and Prince's method sees on the way is told of a run that came to its end, too
    let told = reason_of_many_steps(decay, &[0.0], 1.0, dopri, 1e-6).unwrap();
    assert!(told.contains(stability), "{told}");

    let turns: fn(f64, &[f64], &mut [f64]) = |_, y, f| (f[0], f[1]) = (y[1], -1e8 * y[0]);
    let lorenz: fn(f64, &[f64], &mut [f64]) = |_, y, f| {
        f[0] = 10.0 * (y[1] - y[0]);
        f[1] = y[0] * (28.0 - y[2]) - y[1];
        f[2] = y[0] * y[1] - 8.0 / 3.0 * y[2];
    };
    for method in [bdf, adams, dopri, ros, dirk, erk] {
        for rtol in [1e-3, 1e-6] {
            let told = reason_of_many_steps(turns, &[1.0, 0.0], 10.0, method, rtol);
            assert_eq!(told, None, "{method:?}");
            let told = reason_of_many_steps(lorenz, &[1.0, 0.0, 0.0], 1e3, method, rtol);
            assert_eq!(told, None, "{method:?}");
        }
    }
}
