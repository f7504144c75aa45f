//! ARKODE: orders of convergence, and errors against trusted end states.
//!
//! A one-step method keeps local errors below the tolerance; the global error of these problems
//! is larger by a factor that grows with the number of steps. The bounds are some three times
//! what SUNDIALS 6.4.1 gives, so a wrong Jacobian or a broken error control breaks them.

use crate::support::OwnSolver;
use pliant::{
    ode::Ode,
    rk::{self, DormandPrince},
    samples::{Hires, Pendulum, Reference, Robertson, VanDerPol},
    sundials::{
        Arkode, ArkodeOptions, ButcherTable, Integrator, Jacobian, LinearSolver, Predictor,
        Statistics,
    },
};

const DENSE: LinearSolver = LinearSolver::Dense(Jacobian::Supplied);

/// Largest errors of the pendulum from t = 0 to 1, half a period, in steps of size 1 / `steps`: at
/// the ends of the steps, and at three places within them.
fn errors_of_fixed_steps(table: ButcherTable, steps: u32) -> (f64, f64) {
    // Newton's iteration is to leave no error of its own.
    let options = ArkodeOptions::new(1e-10, 1e-10)
        .table(table)
        .fixed_step(1.0 / f64::from(steps))
        .convergence_coefficient(1e-3)
        .max_steps_between_setups(1)
        .max_steps_between_jacobians(1)
        .max_iterations(20);
    let mut solver = Arkode::new(Pendulum, 0.0, &Pendulum::Y0, &options).unwrap();
    let mut exact = tight_pendulum();
    let mut error = |t: f64, y: &[f64]| {
        exact.solve_to(t).unwrap();
        let exact = exact.y();
        y.iter().zip(exact).map(|(y, exact)| (y - exact).abs()).fold(0.0, f64::max)
    };
    let (mut at_ends, mut within) = (0.0_f64, 0.0_f64);
    let mut y = [0.0; 4];
    for _ in 0..steps {
        solver.step(1.0).unwrap();
        let (start, end) = solver.last_step();
        for part in [0.25, 0.5, 0.75] {
            let t = start + part * (end - start);
            solver.interpolate(t, 0, &mut y).unwrap();
            within = within.max(error(t, &y));
        }
        at_ends = at_ends.max(error(end, solver.y()));
    }
    assert!((solver.t() - 1.0).abs() < 1e-12);
    (at_ends, within)
}

fn tight_pendulum() -> DormandPrince<Pendulum> {
    let options = rk::Options::new(1e-13, 1e-13);
    DormandPrince::new(Pendulum, 0.0, &Pendulum::Y0, &options).unwrap()
}

/// Numbers of steps at which the errors are small, but far above those of rounding and of Newton's
/// iteration.
fn few_steps(order: u32) -> u32 {
    [0, 0, 200, 100, 50, 40, 25, 0, 12][order as usize]
}

#[test]
fn every_table_has_its_order() {
    for table in ButcherTable::ALL {
        let steps = few_steps(table.order());
        let (few, _) = errors_of_fixed_steps(table, steps);
        let (many, _) = errors_of_fixed_steps(table, 2 * steps);
        let order = (few / many).log2();
        println!("{table:24} order {} observed {order:.2}: {few:.1e} {many:.1e}", table.order());
        // higher terms of the error are a tenth or so of the leading one at these steps
        assert!(order > f64::from(table.order()) - 0.4, "{table}: {order}");
    }
}

/// Polynomials of degree d between the steps are good to order d + 1; d is one less than the order of
/// the method, at most 3 for implicit and 5 for explicit ones. (With order 6 they are of order 4 only.)
#[test]
fn between_the_steps_errors_fall_as_the_degree_says() {
    let implicit = [2, 3, 4, 5].map(|order| ButcherTable::implicit(order).unwrap());
    let explicit = [2, 3, 4, 5].map(|order| ButcherTable::explicit(order).unwrap());
    for table in implicit.into_iter().chain(explicit) {
        let steps = few_steps(table.order());
        let (_, few) = errors_of_fixed_steps(table, steps);
        let (_, many) = errors_of_fixed_steps(table, 2 * steps);
        let promised = table.order().min(if table.is_implicit() { 4 } else { 6 });
        let order = (few / many).log2();
        println!("{table:24}: {few:.1e} {many:.1e}, order {order:.2}");
        assert!(order > f64::from(promised) - 0.5, "{table}: {order}");
    }
}

/// Error at the end and statistics.
fn run(
    system: impl Ode,
    y0: &[f64],
    reference: Reference,
    options: &ArkodeOptions,
) -> (f64, Statistics) {
    let mut solver = Arkode::new(system, 0.0, y0, options).unwrap();
    solver.solve_to(reference.t).unwrap();
    let (error, statistics) = (reference.error(solver.y()), solver.statistics());
    println!(
        "error {error:.2e}, {} steps, {} evaluations",
        statistics.steps, statistics.evaluations
    );
    (error, statistics)
}

#[test]
fn stiff_problems_by_every_order() {
    for order in 2..=5 {
        // order 2 takes its time
        let rtol = if order == 2 { 1e-6 } else { 1e-8 };
        let table = ButcherTable::implicit(order).unwrap();
        let options = |atol: f64| {
            ArkodeOptions::new(rtol, atol).table(table).newton(DENSE).max_steps(100_000)
        };
        print!("{table} HIRES ");
        let (hires, _) = run(Hires::new(), &Hires::Y0, Hires::REFERENCE, &options(1e-12));
        print!("{table} van der Pol ");
        let (van_der_pol, _) =
            run(VanDerPol::new(), &VanDerPol::Y0, VanDerPol::REFERENCE, &options(1e-12));
        assert!(hires < 1000.0 * rtol, "{table}: {hires}");
        assert!(van_der_pol < 1000.0 * rtol, "{table}: {van_der_pol}");
    }
}

#[test]
fn robertson_by_every_linear_solver() {
    let klu = LinearSolver::Klu {
        pattern: Robertson::new().pattern().clone(),
        jacobian: Jacobian::Supplied,
    };
    let quotients = LinearSolver::Dense(Jacobian::DifferenceQuotients);
    let options = ArkodeOptions::new(1e-6, [1e-10, 1e-14, 1e-8]).max_steps(100_000);
    for solver in [DENSE, quotients, klu] {
        print!("{solver:?}: ");
        let options = options.clone().newton(solver);
        let (error, _) = run(Robertson::new(), &Robertson::Y0, Robertson::REFERENCE, &options);
        assert!(error < 1e-2, "{error}");
    }
    let own = OwnSolver::new(Robertson::new(), 3);
    let options = options.newton(LinearSolver::Custom);
    let (error, _) = run(own, &Robertson::Y0, Robertson::REFERENCE, &options);
    assert!(error < 1e-2, "{error}");
}

/// The same pair of formulas as the internal method: the same accuracy for about the same work.
#[test]
fn explicit_steps_are_those_of_the_internal_method() {
    const END: f64 = 5.0;
    let (rtol, mut tight) = (1e-9, tight_pendulum());
    tight.solve_to(END).unwrap();
    let exact = tight.y();
    let error =
        |y: &[f64]| y.iter().zip(exact).map(|(y, exact)| (y - exact).abs()).fold(0.0, f64::max);
    let options = ArkodeOptions::new(rtol, rtol).table(ButcherTable::explicit(5).unwrap());
    let mut theirs = Arkode::new(Pendulum, 0.0, &Pendulum::Y0, &options).unwrap();
    theirs.set_stop_time(Some(END)).unwrap();
    theirs.solve_to(END).unwrap();
    let options = rk::Options::new(rtol, rtol);
    let mut ours = DormandPrince::new(Pendulum, 0.0, &Pendulum::Y0, &options).unwrap();
    ours.solve_to(END).unwrap();
    let errors = [error(theirs.y()), error(ours.y())];
    let steps = [theirs.statistics().steps as f64, ours.statistics().steps as f64];
    println!("errors {errors:?}, steps {steps:?}");
    // a pendulum is as accurate as its steps, times the number of its swings
    assert!(errors.iter().all(|&error| error < 1000.0 * rtol), "{errors:?}");
    assert!((0.5..2.0).contains(&(steps[0] / steps[1])), "{steps:?}");
}

/// A predictor that starts at the state of the step before costs iterations.
#[test]
fn predictors_spare_evaluations() {
    let evaluations = |predictor| {
        let options = ArkodeOptions::new(1e-6, 1e-10).newton(DENSE).predictor(predictor);
        let (error, statistics) = run(Hires::new(), &Hires::Y0, Hires::REFERENCE, &options);
        assert!(error < 1e-4, "{error}");
        statistics.evaluations
    };
    let (variable, trivial) =
        (evaluations(Predictor::VariableOrder), evaluations(Predictor::Trivial));
    assert!(variable < trivial, "{variable} {trivial}");
}

#[test]
fn bad_tables_orders_and_options_are_named() {
    let says = |error: &dyn std::error::Error, part: &str| {
        let text = error.to_string();
        assert!(text.contains(part), "{text}");
    };
    says(&"RK4".parse::<ButcherTable>().unwrap_err(), "ESDIRK436L2SA_6_3_4");
    says(&ButcherTable::implicit(7).unwrap_err(), "orders 2 to 5");
    let options = ArkodeOptions::new(1e-6, 1e-8).fixed_step(f64::NAN);
    says(&Arkode::new(Pendulum, 0.0, &Pendulum::Y0, &options).unwrap_err(), "fixed_step");
}

#[test]
fn solvers_can_be_sent() {
    fn is_send<T: Send>(_: &T) {}
    let solver = Arkode::new(Pendulum, 0.0, &Pendulum::Y0, &ArkodeOptions::new(1e-6, 1e-8));
    is_send(&solver.unwrap());
}

/// A panic of the system passes through C, and leaves nothing behind that a new start would trip on.
#[test]
fn a_panic_of_the_system_passes_through() {
    let mut calls = 0;
    let moody = move |_t: f64, y: &[f64], ydot: &mut [f64]| {
        calls += 1;
        assert!(calls != 50, "enough");
        ydot[0] = -y[0];
        Ok(())
    };
    let options = ArkodeOptions::new(1e-9, 1e-9);
    let mut solver = Arkode::new(moody, 0.0, &[1.0], &options).unwrap();
    let panic = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| solver.solve_to(5.0)));
    assert!(panic.is_err());
    solver.reinit(0.0, &[1.0]).unwrap();
    solver.solve_to(1.0).unwrap();
    assert!((solver.y()[0] - (-1.0_f64).exp()).abs() < 1e-7);
}
