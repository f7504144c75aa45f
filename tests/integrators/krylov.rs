//! Newton's linear systems by Krylov methods, with and without preconditioners.

use std::{cell::Cell, f64::consts::PI};

use faer::MatMut;
use pliant::{
    ode::{Dae, Failure, Ode},
    sundials::{
        Arkode, ArkodeOptions, Cvode, CvodeOptions, Error, Ida, IdaOptions, Integrator, Jacobian,
        Krylov, KrylovMethod, LinearSolver, Pattern, Preconditioner, Side, Statistics,
    },
};

use crate::support::OwnSolver;

/// Points inside the rod.
const N: usize = 200;

/// Heat along a rod with cold ends, by second differences, without (ODE) and with (DAE) an implicit time derivative.
struct Rod<'a> {
    products: &'a Cell<u64>,
}

const SCALE: f64 = ((N + 1) * (N + 1)) as f64;

/// Second differences of `y`, times a scale.
fn second_differences(y: &[f64], out: &mut [f64]) {
    for i in 0..N {
        let left = if i > 0 { y[i - 1] } else { 0.0 };
        let right = if i + 1 < N { y[i + 1] } else { 0.0 };
        out[i] = SCALE * (left - 2.0 * y[i] + right);
    }
}

fn entry(i: usize, j: usize) -> f64 {
    match i.abs_diff(j) {
        0 => -2.0 * SCALE,
        1 => SCALE,
        _ => 0.0,
    }
}

impl Ode for Rod<'_> {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        second_differences(y, ydot);
        Ok(())
    }

    fn dense_jacobian(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        mut jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        (0..N * N).for_each(|k| jacobian[(k % N, k / N)] = entry(k % N, k / N));
        Ok(())
    }

    fn sparse_jacobian(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        let places = (0..N).flat_map(|j| (j.max(1) - 1..(j + 2).min(N)).map(move |i| (i, j)));
        values.iter_mut().zip(places).for_each(|(value, (i, j))| *value = entry(i, j));
        Ok(())
    }

    fn jacobian_times(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        v: &[f64],
        jv: &mut [f64],
    ) -> Result<(), Failure> {
        self.products.set(self.products.get() + 1);
        second_differences(v, jv);
        Ok(())
    }
}

impl Dae for Rod<'_> {
    fn residual(&mut self, _t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        second_differences(y, r);
        r.iter_mut().zip(yp).for_each(|(r, yp)| *r -= yp);
        Ok(())
    }

    fn dense_jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        y: &[f64],
        yp: &[f64],
        mut jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        Ode::dense_jacobian(self, 0.0, y, yp, jacobian.as_mut())?;
        (0..N).for_each(|i| jacobian[(i, i)] -= cj);
        Ok(())
    }

    fn sparse_jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        y: &[f64],
        yp: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        Ode::sparse_jacobian(self, 0.0, y, yp, values)?;
        (0..N).for_each(|i| values[3 * i] -= cj);
        Ok(())
    }

    fn jacobian_times(
        &mut self,
        _t: f64,
        cj: f64,
        y: &[f64],
        yp: &[f64],
        v: &[f64],
        jv: &mut [f64],
    ) -> Result<(), Failure> {
        Ode::jacobian_times(self, 0.0, y, yp, v, jv)?;
        jv.iter_mut().zip(v).for_each(|(jv, v)| *jv -= cj * v);
        Ok(())
    }
}

/// All modes of the rod, which decay each at its own rate: the differences have closed eigenvalues.
fn exact(t: f64) -> Vec<f64> {
    let step = PI / (N + 1) as f64;
    let mode = |k: usize, i: usize| {
        let k = k as f64;
        let rate = 2.0 * SCALE * (1.0 - (k * step).cos());
        (-rate * t).exp() / k * (k * step * (i + 1) as f64).sin()
    };
    (0..N).map(|i| (1..=N).map(|k| mode(k, i)).sum()).collect()
}

/// The last is for symmetric matrices alone.
const METHODS: [KrylovMethod; 5] = [
    KrylovMethod::Gmres { dimension: 20, restarts: 2 },
    KrylovMethod::BiCgStab { iterations: 40 },
    KrylovMethod::Fgmres { dimension: 20, restarts: 2 },
    KrylovMethod::Tfqmr { iterations: 40 },
    KrylovMethod::ConjugateGradients { iterations: 60 },
];

/// Whether a method takes a preconditioner on this side.
fn takes(method: KrylovMethod, side: Side) -> bool {
    !(matches!(method, KrylovMethod::Fgmres { .. }) && side == Side::Left)
}

fn ilu(jacobian: Jacobian) -> Preconditioner {
    Preconditioner::Ilu { pattern: Pattern::band(N, 1, 1).unwrap(), jacobian }
}

const END: f64 = 0.05;

/// The largest error at the end, and the effort, of an integrator of the rod.
fn outcome<I: Integrator>(solver: Result<I, Error>) -> (f64, Statistics) {
    let mut solver = solver.unwrap();
    solver.solve_to(END).unwrap();
    let errors = solver.y().iter().zip(exact(END)).map(|(y, e)| (y - e).abs());
    (errors.fold(0.0, f64::max), solver.statistics())
}

/// Without a look at supplied products: those of the solver are counted.
fn cvode<S: Ode>(system: S, solver: LinearSolver) -> (f64, Statistics) {
    let options = CvodeOptions::new(1e-6, 1e-9).newton(solver).check_jacobian(false);
    outcome(Cvode::new(system, 0.0, &exact(0.0), &options))
}

fn arkode<S: Ode>(system: S, solver: LinearSolver) -> (f64, Statistics) {
    let options = ArkodeOptions::new(1e-6, 1e-9).newton(solver).check_jacobian(false);
    outcome(Arkode::new(system, 0.0, &exact(0.0), &options))
}

fn ida<S: Dae>(system: S, solver: LinearSolver) -> (f64, Statistics) {
    let mut yp0 = vec![0.0; N];
    second_differences(&exact(0.0), &mut yp0);
    let options = IdaOptions::new(1e-6, 1e-9).newton(solver).check_jacobian(false);
    outcome(Ida::new(system, 0.0, &exact(0.0), &yp0, &options))
}

/// The runs of all three integrators, IDA's without a preconditioner on the right.
fn runs(krylov: &Krylov, side: Option<Side>) -> Vec<(&'static str, f64, Statistics)> {
    let products = Cell::new(0);
    let rod = || Rod { products: &products };
    let solver = LinearSolver::Krylov(krylov.clone());
    let mut runs = vec![("CVODE", cvode(rod(), solver.clone()))];
    runs.push(("ARKODE", arkode(rod(), solver.clone())));
    if side != Some(Side::Right) {
        runs.push(("IDA", ida(rod(), solver)));
    }
    runs.into_iter().map(|(name, (error, statistics))| (name, error, statistics)).collect()
}

fn report(what: &str, error: f64, s: &Statistics) {
    println!(
        "{what}: error {error:.1e}, {} steps, {} Newton, {} linear iterations, {} failures, {} of {} quotients",
        s.steps,
        s.nonlinear_iterations,
        s.linear_iterations,
        s.linear_failures,
        s.difference_quotient_evaluations,
        s.evaluations
    );
}

/// Errors are those of the tolerance (measured: up to 7.3e-7), for a band solver as for each method; ILU(0) is
/// exact on the band, so that one iteration solves a system, and Newton's iteration goes as with the band.
#[test]
fn heat_by_every_method_and_preconditioner() {
    let band = LinearSolver::Band { lower: 1, upper: 1, jacobian: Jacobian::DifferenceQuotients };
    let products = Cell::new(0);
    let (error, direct) = cvode(Rod { products: &products }, band);
    report("band", error, &direct);
    assert!(error < 2e-6 && direct.linear_iterations == 0);

    for method in METHODS {
        let plain = runs(&Krylov::new(method), None);
        for (name, error, s) in &plain {
            report(&format!("{method:?} {name}, no preconditioner"), *error, s);
            assert!(*error < 2e-6, "{name}: {error}");
            assert_eq!((s.preconditioner_setups, s.preconditioner_solves), (0, 0));
            assert!(s.difference_quotient_evaluations >= s.linear_iterations);
        }
        for (side, way) in [
            (Side::Left, Jacobian::Supplied),
            (Side::Left, Jacobian::DifferenceQuotients),
            (Side::Right, Jacobian::Supplied),
            (Side::Right, Jacobian::DifferenceQuotients),
        ] {
            if !takes(method, side) {
                continue;
            }
            let krylov = Krylov::new(method).preconditioner(side, ilu(way));
            for ((name, error, s), (_, _, plain)) in runs(&krylov, Some(side)).iter().zip(&plain) {
                report(&format!("{method:?} {name}, {side:?} {way:?}"), *error, s);
                assert!(*error < 2e-6, "{name}: {error}");
                // conjugate gradients measure the residual before P^-1, whose size IDA does not have in mind
                let is_cg = matches!(method, KrylovMethod::ConjugateGradients { .. });
                let most = if is_cg { 2 } else { 1 } * s.nonlinear_iterations;
                assert!(s.linear_iterations <= most, "{name}");
                assert!(s.linear_iterations < plain.linear_iterations / 3, "{name}");
                if *name == "CVODE" {
                    assert!(s.steps.abs_diff(direct.steps) < 5);
                }
                // these two have no need to undo the preconditioner at the end
                let spares = matches!(
                    method,
                    KrylovMethod::Fgmres { .. } | KrylovMethod::ConjugateGradients { .. }
                );
                let least = s.linear_iterations + u64::from(!spares);
                assert!(s.preconditioner_solves >= least, "{name}");
                assert!(s.preconditioner_setups > 0);
            }
        }
    }
}

/// Products that the system supplies are those of the statistics, and leave no quotients.
#[test]
fn supplied_products_replace_difference_quotients() {
    let gmres = Krylov::new(METHODS[0]).products(Jacobian::Supplied);
    let solver = LinearSolver::Krylov(gmres);
    let products = Cell::new(0);
    let rod = || Rod { products: &products };
    type Run<'a> = fn(Rod<'a>, LinearSolver) -> (f64, Statistics);
    for run in [cvode as Run<'_>, arkode, ida] {
        let (error, statistics) = run(rod(), solver.clone());
        report("supplied products", error, &statistics);
        assert!(error < 2e-6, "{error}");
        assert_eq!(statistics.difference_quotient_evaluations, 0);
        assert_eq!(products.take(), statistics.linear_iterations);
    }
}

/// A preconditioner that solves exactly leaves one iteration for each system.
#[test]
fn a_system_preconditions_itself() {
    let products = Cell::new(0);
    let rod = || OwnSolver::new(Rod { products: &products }, N);
    for side in [Side::Left, Side::Right] {
        let krylov = Krylov::new(METHODS[0]).preconditioner(side, Preconditioner::Custom);
        let solver = LinearSolver::Krylov(krylov);
        let mut runs = vec![cvode(rod(), solver.clone())];
        if side == Side::Left {
            runs.push(ida(rod(), solver));
        }
        for (error, statistics) in runs {
            report("itself", error, &statistics);
            assert!(error < 2e-6, "{error}");
            assert!(statistics.linear_iterations <= statistics.nonlinear_iterations);
            assert!(statistics.preconditioner_setups <= statistics.linear_setups);
        }
    }
}

/// The factor of the tolerance is that of the linear systems: a small one costs iterations.
#[test]
fn a_tighter_linear_tolerance_takes_more_iterations() {
    let products = Cell::new(0);
    let [loose, tight] = [0.05, 1e-6].map(|factor| {
        let gmres = Krylov::new(METHODS[0]).tolerance_factor(factor);
        let (error, statistics) = cvode(Rod { products: &products }, LinearSolver::Krylov(gmres));
        report(&format!("factor {factor}"), error, &statistics);
        assert!(error < 2e-6, "{error}");
        statistics.linear_iterations
    });
    assert!(tight > 2 * loose, "{loose} and {tight}");
}

/// The Brusselator with diffusion in one dimension: u and v at each of some points.
///
/// Hairer and Wanner, Solving Ordinary Differential Equations II, section IV.10 (BRUSS).
fn brusselator(_t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    let (points, [u_end, v_end]) = (y.len() / 2, [1.0, 3.0]);
    let diffusion = 0.02 * ((points + 1) * (points + 1)) as f64;
    for k in 0..points {
        let at = |k: usize, part: usize, end: f64| y.get(2 * k + part).copied().unwrap_or(end);
        let spread = |part: usize, end: f64| {
            let left = if k > 0 { at(k - 1, part, end) } else { end };
            diffusion * (left - 2.0 * at(k, part, end) + at(k + 1, part, end))
        };
        let (u, v) = (y[2 * k], y[2 * k + 1]);
        ydot[2 * k] = 1.0 + u * u * v - 4.0 * u + spread(0, u_end);
        ydot[2 * k + 1] = 3.0 * u - u * u * v + spread(1, v_end);
    }
    Ok(())
}

/// A nonlinear system with a pattern that is found and whose factors have fill: ILU(0) is not exact, and still
/// spares most iterations. The reference is a dense solver at a tolerance of 1e-10.
#[test]
fn a_brusselator_with_an_incomplete_factorization() {
    let points = 100;
    let start = |k: usize| [1.0 + (2.0 * PI * k as f64 / 101.0).sin(), 3.0];
    let y0: Vec<f64> = (1..=points).flat_map(start).collect();
    let run = |rtol: f64, solver: LinearSolver| {
        let options = CvodeOptions::new(rtol, rtol).newton(solver);
        let mut solver = Cvode::new(brusselator, 0.0, &y0, &options).unwrap();
        solver.solve_to(5.0).unwrap();
        (solver.y().to_vec(), solver.statistics())
    };
    let dense = LinearSolver::Dense(Jacobian::DifferenceQuotients);
    let (reference, _) = run(1e-10, dense);
    let run = |what: &str, krylov: Krylov| {
        let (y, statistics) = run(1e-6, LinearSolver::Krylov(krylov));
        let errors = y.iter().zip(&reference).map(|(y, r)| (y - r).abs());
        let error = errors.fold(0.0, f64::max);
        report(what, error, &statistics);
        // measured: up to 3.7e-5, as the dense solver has it within a factor of 2
        assert!(error < 1e-4, "{error}");
        statistics.linear_iterations
    };
    let mut system = brusselator;
    let pattern = Pattern::ode_by_nan(&mut system, 0.0, &y0).unwrap();
    assert_eq!(pattern.entry_count(), 4 * points + 4 * (points - 1));
    for method in &METHODS[..4] {
        let (method, side) = match takes(*method, Side::Left) {
            true => (*method, Side::Left),
            false => (*method, Side::Right),
        };
        let plain = run("plain", Krylov::new(method));
        let ilu = Preconditioner::Ilu {
            pattern: pattern.clone(),
            jacobian: Jacobian::DifferenceQuotients,
        };
        let preconditioned = run("ILU", Krylov::new(method).preconditioner(side, ilu));
        assert!(preconditioned < plain / 2, "{plain} and {preconditioned}");
    }
}
