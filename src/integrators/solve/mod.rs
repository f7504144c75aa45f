//! Initial value problems solved by one call: any method, events, breaks, limits, interpolation.
//!
//! A [`Problem`] is the equations and where they start, with the [`Event`]s to look for. [`solve`] integrates
//! it over a span by a [`Method`] and returns a [`Solution`]: times, states, interpolants between them, events,
//! and statistics.
//!
//! ```
//! use pliant::solve::{Event, Method, Options, Problem, solve};
//!
//! // a ball that falls from 10 m and bounces, losing a tenth of its speed each time
//! let fall = |_t: f64, y: &[f64], ydot: &mut [f64]| {
//!     ydot[0] = y[1];
//!     ydot[1] = -9.81;
//!     Ok(())
//! };
//! let floor = Event::new(|_t, y| y[0]).falling().action(|jump| jump.y[1] *= -0.9);
//! let problem = Problem::ode(fall, [10.0, 0.0]).event(floor);
//! let solution = solve(problem, Method::Bdf, (0.0, 5.0), &Options::new(1e-8, 1e-10))?;
//!
//! let first = &solution.events()[0];
//! assert!((first.t - (2.0_f64 * 10.0 / 9.81).sqrt()).abs() < 1e-6);
//! let height = solution.at(2.0)?[0];
//! # assert!(height > 0.0);
//! # Ok::<(), pliant::solve::Error>(())
//! ```
//!
//! [`Run`] does the same step by step, under the caller's control, and [`ensemble`] solves many problems on
//! all cores. Features that a method lacks are errors before the first step, and are never replaced by others.

mod auto;
mod caution;
mod choice;
mod control;
mod crossing;
mod diagnosis;
mod edge;
mod engine;
mod ensemble;
mod error;
mod event;
mod gradient;
mod history;
mod integrator_options;
mod linear_solver;
mod method;
mod minimum;
#[cfg(doctest)]
mod misuse;
mod options;
mod problem;
mod rate;
mod resize;
mod run;
mod saved;
mod sensitivities;
mod sides;
mod snapshot;
mod solution;
mod solver;
mod start;
mod stepping;
mod switch;
mod timed;
mod watch;

pub use ensemble::ensemble;
pub use error::{Error, Reason, Stopped};
pub use event::{Event, Jump};
pub use gradient::gradient;
pub use method::{MassMatrices, Method, MethodInformation, MethodUse};
pub use options::{Options, Output};
pub use problem::{Problem, Progress};
pub use run::{Run, Step};
pub use saved::Saved;
pub use solution::{End, Occurrence, Solution};
pub use solver::solve;

pub use crate::base::root::Direction;
pub use crate::integrators::common::Statistics;
