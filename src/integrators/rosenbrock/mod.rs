//! Rosenbrock methods: implicit, and without an iteration.
//!
//! Each step factorizes I - gamma h df/dy once and solves with it once a stage. Nothing has to converge: a
//! step whose error is too large is repeated with a smaller size, and that is all. Two methods, both L-stable
//! and stiffly accurate, with dense output:
//!
//! - order 4, RODASP2, with six stages: for a matrix that is the Jacobian. With an approximation of it the
//!   order falls to 2, with an error in proportion to the difference.
//! - order 3, ROS34PW2, with four stages. A W-method: it has its order with any matrix, and needs a good one
//!   only for stability.
//!
//! The error is controlled at the ends of steps. In between the solution is a cubic, mostly as accurate as
//! the ends. Where the ends are far more accurate than required, as below, steps may become so long that the
//! cubic is not: then bound the steps, or stop at the times that matter.
//!
//! ```
//! use pliant::ode::Failure;
//! use pliant::rosenbrock::{Integrator, Options, Rosenbrock};
//!
//! // a stiff pull towards cos t
//! let stiff = |t: f64, y: &[f64], ydot: &mut [f64]| {
//!     ydot[0] = -1e6 * (y[0] - t.cos()) - t.sin();
//!     Ok::<(), Failure>(())
//! };
//! let options = Options::new(1e-6, 1e-9).max_step(0.1);
//! let mut solver = Rosenbrock::new(stiff, 0.0, &[1.0], &options)?;
//! solver.solve_to(1.0)?;
//! assert!((solver.y()[0] - f64::cos(1.0)).abs() < 1e-6);
//! assert!(solver.statistics().steps < 100);
//! # Ok::<(), pliant::rosenbrock::Error>(())
//! ```

#[cfg(any(test, feature = "gradient"))]
mod adjoint;
mod control;
mod matrix;
mod options;
mod solver;
mod step;
mod tableau;

#[cfg(feature = "gradient")]
pub(crate) use adjoint::{StepAdjoint, Transposed};
pub use options::Options;
pub use solver::Rosenbrock;

pub use crate::integrators::common::{Error, Integrator, Reached, Statistics};
