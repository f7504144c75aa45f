//! CVODE against trusted end states.
//!
//! A multistep method keeps local errors below the tolerance; the global error of these problems
//! is larger by a factor that grows with the number of steps. The bounds below are some three
//! times what SUNDIALS 6.4.1 gives, so a wrong Jacobian or a broken error control breaks them.

use crate::support::OwnSolver;
use pliant::{
    ode::Ode,
    samples::{Hires, Pendulum, Reference, Robertson, VanDerPol},
    sundials::{Cvode, CvodeOptions, Integrator, Jacobian, LinearSolver, Multistep, Statistics},
};

/// Error at the end and statistics.
fn run(
    system: impl Ode,
    y0: &[f64],
    reference: Reference,
    options: &CvodeOptions,
) -> (f64, Statistics) {
    let mut solver = Cvode::new(system, 0.0, y0, options).unwrap();
    solver.solve_to(reference.t).unwrap();
    let (error, statistics) = (reference.error(solver.y()), solver.statistics());
    println!(
        "error {error:.2e}, {} steps, {} evaluations, {} factorizations",
        statistics.steps, statistics.evaluations, statistics.linear_setups
    );
    (error, statistics)
}

const DENSE: LinearSolver = LinearSolver::Dense(Jacobian::Supplied);

#[test]
fn hires_by_every_linear_solver() {
    let options = CvodeOptions::new(1e-8, 1e-12);
    let klu =
        LinearSolver::Klu { pattern: Hires::new().pattern().clone(), jacobian: Jacobian::Supplied };
    let band = |jacobian| LinearSolver::Band { lower: 5, upper: 3, jacobian };
    let mut setups = Vec::new();
    for solver in [
        DENSE,
        LinearSolver::Dense(Jacobian::DifferenceQuotients),
        band(Jacobian::Supplied),
        band(Jacobian::DifferenceQuotients),
        klu,
    ] {
        print!("{solver:?}: ");
        let options = options.clone().newton(solver);
        let (error, statistics) = run(Hires::new(), &Hires::Y0, Hires::REFERENCE, &options);
        assert!(error < 2e-6, "{error}");
        setups.push(statistics.linear_setups);
    }
    // The same matrices give the same run, but for rounding; wrong ones need many more.
    assert!(setups.iter().all(|&count| count < setups[0] * 6 / 5), "{setups:?}");
    let options = options.newton(LinearSolver::Custom);
    let (error, _) = run(OwnSolver::new(Hires::new(), 8), &Hires::Y0, Hires::REFERENCE, &options);
    assert!(error < 2e-6, "{error}");
}

#[test]
fn van_der_pol_by_dense_klu_and_its_own_solver() {
    let options = CvodeOptions::new(1e-8, 1e-12);
    let klu = LinearSolver::Klu {
        pattern: VanDerPol::new().pattern().clone(),
        jacobian: Jacobian::Supplied,
    };
    for solver in [DENSE, klu] {
        print!("{solver:?}: ");
        let options = options.clone().newton(solver);
        let (error, _) = run(VanDerPol::new(), &VanDerPol::Y0, VanDerPol::REFERENCE, &options);
        assert!(error < 1.5e-6, "{error}");
    }
    let mut solver = Cvode::new(
        OwnSolver::new(VanDerPol::new(), 2),
        0.0,
        &VanDerPol::Y0,
        &options.newton(LinearSolver::Custom),
    )
    .unwrap();
    solver.solve_to(VanDerPol::REFERENCE.t).unwrap();
    let error = VanDerPol::REFERENCE.error(solver.y());
    assert!(error < 1.5e-6, "{error}");
    let statistics = solver.statistics();
    let system = solver.into_system();
    assert_eq!(system.setups as u64, statistics.linear_setups);
    assert_eq!(system.solves as u64, statistics.nonlinear_iterations);
    assert!(statistics.jacobian_evaluations < statistics.linear_setups, "J is reused");
}

#[test]
fn robertson_over_eleven_decades() {
    for (reference, solver) in [
        (Robertson::REFERENCE, DENSE),
        (
            Robertson::REFERENCE,
            LinearSolver::Klu {
                pattern: Robertson::new().pattern().clone(),
                jacobian: Jacobian::Supplied,
            },
        ),
        (Robertson::LATE_REFERENCE, DENSE),
    ] {
        // Absolute tolerances below the smallest values: y2 ends near 1e-13.
        let options = CvodeOptions::new(1e-8, [1e-14, 1e-19, 1e-10]).newton(solver);
        let (error, _) = run(Robertson::new(), &Robertson::Y0, reference, &options);
        assert!(error < 1e-5, "{error}");
    }
}

#[test]
fn errors_shrink_with_rtol() {
    for (name, runs) in [
        (
            "HIRES",
            [1e-4, 1e-6, 1e-8, 1e-10].map(|rtol| {
                let options = CvodeOptions::new(rtol, rtol * 1e-4).newton(DENSE);
                run(Hires::new(), &Hires::Y0, Hires::REFERENCE, &options).0
            }),
        ),
        (
            "van der Pol",
            [1e-4, 1e-6, 1e-8, 1e-10].map(|rtol| {
                let options = CvodeOptions::new(rtol, rtol * 1e-4).newton(DENSE);
                run(VanDerPol::new(), &VanDerPol::Y0, VanDerPol::REFERENCE, &options).0
            }),
        ),
    ] {
        println!("{name}: {runs:?}");
        // Three times two decades of tolerance: at least four decades of error in all, and never
        // a step backwards.
        assert!(runs.windows(2).all(|pair| pair[1] < pair[0]), "{name}: {runs:?}");
        assert!(runs[3] < 1e-4 * runs[0], "{name}: {runs:?}");
    }
}

#[test]
fn adams_with_fixed_point_iteration_keeps_the_period_of_the_pendulum() {
    for (rtol, bound) in [(1e-6, 1e-2), (1e-10, 1e-6)] {
        let options = CvodeOptions::new(rtol, rtol).method(Multistep::Adams).fixed_point(0);
        let mut solver = Cvode::new(Pendulum, 0.0, &Pendulum::Y0, &options).unwrap();
        solver.solve_to(5.0 * Pendulum::PERIOD).unwrap();
        let error: f64 =
            solver.y().iter().zip(Pendulum::Y0).map(|(y, y0)| (y - y0).abs()).fold(0.0, f64::max);
        println!("rtol {rtol:e}: error {error:.2e}");
        assert!(error < bound, "{error}");
        let statistics = solver.statistics();
        assert_eq!(statistics.jacobian_evaluations, 0);
        assert!(statistics.last_order > 1);
    }
}
