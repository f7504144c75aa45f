//! Runs that are put aside and taken up again.

use pliant::{
    ode::dae_with_parameters,
    solve::{Error, Event, Method, Problem, Run, Saved, Solution, solve},
};

use crate::support::{G, fall, methods, sine, tight};

/// sin t in two pieces against sin t: no farther off than in one piece, but for the start with order 1 that BDF makes anew.
#[test]
fn a_run_in_two_pieces_is_the_run_in_one() {
    for method in methods() {
        let first = solve(sine(), method, (0.0, 7.0), &tight()).unwrap();
        let second = sine().resume(first.saved().clone());
        let second = solve(second, method, (7.0, 20.0), &tight()).unwrap();
        let error = (second.last()[0] - 20.0_f64.sin()).abs();
        let whole = solve(sine(), method, (0.0, 20.0), &tight()).unwrap();
        assert!((second.last()[0] - whole.last()[0]).abs() < 1e-8, "{method:?} {error:e}");
    }
}

/// A bouncing ball put aside after each event, and now and then between them: no event is lost or met twice.
#[test]
fn events_are_neither_lost_nor_met_twice() {
    let ball = || {
        let floor = Event::new(|_, y: &[f64]| y[0]).falling().action(|jump| jump.y[1] *= -0.9);
        Problem::ode(fall, [10.0, 0.0]).event(floor).event(Event::new(|_, y: &[f64]| y[1]))
    };
    for method in methods() {
        let whole = solve(ball(), method, (0.0, 9.0), &tight()).unwrap();
        let mut saved: Option<Saved> = None;
        let mut events = Vec::new();
        loop {
            let problem = ball();
            let start = saved.as_ref().map_or(0.0, |saved| saved.t);
            let problem = match saved.take() {
                Some(saved) => problem.resume(saved),
                None => problem,
            };
            let mut run = Run::new(problem, method, (start, 9.0), &tight()).unwrap();
            for _ in 0..100 {
                let Some(step) = run.advance().unwrap() else { break };
                events.extend_from_slice(step.events);
                if !step.events.is_empty() {
                    break;
                }
            }
            if run.end().is_some() {
                break;
            }
            saved = Some(run.save());
        }
        let numbers = |events: &[pliant::solve::Occurrence]| {
            events.iter().map(|e| e.event).collect::<Vec<_>>()
        };
        assert_eq!(numbers(&events), numbers(whole.events()), "{method:?}");
        for (a, b) in events.iter().zip(whole.events()) {
            assert!((a.t - b.t).abs() < 2e-7, "{method:?}: {} {}", a.t, b.t);
        }
        assert!((events[0].t - (20.0 / G).sqrt()).abs() < 1e-8);
    }
}

/// Counts and parameters go along: a heater that has switched twice is ended by the third.
#[test]
fn counts_and_parameters_go_along() {
    let heater = || {
        let equations = dae_with_parameters(
            |_t, y, yp, p, r| {
                r[0] = p[0] - y[0] - yp[0];
                Ok(())
            },
            [1.0],
        );
        let switch = Event::new(|_, y| (y[0] - 0.8) * (y[0] - 0.2));
        let switch = switch.terminal_after(3).action(|jump| jump.p[0] = 1.0 - jump.p[0]);
        Problem::dae(equations, [0.5], [0.5]).differential([true]).event(switch)
    };
    let early: Solution = solve(heater(), Method::Ida, (0.0, 2.5), &tight()).unwrap();
    assert_eq!(
        (early.saved().counts.as_slice(), early.parameters()),
        ([2].as_slice(), [1.0].as_slice())
    );
    let late =
        solve(heater().resume(early.saved().clone()), Method::Ida, (2.5, 99.0), &tight()).unwrap();
    // ln(0.5 / 0.2) to the first switch, ln 4 between them
    let expected = 2.5_f64.ln() + 2.0 * 4.0_f64.ln();
    assert!((late.t().last().unwrap() - expected).abs() < 1e-7);
}

#[test]
fn what_does_not_fit_is_refused() {
    let saved = solve(sine(), Method::Bdf, (0.0, 1.0), &tight()).unwrap().saved().clone();
    let refusal = |saved: Saved, start: f64| match solve(
        sine().resume(saved),
        Method::Bdf,
        (start, 5.0),
        &tight(),
    ) {
        Err(Error::Input(error)) => error.to_string(),
        other => panic!("{other:?}"),
    };
    assert!(refusal(saved.clone(), 0.0).contains("the saved run stands at 1.0"));
    let with = |change: fn(&mut Saved)| {
        let mut saved = saved.clone();
        change(&mut saved);
        refusal(saved, 1.0)
    };
    assert!(with(|saved| saved.y.push(1.0)).contains("length of y"));
    assert!(with(|saved| saved.y[0] = f64::NAN).contains("y of the saved run"));
    assert!(with(|saved| saved.yp.push(1.0)).contains("length of yp"));
    assert!(with(|saved| saved.parameters.push(1.0)).contains("have 0 parameters"));
    assert!(with(|saved| saved.counts.push(1)).contains("length of counts"));
    assert!(with(|saved| saved.event_values.push(0.0)).contains("length of event_values"));
}

/// Of a run that was saved without `armed`, as by earlier versions, all events take place but those that happened once; an infinite value of an
/// event function is saved as a finite one, as JSON has no other.
#[test]
fn events_of_an_earlier_version_are_armed() {
    let problem = || {
        let once = Event::new(|_, y: &[f64]| y[1]).once().action(|_| ());
        // 1/t is infinite at the start, and leaves 1 behind at t = 1
        sine().event(once).event(Event::new(|t, _| 1.0 / t - 1.0))
    };
    let mut run = Run::new(problem(), Method::Bdf, (0.0, 9.0), &tight()).unwrap();
    let start = run.save();
    assert_eq!(start.event_values[1], f64::MAX);
    assert_eq!(
        run.advance_to(2.0).unwrap().iter().map(|met| met.event).collect::<Vec<_>>(),
        [1, 0]
    );
    let middle = run.save();
    for (saved, expected) in [(start, vec![1, 0]), (middle, vec![])] {
        let earlier = Saved { armed: Vec::new(), ..saved };
        run.restore(&earlier).unwrap();
        let met: Vec<usize> = run.advance_to(9.0).unwrap().iter().map(|met| met.event).collect();
        assert_eq!(met, expected);
        assert!((run.y()[0] - 9.0_f64.sin()).abs() < 1e-8);
    }
    let nowhere = Saved { t: f64::NAN, ..run.save() };
    assert!(run.restore(&nowhere).unwrap_err().to_string().contains("time of the saved run"));
}
