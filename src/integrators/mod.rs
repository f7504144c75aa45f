//! Integrators of ordinary differential and differential-algebraic equations; they are independent of bodies.
//!
//! [`automatic`] derives equations that are written over a number type. [`ode`] has the traits of the systems to integrate, [`solve`](mod@solve) integrates by one call. Below it
//! are the integrators themselves: [`sundials`] (CVODE, IDA, ARKODE), [`rk`] (Dormand and Prince),
//! [`rosenbrock`] and [`central_difference`], which share the options and the trait of [`common`].

pub mod automatic;
pub mod central_difference;
pub mod common;
pub mod ode;
pub mod rk;
pub mod rosenbrock;
pub mod solve;
pub mod sundials;
