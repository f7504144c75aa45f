//! Specific energy and surface level of liquids in chambers, in addition to the forces of their content.

use crate::integrators::ode::Failure;
use crate::scene::forces::chamber_fluid::ChamberFluid;

/// A liquid in a chamber.
pub(super) trait Held: ChamberFluid {
    /// dE/dm (J/kg) of an `amount` (kg), and its derivative by the amount in a chamber that stays (J/kg^2).
    ///
    /// # Errors
    /// As [`ChamberFluid::press`].
    fn brought(&self, u: &[f64], amount: f64) -> Result<[f64; 2], Failure>;

    /// g z (J/kg) of its middle, or of its surface, in the undeformed shape.
    fn lifted(&self) -> f64;

    /// The level of its surface (m) above the origin; NaN without one.
    fn level(&self, _u: &[f64], _amount: f64) -> f64 {
        f64::NAN
    }

    /// Lines along which its surface meets the walls (m).
    #[cfg(feature = "output")]
    fn waterline(&self, _u: &[f64], _amount: f64) -> Vec<[[f64; 3]; 2]> {
        Vec::new()
    }
}
