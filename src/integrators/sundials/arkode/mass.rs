//! The mass matrix of M y' = f(t, y) in ARKODE.

use crate::integrators::sundials::functions::named;
use std::ffi::c_void;

use crate::integrators::{
    common::{Callback, Error},
    ode::{MassKind, Ode},
    sundials::{
        ffi,
        host::{Host, STOP},
        linear::Linear,
        linear_solver::LinearSolver,
        matrix::{self, Entries},
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
        arkode.set(named!(ARKStepSetMassFn), Some(fill::<S>))
    }
}

/// `ARKLsMassFn`
unsafe extern "C" fn fill<S: Ode>(
    t: f64,
    mass: ffi::SUNMatrix,
    data: *mut c_void,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
    _: ffi::N_Vector,
) -> i32 {
    // SAFETY: the data is the host of the solver, which nobody else uses during this call.
    let host = unsafe { &mut *data.cast::<Host<S>>() };
    let Some(solver) = &host.linear_solver else { return STOP };
    // SAFETY: SUNDIALS passes the matrix that was made for this linear solver.
    let entries = unsafe { matrix::entries(mass, solver, host.n) };
    let outcome = host.guard(Callback::Mass, t, |system| match entries {
        Entries::Dense(matrix) => system.dense_mass(t, matrix),
        Entries::Band(matrix) => system.banded_mass(t, matrix),
        Entries::Sparse(values) => system.sparse_mass(t, values),
        Entries::Custom => unreachable!("a custom solver has no mass matrix"),
    });
    if outcome != 0 {
        return outcome;
    }
    let Some(solver) = &host.linear_solver else { return STOP };
    // SAFETY: as above; the user's access has ended.
    let values = unsafe { matrix::stored(mass, solver, host.n) };
    host.check_finite(Callback::Mass, t, values)
}
