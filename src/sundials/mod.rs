//! A safe, general layer over SUNDIALS: any system of ordinary differential equations (CVODE) or
//! differential-algebraic equations (IDA), nothing about bodies.
//!
//! The system is a closure or a struct, see [`crate::ode`]; the solver owns it, chooses its steps
//! by the tolerances, and answers failures with a typed [`Error`] that tells time, step size,
//! order, cause and what to try. Panics of the system pass through C unharmed.
//!
//! ```
//! use pliant::sundials::{Cvode, CvodeOptions};
//!
//! // y' = -1000 (y - cos t): the solution is pulled to cos t within milliseconds.
//! let system = |t: f64, y: &[f64], ydot: &mut [f64]| {
//!     ydot[0] = -1000.0 * (y[0] - t.cos());
//!     Ok(())
//! };
//! let mut solver = Cvode::new(system, 0.0, &[0.0], &CvodeOptions::new(1e-6, 1e-9))?;
//! for t in [0.5, 1.0, 1.5] {
//!     solver.solve_to(t)?;
//!     assert!((solver.y()[0] - t.cos()).abs() < 2e-3);
//! }
//! println!("{} steps", solver.statistics().steps);
//! # Ok::<(), pliant::sundials::Error>(())
//! ```
//!
//! [`Cvode`] and [`Ida`] offer the same: [`solve_to`](Cvode::solve_to) a time or a single
//! [`step`](Cvode::step), output between the steps by [`interpolate`](Cvode::interpolate), stop
//! times, root functions, re-initialisation and [`Statistics`]. [`LinearSolver`] says how Newton's
//! linear systems are solved: dense, band, sparse (KLU) or by the system itself.
//!
//! The functions of the C library that stand behind the methods are named in their
//! documentation; the SUNDIALS user guide describes them in depth.

mod arkode;
mod context;
mod cvode;
mod dae_callbacks;
mod error;
mod ffi;
mod functions;
mod host;
mod ida;
mod kernels;
mod linear;
mod matrix;
mod nonlinear;
mod ode_callbacks;
mod options;
mod pattern;
mod session;
mod statistics;
mod vector;
mod version;

pub use arkode::{Arkode, ArkodeOptions, Predictor, Table};
pub use cvode::{Cvode, CvodeOptions, Multistep};
pub use error::{Callback, Cause, Error, IntegrationError};
pub use ida::{Ida, IdaOptions, InitialCondition};
pub use linear::{Jacobian, LinearSolver};
pub use options::{AbsoluteTolerance, Reached};
pub use pattern::Pattern;
pub use statistics::Statistics;
pub use version::{suitesparse_version, version};
