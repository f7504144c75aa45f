//! Outputs of muscles, and of actuators that are heated.

use super::super::output::{Kind, Output, Value};
use super::super::reading::{Reading, ReadingKind};
use super::super::view::View;
use crate::base::input::InputError;
use crate::elements::body::Contraction;

const MUSCLE: Kind = Kind {
    key: "muscle",
    about: "the name of the muscle",
    find: |scene, name, input| scene.muscle_number(name, input),
};

/// Muscles with Hill's law.
const ACTIVATED: Kind = Kind {
    find: |scene, name, input| {
        scene.largest_stress(name, input)?;
        scene.muscle_number(name, input)
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

pub(super) static STRESS: Output = Output {
    word: "muscle-stress",
    about: "the stress by which a muscle pulls (Pa)",
    unit: "Pa",
    of: MUSCLE,
    is_vector: false,
    is_of_positions: false,
    read: |view, number| {
        let muscle = &view.scene.muscles()[number];
        let [stress, _] = view.actuation_with_rate(muscle.name());
        let Some(law) = muscle.law() else { return Ok(Value::Number(stress)) };
        let contraction = Contraction { law, stress };
        let strands = &view.gauges.muscles[number];
        Ok(Value::Number(strands.mean_pull(contraction, view.u, view.v)))
    },
};

pub(super) static STRETCH: Output = Output {
    word: "muscle-stretch",
    about: "the length of the fibres of a muscle by that in the undeformed shape, the mean over their volume (no unit)",
    unit: "1",
    of: MUSCLE,
    is_vector: false,
    is_of_positions: true,
    read: |view, number| Ok(Value::Number(view.gauges.muscles[number].mean_stretch(view.u))),
};

pub(super) static ACTIVATION: Output = Output {
    word: "activation",
    about: "the activation of a muscle with Hill's law, from 0 to 1",
    unit: "1",
    of: ACTIVATED,
    is_vector: false,
    is_of_positions: false,
    read: |view, number| {
        let name = view.scene.muscles()[number].name();
        let largest = view.scene.largest_stress(name, "muscle")?;
        Ok(Value::Number((view.actuation_with_rate(name)[0] / largest).clamp(0.0, 1.0)))
    },
};

pub(super) static TEMPERATURE: Output = Output {
    word: "temperature",
    about: "the temperature rise of a heated actuator above its surroundings (K)",
    unit: "K",
    of: HEATED,
    is_vector: false,
    is_of_positions: false,
    read: |view, number| {
        let name = view.scene.actuators().nth(number).unwrap_or_default();
        let per_kelvin = view.scene.per_kelvin(name, "actuator")?;
        Ok(Value::Number(view.actuation_with_rate(name)[0] / per_kelvin))
    },
};

impl View<'_> {
    /// Stress (Pa) by which a muscle pulls: its actuation, or with [Hill's law](crate::Hill) the mean stress of that law over its volume.
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
    /// Stress by which a muscle pulls (Pa): see [`View::muscle_stress`](crate::View::muscle_stress).
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
