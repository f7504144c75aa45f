//! Extra unknowns of forces, beside displacements and velocities.

use super::nodal::NodalForces;
use crate::base::sparse::BlockMatrix;
use crate::integrators::ode::Failure;

/// Extra unknowns of a force: masses of gas and liquid per chamber, actuator lag states, pipe flow rates.
///
/// Layout: masses m (kg) of chambers of volumes V(u) (m^3), with forces p(m, V) dV/du and rates q(t, m, V); then lag states a of
/// actuators, with forces f(u, v, a); then flow rates of pipes (m^3/s), without forces. All of them have rates.
#[doc(hidden)]
pub trait Flow: Send + Sync {
    /// Number of chambers and lag states: of all unknowns but pipe flow rates.
    fn reservoirs(&self) -> usize;

    /// Absolute tolerances of the unknowns, from those of strains (1) and velocities (m/s).
    fn tolerances(&self, strain: f64, velocity: f64) -> Vec<f64>;

    /// Initial values of the unknowns.
    fn start(&self) -> &[f64];

    /// Sets the lag states of actuators to those among the `amounts` at time `t`, before their forces are evaluated.
    fn set(&self, t: f64, amounts: &[f64]);

    /// Adds the forces `at` (u, m) and time `t`, and writes the rates of the unknowns (kg/s for masses); the second vector is a
    /// workspace of the same length. Returns the power (W) supplied by inflow.
    ///
    /// # Errors
    /// As [`Force::add_forces`](super::Force::add_forces).
    fn add_forces_of(
        &self,
        t: f64,
        at: [&[f64]; 2],
        forces: &mut NodalForces,
        rates: [&mut [f64]; 2],
    ) -> Result<f64, Failure>;

    /// Potential energy (J) of the amounts.
    fn potential_of(&self, u: &[f64], amounts: &[f64]) -> f64;

    /// Kinetic energy (J) of the fluid in pipes.
    fn kinetic_of(&self, unknowns: &[f64]) -> f64;

    /// Checks the state at the end `t` of a step.
    ///
    /// # Errors
    /// A state at which the run ends.
    fn check(&self, t: f64, u: &[f64], amounts: &[f64]) -> Result<(), Failure>;

    /// Whether a liquid fills its chamber, so that small errors of its volume are large errors of its pressure.
    fn is_stiff(&self) -> bool;

    /// Writes the gauge pressures (Pa) of chambers that a liquid fills, and NaN for all others.
    fn write_pressures(&self, u: &[f64], amounts: &[f64], pressures: &mut [f64]);

    /// The difference (m^3) from the volume of a chamber to the volume of its `content`, a mass (kg) at a gauge pressure (Pa), and the
    /// latter volume; writes dV/du (m^2). `None` unless a liquid fills the chamber.
    fn missing(
        &self,
        room: usize,
        u: &[f64],
        content: [f64; 2],
        gradient: &mut [f64],
    ) -> Option<[f64; 2]>;

    /// Adds -p d^2V/du^2 to `stiffness`, and writes all other derivatives, `at` (u, v, m).
    fn linearize(
        &self,
        t: f64,
        at: [&[f64]; 3],
        stiffness: &mut BlockMatrix,
        derivatives: &mut FlowDerivatives,
    );
}

/// Derivatives of a [`Flow`] at one state; matrices row by row.
#[doc(hidden)]
#[derive(Debug, Clone)]
pub struct FlowDerivatives {
    /// dV/du (m^2), of one chamber after the other; df/da for lag states.
    pub gradients: Vec<f64>,
    /// -dp/dV (Pa/m^3) and dp/dm (Pa/kg) of each chamber; 0 and 1 for lag states.
    pub pressures: [Vec<f64>; 2],
    /// dq/dV (kg/s/m^3) and dq/dm (1/s), a row for each unknown.
    pub rates: [Vec<f64>; 2],
    /// Derivatives of the power that is supplied, by V (W/m^3) and by m (W/kg).
    pub power: [Vec<f64>; 2],
    /// Derivatives of the power that becomes heat, by m (W/kg).
    pub heat: Vec<f64>,
    /// Rates of the masses (kg/s), and a workspace of the same length.
    pub work: [Vec<f64>; 2],
    /// Workspaces for two evaluations of a force.
    pub trial: [NodalForces; 2],
}

impl FlowDerivatives {
    /// Zeros for these numbers of `rooms` (reservoirs: chambers and lag states) and unknowns; walls are among `dofs` displacement components.
    pub(crate) fn zeros([rooms, unknowns]: [usize; 2], dofs: usize) -> Self {
        let pair = |first: usize, second: usize| [vec![0.0; first], vec![0.0; second]];
        Self {
            gradients: vec![0.0; rooms * dofs],
            pressures: pair(rooms, rooms),
            rates: pair(unknowns * rooms, unknowns * unknowns),
            power: pair(rooms, unknowns),
            heat: vec![0.0; unknowns],
            work: pair(unknowns, unknowns),
            trial: [NodalForces::zeros(dofs), NodalForces::zeros(dofs)],
        }
    }
}
