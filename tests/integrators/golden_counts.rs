//! CVODE takes exactly the steps that it takes without pliant.
//!
//! The counts are those that `benches/c/overhead.c` prints, a program in C on SUNDIALS 6.4.1 alone, after the least time:
//!
//! ```text
//! cc -O3 -I/usr/include/suitesparse -o overhead benches/c/overhead.c -lsundials_cvodes -lsundials_nvecserial \
//!     -lsundials_sunmatrixdense -lsundials_sunmatrixsparse -lsundials_sunlinsoldense -lsundials_sunlinsolklu -lklu
//! ./overhead hires dense 1
//! ```
//!
//! and `hires klu`, `robertson dense`, `vanderpol dense`. Tolerances are those of cvode.rs. They are of Debian 12 on x86-64:
//! another version of SUNDIALS, or one compiled with fused multiply-adds, may count otherwise.

use pliant::{
    ode::Ode,
    samples::{Hires, Robertson, VanDerPol},
    sundials::{
        AbsoluteTolerance, Cvode, CvodeOptions, Integrator, Jacobian, LinearSolver, Statistics,
    },
};

/// Steps, evaluations, Jacobians, factorizations, failures of the error test, iterations and failures of the nonlinear
/// solver, as the program prints them.
type Counts = [u64; 7];

fn counts(
    system: impl Ode,
    y0: &[f64],
    end: f64,
    atol: impl Into<AbsoluteTolerance>,
    solver: LinearSolver,
) -> Counts {
    let options = CvodeOptions::new(1e-8, atol).newton(solver);
    let mut solver = Cvode::new(system, 0.0, y0, &options).unwrap();
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

const DENSE: LinearSolver = LinearSolver::Dense(Jacobian::Supplied);

#[test]
fn hires_dense_counts_as_in_c() {
    let end = Hires::REFERENCE.t;
    let counts = counts(Hires::new(), &Hires::Y0, end, 1e-12, DENSE);
    assert_eq!(counts, [980, 1361, 18, 141, 55, 1360, 0]);
}

#[test]
fn hires_by_klu_counts_as_in_c() {
    let (hires, end) = (Hires::new(), Hires::REFERENCE.t);
    let klu = LinearSolver::Klu { pattern: hires.pattern().clone(), jacobian: Jacobian::Supplied };
    let counts = counts(hires, &Hires::Y0, end, 1e-12, klu);
    assert_eq!(counts, [937, 1330, 17, 146, 61, 1329, 0]);
}

#[test]
fn robertson_counts_as_in_c() {
    let end = Robertson::REFERENCE.t;
    let counts = counts(Robertson::new(), &Robertson::Y0, end, [1e-14, 1e-19, 1e-10], DENSE);
    assert_eq!(counts, [2117, 2688, 39, 315, 122, 2687, 0]);
}

#[test]
fn van_der_pol_counts_as_in_c() {
    let end = VanDerPol::REFERENCE.t;
    let counts = counts(VanDerPol::new(), &VanDerPol::Y0, end, 1e-12, DENSE);
    assert_eq!(counts, [3265, 4450, 58, 487, 253, 4449, 0]);
}
