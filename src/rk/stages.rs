//! The inside of a step: first slope, initial step size, stages, acceptance.

use std::mem::swap;

use super::dormand_prince::{DormandPrince, ORDER};
use super::tableau::{A2, A3, A4, A5, A6, B, C, E, advance, norm};
use crate::integrate::{Callback, Cause, Error, IntegrationError};
use crate::ode::{Failure, Ode};

impl<S: Ode> DormandPrince<S> {
    /// Evaluates f(t, y), where no smaller step can help.
    pub(super) fn evaluate_slope(&mut self) -> Result<(), Error> {
        let t = self.t;
        self.statistics.evaluations += 1;
        let outcome = self.system.rhs(t, &self.y, &mut self.k[0]);
        let setback = classify(outcome, t, [t, 0.0])?;
        if let Some(cause) = setback.or_else(|| not_finite(t, &self.k[0])) {
            return Err(stopped(cause, [t, 0.0]).into());
        }
        self.slope_known = true;
        Ok(())
    }

    /// Initial step size after HNW I, section II.4, "Starting step size".
    pub(super) fn estimate_initial_step(&mut self) -> Result<f64, Error> {
        let max_step = self.max_step();
        let [slope, trial_slope, ..] = &mut self.k;
        let state_size = norm([1.0], [&self.y], &self.weight);
        let slope_size = norm([1.0], [slope], &self.weight);
        let mut h = if state_size < 1e-5 || slope_size < 1e-5 {
            1e-6
        } else {
            0.01 * state_size / slope_size
        };
        h = h.min(max_step);
        let mut t_trial = self.t + h;
        if let Some(stop) = self.stop_time.filter(|stop| t_trial > *stop) {
            (t_trial, h) = (stop, stop - self.t);
        }
        advance(&mut self.argument, &self.y, h, [1.0], [slope]);
        self.statistics.evaluations += 1;
        let outcome = self.system.rhs(t_trial, &self.argument, trial_slope);
        if classify(outcome, t_trial, [self.t, h])?.is_some() {
            return Ok(h);
        }
        let curvature = norm([1.0, -1.0], [trial_slope, slope], &self.weight) / h;
        // y' changes on the time scale T = |y'| / |y''|, so that the error of a step of order 5 is
        // about (h/T)^5 |y'| T; the book has T = 1, which is only right for some unit of time.
        let time_scale = slope_size / curvature;
        let from_error = time_scale * (0.01 / (slope_size * time_scale)).powf(0.2);
        // Not a number or zero when the slopes vanish or are not finite: h will do.
        Ok(if from_error > 0.0 { from_error.min(100.0 * h) } else { h })
    }

    /// Evaluates stages 2 to 7 of a step to `t_new`; `y_old` then holds the new solution.
    ///
    /// The inner result is the norm of the error estimate, at most 1 when the step will do, or why
    /// there is none.
    pub(super) fn try_step(&mut self, t_new: f64, h: f64) -> Result<Result<f64, Cause>, Error> {
        let (y, g, y_new) = (&self.y, &mut self.argument, &mut self.y_old);
        let [k1, k2, k3, k4, k5, k6, k7] = &mut self.k;
        let (t, statistics, system) = (self.t, &mut self.statistics, &mut self.system);
        let mut rhs = |at: f64, y: &[f64], k: &mut [f64]| {
            statistics.evaluations += 1;
            classify(system.rhs(at, y, k), at, [t, h])
        };
        macro_rules! stage {
            ($k:ident at $t:expr, $y:ident from $a:ident of $($other:ident),+) => {
                advance($y, y, h, $a, [$(&*$other),+]);
                if let Some(setback) = rhs($t, $y, $k)? {
                    return Ok(Err(setback));
                }
            };
        }
        stage!(k2 at t + C[1] * h, g from A2 of k1);
        stage!(k3 at t + C[2] * h, g from A3 of k1, k2);
        stage!(k4 at t + C[3] * h, g from A4 of k1, k2, k3);
        stage!(k5 at t + C[4] * h, g from A5 of k1, k2, k3, k4);
        stage!(k6 at t_new, g from A6 of k1, k2, k3, k4, k5);
        stage!(k7 at t_new, y_new from B of k1, k3, k4, k5, k6);
        let error = norm(E.map(|e| h * e), [k1, k3, k4, k5, k6, k7], &self.weight);
        if error.is_finite() {
            return Ok(Ok(error));
        }
        // Look for the first culprit only now that there is one.
        let found = self.k.iter().zip(C).find_map(|(k, c)| not_finite(t + c * h, k));
        // Finite stages whose combination overflows: the step is far too long.
        Ok(found.map_or(Ok(f64::MAX), Err))
    }

    /// Estimate of the largest |lambda| of df/dy from the two stages at the end of the trial step:
    /// |k7 - k6| / |g7 - g6| (HNW II, section IV.2, "Automatic stiffness detection"), in the
    /// weighted norm and so independent of the units of the components.
    fn rate(&self) -> f64 {
        let [.., k6, k7] = &self.k;
        let distance = norm([1.0, -1.0], [&self.y_old, &self.argument], &self.weight);
        if distance > 0.0 { norm([1.0, -1.0], [k7, k6], &self.weight) / distance } else { 0.0 }
    }

    /// Error weights at the start of the next step.
    pub(super) fn update_weight(&mut self) {
        self.options.tolerances.weigh(&self.y, &mut self.weight);
    }

    pub(super) fn accept(&mut self, t_new: f64, h: f64) {
        let rate = self.rate();
        self.monitor.accepted(t_new, h, rate);
        self.statistics.steps += 1;
        self.statistics.last_step = h;
        (self.t_old, self.t) = (self.t, t_new);
        swap(&mut self.y, &mut self.y_old);
        self.update_weight();
        let [first, .., last] = &mut self.k;
        swap(first, last);
    }
}

/// Separates what a smaller step may heal from what ends the integration; `place` is the time reached and
/// the step.
fn classify(outcome: Result<(), Failure>, t: f64, place: [f64; 2]) -> Result<Option<Cause>, Error> {
    let callback = Callback::Rhs;
    match outcome {
        Ok(()) => Ok(None),
        Err(Failure::Recoverable(message)) => Ok(Some(Cause::Rejected { callback, t, message })),
        Err(Failure::Fatal(source)) => {
            let stopped = stopped(Cause::Fatal(callback), place);
            Err(IntegrationError { source: Some(source), ..stopped }.into())
        }
    }
}

fn not_finite(t: f64, slope: &[f64]) -> Option<Cause> {
    let component = slope.iter().position(|value| !value.is_finite())?;
    Some(Cause::NotFinite { callback: Callback::Rhs, t, component, value: slope[component] })
}

/// An integration that stopped at a time, with a step.
pub(super) fn stopped(cause: Cause, [t, step]: [f64; 2]) -> IntegrationError {
    IntegrationError {
        integrator: "Dormand-Prince 5(4)",
        cause,
        t,
        step,
        order: ORDER,
        message: String::new(),
        source: None,
    }
}
