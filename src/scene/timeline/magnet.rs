//! Magnets within the material of the bodies, and the magnetic fields of phases.

use super::input::{Quantity, Target};
use super::{Phase, Scene};
use crate::base::input::InputError;
use crate::elements::body::Magnets;
use crate::scene::forces::{Magnet, MagneticField, VectorSignal};

impl Scene {
    /// Makes a part of the body a magnet, on which the magnetic fields of phases act.
    pub fn magnet(mut self, magnet: Magnet) -> Self {
        self.magnets.push(magnet);
        self
    }

    /// The magnets.
    pub fn magnets(&self) -> &[Magnet] {
        &self.magnets
    }

    /// The magnetization of the body by all magnets, if there is any.
    pub(crate) fn magnetization(&self) -> Result<Option<Magnets>, InputError> {
        if self.magnets.is_empty() {
            return Ok(None);
        }
        let mut sum = self.body.without_magnets();
        let mut magnets = (1..).zip(&self.magnets);
        magnets.try_for_each(|(number, magnet)| magnet.add_to(&self.body, number, &mut sum))?;
        Ok(Some(sum))
    }
}

impl Phase {
    /// The uniform part of its magnetic field (T) at time `t` (s), one component per `dimension`; 0 without a field.
    pub(crate) fn magnetic_field_at(&self, t: f64, dimension: usize) -> Vec<f64> {
        let field = self.uniform_field();
        field.map_or_else(|| vec![0.0; dimension], |field| field.components(t, dimension))
    }

    /// The uniform part of its magnetic field.
    pub(crate) fn uniform_field(&self) -> Option<&VectorSignal> {
        self.vector(Quantity::Field, &Target::Everything)
    }

    /// Its magnetic field.
    pub(crate) fn field(&self) -> Option<MagneticField> {
        let field = self.uniform_field()?.clone();
        Some(MagneticField { field, gradient: self.gradient.clone() })
    }
}
