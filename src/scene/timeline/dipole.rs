//! Dipoles near the magnets of a scene, and where phases have them.

use std::sync::Arc;

use super::input::{Input, Quantity, Target};
use super::{Phase, Scene, unique};
use crate::base::input::{InputError, find};
use crate::elements::body::MagnetizedPoints;
use crate::elements::force::Forces;
use crate::scene::forces::{Dipole, DipoleForce, DipolePart, Signals, VectorSignal};

impl Scene {
    /// Adds a dipole, which acts on the [magnets](Self::magnet) in all phases.
    pub fn dipole(mut self, dipole: Dipole) -> Self {
        let number = self.dipoles.len() + 1;
        self.dipoles.push(dipole.or_named(format!("dipole {number}")));
        self
    }

    /// The dipoles.
    pub fn dipoles(&self) -> &[Dipole] {
        &self.dipoles
    }

    /// Number (from 0) of the dipole with a name; `input` is where that was given.
    pub(crate) fn dipole_number(&self, name: &str, input: &str) -> Result<usize, InputError> {
        find(name, self.dipoles.iter().map(Dipole::name), input, "dipoles")
    }

    /// The forces of all dipoles in `phase`.
    ///
    /// # Errors
    /// Names that are taken or that no dipole has, a scene without magnets, vectors of another dimension, numbers out of range.
    pub(crate) fn dipole_forces(&self, phase: &Phase) -> Result<Vec<DipoleForce>, InputError> {
        let driven = phase.inputs.iter().filter(|i| matches!(i.quantity, Quantity::Dipole(_)));
        for name in driven.flat_map(|input| input.target.names()) {
            self.dipole_number(name, &format!("dipole of phase \"{}\"", phase.name))?;
        }
        if self.dipoles.is_empty() {
            return Ok(Vec::new());
        }
        unique("dipole", self.dipoles.iter().map(Dipole::name))?;
        if self.magnets.is_empty() {
            let help = "the scene has no magnet that feels it: add one";
            return Err(InputError::new("dipole", format!("\"{}\"", self.dipoles[0].name()), help));
        }
        let points = self.magnetized_points()?;
        let force = |dipole| phase.with_dipole(dipole).force(self.body.dimension(), points.clone());
        self.dipoles.iter().map(force).collect()
    }

    /// The position (m) and the moment (A m^2) of each dipole in `phase` at time `t` (s).
    #[cfg(feature = "output")]
    pub(crate) fn dipoles_at(&self, phase: &Phase, t: f64) -> Vec<[Vec<f64>; 2]> {
        let at = |dipole, part| phase.part_of(dipole, part).components(t, self.body.dimension());
        self.dipoles.iter().map(|dipole| DipolePart::ALL.map(|part| at(dipole, part))).collect()
    }

    /// Magnetized points on which dipoles act; empty without dipoles.
    pub(crate) fn magnetized_points(&self) -> Result<Arc<[Box<dyn MagnetizedPoints>]>, InputError> {
        let mut points: Vec<Box<dyn MagnetizedPoints>> = Vec::new();
        if !self.dipoles.is_empty() {
            for (number, magnet) in (1..).zip(&self.magnets) {
                magnet.add_points_to(&self.body, number, &mut points)?;
            }
        }
        Ok(points.into())
    }

    /// Adds the forces of all dipoles.
    pub(super) fn add_dipoles(&self, phase: &Phase, forces: &mut Forces) -> Result<(), InputError> {
        for force in self.dipole_forces(phase)? {
            forces.push(Arc::new(force));
        }
        Ok(())
    }
}

impl Phase {
    /// Where a dipole of the scene is in this phase (m), in place of its [position](Dipole::new) in the scene.
    pub fn dipole_position(
        mut self,
        dipole: impl Into<String>,
        position: impl Into<Signals>,
    ) -> Self {
        self.set_dipole(&dipole.into(), DipolePart::Position, position.into().0);
        self
    }

    /// The moment (A m^2) of a dipole of the scene in this phase, in place of [that](Dipole::new) in the scene; 0 switches it off.
    pub fn dipole_moment(mut self, dipole: impl Into<String>, moment: impl Into<Signals>) -> Self {
        self.set_dipole(&dipole.into(), DipolePart::Moment, moment.into().0);
        self
    }

    /// A dipole of the scene as it is in this phase.
    pub(crate) fn with_dipole(&self, dipole: &Dipole) -> Dipole {
        let parts = DipolePart::ALL.into_iter();
        parts.fold(dipole.clone(), |own, part| own.with(part, self.part_of(dipole, part).clone()))
    }

    /// The moment or the position of a dipole of the scene in this phase.
    pub(crate) fn part_of<'a>(&'a self, dipole: &'a Dipole, part: DipolePart) -> &'a VectorSignal {
        self.own_part(dipole.name(), part).unwrap_or_else(|| dipole.part(part))
    }

    /// The moment or the position of a dipole, if the phase has one of its own.
    fn own_part(&self, dipole: &str, part: DipolePart) -> Option<&VectorSignal> {
        self.vector(Quantity::Dipole(part), &Target::one(dipole))
    }

    /// Replaces the moment or the position of a dipole.
    pub(crate) fn set_dipole(&mut self, dipole: &str, part: DipolePart, value: VectorSignal) {
        self.set(Input::new(Quantity::Dipole(part), Target::one(dipole), value));
    }
}
