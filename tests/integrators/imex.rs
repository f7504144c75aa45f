//! ImEx methods: a stiff part taken implicitly, another one explicitly.

use std::{cell::Cell, fmt::Debug};

use pliant::{
    ode::{Failure, Ode, split, with_jacobian, with_mass},
    rk::{self, DormandPrince},
    sundials::{
        Arkode, ArkodeOptions, ButcherTable, Callback, Cause, Cvode, CvodeOptions, Error,
        Integrator, Jacobian, LinearSolver, MassForm,
    },
};

/// The reactions of the Brusselator.
fn reactions(_t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    ydot[0] = 1.0 + y[0] * y[0] * y[1] - 4.0 * y[0];
    ydot[1] = 3.0 * y[0] - y[0] * y[0] * y[1];
    Ok(())
}

/// An exchange that is not linear, so that both parts act on each other.
fn exchange(_t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    let flow = 2.0 * (y[1] - y[0]) + (y[1] - y[0]).powi(3);
    ydot.copy_from_slice(&[flow, -flow]);
    Ok(())
}

fn both(t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    let mut flow = [0.0; 2];
    exchange(t, y, &mut flow)?;
    reactions(t, y, ydot)?;
    (ydot[0], ydot[1]) = (ydot[0] + flow[0], ydot[1] + flow[1]);
    Ok(())
}

const Y0: [f64; 2] = [1.2, 3.1];

#[test]
fn pairs_have_their_orders() {
    let options = rk::Options::new(1e-13, 1e-13);
    let mut exact = DormandPrince::new(both, 0.0, &Y0, &options).unwrap();
    exact.solve_to(1.0).unwrap();
    // M = diag(2, 4) and both parts multiplied by it
    type Rhs = fn(f64, &[f64], &mut [f64]) -> Result<(), Failure>;
    let heavy = |f: Rhs| {
        move |t: f64, y: &[f64], ydot: &mut [f64]| {
            f(t, y, ydot)?;
            (ydot[0], ydot[1]) = (2.0 * ydot[0], 4.0 * ydot[1]);
            Ok(())
        }
    };
    for table in ButcherTable::IMEX {
        let error = |with_a_mass: bool, steps: u32| {
            let options = ArkodeOptions::new(1e-12, 1e-12)
                .table(table)
                .fixed_step(1.0 / f64::from(steps))
                .convergence_coefficient(1e-3)
                .max_steps_between_setups(1)
                .max_steps_between_jacobians(1)
                .max_iterations(20);
            let run = |system: &mut dyn Ode| {
                let system = pliant::ode::Borrowed(system);
                let mut solver = Arkode::new(system, 0.0, &Y0, &options).unwrap();
                for _ in 0..steps {
                    solver.step(2.0).unwrap();
                }
                solver.y().iter().zip(exact.y()).map(|(y, e)| (y - e).abs()).fold(0.0, f64::max)
            };
            match with_a_mass {
                false => run(&mut split(exchange, reactions)),
                true => run(&mut with_mass(split(heavy(exchange), heavy(reactions)), [2.0, 4.0])),
            }
        };
        let steps = 80;
        let (few, many) = (error(false, steps), error(false, 2 * steps));
        let order = (few / many).log2();
        println!("{table}: {few:.1e} {many:.1e}, order {order:.2}");
        assert!(order > f64::from(table.order()) - 0.2, "{order}");
        // the mass matrix is divided out again, but for rounding
        let heavy = error(true, steps);
        assert!((heavy - few).abs() < 1e-3 * few, "{heavy:e} and {few:e}");
    }
}

/// The Brusselator whose feed w relaxes to b = 2.5 within ten microseconds: the stiff part of a slow system.
const RATE: f64 = 1e5;

fn relaxation(_t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    ydot.copy_from_slice(&[0.0, 0.0, RATE * (2.5 - y[2])]);
    Ok(())
}

fn slow(_t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    let &[u, v, w] = y else { unreachable!("three unknowns") };
    ydot.copy_from_slice(&[1.2 - (w + 1.0) * u + v * u * u, w * u - v * u * u, -w * u]);
    Ok(())
}

#[test]
fn the_stiff_part_does_not_bound_the_steps() {
    let y0 = [3.9, 1.1, 2.8];
    let end = 10.0;
    let whole = |t: f64, y: &[f64], ydot: &mut [f64]| {
        let mut stiff = [0.0; 3];
        relaxation(t, y, &mut stiff)?;
        slow(t, y, ydot)?;
        ydot.iter_mut().zip(stiff).for_each(|(f, stiff)| *f += stiff);
        Ok(())
    };
    let options = CvodeOptions::new(1e-12, 1e-14);
    let mut exact = Cvode::new(whole, 0.0, &y0, &options).unwrap();
    exact.solve_to(end).unwrap();
    let jacobian = |_t: f64, _y: &[f64], _f: &[f64], mut jacobian: faer::MatMut<'_, f64>| {
        jacobian[(2, 2)] = -RATE;
        Ok(())
    };
    for order in [3, 4, 5] {
        let (stiff_calls, slow_calls) = (Cell::new(0), Cell::new(0));
        let stiff = |t: f64, y: &[f64], ydot: &mut [f64]| {
            stiff_calls.set(stiff_calls.get() + 1);
            relaxation(t, y, ydot)
        };
        let slow = |t: f64, y: &[f64], ydot: &mut [f64]| {
            slow_calls.set(slow_calls.get() + 1);
            slow(t, y, ydot)
        };
        let options = ArkodeOptions::new(1e-6, 1e-8)
            .table(ButcherTable::imex(order).unwrap())
            .newton(LinearSolver::Dense(Jacobian::Supplied))
            // its evaluations are none of the integrator's
            .check_jacobian(false);
        let system = split(with_jacobian(stiff, jacobian), slow);
        let mut solver = Arkode::new(system, 0.0, &y0, &options).unwrap();
        solver.solve_to(end).unwrap();
        let error = solver.y().iter().zip(exact.y()).map(|(y, e)| ((y - e) / e).abs());
        let error = error.fold(0.0, f64::max);
        let statistics = solver.statistics();
        let (steps, failures) = (statistics.steps, statistics.nonlinear_failures);
        println!("order {order}: {error:.1e}, {steps} steps, {failures} failures");
        assert!(error < 8e-5);
        // an explicit method would take RATE * end / 3
        assert!(steps < 3_000);
        assert_eq!(statistics.explicit_evaluations, slow_calls.get());
        assert_eq!(statistics.evaluations, slow_calls.get() + stiff_calls.get());
        assert!(slow_calls.get() > 0 && stiff_calls.get() > 0);
        // a new start keeps both parts
        let end_state = solver.y().to_vec();
        solver.reinit(0.0, &y0).unwrap();
        solver.solve_to(end).unwrap();
        assert_eq!(solver.y(), end_state);
    }
}

#[test]
fn splits_and_tables_that_do_not_fit_are_named() {
    fn refused<T: Debug>(result: Result<T, Error>) -> String {
        let Err(Error::Input(error)) = result else { panic!("{result:?} is not an input error") };
        println!("{error}");
        error.input
    }
    let system = || split(exchange, reactions);
    let options = ArkodeOptions::new(1e-6, 1e-9);
    let imex = options.clone().table(ButcherTable::imex(3).unwrap());
    assert_eq!(refused(Arkode::new(system(), 0.0, &Y0, &options)), "right-hand side");
    assert_eq!(refused(Arkode::new(both, 0.0, &Y0, &imex)), "table");
    let cvode = Cvode::new(system(), 0.0, &Y0, &CvodeOptions::new(1e-6, 1e-9));
    assert_eq!(refused(cvode), "right-hand side");
    let explicit = DormandPrince::new(system(), 0.0, &Y0, &rk::Options::new(1e-6, 1e-9));
    assert_eq!(refused(explicit.map(|_| ())), "right-hand side");
    let dense = LinearSolver::Dense(Jacobian::DifferenceQuotients);
    let form = MassForm::new(with_mass(system(), [1.0; 2]), 2, &dense);
    assert_eq!(refused(form.map(|_| ())), "right-hand side");
    assert_eq!(refused(ButcherTable::imex(2).map_err(Error::from)), "order");
    for table in ButcherTable::IMEX {
        assert_eq!(table.name().parse(), Ok(table));
        assert!(table.is_imex() && table.is_implicit());
    }

    let lost = split(exchange, |_t, _y, _g| Err(std::io::Error::other("lost").into()));
    match Arkode::new(lost, 0.0, &Y0, &imex).unwrap().solve_to(1.0) {
        Err(Error::Integration(error)) => {
            assert_eq!(error.cause, Cause::Fatal(Callback::ExplicitRhs));
        }
        other => panic!("{other:?}"),
    }
}
