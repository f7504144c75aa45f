//! States that keep within bounds: signs of unknowns, invariants of the equations.

use pliant::{
    samples::{Pendulum, Robertson},
    solve::{Error, Method, Options, Problem, solve},
    sundials::{ButcherTable, Sign},
};

/// Coarse runs of Robertson's equations make the second concentration negative, where they are unstable.
#[test]
fn concentrations_stay_positive() {
    let coarse = Options::new(1e-2, 1e-3);
    let dae = || Problem::dae(Robertson::new(), Robertson::Y0, Robertson::YP0);
    let ode = || Problem::ode(Robertson::new(), Robertson::Y0);
    for (problem, method) in [
        (ode as fn() -> Problem<'static>, Method::Bdf),
        (ode, Method::RungeKutta(ButcherTable::implicit(4).unwrap())),
        (dae, Method::Ida),
    ] {
        let span = (0.0, 1e3);
        assert!(matches!(solve(problem(), method, span, &coarse), Err(Error::Stopped(_))));
        let kept = coarse.clone().sign_constraints([Sign::NonNegative; 3]);
        let solution = solve(problem(), method, span, &kept).unwrap();
        // IDA puts an unknown to its bound but for rounding
        assert!(solution.states().iter().all(|y| *y > -1e-17));
    }
}

#[test]
fn a_projected_pendulum_keeps_its_length() {
    let drift = |options: &Options| {
        let span = (0.0, 10.0 * Pendulum::PERIOD);
        let solution =
            solve(Problem::ode(Pendulum, Pendulum::Y0), Method::Bdf, span, options).unwrap();
        let lengths = (0..solution.t().len()).map(|k| solution.y(k)[0].hypot(solution.y(k)[1]));
        lengths.map(|length| (length - 1.0).abs()).fold(0.0, f64::max)
    };
    let options = Options::new(1e-6, 1e-6);
    let (free, projected) = (drift(&options), drift(&options.clone().project()));
    println!("{free:.1e} {projected:.1e}");
    // to rounding
    assert!(free > 1e-4 && projected < 1e-15);
}

#[test]
fn methods_that_cannot_say_so() {
    let refusal = |method, options: &Options| {
        let problem = Problem::ode(Pendulum, Pendulum::Y0);
        match solve(problem, method, (0.0, 1.0), options) {
            Err(Error::Input(error)) => error.to_string(),
            other => panic!("{other:?}"),
        }
    };
    let options = Options::new(1e-6, 1e-6);
    let text = refusal(Method::Adams, &options.clone().project());
    assert!(text.contains("project") && text.contains("take Bdf"), "{text}");
    let signs = options.sign_constraints([Sign::Free; 4]);
    let text = refusal(Method::DormandPrince, &signs);
    assert!(text.contains("sign_constraints") && text.contains("another"), "{text}");
    let text = refusal(Method::Bdf, &signs.sign_constraints([Sign::Free; 3]));
    assert!(text.contains("sign_constraints = 3"), "{text}");
}
