//! Dynamics of soft elastic bodies.

pub mod ode;
pub mod samples;
pub mod sundials;
