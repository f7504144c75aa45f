//! What follows from a state (u, v, energies, ...) of the run: energies, samples, projected velocities.

use crate::ode::Failure;
use crate::scene::Phase;
use crate::settings::{Method, Settings};
use crate::system::{Energy, System};
use crate::trajectory::Sample;

/// The sample of `state` = (u, v, energies, ...) at `time`.
pub(super) fn sample(
    phase: usize,
    system: &mut System,
    time: f64,
    state: &[f64],
) -> Result<Sample, Failure> {
    let n = system.dofs();
    let (u, v) = (&state[..n], &state[n..2 * n]);
    let multipliers = system.multipliers(time, u, v)?.to_vec();
    let energy = energy(system, time, state);
    let constraint_drift = system.drift(time, u);
    Ok(Sample { time, phase, u: u.to_vec(), v: v.to_vec(), multipliers, energy, constraint_drift })
}

/// Energies of `state` = (u, v, energies, ...) at `time`.
pub(super) fn energy(system: &System, time: f64, state: &[f64]) -> Energy {
    let n = system.dofs();
    let (u, v) = (&state[..n], &state[n..2 * n]);
    let (dissipated, supplied) = (state[2 * n], state[2 * n + 1]);
    Energy { dissipated, supplied, ..system.energy(time, u, v) }
}

/// Projects the velocities of `state` on those that the constraints allow, if the phase asks for that or
/// the method has an equation for velocities, which allows no others. What that takes from the kinetic
/// energy, or gives to it, is supplied by the constraints.
pub(super) fn project(
    solver: &Settings,
    phase: &Phase,
    system: &mut System,
    time: f64,
    state: &mut [f64],
) {
    if !phase.projects_velocity && solver.method != Method::IdaIndexTwo {
        return;
    }
    let n = system.dofs();
    let (u, rest) = state.split_at_mut(n);
    let (v, energies) = rest.split_at_mut(n);
    let before = system.energy(time, u, v).kinetic;
    system.project(time, v);
    energies[1] += system.energy(time, u, v).kinetic - before;
}
