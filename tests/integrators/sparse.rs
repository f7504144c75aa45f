//! Sparse Jacobians that nobody writes: difference quotients on a pattern, and patterns that are found.

use std::{
    cell::Cell,
    panic::{AssertUnwindSafe, catch_unwind},
};

use pliant::{
    ode::{Dae, Failure, Ode},
    samples::{Hires, Robertson},
    sundials::{
        Arkode, ArkodeOptions, Callback, Cause, Cvode, CvodeOptions, Error, Ida, IdaOptions,
        InitialCondition, Integrator, Jacobian, LinearSolver, Pattern, Statistics,
    },
};

fn klu(pattern: &Pattern, jacobian: Jacobian) -> LinearSolver {
    LinearSolver::Klu { pattern: pattern.clone(), jacobian }
}

/// Both ways lead to the trusted digits, with about the same effort: wrong entries would need far more iterations.
/// Steps of multistep methods differ by a tenth where matrices differ by rounding (dense and KLU with supplied
/// Jacobians: 861 and 955). The tolerances are those of the tests with supplied Jacobians.
fn compare(run: impl Fn(LinearSolver) -> (f64, Statistics), pattern: &Pattern, tolerance: f64) {
    let [supplied, quotients] = [Jacobian::Supplied, Jacobian::DifferenceQuotients].map(|way| {
        let (error, statistics) = run(klu(pattern, way));
        let Statistics { steps, nonlinear_iterations, difference_quotient_evaluations, .. } =
            statistics;
        println!(
            "{way:?}: error {error:.2e}, {steps} steps, {nonlinear_iterations} iterations, \
             {difference_quotient_evaluations} evaluations for quotients"
        );
        assert!(error < tolerance, "{way:?}: {error}");
        statistics
    });
    assert_eq!(supplied.difference_quotient_evaluations, 0);
    assert!(quotients.difference_quotient_evaluations > 0);
    assert!(quotients.steps < supplied.steps * 6 / 5);
    assert!(quotients.nonlinear_iterations < supplied.nonlinear_iterations * 6 / 5);
}

fn hires_by_arkode(solver: LinearSolver) -> (f64, Statistics) {
    let options = ArkodeOptions::new(1e-8, 1e-12).newton(solver);
    let mut solver = Arkode::new(Hires::new(), 0.0, &Hires::Y0, &options).unwrap();
    solver.solve_to(Hires::REFERENCE.t).unwrap();
    (Hires::REFERENCE.error(solver.y()), solver.statistics())
}

#[test]
fn hires_by_cvode_and_arkode() {
    let pattern = Hires::new().pattern().clone();
    let cvode = |solver| {
        let options = CvodeOptions::new(1e-8, 1e-12).newton(solver);
        let mut solver = Cvode::new(Hires::new(), 0.0, &Hires::Y0, &options).unwrap();
        solver.solve_to(Hires::REFERENCE.t).unwrap();
        (Hires::REFERENCE.error(solver.y()), solver.statistics())
    };
    compare(cvode, &pattern, 2e-6);
    compare(hires_by_arkode, &pattern, 2e-6);
}

/// Runge-Kutta steps hardly feel rounding, but the increments: those of the dense quotients give the same run.
#[test]
fn increments_are_those_of_dense_quotients() {
    let pattern = Hires::new().pattern().clone();
    let (_, dense) = hires_by_arkode(LinearSolver::Dense(Jacobian::DifferenceQuotients));
    let (_, sparse) = hires_by_arkode(klu(&pattern, Jacobian::DifferenceQuotients));
    assert_eq!(dense.steps, sparse.steps);
    assert!(dense.nonlinear_iterations.abs_diff(sparse.nonlinear_iterations) < 10);
}

#[test]
fn robertson_by_ida() {
    let ida = |solver| {
        let options = IdaOptions::new(1e-8, [1e-12, 1e-18, 1e-10]).newton(solver);
        let mut solver =
            Ida::new(Robertson::new(), 0.0, &Robertson::Y0, &Robertson::YP0, &options).unwrap();
        solver.solve_to(Robertson::REFERENCE.t).unwrap();
        (Robertson::REFERENCE.error(solver.y()), solver.statistics())
    };
    compare(ida, Robertson::new().pattern(), 2e-5);
}

/// What corrects the start of a DAE counts, as it does for the Jacobians of C.
#[test]
fn a_correction_of_the_start_is_counted() {
    let options = IdaOptions::new(1e-6, [1e-10, 1e-14, 1e-8])
        .newton(klu(Robertson::new().pattern(), Jacobian::DifferenceQuotients))
        .differential(Robertson::DIFFERENTIAL);
    let mut solver = Ida::new(Robertson::new(), 0.0, &Robertson::Y0, &[0.0; 3], &options).unwrap();
    solver.consistent_start(InitialCondition::Algebraic, 0.4).unwrap();
    solver.solve_to(0.4).unwrap();
    let statistics = solver.statistics();
    assert_eq!(statistics.difference_quotient_evaluations, 3 * statistics.jacobian_evaluations);
}

/// Fails, in a way, where y_1 is not 0: there come difference quotients alone.
#[derive(Clone, Copy)]
struct Trap(fn(&mut f64) -> Result<(), Failure>);

impl Ode for Trap {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot.copy_from_slice(&[-y[0], 0.0]);
        if y[1] == 0.0 { Ok(()) } else { (self.0)(&mut ydot[1]) }
    }
}

impl Dae for Trap {
    fn residual(&mut self, _t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        r.copy_from_slice(&[yp[0] + y[0], yp[1]]);
        if y[1] == 0.0 { Ok(()) } else { (self.0)(&mut r[1]) }
    }
}

#[test]
fn failures_within_quotients_pass_through_c() {
    let pattern = Pattern::from_entries(2, []).unwrap();
    let solver = klu(&pattern, Jacobian::DifferenceQuotients);
    type Run<'a> = &'a dyn Fn(Trap) -> Result<(), Error>;
    let cvode: Run<'_> = &|trap| {
        let options = CvodeOptions::new(1e-6, 1e-9).newton(solver.clone());
        Cvode::new(trap, 0.0, &[1.0, 0.0], &options)?.solve_to(1.0).map(|_| ())
    };
    let arkode: Run<'_> = &|trap| {
        let options = ArkodeOptions::new(1e-6, 1e-9).newton(solver.clone());
        Arkode::new(trap, 0.0, &[1.0, 0.0], &options)?.solve_to(1.0).map(|_| ())
    };
    let ida: Run<'_> = &|trap| {
        let options = IdaOptions::new(1e-6, 1e-9).newton(solver.clone());
        let mut ida = Ida::new(trap, 0.0, &[1.0, 0.0], &[-1.0, 0.0], &options)?;
        ida.solve_to(1.0).map(|_| ())
    };
    for (run, place) in [(cvode, Callback::Rhs), (arkode, Callback::Rhs), (ida, Callback::Residual)]
    {
        let cause = |how: fn(&mut f64) -> Result<(), Failure>| match run(Trap(how)) {
            Err(Error::Integration(error)) => error.cause,
            other => panic!("{other:?} is not an integration error"),
        };
        assert_eq!(cause(|_| Err(std::fmt::Error.into())), Cause::Fatal(place));
        let refused = cause(|_| Err(Failure::Recoverable("no".into())));
        assert!(matches!(refused, Cause::Rejected { callback, .. } if callback == place));
        let nan = cause(|output| {
            *output = f64::NAN;
            Ok(())
        });
        assert!(
            matches!(nan, Cause::NotFinite { callback, component: 1, .. } if callback == place),
            "{nan:?}"
        );
        let panics = || run(Trap(|_| panic!("sabotage")));
        let panic = catch_unwind(AssertUnwindSafe(panics)).unwrap_err();
        assert_eq!(panic.downcast_ref(), Some(&"sabotage"));
    }
}

/// Heat along a rod with cold ends; counts its evaluations.
struct Rod<'a>(&'a Cell<u64>);

impl Ode for Rod<'_> {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.0.set(self.0.get() + 1);
        let n = y.len();
        for i in 0..n {
            let left = if i > 0 { y[i - 1] } else { 0.0 };
            let right = if i + 1 < n { y[i + 1] } else { 0.0 };
            ydot[i] = ((n + 1) * (n + 1)) as f64 * (left - 2.0 * y[i] + right);
        }
        Ok(())
    }
}

impl Dae for Rod<'_> {
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        self.rhs(t, y, r)?;
        r.iter_mut().zip(yp).for_each(|(r, yp)| *r -= yp);
        Ok(())
    }
}

/// Three colours tell the columns of a tridiagonal matrix apart, whatever its size; the statistics count every
/// evaluation, and a new start counts from zero.
#[test]
fn a_jacobian_costs_as_many_evaluations_as_colours() {
    let n = 40;
    let y0: Vec<f64> = (1..=n).map(|i| f64::from(i) * f64::from(n + 1 - i)).collect();
    let pattern = Pattern::band(n as usize, 1, 1).unwrap();
    let solver = klu(&pattern, Jacobian::DifferenceQuotients);
    let calls = Cell::new(0);
    let check = |statistics: &Statistics, calls: u64| {
        let quotients = statistics.difference_quotient_evaluations;
        assert_eq!(quotients, 3 * statistics.jacobian_evaluations);
        assert_eq!(calls, statistics.evaluations + quotients);
        assert!(statistics.jacobian_evaluations > 0);
    };

    // the check of the pattern, which the statistics omit, would cost some more
    let options = CvodeOptions::new(1e-6, 1e-9).newton(solver.clone()).check_jacobian(false);
    let mut cvode = Cvode::new(Rod(&calls), 0.0, &y0, &options).unwrap();
    for _ in 0..2 {
        cvode.solve_to(0.1).unwrap();
        check(&cvode.statistics(), calls.take());
        cvode.reinit(0.0, &y0).unwrap();
    }

    let options = ArkodeOptions::new(1e-6, 1e-9).newton(solver.clone()).check_jacobian(false);
    let mut arkode = Arkode::new(Rod(&calls), 0.0, &y0, &options).unwrap();
    arkode.solve_to(0.1).unwrap();
    check(&arkode.statistics(), calls.take());

    let mut yp0 = vec![0.0; n as usize];
    Rod(&calls).rhs(0.0, &y0, &mut yp0).unwrap();
    calls.set(0);
    let options = IdaOptions::new(1e-6, 1e-9).newton(solver).check_jacobian(false);
    let mut ida = Ida::new(Rod(&calls), 0.0, &y0, &yp0, &options).unwrap();
    ida.solve_to(0.1).unwrap();
    check(&ida.statistics(), calls.take());
}
