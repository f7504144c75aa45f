//! Building the slow part of a multirate method, around the session of the fast one.

use std::{ffi::c_void, ptr};

use super::options::MultirateOptions;
use crate::integrators::{
    common::{Clock, Error, check_start, check_whole},
    ode::Ode,
    sundials::{
        ffi,
        functions::{Functions, OdeFunctions, StageFunctions, Stages, named},
        ode_callbacks::{explicit_rhs, note_step_end, rhs, roots},
        session::{InitialState, Session},
    },
};

/// The kind of the session of the slow part.
pub(super) struct MultirateKind {
    /// Freed after the memory of the slow part, and before that of the fast one.
    _fast: FastStepper,
}

/// Owns the object by which slow steps call the fast integrator.
pub(super) struct FastStepper(ffi::MRIStepInnerStepper);

impl FastStepper {
    /// # Safety
    /// The memory is one of ARKStep, and outlives the result.
    pub(super) unsafe fn new(fast: *mut c_void) -> Result<Self, Error> {
        let mut raw = ptr::null_mut();
        // SAFETY: the caller vouches for the memory; the result pointer is valid.
        let code = unsafe { ffi::ARKStepCreateMRIStepInnerStepper(fast, &raw mut raw) };
        if code != 0 || raw.is_null() {
            return Err(Error::call("ARKStepCreateMRIStepInnerStepper", code));
        }
        Ok(Self(raw))
    }
}

impl Drop for FastStepper {
    fn drop(&mut self) {
        // SAFETY: made by ARKStepCreateMRIStepInnerStepper and freed once.
        unsafe { ffi::MRIStepInnerStepper_Free(&raw mut self.0) };
    }
}

impl<S: Ode> Session<MultirateKind, S> {
    /// The session of the slow part `system`.
    pub(super) fn of_multirate(
        system: S,
        fast: FastStepper,
        t0: f64,
        y0: &[f64],
        options: &MultirateOptions,
    ) -> Result<Self, Error> {
        check_start(t0, y0)?;
        options.check(y0)?;
        let coupling = options.own.coupling;
        if !coupling.is_imex() {
            check_whole(&system)?;
        } else if !system.is_split() {
            let help = "it is for a slow part of two parts: see `is_split` and `split`";
            return Err(Error::input("coupling", format!("{coupling:?}"), help));
        }
        let start = InitialState { t: t0, y: y0, yp: None, root_count: system.root_count() };
        let stages: Stages = match (coupling.is_imex(), coupling.is_implicit()) {
            (true, _) => [Some(explicit_rhs::<S>), Some(rhs::<S>)],
            (false, true) => [None, Some(rhs::<S>)],
            (false, false) => [Some(rhs::<S>), None],
        };
        let solver = options.newton_solver().filter(|_| coupling.is_implicit()).cloned();
        let begin = Clock::starting_at(t0).start();
        let stepper = fast.0;
        let kind = MultirateKind { _fast: fast };
        // SAFETY: `create` gets a live context and a vector of its own, the table is that of MRIStep, and the callbacks
        // fit the host that is registered as their data.
        let mut slow = unsafe {
            let create =
                |y, context| ffi::MRIStepCreate(stages[0], stages[1], begin, y, stepper, context);
            let create = ("MRIStepCreate", create);
            Self::create(Functions::MULTIRATE, create, kind, system, &start, solver)?
        };
        slow.stages = stages;
        slow.has_fixed_step = true;
        slow.known_order = Some(coupling.order());
        slow.host.get_mut().step_end = Some(slow.elapsed);
        slow.configure(options)?;
        // Hermite polynomials of degree 3 are those of slopes at the ends of steps alone. SUNDIALS 7.1.1 has a wrong slope
        // at the start of a step.
        let highest = if cfg!(sundials_major = "6") { 3 } else { 2 };
        let degree = (coupling.order() - 1).min(highest);
        slow.interpolant_degree = Some(degree);
        // SAFETY: the callbacks fit the host; the memory is alive; the other values are plain numbers.
        unsafe {
            slow.set_root_functions(OdeFunctions::MULTIRATE.set_roots, Some(roots::<S>))?;
            let table = ffi::MRIStepCoupling_LoadTable(coupling.id());
            let set = slow.set(named!(MRIStepSetCoupling), table);
            // C keeps a copy
            ffi::MRIStepCoupling_Free(table);
            set?;
            slow.set(named!(MRIStepSetInterpolantDegree as _), degree as i32)?;
            slow.set(named!(MRIStepSetFixedStep), options.own.slow_step)?;
            slow.set(named!(MRIStepSetPostprocessStepFn as _), Some(note_step_end::<S> as _))?;
        }
        if coupling.is_implicit() {
            options.own.stages.set(&mut slow, StageFunctions::MULTIRATE, options)?;
        }
        Ok(slow)
    }
}
