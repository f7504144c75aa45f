//! `ark_brusselator1D_imexmri 4 0.001`: the Brusselator on a line, with diffusion implicit and advection explicit in the slow
//! part, and reactions fast.

use std::f64::consts::PI;

use pliant::{
    ode::{BandMut, Failure, Ode},
    sundials::{
        ArkodeOptions, Coupling, Error, Integrator, Jacobian, LinearSolver, Multirate,
        MultirateOptions, Predictor, Tableau,
    },
};

use crate::Figures;

const N: usize = 101;
const DX: f64 = 1.0 / (N - 1) as f64;
const DIFFUSION: f64 = 0.01 / DX / DX;
const ADVECTION: f64 = 0.001 / 2.0 / DX;
const A: f64 = 0.6;
const B: f64 = 2.0;

struct Slow;

impl Ode for Slow {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        for i in 3..3 * (N - 1) {
            ydot[i] = (y[i - 3] - 2.0 * y[i] + y[i + 3]) * DIFFUSION;
        }
        Ok(())
    }

    fn banded_jacobian(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        mut jacobian: BandMut<'_>,
    ) -> Result<(), Failure> {
        for i in 3..3 * (N - 1) {
            jacobian[(i, i - 3)] = DIFFUSION;
            jacobian[(i, i)] = -2.0 * DIFFUSION;
            jacobian[(i, i + 3)] = DIFFUSION;
        }
        Ok(())
    }

    fn is_split(&self) -> bool {
        true
    }

    fn explicit_rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        for i in 3..3 * (N - 1) {
            ydot[i] = (y[i + 3] - y[i - 3]) * ADVECTION;
        }
        Ok(())
    }
}

fn reactions(_t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    for i in 1..N - 1 {
        let (u, v, w) = (y[3 * i], y[3 * i + 1], y[3 * i + 2]);
        ydot[3 * i] = A - (w + 1.0) * u + v * u * u;
        ydot[3 * i + 1] = w * u - v * u * u;
        ydot[3 * i + 2] = (B - w) / 0.01 - w * u;
    }
    Ok(())
}

pub fn imex(figures: &mut Figures) -> Result<(), Error> {
    let example = "ark_brusselator1D_imexmri 4 0.001";
    let bump = |i: usize| 0.1 * (PI * i as f64 * DX).sin();
    let y0: Vec<f64> = (0..N).flat_map(|i| [A, B / A, B].map(|y| y + bump(i))).collect();
    let a: [&[f64]; 3] = [&[], &[0.5], &[-1.0, 2.0]];
    let erk33 = Tableau::new(3, a, [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0]).embedded(2, [0.0, 1.0, 0.0]);
    let inner = ArkodeOptions::new(1e-4, 1e-9).tableau(erk33).fixed_step(1e-4);
    let newton = LinearSolver::Band { lower: 4, upper: 4, jacobian: Jacobian::Supplied };
    let options = MultirateOptions::new(1e-3, 1e-12, 1e-14)
        .coupling(Coupling::ImEx3b)
        .newton(newton)
        .check_jacobian(false)
        .max_iterations(10)
        .predictor(Predictor::Trivial);
    let mut solver = Multirate::new(Slow, reactions, 0.0, &y0, &options, &inner)?;
    let printed = [
        [0.845690, 3.082939, 1.983862],
        [1.164832, 2.458318, 1.978066],
        [0.966116, 2.205723, 1.981334],
        [0.576871, 2.504978, 1.988907],
        [0.412298, 2.877557, 1.992321],
        [0.380412, 3.177317, 1.993012],
        [0.386840, 3.417658, 1.992876],
        [0.405808, 3.608066, 1.992470],
        [0.433411, 3.747387, 1.991882],
        [0.473401, 3.825663, 1.991043],
    ];
    let mut last = [[0.0; 2]; 3];
    let mut most: f64 = 0.0;
    for (k, printed) in printed.iter().enumerate() {
        solver.solve_to((k + 1) as f64)?;
        for (part, printed) in printed.iter().enumerate() {
            let squares = (0..N).map(|i| solver.y()[3 * i + part].powi(2));
            let norm = (squares.sum::<f64>() / N as f64).sqrt();
            last[part] = [*printed, norm];
            most = most.max((norm - printed).abs());
        }
    }
    for (name, [printed, found]) in ["u(10)", "v(10)", "w(10)"].into_iter().zip(last) {
        let digits = if printed < 1.0 { 5 } else { 6 };
        figures.number(example, name, printed, digits, found);
    }
    // half of the last digit that is printed, at all ten times
    figures.count(example, "norms that differ by more than 5e-7", 0, u64::from(most > 5.001e-7));
    let (slow, fast) = (solver.statistics(), solver.fast_statistics());
    for (name, printed, found) in [
        ("slow steps", 10_001, slow.steps),
        ("fast steps", 110_011, fast.steps),
        ("explicit slow evaluations", 40_005, slow.explicit_evaluations),
        ("fast evaluations", 370_038, fast.evaluations),
        ("Newton iterations", 38_883, slow.nonlinear_iterations),
        ("Jacobians", 501, slow.jacobian_evaluations),
    ] {
        figures.count(example, name, printed, found);
    }
    Ok(())
}
