//! Dipoles of a simulation: where they are, what they do, and commands that move them.

use super::simulation::Simulation;
use super::view::View;
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::scene::forces::{DipolePart, Signals, VectorSignal, point_dipole};
use crate::scene::timeline::{Input, Quantity, Target};

/// Dipoles.
impl View<'_> {
    /// Where a dipole is (m).
    ///
    /// # Errors
    /// A name that no dipole has.
    pub fn dipole_position(&self, dipole: &str) -> Result<Vec<f64>, InputError> {
        let [position, _] = self.parts_of(dipole)?;
        Ok(position.components(self.time, self.body().dimension()))
    }

    /// The moment of a dipole (A m^2).
    ///
    /// # Errors
    /// A name that no dipole has.
    pub fn dipole_moment(&self, dipole: &str) -> Result<Vec<f64>, InputError> {
        let [_, moment] = self.parts_of(dipole)?;
        Ok(moment.components(self.time, self.body().dimension()))
    }

    /// The position (m) and the moment (A m^2) of each dipole.
    #[cfg(feature = "play")]
    pub(crate) fn dipoles(&self) -> Vec<[Vec<f64>; 2]> {
        self.scene.dipoles_at(self.phase, self.time)
    }

    /// The force (N) of a dipole on all magnets together, one component per dimension; that on the dipole is minus this.
    ///
    /// # Errors
    /// A name that no dipole has.
    pub fn dipole_force(&self, dipole: &str) -> Result<Vec<f64>, InputError> {
        let (d, mut force) = (self.body().dimension(), [0.0; 3]);
        let parts = self.parts_of(dipole)?;
        let now = point_dipole(parts, self.time, d);
        let magnets = self.gauges.magnetized.iter();
        magnets.for_each(|magnet| magnet.add_force(&now, self.state.u, &mut force));
        Ok(force[..d].to_vec())
    }

    /// The position and the moment of a dipole in the phase.
    fn parts_of(&self, name: &str) -> Result<[&VectorSignal; 2], InputError> {
        let dipole = &self.scene.dipoles()[self.scene.dipole_number(name, "dipole")?];
        Ok(DipolePart::ALL.map(|part| self.phase.part_of(dipole, part)))
    }
}

/// Commands for dipoles.
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
