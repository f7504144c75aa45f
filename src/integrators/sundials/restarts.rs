//! Restarts of C: after a first step or an explicit stage that failed, from the present state; and the state of C then.

use super::{
    ffi,
    session::{Memory, Session},
    vector::Vector,
};
use crate::integrators::common::{Cause, Error};

impl<K, S> Session<K, S> {
    /// Sets the size of the first step after a start; 0 requests an estimate. Multirate methods have their own.
    pub(super) fn set_first_step(&mut self, h: f64) -> Result<(), Error> {
        match self.memory.functions.set_initial_step {
            // SAFETY: the value is a plain number.
            Some(set) => unsafe { self.set(set, h) },
            None => Ok(()),
        }
    }

    /// After a first step of IDA that failed, from `before` towards `target`: lets C start with a smaller
    /// one, if that may help.
    ///
    /// The first step is a thousandth of the way to `target` unless y' suggests less, and C gives up after
    /// ten failures, six decades below. A stiff problem may need an even smaller step.
    pub(super) fn shortens_first_step(
        &mut self,
        code: i32,
        before: f64,
        target: f64,
    ) -> Result<bool, Error> {
        // the smallest step, as a fraction of the way to the target
        const LEAST: f64 = 1e-30;
        let failed = [ffi::CV_ERR_FAILURE, ffi::CV_CONV_FAILURE].contains(&code);
        let is_dae = self.yp.is_some() && self.host.get().find_index.is_some();
        if !failed || !is_dae || self.initial_step.is_some() {
            return Ok(false);
        }
        let statistics = self.step_statistics();
        let h = 0.25 * statistics.current_step;
        let moves = before + h != before && h.abs() > LEAST * (target - before).abs();
        if statistics.steps > 0 || !moves || self.higher_index(&Cause::ErrorTest).is_some() {
            return Ok(false);
        }
        self.elapsed = before;
        self.forget_factors();
        self.start_c_again(before)?;
        self.set_first_step(h)?;
        Ok(true)
    }

    /// After an explicit stage of ARKODE without a right-hand side: C continues from the end of the last step with a smaller one, up to the time
    /// `stop`, with its counts as they are, if that may help. C has no retry there.
    pub(super) fn shortens_explicit_step(
        &mut self,
        code: i32,
        stop: Option<f64>,
    ) -> Result<bool, Error> {
        let functions = self.memory.functions;
        let (Some(reset), Some(end)) = (functions.reset, self.host.get().step_end) else {
            return Ok(false);
        };
        let failed = [ffi::ARK_UNREC_RHSFUNC_ERR, ffi::ARK_RHSFUNC_FAIL].contains(&code);
        let h = 0.25 * self.step_statistics().current_step;
        // a state where the right-hand side is undefined itself stays so
        if !failed
            || self.has_fixed_step
            || !self.host.get().troubles.requests_smaller_step(end)
            || end + h == end
        {
            return Ok(false);
        }
        // SAFETY: memory and vector are alive; C has written the end of the last step there, and copies it. The values are plain numbers.
        unsafe {
            self.host.call(reset, |reset| reset(self.memory.raw, end, self.scratch.raw()))?;
            self.set_first_step(h)?;
            if let Some(stop) = stop {
                self.set(functions.set_stop_time, stop)?;
            }
        }
        self.elapsed = end;
        Ok(true)
    }

    /// Makes C start at time `t` from the present state, integrals and sensitivities.
    pub(super) fn start_c_again(&mut self, t: f64) -> Result<(), Error> {
        self.start_c(t)?;
        self.hand_over_quadratures()?;
        self.hand_over_sensitivities()
    }

    /// Makes C start at time `t` from the present state: `CVodeReInit`, `ARKStepReInit` or `IDAReInit`.
    pub(super) fn start_c(&mut self, t: f64) -> Result<(), Error> {
        let Memory { raw: memory, functions } = self.memory;
        let (stages, y, yp) = (self.stages, self.y.raw(), self.raw_yp());
        // SAFETY: memory and vectors are alive; the integrator copies the vectors, and the right-hand sides are those
        // that it was made with.
        self.host.call(functions.reinit, |reinit| unsafe { reinit(memory, stages, t, y, yp) })
    }

    /// Whether the state that C has written is finite.
    pub(super) fn is_auxiliary_finite(&self) -> bool {
        let vectors = [Some(&self.scratch), self.slope_scratch.as_ref()];
        vectors.into_iter().flatten().all(|vector| vector.as_slice().iter().all(|y| y.is_finite()))
    }

    /// Whether C still has a state to continue from. It predicts by sums of its history, in place, and undoes
    /// them after a failure: sums that overflowed leave NaN.
    pub(super) fn has_finite_history(&mut self) -> bool {
        let (_, get_dky) = self.memory.functions.get_dky;
        let t = self.step_statistics().current_time;
        // SAFETY: memory and vector are alive; CVODE and IDA call no callback here.
        let code = unsafe { get_dky(self.memory.raw, t, 0, self.scratch.raw()) };
        code >= 0 && self.scratch.as_slice().iter().all(|y| y.is_finite())
    }

    /// Reads y and y' of a DAE again: single steps of IDA return them as they were before unknowns were set
    /// to their bounds.
    pub(super) fn read_corrected(&mut self) -> Result<(), Error> {
        let Some(yp) = self.yp.as_ref().map(Vector::raw) else { return Ok(()) };
        let Memory { raw: memory, functions } = self.memory;
        for (order, vector) in [(0, self.y.raw()), (1, yp)] {
            // SAFETY: memory and vector are alive; IDA calls no callback here.
            self.host.call(functions.get_dky, |get| unsafe {
                get(memory, self.elapsed, order, vector)
            })?;
        }
        Ok(())
    }
}
