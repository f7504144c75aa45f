//! `ark_kpr_mri`: the multirate problem of Kvaerno, Prothero and Robinson with G = -100, e = 0.5, w = 100, where the slopes of
//! stages follow from their equations (the last argument of the example, 1).

use pliant::{
    faer::MatMut,
    ode::{Failure, Ode, split, with_jacobian},
    sundials::{
        ArkodeOptions, Coupling, Error, Integrator, Jacobian, LinearSolver, Multirate,
        MultirateOptions, Predictor, Tableau,
    },
};

use crate::Figures;

const G: f64 = -100.0;
const E: f64 = 0.5;
const W: f64 = 100.0;

fn exact(t: f64) -> [f64; 2] {
    [(1.0 + 0.5 * t.cos()).sqrt(), (2.0 + (W * t).cos()).sqrt()]
}

fn terms(t: f64, y: &[f64]) -> (f64, f64) {
    let (u, v) = (y[0], y[1]);
    let (r, s) = (0.5 * t.cos(), (W * t).cos());
    ((-1.0 + u * u - r) / (2.0 * u), (-2.0 + v * v - s) / (2.0 * v))
}

fn fast(t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    let (first, second) = terms(t, y);
    ydot[1] = E * first - second - W * (W * t).sin() / (2.0 * exact(t)[1]);
    Ok(())
}

fn stiff(t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    let (first, second) = terms(t, y);
    ydot[0] = G * first + E * second;
    Ok(())
}

fn forcing(t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    ydot[0] = -0.5 * t.sin() / (2.0 * y[0]);
    Ok(())
}

fn slow(t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    stiff(t, y, ydot)?;
    ydot[0] += -0.5 * t.sin() / (2.0 * y[0]);
    Ok(())
}

/// The Jacobian of the stiff part, or with `forced` of all of the slow one.
fn jacobian(
    forced: f64,
) -> impl FnMut(f64, &[f64], &[f64], MatMut<'_, f64>) -> Result<(), Failure> {
    move |t, y, _, mut jacobian| {
        let (u, v) = (y[0], y[1]);
        let by_u = G * (1.0 + 0.5 * t.cos()) + forced * 0.5 * t.sin();
        jacobian[(0, 0)] = G / 2.0 + by_u / (2.0 * u * u);
        jacobian[(0, 1)] = E / 2.0 + E * (2.0 + (W * t).cos()) / (2.0 * v * v);
        Ok(())
    }
}

fn erk33() -> Tableau {
    let a: [&[f64]; 3] = [&[], &[0.5], &[-1.0, 2.0]];
    Tableau::new(3, a, [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0]).embedded(2, [0.0, 1.0, 0.0])
}

fn erk44() -> Tableau {
    let a: [&[f64]; 4] = [&[], &[0.5], &[0.0, 0.5], &[0.0, 0.0, 1.0]];
    Tableau::new(4, a, [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0])
}

/// The figures of one variant: errors, steps, evaluations of the fast part and Newton iterations.
struct Printed {
    example: &'static str,
    errors: [f64; 2],
    steps: [u64; 2],
    fast: u64,
    iterations: u64,
}

fn run<S: Ode>(
    figures: &mut Figures,
    system: S,
    (coupling, tableau, h): (Coupling, Tableau, f64),
    (rtol, atol): (f64, f64),
    printed: Printed,
) -> Result<(), Error> {
    let inner = ArkodeOptions::new(1e-4, 1e-9).tableau(tableau).fixed_step(h / W);
    let options = MultirateOptions::new(h, rtol, atol)
        .coupling(coupling)
        .newton(LinearSolver::Dense(Jacobian::Supplied))
        .check_jacobian(false)
        .predictor(Predictor::Trivial);
    let mut solver = Multirate::new(system, fast, 0.0, &exact(0.0), &options, &inner)?;
    let (mut tout, mut sums) = (0.0_f64, [0.0; 2]);
    for _ in 0..50 {
        tout = (tout + 0.1).min(5.0);
        solver.solve_to(tout)?;
        for (i, exact) in exact(tout).into_iter().enumerate() {
            sums[i] += (solver.y()[i] - exact).powi(2);
        }
    }
    let (slow, fast) = (solver.statistics(), solver.fast_statistics());
    let Printed { example, errors, steps, fast: evaluations, iterations } = printed;
    figures.number(example, "error of u", errors[0], 3, (sums[0] / 50.0).sqrt());
    figures.number(example, "error of v", errors[1], 3, (sums[1] / 50.0).sqrt());
    figures.count(example, "slow steps", steps[0], slow.steps);
    figures.count(example, "fast steps", steps[1], fast.steps);
    figures.count(example, "fast evaluations", evaluations, fast.evaluations);
    figures.count(example, "Newton iterations", iterations, slow.nonlinear_iterations);
    Ok(())
}

pub fn all(figures: &mut Figures) -> Result<(), Error> {
    let printed = Printed {
        example: "ark_kpr_mri 0 0.002",
        errors: [4.670e-9, 5.638e-10],
        steps: [2501, 252_601],
        fast: 760_306,
        iterations: 0,
    };
    run(figures, slow, (Coupling::MisKw3, erk33(), 0.002), (1e-4, 1e-9), printed)?;
    let printed = Printed {
        example: "ark_kpr_mri 7 0.001",
        errors: [3.764e-10, 3.952e-10],
        steps: [5000, 510_000],
        fast: 1_550_001,
        iterations: 30_312,
    };
    let system = with_jacobian(slow, jacobian(1.0));
    run(figures, system, (Coupling::Esdirk34a, erk33(), 0.001), (1e-9, 1e-11), printed)?;
    let printed = Printed {
        example: "ark_kpr_mri 8 0.001",
        errors: [1.860e-10, 1.672e-10],
        steps: [5000, 510_000],
        fast: 1_550_001,
        iterations: 30_341,
    };
    let system = split(with_jacobian(stiff, jacobian(0.0)), forcing);
    run(figures, system, (Coupling::ImEx3b, erk33(), 0.001), (1e-9, 1e-11), printed)?;
    let printed = Printed {
        example: "ark_kpr_mri 9 0.001",
        errors: [1.533e-11, 4.203e-12],
        steps: [5000, 510_000],
        fast: 2_070_001,
        iterations: 52_554,
    };
    let system = split(with_jacobian(stiff, jacobian(0.0)), forcing);
    run(figures, system, (Coupling::ImEx4, erk44(), 0.001), (1e-12, 1e-14), printed)
}
