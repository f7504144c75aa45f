//! Helpers of the SUNDIALS tests.

use faer::{
    Mat,
    linalg::solvers::{PartialPivLu, Solve},
};
use pliant::ode::{Dae, Failure, Functional, Ode, Slopes};

/// The functional G = y0(T).
pub struct End;

impl Functional for End {
    fn terminal(
        &mut self,
        _t: f64,
        y: &[f64],
        _p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        if let Some(slopes) = slopes {
            slopes.y[0] = 1.0;
        }
        Ok(y[0])
    }
}

/// A system that solves Newton's linear systems itself, by a dense LU of its own Jacobian.
pub struct OwnSolver<S> {
    pub system: S,
    jacobian: Mat<f64>,
    factors: Option<PartialPivLu<f64>>,
    pub setups: usize,
    pub solves: usize,
}

impl<S> OwnSolver<S> {
    pub fn new(system: S, n: usize) -> Self {
        Self { system, jacobian: Mat::zeros(n, n), factors: None, setups: 0, solves: 0 }
    }

    fn factorize(&mut self, matrix: Mat<f64>) {
        self.factors = Some(matrix.partial_piv_lu());
        self.setups += 1;
    }

    fn solve(&mut self, r: &mut [f64]) {
        let b = Mat::from_fn(r.len(), 1, |i, _| r[i]);
        let x = self.factors.as_ref().expect("set up before").solve(&b);
        for (i, r) in r.iter_mut().enumerate() {
            *r = x[(i, 0)];
        }
        self.solves += 1;
    }
}

impl<S: Ode> Ode for OwnSolver<S> {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.system.rhs(t, y, ydot)
    }

    fn newton_setup(
        &mut self,
        t: f64,
        y: &[f64],
        ydot: &[f64],
        gamma: f64,
        reuse: bool,
    ) -> Result<bool, Failure> {
        if !reuse {
            self.jacobian.fill(0.0);
            self.system.dense_jacobian(t, y, ydot, self.jacobian.as_mut())?;
        }
        let jacobian = &self.jacobian;
        self.factorize(Mat::from_fn(y.len(), y.len(), |i, j| {
            f64::from(u8::from(i == j)) - gamma * jacobian[(i, j)]
        }));
        Ok(!reuse)
    }

    fn newton_solve(&mut self, _gamma: f64, r: &mut [f64]) -> Result<(), Failure> {
        self.solve(r);
        Ok(())
    }
}

impl<S: Dae> Dae for OwnSolver<S> {
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        self.system.residual(t, y, yp, r)
    }

    fn newton_setup(&mut self, t: f64, cj: f64, y: &[f64], yp: &[f64]) -> Result<(), Failure> {
        self.jacobian.fill(0.0);
        self.system.dense_jacobian(t, cj, y, yp, self.jacobian.as_mut())?;
        self.factorize(self.jacobian.clone());
        Ok(())
    }

    fn newton_solve(&mut self, r: &mut [f64]) -> Result<(), Failure> {
        self.solve(r);
        Ok(())
    }
}
