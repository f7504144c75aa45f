//! What cannot be done is an error before the first step, with the mend.

use pliant::{
    solve::{Error, Event, Method, Options, Output, Problem, solve},
    sundials::{ButcherTable, Jacobian, LinearSolver},
};

use crate::support::{sine, tight};

fn refusal(problem: Problem<'_>, method: Method, span: (f64, f64), options: &Options) -> String {
    match solve(problem, method, span, options) {
        Err(Error::Input(error)) => error.to_string(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn options_that_a_method_lacks_are_refused() {
    let explicit = Method::RungeKutta(ButcherTable::explicit(4).unwrap());
    let dense = tight().linear_solver(LinearSolver::Dense(Jacobian::DifferenceQuotients));
    for method in [explicit, Method::DormandPrince] {
        let text = refusal(sine(), method, (0.0, 1.0), &dense);
        assert!(text.contains("linear_solver") && text.contains("is explicit"), "{text}");
        let text = refusal(sine(), method, (0.0, 1.0), &tight().max_order(3));
        assert!(text.contains("max_order"), "{text}");
    }
    let text = refusal(sine(), Method::DormandPrince, (0.0, 1.0), &tight().min_step(0.1));
    assert!(text.contains("min_step"), "{text}");
    let text = refusal(sine(), Method::Bdf, (0.0, 1.0), &tight().max_order(6));
    assert!(text.contains("max_order = 6") && text.contains("1 to 5"), "{text}");
    let text = refusal(sine(), Method::DormandPrince, (0.0, -1.0), &tight());
    assert!(text.contains("forward only"), "{text}");
}

#[test]
fn methods_are_for_odes_or_for_daes() {
    let text = refusal(sine(), Method::Ida, (0.0, 1.0), &tight());
    assert!(text.contains("method = Ida") && text.contains("take another method"), "{text}");
    let dae = |_t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
        r[0] = yp[0] + y[0];
        Ok(())
    };
    let text = refusal(Problem::dae(dae, [1.0], [-1.0]), Method::Bdf, (0.0, 1.0), &tight());
    assert!(text.contains("take Method::Ida"), "{text}");
}

#[test]
fn spans_times_and_numbers_are_checked() {
    let bdf = Method::Bdf;
    let text = refusal(sine(), bdf, (1.0, 1.0), &tight());
    assert!(text.contains("end of the span = 1"), "{text}");
    let text = refusal(sine(), bdf, (0.0, f64::NAN), &tight());
    assert!(text.contains("end of the span"), "{text}");
    for times in [vec![0.5, 0.4], vec![-0.1], vec![1.1], vec![f64::NAN]] {
        let text = refusal(sine(), bdf, (0.0, 1.0), &tight().output(Output::Times(times)));
        assert!(text.contains("output times"), "{text}");
    }
    for t in [0.0, 1.0, 2.0] {
        let text = refusal(sine().breaks([t]), bdf, (0.0, 1.0), &tight());
        assert!(text.contains("within the span from 0 to 1, not at its ends"), "{text}");
    }
    let text = refusal(sine(), bdf, (0.0, 1.0), &tight().initial_step(-0.1));
    assert!(text.contains("initial_step") && text.contains("span tells"), "{text}");
    let text = refusal(sine(), bdf, (0.0, 1.0), &tight().max_steps(0));
    assert!(text.contains("max_steps"), "{text}");
    for event in [
        Event::new(|_, _| 1.0).samples(0),
        Event::new(|_, _| 1.0).touching(-1.0),
        Event::new(|_, _| 1.0).terminal_after(0),
    ] {
        let text = refusal(sine().event(event), bdf, (0.0, 1.0), &tight());
        assert!(text.contains("of event 0"), "{text}");
    }
}

#[test]
fn an_event_function_that_is_not_a_number_is_told() {
    let problem = sine().event(Event::new(|t, _| if t < 0.5 { 1.0 } else { f64::NAN }));
    let error = solve(problem, Method::Bdf, (0.0, 1.0), &tight()).unwrap_err();
    assert!(error.to_string().contains("the function of event 0 is NaN"), "{error}");
    assert!(error.solution().is_some_and(|part| part.t().len() > 1));
    let problem = sine().event(Event::new(|_, _| 1.0).action(|_| ()));
    solve(problem, Method::Bdf, (0.0, 1.0), &tight()).unwrap();
    let problem = sine().event(Event::new(|t, _| t - 0.5).action(|jump| jump.y[0] = f64::NAN));
    let error = solve(problem, Method::Bdf, (0.0, 1.0), &tight()).unwrap_err();
    assert!(error.to_string().contains("state after the jump"), "{error}");
}
