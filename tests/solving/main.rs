//! Problems solved by one call: events, breaks, interpolation, limits.

mod accumulation;
mod bounds;
mod breaks;
mod ensembles;
mod events;
mod gradients;
mod integrals;
mod interpolation;
mod limits;
mod refusals;
mod resuming;
mod sensitivities;
mod support;
mod values;
