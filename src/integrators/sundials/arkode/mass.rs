//! The mass matrix of M y' = f(t, y) in ARKODE.

use crate::integrators::{
    common::Error,
    ode::{MassKind, Ode},
    sundials::{
        ffi, functions::named, linear::Linear, linear_solver::LinearSolver, ode_callbacks,
        session::Session,
    },
};

/// The linear solver that gives a mass matrix its form: C requires that of the Newton matrix.
pub(super) fn check(solver: Option<&LinearSolver>) -> Result<LinearSolver, Error> {
    match solver {
        Some(
            solver
            @ (LinearSolver::Dense(_) | LinearSolver::Band { .. } | LinearSolver::Klu { .. }),
        ) => Ok(solver.clone()),
        Some(other) => {
            let help = "with a mass matrix it is dense, of band form or sparse (KLU)";
            Err(Error::input("linear solver", format!("{other:?}"), help))
        }
        None => {
            let help = "a mass matrix needs a linear solver: choose `newton`";
            Err(Error::input("nonlinear solver", "fixed_point", help))
        }
    }
}

/// Gives ARKODE a mass matrix, in the form of `solver`, and a separate linear solver for it.
pub(super) fn attach<K, S: Ode>(
    arkode: &mut Session<K, S>,
    solver: &LinearSolver,
    kind: MassKind,
) -> Result<(), Error> {
    let data = arkode.host.as_ptr();
    // SAFETY: the data is the host, which outlives the solver.
    let linear = unsafe { Linear::new::<S>(solver, &arkode.y, &arkode.context, data)? };
    let linear = arkode.mass.insert(linear);
    let (raw, mass) = (linear.solver(), linear.matrix());
    let time_dependent = i32::from(kind == MassKind::TimeDependent);
    // SAFETY: memory, solver and matrix are alive, and the memory is dropped first; the callback fits the
    // host that is registered as its data.
    unsafe {
        let code = ffi::ARKStepSetMassLinearSolver(arkode.memory.raw, raw, mass, time_dependent);
        arkode.host.accept("ARKStepSetMassLinearSolver", code)?;
        arkode.set(named!(ARKStepSetMassFn), Some(ode_callbacks::mass::<S>))
    }
}
