//! Outputs of dipoles.

use super::super::output::{Kind, Output, Value};
use super::super::reading::{Reading, ReadingKind};
use super::super::view::View;
use crate::base::input::InputError;
use crate::scene::forces::{DipolePart, VectorSignal, point_dipole};

const DIPOLE: Kind = Kind {
    key: "dipole",
    about: "the name of the dipole",
    find: |scene, name, input| scene.dipole_number(name, input),
};

pub(super) static FORCE: Output = Output {
    word: "dipole-force",
    about: "the force of a dipole on all magnets; that on the dipole is minus this (N)",
    unit: "N",
    of: DIPOLE,
    is_vector: true,
    is_of_positions: false,
    read: |view, number| {
        let mut force = [0.0; 3];
        let parts = DipolePart::ALL.map(|part| view.dipole_part(number, part));
        let now = point_dipole(parts, view.time, view.body().dimension());
        let magnets = view.gauges.magnetized.iter();
        magnets.for_each(|magnet| magnet.add_force(&now, view.u, &mut force));
        Ok(Value::Vector(force))
    },
};

pub(super) static POSITION: Output = Output {
    word: "dipole-position",
    about: "the position of a dipole (m)",
    unit: "m",
    of: DIPOLE,
    is_vector: true,
    is_of_positions: false,
    read: |view, number| Ok(view.dipole_value(number, DipolePart::Position)),
};

impl View<'_> {
    /// Position (m) of a dipole.
    ///
    /// # Errors
    /// A name that no dipole has.
    pub fn dipole_position(&self, dipole: &str) -> Result<Vec<f64>, InputError> {
        POSITION.vector(self, dipole)
    }

    /// The moment of a dipole (A m^2).
    ///
    /// # Errors
    /// A name that no dipole has.
    pub fn dipole_moment(&self, dipole: &str) -> Result<Vec<f64>, InputError> {
        let number = self.scene.dipole_number(dipole, "dipole")?;
        let moment = self.dipole_part(number, DipolePart::Moment);
        Ok(moment.components(self.time, self.body().dimension()))
    }

    /// The force (N) of a dipole on all magnets together, one component per dimension; that on the dipole is minus this.
    ///
    /// # Errors
    /// A name that no dipole has.
    pub fn dipole_force(&self, dipole: &str) -> Result<Vec<f64>, InputError> {
        FORCE.vector(self, dipole)
    }

    /// The position (m) and the moment (A m^2) of each dipole.
    #[cfg(feature = "play")]
    pub(crate) fn dipoles(&self) -> Vec<[Vec<f64>; 2]> {
        self.scene.dipoles_at(self.phase, self.time)
    }

    fn dipole_part(&self, number: usize, part: DipolePart) -> &VectorSignal {
        self.phase.part_of(&self.scene.dipoles()[number], part)
    }

    fn dipole_value(&self, number: usize, part: DipolePart) -> Value {
        let mut vector = [0.0; 3];
        let components = &mut vector[..self.body().dimension()];
        self.dipole_part(number, part).at(self.time, components);
        Value::Vector(vector)
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
