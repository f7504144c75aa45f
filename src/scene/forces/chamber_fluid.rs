//! Fluid in a chamber: an amount of gas or liquid, with a pressure.

use super::chamber::ChamberForce;
use crate::base::sparse::BlockMatrix;
use crate::elements::force::NodalForces;
use crate::integrators::ode::Failure;

/// The fluid in a chamber at a moment.
#[derive(Clone, Copy)]
pub(crate) struct Fill {
    /// Its amount (kg).
    pub(crate) amount: f64,
    /// The part of its weight that acts, where it fills the chamber whole; the weight of others follows from the amount.
    pub(crate) weight: f64,
}

impl Fill {
    /// An `amount` (kg) with all of its weight.
    pub(crate) fn of(amount: f64) -> Self {
        Self { amount, weight: 1.0 }
    }
}

/// An amount of something within walls, whose energy depends on it and on the displacements of the walls alone.
pub(crate) trait ChamberFluid: Send + Sync {
    /// Its walls.
    fn walls(&self) -> &ChamberForce;

    /// The amount (kg) at the start.
    fn amount(&self) -> f64;

    /// Adds the forces of a `fill` under the displacements `u` (m).
    ///
    /// # Errors
    /// A state without meaning: walls that have passed through each other, no amount that is left.
    fn press(&self, u: &[f64], fill: Fill, forces: &mut NodalForces) -> Result<(), Failure>;

    /// Adds the tangent under a pressure that stays to `stiffness`, and the derivative of what the pressure acts on (dV/du, m^2) to `gradient`. Returns the
    /// pressure (Pa), of gas the absolute one, and its derivatives by the volume, -dp/dV (Pa/m^3), and by the amount, dp/dm (Pa/kg). `None` where
    /// [`press`](Self::press) fails.
    fn linearize(
        &self,
        u: &[f64],
        fill: Fill,
        stiffness: &mut BlockMatrix,
        gradient: &mut [f64],
    ) -> Option<[f64; 3]>;

    /// Potential energy (J), 0 at the start.
    fn potential(&self, u: &[f64], fill: Fill) -> f64;

    /// The gauge pressure (Pa) of an `amount` (kg) under the displacements `u` (m).
    ///
    /// # Errors
    /// As [`press`](Self::press).
    fn gauge(&self, u: &[f64], amount: f64) -> Result<f64, Failure>;

    /// The volume (m^3) in which an `amount` (kg) has the pressure `gauge` (Pa), of what hardly changes it: there an error of the volume that
    /// tolerances allow is one of many kilopascals.
    fn volume_under(&self, _amount: f64, _gauge: f64) -> Option<f64> {
        None
    }

    /// Checks a step after it was taken, to time `t` (s).
    ///
    /// # Errors
    /// A pressure at which the chamber [bursts](crate::Chamber::burst).
    fn check(&self, t: f64, u: &[f64], amount: f64) -> Result<(), Failure> {
        match self.walls().can_burst() {
            true => self.walls().check_burst(t, self.gauge(u, amount)?),
            false => Ok(()),
        }
    }
}
