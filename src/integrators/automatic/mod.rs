//! Equations written once over a number type, with exact Jacobians and slopes from them.
//!
//! A right-hand side that is generic over [`Number`] is evaluated with numbers that carry derivatives along: its Jacobian has the rounding of
//! one evaluation and no increment to choose, in place of the noise of differences. [`automatic`] makes an
//! [`Ode`](crate::integrators::ode::Ode) of it, with df/dy in any form, products with vectors, and derivatives by the parameters for
//! sensitivities and adjoint gradients; and a [`Dae`](crate::integrators::ode::Dae) of a [`Residual`].
//!
//! ```
//! use pliant::{
//!     automatic::{Number, RightHandSide, automatic},
//!     ode::Failure,
//!     solve::{Method, Options, Problem, solve},
//! };
//!
//! /// Robertson's reactions, with their rates as parameters.
//! struct Robertson;
//!
//! impl RightHandSide for Robertson {
//!     fn rhs<T: Number>(&mut self, _t: f64, y: &[T], p: &[T], ydot: &mut [T]) -> Result<(), Failure> {
//!         let (slow, back) = (p[0] * y[0], p[1] * y[1] * y[2]);
//!         ydot[2] = p[2] * y[1] * y[1];
//!         ydot[0] = back - slow;
//!         ydot[1] = slow - back - ydot[2];
//!         Ok(())
//!     }
//! }
//!
//! let problem = Problem::ode(automatic(Robertson, [0.04, 1e4, 3e7]), [1.0, 0.0, 0.0]);
//! let solution = solve(problem, Method::Bdf, (0.0, 40.0), &Options::new(1e-8, 1e-14))?;
//! // published: 0.7158270688
//! assert!((solution.last()[0] - 0.715_827_068_8).abs() < 1e-7);
//! assert_eq!(solution.statistics().difference_quotient_evaluations, 0);
//! # Ok::<(), pliant::solve::Error>(())
//! ```

mod dae;
mod derivatives;
mod dual;
mod number;
mod ode;
mod system;
mod workspace;

pub use dae::Residual;
pub use number::Number;
pub use ode::RightHandSide;
pub use system::{Automatic, automatic};
