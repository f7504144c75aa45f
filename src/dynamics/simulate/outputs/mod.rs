//! All outputs: a quantity is a row in the file of its components, and stands in this list.

mod actuators;
mod chambers;
mod devices;
mod dipoles;
mod gas;
mod liquids;

#[cfg(feature = "study")]
pub(super) use chambers::VOLUME;

use super::output::Output;

/// Quantities of components that sensors read, in the order of the reference.
pub(crate) const OUTPUTS: [&Output; 18] = [
    &actuators::PULL,
    &actuators::TENSION_AT_END,
    &actuators::LENGTH,
    &actuators::STRESS,
    &actuators::STRETCH,
    &actuators::ACTIVATION,
    &actuators::TEMPERATURE,
    &dipoles::FORCE,
    &dipoles::POSITION,
    &chambers::PRESSURE,
    &gas::ABSOLUTE_PRESSURE,
    &gas::AMOUNT,
    &gas::FLOW,
    &liquids::VOLUME,
    &liquids::FLOW,
    &liquids::LEVEL,
    &liquids::PIPE_FLOW,
    &chambers::VOLUME,
];
