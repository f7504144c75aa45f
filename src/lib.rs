//! Dynamics of soft elastic bodies.

pub mod ode;
pub mod rk;
pub mod samples;
pub mod sundials;

/// Compiles the code blocks of the README.
#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct ReadmeDoctests;
