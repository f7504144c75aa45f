//! The longest stable step, followed along the motion.
//!
//! With consistent inertia each step needs a solve with M, and steps are half as long.

use crate::base::vector::dot;
use crate::integrators::ode::{EnergyBalance, Rates, SecondOrder};

/// Used fraction of the longest stable step: rates may grow until the next bound on them.
const SAFETY: f64 = 0.98;
/// Number of steps from one bound on the rates to the next: at first, and at most.
const FIRST_INTERVAL: usize = 64;
const LONGEST_INTERVAL: usize = 4096;
/// Relative change of the limit from one bound to the next above which bounds become more frequent, and below
/// which they become less frequent.
const MUCH: f64 = 0.04;
const LITTLE: f64 = 0.01;
/// Number of steps between two checks of the energy, the part of it whose apparent creation shortens the
/// steps, and the factor by which it does.
const LOOK: usize = 128;
const CREATED: f64 = 0.05;
const SHORTENED: f64 = 0.7;

/// Longest step (s) that is stable: 2/(decay + sqrt(decay^2 + frequency^2)).
pub fn longest_step(rates: &Rates) -> f64 {
    let Rates { frequency, decay } = *rates;
    2.0 / (decay + decay.hypot(frequency))
}

#[derive(Debug)]
pub(super) struct Stability {
    rates: Rates,
    /// Part of the bound in use.
    safety: f64,
    interval: usize,
    /// Steps since the last bound, and since the last check of the energy.
    since: usize,
    unseen: usize,
    /// Lowest energy balance of the scheme so far, and the largest scale of it.
    lowest_energy: f64,
    energy_scale: f64,
    notice: Option<String>,
}

impl Stability {
    pub(super) fn new() -> Self {
        Self {
            rates: Rates { frequency: 0.0, decay: 0.0 },
            safety: SAFETY,
            interval: FIRST_INTERVAL,
            since: 0,
            unseen: 0,
            lowest_energy: f64::INFINITY,
            energy_scale: 0.0,
            notice: None,
        }
    }

    /// Bounds the longest stable step at the state `y`; infinite if nothing vibrates or decays.
    pub(super) fn limit(&mut self, system: &mut impl SecondOrder, t: f64, y: &[f64]) -> f64 {
        let (u, v, _) = split(system, y);
        self.rates = system.rates(t, u, v);
        self.since = 0;
        self.safety * longest_step(&self.rates)
    }

    /// No more bounds, no more checks of the energy.
    #[cfg(test)]
    pub(super) fn freeze(&mut self) {
        (self.interval, self.energy_scale) = (usize::MAX, f64::INFINITY);
    }

    /// Called before each step; from time to time returns a new limit.
    pub(super) fn update(
        &mut self,
        system: &mut impl SecondOrder,
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
        let before = longest_step(&self.rates);
        let limit = self.limit(system, t, y);
        let change = (longest_step(&self.rates) / before - 1.0).abs();
        if change > MUCH {
            self.interval = (self.interval / 4).max(FIRST_INTERVAL);
        } else if change < LITTLE {
            self.interval = (2 * self.interval).min(LONGEST_INTERVAL);
        }
        Some(limit)
    }

    /// Whether the energy, kinetic + potential + dissipated - supplied, has grown. It is taken as in the
    /// scheme, minus h^2 a.M a/8, which makes the sum constant for linear forces.
    fn creates_energy(
        &mut self,
        system: &impl SecondOrder,
        t: f64,
        y: &[f64],
        force: &[f64],
        acceleration: &[f64],
        step: f64,
    ) -> bool {
        self.unseen = 0;
        let (u, v, integrals) = split(system, y);
        let Some(EnergyBalance { energy, scale }) = system.balance(t, u, v, integrals) else {
            return false;
        };
        let energy = energy - step * step / 8.0 * dot(force, acceleration);
        self.energy_scale = self.energy_scale.max(scale);
        let creates = energy > self.lowest_energy + CREATED * self.energy_scale;
        self.lowest_energy = if creates { energy } else { self.lowest_energy.min(energy) };
        creates
    }

    /// The notice: that energy grew, or that viscosity bounds the step.
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

/// u, v and the integrals of a state.
fn split<'y>(system: &impl SecondOrder, y: &'y [f64]) -> (&'y [f64], &'y [f64], &'y [f64]) {
    let n = (y.len() - system.integrals()) / 2;
    (&y[..n], &y[n..2 * n], &y[2 * n..])
}
