//! Systems M y' = f(y): `newton_rhs` spares solving for y' in each iteration, and changes nothing else.

use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{Mat, mat};
use pliant::ode::{Failure, Ode};
use pliant::sundials::{Arkode, ArkodeOptions, Cvode, CvodeOptions, Integrator, LinearSolver};

/// M y' = f(y), stiff and not linear.
struct Heavy {
    mass: Mat<f64>,
    inverse: PartialPivLu<f64>,
    newton: Option<PartialPivLu<f64>>,
    force: Mat<f64>,
    /// Whether y' is left to `newton_solve`.
    leaves_out: bool,
    solves_for_slope: usize,
}

const RATES: [f64; 3] = [1.0, 50.0, 2e3];
const Y0: [f64; 3] = [1.0, -0.5, 0.2];

impl Heavy {
    fn new(leaves_out: bool) -> Self {
        let mass = mat![[2.0, 0.5, 0.0], [0.5, 1.0, 0.3], [0.0, 0.3, 4.0]];
        let (inverse, force) = (mass.partial_piv_lu(), Mat::zeros(3, 1));
        Self { mass, inverse, newton: None, force, leaves_out, solves_for_slope: 0 }
    }

    fn evaluate(&mut self, t: f64, y: &[f64]) {
        for (i, rate) in RATES.iter().enumerate() {
            self.force[(i, 0)] = rate * (t.cos() - y[i] - y[i].powi(3));
        }
    }
}

impl Ode for Heavy {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.evaluate(t, y);
        ydot.copy_from_slice(self.inverse.solve(&self.force).col_as_slice(0));
        self.solves_for_slope += 1;
        Ok(())
    }

    fn newton_rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        if !self.leaves_out {
            return self.rhs(t, y, ydot);
        }
        self.evaluate(t, y);
        ydot.fill(0.0);
        Ok(())
    }

    fn newton_setup(
        &mut self,
        _t: f64,
        y: &[f64],
        _ydot: &[f64],
        gamma: f64,
        _reuse: bool,
    ) -> Result<bool, Failure> {
        let mut matrix = self.mass.clone();
        for (i, rate) in RATES.iter().enumerate() {
            matrix[(i, i)] += gamma * rate * (1.0 + 3.0 * y[i] * y[i]);
        }
        self.newton = Some(matrix.partial_piv_lu());
        Ok(true)
    }

    fn newton_solve(&mut self, gamma: f64, r: &mut [f64]) -> Result<(), Failure> {
        let mut right = &self.mass * Mat::from_fn(3, 1, |i, _| r[i]);
        if self.leaves_out {
            right += gamma * &self.force;
        }
        let newton = self.newton.as_ref().expect("set up before");
        r.copy_from_slice(newton.solve(&right).col_as_slice(0));
        Ok(())
    }
}

/// Runs twice, from the start and anew, by `$solver`: the states, and the evaluations that solved
/// for y'.
macro_rules! run {
    ($solver:ident, $options:ident, $leaves_out:expr) => {{
        let options = $options::new(1e-6, 1e-9).newton(LinearSolver::Custom);
        let mut solver = $solver::new(Heavy::new($leaves_out), 0.0, &Y0, &options).unwrap();
        let mut states = Vec::new();
        for _ in 0..2 {
            for t in [0.01, 0.1, 0.3] {
                solver.solve_to(t).unwrap();
                states.extend_from_slice(solver.y());
            }
            solver.reinit(0.0, &Y0).unwrap();
        }
        (states, solver.into_system().solves_for_slope)
    }};
}

#[test]
fn slopes_left_to_the_solver_change_nothing_but_the_work() {
    for (name, [whole, left]) in [
        ("CVODE", [false, true].map(|leaves| run!(Cvode, CvodeOptions, leaves))),
        ("ARKODE", [false, true].map(|leaves| run!(Arkode, ArkodeOptions, leaves))),
    ] {
        // only rounding differs, over so short a time that it tips no decision about a step
        let apart = whole.0.iter().zip(&left.0).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("{name}: {apart:e} apart, {} and {} solutions for y'", whole.1, left.1);
        assert!(apart < 2e-12, "{name}: {apart:e}");
        // those of first steps and of the one explicit stage of ARKODE's steps are left
        assert!(left.1 > 0 && whole.1 > 10 * left.1, "{name}: {} {}", whole.1, left.1);
    }
}
