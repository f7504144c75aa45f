//! Integration by a session: steps, interpolation, stop times and restarts.

use std::{ffi::c_void, mem, ptr};

use super::{
    differences::Differences,
    ffi,
    progress::{Progress, STRETCH},
    session::Session,
    signs::check_state,
    vector::Vector,
};
use crate::integrators::common::{
    Clock, Error, Integrator, Reached, SHORTEST, Statistics, check_finite, check_length,
    check_start_time, check_time, number_before,
};

/// Explicit methods whose steps stability limits fail the error test more often than one in twenty, if there are many.
const UNSTABLE: f64 = 0.05;
const MANY: u64 = 1000;

/// Return code of a call that succeeded.
const DONE: i32 = 0;

impl<K, S> Integrator for Session<K, S> {
    type System = S;

    fn t(&self) -> f64 {
        self.t
    }

    fn y(&self) -> &[f64] {
        self.y.as_slice()
    }

    fn solve_to(&mut self, t: f64) -> Result<Reached, Error> {
        self.integrate(t, ffi::CV_NORMAL)
    }

    fn step(&mut self, towards: f64) -> Result<Reached, Error> {
        self.integrate(towards, ffi::CV_ONE_STEP)
    }

    fn last_step(&self) -> (f64, f64) {
        let (start, end) = self.reach_of_last_step();
        (self.clock().time(start), self.clock().time(end))
    }

    fn last_order(&self) -> u32 {
        self.step_statistics().last_order
    }

    fn interpolant_degree(&self) -> u32 {
        self.interpolant_degree.unwrap_or_else(|| self.last_order())
    }

    fn interpolate(&mut self, t: f64, derivative: u32, out: &mut [f64]) -> Result<(), Error> {
        check_length("length of out", out.len(), self.y().len())?;
        check_time("t", t)?;
        if !self.has_step {
            self.check_start_only(t, derivative)?;
            out.copy_from_slice(self.y());
            return Ok(());
        }
        if let Some(degree) = self.interpolant_degree.filter(|degree| derivative > *degree) {
            let help = format!("the polynomials between the steps are of degree {degree}");
            return Err(Error::input("derivative", derivative, help));
        }
        let (name, get_dky) = self.memory.functions.get_dky;
        let scratch = self.scratch.raw();
        // SAFETY: memory and vector are alive; `&mut self` keeps others away while ARKODE evaluates
        // the right-hand side.
        self.look_back(name, t, derivative, |memory, t, order| unsafe {
            get_dky(memory, t, order, scratch)
        })?;
        out.copy_from_slice(self.scratch.as_slice());
        Ok(())
    }

    fn set_stop_time(&mut self, t: Option<f64>) -> Result<(), Error> {
        if let Some(t) = t {
            check_time("stop time", t)?;
            let statistics = self.step_statistics();
            let elapsed = self.clock().elapsed(t);
            if (elapsed - statistics.current_time) * statistics.last_step < 0.0 || t == self.t {
                let reached = self.clock().time(statistics.current_time);
                let help = format!("the steps have reached {reached} already");
                return Err(Error::input("stop time", t, help));
            }
        }
        let clock = &mut self.host.get_mut().clock;
        clock.go_on();
        self.stop_time.set(t, *clock);
        Ok(())
    }

    fn set_stop_before(&mut self, t: f64) -> Result<(), Error> {
        let before = number_before(t, self.t);
        if before == self.t {
            let clock = &mut self.host.get_mut().clock;
            clock.go_on();
            self.stop_time.set(Some(before), *clock);
        } else {
            self.set_stop_time(Some(before))?;
        }
        let stop = self.host.get_mut().clock.end_before(t, before, self.elapsed);
        self.stop_time.keep(Some(stop));
        Ok(())
    }

    fn reinit(&mut self, t: f64, y: &[f64]) -> Result<(), Error> {
        check_length("length of y", y.len(), self.y().len())?;
        check_start_time("t", t)?;
        check_finite("y", y)?;
        check_state(&self.signs, "y", y)?;
        self.y.as_mut_slice().copy_from_slice(y);
        let clock = Clock::starting_at(t);
        let start = clock.start();
        self.start_c(start)?;
        self.host.get_mut().clock = clock;
        self.restart_quadratures()?;
        self.restart_sensitivities()?;
        (self.t, self.elapsed) = (t, start);
        self.progress = Progress::default();
        (self.has_step, self.failed_within, self.history_lost) = (false, false, false);
        let host = self.host.get_mut();
        host.troubles.clear();
        host.step_end = host.step_end.and(Some(start));
        host.differences.iter_mut().for_each(Differences::restart);
        match self.memory.functions.reinit_forgets_stop_time {
            true => self.stop_time.forget(),
            false => self.stop_time.keep(None),
        }
        self.roots_found.fill(0);
        Ok(())
    }

    fn resume(&mut self, t: f64, y: &[f64]) -> Result<bool, Error> {
        check_length("length of y", y.len(), self.y().len())?;
        check_start_time("t", t)?;
        check_finite("y", y)?;
        check_state(&self.signs, "y", y)?;
        let Some(reset) = self.memory.functions.reset else { return Ok(false) };
        self.y.as_mut_slice().copy_from_slice(y);
        let elapsed = self.clock().elapsed(t);
        // SAFETY: memory and vector are alive; the integrator copies the vector.
        self.host.call(reset, |reset| unsafe { reset(self.memory.raw, elapsed, self.y.raw()) })?;
        (self.t, self.elapsed) = (t, elapsed);
        (self.has_step, self.failed_within) = (false, false);
        let step_end = &mut self.host.get_mut().step_end;
        *step_end = step_end.and(Some(elapsed));
        self.stop_time.forget();
        self.roots_found.fill(0);
        Ok(true)
    }

    fn roots_found(&self) -> &[i32] {
        &self.roots_found
    }

    fn statistics(&self) -> Statistics {
        self.all_statistics()
    }

    fn steps(&self) -> u64 {
        self.step_statistics().steps
    }

    fn notice(&self) -> Option<String> {
        let Statistics { steps, error_test_failures: failures, .. } = self.step_statistics();
        let is_explicit = matches!(self.stages, [Some(_), None]);
        (is_explicit && steps >= MANY && failures as f64 > UNSTABLE * steps as f64).then(|| {
            format!(
                "{failures} steps failed the error test besides the {steps} that were taken, as where stability, not accuracy, limits the steps \
                 of an explicit method: use an implicit one"
            )
        })
    }

    fn system(&self) -> &S {
        &self.host.get().system
    }

    fn system_mut(&mut self) -> &mut S {
        &mut self.host.get_mut().system
    }

    fn into_system(self) -> S {
        drop(self.memory);
        self.host.into_system()
    }
}

impl<K, S> Session<K, S> {
    /// Integrates to the time `t` (`CV_NORMAL`) or by one step (`CV_ONE_STEP`).
    fn integrate(&mut self, t: f64, task: i32) -> Result<Reached, Error> {
        check_time("target time", t)?;
        if t == self.t {
            return Ok(Reached::Time);
        }
        let (start, target) = (self.t, self.clock().elapsed(t));
        let known = self.step_statistics();
        self.check_target(&known, (t, target), task)?;
        let (functions, mut steps) = (self.memory.functions, known.steps);
        if self.history_lost {
            self.start_c_again(self.elapsed)?;
            (self.history_lost, steps) = (false, 0);
        }
        if let Some(time) = self.stop_time.take_update(self.elapsed, target) {
            // SAFETY: the value is a plain number.
            unsafe { self.set(functions.set_stop_time, time)? };
        }
        let far = if steps == 0 { apart(self.elapsed, target) } else { target };
        // C would refuse a target so close: single steps with a stop time there
        let stops = task == ffi::CV_NORMAL && far != target;
        let mut stop = self.stop_time.time();
        if stops {
            let ends = stop.filter(|stop| (target - stop) * (far - self.elapsed) >= 0.0);
            stop = ends.or(Some(target));
            // SAFETY: the value is a plain number.
            unsafe { self.set(functions.set_stop_time, ends.unwrap_or(target))? };
        }
        // nor does C estimate a first step if it has to stop so soon: it is the whole way to the stop
        let whole = stop.filter(|stop| steps == 0 && apart(self.elapsed, *stop) != *stop);
        let whole = whole.filter(|_| self.initial_step.is_none());
        if let Some(stop) = whole {
            self.set_first_step(stop - self.elapsed)?;
        }
        let (name, solve) = self.solve;
        // C writes to other vectors than the present state, which is kept if C fails to give another
        let (memory, y, before) = (self.memory.raw, self.scratch.raw(), self.elapsed);
        let yp = self.slope_scratch.as_ref().map_or(ptr::null_mut(), Vector::raw);
        self.scratch.as_mut_slice().iter_mut().take(1).for_each(|y| *y = f64::NAN);
        self.host.get_mut().troubles.begin(self.elapsed);
        self.failed_within = false;
        let (single, mut taken) = (if stops { ffi::CV_ONE_STEP } else { task }, 0);
        let (mut shortened, mut is_shortened) = (0, false);
        let (mut code, falls_short, last_step) = loop {
            let most = STRETCH.min(u64::from(self.max_steps) - taken);
            // SAFETY: the value is a plain number.
            unsafe { self.set(functions.set_max_steps, most as i64)? };
            // SAFETY: memory, vectors and everything registered with the memory are alive; `&mut self`
            // keeps others away while callbacks use the host.
            let code = unsafe { solve(memory, far, &raw mut self.elapsed, y, yp, single) };
            let now = self.step_statistics();
            self.progress.note(now.steps, now.current_time);
            taken = now.steps.saturating_sub(steps);
            // each attempt covers six decades; with a lower bound of the step size there are no more attempts
            // than this
            if shortened < 5 && self.shortens_first_step(code, before, target)? {
                shortened += 1;
                self.host.get_mut().troubles.clear();
                continue;
            }
            if self.shortens_explicit_step(code, stop)? {
                is_shortened = true;
                continue;
            }
            // steps between the same two numbers are one step
            let is_short = single != task
                || task == ffi::CV_ONE_STEP
                    && !self.clock().passes(start, self.elapsed, now.last_step);
            let falls_short = code == DONE && is_short;
            let goes_on = code == ffi::CV_TOO_MUCH_WORK || falls_short;
            if !goes_on || self.progress.stands || taken >= u64::from(self.max_steps) {
                break (code, falls_short, now.last_step);
            }
        };
        if code == DONE && task == ffi::CV_ONE_STEP && !falls_short {
            let (_, end) = self.clock().last_within(self.elapsed, last_step);
            if end != self.elapsed {
                // SAFETY: as above; C interpolates within the step that it has made.
                code = unsafe { solve(memory, end, &raw mut self.elapsed, y, yp, ffi::CV_NORMAL) };
            }
        }
        if shortened > 0 || whole.is_some() {
            self.set_first_step(0.0)?;
        }
        if is_shortened {
            self.set_first_step(self.initial_step.unwrap_or(0.0))?;
        }
        if stops {
            // C has forgotten the stop time of the caller
            self.stop_time.keep(self.stop_time.time());
        }
        self.has_step = code >= 0 || self.step_statistics().steps > 0;
        if code < 0 {
            self.forget_factors();
        }
        if code >= 0 || self.has_step && self.is_auxiliary_finite() {
            mem::swap(&mut self.y, &mut self.scratch);
            mem::swap(&mut self.yp, &mut self.slope_scratch);
        } else if !self.has_step {
            // IDA now has y' times the step size in place of y'
            self.history_lost = self.yp.is_some();
        } else if self.host.get().step_end.is_none() && !self.has_finite_history() {
            self.elapsed = before;
            (self.has_step, self.failed_within, self.history_lost) = (false, true, true);
        }
        if let Some(end) = self.host.get().step_end.filter(|_| code < 0) {
            // the time of `y`; C has that of a stage, and would interpolate as if the step ended there
            self.elapsed = end;
            (self.has_step, self.failed_within) = (false, true);
        }
        let stop = self.stop_time.time().map(|stop| (stop, self.stop_time.given()));
        let known = [Some((before, start)), stop, Some((target, t))].into_iter().flatten();
        // numbers that users gave come back as they were
        let known = known.filter(|(elapsed, _)| *elapsed == self.elapsed).map(|(_, t)| t).next();
        self.t = known.unwrap_or_else(|| self.clock().time(self.elapsed));
        let read = match self.has_step {
            true => self.read_quadratures().and_then(|()| self.read_sensitivities()),
            false => Ok(()),
        };
        self.host.get_mut().troubles.resume_panic();
        if code >= 0 {
            read?;
            if !self.signs.is_empty() {
                self.read_corrected()?;
            }
        }
        match code {
            ffi::CV_ROOT_RETURN => {
                let roots = self.roots_found.as_mut_ptr();
                // SAFETY: there are as many places as root functions.
                unsafe { self.set(functions.get_root_info, roots)? };
                Ok(Reached::Root)
            }
            // a step that ended before the target was the last one allowed
            code if code >= 0 && (self.progress.stands || falls_short) => {
                Err(self.stopped(ffi::CV_TOO_MUCH_WORK, t))
            }
            code if code >= 0 => {
                let stopped = self.stop_time.time() == Some(self.elapsed);
                if stopped {
                    self.host.get_mut().clock.go_on();
                    self.stop_time.keep(None);
                }
                Ok(if stopped { Reached::StopTime } else { Reached::Time })
            }
            code if functions.refusals.contains(&code) && !self.host.get().troubles.is_fatal() => {
                self.host.accept(name, code).map(|()| Reached::Time)
            }
            code => Err(self.stopped(code, t)),
        }
    }

    /// Refuses targets that C would refuse less clearly: `solve_to` can go back within the last
    /// step, `step` cannot.
    fn check_target(
        &self,
        statistics: &Statistics,
        (t, target): (f64, f64),
        task: i32,
    ) -> Result<(), Error> {
        let earliest = match task {
            ffi::CV_ONE_STEP => self.elapsed,
            _ => statistics.current_time - statistics.last_step,
        };
        if statistics.steps == 0 && (target - self.elapsed).abs() < SHORTEST {
            let help = format!("it lies at least {SHORTEST:e} from the start, {:?}", self.t);
            return Err(Error::input("target time", t, help));
        }
        if (target - earliest) * statistics.last_step < 0.0 {
            let earliest = self.clock().time(earliest);
            let help = format!("it lies behind {earliest:?}; reinit turns the direction of time");
            return Err(Error::input("target time", t, help));
        }
        Ok(())
    }

    /// Calls the C function `get_dky`, called `name`, that interpolates within the last step.
    pub(super) fn look_back(
        &mut self,
        name: &'static str,
        t: f64,
        derivative: u32,
        get_dky: impl FnOnce(*mut c_void, f64, i32) -> i32,
    ) -> Result<(), Error> {
        let order = derivative.min(i32::MAX as u32) as i32;
        let functions = self.memory.functions;
        self.host.get_mut().troubles.begin(self.elapsed);
        let code = get_dky(self.memory.raw, self.within_last_step(t), order);
        self.host.get_mut().troubles.resume_panic();
        if code == functions.bad_time {
            let (start, end) = self.last_step();
            return Err(Error::input("t", t, format!("the last step is [{start}, {end}]")));
        }
        if code == functions.bad_derivative {
            let help = format!("the last step was of order {}", self.last_order());
            return Err(Error::input("derivative", derivative, help));
        }
        if code == ffi::CV_RHSFUNC_FAIL {
            return Err(self.stopped(code, t));
        }
        self.host.accept(name, code)
    }

    /// The clock of C.
    pub(super) fn clock(&self) -> Clock {
        self.host.get().clock
    }

    /// Start and end of the last step, as C has them.
    fn reach_of_last_step(&self) -> (f64, f64) {
        let statistics = self.step_statistics();
        (statistics.current_time - statistics.last_step, statistics.current_time)
    }

    /// Time `t` of the last step, as C has it.
    fn within_last_step(&self, t: f64) -> f64 {
        if t == self.t {
            return self.elapsed;
        }
        self.clock().within(t, self.reach_of_last_step())
    }

    /// Checks that only the present values are requested, where there is no step to interpolate in.
    pub(super) fn check_start_only(&self, t: f64, derivative: u32) -> Result<(), Error> {
        if t != self.t {
            let help =
                format!("without a step to look into only the state at {:?} is known", self.t);
            return Err(Error::input("t", t, help));
        }
        if derivative > 0 {
            let help = "it takes a step: without one only the state itself is known";
            return Err(Error::input("derivative", derivative, help));
        }
        Ok(())
    }
}

/// `target`, or, if C would take it for `t`, a time beyond it that C distinguishes from `t`; all are times of C. (C ignores
/// differences of 100 units of rounding when it checks for a stop time, and somewhat larger ones in its first
/// step.)
pub(super) fn apart(t: f64, target: f64) -> f64 {
    let size = t.abs().max(target.abs());
    let (distance, least) = (target - t, (256.0 * f64::EPSILON * size).max(1e-97));
    if distance.abs() >= least { target } else { t + (1e6 * least).copysign(distance) }
}
