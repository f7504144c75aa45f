//! CVODE and IDA take exactly the steps that they take without pliant.
//!
//! The counts are those that `benches/c/overhead.c` prints, a program in C on SUNDIALS 6.4.1 alone, after the least time:
//!
//! ```text
//! cc -O3 -I/usr/include/suitesparse -o overhead benches/c/overhead.c -lsundials_cvodes -lsundials_idas \
//!     -lsundials_nvecserial -lsundials_sunmatrixband -lsundials_sunmatrixdense -lsundials_sunmatrixsparse \
//!     -lsundials_sunlinsolband -lsundials_sunlinsoldense -lsundials_sunlinsolklu -lklu -lm
//! ./overhead hires dense 1
//! ```
//!
//! and so on: each test names its problem and linear solver; KLU orders by AMD. They are of Debian 12 on x86-64: another version of SUNDIALS, or one
//! compiled with fused multiply-adds, may count otherwise.

use pliant::{
    ode::Ode,
    samples::{Brusselator, Hires, Pollution, Robertson, TransistorAmplifier, VanDerPol},
    sundials::{
        AbsoluteTolerance, Cvode, CvodeOptions, Ida, IdaOptions, Integrator, Jacobian,
        LinearSolver, MassForm, Statistics,
    },
};

/// Steps, evaluations, Jacobians, factorizations, failures of the error test, iterations and failures of the nonlinear
/// solver, as the program prints them.
type Counts = [u64; 7];

/// At the end of a run.
fn counts(mut solver: impl Integrator, end: f64) -> Counts {
    solver.solve_to(end).unwrap();
    let Statistics {
        steps,
        evaluations,
        jacobian_evaluations,
        linear_setups,
        error_test_failures,
        nonlinear_iterations,
        nonlinear_failures,
        ..
    } = solver.statistics();
    [
        steps,
        evaluations,
        jacobian_evaluations,
        linear_setups,
        error_test_failures,
        nonlinear_iterations,
        nonlinear_failures,
    ]
}

fn cvode<S: Ode>(
    system: S,
    y0: &[f64],
    atol: impl Into<AbsoluteTolerance>,
    solver: LinearSolver,
) -> Cvode<S> {
    let options = CvodeOptions::new(1e-8, atol).newton(solver);
    Cvode::new(system, 0.0, y0, &options).unwrap()
}

const DENSE: LinearSolver = LinearSolver::Dense(Jacobian::Supplied);

#[test]
fn hires_dense() {
    let solver = cvode(Hires::new(), &Hires::Y0, 1e-12, DENSE);
    assert_eq!(counts(solver, Hires::REFERENCE.t), [980, 1361, 18, 141, 55, 1360, 0]);
}

#[test]
fn hires_klu() {
    let hires = Hires::new();
    let klu = LinearSolver::Klu { pattern: hires.pattern().clone(), jacobian: Jacobian::Supplied };
    let solver = cvode(hires, &Hires::Y0, 1e-12, klu);
    assert_eq!(counts(solver, Hires::REFERENCE.t), [979, 1367, 18, 152, 65, 1366, 0]);
}

#[test]
fn robertson_dense() {
    let solver = cvode(Robertson::new(), &Robertson::Y0, [1e-14, 1e-19, 1e-10], DENSE);
    assert_eq!(counts(solver, Robertson::REFERENCE.t), [2117, 2688, 39, 315, 122, 2687, 0]);
}

#[test]
fn vanderpol_dense() {
    let solver = cvode(VanDerPol::new(), &VanDerPol::Y0, 1e-12, DENSE);
    assert_eq!(counts(solver, VanDerPol::REFERENCE.t), [3265, 4450, 58, 487, 253, 4449, 0]);
}

#[test]
fn pollution_dense() {
    let solver = cvode(Pollution::new(), &Pollution::Y0, 1e-12, DENSE);
    assert_eq!(counts(solver, Pollution::REFERENCE.t), [447, 558, 8, 56, 7, 556, 0]);
}

#[test]
fn brusselator_band_and_klu() {
    let system = Brusselator::new(20);
    let (bandwidth, jacobian) = (Brusselator::BANDWIDTH, Jacobian::Supplied);
    for newton in [
        LinearSolver::Band { lower: bandwidth, upper: bandwidth, jacobian },
        LinearSolver::Klu { pattern: system.pattern().clone(), jacobian },
    ] {
        let solver = cvode(system.clone(), &system.y0(), 1e-12, newton);
        assert_eq!(counts(solver, Brusselator::REFERENCE_20.t), [449, 505, 8, 44, 8, 502, 0]);
    }
}

/// By IDA, of order 3 at most (see `standard_problems.rs`).
#[test]
fn amplifier_dense() {
    let system = MassForm::new(TransistorAmplifier, 8, &DENSE).unwrap();
    let (y0, slope) = (TransistorAmplifier::Y0, TransistorAmplifier::YP0);
    let options = IdaOptions::new(1e-5, 1e-5).newton(DENSE).max_order(3);
    let solver = Ida::new(system, 0.0, &y0, &slope, &options).unwrap();
    assert_eq!(
        counts(solver, TransistorAmplifier::REFERENCE.t),
        [3731, 5851, 522, 522, 258, 5851, 80]
    );
}
