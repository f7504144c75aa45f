//! The motion of a scene: its equations, phase by phase, and their solution by an integrator.
//!
//! `matrices` has the constant matrices, `linear` the linear solvers, `system` the equations of a phase as ODE, DAE and system of
//! second order, `reduced` those by a reduced model, `phase` the integrators of either, [`simulate`] the run, [`statics`] the
//! equilibrium, [`trajectory`] the results of a run, `report` its cost and `indicators` its reliability.

pub mod equations;
pub(crate) mod equilibrium;
pub mod error;
pub(crate) mod indicators;
pub(crate) mod linear;
pub(crate) mod matrices;
pub(crate) mod phase;
pub(crate) mod reduced;
pub(crate) mod report;
pub mod simulate;
pub(crate) mod state;
pub mod statics;
pub(crate) mod system;
pub mod trajectory;
