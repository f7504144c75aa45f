//! `ark_onewaycouple_mri`: a slow oscillation that drives a decay.

use pliant::sundials::{ArkodeOptions, Error, Integrator, Multirate, MultirateOptions, Tableau};

use crate::Figures;

pub fn coupling(figures: &mut Figures) -> Result<(), Error> {
    let example = "ark_onewaycouple_mri";
    let slow = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot.copy_from_slice(&[-50.0 * y[1], 50.0 * y[0], y[0] + y[1]]);
        Ok(())
    };
    let fast = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot[2] = -y[2];
        Ok(())
    };
    let a: [&[f64]; 3] = [&[], &[1.0 / 3.0], &[-3.0 / 16.0, 15.0 / 16.0]];
    let knoth_wolke = Tableau::new(3, a, [1.0 / 6.0, 3.0 / 10.0, 8.0 / 15.0]);
    let inner = ArkodeOptions::new(1e-4, 1e-9).tableau(knoth_wolke).fixed_step(1e-4);
    let options = MultirateOptions::new(1e-3, 1e-4, 1e-9);
    let mut solver = Multirate::new(slow, fast, 0.0, &[1.0, 0.0, 2.0], &options, &inner)?;
    let mut tout: f64 = 0.0;
    for _ in 0..10 {
        tout = (tout + 0.1).min(1.0);
        solver.solve_to(tout)?;
    }
    let y = solver.y();
    for (name, printed, digits, found) in [
        ("u(1)", 9.64718e-1, 5, y[0]),
        ("v(1)", -2.62297e-1, 5, y[1]),
        ("w(1)", 7.18717e-1, 5, y[2]),
    ] {
        figures.number(example, name, printed, digits, found);
    }
    let (slow, fast) = (solver.statistics(), solver.fast_statistics());
    figures.count(example, "slow steps", 1000, slow.steps);
    figures.count(example, "fast steps", 12_000, fast.steps);
    figures.count(example, "slow evaluations", 3001, slow.evaluations);
    figures.count(example, "fast evaluations", 49_002, fast.evaluations);
    Ok(())
}
