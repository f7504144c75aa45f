//! Which method integrates a phase, and why.

use super::{Method, Solver};
use crate::system::{Spectrum, System};

/// How a phase is integrated from now on.
pub(super) struct Plan {
    /// As asked for, with a method of its own in place of [`Method::Auto`].
    pub(super) solver: Solver,
    /// Why this method, if it was chosen.
    pub(super) reason: Option<String>,
}

impl Plan {
    /// The plan for a phase whose equations are `system`, from time `t` and `state` = (u, v, ...).
    pub(super) fn new(asked: &Solver, system: &mut System, t: f64, state: &[f64]) -> Self {
        if asked.method != Method::Auto {
            return Self { solver: asked.clone(), reason: None };
        }
        let n = system.dofs();
        let spectrum = system.spectrum(t, &state[..n], &state[n..2 * n]);
        let (method, max_order, reason) = choose(&spectrum);
        let max_order = asked.max_order.or(max_order);
        Self { solver: Solver { method, max_order, ..asked.clone() }, reason: Some(reason) }
    }

    /// Whether there is another method to go on with if this one creates energy.
    pub(super) fn is_on_trial(&self) -> bool {
        self.reason.is_some() && !self.is_last_resort()
    }

    /// What to go on with when this plan has gone wrong by `trouble`: nothing if the method was
    /// asked for, or is the last resort already.
    pub(super) fn instead(&self, trouble: &str) -> Option<Self> {
        let chosen = self.reason.as_ref().filter(|_| !self.is_last_resort())?;
        let reason = format!("{chosen}; then cvode-bdf of order 2, as {trouble}");
        let solver = Solver { method: Method::CvodeBdf, max_order: Some(2), ..self.solver.clone() };
        Some(Self { solver, reason: Some(reason) })
    }

    /// Whether this is what other plans end in: a method that damps all vibrations.
    fn is_last_resort(&self) -> bool {
        self.solver.method == Method::CvodeBdf && self.solver.max_order == Some(2)
    }
}

fn choose(spectrum: &Spectrum) -> (Method, Option<u32>, String) {
    let ratio = spectrum.lowest_damping_ratio;
    let order = if ratio < 0.05 { 2 } else { 5 };
    (Method::CvodeBdf, Some(order), format!("damping ratio {ratio:.1e}"))
}
