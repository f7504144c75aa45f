//! Explicit Runge-Kutta integration: the method of Dormand and Prince, order 5(4).
//!
//! The right tool for systems that are not stiff, and an independent check on the implicit methods
//! of SUNDIALS for those that are. Error norm and tolerances mean the same as there.
//! On a stiff system the integrator is slow, but right; it notices, and says so in
//! [`Statistics::stability_limited`].
//!
//! ```
//! use pliant::ode::Failure;
//! use pliant::rk::{DormandPrince, Options};
//!
//! let oscillator = |_t: f64, y: &[f64], ydot: &mut [f64]| {
//!     ydot[0] = y[1];
//!     ydot[1] = -y[0];
//!     Ok::<(), Failure>(())
//! };
//! let options = Options::default().rtol(1e-9).atol(1e-12);
//! let mut solver = DormandPrince::new(oscillator, 0.0, &[1.0, 0.0], &options)?;
//! for k in 1..=10 {
//!     let t = 0.1 * f64::from(k);
//!     solver.solve_to(t)?;
//!     assert!((solver.y()[0] - t.cos()).abs() < 1e-8);
//! }
//! # Ok::<(), pliant::rk::Error>(())
//! ```

mod control;
mod error;
mod options;
mod roots;
mod solver;
mod stages;
mod tableau;

pub use control::StabilityLimit;
pub use error::Error;
pub use options::{Options, Tolerance};
pub use solver::DormandPrince;

/// Order of the method.
pub const ORDER: u32 = 5;

/// What an integration has done since it started, or since the last
/// [`reinit`](DormandPrince::reinit).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Statistics {
    /// Accepted steps.
    pub steps: usize,
    /// Steps repeated because the error test failed.
    pub rejected_steps: usize,
    /// Steps repeated because the right-hand side could not be evaluated: it said so
    /// ([`Failure::Recoverable`](crate::ode::Failure)) or its value was not finite.
    pub refused_steps: usize,
    /// Evaluations of the right-hand side.
    pub rhs_evaluations: usize,
    /// Evaluations of the root functions.
    pub root_evaluations: usize,
    /// Accepted steps at the border of the stability region.
    pub stability_limited_steps: usize,
    /// Set once such steps are the rule: the system is stiff.
    pub stability_limited: Option<StabilityLimit>,
    /// Size of the last accepted step; 0 before the first.
    pub last_step: f64,
}
