//! Commands that move dipoles.

use super::simulation::Simulation;
use crate::dynamics::error::Error;
use crate::scene::forces::{DipolePart, Signals, VectorSignal};
use crate::scene::timeline::{Input, Quantity, Target};

impl Simulation {
    /// Sets the position (m) of a dipole, in place of the present one: where it is at once, if it is a vector.
    ///
    /// # Errors
    /// A name that no dipole has, a wrong number of components, numbers that are not finite.
    pub fn dipole_position(
        &mut self,
        dipole: &str,
        position: impl Into<Signals>,
    ) -> Result<(), Error> {
        self.set_dipole(dipole, DipolePart::Position, position.into().0)
    }

    /// Sets the moment (A m^2) of a dipole, in place of the present one.
    ///
    /// # Errors
    /// As [`dipole_position`](Self::dipole_position).
    pub fn dipole_moment(&mut self, dipole: &str, moment: impl Into<Signals>) -> Result<(), Error> {
        self.set_dipole(dipole, DipolePart::Moment, moment.into().0)
    }

    fn set_dipole(
        &mut self,
        dipole: &str,
        part: DipolePart,
        value: VectorSignal,
    ) -> Result<(), Error> {
        self.scene().dipole_number(dipole, &format!("{part} of dipole \"{dipole}\""))?;
        self.set(Input::new(Quantity::Dipole(part), Target::one(dipole), value))
    }
}
