//! Jacobians that users bring: by closures, dense and banded.

use pliant::{
    ode::{BandMut, Dae, Failure, Ode, with_jacobian},
    sundials::{Cvode, CvodeOptions, Ida, IdaOptions, Integrator, Jacobian, LinearSolver},
};

#[test]
fn a_closure_brings_its_jacobian() {
    let rhs = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot[0] = -1e6 * (y[0] - 3.0);
        Ok(())
    };
    let mut calls = 0;
    let system = with_jacobian(rhs, |_t, _y, _ydot, mut jacobian| {
        calls += 1;
        jacobian[(0, 0)] = -1e6;
        Ok(())
    });
    let options = CvodeOptions::new(1e-6, 1e-9).newton(LinearSolver::Dense(Jacobian::Supplied));
    let mut solver = Cvode::new(system, 0.0, &[0.0], &options).unwrap();
    solver.solve_to(1.0).unwrap();
    assert!((solver.y()[0] - 3.0).abs() < 1e-5);
    let statistics = solver.statistics();
    assert_eq!(statistics.difference_quotient_evaluations, 0);
    drop(solver);
    assert_eq!(calls, statistics.jacobian_evaluations);
}

/// Heat along a rod with cold ends, by second differences at n inner points, without (ODE) and
/// with (DAE) an implicit time derivative.
struct Rod(usize);

impl Ode for Rod {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let (n, scale) = (self.0, ((self.0 + 1) * (self.0 + 1)) as f64);
        for i in 0..n {
            let left = if i > 0 { y[i - 1] } else { 0.0 };
            let right = if i + 1 < n { y[i + 1] } else { 0.0 };
            ydot[i] = scale * (left - 2.0 * y[i] + right);
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
        assert_eq!((jacobian.lower(), jacobian.upper()), (1, 1));
        let scale = ((self.0 + 1) * (self.0 + 1)) as f64;
        for i in 0..self.0 {
            jacobian[(i, i)] = -2.0 * scale;
            if i > 0 {
                jacobian[(i - 1, i)] = scale;
                jacobian[(i, i - 1)] = scale;
            }
        }
        Ok(())
    }
}

impl Dae for Rod {
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        self.rhs(t, y, r)?;
        for (r, yp) in r.iter_mut().zip(yp) {
            *r -= yp;
        }
        Ok(())
    }

    fn banded_jacobian(
        &mut self,
        t: f64,
        cj: f64,
        y: &[f64],
        yp: &[f64],
        mut jacobian: BandMut<'_>,
    ) -> Result<(), Failure> {
        for i in 0..self.0 {
            jacobian[(i, i)] = -2.0 * ((self.0 + 1) * (self.0 + 1)) as f64 - cj;
            if i > 0 {
                let scale = ((self.0 + 1) * (self.0 + 1)) as f64;
                jacobian[(i - 1, i)] = scale;
                jacobian[(i, i - 1)] = scale;
            }
        }
        let _ = (t, y, yp);
        Ok(())
    }
}

#[test]
fn a_supplied_band_jacobian_solves_the_heat_equation() {
    // The first sine is an eigenvector of the second differences, so the answer is exact.
    let n = 50;
    let sine = |i: usize| (std::f64::consts::PI * (i + 1) as f64 / (n + 1) as f64).sin();
    let y0: Vec<f64> = (0..n).map(sine).collect();
    let step = std::f64::consts::PI / (n + 1) as f64;
    let rate = -2.0 * (1.0 - step.cos()) * ((n + 1) * (n + 1)) as f64;
    let exact = (0.1 * rate).exp();
    let error = |y: &[f64]| y.iter().zip(&y0).map(|(y, y0)| (y - exact * y0).abs()).sum::<f64>();
    let band = LinearSolver::Band { lower: 1, upper: 1, jacobian: Jacobian::Supplied };

    let options = CvodeOptions::new(1e-8, 1e-11).newton(band.clone());
    let mut solver = Cvode::new(Rod(n), 0.0, &y0, &options).unwrap();
    solver.solve_to(0.1).unwrap();
    assert!(error(solver.y()) < 1e-5, "{}", error(solver.y()));
    assert_eq!(solver.statistics().difference_quotient_evaluations, 0);
    assert!(solver.statistics().nonlinear_failures < 3);

    let yp0: Vec<f64> = y0.iter().map(|y| rate * y).collect();
    let options = IdaOptions::new(1e-8, 1e-11).newton(band);
    let mut solver = Ida::new(Rod(n), 0.0, &y0, &yp0, &options).unwrap();
    solver.solve_to(0.1).unwrap();
    assert!(error(solver.y()) < 1e-5, "{}", error(solver.y()));
    assert!(solver.statistics().nonlinear_failures < 3);
}
