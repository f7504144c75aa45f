//! Runs that go to a time, jump there, and go back.

use pliant::{
    ode::{dae_with_parameters, with_parameters},
    solve::{Event, Method, Problem, Run, solve},
    sundials::Sensitivities,
};

use crate::support::{methods, sine, tight};

/// sin t at times asked for, by a run that only ends steps there: right, and with fewer steps than with a new start at each.
#[test]
fn a_run_goes_to_a_time() {
    for method in methods() {
        let mut run = Run::new(sine(), method, (0.0, 10.0), &tight()).unwrap();
        for k in 1..=100 {
            let t = 0.1 * f64::from(k);
            assert!(run.advance_to(t).unwrap().is_empty());
            assert_eq!(run.t(), t);
            assert!((run.y()[0] - t.sin()).abs() < 1e-7, "{method:?} {t}");
        }
        assert!(run.end().is_some() && run.advance().unwrap().is_none());
        let starts = sine().breaks((1..100).map(|k| 0.1 * f64::from(k)));
        let starts = solve(starts, method, (0.0, 10.0), &tight()).unwrap();
        let (steps, most) = (run.statistics().steps, starts.statistics().steps);
        assert!(steps <= most, "{method:?}: {steps} {most}");
        // a time behind, and one beyond the end
        for t in [9.0, 11.0] {
            assert!(run.advance_to(t).unwrap_err().to_string().contains("reached 10.0"));
        }
    }
}

/// y' = p, with p = 1 up to t = 0.5 and 2 from the break on, where y falls by 1, and ticks each quarter that raise y by p / 8; an event at y = 0.7 happens once.
/// Whatever was tried in between, a run that goes back to a saved state repeats the same, breaks, ticks and events.
#[test]
fn a_run_goes_back() {
    for method in methods() {
        let problem = || {
            let line = with_parameters(
                |_t, _y, p, ydot| {
                    ydot[0] = p[0];
                    Ok(())
                },
                [1.0],
            );
            Problem::ode(line, [0.0])
                .break_with(0.5, |jump| {
                    jump.y[0] -= 1.0;
                    jump.p[0] = 2.0;
                })
                .event(Event::every(0.25).action(|jump| jump.y[0] += 0.125 * jump.p[0]))
                .event(Event::new(|_, y| y[0] - 0.7).rising().once())
        };
        let mut run = Run::new(problem(), method, (0.0, 2.0), &tight()).unwrap();
        let mut saved = vec![run.save()];
        let mut first = Vec::new();
        let times = [0.3, 0.5, 0.9, 2.0];
        for t in times {
            first.push((run.advance_to(t).unwrap(), run.y()[0], run.parameters()[0]));
            saved.push(run.save());
        }
        // at 0.5 down by 1 before the tick, which is of p = 2 then; five ticks from 0.9 to 2
        let expected = [0.425, 0.625 - 1.0 + 0.25, 0.675 + 0.25, 0.925 + 2.2 + 1.25];
        for ((_, y, _), expected) in first.iter().zip(expected) {
            assert!((y - expected).abs() < 1e-8, "{method:?}: {y} {expected}");
        }
        for start in [2, 0, 3, 1] {
            run.restore(&saved[start]).unwrap();
            assert_eq!(run.y(), saved[start].y);
            // a try that is thrown away
            run.jump(|jump| jump.p[0] = -30.0).unwrap();
            run.advance_to(2.0).unwrap();
            run.restore(&saved[start]).unwrap();
            for (t, (events, y, p)) in times.iter().zip(&first).skip(start) {
                let found = run.advance_to(*t).unwrap();
                let numbers = |events: &[pliant::solve::Occurrence]| {
                    events.iter().map(|event| event.event).collect::<Vec<_>>()
                };
                assert_eq!(numbers(&found), numbers(events), "{method:?} {start} {t}");
                assert!((run.y()[0] - y).abs() < 1e-8 && run.parameters()[0] == *p);
            }
        }
        let other = Run::new(sine(), method, (0.0, 1.0), &tight()).unwrap().save();
        assert!(run.restore(&other).unwrap_err().to_string().contains("saved run"));
    }
}

/// y' = -p0 y up to t = 1, where p1 y is added and the rate doubled: derivatives by both; the same after going back.
#[test]
fn jumps_and_restores_carry_sensitivities() {
    let p = [0.7, 0.3];
    let decay = with_parameters(
        |_t, y, p, ydot| {
            ydot[0] = -p[0] * y[0];
            Ok(())
        },
        p,
    );
    let options = tight().sensitivities(Sensitivities::of([0, 1]));
    let mut run = Run::new(Problem::ode(decay, [1.0]), Method::Bdf, (0.0, 2.0), &options).unwrap();
    run.advance_to(1.0).unwrap();
    let saved = run.save();
    let end = (-3.0 * p[0]).exp();
    for _ in 0..2 {
        run.jump(|jump| {
            jump.y[0] *= 1.0 + jump.p[1];
            jump.p[0] *= 2.0;
        })
        .unwrap();
        run.advance_to(2.0).unwrap();
        let s = run.sensitivities();
        assert!((run.y()[0] - 1.3 * end).abs() < 1e-8);
        assert!((s[(0, 0)] + 3.0 * 1.3 * end).abs() < 1e-7, "{}", s[(0, 0)]);
        assert!((s[(0, 1)] - end).abs() < 1e-7, "{}", s[(0, 1)]);
        run.restore(&saved).unwrap();
        assert!((run.sensitivities()[(0, 0)] + (-p[0]).exp()).abs() < 1e-7);
    }
}

/// y' = z, 0 = z - p: z follows a jump of p at once, also at the start, and goes back with the run.
#[test]
fn algebraic_unknowns_follow() {
    let line = dae_with_parameters(
        |_t, y, yp, p, r| {
            r[0] = yp[0] - y[1];
            r[1] = y[1] - p[0];
            Ok(())
        },
        [1.0],
    );
    let problem = Problem::dae(line, [0.0, 0.0], [0.0; 2])
        .differential([true, false])
        .event(Event::at(0.0).action(|jump| jump.p[0] = 2.0));
    let mut run = Run::new(problem, Method::Ida, (0.0, 2.0), &tight()).unwrap();
    assert!((run.y()[1] - 2.0).abs() < 1e-9, "{:?}", run.y());
    let saved = run.save();
    run.jump(|jump| jump.p[0] = 5.0).unwrap();
    assert!((run.y()[1] - 5.0).abs() < 1e-9, "{:?}", run.y());
    run.advance_to(1.0).unwrap();
    assert!((run.y()[0] - 5.0).abs() < 1e-8);
    run.restore(&saved).unwrap();
    run.advance_to(2.0).unwrap();
    assert!((run.y()[0] - 4.0).abs() < 1e-8);
    assert!(run.jump(|_| ()).unwrap_err().to_string().contains("it has ended"));
}
