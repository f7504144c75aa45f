//! The method: its data in addition to the state, and the solution within the last step.

use super::control::{Controller, StabilityLimit, StabilityMonitor};
use super::tableau::{
    A2, A3, A4, A5, A6, B, C, E, STAGES, advance, dense_derivative_weights, dense_weights, norm,
};
use crate::integrators::common::{
    Callback, Cause, Error, ExplicitOptions, March, OneStep, StepMethod, not_finite,
};
use crate::integrators::ode::{Ode, call};

/// Integrates y' = f(t, y) forward in time with the Dormand-Prince pair of order 5(4).
///
/// Steps of automatic size keep the local error within tolerance, with six evaluations of the right-hand side
/// each. Solutions between the ends of a step come from a continuous extension of order 4, so output times do
/// not change the steps; root functions are followed on it, as in CVODE. Its derivative is of order 3, and
/// equals f(t, y) at both ends of the step (L. F. Shampine, Math. Comp. 46 (1986) 135-150; HNW I, section
/// II.6). Stepping allocates nothing.
pub type DormandPrince<S> = OneStep<S, Pair>;

/// Dormand and Prince's pair at work.
#[derive(Debug)]
pub struct Pair {
    /// Stages 2 to 6; the first and the last are f at both ends of the step.
    k: [Vec<f64>; STAGES - 2],
    controller: Controller,
    monitor: StabilityMonitor,
}

impl<S: Ode> DormandPrince<S> {
    /// Starts at y(t) = `y`; the length of `y` is the number n of equations.
    ///
    /// The right-hand side is first called by the first step.
    ///
    /// # Errors
    /// [`Error::Input`] names the option or component that cannot be used.
    pub fn new(system: S, t: f64, y: &[f64], options: &ExplicitOptions) -> Result<Self, Error> {
        let pair = Pair {
            k: std::array::from_fn(|_| vec![0.0; y.len()]),
            controller: Controller::new(),
            monitor: StabilityMonitor::default(),
        };
        Self::start(system, t, y, options, ("Dormand-Prince 5(4)", 5, pair))
    }

    /// Whether stability, not accuracy, limits the steps: set once such steps are frequent.
    pub fn stability_limit(&self) -> Option<StabilityLimit> {
        self.method.monitor.limit()
    }
}

impl StepMethod for Pair {
    fn restart(&mut self) {
        (self.controller, self.monitor) = (Controller::new(), StabilityMonitor::default());
    }

    /// It keeps nothing that depends on the system.
    fn forget(&mut self) {}

    fn norm(&self, x: &[f64], weight: &[f64]) -> f64 {
        norm([1.0], [x], weight)
    }

    fn try_step<S: Ode>(
        &mut self,
        march: &mut March<S>,
        t_new: f64,
        h: f64,
    ) -> Result<Result<f64, Cause>, Error> {
        let ([k2, k3, k4, k5, k6], t, clock) = (&mut self.k, march.t, march.clock);
        macro_rules! stage {
            ($k:expr, at $t:expr, $y:ident from $a:ident of $($other:expr),+) => {
                advance(&mut march.$y, &march.y, h, $a, [$(&*$other),+]);
                march.statistics.evaluations += 1;
                let outcome = call::rhs(&mut march.system, clock.time($t), &march.$y, $k);
                if let Some(setback) = march.classify(outcome, Callback::Rhs, $t, h)? {
                    return Ok(Err(setback));
                }
            };
        }
        stage!(k2, at t + C[1] * h, argument from A2 of march.slope);
        stage!(k3, at t + C[2] * h, argument from A3 of march.slope, k2);
        stage!(k4, at t + C[3] * h, argument from A4 of march.slope, k2, k3);
        stage!(k5, at t + C[4] * h, argument from A5 of march.slope, k2, k3, k4);
        stage!(k6, at t_new, argument from A6 of march.slope, k2, k3, k4, k5);
        stage!(&mut march.slope_old, at t_new, y_old from B of march.slope, k3, k4, k5, k6);
        let [k1, k7] = [&march.slope, &march.slope_old];
        let error = norm(E.map(|e| h * e), [k1, k3, k4, k5, k6, k7], &march.weight);
        if error.is_finite() {
            return Ok(Ok(error));
        }
        // Look for the first culprit only now that there is one.
        let all = [k1, k2, k3, k4, k5, k6, k7];
        let found = all.into_iter().zip(C).find_map(|(k, c)| not_finite(clock.time(t + c * h), k));
        // Finite stages whose combination overflows: the step is far too long.
        Ok(found.map_or(Ok(f64::MAX), Err))
    }

    fn accept<S: Ode>(&mut self, march: &March<S>, t_new: f64, h: f64, error: f64) -> f64 {
        self.monitor.accepted(march.clock.time(t_new), h, self.rate(march));
        self.controller.accept(h, error)
    }

    fn reject(&mut self, h: f64, error: f64) -> f64 {
        self.controller.reject(h, error)
    }

    fn refuse(&mut self, h: f64) -> f64 {
        self.controller.refuse(h)
    }

    fn interpolate<S: Ode>(&self, march: &March<S>, t: f64, y: &mut [f64]) {
        let h = march.t - march.t_old;
        let weights = dense_weights((t - march.t_old) / h);
        advance(y, &march.y_old, h, weights, self.last_stages(march));
    }

    fn interpolate_slope<S: Ode>(&self, march: &March<S>, t: f64, ydot: &mut [f64]) {
        let weights = dense_derivative_weights((t - march.t_old) / (march.t - march.t_old));
        let k = self.last_stages(march);
        for (i, slope) in ydot.iter_mut().enumerate() {
            *slope = weights.iter().zip(k).map(|(weight, k)| weight * k[i]).sum();
        }
    }

    fn interpolant_degree(&self) -> u32 {
        4
    }

    fn notice(&self) -> Option<String> {
        self.monitor.limit().map(|limit| limit.to_string())
    }

    fn bounding_rate(&self) -> Option<f64> {
        self.monitor.limit().map(|limit| limit.rate)
    }
}

impl Pair {
    /// Estimate of the largest |lambda| of df/dy from the two stages at the end of the trial step:
    /// |k7 - k6| / |g7 - g6| (HNW II, section IV.2, "Automatic stiffness detection"), in the
    /// weighted norm and so independent of the units of the components.
    fn rate<S: Ode>(&self, march: &March<S>) -> f64 {
        let March { y_old: g7, slope_old: k7, argument: g6, weight, .. } = march;
        let [.., k6] = &self.k;
        let distance = norm([1.0, -1.0], [g7, g6], weight);
        if distance > 0.0 { norm([1.0, -1.0], [k7, k6], weight) / distance } else { 0.0 }
    }

    /// Stages 1, 3, 4, 5, 6, 7 of the last accepted step.
    fn last_stages<'a, S: Ode>(&'a self, march: &'a March<S>) -> [&'a [f64]; 6] {
        let [_, k3, k4, k5, k6] = &self.k;
        [&march.slope_old, k3, k4, k5, k6, &march.slope]
    }
}
