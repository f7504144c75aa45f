//! Residuals written over a number type: their derivatives are those by hand, to rounding, and those of differences.

use faer::Mat;
use pliant::{
    automatic::{Automatic, Number, Residual, automatic},
    ode::{BandMut, Dae, Failure, Functional, Slopes, check},
    solve::{Method, Options, Problem, solve},
    sundials::{
        AdjointOptions, DaeAdjoint, Ida, IdaOptions, InitialCondition, Integrator, Krylov,
        KrylovMethod, LinearSolver, Pattern, Sensitivities, SensitivitySource,
    },
};

/// Unknowns (z, y, w, x), of which z and w are algebraic, in equations in another order, with parameters in dF/dy'.
struct Mixed;

const P: [f64; 3] = [0.7, 1.3, -0.4];
const N: usize = 4;

impl Residual for Mixed {
    fn residual<T: Number>(
        &mut self,
        t: f64,
        y: &[T],
        yp: &[T],
        p: &[T],
        r: &mut [T],
    ) -> Result<(), Failure> {
        r[0] = y[3] - y[2] - y[2].powi(3) * 0.3;
        r[1] = yp[1] * 2.0 + p[0] * yp[3] + p[1] * y[1] - y[0];
        r[2] = y[0] - p[2] * y[1].sin() - y[2];
        // added to zero
        r[3] += yp[1] + yp[3] * 3.0 + y[3] + y[2] * y[0] - t;
        Ok(())
    }
}

/// dF/dy, dF/dy' and dF/dp by hand.
fn by_hand(y: &[f64], yp: &[f64]) -> [Mat<f64>; 3] {
    let (mut by_y, mut by_yp, mut by_p) = (Mat::zeros(N, N), Mat::zeros(N, N), Mat::zeros(N, 3));
    (by_y[(0, 3)], by_y[(0, 2)]) = (1.0, -1.0 - 0.9 * y[2] * y[2]);
    (by_y[(1, 1)], by_y[(1, 0)]) = (P[1], -1.0);
    (by_yp[(1, 1)], by_yp[(1, 3)]) = (2.0, P[0]);
    (by_y[(2, 0)], by_y[(2, 1)], by_y[(2, 2)]) = (1.0, -P[2] * y[1].cos(), -1.0);
    (by_y[(3, 3)], by_y[(3, 2)], by_y[(3, 0)]) = (1.0, y[0], y[2]);
    (by_yp[(3, 1)], by_yp[(3, 3)]) = (1.0, 3.0);
    (by_p[(1, 0)], by_p[(1, 1)], by_p[(2, 2)]) = (yp[3], y[1], -y[1].sin());
    [by_y, by_yp, by_p]
}

fn pattern() -> Pattern {
    let entries = [(0, 3), (1, 0), (1, 3), (2, 0), (2, 1), (3, 0), (3, 1), (3, 2), (0, 2)];
    Pattern::from_entries(N, entries).unwrap()
}

const Y: [f64; N] = [0.3, 1.2, -0.6, 0.8];
const YP: [f64; N] = [0.1, -0.7, 0.4, 1.5];

#[test]
fn derivatives_are_those_by_hand() {
    let (t, cj) = (0.9, 2.7);
    let [by_y, by_yp, by_p] = by_hand(&Y, &YP);
    let expected = Mat::from_fn(N, N, |i, j| by_y[(i, j)] + cj * by_yp[(i, j)]);
    // of numbers up to 10
    let near = |found: f64, expected: f64| {
        assert!((found - expected).abs() < 20.0 * f64::EPSILON, "{found:e} {expected:e}");
    };
    let make = || automatic(Mixed, P);
    let mut dense = Mat::zeros(N, N);
    let (mut band, mut values) = (vec![0.0; 7 * N], vec![0.0; pattern().entry_count()]);
    make().dense_jacobian(t, cj, &Y, &YP, dense.as_mut()).unwrap();
    let of_band = BandMut::new(&mut band, 7, 3, 3, 3);
    make().banded(3, 3).banded_jacobian(t, cj, &Y, &YP, of_band).unwrap();
    make().sparse(pattern()).sparse_jacobian(t, cj, &Y, &YP, &mut values).unwrap();
    let of_band = BandMut::new(&mut band, 7, 3, 3, 3);
    for i in 0..N {
        for j in 0..N {
            near(dense[(i, j)], expected[(i, j)]);
            near(of_band[(i, j)], expected[(i, j)]);
            let value = pattern().position(i, j).map_or(0.0, |position| values[position]);
            near(value, expected[(i, j)]);
        }
    }
    // another form than that of the linear solver
    let mut wrong = make().banded(1, 1);
    let of_band = BandMut::new(&mut band, 7, 3, 3, 3);
    assert!(Dae::banded_jacobian(&mut wrong, t, cj, &Y, &YP, of_band).is_err());
    assert!(Dae::sparse_jacobian(&mut wrong, t, cj, &Y, &YP, &mut values).is_err());

    let (v, w) = ([0.3, -1.1, 0.5, 0.9], [-0.2, 0.6, 1.4, -0.8]);
    for mut system in [make(), make().sparse(pattern()), make().banded(3, 3)] {
        let mut out = [0.0; N];
        system.jacobian_times(t, cj, &Y, &YP, &v, &mut out).unwrap();
        for i in 0..N {
            near(out[i], (0..N).map(|j| expected[(i, j)] * v[j]).sum());
        }
        out.fill(0.0);
        system.adjoint_residual(t, &Y, &YP, &v, &w, &mut out).unwrap();
        for j in 0..N {
            let product = (0..N).map(|i| by_y[(i, j)] * v[i] + by_yp[(i, j)] * w[i]);
            near(out[j], product.sum());
        }
        let mut by_parameters = [0.0; 3];
        system.adjoint_parameters(t, &Y, &YP, &v, &mut by_parameters).unwrap();
        for (k, found) in by_parameters.into_iter().enumerate() {
            near(found, (0..N).map(|i| by_p[(i, k)] * v[i]).sum());
            out.fill(0.0);
            system.sensitivity_residual(t, &Y, &YP, k, &v, &w, &mut out).unwrap();
            for i in 0..N {
                let product = (0..N).map(|j| by_y[(i, j)] * v[j] + by_yp[(i, j)] * w[j]);
                near(out[i], product.sum::<f64>() + by_p[(i, k)]);
            }
        }
    }
    check::sensitivity_residual(&mut make(), t, (&Y, &YP), (&v, &w)).unwrap();
    check::dae_jacobian(&mut make(), t, cj, &Y, &YP, check::Storage::Dense).unwrap();
}

/// Robertson's reactions with a conservation law, as in `idasHessian_ASA_FSA` of SUNDIALS 6.4.1.
struct Reactions;

impl Residual for Reactions {
    fn residual<T: Number>(
        &mut self,
        _t: f64,
        y: &[T],
        yp: &[T],
        p: &[T],
        r: &mut [T],
    ) -> Result<(), Failure> {
        let exchange = p[0] * y[0] - p[1] * y[1] * y[2];
        r[0] = yp[0] + exchange;
        r[1] = yp[1] - exchange + y[1] * y[1] * 3e7;
        r[2] = y[0] + y[1] + y[2] - 1.0;
        Ok(())
    }
}

const START: [f64; 3] = [1.0, 0.0, 0.0];

fn reactions() -> Automatic<Reactions> {
    automatic(Reactions, [0.04, 1e4])
}

/// y_0(40) = 0.7158270688 (published), without a difference, in each form and by the products, also of the sensitivities.
#[test]
fn runs_take_no_differences() {
    let full = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
    let full = Pattern::from_entries(3, full).unwrap();
    for system in [reactions(), reactions().banded(2, 2), reactions().sparse(full)] {
        let problem = Problem::dae(system, START, [-0.04, 0.04, 0.0]);
        let sensitivities = Sensitivities::of([0]).source(SensitivitySource::Supplied);
        let options = Options::new(1e-8, 1e-14).sensitivities(sensitivities);
        let solution = solve(problem, Method::Ida, (0.0, 40.0), &options).unwrap();
        println!("{}", solution.last()[0]);
        assert!((solution.last()[0] - 0.715_827_068_8).abs() < 1e-7);
        assert_eq!(solution.statistics().difference_quotient_evaluations, 0);
    }
    let krylov = Krylov::new(KrylovMethod::Gmres { dimension: 3, restarts: 1 })
        .products(pliant::sundials::Jacobian::Supplied);
    let options = IdaOptions::new(1e-6, 1e-10)
        .newton(LinearSolver::Krylov(krylov))
        .differential([true, true, false]);
    let mut ida = Ida::new(reactions(), 0.0, &START, &[-0.04, 0.04, 0.0], &options).unwrap();
    ida.consistent_start(InitialCondition::Algebraic, 40.0).unwrap();
    ida.solve_to(40.0).unwrap();
    assert!((ida.y()[0] - 0.715_827_068_8).abs() < 1e-4);
    assert_eq!(ida.statistics().difference_quotient_evaluations, 0);
}

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

/// Gradient and Hessian of that example, of which its `.out` prints five digits, by exact first derivatives.
#[test]
fn gradient_and_hessian_of_the_example_of_idas() {
    let forward = IdaOptions::new(1e-8, 1e-10)
        .newton(reactions().linear_solver())
        .differential([true, true, false]);
    let back = AdjointOptions::new(1e-8, 1e-8).supplied_rhs().supplied_parameters();
    let yp0 = [-0.04, 0.04, 0.0];
    let made = DaeAdjoint::new(reactions(), HalfSquare, 0.0, &START, &yp0, &forward, &back);
    let mut adjoint = made.unwrap();
    let gradient = adjoint.gradient(80.0).unwrap();
    let columns = [[1.0, 0.0], [0.0, 1.0]].map(|v| adjoint.hessian_times(80.0, &v).unwrap());
    for (found, printed) in [
        (gradient.parameters[0], -1.3753e2),
        (gradient.parameters[1], 4.1552e-4),
        (columns[0].parameters[0], 4.4243e3),
        (columns[0].parameters[1], -2.7779e-3),
        (columns[1].parameters[0], -2.7779e-3),
        (columns[1].parameters[1], -2.4173e-8),
    ] {
        println!("{found:e} {printed:e}");
        // half of the last digit that is printed
        assert!((found / printed - 1.0).abs() < 3.7e-5, "{found} {printed}");
    }
}

/// These equations with a product by the unknowns, and one by the parameters, that may be wrong.
struct Wrong(Automatic<Mixed>, [f64; 2]);

impl Dae for Wrong {
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        self.0.residual(t, y, yp, r)
    }

    fn adjoint_residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        lambda: &[f64],
        mu: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        self.0.adjoint_residual(t, y, yp, lambda, mu, out)?;
        out[1] *= self.1[0];
        Ok(())
    }

    fn adjoint_parameters(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        self.0.adjoint_parameters(t, y, yp, lambda, out)?;
        out[2] *= self.1[1];
        Ok(())
    }

    fn parameters(&self) -> &[f64] {
        self.0.parameters()
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.0.set_parameters(values);
    }
}

/// Differences, without a solver, find the products right, and name one that is wrong by a thousandth.
#[test]
fn products_are_checked() {
    let (at, v) = ((&Y[..], &YP[..]), [0.3, -1.1, 0.5, 0.9]);
    let entry = |outcome: Result<(), check::CheckError>| match outcome {
        Ok(()) => None,
        Err(check::CheckError::Mismatch { entry, .. }) => Some(entry),
        Err(error) => panic!("{error}"),
    };
    let new = |factors| Wrong(automatic(Mixed, P), factors);
    let by_state = |factor| {
        let mut system = new([factor, 1.0]);
        entry(check::adjoint_residual(&mut system, 0.9, at, (&v, &Y)))
    };
    assert_eq!((by_state(1.0), by_state(1.001)), (None, Some((0, 1))));
    let by_parameters = |factor| {
        let mut system = new([1.0, factor]);
        entry(check::dae_adjoint_parameters(&mut system, 0.9, at, &v))
    };
    assert_eq!((by_parameters(1.0), by_parameters(1.001)), (None, Some((0, 2))));
    let short = check::adjoint_residual(&mut new([1.0; 2]), 0.9, at, (&v[1..], &Y));
    assert!(short.unwrap_err().to_string().contains("lambda"));
}
