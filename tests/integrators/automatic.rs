//! Equations written over a number type: their derivatives are those by hand, to rounding.

use faer::Mat;
use pliant::{
    automatic::{Automatic, Number, RightHandSide, automatic},
    ode::{BandMut, Failure, Functional, Ode, Slopes, check},
    samples::{Brusselator, Hires, Robertson},
    solve::{Method, Options, Output, Problem, gradient, solve},
    sundials::{
        AdjointOptions, Cvode, CvodeOptions, Integrator, Jacobian, LinearSolver, Pattern,
        Sensitivities, SensitivitySource,
    },
};

use self::equations::{Line, Plant};

#[path = "../../examples/automatic_jacobian/equations.rs"]
mod equations;

struct Reactions;

impl RightHandSide for Reactions {
    fn rhs<T: Number>(&mut self, _t: f64, y: &[T], p: &[T], ydot: &mut [T]) -> Result<(), Failure> {
        let (slow, back) = (p[0] * y[0], p[1] * y[1] * y[2]);
        ydot[2] = p[2] * y[1] * y[1];
        ydot[0] = back - slow;
        ydot[1] = slow - back - ydot[2];
        Ok(())
    }
}

const RATES: [f64; 3] = [0.04, 1e4, 3e7];

/// The dense Jacobian.
fn dense(system: &mut impl Ode, y: &[f64]) -> Mat<f64> {
    let mut jacobian = Mat::zeros(y.len(), y.len());
    system.dense_jacobian(0.0, y, &vec![0.0; y.len()], jacobian.as_mut()).unwrap();
    jacobian
}

/// Compares df/dy in all forms, products, their transposes and the right-hand side with those by hand.
fn compare<E: RightHandSide>(
    make: impl Fn() -> Automatic<E>,
    by_hand: &mut impl Ode,
    pattern: &Pattern,
    y: &[f64],
) {
    let n = y.len();
    let expected = dense(by_hand, y);
    // terms of a row are rounded, some in another order, and may cancel: relative to the largest of the row
    let size = |i: usize| (0..n).map(|j| expected[(i, j)].abs()).fold(0.0, f64::max);
    let near = |i: usize, value: f64, expected: f64, factor: f64| {
        let off = (value - expected).abs();
        assert!(off <= 4.0 * f64::EPSILON * factor * size(i), "{i}: {value:e} {expected:e}");
    };
    let mut system = make();
    let (mut f, mut f_by_hand) = (vec![0.0; n], vec![0.0; n]);
    system.rhs(0.0, y, &mut f).unwrap();
    by_hand.rhs(0.0, y, &mut f_by_hand).unwrap();
    let largest = y.iter().fold(0.0, |most: f64, y| most.max(y.abs()));
    (0..n).for_each(|i| near(i, f[i], f_by_hand[i], 8.0 * largest));

    let mut sparse = make().sparse(pattern.clone());
    for mut system in [system, make().sparse(pattern.clone()), make().banded(n - 1, n - 1)] {
        let found = dense(&mut system, y);
        (0..n * n).for_each(|k| near(k / n, found[(k / n, k % n)], expected[(k / n, k % n)], 1.0));
    }
    let mut values = vec![0.0; pattern.entry_count()];
    sparse.sparse_jacobian(0.0, y, &f, &mut values).unwrap();
    for i in 0..n {
        for j in 0..n {
            let value = pattern.position(i, j).map_or(0.0, |position| values[position]);
            near(i, value, expected[(i, j)], 1.0);
        }
    }
    let v: Vec<f64> = (0..n).map(|i| (1.0 + i as f64).sin()).collect();
    let (mut product, mut transposed) = (vec![0.0; n], vec![0.0; n]);
    sparse.jacobian_times(0.0, y, &f, &v, &mut product).unwrap();
    sparse.adjoint_rhs(0.0, y, &v, &mut transposed).unwrap();
    for i in 0..n {
        let row: f64 = (0..n).map(|j| expected[(i, j)] * v[j]).sum();
        let column: f64 = (0..n).map(|j| expected[(j, i)] * v[j]).sum();
        near(i, product[i], row, n as f64);
        let largest = (0..n).map(|j| expected[(j, i)].abs()).fold(0.0, f64::max);
        assert!((transposed[i] - column).abs() <= 4.0 * f64::EPSILON * n as f64 * largest);
    }
}

#[test]
fn jacobians_are_those_by_hand() {
    let reactions = || automatic(Reactions, RATES);
    let mut by_hand = Robertson::new();
    let pattern = by_hand.pattern().clone();
    compare(reactions, &mut by_hand, &pattern, &[0.7, 1e-5, 0.3]);
    let mut by_hand = Hires::new();
    let pattern = by_hand.pattern().clone();
    let y: Vec<f64> = (0..8).map(|i| 0.1 + 0.05 * i as f64).collect();
    compare(|| automatic(Plant, []), &mut by_hand, &pattern, &y);
    let mut by_hand = Brusselator::new(20);
    let (pattern, y0) = (by_hand.pattern().clone(), by_hand.y0());
    compare(|| automatic(Line(20), []), &mut by_hand, &pattern, &y0);

    // of band form, where only the band is stored
    let mut system = automatic(Line(20), []).banded(2, 2);
    let expected = dense(&mut by_hand, &y0);
    let mut data = vec![0.0; 40 * 5];
    system.banded_jacobian(0.0, &y0, &y0, BandMut::new(&mut data, 5, 2, 2, 2)).unwrap();
    let band = BandMut::new(&mut data, 5, 2, 2, 2);
    for j in 0..40_usize {
        for i in j.saturating_sub(2)..(j + 3).min(40) {
            let size = expected[(j, j)].abs();
            assert!((band[(i, j)] - expected[(i, j)]).abs() < 4.0 * f64::EPSILON * size);
        }
    }
}

/// A run by the Jacobian that comes with the equations makes the steps of one with that by hand, by `solve` without a word about it and by CVODE with
/// `linear_solver`; and no differences are taken.
#[test]
fn runs_are_those_of_jacobians_by_hand() {
    let by_hand = Brusselator::new(20);
    let (pattern, y0) = (by_hand.pattern().clone(), by_hand.y0());
    let make = || automatic(Line(20), []);
    let solvers = [
        (make(), LinearSolver::Dense(Jacobian::Supplied)),
        (
            make().banded(2, 2),
            LinearSolver::Band { lower: 2, upper: 2, jacobian: Jacobian::Supplied },
        ),
        (
            make().sparse(pattern.clone()),
            LinearSolver::Klu { pattern, jacobian: Jacobian::Supplied },
        ),
    ];
    for (system, solver) in solvers {
        let options = CvodeOptions::new(1e-6, 1e-8).newton(solver);
        let mut expected = Cvode::new(by_hand.clone(), 0.0, &y0, &options).unwrap();
        expected.solve_to(10.0).unwrap();
        let options = CvodeOptions::new(1e-6, 1e-8).newton(system.linear_solver());
        let mut found = Cvode::new(system, 0.0, &y0, &options).unwrap();
        found.solve_to(10.0).unwrap();
        let error = Brusselator::REFERENCE_20.error(found.y());
        assert!(error < 1e-4, "{error}");
        // rounding may make a step more or less
        let (found, expected) = (found.statistics(), expected.statistics());
        assert!(found.steps.abs_diff(expected.steps) <= expected.steps / 50);
        assert_eq!(found.difference_quotient_evaluations, 0);
    }
    for method in [Method::Bdf, Method::Rosenbrock] {
        let problem = Problem::ode(make().banded(2, 2), y0.clone());
        let options = Options::new(1e-6, 1e-8).output(Output::End);
        let solution = solve(problem, method, (0.0, 10.0), &options).unwrap();
        assert!(Brusselator::REFERENCE_20.error(solution.last()) < 1e-4);
        // the Rosenbrock method has a quotient by time in each step
        let statistics = solution.statistics();
        let tries = statistics.steps + statistics.error_test_failures;
        let by_time = if method == Method::Rosenbrock { tries } else { 0 };
        assert!(statistics.difference_quotient_evaluations <= by_time, "{statistics:?}");
    }
}

#[test]
fn a_linear_solver_of_another_form_is_refused() {
    let y0 = Brusselator::new(20).y0();
    let system = || automatic(Line(20), []).banded(2, 2);
    let pattern = Pattern::band(40, 3, 3).unwrap();
    for solver in [
        LinearSolver::Band { lower: 3, upper: 2, jacobian: Jacobian::Supplied },
        LinearSolver::Klu { pattern, jacobian: Jacobian::Supplied },
    ] {
        let options = CvodeOptions::new(1e-6, 1e-8).newton(solver);
        let error = Cvode::new(system(), 0.0, &y0, &options).unwrap().solve_to(1.0).unwrap_err();
        let source = std::error::Error::source(&error).unwrap().to_string();
        assert!(source.contains("Automatic::linear_solver"), "{source}");
    }
    // a dense matrix has room for any
    let options = CvodeOptions::new(1e-6, 1e-8).newton(LinearSolver::Dense(Jacobian::Supplied));
    Cvode::new(system(), 0.0, &y0, &options).unwrap().solve_to(1.0).unwrap();
}

/// y' = -p0 y^2 + p1 sin(p2 t): derivatives by the parameters of the equations are those by differences of them.
struct Driven;

impl RightHandSide for Driven {
    fn rhs<T: Number>(&mut self, t: f64, y: &[T], p: &[T], ydot: &mut [T]) -> Result<(), Failure> {
        ydot[0] = p[1] * (p[2] * t).sin() - p[0] * y[0] * y[0] + p[3] * p[4];
        ydot[1] = y[0] * p[4].exp() - y[1];
        Ok(())
    }
}

/// The second unknown at the end.
struct Second;

impl Functional for Second {
    fn terminal(
        &mut self,
        _t: f64,
        y: &[f64],
        _p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        if let Some(slopes) = slopes {
            slopes.y[1] = 1.0;
        }
        Ok(y[1])
    }
}

#[test]
fn slopes_by_parameters_are_those_of_the_equations() {
    let p = [0.5, 1.5, 2.0, 0.3, 0.7];
    let (y, s) = ([1.2, 0.4], [0.3, -0.8]);
    let mut system = automatic(Driven, p);
    check::sensitivity_rhs(&mut system, 0.4, &y, &s).unwrap();
    check::adjoint_rhs(&mut system, 0.4, &y, &s).unwrap();
    check::adjoint_parameters(&mut system, 0.4, &y, &s).unwrap();

    // over a run: forward and by the adjoint the same
    let all: Vec<usize> = (0..p.len()).collect();
    let options = Options::new(1e-9, 1e-11).output(Output::End);
    let problem = || Problem::ode(automatic(Driven, p), [1.0, 0.0]);
    let forward =
        options.clone().sensitivities(Sensitivities::of(all).source(SensitivitySource::Supplied));
    let forward = solve(problem(), Method::Bdf, (0.0, 2.0), &forward).unwrap();
    let back = AdjointOptions::new(1e-9, 1e-11);
    let back = gradient(problem(), Second, Method::Bdf, (0.0, 2.0), &options, &back).unwrap();
    let last = forward.sensitivities(forward.t().len() - 1);
    for k in 0..p.len() {
        let (forward, back) = (last[(1, k)], back.parameters[k]);
        assert!((forward - back).abs() < 1e-6 * (1.0 + forward.abs()), "{k}: {forward} {back}");
    }
}

/// Each function at some points: its value is that of `f64`, its slope that of central differences.
struct Functions;

/// How many functions [`Functions`] has; each takes y0 and y1.
const COUNT: usize = 37;

impl RightHandSide for Functions {
    fn rhs<T: Number>(&mut self, _t: f64, y: &[T], _p: &[T], out: &mut [T]) -> Result<(), Failure> {
        let (x, z) = (y[0], y[1]);
        let mut updated = [x; 8];
        updated[0] += z;
        updated[1] -= z;
        updated[2] *= z;
        updated[3] /= z;
        updated[4] += 2.0;
        updated[5] -= 2.0;
        updated[6] *= 2.0;
        updated[7] /= 2.0;
        let all = [
            x + z,
            x - z,
            x * z,
            x / z,
            x + 3.0,
            x - 3.0,
            x * 3.0,
            x / 3.0,
            -x,
            x.recip(),
            x.sqrt(),
            x.cbrt(),
            x.powi(3) + x.powi(0) + x.powi(-2),
            x.powf(1.7) + x.powf(0.0),
            x.exp(),
            x.exp_m1(),
            x.ln(),
            x.ln_1p(),
            x.sin(),
            x.cos(),
            x.tan(),
            (x * 0.3).asin(),
            (x * 0.3).acos(),
            x.atan(),
            x.sinh() * x.cosh(),
            x.tanh(),
            x.asinh(),
            (x - z).abs(),
            x.max(z) * 2.0 + x.min(z),
        ];
        out[..all.len()].copy_from_slice(&all);
        out[all.len()..][..8].copy_from_slice(&updated);
        for (i, value) in out.iter_mut().enumerate().skip(COUNT) {
            *value = match i - COUNT {
                0 => x.pow(z),
                1 => x.hypot(z),
                2 => x.atan2(-z),
                3 => {
                    if x > 1.0 && x > z {
                        x.function(1.0, 2.0)
                    } else {
                        T::from(z.value())
                    }
                }
                _ => T::from(0.0),
            };
        }
        Ok(())
    }
}

#[test]
fn functions_have_their_slopes() {
    // y0 and y1, and as many equations as functions
    let mut system = automatic(Functions, []);
    for (x, z) in [(0.4, 1.3), (1.9, 0.6), (1.1, 2.2)] {
        let n = COUNT + 3;
        let mut y = vec![1.0; n];
        (y[0], y[1]) = (x, z);
        check::jacobian(&mut system, 0.0, &y, check::Storage::Dense).unwrap();
    }
    let mut y = vec![1.0; COUNT + 4];
    (y[0], y[1]) = (1.5, 0.5);
    let jacobian = dense(&mut system, &y);
    assert_eq!(jacobian[(COUNT + 3, 0)], 2.0);
    let values = |y: &[f64]| {
        let mut out = vec![0.0; y.len()];
        automatic(Functions, []).rhs(0.0, y, &mut out).unwrap();
        out
    };
    let found = values(&y);
    assert_eq!(found[10], 1.5_f64.sqrt());
    assert_eq!(found[13], 1.5_f64.powf(1.7) + 1.0);
    assert_eq!(found[COUNT + 2], 1.5_f64.atan2(-0.5));
    assert_eq!(found[COUNT + 3], 1.0);
    (y[0], y[1]) = (0.5, 0.7);
    assert_eq!(values(&y)[COUNT + 3], 0.7);
}
