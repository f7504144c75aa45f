//! The longest stable step, followed along the motion.

use crate::system::{Rates, RatesBound, System};
use crate::vector::dot;

/// Part of the longest stable step that is used: rates may grow until they are bounded anew.
const SAFETY: f64 = 0.98;
/// Steps from one bound on the rates to the next: at first, and at most.
const FIRST_INTERVAL: usize = 64;
const LONGEST_INTERVAL: usize = 4096;
/// Change of the limit from one bound to the next that calls for more of them, and one that allows
/// fewer.
const MUCH: f64 = 0.04;
const LITTLE: f64 = 0.01;
/// Steps between two looks at the energy, the part of it that must not seem to be created, and what
/// becomes of the step if it does.
const LOOK: usize = 128;
const CREATED: f64 = 0.05;
const SHORTENED: f64 = 0.7;

pub(super) struct Stability {
    bound: RatesBound,
    rates: Rates,
    /// Part of the bound in use.
    safety: f64,
    interval: usize,
    /// Steps since the last bound, and since the last look at the energy.
    since: usize,
    unseen: usize,
    energy: Balance,
    notice: Option<String>,
}

/// The energy balance of the scheme (J).
struct Balance {
    lowest: f64,
    scale: f64,
}

impl Rates {
    /// Longest stable step (s): see the stability of [`central_difference`](super).
    pub(crate) fn longest_step(&self) -> f64 {
        let Self { frequency, decay } = *self;
        2.0 / (decay + decay.hypot(frequency))
    }
}

impl Stability {
    pub(super) fn new(system: &mut System) -> Self {
        Self {
            bound: RatesBound::new(system),
            rates: Rates { frequency: 0.0, decay: 0.0 },
            safety: SAFETY,
            interval: FIRST_INTERVAL,
            since: 0,
            unseen: 0,
            energy: Balance { lowest: f64::INFINITY, scale: 0.0 },
            notice: None,
        }
    }

    /// Bounds the longest stable step at the state `y`; infinite if nothing vibrates.
    pub(super) fn limit(&mut self, system: &mut System, t: f64, y: &[f64]) -> f64 {
        let n = system.dofs();
        self.rates = system.rates(t, &y[..n], &y[n..2 * n], &mut self.bound);
        self.since = 0;
        self.safety * self.rates.longest_step()
    }

    /// No more bounds, no more judgement on the energy.
    #[cfg(test)]
    pub(super) fn freeze(&mut self) {
        (self.interval, self.energy.scale) = (usize::MAX, f64::INFINITY);
    }

    /// Called at each step; tells a new limit from time to time.
    pub(super) fn watch(
        &mut self,
        system: &mut System,
        t: f64,
        y: &[f64],
        force: &[f64],
        acceleration: &[f64],
        step: f64,
    ) -> Option<f64> {
        self.since += 1;
        self.unseen += 1;
        let creates =
            self.unseen > LOOK && self.creates_energy(system, t, y, force, acceleration, step);
        if creates {
            self.safety *= SHORTENED;
            self.notice = Some(format!(
                "the energy grew by itself until t = {t} s: steps were shortened to {:.0} % of what \
                 the highest frequency allows",
                100.0 * self.safety
            ));
        }
        if !creates && self.since < self.interval {
            return None;
        }
        let before = self.rates.longest_step();
        let limit = self.limit(system, t, y);
        let change = (self.rates.longest_step() / before - 1.0).abs();
        if change > MUCH {
            self.interval = (self.interval / 4).max(FIRST_INTERVAL);
        } else if change < LITTLE {
            self.interval = (2 * self.interval).min(LONGEST_INTERVAL);
        }
        Some(limit)
    }

    /// Whether kinetic + potential + dissipated - supplied has grown, in the sense of the scheme: less
    /// h^2 a.M a/8, which makes the sum constant for linear forces.
    fn creates_energy(
        &mut self,
        system: &System,
        t: f64,
        y: &[f64],
        force: &[f64],
        acceleration: &[f64],
        step: f64,
    ) -> bool {
        self.unseen = 0;
        let n = system.dofs();
        let mut energy = system.energy(t, &y[..n], &y[n..2 * n]);
        (energy.dissipated, energy.supplied) = (y[2 * n], y[2 * n + 1]);
        let balance = energy.balance() - step * step / 8.0 * dot(force, acceleration);
        let Balance { lowest, scale } = &mut self.energy;
        *scale = scale.max(energy.size());
        let creates = balance > *lowest + CREATED * *scale;
        *lowest = if creates { balance } else { lowest.min(balance) };
        creates
    }

    /// What there is to say: that energy grew, or that viscosity rules.
    pub(super) fn notice(&self) -> Option<String> {
        let Rates { frequency, decay } = self.rates;
        let viscous = || {
            format!(
                "viscosity bounds the step: its rate is {decay:.3e} 1/s, the highest frequency \
                 {frequency:.3e} rad/s; use an implicit method"
            )
        };
        self.notice.clone().or_else(|| (decay > frequency).then(viscous))
    }
}
