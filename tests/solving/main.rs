//! Problems solved by one call: events, breaks, interpolation, limits.

mod accumulation;
mod bounds;
mod breaks;
mod clock_times;
mod clocks;
mod control;
mod difference_quotients;
mod edges;
mod ensembles;
mod events;
mod gradients;
mod integrals;
mod interpolation;
mod limits;
mod refusals;
mod resuming;
mod rosenbrock;
mod sensitivities;
mod standstill;
mod support;
mod switches;
mod threads;
mod tolerances;
mod values;
mod wrong_jacobians;
mod wrong_solvers;
