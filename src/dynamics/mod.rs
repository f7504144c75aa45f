//! The motion of a scene: its equations, phase by phase, and their solution by an integrator.
//!
//! `matrices` has what is constant, `linear` the linear solvers, `system` the equations of a phase as ODE, DAE and system of
//! second order, `reduced` those by a reduced model, `phase` the integrators of either, [`simulate`] the run, [`statics`] the
//! equilibrium, [`trajectory`] what a run returns, `report` what it cost and `indicators` what makes it doubtful.

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
