//! Problems and runs that go from thread to thread.

use std::{ops::ControlFlow, sync::mpsc, thread};

use pliant::{
    ode::with_parameters,
    solve::{Event, Method, Options, Problem, Run, Solution},
    sundials::{Arkode, Cvode, Ida, Sensitivities},
};

use crate::support::{methods, tight};

/// Seen by the compiler: each of these can be sent to another thread, if what a solver owns can be.
const _: () = {
    const fn is_send<T: Send>() {}
    is_send::<Problem<'_>>();
    is_send::<Run<'_>>();
    is_send::<Event<'_>>();
    is_send::<Solution>();
    is_send::<(Cvode<()>, Ida<()>, Arkode<()>)>();
};

/// y' = p, with an event at each 0.5 of y from 1 on that doubles p, an observer, and sensitivities where the method has them.
fn run(method: Method) -> Run<'static> {
    let line = with_parameters(
        |_t, _y, p, ydot| {
            ydot[0] = p[0];
            Ok(())
        },
        [1.0],
    );
    let problem = Problem::ode(line, [0.0])
        .event(Event::new(|_, y| y[0] - 1.0).rising().action(|jump| jump.p[0] *= 2.0))
        .event(Event::every(0.25))
        .observed_by(|_| ControlFlow::Continue(()));
    let mut options: Options = tight();
    if matches!(method, Method::Bdf | Method::Adams) {
        options = options.sensitivities(Sensitivities::of([0]));
    }
    Run::new(problem, method, (0.0, 2.0), &options).unwrap()
}

/// A run that one thread begins and others go on with, a step each in turn, is the same to the last bit as one that stays: y = 1 at t = 1, and 3 at t = 2.
#[test]
fn a_run_goes_on_in_another_thread() {
    for method in methods() {
        let mut home = run(method);
        while home.advance().unwrap().is_some() {}

        let mut away = run(method);
        let (to, from) = mpsc::channel::<Run<'static>>();
        let (back, returned) = mpsc::channel();
        let worker = thread::spawn(move || {
            for mut run in from {
                run.advance().unwrap();
                back.send(run).unwrap();
            }
        });
        while away.end().is_none() {
            away.advance().unwrap();
            to.send(away).unwrap();
            away = returned.recv().unwrap();
        }
        drop(to);
        worker.join().unwrap();
        assert_eq!(away.save(), home.save(), "{method:?}");
        assert!((away.y()[0] - 3.0).abs() < 1e-8, "{method:?}: {:?}", away.y());
    }
}
