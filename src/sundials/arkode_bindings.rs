//! The generated ARKODE bindings work, with the same callbacks as CVODE.

use super::{context::Context, ffi, host::*, ode_callbacks::rhs, vector::Vector};

#[test]
fn an_implicit_runge_kutta_method_solves_a_decay() {
    let decay = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot[0] = -y[0];
        Ok(())
    };
    fn callback_of<S: crate::ode::Ode>(_: &S) -> ffi::ARKRhsFn {
        Some(rhs::<S>)
    }
    let callback = callback_of(&decay);
    let context = Context::new().unwrap();
    let y = Vector::from_slice(&[1.0], &context).unwrap();
    let host = HostBox::new(Host::new(decay, 1, 0, None));
    let mut t = 0.0;
    // SAFETY: all objects live to the end of the block, and the callback fits the host.
    unsafe {
        let mut ark = ffi::ARKStepCreate(None, callback, 0.0, y.raw(), context.raw());
        assert!(!ark.is_null());
        let solver = ffi::SUNNonlinSol_FixedPoint(y.raw(), 2, context.raw());
        assert_eq!(ffi::ARKStepSetUserData(ark, host.as_ptr()), ffi::ARK_SUCCESS);
        assert_eq!(ffi::ARKStepSStolerances(ark, 1e-6, 1e-10), ffi::ARK_SUCCESS);
        assert_eq!(ffi::ARKStepSetNonlinearSolver(ark, solver), ffi::ARK_SUCCESS);
        let code = ffi::ARKStepEvolve(ark, 1.0, y.raw(), &raw mut t, ffi::ARK_NORMAL);
        assert_eq!(code, ffi::ARK_SUCCESS);
        ffi::ARKStepFree(&raw mut ark);
        ffi::SUNNonlinSolFree(solver);
    }
    // The global error stays within a small multiple of rtol.
    assert!((y.as_slice()[0] - (-1f64).exp()).abs() < 1e-5);
}
