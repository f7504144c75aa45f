//! Options and solutions as values that are written and read.

use std::time::Duration;

use pliant::{
    samples::Hires,
    solve::{Event, Method, Options, Output, Problem, Saved, Solution, solve},
    sundials::{
        ButcherTable, Jacobian, Krylov, KrylovMethod, LinearSolver, Pattern, Preconditioner,
        Sensitivities, Side,
    },
};

use crate::support::{sine, tight};

fn there_and_back<T: serde::Serialize + serde::de::DeserializeOwned>(value: &T) -> T {
    serde_json::from_str(&serde_json::to_string(value).unwrap()).unwrap()
}

/// Every number comes back as it was, so a solution is read between its steps as before, and a run goes on.
#[test]
fn a_solution_comes_back_to_the_last_bit() {
    for method in [Method::Bdf, Method::DormandPrince] {
        let problem = sine().event(Event::new(|_, y| y[0]));
        let solution = solve(problem, method, (0.0, 10.0), &tight()).unwrap();
        let read: Solution = there_and_back(&solution);
        assert_eq!((read.t(), read.states()), (solution.t(), solution.states()));
        assert_eq!(read.events(), solution.events());
        assert_eq!(read.statistics(), solution.statistics());
        for t in [0.1, 3.3, 9.9] {
            assert_eq!(read.at(t).unwrap(), solution.at(t).unwrap());
        }
        let saved: Saved = there_and_back(solution.saved());
        assert_eq!(saved, *solution.saved());
    }
}

/// A run by options that were written and read is the same run.
#[test]
fn options_come_back() {
    let pattern = Hires::new().pattern().clone();
    let ilu = Preconditioner::Ilu { pattern: pattern.clone(), jacobian: Jacobian::Supplied };
    let krylov = Krylov::new(KrylovMethod::Gmres { dimension: 8, restarts: 1 });
    for solver in [
        LinearSolver::Klu { pattern, jacobian: Jacobian::DifferenceQuotients },
        LinearSolver::Krylov(krylov.preconditioner(Side::Left, ilu)),
    ] {
        let options = Options::new(1e-6, [1e-8; 8])
            .linear_solver(solver)
            .max_wall_time(Duration::from_secs(60))
            .output(Output::Times(vec![1.0, 2.0]));
        let run = |options: &Options| {
            let problem = Problem::ode(Hires::new(), Hires::Y0);
            solve(problem, Method::Bdf, (0.0, 10.0), options).unwrap()
        };
        let read: Options = there_and_back(&options);
        assert_eq!(run(&read).states(), run(&options).states());
    }
    let sensitivities = Sensitivities::of([2, 0]).staggered();
    assert_eq!(there_and_back(&sensitivities), sensitivities);
    let method = Method::RungeKutta(ButcherTable::implicit(5).unwrap());
    assert_eq!(there_and_back(&method), method);
}

/// What was changed by hand so that it does not fit together is refused, before anything could be read out of bounds.
#[test]
fn what_does_not_fit_is_refused() {
    let pattern = r#"{"column_pointers":[0,1,2],"row_indices":[0,0]}"#;
    let error = serde_json::from_str::<Pattern>(pattern).unwrap_err().to_string();
    assert!(error.contains("row_indices"), "{error}");
    let error = serde_json::from_str::<ButcherTable>("\"EULER\"").unwrap_err().to_string();
    assert!(error.contains("it is one of"), "{error}");
    let solution = solve(sine(), Method::Bdf, (0.0, 1.0), &tight()).unwrap();
    let good = serde_json::to_value(&solution).unwrap();
    for key in ["t", "states", "inner", "nodes"] {
        let mut bad = good.clone();
        bad[key].as_array_mut().unwrap().pop();
        let error = serde_json::from_value::<Solution>(bad).unwrap_err().to_string();
        assert!(error.contains("do not fit together"), "{key}: {error}");
    }
}
