//! Many problems at once.

use pliant::{
    ode::Failure,
    solve::{Error, Options, Output, Problem, ensemble, solve},
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
