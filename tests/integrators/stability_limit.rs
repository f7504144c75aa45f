//! What BDF spends on a lightly damped oscillation: with orders up to 5, with stability-limit detection, and with order 2
//! at most. No choice wins everywhere.
//!
//! Reference counts are those of plain C on SUNDIALS 6.4.1: rtol and atol 1e-6, t = 1000, a dense Jacobian by difference
//! quotients, whose evaluations count; pliant's have increments of their own. SUNDIALS computes c (x + y) where pliant's vector operations compute c x + c y. Where the
//! oscillation dies out far below atol, rounding of this size decides at which step an order is raised: at a ratio
//! of 0.25 C takes 329, 329 and 1515, pliant 649, 318 and 1515, and with the sums of SUNDIALS all of C's counts come out.

use pliant::{
    samples::DampedOscillator,
    sundials::{Cvode, CvodeOptions, Integrator, Jacobian, LinearSolver},
};

/// Evaluations for a damping ratio.
fn evaluations(ratio: f64) -> [u64; 3] {
    let options = CvodeOptions::new(1e-6, 1e-6);
    let detecting = options.clone().stability_limit_detection(true);
    let low_order = options.clone().max_order(2);
    [options, detecting, low_order].map(|options| {
        let system = DampedOscillator { damping: 2.0 * ratio };
        let mut solver = Cvode::new(system, 0.0, &DampedOscillator::Y0, &options).unwrap();
        solver.solve_to(1000.0).unwrap();
        let statistics = solver.statistics();
        statistics.evaluations + statistics.difference_quotient_evaluations
    })
}

#[test]
fn oscillations_cost_nearly_what_they_cost_in_c() {
    for (ratio, reference) in [
        (0.2, [1202, 427, 1835]),
        (0.1, [1643, 784, 3713]),
        (0.05, [2121, 1577, 7319]),
        (0.01, [5005, 6854, 35381]),
    ] {
        let counts = evaluations(ratio);
        println!("{ratio}: {counts:?}");
        for (count, reference) in counts.into_iter().zip(reference) {
            // found: 7.4 % at most
            assert!(count.abs_diff(reference) <= reference / 12, "{ratio}: {count} {reference}");
        }
    }
}

#[test]
fn the_closed_form_is_kept() {
    let system = DampedOscillator { damping: 0.1 };
    let options = CvodeOptions::new(1e-9, 1e-12).newton(LinearSolver::Dense(Jacobian::Supplied));
    let mut solver = Cvode::new(system, 0.0, &DampedOscillator::Y0, &options).unwrap();
    solver.solve_to(20.0).unwrap();
    let exact = system.state(20.0);
    let error =
        solver.y().iter().zip(exact).map(|(y, exact)| (y - exact).abs()).fold(0.0, f64::max);
    println!("error {error:.2e}");
    assert!(error < 1e-7, "{error}");
}
