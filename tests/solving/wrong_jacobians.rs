//! Supplied Jacobians that are not those of the equations are told; right ones are not, whatever the equations look like.

use std::cell::Cell;

use faer::MatMut;
use pliant::{
    ode::{BandMut, Dae, Failure, Ode, with_jacobian, with_mass, with_sparse_jacobian},
    rosenbrock::{self, Rosenbrock},
    samples::{
        Brusselator, Hires, Oregonator, Pollution, Robertson, TransistorAmplifier, VanDerPol,
    },
    sundials::{
        Arkode, ArkodeOptions, Cause, Cvode, CvodeOptions, Error, Ida, IdaOptions, Integrator,
        Jacobian, Krylov, KrylovMethod, LinearSolver, MassForm, Pattern,
    },
};

use crate::difference_quotients::{E5, E5_Y0};

const DENSE: LinearSolver = LinearSolver::Dense(Jacobian::Supplied);

type Outcome = Result<f64, Error>;

/// What was told: method, entry, what was supplied and what differences say.
fn told(outcome: Outcome) -> (&'static str, (usize, Option<usize>), f64, f64) {
    match outcome {
        Err(Error::Integration(error)) => {
            println!("{error}");
            let text = error.to_string();
            let Cause::WrongJacobian { method, row, column, supplied, difference } = error.cause
            else {
                panic!("{text}")
            };
            assert!(text.contains(method) && text.contains("check_jacobian(false)"), "{text}");
            (method, (row, column), supplied, difference)
        }
        other => panic!("{other:?}"),
    }
}

fn end(mut solver: impl Integrator, t: f64) -> Outcome {
    solver.solve_to(t)?;
    Ok(solver.y()[0])
}

/// y1' = -y1 + 100 y2, y2' = -1000 y2 + y1 y3 / 10, y3' = -y3: df/dy with one entry replaced by a multiple of itself.
#[derive(Clone, Copy)]
struct Chain {
    entry: (usize, usize),
    factor: f64,
}

const CHAIN_Y0: [f64; 3] = [1.0, 0.0, 0.0];
const ENTRIES: [(usize, usize); 6] = [(0, 0), (0, 1), (1, 0), (1, 1), (1, 2), (2, 2)];

impl Chain {
    fn each(&self, y: &[f64], mut put: impl FnMut(usize, usize, f64)) {
        let values = [-1.0, 100.0, 0.1 * y[2], -1000.0, 0.1 * y[0], -1.0];
        for (entry, value) in ENTRIES.into_iter().zip(values) {
            let factor = if entry == self.entry { self.factor } else { 1.0 };
            put(entry.0, entry.1, factor * value);
        }
    }

    fn pattern() -> Pattern {
        Pattern::from_entries(3, ENTRIES).unwrap()
    }
}

impl Ode for Chain {
    fn rhs(&mut self, _t: f64, y: &[f64], f: &mut [f64]) -> Result<(), Failure> {
        f[0] = -y[0] + 100.0 * y[1];
        f[1] = -1000.0 * y[1] + 0.1 * y[0] * y[2];
        f[2] = -y[2];
        Ok(())
    }

    fn dense_jacobian(
        &mut self,
        _t: f64,
        y: &[f64],
        _f: &[f64],
        mut jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        self.each(y, |i, j, value| jacobian[(i, j)] = value);
        Ok(())
    }

    fn banded_jacobian(
        &mut self,
        _t: f64,
        y: &[f64],
        _f: &[f64],
        mut jacobian: BandMut<'_>,
    ) -> Result<(), Failure> {
        self.each(y, |i, j, value| jacobian[(i, j)] = value);
        Ok(())
    }

    fn sparse_jacobian(
        &mut self,
        _t: f64,
        y: &[f64],
        _f: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        let pattern = Self::pattern();
        self.each(y, |i, j, value| values[pattern.position(i, j).unwrap()] = value);
        Ok(())
    }

    fn jacobian_times(
        &mut self,
        _t: f64,
        y: &[f64],
        _f: &[f64],
        v: &[f64],
        jv: &mut [f64],
    ) -> Result<(), Failure> {
        jv.fill(0.0);
        self.each(y, |i, j, value| jv[i] += value * v[j]);
        Ok(())
    }
}

impl Dae for Chain {
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        self.rhs(t, y, r)?;
        r.iter_mut().zip(yp).for_each(|(r, yp)| *r = yp - *r);
        Ok(())
    }

    fn dense_jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        y: &[f64],
        _yp: &[f64],
        mut jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        self.each(y, |i, j, value| jacobian[(i, j)] = -value);
        (0..3).for_each(|i| jacobian[(i, i)] += cj);
        Ok(())
    }

    fn banded_jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        y: &[f64],
        _yp: &[f64],
        mut jacobian: BandMut<'_>,
    ) -> Result<(), Failure> {
        self.each(y, |i, j, value| jacobian[(i, j)] = -value);
        (0..3).for_each(|i| jacobian[(i, i)] += cj);
        Ok(())
    }

    fn sparse_jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        y: &[f64],
        _yp: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        let pattern = Self::pattern();
        self.each(y, |i, j, value| values[pattern.position(i, j).unwrap()] = -value);
        (0..3).for_each(|i| values[pattern.position(i, i).unwrap()] += cj);
        Ok(())
    }

    fn jacobian_times(
        &mut self,
        _t: f64,
        cj: f64,
        y: &[f64],
        _yp: &[f64],
        v: &[f64],
        jv: &mut [f64],
    ) -> Result<(), Failure> {
        jv.iter_mut().zip(v).for_each(|(jv, v)| *jv = cj * v);
        self.each(y, |i, j, value| jv[i] -= value * v[j]);
        Ok(())
    }
}

fn forms() -> [LinearSolver; 4] {
    let jacobian = Jacobian::Supplied;
    let krylov = Krylov::new(KrylovMethod::Gmres { dimension: 3, restarts: 2 }).products(jacobian);
    [
        DENSE,
        LinearSolver::Band { lower: 1, upper: 1, jacobian },
        LinearSolver::Klu { pattern: Chain::pattern(), jacobian },
        LinearSolver::Krylov(krylov),
    ]
}

const METHODS: [&str; 4] =
    ["dense_jacobian", "banded_jacobian", "sparse_jacobian", "jacobian_times"];

/// The chain by each integrator that uses this form, with or without the check.
fn by_each(chain: Chain, form: &LinearSolver, checks: bool) -> Vec<(&'static str, Outcome)> {
    let options = CvodeOptions::new(1e-6, 1e-9).newton(form.clone()).check_jacobian(checks);
    let mut outcomes =
        vec![("CVODE", end(Cvode::new(chain, 0.0, &CHAIN_Y0, &options).unwrap(), 10.0))];
    let options = ArkodeOptions::new(1e-6, 1e-9).newton(form.clone()).check_jacobian(checks);
    outcomes.push(("ARKODE", end(Arkode::new(chain, 0.0, &CHAIN_Y0, &options).unwrap(), 10.0)));
    let options = IdaOptions::new(1e-6, 1e-9).newton(form.clone()).check_jacobian(checks);
    let slope = [-1.0, 0.0, 0.0];
    outcomes.push(("IDA", end(Ida::new(chain, 0.0, &CHAIN_Y0, &slope, &options).unwrap(), 10.0)));
    if !matches!(form, LinearSolver::Krylov(_)) {
        let options =
            rosenbrock::Options::new(1e-6, 1e-9).newton(form.clone()).check_jacobian(checks);
        let solver = Rosenbrock::new(chain, 0.0, &CHAIN_Y0, &options).unwrap();
        outcomes.push(("Rosenbrock", end(solver, 10.0)));
    }
    outcomes
}

/// Entries that are not zero, off by factors from -1 to 1000 or left out, in each form and by each integrator. The products of IDA have those of y'
/// in them, beside which others may vanish while steps are short: what is not told then has to be harmless.
#[test]
fn wrong_entries_are_told_with_place_and_size() {
    let mut cases = vec![((1, 2), 1e3)];
    for entry in [(0, 0), (0, 1), (1, 1), (2, 2)] {
        cases.extend([-1.0, 0.0, 1e-3, 1.5, 1e3].map(|factor| (entry, factor)));
    }
    for (form, name) in forms().iter().zip(METHODS) {
        for &(entry, factor) in &cases {
            for (by, outcome) in by_each(Chain { entry, factor }, form, true) {
                match outcome {
                    Ok(y) if by == "IDA" => assert!((y - (-10.0f64).exp()).abs() < 1e-5, "{y:e}"),
                    outcome => {
                        let (method, (row, column), supplied, difference) = told(outcome);
                        let place = (name, entry.0, Some(entry.1));
                        assert_eq!((method, row, column), place, "{by} {factor}");
                        if by != "IDA" {
                            // the system is linear but for one product
                            let off = (supplied / difference - factor).abs();
                            assert!(off <= 1e-3 * factor.abs(), "{by}: {off:e}");
                        }
                    }
                }
            }
        }
    }
}

/// With the right one, nothing is told, and the answer is right; so it is where the check is switched off.
#[test]
fn right_entries_are_not_told() {
    for form in forms() {
        for checks in [true, false] {
            for (by, outcome) in by_each(Chain { entry: (0, 0), factor: 1.0 }, &form, checks) {
                // y3 is 0, so that y2 is, and y1 = exp(-t)
                assert!((outcome.unwrap() - (-10.0f64).exp()).abs() < 1e-5, "{by}");
            }
        }
    }
}

/// What vanishes at the start is looked at later: y1 y2 from (1, 0), with df1/dy1 of the wrong sign.
#[test]
fn what_vanishes_at_the_start_is_told_later() {
    let rhs = |_t: f64, y: &[f64], f: &mut [f64]| {
        f[0] = -y[0] * y[1] - 1e-3 * y[0];
        f[1] = 1.0 - y[1];
        Ok(())
    };
    let system = with_jacobian(rhs, |_t, y, _f, mut jacobian| {
        jacobian[(0, 0)] = y[1] - 1e-3;
        jacobian[(0, 1)] = -y[0];
        jacobian[(1, 1)] = -1.0;
        Ok(())
    });
    let options = CvodeOptions::new(1e-6, 1e-9).newton(DENSE);
    let (_, entry, ..) = told(end(Cvode::new(system, 0.0, &[1.0, 0.0], &options).unwrap(), 10.0));
    assert_eq!(entry, (0, Some(0)));
}

/// y' = -1e6 (y - cos t) by a Jacobian of -1e3: an answer that is far off and passes, where nobody looks.
#[test]
fn answers_that_would_pass_are_kept_back() {
    let system = || {
        with_jacobian(
            |t: f64, y: &[f64], f: &mut [f64]| {
                f[0] = -1e6 * (y[0] - t.cos());
                Ok(())
            },
            |_t, _y, _f, mut jacobian| {
                jacobian[(0, 0)] = -1e9;
                Ok(())
            },
        )
    };
    let options = CvodeOptions::new(1e-6, 1e-9).newton(DENSE);
    let (method, entry, supplied, difference) =
        told(end(Cvode::new(system(), 0.0, &[0.0], &options).unwrap(), 1.0));
    assert_eq!((method, entry, supplied), ("dense_jacobian", (0, Some(0)), -1e9));
    assert!((difference + 1e6).abs() < 1e3);
    let blind = options.check_jacobian(false);
    let passed = end(Cvode::new(system(), 0.0, &[0.0], &blind).unwrap(), 1.0);
    println!("{passed:?}");
    assert!(passed.is_err() || (passed.unwrap() - 1f64.cos()).abs() > 1e-2);
    // who goes on after the error is told again
    let options = CvodeOptions::new(1e-6, 1e-9).newton(DENSE);
    let mut solver = Cvode::new(system(), 0.0, &[0.0], &options).unwrap();
    assert!(solver.solve_to(1.0).is_err() && solver.solve_to(1.0).is_err());
}

/// The standard problems, badly scaled ones among them, at start and later, at tolerances that tell the sizes of their unknowns and at such as do
/// not: no alarm.
#[test]
fn right_jacobians_of_standard_problems_pass() {
    fn passes<S: Ode + Clone>(name: &str, system: &S, y0: &[f64], t: f64) {
        for atol in [1e-4, 1e-9, 1e-20] {
            let options = CvodeOptions::new(1e-5, atol).newton(DENSE);
            let outcome = end(Cvode::new(system.clone(), 0.0, y0, &options).unwrap(), t);
            no_alarm(name, outcome);
            let options = ArkodeOptions::new(1e-5, atol).newton(DENSE);
            let outcome = end(Arkode::new(system.clone(), 0.0, y0, &options).unwrap(), t);
            no_alarm(name, outcome);
            let options = rosenbrock::Options::new(1e-5, atol).newton(DENSE);
            let outcome = end(Rosenbrock::new(system.clone(), 0.0, y0, &options).unwrap(), t);
            no_alarm(name, outcome);
        }
    }
    passes("E5", &E5, &E5_Y0, 1e6);
    passes("HIRES", &Hires::new(), &Hires::Y0, 300.0);
    passes("ROBER", &Robertson::new(), &Robertson::Y0, 1e5);
    passes("VDPOL", &VanDerPol::new(), &VanDerPol::Y0, 1000.0);
    passes("OREGO", &Oregonator::new(), &Oregonator::Y0, 300.0);
    passes("POLLU", &Pollution::new(), &Pollution::Y0, 60.0);
    let system = Brusselator::new(20);
    passes("BRUSS", &system, &system.y0(), 10.0);
    for rtol in [1e-3, 1e-5] {
        let system = MassForm::new(TransistorAmplifier, 8, &DENSE).unwrap();
        let (y0, slope) = (TransistorAmplifier::Y0, TransistorAmplifier::YP0);
        let options = IdaOptions::new(rtol, rtol).newton(DENSE).max_order(3);
        no_alarm("TRANSAMP", end(Ida::new(system, 0.0, &y0, &slope, &options).unwrap(), 0.05));
    }
    let system = MassForm::new(with_mass(E5, [1.0; 4]), 4, &DENSE).unwrap();
    let options = IdaOptions::new(1e-6, 1e-20).newton(DENSE);
    let slope = [-7.89e-10 * 1.76e-3, 7.89e-10 * 1.76e-3, 7.89e-10 * 1.76e-3, 0.0];
    no_alarm("E5 by IDA", end(Ida::new(system, 0.0, &E5_Y0, &slope, &options).unwrap(), 1e4));
}

fn no_alarm(name: &str, outcome: Outcome) {
    if let Err(Error::Integration(error)) = outcome {
        assert!(!matches!(error.cause, Cause::WrongJacobian { .. }), "{name}: {error}");
    }
}

/// Right-hand sides with jumps and kinks at the very start, and functions that saturate within less than a shift: differences tell
/// nothing about their derivatives there, whichever of them is supplied.
#[test]
fn jumps_and_kinks_are_no_alarm() {
    type Scalar = fn(f64) -> f64;
    let cases: [(&str, Scalar, &[f64]); 6] = [
        ("kink", |y| y.abs(), &[-1.0, 0.0, 1.0]),
        ("contact", |y| -1e6 * y.min(0.0), &[-1e6, -5e5, 0.0]),
        ("jump", |y| if y > 0.0 { -1.0 } else { 1.0 }, &[0.0]),
        ("friction", |y| -(y / 1e-9).tanh(), &[-1e9]),
        ("clamp", |y| (-1e12 * y).clamp(-1.0, 1.0), &[-1e12, 0.0]),
        ("root", |y| -y.abs().sqrt(), &[0.0]),
    ];
    for (name, f, slopes) in cases {
        for &slope in slopes {
            let system = with_jacobian(
                move |_t: f64, y: &[f64], ydot: &mut [f64]| {
                    ydot[0] = f(y[0]);
                    Ok(())
                },
                move |_t, _y, _ydot, mut jacobian| {
                    jacobian[(0, 0)] = slope;
                    Ok(())
                },
            );
            // the Jacobian of the start alone: later the state may be on one side
            let options = CvodeOptions::new(1e-3, 1e-3).newton(DENSE).max_steps(1);
            let mut solver = Cvode::new(system, 0.0, &[0.0], &options).unwrap();
            no_alarm(name, solver.step(1.0).map(|_| 0.0));
        }
    }
}

/// Equations that have no meaning below zero, or none beyond a bound that is near, are not asked there in vain.
#[test]
fn the_edge_of_a_domain_is_no_alarm() {
    let system = with_jacobian(
        |_t: f64, y: &[f64], f: &mut [f64]| {
            f[0] = -y[0].sqrt() - y[1].ln();
            f[1] = -y[1];
            Ok(())
        },
        |_t, y, _f, mut jacobian| {
            jacobian[(0, 0)] = -0.5 / y[0].sqrt().max(1e-300);
            jacobian[(0, 1)] = -1.0 / y[1];
            jacobian[(1, 1)] = -1.0;
            Ok(())
        },
    );
    let options = CvodeOptions::new(1e-6, 1e-9).newton(DENSE);
    no_alarm("edge", end(Cvode::new(system, 0.0, &[0.0, 1e-12], &options).unwrap(), 1.0));
}

/// What it costs: as many evaluations as `check_jacobian` says, beside those of the statistics, and no Jacobian.
#[test]
fn the_check_costs_a_few_evaluations() {
    let (calls, jacobians) = (Cell::new(0_u64), Cell::new(0_u64));
    let run = |checks: bool| {
        let pattern = Pattern::from_entries(1, []).unwrap();
        let system = with_sparse_jacobian(
            |t: f64, y: &[f64], f: &mut [f64]| {
                calls.set(calls.get() + 1);
                f[0] = -50.0 * (y[0] - t.cos());
                Ok(())
            },
            |_t, _y, _f, values: &mut [f64]| {
                jacobians.set(jacobians.get() + 1);
                values[0] = -50.0;
                Ok(())
            },
        );
        let options = CvodeOptions::new(1e-6, 1e-9)
            .newton(LinearSolver::Klu { pattern, jacobian: Jacobian::Supplied })
            .check_jacobian(checks);
        let mut solver = Cvode::new(system, 0.0, &[0.0], &options).unwrap();
        solver.solve_to(10.0).unwrap();
        let statistics = solver.statistics();
        assert_eq!(jacobians.take(), statistics.jacobian_evaluations);
        (solver.y()[0], calls.take() - statistics.evaluations, statistics.jacobian_evaluations)
    };
    let ((y, extra, jacobians), (blind, none, _)) = (run(true), run(false));
    assert_eq!((y, none), (blind, 0));
    // base and, with a single unknown, one direction
    assert_eq!(extra, 2 * (1 + u64::from(jacobians.ilog2())));
}
