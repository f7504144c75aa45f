//! Many problems at once.

use pliant::{
    ode::Failure,
    solve::{Error, Method, Options, Output, Problem, ensemble, solve},
};

use crate::support::methods;

fn member<'a>(k: usize) -> Problem<'a> {
    let rate = k as f64;
    Problem::ode(
        move |_t: f64, y: &[f64], ydot: &mut [f64]| {
            if k == 5 {
                return Err(Failure::Fatal("member 5 is broken".into()));
            }
            ydot[0] = -rate * y[0];
            Ok(())
        },
        [1.0],
    )
}

/// Each member is what it is by itself, bit by bit, with a method, span and options of its own, and one that fails is alone in that.
#[test]
fn members_are_what_they_are_alone() {
    let count = if cfg!(miri) { 8 } else { 40 };
    let methods = methods();
    let alone = |k: usize| {
        let options = Options::new(1e-6 / (1.0 + k as f64), 1e-9).output(Output::End);
        solve(member(k), methods[k % methods.len()], (0.0, 1.0 / (1.0 + k as f64)), &options)
    };
    let all = ensemble(count, alone);
    assert_eq!(all.len(), count);
    for (k, outcome) in all.into_iter().enumerate() {
        if k == 5 {
            assert!(matches!(outcome, Err(Error::Stopped(_))));
            continue;
        }
        let solution = outcome.unwrap();
        assert_eq!(solution.states(), alone(k).unwrap().states(), "{k}");
        // y' = -k y over 1 / (1 + k)
        let exact = (-(k as f64) / (1.0 + k as f64)).exp();
        assert!((solution.last()[0] / exact - 1.0).abs() < 1e-4, "{k}");
    }
}

/// Members that panic, in the equations or before, lose their results alone, and say what they said.
#[test]
fn a_member_that_panics_is_alone_in_that() {
    let all = ensemble(8, |k| {
        assert!(k != 6, "member 6 does not begin");
        let rhs = move |t: f64, _y: &[f64], ydot: &mut [f64]| {
            if k == 3 && t > 0.5 {
                panic!("in the middle");
            }
            ydot[0] = 1.0;
            Ok(())
        };
        let options = Options::new(1e-6, 1e-9).max_step(0.1);
        solve(Problem::ode(rhs, [1.0]), Method::DormandPrince, (0.0, 1.0), &options)
    });
    for (k, outcome) in all.into_iter().enumerate() {
        match (k, outcome) {
            (3, Err(error)) => assert_eq!(error.to_string(), "the member panicked: in the middle"),
            (6, Err(error)) => {
                assert_eq!(error.to_string(), "the member panicked: member 6 does not begin");
                assert!(error.solution().is_none());
            }
            (_, outcome) => assert!((outcome.unwrap().last()[0] - 2.0).abs() < 1e-12, "{k}"),
        }
    }
}

/// 30,000 steps of ten unknowns are 5 MB of digits; an error is for reading, also where a `main` returns it.
#[test]
fn an_error_is_words_in_a_log() {
    let rhs = |t: f64, _y: &[f64], ydot: &mut [f64]| {
        ydot.fill((1e4 * t).cos());
        Ok(())
    };
    let options = Options::new(1e-6, 1e-9).max_steps(30_000);
    let outcome = solve(Problem::ode(rhs, [0.0; 10]), Method::DormandPrince, (0.0, 1e4), &options);
    let error = outcome.unwrap_err();
    let text = format!("{error:?}");
    println!("{text}");
    assert_eq!(text, error.to_string());
    assert!(text.contains("30000 steps taken; raise max_steps") && text.len() < 200, "{text}");
    let Error::Stopped(stopped) = error else { panic!("{text}") };
    assert_eq!(format!("{:?}", stopped.reason), stopped.reason.to_string());
}
