//! Explicit Runge-Kutta integration: the method of Dormand and Prince, order 5(4).
//!
//! The right tool for systems that are not stiff, and an independent check on the implicit methods of
//! SUNDIALS for those that are. Error norm and tolerances mean the same as there. On a stiff system the
//! integrator is slow, but correct; it notices this and reports it by [`DormandPrince::stability_limit`].
//!
//! ```
//! use pliant::ode::Failure;
//! use pliant::rk::{DormandPrince, Integrator, Options};
//!
//! let oscillator = |_t: f64, y: &[f64], ydot: &mut [f64]| {
//!     ydot[0] = y[1];
//!     ydot[1] = -y[0];
//!     Ok::<(), Failure>(())
//! };
//! let options = Options::new(1e-9, 1e-12);
//! let mut solver = DormandPrince::new(oscillator, 0.0, &[1.0, 0.0], &options)?;
//! for k in 1..=10 {
//!     let t = 0.1 * f64::from(k);
//!     solver.solve_to(t)?;
//!     assert!((solver.y()[0] - t.cos()).abs() < 1e-8);
//! }
//! # Ok::<(), pliant::rk::Error>(())
//! ```

mod control;
mod dormand_prince;
mod tableau;

pub use control::StabilityLimit;
pub(crate) use control::{REACH, REACH_UNDAMPED};
pub use dormand_prince::DormandPrince;

pub use crate::integrators::common::{
    Error, ExplicitOptions as Options, Integrator, Reached, Statistics,
};
