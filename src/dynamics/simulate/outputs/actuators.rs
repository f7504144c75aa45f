//! Outputs of actuators.

use super::super::output::{Kind, Output, Read};
use super::super::reading::{Reading, ReadingKind};
use super::super::view::View;
use crate::base::input::InputError;
use crate::scene::forces::{Muscle, Spring};

const SPRING: Kind = Kind {
    key: "spring",
    about: "the name of the spring or cable",
    find: |scene, name, input| scene.number_in("springs", name, input),
};

const CABLE: Kind = Kind { key: "cable", about: "the name of the cable", ..SPRING };

const MUSCLE: Kind = Kind {
    key: "muscle",
    about: "the name of the muscle",
    find: |scene, name, input| scene.number_in("muscles", name, input),
};

/// Muscles with Hill's law.
const ACTIVATED: Kind = Kind {
    find: |scene, name, input| {
        let number = (MUSCLE.find)(scene, name, input)?;
        let help = "it has no Hill's law, whose largest stress is full activation: give it one";
        let missing = || InputError::new(input, format!("\"{name}\""), help);
        scene.actuators()[number].hill().ok_or_else(missing).map(|_| number)
    },
    ..MUSCLE
};

const HEATED: Kind = Kind {
    key: "actuator",
    about: "the name of the actuator",
    find: |scene, name, input| {
        scene.per_kelvin(name, input)?;
        scene.actuator_number(name, input)
    },
};

pub(super) static PULL: Output = Output {
    word: "spring-pull",
    about: "the force with which a spring and its actuator pull its ends together, or the tension of a cable at its first place (N)",
    unit: "N",
    of: SPRING,
    read: Read::Number(|view, number| Ok(view.actuator_value(number, Spring::PULL))),
};

pub(super) static TENSION_AT_END: Output = Output {
    word: "tension-at-end",
    about: "the tension of a cable at its last place, from which friction along its path takes its part (N)",
    unit: "N",
    of: CABLE,
    read: Read::Number(|view, number| Ok(view.actuator_value(number, Spring::PULL_AT_END))),
};

pub(super) static LENGTH: Output = Output {
    word: "spring-length",
    about: "the length of a spring, or of the path of a cable (m)",
    unit: "m",
    of: SPRING,
    read: Read::OfPositions(|view, number| Ok(view.actuator_value(number, Spring::LENGTH))),
};

pub(super) static STRESS: Output = Output {
    word: "muscle-stress",
    about: "the stress by which a muscle pulls (Pa)",
    unit: "Pa",
    of: MUSCLE,
    read: Read::Number(|view, number| Ok(view.actuator_value(number, Muscle::STRESS))),
};

pub(super) static STRETCH: Output = Output {
    word: "muscle-stretch",
    about: "the length of the fibres of a muscle by that in the undeformed shape, the mean over their volume (no unit)",
    unit: "1",
    of: MUSCLE,
    read: Read::OfPositions(|view, number| Ok(view.actuator_value(number, Muscle::STRETCH))),
};

pub(super) static ACTIVATION: Output = Output {
    word: "activation",
    about: "the activation of a muscle with Hill's law, from 0 to 1",
    unit: "1",
    of: ACTIVATED,
    read: Read::Number(|view, number| Ok(view.actuator_value(number, Muscle::ACTIVATION))),
};

pub(super) static TEMPERATURE: Output = Output {
    word: "temperature",
    about: "the temperature rise of a heated actuator above its surroundings (K)",
    unit: "K",
    of: HEATED,
    read: Read::Number(|view, number| {
        let name = view.scene.actuators()[number].name();
        Ok(view.drive(number)[0] / view.scene.per_kelvin(name, "actuator")?)
    }),
};

impl View<'_> {
    /// Force (N) with which a spring pulls its ends together: that of its stiffness and damping minus that of
    /// its actuator.
    ///
    /// # Errors
    /// A name that no spring has.
    pub fn spring_pull(&self, spring: &str) -> Result<f64, InputError> {
        PULL.number(self, spring)
    }

    /// Length of a spring (m).
    ///
    /// # Errors
    /// A name that no spring has.
    pub fn spring_length(&self, spring: &str) -> Result<f64, InputError> {
        LENGTH.number(self, spring)
    }

    /// Tension (N) of a cable at its first point, where it is driven, and at its last; they differ by friction.
    ///
    /// # Errors
    /// A name that no spring has.
    pub fn spring_pulls(&self, spring: &str) -> Result<[f64; 2], InputError> {
        let number = PULL.find(self.scene, spring)?;
        Ok([Spring::PULL, Spring::PULL_AT_END].map(|end| self.actuator_value(number, end)))
    }

    /// Active stress (Pa) of a muscle: its actuation, or with [Hill's law](crate::Hill) the mean stress of that law over its volume.
    ///
    /// # Errors
    /// A name that no muscle has.
    pub fn muscle_stress(&self, muscle: &str) -> Result<f64, InputError> {
        STRESS.number(self, muscle)
    }

    /// Stretch (1) of the fibres of a muscle relative to the undeformed shape: the mean over their volume.
    ///
    /// # Errors
    /// A name that no muscle has.
    pub fn muscle_stretch(&self, muscle: &str) -> Result<f64, InputError> {
        STRETCH.number(self, muscle)
    }

    /// Activation of a muscle with [Hill's law](crate::Hill), from 0 to 1: its actuation divided by the largest stress.
    ///
    /// # Errors
    /// A name that no muscle has, or one without that law.
    pub fn activation(&self, muscle: &str) -> Result<f64, InputError> {
        ACTIVATION.number(self, muscle)
    }

    /// Temperature rise (K) of a [heated](crate::Lag::heated) actuator above its surroundings.
    ///
    /// # Errors
    /// A name that no heated actuator has.
    pub fn temperature(&self, actuator: &str) -> Result<f64, InputError> {
        TEMPERATURE.number(self, actuator)
    }
}

impl Reading {
    /// Force with which a spring pulls its ends together (N): see [`View::spring_pull`](crate::View::spring_pull).
    pub fn spring_pull(spring: impl Into<String>) -> Self {
        ReadingKind::Of(&PULL, spring.into()).into()
    }

    /// Tension of a cable at its last point (N), which differs from its [pull](Self::spring_pull) at the drive by
    /// friction along its path.
    pub fn tension_at_end(cable: impl Into<String>) -> Self {
        ReadingKind::Of(&TENSION_AT_END, cable.into()).into()
    }

    /// Length of a spring (m), or of the path of a cable.
    pub fn spring_length(spring: impl Into<String>) -> Self {
        ReadingKind::Of(&LENGTH, spring.into()).into()
    }

    /// Active stress of a muscle (Pa): see [`View::muscle_stress`](crate::View::muscle_stress).
    pub fn muscle_stress(muscle: impl Into<String>) -> Self {
        ReadingKind::Of(&STRESS, muscle.into()).into()
    }

    /// Stretch of the fibres of a muscle relative to the undeformed shape: see
    /// [`View::muscle_stretch`](crate::View::muscle_stretch).
    pub fn muscle_stretch(muscle: impl Into<String>) -> Self {
        ReadingKind::Of(&STRETCH, muscle.into()).into()
    }

    /// Activation of a muscle with [Hill's law](crate::Hill), from 0 to 1: see [`View::activation`](crate::View::activation).
    pub fn activation(muscle: impl Into<String>) -> Self {
        ReadingKind::Of(&ACTIVATION, muscle.into()).into()
    }

    /// Temperature rise (K) of a [heated](crate::Lag::heated) actuator above its surroundings.
    pub fn temperature(actuator: impl Into<String>) -> Self {
        ReadingKind::Of(&TEMPERATURE, actuator.into()).into()
    }
}
