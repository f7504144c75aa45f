//! Many problems at once.

use std::panic::{AssertUnwindSafe, catch_unwind};

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

/// Each member is what it is by itself, bit by bit, and one that fails is alone in that.
#[test]
fn members_are_what_they_are_alone() {
    let options = Options::new(1e-6, 1e-9).output(Output::End);
    let count = if cfg!(miri) { 8 } else { 40 };
    for method in methods() {
        let all = ensemble(count, member, method, (0.0, 1.0), &options);
        assert_eq!(all.len(), count);
        for (k, outcome) in all.into_iter().enumerate() {
            if k == 5 {
                assert!(matches!(outcome, Err(Error::Stopped(_))));
                continue;
            }
            let alone = solve(member(k), method, (0.0, 1.0), &options).unwrap();
            assert_eq!(outcome.unwrap().states(), alone.states(), "{method:?} {k}");
        }
    }
}

/// Of two that panic, the one of the lower number is heard.
#[test]
fn a_panic_of_a_member_says_what_it_said() {
    let member = |k: usize| {
        let rhs = move |_t: f64, _y: &[f64], ydot: &mut [f64]| {
            assert!(k != 3 && k != 6, "member {k} is not in order");
            ydot[0] = 1.0;
            Ok(())
        };
        Problem::ode(rhs, [1.0])
    };
    let run = || ensemble(8, member, Method::DormandPrince, (0.0, 1.0), &Options::new(1e-6, 1e-9));
    let panic = catch_unwind(AssertUnwindSafe(run)).unwrap_err();
    let message = panic.downcast_ref::<String>().expect("a text");
    assert_eq!(message, "member 3 is not in order");
}

/// 30,000 steps of ten unknowns are 5 MB of digits; an error is for reading.
#[test]
fn an_error_is_short_in_a_log() {
    let rhs = |t: f64, _y: &[f64], ydot: &mut [f64]| {
        ydot.fill((1e4 * t).cos());
        Ok(())
    };
    let options = Options::new(1e-6, 1e-9).max_steps(30_000);
    let outcome = solve(Problem::ode(rhs, [0.0; 10]), Method::DormandPrince, (0.0, 1e4), &options);
    let text = format!("{:?}", outcome.unwrap_err());
    println!("{text}");
    assert!(text.len() < 1000, "{} characters", text.len());
    assert!(text.contains("Steps(30000)") && text.contains("unknowns: 10"), "{text}");
}
