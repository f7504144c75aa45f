//! Dipoles by their own words: sensors, readings and commands, which are those of a device.

use super::super::output::{Kind, Output, Read};
use super::super::reading::{Reading, ReadingKind};
use super::super::simulation::Simulation;
use super::super::view::View;
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::scene::forces::Signals;

const DIPOLE: Kind = Kind {
    key: "dipole",
    about: "the name of the dipole",
    find: |scene, name, input| scene.device_number(name, input),
};

pub(super) static FORCE: Output = Output {
    word: "dipole-force",
    about: "the force of a dipole on all magnets; that on the dipole is minus this (N)",
    unit: "N",
    of: DIPOLE,
    read: Read::Vector(|view, number| read(view, number, "force")),
};

pub(super) static POSITION: Output = Output {
    word: "dipole-position",
    about: "the position of a dipole (m)",
    unit: "m",
    of: DIPOLE,
    read: Read::Vector(|view, number| read(view, number, "position")),
};

fn read(view: &View<'_>, number: usize, word: &str) -> Result<[f64; 3], InputError> {
    let output = view.scene.output_number(number, word)?;
    Ok(view.device_value(number, output, None))
}

impl View<'_> {
    /// Position (m) of a dipole.
    ///
    /// # Errors
    /// A name that no dipole has.
    pub fn dipole_position(&self, dipole: &str) -> Result<Vec<f64>, InputError> {
        self.device(dipole, "position")
    }

    /// The moment of a dipole (A m^2).
    ///
    /// # Errors
    /// A name that no dipole has.
    pub fn dipole_moment(&self, dipole: &str) -> Result<Vec<f64>, InputError> {
        self.device(dipole, "moment")
    }

    /// The force (N) of a dipole on all magnets together, one component per dimension; that on the dipole is minus this.
    ///
    /// # Errors
    /// A name that no dipole has.
    pub fn dipole_force(&self, dipole: &str) -> Result<Vec<f64>, InputError> {
        self.device(dipole, "force")
    }
}

impl Reading {
    /// Force of a [dipole](crate::Dipole) on all magnets (N): see [`View::dipole_force`](crate::View::dipole_force).
    pub fn dipole_force(dipole: impl Into<String>) -> Self {
        ReadingKind::Of(&FORCE, dipole.into()).into()
    }

    /// Position (m) of a [dipole](crate::Dipole).
    pub fn dipole_position(dipole: impl Into<String>) -> Self {
        ReadingKind::Of(&POSITION, dipole.into()).into()
    }
}

impl Simulation {
    /// Sets the position (m) of a dipole, in place of the present one: a constant vector applies at once.
    ///
    /// # Errors
    /// A name that no dipole has, a wrong number of components, numbers that are not finite.
    pub fn dipole_position(
        &mut self,
        dipole: &str,
        position: impl Into<Signals>,
    ) -> Result<(), Error> {
        self.device_input(dipole, "position", position.into())
    }

    /// Sets the moment (A m^2) of a dipole, in place of the present one.
    ///
    /// # Errors
    /// As [`dipole_position`](Self::dipole_position).
    pub fn dipole_moment(&mut self, dipole: &str, moment: impl Into<Signals>) -> Result<(), Error> {
        self.device_input(dipole, "moment", moment.into())
    }
}
