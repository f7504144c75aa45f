//! Robertson's reactions through the general SUNDIALS layer, as any application would use it.
//!
//! Run with `cargo run --release --example stiff_ode`. What to look for: time grows by eleven
//! decades in a few thousand steps, each decade costs about the same, and the error at the end is
//! some hundred times the tolerance, as many steps add up.

use faer::MatMut;
use pliant::{
    ode::with_jacobian,
    samples::Robertson,
    sundials::{Cvode, CvodeOptions, Error, Integrator, Jacobian, LinearSolver},
};

fn main() -> Result<(), Error> {
    // The equations and their Jacobian, as closures.
    let system = with_jacobian(
        |_t, y: &[f64], ydot: &mut [f64]| {
            ydot[0] = -0.04 * y[0] + 1e4 * y[1] * y[2];
            ydot[2] = 3e7 * y[1] * y[1];
            ydot[1] = -ydot[0] - ydot[2];
            Ok(())
        },
        |_t, y: &[f64], _ydot: &[f64], mut jacobian: MatMut<'_, f64>| {
            let (to_first, to_third) = ([-0.04, 1e4 * y[2], 1e4 * y[1]], [0.0, 6e7 * y[1], 0.0]);
            for j in 0..3 {
                jacobian[(0, j)] = to_first[j];
                jacobian[(1, j)] = -to_first[j] - to_third[j];
                jacobian[(2, j)] = to_third[j];
            }
            Ok(())
        },
    );

    // The second unknown stays below 4e-5: it needs an absolute tolerance of its own.
    let options = CvodeOptions::new(1e-8, [1e-14, 1e-19, 1e-10])
        .newton(LinearSolver::Dense(Jacobian::Supplied));
    let mut solver = Cvode::new(system, 0.0, &[1.0, 0.0, 0.0], &options)?;

    println!("{:>9}  {:>13}  {:>13}  {:>13}  {:>6}", "t", "y1", "y2", "y3", "steps");
    for decade in 0..=11 {
        let t = 0.4 * 10f64.powi(decade);
        solver.solve_to(t)?;
        let (y, steps) = (solver.y(), solver.statistics().steps);
        println!("{t:9.1e}  {:13.6e}  {:13.6e}  {:13.6e}  {steps:6}", y[0], y[1], y[2]);
    }
    let reference = Robertson::REFERENCE;
    println!(
        "largest relative error at t = {:e}: {:.1e}",
        reference.t,
        reference.error(solver.y())
    );
    println!("{:#?}", solver.statistics());
    Ok(())
}
