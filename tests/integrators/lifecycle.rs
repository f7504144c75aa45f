//! Creates, uses and drops solvers of every kind, in every way a solver can end.
//!
//! Meant to be run under valgrind (`make valgrind`), where `PLIANT_LIFECYCLES` sets the number of
//! rounds; each round makes some forty solvers.

use std::{
    hint::black_box,
    panic::{self, AssertUnwindSafe, catch_unwind},
};

use crate::{
    outputs,
    support::{End, OwnSolver},
};
use pliant::{
    ode::{Failure, MassMatrix, dae_with_parameters, with_mass, with_parameters},
    samples::Robertson,
    sundials::{
        Adjoint, AdjointOptions, Arkode, ArkodeOptions, ButcherTable, Cvode, CvodeOptions,
        DaeAdjoint, Ida, IdaOptions, InitialCondition, Integrator, Jacobian, Krylov, KrylovMethod,
        LinearSolver, Multistep, Pattern, Preconditioner, Sensitivities, Side, Sign,
    },
};

const ATOL: [f64; 3] = [1e-8, 1e-14, 1e-6];

fn linear_solvers() -> [LinearSolver; 7] {
    let pattern = || Robertson::new().pattern().clone();
    let gmres = Krylov::new(KrylovMethod::Gmres { dimension: 3, restarts: 1 });
    let bicgstab = Krylov::new(KrylovMethod::BiCgStab { iterations: 9 });
    let jacobian = Jacobian::DifferenceQuotients;
    let ilu = Preconditioner::Ilu { pattern: pattern(), jacobian };
    [
        LinearSolver::Dense(Jacobian::Supplied),
        LinearSolver::Dense(Jacobian::DifferenceQuotients),
        LinearSolver::Band { lower: 2, upper: 2, jacobian: Jacobian::DifferenceQuotients },
        LinearSolver::Klu { pattern: pattern(), jacobian: Jacobian::Supplied },
        LinearSolver::Klu { pattern: pattern(), jacobian },
        LinearSolver::Krylov(gmres.preconditioner(Side::Left, ilu)),
        LinearSolver::Krylov(bicgstab),
    ]
}

/// A solver of this type for each linear solver: started, started anew, stopped, looked back on.
macro_rules! each_linear_solver {
    ($solver:ident, $options:ident) => {
        for solver in linear_solvers() {
            let options = $options::new(1e-4, ATOL).newton(solver);
            let mut solver = $solver::new(Robertson::new(), 0.0, &Robertson::Y0, &options).unwrap();
            solver.solve_to(0.4).unwrap();
            solver.reinit(0.0, &Robertson::Y0).unwrap();
            solver.set_stop_time(Some(0.05)).unwrap();
            solver.solve_to(0.1).unwrap();
            let (start, _) = solver.last_step();
            solver.interpolate(start, 0, &mut [0.0; 3]).unwrap();
            drop(black_box(solver.into_system()));
        }
    };
}

fn cvode_solvers() {
    each_linear_solver!(Cvode, CvodeOptions);
    let options = CvodeOptions::new(1e-4, ATOL).newton(LinearSolver::Custom);
    let system = OwnSolver::new(Robertson::new(), 3);
    let mut solver = Cvode::new(system, 0.0, &Robertson::Y0, &options).unwrap();
    solver.solve_to(0.4).unwrap();

    let options = CvodeOptions::new(1e-4, 1e-6).method(Multistep::Adams).fixed_point(3);
    let mut solver = Cvode::new(Robertson::new(), 0.0, &Robertson::Y0, &options).unwrap();
    solver.solve_to(1e-3).unwrap();
}

fn arkode_solvers() {
    each_linear_solver!(Arkode, ArkodeOptions);
    let options = ArkodeOptions::new(1e-4, 1e-6).table(ButcherTable::explicit(5).unwrap());
    let mut solver = Arkode::new(Robertson::new(), 0.0, &Robertson::Y0, &options).unwrap();
    solver.solve_to(1e-3).unwrap();

    let on_pattern = Robertson::new().pattern().values((0..3).map(|i| (i, i, 1.0))).unwrap();
    for solver in linear_solvers() {
        let mass = match solver {
            LinearSolver::Klu { .. } => MassMatrix::Sparse(on_pattern.clone()),
            _ => MassMatrix::Diagonal(vec![1.0; 3]),
        };
        let system = with_mass(Robertson::new(), mass);
        let options =
            ArkodeOptions::new(1e-4, ATOL).newton(solver).sign_constraints([Sign::NonNegative; 3]);
        // what works on no matrix is refused with a mass matrix
        if let Ok(mut solver) = Arkode::new(system, 0.0, &Robertson::Y0, &options) {
            solver.solve_to(1e-3).unwrap();
        }
    }
}

fn ida_solvers() {
    for solver in linear_solvers() {
        let options = IdaOptions::new(1e-4, ATOL)
            .newton(solver)
            .differential(Robertson::DIFFERENTIAL)
            .suppress_algebraic(true);
        let mut solver =
            Ida::new(Robertson::new(), 0.0, &Robertson::Y0, &[0.0; 3], &options).unwrap();
        solver.consistent_start(InitialCondition::Algebraic, 0.4).unwrap();
        solver.solve_to(0.4).unwrap();
        solver.reinit_with(0.0, &Robertson::Y0, &Robertson::YP0).unwrap();
        solver.solve_to(0.1).unwrap();
    }
    let options = IdaOptions::new(1e-4, ATOL).newton(LinearSolver::Custom);
    let system = OwnSolver::new(Robertson::new(), 3);
    let mut solver = Ida::new(system, 0.0, &Robertson::Y0, &Robertson::YP0, &options).unwrap();
    solver.solve_to(0.4).unwrap();
}

/// Sensitivities and integrals come and go with the solvers, also where the constructor refuses late.
fn solvers_with_sensitivities() {
    let decay = || {
        with_parameters(
            |_t: f64, y: &[f64], p: &[f64], ydot: &mut [f64]| {
                ydot[0] = -p[0] * y[0];
                Ok(())
            },
            [2.0, 1.0],
        )
    };
    for sensitivities in [Sensitivities::of([0, 1]), Sensitivities::of([0]).staggered()] {
        let options = CvodeOptions::new(1e-4, 1e-6).sensitivities(sensitivities.clone());
        let mut solver = Cvode::new(decay(), 0.0, &[1.0], &options).unwrap();
        solver.solve_to(0.4).unwrap();
        solver.reinit(0.0, &[1.0]).unwrap();
        solver.solve_to(0.1).unwrap();
        drop(black_box(solver.into_system()));
        assert!(Cvode::new(decay(), 0.0, &[1.0], &options.fixed_point(0)).is_err());

        let residual = |_t: f64, y: &[f64], yp: &[f64], p: &[f64], r: &mut [f64]| {
            r[0] = yp[0] + p[0] * y[0];
            Ok(())
        };
        let options = IdaOptions::new(1e-4, 1e-6).differential([true]).sensitivities(sensitivities);
        let system = dae_with_parameters(residual, [2.0, 1.0]);
        let mut solver = Ida::new(system, 0.0, &[1.0], &[-2.0], &options).unwrap();
        assert!(solver.consistent_start(InitialCondition::State, 0.4).is_err());
        solver.consistent_start(InitialCondition::Algebraic, 0.4).unwrap();
        solver.solve_to(0.4).unwrap();
        let wrong = options.sensitivities(Sensitivities::of([7]));
        let system = dae_with_parameters(residual, [2.0, 1.0]);
        assert!(Ida::new(system, 0.0, &[1.0], &[-2.0], &wrong).is_err());
    }
}

/// Backward problems go before the forward ones.
fn adjoint_solvers() {
    for solver in linear_solvers() {
        let forward = CvodeOptions::new(1e-4, ATOL).newton(solver.clone());
        let options = AdjointOptions::new(1e-4, 1e-6).checkpoint_steps(10);
        let dae = IdaOptions::new(1e-4, ATOL)
            .newton(solver.clone())
            .differential(Robertson::DIFFERENTIAL);
        // what works on no matrix is refused, as it cannot be transposed
        if let Ok(mut adjoint) =
            Adjoint::new(Robertson::new(), End, 0.0, &Robertson::Y0, &forward, &options)
        {
            adjoint.gradient(0.4).unwrap();
            adjoint.gradient(0.2).unwrap();
        }
        let (y0, yp0) = (&Robertson::Y0, &Robertson::YP0);
        if let Ok(mut adjoint) =
            DaeAdjoint::new(Robertson::new(), End, 0.0, y0, yp0, &dae, &options)
        {
            adjoint.gradient(0.4).unwrap();
            adjoint.gradient(0.2).unwrap();
        }
        let dae = dae.max_steps(3);
        if let Ok(mut adjoint) =
            DaeAdjoint::new(Robertson::new(), End, 0.0, y0, yp0, &dae, &options)
        {
            adjoint.gradient(0.4).unwrap_err();
        }
    }
}

fn solvers_that_fail() {
    type Rhs = fn(f64, &[f64], &mut [f64]) -> Result<(), Failure>;
    let fatal: Rhs = |_, _, _| Err(std::fmt::Error.into());
    let refusing: Rhs = |_, _, _| Err(Failure::Recoverable("no".into()));
    let panicking: Rhs = |_, _, _| panic!("sabotage");
    let roots_of_bad_numbers: Rhs = |t, _, ydot| {
        ydot[0] = (0.01 - t).sqrt();
        Ok(())
    };
    let options = CvodeOptions::new(1e-4, 1e-6);
    for system in [fatal, refusing, roots_of_bad_numbers] {
        let mut solver = Cvode::new(system, 0.0, &[1.0], &options).unwrap();
        solver.solve_to(1.0).unwrap_err();
    }
    let mut solver = Cvode::new(panicking, 0.0, &[1.0], &options).unwrap();
    catch_unwind(AssertUnwindSafe(|| solver.solve_to(1.0))).unwrap_err();

    // Refused by the constructor.
    let pattern = Pattern::from_entries(2, []).unwrap();
    let options = options.newton(LinearSolver::Klu { pattern, jacobian: Jacobian::Supplied });
    assert!(Cvode::new(fatal, 0.0, &[1.0], &options).is_err());
}

#[test]
fn solvers_come_and_go() {
    let rounds = std::env::var("PLIANT_LIFECYCLES").ok().map_or(10, |n| n.parse().unwrap());
    // Keep the expected panics quiet.
    panic::set_hook(Box::new(|_| ()));
    for _ in 0..rounds {
        cvode_solvers();
        arkode_solvers();
        ida_solvers();
        solvers_with_sensitivities();
        adjoint_solvers();
        solvers_that_fail();
        // what they add to would show here if nobody had written it
        outputs::every_call();
    }
    drop(panic::take_hook());
}
