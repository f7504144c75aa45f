//! Integrators of any ordinary differential or differential-algebraic equations; they know no bodies.
//!
//! [`ode`] has the traits of what is integrated, [`solve`](mod@solve) integrates by one call. Below it stand the
//! integrators themselves: [`sundials`] (CVODE, IDA, ARKODE), [`rk`] (Dormand and Prince), [`rosenbrock`] and
//! [`central_difference`], which share the options and the trait of [`common`].

pub mod central_difference;
pub mod common;
pub mod ode;
pub mod rk;
pub mod rosenbrock;
pub mod solve;
pub mod sundials;
