//! Outputs of springs and cables.

use super::super::output::{Kind, Output, Value};
use super::super::reading::{Reading, ReadingKind};
use super::super::view::View;
use crate::base::input::InputError;

const SPRING: Kind = Kind {
    key: "spring",
    about: "the name of the spring or cable",
    find: |scene, name, input| scene.spring_number(name, input),
};

const CABLE: Kind = Kind {
    key: "cable",
    about: "the name of the cable",
    find: |scene, name, input| scene.spring_number(name, input),
};

pub(super) static PULL: Output = Output {
    word: "spring-pull",
    about: "the force with which a spring and its actuator pull its ends together, or the tension of a cable at its first place (N)",
    unit: "N",
    of: SPRING,
    is_vector: false,
    is_of_positions: false,
    read: |view, number| Ok(Value::Number(view.pulls(number)[0])),
};

pub(super) static TENSION_AT_END: Output = Output {
    word: "tension-at-end",
    about: "the tension of a cable at its last place, from which friction along its path takes its part (N)",
    unit: "N",
    of: CABLE,
    is_vector: false,
    is_of_positions: false,
    read: |view, number| Ok(Value::Number(view.pulls(number)[1])),
};

pub(super) static LENGTH: Output = Output {
    word: "spring-length",
    about: "the length of a spring, or of the path of a cable (m)",
    unit: "m",
    of: SPRING,
    is_vector: false,
    is_of_positions: true,
    read: |view, number| Ok(Value::Number(view.gauges.springs[number].length(view.u))),
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

    /// Tension (N) of a cable at its first place, where it is driven, and at its last; they differ by friction.
    ///
    /// # Errors
    /// A name that no spring has.
    pub fn spring_pulls(&self, spring: &str) -> Result<[f64; 2], InputError> {
        Ok(self.pulls(self.scene.spring_number(spring, "spring")?))
    }

    fn pulls(&self, number: usize) -> [f64; 2] {
        let Self { u, v, .. } = self;
        let actuation = self.actuation_with_rate(self.scene.springs()[number].name());
        self.gauges.springs[number].pulls(u, v, actuation)
    }
}

impl Reading {
    /// Force with which a spring pulls its ends together (N): see [`View::spring_pull`](crate::View::spring_pull).
    pub fn spring_pull(spring: impl Into<String>) -> Self {
        ReadingKind::Of(&PULL, spring.into()).into()
    }

    /// Tension of a cable at its last place (N), which friction along its path makes another one than its
    /// [pull](Self::spring_pull) at the drive.
    pub fn tension_at_end(cable: impl Into<String>) -> Self {
        ReadingKind::Of(&TENSION_AT_END, cable.into()).into()
    }

    /// Length of a spring (m), or of the path of a cable.
    pub fn spring_length(spring: impl Into<String>) -> Self {
        ReadingKind::Of(&LENGTH, spring.into()).into()
    }
}
