//! Solvers that are called again after a failure.

use faer::MatMut;
use pliant::{
    ode::{BandMut, Failure, Ode, with_mass},
    sundials::{
        Arkode, ArkodeOptions, Cvode, CvodeOptions, Ida, IdaOptions, Integrator, Jacobian,
        LinearSolver, MassForm, Multistep, Pattern,
    },
};

/// y_i' = -1000 (y_i - 1), whose first Jacobian cannot be evaluated.
struct LateJacobian {
    has_failed: bool,
}

impl LateJacobian {
    fn fail_once(&mut self) -> Result<(), Failure> {
        match std::mem::replace(&mut self.has_failed, true) {
            true => Ok(()),
            false => Err(Failure::Fatal("not yet".into())),
        }
    }
}

impl Ode for LateJacobian {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot.iter_mut().zip(y).for_each(|(ydot, y)| *ydot = -1000.0 * (y - 1.0));
        Ok(())
    }

    fn dense_jacobian(
        &mut self,
        _t: f64,
        y: &[f64],
        _ydot: &[f64],
        mut jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        (0..y.len()).for_each(|i| jacobian[(i, i)] = -1000.0);
        self.fail_once()
    }

    fn banded_jacobian(
        &mut self,
        _t: f64,
        y: &[f64],
        _ydot: &[f64],
        mut jacobian: BandMut<'_>,
    ) -> Result<(), Failure> {
        (0..y.len()).for_each(|i| jacobian[(i, i)] = -1000.0);
        self.fail_once()
    }

    fn sparse_jacobian(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        values.fill(-1000.0);
        self.fail_once()
    }
}

/// The matrix was left half written, with pivots of no matrix: places in memory.
#[test]
fn called_again_after_a_jacobian_failed_the_matrix_is_made_anew() {
    fn check(mut solver: impl Integrator) {
        assert!(solver.solve_to(0.1).is_err());
        assert_eq!(solver.y(), [0.0; 4]);
        solver.solve_to(0.1).unwrap();
        // long at rest there: a hundred time constants
        solver.y().iter().for_each(|y| assert!((y - 1.0).abs() < 1e-5, "{y}"));
    }
    let jacobian = Jacobian::Supplied;
    for newton in [
        LinearSolver::Dense(jacobian),
        LinearSolver::Band { lower: 1, upper: 1, jacobian },
        LinearSolver::Klu { pattern: Pattern::band(4, 0, 0).unwrap(), jacobian },
    ] {
        let (system, y0) = (|| LateJacobian { has_failed: false }, [0.0; 4]);
        let options = CvodeOptions::new(1e-6, 1e-8).newton(newton.clone());
        check(Cvode::new(system(), 0.0, &y0, &options).unwrap());
        let options = ArkodeOptions::new(1e-6, 1e-8).newton(newton.clone());
        check(Arkode::new(system(), 0.0, &y0, &options).unwrap());
        if let LinearSolver::Klu { .. } = newton {
            continue;
        }
        let mass = with_mass(system(), [1.0; 4]);
        let form = MassForm::new(mass, 4, &newton).unwrap();
        let options = IdaOptions::new(1e-6, 1e-8).newton(newton);
        check(Ida::new(form, 0.0, &y0, &[1000.0; 4], &options).unwrap());
    }
}

/// y' = y with its integral.
struct Growth;

impl Ode for Growth {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot[0] = y[0];
        Ok(())
    }

    fn quadrature_count(&self) -> usize {
        1
    }

    fn quadratures(&mut self, _t: f64, y: &[f64], qdot: &mut [f64]) -> Result<(), Failure> {
        qdot[0] = y[0];
        Ok(())
    }
}

/// From 1 it overflows at t = 709.8, in the prediction of a step, which C adds to its history and takes off again.
#[test]
fn where_numbers_overflow_the_last_good_state_is_kept() {
    for method in [Multistep::Bdf, Multistep::Adams] {
        let options = CvodeOptions::new(1e-6, 1e-8).method(method).max_steps(20_000);
        let mut solver = Cvode::new(Growth, 0.0, &[1.0], &options).unwrap();
        solver.solve_to(600.0).unwrap();
        let state = |solver: &Cvode<Growth>| (solver.t(), solver.y()[0], solver.quadratures()[0]);
        let before = state(&solver);
        for _ in 0..2 {
            solver.solve_to(1000.0).unwrap_err();
            assert_eq!(state(&solver), before);
            let mut y = [0.0];
            solver.interpolate(solver.t(), 0, &mut y).unwrap();
            assert_eq!(y[0], before.1);
        }
        // it goes on from there, with its integral
        solver.solve_to(601.0).unwrap();
        let (t, y, integral) = state(&solver);
        println!("{:e} {:e}", y / before.1 / 1f64.exp() - 1.0, integral / y - 1.0);
        assert!(t == 601.0 && (y / before.1 / 1f64.exp() - 1.0).abs() < 3e-5);
        assert!((integral / y - 1.0).abs() < 1e-6);

        let mut last = state(&solver);
        while solver.step(1000.0).is_ok() {
            last = state(&solver);
        }
        assert_eq!(state(&solver), last);
        assert!(last.1 > 1e308, "{last:?}");
    }
}
