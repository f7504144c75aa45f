//! `cvsRoberts_dns` and `idasRoberts_dns`: Robertson's reactions as an ODE and as a DAE, with two root functions.

use pliant::{
    faer::MatMut,
    ode::{Dae, Failure, Ode},
    sundials::{
        Cvode, CvodeOptions, Error, Ida, IdaOptions, Integrator, Jacobian, LinearSolver, Reached,
        Statistics,
    },
};

use crate::Figures;

struct Reactions;

const DENSE: LinearSolver = LinearSolver::Dense(Jacobian::Supplied);

fn roots(y: &[f64], g: &mut [f64]) {
    g.copy_from_slice(&[y[0] - 1e-4, y[2] - 0.01]);
}

impl Ode for Reactions {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let yd1 = -0.04 * y[0] + 1e4 * y[1] * y[2];
        let yd3 = 3e7 * y[1] * y[1];
        ydot.copy_from_slice(&[yd1, -yd1 - yd3, yd3]);
        Ok(())
    }

    fn dense_jacobian(
        &mut self,
        _t: f64,
        y: &[f64],
        _ydot: &[f64],
        mut j: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        (j[(0, 0)], j[(0, 1)], j[(0, 2)]) = (-0.04, 1e4 * y[2], 1e4 * y[1]);
        (j[(1, 0)], j[(1, 1)], j[(1, 2)]) = (0.04, -1e4 * y[2] - 6e7 * y[1], -1e4 * y[1]);
        j[(2, 1)] = 6e7 * y[1];
        Ok(())
    }

    fn root_count(&self) -> usize {
        2
    }

    fn roots(&mut self, _t: f64, y: &[f64], g: &mut [f64]) -> Result<(), Failure> {
        roots(y, g);
        Ok(())
    }
}

impl Dae for Reactions {
    fn residual(&mut self, _t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        r[0] = -0.04 * y[0] + 1e4 * y[1] * y[2];
        r[1] = -r[0] - 3e7 * y[1] * y[1] - yp[1];
        r[0] -= yp[0];
        r[2] = y[0] + y[1] + y[2] - 1.0;
        Ok(())
    }

    fn dense_jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        y: &[f64],
        _yp: &[f64],
        mut j: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        (j[(0, 0)], j[(1, 0)], j[(2, 0)]) = (-0.04 - cj, 0.04, 1.0);
        (j[(0, 1)], j[(1, 1)], j[(2, 1)]) = (1e4 * y[2], -1e4 * y[2] - 6e7 * y[1] - cj, 1.0);
        (j[(0, 2)], j[(1, 2)], j[(2, 2)]) = (1e4 * y[1], -1e4 * y[1], 1.0);
        Ok(())
    }

    fn root_count(&self) -> usize {
        2
    }

    fn roots(&mut self, _t: f64, y: &[f64], _yp: &[f64], g: &mut [f64]) -> Result<(), Failure> {
        roots(y, g);
        Ok(())
    }
}

/// The times of both roots and the state at 4e10.
fn run(mut solver: impl Integrator) -> Result<([f64; 2], Vec<f64>, Statistics), Error> {
    let (mut found, mut tout) = (Vec::new(), 0.4);
    for _ in 0..12 {
        while solver.solve_to(tout)? == Reached::Root {
            found.push(solver.t());
        }
        tout *= 10.0;
    }
    let times = [found.first(), found.get(1)].map(|t| t.copied().unwrap_or(f64::NAN));
    Ok((times, solver.y().to_vec(), solver.statistics()))
}

pub fn cvodes(figures: &mut Figures) -> Result<(), Error> {
    let example = "cvsRoberts_dns";
    // the weights of the example are a function, too
    let atol = [1e-8, 1e-14, 1e-6];
    let options = CvodeOptions::new(1e-4, atol).newton(DENSE).error_weights(move |y, weights| {
        for i in 0..3 {
            weights[i] = 1.0 / (1e-4 * y[i].abs() + atol[i]);
        }
    });
    let options = options.check_jacobian(false);
    let (roots, y, s) = run(Cvode::new(Reactions, 0.0, &[1.0, 0.0, 0.0], &options)?)?;
    figures.number(example, "first root", 2.6391e-1, 4, roots[0]);
    figures.number(example, "second root", 2.0790e7, 4, roots[1]);
    for (name, printed, found) in [
        ("y1(4e10)", 6.934511e-8, y[0]),
        ("y2(4e10)", 2.773804e-13, y[1]),
        ("y3(4e10)", 9.999999e-1, y[2]),
    ] {
        figures.number(example, name, printed, 6, found);
    }
    for (name, printed, found) in [
        ("steps", 542, s.steps),
        ("failed error tests", 22, s.error_test_failures),
        ("evaluations", 754, s.evaluations),
        ("Newton iterations", 751, s.nonlinear_iterations),
        ("failures to converge", 3, s.nonlinear_failures),
        ("setups", 107, s.linear_setups),
        ("Jacobians", 11, s.jacobian_evaluations),
        ("root evaluations", 570, s.root_evaluations),
    ] {
        figures.count(example, name, printed, found);
    }
    Ok(())
}

pub fn idas(figures: &mut Figures) -> Result<(), Error> {
    let example = "idasRoberts_dns";
    let options = IdaOptions::new(1e-4, [1e-8, 1e-6, 1e-6]).newton(DENSE).check_jacobian(false);
    let (y0, yp0) = ([1.0, 0.0, 0.0], [-0.04, 0.04, 0.0]);
    let (roots, y, s) = run(Ida::new(Reactions, 0.0, &y0, &yp0, &options)?)?;
    figures.number(example, "first root", 2.6402e-1, 4, roots[0]);
    figures.number(example, "second root", 2.0788e7, 4, roots[1]);
    for (name, printed, found) in
        [("y1(4e10)", 4.8641e-8, y[0]), ("y2(4e10)", 1.9456e-13, y[1]), ("y3(4e10)", 1.0, y[2])]
    {
        figures.number(example, name, printed, 4, found);
    }
    for (name, printed, found) in [
        ("steps", 362, s.steps),
        ("failed error tests", 15, s.error_test_failures),
        ("evaluations", 537, s.evaluations),
        ("failures to converge", 5, s.nonlinear_failures),
        ("setups", 60, s.linear_setups),
        ("Jacobians", 60, s.jacobian_evaluations),
        ("root evaluations", 404, s.root_evaluations),
    ] {
        figures.count(example, name, printed, found);
    }
    Ok(())
}
