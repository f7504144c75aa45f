//! Actuators and magnets within the material of the bodies: muscles, growth, magnets.

use super::input::{Quantity, Target};
use super::{Phase, Scene};
use crate::base::input::{InputError, find};
use crate::elements::body::Magnets;
use crate::scene::forces::{Growth, Magnet, MagneticField, Muscle, Spring, VectorSignal};

impl Scene {
    /// Adds a muscle in the body, to be contracted by the stress that phases give it.
    pub fn muscle(mut self, muscle: Muscle) -> Self {
        let number = self.muscles.len() + 1;
        self.muscles.push(muscle.or_named(format!("muscle {number}")));
        self
    }

    /// Lets cells of the body grow, by the strain that phases give.
    pub fn growth(mut self, growth: Growth) -> Self {
        let number = self.growths.len() + 1;
        self.growths.push(growth.or_named(format!("growth {number}")));
        self
    }

    /// Makes a part of the body a magnet, on which the magnetic fields of phases act.
    pub fn magnet(mut self, magnet: Magnet) -> Self {
        self.magnets.push(magnet);
        self
    }

    /// The muscles.
    pub fn muscles(&self) -> &[Muscle] {
        &self.muscles
    }

    /// The muscle with a name, if there is one.
    pub(super) fn muscle_named(&self, name: &str) -> Option<&Muscle> {
        self.muscles.iter().find(|muscle| muscle.name() == name)
    }

    /// The growths.
    pub fn growths(&self) -> &[Growth] {
        &self.growths
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

    /// Number (from 0) of the muscle with a name; `input` is where that was given.
    pub(crate) fn muscle_number(&self, name: &str, input: &str) -> Result<usize, InputError> {
        find(name, self.muscles.iter().map(Muscle::name), input, "muscles")
    }

    /// The stress (Pa) of full activation of a muscle with Hill's law; `input` is where its name was given.
    pub(crate) fn largest_stress(&self, name: &str, input: &str) -> Result<f64, InputError> {
        let muscle = &self.muscles[self.muscle_number(name, input)?];
        muscle.law().map(|hill| hill.largest).ok_or_else(|| {
            let help = "it has no Hill's law, whose largest stress is full activation: give it one";
            InputError::new(input, format!("\"{name}\""), help)
        })
    }

    /// Number (from 0) of the spring, muscle or growth with a name, in this order; `input` is where that was given.
    pub(crate) fn actuator_number(&self, name: &str, input: &str) -> Result<usize, InputError> {
        if self.muscles.is_empty() && self.growths.is_empty() {
            return self.spring_number(name, input);
        }
        find(name, self.actuators(), input, "springs, cables, muscles and growths")
    }

    /// Names of all springs, muscles and growths.
    pub(crate) fn actuators(&self) -> impl Iterator<Item = &str> + Clone {
        let springs = self.springs.iter().map(Spring::name);
        let muscles = self.muscles.iter().map(Muscle::name);
        springs.chain(muscles).chain(self.growths.iter().map(Growth::name))
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
